/* SPDX-License-Identifier: MIT
 *
 * Bodies that lie on a flat face: they slide to rest in closed form, turn, ride on belts, stand on slopes, tip over;
 * and what is dropped on a face comes to rest there.
 */
#include "kit/held_bodies.h"
#include <impact/face.h>

static const double half[3] = {0.2, 0.25, 0.15};

/* A box-like body of the exponent p, on its largest face on z = 0. */
static impact_body_def box_body(double p, double friction)
{
    impact_body_def body = impact_default_body_def();
    body.name = "box";
    body.mass = mass;
    body.friction = friction;
    body.restitution = 0;
    body.position.z = half[2];
    assert_int_equal(impact_shape_superquadric(half[0], half[1], half[2], p, p, p, &body.shape), IMPACT_OK);
    return body;
}

static impact_scene *run_on(const impact_body_def *plane, const impact_body_def *box, double duration,
                            impact_status expected, scene_log *log)
{
    const impact_body_def bodies[2] = {*plane, *box};
    const impact_scene_def def = scene_of(bodies, 2, duration);
    impact_scene *scene = make_scene(&def);
    const impact_recorder recorder = log_recorder(log);
    const impact_status status = impact_scene_run(scene, &recorder);
    if (status != expected)
        fail_msg("p = %g: %s %s", box->shape.r, impact_status_string(status), impact_scene_message(scene));
    return scene;
}

static void assert_account(const impact_scene *scene, double tolerance)
{
    const impact_energy e = impact_scene_energy(scene);
    assert_near(e.kinetic + e.potential,
                e.start + e.force_work + e.drive_work - e.sliding_loss - e.impact_loss - e.damping_loss,
                tolerance * fmax(fabs(e.start), e.sliding_loss));
}

/* ---- without turning ---- */

static void a_box_slides_to_rest(void **state)
{
    (void)state;
    static const double exponents[] = {20, 50, 100, 1000, 1e5};
    for (size_t k = 0; k < sizeof exponents / sizeof *exponents; k++)
        for (double speed = 0.01; speed < 20; speed *= 7) {
            const double friction = 0.3, angle = 0.7 * (double)k;
            impact_body_def box = box_body(exponents[k], friction);
            const impact_body_def floor = floor_body();
            const qvec3 way = {cos(angle), sin(angle), 0};
            box.velocity = qvec3_scale(way, speed);
            scene_log log = {0};
            impact_scene *scene = run_on(&floor, &box, 10, IMPACT_AT_REST, &log);
            impact_sample end;
            impact_scene_body(scene, 1, &end);
            const double stop = speed / (friction * gravity), path = 0.5 * speed * stop;
            const int rest = find_event(&log, IMPACT_EVENT_REST, NULL, 0);
            assert_near(log.events[rest].t, stop, 1.001e-9 / (friction * gravity)); /* rest_speed */
            assert_near3(end.position, (qvec3){path * way.x, path * way.y, half[2]}, 1e-11 * (1 + path));
            assert_near(impact_scene_energy(scene).sliding_loss, 0.5 * mass * speed * speed,
                        1e-10 * speed * speed + 1e-13);
            assert_account(scene, 1e-11);
            assert_int_equal(impact_scene_usage(scene).events[IMPACT_EVENT_SLIP], 0);
            free_log(&log);
            impact_scene_destroy(scene);
        }
}

/* Each of four bodies slides as it does alone. */
static void many_boxes_slide_to_rest(void **state)
{
    (void)state;
    enum { BOXES = 4 };
    static const char *const names[BOXES] = {"one", "two", "three", "four"};
    const double friction = 0.25;
    impact_body_def bodies[BOXES + 1] = {floor_body()};
    for (int i = 0; i < BOXES; i++) {
        impact_body_def *box = &bodies[i + 1];
        *box = box_body(100, friction);
        box->name = names[i];
        box->position.x = i;
        box->velocity.y = 1 + 0.5 * i;
    }
    const impact_scene_def def = scene_of(bodies, BOXES + 1, 5);
    impact_scene *scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_AT_REST);
    for (int i = 0; i < BOXES; i++) {
        impact_sample end;
        impact_scene_body(scene, i + 1, &end);
        const double v = bodies[i + 1].velocity.y;
        assert_near3(end.position, (qvec3){i, v * v / (2 * friction * gravity), half[2]}, 1e-11);
    }
    assert_account(scene, 1e-11);
    impact_scene_destroy(scene);
}

/* A ball that strikes a box at rest sets it sliding: it comes to rest on its face again. */
static void a_struck_box_lies_down_again(void **state)
{
    (void)state;
    impact_body_def box = box_body(100, 0.5), ball = ball_body("ball", (qvec3){-0.8, 0, 0.15}, 0, 0.5);
    box.restitution = 0.5;
    ball.mass = 1;
    impact_shape_sphere(0.1, &ball.shape);
    ball.velocity = (qvec3){2, 0, 0};
    impact_body_def bodies[3] = {floor_body(), box, ball};
    bodies[0].restitution = 1;
    impact_scene_def def = scene_of(bodies, 3, 0.6);
    impact_scene *scene = make_scene(&def);
    assert_true(impact_scene_run(scene, NULL) >= 0);
    impact_sample end;
    impact_scene_body(scene, 1, &end);
    assert_true(end.position.x > 1e-3);
    assert_near(end.position.z, half[2], 1e-12);
    assert_near3(end.velocity, (qvec3){0, 0, 0}, 1e-12);
    assert_account(scene, 1e-9);
    impact_scene_destroy(scene);
}

/* On a slope it stays, or slides at g (sin - mu cos). */
static void a_slope_holds_up_to_its_friction(void **state)
{
    (void)state;
    for (double slope = 0.05; slope < 0.6; slope += 0.1) {
        const double friction = 0.3, duration = 0.7;
        const quat tilt = quat_from_rotation_vector((qvec3){0, slope, 0}); /* down is +x of the plane */
        impact_body_def box = box_body(100, friction);
        const impact_body_def plane = plane_body("slope", (qvec3){0, 0, 0}, tilt, 1, 0);
        box.orientation = tilt;
        box.position = quat_rotate(tilt, (qvec3){0, 0, half[2]});
        const bool holds = tan(slope) < friction;
        scene_log log = {0};
        impact_scene *scene = run_on(&plane, &box, duration, holds ? IMPACT_AT_REST : IMPACT_OK, &log);
        impact_sample end;
        impact_scene_body(scene, 1, &end);
        const double a = holds ? 0 : gravity * (sin(slope) - friction * cos(slope));
        const qvec3 place = quat_rotate(tilt, (qvec3){0.5 * a * duration * duration, 0, half[2]});
        assert_near3(end.position, place, 1e-12);
        assert_near3(end.velocity, quat_rotate(tilt, (qvec3){a * duration, 0, 0}), 1e-12);
        assert_near(quat_dot(end.orientation, tilt), 1, 1e-15);
        assert_account(scene, 1e-11);
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* Set down on a belt it is brought to the belt's speed. */
static void a_belt_takes_a_box_along(void **state)
{
    (void)state;
    const double friction = 0.4, belt = 1.5;
    impact_body_def box = box_body(60, friction), plane = floor_body();
    plane.velocity = (qvec3){0, belt, 0};
    scene_log log = {0};
    impact_scene *scene = run_on(&plane, &box, 1, IMPACT_OK, &log);
    impact_sample end;
    impact_scene_body(scene, 1, &end);
    const double taken = belt / (friction * gravity);
    assert_near(log.events[find_event(&log, IMPACT_EVENT_STICK, "roll", 0)].t, taken, 1e-11);
    assert_near3(end.velocity, plane.velocity, 1e-12);
    assert_near(end.position.y, belt * (1 - 0.5 * taken), 1e-11);
    assert_near(impact_scene_energy(scene).drive_work, mass * belt * belt, 1e-10);
    assert_account(scene, 1e-11);
    free_log(&log);
    impact_scene_destroy(scene);
}

/* ---- with it ---- */

/* Between z = -c and c over the flat place of the shape's largest face: from whose places it would rise by 1e-10 m, a
 * hundred rest heights, which is p - 1 times as much as they are off its plane. */
static impact_hull *prism_on_flat(const impact_shape *shape)
{
    impact_face face;
    qvec3 points[2 * IMPACT_FACE_RIM];
    impact_hull *hull;
    const double most = fmax(shape->r, fmax(shape->s, shape->t));
    assert_int_equal(impact_shape_face(shape, (qvec3){0, 0, -1}, 1e-10 / (most - 1), &face), 2);
    for (int i = 0; i < face.count; i++) {
        points[i] = points[face.count + i] = face.point[i];
        points[face.count + i].z = -face.point[i].z;
    }
    assert_int_equal(impact_hull_create(points, 2 * (size_t)face.count, 0, NULL, &hull, NULL, 0), IMPACT_OK);
    return hull;
}

/* Sliding and turning, it is braked as a prism on its flat place is, whose motion
 * tests/impact/motion/test_face_motion.c holds to Runge and Kutta's: both ends of the slip come at one instant. */
static void a_turning_box_moves_as_a_prism(void **state)
{
    (void)state;
    random_stream random = {61};
    for (int i = 0; i < 6; i++) {
        const impact_body_def floor = floor_body();
        impact_body_def box = box_body(200, 0.1 + 0.3 * random_unit(&random)), prism = box;
        impact_hull *hull = prism_on_flat(&box.shape);
        box.velocity = random_vector(&random, 0.1, 2);
        box.velocity.z = 0;
        box.omega.z = (random_unit(&random) < 0.5 ? -1 : 1) * random_log(&random, 0.3, 10);
        box.moments = (qvec3){0.05, 0.04, 0.07};
        prism.velocity = box.velocity, prism.omega = box.omega, prism.moments = box.moments;
        assert_int_equal(impact_shape_polyhedron(hull, &prism.shape), IMPACT_OK);
        scene_log log = {0};
        impact_scene *scene = run_on(&floor, &box, 10, IMPACT_AT_REST, &log);
        impact_scene *other = run_on(&floor, &prism, 10, IMPACT_AT_REST, &log);
        impact_sample one, two;
        impact_scene_body(scene, 1, &one);
        impact_scene_body(other, 1, &two);
        assert_near(impact_scene_time(scene), impact_scene_time(other), 1e-9);
        assert_near3(one.position, two.position, 1e-9);
        assert_near(one.orientation.z, two.orientation.z, 1e-9);
        assert_int_equal(impact_scene_usage(scene).pile_steps, 0);
        assert_account(scene, 1e-9);
        free_log(&log);
        impact_scene_destroy(scene);
        impact_scene_destroy(other);
        impact_hull_destroy(hull);
    }
}

/* ---- rest ---- */

/* Dropped at any small tilt, with any restitution, it ends at rest on its face: rocking dies by what slips. */
static void what_drops_on_a_face_comes_to_rest(void **state)
{
    (void)state;
    static const double tilts[] = {0, 1e-6, 1e-3};
    static const double restitutions[] = {0, 0.3, 0.8};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < (i == 1 ? 1 : 3); j++) {
            impact_body_def box = box_body(100, 0.3), floor = floor_body();
            floor.restitution = 1;
            box.restitution = restitutions[j];
            box.orientation = quat_from_rotation_vector((qvec3){0.8 * tilts[i], 0.6 * tilts[i], 0});
            box.position.z =
                0.01 + impact_shape_support(&box.shape, quat_rotate_inverse(box.orientation, (qvec3){0, 0, -1}), NULL);
            scene_log log = {0};
            impact_scene *scene = run_on(&floor, &box, 5, IMPACT_AT_REST, &log);
            impact_sample end;
            impact_scene_body(scene, 1, &end);
            assert_near(end.position.z, half[2], 1e-15);
            const qvec3 down = quat_rotate_inverse(end.orientation, (qvec3){0, 0, -1});
            assert_near3(down, (qvec3){0, 0, -1}, 1e-15);
            assert_near3(end.velocity, (qvec3){0, 0, 0}, 0);
            assert_near3(end.omega, (qvec3){0, 0, 0}, 0);
            assert_account(scene, 1e-9);
            free_log(&log);
            impact_scene_destroy(scene);
        }
}

/* ---- tipping ---- */

/* It reaches what tips the box at 1 s. */
static bool growing_torque(double t, int body, double m, qvec3 position, quat orientation, qvec3 velocity, qvec3 omega,
                           qvec3 *force, qvec3 *torque, void *context)
{
    (void)context, (void)body, (void)m, (void)position, (void)orientation, (void)velocity, (void)omega, (void)force;
    *torque = (qvec3){0, mass * gravity * half[0] * t, 0};
    return true;
}

/* The centre of pressure goes out with the torque, to where the body stands on a point that has risen by rest_height:
 * from there on its contact is carried; at the edge of the face it tips over. */
static void a_box_tips_over_its_edge(void **state)
{
    (void)state;
    impact_body_def box = box_body(100, 0);
    box.velocity.y = 0.3; /* what rests is watched no more */
    const impact_body_def bodies[2] = {floor_body(), box};
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.name = "torque";
    force.body = "box";
    force.function = growing_torque;
    impact_scene_def def = scene_of(bodies, 2, 1.05);
    def.forces = &force;
    def.force_count = 1;
    for (double t = 0.2; t < 1.1; t += 0.25) {
        impact_scene *scene = make_scene(&def);
        assert_int_equal(impact_scene_run_to(scene, t, NULL), IMPACT_OK);
        impact_sample end;
        impact_scene_body(scene, 1, &end);
        const double tilt = 2 * hypot(end.orientation.x, end.orientation.y);
        if (t < 0.7)
            assert_near(tilt, 0, 1e-12);
        else if (t > 1)
            assert_true(tilt > 1e-3);
        assert_account(scene, 1e-9);
        impact_scene_destroy(scene);
    }
}

/* Pushed at its centre by m g t, a box of half sides a and c stands until the centre of its pressure has come to its
 * edge, t = a/c, and then turns about that, at R = (a, c): R^2 (4/3) theta'' = g (t z - x), where the edge is from the
 * centre by x = a cos - c sin, z = c cos + a sin. */
static double sharp_box_tips(double a, double c, double duration)
{
    enum { STEPS = 4000 };
    const double g = 9.8, begin = a / c, h = (duration - begin) / STEPS, inertia = (a * a + c * c) * 4 / 3;
    double theta = 0, omega = 0;
    for (int i = 0; i < STEPS; i++) { /* leapfrog */
        const double middle = theta + 0.5 * h * omega, t = begin + (i + 0.5) * h;
        omega += h * g * (t * (c * cos(middle) + a * sin(middle)) - (a * cos(middle) - c * sin(middle))) / inertia;
        theta = middle + 0.5 * h * omega;
    }
    return omega;
}

static bool push_rising(double t, int body, double weight, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force,
                        qvec3 *torque, void *context)
{
    (void)body, (void)x, (void)q, (void)v, (void)w, (void)torque, (void)context;
    *force = (qvec3){9.8 * weight * t, 0, 0};
    return true;
}

static void what_a_rising_push_tips_goes_on_exactly(void **state)
{
    (void)state;
    static const double exponents[] = {100, 200, 400};
    const double a = 0.1, c = 0.2, duration = 0.7, sharp = sharp_box_tips(a, c, duration);
    double off[3];
    for (int k = 0; k < 3; k++) {
        impact_body_def bodies[2] = {floor_body(), impact_default_body_def()};
        bodies[1].name = "box";
        bodies[1].position.z = c;
        const double p = exponents[k];
        assert_int_equal(impact_shape_superquadric(a, a, c, p, p, p, &bodies[1].shape), IMPACT_OK);
        impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
        force.function = push_rising;
        impact_scene_def def = scene_of(bodies, 2, duration);
        def.gravity = (qvec3){0, 0, -9.8};
        def.friction_rule = IMPACT_MAXIMUM;
        bodies[1].friction = 2;
        def.forces = &force;
        def.force_count = 1;
        impact_scene *scene = make_scene(&def);
        assert_true(impact_scene_run(scene, NULL) >= 0);
        impact_sample end;
        assert_int_equal(impact_scene_body(scene, 1, &end), IMPACT_OK);
        assert_near3((qvec3){end.omega.x, end.omega.z, end.position.y}, ((qvec3){0, 0, 0}), 1e-9);
        off[k] = fabs(end.omega.y - sharp);
        const impact_usage usage = impact_scene_usage(scene);
        assert_true(usage.events[IMPACT_EVENT_IMPACT] == 0 && usage.events[IMPACT_EVENT_LIFTOFF] == 0); /* held on */
        impact_scene_destroy(scene);
    }
    /* the edge's roundness is as 1/p, and so is what it changes */
    assert_true(off[2] < 0.12 * sharp && sharp > 0.5);
    assert_near(off[0] / off[1], 2, 0.03);
    assert_near(off[1] / off[2], 2, 0.03);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_slides_to_rest),
        cmocka_unit_test(many_boxes_slide_to_rest),
        cmocka_unit_test(a_struck_box_lies_down_again),
        cmocka_unit_test(a_slope_holds_up_to_its_friction),
        cmocka_unit_test(a_belt_takes_a_box_along),
        cmocka_unit_test(a_turning_box_moves_as_a_prism),
        cmocka_unit_test(what_drops_on_a_face_comes_to_rest),
        cmocka_unit_test(a_box_tips_over_its_edge),
        cmocka_unit_test(what_a_rising_push_tips_goes_on_exactly),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
