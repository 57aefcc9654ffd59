/* SPDX-License-Identifier: MIT
 *
 * What happens at one instant: impacts, until no touching pair approaches, then the contacts that are held; and what
 * the ends of stretches of motion stand for.
 */
#include "base/tolerances.h"
#include "contact/held_flat.h"
#include "contact/held_line.h"
#include "contact/points.h"
#include "scene/gliding.h"
#include "scene/scene_events.h"
#include "scene/scene_hold.h"
#include "scene/scene_meeting.h"
#include "scene/scene_points.h"
#include "scene/scene_strike.h"
#include "world/corner.h"
#include "world/world_gap.h"

#include <string.h>

/* What lay on a face is to be found anew, on a flat place it is held there; whether anything did. */
static bool rise_from_faces(imp_island *island)
{
    bool lay = false;
    for (int p = 0; p < island->world.pair_count; p++) {
        if (island->world.pairs[p].footing.on != IMP_FOOT_FACE) continue;
        if (imp_island_hold_line(island, p) || imp_island_hold_flat(island, p)) continue;
        island->world.pairs[p].footing.on = IMP_FOOT_POINT;
        lay = true;
    }
    return lay;
}

static impact_status hold_on(imp_island *island, int opened, bool rejoin)
{
    impact_status status = imp_scene_hold(island, opened, rejoin);
    if (status == IMPACT_OK && !island->lies) status = imp_island_glide_on_lines(island);
    return status == IMPACT_OK ? imp_island_glide_on_flats(island) : status;
}

/* Modes changed without an impact; if what slides is drawn on now there is one. */
static impact_status hold(imp_island *island, int opened, bool rejoin)
{
    bool struck;
    const impact_status status = imp_scene_strike_drawn(island, &struck);
    if (status != IMPACT_OK) return status;
    return struck ? imp_scene_settle(island) : hold_on(island, opened, rejoin);
}

impact_status imp_scene_settle(imp_island *island)
{
    const bool lay = rise_from_faces(island);
    impact_status status = imp_scene_place_points(island);
    if (status != IMPACT_OK) return status;
    imp_scene_remember(island);
    const double account = imp_scene_undriven_energy(island) + island->impact_loss;
    bool parted, glides = false;
    for (bool struck = true; status == IMPACT_OK && struck;) {
        struck = false;
        status = imp_scene_strike_all(island, &parted);
        imp_stay stay = status == IMPACT_OK && !parted ? imp_scene_points_stay(island) : IMP_STAY_NONE;
        if (stay == IMP_STAY_FACES) status = imp_island_lay(island, lay, &glides);
        if (glides && status == IMPACT_OK) stay = imp_scene_points_stay(island);
        island->lies = stay == IMP_STAY_FACES;
        if (status != IMPACT_OK || parted || island->lies) break;
        imp_scene_choose_modes(island);
        status = imp_scene_strike_drawn(island, &struck);
        if (status == IMPACT_OK && !struck) status = hold_on(island, -1, glides);
    }
    imp_scene_drop_points(island);
    island->impact_loss = account - imp_scene_undriven_energy(island);
    return status;
}

/* How many points of bodies with faces the island's pairs were made. */
static int placed_points(const imp_world *world)
{
    int count = 0;
    for (int p = 0; p < world->pair_count; p++) count += world->pairs[p].site.placed;
    return count;
}

impact_status imp_scene_strike_steps(imp_island *island)
{
    imp_world *world = &island->world;
    const int count = world->pair_count;
    imp_pair *pairs = imp_arena_take(world->arena, (size_t)count, sizeof *pairs);
    if (!pairs) return IMPACT_ENOMEM;
    memcpy(pairs, world->pairs, sizeof *pairs * (size_t)count);
    impact_status status = imp_scene_place_points(island);
    const int points = placed_points(world);
    if (status == IMPACT_OK && points > 0 && points <= IMP_PILE_DENSE) {
        bool parted;
        imp_scene_remember(island);
        const double account = imp_scene_undriven_energy(island) + island->impact_loss;
        status = imp_scene_strike_all(island, &parted);
        island->impact_loss = account - imp_scene_undriven_energy(island);
    }
    memcpy(world->pairs, pairs, sizeof *pairs * (size_t)count);
    world->pair_count = count;
    imp_arena_give(world->arena, pairs);
    return status;
}

/* ---- the ends of stretches of motion ---- */

/* Of what touches: every point's contact is to be closed, and pairs[p]. */
static impact_status list_landing(imp_island *island, int p)
{
    const imp_pair arriving = island->world.pairs[p];
    const impact_status status = imp_scene_place_points(island);
    for (int k = 0; status == IMPACT_OK && k < island->world.pair_count; k++) {
        imp_pair *pair = &island->world.pairs[k];
        if (pair->site.placed || imp_same_bodies(pair, &arriving)) pair->mode = IMP_SLIDE;
    }
    return status == IMPACT_OK ? imp_held_reserve(&island->motion.held, &island->world, island->states) : status;
}

/* Takes the gaps of what lands to zero with those of what is held, none at the cost of another: putting back what was
 * held has moved the rest by the integrator's error, and steps leave what flies from them as near as they err. The
 * energy that closing takes or gives stands under impacts: of two thousand landings it was 1e-9 of all. */
static impact_status close_landing(imp_island *island, int p)
{
    imp_world *world = &island->world;
    const double energy = imp_island_energy(island);
    const int count = world->pair_count;
    imp_pair *pairs = imp_arena_take(world->arena, (size_t)count, sizeof *pairs);
    impact_status status = pairs ? IMPACT_OK : IMPACT_ENOMEM;
    if (pairs) memcpy(pairs, world->pairs, sizeof *pairs * (size_t)count);
    for (int round = 0; status == IMPACT_OK && round < IMP_HELD_ROUNDS; round++) {
        status = list_landing(island, p);
        if (status == IMPACT_OK) imp_held_close_gaps(&island->motion.held, world, island->states);
        memcpy(world->pairs, pairs, sizeof *pairs * (size_t)count);
        world->pair_count = count;
    }
    imp_arena_give(world->arena, pairs);
    const double given = imp_island_energy(island) - energy;
    island->impact_loss -= given;
    island->gained += fmax(0, given);
    return status == IMPACT_OK ? imp_held_reserve(&island->motion.held, world, island->states) : status;
}

static impact_status arrive(imp_island *island, int p)
{
    imp_world *world = &island->world;
    imp_pair *pair = &world->pairs[p];
    impact_contact contact;
    imp_world_gap(world, pair, island->states, &contact);
    if (imp_world_inside_bounds(world, pair, island->states, &contact) < 0) {
        pair->mode = IMP_BEYOND;
        return IMPACT_OK;
    }
    /* a rounding, of the gap or of the time; many would sum up */
    if (contact.gap < 0 || contact.gap > imp_world_touching_distance(world, pair, island->states)) {
        const impact_status status = close_landing(island, p);
        if (status != IMPACT_OK) return status;
    }
    return imp_scene_settle(island);
}

/* The contact changes its mode, and the rest follows. */
static impact_status change_mode(imp_island *island, int p, imp_mode mode)
{
    imp_scene_remember(island);
    imp_pair *pair = &island->world.pairs[p];
    pair->mode = mode;
    imp_end_incipient(pair);
    const double account = imp_scene_undriven_energy(island) + island->impact_loss;
    const impact_status status = hold(island, imp_mode_holds(mode) ? -1 : p, true);
    island->impact_loss = account - imp_scene_undriven_energy(island);
    return status;
}

/* A rolling contact's friction has reached its cone: it slides, against the friction that held it; where reactions are
 * not unique it may have another: that is asked (held_modes.c). */
static impact_status begin_slide(imp_island *island, int p)
{
    imp_scene_remember(island);
    imp_held *held = &island->motion.held;
    const impact_status status = imp_scene_load(island);
    if (status != IMPACT_OK) return status;
    imp_held_solve(held, &island->world, island->states, island->motion.loads);
    imp_pair *pair = &island->world.pairs[p];
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (contact->pair != p) continue;
        imp_held_begin_slide(pair, contact);
        if (contact->redundant) pair->mode = IMP_STICK;
    }
    return hold(island, -1, true);
}

/* Whether it is the face or the line that a pair's centre of pressure has left, not the plane; the body then tips. */
static bool tips(imp_island *island, int p)
{
    imp_world *world = &island->world;
    imp_held *held = &island->motion.held;
    imp_pair *pair = &world->pairs[p];
    imp_scene_remember(island);
    if ((pair->footing.on != IMP_FOOT_FLAT && pair->footing.on != IMP_FOOT_LINE) || imp_scene_load(island) != IMPACT_OK)
        return false;
    imp_held_solve(held, world, island->states, island->motion.loads);
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (contact->pair != p) continue;
        if (contact->foot == IMP_FOOT_FLAT && contact->spare <= IMP_SPARE_SPENT)
            imp_flat_tip(world, pair, island->states, contact);
        else if (contact->foot == IMP_FOOT_LINE &&
                 imp_line_spare(world, contact, island->states, island->motion.loads) <= IMP_SPARE_SPENT)
            pair->footing.on = IMP_FOOT_SPOT;
        else
            return false;
        return true;
    }
    return false;
}

/* A few roundings of t on: a law that compares for itself where it stands is then asked beyond its edge. */
static void step_over(imp_island *island, int body)
{
    const double later = fmin(island->t + IMP_SWITCH_ROUNDING * fabs(island->t), island->scene->duration);
    imp_state *state = &island->states[body];
    state->x = qvec3_axpy(later - island->t, state->v, state->x);
    island->t = fmax(island->t, later);
}

static impact_status cross_edge(imp_island *island, int edge)
{
    int field, body;
    imp_scene_remember(island);
    imp_field_cross(&island->world, edge, &field, &body);
    if (island->world.fields[field].def.kind == IMPACT_FORCE_CUSTOM) step_over(island, body);
    impact_event event = imp_scene_event_of_body(island, IMPACT_EVENT_FORCE, body);
    event.name2 = island->world.fields[field].name;
    const impact_status status = imp_scene_record(island, &event);
    return status == IMPACT_OK ? hold(island, -1, true) : status;
}

/* Held contacts are put back. */
static impact_status renew(imp_island *island)
{
    imp_scene_remember(island);
    return hold(island, -1, true);
}

/* What glided on a face has stopped. */
static impact_status stop_gliding(imp_island *island, int p)
{
    const imp_pair *pair = &island->world.pairs[p];
    const bool flat = !imp_pair_has_faces(&island->world, pair); /* it is held, and tells it then */
    imp_scene_remember(island);
    if (pair->site.corner > 0) {
        imp_island_stop_on_line(island, p);
        return imp_scene_settle(island);
    }
    island->states[pair->body1].v = island->states[pair->body1].momentum = (qvec3){0, 0, 0};
    if (flat) return imp_scene_settle(island);
    const imp_held_contact contact = imp_held_contact_at(&island->world, p, island->states, island->motion.loads);
    impact_event event = imp_scene_event_of_contact(island, IMPACT_EVENT_STICK, &contact);
    event.phases = "roll";
    const impact_status status = imp_scene_record(island, &event);
    return status == IMPACT_OK ? imp_scene_settle(island) : status;
}

/* Another corner than pairs[p]'s has landed, or that has come to a border. */
static impact_status land(imp_island *island, int p)
{
    const impact_status status = close_landing(island, p);
    return status == IMPACT_OK ? imp_scene_settle(island) : status;
}

impact_status imp_scene_handle(imp_island *island, imp_end end)
{
    switch (end.kind) {
    case IMP_END_TIME: return IMPACT_OK;
    case IMP_END_GAP: return arrive(island, end.index);
    case IMP_END_BOUNDS:
        if (island->world.pairs[end.index].footing.on == IMP_FOOT_FACE)
            return imp_scene_settle(island); /* its face has come to an end */
        if (island->world.pairs[end.index].site.corner > 0) return land(island, end.index);
        if (tips(island, end.index)) return hold(island, -1, true);
        return change_mode(island, end.index, IMP_BEYOND);
    case IMP_END_LIFTOFF: return change_mode(island, end.index, IMP_OPEN);
    case IMP_END_SLIP: return begin_slide(island, end.index);
    case IMP_END_STICK:
        if (island->world.pairs[end.index].footing.on == IMP_FOOT_FACE) return stop_gliding(island, end.index);
        return change_mode(island, end.index, IMP_STICK);
    case IMP_END_EDGE: return cross_edge(island, end.index);
    case IMP_END_SLOW:
        imp_scene_remember(island);
        island->motion.resting[end.index] = false; /* it wakes, or comes to rest only now */
        return hold(island, -1, true);
    case IMP_END_RENEWAL: return renew(island);
    }
    return IMPACT_OK;
}
