/* SPDX-License-Identifier: MIT
 *
 * Conservative advancement of high order. From a state with gap g > 0 and normal n, let m = R^T n be the normal in a
 * body's axes, m' its rate, p its part across the axis of spin, w the spin and r the body's radius. Over [0, T]
 *
 *     m(t) = m + m' t - p w^2 t^2/2 + rest,  |rest| <= |p| (w^3 t^3/6 + w^4 t^4/24),
 *
 * and the support function h is convex and subadditive, so that
 *
 *     psi(T) = g + n.v T + min(0, n.a) T^2/2 - sum [h(m + m' T) - h(m) + h(-p) w^2 T^2/2 + r |rest|]
 *
 * is concave and psi(T) >= 0 proves that there is no contact in [0, T]. So does, for far bodies, the same with their
 * bounding balls. Steps to the zero of psi converge quadratically and never pass the contact.
 */
#include <impact/toi.h>
#include <quat/rotation.h>
#include "support.h"

enum { MAX_STEPS = 2000, MAX_TRIES = 8 };

impact_solid impact_motion_at(const impact_solid *body, const impact_motion *motion, double t)
{
    impact_solid moved = *body;
    moved.position = qvec3_axpy(0.5 * t * t, motion->acceleration, qvec3_axpy(t, motion->velocity, body->position));
    if (motion->omega.x != 0 || motion->omega.y != 0 || motion->omega.z != 0) {
        quat unit;
        moved.orientation = quat_mul(quat_from_rotation_vector(qvec3_scale(motion->omega, t)), body->orientation);
        if (quat_normalize(moved.orientation, &unit) == QUAT_OK) moved.orientation = unit;
    }
    return moved;
}

/* What psi is made of. */
typedef struct proof {
    double gap, apart;           /* n.c - h - h; n.c less the bounding balls' radii */
    double speed;                /* n.v */
    double pull;                 /* min(0, n.a) */
    double second, rest3, rest4; /* sums of h(-p) w^2, r |p| w^3, r |p| w^4 */
    double slope;                /* psi'(0) */
    bool turns[2];
    impact_form form[2];
    double m[2][3], rate[2][3], h[2];
} proof;

/* No less than the bounding radius: the longest of the round axes and all the boxy ones, end to end. */
static double outer_radius(const impact_shape *shape)
{
    const double axis[3] = {shape->a, shape->b, shape->c}, p[3] = {shape->r, shape->s, shape->t};
    double round = 0, boxy = 0;
    for (int i = 0; i < 3; i++) {
        if (p[i] <= 2)
            round = fmax(round, axis[i]);
        else
            boxy = hypot(boxy, axis[i]);
    }
    return hypot(round, boxy);
}

static void store(qvec3 v, double out[3]) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

static void turn(proof *p, int k, const impact_solid *body, qvec3 omega, qvec3 outward)
{
    const double w = qvec3_norm(omega);
    p->turns[k] = w > 0 && body->shape.kind != IMPACT_PLANE && body->shape.kind != IMPACT_SPHERE;
    if (!p->turns[k]) return;
    quat unit;
    quat_normalize(body->orientation, &unit);
    impact_form_make(&body->shape, 1, unit, &p->form[k]);
    store(quat_rotate_inverse(unit, outward), p->m[k]);
    store(quat_rotate_inverse(unit, qvec3_cross(outward, omega)), p->rate[k]);
    const qvec3 part = qvec3_axpy(-qvec3_dot(outward, omega) / (w * w), omega, outward);
    double back[3], point[3], normal[3];
    store(quat_rotate_inverse(unit, qvec3_neg(part)), back);
    impact_surface s;
    const double across = qvec3_norm(part), radius = outer_radius(&body->shape);
    if (across > 0) p->second += w * w * impact_form_support(&p->form[k], back, &s);
    p->rest3 += radius * across * w * w * w;
    p->rest4 += radius * across * w * w * w * w;
    p->h[k] = impact_form_support(&p->form[k], p->m[k], &s);
    impact_surface_point(&p->form[k], &s, point, normal);
    for (int i = 0; i < 3; i++) p->slope -= p->rate[k][i] * point[i];
}

static double psi(const proof *p, double T)
{
    double value = p->gap + T * (p->speed + T * (0.5 * (p->pull - p->second) - T * (p->rest3 / 6 + T * p->rest4 / 24)));
    for (int k = 0; k < 2; k++) {
        if (!p->turns[k]) continue;
        double d[3];
        for (int i = 0; i < 3; i++) d[i] = p->m[k][i] + T * p->rate[k][i];
        impact_surface s;
        value -= impact_form_support(&p->form[k], d, &s) - p->h[k];
    }
    return value;
}

/* First T > 0 at which gap + slope T - bend T^2/2 is zero; infinite when there is none. gap > 0, bend >= 0. */
static double first_zero(double gap, double slope, double bend)
{
    const double root = sqrt(slope * slope + 2 * bend * gap);
    if (slope < 0) return 2 * gap / (root - slope);
    return bend > 0 ? (slope + root) / bend : INFINITY;
}

/* A step with psi >= 0, near the largest up to limit. psi lies below its tangent's parabola, whose zero is so beyond
 * psi's; and above its chords, whose zeros come before it. */
static double safe_step(const proof *p, double limit)
{
    const double balls = p->apart > 0 ? fmin(limit, first_zero(p->apart, p->speed, -p->pull)) : 0;
    double low = 0, at_low = p->gap, high = fmin(limit, first_zero(p->gap, p->slope, p->second - p->pull));
    if (balls >= high) return balls;
    double at_high = psi(p, high);
    if (at_high >= 0) return high;
    for (int k = 0; k < MAX_TRIES && at_low > 0.1 * p->gap; k++) {
        const double chord = low + (high - low) * (at_low / (at_low - at_high)), at_chord = psi(p, chord);
        if (!(at_chord > 0 && chord > low))
            return k > 0 ? fmax(low, balls) : chord * (1 - 1e-15); /* rounding: the zero is reached */
        low = chord, at_low = at_chord;
        if (at_low > 0.5 * p->gap) { /* the far end is too far for its chord */
            const double middle = 0.5 * (low + high), at_middle = psi(p, middle);
            if (at_middle < 0)
                high = middle, at_high = at_middle;
            else
                low = middle, at_low = at_middle;
        }
    }
    return fmax(low, balls);
}

static bool all_finite(qvec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static bool still(const impact_motion *m)
{
    return qvec3_norm(m->velocity) == 0 && qvec3_norm(m->acceleration) == 0 && qvec3_norm(m->omega) == 0;
}

static impact_status check(const impact_solid *body, const impact_motion *motion)
{
    if (!all_finite(motion->velocity) || !all_finite(motion->acceleration) || !all_finite(motion->omega))
        return IMPACT_EDOMAIN;
    return body->shape.kind == IMPACT_PLANE && !still(motion) ? IMPACT_EARGUMENT : IMPACT_OK;
}

static double length_of(const impact_solid *body)
{
    return body->shape.kind == IMPACT_PLANE ? 0 : fmax(body->shape.a, fmax(body->shape.b, body->shape.c));
}

static proof gather(const impact_solid body[2], const impact_motion *const motion[2], const impact_contact *contact,
                    double t)
{
    const qvec3 n = contact->normal, a = qvec3_sub(motion[0]->acceleration, motion[1]->acceleration);
    const qvec3 v = qvec3_axpy(t, a, qvec3_sub(motion[0]->velocity, motion[1]->velocity));
    proof p = {
        .gap = contact->lower, .speed = qvec3_dot(n, v), .pull = fmin(0, qvec3_dot(n, a)), .slope = qvec3_dot(n, v)};
    p.apart = -1;
    if (body[0].shape.kind != IMPACT_PLANE && body[1].shape.kind != IMPACT_PLANE)
        p.apart = qvec3_dot(n, qvec3_sub(body[0].position, body[1].position)) - outer_radius(&body[0].shape) -
                  outer_radius(&body[1].shape);
    turn(&p, 0, &body[0], motion[0]->omega, qvec3_neg(n));
    turn(&p, 1, &body[1], motion[1]->omega, n);
    return p;
}

impact_status impact_toi(const impact_solid *body1, const impact_motion *motion1, const impact_solid *body2,
                         const impact_motion *motion2, double t_max, double *time, impact_contact *contact)
{
    *time = NAN;
    const impact_motion *const motion[2] = {motion1, motion2};
    impact_status status = check(body1, motion1);
    if (status == IMPACT_OK) status = check(body2, motion2);
    if (status != IMPACT_OK) return status;
    if (!isfinite(t_max)) return IMPACT_EDOMAIN;
    if (t_max < 0) return IMPACT_EARGUMENT;
    impact_contact own;
    if (!contact) contact = &own;
    impact_gap_cache cache = {0};
    const double length = fmax(length_of(body1), length_of(body2));
    double t = 0;
    for (int step = 0; step < MAX_STEPS; step++) {
        const impact_solid body[2] = {impact_motion_at(body1, motion1, t), impact_motion_at(body2, motion2, t)};
        status = impact_gap(&body[0], &body[1], &cache, contact);
        if (status < 0) return status;
        *time = t;
        const double distance = qvec3_norm(qvec3_sub(contact->offset1, contact->offset2));
        if (contact->lower <= 2.5e-16 * (length + distance)) return IMPACT_OK;
        if (t >= t_max) return IMPACT_NO_CONTACT;
        const proof p = gather(body, motion, contact, t);
        const double next = fmin(t_max, t + safe_step(&p, t_max - t));
        if (next <= t) return contact->upper <= 1e-14 * (length + distance) ? IMPACT_OK : IMPACT_EUNSETTLED;
        t = next;
    }
    return IMPACT_EUNSETTLED;
}
