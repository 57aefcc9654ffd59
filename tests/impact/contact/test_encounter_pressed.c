/* SPDX-License-Identifier: MIT
 *
 * Painleve's states of bodies that others hold: A slides at u_n = 0 and is pressed, H hold without friction. A planar
 * impulse P = (P_n, P_t) at A makes H answer by P_H = -W_HH^-1 W_HA P, so that
 *
 *     u_A = u + K P,   K = W_AA - W_AH W_HH^-1 W_HA
 *
 * and the closed form of one rod (test_collide_tangential.c) holds with this K wherever P_H presses: with slip -s,
 * d(u_n)/dp = K_nn + mu K_nt = -a < 0 until p1 = s/(mu K_tt + K_nt), when u_n = -a p1; then stick to p2 more, and
 * restitution's eps (p1 + p2). By springs, whose answer hangs on their ratios, it is the limit of a little approach.
 */
#include "kit/near.h"

#include <string.h>
#include <impact/together.h>
#include "kit/encounter_answer.h"

/* ---- planar bodies: x, z and turning about y ---- */

enum { STATIC = 2, HOLDS = 2 };

/* A contact's row: force along `way` on `one` at `arm`, against `other` at its own arm. */
typedef struct planar_row {
    int body[2];
    double way[2], arm[2][2];
} planar_row;

/* x' and z' of the arm under a turning of 1 about y, x from z: (z, -x). */
static double lever(const double *arm, const double *way) { return arm[1] * way[0] - arm[0] * way[1]; }

static double mobility(const planar_row *a, const planar_row *b, const double *mass, const double *inertia)
{
    double sum = 0;
    for (int s = 0; s < 2; s++)
        for (int t = 0; t < 2; t++) {
            const int body = a->body[s];
            if (body != b->body[t] || body == STATIC) continue;
            const double part = (a->way[0] * b->way[0] + a->way[1] * b->way[1]) / mass[body] +
                                lever(a->arm[s], a->way) * lever(b->arm[t], b->way) / inertia[body];
            sum += s == t ? part : -part;
        }
    return sum;
}

/* ---- cases ---- */

/* A rod whose lower end slides on a ball on the ground, or on a box that stands there on two points; or on the ground,
 * its upper end at a smooth wall. */
typedef enum held_case { ON_A_BALL, ON_A_BOX, AT_A_WALL } held_case;

typedef struct held_rod {
    double mass[2], inertia[2], friction, slip;
    double move[3]; /* of the rod: x', z', turning */
    planar_row normal, tangent, hold[HOLDS];
    int holds;
} held_rod;

static held_rod draw_rod(random_stream *random, held_case which)
{
    const double lean = 0.2 + 1.2 * random_unit(random), c = cos(lean), s = sin(lean),
                 radius = random_log(random, 0.1, 3), aside = radius * (2 * random_unit(random) - 1);
    held_rod rod = {.mass = {1, random_log(random, 0.1, 10)},
                    .inertia = {1.0 / 3, 0},
                    .friction = random_log(random, 0.5, 20),
                    .slip = random_log(random, 0.1, 10)};
    rod.inertia[1] = 0.4 * rod.mass[1] * radius * radius;
    rod.normal = (planar_row){{0, which == AT_A_WALL ? STATIC : 1}, {0, 1}, {{-c, -s}, {0, radius}}};
    if (which == ON_A_BOX) rod.normal.arm[1][0] = aside;
    rod.tangent = rod.normal;
    rod.tangent.way[0] = 1, rod.tangent.way[1] = 0;
    rod.move[0] = -rod.slip;
    if (which == AT_A_WALL) { /* the upper end goes along it */
        rod.move[0] = -0.5 * rod.slip, rod.move[2] = 0.5 * rod.slip / s;
        rod.move[1] = -rod.move[2] * c;
    }
    rod.holds = which == ON_A_BOX ? 2 : 1;
    for (int k = 0; k < rod.holds; k++) {
        rod.hold[k] = (planar_row){{1, STATIC}, {0, 1}, {{0, -radius}, {0, 0}}};
        if (which == ON_A_BOX) rod.hold[k].arm[0][0] = k ? 4 * radius : -4 * radius;
        if (which == AT_A_WALL) rod.hold[k] = (planar_row){{0, STATIC}, {-1, 0}, {{c, s}, {0, 0}}};
    }
    return rod;
}

/* P_H of a unit at A along the normal and the tangent. */
static void find_answers(const held_rod *rod, double holds[HOLDS][2])
{
    double w[HOLDS][HOLDS] = {{1, 0}, {0, 1}}, right[HOLDS][2] = {{0}};
    for (int i = 0; i < rod->holds; i++) {
        for (int j = 0; j < rod->holds; j++) w[i][j] = mobility(&rod->hold[i], &rod->hold[j], rod->mass, rod->inertia);
        right[i][0] = -mobility(&rod->hold[i], &rod->normal, rod->mass, rod->inertia);
        right[i][1] = -mobility(&rod->hold[i], &rod->tangent, rod->mass, rod->inertia);
    }
    const double determinant = w[0][0] * w[1][1] - w[0][1] * w[1][0];
    for (int k = 0; k < 2; k++) {
        holds[0][k] = (w[1][1] * right[0][k] - w[0][1] * right[1][k]) / determinant;
        holds[1][k] = (w[0][0] * right[1][k] - w[1][0] * right[0][k]) / determinant;
    }
}

/* K: nn, nt, tt. */
static void find_response(const held_rod *rod, double holds[HOLDS][2], double k[3])
{
    const planar_row *rows[3][2] = {
        {&rod->normal, &rod->normal}, {&rod->normal, &rod->tangent}, {&rod->tangent, &rod->tangent}};
    for (int i = 0; i < 3; i++) {
        k[i] = mobility(rows[i][0], rows[i][1], rod->mass, rod->inertia);
        for (int h = 0; h < rod->holds; h++)
            k[i] += mobility(rows[i][0], &rod->hold[h], rod->mass, rod->inertia) * holds[h][i > 0];
    }
}

/* ---- as encounters ---- */

static qvec3 in_space(quat turn, double x, double z) { return quat_rotate(turn, (qvec3){x, 0, z}); }

static impact_meeting meeting_of(const planar_row *row, quat turn, bool swapped)
{
    const int first = swapped ? 1 : 0;
    const double sign = swapped ? -1 : 1;
    return (impact_meeting){.body1 = row->body[first],
                            .body2 = row->body[1 - first],
                            .normal = in_space(turn, sign * row->way[0], sign * row->way[1]),
                            .offset1 = in_space(turn, row->arm[first][0], row->arm[first][1]),
                            .offset2 = in_space(turn, row->arm[1 - first][0], row->arm[1 - first][1]),
                            .stiffness = 1};
}

static random_encounter encounter_from(const held_rod *rod, quat turn, double restitution, bool swapped)
{
    random_encounter e = {.body_count = 3, .meeting_count = 1 + rod->holds};
    for (int b = 0; b < 2; b++)
        e.bodies[b] = (impact_collider){.mass = rod->mass[b],
                                        .moments = {rod->inertia[b], rod->inertia[b], rod->inertia[b]},
                                        .orientation = {1, 0, 0, 0}};
    e.bodies[STATIC] = (impact_collider){.mass = INFINITY, .orientation = {1, 0, 0, 0}};
    e.bodies[0].velocity = in_space(turn, rod->move[0], rod->move[1]);
    e.bodies[0].omega = quat_rotate(turn, (qvec3){0, rod->move[2], 0});
    for (int k = 0; k < rod->holds; k++) e.meetings[1 + k] = meeting_of(&rod->hold[k], turn, swapped);
    e.meetings[0] = meeting_of(&rod->normal, turn, swapped);
    e.meetings[0].friction = rod->friction;
    e.meetings[0].restitution = restitution;
    e.meetings[0].pressed = true;
    return e;
}

/* ---- Moreau's law ---- */

static void holds_answer_as_in_closed_form(void **state)
{
    (void)state;
    random_stream random = {29};
    int drawn[3] = {0}, kept[3] = {0}, free_too = 0;
    for (int run = 0; run < 6000; run++) {
        const held_case which = (held_case)(run % 3);
        const held_rod rod = draw_rod(&random, which);
        const double eps = run % 4 == 0 ? 0 : random_unit(&random);
        const quat turn = random_rotation(&random);
        const random_encounter e = encounter_from(&rod, turn, eps, run % 5 == 0);
        double answers[HOLDS][2], k[3];
        find_answers(&rod, answers);
        find_response(&rod, answers, k);
        const double mu = rod.friction, a = -(k[0] + mu * k[1]), g = k[0] - k[1] * k[1] / k[2];
        bool presses = true; /* sliding and sticking */
        for (int h = 0; h < rod.holds; h++)
            presses = presses && answers[h][0] + mu * answers[h][1] > 1e-3 &&
                      answers[h][0] - k[1] / k[2] * answers[h][1] > 1e-3;
        if (!presses || fabs(a) < 1e-2) continue;
        const answer o = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        if (a < 0) {
            assert_true(o.status == IMPACT_OK || o.status == IMPACT_SEPARATING);
            assert_near3(o.velocity[0], e.bodies[0].velocity, 1e-15 * rod.slip); /* H are where rounding has them */
            assert_int_equal(o.meetings[0].phase_count, 0);
            kept[which]++;
            continue;
        }
        drawn[which]++;
        free_too += mobility(&rod.normal, &rod.normal, rod.mass, rod.inertia) +
                        mu * mobility(&rod.normal, &rod.tangent, rod.mass, rod.inertia) <
                    0;
        assert_int_equal(o.status, IMPACT_OK);
        const double p1 = rod.slip / (mu * k[2] + k[1]), p2 = a * p1 / g, more = eps * (p1 + p2),
                     normal = p1 + p2 + more, across = mu * p1 - k[1] / k[2] * (p2 + more);
        const qvec3 impulse = qvec3_scale(o.meetings[0].impulse, run % 5 == 0 ? -1 / normal : 1 / normal);
        assert_near3(quat_rotate_inverse(turn, impulse), (qvec3){across / normal, 0, 1}, 1e-12);
        assert_near(o.meetings[0].normal_after / rod.slip, g * more / rod.slip, 1e-12 * (1 + a));
        assert_int_equal(o.meetings[0].phase_count, 1);
        assert_int_equal(o.meetings[0].phases[0], IMPACT_TANGENTIAL);
        for (int h = 0; h < rod.holds; h++) {
            const double wanted = answers[h][0] * normal + answers[h][1] * across;
            assert_near(qvec3_norm(o.meetings[1 + h].impulse) / normal, wanted / normal, 1e-12 * (1 + a));
            assert_int_equal(o.meetings[1 + h].phase_count, 0);
        }
        assert_true(o.outcome.energy_after < o.outcome.energy_before);
    }
    for (int which = 0; which < 3; which++) assert_true(drawn[which] > 50 && kept[which] > 50);
    assert_true(free_too < drawn[0] + drawn[1] + drawn[2]); /* bodies alone would not tell which are */
}

/* ---- springs ---- */

/* The limit of an approach s that goes to nothing: off by s/|a|, or, where Hertz's holds swing beside the growth of the
 * force at A, by s^(4/5). */
static void springs_are_the_limit_of_an_approach(void **state)
{
    (void)state;
    random_stream random = {31};
    int drawn = 0;
    for (int run = 0; run < 300; run++) {
        const held_rod rod = draw_rod(&random, (held_case)(run % 3));
        random_encounter e = encounter_from(&rod, quat_identity(), 0.2 + 0.8 * random_unit(&random), run % 5 == 0);
        for (int i = 0; i < e.meeting_count; i++) {
            e.meetings[i].stiffness = random_log(&random, 0.1, 10);
            if (i > 0) e.meetings[i].restitution = 0.2 + 0.8 * random_unit(&random);
        }
        double answers[HOLDS][2], k[3];
        find_answers(&rod, answers);
        find_response(&rod, answers, k);
        const double near = fmin(1, fabs(k[0] + rod.friction * k[1]));
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, run % 2 ? 1 : 1.5, NULL);
        const bool tangential = a.meetings[0].phase_count > 0 && a.meetings[0].phases[0] == IMPACT_TANGENTIAL;
        assert_true(a.status == IMPACT_OK || (a.status == IMPACT_SEPARATING && !tangential));
        drawn += tangential;
        e.meetings[0].pressed = false;
        const double height = e.bodies[0].velocity.z;
        for (double seed = 1e-4; seed > 1e-9; seed *= 1e-2) {
            e.bodies[0].velocity.z = height - seed * rod.slip;
            const answer b = solve(&e, IMPACT_TOGETHER_SPRINGS, run % 2 ? 1 : 1.5, NULL);
            assert_int_equal(b.status, IMPACT_OK);
            for (int body = 0; body < 2; body++)
                assert_at_most(qvec3_norm(qvec3_sub(a.velocity[body], b.velocity[body])),
                               20 * pow(seed, 0.8) / near * rod.slip);
        }
    }
    assert_true(drawn > 50);
}

/* ---- what else there may be ---- */

/* One contact alone is impact_collide's; a group of which something else approaches is answered as ever. */
static void pressed_changes_nothing_else(void **state)
{
    (void)state;
    random_stream random = {37};
    for (int run = 0; run < 300; run++) {
        random_encounter e = encounter_draw(&random, &(encounter_ranges){2, 6, 2, 0.1, 10, 10});
        const impact_together_law law = run % 2 ? IMPACT_TOGETHER_SPRINGS : IMPACT_TOGETHER_MOREAU;
        const answer plain = solve(&e, law, 1, NULL);
        for (int i = 0; i < e.meeting_count; i++) e.meetings[i].pressed = true;
        const answer pressed = solve(&e, law, 1, NULL);
        assert_int_equal(plain.status, pressed.status);
        for (int i = 0; i < e.meeting_count && plain.status == IMPACT_OK; i++)
            assert_true(pressed.meetings[i].phase_count == 0 || pressed.meetings[i].phases[0] != IMPACT_TANGENTIAL);
    }
    held_rod rod = draw_rod(&random, AT_A_WALL);
    rod.holds = 0;
    random_encounter e = encounter_from(&rod, quat_identity(), 0.5, false);
    e.meetings[0].friction = 30;
    impact_collision alone = {.body = {e.bodies[0], e.bodies[STATIC]},
                              .normal = e.meetings[0].normal,
                              .friction = 30,
                              .restitution = 0.5,
                              .law = IMPACT_POISSON,
                              .pressed = true};
    alone.body[0].offset = e.meetings[0].offset1, alone.body[1].offset = e.meetings[0].offset2;
    impact_outcome one;
    const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
    assert_int_equal(impact_collide(&alone, &one), a.status);
    assert_int_equal(a.status, IMPACT_OK);
    assert_memory_equal(&a.velocity[0], &one.velocity[0], sizeof one.velocity[0]);
    e.meetings[1] = e.meetings[0], e.meeting_count = 2;
    e.meetings[1].pressed = false;
    char message[200];
    const impact_encounter twice = encounter_of(&e, IMPACT_TOGETHER_MOREAU);
    assert_int_equal(impact_collide_together_check(&twice, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "contact 1 is contact 0 again, pressed the one and not the other");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holds_answer_as_in_closed_form),
        cmocka_unit_test(springs_are_the_limit_of_an_approach),
        cmocka_unit_test(pressed_changes_nothing_else),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
