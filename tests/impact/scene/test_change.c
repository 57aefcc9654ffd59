/* SPDX-License-Identifier: MIT
 *
 * Pushes and states that a host sets: against closed forms and balances, with nothing changed where they are refused.
 */
#include "kit/random_scene.h"
#include "kit/scene_log.h"

enum { FLOOR, BALL, OTHER, BODIES };

static const double gravity = 9.81, mass_of_ball = 4, radius = 0.3;

static impact_scene *two_balls(qvec3 ball, qvec3 other, double friction, double restitution, impact_piles piles)
{
    static impact_body_def bodies[BODIES];
    bodies[FLOOR] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1);
    bodies[BALL] = ball_body("ball", ball, friction, restitution);
    bodies[OTHER] = ball_body("other", other, friction, restitution);
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.bodies = bodies;
    def.body_count = BODIES;
    def.duration = 4;
    def.piles = piles;
    return make_scene(&def);
}

static impact_sample state_of(const impact_scene *scene, int body)
{
    impact_sample sample;
    assert_int_equal(impact_scene_body(scene, body, &sample), IMPACT_OK);
    return sample;
}

static void assert_account_holds(const impact_scene *scene, double tolerance)
{
    const impact_energy e = impact_scene_energy(scene);
    const double losses = e.damping_loss + e.sliding_loss + e.impact_loss;
    assert_near(e.kinetic + e.potential, e.start + e.force_work + e.drive_work - losses, tolerance);
}

static void a_push_in_flight_turns_the_path(void **state)
{
    (void)state;
    const qvec3 x0 = {0, 0, 5}, J = {2, -4, 8};
    impact_scene *scene = two_balls(x0, (qvec3){9, 0, 5}, 0, 1, IMPACT_PILES_AUTO);
    assert_int_equal(impact_scene_run_to(scene, 0.25, NULL), IMPACT_OK);
    const qvec3 before = state_of(scene, BALL).velocity,
                point = qvec3_add(state_of(scene, BALL).position, (qvec3){0.1, 0, 0});
    assert_int_equal(impact_scene_push(scene, BALL, J, point), IMPACT_OK);
    const impact_sample after = state_of(scene, BALL);
    assert_near3(after.velocity, qvec3_axpy(1 / mass_of_ball, J, before), 1e-15);
    const double inertia = 0.4 * mass_of_ball * radius * radius;
    assert_near3(after.omega, qvec3_scale(qvec3_cross((qvec3){0.1, 0, 0}, J), 1 / inertia), 1e-13);
    assert_near(impact_scene_energy(scene).force_work,
                0.5 * mass_of_ball * (qvec3_dot(after.velocity, after.velocity) - qvec3_dot(before, before)) +
                    0.5 * inertia * qvec3_dot(after.omega, after.omega),
                1e-12);
    assert_int_equal(impact_scene_run_to(scene, 0.75, NULL), IMPACT_OK);
    const qvec3 v = after.velocity, a = {0, 0, -gravity};
    assert_near3(state_of(scene, BALL).position, qvec3_axpy(0.125, a, qvec3_axpy(0.5, v, after.position)), 1e-14);
    assert_account_holds(scene, 1e-11);
    impact_scene_destroy(scene);
}

/* Down on the floor: the impulse comes back with the restitution; along it: it slips, mu g, until it rolls at 5/7. */
static void a_push_on_a_resting_ball_is_an_impact_or_a_slip(void **state)
{
    (void)state;
    for (int piles = IMPACT_PILES_AUTO; piles <= IMPACT_PILES_STEPS; piles++) {
        impact_scene *scene = two_balls((qvec3){0, 0, radius}, (qvec3){9, 0, radius}, 0.4, 0.5, (impact_piles)piles);
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_AT_REST);
        const double t0 = impact_scene_time(scene);
        const qvec3 centre = state_of(scene, BALL).position;
        assert_int_equal(impact_scene_push(scene, BALL, (qvec3){mass_of_ball, 0, 0}, centre), IMPACT_OK);
        assert_int_equal(impact_scene_run_to(scene, t0 + 1, NULL), IMPACT_OK);
        const double tolerance = piles == IMPACT_PILES_STEPS ? 1e-4 : 1e-10;
        assert_near3(state_of(scene, BALL).velocity, (qvec3){5.0 / 7, 0, 0}, tolerance);
        assert_near(state_of(scene, OTHER).position.x, 9, 0);
        assert_account_holds(scene, 1e-8);
        impact_scene_destroy(scene);
    }
    impact_scene *scene = two_balls((qvec3){0, 0, radius}, (qvec3){9, 0, radius}, 0.4, 0.5, IMPACT_PILES_AUTO);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_AT_REST);
    assert_int_equal(impact_scene_push(scene, BALL, (qvec3){0, 0, -8}, state_of(scene, BALL).position), IMPACT_OK);
    assert_near3(state_of(scene, BALL).velocity, (qvec3){0, 0, 0.5 * 8 / mass_of_ball}, 1e-13);
    impact_scene_destroy(scene);
}

/* A line of two on the floor: a push on one, towards the other, is a game of billiards at rest. */
static void a_push_goes_on_through_what_touches(void **state)
{
    (void)state;
    impact_scene *scene = two_balls((qvec3){0, 0, radius}, (qvec3){2 * radius, 0, radius}, 0, 1, IMPACT_PILES_AUTO);
    assert_int_equal(impact_scene_run_to(scene, 0.5, NULL), IMPACT_AT_REST);
    assert_int_equal(impact_scene_push(scene, BALL, (qvec3){mass_of_ball, 0, 0}, state_of(scene, BALL).position),
                     IMPACT_OK);
    assert_near3(state_of(scene, BALL).velocity, (qvec3){0, 0, 0}, 1e-12);
    assert_near3(state_of(scene, OTHER).velocity, (qvec3){1, 0, 0}, 1e-12);
    impact_scene_destroy(scene);
}

/* One that lies on the other is taken away, and comes back: each time the rest settles under what it holds then. */
static void a_set_state_lets_go_and_takes_up(void **state)
{
    (void)state;
    for (int piles = IMPACT_PILES_AUTO; piles <= IMPACT_PILES_STEPS; piles++) {
        const qvec3 low = {0, 0, radius}, high = {0, 0, 3 * radius};
        impact_scene *scene = two_balls(low, high, 0.5, 0, (impact_piles)piles);
        impact_held held[2];
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_AT_REST);
        assert_int_equal(impact_scene_held(scene, held, 2), 2);
        impact_sample sample = state_of(scene, OTHER);
        sample.position = (qvec3){3, 0, radius};
        assert_int_equal(impact_scene_set_state(scene, OTHER, &sample), IMPACT_OK);
        impact_status status = impact_scene_run_to(scene, impact_scene_time(scene) + 0.1, NULL);
        assert_int_equal(status, IMPACT_AT_REST);
        assert_int_equal(impact_scene_held(scene, held, 2), 2);
        for (int k = 0; k < 2; k++) assert_near3(held[k].force, (qvec3){0, 0, mass_of_ball * gravity}, 1e-9);
        sample.position = (qvec3){0, 0, 3 * radius};
        assert_int_equal(impact_scene_set_state(scene, OTHER, &sample), IMPACT_OK);
        status = impact_scene_run_to(scene, impact_scene_time(scene) + 0.1, NULL);
        assert_int_equal(status, IMPACT_AT_REST);
        assert_int_equal(impact_scene_held(scene, held, 2), 2);
        assert_near(fabs(held[0].force.z) + fabs(held[1].force.z), 3 * mass_of_ball * gravity, 1e-9);
        assert_near(impact_scene_energy(scene).force_work, 0, 1e-8);
        assert_account_holds(scene, 1e-8);
        impact_scene_destroy(scene);
    }
}

static void a_set_state_flies_on_from_there(void **state)
{
    (void)state;
    for (int begun = 0; begun < 2; begun++) {
        impact_scene *scene = two_balls((qvec3){0, 0, 1}, (qvec3){9, 0, 5}, 0, 0.5, IMPACT_PILES_AUTO);
        if (begun) assert_int_equal(impact_scene_run_to(scene, 0.1, NULL), IMPACT_OK);
        impact_sample sample = state_of(scene, BALL);
        sample.position = (qvec3){-2, 7, 1.3};
        sample.velocity = (qvec3){0, 0, 0};
        sample.orientation = quat_make(0, 0, 0, 3);
        assert_int_equal(impact_scene_set_state(scene, BALL, &sample), IMPACT_OK);
        assert_near(state_of(scene, BALL).orientation.z, 1, 0);
        impact_event event;
        const double t = impact_scene_time(scene);
        assert_int_equal(impact_scene_step(scene, 3, NULL, &event), IMPACT_OK);
        assert_near(event.t, t + sqrt(2 / gravity), 1e-14);
        assert_near3(event.point, (qvec3){-2, 7, 0}, 1e-15);
        assert_account_holds(scene, 1e-11);
        impact_scene_destroy(scene);
    }
}

static void refuses(impact_scene *scene, impact_status wanted, impact_status got, const char *words)
{
    assert_int_equal(got, wanted);
    if (!strstr(impact_scene_message(scene), words))
        fail_msg("'%s' is not in '%s'", words, impact_scene_message(scene));
}

static void what_cannot_be_is_refused_in_words_and_changes_nothing(void **state)
{
    (void)state;
    for (int begun = 0; begun < 2; begun++) {
        impact_scene *scene = two_balls((qvec3){0, 0, 1}, (qvec3){0.7, 0, 1}, 0.5, 0.5, IMPACT_PILES_AUTO),
                     *whole = two_balls((qvec3){0, 0, 1}, (qvec3){0.7, 0, 1}, 0.5, 0.5, IMPACT_PILES_AUTO);
        if (begun) assert_int_equal(impact_scene_run_to(scene, 0.3, NULL), IMPACT_OK);
        const impact_sample sample = state_of(scene, BALL);
        impact_sample wrong = sample;
        wrong.position.x += 0.2;
        refuses(scene, IMPACT_EDOMAIN, impact_scene_set_state(scene, BALL, &wrong),
                "body 'ball': there it overlaps 'other' by 0.1 m");
        wrong.position = (qvec3){5, 0, 0.1};
        refuses(scene, IMPACT_EDOMAIN, impact_scene_set_state(scene, BALL, &wrong), "'floor' by 0.2 m");
        wrong = sample;
        wrong.velocity.y = NAN;
        refuses(scene, IMPACT_EDOMAIN, impact_scene_set_state(scene, BALL, &wrong), "velocity");
        wrong.velocity.y = 1e160;
        refuses(scene, IMPACT_EARGUMENT, impact_scene_set_state(scene, BALL, &wrong), "energy");
        wrong = sample;
        wrong.position.z = NAN;
        refuses(scene, IMPACT_EDOMAIN, impact_scene_set_state(scene, BALL, &wrong), "position");
        wrong = sample;
        wrong.omega.x = -INFINITY;
        refuses(scene, IMPACT_EDOMAIN, impact_scene_set_state(scene, BALL, &wrong), "omega");
        wrong = sample;
        wrong.orientation = (quat){0, 0, 0, 0};
        refuses(scene, IMPACT_EARGUMENT, impact_scene_set_state(scene, BALL, &wrong), "orientation");
        refuses(scene, IMPACT_EARGUMENT, impact_scene_set_state(scene, FLOOR, &sample), "static");
        refuses(scene, IMPACT_EARGUMENT, impact_scene_set_state(scene, 3, &sample), "no body 3");
        refuses(scene, IMPACT_EARGUMENT, impact_scene_push(scene, -1, (qvec3){1, 0, 0}, (qvec3){0, 0, 0}),
                "no body -1");
        refuses(scene, IMPACT_EDOMAIN, impact_scene_push(scene, BALL, (qvec3){INFINITY, 0, 0}, (qvec3){0, 0, 0}),
                "impulse");
        refuses(scene, IMPACT_EDOMAIN, impact_scene_push(scene, BALL, (qvec3){1, 0, 0}, (qvec3){0, NAN, 0}), "point");
        refuses(scene, IMPACT_EARGUMENT, impact_scene_push(scene, FLOOR, (qvec3){1, 0, 0}, (qvec3){0, 0, 0}), "static");
        assert_int_equal(impact_scene_run(scene, NULL), impact_scene_run(whole, NULL));
        for (int i = BALL; i < BODIES; i++) {
            const impact_sample a = state_of(scene, i), b = state_of(whole, i);
            assert_memory_equal(&a.position, &b.position, sizeof a.position);
            assert_memory_equal(&a.omega, &b.omega, sizeof a.omega);
        }
        impact_scene_destroy(scene);
        impact_scene_destroy(whole);
    }
}

/* Over random scenes: pushes and leaps at random times leave the account right, and end as all runs do. */
static void the_account_books_every_change(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    enum { SCENES = 60, CHANGES = 4 };
    long changed = 0, refused = 0;
    for (unsigned long seed = 1; seed <= SCENES; seed++) {
        random_scene s;
        random_scene_make(seed, &s);
        random_stream random = {seed + 1000};
        s.def.duration = fmin(s.def.duration, 0.4);
        s.def.max_events = 500;
        impact_scene *scene = make_scene(&s.def);
        for (int k = 1; k <= CHANGES; k++) {
            const double t = k * s.def.duration / (CHANGES + 1);
            if (impact_scene_run_to(scene, t, NULL) < 0 || impact_scene_time(scene) > t) break;
            const int body = 1 + (int)((s.def.body_count - 1) * random_unit(&random));
            impact_sample sample = state_of(scene, body);
            const bool push = random_unit(&random) < 0.5;
            impact_status status;
            if (push) {
                status = impact_scene_push(scene, body, random_vector(&random, 0.01, 1), sample.position);
            } else {
                sample.position = qvec3_add(sample.position, random_vector(&random, 0.01, 1));
                sample.velocity = random_vector(&random, 0.1, 5);
                status = impact_scene_set_state(scene, body, &sample);
            }
            if (status == IMPACT_EDOMAIN && !push && strstr(impact_scene_message(scene), "overlaps")) {
                refused++;
                continue;
            }
            if (status < 0) fail_msg("seed %lu: %s", seed, impact_scene_message(scene));
            changed++;
            const impact_energy e = impact_scene_energy(scene);
            assert_account_holds(scene, 1e-9 * (fabs(e.start) + fabs(e.force_work) + e.kinetic + fabs(e.potential)));
        }
        assert_true(impact_scene_run(scene, NULL) >= 0);
        impact_scene_destroy(scene);
    }
    assert_true(changed > 2 * SCENES);
    assert_true(refused > 0);
}

/* What rests at a time stands there, and what is pushed then has its events after it. */
static void a_rest_takes_its_time(void **state)
{
    (void)state;
    static const double times[] = {0.5, 1, 2.75};
    impact_scene *scene = two_balls((qvec3){0, 0, radius}, (qvec3){9, 0, radius}, 1, 0, IMPACT_PILES_AUTO);
    impact_event event;
    for (int k = 0; k < 3; k++) {
        assert_int_equal(impact_scene_run_to(scene, times[k], NULL), IMPACT_AT_REST);
        assert_true(impact_scene_time(scene) == times[k]);
    }
    assert_int_equal(impact_scene_step(scene, 3, NULL, &event), IMPACT_AT_REST);
    assert_true(event.body1 < 0 && impact_scene_time(scene) == 2.75); /* to the next event, and there is none */
    assert_int_equal(impact_scene_run_to(scene, 3, NULL), IMPACT_AT_REST);
    assert_int_equal(impact_scene_push(scene, BALL, (qvec3){0, 0, mass_of_ball * gravity / 4}, (qvec3){0, 0, radius}),
                     IMPACT_OK);
    assert_int_equal(impact_scene_step(scene, 4, NULL, &event), IMPACT_AT_REST); /* it comes down, and stays */
    assert_int_equal(event.kind, IMPACT_EVENT_IMPACT);
    assert_near(event.t, 3.5, 1e-12);
    assert_true(impact_scene_time(scene) == event.t);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_AT_REST);
    assert_near(impact_scene_time(scene), 3.5, 1e-12);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_push_in_flight_turns_the_path),
        cmocka_unit_test(a_push_on_a_resting_ball_is_an_impact_or_a_slip),
        cmocka_unit_test(a_push_goes_on_through_what_touches),
        cmocka_unit_test(a_set_state_lets_go_and_takes_up),
        cmocka_unit_test(a_set_state_flies_on_from_there),
        cmocka_unit_test(what_cannot_be_is_refused_in_words_and_changes_nothing),
        cmocka_unit_test(the_account_books_every_change),
        cmocka_unit_test(a_rest_takes_its_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
