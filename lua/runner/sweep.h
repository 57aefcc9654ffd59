/* SPDX-License-Identifier: MIT
 *
 * impact sweep, impact gather: many scenes of one script. Its parts: sweep.c (the commands), sweep_workers.c (threads,
 * a Lua state each), sweep_parts.c (rows on the disk, as they are done), sweep_table.c (all parts read as one table),
 * sweep_write.c (the table as CSV and for Lua), sweep_ranks.c (what MPI and HDF5 add, loaded when asked for).
 *
 * A process appends its rows to a file of its own, NAME.SHARD-K.rows: a line that says of which sweep they are, then
 * blocks, each with its size and checksum. A block that a dead process left unfinished is not read. What is in the
 * blocks is done; the rest is still to do.
 */
#ifndef IMPACT_SWEEP_H
#define IMPACT_SWEEP_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include "runner.h"
#include "sweep_extra.h"

/* Which sweep: all of it goes into a part's first line. */
typedef struct impact_sweep_id {
    char name[200];
    uint64_t hash; /* of version, script and arguments */
    long runs;
    char parameters[2000]; /* names, commas between */
} impact_sweep_id;

/* ---- sweep_parts.c ---- */

/* One block of rows as text. */
typedef struct impact_sweep_block {
    char *text;
    size_t size, room;
} impact_sweep_block;

uint64_t impact_sweep_hash(uint64_t hash, const void *bytes, size_t size);
/* Appends; false: out of memory. */
bool impact_sweep_add(impact_sweep_block *block, const char *text, size_t size);
/* A new part in the output folder: its descriptor; -1 with a message. */
int impact_sweep_new_part(impact_runner *runner, const impact_sweep_id *id, char *message, size_t size);
/* Appends a block and empties it; false with errno. */
bool impact_sweep_write_block(impact_runner *runner, int part, impact_sweep_block *block);

/* A part read: its good blocks, one after another. */
typedef struct impact_sweep_part {
    impact_sweep_id id;
    char *text; /* of the whole file */
    size_t size;
} impact_sweep_part;

/* The parts of the folder, of one name or, with NULL, of all; their number, or -1 with a message. */
int impact_sweep_read_parts(impact_runner *runner, const char *name, impact_sweep_part **parts, char *message,
                            size_t size);
void impact_sweep_free_parts(impact_sweep_part *parts, int count);
/* The next line of the part's rows, without its end, from *at on; NULL: no more. */
const char *impact_sweep_next_line(const impact_sweep_part *part, size_t *at, size_t *length);

/* ---- sweep_table.c ---- */

/* The rows of the parts that have the id's name, in the order of their runs; false with a message. */
bool impact_sweep_gather(const impact_sweep_part *parts, int count, const impact_sweep_id *id,
                         impact_sweep_table *table, char *message, size_t size);
void impact_sweep_free_table(impact_sweep_table *table);

/* ---- sweep_write.c ---- */

/* NAME.csv and NAME_times.csv (of a table with rows missing: NAME.partial.csv ...), and NAME.h5 by hdf5, unless NULL.
 */
bool impact_sweep_write(impact_runner *runner, const impact_sweep_table *table, const char *name,
                        const impact_sweep_hdf5 *hdf5, char *message, size_t size);
/* Pushes {column = {...}, ...}. */
void impact_sweep_push_table(lua_State *L, const impact_sweep_table *table);

/* ---- sweep_workers.c ---- */

typedef struct impact_sweep {
    impact_runner *runner;
    impact_sweep_id id;
    const char *script; /* text of it */
    size_t script_size;
    int32_t *todo; /* runs of this shard that are not done */
    long todo_count;
    const impact_sweep_ranks *ranks; /* NULL: one process */
    int rank, rank_count;
    pthread_mutex_t gate; /* of the part, the ranks, the message and: */
    pthread_cond_t end;
    int ended; /* threads */
    int part;
    long grain; /* runs taken at a time */
    atomic_long next, done, failed;
    atomic_bool stopped; /* by a failure: */
    int code;
    char message[400];
} impact_sweep;

/* Does what is to do with so many threads; an exit code, with the message when it is not 0. */
int impact_sweep_work(impact_sweep *sweep, int threads);
/* Loads the script's text into L and leaves the sweep that it returns on top. The first state closes the fence, the
 * others are threads'. */
void impact_sweep_load(lua_State *L, impact_runner *runner, const char *script, size_t size, bool first);

/* ---- sweep.c ---- */

/* impact sweep SCRIPT, impact gather DIR: exit codes. */
int impact_runner_sweep(impact_runner *runner);
int impact_runner_gather(impact_runner *runner);

#endif
