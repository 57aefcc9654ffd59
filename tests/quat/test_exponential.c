/* SPDX-License-Identifier: MIT */
#include "oracle.h"
#include <quat/exponential.h>

static const double pi = 3.14159265358979323846;

/* Angles from 1e-300 to pi, and on both sides of the places where a part of exp vanishes. */
static double nasty_angle(random_state *r, int n)
{
    const double off = random_scale(r, -15.5, -1), near = random_uniform(r) < 0.5 ? -off : off;
    switch (n % 5) {
    case 0: return random_scale(r, -300, 0.49);
    case 1: return pi + near;
    case 2: return 0.5 * pi + near;
    case 3: return random_scale(r, -9, -7); /* where the series hands over */
    default: return random_between(r, 0, pi);
    }
}

static void exp_of_pure_is_right_for_every_angle(void **state)
{
    (void)state;
    random_state r = {11};
    double parts = 0, large = 0, huge = 0;
    for (int n = 0; n < 150000; n++) {
        const qvec3 v = random_vector(&r, nasty_angle(&r, n));
        worse(&parts, error_of_parts(quat_exp_pure(v), wide_exp(wide_vec(v))));
        const qvec3 turns = random_vector(&r, random_scale(&r, 0, 7));
        worse(&large, error_of_parts(quat_exp_pure(turns), wide_exp(wide_vec(turns))));
        const qvec3 many = random_vector(&r, random_scale(&r, 7, 15));
        worse(&huge, error_of(quat_exp_pure(many), wide_exp(wide_vec(many))));
    }
    assert_bound("exp of a pure quaternion, each part, u", parts, 3);
    assert_bound("the same, angles to 1e7, u", large, 3);
    assert_bound("the whole, angles to 1e15, u", huge, 3);
    assert_true(quat_equal(quat_exp_pure(qvec3_make(0, 0, 0)), quat_identity()));
    /* sin of the double next to pi, 1.2246467991473532e-16 (pi - fl(pi), known to all digits) */
    const quat near = quat_exp_pure(qvec3_make(0, pi, 0));
    assert_true(near.w == -1 && fabs(near.y - 1.2246467991473532e-16) < 1e-31);
    assert_true(isnan(quat_exp_pure(qvec3_make(INFINITY, 0, 0)).w) && isnan(quat_exp_pure(qvec3_make(0, NAN, 1)).y));
    assert_true(fabs(quat_norm(quat_exp_pure(qvec3_make(1e300, 1e300, 0))) - 1) < 1e-15);
    assert_true(isnan(quat_exp_pure(qvec3_make(1.7e308, 1.7e308, 1.7e308)).w));
}

static void exp_is_right(void **state)
{
    (void)state;
    random_state r = {12};
    double parts = 0, whole = 0;
    for (int n = 0; n < 150000; n++) {
        quat q = quat_pure(random_vector(&r, nasty_angle(&r, n))), e;
        q.w =
            n % 3 == 0 ? random_scale(&r, -300, 0) : random_between(&r, n % 3 == 1 ? -700 : -1, n % 3 == 1 ? 709.7 : 1);
        assert_int_equal(quat_exp(q, &e), QUAT_OK);
        const wquat want = wide_exp(wide_quat(q));
        if (wide_vnorm(want) > 1e-290 && fabsf128(want.w) > 1e-290) worse(&parts, error_of_parts(e, want));
        if (q.w > -660) worse(&whole, error_of(e, want));
    }
    assert_bound("exp, u", whole, 3);
    assert_bound("exp, each part, u", parts, 3); /* sine or cosine 1.1 by libm, the product 1, all else is carried on */
    quat e;
    assert_int_equal(quat_exp(quat_make(710, 0, 0, 0), &e), QUAT_ERANGE);
    assert_int_equal(quat_exp(quat_make(709.7827128933841, 0, 1, 0), &e), QUAT_ERANGE);
    assert_int_equal(quat_exp(quat_make(709.78271289338397, 0, 1, 0), &e), QUAT_OK);
    assert_true(e.w < 1e308 && e.y > 1.5e308);
    assert_int_equal(quat_exp(quat_make(-1e300, 0, 1, 0), &e), QUAT_OK);
    assert_true(e.w == 0 && e.y == 0);
    assert_int_equal(quat_exp(quat_make(NAN, 0, 0, 0), &e), QUAT_EDOMAIN);
    assert_int_equal(quat_exp(quat_make(0, -INFINITY, 0, 0), &e), QUAT_EDOMAIN);
    assert_true(quat_equal(e, quat_identity()));
    assert_int_equal(quat_exp(quat_make(0, 1e308, 1.7e308, 1.7e308), &e), QUAT_ERANGE);
}

static void log_is_right(void **state)
{
    (void)state;
    random_state r = {13};
    double unit = 0, parts = 0, near_one = 0, scales = 0;
    for (int n = 0; n < 150000; n++) {
        const quat q = quat_exp_pure(random_vector(&r, nasty_angle(&r, n)));
        const wquat want = wide_log(wide_quat(q));
        worse(&unit, error_of_vector(quat_log_unit(q), (wquat){0, want.x, want.y, want.z}));
        quat l;
        const double scale = n % 2 ? random_between(&r, 0.3, 3) : random_scale(&r, -310, 308);
        const quat s = quat_scale(q, scale);
        const quat_status status = quat_log(s, &l); /* the vector part may have vanished in the scaling */
        assert_true(status == QUAT_OK || (status == QUAT_NOT_UNIQUE && s.x == 0 && s.y == 0 && s.z == 0));
        if (status == QUAT_OK) worse(n % 2 ? &parts : &scales, error_of_parts(l, wide_log(wide_quat(s))));
        assert_true(quat_log(q, &l) >= 0);
        if (fabsf128(want.w) > 1e-290 || want.w == 0) worse(&near_one, error_of_parts(l, want));
    }
    assert_bound("log of unit quaternions, u", unit, 3);
    assert_bound("log, each part, |q| = 0.3 ... 3, u", parts, 3);
    assert_bound("log, each part, |q| = 1e-310 ... 1e308, u", scales, 3);
    assert_bound("log, each part, |q| = 1 but for rounding, u", near_one, 3);
}

static void log_at_its_edges(void **state)
{
    (void)state;
    quat l;
    assert_int_equal(quat_log(quat_make(-1, 0, 0, 0), &l), QUAT_NOT_UNIQUE);
    assert_true(quat_equal(l, quat_make(0, pi, 0, 0)));
    assert_int_equal(quat_log(quat_make(0, 0, 0, 0), &l), QUAT_EDOMAIN);
    assert_true(quat_equal(l, quat_make(0, 0, 0, 0)));
    assert_int_equal(quat_log(quat_make(INFINITY, 0, 0, 0), &l), QUAT_EDOMAIN);
    assert_int_equal(quat_log(quat_make(0, 4e-320, 0, 3e-320), &l), QUAT_OK);
    assert_true(fabs(l.w - log(5e-320)) < 0.1 && fabs(quat_norm(quat_make(0, l.x, l.y, l.z)) - pi / 2) < 1e-15);
    assert_int_equal(quat_log(quat_make(1.7e308, 0, 1.7e308, 0), &l), QUAT_OK);
    assert_true(fabs(l.w - (log(1.7) + 308 * log(10) + 0.5 * log(2))) < 2e-13 && fabs(l.y - pi / 4) < 1e-15);
    /* a vector part whose square vanishes, on both sides */
    const qvec3 v = quat_log_unit(quat_make(1, 0, 3e-310, 0)), back = quat_log_unit(quat_make(-1, 0, 3e-310, 0));
    assert_true(v.y == 3e-310 && v.x == 0 && back.y == pi && back.x == 0);
    assert_true(isnan(quat_log_unit(quat_make(1, NAN, 0, 0)).x));
    const qvec3 zero = quat_log_unit(quat_make(0, 0, 0, 0));
    assert_true(zero.x == 0 && zero.y == 0 && zero.z == 0);
}

static void exp_and_log_undo_each_other(void **state)
{
    (void)state;
    random_state r = {14};
    double forth = 0, back = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_unit(&r);
        worse(&forth, error_of(quat_exp_pure(quat_log_unit(q)), wide_unit(wide_quat(q))));
        const qvec3 v = random_vector(&r, random_scale(&r, -300, 0.47));
        worse(&back, error_of_vector(quat_log_unit(quat_exp_pure(v)), wide_vec(v)));
    }
    assert_bound("exp log q = q, u", forth, 6);
    assert_bound("log exp v = v, u", back, 25); /* an error of u in q near -1 is one of u/sin in v */
}

static void powers(void **state)
{
    (void)state;
    random_state r = {15};
    double real = 0, unit = 0, square = 0, quaternion = 0, sum = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_quat(&r, random_between(&r, 0.1, 10)), u = random_unit(&r);
        const double t = random_between(&r, -3, 3);
        quat p, s;
        assert_true(quat_pow(q, t, &p) >= 0);
        worse(&real, error_of(p, wide_pow(wide_quat(q), t)));
        worse(&unit, error_of(quat_pow_unit(u, t), wide_pow(wide_unit(wide_quat(u)), t)));
        assert_int_equal(quat_sqrt(q, &s), QUAT_OK);
        assert_true(s.w >= 0);
        worse(&square, error_of(s, wide_pow(wide_quat(q), 0.5)));
        assert_true(quat_pow_quat(q, u, &p) >= 0);
        worse(&quaternion, error_of(p, wide_exp(wide_mul(wide_log(wide_quat(q)), wide_quat(u)))));
        const double a = random_between(&r, -2, 2);
        worse(&sum, quat_norm(quat_sub(quat_mul(quat_pow_unit(u, t), quat_pow_unit(u, a)), quat_pow_unit(u, t + a))) /
                        ROUNDING);
    }
    assert_bound("q^t, |t| <= 3, u", real, 25); /* conditioned by t times the logarithm, up to 3 (pi + ln 10) */
    assert_bound("q^t of units, u", unit, 20);
    assert_bound("sqrt, u", square, 1.01);
    assert_bound("p^q, u", quaternion, 25);
    assert_bound("q^s q^t = q^(s+t), u", sum, 40);
}

/* The textbook's half-angle formulas. */
static wquat wide_sqrt(wquat q)
{
    const wide n = wide_norm(q), v = wide_vnorm(q), b = sqrtf128((n + fabsf128(q.w)) / 2);
    const wide w = q.w < 0 ? v / (2 * b) : b, s = q.w < 0 ? b / v : 1 / (2 * b);
    return (wquat){w, s * q.x, s * q.y, s * q.z};
}

static void roots_at_every_angle_and_scale(void **state)
{
    (void)state;
    random_state r = {16};
    double parts = 0, back = 0;
    for (int n = 0; n < 100000; n++) {
        const quat u = quat_exp_pure(random_vector(&r, nasty_angle(&r, n)));
        const quat q = quat_scale(u, n % 2 ? random_scale(&r, -310, 308) : random_between(&r, 0.3, 3));
        if (q.x == 0 && q.y == 0 && q.z == 0) continue;
        quat s;
        assert_int_equal(quat_sqrt(q, &s), QUAT_OK);
        const wquat want = wide_sqrt(wide_quat(q));
        if (fabsf128(want.w) > 1e-290 && wide_vnorm(want) > 1e-290) worse(&parts, error_of_parts(s, want));
        if (quat_norm(q) > 1e-290) worse(&back, error_of(quat_mul(s, s), wide_quat(q)));
    }
    assert_bound("sqrt at every scale, each part, u", parts, 1.01);
    assert_bound("its square, u", back, 5);
}

static void powers_at_their_edges(void **state)
{
    (void)state;
    quat p;
    assert_int_equal(quat_sqrt(quat_make(-4, 0, 0, 0), &p), QUAT_NOT_UNIQUE);
    assert_true(quat_equal(p, quat_make(0, 2, 0, 0)));
    assert_int_equal(quat_sqrt(quat_make(0, 0, 0, 0), &p), QUAT_OK);
    assert_true(quat_equal(p, quat_make(0, 0, 0, 0)));
    assert_int_equal(quat_sqrt(quat_make(0, 0, 2e-300, 0), &p), QUAT_OK);
    assert_true(quat_near(p, quat_make(1e-150, 0, 1e-150, 0), 1e-165));
    assert_int_equal(quat_sqrt(quat_make(-1e300, 0, 1, 0), &p), QUAT_OK); /* just beside the cut */
    assert_true(p.y == 1e150 && p.w > 0 && p.w < 1e-140);
    assert_int_equal(quat_sqrt(quat_make(NAN, 0, 1, 0), &p), QUAT_EDOMAIN);
    const quat zero = {0, 0, 0, 0}, minus = {-2, 0, 0, 0}, i = {0, 1, 0, 0};
    assert_int_equal(quat_pow(zero, 2, &p), QUAT_OK);
    assert_true(quat_equal(p, zero));
    assert_int_equal(quat_pow(zero, 0, &p), QUAT_OK);
    assert_true(quat_equal(p, quat_identity()));
    assert_int_equal(quat_pow(zero, -1, &p), QUAT_EDOMAIN);
    assert_int_equal(quat_pow(quat_make(0.6, 0.8, 0, 0), 1.7e308, &p), QUAT_OK); /* some unit quaternion */
    assert_int_equal(quat_pow(quat_make(-0.6, 0.8, 0, 0), 1.7e308, &p), QUAT_ERANGE);
    assert_true(quat_equal(p, quat_identity()));
    assert_int_equal(quat_pow(minus, 3, &p), QUAT_OK);
    assert_true(quat_equal(p, quat_make(-8, 0, 0, 0)));
    assert_int_equal(quat_pow(minus, 2, &p), QUAT_OK);
    assert_true(quat_equal(p, quat_make(4, 0, 0, 0)));
    assert_int_equal(quat_pow(minus, 0.5, &p), QUAT_NOT_UNIQUE);
    assert_true(quat_near(p, quat_make(0, sqrt(2), 0, 0), 1e-15));
    assert_int_equal(quat_pow(quat_make(1e300, 0, 1, 0), 2, &p), QUAT_ERANGE);
    assert_int_equal(quat_pow(i, NAN, &p), QUAT_EDOMAIN);
    assert_int_equal(quat_pow_quat(zero, i, &p), QUAT_EDOMAIN);
    assert_int_equal(quat_pow_quat(i, quat_make(INFINITY, 0, 0, 0), &p), QUAT_EDOMAIN);
    /* i^i = exp(-pi/2), by hand from the definition */
    assert_int_equal(quat_pow_quat(i, i, &p), QUAT_OK);
    assert_true(quat_near(p, quat_make(exp(-pi / 2), 0, 0, 0), 1e-16));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exp_of_pure_is_right_for_every_angle),
        cmocka_unit_test(exp_is_right),
        cmocka_unit_test(log_is_right),
        cmocka_unit_test(log_at_its_edges),
        cmocka_unit_test(exp_and_log_undo_each_other),
        cmocka_unit_test(powers),
        cmocka_unit_test(roots_at_every_angle_and_scale),
        cmocka_unit_test(powers_at_their_edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
