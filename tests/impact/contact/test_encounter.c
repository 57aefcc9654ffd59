/* SPDX-License-Identifier: MIT
 *
 * impact_collide_together: closed forms, the limits of the stiffnesses' ratios, the three laws.
 */
#include "kit/near.h"

#include <impact/together.h>

static impact_collider ball(double speed)
{
    return (impact_collider){
        .mass = 1, .moments = {0.4, 0.4, 0.4}, .orientation = {1, 0, 0, 0}, .velocity = {speed, 0, 0}};
}

/* ---- balls in line ---- */

enum { MOST_BALLS = 12 };

/* The first of n touching balls comes with speed 1; contact i of the stiffness given. */
static void strike_line(int n, double exponent, double eps, const double *stiffness, impact_together_law law,
                        double *speed)
{
    impact_collider balls[MOST_BALLS];
    impact_meeting meetings[MOST_BALLS];
    qvec3 v[MOST_BALLS], omega[MOST_BALLS];
    for (int i = 0; i < n; i++) balls[i] = ball(i == 0);
    for (int i = 0; i + 1 < n; i++)
        meetings[i] = (impact_meeting){.body1 = i,
                                       .body2 = i + 1,
                                       .normal = {-1, 0, 0},
                                       .offset1 = {1, 0, 0},
                                       .offset2 = {-1, 0, 0},
                                       .restitution = eps,
                                       .stiffness = stiffness ? stiffness[i] : 1};
    const impact_encounter e = {.bodies = balls,
                                .body_count = n,
                                .meetings = meetings,
                                .meeting_count = n - 1,
                                .law = law,
                                .exponent = exponent,
                                .restitution = IMPACT_STRONGE};
    impact_together_outcome o = {.velocity = v, .omega = omega};
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
    assert_at_most(o.residual, 1e-14);
    for (int i = 0; i < n; i++) speed[i] = v[i].x;
}

static void a_cradle_of_three_has_its_digits(void **state)
{
    (void)state;
    double v[3];
    strike_line(3, 1, 1, NULL, IMPACT_TOGETHER_SPRINGS, v);
    assert_near(v[0], -0.130261695064521, 5e-15);
    assert_near(v[1], 0.150229569434774, 5e-15);
    assert_near(v[2], 0.980032125629747, 5e-15);
    strike_line(3, 0, 1, NULL, IMPACT_TOGETHER_SPRINGS, v); /* Hertz */
    assert_near(v[0], -0.0710, 5e-5);
    assert_near(v[1], 0.0764, 5e-5);
    assert_near(v[2], 0.9945, 1e-4);
}

static void the_ratio_of_stiffnesses_has_both_sequences_as_limits(void **state)
{
    (void)state;
    const double soft[] = {1, 1e-6}, hard[] = {1e-6, 1};
    double v[3];
    strike_line(3, 1, 1, soft, IMPACT_TOGETHER_SPRINGS, v);
    assert_near(v[0], 0, 3e-7);
    assert_near(v[2], 1, 3e-7);
    strike_line(3, 1, 1, hard, IMPACT_TOGETHER_SPRINGS, v);
    assert_near(v[0], -1.0 / 3, 3e-7);
    assert_near(v[1], 2.0 / 3, 3e-7);
    assert_near(v[2], 2.0 / 3, 3e-7);
}

static void the_other_laws_answer_the_cradle_as_they_must(void **state)
{
    (void)state;
    double v[3];
    strike_line(3, 0, 1, NULL, IMPACT_TOGETHER_MOREAU, v);
    assert_near(v[0], -1.0 / 3, 1e-14);
    assert_near(v[1], 2.0 / 3, 1e-14);
    assert_near(v[2], 2.0 / 3, 1e-14);
    strike_line(3, 0, 1, NULL, IMPACT_TOGETHER_SEQUENCE, v);
    assert_near(v[0], 0, 1e-15);
    assert_near(v[1], 0, 1e-15);
    assert_near(v[2], 1, 1e-15);
}

static void a_long_line_keeps_energy_and_momentum(void **state)
{
    (void)state;
    double v[MOST_BALLS], momentum = 0, energy = 0;
    strike_line(MOST_BALLS, 0, 1, NULL, IMPACT_TOGETHER_SPRINGS, v);
    for (int i = 0; i < MOST_BALLS; i++) momentum += v[i], energy += v[i] * v[i];
    assert_near(momentum, 1, 2e-15);
    assert_near(energy, 1, 1e-13);
    for (int i = 1; i < MOST_BALLS; i++) assert_true(v[i] >= v[i - 1] - 1e-12); /* they part in order */
}

/* ---- Bernoulli's three balls ---- */

static void three_balls_part_by_symmetry_whatever_the_law(void **state)
{
    (void)state;
    const double c = sqrt(3) / 2, exponents[] = {1, 1.5, 2.2};
    for (int run = 0; run < 12; run++) {
        const double eps = run / 3 == 0 ? 1 : 0.2 * (run / 3);
        const impact_together_law law = run % 2 ? IMPACT_TOGETHER_MOREAU : IMPACT_TOGETHER_SPRINGS;
        const impact_collider balls[3] = {ball(1), ball(0), ball(0)};
        impact_meeting m[2];
        for (int i = 0; i < 2; i++) {
            const double s = i ? -0.5 : 0.5;
            m[i] = (impact_meeting){.body1 = 0,
                                    .body2 = i + 1,
                                    .normal = {-c, -s, 0},
                                    .offset1 = {c, s, 0},
                                    .offset2 = {-c, -s, 0},
                                    .restitution = eps,
                                    .stiffness = 7};
        }
        qvec3 v[3], omega[3];
        impact_meeting_outcome each[2];
        impact_together_outcome o = {.velocity = v, .omega = omega, .meetings = each};
        const impact_encounter e = {.bodies = balls,
                                    .body_count = 3,
                                    .meetings = m,
                                    .meeting_count = 2,
                                    .law = law,
                                    .exponent = exponents[run % 3]};
        assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
        const double p = (1 + eps) * c / (1 + 2 * c * c);
        for (int i = 0; i < 2; i++) assert_near(qvec3_norm(each[i].impulse), p, 3e-15);
        assert_near(v[0].x, 1 - 2 * c * p, 3e-15);
        assert_near(v[0].y, 0, 1e-15);
        assert_int_equal(o.groups, 1);
        assert_near(each[0].work_restitution, -eps * eps * each[0].work_compression, 1e-14);
    }
}

/* ---- what moves and is static, what is heavy ---- */

/* Between two walls that move along themselves a ball is driven: the energy that it gains is the walls' work. */
static void walls_that_move_put_in_energy(void **state)
{
    (void)state;
    for (int run = 0; run < 8; run++) {
        const bool springs = run % 2;
        impact_collider bodies[3] = {ball(0), ball(0), ball(run < 4 ? 0.7 : 0)};
        for (int k = 0; k < 2; k++) bodies[k].mass = INFINITY, bodies[k].velocity.y = k ? -2 : 3;
        bodies[2].velocity.z = -1;
        impact_meeting m[2];
        for (int k = 0; k < 2; k++) {
            m[k] = (impact_meeting){.body1 = k,
                                    .body2 = 2,
                                    .normal = {k ? 1 : -1, 0, -0.5},
                                    .offset2 = {k ? 0.9 : -0.9, 0, -0.45},
                                    .friction = 0.3 + 0.2 * k,
                                    .restitution = 0.5,
                                    .stiffness = 1};
            if (run % 4 < 2) { /* the other way round */
                m[k].body1 = 2, m[k].body2 = k, m[k].normal = qvec3_neg(m[k].normal);
                m[k].offset1 = m[k].offset2, m[k].offset2 = (qvec3){0, 0, 0};
            }
        }
        qvec3 v[3], omega[3];
        impact_together_outcome o = {.velocity = v, .omega = omega};
        const impact_encounter e = {.bodies = bodies,
                                    .body_count = 3,
                                    .meetings = m,
                                    .meeting_count = 2,
                                    .law = springs ? IMPACT_TOGETHER_SPRINGS : IMPACT_TOGETHER_MOREAU};
        assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
        assert_true(o.residual < 1e-14 && fabs(omega[2].y) > 0.1);
    }
}

/* A ball of mass M falls on one of mass 1 that lies on the floor: all stop, and the heavy one bounces by eps. Impulses
 * M times the light one's momentum leave it still to rounding of the speed; from 1e11 on its part of the bounce is
 * rounding of those that compressed. */
static void heavy_on_light_is_right_to_rounding(void **state)
{
    (void)state;
    for (int digits = 0; digits <= 12; digits++)
        for (int k = 0; k < (digits <= 10 ? 3 : 1); k++) {
            const double eps = 0.4 * k, heavy = pow(10, digits), c = 0.8;
            impact_collider bodies[3] = {ball(0), ball(0), ball(0)};
            bodies[0].mass = INFINITY;
            bodies[2].mass = heavy, bodies[2].moments = (qvec3){heavy, heavy, heavy};
            const qvec3 n = {0.6, 0, c};
            bodies[2].velocity = qvec3_neg(n);
            const impact_meeting m[2] = {{2, 1, n, qvec3_neg(n), n, 0.1, eps, 1, false},
                                         {1, 0, n, qvec3_neg(n), {0, 0, 0}, 0.1, eps, 1, false}};
            qvec3 v[3], omega[3];
            impact_together_outcome o = {.velocity = v, .omega = omega};
            const impact_encounter e = {
                .bodies = bodies, .body_count = 3, .meetings = m, .meeting_count = 2, .law = IMPACT_TOGETHER_MOREAU};
            assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
            assert_near3(v[1], (qvec3){0, 0, 0}, 1e-14);
            assert_near3(v[2], qvec3_scale(n, eps), 1e-14);
        }
}

/* ---- boxes ---- */

/* A box of half sides a, h on the floor z = 0 with mass 1, in the plane x, z; corner 0 at -a, 1 at +a. */
static impact_together_outcome land_box(double a, double h, double friction, double eps, qvec3 velocity, double omega,
                                        qvec3 *v, qvec3 *w)
{
    impact_collider bodies[2] = {{.mass = 1, .orientation = {1, 0, 0, 0}, .velocity = velocity, .omega = {0, omega, 0}},
                                 {.mass = INFINITY, .orientation = {1, 0, 0, 0}}};
    bodies[0].moments = (qvec3){1, (a * a + h * h) / 3, 1};
    impact_meeting m[2];
    for (int i = 0; i < 2; i++)
        m[i] = (impact_meeting){.body1 = 0,
                                .body2 = 1,
                                .normal = {0, 0, 1},
                                .offset1 = {i ? a : -a, 0, -h},
                                .friction = friction,
                                .restitution = eps,
                                .stiffness = 1};
    const impact_encounter e = {.bodies = bodies, .body_count = 2, .meetings = m, .meeting_count = 2};
    impact_together_outcome o = {.velocity = v, .omega = w};
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
    return o;
}

static void a_box_rocks_as_housner_has_it(void **state)
{
    (void)state;
    qvec3 v[2], w[2];
    for (int run = 0; run < 5; run++) {
        /* it turns about corner 0 at rest, and corner 1 comes down: u = omega x r at the centre */
        const double a = 0.2 + 0.1 * run, h = 1, eps = 0.3, omega = 1, r = 1 - 1.5 * a * a / (a * a + h * h);
        land_box(a, h, 10, eps, (qvec3){omega * h, 0, -omega * a}, omega, v, w);
        assert_near(w[0].y / omega, (1 + eps) * r - eps, 1e-13);
        if (run == 3) assert_near(w[0].y / omega, 0.61, 1e-13);
    }
}

static void a_box_that_falls_flat_does_not_turn(void **state)
{
    (void)state;
    qvec3 v[2], w[2];
    land_box(0.7, 0.4, 0, 0.6, (qvec3){0.3, 0, -2}, 0, v, w);
    assert_near3(v[0], (qvec3){0.3, 0, 1.2}, 1e-14);
    assert_near3(w[0], (qvec3){0, 0, 0}, 1e-14);
}

/* What turns opens at once: without restitution to 1e-9, and smaller ones are what they are. */
static void little_restitution_is_as_small_as_told(void **state)
{
    (void)state;
    qvec3 v[2], w[2];
    impact_together_outcome o = land_box(0.5, 1, 10, 0, (qvec3){1, 0, -0.5}, 1, v, w);
    assert_true(o.error > 0 && o.error < 1e-9);
    assert_near(w[0].y, 0.7, 2 * o.error);
    o = land_box(0.7, 0.4, 0, 0, (qvec3){0.3, 0, -2}, 0, v, w);
    assert_near3(v[0], (qvec3){0.3, 0, 0}, 2 * 1.001 * o.error);
    o = land_box(0.5, 1, 10, 1e-5, (qvec3){1, 0, -0.5}, 1, v, w);
    assert_true(o.error == 0);
    assert_near(w[0].y, (1 + 1e-5) * 0.7 - 1e-5, 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cradle_of_three_has_its_digits),
        cmocka_unit_test(the_ratio_of_stiffnesses_has_both_sequences_as_limits),
        cmocka_unit_test(the_other_laws_answer_the_cradle_as_they_must),
        cmocka_unit_test(a_long_line_keeps_energy_and_momentum),
        cmocka_unit_test(three_balls_part_by_symmetry_whatever_the_law),
        cmocka_unit_test(walls_that_move_put_in_energy),
        cmocka_unit_test(heavy_on_light_is_right_to_rounding),
        cmocka_unit_test(a_box_rocks_as_housner_has_it),
        cmocka_unit_test(a_box_that_falls_flat_does_not_turn),
        cmocka_unit_test(little_restitution_is_as_small_as_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
