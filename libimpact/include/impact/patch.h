/* SPDX-License-Identifier: MIT
 *
 * patch: where two bodies lie on each other: a point, a segment or a convex polygon with one normal.
 */
#ifndef IMPACT_PATCH_H
#define IMPACT_PATCH_H

#include <quat/quat.h>
#include "face.h"
#include "gap.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { IMPACT_PATCH_POINTS = 16 };

typedef struct impact_patch_point {
    qvec3 offset1, offset2;            /* of the two faces, from the centres, world, m */
    qvec3 normal;                      /* unit, world: the patch's, but where lines of round sides cross */
    double height;                     /* of face 1 over face 2 here, along the normal, m */
    impact_feature feature1, feature2; /* what of each body is here */
    bool closed;                       /* height <= the height asked for */
} impact_patch_point;

typedef struct impact_patch {
    int dimension;              /* of the closed points: -1 none, 0 a point, 1 a segment, 2 a polygon or disc */
    int dimension1, dimension2; /* of the face that each body has there, as impact_face.dimension */
    int count;
    qvec3 normal; /* unit, world, from body 2 to body 1 */
    int thinned;  /* extreme points left out beyond 16: those that cost the least area */
    double disc;  /* m; > 0: the polygon is a whole disc of this radius, its points on the rim */
    impact_patch_point point[IMPACT_PATCH_POINTS]; /* counter-clockwise about the normal */
} impact_patch;

/* The patch at a contact that impact_gap gave of the two solids: the faces of both towards each other (see
 * impact_shape_face, with height in m >= 0), clipped against one another along the normal. Its points are the extreme
 * ones: corners of one over the other, and crossings of borders; between planes the height is affine, so that they tell
 * all of it. Lines of round sides that all but lie on each other, d apart at an end of what they share, are apart there
 * by d^2/2R, R the sum of their radii across: where that is no more than the height at both ends, these are the patch.
 * Where a body has but a point there, or the faces are beside each other, the patch is the contact's witness
 * points. IMPACT_EARGUMENT: height < 0; IMPACT_EDOMAIN: a height, normal or gap that is not finite; else IMPACT_OK. */
IMPACT_API impact_status impact_patch_find(const impact_solid *body1, const impact_solid *body2,
                                           const impact_contact *contact, double height, impact_patch *patch);

#ifdef __cplusplus
}
#endif

#endif
