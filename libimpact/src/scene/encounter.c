/* SPDX-License-Identifier: MIT
 *
 * What meets at one instant is gathered: the bodies, what touches them now, all that is held with any of these or tied
 * to it by a force, and so on. In that island, with the static bodies it touches, all is settled. Then it falls apart
 * into what is still held together, and each part is given its next segment.
 */
#include "scene/scene_events.h"
#include "scene/scene_keys.h"
#include "scene/scene_internal.h"
#include "scene/scene_meeting.h"
#include "scene/scene_receipt.h"
#include "scene/stepped.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- islands, numbered and spare ---- */

static bool keep_spare(impact_scene *scene, imp_island *island)
{
    imp_island **spares =
        imp_arena_grow(scene->world.arena, scene->spares, &scene->spare_room, scene->spare_count + 1, sizeof *spares);
    if (!spares) return false;
    scene->spares = spares;
    spares[scene->spare_count++] = island;
    return true;
}

static imp_island *spare_island(impact_scene *scene)
{
    if (scene->spare_count == 0) {
        imp_island *made = imp_arena_take(scene->world.arena, 1, sizeof *made);
        if (!made || !keep_spare(scene, made)) return NULL;
        made->scene = scene;
    }
    imp_island *island = scene->spares[--scene->spare_count];
    imp_island_clear(island);
    return island;
}

static void add_usage(impact_usage *sum, impact_usage *part)
{
    enum { COUNTS = sizeof *sum / sizeof(long) };
    long a[COUNTS], b[COUNTS];
    memcpy(a, sum, sizeof a);
    memcpy(b, part, sizeof b);
    for (int k = 0; k < COUNTS; k++) a[k] += b[k];
    memcpy(sum, a, sizeof a);
    *part = (impact_usage){0};
}

/* What the island did since it was asked last is the scene's. */
static void give_account(imp_island *island)
{
    impact_scene *scene = island->scene;
    imp_works *works = &island->motion.works;
    scene->works.force += works->force;
    scene->works.damping += works->damping;
    scene->works.sliding += works->sliding;
    scene->works.drive += works->drive;
    *works = (imp_works){0};
    scene->impact_loss += island->impact_loss;
    scene->sliding_fallen += island->motion.fallen;
    island->impact_loss = island->loss_before = island->motion.fallen = 0;
    add_usage(&scene->world.usage, &island->world.usage);
}

static void release(imp_island *island)
{
    impact_scene *scene = island->scene;
    give_account(island);
    if (island->number >= 0) {
        scene->islands[island->number] = NULL;
        imp_queue_set(&scene->queue, imp_scene_island_slot(scene, island->number), INFINITY);
    }
    island->number = -1;
    if (!keep_spare(scene, island)) imp_motion_forget(&island->motion); /* the rest goes with the arena */
}

static impact_status give_number(imp_island *island)
{
    impact_scene *scene = island->scene;
    if (island->number >= 0) return IMPACT_OK;
    int number = 0;
    while (number < scene->island_count && scene->islands[number]) number++;
    if (number == scene->island_count) {
        imp_island **islands =
            imp_arena_grow(scene->world.arena, scene->islands, &scene->island_room, number + 1, sizeof *islands);
        if (!islands) return IMPACT_ENOMEM;
        scene->islands = islands;
        if (imp_queue_add(&scene->queue) < 0) return IMPACT_ENOMEM;
        scene->island_count++;
    }
    scene->islands[number] = island;
    island->number = number;
    return IMPACT_OK;
}

/* ---- gathering ---- */

/* Bodies are marked by their place among the members; all others have -1. */
static void add_member(impact_scene *scene, int body)
{
    if (scene->world.bodies[body].is_static || scene->root[body] >= 0) return;
    scene->root[body] = scene->member_count;
    scene->members[scene->member_count++] = body;
}

static void add_company(impact_scene *scene, int body)
{
    const int number = scene->tracks.tracks[body].island;
    if (number < 0) return;
    const imp_island *island = scene->islands[number];
    for (int i = 0; i < island->world.body_count; i++) add_member(scene, island->world.bodies[i].index);
}

static void add_attracted(impact_scene *scene)
{
    for (int k = 0; k < scene->world.field_count; k++)
        if (scene->world.fields[k].def.kind == IMPACT_FORCE_ATTRACTION)
            for (int i = 0; i < scene->world.body_count; i++) add_member(scene, i);
}

/* Whether the pair touches at t, but for a rounding. */
static bool touches(impact_scene *scene, const imp_near *near, double t)
{
    const imp_body *b1 = &scene->world.bodies[near->body[0]], *b2 = &scene->world.bodies[near->body[1]];
    const imp_segment *s1 = &scene->tracks.tracks[near->body[0]].segment,
                      *s2 = &scene->tracks.tracks[near->body[1]].segment;
    qvec3 v;
    if (near->beyond) return false;
    const qvec3 x1 = imp_segment_place(s1, b1, t, &v), x2 = imp_segment_place(s2, b2, t, &v), d = qvec3_sub(x1, x2);
    const bool plane = b2->shape.kind == IMPACT_PLANE;
    const double reach = plane ? b1->radius : b1->radius + b2->radius, distance = sqrt(qvec3_dot(d, d));
    const qvec3 n =
        plane ? quat_rotate(s2->start.q, (qvec3){0, 0, 1}) : qvec3_scale(d, distance > 0 ? 1 / distance : 0);
    const double touching = IMP_TOUCHING * imp_place_scale(b1, x1, b2, x2, n);
    if (qvec3_dot(n, d) - reach > touching) return false;
    if (imp_is_ball(b1) && (plane || imp_is_ball(b2))) return true;
    const imp_state a = imp_segment_at(s1, b1, t), b = imp_segment_at(s2, b2, t);
    impact_contact contact;
    imp_gap_of(b1, &a, b2, &b, &scene->world.usage, &contact);
    return contact.gap <= IMP_TOUCHING * imp_place_scale(b1, x1, b2, x2, contact.normal);
}

static impact_status add_touching(impact_scene *scene, const imp_pair *pair)
{
    imp_pair *touching = imp_arena_grow(scene->world.arena, scene->touching, &scene->touching_room,
                                        scene->touching_count + 1, sizeof *touching);
    if (!touching) return IMPACT_ENOMEM;
    scene->touching = touching;
    scene->touching[scene->touching_count++] = *pair;
    return IMPACT_OK;
}

/* Follows contacts from the members to all they reach; each pair once, held ones as they are. */
static impact_status follow_contacts(impact_scene *scene, int seed, double t)
{
    impact_status status = IMPACT_OK;
    for (int m = 0; m < scene->member_count; m++) {
        const int body = scene->members[m];
        const imp_track *track = &scene->tracks.tracks[body];
        add_company(scene, body);
        for (int k = 0; status == IMPACT_OK && k < track->near_count; k++) {
            const imp_near *near = &scene->tracks.near[track->near[k]];
            const int other = imp_near_other(near, body);
            if (near->held || (scene->root[other] >= 0 && scene->root[other] < m)) continue; /* an island's; seen */
            if (track->near[k] != seed && !touches(scene, near, t)) continue;
            add_member(scene, other);
            imp_pair pair = imp_rules_pair(&scene->rules, &scene->world, near->body[0], near->body[1]);
            pair.beyond = near->beyond;
            status = add_touching(scene, &pair);
        }
    }
    return status;
}

static impact_status add_held(impact_scene *scene, const imp_island *island)
{
    impact_status status = IMPACT_OK;
    for (int p = 0; status == IMPACT_OK && p < island->world.pair_count; p++) {
        imp_pair pair = island->world.pairs[p];
        if (!imp_is_held(&pair)) continue;
        pair.body1 = island->world.bodies[pair.body1].index;
        pair.body2 = island->world.bodies[pair.body2].index;
        status = add_touching(scene, &pair);
    }
    return status;
}

/* All near pairs of the members with each other and with what is static. */
static impact_status add_all_near(impact_scene *scene)
{
    impact_status status = IMPACT_OK;
    scene->touching_count = 0;
    for (int m = 0; m < scene->member_count; m++) {
        const imp_track *track = &scene->tracks.tracks[scene->members[m]];
        for (int k = 0; status == IMPACT_OK && k < track->near_count; k++) {
            const imp_near *near = &scene->tracks.near[track->near[k]];
            const bool within = scene->world.bodies[near->body[1]].is_static || scene->root[near->body[1]] >= 0;
            if (near->body[0] != scene->members[m] || !within) continue;
            imp_pair pair = imp_rules_pair(&scene->rules, &scene->world, near->body[0], near->body[1]);
            pair.beyond = near->beyond;
            status = add_touching(scene, &pair);
        }
    }
    return status;
}

static int ascending(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

/* In the order of the definition: by the earlier body of each pair, then the later. */
static int by_bodies(const void *a, const void *b)
{
    const imp_pair *x = a, *y = b;
    const int low_x = x->body1 < x->body2 ? x->body1 : x->body2, low_y = y->body1 < y->body2 ? y->body1 : y->body2;
    if (low_x != low_y) return (low_x > low_y) - (low_x < low_y);
    const int high_x = x->body1 + x->body2 - low_x, high_y = y->body1 + y->body2 - low_y;
    return (high_x > high_y) - (high_x < high_y);
}

/* The static bodies that the pairs name join the members; all in the order of the definition. */
static void sort_members(impact_scene *scene)
{
    for (int p = 0; p < scene->touching_count; p++) {
        const int other = scene->touching[p].body2;
        if (!scene->world.bodies[other].is_static || scene->root[other] >= 0) continue;
        scene->root[other] = scene->member_count;
        scene->members[scene->member_count++] = other;
    }
    qsort(scene->members, (size_t)scene->member_count, sizeof *scene->members, ascending);
    qsort(scene->touching, (size_t)scene->touching_count, sizeof *scene->touching, by_bodies);
}

/* The state of a member at t; and whether it rests. */
static imp_state state_of(impact_scene *scene, int body, double t, bool *resting)
{
    const imp_track *track = &scene->tracks.tracks[body];
    *resting = false;
    if (track->segment.kind == IMP_SEGMENT_DAMPED) scene->works.damping += imp_scene_damped(scene, body, t);
    if (track->island < 0) return imp_segment_at(&track->segment, &scene->world.bodies[body], t);
    const imp_island *island = scene->islands[track->island];
    const int i = imp_island_find(island, body);
    *resting = island->motion.resting[i];
    return island->states[i];
}

/* Each of the members' islands once: through its first body that moves. */
static imp_island *old_island(const impact_scene *scene, int m)
{
    const int body = scene->members[m], number = scene->tracks.tracks[body].island;
    if (number < 0 || scene->world.bodies[body].is_static) return NULL;
    const imp_world *world = &scene->islands[number]->world;
    int first = 0;
    while (world->bodies[first].is_static) first++;
    return world->bodies[first].index == body ? scene->islands[number] : NULL;
}

static impact_status fill(imp_island *island, double t)
{
    impact_scene *scene = island->scene;
    impact_status status = imp_island_reserve(island, scene->member_count, scene->touching_count);
    for (int m = 0; status == IMPACT_OK && m < scene->member_count; m++) {
        bool resting;
        const imp_state state = state_of(scene, scene->members[m], t, &resting);
        const int i = imp_island_add_body(island, scene->members[m], &state);
        island->motion.resting[i] = resting;
        scene->root[scene->members[m]] = i;
        if (!imp_scene_segment_done(scene, scene->members[m], t, &island->states[i])) status = IMPACT_ESINK;
    }
    for (int p = 0; status == IMPACT_OK && p < scene->touching_count; p++) {
        imp_pair *pair = &island->world.pairs[island->world.pair_count++];
        *pair = scene->touching[p];
        pair->body1 = scene->root[pair->body1];
        pair->body2 = scene->root[pair->body2];
    }
    return status == IMPACT_OK ? imp_island_take_forces(island) : status;
}

static void clear_members(impact_scene *scene)
{
    for (int m = 0; m < scene->member_count; m++) scene->root[scene->members[m]] = -1;
    scene->member_count = scene->touching_count = 0;
}

/* How the islands that go over into this one have got on, and by what. */
static void take_over(imp_island *island, const imp_island *old, bool *were_stepped)
{
    *were_stepped = *were_stepped || old->stepped;
    if (old->patience.steps > island->patience.steps) island->patience = old->patience;
}

/* The energy of all but the members at t, for the rows of events. */
static double energy_outside(impact_scene *scene, const imp_island *island, double t)
{
    for (int i = 0; i < island->world.body_count; i++)
        imp_account_set(&scene->account, island->world.bodies[i].index, 0);
    return scene->recorder && scene->recorder->event ? imp_scene_energy_beside(scene, island, t) : 0;
}

/* The members' islands to the time t; their held contacts join those that touch. */
static impact_status close_old(impact_scene *scene, double t, imp_island *island)
{
    impact_status status = IMPACT_OK;
    bool were_stepped = false;
    const int moving = scene->member_count;
    for (int m = 0; status == IMPACT_OK && m < moving; m++) {
        imp_island *old = old_island(scene, m);
        if (!old) continue;
        imp_island_go_to(old, t);
        if (!imp_scene_held_until(old)) return IMPACT_ESINK;
        take_over(island, old, &were_stepped);
        status = add_held(scene, old);
    }
    scene->world.usage.islands_stepped += island->stepped && !were_stepped;
    island->stepped = island->stepped || were_stepped;
    return status;
}

static void release_old(impact_scene *scene)
{
    for (int m = 0; m < scene->member_count; m++) {
        imp_island *old = old_island(scene, m);
        if (old) old->leaving = true;
    }
    for (int m = 0; m < scene->member_count; m++) {
        imp_track *track = &scene->tracks.tracks[scene->members[m]];
        imp_island *old = track->island < 0 ? NULL : scene->islands[track->island];
        track->island = -1;
        if (!old || !old->leaving) continue;
        old->leaving = false;
        release(old);
    }
}

/* An island of all that the members (and the pair `seed`) touch at t. stepped: to be moved by steps, as it is too where
 * one that joins it was. */
static impact_status gather(impact_scene *scene, int seed, double t, bool stepped, imp_island **out)
{
    *out = NULL;
    add_attracted(scene);
    imp_island *island = spare_island(scene);
    if (!island) return IMPACT_ENOMEM;
    island->t = island->looked_at = t;
    island->stepped = stepped;
    impact_status status = follow_contacts(scene, seed, t);
    if (status == IMPACT_OK) status = close_old(scene, t, island);
    if (status == IMPACT_OK && island->stepped) status = add_all_near(scene);
    if (status != IMPACT_OK) return status;
    sort_members(scene);
    status = fill(island, t);
    release_old(scene);
    clear_members(scene);
    if (status == IMPACT_OK && island->stepped) status = imp_island_begin_steps(island);
    island->balance = imp_island_balance(island);
    *out = island;
    return status;
}

/* ---- going on ---- */

/* What does not let its bodies stand where they are, now or some time. */
static bool may_wake(const imp_island *island) { return island->world.driven || imp_field_unsteady(&island->world); }

/* Whether the pair keeps its bodies in one island, and is not searched for. */
static bool ties(const imp_island *island, const imp_pair *pair)
{
    return imp_is_held(pair) || (island->stepped && pair->met);
}

/* The pairs' other side of what the island has found: what is held is not searched for. */
static impact_status tell_pairs(imp_island *island)
{
    bool taken = true;
    impact_scene *scene = island->scene;
    const imp_body *bodies = island->world.bodies;
    for (int p = 0; p < island->world.pair_count; p++) {
        const imp_pair *pair = &island->world.pairs[p];
        const int near = imp_tracks_find(&scene->tracks, bodies[pair->body1].index, bodies[pair->body2].index);
        if (near < 0) continue;
        scene->tracks.near[near].held = ties(island, pair);
        if (!ties(island, pair) && !imp_scene_held_ends(scene, near, island->t)) taken = false;
        scene->tracks.near[near].beyond = pair->beyond;
    }
    return taken ? IMPACT_OK : IMPACT_ESINK;
}

static bool all_rest(const imp_island *island)
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
static impact_status fly(imp_island *island, int i)
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

static void look_ahead(imp_island *island)
{
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

static impact_status fail(imp_island *island, impact_status status)
{
    impact_scene *scene = island->scene;
    if (status < 0 && scene->message[0] == '\0')
        snprintf(scene->message, sizeof scene->message, "%s", island->motion.message);
    return status;
}

/* The next step, of the integrator or of a pile. */
static impact_status step(imp_island *island)
{
    const double t = island->motion.stride.t;
    if (t >= island->motion.stride.t_end) imp_motion_depart(&island->motion, t, horizon(island->scene, t), true);
    memcpy(island->before, island->states, (size_t)island->world.body_count * sizeof *island->states);
    const impact_status status =
        island->stepped ? imp_island_step(island) : imp_motion_next(&island->motion, island->states, &island->end);
    if (status != IMPACT_OK) {
        island->moves = false;
        return fail(island, status);
    }
    island->t = t; /* its segments begin here; its states are those at their end */
    island->moves = true;
    const impact_status followed = follow_all(island);
    add_usage(&island->scene->world.usage, &island->world.usage);
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
static impact_status start(imp_island *island)
{
    impact_scene *scene = island->scene;
    impact_status status = give_number(island);
    if (status == IMPACT_OK && !island->stepped) status = imp_scene_load_with_reactions(island);
    if (status != IMPACT_OK) return status;
    for (int i = 0; i < island->world.body_count; i++)
        if (!island->world.bodies[i].is_static)
            scene->tracks.tracks[island->world.bodies[i].index].island = island->number;
    island->rests = all_rest(island) && !may_wake(island);
    if (island->rests) return stand(island);
    if (island->stepped) hold_near(island);
    imp_motion_depart(&island->motion, island->t, horizon(scene, island->t), island->end.kind == IMP_END_RENEWAL);
    return step(island);
}

/* ---- falling apart ---- */

static int root_of(const int *root, int i)
{
    while (root[i] != i) i = root[i];
    return i;
}

/* root[i]: the component of the island's body i; of a static one -1. How many there are. */
static int find_components(const imp_island *island, int *root)
{
    const imp_world *world = &island->world;
    int count = 0, last = -1;
    bool attracted = false;
    for (int k = 0; k < world->field_count; k++)
        attracted = attracted || world->fields[k].def.kind == IMPACT_FORCE_ATTRACTION;
    for (int i = 0; i < world->body_count; i++) {
        root[i] = world->bodies[i].is_static ? -1 : i;
        if (root[i] < 0) continue;
        if (attracted && last >= 0) root[i] = root_of(root, last);
        last = i;
    }
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        if (!ties(island, pair) || world->bodies[pair->body2].is_static) continue;
        const int a = root_of(root, pair->body1), b = root_of(root, pair->body2);
        root[a < b ? b : a] = a < b ? a : b;
    }
    for (int i = 0; i < world->body_count; i++)
        if (root[i] >= 0) count += (root[i] = root_of(root, i)) == i;
    return count;
}

/* Whether a contact holds the component, or a force acts on it. */
static bool is_tied(const imp_island *island, const int *root, int component)
{
    const imp_world *world = &island->world;
    for (int p = 0; p < world->pair_count; p++)
        if (ties(island, &world->pairs[p]) && root[world->pairs[p].body1] == component) return true;
    for (int k = 0; k < world->field_count; k++)
        if (world->fields[k].only < 0 || root[world->fields[k].only] == component) return true;
    return false;
}

/* Whether the component goes on by steps: bodies that move touch each other in it; by choice, any touches. */
static bool stays_stepped(const imp_island *island, const int *root, int component)
{
    const imp_world *world = &island->world;
    const bool always = island->scene->piles == IMPACT_PILES_STEPS;
    for (int p = 0; island->stepped && p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        const bool counts = pair->met && (always || !world->bodies[pair->body2].is_static);
        if (counts && root[pair->body1] == component) return true;
    }
    return false;
}

/* Of a pile all pairs go over, of others those that hold. */
static bool goes_over(const imp_island *island, const int *root, int component, const imp_pair *pair)
{
    const bool here = root[pair->body1] == component &&
                      (island->world.bodies[pair->body2].is_static || root[pair->body2] == component);
    return here && (island->stepped || imp_is_held(pair));
}

/* One component as an island of its own. */
static impact_status split_off(imp_island *island, const int *root, int component, imp_island **out)
{
    impact_scene *scene = island->scene;
    const imp_world *world = &island->world;
    imp_island *part = *out = spare_island(scene);
    if (!part) return IMPACT_ENOMEM;
    part->t = part->looked_at = island->t;
    part->patience = island->patience;
    part->stepped = stays_stepped(island, root, component);
    impact_status status = imp_island_reserve(part, world->body_count, world->pair_count);
    if (status != IMPACT_OK) return status;
    for (int i = 0; i < world->body_count; i++) {
        bool takes = root[i] == component;
        for (int p = 0; world->bodies[i].is_static && !takes && p < world->pair_count; p++)
            takes = world->pairs[p].body2 == i && goes_over(island, root, component, &world->pairs[p]);
        if (!takes) continue;
        const int own = imp_island_add_body(part, world->bodies[i].index, &island->states[i]);
        part->motion.resting[own] = island->motion.resting[i];
    }
    for (int p = 0; p < world->pair_count; p++) {
        if (!goes_over(island, root, component, &world->pairs[p])) continue;
        imp_pair *pair = &part->world.pairs[part->world.pair_count++];
        *pair = world->pairs[p];
        pair->body1 = imp_island_find(part, world->bodies[pair->body1].index);
        pair->body2 = imp_island_find(part, world->bodies[pair->body2].index);
    }
    status = imp_island_take_forces(part);
    return status == IMPACT_OK && part->stepped && !all_rest(part) ? imp_island_begin_steps(part) : status;
}

static void count_moving(imp_island *island)
{
    impact_scene *scene = island->scene;
    for (int i = 0; i < island->world.body_count; i++) {
        if (island->world.bodies[i].is_static) continue;
        imp_track *track = &scene->tracks.tracks[island->world.bodies[i].index];
        scene->moving += track->resting - island->motion.resting[i];
        track->resting = island->motion.resting[i];
    }
}

/* What is in none of the parts flies; a component alone stays the island it is. */
static impact_status make_parts(imp_island *island, imp_island **parts, bool *stays)
{
    impact_scene *scene = island->scene;
    int *root = scene->root; /* free between gatherings, but for its -1s */
    const int n = island->world.body_count, components = find_components(island, root);
    impact_status status = IMPACT_OK;
    imp_island **last = parts;
    for (int i = 0; status == IMPACT_OK && i < n; i++) {
        if (root[i] != i) continue;
        if (!is_tied(island, root, i)) {
            status = fly(island, i);
        } else if (components == 1 && island->stepped == stays_stepped(island, root, i)) {
            *stays = true;
        } else {
            status = split_off(island, root, i, last);
            if (*last) last = &(*last)->next;
        }
    }
    for (int i = 0; i < n; i++) root[i] = -1;
    return status;
}

static impact_status conclude(imp_island *island, impact_status status);

/* What leaves a pile has no modes yet. */
static impact_status start_part(imp_island *part, const imp_island *whole)
{
    part->balance = imp_island_balance(part);
    if (whole->stepped && !part->stepped && !all_rest(part)) {
        part->outside = whole->outside + imp_island_energy(whole) - imp_island_energy(part);
        return conclude(part, imp_scene_settle(part));
    }
    const impact_status status = start(part);
    if (status != IMPACT_OK && part->number < 0) release(part);
    return status;
}

/* What is left of the island after all is settled goes its ways. */
static impact_status part_ways(imp_island *island)
{
    const impact_status told = tell_pairs(island);
    imp_island_give_forces(island);
    count_moving(island);
    bool stays = false;
    imp_island *parts = NULL;
    impact_status status = make_parts(island, &parts, &stays);
    for (imp_island *part = parts; part;) {
        imp_island *next = part->next;
        part->next = NULL;
        if (status == IMPACT_OK) status = start_part(part, island);
        part = next;
    }
    if (stays && status == IMPACT_OK) {
        give_account(island);
        island->balance = imp_island_balance(island);
        status = start(island);
    }
    look_ahead(island);
    if (!stays) release(island);
    return status == IMPACT_OK ? told : status;
}

/* ---- instants ---- */

/* A body may have so many events at one time. */
static impact_status check_stall(impact_scene *scene, const imp_island *island)
{
    enum { MAX_STALLS = 10000 };
    for (int i = 0; i < island->world.body_count; i++) {
        const imp_body *body = &island->world.bodies[i];
        imp_track *track = &scene->tracks.tracks[body->index];
        if (body->is_static) continue;
        track->stalls = track->last_event == island->t ? track->stalls + 1 : 0;
        track->last_event = island->t;
        if (track->stalls < MAX_STALLS) continue;
        snprintf(scene->message, sizeof scene->message,
                 "body '%s': %d events at the one instant t = %.17g brought no end", body->name, MAX_STALLS, island->t);
        return IMPACT_EUNSETTLED;
    }
    return IMPACT_OK;
}

/* What is settled goes on, whatever became of the rows. */
static impact_status conclude(imp_island *island, impact_status status)
{
    impact_scene *scene = island->scene;
    const impact_status stalled = check_stall(scene, island);
    if (status != IMPACT_OK) {
        part_ways(island);
        return fail(island, status);
    }
    if (!island->stepped) imp_scene_receipt_look(island);
    const impact_status parted = part_ways(island);
    if (parted != IMPACT_OK || stalled != IMPACT_OK) return parted != IMPACT_OK ? parted : stalled;
    return imp_scene_account(scene) ? IMPACT_OK : IMPACT_ESINK;
}

static impact_status bring_all_to_rest(imp_island *island)
{
    imp_scene_remember(island);
    impact_status status = IMPACT_OK;
    const double energy = imp_island_energy(island);
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
    if (imp_island_can_stand(island)) return conclude(island, bring_all_to_rest(island));
    for (int p = 0; p < island->world.pair_count; p++) island->world.pairs[p].met = true;
    return conclude(island, IMPACT_OK);
}

impact_status imp_scene_meet(impact_scene *scene, int n, double t)
{
    if (!imp_scene_account(scene)) return IMPACT_ESINK;
    const imp_near *near = &scene->tracks.near[n];
    const int body[2] = {near->body[0], near->body[1]};
    for (int k = 0; k < 2; k++) add_member(scene, body[k]);
    imp_island *island;
    impact_status status = gather(scene, n, t, scene->piles == IMPACT_PILES_STEPS, &island);
    if (status != IMPACT_OK) return status;
    island->outside = energy_outside(scene, island, t);
    if (island->stepped) return conclude_steps(island);
    const int i = imp_island_find(island, body[0]), j = imp_island_find(island, body[1]);
    int p = 0;
    while (island->world.pairs[p].body1 != i || island->world.pairs[p].body2 != j) p++;
    imp_pair *pair = &island->world.pairs[p];
    if (!pair->beyond) return conclude(island, imp_scene_handle(island, (imp_end){IMP_END_GAP, p}));
    pair->beyond = false; /* before the plane again */
    return conclude(island, IMPACT_OK);
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
    const impact_status status = step(island);
    look_ahead(island);
    return status;
}

/* Patience is at its end: the island goes on by steps, with all pairs that its bodies may make. */
static impact_status turn_to_steps(impact_scene *scene, imp_island *island, double t)
{
    imp_island *stepped;
    add_company(scene, island->world.bodies[island->world.pairs[0].body1].index);
    const impact_status status = gather(scene, -1, t, true, &stepped);
    return status == IMPACT_OK ? conclude_steps(stepped) : status;
}

/* Whether the pile still is one. */
static bool stays_together(imp_island *island)
{
    int *root = island->scene->root, first = 0;
    const int components = find_components(island, root);
    while (root[first] != first) first++;
    const bool stays = components == 1 && stays_stepped(island, root, first);
    for (int i = 0; i < island->world.body_count; i++) root[i] = -1;
    return stays;
}

/* What stood under forces that change may move again. */
static void wake(imp_island *island)
{
    for (int i = 0; i < island->world.body_count; i++) island->motion.resting[i] = false;
    count_moving(island);
}

static impact_status continue_steps(imp_island *island)
{
    const imp_stepped found = imp_island_after_step(island);
    const bool stood = all_rest(island);
    if (found == IMP_STEPPED_REST && stood) return go_on(island);
    if (stood) wake(island);
    if (found == IMP_STEPPED_ON) return go_on(island);
    if (found == IMP_STEPPED_LOOK && stays_together(island)) {
        imp_island_forget_met(island);
        return go_on(island);
    }
    island->outside = energy_outside(island->scene, island, island->t);
    return conclude(island, found == IMP_STEPPED_REST ? bring_all_to_rest(island) : IMPACT_OK);
}

impact_status imp_scene_continue(impact_scene *scene, imp_island *island)
{
    const double t = island->t = island->motion.stride.t;
    if (!finish(island)) return IMPACT_ESINK;
    if (island->stepped) return continue_steps(island);
    if (imp_island_loses_patience(island)) return turn_to_steps(scene, island, t);
    if (island->end.kind == IMP_END_TIME) return go_on(island);
    if (!imp_scene_account(scene)) return IMPACT_ESINK;
    island->outside = energy_outside(scene, island, t);
    impact_status status = imp_scene_handle(island, island->end);
    while (status == IMPACT_OK && imp_motion_also_crossed(&island->motion, &island->end))
        status = imp_scene_handle(island, island->end);
    return conclude(island, status);
}

/* Whether anything happens to the body at the start. */
static bool begins_alone(impact_scene *scene, int body)
{
    const imp_track *track = &scene->tracks.tracks[body];
    for (int k = 0; k < scene->world.field_count; k++)
        if (scene->world.fields[k].only < 0 || scene->world.fields[k].only == body) return false;
    for (int k = 0; k < track->near_count; k++)
        if (touches(scene, &scene->tracks.near[track->near[k]], scene->t)) return false;
    return true;
}

impact_status imp_scene_first_encounters(impact_scene *scene)
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
        add_member(scene, i);
        status = gather(scene, -1, scene->t, scene->piles == IMPACT_PILES_STEPS, &island);
        if (status != IMPACT_OK) break;
        island->outside = energy_outside(scene, island, scene->t);
        status = island->stepped ? conclude_steps(island) : conclude(island, imp_scene_settle(island));
    }
    return status;
}
