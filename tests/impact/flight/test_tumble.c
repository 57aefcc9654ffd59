/* SPDX-License-Identifier: MIT
 *
 * Torque-free rotation against Taylor series in 128-bit arithmetic (libquadmath), and against what it keeps.
 */
#include <impact/tumble.h>
#include <stdio.h>
#include <stdlib.h>
#include <quat/rotation.h>
#include "kit/contact_random.h"
#include "kit/figures.h"
#include "kit/near.h"

#ifdef HAVE_QUADMATH
#include "tumble_oracle.h"
#endif

typedef struct body {
    qvec3 moments, momentum;
    quat orientation;
} body;

/* The families: what is special about the moments or the momentum. */
enum {
    GENERAL,
    TWO_EQUAL,
    NEARLY_EQUAL,
    ALL_NEARLY_EQUAL,
    LONG_AND_FLAT,
    ABOUT_AN_AXIS,
    ABOUT_THE_MIDDLE,
    SEPARATRIX,
    FAMILIES
};

static double small(random_stream *random)
{
    const double size = random_log(random, 1e-17, 1);
    return size * (random_unit(random) - 0.5);
}

static qvec3 permuted(qvec3 a, int turn)
{
    const double v[3] = {a.x, a.y, a.z};
    const int way = turn < 3 ? 1 : 2;
    return (qvec3){v[turn % 3], v[(turn + way) % 3], v[(turn + 2 * way) % 3]};
}

static body random_body(random_stream *random, int family)
{
    qvec3 moments = {random_log(random, 0.3, 3), random_log(random, 0.3, 3), random_log(random, 0.3, 3)};
    qvec3 inside = random_direction(random); /* momentum, body axes */
    if (family == TWO_EQUAL) moments.y = moments.x;
    if (family == NEARLY_EQUAL) moments.y = moments.x * (1 + random_log(random, 1e-17, 1e-1));
    if (family == ALL_NEARLY_EQUAL) {
        const double off = random_log(random, 1e-17, 1e-1);
        moments = (qvec3){1, 1 + off, 1 + 2 * off * random_unit(random)};
    }
    if (family == LONG_AND_FLAT) {
        moments.x = random_log(random, 1e-5, 1);
        moments.z = moments.x + moments.y * random_unit(random); /* a real body's: no more than the sum */
        inside = qvec3_scale(inside, fmin(moments.x, 1));
    }
    if (family >= ABOUT_AN_AXIS) moments = (qvec3){1, 2, 3};
    if (family == ABOUT_AN_AXIS) inside = (qvec3){1, small(random), small(random)};
    if (family == ABOUT_THE_MIDDLE) inside = (qvec3){small(random), 1, small(random)};
    if (family == SEPARATRIX) inside = (qvec3){1 + small(random), 2 * random_unit(random) - 1, sqrt(3)};
    const int turn = (int)(random_bits(random) % 6);
    body b = {.moments = permuted(moments, turn), .orientation = random_rotation(random)};
    b.momentum = quat_rotate(b.orientation, permuted(inside, turn));
    return b;
}

static double fastest(const body *b)
{
    return qvec3_norm(b->momentum) / fmin(b->moments.x, fmin(b->moments.y, b->moments.z));
}

static impact_tumble make(const body *b)
{
    impact_tumble tumble;
    assert_int_equal(impact_tumble_make(b->moments, b->orientation, b->momentum, &tumble), IMPACT_OK);
    return tumble;
}

static double energy(const impact_tumble *tumble, double t)
{
    return 0.5 * qvec3_dot(tumble->momentum, impact_tumble_omega(tumble, t));
}

/* The body carries the momentum that it was given, and its energy, for a thousand radians and for a billion. */
static void what_is_kept(void **state)
{
    (void)state;
    random_stream random = {1};
    for (int i = 0; i < 40000; i++) {
        const body b = random_body(&random, i % FAMILIES);
        const impact_tumble tumble = make(&b);
        const double later = random_log(&random, 1e-3, 1e9) / fastest(&b),
                     t = random_bits(&random) & 1 ? later : -later;
        const quat q = impact_tumble_at(&tumble, t);
        assert_near(quat_norm(q), 1, 3e-16);
        assert_near(energy(&tumble, t), energy(&tumble, 0), 1e-13 * energy(&tumble, 0));
        /* L = R J omega, to rounding whatever the moments: omega in the body's axes has it in each component */
        const qvec3 omega = impact_tumble_omega_body(&tumble, t);
        const qvec3 inside = {omega.x * b.moments.x, omega.y * b.moments.y, omega.z * b.moments.z};
        assert_near3(quat_rotate(q, inside), b.momentum, 1e-14 * qvec3_norm(b.momentum));
    }
}

/* omega is the rate of the orientation: no formula of the angle about the momentum is in it. */
static void omega_is_the_rate(void **state)
{
    (void)state;
    random_stream random = {2};
    for (int i = 0; i < 8000; i++) {
        const body b = random_body(&random, i % FAMILIES);
        const impact_tumble tumble = make(&b);
        const double t = 30 * (2 * random_unit(&random) - 1) / fastest(&b), h = 1e-2 / fastest(&b);
        quat rate = {0, 0, 0, 0}; /* differences of order 6 */
        const double weight[3] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
        for (int k = 0; k < 3; k++)
            rate = quat_axpy(
                weight[k] / h,
                quat_sub(impact_tumble_at(&tumble, t + (k + 1) * h), impact_tumble_at(&tumble, t - (k + 1) * h)), rate);
        const quat twice = quat_scale(quat_mul(rate, quat_conj(impact_tumble_at(&tumble, t))), 2);
        assert_near3(quat_vector(twice), impact_tumble_omega(&tumble, t), 2e-12 * fastest(&b));
    }
}

static void forth_and_back_and_in_two_pieces(void **state)
{
    (void)state;
    random_stream random = {3};
    for (int i = 0; i < 8000; i++) {
        const body b = random_body(&random, i % ABOUT_THE_MIDDLE);
        const impact_tumble tumble = make(&b);
        const double s = 10 * random_unit(&random) / fastest(&b), t = 10 * random_unit(&random) / fastest(&b);
        body there = b;
        there.orientation = impact_tumble_at(&tumble, s);
        const impact_tumble onward = make(&there);
        assert_near(quat_distance(impact_tumble_at(&onward, t), impact_tumble_at(&tumble, s + t)), 0, 2e-14);
        assert_near(quat_distance(impact_tumble_at(&onward, -s), tumble.orientation), 0, 2e-14);
        assert_near(quat_distance(impact_tumble_at(&tumble, 0), tumble.orientation), 0, 5e-16);
    }
}

/* Units scale out; the angle about the momentum does not know the axes' names; a turned laboratory is turned. */
static void the_same_in_other_words(void **state)
{
    (void)state;
    random_stream random = {4};
    for (int i = 0; i < 4000; i++) {
        const body b = random_body(&random, i % ABOUT_THE_MIDDLE);
        const double t = 20 * random_unit(&random) / fastest(&b);
        const impact_tumble tumble = make(&b);
        const quat wanted = impact_tumble_at(&tumble, t);
        const int mass = (int)(random_bits(&random) % 41) - 20, time = (int)(random_bits(&random) % 41) - 20;
        const body scaled = {qvec3_scale(b.moments, ldexp(1, mass)), qvec3_scale(b.momentum, ldexp(1, mass - time)),
                             b.orientation};
        const impact_tumble other = make(&scaled);
        assert_near(quat_distance(impact_tumble_at(&other, ldexp(t, time)), wanted), 0, 0);
        const quat laboratory = random_rotation(&random);
        const body turned = {b.moments, quat_rotate(laboratory, b.momentum), quat_mul(laboratory, b.orientation)};
        const impact_tumble elsewhere = make(&turned);
        assert_near(quat_distance(impact_tumble_at(&elsewhere, t), quat_mul(laboratory, wanted)), 0, 3e-14);
    }
}

/* Two equal moments: the textbook's precession about L at |L|/I1 and spin at (1/I3 - 1/I1) L3 about the axis. */
static void symmetric_top(void **state)
{
    (void)state;
    random_stream random = {5};
    for (int i = 0; i < 4000; i++) {
        const double across = random_log(&random, 0.3, 3), along = random_log(&random, 0.3, 3);
        const quat q = random_rotation(&random);
        const qvec3 momentum = random_direction(&random);
        const impact_tumble tumble = make(&(body){{across, across, along}, momentum, q});
        const double t = 10 * random_unit(&random), inside = quat_rotate_inverse(q, momentum).z;
        const quat precession = quat_from_rotation_vector(qvec3_scale(momentum, t / across));
        const quat spin = quat_from_rotation_vector((qvec3){0, 0, t * inside * (1 / along - 1 / across)});
        assert_near(quat_distance(impact_tumble_at(&tumble, t), quat_mul(precession, quat_mul(q, spin))), 0, 2e-14);
    }
}

static void on_the_unstable_axis(void **state)
{
    (void)state;
    const impact_tumble still = make(&(body){{1, 2, 3}, {0, 0, 0}, {0, 0, 2, 0}});
    assert_near(quat_distance(impact_tumble_at(&still, 1e9), (quat){0, 0, 1, 0}), 0, 0);
    assert_near3(impact_tumble_omega(&still, 1), (qvec3){0, 0, 0}, 0);
    const impact_tumble spin = make(&(body){{1, 2, 3}, {0, 4, 0}, {1, 0, 0, 0}});
    assert_true(isinf(impact_tumble_period(&spin)));
    assert_near3(impact_tumble_omega(&spin, 1e3), (qvec3){0, 2, 0}, 0);
    assert_near(quat_rotation_distance(impact_tumble_at(&spin, 0.5), (quat){cos(0.5), 0, sin(0.5), 0}), 0, 1e-15);
    /* The separatrix itself, rho l3^2 = sigma l1^2 without rounding: it comes to the unstable axis and stays. */
    const impact_tumble separatrix = make(&(body){{2, 3, 6}, {1, 0, 1}, {1, 0, 0, 0}});
    assert_true(isinf(impact_tumble_period(&separatrix)));
    const quat late = impact_tumble_at(&separatrix, 1e5);
    const qvec3 l = quat_rotate_inverse(late, separatrix.momentum);
    assert_near(fabs(l.y), sqrt(2), 1e-15);
    assert_near(l.x * l.x + l.z * l.z, 0, 1e-30);
}

static void tiny_and_huge(void **state)
{
    (void)state;
    random_stream random = {6};
    for (int i = 0; i < 2000; i++) {
        body b = random_body(&random, i % ABOUT_THE_MIDDLE);
        const impact_tumble tumble = make(&b);
        const double t = 20 * random_unit(&random) / fastest(&b), scale = ldexp(1, i % 2 ? 300 : -300);
        b.momentum = qvec3_scale(b.momentum, scale);
        const impact_tumble other = make(&b);
        assert_near(quat_distance(impact_tumble_at(&other, t / scale), impact_tumble_at(&tumble, t)), 0, 2e-15);
    }
}

static void bad_input(void **state)
{
    (void)state;
    impact_tumble tumble;
    const quat q = {1, 0, 0, 0};
    const qvec3 good = {1, 2, 3};
    assert_int_equal(impact_tumble_make((qvec3){1, NAN, 1}, q, good, &tumble), IMPACT_EDOMAIN);
    assert_int_equal(impact_tumble_make((qvec3){1, 0, 1}, q, good, &tumble), IMPACT_EARGUMENT);
    assert_int_equal(impact_tumble_make((qvec3){1, -1, 1}, q, good, &tumble), IMPACT_EARGUMENT);
    assert_int_equal(impact_tumble_make(good, (quat){0, 0, 0, 0}, good, &tumble), IMPACT_EDOMAIN);
    assert_int_equal(impact_tumble_make(good, q, (qvec3){INFINITY, 0, 0}, &tumble), IMPACT_EDOMAIN);
    assert_int_equal(impact_tumble_make((qvec3){1e-200, 1, 1}, q, (qvec3){1e200, 0, 0}, &tumble), IMPACT_EDOMAIN);
    assert_int_equal(impact_tumble_make_omega((qvec3){1, NAN, 1}, q, good, &tumble), IMPACT_EDOMAIN);
    assert_int_equal(impact_tumble_make_omega((qvec3){1, 0, 1}, q, good, &tumble), IMPACT_EARGUMENT);
    assert_int_equal(impact_tumble_make_omega(good, (quat){0, 0, 0, 0}, good, &tumble), IMPACT_EDOMAIN);
    assert_int_equal(impact_tumble_make_omega((qvec3){1e200, 1, 1}, q, (qvec3){1e200, 0, 0}, &tumble), IMPACT_EDOMAIN);
}

/* ---- from the angular velocity in the body's axes ---- */

enum { REAL_KINDS = 5, KINDS = 8 };

/* Slender bodies, moments to 1 : 1e-9: rods, bars, discs, all but spheres; and, from REAL_KINDS on, such as no mass
 * distribution has, one moment more than the sum of the others. Spins whose components are of any size. */
static void slender(random_stream *random, int kind, qvec3 *moments, qvec3 *omega)
{
    const double r = kind < REAL_KINDS ? random_log(random, 1e-9, 1e-1) : random_log(random, 1e-3, 1e-1),
                 s = random_unit(random);
    const qvec3 kinds[KINDS] = {{1, 1, r},         {1, 1 - r * s, r},   {1, 0.5, 0.5 + r * s}, {1, 1 + r * s, 1 - r},
                                {1, s, 1 - s + r}, {1, r, r * (1 + s)}, {1, sqrt(r), r},       {1, 0.5 + s / 2, r}};
    const int turn = (int)(random_bits(random) % 6);
    const double x = random_log(random, 1e-4, 1), y = random_log(random, 1e-4, 1), z = random_log(random, 1e-4, 1);
    *moments = permuted(kinds[kind], turn);
    *omega = qvec3_make(random_bits(random) & 1 ? x : -x, y, z);
}

/* rad/s: of the turn about the momentum, of the phase in the body, of omega at the start; the largest. */
static double fastest_turn(const impact_tumble *tumble)
{
    const double start = qvec3_norm(tumble->omega);
    return tumble->steady ? start : fmax(start, fmax(fabs(tumble->mean), tumble->rate));
}

static void omega_is_kept_to_the_bit(void **state)
{
    (void)state;
    random_stream random = {11};
    for (int i = 0; i < 20000; i++) {
        qvec3 moments, omega;
        slender(&random, i % KINDS, &moments, &omega);
        const quat q = random_rotation(&random);
        impact_tumble tumble;
        assert_int_equal(impact_tumble_make_omega(moments, q, omega, &tumble), IMPACT_OK);
        assert_near3(impact_tumble_omega_body(&tumble, 0), omega, 0);
        assert_near3(tumble.omega, omega, 0);
        /* the formula, not the copy: an instant later it has moved by rounding alone */
        const double fast = fastest_turn(&tumble);
        assert_near3(impact_tumble_omega_body(&tumble, 1e-18 / fast), omega, 4e-15 * fast);
        /* world axes: the body's, turned */
        const double t = random_log(&random, 1e-3, 10) / fast;
        const qvec3 later = impact_tumble_omega_body(&tumble, t);
        assert_near3(quat_rotate_inverse(impact_tumble_at(&tumble, t), impact_tumble_omega(&tumble, t)), later,
                     2e-15 * qvec3_norm(later));
        /* what flight keeps: |L| and the energy, of each component's own terms */
        const qvec3 L0 = {moments.x * omega.x, moments.y * omega.y, moments.z * omega.z};
        const qvec3 L = {moments.x * later.x, moments.y * later.y, moments.z * later.z};
        assert_near(qvec3_norm(L), qvec3_norm(L0), 2e-15 * qvec3_norm(L0));
        assert_near(qvec3_dot(L, later), qvec3_dot(L0, omega), 4e-15 * qvec3_dot(L0, omega));
    }
}

#ifdef HAVE_QUADMATH
typedef struct flight_error {
    double q, omega;
} flight_error;

/* After the angle, and (NULL: not wanted) what relative changes of the data come to. */
static flight_error error_after(qvec3 moments, quat q, qvec3 omega, double angle, flight_error *sensitivity)
{
    impact_tumble tumble;
    quat wanted;
    qvec3 spin;
    assert_int_equal(impact_tumble_make_omega(moments, q, omega, &tumble), IMPACT_OK);
    const double t = angle / fastest_turn(&tumble);
    if (sensitivity) oracle_tumble_omega_sensitivity(moments, q, omega, t, &sensitivity->q, &sensitivity->omega);
    oracle_tumble_omega(moments, q, omega, t, &wanted, &spin);
    return (flight_error){quat_rotation_distance(impact_tumble_at(&tumble, t), wanted),
                          qvec3_norm(qvec3_sub(impact_tumble_omega_body(&tumble, t), spin)) / qvec3_norm(spin)};
}

/* In units of eps times the true sensitivity to the data. */
static void slender_bodies_to_the_limit_of_their_data(void **state)
{
    (void)state;
    random_stream random = {12};
    flight_error worst = {0, 0};
    for (int i = 0; i < 4 * KINDS; i++) {
        qvec3 moments, omega;
        slender(&random, i % KINDS, &moments, &omega);
        const quat q = random_rotation(&random);
        flight_error s;
        const flight_error e = error_after(moments, q, omega, random_log(&random, 1e-2, 30), &s);
        worst.q = fmax(worst.q, e.q / (2.2e-16 * (1 + s.q)));
        worst.omega = fmax(worst.omega, e.omega / (2.2e-16 * (1 + s.omega)));
    }
    show_bounded("slender, q, eps x sensitivity", worst.q, 30);
    show_bounded("slender, omega, eps x sensitivity", worst.omega, 30);
    if (!(worst.q <= 30 && worst.omega <= 30)) fail_msg("q %g, omega %g eps x sensitivity", worst.q, worst.omega);
}

static void slender_bodies_after_a_thousand_radians(void **state)
{
    (void)state;
    random_stream random = {13};
    flight_error worst = {0, 0};
    for (int i = 0; i < 3 * REAL_KINDS; i++) {
        qvec3 moments, omega;
        slender(&random, i % REAL_KINDS, &moments, &omega);
        const quat q = random_rotation(&random);
        const flight_error e = error_after(moments, q, omega, 1000, NULL);
        worst.q = fmax(worst.q, e.q);
        worst.omega = fmax(worst.omega, e.omega);
    }
    /* the time, the rates and their products have roundings: 4e-16 of the angle, as above */
    show_bounded("slender, 1000 rad, q", worst.q, 4e-13);
    show_bounded("slender, 1000 rad, omega", worst.omega, 4e-13);
    if (!(worst.q <= 4e-13 && worst.omega <= 4e-13)) fail_msg("q %g, omega %g after 1000 rad", worst.q, worst.omega);
}

/* Over a hundred radians: a few roundings, and as many of the data as the motion itself magnifies. */
static void against_taylor_series(void **state)
{
    (void)state;
    random_stream random = {7};
    for (int i = 0; i < 15 * FAMILIES; i++) {
        const int family = i % FAMILIES;
        const body b = random_body(&random, family);
        const impact_tumble tumble = make(&b);
        const double angle = random_log(&random, 1e-3, 100),
                     t = angle / fastest(&b) * (random_bits(&random) & 1 ? 1 : -1);
        const bool unstable = family == ABOUT_THE_MIDDLE || family == SEPARATRIX;
        const double magnified = unstable ? oracle_tumble_sensitivity(b.moments, b.orientation, b.momentum, t) : 0;
        assert_near(quat_distance(impact_tumble_at(&tumble, t), oracle_tumble(b.moments, b.orientation, b.momentum, t)),
                    0, 3e-15 + 4e-16 * angle + 8 * magnified);
    }
}

/* A million periods: the error is that of the phase, about a rounding of the angle turned through. */
static void a_million_periods(void **state)
{
    (void)state;
    random_stream random = {8};
    for (int i = 0; i < 24; i++) {
        const body b = random_body(&random, GENERAL);
        const impact_tumble tumble = make(&b);
        const double period = oracle_tumble_period(b.moments, b.orientation, b.momentum);
        assert_near(impact_tumble_period(&tumble), period, 4e-15 * period);
        const double t = 1e6 * random_unit(&random) * period;
        const quat wanted = oracle_tumble(b.moments, b.orientation, b.momentum, t), got = impact_tumble_at(&tumble, t);
        assert_near(quat_rotation_distance(got, wanted), 0, 1e-15 * fastest(&b) * t);
        assert_near(energy(&tumble, t), energy(&tumble, 0), 1e-14 * energy(&tumble, 0));
    }
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_kept),
        cmocka_unit_test(omega_is_the_rate),
        cmocka_unit_test(forth_and_back_and_in_two_pieces),
        cmocka_unit_test(the_same_in_other_words),
        cmocka_unit_test(symmetric_top),
        cmocka_unit_test(on_the_unstable_axis),
        cmocka_unit_test(tiny_and_huge),
        cmocka_unit_test(bad_input),
        cmocka_unit_test(omega_is_kept_to_the_bit),
#ifdef HAVE_QUADMATH
        cmocka_unit_test(slender_bodies_to_the_limit_of_their_data),
        cmocka_unit_test(slender_bodies_after_a_thousand_radians),
        cmocka_unit_test(against_taylor_series),
        cmocka_unit_test(a_million_periods),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
