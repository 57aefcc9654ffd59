/* SPDX-License-Identifier: MIT
 *
 * At the limits of what is admitted: slender bodies against the 128-bit oracle (tests/data/collide_slender.csv), hardly
 * any friction, units of any size; and what lies beyond is refused in words.
 */
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <impact/collide.h>
#include "generators/collide_cases.h"
#include "kit/figures.h"
#include "kit/near.h"

static const impact_collider still = {.mass = INFINITY, .orientation = {1, 0, 0, 0}};

static double velocities_off(const impact_collision *c, const impact_outcome *a, const impact_outcome *b)
{
    return case_error(c, a->velocity, a->omega, b->velocity, b->omega);
}

/* ---- slender bodies ---- */

enum { INPUTS = 41, ANSWERS = 12, NUMBERS = INPUTS + ANSWERS + 1 };

static qvec3 three(const double *x) { return (qvec3){x[0], x[1], x[2]}; }

static impact_collider body_of(const double *x)
{
    return (impact_collider){x[0], three(x + 1), {x[4], x[5], x[6], x[7]}, three(x + 8), three(x + 11), three(x + 14)};
}

static bool read_numbers(FILE *file, double *numbers)
{
    static char line[8192];
    if (!fgets(line, sizeof line, file)) return false;
    char *at = line;
    for (int i = 0; i < NUMBERS; i++, at++) numbers[i] = strtod(at, &at);
    return true;
}

/* The data's own limit: 30 eps times the true sensitivity, by AUTO and by the series. */
static void slender_bodies(void **state)
{
    (void)state;
    FILE *file = fopen(TEST_DATA "/collide_slender.csv", "r");
    assert_non_null(file);
    static char heading[4096];
    assert_non_null(fgets(heading, sizeof heading, file));
    double x[NUMBERS], worst = 0;
    int rows = 0;
    for (; read_numbers(file, x); rows++)
        for (int solver = IMPACT_SOLVER_AUTO; solver <= IMPACT_SOLVER_SERIES; solver += IMPACT_SOLVER_SERIES) {
            const impact_collision c = {.body = {body_of(x + 1), body_of(x + 18)},
                                        .normal = three(x + 35),
                                        .friction = x[38],
                                        .restitution = x[39],
                                        .law = (impact_law)(int)x[40],
                                        .solver = (impact_solver)solver};
            const double *y = x + INPUTS;
            const qvec3 v[2] = {three(y), three(y + 6)}, w[2] = {three(y + 3), three(y + 9)};
            impact_outcome o;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            const double off = case_error(&c, o.velocity, o.omega, v, w) / (DBL_EPSILON * x[NUMBERS - 1]);
            if (!(off <= 30)) fail_msg("r = %g, row %d: off by %.3g eps times the sensitivity", x[0], rows + 2, off);
            worst = fmax(worst, off);
        }
    fclose(file);
    show_bounded("slender impacts, eps x sensitivity", worst, 30);
    assert_true(rows >= 200);
}

/* The sensitivity against that by differences in 128 bits, to the six digits written, and
 * the bend of a change by 2^-24 of what nearly vanishes. */
static void sensitivity_is_true(void **state)
{
    (void)state;
    FILE *file = fopen(TEST_DATA "/collide_slender.csv", "r");
    assert_non_null(file);
    static char heading[4096];
    assert_non_null(fgets(heading, sizeof heading, file));
    double x[NUMBERS];
    while (read_numbers(file, x)) {
        const impact_collision c = {.body = {body_of(x + 1), body_of(x + 18)},
                                    .normal = three(x + 35),
                                    .friction = x[38],
                                    .restitution = x[39],
                                    .law = (impact_law)(int)x[40]};
        const double said = impact_collide_sensitivity(&c), wanted = x[NUMBERS - 1], most = 6e-6 + 0x1p-24 * wanted;
        if (!(fabs(said / wanted - 1) <= most)) fail_msg("r = %g: said %.9g, not %.9g", x[0], said, wanted);
    }
    fclose(file);
}

/* ---- hardly any friction ---- */

static impact_collision without_friction(impact_collision c)
{
    c.friction = 0;
    return c;
}

/* By so little friction that none of it shows, velocities are those without; and energy never rises. */
static void slippery(void **state)
{
    (void)state;
    int compared = 0;
    for (uint64_t i = 0; i < 20000; i++) {
        const impact_collision c = case_make(CASE_SLIPPERY, 3, i), smooth = without_friction(c);
        impact_outcome o, without;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        assert_int_equal(impact_collide(&smooth, &without), IMPACT_OK);
        assert_true(o.normal_after >= 0);
        const bool shows = c.friction * o.conditioning > DBL_EPSILON;
        const double rise = o.energy_after / o.energy_before - 1, off = velocities_off(&c, &o, &without);
        compared += !shows;
        /* Most need no more than 1. */
        if (rise <= 100 * DBL_EPSILON && (shows || off <= 30 * DBL_EPSILON)) continue;
        const double s = impact_collide_sensitivity(&c);
        assert_at_most(rise, 100 * DBL_EPSILON * s);
        if (!shows) assert_at_most(off, 30 * DBL_EPSILON * s);
    }
    assert_true(compared > 15000);
}

/* An egg slides on a floor: its centre is nearly above the contact. */
static void a_sliding_egg(void **state)
{
    (void)state;
    uint64_t g = 99;
    for (int exponent = 8; exponent <= 300; exponent += 4)
        for (int i = 0; i < 200; i++) {
            const double off = pow(10, -8 * case_random(&g)), x = 2 * case_random(&g) - 1, y = 2 * case_random(&g) - 1;
            impact_collision c = {
                .normal = {0, 0, 1}, .friction = pow(10, -exponent), .restitution = 0.5, .law = i % 3};
            c.body[0] =
                (impact_collider){1, {1, 2, 1.5}, {1, 0, 0, 0}, {off * x, off * y, off * x * y}, {y, x, -1}, {0, 0, 0}};
            c.body[1] = still;
            impact_outcome o;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            assert_true(o.energy_after <= o.energy_before);
            assert_near(o.normal_after, 0.5, 1e-7);
            assert_near(o.impulse_normal * (1 + off * off * (x * x / 2 + y * y)), 1.5, 1e-7);
        }
}

/* ---- units ---- */

/* In units a power of two (of mass: of four) larger or smaller the answer is the same to the bit, also where the
 * numbers are beyond 1e+-100. */
static void units_scale_out(void **state)
{
    (void)state;
    static const int powers[][3] = {{300, 0, 0}, {-300, 50, 0}, {0, -200, 400}, {10, 10, -500}, {-500, 200, 100}};
    for (uint64_t i = 0; i < 4000; i++) {
        impact_collision c = case_make((case_class)(i % CASE_CLASSES), 5, i);
        impact_outcome o, other;
        const impact_status status = impact_collide(&c, &o);
        const int *by = powers[i % 5];
        for (int k = 0; k < 2; k++) {
            impact_collider *b = &c.body[k];
            b->mass = ldexp(b->mass, by[0]);
            b->moments = qvec3_scale(qvec3_scale(b->moments, ldexp(1, by[0])), ldexp(1, 2 * by[1]));
            b->offset = qvec3_scale(b->offset, ldexp(1, by[1]));
            b->velocity = qvec3_scale(b->velocity, ldexp(1, by[2]));
            b->omega = qvec3_scale(b->omega, ldexp(1, by[2] - by[1]));
        }
        assert_int_equal(impact_collide(&c, &other), status);
        for (int k = 0; k < 2; k++) {
            const qvec3 v = qvec3_scale(o.velocity[k], ldexp(1, by[2])), w = o.omega[k];
            assert_memory_equal(&v, &other.velocity[k], sizeof v);
            const qvec3 back = qvec3_scale(other.omega[k], ldexp(1, by[1] - by[2]));
            assert_memory_equal(&w, &back, sizeof w);
        }
        assert_true(other.phase_count == o.phase_count && other.compressions == o.compressions);
    }
}

/* ---- anything at all ---- */

/* Numbers within 1e+-3 ... 1e+-100: an answer that is finite and gains no energy, or a refusal in words. */
static void any_numbers(void **state)
{
    (void)state;
    int answered = 0, refused = 0;
    for (uint64_t i = 0; i < 60000; i++) {
        const impact_collision c = case_make(CASE_RANGE, 7, i);
        impact_outcome o;
        char message[200];
        const impact_status status = impact_collide(&c, &o), check = impact_collide_check(&c, message, sizeof message);
        if (status < 0) {
            if (check != IMPACT_OK) assert_true(status == check && strlen(message) > 10);
            refused++;
            continue;
        }
        assert_int_equal(check, IMPACT_OK);
        assert_true(isfinite(o.energy_after) && isfinite(qvec3_norm(o.impulse)) && isfinite(o.normal_after));
        answered++;
    }
    assert_true(answered > 20000 && refused > 1000);
}

static void refuses(const impact_collision *c, const char *words)
{
    char message[200];
    impact_outcome o;
    assert_int_equal(impact_collide_check(c, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, words);
    assert_int_equal(impact_collide(c, &o), IMPACT_EARGUMENT);
}

static void beyond(void **state)
{
    (void)state;
    const impact_collider ball = {1, {1, 1, 1}, {1, 0, 0, 0}, {0, 0.5, -1}, {0, 0, -1}, {0, 0, 0}};
    const impact_collision good = {.body = {ball, ball}, .normal = {0, 0, 1}, .friction = 0.3};
    impact_collision c = good;
    c.body[1].velocity.z = 1;
    c.body[1].moments.y = 1e-13;
    refuses(&c, "body 2: moments spread over 1e+13, at most 1e+12");
    c = good;
    c.body[0].mass = 1e17;
    refuses(&c, "the masses are 1e+17 apart, at most 1e+16");
    c = good;
    c.friction = 1e101;
    refuses(&c, "friction is 1e+101, must be at most 1e+100");
    c = good;
    c.any_restitution = true;
    c.restitution = 1e101;
    refuses(&c, "restitution is 1e+101, must be at most 1e+100");
    c = good;
    c.body[0].moments = (qvec3){0x1p-340, 0x1p-340, 0x1p-340};
    refuses(&c, "body 1: a moment is 4.46e-103 of the reduced mass times the longest arm squared, at least 1e-100");
    c = good;
    c.body[1] = still;
    c.body[0].velocity = (qvec3){1, 0, -0x1p-340};
    refuses(&c, "the contact points approach at 4.46e-103 of the fastest velocity, at least 1e-100");
    c = good;
    c.body[0].velocity = (qvec3){0, 0, -1e160};
    char message[200];
    assert_int_equal(impact_collide_check(&c, message, sizeof message), IMPACT_EDOMAIN);
    assert_string_equal(message, "the kinetic energy is about 1e+320 J, must be below 1.8e+308");
    c.body[0].velocity = (qvec3){0, 0, -1e153};
    assert_int_equal(impact_collide_check(&c, message, sizeof message), IMPACT_OK);
    c = good;
    c.body[1] = still;
    c.body[0].velocity = (qvec3){1, 0, -1e-99};
    impact_outcome o;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    assert_true(o.normal_before == -1e-99 && isfinite(o.impulse_normal));
}

/* An arm that is 0 stays so; else it is told from 0 down to 1e-100 of the longest. */
static void short_arms(void **state)
{
    (void)state;
    const impact_collider ball = {1, {1, 1, 1}, {1, 0, 0, 0}, {0, 0.5, -1}, {0, 0, -1}, {0, 0, 0}};
    impact_collision c = {.body = {ball, ball}, .normal = {0, 0, 1}};
    impact_outcome o;
    impact_receipt r;
    c.body[1].velocity.z = 1;
    c.body[1].offset = (qvec3){0x1p-500, 0, 0};
    refuses(&c, "body 2: its arm is 3.05e-151 of the longest arm or radius of gyration, at least 1e-100, or 0");
    c.body[1].offset = (qvec3){0x1p-330, 0, 0};
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    assert_true(impact_collide_receipt(&c, &o, &r) < 10);
    assert_true(o.omega[1].y == 0x1p-330 * o.impulse_normal); /* J w = r x P, to the last digit */
    c.body[1].offset = (qvec3){0, 0, 0};
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    assert_true(impact_collide_receipt(&c, &o, &r) < 10 && o.omega[1].y == 0);
}

/* A body that is nearly a point, met slowly beside its way: the impulse is 1e-166 in the impact's units, and its square
 * none. */
static void faint_impulses(void **state)
{
    (void)state;
    const double laws[] = {IMPACT_POISSON, IMPACT_NEWTON, IMPACT_STRONGE}, frictions[] = {0, 0.3, 1e-20};
    for (int i = 0; i < 9; i++) {
        impact_collision c = {
            .body = {{2, {2e-96, 1e-96, 3e-96}, {1, 0, 0, 0}, {-1, 1, -1}, {0, 0, 1}, {0, 4e-16, -1}},
                     {3e11, {3e11, 3e11, 4e11}, {1, 0, 0, 0}, {1, -1, 0}, {.3, .5, -3e69}, {0, 1, 1}}},
            .normal = {.33, -.1, 0},
            .friction = frictions[i / 3],
            .restitution = .6,
            .law = (impact_law)laws[i % 3]};
        impact_outcome o;
        impact_receipt r;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        assert_true(o.impulse_normal > 0 && o.impulse_normal < 1e-90);
        assert_true(impact_collide_receipt(&c, &o, &r) < 1e4);
    }
}

/* Energies below double precision, 2e-308, are rounded to what there is; velocities and impulses keep their digits, and
 * the receipt holds. */
static void below_double(void **state)
{
    (void)state;
    impact_collision c = {.body = {{1, {1, 1, 1}, {1, 0, 0, 0}, {0, 0, -1}, {0, 0, -1e-150}, {0, 0, 0}}, still},
                          .normal = {0, 0, 1},
                          .restitution = .5};
    impact_outcome o;
    impact_receipt r;
    for (double speed = 1e-150; speed > 1e-300; speed *= 1e-3) {
        c.body[0].velocity = (qvec3){speed / 3, 0, -speed};
        c.friction = .1;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        assert_true(impact_collide_receipt(&c, &o, &r) < 10);
        assert_near(o.velocity[0].z, speed / 2, 1e-15 * speed);
    }
    o.velocity[0].z *= 1 + 1e-10; /* some 5e5 eps */
    assert_true(impact_collide_receipt(&c, &o, &r) > 1e4 && r.momentum > 1e4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slender_bodies), cmocka_unit_test(sensitivity_is_true), cmocka_unit_test(slippery),
        cmocka_unit_test(a_sliding_egg),  cmocka_unit_test(units_scale_out),     cmocka_unit_test(any_numbers),
        cmocka_unit_test(beyond),         cmocka_unit_test(short_arms),          cmocka_unit_test(faint_impulses),
        cmocka_unit_test(below_double),
    };
    return cmocka_run_group_tests_name("impact collide_limits", tests, NULL, NULL);
}
