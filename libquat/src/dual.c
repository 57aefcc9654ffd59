/* SPDX-License-Identifier: MIT */
#include <quat/dual.h>
#include <quat/jacobian.h>

quat_status quat_dual_inverse(qdual p, qdual *inverse)
{
    quat r;
    *inverse = quat_dual_identity();
    if (!quat_isfinite(p.dual)) return QUAT_EDOMAIN;
    const quat_status status = quat_inverse(p.real, &r);
    if (status != QUAT_OK) return status;
    const quat d = quat_neg(quat_mul(quat_mul(r, p.dual), r));
    if (!quat_isfinite(d)) return QUAT_ERANGE;
    *inverse = quat_dual_make(r, d);
    return QUAT_OK;
}

quat_status quat_dual_normalize(qdual p, qdual *unit)
{
    quat r;
    *unit = quat_dual_identity();
    if (!quat_isfinite(p.dual) || quat_normalize(p.real, &r) != QUAT_OK) return QUAT_EDOMAIN;
    const quat d = quat_scale(p.dual, 1 / quat_norm(p.real)), across = quat_axpy(-quat_dot(r, d), r, d);
    if (!quat_isfinite(across)) return QUAT_ERANGE;
    *unit = quat_dual_make(r, across);
    return QUAT_OK;
}

qdual quat_dual_exp(qtwist twist)
{
    const qmat3 j = quat_rotation_vector_jacobian_left(twist.rotation);
    return quat_dual_from(quat_from_rotation_vector(twist.rotation), qmat3_apply(&j, twist.translation));
}

qtwist quat_dual_log(qdual p)
{
    const qvec3 rotation = quat_to_rotation_vector(p.real);
    const qmat3 j = quat_rotation_vector_jacobian_left_inverse(rotation);
    const qtwist twist = {rotation, qmat3_apply(&j, quat_dual_shift(p))};
    return twist;
}

qdual quat_dual_sclerp(qdual p, qdual q, double t)
{
    if (t == 0) return p;
    if (t == 1) return quat_dot(p.real, q.real) < 0 ? quat_dual_scale(q, -1) : q;
    const qtwist whole = quat_dual_log(quat_dual_mul(quat_dual_conj(p), q));
    const qtwist part = {qvec3_scale(whole.rotation, t), qvec3_scale(whole.translation, t)};
    return quat_dual_mul(p, quat_dual_exp(part));
}

quat_status quat_dual_to_screw(qdual p, qvec3 *axis, qvec3 *point, double *angle, double *slide)
{
    qdual unit;
    quat_status status = quat_dual_normalize(p, &unit);
    qtwist twist = quat_dual_log(unit);
    if (!isfinite(qvec3_norm(twist.translation))) {
        status = QUAT_ERANGE;
        twist = quat_dual_log(quat_dual_identity());
    }
    *point = qvec3_make(0, 0, 0);
    *angle = qvec3_norm(twist.rotation);
    if (qvec3_normalize(twist.rotation, axis) == QUAT_OK) {
        /* the translation rate is slide n - rotation x point */
        *slide = qvec3_dot(*axis, twist.translation);
        *point = qvec3_scale(qvec3_cross(*axis, twist.translation), 1 / *angle);
        if (qvec3_isfinite(*point)) return QUAT_OK;
        *point = qvec3_make(0, 0, 0); /* an axis out of the range of doubles: as good as a shift */
    }
    *angle = 0;
    *slide = qvec3_norm(twist.translation);
    qvec3_normalize(twist.translation, axis);
    return status == QUAT_OK ? QUAT_NOT_UNIQUE : status;
}

/* x - R x, without the difference: a line far away is turned about by little. */
static qvec3 turned_away(quat q, qvec3 x)
{
    const qvec3 v = quat_vector(q), across = qvec3_cross(v, x);
    return qvec3_scale(qvec3_axpy(q.w, across, qvec3_cross(v, across)), -2);
}

quat_status quat_dual_from_screw(qvec3 axis, qvec3 point, double angle, double slide, qdual *p)
{
    quat q;
    qvec3 n;
    *p = quat_dual_identity();
    if (qvec3_normalize(axis, &n) != QUAT_OK || quat_from_axis_angle(n, angle, &q) != QUAT_OK) return QUAT_EDOMAIN;
    if (!qvec3_isfinite(point) || !isfinite(slide)) return QUAT_EDOMAIN;
    const qdual motion = quat_dual_from(q, qvec3_axpy(slide, n, turned_away(q, point)));
    if (!quat_isfinite(motion.dual)) return QUAT_ERANGE;
    *p = motion;
    return QUAT_OK;
}

quat_status quat_dual_blend(size_t n, const qdual p[], const double weights[], qdual *blend)
{
    *blend = quat_dual_identity();
    if (n == 0) return QUAT_EARGUMENT;
    qdual sum = {{0, 0, 0, 0}, {0, 0, 0, 0}};
    for (size_t i = 0; i < n; i++) {
        const double side = quat_dot(p[i].real, p[0].real) < 0 ? -1 : 1, w = weights ? weights[i] : 1;
        sum = quat_dual_add(sum, quat_dual_scale(p[i], side * w));
    }
    return quat_dual_normalize(sum, blend);
}
