/* SPDX-License-Identifier: MIT
 *
 * The integrator's steps as pieces of motion: its dense output, and the rates of that.
 */
#include "motion/motion_trace.h"

#include <string.h>

/* At a quarter of the step each, and anywhere. */
enum { QUARTERS = 4, SLOTS = QUARTERS + 2 };

/* Every body at one place of the step. */
typedef struct slot {
    double s, t; /* s: NaN when nothing is known */
    bool rated;  /* the rates are known too */
    imp_state *states;
    qvec3 *acceleration, *torque;
} slot;

struct imp_trace {
    slot slots[SLOTS]; /* the first: where the step began */
    double tau[2];     /* of its ends */
    double *y, *rate;
};

void imp_motion_trace_free(struct imp_trace *trace, imp_arena *arena)
{
    if (!trace) return;
    for (int k = 0; k < SLOTS; k++) {
        imp_arena_give(arena, trace->slots[k].states);
        imp_arena_give(arena, trace->slots[k].acceleration);
        imp_arena_give(arena, trace->slots[k].torque);
    }
    imp_arena_give(arena, trace->y);
    imp_arena_give(arena, trace->rate);
    imp_arena_give(arena, trace);
}

static impact_status make_trace(imp_motion *motion)
{
    if (motion->trace) return IMPACT_OK;
    imp_arena *arena = motion->world->arena;
    const size_t n = (size_t)motion->world->body_count;
    struct imp_trace *trace = motion->trace = imp_arena_take(arena, 1, sizeof *trace);
    if (!trace) return IMPACT_ENOMEM;
    trace->y = imp_arena_take(arena, (size_t)motion->size, sizeof *trace->y);
    trace->rate = imp_arena_take(arena, (size_t)motion->size, sizeof *trace->rate);
    bool whole = trace->y && trace->rate;
    for (int k = 0; k < SLOTS; k++) {
        slot *place = &trace->slots[k];
        place->states = imp_arena_take(arena, n, sizeof *place->states);
        place->acceleration = imp_arena_take(arena, n, sizeof *place->acceleration);
        place->torque = imp_arena_take(arena, n, sizeof *place->torque);
        whole = whole && place->states && place->acceleration && place->torque;
    }
    return whole ? IMPACT_OK : IMPACT_ENOMEM;
}

/* The bodies' accelerations and torques from the rates of y. */
static void take_rates(const imp_motion *motion, const double *rate, slot *place)
{
    const double clock = imp_motion_clocked(motion) ? 1 / rate[Y_TIME] : 1;
    const double *b = rate + Y_BODIES + Y_VELOCITY;
    for (int i = 0; i < motion->world->body_count; i++) {
        if (motion->world->bodies[i].is_static) continue;
        place->acceleration[i] = (qvec3){clock * b[0], clock * b[1], clock * b[2]};
        place->torque[i] = (qvec3){clock * b[3], clock * b[4], clock * b[5]};
        b += Y_PER_BODY;
    }
}

static void fill(imp_motion *motion, slot *place, double s, double tau, const double *y)
{
    memcpy(place->states, motion->scratch, sizeof *place->states * (size_t)motion->world->body_count);
    imp_motion_unpack(motion, y, place->states);
    place->s = s;
    place->t = imp_motion_clocked(motion) ? y[Y_TIME] : tau;
    place->rated = false;
}

static double tau_at(const struct imp_trace *trace, double s)
{
    return s < 1 ? trace->tau[0] + s * (trace->tau[1] - trace->tau[0]) : trace->tau[1];
}

static slot *slot_at(imp_motion *motion, double s)
{
    struct imp_trace *trace = motion->trace;
    const int quarter = (int)(QUARTERS * s);
    slot *place = &trace->slots[quarter == QUARTERS * s ? quarter : SLOTS - 1];
    if (place->s == s) return place;
    impact_ode_interpolate(motion->ode, tau_at(trace, s), 0, trace->y);
    fill(motion, place, s, tau_at(trace, s), trace->y);
    return place;
}

static imp_pose trace_pose(void *context, int body, double s)
{
    const slot *place = slot_at(context, s);
    return (imp_pose){place->t, place->states[body].x, place->states[body].q};
}

static impact_key trace_key(void *context, int body, double s)
{
    imp_motion *motion = context;
    slot *place = slot_at(motion, s);
    if (!place->rated) {
        impact_ode_interpolate(motion->ode, tau_at(motion->trace, s), 1, motion->trace->rate);
        take_rates(motion, motion->trace->rate, place);
        place->rated = true;
    }
    return imp_key_of(&motion->world->bodies[body], body, place->t, &place->states[body], place->acceleration[body],
                      place->torque[body]);
}

impact_status imp_motion_trace_start(imp_motion *motion, double t, const imp_state *states)
{
    const impact_status status = make_trace(motion);
    if (status != IMPACT_OK) return status;
    struct imp_trace *trace = motion->trace;
    slot *first = &trace->slots[0];
    if (imp_motion_rates(imp_motion_clocked(motion) ? 0 : t, motion->y, trace->rate, motion) != 0)
        return IMPACT_EDOMAIN;
    memcpy(first->states, states, sizeof *states * (size_t)motion->world->body_count);
    take_rates(motion, trace->rate, first);
    first->s = 0, first->t = t;
    first->rated = true;
    return IMPACT_OK;
}

bool imp_motion_trace_step(imp_motion *motion, const imp_sampler *sampler, double tau_before, double tau,
                           const double *y)
{
    struct imp_trace *trace = motion->trace;
    trace->tau[0] = tau_before, trace->tau[1] = tau;
    for (int k = 1; k < SLOTS; k++) trace->slots[k].s = NAN;
    fill(motion, &trace->slots[QUARTERS], 1, tau, y);
    const imp_works works = {y[Y_FORCE_WORK], y[Y_DAMPING], y[Y_SLIDING],
                             motion->world->driven ? y[imp_motion_drive(motion)] : 0};
    const imp_piece piece = {
        trace->slots[0].t, y[Y_TIME], motion, trace_key, trace_pose, trace->slots[QUARTERS].states, &works};
    trace_key(motion, 0, 1); /* the next step begins with these rates */
    const bool taken = sampler->piece(sampler->context, &piece);
    const slot end = trace->slots[QUARTERS]; /* where the next step begins */
    trace->slots[QUARTERS] = trace->slots[0];
    trace->slots[0] = end;
    trace->slots[0].s = 0;
    return taken;
}
