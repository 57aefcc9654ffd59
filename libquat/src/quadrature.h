/* SPDX-License-Identifier: MIT
 *
 * quadrature: adaptive integrals over GSL's Gauss-Kronrod rules. Internal.
 */
#ifndef QUAT_QUADRATURE_H
#define QUAT_QUADRATURE_H

#include <quat/quat.h>

typedef double (*quat_integrand)(double t, void *context);

/* The integral of f over a ... b to about `tolerance` of the integral of |f|. GSL's own drivers call the process-wide
 * error handler when they fall short of it, its rules never do: halving is done here. QUAT_NOT_CONVERGED when 40
 * halvings are not enough, or 4000 intervals. */
quat_status quat_quadrature(quat_integrand f, void *context, double a, double b, double tolerance, double *integral);

#endif
