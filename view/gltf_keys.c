/* SPDX-License-Identifier: MIT
 *
 * Straight lines, not glTF's cubic splines: Blender's importer drops their tangents. From event to event the interval
 * is halved until lines and slerp meet the record at its keys and at a quarter, half and three quarters, and so do
 * quaternions whose components go in straight lines, which is what Blender makes of slerp: between two an angle th
 * apart they are off by th^3/250, most near a quarter. Every key is the record's state at a time that is a float, as
 * glTF's are.
 *
 * Blender turns seconds into frames, as floats, and of keys within a hundredth of a frame keeps the last one's value at
 * the first one's time. So no two stand closer than
 *     .01/rate + t/2^23        s: the second for two roundings of frames, by t rate/2^24 each
 * and what happens between two such keys is not in the file: events that follow faster, and what moves by the
 * tolerance in less. And a time within a ten-thousandth of a frame of a key is shown as the key's. What both leave a
 * body off by is measured, and said; more frames a second take it away.
 */
#include "gltf_keys.h"

#include <float.h>
#include <quat/interpolate.h>

/* Frames: Blender's hundredth, and a hundredth of it more, by which the two are told apart. */
static const double least_part = 0.0101;

/* Frames: what Blender does not tell from a key. */
static const double unseen_part = 1e-4;

/* Of the tolerance: the rest is for floats, 2^-24 of what is 150 of a body's sizes away at 3e-4 of that. */
static const double part_of_lines = 0.97;

/* rad: two keys further apart could be joined the wrong way round, and whole turns between them be missed. */
static const double widest_turn = 1;

typedef struct keys {
    imp_arena *arena;
    const impact_run *run;
    int body;
    double place, angle; /* tolerances */
    double frame_rate;
    imp_gltf_key *items;
    int count, room;
    double off; /* tolerances, where keys may not stand closer */
    bool failed;
} keys;

/* At t, or at the float beside it that is within the run. */
static imp_gltf_key key_at(const keys *k, double t)
{
    const double begin = impact_run_begin(k->run);
    float part = (float)(t - begin);
    if (begin + part > impact_run_end(k->run)) part = nextafterf(part, 0);
    impact_sample s = {0};
    impact_run_state(k->run, k->body, begin + part, &s);
    return (imp_gltf_key){begin + part, s.position, s.orientation, qvec3_norm(s.velocity), qvec3_norm(s.omega)};
}

/* s: what the next key after that time must be apart from it. */
static double least_step(const keys *k, double t)
{
    return least_part / k->frame_rate + FLT_EPSILON * (t - impact_run_begin(k->run));
}

static void add(keys *k, imp_gltf_key key)
{
    imp_gltf_key *more = k->failed ? NULL : imp_arena_grow(k->arena, k->items, &k->room, k->count + 1, sizeof *more);
    k->failed = !more;
    if (!more) return;
    k->items = more;
    k->items[k->count++] = key;
}

/* How far lines between the two are off at part s of the way, in tolerances. */
static double miss_at(const keys *k, const imp_gltf_key *a, const imp_gltf_key *b, double s)
{
    impact_sample there = {0};
    impact_run_state(k->run, k->body, a->t + s * (b->t - a->t), &there);
    const qvec3 x = qvec3_axpy(s, qvec3_sub(b->x, a->x), a->x);
    const quat slerped = quat_slerp(a->q, b->q, s);
    const quat lerped = quat_unit(quat_add(a->q, quat_scale(quat_sub(b->q, a->q), s)));
    const double turn = 2 * fmax(quat_distance(slerped, there.orientation), quat_distance(lerped, there.orientation));
    return fmax(qvec3_norm(qvec3_sub(x, there.position)) / k->place, turn / k->angle);
}

/* The number of the body's first key after t. */
static long key_after(const keys *k, double t)
{
    long low = 0, high = impact_run_key_count(k->run, k->body);
    while (low < high) {
        impact_key key;
        const long middle = low + (high - low) / 2;
        impact_run_key(k->run, k->body, middle, &key);
        if (key.t <= t)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The same where it is at its worst: at the record's keys between, where the motion has its corners. */
static double miss_at_corners(const keys *k, const imp_gltf_key *a, const imp_gltf_key *b)
{
    impact_key key;
    double worst = 0;
    for (long i = key_after(k, a->t); impact_run_key(k->run, k->body, i, &key) == IMPACT_OK && key.t < b->t; i++)
        worst = fmax(worst, miss_at(k, a, b, (key.t - a->t) / (b->t - a->t)));
    return worst;
}

static double miss(const keys *k, const imp_gltf_key *a, const imp_gltf_key *b)
{
    if (2 * quat_distance(a->q, b->q) > widest_turn || fmax(a->turn, b->turn) * (b->t - a->t) > widest_turn)
        return INFINITY;
    const double between = fmax(fmax(miss_at(k, a, b, 0.25), miss_at(k, a, b, 0.5)), miss_at(k, a, b, 0.75));
    return fmax(between, miss_at_corners(k, a, b));
}

/* What is off beside the key, of its place or angle, in tolerances. */
static double unseen(const keys *k, const imp_gltf_key *key)
{
    return unseen_part / k->frame_rate * fmax(key->speed / k->place, key->turn / k->angle);
}

/* Adds what is needed between a and b, and b. */
static void halve(keys *k, imp_gltf_key a, imp_gltf_key b)
{
    const double off = miss(k, &a, &b);
    if (off <= part_of_lines || b.t - a.t < 2 * least_step(k, b.t)) {
        k->off = fmax(k->off, fmax(off, unseen(k, &b)));
        add(k, b);
        return;
    }
    const imp_gltf_key middle = key_at(k, 0.5 * (a.t + b.t));
    halve(k, a, middle);
    halve(k, middle, b);
}

imp_gltf_key *imp_gltf_keys(imp_arena *arena, const impact_run *run, int body, const imp_gltf_way *way, int *count,
                            double *off)
{
    impact_body_def def = impact_default_body_def();
    impact_run_body(run, body, &def);
    const double size = impact_shape_bounding_radius(&def.shape) + qvec3_norm(def.shape_position);
    const double end = impact_run_end(run);
    keys k = {.arena = arena,
              .run = run,
              .body = body,
              .place = way->tolerance * size,
              .angle = way->tolerance,
              .frame_rate = way->frame_rate};
    imp_gltf_key last = key_at(&k, impact_run_begin(run));
    add(&k, last);
    for (long i = 1; i < impact_run_key_count(run, body); i++) {
        impact_key before, key;
        impact_run_key(run, body, i - 1, &before);
        impact_run_key(run, body, i, &key);
        const bool turns = key.t == before.t || before.form != IMPACT_KEY_QUINTIC;
        if (!turns || key.t < last.t + least_step(&k, key.t) || key.t > end - least_step(&k, end)) continue;
        const imp_gltf_key next = key_at(&k, key.t);
        halve(&k, last, next);
        last = next;
    }
    if (end > last.t) halve(&k, last, key_at(&k, end));
    *count = k.count;
    *off = fmax(*off, way->tolerance * k.off);
    return k.failed ? NULL : k.items;
}
