/* SPDX-License-Identifier: MIT
 *
 * Alignment against Davenport's q-method in 113 bits, whose squared condition leaves digits enough there, on the data
 * as they are.
 */
#include "oracle.h"
#include <float.h>
#include <quat/average.h>
#include <quat/exponential.h>
#include <quat/rotation.h>

enum { most = 40 };

/* ---- the oracle ---- */

static void wide_annihilate(wide a[4][4], wide v[4][4], int p, int q)
{
    if (a[p][q] == 0) return;
    const wide theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const wide t = (theta < 0 ? -1 : 1) / (fabsf128(theta) + sqrtf128(1 + theta * theta));
    const wide c = 1 / sqrtf128(1 + t * t), s = t * c;
    for (int k = 0; k < 4; k++) {
        const wide x = a[k][p], y = a[k][q];
        a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
    }
    for (int k = 0; k < 4; k++) {
        const wide x = a[p][k], y = a[q][k], vx = v[k][p], vy = v[k][q];
        a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
        v[k][p] = c * vx - s * vy, v[k][q] = s * vx + c * vy;
    }
}

/* The best rotation; *lead: by how much the largest eigenvalue leads, relative. */
static wquat davenport(size_t n, const wquat a[], const wquat b[], const double w[], double *lead)
{
    wide m[3][3] = {{0}}, v[4][4] = {{0}};
    for (size_t i = 0; i < n; i++) {
        const wide from[3] = {a[i].x, a[i].y, a[i].z}, to[3] = {b[i].x, b[i].y, b[i].z};
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) m[j][k] += (w ? w[i] : 1) * to[j] * from[k];
    }
    const wide x = m[2][1] - m[1][2], y = m[0][2] - m[2][0], z = m[1][0] - m[0][1];
    wide k[4][4] = {{m[0][0] + m[1][1] + m[2][2], x, y, z},
                    {x, m[0][0] - m[1][1] - m[2][2], m[1][0] + m[0][1], m[0][2] + m[2][0]},
                    {y, m[1][0] + m[0][1], m[1][1] - m[0][0] - m[2][2], m[2][1] + m[1][2]},
                    {z, m[0][2] + m[2][0], m[2][1] + m[1][2], m[2][2] - m[0][0] - m[1][1]}};
    for (int i = 0; i < 4; i++) v[i][i] = 1;
    for (int sweep = 0; sweep < 20; sweep++)
        for (int p = 0; p < 3; p++)
            for (int q = p + 1; q < 4; q++) wide_annihilate(k, v, p, q);
    int best = 0;
    wide second = -INFINITY;
    for (int i = 1; i < 4; i++) best = k[i][i] > k[best][best] ? i : best;
    for (int i = 0; i < 4; i++)
        if (i != best && k[i][i] > second) second = k[i][i];
    if (lead) *lead = (double)((k[best][best] - second) / k[best][best]);
    return (wquat){v[0][best], v[1][best], v[2][best], v[3][best]};
}

static wquat vectors_oracle(size_t n, const qvec3 a[], const qvec3 b[], const double w[], double *lead)
{
    wquat from[most], to[most];
    for (size_t i = 0; i < n; i++) from[i] = wide_vec(a[i]), to[i] = wide_vec(b[i]);
    return davenport(n, from, to, w, lead);
}

static wquat points_oracle(size_t n, const qvec3 a[], const qvec3 b[], const double w[])
{
    wquat from[most], to[most], ca = {0, 0, 0, 0}, cb = ca;
    wide total = 0;
    for (size_t i = 0; i < n; i++) {
        ca = wide_add(ca, wide_scale(wide_vec(a[i]), w ? w[i] : 1));
        cb = wide_add(cb, wide_scale(wide_vec(b[i]), w ? w[i] : 1));
        total += w ? w[i] : 1;
    }
    for (size_t i = 0; i < n; i++) {
        from[i] = wide_sub(wide_vec(a[i]), wide_scale(ca, 1 / total));
        to[i] = wide_sub(wide_vec(b[i]), wide_scale(cb, 1 / total));
    }
    return davenport(n, from, to, w, NULL);
}

/* rad */
static double angle_between(quat got, wquat wanted)
{
    const wquat g = wide_quat(got), sum = wide_add(g, wanted), difference = wide_sub(g, wanted);
    const double a = (double)wide_norm(sum), b = (double)wide_norm(difference);
    return 2 * (a < b ? a : b);
}

/* ---- sets ---- */

static size_t some(random_state *r, size_t least) { return least + (size_t)(random_uniform(r) * 8); }

/* n vectors about one direction, the farthest at the angle `spread` of the first, turned by a random rotation; each
 * component is rounded. */
static void bundle(random_state *r, size_t n, double spread, qvec3 a[], qvec3 b[])
{
    const quat q = random_unit(r), frame = random_unit(r);
    for (size_t i = 0; i < n; i++) {
        const double reach = i == 0 ? 0 : i == 1 ? spread : spread * random_uniform(r), turn = 6.3 * random_uniform(r);
        a[i] = quat_rotate(frame, qvec3_make(sin(reach) * cos(turn), sin(reach) * sin(turn), cos(reach)));
        const wquat turned = wide_rotate(wide_unit(wide_quat(q)), wide_vec(a[i]));
        b[i] = qvec3_make((double)turned.x, (double)turned.y, (double)turned.z);
    }
}

/* ---- tests ---- */

/* The table: error times spread over eps, for every spread alike. */
static void the_condition_is_not_squared(void **state)
{
    (void)state;
    static const double spreads[] = {1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
    static const size_t counts[] = {2, 3, 20};
    random_state r = {101};
    for (size_t k = 0; k < sizeof spreads / sizeof *spreads; k++) {
        double worst = 0;
        for (int round = 0; round < 1200; round++) {
            qvec3 a[most], b[most];
            const size_t n = counts[round % 3];
            quat q;
            bundle(&r, n, spreads[k], a, b);
            assert_int_equal(quat_align(n, a, b, NULL, &q, NULL), QUAT_OK);
            const double error = angle_between(q, vectors_oracle(n, a, b, NULL, NULL));
            worse(&worst, error * spreads[k] / DBL_EPSILON);
            assert_true(error <= quat_align_error(n, a, b, NULL, q));
        }
        char name[64];
        snprintf(name, sizeof name, "error spread/eps, spread %g", spreads[k]);
        assert_bound(name, worst, 4);
    }
}

/* Any sets: noise, outliers, reflections, weights and lengths over many magnitudes. */
static void any_sets(void **state)
{
    (void)state;
    random_state r = {102};
    int answered = 0, refused = 0;
    double slackest = 0, over = 0;
    for (int round = 0; round < 40000; round++) {
        qvec3 a[most], b[most];
        double w[most];
        const size_t n = some(&r, 2);
        bundle(&r, n, random_scale(&r, -12, 0.4), a, b);
        const double noise = round % 4 == 0 ? 0 : random_scale(&r, -14, 0), lengths = round % 3 == 0 ? 6 : 0;
        for (size_t i = 0; i < n; i++) {
            const double length = random_scale(&r, -lengths, lengths);
            b[i] = qvec3_scale(qvec3_axpy(noise, random_direction(&r), b[i]), length);
            if (round % 5 == 1) b[i] = qvec3_neg(b[i]); /* a reflection: no rotation fits */
            w[i] = random_scale(&r, -lengths / 2, 0);
        }
        if (round % 7 == 2) b[0] = random_direction(&r); /* an outlier */
        quat q;
        double lead;
        const quat_status status = quat_align(n, a, b, w, &q, NULL);
        const wquat wanted = vectors_oracle(n, a, b, w, &lead);
        const double error = angle_between(q, wanted), bound = quat_align_error(n, a, b, w, q);
        assert_true(status == QUAT_OK || status == QUAT_NOT_UNIQUE);
        assert_true((status == QUAT_OK) == (bound <= 4e-3) || fabs(bound / 4e-3 - 1) < 0.1);
        if (status != QUAT_OK) {
            refused++;
            worse(&slackest, lead);
            continue;
        }
        answered++;
        worse(&over, error / bound);
    }
    assert_bound("error over its bound", over, 1);
    assert_bound("lead of the best eigenvalue where the answer is not unique", slackest, 1e-8);
    assert_true(answered > 30000 && refused > 1000);
}

static void points_far_away(void **state)
{
    (void)state;
    random_state r = {103};
    double over = 0;
    for (int round = 0; round < 10000; round++) {
        qvec3 a[most], b[most];
        const size_t n = some(&r, 3);
        const qvec3 shift = random_vector(&r, random_scale(&r, -2, 4)), start = random_vector(&r, 100);
        const quat turn = random_unit(&r);
        const double width = random_scale(&r, -6, 0);
        for (size_t i = 0; i < n; i++) { /* near a line */
            const qvec3 p = {random_between(&r, -1, 1), width * random_between(&r, -1, 1),
                             width * random_between(&r, -1, 1)};
            a[i] = qvec3_add(start, p);
            b[i] = qvec3_add(shift, quat_rotate(turn, a[i]));
        }
        quat q;
        qvec3 found;
        const quat_status status = quat_align_points(n, a, b, NULL, &q, &found, NULL);
        assert_true(status == QUAT_OK || status == QUAT_NOT_UNIQUE);
        const double error = angle_between(q, points_oracle(n, a, b, NULL));
        if (status == QUAT_OK) worse(&over, error / quat_align_points_error(n, a, b, NULL, q));
        const quat turned = quat_mul(q, quat_conj(turn)); /* the data's own rounding, 1e4 eps, over the width */
        if (status == QUAT_OK) assert_true(quat_angle(turned) <= 1e-10 / (width * width));
    }
    assert_bound("points: error over its bound", over, 1);
}

/* Lengths of either set and the weights' scale do not matter; turning a set turns the answer. */
static void what_does_not_matter(void **state)
{
    (void)state;
    random_state r = {104};
    for (int round = 0; round < 5000; round++) {
        qvec3 a[most], b[most], c[most];
        double w[most], heavier[most];
        const size_t n = some(&r, 2);
        bundle(&r, n, random_scale(&r, -6, 0), a, b);
        const quat turn = random_unit(&r);
        const double size = random_scale(&r, -250, 250);
        for (size_t i = 0; i < n; i++) {
            w[i] = random_between(&r, 0.1, 1), heavier[i] = 1e200 * w[i];
            c[i] = qvec3_scale(quat_rotate(turn, b[i]), size);
        }
        quat q, p;
        assert_int_equal(quat_align(n, a, b, w, &q, NULL), QUAT_OK);
        assert_int_equal(quat_align(n, a, c, heavier, &p, NULL), QUAT_OK);
        const double error = quat_align_error(n, a, b, w, q);
        assert_true(quat_rotation_distance(p, quat_mul(turn, q)) <= 2 * error + 1e-15);
    }
}

static void errors_are_said(void **state)
{
    (void)state;
    const qvec3 line[2] = {{1, 0, 0}, {-2, 0, 0}}, tripod[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                mirrored[3] = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, bad[2] = {{NAN, 0, 0}, {1, 0, 0}};
    quat q;
    assert_int_equal(quat_align(2, line, line, NULL, &q, NULL), QUAT_NOT_UNIQUE);
    assert_true(isinf(quat_align_error(2, line, line, NULL, q)));
    assert_int_equal(quat_align(3, tripod, mirrored, NULL, &q, NULL), QUAT_NOT_UNIQUE);
    assert_true(quat_align_error(3, tripod, mirrored, NULL, q) > 1);
    assert_true(quat_align_error(3, tripod, tripod, NULL, quat_identity()) < 1e-14);
    assert_true(quat_align_points_error(3, tripod, tripod, NULL, quat_identity()) < 1e-14);
    assert_true(isnan(quat_align_error(2, bad, line, NULL, q)));
    assert_true(isnan(quat_align_error(0, line, line, NULL, q)));
    assert_true(isnan(quat_align_error(3, tripod, tripod, NULL, quat_make(0, 0, 0, 0))));
    assert_true(isnan(quat_align_points_error(0, line, line, NULL, q)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_condition_is_not_squared),
        cmocka_unit_test(any_sets),
        cmocka_unit_test(points_far_away),
        cmocka_unit_test(what_does_not_matter),
        cmocka_unit_test(errors_are_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
