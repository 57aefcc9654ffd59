/* SPDX-License-Identifier: MIT */
#include "motion/pile_contacts.h"
#include "base/tolerances.h"
#include "world/normal.h"
#include "world/world_gap.h"

#include <string.h>

bool imp_pile_contacts_reserve(imp_pile_contacts *contacts, const imp_world *world)
{
    if (world->body_count > contacts->bodies) {
        imp_arena_give(contacts->arena, contacts->root);
        contacts->root = imp_arena_take(contacts->arena, (size_t)world->body_count, sizeof *contacts->root);
        contacts->bodies = contacts->root ? world->body_count : 0;
    }
    if (world->pair_count > contacts->pairs) {
        imp_arena_give(contacts->arena, contacts->held);
        contacts->held = imp_arena_take(contacts->arena, (size_t)world->pair_count, sizeof *contacts->held);
        contacts->pairs = contacts->held ? world->pair_count : 0;
    }
    return world->body_count <= contacts->bodies && world->pair_count <= contacts->pairs;
}

void imp_pile_contacts_mark(imp_pile_contacts *contacts, const imp_world *world, const imp_pile_memories *memories)
{
    for (int p = 0; p < world->pair_count; p++) contacts->held[p] = false;
    for (int k = 0; k < memories->count; k++) contacts->held[memories->list[k].pair] = true;
}

/* ---- points ---- */

static int root_of(int *root, int i)
{
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
}

static bool add_point(imp_pile_contacts *contacts, const imp_world *world, int p, const imp_point *point)
{
    imp_pile_point *points =
        imp_arena_grow(contacts->arena, contacts->points, &contacts->room, contacts->count + 1, sizeof *points);
    if (!points) return false;
    contacts->points = points;
    const imp_pair *pair = &world->pairs[p];
    imp_pile_point *own = &points[contacts->count++];
    *own = (imp_pile_point){.pair = p,
                            .feature = {point->feature[0], point->feature[1]},
                            .bearer = point->bearer,
                            .contact = {.body1 = pair->body1,
                                        .body2 = pair->body2,
                                        .arm1 = point->contact.offset1,
                                        .arm2 = point->contact.offset2},
                            .gap = point->contact.gap,
                            .strength = 1,
                            .memory = -1};
    imp_cone_find_axes(point->contact.normal, own->contact.axes);
    if (!world->bodies[pair->body1].is_static && !world->bodies[pair->body2].is_static)
        contacts->root[root_of(contacts->root, pair->body1)] = root_of(contacts->root, pair->body2);
    return true;
}

/* How fast any two points of the pair's bodies go by each other at most. */
static double fastest(const imp_world *world, const imp_pair *pair, const imp_state *next)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &next[pair->body1], *s2 = &next[pair->body2];
    double speed = qvec3_norm(qvec3_sub(s1->v, s2->v)) + b1->radius * qvec3_norm(imp_omega(b1, s1));
    if (!b2->is_static) speed += b2->radius * qvec3_norm(imp_omega(b2, s2));
    return speed;
}

static bool is_on_rim(const imp_point *p)
{
    return p->feature[0].kind == IMPACT_RIM || p->feature[1].kind == IMPACT_RIM;
}

/* A rim's points are some of its places, and those of two faces the corners of what they share, within some height: an
 * edge may stand in a face between them, and two bodies overlap most at another place. That is one more, after the
 * points found, among which there is room for it; how many then. */
static int add_deepest(imp_world *world, imp_pair *pair, const imp_state *states, const impact_contact *contact,
                       imp_point *points, int found)
{
    bool rim = false;
    double least = INFINITY;
    for (int k = 0; k < found; k++) rim = rim || is_on_rim(&points[k]), least = fmin(least, points[k].contact.gap);
    const double touching = imp_world_touching_distance(world, pair, states);
    impact_contact deepest = *contact;
    if (rim) imp_world_gap(world, pair, states, &deepest); /* the contact is a face's */
    if (found == 0 || !(deepest.gap < fmin(least, 0) - touching)) return found;
    points[found] = (imp_point){.contact = deepest, .feature = {{IMPACT_SMOOTH, -1}, {IMPACT_SMOOTH, -1}}};
    return found + 1;
}

bool imp_pile_find_points(imp_pile_contacts *contacts, imp_world *world, const imp_state *states, const imp_state *next,
                          double h, double slack, bool held_only)
{
    contacts->count = 0;
    for (int i = 0; i < world->body_count; i++) contacts->root[i] = i;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        const bool held = contacts->held[p];
        if (held_only && !held) continue;
        const double height = held && next ? slack + 0.5 * h * fastest(world, pair, next) : slack;
        if (imp_world_distance_bound(world, pair, states) > height) continue;
        if (imp_pair_has_faces(world, pair) && imp_world_separation(world, pair, states) > height) continue;
        imp_point points[IMP_POINTS + 1];
        const double flush = imp_stepped_flush(&world->bodies[pair->body1], &world->bodies[pair->body2]);
        impact_contact contact;
        int found = imp_points_find(world, pair, states, height, flush, &contact, points);
        if (!next) found = add_deepest(world, pair, states, &contact, points, found);
        for (int k = 0; k < found; k++) {
            const impact_contact *c = &points[k].contact;
            const bool closes =
                c->gap <= slack || (held && next && c->gap + 0.5 * h * imp_world_gap_rate(world, pair, next, c) <= 0);
            if (!closes && !held_only) continue;
            if (!add_point(contacts, world, p, &points[k])) return false;
        }
    }
    return true;
}

static int island_of(imp_pile_contacts *contacts, const imp_world *world, const imp_pile_point *point)
{
    const int body = world->bodies[point->contact.body1].is_static ? point->contact.body2 : point->contact.body1;
    return root_of(contacts->root, body);
}

int imp_pile_take_island(imp_pile_contacts *contacts, const imp_world *world, int *members)
{
    int first = 0, count = 0;
    while (first < contacts->count && contacts->points[first].taken) first++;
    if (first == contacts->count) return 0;
    const int island = island_of(contacts, world, &contacts->points[first]);
    for (int k = first; k < contacts->count; k++) {
        imp_pile_point *point = &contacts->points[k];
        if (point->taken || island_of(contacts, world, point) != island) continue;
        point->taken = true;
        members[count++] = k;
    }
    return count;
}

/* ---- memory ---- */

static bool same_feature(impact_feature a, impact_feature b) { return a.kind == b.kind && a.index == b.index; }

static bool same_features(const imp_pile_memory *m, const imp_pile_point *point)
{
    return same_feature(m->feature[0], point->feature[0]) && same_feature(m->feature[1], point->feature[1]);
}

/* Of one pair: its points and what is remembered of them, both in a row. */
typedef struct pair_points {
    imp_pile_point *points;
    int count;
    imp_pile_memory *memories;
    int memory_count, first; /* of those: its number among all */
} pair_points;

/* How far apart a point and what is remembered are; infinite: alike is asked for, and they are of other features. */
static double apart_of(const imp_pile_memory *m, const imp_pile_point *point, bool alike)
{
    return alike && !same_features(m, point) ? INFINITY : qvec3_norm(qvec3_sub(m->arm1, point->contact.arm1));
}

/* The nearest that is no point's yet; NULL: there is none. */
static imp_pile_memory *nearest_memory(const pair_points *own, const imp_pile_point *point, bool alike, double *apart)
{
    imp_pile_memory *best = NULL;
    *apart = INFINITY;
    for (int k = 0; k < own->memory_count; k++) {
        if (own->memories[k].taken) continue;
        const double distance = apart_of(&own->memories[k], point, alike);
        if (distance < *apart) best = &own->memories[k], *apart = distance;
    }
    return best;
}

/* A point of which nothing is remembered yet is nearer than that. */
static bool is_nearer_to_another(const pair_points *own, const imp_pile_memory *m, double apart, bool alike)
{
    for (int i = 0; i < own->count; i++)
        if (own->points[i].memory < 0 && apart_of(m, &own->points[i], alike) < apart) return true;
    return false;
}

/* Points and what is remembered of them that are each other's nearest, no farther apart than `far`; false: none. */
static bool recall_nearest(const pair_points *own, double far, bool alike)
{
    bool some = false;
    for (int i = 0; i < own->count; i++) {
        imp_pile_point *point = &own->points[i];
        if (point->memory >= 0) continue;
        double apart;
        imp_pile_memory *memory = nearest_memory(own, point, alike, &apart);
        if (!memory || apart > far || is_nearer_to_another(own, memory, apart, alike)) continue;
        point->memory = own->first + (int)(memory - own->memories);
        memory->taken = some = true;
    }
    return some;
}

/* Those of the pair, which are in a row: a pair is of one island. */
static void find_memories(pair_points *own, const imp_pile_memories *memories)
{
    const int pair = own->points->pair;
    int first = 0, end;
    while (first < memories->count && memories->list[first].pair != pair) first++;
    for (end = first; end < memories->count && memories->list[end].pair == pair;) end++;
    own->first = first;
    own->memories = memories->list + first;
    own->memory_count = end - first;
}

void imp_pile_recall(imp_pile_contacts *contacts, const imp_world *world, const imp_state *states, double h,
                     imp_pile_memories *memories)
{
    for (int k = 0; k < memories->count; k++) memories->list[k].taken = false;
    if (memories->count == 0) return;
    for (int i = 0; i < contacts->count;) {
        pair_points own = {.points = &contacts->points[i]};
        while (i < contacts->count && contacts->points[i].pair == own.points->pair) i++, own.count++;
        find_memories(&own, memories);
        if (own.memory_count == 0) continue;
        while (recall_nearest(&own, INFINITY, true)) continue;
        const double way = h * fastest(world, &world->pairs[own.points->pair], states);
        while (recall_nearest(&own, way, false)) continue;
    }
}

imp_pile_memory *imp_pile_remember(imp_arena *arena, imp_pile_memories *memories, const imp_pile_point *point)
{
    imp_pile_memory *list = imp_arena_grow(arena, memories->list, &memories->room, memories->count + 1, sizeof *list);
    if (!list) return NULL;
    memories->list = list;
    imp_pile_memory *own = &list[memories->count++];
    *own = (imp_pile_memory){.pair = point->pair,
                             .feature = {point->feature[0], point->feature[1]},
                             .gap = point->gap,
                             .arm1 = point->contact.arm1,
                             .arm2 = point->contact.arm2,
                             .rub = point->contact.rub,
                             .normal = point->contact.axes[0]};
    return own;
}

bool imp_pile_copy_memories(imp_arena *arena, imp_pile_memories *to, const imp_pile_memories *from)
{
    to->count = 0;
    if (from->count == 0) return true;
    imp_pile_memory *list = imp_arena_grow(arena, to->list, &to->room, from->count, sizeof *list);
    if (!list) return false;
    to->list = list;
    to->count = from->count;
    memcpy(list, from->list, sizeof *list * (size_t)from->count);
    return true;
}
