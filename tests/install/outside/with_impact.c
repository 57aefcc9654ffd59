/* SPDX-License-Identifier: MIT */
#include <impact/impact.h>

#include <math.h>
#include <stdio.h>

static int decay(double t, const double *y, double *rate, void *context)
{
    (void)t, (void)context;
    rate[0] = -y[0];
    return 0;
}

/* y' = -y from 1 to t = 1 with CVODE; a build without it must say so. */
static int integrate(void)
{
    const impact_ode_def def = {.struct_size = sizeof def,
                                .size = 1,
                                .rhs = decay,
                                .method = IMPACT_ODE_ADAMS,
                                .relative_tolerance = 1e-10,
                                .absolute_tolerance = 1e-12};
    impact_ode *ode = NULL;
    const impact_status status = impact_ode_create(&def, &ode);
    if (!impact_has(IMPACT_PART_CVODE)) return status == IMPACT_EABSENT ? 0 : 1;
    double t = 0, y = 1;
    bool found = false;
    if (status != IMPACT_OK || impact_ode_start(ode, t, &y) != IMPACT_OK ||
        impact_ode_advance(ode, 1, &t, &y, NULL, &found) != IMPACT_OK)
        return 1;
    impact_ode_destroy(ode);
    printf("impact: CVODE's exp(-1) is off by %.1e\n", fabs(y - exp(-1)));
    return fabs(y - exp(-1)) < 1e-8 ? 0 : 1;
}

int main(void)
{
    impact_shape sphere;
    if (impact_shape_sphere(0.3, &sphere) != IMPACT_OK) return 1;
    printf("impact %s: a sphere of radius 0.3 m has %.6f m^3\n", impact_version(), impact_shape_volume(&sphere));
    return integrate();
}
