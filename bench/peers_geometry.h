/* SPDX-License-Identifier: MIT
 *
 * What bench_geometry and the textbook methods beside it share.
 */
#ifndef PEERS_GEOMETRY_H
#define PEERS_GEOMETRY_H

#include <quat/quat.h>

/* One run of a case: how far off it was, and a number that depends on all of it. */
typedef struct outcome {
    double error, checksum;
} outcome;

/* v/(1 + w) and back, as formulas in books have it: near w = -1 digits go. */
outcome plain_stereographic(int n, const quat frames[]);

/* Central differences of this step: the curvature of a helix, Gauss' of a torus (R = 2, r = 1), over n places. */
outcome helix_differences(int n, double step);
outcome torus_differences(int n, double step);

/* The length of the ellipse 2 : 1 by a polygon of so many sides, and by GSL's adaptive quadrature to a tolerance. */
outcome ellipse_polygon(double sides);
outcome ellipse_gsl(double tolerance);

/* The integral of K dA over the ellipsoid (1, 1, 1.5) by the midpoint rule of n x 2n points, and by GSL's adaptive
 * quadrature along v. */
outcome ellipsoid_midpoints(double n);
outcome ellipsoid_gsl(double tolerance);

static const double ellipse_length = 9.68844822054767619842; /* 8 E(sqrt(3)/2) */

/* Whether the peers by GSL are there: they answer NaN where not. */
#ifdef HAVE_GSL
enum { HAS_GSL = 1 };
#else
enum { HAS_GSL = 0 };
#endif

#endif
