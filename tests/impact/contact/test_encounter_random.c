/* SPDX-License-Identifier: MIT
 *
 * Random encounters: the same bits in any order, the same answer in any frame and units, receipts, energies; and those
 * of a struck cube.
 */
#include "kit/near.h"

#include <string.h>
#include <impact/together.h>
#include "kit/encounter_answer.h"

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

static void turning_the_scene_and_changing_units_changes_nothing(void **state)
{
    (void)state;
    random_stream random = {13};
    int compared = 0;
    for (int run = 0; run < 300; run++) {
        const random_encounter e = encounter_draw(&random, &campaign);
        const encounter_frame frame = {random_rotation(&random), 2.9, 0.31, 7.3};
        const random_encounter other = change_frame(&e, &frame);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 0, NULL);
        answer b = solve(&other, IMPACT_TOGETHER_SPRINGS, 0, NULL);
        if (a.status != IMPACT_OK || b.status != IMPACT_OK) continue;
        change_back(&b, e.body_count, &frame);
        const double off = distance(&e, &a, &b);
        assert_at_most(off, allowance(&random, &e, IMPACT_TOGETHER_SPRINGS, 0, &a, off));
        compared++;
    }
    assert_true(compared > 250);
}

/* How far linear momenta of the bodies are off, and impulses out of their cones: of the largest impulse. */
static double momentum_off(const random_encounter *e, const answer *a, double largest)
{
    double off = 0;
    for (int b = 0; b < e->body_count; b++) {
        if (isinf(e->bodies[b].mass)) continue;
        qvec3 left = qvec3_scale(qvec3_sub(e->bodies[b].velocity, a->velocity[b]), e->bodies[b].mass);
        double size = largest + e->bodies[b].mass * qvec3_norm(e->bodies[b].velocity);
        for (int i = 0; i < e->meeting_count; i++) {
            const impact_meeting *m = &e->meetings[i];
            if (m->body1 == b) left = qvec3_add(left, a->meetings[i].impulse);
            if (m->body2 == b) left = qvec3_sub(left, a->meetings[i].impulse);
        }
        off = fmax(off, qvec3_norm(left) / size);
    }
    return off;
}

static double cones_off(const random_encounter *e, const answer *a, double largest)
{
    double off = 0;
    for (int i = 0; i < e->meeting_count; i++) {
        qvec3 n;
        (void)qvec3_normalize(e->meetings[i].normal, &n);
        const qvec3 p = a->meetings[i].impulse;
        const double normal = qvec3_dot(n, p), across = qvec3_norm(qvec3_axpy(-normal, n, p));
        off = fmax(off, fmax(-normal, across - e->meetings[i].friction * normal) / largest);
    }
    return off;
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
        double largest = 0;
        for (int i = 0; i < e.meeting_count; i++) largest = fmax(largest, qvec3_norm(a.meetings[i].impulse));
        assert_at_most(a.outcome.residual, law == IMPACT_TOGETHER_SEQUENCE ? 1e-11 : 1e-13);
        if (law != IMPACT_TOGETHER_SEQUENCE) assert_at_most(momentum_off(&e, &a, largest), 1e-15);
        if (law != IMPACT_TOGETHER_SEQUENCE) assert_at_most(cones_off(&e, &a, largest), 1e-15);
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

/* With one restitution for all. */
static void moreau_s_energy_rises_only_by_different_restitutions(void **state)
{
    (void)state;
    const encounter_ranges ranges = {2, 8, 10, 0.05, 1e4, 1e4};
    random_stream random = {77};
    for (int run = 0; run < 600; run++) {
        random_encounter e = encounter_draw(&random, &ranges);
        const double restitution = run % 3 ? random_unit(&random) : 1;
        for (int i = 0; i < e.meeting_count; i++) e.meetings[i].restitution = restitution;
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        if (a.status != IMPACT_OK) continue;
        assert_false(a.outcome.energy_rose);
        assert_at_most(a.outcome.energy_after, a.outcome.energy_before * (1 + 1e-13));
    }
}

/* A cube falls with a corner on one that rests on the floor, which four contacts hold more than they need to: with
 * friction this strong they stick and give way by turns, and all creep together, so slowly that friction turns them
 * a million times faster than they go. Every second is without restitution: springs take that as more and say by how
 * much velocities are off for it, and no frame is further off another than that. Run 2 is chaos within it: 1e-16 of
 * the data moves it as far as 1e-5 does. */
static random_encounter draw_struck_cube(random_stream *random)
{
    const double friction = 0.9 + 0.1 * random_unit(random), restitution = random_unit(random) < 0.5 ? 0.3 : 0;
    random_encounter e = {.body_count = 3, .meeting_count = 5};
    e.bodies[0] = (impact_collider){.mass = INFINITY, .orientation = {1, 0, 0, 0}};
    e.bodies[1] =
        (impact_collider){.mass = 1, .moments = {1 / 600.0, 1 / 600.0, 1 / 600.0}, .orientation = {1, 0, 0, 0}};
    e.bodies[2] = e.bodies[1];
    e.bodies[2].velocity.z = -1 - random_unit(random);
    const quat turn = e.bodies[2].orientation = random_rotation(random);
    qvec3 lowest = {0, 0, 1};
    for (int k = 0; k < 8; k++) {
        const qvec3 corner =
            quat_rotate(turn, (qvec3){k & 1 ? 0.05 : -0.05, k & 2 ? 0.05 : -0.05, k & 4 ? 0.05 : -0.05});
        if (corner.z < lowest.z) lowest = corner;
    }
    for (int i = 0; i < 4; i++) {
        const double x = i == 1 || i == 2 ? 0.05 : -0.05, y = i < 2 ? -0.05 : 0.05;
        e.meetings[i] = (impact_meeting){.body1 = 1,
                                         .normal = {0, 0, 1},
                                         .offset1 = {x, y, -0.05},
                                         .offset2 = {x, y, 0},
                                         .friction = friction,
                                         .restitution = restitution,
                                         .stiffness = 0.387};
    }
    const double x = 0.1 * random_unit(random) - 0.05, y = 0.1 * random_unit(random) - 0.05;
    e.meetings[4] = (impact_meeting){.body1 = 1,
                                     .body2 = 2,
                                     .normal = {0, 0, -1},
                                     .offset1 = {x, y, 0.05},
                                     .offset2 = lowest,
                                     .friction = friction,
                                     .restitution = restitution,
                                     .stiffness = 0.294};
    return e;
}

static void a_struck_cube_on_the_floor_is_answered(void **state)
{
    (void)state;
    int chosen = 0;
    for (uint64_t run = 0; run < 40; run++) {
        random_stream random = {1000003 * run + 17};
        const random_encounter e = draw_struck_cube(&random);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(a.outcome.residual, 1e-12);
        chosen += a.outcome.chosen;
        if (run % 4 != 2) continue;
        const encounter_frame frame = {random_rotation(&random), 2.9, 0.31, 7.3};
        const random_encounter other = change_frame(&e, &frame);
        answer b = solve(&other, IMPACT_TOGETHER_SPRINGS, 0, NULL);
        assert_int_equal(b.status, IMPACT_OK);
        change_back(&b, e.body_count, &frame);
        assert_at_most(distance(&e, &a, &b), fmax(1e-11, a.outcome.error));
    }
    assert_true(chosen > 30);
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
 * thousand times its dents and more, and comes back where it closed; at rest at last but for the energy of a spring
 * that counts as open, 2^-90. */
static void long_flights_come_back_to_where_contacts_close(void **state)
{
    (void)state;
    const encounter_ranges ranges = {2, 3, 10, 0.05, 1e4, 1e4};
    random_stream random = {1 + 0x9e3779b97f4a7c15u * 644u};
    const random_encounter e = encounter_draw(&random, &ranges);
    const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 1, NULL);
    assert_int_equal(a.status, IMPACT_OK);
    assert_at_most(a.outcome.residual, 0x1p-44);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbering_and_order_change_no_bit),
        cmocka_unit_test(turning_the_scene_and_changing_units_changes_nothing),
        cmocka_unit_test(moreau_s_energy_rises_only_by_different_restitutions),
        cmocka_unit_test(receipts_hold_over_random_encounters),
        cmocka_unit_test(a_struck_cube_on_the_floor_is_answered),
        cmocka_unit_test(elastic_encounters_without_friction_keep_energy),
        cmocka_unit_test(long_flights_come_back_to_where_contacts_close),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
