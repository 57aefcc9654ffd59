/* SPDX-License-Identifier: MIT
 *
 * support (internal): bodies prepared for the gap's solvers, and points of their surfaces with normals.
 *
 * A surface point is kept as pairs (u, e = |u|^(p-1) sgn u), one per axis: u is gentle on faces, e on edges, and
 * together they hold the point, x_i = A_i u_i, and its normal, N_i ~ p_i e_i / A_i. A superellipsoid has a fourth pair,
 * the radius k of its section: x = a k u_0, y = b k u_1 with u_0^r + u_1^r = 1, k^t + u_2^t = 1.
 */
#ifndef IMP_SUPPORT_H
#define IMP_SUPPORT_H

#include <impact/shape.h>
#include "shape/core.h"

enum { IMP_AXES = 3, IMP_SECTION = 3 };

/* What a form's surface is made of. */
typedef enum imp_form_kind {
    IMP_FORM_QUADRIC, /* sphere, superquadric, superellipsoid */
    IMP_FORM_BOX,
    IMP_FORM_POLYTOPE, /* a hull, or a capsule's segment */
    IMP_FORM_CYLINDER,
    IMP_FORM_CONE
} imp_form_kind;

typedef struct imp_form {
    imp_form_kind kind;
    bool nested;           /* superellipsoid */
    bool round;            /* every exponent is 2 */
    bool uniform;          /* every exponent is p[0] */
    double axis[3];        /* of cores: imp_core_axes */
    double p[4];           /* p[IMP_SECTION] is t of a superellipsoid */
    double rotation[3][3]; /* body to world */
    double base;           /* of a cone */
    double rounding;       /* of a core: the ball's radius */
    imp_core core;         /* of boxes and polytopes */
} imp_form;

static inline bool imp_of_revolution(const imp_form *form)
{
    return form->kind == IMP_FORM_CYLINDER || form->kind == IMP_FORM_CONE;
}

/* Of a core: u is the core's point, e the unit normal; kind and index the feature it is on (gap_walk.h). */
typedef struct imp_surface {
    double u[4], e[4];
    short kind, index;
} imp_surface;

/* Semi-axes are multiplied by scale. Spheres are ellipsoids here; planes have no form. */
void imp_form_make(const impact_shape *shape, double scale, quat orientation, imp_form *form);

/* The same body with another orientation. */
void imp_form_turn(imp_form *form, quat orientation);

/* h(d) of a box of these half sides, and the middle of what reaches so far. */
double imp_box_support(const double axis[3], const double d[3], double x[3]);

/* h(d) for a non-zero d in the body's axes, and the surface point where it is reached. */
double imp_form_support(const imp_form *form, const double d[3], imp_surface *surface);

/* The same with d and x in world axes, x relative to the centre. */
double imp_form_support_world(const imp_form *form, const double d[3], double x[3], imp_surface *surface);

/* Position and (not normalised) outward normal of a surface point, body axes. */
void imp_surface_point(const imp_form *form, const imp_surface *surface, double x[3], double normal[3]);

/* Hessian of h at d (body axes) into H. */
void imp_form_hessian(const imp_form *form, const double d[3], double H[3][3]);

/* impact_shape_curvatures of what lies within the height, m, of the supporting plane across the direction: a face that
 * rounding has turned is flat. */
void imp_shape_curvatures(const impact_shape *shape, qvec3 direction, double height, double *k1, double *k2);

/* The left-hand side of the inequality of a quadric at x, body axes. */
double imp_form_inside(const imp_form *form, const double x[3]);

#endif
