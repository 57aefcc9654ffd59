/* SPDX-License-Identifier: MIT
 *
 * impact_collide_together: closed forms, the limits of the stiffnesses' ratios, symmetries of random encounters, the
 * three laws, memory, and bad input in words.
 */
#include "kit/near.h"

#include <stdlib.h>
#include <string.h>
#include <impact/together.h>
#include "kit/encounter_random.h"

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
            const impact_meeting m[2] = {{2, 1, n, qvec3_neg(n), n, 0.1, eps, 1},
                                         {1, 0, n, qvec3_neg(n), {0, 0, 0}, 0.1, eps, 1}};
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

static void little_restitution_is_told(void **state)
{
    (void)state;
    qvec3 v[2], w[2];
    const impact_together_outcome o = land_box(0.5, 1, 10, 0, (qvec3){1, 0, -0.5}, 1, v, w);
    assert_near(o.error, 1e-3, 1e-18);
    assert_near(w[0].y, 0.7, 2e-3);
}

/* ---- symmetries ---- */

typedef struct answer {
    impact_status status;
    impact_together_outcome outcome;
    qvec3 velocity[ENCOUNTER_BODIES], omega[ENCOUNTER_BODIES];
    impact_meeting_outcome meetings[ENCOUNTER_CONTACTS];
} answer;

static answer solve(const random_encounter *e, impact_together_law law, double exponent,
                    impact_together_workspace *workspace)
{
    answer a;
    impact_encounter encounter = encounter_of(e, law);
    encounter.exponent = exponent;
    encounter.workspace = workspace;
    a.outcome = (impact_together_outcome){.velocity = a.velocity, .omega = a.omega, .meetings = a.meetings};
    a.status = impact_collide_together(&encounter, &a.outcome);
    return a;
}

static const encounter_ranges campaign = {2, 8, 3, 0.1, 100, 100};

static void draw_permutation(random_stream *random, int *order, int n)
{
    for (int i = 0; i < n; i++) order[i] = i;
    for (int i = n - 1; i > 0; i--) {
        const int j = (int)(random_unit(random) * (i + 1)), kept = order[i];
        order[i] = order[j], order[j] = kept;
    }
}

static void numbering_and_order_change_no_bit(void **state)
{
    (void)state;
    random_stream random = {11};
    impact_together_workspace *workspace;
    assert_int_equal(impact_together_workspace_create(NULL, &workspace), IMPACT_OK);
    for (int run = 0; run < 1500; run++) {
        const random_encounter e = encounter_draw(&random, &campaign);
        random_encounter other = e;
        int bodies[ENCOUNTER_BODIES], contacts[ENCOUNTER_CONTACTS];
        draw_permutation(&random, bodies, e.body_count);
        draw_permutation(&random, contacts, e.meeting_count);
        for (int b = 0; b < e.body_count; b++) other.bodies[bodies[b]] = e.bodies[b];
        for (int i = 0; i < e.meeting_count; i++) {
            other.meetings[contacts[i]] = e.meetings[i];
            other.meetings[contacts[i]].body1 = bodies[e.meetings[i].body1];
            other.meetings[contacts[i]].body2 = bodies[e.meetings[i].body2];
        }
        const impact_together_law law = run % 3 ? IMPACT_TOGETHER_SPRINGS : IMPACT_TOGETHER_MOREAU;
        const double exponent = run % 2 ? 1 : 0;
        const answer a = solve(&e, law, exponent, workspace), b = solve(&other, law, exponent, workspace);
        assert_int_equal(a.status, b.status);
        for (int k = 0; k < e.body_count; k++) {
            assert_memory_equal(&a.velocity[k], &b.velocity[bodies[k]], sizeof a.velocity[k]);
            assert_memory_equal(&a.omega[k], &b.omega[bodies[k]], sizeof a.omega[k]);
        }
    }
    impact_together_workspace_destroy(workspace);
}

/* All turned by q, masses times m, lengths times l, times times t. */
static random_encounter change_frame(const random_encounter *e, quat q, double m, double l, double t)
{
    random_encounter out = *e;
    for (int b = 0; b < e->body_count; b++) {
        impact_collider *body = &out.bodies[b];
        body->mass *= m;
        body->moments = qvec3_scale(body->moments, m * l * l);
        body->orientation = quat_mul(q, body->orientation);
        (void)quat_normalize(body->orientation, &body->orientation);
        body->velocity = quat_rotate(q, qvec3_scale(body->velocity, l / t));
        body->omega = quat_rotate(q, qvec3_scale(body->omega, 1 / t));
    }
    for (int i = 0; i < e->meeting_count; i++) {
        impact_meeting *own = &out.meetings[i];
        own->normal = quat_rotate(q, own->normal);
        own->offset1 = quat_rotate(q, qvec3_scale(own->offset1, l));
        own->offset2 = quat_rotate(q, qvec3_scale(own->offset2, l));
        own->stiffness *= 3.7;
    }
    return out;
}

static double distance(const answer *a, const answer *b, int bodies)
{
    double off = 0, size = 0;
    for (int k = 0; k < bodies; k++) {
        off = fmax(off, qvec3_norm(qvec3_sub(a->velocity[k], b->velocity[k])) +
                            qvec3_norm(qvec3_sub(a->omega[k], b->omega[k])));
        size = fmax(size, qvec3_norm(a->velocity[k]) + qvec3_norm(a->omega[k]));
    }
    return off / size;
}

/* How far the answer follows relative changes of the data, of eight tries of 2^-36. */
static double sensitivity(random_stream *random, const random_encounter *e, const answer *a)
{
    double most = 1;
    for (int k = 0; k < 8; k++) {
        random_encounter near = *e;
        for (int b = 0; b < e->body_count; b++)
            near.bodies[b].velocity = qvec3_axpy(0x1p-36, random_direction(random), near.bodies[b].velocity);
        for (int i = 0; i < e->meeting_count; i++) {
            near.meetings[i].normal = qvec3_axpy(0x1p-36, random_direction(random), near.meetings[i].normal);
            near.meetings[i].stiffness *= 1 + 0x1p-36 * random_unit(random);
        }
        const answer b = solve(&near, IMPACT_TOGETHER_SPRINGS, 0, NULL);
        most = fmax(most, distance(a, &b, e->body_count) * 0x1p36);
    }
    return most;
}

static void turning_the_scene_and_changing_units_changes_nothing(void **state)
{
    (void)state;
    random_stream random = {13};
    int compared = 0;
    for (int run = 0; run < 300; run++) {
        const random_encounter e = encounter_draw(&random, &campaign);
        const quat q = random_rotation(&random);
        const double m = 2.9, l = 0.31, t = 7.3;
        random_encounter other = change_frame(&e, q, m, l, t);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 0, NULL);
        answer b = solve(&other, IMPACT_TOGETHER_SPRINGS, 0, NULL);
        if (a.status != IMPACT_OK || b.status != IMPACT_OK) continue;
        for (int k = 0; k < e.body_count; k++) {
            b.velocity[k] = qvec3_scale(quat_rotate_inverse(q, b.velocity[k]), t / l);
            b.omega[k] = qvec3_scale(quat_rotate_inverse(q, b.omega[k]), t);
        }
        assert_at_most(distance(&a, &b, e.body_count), 1e-11 * sensitivity(&random, &e, &a));
        compared++;
    }
    assert_true(compared > 250);
}

static void receipts_hold_over_random_encounters(void **state)
{
    (void)state;
    random_stream random = {17};
    impact_together_workspace *workspace;
    assert_int_equal(impact_together_workspace_create(NULL, &workspace), IMPACT_OK);
    int answered[3] = {0};
    for (int run = 0; run < 1500; run++) {
        const random_encounter e = encounter_draw(&random, &campaign);
        const impact_together_law law = (impact_together_law)(run % 3);
        const answer a = solve(&e, law, 0, workspace);
        if (a.status != IMPACT_OK) continue;
        answered[law]++;
        assert_at_most(a.outcome.residual, law == IMPACT_TOGETHER_SPRINGS ? 1e-13 : 1e-11);
        assert_true(law == IMPACT_TOGETHER_MOREAU || !a.outcome.energy_rose);
        if (!a.outcome.energy_rose) assert_at_most(a.outcome.energy_after, a.outcome.energy_before * (1 + 1e-11));
        if (law == IMPACT_TOGETHER_SPRINGS)
            assert_at_most(a.outcome.energy_after, a.outcome.energy_before * (1 + 1e-14));
    }
    assert_true(answered[IMPACT_TOGETHER_SPRINGS] > 450);
    assert_true(answered[IMPACT_TOGETHER_MOREAU] > 450);
    assert_true(answered[IMPACT_TOGETHER_SEQUENCE] > 300);
    impact_together_workspace_destroy(workspace);
}

/* Encounters of the campaign (./run report together) that once found no end: slip that begins by and by where the
 * contact is about to open; slip as slow as the rounding of impulses a hundred times the largest momentum. */
static void what_found_no_end_is_answered(void **state)
{
    (void)state;
    static const struct {
        uint64_t number;
        double exponent;
        int least, most;
    } cases[] = {{1192, 1.5, 2, 3}, {433, 1, 4, 6}, {555, 1, 7, 12}, {4055, 1.5, 4, 6}};
    for (int k = 0; k < 4; k++) {
        const encounter_ranges ranges = {cases[k].least, cases[k].most, 10, 0.05, 1e4, 1e4};
        random_stream random = {1 + 0x9e3779b97f4a7c15u * cases[k].number};
        const random_encounter e = encounter_draw(&random, &ranges);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, cases[k].exponent, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_true(a.outcome.residual < 1e-12);
    }
}

static void elastic_encounters_without_friction_keep_energy(void **state)
{
    (void)state;
    const encounter_ranges ranges = {2, 3, 0, 1, 1e4, 1e4};
    random_stream random = {29};
    int answered = 0;
    for (int run = 0; run < 600; run++) {
        const random_encounter e = encounter_draw(&random, &ranges);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, run % 2 ? 1 : 1.5, NULL);
        if (a.status == IMPACT_SEPARATING) continue;
        assert_int_equal(a.status, IMPACT_OK);
        assert_near(a.outcome.energy_after / a.outcome.energy_before, 1, 1e-13);
        answered++;
    }
    assert_true(answered > 500);
}

/* Three contacts of one body in a plane, held by friction: it goes from one to the other over gaps that grow, a
 * thousand times its dents and more, and comes back where it closed. */
static void long_flights_come_back_to_where_contacts_close(void **state)
{
    (void)state;
    const encounter_ranges ranges = {2, 3, 10, 0.05, 1e4, 1e4};
    random_stream random = {1 + 0x9e3779b97f4a7c15u * 644u};
    const random_encounter e = encounter_draw(&random, &ranges);
    const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 1, NULL);
    assert_int_equal(a.status, IMPACT_OK);
    assert_at_most(a.outcome.residual, 1e-14);
}

/* ---- groups, duplicates, wedges ---- */

static void groups_are_apart_and_one_contact_is_impact_collide(void **state)
{
    (void)state;
    const impact_collider bodies[4] = {ball(1), ball(0), ball(2), ball(-1)};
    impact_meeting m[3];
    for (int i = 0; i < 3; i++)
        m[i] = (impact_meeting){.body1 = i == 2 ? 2 : 0,
                                .body2 = i == 2 ? 3 : 1,
                                .normal = {-1, 0.1, 0},
                                .offset1 = {1, 0, 0},
                                .offset2 = {-1, 0, 0},
                                .friction = 0.2,
                                .restitution = 0.7,
                                .stiffness = 1};
    qvec3 v[4], omega[4];
    impact_meeting_outcome each[3];
    impact_together_outcome o = {.velocity = v, .omega = omega, .meetings = each};
    const impact_encounter e = {.bodies = bodies, .body_count = 4, .meetings = m, .meeting_count = 3};
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
    assert_int_equal(o.groups, 2);
    assert_int_equal(o.solver, IMPACT_TOGETHER_ALONE);
    assert_true(each[1].merged && !each[0].merged && !each[2].merged);
    assert_int_equal(each[0].group, each[1].group);
    impact_collision c = {.body = {bodies[2], bodies[3]},
                          .normal = m[2].normal,
                          .friction = 0.2,
                          .restitution = 0.7,
                          .law = IMPACT_STRONGE};
    c.body[0].offset = m[2].offset1, c.body[1].offset = m[2].offset2;
    impact_outcome one;
    assert_int_equal(impact_collide(&c, &one), IMPACT_OK);
    assert_memory_equal(&v[2], &one.velocity[0], sizeof v[2]);
    assert_memory_equal(&omega[3], &one.omega[1], sizeof omega[3]);
}

static void a_wedged_ball_is_told(void **state)
{
    (void)state;
    const impact_collider bodies[2] = {ball(1), {.mass = INFINITY, .orientation = {1, 0, 0, 0}}};
    impact_meeting m[2];
    for (int i = 0; i < 2; i++)
        m[i] = (impact_meeting){.body1 = 0,
                                .body2 = 1,
                                .normal = {i ? 1 : -1, 0, 0},
                                .offset1 = {i ? -1 : 1, 0, 0},
                                .restitution = 0.5,
                                .stiffness = 1};
    qvec3 v[2];
    impact_together_outcome o = {.velocity = v};
    const impact_encounter e = {.bodies = bodies, .body_count = 2, .meetings = m, .meeting_count = 2};
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_EUNSETTLED);
    assert_true(o.wedged >= 0);
    assert_near3(v[0], bodies[0].velocity, 0);
}

/* A ball in a groove of 60 degrees: friction of 3 holds it by pressures of its own, of .2 does not. */
static void what_friction_locks_is_told(void **state)
{
    (void)state;
    const double c = cos(0.5236), s = sin(0.5236);
    impact_collider bodies[2] = {ball(0), {.mass = INFINITY, .orientation = {1, 0, 0, 0}}};
    bodies[0].velocity = (qvec3){0.1, 0, -1};
    impact_meeting m[2];
    for (int i = 0; i < 2; i++)
        m[i] = (impact_meeting){.body1 = 0,
                                .body2 = 1,
                                .normal = {i ? c : -c, 0, s},
                                .offset1 = {i ? -c : c, 0, -s},
                                .friction = 3,
                                .restitution = 0.5,
                                .stiffness = 1};
    impact_together_outcome o = {.velocity = NULL};
    const impact_encounter e = {.bodies = bodies, .body_count = 2, .meetings = m, .meeting_count = 2};
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_EUNSETTLED);
    assert_true(o.wedged >= 0);
    for (int i = 0; i < 2; i++) m[i].friction = 0.2;
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
}

/* ---- memory ---- */

static void *count_bytes(size_t size, void *context)
{
    *(size_t *)context += size;
    return malloc(size);
}

static void release(void *piece, size_t size, void *context)
{
    (void)size, (void)context;
    free(piece);
}

static void a_workspace_takes_memory_once_and_keeps_its_limit(void **state)
{
    (void)state;
    size_t taken = 0;
    const impact_allocator counting = {count_bytes, release, &taken, 0}, tight = {NULL, NULL, NULL, 4096};
    impact_together_workspace *workspace;
    random_stream random = {19};
    const random_encounter e = encounter_draw(&random, &(encounter_ranges){5, 5, 1, 0.3, 4, 4});
    assert_int_equal(impact_together_workspace_create(&counting, &workspace), IMPACT_OK);
    const answer first = solve(&e, IMPACT_TOGETHER_SPRINGS, 0, workspace);
    const size_t once = taken;
    const answer again = solve(&e, IMPACT_TOGETHER_SPRINGS, 0, workspace);
    assert_int_equal(taken, once);
    assert_int_equal(impact_together_workspace_memory(workspace).held, once);
    assert_memory_equal(first.velocity, again.velocity, (size_t)e.body_count * sizeof *first.velocity);
    impact_together_workspace_destroy(workspace);
    if (impact_together_workspace_create(&tight, &workspace) != IMPACT_OK) return;
    assert_int_equal(solve(&e, IMPACT_TOGETHER_SPRINGS, 0, workspace).status, IMPACT_ENOMEM);
    impact_together_workspace_destroy(workspace);
}

/* ---- bad input ---- */

static void expect(const random_encounter *e, double exponent, impact_status status, const char *words)
{
    char message[300];
    impact_encounter encounter = encounter_of(e, IMPACT_TOGETHER_SPRINGS);
    encounter.exponent = exponent;
    assert_int_equal(impact_collide_together_check(&encounter, message, sizeof message), status);
    if (!strstr(message, words)) fail_msg("'%s' does not say '%s'", message, words);
    assert_int_equal(solve(e, IMPACT_TOGETHER_SPRINGS, exponent, NULL).status, status);
}

static void bad_input_is_named_in_words(void **state)
{
    (void)state;
    random_stream random = {23};
    const random_encounter good = encounter_draw(&random, &(encounter_ranges){3, 3, 1, 0.3, 4, 4});
    random_encounter e = good;
    e.meetings[1].body2 = 9;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 1: body2 is 9");
    e = good, e.meetings[2].body2 = e.meetings[2].body1;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 2: both sides are body");
    e = good, e.meetings[0].stiffness = -1;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 0: stiffness is -1, must be > 0");
    e = good, e.meetings[0].stiffness = NAN;
    expect(&e, 0, IMPACT_EDOMAIN, "contact 0: stiffness is NaN");
    e = good, e.meetings[2].friction = -0.5;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 2, of body");
    e = good, e.bodies[e.meetings[0].body1].mass = NAN;
    expect(&e, 0, IMPACT_EDOMAIN, "mass is NaN");
    e = good, e.bodies[e.meetings[0].body1].mass = e.bodies[e.meetings[0].body2].mass = INFINITY;
    expect(&e, 0, IMPACT_EARGUMENT, "static");
    e = good, e.meetings[1] = e.meetings[0], e.meetings[1].friction += 1;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 1 is contact 0 again");
    expect(&good, 4, IMPACT_EARGUMENT, "exponent is 4");
    e = good, e.meeting_count = 0;
    expect(&e, 0, IMPACT_EARGUMENT, "there are no contacts");
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
        cmocka_unit_test(little_restitution_is_told),
        cmocka_unit_test(numbering_and_order_change_no_bit),
        cmocka_unit_test(turning_the_scene_and_changing_units_changes_nothing),
        cmocka_unit_test(receipts_hold_over_random_encounters),
        cmocka_unit_test(what_found_no_end_is_answered),
        cmocka_unit_test(elastic_encounters_without_friction_keep_energy),
        cmocka_unit_test(long_flights_come_back_to_where_contacts_close),
        cmocka_unit_test(groups_are_apart_and_one_contact_is_impact_collide),
        cmocka_unit_test(a_wedged_ball_is_told),
        cmocka_unit_test(what_friction_locks_is_told),
        cmocka_unit_test(a_workspace_takes_memory_once_and_keeps_its_limit),
        cmocka_unit_test(bad_input_is_named_in_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
