/* SPDX-License-Identifier: MIT
 *
 * M = (w1 + w2) I - [r1] J1^-1 [r1] - [r2] J2^-1 [r2] is never formed as a difference: with arms r x e in each body's
 * axes, e.M f = (w1 + w2) e.f + sum (r x e).J^-1 (r x f), so that every entry is a sum of products.
 */
#include "collide/collide_frame.h"

#include <float.h>

/* Rows: with the weights J^-1/2, a unit vector's dot product with them is its arm offset x e, local axes, for each
 * body. */
typedef struct levers {
    imp_vectors row[3];
} levers;

static inline imp_vectors row(imp_pair weight, imp_pair p, const imp_vectors *x, imp_pair q, const imp_vectors *y)
{
    p *= weight;
    q *= weight;
    return (imp_vectors){p * x->x - q * y->x, p * x->y - q * y->y, p * x->z - q * y->z};
}

static inline levers make_levers(const imp_ready *ready)
{
    const imp_vectors *axis = ready->axis, *r = &ready->offset, *w = &ready->inverse_moments;
    return (levers){{row(imp_pair_sqrt(w->x), r->y, &axis[2], r->z, &axis[1]),
                     row(imp_pair_sqrt(w->y), r->z, &axis[0], r->x, &axis[2]),
                     row(imp_pair_sqrt(w->z), r->x, &axis[1], r->y, &axis[0])}};
}

static inline imp_vectors make_arms(const levers *l, qvec3 e)
{
    const imp_vectors *row = l->row;
    return (imp_vectors){row[0].x * e.x + row[0].y * e.y + row[0].z * e.z,
                         row[1].x * e.x + row[1].y * e.y + row[1].z * e.z,
                         row[2].x * e.x + row[2].y * e.y + row[2].z * e.z};
}

/* sum p.q over both bodies */
static inline double arms_dot(const imp_vectors *p, const imp_vectors *q)
{
    const imp_pair sum = imp_vectors_dot(p, q);
    return sum[0] + sum[1];
}

static inline imp_vectors arms_mix(double x, const imp_vectors *p, double y, const imp_vectors *q)
{
    return (imp_vectors){x * p->x + y * q->x, x * p->y + y * q->y, x * p->z + y * q->z};
}

static inline imp_pair both(double x) { return (imp_pair){x, x}; }

/* Without a branch that jumps near the poles (Duff et al. 2017). */
qvec3 imp_frame_across(qvec3 n)
{
    const double sign = copysign(1, n.z), f = -1 / (sign + n.z);
    return (qvec3){1 + sign * n.x * n.x * f, sign * n.x * n.y * f, -sign * n.x};
}

/* |M| |M^-1| / 3 by Frobenius norms, the inverse from what elimination left: its diagonal is a sum of what
 * is positive. */
static inline double conditioning(const imp_frame *m, double shear, double inverse_a, double inverse_schur)
{
    const double w = 1 / m->k, s = inverse_schur, alpha = m->alpha, beta = m->beta;
    const double x = inverse_a + shear * shear * s + alpha * alpha * w, y = s + beta * beta * w,
                 xy = alpha * beta * w - shear * s;
    const double inverse2 = x * x + y * y + w * w + 2 * (xy * xy + (alpha * alpha + beta * beta) * (w * w));
    const double norm2 = m->a * m->a + m->b * m->b + 1 + 2 * (m->c * m->c + m->d * m->d + m->e * m->e);
    return imp_larger(sqrt(norm2) * sqrt(inverse2) * (1.0 / 3), 1);
}

qvec3 imp_frame_normal(const impact_collision *collision)
{
    const qvec3 given = collision->normal;
    const double length2 = qvec3_dot(given, given);
    /* Most are of unit length but for rounding: no root, no division. */
    if (fabs(length2 - 1) < 1e-14) return qvec3_scale(given, 1.5 - 0.5 * length2);
    const double length = length2 > 1e-200 && length2 < 1e200 ? sqrt(length2) : qvec3_norm(given);
    return (qvec3){given.x / length, given.y / length, given.z / length};
}

void imp_frame_make(qvec3 n, qvec3 t1, const imp_ready *ready, imp_frame *frame)
{
    const double w = ready->inverse_mass[0] + ready->inverse_mass[1];
    const qvec3 t2 = qvec3_cross(n, t1);
    const levers l = make_levers(ready);
    const imp_vectors x = make_arms(&l, t1), y = make_arms(&l, t2), z = make_arms(&l, n);
    const double a = w + arms_dot(&x, &x), m = w + arms_dot(&z, &z), e = arms_dot(&x, &y), c = arms_dot(&x, &z);
    const double f = 1 / m, g = 1 / a;
    /* Gram and Schmidt, modified: what t1 leaves of t2 and n, then what t2 leaves of n. */
    const double shear = e * g, lean = c * g;
    const imp_vectors y_left = imp_vectors_add(&y, both(-shear), &x), z_left = imp_vectors_add(&z, both(-lean), &x);
    const double schur = w * (1 + shear * shear) + arms_dot(&y_left, &y_left);
    const double h = 1 / schur, beta = -(w * (shear * lean) + arms_dot(&y_left, &z_left)) * h,
                 alpha = -(lean + beta * shear);
    const imp_vectors rest = imp_vectors_add(&z_left, both(beta), &y_left);
    const double k = w * (1 + (alpha * alpha + beta * beta)) + arms_dot(&rest, &rest);
    *frame = (imp_frame){.t1 = t1,
                         .t2 = t2,
                         .n = n,
                         .a = a * f,
                         .b = (w + arms_dot(&y, &y)) * f,
                         .c = c * f,
                         .d = arms_dot(&y, &z) * f,
                         .e = e * f,
                         .schur = schur * f,
                         .k = k * f,
                         .alpha = alpha,
                         .beta = beta,
                         .scale = m};
    frame->conditioning = conditioning(frame, shear, g * m, h * m);
}

/* One-sided Jacobi: t1, t2 until M_xy is rounding of its own. */
void imp_frame_turn(const imp_ready *ready, imp_frame *frame)
{
    const double w = ready->inverse_mass[0] + ready->inverse_mass[1], f = 1 / frame->scale;
    const levers l = make_levers(ready);
    qvec3 t1 = frame->t1, t2 = frame->t2;
    imp_vectors x = make_arms(&l, t1), y = make_arms(&l, t2);
    const imp_vectors z = make_arms(&l, frame->n);
    double a = frame->a, b = frame->b, e = frame->e;
    for (int sweep = 0; sweep < 3 && e * e > 16 * DBL_EPSILON * DBL_EPSILON * (a * b); sweep++) {
        const double h = b - a, g = 2 * e, r = fabs(h) + sqrt(h * h + g * g);
        const double shrink = 1 / sqrt(r * r + g * g), cs = r * shrink, sn = copysign(g * shrink, g * h);
        const imp_vectors old = x;
        const qvec3 old_t1 = t1;
        x = arms_mix(cs, &old, -sn, &y);
        y = arms_mix(sn, &old, cs, &y);
        t1 = qvec3_axpy(-sn, t2, qvec3_scale(old_t1, cs));
        t2 = qvec3_axpy(sn, old_t1, qvec3_scale(t2, cs));
        a = (w + arms_dot(&x, &x)) * f;
        b = (w + arms_dot(&y, &y)) * f;
        e = arms_dot(&x, &y) * f;
    }
    frame->t1 = t1;
    frame->t2 = t2;
    frame->a = a;
    frame->b = frame->schur = b;
    frame->e = 0;
    frame->c = arms_dot(&x, &z) * f;
    frame->d = arms_dot(&y, &z) * f;
    frame->alpha = -frame->c / a;
    frame->beta = -frame->d / b;
}

void imp_frame_principal(qvec3 n, const imp_ready *ready, imp_frame *frame)
{
    imp_frame_make(n, imp_frame_across(n), ready, frame);
    imp_frame_turn(ready, frame);
}
