/* SPDX-License-Identifier: MIT
 *
 * ridge: the edges and apexes of superquadrics whose surface holds straight lines from one edge to another. Supports
 * jump from edge to edge as the body tips over a line, so that each edge is a contact of its own, as a cylinder's rims
 * are. With z along the curved axis, zeta = |z/c|:
 *
 *   arcs     exponents 1, 1, t:    |x/a| + |y/b| <= g(zeta),  g = 1 - zeta^t
 *            hull of the arcs (-+a g, 0, z), (0, -+b g, z), features 0 to 3, which meet in the apexes z = -c, +c,
 * features 4 and 5: sharp ones, in which an arc's place stays once d is steeper than its end. A superellipsoid whose
 *            section has exponent 1: g = (1 - zeta^t)^(1/t), its ends are smooth, and no features
 *   bicone   superellipsoid with t = 1:  (|x/a|^r + |y/b|^r)^(1/r) + |z/c| <= 1
 *            hull of its rim in z = 0, feature 0, and the apexes z = -c, +c: features 1 and 2
 *
 * Internal.
 */
#ifndef IMP_RIDGE_H
#define IMP_RIDGE_H

#include "shape/support.h"

/* How many such features the shape has: 6, 4, 3, or 0 where it has none. An octahedron is a polyhedron. */
int imp_ridge_count(const impact_shape *shape);

/* An apex, that is, and no curve. */
bool imp_ridge_is_apex(const imp_form *form, int feature);
/* The two, or the one twice, that may be farthest along d: one of them reaches as far as the body. */
void imp_ridge_facing(const imp_form *form, qvec3 d, int feature[2]);
/* m: how far the feature is from giving way to another in a sharp apex: an arc that comes to its end, the apex where an
 * arc's place leaves it; 0 there, < 0 beyond. INFINITY where there is no such end. */
double imp_ridge_room(const imp_form *form, int feature, qvec3 d);
/* The feature; or the one that it gives way to, where its room is `within` (m) at most and falls as d turns. */
int imp_ridge_ahead(const imp_form *form, int feature, qvec3 d, qvec3 d_rate, double within);

/* An arc ends in its apex; that of a stretch of motion that an event ends there goes on for a while, smoothly: zeta. */
#define IMP_RIDGE_END 1.0
#define IMP_RIDGE_BEYOND 2.0

/* Where the feature reaches farthest along d, body axes, m; an arc that looks away from d does so at an apex. */
qvec3 imp_ridge_place(const imp_form *form, int feature, qvec3 d, double end);
/* How that place moves as d does, m/s. */
qvec3 imp_ridge_rate(const imp_form *form, int feature, qvec3 d, qvec3 d_rate, double end);

#endif
