/* SPDX-License-Identifier: MIT
 *
 * jacobian: derivatives of the operations, as row-major matrices; column order w, x, y, z for quaternions. All are the
 * plain derivatives in R^4 (no constraint |q| = 1) unless their comment says otherwise. Conventions in quat.h.
 */
#ifndef QUAT_JACOBIAN_H
#define QUAT_JACOBIAN_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* m[row][column] */
typedef struct qmat4 {
    double m[4][4];
} qmat4;
typedef struct qmat34 {
    double m[3][4];
} qmat34;
typedef struct qmat43 {
    double m[4][3];
} qmat43;

/* d(p q)/dq: the matrix L with L q = p q. */
QUAT_API qmat4 quat_left_matrix(quat p);
/* d(p q)/dp: the matrix R with R p = p q. */
QUAT_API qmat4 quat_right_matrix(quat q);

/* d(q v q*)/dq at any q (q v q* is quat_rotate for unit q). d(q v q*)/dv is quat_to_matrix(q) for unit q. */
QUAT_API qmat34 quat_rotate_jacobian(quat q, qvec3 v);

/* d exp(0, v)/dv, at every v, series for small ones. */
QUAT_API qmat43 quat_exp_jacobian(qvec3 v);
/* d log_unit(q)/dq for unit q: the derivative of atan2(|u|, w) u/|u|. At q = -1 the logarithm jumps: infinite and NaN
 * elements there; finite everywhere else. */
QUAT_API qmat34 quat_log_jacobian(quat q);

/* For the rotation vector r of body to world, with r changing at dr/dt:
 * omega_world = J_left(r) dr/dt and omega_body = J_right(r) dr/dt, J_right(r) = J_left(-r) = J_left(r)^T.
 * J_left = 1 + (1 - cos a)/a^2 [r]x + (a - sin a)/a^3 [r]x^2, a = |r|. */
QUAT_API qmat3 quat_rotation_vector_jacobian_left(qvec3 r);
QUAT_API qmat3 quat_rotation_vector_jacobian_right(qvec3 r);
/* Their inverses, for |r| < 2 pi (infinite or NaN elements at 2 pi, where they do not exist):
 * 1 - [r]x/2 + (1 - (a/2) cot(a/2))/a^2 [r]x^2. */
QUAT_API qmat3 quat_rotation_vector_jacobian_left_inverse(qvec3 r);
QUAT_API qmat3 quat_rotation_vector_jacobian_right_inverse(qvec3 r);

#ifdef __cplusplus
}
#endif

#endif
