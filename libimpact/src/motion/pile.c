/* SPDX-License-Identifier: MIT */
#include "motion/pile.h"
#include "motion/pile_parts.h"
#include "base/tolerances.h"

#include <string.h>

void imp_pile_begin(imp_pile *pile)
{
    pile->step = 0;
    pile->begun = false;
    pile->memory[0].count = 0;
}

impact_status imp_pile_keep(imp_pile *pile)
{
    pile->kept.step = pile->step;
    pile->kept.begun = pile->begun;
    return imp_pile_copy_memories(pile->arena, &pile->kept.memory, &pile->memory[0]) ? IMPACT_OK : IMPACT_ENOMEM;
}

impact_status imp_pile_take_back(imp_pile *pile)
{
    pile->step = pile->kept.step;
    pile->begun = pile->kept.begun;
    return imp_pile_copy_memories(pile->arena, &pile->memory[0], &pile->kept.memory) ? IMPACT_OK : IMPACT_ENOMEM;
}

static void add_loads(const imp_world *world, const imp_load *loads, double h, imp_state *states)
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
    add_loads(world, pile->loads, h, to);
    for (int i = 0; i < world->body_count; i++) {
        result->force_work += h * pile->loads[i].work_rate;
        result->damping += h * pile->loads[i].damping_rate;
    }
    pile->memory[2].count = 0;
    imp_pile_contacts_mark(&pile->touching, world, &pile->memory[1]);
    if (!imp_pile_find_points(&pile->touching, world, pile->middle, to, h, imp_pile_slack(pile, world), false) ||
        !imp_pile_reserve_contacts(pile, world, pile->touching.count))
        return IMPACT_ENOMEM;
    imp_pile_recall(&pile->touching, world, pile->middle, h, &pile->memory[1], IMP_PILE_BEFORE);
    if (pile->halved) {
        imp_pile_recall(&pile->touching, world, pile->middle, h, &pile->memory[4], IMP_PILE_HALF);
        imp_pile_recall(&pile->touching, world, pile->middle, h, &pile->memory[3], IMP_PILE_END);
    } else
        imp_pile_seek_strikes(pile, world, pile->middle, pile->strike.begun + 0.5 * h);
    if (pile->strike.found) return IMPACT_OK;
    imp_pile_place_friction(&pile->touching, world, &pile->memory[pile->halved ? 3 : 1],
                            pile->halved ? IMP_PILE_END : IMP_PILE_BEFORE);
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
    if (!imp_pile_copy_memories(pile->arena, &pile->memory[1], &pile->memory[2])) return IMPACT_ENOMEM;
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

/* How far apart any body's point stands in two ends of a step. */
static double apart(const imp_world *world, const imp_state *a, const imp_state *b)
{
    double most = 0;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        const quat turn = quat_mul(a[i].q, quat_conj(b[i].q));
        const double angle =
            body->shape.kind == IMPACT_SPHERE && !body->shifted ? 0 : 2 * qvec3_norm((qvec3){turn.x, turn.y, turn.z});
        most = fmax(most, qvec3_norm(qvec3_sub(a[i].x, b[i].x)) + body->radius * angle);
    }
    return most;
}

double imp_pile_natural_time(const imp_world *world, const imp_state *states)
{
    const double size = imp_pile_smallest(world), g = qvec3_norm(world->gravity);
    double speed = 0;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) speed = fmax(speed, qvec3_norm(states[i].v));
    return size / (sqrt(g * size) + (g > 0 ? 0 : speed) + IMP_NOT_ZERO);
}

/* The step in two halves, and whole; there: the whole was found, as the first half of one tried before. halfway: the
 * first half is found. */
static impact_status try_step(imp_pile *pile, imp_world *world, double t, double h, const imp_state *states, bool there,
                              bool *halfway, imp_pile_step_result *result)
{
    imp_pile_step_result scratch = {.taken = 0};
    imp_pile_memories *memory = pile->memory;
    *result = (imp_pile_step_result){.taken = h};
    if (!imp_pile_copy_memories(pile->arena, &memory[1], &memory[0])) return IMPACT_ENOMEM;
    impact_status status = step_once(pile, world, t, 0.5 * h, states, pile->half, result);
    *halfway = status == IMPACT_OK && !pile->strike.found;
    if (!*halfway) return status;
    if (!imp_pile_copy_memories(pile->arena, &memory[4], &memory[1])) return IMPACT_ENOMEM;
    pile->strike.begun = 0.5 * h;
    status = step_once(pile, world, t + 0.5 * h, 0.5 * h, pile->half, pile->end, result);
    if (status != IMPACT_OK || pile->strike.found) return status;
    if (!imp_pile_copy_memories(pile->arena, &memory[3], &memory[1]) ||
        !imp_pile_copy_memories(pile->arena, &memory[1], &memory[0]))
        return IMPACT_ENOMEM;
    pile->halved = true;
    if (!there) status = step_once(pile, world, t, h, states, pile->whole, &scratch);
    pile->halved = false;
    result->error += apart(world, pile->whole, pile->end);
    return status;
}

/* Half as long: whole it is the first half of the step before, where that was found. */
static bool keep_first_half(imp_pile *pile, bool halfway)
{
    imp_state *whole = pile->whole;
    if (halfway) pile->whole = pile->half, pile->half = whole;
    return halfway;
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
 * came to overlap after the middle of the second half no contact has met, and how far that has to be moved apart is
 * error too. */
static impact_status try_and_project(imp_pile *pile, imp_world *world, double t, double h, const imp_state *from,
                                     bool there, bool *halfway, double allowed, imp_state *to,
                                     imp_pile_step_result *result)
{
    impact_status status = try_step(pile, world, t, h, from, there, halfway, result);
    double parted = 0;
    if (status != IMPACT_OK || pile->strike.found || result->error > allowed) return status;
    memcpy(to, pile->end, sizeof *to * (size_t)world->body_count);
    status = imp_pile_project(pile, world, h, to, &parted);
    result->error += parted;
    if (result->error > allowed) imp_pile_seek_strikes(pile, world, to, h);
    return status;
}

/* The steps that are tried for one. */
typedef struct pile_trial {
    double h, cut; /* s; that was to be tried where a strike was met */
    bool there, halfway, good;
    int strikes;
    imp_pile_step_result struck; /* what strikes at its begin does */
} pile_trial;

/* Strikes what strikes at the begin, or ends the step where it does. */
static impact_status meet_strike(imp_pile *pile, imp_world *world, pile_trial *trial)
{
    enum { MOST = 16 };
    const imp_pile_strike *strike = &pile->strike;
    bool struck = false;
    const bool at_once = strike->time * strike->approach <= imp_pile_slack(pile, world);
    trial->there = false;
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

static impact_status try_length(imp_pile *pile, imp_world *world, double t, double wanted, double least,
                                pile_trial *trial, imp_pile_step_result *result)
{
    pile->shortest = !(trial->h > least);
    const double allowed = pile->shortest ? INFINITY : wanted;
    pile->strike = (imp_pile_strike){.allowed = allowed, .span = trial->h};
    impact_status status = try_and_project(pile, world, t, trial->h, pile->from, trial->there, &trial->halfway, allowed,
                                           pile->projected, result);
    if (status == IMPACT_OK && pile->strike.found) return meet_strike(pile, world, trial);
    trial->good = status == IMPACT_OK && result->error <= allowed;
    if (status == IMPACT_EUNSETTLED && !pile->shortest) status = IMPACT_OK;
    if (trial->good) return status;
    trial->there = keep_first_half(pile, trial->halfway);
    trial->h *= 0.5;
    return status;
}

impact_status imp_pile_step(imp_pile *pile, imp_world *world, double t, double most, imp_state *states,
                            imp_pile_step_result *result)
{
    if (!imp_pile_reserve_bodies(pile, world)) return IMPACT_ENOMEM;
    const size_t size = sizeof *states * (size_t)world->body_count;
    const double natural = imp_pile_natural_time(world, states), wanted = pile->tolerance * imp_pile_smallest(world);
    const double least = pile->tolerance * natural; /* of which any error is allowed */
    if (!(pile->step > 0)) pile->step = pile->longest / IMP_PILE_FIRST * natural;
    pile_trial trial = {.h = fmin(most, fmin(pile->step, pile->longest * natural))};
    memcpy(pile->from, states, size);
    impact_status status = pile->begun ? IMPACT_OK : begin_held(pile, world, states);
    while (status == IMPACT_OK && !trial.good) status = try_length(pile, world, t, wanted, least, &trial, result);
    if (status != IMPACT_OK) return status;
    memcpy(states, pile->projected, size);
    result->error += trial.struck.error, result->sliding += trial.struck.sliding;
    result->drive_work += trial.struck.drive_work;
    /* h³ where modes stay, h where they change: doubled where the first would allow as much */
    pile->step = fmax(trial.cut, result->error < IMP_PILE_LENGTHENS * wanted ? 2 * trial.h : trial.h);
    return imp_pile_copy_memories(pile->arena, &pile->memory[0], imp_pile_ended(pile)) ? IMPACT_OK : IMPACT_ENOMEM;
}
