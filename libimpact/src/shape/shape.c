/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <impact/shape.h>
#include "base/tolerances.h"
#include "base/number.h"
#include "shape/solid.h"

static impact_status say(impact_status status, char *message, size_t size, const char *name, double value,
                         const char *complaint)
{
    if (message && size > 0) snprintf(message, size, "%s = %s %s", name, imp_number_of(value).text, complaint);
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
    if (value > IMP_MOST_EXPONENT) return say(IMPACT_EARGUMENT, message, size, name, value, "is above 1e6");
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

/* least: the smallest half size that the rounding must leave room in. */
static impact_status check_rounding(double value, double least, const char *complaint, char *message, size_t size)
{
    if (!isfinite(value)) return say(IMPACT_EDOMAIN, message, size, "rounding", value, "is not finite");
    if (value < 0) return say(IMPACT_EARGUMENT, message, size, "rounding", value, "is negative");
    if (!(value < least)) return say(IMPACT_EARGUMENT, message, size, "rounding", value, complaint);
    return IMPACT_OK;
}

static impact_status check_box(const impact_shape *shape, char *message, size_t size)
{
    impact_status status;
    if ((status = check_axis(shape->a, "half side a", message, size)) != IMPACT_OK) return status;
    if ((status = check_axis(shape->b, "half side b", message, size)) != IMPACT_OK) return status;
    if ((status = check_axis(shape->c, "half side c", message, size)) != IMPACT_OK) return status;
    return check_rounding(shape->rounding, fmin(shape->a, fmin(shape->b, shape->c)), "is not below every half side",
                          message, size);
}

static impact_status check_turned(const impact_shape *shape, char *message, size_t size)
{
    const bool cone = shape->kind == IMPACT_CONE;
    impact_status status;
    if ((status = check_axis(shape->a, "radius", message, size)) != IMPACT_OK) return status;
    if ((status = check_axis(shape->c, cone ? "height" : "half_height", message, size)) != IMPACT_OK) return status;
    if (shape->b != shape->a)
        return say(IMPACT_EARGUMENT, message, size, "b", shape->b, "is not a, the radius, as a round body needs");
    if (shape->kind == IMPACT_CAPSULE)
        return shape->rounding == shape->a && shape->c > shape->a
                   ? IMPACT_OK
                   : say(IMPACT_EARGUMENT, message, size, "rounding", shape->rounding,
                         "is not a capsule's radius, or c not above it");
    status = check_rounding(shape->rounding, fmin(shape->a, cone ? shape->c / 2 : shape->c),
                            "is not below the radius and half the height", message, size);
    if (status != IMPACT_OK || !cone) return status;
    return shape->base > -shape->c && shape->base < 0
               ? IMPACT_OK
               : say(IMPACT_EARGUMENT, message, size, "base", shape->base, "is not below the centroid");
}

static impact_status check_polyhedron(const impact_shape *shape, char *message, size_t size)
{
    if (!shape->hull) return say(IMPACT_EARGUMENT, message, size, "hull", 0, "is none");
    return shape->rounding == shape->hull->rounding
               ? IMPACT_OK
               : say(IMPACT_EARGUMENT, message, size, "rounding", shape->rounding, "is not its hull's");
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
    case IMPACT_BOX: return check_box(shape, message, size);
    case IMPACT_CYLINDER:
    case IMPACT_CONE:
    case IMPACT_CAPSULE: return check_turned(shape, message, size);
    case IMPACT_POLYHEDRON: return check_polyhedron(shape, message, size);
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
    return keep_if_good(
        (impact_shape){.kind = IMPACT_SPHERE, .a = radius, .b = radius, .c = radius, .r = 2, .s = 2, .t = 2}, shape);
}

impact_status impact_shape_plane(double half_x, double half_y, impact_shape *shape)
{
    return keep_if_good((impact_shape){.kind = IMPACT_PLANE, .a = half_x, .b = half_y, .c = 0, .r = 2, .s = 2, .t = 2},
                        shape);
}

impact_status impact_shape_ellipsoid(double a, double b, double c, impact_shape *shape)
{
    return keep_if_good((impact_shape){.kind = IMPACT_SUPERQUADRIC, .a = a, .b = b, .c = c, .r = 2, .s = 2, .t = 2},
                        shape);
}

impact_status impact_shape_superquadric(double a, double b, double c, double r, double s, double t, impact_shape *shape)
{
    return keep_if_good((impact_shape){.kind = IMPACT_SUPERQUADRIC, .a = a, .b = b, .c = c, .r = r, .s = s, .t = t},
                        shape);
}

impact_status impact_shape_superellipsoid(double a, double b, double c, double eps1, double eps2, impact_shape *shape)
{
    if (!isfinite(eps1) || !isfinite(eps2)) return IMPACT_EDOMAIN;
    if (!(eps1 > 0 && eps2 > 0)) return IMPACT_EARGUMENT;
    return keep_if_good(
        (impact_shape){
            .kind = IMPACT_SUPERELLIPSOID, .a = a, .b = b, .c = c, .r = 2 / eps2, .s = 2 / eps2, .t = 2 / eps1},
        shape);
}

static impact_shape with_core(impact_shape_kind kind, double a, double b, double c, double rounding)
{
    const bool round = kind != IMPACT_BOX && kind != IMPACT_POLYHEDRON;
    const double across = round ? 2 : INFINITY, along = kind == IMPACT_CAPSULE ? 2 : INFINITY;
    return (impact_shape){
        .kind = kind, .a = a, .b = b, .c = c, .r = across, .s = across, .t = along, .rounding = rounding};
}

impact_status impact_shape_box(double a, double b, double c, double rounding, impact_shape *shape)
{
    return keep_if_good(with_core(IMPACT_BOX, a, b, c, rounding), shape);
}

impact_status impact_shape_cylinder(double radius, double half_height, double rounding, impact_shape *shape)
{
    return keep_if_good(with_core(IMPACT_CYLINDER, radius, radius, half_height, rounding), shape);
}

impact_status impact_shape_cone(double radius, double height, double rounding, impact_shape *shape)
{
    impact_shape cone = with_core(IMPACT_CONE, radius, radius, height, rounding);
    cone.base = imp_cone_base(radius, height, rounding);
    return keep_if_good(cone, shape);
}

impact_status impact_shape_capsule(double radius, double half_height, impact_shape *shape)
{
    if (!(half_height > 0)) return isnan(half_height) ? IMPACT_EDOMAIN : IMPACT_EARGUMENT;
    return keep_if_good(with_core(IMPACT_CAPSULE, radius, radius, half_height + radius, radius), shape);
}

impact_status impact_shape_polyhedron(const impact_hull *hull, impact_shape *shape)
{
    if (!hull) return IMPACT_EARGUMENT;
    const double *e = hull->extent, r = hull->rounding;
    impact_shape polyhedron = with_core(IMPACT_POLYHEDRON, e[0] + r, e[1] + r, e[2] + r, r);
    polyhedron.hull = hull;
    return keep_if_good(polyhedron, shape);
}
