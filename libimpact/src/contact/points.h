/* SPDX-License-Identifier: MIT
 *
 * points: the places at which two bodies touch: the extreme points of their patch, where faces or edges lie on each
 * other, else the one point of their gap. Internal.
 */
#ifndef IMP_POINTS_H
#define IMP_POINTS_H

#include <impact/patch.h>
#include "world/world.h"

typedef struct imp_point {
    impact_contact contact;    /* the gap here; offsets from the bodies' centres of mass */
    impact_feature feature[2]; /* of body 1 and body 2: what tells the point from the pair's others */
    imp_bearer bearer;
} imp_point;

enum { IMP_POINTS = IMPACT_PATCH_POINTS };

/* The points of a whole disc on a face, a sixteenth of its rim apart, go round it until the first is where the rim is
 * lowest, or is about to be: what sixteen points do hangs on where they are, by up to 2 % of the radius, and where the
 * scene, or the body about its axis, is turned they are to be the same. */
void imp_points_turn_rim(const imp_world *world, const imp_pair *pair, const imp_state *states, imp_point *points,
                         int count);

/* The body has faces, edges and corners. */
bool imp_has_faces(const imp_body *body);
/* Either body of the pair has. */
bool imp_pair_has_faces(const imp_world *world, const imp_pair *pair);
/* More than a point of either can lie on the other: faces, or flat places of superquadrics. */
bool imp_pair_can_lie(const imp_world *world, const imp_pair *pair);

/* The pair's points that lie at most `height` (m) apart along the normal, within the bounds of a plane, in points (room
 * for IMP_POINTS); how many. Where neither body is flat and across bounds there is the one, or none. flush (m): how far
 * below a face a body may be and still be on it, not beside (world/normal.h). *contact: whose normal it is; its own
 * place is none of the points where another of the same faces is deeper, or they are cut elsewhere. */
int imp_points_find(imp_world *world, imp_pair *pair, const imp_state *states, double height, double flush,
                    impact_contact *contact, imp_point *points);

#endif
