/* SPDX-License-Identifier: MIT
 *
 * solid (internal): the bodies that are a core and a ball: moments, distances. A cylinder, cone or capsule is a profile
 * in (rho, z) turned about z.
 */
#ifndef IMP_SOLID_H
#define IMP_SOLID_H

#include <impact/shape.h>
#include "shape/support.h"

static inline bool imp_has_core(const impact_shape *shape) { return shape->kind >= IMPACT_BOX; }

/* |x/a| + |y/b| + |z/c| <= 1: a polyhedron, though it is given as a superquadric. */
static inline bool imp_is_octahedron(const impact_shape *shape)
{
    const bool quadric = shape->kind == IMPACT_SUPERQUADRIC || shape->kind == IMPACT_SUPERELLIPSOID;
    return quadric && shape->r == 1 && shape->s == 1 && shape->t == 1;
}

/* Half sides of a box's core; of a cylinder's its radius, radius and half height; of a cone's radius, radius and
 * height; of a capsule's 0, 0 and half its length; a hull's half-extents. */
void imp_core_axes(const impact_shape *shape, double axis[3]);

/* The hull whose stretched image the core is; of a superquadric that is an octahedron, and of spheres, theirs too. */
const impact_hull *imp_core_hull(const impact_shape *shape);

/* Volume and the principal moments of inertia per unit mass of a shape with a core. */
double imp_solid_volume(const impact_shape *shape);
qvec3 imp_solid_inertia(const impact_shape *shape);
double imp_solid_radius(const impact_shape *shape); /* of the ball about the centre that holds it */

/* Of a ball about the centre within the shape: of any shape that has faces, flat places or is round; of a superquadric
 * without flat places its least half axis; of a plane INFINITY. */
double imp_shape_inner_radius(const impact_shape *shape);

/* z of the base of a cone's core about the centroid of the whole. */
double imp_cone_base(double radius, double height, double rounding);

/* Signed distance of x (body axes) from the core: < 0 inside. */
double imp_core_distance(const imp_form *form, const double x[3]);

#endif
