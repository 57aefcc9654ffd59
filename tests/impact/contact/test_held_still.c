/* SPDX-License-Identifier: MIT
 *
 * Bodies at rest on more contacts than the balance of forces can tell apart: whichever way they are turned, with
 * reactions that balance; and what does not rest.
 */
#include "contact/held_still.h"
#include "kit/held_bodies.h"
#include "kit/islands.h"

enum { WALLS = 4, MOST = 8 };

typedef struct slot {
    impact_body_def bodies[MOST];
    impact_scene_def def;
} slot;

/* A ball between a floor, two walls that face each other and one behind, all turned by q. */
static void make_slot(slot *s, double friction, qvec3 pull, quat q)
{
    const double r = radius;
    s->bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0);
    s->bodies[1] = plane_body("left", (qvec3){-r, 0, 0}, (quat){1, 0, 1, 0}, 1, 0);
    s->bodies[2] = plane_body("right", (qvec3){r, 0, 0}, (quat){1, 0, -1, 0}, 1, 0);
    s->bodies[3] = plane_body("back", (qvec3){0, r, 0}, (quat){1, 1, 0, 0}, 1, 0);
    s->bodies[4] = ball_body("ball", (qvec3){0, 0, r}, friction, 0);
    for (int i = 0; i <= WALLS; i++) {
        s->bodies[i].position = quat_rotate(q, s->bodies[i].position);
        quat_normalize(s->bodies[i].orientation, &s->bodies[i].orientation);
        quat_normalize(quat_mul(q, s->bodies[i].orientation), &s->bodies[i].orientation);
    }
    s->def = scene_of(s->bodies, WALLS + 1, 0.5);
    s->def.gravity = quat_rotate(q, pull);
}

/* Newton and Euler for the bodies that move, from the reactions as the contacts have them. */
static void assert_balanced(const impact_scene *scene)
{
    const imp_held *held = &island_of(scene, WALLS)->motion.held;
    const imp_world *world = &island_of(scene, WALLS)->world;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        const double weight = body->mass * qvec3_norm(world->gravity);
        qvec3 force = qvec3_scale(world->gravity, body->mass), torque = {0, 0, 0};
        for (int c = 0; c < held->count; c++) {
            const imp_held_contact *contact = &held->contacts[c];
            if (contact->body1 != i && contact->body2 != i) continue;
            const qvec3 f = contact->body1 == i ? contact->force : qvec3_neg(contact->force);
            force = qvec3_add(force, f);
            torque = qvec3_add(torque, qvec3_cross(contact->body1 == i ? contact->r1 : contact->r2, f));
        }
        assert_near3(force, (qvec3){0, 0, 0}, 1e-10 * weight);
        assert_near3(torque, (qvec3){0, 0, 0}, 1e-10 * weight * body->radius);
    }
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        const double pressure = qvec3_dot(contact->force, contact->normal);
        assert_true(pressure >= 0);
        assert_at_most(qvec3_norm(qvec3_axpy(-pressure, contact->normal, contact->force)),
                       contact->friction * pressure + 1e-13 * qvec3_norm(contact->force));
    }
}

static void a_clamped_ball_rests_however_it_is_turned(void **state)
{
    (void)state;
    const double frictions[4] = {0, 0.1, 0.5, 2};
    random_stream random = {31};
    for (int k = 0; k < 400; k++) {
        slot s;
        make_slot(&s, frictions[k % 4], (qvec3){1, 2, -9}, random_rotation(&random));
        impact_scene *scene = make_scene(&s.def);
        const impact_status status = impact_scene_run(scene, NULL);
        if (status != IMPACT_AT_REST) fail_msg("turn %d: status %d: %s", k, status, impact_scene_message(scene));
        assert_true(impact_scene_time(scene) == 0);
        assert_int_equal(impact_scene_usage(scene).integrator_starts, 0);
        assert_int_equal(island_of(scene, WALLS)->motion.held.count, WALLS);
        for (int p = 0; p < WALLS; p++) assert_true(island_of(scene, WALLS)->world.pairs[p].rest.still);
        assert_balanced(scene);
        impact_scene_destroy(scene);
    }
}

/* Pulled out of the slot, it is clamped by walls that nothing presses: their friction gives way, and it falls freely.
 */
static void walls_that_nothing_presses_hold_nothing(void **state)
{
    (void)state;
    random_stream random = {32};
    for (int k = 0; k < 40; k++) {
        slot s;
        const quat q = random_rotation(&random);
        const qvec3 pull = {0, -3, 5};
        make_slot(&s, 0.5 * (k % 2), pull, q);
        impact_scene *scene = make_scene(&s.def);
        const impact_status status = impact_scene_run(scene, NULL);
        if (status != IMPACT_OK) fail_msg("turn %d: status %d: %s", k, status, impact_scene_message(scene));
        impact_sample at;
        impact_scene_body(scene, WALLS, &at);
        const double t = impact_scene_time(scene);
        const qvec3 wanted = qvec3_axpy(0.5 * t * t, pull, (qvec3){0, 0, radius});
        assert_near3(at.position, quat_rotate(q, wanted), 1e-11);
        impact_scene_destroy(scene);
    }
}

/* A second ball falls upon the clamped one, which is pushed, and both come to rest again. */
static void what_is_still_is_stirred_by_an_impact(void **state)
{
    (void)state;
    random_stream random = {33};
    for (int k = 0; k < 100; k++) {
        slot s;
        const quat q = random_rotation(&random);
        make_slot(&s, 0, (qvec3){0, 2, -9}, q);
        s.bodies[5] = ball_body("other", quat_rotate(q, (qvec3){0, 0, 4 * radius}), 0, 0);
        s.def.body_count = 6;
        s.def.duration = 4;
        impact_scene *scene = make_scene(&s.def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        const impact_status status = impact_scene_run(scene, &recorder);
        if (status != IMPACT_AT_REST) fail_msg("%d: status %d: %s", k, status, impact_scene_message(scene));
        const int rest = find_event(&log, IMPACT_EVENT_REST, NULL, 0),
                  hit = find_event(&log, IMPACT_EVENT_IMPACT, NULL, 0);
        assert_true(rest >= 0 && hit > rest);
        assert_balanced(scene);
        const impact_energy e = impact_scene_energy(scene);
        assert_near(e.kinetic, 0, 1e-15);
        assert_near(e.sliding_loss, 0, 1e-15); /* there is no friction */
        assert_true(e.impact_loss > 0);
        assert_near(e.potential + e.sliding_loss + e.impact_loss, e.start, 1e-9);
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* A ball that slides along between walls that just touch it: their pressures are a choice, and matter where they rub.
 */
static void motion_on_chosen_reactions_is_told(void **state)
{
    (void)state;
    for (int walls = 0; walls < 2; walls++)
        for (int rough = 0; rough < 2; rough++) {
            slot s;
            make_slot(&s, rough ? 0.2 : 0, (qvec3){0, 0, -9.81}, quat_identity());
            s.bodies[4].velocity = (qvec3){0, -0.5, 0};
            if (!walls) s.bodies[1].position.x -= 1;
            impact_scene *scene = make_scene(&s.def);
            assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
            const long chosen = impact_scene_usage(scene).reactions_chosen;
            assert_int_equal(chosen > 0, walls && rough);
            impact_scene_destroy(scene);
        }
}

/* With other forces, that may change, nothing is taken for still. */
static void nothing_is_still_under_other_forces(void **state)
{
    (void)state;
    slot s;
    make_slot(&s, 0.5, (qvec3){1, 2, -9}, quat_identity());
    impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
    wind.strength = 0;
    s.def.forces = &wind;
    s.def.force_count = 1;
    impact_scene *scene = make_scene(&s.def);
    assert_true(impact_scene_run(scene, NULL) >= 0);
    for (int p = 0; p < WALLS; p++) assert_false(island_of(scene, WALLS)->world.pairs[p].rest.still);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest closed_forms[] = {
        cmocka_unit_test(a_clamped_ball_rests_however_it_is_turned),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(walls_that_nothing_presses_hold_nothing),
        cmocka_unit_test(what_is_still_is_stirred_by_an_impact),
        cmocka_unit_test(motion_on_chosen_reactions_is_told),
        cmocka_unit_test(nothing_is_still_under_other_forces),
    };
    const int failed = cmocka_run_group_tests(closed_forms, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
