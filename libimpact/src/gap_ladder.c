/* SPDX-License-Identifier: MIT
 *
 * The ways to the gap, cheapest first. A gap >= 0 that Newton settles is the gap: g has no other local maximum. A negative one
 * is a local maximum; where it is deep, others are looked for.
 */
#include "gap_solver.h"
#include <string.h>

/* Deeper than this part of the smallest semi-axis, or of the smallest radius of both surfaces together at the contact, an overlap may
 * have several local answers. */
static const double deep_part = 0.05;

typedef struct search {
    const impact_pair *pair;
    impact_meeting best; /* the highest local maximum so far */
    impact_gap_path path;
    bool found;
    double thin;         /* smallest semi-axis */
    double low, low_n[3]; /* the largest g met, and where */
} search;

static bool done(const search *s)
{
    const double depth = -s->best.gap, radius = s->best.stiffness + depth;
    return s->found && (depth <= 1e-13 * s->pair->reach || depth <= deep_part * fmin(s->thin, radius));
}

static double distance_of(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* Newton from n and, when not NULL, the points x; true when the search is over. */
static bool try_from(search *s, const double n[3], const double (*x)[3], impact_gap_path path)
{
    impact_meeting meeting;
    if (impact_gap_newton(s->pair, n, x, &meeting) && (!s->found || meeting.gap > s->best.gap)) {
        s->best = meeting;
        s->path = path;
        s->found = true;
    }
    return done(s);
}

static void centre_line(const impact_pair *pair, double n[3])
{
    const double distance = distance_of(pair->c);
    for (int i = 0; i < 3; i++) n[i] = distance > 0 ? pair->c[i] / distance : i == 2;
}

/* Distance of the bodies, then of the bodies shrunk until they are apart, each to a few digits and then polished. */
static bool try_simplex(search *s, double *upper)
{
    static const double shrink[] = {1, 0.99, 0.9, 0.7, 0.45, 0.2, 0.05}, tolerance[] = {1e-2, 1e-4, 1e-7, 1e-11};
    for (size_t i = 0; i < sizeof shrink / sizeof *shrink; i++) {
        double n[3], x[2][3], low, high;
        centre_line(s->pair, n);
        for (size_t j = 0; j < sizeof tolerance / sizeof *tolerance; j++) {
            const bool apart = impact_gap_simplex(s->pair, shrink[i], tolerance[j], 20 << j, n, x, &low, &high) == IMPACT_SIMPLEX_APART;
            const double g = impact_pair_gap(s->pair, n, NULL);
            if (g > s->low) {
                s->low = g;
                memcpy(s->low_n, n, sizeof s->low_n);
            }
            if (shrink[i] == 1 && apart) *upper = fmin(*upper, high);
            if (try_from(s, n, (const double(*)[3])x, IMPACT_PATH_FALLBACK)) return true;
            if (try_from(s, n, NULL, IMPACT_PATH_FALLBACK)) return true;
            if (!apart) break;
        }
        if (shrink[i] == 1 && s->low > 0) break; /* apart: shrinking adds nothing */
    }
    return false;
}

/* The bodies' axes, towards each other and away. */
static bool try_axes(search *s)
{
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++)
            for (int side = -1; side <= 1; side += 2) {
                const double(*m)[3] = s->pair->form[k].rotation;
                const double n[3] = {side * m[0][i], side * m[1][i], side * m[2][i]};
                if (try_from(s, n, NULL, IMPACT_PATH_FALLBACK)) return true;
            }
    return false;
}

/* All exponents go from 2 to their own along p_t - 1 = (p - 1)^t, each stage seeding the next. */
static bool try_homotopy(search *s)
{
    double n[3];
    centre_line(s->pair, n);
    for (int stage = 0; stage <= 8; stage++) {
        impact_pair eased = *s->pair;
        for (int k = 0; k < 2; k++) {
            impact_form *form = &eased.form[k];
            for (int i = 0; i < 4; i++) form->p[i] = 1 + pow(form->p[i] - 1, stage / 8.0);
            if (stage == 0) form->round = form->uniform = true, form->nested = false;
        }
        impact_meeting meeting;
        if (impact_gap_newton(&eased, n, NULL, &meeting)) memcpy(n, meeting.n, sizeof n);
    }
    return try_from(s, n, NULL, IMPACT_PATH_FALLBACK);
}

/* No way settled: the best that is known for certain. */
static impact_status bracket(search *s, double upper, impact_meeting *meeting)
{
    double x[2][3];
    memcpy(meeting->n, s->low_n, sizeof meeting->n);
    meeting->lower = meeting->gap = impact_pair_gap(s->pair, meeting->n, x);
    memcpy(meeting->x, x, sizeof meeting->x);
    meeting->upper = fmax(upper, meeting->lower);
    meeting->stiffness = 0;
    return IMPACT_BRACKET;
}

impact_status impact_gap_settle(const impact_pair *pair, const double *cached, impact_meeting *meeting, impact_gap_path *path)
{
    search s = {.pair = pair, .low = -INFINITY, .thin = INFINITY};
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++) s.thin = fmin(s.thin, pair->form[k].axis[i]);
    double n[3], upper = distance_of(pair->c);
    centre_line(pair, n);
    bool over = (cached && try_from(&s, cached, NULL, IMPACT_PATH_NEWTON)) || try_from(&s, n, NULL, IMPACT_PATH_NEWTON);
    over = over || (impact_gap_harvest(pair, false, n) && try_from(&s, n, NULL, IMPACT_PATH_GJK));
    over = over || try_simplex(&s, &upper) || try_homotopy(&s);
    if (!over) over = impact_gap_harvest(pair, true, n) && try_from(&s, n, NULL, IMPACT_PATH_GJK);
    over = over || try_axes(&s);
    *path = s.found ? s.path : IMPACT_PATH_FALLBACK;
    if (!s.found) return bracket(&s, upper, meeting);
    *meeting = s.best;
    return over ? IMPACT_OK : IMPACT_DEEP;
}
