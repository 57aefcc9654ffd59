/* SPDX-License-Identifier: MIT */
#include "contact/points.h"
#include "gap/gap_core.h"
#include "shape/ridge.h"
#include "shape/solid.h"
#include "world/normal.h"
#include "world/world_gap.h"

bool imp_has_faces(const imp_body *body) { return imp_has_core(&body->shape) || imp_ridge_count(&body->shape) > 0; }

/* On a ball a body's edges are as round as the ball. */
bool imp_pair_has_faces(const imp_world *world, const imp_pair *pair)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const bool ball = imp_is_ball(b1) || imp_is_ball(b2);
    return imp_has_core(&b1->shape) || imp_has_core(&b2->shape) || (!ball && (imp_has_faces(b1) || imp_has_faces(b2)));
}

/* Whether more than a point of the body can lie on a plane. */
static bool can_lie(const imp_body *body)
{
    const impact_shape *s = &body->shape;
    const bool curved = s->kind == IMPACT_SUPERQUADRIC || s->kind == IMPACT_SUPERELLIPSOID;
    return s->kind == IMPACT_PLANE || imp_has_faces(body) ||
           (curved && fmax(s->r, fmax(s->s, s->t)) >= IMP_FLAT_EXPONENT);
}

bool imp_pair_can_lie(const imp_world *world, const imp_pair *pair)
{
    return can_lie(&world->bodies[pair->body1]) && can_lie(&world->bodies[pair->body2]);
}

/* Of two faces on each other either turns the normal. */
static imp_bearer bearer_of(const impact_patch *patch)
{
    if (patch->count < 2) return IMP_BORNE_BY_BOTH;
    if (patch->dimension1 == 1 && patch->dimension2 == 1) return IMP_BORNE_BY_LINES;
    return patch->dimension2 == 2 ? IMP_BORNE_BY_2 : IMP_BORNE_BY_1;
}

static imp_point point_of(const impact_patch *patch, int i, qvec3 shift1, qvec3 shift2)
{
    const impact_patch_point *p = &patch->point[i];
    return (imp_point){.contact = {.gap = p->height,
                                   .normal = p->normal,
                                   .offset1 = qvec3_add(p->offset1, shift1),
                                   .offset2 = qvec3_add(p->offset2, shift2)},
                       .feature = {p->feature1, p->feature2},
                       .bearer = bearer_of(patch)};
}

/* Neither two polytopes, which have a closed form, nor on a plane. */
static bool is_mixed(const imp_body *b1, const imp_body *b2)
{
    return b2->shape.kind != IMPACT_PLANE && !imp_core_takes(&b1->shape, &b2->shape);
}

static int keep_near(imp_point *points, int count, double height)
{
    int kept = 0;
    for (int i = 0; i < count; i++)
        if (points[i].contact.gap <= height) points[kept++] = points[i];
    return kept;
}

int imp_points_find(imp_world *world, imp_pair *pair, const imp_state *states, double height, double flush,
                    impact_contact *contact, imp_point *points)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    if (is_mixed(b1, b2) && pair->cache.valid && imp_face_gap(b1, s1, b2, s2, pair->cache.normal, contact)) {
        pair->cache.normal = contact->normal;
        imp_settle_among(world, pair, states, flush, contact);
    } else {
        (void)imp_world_gap_within(world, pair, states, flush, contact);
    }
    if (!(contact->gap <= height)) return 0;
    int count = 0;
    if (imp_pair_can_lie(world, pair)) {
        const qvec3 shift1 = imp_shape_offset(b1, s1), shift2 = imp_shape_offset(b2, s2);
        const impact_solid solid1 = imp_solid_of(b1, s1), solid2 = imp_solid_of(b2, s2);
        impact_contact shape = *contact;
        shape.offset1 = qvec3_sub(contact->offset1, shift1), shape.offset2 = qvec3_sub(contact->offset2, shift2);
        impact_patch patch;
        /* Of each body all that lies no higher than the lowest point and this: its part of `height` over the other.
         * What lies higher than a ball within it may be of another face than the lowest, as the top of a thin plate:
         * the patch is of one. */
        const double most = fmin(height - contact->gap, fmin(b1->inner, b2->inner));
        const impact_status found = impact_patch_find(&solid1, &solid2, &shape, most, &patch);
        for (int i = 0; found == IMPACT_OK && i < patch.count; i++)
            points[count++] = point_of(&patch, i, shift1, shift2);
        if (found == IMPACT_OK && patch.disc > 0) imp_points_turn_rim(world, pair, states, points, count);
        count = keep_near(points, count, height);
    }
    if (count == 0 && imp_world_inside_bounds(world, pair, states, contact) >= 0)
        points[count++] = (imp_point){.contact = *contact, .feature = {{IMPACT_SMOOTH, -1}, {IMPACT_SMOOTH, -1}}};
    return count;
}
