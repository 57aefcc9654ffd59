/* SPDX-License-Identifier: MIT */
#include "oracle.h"

static const double inf = INFINITY;

/* ---- conventions and hand-checkable values ---- */

static void units_multiply_as_hamilton_wrote(void **state)
{
    (void)state;
    const quat i = {0, 1, 0, 0}, j = {0, 0, 1, 0}, k = {0, 0, 0, 1}, minus_one = {-1, 0, 0, 0};
    assert_true(quat_equal(quat_mul(i, j), k) && quat_equal(quat_mul(j, k), i) && quat_equal(quat_mul(k, i), j));
    assert_true(quat_equal(quat_mul(i, i), minus_one) && quat_equal(quat_mul(j, j), minus_one));
    assert_true(quat_equal(quat_mul(k, k), minus_one) && quat_equal(quat_mul(quat_mul(i, j), k), minus_one));
    /* (1 + 2i + 3j + 4k)(5 + 6i + 7j + 8k) = -60 + 12i + 30j + 24k, by hand */
    assert_true(quat_equal(quat_mul(quat_make(1, 2, 3, 4), quat_make(5, 6, 7, 8)), quat_make(-60, 12, 30, 24)));
    assert_true(quat_equal(quat_mul(quat_make(5, 6, 7, 8), quat_make(1, 2, 3, 4)), quat_make(-60, 20, 14, 32)));
}

static void algebra_keeps_its_identities(void **state)
{
    (void)state;
    random_state r = {1};
    double norm = 0, associate = 0, conjugate = 0, inverse = 0, quotient = 0;
    for (int n = 0; n < 100000; n++) {
        const quat p = random_any(&r), q = random_any(&r), s = random_any(&r);
        const double size = quat_norm(p) * quat_norm(q);
        if (size == 0 || quat_norm(s) == 0) continue;
        worse(&norm, fabs(quat_norm(quat_mul(p, q)) - size) / size / ROUNDING);
        worse(&associate, quat_norm(quat_sub(quat_mul(quat_mul(p, q), s), quat_mul(p, quat_mul(q, s)))) /
                              (size * quat_norm(s)) / ROUNDING);
        assert_true(quat_equal(quat_conj(quat_mul(p, q)), quat_mul(quat_conj(q), quat_conj(p))) ||
                    quat_norm(quat_sub(quat_conj(quat_mul(p, q)), quat_mul(quat_conj(q), quat_conj(p)))) <=
                        4 * ROUNDING * size);
        quat inv, d;
        assert_int_equal(quat_inverse(q, &inv), QUAT_OK);
        worse(&inverse, error_of(inv, wide_inverse(wide_quat(q))));
        assert_int_equal(quat_div(p, q, &d), QUAT_OK);
        worse(&quotient, error_of(d, wide_mul(wide_quat(p), wide_inverse(wide_quat(q)))));
        assert_int_equal(quat_div_left(q, p, &d), QUAT_OK);
        worse(&quotient, error_of(d, wide_mul(wide_inverse(wide_quat(q)), wide_quat(p))));
        worse(&conjugate, fabs(quat_mul(q, quat_conj(q)).w - quat_norm2(q)) / quat_norm2(q) / ROUNDING);
    }
    assert_bound("|pq| = |p||q|", norm, 8);
    assert_bound("(pq)s = p(qs)", associate, 6);
    assert_bound("q q* = |q|^2", conjugate, 4);
    assert_bound("inverse error, u", inverse, 4);
    assert_bound("quotient error, u", quotient, 6);
}

/* ---- the product ---- */

/* The product as it is usually written: four terms, left to right. */
static quat left_to_right(quat p, quat q)
{
    return quat_make(p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
                     p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x, p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w);
}

static double pair(double a, double b, double c, double d) { return (a + b) + (c + d); }

/* What quat_mul promises to the bit, on every machine: the pairs of its comment, written out. */
static quat in_pairs(quat p, quat q)
{
    return quat_make(
        pair(p.w * q.w, -(p.x * q.x), -(p.y * q.y), -(p.z * q.z)), pair(p.w * q.x, p.x * q.w, p.y * q.z, -(p.z * q.y)),
        pair(p.w * q.y, -(p.x * q.z), p.y * q.w, p.z * q.x), pair(p.w * q.z, p.x * q.y, p.z * q.w, -(p.y * q.x)));
}

static void product_is_within_its_bar(void **state)
{
    (void)state;
    random_state r = {2};
    double unit = 0, any = 0, peers = 0;
    for (int n = 0; n < 1000000; n++) {
        const quat p = random_unit(&r);
        quat q = random_unit(&r);
        /* near the conjugate one component has nearly all the length, and all the errors */
        if (n % 4 == 0) q = quat_unit(quat_axpy(0.1, q, quat_conj(p)));
        const wquat want = wide_mul(wide_quat(p), wide_quat(q));
        worse(&unit, error_of(quat_mul(p, q), want));
        worse(&peers, error_of(left_to_right(p, q), want));
        if (n % 4) continue;
        const quat a = random_any(&r), b = random_any(&r), ab = quat_mul(a, b), pairs = in_pairs(a, b);
        worse(&any, error_of(ab, wide_mul(wide_quat(a), wide_quat(b))));
        assert_memory_equal(&ab, &pairs, sizeof ab);
    }
    assert_bound("product of units over the plain formula's, u", unit, peers);
    /* the products together 1 u, their pairs 3/4 u, the sum 1/2 u as long as it stays below 1 */
    assert_bound("product of 1e6 units, u", unit, 2.25);
    /* the proven bound: a product and two sums, each rounded once */
    assert_bound("product of any, u", any, 3);
}

static void compensated_product_keeps_small_parts(void **state)
{
    (void)state;
    random_state r = {3};
    double vector = 0, whole = 0;
    for (int n = 0; n < 100000; n++) {
        /* p p^-1 with the inverse rounded: the vector part is all rounding, and must be right to its last bit */
        const quat p = random_quat(&r, random_scale(&r, -10, 10));
        quat inverse;
        quat_inverse(p, &inverse);
        wquat want = wide_mul(wide_quat(p), wide_quat(inverse));
        const quat got = quat_mul_compensated(p, inverse);
        worse(&whole, error_of(got, want));
        want.w = 0;
        if (wide_norm(want) > 0) worse(&vector, error_of_vector(quat_vector(got), want));
    }
    assert_bound("compensated product, u", whole, 1);
    assert_bound("its vector part of p/p, u", vector, 1);
}

/* ---- lengths ---- */

static void normalise_is_right_at_every_scale(void **state)
{
    (void)state;
    random_state r = {4};
    double worst = 0, norm = 0, quick = 0;
    for (int n = 0; n < 300000; n++) {
        const double size = n % 3 ? random_scale(&r, -310, 308) : 1;
        const quat q = quat_scale(random_any(&r), size);
        quat unit;
        if (quat_equal(q, quat_make(0, 0, 0, 0))) continue;
        assert_int_equal(quat_normalize(q, &unit), QUAT_OK);
        worse(&worst, error_of(unit, wide_unit(wide_quat(q))));
        if (quat_norm2(q) > 1e-280 && quat_norm2(q) < 1e280)
            worse(&quick, error_of(quat_unit(q), wide_unit(wide_quat(q))));
        if (quat_norm(q) > 1e-300) worse(&norm, error_of_scalar(quat_norm(q), wide_norm(wide_quat(q))));
    }
    assert_bound("normalise error, u", worst, 1.01);
    assert_bound("quick normalise error, u", quick, 3.5);
    assert_bound("norm error, u", norm, 2.5);
    const double edges[] = {4.9406564584124654e-324, 1e-310, 2.2250738585072014e-308, 1e-160, 1e160,
                            1.7976931348623157e308};
    for (size_t i = 0; i < sizeof edges / sizeof *edges; i++) {
        const double e = edges[i];
        quat unit;
        assert_int_equal(quat_normalize(quat_make(e, -e, e, -e), &unit), QUAT_OK);
        assert_true(quat_equal(unit, quat_make(0.5, -0.5, 0.5, -0.5)));
        assert_int_equal(quat_normalize(quat_make(0, 0, -e, 0), &unit), QUAT_OK);
        assert_true(quat_equal(unit, quat_make(0, 0, -1, 0)));
    }
    assert_true(fabs(quat_norm(quat_make(3e200, 0, 4e200, 0)) / 5e200 - 1) < 4e-16);
    assert_true(quat_norm(quat_make(0, 0, 0, 0)) == 0);
    assert_true(isinf(quat_norm(quat_make(NAN, inf, 0, 0))) && isnan(quat_norm(quat_make(NAN, 1, 0, 0))));
}

static void bad_input_is_named(void **state)
{
    (void)state;
    const quat bad[] = {{0, 0, 0, 0}, {NAN, 1, 0, 0}, {1, inf, 0, 0}, {0, 0, -inf, NAN}};
    quat q;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(quat_normalize(bad[i], &q), QUAT_EDOMAIN);
        assert_true(quat_equal(q, quat_identity()));
        assert_int_equal(quat_inverse(bad[i], &q), QUAT_EDOMAIN);
        assert_true(quat_equal(q, quat_identity()));
        assert_int_equal(quat_div(quat_identity(), bad[i], &q), QUAT_EDOMAIN);
        assert_true(quat_equal(q, quat_identity()));
    }
    assert_int_equal(quat_div(bad[1], quat_identity(), &q), QUAT_EDOMAIN);
    assert_int_equal(quat_inverse(quat_make(1e-310, 0, 0, 0), &q), QUAT_ERANGE);
    assert_int_equal(quat_div(quat_make(1e-310, 0, 0, 0), quat_make(0, 1e-310, 0, 0), &q), QUAT_OK);
    assert_true(quat_near(q, quat_make(0, -1, 0, 0), 1e-15));
    qvec3 v;
    assert_int_equal(qvec3_normalize(qvec3_make(0, 0, 0), &v), QUAT_EDOMAIN);
    assert_int_equal(qvec3_normalize(qvec3_make(0, 1e-320, 0), &v), QUAT_OK);
    assert_true(v.y == 1);
    for (int s = QUAT_ERANGE; s <= QUAT_AT_INFINITY; s++)
        if (s <= QUAT_OK || s >= QUAT_NOT_UNIQUE)
            assert_string_not_equal(quat_status_string((quat_status)s), "unknown status");
    assert_string_equal(quat_status_string((quat_status)-99), "unknown status");
}

static void drift_is_held(void **state)
{
    (void)state;
    random_state r = {5};
    quat chain = quat_identity(), free_chain = chain;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_unit(&r);
        chain = quat_renormalize(quat_mul(chain, q));
        free_chain = quat_mul(free_chain, q);
        assert_true(fabs(quat_norm(chain) - 1) < 4 * ROUNDING);
    }
    assert_true(fabs(quat_norm(free_chain) - 1) > 4 * ROUNDING);
}

/* ---- distances ---- */

static void distances_are_right_for_every_angle(void **state)
{
    (void)state;
    random_state r = {6};
    double sphere = 0, rotation = 0, angle = 0;
    for (int n = 0; n < 100000; n++) {
        const quat p = random_unit(&r);
        const double a = n % 2 ? random_between(&r, 0, 3.14159265358979) : random_scale(&r, -12, 0.49);
        const qvec3 d = random_direction(&r);
        const quat q = quat_mul(p, quat_make(cos(a), sin(a) * d.x, sin(a) * d.y, sin(a) * d.z));
        const wquat wp = wide_unit(wide_quat(p)), wq = wide_unit(wide_quat(q));
        const wide s = 2 * atan2f128(wide_norm(wide_sub(wp, wq)), wide_norm(wide_add(wp, wq)));
        const wide pi = 2 * atan2f128(1, 0), t = 2 * (s < pi / 2 ? s : pi - s);
        worse(&sphere, (double)fabsf128(quat_distance(p, q) - s));
        worse(&rotation, (double)fabsf128(quat_rotation_distance(p, q) - t));
        assert_true(quat_rotation_distance(p, q) == quat_rotation_distance(p, quat_neg(q)));
        assert_true(quat_distance(p, q) == quat_distance(q, p));
        const double scale = random_scale(&r, -150, 150);
        const quat o = quat_scale(quat_make(cos(a), sin(a) * d.x, sin(a) * d.y, sin(a) * d.z), scale);
        worse(&angle, error_of_scalar(quat_angle(o), 2 * atan2f128(wide_vnorm(wide_quat(o)), fabsf128((wide)o.w))));
    }
    assert_bound("distance in S3, rad", sphere, 1e-15);
    assert_bound("distance of rotations, rad", rotation, 2e-15);
    assert_bound("angle, u", angle, 4);
    const quat q = {0.5, 0.5, 0.5, 0.5};
    assert_true(quat_distance(q, q) == 0 && quat_distance(q, quat_neg(q)) == 2 * atan2(1, 0));
    assert_true(quat_rotation_distance(q, quat_neg(q)) == 0);
    assert_true(quat_same_rotation(q, quat_neg(q), 0) && !quat_near(q, quat_neg(q), 1.9) && quat_near(q, q, 0));
    assert_true(quat_equal(quat_nearest(quat_neg(q), q), q) && quat_equal(quat_nearest(q, q), q));
    assert_true(isnan(quat_distance(quat_make(NAN, 0, 0, 0), q)) &&
                isnan(quat_rotation_distance(q, quat_make(NAN, 0, 0, 0))));
    assert_false(quat_same_rotation(q, quat_make(NAN, 0, 0, 0), 10));
    assert_true(quat_angle(quat_make(0, 0, 0, 0)) == 0 && quat_angle(quat_make(-2, 0, 0, 0)) == 0);
    /* |v| is no double, or not with all digits, but the angle of (1, 1, 1, 1) is 2 pi/3 and of (1, 3, 4, 0) 2 atan 5 */
    const double end[2] = {0x1p1021, 0x1p-1074};
    for (int n = 0; n < 2; n++) {
        assert_true(fabs(quat_angle(quat_make(end[n], end[n], -end[n], end[n])) - 4 * atan2(1, 0) / 3) < 1e-15);
        assert_true(fabs(quat_angle(quat_make(end[n], 3 * end[n], 4 * end[n], 0)) - 2 * atan(5)) < 1e-15);
    }
    assert_true(fabs(quat_angle(quat_make(1.7e308, 1.7e308, 1.7e308, 1.7e308)) - 4 * atan2(1, 0) / 3) < 1e-15);
    assert_true(isnan(quat_angle(quat_make(1, NAN, 0, 0))) &&
                quat_angle(quat_make(1, INFINITY, 0, 0)) == 2 * atan2(1, 0));
}

/* ---- random rotations ---- */

static void random_rotations_are_uniform(void **state)
{
    (void)state;
    random_state r = {7};
    enum { count = 200000 };
    double mean[4] = {0}, second[4][4] = {{0}};
    int small = 0;
    for (int n = 0; n < count; n++) {
        const quat q = random_unit(&r);
        const double c[4] = {q.w, q.x, q.y, q.z};
        assert_true(fabs(quat_norm(q) - 1) < 4 * ROUNDING);
        for (int i = 0; i < 4; i++) {
            mean[i] += c[i] / count;
            for (int j = 0; j < 4; j++) second[i][j] += c[i] * c[j] / count;
        }
        small += quat_angle(q) < 1;
    }
    /* five standard deviations: var c = 1/4, var c^2 = 1/16, var c_i c_j = 1/24 */
    for (int i = 0; i < 4; i++) {
        assert_true(fabs(mean[i]) < 5 * sqrt(0.25 / count));
        for (int j = 0; j < 4; j++) assert_true(fabs(second[i][j] - (i == j) * 0.25) < 5 * sqrt(1.0 / 16 / count));
    }
    /* P(angle < a) = (a - sin a)/pi */
    const double p = (1 - sin(1)) / 3.14159265358979;
    assert_true(fabs((double)small / count - p) < 5 * sqrt(p / count));
}

static void matrices_multiply(void **state)
{
    (void)state;
    const qmat3 a = {{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}}, t = qmat3_transpose(&a), p = qmat3_mul(&a, &t),
                one = qmat3_identity();
    assert_true(p.m[0][0] == 14 && p.m[0][1] == 32 && p.m[1][2] == 128 && p.m[2][2] == 213);
    assert_true(qmat3_det(&a) == -3 && qmat3_det(&one) == 1);
    const qvec3 v = qmat3_apply(&a, qvec3_make(1, 0, -1));
    assert_true(v.x == -2 && v.y == -2 && v.z == -3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_multiply_as_hamilton_wrote),
        cmocka_unit_test(algebra_keeps_its_identities),
        cmocka_unit_test(product_is_within_its_bar),
        cmocka_unit_test(compensated_product_keeps_small_parts),
        cmocka_unit_test(normalise_is_right_at_every_scale),
        cmocka_unit_test(bad_input_is_named),
        cmocka_unit_test(drift_is_held),
        cmocka_unit_test(distances_are_right_for_every_angle),
        cmocka_unit_test(random_rotations_are_uniform),
        cmocka_unit_test(matrices_multiply),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
