/* SPDX-License-Identifier: MIT
 *
 * Superquadrics on ramps (tests/kit/ramp_scene.h; ./run report ramps: a thousand): each comes to its end, and what
 * slides on its flat place does so by the closed form. One that turns as it slides is braked by the friction of its
 * flat place, as a box of that size is.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include "kit/ramp_scene.h"

enum { MOST_STEPS = 200000 };

static long steps;

static bool count(void *context, double t, double end)
{
    (void)context, (void)t, (void)end;
    return ++steps < MOST_STEPS;
}

static impact_sample run(const impact_scene_def *def, impact_status *status, impact_usage *usage)
{
    impact_scene *scene;
    impact_sample sample;
    const impact_recorder recorder = {.struct_size = sizeof recorder, .progress = count};
    steps = 0;
    assert_int_equal(impact_scene_create(def, &scene, NULL, 0), IMPACT_OK);
    *status = impact_scene_run(scene, &recorder);
    *usage = impact_scene_usage(scene);
    impact_scene_body(scene, 1, &sample);
    impact_scene_destroy(scene);
    return sample;
}

/* The last ends its glide on the border of its flat place: from places beyond it would rise, out of nothing. */
static void test_all_end(void **state)
{
    (void)state;
    int closed = 0;
    for (uint64_t n = 1; n <= 91; n++) {
        const uint64_t seed = n <= 90 ? n : 272;
        random_stream random = {seed};
        ramp_scene ramp;
        random_ramp_scene(&random, (int)(seed % RAMP_STARTS), &ramp);
        impact_status status;
        impact_usage usage;
        const impact_sample end = run(&ramp.def, &status, &usage);
        assert_true(status == IMPACT_OK || status == IMPACT_AT_REST);
        if (ramp.start == RAMP_TURNED || !ramp_stays_flat(&ramp)) continue;
        const double way = ramp_way(&ramp, ramp.def.duration);
        const qvec3 due = qvec3_axpy(way, ramp.down, ramp.bodies[1].position);
        assert_true(qvec3_norm(qvec3_sub(end.position, due)) <= 1e-13 * (1 + fabs(way)));
        assert_int_equal(usage.integrator_steps + usage.pile_steps, 0);
        closed++;
    }
    assert_true(closed > 30);
}

/* Of exponent 1e4 the flat place, at 1e-10 m, is all but 1e-3 of the side: where a box of that side stops, it does. */
static void test_turns_as_a_box(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {impact_default_body_def(), impact_default_body_def()};
    impact_scene_def def = impact_default_scene_def();
    bodies[0].name = "floor", bodies[1].name = "body";
    bodies[0].is_static = true, bodies[0].friction = 1;
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    bodies[1].mass = 1, bodies[1].friction = 0.3;
    bodies[1].position = (qvec3){0, 0, 0.05};
    bodies[1].velocity = (qvec3){0.6, 0.2, 0}, bodies[1].omega = (qvec3){0, 0, 7};
    bodies[1].moments = (qvec3){0.004, 0.004, 0.005}; /* of both: what differs is the face alone */
    def.gravity = (qvec3){0, 0, -9.81};
    def.bodies = bodies, def.body_count = 2, def.duration = 2, def.output_rate = 0;
    impact_status status;
    impact_usage usage;
    impact_shape_superquadric(0.1, 0.08, 0.05, 1e4, 1e4, 1e4, &bodies[1].shape);
    const impact_sample quadric = run(&def, &status, &usage);
    assert_int_equal(status, IMPACT_AT_REST);
    assert_int_equal(usage.pile_steps, 0);
    assert_int_equal(usage.integrators, 0);
    impact_shape_box(0.1, 0.08, 0.05, 0, &bodies[1].shape);
    const impact_sample box = run(&def, &status, &usage);
    assert_int_equal(status, IMPACT_AT_REST);
    const double way = qvec3_norm(qvec3_sub(box.position, bodies[1].position));
    assert_true(qvec3_norm(qvec3_sub(quadric.position, box.position)) < 2e-3 * way);
    assert_true(fabs(quadric.t - box.t) < 2e-3 * box.t);
    assert_true(fabs(quadric.orientation.z - box.orientation.z) < 4e-3 * fabs(box.orientation.z));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_all_end), cmocka_unit_test(test_turns_as_a_box)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
