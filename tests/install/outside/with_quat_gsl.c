/* SPDX-License-Identifier: MIT */
#include <quat/family.h>

#include <stdio.h>

/* The length of a unit circle, by GSL's quadrature, and the total curvature of a torus. */
int main(void)
{
    const double two_pi = 4 * acos(0.0);
    quat_family ring, tube;
    quat_curve circle;
    quat_surface torus;
    quat_surface_totals totals;
    double length;
    if (quat_ellipse(1, 1, &ring, &circle) != QUAT_OK || quat_torus(2, 1, &tube, &torus) != QUAT_OK) return 1;
    if (quat_curve_length(&circle, 0, two_pi, &length) != QUAT_OK) return 1;
    if (quat_surface_total(&torus, 1e-12, &totals) != QUAT_OK) return 1;
    printf("quat_gsl: the circle is off by %.1e, Gauss and Bonnet by %.1e\n", fabs(length - two_pi),
           fabs(totals.gauss));
    return fabs(length - two_pi) < 1e-12 && fabs(totals.gauss) < 1e-10 ? 0 : 1;
}
