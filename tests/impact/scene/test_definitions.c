/* SPDX-License-Identifier: MIT
 *
 * Definitions of other versions: a struct that was shorter, one that is longer; whatever its length, the scene is the
 * one that a struct of this version gives. What a scene saves has a fingerprint of its definition in it.
 */
#include <impact/ode.h>
#include "kit/random_scene.h"
#include "kit/scene_log.h"

enum { SEEDS = 100 };

/* A copy of the first `bytes` of each struct, one after the other in memory of just that size, with its size in it;
 * what is beyond the struct is zero. */
static void *in_version(const void *structs, size_t count, size_t size, size_t bytes)
{
    char *copy = calloc(count, bytes);
    for (size_t i = 0; i < count; i++) {
        memcpy(copy + i * bytes, (const char *)structs + i * size, bytes < size ? bytes : size);
        memcpy(copy + i * bytes, &bytes, sizeof bytes);
    }
    return copy;
}

/* What this version's struct would be to say the same: the first `bytes`, else defaults. */
static void say_the_same(void *own, const void *given, const void *defaults, size_t size, size_t bytes)
{
    memcpy(own, defaults, size);
    memcpy(own, given, bytes < size ? bytes : size);
    memcpy(own, &size, sizeof size);
}

static size_t saved(const impact_scene *scene, void **bytes)
{
    size_t size = 0;
    impact_scene *s = (impact_scene *)scene;
    assert_int_equal(impact_scene_save(s, NULL, &size), IMPACT_OK);
    *bytes = malloc(size);
    assert_int_equal(impact_scene_save(s, *bytes, &size), IMPACT_OK);
    return size;
}

/* Both definitions are refused in the same words, or make scenes that save the same bytes. True: they were made. */
static bool assert_same(const impact_scene_def *a, const impact_scene_def *b)
{
    impact_scene *one, *two;
    char words[2][300];
    const impact_status first = impact_scene_create(a, &one, words[0], sizeof words[0]);
    assert_int_equal(impact_scene_create(b, &two, words[1], sizeof words[1]), first);
    assert_string_equal(words[0], words[1]);
    if (first != IMPACT_OK) return false;
    void *bytes[2];
    const size_t size = saved(one, &bytes[0]);
    assert_int_equal(saved(two, &bytes[1]), size);
    assert_memory_equal(bytes[0], bytes[1], size);
    free(bytes[0]), free(bytes[1]);
    impact_scene_destroy(one), impact_scene_destroy(two);
    return true;
}

/* What is not there at all is told, too. */
static void no_definition_is_refused(void **state)
{
    (void)state;
    impact_scene *scene;
    char words[300];
    assert_int_equal(impact_scene_create(NULL, &scene, words, sizeof words), IMPACT_EARGUMENT);
    assert_null(scene);
    assert_non_null(strstr(words, "NULL"));
    assert_int_equal(impact_scene_create(NULL, &scene, NULL, 0), IMPACT_EARGUMENT);
    impact_ode *ode;
    assert_int_equal(impact_ode_create(NULL, &ode), IMPACT_EARGUMENT);
    assert_null(ode);
}

/* An array that is not there, beside a count; and counts below 0. */
static void arrays_stand_beside_their_counts(void **state)
{
    (void)state;
    impact_scene *scene;
    char words[300];
    impact_body_def body = impact_default_body_def();
    body.name = "ball", body.mass = 1;
    assert_int_equal(impact_shape_sphere(1, &body.shape), IMPACT_OK);
    impact_scene_def good = impact_default_scene_def();
    good.bodies = &body, good.body_count = 1, good.duration = 1;
    assert_int_equal(impact_scene_create(&good, &scene, NULL, 0), IMPACT_OK);
    impact_scene_destroy(scene);
    impact_scene_def wrong[5] = {good, good, good, good, good};
    wrong[0].bodies = NULL;
    wrong[1].force_count = 2, wrong[2].pair_count = 3;
    wrong[3].force_count = -1, wrong[4].pair_count = -1;
    static const char *const said[5] = {"bodies is NULL", "forces is NULL", "pairs is NULL", "force_count = -1",
                                        "pair_count = -1"};
    for (int k = 0; k < 5; k++) {
        assert_int_equal(impact_scene_create(&wrong[k], &scene, words, sizeof words), IMPACT_EARGUMENT);
        assert_null(scene);
        assert_non_null(strstr(words, said[k]));
    }
}

static size_t random_bytes(random_stream *random, size_t least, size_t most)
{
    return least + sizeof(void *) * (size_t)(random_unit(random) * (double)((most - least) / sizeof(void *) + 1));
}

/* From the fields without which there is no scene up to some that no version has yet. */
static void any_length_is_read(void **state)
{
    (void)state;
    int made = 0;
    for (unsigned long long seed = 1; seed <= SEEDS; seed++) {
        random_stream random = {seed};
        random_scene s;
        random_scene_make(seed, &s);
        s.def.tolerance = 1e-9, s.def.max_events = 100, s.def.piles = IMPACT_PILES_STEPS;
        s.bodies[1].trail = (qvec3){0.1, 0, 0};
        const impact_pair_def given[2] = {{sizeof *given, "b1", "floor", 0.3, 0.2, 7, 0.01, NAN},
                                          impact_default_pair_def("b2", "b1")};
        const size_t body = random_bytes(&random, offsetof(impact_body_def, density), sizeof(impact_body_def) + 64);
        const size_t pair = random_bytes(&random, offsetof(impact_pair_def, friction), sizeof(impact_pair_def) + 64);
        const size_t whole =
            random_bytes(&random, offsetof(impact_scene_def, tolerance), sizeof(impact_scene_def) + 64);
        impact_body_def bodies[1 + RANDOM_SCENE_BODIES];
        const impact_body_def usual_body = impact_default_body_def();
        for (int i = 0; i < s.def.body_count; i++)
            say_the_same(&bodies[i], &s.bodies[i], &usual_body, sizeof *bodies, body);
        impact_pair_def pairs[2];
        const impact_pair_def usual_pair = impact_default_pair_def(NULL, NULL);
        for (int i = 0; i < 2; i++) say_the_same(&pairs[i], &given[i], &usual_pair, sizeof *pairs, pair);
        impact_scene_def own = {0};
        const impact_scene_def usual = impact_default_scene_def();
        s.def.pairs = given, s.def.pair_count = s.def.body_count > 2 ? 2 : 1;
        say_the_same(&own, &s.def, &usual, sizeof own, whole);
        own.bodies = bodies, own.pairs = pairs;
        void *other_bodies = in_version(s.bodies, (size_t)s.def.body_count, sizeof *s.bodies, body);
        void *other_pairs = in_version(given, 2, sizeof *given, pair);
        s.def.bodies = other_bodies, s.def.pairs = other_pairs;
        void *other = in_version(&s.def, 1, sizeof s.def, whole);
        made += assert_same(&own, other);
        free(other), free(other_bodies), free(other_pairs);
    }
    assert_true(made > SEEDS / 4);
}

static impact_body_def two[2];

static impact_scene_def small_scene(void)
{
    two[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 1);
    two[1] = ball_body("ball", (qvec3){0, 0, 1}, 0.5, 1);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = two;
    def.body_count = 2;
    return def;
}

static void forces_too(void **state)
{
    (void)state;
    impact_scene_def def = small_scene(), other = def;
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_WIND), own;
    const impact_force_def usual = force;
    force.strength = 3, force.drag = 0.5, force.falloff_power = 1;
    def.forces = &own, def.force_count = other.force_count = 1;
    int made = 0;
    for (size_t bytes = offsetof(impact_force_def, origin); bytes <= sizeof force + 64; bytes += sizeof(void *)) {
        say_the_same(&own, &force, &usual, sizeof own, bytes);
        void *copy = in_version(&force, 1, sizeof force, bytes);
        other.forces = copy;
        made += assert_same(&def, &other);
        free(copy);
    }
    assert_true(made > 10);
}

static void refuse(const impact_scene_def *def, const char *words)
{
    impact_scene *scene;
    char message[300];
    assert_int_equal(impact_scene_create(def, &scene, message, sizeof message), IMPACT_EARGUMENT);
    if (!strstr(message, words)) fail_msg("'%s' is not in '%s'", words, message);
    assert_null(scene);
    assert_int_equal(impact_scene_create(def, &scene, NULL, 0), IMPACT_EARGUMENT);
}

/* A field of a later version that is set asks for what this one cannot do: each byte of it counts. */
static void a_later_field_that_is_set_is_refused(void **state)
{
    (void)state;
    impact_scene_def def = small_scene();
    for (size_t at = 0; at < 16; at++) {
        char *later = in_version(&def, 1, sizeof def, sizeof def + 16);
        later[sizeof def + at] = 1;
        refuse((impact_scene_def *)later, "scene: struct_size");
        refuse((impact_scene_def *)later, "later version");
        free(later);
        later = in_version(two, 2, sizeof *two, sizeof *two + 16);
        later[2 * sizeof *two + 16 + at] = 1; /* of the second */
        def.bodies = (impact_body_def *)later;
        refuse(&def, "body 2: struct_size");
        def.bodies = two;
        free(later);
    }
}

static void what_is_no_size_is_refused(void **state)
{
    (void)state;
    static const size_t none[] = {0, 1, 7, sizeof(impact_scene_def) + 1, 4104, (size_t)-1, (size_t)-8};
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        impact_scene_def def = small_scene();
        def.struct_size = none[k];
        refuse(&def, "impact_default_scene_def");
        def = small_scene();
        two[0].struct_size = none[k];
        refuse(&def, "body 1: struct_size");
        def = small_scene();
        two[1].struct_size = none[k];
        refuse(&def, "body 2: struct_size");
        def = small_scene();
        impact_pair_def pair = impact_default_pair_def("floor", "ball");
        pair.struct_size = none[k];
        def.pairs = &pair, def.pair_count = 1;
        refuse(&def, "impact_default_pair_def");
        def = small_scene();
        impact_force_def force = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
        force.struct_size = none[k];
        def.forces = &force, def.force_count = 1;
        refuse(&def, "impact_default_force_def");
    }
    impact_scene_def def = small_scene();
    two[1].struct_size -= sizeof(void *);
    refuse(&def, "not the size of the first");
}

/* Defaults and answers fill what the caller has, and no byte more. */
static void defaults_and_answers_fill_any_length(void **state)
{
    (void)state;
    const impact_scene_def def = small_scene(), usual = impact_default_scene_def();
    impact_scene *scene;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
    impact_body_def own = impact_default_body_def();
    assert_int_equal(impact_scene_body_def(scene, 1, &own), IMPACT_OK);
    assert_string_equal(own.name, "ball");
    for (size_t bytes = sizeof(size_t); bytes <= sizeof usual + 64; bytes += sizeof(void *)) {
        impact_scene_def *some = malloc(bytes);
        impact_fill_scene_def(some, bytes);
        assert_int_equal(some->struct_size, bytes);
        const char *rest = (const char *)some + sizeof bytes, *wanted = (const char *)&usual + sizeof bytes;
        for (size_t i = 0; i + sizeof bytes < bytes; i++)
            assert_int_equal(rest[i], i + sizeof bytes < sizeof usual ? wanted[i] : 0);
        free(some);
    }
    for (size_t bytes = sizeof(size_t); bytes <= sizeof own + 64; bytes += sizeof(void *)) {
        impact_body_def *some = malloc(bytes);
        some->struct_size = bytes;
        assert_int_equal(impact_scene_body_def(scene, 1, some), IMPACT_OK);
        assert_int_equal(some->struct_size, bytes);
        const char *rest = (const char *)some + sizeof bytes, *wanted = (const char *)&own + sizeof bytes;
        for (size_t i = 0; i + sizeof bytes < bytes; i++)
            assert_int_equal(rest[i], i + sizeof bytes < sizeof own ? wanted[i] : 0);
        free(some);
    }
    own.struct_size = 0;
    assert_int_equal(impact_scene_body_def(scene, 1, &own), IMPACT_EARGUMENT);
    impact_scene_destroy(scene);
}

/* A body's definition comes back with all its numbers. */
static void a_definition_comes_back(void **state)
{
    (void)state;
    impact_scene_def def = small_scene();
    impact_body_def ball = impact_default_body_def();
    ball.name = "ball";
    impact_shape_ellipsoid(0.1, 0.2, 0.3, &ball.shape);
    ball.mass = 3, ball.moments = (qvec3){0.1, 0.11, 0.12};
    ball.position = (qvec3){1, 2, 3};
    ball.orientation = (quat){0.5, 0.5, -0.5, 0.5};
    ball.shape_position = (qvec3){0.01, 0.02, 0.03};
    ball.shape_orientation = (quat){0.6, 0, 0.8, 0};
    ball.velocity = (qvec3){4, 5, 6}, ball.omega = (qvec3){7, 8, 9};
    ball.friction = 0.3, ball.restitution = 0.6;
    ball.torsional_friction = 0.004, ball.rolling_friction = 0.002;
    ball.linear_damping = 0.25, ball.angular_damping = 0.5;
    ball.trail = (qvec3){0.1, 0, 0};
    ball.user = &def;
    def.bodies = &ball, def.body_count = 1;
    impact_scene *scene = make_scene(&def);
    impact_body_def back = impact_default_body_def();
    assert_int_equal(impact_scene_body_def(scene, -1, &back), IMPACT_EARGUMENT);
    assert_int_equal(impact_scene_body_def(scene, 1, &back), IMPACT_EARGUMENT);
    assert_int_equal(impact_scene_body_def(scene, 0, &back), IMPACT_OK);
    assert_string_equal(back.name, "ball");
    assert_near3(back.moments, ball.moments, 1e-15);
    assert_near3(back.position, ball.position, 1e-15);
    assert_near3(back.shape_position, ball.shape_position, 1e-15);
    assert_near3(back.velocity, ball.velocity, 1e-15);
    assert_near3(back.omega, ball.omega, 1e-13);
    assert_near3(back.trail, ball.trail, 0);
    assert_near(quat_norm(quat_sub(back.orientation, ball.orientation)), 0, 1e-15);
    assert_near(quat_norm(quat_sub(back.shape_orientation, ball.shape_orientation)), 0, 1e-15);
    const double got[] = {
        back.mass,           back.friction,        back.restitution, back.torsional_friction, back.rolling_friction,
        back.linear_damping, back.angular_damping, back.shape.b};
    const double wanted[] = {3, 0.3, 0.6, 0.004, 0.002, 0.25, 0.5, 0.2};
    for (size_t k = 0; k < sizeof got / sizeof *got; k++) assert_near(got[k], wanted[k], 1e-15);
    assert_ptr_equal(back.user, &def);

    impact_sample sample;
    for (int body = -1; body <= 1; body += 2) {
        assert_int_equal(impact_scene_body(scene, body, &sample), IMPACT_EARGUMENT);
        assert_null(impact_scene_force_name(scene, body));
    }
    for (int k = 0; k < 3; k++) {
        assert_int_equal(impact_scene_run_to(scene, (const double[]){NAN, INFINITY, -INFINITY}[k], NULL),
                         IMPACT_EDOMAIN);
        assert_non_null(strstr(impact_scene_message(scene), "is no time to run to"));
    }
    impact_scene_destroy(scene);
}

/* What is refused is refused without a place for words, too. */
static void words_may_be_unwanted(void **state)
{
    (void)state;
    impact_scene *scene;
    impact_scene_def def = small_scene();
    impact_body_def bodies[2] = {impact_default_body_def(), impact_default_body_def()};
    for (int i = 0; i < 2; i++) {
        bodies[i].name = i ? "b" : "a";
        impact_shape_sphere(1, &bodies[i].shape);
        bodies[i].position.x = i;
    }
    def.bodies = bodies, def.body_count = 2, def.name = NULL;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_EARGUMENT); /* they overlap */
    char message[200];
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "overlaps"));
    bodies[1].position.x = 3;
    const impact_allocator half = {.limit = 0, .allocate = NULL, .release = (void (*)(void *, size_t, void *))abort};
    def.allocator = &half;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_EARGUMENT);
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "scene '': its allocator has one function without the other");
    const impact_allocator small = {.limit = 64};
    def.allocator = &small;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_ENOMEM);
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_ENOMEM);
    assert_true(strlen(message) > 0);
}

/* Those that take a struct each and have no list. */
static void recorders_and_others(void **state)
{
    (void)state;
    const impact_scene_def def = small_scene();
    impact_scene *scene;
    scene_log log = {0};
    const impact_recorder all = log_recorder(&log);
    for (size_t bytes = offsetof(impact_recorder, progress); bytes <= sizeof all + 64; bytes += sizeof(void *)) {
        assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
        impact_recorder *some = in_version(&all, 1, sizeof all, bytes);
        log.event_count = 0;
        assert_int_equal(impact_scene_run(scene, some), IMPACT_OK);
        assert_true(log.event_count > 0);
        impact_scene_destroy(scene);
        free(some);
    }
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
    assert_int_equal(impact_scene_run(scene, &(impact_recorder){.sample = log_sample}), IMPACT_EARGUMENT);
    assert_non_null(strstr(impact_scene_message(scene), "recorder: struct_size = 0"));
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    impact_scene_destroy(scene);
    impact_csv *csv;
    char message[200];
    assert_int_equal(impact_csv_open_with(&(impact_csv_def){0}, &csv, message, sizeof message), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "CSV: struct_size = 0"));
    assert_int_equal(impact_report(&def, &(impact_report_def){0}, NULL, NULL, NULL, message, sizeof message),
                     IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "report: struct_size = 0"));
    impact_ode *ode;
    assert_int_equal(impact_ode_create(&(impact_ode_def){.size = 1}, &ode), IMPACT_EARGUMENT);
    free(log.samples), free(log.events), free(log.phases);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_length_is_read),
        cmocka_unit_test(no_definition_is_refused),
        cmocka_unit_test(arrays_stand_beside_their_counts),
        cmocka_unit_test(forces_too),
        cmocka_unit_test(a_later_field_that_is_set_is_refused),
        cmocka_unit_test(what_is_no_size_is_refused),
        cmocka_unit_test(defaults_and_answers_fill_any_length),
        cmocka_unit_test(a_definition_comes_back),
        cmocka_unit_test(words_may_be_unwanted),
        cmocka_unit_test(recorders_and_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
