/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <impact/shape.h>

static const double max_exponent = 1e6;

static impact_status say(impact_status status, char *message, size_t size, const char *name, double value,
                         const char *complaint)
{
    if (message && size > 0) snprintf(message, size, "%s = %.17g %s", name, value, complaint);
    return status;
}

static impact_status check_axis(double value, const char *name, char *message, size_t size)
{
    if (!isfinite(value)) return say(IMPACT_EDOMAIN, message, size, name, value, "is not finite");
    if (!(value > 0)) return say(IMPACT_EARGUMENT, message, size, name, value, "is not positive");
    return IMPACT_OK;
}

static impact_status check_extent(double value, const char *name, char *message, size_t size)
{
    if (isnan(value)) return say(IMPACT_EDOMAIN, message, size, name, value, "is not a number");
    if (!(value > 0)) return say(IMPACT_EARGUMENT, message, size, name, value, "is not positive");
    return IMPACT_OK;
}

static impact_status check_exponent(double value, const char *name, char *message, size_t size)
{
    if (!isfinite(value)) return say(IMPACT_EDOMAIN, message, size, name, value, "is not finite");
    if (value < 1) return say(IMPACT_EARGUMENT, message, size, name, value, "< 1 is not convex");
    if (value > max_exponent) return say(IMPACT_EARGUMENT, message, size, name, value, "is above 1e6");
    return IMPACT_OK;
}

static impact_status check_superquadric(const impact_shape *shape, char *message, size_t size)
{
    impact_status status;
    if ((status = check_axis(shape->a, "semi-axis a", message, size)) != IMPACT_OK) return status;
    if ((status = check_axis(shape->b, "semi-axis b", message, size)) != IMPACT_OK) return status;
    if ((status = check_axis(shape->c, "semi-axis c", message, size)) != IMPACT_OK) return status;
    if ((status = check_exponent(shape->r, "exponent r", message, size)) != IMPACT_OK) return status;
    if ((status = check_exponent(shape->s, "exponent s", message, size)) != IMPACT_OK) return status;
    if ((status = check_exponent(shape->t, "exponent t", message, size)) != IMPACT_OK) return status;
    if (shape->kind == IMPACT_SUPERELLIPSOID && shape->s != shape->r)
        return say(IMPACT_EARGUMENT, message, size, "exponent s", shape->s, "is not r, as a superellipsoid needs");
    return IMPACT_OK;
}

impact_status impact_shape_check(const impact_shape *shape, char *message, size_t size)
{
    if (message && size > 0) message[0] = '\0';
    impact_status status;
    switch (shape->kind) {
    case IMPACT_SPHERE: return check_axis(shape->a, "radius", message, size);
    case IMPACT_PLANE:
        if ((status = check_extent(shape->a, "half-extent along x", message, size)) != IMPACT_OK) return status;
        return check_extent(shape->b, "half-extent along y", message, size);
    case IMPACT_SUPERQUADRIC:
    case IMPACT_SUPERELLIPSOID: return check_superquadric(shape, message, size);
    }
    return say(IMPACT_EARGUMENT, message, size, "kind", (double)shape->kind, "is no kind of shape");
}

static impact_status keep_if_good(impact_shape candidate, impact_shape *shape)
{
    const impact_status status = impact_shape_check(&candidate, NULL, 0);
    if (status == IMPACT_OK) *shape = candidate;
    return status;
}

impact_status impact_shape_sphere(double radius, impact_shape *shape)
{
    return keep_if_good((impact_shape){IMPACT_SPHERE, radius, radius, radius, 2, 2, 2}, shape);
}

impact_status impact_shape_plane(double half_x, double half_y, impact_shape *shape)
{
    return keep_if_good((impact_shape){IMPACT_PLANE, half_x, half_y, 0, 2, 2, 2}, shape);
}

impact_status impact_shape_ellipsoid(double a, double b, double c, impact_shape *shape)
{
    return keep_if_good((impact_shape){IMPACT_SUPERQUADRIC, a, b, c, 2, 2, 2}, shape);
}

impact_status impact_shape_superquadric(double a, double b, double c, double r, double s, double t, impact_shape *shape)
{
    return keep_if_good((impact_shape){IMPACT_SUPERQUADRIC, a, b, c, r, s, t}, shape);
}

impact_status impact_shape_superellipsoid(double a, double b, double c, double eps1, double eps2, impact_shape *shape)
{
    if (!isfinite(eps1) || !isfinite(eps2)) return IMPACT_EDOMAIN;
    if (!(eps1 > 0 && eps2 > 0)) return IMPACT_EARGUMENT;
    return keep_if_good((impact_shape){IMPACT_SUPERELLIPSOID, a, b, c, 2 / eps2, 2 / eps2, 2 / eps1}, shape);
}
