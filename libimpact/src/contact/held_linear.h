/* SPDX-License-Identifier: MIT
 *
 * held_linear: square linear systems, and where they leave something open, their solution of least norm. Internal.
 */
#ifndef IMP_HELD_LINEAR_H
#define IMP_HELD_LINEAR_H

#include <stdbool.h>

/* A system of n equations, taken apart; the arrays are the caller's. */
typedef struct imp_linear {
    int n, rank;
    double doubtful;     /* pivots under this part of the greatest element are looked at again, by complete pivoting */
    double vanishing;    /* of the greatest element: pivots under it are none; 0: 1e-12 */
    int sign;            /* of the determinant; 0 where equations are missing */
    double *matrix;      /* n^2: comes in by rows, and is spent */
    double *spare;       /* n^2 of scratch */
    double *scratch;     /* n of scratch */
    int *rows, *columns; /* n each */
} imp_linear;

/* Takes the matrix apart by Gauss' elimination, with complete pivoting if pivots under 1e-12 of the greatest element,
 * or under `doubtful`, show that the equations do not determine all unknowns. */
void imp_linear_factor(imp_linear *system);

/* The same where no pivot but zero is refused: false of those. The matrix is badly conditioned, and known to be. */
bool imp_linear_factor_regular(imp_linear *system);

/* In four sums, whose order is fixed: one sum would wait for each of its additions. */
double imp_linear_dot(const double *a, const double *b, int n);

/* x, in place of the right-hand side: of all that satisfy the equations that tell something, the one of least norm. */
void imp_linear_solve(const imp_linear *system, double *x);

#endif
