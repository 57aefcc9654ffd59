/* SPDX-License-Identifier: MIT
 *
 * Toys whose motion is known: rattleback, tippe top, Euler's disk; and shapes that stand aside of their centre of mass.
 */
#include "kit/held_bodies.h"

/* ---- shapes aside ---- */

/* A sphere about a point off its centre of mass, thrown: the sphere's centre goes round at a steady rate and down a
 * parabola. */
static void a_loaded_ball_lands_when_its_surface_does(void **state)
{
    (void)state;
    random_stream random = {41};
    for (int k = 0; k < 50; k++) {
        impact_body_def bodies[2] = {floor_body(), ball_body("ball", (qvec3){0, 0, 2}, 0.5, 0.5)};
        impact_body_def *ball = &bodies[1];
        ball->shape_position = random_vector(&random, 0.01, 0.25);
        ball->shape_orientation = random_rotation(&random);
        ball->orientation = random_rotation(&random);
        ball->moments = (qvec3){0.1, 0.1, 0.1};
        ball->omega = random_vector(&random, 0.1, 20);
        double low = 0, high = 0;
        for (double height = 1; height > 0; high += 1e-5) {
            const quat q = quat_mul(quat_from_rotation_vector(qvec3_scale(ball->omega, high)), ball->orientation);
            height = 2 - 0.5 * gravity * high * high + quat_rotate(q, ball->shape_position).z - radius;
            if (height > 0) low = high;
        }
        const impact_scene_def def = scene_of(bodies, 2, 2);
        impact_scene *scene = make_scene(&def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        if (impact_scene_run(scene, &recorder) < 0) fail_msg("%s", impact_scene_message(scene));
        const double t = log.events[0].t;
        assert_int_equal(log.events[0].kind, IMPACT_EVENT_IMPACT);
        assert_true(t >= low && t <= low + 1e-5);
        const quat q = quat_mul(quat_from_rotation_vector(qvec3_scale(ball->omega, t)), ball->orientation);
        assert_near(2 - 0.5 * gravity * t * t + quat_rotate(q, ball->shape_position).z, radius, 1e-11);
        const impact_energy e = impact_scene_energy(scene);
        assert_near(e.kinetic + e.potential, e.start - e.sliding_loss - e.impact_loss, 1e-9 * e.start);
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* The same body with its axes named otherwise moves the same. */
static void axes_have_no_names(void **state)
{
    (void)state;
    random_stream random = {42};
    const quat cycle = {0.5, 0.5, 0.5, 0.5}; /* x to y to z to x */
    for (int k = 0; k < 10; k++) {
        impact_sample end[2];
        impact_body_def bodies[2] = {floor_body(), impact_default_body_def()};
        impact_body_def *body = &bodies[1];
        body->name = "body";
        body->mass = mass;
        impact_shape_superquadric(0.2, 0.3, 0.25, k & 1 ? 2 : 3, 2, k & 2 ? 2 : 4, &body->shape);
        body->orientation = random_rotation(&random);
        body->omega = random_vector(&random, 0.1, 5);
        body->position.z = 0.7;
        const quat q = body->orientation;
        for (int turned = 0; turned < 2; turned++) {
            body->moments = turned ? (qvec3){0.03, 0.01, 0.02} : (qvec3){0.01, 0.02, 0.03};
            body->shape_orientation = turned ? cycle : quat_identity();
            body->orientation = turned ? quat_mul(q, quat_conj(cycle)) : q;
            const impact_scene_def def = scene_of(bodies, 2, 0.8);
            impact_scene *scene = make_scene(&def);
            if (impact_scene_run(scene, NULL) < 0) fail_msg("%s", impact_scene_message(scene));
            impact_scene_body(scene, 1, &end[turned]);
            impact_scene_destroy(scene);
        }
        assert_near3(end[1].position, end[0].position, 1e-8);
        assert_near3(end[1].omega, end[0].omega, 1e-7);
    }
}

/* ---- held toys ---- */

/* Sets the body down on z = 0 with the contact point at rest. */
static void set_down(impact_body_def *body)
{
    const quat axes = quat_mul(body->orientation, body->shape_orientation);
    qvec3 lowest;
    impact_shape_support(&body->shape, quat_rotate_inverse(axes, (qvec3){0, 0, -1}), &lowest);
    const qvec3 r = qvec3_add(quat_rotate(body->orientation, body->shape_position), quat_rotate(axes, lowest));
    body->position.z = -r.z;
    body->velocity = qvec3_neg(qvec3_cross(body->omega, r));
}

/* From the centre of mass to the contact. */
static qvec3 contact_arm(const impact_body_def *body, const impact_sample *s)
{
    const quat axes = quat_mul(s->orientation, body->shape_orientation);
    qvec3 lowest;
    impact_shape_support(&body->shape, quat_rotate_inverse(axes, (qvec3){0, 0, -1}), &lowest);
    return qvec3_add(quat_rotate(s->orientation, body->shape_position), quat_rotate(axes, lowest));
}

static scene_log run_toy(const impact_body_def *toy, double duration, double rate, double tolerance)
{
    const impact_body_def bodies[2] = {floor_body(), *toy};
    impact_scene_def def = scene_of(bodies, 2, duration);
    def.output_rate = rate;
    def.tolerance = 1e-14;
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    const impact_status status = impact_scene_run(scene, &recorder);
    if (status < 0) fail_msg("%s: %s", toy->name, impact_scene_message(scene));
    const impact_energy e = impact_scene_energy(scene);
    assert_near(e.kinetic + e.potential, e.start - e.sliding_loss - e.impact_loss, tolerance * e.start);
    impact_scene_destroy(scene);
    return log;
}

/* ---- rattleback ---- */

/* Kane and Levinson's (1982): an ellipsoid, its centre of mass 1 cm below its centre, its principal axes turned from
 * the ellipsoid's. hand = -1: its mirror image. */
static impact_body_def rattleback(double hand, double spin)
{
    impact_body_def body = impact_default_body_def();
    const double a = 2e-4, b = 16e-4, d = -0.2e-4, mean = 0.5 * (a + b), half = hypot(0.5 * (a - b), d);
    const double turn = hand * atan((mean - half - a) / d), tilt = hand * 2 * 1.57079632679489662 / 90;
    body.name = "rattleback";
    body.mass = 1;
    body.moments = (qvec3){mean - half, mean + half, 17e-4};
    impact_shape_ellipsoid(0.2, 0.03, 0.02, &body.shape);
    body.shape_position = (qvec3){0, 0, 0.01};
    body.shape_orientation = (quat){cos(turn / 2), 0, 0, -sin(turn / 2)};
    body.orientation = quat_mul((quat){cos(tilt / 2), sin(tilt / 2), 0, 0}, (quat){cos(turn / 2), 0, 0, sin(turn / 2)});
    body.omega = (qvec3){0, 0, spin};
    body.friction = 1e3;
    set_down(&body);
    return body;
}

/* Spun one way it begins to rattle, stops, and turns back to its full spin, as nothing is lost; spun the other way it
 * goes on. Its mirror image does the mirror image. */
static void a_rattleback_turns_back(void **state)
{
    (void)state;
    double last[2][2];
    for (int mirrored = 0; mirrored < 2; mirrored++)
        for (int way = 0; way < 2; way++) {
            const double hand = mirrored ? -1 : 1, spin = (way ? 5 : -5) * hand;
            const impact_body_def toy = rattleback(hand, spin);
            scene_log log = run_toy(&toy, 8, 20, 1e-9);
            double slowest = INFINITY;
            for (int i = 0; i < log.sample_count; i++) slowest = fmin(slowest, log.samples[i].omega.z / spin);
            assert_at_most(way ? -slowest : slowest, way ? -0.85 : -0.98);
            last[mirrored][way] = log.samples[log.sample_count - 1].omega.z;
            free_log(&log);
        }
    for (int way = 0; way < 2; way++) assert_near(last[1][way], -last[0][way], 1e-9);
}

/* ---- tippe top ---- */

/* A sphere of radius R whose centre of mass lies 0.3 R below its centre. With moments A across and C along its axis it
 * inverts when 0.7 < A/C < 1.3 and it spins fast enough; friction turns it over, sliding. */
static void a_tippe_top_inverts(void **state)
{
    (void)state;
    const double r = 0.02, m = 0.02, aside = 0.3, tilt = 0.1;
    impact_body_def top = impact_default_body_def();
    top.name = "top";
    top.mass = m;
    impact_shape_sphere(r, &top.shape);
    top.shape_position = (qvec3){0, 0, aside * r};
    top.moments = (qvec3){131.0 / 350 * m * r * r, 131.0 / 350 * m * r * r, 0.4 * m * r * r};
    top.orientation = (quat){cos(tilt / 2), sin(tilt / 2), 0, 0};
    top.omega = (qvec3){0, 0, 155};
    top.friction = 0.1;
    set_down(&top);
    top.velocity = (qvec3){0, 0, 0};
    scene_log log = run_toy(&top, 8, 200, 1e-9);
    double jellett = 0, lowest = 1;
    for (int i = 0; i < log.sample_count; i++) {
        const impact_sample *s = &log.samples[i];
        const qvec3 w = quat_rotate_inverse(s->orientation, s->omega);
        const qvec3 momentum =
            quat_rotate(s->orientation, (qvec3){top.moments.x * w.x, top.moments.y * w.y, top.moments.z * w.z});
        const double now = -qvec3_dot(momentum, contact_arm(&top, s));
        if (i == 0) jellett = now;
        assert_near(now, jellett, 1e-11 * jellett);
        lowest = fmin(lowest, quat_rotate(s->orientation, (qvec3){0, 0, 1}).z);
    }
    assert_at_most(lowest, -0.99);
    const qvec3 up = quat_rotate(log.samples[log.sample_count - 1].orientation, (qvec3){0, 0, 1});
    assert_near(log.samples[log.sample_count - 1].position.z, r - aside * r * up.z, 1e-12);
    free_log(&log);
}

/* ---- Euler's disk ---- */

/* A disk that rolls round on its edge, leaning by the angle a, its centre at rest: it turns about the line from the
 * centre to the contact, w = W z + s e with w x r = 0, e its axis; its weight turns the angular momentum at the rate W:
 * r x m g z = W z x L(w). Thin and flat, W^2 = 4 g/(radius a). */
static double start_disk(impact_body_def *disk, double half_thickness, double angle)
{
    const double edge = 0.0375;
    *disk = impact_default_body_def();
    disk->name = "disk";
    disk->mass = 0.4;
    impact_shape_superquadric(edge, edge, half_thickness, 2, 2, 100, &disk->shape);
    disk->orientation = (quat){cos(angle / 2), sin(angle / 2), 0, 0};
    const qvec3 moments = qvec3_scale(impact_shape_inertia(&disk->shape), disk->mass), z = {0, 0, 1};
    const qvec3 axis = quat_rotate(disk->orientation, z);
    qvec3 r;
    impact_shape_support(&disk->shape, quat_rotate_inverse(disk->orientation, qvec3_neg(z)), &r);
    r = quat_rotate(disk->orientation, r);
    const qvec3 w = qvec3_axpy(-qvec3_cross(z, r).x / qvec3_cross(axis, r).x, axis, z); /* over W */
    const qvec3 b = quat_rotate_inverse(disk->orientation, w);
    const qvec3 l = quat_rotate(disk->orientation, (qvec3){moments.x * b.x, moments.y * b.y, moments.z * b.z});
    const double rate = sqrt(disk->mass * gravity * qvec3_cross(r, z).x / qvec3_cross(z, l).x);
    disk->omega = qvec3_scale(w, rate);
    disk->friction = 0.5;
    set_down(disk);
    return rate;
}

static void a_disk_rolls_round_on_its_edge(void **state)
{
    (void)state;
    for (double angle = 0.04; angle < 0.7; angle *= 2) {
        impact_body_def disk;
        const double rate = start_disk(&disk, 0.002, angle), turn = 6.283185307179586 / rate;
        scene_log log = run_toy(&disk, 3 * turn, 8 / turn, 1e-9);
        for (int i = 0; i < log.sample_count; i++) {
            const impact_sample *s = &log.samples[i];
            const double c = cos(rate * s->t), n = sin(rate * s->t);
            assert_near3(quat_rotate(s->orientation, (qvec3){0, 0, 1}),
                         (qvec3){n * sin(angle), -c * sin(angle), cos(angle)}, 1e-11);
            assert_near3(s->position, disk.position, 1e-12);
        }
        free_log(&log);
    }
    /* the limit, of ever thinner and flatter disks; the edge's rounding, exponent 100, takes 0.5 % of the moment m
     * radius^2/4 */
    for (double angle = 0.1; angle > 1e-3; angle /= 4) {
        impact_body_def disk;
        const double edge = 0.0375, rate = start_disk(&disk, 1e-5 * angle * edge, angle);
        const double moment = impact_shape_inertia(&disk.shape).x;
        assert_near(moment, 0.25 * edge * edge, 0.006 * moment);
        assert_near(rate * rate * angle * moment / (gravity * edge), 1, 0.2 * angle * angle + 5e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loaded_ball_lands_when_its_surface_does),
        cmocka_unit_test(axes_have_no_names),
        cmocka_unit_test(a_rattleback_turns_back),
        cmocka_unit_test(a_tippe_top_inverts),
        cmocka_unit_test(a_disk_rolls_round_on_its_edge),
    };
    if (!impact_has(IMPACT_PART_CVODE)) return 0;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
