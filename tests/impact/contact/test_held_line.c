/* SPDX-License-Identifier: MIT
 *
 * Cylinders on their side, flat along their axis: they roll and slide straight in closed form, whatever their exponent,
 * and do not rattle.
 */
#include "kit/held_bodies.h"

static const double exponents[] = {3, 4, 10, 30, 100, 1e4};
enum { EXPONENTS = sizeof exponents / sizeof *exponents };

/* On its side on the plane through 0, turned by tilt, its axis along y of the plane; it goes along x. */
static impact_body_def cylinder_body(double exponent, double friction, quat tilt, double speed)
{
    impact_body_def body = impact_default_body_def();
    body.name = "cylinder";
    body.mass = mass;
    body.friction = friction;
    body.restitution = 0;
    assert_int_equal(impact_shape_superquadric(radius, radius, 2 * radius, 2, 2, exponent, &body.shape), IMPACT_OK);
    body.orientation = quat_mul(tilt, quat_from_rotation_vector((qvec3){acos(0), 0, 0}));
    body.position = quat_rotate(tilt, (qvec3){0, 0, radius});
    body.velocity = quat_rotate(tilt, (qvec3){speed, 0, 0});
    return body;
}

static impact_sample run_on(quat tilt, const impact_body_def *cylinder, double duration, double *stick)
{
    const impact_body_def bodies[2] = {plane_body("plane", (qvec3){0, 0, 0}, tilt, 1, 0), *cylinder};
    const impact_scene_def def = scene_of(bodies, 2, duration);
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    const impact_status status = impact_scene_run(scene, &recorder);
    if (status != IMPACT_OK) fail_msg("p = %g: %s", cylinder->shape.t, impact_scene_message(scene));
    const int at = find_event(&log, IMPACT_EVENT_STICK, "roll", 0);
    if (stick) *stick = at < 0 ? NAN : log.events[at].t;
    const impact_energy e = impact_scene_energy(scene);
    assert_near(e.kinetic + e.potential, e.start - e.sliding_loss - e.impact_loss,
                1e-9 * fmax(fabs(e.start), e.kinetic));
    assert_at_most((double)impact_scene_usage(scene).integrator_steps, 5000);
    impact_sample end;
    impact_scene_body(scene, 1, &end);
    free_log(&log);
    impact_scene_destroy(scene);
    return end;
}

/* J/(m r^2) about the axis. */
static double inertia_ratio(const impact_body_def *body)
{
    return impact_shape_inertia(&body->shape).z / (radius * radius);
}

static void assert_straight(const impact_sample *end, quat tilt, double path, double speed, double spin)
{
    const qvec3 axis = quat_rotate(tilt, (qvec3){0, 1, 0}), own = quat_rotate(end->orientation, (qvec3){0, 0, 1});
    assert_near3(end->position, quat_rotate(tilt, (qvec3){path, 0, radius}), 1e-9);
    assert_near3(end->velocity, quat_rotate(tilt, (qvec3){speed, 0, 0}), 1e-9);
    assert_near3(end->omega, qvec3_scale(axis, spin), 1e-9 / radius);
    assert_near(fabs(qvec3_dot(own, axis)), 1, 1e-12);
}

static void it_rolls_down_a_slope(void **state)
{
    (void)state;
    for (int k = 0; k < EXPONENTS; k++)
        for (double slope = 0.1; slope < 0.8; slope += 0.3) {
            const quat tilt = quat_from_rotation_vector((qvec3){0, slope, 0});
            const impact_body_def body = cylinder_body(exponents[k], 0.8, tilt, 0);
            const double ratio = inertia_ratio(&body), a = gravity * sin(slope) / (1 + ratio), t = 1.3;
            const impact_sample end = run_on(tilt, &body, t, NULL);
            assert_straight(&end, tilt, 0.5 * a * t * t, a * t, a * t / radius);
        }
}

/* Too steep to grip: friction is mu N, whatever the spin. */
static void it_slides_down_a_steep_one(void **state)
{
    (void)state;
    for (int k = 0; k < EXPONENTS; k++) {
        const double slope = 1, friction = 0.1, t = 0.8;
        const quat tilt = quat_from_rotation_vector((qvec3){0, slope, 0});
        const impact_body_def body = cylinder_body(exponents[k], friction, tilt, 0);
        const double pull = friction * gravity * cos(slope), a = gravity * sin(slope) - pull;
        const impact_sample end = run_on(tilt, &body, t, NULL);
        assert_straight(&end, tilt, 0.5 * a * t * t, a * t, pull * t / (radius * inertia_ratio(&body)));
    }
}

/* It slides until it rolls, at v/(1 + J/(m r^2)) of its speed. */
static void it_slides_then_rolls(void **state)
{
    (void)state;
    for (int k = 0; k < EXPONENTS; k++) {
        const double friction = 0.3, speed = 2, t = 1.5;
        const impact_body_def body = cylinder_body(exponents[k], friction, quat_identity(), speed);
        const double ratio = inertia_ratio(&body), rolling = speed / (1 + ratio);
        const double stop = (speed - rolling) / (friction * gravity);
        double stick;
        const impact_sample end = run_on(quat_identity(), &body, t, &stick);
        assert_near(stick, stop, 1e-9);
        assert_straight(&end, quat_identity(), 0.5 * (speed + rolling) * stop + rolling * (t - stop), rolling,
                        rolling / radius);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_rolls_down_a_slope),
        cmocka_unit_test(it_slides_down_a_steep_one),
        cmocka_unit_test(it_slides_then_rolls),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
