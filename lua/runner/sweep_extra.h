/* SPDX-License-Identifier: MIT
 *
 * What the modules sweep_mpi.so and sweep_hdf5.so give the runner: they alone link MPI and HDF5, and are loaded by
 * --mpi and --hdf5 only.
 */
#ifndef IMPACT_SWEEP_EXTRA_H
#define IMPACT_SWEEP_EXTRA_H

#include <stdbool.h>
#include <stddef.h>

/* ---- ranks: a variable `impact_sweep_mpi` of this type ---- */

typedef struct impact_sweep_ranks {
    /* Before the fence and any thread; NULL, or what went wrong. */
    const char *(*begin)(int *rank, int *count);
    /* By all: the one counter, at 0. */
    void (*open_counter)(void);
    /* The counter's value, which grows by count; by one thread at a time, as all below. */
    long (*take)(long count);
    /* Lets messages pass while this rank computes. */
    void (*poll)(void);
    /* All wait for all. */
    void (*meet)(void);
    /* The sum over all ranks, to rank 0 (what others get is their own). */
    long (*sum)(long value);
    /* By all; a rank that has not opened the counter ends the others with it. */
    void (*end)(int code);
} impact_sweep_ranks;

/* ---- tables ---- */

typedef enum impact_sweep_kind {
    IMPACT_SWEEP_INTEGER,
    IMPACT_SWEEP_NUMBER, /* of integers with absent ones, too: those are NaN */
    IMPACT_SWEEP_BOOLEAN,
    IMPACT_SWEEP_STRING
} impact_sweep_kind;

typedef struct impact_sweep_column {
    char name[64];
    impact_sweep_kind kind;
    long count;     /* rows that have it */
    size_t longest; /* bytes of its longest cell */
} impact_sweep_column;

/* A cell as it stands in a row, escaped; text NULL: absent. */
typedef struct impact_sweep_cell {
    const char *text;
    size_t size;
} impact_sweep_cell;

/* Columns: run, the parameters, the results by name, status, message, and last cpu, which stands apart. */
typedef struct impact_sweep_table {
    long runs, rows; /* wanted, and there */
    int parameter_count, column_count;
    impact_sweep_column *columns;
    const char **lines; /* of the rows, by run */
    size_t *sizes;
    size_t longest_words[2]; /* of status and message */
} impact_sweep_table;

/* The cells of a row, as many as there are columns. */
typedef void impact_sweep_split(const impact_sweep_table *table, long row, impact_sweep_cell *cells);
/* A string's cell without its mark and escapes, at most its size bytes; how many there are. */
typedef size_t impact_sweep_plain(impact_sweep_cell cell, char *text);

/* ---- HDF5: a variable `impact_sweep_hdf5_writer` of this type ---- */

typedef struct impact_sweep_hdf5 {
    /* Writes the table /runs to path, which is new; NULL, or what went wrong. */
    const char *(*write)(const char *path, const impact_sweep_table *table, impact_sweep_split *split,
                         impact_sweep_plain *plain);
} impact_sweep_hdf5;

#endif
