/* SPDX-License-Identifier: MIT
 *
 * Curves and surfaces: every number that makes them is looked at; what has no value, or no memory, says so and leaves
 * zeros. And where samples end, or seams are met, what is there is right.
 */
#include <quat/family.h>
#include <stdlib.h>
#include <string.h>
#include "kit/near.h"

static const double pi = 3.14159265358979323846;

/* ---- families ---- */

typedef quat_status make_call(const double *x, quat_family *f, quat_curve *c, quat_surface *s);

static quat_status ellipse(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)s;
    return quat_ellipse(x[0], x[1], f, c);
}
static quat_status helix(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)s;
    return quat_helix(x[0], 0.5, x[1], f, c);
}
static quat_status knot(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)s;
    return quat_torus_knot(x[0], x[1], 2, 3, f, c);
}
static quat_status trefoil(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)s;
    return quat_trefoil(x[0], f, c);
}
static quat_status viviani(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)s;
    return quat_viviani(x[0], f, c);
}
static quat_status cubic(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)s;
    return quat_cubic(x[0], true, f, c);
}
static quat_status plane(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)c;
    return quat_plane(x[0], x[1], f, s);
}
static quat_status ellipsoid(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)c;
    return quat_ellipsoid(x[0], x[1], x[2], f, s);
}
static quat_status torus(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)c;
    return quat_torus(x[0], x[1], f, s);
}
static quat_status saddle(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)c;
    return quat_saddle(x[0], x[1], f, s);
}
static quat_status catenoid(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)c;
    return quat_catenoid(x[0], x[1], f, s);
}
static quat_status helicoid(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)c;
    return quat_helicoid(x[0], x[1], x[2], f, s);
}
static quat_status superellipsoid(const double *x, quat_family *f, quat_curve *c, quat_surface *s)
{
    (void)c;
    return quat_superellipsoid(x[0], x[1], x[2], x[3], x[4], f, s);
}

/* What is refused makes neither a curve nor a surface that can be asked. */
static void each_number_of_a_family(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        make_call *make;
        int n;
    } families[] = {{"ellipse", ellipse, 2},
                    {"helix", helix, 2},
                    {"torus knot", knot, 2},
                    {"trefoil", trefoil, 1},
                    {"viviani", viviani, 1},
                    {"cubic", cubic, 1},
                    {"plane", plane, 2},
                    {"ellipsoid", ellipsoid, 3},
                    {"torus", torus, 2},
                    {"saddle", saddle, 2},
                    {"catenoid", catenoid, 2},
                    {"helicoid", helicoid, 3},
                    {"superellipsoid", superellipsoid, 5}};
    static const double bad[] = {NAN, INFINITY, -INFINITY, -1, 0};
    for (size_t i = 0; i < sizeof families / sizeof *families; i++) {
        double x[5] = {2, 1, 1, 1, 1};
        quat_family f;
        quat_curve c = {0};
        quat_surface s = {0};
        if (families[i].make(x, &f, &c, &s) != QUAT_OK) fail_msg("%s refuses good numbers", families[i].name);
        assert_true((c.at != NULL) != (s.at != NULL));
        for (int k = 0; k < families[i].n; k++)
            for (int b = 0; b < 5; b++) {
                const double good = x[k];
                x[k] = bad[b];
                if (families[i].make(x, &f, &c, &s) != QUAT_EDOMAIN)
                    fail_msg("%s takes %g as number %d", families[i].name, bad[b], k);
                if (c.at || s.at) fail_msg("%s, refused, can be asked", families[i].name);
                x[k] = good;
            }
    }
    quat_family f;
    quat_curve c;
    quat_surface s;
    assert_int_equal(quat_helix(1, NAN, 1, &f, &c), QUAT_EDOMAIN);
    assert_int_equal(quat_helix(1, 0, 1, &f, &c), QUAT_OK); /* a circle */
    assert_int_equal(quat_torus(1, 1, &f, &s), QUAT_EDOMAIN);
    assert_int_equal(quat_superellipsoid(1, 1, 1, 4.1, 1, &f, &s), QUAT_EDOMAIN);
    assert_int_equal(quat_superellipsoid(1, 1, 1, 1, 4.1, &f, &s), QUAT_EDOMAIN);
    static const int pairs[][2] = {{0, 1}, {1, 0}, {-2, 3}, {2, -3}, {1001, 1}, {1, 1001}, {2, 4}, {999, 333}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        assert_int_equal(quat_torus_knot(2, 1, pairs[i][0], pairs[i][1], &f, &c), QUAT_EARGUMENT);
    assert_int_equal(quat_torus_knot(2, 1, 1000, 999, &f, &c), QUAT_OK);
}

/* ---- curves ---- */

static double last_good; /* a curve has values up to there */

static bool ends_early(double t, qvec3 d[4], void *context)
{
    const int *how = context;
    d[0] = qvec3_make(cos(t), sin(t), t);
    if (t <= last_good) return true;
    if (*how == 1) d[0].y = NAN;
    return *how == 1;
}

static void assert_zero(qvec3 v) { assert_near3(v, (qvec3){0, 0, 0}, 0); }

/* Every call of curves, with a curve that is no curve, or has no value somewhere. */
static void assert_all_refuse(const quat_curve *c, double a, double b, quat_status wanted)
{
    qvec3 d[4];
    double length = 7, t[3], error[4];
    quat q[3];
    quat_curve_point point;
    quat_curve_totals totals;
    quat_framing_report report;
    assert_int_equal(quat_curve_derivatives(c, b, 3, d, error), wanted);
    for (int k = 0; k < 4; k++) assert_zero(d[k]);
    assert_int_equal(quat_curve_at(c, b, &point), wanted);
    assert_true(point.curvature == 0 && point.torsion == 0 && quat_equal(point.frame, (quat){1, 0, 0, 0}));
    assert_int_equal(quat_curve_length(c, a, b, &length), wanted);
    assert_true(length == 0);
    assert_int_equal(quat_curve_at_length(c, 1e-3, &length), wanted);
    assert_int_equal(quat_curve_even(c, 3, t), wanted);
    assert_int_equal(quat_curve_total(c, &totals), wanted);
    assert_true(totals.length == 0 && totals.curvature == 0 && totals.torsion == 0);
    for (int framing = QUAT_FRENET; framing <= QUAT_MINIMAL; framing++)
        assert_int_equal(quat_curve_frames(c, (quat_framing)framing, NULL, 3, NULL, q, &report), wanted);
}

static void curves_that_are_none(void **state)
{
    (void)state;
    int how = 0;
    last_good = INFINITY;
    const quat_curve good = {.at = ends_early, .context = &how, .start = 0, .end = 1};
    double length;
    assert_int_equal(quat_curve_length(&good, 0, 1, &length), QUAT_OK);
    assert_near(length, sqrt(2), 1e-9);
    assert_all_refuse(NULL, 0, 1, QUAT_EARGUMENT);
    quat_curve bad[8];
    for (int i = 0; i < 8; i++) bad[i] = good;
    bad[0].at = NULL, bad[1].known = -1, bad[2].known = 4;
    bad[3].start = NAN, bad[4].end = INFINITY, bad[5].end = 0, bad[6].start = 2, bad[7].end = NAN;
    for (int i = 0; i < 8; i++) assert_all_refuse(&bad[i], 0, 1, QUAT_EARGUMENT);
    for (how = 0; how < 2; how++)
        for (int where = 0; where < 3; where++) {
            last_good = where == 0 ? 0.999 : where == 1 ? 0.4 : -1;
            assert_all_refuse(&good, 0, 1, QUAT_EDOMAIN);
        }
}

static void bad_places_on_a_curve(void **state)
{
    (void)state;
    int how = 0;
    last_good = INFINITY;
    const quat_curve c = {.at = ends_early, .context = &how, .start = 0, .end = 1};
    const double places[] = {NAN, INFINITY, -INFINITY, -1e-9, 1 + 1e-9};
    double length, t, three[3];
    quat q[3];
    qvec3 d[4];
    for (int i = 0; i < 5; i++) {
        assert_int_equal(quat_curve_derivatives(&c, places[i], 1, d, NULL), QUAT_EDOMAIN);
        assert_int_equal(quat_curve_length(&c, places[i], 1, &length), QUAT_EDOMAIN);
        assert_int_equal(quat_curve_length(&c, 0, places[i], &length), QUAT_EDOMAIN);
        three[0] = 0, three[1] = 0.5, three[2] = 1;
        three[i % 3] = places[i];
        assert_int_equal(quat_curve_frames(&c, QUAT_MINIMAL, NULL, 3, three, q, NULL), QUAT_EARGUMENT);
    }
    assert_int_equal(quat_curve_derivatives(&c, 0, -1, d, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_derivatives(&c, 0, 4, d, NULL), QUAT_EARGUMENT);
    const double lengths[] = {NAN, INFINITY, -1e-3, sqrt(2) + 1e-3};
    for (int i = 0; i < 4; i++) assert_int_equal(quat_curve_at_length(&c, lengths[i], &t), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_at_length(&c, sqrt(2) * (1 + 5e-10), &t), QUAT_OK);
    assert_true(t == 1);
    assert_int_equal(quat_curve_at_length(&c, 0, &t), QUAT_OK);
    assert_true(t == 0);
    assert_int_equal(quat_curve_even(&c, 1, three), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_frames(&c, QUAT_MINIMAL, NULL, 1, NULL, q, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_frames(&c, QUAT_MINIMAL, NULL, 3, NULL, NULL, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_frames(&c, (quat_framing)3, NULL, 3, NULL, q, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_frames(&c, QUAT_CLOSED, NULL, 3, NULL, q, NULL), QUAT_EARGUMENT); /* it is open */
    quat next;
    const quat one = {1, 0, 0, 0};
    assert_int_equal(quat_frame_step(one, (qvec3){0, 0, 0}, (qvec3){0, 0, 0}, (qvec3){1, 0, 0}, &next), QUAT_EDOMAIN);
    assert_true(quat_equal(next, one));
    /* the mirror image of the tangent: a cusp between the two */
    assert_int_equal(quat_frame_step(one, (qvec3){0, 0, 0}, (qvec3){0, 1, 0}, (qvec3){1, 0, 0}, &next), QUAT_EDOMAIN);
    assert_true(quat_equal(next, one));
}

/* Frames of a closed curve at times of one's own: as at equal steps where they are those; only whole ways close. */
static void times_on_a_closed_curve(void **state)
{
    (void)state;
    enum { N = 9 };
    quat_family f;
    quat_curve c;
    quat_framing_report whole, own;
    quat q[N], r[N];
    double t[N];
    assert_int_equal(quat_torus_knot(2, 0.5, 2, 3, &f, &c), QUAT_OK);
    for (int i = 0; i < N; i++) t[i] = i == N - 1 ? c.end : c.start + (c.end - c.start) * (i / (N - 1.0));
    for (int framing = QUAT_FRENET; framing <= QUAT_CLOSED; framing++) {
        const quat_status status = quat_curve_frames(&c, (quat_framing)framing, NULL, N, NULL, q, &whole);
        assert_int_equal(quat_curve_frames(&c, (quat_framing)framing, NULL, N, t, r, &own), status);
        for (int i = 0; i < N; i++) assert_true(quat_equal(q[i], r[i]));
        assert_true(own.holonomy == whole.holonomy && own.monodromy == whole.monodromy && own.monodromy != 0);
    }
    assert_near(quat_rotation_distance(q[0], q[N - 1]), 0, 1e-14); /* the closed frame comes back */
    for (int cut = 0; cut < 2; cut++) {                            /* part of the way, from either end */
        assert_int_equal(quat_curve_frames(&c, QUAT_MINIMAL, NULL, N - 1, t + cut, r, &own), QUAT_OK);
        assert_true(own.holonomy == 0 && own.monodromy == 0);
        assert_int_equal(quat_curve_frames(&c, QUAT_CLOSED, NULL, N - 1, t + cut, r, &own), QUAT_EARGUMENT);
    }
    t[4] = t[3];
    assert_int_equal(quat_curve_frames(&c, QUAT_MINIMAL, NULL, N, t, r, &own), QUAT_EARGUMENT);
}

static bool long_way(double t, qvec3 d[4], void *context)
{
    (void)context;
    d[0] = qvec3_make(1e308 * t, 0, 0);
    d[1] = qvec3_make(1e308, 0, 0);
    return true;
}

static void a_length_overflows(void **state)
{
    (void)state;
    const quat_curve c = {.at = long_way, .start = -4, .end = 4, .closed = true, .known = 1};
    double length = 1;
    /* the value itself overflows beyond 1.79e308: no value; the length does within */
    assert_int_equal(quat_curve_length(&c, -1.5, 1.5, &length), QUAT_ERANGE);
    assert_true(length == 0);
}

/* ---- through samples ---- */

/* x of a polynomial of that degree, its coefficients 1, -1/2, 1/4 ... */
static qvec3 polynomial(double t, int degree)
{
    double x = 0, c = 1, power = 1;
    for (int k = 0; k <= degree; k++, c *= -0.5, power *= t) x += c * power;
    return qvec3_make(x, 2 * x, t);
}

/* Eight neighbours hold a polynomial of degree 7 exactly, at the ends as in the middle; n < 8 one of degree n - 1. */
static void samples_hold_polynomials(void **state)
{
    (void)state;
    double t[20];
    qvec3 x[20];
    for (int n = 4; n <= 20; n++) {
        const int degree = n < 8 ? n - 1 : 7;
        for (int i = 0; i < n; i++) t[i] = 0.1 * i + 0.02 * (i % 3), x[i] = polynomial(t[i], degree);
        const quat_samples s = {(size_t)n, t, x, false};
        quat_curve c;
        assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_OK);
        for (int i = 0; i <= 200; i++) {
            const double at = fmin(t[0] + (t[n - 1] - t[0]) * i / 200, t[n - 1]);
            qvec3 d[4];
            assert_int_equal(quat_curve_derivatives(&c, at, 0, d, NULL), QUAT_OK);
            assert_near3(d[0], polynomial(at, degree), 2e-14 * qvec3_norm(d[0]));
        }
    }
}

static void closed_samples_go_round(void **state)
{
    (void)state;
    for (int n = 5; n <= 40; n += 5) {
        double t[41];
        qvec3 x[41];
        for (int i = 0; i <= n; i++)
            t[i] = (double)i / n, x[i] = qvec3_make(cos(2 * pi * (i % n) / n), sin(2 * pi * (i % n) / n), 0);
        const quat_samples s = {(size_t)n + 1, t, x, true};
        quat_curve c;
        assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_OK);
        for (int i = 0; i < 100; i++) {
            qvec3 here[4], there[4], back[4];
            const double at = i / 100.0;
            assert_int_equal(quat_curve_derivatives(&c, at, 0, here, NULL), QUAT_OK);
            assert_int_equal(quat_curve_derivatives(&c, at + 3, 0, there, NULL), QUAT_OK);
            assert_int_equal(quat_curve_derivatives(&c, at - 2, 0, back, NULL), QUAT_OK);
            assert_near3(here[0], there[0], 2e-14);
            assert_near3(here[0], back[0], 2e-14);
            /* n points turn alike: a symmetric rule turns with them */
            qvec3 next[4];
            const double on = 2 * pi / n;
            assert_int_equal(quat_curve_derivatives(&c, at + 1.0 / n, 0, next, NULL), QUAT_OK);
            assert_near3(
                next[0],
                qvec3_make(here[0].x * cos(on) - here[0].y * sin(on), here[0].x * sin(on) + here[0].y * cos(on), 0),
                2e-14);
        }
    }
}

static void samples_that_are_none(void **state)
{
    (void)state;
    double t[5] = {0, 1, 2, 3, 4};
    qvec3 x[5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}};
    quat_curve c;
    quat_samples s = {5, t, x, true};
    assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_OK);
    assert_int_equal(quat_curve_from_samples(NULL, &c), QUAT_EARGUMENT);
    s.n = 3;
    assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_EARGUMENT);
    s.n = 5, s.t = NULL;
    assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_EARGUMENT);
    s.t = t, s.x = NULL;
    assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_EARGUMENT);
    s.x = x, t[2] = 1;
    assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_EARGUMENT);
    t[2] = NAN;
    assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_EDOMAIN);
    t[2] = 2, x[3].z = INFINITY;
    assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_EDOMAIN);
    x[3].z = 0, x[4].x = 1e-6;
    assert_int_equal(quat_curve_from_samples(&s, &c), QUAT_EDOMAIN);
    assert_null(c.at);
}

/* ---- surfaces ---- */

static double last_u;

static bool stops_early(double u, double v, qvec3 d[6], void *context)
{
    const int *how = context;
    d[0] = qvec3_make(u, v, u * u - v * v);
    d[1] = qvec3_make(1, 0, 2 * u);
    d[2] = qvec3_make(0, 1, -2 * v);
    d[3] = qvec3_make(0, 0, 2), d[4] = qvec3_make(0, 0, 0), d[5] = qvec3_make(0, 0, -2);
    if (u <= last_u) return true;
    if (*how == 1) d[0].y = NAN;
    if (*how == 2) d[1].x = INFINITY;
    return *how > 0;
}

static void assert_surface_refuses(const quat_surface *s, quat_status wanted)
{
    quat_surface_point p;
    quat_surface_totals totals;
    double residual;
    qvec3 x[4];
    quat q[4];
    size_t triangles[6];
    assert_int_equal(quat_surface_at(s, 0.9, 0.1, &p), wanted);
    assert_true(p.curvature.gauss == 0 && p.area == 0 && quat_equal(p.frame, (quat){1, 0, 0, 0}));
    assert_int_equal(quat_surface_integrability(s, 0.9, 0.1, &residual), wanted);
    assert_int_equal(quat_surface_total(s, 1e-8, &totals), wanted);
    assert_int_equal(quat_surface_patch(s, 0, 1, 0, 1, 2, 2, x, q, triangles), wanted);
}

static void surfaces_that_are_none(void **state)
{
    (void)state;
    int how = 0;
    last_u = INFINITY;
    for (int known = 0; known <= 2; known++) {
        const quat_surface good = {.at = stops_early, .context = &how, .u1 = 1, .v1 = 1, .known = known};
        quat_surface_point p;
        last_u = INFINITY;
        assert_int_equal(quat_surface_at(&good, 0.9, 0.1, &p), QUAT_OK);
        assert_near(p.curvature.gauss, -4 / pow(1 + 4 * 0.82, 2), 1e-8);
        for (how = 0; how < 2 + (known > 0); how++) {
            last_u = 0.89;
            assert_surface_refuses(&good, QUAT_EDOMAIN);
            last_u = how == 2 ? 0.89 : 0.9; /* on the edge of what it has: differences go beyond it */
            if (known == 0) assert_surface_refuses(&good, QUAT_EDOMAIN);
        }
        how = 0;
    }
    last_u = INFINITY;
    assert_surface_refuses(NULL, QUAT_EARGUMENT);
    const quat_surface good = {.at = stops_early, .context = &how, .u1 = 1, .v1 = 1, .known = 2};
    quat_surface bad[9];
    for (int i = 0; i < 9; i++) bad[i] = good;
    bad[0].at = NULL, bad[1].known = -1, bad[2].known = 3, bad[3].u0 = NAN, bad[4].v0 = NAN;
    bad[5].u1 = INFINITY, bad[6].v1 = -INFINITY, bad[7].u0 = 1, bad[8].v0 = 1;
    for (int i = 0; i < 9; i++) assert_surface_refuses(&bad[i], QUAT_EARGUMENT);
    const double places[] = {NAN, INFINITY, -1e-9, 1 + 1e-9};
    for (int i = 0; i < 4; i++) {
        quat_surface_point p;
        double residual;
        assert_int_equal(quat_surface_at(&good, places[i], 0.5, &p), QUAT_EDOMAIN);
        assert_int_equal(quat_surface_at(&good, 0.5, places[i], &p), QUAT_EDOMAIN);
        assert_int_equal(quat_surface_integrability(&good, places[i], 0.5, &residual), QUAT_EDOMAIN);
        assert_int_equal(quat_surface_integrability(&good, 0.5, places[i], &residual), QUAT_EDOMAIN);
    }
    qvec3 x[4];
    quat q[4];
    size_t t[6];
    assert_int_equal(quat_surface_patch(&good, 0, 1, 0, 1, 1, 2, x, q, t), QUAT_EARGUMENT);
    assert_int_equal(quat_surface_patch(&good, 0, 1, 0, 1, 2, 1, x, q, t), QUAT_EARGUMENT);
    assert_int_equal(quat_surface_patch(&good, 1, 1, 0, 1, 2, 2, x, q, t), QUAT_EARGUMENT);
    assert_int_equal(quat_surface_patch(&good, 0, 1, 1, 0, 2, 2, x, q, t), QUAT_EARGUMENT);
}

/* Every number of a frame's curvature, and tangents that span nothing. */
static void curvature_of_no_frame(void **state)
{
    (void)state;
    static const double bad[] = {NAN, INFINITY};
    double x[16] = {1, 0, 0, 0, 0.1, 0.2, 0.3, -0.5, 0.1, 0.4, 1, 0, 0, 0, 1, 0};
    quat_curvature c;
    for (int i = -1; i < 16; i++)
        for (int b = 0; b < 2; b++) {
            const double keep = i < 0 ? 0 : x[i];
            if (i >= 0) x[i] = bad[b];
            const quat_status got = quat_curvature_of_frame((quat){x[0], x[1], x[2], x[3]}, (qvec3){x[4], x[5], x[6]},
                                                            (qvec3){x[7], x[8], x[9]}, (qvec3){x[10], x[11], x[12]},
                                                            (qvec3){x[13], x[14], x[15]}, &c);
            if (got != (i < 0 ? QUAT_OK : QUAT_EDOMAIN)) fail_msg("number %d as %g: status %d", i, bad[b], (int)got);
            if (i >= 0) assert_true(c.gauss == 0 && c.mean == 0 && c.asymmetry == 0);
            if (i >= 0) x[i] = keep;
        }
    const quat q = {1, 0, 0, 0};
    const qvec3 a = {0.1, 0.2, 0}, b = {-0.2, 0.1, 0}, ex = {1, 0, 0}, ey = {0, 1, 0}, none = {0, 0, 0};
    assert_int_equal(quat_curvature_of_frame(q, a, b, ex, ex, &c), QUAT_EDOMAIN);
    assert_int_equal(quat_curvature_of_frame(q, a, b, ex, none, &c), QUAT_EDOMAIN);
    assert_int_equal(quat_curvature_of_frame((quat){0, 0, 0, 0}, a, b, ex, ey, &c), QUAT_EDOMAIN);
    assert_int_equal(
        quat_curvature_of_frame(q, qvec3_scale(a, 1e200), b, qvec3_scale(ex, 1e-150), qvec3_scale(ey, 1e-150), &c),
        QUAT_ERANGE);
    assert_true(c.gauss == 0 && c.mean == 0);
}

/* On the seam u = 0 or v = 0 of a superellipsoid: exponents 1 are the ellipsoid, under 2 have no second derivative, and
 * over 2 are flat. */
static void seams(void **state)
{
    (void)state;
    quat_family f, g;
    quat_surface s, e;
    quat_surface_point p, wanted;
    assert_int_equal(quat_ellipsoid(3, 2, 1, &f, &e), QUAT_OK);
    const double exponents[] = {1, 1.5, 2, 3};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(quat_superellipsoid(3, 2, 1, exponents[i], exponents[i], &g, &s), QUAT_OK);
        for (int seam = 0; seam < 3; seam++) {
            const double u = seam == 1 ? 0.7 : 0, v = seam == 2 ? 0.3 : 0;
            const quat_status got = quat_surface_at(&s, u, v, &p);
            if (exponents[i] > 1) {
                assert_int_equal(got, QUAT_EDOMAIN);
                continue;
            }
            assert_int_equal(got, quat_surface_at(&e, u, v, &wanted));
            assert_near(p.curvature.gauss, wanted.curvature.gauss, 1e-15 * fabs(wanted.curvature.gauss));
            assert_near(p.curvature.mean, wanted.curvature.mean, 1e-15 * fabs(wanted.curvature.mean));
        }
    }
}

/* ---- Gauss maps ---- */

static void frames_of_no_mesh(void **state)
{
    (void)state;
    const qvec3 x[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const quat one = {1, 0, 0, 0};
    quat q[3] = {one, one, one};
    const size_t t[3] = {0, 1, 2}, wild[3] = {0, 1, 3};
    quat_gauge_report report;
    assert_int_equal(quat_choose_frames(3, x, 1, t, QUAT_MINIMAL_AREA, q, NULL), QUAT_OK);
    assert_int_equal(quat_choose_frames(0, x, 1, t, QUAT_SHORTEST, q, &report), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(3, x, 0, t, QUAT_SHORTEST, q, &report), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(3, NULL, 1, t, QUAT_SHORTEST, q, &report), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(3, x, 1, NULL, QUAT_SHORTEST, q, &report), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(3, x, 1, t, QUAT_SHORTEST, NULL, &report), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(3, x, 1, wild, QUAT_SHORTEST, q, &report), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(3, x, 1, t, (quat_gauge)3, q, &report), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(SIZE_MAX / 2, x, 1, t, QUAT_SHORTEST, q, &report), QUAT_ENOMEM);
    assert_int_equal(quat_choose_frames(3, x, SIZE_MAX / 2, t, QUAT_SHORTEST, q, &report), QUAT_ENOMEM);
    qvec3 far[3];
    memcpy(far, x, sizeof far);
    far[1].y = NAN;
    assert_int_equal(quat_choose_frames(3, far, 1, t, QUAT_SHORTEST, q, &report), QUAT_EDOMAIN);
    q[2] = (quat){0, 0, 0, 0};
    assert_int_equal(quat_choose_frames(3, x, 1, t, QUAT_SHORTEST, q, &report), QUAT_EDOMAIN);
}

static void seams_that_are_none(void **state)
{
    (void)state;
    const quat one = {1, 0, 0, 0}, none = {0, 0, 0, 0}, away = {0, 1, 0, 0};
    double turns, off;
    assert_int_equal(quat_transition(1, &one, &one, NULL, NULL, NULL), QUAT_OK);
    assert_int_equal(quat_transition(0, &one, &one, NULL, &turns, &off), QUAT_EARGUMENT);
    assert_int_equal(quat_transition(1, NULL, &one, NULL, &turns, &off), QUAT_EARGUMENT);
    assert_int_equal(quat_transition(1, &one, NULL, NULL, &turns, &off), QUAT_EARGUMENT);
    assert_int_equal(quat_transition(1, &none, &one, NULL, &turns, &off), QUAT_EDOMAIN);
    assert_int_equal(quat_transition(1, &one, &none, NULL, &turns, &off), QUAT_EDOMAIN);
    assert_int_equal(quat_transition(1, &one, &away, NULL, &turns, &off), QUAT_EDOMAIN);
    assert_near(off, pi, 1e-15);
}

/* ---- no memory ---- */

static long refuse_at; /* the allocation that fails, counted down; 0: none */
void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_malloc(size_t size) { return refuse_at > 0 && --refuse_at == 0 ? NULL : __real_malloc(size); }

/* Each allocation of a total and of a Gauss map refused: QUAT_ENOMEM, until there is none left to refuse. */
static void each_allocation_refused(void **state)
{
    (void)state;
    quat_family f;
    quat_surface s;
    quat_surface_totals totals;
    assert_int_equal(quat_ellipsoid(1, 1e3, 1, &f, &s), QUAT_OK); /* so long that it is cut into parts */
    int refused = 0;
    for (long at = 1;; at++, refused++) {
        refuse_at = at;
        const quat_status got = quat_surface_total(&s, 1e-10, &totals);
        if (refuse_at > 0) break;
        assert_int_equal(got, QUAT_ENOMEM);
    }
    refuse_at = 0;
    assert_true(refused >= 3);
    const qvec3 x[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    quat q[3] = {{1, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}};
    const size_t t[3] = {0, 1, 2};
    refuse_at = 1;
    assert_int_equal(quat_choose_frames(3, x, 1, t, QUAT_SHORTEST, q, NULL), QUAT_ENOMEM);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_number_of_a_family),  cmocka_unit_test(curves_that_are_none),
        cmocka_unit_test(bad_places_on_a_curve),    cmocka_unit_test(a_length_overflows),
        cmocka_unit_test(samples_hold_polynomials), cmocka_unit_test(closed_samples_go_round),
        cmocka_unit_test(samples_that_are_none),    cmocka_unit_test(surfaces_that_are_none),
        cmocka_unit_test(curvature_of_no_frame),    cmocka_unit_test(seams),
        cmocka_unit_test(frames_of_no_mesh),        cmocka_unit_test(seams_that_are_none),
        cmocka_unit_test(each_allocation_refused),  cmocka_unit_test(times_on_a_closed_curve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
