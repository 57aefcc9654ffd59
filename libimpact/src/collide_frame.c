/* SPDX-License-Identifier: MIT
 *
 * M = (w1 + w2) I - [r1] J1^-1 [r1] - [r2] J2^-1 [r2] is never formed as a difference: with arms r x e in each body's axes,
 * e.M f = (w1 + w2) e.f + sum (r x e).J^-1 (r x f), so that every entry is a sum of products.
 */
#include "collide_frame.h"

#include <float.h>

/* A vector for each body, side by side. */
typedef struct vectors {
    impact_pair x, y, z;
} vectors;

typedef struct both {
    vectors axis[3], offset, inverse_moments;
} both;

static inline vectors side_by_side(qvec3 one, qvec3 two)
{
    return (vectors){{one.x, two.x}, {one.y, two.y}, {one.z, two.z}};
}

static inline both make_both(const impact_ready *one, const impact_ready *two)
{
    both r;
    for (int i = 0; i < 3; i++) r.axis[i] = side_by_side(one->axis[i], two->axis[i]);
    r.offset = side_by_side(one->offset, two->offset);
    r.inverse_moments = side_by_side(one->inverse_moments, two->inverse_moments);
    return r;
}

/* r x e, local axes. */
static inline vectors make_arms(const both *bodies, qvec3 e)
{
    const vectors *axis = bodies->axis, *r = &bodies->offset;
    const impact_pair x = axis[0].x * e.x + axis[0].y * e.y + axis[0].z * e.z;
    const impact_pair y = axis[1].x * e.x + axis[1].y * e.y + axis[1].z * e.z;
    const impact_pair z = axis[2].x * e.x + axis[2].y * e.y + axis[2].z * e.z;
    return (vectors){r->y * z - r->z * y, r->z * x - r->x * z, r->x * y - r->y * x};
}

/* sum p.J^-1 q */
static inline double arms_dot(const both *bodies, const vectors *p, const vectors *q)
{
    const vectors *w = &bodies->inverse_moments;
    const impact_pair sum = p->x * (w->x * q->x) + p->y * (w->y * q->y) + p->z * (w->z * q->z);
    return sum[0] + sum[1];
}

static inline vectors arms_mix(double x, const vectors *p, double y, const vectors *q)
{
    return (vectors){x * p->x + y * q->x, x * p->y + y * q->y, x * p->z + y * q->z};
}

/* A unit vector across n, without a branch that jumps near the poles (Duff et al. 2017). */
static qvec3 across(qvec3 n)
{
    const double sign = copysign(1, n.z), f = -1 / (sign + n.z);
    return (qvec3){1 + sign * n.x * n.x * f, sign * n.x * n.y * f, -sign * n.x};
}

/* The largest root of l^3 - e1 l^2 + e2 l - e3, all three real and positive, to 0.1 %: e1/3 + 2q cos(phi/3), and of cos(phi) =
 * 2y^2 - 1 it is cos(phi/3) = cos(2/3 acos y), nearly a parabola in y. */
static inline double largest_root(double e1, double e2, double e3)
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
    const both bodies = make_both(&ready[0], &ready[1]);
    vectors x = make_arms(&bodies, t1), y = make_arms(&bodies, t2);
    const vectors z = make_arms(&bodies, n);
    const double m = w + arms_dot(&bodies, &z, &z), f = 1 / m;
    double a = w + arms_dot(&bodies, &x, &x), b = w + arms_dot(&bodies, &y, &y);
    /* One-sided Jacobi: turn t1, t2 until M_xy is rounding. */
    for (int sweep = 0; sweep < 3; sweep++) {
        const double xy = arms_dot(&bodies, &x, &y);
        if (xy * xy <= 16 * DBL_EPSILON * DBL_EPSILON * (a * b)) break;
        const double h = (b - a) * f, g = 2 * xy * f, r = fabs(h) + sqrt(h * h + g * g);
        const double shrink = 1 / sqrt(r * r + g * g), cs = r * shrink, sn = copysign(g * shrink, g * h);
        const vectors old = x;
        const qvec3 old_t1 = t1;
        x = arms_mix(cs, &old, -sn, &y);
        y = arms_mix(sn, &old, cs, &y);
        t1 = qvec3_axpy(-sn, t2, qvec3_scale(old_t1, cs));
        t2 = qvec3_axpy(sn, old_t1, qvec3_scale(t2, cs));
        a = w + arms_dot(&bodies, &x, &x);
        b = w + arms_dot(&bodies, &y, &y);
    }
    const double c = arms_dot(&bodies, &x, &z), d = arms_dot(&bodies, &y, &z);
    /* What the best alpha t1 + beta t2 leaves of n: at the least, rounding of alpha and beta counts but squared. */
    const double alpha = -c / a, beta = -d / b;
    const vectors least = arms_mix(alpha, &x, beta, &y), rest = arms_mix(1, &z, 1, &least);
    const double k = w * (1 + (alpha * alpha + beta * beta)) + arms_dot(&bodies, &rest, &rest);
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
