/* SPDX-License-Identifier: MIT */
#include "oracle.h"
#include <quat/exponential.h>
#include <quat/rotation.h>
#include <quat/spline.h>

enum { count = 9 };
static const qvec3 zero = {0, 0, 0};

static void random_keys(random_state *r, double reach, double t[], quat q[])
{
    for (int i = 0; i < count; i++) {
        t[i] = (i ? t[i - 1] : -1) + random_between(r, 0.3, 2);
        const quat step = quat_exp_pure(random_vector(r, 0.5 * reach * random_uniform(r)));
        q[i] = i ? quat_mul(q[i - 1], step) : random_unit(r);
        if (i && random_uniform(r) < 0.5) q[i] = quat_neg(q[i]);
    }
}

/* Velocity and acceleration just before and just after t. */
static double jump(const quat_spline *s, double t, double h, bool acceleration)
{
    qvec3 w[2], a[2];
    for (int side = 0; side < 2; side++) quat_spline_state(s, side ? t + h : t - h, &w[side], &a[side]);
    return qvec3_norm(acceleration ? qvec3_sub(a[1], a[0]) : qvec3_sub(w[1], w[0]));
}

static void splines_are_twice_smooth(void **state)
{
    (void)state;
    random_state r = {101};
    double at_keys = 0, velocity = 0, acceleration = 0, natural = 0, clamped = 0, derivative = 0, second = 0;
    for (int round = 0; round < 10000; round++) {
        double t[count];
        quat q[count];
        random_keys(&r, 2.5, t, q);
        const quat_spline_end end = round % 2 ? QUAT_SPLINE_NATURAL : QUAT_SPLINE_CLAMPED;
        const qvec3 first = random_direction(&r), last = random_direction(&r);
        quat_spline *s;
        assert_int_equal(quat_spline_new(count, t, q, end, first, last, &s), QUAT_OK);
        for (int i = 0; i < count; i++) {
            worse(&at_keys, quat_rotation_distance(quat_spline_at(s, t[i]), q[i]));
            if (i == 0 || i == count - 1) continue;
            worse(&velocity, jump(s, t[i], 1e-13, false));
            worse(&acceleration, jump(s, t[i], 1e-13, true));
        }
        qvec3 w, a, b;
        quat_spline_state(s, t[0], &w, &a);
        quat_spline_state(s, t[count - 1], NULL, &b);
        if (end == QUAT_SPLINE_NATURAL)
            worse(&natural, qvec3_norm(a) + qvec3_norm(b));
        else
            worse(&clamped, qvec3_norm(qvec3_sub(w, first)));
        /* velocity and acceleration are the derivatives of what is returned, between the keys */
        for (int k = 0; k < 10; k++) {
            const double at = random_between(&r, t[0], t[count - 1]), h = 2e-4;
            bool near = false;
            for (int i = 0; i < count; i++) near = near || fabs(at - t[i]) < 3 * h;
            if (near) continue;
            quat q4[5];
            qvec3 w4[5];
            for (int i = 0; i < 5; i++) q4[i] = quat_spline_state(s, at + (i - 2) * h, &w4[i], i == 2 ? &a : NULL);
            const quat dq =
                quat_scale(quat_sub(quat_scale(quat_sub(q4[3], q4[1]), 8), quat_sub(q4[4], q4[0])), 1 / (12 * h));
            const qvec3 dw =
                qvec3_scale(qvec3_sub(qvec3_scale(qvec3_sub(w4[3], w4[1]), 8), qvec3_sub(w4[4], w4[0])), 1 / (12 * h));
            worse(&derivative, qvec3_norm(qvec3_sub(quat_omega_world(q4[2], dq), w4[2])));
            worse(&second, qvec3_norm(qvec3_sub(dw, a)) / (1 + qvec3_norm(a)));
        }
        quat_spline_free(s);
    }
    assert_bound("key met, rad", at_keys, 2e-15);
    assert_bound("jump of the angular velocity", velocity, 1e-10); /* 2e-13 s of acceleration */
    assert_bound("jump of the angular acceleration", acceleration, 1e-9);
    assert_bound("natural end", natural, 1e-12);
    assert_bound("clamped end", clamped, 1e-14);
    assert_bound("velocity against differences", derivative, 1e-9);
    assert_bound("acceleration against differences", second, 1e-9);
}

/* Steady turning about one axis is a spline's fixed point, and so is any cubic about one axis. */
static void exact_where_it_must_be(void **state)
{
    (void)state;
    double t[count], worst = 0;
    quat q[count];
    const qvec3 n = {0.6, 0, 0.8};
    for (int i = 0; i < count; i++) {
        t[i] = 0.25 * i * (1 + 0.1 * i);
        q[i] = quat_from_rotation_vector(qvec3_scale(n, t[i] - 0.2 * t[i] * t[i] + 0.05 * t[i] * t[i] * t[i]));
    }
    const double e = t[count - 1];
    quat_spline *s;
    const qvec3 last = qvec3_scale(n, 1 - 0.4 * e + 0.15 * e * e);
    assert_int_equal(quat_spline_new(count, t, q, QUAT_SPLINE_CLAMPED, n, last, &s), QUAT_OK);
    for (int k = 0; k <= 1000; k++) {
        const double x = e * k / 1000;
        qvec3 w, a;
        const quat at = quat_spline_state(s, x, &w, &a);
        worse(&worst, quat_rotation_distance(
                          at, quat_from_rotation_vector(qvec3_scale(n, x - 0.2 * x * x + 0.05 * x * x * x))));
        worse(&worst, qvec3_norm(qvec3_sub(w, qvec3_scale(n, 1 - 0.4 * x + 0.15 * x * x))));
        worse(&worst, 0.01 * qvec3_norm(qvec3_sub(a, qvec3_scale(n, -0.4 + 0.3 * x))));
        /* by arc length: the speed is positive throughout */
        const double length = x - 0.2 * x * x + 0.05 * x * x * x;
        worse(&worst, fabs(quat_spline_length(s, x) - length));
        worse(&worst, 0.1 * fabs(quat_spline_time_at(s, length) - x));
    }
    assert_bound("a cubic about one axis", worst, 2e-14);
    quat_spline_free(s);
}

static void periodic_splines_go_round(void **state)
{
    (void)state;
    random_state r = {102};
    double smooth = 0, again = 0;
    for (int round = 0; round < 10000; round++) {
        double t[count];
        quat q[count];
        random_keys(&r, 1.5, t, q);
        const size_t n = (size_t)(3 + round % (count - 3));
        q[n - 1] = round % 3 ? q[0] : quat_neg(q[0]);
        quat_spline *s;
        const quat_status status = quat_spline_new(n, t, q, QUAT_SPLINE_PERIODIC, zero, zero, &s);
        if (status == QUAT_NOT_CONVERGED) continue; /* the last step may be close to pi */
        assert_int_equal(status, QUAT_OK);
        qvec3 w[2], a[2];
        quat_spline_state(s, t[0], &w[0], &a[0]);
        quat_spline_state(s, t[n - 1], &w[1], &a[1]);
        worse(&smooth, qvec3_norm(qvec3_sub(w[0], w[1])) + qvec3_norm(qvec3_sub(a[0], a[1])) / (1 + qvec3_norm(a[0])));
        const double period = t[n - 1] - t[0], x = t[0] + 0.3 * period;
        for (int k = -2; k <= 2; k++) {
            worse(&again, quat_rotation_distance(quat_spline_at(s, x), quat_spline_at(s, x + k * period)));
            const quat before = quat_spline_at(s, t[0] + k * period - 1e-9),
                       after = quat_spline_at(s, t[0] + k * period + 1e-9);
            assert_true(quat_distance(before, after) < 1e-7); /* continuous on S^3 */
        }
        quat_spline_free(s);
    }
    assert_bound("velocity and acceleration round the loop", smooth, 1e-13);
    assert_bound("one period on", again, 1e-13);
}

static double cubic(double first, double a, double b, double s) { return s * (first + s * (a + s * b)); }

/* Turns about one axis stop and go back: the speed has kinks, of any place in the segment. r = first s + a s^2 + b s^3
 * in 0 ... 1 goes monotonically between the roots of its derivative. */
static void arc_length_to_and_fro(void **state)
{
    (void)state;
    random_state r = {73};
    double worst = 0, part = 0;
    for (int round = 0; round < 20000; round++) {
        const double turn = random_between(&r, -3, 3), first = random_between(&r, -1, 1) * random_scale(&r, -2, 1.5),
                     last = random_between(&r, -1, 1) * random_scale(&r, -2, 1.5);
        const double a = 3 * turn - 2 * first - last, b = first + last - 2 * turn, t[2] = {0, 1};
        const qvec3 axis = random_direction(&r);
        quat keys[2] = {quat_identity(), quat_from_rotation_vector(qvec3_scale(axis, turn))};
        quat_spline *s;
        assert_int_equal(
            quat_spline_new(2, t, keys, QUAT_SPLINE_CLAMPED, qvec3_scale(axis, first), qvec3_scale(axis, last), &s),
            QUAT_OK);
        /* roots of first + 2 a s + 3 b s^2, without cancellation */
        const double square = a * a - 3 * b * first, q = -(a + copysign(sqrt(fmax(square, 0)), a));
        const double root[2] = {square > 0 ? q / (3 * b) : 2, square > 0 ? first / q : 2};
        double at = random_between(&r, 0, 1), want[2] = {0, 0};
        for (int k = 0; k < 2; k++) {
            const double end = k ? at : 1;
            double stop[4] = {0, fmin(fmax(fmin(root[0], root[1]), 0), end), fmin(fmax(fmax(root[0], root[1]), 0), end),
                              end};
            for (int i = 0; i < 3; i++) want[k] += fabs(cubic(first, a, b, stop[i + 1]) - cubic(first, a, b, stop[i]));
        }
        const double size = fabs(turn) + fabs(first) + fabs(last);
        worse(&worst, fabs(quat_spline_length(s, INFINITY) - want[0]) / size);
        worse(&part, fabs(quat_spline_length(s, at) - want[1]) / size);
        quat_spline_free(s);
    }
    assert_bound("to and fro: the whole", worst, 2e-14);
    assert_bound("to and fro: a part", part, 2e-14);
}

static void arc_length(void **state)
{
    (void)state;
    random_state r = {103};
    double inverse = 0, sum = 0;
    for (int round = 0; round < 30; round++) {
        double t[count];
        quat q[count];
        random_keys(&r, 1.5, t, q);
        quat_spline *s;
        assert_int_equal(quat_spline_new(count, t, q, QUAT_SPLINE_NATURAL, zero, zero, &s), QUAT_OK);
        const double whole = quat_spline_length(s, INFINITY);
        double polygon = 0;
        quat last = quat_spline_at(s, t[0]);
        for (int k = 1; k <= 20000; k++) {
            const quat next = quat_spline_at(s, t[0] + (t[count - 1] - t[0]) * k / 20000);
            polygon += quat_rotation_distance(last, next);
            last = next;
        }
        worse(&sum, fabs(polygon / whole - 1));
        for (int k = 0; k < 700; k++) {
            const double l = whole * random_uniform(&r);
            worse(&inverse, fabs(quat_spline_length(s, quat_spline_time_at(s, l)) - l));
        }
        assert_true(quat_spline_time_at(s, -1) == t[0] && quat_spline_time_at(s, 2 * whole) == t[count - 1]);
        assert_true(quat_spline_length(s, t[0] - 1) == 0 && isnan(quat_spline_length(s, NAN)) &&
                    isnan(quat_spline_time_at(s, NAN)));
        quat_spline_free(s);
    }
    assert_bound("length against a polygon of 20000 sides", sum, 2e-7);
    assert_bound("length(time_at(l)) = l", inverse, 2e-14);
}

/* What turns between keys hangs on the times between them alone: times that are exact, 2^30 s later. */
static void the_clock_may_begin_anywhere(void **state)
{
    (void)state;
    const double late = ldexp(1, 30);
    random_state r = {107};
    for (int round = 0; round < 20; round++) {
        double t[count], later[count];
        quat q[count];
        random_keys(&r, 1.5, t, q);
        for (int i = 0; i < count; i++) t[i] = ldexp(rint(ldexp(t[i], 16)), -16), later[i] = late + t[i];
        quat_spline *s, *l;
        assert_int_equal(quat_spline_new(count, t, q, QUAT_SPLINE_NATURAL, zero, zero, &s), QUAT_OK);
        assert_int_equal(quat_spline_new(count, later, q, QUAT_SPLINE_NATURAL, zero, zero, &l), QUAT_OK);
        for (int k = 0; k < 10; k++) {
            const double at = ldexp(rint(ldexp(t[0] + (t[count - 1] - t[0]) * random_uniform(&r), 16)), -16);
            qvec3 omega[2], acceleration[2];
            assert_true(quat_equal(quat_spline_state(s, at, &omega[0], &acceleration[0]),
                                   quat_spline_state(l, late + at, &omega[1], &acceleration[1])));
            assert_true(qvec3_norm(qvec3_sub(omega[0], omega[1])) == 0);
            assert_true(qvec3_norm(qvec3_sub(acceleration[0], acceleration[1])) == 0);
            assert_true(quat_spline_length(s, at) == quat_spline_length(l, late + at));
        }
        quat_spline_free(s);
        quat_spline_free(l);
    }
}

static void outside_and_bad_input(void **state)
{
    (void)state;
    const double t[3] = {0, 1, 2}, back[3] = {0, 1, 1}, bad_t[3] = {0, NAN, 2};
    const quat q[3] = {{1, 0, 0, 0}, {0.8, 0.6, 0, 0}, {0.6, 0.8, 0, 0}},
               bad[3] = {{1, 0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}};
    quat_spline *s;
    qvec3 w, a;
    assert_int_equal(quat_spline_new(3, t, q, QUAT_SPLINE_NATURAL, zero, zero, &s), QUAT_OK);
    assert_true(quat_equal(quat_spline_state(s, -1, &w, &a), q[0]) && qvec3_norm(w) == 0 && qvec3_norm(a) == 0);
    assert_true(quat_equal(quat_spline_state(s, 3, &w, &a), q[2]) && qvec3_norm(w) == 0);
    assert_true(isnan(quat_spline_state(s, NAN, &w, &a).w) && isnan(w.x) && isnan(a.x));
    quat_spline_free(s);
    quat_spline_free(NULL);
    assert_int_equal(quat_spline_new(1, t, q, QUAT_SPLINE_NATURAL, zero, zero, &s), QUAT_EARGUMENT);
    assert_int_equal(quat_spline_new(2, t, q, QUAT_SPLINE_PERIODIC, zero, zero, &s), QUAT_EARGUMENT);
    assert_int_equal(quat_spline_new(3, t, q, QUAT_SPLINE_PERIODIC, zero, zero, &s), QUAT_EARGUMENT);
    assert_int_equal(quat_spline_new(3, back, q, QUAT_SPLINE_NATURAL, zero, zero, &s), QUAT_EARGUMENT);
    assert_int_equal(quat_spline_new(3, t, q, (quat_spline_end)9, zero, zero, &s), QUAT_EARGUMENT);
    assert_int_equal(quat_spline_new(3, bad_t, q, QUAT_SPLINE_NATURAL, zero, zero, &s), QUAT_EDOMAIN);
    assert_int_equal(quat_spline_new(3, t, bad, QUAT_SPLINE_NATURAL, zero, zero, &s), QUAT_EDOMAIN);
    assert_int_equal(quat_spline_new(3, t, q, QUAT_SPLINE_CLAMPED, qvec3_make(INFINITY, 0, 0), zero, &s), QUAT_EDOMAIN);
    assert_null(s);
    /* no hang and no NaN where times lie too close, too far or too unevenly, and where the ends turn too fast */
    const double close[3] = {0, 1e-310, 1}, far[3] = {-1.7e308, 0, 1.7e308}, uneven[3] = {0, 1e-12, 1};
    const qvec3 quick = {0, 1e12, 1e12};
    assert_int_equal(quat_spline_new(2, close, q, QUAT_SPLINE_CLAMPED, zero, zero, &s), QUAT_ERANGE);
    assert_int_equal(quat_spline_new(3, far, q, QUAT_SPLINE_NATURAL, zero, zero, &s), QUAT_ERANGE);
    assert_int_equal(quat_spline_new(3, uneven, q, QUAT_SPLINE_NATURAL, zero, zero, &s), QUAT_ERANGE);
    assert_int_equal(quat_spline_new(2, t, q, QUAT_SPLINE_CLAMPED, quick, zero, &s), QUAT_ERANGE);
    assert_null(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(splines_are_twice_smooth),  cmocka_unit_test(exact_where_it_must_be),
        cmocka_unit_test(periodic_splines_go_round), cmocka_unit_test(arc_length),
        cmocka_unit_test(arc_length_to_and_fro),     cmocka_unit_test(the_clock_may_begin_anywhere),
        cmocka_unit_test(outside_and_bad_input)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
