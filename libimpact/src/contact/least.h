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

#endif
