/* SPDX-License-Identifier: MIT */
#include "scene/scene_hold.h"
#include "world/drive.h"
#include "contact/persist_flat.h"
#include "contact/persist_line.h"
#include "contact/persist_still.h"
#include "scene/scene_events.h"
#include "scene/scene_meeting.h"

#include <stdio.h>

/* What has no friction slides even where it stands still. */
static imp_mode held_mode(const imp_touch *touch, bool slides)
{
    return slides || touch->friction == 0 ? IMP_SLIDE : IMP_ROLL;
}

void imp_scene_choose_modes(impact_scene *scene)
{
    imp_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) {
        imp_meeting m;
        imp_pair *pair = &world->pairs[p];
        if (!imp_scene_meets(scene, p, &m)) continue;
        const bool stays =
            m.acceleration < 0 ? imp_scene_dies_out(scene, &m, m.velocity) : m.velocity <= world->slip_speed;
        const bool slides = m.touch.speed > world->slip_speed || (imp_is_held(pair) && m.touch.onset);
        pair->mode = stays ? held_mode(&m.touch, slides) : IMP_OPEN;
        pair->onset = slides && m.touch.onset && m.touch.speed < world->onset_speed;
    }
}

static impact_event_kind change_of_mode(imp_mode before, imp_mode now)
{
    if (now == IMP_OPEN) return IMPACT_EVENT_LIFTOFF;
    if (before == IMP_OPEN) return IMPACT_EVENT_CONTACT;
    return now == IMP_ROLL ? IMPACT_EVENT_STICK : IMPACT_EVENT_SLIP;
}

static impact_status record_changes(impact_scene *scene)
{
    imp_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_mode now = world->pairs[p].mode;
        if (now == scene->modes[p]) continue;
        const imp_touch touch = imp_persist_touch(world, p, scene->states, scene->motion.loads);
        impact_event event = imp_scene_event_of_touch(scene, change_of_mode(scene->modes[p], now), &touch);
        const bool stands = touch.friction == 0 && touch.speed <= world->slip_speed;
        event.phases = now == IMP_OPEN ? "" : now == IMP_ROLL || stands ? "roll" : "slide";
        scene->motion.resting[touch.body1] = scene->motion.resting[touch.body2] = false;
        const impact_status status = imp_scene_record(scene, &event);
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
static bool comes_to_rest(const impact_scene *scene, int body)
{
    const imp_body *b = &scene->world.bodies[body];
    const imp_state *s = &scene->states[body];
    if (b->is_static || scene->motion.resting[body]) return false;
    if (fastest_point(b, s) > scene->rest_speed) return false;
    qvec3 force = scene->motion.loads[body].force, torque = scene->motion.loads[body].torque;
    bool held = false;
    for (int c = 0; c < scene->motion.persist.count; c++) {
        const imp_touch *touch = &scene->motion.persist.touches[c];
        if (touch->body1 != body && touch->body2 != body) continue;
        if (touch->still) return true;
        const bool fades = touch->mode == IMP_SLIDE && !touch->onset && touch->friction > 0;
        if (fades && touch->speed <= 2 * scene->rest_speed) return false; /* it sticks first */
        held = true;
        const qvec3 f = touch->body1 == body ? touch->force : qvec3_neg(touch->force);
        force = qvec3_add(force, f);
        torque = qvec3_add(torque, qvec3_cross(touch->body1 == body ? touch->r1 : touch->r2, f));
    }
    const double acceleration =
        qvec3_norm(force) * b->inverse_mass + b->radius * qvec3_norm(imp_inverse_inertia(b, s->q, torque));
    return held && acceleration < 100 * scene->rest_speed;
}

static impact_status bring_to_rest(impact_scene *scene)
{
    for (int i = 0; i < scene->world.body_count; i++) {
        if (!comes_to_rest(scene, i)) continue;
        scene->states[i].v = scene->states[i].momentum = (qvec3){0, 0, 0};
        scene->motion.resting[i] = true;
        const impact_event event = imp_scene_event_of_body(scene, IMPACT_EVENT_REST, i);
        const impact_status status = imp_scene_record(scene, &event);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

static void stop(impact_scene *scene, int body)
{
    if (!scene->world.bodies[body].is_static) scene->states[body].v = scene->states[body].momentum = (qvec3){0, 0, 0};
}

/* What stands still, or is so jammed that it stops before it has gone the rest height. */
static impact_status find_still(impact_scene *scene)
{
    imp_motion *motion = &scene->motion;
    imp_world *world = &scene->world;
    const double jam_speed = fmax(scene->rest_speed, sqrt(2 * qvec3_norm(world->gravity) * scene->rest_height));
    const impact_status status =
        imp_persist_find_still(&motion->persist, world, scene->states, motion->loads, scene->rest_speed, jam_speed);
    for (int p = 0; status == IMPACT_OK && p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        if (!imp_is_held(pair) || !pair->still) continue;
        stop(scene, pair->body1);
        stop(scene, pair->body2);
    }
    return status;
}

/* Puts the constraints of the contacts that are held in order, and opens those that would pull. */
static impact_status make_consistent(impact_scene *scene)
{
    imp_motion *motion = &scene->motion;
    imp_persist_stir(&scene->world);
    impact_status status = imp_persist_reserve(&motion->persist, &scene->world, scene->states);
    if (status == IMPACT_OK) status = imp_scene_load(scene);
    if (status != IMPACT_OK) return status;
    imp_persist_project(&motion->persist, &scene->world, scene->states, motion->loads);
    motion->works.drive += imp_persist_drive_power(&motion->persist, &scene->world);
    status = imp_scene_load(scene);
    if (status == IMPACT_OK) status = find_still(scene);
    if (status == IMPACT_OK)
        status = imp_persist_resolve(&motion->persist, &scene->world, scene->states, motion->loads);
    if (status == IMPACT_EUNSETTLED)
        snprintf(scene->message, sizeof scene->message, "no consistent set of contact forces found at t = %.17g",
                 scene->t);
    return status;
}

/* The first open pair that touches, is all but still along the normal, and is pressed together by the loads and the
 * reactions; or -1. */
static int find_pressed(impact_scene *scene, imp_meeting *m)
{
    imp_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        if (imp_is_held(pair) || pair->settled || !imp_scene_meets(scene, p, m)) continue;
        const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
        const double push1 = qvec3_norm(scene->motion.loads[pair->body1].force) * b1->inverse_mass,
                     push2 = qvec3_norm(scene->motion.loads[pair->body2].force) * b2->inverse_mass;
        const double pressed = -1e-9 * (push1 + push2);
        if (m->acceleration < pressed && imp_scene_dies_out(scene, m, m->velocity)) return p;
    }
    return -1;
}

/* What rocks on a face too low to be seen lies on it; the energy is given up. */
static impact_status lie_down(impact_scene *scene)
{
    const double energy = imp_scene_undriven_energy(scene);
    impact_status status = imp_scene_load(scene);
    if (status != IMPACT_OK) return status;
    const bool flat = imp_flat_lay(&scene->world, scene->states, scene->motion.loads);
    const bool lined = imp_line_lay(&scene->motion.persist, &scene->world, scene->states, scene->motion.loads);
    if (!flat && !lined) return status;
    status = make_consistent(scene);
    scene->impact_loss += energy - imp_scene_undriven_energy(scene);
    return status;
}

/* Whether a body that moves is held with friction by reactions that are not unique. */
static bool hangs_on_choice(const impact_scene *scene)
{
    const imp_persist *persist = &scene->motion.persist;
    for (int c = 0; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        if (touch->still || !touch->redundant || !(touch->friction > 0)) continue;
        const int bodies[2] = {touch->body1, touch->body2};
        for (int k = 0; k < 2; k++) {
            const imp_body *body = &scene->world.bodies[bodies[k]];
            const imp_state *state = &scene->states[bodies[k]];
            if (!body->is_static && fastest_point(body, state) > scene->rest_speed) return true;
        }
    }
    return false;
}

impact_status imp_scene_hold(impact_scene *scene, int opened, bool rejoin)
{
    imp_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) world->pairs[p].settled = p == opened;
    impact_status status = make_consistent(scene);
    while (rejoin && status == IMPACT_OK) {
        imp_meeting m;
        status = imp_scene_load_with_reactions(scene);
        const int p = status == IMPACT_OK ? find_pressed(scene, &m) : -1;
        if (p < 0) break;
        imp_pair *pair = &world->pairs[p];
        pair->settled = true;
        pair->onset = false;
        pair->mode = held_mode(&m.touch, m.touch.speed > world->slip_speed);
        status = make_consistent(scene);
    }
    if (status == IMPACT_OK) status = lie_down(scene);
    if (status == IMPACT_OK) world->usage.reactions_chosen += hangs_on_choice(scene);
    if (status == IMPACT_OK) status = imp_scene_load(scene);
    if (status == IMPACT_OK) status = record_changes(scene);
    return status == IMPACT_OK ? bring_to_rest(scene) : status;
}
