/* SPDX-License-Identifier: MIT
 *
 * family: curves and surfaces given by formulas, with all the derivatives that curve.h and surface.h ask for.
 * Lengths in the caller's unit, angles in radians.
 *
 * Each function fills *family, which holds the numbers and must outlive the curve or surface made with it. Statuses:
 * QUAT_EDOMAIN for a length that is not positive and finite or another number that is not finite, QUAT_EARGUMENT for
 * bad counts; the curve or surface is then empty, and every function of it returns QUAT_EARGUMENT.
 */
#ifndef QUAT_FAMILY_H
#define QUAT_FAMILY_H

#include "curve.h"
#include "surface.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct quat_family {
    double a, b, c, d, e;
} quat_family;

/* ---- curves; closed over 0 ... 2 pi unless said otherwise ---- */

/* (a cos t, b sin t, 0); a circle for a = b. */
QUAT_API quat_status quat_ellipse(double a, double b, quat_family *family, quat_curve *curve);
/* (r cos t, r sin t, h t/(2 pi)), rising h a turn (left-handed for h < 0), t = 0 ... 2 pi turns; open. */
QUAT_API quat_status quat_helix(double r, double h, double turns, quat_family *family, quat_curve *curve);
/* ((R + r cos qt) cos pt, (R + r cos qt) sin pt, -r sin qt): winds p times about the z axis and q times about the core;
 * p, q from 1 to 1000 without a common factor; r < R. */
QUAT_API quat_status quat_torus_knot(double R, double r, int p, int q, quat_family *family, quat_curve *curve);
/* a (sin t + 2 sin 2t, cos t - 2 cos 2t, -sin 3t): the trefoil. */
QUAT_API quat_status quat_trefoil(double a, quat_family *family, quat_curve *curve);
/* Viviani's curve a (1 + cos t, sin t, 2 sin(t/2)), t = 0 ... 4 pi, on the sphere of radius 2a; closed. */
QUAT_API quat_status quat_viviani(double a, quat_family *family, quat_curve *curve);
/* a (t, t^2, t^3), t = -1 ... 1, without inflection; `planar`: a (t, t^3, 0), with one at 0. Open. */
QUAT_API quat_status quat_cubic(double a, bool planar, quat_family *family, quat_curve *curve);

/* ---- surfaces ---- */

/* (u, v, 0) over |u| <= a, |v| <= b. Normal +z. */
QUAT_API quat_status quat_plane(double a, double b, quat_family *family, quat_surface *surface);
/* (a cos v cos u, b cos v sin u, c sin v), u = 0 ... 2 pi closed, v = -pi/2 ... pi/2; a sphere for a = b = c. The poles
 * are degenerate. Normal outward. */
QUAT_API quat_status quat_ellipsoid(double a, double b, double c, quat_family *family, quat_surface *surface);
/* ((R + r cos v) cos u, (R + r cos v) sin u, r sin v), both closed over 0 ... 2 pi, r < R. Normal outward. */
QUAT_API quat_status quat_torus(double R, double r, quat_family *family, quat_surface *surface);
/* (u, v, (u^2 - v^2)/(2a)) over |u|, |v| <= size. Normal up. */
QUAT_API quat_status quat_saddle(double a, double size, quat_family *family, quat_surface *surface);
/* (a cosh(v/a) cos u, a cosh(v/a) sin u, v), u closed over 0 ... 2 pi, |v| <= height. Normal outward; H = 0. */
QUAT_API quat_status quat_catenoid(double a, double height, quat_family *family, quat_surface *surface);
/* (v cos u, v sin u, a u), |u| <= pi turns, |v| <= width; H = 0. */
QUAT_API quat_status quat_helicoid(double a, double turns, double width, quat_family *family, quat_surface *surface);
/* (a C(v, e) C(u, f), b C(v, e) S(u, f), c S(v, e)) with C(t, e) = cos t |cos t|^(e-1) and S alike: a superellipsoid
 * with exponents e and f in 0.05 ... 4, over the ellipsoid's ranges; (1, 1) is the ellipsoid. Where a sine or cosine is
 * 0 and its exponent is neither 1, 2 nor above 2 the second derivatives do not exist: no value there. */
QUAT_API quat_status quat_superellipsoid(double a, double b, double c, double e, double f, quat_family *family,
                                         quat_surface *surface);

#ifdef __cplusplus
}
#endif

#endif
