/* SPDX-License-Identifier: MIT
 *
 * least: of rows and columns S of W (symmetric, no eigenvalue under zero, of any rank) the pseudo-inverse W_SS^+, for
 * answers of least norm. Internal.
 */
#ifndef IMP_LEAST_H
#define IMP_LEAST_H

/* W by rows of `width` numbers; which[n]: S, places in W; inverse: n x n. scratch: 3 n^2 + n. A pivot under `rank` of
 * the largest is none. Returns the rank. */
int imp_least_inverse(const double *w, int width, const int *which, int n, double rank, double *scratch,
                      double *inverse);

/* From that inverse the null space of W_SS: N, n x (its dimension, returned) with stride n, N^T N = 1.
 * scratch: n^2 + n. */
int imp_least_null(const double *w, int width, const int *which, int n, const double *inverse, double *scratch,
                   double *basis);

/* Solves A x = b in place of b, A of order m symmetric with no eigenvalue under zero, its lower half given and lost;
 * what has no pivot stays 0. */
void imp_least_solve(double *a, int m, double *b);

/* Solves A x = b in place of b (n), A (n x n) symmetric with no eigenvalue under zero, for those rows that are
 * independent: each as its pivot is the largest left, as far as that is over `rank` of the largest; x is 0 at the
 * others. order[n], scratch: n^2 + n. Returns the rank. */
int imp_least_solve_pivoted(const double *a, int n, double rank, double *scratch, int *order, double *b);

#endif
