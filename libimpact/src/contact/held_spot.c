/* SPDX-License-Identifier: MIT */
#include "contact/held_spot.h"
#include "shape/ridge.h"
#include "shape/solid.h"
#include "shape/support.h"

static bool is_nested(const impact_shape *shape)
{
    return shape->kind == IMPACT_SUPERELLIPSOID && shape->r != shape->t;
}

bool imp_spot_suits(const imp_world *world, const imp_pair *pair)
{
    const impact_shape *shape = &world->bodies[pair->body1].shape;
    if (world->bodies[pair->body2].shape.kind != IMPACT_PLANE) return false;
    if (shape->kind != IMPACT_SUPERQUADRIC && shape->kind != IMPACT_SUPERELLIPSOID) return false;
    const bool has_edges = imp_ridge_count(shape) > 0 || imp_is_octahedron(shape);
    return !has_edges && (shape->r != 2 || shape->s != 2 || shape->t != 2);
}

/* The x >= 0 of x + x^n = s, n >= 1, s >= 0: Newton from above falls monotonically. */
static double split(double s, double n)
{
    double x = s > 1 ? pow(s, 1 / n) : s;
    for (int i = 0; i < 60; i++) {
        const double power = pow(x, n - 1), step = (x + x * power - s) / (1 + n * power);
        x -= step;
        if (!(step > IMP_SPOT_STEP * x)) break;
    }
    return fmax(x, 0);
}

/* u and e of one axis from s; of p = 1 u is 0 on the edge, and e is 1 beside it. */
static void part(double s, double p, double *u, double *e)
{
    const double size = fabs(s);
    if (p == 1) {
        *u = copysign(fmax(size - 1, 0), s);
        *e = copysign(fmin(size, 1), s);
        return;
    }
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

/* e/u stands off 0 and infinity. */
static double ratio_of(double e, double u, double p)
{
    const double ratio = u != 0 ? e / u : p < 2 ? INFINITY : p == 2;
    return fmin(fmax(ratio, IMP_SPOT_LEAST_SLOPE), 1 / IMP_SPOT_LEAST_SLOPE);
}

/* ---- superellipsoids of two exponents: the section x, y ---- */

/* The x >= 0 of x + b x^n = s, n >= 1, s >= 0: Newton from above falls monotonically. */
static double split_weighted(double s, double b, double n)
{
    double x = fmin(s, pow(s / b, 1 / n));
    for (int i = 0; i < 200; i++) {
        const double power = b * pow(x, n - 1), step = (x + x * power - s) / (1 + n * power);
        x -= step;
        if (!(step > IMP_SPOT_STEP * x)) break;
    }
    return fmax(x, 0);
}

/* v + b v^(r-1) = s; e = v^(r-1). */
static void section_part(double s, double b, double r, double *v, double *e)
{
    if (r >= 2) {
        *v = split_weighted(s, b, r - 1);
        *e = pow(*v, r - 1);
    } else {
        *e = split_weighted(s / b, 1 / b, 1 / (r - 1));
        *v = pow(*e, 1 / (r - 1));
    }
}

/* v = u/K, e and K^(t-1), told, of the section so near the pole that K v is nothing beside s = K v + K^(t-1) e: sum
 * v^r = 1 gives K^(t-1), the norm of s of the exponent r/(r-1). */
static double section_at_pole(const double s[2], double r, double v[2], double e[2])
{
    const double dual = r / (r - 1), most = fmax(s[0], s[1]), least = fmin(s[0], s[1]),
                 weight = most * pow(1 + pow(least / most, dual), 1 / dual);
    for (int j = 0; j < 2; j++) e[j] = s[j] / weight, v[j] = pow(e[j], 1 / (r - 1));
    return weight;
}

/* v = u/K, e and K of the section from s = K v + K^(t-1) e, both v >= 0 and sum v^r = 1; K^(t-1) is told. That sum
 * falls with K: Newton in log K, within what is known of it. */
static double section_of(const double s[2], double r, double t, double v[2], double e[2], double *told)
{
    double k, other, low = 0, high = INFINITY;
    *told = section_at_pole(s, r, v, e);
    part(*told, t, &k, &other); /* K + K^(t-1) is that norm, but for that of v */
    if (k < IMP_ROUNDOFF * IMP_ROUNDOFF * *told) return k;
    for (int i = 0; i < 60; i++) {
        const double weight = pow(k, t - 2);
        double sum = 0, slope = 0;
        for (int j = 0; j < 2; j++) {
            section_part(s[j] / k, weight, r, &v[j], &e[j]);
            const double bent = fmin(weight * ratio_of(e[j], v[j], r), IMP_SPOT_MOST_BENT);
            sum += v[j] * e[j];
            slope += r * v[j] * e[j] * (1 + (t - 1) * bent) / (1 + (r - 1) * bent);
        }
        const double step = log(sum) * sum / slope;
        if (sum > 1)
            low = k;
        else
            high = k;
        if (fabs(step) <= 4 * IMP_SPOT_STEP) break;
        const double next = k * exp(step);
        k = next > low && next < high ? next : high < INFINITY ? 0.5 * (low + high) : 2 * k;
    }
    *told = pow(k, t - 1);
    return k;
}

/* Where s stands at the pole, any section will do. */
static void nested_section(const impact_shape *shape, const double s[3], imp_spot *spot)
{
    const double size[2] = {fabs(s[0]), fabs(s[1])}, r = shape->r, t = shape->t;
    double v[2], e[2], k = 0, weight = 0; /* K^(t-1) */
    if (fmax(size[0], size[1]) > IMP_SPOT_LEAST_SLOPE) {
        k = section_of(size, r, t, v, e, &weight);
    } else {
        v[0] = v[1] = pow(0.5, 1 / r);
        e[0] = e[1] = 0.5 / v[0];
    }
    spot->k_ratio = ratio_of(weight, k, t);
    for (int i = 0; i < 2; i++) {
        spot->section[i] = copysign(v[i], s[i]);
        spot->slope[i] = (r - 1) * ratio_of(e[i], v[i], r);
        spot->u[i] = copysign(k * v[i], s[i]);
        spot->e[i] = copysign(weight * e[i], s[i]);
    }
}

/* ---- spots ---- */

void imp_spot_find(const impact_shape *shape, qvec3 normal, double s[3])
{
    const double d[3] = {normal.x, normal.y, normal.z};
    imp_form form;
    imp_surface surface;
    imp_form_make(shape, 1, quat_identity(), &form);
    imp_form_support(&form, d, &surface);
    const double k = form.nested ? surface.u[IMP_SECTION] : 1, ek = form.nested ? surface.e[IMP_SECTION] : 1;
    for (int i = 0; i < 2; i++) s[i] = k * surface.u[i] + ek * surface.e[i];
    s[2] = surface.u[2] + surface.e[2];
}

void imp_spot_on(const impact_shape *shape, qvec3 point, double s[3])
{
    double p[3], axis[3], size = 1;
    exponents_of(shape, p, axis);
    const double u[3] = {point.x / axis[0], point.y / axis[1], point.z / axis[2]};
    if (is_nested(shape)) {
        const double k = pow(pow(fabs(u[0]), p[0]) + pow(fabs(u[1]), p[0]), 1 / p[0]);
        size = k > 0 ? pow(k, p[2] - p[0]) : 0;
    }
    for (int i = 0; i < 3; i++) s[i] = u[i] + copysign((i < 2 ? size : 1) * pow(fabs(u[i]), p[i] - 1), u[i]);
}

imp_spot imp_spot_at(const impact_shape *shape, const double s[3])
{
    imp_spot spot = {.k_ratio = 1};
    double p[3], axis[3], level = 0, x[3], n[3];
    const bool nested = is_nested(shape);
    exponents_of(shape, p, axis);
    if (nested) nested_section(shape, s, &spot);
    for (int i = nested ? 2 : 0; i < 3; i++) {
        part(s[i], p[i], &spot.u[i], &spot.e[i]);
        spot.slope[i] = (p[i] - 1) * ratio_of(spot.e[i], spot.u[i], p[i]);
    }
    for (int i = 0; i < 3; i++) level += spot.u[i] * spot.e[i];
    /* back on the surface: each u^p divided by their sum */
    const double excess = level - 1;
    for (int i = 0; i < 3; i++) {
        const double own = nested ? p[2] : p[i];
        spot.u[i] /= 1 + excess / own;
        spot.e[i] /= 1 + excess * (1 - 1 / own);
        x[i] = axis[i] * spot.u[i];
        n[i] = (nested ? 1 : p[i]) * spot.e[i] / axis[i];
    }
    spot.point = (qvec3){x[0], x[1], x[2]};
    spot.normal = (qvec3){n[0], n[1], n[2]};
    spot.normal = qvec3_scale(spot.normal, 1 / qvec3_norm(spot.normal));
    return spot;
}

/* With H the Hessian of K^t/t along x and y, H = K^(t-2) ((r-1) diag |v|^(r-2) + (t-r) e e^T), e = |v|^(r-1): u' = H^-1
 * e'. */
static void section_rates(const impact_shape *shape, const imp_spot *spot, const double e_rate[2], double u_rate[2])
{
    const double r = shape->r, t = shape->t, turn = spot->section[0] * e_rate[0] + spot->section[1] * e_rate[1];
    for (int i = 0; i < 2; i++)
        u_rate[i] =
            (e_rate[i] / spot->slope[i] - (t - r) / ((t - 1) * (r - 1)) * turn * spot->section[i]) / spot->k_ratio;
}

/* With l the length of the normal m = p e/(a l), e' = (a/p)(l m' + l' m). Of superellipsoids m is e/a over its length;
 * e is homogeneous in (x, y) and in z alike, and sum e u' = 0 is sum u e' = 0. */
typedef struct spot_turn {
    double axis[3], p[3]; /* axis: a/p */
    double m_rate[3], length, e_rate[3], u_rate[3];
} spot_turn;

static spot_turn turn_of_spot(const impact_shape *shape, const imp_spot *spot, qvec3 normal_rate)
{
    spot_turn t = {.m_rate = {normal_rate.x, normal_rate.y, normal_rate.z}};
    double squares = 0;
    exponents_of(shape, t.p, t.axis);
    for (int i = 0; i < 3; i++) {
        if (!is_nested(shape)) t.axis[i] /= t.p[i];
        squares += spot->e[i] / t.axis[i] * (spot->e[i] / t.axis[i]);
    }
    t.length = sqrt(squares);
    return t;
}

/* From l'/l; u' = e'/slope. */
static void stretch_turn(const imp_spot *spot, double stretch, spot_turn *t)
{
    for (int i = 0; i < 3; i++) {
        t->e_rate[i] = t->axis[i] * t->length * t->m_rate[i] + spot->e[i] * stretch;
        t->u_rate[i] = t->p[i] > 1 ? t->e_rate[i] / spot->slope[i] : 0;
    }
}

/* Beside the edge of an exponent of 1 its own e stays, which gives l'/l, and u' is what sum p e u' = 0 leaves. */
static void turn_beside(const imp_spot *spot, int sharp, spot_turn *t)
{
    double sum = 0;
    stretch_turn(spot, -t->axis[sharp] * t->length * t->m_rate[sharp] / spot->e[sharp], t);
    for (int i = 0; i < 3; i++) sum += t->p[i] * spot->e[i] * t->u_rate[i];
    t->e_rate[sharp] = 0;
    t->u_rate[sharp] = -sum / spot->e[sharp];
}

/* sum p e u' = 0 gives l'/l: p e/slope is p u/(p - 1). */
static void turn_smoothly(const impact_shape *shape, const imp_spot *spot, spot_turn *t)
{
    double turning = 0, mass = 0;
    for (int i = 0; i < 3; i++) {
        const double q = is_nested(shape) ? 1 : t->p[i] > 1 ? t->p[i] / (t->p[i] - 1) : 0;
        turning += q * spot->u[i] * t->axis[i] * t->length * t->m_rate[i];
        mass += q * spot->u[i] * spot->e[i];
    }
    stretch_turn(spot, -turning / mass, t);
    if (is_nested(shape)) section_rates(shape, spot, t->e_rate, t->u_rate);
}

imp_spot_rate imp_spot_move(const impact_shape *shape, const imp_spot *spot, qvec3 normal_rate)
{
    spot_turn t = turn_of_spot(shape, spot, normal_rate);
    int beside = -1;
    for (int i = 0; i < 3; i++)
        if (t.p[i] == 1 && spot->u[i] != 0) beside = i;
    if (beside >= 0)
        turn_beside(spot, beside, &t);
    else
        turn_smoothly(shape, spot, &t);
    imp_spot_rate rate = {.point_speed = hypot(t.u_rate[0], hypot(t.u_rate[1], t.u_rate[2]))};
    for (int i = 0; i < 3; i++) rate.s[i] = t.u_rate[i] + t.e_rate[i];
    rate.point_rate = (qvec3){shape->a * t.u_rate[0], shape->b * t.u_rate[1], shape->c * t.u_rate[2]};
    return rate;
}
