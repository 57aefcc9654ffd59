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
    imp_pile_open(&pile, scene->world.arena, 1e-5);
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

/* ---- a ball that slides, spins and rolls aslant ---- */

typedef struct thrown {
    double v[2], w[3];
} thrown;

static const double ball_radius = 0.1, friction = 0.3, torsional = 0.01, rolling = 0.002;

/* Friction and the moment about the normal are one ellipsoid, against (mu u, tau w_z); rolling is held by rho N. */
static thrown rate_of(thrown b)
{
    const double u[2] = {b.v[0] - ball_radius * b.w[1], b.v[1] + ball_radius * b.w[0]},
                 rub = friction * hypot(u[0], u[1]), size = hypot(rub, torsional * b.w[2]),
                 roll = hypot(b.w[0], b.w[1]),
                 f[2] = {-gravity * friction * friction * u[0] / size, -gravity * friction * friction * u[1] / size},
                 inertia = 0.4 * ball_radius * ball_radius;
    return (thrown){{f[0], f[1]},
                    {(ball_radius * f[1] - rolling * gravity * b.w[0] / roll) / inertia,
                     (-ball_radius * f[0] - rolling * gravity * b.w[1] / roll) / inertia,
                     -gravity * torsional * torsional * b.w[2] / size / inertia}};
}

static thrown along(thrown b, double h, thrown rate)
{
    return (thrown){{b.v[0] + h * rate.v[0], b.v[1] + h * rate.v[1]},
                    {b.w[0] + h * rate.w[0], b.w[1] + h * rate.w[1], b.w[2] + h * rate.w[2]}};
}

static thrown by_rates(thrown b, double time, int steps)
{
    const double h = time / steps;
    for (int i = 0; i < steps; i++) {
        const thrown k1 = rate_of(b), k2 = rate_of(along(b, h / 2, k1)), k3 = rate_of(along(b, h / 2, k2)),
                     k4 = rate_of(along(b, h, k3));
        b = along(along(along(along(b, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
    }
    return b;
}

static thrown by_steps(thrown b, double time, int steps)
{
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), friction, 0),
                                 ball_body("ball", (qvec3){0, 0, ball_radius}, friction, 0)};
    assert_int_equal(impact_shape_sphere(ball_radius, &bodies[1].shape), IMPACT_OK);
    bodies[1].velocity = (qvec3){b.v[0], b.v[1], 0};
    bodies[1].omega = (qvec3){b.w[0], b.w[1], b.w[2]};
    bodies[1].torsional_friction = torsional, bodies[1].rolling_friction = rolling;
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.friction_rule = IMPACT_MINIMUM;
    def.bodies = bodies, def.body_count = 2;
    impact_scene *scene = make_scene(&def);
    imp_island *island = whole_island(scene);
    imp_pile pile;
    imp_pile_open(&pile, scene->world.arena, 1e-3); /* so that steps are as long as they are asked to be */
    imp_pile_begin(&pile);
    for (int k = 0; k < steps; k++) {
        imp_pile_step_result result;
        pile.step = time / steps;
        assert_int_equal(imp_pile_step(&pile, &island->world, 0, time / steps, island->states, &result), IMPACT_OK);
        assert_near(result.taken, time / steps, 1e-12);
    }
    const qvec3 v = island->states[1].v, w = imp_omega(&island->world.bodies[1], &island->states[1]);
    impact_scene_destroy(scene);
    return (thrown){{v.x, v.y}, {w.x, w.y, w.z}};
}

static double apart(thrown a, thrown b)
{
    return hypot(a.v[0] - b.v[0], a.v[1] - b.v[1]) +
           ball_radius * (hypot(a.w[0] - b.w[0], a.w[1] - b.w[1]) + fabs(a.w[2] - b.w[2]));
}

/* Spin and rolling as slip: friction against each as it is in the step's middle. */
static void half_a_step_leaves_a_quarter_of_the_error(void **state)
{
    (void)state;
    const thrown from = {{1, 0.5}, {3, -4, 30}};
    const double time = 0.05;
    const thrown exact = by_rates(from, time, 2000);
    const double error = apart(by_steps(from, time, 20), exact), finer = apart(by_steps(from, time, 40), exact);
    assert_true(error < 2e-6);
    assert_true(error / finer > 3.5 && error / finer < 4.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(eulers_disk_falls_as_its_closed_form),
                                       cmocka_unit_test(half_a_step_leaves_a_quarter_of_the_error)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
