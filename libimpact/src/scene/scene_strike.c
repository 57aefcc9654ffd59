/* SPDX-License-Identifier: MIT */
#include "scene/scene_strike.h"
#include "base/number.h"
#include "contact/held_still.h"
#include "contact/turning.h"
#include "scene/scene_drawn.h"
#include "scene/scene_events.h"
#include "scene/scene_meeting.h"
#include "scene/scene_together.h"

#include <stdio.h>

/* ---- one impact ---- */

static void count_solver(imp_island *island, const impact_outcome *outcome)
{
    impact_usage *usage = &island->world.usage;
    if (outcome->solver == IMPACT_SOLVER_CLOSED_FORM) usage->impacts_closed_form++;
    if (outcome->solver == IMPACT_SOLVER_SERIES) usage->impacts_series++;
    if (outcome->solver == IMPACT_SOLVER_CVODE) usage->impacts_cvode++;
    if (outcome->second) usage->impacts_second++;
    if (outcome->energy_rose)
        imp_scene_gain(island, outcome->work_compression + outcome->work_restitution + outcome->work_friction);
}

/* The impact of a pair that resists turning: forces and moments at once (contact/turning.h). */
static impact_status strike_turning(imp_island *island, imp_meeting *m)
{
    imp_world *world = &island->world;
    const imp_held_contact *held = &m->contact;
    const imp_pair *pair = &world->pairs[held->pair];
    imp_cone_contact contact = {.body1 = held->body1, .body2 = held->body2, .arm1 = held->r1, .arm2 = held->r2};
    imp_cone_workspace room = {.arena = world->arena};
    imp_turning_impact impact;
    imp_cone_find_axes(held->normal, contact.axes);
    const impact_status status = imp_turning_collide(world, island->states, &contact, pair->law.friction,
                                                     (imp_cone_lengths){pair->law.torsional, pair->law.rolling},
                                                     imp_scene_collision(island, m).restitution, &room, &impact);
    imp_cone_release(&room);
    if (status == IMPACT_EUNSETTLED)
        snprintf(island->scene->message, sizeof island->scene->message,
                 "impact of '%s' and '%s' at t = %s, with friction against turning: no answer was found",
                 world->bodies[held->body1].name, world->bodies[held->body2].name, imp_number_of(island->t).text);
    if (status != IMPACT_OK) return status;
    impact_event event = imp_scene_event_of_contact(island, IMPACT_EVENT_IMPACT, held);
    const qvec3 rubs = qvec3_axpy(impact.p[1], contact.axes[1], qvec3_scale(contact.axes[2], impact.p[2]));
    event.impulse = qvec3_axpy(impact.p[0], held->normal, rubs);
    event.impulse_normal = impact.p[0];
    event.impulse_tangential = qvec3_norm(rubs);
    event.normal_before = impact.before[0];
    event.normal_after = impact.after[0];
    imp_scene_drive_impulse(island, held, event.impulse);
    for (int k = 0; k < 3; k++)
        island->motion.works.drive += impact.p[3 + k] * qvec3_dot(contact.axes[k], world->bodies[held->body2].spin);
    imp_held_wake(world);
    imp_cone_push_turning(world, &contact, 1, impact.p, island->states);
    island->motion.resting[held->body1] = island->motion.resting[held->body2] = false;
    world->usage.impacts_turning++;
    event.phases = "turning";
    if (imp_scene_tells_events(island)) event.energy_after = imp_scene_total_energy(island);
    return imp_scene_record(island, &event);
}

static impact_status strike(imp_island *island, imp_meeting *m)
{
    imp_world *world = &island->world;
    const imp_held_contact *contact = &m->contact;
    if (imp_is_rough(&world->pairs[contact->pair]) && !m->jams) return strike_turning(island, m);
    const impact_collision collision = imp_scene_collision(island, m);
    impact_outcome outcome;
    const impact_status status = impact_collide(&collision, &outcome);
    if (status == IMPACT_SOFT && island->world.usage.impacts_soft++ == 0)
        snprintf(island->scene->message, sizeof island->scene->message,
                 "impact of '%s' and '%s' at t = %s: no solver's answer passes its receipt, the best is taken",
                 world->bodies[contact->body1].name, world->bodies[contact->body2].name, imp_number_of(island->t).text);
    if (status != IMPACT_OK && status != IMPACT_SOFT) {
        snprintf(island->scene->message, sizeof island->scene->message, "impact of '%s' and '%s' at t = %s: %s",
                 world->bodies[contact->body1].name, world->bodies[contact->body2].name, imp_number_of(island->t).text,
                 status == IMPACT_EARGUMENT && island->scene->methods.impacts == IMPACT_SOLVER_CLOSED_FORM
                     ? "it has no closed form, and the scene asks for no other solver"
                     : impact_status_string(status));
        return status < 0 ? status : IMPACT_EUNSETTLED;
    }
    impact_event event = imp_scene_event_of_contact(island, IMPACT_EVENT_IMPACT, contact);
    const int bodies[2] = {contact->body1, contact->body2};
    imp_scene_drive_impulse(island, contact, outcome.impulse);
    imp_held_wake(world);
    for (int k = 0; k < 2; k++) {
        imp_scene_set_velocities(island, bodies[k], outcome.velocity[k], outcome.omega[k]);
        island->motion.resting[bodies[k]] = false;
    }
    count_solver(island, &outcome);
    char words[128] = "";
    if (imp_scene_tells_events(island)) {
        event.phases = imp_scene_phases_in_words(outcome.phases, outcome.phase_count, words, sizeof words);
        event.energy_after = imp_scene_total_energy(island);
    }
    event.impulse_normal = outcome.impulse_normal;
    event.impulse = outcome.impulse;
    event.impulse_tangential = outcome.impulse_tangential;
    event.normal_before = outcome.normal_before;
    event.normal_after = outcome.normal_after;
    return imp_scene_record(island, &event);
}

/* The first touching pair that approaches in earnest, or -1. Those that barely do are put right by projection where
 * they are held, or (answering) will be: what answers another impact so softly would not rise again. */
static int find_approach(imp_island *island, bool answering, imp_meeting *m)
{
    for (int p = 0; p < island->world.pair_count; p++) {
        if (!imp_scene_meets(island, p, m)) continue;
        const bool held = answering || imp_is_held(&island->world.pairs[p]);
        if (m->velocity < -island->world.slip_speed && !(held && imp_scene_dies_out(island, m, m->velocity))) return p;
    }
    return -1;
}

/* The first touching pair that jams, of those from there on, or -1. */
static int find_jam(imp_island *island, int from, imp_meeting *m)
{
    for (int p = from; p < island->world.pair_count; p++) {
        m->jams = imp_scene_meets(island, p, m) && imp_scene_jams(island, m);
        if (m->jams) return p;
    }
    return -1;
}

/* ---- many impacts in one instant ---- */

/* Whether the impacts of this instant have gone round among the pairs that struck often enough, and lose energy as they
 * go. */
static bool goes_round(const imp_island *island, int impacts)
{
    int struck = 0;
    bool elastic = true;
    for (int p = 0; p < island->world.pair_count; p++) {
        struck += island->notes[p].struck;
        elastic = elastic && (!island->notes[p].struck || island->world.pairs[p].law.restitution == 1);
    }
    return !elastic && impacts > 10 * struck;
}

static impact_status strike_on(imp_island *island, bool *parted)
{
    enum { MAX_IMPACTS = 100000, ASKED_EVERY = 100 };
    imp_world *world = &island->world;
    imp_meeting m;
    bool fresh = true; /* the loads know of the last impact */
    int jam = 0;       /* the first pair that may jam: those before it have been asked since */
    *parted = island->unanswered = false;
    for (int p = 0; p < world->pair_count; p++) island->notes[p].struck = false;
    impact_status status = imp_scene_load_with_reactions(island);
    for (int count = 0; status == IMPACT_OK; count++) {
        int p = find_approach(island, count > 0, &m);
        if (p < 0 && !fresh) {
            status = imp_scene_load_with_reactions(island);
            p = status == IMPACT_OK ? find_approach(island, count > 0, &m) : -1;
            fresh = true;
        }
        if (p < 0 && status == IMPACT_OK) p = find_jam(island, jam, &m);
        if (p < 0) return status;
        if (goes_round(island, count)) {
            status = imp_scene_end_together(island);
            return status == IMPACT_OK ? imp_scene_load_with_reactions(island) : status;
        }
        if (count == MAX_IMPACTS) {
            snprintf(island->scene->message, sizeof island->scene->message,
                     "%d impacts in the one instant t = %s brought no end", count, imp_number_of(island->t).text);
            return IMPACT_EUNSETTLED;
        }
        if (count > 0 && count % ASKED_EVERY == 0 && !imp_scene_may_go_on(island->scene)) {
            island->scene->failed = true; /* half of an instant is no state to go on from */
            return island->scene->stop;
        }
        imp_answer by;
        status = imp_scene_answer_together(island, &m, &by);
        fresh = by == IMP_ANSWER_NONE;
        jam = by == IMP_ANSWER_NONE ? p + 1 : 0;
        if (status != IMPACT_OK || by != IMP_ANSWER_ALONE) continue;
        if (count > 0) world->usage.impacts_simultaneous++;
        status = strike(island, &m);
        island->notes[p].struck = true;
        if (world->pair_count > 1) continue;
        const double speed = imp_held_approach(world, &m.contact, island->states);
        const bool was_held = imp_mode_holds(m.contact.mode); /* by a push: it has to be let go yet */
        *parted = !was_held && imp_scene_leaves_for_good(island, &m, speed);
        if (speed > 0) return status;
    }
    return status;
}

/* ---- what is drawn on where others hold it ---- */

static bool has_sliding(const imp_world *world)
{
    int held = 0, sliding = 0;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        held += imp_is_held(pair);
        sliding += pair->mode == IMP_SLIDE && pair->law.friction > 0 && !imp_is_incipient(pair);
    }
    return held > 1 && sliding > 0;
}

/* The pair after `last` that is drawn on is let go, or answered, or neither: what holds it gives way. */
static impact_status answer_next(imp_island *island, int *last, imp_answer *by)
{
    bool jams = false;
    imp_meeting m;
    impact_status status = imp_scene_load_with_reactions(island);
    if (status == IMPACT_OK) status = imp_scene_find_drawn(island, *last, last, &jams);
    if (status != IMPACT_OK || *last < 0 || !imp_scene_meets(island, *last, &m)) return status;
    m.jams = jams;
    if (jams) return imp_scene_answer_together(island, &m, by);
    island->world.pairs[*last].mode = IMP_OPEN;
    island->world.usage.lifts_chosen++;
    return IMPACT_OK;
}

impact_status imp_scene_strike_drawn(imp_island *island, bool *struck)
{
    imp_answer by = IMP_ANSWER_NONE;
    impact_status status = IMPACT_OK;
    int last = -1;
    *struck = false;
    if (!has_sliding(&island->world) || island->scene->compliance > 0) return IMPACT_OK;
    imp_island_begin_push(island);
    do status = answer_next(island, &last, &by);
    while (status == IMPACT_OK && last >= 0 && by == IMP_ANSWER_NONE);
    imp_island_end_push(island);
    *struck = by != IMP_ANSWER_NONE;
    return status;
}

impact_status imp_scene_strike_all(imp_island *island, bool *parted)
{
    imp_island_begin_push(island);
    const impact_status status = strike_on(island, parted);
    imp_island_end_push(island);
    return status;
}
