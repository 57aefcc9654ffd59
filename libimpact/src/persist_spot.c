/* SPDX-License-Identifier: MIT */
#include "persist_spot.h"
#include "support.h"

/* Stands for the slope 0 of a flat point: the contact passes it before any time goes by. */
#define LEAST_SLOPE 1e-200

bool impact_spot_suits(const impact_world *world, const impact_pair *pair)
{
    const impact_shape *shape = &world->bodies[pair->body1].shape;
    if (world->bodies[pair->body2].shape.kind != IMPACT_PLANE) return false;
    if (shape->kind == IMPACT_SUPERELLIPSOID && shape->r != shape->t) return false;
    if (shape->kind != IMPACT_SUPERQUADRIC && shape->kind != IMPACT_SUPERELLIPSOID) return false;
    return fmin(shape->r, fmin(shape->s, shape->t)) > 1 && (shape->r != 2 || shape->s != 2 || shape->t != 2);
}

/* The x >= 0 of x + x^n = s, n >= 1, s >= 0: Newton from above falls monotonically. */
static double split(double s, double n)
{
    double x = s > 1 ? pow(s, 1 / n) : s;
    for (int i = 0; i < 60; i++) {
        const double power = pow(x, n - 1), step = (x + x * power - s) / (1 + n * power);
        x -= step;
        if (!(step > 1e-16 * x)) break;
    }
    return fmax(x, 0);
}

/* u and e of one axis from s. */
static void part(double s, double p, double *u, double *e)
{
    const double size = fabs(s);
    const double smaller = p == 2 ? 0.5 * size : split(size, p > 2 ? p - 1 : 1 / (p - 1)), rest = size - smaller;
    /* near 0 the rest of one axis is all rounding: the power is exact */
    const double larger = rest > 0.1 * size ? rest : pow(smaller, p > 2 ? p - 1 : 1 / (p - 1));
    *u = copysign(p > 2 ? smaller : larger, s);
    *e = copysign(p > 2 ? larger : smaller, s);
}

static void exponents_of(const impact_shape *shape, double p[3], double axis[3])
{
    p[0] = shape->r, p[1] = shape->s, p[2] = shape->t;
    axis[0] = shape->a, axis[1] = shape->b, axis[2] = shape->c;
}

void impact_spot_find(const impact_shape *shape, qvec3 normal, double s[3])
{
    const double d[3] = {normal.x, normal.y, normal.z};
    impact_form form;
    impact_surface surface;
    impact_form_make(shape, 1, quat_identity(), &form);
    impact_form_support(&form, d, &surface);
    for (int i = 0; i < 3; i++) s[i] = surface.u[i] + surface.e[i];
}

void impact_spot_on(const impact_shape *shape, qvec3 point, double s[3])
{
    const double x[3] = {point.x, point.y, point.z};
    double p[3], axis[3];
    exponents_of(shape, p, axis);
    for (int i = 0; i < 3; i++) {
        const double u = x[i] / axis[i];
        s[i] = u + copysign(pow(fabs(u), p[i] - 1), u);
    }
}

impact_spot impact_spot_at(const impact_shape *shape, const double s[3])
{
    impact_spot spot;
    double p[3], axis[3], level = 0, x[3], n[3];
    exponents_of(shape, p, axis);
    for (int i = 0; i < 3; i++) {
        part(s[i], p[i], &spot.u[i], &spot.e[i]);
        level += spot.u[i] * spot.e[i];
    }
    /* back on the surface: each u^p divided by their sum */
    const double excess = level - 1;
    for (int i = 0; i < 3; i++) {
        spot.u[i] /= 1 + excess / p[i];
        spot.e[i] /= 1 + excess * (1 - 1 / p[i]);
        const double ratio = spot.u[i] != 0 ? spot.e[i] / spot.u[i] : p[i] < 2 ? INFINITY : p[i] == 2;
        spot.slope[i] = fmin(fmax((p[i] - 1) * ratio, LEAST_SLOPE), 1 / LEAST_SLOPE);
        x[i] = axis[i] * spot.u[i];
        n[i] = p[i] * spot.e[i] / axis[i];
    }
    spot.point = (qvec3){x[0], x[1], x[2]};
    spot.normal = (qvec3){n[0], n[1], n[2]};
    spot.normal = qvec3_scale(spot.normal, 1 / qvec3_norm(spot.normal));
    return spot;
}

/* The normal m is p e/a over its length l, so that e' = (a/p)(l m' + l' m); sum p e u' = 0, u' = e'/slope, gives l'. */
impact_spot_rate impact_spot_move(const impact_shape *shape, const impact_spot *spot, qvec3 normal_rate)
{
    const double m_rate[3] = {normal_rate.x, normal_rate.y, normal_rate.z};
    double p[3], axis[3], squares = 0, turning = 0, mass = 0, x[3];
    exponents_of(shape, p, axis);
    for (int i = 0; i < 3; i++) squares += p[i] * spot->e[i] / axis[i] * (p[i] * spot->e[i] / axis[i]);
    const double length = sqrt(squares);
    for (int i = 0; i < 3; i++) {
        /* p e/slope = p u/(p - 1) */
        const double q = p[i] / (p[i] - 1);
        turning += q * spot->u[i] * axis[i] / p[i] * length * m_rate[i];
        mass += q * spot->u[i] * spot->e[i];
    }
    impact_spot_rate rate = {.creep = 0};
    for (int i = 0; i < 3; i++) {
        const double e_rate = axis[i] / p[i] * length * m_rate[i] - spot->e[i] * turning / mass;
        const double u_rate = e_rate / spot->slope[i];
        rate.s[i] = u_rate + e_rate;
        rate.creep = hypot(rate.creep, u_rate);
        x[i] = axis[i] * u_rate;
    }
    rate.point_rate = (qvec3){x[0], x[1], x[2]};
    return rate;
}
