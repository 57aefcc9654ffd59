/* SPDX-License-Identifier: MIT */
#include "scene/coarser.h"
#include "base/tolerances.h"
#include "scene/saved.h"
#include "scene/scene_receipt.h"

#include <math.h>
#include <string.h>

/* ---- the other scene ---- */

/* Forces that may change unsaid bound all steps alike: the other's are longer, as errors of the third order allow, so
 * that it misses more. */
static impact_status copy_fields(impact_scene *other)
{
    imp_world *world = &other->world;
    imp_field *fields = imp_arena_take(world->arena, (size_t)world->field_count + 1, sizeof *fields);
    if (!fields) return IMPACT_ENOMEM;
    for (int k = 0; k < world->field_count; k++) {
        fields[k] = world->fields[k];
        fields[k].def.max_step *= cbrt(IMP_COARSER_STEPS);
        fields[k].inside = imp_arena_take(world->arena, (size_t)fields[k].slots + 1, sizeof *fields[k].inside);
        if (!fields[k].inside) return IMPACT_ENOMEM;
    }
    world->fields = fields;
    return IMPACT_OK;
}

static impact_status copy_bodies(impact_scene *other, const impact_scene *scene)
{
    imp_world *world = &other->world;
    const size_t n = (size_t)world->body_count;
    imp_body *bodies = imp_arena_take(world->arena, n, sizeof *bodies);
    other->states = imp_arena_take(world->arena, n, sizeof *other->states);
    other->members = imp_arena_take(world->arena, n, sizeof *other->members);
    other->root = imp_arena_take(world->arena, n, sizeof *other->root);
    if (!bodies || !other->states || !other->members || !other->root) return IMPACT_ENOMEM;
    memcpy(bodies, world->bodies, n * sizeof *bodies);
    memcpy(other->states, scene->states, n * sizeof *other->states);
    for (size_t i = 0; i < n; i++) other->root[i] = -1;
    world->bodies = bodies;
    return IMPACT_OK;
}

/* What the definition says is the scene's; what moves, and where it is, is the other's own. */
static impact_status build_other(impact_scene *other, const impact_scene *scene)
{
    imp_world *world = &other->world;
    imp_arena *arena = world->arena;
    *other = (impact_scene){.name = scene->name,
                            .world = scene->world,
                            .names = scene->names,
                            .rules = scene->rules,
                            .queue.arena = arena,
                            .duration = scene->duration,
                            .unsteady = scene->unsteady,
                            .law = scene->law,
                            .compliance = scene->compliance,
                            .together = scene->together,
                            .methods = scene->methods,
                            .gaps = {.method = scene->gaps.method, .tolerance = scene->gaps.tolerance},
                            .rest_height = scene->rest_height,
                            .rest_speed = scene->rest_speed,
                            .pile_tolerance = fmin(IMP_COARSER_STEPS * scene->pile_tolerance, IMP_MOST_TOLERANCE),
                            .pile_parted = INFINITY,
                            .is_coarser = true,
                            .max_events = scene->max_events,
                            .max_steps = scene->max_steps,
                            .piles = scene->piles,
                            .movable = scene->movable,
                            .key_tolerance = scene->key_tolerance};
    world->arena = arena;
    world->gaps = &other->gaps;
    world->pairs = NULL, world->pair_count = 0;
    imp_scene_receipt_begin(other);
    impact_status status = copy_bodies(other, scene);
    if (status == IMPACT_OK) status = copy_fields(other);
    if (status == IMPACT_OK) status = imp_account_open(&other->account, arena, world->body_count);
    if (status == IMPACT_OK && imp_queue_add(&other->queue) < 0) status = IMPACT_ENOMEM;
    if (status == IMPACT_OK) status = imp_tracks_open(&other->tracks, world, &other->queue);
    if (status == IMPACT_OK) status = imp_tracks_begin(&other->tracks, scene->t, other->states);
    if (status == IMPACT_OK) status = imp_scene_open_workspace(other, NULL, 0);
    return status;
}

static impact_status go_on_from(impact_scene *other, impact_scene *scene)
{
    imp_saved saved = {0};
    impact_status status = imp_saved_collect(&saved, scene);
    if (status == IMPACT_OK) status = imp_saved_restore(&saved, other);
    imp_saved_release(&saved, scene->world.arena);
    return status;
}

static impact_status begin_other(impact_scene *scene)
{
    const impact_allocator within = imp_arena_allocator(scene->world.arena);
    imp_arena *arena;
    impact_status status = imp_arena_create(&within, &arena);
    if (status != IMPACT_OK) return status;
    impact_scene *other = imp_arena_take(arena, 1, sizeof *other);
    if (!other) {
        imp_arena_destroy(arena);
        return IMPACT_ENOMEM;
    }
    other->world.arena = arena;
    scene->coarser = other;
    status = build_other(other, scene);
    if (status == IMPACT_OK) status = go_on_from(other, scene);
    scene->coarser_due = scene->t + IMP_COARSER_LOOKS * scene->duration;
    scene->made_before = scene->made;
    if (status != IMPACT_OK) imp_coarser_end(scene);
    return status;
}

void imp_coarser_end(impact_scene *scene)
{
    impact_scene_destroy(scene->coarser);
    scene->coarser = NULL;
}

/* ---- how far it is ---- */

static double selves_apart(const imp_body *body, const imp_state *a, const imp_state *b)
{
    const quat turn = quat_mul(a->q, quat_conj(b->q));
    const bool round = body->shape.kind == IMPACT_SPHERE && !body->shifted;
    const double angle = round ? 0 : 2 * qvec3_norm((qvec3){turn.x, turn.y, turn.z});
    return qvec3_norm(qvec3_sub(a->x, b->x)) + body->radius * angle;
}

/* What is told of the greatest of all bodies'; *parted: of one that is so large a part of the body that it is no small
 * difference any more. */
static double greatest_apart(const impact_scene *scene, const imp_state *states, bool *parted)
{
    double most = 0;
    *parted = false;
    for (int i = 0; i < scene->world.body_count; i++) {
        const imp_body *body = &scene->world.bodies[i];
        if (body->is_static) continue;
        const double by = IMP_COARSER_SAFETY * selves_apart(body, &scene->states[i], &states[i]);
        *parted = *parted || by > IMP_COARSER_PARTED * body->radius;
        most = fmax(most, by);
    }
    return most;
}

static void end_parted(impact_scene *scene, double t)
{
    scene->pile_parted = t;
    imp_coarser_end(scene);
}

void imp_coarser_parts(impact_scene *scene)
{
    if (!scene->is_coarser && !(scene->pile_parted < INFINITY)) end_parted(scene, scene->t);
}

void imp_coarser_changed(impact_scene *scene, impact_status change)
{
    if (change < 0) end_parted(scene, scene->t);
}

static bool may_go_on(void *context, double t, double end)
{
    const impact_recorder *recorder = ((const impact_scene *)context)->recorder;
    (void)t, (void)end;
    return !recorder || !recorder->progress ||
           recorder->progress(recorder->context, ((const impact_scene *)context)->t, end);
}

/* To t, at which scene->states are. What finds no answer has parted from what did. */
static impact_status follow_to(impact_scene *scene, double t)
{
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = scene, .progress = may_go_on};
    impact_scene *other = scene->coarser;
    bool parted;
    const impact_status status = impact_scene_run_to(other, fmax(t, other->t), &recorder);
    if (status == IMPACT_ENOMEM || status == IMPACT_STOPPED) return status == IMPACT_ENOMEM ? status : IMPACT_OK;
    if (status >= 0) {
        const double by = greatest_apart(scene, other->states, &parted);
        scene->made = fmax(scene->made, scene->made_before + by);
    } else
        parted = true;
    if (parted) end_parted(scene, t);
    return IMPACT_OK;
}

impact_status imp_coarser_follow(impact_scene *scene)
{
    return scene->coarser ? follow_to(scene, scene->t) : IMPACT_OK;
}

/* Where it finds no answer to begin with they have parted at once. */
static impact_status begin(impact_scene *scene)
{
    const impact_status status = begin_other(scene);
    if (status == IMPACT_OK || status == IMPACT_ENOMEM) return status;
    end_parted(scene, scene->t);
    return IMPACT_OK;
}

impact_status imp_coarser_attend(impact_scene *scene, double t)
{
    const bool wanted = scene->stepped && !scene->is_coarser && !(scene->pile_parted < INFINITY);
    impact_status status = IMPACT_OK;
    if (wanted && !scene->coarser && t > scene->t) status = begin(scene);
    while (status == IMPACT_OK && scene->coarser && scene->coarser_due < t) {
        const double due = scene->coarser_due;
        scene->coarser_due += IMP_COARSER_LOOKS * scene->duration;
        if (due <= scene->coarser->t) continue; /* the run was paused behind it, and both were looked at there */
        status = imp_scene_look_between(scene, due);
        if (status == IMPACT_OK) status = follow_to(scene, due);
    }
    return status;
}
