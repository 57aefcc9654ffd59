/* SPDX-License-Identifier: MIT */
#include "scene/scene_points.h"
#include "contact/points.h"
#include "scene/scene_meeting.h"
#include "world/world_gap.h"

#include <string.h>

static impact_status place(imp_island *island, const imp_pair *pair)
{
    imp_world *world = &island->world;
    imp_point points[IMP_POINTS];
    imp_pair own = *pair;
    const double touching = imp_world_touching_distance(world, pair, island->states);
    const int count = imp_points_find(world, &own, island->states, touching, points);
    const impact_status status = imp_island_reserve(island, world->body_count, world->pair_count + count);
    for (int k = 0; status == IMPACT_OK && k < count; k++) {
        own.placed = true;
        own.place = points[k].contact;
        own.bearer = count == 1 ? 0 : points[k].feature[1].kind == IMPACT_FACE ? 2 : 1;
        world->pairs[world->pair_count++] = own;
    }
    return status;
}

impact_status imp_scene_place_points(imp_island *island)
{
    imp_world *world = &island->world;
    bool any = false;
    for (int p = 0; p < world->pair_count; p++) any = any || imp_pair_has_faces(world, &world->pairs[p]);
    if (!any) return IMPACT_OK;
    const int count = world->pair_count;
    const size_t size = sizeof *world->pairs * (size_t)count;
    imp_pair *before = imp_arena_take(world->arena, (size_t)count, sizeof *before);
    if (!before) return IMPACT_ENOMEM;
    memcpy(before, world->pairs, size);
    world->pair_count = 0;
    impact_status status = IMPACT_OK;
    for (int p = 0; status == IMPACT_OK && p < count; p++) {
        if (imp_pair_has_faces(world, &before[p]))
            status = place(island, &before[p]);
        else
            world->pairs[world->pair_count++] = before[p];
    }
    imp_arena_give(world->arena, before);
    return status;
}

bool imp_scene_points_stay(imp_island *island)
{
    imp_meeting m;
    for (int p = 0; p < island->world.pair_count; p++) {
        if (!island->world.pairs[p].placed || !imp_scene_meets(island, p, &m)) continue;
        imp_scene_press(island, &m);
        if (m.acceleration < 0 ? imp_scene_dies_out(island, &m, m.velocity) : m.velocity <= island->world.slip_speed)
            return true;
    }
    return false;
}

void imp_scene_drop_points(imp_island *island)
{
    imp_world *world = &island->world;
    int kept = 0;
    for (int p = 0; p < world->pair_count; p++) {
        if (world->pairs[p].placed) continue;
        island->modes[kept] = island->modes[p];
        world->pairs[kept++] = world->pairs[p];
    }
    world->pair_count = kept;
}
