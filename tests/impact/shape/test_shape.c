/* SPDX-License-Identifier: MIT */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>
#include <impact/shape.h>
#include "kit/contact_random.h"

static const double pi = 3.14159265358979323846;

static void near_relative(double got, double wanted, double tolerance)
{
    if (!(fabs(got - wanted) <= tolerance * fabs(wanted)))
        fail_msg("wanted %.17g, got %.17g, error/tolerance %g", wanted, got,
                 fabs(got - wanted) / fabs(wanted) / tolerance);
}

static impact_shape superquadric(double a, double b, double c, double r, double s, double t)
{
    impact_shape shape;
    assert_int_equal(impact_shape_superquadric(a, b, c, r, s, t, &shape), IMPACT_OK);
    return shape;
}

static void refusals(void **state)
{
    (void)state;
    impact_shape shape = {.kind = IMPACT_SPHERE, .a = 1, .b = 1, .c = 1, .r = 2, .s = 2, .t = 2};
    const impact_shape before = shape;
    assert_int_equal(impact_shape_sphere(-1, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_sphere(INFINITY, &shape), IMPACT_EDOMAIN);
    assert_int_equal(impact_shape_plane(0, 1, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_superquadric(1, 1, 1, 0.5, 2, 2, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_superquadric(1, 1, 0, 2, 2, 2, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_superquadric(1, NAN, 1, 2, 2, 2, &shape), IMPACT_EDOMAIN);
    assert_int_equal(impact_shape_superquadric(1, 1, 1, 2, 2, 1e7, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_superellipsoid(1, 1, 1, 2.5, 1, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_superellipsoid(1, 1, 1, 0, 1, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_superellipsoid(1, 1, 1, NAN, 1, &shape), IMPACT_EDOMAIN);
    assert_true(shape.kind == before.kind && shape.a == before.a && shape.b == before.b && shape.c == before.c);
    assert_true(shape.r == before.r && shape.s == before.s && shape.t == before.t);

    char message[80];
    const impact_shape bad = {.kind = IMPACT_SUPERQUADRIC, .a = 1, .b = 1, .c = 1, .r = 0.5, .s = 2, .t = 2};
    assert_int_equal(impact_shape_check(&bad, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "exponent r = 0.5 < 1 is not convex");
    assert_int_equal(impact_shape_check(&before, message, sizeof message), IMPACT_OK);
    assert_string_equal(message, "");
}

static void known_volumes_and_inertia(void **state)
{
    (void)state;
    impact_shape shape;
    impact_shape_sphere(0.3, &shape);
    near_relative(impact_shape_volume(&shape), 4.0 / 3.0 * pi * 0.027, 4e-16);
    near_relative(impact_shape_inertia(&shape).x, 0.4 * 0.09, 4e-16);

    shape = superquadric(1, 2, 3, 1, 1, 1); /* octahedron: V = 4/3 abc, <x^2> = a^2/10 */
    near_relative(impact_shape_volume(&shape), 8, 2e-15);
    near_relative(impact_shape_inertia(&shape).x, (4 + 9) / 10.0, 4e-15);

    shape = superquadric(0.1, 0.2, 0.3, 2, 2, 2);
    near_relative(impact_shape_volume(&shape), 4.0 / 3.0 * pi * 0.006, 1e-15);
    near_relative(impact_shape_inertia(&shape).z, 0.2 * 0.05, 1e-15);

    shape = superquadric(1, 1, 2, 2, 2, 1e6); /* a cylinder to 1e-6 */
    near_relative(impact_shape_volume(&shape), pi * 4, 3e-6);
    near_relative(impact_shape_inertia(&shape).z, 0.5, 3e-6);

    impact_shape barr;
    assert_int_equal(impact_shape_superellipsoid(1, 2, 3, 0.5, 0.5, &barr), IMPACT_OK);
    shape = superquadric(1, 2, 3, 4, 4, 4);
    near_relative(impact_shape_volume(&barr), impact_shape_volume(&shape), 4e-15);
    near_relative(impact_shape_inertia(&barr).x, impact_shape_inertia(&shape).x, 8e-15);
    near_relative(impact_shape_inertia(&barr).z, impact_shape_inertia(&shape).z, 8e-15);

    assert_int_equal(impact_shape_superellipsoid(1, 1, 1, 2, 1, &barr), IMPACT_OK); /* double cone: V = 2/3 pi */
    near_relative(impact_shape_volume(&barr), 2.0 / 3.0 * pi, 4e-15);
    near_relative(impact_shape_inertia(&barr).z, 0.3, 8e-15);

    impact_shape_plane(INFINITY, INFINITY, &shape);
    assert_true(isinf(impact_shape_volume(&shape)) && isinf(impact_shape_inertia(&shape).y));
}

/* The ball holds every support point and touches one, to the fineness of the sampling. */
static void smallest_ball(void **state)
{
    (void)state;
    random_stream random = {17};
    for (int k = 0; k < 200; k++) {
        const impact_shape shape = random_shape(&random, k % RANDOM_FAMILIES);
        const double radius = impact_shape_bounding_radius(&shape);
        double farthest = 0;
        qvec3 best = {0, 0, 1};
        for (int i = 0; i < 300; i++) {
            qvec3 d = random_direction(&random), x;
            for (int j = 0; j < 60; j++) { /* climbing: the farthest point in the direction of the last */
                impact_shape_support(&shape, d, &x);
                d = x;
            }
            if (qvec3_norm(x) > farthest) farthest = qvec3_norm(x), best = x;
        }
        (void)best;
        if (!(farthest <= radius * (1 + 4e-15) && farthest >= radius * (1 - 1e-3)))
            fail_msg("ball %.17g, farthest point %.17g, exponents %g %g %g, axes %g %g %g", radius, farthest, shape.r,
                     shape.s, shape.t, shape.a, shape.b, shape.c);
    }
}

static void support_identities(void **state)
{
    (void)state;
    random_stream random = {5};
    for (int k = 0; k < 20000; k++) {
        const impact_shape shape = random_shape(&random, k % RANDOM_FAMILIES);
        const qvec3 d = random_direction(&random), other = random_direction(&random);
        qvec3 x, y;
        const double size = fmax(shape.a, fmax(shape.b, shape.c));
        const double h = impact_shape_support(&shape, d, &x);
        const double worth = fmax(fabs(d.x) * shape.a, fmax(fabs(d.y) * shape.b, fabs(d.z) * shape.c));
        assert_true(h >= worth * (1 - 1e-15)); /* the semi-axes' ends are in the shape */
        if (!(fabs(qvec3_dot(d, x) - h) <= 3e-15 * size))
            fail_msg("d.x - h = %g of %g, exponents %.17g %.17g %.17g", qvec3_dot(d, x) - h, size, shape.r, shape.s,
                     shape.t);
        near_relative(impact_shape_support(&shape, qvec3_scale(d, 8), NULL), 8 * h, 1e-15);
        impact_shape_support(&shape, other, &y);
        assert_true(qvec3_dot(d, y) <= h + 3e-15 * size);
        /* an exponent of 1e3 makes 1 - f of one ulp of x 1e3 times that */
        const double off = impact_shape_inside(&shape, x) - 1;
        if (!(fabs(off) <= 2e-15 * (2 + fmax(shape.r, fmax(shape.s, shape.t)))))
            fail_msg("f - 1 = %g, exponents %.17g %.17g %.17g", off, shape.r, shape.s, shape.t);
    }
}

/* The Hessian against central differences of the support point, where it is smooth. */
static void hessian_is_the_derivative(void **state)
{
    (void)state;
    random_stream random = {11};
    for (int k = 0; k < 2000; k++) {
        const impact_shape shape = random_smooth_shape(&random, k % 2 == 1);
        const qvec3 d = random_direction(&random), e = random_direction(&random);
        if (fabs(d.x) < 0.2 || fabs(d.y) < 0.2 || fabs(d.z) < 0.2) continue;
        const qmat3 H = impact_shape_support_hessian(&shape, d);
        qvec3 plus, minus;
        const double step = 1e-5;
        impact_shape_support(&shape, qvec3_axpy(step, e, d), &plus);
        impact_shape_support(&shape, qvec3_axpy(-step, e, d), &minus);
        const qvec3 wanted = qvec3_scale(qvec3_sub(plus, minus), 0.5 / step);
        const qvec3 got = {H.m[0][0] * e.x + H.m[0][1] * e.y + H.m[0][2] * e.z,
                           H.m[1][0] * e.x + H.m[1][1] * e.y + H.m[1][2] * e.z,
                           H.m[2][0] * e.x + H.m[2][1] * e.y + H.m[2][2] * e.z};
        const double scale = fabs(H.m[0][0]) + fabs(H.m[1][1]) + fabs(H.m[2][2]);
        if (!(qvec3_norm(qvec3_sub(got, wanted)) <= 2e-7 * scale))
            fail_msg("Hessian off by %g of %g: exponents %g %g %g", qvec3_norm(qvec3_sub(got, wanted)), scale, shape.r,
                     shape.s, shape.t);
    }
}

static void curvatures(void **state)
{
    (void)state;
    double k1, k2;
    impact_shape shape;
    impact_shape_sphere(0.5, &shape);
    impact_shape_curvatures(&shape, (qvec3){1, 2, -2}, &k1, &k2);
    near_relative(k1, 2, 4e-8); /* a double root: half the digits */
    near_relative(k2, 2, 4e-8);
    shape = superquadric(1, 2, 3, 2, 2, 2); /* at the tip of c: c/b^2 and c/a^2 */
    impact_shape_curvatures(&shape, (qvec3){0, 0, 1}, &k1, &k2);
    near_relative(k1, 3, 1e-14);
    near_relative(k2, 0.75, 1e-14);
    shape = superquadric(1, 1, 1, 4, 4, 4);
    impact_shape_curvatures(&shape, (qvec3){0, 0, 1}, &k1, &k2);
    assert_true(k1 == 0 && k2 == 0);
    shape = superquadric(1, 1, 1, 1, 1, 1);
    impact_shape_curvatures(&shape, (qvec3){0.1, 0.2, 1}, &k1, &k2);
    assert_true(isinf(k1) && isinf(k2));
}

static void surface_points_and_normals(void **state)
{
    (void)state;
    random_stream random = {23};
    for (int k = 0; k < 4000; k++) {
        const impact_shape shape = random_smooth_shape(&random, k % 2 == 1);
        const double u = (random_unit(&random) * 2 - 1) * pi, v = (random_unit(&random) - 0.5) * pi;
        const qvec3 x = impact_shape_point(&shape, u, v), n = impact_shape_normal(&shape, u, v);
        near_relative(impact_shape_inside(&shape, x), 1, 1e-13);
        const double h = impact_shape_support(&shape, n, NULL);
        near_relative(qvec3_dot(n, x), h, 1e-13);
    }
    qvec3 points[8 * 5], normals[8 * 5];
    const impact_shape shape = superquadric(1, 2, 3, 4, 3, 2);
    assert_int_equal(impact_shape_mesh(&shape, 8, 4, points, normals), IMPACT_OK);
    assert_int_equal(impact_shape_mesh(&shape, 2, 4, points, normals), IMPACT_EARGUMENT);
    near_relative(points[4 * 8].z, 3, 1e-15);
    near_relative(normals[4 * 8].z, 1, 1e-15);
}

/* Where quarter turns are given in doubles: on the axes, of exponents with which a rounding u of its cosine would be
 * u^(2/p), 1e-3 of the size and more; and none else, as near as 1e-14 rad. */
static void quarter_turns_are_on_the_axes(void **state)
{
    (void)state;
    const impact_shape shape = superquadric(1, 2, 3, 10, 10, 10);
    for (int k = -4; k < 4; k++) {
        const qvec3 x = impact_shape_point(&shape, k * pi / 2, 0), beside = impact_shape_point(&shape, 1e-14, 0);
        assert_true(x.z == 0 && (k % 2 ? x.x == 0 && fabs(x.y) == 2 : fabs(x.x) == 1 && x.y == 0));
        near_relative(beside.y, 2 * pow(1e-14, 0.2), 1e-12);
    }
    for (int side = -1; side <= 1; side += 2) {
        const qvec3 pole = impact_shape_point(&shape, 1, side * pi / 2),
                    n = impact_shape_normal(&shape, 1, side * pi / 2);
        assert_true(pole.x == 0 && pole.y == 0 && pole.z == 3 * side);
        assert_true(n.x == 0 && n.y == 0 && n.z == side);
    }
}

/* A plane answers every question, with what it has: no size, no curvature, support along +z alone. */
static void planes_answer_too(void **state)
{
    (void)state;
    impact_shape plane;
    qvec3 x;
    double k1, k2;
    assert_int_equal(impact_shape_plane(2, 3, &plane), IMPACT_OK);
    assert_true(impact_shape_support(&plane, (qvec3){0, 0, 2}, &x) == 0 && x.z == 0);
    assert_true(isinf(impact_shape_support(&plane, (qvec3){0, 0.1, 2}, &x)) && isnan(x.x));
    assert_true(isinf(impact_shape_support(&plane, (qvec3){0, 0, -1}, NULL)));
    assert_true(isnan(impact_shape_support_hessian(&plane, (qvec3){0, 0, 1}).m[0][0]));
    x = impact_shape_point(&plane, -5, 1);
    assert_true(x.x == -2 && x.y == 1 && x.z == 0);
    assert_true(impact_shape_normal(&plane, 1, 1).z == 1);
    assert_true(impact_shape_inside(&plane, (qvec3){9, 9, -0.5}) == 0.5);
    impact_shape_curvatures(&plane, (qvec3){0, 0, 1}, &k1, &k2);
    assert_true(k1 == 0 && k2 == 0);
    assert_true(isinf(impact_shape_volume(&plane)) && isinf(impact_shape_bounding_radius(&plane)));
    assert_true(isinf(impact_shape_inertia(&plane).x));
}

/* Flat in one direction and round in the other: an ellipsoid's side whose third exponent is above 2. */
static void flat_one_way(void **state)
{
    (void)state;
    const impact_shape shape = superquadric(1, 2, 3, 2, 2, 4);
    double k1, k2;
    impact_shape_curvatures(&shape, (qvec3){1, 0, 0}, &k1, &k2);
    near_relative(k1, 0.25, 1e-14); /* a/b^2 */
    assert_true(k2 == 0);
    impact_shape_curvatures(&shape, (qvec3){0, 3, 0}, &k1, &k2);
    near_relative(k1, 2, 1e-14); /* b/a^2 */
    assert_true(k2 == 0);
    impact_shape_curvatures(&shape, (qvec3){0, 0, 0}, &k1, &k2);
    assert_true(isnan(k1) && isnan(k2));
    impact_shape_curvatures(&shape, (qvec3){0, INFINITY, 0}, &k1, &k2);
    assert_true(isnan(k1) && isnan(k2));
    qvec3 points[3 * 3];
    assert_int_equal(impact_shape_mesh(&shape, 3, 2, points, NULL), IMPACT_OK);
    assert_int_equal(impact_shape_mesh(&shape, 3, 1, points, NULL), IMPACT_EARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refusals),
        cmocka_unit_test(known_volumes_and_inertia),
        cmocka_unit_test(smallest_ball),
        cmocka_unit_test(support_identities),
        cmocka_unit_test(hessian_is_the_derivative),
        cmocka_unit_test(curvatures),
        cmocka_unit_test(surface_points_and_normals),
        cmocka_unit_test(quarter_turns_are_on_the_axes),
        cmocka_unit_test(planes_answer_too),
        cmocka_unit_test(flat_one_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
