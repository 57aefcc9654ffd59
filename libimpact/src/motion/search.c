/* SPDX-License-Identifier: MIT
 *
 * The one search for contact: of scenes, and of impact_toi (toi.c). It goes from time to time, before each of which
 * there is no contact, and each follows from the last and the segments alone. In order:
 *
 *  1. Balls that fall alike, and a ball over a plane: the zero of a quadratic.
 *  2. While bounding balls are apart: their zero.
 *  3. Two bodies with support functions, in closed form: a window in which they turn by some radians, its far end
 *     first (search_window.c), cleared by links between times at which normals part the bodies (search_proof.c):
 *     with g0, g1 the gaps there and K a bound of second order in the time between, sqrt(g0) + sqrt(g1) >= sqrt(K).
 *  4. Planes, integrated motions, and where a window ends for want of a proof: a step of psi (psi.c). From a time at
 *     which the gap is g, with normal n, w = n . (v1 - v2), a = a1 - a2 and J no less than the centres' jerks over the
 *     time W that is left, m = n in a body's axes, h its support function and r its radius: for T <= W
 *
 *       psi(T) = g + w T - A T^2/2 - sum over the bodies that turn [h(m + m' T) - h(m) + h(m'') T^2/2 + r j T^3/6],
 *       A = max(0, -n.a + J W/3),  j >= |m'''|
 *
 *     is concave and never more than the gap T later, as h is convex and subadditive: psi(T) >= 0 proves that there is
 *     no contact until then. Steps to the zero of psi converge quadratically and never pass the contact. Integrated
 *     bodies whose steps creep, an edge along an edge, are looked at by a window (3).
 *
 * On the integrator's polynomials J W does not vanish, and bodies that stay next to each other would be followed in
 * steps of sqrt(2 g/A). Where the gap is all but closed, below c, and its rate alone would not close it in a 64th of
 * the segment, a step is that long at least, or sqrt(8 c/A): what dips below zero and rises again within it, by less
 * than A (W/64)^2/8 and c, is passed over.
 */
#include "motion/search.h"
#include "base/bracket.h"
#include "motion/psi.h"
#include "motion/search_window.h"
#include "world/normal.h"
#include "world/world_gap.h"

#include <impact/flight.h>

#include <float.h>

/* ---- closed forms ---- */

static bool falls(const imp_segment *s) { return s->kind == IMP_SEGMENT_FREE || s->kind == IMP_SEGMENT_ROLL; }

static bool same(qvec3 a, qvec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* Centres on a straight line towards each other. */
static bool fall_alike(const imp_search *s)
{
    const imp_segment *a = s->segment[0], *b = s->segment[1];
    return imp_segment_is_parabola(a) && imp_segment_is_parabola(b) && same(a->acceleration, b->acceleration);
}

static bool is_plane(const imp_body *body) { return body->shape.kind == IMPACT_PLANE; }

static qvec3 centres_apart(const imp_search *s, double t, qvec3 *velocity)
{
    qvec3 v1, v2;
    const qvec3 x1 = imp_segment_place(s->segment[0], s->body[0], t, &v1);
    const qvec3 x2 = imp_segment_place(s->segment[1], s->body[1], t, &v2);
    *velocity = qvec3_sub(v1, v2);
    return qvec3_sub(x1, x2);
}

/* The time in which two balls at d with the velocity w come to the distance R: (d.d - R^2)/(b + sqrt(w.w R^2 - |d x
 * w|^2)), b = -d.w. */
static double line_time(qvec3 d, qvec3 w, double R)
{
    const double b = -qvec3_dot(d, w);
    if (!(b > 0)) return INFINITY;
    const qvec3 aside = qvec3_cross(d, w);
    const double left = qvec3_dot(w, w) * R * R - qvec3_dot(aside, aside);
    if (!(left >= 0)) return INFINITY;
    return fmax(qvec3_dot(d, d) - R * R, 0) / (b + sqrt(left));
}

static double start_of(const imp_search *s) { return fmax(s->segment[0]->t0, s->segment[1]->t0); }

/* When two bodies on a line past each other have parted for good; infinite where that is not known. */
static double gone_by(const imp_search *s)
{
    if (is_plane(s->body[1]) || !fall_alike(s)) return INFINITY;
    qvec3 w;
    const qvec3 d = centres_apart(s, start_of(s), &w), aside = qvec3_cross(d, w);
    const double R = (s->body[0]->radius + s->body[1]->radius) * (1 + IMP_SEARCH_BALLS), square = qvec3_dot(w, w),
                 left = square * R * R - qvec3_dot(aside, aside), b = -qvec3_dot(d, w);
    if (!(square > 0)) return INFINITY;
    return start_of(s) + fmax(0, (b + sqrt(fmax(0, left))) / square);
}

static qvec3 plane_normal(const imp_search *s) { return quat_rotate(s->segment[1]->start.q, (qvec3){0, 0, 1}); }

/* Nothing can happen before this: of the bounding balls, a little too large so that the time is never late. */
static double balls_meet(const imp_search *s, double from)
{
    const double reach = s->body[0]->radius + (is_plane(s->body[1]) ? 0 : s->body[1]->radius);
    qvec3 w;
    if (s->beyond) return 0;
    const qvec3 d = centres_apart(s, from, &w);
    if (is_plane(s->body[1])) {
        if (!falls(s->segment[0])) return 0;
        const qvec3 n = plane_normal(s);
        const double bound = qvec3_dot(n, d) - reach * (1 + IMP_SEARCH_BALLS);
        return bound > 0 ? impact_flight_fall_time(bound, qvec3_dot(n, w), qvec3_dot(n, s->segment[0]->acceleration))
                         : 0;
    }
    if (!fall_alike(s)) return 0;
    const double edge = reach * (1 + IMP_SEARCH_BALLS);
    return qvec3_dot(d, d) > edge * edge ? line_time(d, w, edge) : 0;
}

/* ---- psi ---- */

static bool turns(const imp_search *s, int k) { return imp_segment_turns(s->segment[k], s->body[k]); }

/* ---- advancement ---- */

/* What is known at one time of the search. */
typedef struct sight {
    double t;
    imp_state state[2];
    imp_bounds bounds[2];
    imp_spin spin[2];
    impact_contact contact;
    double rate;   /* d(gap)/dt */
    double window; /* s: to the end of the shorter segment */
    qvec3 pull;    /* relative acceleration */
    double jerk;   /* of both centres, where one of them is no parabola */
    bool parabola;
} sight;

static void see_motion(const imp_search *s, double t, sight *l)
{
    l->t = t;
    l->window = fmin(s->segment[0]->t1, s->segment[1]->t1) - t;
    l->parabola = true;
    l->jerk = 0;
    for (int k = 0; k < 2; k++) {
        const imp_segment *segment = s->segment[k];
        l->state[k] = imp_segment_at(segment, s->body[k], t);
        l->bounds[k] = imp_segment_bounds(segment, s->body[k], t, l->window);
        l->spin[k] = turns(s, k) ? imp_segment_spin(segment, s->body[k], &l->state[k], &l->bounds[k], l->window)
                                 : (imp_spin){.most = 0};
        if (imp_segment_is_parabola(segment)) continue;
        l->parabola = false;
        /* damping's acceleration keeps its direction and only falls: it bends by no more than it does now, and by
         * nothing back */
        l->jerk += segment->kind == IMP_SEGMENT_DAMPED ? 0 : l->bounds[k].jerk;
    }
    l->pull = qvec3_sub(l->bounds[0].acceleration, l->bounds[1].acceleration);
}

/* veer: the rate of `towards`, held; most: |veer| T is no more. */
static void add_turning(imp_psi *p, const imp_search *s, int k, const sight *l, qvec3 towards, qvec3 veer, double most)
{
    const bool veers = !same(veer, (qvec3){0, 0, 0}), spins = turns(s, k);
    if (!spins && !veers) return;
    const imp_body *body = s->body[k];
    const imp_spin *spin = &l->spin[k];
    imp_turning *b = &p->body[p->count++];
    b->body = body;
    b->m = quat_rotate_inverse(l->state[k].q, towards);
    const qvec3 along = veers ? quat_rotate_inverse(l->state[k].q, veer) : veer;
    b->rate = qvec3_add(qvec3_cross(b->m, spin->omega), along);
    b->second = qvec3_add(qvec3_cross(qvec3_add(b->rate, along), spin->omega), qvec3_cross(b->m, spin->rate));
    qvec3 point;
    b->h = imp_world_support(body, b->m, &point);
    p->slope -= qvec3_dot(b->rate, point);
    p->spread += body->radius * qvec3_norm(b->second);
    p->jerk += body->radius * ((1 + most) * spin->third + 3 * qvec3_norm(veer) * spin->second);
}

static bool is_fixed(const imp_search *s, int k)
{
    return s->segment[k]->kind == IMP_SEGMENT_DENSE && s->segment[k]->dense->fixed;
}

static bool is_stepped(const imp_search *s, int k)
{
    return s->segment[k]->kind == IMP_SEGMENT_DENSE && s->segment[k]->dense->stepped;
}

/* known: the contact then; NULL: it is asked for. */
static void look_at(const imp_search *s, double t, const impact_contact *known, sight *l)
{
    see_motion(s, t, l);
    if (known)
        l->contact = *known;
    else
        imp_gap_of(s->body[0], &l->state[0], s->body[1], &l->state[1], s->gaps, s->usage, &l->contact);
    if (is_stepped(s, 0) || is_stepped(s, 1))
        imp_settle_normal(s->body[0], &l->state[0], s->body[1], &l->state[1], imp_stepped_flush(s->body[0], s->body[1]),
                          &l->contact);
    const qvec3 still = {0, 0, 0};
    const qvec3 omega1 = imp_omega(s->body[0], &l->state[0]);
    const qvec3 omega2 = s->body[1]->is_static ? still : imp_omega(s->body[1], &l->state[1]);
    l->rate = impact_gap_rate(&l->contact, l->state[0].v, omega1, l->state[1].v, omega2);
}

/* The centres' part of A; each damped one's falls by itself. */
static double bend_of(const imp_search *s, const sight *l, qvec3 n)
{
    if (l->parabola) return -qvec3_dot(n, l->pull);
    double bend = 0, others = 0;
    for (int k = 0; k < 2; k++) {
        const double along = qvec3_dot(k ? qvec3_neg(n) : n, l->bounds[k].acceleration);
        if (s->segment[k]->kind == IMP_SEGMENT_DAMPED)
            bend += fmax(0, -along);
        else
            others += along;
    }
    const double drift = l->jerk > 0 ? l->jerk * l->window / 3 : 0;
    return bend + drift - others;
}

/* Whether the step is far less than what the gap's own rate promises. */
static bool creeps_on(const sight *l, double gap, double step)
{
    return step < l->window && (l->rate >= 0 || step < IMP_CREEPING * gap / -l->rate);
}

/* The same of bodies of which one turns and both have a support function that knows where the normal goes. */
static bool creeps(const imp_search *s, const sight *l, double gap, double step)
{
    return !is_plane(s->body[1]) && (turns(s, 0) || turns(s, 1)) && creeps_on(l, gap, step);
}

/* The same with a direction n + n' T that goes along: two edges stay across it, and a corner does not fall behind on
 * one. Any n' proves what it does. */
static double step_going_along(const imp_search *s, const sight *l, double gap, qvec3 turned)
{
    const qvec3 n = l->contact.normal, veer = qvec3_axpy(-qvec3_dot(turned, n), n, turned);
    const double rate = qvec3_norm(veer), limit = fmin(l->window, 0.5 / rate);
    const qvec3 v = qvec3_sub(l->state[0].v, l->state[1].v), c = qvec3_sub(l->state[0].x, l->state[1].x);
    if (!(rate > 0) || !isfinite(rate)) return 0;
    const double speed = qvec3_dot(n, v) + qvec3_dot(veer, c), along = -2 * qvec3_dot(veer, v);
    imp_psi p = {.gap = gap, .speed = speed, .slope = speed};
    if (l->parabola) {
        p.bend = along - qvec3_dot(n, l->pull);
        p.jerk = 3 * fmax(0, -qvec3_dot(veer, l->pull));
    } else {
        const double most = qvec3_norm(l->bounds[0].acceleration) + qvec3_norm(l->bounds[1].acceleration);
        p.bend = along + bend_of(s, l, n);
        p.jerk = 3 * rate * (most + (l->jerk > 0 ? l->jerk * l->window : 0));
    }
    add_turning(&p, s, 0, l, qvec3_neg(n), qvec3_neg(veer), 0.5);
    add_turning(&p, s, 1, l, n, veer, 0.5);
    return imp_psi_safe_step(&p, limit);
}

/* Of such directions that which the contact's normals have a little earlier and later: where it turns on as it did, or
 * otherwise from here on, the rates of before and after tell, and their mean neither. */
static double step_veering(const imp_search *s, const sight *l, double gap)
{
    const double spin = l->spin[0].most + l->spin[1].most, apart = IMP_VEERING / spin;
    if (!(spin > 0)) return 0;
    qvec3 turned[2];
    for (int k = 0; k < 2; k++) {
        const double then = k ? apart : -apart; /* as they move now: their segments may be shorter */
        const imp_state a = imp_drifted(s->body[0], &l->state[0], then),
                        b = imp_drifted(s->body[1], &l->state[1], then);
        impact_contact contact;
        imp_gap_of(s->body[0], &a, s->body[1], &b, s->gaps, s->usage, &contact);
        turned[k] = qvec3_scale(qvec3_sub(contact.normal, l->contact.normal), 1 / then);
    }
    const double step = step_going_along(s, l, gap, qvec3_scale(qvec3_add(turned[0], turned[1]), 0.5));
    if (!creeps_on(l, gap, step)) return step;
    return fmax(step, fmax(step_going_along(s, l, gap, turned[0]), step_going_along(s, l, gap, turned[1])));
}

static double scale_of(const imp_search *s, const sight *l)
{
    return imp_place_scale(s->body[0], l->state[0].x, s->body[1], l->state[1].x, l->contact.normal);
}

/* The step that psi allows along the contact's normal, where that leaves a gap. */
static double step_along(const imp_search *s, const sight *l, double gap)
{
    const qvec3 n = l->contact.normal, none = {0, 0, 0};
    const double speed = qvec3_dot(n, qvec3_sub(l->state[0].v, l->state[1].v));
    imp_psi p = {.gap = gap, .speed = speed, .slope = speed, .bend = bend_of(s, l, n)};
    add_turning(&p, s, 0, l, qvec3_neg(n), none, 0);
    add_turning(&p, s, 1, l, n, none, 0);
    return imp_psi_safe_step(&p, l->window);
}

/* What the body reaches along n from its centre of mass. */
static double reach_of(const imp_body *body, const imp_state *state, qvec3 n)
{
    qvec3 point;
    return imp_world_support(body, quat_rotate_inverse(state->q, n), &point);
}

/* Whether the bounding balls are further apart than both come before one of the segments ends. */
static bool is_out_of_reach(const imp_search *s, double from, double end)
{
    qvec3 w;
    const qvec3 d = centres_apart(s, from, &w);
    const bool plane = is_plane(s->body[1]);
    const double reach = s->body[0]->radius + (plane ? 0 : s->body[1]->radius),
                 apart = plane ? qvec3_dot(plane_normal(s), d) : qvec3_norm(d),
                 left = apart - reach * (1 + IMP_SEARCH_BALLS);
    if (s->beyond || !(left > 0)) return false;
    double speed = 0;
    for (int k = 0; k < 2; k++) /* over all of its segment, as it is asked of every pair */
        speed += imp_segment_bounds(s->segment[k], s->body[k], from, s->segment[k]->t1 - from).speed;
    return speed * (end - from) < left;
}

/* Whether the direction of an earlier search proves, without a gap, that there is no contact before one of the segments
 * ends: of an integrator's short ones most end so. */
static bool is_parted(const imp_search *s, double t)
{
    if (!s->axis || s->beyond || is_plane(s->body[1]) || same(*s->axis, (qvec3){0, 0, 0})) return false;
    sight l;
    see_motion(s, t, &l);
    const qvec3 n = l.contact.normal = *s->axis;
    const double gap = qvec3_dot(n, qvec3_sub(l.state[0].x, l.state[1].x)) -
                       reach_of(s->body[0], &l.state[0], qvec3_neg(n)) - reach_of(s->body[1], &l.state[1], n);
    const double touching = IMP_TOUCHING * scale_of(s, &l);
    return gap > touching && l.window > 0 && step_along(s, &l, gap - touching) >= l.window;
}

/* A step over which the gap cannot fall to zero; of bodies that do not turn, on parabolas, the one in which it does. */
static double step_before(const imp_search *s, const sight *l, double gap)
{
    const qvec3 n = l->contact.normal;
    const double speed = qvec3_dot(n, qvec3_sub(l->state[0].v, l->state[1].v));
    if (l->parabola && !turns(s, 0) && !turns(s, 1)) return impact_flight_fall_time(gap, speed, qvec3_dot(n, l->pull));
    const double step = step_along(s, l, gap);
    return creeps(s, l, gap, step) ? fmax(step, step_veering(s, l, gap)) : step;
}

/* Behind a plane, a step over which the gap cannot rise to zero: its normal is fixed and -h concave, below its
 * tangents. */
static double step_behind(const imp_search *s, const sight *l)
{
    const qvec3 n = l->contact.normal;
    const double deep = fmax(0, -l->contact.gap);
    const double drift = l->jerk > 0 ? l->jerk * l->window / 3 : 0, pull = qvec3_dot(n, l->pull);
    imp_psi p = {.slope = qvec3_dot(n, l->state[0].v)};
    add_turning(&p, s, 0, l, qvec3_neg(n), (qvec3){0, 0, 0}, 0);
    const double bend = p.count > 0 || !l->parabola ? fmax(0, pull) + drift + p.spread : pull;
    double low = 0, high = impact_flight_fall_time(deep, -p.slope, -bend);
    if (p.jerk == 0) return high;
    high = fmin(high, 2 * fmax(cbrt(6 * deep / p.jerk), fmax(sqrt(6 * fmax(0, -p.slope) / p.jerk), 0)));
    for (int i = 0; i < 100 && high > low * (1 + IMP_SEARCH_BISECTED); i++) {
        const double T = 0.5 * (low + high);
        *(T * (p.slope + T * (0.5 * bend + T * p.jerk / 6)) < deep ? &low : &high) = T;
    }
    return low;
}

/* A rate of the gap that only rounding makes. */
static double still_rate(const imp_search *s, const sight *l)
{
    double speed = 0;
    for (int k = 0; k < 2; k++)
        if (turns(s, k)) speed += qvec3_norm(l->state[k].v) + s->body[k]->radius * l->spin[k].most;
    return s->still + IMP_STILL_OF_SPEED * speed;
}

/* Between a time before the contact and one behind it, where the gap is below the slack: the Illinois form of regula
 * falsi. */
static double bisect(const imp_search *s, double low, double gap_low, double high, double gap_high, double slack)
{
    sight l;
    imp_bracket b = {.low = low, .high = high, .at_low = gap_low, .at_high = gap_high};
    for (int i = 0; i < IMP_BRACKET_MOST && b.at_low != b.at_high; i++) {
        const double t = imp_bracket_guess(&b);
        if (t == b.low || t == b.high) break;
        look_at(s, t, NULL, &l);
        const double gap = l.contact.gap + slack;
        if (gap == 0) return t;
        imp_bracket_take(&b, t, gap, gap < 0);
    }
    return b.high;
}

static double shortest_step(const imp_search *s)
{
    double longest = INFINITY;
    for (int k = 0; k < 2; k++)
        if (s->segment[k]->kind == IMP_SEGMENT_DENSE) longest = fmin(longest, s->segment[k]->t1 - s->segment[k]->t0);
    return isfinite(longest) ? longest / IMP_CRAWL_PARTS : 0;
}

/* How fast the gap's rate can fall within the window: by the centres, and by what turns. */
static double most_bend(const imp_search *s, const sight *l, double window)
{
    sight near = *l;
    near.window = fmin(l->window, window);
    double bend = fmax(0, bend_of(s, &near, l->contact.normal));
    for (int k = 0; k < 2; k++)
        if (turns(s, k)) bend += s->body[k]->radius * (l->spin[k].most * l->spin[k].most + l->spin[k].second);
    return bend;
}

/* Where bodies crawl along each other: over a dip, A T^2/8, that is no deeper than what is all but closed, or, while
 * they part, than what counts as touching, A T^2/2; of a fixed step, which is long behind a bounce too, over no other.
 */
static double crawl(const imp_search *s, const sight *l, double longest, double closed, double touching)
{
    const double bend = most_bend(s, l, longest), flat = bend > 0 ? sqrt(2 * touching / bend) : INFINITY,
                 least = bend > 0 ? fmin(longest, sqrt(8 * closed / bend)) : longest;
    double step = least;
    if (is_fixed(s, 0) || is_fixed(s, 1))
        step = fmin(least, 2 * flat);
    else if (l->rate >= 0)
        step = fmax(least, flat);
    return fmin(step, l->window);
}

/* How much nearer any points of the bodies can come in the shortest time that there is after t. */
static double nearer_at_once(const imp_search *s, const sight *l, double t)
{
    double speed = qvec3_norm(qvec3_sub(l->state[0].v, l->state[1].v));
    for (int k = 0; k < 2; k++)
        if (turns(s, k)) speed += s->body[k]->radius * qvec3_norm(imp_omega(s->body[k], &l->state[k]));
    return speed * (nextafter(t, INFINITY) - t);
}

/* A time between the two at which what was leaving at the first had left, further than what counts as touching; NaN:
 * none. */
static double away_between(const imp_search *s, double from, double t, double touching, double *gap)
{
    enum { HALVINGS = 8 };
    sight l;
    double part = 0.5;
    for (int i = 0; i < HALVINGS; i++, part *= 0.5) {
        look_at(s, from + part * (t - from), NULL, &l);
        *gap = l.contact.lower;
        if (*gap > touching) return l.t;
    }
    return NAN;
}

/* What is sought, and how far the search has come: before t there is no contact. */
typedef struct march {
    const imp_search *of;
    double start, end, gone; /* no contact after `gone`, nor is one asked for after `end` */
    double least;            /* a part of an integrator's step, where one of the segments is one; else 0 */
    double error;            /* of the gaps, m */
    bool ahead;              /* windows may be looked over */
    double t, before, gap_before;
    bool leaving; /* they touched at the start, and are no further apart yet: */
    double slack; /* what their gap may fall to */
} march;

/* Whether both have a support function and Newton answers for their gap; of steps of a fixed length it is not asked. */
static bool may_look_ahead(const imp_search *s)
{
    const bool balls = imp_is_ball(s->body[0]) && imp_is_ball(s->body[1]);
    if (s->beyond || balls || is_plane(s->body[1]) || (s->gaps && s->gaps->method == IMPACT_GAP_CCD)) return false;
    for (int k = 0; k < 2; k++)
        if (is_fixed(s, k) || is_stepped(s, k)) return false;
    return true;
}

static march march_from(const imp_search *s, double from)
{
    march m = {.of = s, .start = start_of(s), .least = shortest_step(s), .gone = INFINITY, .gap_before = INFINITY};
    m.end = fmin(s->segment[0]->t1, s->segment[1]->t1);
    m.error = imp_gap_error(s->gaps, s->body[0], s->body[1]);
    m.ahead = may_look_ahead(s);
    if (m.ahead) m.gone = gone_by(s);
    m.t = m.before = from + (from == m.start ? balls_meet(s, from) : 0);
    return m;
}

static double touching_of(const march *m, const sight *l) { return IMP_TOUCHING * scale_of(m->of, l) + m->error; }

static bool met(const march *m, double t, const impact_contact *contact, imp_found *found)
{
    if (m->of->contact && contact) *m->of->contact = *contact;
    *found = (imp_found){t, true};
    return true;
}

/* Over a window of both motions: whether that settles the matter. known: the contact at its start, or NULL; then that
 * at the time reached, where it is known. */
static imp_reached look_ahead(march *m, const impact_contact *known)
{
    const imp_search *s = m->of;
    const imp_reached reached = imp_search_window(s, m->t, fmin(m->end, m->gone), known);
    if (reached.t > m->t) m->t = reached.t, m->gap_before = INFINITY;
    if (s->axis && reached.known) *s->axis = reached.contact.normal;
    return reached;
}

/* What is made of bodies that touched at the start; true: they meet. */
static bool settle_start(march *m, const sight *l, imp_found *found)
{
    const imp_search *s = m->of;
    const double gap = l->contact.lower, touching = touching_of(m, l);
    if (m->t == m->start) {
        const bool still = fabs(l->rate) <= still_rate(s, l);
        m->slack = touching + fmax(0, -gap); /* of bodies that began with an overlap */
        m->leaving = fabs(gap) <= m->slack && (still || (l->rate > 0 && (turns(s, 0) || turns(s, 1))));
    } else if (m->leaving && l->rate < 0) { /* a step that had the slack may have passed over a whole bounce */
        double high;
        const double away = away_between(s, m->before, m->t, touching, &high);
        if (isfinite(away) && gap < 0) return met(m, bisect(s, away, high, m->t, gap, 0), NULL, found);
        m->leaving = !isfinite(away);
    }
    m->leaving = m->leaving && gap <= touching;
    return false;
}

/* Whether they touch: between the last look and this one, or now. gap: with the slack of what leaves. */
static bool touch(const march *m, const sight *l, double gap, imp_found *found)
{
    const imp_search *s = m->of;
    const double rounding = IMP_GAP_ROUNDING * scale_of(s, l) + m->error,
                 most_rate = m->t > m->start ? still_rate(s, l) : -DBL_MIN;
    if (gap < -touching_of(m, l) && m->gap_before > 0 && isfinite(m->gap_before))
        return met(m, bisect(s, m->before, m->gap_before, m->t, gap, m->leaving ? m->slack : 0), NULL, found);
    return gap <= rounding && l->rate <= most_rate && met(m, m->t, &l->contact, found);
}

/* A step in which there is no contact, or none that is not passed over. */
static double step_from(const march *m, const sight *l, double gap)
{
    const imp_search *s = m->of;
    const double closed = IMP_ALL_BUT_CLOSED * scale_of(s, l);
    const bool near = gap <= closed && gap + l->rate * m->least > 0;
    const double step = m->least > 0 && near ? crawl(s, l, m->least, closed, touching_of(m, l)) : 0;
    return step < l->window ? fmax(step, step_before(s, l, fmax(gap, 0))) : step; /* they part from where they are */
}

/* One step on; true: *found is the answer. */
static bool go_on(march *m, imp_found *found)
{
    const imp_search *s = m->of;
    sight l;
    imp_reached reached = {.known = false};
    *found = (imp_found){INFINITY, false};
    if (m->ahead && !m->leaving && m->least == 0) {
        reached = look_ahead(m, NULL);
        if (reached.touches) return met(m, m->t, &reached.contact, found);
        if (reached.cleared) return m->t >= m->end;
    }
    look_at(s, m->t, reached.known ? &reached.contact : NULL, &l);
    if (s->axis) *s->axis = l.contact.normal;
    double gap = l.contact.lower, step;
    if (s->beyond) {
        step = step_behind(s, &l);
    } else {
        if (settle_start(m, &l, found)) return true;
        if (m->leaving) gap += m->slack;
        if (touch(m, &l, gap, found)) return true;
        step = step_from(m, &l, gap);
        if (m->ahead && m->least > 0 && !m->leaving && creeps(s, &l, gap, step)) {
            const double t = m->t;
            reached = look_ahead(m, &l.contact);
            if (reached.touches) return met(m, m->t, &reached.contact, found);
            if (m->t > t + step) return m->t >= m->end;
            m->t = t;
        }
    }
    m->before = m->t, m->gap_before = gap;
    if (l.window <= 0 || !(m->t + step <= m->end) || step == INFINITY) return true;
    /* a stretch in which time all but stands bounds the rates of no gap: what is wide open stays so */
    if (m->t + step == m->t && (s->beyond || gap <= touching_of(m, &l) + nearer_at_once(s, &l, m->t)))
        return met(m, m->t, &l.contact, found);
    m->t = fmax(m->t + step, nextafter(m->t, INFINITY));
    return false;
}

static imp_found advance(const imp_search *s, double from, double until)
{
    const imp_found never = {INFINITY, false};
    march m = march_from(s, from);
    if (m.least > 0 && from == m.start && (is_out_of_reach(s, from, m.end) || is_parted(s, from))) return never;
    for (int i = 0; i < IMP_SEARCH_QUERIES && m.t <= m.end && m.t < m.gone; i++) {
        imp_found found;
        if (m.t > until && !m.leaving && m.least == 0) return (imp_found){m.t, false};
        if (go_on(&m, &found)) return found;
    }
    return m.t <= m.end && m.t < m.gone ? (imp_found){m.t, false} : never;
}

/* Whether the line from d along w passes the origin at the distance R at most: most do not. */
static bool passes_within(qvec3 d, qvec3 w, double R)
{
    const qvec3 aside = qvec3_cross(d, w);
    return qvec3_dot(w, w) * R * R - qvec3_dot(aside, aside) >= 0;
}

/* Two balls in a straight line to each other. Such as touch and come no nearer than rounding brings them meet where
 * they overlap by more than that. */
static imp_found meet_in_line(const imp_search *s, double from)
{
    qvec3 w;
    const qvec3 d = centres_apart(s, from, &w);
    const double R = s->body[0]->radius + s->body[1]->radius;
    if (!(qvec3_dot(d, w) < 0) || !passes_within(d, w, R)) return (imp_found){INFINITY, false};
    const qvec3 n = qvec3_scale(d, 1 / R), x1 = s->segment[0]->start.x, x2 = s->segment[1]->start.x;
    const double slack = IMP_TOUCHING * imp_place_scale(s->body[0], x1, s->body[1], x2, n);
    const bool touches = qvec3_dot(d, d) <= R * (R + 2 * slack), still = qvec3_dot(n, w) >= -s->still;
    const double met = from + line_time(d, w, touches && still ? R - slack : R);
    const double end = fmin(s->segment[0]->t1, s->segment[1]->t1);
    return isfinite(met) && met <= end ? (imp_found){met, true} : (imp_found){INFINITY, false};
}

/* A ball over a plane, on a parabola: the same. */
static imp_found meet_plane(const imp_search *s, double from)
{
    qvec3 w;
    const qvec3 d = centres_apart(s, from, &w), n = plane_normal(s);
    const double end = fmin(s->segment[0]->t1, s->segment[1]->t1), rate = qvec3_dot(n, w),
                 pull = qvec3_dot(n, s->segment[0]->acceleration), gap = qvec3_dot(n, d) - s->body[0]->radius;
    const double slack = IMP_TOUCHING * imp_place_scale(s->body[0], qvec3_add(s->segment[1]->start.x, d), s->body[1],
                                                        s->segment[1]->start.x, n);
    const bool touches = gap <= slack, still = rate >= -s->still && rate <= s->still;
    if (touches && rate < -s->still) return (imp_found){from, true};
    const double deep = touches && still ? slack + fmax(0, -gap) : 0;
    const double met = from + impact_flight_fall_time(fmax(gap, 0) + deep, rate, pull);
    return isfinite(met) && met <= end ? (imp_found){met, true} : (imp_found){INFINITY, false};
}

imp_found imp_search_contact(const imp_search *s, double from, double until)
{
    const bool ball = imp_is_ball(s->body[0]);
    if (ball && imp_is_ball(s->body[1]) && fall_alike(s)) return meet_in_line(s, from);
    if (ball && is_plane(s->body[1]) && falls(s->segment[0]) && !s->beyond) return meet_plane(s, from);
    return advance(s, from, until);
}
