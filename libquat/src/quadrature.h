/* SPDX-License-Identifier: MIT
 *
 * quadrature: adaptive integrals over Kronrod's rule of 21 points. Internal.
 */
#ifndef QUAT_QUADRATURE_H
#define QUAT_QUADRATURE_H

#include <quat/quat.h>

/* f(t), and in *error (0 before) how far off it may be. */
typedef double (*quat_integrand)(double t, void *context, double *error);

/* The integral of f over a ... b: each interval is halved until that changes it by no more than `tolerance` of the
 * whole integral of |f|, or than f's own errors may; what these may make of the integral comes out in *noise.
 * QUAT_NOT_CONVERGED when 40 halvings are not enough, or 1600 intervals. */
quat_status quat_quadrature(quat_integrand f, void *context, double a, double b, double tolerance, double *integral,
                            double *noise);

#endif
