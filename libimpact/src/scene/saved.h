/* SPDX-License-Identifier: MIT
 *
 * saved: a scene at one time without its pointers: all that decides its future bits, and its books. What follows from
 * that (boxes, pairs, queue, polynomials) is not in it, and is made anew where it is restored. Internal.
 */
#ifndef IMP_SAVED_H
#define IMP_SAVED_H

#include "base/archive.h"
#include "scene/scene_internal.h"

/* A body: alone, by the state and the time its segment began with; static, where it is. */
typedef struct imp_saved_body {
    double t0;
    imp_state state;
    bool resting, told;
    int stalls;
    double last_event;
    imp_patience patience;
} imp_saved_body;

typedef struct imp_saved_member {
    int body;
    imp_state state; /* at the island's time */
    bool resting;
} imp_saved_member;

typedef struct imp_saved_island {
    double t; /* one that rests: since when; else now */
    double loss, fallen, looked_at, slip_speed;
    imp_works works;
    bool stepped;
    int member_count, pair_count;
} imp_saved_island;

/* Its arrays are one after the other those of all islands. */
typedef struct imp_saved {
    double t;
    bool begun;
    long next_sample, encounter_count, event_count, steps;
    imp_works works;
    double impact_loss, greatest_energy, impact_loss_fallen, sliding_fallen, pile_error, pile_parted, energy_start;
    impact_scene_residuals receipt;
    impact_usage usage;
    int body_count, inside_count, beyond_count, island_count, member_count, pair_count;
    imp_saved_body *bodies;
    bool *inside; /* of all forces */
    int *beyond;  /* the two bodies of each pair of which the first is behind a plane beside its bounds */
    imp_saved_island *islands;
    imp_saved_member *members;
    imp_pair *pairs; /* by the scene's indices */
} imp_saved;

/* Room for what its counts say; and back. */
impact_status imp_saved_reserve(imp_saved *saved, imp_arena *arena);
void imp_saved_release(imp_saved *saved, imp_arena *arena);

/* Counts, writes or reads all of it; reading, arrays are taken from the arena, for as many bodies as saved->body_count
 * says before. IMPACT_ENOMEM; IMPACT_EARGUMENT: the bytes are no such thing. */
impact_status imp_saved_walk(imp_saved *saved, imp_archive *archive, imp_arena *arena);

/* Whether it can be a state of this scene. IMPACT_EARGUMENT: *fault is what cannot be; IMPACT_ENOMEM. */
impact_status imp_saved_check(const imp_saved *saved, const impact_scene *scene, const char **fault);

/* The scene as it is, in arrays of its arena. */
impact_status imp_saved_collect(imp_saved *saved, impact_scene *scene);
/* The scene goes on from there, whatever it was. */
impact_status imp_saved_restore(const imp_saved *saved, impact_scene *scene);

/* A number of all that decides the motion of a definition: another one for another definition. */
uint64_t imp_scene_print(const impact_scene_def *def);

#endif
