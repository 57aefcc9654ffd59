/* SPDX-License-Identifier: MIT
 *
 * Whole scenes against closed forms: bounces, slides, rolls and several bodies with known answers.
 */
#include "kit/contact_random.h"
#include "kit/scene_log.h"

static const double mass = 4, radius = 0.3, gravity = 9.81;

/* ---- bounces, in closed form throughout ---- */

static void ten_bounces(void **state)
{
    (void)state;
    const double g = 9.80665, e = 0.8, w0 = sqrt(2 * g);
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1),
                                 ball_body("ball", (qvec3){0, 0, radius + 1}, 0.25, e)};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 60;
    def.output_rate = 0;
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_AT_REST);
    double t = w0 / g, w = w0;
    for (int i = 0; i < 10; i++) {
        assert_near(log.events[i].t, t, 4e-15 * (i + 1));
        assert_near(log.events[i].normal_before, -w, 1e-14 * w0);
        assert_near(log.events[i].normal_after * log.events[i].normal_after / (2 * g), pow(e, 2 * i + 2), 4e-15);
        t += 2 * e * w / g;
        w *= e;
    }
    /* Zeno: all bounces end at w0/g + 2 e w0/(g (1 - e)), but for the tail below the rest height. */
    const int contact = find_event(&log, IMPACT_EVENT_CONTACT, "roll", 0);
    assert_true(contact >= 0);
    const double zeno = w0 / g * (1 + 2 * e / (1 - e)), tail = 2 * sqrt(2 * def.rest_height / g) / (1 - e);
    assert_true(log.events[contact].t < zeno && log.events[contact].t > zeno - tail / e);
    const impact_usage usage = impact_scene_usage(scene);
    assert_int_equal(usage.integrators, 0);
    assert_true(usage.ballistic_flights > 10);
    impact_sample rest;
    assert_int_equal(impact_scene_body(scene, impact_scene_find(scene, "ball"), &rest), IMPACT_OK);
    assert_near3(rest.position, (qvec3){0, 0, radius}, 1e-15);
    assert_true(qvec3_norm(rest.velocity) == 0 && qvec3_norm(rest.omega) == 0);
    free_log(&log);
    impact_scene_destroy(scene);
}

/* ---- slides and rolls with known answers ---- */

/* A ball thrown along the floor without spin slides until t = 2 v0/(7 mu g), then rolls at 5/7 v0 (Coriolis 1835). */
static void bowling_ball(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        const double v0 = 0.3 * pow(3, k - 3), mu = 0.05 + 0.1 * k, angle = 0.7 * k;
        impact_body_def bodies[2] = {plane_body("lane", (qvec3){0, 0, 0}, quat_identity(), 1, 0),
                                     ball_body("ball", (qvec3){0, 0, radius}, mu, 0)};
        bodies[1].velocity = (qvec3){v0 * cos(angle), v0 * sin(angle), 0};
        impact_scene_def def = impact_default_scene_def();
        def.gravity = (qvec3){0, 0, -gravity};
        def.bodies = bodies;
        def.body_count = 2;
        def.tolerance = 1e-14;
        def.rest_speed = 1e-10; /* it rolls once its slip is below a hundredth of it */
        const double t = 2 * v0 / (7 * mu * gravity);
        def.duration = 2 * t;
        impact_scene *scene = make_scene(&def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
        const int stick = find_event(&log, IMPACT_EVENT_STICK, "roll", 0);
        assert_true(stick >= 0);
        assert_near(log.events[stick].t, t, 1e-12);
        impact_sample end;
        impact_scene_body(scene, 1, &end);
        assert_near3(end.velocity, qvec3_scale(bodies[1].velocity, 5.0 / 7), 1e-12 * fmax(1, v0));
        assert_near(qvec3_norm(end.omega), 5.0 / 7 * v0 / radius, 1e-11 * fmax(1, v0));
        const impact_energy energy = impact_scene_energy(scene);
        assert_near(energy.sliding_loss, mass * v0 * v0 / 7, 1e-12 * fmax(1, mass * v0 * v0));
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* On an incline of angle a, a ball rolls at 5/7 g sin a when friction allows (mu > 2/7 tan a), and slides at g (sin a -
 * mu cos a) else. */
static void incline(void **state)
{
    (void)state;
    for (int slides = 0; slides < 2; slides++) {
        const double angle = 0.5, mu = slides ? 0.1 : 0.2;
        const quat tilt = {cos(angle / 2), 0, sin(angle / 2), 0};
        const qvec3 normal = quat_rotate(tilt, (qvec3){0, 0, 1}), down = quat_rotate(tilt, (qvec3){1, 0, 0});
        impact_body_def bodies[2] = {plane_body("incline", (qvec3){0, 0, 0}, tilt, 1, 0),
                                     ball_body("ball", qvec3_scale(normal, radius), mu, 0)};
        impact_scene_def def = impact_default_scene_def();
        def.gravity = (qvec3){0, 0, -gravity};
        def.bodies = bodies;
        def.body_count = 2;
        def.duration = 2;
        impact_scene *scene = make_scene(&def);
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
        const double a = slides ? gravity * (sin(angle) - mu * cos(angle)) : 5.0 / 7 * gravity * sin(angle);
        const double spin = slides ? 2.5 * mu * gravity * cos(angle) / radius : a / radius;
        impact_sample end;
        impact_scene_body(scene, 1, &end);
        assert_near3(end.position, qvec3_axpy(0.5 * a * 4, down, bodies[1].position), 1e-10);
        assert_near3(end.velocity, qvec3_scale(down, a * 2), 1e-10);
        assert_near3(end.omega, (qvec3){0, spin * 2, 0}, 1e-9);
        impact_scene_destroy(scene);
    }
}

/* It rolls over the floor's edge and falls as a stone. */
static void falls_off_the_edge(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("table", (qvec3){0, 0, 0}, quat_identity(), 1, 0),
                                 ball_body("ball", (qvec3){0, 0, radius}, 1, 0)};
    impact_shape_plane(0.5, 2, &bodies[0].shape);
    bodies[1].velocity = (qvec3){1, 0, 0};
    bodies[1].omega = (qvec3){0, 1 / radius, 0};
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 1;
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    const int liftoff = find_event(&log, IMPACT_EVENT_LIFTOFF, NULL, 0);
    assert_true(liftoff >= 0);
    assert_near(log.events[liftoff].t, 0.5, 1e-12);
    impact_sample end;
    impact_scene_body(scene, 1, &end);
    assert_near3(end.position, (qvec3){1, 0, radius - 0.5 * gravity * 0.25}, 1e-11);
    free_log(&log);
    impact_scene_destroy(scene);
}

/* ---- several bodies ---- */

/* Newton's cradle of three, not touching: the last flies off with the first one's velocity. */
static void cradle(void **state)
{
    (void)state;
    impact_body_def bodies[3] = {ball_body("a", (qvec3){0, 0, 0}, 0, 1), ball_body("b", (qvec3){1, 0, 0}, 0, 1),
                                 ball_body("c", (qvec3){1.7, 0, 0}, 0, 1)};
    bodies[0].velocity = (qvec3){2, 0, 0};
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies;
    def.body_count = 3;
    impact_scene *scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    const double x[3] = {0.4, 1.1, 1.7 + 2 * (1 - 0.25)}, v[3] = {0, 0, 2};
    for (int i = 0; i < 3; i++) {
        impact_sample s;
        impact_scene_body(scene, i, &s);
        assert_near3(s.position, (qvec3){x[i], 0, 0}, 1e-14);
        assert_near3(s.velocity, (qvec3){v[i], 0, 0}, 1e-14);
    }
    const impact_usage usage = impact_scene_usage(scene);
    assert_int_equal(usage.integrators, 0);
    assert_int_equal(usage.events[IMPACT_EVENT_IMPACT], 2);
    impact_scene_destroy(scene);
}

/* Two bodies that fall towards each other under Newton's attraction alone, from rest a distance d apart: they meet at
 * t = sqrt(d^3/(2 G (m1 + m2))) (acos(sqrt(x)) + sqrt(x (1 - x))), x = 2 r/d. */
static void fall_by_attraction(void **state)
{
    (void)state;
    const double d = 3, G = 0.5, x = 2 * radius / d;
    impact_body_def bodies[2] = {ball_body("a", (qvec3){0, 0, 0}, 0, 0.5), ball_body("b", (qvec3){0, d, 0}, 0, 0.5)};
    impact_force_def attraction = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    attraction.constant = G;
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies;
    def.body_count = 2;
    def.forces = &attraction;
    def.force_count = 1;
    const double t = sqrt(d * d * d / (2 * G * 2 * mass)) * (acos(sqrt(x)) + sqrt(x * (1 - x)));
    def.duration = 1.01 * t;
    def.restitution_rule = IMPACT_MAXIMUM;
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    assert_near(log.events[0].t, t, 1e-10);
    const double speed = sqrt(2 * G * 2 * mass * (1 / (2 * radius) - 1 / d));
    assert_near(log.events[0].normal_before, -speed, 1e-10);
    assert_near(log.events[0].normal_after, 0.5 * speed, 1e-10);
    const impact_energy energy = impact_scene_energy(scene);
    assert_near(energy.kinetic + energy.potential, energy.start - energy.impact_loss, 1e-9);
    free_log(&log);
    impact_scene_destroy(scene);
}

/* The whole scene turned by a rotation, and its bodies in another order, gives the turned answer. */
static void invariant_under_rotation_and_order(void **state)
{
    (void)state;
    quat turn;
    quat_normalize((quat){0.3, -0.7, 0.2, 0.5}, &turn);
    impact_sample ends[2];
    for (int turned = 0; turned < 2; turned++) {
        const quat r = turned ? turn : quat_identity();
        const int ball = turned ? 1 : 0, other = turned ? 0 : 1;
        impact_body_def bodies[3] = {[2] = plane_body("floor", (qvec3){0, 0, 0}, r, 0.4, 0.7)};
        bodies[ball] = ball_body("ball", quat_rotate(r, (qvec3){0, 0, 1}), 0.6, 0.8);
        bodies[ball].velocity = quat_rotate(r, (qvec3){1, 0.3, 0});
        bodies[ball].omega = quat_rotate(r, (qvec3){3, -8, 11});
        bodies[other] = ball_body("other", quat_rotate(r, (qvec3){1.2, 0.2, 0.3}), 0.5, 0.8);
        impact_scene_def def = impact_default_scene_def();
        def.gravity = quat_rotate(r, (qvec3){0, 0, -gravity});
        def.bodies = bodies;
        def.body_count = 3;
        def.duration = 0.9;
        impact_scene *scene = make_scene(&def);
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
        impact_scene_body(scene, impact_scene_find(scene, "ball"), &ends[turned]);
        const impact_usage usage = impact_scene_usage(scene);
        assert_true(usage.events[IMPACT_EVENT_IMPACT] >= 2);
        impact_scene_destroy(scene);
    }
    assert_near3(ends[1].position, quat_rotate(turn, ends[0].position), 1e-12);
    assert_near3(ends[1].velocity, quat_rotate(turn, ends[0].velocity), 1e-11);
    assert_near3(ends[1].omega, quat_rotate(turn, ends[0].omega), 1e-10);
}

/* ---- octahedra ---- */

/* |x/a| + |y/b| + |z/c| <= 1 thrown on a floor, given as `shape`: how it lies at the end. */
static impact_status throw_octahedron(const impact_shape *shape, unsigned long seed, impact_sample *end,
                                      impact_body_def *def_back)
{
    random_stream random = {seed};
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.6, 0.3),
                                 ball_body("stone", (qvec3){0, 0, 0.4}, 0.5, 0.4)};
    bodies[1].shape = *shape;
    bodies[1].mass = 2;
    bodies[1].moments = (qvec3){0.03, 0.04, 0.035};
    bodies[1].orientation = random_rotation(&random);
    bodies[1].velocity = random_vector(&random, 0.1, 2);
    bodies[1].omega = random_vector(&random, 0.1, 10);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 4;
    impact_scene *scene = make_scene(&def);
    const impact_status status = impact_scene_run(scene, NULL);
    impact_scene_body(scene, 1, end);
    *def_back = impact_default_body_def();
    assert_int_equal(impact_scene_body_def(scene, 1, def_back), IMPACT_OK);
    impact_scene_destroy(scene);
    return status;
}

/* A superquadric of exponents 1 is held with its corners and faces, as the polyhedron of the same corners, to the bit;
 * its definition is given back as it was. In the end it lies on a face: the faces are at abc/|(bc, ca, ab)|. */
static void octahedra_are_polyhedra(void **state)
{
    (void)state;
    const double a = 0.2, b = 0.15, c = 0.18, height = a * b * c / qvec3_norm((qvec3){b * c, c * a, a * b});
    const qvec3 corners[] = {{a, 0, 0}, {-a, 0, 0}, {0, b, 0}, {0, -b, 0}, {0, 0, c}, {0, 0, -c}};
    impact_hull *hull;
    impact_shape shapes[3];
    assert_int_equal(impact_hull_create(corners, 6, 0, NULL, &hull, NULL, 0), IMPACT_OK);
    impact_shape_superquadric(a, b, c, 1, 1, 1, &shapes[0]);
    impact_shape_superellipsoid(a, b, c, 2, 2, &shapes[1]);
    impact_shape_polyhedron(hull, &shapes[2]);
    for (unsigned long seed = 1; seed <= 6; seed++) {
        impact_sample end[3];
        for (int k = 0; k < 3; k++) {
            impact_body_def back;
            assert_int_equal(throw_octahedron(&shapes[k], seed, &end[k], &back), IMPACT_AT_REST);
            assert_int_equal(back.shape.kind, shapes[k].kind);
            assert_true(back.shape.hull == shapes[k].hull && back.shape.a == shapes[k].a);
            assert_memory_equal(&end[k].position, &end[0].position, sizeof end[0].position);
            assert_memory_equal(&end[k].orientation, &end[0].orientation, sizeof end[0].orientation);
        }
        assert_near(end[0].position.z, height, 1e-9);
    }
    impact_hull_destroy(hull);
}

/* And is refused where polyhedra are. */
static void octahedra_are_refused_as_polyhedra(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.6, 0.3),
                                 ball_body("stone", (qvec3){0, 0, 0.4}, 0.5, 0.4)};
    impact_shape_superquadric(0.1, 0.1, 0.1, 1, 1, 1, &bodies[1].shape);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.piles = IMPACT_PILES_EXACT;
    impact_scene *scene;
    char message[200];
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "piles = 'exact' is not for them"));
    def.piles = IMPACT_PILES_AUTO;
    impact_shape_plane(1, 1, &bodies[0].shape);
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "a plane with edges carries no bodies with faces"));
    impact_shape_superquadric(0.1, 0.1, 0.1, 1, 1, 1.1, &bodies[1].shape); /* it has edges, each a contact of its own */
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
    impact_shape_superquadric(0.1, 0.1, 0.1, 1, 1.1, 1.1, &bodies[1].shape);
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_OK);
    impact_scene_destroy(scene);
}

/* ---- edges that straight lines join ---- */

typedef struct tumbled {
    impact_sample end;
    double account; /* what its energies are off by, of the first */
    bool stepped;
} tumbled;

/* The body dropped, spinning, on a rough floor by the method of motion. */
static tumbled tumble(const impact_shape *shape, unsigned long seed, impact_motion_method method, double tolerance)
{
    random_stream random = {seed};
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.6, 0.2),
                                 ball_body("stone", (qvec3){0, 0, 0.5}, 0.5, 0.3)};
    bodies[1].shape = *shape;
    bodies[1].orientation = random_rotation(&random);
    bodies[1].velocity = random_vector(&random, 0.1, 2);
    bodies[1].omega = random_vector(&random, 0.1, 20);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 1;
    def.methods.motion = method;
    def.tolerance = tolerance;
    impact_scene *scene = make_scene(&def);
    const impact_status status = impact_scene_run(scene, NULL);
    if (status != IMPACT_OK && status != IMPACT_AT_REST) fail_msg("seed %lu: %s", seed, impact_scene_message(scene));
    const impact_energy e = impact_scene_energy(scene);
    tumbled t = {.account = fabs(e.kinetic + e.potential + e.sliding_loss + e.impact_loss - e.start) / e.start,
                 .stepped = impact_scene_usage(scene).pile_steps > 0};
    impact_scene_body(scene, 1, &t.end);
    impact_scene_destroy(scene);
    return t;
}

/* Where such a body tips from edge to edge, its next edge strikes and is held (as a smooth body its one lowest point
 * would jump, and its energy with it), and what an edge or an apex holds ends where the one gives way to the other: the
 * account closes, and a second method of motion ends in the same place: to 1e-8, or as closely as it does itself with
 * another tolerance, as of two thousand bounces that die out each multiplies what was off before. */
static void edges_that_lines_join(void **state)
{
    (void)state;
    impact_shape shapes[4];
    int compared = 0;
    impact_shape_superquadric(0.2, 0.15, 0.18, 1, 1, 1.2, &shapes[0]);
    impact_shape_superquadric(0.1, 0.15, 0.2, 1.7, 1, 1, &shapes[1]);
    impact_shape_superellipsoid(0.2, 0.15, 0.18, 1.5, 2, &shapes[2]); /* t = 1.33, its section a rhombus */
    impact_shape_superellipsoid(0.2, 0.15, 0.1, 2, 1.2, &shapes[3]);  /* a double cone */
    for (int k = 0; k < 4; k++)
        for (unsigned long seed = 1; seed <= 4; seed++) {
            const tumbled one = tumble(&shapes[k], seed, IMPACT_MOTION_AUTO, 1e-13),
                          other = tumble(&shapes[k], seed, IMPACT_MOTION_CVODE, 1e-13),
                          finer = tumble(&shapes[k], seed, IMPACT_MOTION_CVODE, 3e-14);
            const double apart = qvec3_norm(qvec3_sub(finer.end.position, other.end.position));
            assert_at_most(fmax(one.account, other.account), 1e-11);
            if (one.stepped) continue; /* to a step's error */
            assert_near3(other.end.position, one.end.position, fmax(1e-8, 2 * apart));
            assert_at_most(apart, 3e-8);
            compared++;
        }
    assert_true(compared >= 12);
}

/* Edges with flat places, over which the contact runs without bound, are held as they are; what the integrator does not
 * get over goes by steps. An edge of one exponent of 1 beside flat places is integrated along, to the same place with
 * another tolerance. As smooth bodies the first four gained or lost up to half of their energy, the others 1e-5. */
static void edges_with_flat_places(void **state)
{
    (void)state;
    impact_shape shapes[6];
    impact_shape_superquadric(0.2, 0.15, 0.18, 1, 1, 4, &shapes[0]);
    impact_shape_superquadric(0.2, 0.15, 0.18, 50, 1, 1, &shapes[1]);
    impact_shape_superellipsoid(0.2, 0.15, 0.18, 0.5, 2, &shapes[2]);
    impact_shape_superellipsoid(0.2, 0.15, 0.1, 2, 0.3, &shapes[3]);
    impact_shape_superquadric(0.2, 0.15, 0.18, 1, 4, 4, &shapes[4]);
    impact_shape_superquadric(0.2, 0.15, 0.18, 1.5, 8, 1, &shapes[5]);
    for (int k = 0; k < 6; k++)
        for (unsigned long seed = 1; seed <= 6; seed++) {
            const tumbled one = tumble(&shapes[k], seed, IMPACT_MOTION_AUTO, 1e-13);
            assert_at_most(one.account, 1e-9);
            if (k < 4) continue;
            const tumbled other = tumble(&shapes[k], seed, IMPACT_MOTION_AUTO, 1e-12);
            assert_false(one.stepped);
            assert_near3(other.end.position, one.end.position, 1e-8);
        }
}

int main(void)
{
    const struct CMUnitTest closed_forms[] = {
        cmocka_unit_test(ten_bounces),
        cmocka_unit_test(cradle),
        cmocka_unit_test(octahedra_are_refused_as_polyhedra),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(bowling_ball),
        cmocka_unit_test(incline),
        cmocka_unit_test(falls_off_the_edge),
        cmocka_unit_test(fall_by_attraction),
        cmocka_unit_test(invariant_under_rotation_and_order),
        cmocka_unit_test(octahedra_are_polyhedra),
        cmocka_unit_test(edges_that_lines_join),
        cmocka_unit_test(edges_with_flat_places),
    };
    const int failed = cmocka_run_group_tests(closed_forms, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
