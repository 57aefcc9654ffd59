/* SPDX-License-Identifier: MIT
 *
 * flat (internal): points, segments and convex polygons in a plane, counter-clockwise.
 */
#ifndef IMP_FLAT_H
#define IMP_FLAT_H

#include <impact/hull.h>

enum { IMP_FLAT_CORNERS = 2 * IMPACT_HULL_POINTS };

typedef struct imp_flat {
    int count;
    double p[IMP_FLAT_CORNERS][2];
    short from[IMP_FLAT_CORNERS]; /* what a corner is: the caller's number; -1 where two borders cross */
} imp_flat;

/* The corners that there are. */
void imp_flat_copy(imp_flat *to, const imp_flat *from);

/* The convex hull of the corners, in place, those within slack of a side left out. */
void imp_flat_hull(imp_flat *flat, double slack);

/* What of one lies in the other (a point, segment or polygon), or by no more than slack outside. Corners of the other
 * that lie in it get the number from + offset. */
void imp_flat_clip(imp_flat *one, const imp_flat *other, double slack, int offset);

/* Leaves out the corners that cost least area until so many are left; of those that cost the same, as all of a disc do,
 * that of the lowest number: what is left turns with its body. */
void imp_flat_thin(imp_flat *flat, int most);

#endif
