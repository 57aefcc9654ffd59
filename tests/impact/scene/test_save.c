/* SPDX-License-Identifier: MIT
 *
 * Saved and loaded is going on, bit for bit; what is not this scene's state is refused in words and changes nothing.
 */
#include "kit/random_scene.h"
#include "kit/same_bits.h"
#include "kit/scene_log.h"

#include <stdlib.h>

typedef struct saved_bytes {
    unsigned char *bytes;
    size_t size;
} saved_bytes;

static saved_bytes save(impact_scene *scene)
{
    saved_bytes s = {0};
    if (impact_scene_save(scene, NULL, &s.size) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
    s.bytes = malloc(s.size);
    const size_t wanted = s.size;
    if (impact_scene_save(scene, s.bytes, &s.size) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
    assert_int_equal(s.size, wanted);
    return s;
}

static void load(impact_scene *scene, saved_bytes s)
{
    if (impact_scene_load(scene, s.bytes, s.size) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
}

static void assert_same_events(const scene_log *a, const scene_log *b)
{
    assert_int_equal(a->event_count, b->event_count);
    for (int k = 0; k < a->event_count; k++) {
        assert_true(a->events[k].t == b->events[k].t);
        assert_int_equal(a->events[k].kind, b->events[k].kind);
        assert_memory_equal(&a->events[k].impulse, &b->events[k].impulse, sizeof(qvec3));
    }
}

/* Random scenes, saved at a random time into another that has run elsewhere: same events, states and books to the end.
 */
static void saved_and_loaded_is_going_on(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    enum { SCENES = 36 };
    int saved_count = 0, islands = 0;
    for (unsigned long seed = 1; seed <= SCENES; seed++) {
        random_scene s;
        random_scene_make(seed, &s);
        random_stream random = {seed + 7000};
        s.def.duration = fmin(s.def.duration, 0.25);
        s.def.gravity.z = -40; /* so that they land by then */
        s.def.max_events = 300;
        if (seed % 5 == 0) s.def.piles = IMPACT_PILES_STEPS;
        impact_scene *a = make_scene(&s.def), *b = make_scene(&s.def);
        const double t = s.def.duration * random_unit(&random);
        if (seed % 3 == 0) assert_true(impact_scene_run_to(b, s.def.duration * random_unit(&random), NULL) >= 0);
        if (seed % 7 != 0 && impact_scene_run_to(a, t, NULL) == IMPACT_EVENT_LIMIT) {
            impact_scene_destroy(a); /* it may stand amid an instant */
            impact_scene_destroy(b);
            continue;
        }
        const saved_bytes bytes = save(a);
        load(b, bytes);
        if (!same_scene(a, b)) fail_msg("seed %lu: not the same after the load", seed);
        const saved_bytes again = save(b);
        assert_int_equal(again.size, bytes.size);
        islands += impact_scene_usage(a).integrator_steps + impact_scene_usage(a).pile_steps > 0;
        load(a, again);
        scene_log log_a = {0}, log_b = {0};
        const impact_recorder rows_a = log_recorder(&log_a), rows_b = log_recorder(&log_b);
        assert_int_equal(impact_scene_run(a, &rows_a), impact_scene_run(b, &rows_b));
        assert_same_events(&log_a, &log_b);
        if (!same_scene(a, b)) fail_msg("seed %lu: not the same in the end", seed);
        const impact_usage x = impact_scene_usage(a), y = impact_scene_usage(b);
        assert_memory_equal(&x, &y, sizeof x);
        saved_count++;
        free_log(&log_a);
        free_log(&log_b);
        free(bytes.bytes);
        free(again.bytes);
        impact_scene_destroy(a);
        impact_scene_destroy(b);
    }
    assert_true(saved_count > 0.9 * SCENES);
    assert_true(islands > SCENES / 4);
}

/* Rolling, sliding, lying, resting, in a pile: saved amid each of these. */
static void held_contacts_go_on_after_a_load(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    for (int piles = IMPACT_PILES_AUTO; piles <= IMPACT_PILES_STEPS; piles++) {
        impact_body_def bodies[6] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0.5),
                                     ball_body("rolls", (qvec3){0, 0, 0.3}, 0.2, 0.5),
                                     ball_body("slides", (qvec3){0, 2, 0.3}, 0.05, 0.5),
                                     ball_body("low", (qvec3){0, 4, 0.3}, 0.5, 0.5),
                                     ball_body("high", (qvec3){0.05, 4, 0.9}, 0.5, 0.5),
                                     ball_body("egg", (qvec3){0, 6, 0.21}, 0.5, 0.1)};
        bodies[1].velocity = bodies[2].velocity = (qvec3){2, 0, 0};
        impact_shape_ellipsoid(0.4, 0.3, 0.2, &bodies[5].shape);
        impact_scene_def def = impact_default_scene_def();
        def.gravity = (qvec3){0, 0, -9.81};
        def.bodies = bodies;
        def.body_count = 6;
        def.duration = 1;
        def.piles = (impact_piles)piles;
        for (int k = 0; k < 8; k++) {
            impact_scene *a = make_scene(&def), *b = make_scene(&def);
            assert_true(impact_scene_run_to(a, 0.11 * k, NULL) >= 0);
            if (k > 0) assert_true(impact_scene_held(a, NULL, 0) >= 3);
            const saved_bytes bytes = save(a);
            load(b, bytes);
            assert_true(same_scene(a, b));
            assert_int_equal(impact_scene_run(a, NULL), impact_scene_run(b, NULL));
            assert_true(same_scene(a, b));
            free(bytes.bytes);
            impact_scene_destroy(a);
            impact_scene_destroy(b);
        }
    }
}

/* Bounces and flights alone: a save changes no bit of them. */
static void what_flies_and_bounces_does_not_notice_a_save(void **state)
{
    (void)state;
    enum { BALLS = 5, SAVES = 40 };
    impact_body_def bodies[1 + BALLS] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 1)};
    static const char *const names[BALLS] = {"a", "b", "c", "d", "e"};
    for (int i = 0; i < BALLS; i++) {
        bodies[1 + i] = ball_body(names[i], (qvec3){0.61 * i, 0, 1 + 0.1 * i * i}, 0.3, 0.99);
        bodies[1 + i].omega = (qvec3){i, 1, 2};
        bodies[1 + i].linear_damping = i == 2 ? 0.1 : 0;
    }
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -9.81};
    def.bodies = bodies;
    def.body_count = 1 + BALLS;
    def.duration = 6;
    impact_scene *whole = make_scene(&def), *saved = make_scene(&def);
    assert_true(impact_scene_run(whole, NULL) >= 0);
    for (int k = 0; k < SAVES; k++) {
        assert_true(impact_scene_run_to(saved, k * def.duration / SAVES, NULL) >= 0);
        free(save(saved).bytes);
    }
    assert_true(impact_scene_run(saved, NULL) >= 0);
    assert_true(impact_scene_usage(saved).events[IMPACT_EVENT_IMPACT] > 20);
    for (int i = 1; i <= BALLS; i++) assert_true(same_body(whole, i, saved, i));
    impact_scene_destroy(whole);
    impact_scene_destroy(saved);
}

/* Saved twice, the bytes of the second are those of the first. */
static void a_save_is_a_function_of_what_was_saved(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    for (unsigned long seed = 1; seed <= 30; seed++) {
        random_scene s;
        random_scene_make(seed, &s);
        s.def.max_events = 300;
        impact_scene *scene = make_scene(&s.def), *other = make_scene(&s.def);
        assert_true(impact_scene_run_to(scene, 0.3 * s.def.duration, NULL) >= 0);
        const saved_bytes first = save(scene);
        load(other, first);
        load(scene, first);
        const saved_bytes second = save(scene), third = save(other);
        assert_int_equal(second.size, third.size);
        assert_memory_equal(second.bytes, third.bytes, third.size);
        free(first.bytes), free(second.bytes), free(third.bytes);
        impact_scene_destroy(scene);
        impact_scene_destroy(other);
    }
}

/* ---- refusals ---- */

static void refuses(impact_scene *scene, const void *bytes, size_t size, const char *words)
{
    assert_int_equal(impact_scene_load(scene, bytes, size), IMPACT_EARGUMENT);
    if (!strstr(impact_scene_message(scene), words))
        fail_msg("'%s' is not in '%s'", words, impact_scene_message(scene));
}

static void every_changed_byte_and_every_part_is_refused(void **state)
{
    (void)state;
    random_scene s;
    random_scene_make(6, &s);
    impact_scene *scene = make_scene(&s.def), *other = make_scene(&s.def);
    assert_true(impact_scene_run_to(scene, 0.5 * s.def.duration, NULL) >= 0);
    const saved_bytes saved = save(scene);
    random_stream random = {99};
    for (size_t k = 0; k < saved.size; k++) {
        const unsigned char kept = saved.bytes[k];
        saved.bytes[k] ^= (unsigned char)(1 + 254 * random_unit(&random));
        refuses(other, saved.bytes, saved.size, "cannot go on from these bytes");
        saved.bytes[k] = kept;
    }
    for (size_t size = 0; size < saved.size; size += 1 + size / 50) refuses(other, saved.bytes, size, "bytes");
    assert_true(impact_scene_time(other) == 0);
    load(other, saved);
    assert_true(same_scene(scene, other));
    free(saved.bytes);
    impact_scene_destroy(scene);
    impact_scene_destroy(other);
}

static void another_scene_is_refused(void **state)
{
    (void)state;
    random_scene s;
    random_scene_make(6, &s);
    impact_scene *scene = make_scene(&s.def);
    const saved_bytes saved = save(scene);
    s.def.name = "other";
    impact_scene *other = make_scene(&s.def);
    refuses(other, saved.bytes, saved.size, "they are scene 'scene' with");
    impact_scene_destroy(other);
    s.def.name = "scene";
    s.bodies[1].restitution = 0.123;
    other = make_scene(&s.def);
    refuses(other, saved.bytes, saved.size, "its definition was another one");
    impact_scene_destroy(other);
    free(saved.bytes);
    impact_scene_destroy(scene);
}

static bool stop(void *context, double t, double t_end)
{
    (void)t, (void)t_end;
    return --*(int *)context > 0;
}

static void what_cannot_be_saved_says_why(void **state)
{
    (void)state;
    impact_body_def bodies[3] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 1),
                                 ball_body("a", (qvec3){0, 0, 1}, 0.3, 0.5),
                                 ball_body("b", (qvec3){2, 0, 1}, 0.3, 0.5)};
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -9.81};
    def.bodies = bodies;
    def.body_count = 3;
    def.duration = 1;
    impact_scene *scene = make_scene(&def);
    unsigned char few[10];
    size_t size = sizeof few;
    assert_int_equal(impact_scene_save(scene, few, &size), IMPACT_EARGUMENT);
    assert_true(size > sizeof few);
    assert_string_equal(impact_scene_message(scene), "scene 'scene' cannot be saved: there is not so much room");
    /* both balls end their slip at one time: stopped between them */
    for (int i = 1; i < 3; i++) {
        bodies[i].position = (qvec3){2.0 * i, 0, 0.3};
        bodies[i].velocity = (qvec3){0, 1, 0};
    }
    impact_scene_destroy(scene);
    scene = make_scene(&def);
    impact_event event = {.kind = IMPACT_EVENT_IMPACT};
    while (event.kind != IMPACT_EVENT_STICK) assert_int_equal(impact_scene_step(scene, 1, NULL, &event), IMPACT_OK);
    bool refused = false;
    for (int calls = 1; calls < 4000 && !refused; calls++) {
        impact_scene *stopped = make_scene(&def);
        int left = calls;
        const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &left, .progress = stop};
        impact_scene_run_to(stopped, event.t, &recorder);
        if (impact_scene_time(stopped) == event.t && impact_scene_save(stopped, NULL, &size) != IMPACT_OK) {
            refused = strstr(impact_scene_message(stopped), "stopped amid an instant") != NULL;
            assert_int_equal(impact_scene_run_to(stopped, event.t, NULL), IMPACT_OK);
            assert_int_equal(impact_scene_save(stopped, NULL, &size), IMPACT_OK);
        }
        impact_scene_destroy(stopped);
    }
    assert_true(refused);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(saved_and_loaded_is_going_on),
        cmocka_unit_test(held_contacts_go_on_after_a_load),
        cmocka_unit_test(what_flies_and_bounces_does_not_notice_a_save),
        cmocka_unit_test(a_save_is_a_function_of_what_was_saved),
        cmocka_unit_test(every_changed_byte_and_every_part_is_refused),
        cmocka_unit_test(another_scene_is_refused),
        cmocka_unit_test(what_cannot_be_saved_says_why),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
