/* SPDX-License-Identifier: MIT */
#include "scene/scene_hold.h"
#include "base/number.h"
#include "world/surface_velocity.h"
#include "contact/held_flat.h"
#include "contact/held_line.h"
#include "contact/held_still.h"
#include "scene/scene_drawn.h"
#include "scene/scene_events.h"
#include "scene/scene_meeting.h"
#include "scene/scene_points.h"

#include <stdio.h>

/* What has no friction slides even where it stands still. */
static imp_mode held_mode(const imp_held_contact *contact, bool slides)
{
    return slides || contact->friction == 0 ? IMP_SLIDE : IMP_STICK;
}

void imp_scene_choose_modes(imp_island *island)
{
    imp_world *world = &island->world;
    for (int p = 0; p < world->pair_count; p++) {
        imp_meeting m;
        imp_pair *pair = &world->pairs[p];
        if (pair->footing.on == IMP_FOOT_FACE || island->notes[p].rises || !imp_scene_meets(island, p, &m)) continue;
        imp_scene_press(island, &m);
        const bool stays =
            m.acceleration < 0 ? imp_scene_dies_out(island, &m, m.velocity) : m.velocity <= world->slip_speed;
        const bool slides = m.contact.speed > world->slip_speed || (imp_is_held(pair) && m.contact.incipient);
        pair->mode = stays ? held_mode(&m.contact, slides) : IMP_OPEN;
        if (!slides || m.contact.speed >= world->incipient_speed) imp_end_incipient(pair);
    }
    for (int p = 0; p < world->pair_count; p++) { /* now that it is known what holds whose bodies */
        imp_meeting m;
        imp_pair *pair = &world->pairs[p];
        if (pair->mode != IMP_SLIDE || pair->footing.on == IMP_FOOT_FACE || island->notes[p].rises ||
            !imp_scene_meets(island, p, &m))
            continue;
        if (!imp_scene_lifts(island, &m)) continue;
        world->usage.lifts_chosen++;
        pair->mode = IMP_OPEN;
    }
}

static impact_event_kind change_of_mode(imp_mode before, imp_mode now)
{
    if (!imp_mode_holds(now)) return IMPACT_EVENT_LIFTOFF;
    if (!imp_mode_holds(before)) return IMPACT_EVENT_CONTACT;
    return now == IMP_STICK ? IMPACT_EVENT_STICK : IMPACT_EVENT_SLIP;
}

static impact_status record_changes(imp_island *island)
{
    imp_world *world = &island->world;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_mode now = world->pairs[p].mode;
        if (now == island->notes[p].mode) continue;
        const imp_held_contact contact = imp_held_contact_at(world, p, island->states, island->motion.loads);
        impact_event event = imp_scene_event_of_contact(island, change_of_mode(island->notes[p].mode, now), &contact);
        const bool stands = contact.friction == 0 && contact.speed <= world->slip_speed;
        event.phases = !imp_mode_holds(now) ? "" : now == IMP_STICK || stands ? "roll" : "slide";
        island->motion.resting[contact.body1] = island->motion.resting[contact.body2] = false;
        const impact_status status = imp_scene_record(island, &event);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

/* How fast any point of the body moves at most, m/s. */
static double fastest_point(const imp_body *body, const imp_state *state)
{
    return qvec3_norm(state->v) + body->radius * qvec3_norm(imp_omega(body, state));
}

/* A body that is slower than the rest speed, held, and not accelerated, is at rest. */
static bool comes_to_rest(const imp_island *island, int body)
{
    const imp_body *b = &island->world.bodies[body];
    const imp_state *s = &island->states[body];
    if (b->is_static || island->motion.resting[body]) return false;
    if (fastest_point(b, s) > island->scene->rest_speed) return false;
    qvec3 force = island->motion.loads[body].force, torque = island->motion.loads[body].torque;
    bool held = false;
    for (int c = 0; c < island->motion.held.count; c++) {
        const imp_held_contact *contact = &island->motion.held.contacts[c];
        if (contact->body1 != body && contact->body2 != body) continue;
        if (imp_is_turned(&island->world, &island->world.pairs[contact->pair])) return false;
        if (contact->still) return true;
        const bool fades = contact->mode == IMP_SLIDE && !contact->incipient && contact->friction > 0;
        if (fades && contact->speed <= 2 * island->scene->rest_speed) return false; /* it sticks first */
        held = true;
        const qvec3 f = contact->body1 == body ? contact->force : qvec3_neg(contact->force);
        force = qvec3_add(force, f);
        torque = qvec3_add(torque, qvec3_cross(contact->body1 == body ? contact->r1 : contact->r2, f));
    }
    const double acceleration =
        qvec3_norm(force) * b->inverse_mass + b->radius * qvec3_norm(imp_inverse_inertia(b, s->q, torque));
    return held && acceleration < 100 * island->scene->rest_speed;
}

static void stop(imp_island *island, int body)
{
    imp_state *state = &island->states[body];
    if (island->world.bodies[body].is_static) return;
    state->v = state->momentum = (qvec3){0, 0, 0};
}

static impact_status bring_to_rest(imp_island *island)
{
    for (int i = 0; i < island->world.body_count; i++) {
        if (!comes_to_rest(island, i)) continue;
        stop(island, i);
        island->motion.resting[i] = true;
        const impact_event event = imp_scene_event_of_body(island, IMPACT_EVENT_REST, i);
        const impact_status status = imp_scene_record(island, &event);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

/* What stands still, or is so jammed that it stops before it has gone the rest height. */
static impact_status find_still(imp_island *island)
{
    imp_motion *motion = &island->motion;
    imp_world *world = &island->world;
    const double jam_speed =
        fmax(island->scene->rest_speed, sqrt(2 * qvec3_norm(world->gravity) * island->scene->rest_height));
    const impact_status status =
        imp_held_find_still(&motion->held, world, island->states, motion->loads, island->scene->rest_speed, jam_speed);
    for (int p = 0; status == IMPACT_OK && p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        if (!imp_is_held(pair) || !pair->rest.still) continue;
        stop(island, pair->body1);
        stop(island, pair->body2);
    }
    return status;
}

/* Whether one that sticks has slip: the projection of others left it where it slid, before its mode was found. */
static bool sticks_with_slip(const imp_island *island)
{
    const imp_held *held = &island->motion.held;
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (contact->mode == IMP_STICK && !contact->still && contact->speed > island->world.slip_speed) return true;
    }
    return false;
}

/* Velocities to the modes, and modes to the velocities. */
static impact_status project_and_resolve(imp_island *island)
{
    imp_motion *motion = &island->motion;
    imp_held_project(&motion->held, &island->world, island->states, motion->loads);
    motion->works.drive += imp_held_drive_power(&motion->held, &island->world);
    impact_status status = imp_scene_load(island);
    if (status == IMPACT_OK) status = find_still(island);
    if (status == IMPACT_OK) status = imp_held_resolve(&motion->held, &island->world, island->states, motion->loads);
    return status;
}

/* Puts the constraints of the contacts that are held in order, and opens those that would pull. */
static impact_status make_consistent(imp_island *island)
{
    imp_motion *motion = &island->motion;
    imp_held_wake(&island->world);
    impact_status status = imp_held_reserve(&motion->held, &island->world, island->states);
    if (status == IMPACT_OK) status = imp_scene_load(island);
    if (status == IMPACT_OK) status = project_and_resolve(island);
    if (status == IMPACT_OK && sticks_with_slip(island)) status = project_and_resolve(island);
    if (status == IMPACT_EUNSETTLED)
        snprintf(island->scene->message, sizeof island->scene->message,
                 "no consistent set of contact forces found at t = %s", imp_number_of(island->t).text);
    return status;
}

/* The first open pair that touches, is all but still along the normal, and is pressed together by the loads and the
 * reactions; or -1. One by one, not all in the law that gives the modes: whether what is left of a bounce dies out
 * hangs on what presses the pair, and of one that joins its velocity is ended before the law of accelerations holds for
 * it. */
static int find_pressed(imp_island *island, imp_meeting *m)
{
    imp_world *world = &island->world;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        if (imp_is_held(pair) || pair->footing.on == IMP_FOOT_FACE || island->notes[p].settled ||
            !imp_scene_meets(island, p, m))
            continue;
        const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
        const double push1 = qvec3_norm(island->motion.loads[pair->body1].force) * b1->inverse_mass,
                     push2 = qvec3_norm(island->motion.loads[pair->body2].force) * b2->inverse_mass;
        const double pressed = -IMP_PRESSED_OF_LOADS * (push1 + push2);
        imp_scene_press(island, m);
        if (m->acceleration < pressed && imp_scene_dies_out(island, m, m->velocity)) return p;
    }
    return -1;
}

/* What rocks on a face too low to be seen lies on it; the energy is given up. */
static impact_status lie_down(imp_island *island)
{
    const double energy = imp_scene_undriven_energy(island);
    impact_status status = imp_scene_load(island);
    if (status != IMPACT_OK) return status;
    const bool flat = imp_flat_lay(&island->world, island->states, island->motion.loads);
    const bool lined = imp_line_lay(&island->motion.held, &island->world, island->states, island->motion.loads);
    if (!flat && !lined) return status;
    status = make_consistent(island);
    island->impact_loss += energy - imp_scene_undriven_energy(island);
    return status;
}

/* Whether a body that moves is held with friction by reactions that are not unique. */
static bool hangs_on_choice(const imp_island *island)
{
    const imp_held *held = &island->motion.held;
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (contact->still || !contact->redundant || !(contact->friction > 0)) continue;
        const int bodies[2] = {contact->body1, contact->body2};
        for (int k = 0; k < 2; k++) {
            const imp_body *body = &island->world.bodies[bodies[k]];
            const imp_state *state = &island->states[bodies[k]];
            if (!body->is_static && fastest_point(body, state) > island->scene->rest_speed) return true;
        }
    }
    return false;
}

impact_status imp_scene_hold(imp_island *island, int opened, bool rejoin)
{
    imp_world *world = &island->world;
    for (int p = 0; p < world->pair_count; p++) island->notes[p].settled = p == opened;
    impact_status status = make_consistent(island);
    while (rejoin && status == IMPACT_OK) {
        imp_meeting m;
        status = imp_scene_load_with_reactions(island);
        const int p = status == IMPACT_OK ? find_pressed(island, &m) : -1;
        if (p < 0) break;
        imp_pair *pair = &world->pairs[p];
        island->notes[p].settled = true;
        imp_end_incipient(pair);
        imp_scene_name_corner(island, pair);
        pair->mode = held_mode(&m.contact, m.contact.speed > world->slip_speed);
        status = make_consistent(island);
    }
    if (status == IMPACT_OK) status = lie_down(island);
    if (status == IMPACT_OK) world->usage.reactions_chosen += hangs_on_choice(island);
    if (status == IMPACT_OK) status = imp_scene_load(island);
    if (status == IMPACT_OK) status = record_changes(island);
    return status == IMPACT_OK ? bring_to_rest(island) : status;
}
