/* SPDX-License-Identifier: MIT */
#include "scene/scene_points.h"
#include "contact/points.h"
#include "scene/scene_meeting.h"
#include "world/corner.h"
#include "world/normal.h"
#include "world/world_gap.h"

#include <string.h>

/* The pair of both bodies that the point is of: nothing is held. */
static imp_pair whole_pair(const imp_pair *pair)
{
    imp_pair whole = *pair;
    if (imp_is_held(pair)) whole.mode = IMP_OPEN;
    whole.slip.stage = IMP_SLIP_GROSS;
    whole.site.placed = whole.rest.still = false;
    whole.site.corner = whole.site.face = 0;
    return whole;
}

/* Whether one of the pairs is of the same bodies. */
static bool is_among(const imp_pair *pairs, int count, const imp_pair *pair)
{
    for (int k = 0; k < count; k++)
        if (imp_same_bodies(&pairs[k], pair)) return true;
    return false;
}

/* What of body 1 the point is and on which face of body 2 (corner.h), where it stands on what is static; 0: nothing
 * that can be held alone. */
static int corner_of(const imp_island *island, const imp_pair *pair, const imp_point *point, int count, int *face)
{
    const imp_world *world = &island->world;
    const imp_body *under = &world->bodies[pair->body2];
    const impact_feature on = point->feature[1];
    if (world->bodies[pair->body1].shape.kind == IMPACT_SPHERE) {
        /* at the seam of two faces it is on the one that it goes to: within that of the border its normal may be off by
         * as much, or by what steps err */
        const qvec3 v = island->states[pair->body1].v;
        const double speed = qvec3_norm(v), ahead = IMP_TOUCHING * world->bodies[pair->body1].radius;
        impact_contact foot = point->contact;
        if (speed > 0) foot.offset2 = qvec3_axpy(ahead / speed, v, foot.offset2);
        *face = imp_corner_face_under(under, &island->states[pair->body2], &foot,
                                      island->stepped ? IMP_PILE_SLACK * IMP_DEFAULT_PILE_TOLERANCE : 2 * IMP_TOUCHING);
        return *face > 0 ? 1 : 0;
    }
    *face = on.kind == IMPACT_FACE && on.index >= 0 && on.index < imp_corner_faces(under) ? on.index + 1 : 0;
    if (under->shape.kind != IMPACT_PLANE && *face == 0) return 0;
    const bool of_disc = point->feature[0].kind == IMPACT_RIM && count > 2;
    if (of_disc) return 0;
    imp_pair stands = *pair;
    stands.site.face = *face;
    return imp_corner_ahead(world, &stands, island->states,
                            imp_corner_number(&world->bodies[pair->body1], point->feature[0]));
}

/* What was held there goes on being held until it is settled anew. */
static imp_pair point_pair(const imp_pair *whole, int corner, int face, const imp_pair *before, int count)
{
    for (int k = 0; corner > 0 && k < count; k++)
        if (before[k].site.corner == corner && before[k].site.face == face && imp_same_bodies(&before[k], whole))
            return before[k];
    imp_pair own = *whole;
    own.site.corner = corner, own.site.face = face;
    return own;
}

/* Whether one of the pairs from `first` on is of that corner: edges that end in one apex have it together. */
static bool is_placed(const imp_world *world, int first, int corner, int face)
{
    for (int k = first; corner > 0 && k < world->pair_count; k++)
        if (world->pairs[k].site.corner == corner && world->pairs[k].site.face == face) return true;
    return false;
}

void imp_scene_name_corner(imp_island *island, imp_pair *pair)
{
    imp_world *world = &island->world;
    imp_point points[IMP_POINTS];
    impact_contact contact;
    int face;
    if (pair->site.placed || pair->site.corner > 0 || !imp_pair_has_faces(world, pair)) return;
    const double touching = imp_world_touching_distance(world, pair, island->states);
    const int count = imp_points_find(world, pair, island->states, touching, touching, &contact, points);
    const int corner = count == 1 ? corner_of(island, pair, &points[0], count, &face) : 0;
    if (corner > 0) pair->site.corner = corner, pair->site.face = face;
}

/* The points of the bodies of before[p], of so many pairs. */
static impact_status place(imp_island *island, const imp_pair *before, int p, int pairs)
{
    imp_world *world = &island->world;
    imp_point points[IMP_POINTS];
    impact_contact contact;
    imp_pair whole = whole_pair(&before[p]);
    const double touching = imp_world_touching_distance(world, &whole, island->states);
    const imp_body *b1 = &world->bodies[whole.body1], *b2 = &world->bodies[whole.body2];
    const double flush = island->stepped ? imp_stepped_flush(b1, b2) : touching;
    const int count = imp_points_find(world, &whole, island->states, touching, flush, &contact, points);
    const impact_status status = imp_island_reserve(island, world->body_count, world->pair_count + count + 1);
    const int first = world->pair_count;
    for (int k = 0; status == IMPACT_OK && k < count; k++) {
        int face;
        const int corner = corner_of(island, &whole, &points[k], count, &face);
        if (is_placed(world, first, corner, face)) continue;
        imp_pair own = point_pair(&whole, corner, face, before, pairs);
        own.site.placed = true;
        own.site.contact = points[k].contact;
        own.site.bearer = points[k].bearer;
        world->pairs[world->pair_count++] = own;
    }
    if (status == IMPACT_OK && world->pair_count == first) world->pairs[world->pair_count++] = whole;
    return status;
}

impact_status imp_scene_place_points(imp_island *island)
{
    imp_world *world = &island->world;
    bool any = false;
    for (int p = 0; p < world->pair_count; p++) any = any || imp_pair_has_faces(world, &world->pairs[p]);
    if (!any) return IMPACT_OK;
    const int count = world->pair_count;
    const size_t size = sizeof *world->pairs * (size_t)count;
    imp_pair *before = imp_arena_take(world->arena, (size_t)count, sizeof *before);
    if (!before) return IMPACT_ENOMEM;
    memcpy(before, world->pairs, size);
    world->pair_count = 0;
    impact_status status = IMPACT_OK;
    for (int p = 0; status == IMPACT_OK && p < count; p++) {
        if (!imp_pair_has_faces(world, &before[p])) {
            status = imp_island_reserve(island, world->body_count, world->pair_count + 1);
            if (status == IMPACT_OK) world->pairs[world->pair_count++] = before[p];
        } else if (!is_among(before, p, &before[p])) {
            status = place(island, before, p, count);
        }
    }
    imp_arena_give(world->arena, before);
    return status;
}

bool imp_scene_point_stays(imp_island *island, int p)
{
    imp_meeting m;
    if (!island->world.pairs[p].site.placed || !imp_scene_meets(island, p, &m)) return false;
    imp_scene_press(island, &m);
    return m.acceleration < 0 ? imp_scene_dies_out(island, &m, m.velocity) : m.velocity <= island->world.slip_speed;
}

/* Whether body 1 reaches below the face its corner is on, beside its border: edges may meet there. */
static bool overhangs(const imp_island *island, int p)
{
    const imp_pair *pair = &island->world.pairs[p];
    const double touching = imp_world_touching_distance(&island->world, pair, island->states);
    return pair->site.face > 0 && imp_corner_lowest(&island->world, pair, island->states) < -touching;
}

/* Whether the point's place on body 1 stands on another body's face too: it is held there. What goes d over the edge of
 * one face is d^2/2r above it: the two places are one as far as gaps can tell, d <= sqrt(2 r touching). */
static bool is_held_beside(const imp_world *world, const imp_pair *pair)
{
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *other = &world->pairs[p];
        if (other->site.corner == 0 || !other->site.placed || other->body1 != pair->body1 ||
            imp_same_bodies(other, pair))
            continue;
        const double size = world->bodies[pair->body1].radius;
        const qvec3 apart = qvec3_sub(other->site.contact.offset1, pair->site.contact.offset1);
        if (qvec3_norm(apart) <= sqrt(2 * IMP_TOUCHING) * size) return true;
    }
    return false;
}

imp_stay imp_scene_points_stay(imp_island *island)
{
    const imp_world *world = &island->world;
    imp_stay found = IMP_STAY_NONE;
    for (int p = 0, run = 0; p < world->pair_count; p++) {
        /* the points of two bodies follow each other */
        if (p > 0 && !imp_same_bodies(&world->pairs[p], &world->pairs[p - 1])) run = 0;
        if (world->pairs[p].footing.on == IMP_FOOT_FACE || island->notes[p].rises || !imp_scene_point_stays(island, p))
            continue;
        if (world->pairs[p].site.corner == 0 && is_held_beside(world, &world->pairs[p])) continue;
        if (world->pairs[p].site.corner == 0 || ++run > 2 || overhangs(island, p)) return IMP_STAY_FACES;
        found = IMP_STAY_CORNERS;
    }
    return found;
}

static bool is_point(const imp_pair *pair) { return pair->site.placed || pair->site.corner > 0; }

static bool is_held_corner(const imp_pair *pair) { return pair->site.corner > 0 && imp_is_held(pair); }

/* At an end of the line that its body lies on. */
static bool lies_on_corners(const imp_pair *pair) { return pair->site.corner > 0 && pair->footing.on == IMP_FOOT_FACE; }

void imp_scene_drop_points(imp_island *island)
{
    imp_world *world = &island->world;
    int kept = 0;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair pair = world->pairs[p];
        if (is_held_corner(&pair) || lies_on_corners(&pair)) {
            pair.site.placed = false;
        } else if (is_point(&pair)) {
            if (imp_corner_is_held(world, &pair, 0) || is_among(world->pairs, kept, &pair)) continue;
            pair = whole_pair(&pair);
        }
        island->notes[kept] = island->notes[p];
        world->pairs[kept++] = pair;
    }
    world->pair_count = kept;
}

bool imp_scene_holds_features(const imp_island *island)
{
    const imp_world *world = &island->world;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        if (is_held_corner(pair) || (imp_is_held(pair) && imp_pair_can_lie(world, pair))) return true;
    }
    return false;
}
