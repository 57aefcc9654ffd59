/* SPDX-License-Identifier: MIT
 *
 * The curvature of a torus from its points alone, and Gauss and Bonnet's theorem on it.
 */
#include <quat/surface.h>
#include <stdio.h>

static bool torus(double u, double v, qvec3 d[6], void *context)
{
    (void)context;
    const double ring = 2 + cos(v);
    d[0] = qvec3_make(ring * cos(u), ring * sin(u), sin(v));
    return true;
}

int main(void)
{
    const double two_pi = 6.283185307179586;
    const quat_surface surface = {
        .at = torus, .u1 = two_pi, .v1 = two_pi, .closed_u = true, .closed_v = true, .known = 0};
    quat_surface_point p;
    quat_surface_totals totals;
    if (quat_surface_at(&surface, 1, 0, &p) < 0) return 1;
    printf("K = %.6f, H = %.6f, principal %.6f and %.6f\n", p.curvature.gauss, p.curvature.mean,
           p.curvature.principal[0], p.curvature.principal[1]);
    if (quat_surface_total(&surface, 1e-7, &totals) != QUAT_OK) return 1;
    printf("area %.6f, integral of K %.6f\n", totals.area, fabs(totals.gauss));
    return 0;
}
