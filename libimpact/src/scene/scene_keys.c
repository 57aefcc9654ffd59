/* SPDX-License-Identifier: MIT */
#include "scene/scene_keys.h"
#include "base/tolerances.h"
#include "world/world_gap.h"

/* ---- keys ---- */

static bool put_key(void *context, const impact_key *key)
{
    impact_scene *scene = context;
    scene->world.usage.keys++;
    return scene->recorder->key(scene->recorder->context, key);
}

static imp_key_tolerance tolerance_of(const impact_scene *scene, int body)
{
    const double tolerance = scene->key_tolerance;
    return (imp_key_tolerance){tolerance * scene->world.bodies[body].radius, tolerance};
}

bool imp_scene_add_span(impact_scene *scene, const imp_span *span)
{
    const int body = span->from.body;
    return !scene->recorder->key ||
           imp_key_line_add(&scene->keys->lines[body], span, tolerance_of(scene, body), put_key, scene);
}

static bool add_pieces(impact_scene *scene, const imp_piece *piece)
{
    bool taken = true;
    for (int i = 0; taken && i < scene->world.body_count; i++)
        if (!scene->world.bodies[i].is_static)
            taken = imp_key_line_add_piece(&scene->keys->lines[i], piece, i, tolerance_of(scene, i), put_key, scene,
                                           &scene->world.usage.keys_unmet);
    return taken;
}

bool imp_scene_spans_of(impact_scene *scene, const imp_piece *piece, imp_span_sink *sink, void *context)
{
    for (int i = 0; i < scene->world.body_count; i++)
        if (!scene->world.bodies[i].is_static &&
            !imp_key_halve(piece, i, tolerance_of(scene, i), sink, context, &scene->world.usage.keys_unmet))
            return false;
    return true;
}

/* Where the body is now; what stands still until then has no other key. */
static bool put_state(impact_scene *scene, int body)
{
    const imp_state *state = &scene->states[body];
    impact_key key = {.t = scene->t, .body = body, .position = state->x, .orientation = state->q};
    if (scene->world.bodies[body].is_static) return put_key(scene, &key);
    key.velocity = state->v;
    key.omega = imp_omega(&scene->world.bodies[body], state);
    return put_key(scene, &key);
}

static bool end_keys(impact_scene *scene)
{
    bool taken = true;
    for (int i = 0; taken && i < scene->world.body_count; i++) {
        imp_key_line *line = &scene->keys->lines[i];
        taken = imp_key_line_end(line, put_key, scene);
        if (taken && (!line->begun || line->last.t < scene->t)) taken = put_state(scene, i);
    }
    return taken;
}

/* ---- held contacts ---- */

static bool put_held(void *context, const impact_held *row)
{
    const impact_recorder *recorder = ((impact_scene *)context)->recorder;
    return recorder->held(recorder->context, row);
}

bool imp_scene_add_held(impact_scene *scene, const impact_held *row)
{
    return !scene->recorder->held || put_held(scene, row);
}

static double apart(qvec3 a, qvec3 b) { return qvec3_norm(qvec3_sub(a, b)); }

static bool differs(const impact_held *a, const impact_held *b, double radius)
{
    return a->mode != b->mode || apart(a->normal, b->normal) > IMP_HELD_CHANGE ||
           apart(a->point, b->point) > IMP_HELD_CHANGE * radius ||
           apart(a->force, b->force) > IMP_HELD_CHANGE * qvec3_norm(a->force);
}

static bool put_pending(imp_held_line *line, imp_held_sink *sink, void *context)
{
    const bool skipped = line->skipped;
    line->skipped = false;
    return !skipped || sink(context, &line->pending);
}

/* least: s, no two rows of one mode stand closer. */
static bool add_held(imp_held_line *line, const impact_held *row, double radius, double least, imp_held_sink *sink,
                     void *context)
{
    const bool same_mode = line->live && line->last.mode == row->mode;
    if (same_mode && (row->t < line->last.t + least || !differs(&line->last, row, radius))) {
        line->pending = *row;
        line->skipped = true;
        return true;
    }
    const bool sudden = line->skipped && line->pending.t > line->last.t + least;
    if (!(same_mode && !sudden) && !put_pending(line, sink, context)) return false;
    line->skipped = false;
    line->live = true;
    line->last = *row;
    return sink(context, row);
}

static bool end_held(imp_held_line *line, double t, imp_held_sink *sink, void *context)
{
    if (!line->live) return true;
    if (!put_pending(line, sink, context)) return false;
    impact_held row = line->last;
    row.mode = IMPACT_HOLD_OPEN;
    row.t = t;
    line->live = false;
    return sink(context, &row);
}

bool imp_scene_held_of(impact_scene *scene, const imp_piece *piece, imp_held_line *lines, imp_held_sink *sink,
                       void *context)
{
    const imp_persist *persist = &scene->motion.persist;
    const double least = scene->duration / IMP_DISPLAY_ROWS;
    bool taken = true;
    for (int p = 0; taken && p < scene->world.pair_count; p++)
        if (!imp_is_held(&scene->world.pairs[p])) taken = end_held(&lines[p], piece->from, sink, context);
    for (int c = 0; taken && c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        const impact_held row = {.t = piece->to,
                                 .body1 = touch->body1,
                                 .body2 = touch->body2,
                                 .mode = touch->mode == IMP_ROLL ? IMPACT_HOLD_STICK : IMPACT_HOLD_SLIP,
                                 .point = qvec3_add(piece->end[touch->body1].x, touch->r1),
                                 .normal = touch->normal,
                                 .force = touch->force};
        taken = add_held(&lines[touch->pair], &row, scene->world.bodies[touch->body1].radius, least, sink, context);
    }
    return taken;
}

/* ---- the account ---- */

static bool put_account(impact_scene *scene, double t, const imp_state *states, const imp_works *works)
{
    const impact_energy energy = {.start = scene->energy_start,
                                  .kinetic = imp_world_kinetic_energy(&scene->world, states),
                                  .potential = imp_field_potential(&scene->world, states),
                                  .force_work = works->force,
                                  .drive_work = works->drive,
                                  .damping_loss = works->damping,
                                  .sliding_loss = works->sliding,
                                  .impact_loss = scene->impact_loss};
    scene->keys->accounted = t;
    return scene->recorder->account(scene->recorder->context, t, &energy);
}

bool imp_scene_account(impact_scene *scene)
{
    if (!scene->recorder || !scene->recorder->account) return true;
    return put_account(scene, scene->t, scene->states, &scene->motion.works);
}

/* ---- a run ---- */

bool imp_scene_piece(void *context, const imp_piece *piece)
{
    impact_scene *scene = context;
    const impact_recorder *recorder = scene->recorder;
    if (recorder->key && !add_pieces(scene, piece)) return false;
    if (recorder->held && !imp_scene_held_of(scene, piece, scene->keys->held, put_held, scene)) return false;
    if (!recorder->account || piece->to < scene->keys->accounted + scene->duration / IMP_DISPLAY_ROWS) return true;
    return put_account(scene, piece->to, piece->end, piece->works);
}

impact_status imp_scene_keys_begin(impact_scene *scene)
{
    const impact_recorder *recorder = scene->recorder;
    scene->sampler.piece = NULL;
    if (!recorder || (!recorder->key && !recorder->held && !recorder->account)) return IMPACT_OK;
    imp_arena *arena = scene->world.arena;
    imp_scene_keys *keys = scene->keys = imp_arena_take(arena, 1, sizeof *keys);
    if (!keys) return IMPACT_ENOMEM;
    keys->lines = imp_arena_take(arena, (size_t)scene->world.body_count, sizeof *keys->lines);
    keys->held = imp_arena_take(arena, (size_t)scene->world.pair_count, sizeof *keys->held);
    if (!keys->lines || !keys->held) return IMPACT_ENOMEM;
    scene->sampler.piece = imp_scene_piece;
    if (!imp_scene_account(scene)) return IMPACT_ESINK;
    for (int i = 0; recorder->key && i < scene->world.body_count; i++)
        if (scene->world.bodies[i].is_static && !put_state(scene, i)) return IMPACT_ESINK;
    return IMPACT_OK;
}

bool imp_scene_keys_end(impact_scene *scene)
{
    imp_scene_keys *keys = scene->keys;
    if (!keys) return true;
    const impact_recorder *recorder = scene->recorder;
    const bool whole = keys->lines && keys->held;
    bool taken = whole && (!recorder->key || end_keys(scene));
    for (int p = 0; taken && recorder->held && p < scene->world.pair_count; p++)
        taken = put_pending(&keys->held[p], put_held, scene);
    taken = taken && imp_scene_account(scene);
    imp_arena_give(scene->world.arena, keys->lines);
    imp_arena_give(scene->world.arena, keys->held);
    imp_arena_give(scene->world.arena, keys);
    scene->keys = NULL;
    return taken;
}

/* ---- of a crowd ---- */

void imp_kept_add(imp_kept_list *list, const imp_kept *item)
{
    imp_kept *more = imp_arena_grow(list->arena, list->items, &list->room, list->count + 1, sizeof *more);
    list->failed = list->failed || !more;
    if (!more) return;
    list->items = more;
    list->items[list->count++] = *item;
}

void imp_kept_drop(imp_kept_list *list, int group)
{
    int kept = 0;
    for (int k = 0; k < list->count; k++)
        if (list->items[k].group != group) list->items[kept++] = list->items[k];
    list->count = kept;
}

void imp_kept_free(imp_kept_list *list)
{
    imp_arena_give(list->arena, list->items);
    *list = (imp_kept_list){.arena = list->arena};
}

impact_status imp_kept_deliver(imp_kept_list *list, impact_scene *scene)
{
    bool taken = true;
    for (int k = 0; taken && k < list->count; k++) {
        const imp_kept *item = &list->items[k];
        taken = item->is_span ? imp_scene_add_span(scene, &item->span) : imp_scene_add_held(scene, &item->held);
    }
    list->count = 0;
    if (list->failed) return IMPACT_ENOMEM;
    return taken ? IMPACT_OK : IMPACT_ESINK;
}
