/* SPDX-License-Identifier: MIT
 *
 * Integration: a stretch of it from step to step, and the event at the end of one.
 */
#include "motion/motion_stretch.h"
#include "base/bracket.h"
#include "base/number.h"
#include "motion/motion_guard.h"
#include "world/corner.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

/* Ends the incipient slip of every contact that slides fast enough to have a direction of its own; tells whether one
 * did. */
static bool end_incipient(imp_motion *motion)
{
    bool ended = false;
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        if (!contact->incipient || contact->speed < motion->world->incipient_speed) continue;
        motion->world->pairs[contact->pair].slip.stage = IMP_SLIP_SLOW;
        ended = true;
    }
    return ended;
}

/* The function of the interpolated state whose zero is looked for in the last step. */
typedef struct last_step_function {
    enum { CLOCK, FIELD_EDGE, CLEARANCE } kind;
    int index; /* edge; pair */
    double t;  /* the clock's zero */
} last_step_function;

static double last_step_value(imp_motion *motion, last_step_function f, const double *y)
{
    if (f.kind == CLOCK) return y[Y_TIME] - f.t;
    imp_motion_unpack(motion, y, motion->scratch);
    if (f.kind == CLEARANCE)
        return imp_corner_clearance(motion->world, &motion->world->pairs[f.index], motion->scratch);
    return imp_field_edge(motion->world, y[Y_TIME], motion->scratch, f.index);
}

/* Interpolates the last step where f changes sign between tau = low and high, by regula falsi (base/bracket.h). */
static impact_status find_in_last_step(imp_motion *motion, last_step_function f, double low, double high, double *tau,
                                       double *y)
{
    impact_status status = impact_ode_interpolate(motion->ode, low, 0, y);
    imp_bracket b = {.low = low, .high = high, .at_low = last_step_value(motion, f, y)};
    if (status == IMPACT_OK) status = impact_ode_interpolate(motion->ode, high, 0, y);
    b.at_high = last_step_value(motion, f, y);
    *tau = high;
    for (int i = 0; status == IMPACT_OK && i < IMP_BRACKET_MOST && b.at_high != b.at_low; i++) {
        const double guess = imp_bracket_guess(&b);
        if (guess == b.low || guess == b.high || guess == *tau) break;
        *tau = guess;
        status = impact_ode_interpolate(motion->ode, guess, 0, y);
        const double value = last_step_value(motion, f, y);
        if (value == 0) break;
        imp_bracket_take(&b, guess, value, (value > 0) == (b.at_high > 0));
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
        return (imp_end){world->pairs[p].mode == IMP_STICK ? IMP_END_SLIP : IMP_END_STICK, p};
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

/* Where held rims stand, and have gone on round to; not where one has changed over: that passed flat, by less yet than
 * a landing's root. */
static void follow_sides(imp_world *world, const imp_state *states)
{
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        const bool stands = pair->site.corner > 0 && imp_is_held(pair);
        const qvec3 side = stands ? imp_corner_side(world, pair, states) : (qvec3){0, 0, 0};
        const bool known = pair->site.side.x != 0 || pair->site.side.y != 0;
        if (!stands || !known || qvec3_dot(side, pair->site.side) > 0) pair->site.side = side;
    }
}

/* A corner lands where its height is 0: its root, which no rounding is to find, lies a little below. One that left the
 * ground where the step began is highest about the middle. */
static impact_status find_landing(imp_motion *motion, int p, double tau_before, double *tau, double *y)
{
    const last_step_function height = {.kind = CLEARANCE, .index = p};
    const double at = *tau, above[] = {tau_before, 0.5 * (tau_before + at)};
    impact_status status = IMPACT_OK;
    for (int k = 0; k < 2 && status == IMPACT_OK; k++) {
        status = impact_ode_interpolate(motion->ode, above[k], 0, y);
        if (status == IMPACT_OK && last_step_value(motion, height, y) > 0)
            return find_in_last_step(motion, height, above[k], at, tau, y);
    }
    return status == IMPACT_OK ? impact_ode_interpolate(motion->ode, at, 0, y) : status;
}

/* Whether other corners of a pair's are down at y, within the distance that touches: what presses otherwise than
 * before where a rim is flat, and its lowest place changes over, is the landing's to change. */
static bool lands(imp_motion *motion, int p, const double *y)
{
    const imp_pair *pair = &motion->world->pairs[p];
    if (!imp_is_held(pair) || pair->site.corner == 0) return false;
    imp_motion_unpack(motion, y, motion->scratch);
    return imp_corner_clearance(motion->world, pair, motion->scratch) <=
           imp_world_touching_distance(motion->world, pair, motion->scratch);
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
            if (end->kind != IMP_END_BOUNDS || motion->world->pairs[end->index].site.corner == 0) continue;
            memset(motion->found, 0, sizeof *motion->found * (size_t)motion->roots); /* of later times */
            return find_landing(motion, end->index, tau_before, tau, y);
        }
        if (last_step_value(motion, value, y) >= 0) continue;
        *end = (imp_end){IMP_END_EDGE, value.index};
        memset(motion->found, 0, sizeof *motion->found * (size_t)motion->roots); /* of later times */
        return find_in_last_step(motion, value, tau_before, *tau, tau, y);
    }
    const bool changes = end->kind == IMP_END_LIFTOFF || end->kind == IMP_END_SLIP || end->kind == IMP_END_STICK;
    for (int p = 0; changes && p < motion->world->pair_count; p++)
        if (lands(motion, p, y)) *end = (imp_end){IMP_END_BOUNDS, p};
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
        return imp_motion_stuck(
            motion,
            imp_motion_has_custom_force(motion->world)
                ? "the integrator cannot go on: the motion is not smooth (where a force's law jumps "
                  "tell it: switches in time, edge elsewhere), or without bound,"
                : "the integrator cannot go on: the motion is not smooth, or without bound,",
            motion->stride.t);
    return status;
}

static impact_status too_rough(imp_motion *motion, double from, double to, long steps)
{
    char what[200];
    snprintf(what, sizeof what,
             "%ld steps from t = %s got nowhere: the motion is too rough (a face that rocks, or masses too different "
             "that press on each other?)",
             steps, imp_number_of(from).text);
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
    const imp_stride *s = &motion->stride;
    const long renewal = motion->following ? CARRIED_RENEWAL : RENEWAL;
    if (s->steps % renewal != 0) return IMPACT_OK;
    const bool looks = s->steps >= LOOK; /* long runs are the caller's to stop, unless they get nowhere */
    if (looks && s->t - s->began < IMP_LEAST_GAIN * (s->t_end - s->began))
        return too_rough(motion, s->began, s->t, LOOK);
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
static void see_changes(imp_motion *motion, imp_end *end)
{
    imp_stride *s = &motion->stride;
    const bool ended = end_incipient(motion);
    if (ended) renew(end); /* friction turns with the slip from here: what rolls beside it may have slipped a little */
    s->restart = ended || imp_motion_outgrows(motion);
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
    if (status == IMPACT_EINTEGRATOR && s->t > s->began && motion->held.count > 0) return renew(end); /* a corner */
    if (status == IMPACT_OK && found) status = pick_event(motion, tau_before, &s->tau, y, end);
    if (status != IMPACT_OK) return fail(motion, status);
    if (!clocked) y[Y_TIME] = s->tau;
    status = cut_off(motion, y, end);
    if (status != IMPACT_OK) return fail(motion, status);
    if (!imp_motion_finite_or_back(motion, y))
        return imp_motion_stuck(motion, "the motion has left double precision", s->t);
    if (imp_motion_loss_falls(motion, y) && s->t > s->from && imp_motion_take_back(motion, y)) return renew(end);
    s->t = y[Y_TIME];
    s->stood = s->tau - tau_before <= IMP_ROUNDOFF * fabs(s->t);
    s->steps++;
    if (!imp_motion_gains(motion, s->t))
        return imp_motion_stuck(motion, "time all but stands: 100000 steps were too short to tell", s->t);
    if (s->t >= s->t_end) s->restart = true;
    if (end->kind != IMP_END_TIME || s->restart) return IMPACT_OK;
    if (s->tau == stop) return renew(end); /* slip so slow that time all but stands, and that does not die out */
    see_changes(motion, end);
    if (s->restart) return IMPACT_OK;
    s->still = s->tau > tau_before ? 0 : s->still + 1;
    s->passed = found;
    if (s->still == MAX_STILL)
        return imp_motion_stuck(motion, "the integrator does not advance: the motion is not smooth", s->t);
    return look_back(motion, end);
}

/* What a landing or a rounding left of other corners below those that are held: they land where they sink further. */
static void find_sunk_corners(imp_world *world, const imp_state *states)
{
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        if (pair->site.corner > 0 && imp_is_held(pair))
            pair->site.sunk = fmin(0, imp_corner_clearance(world, pair, states));
    }
}

static impact_status start(imp_motion *motion, const imp_state *states)
{
    imp_stride *s = &motion->stride;
    motion->message[0] = '\0';
    if (!imp_motion_load(motion, s->t, states)) return IMPACT_EDOMAIN;
    memcpy(motion->scratch, states,
           sizeof *states * (size_t)motion->world->body_count); /* static bodies stand there too */
    follow_sides(motion->world, states);
    find_sunk_corners(motion->world, states);
    impact_status status = imp_motion_choose(motion, states);
    if (status != IMPACT_OK) return status;
    imp_motion_pack(motion, s->t, states, motion->y);
    s->tau = imp_motion_clocked(motion) ? 0 : s->t;
    s->from = s->t;
    s->still = 0;
    s->passed = s->restart = false;
    status = impact_ode_start(motion->ode, s->tau, motion->y);
    return status == IMPACT_OK ? status : fail(motion, status);
}

void imp_motion_depart(imp_motion *motion, double t, double t_end, bool renewed)
{
    imp_stride *s = &motion->stride;
    if (!renewed) *s = (imp_stride){.began = t};
    s->t = t;
    imp_field_enter(motion->world, t);
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
    follow_sides(motion->world, states);
    imp_motion_count_work(motion);
    if (status == IMPACT_OK && motion->stride.t >= imp_field_next_switch(motion->world)) {
        imp_field_enter(motion->world, motion->stride.t);
        if (end->kind == IMP_END_TIME) renew(end); /* other loads: which contacts hold? */
    }
    if (status == IMPACT_OK) status = imp_motion_keep_step(motion, t0, motion->stride.t);
    motion->works = imp_motion_works_of(motion, motion->y);
    return status;
}
