/* SPDX-License-Identifier: MIT
 *
 * A scene event by event, and what is held between: the same bits as in one run, and forces that balance.
 */
#include "kit/random_scene.h"
#include "kit/scene_log.h"

enum { SCENES = 60, MOST_STEPS = 4000, MOST_HELD = 32 };

static const double gravity = 9.81;

static impact_scene_def scene_of(const impact_body_def *bodies, int count, double duration)
{
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.bodies = bodies;
    def.body_count = count;
    def.duration = duration;
    return def;
}

static impact_scene *ball_over_floor(double height, double friction, double restitution)
{
    static impact_body_def bodies[2];
    bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1);
    bodies[1] = ball_body("ball", (qvec3){0, 0, height}, friction, restitution);
    const impact_scene_def def = scene_of(bodies, 2, 5);
    return make_scene(&def);
}

static void a_step_ends_with_the_next_event(void **state)
{
    (void)state;
    impact_scene *scene = ball_over_floor(1.3, 0.5, 0.5);
    impact_event event;
    const double fall = sqrt(2 / gravity);
    assert_int_equal(impact_scene_step(scene, 0.1, NULL, &event), IMPACT_OK);
    assert_int_equal(event.body1, -1);
    assert_true(impact_scene_time(scene) == 0.1);
    assert_int_equal(impact_scene_step(scene, 5, NULL, &event), IMPACT_OK);
    assert_int_equal(event.kind, IMPACT_EVENT_IMPACT);
    assert_near(event.t, fall, 1e-14);
    assert_true(impact_scene_time(scene) == event.t);
    assert_near(event.normal_after, 0.5 * sqrt(2 * gravity), 1e-13);
    assert_string_equal(event.name1, "ball");
    assert_true(strlen(event.phases) > 0);
    assert_near(event.energy_before, 4 * gravity * 1.3, 1e-12);
    assert_int_equal(impact_scene_step(scene, 5, NULL, NULL), IMPACT_OK);
    assert_near(impact_scene_time(scene), 2 * fall, 1e-14);
    assert_int_equal(impact_scene_step(scene, 0.2, NULL, &event), IMPACT_EARGUMENT);
    assert_int_equal(event.body1, -1);
    impact_scene_destroy(scene);
}

static bool is_finished(impact_status status) { return status != IMPACT_OK && status != IMPACT_SOFT; }

static void assert_same_rows(const scene_log *a, const scene_log *b)
{
    assert_int_equal(a->event_count, b->event_count);
    assert_int_equal(a->sample_count, b->sample_count);
    for (int k = 0; k < a->event_count; k++) {
        assert_true(a->events[k].t == b->events[k].t);
        assert_memory_equal(&a->events[k].impulse, &b->events[k].impulse, sizeof a->events[k].impulse);
        assert_string_equal(a->phases[k], b->phases[k]);
    }
    for (int k = 0; k < a->sample_count; k++) {
        assert_true(a->samples[k].t == b->samples[k].t);
        assert_memory_equal(&a->samples[k].position, &b->samples[k].position, sizeof(qvec3));
        assert_memory_equal(&a->samples[k].orientation, &b->samples[k].orientation, sizeof(quat));
    }
}

/* The contacts held now, asked on the way, change nothing; the answer does not depend on how often it is asked. */
static void ask_twice(const impact_scene *scene)
{
    impact_held once[MOST_HELD], twice[MOST_HELD];
    const int count = impact_scene_held(scene, once, MOST_HELD);
    assert_in_range(count, 0, MOST_HELD);
    assert_int_equal(impact_scene_held(scene, NULL, 0), count);
    assert_int_equal(impact_scene_held(scene, twice, MOST_HELD), count);
    for (int k = 0; k < count; k++) {
        assert_memory_equal(&once[k].force, &twice[k].force, sizeof(qvec3));
        assert_true(once[k].t == impact_scene_time(scene));
        assert_near(qvec3_norm(once[k].normal), 1, 1e-14);
    }
}

static void stepped_and_asked_is_the_run_in_one(void **state)
{
    (void)state;
    long events = 0;
    for (unsigned long seed = 1; seed <= SCENES; seed++) {
        random_scene s;
        random_scene_make(seed, &s);
        s.def.duration = fmin(s.def.duration, 0.5);
        s.def.output_rate = 40;
        s.def.max_events = 200;
        scene_log whole = {0}, parts = {0};
        const impact_recorder whole_rows = log_recorder(&whole), part_rows = log_recorder(&parts);
        impact_scene *a = make_scene(&s.def), *b = make_scene(&s.def);
        const impact_status ended = impact_scene_run(a, &whole_rows);
        impact_status status = IMPACT_OK;
        for (int k = 0; k < MOST_STEPS && !is_finished(status) && impact_scene_time(b) < s.def.duration; k++) {
            impact_event event;
            const int before = parts.event_count;
            status = impact_scene_step(b, s.def.duration, &part_rows, &event);
            assert_int_equal(event.body1 >= 0, parts.event_count > before);
            if (event.body1 >= 0) assert_true(event.t == parts.events[before].t);
            ask_twice(b);
        }
        assert_int_equal(status, ended);
        assert_same_rows(&whole, &parts);
        events += whole.event_count;
        free_log(&whole);
        free_log(&parts);
        impact_scene_destroy(a);
        impact_scene_destroy(b);
    }
    assert_true(events > SCENES);
}

static void held_forces_balance_the_weight(void **state)
{
    (void)state;
    impact_scene *scene = ball_over_floor(0.3, 0.5, 0);
    impact_held held;
    assert_int_equal(impact_scene_held(scene, &held, 1), 0);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_AT_REST);
    assert_int_equal(impact_scene_held(scene, &held, 1), 1);
    assert_int_equal(held.mode, IMPACT_HOLD_STICK);
    assert_int_equal(held.body1, 1);
    assert_int_equal(held.body2, 0);
    assert_near3(held.force, ((qvec3){0, 0, 4 * gravity}), 1e-12);
    assert_near3(held.normal, ((qvec3){0, 0, 1}), 0);
    assert_near3(held.point, ((qvec3){0, 0, 0}), 1e-15);
    impact_scene_destroy(scene);
}

/* Down a slope of 45 degrees, friction 0.1: it slides at mu m gravity cos(a) against its slip, as long as it slips. */
static void held_forces_of_sliding_lie_on_the_cone(void **state)
{
    (void)state;
    const double c = sqrt(0.5);
    const quat turn = {cos(0.125 * acos(-1)), 0, sin(0.125 * acos(-1)), 0};
    impact_body_def bodies[2] = {plane_body("slope", (qvec3){0, 0, 0}, turn, 1, 0),
                                 ball_body("ball", (qvec3){0.3 * c, 0, 0.3 * c}, 0.1, 0)};
    const impact_scene_def def = scene_of(bodies, 2, 1);
    impact_scene *scene = make_scene(&def);
    impact_held held;
    assert_int_equal(impact_scene_run_to(scene, 0.37, NULL), IMPACT_OK);
    assert_int_equal(impact_scene_held(scene, &held, 1), 1);
    assert_int_equal(held.mode, IMPACT_HOLD_SLIP);
    assert_near(qvec3_dot(held.force, held.normal), 4 * gravity * c, 1e-10);
    assert_near3(qvec3_axpy(-4 * gravity * c, held.normal, held.force),
                 qvec3_scale((qvec3){-c, 0, c}, 0.4 * gravity * c), 1e-9);
    impact_scene_destroy(scene);
}

/* Of a pile at rest all forces on each body and its weight are nothing, whether it was moved by steps or not. */
static void held_forces_of_a_pile_balance_each_body(void **state)
{
    (void)state;
    for (int piles = IMPACT_PILES_AUTO; piles <= IMPACT_PILES_STEPS; piles++) {
        impact_body_def bodies[3] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1),
                                     ball_body("low", (qvec3){0, 0, 0.3}, 0.5, 0),
                                     ball_body("high", (qvec3){0, 0, 0.9}, 0.5, 0)};
        impact_scene_def def = scene_of(bodies, 3, 1);
        def.piles = (impact_piles)piles;
        impact_scene *scene = make_scene(&def);
        impact_held held[4];
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_AT_REST);
        const int count = impact_scene_held(scene, held, 4);
        assert_int_equal(count, 2);
        qvec3 sum[3] = {{0, 0, 0}, {0, 0, -4 * gravity}, {0, 0, -4 * gravity}};
        for (int k = 0; k < count; k++) {
            sum[held[k].body1] = qvec3_add(sum[held[k].body1], held[k].force);
            sum[held[k].body2] = qvec3_sub(sum[held[k].body2], held[k].force);
        }
        for (int i = 1; i < 3; i++) assert_near3(sum[i], ((qvec3){0, 0, 0}), 1e-9);
        impact_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_ends_with_the_next_event),
        cmocka_unit_test(stepped_and_asked_is_the_run_in_one),
        cmocka_unit_test(held_forces_balance_the_weight),
        cmocka_unit_test(held_forces_of_sliding_lie_on_the_cone),
        cmocka_unit_test(held_forces_of_a_pile_balance_each_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
