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

/* One body's segment from where its last piece ended, by the segment's own variable. */
typedef struct done_piece {
    const impact_scene *scene;
    const imp_segment *segment;
    double from, to, own[2]; /* s; own: at both, once they are asked for */
    bool placed;
    const imp_state *end;
} done_piece;

static double own_at(done_piece *piece, double s)
{
    double *own = piece->own;
    if (!piece->placed) {
        own[0] = imp_segment_own(piece->segment, piece->from);
        own[1] = imp_segment_own(piece->segment, piece->to);
    }
    piece->placed = true;
    return s < 1 ? own[0] + s * (own[1] - own[0]) : own[1];
}

static imp_pose pose_at(void *context, int body, double s)
{
    done_piece *piece = context;
    const imp_body *b = &piece->scene->world.bodies[body];
    imp_pose pose;
    pose.x = imp_segment_pose(piece->segment, b, own_at(piece, s), &pose.t, &pose.q);
    return pose;
}

static imp_state state_at(const done_piece *piece, int body, double t)
{
    return t < piece->to ? imp_segment_at(piece->segment, &piece->scene->world.bodies[body], t) : *piece->end;
}

static impact_key key_at(void *context, int body, double s)
{
    done_piece *piece = context;
    const imp_body *b = &piece->scene->world.bodies[body];
    const double own = s < 1 ? own_at(piece, s) : imp_segment_own(piece->segment, piece->to);
    const double t = s <= 0 ? piece->from : s >= 1 ? piece->to : imp_segment_time(piece->segment, own);
    const imp_state state = state_at(piece, body, t);
    qvec3 acceleration, torque;
    imp_segment_rates(piece->segment, b, own, &acceleration, &torque);
    impact_key key = imp_key_of(b, body, t, &state, acceleration, torque);
    if (imp_segment_is_within_step(piece->segment, t)) imp_segment_turning(piece->segment, own, &key.omega, &key.alpha);
    return key;
}

static impact_key begin_of(void *context, int body)
{
    const done_piece *piece = context;
    const imp_state state = state_at(piece, body, piece->from);
    const qvec3 omega = imp_omega(&piece->scene->world.bodies[body], &state);
    return (impact_key){.t = piece->from,
                        .body = body,
                        .position = state.x,
                        .orientation = state.q,
                        .velocity = state.v,
                        .omega = omega};
}

/* One key from where the piece begins, for as long as the segment lasts. */
static bool put_form(impact_scene *scene, const done_piece *piece, int body, impact_key_form form)
{
    const imp_segment *segment = piece->segment;
    const imp_body *b = &scene->world.bodies[body];
    imp_key_line *line = &scene->keys->lines[body];
    const impact_key *last = &line->last;
    const bool alone = line->begun && !line->open && last->form != IMPACT_KEY_QUINTIC;
    if (alone && last->t == segment->t0 && piece->from > segment->t0) return true; /* it goes on */
    const imp_state state = imp_segment_at(segment, b, piece->from);
    qvec3 acceleration, torque;
    imp_segment_rates(segment, b, piece->from, &acceleration, &torque);
    impact_key key = imp_key_of(b, body, piece->from, &state, acceleration, torque);
    key.form = form;
    return imp_key_line_add_form(line, &key, put_key, scene);
}

bool imp_scene_segment_done(impact_scene *scene, int body, double t, const imp_state *end)
{
    imp_scene_keys *keys = scene->keys;
    if (!keys || !scene->recorder->key || scene->world.bodies[body].is_static) return true;
    const double from = keys->from[body];
    keys->from[body] = t;
    if (!(t > from)) return true;
    const imp_segment *segment = &scene->tracks.tracks[body].segment;
    done_piece way = {.scene = scene, .segment = segment, .from = from, .to = t, .end = end};
    const impact_key_form form = imp_key_form(&scene->world.bodies[body], segment);
    if (form != IMPACT_KEY_QUINTIC) return put_form(scene, &way, body, form);
    const imp_piece piece = {.from = from, .to = t, .context = &way, .at = key_at, .pose = pose_at, .begin = begin_of};
    return imp_key_line_add_piece(&keys->lines[body], &piece, body, tolerance_of(scene, body), put_key, scene,
                                  &scene->world.usage.keys_unmet);
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
        taken = imp_scene_segment_done(scene, i, scene->t, &scene->states[i]);
        if (taken) taken = imp_key_line_end(line, put_key, scene);
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

static double apart(qvec3 a, qvec3 b) { return qvec3_norm(qvec3_sub(a, b)); }

static bool differs(const impact_held *a, const impact_held *b, double radius)
{
    return a->mode != b->mode || apart(a->normal, b->normal) > IMP_HELD_CHANGE ||
           apart(a->point, b->point) > IMP_HELD_CHANGE * radius ||
           apart(a->force, b->force) > IMP_HELD_CHANGE * qvec3_norm(a->force);
}

static bool put_pending(impact_scene *scene, imp_held_line *line)
{
    const bool skipped = line->skipped;
    line->skipped = false;
    return !skipped || put_held(scene, &line->pending);
}

/* least: s, no two rows of one mode stand closer. */
static bool add_held_row(impact_scene *scene, imp_held_line *line, const impact_held *row, double radius, double least)
{
    const bool same_mode = line->live && line->last.mode == row->mode;
    if (same_mode && (row->t < line->last.t + least || !differs(&line->last, row, radius))) {
        line->pending = *row;
        line->skipped = true;
        return true;
    }
    const bool sudden = line->skipped && line->pending.t > line->last.t + least;
    if (!(same_mode && !sudden) && !put_pending(scene, line)) return false;
    line->skipped = false;
    line->live = true;
    line->last = *row;
    return put_held(scene, row);
}

static imp_held_line *held_line(impact_scene *scene, int near)
{
    imp_scene_keys *keys = scene->keys;
    imp_held_line *lines = imp_arena_grow(scene->world.arena, keys->held, &keys->held_room, near + 1, sizeof *lines);
    if (lines) keys->held = lines;
    return lines ? &lines[near] : NULL;
}

bool imp_scene_held_ends(impact_scene *scene, int near, double t)
{
    if (!scene->keys || !scene->recorder->held || near >= scene->keys->held_room) return true;
    imp_held_line *line = &scene->keys->held[near];
    if (!line->live) return true;
    if (!put_pending(scene, line)) return false;
    impact_held row = line->last;
    row.mode = IMPACT_HOLD_OPEN;
    row.t = t;
    line->live = line->rests = false;
    return put_held(scene, &row);
}

bool imp_scene_held_until(imp_island *island)
{
    impact_scene *scene = island->scene;
    if (!scene->keys || !scene->recorder->held) return true;
    const imp_held *held = &island->motion.held;
    const imp_body *bodies = island->world.bodies;
    const double least = scene->duration / IMP_DISPLAY_ROWS;
    bool taken = true;
    for (int c = 0; taken && c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        const int body1 = bodies[contact->body1].index, body2 = bodies[contact->body2].index;
        const int near = imp_tracks_find(&scene->tracks, body1, body2);
        imp_held_line *line = near < 0 ? NULL : held_line(scene, near);
        const impact_held row = {.t = island->t,
                                 .body1 = body1,
                                 .body2 = body2,
                                 .mode = contact->mode == IMP_STICK ? IMPACT_HOLD_STICK : IMPACT_HOLD_SLIP,
                                 .point = qvec3_add(island->states[contact->body1].x, contact->r1),
                                 .normal = contact->normal,
                                 .force = contact->force};
        if (line) taken = add_held_row(scene, line, &row, bodies[contact->body1].radius, least);
    }
    return taken;
}

/* All points of what a pile's steps hold: rows of one time and pair are one patch. Of what rests they stand once. */
static bool put_points(impact_scene *scene, const imp_island *island, const impact_held *rows, int count)
{
    for (int k = 0; k < count; k++) {
        const int near = imp_tracks_find(&scene->tracks, rows[k].body1, rows[k].body2);
        imp_held_line *line = near < 0 ? NULL : held_line(scene, near);
        if (!line || line->rests) continue;
        line->live = true;
        line->skipped = false;
        line->last = rows[k];
        if (!put_held(scene, &rows[k])) return false;
    }
    for (int k = 0; island->rests && k < count; k++) {
        const int near = imp_tracks_find(&scene->tracks, rows[k].body1, rows[k].body2);
        if (near >= 0 && near < scene->keys->held_room) scene->keys->held[near].rests = true;
    }
    return true;
}

static bool put_piles(impact_scene *scene)
{
    bool taken = true;
    for (int k = 0; taken && scene->recorder->held && k < scene->island_count; k++) {
        const imp_island *island = scene->islands[k];
        const int count = island ? imp_island_held_by_steps(island, scene->t, NULL, 0) : 0;
        if (count == 0) continue;
        impact_held *rows = imp_arena_take(scene->world.arena, (size_t)count, sizeof *rows);
        if (!rows) return false;
        imp_island_held_by_steps(island, scene->t, rows, count);
        taken = put_points(scene, island, rows, count);
        imp_arena_give(scene->world.arena, rows);
    }
    return taken;
}

/* ---- the account ---- */

static bool put_account(impact_scene *scene)
{
    if (!scene->recorder->account) return true;
    imp_state *states = scene->keys->states;
    imp_scene_look_by(scene, scene->t, imp_segment_unturned, true, states);
    scene->keys->accounted = scene->t;
    const impact_energy energy = imp_scene_energy_of(scene, states);
    return scene->recorder->account(scene->recorder->context, scene->t, &energy);
}

/* A row asks every body, an event moves two or a few: rows are taken where all that has gone on pays for them, in a
 * crowd beside one event of many. */
static bool pays(imp_scene_keys *keys, double rows, int body_count)
{
    if (keys->looks < rows * body_count) return false;
    keys->looks -= rows * body_count;
    return true;
}

bool imp_scene_account_before(impact_scene *scene)
{
    imp_scene_keys *keys = scene->keys;
    if (!keys) return true;
    keys->beside = pays(keys, 2, scene->world.body_count);
    return !keys->beside || put_account(scene);
}

bool imp_scene_account_after(impact_scene *scene) { return !scene->keys || !scene->keys->beside || put_account(scene); }

bool imp_scene_account_now_and_then(impact_scene *scene)
{
    imp_scene_keys *keys = scene->keys;
    if (!keys) return true;
    keys->looks += IMP_ACCOUNT_LOOKS;
    const bool due = scene->t >= keys->accounted + scene->duration / IMP_DISPLAY_ROWS;
    return !due || !pays(keys, 1, scene->world.body_count) || (put_account(scene) && put_piles(scene));
}

/* ---- a run ---- */

impact_status imp_scene_keys_begin(impact_scene *scene)
{
    const impact_recorder *recorder = scene->recorder;
    if (!recorder || (!recorder->key && !recorder->held && !recorder->account)) return IMPACT_OK;
    imp_arena *arena = scene->world.arena;
    const size_t n = (size_t)scene->world.body_count;
    imp_scene_keys *keys = scene->keys = imp_arena_take(arena, 1, sizeof *keys);
    if (!keys) return IMPACT_ENOMEM;
    keys->lines = imp_arena_take(arena, n, sizeof *keys->lines);
    keys->from = imp_arena_take(arena, n, sizeof *keys->from);
    keys->states = imp_arena_take(arena, n, sizeof *keys->states);
    if (!keys->lines || !keys->from || !keys->states) return IMPACT_ENOMEM;
    for (size_t i = 0; i < n; i++) keys->from[i] = scene->t;
    if (!put_account(scene)) return IMPACT_ESINK;
    for (int i = 0; recorder->key && i < scene->world.body_count; i++)
        if (scene->world.bodies[i].is_static && !put_state(scene, i)) return IMPACT_ESINK;
    return IMPACT_OK;
}

bool imp_scene_keys_end(impact_scene *scene)
{
    imp_scene_keys *keys = scene->keys;
    if (!keys) return true;
    const impact_recorder *recorder = scene->recorder;
    const bool whole = keys->lines && keys->from && keys->states;
    bool taken = whole && (!recorder->key || end_keys(scene));
    for (int p = 0; taken && recorder->held && p < keys->held_room; p++) taken = put_pending(scene, &keys->held[p]);
    taken = taken && put_account(scene) && put_piles(scene);
    imp_arena_give(scene->world.arena, keys->lines);
    imp_arena_give(scene->world.arena, keys->from);
    imp_arena_give(scene->world.arena, keys->states);
    imp_arena_give(scene->world.arena, keys->held);
    imp_arena_give(scene->world.arena, keys);
    scene->keys = NULL;
    return taken;
}
