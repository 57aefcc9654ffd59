/* SPDX-License-Identifier: MIT
 *
 * Support functions of every kind of shape by what they are: h(d) = d . x(d), x on the surface and no point of it
 * further out, h convex and of degree 1; the Hessian by differences of x = grad h, symmetric, with d its null vector.
 */
#include <impact/shape.h>
#include "kit/contact_random.h"
#include "kit/near.h"

enum { SHAPES = 400, DIRECTIONS = 40 };

static impact_shape shape_of(random_stream *random, impact_hull **hull)
{
    static const double exponents[] = {1, 1, 1.5, 2, 2, 3, 4, 8};
    const double a = random_log(random, 0.3, 2), b = random_log(random, 0.3, 2), c = random_log(random, 0.3, 2);
    double p[3];
    for (int i = 0; i < 3; i++) p[i] = exponents[random_bits(random) % 8];
    qvec3 corner[12];
    impact_shape shape = {.kind = IMPACT_SPHERE};
    *hull = NULL;
    switch (random_bits(random) % 8) {
    case 0: impact_shape_superellipsoid(a, b, c, 2 / p[0], 2 / p[1], &shape); break;
    case 1: impact_shape_box(a, b, c, 0.1 * (random_bits(random) % 2), &shape); break;
    case 2: impact_shape_cylinder(a, b, 0.1 * (random_bits(random) % 2), &shape); break;
    case 3: impact_shape_cone(a, 2 * b, 0.1 * (random_bits(random) % 2), &shape); break;
    case 4: impact_shape_capsule(a, a + b, &shape); break;
    case 5:
        for (int i = 0; i < 12; i++) corner[i] = random_vector(random, 0.5, 1);
        assert_int_equal(impact_hull_create(corner, 12, 0.05 * (random_bits(random) % 2), NULL, hull, NULL, 0),
                         IMPACT_OK);
        impact_shape_polyhedron(*hull, &shape);
        break;
    default: impact_shape_superquadric(a, b, c, p[0], p[1], p[2], &shape);
    }
    return shape;
}

/* Any, or with one part or two that are zero. */
static qvec3 direction_of(random_stream *random)
{
    qvec3 d = random_direction(random);
    const unsigned zero = random_bits(random) % 12;
    if (zero & 1 && zero < 8) d.x = 0;
    if (zero & 2 && zero < 8) d.y = 0;
    if (zero & 4 && zero < 8) d.z = 0;
    return qvec3_norm(d) > 0.1 ? qvec3_scale(d, 1 / qvec3_norm(d)) : (qvec3){0, 0, 1};
}

static double size_of(const impact_shape *s) { return impact_shape_bounding_radius(s); }

static void supports(void **state)
{
    (void)state;
    random_stream random = {41};
    for (int k = 0; k < SHAPES; k++) {
        impact_hull *hull;
        const impact_shape shape = shape_of(&random, &hull);
        for (int i = 0; i < DIRECTIONS; i++) {
            const qvec3 d = direction_of(&random), e = direction_of(&random);
            qvec3 x, y;
            const double h = impact_shape_support(&shape, d, &x), size = size_of(&shape);
            assert_near(h, qvec3_dot(d, x), 1e-14 * size);
            assert_near(impact_shape_support(&shape, d, NULL), h, 0);
            assert_near(impact_shape_support(&shape, qvec3_scale(d, 3), NULL), 3 * h, 1e-14 * size);
            const double other = impact_shape_support(&shape, e, &y);
            assert_true(qvec3_dot(d, y) <= h + 1e-14 * size && qvec3_dot(e, x) <= other + 1e-14 * size);
            assert_true(impact_shape_support(&shape, qvec3_add(d, e), NULL) <= h + other + 1e-14 * size);
            const double inside = impact_shape_inside(&shape, x);
            if (fabs(inside - 1) > 1e-12) fail_msg("shape %d of kind %d: %.17g", k, (int)shape.kind, inside);
            assert_true(impact_shape_inside(&shape, qvec3_scale(x, 0.99)) <= 1 + 1e-12);
        }
        impact_hull_destroy(hull);
    }
}

static qvec3 column(qmat3 H, qvec3 t)
{
    return (qvec3){H.m[0][0] * t.x + H.m[0][1] * t.y + H.m[0][2] * t.z,
                   H.m[1][0] * t.x + H.m[1][1] * t.y + H.m[1][2] * t.z,
                   H.m[2][0] * t.x + H.m[2][1] * t.y + H.m[2][2] * t.z};
}

static bool is_finite(qmat3 H)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) sum += H.m[i][j];
    return isfinite(sum);
}

/* Where there is none: at the pole of a superellipsoid whose profile is round there and whose section is no ellipse. */
static bool has_none(const impact_shape *s, qvec3 d)
{
    return s->kind == IMPACT_SUPERELLIPSOID && s->t == 2 && s->r != 2 && d.x == 0 && d.y == 0;
}

/* Differences of x over 2 h along t; those of h/2 beside them tell how good they are. */
static qvec3 difference(const impact_shape *shape, qvec3 d, qvec3 t, double h)
{
    qvec3 ahead, behind;
    impact_shape_support(shape, qvec3_axpy(h, t, d), &ahead);
    impact_shape_support(shape, qvec3_axpy(-h, t, d), &behind);
    return qvec3_scale(qvec3_sub(ahead, behind), 0.5 / h);
}

static void hessians(void **state)
{
    (void)state;
    random_stream random = {43};
    long compared = 0, infinite = 0;
    for (int k = 0; k < SHAPES; k++) {
        impact_hull *hull;
        const impact_shape shape = shape_of(&random, &hull);
        const double size = size_of(&shape);
        for (int i = 0; i < DIRECTIONS; i++) {
            const qvec3 d = direction_of(&random);
            const qmat3 H = impact_shape_support_hessian(&shape, d);
            if (has_none(&shape, d)) continue;
            if (!is_finite(H)) {
                infinite++;
                continue;
            }
            double most = size;
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 3; c++) {
                    most = fmax(most, fabs(H.m[r][c]));
                    assert_near(H.m[r][c], H.m[c][r], 1e-12 * most);
                }
            assert_near(qvec3_norm(column(H, d)), 0, 1e-10 * most);
            const qvec3 t = random_direction(&random), coarse = difference(&shape, d, t, 1e-5),
                        fine = difference(&shape, d, t, 5e-6), is = column(H, t);
            const double noise = qvec3_norm(qvec3_sub(coarse, fine));
            if (!(noise < 1e-4 * most)) continue; /* it bends too fast there, or a corner changes */
            if (!(qvec3_norm(qvec3_sub(is, fine)) <= 10 * noise + 1e-7 * most))
                fail_msg("shape %d of kind %d (%g %g %g), d = %g %g %g: off by %g of %g", k, (int)shape.kind, shape.r,
                         shape.s, shape.t, d.x, d.y, d.z, qvec3_norm(qvec3_sub(is, fine)), most);
            compared++;
        }
        impact_hull_destroy(hull);
    }
    assert_true(compared > SHAPES * DIRECTIONS / 2 && infinite > 100);
}

/* Curvatures are the inverse of the Hessian's two other eigenvalues: their sum and product are its trace and minors. */
static void curvatures(void **state)
{
    (void)state;
    random_stream random = {47};
    for (int k = 0; k < SHAPES; k++) {
        impact_hull *hull;
        const impact_shape shape = shape_of(&random, &hull);
        for (int i = 0; i < DIRECTIONS; i++) {
            const qvec3 d = direction_of(&random);
            const qmat3 H = impact_shape_support_hessian(&shape, d);
            double k1, k2;
            impact_shape_curvatures(&shape, d, &k1, &k2);
            assert_true(k1 >= k2 && k2 >= 0);
            const double trace = H.m[0][0] + H.m[1][1] + H.m[2][2];
            if (!is_finite(H) || !(k2 > 1e-6) || isinf(k1)) continue;
            assert_near(1 / k1 + 1 / k2, trace, 1e-9 * trace);
        }
        impact_hull_destroy(hull);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(supports),
        cmocka_unit_test(hessians),
        cmocka_unit_test(curvatures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
