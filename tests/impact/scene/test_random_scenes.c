/* SPDX-License-Identifier: MIT
 *
 * Random scenes: each ends, or says why not; what is called good is finite, has a receipt that holds, and no more
 * energy than it was given. More of them: ./run report scenes.
 */
#include "kit/near.h"
#include "kit/random_scene.h"

static void assert_finite(const impact_scene *scene, int bodies)
{
    for (int i = 0; i < bodies; i++) {
        impact_sample s;
        assert_int_equal(impact_scene_body(scene, i, &s), IMPACT_OK);
        const double sum = s.position.x + s.position.y + s.position.z + s.velocity.x + s.velocity.y + s.velocity.z +
                           s.omega.x + s.omega.y + s.omega.z;
        assert_true(isfinite(sum));
        assert_near(quat_norm(s.orientation), 1, 1e-14);
    }
}

static void every_scene_ends_or_says_why_not(void **state)
{
    (void)state;
    for (unsigned long seed = 1; seed <= 40; seed++) {
        random_scene s;
        random_scene_make(seed, &s);
        s.def.max_steps = 3000;
        impact_scene *scene;
        char message[300];
        if (impact_scene_create(&s.def, &scene, message, sizeof message) != IMPACT_OK)
            fail_msg("seed %lu: %s", seed, message);
        const impact_status status = impact_scene_run(scene, NULL);
        assert_finite(scene, s.def.body_count);
        impact_scene_residuals r;
        const bool holds = impact_scene_receipt(scene, &r) == IMPACT_OK;
        const impact_energy e = impact_scene_energy(scene);
        if (status == IMPACT_OK || status == IMPACT_AT_REST) {
            assert_true(holds);
            assert_at_most(r.momentum, 1e-14);
            const double scale = fabs(e.start) + fabs(e.force_work) + e.kinetic + fabs(e.potential);
            assert_true(e.kinetic + e.potential <= e.start + e.force_work + 1e-8 * scale);
        } else if (impact_scene_message(scene)[0] == '\0') {
            fail_msg("seed %lu: status %d without a word", seed, status);
        }
        impact_scene_destroy(scene);
    }
}

/* A body of exponents 1.12, 1.05 and 1 that rolls over its edge flies off there, by either integrator. */
static void an_edge_is_not_stepped_over(void **state)
{
    (void)state;
    static random_scene s;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    random_scene_make(709680, &s);
    qvec3 place[2];
    for (int k = 0; k < 2; k++) {
        impact_scene_def def = s.def;
        def.methods.motion = k ? IMPACT_MOTION_CVODE : IMPACT_MOTION_AUTO;
        impact_scene *scene;
        impact_sample sharp;
        assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
        assert_int_equal(impact_scene_run_to(scene, 0.498, NULL), IMPACT_OK);
        assert_int_equal(impact_scene_body(scene, 2, &sharp), IMPACT_OK);
        place[k] = sharp.position;
        impact_scene_destroy(scene);
    }
    assert_near3(place[0], place[1], 1e-9);
}

static void ends_with_its_energy(unsigned long seed)
{
    static random_scene s;
    random_scene_make(seed, &s);
    impact_scene *scene;
    impact_scene_residuals r;
    assert_int_equal(impact_scene_create(&s.def, &scene, NULL, 0), IMPACT_OK);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    assert_int_equal(impact_scene_receipt(scene, &r), IMPACT_OK);
    assert_at_most(r.energy, 1e-12);
    impact_scene_destroy(scene);
}

/* A body that sticks in one place and slides in another, which no reactions hold: 1e8 N, of the right signs, were taken
 * for those, and 7 kJ of 140 went at an instant. */
static void modes_that_nothing_holds_are_left(void **state)
{
    (void)state;
    ends_with_its_energy(20422);
}

/* Two superquadrics with edges, face on face: the point that holds them runs from end to end while time stands. Taken
 * for so many steps of a motion that gets on, they asked for the gap 125 000 times by its longest way, six seconds. */
static void what_leaves_time_standing_is_stepped(void **state)
{
    (void)state;
    static random_scene s;
    random_scene_make(25672, &s);
    impact_scene *scene;
    assert_int_equal(impact_scene_create(&s.def, &scene, NULL, 0), IMPACT_OK);
    assert_int_equal(impact_scene_run_to(scene, 0.2, NULL), IMPACT_SOFT); /* told */
    assert_at_most(impact_scene_usage(scene).gap_fallback, 25000);
    assert_true(impact_scene_usage(scene).islands_stepped > 0);
    impact_scene_destroy(scene);
}

/* The least step gave bodies a millijoule, and that was the end of it; two halvings of it give none. */
static void what_gives_energy_is_tried_in_shorter_steps(void **state)
{
    (void)state;
    ends_with_its_energy(40401);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_ends_or_says_why_not), cmocka_unit_test(an_edge_is_not_stepped_over),
        cmocka_unit_test(modes_that_nothing_holds_are_left), cmocka_unit_test(what_leaves_time_standing_is_stepped),
        cmocka_unit_test(what_gives_energy_is_tried_in_shorter_steps)};
    return cmocka_run_group_tests_name("impact.random_scenes", tests, NULL, NULL);
}
