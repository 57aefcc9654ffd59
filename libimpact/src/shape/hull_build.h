/* SPDX-License-Identifier: MIT
 *
 * hull_build (internal): the hull of points as triangles, and those as faces.
 */
#ifndef IMP_HULL_BUILD_H
#define IMP_HULL_BUILD_H

#include "shape/core.h"

enum {
    IMP_HULL_TRIANGLES = 2 * IMPACT_HULL_POINTS - 4,
    IMP_HULL_EDGES = 3 * IMPACT_HULL_POINTS - 6,
    IMP_HULL_CORNERS = 2 * IMP_HULL_EDGES
};

/* What a hull is made in. */
typedef struct imp_hull_work {
    int count;
    double point[IMPACT_HULL_POINTS][3]; /* of size 1, about their middle */
    double flat;                         /* IMP_HULL_FLAT of the farthest one's distance */
    int triangles;
    short triangle[4 * IMPACT_HULL_POINTS][3];          /* counter-clockwise; [0] < 0: none */
    short left[IMPACT_HULL_POINTS][IMPACT_HULL_POINTS]; /* triangle to the left of i -> j, or -1 */
    short group[4 * IMPACT_HULL_POINTS];                /* the face a triangle is of */
    double normal[IMP_HULL_TRIANGLES][3];               /* of faces */
    short start[IMP_HULL_TRIANGLES + 1], loop[IMP_HULL_CORNERS];
    int faces;
} imp_hull_work;

/* The triangles of the hull; false when the points lie in a plane but for IMP_HULL_FLAT of their size: *thickness is
 * their greatest distance from it. */
bool imp_hull_triangles(imp_hull_work *work, double *thickness);

/* Triangles in one plane, but for IMP_HULL_FLAT, become one face: normals, start and loop. */
void imp_hull_faces(imp_hull_work *work);

#endif
