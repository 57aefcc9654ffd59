/* SPDX-License-Identifier: MIT
 *
 * average: means of rotations, and the rotation that aligns two sets of vectors. Conventions in quat.h.
 *
 * The means are the leading eigenvectors of symmetric 4 x 4 matrices; Jacobi's method finds them to rounding without
 * allocating and cannot fail, so this room needs libm only. q and -q count as the same rotation throughout.
 */
#ifndef QUAT_AVERAGE_H
#define QUAT_AVERAGE_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The mean of n rotations (q/|q| counts) that minimises sum w |R(q) - R(q_i)|_F^2: the leading eigenvector of the sum
 * of w q q^T (Markley, Cheng, Crassidis, Oshman 2007), w >= 0. weights may be NULL (all 1). QUAT_NOT_UNIQUE when the
 * two largest eigenvalues agree to rounding (two opposite half turns, for instance). QUAT_EARGUMENT for n = 0;
 * QUAT_EDOMAIN for a quaternion that cannot be normalised, for negative, infinite or NaN weights, and when all weights
 * are 0; *mean = 1 then. */
QUAT_API quat_status quat_mean(size_t n, const quat q[], const double weights[], quat *mean);

/* The Karcher mean: minimises the weighted sum of squared rotation angles. Newton-like iteration q exp(average of the
 * logarithms) from the Markley mean, to rounding; *spread (may be NULL) gets the root mean square angle (rad).
 * QUAT_NOT_CONVERGED after 100 rounds; unique for rotations within pi/2 of their mean, a local minimum otherwise.
 * Other statuses as quat_mean's, *spread = NaN with the errors. */
QUAT_API quat_status quat_mean_karcher(size_t n, const quat q[], const double weights[], quat *mean, double *spread);

/* Wahba's (1965) problem: the q that minimises sum w |b_i - R(q) a_i|^2; w >= 0. The vectors may have any length. From
 * the better of Davenport's q-method and TRIAD, by Newton's steps on an orthogonal factorisation: vectors within an
 * angle s of each other cost 1/s of the digits, as in the data. *residual (may be NULL) gets the root mean square of
 * |b_i - R a_i|, weighted; infinite when that overflows. QUAT_NOT_UNIQUE when rounding of the data may turn the answer
 * by more than 4e-3 rad (all parallel, for instance; see quat_align_error); QUAT_NOT_CONVERGED after 40 steps;
 * QUAT_EARGUMENT for n = 0; QUAT_EDOMAIN for infinite or NaN vectors, bad weights and when in every pair one vector or
 * the weight is 0; *q = 1 and *residual = NaN then. */
QUAT_API quat_status quat_align(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat *q,
                                double *residual);

/* Kabsch (1976): the rigid motion b = R(q) a + shift that fits two sets of points best. Centroids are taken off first;
 * otherwise as quat_align, QUAT_NOT_UNIQUE also when all points of a set coincide (q = 1 then), and QUAT_ERANGE with
 * *q = 1, *shift = 0 and *residual = NaN when differences of points or the shift overflow. */
QUAT_API quat_status quat_align_points(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat *q,
                                       qvec3 *shift, double *residual);

/* How far, in rad, roundings of the vectors and of the arithmetic may have turned q, an answer of quat_align or
 * quat_align_points for the same sets: to first order, so that it means little above 0.1; infinite where the sets say
 * nothing of some turn. NaN for what they refuse. */
QUAT_API double quat_align_error(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat q);
QUAT_API double quat_align_points_error(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat q);

#ifdef __cplusplus
}
#endif

#endif
