/* SPDX-License-Identifier: MIT
 *
 * M = (w1 + w2) I - [r1] J1^-1 [r1] - [r2] J2^-1 [r2] is never formed as a difference: with arms r x e in each body's axes,
 * e.M f = (w1 + w2) e.f + sum (r x e).J^-1 (r x f), so that every entry is a sum of products.
 */
#include "collide_frame.h"

#include <float.h>

/* r x e for both bodies, local axes. */
typedef struct arms {
    qvec3 of[2];
} arms;

static inline arms make_arms(const impact_ready ready[2], qvec3 e)
{
    return (arms){{qvec3_cross(ready[0].offset, impact_ready_local(&ready[0], e)),
                   qvec3_cross(ready[1].offset, impact_ready_local(&ready[1], e))}};
}

/* sum p.J^-1 q */
static inline double arms_dot(const impact_ready ready[2], const arms *p, const arms *q)
{
    return qvec3_dot(p->of[0], impact_ready_spin(&ready[0], q->of[0])) +
           qvec3_dot(p->of[1], impact_ready_spin(&ready[1], q->of[1]));
}

static inline arms arms_mix(double x, const arms *p, double y, const arms *q)
{
    return (arms){
        {qvec3_axpy(y, q->of[0], qvec3_scale(p->of[0], x)), qvec3_axpy(y, q->of[1], qvec3_scale(p->of[1], x))}};
}

/* A unit vector across n, without a branch that jumps near the poles (Duff et al. 2017). */
static qvec3 across(qvec3 n)
{
    const double sign = copysign(1, n.z), f = -1 / (sign + n.z);
    return (qvec3){1 + sign * n.x * n.x * f, sign * n.x * n.y * f, -sign * n.x};
}

/* The largest root of l^3 - e1 l^2 + e2 l - e3, all three real and positive, to 0.1 %: e1/3 + 2q cos(phi/3), and of cos(phi) =
 * 2y^2 - 1 it is cos(phi/3) = cos(2/3 acos y), nearly a parabola in y. */
static double largest_root(double e1, double e2, double e3)
{
    const double d = impact_larger(e1 * e1 - 3 * e2, 1e-30 * e1 * e1), q = sqrt(d);
    const double cosine = (e1 * (2 * e1 * e1 - 9 * e2) + 27 * e3) / (2 * d * q);
    const double y = sqrt(impact_smaller(impact_larger(0.5 + 0.5 * cosine, 0), 1));
    return (e1 + 2 * q * (0.500734 + y * (0.562841 - 0.064169 * y))) / 3;
}

/* Largest over smallest root: that is the largest root times that of the reversed polynomial. */
static double conditioning(double trace, double second, double det)
{
    const double f = 1 / det;
    return impact_larger(largest_root(trace, second, det) * largest_root(second * f, trace * f, f), 1);
}

qvec3 impact_frame_normal(const impact_collision *collision)
{
    const qvec3 given = collision->normal;
    const double length2 = qvec3_dot(given, given);
    const double length = length2 > 1e-200 && length2 < 1e200 ? sqrt(length2) : qvec3_norm(given);
    return (qvec3){given.x / length, given.y / length, given.z / length};
}

void impact_frame_make(qvec3 n, const impact_ready ready[2], impact_frame *frame)
{
    const double w = ready[0].inverse_mass + ready[1].inverse_mass;
    qvec3 t1 = across(n), t2 = qvec3_cross(n, t1);
    arms x = make_arms(ready, t1), y = make_arms(ready, t2);
    const arms z = make_arms(ready, n);
    const double m = w + arms_dot(ready, &z, &z), f = 1 / m;
    double a = w + arms_dot(ready, &x, &x), b = w + arms_dot(ready, &y, &y);
    /* One-sided Jacobi: turn t1, t2 until M_xy is rounding. */
    for (int sweep = 0; sweep < 3; sweep++) {
        const double xy = arms_dot(ready, &x, &y);
        if (xy * xy <= 16 * DBL_EPSILON * DBL_EPSILON * (a * b)) break;
        const double h = (b - a) * f, g = 2 * xy * f, r = fabs(h) + sqrt(h * h + g * g);
        const double shrink = 1 / sqrt(r * r + g * g), cs = r * shrink, sn = copysign(g * shrink, g * h);
        const arms old = x;
        const qvec3 old_t1 = t1;
        x = arms_mix(cs, &old, -sn, &y);
        y = arms_mix(sn, &old, cs, &y);
        t1 = qvec3_axpy(-sn, t2, qvec3_scale(old_t1, cs));
        t2 = qvec3_axpy(sn, old_t1, qvec3_scale(t2, cs));
        a = w + arms_dot(ready, &x, &x);
        b = w + arms_dot(ready, &y, &y);
    }
    const double c = arms_dot(ready, &x, &z), d = arms_dot(ready, &y, &z);
    /* What the best alpha t1 + beta t2 leaves of n: at the least, rounding of alpha and beta counts but squared. */
    const double alpha = -c / a, beta = -d / b;
    const arms least = arms_mix(alpha, &x, beta, &y), rest = arms_mix(1, &z, 1, &least);
    const double k = w * (1 + (alpha * alpha + beta * beta)) + arms_dot(ready, &rest, &rest);
    *frame = (impact_frame){
        .t1 = t1, .t2 = t2, .n = n, .a = a * f, .b = b * f, .c = c * f, .d = d * f, .k = k * f, .scale = m};
    const double A = frame->a, B = frame->b, K = frame->k;
    frame->conditioning = conditioning(
        A + B + 1, A * B + A * (K + frame->d * frame->d / B) + B * (K + frame->c * frame->c / A), A * B * K);
}

qvec3 impact_frame_velocity(const impact_collision *collision)
{
    const impact_collider *one = &collision->body[0], *two = &collision->body[1];
    return qvec3_sub(qvec3_add(one->velocity, qvec3_cross(one->omega, one->offset)),
                     qvec3_add(two->velocity, qvec3_cross(two->omega, two->offset)));
}
