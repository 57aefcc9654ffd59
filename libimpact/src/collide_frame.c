/* SPDX-License-Identifier: MIT
 *
 * M = (w1 + w2) I - [r1] J1^-1 [r1] - [r2] J2^-1 [r2] is never formed as a difference: M = A'A with
 * A = [sqrt(w1 + w2) I; S1; S2] and S e = J^-1/2 (r x e), so that every entry is a sum of products of columns.
 */
#include "collide_frame.h"

#include <float.h>

qvec3 impact_frame_to_world(quat q, qvec3 v)
{
    const qvec3 axis = {q.x, q.y, q.z};
    const qvec3 t = qvec3_scale(qvec3_cross(axis, v), 2);
    return qvec3_add(qvec3_axpy(q.w, t, v), qvec3_cross(axis, t));
}

qvec3 impact_frame_to_body(quat q, qvec3 v) { return impact_frame_to_world(quat_conj(q), v); }

void impact_frame_ready(const impact_collider *body, impact_ready *ready)
{
    if (isinf(body->mass)) {
        *ready = (impact_ready){.orientation = {1, 0, 0, 0}, .round = true};
        return;
    }
    const qvec3 j = body->moments;
    ready->inverse_mass = 1 / body->mass;
    ready->inverse_moments = (qvec3){1 / j.x, 1 / j.y, 1 / j.z};
    ready->root =
        (qvec3){sqrt(ready->inverse_moments.x), sqrt(ready->inverse_moments.y), sqrt(ready->inverse_moments.z)};
    ready->round = j.x == j.y && j.y == j.z;
    const quat q = body->orientation;
    const double f = 1 / sqrt(quat_dot(q, q));
    ready->orientation = (quat){q.w * f, q.x * f, q.y * f, q.z * f};
}

/* A column of A: the mass row is sqrt(w) e and the two angular parts are J^-1/2 (r x e) in each body's axes. */
typedef struct column {
    qvec3 linear, angular[2];
} column;

static double column_dot(const column *p, const column *q)
{
    return qvec3_dot(p->linear, q->linear) +
           (qvec3_dot(p->angular[0], q->angular[0]) + qvec3_dot(p->angular[1], q->angular[1]));
}

static inline column column_mix(double x, const column *p, double y, const column *q)
{
    column r;
    r.linear = qvec3_axpy(y, q->linear, qvec3_scale(p->linear, x));
    for (int i = 0; i < 2; i++) r.angular[i] = qvec3_axpy(y, q->angular[i], qvec3_scale(p->angular[i], x));
    return r;
}

static column make_column(const impact_collision *collision, const impact_ready ready[2], double root, qvec3 e)
{
    column r = {.linear = qvec3_scale(e, root)};
    for (int i = 0; i < 2; i++) {
        if (ready[i].inverse_mass == 0) continue;
        qvec3 x = qvec3_cross(collision->body[i].offset, e);
        if (!ready[i].round) x = impact_frame_to_body(ready[i].orientation, x);
        const qvec3 w = ready[i].root;
        r.angular[i] = (qvec3){w.x * x.x, w.y * x.y, w.z * x.z};
    }
    return r;
}

/* A unit vector across n, without a branch that jumps near the poles (Duff et al. 2017). */
static qvec3 across(qvec3 n)
{
    const double sign = copysign(1, n.z), f = -1 / (sign + n.z);
    return (qvec3){1 + sign * n.x * n.x * f, sign * n.x * n.y * f, -sign * n.x};
}

/* Largest over smallest root of l^3 - trace l^2 + second l - det, to 1 %: the harmonic sum det / second and the trace are
 * within a factor 3 of them, and Newton from there is monotone. */
static double conditioning(double trace, double second, double det)
{
    double low = det / second, high = trace;
    /* Both at once: each alone is a chain of divisions. */
    for (int i = 0; i < 16; i++) {
        const double low_value = ((low - trace) * low + second) * low - det,
                     low_slope = (3 * low - 2 * trace) * low + second;
        const double high_value = ((high - trace) * high + second) * high - det,
                     high_slope = (3 * high - 2 * trace) * high + second;
        const double up = low_slope > 0 ? -low_value / low_slope : 0,
                     down = high_slope > 0 ? high_value / high_slope : 0;
        low += up;
        high -= down;
        if (!(up > 2e-3 * low || down > 2e-3 * high)) break;
    }
    return fmax(high / low, 1);
}

/* Spheres: every offset along the normal and every body round. Then M is diagonal and the tangential frame is free. */
static bool central(const impact_collision *collision, const impact_ready ready[2], qvec3 n, double *tangential)
{
    *tangential = ready[0].inverse_mass + ready[1].inverse_mass;
    for (int i = 0; i < 2; i++) {
        if (ready[i].inverse_mass == 0) continue;
        if (!ready[i].round) return false;
        const qvec3 r = collision->body[i].offset, x = qvec3_cross(r, n);
        const double r2 = qvec3_dot(r, r);
        if (qvec3_dot(x, x) > 16 * DBL_EPSILON * DBL_EPSILON * r2) return false;
        *tangential += r2 * ready[i].inverse_moments.x;
    }
    return true;
}

void impact_frame_make(const impact_collision *collision, const impact_ready ready[2], impact_frame *frame)
{
    const qvec3 given = collision->normal;
    const double length2 = qvec3_dot(given, given);
    const double length = length2 > 1e-200 && length2 < 1e200 ? sqrt(length2) : qvec3_norm(given);
    const qvec3 n = {given.x / length, given.y / length, given.z / length};
    const double w = ready[0].inverse_mass + ready[1].inverse_mass;
    qvec3 t1 = across(n), t2 = qvec3_cross(n, t1);
    frame->n = n;
    double tangential;
    if (central(collision, ready, n, &tangential)) {
        const double a = tangential / w;
        *frame = (impact_frame){.t1 = t1, .t2 = t2, .n = n, .a = a, .b = a, .k = 1, .scale = w, .conditioning = a};
        return;
    }
    const double root = sqrt(w);
    column x = make_column(collision, ready, root, t1), y = make_column(collision, ready, root, t2);
    const column z = make_column(collision, ready, root, n);
    /* One-sided Jacobi: turn t1, t2 until their columns are orthogonal to rounding. */
    for (int sweep = 0; sweep < 3; sweep++) {
        const double xx = column_dot(&x, &x), yy = column_dot(&y, &y), xy = column_dot(&x, &y);
        if (xy * xy <= 16 * DBL_EPSILON * DBL_EPSILON * (xx * yy)) break;
        const double zeta = (yy - xx) / (2 * xy);
        const double t = copysign(1 / (fabs(zeta) + sqrt(1 + zeta * zeta)), zeta);
        const double cs = 1 / sqrt(1 + t * t), sn = cs * t;
        const column old = x;
        const qvec3 old_t1 = t1;
        x = column_mix(cs, &old, -sn, &y);
        y = column_mix(sn, &old, cs, &y);
        t1 = qvec3_axpy(-sn, t2, qvec3_scale(old_t1, cs));
        t2 = qvec3_axpy(sn, old_t1, qvec3_scale(t2, cs));
    }
    const double a = column_dot(&x, &x), b = column_dot(&y, &y), m = column_dot(&z, &z);
    const double c = column_dot(&x, &z), d = column_dot(&y, &z);
    /* What the x and y columns leave of z; a second time where the first left little, since it is then rough (Giraud et al. 2005). */
    column rest = column_mix(1, &z, -c / a, &x);
    rest = column_mix(1, &rest, -d / b, &y);
    double k = column_dot(&rest, &rest);
    if (k < 0.25 * m) {
        rest = column_mix(1, &rest, -column_dot(&x, &rest) / a, &x);
        rest = column_mix(1, &rest, -column_dot(&y, &rest) / b, &y);
        k = column_dot(&rest, &rest);
    }
    frame->t1 = t1;
    frame->t2 = t2;
    frame->a = a / m;
    frame->b = b / m;
    frame->c = c / m;
    frame->d = d / m;
    frame->k = k / m;
    frame->scale = m;
    frame->conditioning = conditioning(frame->a + frame->b + 1,
                                       frame->a * frame->b + frame->a * (frame->k + frame->d * frame->d / frame->b) +
                                           frame->b * (frame->k + frame->c * frame->c / frame->a),
                                       frame->a * frame->b * frame->k);
}

qvec3 impact_frame_velocity(const impact_collision *collision)
{
    const impact_collider *one = &collision->body[0], *two = &collision->body[1];
    return qvec3_sub(qvec3_add(one->velocity, qvec3_cross(one->omega, one->offset)),
                     qvec3_add(two->velocity, qvec3_cross(two->omega, two->offset)));
}
