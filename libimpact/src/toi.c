/* SPDX-License-Identifier: MIT
 *
 * A search for the gap's root in time, and a proof that it is the first. From a state with gap g >= 0 and normal n,
 * follow time (either way) along the direction n(t) = (1 + alpha t^2/2) n + t nu. With d = n or -n outward, w the spin,
 * c, v, a the centres' offset and its rates, the direction in a body's axes is, to third order, R^T of
 *
 *     d + t (nu - w x d) + t^2/2 q + t^3/6 s + rest,   q = w x (w x d) - 2 w x nu + alpha d,
 *     s = -w x (w x (w x d)) + 3 w x (w x nu) - 3 alpha w x d,   |rest| <= M t^4/24.
 *
 * The support function h is convex and subadditive, r the body's radius, so that n(t).c(t) less both h is at least
 *
 *     psi(t) = g + (n.v + nu.c) t + min(0, B) t^2/2 + min(0, C) t^3/6 - r M t^4/24 - sum [h(d + t (nu - w x d)) - h(d)]
 *
 * B = n.a + 2 nu.v + alpha n.c - sum h(q), C = 3 nu.a + 3 alpha n.v - sum r |s|. psi is concave: psi(T) >= 0 proves that
 * there is no contact from 0 to T. nu is chosen to lead to the normal found at T, where the true gap is known to be
 * positive, so that psi(T) falls short of it by terms of second order in T only, however steep or flat the surfaces.
 */
#include <impact/toi.h>
#include <quat/rotation.h>
#include "gap_solver.h"

enum { MAX_STEPS = 2000, MAX_WAITING = 12 };

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

/* The question: what does not change on the way. */
typedef struct chase {
    const impact_solid *body[2];
    const impact_motion *motion[2];
    bool plane[2];
    qvec3 omega[2]; /* of the bodies whose turning shows */
    double radius[2], length;
    qvec3 acceleration; /* of body 1 relative to body 2 */
    double turning;     /* the faster spin */
} chase;

/* One time and what is known of it. */
typedef struct instant {
    double t, gap, rate, tolerance; /* gap: the bracket's lower end */
    impact_solid body[2];
    impact_contact contact;
} instant;

/* Supports of the two bodies at an instant. */
typedef struct stand {
    impact_form form[2];
    qvec3 c, v; /* v in the sense of time that is followed */
    double sense;
} stand;

static double support(const impact_form *form, qvec3 d)
{
    const double body[3] = {form->rotation[0][0] * d.x + form->rotation[1][0] * d.y + form->rotation[2][0] * d.z,
                            form->rotation[0][1] * d.x + form->rotation[1][1] * d.y + form->rotation[2][1] * d.z,
                            form->rotation[0][2] * d.x + form->rotation[1][2] * d.y + form->rotation[2][2] * d.z};
    impact_surface s;
    return body[0] == 0 && body[1] == 0 && body[2] == 0 ? 0 : impact_form_support(form, body, &s);
}

static stand stand_at(const chase *q, const instant *at, double sense)
{
    stand s = {.sense = sense};
    for (int k = 0; k < 2; k++) {
        if (q->plane[k]) continue;
        quat unit = quat_identity();
        quat_normalize(at->body[k].orientation, &unit);
        impact_form_make(&at->body[k].shape, 1, unit, &s.form[k]);
    }
    s.c = qvec3_sub(at->body[0].position, at->body[1].position);
    s.v = qvec3_axpy(at->t, q->acceleration, qvec3_sub(q->motion[0]->velocity, q->motion[1]->velocity));
    s.v = qvec3_scale(s.v, sense);
    return s;
}

/* psi(T) with n(t) as the head of this file has it. */
static double psi(const chase *q, const instant *at, const stand *s, qvec3 nu, double T)
{
    const qvec3 n = at->contact.normal;
    qvec3 outward[2], lead[2], w[2];
    double alpha = 0;
    for (int k = 0; k < 2; k++) {
        outward[k] = k ? n : qvec3_neg(n), lead[k] = k ? nu : qvec3_neg(nu);
        w[k] = qvec3_scale(q->omega[k], s->sense);
        const qvec3 slip = qvec3_sub(lead[k], qvec3_cross(w[k], outward[k]));
        if (!q->plane[k]) alpha = fmax(alpha, qvec3_dot(slip, slip) - qvec3_dot(nu, nu));
    }
    double first = qvec3_dot(n, s->v) + qvec3_dot(nu, s->c),
           second = qvec3_dot(n, q->acceleration) + 2 * qvec3_dot(nu, s->v) + alpha * qvec3_dot(n, s->c),
           third = 3 * qvec3_dot(nu, q->acceleration) + 3 * alpha * qvec3_dot(n, s->v),
           fourth = fmin(0, 6 * alpha * qvec3_dot(n, q->acceleration)), value = fmax(0, at->gap);
    for (int k = 0; k < 2; k++) {
        if (q->plane[k]) continue;
        const qvec3 wd = qvec3_cross(w[k], outward[k]), wnu = qvec3_cross(w[k], lead[k]);
        const qvec3 bend = qvec3_axpy(alpha, outward[k], qvec3_axpy(-2, wnu, qvec3_cross(w[k], wd)));
        const qvec3 twist =
            qvec3_axpy(-3 * alpha, wd,
                       qvec3_sub(qvec3_scale(qvec3_cross(w[k], wnu), 3), qvec3_cross(w[k], qvec3_cross(w[k], wd))));
        const double W = qvec3_norm(w[k]), N = qvec3_norm(nu);
        second -= support(&s->form[k], bend);
        third -= q->radius[k] * qvec3_norm(twist);
        fourth -=
            q->radius[k] * W * W * (W * W * (1 + T * N + 0.5 * alpha * T * T) + 4 * W * (N + alpha * T) + 6 * alpha);
        const qvec3 offset = k ? at->contact.offset2 : at->contact.offset1;
        value -=
            support(&s->form[k], qvec3_axpy(T, qvec3_sub(lead[k], wd), outward[k])) - qvec3_dot(outward[k], offset);
    }
    return value + T * (first + T * (fmin(0, second) / 2 + T * (fmin(0, third) / 6 + T * fourth / 24)));
}

/* Whether there is provably no contact between two instants without one. */
static bool link(const chase *q, const instant *from, const instant *to)
{
    const bool forward = from->gap < to->gap;
    const instant *base = forward ? from : to, *end = forward ? to : from;
    const double T = to->t - from->t, along = qvec3_dot(base->contact.normal, end->contact.normal);
    if (!(along > 0.2)) return false;
    const qvec3 nu = qvec3_scale(qvec3_axpy(-along, base->contact.normal, end->contact.normal), 1 / (along * T));
    const stand s = stand_at(q, base, forward ? 1 : -1);
    return psi(q, base, &s, nu, T) >= -base->tolerance;
}

/* First T > 0 at which gap + slope T - bend T^2/2 is zero; infinite when there is none. gap > 0, bend >= 0. */
static double first_zero(double gap, double slope, double bend)
{
    const double root = sqrt(slope * slope + 2 * bend * gap);
    if (slope < 0) return 2 * gap / (root - slope);
    return bend > 0 ? (slope + root) / bend : INFINITY;
}

/* A step from an instant, at most limit, in which there is provably no contact: along its normal, or for far bodies along
 * the same with their bounding balls. */
static double safe_step(const chase *q, const instant *at, double limit)
{
    const stand s = stand_at(q, at, 1);
    const double value = psi(q, at, &s, (qvec3){0, 0, 0}, limit);
    return value >= 0 ? limit : limit * (at->gap / (at->gap - value)); /* psi is above its chord */
}

static double ball_step(const chase *q, const instant *at)
{
    if (q->plane[0] || q->plane[1]) return 0;
    const qvec3 n = at->contact.normal;
    const double apart =
        qvec3_dot(n, qvec3_sub(at->body[0].position, at->body[1].position)) - q->radius[0] - q->radius[1];
    const qvec3 v = qvec3_axpy(at->t, q->acceleration, qvec3_sub(q->motion[0]->velocity, q->motion[1]->velocity));
    return apart > 0 ? first_zero(apart, qvec3_dot(n, v), -fmin(0, qvec3_dot(n, q->acceleration))) : 0;
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

static bool touches(const instant *at) { return at->gap <= at->tolerance; }

/* The gap at time t, from the normal seed (NULL: none). glance: at a time that may lie beyond the contact. */
static impact_status solve(const chase *q, double t, const qvec3 *seed, bool glance, instant *at)
{
    impact_gap_cache cache = {0};
    if (seed) cache = (impact_gap_cache){true, *seed};
    at->t = t;
    for (int k = 0; k < 2; k++) at->body[k] = impact_motion_at(q->body[k], q->motion[k], t);
    const impact_status status = glance ? impact_gap_glance(&at->body[0], &at->body[1], &cache, &at->contact)
                                        : impact_gap(&at->body[0], &at->body[1], &cache, &at->contact);
    if (status < 0 || (glance && status != IMPACT_OK)) return status;
    const qvec3 v[2] = {qvec3_axpy(t, q->motion[0]->acceleration, q->motion[0]->velocity),
                        qvec3_axpy(t, q->motion[1]->acceleration, q->motion[1]->velocity)};
    at->gap = at->contact.lower;
    at->rate = impact_gap_rate(&at->contact, v[0], q->motion[0]->omega, v[1], q->motion[1]->omega);
    at->tolerance = 2.5e-16 * (q->length + qvec3_norm(qvec3_sub(at->contact.offset1, at->contact.offset2)));
    return status;
}

/* One look ahead turns the faster body by no more than this, rad. */
static const double longest_turn = 0.5;

/* The search: before `here` there is no contact. `waiting`: later instants without contact, or (the first) at the
 * contact, the nearest last, all of them before `beyond`, where the bodies overlap. */
typedef struct search {
    chase q;
    double t_max;
    instant here, last, beyond, waiting[MAX_WAITING]; /* last: before here, when followed */
    int waiting_count;
    bool crossed, followed; /* beyond is known, last is known */
    int stalls;             /* the bracket's steps that came to nothing much */
} search;

/* t(g) at g = 0 by the cubic through two instants with their rates; NaN when they do not fall steadily to it. */
static double cubic_zero(const instant *a, const instant *b)
{
    const double d = b->gap - a->gap, u = -a->gap / d;
    if (!(a->rate < 0 && b->rate < 0 && fabs(b->gap) < 0.5 * fabs(a->gap))) return NAN;
    return a->t + (b->t - a->t) * u * u * (3 - 2 * u) + d * u * (1 - u) * ((1 - u) / a->rate - u / b->rate);
}

/* The gap's zero as it seems from the nearer end. */
static double foresee(const search *s)
{
    const instant *here = &s->here, *beyond = &s->beyond;
    const bool far_end = s->crossed && -beyond->gap < here->gap;
    const instant *near = far_end ? beyond : here, *other = far_end ? here : s->crossed ? beyond : &s->last;
    const double newton = near->rate < 0 ? near->t - near->gap / near->rate : far_end ? NAN : INFINITY;
    const double cubic = s->crossed || s->followed ? cubic_zero(other, near) : NAN;
    return fabs(cubic - newton) < 0.3 * fabs(newton - near->t) ? cubic : newton;
}

/* Where to look next, nothing waiting. */
static double aim(search *s)
{
    const instant *here = &s->here, *beyond = &s->beyond;
    const double reach = here->t + (s->q.turning > 0 ? longest_turn / s->q.turning : INFINITY);
    double t = foresee(s);
    if (!s->crossed) return fmin(s->t_max, fmin(reach, t));
    if (!(t > here->t && t < beyond->t)) t = here->t + (beyond->t - here->t) * (here->gap / (here->gap - beyond->gap));
    if (s->stalls >= 3) t = 0.5 * (here->t + beyond->t), s->stalls = 0;
    return fmin(reach, t);
}

/* The normal as it seems at time t: from here's and another's, in a straight line. */
static qvec3 lean(const search *s, double t)
{
    const instant *here = &s->here;
    const instant *other = s->waiting_count > 0 ? &s->waiting[s->waiting_count - 1]
                           : s->crossed         ? &s->beyond
                                                : &s->last;
    const qvec3 n = here->contact.normal;
    if (other == &s->last && !(s->followed && t - here->t < here->t - other->t)) return n;
    const double part = (t - here->t) / (other->t - here->t);
    const qvec3 m = qvec3_axpy(part, qvec3_sub(other->contact.normal, n), n);
    const double length = qvec3_norm(m);
    return length > 0.5 ? qvec3_scale(m, 1 / length) : n;
}

/* Looks at time t: what is found becomes beyond, or waits. False when the cheap ways did not settle. */
static bool look(search *s, double t)
{
    instant *at = &s->waiting[s->waiting_count];
    const qvec3 seed = lean(s, t);
    if (solve(&s->q, t, &seed, true, at) != IMPACT_OK) return false;
    if (at->gap < -at->tolerance) {
        s->beyond = *at;
        s->crossed = true;
        s->waiting_count = 0;
    } else {
        if (touches(at)) s->waiting_count = 0, s->waiting[0] = *at;
        s->waiting_count++;
    }
    return true;
}

static void go_to(search *s, const instant *next)
{
    s->last = s->here;
    s->followed = true;
    s->here = *next;
    if (s->waiting_count > 0 && s->waiting[s->waiting_count - 1].t <= next->t) s->waiting_count--;
}

/* Goes to time t, before which there is no contact. */
static impact_status stride(search *s, double t)
{
    instant next;
    const qvec3 seed = s->here.contact.normal;
    const impact_status status = solve(&s->q, t, &seed, false, &next);
    go_to(s, &next);
    return status;
}

/* One move on: links the instant that waits, or looks at a new one, or steps by a proof that needs no other end. stuck:
 * no time lies between here and the contact. */
static impact_status move_on(search *s, bool *stuck)
{
    instant *here = &s->here;
    const instant *next = s->waiting_count > 0 ? &s->waiting[s->waiting_count - 1] : NULL;
    if (next && link(&s->q, here, next)) {
        go_to(s, next);
        return IMPACT_OK;
    }
    const double t = next ? 0.5 * (here->t + next->t) : aim(s);
    if (!next && !s->crossed) {
        const double clear = fmin(s->t_max, here->t + ball_step(&s->q, here));
        if (clear > here->t && clear >= t) return stride(s, clear);
    }
    const double end = next ? next->t : s->crossed ? s->beyond.t : s->t_max;
    if (t > here->t && (t < end || end == s->t_max) && s->waiting_count < MAX_WAITING) {
        const double width = end - here->t;
        if (look(s, t)) {
            s->stalls = s->crossed && s->beyond.t - here->t > 0.5 * width ? s->stalls + 1 : 0;
            return IMPACT_OK;
        }
    }
    const double limit = fmin(end, fmax(t, here->t)),
                 safe = fmin(limit, here->t + safe_step(&s->q, here, limit - here->t));
    *stuck = !(safe > here->t);
    return *stuck ? IMPACT_OK : stride(s, safe);
}

/* Whether the gap left is rounding's: of the length, or of the time. */
static bool near_enough(const instant *at)
{
    return at->contact.upper <= fmax(40 * at->tolerance, 4.5e-16 * at->t * fabs(at->rate));
}

static impact_status run(search *s)
{
    impact_status status = solve(&s->q, 0, NULL, false, &s->here);
    for (int step = 0; step < MAX_STEPS && status >= 0; step++) {
        bool stuck = false;
        if (touches(&s->here)) return IMPACT_OK;
        if (s->here.t >= s->t_max) return IMPACT_NO_CONTACT;
        status = move_on(s, &stuck);
        if (stuck) return near_enough(&s->here) ? IMPACT_OK : IMPACT_EUNSETTLED;
    }
    return status < 0 ? status : IMPACT_EUNSETTLED;
}

impact_status impact_toi(const impact_solid *body1, const impact_motion *motion1, const impact_solid *body2,
                         const impact_motion *motion2, double t_max, double *time, impact_contact *contact)
{
    *time = NAN;
    search s = {.q = {.body = {body1, body2}, .motion = {motion1, motion2}}, .t_max = t_max};
    impact_status status = check(body1, motion1);
    if (status == IMPACT_OK) status = check(body2, motion2);
    if (status != IMPACT_OK) return status;
    if (!isfinite(t_max)) return IMPACT_EDOMAIN;
    if (t_max < 0) return IMPACT_EARGUMENT;
    for (int k = 0; k < 2; k++) {
        const impact_shape *shape = &s.q.body[k]->shape;
        s.q.plane[k] = shape->kind == IMPACT_PLANE;
        if (s.q.plane[k]) continue;
        s.q.radius[k] = outer_radius(shape);
        if (shape->kind != IMPACT_SPHERE) s.q.omega[k] = s.q.motion[k]->omega;
        s.q.turning = fmax(s.q.turning, qvec3_norm(s.q.omega[k]));
    }
    s.q.length = fmax(length_of(body1), length_of(body2));
    s.q.acceleration = qvec3_sub(motion1->acceleration, motion2->acceleration);
    status = run(&s);
    if (contact) *contact = s.here.contact;
    if (status >= 0 || status == IMPACT_EUNSETTLED) *time = s.here.t;
    return status;
}
