/* SPDX-License-Identifier: MIT */
#include "motion.h"
#include "world_gap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

impact_status impact_motion_open(impact_motion *motion, impact_world *world, double tolerance, double rest_speed)
{
    *motion = (impact_motion){.world = world, .tolerance = tolerance, .rest_speed = rest_speed};
    const size_t n = (size_t)world->body_count;
    motion->resting = calloc(n, sizeof *motion->resting);
    motion->loads = calloc(n, sizeof *motion->loads);
    motion->sampled = calloc(n, sizeof *motion->sampled);
    motion->scratch = calloc(n, sizeof *motion->scratch);
    return motion->resting && motion->loads && motion->sampled && motion->scratch ? IMPACT_OK : IMPACT_ENOMEM;
}

void impact_motion_close(impact_motion *motion)
{
    impact_ode_destroy(motion->adams);
    impact_ode_destroy(motion->bdf);
    impact_persist_free(&motion->persist);
    free(motion->flyers);
    free(motion->resting);
    free(motion->loads);
    free(motion->sampled);
    free(motion->scratch);
    free(motion->kept);
    free(motion->y);
    free(motion->found);
    *motion = (impact_motion){0};
}

bool impact_motion_load(impact_motion *motion, double t, const impact_state *states)
{
    impact_world *world = motion->world;
    if (!impact_field_loads(world, t, states, motion->loads)) {
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
double impact_motion_sample_time(const impact_sampler *sampler)
{
    return sampler->rate > 0 ? (double)sampler->next / sampler->rate : INFINITY;
}

/* Emits the states with the held contacts put back exactly. */
impact_status impact_motion_emit(impact_motion *motion, impact_sampler *sampler, double t, const impact_state *states)
{
    sampler->next++;
    if (states != motion->sampled) memcpy(motion->sampled, states, sizeof *states * (size_t)motion->world->body_count);
    if (motion->persist.count > 0) {
        if (!impact_motion_load(motion, t, motion->sampled)) return IMPACT_EDOMAIN;
        impact_persist_project(&motion->persist, motion->world, motion->sampled, motion->loads);
    }
    return sampler->emit(sampler->context, t, motion->sampled) ? IMPACT_OK : IMPACT_STOPPED;
}

void impact_motion_set_slack(impact_motion *motion, const impact_state *states)
{
    impact_world *world = motion->world;
    for (int p = 0; p < world->pair_count; p++) {
        impact_pair *pair = &world->pairs[p];
        pair->slack = impact_world_touching_distance(world, pair, states);
        if (impact_is_held(pair) || pair->beyond || impact_world_distance_bound(world, pair, states) > 0) continue;
        impact_contact contact;
        impact_world_gap(world, pair, states, &contact);
        pair->slack += fmax(0, -contact.gap); /* of bodies that began with an overlap */
    }
}

bool impact_motion_is_ballistic(const impact_motion *motion)
{
    return motion->persist.count == 0 && !impact_field_any(motion->world);
}
