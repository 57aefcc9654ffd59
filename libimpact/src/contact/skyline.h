/* SPDX-License-Identifier: MIT
 *
 * skyline: a matrix of 6 x 6 blocks, one row of them for each body, zero but where bodies touch: of each row, and each
 * column, what stands from its first block to the diagonal, in an order of the bodies that keeps both short (Cuthill
 * & McKee 1969, reversed), and its factors (1 + L)(D + U) in their place, without pivots, of the diagonal D^-1.
 * Internal.
 */
#ifndef IMP_SKYLINE_H
#define IMP_SKYLINE_H

#include "base/arena.h"

typedef struct imp_skyline_block {
    double a[6][6];
} imp_skyline_block;

typedef struct imp_skyline {
    imp_arena *arena;
    int bodies;
    int *place;                       /* of each body: its row */
    int *first;                       /* of each row: its first block */
    size_t *start;                    /* of each row: where its blocks begin in the values */
    imp_skyline_block *lower, *upper; /* rows, with the diagonal; columns, whose diagonal is not used */
    double *scratch;                  /* 6 bodies */
    int *degree, *queue;              /* scratch */
    int body_room;
    size_t value_room;
} imp_skyline;

/* Zero, of so many bodies of which these touch: two numbers each, those of static bodies negative. False: there is no
 * room. */
bool imp_skyline_shape(imp_skyline *sky, int bodies, const int (*touching)[2], int count);
void imp_skyline_clear(imp_skyline *sky);

/* Adds to the block of row a, column b: two bodies that touch, or one twice. */
void imp_skyline_add(imp_skyline *sky, int a, int b, double block[6][6]);
/* The same of left^T right. */
void imp_skyline_add_product(imp_skyline *sky, int a, int b, double left[3][6], const double right[3][6]);

/* False: a pivot is zero, or no number. */
bool imp_skyline_factor(imp_skyline *sky);
void imp_skyline_solve(const imp_skyline *sky, double *x);

#endif
