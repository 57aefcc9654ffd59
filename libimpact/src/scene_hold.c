/* SPDX-License-Identifier: MIT */
#include "scene_hold.h"
#include "drive.h"
#include "persist_flat.h"
#include "persist_line.h"
#include "persist_still.h"
#include "scene_events.h"
#include "scene_meeting.h"

#include <stdio.h>

/* What has no friction slides even where it stands still. */
static impact_mode held_mode(const impact_touch *touch, bool slides)
{
    return slides || touch->friction == 0 ? IMPACT_SLIDE : IMPACT_ROLL;
}

void impact_scene_choose_modes(impact_scene *scene)
{
    impact_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) {
        impact_meeting m;
        impact_pair *pair = &world->pairs[p];
        if (!impact_scene_meets(scene, p, &m)) continue;
        const bool stays =
            m.acceleration < 0 ? impact_scene_dies_out(scene, &m, m.velocity) : m.velocity <= world->slip_speed;
        const bool slides = m.touch.speed > world->slip_speed || (impact_is_held(pair) && m.touch.onset);
        pair->mode = stays ? held_mode(&m.touch, slides) : IMPACT_OPEN;
        pair->onset = slides && m.touch.onset && m.touch.speed < world->onset_speed;
    }
}

static impact_event_kind change_of_mode(impact_mode before, impact_mode now)
{
    if (now == IMPACT_OPEN) return IMPACT_EVENT_LIFTOFF;
    if (before == IMPACT_OPEN) return IMPACT_EVENT_CONTACT;
    return now == IMPACT_ROLL ? IMPACT_EVENT_STICK : IMPACT_EVENT_SLIP;
}

static impact_status record_changes(impact_scene *scene)
{
    impact_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) {
        const impact_mode now = world->pairs[p].mode;
        if (now == scene->modes[p]) continue;
        const impact_touch touch = impact_persist_touch(world, p, scene->states, scene->motion.loads);
        impact_event event = impact_scene_event_of_touch(scene, change_of_mode(scene->modes[p], now), &touch);
        const bool stands = touch.friction == 0 && touch.speed <= world->slip_speed;
        event.phases = now == IMPACT_OPEN ? "" : now == IMPACT_ROLL || stands ? "roll" : "slide";
        scene->motion.resting[touch.body1] = scene->motion.resting[touch.body2] = false;
        const impact_status status = impact_scene_record(scene, &event);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

/* How fast any point of the body moves at most, m/s. */
static double fastest_point(const impact_body *body, const impact_state *state)
{
    return qvec3_norm(state->v) + body->radius * qvec3_norm(impact_omega(body, state));
}

/* A body that is slower than the rest speed, held, and not accelerated, is at rest. */
static bool comes_to_rest(const impact_scene *scene, int body)
{
    const impact_body *b = &scene->world.bodies[body];
    const impact_state *s = &scene->states[body];
    if (b->is_static || scene->motion.resting[body]) return false;
    if (fastest_point(b, s) > scene->rest_speed) return false;
    qvec3 force = scene->motion.loads[body].force, torque = scene->motion.loads[body].torque;
    bool held = false;
    for (int c = 0; c < scene->motion.persist.count; c++) {
        const impact_touch *touch = &scene->motion.persist.touches[c];
        if (touch->body1 != body && touch->body2 != body) continue;
        if (touch->still) return true;
        const bool fades = touch->mode == IMPACT_SLIDE && !touch->onset && touch->friction > 0;
        if (fades && touch->speed <= 2 * scene->rest_speed) return false; /* it sticks first */
        held = true;
        const qvec3 f = touch->body1 == body ? touch->force : qvec3_neg(touch->force);
        force = qvec3_add(force, f);
        torque = qvec3_add(torque, qvec3_cross(touch->body1 == body ? touch->r1 : touch->r2, f));
    }
    const double acceleration =
        qvec3_norm(force) * b->inverse_mass + b->radius * qvec3_norm(impact_inverse_inertia(b, s->q, torque));
    return held && acceleration < 100 * scene->rest_speed;
}

static impact_status bring_to_rest(impact_scene *scene)
{
    for (int i = 0; i < scene->world.body_count; i++) {
        if (!comes_to_rest(scene, i)) continue;
        scene->states[i].v = scene->states[i].momentum = (qvec3){0, 0, 0};
        scene->motion.resting[i] = true;
        const impact_event event = impact_scene_event_of_body(scene, IMPACT_EVENT_REST, i);
        const impact_status status = impact_scene_record(scene, &event);
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
    impact_motion *motion = &scene->motion;
    impact_world *world = &scene->world;
    const double jam_speed = fmax(scene->rest_speed, sqrt(2 * qvec3_norm(world->gravity) * scene->rest_height));
    const impact_status status =
        impact_persist_find_still(&motion->persist, world, scene->states, motion->loads, scene->rest_speed, jam_speed);
    for (int p = 0; status == IMPACT_OK && p < world->pair_count; p++) {
        const impact_pair *pair = &world->pairs[p];
        if (!impact_is_held(pair) || !pair->still) continue;
        stop(scene, pair->body1);
        stop(scene, pair->body2);
    }
    return status;
}

/* Puts the constraints of the contacts that are held in order, and opens those that would pull. */
static impact_status make_consistent(impact_scene *scene)
{
    impact_motion *motion = &scene->motion;
    impact_persist_stir(&scene->world);
    impact_status status = impact_persist_reserve(&motion->persist, &scene->world, scene->states);
    if (status == IMPACT_OK) status = impact_scene_load(scene);
    if (status != IMPACT_OK) return status;
    impact_persist_project(&motion->persist, &scene->world, scene->states, motion->loads);
    motion->works.drive += impact_drive_power(&motion->persist, &scene->world);
    status = impact_scene_load(scene);
    if (status == IMPACT_OK) status = find_still(scene);
    if (status == IMPACT_OK)
        status = impact_persist_resolve(&motion->persist, &scene->world, scene->states, motion->loads);
    if (status == IMPACT_EUNSETTLED)
        snprintf(scene->message, sizeof scene->message, "no consistent set of contact forces found at t = %.17g",
                 scene->t);
    return status;
}

/* The first open pair that touches, is all but still along the normal, and is pressed together by the loads and the
 * reactions; or -1. */
static int find_pressed(impact_scene *scene, impact_meeting *m)
{
    impact_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) {
        impact_pair *pair = &world->pairs[p];
        if (impact_is_held(pair) || pair->settled || !impact_scene_meets(scene, p, m)) continue;
        const impact_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
        const double push1 = qvec3_norm(scene->motion.loads[pair->body1].force) * b1->inverse_mass,
                     push2 = qvec3_norm(scene->motion.loads[pair->body2].force) * b2->inverse_mass;
        const double pressed = -1e-9 * (push1 + push2);
        if (m->acceleration < pressed && impact_scene_dies_out(scene, m, m->velocity)) return p;
    }
    return -1;
}

/* What rocks on a face too low to be seen lies on it; the energy is given up. */
static impact_status lie_down(impact_scene *scene)
{
    const double energy = impact_scene_undriven_energy(scene);
    impact_status status = impact_scene_load(scene);
    if (status != IMPACT_OK) return status;
    const bool flat = impact_flat_lay(&scene->world, scene->states, scene->motion.loads);
    const bool lined = impact_line_lay(&scene->motion.persist, &scene->world, scene->states, scene->motion.loads);
    if (!flat && !lined) return status;
    status = make_consistent(scene);
    scene->impact_loss += energy - impact_scene_undriven_energy(scene);
    return status;
}

/* Whether a body that moves is held with friction by reactions that are not unique. */
static bool hangs_on_choice(const impact_scene *scene)
{
    const impact_persist *persist = &scene->motion.persist;
    for (int c = 0; c < persist->count; c++) {
        const impact_touch *touch = &persist->touches[c];
        if (touch->still || !touch->redundant || !(touch->friction > 0)) continue;
        const int bodies[2] = {touch->body1, touch->body2};
        for (int k = 0; k < 2; k++) {
            const impact_body *body = &scene->world.bodies[bodies[k]];
            const impact_state *state = &scene->states[bodies[k]];
            if (!body->is_static && fastest_point(body, state) > scene->rest_speed) return true;
        }
    }
    return false;
}

impact_status impact_scene_hold(impact_scene *scene, int opened, bool rejoin)
{
    impact_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) world->pairs[p].settled = p == opened;
    impact_status status = make_consistent(scene);
    while (rejoin && status == IMPACT_OK) {
        impact_meeting m;
        status = impact_scene_load_with_reactions(scene);
        const int p = status == IMPACT_OK ? find_pressed(scene, &m) : -1;
        if (p < 0) break;
        impact_pair *pair = &world->pairs[p];
        pair->settled = true;
        pair->onset = false;
        pair->mode = held_mode(&m.touch, m.touch.speed > world->slip_speed);
        status = make_consistent(scene);
    }
    if (status == IMPACT_OK) status = lie_down(scene);
    if (status == IMPACT_OK) world->usage.reactions_chosen += hangs_on_choice(scene);
    if (status == IMPACT_OK) status = impact_scene_load(scene);
    if (status == IMPACT_OK) status = record_changes(scene);
    return status == IMPACT_OK ? bring_to_rest(scene) : status;
}
