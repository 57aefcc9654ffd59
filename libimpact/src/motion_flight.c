/* SPDX-License-Identifier: MIT
 *
 * Flight in closed form: uniform gravity and nothing held. The centre falls, the body tumbles; pairs are asked when
 * they meet.
 */
#include "motion.h"
#include "motion_meet.h"

#include <stdlib.h>

/* Every body's flight from here; a body whose flight nothing has changed goes on with it. */
static impact_status board(impact_motion *motion, const impact_state *states)
{
    const impact_world *world = motion->world;
    if (!motion->flyers) motion->flyers = calloc((size_t)world->body_count, sizeof *motion->flyers);
    if (!motion->flyers) return IMPACT_ENOMEM;
    for (int i = 0; i < world->body_count; i++) impact_flyer_board(&motion->flyers[i], &world->bodies[i], &states[i]);
    return IMPACT_OK;
}

static void fly(const impact_motion *motion, double dt, impact_state *states)
{
    const impact_world *world = motion->world;
    for (int i = 0; i < world->body_count; i++)
        states[i] = impact_flyer_at(&motion->flyers[i], &world->bodies[i], world->gravity, dt);
}

/* What ends the stretch first; *dt is shortened to it. */
static impact_end find_end(impact_motion *motion, double *dt)
{
    impact_world *world = motion->world;
    impact_end end = {IMPACT_END_TIME, 0};
    for (int p = 0; p < world->pair_count; p++) {
        const impact_meeting_time meeting =
            impact_motion_meet(world, &world->pairs[p], motion->flyers, motion->scratch, *dt);
        if (meeting.dt > *dt || (meeting.dt == *dt && (end.kind != IMPACT_END_TIME || !meeting.touches))) continue;
        *dt = meeting.dt;
        end = (impact_end){!meeting.touches         ? IMPACT_END_TIME
                           : world->pairs[p].beyond ? IMPACT_END_RETURN
                                                    : IMPACT_END_GAP,
                           p};
    }
    return end;
}

impact_status impact_motion_fly(impact_motion *motion, double *t, double t_end, impact_state *states,
                                impact_sampler *sampler, impact_end *end)
{
    impact_world *world = motion->world;
    double dt = t_end - *t;
    impact_motion_set_slack(motion, states);
    impact_status status = board(motion, states);
    if (status != IMPACT_OK) return status;
    *end = find_end(motion, &dt);
    const double t_event = dt == t_end - *t ? t_end : *t + dt;
    world->usage.ballistic_flights++;
    while (impact_motion_sample_time(sampler) <= t_event) {
        const double due = impact_motion_sample_time(sampler);
        fly(motion, due - *t, motion->sampled);
        status = impact_motion_emit(motion, sampler, due, motion->sampled);
        if (status == IMPACT_OK) continue;
        *end = (impact_end){IMPACT_END_TIME, 0};
        return status;
    }
    fly(motion, dt, states);
    for (int i = 0; i < world->body_count; i++) {
        motion->flyers[i].now = states[i];
        motion->flyers[i].elapsed += dt;
    }
    if (end->kind ==
        IMPACT_END_GAP) { /* these two begin anew, whatever becomes of them: no step is then lost to rounding */
        impact_flyer_leave(&motion->flyers[world->pairs[end->index].body1]);
        impact_flyer_leave(&motion->flyers[world->pairs[end->index].body2]);
    }
    *t = t_event;
    return IMPACT_OK;
}
