/* SPDX-License-Identifier: MIT
 *
 * The ways to the gap, cheapest first. A gap >= 0 that Newton settles is the gap: g has no other local maximum. A
 * negative one is a local maximum; where it is deep, others are looked for.
 */
#include "gap/gap_chart.h"
#include "gap/gap_solver.h"
#include "base/tolerances.h"
#include "gap/gap_walk.h"
#include "shape/solid.h"
#include <string.h>

enum { SEED_STEPS = 4, MAX_PROOFS = 8, APART_STEPS = 60 };

typedef struct search {
    const imp_gap_solids *pair;
    imp_gap_bracket best; /* the highest local maximum so far */
    impact_gap_path path;
    bool found;
    double thin;          /* smallest semi-axis */
    bool arcs;            /* imp_gap_has_arcs */
    bool sharp;           /* both bodies have edges or vertices: an overlap counts as deep if not proved otherwise */
    double low, low_n[3]; /* the largest g met, and where */
    double most;          /* no overlap's gap is more: proved, or INFINITY */
} search;

static bool is_sharp(const imp_form *form)
{
    return form->p[0] < IMP_GAP_SHARP || form->p[1] < IMP_GAP_SHARP || form->p[2] < IMP_GAP_SHARP;
}

static double distance_of(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* |x/axis|^p near x: its value there, its slope at x and the most of its second derivative within reach of it; false
 * where that has no bound. low, high: between which it lies. */
typedef struct power {
    double value, slope, bend, low, high, steepest;
} power;

static bool power_near(double place, double axis, double p, double reach, power *f)
{
    const double at = place / axis, near = (place - reach) / axis, far = (place + reach) / axis;
    if (p < 2 && !(near > 0)) return false;
    *f = (power){.value = pow(at, p),
                 .slope = p * pow(at, p - 1) / axis,
                 .bend = p * (p - 1) * pow(p < 2 ? near : far, p - 2) / (axis * axis),
                 .low = pow(fmax(near, 0), p),
                 .high = pow(far, p),
                 .steepest = p * pow(far, p - 1) / axis};
    return true;
}

/* S^k of the section's sum S = f + g, of a superellipsoid. */
static bool section_near(const power *f, const power *g, double k, power *section)
{
    const double S = f->value + g->value, low = f->low + g->low, high = f->high + g->high;
    if (!(low > 0)) return false;
    const double steepest = f->steepest * f->steepest + g->steepest * g->steepest;
    const double along = k > 1 ? k * (k - 1) * pow(k < 2 ? low : high, k - 2) * steepest : 0;
    section->slope = k * pow(S, k - 1) * sqrt(f->slope * f->slope + g->slope * g->slope);
    section->bend = k * pow(k < 1 ? low : high, k - 1) * fmax(f->bend, g->bend) + along;
    return true;
}

/* A radius up to depth such that the ball that touches the surface from inside at the witness point x (world) lies in
 * the body: with f <= 1 the body and F its largest second derivative within two depths of x, f is at most
 * 1 - |grad f| |z|^2/(2 r) + F |z|^2/2 at x + z of the ball of radius r. 0: none is known. */
static double inner_radius(const imp_form *form, const double x[3], double depth)
{
    double body[3];
    power f[3], section = {0};
    imp_to_body(form->rotation, x, body);
    if (form->kind != IMP_FORM_QUADRIC) return imp_walk_inner_radius(form, body);
    for (int i = 0; i < 3; i++) {
        const double p = i == 2 && form->nested ? form->p[IMP_SECTION] : form->p[i];
        if (!power_near(fabs(body[i]), form->axis[i], p, 2 * depth, &f[i])) return 0;
    }
    if (form->nested && !section_near(&f[0], &f[1], form->p[IMP_SECTION] / form->p[0], &section)) return 0;
    if (!form->nested) {
        section.slope = sqrt(f[0].slope * f[0].slope + f[1].slope * f[1].slope);
        section.bend = fmax(f[0].bend, f[1].bend);
    }
    const double slope = sqrt(section.slope * section.slope + f[2].slope * f[2].slope),
                 bend = fmax(section.bend, f[2].bend);
    return slope >= bend * depth ? depth : slope / bend;
}

/* Whether an overlap's answer is proved the nearest way out: balls in both bodies, touching them at their witness
 * points, add up to one in their difference that touches it there. */
static bool certain(const search *s)
{
    const double depth = -s->best.gap, balls = inner_radius(&s->pair->form[0], s->best.x[0], depth) +
                                               inner_radius(&s->pair->form[1], s->best.x[1], depth);
    return balls >= depth;
}

/* Whether the best answer needs no proof, or has one that is cheap. */
static bool plain(const search *s)
{
    const double depth = -s->best.gap, radius = s->best.stiffness + depth;
    if (depth <= IMP_GAP_SHALLOW * s->pair->reach) return true;
    return s->sharp ? depth <= IMP_GAP_DEEP * s->thin && certain(s) : depth <= IMP_GAP_DEEP * fmin(s->thin, radius);
}

static void note_low(search *s, double g, const double n[3])
{
    if (!(g > s->low)) return;
    s->low = g;
    memcpy(s->low_n, n, sizeof s->low_n);
}

/* A local maximum is taken where the bodies are known to overlap: by a point in common, or as g is nowhere >= 0. The
 * witness points of a deep overlap, and all between them, may well lie outside the other body. */
static bool take(search *s, const imp_gap_bracket *meeting, impact_gap_path path)
{
    if (!(meeting->shares || s->most < 0) || (s->found && !(meeting->gap > s->best.gap))) return false;
    s->best = *meeting;
    s->path = path;
    s->found = true;
    return true;
}

static bool newton_from(search *s, const double n[3], const double (*x)[3], impact_gap_path path)
{
    imp_gap_bracket meeting;
    return imp_gap_newton(s->pair, n, x, &meeting) && take(s, &meeting, path);
}

/* Nearest points of the bodies drawn apart along n, and their normal. Of two faces on each other n alone tells a corner
 * and any place of a rim, and from there Newton goes astray: they lie far aside of each other for the way along n. */
static void nearest_apart(const imp_gap_solids *pair, const double n[3], double m[3], double x[2][3])
{
    imp_gap_solids apart = *pair;
    double low, high;
    const double way = fmax(0, IMP_GAP_APART * apart.size - imp_pair_gap(pair, n, NULL));
    for (int i = 0; i < 3; i++) m[i] = n[i], apart.c[i] += way * n[i];
    imp_gap_simplex(&apart, 1, IMP_GAP_APART_CLOSED, APART_STEPS, m, x, &low, &high);
}

static void difference(const imp_gap_solids *pair, const double x[2][3], double v[3])
{
    for (int i = 0; i < 3; i++) v[i] = pair->c[i] + x[1][i] - x[0][i];
}

/* Points from the midst of the faces or edges that the normal n touches: the mean of those of normals about it. */
static void midst(const imp_gap_solids *pair, const double n[3], double lean, double x[2][3])
{
    double t[2][3];
    imp_across(n, t);
    memset(x, 0, 2 * sizeof x[0]);
    for (int turn = 0; turn < 8; turn++) {
        double m[3], y[2][3];
        for (int i = 0; i < 3; i++)
            m[i] = n[i] + lean * (cos(turn * 0.7853981633974483) * t[0][i] + sin(turn * 0.7853981633974483) * t[1][i]);
        imp_pair_gap(pair, m, y);
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < 3; i++) x[k][i] += y[k][i] / 8;
    }
}

/* Newton from the midst of what the best normal met touches. */
static bool settle_low(search *s)
{
    double x[2][3];
    for (double lean = IMP_GAP_LEAST_LEAN; lean < IMP_GAP_MOST_LEAN;
         lean *= 10) { /* edges and vertices are round at any scale */
        midst(s->pair, s->low_n, lean, x);
        if (newton_from(s, s->low_n, (const double(*)[3])x, IMPACT_PATH_FALLBACK) &&
            s->best.gap >= s->low - IMP_GAP_SLACK * s->pair->reach)
            return true;
    }
    return false;
}

/* Whether the bodies overlap, by a tetrahedron of points of their difference about 0; from the normal n. */
static bool overlaps(const imp_gap_solids *pair, const double n[3])
{
    double m[3] = {n[0], n[1], n[2]}, x[2][3], low, high;
    return imp_gap_simplex(pair, 1, IMP_GAP_APART_CLOSED, APART_STEPS, m, x, &low, &high) == IMP_SIMPLEX_OVERLAP;
}

/* The nearest way out by the features of what overlaps, and Newton for its witness points; true when it is the answer.
 */
static bool find_way_out(search *s)
{
    const double slack = IMP_GAP_SLACK * s->pair->reach;
    if (!s->found && !overlaps(s->pair, s->low_n)) return false;
    imp_way_out out;
    imp_gap_bracket meeting;
    if (!imp_gap_highest_by_arcs(s->pair, slack, s->found ? s->best.gap : -INFINITY, &out)) return out.all;
    if (out.all) s->most = fmin(s->most, out.gap + slack);
    note_low(s, out.gap, out.n);
    bool taken = out.placed && imp_gap_newton_at(s->pair, out.at, &meeting) && meeting.gap >= out.gap - slack &&
                 take(s, &meeting, IMPACT_PATH_FALLBACK);
    if (!taken) {
        double m[3], x[2][3];
        nearest_apart(s->pair, out.n, m, x);
        taken = newton_from(s, m, (const double(*)[3])x, IMPACT_PATH_FALLBACK) && s->best.gap >= out.gap - slack;
    }
    return taken && (out.all || plain(s)); /* cores that but touch are not above a bound < 0 */
}

/* Proves the best answer the nearest way out, to the accuracy that is promised; what speaks against it is taken. */
static bool prove_best(search *s)
{
    if (s->arcs) return find_way_out(s);
    for (int tries = 0; tries < MAX_PROOFS; tries++) {
        double gap = s->best.gap, other[3];
        memcpy(other, s->best.n, sizeof other);
        const double peak[3] = {gap * other[0], gap * other[1], gap * other[2]};
        imp_gap_peaks peaks = {0};
        imp_gap_peak_add(peak, &peaks);
        const imp_proof proof = imp_gap_prove(s->pair, &peaks, IMP_GAP_SLACK * s->pair->reach, false, &gap, other);
        if (proof != IMP_PROOF_AGAINST) return proof == IMP_PROOF_NEAREST;
        note_low(s, gap, other);
        if (!newton_from(s, other, NULL, IMPACT_PATH_FALLBACK)) return false;
    }
    return false;
}

/* Newton from n and, when not NULL, the points x; true when the search is over. An answer that is not plain is proved
 * where it is shallow, or its proof cheap, or what speaks against it seeds the next. */
static bool try_from(search *s, const double n[3], const double (*x)[3], impact_gap_path path)
{
    if (!newton_from(s, n, x, path)) return false;
    if (plain(s)) return true;
    return (s->arcs || -s->best.gap <= IMP_GAP_DEEP * s->thin) && prove_best(s);
}

static bool has_faces(const imp_gap_solids *pair)
{
    return pair->form[0].kind != IMP_FORM_QUADRIC && pair->form[1].kind != IMP_FORM_QUADRIC;
}

/* The same as try_from, by a start that suits the bodies. What it finds deep, and not proved the nearest, is but noted:
 * the ways after it are gone all the same. */
static bool try_normal(search *s, const double n[3], impact_gap_path path)
{
    double m[3], x[2][3];
    if (has_faces(s->pair)) {
        search other = *s;
        nearest_apart(s->pair, n, m, x);
        if (try_from(&other, m, (const double(*)[3])x, path)) {
            *s = other;
            return true;
        }
        if (other.found) note_low(s, other.best.gap, other.best.n);
        if (s->arcs) note_low(s, imp_pair_gap(s->pair, n, NULL), n);
        if (s->arcs && find_way_out(s)) return true;
    }
    return try_from(s, n, NULL, path);
}

static void centre_line(const imp_gap_solids *pair, double n[3])
{
    const double distance = distance_of(pair->c);
    for (int i = 0; i < 3; i++) n[i] = distance > 0 ? pair->c[i] / distance : i == 2;
}

/* A semi-axis of the ellipsoid a body is taken for here: of a segment a little in every direction. */
static double seed_axis(const imp_form *form, int k)
{
    return fmax(form->axis[k], IMP_GAP_SEED_AXIS * fmax(form->axis[0], fmax(form->axis[1], form->axis[2])));
}

/* M = R diag(axis^2) R^T. */
static void add_ellipsoid(const imp_form *form, double scale, double M[3][3])
{
    for (int k = 0; k < 3; k++) {
        const double square = scale * seed_axis(form, k) * seed_axis(form, k);
        for (int i = 0; i < 3; i++)
            for (int j = i; j < 3; j++) M[i][j] += square * form->rotation[i][k] * form->rotation[j][k];
    }
}

static double ellipsoid_height(const imp_form *form, const double n[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double w = seed_axis(form, k) *
                         (form->rotation[0][k] * n[0] + form->rotation[1][k] * n[1] + form->rotation[2][k] * n[2]);
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
static void ellipsoid_seed(const imp_gap_solids *pair, int steps, double n[3])
{
    for (int k = 0; k < steps; k++) {
        const double h[2] = {ellipsoid_height(&pair->form[0], n), ellipsoid_height(&pair->form[1], n)};
        const double g = fmax(0, n[0] * pair->c[0] + n[1] * pair->c[1] + n[2] * pair->c[2] - h[0] - h[1]);
        double M[3][3] = {{g, 0, 0}, {0, g, 0}, {0, 0, g}};
        for (int i = 0; i < 2; i++) add_ellipsoid(&pair->form[i], 1 / h[i], M);
        if (!solve_for_normal(M, pair->c, n)) return;
    }
}

void imp_gap_seed(const imp_gap_solids *pair, double n[3])
{
    centre_line(pair, n);
    ellipsoid_seed(pair, SEED_STEPS, n);
}

/* Distance of the bodies, then of the bodies shrunk until they are apart, each to a few digits and then polished. */
static bool try_simplex(search *s, double *upper)
{
    static const double shrink[] = {IMP_GAP_SHRINKING}, tolerance[] = {IMP_GAP_SIMPLEX_STAGES};
    for (size_t i = 0; i < sizeof shrink / sizeof *shrink; i++) {
        double n[3], x[2][3], low, high;
        centre_line(s->pair, n);
        for (size_t j = 0; j < sizeof tolerance / sizeof *tolerance; j++) {
            const bool apart =
                imp_gap_simplex(s->pair, shrink[i], tolerance[j], 20 << j, n, x, &low, &high) == IMP_SIMPLEX_APART;
            note_low(s, imp_pair_gap(s->pair, n, NULL), n);
            if (shrink[i] == 1 && apart) *upper = fmin(*upper, high);
            if (try_from(s, n, (const double(*)[3])x, IMPACT_PATH_FALLBACK)) return true;
            if (try_from(s, n, NULL, IMPACT_PATH_FALLBACK)) return true;
            if (!apart) break;
        }
        if (shrink[i] == 1 && s->low > 0) break; /* apart: shrinking adds nothing */
    }
    return false;
}

/* Steps of many lengths up g's slope from the best normal met: for two vertices in touch, whose g is flat at 0. */
static bool try_slope(search *s)
{
    for (int round = 0; round < 8; round++) {
        double x[2][3], v[3], along = 0, best[3], highest = s->low;
        imp_pair_gap(s->pair, s->low_n, x);
        for (int i = 0; i < 3; i++) v[i] = s->pair->c[i] + x[1][i] - x[0][i];
        for (int i = 0; i < 3; i++) along += v[i] * s->low_n[i];
        for (int i = 0; i < 3; i++) v[i] -= along * s->low_n[i];
        const double slope = distance_of(v);
        if (!(slope > 0)) return false;
        for (double step = 1; step > IMP_GAP_SLOPE_STEP; step /= 2) {
            double n[3];
            for (int i = 0; i < 3; i++) n[i] = s->low_n[i] + step * v[i] / slope;
            const double length = distance_of(n);
            for (int i = 0; i < 3; i++) n[i] /= length;
            const double g = imp_pair_gap(s->pair, n, NULL);
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
        imp_gap_solids eased = *s->pair;
        for (int k = 0; k < 2; k++) {
            imp_form *form = &eased.form[k];
            if (form->kind != IMP_FORM_QUADRIC) continue;
            for (int i = 0; i < 4; i++) form->p[i] = 1 + pow(form->p[i] - 1, stage / 8.0);
            if (stage == 0) form->round = form->uniform = true, form->nested = false;
        }
        imp_gap_bracket meeting;
        if (imp_gap_newton(&eased, n, NULL, &meeting)) memcpy(n, meeting.n, sizeof n);
    }
    return try_from(s, n, NULL, IMPACT_PATH_FALLBACK);
}

/* The highest g over the whole sphere but for slack, from the highest met; false where the work allowed is not enough.
 */
static bool climb(search *s, double slack)
{
    imp_gap_peaks peaks = {0};
    double gap = s->low, n[3], x[2][3], v[3];
    memcpy(n, s->low_n, sizeof n);
    imp_pair_gap(s->pair, n, x);
    difference(s->pair, (const double(*)[3])x, v);
    imp_gap_peak_add(v, &peaks);
    const imp_proof proof = imp_gap_prove(s->pair, &peaks, slack, true, &gap, n);
    note_low(s, gap, n);
    if (proof == IMP_PROOF_NEAREST) s->most = fmin(s->most, gap + slack);
    return proof == IMP_PROOF_NEAREST;
}

/* The normals of a body's faces and caps: a deep overlap's nearest way out is along one of them, or near an edge. */
static void look_along_faces(search *s, int body)
{
    const imp_form *form = &s->pair->form[body];
    const bool turned = imp_of_revolution(form);
    const int count = turned ? 2 : form->kind == IMP_FORM_QUADRIC ? 0 : form->core.hull->face_count;
    for (int f = 0; f < count; f++) {
        double own[3] = {0, 0, f ? 1 : -1}, n[3];
        if (!turned) imp_core_normal(&form->core, f, own);
        imp_to_world(form->rotation, own, n);
        for (int k = 0; body == 1 && k < 3; k++) n[k] = -n[k];
        note_low(s, imp_pair_gap(s->pair, n, NULL), n);
    }
}

/* Of the depth, which is told to within it: where it turns out half as deep, or less, it is told again. */
static double coarse_slack(const search *s)
{
    return fmax(IMP_GAP_SLACK * s->pair->reach,
                fmin(IMP_GAP_COARSE_DEPTH * -s->low, IMP_GAP_COARSE_SIZE * s->pair->size));
}

/* An overlap without a proof: bounded from both sides, and the nearest way out looked for over the whole sphere. True
 * when it is proved. */
static bool surround(search *s)
{
    if (s->found) note_low(s, s->best.gap, s->best.n);
    look_along_faces(s, 0);
    look_along_faces(s, 1);
    if (s->sharp && (!s->found || s->low > s->best.gap) && settle_low(s) && prove_best(s)) return true;
    double slack;
    do slack = coarse_slack(s);
    while (climb(s, slack) && coarse_slack(s) < 0.5 * slack);
    if (!s->found || s->low > s->best.gap) newton_from(s, s->low_n, NULL, IMPACT_PATH_FALLBACK);
    if (s->found && s->best.gap >= s->low - IMP_GAP_SLACK * s->pair->reach && prove_best(s)) return true;
    if (s->found && s->best.gap >= s->low - IMP_GAP_SLACK * s->pair->reach) return false;
    return climb(s, IMP_GAP_SLACK * s->pair->reach) && settle_low(s);
}

/* Whether the points that the normal touches face each other across it. */
static bool face_across(const imp_gap_solids *pair, const double n[3], double gap, const double x[2][3])
{
    double aside[3];
    difference(pair, x, aside);
    for (int i = 0; i < 3; i++) aside[i] -= gap * n[i];
    return distance_of(aside) <= IMP_GAP_CLOSED * pair->reach;
}

static bool in_bodies(const imp_gap_solids *pair, const double x[2][3])
{
    return imp_gap_holds(&pair->form[0], x[0], IMP_GAP_SLACK * pair->reach) &&
           imp_gap_holds(&pair->form[1], x[1], IMP_GAP_SLACK * pair->reach);
}

/* What all but touches, drawn apart along the best normal met, has that normal but for its error times the way, and
 * nearest points that tell it: where g has a kink across one way and bends across the other, heights tell a normal to
 * the root of their rounding. */
static void draw_apart(search *s)
{
    const double reach = s->pair->reach, way = fmax(-s->low, 0) + IMP_GAP_PARTED * reach;
    if (!(s->low <= 0 && -s->low <= IMP_GAP_PARTED * reach)) return;
    imp_gap_solids parted = *s->pair;
    for (int i = 0; i < 3; i++) parted.c[i] += way * s->low_n[i];
    search apart = {
        .pair = &parted, .low = -INFINITY, .most = INFINITY, .thin = s->thin, .arcs = s->arcs, .sharp = s->sharp};
    double upper = INFINITY;
    if (!try_from(&apart, s->low_n, NULL, IMPACT_PATH_NEWTON) && !try_simplex(&apart, &upper)) return;
    const double g = imp_pair_gap(s->pair, apart.best.n, NULL);
    if (g >= s->low - IMP_GAP_SLACK * reach) memcpy(s->low_n, apart.best.n, sizeof s->low_n);
}

/* No way settled: the best that is known for certain. The support points of any normal are no nearer than the bodies.
 */
static impact_status bracket(const search *s, double upper, imp_gap_bracket *meeting)
{
    double v[3];
    memcpy(meeting->n, s->low_n, sizeof meeting->n);
    meeting->lower = meeting->gap = imp_pair_gap(s->pair, meeting->n, meeting->x);
    difference(s->pair, (const double(*)[3])meeting->x, v);
    const double apart = distance_of(v);
    /* Points that leave their bodies, as they may at exponents near 1, bound nothing; the centres do. */
    const bool held = in_bodies(s->pair, (const double(*)[3])meeting->x);
    meeting->upper = fmax(held ? fmin(s->most, fmin(upper, apart)) : distance_of(s->pair->c), meeting->lower);
    meeting->stiffness = 0;
    if (!(meeting->upper - meeting->lower <= IMP_GAP_CLOSED * s->pair->reach)) return IMPACT_BRACKET;
    const bool faces = face_across(s->pair, meeting->n, meeting->gap, (const double(*)[3])meeting->x);
    return faces ? IMPACT_OK : IMPACT_BRACKET;
}

static bool first_from(const imp_gap_solids *pair, const double n[3], imp_gap_bracket *meeting)
{
    double m[3], x[2][3];
    if (has_faces(pair)) {
        nearest_apart(pair, n, m, x);
        if (imp_gap_newton(pair, m, (const double(*)[3])x, meeting) && meeting->shares) return true;
    }
    return imp_gap_newton(pair, n, NULL, meeting) && meeting->shares;
}

bool imp_gap_first(const imp_gap_solids *pair, const double *cached, imp_gap_bracket *meeting, impact_gap_path *path)
{
    double n[3];
    *path = IMPACT_PATH_NEWTON;
    if (cached && first_from(pair, cached, meeting)) return true;
    centre_line(pair, n);
    ellipsoid_seed(pair, SEED_STEPS, n);
    if (first_from(pair, n, meeting)) return true;
    *path = IMPACT_PATH_GJK;
    return imp_gap_harvest(pair, n) && first_from(pair, n, meeting);
}

/* The best answer, with what is known of better ones: an overlap that is not over may have a nearer way out, by no more
 * than the bracket. */
static impact_status answer(const search *s, bool over, imp_gap_bracket *meeting)
{
    *meeting = s->best;
    if (over) return IMPACT_OK;
    meeting->lower = fmin(meeting->gap, meeting->lower);
    meeting->upper = fmax(meeting->upper, fmin(s->most, 0));
    return IMPACT_DEEP;
}

impact_status imp_gap_settle(const imp_gap_solids *pair, const double *cached, imp_gap_bracket *meeting,
                             impact_gap_path *path)
{
    search s = {.pair = pair,
                .low = -INFINITY,
                .most = INFINITY,
                .thin = INFINITY,
                .arcs = imp_gap_has_arcs(pair),
                .sharp = pair->form[0].kind != IMP_FORM_QUADRIC || pair->form[1].kind != IMP_FORM_QUADRIC ||
                         (is_sharp(&pair->form[0]) && is_sharp(&pair->form[1]))};
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++) s.thin = fmin(s.thin, pair->form[k].axis[i]);
    double n[3], upper = distance_of(pair->c);
    centre_line(pair, n);
    bool over = cached && try_normal(&s, cached, IMPACT_PATH_NEWTON);
    if (!over) {
        ellipsoid_seed(pair, SEED_STEPS, n);
        over = try_normal(&s, n, IMPACT_PATH_NEWTON);
    }
    over = over || (imp_gap_harvest(pair, n) && try_from(&s, n, NULL, IMPACT_PATH_GJK));
    if (!s.found) over = try_simplex(&s, &upper) || try_slope(&s) || try_homotopy(&s);
    const double low = s.found ? s.best.gap : s.low;
    if (!over && low <= 0) over = surround(&s);
    *path = s.found ? s.path : IMPACT_PATH_FALLBACK;
    const bool best = s.found && s.best.gap >= s.low - 2 * IMP_GAP_SLACK * pair->reach;
    if (best) return answer(&s, over, meeting);
    draw_apart(&s);
    return bracket(&s, upper, meeting);
}
