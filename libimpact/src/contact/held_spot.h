/* SPDX-License-Identifier: MIT
 *
 * held_spot: where a held contact stands on a surface that is flat or sharp along an axis, in coordinates that move
 * gently. Internal.
 *
 * A superquadric's contact point is no smooth function of its orientation where an exponent p is over 2: with
 * e = |u|^(p-1) sgn u, u = x/a, it is e that follows the normal, and u = |e|^(1/(p-1)) sgn e. So the spot is not solved
 * from the orientation but integrated along, as s = u + e on each axis: both u and e are functions of s of slope at
 * most 1. A superellipsoid of two exponents, K^t + |u_z|^t = 1 with K^r = |u_x|^r + |u_y|^r, has e = K^(t-r) |u|^(r-1)
 * sgn u along x and y: the gradient of K^t/t, so that s = u + e is that of a convex function still. Of p = 1 e is any
 * of -1 ... 1 on the edge u = 0, and sgn u beside it.
 */
#ifndef IMP_HELD_SPOT_H
#define IMP_HELD_SPOT_H

#include "world/world.h"

typedef struct imp_spot {
    double u[3], e[3];
    double slope[3];   /* de/du = (p-1) |u|^(p-2); never 0. Along a section x, y of its own: of v = u/K, on K = 1 */
    double section[2]; /* such a section's v, */
    double k_ratio;    /* and K^(t-2), never 0; else 1 */
    qvec3 point;       /* on the surface, from the centre, m, body axes */
    qvec3 normal;      /* outward unit, body axes */
} imp_spot;

/* How the spot moves as the body's normal at the contact turns. */
typedef struct imp_spot_rate {
    double s[3];
    double point_speed; /* |u'|, 1/s: grows without bound towards a flat point */
    qvec3 point_rate;   /* m/s, body axes */
} imp_spot_rate;

/* Whether the pair's contact is integrated along while it is held: a superquadric or superellipsoid with an exponent
 * other than 2, on a plane, but those whose edges are contacts of their own (shape/ridge.h). */
bool imp_spot_suits(const imp_world *world, const imp_pair *pair);

/* The spot of the outward normal given, body axes. */
void imp_spot_find(const impact_shape *shape, qvec3 normal, double s[3]);

/* The spot at a point of the surface, or near it, body axes, m. */
void imp_spot_on(const impact_shape *shape, qvec3 point, double s[3]);

/* s need not be quite on the surface. */
imp_spot imp_spot_at(const impact_shape *shape, const double s[3]);

imp_spot_rate imp_spot_move(const impact_shape *shape, const imp_spot *spot, qvec3 normal_rate);

#endif
