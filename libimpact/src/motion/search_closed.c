/* SPDX-License-Identifier: MIT */
#include "base/tolerances.h"
#include "motion/search_parts.h"
#include "world/world_gap.h"

#include <impact/flight.h>

static bool falls(const imp_segment *s) { return s->kind == IMP_SEGMENT_FREE || s->kind == IMP_SEGMENT_ROLL; }

/* Centres on a straight line towards each other. */
static bool fall_alike(const imp_search *s)
{
    const imp_segment *a = s->segment[0], *b = s->segment[1];
    return imp_segment_is_parabola(a) && imp_segment_is_parabola(b) &&
           imp_search_same(a->acceleration, b->acceleration);
}

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

double imp_search_gone(const imp_search *s)
{
    if (imp_search_has_plane(s) || !fall_alike(s)) return INFINITY;
    qvec3 w;
    const qvec3 d = centres_apart(s, imp_search_start(s), &w), aside = qvec3_cross(d, w);
    const double R = (s->body[0]->radius + s->body[1]->radius) * (1 + IMP_SEARCH_BALLS), square = qvec3_dot(w, w),
                 left = square * R * R - qvec3_dot(aside, aside), b = -qvec3_dot(d, w);
    if (!(square > 0)) return INFINITY;
    return imp_search_start(s) + fmax(0, (b + sqrt(fmax(0, left))) / square);
}

static qvec3 plane_normal(const imp_search *s) { return quat_rotate(s->segment[1]->start.q, (qvec3){0, 0, 1}); }

double imp_search_balls_meet(const imp_search *s, double from)
{
    const double reach = s->body[0]->radius + (imp_search_has_plane(s) ? 0 : s->body[1]->radius);
    qvec3 w;
    if (s->beyond) return 0;
    const qvec3 d = centres_apart(s, from, &w);
    if (imp_search_has_plane(s)) {
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

bool imp_search_is_out_of_reach(const imp_search *s, double from, double end)
{
    qvec3 w;
    const qvec3 d = centres_apart(s, from, &w);
    const bool plane = imp_search_has_plane(s);
    const double reach = s->body[0]->radius + (plane ? 0 : s->body[1]->radius),
                 apart = plane ? qvec3_dot(plane_normal(s), d) : qvec3_norm(d),
                 left = apart - reach * (1 + IMP_SEARCH_BALLS);
    if (s->beyond || !(left > 0)) return false;
    double speed = 0;
    for (int k = 0; k < 2; k++) /* over all of its segment, as it is asked of every pair */
        speed += imp_segment_bounds(s->segment[k], s->body[k], from, s->segment[k]->t1 - from).speed;
    return speed * (end - from) < left;
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
    const double end = imp_search_end(s);
    return isfinite(met) && met <= end ? (imp_found){met, true} : (imp_found){INFINITY, false};
}

/* A ball over a plane, on a parabola: the same. */
static imp_found meet_plane(const imp_search *s, double from)
{
    qvec3 w;
    const qvec3 d = centres_apart(s, from, &w), n = plane_normal(s);
    const double end = imp_search_end(s), rate = qvec3_dot(n, w), pull = qvec3_dot(n, s->segment[0]->acceleration),
                 gap = qvec3_dot(n, d) - s->body[0]->radius;
    const double slack = IMP_TOUCHING * imp_place_scale(s->body[0], qvec3_add(s->segment[1]->start.x, d), s->body[1],
                                                        s->segment[1]->start.x, n);
    const bool touches = gap <= slack, still = rate >= -s->still && rate <= s->still;
    if (touches && rate < -s->still) return (imp_found){from, true};
    const double deep = touches && still ? slack + fmax(0, -gap) : 0;
    const double met = from + impact_flight_fall_time(fmax(gap, 0) + deep, rate, pull);
    return isfinite(met) && met <= end ? (imp_found){met, true} : (imp_found){INFINITY, false};
}

bool imp_search_in_closed_form(const imp_search *s, double from, imp_found *found)
{
    if (!imp_is_ball(s->body[0])) return false;
    if (imp_is_ball(s->body[1]) && fall_alike(s))
        *found = meet_in_line(s, from);
    else if (imp_search_has_plane(s) && falls(s->segment[0]) && !s->beyond)
        *found = meet_plane(s, from);
    else
        return false;
    return true;
}
