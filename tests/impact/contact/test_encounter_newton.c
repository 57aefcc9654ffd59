/* SPDX-License-Identifier: MIT
 *
 * Newton's restitution of all contacts at once: its law by the bodies' velocities and impulses alone, which without
 * friction have one answer; faces that land; the same bits in any order, the same answer in any frame.
 */
#include "kit/near.h"

#include <string.h>
#include <impact/together.h>
#include "kit/encounter_answer.h"

static const encounter_ranges ranges = {2, 8, 3, 0.001, 100, 1};

static random_encounter draw(random_stream *random, bool frictionless)
{
    random_encounter e = encounter_draw(random, &ranges);
    e.restitution = IMPACT_NEWTON;
    for (int i = 0; i < e.meeting_count && frictionless; i++) e.meetings[i].friction = 0;
    return e;
}

/* The relative velocity at a contact. */
static qvec3 slip_of(const impact_meeting *m, const qvec3 *v, const qvec3 *w)
{
    const qvec3 one = qvec3_add(v[m->body1], qvec3_cross(w[m->body1], m->offset1)),
                two = qvec3_add(v[m->body2], qvec3_cross(w[m->body2], m->offset2));
    return qvec3_sub(one, two);
}

/* What the law is missed by, of the fastest contact, and of the greatest impulse times it:
 *     u_n' >= b = eps max(-u_n, 0),   P_n (u_n' - b) = 0,   mu P_n |u_t'| + P_t . u_t' = 0. */
static double law_off(const random_encounter *e, const answer *a)
{
    qvec3 v[ENCOUNTER_BODIES], w[ENCOUNTER_BODIES];
    double off = 0, work = 0, fastest = 0, greatest = 0;
    for (int b = 0; b < e->body_count; b++) v[b] = e->bodies[b].velocity, w[b] = e->bodies[b].omega;
    for (int i = 0; i < e->meeting_count; i++) {
        const impact_meeting *m = &e->meetings[i];
        qvec3 n;
        (void)qvec3_normalize(m->normal, &n);
        const qvec3 before = slip_of(m, v, w), after = slip_of(m, a->velocity, a->omega), p = a->meetings[i].impulse;
        const double rebound = m->restitution * fmax(-qvec3_dot(n, before), 0), un = qvec3_dot(n, after),
                     pn = qvec3_dot(n, p);
        const qvec3 ut = qvec3_axpy(-un, n, after), pt = qvec3_axpy(-pn, n, p);
        fastest = fmax(fastest, fmax(qvec3_norm(before), qvec3_norm(after)));
        greatest = fmax(greatest, qvec3_norm(p));
        off = fmax(off, rebound - un);
        work = fmax(work, fabs(pn * (un - rebound)));
        work = fmax(work, fabs(m->friction * pn * qvec3_norm(ut) + qvec3_dot(pt, ut)));
    }
    return fmax(off / fastest, work / (greatest * fastest));
}

/* Alone a contact goes by impact_collide, whose friction is Coulomb's at every instant of the impact. */
static bool any_alone(const random_encounter *e, const answer *a)
{
    for (int i = 0; i < e->meeting_count; i++) {
        int mates = 0;
        for (int k = 0; k < e->meeting_count; k++) mates += a->meetings[k].group == a->meetings[i].group;
        if (mates == 1 && e->meetings[i].friction > 0) return true;
    }
    return false;
}

static void the_law_holds_over_random_encounters(void **state)
{
    (void)state;
    random_stream random = {41};
    int answered = 0, tried = 0;
    for (int run = 0; run < 3000; run++) {
        const random_encounter e = draw(&random, run % 3 == 0);
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        if (a.status == IMPACT_SEPARATING) continue;
        if (a.status == IMPACT_EUNSETTLED && a.outcome.wedged >= 0) continue;
        tried++;
        if (a.status == IMPACT_EUNSETTLED) continue;
        assert_int_equal(a.status, IMPACT_OK);
        answered++;
        assert_at_most(a.outcome.residual, 1e-12);
        if (!any_alone(&e, &a)) assert_at_most(law_off(&e, &a), 1e-12);
    }
    assert_true(tried > 2900 && answered >= tried - 8); /* what presses a wedge has no answer by Newton's law */
}

/* With one restitution, without friction, and where nothing parts before: by Moreau (1988) energy cannot rise. */
static void one_restitution_without_friction_gains_no_energy(void **state)
{
    (void)state;
    random_stream random = {43};
    int compared = 0;
    for (int run = 0; run < 1500; run++) {
        random_encounter e = draw(&random, true);
        const double restitution = run % 4 ? random_unit(&random) : 1;
        for (int i = 0; i < e.meeting_count; i++) e.meetings[i].restitution = restitution;
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        bool parts = a.status != IMPACT_OK;
        for (int i = 0; i < e.meeting_count && !parts; i++) parts = a.meetings[i].normal_before > 0;
        if (parts) continue;
        compared++;
        assert_at_most(a.outcome.energy_after, a.outcome.energy_before * (1 + 1e-13));
        assert_false(a.outcome.energy_rose);
    }
    assert_true(compared > 300);
}

/* A face of many corners on the floor, that comes down without slip: v' = -eps v, whatever the friction. */
static void a_face_comes_up_flat(void **state)
{
    (void)state;
    random_stream random = {47};
    for (int run = 0; run < 500; run++) {
        const int corners = 2 + run % 15;
        const double eps = run % 5 ? random_unit(&random) : 1, speed = random_log(&random, 1e-6, 1e3);
        random_encounter e = {.body_count = 2, .meeting_count = corners, .restitution = IMPACT_NEWTON};
        const double friction = 3 * random_unit(&random), height = random_log(&random, 0.05, 2);
        e.bodies[0] = encounter_body(&random, &ranges, true);
        e.bodies[0].velocity = (qvec3){0, 0, -speed};
        e.bodies[1] = (impact_collider){.mass = INFINITY, .orientation = {1, 0, 0, 0}};
        for (int i = 0; i < corners; i++) {
            const double turn = 6.283185307179586 * i / corners;
            e.meetings[i] = (impact_meeting){.body1 = 0,
                                             .body2 = 1,
                                             .normal = {0, 0, 1},
                                             .offset1 = {0.7 * cos(turn), 0.3 * sin(turn), -height},
                                             .friction = friction,
                                             .restitution = eps};
        }
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_near3(a.velocity[0], (qvec3){0, 0, eps * speed}, 1e-12 * speed);
        assert_near3(a.omega[0], (qvec3){0, 0, 0}, 1e-11 * speed);
    }
}

/* The two of a dumbbell that comes down on one: the other's velocity is Newton's at neither. */
static void what_stays_apart_takes_no_part(void **state)
{
    (void)state;
    random_encounter e = {.body_count = 2, .meeting_count = 2, .restitution = IMPACT_NEWTON};
    e.bodies[0] = (impact_collider){
        .mass = 1, .moments = {1, 0.25, 1}, .orientation = {1, 0, 0, 0}, .velocity = {0, 0, -1}, .omega = {0, 4, 0}};
    e.bodies[1] = (impact_collider){.mass = INFINITY, .orientation = {1, 0, 0, 0}};
    for (int i = 0; i < 2; i++)
        e.meetings[i] = (impact_meeting){
            .body1 = 0, .body2 = 1, .normal = {0, 0, 1}, .offset1 = {i ? 0.5 : -0.5, 0, 0}, .restitution = 0.5};
    /* u = (1, -3): m (v' - v) = P, J (w' - w) = -P/2 at +1/2, u_2' = 1.5: P (1 + 1) = 4.5, u_1' = 1 + P (1 - 1) */
    const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
    assert_int_equal(a.status, IMPACT_OK);
    assert_near(a.meetings[0].normal_before, 1, 1e-15);
    assert_near(a.meetings[1].normal_before, -3, 1e-15);
    assert_near(a.meetings[0].normal_after, 1, 1e-14);
    assert_near(a.meetings[1].normal_after, 1.5, 1e-14);
    assert_near(a.meetings[1].impulse.z, 2.25, 1e-14);
    assert_near(qvec3_norm(a.meetings[0].impulse), 0, 1e-14);
}

static void neither_order_nor_frame_chooses(void **state)
{
    (void)state;
    random_stream random = {53};
    int compared = 0;
    for (int run = 0; run < 300; run++) {
        const random_encounter e = draw(&random, false);
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        if (a.status != IMPACT_OK) continue;
        random_encounter other = e;
        for (int i = 0; i < e.meeting_count; i++) other.meetings[i] = e.meetings[e.meeting_count - 1 - i];
        const answer b = solve(&other, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_memory_equal(a.velocity, b.velocity, (size_t)e.body_count * sizeof *a.velocity);
        assert_memory_equal(a.omega, b.omega, (size_t)e.body_count * sizeof *a.omega);
        if (a.outcome.chosen) continue;
        const encounter_frame frame = {random_rotation(&random), 2.9, 0.31, 7.3};
        other = change_frame(&e, &frame);
        answer c = solve(&other, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(c.status, IMPACT_OK);
        change_back(&c, e.body_count, &frame);
        const double off = distance(&e, &a, &c);
        assert_at_most(off, allowance(&random, &e, IMPACT_TOGETHER_MOREAU, 0, &a, off));
        compared++;
    }
    assert_true(compared > 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_law_holds_over_random_encounters),
        cmocka_unit_test(one_restitution_without_friction_gains_no_energy),
        cmocka_unit_test(a_face_comes_up_flat),
        cmocka_unit_test(what_stays_apart_takes_no_part),
        cmocka_unit_test(neither_order_nor_frame_chooses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
