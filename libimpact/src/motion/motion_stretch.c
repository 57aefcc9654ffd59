/* SPDX-License-Identifier: MIT
 *
 * One stretch of integration: which variable and method it needs, its steps, its samples, and the event at its end.
 */
#include "motion/motion_equations.h"
#include "motion/motion_guard.h"
#include "motion/motion_trace.h"
#include "contact/persist_spot.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Slip faster than this part of the slip scale turns no faster than the motion goes. */
static const double grown_up = 1e-2;

static impact_status allocate_state(imp_motion *motion)
{
    const imp_world *world = motion->world;
    if (motion->y) return IMPACT_OK;
    int moving = 0;
    for (int i = 0; i < world->body_count; i++) moving += !world->bodies[i].is_static;
    int spots = 0;
    for (int p = 0; p < world->pair_count; p++) spots += imp_spot_suits(world, &world->pairs[p]);
    motion->size = Y_BODIES + Y_PER_BODY * moving + Y_PER_SPOT * spots + world->driven;
    motion->roots =
        ROOTS_PER_PAIR * world->pair_count + ROOTS_PER_EDGE * imp_field_edge_count(world) + world->body_count;
    motion->kept = imp_arena_take(world->arena, (size_t)motion->size, sizeof *motion->kept);
    motion->found = imp_arena_take(world->arena, (size_t)motion->roots, sizeof *motion->found);
    motion->absolute = imp_arena_take(world->arena, (size_t)motion->size, sizeof *motion->absolute);
    motion->probe = imp_arena_take(world->arena, 4 * (size_t)motion->size, sizeof *motion->probe);
    motion->y = imp_arena_take(world->arena, (size_t)motion->size, sizeof *motion->y);
    const bool room = motion->kept && motion->y && motion->found && motion->absolute && motion->probe;
    return room ? IMPACT_OK : IMPACT_ENOMEM;
}

/* Makes the integrator of the method the one at work, creating it when it is first needed. */
static impact_status choose_integrator(imp_motion *motion, impact_ode_method method)
{
    impact_ode **ode = method == IMPACT_ODE_ADAMS ? &motion->adams : &motion->bdf;
    impact_status status = allocate_state(motion);
    if (status == IMPACT_OK && !*ode) {
        const impact_ode_def def = {.size = motion->size,
                                    .roots = motion->roots,
                                    .rhs = imp_motion_rates,
                                    .root_functions = imp_motion_root_values,
                                    .context = motion,
                                    .method = method,
                                    .relative_tolerance = motion->tolerance,
                                    .absolute_tolerance = IMP_ABSOLUTE_OF_RELATIVE * motion->tolerance,
                                    .falling_roots_only = true};
        status = imp_ode_create_in(motion->world->arena, &def, ode);
        if (status == IMPACT_EABSENT)
            snprintf(motion->message, sizeof motion->message,
                     "this motion needs the integrator, and this build has none (IMPACT_WITH_CVODE is off)");
        motion->world->usage.integrators += status == IMPACT_OK;
    }
    motion->ode = *ode;
    return status;
}

static void count_work(imp_motion *motion)
{
    impact_ode_counts adams = {0}, bdf = {0};
    if (motion->adams) adams = impact_ode_count(motion->adams);
    if (motion->bdf) bdf = impact_ode_count(motion->bdf);
    impact_usage *usage = &motion->world->usage;
    usage->integrator_starts = adams.starts + bdf.starts;
    usage->integrator_steps = adams.steps + bdf.steps;
    usage->integrator_rhs_calls = adams.rhs_calls + bdf.rhs_calls;
}

/* The slowest slip, as the touches stand, of the contacts that slide past their onset, m/s; infinite when none does.
 * young: of those alone whose slip has just begun, or of the others. */
static double slowest_slip(const imp_motion *motion, bool young)
{
    double slowest = INFINITY;
    for (int c = 0; c < motion->persist.count; c++) {
        const imp_touch *touch = &motion->persist.touches[c];
        if (touch->mode == IMP_SLIDE && !touch->onset && touch->friction > 0 &&
            motion->world->pairs[touch->pair].young == young)
            slowest = fmin(slowest, touch->speed);
    }
    return slowest;
}

/* Whether some slip dies out again that has just begun. */
static bool young_fades(const imp_motion *motion)
{
    for (int c = 0; c < motion->persist.count; c++) {
        const imp_touch *touch = &motion->persist.touches[c];
        if (touch->mode == IMP_SLIDE && !touch->onset && motion->world->pairs[touch->pair].young &&
            qvec3_dot(touch->slip_rate, touch->slip) < 0)
            return true;
    }
    return false;
}

/* What has its direction from itself again is not young any more. */
static void grow_up(imp_motion *motion)
{
    for (int c = 0; c < motion->persist.count; c++) {
        const imp_touch *touch = &motion->persist.touches[c];
        imp_pair *pair = &motion->world->pairs[touch->pair];
        pair->young =
            pair->young && touch->mode == IMP_SLIDE && !touch->onset && touch->speed < grown_up * motion->slip_scale;
    }
}

/* Ends the onset of every contact that slides fast enough to have a direction of its own; tells whether one did. */
static bool end_onsets(imp_motion *motion)
{
    bool ended = false;
    for (int c = 0; c < motion->persist.count; c++) {
        const imp_touch *touch = &motion->persist.touches[c];
        if (!touch->onset || touch->speed < motion->world->onset_speed) continue;
        motion->world->pairs[touch->pair].onset = false;
        motion->world->pairs[touch->pair].young = true;
        ended = true;
    }
    return ended;
}

/* Friction turns with the slip whose onset has ended: whether a contact now pulls, or rolls with more friction than it
 * has. No root function tells, for it does not fall through zero: it jumps. */
static bool modes_break(imp_motion *motion, double t, const double *y)
{
    imp_persist *persist = &motion->persist;
    double greatest = 0;
    bool breaks = false;
    imp_motion_unpack(motion, y, motion->scratch);
    if (!imp_motion_load(motion, t, motion->scratch)) return true;
    imp_persist_solve(persist, motion->world, motion->scratch, motion->loads);
    for (int c = 0; c < persist->count; c++) greatest = fmax(greatest, qvec3_norm(persist->touches[c].force));
    for (int c = 0; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        const double spare = touch->mode == IMP_ROLL ? fmin(touch->pressure, touch->margin) : touch->pressure;
        breaks = breaks || (!touch->still && spare < -IMP_MODE_ROUNDING * greatest);
    }
    return breaks;
}

/* The speed below which slip slows the clock: small against the motion and the weight of the sliding bodies. */
static double slip_scale(const imp_motion *motion, const imp_state *states)
{
    double scale = 0;
    for (int c = 0; c < motion->persist.count; c++) {
        const imp_touch *touch = &motion->persist.touches[c];
        if (touch->mode != IMP_SLIDE) continue;
        const imp_body *body = &motion->world->bodies[touch->body1];
        const double fall = fabs(touch->pressure) * body->inverse_mass * body->radius;
        scale = fmax(scale, 0.05 * (imp_motion_speed(body, &states[touch->body1]) + sqrt(fall)));
    }
    return fmax(scale, motion->world->slip_speed);
}

/* How fast a carried contact may move over its surface before it slows the clock, 1/s: as the body itself moves, about;
 * 0: none is. */
static double creep_scale(const imp_motion *motion, const imp_state *states)
{
    double scale = 0;
    for (int c = 0; c < motion->persist.count; c++) {
        const imp_touch *touch = &motion->persist.touches[c];
        if (!touch->carried) continue;
        const imp_body *body = &motion->world->bodies[touch->body1];
        const double fall = qvec3_norm(motion->loads[touch->body1].force) * body->inverse_mass;
        const double rate = qvec3_norm(imp_omega(body, &states[touch->body1])) + sqrt(fall / body->radius);
        scale = fmax(scale, rate);
    }
    return scale;
}

/* The function of the interpolated state whose zero is looked for in the last step. */
typedef struct last_step_function {
    enum { CLOCK, PAIR_GAP, FIELD_EDGE } kind;
    int index; /* pair or edge */
    double t;  /* the clock's zero */
} last_step_function;

static double last_step_value(imp_motion *motion, last_step_function f, const double *y)
{
    if (f.kind == CLOCK) return y[Y_TIME] - f.t;
    imp_motion_unpack(motion, y, motion->scratch);
    if (f.kind == FIELD_EDGE) return imp_field_edge(motion->world, y[Y_TIME], motion->scratch, f.index);
    impact_contact contact;
    imp_world_gap(motion->world, &motion->world->pairs[f.index], motion->scratch, &contact);
    return contact.gap;
}

/* Interpolates the last step where f changes sign between tau = low and high, by the Illinois form of regula falsi. */
static impact_status find_in_last_step(imp_motion *motion, last_step_function f, double low, double high, double *tau,
                                       double *y)
{
    impact_status status = impact_ode_interpolate(motion->ode, low, 0, y);
    double f_low = last_step_value(motion, f, y);
    if (status == IMPACT_OK) status = impact_ode_interpolate(motion->ode, high, 0, y);
    double f_high = last_step_value(motion, f, y);
    *tau = high;
    for (int i = 0, side = 0; status == IMPACT_OK && i < 100 && f_high != f_low; i++) {
        double guess = (f_low * high - f_high * low) / (f_low - f_high);
        if (!(guess > low && guess < high)) guess = 0.5 * (low + high);
        if (guess == low || guess == high || guess == *tau) break;
        *tau = guess;
        status = impact_ode_interpolate(motion->ode, guess, 0, y);
        const double value = last_step_value(motion, f, y);
        if (value == 0) break;
        if ((value > 0) == (f_high > 0)) {
            high = guess, f_high = value;
            if (side == 1) f_low *= 0.5;
            side = 1;
        } else {
            low = guess, f_low = value;
            if (side == -1) f_high *= 0.5;
            side = -1;
        }
    }
    return status;
}

/* The state of the last step at time t, and where in the variable of integration that is. */
static impact_status interpolate_time(imp_motion *motion, double t, double *tau, double *y)
{
    *tau = t;
    if (!imp_motion_clocked(motion)) return impact_ode_interpolate(motion->ode, t, 0, y);
    double low, high;
    impact_ode_last_step(motion->ode, &low, &high);
    return find_in_last_step(motion, (last_step_function){.kind = CLOCK, .t = t}, low, high, tau, y);
}

/* The event that a root stands for; how deep a gap's closest approach is tells whether its rate's root is one. */
static imp_end end_of_root(const imp_motion *motion, int root)
{
    const imp_world *world = motion->world;
    if (root < ROOTS_PER_PAIR * world->pair_count) {
        const int p = root / ROOTS_PER_PAIR, slot = root % ROOTS_PER_PAIR;
        const imp_pair *pair = &world->pairs[p];
        if (!imp_is_held(pair)) return (imp_end){pair->beyond ? IMP_END_RETURN : IMP_END_GAP, p};
        if (slot == 0) return (imp_end){IMP_END_LIFTOFF, p};
        if (slot == 2) return (imp_end){IMP_END_BOUNDS, p};
        return (imp_end){pair->mode == IMP_ROLL ? IMP_END_SLIP : IMP_END_STICK, p};
    }
    root -= ROOTS_PER_PAIR * world->pair_count;
    const int edges = ROOTS_PER_EDGE * imp_field_edge_count(world);
    if (root < edges) return (imp_end){IMP_END_EDGE, root / ROOTS_PER_EDGE};
    return (imp_end){IMP_END_SLOW, root - edges};
}

/* Whether a root is that of a value's rate: the value is lowest here. If it is below its slack, both its zeros lie in
 * the step. */
static bool is_lowest_point(const imp_motion *motion, int root, last_step_function *value, double *slack)
{
    const imp_world *world = motion->world;
    const int pair = root / ROOTS_PER_PAIR, edge_root = root - ROOTS_PER_PAIR * world->pair_count;
    if (edge_root < 0) {
        *value = (last_step_function){.kind = PAIR_GAP, .index = pair};
        *slack = world->pairs[pair].slack;
        return root % ROOTS_PER_PAIR == 1 && !imp_is_held(&world->pairs[pair]);
    }
    *value = (last_step_function){.kind = FIELD_EDGE, .index = edge_root / ROOTS_PER_EDGE};
    *slack = 0;
    return edge_root % ROOTS_PER_EDGE == 1 && value->index < imp_field_edge_count(world);
}

/* Looks through the roots found at *tau for the event that ends the stretch; a zero that the step hid moves *tau and y
 * back to it. */
static impact_status pick_event(imp_motion *motion, double tau_before, double *tau, double *y, imp_end *end)
{
    for (int root = 0; root < motion->roots; root++) {
        last_step_function value;
        double slack;
        if (motion->found[root] == 0) continue;
        if (!is_lowest_point(motion, root, &value, &slack)) {
            if (end->kind != IMP_END_TIME) continue;
            *end = end_of_root(motion, root);
            motion->found[root] = 0;
            continue;
        }
        if (last_step_value(motion, value, y) >= -slack) continue;
        *end = (imp_end){value.kind == PAIR_GAP ? IMP_END_GAP : IMP_END_EDGE, value.index};
        memset(motion->found, 0, sizeof *motion->found * (size_t)motion->roots); /* of later times */
        return find_in_last_step(motion, value, tau_before, *tau, tau, y);
    }
    return IMPACT_OK;
}

bool imp_motion_also_crossed(imp_motion *motion, imp_end *end)
{
    const int first = ROOTS_PER_PAIR * motion->world->pair_count, edges = imp_field_edge_count(motion->world);
    for (int edge = 0; motion->found && edge < edges; edge++) {
        int *found = &motion->found[first + ROOTS_PER_EDGE * edge];
        if (*found == 0) continue;
        *found = 0;
        *end = (imp_end){IMP_END_EDGE, edge};
        return true;
    }
    return false;
}

/* From the root that was watched for, the slack below zero and to 1e-14 of the step, one Newton step back to where the
 * gap is zero. */
static impact_status polish_gap(imp_motion *motion, int pair, double *tau, double *y)
{
    imp_world *world = motion->world;
    impact_contact contact;
    imp_motion_unpack(motion, y, motion->scratch);
    imp_world_gap(world, &world->pairs[pair], motion->scratch, &contact);
    const double rate =
        imp_world_gap_rate(world, &world->pairs[pair], motion->scratch, &contact) * imp_motion_clock(motion);
    double low, high;
    impact_ode_last_step(motion->ode, &low, &high);
    const double polished = *tau - contact.gap / rate;
    if (!(polished >= low && polished <= high) || rate >= 0) return IMPACT_OK; /* a gap that was never open */
    *tau = polished;
    return impact_ode_interpolate(motion->ode, polished, 0, y);
}

static impact_status emit_until(imp_motion *motion, double t, imp_state *states, imp_sampler *sampler, double *y)
{
    while (imp_motion_sample_time(sampler) <= t) {
        double tau;
        impact_status status = interpolate_time(motion, imp_motion_sample_time(sampler), &tau, y);
        if (status != IMPACT_OK) return status;
        imp_motion_unpack(motion, y, states);
        status = imp_motion_emit(motion, sampler, imp_motion_sample_time(sampler), states);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

/* What the integrator has to say is of its own insides. */
static impact_status fail(imp_motion *motion, impact_status status, double t)
{
    if (status == IMPACT_EINTEGRATOR || status == IMPACT_EDOMAIN)
        return imp_motion_stuck(motion, "the integrator cannot go on: the motion is not smooth, or without bound,", t);
    return status;
}

static impact_status too_rough(imp_motion *motion, double from, double to, long steps)
{
    char what[160];
    snprintf(
        what, sizeof what,
        "%ld steps from t = %.17g got nowhere: the motion is too rough (a face that rocks, or masses too different "
        "that press on each other?)",
        steps, from);
    return imp_motion_stuck(motion, what, to);
}

/* Steps until an event or t_end; y at the end is the state at *t. */
static impact_status integrate(imp_motion *motion, double *t, double t_end, double *y, imp_state *states,
                               imp_sampler *sampler, imp_end *end)
{
    enum { MAX_STILL = 1000, LOOK = 2000000, RENEWAL = 20000, CARRIED_RENEWAL = 500 };
    const double least = 1e-6; /* of the time left, gained in so many steps */
    const long renewal = motion->creeping ? CARRIED_RENEWAL : RENEWAL;
    const long steps_before = motion->steps_before;
    const double t_start = steps_before > 0 ? motion->began : *t;
    motion->steps_before = 0;
    int still = 0;
    bool passed = false; /* the last step ended at a root that is no event */
    const bool clocked = imp_motion_clocked(motion);
    double tau = clocked ? 0 : *t;
    const double stop = clocked ? 1000 * (t_end - *t) + 1000 : t_end;
    *end = (imp_end){IMP_END_TIME, 0};
    for (long step = steps_before; still < MAX_STILL; step++) {
        const double tau_before = tau;
        bool found;
        impact_status status = imp_motion_step(motion, stop, &tau, y, &found);
        if (motion->message[0] != '\0') return IMPACT_EDOMAIN;        /* a load was refused */
        if (status == IMPACT_EINTEGRATOR && passed) return IMPACT_OK; /* another root close by: begin anew from here */
        if (status == IMPACT_EINTEGRATOR && *t > t_start &&
            motion->persist.count > 0) { /* reactions that went a corner */
            *end = (imp_end){IMP_END_RENEWAL, 0};
            return IMPACT_OK;
        }
        if (status == IMPACT_OK && found) status = pick_event(motion, tau_before, &tau, y, end);
        if (status == IMPACT_OK && end->kind == IMP_END_GAP) status = polish_gap(motion, end->index, &tau, y);
        if (status != IMPACT_OK) return fail(motion, status, *t);
        if (!clocked) y[Y_TIME] = tau;
        if (y[Y_TIME] > t_end) {
            status = interpolate_time(motion, t_end, &tau, y);
            if (status != IMPACT_OK) return fail(motion, status, *t);
            y[Y_TIME] = t_end;
            *end = (imp_end){IMP_END_TIME, 0};
            memset(motion->found, 0, sizeof *motion->found * (size_t)motion->roots);
        }
        if (!imp_motion_finite_or_back(motion, y))
            return imp_motion_stuck(motion, "the motion has left double precision", *t);
        if (imp_motion_loss_falls(motion, y) && *t > t_start && imp_motion_take_back(motion, y)) {
            *end = (imp_end){IMP_END_RENEWAL, 0};
            return IMPACT_OK;
        }
        *t = y[Y_TIME];
        if (!imp_motion_gains(motion, *t))
            return imp_motion_stuck(motion, "time all but stands: 100000 steps were too short to tell", *t);
        memcpy(motion->kept, y, sizeof *y * (size_t)motion->size); /* samples overwrite y */
        if (sampler->piece && !imp_motion_trace_step(motion, sampler, tau_before, tau, y)) return IMPACT_ESINK;
        status = emit_until(motion, *t, states, sampler, y);
        memcpy(y, motion->kept, sizeof *y * (size_t)motion->size);
        if (status == IMPACT_OK && !sampler->pulse(sampler->context, *t)) status = IMPACT_STOPPED;
        if (status != IMPACT_OK || *t >= t_end || end->kind != IMP_END_TIME) return status;
        if (tau == stop) { /* slip so slow that time all but stands, and that does not die out: does anything move? */
            *end = (imp_end){IMP_END_RENEWAL, 0};
            return IMPACT_OK;
        }
        if (end_onsets(motion)) {
            if (modes_break(motion, *t, y)) *end = (imp_end){IMP_END_RENEWAL, 0};
            return IMPACT_OK;
        }
        if (motion->stiff && slowest_slip(motion, true) > grown_up * motion->slip_scale) return IMPACT_OK;
        if (motion->stiff && !motion->sliding && young_fades(motion)) return IMPACT_OK;
        still = tau > tau_before ? 0 : still + 1;
        passed = found;
        /* Held contacts drift apart otherwise, and forces may brake as they did not before. */
        if (step + 1 == steps_before + renewal) {
            const bool looks = step + 1 >= LOOK; /* long runs are the caller's to stop, unless they get nowhere */
            if (looks && *t - t_start < least * (t_end - t_start)) return too_rough(motion, t_start, *t, LOOK);
            motion->steps_before = looks ? 0 : step + 1;
            motion->began = t_start;
            *end = (imp_end){IMP_END_RENEWAL, 0};
            return IMPACT_OK;
        }
    }
    return imp_motion_stuck(motion, "the integrator does not advance: the motion is not smooth", *t);
}

/* Whether custom forces brake so much faster than the motion goes on that Adams' short steps, a hundredth of their
 * time, would cost more than BDF's many. */
static bool is_braked(const imp_motion *motion, double t, double t_end, const imp_state *states)
{
    double turning;
    return imp_field_brake(motion->world, t, states, &turning) > 30 * turning + 50 / (t_end - t);
}

/* Which variable and which method the stretch needs. */
static impact_status choose_road(imp_motion *motion, double t, double t_end, const imp_state *states)
{
    if (motion->persist.count > 0) imp_persist_solve(&motion->persist, motion->world, states, motion->loads);
    motion->slip_scale = slip_scale(motion, states);
    grow_up(motion);
    motion->stiff = isfinite(slowest_slip(motion, true));
    const double grown = slowest_slip(motion, false);
    motion->sliding = isfinite(grown) && (!motion->stiff || grown < grown_up * motion->slip_scale);
    motion->sliding = motion->sliding || young_fades(motion);
    motion->creep_scale = creep_scale(motion, states);
    motion->creeping = motion->creep_scale > 0;
    const bool stiff = motion->stiff || is_braked(motion, t, t_end, states), other = motion->distrusted;
    motion->distrusted = false;
    return choose_integrator(motion, stiff != other ? IMPACT_ODE_BDF : IMPACT_ODE_ADAMS);
}

static double stretch_tolerance(const imp_motion *motion)
{
    double tolerance = motion->tolerance;
    if (motion->persist.count == 0)
        tolerance = fmin(tolerance, fmax(IMP_FLIGHT_TOLERANCE, IMP_FLIGHT_OF_TOLERANCE * tolerance));
    if (motion->bounces) tolerance = fmin(tolerance, IMP_BOUNCE_TOLERANCE);
    for (int c = 0; c < motion->persist.count; c++)
        if (motion->persist.touches[c].mode == IMP_SLIDE && motion->persist.touches[c].friction > 0)
            tolerance = fmin(tolerance, IMP_SLIDING_TOLERANCE);
    return tolerance;
}

static impact_status choose_tolerance(imp_motion *motion, const imp_state *states)
{
    motion->relative = stretch_tolerance(motion);
    imp_motion_measures(motion, states, motion->absolute);
    for (int i = 0; i < motion->size; i++) motion->absolute[i] *= IMP_ABSOLUTE_OF_RELATIVE * motion->relative;
    return impact_ode_set_tolerances(motion->ode, motion->relative, motion->absolute);
}

impact_status imp_motion_integrate(imp_motion *motion, double *t, double t_end, imp_state *states, imp_sampler *sampler,
                                   imp_end *end)
{
    memcpy(motion->scratch, states,
           sizeof *states * (size_t)motion->world->body_count); /* static bodies stand there too */
    imp_motion_set_slack(motion, states);
    impact_status status = choose_road(motion, *t, t_end, states);
    if (status != IMPACT_OK) return status;
    imp_motion_pack(motion, *t, states, motion->y);
    status = choose_tolerance(motion, states);
    if (status == IMPACT_OK) status = impact_ode_start(motion->ode, imp_motion_clocked(motion) ? 0 : *t, motion->y);
    if (status == IMPACT_OK && sampler->piece) status = imp_motion_trace_start(motion, *t, states);
    if (status != IMPACT_OK) return fail(motion, status, *t);
    status = integrate(motion, t, t_end, motion->y, states, sampler, end);
    imp_motion_unpack(motion, motion->y, states);
    motion->works.force = motion->y[Y_FORCE_WORK];
    motion->works.damping = motion->y[Y_DAMPING];
    motion->works.sliding = motion->y[Y_SLIDING];
    if (motion->world->driven) motion->works.drive = motion->y[imp_motion_drive(motion)];
    count_work(motion);
    return status;
}
