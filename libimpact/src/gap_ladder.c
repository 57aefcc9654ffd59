/* SPDX-License-Identifier: MIT
 *
 * The ways to the gap, cheapest first. A gap >= 0 that Newton settles is the gap: g has no other local maximum. A
 * negative one is a local maximum; where it is deep, others are looked for.
 */
#include "gap_solver.h"
#include <string.h>

/* Deeper than this part of the smallest semi-axis, or of the smallest radius of both surfaces together at the contact,
 * an overlap may have several local answers. */
static const double deep_part = 0.05;

enum { SEED_STEPS = 4 };

typedef struct search {
    const impact_pair *pair;
    impact_meeting best; /* the highest local maximum so far */
    impact_gap_path path;
    bool found;
    double thin;          /* smallest semi-axis */
    bool sharp;           /* both bodies have edges or vertices: every overlap counts as deep */
    double low, low_n[3]; /* the largest g met, and where */
} search;

/* Below this exponent a body has edges; two such bodies may overlap shallowly in more than one way. */
static const double sharp_exponent = 1.3;

static bool is_sharp(const impact_form *form)
{
    return form->p[0] < sharp_exponent || form->p[1] < sharp_exponent || form->p[2] < sharp_exponent;
}

static bool done(const search *s)
{
    if (!s->found) return false;
    const double depth = -s->best.gap, radius = s->best.stiffness + depth;
    return depth <= 1e-13 * s->pair->reach || (!s->sharp && depth <= deep_part * fmin(s->thin, radius));
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

/* M = R diag(axis^2) R^T, the ellipsoid a body is taken for here. */
static void add_ellipsoid(const impact_form *form, double scale, double M[3][3])
{
    for (int k = 0; k < 3; k++) {
        const double square = scale * form->axis[k] * form->axis[k];
        for (int i = 0; i < 3; i++)
            for (int j = i; j < 3; j++) M[i][j] += square * form->rotation[i][k] * form->rotation[j][k];
    }
}

static double ellipsoid_height(const impact_form *form, const double n[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double w =
            form->axis[k] * (form->rotation[0][k] * n[0] + form->rotation[1][k] * n[1] + form->rotation[2][k] * n[2]);
        sum += w * w;
    }
    return sqrt(sum);
}

/* n = M^-1 c normalised, by cofactors; M symmetric and positive, its upper half filled. */
static bool solve_for_normal(double M[3][3], const double c[3], double n[3])
{
    const double a = M[1][1] * M[2][2] - M[1][2] * M[1][2], b = M[0][2] * M[1][2] - M[0][1] * M[2][2],
                 d = M[0][1] * M[1][2] - M[0][2] * M[1][1], e = M[0][0] * M[2][2] - M[0][2] * M[0][2],
                 f = M[0][1] * M[0][2] - M[0][0] * M[1][2], g = M[0][0] * M[1][1] - M[0][1] * M[0][1];
    const double x[3] = {a * c[0] + b * c[1] + d * c[2], b * c[0] + e * c[1] + f * c[2],
                         d * c[0] + f * c[1] + g * c[2]};
    const double length = distance_of(x);
    if (!(length > 0) || !(x[0] * c[0] + x[1] * c[1] + x[2] * c[2] > 0)) return false;
    for (int i = 0; i < 3; i++) n[i] = x[i] / length;
    return true;
}

/* The normal for the bodies' ellipsoids: fixed points of n ~ (M_A/h_A + M_B/h_B + g I)^-1 c, from the centre line. */
static void ellipsoid_seed(const impact_pair *pair, int steps, double n[3])
{
    for (int k = 0; k < steps; k++) {
        const double h[2] = {ellipsoid_height(&pair->form[0], n), ellipsoid_height(&pair->form[1], n)};
        const double g = fmax(0, n[0] * pair->c[0] + n[1] * pair->c[1] + n[2] * pair->c[2] - h[0] - h[1]);
        double M[3][3] = {{g, 0, 0}, {0, g, 0}, {0, 0, g}};
        for (int i = 0; i < 2; i++) add_ellipsoid(&pair->form[i], 1 / h[i], M);
        if (!solve_for_normal(M, pair->c, n)) return;
    }
}

/* Distance of the bodies, then of the bodies shrunk until they are apart, each to a few digits and then polished. */
static bool try_simplex(search *s, double *upper)
{
    static const double shrink[] = {1, 0.99, 0.9, 0.7, 0.45, 0.2, 0.05}, tolerance[] = {1e-2, 1e-4, 1e-7, 1e-11};
    for (size_t i = 0; i < sizeof shrink / sizeof *shrink; i++) {
        double n[3], x[2][3], low, high;
        centre_line(s->pair, n);
        for (size_t j = 0; j < sizeof tolerance / sizeof *tolerance; j++) {
            const bool apart = impact_gap_simplex(s->pair, shrink[i], tolerance[j], 20 << j, n, x, &low, &high) ==
                               IMPACT_SIMPLEX_APART;
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

/* Steps of many lengths up g's slope from the best normal met: for two vertices in touch, whose g is flat at 0. */
static bool try_slope(search *s)
{
    for (int round = 0; round < 8; round++) {
        double x[2][3], v[3], along = 0, best[3], highest = s->low;
        impact_pair_gap(s->pair, s->low_n, x);
        for (int i = 0; i < 3; i++) v[i] = s->pair->c[i] + x[1][i] - x[0][i];
        for (int i = 0; i < 3; i++) along += v[i] * s->low_n[i];
        for (int i = 0; i < 3; i++) v[i] -= along * s->low_n[i];
        const double slope = distance_of(v);
        if (!(slope > 0)) return false;
        for (double step = 1; step > 1e-7; step /= 2) {
            double n[3];
            for (int i = 0; i < 3; i++) n[i] = s->low_n[i] + step * v[i] / slope;
            const double length = distance_of(n);
            for (int i = 0; i < 3; i++) n[i] /= length;
            const double g = impact_pair_gap(s->pair, n, NULL);
            if (g > highest) highest = g, memcpy(best, n, sizeof best);
        }
        if (!(highest > s->low)) return false;
        s->low = highest;
        memcpy(s->low_n, best, sizeof best);
        if (try_from(s, best, NULL, IMPACT_PATH_FALLBACK)) return true;
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

/* No way settled: the best that is known for certain. The support points of any normal are no nearer than the bodies. */
static impact_status bracket(const search *s, double upper, impact_meeting *meeting)
{
    double v[3];
    memcpy(meeting->n, s->low_n, sizeof meeting->n);
    meeting->lower = meeting->gap = impact_pair_gap(s->pair, meeting->n, meeting->x);
    for (int i = 0; i < 3; i++) v[i] = s->pair->c[i] + meeting->x[1][i] - meeting->x[0][i];
    meeting->upper = fmax(fmin(upper, distance_of(v)), meeting->lower);
    meeting->stiffness = 0;
    return meeting->upper - meeting->lower <= 2e-14 * s->pair->reach ? IMPACT_OK : IMPACT_BRACKET;
}

bool impact_gap_first(const impact_pair *pair, const double *cached, impact_meeting *meeting, impact_gap_path *path)
{
    double n[3];
    *path = IMPACT_PATH_NEWTON;
    if (cached && impact_gap_newton(pair, cached, NULL, meeting)) return true;
    centre_line(pair, n);
    ellipsoid_seed(pair, SEED_STEPS, n);
    if (impact_gap_newton(pair, n, NULL, meeting)) return true;
    *path = IMPACT_PATH_GJK;
    return impact_gap_harvest(pair, false, n) && impact_gap_newton(pair, n, NULL, meeting);
}

impact_status impact_gap_settle(const impact_pair *pair, const double *cached, impact_meeting *meeting,
                                impact_gap_path *path)
{
    search s = {.pair = pair,
                .low = -INFINITY,
                .thin = INFINITY,
                .sharp = is_sharp(&pair->form[0]) && is_sharp(&pair->form[1])};
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++) s.thin = fmin(s.thin, pair->form[k].axis[i]);
    double n[3], upper = distance_of(pair->c);
    centre_line(pair, n);
    bool over = cached && try_from(&s, cached, NULL, IMPACT_PATH_NEWTON);
    if (!over) {
        ellipsoid_seed(pair, SEED_STEPS, n);
        over = try_from(&s, n, NULL, IMPACT_PATH_NEWTON);
    }
    over = over || (impact_gap_harvest(pair, false, n) && try_from(&s, n, NULL, IMPACT_PATH_GJK));
    over = over || try_simplex(&s, &upper) || (!s.found && (try_slope(&s) || try_homotopy(&s)));
    if (!over) over = impact_gap_harvest(pair, true, n) && try_from(&s, n, NULL, IMPACT_PATH_GJK);
    over = over || try_axes(&s);
    *path = s.found ? s.path : IMPACT_PATH_FALLBACK;
    if (!s.found) return bracket(&s, upper, meeting);
    *meeting = s.best;
    return over ? IMPACT_OK : IMPACT_DEEP;
}
