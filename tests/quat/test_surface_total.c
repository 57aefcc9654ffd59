/* SPDX-License-Identifier: MIT
 *
 * Integrals over surfaces: Gauss and Bonnet, Willmore, and areas in closed form.
 */
#include "oracle.h"

#include <quat/family.h>
#include "handler.h"
#include "kit/near.h"

static const double pi = 3.14159265358979324;

static bool veil(double u, double v, qvec3 d[6], void *context)
{
    const quat_surface *inner = context;
    return inner->at(u, v, d, inner->context);
}

static void gauss_and_bonnet(void **state)
{
    (void)state;
    quat_family f;
    quat_surface s;
    quat_surface_totals t;
    double worst = 0;
    quat_ellipsoid(2, 2, 2, &f, &s);
    assert_int_equal(quat_surface_total(&s, 1e-12, &t), QUAT_OK);
    worse(&worst, fabs(t.gauss - 4 * pi) + fabs(t.area / (16 * pi) - 1) + fabs(t.mean / (8 * pi) - 1) +
                      fabs(t.bending - 4 * pi));
    quat_ellipsoid(1, 2, 3, &f, &s);
    assert_int_equal(quat_surface_total(&s, 1e-11, &t), QUAT_OK);
    worse(&worst, fabs(t.gauss - 4 * pi));
    assert_true(t.bending > 4 * pi);
    quat_torus(sqrt(2), 1, &f, &s);
    assert_int_equal(quat_surface_total(&s, 1e-12, &t), QUAT_OK);
    worse(&worst,
          fabs(t.gauss) + fabs(t.area / (4 * pi * pi * sqrt(2)) - 1) + fabs(t.bending - 2 * pi * pi)); /* Clifford's */
    quat_superellipsoid(1, 1.5, 2, 1, 1, &f, &s);
    assert_int_equal(quat_surface_total(&s, 1e-11, &t), QUAT_OK);
    worse(&worst, fabs(t.gauss - 4 * pi));
    assert_bound("Gauss and Bonnet, areas, Willmore", worst, 2e-12);
}

/* The area of a spheroid of half axes a, a, c (Archimedes' problem, solved with asin and atanh). */
static double spheroid(double a, double c)
{
    const long double ratio = (long double)c / a, e = sqrtl(ratio < 1 ? 1 - ratio * ratio : 1 - 1 / (ratio * ratio));
    const long double part = ratio < 1 ? ratio * ratio / e * atanhl(e) : ratio / e * asinl(e);
    return (double)(2 * pi * a * a * (1 + part));
}

/* Discs, needles, tori about to pinch: all that bends does so in a thousandth of the angles' range. */
static void sharp_bends(void **state)
{
    (void)state;
    random_state r = {415};
    quat_family f;
    quat_surface s;
    quat_surface_totals t;
    double area = 0, gauss = 0, willmore = 0;
    for (int round = 0; round < 20; round++) {
        const double a = random_scale(&r, -2, 2), c = a * random_scale(&r, -4, 4);
        quat_ellipsoid(a, a, c, &f, &s);
        assert_int_equal(quat_surface_total(&s, 1e-10, &t), QUAT_OK);
        worse(&area, fabs(t.area / spheroid(a, c) - 1));
        worse(&gauss, fabs(t.gauss - 4 * pi));
        quat_ellipsoid(random_scale(&r, -1, 1), random_scale(&r, -1, 1), random_scale(&r, -1, 1), &f, &s);
        assert_int_equal(quat_surface_total(&s, 1e-10, &t), QUAT_OK);
        worse(&gauss, fabs(t.gauss - 4 * pi));
        const double R = random_scale(&r, -2, 2),
                     small = R * (round % 2 ? 1 - random_scale(&r, -4, -1) : random_scale(&r, -4, 0));
        quat_torus(R, small, &f, &s);
        assert_int_equal(quat_surface_total(&s, 1e-10, &t), QUAT_OK);
        worse(&area, fabs(t.area / (4 * pi * pi * R * small) - 1));
        worse(&gauss, fabs(t.gauss));
        worse(&willmore, fabs(t.bending / (pi * pi * R * R / (small * sqrt(R * R - small * small))) - 1));
    }
    assert_bound("area of spheroids to 1 : 1e4, of tori", area, 1e-13);
    assert_bound("their integral of K, and of ellipsoids'", gauss, 2.5e-9);
    assert_bound("Willmore's integral of tori", willmore, 2e-13);
    quat_superellipsoid(1, 1, 1, 2, 2, &f, &s); /* eight flat triangles */
    assert_int_equal(quat_surface_total(&s, 1e-10, &t), QUAT_OK);
    assert_near(t.area, 4 * sqrt(3), 1e-9);
    assert_near(t.gauss, 0, 1e-12);
}

/* A cone: its apex has no tangents, and the integral of H^2 grows without bounds towards it. */
static bool cone(double u, double v, qvec3 d[6], void *context)
{
    (void)context;
    const double c = cos(u), n = sin(u);
    d[0] = qvec3_make(v * c, v * n, v);
    d[1] = qvec3_make(-v * n, v * c, 0);
    d[2] = qvec3_make(c, n, 1);
    d[3] = qvec3_make(-v * c, -v * n, 0);
    d[4] = qvec3_make(-n, c, 0);
    d[5] = qvec3_make(0, 0, 0);
    return true;
}

static void totals_that_do_not_settle(void **state)
{
    (void)state;
    const quat_surface peaked = {cone, NULL, 0, 2 * pi, 0, 1, true, false, 2};
    quat_surface_totals t;
    quat_surface_point p;
    assert_int_equal(quat_surface_at(&peaked, 1, 0, &p), QUAT_EDOMAIN);
    assert_int_equal(quat_surface_at(&peaked, 1, 0.5, &p), QUAT_OK);
    assert_near(p.curvature.mean, sqrt(0.5), 1e-15);
    assert_int_equal(quat_surface_total(&peaked, 1e-10, &t), QUAT_NOT_CONVERGED);
    assert_near(t.area, pi * sqrt(2), 1e-13);
    assert_near(t.mean, pi, 1e-12);
    assert_near(t.gauss, 0, 1e-13);
    /* differences of x alone do not see a needle's ends to 1e-7 */
    quat_family f;
    quat_surface needle;
    quat_ellipsoid(1, 1, 1e4, &f, &needle);
    quat_surface poorer = needle;
    poorer.at = veil, poorer.context = &needle, poorer.known = 0;
    assert_int_equal(quat_surface_total(&poorer, 1e-7, &t), QUAT_NOT_CONVERGED);
    assert_near(t.gauss, 4 * pi, 1e-3);
}

static bool enormous(double u, double v, qvec3 d[6], void *context)
{
    (void)context;
    d[0] = qvec3_make(1e99 * u, 1e99 * v, 0);
    d[1] = qvec3_make(1e99, 0, 0);
    d[2] = qvec3_make(0, 1e99, 0);
    d[3] = d[4] = d[5] = qvec3_make(0, 0, 0);
    return true;
}

static bool with_a_hole(double u, double v, qvec3 d[6], void *context)
{
    (void)context;
    d[0] = qvec3_make(u, v, 0);
    return hypot(u, v) > 0.3;
}

static void bad_input_has_a_status(void **state)
{
    (void)state;
    const quat_surface holed = {with_a_hole, NULL, -1, 1, -1, 1, false, false, 0}, empty = {0},
                       vast = {enormous, NULL, -1e120, 1e120, -1, 1, false, false, 2};
    quat_surface_totals t;
    assert_int_equal(quat_surface_total(&holed, 1e-7, &t), QUAT_EDOMAIN);
    assert_true(t.area == 0 && t.gauss == 0);
    assert_int_equal(quat_surface_total(&empty, 1e-7, &t), QUAT_EARGUMENT);
    assert_int_equal(quat_surface_total(&holed, 1e-15, &t), QUAT_EARGUMENT);
    assert_int_equal(quat_surface_total(&holed, NAN, &t), QUAT_EARGUMENT);
    const quat_status status = quat_surface_total(&vast, 1e-7, &t);
    assert_true(status < 0 || isfinite(t.area));
    assert_int_equal(handled, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(gauss_and_bonnet), cmocka_unit_test(sharp_bends),
                                       cmocka_unit_test(totals_that_do_not_settle),
                                       cmocka_unit_test(bad_input_has_a_status)};
    gsl_set_error_handler(count_call);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
