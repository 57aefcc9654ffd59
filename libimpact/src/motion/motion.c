/* SPDX-License-Identifier: MIT */
#include "motion/motion.h"
#include "base/number.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

bool imp_motion_reserve(imp_motion *motion, imp_arena *arena, int bodies)
{
    int room[4] = {motion->room, motion->room, motion->room, motion->room};
    bool *resting = imp_arena_grow(arena, motion->resting, &room[0], bodies, sizeof *resting);
    if (resting) motion->resting = resting;
    imp_load *loads = imp_arena_grow(arena, motion->loads, &room[1], bodies, sizeof *loads);
    if (loads) motion->loads = loads;
    imp_state *sampled = imp_arena_grow(arena, motion->sampled, &room[2], bodies, sizeof *sampled);
    if (sampled) motion->sampled = sampled;
    imp_state *scratch = imp_arena_grow(arena, motion->scratch, &room[3], bodies, sizeof *scratch);
    if (scratch) motion->scratch = scratch;
    if (!resting || !loads || !sampled || !scratch) return false;
    motion->room = room[0]; /* the arena grows all alike */
    return true;
}

void imp_motion_reset(imp_motion *motion, imp_world *world, const impact_methods *methods, double rest_speed)
{
    motion->world = world;
    motion->held.arena = world->arena;
    motion->method = methods->motion;
    motion->tolerance = methods->tolerance;
    motion->step = methods->step;
    motion->rest_speed = rest_speed;
    motion->works = (imp_works){0};
    motion->bounces = motion->distrusted = motion->retried = false;
    motion->steady_steps = motion->pace_steps = 0;
    motion->fallen = motion->last_fall = 0;
    motion->held.count = 0;
    motion->message[0] = '\0'; /* integrators that fit are used again: a start leaves nothing of what they did */
}

void imp_motion_forget(imp_motion *motion)
{
    if (!motion->world) return;
    imp_arena *arena = motion->world->arena;
    impact_ode_destroy(motion->adams);
    impact_ode_destroy(motion->bdf);
    impact_ode_destroy(motion->rk4);
    impact_ode_destroy(motion->lobatto);
    impact_ode_destroy(motion->dop853);
    imp_arena_give(arena, motion->kept);
    imp_arena_give(arena, motion->y);
    imp_arena_give(arena, motion->found);
    imp_arena_give(arena, motion->probe);
    imp_arena_give(arena, motion->absolute);
    motion->ode = motion->adams = motion->bdf = motion->rk4 = motion->lobatto = motion->dop853 = NULL;
    motion->kept = motion->y = motion->probe = motion->absolute = NULL;
    motion->found = NULL;
    motion->counted = (impact_ode_counts){0};
}

void imp_motion_close(imp_motion *motion)
{
    if (!motion->world) return;
    imp_arena *arena = motion->world->arena;
    imp_motion_forget(motion);
    imp_held_free(&motion->held);
    imp_arena_give(arena, motion->dense.c);
    imp_arena_give(arena, motion->dense.seen);
    imp_arena_give(arena, motion->kept_contacts);
    imp_arena_give(arena, motion->kept_pairs);
    imp_arena_give(arena, motion->resting);
    imp_arena_give(arena, motion->loads);
    imp_arena_give(arena, motion->sampled);
    imp_arena_give(arena, motion->scratch);
    *motion = (imp_motion){0};
}

bool imp_motion_load(imp_motion *motion, double t, const imp_state *states)
{
    imp_world *world = motion->world;
    if (!imp_field_loads(world, t, states, motion->loads)) {
        snprintf(motion->message, sizeof motion->message, "a custom force refused at t = %s", imp_number_of(t).text);
        return false;
    }
    for (int i = 0; i < world->body_count; i++) {
        const qvec3 f = motion->loads[i].force, m = motion->loads[i].torque;
        if (isfinite(f.x + f.y + f.z + m.x + m.y + m.z)) continue;
        snprintf(motion->message, sizeof motion->message, "body '%s': the force on it is not finite at t = %s",
                 world->bodies[i].name, imp_number_of(t).text);
        return false;
    }
    return true;
}
