/* SPDX-License-Identifier: MIT
 *
 * corner: what of a body's core stands on a plane, or on a face of a static body, alone: a contact whose place follows
 * from the orientation: a corner, or the lowest place of a rim. With c it in the body's axes, rho the rounding, n the
 * plane's normal and y a point of the plane
 *
 *     gap = n . (x + R c - y) - rho,     contact point from the centre  r = R c - rho n,     r' = w x R c + R c'
 *
 * c stays of a corner. Of a rim of radius a about z, with u = R^T n the normal as the body sees it, u' = u x w:
 * c = -a (u_x, u_y)/|(u_x, u_y)| + z.  Internal.
 */
#ifndef IMP_CORNER_H
#define IMP_CORNER_H

#include <impact/face.h>
#include "world/world.h"

/* How many corners and rims the body has; 0 of what is smooth, and of planes. A capsule has two corners, a cylinder two
 * rims, a cone its rim and then its top, a sphere its centre, rounded by its radius; superquadrics with edges as
 * shape/ridge.h has them. */
int imp_corner_count(const imp_body *body);

/* The feature's number among them, from 1; 0: it is none. */
int imp_corner_number(const imp_body *body, impact_feature feature);

/* The number; or that of the corner that is the lowest next, where an edge of a superquadric ends in an apex, and both
 * are as low as gaps can tell: what gives way at once is not held. */
int imp_corner_ahead(const imp_world *world, const imp_pair *pair, const imp_state *states, int corner);

/* How many faces the body has on which a corner may be held; 0 where it is not static, or none of a box or polyhedron;
 * a plane is not one of them. */
int imp_corner_faces(const imp_body *body);

/* The face of the body, from 1, within whose border a sphere touches it at the contact, whose normal is the face's to
 * `within` rad; 0: none on which it is held. */
int imp_corner_face_under(const imp_body *body, const imp_state *state, const impact_contact *contact, double within);

/* Whether the corner of that number, or for 0 any, of the pair's body 1 is held on its body 2. */
bool imp_corner_is_held(const imp_world *world, const imp_pair *pair, int corner);

/* Of a pair with a corner (imp_site.corner) on its plane, or on body 2's face (imp_site.face). *rate: how the contact
 * point moves from body 1's centre, m/s; NULL: that is not asked for. */
impact_contact imp_corner_contact(const imp_world *world, const imp_pair *pair, const imp_state *states, qvec3 *rate);

/* From the lowest place of the pair's rim to its far side, m; 0 of a corner. */
qvec3 imp_corner_across(const imp_world *world, const imp_pair *pair, const imp_state *states);

/* Where the pair's rim stands, unit, body 1's shape's axes; 0 of a corner. */
qvec3 imp_corner_side(const imp_world *world, const imp_pair *pair, const imp_state *states);

/* m: how high over the plane the lowest is of what may land yet: body 1's corners and rims but those that are held,
 * and, where the pair's own is a rim, its side across from imp_site.side: below it once the rim has passed flat, and
 * its lowest place has changed over; or, where that is less, how far the pair's corner is within its face's border.
 * The pair is held. Infinite: nothing is left to land. */
double imp_corner_clearance(const imp_world *world, const imp_pair *pair, const imp_state *states);
/* m: how high the lowest of them all is: < 0 beside the border of a face. */
double imp_corner_lowest(const imp_world *world, const imp_pair *pair, const imp_state *states);

/* Whether both are pairs of the same two bodies. */
static inline bool imp_same_bodies(const imp_pair *a, const imp_pair *b)
{
    return a->body1 == b->body1 && a->body2 == b->body2;
}

#endif
