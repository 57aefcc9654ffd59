/* SPDX-License-Identifier: MIT
 *
 * gap_walk (internal): charts of bodies with vertices, edges and faces, for Newton's steps. On each feature point and
 * normal have two ways to go between them:
 *
 *     vertex, apex    the normal, two
 *     edge            the point along it, the normal about it
 *     face, cap       the point, two
 *     side            the point along the line; point and normal around
 *     rim             point and normal around; the normal across
 *
 * A step that leads off the feature ends at its border, on the feature beyond: so the feature that has the witness
 * point is walked to, as in Lin & Canny 1991.
 */
#ifndef IMP_GAP_WALK_H
#define IMP_GAP_WALK_H

#include "shape/support.h"

typedef enum imp_walk_kind {
    IMP_ON_VERTEX, /* of a polytope; a cone's apex */
    IMP_ON_EDGE,
    IMP_ON_FACE, /* of a polytope */
    IMP_ON_CAP,
    IMP_ON_SIDE,
    IMP_ON_RIM
} imp_walk_kind;

/* All in body axes; the steps of points are in sizes of the body. */
void imp_walk_start(const imp_form *form, const double d[3], const double *x, imp_surface *s);
void imp_walk_chart(const imp_form *form, const imp_surface *s, double P[2][3], double Q[2][3]);
/* On that feature: at the point x of it, its normal m. */
void imp_walk_put(const imp_form *form, imp_walk_kind kind, int index, const double x[3], const double m[3],
                  imp_surface *s);
void imp_walk_move(const imp_form *form, const double step[2], imp_surface *s);

/* Radius of a ball in the body that touches the surface at the point x: 0 on edges, rims and vertices, and of cones. */
double imp_walk_inner_radius(const imp_form *form, const double x[3]);

#endif
