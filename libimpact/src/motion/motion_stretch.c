/* SPDX-License-Identifier: MIT
 *
 * Integration: which variable and method a stretch of it needs, its steps as segments, and the event at the end of one.
 */
#include "motion/motion_equations.h"
#include "motion/motion_guard.h"
#include "contact/persist_spot.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Slip faster than this part of the slip scale turns no faster than the motion goes. */
static const double grown_up = 1e-2;

impact_status imp_motion_make_room(imp_motion *motion)
{
    const imp_world *world = motion->world;
    int moving = 0;
    for (int i = 0; i < world->body_count; i++) moving += !world->bodies[i].is_static;
    int spots = 0;
    for (int p = 0; p < world->pair_count; p++) spots += imp_spot_suits(world, &world->pairs[p]);
    const int size = Y_BODIES + Y_PER_BODY * moving + Y_PER_SPOT * spots + world->driven;
    const int roots =
        ROOTS_PER_PAIR * world->pair_count + ROOTS_PER_EDGE * imp_field_edge_count(world) + world->body_count;
    if (motion->y && size == motion->size && roots == motion->roots) return IMPACT_OK;
    imp_motion_forget(motion);
    motion->size = size, motion->roots = roots;
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
    impact_status status = imp_motion_make_room(motion);
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
    const long starts = adams.starts + bdf.starts, steps = adams.steps + bdf.steps,
               calls = adams.rhs_calls + bdf.rhs_calls;
    impact_usage *usage = &motion->world->usage;
    usage->integrator_starts += starts - motion->counted.starts;
    usage->integrator_steps += steps - motion->counted.steps;
    usage->integrator_rhs_calls += calls - motion->counted.rhs_calls;
    motion->counted = (impact_ode_counts){.starts = starts, .steps = steps, .rhs_calls = calls};
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
    enum { CLOCK, FIELD_EDGE } kind;
    int index; /* edge */
    double t;  /* the clock's zero */
} last_step_function;

static double last_step_value(imp_motion *motion, last_step_function f, const double *y)
{
    if (f.kind == CLOCK) return y[Y_TIME] - f.t;
    imp_motion_unpack(motion, y, motion->scratch);
    return imp_field_edge(motion->world, y[Y_TIME], motion->scratch, f.index);
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

/* The event that a root stands for. */
static imp_end end_of_root(const imp_motion *motion, int root)
{
    const imp_world *world = motion->world;
    if (root < ROOTS_PER_PAIR * world->pair_count) {
        const int p = root / ROOTS_PER_PAIR, slot = root % ROOTS_PER_PAIR;
        if (slot == 0) return (imp_end){IMP_END_LIFTOFF, p};
        if (slot == 2) return (imp_end){IMP_END_BOUNDS, p};
        return (imp_end){world->pairs[p].mode == IMP_ROLL ? IMP_END_SLIP : IMP_END_STICK, p};
    }
    root -= ROOTS_PER_PAIR * world->pair_count;
    const int edges = ROOTS_PER_EDGE * imp_field_edge_count(world);
    if (root < edges) return (imp_end){IMP_END_EDGE, root / ROOTS_PER_EDGE};
    return (imp_end){IMP_END_SLOW, root - edges};
}

/* Whether a root is that of an edge's rate: its value is lowest here. If it is below zero, both its zeros lie in the
 * step. */
static bool is_lowest_point(const imp_motion *motion, int root, last_step_function *value)
{
    const int edge_root = root - ROOTS_PER_PAIR * motion->world->pair_count;
    *value = (last_step_function){.kind = FIELD_EDGE, .index = edge_root / ROOTS_PER_EDGE};
    return edge_root >= 0 && edge_root % ROOTS_PER_EDGE == 1 && value->index < imp_field_edge_count(motion->world);
}

/* Looks through the roots found at *tau for the event that ends the segment; a zero that the step hid moves *tau and y
 * back to it. */
static impact_status pick_event(imp_motion *motion, double tau_before, double *tau, double *y, imp_end *end)
{
    for (int root = 0; root < motion->roots; root++) {
        last_step_function value;
        if (motion->found[root] == 0) continue;
        if (!is_lowest_point(motion, root, &value)) {
            if (end->kind != IMP_END_TIME) continue;
            *end = end_of_root(motion, root);
            motion->found[root] = 0;
            continue;
        }
        if (last_step_value(motion, value, y) >= 0) continue;
        *end = (imp_end){IMP_END_EDGE, value.index};
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

/* What the integrator has to say is of its own insides. */
static impact_status fail(imp_motion *motion, impact_status status)
{
    if (status == IMPACT_EINTEGRATOR || status == IMPACT_EDOMAIN)
        return imp_motion_stuck(motion, "the integrator cannot go on: the motion is not smooth, or without bound,",
                                motion->stride.t);
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

/* What held contacts want: to be put back exactly, before a restart. */
static impact_status renew(imp_end *end)
{
    *end = (imp_end){IMP_END_RENEWAL, 0};
    return IMPACT_OK;
}

/* Held contacts drift apart otherwise, and forces may brake as they did not before. */
static impact_status look_back(imp_motion *motion, imp_end *end)
{
    enum { LOOK = 2000000, RENEWAL = 20000, CARRIED_RENEWAL = 500 };
    const double least = 1e-6; /* of the time left, gained in so many steps */
    const imp_stride *s = &motion->stride;
    const long renewal = motion->creeping ? CARRIED_RENEWAL : RENEWAL;
    if (s->steps % renewal != 0) return IMPACT_OK;
    const bool looks = s->steps >= LOOK; /* long runs are the caller's to stop, unless they get nowhere */
    if (looks && s->t - s->began < least * (s->t_end - s->began)) return too_rough(motion, s->began, s->t, LOOK);
    if (looks) motion->stride.steps = 0;
    return renew(end);
}

/* The part of the step that lies behind the end of the stretch is not taken. */
static impact_status cut_off(imp_motion *motion, double *y, imp_end *end)
{
    imp_stride *s = &motion->stride;
    if (!(y[Y_TIME] > s->t_end)) return IMPACT_OK;
    const impact_status status = interpolate_time(motion, s->t_end, &s->tau, y);
    y[Y_TIME] = s->t_end;
    *end = (imp_end){IMP_END_TIME, 0};
    memset(motion->found, 0, sizeof *motion->found * (size_t)motion->roots);
    return status;
}

/* Whether what the integrator follows changes at the end of this step, so that it begins anew; or the contacts have to
 * be put back. */
static void see_changes(imp_motion *motion, const double *y, imp_end *end)
{
    imp_stride *s = &motion->stride;
    if (end_onsets(motion)) {
        s->restart = true;
        if (modes_break(motion, s->t, y)) renew(end);
    }
    const bool grown = motion->stiff && slowest_slip(motion, true) > grown_up * motion->slip_scale;
    s->restart = s->restart || grown || (motion->stiff && !motion->sliding && young_fades(motion));
}

/* One step, to an event or to t_end at most; y at the end is the state at stride.t. */
static impact_status step_on(imp_motion *motion, double *y, imp_end *end)
{
    enum { MAX_STILL = 1000 };
    imp_stride *s = &motion->stride;
    const bool clocked = imp_motion_clocked(motion);
    const double tau_before = s->tau, stop = clocked ? 1000 * (s->t_end - s->from) + 1000 : s->t_end;
    bool found;
    *end = (imp_end){IMP_END_TIME, 0};
    impact_status status = imp_motion_step(motion, stop, &s->tau, y, &found);
    if (motion->message[0] != '\0') return IMPACT_EDOMAIN; /* a load was refused */
    if (status == IMPACT_EINTEGRATOR && s->passed) {       /* another root close by: begin anew from here */
        s->restart = true;
        return IMPACT_OK;
    }
    if (status == IMPACT_EINTEGRATOR && s->t > s->began && motion->persist.count > 0) return renew(end); /* a corner */
    if (status == IMPACT_OK && found) status = pick_event(motion, tau_before, &s->tau, y, end);
    if (status != IMPACT_OK) return fail(motion, status);
    if (!clocked) y[Y_TIME] = s->tau;
    status = cut_off(motion, y, end);
    if (status != IMPACT_OK) return fail(motion, status);
    if (!imp_motion_finite_or_back(motion, y))
        return imp_motion_stuck(motion, "the motion has left double precision", s->t);
    if (imp_motion_loss_falls(motion, y) && s->t > s->from && imp_motion_take_back(motion, y)) return renew(end);
    s->t = y[Y_TIME];
    s->steps++;
    if (!imp_motion_gains(motion, s->t))
        return imp_motion_stuck(motion, "time all but stands: 100000 steps were too short to tell", s->t);
    if (s->t >= s->t_end) s->restart = true;
    if (end->kind != IMP_END_TIME || s->restart) return IMPACT_OK;
    if (s->tau == stop) return renew(end); /* slip so slow that time all but stands, and that does not die out */
    see_changes(motion, y, end);
    if (s->restart) return IMPACT_OK;
    s->still = s->tau > tau_before ? 0 : s->still + 1;
    s->passed = found;
    if (s->still == MAX_STILL)
        return imp_motion_stuck(motion, "the integrator does not advance: the motion is not smooth", s->t);
    return look_back(motion, end);
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
    const double part = motion->persist.count == 0 ? IMP_FLIGHT_OF_TOLERANCE : IMP_HELD_OF_TOLERANCE;
    double tolerance = fmin(motion->tolerance, fmax(IMP_FLIGHT_TOLERANCE, part * motion->tolerance));
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

/* Whether an open pair touches: what bounced a moment ago is to come down where it falls. */
static bool has_bounced(const imp_motion *motion, const imp_state *states)
{
    imp_world *world = motion->world;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        const double touching = imp_world_touching_distance(world, pair, states);
        if (imp_is_held(pair) || pair->beyond || imp_world_distance_bound(world, pair, states) > touching) continue;
        impact_contact contact;
        imp_world_gap(world, pair, states, &contact);
        if (contact.gap <= touching) return true;
    }
    return false;
}

static impact_status start(imp_motion *motion, const imp_state *states)
{
    imp_stride *s = &motion->stride;
    motion->message[0] = '\0';
    if (!imp_motion_load(motion, s->t, states)) return IMPACT_EDOMAIN;
    memcpy(motion->scratch, states,
           sizeof *states * (size_t)motion->world->body_count); /* static bodies stand there too */
    motion->bounces = has_bounced(motion, states);
    impact_status status = choose_road(motion, s->t, s->t_end, states);
    if (status != IMPACT_OK) return status;
    imp_motion_pack(motion, s->t, states, motion->y);
    status = choose_tolerance(motion, states);
    s->tau = imp_motion_clocked(motion) ? 0 : s->t;
    s->from = s->t;
    s->still = 0;
    s->passed = s->restart = false;
    if (status == IMPACT_OK) status = impact_ode_start(motion->ode, s->tau, motion->y);
    return status == IMPACT_OK ? status : fail(motion, status);
}

/* ---- the step as a segment ---- */

/* Nothing moved: the state alone. */
static void keep_still(imp_dense *dense, const double *y)
{
    dense->terms = 1;
    dense->h = 0;
    memcpy(dense->c, y, sizeof *y * (size_t)dense->size);
}

/* y^(j) h^j/j! at the end of the step, as far as the method's order goes. */
static impact_status keep_step(imp_motion *motion, double t0, double t1)
{
    imp_dense *dense = &motion->dense;
    const impact_status status = imp_dense_reserve(dense, motion->world->arena, motion->size);
    if (status != IMPACT_OK) return status;
    double begin;
    impact_ode_last_step(motion->ode, &begin, &dense->end);
    dense->h = dense->end - begin;
    dense->t0 = t0, dense->t1 = t1;
    dense->size = motion->size;
    dense->clocked = imp_motion_clocked(motion);
    if (!(t1 > t0)) {
        keep_still(dense, motion->y);
        return IMPACT_OK;
    }
    double scale = 1;
    for (dense->terms = 0; dense->terms < IMP_DENSE_TERMS; dense->terms++) {
        double *c = dense->c + (size_t)dense->terms * (size_t)dense->size;
        if (impact_ode_interpolate(motion->ode, dense->end, dense->terms, c) != IMPACT_OK) break;
        for (int i = 0; i < dense->size; i++) c[i] *= scale;
        scale *= dense->h / (dense->terms + 1);
    }
    return dense->terms > 0 ? IMPACT_OK : IMPACT_EINTEGRATOR;
}

static imp_works works_of(const imp_motion *motion, const double *y)
{
    const double drive = motion->world->driven ? y[imp_motion_drive(motion)] : motion->works.drive;
    return (imp_works){y[Y_FORCE_WORK], y[Y_DAMPING], y[Y_SLIDING], drive};
}

imp_works imp_motion_works(const imp_motion *motion, double t)
{
    double y[Y_BODIES], drive = motion->works.drive;
    imp_dense_at(&motion->dense, t, 0, Y_BODIES, y);
    if (motion->world->driven) imp_dense_at(&motion->dense, t, imp_motion_drive(motion), 1, &drive);
    return (imp_works){y[Y_FORCE_WORK], y[Y_DAMPING], y[Y_SLIDING], drive};
}

void imp_motion_depart(imp_motion *motion, double t, double t_end, bool renewed)
{
    imp_stride *s = &motion->stride;
    if (!renewed) *s = (imp_stride){.began = t};
    s->t = t;
    s->t_end = fmin(t_end, imp_field_next_switch(motion->world));
    s->restart = true;
}

impact_status imp_motion_next(imp_motion *motion, imp_state *states, imp_end *end)
{
    const double t0 = motion->stride.t;
    if (motion->stride.restart) {
        const impact_status status = start(motion, states);
        if (status != IMPACT_OK) return status;
    }
    impact_status status = step_on(motion, motion->y, end);
    imp_motion_unpack(motion, motion->y, states);
    count_work(motion);
    if (status == IMPACT_OK && motion->stride.t >= imp_field_next_switch(motion->world)) {
        imp_field_enter(motion->world, motion->stride.t);
        if (end->kind == IMP_END_TIME) renew(end); /* other loads: which contacts hold? */
    }
    if (status == IMPACT_OK) status = keep_step(motion, t0, motion->stride.t);
    motion->works = works_of(motion, motion->y);
    return status;
}

void imp_motion_go_to(imp_motion *motion, double t, imp_state *states)
{
    if (t == motion->dense.t1) return; /* the states are there */
    imp_dense_at(&motion->dense, t, 0, motion->size, motion->kept);
    imp_motion_unpack(motion, motion->kept, states);
    motion->works = works_of(motion, motion->kept);
}

/* Contacts and pairs as they are, and back: to look must leave no traces. */
static bool keep_contacts(imp_motion *motion)
{
    imp_arena *arena = motion->world->arena;
    const int touches = motion->persist.count, pairs = motion->world->pair_count;
    imp_touch *kept = imp_arena_grow(arena, motion->kept_touches, &motion->kept_room[0], touches, sizeof *kept);
    if (kept) motion->kept_touches = kept;
    imp_pair *kept_pairs = imp_arena_grow(arena, motion->kept_pairs, &motion->kept_room[1], pairs, sizeof *kept_pairs);
    if (kept_pairs) motion->kept_pairs = kept_pairs;
    if (!kept || !kept_pairs) return false;
    memcpy(kept, motion->persist.touches, sizeof *kept * (size_t)touches);
    memcpy(kept_pairs, motion->world->pairs, sizeof *kept_pairs * (size_t)pairs);
    return true;
}

static void restore_contacts(imp_motion *motion)
{
    memcpy(motion->persist.touches, motion->kept_touches, sizeof *motion->kept_touches * (size_t)motion->persist.count);
    memcpy(motion->world->pairs, motion->kept_pairs, sizeof *motion->kept_pairs * (size_t)motion->world->pair_count);
}

impact_status imp_motion_look(imp_motion *motion, double t, imp_state *states)
{
    const bool held = motion->persist.count > 0;
    if (held && !keep_contacts(motion)) return IMPACT_ENOMEM;
    imp_dense_at(&motion->dense, t, 0, motion->size, motion->kept);
    imp_motion_unpack(motion, motion->kept, states);
    if (!held) return IMPACT_OK;
    const bool loaded = imp_motion_load(motion, t, states);
    if (loaded) imp_persist_project(&motion->persist, motion->world, states, motion->loads);
    restore_contacts(motion);
    return loaded ? IMPACT_OK : IMPACT_EDOMAIN;
}

impact_status imp_motion_touches(imp_motion *motion, double t, const imp_state *states, imp_touch *touches)
{
    imp_persist *persist = &motion->persist;
    const impact_usage usage = motion->world->usage;
    const bool lenient = persist->lenient, redundant = persist->redundant;
    if (persist->count == 0) return IMPACT_OK;
    if (!keep_contacts(motion)) return IMPACT_ENOMEM;
    const bool loaded = imp_motion_load(motion, t, states);
    if (loaded) imp_persist_solve(persist, motion->world, states, motion->loads);
    memcpy(touches, persist->touches, sizeof *touches * (size_t)persist->count);
    restore_contacts(motion);
    persist->lenient = lenient, persist->redundant = redundant;
    motion->world->usage = usage;
    return loaded ? IMPACT_OK : IMPACT_EDOMAIN;
}
