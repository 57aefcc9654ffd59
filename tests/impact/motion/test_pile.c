/* SPDX-License-Identifier: MIT
 *
 * Motion by steps against closed forms, to the error that it says of itself; and the pile that it is for.
 */
#include <math.h>
#include <impact/gap.h>
#include "kit/scene_log.h"

enum { WALLS = 5, BALLS = 5 };

static const double gravity = 9.81, radius = 0.1;

typedef struct outcome {
    impact_status status;
    impact_energy energy;
    impact_usage usage;
    double error, t;
    impact_sample samples[WALLS + BALLS];
} outcome;

static impact_scene_def scene_of(const impact_body_def *bodies, int count, double duration, impact_piles piles)
{
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.bodies = bodies;
    def.body_count = count;
    def.duration = duration;
    def.output_rate = 0;
    def.friction_rule = def.restitution_rule = IMPACT_MINIMUM;
    def.piles = piles;
    return def;
}

static outcome run(const impact_scene_def *def)
{
    outcome o;
    char message[256];
    impact_scene *scene;
    assert_int_equal(impact_scene_create(def, &scene, message, sizeof message), IMPACT_OK);
    o.status = impact_scene_run(scene, NULL);
    o.energy = impact_scene_energy(scene);
    o.usage = impact_scene_usage(scene);
    o.error = impact_scene_pile_error(scene);
    o.t = impact_scene_time(scene);
    for (int i = 0; i < def->body_count; i++) impact_scene_body(scene, i, &o.samples[i]);
    impact_scene_destroy(scene);
    return o;
}

static void assert_account(const impact_energy *e)
{
    const double losses = e->impact_loss + e->sliding_loss + e->damping_loss;
    assert_near(e->kinetic + e->potential + losses, e->start, 1e-12 * fabs(e->start));
}

static impact_body_def ball(const char *name, qvec3 position, double friction, double restitution)
{
    impact_body_def body = ball_body(name, position, friction, restitution);
    impact_shape_sphere(radius, &body.shape);
    return body;
}

static const quat flat = {1, 0, 0, 0};

/* ---- closed forms ---- */

static void flight_is_exact(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, flat, 1, 1),
                                 ball("ball", (qvec3){0, 0, 2}, 0.3, 0.5)};
    bodies[1].velocity = (qvec3){1, -2, 3};
    const impact_scene_def def = scene_of(bodies, 2, 0.7, IMPACT_PILES_STEPS);
    const outcome o = run(&def);
    assert_int_equal(o.status, IMPACT_OK);
    assert_near3(o.samples[1].position, (qvec3){0.7, -1.4, 2 + 2.1 - 0.5 * gravity * 0.49}, 1e-13);
    assert_near3(o.samples[1].velocity, (qvec3){1, -2, 3 - gravity * 0.7}, 1e-13);
    assert_true(o.usage.pile_steps == 0 && o.usage.integrators == 0); /* what touches nothing needs no steps */
}

/* It rises to the part e² of its height; the way there is as long as e says. */
static void bounces_rise_as_high_as_they_should(void **state)
{
    (void)state;
    const double drop = 1, e = 0.5, fall = sqrt(2 * drop / gravity), t = 1.3 * fall;
    const impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, flat, 1, 1),
                                       ball("ball", (qvec3){0, 0, drop + radius}, 0.3, e)};
    const impact_scene_def def = scene_of(bodies, 2, t, IMPACT_PILES_STEPS);
    const outcome o = run(&def);
    const double up = e * gravity * fall, since = t - fall;
    assert_near(o.samples[1].position.z, radius + up * since - 0.5 * gravity * since * since, 1e-5);
    assert_near(o.samples[1].velocity.z, up - gravity * since, 1e-4);
    assert_account(&o.energy);
}

/* Slip dies out at 2 v/(7 mu g), and 5/7 of the speed is left. */
static void a_ball_slides_until_it_rolls(void **state)
{
    (void)state;
    const double v = 1, mu = 0.3, duration = 0.5, stop = 2 * v / (7 * mu * gravity);
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, flat, 1, 1),
                                 ball("ball", (qvec3){0, 0, radius}, mu, 0)};
    bodies[1].velocity = (qvec3){v, 0, 0};
    impact_scene_def def = scene_of(bodies, 2, duration, IMPACT_PILES_STEPS);
    def.pile_tolerance = 1e-4;
    const outcome o = run(&def);
    const double way = v * stop - 0.5 * mu * gravity * stop * stop + 5.0 / 7 * v * (duration - stop);
    assert_near(o.samples[1].velocity.x, 5.0 / 7 * v, 1e-12);
    assert_near(o.samples[1].omega.y, 5.0 / 7 * v / radius, 1e-11);
    assert_near(o.samples[1].position.x, way, 1e-5);
    assert_account(&o.energy);
}

/* Out of the tube of a wind: the force ends within a step, on the way that the exact motion goes. */
static void forces_end_where_they_reach(void **state)
{
    (void)state;
    impact_body_def body = ball("ball", (qvec3){0, 0, 0}, 0.3, 0.5);
    body.velocity = (qvec3){1, 0, 0};
    impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
    wind.direction = (qvec3){1, 0, 0};
    wind.strength = 5;
    wind.reach = 0.5;
    double end[2], work[2];
    for (int k = 0; k < 2; k++) {
        impact_scene_def def = scene_of(&body, 1, 1, k ? IMPACT_PILES_STEPS : IMPACT_PILES_EXACT);
        def.gravity = (qvec3){0, 0, 0};
        def.forces = &wind;
        def.force_count = 1;
        const outcome o = run(&def);
        end[k] = o.samples[0].position.x;
        work[k] = o.energy.force_work;
    }
    assert_true(work[0] > 0.1);
    assert_near(work[1], work[0], 0.02 * work[0]);
    assert_near(end[1], end[0], 1e-2 * end[0]);
}

/* ---- the pile ---- */

/* Five balls fall into a shaft as wide as two and a bit, and jam. rolling: m; at 0 what rolls along a corner of the
 * shaft does so for ever. */
static void make_shaft(double rolling, impact_body_def *bodies)
{
    const double h = sqrt(0.5);
    const qvec3 at[WALLS] = {{0, 0, 0}, {-0.25, 0, 0}, {0.25, 0, 0}, {0, -0.11, 0}, {0, 0.11, 0}};
    const quat turned[WALLS] = {{1, 0, 0, 0}, {h, 0, h, 0}, {h, 0, -h, 0}, {h, -h, 0, 0}, {h, h, 0, 0}};
    static const char *const names[] = {"floor", "west", "east", "south", "north", "1", "2", "3", "4", "5"};
    const qvec3 from[BALLS] = {
        {-0.14, 0, 0.15}, {0.13, 0, 0.2}, {0.01, 0.003, 0.5}, {-0.02, -0.005, 0.8}, {0.02, -0.005, 1.1}};
    for (int i = 0; i < WALLS; i++) bodies[i] = plane_body(names[i], at[i], turned[i], 1, 1);
    for (int i = 0; i < BALLS; i++) {
        bodies[WALLS + i] = ball(names[WALLS + i], from[i], 0.3, 0.25);
        bodies[WALLS + i].rolling_friction = rolling;
    }
}

static void assert_apart(const outcome *o)
{
    for (int i = WALLS; i < WALLS + BALLS; i++) {
        const qvec3 x = o->samples[i].position;
        assert_true(x.z > radius * (1 - 1e-6) && fabs(x.x) < 0.25 - radius * (1 - 1e-6));
        for (int j = WALLS; j < i; j++)
            assert_true(qvec3_norm(qvec3_sub(x, o->samples[j].position)) > 2 * radius * (1 - 1e-6));
    }
}

static void a_shaft_of_balls_comes_to_rest(void **state)
{
    (void)state;
    impact_body_def bodies[WALLS + BALLS];
    make_shaft(1e-4, bodies);
    for (int k = 0; k < 2; k++) {
        impact_scene_def def = scene_of(bodies, WALLS + BALLS, 4, k ? IMPACT_PILES_AUTO : IMPACT_PILES_STEPS);
        def.pile_tolerance = 1e-5;
        const outcome o = run(&def), again = run(&def);
        assert_int_equal(o.status, IMPACT_AT_REST);
        assert_true(o.usage.islands_stepped >= 1);
        assert_true(o.usage.pile_steps > 0 && o.usage.pile_steps < 5000);
        assert_true(o.error > 0 && o.error < 0.1 * radius);
        assert_int_equal(o.usage.events[IMPACT_EVENT_REST] >= BALLS, 1);
        const impact_energy *e = &o.energy;
        const double losses = e->impact_loss + e->sliding_loss;
        assert_near(e->kinetic, 0, 0);
        assert_near(e->potential + losses, e->start, k ? 1e-8 : 1e-11); /* exactly moved at first: to its tolerance */
        assert_apart(&o);
        for (int i = 0; i < WALLS + BALLS; i++)
            assert_memory_equal(&o.samples[i].position, &again.samples[i].position, sizeof o.samples[i].position);
    }
}

/* A ball in the groove of two others that the walls hold: what rests from the start is at rest at once. */
static void what_rests_is_at_rest_at_once(void **state)
{
    (void)state;
    impact_body_def bodies[WALLS + BALLS];
    make_shaft(0, bodies);
    const double half = 0.25 - radius;
    bodies[WALLS].position = (qvec3){-half, 0, radius};
    bodies[WALLS + 1].position = (qvec3){half, 0, radius};
    bodies[WALLS + 2].position = (qvec3){0, 0, radius + sqrt(4 * radius * radius - half * half)};
    const impact_scene_def def = scene_of(bodies, WALLS + 3, 1, IMPACT_PILES_STEPS);
    const outcome o = run(&def);
    assert_int_equal(o.status, IMPACT_AT_REST);
    assert_int_equal(o.usage.pile_steps, 0); /* what settles at t = 0 needs no motion */
    assert_near(o.samples[WALLS + 2].position.z, bodies[WALLS + 2].position.z, 1e-12);
}

/* ---- the choice ---- */

static void exact_motion_takes_no_steps(void **state)
{
    (void)state;
    impact_body_def bodies[WALLS + BALLS];
    make_shaft(0, bodies);
    const impact_scene_def def = scene_of(bodies, WALLS + BALLS, 0.3, IMPACT_PILES_EXACT);
    const outcome o = run(&def);
    assert_int_equal(o.usage.islands_stepped, 0);
    assert_int_equal(o.usage.pile_steps, 0);
    assert_true(o.error == 0);
}

static void other_choices_are_refused(void **state)
{
    (void)state;
    const impact_body_def body = ball("ball", (qvec3){0, 0, 1}, 0.3, 0.5);
    char message[256];
    impact_scene *scene;
    for (int k = -1; k <= 3; k += 4) {
        const impact_scene_def def = scene_of(&body, 1, 1, (impact_piles)k);
        assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
        assert_non_null(strstr(message, "piles"));
    }
}

/* A force that gives up ends motion by steps in words, which name the heaviest of the bodies that move. */
static bool gives_up(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 omega, qvec3 *force,
                     qvec3 *torque, void *context)
{
    (void)body, (void)mass, (void)x, (void)q, (void)v, (void)omega;
    *force = *torque = (qvec3){0, 0, 0};
    return t < *(const double *)context;
}

static void a_force_that_gives_up_is_told(void **state)
{
    (void)state;
    double until = 0.1;
    char message[256];
    impact_scene *scene;
    impact_body_def bodies[5] = {plane_body("floor", (qvec3){0, 0, 0}, flat, 1, 1),
                                 ball("light", (qvec3){0, 0, radius}, 0.3, 0),
                                 ball("heavy", (qvec3){2.02 * radius, 0, radius}, 0.3, 0),
                                 plane_body("wall", (qvec3){-1, 0, 0}, (quat){sqrt(0.5), 0, sqrt(0.5), 0}, 0.3, 0),
                                 ball("last", (qvec3){4.04 * radius, 0, radius}, 0.3, 0)};
    bodies[1].velocity = (qvec3){2, 0, 0}, bodies[1].mass = 1, bodies[2].mass = 3, bodies[4].mass = 2;
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.name = "law", force.function = gives_up, force.context = &until;
    impact_scene_def def = scene_of(bodies, 5, 1, IMPACT_PILES_STEPS);
    def.forces = &force, def.force_count = 1;
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_OK);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_EDOMAIN);
    assert_near(impact_scene_time(scene), until, 0.05);
    if (!strstr(impact_scene_message(scene), "of which body 'heavy' is the heaviest (3 kg)"))
        fail_msg("%s", impact_scene_message(scene));
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest closed_forms[] = {
        cmocka_unit_test(flight_is_exact),
        cmocka_unit_test(bounces_rise_as_high_as_they_should),
        cmocka_unit_test(a_ball_slides_until_it_rolls),
        cmocka_unit_test(what_rests_is_at_rest_at_once),
        cmocka_unit_test(exact_motion_takes_no_steps),
        cmocka_unit_test(a_force_that_gives_up_is_told),
        cmocka_unit_test(other_choices_are_refused),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(forces_end_where_they_reach),
        cmocka_unit_test(a_shaft_of_balls_comes_to_rest),
    };
    const int failed = cmocka_run_group_tests(closed_forms, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
