/* SPDX-License-Identifier: MIT
 *
 * gap_core (internal): the gap of two polytopes (points, segments, boxes, octahedra, hulls), in A's axes and with one
 * relative rotation that is rounded once: the answer is that of bodies moved by a rounding, and consistent in itself.
 * As in gap_solver.h body A is the public body 2, and for every unit n
 *
 *     g(n) = n.c - h_A(n) - h_B(-n)
 *
 * is a lower bound of the gap. Overlapping, its maximum is at a facet of c + B - A: a normal of a face of A or B, or a
 * cross of two edges. Apart, it is the distance, between two features.
 */
#ifndef IMP_GAP_CORE_H
#define IMP_GAP_CORE_H

#include "gap/gap_solver.h"

typedef struct imp_core_pair {
    imp_core core[2];
    bool box[2];
    double R[3][3]; /* B to A */
    double c[3];    /* centre of B minus centre of A, A's axes */
    double reach;   /* size + |c| */
} imp_core_pair;

/* An answer in A's axes; x relative to the centres. */
typedef struct imp_core_gap {
    double gap, lower, upper, n[3], x[2][3];
    bool firm; /* the features fix the normal */
} imp_core_gap;

/* A pair of vertices: the point c + b - a of the difference. */
typedef struct imp_core_tip {
    double w[3];
    int vertex[2];
} imp_core_tip;

/* g(n), n of any length, times that; tip: where. */
double imp_core_height_between(const imp_core_pair *pair, const double n[3], imp_core_tip *tip);

/* Vertices, directions of edges and outward normals of faces of either body, A's axes; B's relative to its own centre.
 */
void imp_core_place(const imp_core_pair *pair, int body, int vertex, double x[3]);
void imp_core_edge(const imp_core_pair *pair, int body, int edge, double e[3]);
void imp_core_face(const imp_core_pair *pair, int body, int face, double n[3]);

/* a x b, each component right to two roundings of itself (Kahan's ab - cd). */
void imp_core_cross(const double a[3], const double b[3], double c[3]);

/* Of two boxes an axis, away from A, and its g: 0 to 2 of A's faces, 3 to 5 of B's, then the crosses of A's first edge
 * with B's three, of its second, its third; -infinity: they are parallel. */
enum { IMP_CORE_BOX_AXES = 15 };
double imp_core_box_axis(const imp_core_pair *pair, int axis, double n[3]);
/* The best of all faces' normals and crosses of edges, and its g: of two boxes; of any two, one of which has faces. */
double imp_core_box_axes(const imp_core_pair *pair, double n[3], int *axis);
double imp_core_axes_of_all(const imp_core_pair *pair, double n[3]);
/* The best cross of edges alone. */
double imp_core_edge_axis(const imp_core_pair *pair, double n[3]);

/* The answer at such an axis of a box's face, when the vertex of the other that reaches it is over the face: then the
 * distance is g, in either sign. */
bool imp_core_box_face(const imp_core_pair *pair, int axis, imp_core_gap *answer);
/* The same at the axis of two edges that cross, not all but parallel, when their nearest points are on both. */
bool imp_core_box_edges(const imp_core_pair *pair, int axis, imp_core_gap *answer);

/* The point of c + B - A nearest to 0, from the direction n, with a normal made of the features met: false when 0 is
 * seen inside, or so near that no direction is left. *answer: upper, x and, when better than *lower's, lower and n. */
bool imp_core_nearest(const imp_core_pair *pair, imp_core_gap *answer);

/* The same by all pairs of an edge with an edge and of a vertex with a face. */
void imp_core_enumerate(const imp_core_pair *pair, imp_core_gap *answer);

/* Witness points of an overlap, gap n apart: in the middle of where the features along n lie on each other, of which
 * all is that reaches as far but for the slack (of the pair's reach); false: nowhere. */
bool imp_core_witness(const imp_core_pair *pair, double slack, imp_core_gap *answer);

/* All of it, from a direction to begin with (NULL: none). */
impact_status imp_core_solve(const imp_core_pair *pair, const double *cached, imp_core_gap *answer);

/* Whether two shapes are such (a sphere only beside a shape with a core); and their contact. */
bool imp_core_takes(const impact_shape *one, const impact_shape *other);
impact_status imp_core_contact(const impact_solid *body1, quat q1, const impact_solid *body2, quat q2, double scale,
                               impact_gap_cache *cache, impact_contact *contact);

#endif
