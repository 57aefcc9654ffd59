/* SPDX-License-Identifier: MIT
 *
 * persist_linear: square linear systems, and where they leave something open, their solution of least norm. Internal.
 */
#ifndef IMPACT_PERSIST_LINEAR_H
#define IMPACT_PERSIST_LINEAR_H

#include <stdbool.h>

/* A system of n equations, taken apart; the arrays are the caller's. */
typedef struct impact_linear {
    int n, rank;
    double *matrix;      /* n^2: comes in by rows, and is spent */
    double *spare;       /* n^2 of scratch */
    double *scratch;     /* n of scratch */
    int *rows, *columns; /* n each */
} impact_linear;

/* Takes the matrix apart by Gauss' elimination, with complete pivoting if pivots under 1e-12 of the greatest element
 * show that the equations do not determine all unknowns. */
void impact_linear_factor(impact_linear *system);

/* x, in place of the right-hand side: of all that satisfy the equations that tell something, the one of least norm. */
void impact_linear_solve(const impact_linear *system, double *x);

#endif
