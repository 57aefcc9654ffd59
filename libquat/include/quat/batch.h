/* SPDX-License-Identifier: MIT
 *
 * batch: the hot operations over arrays, in C loops that the compiler turns into vector instructions. Conventions in
 * quat.h.
 *
 * Every result has the bits of the one-at-a-time function unless said otherwise, on every machine. `out` may be the
 * same array as an input (in place), but must not overlap it shifted. n = 0 is allowed, with any pointers.
 */
#ifndef QUAT_BATCH_H
#define QUAT_BATCH_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- many vectors by one rotation: the matrix of unit q is made once, the last bits differ from quat_rotate's ---- */

/* out[i] = q in[i] q*, points one after the other (x y z x y z ...). */
QUAT_API void quat_rotate_array(quat q, size_t n, const qvec3 in[], qvec3 out[]);
/* The same with a separate array for each component. */
QUAT_API void quat_rotate_soa(quat q, size_t n, const double *x, const double *y, const double *z, double *out_x,
                              double *out_y, double *out_z);

/* Where an array of vectors lies: component c of point i is at data[i * point + c * component]; strides in doubles, of
 * either sign. {data, 3, 1} is an array of points, {data, 1, n} n x's followed by n y's and n z's. */
typedef struct quat_strided {
    double *data;
    ptrdiff_t point, component;
} quat_strided;
/* The same for any layout; in.data is only read. */
QUAT_API void quat_rotate_strided(quat q, size_t n, quat_strided in, quat_strided out);

/* ---- element by element ---- */

/* out[i] = q[i] v[i] q[i]*. */
QUAT_API void quat_rotate_each(size_t n, const quat q[], const qvec3 v[], qvec3 out[]);
/* out[i] = p[i] q[i]. */
QUAT_API void quat_mul_array(size_t n, const quat p[], const quat q[], quat out[]);
/* out[i] = q[i]/|q[i]|, as right as quat_normalize's and quicker; the last bits may differ. QUAT_OK, or QUAT_EDOMAIN
 * when some cannot be normalised: those become 1, and *first_bad (may be NULL) is the index of the first; n when there
 * is none. */
QUAT_API quat_status quat_normalize_array(size_t n, const quat q[], quat out[], size_t *first_bad);
/* out[i] = quat_to_matrix(q[i]). */
QUAT_API void quat_to_matrix_array(size_t n, const quat q[], qmat3 out[]);
/* out[i] = quat_from_matrix(m[i]); status and *first_bad as quat_normalize_array. */
QUAT_API quat_status quat_from_matrix_array(size_t n, const qmat3 m[], quat out[], size_t *first_bad);
/* out[i] = quat_slerp(p[i], q[i], t[i]), 0 <= t[i] <= 1, short way; NaN for a t outside. */
QUAT_API void quat_slerp_array(size_t n, const quat p[], const quat q[], const double t[], quat out[]);

/* ---- all into one ---- */

/* q[0] q[1] ... q[n-1]: as rotations the last is applied first; 1 for n = 0. The product is made in eight runs of
 * neighbours, which are then multiplied in order: the rounding differs from one long chain, the order of factors does
 * not. Lengths multiply; for unit quaternions the drift, about n/4 rounding units, is left in. */
QUAT_API quat quat_compose_array(size_t n, const quat q[]);

#ifdef __cplusplus
}
#endif

#endif
