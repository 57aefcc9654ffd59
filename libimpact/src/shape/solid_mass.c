/* SPDX-License-Identifier: MIT
 *
 * Moments of a core with a ball of radius r about each of its points.
 *
 * Box of core a, b, c: the core, slabs on its faces, quarters of cylinders on its edges, eighths of a ball:
 *
 *     V     = 8abc + 8r(ab + bc + ca) + 2 pi r^2 (a + b + c) + (4/3) pi r^3
 *     int x^2 = (8/3)a^3(bc + br + cr) + (8/3)bc((a + r)^3 - a^3) + (2/3) pi r^2 a^3
 *             + 2(b + c)(pi r^2 a^2 + (8/3) a r^3 + pi r^4/4) + (4/3) pi r^3 a^2 + pi r^4 a + (4/15) pi r^5
 *
 * A body of revolution with the profile rho(z): V = pi int rho^2 dz, int z = pi int rho^2 z dz, int z^2 = pi int rho^2
 * z^2 dz, int x^2 = (pi/4) int rho^4 dz, along the profile from the bottom up: lines and arcs rho = rho_0 + r cos phi,
 * z = z_0 + r sin phi, whose integrals are those of cos^m and of cos^m sin^k.
 */
#include "base/numbers.h"
#include "shape/ridge.h"
#include "shape/solid.h"

void imp_core_axes(const impact_shape *shape, double axis[3])
{
    const double r = shape->rounding;
    const double all[3] = {shape->a, shape->b, shape->c};
    for (int k = 0; k < 3; k++) axis[k] = all[k] - r;
    if (shape->kind == IMPACT_CONE) axis[2] = shape->c - 2 * r;
    if (shape->kind == IMPACT_CAPSULE) axis[0] = axis[1] = 0;
}

static double box_volume(double a, double b, double c, double r)
{
    return 8 * a * b * c + 8 * r * (a * b + b * c + c * a) + 2 * IMP_PI * r * r * (a + b + c) +
           4.0 / 3.0 * IMP_PI * r * r * r;
}

static double box_second(double a, double b, double c, double r)
{
    const double r2 = r * r, r3 = r2 * r, r4 = r3 * r, a2 = a * a, a3 = a2 * a;
    return 8.0 / 3.0 * a3 * (b * c + b * r + c * r) + 8.0 / 3.0 * b * c * r * (3 * a2 + 3 * a * r + r2) +
           2.0 / 3.0 * IMP_PI * r2 * a3 + 2 * (b + c) * (IMP_PI * r2 * a2 + 8.0 / 3.0 * a * r3 + IMP_PI * r4 / 4) +
           4.0 / 3.0 * IMP_PI * r3 * a2 + IMP_PI * r4 * a + 4.0 / 15.0 * IMP_PI * r4 * r;
}

/* int rho^2, rho^2 z, rho^2 z^2, rho^4 dz */
typedef struct profile {
    double volume, z, zz, quartic;
} profile;

/* Three Gauss points hold polynomials of degree 5. */
static void add_line(profile *p, double rho0, double z0, double rho1, double z1)
{
    static const double node[3] = {0.11270166537925831, 0.5, 0.88729833462074169};
    static const double weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    for (int i = 0; i < 3; i++) {
        const double rho = rho0 + node[i] * (rho1 - rho0), z = z0 + node[i] * (z1 - z0), dz = weight[i] * (z1 - z0);
        const double square = rho * rho;
        p->volume += square * dz, p->z += square * z * dz, p->zz += square * z * z * dz;
        p->quartic += square * square * dz;
    }
}

/* int cos^m, m = 0 .. 7, from 0 to phi. */
static void cosine_powers(double phi, double c[8])
{
    const double cosine = cos(phi), sine = sin(phi);
    double power = 1;
    c[0] = phi, c[1] = sine;
    for (int m = 2; m < 8; m++) {
        power *= cosine;
        c[m] = (power * sine + (m - 1) * c[m - 2]) / m;
    }
}

/* The arc about (rho0, z0) of radius r from the angle phi0 to phi1. */
static void add_arc(profile *p, double rho0, double z0, double r, double phi0, double phi1)
{
    double c[8], from[8], s[8], ss[6];
    cosine_powers(phi1, c);
    cosine_powers(phi0, from);
    for (int m = 0; m < 8; m++) {
        c[m] -= from[m];
        s[m] = (pow(cos(phi0), m + 1) - pow(cos(phi1), m + 1)) / (m + 1); /* int cos^m sin */
    }
    for (int m = 0; m < 6; m++) ss[m] = c[m] - c[m + 2]; /* int cos^m sin^2 */
    /* rho^2 dz = (R^2 + 2 R r cos + r^2 cos^2) r cos, in powers of the cosine */
    const double square[3] = {rho0 * rho0 * r, 2 * rho0 * r * r, r * r * r};
    for (int k = 0; k < 3; k++) {
        p->volume += square[k] * c[1 + k];
        p->z += square[k] * (z0 * c[1 + k] + r * s[1 + k]);
        p->zz += square[k] * (z0 * z0 * c[1 + k] + 2 * z0 * r * s[1 + k] + r * r * ss[1 + k]);
    }
    double binomial = 1, big = pow(rho0, 4);
    for (int k = 0; k <= 4; k++) {
        p->quartic += binomial * big * pow(r, k + 1) * c[1 + k];
        binomial = binomial * (4 - k) / (k + 1);
        big = pow(rho0, 3 - k);
    }
}

/* A cylinder, a capsule (radius 0) of half height h, about its middle. */
static profile straight(double radius, double h, double r)
{
    profile p = {0};
    add_arc(&p, radius, -h, r, -IMP_PI / 2, 0);
    add_line(&p, radius + r, -h, radius + r, h);
    add_arc(&p, radius, h, r, 0, IMP_PI / 2);
    return p;
}

/* A cone with its base at z. */
static profile tapering(double radius, double height, double r, double z)
{
    profile p = {0};
    const double tilt = atan2(radius, height), x = r * cos(tilt), y = r * sin(tilt);
    add_arc(&p, radius, z, r, -IMP_PI / 2, tilt);
    add_line(&p, radius + x, z + y, x, z + height + y);
    add_arc(&p, 0, z + height, r, tilt, IMP_PI / 2);
    return p;
}

double imp_cone_base(double radius, double height, double rounding)
{
    if (!(rounding > 0)) return -height / 4;
    const profile p = tapering((radius - rounding) / radius, (height - 2 * rounding) / radius, rounding / radius, 0);
    return -p.z / p.volume * radius;
}

/* In units of the largest of a, b, c. */
static profile profile_of(const impact_shape *shape, double unit)
{
    double axis[3];
    imp_core_axes(shape, axis);
    const double r = shape->rounding / unit;
    return shape->kind == IMPACT_CONE ? tapering(axis[0] / unit, axis[2] / unit, r, shape->base / unit)
                                      : straight(axis[0] / unit, axis[2] / unit, r);
}

static double unit_of(const impact_shape *shape) { return fmax(shape->a, fmax(shape->b, shape->c)); }

double imp_solid_volume(const impact_shape *shape)
{
    const double unit = unit_of(shape), cube = unit * unit * unit;
    double axis[3];
    imp_core_axes(shape, axis);
    if (shape->kind == IMPACT_POLYHEDRON) return shape->hull->volume;
    if (shape->kind == IMPACT_BOX)
        return cube * box_volume(axis[0] / unit, axis[1] / unit, axis[2] / unit, shape->rounding / unit);
    return cube * IMP_PI * profile_of(shape, unit).volume;
}

qvec3 imp_solid_inertia(const impact_shape *shape)
{
    const double unit = unit_of(shape), square = unit * unit;
    double axis[3];
    imp_core_axes(shape, axis);
    if (shape->kind == IMPACT_POLYHEDRON) return shape->hull->inertia;
    if (shape->kind == IMPACT_BOX) {
        const double a = axis[0] / unit, b = axis[1] / unit, c = axis[2] / unit, r = shape->rounding / unit;
        const double scale = square / box_volume(a, b, c, r), x = scale * box_second(a, b, c, r),
                     y = scale * box_second(b, c, a, r), z = scale * box_second(c, a, b, r);
        return (qvec3){y + z, z + x, x + y};
    }
    const profile p = profile_of(shape, unit);
    const double x = square * p.quartic / p.volume / 4, z = square * p.zz / p.volume;
    return (qvec3){x + z, x + z, 2 * x};
}

double imp_solid_radius(const impact_shape *shape)
{
    double axis[3];
    imp_core_axes(shape, axis);
    const double r = shape->rounding;
    switch (shape->kind) {
    case IMPACT_BOX: return hypot(hypot(axis[0], axis[1]), axis[2]) + r;
    case IMPACT_CYLINDER: return hypot(axis[0], axis[2]) + r;
    case IMPACT_CONE: return fmax(hypot(axis[0], shape->base), shape->base + axis[2]) + r;
    case IMPACT_CAPSULE: return shape->c;
    case IMPACT_POLYHEDRON: return shape->hull->radius + r;
    default: return NAN;
    }
}

static double inner_of_hull(const impact_hull *hull)
{
    double least = INFINITY;
    int vertex[IMPACT_HULL_POINTS];
    for (int f = 0; f < hull->face_count; f++) {
        qvec3 normal;
        if (impact_hull_face(hull, f, vertex, &normal) > 0)
            least = fmin(least, qvec3_dot(normal, impact_hull_vertex(hull, vertex[0])));
    }
    return least;
}

double imp_shape_inner_radius(const impact_shape *shape)
{
    switch (shape->kind) {
    case IMPACT_PLANE: return INFINITY;
    case IMPACT_CYLINDER: return fmin(shape->a, shape->c);
    case IMPACT_CAPSULE: return shape->a;
    case IMPACT_CONE: {
        const qvec3 side = {shape->c, 0, shape->a}; /* across a line from the base's rim to the apex: near enough */
        const double across = impact_shape_support(shape, qvec3_scale(side, 1 / qvec3_norm(side)), NULL);
        return fmin(across, shape->rounding - shape->base);
    }
    case IMPACT_POLYHEDRON: return inner_of_hull(shape->hull) + shape->rounding;
    default:
        return imp_is_octahedron(shape) || imp_ridge_count(shape) > 0
                   ? 1 / hypot(hypot(1 / shape->a, 1 / shape->b), 1 / shape->c)
                   : fmin(shape->a, fmin(shape->b, shape->c));
    }
}
