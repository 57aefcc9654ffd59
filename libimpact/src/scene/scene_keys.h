/* SPDX-License-Identifier: MIT
 *
 * scene_keys: pieces of motion become the recorder's keys, rows of held contacts and of the energy account. Internal.
 */
#ifndef IMP_SCENE_KEYS_H
#define IMP_SCENE_KEYS_H

#include "scene/scene_internal.h"

/* The rows of one pair's held contact: of those that differ little only the last is kept, until one differs. */
typedef struct imp_held_line {
    bool live, skipped;
    impact_held last, pending;
} imp_held_line;

typedef bool imp_held_sink(void *context, const impact_held *row);

/* What is under way on the way to the recorder. */
typedef struct imp_scene_keys {
    imp_key_line *lines; /* per body */
    imp_held_line *held; /* per pair */
    double accounted;    /* s: the last account row */
} imp_scene_keys;

/* Before and after a run with a recorder that wants any of them. */
impact_status imp_scene_keys_begin(impact_scene *scene);
bool imp_scene_keys_end(impact_scene *scene);

/* For the sampler of a scene: spans become keys. */
bool imp_scene_piece(void *scene, const imp_piece *piece);
/* The account as it stands, at the scene's time. */
bool imp_scene_account(impact_scene *scene);

/* A body's next span, and the row of a held contact, as the pieces of motion have them. */
bool imp_scene_add_span(impact_scene *scene, const imp_span *span);
bool imp_scene_add_held(impact_scene *scene, const impact_held *row);

/* A piece as spans of all bodies that move; as rows of held contacts, by the lines given. False: a sink refused. */
bool imp_scene_spans_of(impact_scene *scene, const imp_piece *piece, imp_span_sink *sink, void *context);
bool imp_scene_held_of(impact_scene *scene, const imp_piece *piece, imp_held_line *lines, imp_held_sink *sink,
                       void *context);

/* ---- spans and rows of the groups of a crowd, kept until their while is over ---- */

typedef struct imp_kept {
    int group;
    bool is_span;
    imp_span span;
    impact_held held;
} imp_kept;

typedef struct imp_kept_list {
    imp_arena *arena;
    imp_kept *items;
    int count, room;
    bool failed; /* out of memory */
} imp_kept_list;

void imp_kept_add(imp_kept_list *list, const imp_kept *item);
void imp_kept_drop(imp_kept_list *list, int group);
void imp_kept_free(imp_kept_list *list);
/* Hands all of them to the scene. */
impact_status imp_kept_deliver(imp_kept_list *list, impact_scene *scene);

#endif
