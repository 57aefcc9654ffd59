/* SPDX-License-Identifier: MIT
 *
 * Flight in closed form against the same in long double, by another formula; when a parabola falls to zero, against its
 * roots.
 */
#include <impact/flight.h>
#include <quat/rotation.h>
#include "kit/contact_random.h"
#include "kit/near.h"

static double any_sign(random_stream *random, double size) { return random_bits(random) & 1 ? size : -size; }

/* ---- impact_flight_after ---- */

static long double ballistic(double x, double v, double g, double dt)
{
    return (long double)x + (long double)v * dt + (long double)g * dt * dt / 2;
}

/* v turned about the unit axis by the angle: Rodrigues' formula, in long double. */
static qvec3 rodrigues(qvec3 v, qvec3 omega, double dt)
{
    const long double w =
        sqrtl((long double)omega.x * omega.x + (long double)omega.y * omega.y + (long double)omega.z * omega.z);
    const long double c = cosl(w * dt), s = sinl(w * dt);
    const long double k[3] = {omega.x / w, omega.y / w, omega.z / w}, u[3] = {v.x, v.y, v.z};
    const long double dot = k[0] * u[0] + k[1] * u[1] + k[2] * u[2];
    long double turned[3];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, l = (i + 2) % 3;
        turned[i] = u[i] * c + (k[j] * u[l] - k[l] * u[j]) * s + k[i] * dot * (1 - c);
    }
    return (qvec3){(double)turned[0], (double)turned[1], (double)turned[2]};
}

static void assert_close_at_scale(double got, long double wanted, double scale)
{
    assert_near(got, (double)wanted, 4e-16 * scale);
}

static void centre_and_turn_against_long_double(void **state)
{
    (void)state;
    random_stream random = {1};
    for (int i = 0; i < 20000; i++) {
        const impact_flight start = {random_vector(&random, 1e-6, 1e6), random_rotation(&random),
                                     random_vector(&random, 1e-6, 1e6), random_vector(&random, 1e-9, 1e2)};
        const qvec3 gravity = random_vector(&random, 1e-3, 1e3);
        const double dt = any_sign(&random, random_log(&random, 1e-9, 1e2));
        const impact_flight end = impact_flight_after(start, gravity, dt);
        const double x_scale =
            qvec3_norm(start.position) + fabs(dt) * qvec3_norm(start.velocity) + dt * dt * qvec3_norm(gravity);
        const double v_scale = qvec3_norm(start.velocity) + fabs(dt) * qvec3_norm(gravity);
        assert_close_at_scale(end.position.x, ballistic(start.position.x, start.velocity.x, gravity.x, dt), x_scale);
        assert_close_at_scale(end.position.y, ballistic(start.position.y, start.velocity.y, gravity.y, dt), x_scale);
        assert_close_at_scale(end.position.z, ballistic(start.position.z, start.velocity.z, gravity.z, dt), x_scale);
        assert_close_at_scale(end.velocity.x, ballistic(start.velocity.x, gravity.x, 0, dt), v_scale);
        assert_close_at_scale(end.velocity.y, ballistic(start.velocity.y, gravity.y, 0, dt), v_scale);
        assert_close_at_scale(end.velocity.z, ballistic(start.velocity.z, gravity.z, 0, dt), v_scale);
        assert_near3(end.omega, start.omega, 0);
        assert_near(quat_dot(end.orientation, end.orientation), 1, 5e-16);
        const qvec3 arm = random_direction(&random);
        const double angle = fabs(dt) * qvec3_norm(start.omega); /* its own rounding turns by this much too */
        assert_near3(quat_rotate(end.orientation, arm), rodrigues(quat_rotate(start.orientation, arm), start.omega, dt),
                     3e-15 + 4e-16 * angle);
    }
}

static void forth_and_back_and_in_two_pieces(void **state)
{
    (void)state;
    random_stream random = {2};
    for (int i = 0; i < 5000; i++) {
        const impact_flight start = {random_vector(&random, 0.1, 10), random_rotation(&random),
                                     random_vector(&random, 0.1, 10), random_vector(&random, 0.1, 10)};
        const qvec3 gravity = random_vector(&random, 0.1, 10);
        const double a = 2 * random_unit(&random), b = 2 * random_unit(&random);
        const impact_flight back = impact_flight_after(impact_flight_after(start, gravity, a), gravity, -a);
        assert_near3(back.position, start.position, 5e-14);
        assert_near3(back.velocity, start.velocity, 1e-14);
        assert_near(fabs(quat_dot(back.orientation, start.orientation)), 1, 1e-15);
        const impact_flight whole = impact_flight_after(start, gravity, a + b);
        const impact_flight pieces = impact_flight_after(impact_flight_after(start, gravity, a), gravity, b);
        assert_near3(pieces.position, whole.position, 2e-13);
        assert_near(fabs(quat_dot(pieces.orientation, whole.orientation)), 1, 1e-15);
    }
}

static void no_time_and_no_turning_change_nothing(void **state)
{
    (void)state;
    const impact_flight start = {{1, 2, 3}, {0.6, 0, 0.8, 0}, {4, 5, 6}, {7, 8, 9}};
    const impact_flight same = impact_flight_after(start, (qvec3){0, 0, -9.81}, 0);
    assert_near3(same.position, start.position, 0);
    assert_near3(same.velocity, start.velocity, 0);
    assert_near(quat_dot(same.orientation, start.orientation), 1, 3e-16);
    impact_flight still = start;
    still.omega = (qvec3){0, 0, 0};
    const impact_flight later = impact_flight_after(still, (qvec3){0, 0, 0}, 10);
    assert_near3(later.position, (qvec3){41, 52, 63}, 0);
    assert_near(quat_dot(later.orientation, start.orientation), 1, 3e-16);
}

/* ---- impact_flight_fall_time ---- */

/* Smallest t >= 0 where a + b t + c t^2/2 falls: from its lowest and highest points, by bisection in long double. */
static long double fall_by_bisection(double a, double b, double c)
{
    const long double turn = c != 0 ? -(long double)b / c : 0;
    long double low = 0, high;
    if (c < 0) {
        if (turn > 0) low = turn; /* up to the top, down from there */
        high = low + 1;
        while (a + high * (b + 0.5L * c * high) > 0) high = low + 2 * (high - low);
    } else {
        if (b >= 0) return INFINITY;
        high = c > 0 ? turn : -2 * (long double)a / b;
        if (a + high * (b + 0.5L * c * high) > 0) return INFINITY;
    }
    for (int i = 0; i < 200; i++) {
        const long double middle = (low + high) / 2;
        *(a + middle * (b + 0.5L * c * middle) > 0 ? &low : &high) = middle;
    }
    return (low + high) / 2;
}

static void fall_time_against_bisection(void **state)
{
    (void)state;
    random_stream random = {3};
    int falls = 0, never = 0;
    for (int i = 0; i < 30000; i++) {
        const double a = random_log(&random, 1e-12, 1e3);
        const double b = any_sign(&random, random_log(&random, 1e-9, 1e3));
        const double c = any_sign(&random, random_log(&random, 1e-6, 1e3));
        const long double d = (long double)b * b - 2 * (long double)a * c;
        const double got = impact_flight_fall_time(a, b, c);
        const long double wanted = fall_by_bisection(a, b, c);
        if (fabsl(d) < 1e-12L * b * b) continue; /* grazing: whether it falls is not for doubles to say */
        if (isinf(wanted)) {
            never++;
            assert_true(isinf(got) && got > 0);
            continue;
        }
        falls++;
        /* The time's sensitivity to a rounding of b^2 or 2 a c. */
        const double sensitivity = (double)((b * b + 2 * fabs(a * c)) / fabsl(d));
        assert_near(got, (double)wanted, 4e-16 * (double)wanted * (1 + sensitivity));
    }
    assert_true(falls > 10000 && never > 5000);
}

static void fall_time_where_something_is_zero(void **state)
{
    (void)state;
    assert_true(impact_flight_fall_time(0, -1, 5) == 0); /* falls at once */
    assert_true(impact_flight_fall_time(0, 0, -5) == 0);
    assert_true(isinf(impact_flight_fall_time(0, 0, 0))); /* stays */
    assert_true(isinf(impact_flight_fall_time(0, 0, 5))); /* opens */
    assert_true(isinf(impact_flight_fall_time(0, 2, 0)));
    assert_true(impact_flight_fall_time(0, 2, -8) == 0.5);    /* opens, and falls later */
    assert_true(impact_flight_fall_time(-0.1, 2, -8) == 0.5); /* a rounding below zero is zero */
    assert_true(impact_flight_fall_time(-0.1, -2, 8) == 0);
    assert_true(isinf(impact_flight_fall_time(3, 0, 0)));
    assert_true(impact_flight_fall_time(3, -2, 0) == 1.5);
    assert_true(isinf(impact_flight_fall_time(3, 2, 0)));
    assert_true(isinf(impact_flight_fall_time(3, 0, 2)));
    assert_true(impact_flight_fall_time(8, 0, -4) == 2);
    assert_true(impact_flight_fall_time(2, -4, 4) == 1);           /* touches */
    assert_true(isinf(impact_flight_fall_time(2, -4, 4.0000001))); /* does not */
}

/* Units scale out: lengths by 2^i, times by 2^j, to the bit. */
static void fall_time_scales_with_the_units(void **state)
{
    (void)state;
    random_stream random = {4};
    for (int i = 0; i < 5000; i++) {
        const double a = random_unit(&random), b = 2 * random_unit(&random) - 1, c = 2 * random_unit(&random) - 1;
        const int length = (int)(random_bits(&random) % 201) - 100, time = (int)(random_bits(&random) % 101) - 50;
        const double one = impact_flight_fall_time(a, b, c);
        const double other =
            impact_flight_fall_time(ldexp(a, length), ldexp(b, length - time), ldexp(c, length - 2 * time));
        assert_true(isinf(one) ? isinf(other) : other == ldexp(one, time));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(centre_and_turn_against_long_double),   cmocka_unit_test(forth_and_back_and_in_two_pieces),
        cmocka_unit_test(no_time_and_no_turning_change_nothing), cmocka_unit_test(fall_time_against_bisection),
        cmocka_unit_test(fall_time_where_something_is_zero),     cmocka_unit_test(fall_time_scales_with_the_units),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
