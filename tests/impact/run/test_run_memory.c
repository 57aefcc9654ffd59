/* SPDX-License-Identifier: MIT
 *
 * Recorded runs, written, read and exported, take all their memory from the caller's allocator: whatever is refused
 * ends with IMPACT_ENOMEM and a message or with the same bytes, and everything comes back.
 */
#include <impact/impact.h>

#include <stdio.h>
#include "kit/allocations.h"
#include "kit/ledger.h"
#include "kit/scene_log.h"

static const char record_path[] = "test_run_memory.run", page_path[] = "test_run_memory.html",
                  gltf_path[] = "test_run_memory.glb";

typedef struct outcome {
    impact_status status; /* of the first call that fails */
    char message[300];
    unsigned char bytes[1 << 16]; /* the record that was read */
    size_t size;
} outcome;

/* Whether the call went well; the first that did not is kept. */
static bool good(outcome *o, impact_status status)
{
    if (o->status >= 0) o->status = status;
    return status >= 0;
}

/* A sphere and a tetrahedron fall on a floor. */
static impact_scene_def fall(impact_body_def bodies[3], const impact_hull *hull)
{
    bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 0.5, 1);
    bodies[1] = ball_body("ball", (qvec3){0, 0, 0.7}, 0.5, 0.9);
    bodies[2] = ball_body("dice", (qvec3){4, 0, 1.2}, 0.5, 0.9);
    bodies[2].omega = (qvec3){1, 2, 3};
    impact_shape_polyhedron(hull, &bodies[2].shape);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 3;
    def.duration = 0.4;
    return def;
}

/* Everything that can be done with an open record. */
static void export_run(outcome *o, const impact_run *run)
{
    const void *bytes = impact_run_contents(run, &o->size);
    assert_true(o->size <= sizeof o->bytes);
    memcpy(o->bytes, bytes, o->size);
    if (!impact_has(IMPACT_PART_VIEW)) return;
    if (!good(o, impact_view_write(run, 1e-5, page_path, NULL, o->message, sizeof o->message))) return;
    good(o, impact_gltf_write(run, 1e-2, 24, gltf_path, NULL, o->message, sizeof o->message));
}

static void write_run(outcome *o, impact_scene *scene, impact_run_writer *writer)
{
    const impact_recorder recorder = impact_run_recorder(writer);
    const impact_status ran = impact_scene_run(scene, &recorder);
    if (ran < 0) snprintf(o->message, sizeof o->message, "%s", impact_scene_message(scene));
    if (ran == IMPACT_ESINK) /* the writer had no room for a row */
        o->status = IMPACT_ENOMEM, snprintf(o->message, sizeof o->message, "memory");
    else if (good(o, ran))
        good(o, impact_run_save(writer, "end of time", record_path, NULL, o->message, sizeof o->message));
}

static void write_and_read(outcome *o, const impact_allocator *allocator, const impact_hull *hull)
{
    impact_body_def bodies[3];
    impact_scene_def def = fall(bodies, hull);
    impact_scene *scene;
    impact_run_writer *writer;
    impact_run *run;
    *o = (outcome){.status = IMPACT_OK};
    def.allocator = allocator;
    if (!good(o, impact_scene_create(&def, &scene, o->message, sizeof o->message))) return;
    if (good(o, impact_run_create(scene, &writer, o->message, sizeof o->message))) {
        write_run(o, scene, writer);
        impact_run_discard(writer);
    }
    impact_scene_destroy(scene);
    if (o->status < 0) return;
    const impact_status opened = impact_run_open(record_path, allocator, &run, o->message, sizeof o->message);
    if (good(o, opened)) {
        export_run(o, run);
        impact_run_close(run);
    } else {
        assert_null(run);
    }
}

typedef struct tally {
    int refused, whole;
} tally;

static void try_refused(const ledger *refusal, size_t limit, const impact_hull *hull, const outcome *wanted, tally *t)
{
    static outcome got;
    ledger l = *refusal;
    const impact_allocator allocator = ledger_allocator(&l, limit);
    write_and_read(&got, &allocator, hull);
    assert_int_equal(l.live, 0);
    if (got.status == IMPACT_ENOMEM) {
        t->refused++;
        if (!strstr(got.message, "memory")) fail_msg("says '%s'", got.message);
        return;
    }
    if (got.status < 0) fail_msg("status %d: %s", got.status, got.message);
    assert_int_equal(got.size, wanted->size);
    assert_memory_equal(got.bytes, wanted->bytes, wanted->size);
    t->whole++;
}

static void test_every_refusal_is_answered(void **state)
{
    enum { LIMITS = 60 };
    static outcome whole;
    (void)state;
    const qvec3 corner[4] = {{0.3, 0.3, 0.3}, {-0.3, -0.3, 0.3}, {-0.3, 0.3, -0.3}, {0.3, -0.3, -0.3}};
    impact_hull *hull;
    assert_int_equal(impact_hull_create(corner, 4, 0.01, NULL, &hull, NULL, 0), IMPACT_OK);
    ledger l = {0};
    const impact_allocator allocator = ledger_allocator(&l, 0);
    const long before = allocations;
    write_and_read(&whole, &allocator, hull);
    if (whole.status < 0) fail_msg("%s", whole.message);
    assert_int_equal(allocations - before, l.calls); /* nothing beside it */
    assert_int_equal(l.live, 0);
    tally t = {0};
    for (int all_after = 0; all_after < 2; all_after++)
        for (long at = 1; at <= l.calls; at++)
            try_refused(&(ledger){.fail_at = at, .all_after = all_after}, 0, hull, &whole, &t);
    for (size_t i = 1; i <= LIMITS; i++) try_refused(&(ledger){0}, i * l.most / LIMITS, hull, &whole, &t);
    assert_true(t.refused > l.calls && t.whole > 0);
    assert_int_equal(remove(record_path), 0);
    if (impact_has(IMPACT_PART_VIEW)) assert_true(remove(page_path) == 0 && remove(gltf_path) == 0);
    impact_hull_destroy(hull);
}

/* A hull that came with a record outlives it where it is shared. */
static void test_a_shared_hull_stays(void **state)
{
    (void)state;
    static outcome whole;
    const qvec3 corner[4] = {{0.3, 0.3, 0.3}, {-0.3, -0.3, 0.3}, {-0.3, 0.3, -0.3}, {0.3, -0.3, -0.3}};
    impact_hull *hull, *kept;
    impact_run *run;
    char message[200];
    ledger l = {0};
    const impact_allocator allocator = ledger_allocator(&l, 0);
    assert_int_equal(impact_hull_create(corner, 4, 0.01, NULL, &hull, NULL, 0), IMPACT_OK);
    write_and_read(&whole, &allocator, hull);
    assert_int_equal(impact_run_read(whole.bytes, whole.size, "bytes", &allocator, &run, message, sizeof message), 0);
    impact_body_def dice = impact_default_body_def();
    assert_int_equal(impact_run_body(run, 2, &dice), IMPACT_OK);
    kept = impact_hull_share(dice.shape.hull);
    impact_run_close(run);
    assert_int_equal(l.live, 1);
    for (int i = 0; i < 4; i++)
        assert_true(qvec3_norm(qvec3_sub(impact_hull_vertex(kept, i), impact_hull_vertex(hull, i))) == 0);
    impact_hull_destroy(kept);
    assert_int_equal(l.live, 0);
    impact_hull_destroy(hull);
    remove(record_path), remove(page_path), remove(gltf_path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_refusal_is_answered),
        cmocka_unit_test(test_a_shared_hull_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
