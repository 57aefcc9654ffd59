/* SPDX-License-Identifier: MIT
 *
 * A scene's bodies as one island, and the island that a scene has made.
 */
#ifndef ISLANDS_H
#define ISLANDS_H

#include "scene/scene_internal.h"
#include "kit/scene_log.h"

/* All bodies of the scene as they stand at the start, and all its pairs, open. */
static inline imp_island *whole_island(impact_scene *scene)
{
    const int n = scene->world.body_count;
    imp_island *island = imp_arena_take(scene->world.arena, 1, sizeof *island);
    island->scene = scene;
    imp_island_clear(island);
    assert_int_equal(imp_island_reserve(island, n, n * n), IMPACT_OK);
    for (int i = 0; i < n; i++) imp_island_add_body(island, i, &scene->states[i]);
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            if (!scene->world.bodies[i].is_static || !scene->world.bodies[j].is_static)
                island->world.pairs[island->world.pair_count++] = imp_rules_pair(&scene->rules, &scene->world, i, j);
    return island;
}

/* The island that holds the body. */
static inline const imp_island *island_of(const impact_scene *scene, int body)
{
    const int number = scene->tracks.tracks[body].island;
    assert_true(number >= 0);
    return scene->islands[number];
}

#endif
