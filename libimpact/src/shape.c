/* SPDX-License-Identifier: MIT */
#include <impact/shape.h>

impact_status impact_shape_sphere(double radius, impact_shape *shape)
{
    if (!isfinite(radius)) return IMPACT_EDOMAIN;
    if (!(radius > 0)) return IMPACT_EARGUMENT;
    *shape = (impact_shape){IMPACT_SPHERE, radius, radius, radius, 2, 2, 2};
    return IMPACT_OK;
}

impact_status impact_shape_plane(double half_x, double half_y, impact_shape *shape)
{
    if (isnan(half_x) || isnan(half_y)) return IMPACT_EDOMAIN;
    if (!(half_x > 0 && half_y > 0)) return IMPACT_EARGUMENT;
    *shape = (impact_shape){IMPACT_PLANE, half_x, half_y, 0, 2, 2, 2};
    return IMPACT_OK;
}

double impact_shape_volume(const impact_shape *shape)
{
    if (shape->kind == IMPACT_PLANE) return INFINITY;
    return 4.0 / 3.0 * 3.14159265358979323846 * shape->a * shape->b * shape->c;
}

qvec3 impact_shape_inertia(const impact_shape *shape)
{
    if (shape->kind == IMPACT_PLANE) return (qvec3){INFINITY, INFINITY, INFINITY};
    const double moment = 0.4 * shape->a * shape->a;
    return (qvec3){moment, moment, moment};
}

double impact_shape_bounding_radius(const impact_shape *shape)
{
    return shape->kind == IMPACT_PLANE ? INFINITY : shape->a;
}
