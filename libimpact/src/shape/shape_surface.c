/* SPDX-License-Identifier: MIT
 *
 * The shape as a surface: support, curvature, parametrisation, mesh.
 */
#include <impact/face.h>
#include <impact/shape.h>
#include "base/numbers.h"
#include "base/tolerances.h"
#include "shape/solid.h"
#include "shape/support.h"

static imp_form form_of(const impact_shape *shape)
{
    imp_form form;
    imp_form_make(shape, 1, quat_identity(), &form);
    return form;
}

/* Without its form, which takes five times as long: a wall of bricks takes a fiftieth fewer instructions for it. */
static double support_of_box(const impact_shape *shape, const double d[3], qvec3 *point)
{
    double axis[3], x[3];
    imp_core_axes(shape, axis);
    const double h = imp_box_support(axis, d, x), length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++) x[k] += shape->rounding * (d[k] / length);
    if (point) *point = (qvec3){x[0], x[1], x[2]};
    return h + shape->rounding * length;
}

double impact_shape_support(const impact_shape *shape, qvec3 direction, qvec3 *point)
{
    const double d[3] = {direction.x, direction.y, direction.z};
    if (shape->kind == IMPACT_PLANE) {
        const bool up = d[0] == 0 && d[1] == 0 && d[2] > 0;
        if (point) *point = up ? (qvec3){0, 0, 0} : (qvec3){NAN, NAN, NAN};
        return up ? 0 : INFINITY;
    }
    if (shape->kind == IMPACT_BOX) return support_of_box(shape, d, point);
    const imp_form form = form_of(shape);
    imp_surface s;
    double x[3], normal[3];
    const double h = imp_form_support(&form, d, &s);
    imp_surface_point(&form, &s, x, normal);
    if (point) *point = (qvec3){x[0], x[1], x[2]};
    return h;
}

qmat3 impact_shape_support_hessian(const impact_shape *shape, qvec3 direction)
{
    qmat3 out = {{{NAN, NAN, NAN}, {NAN, NAN, NAN}, {NAN, NAN, NAN}}};
    if (shape->kind == IMPACT_PLANE) return out;
    const imp_form form = form_of(shape);
    const double d[3] = {direction.x, direction.y, direction.z};
    imp_form_hessian(&form, d, out.m);
    return out;
}

/* sgn(s) |s|^m */
static double signed_power(double s, double m) { return copysign(pow(fabs(s), m), s); }

/* cos and sin of u and v, exact zeros at the quarter turns. */
static double quarter(double value) { return fabs(value) < IMP_QUARTER_TURN ? 0 : value; }

static qvec3 globe(double u, double v)
{
    const double across = quarter(cos(v));
    return (qvec3){across * quarter(cos(u)), across * quarter(sin(u)), quarter(sin(v))};
}

/* The middle of what a core's normal n has, and the ball's point there. */
static qvec3 core_point(const impact_shape *shape, qvec3 n)
{
    short vertex[IMPACT_HULL_POINTS];
    qvec3 x;
    impact_shape_support(shape, n, &x);
    if (shape->kind != IMPACT_POLYHEDRON) return x;
    const double d[3] = {n.x, n.y, n.z}, size = fmax(shape->a, fmax(shape->b, shape->c));
    const imp_form form = form_of(shape);
    double mean[3];
    imp_core_reached(&form.core, d, IMP_CORE_TIE * size, vertex, mean);
    return (qvec3){mean[0] + shape->rounding * n.x, mean[1] + shape->rounding * n.y, mean[2] + shape->rounding * n.z};
}

qvec3 impact_shape_point(const impact_shape *shape, double u, double v)
{
    if (imp_has_core(shape)) return core_point(shape, globe(u, v));
    if (shape->kind == IMPACT_PLANE)
        return (qvec3){fmax(-shape->a, fmin(shape->a, u)), fmax(-shape->b, fmin(shape->b, v)), 0};
    const double cu = quarter(cos(u)), su = quarter(sin(u)), cv = quarter(cos(v)), sv = quarter(sin(v));
    const bool nested = shape->kind == IMPACT_SUPERELLIPSOID;
    const double r = 2 / shape->r, s = 2 / shape->s, t = 2 / shape->t;
    return (qvec3){shape->a * signed_power(cv, nested ? t : r) * signed_power(cu, r),
                   shape->b * signed_power(cv, nested ? t : s) * signed_power(su, s), shape->c * signed_power(sv, t)};
}

/* The gradient of the left-hand side has the exponents 2 - 2/p; where it vanishes with an axis the limit is kept. */
qvec3 impact_shape_normal(const impact_shape *shape, double u, double v)
{
    if (shape->kind == IMPACT_PLANE) return (qvec3){0, 0, 1};
    if (imp_has_core(shape)) return globe(u, v);
    const double cu = quarter(cos(u)), su = quarter(sin(u)), cv = quarter(cos(v)), sv = quarter(sin(v));
    const bool nested = shape->kind == IMPACT_SUPERELLIPSOID;
    const double r = 2 - 2 / shape->r, s = 2 - 2 / shape->s, t = 2 - 2 / shape->t;
    const double kx = nested ? 1 : shape->r, ky = nested ? 1 : shape->s, kz = nested ? 1 : shape->t;
    qvec3 n = {kx * signed_power(cv, nested ? t : r) * signed_power(cu, r) / shape->a,
               ky * signed_power(cv, nested ? t : s) * signed_power(su, s) / shape->b,
               kz * signed_power(sv, t) / shape->c};
    const double largest = fmax(fabs(n.x), fmax(fabs(n.y), fabs(n.z)));
    n = qvec3_scale(n, 1 / largest);
    return qvec3_scale(n, 1 / sqrt(qvec3_dot(n, n)));
}

double impact_shape_inside(const impact_shape *shape, qvec3 x)
{
    if (shape->kind == IMPACT_PLANE) return 1 + x.z;
    const imp_form form = form_of(shape);
    const double at[3] = {x.x, x.y, x.z};
    if (!imp_has_core(shape)) return imp_form_inside(&form, at);
    return 1 + (imp_core_distance(&form, at) - shape->rounding) / fmax(shape->a, fmax(shape->b, shape->c));
}

/* 1/radius with 1/0 = inf and 1/inf = 0. */
static double curvature_of(double radius) { return radius > 0 ? 1 / radius : INFINITY; }

/* Radii rounding + R/rho and rounding on a rim; rounding + R and infinite on a side (half R/rho in the middle of a
 * cone's); of a polytope rounding across an edge and infinite along it: by the dimension of what lies within the height
 * of the supporting plane. */
static void core_curvatures(const impact_shape *shape, qvec3 n, double height, double *k1, double *k2)
{
    const double r = shape->rounding;
    const imp_form form = form_of(shape);
    impact_face face;
    impact_shape_face(shape, n, height, &face);
    *k1 = *k2 = 0;
    if (face.dimension == 2) return;
    const bool cone = form.kind == IMP_FORM_CONE, turned = cone || form.kind == IMP_FORM_CYLINDER;
    const double around = turned ? form.axis[0] / hypot(n.x, n.y) : 0; /* R/rho */
    if (face.dimension == 1) {
        *k1 = curvature_of(r + (cone ? around / 2 : around));
        return;
    }
    *k1 = curvature_of(r);
    *k2 = curvature_of(face.feature.kind == IMPACT_RIM ? r + around : r);
}

void imp_shape_curvatures(const impact_shape *shape, qvec3 direction, double height, double *k1, double *k2)
{
    *k1 = *k2 = NAN;
    const double length = qvec3_norm(direction);
    if (!(length > 0) || !isfinite(length)) return;
    if (shape->kind == IMPACT_PLANE) {
        *k1 = *k2 = 0;
        return;
    }
    if (imp_has_core(shape)) {
        core_curvatures(shape, qvec3_scale(direction, 1 / length), height, k1, k2);
        return;
    }
    const qmat3 H = impact_shape_support_hessian(shape, qvec3_scale(direction, 1 / length));
    /* H has the eigenvalues 0, rho1, rho2: their sum is the trace, their product the sum of the principal minors. */
    const double trace = H.m[0][0] + H.m[1][1] + H.m[2][2];
    const double minors = H.m[0][0] * H.m[1][1] - H.m[0][1] * H.m[1][0] + H.m[1][1] * H.m[2][2] -
                          H.m[1][2] * H.m[2][1] + H.m[2][2] * H.m[0][0] - H.m[2][0] * H.m[0][2];
    if (!isfinite(trace)) {
        const double rest = (isinf(H.m[0][0]) ? 0 : H.m[0][0]) + (isinf(H.m[1][1]) ? 0 : H.m[1][1]) +
                            (isinf(H.m[2][2]) ? 0 : H.m[2][2]);
        const int flats = (isinf(H.m[0][0]) != 0) + (isinf(H.m[1][1]) != 0) + (isinf(H.m[2][2]) != 0);
        *k1 = flats > 1 ? 0 : curvature_of(rest);
        *k2 = 0;
        return;
    }
    const double root = sqrt(fmax(0, trace * trace / 4 - minors)), larger = trace / 2 + root;
    *k2 = curvature_of(larger);
    *k1 = curvature_of(larger > 0 ? minors / larger : 0);
}

void impact_shape_curvatures(const impact_shape *shape, qvec3 direction, double *k1, double *k2)
{
    imp_shape_curvatures(shape, direction, IMP_CORE_TIE * fmax(shape->a, fmax(shape->b, shape->c)), k1, k2);
}

impact_status impact_shape_mesh(const impact_shape *shape, int nu, int nv, qvec3 *points, qvec3 *normals)
{
    if (nu < 3 || nv < 2) return IMPACT_EARGUMENT;
    for (int j = 0; j <= nv; j++)
        for (int i = 0; i < nu; i++) {
            const double u = -IMP_PI + 2 * IMP_PI * i / nu, v = -IMP_PI / 2 + IMP_PI * j / nv;
            points[j * nu + i] = impact_shape_point(shape, u, v);
            if (normals) normals[j * nu + i] = impact_shape_normal(shape, u, v);
        }
    return IMPACT_OK;
}
