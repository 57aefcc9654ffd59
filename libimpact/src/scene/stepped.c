/* SPDX-License-Identifier: MIT */
#include "scene/stepped.h"
#include "base/number.h"
#include "base/tolerances.h"
#include "motion/motion_pile.h"
#include "scene/following.h"
#include "scene/gliding.h"
#include "scene/scene_points.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

/* ---- when ---- */

/* Whether bodies that move touch each other with friction, and by three contacts in all: fewer are no pile. What is
 * held touches, and what has just struck: of a pile that chatters one contact is always open. */
static bool is_pile(const imp_island *island)
{
    const imp_world *world = &island->world;
    int touching = 0;
    bool rough = false;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        if (!imp_is_held(pair) && !island->notes[p].struck) continue;
        touching++;
        rough = rough || (!world->bodies[pair->body2].is_static && pair->law.friction > 0);
    }
    return rough && touching >= 3;
}

/* Whether a pair has faces, or holds a flat place on what it may lie on. */
static bool meets_faces(const imp_island *island)
{
    for (int p = 0; p < island->world.pair_count; p++)
        if (imp_pair_has_faces(&island->world, &island->world.pairs[p])) return true;
    return imp_scene_holds_features(island);
}

/* Whether two bodies that move are held on each other: what is not goes exactly again at once. */
static bool holds_movers(const imp_island *island)
{
    for (int p = 0; p < island->world.pair_count; p++) {
        const imp_pair *pair = &island->world.pairs[p];
        if (imp_is_held(pair) && !island->world.bodies[pair->body2].is_static) return true;
    }
    return false;
}

bool imp_island_loses_patience(imp_island *island, long rates, bool stood)
{
    const long events = 1 + island->strides / IMP_EVENT_STRIDES;
    island->strides = 0;
    if (island->stepped || island->scene->piles == IMPACT_PILES_EXACT) return false;
    const bool faces = meets_faces(island), pile = !faces && is_pile(island);
    if (!faces && !pile && !holds_movers(island)) return false;
    const double natural = imp_pile_natural_time(&island->world, island->states);
    const long least = events * IMP_EVENT_RATES,
               rough = faces           ? events
                       : rates > least ? rates
                                       : least,
               own = stood ? IMP_STOOD_STRIDES * rough : rough;
    long most = 0;
    for (int i = 0; i < island->world.body_count; i++) {
        const imp_body *body = &island->world.bodies[i];
        imp_patience *patience = &island->scene->tracks.tracks[body->index].patience;
        if (body->is_static) continue;
        if (!(fabs(island->t - patience->since) <= natural)) *patience = (imp_patience){.since = island->t};
        patience->work += own;
        if (patience->work > most) most = patience->work;
    }
    return most >= (faces ? IMP_FACES_PATIENCE : pile ? IMP_PILE_PATIENCE : IMP_HELD_PATIENCE);
}

/* A pile that remembers nothing. */
static impact_status open_pile(imp_island *island)
{
    imp_arena *arena = island->scene->world.arena;
    if (!island->pile) {
        island->pile = imp_arena_take(arena, 1, sizeof *island->pile);
        if (!island->pile) return IMPACT_ENOMEM;
        imp_pile_open(island->pile, arena, island->scene->pile_tolerance);
    }
    imp_pile_begin(island->pile);
    return IMPACT_OK;
}

impact_status imp_island_begin_steps(imp_island *island)
{
    const impact_status status = open_pile(island);
    if (status != IMPACT_OK) return status;
    island->met_since = island->t;
    island->scene->stepped = true;
    for (int i = 0; i < island->world.body_count; i++) island->motion.resting[i] = false;
    for (int p = 0; p < island->world.pair_count; p++) {
        imp_pair *pair = &island->world.pairs[p];
        *pair = (imp_pair){.body1 = pair->body1,
                           .body2 = pair->body2,
                           .law.friction = pair->law.friction,
                           .law.restitution = pair->law.restitution,
                           .law.torsional = pair->law.torsional,
                           .law.rolling = pair->law.rolling,
                           .law.stiffness = pair->law.stiffness};
    }
    return IMPACT_OK;
}

/* One that rests keeps what touched, and gets the reactions that hold it from the proof of its rest. */
impact_status imp_island_resume_steps(imp_island *island)
{
    if (!imp_island_all_rest(island)) return imp_island_begin_steps(island);
    const impact_status status = open_pile(island);
    bool rests;
    if (status != IMPACT_OK) return status;
    return imp_pile_rests(island->pile, &island->world, island->t, island->states, island->scene->rest_speed, &rests);
}

/* ---- steps ---- */

double imp_island_stepped_loss(const imp_island *island, const imp_state *states, const imp_works *works)
{
    const double energy =
        imp_world_kinetic_energy(&island->world, states) + imp_field_potential(&island->world, states);
    return island->balance + works->force + works->drive - works->damping - works->sliding - energy;
}

/* Which pairs touch, of those that the pile has held since it was looked at last. */
static void mark_met(imp_island *island)
{
    const imp_pile_memories *held = imp_pile_held(island->pile);
    for (int k = 0; k < held->count; k++) island->world.pairs[held->list[k].pair].met = true;
}

/* Of the bodies that move. */
static const imp_body *heaviest_of(const imp_world *world)
{
    const imp_body *heaviest = &world->bodies[0];
    for (int i = 1; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (!body->is_static && (heaviest->is_static || body->mass > heaviest->mass)) heaviest = body;
    }
    return heaviest;
}

impact_status imp_island_step(imp_island *island)
{
    impact_scene *scene = island->scene;
    imp_motion *motion = &island->motion;
    imp_pile_step_result result;
    island->balance = imp_island_balance(island);
    const impact_status status =
        imp_motion_next_by_steps(motion, island->pile, island->before, island->states, &result);
    if (status == IMPACT_ENOMEM) return status;
    if (status != IMPACT_OK) {
        const imp_body *heaviest = heaviest_of(&island->world);
        snprintf(scene->message, sizeof scene->message,
                 "by steps from t = %s, of which body '%s' is the heaviest (%s kg): %s",
                 imp_number_of(motion->stride.t).text, heaviest->name, imp_number_of(heaviest->mass).text,
                 island->pile->message[0] ? island->pile->message : impact_status_string(status));
        return status;
    }
    /* what strikes where the step begins has struck in its segments */
    memcpy(island->before, island->pile->from, sizeof *island->before * (size_t)island->world.body_count);
    island->impact_loss = imp_island_stepped_loss(island, island->states, &motion->works);
    island->end = (imp_end){IMP_END_TIME, 0};
    scene->pile_error += result.error;
    scene->world.usage.pile_steps++;
    mark_met(island);
    return IMPACT_OK;
}

impact_status imp_island_can_stand(imp_island *island, bool *can)
{
    const double speed = island->scene->rest_speed;
    const impact_status status = imp_pile_rests(island->pile, &island->world, island->t, island->states, speed, can);
    if (!*can) return status;
    imp_island_forget_met(island);
    mark_met(island);
    return IMPACT_OK;
}

impact_status imp_island_after_step(imp_island *island, imp_stepped *found)
{
    bool stands;
    const impact_status status = imp_island_can_stand(island, &stands);
    const double apart = IMP_PILE_APART * imp_pile_natural_time(&island->world, island->states);
    *found = stands ? (imp_island_may_lie(island) ? IMP_STEPPED_LIES : IMP_STEPPED_REST)
             : island->t - island->met_since >= apart ? IMP_STEPPED_LOOK
                                                      : IMP_STEPPED_ON;
    return status;
}

void imp_island_forget_met(imp_island *island)
{
    for (int p = 0; p < island->world.pair_count; p++) island->world.pairs[p].met = false;
    island->met_since = island->t;
}
