/* SPDX-License-Identifier: MIT */
#include "oracle.h"
#include <quat/exponential.h>
#include <quat/interpolate.h>
#include <quat/sequence.h>

static const double pi = 3.14159265358979323846;
static const quat one = {1, 0, 0, 0}, minus = {-1, 0, 0, 0};

static wide wide_pi(void) { return 4 * atan2f128(1, 1); }
static wquat wide_turn(wide half, wide x, wide y, wide z) { return wide_exp((wquat){0, half * x, half * y, half * z}); }

/* ---- the belt ---- */

/* exp(pi t j) exp(pi t (cos pi s j + sin pi s i)), as it stands */
static wquat wide_untwist(wide s, wide t)
{
    const wide p = wide_pi();
    return wide_mul(wide_turn(p * t, 0, 1, 0), wide_turn(p * t, sinf128(p * s), cosf128(p * s), 0));
}

static void untwisting_against_the_oracle(void **state)
{
    (void)state;
    random_state r = {201};
    double worst = 0, unit = 0;
    for (int n = 0; n < 100000; n++) {
        const double s = n % 5 ? random_uniform(&r) : random_scale(&r, -20, 0),
                     t = n % 7 ? random_uniform(&r) : 1 - random_scale(&r, -15, 0);
        const quat q = quat_belt_untwist(s, t);
        worse(&worst, error_of(q, wide_untwist(s, t)));
        worse(&unit, fabs(quat_norm(q) - 1) / ROUNDING);
    }
    assert_bound("the untwisting belt, u", worst, 6);
    assert_bound("its length, u", unit, 6);
    assert_true(isnan(quat_belt_untwist(NAN, 0.5).w) && isnan(quat_belt_untwist(0.5, INFINITY).w));
}

static void ends_are_held(void **state)
{
    (void)state;
    random_state r = {202};
    double first = 0, last = 0;
    for (int n = 0; n < 100000; n++) {
        const double x = random_uniform(&r);
        assert_true(quat_equal(quat_belt_untwist(x, 0), one) && quat_equal(quat_belt_untwist(x, 1), one));
        assert_true(quat_equal(quat_belt_untwist(1, x), one));
        worse(&last, qvec3_norm(qvec3_sub(quat_belt_centre(1, x), qvec3_make(0, x, 0))));
        worse(&first, quat_norm(quat_sub(quat_belt_untwist(0, x), quat_belt_twist(4 * pi, x))));
    }
    assert_bound("s = 0 is the twist of 4 pi", first, 2e-15);
    assert_bound("s = 1 is the straight belt", last, 0);
    /* the thesis' equation 15: 2 pi ends at -1, 4 pi at 1 */
    assert_true(quat_near(quat_belt_twist(2 * pi, 1), minus, 2e-16));
    assert_true(quat_near(quat_belt_twist(4 * pi, 1), one, 3e-16));
    assert_true(quat_equal(quat_belt_twist(2 * pi, 0), one));
    assert_true(quat_near(quat_belt_twist(pi, 1), quat_make(0, 0, 1, 0), 1e-16));
    /* and right it is by y alone */
    assert_true(qvec3_norm(qvec3_sub(quat_rotate(quat_belt_twist(pi, 0.5), qvec3_make(0, 0, 1)), qvec3_make(1, 0, 0))) <
                3e-16);
}

/* A homotopy: no jump in s or t, however fine; a curve to -1 would have to have one. */
static void untwisting_is_continuous(void **state)
{
    (void)state;
    enum { steps = 400 };
    double widest = 0;
    for (int a = 0; a <= steps; a++) {
        for (int b = 0; b < steps; b++) {
            const double s = (double)a / steps, t = (double)b / steps;
            const quat q = quat_belt_untwist(s, t);
            worse(&widest, quat_distance(q, quat_belt_untwist(s, t + 1.0 / steps)) * steps);
            if (a < steps) worse(&widest, quat_distance(q, quat_belt_untwist(s + 1.0 / steps, t)) * steps);
        }
    }
    assert_bound("speed of the untwisting on S^3", widest, 2 * pi + 1e-9);
}

static void centre_line_follows_the_frames(void **state)
{
    (void)state;
    random_state r = {203};
    const double h = 1e-5;
    double slope = 0, end = 0, sum = 0;
    for (int n = 0; n < 100000; n++) {
        const double s = random_uniform(&r), t = random_uniform(&r);
        const qvec3 d = qvec3_scale(qvec3_sub(quat_belt_centre(s, t + h), quat_belt_centre(s, t - h)), 0.5 / h);
        worse(&slope, qvec3_norm(qvec3_sub(d, quat_rotate(quat_belt_untwist(s, t), qvec3_make(0, 1, 0)))));
        const qvec3 free = {0.5 * sin(pi * s) * (1 - cos(pi * s)), cos(pi * s) * cos(pi * s), 0};
        worse(&end, qvec3_norm(qvec3_sub(quat_belt_centre(s, 1), free)));
    }
    /* and from 0 to any t by Gauss' five points on 64 parts */
    static const double node[5] = {-0.90617984593866399280, -0.53846931010568309104, 0, 0.53846931010568309104,
                                   0.90617984593866399280},
                        weight[5] = {0.23692688505618908751, 0.47862867049936646804, 0.56888888888888888889,
                                     0.47862867049936646804, 0.23692688505618908751};
    double part = 0;
    for (int n = 0; n < 2000; n++) {
        const double s = random_between(&r, -1, 2), t = random_between(&r, -1, 2), step = t / 128;
        qvec3 place = {0, 0, 0};
        for (int i = 0; i < 64; i++)
            for (int k = 0; k < 5; k++)
                place = qvec3_axpy(step * weight[k],
                                   quat_rotate(quat_belt_untwist(s, step * (2 * i + 1 + node[k])), qvec3_make(0, 1, 0)),
                                   place);
        worse(&part, qvec3_norm(qvec3_sub(place, quat_belt_centre(s, t))));
    }
    assert_bound("centre line to any t, any s, by quadrature", part, 5e-15);
    /* the slope is a trigonometric polynomial of degree 2: the mean of 8 values is its integral over the whole belt */
    for (int n = 0; n < 100; n++) {
        const double s = n / 99.0;
        qvec3 place = {0, 0, 0};
        for (int i = 0; i < 8; i++)
            place = qvec3_axpy(0.125, quat_rotate(quat_belt_untwist(s, 0.125 * i), qvec3_make(0, 1, 0)), place);
        worse(&sum, qvec3_norm(qvec3_sub(place, quat_belt_centre(s, 1))));
    }
    assert_bound("centre line's slope is q y q*", slope, 1e-8);
    assert_bound("the free end", end, 1e-15);
    assert_bound("centre line by quadrature", sum, 1e-15);
    quat q[3];
    qvec3 c[3];
    quat_belt_frames(0.3, 3, q, c);
    assert_true(quat_equal(q[1], quat_belt_untwist(0.3, 0.5)) && quat_equal(q[2], one));
    assert_true(c[1].x == quat_belt_centre(0.3, 0.5).x && qvec3_norm(c[0]) == 0);
    assert_true(
        isfinite(qvec3_norm(qvec3_scale(quat_belt_centre(0.3, -1e308), 1e-300)))); /* any t: 2 t is no number there */
    quat_belt_frames(0.3, 1, NULL, c);
    quat_belt_frames(0.3, 0, NULL, NULL);
    assert_true(qvec3_norm(c[0]) == 0);
}

/* ---- spinor discs ---- */

static void arrows_end_where_the_spinor_is(void **state)
{
    (void)state;
    random_state r = {204};
    double arrows[16], place = 0, sums = 0;
    for (int n = 0; n < 100000; n++) {
        const double angle = random_between(&r, -12 * pi, 12 * pi);
        const size_t count = quat_spinor_arrows(angle, 16, arrows);
        assert_int_equal(count, (size_t)ceil(fabs(angle) / pi));
        double sum = 0;
        for (size_t k = 0; k < count; k++) {
            assert_true(fabs(arrows[k]) <= pi);
            sum += arrows[k];
        }
        worse(&sums, fabs(sum - quat_spinor_place(angle)));
        worse(&place, fabs(fabs(quat_spinor_place(angle)) - 2 * quat_distance(one, quat_belt_twist(angle, 1))));
    }
    assert_bound("the arrows' sum", sums, 2e-14);
    assert_bound("place = 2 distance on S^3", place, 1e-14);
    /* figures 7a, 7b, 8 and 9 */
    assert_int_equal(quat_spinor_arrows(0, 16, arrows), 0);
    assert_int_equal(quat_spinor_arrows(pi, 16, arrows), 1);
    assert_true(arrows[0] == pi && quat_spinor_place(pi) == pi);
    assert_int_equal(quat_spinor_arrows(-2 * pi, 16, arrows), 2);
    assert_true(arrows[0] == -pi && arrows[1] == -pi && quat_spinor_place(-2 * pi) == -2 * pi);
    assert_int_equal(quat_spinor_arrows(4 * pi, 16, arrows), 4);
    assert_true(arrows[0] == pi && arrows[1] == pi && arrows[2] == -pi && arrows[3] == -pi &&
                quat_spinor_place(4 * pi) == 0);
    for (int n = 1; n < 1000; n++) assert_int_equal(quat_spinor_arrows(n * pi, 0, NULL), n);
    assert_int_equal(quat_spinor_arrows(NAN, 16, arrows), 0);
    assert_int_equal(quat_spinor_arrows(INFINITY, 16, arrows), 0);
    assert_true(isnan(quat_spinor_place(INFINITY)));
}

/* ---- bands ---- */

static void only_four_rounds_bring_the_spinor_back(void **state)
{
    (void)state;
    const quat start = quat_band(pi, 0);
    const qvec3 z = {0, 0, 1};
    assert_true(quat_near(quat_band(pi, 1), quat_make(0, 0, -1, 0), 2e-16));
    assert_true(quat_rotate(quat_band(pi, 1), z).z == -1);
    assert_true(quat_near(quat_band(pi, 2), quat_neg(start), 2e-16));
    assert_true(quat_near(quat_band(pi, 4), start, 4e-16));
    assert_true(quat_near(quat_band(0, 1), minus, 0)); /* one round without a twist, too, is a full turn */
    random_state r = {205};
    double worst = 0;
    for (int n = 0; n < 100000; n++) {
        const double twist = random_between(&r, -10, 10), u = random_between(&r, 0, 4);
        const wquat want =
            wide_mul(wide_turn(wide_pi() * (wide)u, 0, 0, 1), wide_turn((wide)twist * (wide)u / 2, 0, 1, 0));
        worse(&worst, error_of(quat_band(twist, u), want) / (1 + fabs(0.5 * twist * u)));
    }
    assert_bound("frame of a band, u for each radian of the twist", worst, 4);

    enum { count = 401 };
    quat q[count];
    for (int rounds = 1; rounds <= 4; rounds++) {
        for (int i = 0; i < count; i++) {
            q[i] = quat_band(pi, rounds * i / (count - 1.0));
            if (random_uniform(&r) < 0.5) q[i] = quat_neg(q[i]);
        }
        const int sign = quat_loop_sign(count, q);
        int unflipped;
        quat_unflip(count, q, &unflipped);
        if (rounds % 2 == 0) assert_int_equal(sign, rounds == 2 ? -1 : 1);
        if (rounds % 2 == 0) assert_int_equal(sign, unflipped);
    }
    assert_int_equal(quat_loop_sign(0, NULL), 1);
    assert_int_equal(quat_loop_sign(1, q), 1);
}

/* ---- the ball ---- */

static void a_circle_of_the_hand_turns_the_ball(void **state)
{
    (void)state;
    random_state r = {206};
    double worst = 0, rate = 0, loop = 0, exact = 0;
    for (int n = 0; n < 100000; n++) {
        const double radius = n % 2 ? random_between(&r, 0, 3) : random_scale(&r, -8, 1),
                     angle = random_between(&r, -20, 20);
        const wide half = (wide)angle / 2;
        const wquat want = wide_mul(wide_turn(half, 0, 0, 1), wide_turn(half, -(wide)radius, 0, -1));
        worse(&worst, error_of(quat_roll_circle(radius, angle), want) / (1 + fabs(angle) * (1 + radius)));

        /* its angular velocity is z x the hand's velocity */
        const double h = 1e-5;
        const quat q = quat_roll_circle(radius, angle),
                   dq = quat_scale(quat_sub(quat_roll_circle(radius, angle + h), quat_roll_circle(radius, angle - h)),
                                   0.5 / h);
        const qvec3 omega = {-radius * cos(angle), -radius * sin(angle), 0};
        worse(&rate, qvec3_norm(qvec3_sub(quat_omega_world(q, dq), omega)) / (1 + radius * radius * radius));

        const qvec3 net = quat_roll_loop(radius);
        worse(&loop,
              quat_rotation_distance(quat_from_rotation_vector(net), quat_roll_circle(radius, 2 * pi)) / (1 + radius));
        const wide size = sqrtf128(1 + (wide)radius * (wide)radius),
                   part = 2 * wide_pi() * (wide)radius * (wide)radius / (size * (size + 1));
        worse(&exact, error_of_scalar(net.x, -(wide)radius * part));
        worse(&exact, error_of_scalar(net.z, -part));
    }
    assert_bound("circle of the hand, u for each radian", worst, 4);
    assert_bound("its angular velocity", rate, 1e-8);
    assert_bound("one loop", loop, 1e-14);
    assert_bound("net turn of one loop, u", exact, 8);
    assert_true(qvec3_norm(quat_roll_loop(0)) == 0 && isfinite(quat_roll_loop(1e300).x));
}

/* The thesis' hand, sin f x - cos f y, goes counter-clockwise and the ball clockwise: the appendix's code, and its
 * limit. */
static void the_ball_trick(void **state)
{
    (void)state;
    quat q = one;
    for (int n = 1; n <= 100; n++) {
        const double a = n * pi / 50, half = pi / 500;
        q = quat_mul(quat_make(cos(half), sin(half) * sin(a), -sin(half) * cos(a), 0), q);
    }
    quat swing, twist;
    quat_swing_twist(q, qvec3_make(0, 0, 1), &swing, &twist);
    assert_true(fabs(2 * atan2(twist.z, twist.w) * 180 / pi + 6.989) < 5e-4);

    /* the hand's places of those strokes: z x d is the axis times the angle */
    qvec2 hand[101] = {{0, 0}};
    quat path[101];
    for (int n = 1; n <= 100; n++) {
        const double a = n * pi / 50, d = pi / 250;
        hand[n] = qvec2_make(hand[n - 1].x - d * cos(a), hand[n - 1].y - d * sin(a));
    }
    quat_roll_path(one, 101, hand, path);
    assert_true(quat_near(path[100], q, 1e-14));
    assert_true(hypot(hand[100].x, hand[100].y) < 1e-14);
    double area = 0;
    for (int n = 1; n <= 100; n++) area += 0.5 * (hand[n - 1].x * hand[n].y - hand[n].x * hand[n - 1].y);
    assert_true(area > 0); /* counter-clockwise */

    /* many strokes on a circle come to the closed form, quadratically */
    double before = 0;
    for (int strokes = 100; strokes <= 1600; strokes *= 2) {
        quat p = one;
        for (int n = 0; n < strokes; n++) {
            const double from = 2 * pi * n / strokes, to = 2 * pi * (n + 1) / strokes;
            p = quat_roll(p, 0.7 * (cos(to) - cos(from)), 0.7 * (sin(to) - sin(from)));
        }
        const double off = quat_rotation_distance(p, quat_roll_circle(0.7, 2 * pi));
        if (before > 0) assert_true(fabs(before / off - 4) < 0.02);
        before = off;
    }
}

/* -90 degrees about y, 90 about x, 90 about y: -90 about z; and what two reflections are. */
static void three_turns_and_two_mirrors(void **state)
{
    (void)state;
    const double h = sqrt(0.5);
    const qvec3 turns[3] = {{0, -pi / 2, 0}, {pi / 2, 0, 0}, {0, pi / 2, 0}};
    quat out[13];
    assert_int_equal(quat_chain(one, 3, turns, QUAT_WORLD, 4, out), QUAT_OK);
    assert_true(quat_near(out[12], quat_make(h, 0, 0, -h), 3e-16));
    random_state r = {207};
    double mirrors = 0, theorem = 0, cover = 0;
    for (int n = 0; n < 100000; n++) {
        const qvec3 a = random_direction(&r), b = random_direction(&r), v = random_direction(&r);
        const quat product = quat_mul(quat_pure(b), quat_pure(a)), q = quat_from_reflections(a, b);
        worse(&theorem, quat_norm(quat_add(product, q)));
        worse(&theorem, fabs(q.w - qvec3_dot(a, b)));
        worse(&mirrors, qvec3_norm(qvec3_sub(quat_rotate(product, v), quat_reflect(b, quat_reflect(a, v)))));
        /* equation 9: every point of S^3 is (cos f/2, sin f/2 n) for one f in 0 ... 2 pi; f + 2 pi gives
         * the opposite */
        const quat p = random_unit(&r);
        const double half = atan2(qvec3_norm(quat_vector(p)), p.w);
        qvec3 axis;
        qvec3_normalize(quat_vector(p), &axis);
        assert_true(half >= 0 && half <= pi);
        worse(&cover, quat_norm(quat_sub(quat_from_parts(cos(half), qvec3_scale(axis, sin(half))), p)));
        worse(&cover, quat_norm(quat_add(quat_from_parts(cos(half + pi), qvec3_scale(axis, sin(half + pi))), p)));
    }
    assert_bound("q2 q1 = -(cos, sin p)", theorem, 1e-15);
    assert_bound("two mirrors are the rotation", mirrors, 2e-15);
    assert_bound("equation 9 covers S^3 once", cover, 1e-15);
}

/* ---- chains ---- */

static void chains_are_products_of_exponentials(void **state)
{
    (void)state;
    enum { legs = 5, parts = 7 };
    random_state r = {208};
    double world = 0, body = 0, step = 0;
    for (int n = 0; n < 3000; n++) {
        qvec3 turns[legs];
        quat out[legs * parts + 1], inside[legs * parts + 1];
        const quat start = random_unit(&r);
        for (int i = 0; i < legs; i++) turns[i] = random_vector(&r, random_between(&r, 0, 4 * pi));
        assert_int_equal(quat_chain(quat_scale(start, 3), legs, turns, QUAT_WORLD, parts, out), QUAT_OK);
        assert_int_equal(quat_chain(start, legs, turns, QUAT_BODY, parts, inside), QUAT_OK);
        wquat w = wide_quat(start), b = w;
        for (int i = 0; i < legs; i++) {
            for (int k = 1; k <= parts; k++) {
                const wquat e = wide_exp(wide_scale(wide_vec(turns[i]), (wide)k / parts / 2));
                worse(&world, (double)wide_norm(wide_sub(wide_quat(out[i * parts + k]), wide_mul(e, w))));
                worse(&body, (double)wide_norm(wide_sub(wide_quat(inside[i * parts + k]), wide_mul(b, e))));
                worse(&step,
                      quat_distance(out[i * parts + k - 1], out[i * parts + k]) - qvec3_norm(turns[i]) / parts / 2);
            }
            const wquat e = wide_exp(wide_scale(wide_vec(turns[i]), 0.5));
            w = wide_mul(e, w);
            b = wide_mul(b, e);
        }
    }
    assert_bound("chain about world axes", world, 5e-15);
    assert_bound("chain about body axes", body, 5e-15);
    assert_bound("each step as long as its part of the turn", step, 1e-14);
    const qvec3 bad = {NAN, 0, 0}, twice = {0, 0, 4 * pi};
    quat out[3];
    assert_int_equal(quat_chain(one, 1, &bad, QUAT_WORLD, 2, out), QUAT_EDOMAIN);
    assert_true(quat_equal(out[2], one));
    assert_int_equal(quat_chain(quat_make(0, 0, 0, 0), 1, &twice, QUAT_WORLD, 2, out), QUAT_EDOMAIN);
    assert_int_equal(quat_chain(one, 1, &twice, QUAT_WORLD, 0, out), QUAT_EARGUMENT);
    assert_int_equal(quat_chain(one, 1, &twice, (quat_frame)7, 2, out), QUAT_EARGUMENT);
    assert_int_equal(quat_chain(one, 1, &twice, QUAT_WORLD, 2, out), QUAT_OK);
    assert_true(quat_near(out[1], minus, 2e-16) && quat_near(out[2], one, 3e-16));
    assert_int_equal(quat_chain(minus, 0, NULL, QUAT_WORLD, 2, out), QUAT_OK);
    assert_true(quat_equal(out[0], minus));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(untwisting_against_the_oracle),
        cmocka_unit_test(ends_are_held),
        cmocka_unit_test(untwisting_is_continuous),
        cmocka_unit_test(centre_line_follows_the_frames),
        cmocka_unit_test(arrows_end_where_the_spinor_is),
        cmocka_unit_test(only_four_rounds_bring_the_spinor_back),
        cmocka_unit_test(a_circle_of_the_hand_turns_the_ball),
        cmocka_unit_test(the_ball_trick),
        cmocka_unit_test(three_turns_and_two_mirrors),
        cmocka_unit_test(chains_are_products_of_exponentials),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
