/* SPDX-License-Identifier: MIT
 *
 * Rows of what moves, beside the rows of all bodies: the same, without those that repeat the body's row before.
 */
#include <stdlib.h>
#include <string.h>
#include <impact/scene.h>
#include "kit/contact_random.h"
#include "kit/near.h"

enum { BALLS = 6, BODIES = BALLS + 1, ROWS = 20000, RATE = 50 };

static const double duration = 3;

typedef struct table {
    impact_sample rows[ROWS];
    int count;
} table;

static bool keep(void *context, const impact_sample *sample)
{
    table *t = context;
    assert_true(t->count < ROWS);
    t->rows[t->count++] = *sample;
    return true;
}

/* Balls that are dropped beside each other and come to rest; a late one flies in and strikes one of them. */
static impact_scene *make_scene(int seed, impact_samples samples)
{
    static const char *const names[BODIES] = {"a", "b", "c", "d", "e", "f", "floor"};
    random_stream random = {(unsigned)seed};
    impact_body_def bodies[BODIES];
    for (int i = 0; i < BODIES; i++) {
        bodies[i] = impact_default_body_def();
        bodies[i].name = names[i];
        bodies[i].restitution = i < BALLS ? 0.3 * random_unit(&random) : 1;
        bodies[i].position = (qvec3){i, 0, 0.1 + 0.3 * random_unit(&random)};
        assert_int_equal(impact_shape_sphere(0.1, &bodies[i].shape), IMPACT_OK);
    }
    bodies[0].position = (qvec3){-9, 0, 30};
    bodies[0].velocity = (qvec3){4, 0, 0};
    bodies[BALLS].is_static = true;
    bodies[BALLS].position = (qvec3){0, 0, 0};
    assert_int_equal(impact_shape_plane(INFINITY, INFINITY, &bodies[BALLS].shape), IMPACT_OK);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = BODIES;
    def.duration = duration;
    def.output_rate = RATE;
    def.samples = samples;
    impact_scene *scene;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
    return scene;
}

/* The scene goes on in another. */
static impact_scene *reloaded(impact_scene *scene, int seed, impact_samples samples)
{
    size_t size = 0;
    impact_scene_save(scene, NULL, &size);
    void *bytes = malloc(size);
    assert_non_null(bytes);
    assert_int_equal(impact_scene_save(scene, bytes, &size), IMPACT_OK);
    impact_scene_destroy(scene);
    scene = make_scene(seed, samples);
    assert_int_equal(impact_scene_load(scene, bytes, size), IMPACT_OK);
    free(bytes);
    return scene;
}

/* In one run, or in parts that end anywhere, saved and loaded between them. */
static void fill(table *t, int seed, impact_samples samples, int parts)
{
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = t, .sample = keep};
    impact_scene *scene = make_scene(seed, samples);
    t->count = 0;
    for (int k = 1; k <= parts; k++) {
        assert_true(impact_scene_run_to(scene, duration * k / parts, &recorder) >= 0);
        if (k < parts) scene = reloaded(scene, seed, samples);
    }
    impact_scene_destroy(scene);
}

static bool same_state(const impact_sample *a, const impact_sample *b)
{
    return memcmp(&a->position, &b->position, sizeof a->position) == 0 &&
           memcmp(&a->orientation, &b->orientation, sizeof a->orientation) == 0 &&
           memcmp(&a->velocity, &b->velocity, sizeof a->velocity) == 0 &&
           memcmp(&a->omega, &b->omega, sizeof a->omega) == 0;
}

static bool same_row(const impact_sample *a, const impact_sample *b)
{
    return a->t == b->t && a->body == b->body && same_state(a, b);
}

static const impact_sample *row_before(const table *t, int end, int body)
{
    for (int i = end - 1; i >= 0; i--)
        if (t->rows[i].body == body) return &t->rows[i];
    return NULL;
}

static void what_is_left_out_is_the_row_before(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    table *all = calloc(1, sizeof *all), *moving = calloc(1, sizeof *moving);
    assert_true(all && moving);
    for (int seed = 1; seed <= 20; seed++) {
        fill(all, seed, IMPACT_SAMPLES_ALL, 1);
        fill(moving, seed, IMPACT_SAMPLES_MOVING, 1);
        int kept = 0;
        for (int i = 0; i < all->count; i++) {
            if (kept < moving->count && same_row(&all->rows[i], &moving->rows[kept])) {
                kept++;
                continue;
            }
            const impact_sample *before = row_before(moving, kept, all->rows[i].body);
            assert_true(before && same_state(before, &all->rows[i]));
            assert_true(all->rows[i].t < duration);
        }
        assert_int_equal(kept, moving->count);
        assert_true(all->count - moving->count > 4 * RATE);
    }
    free(all), free(moving);
}

static void parts_write_what_the_whole_does(void **state)
{
    (void)state;
    table *whole = calloc(1, sizeof *whole), *parts = calloc(1, sizeof *parts);
    assert_true(whole && parts);
    fill(whole, 5, IMPACT_SAMPLES_MOVING, 1);
    fill(parts, 5, IMPACT_SAMPLES_MOVING, 7);
    assert_int_equal(parts->count, whole->count);
    for (int i = 0; i < whole->count; i++) {
        assert_int_equal(parts->rows[i].body, whole->rows[i].body);
        assert_near(parts->rows[i].t, whole->rows[i].t, 1e-6); /* what an integrator moves departs anew */
    }
    free(whole), free(parts);
}

static void an_unknown_choice_is_refused(void **state)
{
    (void)state;
    impact_body_def body = impact_default_body_def();
    impact_scene_def def = impact_default_scene_def();
    impact_scene *scene;
    char message[200];
    body.name = "a";
    assert_int_equal(impact_shape_sphere(1, &body.shape), IMPACT_OK);
    def.bodies = &body;
    def.body_count = 1;
    def.samples = (impact_samples)2;
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "scene 'scene': samples = 2: are neither all nor those that move");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_left_out_is_the_row_before),
                                       cmocka_unit_test(parts_write_what_the_whole_does),
                                       cmocka_unit_test(an_unknown_choice_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
