/* SPDX-License-Identifier: MIT
 *
 * Whatever allocation is refused, a scene answers IMPACT_ENOMEM, or the same rows as with all of them; nothing is left
 * over, and nothing is taken beside the caller's allocator. Refused are: each piece that a scene asks for, alone and
 * with all after it; and, by limits of every size up to what the scene takes, the blocks it cuts from them.
 */
#include <stdio.h>
#include <string.h>
#include <impact/impact.h>
#include "kit/ledger.h"

/* ---- the scenes ---- */

typedef struct family {
    impact_body_def bodies[7];
    impact_force_def force;
    impact_scene_def def;
} family;

static void begin(family *f, double duration)
{
    f->def = impact_default_scene_def();
    f->def.bodies = f->bodies;
    f->def.duration = duration;
    f->bodies[0] = impact_default_body_def();
    f->bodies[0].name = "floor";
    f->bodies[0].is_static = true;
    f->bodies[0].friction = f->bodies[0].restitution = 1;
    impact_shape_plane(INFINITY, INFINITY, &f->bodies[0].shape);
    f->def.body_count = 1;
}

static impact_body_def *add(family *f, const char *name, double x, double z)
{
    impact_body_def *body = &f->bodies[f->def.body_count++];
    *body = impact_default_body_def();
    body->name = name;
    body->position = (qvec3){x, 0, z};
    body->friction = 0.4;
    body->restitution = 0.5;
    impact_shape_sphere(0.2, &body->shape);
    return body;
}

static bool breeze(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 omega, qvec3 *force, qvec3 *torque,
                   void *context)
{
    (void)t, (void)body, (void)x, (void)q, (void)omega, (void)context;
    *force = qvec3_scale((qvec3){1 - v.x, 0, 0}, 0.1 * mass);
    *torque = (qvec3){0, 0, 0};
    return true;
}

static void spheres(family *f)
{
    begin(f, 1.0);
    add(f, "a", 0, 0.6)->velocity = (qvec3){1, 0, 0};
    add(f, "b", 0.8, 0.5)->omega = (qvec3){0, 3, 1};
}

static void superquadrics_with_forces(family *f)
{
    begin(f, 0.4);
    f->force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    f->force.name = "breeze";
    f->force.function = breeze;
    f->def.forces = &f->force;
    f->def.force_count = 1;
    for (int i = 0; i < 2; i++) {
        impact_body_def *body = add(f, i ? "b" : "a", 0.8 * i, 0.5);
        impact_shape_superquadric(0.3, 0.2, 0.25, 2, 3, 2.5, &body->shape);
        body->omega = (qvec3){1, 2, 0.5};
    }
}

static void held_contacts(family *f)
{
    begin(f, 0.5);
    impact_body_def *body = add(f, "egg", 0, 0.1);
    impact_shape_ellipsoid(0.2, 0.15, 0.1, &body->shape);
    body->restitution = 0;
    body->velocity = (qvec3){0.3, 0, 0};
    body->omega = (qvec3){0, 0, 5};
    body = add(f, "ball", 1, 0.2);
    body->restitution = 0;
    body->velocity = (qvec3){-0.5, 0.1, 0};
}

static void springs(family *f)
{
    begin(f, 0.5);
    f->def.law = IMPACT_STRONGE;
    f->def.compliance = 1.2;
    add(f, "a", 0, 0.3)->omega = (qvec3){0, 30, 0};
}

static void crowd(family *f)
{
    static const char *const names[] = {"a", "b", "c", "d", "e", "f"};
    begin(f, 0.3);
    for (int i = 0; i < 6; i++)
        add(f, names[i], 0.6 * i, 0.3 + 0.05 * (i % 3))->velocity = (qvec3){i % 2 ? -1 : 1, 0, 0};
}

static void crowd_that_slides(family *f)
{
    crowd(f);
    f->def.duration = 0.01;
    for (int i = 1; i < f->def.body_count; i++) f->bodies[i].position.z = 0.2, f->bodies[i].restitution = 0;
}

/* They land on each other at many points, slide by steps and come to rest. */
static void boxes(family *f)
{
    begin(f, 0.3);
    for (int i = 0; i < 2; i++) {
        impact_body_def *body = add(f, i ? "upper" : "lower", 0.05 * i, 0.11 + 0.21 * i);
        impact_shape_box(0.2 - 0.05 * i, 0.2, 0.1, 0, &body->shape);
        body->velocity = (qvec3){0.3 * i, 0, 0};
        body->restitution = 0.1;
    }
}

/* ---- a run, and a number that stands for all its rows ---- */

static uint64_t hash;

static void mix(const void *data, size_t size) /* FNV-1a */
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) hash = (hash ^ bytes[i]) * 1099511628211u;
}

static bool take_sample(void *context, const impact_sample *s)
{
    (void)context;
    const double numbers[] = {s->t,
                              s->position.x,
                              s->position.y,
                              s->position.z,
                              s->orientation.w,
                              s->orientation.x,
                              s->orientation.y,
                              s->orientation.z,
                              s->velocity.x,
                              s->velocity.y,
                              s->velocity.z,
                              s->omega.x,
                              s->omega.y,
                              s->omega.z};
    mix(numbers, sizeof numbers);
    return true;
}

static bool take_event(void *context, const impact_event *e)
{
    (void)context;
    const double numbers[] = {e->t, e->impulse_normal, e->impulse_tangential, e->energy_before, e->energy_after};
    mix(numbers, sizeof numbers);
    return true;
}

static impact_status run(const impact_scene_def *def, char *message, impact_memory *memory)
{
    const impact_recorder recorder = {.struct_size = sizeof recorder, .sample = take_sample, .event = take_event};
    impact_scene *scene;
    hash = 14695981039346656037u;
    message[0] = '\0';
    impact_status status = impact_scene_create(def, &scene, message, 300);
    if (status != IMPACT_OK) return assert_null(scene), status;
    status = impact_scene_run(scene, &recorder);
    if (status < 0) snprintf(message, 300, "%s", impact_scene_message(scene));
    *memory = impact_scene_memory(scene);
    impact_scene_destroy(scene);
    return status;
}

/* ---- the tests ---- */

typedef struct tally {
    int refused, whole;
} tally;

static void run_refused(family *f, const ledger *refusal, size_t limit, uint64_t wanted, tally *count)
{
    char message[300];
    ledger l = *refusal;
    impact_memory memory = {0};
    const impact_allocator allocator = ledger_allocator(&l, limit);
    f->def.allocator = &allocator;
    const impact_status status = run(&f->def, message, &memory);
    assert_int_equal(l.live, 0);
    assert_true(limit == 0 || l.most <= limit);
    if (status == IMPACT_ENOMEM) {
        count->refused++;
        if (!strstr(message, "memory")) fail_msg("%s", message);
        return;
    }
    if (status < 0) fail_msg("status %d: %s", status, message);
    assert_true(hash == wanted);
    count->whole++;
}

static void every_refusal_is_answered(void **state)
{
    static void (*const scenes[])(family *) = {spheres, superquadrics_with_forces, held_contacts, springs,
                                               crowd,   crowd_that_slides,         boxes};
    enum { LIMITS = 60 };
    (void)state;
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        family f;
        char message[300];
        tally count = {0};
        ledger l = {0};
        impact_memory memory;
        const impact_allocator allocator = ledger_allocator(&l, 0);
        scenes[k](&f);
        f.def.allocator = &allocator;
        const impact_status status = run(&f.def, message, &memory);
        if (status < 0) fail_msg("scene %zu: %s", k, message);
        assert_int_equal(l.live, 0);
        assert_int_equal(memory.held, l.most);
        assert_int_equal(memory.pieces, l.calls);
        const uint64_t wanted = hash;
        for (int all_after = 0; all_after < 2; all_after++)
            for (long fail_at = 1; fail_at <= l.calls; fail_at++)
                run_refused(&f, &(ledger){.fail_at = fail_at, .all_after = all_after}, 0, wanted, &count);
        for (size_t i = 1; i <= LIMITS; i++) run_refused(&f, &(ledger){0}, i * l.most / LIMITS, wanted, &count);
        assert_true(count.refused > l.calls && count.whole > 0);
    }
}

/* Without an allocator, by malloc: the same rows. */
static void malloc_serves_as_well(void **state)
{
    (void)state;
    family f;
    char message[300];
    ledger l = {0};
    impact_memory memory;
    const impact_allocator allocator = ledger_allocator(&l, 0);
    held_contacts(&f);
    assert_true(run(&f.def, message, &memory) >= 0);
    const uint64_t wanted = hash;
    f.def.allocator = &allocator;
    assert_true(run(&f.def, message, &memory) >= 0);
    assert_true(hash == wanted);
    const impact_allocator half = {.allocate = ledger_allocate};
    f.def.allocator = &half;
    assert_int_equal(run(&f.def, message, &memory), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "one function without the other"));
}

static void workspaces_too(void **state)
{
    (void)state;
    for (long fail_at = 1; fail_at < 12; fail_at++) {
        ledger l = {.fail_at = fail_at};
        impact_collide_workspace *workspace = NULL;
        const impact_allocator allocator = ledger_allocator(&l, 0);
        const impact_status status =
            impact_collide_workspace_create_with(&allocator, IMPACT_ODE_BDF, 1e-12, &workspace);
        assert_true(status == IMPACT_OK || (status == IMPACT_ENOMEM && !workspace));
        if (workspace) assert_int_equal(impact_collide_workspace_memory(workspace).held, l.held);
        impact_collide_workspace_destroy(workspace);
        assert_int_equal(l.live, 0);
    }
}

/* "././ ... test_memory.csv": a name that takes more than a first piece, and more than all before it together. */
static void lengthen(char longer[4000], const char *name)
{
    enum { DOTS = 3700 };
    for (int i = 0; i < DOTS; i += 2) memcpy(longer + i, "./", 2);
    strcpy(longer + DOTS, name);
}

/* However little it may hold, a sink opens whole or not at all, says so, and leaves no file. */
static void sinks_too(void **state)
{
    (void)state;
    char longer[4000], message[5000];
    lengthen(longer, "test_memory.csv");
    int opened = 0, refused = 0;
    for (size_t limit = 1024; limit < 1u << 19; limit += limit < 1u << 14 ? 512 : 1u << 14) {
        ledger l = {0};
        const impact_allocator allocator = ledger_allocator(&l, limit);
        const impact_csv_def def = {.struct_size = sizeof def, .samples_path = longer, .allocator = &allocator};
        impact_csv *csv = NULL;
        const impact_status status = impact_csv_open_with(&def, &csv, message, sizeof message);
        opened += status == IMPACT_OK, refused += status < 0;
        assert_true(status == IMPACT_OK || ((status == IMPACT_ENOMEM || status == IMPACT_ESINK) && !csv));
        if (status == IMPACT_ESINK) assert_non_null(strstr(message, "memory"));
        impact_csv_close(csv, IMPACT_CSV_DROP, NULL, 0);
        assert_true(l.live == 0 && l.most <= limit);
        FILE *left = fopen(longer, "r");
        assert_null(left);
    }
    assert_true(opened > 3 && refused > 3);
}

/* Whichever piece alone is refused: a sink that opens all the same lacks nothing for its rows to be kept as partial. */
static void what_a_sink_lacks_is_told_when_it_opens(void **state)
{
    (void)state;
    char longer[4000], partial[4000], message[5000];
    lengthen(longer, "test_memory.csv");
    lengthen(partial, "test_memory.partial.csv");
    int opened = 0, refused = 0;
    for (long fail_at = 1; fail_at < 12; fail_at++) {
        ledger l = {.fail_at = fail_at};
        const impact_allocator allocator = ledger_allocator(&l, 0);
        const impact_csv_def def = {.struct_size = sizeof def, .samples_path = longer, .allocator = &allocator};
        impact_csv *csv = NULL;
        const impact_status status = impact_csv_open_with(&def, &csv, message, sizeof message);
        opened += status == IMPACT_OK, refused += status < 0;
        if (csv) {
            impact_recorder recorder = {.struct_size = sizeof recorder};
            const impact_sample sample = {.name = "ball"};
            impact_csv_fill_recorder(csv, &recorder, sizeof recorder);
            assert_true(recorder.sample(recorder.context, &sample));
            assert_int_equal(impact_csv_close(csv, IMPACT_CSV_PARTIAL, message, sizeof message), IMPACT_OK);
            assert_int_equal(remove(partial), 0);
        }
        assert_int_equal(l.live, 0);
    }
    assert_true(opened > 1 && refused > 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_refusal_is_answered),
        cmocka_unit_test(malloc_serves_as_well),
        cmocka_unit_test(workspaces_too),
        cmocka_unit_test(sinks_too),
        cmocka_unit_test(what_a_sink_lacks_is_told_when_it_opens),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
