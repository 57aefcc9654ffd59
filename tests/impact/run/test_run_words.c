/* SPDX-License-Identifier: MIT
 *
 * Records with one thing wrong in them: each byte of the head by letters that JSON has a meaning for, each word of the
 * tables by numbers at and beyond the ends, each length. Refused in words, or open and answering. And sinks that
 * refuse: whichever call it is, the run ends there with IMPACT_ESINK.
 */
#include <stdint.h>
#include <stdio.h>
#include <impact/impact.h>
#include "kit/scene_log.h"
#include "kit/seal.h"

/* ---- a record with all there is in it ---- */

static bool push(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 omega, qvec3 *force, qvec3 *torque,
                 void *context)
{
    (void)t, (void)body, (void)x, (void)q, (void)omega, (void)context;
    *force = qvec3_scale(v, -0.1 * mass), *torque = (qvec3){0, 0, 0};
    return true;
}

typedef struct fixture {
    impact_body_def bodies[4];
    impact_force_def force;
    impact_hull *hull;
    impact_scene_def def;
} fixture;

static impact_scene *make(fixture *f)
{
    const qvec3 corner[] = {{0.1, 0.1, 0.1}, {-0.1, -0.1, 0.1}, {-0.1, 0.1, -0.1}, {0.1, -0.1, -0.1}};
    assert_int_equal(impact_hull_create(corner, 4, 0.01, NULL, &f->hull, NULL, 0), IMPACT_OK);
    f->bodies[0] = plane_body("fl\"oor\n", (qvec3){0, 0, 0}, quat_identity(), 0.5, 0.5);
    f->bodies[0].velocity = (qvec3){0.1, 0, 0};
    f->bodies[1] = ball_body("ball", (qvec3){0, 0, 0.3}, 0.5, 0.5);
    f->bodies[1].velocity = (qvec3){1, 0, 0}, f->bodies[1].trail = (qvec3){0, 0, 0.1};
    f->bodies[2] = ball_body("egg", (qvec3){2, 0, 0.32}, 0.5, 0.5);
    impact_shape_ellipsoid(0.3, 0.25, 0.2, &f->bodies[2].shape);
    f->bodies[3] = ball_body("die", (qvec3){4, 0, 0.5}, 0.5, 0.5);
    impact_shape_polyhedron(f->hull, &f->bodies[3].shape);
    f->force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    f->force.function = push, f->force.body = "egg";
    f->def = impact_default_scene_def();
    f->def.bodies = f->bodies, f->def.body_count = 4;
    f->def.forces = &f->force, f->def.force_count = 1;
    f->def.duration = 0.3, f->def.tolerance = 1e-6, f->def.key_tolerance = 1e-3;
    return make_scene(&f->def);
}

static void end(fixture *f, impact_scene *scene)
{
    impact_scene_destroy(scene);
    impact_hull_destroy(f->hull);
}

static char *record(impact_scene *scene, size_t *size)
{
    impact_run_writer *writer;
    const void *bytes;
    assert_int_equal(impact_run_create(scene, &writer, NULL, 0), IMPACT_OK);
    const impact_recorder recorder = impact_run_recorder(writer);
    if (impact_scene_run(scene, &recorder) < 0) fail_msg("%s", impact_scene_message(scene));
    assert_int_equal(impact_run_bytes(writer, "end of time", &bytes, size), IMPACT_OK);
    char *copy = malloc(*size);
    memcpy(copy, bytes, *size);
    impact_run_discard(writer);
    return copy;
}

/* ---- what is open answers, and says no where there is nothing ---- */

static void ask_rows(const impact_run *run)
{
    impact_event event;
    impact_held held;
    impact_energy energy;
    double t;
    const long events = impact_run_event_count(run), contacts = impact_run_held_count(run),
               accounts = impact_run_account_count(run);
    for (long k = -1; k <= events; k++)
        assert_int_equal(impact_run_event(run, k, &event), k < 0 || k == events ? IMPACT_EARGUMENT : IMPACT_OK);
    for (long k = -1; k <= contacts; k++)
        assert_int_equal(impact_run_held(run, k, &held), k < 0 || k == contacts ? IMPACT_EARGUMENT : IMPACT_OK);
    for (long k = -1; k <= accounts; k++)
        assert_int_equal(impact_run_account(run, k, &t, &energy),
                         k < 0 || k == accounts ? IMPACT_EARGUMENT : IMPACT_OK);
}

static void ask_all(const impact_run *run)
{
    const int count = impact_run_body_count(run);
    const double begin = impact_run_begin(run), last = impact_run_end(run);
    for (int i = -1; i <= count; i++) {
        const impact_status wanted = i < 0 || i == count ? IMPACT_EARGUMENT : IMPACT_OK;
        impact_sample s;
        impact_key key;
        impact_body_def def = impact_default_body_def();
        assert_int_equal(impact_run_body(run, i, &def), wanted);
        assert_int_equal(impact_run_state(run, i, begin, &s), wanted);
        assert_int_equal(impact_run_state_before(run, i, last, &s), wanted);
        assert_int_equal(impact_run_state(run, i, last + 1, &s), IMPACT_EARGUMENT);
        const long keys = impact_run_key_count(run, i);
        assert_int_equal(impact_run_key(run, i, -1, &key), IMPACT_EARGUMENT);
        assert_int_equal(impact_run_key(run, i, keys, &key), IMPACT_EARGUMENT);
        def.struct_size = 0;
        assert_int_equal(impact_run_body(run, i, &def), IMPACT_EARGUMENT);
    }
    ask_rows(run);
}

typedef struct tally {
    long refused, open;
} tally;

static void try_bytes(const char *bytes, size_t size, tally *t)
{
    char message[300] = "";
    impact_run *run;
    const impact_status status = impact_run_read(bytes, size, "x.run", NULL, &run, message, sizeof message);
    if (status != IMPACT_OK) {
        assert_int_equal(status, IMPACT_EARGUMENT);
        assert_int_equal(impact_run_read(bytes, size, "x.run", NULL, &run, NULL, 0), status);
        assert_true(message[0] != '\0' && !run);
        t->refused++;
        return;
    }
    ask_all(run);
    impact_run_close(run);
    t->open++;
}

static void each_letter_of_the_head(void **state)
{
    (void)state;
    static const char letters[] = "\"\\{}[],:-+.eE0x9nu t\n\x01";
    fixture f;
    impact_scene *scene = make(&f);
    size_t size;
    char *bytes = record(scene, &size);
    const size_t head = (size_t)((char *)memchr(bytes, '\n', size) - bytes);
    tally t = {0};
    try_bytes(bytes, size, &t);
    assert_int_equal(t.open, 1);
    for (size_t place = 0; place <= head; place++) {
        const char was = bytes[place];
        for (size_t k = 0; letters[k]; k++) {
            bytes[place] = letters[k];
            seal(bytes, size);
            try_bytes(bytes, size, &t);
        }
        bytes[place] = was;
        seal(bytes, size);
        try_bytes(bytes, place, &t);
    }
    assert_true(t.refused > 10000 && t.open > 1000);
    free(bytes);
    end(&f, scene);
}

/* Values of the head by what they are not: null, a number, words, a list, an object; and escapes in words. */
static void each_value_of_the_head(void **state)
{
    (void)state;
    static const char *const others[] = {"null",
                                         "-1",
                                         "0.5",
                                         "1e400",
                                         "1e-3000",
                                         "true",
                                         "[]",
                                         "{}",
                                         "[1,2]",
                                         "\"\"",
                                         "\"a\\n\\t\\\"\\u0041\\/\\b\"",
                                         "\"\\u00e9\"",
                                         "\"\\q\"",
                                         "[[[[[[[[[[1]]]]]]]]]]"};
    fixture f;
    impact_scene *scene = make(&f);
    size_t size;
    char *bytes = record(scene, &size), *copy = malloc(size + 64);
    const size_t head = (size_t)((char *)memchr(bytes, '\n', size) - bytes);
    tally t = {0};
    for (size_t at = 1; at < head; at++) {
        if (bytes[at - 1] != ':' && bytes[at - 1] != '[' && bytes[at - 1] != ',') continue;
        size_t to = at;
        for (int depth = 0; to < head && !(depth == 0 && strchr(",]}", bytes[to])); to++)
            depth += (bytes[to] == '[' || bytes[to] == '{') - (bytes[to] == ']' || bytes[to] == '}');
        for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
            const size_t length = strlen(others[k]);
            memcpy(copy, bytes, at);
            memcpy(copy + at, others[k], length);
            memcpy(copy + at + length, bytes + to, size - to);
            seal(copy, at + length + size - to);
            try_bytes(copy, at + length + size - to, &t);
        }
    }
    assert_true(t.refused > 1000 && t.open > 10);
    free(copy), free(bytes);
    end(&f, scene);
}

static void each_word_of_the_tables(void **state)
{
    (void)state;
    const double numbers[] = {0, 1, -1, 0.05, 0.5, 2, 1e9, 1e300, NAN, INFINITY};
    fixture f;
    impact_scene *scene = make(&f);
    size_t size;
    char *bytes = record(scene, &size);
    const size_t data = (size_t)((char *)memchr(bytes, '\n', size) - bytes) + 1;
    const size_t stride = 8 * (1 + (size - data) / 8 / 3000);
    tally t = {0};
    for (size_t place = data; place + 8 + SEAL <= size; place += stride) {
        char was[8];
        memcpy(was, bytes + place, 8);
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
            memcpy(bytes + place, &numbers[k], 8);
            seal(bytes, size);
            try_bytes(bytes, size, &t);
        }
        memcpy(bytes + place, was, 8);
    }
    assert_true(t.refused > 100 && t.open > 100);
    free(bytes);
    end(&f, scene);
}

/* ---- sinks ---- */

static long calls, refuse_at;

static bool count(void) { return ++calls != refuse_at; }
static bool on_sample(void *context, const impact_sample *s) { return (void)context, (void)s, count(); }
static bool on_event(void *context, const impact_event *e) { return (void)context, (void)e, count(); }
static bool on_key(void *context, const impact_key *k) { return (void)context, (void)k, count(); }
static bool on_held(void *context, const impact_held *h) { return (void)context, (void)h, count(); }
static bool on_account(void *context, double t, const impact_energy *e)
{
    return (void)context, (void)t, (void)e, count();
}

static impact_status run_refused(const impact_recorder *recorder, long at)
{
    fixture f;
    impact_scene *scene = make(&f);
    calls = 0, refuse_at = at;
    const impact_status status = impact_scene_run(scene, recorder);
    if (status < 0) assert_true(impact_scene_message(scene)[0] != '\0');
    end(&f, scene);
    return status;
}

/* Every choice of functions; each of the first calls, the last ones, and some between. */
static void whichever_call_is_refused(void **state)
{
    (void)state;
    for (int which = 1; which < 32; which++) {
        const impact_recorder recorder = {.struct_size = sizeof recorder,
                                          .sample = which & 1 ? on_sample : NULL,
                                          .event = which & 2 ? on_event : NULL,
                                          .key = which & 4 ? on_key : NULL,
                                          .held = which & 8 ? on_held : NULL,
                                          .account = which & 16 ? on_account : NULL};
        assert_true(run_refused(&recorder, 0) >= 0);
        const long all = calls;
        const bool alone = (which & (which - 1)) == 0;
        assert_true(all > 0);
        for (long at = 1; at <= all; at += at < 12 || all - at < 12 ? 1 : 1 + all / (alone ? 40 : 8)) {
            assert_int_equal(run_refused(&recorder, at), IMPACT_ESINK);
            assert_true(calls >= at); /* the end of a record is offered all the same */
        }
    }
}

/* However few bytes are left, of CSV too: the row that has no room ends the run. */
static void whichever_byte_is_refused(void **state)
{
    (void)state;
    long whole = 0, ended = 0;
    for (unsigned long long bytes = 0; whole < 3; bytes += bytes < 1500 ? 7 : 1777) {
        fixture f;
        impact_scene *scene = make(&f);
        impact_quota quota = {.left = bytes};
        const impact_csv_def def = {.struct_size = sizeof def,
                                    .samples_path = "test_run_words.csv",
                                    .events_path = "test_run_words_events.csv",
                                    .quota = &quota};
        impact_csv *csv;
        char message[300];
        if (impact_csv_open_with(&def, &csv, message, sizeof message) == IMPACT_OK) {
            const impact_recorder recorder = impact_csv_recorder(csv);
            const impact_status status = impact_scene_run(scene, &recorder);
            assert_true(status >= 0 || (status == IMPACT_ESINK && quota.spent));
            whole += status >= 0, ended += status < 0;
        } else {
            assert_true(quota.spent && message[0] != '\0');
        }
        impact_csv_close(csv, IMPACT_CSV_DROP, NULL, 0);
        end(&f, scene);
    }
    assert_true(ended > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_letter_of_the_head),   cmocka_unit_test(each_value_of_the_head),
        cmocka_unit_test(each_word_of_the_tables),   cmocka_unit_test(whichever_call_is_refused),
        cmocka_unit_test(whichever_byte_is_refused),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
