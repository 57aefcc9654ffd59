/* SPDX-License-Identifier: MIT
 *
 * A scene to what is saved of it, and back. Restored, every island departs anew from its bodies' states: an
 * integrator's history and a pile's are not kept. So a scene that is saved is restored too, from its own bytes: both go
 * on alike, bit for bit, and what flies or rests goes on as if nothing had been.
 */
#include "scene/coarser.h"
#include "scene/following.h"
#include "scene/islands.h"
#include "scene/saved.h"
#include "scene/stepped.h"

#include <string.h>

/* ---- collecting ---- */

/* Pairs beside a plane's bounds, behind it, in the order of the bodies; out: NULL, to count them. */
static int collect_beyond(const impact_scene *scene, int *out)
{
    const imp_tracks *tracks = &scene->tracks;
    int count = 0;
    for (int i = 0; i < scene->world.body_count; i++)
        for (int k = 0; !scene->world.bodies[i].is_static && k < tracks->plane_count; k++) {
            const int near = imp_tracks_find(tracks, i, tracks->planes[k].body);
            if (near < 0 || !tracks->near[near].beyond) continue;
            if (out) out[2 * count] = i, out[2 * count + 1] = tracks->planes[k].body;
            count++;
        }
    return count;
}

static void count_all(imp_saved *s, const impact_scene *scene)
{
    s->body_count = scene->world.body_count;
    for (int k = 0; k < scene->world.field_count; k++) s->inside_count += scene->world.fields[k].slots;
    s->beyond_count = collect_beyond(scene, NULL);
    for (int k = 0; k < scene->island_count; k++) {
        const imp_island *island = scene->islands[k];
        if (!island) continue;
        s->island_count++;
        s->member_count += island->world.body_count;
        s->pair_count += island->world.pair_count;
    }
}

static void collect_bodies(imp_saved *s, const impact_scene *scene)
{
    for (int i = 0; i < s->body_count; i++) {
        const imp_track *track = &scene->tracks.tracks[i];
        const bool alone = track->island < 0;
        s->bodies[i] = (imp_saved_body){.t0 = alone ? track->segment.t0 : scene->t,
                                        .state = alone ? track->segment.start : scene->states[i],
                                        .resting = track->resting,
                                        .told = track->told,
                                        .stalls = track->stalls,
                                        .last_event = track->last_event,
                                        .patience = track->patience};
    }
}

/* What is in no island is as the scene has it. */
static void collect_inside(imp_saved *s, const impact_scene *scene)
{
    bool *out = s->inside;
    for (int k = 0; k < scene->island_count; k++)
        if (scene->islands[k]) imp_island_give_forces(scene->islands[k]);
    for (int k = 0; k < scene->world.field_count; k++) {
        const imp_field *field = &scene->world.fields[k];
        memcpy(out, field->inside, sizeof *out * (size_t)field->slots);
        out += field->slots;
    }
}

static imp_saved_island head_of(const imp_island *island, double t)
{
    return (imp_saved_island){.t = island->rests ? island->t : t,
                              .loss = imp_island_loss(island, t),
                              .fallen = island->motion.fallen,
                              .looked_at = fmin(island->looked_at, t),
                              .works = imp_island_works(island, t),
                              .slip_speed = island->world.slip_speed,
                              .stepped = island->stepped,
                              .member_count = island->world.body_count,
                              .pair_count = island->world.pair_count};
}

static void collect_island(const imp_island *island, imp_saved_member *members, imp_pair *pairs)
{
    const imp_body *bodies = island->world.bodies;
    for (int i = 0; i < island->world.body_count; i++)
        members[i] = (imp_saved_member){bodies[i].index, island->motion.sampled[i], island->motion.resting[i]};
    for (int p = 0; p < island->world.pair_count; p++) {
        pairs[p] = island->world.pairs[p];
        pairs[p].body1 = bodies[pairs[p].body1].index;
        pairs[p].body2 = bodies[pairs[p].body2].index;
    }
}

static void collect_scalars(imp_saved *s, const impact_scene *scene)
{
    *s = (imp_saved){.t = scene->t,
                     .begun = scene->begun,
                     .next_sample = scene->next_sample,
                     .event_count = scene->event_count,
                     .encounter_count = scene->encounter_count,
                     .steps = scene->steps,
                     .works = scene->works,
                     .impact_loss = scene->impact_loss,
                     .greatest_energy = scene->greatest_energy,
                     .impact_loss_fallen = scene->impact_loss_fallen,
                     .sliding_fallen = scene->sliding_fallen,
                     .pile_error = scene->pile_error + scene->made,
                     .pile_parted = scene->pile_parted,
                     .energy_start = scene->energy_start,
                     .receipt = scene->receipt,
                     .usage = scene->world.usage};
}

impact_status imp_saved_collect(imp_saved *s, impact_scene *scene)
{
    collect_scalars(s, scene);
    count_all(s, scene);
    impact_status status = imp_saved_reserve(s, scene->world.arena);
    if (status == IMPACT_OK) status = imp_scene_look(scene, scene->t);
    if (status != IMPACT_OK) return status;
    collect_bodies(s, scene);
    collect_inside(s, scene);
    collect_beyond(scene, s->beyond);
    int count = 0, member = 0, pair = 0;
    for (int k = 0; k < scene->island_count; k++) {
        const imp_island *island = scene->islands[k];
        if (!island) continue;
        s->islands[count++] = head_of(island, scene->t);
        collect_island(island, &s->members[member], &s->pairs[pair]);
        member += island->world.body_count, pair += island->world.pair_count;
    }
    return IMPACT_OK;
}

/* ---- restoring ---- */

/* No island, no integrator, no pair, no time in the queue. */
static void forget_all(impact_scene *scene)
{
    for (int k = 0; k < scene->island_count; k++)
        if (scene->islands[k]) imp_islands_release(scene->islands[k]);
    for (int k = 0; k < scene->spare_count; k++) imp_motion_forget(&scene->spares[k]->motion);
    for (int slot = 0; slot < scene->queue.slots; slot++) imp_queue_set(&scene->queue, slot, INFINITY);
    for (int i = 0; i < scene->world.body_count; i++) imp_account_set(&scene->account, i, 0);
    imp_tracks_clear(&scene->tracks);
}

static void restore_scalars(const imp_saved *s, impact_scene *scene)
{
    const impact_scene_residuals limits = scene->receipt;
    scene->t = s->t;
    scene->begun = s->begun;
    scene->next_sample = s->next_sample;
    scene->event_count = s->event_count;
    scene->encounter_count = s->encounter_count;
    scene->steps = s->steps;
    scene->works = s->works;
    scene->impact_loss = s->impact_loss;
    scene->greatest_energy = s->greatest_energy;
    scene->impact_loss_fallen = s->impact_loss_fallen;
    scene->sliding_fallen = s->sliding_fallen;
    scene->pile_error = s->pile_error;
    scene->pile_parted = s->pile_parted;
    scene->made = scene->made_before = 0;
    scene->energy_start = s->energy_start;
    scene->receipt = s->receipt;
    scene->receipt.limit_unit = limits.limit_unit, scene->receipt.limit_gap = limits.limit_gap;
    scene->receipt.limit_momentum = limits.limit_momentum;
    scene->receipt.limit_contact = limits.limit_contact, scene->receipt.limit_energy = limits.limit_energy;
    scene->world.usage = s->usage;
    const bool *inside = s->inside;
    for (int k = 0; k < scene->world.field_count; k++) {
        imp_field *field = &scene->world.fields[k];
        memcpy(field->inside, inside, sizeof *inside * (size_t)field->slots);
        inside += field->slots;
    }
}

static void restore_bodies(const imp_saved *s, impact_scene *scene)
{
    scene->moving = scene->movable;
    for (int i = 0; i < s->body_count; i++) {
        const imp_saved_body *from = &s->bodies[i];
        const imp_body *body = &scene->world.bodies[i];
        imp_track *track = &scene->tracks.tracks[i];
        track->segment = imp_segment_fly(body, from->t0, &from->state, scene->world.gravity, track->tumble);
        track->resting = from->resting && !body->is_static;
        track->stalls = from->stalls;
        track->last_event = from->last_event;
        track->patience = from->patience;
        scene->moving -= track->resting;
        scene->states[i] = from->state;
        if (!s->begun || body->is_static) continue;
        if (track->segment.kind == IMP_SEGMENT_DAMPED)
            imp_account_set_live(&scene->account, i);
        else
            imp_account_set(&scene->account, i, imp_body_energy(body, &from->state, scene->world.gravity));
    }
    for (int m = 0; m < s->member_count; m++) {
        const imp_saved_member *member = &s->members[m];
        if (scene->world.bodies[member->body].is_static) continue;
        scene->tracks.tracks[member->body].segment = imp_segment_rest(s->t, &member->state);
        imp_account_set(&scene->account, member->body, 0);
    }
}

static void restore_beyond(const imp_saved *s, impact_scene *scene)
{
    imp_tracks *tracks = &scene->tracks;
    for (int k = 0; k < s->beyond_count; k++) {
        const int near = imp_tracks_find(tracks, s->beyond[2 * k], s->beyond[2 * k + 1]);
        if (near < 0 || tracks->near[near].beyond) continue;
        tracks->near[near].beyond = true;
        imp_tracks_predict(tracks, near, s->t);
    }
}

static void restore_pair(imp_island *island, const imp_pair *from)
{
    const impact_scene *scene = island->scene;
    const imp_pair rules = imp_rules_pair(&scene->rules, &scene->world, from->body1, from->body2);
    imp_pair *pair = &island->world.pairs[island->world.pair_count++];
    *pair = *from;
    pair->body1 = imp_island_find(island, from->body1);
    pair->body2 = imp_island_find(island, from->body2);
    pair->law = rules.law;
    pair->cache = rules.cache;
}

/* Its bodies, contacts and books; it moves not yet. */
static impact_status fill_island(imp_island *island, const imp_saved_island *from, const imp_saved_member *members,
                                 const imp_pair *pairs)
{
    impact_status status = imp_island_reserve(island, from->member_count, from->pair_count);
    if (status != IMPACT_OK) return status;
    island->t = from->t;
    for (int m = 0; m < from->member_count; m++) {
        const int i = imp_island_add_body(island, members[m].body, &members[m].state);
        island->motion.resting[i] = members[m].resting;
    }
    for (int p = 0; p < from->pair_count; p++) restore_pair(island, &pairs[p]);
    imp_island_set_slip_speed(island, from->slip_speed);
    status = imp_island_take_forces(island);
    island->stepped = from->stepped;
    if (status == IMPACT_OK && island->stepped) status = imp_island_resume_steps(island);
    island->looked_at = from->looked_at;
    island->motion.works = from->works;
    island->motion.fallen = from->fallen;
    island->impact_loss = from->loss;
    return status;
}

static impact_status restore_island(impact_scene *scene, const imp_saved_island *from, const imp_saved_member *members,
                                    const imp_pair *pairs)
{
    imp_island *island = imp_islands_spare(scene);
    if (!island) return IMPACT_ENOMEM;
    impact_status status = fill_island(island, from, members, pairs);
    if (status == IMPACT_OK) {
        imp_islands_give_account(island);
        island->balance = imp_island_balance(island);
        status = imp_island_tell_pairs(island);
    }
    if (status == IMPACT_OK) status = imp_island_start(island);
    if (status != IMPACT_OK && island->number < 0) imp_islands_release(island);
    return status;
}

static impact_status restore_islands(const imp_saved *s, impact_scene *scene)
{
    impact_status status = IMPACT_OK;
    for (int k = 0, member = 0, pair = 0; status == IMPACT_OK && k < s->island_count; k++) {
        status = restore_island(scene, &s->islands[k], &s->members[member], &s->pairs[pair]);
        member += s->islands[k].member_count, pair += s->islands[k].pair_count;
    }
    imp_tracks_begin_look(&scene->tracks);
    for (int m = 0; status == IMPACT_OK && m < s->member_count; m++)
        if (!scene->world.bodies[s->members[m].body].is_static)
            imp_tracks_look_ahead(&scene->tracks, s->members[m].body, s->t);
    return status;
}

impact_status imp_saved_restore(const imp_saved *s, impact_scene *scene)
{
    imp_coarser_end(scene);
    forget_all(scene);
    restore_scalars(s, scene);
    restore_bodies(s, scene);
    impact_status status = imp_tracks_renew(&scene->tracks, s->t);
    if (status != IMPACT_OK) return status;
    restore_beyond(s, scene);
    status = restore_islands(s, scene);
    for (int i = 0; i < s->body_count; i++) scene->tracks.tracks[i].told = s->bodies[i].told;
    return status == IMPACT_OK ? imp_scene_look(scene, s->t) : status;
}
