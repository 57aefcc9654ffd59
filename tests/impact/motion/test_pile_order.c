/* SPDX-License-Identifier: MIT
 *
 * Steps of what is held, as long as their error allows: half the step leaves a quarter of the error. The way that they
 * are held to is that of the exact motion: reactions from the accelerations, by an integrator.
 */
#include "motion/pile.h"
#include <math.h>
#include "kit/islands.h"

static const double gravity = 9.81;

typedef struct held_case {
    impact_body_def body;
    double duration;
} held_case;

/* On its lower edge, on a corner that slides, and rolling and sliding about on all its surface. */
static held_case case_of(int k)
{
    held_case c = {.body = ball_body("body", (qvec3){0, 0, 0}, 0.9, 0)};
    c.body.mass = 1;
    if (k == 2) {
        assert_int_equal(impact_shape_superquadric(0.1, 0.15, 0.2, 2, 2, 2, &c.body.shape), IMPACT_OK);
        c.body.position.z = 0.2;
        c.body.friction = 0.3;
        c.body.omega = (qvec3){2, 3, 3};
        c.body.velocity = (qvec3){0.3, 0, 0};
        c.duration = 0.3;
        return c;
    }
    assert_int_equal(impact_shape_box(0.1, k == 0 ? 0.1 : 0.2, 0.3, 0, &c.body.shape), IMPACT_OK);
    c.body.orientation =
        k == 0 ? quat_from_rotation_vector((qvec3){0, 0.25, 0}) : quat_from_rotation_vector((qvec3){0.64, 0.26, 0.13});
    c.body.friction = k == 0 ? 0.9 : 0.2;
    if (k == 1) c.body.omega = (qvec3){0.1, 0.2, 3};
    const qvec3 down = quat_rotate_inverse(c.body.orientation, (qvec3){0, 0, -1});
    qvec3 corner;
    c.body.position.z = impact_shape_support(&c.body.shape, down, &corner);
    c.body.velocity.z =
        -qvec3_cross(c.body.omega, quat_rotate(c.body.orientation, corner)).z; /* it is held from the start */
    c.duration = k == 0 ? 0.25 : 0.12;
    return c;
}

static impact_scene *scene_of(const held_case *c, impact_body_def bodies[2])
{
    bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), c->body.friction, 0);
    bodies[1] = c->body;
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.bodies = bodies, def.body_count = 2;
    def.duration = c->duration;
    return make_scene(&def);
}

static imp_state by_integrator(const held_case *c)
{
    impact_body_def bodies[2];
    impact_scene *scene = scene_of(c, bodies);
    impact_sample sample;
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    assert_int_equal(impact_scene_usage(scene).pile_steps, 0);
    assert_int_equal(impact_scene_body(scene, 1, &sample), IMPACT_OK);
    impact_scene_destroy(scene);
    return (imp_state){.x = sample.position, .v = sample.velocity, .q = sample.orientation};
}

static imp_state by_steps(const held_case *c, double tolerance, int *steps)
{
    impact_body_def bodies[2];
    impact_scene *scene = scene_of(c, bodies);
    imp_island *island = whole_island(scene);
    imp_pile pile;
    imp_pile_open(&pile, scene->world.arena, tolerance);
    imp_pile_begin(&pile);
    *steps = 0;
    for (double t = 0; t < c->duration; ++*steps) {
        imp_pile_step_result result;
        assert_int_equal(imp_pile_step(&pile, &island->world, t, c->duration - t, island->states, &result), IMPACT_OK);
        assert_true(result.contacts > 0);
        t = result.taken < c->duration - t ? t + result.taken : c->duration;
    }
    const imp_state end = island->states[1];
    impact_scene_destroy(scene);
    return end;
}

static double error_of(const imp_state *a, const imp_state *b)
{
    const quat turn = quat_mul(a->q, quat_conj(b->q));
    return qvec3_norm(qvec3_sub(a->x, b->x)) + 0.1 * qvec3_norm((qvec3){turn.x, turn.y, turn.z}) +
           0.1 * qvec3_norm(qvec3_sub(a->v, b->v));
}

/* What a step may err is as h^3 of what is smooth: with a 64th of it steps are a quarter as long. */
static void half_a_step_leaves_a_quarter_of_the_error(void **state)
{
    (void)state;
    const double tolerance = 1.0 / 64000;
    for (int k = 0; k < 3; k++) {
        const held_case c = case_of(k);
        int few, many;
        const imp_state exact = by_integrator(&c), coarse = by_steps(&c, tolerance, &few),
                        fine = by_steps(&c, tolerance / 64, &many);
        const double error = error_of(&coarse, &exact), finer = error_of(&fine, &exact);
        assert_true(error < 4e-5);
        assert_true(error / finer > 12 && error / finer < 21);
        assert_true(many > 3.5 * few && many < 4.5 * few);
    }
}

/* ---- about an axis that turns ---- */

static const qvec3 twist = {0.1, 0, 0};

static bool turns(double t, int body, double mass, qvec3 position, quat orientation, qvec3 velocity, qvec3 omega,
                  qvec3 *force, qvec3 *torque, void *context)
{
    (void)t, (void)body, (void)mass, (void)position, (void)orientation, (void)velocity, (void)omega, (void)force;
    *torque = *(const qvec3 *)context;
    return true;
}

/* A cube that spins about z and is turned about x at a steady rate: its accelerations stay, its axis does not. */
static void what_turns_about_a_turning_axis_is_off_by_no_more_than_steps_may_err(void **state)
{
    (void)state;
    enum { FINE = 100000 };
    const double duration = 0.5, tolerance = 1e-5, moment = 1.0 / 150;
    const qvec3 from = {0, 0, 40};
    qvec3 torque = twist;
    impact_body_def cube = ball_body("cube", (qvec3){0, 0, 0}, 0, 0);
    cube.mass = 1;
    cube.omega = from;
    assert_int_equal(impact_shape_box(0.1, 0.1, 0.1, 0, &cube.shape), IMPACT_OK);
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = turns;
    force.context = &torque;
    impact_scene_def def = impact_default_scene_def();
    def.bodies = &cube, def.body_count = 1;
    def.gravity = (qvec3){0, 0, 0};
    def.forces = &force, def.force_count = 1;
    impact_scene *scene = make_scene(&def);
    imp_island *island = whole_island(scene);
    island->world.fields = scene->world.fields, island->world.field_count = scene->world.field_count;
    imp_pile pile;
    imp_pile_open(&pile, scene->world.arena, tolerance);
    imp_pile_begin(&pile);
    int steps = 0;
    for (double t = 0; t < duration; steps++) {
        imp_pile_step_result result;
        assert_int_equal(imp_pile_step(&pile, &island->world, t, duration - t, island->states, &result), IMPACT_OK);
        t = result.taken < duration - t ? t + result.taken : duration;
    }
    quat q = quat_identity();
    for (int k = 0; k < FINE; k++) {
        const double h = duration / FINE, middle = (k + 0.5) * h / moment;
        const qvec3 omega = qvec3_axpy(middle, twist, from);
        q = quat_mul(quat_from_rotation_vector(qvec3_scale(omega, h)), q);
    }
    const quat off = quat_mul(island->states[0].q, quat_conj(q));
    const double apart = 2 * qvec3_norm((qvec3){off.x, off.y, off.z});
    assert_true(apart > 0 && apart < steps * tolerance);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_a_step_leaves_a_quarter_of_the_error),
        cmocka_unit_test(what_turns_about_a_turning_axis_is_off_by_no_more_than_steps_may_err)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
