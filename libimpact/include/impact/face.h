/* SPDX-License-Identifier: MIT
 *
 * face: what of a shape lies on a supporting plane.
 */
#ifndef IMPACT_FACE_H
#define IMPACT_FACE_H

#include "shape.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum impact_feature_kind {
    IMPACT_SMOOTH, /* a place of a curved surface */
    IMPACT_VERTEX,
    IMPACT_EDGE, /* of a polytope; the side line of a cylinder, cone or capsule; a superquadric's */
    IMPACT_RIM,  /* of a cylinder's or cone's cap */
    IMPACT_FACE  /* a flat, or a superquadric's flat place */
} impact_feature_kind;

/* Vertices, edges and faces by their number in the hull; a box's vertex has x, y, z > 0 for its bits 0, 1, 2, its faces
 * are -x, +x, -y, +y, -z, +z; -1 where there is no number. */
typedef struct impact_feature {
    impact_feature_kind kind;
    int index;
} impact_feature;

enum { IMPACT_FACE_POINTS = IMPACT_HULL_POINTS, IMPACT_FACE_RIM = 64 };

typedef struct impact_face {
    int dimension;                   /* 0 a point, 1 a segment, 2 a polygon or disc */
    int count;                       /* of corners; 0 of a plane without end on a side */
    double disc;                     /* m; > 0: a disc of this radius, its IMPACT_FACE_RIM points on the rim */
    impact_feature feature;          /* the face itself */
    qvec3 point[IMPACT_FACE_POINTS]; /* body frame, m; counter-clockwise about the direction */
    impact_feature corner[IMPACT_FACE_POINTS]; /* what each point is */
} impact_face;

/* All of the shape within height (m, >= 0) of its supporting plane across the direction (body frame, unit), as far as
 * it is flat: a vertex, edge or face, a side line, a cap; of superquadrics |x_i|^p_i <= p height/A, where the exponent
 * along the face is 3 or more, and the direction stands off its axis by no more than the height allows; of those with
 * two exponents of 1 (of superellipsoids with one of 1) a line from edge to edge. What is curved is
 * a point. Planes: along +z their bounds. The dimension; -1 for a height < 0, a direction that is not unit or
 * finite, or a plane seen from another side. */
IMPACT_API int impact_shape_face(const impact_shape *shape, qvec3 direction, double height, impact_face *face);

#ifdef __cplusplus
}
#endif

#endif
