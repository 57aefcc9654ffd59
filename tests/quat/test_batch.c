/* SPDX-License-Identifier: MIT */
#include "oracle.h"
#include <string.h>
#include <quat/batch.h>
#include <quat/interpolate.h>
#include <quat/rotation.h>

enum { count = 1003 }; /* no multiple of a block or a vector register */

static quat p[count], q[count], out[count];
static qvec3 v[count], w[count];
static double t[count];
static qmat3 m[count];

static int fill(void **state)
{
    (void)state;
    random_state r = {61};
    for (int i = 0; i < count; i++) {
        p[i] = random_unit(&r);
        q[i] = random_unit(&r);
        t[i] = i % 10 == 0 ? 0 : i % 10 == 1 ? 1 : random_uniform(&r);
        v[i] = random_vector(&r, random_scale(&r, -3, 3));
    }
    return 0;
}

static bool same_bits(const void *a, const void *b, size_t size) { return memcmp(a, b, size) == 0; }

static void element_by_element(void **state)
{
    (void)state;
    for (size_t n = 0; n < 12; n++) { /* short and empty arrays touch nothing else */
        memset(out, 0, sizeof out);
        quat_mul_array(n, p, q, out);
        assert_true(quat_equal(out[n], quat_make(0, 0, 0, 0)));
    }
    quat_mul_array(count, p, q, out);
    for (int i = 0; i < count; i++) {
        const quat one = quat_mul(p[i], q[i]);
        assert_true(same_bits(&out[i], &one, sizeof one));
    }
    quat_rotate_each(count, q, v, w);
    for (int i = 0; i < count; i++) {
        const qvec3 one = quat_rotate(q[i], v[i]);
        assert_true(same_bits(&w[i], &one, sizeof one));
    }
    quat_to_matrix_array(count, q, m);
    for (int i = 0; i < count; i++) {
        const qmat3 one = quat_to_matrix(q[i]);
        assert_true(same_bits(&m[i], &one, sizeof one));
    }
    size_t bad = 0;
    assert_int_equal(quat_from_matrix_array(count, m, out, &bad), QUAT_OK);
    assert_int_equal(bad, count);
    for (int i = 0; i < count; i++) {
        quat one;
        assert_int_equal(quat_from_matrix(&m[i], &one), QUAT_OK);
        assert_true(same_bits(&out[i], &one, sizeof one));
        assert_true(quat_same_rotation(out[i], q[i], 1e-14));
    }
    m[17].m[1][1] = m[1001].m[2][2] = NAN; /* among fours, and among the last three */
    assert_int_equal(quat_from_matrix_array(count, m, out, &bad), QUAT_EDOMAIN);
    assert_int_equal(bad, 17);
    for (int i = 0; i < count; i++) {
        quat one;
        assert_int_equal(quat_from_matrix(&m[i], &one), i == 17 || i == 1001 ? QUAT_EDOMAIN : QUAT_OK);
        assert_true(same_bits(&out[i], &one, sizeof one));
    }
    quat_slerp_array(count, p, q, t, out);
    for (int i = 0; i < count; i++) assert_true(quat_equal(out[i], quat_slerp(p[i], q[i], t[i])));
    const double outside = 1.5;
    quat_slerp_array(1, p, q, &outside, out);
    assert_true(isnan(out[0].w));
}

static void in_place(void **state)
{
    (void)state;
    quat expected[count];
    quat_mul_array(count, p, q, expected);
    memcpy(out, p, sizeof p);
    quat_mul_array(count, out, q, out);
    assert_true(same_bits(out, expected, sizeof out));
    quat_slerp_array(count, p, q, t, expected);
    memcpy(out, q, sizeof q);
    quat_slerp_array(count, p, out, t, out);
    assert_true(same_bits(out, expected, sizeof out));
    qvec3 moved[count];
    quat_rotate_array(q[0], count, v, moved);
    memcpy(w, v, sizeof v);
    quat_rotate_array(q[0], count, w, w);
    assert_true(same_bits(w, moved, sizeof w));
}

static void every_layout_gives_the_same(void **state)
{
    (void)state;
    static double soa[3 * count], moved[3 * count], padded[5 * count];
    double worst = 0;
    quat_rotate_array(q[0], count, v, w);
    for (int i = 0; i < count; i++) {
        soa[i] = v[i].x, soa[count + i] = v[i].y, soa[2 * count + i] = v[i].z;
        worse(&worst, error_of_vector(w[i], wide_rotate(wide_unit(wide_quat(q[0])), wide_vec(v[i]))));
    }
    assert_bound("one rotation, many vectors, u", worst, 6.5);
    quat_rotate_soa(q[0], count, soa, soa + count, soa + 2 * count, moved, moved + count, moved + 2 * count);
    for (int i = 0; i < count; i++)
        assert_true(moved[i] == w[i].x && moved[count + i] == w[i].y && moved[2 * count + i] == w[i].z);
    const quat_strided in_place = {soa, 1, count};
    memcpy(padded, soa, sizeof soa);
    quat_rotate_strided(q[0], count, in_place, in_place);
    assert_true(same_bits(soa, moved, sizeof soa));
    memcpy(soa, padded, sizeof soa);
    memset(padded, 0, sizeof padded);
    quat_rotate_strided(q[0], 0, (quat_strided){NULL, 1, 1}, (quat_strided){NULL, 1, 1});
    /* backwards, z y x, five apart */
    const quat_strided in = {soa, 1, count}, back = {padded + 5 * (count - 1) + 2, -5, -1};
    quat_rotate_strided(q[0], count, in, back);
    for (int i = 0; i < count; i++) {
        const double *const last = padded + 5 * (count - 1 - i);
        assert_true(last[2] == w[i].x && last[1] == w[i].y && last[0] == w[i].z && last[3] == 0);
    }
}

static void normalise_arrays(void **state)
{
    (void)state;
    random_state r = {62};
    quat a[count], one;
    double worst = 0;
    for (int round = 0; round < 120;
         round++) { /* of ordinary size, of any size, and some of any size among the ordinary */
        for (int i = 0; i < count; i++) {
            const bool any = round % 3 == 1 || (round % 3 == 2 && random_uniform(&r) < 0.05);
            const double size = random_scale(&r, any ? -308 : -9, any ? 307 : 9);
            a[i] = quat_scale(random_any(&r), size);
            if (quat_equal(a[i], quat_make(0, 0, 0, 0))) a[i].y = 1;
        }
        size_t bad = 0;
        const size_t n = count - (size_t)(round % 7);
        out[n < count ? n : 0] = quat_make(7, 7, 7, 7);
        assert_int_equal(quat_normalize_array(n, a, out, &bad), QUAT_OK);
        assert_int_equal(bad, n);
        assert_true(n == count || out[n].w == 7);
        for (size_t i = 0; i < n; i++) {
            assert_int_equal(quat_normalize_array(1, a + i, &one, NULL), QUAT_OK);
            assert_true(same_bits(&out[i], &one, sizeof one)); /* whatever its neighbours are */
            worse(&worst, error_of(out[i], wide_unit(wide_quat(a[i]))));
        }
        assert_int_equal(quat_normalize_array(count, a, out, NULL), QUAT_OK);
        assert_int_equal(quat_normalize_array(count, a, a, NULL), QUAT_OK); /* in place */
        assert_true(same_bits(a, out, sizeof a));
    }
    assert_bound("normalise, 1.2e5 in arrays, u", worst, 1.01);
    memcpy(a, q, sizeof a);
    size_t bad = 0;
    a[400] = quat_make(0, 0, 0, 0);
    a[700] = quat_make(NAN, 0, 0, 0);
    assert_int_equal(quat_normalize_array(count, a, out, &bad), QUAT_EDOMAIN);
    assert_int_equal(bad, 400);
    assert_true(quat_equal(out[400], quat_identity()) && quat_equal(out[700], quat_identity()));
    assert_int_equal(quat_normalize_array(0, NULL, NULL, NULL), QUAT_OK);
}

static void compose(void **state)
{
    (void)state;
    for (size_t n = 0; n <= count; n = 2 * n + 1) {
        wquat want = {1, 0, 0, 0};
        for (size_t i = 0; i < n; i++) want = wide_mul(want, wide_quat(q[i]));
        assert_true(error_of(quat_compose_array(n, q), want) < 4 + 2 * sqrt((double)n));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(element_by_element), cmocka_unit_test(in_place), cmocka_unit_test(every_layout_gives_the_same),
        cmocka_unit_test(normalise_arrays),   cmocka_unit_test(compose),
    };
    return cmocka_run_group_tests(tests, fill, NULL);
}
