/* SPDX-License-Identifier: MIT
 *
 * core (internal): polyhedra as tables, and the bodies that are a stretched one of them: a point, a segment, a box, an
 * octahedron, a hull. A support function is a maximum over vertices; a normal cone is spanned by a vertex's faces.
 */
#ifndef IMP_CORE_H
#define IMP_CORE_H

#include <impact/hull.h>
#include <stdatomic.h>

typedef struct imp_hull_edge {
    short v[2], f[2]; /* from v[0] to v[1] with the face f[0] on its left, f[1] on its right; -1: no face */
} imp_hull_edge;

struct impact_hull {
    int vertex_count, edge_count, face_count, dropped;
    const double (*vertex)[3], (*normal)[3]; /* of faces: outward, unit */
    const imp_hull_edge *edge;
    const short *start, *loop; /* face f: vertices loop[start[f]] to loop[start[f + 1] - 1], counter-clockwise */
    /* Of hulls made from points: */
    double rounding, volume, radius;
    double extent[3]; /* largest |x|, |y|, |z| of the vertices */
    qvec3 inertia, center;
    quat axes;
    impact_allocator allocator;
    size_t bytes;
    atomic_int holders;
};

extern const impact_hull imp_hull_point, imp_hull_segment, imp_hull_box, imp_hull_octahedron;

/* The hull's vertices times axis, by coordinate. */
typedef struct imp_core {
    const impact_hull *hull;
    double axis[3];
    bool even; /* all of axis are one: the hull's normals are the core's */
} imp_core;

/* Largest d.x and the vertex that has it. */
double imp_core_support(const imp_core *core, const double d[3], int *vertex);

void imp_core_vertex(const imp_core *core, int i, double x[3]);
void imp_core_normal(const imp_core *core, int face, double n[3]); /* unit */

/* Largest n.x over the core but for rounding, for the unit normal n of a face: that of its corners. */
double imp_core_height(const imp_core *core, int face, const double n[3]);

/* What of the core lies within slack of the supporting plane across d: the number of vertices, listed; and their mean.
 */
int imp_core_reached(const imp_core *core, const double d[3], double slack, short *vertex, double mean[3]);

/* The sign of (b - a) x (c - a) . (d - a), exactly, for coordinates of at most 1e100 and none below 1e-90 but 0. */
int imp_orientation(const double a[3], const double b[3], const double c[3], const double d[3]);

/* Volume, centroid and second moments of the polyhedron, and of it with a ball of radius r about each point: into
 * moments[0] the volume, then x, y, z, then xx, yy, zz, xy, yz, zx, each an integral over the body. */
void imp_hull_moments(const impact_hull *hull, double r, double moments[10]);

#endif
