/* SPDX-License-Identifier: MIT
 *
 * search_parts (internal): what the search for contact is made of: closed forms of balls and of bounding balls
 * (search_closed.c), and what is seen at one time and how far on from there no contact can be (search_sight.c).
 */
#ifndef IMP_SEARCH_PARTS_H
#define IMP_SEARCH_PARTS_H

#include "motion/search.h"

static inline bool imp_search_turns(const imp_search *s, int k) { return imp_segment_turns(s->segment[k], s->body[k]); }
static inline bool imp_search_has_plane(const imp_search *s) { return s->body[1]->shape.kind == IMPACT_PLANE; }
static inline double imp_search_start(const imp_search *s) { return fmax(s->segment[0]->t0, s->segment[1]->t0); }
static inline double imp_search_end(const imp_search *s) { return fmin(s->segment[0]->t1, s->segment[1]->t1); }

/* Of an integrated motion: its step is of a fixed length; it is a pile's. */
static inline bool imp_search_is_fixed(const imp_search *s, int k)
{
    return s->segment[k]->kind == IMP_SEGMENT_DENSE && s->segment[k]->dense->fixed;
}

static inline bool imp_search_is_stepped(const imp_search *s, int k)
{
    return s->segment[k]->kind == IMP_SEGMENT_DENSE && s->segment[k]->dense->stepped;
}

static inline bool imp_search_same(qvec3 a, qvec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* ---- closed forms ---- */

/* Of balls that fall alike and of a ball over a plane; false: the bodies are others. */
bool imp_search_in_closed_form(const imp_search *s, double from, imp_found *found);

/* When two bodies on a line past each other have parted for good; infinite where that is not known. */
double imp_search_gone(const imp_search *s);

/* Nothing can happen before this: of the bounding balls, a little too large so that the time is never late. */
double imp_search_balls_meet(const imp_search *s, double from);

/* Whether the bounding balls are further apart than both come before the end. */
bool imp_search_is_out_of_reach(const imp_search *s, double from, double end);

/* ---- one time ---- */

/* What is known at one time of the search. */
typedef struct imp_sight {
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
} imp_sight;

/* known: the contact then; NULL: it is asked for. */
void imp_sight_look(const imp_search *s, double t, const impact_contact *known, imp_sight *l);

double imp_sight_scale(const imp_search *s, const imp_sight *l);

/* A rate of the gap that only rounding makes. */
double imp_sight_still_rate(const imp_search *s, const imp_sight *l);

/* How fast the gap's rate can fall within the window: by the centres, and by what turns. */
double imp_sight_most_bend(const imp_search *s, const imp_sight *l, double window);

/* A step over which the gap cannot fall to zero; of bodies that do not turn, on parabolas, the one in which it does. */
double imp_sight_step(const imp_search *s, const imp_sight *l, double gap);

/* Behind a plane, a step over which the gap cannot rise to zero: its normal is fixed and -h concave, below its
 * tangents. */
double imp_sight_step_behind(const imp_search *s, const imp_sight *l);

/* Whether the step is far less than what the gap's own rate promises, of bodies of which one turns and both have a
 * support function that knows where the normal goes. */
bool imp_sight_creeps(const imp_search *s, const imp_sight *l, double gap, double step);

/* Whether the direction of an earlier search proves, without a gap, that there is no contact before one of the segments
 * ends: of an integrator's short ones most end so. */
bool imp_sight_is_parted(const imp_search *s, double t);

#endif
