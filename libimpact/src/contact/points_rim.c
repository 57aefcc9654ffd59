/* SPDX-License-Identifier: MIT
 *
 * A disc of centre c and normal m on another face: at a the heights are g + s.a, s across the normal n of the contact.
 * The rim is lowest at -s; of one that lies level it is about to be where s' = n x (omega1 - omega2) points away from;
 * of one that does not tip either, ahead of its slip, where friction brings it down.
 */
#include "contact/points.h"
#include "base/numbers.h"
#include "world/world_gap.h"

/* A rim on a face: from each body's centre of mass to the middle, and from there to two of its places. */
typedef struct rim {
    bool of_first; /* the disc is body 1's */
    qvec3 middle[2], x, y;
    double height, rise[2]; /* m: there, and how much higher both places are */
} rim;

static rim rim_of(const imp_point *points, int count)
{
    rim r = {.of_first = points[0].feature[0].kind == IMPACT_RIM};
    for (int i = 0; i < count; i++) {
        const impact_contact *c = &points[i].contact;
        r.middle[0] = qvec3_axpy(1.0 / count, c->offset1, r.middle[0]);
        r.middle[1] = qvec3_axpy(1.0 / count, c->offset2, r.middle[1]);
        r.height += c->gap / count;
    }
    const impact_contact *a = &points[0].contact, *b = &points[count / 4].contact;
    r.x = r.of_first ? qvec3_sub(a->offset1, r.middle[0]) : qvec3_sub(a->offset2, r.middle[1]);
    r.y = r.of_first ? qvec3_sub(b->offset1, r.middle[0]) : qvec3_sub(b->offset2, r.middle[1]);
    r.rise[0] = a->gap - r.height, r.rise[1] = b->gap - r.height;
    return r;
}

/* Where the rim is lowest, or about to be, from its middle; of no length where nothing tells. */
static qvec3 lowest_way(const imp_world *world, const imp_pair *pair, const imp_state *states, const rim *r, qvec3 n)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const qvec3 w2 = b2->is_static ? b2->spin : imp_omega(b2, s2), w = qvec3_sub(imp_omega(b1, s1), w2),
                tips = qvec3_cross(w, n);
    if (2 * hypot(r->rise[0], r->rise[1]) > imp_world_touching_distance(world, pair, states))
        return qvec3_neg(qvec3_add(qvec3_scale(r->x, r->rise[0]), qvec3_scale(r->y, r->rise[1])));
    if (2 * qvec3_norm(r->x) * qvec3_norm(tips) > world->slip_speed) return tips;
    const qvec3 u = qvec3_sub(imp_point_velocity(b1, s1, r->middle[0]), imp_point_velocity(b2, s2, r->middle[1]));
    return qvec3_scale(qvec3_axpy(-qvec3_dot(u, n), n, u), r->of_first ? 1 : -1);
}

static void put_place(const rim *r, qvec3 a, double rise, imp_point *point)
{
    impact_contact *c = &point->contact;
    c->gap = r->height + rise;
    const qvec3 other = qvec3_axpy(r->of_first ? -rise : rise, c->normal, a);
    c->offset1 = qvec3_add(r->middle[0], r->of_first ? a : other);
    c->offset2 = qvec3_add(r->middle[1], r->of_first ? other : a);
}

void imp_points_turn_rim(const imp_world *world, const imp_pair *pair, const imp_state *states, imp_point *points,
                         int count)
{
    const rim r = rim_of(points, count);
    const qvec3 way = lowest_way(world, pair, states, &r, points[0].contact.normal);
    const double x = qvec3_dot(way, r.x), y = qvec3_dot(way, r.y);
    if (!(hypot(x, y) > 0)) return;
    const double first = atan2(y, x);
    for (int i = 0; i < count; i++) {
        const double angle = first + 2 * IMP_PI * i / count, c = cos(angle), s = sin(angle);
        put_place(&r, qvec3_add(qvec3_scale(r.x, c), qvec3_scale(r.y, s)), c * r.rise[0] + s * r.rise[1], &points[i]);
    }
}
