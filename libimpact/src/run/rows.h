/* SPDX-License-Identifier: MIT
 *
 * rows: rows of doubles as they come, in pieces that stay where they are: nothing is copied as they grow. Internal.
 */
#ifndef IMP_ROWS_H
#define IMP_ROWS_H

#include <stdbool.h>
#include "base/arena.h"

typedef struct imp_rows_piece {
    struct imp_rows_piece *next;
    long used, room; /* rows */
    double values[];
} imp_rows_piece;

typedef struct imp_rows {
    imp_rows_piece *first, *last;
    long count;
    int width; /* doubles of a row */
} imp_rows;

/* False: out of memory, and the row is not there. */
bool imp_rows_add(imp_rows *rows, imp_arena *arena, const double *values);
void imp_rows_free(imp_rows *rows, imp_arena *arena);

/* One row after another, from {rows->first, 0} on; NULL behind the last. */
typedef struct imp_rows_cursor {
    const imp_rows_piece *piece;
    long row;
} imp_rows_cursor;
const double *imp_rows_next(const imp_rows *rows, imp_rows_cursor *at);

#endif
