/* SPDX-License-Identifier: MIT
 *
 * Flight in closed form: uniform gravity and nothing held. The centre falls, the body tumbles; pairs are asked when
 * they meet.
 */
#include "motion/motion.h"
#include "motion/motion_meet.h"

/* Every body's flight from here; a body whose flight nothing has changed goes on with it. */
static impact_status board(imp_motion *motion, const imp_state *states)
{
    const imp_world *world = motion->world;
    if (!motion->flyers)
        motion->flyers = imp_arena_take(world->arena, (size_t)world->body_count, sizeof *motion->flyers);
    if (!motion->flyers) return IMPACT_ENOMEM;
    for (int i = 0; i < world->body_count; i++) imp_flyer_board(&motion->flyers[i], &world->bodies[i], &states[i]);
    return IMPACT_OK;
}

static void fly(const imp_motion *motion, double dt, imp_state *states)
{
    const imp_world *world = motion->world;
    for (int i = 0; i < world->body_count; i++)
        states[i] = imp_flyer_at(&motion->flyers[i], &world->bodies[i], world->gravity, dt);
}

/* What ends the stretch first; *dt is shortened to it. */
static imp_end find_end(imp_motion *motion, double *dt)
{
    imp_world *world = motion->world;
    imp_end end = {IMP_END_TIME, 0};
    for (int p = 0; p < world->pair_count; p++) {
        const imp_meeting_time meeting = imp_motion_meet(world, &world->pairs[p], motion->flyers, motion->scratch, *dt);
        if (meeting.dt > *dt || (meeting.dt == *dt && (end.kind != IMP_END_TIME || !meeting.touches))) continue;
        *dt = meeting.dt;
        end = (imp_end){!meeting.touches ? IMP_END_TIME : world->pairs[p].beyond ? IMP_END_RETURN : IMP_END_GAP, p};
    }
    return end;
}

/* The stretch as a piece of motion. */
typedef struct flight_piece {
    const imp_motion *motion;
    double t, dt, t_event;
} flight_piece;

static imp_state state_at(const flight_piece *piece, int body, double s)
{
    const imp_world *world = piece->motion->world;
    const imp_flyer *flyer = &piece->motion->flyers[body];
    return s > 0 ? imp_flyer_at(flyer, &world->bodies[body], world->gravity, s * piece->dt) : flyer->now;
}

static double time_at(const flight_piece *piece, double s) { return s < 1 ? piece->t + s * piece->dt : piece->t_event; }

static imp_pose flight_pose(void *piece, int body, double s)
{
    const imp_state state = state_at(piece, body, s);
    return (imp_pose){time_at(piece, s), state.x, state.q};
}

static impact_key flight_key(void *piece, int body, double s)
{
    const imp_world *world = ((const flight_piece *)piece)->motion->world;
    const imp_state state = state_at(piece, body, s);
    return imp_key_of(&world->bodies[body], body, time_at(piece, s), &state, world->gravity, (qvec3){0, 0, 0});
}

impact_status imp_motion_fly(imp_motion *motion, double *t, double t_end, imp_state *states, imp_sampler *sampler,
                             imp_end *end)
{
    imp_world *world = motion->world;
    double dt = t_end - *t;
    imp_motion_set_slack(motion, states);
    impact_status status = board(motion, states);
    if (status != IMPACT_OK) return status;
    *end = find_end(motion, &dt);
    const double t_event = dt == t_end - *t ? t_end : *t + dt;
    world->usage.ballistic_flights++;
    while (imp_motion_sample_time(sampler) <= t_event) {
        const double due = imp_motion_sample_time(sampler);
        fly(motion, due - *t, motion->sampled);
        status = imp_motion_emit(motion, sampler, due, motion->sampled);
        if (status == IMPACT_OK) continue;
        *end = (imp_end){IMP_END_TIME, 0};
        return status;
    }
    fly(motion, dt, states);
    flight_piece way = {motion, *t, dt, t_event};
    const imp_piece piece = {*t, t_event, &way, flight_key, flight_pose, states, &motion->works};
    if (sampler->piece && !sampler->piece(sampler->context, &piece)) status = IMPACT_ESINK;
    for (int i = 0; i < world->body_count; i++) {
        motion->flyers[i].now = states[i];
        motion->flyers[i].elapsed += dt;
    }
    if (end->kind ==
        IMP_END_GAP) { /* these two begin anew, whatever becomes of them: no step is then lost to rounding */
        imp_flyer_leave(&motion->flyers[world->pairs[end->index].body1]);
        imp_flyer_leave(&motion->flyers[world->pairs[end->index].body2]);
    }
    *t = t_event;
    return status;
}
