/* SPDX-License-Identifier: MIT
 *
 * Thinned records are records: they open, and their states at any time are those of the record they were made of, to
 * the tolerance; times and events are the same to the bit; jumps stay jumps.
 */
#include "../../../view/plain.h"
#include "../../../view/thin.h"
#include "kit/scene_log.h"
#include <impact/impact.h>

#include <string.h>

static double uniform(unsigned long long *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

static impact_run *record(const impact_scene_def *def)
{
    char message[200];
    impact_run_writer *writer;
    impact_run *run;
    const void *bytes;
    size_t size;
    impact_scene *scene = make_scene(def);
    assert_int_equal(impact_run_create(scene, &writer, message, sizeof message), IMPACT_OK);
    const impact_recorder recorder = impact_run_recorder(writer);
    if (impact_scene_run(scene, &recorder) < 0) fail_msg("%s", impact_scene_message(scene));
    assert_int_equal(impact_run_bytes(writer, "end of time", &bytes, &size), IMPACT_OK);
    assert_int_equal(impact_run_read(bytes, size, "test", NULL, &run, message, sizeof message), IMPACT_OK);
    impact_run_discard(writer);
    impact_scene_destroy(scene);
    return run;
}

static impact_run *thinned(const impact_run *run, double tolerance)
{
    char message[200];
    imp_arena *arena;
    impact_run *thin;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    imp_text text = {.arena = arena};
    assert_int_equal(imp_thin(&text, run, tolerance), IMPACT_OK);
    if (impact_run_read(text.bytes, text.size, "thin", NULL, &thin, message, sizeof message) < 0)
        fail_msg("%s", message);
    imp_arena_destroy(arena);
    return thin;
}

/* A brick that tumbles down on a floor, which it meets at its corners, beside a ball that bounces far from the origin.
 */
static impact_scene_def busy(impact_body_def *bodies)
{
    for (int i = 0; i < 3; i++) bodies[i] = impact_default_body_def();
    bodies[0].name = "floor <b>";
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    bodies[0].is_static = true;
    bodies[0].friction = bodies[0].restitution = 0.5;
    bodies[1].name = "brick";
    impact_shape_superquadric(0.3, 0.2, 0.1, 4, 4, 4, &bodies[1].shape);
    bodies[1].position = (qvec3){0, 0, 1};
    bodies[1].omega = (qvec3){3, 7, -2};
    bodies[1].restitution = 1;
    bodies[2].name = "ball";
    impact_shape_sphere(0.05, &bodies[2].shape);
    bodies[2].position = (qvec3){900, 0, 2};
    bodies[2].velocity = (qvec3){1, 0, 0};
    bodies[2].omega = (qvec3){0, 0, 40};
    bodies[2].restitution = 1;
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 3;
    def.duration = 2;
    return def;
}

static void test_states_stay_within_the_tolerance(void **state)
{
    (void)state;
    const double tolerances[] = {1e-2, 1e-3, 1e-5, 1e-7}, sizes[] = {0, 0.3742, 0.05};
    impact_body_def bodies[3];
    const impact_scene_def def = busy(bodies);
    impact_run *run = record(&def);
    long before = 0;
    for (size_t k = 0; k < sizeof tolerances / sizeof *tolerances; k++) {
        impact_run *thin = thinned(run, tolerances[k]);
        unsigned long long seed = 5 + k;
        long keys = 0;
        for (int b = 1; b < 3; b++) {
            keys += impact_run_key_count(thin, b);
            for (int i = 0; i < 10000; i++) {
                impact_sample s, w;
                const double t = impact_run_end(run) * uniform(&seed);
                assert_int_equal(impact_run_state(run, b, t, &w), IMPACT_OK);
                assert_int_equal(impact_run_state(thin, b, t, &s), IMPACT_OK);
                assert_true(qvec3_norm(qvec3_sub(s.position, w.position)) <= tolerances[k] * sizes[b]);
                assert_true(2 * quat_norm(quat_sub(s.orientation, w.orientation)) <= tolerances[k]);
            }
        }
        assert_true(keys > before && keys < impact_run_key_count(run, 1) + impact_run_key_count(run, 2));
        before = keys;
        impact_run_close(thin);
    }
    impact_run_close(run);
}

/* For readers without elliptic functions: no key is a free flight, and states are the same to the record's tolerance.
 */
static void test_a_plain_record_has_no_free_flights(void **state)
{
    (void)state;
    impact_body_def bodies[3];
    const impact_scene_def def = busy(bodies);
    impact_run *run = record(&def), *read, plain;
    imp_arena *arena;
    char message[200];
    bool changed;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    assert_int_equal(imp_plain(arena, run, &plain, &changed), IMPACT_OK);
    assert_true(changed);
    imp_text text = {.arena = arena};
    assert_int_equal(imp_thin(&text, &plain, 0), IMPACT_OK);
    assert_int_equal(impact_run_read(text.bytes, text.size, "plain", NULL, &read, message, sizeof message), IMPACT_OK);
    unsigned long long seed = 7;
    for (int b = 0; b < 3; b++) {
        for (long k = 0; k < impact_run_key_count(read, b); k++) {
            impact_key key;
            assert_int_equal(impact_run_key(read, b, k, &key), IMPACT_OK);
            assert_true(key.form != IMPACT_KEY_FREE);
        }
        for (int i = 0; i < 10000; i++) {
            impact_sample s, w;
            const double t = impact_run_end(run) * uniform(&seed);
            assert_int_equal(impact_run_state(run, b, t, &w), IMPACT_OK);
            assert_int_equal(impact_run_state(read, b, t, &s), IMPACT_OK);
            assert_true(qvec3_norm(qvec3_sub(s.position, w.position)) <= 2e-10);
            assert_true(2 * quat_norm(quat_sub(s.orientation, w.orientation)) <= 2e-10);
        }
    }
    imp_arena_destroy(arena);
    impact_run_close(read);
    impact_run_close(run);
}

static void test_events_and_times_are_the_same(void **state)
{
    (void)state;
    impact_body_def bodies[3];
    const impact_scene_def def = busy(bodies);
    impact_run *run = record(&def), *thin = thinned(run, 1e-5);
    const long events = impact_run_event_count(run);
    assert_true(impact_run_begin(thin) == impact_run_begin(run) && impact_run_end(thin) == impact_run_end(run));
    assert_int_equal(impact_run_event_count(thin), events);
    assert_int_equal(impact_run_account_count(thin), impact_run_account_count(run));
    assert_string_equal(impact_run_name(thin), impact_run_name(run));
    int jumps = 0;
    for (long k = 0; k < events; k++) {
        impact_event a, b;
        impact_sample before, after, was;
        impact_run_event(run, k, &a);
        impact_run_event(thin, k, &b);
        assert_true(a.t == b.t && a.kind == b.kind && a.body1 == b.body1 && a.body2 == b.body2);
        assert_memory_equal(&a.impulse, &b.impulse, sizeof a.impulse);
        assert_string_equal(a.name2, b.name2);
        assert_string_equal(a.phases, b.phases);
        if (a.kind != IMPACT_EVENT_IMPACT || qvec3_norm(a.impulse) < 1) continue;
        jumps++;
        impact_run_state_before(thin, a.body1, a.t, &before);
        impact_run_state(thin, a.body1, a.t, &after);
        impact_run_state_before(run, a.body1, a.t, &was);
        assert_near(qvec3_norm(qvec3_sub(before.velocity, was.velocity)), 0, 1e-5);
        impact_body_def def_of = impact_default_body_def();
        impact_run_body(run, a.body1, &def_of);
        const qvec3 change = qvec3_scale(qvec3_sub(after.velocity, before.velocity), def_of.mass);
        assert_near(qvec3_norm(qvec3_sub(change, a.impulse)), 0, 1e-5 * def_of.mass);
    }
    assert_true(jumps > 3);
    impact_run_close(thin);
    impact_run_close(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_states_stay_within_the_tolerance),
        cmocka_unit_test(test_a_plain_record_has_no_free_flights),
        cmocka_unit_test(test_events_and_times_are_the_same),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
