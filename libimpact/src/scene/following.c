/* SPDX-License-Identifier: MIT */
#include "scene/following.h"
#include "base/tolerances.h"
#include "scene/gliding.h"
#include "scene/islands.h"
#include "scene/rolling.h"
#include "scene/scene_keys.h"
#include "scene/scene_meeting.h"
#include "scene/scene_methods.h"
#include "scene/stepped.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

/* What does not let its bodies stand where they are, now or some time. */
static bool may_wake(const imp_island *island) { return island->world.driven || imp_field_unsteady(&island->world); }

/* Whether the pair keeps its bodies in one island, and is not searched for. */
bool imp_island_ties(const imp_island *island, const imp_pair *pair)
{
    return imp_is_held(pair) || pair->footing.on == IMP_FOOT_FACE || (island->stepped && pair->met);
}

/* The pairs' other side of what the island has found: what is held is not searched for. */
impact_status imp_island_tell_pairs(imp_island *island)
{
    bool taken = true;
    impact_scene *scene = island->scene;
    const imp_body *bodies = island->world.bodies;
    for (int p = 0; p < island->world.pair_count; p++) {
        const imp_pair *pair = &island->world.pairs[p];
        const int near = imp_tracks_find(&scene->tracks, bodies[pair->body1].index, bodies[pair->body2].index);
        if (near < 0) continue;
        scene->tracks.near[near].held = imp_island_ties(island, pair);
        if (!imp_island_ties(island, pair) && !imp_scene_held_ends(scene, near, island->t)) taken = false;
        scene->tracks.near[near].beyond = pair->mode == IMP_BEYOND;
    }
    return taken ? IMPACT_OK : IMPACT_ESINK;
}

bool imp_island_all_rest(const imp_island *island)
{
    for (int i = 0; i < island->world.body_count; i++)
        if (!island->world.bodies[i].is_static && !island->motion.resting[i]) return false;
    return true;
}

static impact_status follow(imp_island *island, int i, const imp_segment *segment)
{
    return imp_tracks_follow(&island->scene->tracks, island->world.bodies[i].index, segment, island->t);
}

/* Alone, and nothing acts on it but gravity and damping. */
impact_status imp_island_fly(imp_island *island, int i)
{
    impact_scene *scene = island->scene;
    const imp_body *body = &island->world.bodies[i];
    imp_track *track = &scene->tracks.tracks[body->index];
    track->island = -1;
    const imp_segment s = imp_segment_fly(body, island->t, &island->states[i], scene->world.gravity, track->tumble);
    scene->world.usage.ballistic_flights++;
    if (s.kind == IMP_SEGMENT_DAMPED)
        imp_account_set_live(&scene->account, body->index);
    else
        imp_account_set(&scene->account, body->index, imp_body_energy(body, &island->states[i], scene->world.gravity));
    return follow(island, i, &s);
}

static impact_status follow_all(imp_island *island)
{
    impact_scene *scene = island->scene;
    impact_status status = IMPACT_OK;
    for (int i = 0, place = 0; status == IMPACT_OK && i < island->world.body_count; i++) {
        if (island->world.bodies[i].is_static) continue;
        const imp_segment s = island->rests ? imp_segment_rest(island->t, &island->states[i])
                                            : imp_segment_dense(&island->motion.dense, place++, &island->before[i]);
        status = follow(island, i, &s);
    }
    imp_queue_set(&scene->queue, imp_scene_island_slot(scene, island->number),
                  island->rests ? INFINITY : island->motion.dense.t1);
    return status;
}

void imp_island_look_ahead(imp_island *island)
{
    imp_tracks_begin_look(&island->scene->tracks);
    for (int i = 0; i < island->world.body_count; i++)
        if (!island->world.bodies[i].is_static)
            imp_tracks_look_ahead(&island->scene->tracks, island->world.bodies[i].index, island->t);
}

/* The end of the definition's duration after t, or that of its next repetition: how far an integrator looks must not
 * depend on how far this run goes. */
static double horizon(const impact_scene *scene, double t)
{
    const double T = scene->duration;
    if (t < T) return T;
    const double end = T * (floor(t / T) + 1);
    return end > t ? end : t + T;
}

impact_status imp_island_fail(imp_island *island, impact_status status)
{
    impact_scene *scene = island->scene;
    if (status < 0 && scene->message[0] == '\0')
        snprintf(scene->message, sizeof scene->message, "%s", island->motion.message);
    return status;
}

/* The one body that moves in it has this segment. What friction does not take from has its energy in the account. */
static impact_status move_closed(imp_island *island, const imp_segment *segment, bool loses)
{
    impact_scene *scene = island->scene;
    int i = 0;
    while (island->world.bodies[i].is_static) i++;
    const imp_body *body = &island->world.bodies[i];
    island->rolls = island->moves = true;
    island->loses = loses;
    island->begun_with = imp_island_energy(island);
    island->motion.stride.t = segment->t1;
    imp_motion_forget(&island->motion);
    imp_account_set(&scene->account, body->index, island->loses ? 0 : island->begun_with);
    scene->world.usage.rolls++;
    imp_queue_set(&scene->queue, imp_scene_island_slot(scene, island->number), segment->t1);
    return follow(island, i, segment);
}

static impact_status roll(imp_island *island, const imp_segment *segment)
{
    imp_held_contact *contact = &island->motion.held.contacts[0];
    const imp_body *body = &island->world.bodies[contact->body1];
    const bool rough = imp_is_rough(&island->world.pairs[contact->pair]);
    if (rough) contact->force = qvec3_scale(qvec3_sub(segment->acceleration, island->world.gravity), body->mass);
    return move_closed(island, segment, (contact->mode == IMP_SLIDE && contact->friction > 0) || rough);
}

/* The next segment of what glides on a face. */
static impact_status glide(imp_island *island)
{
    imp_segment segment;
    bool closed;
    memcpy(island->before, island->states, (size_t)island->world.body_count * sizeof *island->states);
    island->world.usage.glides++;
    const impact_status status = imp_island_glide_on(island, &segment, &closed);
    island->rolls = island->loses = false;
    if (status != IMPACT_OK) return imp_island_fail(island, status);
    if (closed) return move_closed(island, &segment, imp_island_lying(island)->law.friction > 0);
    island->moves = true;
    return follow_all(island);
}

/* The next step, of the integrator or of a pile. */
impact_status imp_island_step_on(imp_island *island)
{
    const double t = island->motion.stride.t;
    if (imp_island_lying(island)) return glide(island);
    if (t >= island->motion.stride.t_end) imp_motion_depart(&island->motion, t, horizon(island->scene, t), true);
    memcpy(island->before, island->states, (size_t)island->world.body_count * sizeof *island->states);
    const impact_status status =
        island->stepped ? imp_island_step(island) : imp_motion_next(&island->motion, island->states, &island->end);
    if (status != IMPACT_OK) {
        island->moves = false;
        return imp_island_fail(island, status);
    }
    island->t = t; /* its segments begin here; its states are those at their end */
    island->moves = true;
    const impact_status followed = follow_all(island);
    imp_islands_add_usage(&island->scene->world.usage, &island->world.usage);
    return followed;
}

/* All its bodies stay where they are. The energy of what attracts each other is the first one's in the account. */
static impact_status stand(imp_island *island)
{
    impact_scene *scene = island->scene;
    double energy = imp_island_energy(island);
    island->moves = true;
    imp_motion_forget(&island->motion);
    for (int i = 0; i < island->world.body_count; i++) {
        if (island->world.bodies[i].is_static) continue;
        imp_account_set(&scene->account, island->world.bodies[i].index, energy);
        energy = 0;
    }
    return follow_all(island);
}

/* All that the pile moves is its to find: nothing between its bodies is searched for. */
static void hold_near(imp_island *island)
{
    imp_tracks *tracks = &island->scene->tracks;
    const imp_body *bodies = island->world.bodies;
    for (int p = 0; p < island->world.pair_count; p++) {
        const imp_pair *pair = &island->world.pairs[p];
        const int near = imp_tracks_find(tracks, bodies[pair->body1].index, bodies[pair->body2].index);
        if (near >= 0) tracks->near[near].held = true;
    }
}

/* Gives the island, whose bodies are all tied, its next segments. */
impact_status imp_island_start(imp_island *island)
{
    impact_scene *scene = island->scene;
    impact_status status = imp_islands_number(island);
    if (status == IMPACT_OK && !island->stepped) status = imp_scene_load_with_reactions(island);
    if (status != IMPACT_OK) return status;
    for (int i = 0; i < island->world.body_count; i++)
        if (!island->world.bodies[i].is_static)
            scene->tracks.tracks[island->world.bodies[i].index].island = island->number;
    island->rests = imp_island_all_rest(island) && !may_wake(island);
    island->rolls = island->loses = false;
    if (island->rests) return stand(island);
    if (imp_island_lying(island)) {
        island->glide = IMP_FACE_LONGEST;
        imp_motion_depart(&island->motion, island->t, horizon(scene, island->t), false);
        return glide(island);
    }
    imp_segment segment;
    const bool closed = !island->stepped && !imp_scene_integrates_all(&scene->methods);
    if (closed && imp_island_rolls(island, &segment, &island->end)) return roll(island, &segment);
    if (island->stepped) hold_near(island);
    imp_motion_depart(&island->motion, island->t, horizon(scene, island->t), island->end.kind == IMP_END_RENEWAL);
    return imp_island_step_on(island);
}
