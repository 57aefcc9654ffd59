/* SPDX-License-Identifier: MIT
 *
 * What happens at one instant: impacts, until no touching pair approaches, then the contacts that are held; and what
 * the ends of stretches of motion stand for.
 */
#include "persist_flat.h"
#include "persist_line.h"
#include "scene_events.h"
#include "scene_hold.h"
#include "scene_meeting.h"
#include "scene_strike.h"
#include "world_gap.h"

impact_status impact_scene_settle(impact_scene *scene)
{
    impact_scene_remember(scene);
    const double account = impact_scene_undriven_energy(scene) + scene->impact_loss;
    impact_status status = impact_scene_strike_all(scene);
    if (status == IMPACT_OK) {
        impact_scene_choose_modes(scene);
        status = impact_scene_hold(scene, -1, false);
    }
    scene->impact_loss = account - impact_scene_undriven_energy(scene);
    return status;
}

/* ---- the ends of stretches of motion ---- */

static impact_status arrive(impact_scene *scene, int p)
{
    impact_world *world = &scene->world;
    impact_pair *pair = &world->pairs[p];
    impact_contact contact;
    impact_world_gap(world, pair, scene->states, &contact);
    if (impact_world_inside_bounds(world, pair, scene->states, &contact) < 0) {
        pair->beyond = true;
        return IMPACT_OK;
    }
    if (contact.gap < 0)
        impact_persist_close_gap(world, pair, &contact, scene->states); /* a rounding; many would sum up */
    return impact_scene_settle(scene);
}

/* The contact changes its mode, and the rest follows. */
static impact_status change_mode(impact_scene *scene, int p, impact_mode mode)
{
    impact_scene_remember(scene);
    impact_pair *pair = &scene->world.pairs[p];
    pair->mode = mode;
    pair->onset = false;
    const double account = impact_scene_undriven_energy(scene) + scene->impact_loss;
    const impact_status status = impact_scene_hold(scene, mode == IMPACT_OPEN ? p : -1, true);
    scene->impact_loss = account - impact_scene_undriven_energy(scene);
    return status;
}

/* A rolling contact's friction has reached its cone: it slides, against the friction that held it. */
static impact_status begin_slide(impact_scene *scene, int p)
{
    impact_scene_remember(scene);
    impact_persist *persist = &scene->motion.persist;
    const impact_status status = impact_scene_load(scene);
    if (status != IMPACT_OK) return status;
    impact_persist_solve(persist, &scene->world, scene->states, scene->motion.loads);
    for (int c = 0; c < persist->count; c++)
        if (persist->touches[c].pair == p) impact_persist_begin_slide(&scene->world.pairs[p], &persist->touches[c]);
    return impact_scene_hold(scene, -1, true);
}

/* Whether it is the face or the line that a pair's centre of pressure has left, not the plane; the body then tips. */
static bool tips(impact_scene *scene, int p)
{
    const double spent = 1e-6; /* of its spare, as a root leaves it */
    impact_world *world = &scene->world;
    impact_persist *persist = &scene->motion.persist;
    impact_pair *pair = &world->pairs[p];
    impact_scene_remember(scene);
    if ((!pair->flat && !pair->lined) || impact_scene_load(scene) != IMPACT_OK) return false;
    impact_persist_solve(persist, world, scene->states, scene->motion.loads);
    for (int c = 0; c < persist->count; c++) {
        const impact_touch *touch = &persist->touches[c];
        if (touch->pair != p) continue;
        if (touch->flat && touch->spare <= spent)
            impact_flat_tip(world, pair, scene->states, touch);
        else if (touch->lined && impact_line_spare(world, touch, scene->states, scene->motion.loads) <= spent)
            pair->lined = false;
        else
            return false;
        return true;
    }
    return false;
}

static impact_status cross_edge(impact_scene *scene, int edge)
{
    int field, body;
    impact_scene_remember(scene);
    impact_field_cross(&scene->world, edge, &field, &body);
    impact_event event = impact_scene_event_of_body(scene, IMPACT_EVENT_FORCE, body);
    event.name2 = scene->world.fields[field].name;
    const impact_status status = impact_scene_record(scene, &event);
    return status == IMPACT_OK ? impact_scene_hold(scene, -1, true) : status;
}

/* Held contacts are put back, and those that others hold are asked again whether they must give way. */
static impact_status renew(impact_scene *scene)
{
    impact_scene_remember(scene);
    const impact_status status = impact_scene_load(scene);
    if (status != IMPACT_OK) return status;
    impact_persist_stop_onsets(&scene->motion.persist, &scene->world, scene->states, scene->motion.loads);
    return impact_scene_hold(scene, -1, true);
}

impact_status impact_scene_handle(impact_scene *scene, impact_end end)
{
    switch (end.kind) {
    case IMPACT_END_TIME: return IMPACT_OK;
    case IMPACT_END_GAP: return arrive(scene, end.index);
    case IMPACT_END_RETURN: scene->world.pairs[end.index].beyond = false; return IMPACT_OK;
    case IMPACT_END_BOUNDS:
        if (tips(scene, end.index)) return impact_scene_hold(scene, -1, true);
        scene->world.pairs[end.index].beyond = true;
        return change_mode(scene, end.index, IMPACT_OPEN);
    case IMPACT_END_LIFTOFF: return change_mode(scene, end.index, IMPACT_OPEN);
    case IMPACT_END_SLIP: return begin_slide(scene, end.index);
    case IMPACT_END_STICK: return change_mode(scene, end.index, IMPACT_ROLL);
    case IMPACT_END_EDGE: return cross_edge(scene, end.index);
    case IMPACT_END_SLOW: impact_scene_remember(scene); return impact_scene_hold(scene, -1, true);
    case IMPACT_END_RENEWAL: return renew(scene);
    }
    return IMPACT_OK;
}
