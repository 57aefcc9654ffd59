/* SPDX-License-Identifier: MIT
 *
 * Straight lines, not glTF's cubic splines: Blender's importer drops their tangents. From event to event the interval
 * is halved until lines and slerp meet the record at a quarter, half and three quarters, and so do quaternions whose
 * components go in straight lines, which is what Blender makes of slerp: between two an angle th apart they are off
 * by th^3/250, most near a quarter.
 */
#include "gltf_keys.h"

#include <quat/interpolate.h>

/* s: Blender takes keys within a hundredth of a frame of each other as one: at 24 frames a second. */
static const double least_step = 4.2e-4;

/* rad: two keys further apart could be joined the wrong way round, and whole turns between them be missed. */
static const double widest_turn = 1;

typedef struct keys {
    imp_arena *arena;
    const impact_run *run;
    int body;
    double place, angle; /* tolerances */
    imp_gltf_key *items;
    int count, room;
    bool failed;
} keys;

static imp_gltf_key key_at(const keys *k, double t)
{
    impact_sample s = {0};
    impact_run_state(k->run, k->body, t, &s);
    return (imp_gltf_key){t, s.position, s.orientation, qvec3_norm(s.omega)};
}

static void add(keys *k, imp_gltf_key key)
{
    imp_gltf_key *more = k->failed ? NULL : imp_arena_grow(k->arena, k->items, &k->room, k->count + 1, sizeof *more);
    k->failed = !more;
    if (!more) return;
    k->items = more;
    k->items[k->count++] = key;
}

static bool meets(const keys *k, const imp_gltf_key *a, const imp_gltf_key *b)
{
    if (2 * quat_distance(a->q, b->q) > widest_turn || fmax(a->turn, b->turn) * (b->t - a->t) > widest_turn)
        return false;
    for (int i = 1; i < 4; i++) {
        const double s = 0.25 * i;
        const imp_gltf_key there = key_at(k, a->t + s * (b->t - a->t));
        const qvec3 x = qvec3_axpy(s, qvec3_sub(b->x, a->x), a->x);
        const quat slerped = quat_slerp(a->q, b->q, s);
        const quat lerped = quat_unit(quat_add(a->q, quat_scale(quat_sub(b->q, a->q), s)));
        if (qvec3_norm(qvec3_sub(x, there.x)) > k->place) return false;
        if (2 * fmax(quat_distance(slerped, there.q), quat_distance(lerped, there.q)) > k->angle) return false;
    }
    return true;
}

/* Adds what is needed between a and b, and b. */
static void halve(keys *k, imp_gltf_key a, imp_gltf_key b)
{
    if (b.t - a.t < 2 * least_step || meets(k, &a, &b)) {
        add(k, b);
        return;
    }
    const imp_gltf_key middle = key_at(k, 0.5 * (a.t + b.t));
    halve(k, a, middle);
    halve(k, middle, b);
}

imp_gltf_key *imp_gltf_keys(imp_arena *arena, const impact_run *run, int body, double tolerance, int *count)
{
    impact_body_def def = impact_default_body_def();
    impact_run_body(run, body, &def);
    const double size = impact_shape_bounding_radius(&def.shape) + qvec3_norm(def.shape_position);
    const double end = impact_run_end(run);
    keys k = {.arena = arena, .run = run, .body = body, .place = tolerance * size, .angle = tolerance};
    imp_gltf_key last = key_at(&k, impact_run_begin(run));
    add(&k, last);
    for (long i = 1; i < impact_run_key_count(run, body); i++) {
        impact_key before, key;
        impact_run_key(run, body, i - 1, &before);
        impact_run_key(run, body, i, &key);
        const bool turns = key.t == before.t || before.form != IMPACT_KEY_QUINTIC;
        if (!turns || key.t < last.t + least_step || key.t > end - least_step) continue;
        const imp_gltf_key next = key_at(&k, key.t);
        halve(&k, last, next);
        last = next;
    }
    if (end > last.t) halve(&k, last, key_at(&k, end));
    *count = k.count;
    return k.failed ? NULL : k.items;
}
