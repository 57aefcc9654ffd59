/* SPDX-License-Identifier: MIT
 *
 * A search for the time of contact, and proofs (toi_proof) that nothing touches before it. The far end comes first:
 * Newton for the contact itself, or for the gap at times that the gap's rate foretells; then what lies between is
 * cleared, halved where no proof clears it at once. At a time between it is enough to know a normal that parts the
 * bodies.
 */
#include <quat/rotation.h>
#include "base/floats.h"
#include "base/tolerances.h"
#include "base/numbers.h"
#include "motion/toi_proof.h"

enum { MAX_STEPS = 2000, MAX_WAITING = 12, MAX_BALL_STEPS = 4 };

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

impact_solid imp_course_at(const imp_gap_course *course, int k, double t)
{
    const impact_motion *motion = course->motion[k];
    impact_solid moved = *course->body[k];
    moved.position = qvec3_axpy(0.5 * t * t, motion->acceleration, qvec3_axpy(t, motion->velocity, moved.position));
    if (course->half_spin[k] == 0) return moved;
    const double half = course->half_spin[k] * t, sine = sin(half);
    const quat axis = course->axis[k];
    moved.orientation = quat_mul((quat){cos(half), sine * axis.x, sine * axis.y, sine * axis.z}, moved.orientation);
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

static bool still(const impact_motion *m)
{
    return qvec3_norm(m->velocity) == 0 && qvec3_norm(m->acceleration) == 0 && qvec3_norm(m->omega) == 0;
}

static impact_status check(const impact_solid *body, const impact_motion *motion)
{
    if (!imp_all_finite(motion->velocity) || !imp_all_finite(motion->acceleration) || !imp_all_finite(motion->omega))
        return IMPACT_EDOMAIN;
    return body->shape.kind == IMPACT_PLANE && !still(motion) ? IMPACT_EARGUMENT : IMPACT_OK;
}

/* The gap costs next to nothing. */
static bool closed_form(const impact_solid *body1, const impact_solid *body2)
{
    const impact_shape_kind kind1 = body1->shape.kind, kind2 = body2->shape.kind;
    return kind1 == IMPACT_PLANE || kind2 == IMPACT_PLANE || (kind1 == IMPACT_SPHERE && kind2 == IMPACT_SPHERE);
}

static double length_of(const impact_solid *body)
{
    return body->shape.kind == IMPACT_PLANE ? 0 : fmax(body->shape.a, fmax(body->shape.b, body->shape.c));
}

static void note_contact(const imp_chase *q, imp_instant *at)
{
    const qvec3 zero = {0, 0, 0};
    at->gap = at->contact.lower;
    at->rate = impact_gap_rate(&at->contact, at->v, q->omega[0], zero, q->omega[1]);
    at->sketched = false;
}

/* What a gap may be for its rounding, or for that of the time. */
static double slack(const imp_instant *at)
{
    return fmax(at->tolerance, IMP_TOI_TIME_ROUNDING * at->t * fabs(at->rate));
}

static bool touches(const imp_instant *at) { return at->gap <= slack(at); }

/* The gap at the instant, its bodies placed, from the normal seed (NULL: none). glance: it may lie beyond the contact.
 */
static impact_status solve(const imp_chase *q, const qvec3 *seed, bool glance, imp_instant *at)
{
    impact_gap_cache cache = {0};
    if (seed) cache = (impact_gap_cache){true, *seed};
    const impact_status status = glance ? imp_gap_glance(&at->body[0], &at->body[1], &cache, &at->contact)
                                        : impact_gap(&at->body[0], &at->body[1], &cache, &at->contact);
    if (status < 0 || (glance && status != IMPACT_OK)) return status;
    note_contact(q, at);
    return status;
}

/* One look ahead turns the faster body by no more than this, rad. */
static const double longest_turn = 0.5;

/* The search: before `here` there is no contact. `waiting`: later instants without contact, or (the first) at the
 * contact, the nearest last, all of them before `beyond`, where the bodies overlap. */
typedef struct search {
    imp_chase q;
    double t_max;
    imp_instant here, last, beyond, waiting[MAX_WAITING]; /* last: before here, when followed */
    int waiting_count;
    bool crossed, followed; /* beyond is known, last is known */
    int stalls;             /* the bracket's steps that came to nothing much */
    double strike_gap;      /* below it Newton for the contact may be tried, again */
} search;

/* The gap's zero as it seems from the nearer end, by its rate there. */
static double foresee(const search *s)
{
    const imp_instant *here = &s->here, *beyond = &s->beyond;
    const bool far_end = s->crossed && -beyond->gap < here->gap;
    const imp_instant *near = far_end ? beyond : here;
    return near->rate < 0 ? near->t - near->gap / near->rate : far_end ? NAN : INFINITY;
}

/* Where to look next, nothing waiting. */
static double aim(search *s)
{
    const imp_instant *here = &s->here, *beyond = &s->beyond;
    const double reach = here->t + s->q.course.longest;
    double t = foresee(s);
    if (!s->crossed) return fmin(s->t_max, fmin(reach, t));
    if (!(t > here->t && t < beyond->t)) t = here->t + (beyond->t - here->t) * (here->gap / (here->gap - beyond->gap));
    if (s->stalls >= 3) t = 0.5 * (here->t + beyond->t), s->stalls = 0;
    return fmin(reach, t);
}

/* The normal as it seems at time t: from here's and another's, in a straight line. */
static qvec3 lean(const search *s, double t)
{
    const imp_instant *here = &s->here;
    const imp_instant *other = s->waiting_count > 0 ? &s->waiting[s->waiting_count - 1]
                               : s->crossed         ? &s->beyond
                                                    : &s->last;
    const qvec3 n = here->contact.normal;
    if (other == &s->last && !(s->followed && t - here->t < here->t - other->t)) return n;
    const double part = (t - here->t) / (other->t - here->t);
    const qvec3 m = qvec3_axpy(part, qvec3_sub(other->contact.normal, n), n);
    const double length = qvec3_norm(m);
    return length > 0.5 ? qvec3_scale(m, 1 / length) : n;
}

/* What is found at a later instant becomes beyond, or waits. */
static void keep(search *s, const imp_instant *at)
{
    if (at->gap < -slack(at)) {
        s->beyond = *at;
        s->crossed = true;
        s->waiting_count = 0;
    } else {
        if (touches(at)) s->waiting_count = 0;
        s->waiting[s->waiting_count++] = *at;
    }
}

/* Looks at time t; false when the cheap ways did not settle. */
static bool look(search *s, double t)
{
    imp_instant at;
    const qvec3 seed = lean(s, t);
    imp_instant_place(&s->q, t, true, &at);
    if (solve(&s->q, &seed, true, &at) != IMPACT_OK) return false;
    keep(s, &at);
    return true;
}

/* A time between here and the next is clear of contact along a normal between theirs, or along one of them. */
static bool glimpse(search *s, double t)
{
    imp_instant at;
    const imp_instant *next = &s->waiting[s->waiting_count - 1];
    if (s->q.plane[0] || s->q.plane[1]) return false;
    imp_instant_place(&s->q, t, false, &at);
    if (!imp_instant_sketch(&s->q, lean(s, t), &at) && !imp_instant_sketch(&s->q, next->contact.normal, &at) &&
        !imp_instant_sketch(&s->q, s->here.contact.normal, &at))
        return false;
    if (at.gap < 0.1 * (s->here.gap + fmax(0, next->gap))) return false;
    keep(s, &at);
    return true;
}

/* A time ahead is clear of contact along the normal that one guesses there, and the gap has not shrunk by much. */
static bool scout(search *s, double t)
{
    imp_instant at;
    if (s->crossed || s->q.plane[0] || s->q.plane[1]) return false;
    imp_instant_place(&s->q, t, false, &at);
    if (!imp_instant_sketch(&s->q, imp_gap_guess(&at.body[0], &at.body[1]), &at)) return false;
    if (at.gap < 0.2 * s->here.gap) return false;
    keep(s, &at);
    return true;
}

/* Newton for the contact, from here. */
static bool strike(search *s)
{
    const imp_instant *here = &s->here;
    const double high = s->crossed ? s->beyond.t : s->t_max;
    if (!(here->gap < s->strike_gap) || !(here->rate < 0) || !(s->crossed || here->t - here->gap / here->rate < high))
        return false;
    s->strike_gap = 0.25 * here->gap;
    imp_instant at;
    double t = here->t;
    if (!imp_gap_strike(&s->q.course, here->t, high, here->contact.normal, &t, &at.contact)) return false;
    if (!(t > here->t && t < high)) return false;
    imp_instant_place(&s->q, t, true, &at);
    note_contact(&s->q, &at);
    keep(s, &at);
    return true;
}

/* How the normal turned lately, rad/s. */
static qvec3 trend(const search *s)
{
    const qvec3 none = {0, 0, 0};
    if (!s->followed || !(qvec3_dot(s->last.contact.normal, s->here.contact.normal) > 0.5)) return none;
    return imp_toi_turn(s->last.contact.normal, s->here.contact.normal, s->here.t - s->last.t);
}

static void go_to(search *s, const imp_instant *next)
{
    s->last = s->here;
    s->followed = true;
    s->here = *next;
    if (s->waiting_count > 0 && s->waiting[s->waiting_count - 1].t <= next->t) s->waiting_count--;
}

/* Goes to time t, before which there is no contact; far: the gap itself is not needed there. */
static impact_status stride(search *s, double t, bool far)
{
    imp_instant next;
    const qvec3 seed = s->here.contact.normal;
    impact_status status = IMPACT_OK;
    imp_instant_place(&s->q, t, true, &next);
    if (!far || !imp_instant_sketch(&s->q, imp_gap_guess(&next.body[0], &next.body[1]), &next))
        status = solve(&s->q, &seed, false, &next);
    go_to(s, &next);
    return status;
}

/* Finds the gap at an instant where only a normal that parts the bodies was known. */
static impact_status settle(const search *s, imp_instant *at)
{
    const qvec3 seed = at->contact.normal;
    imp_instant_place(&s->q, at->t, true, at);
    return solve(&s->q, &seed, false, at);
}

/* On to an instant ahead of here, nothing waiting, without the gap at it: as far as the balls are clear, or to the
 * contact itself, or to a time when a normal is seen to part the bodies. False when none of that can be had. */
static bool set_forth(search *s, double t, impact_status *status)
{
    const imp_instant *here = &s->here;
    const double clear = s->crossed ? 0 : here->t + imp_toi_ball_step(&s->q, here, here->contact.normal);
    *status = IMPACT_OK;
    if (clear > here->t && clear >= t) {
        *status = stride(s, fmin(s->t_max, clear), true);
        return true;
    }
    return strike(s) || (t > here->t && scout(s, t));
}

/* One move on: links the instant that waits, or finds a new one, or steps by a proof that needs no other end. stuck: no
 * time lies between here and the contact. */
static impact_status move_on(search *s, bool *stuck)
{
    imp_instant *here = &s->here;
    imp_instant *next = s->waiting_count > 0 ? &s->waiting[s->waiting_count - 1] : NULL;
    if (next && imp_toi_link(&s->q, here, next)) {
        go_to(s, next);
        return IMPACT_OK;
    }
    if (next && next->t - here->t < 0.02 * s->q.course.longest && (here->sketched || next->sketched))
        return settle(s, here->sketched ? here : next); /* so near: their normals are bad */
    const double t = next ? 0.5 * (here->t + next->t) : aim(s);
    impact_status status;
    if (!next && set_forth(s, t, &status)) return status;
    if (!next && here->sketched) return settle(s, here);
    const double end = next ? next->t : s->crossed ? s->beyond.t : s->t_max;
    if (t > here->t && (t < end || end == s->t_max) && s->waiting_count < MAX_WAITING) {
        const double width = end - here->t;
        if (next && glimpse(s, t)) return IMPACT_OK;
        if (look(s, t)) {
            s->stalls = s->crossed && s->beyond.t - here->t > 0.5 * width ? s->stalls + 1 : 0;
            return IMPACT_OK;
        }
    }
    if (here->sketched) return settle(s, here);
    const double limit = fmin(end, fmax(t, here->t)),
                 safe = fmin(limit, here->t + imp_toi_safe_step(&s->q, here, trend(s), limit - here->t));
    *stuck = !(safe > here->t);
    return *stuck ? IMPACT_OK : stride(s, safe, false);
}

/* Whether the gap left is rounding's: of the length, or of the time. */
static bool near_enough(const imp_instant *at)
{
    return at->contact.upper <= fmax(IMP_TOI_NEAR * at->tolerance, IMP_TOI_TIME_NEAR * at->t * fabs(at->rate));
}

/* The time to which the bodies' bounding balls stay apart, and the line of their centres there. */
static double balls_apart_until(const search *s, qvec3 *line)
{
    imp_instant at = {.t = 0};
    for (int i = 0; i < MAX_BALL_STEPS; i++) {
        imp_instant_centres(&s->q, at.t, &at);
        const double distance = qvec3_norm(at.c);
        *line = distance > 0 ? qvec3_scale(at.c, 1 / distance) : (qvec3){0, 0, 1};
        const double step = imp_toi_ball_step(&s->q, &at, *line);
        if (!(step > IMP_TOI_BALL_STEP * at.t) || at.t >= s->t_max) break;
        at.t = fmin(s->t_max, at.t + step);
    }
    return at.t;
}

/* Where the search sets out: before, there is no contact. */
static impact_status set_out(search *s)
{
    imp_instant *here = &s->here;
    qvec3 n = {0, 0, 0};
    const bool plane = s->q.plane[0] || s->q.plane[1];
    imp_instant_place(&s->q, plane ? 0 : balls_apart_until(s, &n), true, here);
    if (plane || here->t >= s->t_max) return solve(&s->q, NULL, false, here);
    n = imp_gap_guess(&here->body[0], &here->body[1]);
    return imp_instant_sketch(&s->q, n, here) ? IMPACT_OK : solve(&s->q, &n, false, here);
}

static impact_status run(search *s)
{
    impact_status status = set_out(s);
    for (int step = 0; step < MAX_STEPS && status >= 0; step++) {
        bool stuck = false;
        if (touches(&s->here)) return IMPACT_OK;
        if (s->here.t >= s->t_max && !s->here.sketched) return IMPACT_NO_CONTACT;
        if (s->here.t >= s->t_max) {
            status = settle(s, &s->here);
            continue;
        }
        status = move_on(s, &stuck);
        if (stuck) return near_enough(&s->here) ? IMPACT_OK : IMPACT_EUNSETTLED;
    }
    return status < 0 ? status : IMPACT_EUNSETTLED;
}

/* What is asked, of bodies with unit orientations. */
static imp_chase chase_of(const impact_solid body[2], const impact_motion *motion1, const impact_motion *motion2)
{
    imp_chase q = {.course = {.body = {&body[0], &body[1]}, .motion = {motion1, motion2}}};
    for (int k = 0; k < 2; k++) {
        const impact_shape *shape = &body[k].shape;
        const qvec3 omega = q.course.motion[k]->omega;
        const double spin = qvec3_norm(omega);
        q.course.half_spin[k] = 0.5 * spin;
        if (spin > 0) q.course.axis[k] = quat_pure(qvec3_scale(omega, 1 / spin));
        q.plane[k] = shape->kind == IMPACT_PLANE;
        if (q.plane[k]) continue;
        q.radius[k] = outer_radius(shape);
        if (shape->kind == IMPACT_SPHERE) continue;
        q.omega[k] = omega;
        q.turning = fmax(q.turning, spin);
    }
    q.length = fmax(length_of(&body[0]), length_of(&body[1]));
    q.acceleration = qvec3_sub(motion1->acceleration, motion2->acceleration);
    q.course.longest = q.turning > 0 ? longest_turn / q.turning : INFINITY;
    return q;
}

static void set(search *s, const impact_solid body[2], const impact_motion *motion1, const impact_motion *motion2,
                double t_max)
{
    s->q = chase_of(body, motion1, motion2);
    s->t_max = t_max;
    s->waiting_count = s->stalls = 0;
    s->crossed = s->followed = false;
    s->strike_gap = closed_form(&body[0], &body[1]) ? 0 : INFINITY;
}

impact_status impact_toi(const impact_solid *body1, const impact_motion *motion1, const impact_solid *body2,
                         const impact_motion *motion2, double t_max, double *time, impact_contact *contact)
{
    *time = NAN;
    impact_solid body[2] = {*body1, *body2};
    impact_status status = check(body1, motion1);
    if (status == IMPACT_OK) status = check(body2, motion2);
    if (status == IMPACT_OK && !isfinite(t_max)) status = IMPACT_EDOMAIN;
    if (status == IMPACT_OK && t_max < 0) status = IMPACT_EARGUMENT;
    if (status == IMPACT_OK) status = imp_gap_check(body1, &body[0].orientation, body2, &body[1].orientation);
    if (status != IMPACT_OK) return status;
    search s;
    const imp_floats floats = imp_floats_hold();
    set(&s, body, motion1, motion2, t_max);
    status = run(&s);
    const bool wrong = status == IMPACT_OK && s.here.t > 0 && !imp_toi_holds(&s.q, &s.here);
    imp_floats_give_back(&floats);
    if (contact) *contact = s.here.contact;
    if (wrong) status = IMPACT_EUNSETTLED;
    if (status >= 0 || status == IMPACT_EUNSETTLED) *time = wrong ? 0 : s.here.t;
    return status;
}
