/* SPDX-License-Identifier: MIT */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <impact/gap.h>
#include "gap/gap_solver.h"
#include "kit/allocations.h"
#include "kit/contact_random.h"

static void near(double got, double wanted, double tolerance)
{
    if (!(fabs(got - wanted) <= tolerance))
        fail_msg("wanted %.17g, got %.17g, off by %g of %g", wanted, got, got - wanted, tolerance);
}

static impact_solid superquadric(double a, double b, double c, double r, double s, double t, qvec3 position)
{
    impact_solid body = {.position = position, .orientation = {1, 0, 0, 0}};
    assert_int_equal(impact_shape_superquadric(a, b, c, r, s, t, &body.shape), IMPACT_OK);
    return body;
}

static impact_solid ball(double radius, qvec3 position)
{
    impact_solid body = {.position = position, .orientation = {1, 0, 0, 0}};
    assert_int_equal(impact_shape_sphere(radius, &body.shape), IMPACT_OK);
    return body;
}

static double reach_of(const impact_solid *b1, const impact_solid *b2)
{
    return fmax(contact_size(&b1->shape), contact_size(&b2->shape)) + qvec3_norm(qvec3_sub(b1->position, b2->position));
}

static void expect_gap(const impact_solid *body1, const impact_solid *body2, double wanted)
{
    impact_contact c;
    const impact_status status = impact_gap(body1, body2, NULL, &c);
    if (status != IMPACT_OK)
        fail_msg("status %d, gap %g in [%g, %g], wanted %g", status, c.gap, c.lower, c.upper, wanted);
    near(c.gap, wanted, 1e-14 * reach_of(body1, body2));
}

/* ---- against 113-bit values of another formulation: tests/generators/gap_oracle.c ---- */

static void read_body(const double *v, impact_solid *body)
{
    body->shape = (impact_shape){
        .kind = (impact_shape_kind)v[0], .a = v[1], .b = v[2], .c = v[3], .r = v[4], .s = v[5], .t = v[6]};
    body->position = (qvec3){v[7], v[8], v[9]};
    body->orientation = (quat){v[10], v[11], v[12], v[13]};
}

static void agrees_with_the_oracle(void **state)
{
    (void)state;
    FILE *file = fopen(TEST_DATA "/gap_oracle.csv", "r");
    assert_non_null(file);
    char line[4096];
    int rows = 0;
    while (fgets(line, sizeof line, file)) {
        double v[38];
        char *at = line;
        for (int i = 0; i < 38; i++) v[i] = strtod(at, &at), at++;
        impact_solid body[2];
        read_body(v, &body[0]);
        read_body(v + 14, &body[1]);
        impact_contact c;
        const impact_status status = impact_gap(&body[0], &body[1], NULL, &c);
        const double *w = v + 28;
        assert_true(status == IMPACT_OK || (status == IMPACT_DEEP && w[0] < 0)); /* sharp corners are deep early */
        const double reach = reach_of(&body[0], &body[1]);
        near(c.gap, w[0], 1e-15 * reach);
        near(qvec3_norm(qvec3_sub(c.normal, (qvec3){w[1], w[2], w[3]})), 0, 1e-14);
        /* the points are as firm as the flattest surface lets them be: exponents to 12 */
        near(qvec3_norm(qvec3_sub(c.offset1, (qvec3){w[4], w[5], w[6]})), 0, 2e-12 * reach);
        near(qvec3_norm(qvec3_sub(c.offset2, (qvec3){w[7], w[8], w[9]})), 0, 2e-12 * reach);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, 200);
}

/* ---- the seam of signs ---- */

static void normal_points_from_body_2_to_body_1(void **state)
{
    (void)state;
    const impact_solid low = superquadric(1, 2, 3, 2, 2, 2, (qvec3){0, 0, 0}),
                       high = superquadric(1, 1, 1, 4, 4, 4, (qvec3){0, 0, 6});
    impact_contact c;
    assert_int_equal(impact_gap(&high, &low, NULL, &c), IMPACT_OK);
    near(c.normal.z, 1, 1e-15);
    near(c.gap, 2, 1e-15);
    near(c.point1.z, 5, 1e-15);
    near(c.point2.z, 3, 1e-15);
    near(c.offset1.z, -1, 1e-15);
    assert_int_equal(impact_gap(&low, &high, NULL, &c), IMPACT_OK);
    near(c.normal.z, -1, 1e-15);
    near(c.point1.z, 3, 1e-15);
    /* moving apart along the normal opens the gap at that speed; spin about the contact's axis does nothing */
    near(impact_gap_rate(&c, (qvec3){0, 0, -2}, (qvec3){0, 0, 7}, (qvec3){0, 0, 0.5}, (qvec3){0, 0, 1}), 2.5, 1e-15);
}

/* The smallest eigenvalue of H1 + H2 + gap I: of spheres r1 + r2 + gap, of ellipsoids at their tips a^2/c and alike. */
static void stiffness_of_known_contacts(void **state)
{
    (void)state;
    const impact_solid round1 = superquadric(1, 1, 1, 2, 2, 2, (qvec3){0, 3, 4}),
                       round2 = superquadric(2, 2, 2, 2, 2, 2, (qvec3){0, 0, 0});
    impact_contact c;
    assert_int_equal(impact_gap(&round1, &round2, NULL, &c), IMPACT_OK);
    near(c.stiffness, 1 + 2 + 2, 1e-14);
    const impact_solid tip = superquadric(1, 2, 3, 2, 2, 2, (qvec3){0, 0, 7}),
                       low = superquadric(3, 1, 2, 2, 2, 2, (qvec3){0, 0, 0});
    assert_int_equal(impact_gap(&tip, &low, NULL, &c), IMPACT_OK);
    near(c.stiffness, 4.0 / 3 + 1.0 / 2 + 2, 1e-14); /* along y; along x it is 1/3 + 9/2 + 2 */
}

/* ---- identities over random pairs ---- */

static void random_pair(random_stream *random, int family, double gap, impact_solid body[2], qvec3 *normal)
{
    for (int k = 0; k < 2; k++) {
        body[k].shape = random_shape(random, family);
        body[k].orientation = random_rotation(random);
        body[k].position = (qvec3){0, 0, 0};
    }
    *normal = random_direction(random);
    qvec3 x[2];
    for (int k = 0; k < 2; k++) {
        impact_shape_support(&body[k].shape, quat_rotate_inverse(body[k].orientation, qvec3_scale(*normal, k ? 1 : -1)),
                             &x[k]);
        x[k] = quat_rotate(body[k].orientation, x[k]);
    }
    const double size = fmax(contact_size(&body[0].shape), contact_size(&body[1].shape));
    body[0].position = qvec3_axpy(gap * size, *normal, qvec3_sub(x[1], x[0]));
}

static void truth_by_construction(void **state)
{
    (void)state;
    random_stream random = {1};
    for (int k = 0; k < 40000; k++) {
        impact_solid body[2];
        qvec3 normal;
        const double gap = random_log(&random, 1e-6, 10);
        random_pair(&random, k % RANDOM_FAMILIES, gap, body, &normal);
        impact_contact c;
        const impact_status status = impact_gap(&body[0], &body[1], NULL, &c);
        if (status == IMPACT_BRACKET) {
            assert_true(c.lower <= gap * fmax(contact_size(&body[0].shape), contact_size(&body[1].shape)) &&
                        c.upper >= c.lower);
            continue;
        }
        assert_int_equal(status, IMPACT_OK);
        near(c.gap, gap * fmax(contact_size(&body[0].shape), contact_size(&body[1].shape)),
             1e-13 * reach_of(&body[0], &body[1]));
        /* the witness points are that far apart, along the normal */
        const qvec3 v = qvec3_sub(qvec3_add(qvec3_sub(body[0].position, body[1].position), c.offset1), c.offset2);
        const double reach = reach_of(&body[0], &body[1]);
        near(qvec3_norm(qvec3_axpy(-c.gap, c.normal, v)), 0, sqrt(4e-14 * c.gap * reach) + 1e-14 * reach);
    }
}

static void swapping_rotating_shifting_and_scaling(void **state)
{
    (void)state;
    random_stream random = {2};
    for (int k = 0; k < 6000; k++) {
        impact_solid body[2], other[2];
        qvec3 normal;
        const int family = k % RANDOM_FAMILIES;
        random_pair(&random, family, random_log(&random, 1e-3, 3), body, &normal);
        impact_contact c, d;
        const double reach = reach_of(&body[0], &body[1]);
        if (impact_gap(&body[0], &body[1], NULL, &c) != IMPACT_OK) continue;
        assert_true(impact_gap(&body[1], &body[0], NULL, &d) == IMPACT_OK);
        const double open = c.upper - c.lower; /* at most 2e-14 of the reach, mostly 1e-16 */
        near(d.gap, c.gap, 2e-15 * reach + open + d.upper - d.lower);

        const quat turn = random_rotation(&random);
        const double scale = ldexp(1, (int)(random_unit(&random) * 200) - 100);
        for (int i = 0; i < 2; i++) {
            other[i] = body[i];
            other[i].position = quat_rotate(turn, body[i].position);
            quat_normalize(quat_mul(turn, body[i].orientation), &other[i].orientation);
        }
        assert_true(impact_gap(&other[0], &other[1], NULL, &d) == IMPACT_OK);
        near(d.gap, c.gap, 4e-15 * reach + open + d.upper - d.lower);
        for (int i = 0; i < 2; i++) {
            other[i] = body[i];
            other[i].position = qvec3_scale(body[i].position, scale);
            other[i].shape.a *= scale, other[i].shape.b *= scale, other[i].shape.c *= scale;
        }
        assert_true(impact_gap(&other[0], &other[1], NULL, &d) == IMPACT_OK);
        assert_true(d.gap == c.gap * scale); /* powers of two: to the bit */
    }
}

static void rate_is_the_derivative(void **state)
{
    (void)state;
    random_stream random = {3};
    for (int k = 0; k < 2000; k++) {
        impact_solid body[2];
        for (int i = 0; i < 2; i++) {
            body[i].shape = random_shape(&random, RANDOM_ELLIPSOID);
            body[i].position = (qvec3){0, 0, 0};
            body[i].orientation = random_rotation(&random);
        }
        body[0].position = qvec3_scale(random_direction(&random), 4);
        qvec3 v[2], w[2];
        for (int i = 0; i < 2; i++) {
            v[i] = random_direction(&random);
            w[i] = random_direction(&random);
        }
        const double h = 1e-4;
        double gaps[4];
        impact_contact c;
        for (int i = 0; i < 4; i++) {
            static const double offset[4] = {-2, -1, 1, 2};
            impact_solid moved[2];
            for (int j = 0; j < 2; j++) {
                moved[j] = body[j];
                moved[j].position = qvec3_axpy(offset[i] * h, v[j], body[j].position);
                moved[j].orientation =
                    quat_mul(quat_from_rotation_vector(qvec3_scale(w[j], offset[i] * h)), body[j].orientation);
            }
            impact_gap(&moved[0], &moved[1], NULL, &c);
            gaps[i] = c.gap;
        }
        assert_int_equal(impact_gap(&body[0], &body[1], NULL, &c), IMPACT_OK);
        near(impact_gap_rate(&c, v[0], w[0], v[1], w[1]), (gaps[0] - 8 * gaps[1] + 8 * gaps[2] - gaps[3]) / (12 * h),
             2e-9);
    }
}

/* The gap goes through zero without a step or a kink: its second difference stays at rounding plus curvature. */
static void smooth_through_zero(void **state)
{
    (void)state;
    random_stream random = {4};
    for (int k = 0; k < 200; k++) {
        impact_solid body[2];
        qvec3 normal;
        random_pair(&random, 1 + k % 4 == RANDOM_NEEDLE ? RANDOM_MIXED : 1 + k % 4, 0, body, &normal);
        const qvec3 touching = body[0].position;
        for (int i = -20; i <= 20; i++) {
            const double at = i * 1e-9;
            body[0].position = qvec3_axpy(at, normal, touching);
            impact_contact c;
            assert_int_equal(impact_gap(&body[0], &body[1], NULL, &c), IMPACT_OK);
            near(c.gap, at, 1.5e-15 * (1 + qvec3_norm(touching)));
        }
    }
}

/* ---- the cache ---- */

static void cache_helps_and_never_harms(void **state)
{
    (void)state;
    random_stream random = {5};
    for (int k = 0; k < 3000; k++) {
        impact_solid body[2];
        qvec3 normal;
        random_pair(&random, k % RANDOM_FAMILIES, 0.1, body, &normal);
        impact_contact cold, warm;
        if (impact_gap(&body[0], &body[1], NULL, &cold) != IMPACT_OK) continue;
        impact_gap_cache cache = {true, random_direction(&random)}; /* a useless one */
        assert_int_equal(impact_gap(&body[0], &body[1], &cache, &warm), IMPACT_OK);
        near(warm.gap, cold.gap, 1e-13 * reach_of(&body[0], &body[1]));
        assert_true(cache.valid);
        assert_int_equal(impact_gap(&body[0], &body[1], &cache, &warm), IMPACT_OK);
        near(warm.gap, cold.gap, 1e-13 * reach_of(&body[0], &body[1]));
        cache.normal = (qvec3){NAN, 0, 0};
        assert_int_equal(impact_gap(&body[0], &body[1], &cache, &warm), IMPACT_OK);
        near(warm.gap, cold.gap, 1e-13 * reach_of(&body[0], &body[1]));
    }
}

/* Flat bodies face each other with their far sides too, where g has a peak below 0 however far they are apart: a glance
 * from any normal, the worst among them, tells no overlap of bodies that have none. */
static void a_glance_tells_no_overlap_of_what_is_apart(void **state)
{
    (void)state;
    random_stream random = {22};
    int told = 0;
    for (int k = 0; k < 20000; k++) {
        impact_solid body[2];
        qvec3 normal;
        const double gap = random_log(&random, 1e-6, 1);
        random_pair(&random, k % RANDOM_FAMILIES, gap, body, &normal);
        impact_gap_cache cache = {true, k % 3 ? random_direction(&random) : qvec3_neg(normal)};
        impact_contact c;
        if (imp_gap_glance(&body[0], &body[1], &cache, &c) != IMPACT_OK) continue;
        told++;
        near(c.gap, gap * fmax(contact_size(&body[0].shape), contact_size(&body[1].shape)),
             1e-13 * reach_of(&body[0], &body[1]));
    }
    assert_true(told > 15000);
}

/* ---- closed forms ---- */

static void closed_forms(void **state)
{
    (void)state;
    const impact_solid small = ball(1, (qvec3){0, 0, 0}), far_one = ball(2, (qvec3){3, 4, 12});
    impact_contact c;
    assert_int_equal(impact_gap(&far_one, &small, NULL, &c), IMPACT_OK);
    assert_int_equal(c.path, IMPACT_PATH_CLOSED_FORM);
    near(c.gap, 10, 1e-15);
    near(c.normal.x, 3.0 / 13, 1e-16);
    impact_solid plane = {.position = {0, 0, 1}, .orientation = {1, 0, 0, 0}};
    assert_int_equal(impact_shape_plane(INFINITY, INFINITY, &plane.shape), IMPACT_OK);
    impact_solid box = superquadric(1, 1, 2, 100, 100, 100, (qvec3){5, 6, 4});
    expect_gap(&box, &plane, 1);
    assert_int_equal(impact_gap(&plane, &box, NULL, &c), IMPACT_OK);
    near(c.gap, 1, 1e-15);
    near(c.normal.z, -1, 1e-15);
    near(c.point2.z, 2, 1e-15);
    near(c.point1.z, 1, 1e-15);
    assert_int_equal(c.path, IMPACT_PATH_CLOSED_FORM);
    assert_int_equal(impact_gap(&plane, &plane, NULL, &c), IMPACT_EARGUMENT);
}

/* ---- the hard list ---- */

static void octahedra(void **state)
{
    (void)state;
    const impact_solid a = superquadric(1, 1, 1, 1, 1, 1, (qvec3){0, 0, 0});
    impact_solid b = superquadric(1, 1, 1, 1, 1, 1, (qvec3){0, 0, 3});
    expect_gap(&b, &a, 1); /* vertex to vertex */
    b.position.z = 2;
    expect_gap(&b, &a, 0);
    b.position = (qvec3){2, 2, 2}; /* parallel faces */
    expect_gap(&b, &a, 4 / sqrt(3));
    b.position = (qvec3){2.25, 2, 1.75};
    expect_gap(&b, &a, 4 / sqrt(3));
    b.position = (qvec3){1.5, 1.5, 0}; /* parallel edges */
    expect_gap(&b, &a, 0.5 * sqrt(2));
    quat_from_axis_angle((qvec3){0, 0, 1}, 0.3, &b.orientation);
    b.position = (qvec3){0.05, 0.02, 2.5}; /* vertex above vertex, turned */
    impact_contact c;
    assert_int_equal(impact_gap(&b, &a, NULL, &c), IMPACT_OK);
    near(c.gap, qvec3_norm((qvec3){0.05, 0.02, 0.5}), 1e-15);
    const impact_solid dot = ball(0.1, (qvec3){1, 1, 1}); /* a face's middle */
    expect_gap(&dot, &a, 2 / sqrt(3) - 0.1);
    const impact_solid edge = ball(0.1, (qvec3){1, 1, 0});
    expect_gap(&edge, &a, 1 / sqrt(2) - 0.1);
}

/* Exact octahedra are polytopes: the gap of two that overlap is the largest along a face's normal or across two edges.
 */
static double octahedra_gap(const impact_solid body[2])
{
    static const int sign[2] = {1, -1};
    qvec3 face[2][4], edge[2][6];
    double best = -INFINITY;
    for (int k = 0; k < 2; k++) {
        const double a[3] = {body[k].shape.a, body[k].shape.b, body[k].shape.c};
        for (int i = 0; i < 4; i++)
            face[k][i] = quat_rotate(body[k].orientation, (qvec3){1 / a[0], sign[i & 1] / a[1], sign[i >> 1] / a[2]});
        for (int i = 0; i < 6; i++) {
            double v[3] = {0, 0, 0};
            v[i % 3] = a[i % 3], v[(i + 1) % 3] = sign[i / 3] * a[(i + 1) % 3];
            edge[k][i] = quat_rotate(body[k].orientation, (qvec3){v[0], v[1], v[2]});
        }
    }
    for (int i = 0; i < 2 * 4 + 36; i++) {
        const int cross = i - 8;
        const qvec3 n = i < 8 ? face[i / 4][i % 4] : qvec3_cross(edge[0][cross / 6], edge[1][cross % 6]);
        for (int side = 0; side < 2; side++) {
            const qvec3 unit = qvec3_scale(n, sign[side] / qvec3_norm(n));
            const qvec3 d =
                qvec3_add(qvec3_sub(body[0].position, body[1].position),
                          qvec3_sub(contact_support(&body[0], qvec3_neg(unit)), contact_support(&body[1], unit)));
            best = fmax(best, qvec3_dot(unit, d));
        }
    }
    return best;
}

/* Shallow overlaps: all settled, by the same facets that are enumerated here in another order (deep: test_gap_deep). */
static void overlapping_octahedra(void **state)
{
    (void)state;
    random_stream random = {2024};
    int settled = 0, asked = 0;
    for (int k = 0; k < 1000; k++) {
        impact_solid body[2];
        for (int i = 0; i < 2; i++) {
            const double a = random_log(&random, 0.2, 1), b = random_log(&random, 0.2, 1),
                         c = random_log(&random, 0.2, 1);
            body[i] = superquadric(a, b, c, 1, 1, 1, (qvec3){0, 0, 0});
            body[i].orientation = random_rotation(&random);
        }
        const qvec3 towards = random_direction(&random);
        const double depth = random_log(&random, 1e-9, 1e-4);
        double low = 0, high = 3; /* low: deeper than wanted */
        for (int i = 0; i < 60; i++) {
            const double middle = 0.5 * (low + high);
            body[0].position = qvec3_scale(towards, middle);
            if (octahedra_gap(body) < -depth)
                low = middle;
            else
                high = middle;
        }
        const double wanted = octahedra_gap(body);
        impact_contact contact;
        const impact_status status = impact_gap(&body[0], &body[1], NULL, &contact);
        asked++;
        settled += status == IMPACT_OK;
        near(contact.gap, wanted, 2e-15);
    }
    assert_int_equal(settled, asked);
}

/* g along the unit n: no more than the gap. */
static double gap_along(const impact_solid body[2], qvec3 n)
{
    const qvec3 d = qvec3_add(qvec3_sub(body[0].position, body[1].position),
                              qvec3_sub(contact_support(&body[0], qvec3_neg(n)), contact_support(&body[1], n)));
    return qvec3_dot(n, d);
}

/* Where an overlap's answer is ok no other normal is a nearer way out, near it or far from it; of bodies with edges
 * too. */
static void no_nearer_way_out(void **state)
{
    (void)state;
    random_stream random = {77};
    int settled = 0, asked = 0;
    for (int k = 0; k < 600; k++) {
        const int family = k % 2 ? RANDOM_OCTAHEDRAL : (k / 2) % RANDOM_FAMILIES;
        impact_solid body[2];
        qvec3 normal;
        random_pair(&random, family, 0, body, &normal);
        const double thin = fmin(body[0].shape.a, fmin(body[0].shape.b, body[0].shape.c)),
                     depth = thin * random_log(&random, 1e-10, 1e-2);
        body[0].position = qvec3_axpy(-depth, normal, body[0].position);
        impact_contact c;
        const impact_status status = impact_gap(&body[0], &body[1], NULL, &c);
        asked++;
        if (status != IMPACT_OK) continue;
        settled++;
        const double reach = reach_of(&body[0], &body[1]);
        for (int i = 0; i < 400; i++) {
            qvec3 n = random_direction(&random);
            if (i % 2) n = qvec3_axpy(random_log(&random, 1e-7, 1), n, c.normal);
            n = qvec3_scale(n, 1 / qvec3_norm(n));
            if (!(gap_along(body, n) <= c.gap + 2e-14 * reach))
                fail_msg("%d: g = %g, the gap %g", k, gap_along(body, n), c.gap);
        }
    }
    if (settled < 0.8 * asked) fail_msg("%d of %d settled", settled, asked);
}

static void parallel_flat_faces(void **state)
{
    (void)state;
    for (double p = 10; p <= 1000; p *= 10) {
        const impact_solid a = superquadric(1, 1, 1, p, p, p, (qvec3){0, 0, 0});
        impact_solid b = superquadric(0.5, 0.7, 0.9, p, p, p, (qvec3){0, 0, 2.9});
        expect_gap(&b, &a, 1);
        b.position = (qvec3){0, 2.7, 0};
        expect_gap(&b, &a, 1);
        impact_contact c;
        b.position = (qvec3){0.2, 0.1, 2.9}; /* off centre: the highest point moves by less than 1e-5 */
        assert_int_equal(impact_gap(&b, &a, NULL, &c), IMPACT_OK);
        assert_true(c.gap >= 1 - 1e-15 && c.gap < 1 + 1e-4);
    }
}

static void steep_exponents(void **state)
{
    (void)state;
    impact_solid a = superquadric(1, 1, 1, 1000, 1000, 1000, (qvec3){0, 0, 0}),
                 b = superquadric(1, 1, 1, 1000, 1000, 1000, (qvec3){0, 0, 4});
    quat_from_axis_angle((qvec3){1, 1, 0}, 0.6, &b.orientation);
    impact_contact c;
    assert_int_equal(impact_gap(&b, &a, NULL, &c), IMPACT_OK);
    assert_true(c.upper - c.lower <= 1e-13 && c.gap > 1.2 && c.gap < 2);
}

static void concentric_and_deep(void **state)
{
    (void)state;
    const impact_solid a = superquadric(1, 2, 3, 2, 2, 2, (qvec3){0, 0, 0}),
                       b = superquadric(0.5, 0.5, 0.5, 2, 2, 2, (qvec3){0, 0, 0});
    impact_contact c;
    assert_int_equal(impact_gap(&b, &a, NULL, &c), IMPACT_OK); /* two ways out, equally near: each is the nearest */
    near(c.gap, -1.5, 1e-14);                                  /* along the shortest axis */
    near(fabs(c.normal.x), 1, 1e-14);
    const impact_solid same = ball(1, (qvec3){0, 0, 0});
    assert_int_equal(impact_gap(&same, &same, NULL, &c), IMPACT_DEEP);
    near(c.gap, -2, 0);
    const impact_solid deep = superquadric(1, 1, 1, 4, 4, 4, (qvec3){0.1, 0.2, 1.2}),
                       block = superquadric(1, 1, 1, 4, 4, 4, (qvec3){0, 0, 0});
    assert_int_equal(impact_gap(&deep, &block, NULL, &c), IMPACT_OK);
    assert_true(c.gap < -0.75 && c.gap > -0.85 && c.normal.z > 0.9);
}

static void needles_and_discs(void **state)
{
    (void)state;
    const impact_solid needle = superquadric(1e-6, 1e-6, 1, 2, 2, 2, (qvec3){0, 0, 0}),
                       disc = superquadric(1, 1, 1e-6, 2, 2, 2, (qvec3){0, 0, 2});
    expect_gap(&disc, &needle, 1 - 1e-6);
    impact_solid beside = superquadric(1e-6, 1e-6, 1, 2, 2, 2, (qvec3){3e-6, 0, 0});
    expect_gap(&beside, &needle, 1e-6);
    impact_solid tilted = superquadric(1, 1, 1e-3, 2, 2, 2, (qvec3){0, 0, 1}); /* discs tilted by 2e-9 rad */
    const impact_solid flat = superquadric(1, 1, 1e-3, 2, 2, 2, (qvec3){0, 0, 0});
    quat_from_axis_angle((qvec3){1, 0, 0}, 2e-9, &tilted.orientation);
    impact_contact c;
    assert_int_equal(impact_gap(&tilted, &flat, NULL, &c), IMPACT_OK);
    near(c.gap, 1 - 2e-3, 1e-14); /* the tilt's effect is quadratic: 1e-3 (1e-9 1e3)^2/2 */
}

static void far_apart_and_far_away(void **state)
{
    (void)state;
    impact_solid a = superquadric(1, 2, 3, 3, 2, 4, (qvec3){0, 0, 0}),
                 b = superquadric(1, 1, 1, 2, 2, 2, (qvec3){1e8, 0, 0});
    expect_gap(&b, &a, 1e8 - 2);
    a.position = (qvec3){1e8, -1e8, 1e8};
    b.position = (qvec3){1e8 + 3, -1e8, 1e8};
    expect_gap(&b, &a, 1);
    impact_contact c;
    impact_gap(&b, &a, NULL, &c);
    near(c.offset2.x, 1, 1e-15);
}

static void tiny_and_huge(void **state)
{
    (void)state;
    static const double scales[] = {1e-9, 1e-150, 1e150};
    for (int i = 0; i < 3; i++) {
        const double s = scales[i];
        const impact_solid a = superquadric(s, 2 * s, 3 * s, 3, 2, 4, (qvec3){0, 0, 0}),
                           b = superquadric(s, s, s, 2, 1.5, 9, (qvec3){4 * s, 0, 0});
        expect_gap(&b, &a, 2 * s);
    }
}

/* ---- bad input ---- */

static void refusals(void **state)
{
    (void)state;
    const impact_solid good = superquadric(1, 2, 3, 3, 2, 4, (qvec3){0, 0, 0});
    impact_solid bad = superquadric(1, 1, 1, 2, 2, 2, (qvec3){NAN, 0, 5});
    impact_contact c;
    assert_int_equal(impact_gap(&bad, &good, NULL, &c), IMPACT_EDOMAIN);
    assert_true(isnan(c.gap) && isnan(c.point1.x) && isnan(c.lower));
    bad.position.x = INFINITY;
    assert_int_equal(impact_gap(&good, &bad, NULL, &c), IMPACT_EDOMAIN);
    bad.position.x = 0;
    bad.orientation = (quat){0, 0, 0, 0};
    assert_int_equal(impact_gap(&bad, &good, NULL, &c), IMPACT_EDOMAIN);
    bad.orientation = (quat){NAN, 0, 0, 0};
    assert_int_equal(impact_gap(&bad, &good, NULL, &c), IMPACT_EDOMAIN);
    bad.orientation = (quat){-7, 0, 0, 0}; /* normalised */
    expect_gap(&bad, &good, 1);
    bad.shape.r = 0.5;
    assert_int_equal(impact_gap(&bad, &good, NULL, &c), IMPACT_EARGUMENT);
    bad.shape.r = 2;
    bad.shape.b = 0;
    assert_int_equal(impact_gap(&bad, &good, NULL, &c), IMPACT_EARGUMENT);
}

/* ---- no allocation ---- */

static void newton_and_closed_forms_allocate_nothing(void **state)
{
    (void)state;
    random_stream random = {6};
    long counted = 0;
    for (int k = 0; k < 5000; k++) {
        impact_solid body[2];
        qvec3 normal;
        random_pair(&random, k % RANDOM_FAMILIES, 0.2, body, &normal);
        impact_contact c;
        const long before = allocations;
        impact_gap(&body[0], &body[1], NULL, &c);
        if (c.path == IMPACT_PATH_GJK || c.path == IMPACT_PATH_FALLBACK) continue;
        assert_int_equal(allocations - before, 0);
        counted++;
    }
    assert_true(counted > 3000);
    void *volatile block = malloc(1);
    free(block);
    assert_true(allocations > 0); /* the count works */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_oracle),
        cmocka_unit_test(normal_points_from_body_2_to_body_1),
        cmocka_unit_test(stiffness_of_known_contacts),
        cmocka_unit_test(truth_by_construction),
        cmocka_unit_test(swapping_rotating_shifting_and_scaling),
        cmocka_unit_test(rate_is_the_derivative),
        cmocka_unit_test(smooth_through_zero),
        cmocka_unit_test(cache_helps_and_never_harms),
        cmocka_unit_test(a_glance_tells_no_overlap_of_what_is_apart),
        cmocka_unit_test(closed_forms),
        cmocka_unit_test(octahedra),
        cmocka_unit_test(overlapping_octahedra),
        cmocka_unit_test(no_nearer_way_out),
        cmocka_unit_test(parallel_flat_faces),
        cmocka_unit_test(steep_exponents),
        cmocka_unit_test(concentric_and_deep),
        cmocka_unit_test(needles_and_discs),
        cmocka_unit_test(far_apart_and_far_away),
        cmocka_unit_test(tiny_and_huge),
        cmocka_unit_test(refusals),
        cmocka_unit_test(newton_and_closed_forms_allocate_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
