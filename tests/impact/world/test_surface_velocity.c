/* SPDX-License-Identifier: MIT
 *
 * Static bodies whose surface moves: closed forms, Galileo's twin of a belt, a heavy body's of a drum; the drive's
 * work; what is refused.
 */
#include <stdio.h>
#include "kit/held_bodies.h"

static void assert_account_closes(const impact_scene *scene, double tolerance)
{
    const impact_energy e = impact_scene_energy(scene);
    const double losses = e.damping_loss + e.sliding_loss + e.impact_loss;
    const double scale = fmax(fmax(fabs(e.start), e.kinetic), fabs(e.drive_work));
    assert_near(e.kinetic + e.potential, e.start + e.force_work + e.drive_work - losses, tolerance * scale);
}

static void run(impact_scene *scene, double t, const impact_recorder *recorder)
{
    const impact_status status = impact_scene_run_to(scene, t, recorder);
    if (status < 0 || status == IMPACT_SOFT) fail_msg("%s", impact_scene_message(scene));
}

static qvec3 turned_about(qvec3 axis, double angle, qvec3 v)
{
    return quat_rotate(quat_from_rotation_vector(qvec3_scale(axis, angle)), v);
}

/* ---- turntable ---- */

/* A ball of moments k m r^2 that rolls on z = 0, which turns at `spin` about the origin, and leans so that g_t is the
 * gravity along it: v' = k/(1 + k) spin z x v + g_t/(1 + k), in the table's plane. */
static void check_turntable(double k, double spin, qvec3 v0, double lean, double turns, double tolerance)
{
    const double rate = k / (1 + k) * spin, pull = gravity * sin(lean) / (1 + k);
    const qvec3 x0 = {0.7, -0.2, radius}, z = {0, 0, 1};
    impact_body_def bodies[2] = {floor_body(), ball_body("ball", x0, 1, 0)};
    bodies[0].omega.z = spin;
    const double inertia = k * mass * radius * radius;
    bodies[1].moments = (qvec3){inertia, inertia, inertia};
    bodies[1].velocity = v0;
    const qvec3 under = qvec3_sub(v0, qvec3_cross((qvec3){0, 0, spin}, x0));
    bodies[1].omega = qvec3_scale(qvec3_cross(z, under), 1 / radius); /* v - spin x = omega x (r z) */
    bodies[1].omega.z = 3;
    impact_scene_def def = scene_of(bodies, 2, turns * 6.28318530717958648 / fabs(rate));
    def.gravity = (qvec3){gravity * sin(lean), 0, -gravity * cos(lean)};
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    run(scene, def.duration, &recorder);
    assert_int_equal(log.event_count, 1);    /* the contact: nothing slips */
    const qvec3 drift = {0, pull / rate, 0}; /* rate z x drift + pull x = 0 */
    for (int i = 0; i < log.sample_count; i++) {
        const impact_sample *s = &log.samples[i];
        const qvec3 circling = qvec3_sub(v0, drift);
        const qvec3 v = qvec3_add(drift, turned_about(z, rate * s->t, circling));
        const qvec3 way = qvec3_sub(turned_about(z, rate * s->t - 1.57079632679489662, circling),
                                    turned_about(z, -1.57079632679489662, circling));
        const qvec3 x = qvec3_add(x0, qvec3_axpy(s->t, drift, qvec3_scale(way, 1 / rate)));
        assert_near3(s->position, x, tolerance);
        assert_near3(s->velocity, v, tolerance);
        assert_near(s->omega.z, 3, tolerance);
    }
    assert_account_closes(scene, 1e-10);
    free_log(&log);
    impact_scene_destroy(scene);
}

static void a_ball_on_a_turntable_goes_round_at_two_sevenths(void **state)
{
    (void)state;
    check_turntable(0.4, 3, (qvec3){0.4, 0.3, 0}, 0, 20, 1e-10);
    check_turntable(0.4, -11, (qvec3){-1, 0.5, 0}, 0, 20, 1e-10);
    check_turntable(2. / 3, 5, (qvec3){0.2, 0, 0}, 0, 10, 1e-10); /* a shell: at two fifths */
}

static void on_a_table_that_leans_it_drifts_across(void **state)
{
    (void)state;
    check_turntable(0.4, 6, (qvec3){0.4, 0.3, 0}, 0.1, 5, 1e-10);
    check_turntable(0.4, -4, (qvec3){0, 0, 0}, 0.02, 5, 1e-10);
}

/* ---- belt ---- */

/* Set down on a belt without spin it slides with a = mu g for 2 V/(7 mu g), and rolls at 2/7 V from then on; the drive
 * gives 2/7 m V^2, of which friction takes half. */
static void a_ball_on_a_belt_rolls_at_two_sevenths(void **state)
{
    (void)state;
    const double speeds[4] = {0.5, 2, 8, 1e-3}, frictions[4] = {0.1, 0.3, 0.7, 0.05};
    for (int k = 0; k < 4; k++) {
        const double V = speeds[k], mu = frictions[k], t0 = 2 * V / (7 * mu * gravity);
        impact_body_def bodies[2] = {floor_body(), ball_body("ball", (qvec3){0, 0, radius}, mu, 0)};
        bodies[0].velocity = (qvec3){0.6 * V, 0.8 * V, 0};
        const impact_scene_def def = scene_of(bodies, 2, 3 * t0);
        impact_scene *scene = make_scene(&def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        run(scene, def.duration, &recorder);
        const int stick = find_event(&log, IMPACT_EVENT_STICK, NULL, 0);
        assert_true(stick >= 0);
        assert_near(log.events[stick].t, t0, 1e-10);
        impact_sample s;
        impact_scene_body(scene, 1, &s);
        assert_near3(s.velocity, qvec3_scale(bodies[0].velocity, 2. / 7), 1e-11 * (1 + V));
        const double way = (0.5 * mu * gravity * t0) * t0 + 2. / 7 * V * 2 * t0;
        assert_near(s.position.x, 0.6 * way, 1e-10 * (1 + way));
        const impact_energy e = impact_scene_energy(scene);
        assert_near(e.drive_work, 2. / 7 * mass * V * V, 1e-13 + 1e-10 * V * V);
        assert_near(e.sliding_loss, 1. / 7 * mass * V * V, 1e-13 + 1e-10 * V * V);
        assert_account_closes(scene, 1e-11);
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* Dropped onto it, the same speed comes out of impacts that slide: those without rebound, and those with. */
static void a_ball_dropped_on_a_belt_ends_the_same(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        impact_body_def bodies[2] = {floor_body(), ball_body("ball", (qvec3){0, 0, 1}, 0.02 + 0.1 * k, 0)};
        bodies[0].velocity.x = 4;
        bodies[0].restitution = 1;
        bodies[1].restitution = 0.15 * k;
        const impact_scene_def def = scene_of(bodies, 2, 10);
        impact_scene *scene = make_scene(&def);
        run(scene, def.duration, NULL);
        impact_sample s;
        impact_scene_body(scene, 1, &s);
        assert_near3(s.velocity, (qvec3){8. / 7, 0, 0}, 1e-10);
        assert_near3(s.omega, (qvec3){0, -20. / 7 / radius, 0}, 1e-9);
        const impact_energy e = impact_scene_energy(scene);
        assert_near(e.drive_work, 2. / 7 * mass * 16, 1e-9); /* of impulses and of forces: V m v all the same */
        assert_true(e.impact_loss > 0);
        assert_account_closes(scene, 1e-11);
        impact_scene_destroy(scene);
    }
}

/* Galileo: seen from the belt, it is a floor at rest. Any body, any slope. */
static void a_belt_is_a_floor_seen_from_a_train(void **state)
{
    (void)state;
    random_stream random = {51};
    for (int k = 0; k < 40; k++) {
        const quat slope = quat_from_rotation_vector(random_vector(&random, 0.01, 0.3));
        const qvec3 along = random_vector(&random, 0.1, 5), up = quat_rotate(slope, (qvec3){0, 0, 1});
        const qvec3 V = qvec3_axpy(-qvec3_dot(along, up), up, along);
        impact_body_def bodies[2] = {floor_body(),
                                     ball_body("body", qvec3_scale(up, 0.5), 0.05 * (k % 7), 0.1 * (k % 5))};
        bodies[0].orientation = slope;
        bodies[0].restitution = 1;
        if (k % 3 == 1) impact_shape_ellipsoid(0.3, 0.2, 0.25, &bodies[1].shape);
        if (k % 3 == 2) impact_shape_superquadric(0.3, 0.2, 0.25, 3, 2.5, 4, &bodies[1].shape);
        bodies[1].velocity = random_vector(&random, 0.01, 2);
        bodies[1].omega = random_vector(&random, 0.01, 10);
        impact_sample end[2];
        long impacts[2], sticks[2];
        const double duration = k % 3 == 0 ? 3 : 0.9;
        for (int moves = 0; moves < 2; moves++) {
            bodies[0].velocity = moves ? V : (qvec3){0, 0, 0};
            if (moves) bodies[1].velocity = qvec3_add(bodies[1].velocity, V);
            const impact_scene_def def = scene_of(bodies, 2, duration);
            impact_scene *scene = make_scene(&def);
            run(scene, duration, NULL);
            impact_scene_body(scene, 1, &end[moves]);
            const impact_usage usage = impact_scene_usage(scene);
            impacts[moves] = usage.events[IMPACT_EVENT_IMPACT];
            /* What sticks in its last bounce may slide for an instant more, by rounding. */
            sticks[moves] = usage.events[IMPACT_EVENT_STICK] - usage.events[IMPACT_EVENT_SLIP];
            assert_account_closes(scene, 1e-9);
            impact_scene_destroy(scene);
        }
        const double rough = k % 3 == 0 ? 1 : 100;
        assert_int_equal(impacts[0], impacts[1]);
        assert_int_equal(sticks[0], sticks[1]);
        assert_near3(end[1].velocity, qvec3_add(end[0].velocity, V), 1e-9 * rough);
        assert_near3(end[1].omega, end[0].omega, 1e-9 * rough);
        assert_near3(end[1].position, qvec3_axpy(duration, V, end[0].position), 1e-9 * rough);
    }
}

/* Carried against a wall it is spun up where it is: with N the belt's pressure, the wall's friction, of muw times mub
 * N, holds it down, N = m g/(1 - muw mub), and (2/5) m r w' = mub N (1 - muw) until the rim goes with the belt. From
 * then on nothing acts. */
static void between_belt_and_wall_it_spins_in_its_place(void **state)
{
    (void)state;
    for (int k = 0; k < 5; k++) {
        const double V = 0.4 + k, mub = 0.2 + 0.1 * k, muw = 0.15 * k;
        const double N = mass * gravity / (1 - muw * mub), stop = 0.4 * mass * V / (mub * N * (1 - muw));
        const impact_pair_def pairs[2] = {
            {.struct_size = sizeof(impact_pair_def),
             .body1 = "ball",
             .body2 = "floor",
             .friction = mub,
             .restitution = 0},
            {.struct_size = sizeof(impact_pair_def),
             .body1 = "ball",
             .body2 = "wall",
             .friction = muw,
             .restitution = 0},
        };
        impact_body_def bodies[3] = {floor_body(), plane_body("wall", (qvec3){radius, 0, 0}, quat_identity(), 1, 0),
                                     ball_body("ball", (qvec3){0, 0, radius}, 1, 0)};
        bodies[0].velocity.x = V;
        bodies[1].orientation = (quat){sqrt(0.5), 0, -sqrt(0.5), 0};
        impact_scene_def def = scene_of(bodies, 3, 2 * stop);
        def.pairs = pairs;
        def.pair_count = 2;
        impact_scene *scene = make_scene(&def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        run(scene, def.duration, &recorder);
        assert_near(log.events[find_event(&log, IMPACT_EVENT_STICK, NULL, 0)].t, stop, 1e-10);
        impact_sample s;
        impact_scene_body(scene, 2, &s);
        assert_near3(s.position, (qvec3){0, 0, radius}, 1e-12);
        assert_near3(s.omega, (qvec3){0, -V / radius, 0}, 1e-9);
        const impact_energy e = impact_scene_energy(scene);
        assert_near(e.drive_work, mub * N * V * stop, 1e-9 * (1 + e.drive_work));
        assert_account_closes(scene, 1e-11);
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* In a groove of two belts that go along it, m v = P, (2/5) m r^2 w = P r/sqrt 2, v + w r/sqrt 2 = V: at 4/9 V. The
 * impacts that clamp it go round. */
static void in_a_groove_of_belts_it_rolls_at_four_ninths(void **state)
{
    (void)state;
    const double V = 3, half = 0.39269908169872415; /* pi/8 */
    impact_body_def bodies[3] = {plane_body("left", (qvec3){0, 0, 0}, (quat){cos(half), 0, sin(half), 0}, 0.6, 0.9),
                                 plane_body("right", (qvec3){0, 0, 0}, (quat){cos(half), 0, -sin(half), 0}, 0.6, 0.9),
                                 ball_body("ball", (qvec3){0.1, 0, 1}, 1, 0.5)};
    bodies[0].velocity.y = bodies[1].velocity.y = V;
    const impact_scene_def def = scene_of(bodies, 3, 8);
    impact_scene *scene = make_scene(&def);
    run(scene, def.duration, NULL);
    impact_sample s;
    impact_scene_body(scene, 2, &s);
    assert_near3(s.velocity, (qvec3){0, 4. / 9 * V, 0}, 1e-9);
    assert_near3(s.omega, (qvec3){s.omega.x, 0, 0}, 1e-9);
    const impact_energy e = impact_scene_energy(scene);
    assert_near(e.drive_work, 4. / 9 * mass * V * V, 1e-9);
    assert_account_closes(scene, 1e-11);
    impact_scene_destroy(scene);
}

/* What goes round in one instant is answered together: a ball that just fits between two belts and is thrown against
 * one. */
static void together_drives_do_work_too(void **state)
{
    (void)state;
    random_stream random = {53};
    const quat left = {sqrt(0.5), 0, sqrt(0.5), 0}, right = {sqrt(0.5), 0, -sqrt(0.5), 0};
    for (int k = 0; k < 30; k++) {
        impact_body_def bodies[3] = {plane_body("left", (qvec3){-radius, 0, 0}, left, 0.1 + 0.02 * k, 0.9),
                                     plane_body("right", (qvec3){radius, 0, 0}, right, 0.3, 0.9),
                                     ball_body("ball", (qvec3){0, 0, 0}, 1, 1)};
        bodies[0].velocity = (qvec3){0, 3 * random_unit(&random), 2};
        bodies[1].velocity = (qvec3){0, 0, -4 * random_unit(&random)};
        bodies[2].velocity = (qvec3){0.5 + random_unit(&random), 0, 0};
        const impact_scene_def def = scene_of(bodies, 3, 0.5);
        impact_scene *scene = make_scene(&def);
        run(scene, def.duration, NULL);
        assert_true(impact_scene_usage(scene).impacts_together > 0);
        assert_true(fabs(impact_scene_energy(scene).drive_work) > 0.01);
        assert_account_closes(scene, 1e-11);
        impact_scene_destroy(scene);
    }
}

/* Drawn in where it jams it has nowhere to go: no rigid bodies do that, and the run says so. */
static void what_is_drawn_into_a_wedge_is_told(void **state)
{
    (void)state;
    const double lean = 1.2;
    impact_body_def bodies[3] = {
        plane_body("left", (qvec3){0, 0, 0}, (quat){cos(lean / 2), 0, sin(lean / 2), 0}, 0.5, 0.8),
        plane_body("right", (qvec3){0, 0, 0}, (quat){cos(lean / 2), 0, -sin(lean / 2), 0}, 0.5, 0.8),
        ball_body("ball", (qvec3){0, 0, radius / cos(lean)}, 1, 1)};
    bodies[0].velocity = quat_rotate(bodies[0].orientation, (qvec3){1, 2, 0});
    bodies[1].velocity = quat_rotate(bodies[1].orientation, (qvec3){-0.5, 1, 0});
    bodies[2].velocity = (qvec3){0.3, 0.5, -3};
    const impact_scene_def def = scene_of(bodies, 3, 1);
    impact_scene *scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_EUNSETTLED);
    assert_non_null(strstr(impact_scene_message(scene), "do moving surfaces draw a body in where it jams?"));
    impact_scene_destroy(scene);
}

/* A box that lies on a turntable goes along as long as friction can turn it, W^2 x <= mu g; else it slides off. */
static void a_box_goes_along_until_friction_gives(void **state)
{
    (void)state;
    const double mu = 0.5, x0 = 0.4, parts[5] = {0.2, 0.7, 0.999, 1.001, 1.5};
    for (int k = 0; k < 5; k++) {
        const double W = parts[k] * sqrt(mu * gravity / x0);
        impact_body_def bodies[2] = {floor_body(), ball_body("box", (qvec3){x0, 0, 0.05}, mu, 0)};
        bodies[0].omega.z = W;
        impact_shape_superquadric(0.1, 0.1, 0.05, 50, 50, 50, &bodies[1].shape);
        bodies[1].velocity.y = W * x0;
        bodies[1].omega.z = W;
        const impact_scene_def def = scene_of(bodies, 2, 2);
        impact_scene *scene = make_scene(&def);
        run(scene, def.duration, NULL);
        impact_sample s;
        impact_scene_body(scene, 1, &s);
        const qvec3 along = turned_about((qvec3){0, 0, 1}, 2 * W, bodies[1].position);
        if (parts[k] < 1)
            assert_near3(s.position, along, 1e-10);
        else
            assert_true(hypot(s.position.x, s.position.y) > x0 + 0.01);
        assert_account_closes(scene, 1e-10);
        impact_scene_destroy(scene);
    }
}

/* A belt with ends: carried over one it falls, at the speed it has. */
static void a_ball_falls_off_the_end_of_a_belt(void **state)
{
    (void)state;
    const double V = 2, mu = 0.3, t0 = 2 * V / (7 * mu * gravity), way = 0.5 * mu * gravity * t0 * t0;
    impact_body_def bodies[2] = {floor_body(), ball_body("ball", (qvec3){0, 0, radius}, mu, 0)};
    bodies[0].velocity.x = V;
    impact_shape_plane(1, 0.5, &bodies[0].shape);
    const double leaves = t0 + (1 - way) / (2. / 7 * V);
    const impact_scene_def def = scene_of(bodies, 2, leaves + 1);
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    run(scene, def.duration, &recorder);
    assert_near(log.events[find_event(&log, IMPACT_EVENT_LIFTOFF, NULL, 0)].t, leaves, 1e-10);
    impact_sample s;
    impact_scene_body(scene, 1, &s);
    assert_near3(s.position, (qvec3){1 + 2. / 7 * V, 0, radius - 0.5 * gravity}, 1e-10);
    assert_account_closes(scene, 1e-11);
    free_log(&log);
    impact_scene_destroy(scene);
}

/* Without friction a moving surface does nothing: what stands on it rests. */
static void without_friction_nothing_is_driven(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {floor_body(), ball_body("ball", (qvec3){1, 0, radius}, 0, 0)};
    bodies[0].velocity.x = 3;
    bodies[0].omega.z = 2;
    const impact_scene_def def = scene_of(bodies, 2, 5);
    impact_scene *scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_AT_REST);
    assert_true(impact_scene_energy(scene).drive_work == 0);
    impact_scene_destroy(scene);
}

/* ---- drums ---- */

static bool weigh(double t, int body, double m, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                  void *context)
{
    (void)t, (void)body, (void)x, (void)q, (void)v, (void)w, (void)torque, (void)context;
    *force = (qvec3){0, 0, -m * gravity};
    return true;
}

/* A drum is a body so heavy that nothing slows it: seen to really turn, with gravity on the other alone. */
static void a_drum_is_a_heavy_body_that_turns(void **state)
{
    (void)state;
    random_stream random = {52};
    impact_force_def weight = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    weight.function = weigh;
    weight.body = "body";
    for (int k = 0; k < 24; k++) {
        impact_body_def bodies[2] = {ball_body("drum", (qvec3){0, 0, 0}, 1, 1),
                                     ball_body("body", (qvec3){0, 0, 0}, 0.2 * (k % 6), 0.3 * (k % 3))};
        bodies[0].mass = 1e15;
        if (k % 2 == 1) impact_shape_superquadric(1.5, 1.5, 0.8, 2, 2, k % 4 == 1 ? 2 : 3, &bodies[0].shape);
        if (k % 2 == 0) impact_shape_sphere(1.2, &bodies[0].shape);
        bodies[0].orientation = random_rotation(&random);
        if (k % 2 == 1) bodies[0].orientation = quat_from_rotation_vector((qvec3){0.3, -0.2, 0.1});
        bodies[0].omega = k % 2 == 0 ? random_vector(&random, 0.5, 8)
                                     : qvec3_scale(quat_rotate(bodies[0].orientation, (qvec3){0, 0, 1}), -4);
        if (k % 8 >= 4) impact_shape_ellipsoid(0.3, 0.25, 0.2, &bodies[1].shape);
        bodies[1].position = (qvec3){0.05, -0.1, 2};
        bodies[1].omega = random_vector(&random, 0.1, 5);
        impact_sample end[2];
        for (int heavy = 0; heavy < 2; heavy++) {
            bodies[0].is_static = !heavy;
            impact_scene_def def = scene_of(bodies, 2, 0.75);
            def.gravity = (qvec3){0, 0, 0};
            def.forces = &weight;
            def.force_count = 1;
            impact_scene *scene = make_scene(&def);
            run(scene, def.duration, NULL);
            impact_scene_body(scene, 1, &end[heavy]);
            if (!heavy) assert_account_closes(scene, 1e-9);
            impact_scene_destroy(scene);
        }
        assert_near3(end[0].position, end[1].position, 1e-8);
        assert_near3(end[0].velocity, end[1].velocity, 1e-8);
        assert_near3(end[0].omega, end[1].omega, 1e-7);
    }
}

/* ---- many ---- */

/* Balls on a belt between walls, each for itself and (a force that is none stands by) by the integrator. */
static void many_on_a_belt_move_as_together(void **state)
{
    (void)state;
    impact_body_def bodies[10] = {floor_body()};
    char names[8][8];
    bodies[0].velocity = (qvec3){1.5, 0.5, 0};
    bodies[1] = plane_body("wall", (qvec3){3, 0, 0}, (quat){sqrt(0.5), 0, -sqrt(0.5), 0}, 1, 1);
    for (int i = 0; i < 8; i++) {
        snprintf(names[i], sizeof names[i], "ball %d", i);
        bodies[2 + i] = ball_body(names[i], (qvec3){0.9 * (i % 4) - 1, 0.8 * (i / 4), 0.4 + 0.05 * i}, 0.3, 0.5);
    }
    impact_force_def nothing = impact_default_force_def(IMPACT_FORCE_WIND);
    impact_sample end[2][8];
    for (int together = 0; together < 2; together++) {
        impact_scene_def def = scene_of(bodies, 10, 1.2);
        def.friction_rule = def.restitution_rule = IMPACT_MINIMUM;
        bodies[0].restitution = 1;
        def.forces = &nothing;
        def.force_count = together;
        impact_scene *scene = make_scene(&def);
        run(scene, def.duration, NULL);
        for (int i = 0; i < 8; i++) impact_scene_body(scene, 2 + i, &end[together][i]);
        assert_account_closes(scene, 1e-9);
        assert_true(impact_scene_energy(scene).drive_work > 1);
        impact_scene_destroy(scene);
    }
    for (int i = 0; i < 8; i++) {
        assert_near3(end[1][i].position, end[0][i].position, 1e-8);
        assert_near3(end[1][i].velocity, end[0][i].velocity, 1e-8);
    }
}

/* ---- what cannot be ---- */

static void expect_refusal(const impact_body_def *body, const char *wanted)
{
    char message[256];
    impact_scene *scene;
    const impact_scene_def def = scene_of(body, 1, 1);
    const impact_status status = impact_scene_create(&def, &scene, message, sizeof message);
    if (!wanted) {
        if (status != IMPACT_OK) fail_msg("%s", message);
        impact_sample s;
        impact_scene_body(scene, 0, &s);
        assert_near3(s.velocity, body->velocity, 1e-15);
        assert_near3(s.omega, body->omega, 1e-15);
        impact_scene_destroy(scene);
        return;
    }
    assert_int_equal(status, IMPACT_EARGUMENT);
    assert_string_equal(message, wanted);
}

static void what_would_move_the_shape_is_refused(void **state)
{
    (void)state;
    impact_body_def body = plane_body("belt", (qvec3){1, 2, 3}, quat_from_rotation_vector((qvec3){0.4, 0, 0}), 1, 1);
    body.velocity = quat_rotate(body.orientation, (qvec3){0.5, 0.2, 0});
    body.omega = quat_rotate(body.orientation, (qvec3){0, 0, -3});
    expect_refusal(&body, NULL);
    body.velocity.z += 1e-6;
    expect_refusal(&body, "body 'belt': velocity of a static body is its surface's: a plane's must lie along it");
    body.velocity = (qvec3){0, 0, 0};
    body.omega.x = 1e-6;
    expect_refusal(&body,
                   "body 'belt': omega of a static body is its surface's: a plane's must stand along the normal");
    body.omega.x = 0;
    impact_shape_plane(1, INFINITY, &body.shape);
    expect_refusal(&body, "body 'belt': omega of a static body is its surface's: a plane with edges would turn them");
    body.omega = (qvec3){0, 0, 0};
    body.velocity = (qvec3){2, 0, 0};
    expect_refusal(&body, NULL);
    body.name = "drum";
    impact_shape_sphere(1, &body.shape);
    expect_refusal(&body,
                   "body 'drum': velocity of a static body is its surface's: only a plane's can move along itself");
    body.velocity = (qvec3){0, 0, 0};
    body.omega = (qvec3){1, 2, 3};
    expect_refusal(&body, NULL);
    body.shape_position = quat_rotate_inverse(body.orientation, (qvec3){0.1, 0.2, 0.3});
    expect_refusal(&body, NULL);
    body.shape_position.x += 0.1;
    expect_refusal(
        &body, "body 'drum': omega of a static body is its surface's: its axis must pass through the shape's centre");
    body.shape_position = (qvec3){0, 0, 0};
    const char *const edgy =
        "body 'drum': omega of a static body is its surface's: it must stand along an axis on which the shape is round";
    impact_shape_ellipsoid(1, 1, 2, &body.shape);
    expect_refusal(&body, edgy);
    body.omega = quat_rotate(body.orientation, (qvec3){0, 0, 2});
    expect_refusal(&body, NULL);
    impact_shape_ellipsoid(1, 1.01, 2, &body.shape);
    expect_refusal(&body, edgy);
    impact_shape_superquadric(1, 1, 2, 2, 2, 8, &body.shape);
    expect_refusal(&body, NULL);
    impact_shape_superquadric(1, 1, 2, 2, 3, 2, &body.shape);
    expect_refusal(&body, edgy);
    impact_shape_superellipsoid(1, 1, 2, 0.3, 1, &body.shape);
    expect_refusal(&body, NULL);
    impact_shape_superellipsoid(1, 1, 2, 1, 0.3, &body.shape);
    expect_refusal(&body, edgy);
    impact_shape_superellipsoid(2, 1, 1, 0.3, 1, &body.shape);
    body.omega = quat_rotate(body.orientation, (qvec3){2, 0, 0});
    expect_refusal(&body, edgy);
}

int main(void)
{
    const struct CMUnitTest closed_forms[] = {cmocka_unit_test(what_would_move_the_shape_is_refused)};
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(a_ball_on_a_turntable_goes_round_at_two_sevenths),
        cmocka_unit_test(on_a_table_that_leans_it_drifts_across),
        cmocka_unit_test(a_ball_on_a_belt_rolls_at_two_sevenths),
        cmocka_unit_test(a_ball_dropped_on_a_belt_ends_the_same),
        cmocka_unit_test(a_belt_is_a_floor_seen_from_a_train),
        cmocka_unit_test(between_belt_and_wall_it_spins_in_its_place),
        cmocka_unit_test(in_a_groove_of_belts_it_rolls_at_four_ninths),
        cmocka_unit_test(together_drives_do_work_too),
        cmocka_unit_test(what_is_drawn_into_a_wedge_is_told),
        cmocka_unit_test(a_box_goes_along_until_friction_gives),
        cmocka_unit_test(a_ball_falls_off_the_end_of_a_belt),
        cmocka_unit_test(without_friction_nothing_is_driven),
        cmocka_unit_test(a_drum_is_a_heavy_body_that_turns),
        cmocka_unit_test(many_on_a_belt_move_as_together),
    };
    const int failed = cmocka_run_group_tests(closed_forms, NULL, NULL);
    return impact_has(IMPACT_PART_CVODE) ? failed + cmocka_run_group_tests(integrated, NULL, NULL) : failed;
}
