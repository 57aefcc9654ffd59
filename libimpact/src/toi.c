/* SPDX-License-Identifier: MIT
 *
 * Conservative advancement of second order. From a state with gap g > 0 and normal n, let m = R^T n be the normal in a
 * body's axes and m' its rate. Over [0, T] the normal stays within w^2 T^2/2 of m + m' t, so, with r the body's radius,
 *
 *     h(m(t)) <= h(m + m' t) + r w^2 t^2/2,
 *
 * and h is convex. Hence psi(T) = n.(c + v T + min(0, a) T^2/2) - sum [h(m + m' T) + r w^2 T^2/2] is concave, psi(0) = g, and
 * psi(T) >= 0 proves that there is no contact in [0, T]. Steps to the zero of psi converge quadratically, never past contact.
 */
#include <impact/toi.h>
#include <quat/rotation.h>
#include "support.h"

enum { MAX_STEPS = 2000, MAX_TRIES = 40 };

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
    double gap, speed, brake; /* n.c - h - h; n.v; min(0, n.a) less r w^2 of both */
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
        if (p[i] <= 2) round = fmax(round, axis[i]);
        else boxy = hypot(boxy, axis[i]);
    }
    return hypot(round, boxy);
}

static void turn(proof *p, int k, const impact_solid *body, qvec3 omega, qvec3 outward)
{
    const double w2 = qvec3_dot(omega, omega);
    p->turns[k] = w2 > 0 && body->shape.kind != IMPACT_PLANE && body->shape.kind != IMPACT_SPHERE;
    if (!p->turns[k]) return;
    quat unit;
    quat_normalize(body->orientation, &unit);
    const qvec3 m = quat_rotate_inverse(unit, outward), rate = quat_rotate_inverse(unit, qvec3_cross(outward, omega));
    p->m[k][0] = m.x, p->m[k][1] = m.y, p->m[k][2] = m.z;
    p->rate[k][0] = rate.x, p->rate[k][1] = rate.y, p->rate[k][2] = rate.z;
    impact_form_make(&body->shape, 1, unit, &p->form[k]);
    impact_surface s;
    p->h[k] = impact_form_support(&p->form[k], p->m[k], &s);
    p->brake -= outer_radius(&body->shape) * w2;
}

static double psi(const proof *p, double T)
{
    double value = p->gap + T * (p->speed + 0.5 * T * p->brake);
    for (int k = 0; k < 2; k++) {
        if (!p->turns[k]) continue;
        double d[3];
        for (int i = 0; i < 3; i++) d[i] = p->m[k][i] + T * p->rate[k][i];
        impact_surface s;
        value -= impact_form_support(&p->form[k], d, &s) - p->h[k];
    }
    return value;
}

/* A step with psi >= 0, near the largest up to limit: psi is concave and positive at 0, so a chord's zero lies below the root. */
static double safe_step(const proof *p, double limit)
{
    double low = 0, at_low = p->gap, high = limit, at_high = psi(p, limit);
    if (at_high >= 0) return limit;
    for (int k = 0; k < MAX_TRIES; k++) {
        const double chord = low + (high - low) * (at_low / (at_low - at_high)), at_chord = psi(p, chord);
        if (at_chord < 0) return k > 0 ? low : chord * (1 - 1e-15); /* rounding: the root is reached */
        low = chord, at_low = at_chord;
        if (at_low <= 0.05 * p->gap) return low;
        const double beyond = low + 0.5 * (high - low), at_beyond = psi(p, beyond);
        if (at_beyond < 0) high = beyond, at_high = at_beyond;
        else low = beyond, at_low = at_beyond;
    }
    return low;
}

static bool all_finite(qvec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static bool still(const impact_motion *m)
{
    return qvec3_norm(m->velocity) == 0 && qvec3_norm(m->acceleration) == 0 && qvec3_norm(m->omega) == 0;
}

static impact_status check(const impact_solid *body, const impact_motion *motion)
{
    if (!all_finite(motion->velocity) || !all_finite(motion->acceleration) || !all_finite(motion->omega)) return IMPACT_EDOMAIN;
    return body->shape.kind == IMPACT_PLANE && !still(motion) ? IMPACT_EARGUMENT : IMPACT_OK;
}

static double length_of(const impact_solid *body)
{
    return body->shape.kind == IMPACT_PLANE ? 0 : fmax(body->shape.a, fmax(body->shape.b, body->shape.c));
}

static proof gather(const impact_solid body[2], const impact_motion *const motion[2], const impact_contact *contact, double t)
{
    const qvec3 n = contact->normal, a = qvec3_sub(motion[0]->acceleration, motion[1]->acceleration);
    const qvec3 v = qvec3_axpy(t, a, qvec3_sub(motion[0]->velocity, motion[1]->velocity));
    proof p = {.gap = contact->lower, .speed = qvec3_dot(n, v), .brake = fmin(0, qvec3_dot(n, a))};
    turn(&p, 0, &body[0], motion[0]->omega, qvec3_neg(n));
    turn(&p, 1, &body[1], motion[1]->omega, n);
    return p;
}

impact_status impact_toi(const impact_solid *body1, const impact_motion *motion1, const impact_solid *body2, const impact_motion *motion2,
                         double t_max, double *time, impact_contact *contact)
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
