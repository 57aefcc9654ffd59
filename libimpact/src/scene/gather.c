/* SPDX-License-Identifier: MIT */
#include "scene/gather.h"
#include "scene/following.h"
#include "scene/islands.h"
#include "scene/scene_events.h"
#include "scene/scene_keys.h"
#include "scene/stepped.h"
#include "world/world_gap.h"

#include <stdlib.h>

/* Bodies are marked by their place among the members; all others have -1. */
void imp_gather_member(impact_scene *scene, int body)
{
    if (scene->world.bodies[body].is_static || scene->root[body] >= 0) return;
    scene->root[body] = scene->member_count;
    scene->members[scene->member_count++] = body;
}

void imp_gather_company(impact_scene *scene, int body)
{
    const int number = scene->tracks.tracks[body].island;
    if (number < 0) return;
    const imp_island *island = scene->islands[number];
    for (int i = 0; i < island->world.body_count; i++) imp_gather_member(scene, island->world.bodies[i].index);
}

static void add_attracted(impact_scene *scene)
{
    for (int k = 0; k < scene->world.field_count; k++)
        if (scene->world.fields[k].def.kind == IMPACT_FORCE_ATTRACTION)
            for (int i = 0; i < scene->world.body_count; i++) imp_gather_member(scene, i);
}

/* Whether the pair touches at t, but for a rounding. */
bool imp_gather_touches(impact_scene *scene, const imp_near *near, double t)
{
    const imp_body *b1 = &scene->world.bodies[near->body[0]], *b2 = &scene->world.bodies[near->body[1]];
    const imp_segment *s1 = &scene->tracks.tracks[near->body[0]].segment,
                      *s2 = &scene->tracks.tracks[near->body[1]].segment;
    qvec3 v;
    if (near->beyond) return false;
    const qvec3 x1 = imp_segment_place(s1, b1, t, &v), x2 = imp_segment_place(s2, b2, t, &v), d = qvec3_sub(x1, x2);
    const bool plane = b2->shape.kind == IMPACT_PLANE;
    const double reach = plane ? b1->radius : b1->radius + b2->radius, distance = sqrt(qvec3_dot(d, d));
    const double far =
        fabs(x1.x) + fabs(x1.y) + fabs(x1.z) + distance; /* no place scale is more than 3 (far + reach) */
    if (!plane && distance - reach > IMP_TOUCHING * 3 * (far + reach)) return false;
    const qvec3 n =
        plane ? quat_rotate(s2->start.q, (qvec3){0, 0, 1}) : qvec3_scale(d, distance > 0 ? 1 / distance : 0);
    const double touching = IMP_TOUCHING * imp_place_scale(b1, x1, b2, x2, n);
    if (qvec3_dot(n, d) - reach > touching) return false;
    if (imp_is_ball(b1) && (plane || imp_is_ball(b2))) return true;
    const imp_state a = imp_segment_at(s1, b1, t), b = imp_segment_at(s2, b2, t);
    impact_contact contact;
    imp_gap_of(b1, &a, b2, &b, scene->world.gaps, &scene->world.usage, &contact);
    return contact.gap <=
           IMP_TOUCHING * imp_place_scale(b1, x1, b2, x2, contact.normal) + imp_gap_error(scene->world.gaps, b1, b2);
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
        imp_gather_company(scene, body);
        for (int k = 0; status == IMPACT_OK && k < track->companion_count; k++) {
            const imp_near *near = &scene->tracks.near[track->companions[k].near];
            const int other = track->companions[k].other;
            if (near->held || (scene->root[other] >= 0 && scene->root[other] < m)) continue; /* an island's; seen */
            if (track->companions[k].near != seed && !imp_gather_touches(scene, near, t)) continue;
            imp_gather_member(scene, other);
            imp_pair pair = imp_rules_pair(&scene->rules, &scene->world, near->body[0], near->body[1]);
            if (near->beyond) pair.mode = IMP_BEYOND;
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
        if (!imp_island_ties(island, &pair)) continue;
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
        for (int k = 0; status == IMPACT_OK && k < track->companion_count; k++) {
            const imp_near *near = &scene->tracks.near[track->companions[k].near];
            const bool within = scene->world.bodies[near->body[1]].is_static || scene->root[near->body[1]] >= 0;
            if (near->body[0] != scene->members[m] || !within) continue;
            imp_pair pair = imp_rules_pair(&scene->rules, &scene->world, near->body[0], near->body[1]);
            if (near->beyond) pair.mode = IMP_BEYOND;
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

/* In the order of the definition: by the earlier body of each pair, then the later, then the corner. */
static int by_bodies(const void *a, const void *b)
{
    const imp_pair *x = a, *y = b;
    const int low_x = x->body1 < x->body2 ? x->body1 : x->body2, low_y = y->body1 < y->body2 ? y->body1 : y->body2;
    if (low_x != low_y) return (low_x > low_y) - (low_x < low_y);
    const int high_x = x->body1 + x->body2 - low_x, high_y = y->body1 + y->body2 - low_y;
    if (high_x != high_y) return (high_x > high_y) - (high_x < high_y);
    return (x->site.corner > y->site.corner) - (x->site.corner < y->site.corner);
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
    if (scene->touching_count > 1)
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

/* The pairs of the members, which scene->root numbers by now, and the forces on them. */
static impact_status fill_pairs(imp_island *island)
{
    const impact_scene *scene = island->scene;
    for (int p = 0; p < scene->touching_count; p++) {
        imp_pair *pair = &island->world.pairs[island->world.pair_count++];
        *pair = scene->touching[p];
        pair->body1 = scene->root[pair->body1];
        pair->body2 = scene->root[pair->body2];
    }
    return imp_island_take_forces(island);
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
    return status == IMPACT_OK ? fill_pairs(island) : status;
}

static void clear_members(impact_scene *scene)
{
    for (int m = 0; m < scene->member_count; m++) scene->root[scene->members[m]] = -1;
    scene->member_count = scene->touching_count = 0;
}

/* Whether it is one body that rests on what is static: by a proof of the pile's, and no steps. */
static bool rests_alone(const imp_island *island)
{
    int moving = 0;
    for (int i = 0; i < island->world.body_count; i++) moving += !island->world.bodies[i].is_static;
    return island->rests && moving == 1;
}

/* The energy of all but the members at t, for the rows of events. */
double imp_gather_energy_outside(impact_scene *scene, const imp_island *island, double t)
{
    for (int i = 0; i < island->world.body_count; i++)
        imp_account_set(&scene->account, island->world.bodies[i].index, 0);
    return imp_scene_tells_events(island) ? imp_scene_energy_beside(scene, island, t) : 0;
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
        were_stepped = were_stepped || (old->stepped && !rests_alone(old));
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
        imp_islands_release(old);
    }
}

/* An island of all that the members (and the pair `seed`) touch at t. stepped: to be moved by steps, as it is too where
 * one that joins it was. */
impact_status imp_gather(impact_scene *scene, int seed, double t, bool stepped, imp_island **out)
{
    *out = NULL;
    add_attracted(scene);
    imp_island *island = imp_islands_spare(scene);
    if (!island) return IMPACT_ENOMEM;
    island->t = island->looked_at = t;
    island->stepped = stepped;
    impact_status status = follow_contacts(scene, seed, t);
    if (status == IMPACT_OK) status = close_old(scene, t, island);
    if (status == IMPACT_OK && island->stepped) status = add_all_near(scene);
    if (status != IMPACT_OK) {
        imp_islands_release(island);
        return status;
    }
    sort_members(scene);
    status = fill(island, t);
    release_old(scene);
    clear_members(scene);
    if (status == IMPACT_OK && island->stepped) status = imp_island_begin_steps(island);
    if (status != IMPACT_OK) {
        imp_islands_release(island);
        return status;
    }
    island->balance = imp_island_balance(island);
    *out = island;
    return IMPACT_OK;
}

/* Bodies and pairs of the members, the bodies' states from the island they were in. */
static impact_status fill_from(imp_island *to, const imp_island *from)
{
    impact_scene *scene = to->scene;
    const impact_status status = imp_island_reserve(to, scene->member_count, scene->touching_count);
    for (int m = 0; status == IMPACT_OK && m < scene->member_count; m++) {
        const int body = scene->members[m], i = imp_island_find(from, body);
        const imp_state *state = i >= 0 ? &from->states[i] : &scene->tracks.tracks[body].segment.start;
        scene->root[body] = imp_island_add_body(to, body, state);
    }
    return status == IMPACT_OK ? fill_pairs(to) : status;
}

impact_status imp_gather_steps(imp_island *island, imp_island **out)
{
    impact_scene *scene = island->scene;
    imp_island *steps = *out = imp_islands_spare(scene);
    if (!steps) return IMPACT_ENOMEM;
    steps->t = steps->looked_at = island->t;
    steps->outside = island->outside;
    steps->stepped = true;
    imp_island_give_forces(island);
    for (int i = 0; i < island->world.body_count; i++) imp_gather_member(scene, island->world.bodies[i].index);
    impact_status status = add_all_near(scene);
    if (status == IMPACT_OK) {
        sort_members(scene);
        status = fill_from(steps, island);
    }
    clear_members(scene);
    if (status == IMPACT_OK) status = imp_island_begin_steps(steps);
    if (status != IMPACT_OK) {
        imp_islands_release(steps);
        return status;
    }
    scene->world.usage.islands_stepped++;
    steps->balance = imp_island_balance(steps);
    imp_islands_release(island);
    return IMPACT_OK;
}
