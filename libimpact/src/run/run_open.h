/* SPDX-License-Identifier: MIT
 *
 * run_open: an open record. Internal.
 */
#ifndef IMP_RUN_OPEN_H
#define IMP_RUN_OPEN_H

#include "run/json.h"
#include "run/run.h"
#include "world/world.h"

/* A table in the file, its columns found by name. */
typedef struct imp_run_place {
    const char *at; /* of its first row */
    long rows;
    int width;                        /* columns in the file */
    int column[IMP_RUN_MOST_COLUMNS]; /* where each of ours stands in a row */
} imp_run_place;

typedef struct imp_run_body {
    impact_body_def def;
    impact_hull *hull; /* the shape's, or NULL */
    imp_body flight;   /* what a free flight asks of it; nothing else */
    long first, count; /* of its keys */
} imp_run_body;

typedef struct imp_words {
    const char **word;
    int count;
} imp_words;

struct impact_run {
    imp_arena *arena; /* where all of it stands, itself too, but hulls, which others may share */
    impact_allocator allocator;
    char *bytes;
    size_t size;
    const imp_json *head;
    const char *name, *reason;
    double begin, end, tolerance;
    qvec3 gravity;
    imp_run_body *bodies;
    int body_count;
    imp_words kinds, modes, forces, phases;
    imp_run_place tables[IMP_RUN_TABLES];
};

/* Our columns of a row; those the file has not are 0. */
void imp_run_row(const impact_run *run, int table, long row, double *values);

impact_key imp_run_key(const impact_run *run, int body, long number);

/* Whether the key's form is known, and leads to numbers up to the next. */
bool imp_run_key_is_sound(const impact_run *run, int body, long number);

/* The motion from the body's key of that number on, up to the next key: the state at t. */
impact_key imp_run_after(const impact_run *run, int body, long number, double t);

#endif
