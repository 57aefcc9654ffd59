/* SPDX-License-Identifier: MIT */
#include "oracle.h"
#include <quat/average.h>
#include <quat/exponential.h>
#include <quat/rotation.h>

enum { most = 40 };

/* Between `least` and `most`: many in one round of thirty, a few in the others. */
static size_t some(random_state *r, int round, size_t least)
{
    const size_t limit = round % 30 ? least + 4 : most;
    return least + (size_t)(random_uniform(r) * (double)(limit - least));
}

/* Rotations within `spread` of c, with random signs and weights. */
static void cloud(random_state *r, size_t n, quat c, double spread, quat q[], double w[])
{
    for (size_t i = 0; i < n; i++) {
        quat_normalize(quat_mul(c, quat_exp_pure(random_vector(r, 0.5 * spread * random_uniform(r)))), &q[i]);
        if (random_uniform(r) < 0.5) q[i] = quat_neg(q[i]);
        w[i] = random_between(r, 0.1, 2);
    }
}

/* sum w (q.q_i)^2, which the Markley mean makes largest. */
static wide markley(size_t n, const quat q[], const double w[], quat m)
{
    wide sum = 0;
    for (size_t i = 0; i < n; i++) {
        const wide d = wide_dot(wide_quat(q[i]), wide_unit(wide_quat(m)));
        sum += w[i] * d * d;
    }
    return sum;
}

static void markley_mean_is_the_best(void **state)
{
    (void)state;
    random_state r = {71};
    double stationary = 0;
    for (int round = 0; round < 100000; round++) {
        quat q[most], m;
        double w[most];
        const size_t n = some(&r, round, 1);
        const double spread = random_scale(&r, -6, 0.4);
        cloud(&r, n, random_unit(&r), spread, q, w);
        assert_true(quat_mean(n, q, w, &m) == QUAT_OK);
        assert_true(m.w >= 0);
        const wide best = markley(n, q, w, m);
        for (int k = 0; k < (round % 30 ? 1 : 6); k++) {
            quat other;
            quat_normalize(quat_mul(m, quat_exp_pure(random_vector(&r, random_scale(&r, -7, 0)))), &other);
            assert_true(markley(n, q, w, other) <= best * (1 + 1e-15));
        }
        /* gradient on the sphere: sum w (q.q_i) q_i is along q */
        wquat g = {0, 0, 0, 0};
        double total = 0;
        for (size_t i = 0; i < n; i++) {
            g = wide_add(g, wide_scale(wide_quat(q[i]), w[i] * wide_dot(wide_quat(q[i]), wide_quat(m))));
            total += w[i];
        }
        const wquat u = wide_unit(wide_quat(m));
        worse(&stationary, (double)wide_norm(wide_sub(g, wide_scale(u, wide_dot(g, u)))) / total);
        /* turning everything turns the mean; the weights' scale does not matter */
        quat turned[most], mt;
        double heavier[most];
        const quat s = random_unit(&r);
        for (size_t i = 0; i < n; i++) turned[i] = quat_mul(s, q[i]), heavier[i] = 1e200 * w[i];
        assert_true(quat_mean(n, turned, heavier, &mt) == QUAT_OK);
        assert_true(quat_same_rotation(mt, quat_mul(s, m), 1e-13));
    }
    assert_bound("Markley mean stationary", stationary, 1e-15);
}

static void karcher_mean_balances(void **state)
{
    (void)state;
    random_state r = {72};
    double balance = 0, middle = 0;
    for (int round = 0; round < 100000; round++) {
        quat q[most], m;
        double w[most], spread;
        const size_t n = some(&r, round, 1);
        const double reach = random_scale(&r, -8, 0.19);
        cloud(&r, n, random_unit(&r), reach, q, w);
        assert_int_equal(quat_mean_karcher(n, q, w, &m, &spread), QUAT_OK);
        wquat sum = {0, 0, 0, 0};
        wide square = 0;
        double total = 0;
        for (size_t i = 0; i < n; i++) {
            wquat l =
                wide_log(wide_mul(wide_conj(wide_unit(wide_quat(m))), wide_unit(wide_quat(quat_nearest(q[i], m)))));
            l.w = 0;
            sum = wide_add(sum, wide_scale(l, w[i]));
            square += w[i] * wide_dot(l, l);
            total += w[i];
        }
        worse(&balance, (double)wide_norm(sum) / total);
        assert_true(fabs(spread - 2 * sqrt((double)square / total)) < 1e-14);
        /* of two, the middle of the great circle */
        const quat a = random_unit(&r), b = quat_mul(a, quat_exp_pure(random_vector(&r, random_between(&r, 0, 0.7))));
        const quat two[2] = {a, quat_neg(b)}, half = quat_mul(a, quat_pow_unit(quat_mul(quat_conj(a), b), 0.5));
        assert_int_equal(quat_mean_karcher(2, two, NULL, &m, NULL), QUAT_OK);
        worse(&middle, quat_rotation_distance(m, half));
    }
    assert_bound("Karcher mean: sum of logarithms", balance, 2e-15);
    assert_bound("Karcher mean of two, rad", middle, 4e-15);
}

static void alignment_finds_the_rotation(void **state)
{
    (void)state;
    random_state r = {73};
    double exact = 0, exact_residual = 0, symmetric = 0, moved = 0;
    for (int round = 0; round < 100000; round++) {
        qvec3 a[most], b[most], c[most];
        double w[most], residual;
        const size_t n = some(&r, round, 3);
        const quat q = random_unit(&r);
        const qvec3 shift = random_vector(&r, random_scale(&r, -2, 3));
        const double size = random_scale(&r, -140, 140), noise = random_scale(&r, -6, -0.5);
        for (size_t i = 0; i < n; i++) {
            a[i] = random_direction(&r);
            b[i] = quat_rotate(q, a[i]);
            w[i] = random_between(&r, 0.1, 1);
            c[i] = qvec3_add(shift, b[i]);
        }
        /* nearly parallel vectors, and points nearly in line, tell less of the turn about themselves */
        double width = 0, flat = 0;
        for (size_t i = 1; i < n; i++) {
            width = fmax(width, qvec3_norm(qvec3_cross(a[0], a[i])));
            flat = fmax(flat, qvec3_norm(qvec3_cross(qvec3_sub(a[1], a[0]), qvec3_sub(a[i], a[0]))));
        }
        width *= width, flat = fmin(1, flat * flat);
        quat found;
        qvec3 found_shift;
        assert_int_equal(quat_align(n, a, b, w, &found, &residual), QUAT_OK);
        worse(&exact, quat_rotation_distance(found, q) * width);
        worse(&exact_residual, residual);
        assert_int_equal(quat_align_points(n, a, c, w, &found, &found_shift, &residual), QUAT_OK);
        worse(&moved, quat_rotation_distance(found, q) * flat / (1 + qvec3_norm(shift)));
        worse(&moved, qvec3_norm(qvec3_sub(found_shift, shift)) * flat / (1 + qvec3_norm(shift)));
        /* noisy, and of any size: R^T sum w b a^T must be symmetric */
        for (size_t i = 0; i < n; i++) {
            b[i] = qvec3_axpy(noise, random_direction(&r), b[i]);
            a[i] = qvec3_scale(a[i], size);
        }
        assert_int_equal(quat_align(n, a, b, w, &found, NULL), QUAT_OK);
        double m[3][3] = {{0}};
        for (size_t i = 0; i < n; i++) {
            const qvec3 back = quat_rotate_inverse(found, b[i]);
            const double x[3] = {back.x, back.y, back.z}, y[3] = {a[i].x / size, a[i].y / size, a[i].z / size};
            for (int j = 0; j < 3; j++)
                for (int k = 0; k < 3; k++) m[j][k] += w[i] * x[j] * y[k] / (double)n;
        }
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < j; k++) worse(&symmetric, fabs(m[j][k] - m[k][j]));
    }
    assert_bound("alignment of exact sets, rad times width^2", exact, 2e-14);
    assert_bound("their residual", exact_residual, 1e-14);
    assert_bound("alignment of shifted points, likewise, over 1 + shift", moved, 1e-13);
    assert_bound("R^T sum b a^T symmetric", symmetric, 3e-15);
}

static void what_is_not_unique_is_said(void **state)
{
    (void)state;
    quat m;
    double residual;
    const quat opposite[2] = {{1, 0, 0, 0}, {0, 1, 0, 0}};
    assert_int_equal(quat_mean(2, opposite, NULL, &m), QUAT_NOT_UNIQUE);
    const qvec3 line[2] = {{1, 0, 0}, {-2, 0, 0}}, plane[2] = {{1, 0, 0}, {0, 1, 0}},
                turned[2] = {{0, 1, 0}, {-1, 0, 0}};
    assert_int_equal(quat_align(2, line, line, NULL, &m, &residual), QUAT_NOT_UNIQUE);
    assert_true(residual < 1e-15);
    assert_int_equal(quat_align(2, plane, turned, NULL, &m, &residual), QUAT_OK); /* two directions are enough */
    assert_true(quat_same_rotation(m, quat_make(sqrt(0.5), 0, 0, sqrt(0.5)), 1e-15) && residual < 1e-15);
    /* a mirrored tripod: no rotation is better than another of a whole family */
    const qvec3 tripod[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, mirrored[3] = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    assert_int_equal(quat_align(3, tripod, mirrored, NULL, &m, &residual), QUAT_NOT_UNIQUE);
    const qvec3 point[2] = {{3, 3, 3}, {3, 3, 3}};
    qvec3 shift;
    assert_int_equal(quat_align_points(2, point, plane, NULL, &m, &shift, &residual), QUAT_NOT_UNIQUE);
    assert_true(quat_equal(m, quat_identity()) && fabs(shift.x + 2.5) < 1e-15 && fabs(shift.z + 3) < 1e-15);
}

static void bad_input_is_named(void **state)
{
    (void)state;
    quat m;
    double residual;
    qvec3 shift;
    const quat q[2] = {{1, 0, 0, 0}, {NAN, 0, 0, 0}};
    const qvec3 v[2] = {{1, 0, 0}, {0, INFINITY, 0}}, zero[2] = {{0, 0, 0}, {0, 0, 0}};
    const double negative[2] = {1, -1}, none[2] = {0, 0}, nan[2] = {NAN, 1};
    assert_int_equal(quat_mean(0, q, NULL, &m), QUAT_EARGUMENT);
    assert_int_equal(quat_mean(2, q, NULL, &m), QUAT_EDOMAIN);
    assert_int_equal(quat_mean(1, q, negative + 1, &m), QUAT_EDOMAIN);
    assert_int_equal(quat_mean(1, q, none, &m), QUAT_EDOMAIN);
    const quat long_and_short[2] = {{1e-200, 0, 0, 0}, {0.8e200, 0.6e200, 0, 0}}, nothing = {0, 0, 0, 0};
    assert_int_equal(quat_mean(1, &nothing, NULL, &m), QUAT_EDOMAIN);
    assert_int_equal(quat_mean_karcher(2, long_and_short, NULL, &m, &residual), QUAT_OK); /* lengths do not count */
    assert_true(fabs(quat_angle(m) - acos(0.8)) < 1e-15 && fabs(residual - acos(0.8)) < 1e-15);
    assert_int_equal(quat_mean_karcher(1, q, nan, &m, &residual), QUAT_EDOMAIN);
    assert_true(quat_equal(m, quat_identity()) && isnan(residual));
    assert_int_equal(quat_align(0, v, v, NULL, &m, &residual), QUAT_EARGUMENT);
    assert_int_equal(quat_align(2, v, v, NULL, &m, &residual), QUAT_EDOMAIN);
    assert_int_equal(quat_align(2, zero, zero, NULL, &m, &residual), QUAT_EDOMAIN);
    assert_true(isnan(residual));
    assert_int_equal(quat_align_points(2, v, zero, NULL, &m, &shift, NULL), QUAT_EDOMAIN);
    assert_int_equal(quat_align_points(2, zero, zero, negative, &m, &shift, NULL), QUAT_EDOMAIN);
    const qvec3 apart[2] = {{1.7e308, 0, 0}, {-1.7e308, 0, 0}};
    assert_int_equal(quat_align_points(2, apart, apart, NULL, &m, &shift, &residual), QUAT_ERANGE);
    assert_true(quat_equal(m, quat_identity()) && qvec3_norm(shift) == 0 && isnan(residual));
    const qvec3 large[2] = {{1e308, 0, 0}, {0, 1e308, 0}}, turned[2] = {{0, 1e308, 0}, {-1e308, 0, 0}};
    assert_int_equal(quat_align(2, large, turned, NULL, &m, &residual), QUAT_OK);
    assert_true(quat_near(m, quat_make(sqrt(0.5), 0, 0, sqrt(0.5)), 1e-15) && residual < 1e293);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(markley_mean_is_the_best),     cmocka_unit_test(karcher_mean_balances),
        cmocka_unit_test(alignment_finds_the_rotation), cmocka_unit_test(what_is_not_unique_is_said),
        cmocka_unit_test(bad_input_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
