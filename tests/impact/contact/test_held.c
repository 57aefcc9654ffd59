/* SPDX-License-Identifier: MIT
 *
 * Held contacts as they move: rolls and slides with closed forms, several contacts at once, and random bodies dropped
 * on a plane.
 */
#include "kit/held_bodies.h"

/* What a step may add to any number of a body's, relative to it: CVODE holds the root mean square of one body's 17 to
 * the tolerance. */
static const double step_error = 4.2e-13;

/* ---- rolling off a fixed ball ---- */

typedef struct roll_off {
    scene_log log;
    double start; /* cosine of the angle from the top, at the start */
} roll_off;

/* From rest near the top of a ball of radius 1. */
static roll_off run_roll_off(double friction)
{
    const double angle = 0.1, reach = 1 + radius;
    impact_body_def bodies[2] = {ball_body("hill", (qvec3){0, 0, 0}, 1, 0),
                                 ball_body("ball", (qvec3){0, 0, 0}, friction, 0)};
    impact_shape_sphere(1, &bodies[0].shape);
    bodies[0].is_static = true;
    bodies[1].position = (qvec3){reach * sin(angle) * 0.6, reach * sin(angle) * 0.8, reach * cos(angle)};
    const impact_scene_def def = scene_of(bodies, 2, 2);
    impact_scene *scene = make_scene(&def);
    roll_off result = {.start = cos(angle)};
    const impact_recorder recorder = log_recorder(&result.log);
    if (impact_scene_run(scene, &recorder) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
    const impact_energy energy = impact_scene_energy(scene);
    assert_near(energy.kinetic + energy.potential, energy.start - energy.sliding_loss, 1e-9);
    impact_scene_destroy(scene);
    return result;
}

/* Cosine of the angle from the top at the event. */
static double height_at(const roll_off *r, impact_event_kind kind)
{
    const int i = find_event(&r->log, kind, NULL, 0);
    assert_true(i >= 0);
    return r->log.events[i].normal.z;
}

static void a_ball_without_friction_leaves_a_ball_at_two_thirds(void **state)
{
    (void)state;
    roll_off r = run_roll_off(0);
    assert_near(height_at(&r, IMPACT_EVENT_LIFTOFF), 2.0 / 3 * r.start, 1e-10);
    free_log(&r.log);
}

/* N = m g (cos - 10/7 (cos0 - cos)), friction 2/7 m g sin: it leaves at 10/17 cos0, sliding just before however strong
 * the friction. */
static void a_rolling_ball_leaves_a_ball_at_ten_seventeenths(void **state)
{
    (void)state;
    for (double friction = 1e4; friction < 1e9; friction *= 100) {
        roll_off r = run_roll_off(friction);
        const double wanted = 10.0 / 17 * r.start;
        assert_near(height_at(&r, IMPACT_EVENT_LIFTOFF), wanted, 2 / friction + 1e-9);
        assert_true(height_at(&r, IMPACT_EVENT_SLIP) >= wanted - 1e-9);
        free_log(&r.log);
    }
}

/* With less friction it slides when 2/7 sin = mu (17/7 cos - 10/7 cos0), and leaves later. */
static void a_rolling_ball_slides_before_it_leaves(void **state)
{
    (void)state;
    for (int k = 1; k <= 8; k++) {
        const double mu = 0.1 * k;
        roll_off r = run_roll_off(mu);
        double low = 0.1, high = acos(10.0 / 17 * r.start);
        for (int i = 0; i < 100; i++) {
            const double middle = 0.5 * (low + high);
            *(2 * sin(middle) < mu * (17 * cos(middle) - 10 * r.start) ? &low : &high) = middle;
        }
        assert_near(height_at(&r, IMPACT_EVENT_SLIP), cos(low), 1e-10);
        const double leaves = height_at(&r, IMPACT_EVENT_LIFTOFF);
        assert_true(leaves < cos(low) && leaves < 2.0 / 3 * r.start && leaves > 0.5);
        free_log(&r.log);
    }
}

/* ---- rolling ellipsoids ---- */

static impact_body_def rolling_egg(random_stream *random, qvec3 w)
{
    const quat q = random_rotation(random);
    double axis[3];
    for (int i = 2; i >= 0; i--) axis[i] = 0.2 + 0.2 * random_unit(random);
    impact_body_def body = ellipsoid_body("egg", axis[0], axis[1], axis[2], q);
    qvec3 lowest;
    body.position.z =
        impact_shape_support(&body.shape, quat_rotate_inverse(body.orientation, (qvec3){0, 0, -1}), &lowest);
    body.omega = w;
    body.velocity = qvec3_neg(qvec3_cross(w, quat_rotate(body.orientation, lowest)));
    body.friction = 1000;
    return body;
}

static void rolling_keeps_energy_and_the_contact_point_at_rest(void **state)
{
    (void)state;
    random_stream random = {13};
    for (int k = 0; k < 12; k++) {
        const impact_body_def bodies[2] = {rolling_egg(&random, random_vector(&random, 0.1, 3)),
                                           plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0)};
        impact_scene_def def = scene_of(bodies, 2, 3);
        def.output_rate = 50;
        impact_scene *scene = make_scene(&def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        if (impact_scene_run(scene, &recorder) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
        assert_int_equal(find_event(&log, IMPACT_EVENT_LIFTOFF, NULL, 0), -1);
        for (int i = 0; i < log.sample_count; i++) {
            const impact_sample *s = &log.samples[i];
            qvec3 lowest;
            const qvec3 down = quat_rotate_inverse(s->orientation, (qvec3){0, 0, -1});
            assert_near(s->position.z, impact_shape_support(&bodies[0].shape, down, &lowest), 1e-14);
            assert_near3(qvec3_add(s->velocity, qvec3_cross(s->omega, quat_rotate(s->orientation, lowest))),
                         (qvec3){0, 0, 0}, 1e-13);
        }
        const impact_energy energy = impact_scene_energy(scene);
        const double steps = (double)impact_scene_usage(scene).integrator_steps;
        assert_near((energy.kinetic + energy.potential) / energy.start, 1, steps * step_error);
        assert_true(energy.sliding_loss == 0);
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* ---- slides with closed forms ---- */

/* On an incline too steep for its friction, a ball that rolls across it slides straight down while it goes on across:
 * the slip it gains points down. */
static void slip_from_rest_goes_down_the_incline(void **state)
{
    (void)state;
    random_stream random = {14};
    for (int k = 0; k < 20; k++) {
        const double slope = 0.5 + 0.5 * random_unit(&random),
                     mu = 2.0 / 7 * tan(slope) * (0.2 + 0.7 * random_unit(&random));
        const double across = k % 4 == 0 ? 0 : random_log(&random, 0.01, 3), turn = 6.3 * random_unit(&random), t = 1.5;
        const quat tilt =
            quat_mul((quat){cos(turn / 2), 0, 0, sin(turn / 2)}, (quat){cos(slope / 2), 0, sin(slope / 2), 0});
        const qvec3 n = quat_rotate(tilt, (qvec3){0, 0, 1}), down = quat_rotate(tilt, (qvec3){1, 0, 0}),
                    side = qvec3_cross(n, down);
        impact_body_def bodies[2] = {plane_body("incline", (qvec3){0, 0, 0}, tilt, 1, 0),
                                     ball_body("ball", qvec3_scale(n, radius), mu, 0)};
        bodies[1].velocity = qvec3_scale(side, across);
        bodies[1].omega = qvec3_scale(qvec3_cross(n, side), across / radius);
        const impact_scene_def def = scene_of(bodies, 2, t);
        impact_scene *scene = make_scene(&def);
        if (impact_scene_run(scene, NULL) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
        const double a = gravity * (sin(slope) - mu * cos(slope)), spin = 2.5 * mu * gravity * cos(slope) / radius;
        impact_sample end;
        impact_scene_body(scene, 1, &end);
        assert_near3(end.velocity, qvec3_axpy(a * t, down, bodies[1].velocity), 1e-9);
        assert_near3(end.position,
                     qvec3_axpy(0.5 * a * t * t, down, qvec3_axpy(t, bodies[1].velocity, bodies[1].position)), 1e-9);
        assert_near3(end.omega, qvec3_axpy(spin * t, qvec3_cross(n, down), bodies[1].omega), 1e-8);
        impact_scene_destroy(scene);
    }
}

/* A ball that turns about the normal pivots for ever; friction takes nothing. */
static void pivoting_goes_on(void **state)
{
    (void)state;
    for (int moves = 0; moves < 2; moves++) {
        impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0),
                                     ball_body("ball", (qvec3){0, 0, radius}, 0.5, 0)};
        bodies[1].omega = (qvec3){0, moves ? 1 / radius : 0, 7};
        bodies[1].velocity = (qvec3){moves, 0, 0};
        const impact_scene_def def = scene_of(bodies, 2, 20);
        impact_scene *scene = make_scene(&def);
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
        impact_sample end;
        impact_scene_body(scene, 1, &end);
        assert_near3(end.omega, bodies[1].omega, 1e-10);
        assert_near3(end.position, (qvec3){20.0 * moves, 0, radius}, 1e-9);
        const quat turned = quat_from_rotation_vector(qvec3_scale(bodies[1].omega, 20));
        assert_near3(quat_rotate(end.orientation, (qvec3){0, 0.6, 0.8}), quat_rotate(turned, (qvec3){0, 0.6, 0.8}),
                     2e-11 * 20 * qvec3_norm(bodies[1].omega)); /* of the angle it has turned through */
        impact_scene_destroy(scene);
    }
}

/* Painleve (1895): a rod that slides towards its lean is pressed into the floor by its own friction where mu >
 * K_zz/K_xz, K the inverse mass of its lower end: no force holds it, and an impact without approach stops the slip.
 * Below that, and away from its lean, it slides. */
static void a_rod_that_jams_is_stopped_by_an_impact(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        const double lean = 0.9, mu = 0.25 * (1 + k / 2), speed = k & 1 ? 3 : -3;
        impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0),
                                     ellipsoid_body("rod", 1, 0.02, 0.02, (quat){cos(lean / 2), 0, sin(lean / 2), 0})};
        qvec3 low;
        const qvec3 down = quat_rotate_inverse(bodies[1].orientation, (qvec3){0, 0, -1});
        bodies[1].position.z = impact_shape_support(&bodies[1].shape, down, &low);
        bodies[1].velocity.x = speed;
        bodies[1].friction = mu;
        const qvec3 r = quat_rotate(bodies[1].orientation, low);
        const double inertia = impact_shape_inertia(&bodies[1].shape).y; /* of a unit mass */
        const bool jams = 1 + r.x * r.x / inertia + mu * copysign(1, speed) * r.x * r.z / inertia < 0;
        const impact_scene_def def = scene_of(bodies, 2, 0.05);
        impact_scene *scene = make_scene(&def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        if (impact_scene_run(scene, &recorder) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
        assert_int_equal(log.events[0].kind, jams ? IMPACT_EVENT_IMPACT : IMPACT_EVENT_CONTACT);
        if (jams) {
            assert_string_equal(log.phases[0], "tangential stick-c");
            assert_true(log.events[0].t == 0);
            assert_true(log.events[0].energy_after < log.events[0].energy_before - 0.1);
        }
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* ---- several contacts ---- */

/* A ball that spins in the corner of a floor and a wall and slides on both: N1 = m g/(1 + mu^2), N2 = mu N1, and it
 * stops after t = 2/5 R w/(g mu (1 + mu)/(1 + mu^2)). */
static void spin_in_a_corner_dies_out(void **state)
{
    (void)state;
    for (int k = 1; k <= 6; k++) {
        const double mu = 0.15 * k, w = 20;
        impact_body_def bodies[3] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0),
                                     plane_body("wall", (qvec3){radius, 0, 0}, (quat){1, 0, -1, 0}, 1, 0),
                                     ball_body("ball", (qvec3){0, 0, radius}, mu, 0)};
        bodies[2].omega = (qvec3){0, w, 0};
        const impact_scene_def def = scene_of(bodies, 3, 30);
        impact_scene *scene = make_scene(&def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        const impact_status status = impact_scene_run(scene, &recorder);
        if (status != IMPACT_AT_REST) fail_msg("status %d: %s", status, impact_scene_message(scene));
        const double t = 0.4 * radius * w / (gravity * mu * (1 + mu) / (1 + mu * mu));
        const int rest = find_event(&log, IMPACT_EVENT_REST, NULL, 0);
        assert_true(rest >= 0);
        assert_near(log.events[rest].t, t, 1e-9);
        impact_sample end;
        impact_scene_body(scene, 2, &end);
        assert_near3(end.position, (qvec3){0, 0, radius}, 1e-12);
        const impact_energy energy = impact_scene_energy(scene);
        assert_near(energy.sliding_loss, 0.2 * mass * radius * radius * w * w, 1e-9);
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* Spinning about any axis and thrown into the corner, it comes to rest, or pivots: what no friction without moment can
 * stop. */
static void thrown_into_a_corner_it_settles(void **state)
{
    (void)state;
    random_stream random = {15};
    for (int k = 0; k < 15; k++) {
        impact_body_def bodies[3] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1),
                                     plane_body("wall", (qvec3){radius, 0, 0}, (quat){1, 0, -1, 0}, 1, 1),
                                     ball_body("ball", (qvec3){-0.2, 0, radius + 0.3}, 0.6, 0.4)};
        bodies[2].velocity = (qvec3){1 + random_unit(&random), random_unit(&random) - 0.5, 0};
        bodies[2].omega = random_vector(&random, 1, 20);
        const impact_scene_def def = scene_of(bodies, 3, 5);
        impact_scene *scene = make_scene(&def);
        const impact_status status = impact_scene_run(scene, NULL);
        if (status < 0) fail_msg("%s", impact_scene_message(scene));
        impact_sample end;
        impact_scene_body(scene, 2, &end);
        assert_true(end.position.z >= radius - 1e-12 && end.position.x <= 1e-12);
        const impact_energy energy = impact_scene_energy(scene);
        assert_near(energy.kinetic + energy.potential, energy.start - energy.sliding_loss - energy.impact_loss,
                    1e-8 * energy.start);
        assert_true(energy.sliding_loss >= 0 && energy.impact_loss >= 0);
        impact_scene_destroy(scene);
    }
}

/* More contacts than the balance of forces can tell apart: nothing moves. */
static void hyperstatic_contacts_rest(void **state)
{
    (void)state;
    const double r = radius, h = sqrt(4 * r * r - 4.0 / 3 * r * r); /* of a ball on three that touch */
    const qvec3 below[3] = {{r, -r / sqrt(3), r}, {-r, -r / sqrt(3), r}, {0, 2 * r / sqrt(3), r}};
    impact_body_def bodies[8] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0)};
    /* A ball between a floor, two walls that face each other, and one behind. */
    bodies[1] = plane_body("left", (qvec3){-r, 0, 0}, (quat){1, 0, 1, 0}, 1, 0);
    bodies[2] = plane_body("right", (qvec3){r, 0, 0}, (quat){1, 0, -1, 0}, 1, 0);
    bodies[3] = plane_body("back", (qvec3){0, r, 0}, (quat){1, 1, 0, 0}, 1, 0);
    bodies[4] = ball_body("ball", (qvec3){0, 0, r}, 0.5, 0);
    random_stream random = {17};
    for (int k = 0; k < 42; k++) {
        const quat turn = k < 2 ? quat_identity() : random_rotation(&random);
        impact_body_def turned[5];
        for (int i = 0; i < 5; i++) {
            turned[i] = bodies[i];
            quat_normalize(bodies[i].orientation, &turned[i].orientation);
            turned[i].position = quat_rotate(turn, bodies[i].position);
            turned[i].orientation = quat_mul(turn, turned[i].orientation);
        }
        impact_scene_def def = scene_of(turned, 5, 1);
        def.gravity = quat_rotate(turn, k > 0 ? (qvec3){1, 2, -9} : def.gravity);
        impact_scene *scene = make_scene(&def);
        const impact_status status = impact_scene_run(scene, NULL);
        if (status != IMPACT_AT_REST) fail_msg("turn %d: status %d: %s", k, status, impact_scene_message(scene));
        assert_true(impact_scene_time(scene) == 0);
        impact_scene_destroy(scene);
    }
    /* A pyramid of four balls with friction enough. */
    static const char *const names[3] = {"a", "b", "c"};
    for (int i = 0; i < 3; i++) bodies[1 + i] = ball_body(names[i], below[i], 1, 0);
    bodies[4] = ball_body("top", (qvec3){0, 0, r + h}, 1, 0);
    const impact_scene_def def = scene_of(bodies, 5, 1);
    impact_scene *scene = make_scene(&def);
    const impact_status status = impact_scene_run(scene, NULL);
    if (status < 0) fail_msg("pyramid: status %d: %s", status, impact_scene_message(scene));
    impact_sample top;
    impact_scene_body(scene, 4, &top);
    assert_near3(top.position, bodies[4].position, 1e-9);
    impact_scene_destroy(scene);
}

/* ---- ellipsoids dropped on a plane, one or two at a time ---- */

typedef struct watch {
    impact_shape shapes[2];
    impact_sample last;
    double deepest;
} watch;

static double overlap(const watch *w, const impact_sample *a, const impact_sample *b)
{
    const impact_solid one = {w->shapes[a->body], a->position, a->orientation},
                       two = {w->shapes[b->body], b->position, b->orientation};
    impact_contact contact;
    assert_true(impact_gap(&one, &two, NULL, &contact) >= 0);
    return -contact.gap;
}

static bool watch_depth(void *context, const impact_sample *s)
{
    watch *w = context;
    const qvec3 down = quat_rotate_inverse(s->orientation, (qvec3){0, 0, -1});
    w->deepest = fmax(w->deepest, impact_shape_support(&w->shapes[s->body], down, NULL) - s->position.z);
    if (s->body == 1 && w->last.body == 0 && w->last.t == s->t) w->deepest = fmax(w->deepest, overlap(w, s, &w->last));
    w->last = *s;
    return true;
}

static void drop(random_stream *random, int eggs, int k)
{
    static const char *const names[2] = {"egg", "other"};
    impact_body_def bodies[3];
    watch w = {.last.body = -1};
    for (int i = 0; i < eggs; i++) {
        const quat q = random_rotation(random);
        double axis[3];
        for (int j = 2; j >= 0; j--) axis[j] = random_log(random, 0.1, 0.5);
        bodies[i] = ellipsoid_body(names[i], axis[0], axis[1], axis[2], q);
        bodies[i].position = (qvec3){0.1 * i, 0, 0.6 + 0.4 * random_unit(random) + 1.1 * i};
        bodies[i].velocity = random_vector(random, 0.1, 2);
        bodies[i].omega = random_vector(random, 0.1, 10);
        bodies[i].friction = k % 5 == 0 ? 0 : random_log(random, 0.05, 1);
        bodies[i].restitution = k % 7 == 0 ? 0 : 0.8 * random_unit(random);
        w.shapes[i] = bodies[i].shape;
    }
    bodies[eggs] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1);
    impact_scene_def def = scene_of(bodies, eggs + 1, 2);
    def.output_rate = 200;
    def.law = k & 1 ? IMPACT_STRONGE : IMPACT_POISSON;
    impact_scene *scene = make_scene(&def);
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &w, .sample = watch_depth};
    const impact_status status = impact_scene_run(scene, &recorder);
    if (status < 0) fail_msg("drop %d at t = %.17g: %s", k, impact_scene_time(scene), impact_scene_message(scene));
    const impact_energy energy = impact_scene_energy(scene);
    const double appeared = energy.kinetic + energy.potential + energy.sliding_loss + energy.impact_loss - energy.start;
    if (fabs(appeared) > 1e-8 * energy.start) fail_msg("drop %d: %.3g J of %.3g appeared", k, appeared, energy.start);
    assert_at_most(-energy.sliding_loss, 1e-13 * energy.start);
    assert_at_most(-energy.impact_loss, 1e-13 * energy.start);
    /* what the exact motion does not settle within its patience goes by steps, which leave a millionth of the smaller
     */
    double smallest = INFINITY;
    for (int i = 0; i < eggs; i++) smallest = fmin(smallest, fmax(w.shapes[i].a, fmax(w.shapes[i].b, w.shapes[i].c)));
    assert_at_most(w.deepest, impact_scene_usage(scene).pile_steps > 0 ? 1e-6 * smallest : 1e-9);
    /* Contacts neither chatter nor creep on by restarts. */
    const impact_usage usage = impact_scene_usage(scene);
    assert_at_most((double)usage.integrator_starts, 1000);
    impact_scene_destroy(scene);
}

static void dropped_ellipsoids_gain_nothing(void **state)
{
    (void)state;
    random_stream random = {16};
    for (int k = 0; k < 100; k++) drop(&random, 1, k);
}

static void two_dropped_ellipsoids_gain_nothing(void **state)
{
    (void)state;
    random_stream random = {17};
    for (int k = 0; k < 60; k++) drop(&random, 2, k);
}

int main(void)
{
    const struct CMUnitTest instants[] = {
        cmocka_unit_test(hyperstatic_contacts_rest),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(a_ball_without_friction_leaves_a_ball_at_two_thirds),
        cmocka_unit_test(a_rolling_ball_leaves_a_ball_at_ten_seventeenths),
        cmocka_unit_test(a_rolling_ball_slides_before_it_leaves),
        cmocka_unit_test(rolling_keeps_energy_and_the_contact_point_at_rest),
        cmocka_unit_test(slip_from_rest_goes_down_the_incline),
        cmocka_unit_test(pivoting_goes_on),
        cmocka_unit_test(a_rod_that_jams_is_stopped_by_an_impact),
        cmocka_unit_test(spin_in_a_corner_dies_out),
        cmocka_unit_test(thrown_into_a_corner_it_settles),
        cmocka_unit_test(dropped_ellipsoids_gain_nothing),
        cmocka_unit_test(two_dropped_ellipsoids_gain_nothing),
    };
    const int failed = cmocka_run_group_tests(instants, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
