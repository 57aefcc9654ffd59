/* SPDX-License-Identifier: MIT */
#include <impact/impact.h>
#include <stdio.h>

int main(void)
{
    impact_shape sphere;
    if (impact_shape_sphere(0.3, &sphere) != IMPACT_OK) return 1;
    printf("impact %s: a sphere of radius 0.3 m has %.6f m^3\n", impact_version(), impact_shape_volume(&sphere));
    return 0;
}
