/* SPDX-License-Identifier: MIT
 *
 * rotation: unit quaternions as rotations of space. Conventions in quat.h; Euler angles in euler.h, arrays in batch.h,
 * derivatives in jacobian.h.
 */
#ifndef QUAT_ROTATION_H
#define QUAT_ROTATION_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the operator ---- */

/* v rotated by the unit quaternion q (body to world): the vector part of (q v) q*. As two products it rounds half as
 * much as v + 2 w (u x v) + 2 u x (u x v) and takes about as long. Scales by |q|^2 if q is not unit. For many
 * vectors by the same q, quat_rotate_array. */
QUAT_INLINE qvec3 quat_rotate(quat q, qvec3 v)
{
    const double s = q.x * v.x + q.y * v.y + q.z * v.z; /* q v = -s + a */
    const qvec3 a = qvec3_make(q.w * v.x + (q.y * v.z - q.z * v.y), q.w * v.y + (q.z * v.x - q.x * v.z),
                               q.w * v.z + (q.x * v.y - q.y * v.x));
    return qvec3_make((s * q.x + a.x * q.w) + (q.y * a.z - q.z * a.y), (s * q.y + a.y * q.w) + (q.z * a.x - q.x * a.z),
                      (s * q.z + a.z * q.w) + (q.x * a.y - q.y * a.x));
}

/* The inverse rotation, world to body. */
QUAT_INLINE qvec3 quat_rotate_inverse(quat q, qvec3 v) { return quat_rotate(quat_conj(q), v); }

/* ---- reflections ---- */

/* v mirrored in the plane through the origin with unit normal n: v - 2 (n.v) n = n v n. Its determinant is -1: it is no
 * rotation; two of them are. */
QUAT_INLINE qvec3 quat_reflect(qvec3 n, qvec3 v) { return qvec3_axpy(-2 * qvec3_dot(n, v), n, v); }

/* The rotation that mirrors in the plane of unit normal n1 first, then in that of n2: -n2 n1 = (n1.n2, n1 x n2), which
 * turns by twice the angle from n1 to n2 (thesis, theorem 5, with its sign corrected). */
QUAT_INLINE quat quat_from_reflections(qvec3 n1, qvec3 n2)
{
    return quat_from_parts(qvec3_dot(n1, n2), qvec3_cross(n1, n2));
}

/* ---- axis and angle ---- */

/* The unit quaternion of the rotation vector r (axis times angle, radians); r = 0 gives 1. NaN for infinite and NaN. */
QUAT_API quat quat_from_rotation_vector(qvec3 r);

/* The rotation vector of unit q, length 0 ... pi, the same for q and -q. A half turn (w = 0) takes the direction of q's
 * own vector part. */
QUAT_API qvec3 quat_to_rotation_vector(quat q);

/* Rotation by angle (radians) about axis (any finite non-zero length). QUAT_EDOMAIN and *q = 1 otherwise. */
QUAT_API quat_status quat_from_axis_angle(qvec3 axis, double angle, quat *q);

/* Unit axis and angle in 0 ... pi of a non-zero q, the same for q and -q. A q without vector part gives angle 0,
 * axis (1, 0, 0) and QUAT_NOT_UNIQUE. QUAT_EDOMAIN (the same values) for zero, infinite and NaN. */
QUAT_API quat_status quat_to_axis_angle(quat q, qvec3 *axis, double *angle);

/* ---- matrices ---- */

/* The rotation matrix of the unit quaternion q: its columns are the body axes in the world. */
QUAT_INLINE qmat3 quat_to_matrix(quat q)
{
    const double x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    const double xx = q.x * x2, yy = q.y * y2, zz = q.z * z2;
    const double xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
    const double wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
    const qmat3 r = {
        {{1 - (yy + zz), xy - wz, xz + wy}, {xy + wz, 1 - (xx + zz), yz - wx}, {xz - wy, yz + wx, 1 - (xx + yy)}}};
    return r;
}

/* The unit quaternion of a rotation matrix m, w >= 0: the longest row of 4 q q^T (Shepperd 1978), normalised, so that
 * the result is a unit quaternion whatever the noise in m. QUAT_EDOMAIN and *q = 1 when m has an infinite or NaN
 * element or one beyond 1e140, and when it is zero or vanishes beside 1. For a matrix that is off by more than
 * rounding, quat_from_matrix_nearest. */
QUAT_INLINE quat_status quat_from_matrix(const qmat3 *m, quat *q)
{
    const double a = m->m[0][0], b = m->m[1][1], c = m->m[2][2];
    const double wx = m->m[2][1] - m->m[1][2], wy = m->m[0][2] - m->m[2][0], wz = m->m[1][0] - m->m[0][1];
    const double xy = m->m[1][0] + m->m[0][1], xz = m->m[0][2] + m->m[2][0], yz = m->m[2][1] + m->m[1][2];
    const double ww = 1 + ((a + b) + c), xx = 1 + ((a - b) - c), yy = 1 + ((b - a) - c), zz = 1 + ((c - a) - b);
    const double rows[4][4] = {{ww, wx, wy, wz}, {wx, xx, xy, xz}, {wy, xy, yy, yz}, {wz, xz, yz, zz}};
    /* chosen by arithmetic: branches would be mispredicted for random rotations */
    const unsigned x = xx > ww, z = zz > yy, second = (zz > yy ? zz : yy) > (xx > ww ? xx : ww);
    const double *const r = rows[(x & ~(0u - second)) | ((2 + z) & (0u - second))];
    const double n2 = (r[0] * r[0] + r[1] * r[1]) + (r[2] * r[2] + r[3] * r[3]);
    if (!(n2 > 1 && n2 <= 1e280)) { /* 4 or more for a rotation, 1 for zeros */
        *q = quat_identity();
        return QUAT_EDOMAIN;
    }
    const double s = copysign(1 / sqrt(n2), r[0]);
    *q = quat_make(r[0] * s, r[1] * s, r[2] * s, r[3] * s);
    return QUAT_OK;
}

/* The rotation nearest to m in the Frobenius norm, w >= 0: the polar factor, as the leading eigenvector of
 * Bar-Itzhack's (2000) symmetric 4 x 4 matrix, by Jacobi's method. *distance (may be NULL) gets |R - m|_F, infinite
 * when that overflows. QUAT_NOT_UNIQUE when several rotations are equally near (rank below 2, or a reflection with
 * equal singular values); QUAT_EDOMAIN, *q = 1 and *distance = NaN for a zero, infinite or NaN m. */
QUAT_API quat_status quat_from_matrix_nearest(const qmat3 *m, quat *q, double *distance);

/* ---- from vectors ---- */

/* The shortest rotation that carries the direction of a to that of b (any finite non-zero lengths). Opposite
 * directions: a half turn about a x e, e the coordinate axis least along a, and QUAT_NOT_UNIQUE. QUAT_EDOMAIN and
 * *q = 1 for zero, infinite and NaN. */
QUAT_API quat_status quat_from_two_vectors(qvec3 a, qvec3 b, quat *q);

/* The rotation whose body x axis is along x and whose y axis is in the half plane of x and y (Gram-Schmidt); w >= 0.
 * QUAT_EDOMAIN and *q = 1 for zero, infinite and NaN and for x and y that are parallel but for rounding (4e-16 rad). */
QUAT_API quat_status quat_from_axes(qvec3 x, qvec3 y, quat *q);

/* The rotation nearest to the frame with columns x, y, z, as quat_from_matrix_nearest; exact frames give their own. */
QUAT_API quat_status quat_from_frame(qvec3 x, qvec3 y, qvec3 z, quat *q);

/* q/|q| = swing twist: the twist turns about `axis` (body; any non-zero length), the swing about an axis perpendicular
 * to it. The twist has w >= 0. A q that turns `axis` to its opposite leaves the twist open: twist = 1, swing = q/|q|
 * and QUAT_NOT_UNIQUE. QUAT_EDOMAIN with the same values for a zero, infinite or NaN axis, and with swing = 1 for such
 * a q. */
QUAT_API quat_status quat_swing_twist(quat q, qvec3 axis, quat *swing, quat *twist);

/* ---- angular velocity (rad/s) ---- */

/* dq/dt of unit q turning at omega in world axes: (0, omega) q / 2. */
QUAT_INLINE quat quat_derivative_world(quat q, qvec3 omega) { return quat_scale(quat_mul(quat_pure(omega), q), 0.5); }
/* The same with omega in body axes: q (0, omega) / 2. */
QUAT_INLINE quat quat_derivative_body(quat q, qvec3 omega) { return quat_scale(quat_mul(q, quat_pure(omega)), 0.5); }
/* The angular velocity in world axes of unit q with derivative dq: the vector part of 2 dq q*. */
QUAT_INLINE qvec3 quat_omega_world(quat q, quat dq) { return quat_vector(quat_scale(quat_mul(dq, quat_conj(q)), 2)); }
/* The same in body axes: the vector part of 2 q* dq. */
QUAT_INLINE qvec3 quat_omega_body(quat q, quat dq) { return quat_vector(quat_scale(quat_mul(quat_conj(q), dq), 2)); }

/* q after time dt (s) of turning at a constant omega in world axes: exp(omega dt/2) q. For varying omega,
 * integrate.h. */
QUAT_INLINE quat quat_step_world(quat q, qvec3 omega, double dt)
{
    return quat_mul(quat_from_rotation_vector(qvec3_scale(omega, dt)), q);
}
/* The same with omega in body axes: q exp(omega dt/2). */
QUAT_INLINE quat quat_step_body(quat q, qvec3 omega, double dt)
{
    return quat_mul(q, quat_from_rotation_vector(qvec3_scale(omega, dt)));
}

#ifdef __cplusplus
}
#endif

#endif
