/* SPDX-License-Identifier: MIT
 *
 * M = (w1 + w2) I - [r1] J1^-1 [r1] - [r2] J2^-1 [r2] is never formed as a difference: with arms r x e in each body's
 * axes, e.M f = (w1 + w2) e.f + sum (r x e).J^-1 (r x f), so that every entry is a sum of products.
 */
#include "collide/collide_frame.h"
#include "base/tolerances.h"

/* sum p.q over both bodies */
static inline imp_real arms_dot(const imp_vectors *p, const imp_vectors *q)
{
    const imp_lanes sum = imp_vectors_dot(p, q);
    return sum[0] + sum[1];
}

static inline imp_vectors arms_mix(imp_real x, const imp_vectors *p, imp_real y, const imp_vectors *q)
{
    return (imp_vectors){x * p->x + y * q->x, x * p->y + y * q->y, x * p->z + y * q->z};
}

static inline imp_lanes both(imp_real x) { return (imp_lanes){x, x}; }

/* Without a branch that jumps near the poles (Duff et al. 2017). */
imp_vec imp_frame_across(imp_vec n)
{
    const imp_real sign = imp_copysign(1, n.z), f = -1 / (sign + n.z);
    return (imp_vec){1 + sign * n.x * n.x * f, sign * n.x * n.y * f, -sign * n.x};
}

/* |M| |M^-1| / 3 by Frobenius norms, the inverse from what elimination left: its diagonal is a sum of what
 * is positive. */
static inline imp_real conditioning(const imp_frame *m, imp_real shear, imp_real inverse_a, imp_real inverse_schur)
{
    const imp_real w = 1 / m->k, s = inverse_schur, alpha = m->alpha, beta = m->beta;
    const imp_real x = inverse_a + shear * shear * s + alpha * alpha * w, y = s + beta * beta * w,
                   xy = alpha * beta * w - shear * s;
    const imp_real inverse2 = x * x + y * y + w * w + 2 * (xy * xy + (alpha * alpha + beta * beta) * (w * w));
    const imp_real norm2 = m->a * m->a + m->b * m->b + 1 + 2 * (m->c * m->c + m->d * m->d + m->e * m->e);
    return imp_larger(imp_sqrt(norm2) * imp_sqrt(inverse2) * (1.0 / 3), 1);
}

imp_vec imp_frame_normal(const impact_collision *collision)
{
    const imp_vec given = imp_vec_of(collision->normal);
    const imp_real length2 = imp_vec_dot(given, given);
    /* Most are of unit length but for rounding: no root, no division. The square of what is left is below eps. */
    if (imp_abs(length2 - 1) < 45 * IMP_EPSILON) return imp_vec_scale(given, 1.5 - 0.5 * length2);
    const bool squares = length2 > 1 / IMP_COLLIDE_SQUARES && length2 < IMP_COLLIDE_SQUARES;
    const imp_real length = squares ? imp_sqrt(length2) : qvec3_norm(collision->normal);
    return (imp_vec){given.x / length, given.y / length, given.z / length};
}

/* What t1 leaves of t2 and n, then t2 of n (Gram and Schmidt, modified): per M_xx, M_xy and M_xz. */
typedef struct elimination {
    imp_real shear, schur, alpha, beta, k;
} elimination;

static inline elimination eliminate(imp_real w, const imp_vectors *x, const imp_vectors *y, const imp_vectors *z,
                                    imp_real shear, imp_real lean)
{
    const imp_vectors y_left = imp_vectors_add(y, both(-shear), x), z_left = imp_vectors_add(z, both(-lean), x);
    const imp_real schur = w * (1 + shear * shear) + arms_dot(&y_left, &y_left);
    const imp_real beta = -(w * (shear * lean) + arms_dot(&y_left, &z_left)) / schur, alpha = -(lean + beta * shear);
    const imp_vectors rest = imp_vectors_add(&z_left, both(beta), &y_left);
    const imp_real k = w * (1 + (alpha * alpha + beta * beta)) + arms_dot(&rest, &rest);
    return (elimination){shear, schur, alpha, beta, k};
}

void imp_frame_make(imp_vec n, imp_vec t1, const imp_ready *ready, imp_frame *frame)
{
    const imp_real w = ready->inverse_mass[0] + ready->inverse_mass[1];
    const imp_vec t2 = imp_vec_cross(n, t1);
    const imp_levers l = imp_frame_levers(ready);
    const imp_vectors x = imp_frame_arms(&l, t1), y = imp_frame_arms(&l, t2), z = imp_frame_arms(&l, n);
    const imp_real a = w + arms_dot(&x, &x), m = w + arms_dot(&z, &z), e = arms_dot(&x, &y), c = arms_dot(&x, &z);
    const imp_real f = 1 / m, g = 1 / a;
    const elimination left = eliminate(w, &x, &y, &z, e * g, c * g);
    *frame = (imp_frame){.t1 = t1,
                         .t2 = t2,
                         .n = n,
                         .a = a * f,
                         .b = (w + arms_dot(&y, &y)) * f,
                         .c = c * f,
                         .d = arms_dot(&y, &z) * f,
                         .e = e * f,
                         .schur = left.schur * f,
                         .k = left.k * f,
                         .alpha = left.alpha,
                         .beta = left.beta,
                         .scale = m};
    frame->conditioning = conditioning(frame, left.shear, g * m, m / left.schur);
}

/* One-sided Jacobi: t1, t2 until M_xy is rounding of its own. What is left of it is still felt by the impulse that
 * sticks where a and b are far apart: that comes from eliminating the larger first, and M_xy with it. */
void imp_frame_turn(const imp_ready *ready, imp_frame *frame)
{
    enum { SWEEPS = 6 };
    const imp_real w = ready->inverse_mass[0] + ready->inverse_mass[1], f = 1 / frame->scale;
    const imp_levers l = imp_frame_levers(ready);
    imp_vec t1 = frame->t1, t2 = frame->t2;
    imp_vectors x = imp_frame_arms(&l, t1), y = imp_frame_arms(&l, t2);
    const imp_vectors z = imp_frame_arms(&l, frame->n);
    imp_real a = frame->a, b = frame->b, e = frame->e;
    for (int sweep = 0; sweep < SWEEPS && e * e > 16 * IMP_EPSILON * IMP_EPSILON * (a * b); sweep++) {
        const imp_real h = b - a, g = 2 * e, r = imp_abs(h) + imp_sqrt(h * h + g * g);
        const imp_real shrink = 1 / imp_sqrt(r * r + g * g), cs = r * shrink, sn = imp_copysign(g * shrink, g * h);
        const imp_vectors old = x;
        const imp_vec old_t1 = t1;
        x = arms_mix(cs, &old, -sn, &y);
        y = arms_mix(sn, &old, cs, &y);
        t1 = imp_vec_axpy(-sn, t2, imp_vec_scale(old_t1, cs));
        t2 = imp_vec_axpy(sn, old_t1, imp_vec_scale(t2, cs));
        a = (w + arms_dot(&x, &x)) * f;
        b = (w + arms_dot(&y, &y)) * f;
        e = arms_dot(&x, &y) * f;
    }
    const imp_real c = arms_dot(&x, &z) * f, d = arms_dot(&y, &z) * f;
    const bool first = a >= b;
    const elimination left = first ? eliminate(w, &x, &y, &z, e / a, c / a) : eliminate(w, &y, &x, &z, e / b, d / b);
    frame->t1 = t1;
    frame->t2 = t2;
    frame->a = a;
    frame->b = b;
    frame->c = c;
    frame->d = d;
    frame->e = 0;
    frame->schur = first ? left.schur * f : left.schur * f * (b / a);
    frame->alpha = first ? left.alpha : left.beta;
    frame->beta = first ? left.beta : left.alpha;
}

void imp_frame_principal(imp_vec n, const imp_ready *ready, imp_frame *frame)
{
    imp_frame_make(n, imp_frame_across(n), ready, frame);
    imp_frame_turn(ready, frame);
}
