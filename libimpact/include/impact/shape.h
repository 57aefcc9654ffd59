/* SPDX-License-Identifier: MIT
 *
 * shape: convex bodies in their own frame, centred on the origin, axes along x, y, z. SI units.
 */
#ifndef IMPACT_SHAPE_H
#define IMPACT_SHAPE_H

#include <quat/quat.h>
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum impact_shape_kind {
    IMPACT_SPHERE,         /* |x| <= a */
    IMPACT_PLANE,          /* the half-space z <= 0; outward normal +z; static only */
    IMPACT_SUPERQUADRIC,   /* |x/a|^r + |y/b|^s + |z/c|^t <= 1, r, s, t >= 1 */
    IMPACT_SUPERELLIPSOID  /* (|x/a|^r + |y/b|^r)^(t/r) + |z/c|^t <= 1, s = r; Barr: r = 2/eps2, t = 2/eps1 */
} impact_shape_kind;

/* A plain value; make it with the functions below, which check what they are given. */
typedef struct impact_shape {
    impact_shape_kind kind;
    double a, b, c; /* semi-axes, m; sphere: all the radius; plane: half-extents of its bounds along x and y (infinite: none), c = 0 */
    double r, s, t; /* exponents; 2 where the kind has none */
} impact_shape;

/* Each returns IMPACT_OK, or IMPACT_EARGUMENT / IMPACT_EDOMAIN and leaves *shape untouched. */
IMPACT_API impact_status impact_shape_sphere(double radius, impact_shape *shape);
IMPACT_API impact_status impact_shape_plane(double half_x, double half_y, impact_shape *shape);

/* Volume in m^3; infinite for a plane. */
IMPACT_API double impact_shape_volume(const impact_shape *shape);

/* Principal moments of inertia per unit mass, m^2, about the centre, along the body axes; infinite for a plane. */
IMPACT_API qvec3 impact_shape_inertia(const impact_shape *shape);

/* Radius of the smallest ball about the centre that holds the shape; infinite for a plane. */
IMPACT_API double impact_shape_bounding_radius(const impact_shape *shape);

#ifdef __cplusplus
}
#endif

#endif
