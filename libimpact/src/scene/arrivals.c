/* SPDX-License-Identifier: MIT */
#include "scene/arrivals.h"
#include "base/number.h"
#include "base/tolerances.h"
#include "scene/coarser.h"
#include "scene/following.h"
#include "scene/gather.h"
#include "scene/islands.h"
#include "scene/parting.h"
#include "scene/rolling.h"
#include "scene/scene_events.h"
#include "scene/scene_keys.h"
#include "scene/scene_methods.h"
#include "scene/scene_points.h"
#include "scene/scene_receipt.h"
#include "scene/stepped.h"
#include "world/corner.h"

#include <stdio.h>

/* A body has no end of events at one time. */
static impact_status check_stall(impact_scene *scene, const imp_island *island)
{
    for (int i = 0; i < island->world.body_count; i++) {
        const imp_body *body = &island->world.bodies[i];
        imp_track *track = &scene->tracks.tracks[body->index];
        if (body->is_static) continue;
        track->stalls = track->last_event == island->t ? track->stalls + 1 : 0;
        track->last_event = island->t;
        if (track->stalls < IMP_EVENTS_AT_ONCE * (1 + track->companion_count)) continue;
        snprintf(scene->message, sizeof scene->message, "body '%s': %d events at the one instant t = %s brought no end",
                 body->name, track->stalls, imp_number_of(island->t).text);
        return IMPACT_EUNSETTLED;
    }
    return IMPACT_OK;
}

/* The scene has failed: nothing moves on, and nothing is lost. */
static void give_up(imp_island *loose)
{
    while (loose) {
        imp_island *part = loose;
        loose = part->next;
        part->next = NULL;
        imp_islands_release(part);
    }
}

static impact_status conclude_steps(imp_island *island);

static bool holds_any(const imp_island *island)
{
    for (int p = 0; p < island->world.pair_count; p++)
        if (imp_is_held(&island->world.pairs[p])) return true;
    return false;
}

/* What is held, and the exact way does not settle, goes on by steps: of corners and flat places more may hold than
 * there are motions, and in three of six hundred heaps of balls no contact forces are found; steps ask for impulses,
 * which may be there all the same. */
static void step_where_unsettled(imp_island *island, impact_status *status)
{
    if (*status != IMPACT_EUNSETTLED || island->scene->piles == IMPACT_PILES_EXACT || !holds_any(island)) return;
    *status = IMPACT_OK;
    island->lies = true;
    island->scene->message[0] = '\0';
}

/* What is settled goes on, whatever became of the rows. */
static impact_status conclude(imp_island *island, impact_status status)
{
    impact_scene *scene = island->scene;
    step_where_unsettled(island, &status);
    const bool impatient = imp_island_loses_patience(island, 0, false);
    if (status == IMPACT_OK && (island->lies || impatient || imp_island_needs_steps(island))) {
        imp_island *stepped;
        imp_scene_receipt_look(island);
        status = imp_gather_steps(island, &stepped);
        if (status == IMPACT_OK) return conclude_steps(stepped);
    }
    const impact_status stalled = check_stall(scene, island);
    imp_island *loose;
    if (status != IMPACT_OK) {
        imp_island_fail(island, status);
        imp_island_part_ways(island, &loose);
        give_up(loose);
        return status;
    }
    if (!island->stepped) imp_scene_receipt_look(island);
    impact_status parted = imp_island_part_ways(island, &loose);
    while (loose && parted == IMPACT_OK) {
        imp_island *part = loose;
        loose = part->next;
        part->next = NULL;
        parted = conclude(part, imp_scene_settle(part));
    }
    give_up(loose);
    if (parted != IMPACT_OK || stalled != IMPACT_OK) return parted != IMPACT_OK ? parted : stalled;
    return imp_scene_account_after(scene) ? IMPACT_OK : IMPACT_ESINK;
}

static impact_status bring_all_to_rest(imp_island *island)
{
    imp_scene_remember(island);
    const double energy = imp_island_energy(island);
    /* what were left of overlaps and gaps would stay for ever */
    impact_status status = imp_pile_lay_down(island->pile, &island->world, island->states);
    for (int i = 0; status == IMPACT_OK && i < island->world.body_count; i++) {
        if (island->world.bodies[i].is_static) continue;
        island->states[i].v = island->states[i].momentum = (qvec3){0, 0, 0};
        island->motion.resting[i] = true;
        const impact_event event = imp_scene_event_of_body(island, IMPACT_EVENT_REST, i);
        status = imp_scene_record(island, &event);
    }
    island->impact_loss += energy - imp_island_energy(island);
    return status;
}

/* A pile finds by itself what meets in it, and ties all that is there from its first step; what can stand does. */
static impact_status conclude_steps(imp_island *island)
{
    bool stands;
    const impact_status status = imp_island_can_stand(island, &stands);
    if (status != IMPACT_OK) return conclude(island, status);
    if (stands) return conclude(island, bring_all_to_rest(island));
    for (int p = 0; p < island->world.pair_count; p++) island->world.pairs[p].met = true;
    return conclude(island, IMPACT_OK);
}

/* Whether both bodies go by the same steps, which find by themselves what meets: those answer it, and by one law,
 * whenever the pair has come to be near. */
static bool is_of_one_pile(const impact_scene *scene, const imp_near *near)
{
    const int number = scene->tracks.tracks[near->body[0]].island;
    const imp_island *island = number < 0 ? NULL : scene->islands[number];
    if (!island || !island->stepped || imp_island_all_rest(island)) return false;
    const int i = imp_island_find(island, near->body[0]), j = imp_island_find(island, near->body[1]);
    for (int p = 0; p < island->world.pair_count; p++)
        if (island->world.pairs[p].body1 == i && island->world.pairs[p].body2 == j) return true;
    return false;
}

impact_status imp_scene_meet(impact_scene *scene, int n, double t)
{
    if (is_of_one_pile(scene, &scene->tracks.near[n])) {
        scene->tracks.near[n].held = true;
        imp_tracks_predict(&scene->tracks, n, t);
        return IMPACT_OK;
    }
    if (!imp_scene_account_before(scene)) return IMPACT_ESINK;
    const imp_near *near = &scene->tracks.near[n];
    const int body[2] = {near->body[0], near->body[1]};
    for (int k = 0; k < 2; k++) imp_gather_member(scene, body[k]);
    imp_island *island;
    impact_status status = imp_gather(scene, n, t, scene->piles == IMPACT_PILES_STEPS, &island);
    if (status != IMPACT_OK) return status;
    island->outside = imp_gather_energy_outside(scene, island, t);
    if (island->stepped) {
        status = scene->piles == IMPACT_PILES_STEPS ? IMPACT_OK : imp_scene_strike_steps(island);
        return status == IMPACT_OK ? conclude_steps(island) : conclude(island, status);
    }
    const int i = imp_island_find(island, body[0]), j = imp_island_find(island, body[1]);
    int p = 0;
    while (island->world.pairs[p].body1 != i || island->world.pairs[p].body2 != j) p++;
    imp_pair *pair = &island->world.pairs[p];
    if (pair->mode != IMP_BEYOND) return conclude(island, imp_scene_handle(island, (imp_end){IMP_END_GAP, p}));
    pair->mode = IMP_OPEN; /* before the plane again */
    return conclude(island, IMPACT_OK);
}

impact_status imp_scene_conclude(imp_island *island)
{
    return island->stepped ? conclude_steps(island) : conclude(island, imp_scene_settle(island));
}

/* The island's segments are done. */
static bool finish(imp_island *island)
{
    bool taken = imp_scene_held_until(island);
    for (int i = 0; taken && i < island->world.body_count; i++)
        taken = imp_scene_segment_done(island->scene, island->world.bodies[i].index, island->t, &island->states[i]);
    return taken;
}

static impact_status go_on(imp_island *island)
{
    const impact_status status = imp_island_step_on(island);
    imp_island_look_ahead(island);
    return status;
}

/* What a body stands on has come to its border: what it touches beyond, a face laid flush, is of the island too. */
static bool crosses_border(const imp_island *island)
{
    return island->end.kind == IMP_END_BOUNDS && island->world.pairs[island->end.index].site.face > 0;
}

static impact_status cross_border(impact_scene *scene, imp_island *island, double t)
{
    const imp_pair ended = island->world.pairs[island->end.index];
    const int body[2] = {island->world.bodies[ended.body1].index, island->world.bodies[ended.body2].index};
    imp_island *wider;
    imp_gather_company(scene, body[0]);
    const impact_status status = imp_gather(scene, -1, t, false, &wider);
    if (status != IMPACT_OK) return status;
    wider->outside = imp_gather_energy_outside(scene, wider, t);
    const int i = imp_island_find(wider, body[0]), j = imp_island_find(wider, body[1]);
    for (int p = 0; p < wider->world.pair_count; p++) {
        const imp_pair *pair = &wider->world.pairs[p];
        if (pair->body1 == i && pair->body2 == j && pair->site.corner == ended.site.corner && imp_is_held(pair))
            return conclude(wider, imp_scene_handle(wider, (imp_end){IMP_END_BOUNDS, p}));
    }
    return conclude(wider, imp_scene_settle(wider));
}

/* Whether a rim passes flat, but for a tilt: its lowest place runs round to the other side, where steps, whose error
 * its far side is within, land that side. What it rocks by would lift it far higher than they err. */
static bool rim_passes(const imp_island *island)
{
    const imp_world *world = &island->world;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        if (!imp_is_held(pair) || pair->site.corner == 0) continue;
        const imp_body *body = &world->bodies[pair->body1];
        const double allowed = island->scene->pile_tolerance * body->radius;
        const qvec3 normal = imp_corner_contact(world, pair, island->states, NULL).normal,
                    across = imp_corner_across(world, pair, island->states),
                    tips = qvec3_cross(normal, imp_omega(body, &island->states[pair->body1]));
        const double speed = qvec3_norm(across) * qvec3_norm(tips);
        if (qvec3_dot(normal, across) <= allowed &&
            speed * speed > IMP_RIM_ROCKS * 2 * qvec3_norm(world->gravity) * allowed)
            return true;
    }
    return false;
}

/* Patience is at its end: the island goes on by steps, with all pairs that its bodies may make. */
static impact_status turn_to_steps(impact_scene *scene, imp_island *island, double t)
{
    imp_island *stepped;
    if (rim_passes(island)) imp_coarser_parts(scene);
    imp_gather_company(scene, island->world.bodies[island->world.pairs[0].body1].index);
    const impact_status status = imp_gather(scene, -1, t, true, &stepped);
    return status == IMPACT_OK ? conclude_steps(stepped) : status;
}

/* Where the integrator cannot go on, what corners or flat places hold goes on by steps. */
static impact_status go_on_or_by_steps(impact_scene *scene, imp_island *island, double t)
{
    const impact_status status = go_on(island);
    if (status != IMPACT_EUNSETTLED || scene->piles == IMPACT_PILES_EXACT || !imp_scene_holds_features(island))
        return status;
    scene->message[0] = '\0';
    return turn_to_steps(scene, island, t);
}

/* What stood under forces that change may move again. */
static void wake(imp_island *island)
{
    for (int i = 0; i < island->world.body_count; i++) island->motion.resting[i] = false;
    imp_island_count_moving(island);
}

/* What stands on its face, and no steps hold any more. */
static impact_status leave_steps(imp_island *island)
{
    island->stepped = false;
    island->outside = imp_gather_energy_outside(island->scene, island, island->t);
    return conclude(island, imp_scene_settle(island));
}

static impact_status continue_steps(imp_island *island)
{
    imp_stepped found;
    const impact_status status = imp_island_after_step(island, &found);
    if (status != IMPACT_OK) return imp_island_fail(island, status);
    const bool stood = imp_island_all_rest(island);
    if (found == IMP_STEPPED_LIES) return leave_steps(island);
    if (found == IMP_STEPPED_REST && stood) return go_on(island);
    if (stood) wake(island);
    if (found == IMP_STEPPED_ON) return go_on(island);
    if (found == IMP_STEPPED_LOOK && imp_island_stays_together(island)) {
        imp_island_forget_met(island);
        return go_on(island);
    }
    island->outside = imp_gather_energy_outside(island->scene, island, island->t);
    return conclude(island, found == IMP_STEPPED_REST ? bring_all_to_rest(island) : IMPACT_OK);
}

impact_status imp_scene_continue(impact_scene *scene, imp_island *island)
{
    const double t = island->motion.stride.t;
    if (island->rolls) imp_island_go_to(island, t);
    island->t = t;
    if (island->end.kind != IMP_END_TIME) imp_island_put_back(island);
    if (!finish(island)) return IMPACT_ESINK;
    if (island->stepped) return continue_steps(island);
    if (island->end.kind == IMP_END_TIME &&
        imp_island_loses_patience(island, island->motion.last_rates, island->motion.stride.stood))
        return turn_to_steps(scene, island, t);
    if (island->end.kind == IMP_END_TIME) return go_on_or_by_steps(scene, island, t);
    if (!imp_scene_account_before(scene)) return IMPACT_ESINK;
    if (crosses_border(island)) return cross_border(scene, island, t);
    island->outside = imp_gather_energy_outside(scene, island, t);
    impact_status status = imp_scene_handle(island, island->end);
    while (status == IMPACT_OK && imp_motion_also_crossed(&island->motion, &island->end))
        status = imp_scene_handle(island, island->end);
    return conclude(island, status);
}

/* Whether nothing happens to the body at the start, and it may fly. */
static bool begins_alone(impact_scene *scene, int body)
{
    const imp_track *track = &scene->tracks.tracks[body];
    if (imp_scene_integrates_all(&scene->methods)) return false;
    for (int k = 0; k < scene->world.field_count; k++)
        if (scene->world.fields[k].only < 0 || scene->world.fields[k].only == body) return false;
    for (int k = 0; k < track->companion_count; k++)
        if (imp_gather_touches(scene, &scene->tracks.near[track->companions[k].near], scene->t)) return false;
    return true;
}

impact_status imp_scene_first_arrivals(impact_scene *scene)
{
    impact_status status = IMPACT_OK;
    for (int i = 0; i < scene->world.body_count; i++) {
        if (scene->world.bodies[i].is_static) continue;
        if (scene->tracks.tracks[i].segment.kind == IMP_SEGMENT_DAMPED)
            imp_account_set_live(&scene->account, i);
        else
            imp_account_set(
                &scene->account, i,
                imp_body_energy(&scene->world.bodies[i], &scene->tracks.tracks[i].segment.start, scene->world.gravity));
    }
    for (int i = 0; status == IMPACT_OK && i < scene->world.body_count; i++) {
        if (scene->world.bodies[i].is_static || scene->tracks.tracks[i].last_event == scene->t) continue;
        if (begins_alone(scene, i)) {
            scene->world.usage.ballistic_flights++;
            continue;
        }
        imp_island *island;
        imp_gather_member(scene, i);
        status = imp_gather(scene, -1, scene->t, scene->piles == IMPACT_PILES_STEPS, &island);
        if (status != IMPACT_OK) break;
        island->outside = imp_gather_energy_outside(scene, island, scene->t);
        status = imp_scene_conclude(island);
    }
    return status;
}
