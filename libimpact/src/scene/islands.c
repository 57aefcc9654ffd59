/* SPDX-License-Identifier: MIT */
#include "scene/islands.h"

#include <string.h>

static bool keep_spare(impact_scene *scene, imp_island *island)
{
    imp_island **spares =
        imp_arena_grow(scene->world.arena, scene->spares, &scene->spare_room, scene->spare_count + 1, sizeof *spares);
    if (!spares) return false;
    scene->spares = spares;
    spares[scene->spare_count++] = island;
    return true;
}

imp_island *imp_islands_spare(impact_scene *scene)
{
    if (scene->spare_count == 0) {
        imp_island *made = imp_arena_take(scene->world.arena, 1, sizeof *made);
        if (!made || !keep_spare(scene, made)) return NULL;
        made->scene = scene;
    }
    imp_island *island = scene->spares[--scene->spare_count];
    imp_island_clear(island);
    return island;
}

void imp_islands_add_usage(impact_usage *sum, impact_usage *part)
{
    enum { COUNTS = sizeof *sum / sizeof(long) };
    long a[COUNTS], b[COUNTS];
    memcpy(a, sum, sizeof a);
    memcpy(b, part, sizeof b);
    for (int k = 0; k < COUNTS; k++) a[k] += b[k];
    memcpy(sum, a, sizeof a);
    *part = (impact_usage){0};
}

/* What the island did since it was asked last is the scene's. */
void imp_islands_give_account(imp_island *island)
{
    impact_scene *scene = island->scene;
    imp_works *works = &island->motion.works;
    scene->works.force += works->force;
    scene->works.damping += works->damping;
    scene->works.sliding += works->sliding;
    scene->works.drive += works->drive;
    *works = (imp_works){0};
    scene->impact_loss += island->impact_loss;
    scene->sliding_fallen += island->motion.fallen;
    island->impact_loss = island->loss_before = island->gained = island->motion.fallen = 0;
    imp_islands_add_usage(&scene->world.usage, &island->world.usage);
}

void imp_islands_release(imp_island *island)
{
    impact_scene *scene = island->scene;
    imp_islands_give_account(island);
    if (island->number >= 0) {
        scene->islands[island->number] = NULL;
        if (island->number < scene->first_free) scene->first_free = island->number;
        imp_queue_set(&scene->queue, imp_scene_island_slot(scene, island->number), INFINITY);
    }
    island->number = -1;
    if (!keep_spare(scene, island)) imp_motion_forget(&island->motion); /* the rest goes with the arena */
}

impact_status imp_islands_number(imp_island *island)
{
    impact_scene *scene = island->scene;
    if (island->number >= 0) return IMPACT_OK;
    int number = scene->first_free;
    while (number < scene->island_count && scene->islands[number]) number++;
    if (number == scene->island_count) {
        imp_island **islands =
            imp_arena_grow(scene->world.arena, scene->islands, &scene->island_room, number + 1, sizeof *islands);
        if (!islands) return IMPACT_ENOMEM;
        scene->islands = islands;
        if (imp_queue_add(&scene->queue) < 0) return IMPACT_ENOMEM;
        scene->island_count++;
    }
    scene->islands[number] = island;
    scene->first_free = number + 1;
    island->number = number;
    return IMPACT_OK;
}
