/* SPDX-License-Identifier: MIT
 *
 * From event to event: what could hide inside one long step is found, in closed form and by the integrator alike.
 */
#include "kit/contact_random.h"
#include "kit/scene_log.h"

static const double gravity = 9.81;

static impact_body_def small_ball(const char *name, double r, qvec3 position, qvec3 velocity)
{
    impact_body_def body = impact_default_body_def();
    body.name = name;
    body.mass = 1;
    body.position = position;
    body.velocity = velocity;
    body.friction = 0;
    body.restitution = 1;
    impact_shape_sphere(r, &body.shape);
    return body;
}

static impact_scene_def scene_of(const impact_body_def *bodies, int count, double duration)
{
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies;
    def.body_count = count;
    def.duration = duration;
    def.output_rate = 0;
    return def;
}

static bool nothing(double t, int body, double m, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                    void *context)
{
    (void)t, (void)body, (void)m, (void)x, (void)q, (void)v, (void)w, (void)force, (void)torque, (void)context;
    return true;
}

/* A force of nothing: the same motion, by the integrator. */
static impact_force_def idle_force(void)
{
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = nothing;
    force.max_step = INFINITY;
    return force;
}

/* The roads a scene can take: closed form, and the integrator where there is one. */
static int road_count(void) { return impact_has(IMPACT_PART_CVODE) ? 2 : 1; }

static void take_road(impact_scene_def *def, int road, const impact_force_def *idle)
{
    def->forces = idle;
    def->force_count = road;
}

static scene_log run_log(const impact_scene_def *def, impact_usage *usage)
{
    impact_scene *scene = make_scene(def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    const impact_status status = impact_scene_run(scene, &recorder);
    if (status < 0) fail_msg("%s", impact_scene_message(scene));
    if (usage) *usage = impact_scene_usage(scene);
    impact_scene_destroy(scene);
    return log;
}

/* Past a small ball at rest, at any speed and from far, by a part of the sum of radii within its edge or beyond it. */
static void a_ball_grazes_a_ball(void **state)
{
    (void)state;
    const impact_force_def idle = idle_force();
    random_stream random = {21};
    for (int k = 0; k < 300; k++) {
        const double r1 = random_log(&random, 1e-3, 1), r2 = random_log(&random, 1e-3, 1), sum = r1 + r2;
        const double speed = random_log(&random, 0.1, 1e4), depth = random_log(&random, 1e-6, 1) * (k & 1 ? 1 : -1);
        const double beside = sum * (1 - depth), from = random_log(&random, 2, 100) * sum;
        const qvec3 along = random_direction(&random);
        qvec3 across = qvec3_cross(along, random_direction(&random));
        across = qvec3_scale(across, 1 / qvec3_norm(across));
        const qvec3 place = qvec3_scale(random_direction(&random), 0.1);
        const impact_body_def bodies[2] = {small_ball("still", r1, place, (qvec3){0, 0, 0}),
                                           small_ball("fast", r2,
                                                      qvec3_axpy(-from, along, qvec3_axpy(beside, across, place)),
                                                      qvec3_scale(along, speed))};
        impact_scene_def def = scene_of(bodies, 2, 3 * from / speed);
        for (int road = 0; road < road_count(); road++) {
            take_road(&def, road, &idle);
            impact_usage usage;
            scene_log log = run_log(&def, &usage);
            assert_int_equal(usage.integrators > 0, road); /* each body has its own */
            assert_int_equal(log.event_count, depth > 0);
            if (depth > 0) {
                const double half = sqrt((sum - beside) * (sum + beside)); /* of the chord */
                const double blur = 1e-14 * (from + sum) * sum / (half * speed);
                assert_near(log.events[0].t, (from - half) / speed, blur + 1e-13 * from / speed);
                assert_near(log.events[0].normal_before, -speed * half / sum, 1e-12 * speed * (from + sum) / half);
            }
            free_log(&log);
        }
    }
}

/* A 1e-4 m ball at 1e4 m/s meets every wall, at every angle but along it. */
static void a_bullet_meets_the_wall(void **state)
{
    (void)state;
    const impact_force_def idle = idle_force();
    random_stream random = {22};
    for (int k = 0; k < 200; k++) {
        const double r = 1e-4, speed = 1e4, from = random_log(&random, 1e-3, 1e3);
        const quat turn = random_rotation(&random);
        const qvec3 n = quat_rotate(turn, (qvec3){0, 0, 1});
        const double steep = random_log(&random, 1e-3, 1), flat = sqrt(1 - steep * steep);
        const qvec3 v =
            qvec3_axpy(-speed * steep, n, qvec3_scale(quat_rotate(turn, (qvec3){0.6, 0.8, 0}), speed * flat));
        const impact_body_def bodies[2] = {plane_body("wall", (qvec3){0, 0, 0}, turn, 0, 1),
                                           small_ball("bullet", r, qvec3_scale(n, r + from), v)};
        const double t = from / (speed * steep);
        impact_scene_def def = scene_of(bodies, 2, 5 * t);
        for (int road = 0; road < road_count(); road++) {
            take_road(&def, road, &idle);
            scene_log log = run_log(&def, NULL);
            assert_int_equal(log.event_count, 1);
            assert_near(log.events[0].t, t, 1e-12 * t);
            assert_near(log.events[0].normal_after, speed * steep, 1e-11 * speed);
            free_log(&log);
        }
    }
}

/* Thrown up at a ceiling: the top of its way a little above it, just under it, or far under it. Only what reaches it
 * strikes. */
static void a_throw_that_dips_into_the_ceiling(void **state)
{
    (void)state;
    const impact_force_def idle = idle_force();
    for (int k = 0; k < 26; k++) {
        const double r = 1e-3, dip = pow(10, -(k / 2)) * (k & 1 ? 1 : -1), height = 2 - dip, w = sqrt(2 * gravity * 2);
        const impact_body_def bodies[2] = {plane_body("ceiling", (qvec3){0, 0, height + r}, (quat){0, 1, 0, 0}, 0, 1),
                                           small_ball("ball", r, (qvec3){0, 0, 0}, (qvec3){0.3, 0, w})};
        if (fabs(dip) < 1e-11) continue; /* known to no double */
        impact_scene_def def = scene_of(bodies, 2, 1.5 * w / gravity);
        def.gravity = (qvec3){0, 0, -gravity};
        for (int road = 0; road < road_count(); road++) {
            take_road(&def, road, &idle);
            scene_log log = run_log(&def, NULL);
            assert_int_equal(log.event_count, dip > 0);
            if (dip > 0) {
                const double before = sqrt(2 * gravity * dip) / gravity;
                assert_near(log.events[0].t, w / gravity - before, 1e-13 + 1e-14 / before);
            }
            free_log(&log);
        }
    }
}

/* Contact without approach is no impact: a ball that glides along a wall, two that touch and part, or go side by side.
 */
static void touching_is_not_striking(void **state)
{
    (void)state;
    const impact_force_def idle = idle_force();
    const qvec3 velocities[3] = {{3, 0, 0}, {0, 0, 2}, {1, 1, 0}};
    for (int k = 0; k < 6; k++) {
        const bool plane = k < 3;
        impact_body_def bodies[2] = {plane_body("wall", (qvec3){0, 0, 0}, quat_identity(), 0.5, 1),
                                     small_ball("ball", 0.25, (qvec3){0, 0, 0.25}, velocities[k % 3])};
        if (!plane)
            bodies[0] = small_ball("other", 0.5, (qvec3){0, 0, -0.5}, k == 4 ? (qvec3){0, 0, 0} : velocities[k % 3]);
        bodies[1].friction = 0.5;
        impact_scene_def def = scene_of(bodies, 2, 2);
        for (int road = 0; road < road_count(); road++) {
            take_road(&def, road, &idle);
            impact_scene *scene = make_scene(&def);
            if (impact_scene_run(scene, NULL) < 0) fail_msg("%s", impact_scene_message(scene));
            const impact_usage usage = impact_scene_usage(scene);
            assert_int_equal(usage.events[IMPACT_EVENT_IMPACT], 0);
            impact_sample end;
            impact_scene_body(scene, 1, &end);
            assert_near3(end.position, qvec3_axpy(2, velocities[k % 3], bodies[1].position), 1e-12);
            impact_scene_destroy(scene);
        }
    }
}

/* Through the plane's surface beside its bounds, round behind it, and back up beside them: no impact; then down onto
 * it. */
static void beyond_the_bounds_and_back(void **state)
{
    (void)state;
    const double r = 0.1;
    impact_body_def bodies[3] = {plane_body("table", (qvec3){0, 0, 0}, quat_identity(), 0, 1),
                                 plane_body("ground", (qvec3){0, 0, -1}, quat_identity(), 0, 1),
                                 small_ball("ball", r, (qvec3){-2, 0, r + 1}, (qvec3){1, 0, 0})};
    impact_shape_plane(0.5, 0.5, &bodies[0].shape);
    impact_scene_def def = scene_of(bodies, 3, 4);
    def.gravity = (qvec3){0, 0, -gravity};
    const impact_force_def idle = idle_force();
    /* Falls from 2 m above the ground, and bounces to 2 m again and again, while it drifts across the table. */
    const double fall = sqrt(4 / gravity), onto = sqrt(2 / gravity);
    for (int road = 0; road < road_count(); road++) {
        take_road(&def, road, &idle);
        scene_log log = run_log(&def, NULL);
        assert_true(log.event_count >= 3);
        assert_near(log.events[0].t, fall, 1e-12);
        assert_int_equal(log.events[0].body2, 1);
        /* At t = 2 fall it is at its top again, x = -2 + 2 fall = -0.72; it meets the table's height at x = -0.27: onto
         * it. */
        assert_near(log.events[1].t, 2 * fall + onto, 1e-12);
        assert_int_equal(log.events[1].body2, 0);
        assert_near3(log.events[1].point, (qvec3){-2 + 2 * fall + onto, 0, 0}, 1e-11);
        /* The next time, too, at x = .63: beside it, down to the ground. */
        assert_near(log.events[2].t, 2 * fall + 2 * onto + fall, 1e-11);
        assert_true(-2 + 2 * fall + 3 * onto > 0.5);
        assert_near(log.events[2].t, 2 * fall + 2 * onto + fall, 1e-11);
        assert_int_equal(log.events[2].body2, 1);
        free_log(&log);
    }
}

/* A ball between two walls that face each other: so many bounces in so much time. */
static void between_two_walls(void **state)
{
    (void)state;
    const impact_force_def idle = idle_force();
    const double r = 0.05, speed = 7;
    const impact_body_def bodies[3] = {plane_body("left", (qvec3){-0.5, 0, 0}, (quat){1, 0, 1, 0}, 0, 1),
                                       plane_body("right", (qvec3){0.5, 0, 0}, (quat){1, 0, -1, 0}, 0, 1),
                                       small_ball("ball", r, (qvec3){0, 0, 0}, (qvec3){speed, 0, 1})};
    impact_scene_def def = scene_of(bodies, 3, 10);
    for (int road = 0; road < road_count(); road++) {
        take_road(&def, road, &idle);
        scene_log log = run_log(&def, NULL);
        assert_int_equal(log.event_count, (int)floor((10 * speed - 0.45) / 0.9) + 1);
        for (int i = 0; i < log.event_count; i++) assert_near(log.events[i].t, (0.45 + 0.9 * i) / speed, 1e-12);
        free_log(&log);
    }
}

/* The torque-free tumbling of a body of three different moments keeps its energy and its angular momentum. */
static void tumbling_keeps_energy_and_momentum(void **state)
{
    (void)state;
    random_stream random = {23};
    for (int k = 0; k < 10; k++) {
        impact_body_def body = small_ball("T", 0.1, (qvec3){0, 0, 0}, (qvec3){0.1, 0, 0});
        impact_shape_ellipsoid(0.1, 0.2, 0.3, &body.shape);
        body.orientation = random_rotation(&random);
        body.omega = random_vector(&random, 0.1, 20);
        const impact_scene_def def = scene_of(&body, 1, 10);
        impact_scene *scene = make_scene(&def);
        if (impact_scene_run(scene, NULL) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
        impact_sample end;
        impact_scene_body(scene, 0, &end);
        const qvec3 moments = impact_shape_inertia(&body.shape);
        qvec3 l[2];
        for (int i = 0; i < 2; i++) {
            const quat q = i ? end.orientation : body.orientation;
            const qvec3 w = quat_rotate_inverse(q, i ? end.omega : body.omega);
            l[i] = quat_rotate(q, (qvec3){moments.x * w.x, moments.y * w.y, moments.z * w.z});
        }
        assert_near3(l[1], l[0], 1e-14 * qvec3_norm(l[0]));
        const impact_energy energy = impact_scene_energy(scene);
        assert_int_equal(impact_scene_usage(scene).integrators, 0);
        assert_near(energy.kinetic / energy.start, 1, 1e-13);
        impact_scene_destroy(scene);
    }
}

/* ---- bodies that tumble ---- */

static impact_body_def tumbling(random_stream *random, const char *name, int family, qvec3 position, qvec3 velocity)
{
    impact_body_def body = small_ball(name, 1, position, velocity);
    body.shape = random_shape(random, family);
    body.orientation = random_rotation(random);
    body.omega = random_vector(random, 0.5, 20);
    return body;
}

static impact_solid solid_of(const impact_body_def *def, const impact_sample *sample)
{
    return (impact_solid){def->shape, sample->position, sample->orientation};
}

/* Two of them fall, towards each other and to the ground: never nearer than touching before the first event, and
 * touching there; without the integrator, and when and where it has them meet. */
static void tumbling_bodies_meet(void **state)
{
    (void)state;
    const impact_force_def idle = idle_force();
    random_stream random = {24};
    int pair_met = 0, ground_met = 0;
    for (int k = 0; k < 60; k++) {
        const int family = k % 2 ? RANDOM_ELLIPSOID : RANDOM_ROUND;
        const qvec3 offset = qvec3_scale(random_direction(&random), 0.2);
        impact_body_def bodies[3] = {plane_body("ground", (qvec3){0, 0, 0}, quat_identity(), 0, 1),
                                     tumbling(&random, "left", family, (qvec3){-4, 0, 6}, (qvec3){k % 3 ? 4 : 1, 0, 2}),
                                     tumbling(&random, "right", family, (qvec3){4 + offset.x, offset.y, 6 + offset.z},
                                              (qvec3){k % 3 ? -4 : -1, 0, 2})};
        impact_scene_def def = scene_of(bodies, 3, 3);
        def.gravity = (qvec3){0, 0, -gravity};
        def.max_events = 1;
        def.output_rate = 500;
        impact_event first[2] = {{0}};
        for (int road = 0; road < road_count(); road++) {
            take_road(&def, road, &idle);
            impact_usage usage;
            scene_log log = run_log(&def, &usage);
            assert_true(log.event_count > 0);
            first[road] = log.events[0];
            if (road == 1) {
                free_log(&log);
                continue;
            }
            assert_int_equal(usage.integrators + usage.integrator_steps, 0);
            for (int i = 0; i + 1 < log.sample_count && log.samples[i].t < first[0].t; i += 2) {
                const impact_solid left = solid_of(&bodies[1], &log.samples[i]),
                                   right = solid_of(&bodies[2], &log.samples[i + 1]);
                const impact_solid ground = {bodies[0].shape, bodies[0].position, bodies[0].orientation};
                impact_contact contact;
                impact_gap(&left, &right, NULL, &contact);
                assert_true(contact.upper > 0);
                impact_gap(&left, &ground, NULL, &contact);
                assert_true(contact.upper > 0);
                impact_gap(&right, &ground, NULL, &contact);
                assert_true(contact.upper > 0);
            }
            free_log(&log);
        }
        *(first[0].body2 == 0 ? &ground_met : &pair_met) += 1;
        if (road_count() < 2) continue;
        assert_int_equal(first[0].body2, first[1].body2);
        assert_near(first[0].t, first[1].t, 1e-10);
        assert_near3(first[0].point, first[1].point, 1e-8);
    }
    if (pair_met < 10 || ground_met < 10) fail_msg("%d pairs met, %d the ground", pair_met, ground_met);
}

/* A disc 1e-4 m thick that tumbles, at 1e4 m/s, to a wall and to a plate as thin: it meets both, however it happens to
 * stand. */
static void a_tumbling_disc_does_not_tunnel(void **state)
{
    (void)state;
    random_stream random = {25};
    for (int k = 0; k < 200; k++) {
        const double speed = 1e4, from = random_log(&random, 1e-2, 1e2), thin = 0.5e-4;
        const bool plate = k % 2;
        impact_body_def bodies[2] = {plane_body("wall", (qvec3){0, 0, 0}, random_rotation(&random), 0, 1),
                                     small_ball("disc", 1, (qvec3){0, 0, 0}, (qvec3){0, 0, 0})};
        if (plate) impact_shape_superquadric(0.2, 0.2, thin, 2, 2, 4, &bodies[0].shape);
        impact_shape_superquadric(1e-3, 1e-3, thin, 2, 2, 4, &bodies[1].shape);
        const qvec3 n = quat_rotate(bodies[0].orientation, (qvec3){0, 0, 1});
        bodies[1].position = qvec3_scale(n, from + 2e-3);
        bodies[1].velocity = qvec3_scale(n, -speed);
        bodies[1].orientation = random_rotation(&random);
        bodies[1].omega = random_vector(&random, 1, 1e5);
        impact_scene_def def = scene_of(bodies, 2, 2 * (from + 2e-3) / speed);
        impact_usage usage;
        scene_log log = run_log(&def, &usage);
        assert_true(log.event_count >= 1); /* its rim may strike again */
        assert_int_equal(usage.integrators, 0);
        assert_true(log.events[0].t > from / speed && log.events[0].t < (from + 2e-3) / speed);
        impact_sample at = log.samples[0];
        const impact_solid disc = solid_of(&bodies[1], &at),
                           wall = {bodies[0].shape, bodies[0].position, bodies[0].orientation};
        impact_contact contact;
        impact_gap(&disc, &wall, NULL, &contact);
        assert_near(contact.gap, 0, 1e-15 * speed * log.events[0].t + 1e-15);
        free_log(&log);
    }
}

/* Two elastic bodies of every family of shapes in a box of planes: hundreds of impacts, none of them by the integrator,
 * every bounce as high as it came, no energy lost, and never a sample in which anything overlaps. */
enum { BOX = 6 };

static void box_of_planes(impact_body_def *bodies)
{
    static const char *const names[BOX] = {"-x", "+x", "-y", "+y", "-z", "+z"};
    for (int i = 0; i < BOX; i++) {
        const double sign = i % 2 ? -1 : 1;
        const qvec3 n = {i / 2 == 0 ? sign : 0, i / 2 == 1 ? sign : 0, i / 2 == 2 ? sign : 0};
        quat turn;
        quat_from_two_vectors((qvec3){0, 0, 1}, n, &turn);
        bodies[i] = plane_body(names[i], qvec3_scale(n, -3), turn, 0, 1);
    }
}

static void nothing_overlaps(const impact_body_def *bodies, const impact_sample two[2])
{
    const impact_solid solid[2] = {solid_of(&bodies[BOX], &two[0]), solid_of(&bodies[BOX + 1], &two[1])};
    impact_contact contact;
    impact_gap(&solid[0], &solid[1], NULL, &contact);
    assert_true(contact.upper > -2e-15);
    for (int i = 0; i < 2 * BOX; i++) {
        const impact_body_def *plane = &bodies[i / 2];
        impact_gap(&solid[i % 2], &(impact_solid){plane->shape, plane->position, plane->orientation}, NULL, &contact);
        assert_true(contact.upper > -2e-15);
    }
}

static void tumbling_in_a_box(void **state)
{
    (void)state;
    for (int k = 0; k < 3 * (RANDOM_FAMILIES - 1); k++) {
        random_stream random = {27 + (uint64_t)k};
        const int family = 1 + k / 3;
        impact_body_def bodies[BOX + 2];
        box_of_planes(bodies);
        for (int i = 0; i < 2; i++)
            bodies[BOX + i] = tumbling(&random, i ? "b" : "a", family, (qvec3){i ? 1.5 : -1.5, 0, 0},
                                       qvec3_scale(random_direction(&random), 4));
        impact_scene_def def = scene_of(bodies, BOX + 2, 15);
        def.output_rate = 20;
        impact_scene *scene = make_scene(&def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        if (impact_scene_run(scene, &recorder) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
        const impact_usage usage = impact_scene_usage(scene);
        const impact_energy energy = impact_scene_energy(scene);
        assert_int_equal(usage.integrators + usage.integrator_steps, 0);
        assert_int_equal(usage.events[IMPACT_EVENT_IMPACT], log.event_count);
        assert_true(log.event_count > 10);
        for (int i = 0; i < log.event_count; i++)
            assert_near(log.events[i].normal_after, -log.events[i].normal_before, 1e-9);
        assert_near((energy.kinetic + energy.potential) / energy.start, 1, 1e-12);
        for (int i = 0; i + 1 < log.sample_count; i++)
            if (log.samples[i].body == BOX && log.samples[i + 1].body == BOX + 1 &&
                log.samples[i].t == log.samples[i + 1].t)
                nothing_overlaps(bodies, &log.samples[i]);
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* A hundred orbits under Newton's attraction, a thousand seconds: the energy, and where they end. */
static void orbits_keep_their_energy(void **state)
{
    (void)state;
    const double mu = 4 * 9.8696044010893586188 / 100; /* a period of 10 s at a half axis of 1 m */
    for (int k = 0; k < 3; k++) {
        const double eccentricity = 0.3 * k, r = 1 + eccentricity, v = sqrt(mu * (1 - eccentricity) / r);
        impact_body_def bodies[2] = {small_ball("a", 1e-3, (qvec3){-0.5 * r, 0, 0}, (qvec3){0, -0.5 * v, 0}),
                                     small_ball("b", 1e-3, (qvec3){0.5 * r, 0, 0}, (qvec3){0, 0.5 * v, 0})};
        impact_force_def attraction = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
        attraction.constant = mu / 2;
        impact_scene_def def = scene_of(bodies, 2, 1000);
        def.forces = &attraction;
        def.force_count = 1;
        impact_scene *scene = make_scene(&def);
        if (impact_scene_run(scene, NULL) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
        const impact_energy energy = impact_scene_energy(scene);
        assert_near((energy.kinetic + energy.potential) / energy.start, 1, 1e-9);
        impact_sample end;
        impact_scene_body(scene, 0, &end);
        assert_near3(end.position, bodies[0].position, 1e-6);
        impact_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_grazes_a_ball),
        cmocka_unit_test(a_bullet_meets_the_wall),
        cmocka_unit_test(a_throw_that_dips_into_the_ceiling),
        cmocka_unit_test(beyond_the_bounds_and_back),
        cmocka_unit_test(between_two_walls),
        cmocka_unit_test(tumbling_keeps_energy_and_momentum),
        cmocka_unit_test(tumbling_bodies_meet),
        cmocka_unit_test(a_tumbling_disc_does_not_tunnel),
        cmocka_unit_test(tumbling_in_a_box),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(touching_is_not_striking),
        cmocka_unit_test(orbits_keep_their_energy),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
