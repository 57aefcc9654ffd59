/* SPDX-License-Identifier: MIT
 *
 * Newton for witness points and time at once: the surface points face each other and meet. Convex bodies whose normals
 * oppose where they meet are parted by the plane there, so that each such time is one of gap zero.
 */
#include "base/tolerances.h"
#include "gap/gap_face.h"

enum { STRIKE_STEPS = 32, MAX_TURNS = 3, MAX_TRIMS = 4 };

typedef struct strike {
    const imp_gap_course *course;
    double scale, t;
    imp_gap_moved moved;
    imp_gap_solids pair;
    imp_face face;
    imp_drift drift;
} strike;

static void spin(qvec3 omega, const imp_chart *chart, double x[3], double N[3])
{
    const double w[3] = {omega.x, omega.y, omega.z};
    imp_cross(w, chart->x, x);
    imp_cross(w, chart->N, N);
}

static void place(strike *s)
{
    s->course->at(s->course->of, s->t, &s->moved);
    for (int k = 0; k < 2; k++) imp_form_turn(&s->pair.form[1 - k], s->moved.body[k].orientation);
    imp_gap_apart(qvec3_sub(s->moved.body[0].position, s->moved.body[1].position), s->scale, &s->pair);
}

/* Bodies, points and drift at s->t; false when the normals do not face each other. */
static bool look(strike *s, const imp_surface surface[2])
{
    place(s);
    if (!imp_face_look(&s->pair, surface, &s->face)) return false;
    spin(s->moved.omega[1], &s->face.chart[0], s->drift.x[0], s->drift.N[0]);
    spin(s->moved.omega[0], &s->face.chart[1], s->drift.x[1], s->drift.N[1]);
    const qvec3 v = s->moved.v;
    s->drift.x[1][0] += v.x * s->scale, s->drift.x[1][1] += v.y * s->scale, s->drift.x[1][2] += v.z * s->scale;
    return true;
}

/* The rate of the gap, less than 0 while the bodies close. */
static double closing(const strike *s) { return imp_dot(s->face.m, s->drift.x[1]) - imp_dot(s->face.m, s->drift.x[0]); }

/* The points face each other: trims the time to the gap's zero, and the points to the time as it is rounded. */
static bool trim(strike *s, imp_surface surface[2], double low, double high, double *t, impact_contact *contact)
{
    double least = INFINITY, last;
    for (int i = 0; i < MAX_TRIMS; i++) {
        imp_gap_bracket meeting;
        const double rate = closing(s);
        if (!imp_face_judge(&s->pair, &s->face, &meeting) || !meeting.shares || !(rate < 0)) break;
        const double width = meeting.upper - meeting.lower, off = fabs(meeting.lower) + width;
        if (off < least) {
            least = off;
            *t = s->t;
            imp_gap_contact(&s->moved.body[0], &s->moved.body[1], s->scale, &meeting, IMPACT_PATH_NEWTON, contact);
        }
        const double next = fmin(high, fmax(low, s->t - meeting.lower / rate));
        const bool there = fabs(meeting.lower) <= IMP_TOI_ROUNDING * s->pair.reach || next == s->t;
        if (there && width <= IMP_GAP_TIGHT * s->pair.reach) break;
        if (!there) s->t = next;
        double step[2][2];
        imp_face_step(&s->pair, &s->face, step);
        if (!imp_face_advance(&s->pair, &s->face, step, surface, &last) || !look(s, surface)) break;
    }
    return least < INFINITY;
}

/* How far the time may move: on, while the bodies are apart and near no contact; back, where they overlap. */
static void reins(const strike *s, double low, double high, double *least, double *most)
{
    const double longest = s->course->longest, near = IMP_STRIKE_NEAR * s->pair.size, rate = closing(s),
                 gap = s->face.vm;
    *least = fmax(low - s->t, -longest);
    *most = fmin(high - s->t, longest);
    if (gap > near)
        *least = rate < 0 ? fmin(*most, -0.5 * gap / rate) : *most;
    else if (gap < -near && rate >= 0)
        *most = *least;
}

bool imp_gap_strike(const imp_gap_course *course, double low, double high, qvec3 n, double *t, impact_contact *contact)
{
    strike s = {.course = course, .t = *t};
    course->at(course->of, *t, &s.moved);
    const impact_solid *one = &s.moved.body[0], *other = &s.moved.body[1];
    if (one->shape.rounding > 0 || other->shape.rounding > 0) return false; /* of cores alone */
    const double normal[3] = {n.x, n.y, n.z};
    imp_surface surface[2];
    s.scale = imp_gap_scale(one, other);
    imp_gap_pair(one, one->orientation, other, other->orientation, s.scale, &s.pair);
    imp_face_start(&s.pair, normal, NULL, surface);
    double last = INFINITY;
    for (int i = 0, turns = 0, trims = 0; i < STRIKE_STEPS; i++) {
        if (!look(&s, surface)) return false;
        if (last < IMP_GAP_LAST_STEP) {
            if (trim(&s, surface, low, high, t, contact)) return true;
            if (++trims == MAX_TURNS) return false;
        }
        double step[2][2], dt, least, most;
        reins(&s, low, high, &least, &most);
        imp_face_strike(&s.pair, &s.face, &s.drift, least, most, step, &dt);
        if ((s.t == low && dt <= 0) || (s.t == high && dt >= 0))
            if (++turns == MAX_TURNS) return false;
        if (!imp_face_advance(&s.pair, &s.face, step, surface, &last)) return false;
        if (last > 0.5) dt *= 0.5 / last;
        last = fmax(last, fabs(dt * closing(&s)));
        s.t += dt;
    }
    return false;
}
