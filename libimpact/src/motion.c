/* SPDX-License-Identifier: MIT
 *
 * The integrated state is y = (t, works[3], (x, q, v, L) of each body that moves). While a contact slides, time is not the
 * variable of integration: with s the slip speed, du/dt is singular where s dies out, since the direction of slip turns ever faster.
 * In tau with dt/dtau = 1/(1 + sum slip_scale/s_i) the motion is smooth, s dies out exponentially, and no sign can flip.
 * Where slip begins from rest it has no direction but its acceleration's (persist.c); once it has, the direction is bound to the
 * acceleration the more stiffly the slower the slip is: BDF takes that stretch, in t.
 */
#include "motion.h"
#include "world_gap.h"

#include <impact/flight.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { Y_TIME, Y_FORCE_WORK, Y_DAMPING, Y_SLIDING, Y_BODIES, Y_PER_BODY = 13, ROOTS_PER_PAIR = 3 };

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

/* ---- samples ---- */

static double sample_time(const impact_sampler *sampler)
{
    return sampler->rate > 0 ? (double)sampler->next / sampler->rate : INFINITY;
}

/* Emits the states with the held contacts put back exactly. */
static impact_status emit(impact_motion *motion, impact_sampler *sampler, double t, const impact_state *states)
{
    sampler->next++;
    if (states != motion->sampled)
        memcpy(motion->sampled, states, sizeof *states * (size_t)motion->world->body_count);
    if (motion->persist.count > 0) {
        if (!impact_motion_load(motion, t, motion->sampled)) return IMPACT_EDOMAIN;
        impact_persist_project(&motion->persist, motion->world, motion->sampled, motion->loads);
    }
    return sampler->emit(sampler->context, t, motion->sampled) ? IMPACT_OK : IMPACT_STOPPED;
}

/* ---- flight in closed form ---- */

static bool is_ballistic(const impact_motion *motion, const impact_state *states)
{
    const impact_world *world = motion->world;
    if (motion->persist.count > 0 || impact_field_any(world)) return false;
    for (int i = 0; i < world->body_count; i++) {
        const impact_body *body = &world->bodies[i];
        const bool turns = states[i].momentum.x != 0 || states[i].momentum.y != 0 || states[i].momentum.z != 0;
        if (!body->is_static && turns && !(body->spherical && body->shape.kind == IMPACT_SPHERE)) return false;
    }
    return true;
}

static impact_state fly(const impact_world *world, int i, const impact_state *start, double dt)
{
    const impact_body *body = &world->bodies[i];
    if (body->is_static) return *start;
    const impact_flight flight = {start->x, start->q, start->v, impact_omega(body, start)};
    const impact_flight end = impact_flight_after(flight, world->gravity, dt);
    return (impact_state){end.position, end.orientation, end.velocity, start->momentum};
}

static void set_slack(impact_motion *motion, const impact_state *states)
{
    impact_world *world = motion->world;
    for (int p = 0; p < world->pair_count; p++)
        world->pairs[p].slack = impact_world_touching_distance(world, &world->pairs[p], states);
}

/* Time until the pair's gap falls to zero (or, beyond a plane's bounds, until it rises to it), or infinity. With the normal held fixed
 * the gap of two bodies that do not turn is bounded below by a parabola, which each step falls down: no contact can be missed, and
 * against a plane the first step is exact. */
static double time_to_contact(impact_motion *motion, impact_pair *pair, const impact_state *start, double horizon)
{
    enum { STEPS = 200 };
    impact_world *world = motion->world;
    impact_state *states = motion->scratch;
    const double sign = pair->beyond ? -1 : 1;
    double dt = 0;
    for (int i = 0; i < STEPS; i++) {
        states[pair->body1] = fly(world, pair->body1, &start[pair->body1], dt);
        states[pair->body2] = fly(world, pair->body2, &start[pair->body2], dt);
        impact_contact contact;
        impact_world_gap(world, pair, states, &contact);
        const double rate = qvec3_dot(contact.normal, qvec3_sub(states[pair->body1].v, states[pair->body2].v));
        const double acceleration = world->bodies[pair->body2].is_static ? qvec3_dot(contact.normal, world->gravity) : 0;
        const bool grazes = dt == 0 && fabs(contact.gap) <= pair->slack && fabs(rate) <= world->slip_speed;
        const double gap = grazes ? pair->slack : sign * contact.gap;
        const double step = impact_flight_fall_time(gap, sign * rate, sign * acceleration);
        if (!(dt + step <= horizon)) return INFINITY;
        if (dt + step == dt) return dt;
        dt += step;
    }
    return dt;
}

static impact_status advance_ballistic(impact_motion *motion, double *t, double t_end, impact_state *states,
                                       impact_sampler *sampler, impact_end *end)
{
    impact_world *world = motion->world;
    double dt = t_end - *t;
    set_slack(motion, states);
    *end = (impact_end){IMPACT_END_TIME, 0};
    for (int p = 0; p < world->pair_count; p++) {
        const double contact = time_to_contact(motion, &world->pairs[p], states, dt);
        if (contact > dt || (contact == dt && end->kind != IMPACT_END_TIME)) continue;
        dt = contact;
        *end = (impact_end){world->pairs[p].beyond ? IMPACT_END_RETURN : IMPACT_END_GAP, p};
    }
    const double t_event = end->kind == IMPACT_END_TIME ? t_end : *t + dt;
    world->usage.ballistic_flights++;
    while (sample_time(sampler) <= t_event) {
        for (int i = 0; i < world->body_count; i++) motion->sampled[i] = fly(world, i, &states[i], sample_time(sampler) - *t);
        const impact_status status = emit(motion, sampler, sample_time(sampler), motion->sampled);
        if (status == IMPACT_OK) continue;
        *end = (impact_end){IMPACT_END_TIME, 0};
        return status;
    }
    for (int i = 0; i < world->body_count; i++) states[i] = fly(world, i, &states[i], dt);
    *t = t_event;
    return IMPACT_OK;
}

/* ---- the integrated state ---- */

static void pack(const impact_motion *motion, double t, const impact_state *states, double *y)
{
    y[Y_TIME] = t;
    y[Y_FORCE_WORK] = motion->works.force;
    y[Y_DAMPING] = motion->works.damping;
    y[Y_SLIDING] = motion->works.sliding;
    double *b = y + Y_BODIES;
    for (int i = 0; i < motion->world->body_count; i++) {
        if (motion->world->bodies[i].is_static) continue;
        const impact_state *s = &states[i];
        const double values[Y_PER_BODY] = {s->x.x, s->x.y, s->x.z, s->q.w, s->q.x, s->q.y, s->q.z,
                                           s->v.x, s->v.y, s->v.z, s->momentum.x, s->momentum.y, s->momentum.z};
        memcpy(b, values, sizeof values);
        b += Y_PER_BODY;
    }
}

/* Static bodies' states are left as they are. */
static void unpack(const impact_motion *motion, const double *y, impact_state *states)
{
    const double *b = y + Y_BODIES;
    for (int i = 0; i < motion->world->body_count; i++) {
        if (motion->world->bodies[i].is_static) continue;
        impact_state *s = &states[i];
        s->x = (qvec3){b[0], b[1], b[2]};
        quat_normalize((quat){b[3], b[4], b[5], b[6]}, &s->q);
        s->v = (qvec3){b[7], b[8], b[9]};
        s->momentum = (qvec3){b[10], b[11], b[12]};
        b += Y_PER_BODY;
    }
}

/* dt/dtau. */
static double clock_rate(const impact_motion *motion)
{
    if (!motion->sliding) return 1;
    double slowness = 1;
    for (int c = 0; c < motion->persist.count; c++)
        if (motion->persist.touches[c].mode == IMPACT_SLIDE && !motion->persist.touches[c].onset)
            slowness += motion->slip_scale / motion->persist.touches[c].speed;
    return 1 / slowness;
}

static void body_rates(const impact_body *body, const impact_state *s, qvec3 force, qvec3 torque, double clock, double *rate)
{
    const qvec3 omega = impact_omega(body, s);
    const quat turning = quat_mul((quat){0, omega.x, omega.y, omega.z}, s->q);
    const double values[Y_PER_BODY] = {s->v.x, s->v.y, s->v.z, 0.5 * turning.w, 0.5 * turning.x, 0.5 * turning.y, 0.5 * turning.z,
                                       force.x * body->inverse_mass, force.y * body->inverse_mass, force.z * body->inverse_mass,
                                       torque.x, torque.y, torque.z};
    for (int k = 0; k < Y_PER_BODY; k++) rate[k] = clock * values[k];
}

static int rates(double tau, const double *y, double *rate, void *context)
{
    impact_motion *motion = context;
    impact_world *world = motion->world;
    unpack(motion, y, motion->scratch);
    if (!impact_motion_load(motion, motion->sliding ? y[Y_TIME] : tau, motion->scratch)) return -1;
    rate[Y_FORCE_WORK] = rate[Y_DAMPING] = rate[Y_SLIDING] = 0;
    for (int i = 0; i < world->body_count; i++) {
        rate[Y_FORCE_WORK] += motion->loads[i].work_rate;
        rate[Y_DAMPING] += motion->loads[i].damping_rate;
    }
    if (motion->persist.count > 0) impact_persist_solve(&motion->persist, world, motion->scratch, motion->loads);
    for (int c = 0; c < motion->persist.count; c++)
        if (motion->persist.touches[c].mode == IMPACT_SLIDE)
            rate[Y_SLIDING] -= qvec3_dot(motion->persist.touches[c].force, motion->persist.touches[c].slip);
    impact_persist_add_reactions(&motion->persist, motion->loads);
    const double clock = clock_rate(motion);
    rate[Y_TIME] = clock;
    for (int k = Y_FORCE_WORK; k < Y_BODIES; k++) rate[k] *= clock;
    double *b = rate + Y_BODIES;
    for (int i = 0; i < world->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        body_rates(&world->bodies[i], &motion->scratch[i], motion->loads[i].force, motion->loads[i].torque, clock, b);
        b += Y_PER_BODY;
    }
    return 0;
}

/* ---- roots: every one falls through zero when its event comes ---- */

/* The gap with its slack, and minus its rate. Far apart, of the bounding balls: positive either way. */
static void open_pair_roots(impact_world *world, impact_pair *pair, const impact_state *states, double *value)
{
    const double bound = impact_world_distance_bound(world, pair, states);
    if (bound > world->bodies[pair->body1].radius) {
        value[0] = pair->beyond ? -bound : bound;
        value[1] = 1;
        return;
    }
    impact_contact contact;
    impact_world_gap(world, pair, states, &contact);
    value[0] = pair->beyond ? -contact.gap : contact.gap + pair->slack;
    value[1] = pair->beyond ? 1 : -impact_world_gap_rate(world, pair, states, &contact);
}

static void held_pair_roots(impact_world *world, const impact_touch *touch, const impact_state *states, double *value)
{
    const impact_contact contact = {.offset2 = touch->r2};
    value[0] = touch->pressure;
    value[1] = touch->mode == IMPACT_ROLL ? touch->margin : touch->onset ? touch->drive - (1 - 1e-9) : touch->speed - world->slip_speed;
    value[2] = impact_world_inside_bounds(world, &world->pairs[touch->pair], states, &contact);
    if (!isfinite(value[2])) value[2] = 1;
}

/* How fast any point of the body moves, m/s. */
static double speed_of(const impact_body *body, const impact_state *state)
{
    return qvec3_norm(state->v) + body->radius * qvec3_norm(impact_omega(body, state));
}

static int root_values(double tau, const double *y, double *value, void *context)
{
    impact_motion *motion = context;
    impact_world *world = motion->world;
    impact_state *states = motion->scratch;
    unpack(motion, y, states);
    if (motion->persist.count > 0) {
        if (!impact_motion_load(motion, motion->sliding ? y[Y_TIME] : tau, states)) return -1;
        impact_persist_solve(&motion->persist, world, states, motion->loads);
    }
    for (int p = 0, c = 0; p < world->pair_count; p++, value += ROOTS_PER_PAIR) {
        value[2] = 1;
        if (impact_is_held(&world->pairs[p]))
            held_pair_roots(world, &motion->persist.touches[c++], states, value);
        else
            open_pair_roots(world, &world->pairs[p], states, value);
    }
    impact_field_edges(world, states, value);
    value += impact_field_edge_count(world);
    for (int i = 0; i < world->body_count; i++)
        value[i] = motion->resting[i] ? 1 : speed_of(&world->bodies[i], &states[i]) - motion->rest_speed;
    return 0;
}

/* ---- one stretch of integration ---- */

static impact_status allocate_state(impact_motion *motion)
{
    const impact_world *world = motion->world;
    if (motion->y) return IMPACT_OK;
    int moving = 0;
    for (int i = 0; i < world->body_count; i++) moving += !world->bodies[i].is_static;
    motion->size = Y_BODIES + Y_PER_BODY * moving;
    motion->roots = ROOTS_PER_PAIR * world->pair_count + impact_field_edge_count(world) + world->body_count;
    motion->kept = calloc((size_t)motion->size, sizeof *motion->kept);
    motion->found = calloc((size_t)motion->roots, sizeof *motion->found);
    motion->y = calloc((size_t)motion->size, sizeof *motion->y);
    return motion->kept && motion->y && motion->found ? IMPACT_OK : IMPACT_ENOMEM;
}

/* Makes the integrator of the method the one at work, creating it when it is first needed. */
static impact_status choose_integrator(impact_motion *motion, impact_ode_method method)
{
    impact_ode **ode = method == IMPACT_ODE_ADAMS ? &motion->adams : &motion->bdf;
    impact_status status = allocate_state(motion);
    if (status == IMPACT_OK && !*ode) {
        const impact_ode_def def = {.size = motion->size, .roots = motion->roots, .rhs = rates, .root_functions = root_values,
                                    .context = motion, .method = method, .relative_tolerance = motion->tolerance,
                                    .absolute_tolerance = 1e-2 * motion->tolerance, .falling_roots_only = true};
        status = impact_ode_create(&def, ode);
        if (status == IMPACT_EABSENT)
            snprintf(motion->message, sizeof motion->message,
                     "this motion needs the integrator, and this build has none (IMPACT_WITH_CVODE is off)");
        motion->world->usage.integrators += status == IMPACT_OK;
    }
    motion->ode = *ode;
    return status;
}

static void count_work(impact_motion *motion)
{
    impact_ode_counts adams = {0}, bdf = {0};
    if (motion->adams) adams = impact_ode_count(motion->adams);
    if (motion->bdf) bdf = impact_ode_count(motion->bdf);
    impact_usage *usage = &motion->world->usage;
    usage->integrator_starts = adams.starts + bdf.starts;
    usage->integrator_steps = adams.steps + bdf.steps;
    usage->integrator_rhs_calls = adams.rhs_calls + bdf.rhs_calls;
}

static bool any_onset(const impact_motion *motion)
{
    for (int c = 0; c < motion->persist.count; c++)
        if (motion->persist.touches[c].onset) return true;
    return false;
}

/* The slowest slip, as the touches stand, of the contacts that slide past their onset, m/s; infinite when none does. */
static double slowest_slip(const impact_motion *motion)
{
    double slowest = INFINITY;
    for (int c = 0; c < motion->persist.count; c++) {
        const impact_touch *touch = &motion->persist.touches[c];
        if (touch->mode == IMPACT_SLIDE && !touch->onset) slowest = fmin(slowest, touch->speed);
    }
    return slowest;
}

/* Ends the onset of every contact that slides fast enough to have a direction of its own; tells whether one did. */
static bool end_onsets(impact_motion *motion)
{
    bool ended = false;
    for (int c = 0; c < motion->persist.count; c++) {
        const impact_touch *touch = &motion->persist.touches[c];
        if (!touch->onset || touch->speed < motion->world->onset_speed) continue;
        motion->world->pairs[touch->pair].onset = false;
        ended = true;
    }
    return ended;
}

/* The speed below which slip slows the clock: small against the motion and the weight of the sliding bodies. */
static double slip_scale(const impact_motion *motion, const impact_state *states)
{
    double scale = 0;
    for (int c = 0; c < motion->persist.count; c++) {
        const impact_touch *touch = &motion->persist.touches[c];
        if (touch->mode != IMPACT_SLIDE) continue;
        const impact_body *body = &motion->world->bodies[touch->body1];
        const double fall = fabs(touch->pressure) * body->inverse_mass * body->radius;
        scale = fmax(scale, 0.05 * (speed_of(body, &states[touch->body1]) + sqrt(fall)));
    }
    return fmax(scale, motion->world->slip_speed);
}

/* The function of the interpolated state whose zero is looked for in the last step: the clock against a time, or a pair's gap. */
typedef struct last_step_function {
    int pair; /* or -1: the clock */
    double t;
} last_step_function;

static double last_step_value(impact_motion *motion, last_step_function f, const double *y)
{
    if (f.pair < 0) return y[Y_TIME] - f.t;
    impact_contact contact;
    unpack(motion, y, motion->scratch);
    impact_world_gap(motion->world, &motion->world->pairs[f.pair], motion->scratch, &contact);
    return contact.gap;
}

/* Interpolates the last step where f changes sign between tau = low and high, by the Illinois form of regula falsi. */
static impact_status find_in_last_step(impact_motion *motion, last_step_function f, double low, double high, double *tau, double *y)
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

/* The state of the last step at time t. */
static impact_status interpolate_time(impact_motion *motion, double t, double *y)
{
    if (!motion->sliding) return impact_ode_interpolate(motion->ode, t, 0, y);
    double low, high, tau;
    impact_ode_last_step(motion->ode, &low, &high);
    return find_in_last_step(motion, (last_step_function){-1, t}, low, high, &tau, y);
}

/* The event that a root stands for; how deep a gap's closest approach is tells whether its rate's root is one. */
static impact_end end_of_root(const impact_motion *motion, int root)
{
    const impact_world *world = motion->world;
    if (root < ROOTS_PER_PAIR * world->pair_count) {
        const int p = root / ROOTS_PER_PAIR, slot = root % ROOTS_PER_PAIR;
        const impact_pair *pair = &world->pairs[p];
        if (!impact_is_held(pair)) return (impact_end){pair->beyond ? IMPACT_END_RETURN : IMPACT_END_GAP, p};
        if (slot == 0) return (impact_end){IMPACT_END_LIFTOFF, p};
        if (slot == 2) return (impact_end){IMPACT_END_BOUNDS, p};
        return (impact_end){pair->mode == IMPACT_ROLL ? IMPACT_END_SLIP : IMPACT_END_STICK, p};
    }
    root -= ROOTS_PER_PAIR * world->pair_count;
    const int edges = impact_field_edge_count(world);
    if (root < edges) return (impact_end){IMPACT_END_EDGE, root};
    return (impact_end){IMPACT_END_SLOW, root - edges};
}

/* A root of an open pair's gap rate: the gap is smallest here. If it is below its slack, both its zeros lie in the step. */
static bool is_closest_approach(const impact_motion *motion, int root)
{
    return root < ROOTS_PER_PAIR * motion->world->pair_count && root % ROOTS_PER_PAIR == 1 &&
           !impact_is_held(&motion->world->pairs[root / ROOTS_PER_PAIR]);
}

/* Looks through the roots found at *tau for the event that ends the stretch; a gap's zero that the step hid moves *tau and y back to it. */
static impact_status pick_event(impact_motion *motion, double tau_before, double *tau, double *y, impact_end *end)
{
    for (int root = 0; root < motion->roots; root++) {
        if (motion->found[root] == 0) continue;
        if (!is_closest_approach(motion, root)) {
            if (end->kind != IMPACT_END_TIME) continue;
            *end = end_of_root(motion, root);
            motion->found[root] = 0;
            continue;
        }
        const int pair = root / ROOTS_PER_PAIR;
        if (last_step_value(motion, (last_step_function){pair, 0}, y) >= -motion->world->pairs[pair].slack) continue;
        *end = (impact_end){IMPACT_END_GAP, pair};
        memset(motion->found, 0, sizeof *motion->found * (size_t)motion->roots); /* of later times */
        return find_in_last_step(motion, (last_step_function){pair, 0}, tau_before, *tau, tau, y);
    }
    return IMPACT_OK;
}

bool impact_motion_also_crossed(impact_motion *motion, impact_end *end)
{
    const int first = ROOTS_PER_PAIR * motion->world->pair_count, edges = impact_field_edge_count(motion->world);
    for (int edge = 0; motion->found && edge < edges; edge++) {
        if (motion->found[first + edge] == 0) continue;
        motion->found[first + edge] = 0;
        *end = (impact_end){IMPACT_END_EDGE, edge};
        return true;
    }
    return false;
}

/* From the root that was watched for, the slack below zero and to 1e-14 of the step, one Newton step back to where the gap is zero. */
static impact_status polish_gap(impact_motion *motion, int pair, double *tau, double *y)
{
    impact_world *world = motion->world;
    impact_contact contact;
    unpack(motion, y, motion->scratch);
    impact_world_gap(world, &world->pairs[pair], motion->scratch, &contact);
    const double rate = impact_world_gap_rate(world, &world->pairs[pair], motion->scratch, &contact) * clock_rate(motion);
    double low, high;
    impact_ode_last_step(motion->ode, &low, &high);
    const double polished = *tau - contact.gap / rate;
    if (!(polished >= low && polished <= high) || rate >= 0) return IMPACT_OK; /* a gap that was never open */
    *tau = polished;
    return impact_ode_interpolate(motion->ode, polished, 0, y);
}

static impact_status emit_until(impact_motion *motion, double t, impact_state *states, impact_sampler *sampler, double *y)
{
    while (sample_time(sampler) <= t) {
        impact_status status = interpolate_time(motion, sample_time(sampler), y);
        if (status != IMPACT_OK) return status;
        unpack(motion, y, states);
        status = emit(motion, sampler, sample_time(sampler), states);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

static impact_status fail(impact_motion *motion, impact_status status)
{
    if (motion->message[0] == '\0') snprintf(motion->message, sizeof motion->message, "%s", impact_ode_message(motion->ode));
    return status;
}

/* Steps until an event or t_end; y at the end is the state at *t. */
static impact_status integrate(impact_motion *motion, double *t, double t_end, double *y, impact_state *states,
                               impact_sampler *sampler, impact_end *end)
{
    enum { MAX_STILL = 1000 };
    int still = 0;
    double tau = motion->sliding ? 0 : *t;
    const double stop = motion->sliding ? 1000 * (t_end - *t) + 1000 : t_end;
    *end = (impact_end){IMPACT_END_TIME, 0};
    while (still < MAX_STILL) {
        const double tau_before = tau;
        bool found;
        impact_status status = impact_ode_step(motion->ode, stop, &tau, y, motion->found, &found);
        if (motion->message[0] != '\0') return IMPACT_EDOMAIN; /* a load was refused */
        if (status == IMPACT_OK && found) status = pick_event(motion, tau_before, &tau, y, end);
        if (status == IMPACT_OK && end->kind == IMPACT_END_GAP) status = polish_gap(motion, end->index, &tau, y);
        if (status != IMPACT_OK) return fail(motion, status);
        if (!motion->sliding) y[Y_TIME] = tau;
        if (y[Y_TIME] > t_end) {
            status = interpolate_time(motion, t_end, y);
            if (status != IMPACT_OK) return fail(motion, status);
            y[Y_TIME] = t_end;
            *end = (impact_end){IMPACT_END_TIME, 0};
            memset(motion->found, 0, sizeof *motion->found * (size_t)motion->roots);
        }
        *t = y[Y_TIME];
        memcpy(motion->kept, y, sizeof *y * (size_t)motion->size); /* samples overwrite y */
        status = emit_until(motion, *t, states, sampler, y);
        memcpy(y, motion->kept, sizeof *y * (size_t)motion->size);
        if (status == IMPACT_OK && !sampler->pulse(sampler->context, *t)) status = IMPACT_STOPPED;
        if (status != IMPACT_OK || *t >= t_end || end->kind != IMPACT_END_TIME || tau == stop) return status;
        if (end_onsets(motion) || (motion->stiff && slowest_slip(motion) > 1e-2 * motion->slip_scale)) return IMPACT_OK;
        still = tau > tau_before ? 0 : still + 1;
    }
    snprintf(motion->message, sizeof motion->message, "the integrator cannot get past t = %.17g: the motion is not smooth there", *t);
    return IMPACT_EUNSETTLED;
}

/* Which variable and which method the stretch needs. */
static impact_status choose_road(impact_motion *motion, const impact_state *states)
{
    if (motion->persist.count > 0) impact_persist_solve(&motion->persist, motion->world, states, motion->loads);
    const double slowest = slowest_slip(motion);
    motion->slip_scale = slip_scale(motion, states);
    motion->stiff = motion->after_onset && slowest < 1e-2 * motion->slip_scale;
    motion->after_onset = any_onset(motion);
    motion->sliding = isfinite(slowest) && !motion->stiff;
    return choose_integrator(motion, motion->stiff ? IMPACT_ODE_BDF : IMPACT_ODE_ADAMS);
}

static impact_status advance_integrated(impact_motion *motion, double *t, double t_end, impact_state *states,
                                        impact_sampler *sampler, impact_end *end)
{
    memcpy(motion->scratch, states, sizeof *states * (size_t)motion->world->body_count); /* static bodies stand there too */
    set_slack(motion, states);
    impact_status status = choose_road(motion, states);
    if (status != IMPACT_OK) return status;
    pack(motion, *t, states, motion->y);
    status = impact_ode_start(motion->ode, motion->sliding ? 0 : *t, motion->y);
    if (status != IMPACT_OK) return fail(motion, status);
    status = integrate(motion, t, t_end, motion->y, states, sampler, end);
    unpack(motion, motion->y, states);
    motion->works = (impact_works){motion->y[Y_FORCE_WORK], motion->y[Y_DAMPING], motion->y[Y_SLIDING]};
    count_work(motion);
    return status;
}

impact_status impact_motion_advance(impact_motion *motion, double *t, double t_end, impact_state *states, impact_sampler *sampler,
                                    impact_end *end)
{
    motion->message[0] = '\0';
    if (is_ballistic(motion, states)) return advance_ballistic(motion, t, t_end, states, sampler, end);
    if (!impact_motion_load(motion, *t, states)) return IMPACT_EDOMAIN;
    return advance_integrated(motion, t, t_end, states, sampler, end);
}
