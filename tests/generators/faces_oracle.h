/* SPDX-License-Identifier: MIT
 *
 * faces_oracle: gaps of polytopes with balls (spheres, capsules, boxes, octahedra, polyhedra) in 113-bit arithmetic,
 * from the solids alone, by all of their features: apart, the least distance of a vertex from a vertex, edge or face
 * and of an edge from an edge; overlapping, the largest g(n) over all faces' normals and all crosses of edges.
 */
#ifndef FACES_ORACLE_H
#define FACES_ORACLE_H

#include <impact/gap.h>

/* Gap in m, rounded once. */
double faces_oracle_gap(const impact_solid *body1, const impact_solid *body2);

/* How far the contact's gap, its g(n), and its witness points (|v| or n.v) are from the gap given, over L + |c|: the
 * worst of them. */
double faces_oracle_error(const impact_solid *body1, const impact_solid *body2, const impact_contact *contact,
                          double gap);

#endif
