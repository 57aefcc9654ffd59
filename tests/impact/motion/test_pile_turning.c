/* SPDX-License-Identifier: MIT
 *
 * Steps of bodies that resist turning, in the limit of short steps, against Euler's disk: of a tilt that is small the
 * energy is (3/2) m g R alpha, the disk goes round with Omega² = 4 g/(R alpha), its rolling takes rho m g Omega alpha
 * a second, so that the root of alpha falls by (2 rho/(3 R)) sqrt(g/R) a second.
 */
#include "motion/pile.h"
#include <math.h>
#include "kit/islands.h"

static const double gravity = 9.81, radius = 0.05, thickness = 1e-6, mass = 1;

/* (3/2) m g R alpha that are left of a tilt after a time, by steps of h. */
static double tilt_after(double tilt, double rolling, double time, double h)
{
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0),
                                 ball_body("disk", (qvec3){0, 0, 0}, 1, 0)};
    const double omega = 2 * sqrt(gravity / (radius * sin(tilt))), turn = omega * sin(tilt);
    bodies[1].mass = mass;
    bodies[1].moments = (qvec3){mass * radius * radius / 4, mass * radius * radius / 4, mass * radius * radius / 2};
    assert_int_equal(impact_shape_cylinder(radius, 0.5 * thickness, 0, &bodies[1].shape), IMPACT_OK);
    bodies[1].position.z = radius * sin(tilt) + 0.5 * thickness * cos(tilt);
    bodies[1].orientation = (quat){cos(tilt / 2), sin(tilt / 2), 0, 0};
    bodies[1].omega = (qvec3){0, -turn * cos(tilt), -turn * sin(tilt)}; /* along the diameter to the floor */
    bodies[1].rolling_friction = rolling;
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.bodies = bodies, def.body_count = 2;
    impact_scene *scene = make_scene(&def);
    imp_island *island = whole_island(scene);
    imp_pile pile;
    imp_pile_open(&pile, scene->world.arena);
    imp_pile_begin(&pile);
    for (double t = 0; t < time - 0.5 * h;) {
        imp_pile_step_result result;
        pile.step = h;
        assert_int_equal(imp_pile_step(&pile, &island->world, t, h, island->states, &result), IMPACT_OK);
        t += result.taken;
    }
    const double energy = imp_body_energy(&island->world.bodies[1], &island->states[1], def.gravity);
    impact_scene_destroy(scene);
    return energy / (1.5 * mass * gravity * radius);
}

/* The steps err by the square of their length: two lengths give the limit. */
static double limit_after(double tilt, double rolling, double time)
{
    const double h = 1e-5;
    return (4 * tilt_after(tilt, rolling, time, 0.5 * h) - tilt_after(tilt, rolling, time, h)) / 3;
}

static void eulers_disk_falls_as_its_closed_form(void **state)
{
    (void)state;
    const double time = 0.1, tilts[2] = {0.005, 0.01}, lengths[2] = {2e-4, 5e-4};
    for (int k = 0; k < 2; k++) {
        const double still = limit_after(tilts[k], 0, time);
        assert_near(still, tilts[k], 2e-3 * tilts[k]);
        for (int i = 0; i < 2; i++) {
            const double root = sqrt(tilts[k]) - 2 * lengths[i] / (3 * radius) * sqrt(gravity / radius) * time;
            const double fall = still - limit_after(tilts[k], lengths[i], time);
            assert_near(fall / (tilts[k] - root * root), 1, 5e-3);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(eulers_disk_falls_as_its_closed_form)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
