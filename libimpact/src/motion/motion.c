/* SPDX-License-Identifier: MIT */
#include "motion/motion.h"
#include "motion/motion_trace.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

impact_status imp_motion_open(imp_motion *motion, imp_world *world, double tolerance, double rest_speed)
{
    *motion =
        (imp_motion){.world = world, .persist.arena = world->arena, .tolerance = tolerance, .rest_speed = rest_speed};
    const size_t n = (size_t)world->body_count;
    motion->resting = imp_arena_take(world->arena, n, sizeof *motion->resting);
    motion->loads = imp_arena_take(world->arena, n, sizeof *motion->loads);
    motion->sampled = imp_arena_take(world->arena, n, sizeof *motion->sampled);
    motion->scratch = imp_arena_take(world->arena, n, sizeof *motion->scratch);
    return motion->resting && motion->loads && motion->sampled && motion->scratch ? IMPACT_OK : IMPACT_ENOMEM;
}

void imp_motion_close(imp_motion *motion)
{
    if (!motion->world) return;
    imp_arena *arena = motion->world->arena;
    impact_ode_destroy(motion->adams);
    impact_ode_destroy(motion->bdf);
    imp_persist_free(&motion->persist);
    imp_motion_trace_free(motion->trace, arena);
    imp_arena_give(arena, motion->flyers);
    imp_arena_give(arena, motion->resting);
    imp_arena_give(arena, motion->loads);
    imp_arena_give(arena, motion->sampled);
    imp_arena_give(arena, motion->scratch);
    imp_arena_give(arena, motion->kept);
    imp_arena_give(arena, motion->y);
    imp_arena_give(arena, motion->found);
    imp_arena_give(arena, motion->probe);
    imp_arena_give(arena, motion->absolute);
    *motion = (imp_motion){0};
}

bool imp_motion_load(imp_motion *motion, double t, const imp_state *states)
{
    imp_world *world = motion->world;
    if (!imp_field_loads(world, t, states, motion->loads)) {
        snprintf(motion->message, sizeof motion->message, "a custom force refused at t = %.17g", t);
        return false;
    }
    for (int i = 0; i < world->body_count; i++) {
        const qvec3 f = motion->loads[i].force, m = motion->loads[i].torque;
        if (isfinite(f.x + f.y + f.z + m.x + m.y + m.z)) continue;
        snprintf(motion->message, sizeof motion->message, "body '%s': the force on it is not finite at t = %.17g",
                 world->bodies[i].name, t);
        return false;
    }
    return true;
}
double imp_motion_sample_time(const imp_sampler *sampler)
{
    return sampler->rate > 0 ? (double)sampler->next / sampler->rate : INFINITY;
}

/* Emits the states with the held contacts put back exactly. */
impact_status imp_motion_emit(imp_motion *motion, imp_sampler *sampler, double t, const imp_state *states)
{
    sampler->next++;
    if (states != motion->sampled) memcpy(motion->sampled, states, sizeof *states * (size_t)motion->world->body_count);
    if (motion->persist.count > 0) {
        if (!imp_motion_load(motion, t, motion->sampled)) return IMPACT_EDOMAIN;
        imp_persist_project(&motion->persist, motion->world, motion->sampled, motion->loads);
    }
    return sampler->emit(sampler->context, t, motion->sampled) ? IMPACT_OK : IMPACT_STOPPED;
}

void imp_motion_set_slack(imp_motion *motion, const imp_state *states)
{
    imp_world *world = motion->world;
    motion->bounces = false;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        pair->slack = imp_world_touching_distance(world, pair, states);
        if (imp_is_held(pair) || pair->beyond || imp_world_distance_bound(world, pair, states) > pair->slack) continue;
        impact_contact contact;
        imp_world_gap(world, pair, states, &contact);
        motion->bounces = motion->bounces || contact.gap <= pair->slack;
        pair->slack += fmax(0, -contact.gap); /* of bodies that began with an overlap */
    }
}

bool imp_motion_is_ballistic(const imp_motion *motion)
{
    return motion->persist.count == 0 && !imp_field_any(motion->world);
}
