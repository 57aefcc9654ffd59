/* SPDX-License-Identifier: MIT
 *
 * Each block that a scene cuts from its arena is refused in turn, alone and with all after it: the scene is not made,
 * or its run, push, save, load and record end with IMPACT_ENOMEM and a message; nothing is left over. (test_memory.c
 * refuses the pieces that blocks are cut from: of those there are few.)
 */
#include <stdio.h>
#include <string.h>
#include <impact/impact.h>
#include "kit/blocks.h"
#include "kit/ledger.h"
#include "kit/scene_log.h"

/* ---- the scenes ---- */

typedef struct family {
    impact_body_def bodies[8];
    impact_force_def forces[2];
    impact_pair_def pair;
    impact_scene_def def;
    double switches[2];
} family;

static void begin(family *f, double duration)
{
    *f = (family){.def = impact_default_scene_def()};
    f->bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.6, 0.5);
    f->def.bodies = f->bodies;
    f->def.body_count = 1;
    f->def.duration = duration;
    f->def.output_rate = 200;
    f->def.tolerance = 1e-6;
}

static impact_body_def *add(family *f, const char *name, double x, double z)
{
    impact_body_def *body = &f->bodies[f->def.body_count++];
    *body = ball_body(name, (qvec3){x, 0, z}, 0.6, 0.5);
    impact_shape_sphere(0.1, &body->shape);
    return body;
}

static bool breeze(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 omega, qvec3 *force, qvec3 *torque,
                   void *context)
{
    (void)body, (void)x, (void)q, (void)omega, (void)context;
    *force = qvec3_scale((qvec3){sin(3 * t) - v.x, 0, 0}, 0.1 * mass);
    *torque = (qvec3){0, 0, 0};
    return true;
}

/* Two that attract each other and are blown at, over a belt; one that rolls. */
static void forces(family *f)
{
    begin(f, 0.01);
    f->bodies[0].velocity = (qvec3){0.5, 0, 0};
    add(f, "a", 0, 0.1)->restitution = 0;
    impact_body_def *egg = add(f, "egg", 0.5, 0.13);
    impact_shape_superquadric(0.1, 0.08, 0.12, 3, 2, 2.5, &egg->shape);
    add(f, "wheel", 2, 0.1)->velocity = (qvec3){1, 0, 0};
    f->forces[0] = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    f->forces[0].constant = 1e-3;
    f->forces[1] = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    f->forces[1].name = "breeze";
    f->forces[1].function = breeze;
    f->switches[0] = 0.003, f->switches[1] = 0.006;
    f->forces[1].switches = f->switches;
    f->forces[1].switch_count = 2;
    f->def.forces = f->forces;
    f->def.force_count = 2;
    f->pair = impact_default_pair_def("a", "egg");
    f->pair.restitution = 0.2;
    f->def.pairs = &f->pair;
    f->def.pair_count = 1;
}

/* A box dropped on a box that lies: struck at many points, then by steps. */
static void pile(family *f)
{
    begin(f, 0.06);
    for (int i = 0; i < 2; i++) {
        impact_body_def *body = add(f, i ? "upper" : "lower", 0.03 * i, i ? 0.305 : 0.1);
        impact_shape_box(0.2, 0.15, 0.1, 0.01 * i, &body->shape);
        body->velocity = (qvec3){0.4 * i, 0, 0};
    }
}

/* A row of balls, struck, by stiff springs. */
static void springs(family *f)
{
    static const char *const names[] = {"a", "b", "c", "d"};
    begin(f, 0.06);
    f->def.law = IMPACT_STRONGE;
    for (int i = 0; i < 4; i++) add(f, names[i], 0.2 * i + (i == 0 ? -0.03 : 0), 0.1)->restitution = 0.9;
    f->bodies[1].velocity = (qvec3){1, 0, 0};
}

/* What bodies with corners, rims and edges do on planes and on a static box, and one whose contact resists turning. */
static void corners(family *f)
{
    begin(f, 0.03);
    impact_body_def *block = add(f, "block", 0, 0);
    impact_shape_box(0.1, 0.2, 0.3, 0, &block->shape);
    block->orientation = (quat){cos(0.05), 0, sin(0.05), 0};
    block->position.z = 0.1 * sin(0.1) + 0.3 * cos(0.1);
    impact_body_def *disc = add(f, "disc", 1, 0);
    impact_shape_cylinder(0.1, 0.01, 0, &disc->shape);
    disc->orientation = (quat){cos(0.6), sin(0.6), 0, 0};
    disc->position.z = 0.1 * sin(1.2) + 0.01 * cos(1.2);
    disc->omega = (qvec3){0, 0, 5};
    impact_body_def *step = add(f, "step", 2.5, 0.1);
    impact_shape_box(0.5, 0.5, 0.1, 0, &step->shape);
    step->is_static = true;
    impact_shape_superquadric(0.1, 0.1, 0.1, 1, 1, 1, &add(f, "stone", 2.5, 0.301)->shape);
    impact_body_def *wheel = add(f, "wheel", 4, 0.1);
    wheel->rolling_friction = 1e-3;
    wheel->velocity = (qvec3){0.1, 0, 0};
}

static void compliant(family *f)
{
    begin(f, 0.1);
    f->def.law = IMPACT_STRONGE;
    f->def.compliance = 1.2;
    add(f, "a", 0, 0.12)->omega = (qvec3){0, 30, 0};
}

/* What glides on faces and comes to rest there: a box that turns as it slides, a disc that spins on a static box. */
static void gliding(family *f)
{
    begin(f, 0.05);
    impact_body_def *box = add(f, "box", 0, 0.1);
    impact_shape_box(0.2, 0.15, 0.1, 0, &box->shape);
    box->velocity = (qvec3){0.1, 0, 0}, box->omega = (qvec3){0, 0, 0.4};
    impact_body_def *table = add(f, "table", 2, 0.1);
    impact_shape_box(0.5, 0.5, 0.1, 0, &table->shape);
    table->is_static = true;
    impact_body_def *disc = add(f, "disc", 2, 0.25);
    impact_shape_cylinder(0.1, 0.05, 0, &disc->shape);
    disc->omega = (qvec3){0, 0, 3};
}

/* By steps from the start: a box on a box, and a ball that meets both. */
static void steps(family *f)
{
    begin(f, 0.03);
    f->def.piles = IMPACT_PILES_STEPS;
    for (int i = 0; i < 2; i++) {
        impact_body_def *box = add(f, i ? "upper" : "lower", 0.02 * i, 0.1 + 0.2 * i);
        impact_shape_box(0.2, 0.15, 0.1, 0, &box->shape);
    }
    add(f, "ball", -0.31, 0.1)->velocity = (qvec3){0.5, 0, 0};
}

/* Struck at one instant on both sides of a corner, whose contacts resist turning; and what rests on two walls. */
static void groove(family *f)
{
    begin(f, 0.05);
    impact_body_def *ball = add(f, "ball", -0.11 * (1 - cos(1.2)) / sin(1.2), 0.11);
    ball->velocity = (qvec3){0, 1, -0.5};
    ball->rolling_friction = ball->torsional_friction = 1e-3;
    impact_body_def *second = add(f, "second", -1, 0.1);
    second->velocity = (qvec3){0.3, 0.2, 0}, second->omega = (qvec3){0, 0, 4};
    second->rolling_friction = 1e-3;
    *add(f, "wall", 0, 0) =
        plane_body("wall", (qvec3){0, 0, 0}, quat_from_rotation_vector((qvec3){0, -1.2, 0}), 0.6, 0.5);
}

/* ---- what is done with them ---- */

typedef struct outcome {
    impact_status status; /* of the first call that fails */
    char message[400];
} outcome;

static bool good(outcome *o, impact_status status, const char *message)
{
    if (o->status < 0) return false;
    o->status = status;
    if (status < 0) snprintf(o->message, sizeof o->message, "%s", message);
    return status >= 0;
}

static void load(outcome *o, const impact_scene_def *def, impact_scene *from)
{
    static unsigned char bytes[1 << 18];
    size_t size = sizeof bytes;
    impact_scene *scene;
    char message[300];
    if (!good(o, impact_scene_save(from, bytes, &size), impact_scene_message(from))) return;
    if (!good(o, impact_scene_create(def, &scene, message, sizeof message), message)) return;
    if (good(o, impact_scene_load(scene, bytes, size), impact_scene_message(scene)))
        good(o, impact_scene_run(scene, NULL), impact_scene_message(scene));
    impact_scene_destroy(scene);
}

static void disturb(outcome *o, const impact_scene_def *def, impact_scene *scene)
{
    impact_held held[16];
    impact_sample now;
    impact_event event;
    impact_scene_held(scene, held, 16);
    impact_scene_body(scene, 1, &now);
    good(o, impact_scene_push(scene, 1, (qvec3){0.01, 0, 0.02}, now.position), impact_scene_message(scene));
    now.velocity.y += 0.1;
    if (o->status >= 0) good(o, impact_scene_set_state(scene, 1, &now), impact_scene_message(scene));
    if (o->status >= 0)
        good(o, impact_scene_step(scene, 0.8 * def->duration, NULL, &event), impact_scene_message(scene));
}

static void record(outcome *o, const impact_scene_def *def, impact_scene *scene)
{
    impact_run_writer *writer;
    char message[300];
    const void *bytes;
    size_t size;
    if (!good(o, impact_run_create(scene, &writer, message, sizeof message), message)) return;
    const impact_recorder recorder = impact_run_recorder(writer);
    const impact_status ran = impact_scene_run_to(scene, 0.6 * def->duration, &recorder);
    if (ran == IMPACT_ESINK) /* the writer had no room for a row */
        good(o, IMPACT_ENOMEM, "memory");
    else
        good(o, ran, impact_scene_message(scene));
    if (o->status >= 0) good(o, impact_run_bytes(writer, "paused", &bytes, &size), "memory");
    impact_run_discard(writer);
}

static void do_all(const impact_scene_def *def, outcome *o)
{
    impact_scene *scene;
    char message[300];
    *o = (outcome){.status = IMPACT_OK};
    blocks = 0;
    if (!good(o, impact_scene_create(def, &scene, message, sizeof message), message)) {
        assert_null(scene);
        return;
    }
    record(o, def, scene);
    if (o->status >= 0) disturb(o, def, scene);
    if (o->status >= 0) load(o, def, scene);
    impact_scene_destroy(scene);
}

static void one_refused(family *f, long at, bool after, long *told)
{
    outcome o;
    ledger l = {0};
    const impact_allocator allocator = ledger_allocator(&l, 0);
    f->def.allocator = &allocator;
    fail_at = at, all_after = after;
    do_all(&f->def, &o);
    fail_at = 0;
    assert_int_equal(l.live, 0);
    if (o.status >= 0) return; /* what is refused alone may be done without */
    if (o.status != IMPACT_ENOMEM || !strstr(o.message, "memory"))
        fail_msg("block %ld: status %d, '%s'", at, o.status, o.message);
    ++*told;
}

static void every_block_is_refused(void **state)
{
    static void (*const families[])(family *) = {forces, pile, springs, corners, compliant, gliding, steps, groove};
    enum { EACH = 5 }; /* of the others a third: they share how they begin */
    (void)state;
    for (size_t k = 0; k < sizeof families / sizeof *families; k++) {
        family f;
        outcome whole;
        families[k](&f);
        do_all(&f.def, &whole);
        if (whole.status < 0) fail_msg("family %zu: status %d: %s", k, whole.status, whole.message);
        const long count = blocks;
        long told = 0;
        const long each = k < EACH ? 1 : 3;
        for (long at = 1; at <= count; at += each) one_refused(&f, at, at % 2 == 0, &told);
        if (!(count > 150 && told * each > count / 2)) fail_msg("family %zu: %ld of %ld told", k, told, count);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_block_is_refused),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
