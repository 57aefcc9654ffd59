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
#include "base/tolerances.h"
#include "motion/search_parts.h"
#include "motion/search_window.h"
#include "world/world_gap.h"

#include <float.h>

/* Between a time before the contact and one behind it, where the gap is below the slack: the Illinois form of regula
 * falsi. */
static double bisect(const imp_search *s, double low, double gap_low, double high, double gap_high, double slack)
{
    imp_sight l;
    imp_bracket b = {.low = low, .high = high, .at_low = gap_low, .at_high = gap_high};
    for (int i = 0; i < IMP_BRACKET_MOST && b.at_low != b.at_high; i++) {
        const double t = imp_bracket_guess(&b);
        if (t == b.low || t == b.high) break;
        imp_sight_look(s, t, NULL, &l);
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

/* Where bodies crawl along each other: over a dip, A T^2/8, that is no deeper than what is all but closed, or, while
 * they part, than what counts as touching, A T^2/2; of a fixed step, which is long behind a bounce too, over no other.
 */
static double crawl(const imp_search *s, const imp_sight *l, double longest, double closed, double touching)
{
    const double bend = imp_sight_most_bend(s, l, longest), flat = bend > 0 ? sqrt(2 * touching / bend) : INFINITY,
                 least = bend > 0 ? fmin(longest, sqrt(8 * closed / bend)) : longest;
    double step = least;
    if (imp_search_is_fixed(s, 0) || imp_search_is_fixed(s, 1))
        step = fmin(least, 2 * flat);
    else if (l->rate >= 0)
        step = fmax(least, flat);
    return fmin(step, l->window);
}

/* How much nearer any points of the bodies can come in the shortest time that there is after t. */
static double nearer_at_once(const imp_search *s, const imp_sight *l, double t)
{
    double speed = qvec3_norm(qvec3_sub(l->state[0].v, l->state[1].v));
    for (int k = 0; k < 2; k++)
        if (imp_search_turns(s, k)) speed += s->body[k]->radius * qvec3_norm(imp_omega(s->body[k], &l->state[k]));
    return speed * (nextafter(t, INFINITY) - t);
}

/* A time between the two at which what was leaving at the first had left, further than what counts as touching; NaN:
 * none. */
static double away_between(const imp_search *s, double from, double t, double touching, double *gap)
{
    enum { HALVINGS = 8 };
    imp_sight l;
    double part = 0.5;
    for (int i = 0; i < HALVINGS; i++, part *= 0.5) {
        imp_sight_look(s, from + part * (t - from), NULL, &l);
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
    if (s->beyond || balls || imp_search_has_plane(s) || (s->gaps && s->gaps->method == IMPACT_GAP_CCD)) return false;
    for (int k = 0; k < 2; k++)
        if (imp_search_is_fixed(s, k) || imp_search_is_stepped(s, k)) return false;
    return true;
}

static march march_from(const imp_search *s, double from)
{
    march m = {
        .of = s, .start = imp_search_start(s), .least = shortest_step(s), .gone = INFINITY, .gap_before = INFINITY};
    m.end = imp_search_end(s);
    m.error = imp_gap_error(s->gaps, s->body[0], s->body[1]);
    m.ahead = may_look_ahead(s);
    if (m.ahead) m.gone = imp_search_gone(s);
    m.t = m.before = from + (from == m.start ? imp_search_balls_meet(s, from) : 0);
    return m;
}

static double touching_of(const march *m, const imp_sight *l)
{
    return IMP_TOUCHING * imp_sight_scale(m->of, l) + m->error;
}

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
static bool settle_start(march *m, const imp_sight *l, imp_found *found)
{
    const imp_search *s = m->of;
    const double gap = l->contact.lower, touching = touching_of(m, l);
    if (m->t == m->start) {
        const bool still = fabs(l->rate) <= imp_sight_still_rate(s, l);
        m->slack = touching + fmax(0, -gap); /* of bodies that began with an overlap */
        m->leaving =
            fabs(gap) <= m->slack && (still || (l->rate > 0 && (imp_search_turns(s, 0) || imp_search_turns(s, 1))));
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
static bool touch(const march *m, const imp_sight *l, double gap, imp_found *found)
{
    const imp_search *s = m->of;
    const double rounding = IMP_GAP_ROUNDING * imp_sight_scale(s, l) + m->error,
                 most_rate = m->t > m->start ? imp_sight_still_rate(s, l) : -DBL_MIN;
    if (gap < -touching_of(m, l) && m->gap_before > 0 && isfinite(m->gap_before))
        return met(m, bisect(s, m->before, m->gap_before, m->t, gap, m->leaving ? m->slack : 0), NULL, found);
    return gap <= rounding && l->rate <= most_rate && met(m, m->t, &l->contact, found);
}

/* A step in which there is no contact, or none that is not passed over. */
static double step_from(const march *m, const imp_sight *l, double gap)
{
    const imp_search *s = m->of;
    const double closed = IMP_ALL_BUT_CLOSED * imp_sight_scale(s, l);
    const bool near = gap <= closed && gap + l->rate * m->least > 0;
    const double step = m->least > 0 && near ? crawl(s, l, m->least, closed, touching_of(m, l)) : 0;
    return step < l->window ? fmax(step, imp_sight_step(s, l, fmax(gap, 0))) : step; /* they part from where they are */
}

/* One step on; true: *found is the answer. */
static bool go_on(march *m, imp_found *found)
{
    const imp_search *s = m->of;
    imp_sight l;
    imp_reached reached = {.known = false};
    *found = (imp_found){INFINITY, false};
    if (m->ahead && !m->leaving && m->least == 0) {
        reached = look_ahead(m, NULL);
        if (reached.touches) return met(m, m->t, &reached.contact, found);
        if (reached.cleared) return m->t >= m->end;
    }
    imp_sight_look(s, m->t, reached.known ? &reached.contact : NULL, &l);
    if (s->axis) *s->axis = l.contact.normal;
    double gap = l.contact.lower, step;
    if (s->beyond) {
        step = imp_sight_step_behind(s, &l);
    } else {
        if (settle_start(m, &l, found)) return true;
        if (m->leaving) gap += m->slack;
        if (touch(m, &l, gap, found)) return true;
        step = step_from(m, &l, gap);
        if (m->ahead && m->least > 0 && !m->leaving && imp_sight_creeps(s, &l, gap, step)) {
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
    if (m.least > 0 && from == m.start && (imp_search_is_out_of_reach(s, from, m.end) || imp_sight_is_parted(s, from)))
        return never;
    for (int i = 0; i < IMP_SEARCH_QUERIES && m.t <= m.end && m.t < m.gone; i++) {
        imp_found found;
        if (m.t > until && !m.leaving && m.least == 0) return (imp_found){m.t, false};
        if (go_on(&m, &found)) return found;
    }
    return m.t <= m.end && m.t < m.gone ? (imp_found){m.t, false} : never;
}

imp_found imp_search_contact(const imp_search *s, double from, double until)
{
    imp_found found;
    return imp_search_in_closed_form(s, from, &found) ? found : advance(s, from, until);
}
