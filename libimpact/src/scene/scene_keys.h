/* SPDX-License-Identifier: MIT
 *
 * scene_keys: pieces of motion become the recorder's keys, rows of held contacts and of the energy account. Internal.
 */
#ifndef IMP_SCENE_KEYS_H
#define IMP_SCENE_KEYS_H

#include "motion/key.h"
#include "scene/scene_internal.h"

/* The rows of one pair's held contact: of those that differ little only the last is kept, until one differs. */
typedef struct imp_held_line {
    bool live, skipped;
    bool rests; /* its points' rows stand, and hold for as long as it does */
    impact_held last, pending;
} imp_held_line;

typedef bool imp_held_sink(void *context, const impact_held *row);

/* What is under way on the way to the recorder. */
typedef struct imp_scene_keys {
    imp_key_line *lines; /* per body */
    double *from;        /* per body, s: up to where its motion has been handed on */
    imp_held_line *held; /* per pair of the tracks */
    int held_room;
    imp_state *states; /* room for all bodies', of one row of the account */
    double accounted;  /* s: the last account row */
    double looks;      /* at bodies, that rows of the account may take now */
    bool beside;       /* the event under way has its rows */
} imp_scene_keys;

/* Before and after a run with a recorder that wants any of them. */
impact_status imp_scene_keys_begin(impact_scene *scene);
bool imp_scene_keys_end(impact_scene *scene);

/* A body's segment is done at t, where its state is `end`: the one place that every trajectory goes through. False: a
 * sink refused. */
bool imp_scene_segment_done(impact_scene *scene, int body, double t, const imp_state *end);
/* The rows of the contacts that an island holds up to its time. */
bool imp_scene_held_until(imp_island *island);
/* The pair is held no more at t. */
bool imp_scene_held_ends(impact_scene *scene, int near, double t);
/* The account as it stands, at the scene's time: before and after an event, where it costs less than the event; and
 * where the last is a while ago. */
bool imp_scene_account_before(impact_scene *scene);
bool imp_scene_account_after(impact_scene *scene);
bool imp_scene_account_now_and_then(impact_scene *scene);

#endif
