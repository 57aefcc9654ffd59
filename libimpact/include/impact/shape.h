/* SPDX-License-Identifier: MIT
 *
 * shape: convex bodies in their own frame, centred on the origin, axes along x, y, z. SI units.
 */
#ifndef IMPACT_SHAPE_H
#define IMPACT_SHAPE_H

#include <stddef.h>
#include <quat/quat.h>
#include "hull.h"
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum impact_shape_kind {
    IMPACT_SPHERE,         /* |x| <= a */
    IMPACT_PLANE,          /* the half-space z <= 0; outward normal +z; static only */
    IMPACT_SUPERQUADRIC,   /* |x/a|^r + |y/b|^s + |z/c|^t <= 1, r, s, t >= 1 */
    IMPACT_SUPERELLIPSOID, /* (|x/a|^r + |y/b|^r)^(t/r) + |z/c|^t <= 1, s = r; Barr: r = 2/eps2, t = 2/eps1 */
    /* A core and a ball of the radius `rounding` about each of its points: */
    IMPACT_BOX,       /* |x| <= a, |y| <= b, |z| <= c, edges and corners rounded inside of that */
    IMPACT_CYLINDER,  /* x^2 + y^2 <= a^2, |z| <= c, its rims rounded inside of that */
    IMPACT_CONE,      /* radius a at its base, height c along +z, rounded inside of that; z = 0 is its centroid */
    IMPACT_CAPSULE,   /* the segment |z| <= c - a and a ball of radius a = rounding */
    IMPACT_POLYHEDRON /* a hull and a ball */
} impact_shape_kind;

enum { IMPACT_SHAPE_KINDS = IMPACT_POLYHEDRON + 1 };

/* A plain value; make it with the functions below, which check what they are given. */
typedef struct impact_shape {
    impact_shape_kind kind;
    double a, b, c;  /* semi-axes, m; sphere: all the radius; plane: half-extents of its bounds along x and y (infinite:
                        none), c = 0; with a core: half-extents of the whole (a cone's c: its height) */
    double r, s, t;  /* exponents; 2 where the kind has none, infinite where it is flat */
    double rounding; /* m; 0: sharp, and of kinds that have none */
    double base;     /* cone: z of its core's base, m; else 0 */
    const impact_hull *hull; /* polyhedron: borrowed, it must outlive every use of the shape; else NULL */
} impact_shape;

/* Each returns IMPACT_OK; IMPACT_EDOMAIN for a NaN or infinity, IMPACT_EARGUMENT for an axis <= 0, an exponent < 1
 * (not convex) or a rounding < 0 or too large; on failure *shape is untouched. impact_shape_check puts the reason into
 * words. */
IMPACT_API impact_status impact_shape_sphere(double radius, impact_shape *shape);
IMPACT_API impact_status impact_shape_plane(double half_x, double half_y, impact_shape *shape);
IMPACT_API impact_status impact_shape_ellipsoid(double a, double b, double c, impact_shape *shape);
/* Semi-axes a, b, c in m; exponents r, s, t in [1, 1e6]. */
IMPACT_API impact_status impact_shape_superquadric(double a, double b, double c, double r, double s, double t,
                                                   impact_shape *shape);
/* Barr's superellipsoid: eps1 shapes the profile along z, eps2 the section across it; both in (0, 2], 1 for an
 * ellipsoid. */
IMPACT_API impact_status impact_shape_superellipsoid(double a, double b, double c, double eps1, double eps2,
                                                     impact_shape *shape);

/* Half sides a, b, c in m of the whole box; 0 <= rounding < each of them. */
IMPACT_API impact_status impact_shape_box(double a, double b, double c, double rounding, impact_shape *shape);
/* Of the whole: radius, and half the height along z, m; 0 <= rounding < either. */
IMPACT_API impact_status impact_shape_cylinder(double radius, double half_height, double rounding, impact_shape *shape);
/* Of the whole: radius of the base, and height along +z, m; 0 <= rounding < radius and < height/2. The core is a cone
 * of radius `radius - rounding` and height `height - 2 rounding`. */
IMPACT_API impact_status impact_shape_cone(double radius, double height, double rounding, impact_shape *shape);
/* A segment of half the length half_height along z, m, and all within radius of it. */
IMPACT_API impact_status impact_shape_capsule(double radius, double half_height, impact_shape *shape);
/* The hull in the frame of its centroid and principal axes, with its rounding (see hull.h); IMPACT_EARGUMENT for NULL.
 * The shape borrows the hull. */
IMPACT_API impact_status impact_shape_polyhedron(const impact_hull *hull, impact_shape *shape);

/* The status the constructors would give these numbers. When it is negative and message is not NULL, up to size bytes
 * of a sentence naming the number, such as "exponent r = 0.5 < 1 is not convex", are written; "" when the shape is
 * good. */
IMPACT_API impact_status impact_shape_check(const impact_shape *shape, char *message, size_t size);

/* Volume in m^3; infinite for a plane. */
IMPACT_API double impact_shape_volume(const impact_shape *shape);

/* Principal moments of inertia per unit mass, m^2, about the centre, along the body axes; infinite for a plane. */
IMPACT_API qvec3 impact_shape_inertia(const impact_shape *shape);

/* Radius of the smallest ball about the centre that holds the shape; infinite for a plane. */
IMPACT_API double impact_shape_bounding_radius(const impact_shape *shape);

/* Support function h = max direction . x over the shape, and where it is reached (*point may be NULL). direction: body
 * frame, finite, of any length but 0 (h scales with it). Where a whole edge or face answers, one of its points is
 * given. Planes: h is infinite and *point NaN unless direction is along +z. */
IMPACT_API double impact_shape_support(const impact_shape *shape, qvec3 direction, qvec3 *point);

/* Hessian of h at a unit direction, m: symmetric, positive semidefinite, its null vector the direction; its other
 * eigenvalues are the surface's principal radii of curvature there. Infinite or NaN entries where the surface is flat;
 * zero at a vertex. */
IMPACT_API qmat3 impact_shape_support_hessian(const impact_shape *shape, qvec3 direction);

/* Surface point at the angles u in [-pi, pi), v in [-pi/2, pi/2] (Barr 1981; thesis appendix B). Sphere: an ordinary
 * globe. Plane: (u, v, 0) in m, within its bounds. Kinds with a core: where the normal is the globe's, the middle of
 * what has it. */
IMPACT_API qvec3 impact_shape_point(const impact_shape *shape, double u, double v);

/* Outward unit normal of the surface at (u, v). On edges and vertices: one of the normals. */
IMPACT_API qvec3 impact_shape_normal(const impact_shape *shape, double u, double v);

/* Below 1 inside, 1 on the surface, above 1 outside: the shape's left-hand side at x (body frame). Plane: 1 + z. Kinds
 * with a core: 1 + the distance outside over the largest of a, b, c; inside, by the nearest of the core's faces. */
IMPACT_API double impact_shape_inside(const impact_shape *shape, qvec3 x);

/* Principal curvatures (1/m, >= 0, k1 >= k2) at the surface point whose outward normal is along direction. 0 where
 * flat, infinite on edges and vertices. */
IMPACT_API void impact_shape_curvatures(const impact_shape *shape, qvec3 direction, double *k1, double *k2);

/* Points (and outward normals when not NULL) of the grid u_i = -pi + 2 pi i/nu (i < nu), v_j = -pi/2 + pi j/nv (j <=
 * nv); element j nu + i. IMPACT_EARGUMENT for nu < 3 or nv < 2. */
IMPACT_API impact_status impact_shape_mesh(const impact_shape *shape, int nu, int nv, qvec3 *points, qvec3 *normals);

#ifdef __cplusplus
}
#endif

#endif
