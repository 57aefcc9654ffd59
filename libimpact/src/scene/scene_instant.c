/* SPDX-License-Identifier: MIT
 *
 * What happens at one instant: impacts, until no touching pair approaches, then the contacts that are held; and what
 * the ends of stretches of motion stand for.
 */
#include "contact/persist_flat.h"
#include "contact/persist_line.h"
#include "scene/scene_events.h"
#include "scene/scene_hold.h"
#include "scene/scene_meeting.h"
#include "scene/scene_strike.h"
#include "world/world_gap.h"

impact_status imp_scene_settle(impact_scene *scene)
{
    imp_scene_remember(scene);
    const double account = imp_scene_undriven_energy(scene) + scene->impact_loss;
    impact_status status = imp_scene_strike_all(scene);
    if (status == IMPACT_OK) {
        imp_scene_choose_modes(scene);
        status = imp_scene_hold(scene, -1, false);
    }
    scene->impact_loss = account - imp_scene_undriven_energy(scene);
    return status;
}

/* ---- the ends of stretches of motion ---- */

static impact_status arrive(impact_scene *scene, int p)
{
    imp_world *world = &scene->world;
    imp_pair *pair = &world->pairs[p];
    impact_contact contact;
    imp_world_gap(world, pair, scene->states, &contact);
    if (imp_world_inside_bounds(world, pair, scene->states, &contact) < 0) {
        pair->beyond = true;
        return IMPACT_OK;
    }
    if (contact.gap < 0)
        imp_persist_close_gap(world, pair, &contact, scene->states); /* a rounding; many would sum up */
    return imp_scene_settle(scene);
}

/* The contact changes its mode, and the rest follows. */
static impact_status change_mode(impact_scene *scene, int p, imp_mode mode)
{
    imp_scene_remember(scene);
    imp_pair *pair = &scene->world.pairs[p];
    pair->mode = mode;
    pair->onset = false;
    const double account = imp_scene_undriven_energy(scene) + scene->impact_loss;
    const impact_status status = imp_scene_hold(scene, mode == IMP_OPEN ? p : -1, true);
    scene->impact_loss = account - imp_scene_undriven_energy(scene);
    return status;
}

/* A rolling contact's friction has reached its cone: it slides, against the friction that held it. */
static impact_status begin_slide(impact_scene *scene, int p)
{
    imp_scene_remember(scene);
    imp_persist *persist = &scene->motion.persist;
    const impact_status status = imp_scene_load(scene);
    if (status != IMPACT_OK) return status;
    imp_persist_solve(persist, &scene->world, scene->states, scene->motion.loads);
    for (int c = 0; c < persist->count; c++)
        if (persist->touches[c].pair == p) imp_persist_begin_slide(&scene->world.pairs[p], &persist->touches[c]);
    return imp_scene_hold(scene, -1, true);
}

/* Whether it is the face or the line that a pair's centre of pressure has left, not the plane; the body then tips. */
static bool tips(impact_scene *scene, int p)
{
    const double spent = 1e-6; /* of its spare, as a root leaves it */
    imp_world *world = &scene->world;
    imp_persist *persist = &scene->motion.persist;
    imp_pair *pair = &world->pairs[p];
    imp_scene_remember(scene);
    if ((!pair->flat && !pair->lined) || imp_scene_load(scene) != IMPACT_OK) return false;
    imp_persist_solve(persist, world, scene->states, scene->motion.loads);
    for (int c = 0; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        if (touch->pair != p) continue;
        if (touch->flat && touch->spare <= spent)
            imp_flat_tip(world, pair, scene->states, touch);
        else if (touch->lined && imp_line_spare(world, touch, scene->states, scene->motion.loads) <= spent)
            pair->lined = false;
        else
            return false;
        return true;
    }
    return false;
}

/* A few roundings of t on: a law that compares for itself where it stands is then asked beyond its edge. */
static void step_over(impact_scene *scene, int body)
{
    const double later = scene->t + IMP_SWITCH_ROUNDING * fabs(scene->t);
    imp_state *state = &scene->states[body];
    state->x = qvec3_axpy(later - scene->t, state->v, state->x);
    scene->t = fmin(later, scene->duration);
}

static impact_status cross_edge(impact_scene *scene, int edge)
{
    int field, body;
    imp_scene_remember(scene);
    imp_field_cross(&scene->world, edge, &field, &body);
    if (scene->world.fields[field].def.kind == IMPACT_FORCE_CUSTOM) step_over(scene, body);
    impact_event event = imp_scene_event_of_body(scene, IMPACT_EVENT_FORCE, body);
    event.name2 = scene->world.fields[field].name;
    const impact_status status = imp_scene_record(scene, &event);
    return status == IMPACT_OK ? imp_scene_hold(scene, -1, true) : status;
}

/* Held contacts are put back, and those that others hold are asked again whether they must give way. */
static impact_status renew(impact_scene *scene)
{
    imp_scene_remember(scene);
    const impact_status status = imp_scene_load(scene);
    if (status != IMPACT_OK) return status;
    imp_persist_stop_onsets(&scene->motion.persist, &scene->world, scene->states, scene->motion.loads);
    return imp_scene_hold(scene, -1, true);
}

impact_status imp_scene_handle(impact_scene *scene, imp_end end)
{
    switch (end.kind) {
    case IMP_END_TIME: return IMPACT_OK;
    case IMP_END_GAP: return arrive(scene, end.index);
    case IMP_END_RETURN: scene->world.pairs[end.index].beyond = false; return IMPACT_OK;
    case IMP_END_BOUNDS:
        if (tips(scene, end.index)) return imp_scene_hold(scene, -1, true);
        scene->world.pairs[end.index].beyond = true;
        return change_mode(scene, end.index, IMP_OPEN);
    case IMP_END_LIFTOFF: return change_mode(scene, end.index, IMP_OPEN);
    case IMP_END_SLIP: return begin_slide(scene, end.index);
    case IMP_END_STICK: return change_mode(scene, end.index, IMP_ROLL);
    case IMP_END_EDGE: return cross_edge(scene, end.index);
    case IMP_END_SLOW:
        imp_scene_remember(scene);
        scene->motion.resting[end.index] = false; /* it wakes, or comes to rest only now */
        return imp_scene_hold(scene, -1, true);
    case IMP_END_RENEWAL: return renew(scene);
    }
    return IMPACT_OK;
}
