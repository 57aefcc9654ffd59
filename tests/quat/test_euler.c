/* SPDX-License-Identifier: MIT */
#include "oracle.h"
#include <quat/euler.h>
#include <quat/rotation.h>

static const double pi = 3.14159265358979323846;

static const char *const names[24] = {"XYZ", "XZY", "YZX", "YXZ", "ZXY", "ZYX", "XYX", "XZX",
                                      "YXY", "YZY", "ZXZ", "ZYZ", "xyz", "xzy", "yzx", "yxz",
                                      "zxy", "zyx", "xyx", "xzx", "yxy", "yzy", "zxz", "zyz"};

static quat_euler sequence(int i)
{
    quat_euler s;
    assert_int_equal(quat_euler_from_name(names[i], &s), QUAT_OK);
    return s;
}

/* The sequence from its definition: one turn after the other about the axes its letters name, in wide arithmetic. */
static wquat by_definition(const char *name, const double angles[3])
{
    wquat q = {1, 0, 0, 0};
    for (int i = 0; i < 3; i++) {
        const int extrinsic = name[i] >= 'a', axis = name[i] - (extrinsic ? 'x' : 'X');
        const wide half = (wide)angles[i] / 2, s = sinf128(half);
        const wquat turn = {cosf128(half), axis == 0 ? s : 0, axis == 1 ? s : 0, axis == 2 ? s : 0};
        q = extrinsic ? wide_mul(turn, q) : wide_mul(q, turn);
    }
    return q;
}

/* Angle between the rotation q and the one the angles stand for. */
static double off_by(quat q, const char *name, const double angles[3])
{
    const wquat a = wide_unit(wide_quat(q)), b = by_definition(name, angles);
    const wide minus = wide_norm(wide_sub(a, b)), plus = wide_norm(wide_add(a, b));
    return (double)(minus < plus ? 4 * atan2f128(minus, plus) : 4 * atan2f128(plus, minus));
}

static void the_24_sequences_are_what_their_names_say(void **state)
{
    (void)state;
    random_state r = {31};
    double worst = 0;
    for (int n = 0; n < 100000; n++) {
        const double angles[3] = {random_between(&r, -7, 7), random_between(&r, -7, 7), random_between(&r, -7, 7)};
        quat q;
        assert_int_equal(quat_from_euler(angles, sequence(n % 24), &q), QUAT_OK);
        worse(&worst, error_of(q, by_definition(names[n % 24], angles)));
    }
    assert_bound("from Euler angles, u", worst, 6);
    /* R_x(a) R_y(b) R_z(c), entry (2,1): sin a sin b cos c + cos a sin c (the thesis drops the second term) */
    const double angles[3] = {0.3, 0.5, 0.7};
    quat q;
    quat_from_euler(angles, QUAT_EULER_XYZ, &q);
    const qmat3 m = quat_to_matrix(q);
    assert_true(fabs(m.m[1][0] - (sin(0.3) * sin(0.5) * cos(0.7) + cos(0.3) * sin(0.7))) < 1e-15);
    assert_true(fabs(m.m[0][2] - sin(0.5)) < 1e-15);
}

static void there_and_back_everywhere(void **state)
{
    (void)state;
    random_state r = {32};
    double worst = 0, lock = 0, scaled = 0;
    for (int n = 0; n < 120000; n++) {
        const int i = n % 24;
        const quat q = random_unit(&r);
        double angles[3];
        assert_int_equal(quat_to_euler(q, sequence(i), angles), QUAT_OK);
        worse(&worst, off_by(q, names[i], angles));
        double other[3];
        quat_to_euler(quat_neg(q), sequence(i), other);
        assert_true(off_by(q, names[i], other) < 2e-15);
        quat_to_euler(quat_scale(q, random_scale(&r, -300, 300)), sequence(i), other);
        worse(&scaled, off_by(q, names[i], other));

        /* at lock, and within 1e-15 ... 1e-1 of it, on both sides */
        const int proper = names[i][0] == names[i][2], which = random_uniform(&r) < 0.5;
        const double off = random_scale(&r, -17, -1), near = n % 7 == 0 ? 0 : random_uniform(&r) < 0.5 ? -off : off;
        const double middle = (proper ? (which ? 0 : pi) : (which ? 0.5 * pi : -0.5 * pi)) + near;
        const double at_lock[3] = {random_between(&r, -pi, pi), middle, random_between(&r, -pi, pi)};
        quat s;
        assert_int_equal(quat_from_euler(at_lock, sequence(i), &s), QUAT_OK);
        assert_true(quat_to_euler(s, sequence(i), angles) >= 0);
        worse(&lock, off_by(s, names[i], angles));
        assert_true(fabs(angles[0]) <= pi && fabs(angles[2]) <= pi);
        assert_true(proper ? angles[1] >= 0 && angles[1] <= pi : fabs(angles[1]) <= 0.5 * pi + 1e-15);
    }
    assert_bound("Euler round trip, rad", worst, 2e-15);
    assert_bound("Euler round trip, any length, rad", scaled, 2e-15);
    assert_bound("Euler round trip at and near lock, rad", lock, 2e-15);
}

static void exact_lock_is_said(void **state)
{
    (void)state;
    const double h = sqrt(0.5);
    double a[3];
    /* proper: a turn about the first axis alone, and one with the middle angle pi */
    assert_int_equal(quat_to_euler(quat_make(cos(0.4), 0, 0, sin(0.4)), QUAT_EULER_ZXZ, a), QUAT_NOT_UNIQUE);
    assert_true(fabs(a[0] - 0.8) < 1e-15 && a[1] == 0 && a[2] == 0);
    assert_int_equal(quat_to_euler(quat_make(0, cos(0.4), sin(0.4), 0), QUAT_EULER_ZXZ, a), QUAT_NOT_UNIQUE);
    assert_true(a[2] == 0 && fabs(a[1] - pi) < 1e-15 && off_by(quat_make(0, cos(0.4), sin(0.4), 0), "ZXZ", a) < 2e-15);
    assert_int_equal(quat_to_euler(quat_make(0, cos(0.4), sin(0.4), 0), QUAT_EULER_EXTRINSIC_ZXZ, a), QUAT_NOT_UNIQUE);
    assert_true(a[2] == 0 && off_by(quat_make(0, cos(0.4), sin(0.4), 0), "zxz", a) < 2e-15);
    /* Tait-Bryan: pitch of +-90 degrees */
    assert_int_equal(quat_to_euler(quat_make(h, 0, h, 0), QUAT_EULER_ZYX, a), QUAT_NOT_UNIQUE);
    assert_true(a[2] == 0 && a[1] == 0.5 * pi && a[0] == 0);
    assert_int_equal(quat_to_euler(quat_make(0.5, 0.5, 0.5, -0.5), QUAT_EULER_ZYX, a), QUAT_NOT_UNIQUE);
    assert_true(a[2] == 0 && off_by(quat_make(0.5, 0.5, 0.5, -0.5), "ZYX", a) < 2e-15);
    /* the matrix there holds the sum or the difference only: entry (2,1) of R_x(a) R_y(+-90) R_z(c) is +-sin(a +- c),
     * not the thesis' half of it and more */
    for (int side = -1; side <= 1; side += 2) {
        const double angles[3] = {0.3, side * 0.5 * pi, 0.9};
        quat q;
        assert_int_equal(quat_from_euler(angles, QUAT_EULER_XYZ, &q), QUAT_OK);
        assert_true(fabs(quat_to_matrix(q).m[1][0] - side * sin(0.3 + side * 0.9)) < 1e-15);
    }
    for (int i = 0; i < 24; i++) {
        const quat q = {0.5, 0.5, 0.5, 0.5}, half = {0, 1, 0, 0};
        quat_to_euler(q, sequence(i), a);
        assert_true(off_by(q, names[i], a) < 2e-15);
        if (quat_to_euler(half, sequence(i), a) == QUAT_NOT_UNIQUE) assert_true(a[2] == 0);
        assert_true(off_by(half, names[i], a) < 2e-15);
    }
}

static void bad_input_is_named(void **state)
{
    (void)state;
    const char *const wrong[] = {"", "XY", "XXY", "XYZX", "XyZ", "xYz", "ABC", "xyy", "wxy"};
    quat_euler s;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(quat_euler_from_name(wrong[i], &s), QUAT_EARGUMENT);
    assert_int_equal(quat_euler_from_name(NULL, &s), QUAT_EARGUMENT);
    double a[3] = {0, NAN, 0};
    quat q;
    assert_int_equal(quat_from_euler(a, QUAT_EULER_XYZ, &q), QUAT_EDOMAIN);
    assert_true(quat_equal(q, quat_identity()));
    assert_int_equal(quat_from_euler(a, (quat_euler)0, &q), QUAT_EARGUMENT);
    assert_int_equal(quat_to_euler(q, (quat_euler)0x3f, a), QUAT_EARGUMENT);
    assert_int_equal(quat_to_euler(quat_make(0, 0, 0, 0), QUAT_EULER_XYZ, a), QUAT_EDOMAIN);
    assert_true(a[0] == 0 && a[1] == 0 && a[2] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_24_sequences_are_what_their_names_say),
        cmocka_unit_test(there_and_back_everywhere),
        cmocka_unit_test(exact_lock_is_said),
        cmocka_unit_test(bad_input_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
