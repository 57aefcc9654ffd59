/* SPDX-License-Identifier: MIT
 *
 * Balls that roll and slide in closed form: against the integrator (the same scene with a damping that takes 1e-17 of
 * the motion in a second), against formulas, in parts, and for ever.
 */
#include <math.h>
#include "kit/scene_log.h"
#include "kit/contact_random.h"

static const double radius = 0.3, gravity = 9.81;

/* A ball on a plane that is level or tilted by up to 50 degrees; its slip lies in the line of descent, where there is
 * one. */
static void draw_ball(random_stream *random, impact_body_def bodies[2])
{
    const bool level = random_unit(random) < 0.3;
    const double tilt = level ? 0 : 0.9 * random_unit(random), turn = 6.3 * random_unit(random);
    const quat q =
        quat_mul(quat_from_rotation_vector((qvec3){0, 0, turn}), quat_from_rotation_vector((qvec3){0, tilt, 0}));
    const qvec3 n = quat_rotate(q, (qvec3){0, 0, 1}), down = quat_rotate(q, (qvec3){1, 0, 0});
    const qvec3 aside = level ? quat_rotate(q, (qvec3){0, 1, 0}) : (qvec3){0, 0, 0};
    const double friction = random_unit(random) < 0.2 ? 0 : random_log(random, 0.01, 1);
    bodies[0] = plane_body("plane", qvec3_scale(random_direction(random), random_unit(random)), q, 1, 0);
    bodies[1] = ball_body("ball", qvec3_axpy(radius, n, bodies[0].position), friction, 0);
    const double v = random_unit(random) < 0.2 ? 0 : 4 * random_unit(random) - 2, w = 10 * random_unit(random) - 5;
    bodies[1].velocity = qvec3_axpy(v, down, qvec3_scale(aside, random_unit(random)));
    bodies[1].omega = qvec3_axpy(w, qvec3_cross(n, down), qvec3_scale(n, 20 * random_unit(random) - 10));
}

static impact_scene_def scene_of(const impact_body_def *bodies, double duration)
{
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.bodies = bodies;
    def.body_count = 2;
    def.friction_rule = def.restitution_rule = IMPACT_PRODUCT;
    def.duration = duration;
    return def;
}

static impact_usage run_ball(const impact_scene_def *def, scene_log *log, impact_sample *end)
{
    impact_scene *scene = make_scene(def);
    const impact_recorder recorder = log_recorder(log);
    const impact_status status = impact_scene_run(scene, &recorder);
    assert_true(status == IMPACT_OK || status == IMPACT_AT_REST);
    assert_int_equal(impact_scene_body(scene, 1, end), IMPACT_OK);
    const impact_energy e = impact_scene_energy(scene);
    const double scale = fmax(fabs(e.start), fmax(fabs(e.potential), e.kinetic));
    assert_near(e.kinetic + e.potential + e.sliding_loss + e.impact_loss + e.damping_loss, e.start, 1e-12 * scale);
    const impact_usage usage = impact_scene_usage(scene);
    impact_scene_destroy(scene);
    return usage;
}

static void as_the_integrator_has_it(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    random_stream random = {11};
    int sticks = 0;
    for (int i = 0; i < 300; i++) {
        impact_body_def bodies[2];
        draw_ball(&random, bodies);
        impact_scene_def def = scene_of(bodies, 2);
        scene_log exact = {0}, integrated = {0};
        impact_sample a, b;
        const impact_usage usage = run_ball(&def, &exact, &a);
        assert_true(usage.rolls > 0 && usage.integrators == 0);
        bodies[1].linear_damping = bodies[1].angular_damping = 1e-17;
        assert_true(run_ball(&def, &integrated, &b).integrator_steps > 0);
        assert_near3(a.position, b.position, 1e-9);
        assert_near3(a.velocity, b.velocity, 1e-8);
        assert_near3(a.omega, b.omega, 1e-7);
        assert_near(fabs(quat_dot(a.orientation, b.orientation)), 1, 1e-9);
        assert_int_equal(exact.event_count, integrated.event_count);
        for (int k = 0; k < exact.event_count; k++) {
            assert_int_equal(exact.events[k].kind, integrated.events[k].kind);
            assert_near(exact.events[k].t, integrated.events[k].t, 1e-9);
            sticks += exact.events[k].kind == IMPACT_EVENT_STICK;
        }
        free_log(&exact);
        free_log(&integrated);
    }
    assert_true(sticks > 50);
}

/* Slip dies out at 2 v/(7 mu g) with 5/7 of the speed left; then it goes on for ever, and nothing is computed. */
static void rolls_for_ten_thousand_seconds(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 1, 0),
                                 ball_body("ball", (qvec3){0, 0, radius}, 0.25, 0)};
    bodies[1].velocity = (qvec3){3, 4, 0};
    impact_scene_def def = scene_of(bodies, 1e4);
    def.output_rate = 0.01;
    scene_log log = {0};
    impact_sample end;
    const impact_usage usage = run_ball(&def, &log, &end);
    assert_int_equal(usage.integrators, 0);
    assert_int_equal(usage.rolls, 2);
    const double slid = 2 * 5 / (7 * 0.25 * gravity), left = 5 * 5.0 / 7;
    const int stick = find_event(&log, IMPACT_EVENT_STICK, "roll", 0);
    assert_true(stick >= 0);
    assert_near(log.events[stick].t, slid, 1e-14);
    const double way = 0.5 * (5 + left) * slid + left * (1e4 - slid);
    assert_near3(end.position, (qvec3){0.6 * way, 0.8 * way, radius}, 1e-11 * way);
    assert_near3(end.velocity, (qvec3){0.6 * left, 0.8 * left, 0}, 1e-14);
    free_log(&log);
}

/* A ball rolls off the edge of a table: when, and how fast. */
static void leaves_a_table(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("table", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 1, 0),
                                 ball_body("ball", (qvec3){0, 0, radius}, 0.25, 0)};
    impact_shape_plane(2, 2, &bodies[0].shape);
    bodies[1].velocity = (qvec3){1, 0, 0};
    bodies[1].omega = (qvec3){0, 1 / radius, 0};
    const impact_scene_def def = scene_of(bodies, 3);
    scene_log log = {0};
    impact_sample end;
    assert_int_equal(run_ball(&def, &log, &end).integrators, 0);
    const int off = find_event(&log, IMPACT_EVENT_LIFTOFF, NULL, 0);
    assert_true(off >= 0);
    const double half = bodies[0].shape.a;
    assert_near(log.events[off].t, half, 1e-14);
    const double fall = 3 - half;
    assert_near3(end.position, (qvec3){3, 0, radius - 0.5 * gravity * fall * fall}, 1e-13);
    free_log(&log);
}

static void in_parts_the_same_bits(void **state)
{
    (void)state;
    random_stream random = {12};
    for (int i = 0; i < 200; i++) {
        impact_body_def bodies[2];
        draw_ball(&random, bodies);
        const impact_scene_def def = scene_of(bodies, 2);
        impact_scene *whole = make_scene(&def), *parts = make_scene(&def);
        impact_sample a, b;
        impact_scene_run(whole, NULL);
        for (double t = 0; t < 2; t += 0.4 * random_unit(&random)) impact_scene_run_to(parts, t, NULL);
        impact_scene_run(parts, NULL);
        impact_scene_body(whole, 1, &a);
        impact_scene_body(parts, 1, &b);
        assert_memory_equal(&a.position, &b.position, sizeof a.position);
        assert_memory_equal(&a.orientation, &b.orientation, sizeof a.orientation);
        assert_memory_equal(&a.velocity, &b.velocity, sizeof a.velocity);
        assert_memory_equal(&a.omega, &b.omega, sizeof a.omega);
        const impact_energy e = impact_scene_energy(whole), f = impact_scene_energy(parts);
        assert_near(e.sliding_loss, f.sliding_loss, 1e-13 * (1 + e.sliding_loss));
        impact_scene_destroy(whole);
        impact_scene_destroy(parts);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_the_integrator_has_it),
        cmocka_unit_test(rolls_for_ten_thousand_seconds),
        cmocka_unit_test(leaves_a_table),
        cmocka_unit_test(in_parts_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
