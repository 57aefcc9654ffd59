/* SPDX-License-Identifier: MIT */
#include "motion/pile.h"
#include "motion/pile_parts.h"
#include "base/number.h"
#include "base/tolerances.h"
#include "world/field.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

void imp_pile_begin(imp_pile *pile)
{
    pile->step = 0;
    pile->begun = false;
    pile->memory[0].count = 0;
    for (int k = 0; k < IMP_PILE_RATES; k++)
        for (int i = 0; i < pile->bodies; i++) pile->rates[k][i] = (imp_pile_rates){0};
}

static void copy_rates(const imp_pile *pile, imp_pile_rates *const from[], imp_pile_rates *const to[])
{
    for (int k = 0; k < IMP_PILE_RATES && pile->bodies > 0; k++)
        memcpy(to[k], from[k], sizeof *to[k] * (size_t)pile->bodies);
}

impact_status imp_pile_keep(imp_pile *pile)
{
    pile->kept.step = pile->step;
    pile->kept.begun = pile->begun;
    copy_rates(pile, pile->rates, pile->kept.rates);
    return imp_pile_copy_memories(pile->arena, &pile->kept.memory, &pile->memory[0]) ? IMPACT_OK : IMPACT_ENOMEM;
}

impact_status imp_pile_take_back(imp_pile *pile)
{
    pile->step = pile->kept.step;
    pile->begun = pile->kept.begun;
    copy_rates(pile, pile->kept.rates, pile->rates);
    return imp_pile_copy_memories(pile->arena, &pile->memory[0], &pile->kept.memory) ? IMPACT_OK : IMPACT_ENOMEM;
}

void imp_pile_add_loads(const imp_world *world, const imp_load *loads, double h, imp_state *states)
{
    for (int i = 0; i < world->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        states[i].v = qvec3_axpy(h * world->bodies[i].inverse_mass, loads[i].force, states[i].v);
        states[i].momentum = qvec3_axpy(h, loads[i].torque, states[i].momentum);
    }
}

/* Whether loads follow velocities, or tell work that does. */
static bool loads_follow(const imp_world *world)
{
    for (int i = 0; i < world->body_count; i++)
        if (world->bodies[i].linear_rate > 0 || world->bodies[i].angular_rate > 0) return true;
    return world->field_count > 0;
}

/* The middle of the step with the velocities that are the mean of its ends'. */
static void find_mean(imp_pile *pile, const imp_world *world, const imp_state *from, const imp_state *to)
{
    memcpy(pile->mean, pile->middle, sizeof *pile->mean * (size_t)world->body_count);
    for (int i = 0; i < world->body_count; i++) {
        pile->mean[i].v = qvec3_scale(qvec3_add(from[i].v, to[i].v), 0.5);
        pile->mean[i].momentum = qvec3_scale(qvec3_add(from[i].momentum, to[i].momentum), 0.5);
    }
}

/* The velocities at the end of the step, the places being those of its middle; loads are those of the states given.
 * What strikes too hard in it is found instead. */
static impact_status push_bodies(imp_pile *pile, imp_world *world, double t, double h, const imp_state *loaded,
                                 imp_state *to, imp_pile_step_result *result)
{
    if (!imp_field_loads(world, t + 0.5 * h, loaded, pile->loads)) return IMPACT_EDOMAIN;
    memcpy(to, pile->middle, sizeof *to * (size_t)world->body_count);
    imp_pile_add_loads(world, pile->loads, h, to);
    for (int i = 0; i < world->body_count; i++) {
        result->force_work += h * pile->loads[i].work_rate;
        result->damping += h * pile->loads[i].damping_rate;
    }
    pile->memory[2].count = 0;
    imp_pile_contacts_mark(&pile->touching, world, &pile->memory[1]);
    if (!imp_pile_find_points(&pile->touching, world, pile->middle, to, h, imp_pile_slack(pile, world), false) ||
        !imp_pile_reserve_contacts(pile, world, pile->touching.count))
        return IMPACT_ENOMEM;
    imp_pile_recall(&pile->touching, world, pile->middle, h, &pile->memory[1]);
    imp_pile_seek_strikes(pile, world, pile->middle, 0.5 * h);
    if (pile->strike.found) return IMPACT_OK;
    const double glides = IMP_PILE_GLIDES * imp_pile_smallest(world) / imp_pile_natural_time(world, pile->middle);
    imp_pile_place_friction(&pile->touching, world, &pile->memory[1], pile->middle, glides);
    for (int count; (count = imp_pile_gather_island(pile, world)) > 0;) {
        const impact_status status = imp_pile_answer(pile, world, pile->middle, count, h, to, result);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

/* From `from` over h to `to`. Loads that follow velocities are asked at those of the beginning, and then at the mean of
 * those that this leads to: of the second order, and their work with the way. */
static impact_status step_once(imp_pile *pile, imp_world *world, double t, double h, const imp_state *from,
                               imp_state *to, imp_pile_step_result *result)
{
    result->contacts = result->coupled = 0;
    memcpy(pile->middle, from, sizeof *from * (size_t)world->body_count);
    imp_pile_drift(world, from, 0.5 * h, pile->middle);
    const imp_pile_step_result before = *result;
    impact_status status = push_bodies(pile, world, t, h, pile->middle, to, result);
    if (status == IMPACT_OK && loads_follow(world) && !pile->strike.found) {
        *result = before;
        find_mean(pile, world, from, to);
        status = push_bodies(pile, world, t, h, pile->mean, to, result);
    }
    if (status != IMPACT_OK || pile->strike.found) return status;
    /* x' = x_m + h v'/2; of what tumbles with the turning that it has in its end's orientation, near enough */
    imp_pile_drift(world, to, 0.5 * h, to);
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (!body->is_static && !body->spherical)
            to[i].q = imp_pile_turned(pile->middle[i].q, imp_omega(body, &to[i]), 0.5 * h);
    }
    return IMPACT_OK;
}

/* ---- the step that its error allows ---- */

/* Of any of the body's points, m/s, at these velocities, m/s and 1/s. */
static double speed_of(const imp_body *body, qvec3 along, qvec3 about)
{
    return qvec3_norm(along) + (imp_is_ball(body) ? 0 : body->radius * qvec3_norm(about));
}

/* What the body's velocities changed by over h, but for the rates. */
static double deviation_from(const imp_body *body, const imp_pile_rates *rates, double h, const imp_state *from,
                             const imp_state *to)
{
    const qvec3 along = qvec3_sub(to->v, from->v), about = qvec3_sub(imp_omega(body, to), imp_omega(body, from));
    return speed_of(body, qvec3_axpy(-h, rates->v, along), qvec3_axpy(-h, rates->omega, about));
}

/* The measure of the step's error: half of it times what velocities deviate by. (What exp(h w1/2) exp(h w0/2) leaves of
 * Magnus' series, h^2 (w1 x w0)/24, is a hundredth of it where bodies tumble.) */
static double step_error(const imp_pile *pile, const imp_world *world, double h, const imp_state *from,
                         const imp_state *to)
{
    double most = 0;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        double least = INFINITY;
        for (int k = 0; k < IMP_PILE_RATES; k++)
            least = fmin(least, deviation_from(body, &pile->rates[k][i], h, &from[i], &to[i]));
        most = fmax(most, 0.5 * h * least);
    }
    return most;
}

/* Of the step from there to there over h; those before go one back. */
static void remember_rates(imp_pile *pile, const imp_world *world, double h, const imp_state *from, const imp_state *to)
{
    imp_pile_rates *own = pile->rates[IMP_PILE_RATES - 1];
    for (int k = IMP_PILE_RATES - 1; k > 0; k--) pile->rates[k] = pile->rates[k - 1];
    pile->rates[0] = own;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        const qvec3 turned = qvec3_sub(imp_omega(body, &to[i]), imp_omega(body, &from[i]));
        own[i].v = qvec3_scale(qvec3_sub(to[i].v, from[i].v), 1 / h);
        own[i].omega = qvec3_scale(turned, 1 / h);
    }
}

double imp_pile_natural_time(const imp_world *world, const imp_state *states)
{
    const double size = imp_pile_smallest(world), g = qvec3_norm(world->gravity);
    double speed = 0;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) speed = fmax(speed, qvec3_norm(states[i].v));
    return size / (sqrt(g * size) + (g > 0 ? 0 : speed) + IMP_NOT_ZERO);
}

/* s: in which what goes fastest, at least as fast as the smallest body falls, goes as far as a step may err. */
static double least_step(const imp_pile *pile, const imp_world *world, const imp_state *states, double natural)
{
    const double size = imp_pile_smallest(world);
    double fastest = size / natural;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (!body->is_static) fastest = fmax(fastest, speed_of(body, states[i].v, imp_omega(body, &states[i])));
    }
    return imp_pile_allowed(pile, world) / fastest;
}

/* s: the longest step. What turns by two radians in one is led on by rates of where it was: its rounding grows. */
static double longest_step(const imp_pile *pile, const imp_world *world, const imp_state *states, double natural)
{
    double fastest = 0;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (!body->is_static && !imp_is_ball(body)) fastest = fmax(fastest, qvec3_norm(imp_omega(body, &states[i])));
    }
    return fmin(pile->longest * natural, IMP_PILE_TURN / (fastest + IMP_NOT_ZERO));
}

/* What touches at the first step and does not approach is held from there: it does not come to touch within the step.
 */
static impact_status begin_held(imp_pile *pile, imp_world *world, const imp_state *states)
{
    imp_pile_contacts *touching = &pile->touching;
    pile->begun = true;
    imp_pile_contacts_mark(touching, world, &pile->memory[0]);
    if (!imp_pile_find_points(touching, world, states, NULL, 0, imp_pile_slack(pile, world), false))
        return IMPACT_ENOMEM;
    pile->memory[0].count = 0;
    for (int k = 0; k < touching->count; k++) {
        const imp_pile_point *point = &touching->points[k];
        double u[3];
        imp_cone_contact_velocities(world, states, &point->contact, 1, u);
        if (u[0] < -imp_still_rate(world, hypot(u[1], u[2]))) continue;
        if (!imp_pile_remember(pile->arena, &pile->memory[0], point)) return IMPACT_ENOMEM;
    }
    return IMPACT_OK;
}

/* Tries the step, and puts where it ends, if its error is allowed, into `to`, gaps closed and overlaps parted: what
 * came to overlap after the middle no contact has met, and how far that has to be moved apart is error too. */
static impact_status try_step(imp_pile *pile, imp_world *world, double t, double h, double allowed, imp_state *to,
                              imp_pile_step_result *result)
{
    double parted = 0;
    *result = (imp_pile_step_result){.taken = h};
    if (!imp_pile_copy_memories(pile->arena, &pile->memory[1], &pile->memory[0])) return IMPACT_ENOMEM;
    impact_status status = step_once(pile, world, t, h, pile->from, pile->end, result);
    if (status != IMPACT_OK || pile->strike.found) return status;
    result->error += step_error(pile, world, h, pile->from, pile->end);
    if (result->error > allowed) return IMPACT_OK;
    memcpy(to, pile->end, sizeof *to * (size_t)world->body_count);
    status = imp_pile_project(pile, world, h, to, &parted);
    result->error += parted;
    if (result->error > allowed) imp_pile_seek_strikes(pile, world, to, h);
    return status;
}

/* The steps that are tried for one. */
typedef struct pile_trial {
    double h, cut; /* s; that was to be tried where a strike was met */
    double energy; /* J, of where it begins */
    bool good;
    int strikes;
    imp_pile_step_result struck; /* what strikes at its begin does */
} pile_trial;

static double energy_of(const imp_world *world, const imp_state *states)
{
    return imp_world_kinetic_energy(world, states) + imp_field_potential(world, states);
}

/* What energy the bodies may gain in a step by its errors, J: of what they have, and of what their loads do over their
 * size. */
static double gain_allowed(const imp_pile *pile, const imp_world *world)
{
    double size = imp_world_kinetic_energy(world, pile->from);
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (!body->is_static) size += qvec3_norm(pile->loads[i].force) * body->radius;
    }
    return IMP_PILE_GAIN * size;
}

/* An error of places that is allowed is a great one of velocities in a short step. Whether it gave no more than these
 * may; where no shorter one is tried nothing is known of what follows. */
static bool gives_nothing(imp_pile *pile, const imp_world *world, const pile_trial *trial,
                          const imp_pile_step_result *result, const imp_state *to, bool last)
{
    const double gain = energy_of(world, to) - trial->energy + result->damping + result->sliding - result->force_work -
                        result->drive_work + trial->struck.sliding - trial->struck.drive_work;
    if (gain <= gain_allowed(pile, world)) return true;
    if (last)
        snprintf(pile->message, sizeof pile->message, "they gave bodies %s J that nothing did",
                 imp_number_of(gain).text);
    return false;
}

/* Strikes what strikes at the begin, or ends the step where it does. */
static impact_status meet_strike(imp_pile *pile, imp_world *world, pile_trial *trial)
{
    enum { MOST = 16 };
    const imp_pile_strike *strike = &pile->strike;
    bool struck = false;
    const bool at_once = strike->time * strike->approach <= imp_pile_slack(pile, world);
    if (at_once && trial->strikes++ < MOST) {
        const impact_status status = imp_pile_strike_now(pile, world, pile->from, &trial->struck, &struck);
        if (status == IMPACT_ENOMEM) return status;
    }
    if (struck) return IMPACT_OK;
    trial->cut = fmax(trial->cut, trial->h);
    const double passes = strike->allowed / strike->approach; /* in which it moves no farther than the step may err */
    trial->h = fmin(fmax(at_once ? 0 : strike->time, passes), (at_once ? 0.5 : 1) * trial->h);
    return IMPACT_OK;
}

/* How much longer the next step may be, at most so much: errors are as h where velocities jump within a step, as h^2
 * where accelerations do, and as h^3 of what is smooth. */
static double part_allowed(double error, double allowed, double most)
{
    return fmax(fmin(sqrt(IMP_PILE_AIM * allowed / fmax(error, IMP_NOT_ZERO)), most), IMP_PILE_SHORTENS);
}

static impact_status try_length(imp_pile *pile, imp_world *world, double t, double wanted, double least,
                                pile_trial *trial, imp_pile_step_result *result)
{
    pile->shortest = !(trial->h > least);
    const double allowed = pile->shortest ? INFINITY : wanted;
    pile->strike = (imp_pile_strike){.allowed = allowed, .span = trial->h};
    impact_status status = try_step(pile, world, t, trial->h, allowed, pile->projected, result);
    if (status == IMPACT_OK && pile->strike.found) return meet_strike(pile, world, trial);
    trial->good = status == IMPACT_OK && result->error <= allowed;
    const bool last = !(trial->h > IMP_PILE_LEAST_GIVING * least);
    if (trial->good && !gives_nothing(pile, world, trial, result, pile->projected, last)) {
        trial->good = false;
        status = last ? IMPACT_EUNSETTLED : IMPACT_OK;
    }
    if (status == IMPACT_EUNSETTLED && !pile->shortest) status = IMPACT_OK;
    if (trial->good) return status;
    const double shorter = (result->error > allowed ? part_allowed(result->error, allowed, 0.5) : 0.5) * trial->h;
    trial->h = trial->h > least ? fmax(shorter, least) : shorter;
    return status;
}

impact_status imp_pile_step(imp_pile *pile, imp_world *world, double t, double most, imp_state *states,
                            imp_pile_step_result *result)
{
    if (!imp_pile_reserve_bodies(pile, world)) return IMPACT_ENOMEM;
    const size_t size = sizeof *states * (size_t)world->body_count;
    const double natural = imp_pile_natural_time(world, states), wanted = imp_pile_allowed(pile, world);
    const double least = least_step(pile, world, states, natural); /* of which any error is allowed */
    if (!(pile->step > 0)) pile->step = pile->longest / IMP_PILE_FIRST * natural;
    pile_trial trial = {.h = fmin(most, fmin(fmax(pile->step, least), longest_step(pile, world, states, natural))),
                        .energy = energy_of(world, states)};
    memcpy(pile->from, states, size);
    impact_status status = pile->begun ? IMPACT_OK : begin_held(pile, world, states);
    while (status == IMPACT_OK && !trial.good) status = try_length(pile, world, t, wanted, least, &trial, result);
    if (status != IMPACT_OK) return status;
    memcpy(states, pile->projected, size);
    result->error += trial.struck.error, result->sliding += trial.struck.sliding;
    result->drive_work += trial.struck.drive_work;
    remember_rates(pile, world, trial.h, pile->from, pile->end);
    pile->step = fmax(trial.cut, part_allowed(result->error, wanted, 2) * trial.h);
    return imp_pile_copy_memories(pile->arena, &pile->memory[0], imp_pile_ended(pile)) ? IMPACT_OK : IMPACT_ENOMEM;
}
