/* SPDX-License-Identifier: MIT
 *
 * The far end comes first: Newton for the contact itself, or for the gap at times that the gap's rate foretells; then
 * what lies between is cleared, halved where no proof (search_proof) clears it at once. At a time between it is enough
 * to know a normal that parts the bodies.
 */
#include "motion/search_window.h"
#include "base/tolerances.h"
#include "world/world_gap.h"

enum { MOST_MOVES = 200, MOST_WAITING = 40 };

/* Before `here` there is no contact. `waiting`: later instants without contact, or (the first) at the contact, the
 * nearest last, all of them before `beyond`, where the bodies overlap. */
typedef struct chase {
    imp_window w;
    imp_instant here, beyond, waiting[MOST_WAITING];
    int waiting_count;
    bool crossed;      /* beyond is known */
    int stalls;        /* the bracket's steps that came to nothing much */
    double strike_gap; /* below it Newton for the contact may be tried, again */
} chase;

/* What a gap may be for its rounding, or for that of the time. */
static double slack_of(const imp_instant *at)
{
    return fmax(at->tolerance, IMP_TOI_TIME_ROUNDING * fabs(at->t * at->rate));
}

static bool touches(const imp_instant *at) { return at->gap <= slack_of(at); }

/* The gap at the instant, its bodies placed, from the normal seed (NULL: none). glance: it may lie beyond the contact.
 */
static bool solve(const chase *s, const qvec3 *seed, bool glance, imp_instant *at)
{
    impact_gap_cache cache = {0};
    if (seed) cache = (impact_gap_cache){true, *seed};
    const impact_status status = glance ? imp_gap_glance(&at->body[0], &at->body[1], &cache, &at->contact)
                                        : impact_gap(&at->body[0], &at->body[1], &cache, &at->contact);
    imp_count_gap(at->contact.path, s->w.of->usage);
    if (status < 0 || (glance && status != IMPACT_OK)) return false;
    imp_instant_note(&s->w, at);
    return true;
}

/* The gap's zero as it seems from the nearer end, by its rate there. */
static double foresee(const chase *s)
{
    const imp_instant *here = &s->here, *beyond = &s->beyond;
    const bool far_end = s->crossed && -beyond->gap < here->gap;
    const imp_instant *near = far_end ? beyond : here;
    return near->rate < 0 ? near->t - near->gap / near->rate : far_end ? NAN : INFINITY;
}

/* Where to look next, nothing waiting. */
static double aim(chase *s)
{
    const imp_instant *here = &s->here, *beyond = &s->beyond;
    double t = foresee(s);
    const double reach = here->t + s->w.longest;
    if (!s->crossed) return fmin(s->w.t1, fmin(reach, t));
    if (!(t > here->t && t < beyond->t)) t = here->t + (beyond->t - here->t) * (here->gap / (here->gap - beyond->gap));
    if (s->stalls >= 3) t = 0.5 * (here->t + beyond->t), s->stalls = 0;
    return fmin(reach, t);
}

/* The normal as it seems at time t: from here's and another's, in a straight line. */
static qvec3 lean(const chase *s, double t)
{
    const imp_instant *here = &s->here, *other = s->waiting_count > 0 ? &s->waiting[s->waiting_count - 1] : &s->beyond;
    const qvec3 n = here->contact.normal;
    if (s->waiting_count == 0 && !s->crossed) return n;
    const double part = (t - here->t) / (other->t - here->t);
    const qvec3 m = qvec3_axpy(part, qvec3_sub(other->contact.normal, n), n);
    const double length = qvec3_norm(m);
    return length > 0.5 ? qvec3_scale(m, 1 / length) : n;
}

/* What is found at a later instant becomes beyond, or waits. */
static void keep(chase *s, const imp_instant *at)
{
    if (at->gap < -slack_of(at)) {
        s->beyond = *at;
        s->crossed = true;
        s->waiting_count = 0;
    } else {
        if (touches(at)) s->waiting_count = 0;
        s->waiting[s->waiting_count++] = *at;
    }
}

/* Looks at time t; false when the cheap ways did not settle. */
static bool look(chase *s, double t)
{
    imp_instant at;
    const qvec3 seed = lean(s, t);
    imp_instant_place(&s->w, t, &at);
    if (!solve(s, &seed, true, &at)) return false;
    keep(s, &at);
    return true;
}

/* A time between here and the next is clear of contact along a normal between theirs, or along one of them. */
static bool glimpse(chase *s, double t)
{
    imp_instant at;
    const imp_instant *next = &s->waiting[s->waiting_count - 1];
    imp_instant_place(&s->w, t, &at);
    if (!imp_instant_sketch(&s->w, lean(s, t), &at) && !imp_instant_sketch(&s->w, next->contact.normal, &at) &&
        !imp_instant_sketch(&s->w, s->here.contact.normal, &at))
        return false;
    if (at.gap < IMP_WINDOW_GLIMPSE * (s->here.gap + fmax(0, next->gap))) return false;
    keep(s, &at);
    return true;
}

/* A time ahead is clear of contact along the normal that one guesses there, and the gap has not shrunk by much. */
static bool scout(chase *s, double t)
{
    imp_instant at;
    if (s->crossed) return false;
    imp_instant_place(&s->w, t, &at);
    if (!imp_instant_sketch(&s->w, imp_gap_guess(&at.body[0], &at.body[1]), &at)) return false;
    if (at.gap < IMP_WINDOW_SCOUT * s->here.gap) return false;
    keep(s, &at);
    return true;
}

static void moved_at(const void *of, double t, imp_gap_moved *moved)
{
    const imp_window *w = of;
    qvec3 v[2];
    for (int k = 0; k < 2; k++) {
        const imp_body *body = w->of->body[k];
        const imp_state state = imp_segment_at(w->of->segment[k], body, t);
        const qvec3 none = {0, 0, 0};
        moved->body[k] = imp_solid_of(body, &state);
        moved->omega[k] = w->turns[k] ? imp_omega(body, &state) : none;
        v[k] =
            body->shifted ? qvec3_add(state.v, qvec3_cross(moved->omega[k], imp_shape_offset(body, &state))) : state.v;
    }
    moved->v = qvec3_sub(v[0], v[1]);
}

/* Newton for the contact, from here. */
static bool strike(chase *s)
{
    const imp_instant *here = &s->here;
    const double high = s->crossed ? s->beyond.t : s->w.t1;
    if (!(here->gap < s->strike_gap) || !(here->rate < 0) || !(s->crossed || here->t - here->gap / here->rate < high))
        return false;
    s->strike_gap = 0.25 * here->gap;
    const imp_gap_course course = {.at = moved_at, .of = &s->w, .longest = s->w.longest};
    imp_instant at;
    double t = here->t;
    if (!imp_gap_strike(&course, here->t, high, here->contact.normal, &t, &at.contact)) return false;
    imp_count_gap(IMPACT_PATH_NEWTON, s->w.of->usage);
    if (!(t > here->t && t < high)) return false;
    imp_instant_place(&s->w, t, &at);
    imp_instant_note(&s->w, &at);
    keep(s, &at);
    return true;
}

static void go_to(chase *s, const imp_instant *next)
{
    s->here = *next;
    s->waiting_count--;
}

/* Finds the gap at an instant where only a normal that parts the bodies was known. */
static bool settle(const chase *s, imp_instant *at)
{
    const qvec3 seed = at->contact.normal;
    imp_instant_place(&s->w, at->t, at);
    return solve(s, &seed, false, at);
}

/* Looks nearer where the far end did not settle, as where the bodies overlap by then: half as far each time. */
static bool look_nearer(chase *s, double t)
{
    for (int k = 0; k < MOST_WAITING; k++) {
        t = 0.5 * (s->here.t + t);
        if (!(t > s->here.t)) return false;
        if (scout(s, t) || look(s, t)) return true;
    }
    return false;
}

/* One move on: links the instant that waits, or finds a new one. False: neither can be had. */
static bool move_on(chase *s)
{
    imp_instant *here = &s->here;
    imp_instant *next = s->waiting_count > 0 ? &s->waiting[s->waiting_count - 1] : NULL;
    if (next && imp_search_link(&s->w, here, next)) {
        go_to(s, next);
        return true;
    }
    if (next && next->t - here->t < IMP_WINDOW_NEAR * s->w.longest && (here->sketched || next->sketched))
        return settle(s, here->sketched ? here : next); /* so near: their normals are bad */
    const double t = next ? 0.5 * (here->t + next->t) : aim(s), end = next         ? next->t
                                                                      : s->crossed ? s->beyond.t
                                                                                   : s->w.t1;
    if (!next && (strike(s) || (t > here->t && scout(s, t)))) return true;
    if (!next && here->sketched) return settle(s, here);
    if (t > here->t && (t < end || end == s->w.t1) && s->waiting_count < MOST_WAITING) {
        const double width = end - here->t;
        if (next && glimpse(s, t)) return true;
        if (look(s, t)) {
            s->stalls = s->crossed && s->beyond.t - here->t > 0.5 * width ? s->stalls + 1 : 0;
            return true;
        }
        if (!next && !here->sketched) return look_nearer(s, t);
    }
    return here->sketched && settle(s, here);
}

static bool is_apart(const imp_instant *at) { return at->gap > IMP_TOUCHING / IMP_TOI_ROUNDING * at->tolerance; }

/* Where the window begins: a normal parts the bodies, or their gap is known. */
static bool set_out(chase *s, const impact_contact *known)
{
    imp_instant *here = &s->here;
    imp_instant_place(&s->w, s->w.t0, here);
    if (known) {
        here->contact = *known;
        imp_instant_take(&s->w, here);
        return is_apart(here);
    }
    const qvec3 n = imp_gap_guess(&here->body[0], &here->body[1]);
    return (imp_instant_sketch(&s->w, n, here) && is_apart(here)) || (solve(s, &n, false, here) && is_apart(here));
}

imp_reached imp_search_window(const imp_search *search, double t, double end, const impact_contact *known)
{
    chase s;
    s.waiting_count = s.stalls = 0;
    s.crossed = false;
    s.strike_gap = INFINITY;
    imp_window_open(search, t, end, &s.w);
    if (!isfinite(s.w.t1) || !set_out(&s, known)) return (imp_reached){.t = t};
    for (int i = 0; i < MOST_MOVES && s.here.t < s.w.t1 && !touches(&s.here) && move_on(&s); i++)
        ;
    const bool met = touches(&s.here) && s.here.rate < 0;
    return (imp_reached){.t = s.here.t,
                         .touches = met,
                         .cleared = !met && s.here.t >= s.w.t1,
                         .known = !s.here.sketched && is_apart(&s.here),
                         .contact = s.here.contact};
}
