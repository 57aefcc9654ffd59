/* SPDX-License-Identifier: MIT
 *
 * Superquadrics of exponents 1, 1, t that turn over where an edge ends in an apex, on a plane without friction: their
 * edge gives way to the apex, or the apex to an edge, and the run goes on. Heights are the support's, energy and
 * horizontal momentum stay; with friction, too, the motion is the same where the scene is mirrored, slowed, or the
 * body's axes are renumbered.
 */
#include "kit/contact_random.h"
#include "kit/near.h"
#include <impact/impact.h>

enum { STARTS = 150 };

typedef struct apex_scene {
    impact_scene_def def;
    impact_body_def bodies[2];
    double turning; /* s: how long, at the end */
} apex_scene;

/* What a run did: energy that went, J, stretches of motion, contacts held at its end. */
typedef struct run_facts {
    double lost;
    long stretches;
    int held;
} run_facts;

/* Where the place of the edge along +-x, the farther one, is s = beta/(t alpha) on its way to the apex, 1 there. */
static qvec3 towards_apex(random_stream *random, const impact_shape *shape, double s)
{
    const double x = random_unit(random) < 0.5 ? -1 : 1, y = random_unit(random) - 0.5, z = random_unit(random) < 0.5;
    const qvec3 d = {x / shape->a, y / shape->b, (z > 0 ? 1 : -1) * s * shape->t / shape->c};
    return qvec3_scale(d, 1 / qvec3_norm(d));
}

/* It stands on the floor, near to where both meet or, not apart, there; its place does not rise or fall. */
static void make(random_stream *random, bool apart, apex_scene *s)
{
    const qvec3 down = {0, 0, -1};
    qvec3 place;
    quat tilt, turn;
    s->def = impact_default_scene_def();
    s->bodies[0] = s->bodies[1] = impact_default_body_def();
    s->bodies[0].name = "floor", s->bodies[1].name = "body";
    s->bodies[0].is_static = true;
    s->bodies[0].friction = s->bodies[1].friction = 0;
    impact_shape_plane(INFINITY, INFINITY, &s->bodies[0].shape);
    impact_body_def *b = &s->bodies[1];
    const double size[3] = {random_log(random, 0.3, 1), random_log(random, 0.3, 1), random_log(random, 0.3, 1)};
    impact_shape_superquadric(size[0], size[1], size[2], 1, 1, 1.05 + random_unit(random), &b->shape);
    const qvec3 d = towards_apex(random, &b->shape, apart ? 0.98 + 0.04 * random_unit(random) : 1);
    quat_from_two_vectors(d, down, &tilt);
    quat_from_axis_angle(down, 6 * random_unit(random), &turn);
    b->orientation = quat_mul(turn, tilt);
    b->position = (qvec3){0, 0, impact_shape_support(&b->shape, d, &place)};
    b->omega = random_vector(random, 0.5, 5);
    b->velocity = (qvec3){0, 0, -qvec3_cross(b->omega, quat_rotate(b->orientation, place)).z};
    s->def.bodies = s->bodies;
    s->def.body_count = 2;
    s->def.duration = 1;
    s->turning = 0.05;
    s->def.output_rate = 0;
}

/* From the middle of the run on: there times have a rounding that they have not at 0. */
static impact_sample run(apex_scene *s, run_facts *facts)
{
    impact_scene *scene;
    impact_sample start, end;
    impact_body_def *b = &s->bodies[1];
    const qvec3 place = b->position;
    s->def.bodies = s->bodies;
    b->position = (qvec3){0, 0, 10};
    assert_int_equal(impact_scene_create(&s->def, &scene, NULL, 0), IMPACT_OK);
    assert_int_equal(impact_scene_run_to(scene, s->def.duration - s->turning, NULL), IMPACT_OK);
    impact_scene_body(scene, 1, &start);
    start.position = b->position = place, start.orientation = b->orientation;
    start.velocity = b->velocity, start.omega = b->omega;
    assert_int_equal(impact_scene_set_state(scene, 1, &start), IMPACT_OK);
    const impact_energy had = impact_scene_energy(scene);
    const long before = impact_scene_usage(scene).integrator_starts;
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    impact_scene_body(scene, 1, &end);
    const impact_energy has = impact_scene_energy(scene);
    facts->held = impact_scene_held(scene, NULL, 0);
    facts->stretches = impact_scene_usage(scene).integrator_starts - before;
    facts->lost = had.kinetic + had.potential - has.kinetic - has.potential;
    impact_scene_destroy(scene);
    return end;
}

/* Through y = 0. */
static qvec3 mirrored(qvec3 v) { return (qvec3){v.x, -v.y, v.z}; }
static qvec3 spun(qvec3 omega) { return (qvec3){-omega.x, omega.y, -omega.z}; }

static void mirror(apex_scene *s)
{
    impact_body_def *b = &s->bodies[1];
    b->velocity = mirrored(b->velocity);
    b->omega = spun(b->omega);
    b->orientation.x = -b->orientation.x, b->orientation.z = -b->orientation.z;
}

static void slow(apex_scene *s, double factor)
{
    impact_body_def *b = &s->bodies[1];
    s->def.duration *= factor, s->turning *= factor;
    s->def.gravity = qvec3_scale(s->def.gravity, 1 / (factor * factor));
    b->velocity = qvec3_scale(b->velocity, 1 / factor);
    b->omega = qvec3_scale(b->omega, 1 / factor);
}

/* The body's x, y, z are its y, z, x. */
static void renumber(apex_scene *s)
{
    impact_body_def *b = &s->bodies[1];
    const impact_shape old = b->shape;
    impact_shape_superquadric(old.c, old.a, old.b, old.t, old.r, old.s, &b->shape);
    b->orientation = quat_mul(b->orientation, (quat){0.5, -0.5, -0.5, -0.5});
}

static void edges_and_apexes_hand_over(void **state)
{
    (void)state;
    random_stream random = {91};
    int stood = 0;
    for (int k = 0; k < STARTS; k++) {
        apex_scene s;
        run_facts facts;
        make(&random, k % 2, &s);
        const impact_sample end = run(&s, &facts);
        const qvec3 d = quat_rotate_inverse(end.orientation, (qvec3){0, 0, -1});
        const double gap = end.position.z - impact_shape_support(&s.bodies[1].shape, d, NULL);
        assert_true(gap > -1e-12);
        assert_near(end.velocity.x, 0, 1e-10);
        assert_near(end.velocity.y, 0, 1e-10);
        assert_near(facts.lost, 0, 1e-9);
        stood += gap < 1e-12;
    }
    assert_true(stood > STARTS / 4);
}

/* Where both are as low what is held is what is ahead: within a nanosecond nothing else is. */
static void what_is_held_stays(void **state)
{
    (void)state;
    random_stream random = {93};
    for (int k = 0; k < STARTS; k++) {
        apex_scene s;
        run_facts facts;
        make(&random, false, &s);
        s.turning = 1e-9;
        run(&s, &facts);
        assert_true(facts.stretches <= 1);
    }
}

/* What lies on a line, from edge to edge, that has shrunk to the apex and goes on so stands on that, once. */
static void lines_end_in_one_apex(void **state)
{
    (void)state;
    random_stream random = {94};
    for (int k = 0; k < STARTS; k++) {
        apex_scene s;
        run_facts facts;
        qvec3 place;
        make(&random, false, &s);
        impact_body_def *b = &s.bodies[1];
        const impact_shape *shape = &b->shape;
        const qvec3 d = {1 / shape->a, 1 / shape->b, shape->t / shape->c}, about = {-d.y, d.x, 0};
        quat_from_two_vectors(d, (qvec3){0, 0, -1}, &b->orientation);
        b->position.z = impact_shape_support(shape, d, &place) / qvec3_norm(d);
        b->omega = quat_rotate(b->orientation, qvec3_scale(about, 1 / qvec3_norm(about)));
        b->velocity = (qvec3){0, 0, -qvec3_cross(b->omega, quat_rotate(b->orientation, place)).z};
        s.turning = 1e-9;
        run(&s, &facts);
        assert_int_equal(facts.held, 1);
    }
}

static void the_same_motion(void **state)
{
    (void)state;
    random_stream random = {92};
    for (int k = 0; k < STARTS; k++) {
        apex_scene s, other;
        run_facts facts;
        make(&random, k % 2, &s);
        /* friction, of slip that does not die out meanwhile */
        s.bodies[0].friction = s.bodies[1].friction = random_unit(&random);
        s.bodies[1].velocity.x = 1;
        const impact_sample end = run(&s, &facts);
        other = s, mirror(&other);
        const impact_sample reflected = run(&other, &facts);
        assert_near3(mirrored(reflected.position), end.position, 1e-9);
        assert_near3(spun(reflected.omega), end.omega, 1e-7);
        other = s, slow(&other, 3);
        const impact_sample slowed = run(&other, &facts);
        assert_near3(slowed.position, end.position, 1e-9);
        assert_near3(qvec3_scale(slowed.omega, 3), end.omega, 1e-7);
        other = s, renumber(&other);
        const impact_sample renumbered = run(&other, &facts);
        assert_near3(renumbered.position, end.position, 1e-9);
        assert_near3(renumbered.omega, end.omega, 1e-7);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(edges_and_apexes_hand_over),
                                       cmocka_unit_test(what_is_held_stays), cmocka_unit_test(lines_end_in_one_apex),
                                       cmocka_unit_test(the_same_motion)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
