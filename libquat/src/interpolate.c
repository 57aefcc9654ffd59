/* SPDX-License-Identifier: MIT */
#include <quat/interpolate.h>
#include <quat/rotation.h>
#include <quat/exponential.h>
#include <quat/jacobian.h>
#include <float.h>
#include "dd.h"
#include "slerp_kernel.h"

/* ---- nlerp ---- */

quat quat_nlerp_as_given(quat p, quat q, double t)
{
    if (t == 0) return p;
    if (t == 1) return q;
    const quat sum = quat_axpy(t, q, quat_scale(p, 1 - t));
    if (!quat_isfinite(sum)) return quat_make(NAN, NAN, NAN, NAN);
    quat unit;
    return quat_normalize(sum, &unit) == QUAT_OK ? unit : p;
}

quat quat_nlerp(quat p, quat q, double t) { return quat_nlerp_as_given(p, quat_nearest(q, p), t); }

/* ---- slerp ---- */

/* d - g (d.g)/(g.g): what of d is perpendicular to g. d may be tiny and g not: the dot product in twice the
 * precision. */
static inline quat perpendicular(quat d, quat g)
{
    const double a[4] = {d.w, d.x, d.y, d.z}, b[4] = {g.w, g.x, g.y, g.z};
    return quat_axpy(-quat_dot4_plus(0, a, b).hi / quat_norm2(g), g, d);
}

/* The great circle for any t and any angle up to pi. p + q and p - q are perpendicular but for the rounding of |p| and
 * |q|; the smaller of them, exact where it is small, is made perpendicular to the larger. */
QUAT_FMA_CLONES
static quat great_circle(quat p, quat q, double t)
{
    quat sum = quat_add(p, q), difference = quat_sub(q, p);
    if (quat_dot(p, q) < 0)
        sum = perpendicular(sum, difference);
    else
        difference = perpendicular(difference, sum);
    const double long_sum = quat_norm(sum), long_difference = quat_norm(difference);
    if (long_difference == 0 && !isnan(t)) return p;
    const quat middle = long_sum > DBL_MIN ? quat_scale(sum, 1 / long_sum) : quat_mul(p, quat_make(0, 1, 0, 0));
    const double angle = (2 * t - 1) * atan2(long_difference, long_sum);
    if (isnan(angle)) return quat_make(NAN, NAN, NAN, NAN);
    return quat_axpy(sin(angle) / long_difference, difference, quat_scale(middle, cos(angle)));
}

/* For 0 < t < 1, from p to side q, side = +-1 such that they are no more than a right angle apart. */
static inline quat short_slerp(quat p, quat q, double side, double t)
{
    double a, b;
    quat_slerp_weights(0.25 * quat_norm2(quat_axpy(-side, p, q)), 2 * t - 1, &a, &b);
    /* most of the error by now is one of length */
    return quat_renormalize(quat_axpy(side * b, q, quat_scale(p, a)));
}

quat quat_slerp(quat p, quat q, double t)
{
    /* the sign as a number: as a branch it would be mispredicted every second time */
    if (t > 0 && t < 1) return short_slerp(p, q, copysign(1, quat_dot(p, q)), t);
    if (t == 0) return p;
    const quat near = quat_nearest(q, p);
    return t == 1 ? near : great_circle(p, near, t);
}

quat quat_slerp_as_given(quat p, quat q, double t)
{
    if (t == 0) return p;
    if (t == 1) return q;
    if (t > 0 && t < 1 && quat_dot(p, q) >= 0) return short_slerp(p, q, 1, t);
    return great_circle(p, q, t);
}

/* ---- angular velocities ---- */

/* 2 log(q p*), through the perpendicular difference where q p* would cancel. Between opposite points that of the circle
 * which is taken there, through p i. */
qvec3 quat_slerp_as_given_omega(quat p, quat q)
{
    static const double two_pi = 6.283185307179586;
    if (quat_dot(p, q) < 0 && quat_norm(perpendicular(quat_add(p, q), quat_sub(q, p))) <= DBL_MIN)
        return quat_rotate(p, qvec3_make(two_pi, 0, 0));
    return qvec3_scale(quat_log_unit(quat_mul_compensated(q, quat_conj(p))), 2);
}

qvec3 quat_slerp_omega(quat p, quat q) { return quat_slerp_as_given_omega(p, quat_nearest(q, p)); }

/* With s = (1 - t) p + t q the radial part of s' drops out: 2 vec(s' s*)/|s|^2, s' s* = (q - p) s*. */
qvec3 quat_nlerp_as_given_omega(quat p, quat q, double t)
{
    const quat s = quat_axpy(t, q, quat_scale(p, 1 - t));
    const quat turn = quat_mul_compensated(quat_sub(q, p), quat_conj(s));
    return qvec3_scale(quat_vector(turn), 2 / quat_norm2(s));
}

qvec3 quat_nlerp_omega(quat p, quat q, double t) { return quat_nlerp_as_given_omega(p, quat_nearest(q, p), t); }

/* ---- squad ---- */

quat quat_squad(quat p, quat a, quat b, quat q, double t)
{
    if (t == 0) return p;
    if (t == 1) return q;
    return quat_slerp_as_given(quat_slerp_as_given(p, q, t), quat_slerp_as_given(a, b, t), 2 * t * (1 - t));
}

/* log(q* p) for unit p and q. */
static qvec3 relative_log(quat q, quat p) { return quat_log_unit(quat_mul_compensated(quat_conj(q), p)); }

quat quat_squad_control(quat before, quat q, quat after)
{
    const qvec3 sum = qvec3_add(relative_log(q, before), relative_log(q, after));
    return quat_mul(q, quat_exp_pure(qvec3_scale(sum, -0.25)));
}

/* squad = P exp(k L) with P and A the two slerps, L = log(P* A) and k = 2t(1 - t). */
qvec3 quat_squad_omega(quat p, quat a, quat b, quat q, double t)
{
    const quat outer = quat_slerp_as_given(p, q, t), inner = quat_slerp_as_given(a, b, t);
    const quat d_outer = quat_scale(quat_mul(quat_pure(quat_slerp_as_given_omega(p, q)), outer), 0.5);
    const quat d_inner = quat_scale(quat_mul(quat_pure(quat_slerp_as_given_omega(a, b)), inner), 0.5);
    const quat between = quat_mul_compensated(quat_conj(outer), inner);
    const quat d_between = quat_add(quat_mul(quat_conj(d_outer), inner), quat_mul(quat_conj(outer), d_inner));
    const qvec3 l = quat_log_unit(between);
    const qmat34 dlog = quat_log_jacobian(between);
    double dl[3];
    for (int i = 0; i < 3; i++)
        dl[i] = dlog.m[i][0] * d_between.w + dlog.m[i][1] * d_between.x + dlog.m[i][2] * d_between.y +
                dlog.m[i][3] * d_between.z;
    const double k = 2 * t * (1 - t), dk = 2 - 4 * t;
    const qvec3 dv = qvec3_axpy(k, qvec3_make(dl[0], dl[1], dl[2]), qvec3_scale(l, dk));
    /* (P e)' (P e)* = P' P* + P (e' e*) P*, and 2 e' e* = J_left(2kL) (2kL)' */
    const qmat3 j = quat_rotation_vector_jacobian_left(qvec3_scale(l, 2 * k));
    const qvec3 inner_omega = qmat3_apply(&j, qvec3_scale(dv, 2));
    const quat turned = quat_mul(quat_mul(outer, quat_pure(inner_omega)), quat_conj(outer));
    return qvec3_add(quat_slerp_as_given_omega(p, q), quat_vector(turned));
}

/* ---- recorded curves ---- */

size_t quat_unflip(size_t n, quat q[], int *monodromy)
{
    size_t changed = 0;
    for (size_t i = 1; i < n; i++) {
        if (!(quat_dot(q[i - 1], q[i]) < 0)) continue;
        q[i] = quat_neg(q[i]);
        changed++;
    }
    if (monodromy) *monodromy = n > 0 && quat_dot(q[0], q[n - 1]) < 0 ? -1 : 1;
    return changed;
}
