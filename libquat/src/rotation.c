/* SPDX-License-Identifier: MIT */
#include <quat/rotation.h>
#include <quat/exponential.h>
#include "attitude.h"
#include "scale.h"

/* ---- axis and angle ---- */

quat quat_from_rotation_vector(qvec3 r) { return quat_exp_pure(qvec3_scale(r, 0.5)); }

qvec3 quat_to_rotation_vector(quat q) { return qvec3_scale(quat_log_unit(q.w < 0 ? quat_neg(q) : q), 2); }

quat_status quat_from_axis_angle(qvec3 axis, double angle, quat *q)
{
    quat unit;
    const quat_status status = quat_normalize(quat_pure(axis), &unit);
    *q = quat_identity();
    if (status != QUAT_OK || !isfinite(angle)) return QUAT_EDOMAIN;
    const double s = sin(0.5 * angle);
    *q = quat_make(cos(0.5 * angle), s * unit.x, s * unit.y, s * unit.z);
    return QUAT_OK;
}

quat_status quat_to_axis_angle(quat q, qvec3 *axis, double *angle)
{
    *axis = qvec3_make(1, 0, 0);
    *angle = 0;
    if (!quat_isfinite(q) || quat_equal(q, quat_make(0, 0, 0, 0))) return QUAT_EDOMAIN;
    qvec3 n;
    if (qvec3_normalize(quat_vector(q), &n) != QUAT_OK) return QUAT_NOT_UNIQUE;
    *axis = q.w < 0 ? qvec3_neg(n) : n;
    *angle = quat_angle(q);
    return QUAT_OK;
}

/* ---- matrices ---- */

quat_status quat_from_matrix_nearest(const qmat3 *m, quat *q, double *distance)
{
    const quat_status status = quat_attitude(m, q);
    if (!distance) return status;
    const qmat3 r = quat_to_matrix(*q);
    double norm = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) norm = hypot(norm, r.m[i][j] - m->m[i][j]);
    *distance = status < 0 ? NAN : norm;
    return status;
}

/* ---- from vectors ---- */

/* A half turn about a direction perpendicular to unit a. */
static quat half_turn_of(qvec3 a)
{
    const double x = fabs(a.x), y = fabs(a.y), z = fabs(a.z);
    const qvec3 e = x <= y && x <= z ? qvec3_make(1, 0, 0) : y <= z ? qvec3_make(0, 1, 0) : qvec3_make(0, 0, 1);
    quat q;
    quat_normalize(quat_pure(qvec3_cross(a, e)), &q);
    return q;
}

quat_status quat_from_two_vectors(qvec3 a, qvec3 b, quat *q)
{
    qvec3 u, v;
    *q = quat_identity();
    if (qvec3_normalize(a, &u) != QUAT_OK || qvec3_normalize(b, &v) != QUAT_OK) return QUAT_EDOMAIN;
    /* u x v = u x (u + v), and the sum is exact where u and v nearly cancel */
    const qvec3 sum = qvec3_add(u, v), cross = qvec3_cross(u, sum);
    const double s2 = qvec3_dot(sum, sum);
    if (qvec3_norm(cross) <= 1e-16 && s2 < 1) {
        *q = half_turn_of(u);
        return QUAT_NOT_UNIQUE;
    }
    return quat_normalize(quat_from_parts(0.5 * s2, cross), q);
}

quat_status quat_from_axes(qvec3 x, qvec3 y, quat *q)
{
    qvec3 ex, ey, ez;
    *q = quat_identity();
    if (qvec3_normalize(x, &ex) != QUAT_OK || qvec3_normalize(y, &ey) != QUAT_OK) return QUAT_EDOMAIN;
    const qvec3 cross = qvec3_cross(ex, ey);
    if (qvec3_norm(cross) <= 0x1p-51) return QUAT_EDOMAIN; /* parallel as far as ex and ey, rounded, can tell */
    qvec3_normalize(cross, &ez);
    /* nearly parallel x and y leave the cross product askew: square it up once */
    qvec3_normalize(qvec3_axpy(-qvec3_dot(ex, ez), ex, ez), &ez);
    ey = qvec3_cross(ez, ex);
    const qmat3 m = {{{ex.x, ey.x, ez.x}, {ex.y, ey.y, ez.y}, {ex.z, ey.z, ez.z}}};
    return quat_from_matrix(&m, q);
}

quat_status quat_from_frame(qvec3 x, qvec3 y, qvec3 z, quat *q)
{
    const qmat3 m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    return quat_from_matrix_nearest(&m, q, NULL);
}

quat_status quat_swing_twist(quat q, qvec3 axis, quat *swing, quat *twist)
{
    qvec3 unit;
    *twist = quat_identity();
    const quat_status status = quat_normalize(q, swing);
    if (status != QUAT_OK || qvec3_normalize(axis, &unit) != QUAT_OK) return QUAT_EDOMAIN;
    int exponent;
    q = quat_prescale(q, &exponent);
    const quat n = quat_prescale(quat_pure(axis), &exponent);
    /* (w |n|, (v.n) n/|n|), and v.n with no rounding of its own: near a half turn across the axis it is all there is */
    const double along = -quat_mul_compensated(quat_pure(quat_vector(q)), n).w, length = quat_norm(n);
    quat t;
    if (quat_normalize(quat_from_parts(q.w * length, qvec3_scale(unit, along)), &t) != QUAT_OK) return QUAT_NOT_UNIQUE;
    if (t.w < 0) t = quat_neg(t);
    *twist = t;
    *swing = quat_mul(*swing, quat_conj(t));
    return QUAT_OK;
}
