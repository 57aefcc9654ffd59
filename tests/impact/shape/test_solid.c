/* SPDX-License-Identifier: MIT
 *
 * Shapes that are a core and a ball, against quadrature over where impact_shape_inside says they are, and against each
 * other: a rounded box is a rounded hull of its corners, whose formulas share nothing.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include <impact/shape.h>
#include <quat/rotation.h>
#include "kit/contact_random.h"
#include "kit/solid_random.h"

static const double pi = 3.14159265358979323846;

static void near_relative(double got, double wanted, double tolerance, const char *what)
{
    if (!(fabs(got - wanted) <= tolerance * fabs(wanted)))
        fail_msg("%s: wanted %.17g, got %.17g, error/tolerance %g", what, wanted, got,
                 fabs(got - wanted) / fabs(wanted) / tolerance);
}

static void mistakes_are_named(void **state)
{
    (void)state;
    impact_shape shape = {.kind = IMPACT_SPHERE, .a = 1, .b = 1, .c = 1, .r = 2, .s = 2, .t = 2};
    char message[120];
    assert_int_equal(impact_shape_box(1, 1, 1, 1, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_box(1, 1, NAN, 0, &shape), IMPACT_EDOMAIN);
    assert_int_equal(impact_shape_box(1, 1, 1, -0.1, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_box(1, 1, 1, NAN, &shape), IMPACT_EDOMAIN);
    assert_int_equal(impact_shape_cylinder(1, 0.5, 0.5, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_cylinder(-1, 0.5, 0, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_cone(1, 1, 0.5, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_capsule(0, 1, &shape), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_polyhedron(NULL, &shape), IMPACT_EARGUMENT);
    assert_int_equal(shape.kind, IMPACT_SPHERE);
    shape = (impact_shape){.kind = IMPACT_BOX, .a = 1, .b = 0.2, .c = 1, .rounding = 0.3};
    assert_int_equal(impact_shape_check(&shape, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "rounding = 0.3 is not below every half side");
    shape = (impact_shape){.kind = IMPACT_POLYHEDRON, .a = 1, .b = 1, .c = 1};
    assert_int_equal(impact_shape_check(&shape, message, sizeof message), IMPACT_EARGUMENT);
}

/* The largest x for which along(x) is inside, by halving. */
static double border(const impact_shape *shape, qvec3 from, qvec3 along)
{
    double low = 0, high = 3 * (impact_shape_bounding_radius(shape) + qvec3_norm(from));
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        if (impact_shape_inside(shape, qvec3_axpy(middle, along, from)) <= 1)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Along z between the places where the profile has corners, with z = middle - half cos(pi s): smooth at both ends. */
static void turned_moments(const impact_shape *shape, const double *corner, int corners, double moments[4])
{
    enum { POINTS = 400 };
    memset(moments, 0, 4 * sizeof *moments);
    for (int i = 0; i + 1 < corners; i++)
        for (int k = 0; k < POINTS; k++) {
            const double middle = 0.5 * (corner[i] + corner[i + 1]), half = 0.5 * (corner[i + 1] - corner[i]),
                         s = (k + 0.5) / POINTS, z = middle - half * cos(pi * s), dz = half * pi * sin(pi * s) / POINTS;
            const double rho = border(shape, (qvec3){0, 0, z}, (qvec3){0.6, 0.8, 0}), square = rho * rho;
            moments[0] += pi * square * dz, moments[1] += pi * square * z * dz, moments[2] += pi * square * z * z * dz;
            moments[3] += pi / 4 * square * square * dz;
        }
}

static void turned_against_quadrature(void **state)
{
    (void)state;
    random_stream random = {3};
    for (int k = 0; k < 60; k++) {
        impact_shape shape = {.kind = IMPACT_SPHERE};
        const double a = random_log(&random, 0.2, 2), c = random_log(&random, 0.2, 2),
                     r = (k & 1) * 0.95 * random_unit(&random) * fmin(a, c / 2);
        double corner[4], m[4];
        int corners = 4;
        if (k % 3 == 0) {
            assert_int_equal(impact_shape_cylinder(a, c, r, &shape), IMPACT_OK);
            corner[0] = -c, corner[1] = -c + r, corner[2] = c - r, corner[3] = c;
        } else if (k % 3 == 1) {
            assert_int_equal(impact_shape_capsule(a, c, &shape), IMPACT_OK);
            corner[0] = -c - a, corner[1] = -c, corner[2] = c, corner[3] = c + a;
        } else {
            assert_int_equal(impact_shape_cone(a, c, r, &shape), IMPACT_OK);
            const double up = r * (a - r) / hypot(a - r, c - 2 * r), top = shape.base + c - 2 * r;
            corner[0] = shape.base - r, corner[1] = shape.base + up, corner[2] = top + up, corner[3] = top + r;
        }
        turned_moments(&shape, corner, corners, m);
        const qvec3 inertia = impact_shape_inertia(&shape);
        near_relative(impact_shape_volume(&shape), m[0], 2e-5, "volume");
        near_relative(inertia.z, 2 * m[3] / m[0], 2e-5, "moment about z");
        near_relative(inertia.x, (m[3] + m[2]) / m[0], 2e-5, "moment about x");
        if (fabs(m[1]) > 2e-5 * m[0] * c) fail_msg("centroid at %g of %g", m[1] / m[0], c);
    }
}

/* Corners of a box, turned and moved: the hull finds the frame, and the moments of the closed form. */
static void rounded_hulls_of_boxes(void **state)
{
    (void)state;
    random_stream random = {7};
    for (int k = 0; k < 300; k++) {
        const double side[3] = {random_log(&random, 0.1, 10), random_log(&random, 0.1, 10),
                                random_log(&random, 0.1, 10)};
        const double r = k % 3 ? random_log(&random, 1e-3, 1) * 0.5 : 0;
        const quat q = k % 5 ? random_rotation(&random) : quat_identity();
        const qvec3 away = k % 5 ? random_direction(&random) : (qvec3){0, 0, 0};
        qvec3 points[9];
        for (int i = 0; i < 8; i++)
            points[i] = qvec3_add(away, quat_rotate(q, (qvec3){i & 1 ? side[0] : -side[0], i & 2 ? side[1] : -side[1],
                                                               i & 4 ? side[2] : -side[2]}));
        points[8] = away;
        impact_hull *hull;
        char message[120];
        if (impact_hull_create(points, 9, r, NULL, &hull, message, sizeof message) != IMPACT_OK)
            fail_msg("%s", message);
        const impact_hull_info info = impact_hull_describe(hull);
        assert_int_equal(info.vertices, 8);
        assert_int_equal(info.edges, 12);
        assert_int_equal(info.faces, 6);
        assert_int_equal(info.dropped, 1);
        impact_shape box, shape;
        impact_shape_box(side[0] + r, side[1] + r, side[2] + r, r, &box);
        assert_int_equal(impact_shape_polyhedron(hull, &shape), IMPACT_OK);
        near_relative(impact_shape_volume(&shape), impact_shape_volume(&box), 1e-13, "volume");
        const qvec3 got = impact_shape_inertia(&shape), wanted = impact_shape_inertia(&box);
        near_relative(got.x + got.y + got.z, wanted.x + wanted.y + wanted.z, 1e-13, "trace");
        near_relative(qvec3_dot(got, got), qvec3_dot(wanted, wanted), 1e-13, "squares");
        for (int i = 0; i < info.vertices; i++) { /* frame and points are one */
            const qvec3 x = qvec3_add(info.center, quat_rotate(info.axes, impact_hull_vertex(hull, i)));
            double least = INFINITY;
            for (int j = 0; j < 8; j++) least = fmin(least, qvec3_norm(qvec3_sub(x, points[j])));
            if (least > 4e-15 * 20) fail_msg("vertex %d off by %g", i, least);
            if (k % 5 == 0) assert_true(qvec3_norm(qvec3_sub(impact_hull_vertex(hull, i), x)) == 0 && least == 0);
        }
        impact_hull_destroy(hull);
    }
}

/* Moments of any rounded hull by rays from its centre. */
static void rounded_hulls_by_rays(void **state)
{
    (void)state;
    random_stream random = {11};
    enum { RAYS = 20000 };
    for (int k = 0; k < 12; k++) {
        impact_hull *hull = random_hull(&random, 4 + k, k % 2 ? 0.3 : 0);
        impact_shape shape;
        assert_int_equal(impact_shape_polyhedron(hull, &shape), IMPACT_OK);
        double volume = 0, second[3] = {0};
        qvec3 first = {0, 0, 0};
        for (int i = 0; i < RAYS; i++) { /* Fibonacci's lattice */
            const double z = 1 - (2 * i + 1.0) / RAYS, phi = i * 2.39996322972865332, across = sqrt(1 - z * z);
            const qvec3 n = {across * cos(phi), across * sin(phi), z};
            const double R = border(&shape, (qvec3){0, 0, 0}, n), cube = R * R * R;
            volume += cube / 3, first = qvec3_axpy(cube * R / 4, n, first);
            second[0] += cube * R * R / 5 * n.x * n.x, second[1] += cube * R * R / 5 * n.y * n.y;
            second[2] += cube * R * R / 5 * n.x * n.y;
        }
        near_relative(impact_shape_volume(&shape), volume * 4 * pi / RAYS, 1e-3, "volume");
        near_relative(impact_shape_inertia(&shape).z, (second[0] + second[1]) / volume, 2e-3, "moment");
        assert_true(qvec3_norm(first) < 2e-3 * volume && fabs(second[2]) < 2e-3 * volume);
        impact_hull_destroy(hull);
    }
}

/* Every point given is inside, every vertex on the surface, every face flat with all points below; Euler. */
static void hulls_hold_their_points(void **state)
{
    (void)state;
    random_stream random = {13};
    for (int k = 0; k < 400; k++) {
        const int count = k < 300 ? 4 + k % 30 : 256;
        qvec3 points[IMPACT_HULL_POINTS];
        for (int i = 0; i < count; i++) points[i] = random_point(&random, k % RANDOM_POINTS);
        impact_hull *hull;
        char message[120];
        if (impact_hull_create(points, (size_t)count, 0, NULL, &hull, message, sizeof message) != IMPACT_OK) {
            assert_true(strstr(message, "lie in a plane") || strstr(message, "are one point"));
            continue;
        }
        const impact_hull_info info = impact_hull_describe(hull);
        assert_int_equal(info.vertices - info.edges + info.faces, 2);
        assert_int_equal(info.vertices + info.dropped, count);
        int corners = 0;
        for (int f = 0; f < info.faces; f++) {
            int vertex[IMPACT_HULL_POINTS];
            qvec3 n;
            corners += impact_hull_face(hull, f, vertex, &n);
            const double h = qvec3_dot(n, impact_hull_vertex(hull, vertex[0]));
            for (int i = 0; i < count; i++) {
                const qvec3 x = quat_rotate_inverse(info.axes, qvec3_sub(points[i], info.center));
                if (qvec3_dot(n, x) - h > 4e-14)
                    fail_msg("case %d: point %d is %g above face %d", k, i, qvec3_dot(n, x) - h, f);
            }
        }
        assert_int_equal(corners, 2 * info.edges);
        impact_hull_destroy(hull);
    }
}

static void hulls_refuse_in_words(void **state)
{
    (void)state;
    impact_hull *hull;
    char message[120];
    const qvec3 flat[5] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0.3, 0.2, 1e-17}}, bad[4] = {{0, 0, NAN}};
    const qvec3 good[4] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}},
                one[4] = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    assert_int_equal(impact_hull_create(flat, 3, 0, NULL, &hull, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "3 points are fewer than 4");
    assert_null(hull);
    assert_int_equal(impact_hull_create(flat, 5, 0, NULL, &hull, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "its 5 vertices lie in a plane to 1e-17 m");
    assert_int_equal(impact_hull_create(bad, 4, 0, NULL, &hull, message, sizeof message), IMPACT_EDOMAIN);
    assert_string_equal(message, "vertex 1 is not finite");
    assert_int_equal(impact_hull_create(one, 4, 0, NULL, &hull, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "its 4 vertices are one point");
    assert_int_equal(impact_hull_create(good, 4, -1, NULL, &hull, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "rounding = -1 is negative");
    assert_int_equal(impact_hull_create(good, 4, NAN, NULL, &hull, message, sizeof message), IMPACT_EDOMAIN);
    assert_int_equal(impact_hull_create(good, 257, 0, NULL, &hull, NULL, 0), IMPACT_EARGUMENT);
}

/* h(n) = n.x at a point on the surface that no other of the shape exceeds; the ball holds it; meshes lie on it. */
static void supports_are_the_farthest(void **state)
{
    (void)state;
    random_stream random = {17};
    for (int k = 0; k < 2000; k++) {
        impact_hull *hull = NULL;
        const impact_shape shape = random_solid_shape(&random, k % RANDOM_SOLIDS, &hull);
        const double size = contact_size(&shape);
        const qvec3 d = random_direction(&random), other = random_direction(&random);
        qvec3 x, y;
        const double h = impact_shape_support(&shape, d, &x);
        impact_shape_support(&shape, other, &y);
        assert_true(fabs(h - qvec3_dot(d, x)) <= 4e-15 * size && qvec3_dot(d, y) <= h + 4e-15 * size);
        if (fabs(impact_shape_inside(&shape, x) - 1) > 1e-14)
            fail_msg("kind %d: inside is %.17g on the surface", (int)shape.kind, impact_shape_inside(&shape, x));
        assert_true(qvec3_norm(x) <= impact_shape_bounding_radius(&shape) * (1 + 4e-15));
        const double u = pi * (2 * random_unit(&random) - 1), v = pi * (random_unit(&random) - 0.5);
        const qvec3 p = impact_shape_point(&shape, u, v), n = impact_shape_normal(&shape, u, v);
        assert_true(fabs(qvec3_dot(p, n) - impact_shape_support(&shape, n, NULL)) <= 1e-14 * size);
        impact_hull_destroy(hull);
    }
}

static void curvatures_of_what_is_met(void **state)
{
    (void)state;
    impact_shape shape;
    double k1, k2;
    impact_shape_box(1, 2, 3, 0.25, &shape);
    impact_shape_curvatures(&shape, (qvec3){1, 0, 0}, &k1, &k2);
    assert_true(k1 == 0 && k2 == 0);
    impact_shape_curvatures(&shape, (qvec3){1, 1, 0}, &k1, &k2);
    assert_true(k1 == 4 && k2 == 0);
    impact_shape_curvatures(&shape, (qvec3){1, 1, 1}, &k1, &k2);
    assert_true(k1 == 4 && k2 == 4);
    impact_shape_cylinder(2, 3, 0, &shape);
    impact_shape_curvatures(&shape, (qvec3){1, 0, 0}, &k1, &k2);
    assert_true(k1 == 0.5 && k2 == 0);
    impact_shape_curvatures(&shape, (qvec3){0, 0, -1}, &k1, &k2);
    assert_true(k1 == 0 && k2 == 0);
    impact_shape_curvatures(&shape, (qvec3){3, 0, 4}, &k1, &k2); /* the rim: R/rho = 2/.6 */
    assert_true(isinf(k1) && fabs(k2 - 0.3) < 1e-15);
    impact_shape_capsule(2, 3, &shape);
    impact_shape_curvatures(&shape, (qvec3){0, 1, 0}, &k1, &k2);
    assert_true(k1 == 0.5 && k2 == 0);
    const qmat3 H = impact_shape_support_hessian(&shape, (qvec3){0.6, 0, 0.8});
    assert_true(fabs(H.m[0][0] - 2 * 0.64) < 1e-15 && fabs(H.m[1][1] - 2) < 1e-15 &&
                fabs(H.m[0][2] + 2 * 0.48) < 1e-15);
}

/* Every number of every shape that a caller may have filled in by hand. */
static void shapes_by_hand(void **state)
{
    (void)state;
    impact_shape box, cylinder, cone, capsule, quadric, made;
    impact_shape_box(1, 2, 3, 0.5, &box);
    impact_shape_cylinder(2, 1, 0.1, &cylinder);
    impact_shape_cone(2, 3, 0.1, &cone);
    impact_shape_capsule(1, 2, &capsule);
    impact_shape_superellipsoid(1, 2, 3, 1, 0.5, &quadric);
    const struct {
        const impact_shape *good;
        size_t place;
        double value;
        impact_status status;
        const char *words;
    } bad[] = {
        {&box, offsetof(impact_shape, b), 0, IMPACT_EARGUMENT, "half side b"},
        {&box, offsetof(impact_shape, c), NAN, IMPACT_EDOMAIN, "half side c"},
        {&cylinder, offsetof(impact_shape, b), 1, IMPACT_EARGUMENT,
         "b = 1 is not a, the radius, as a round body needs"},
        {&cone, offsetof(impact_shape, base), 0, IMPACT_EARGUMENT, "base = 0 is not below the centroid"},
        {&cone, offsetof(impact_shape, base), -3, IMPACT_EARGUMENT, "base = -3 is not below the centroid"},
        {&capsule, offsetof(impact_shape, rounding), 0.5, IMPACT_EARGUMENT,
         "is not a capsule's radius, or c not above"},
        {&capsule, offsetof(impact_shape, c), 1, IMPACT_EARGUMENT, "is not a capsule's radius, or c not above"},
        {&quadric, offsetof(impact_shape, s), 3, IMPACT_EARGUMENT,
         "exponent s = 3 is not r, as a superellipsoid needs"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char message[200];
        impact_shape shape = *bad[i].good;
        assert_int_equal(impact_shape_check(&shape, message, sizeof message), IMPACT_OK);
        memcpy((char *)&shape + bad[i].place, &bad[i].value, sizeof bad[i].value);
        assert_int_equal(impact_shape_check(&shape, message, sizeof message), bad[i].status);
        if (!strstr(message, bad[i].words)) fail_msg("%s: %s", bad[i].words, message);
    }
    assert_int_equal(impact_shape_superellipsoid(1, 1, 1, 1, 0, &made), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_superellipsoid(1, 1, 1, NAN, 1, &made), IMPACT_EDOMAIN);
    assert_int_equal(impact_shape_superellipsoid(1, 1, 1, 1, INFINITY, &made), IMPACT_EDOMAIN);
    assert_int_equal(impact_shape_capsule(1, 0, &made), IMPACT_EARGUMENT);
    assert_int_equal(impact_shape_capsule(1, NAN, &made), IMPACT_EDOMAIN);
}

/* A number of a vertex or a face that the hull does not have. */
static void hulls_beyond_their_ends(void **state)
{
    (void)state;
    const qvec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    impact_hull *hull;
    int vertices[8];
    qvec3 normal;
    assert_int_equal(impact_hull_create(corners, 4, 0, NULL, &hull, NULL, 0), IMPACT_OK);
    assert_int_equal(impact_hull_describe(hull).vertices, 4);
    for (int i = -1; i <= 4; i += 5) {
        assert_true(isnan(impact_hull_vertex(hull, i).x));
        assert_int_equal(impact_hull_face(hull, i, vertices, &normal), 0);
    }
    assert_int_equal(impact_hull_face(hull, 3, vertices, &normal), 3);
    impact_hull_destroy(hull);
    impact_hull_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_named),
        cmocka_unit_test(turned_against_quadrature),
        cmocka_unit_test(rounded_hulls_of_boxes),
        cmocka_unit_test(rounded_hulls_by_rays),
        cmocka_unit_test(hulls_hold_their_points),
        cmocka_unit_test(hulls_refuse_in_words),
        cmocka_unit_test(supports_are_the_farthest),
        cmocka_unit_test(curvatures_of_what_is_met),
        cmocka_unit_test(shapes_by_hand),
        cmocka_unit_test(hulls_beyond_their_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
