/* SPDX-License-Identifier: MIT
 *
 * The place of a plane curve x = A g, z = C zeta, that reaches farthest along d, of alpha = A |d_x| and beta = C |d_z|:
 *
 *   g = 1 - zeta^t:            zeta = s^(1/(t-1)), s = beta/(t alpha), 1 at most: there is the apex
 *   g^t + zeta^t = 1:          g = 1/(1 + m^t)^(1/t),  zeta = m g,  m = (beta/alpha)^(1/(t-1));  beyond 1 the other way
 */
#include "shape/ridge.h"
#include "base/tolerances.h"

#include <math.h>

int imp_ridge_count(const impact_shape *shape)
{
    const int ones = (shape->r == 1) + (shape->s == 1) + (shape->t == 1);
    if (shape->kind == IMPACT_SUPERQUADRIC) return ones == 2 ? 6 : 0;
    if (shape->kind != IMPACT_SUPERELLIPSOID) return 0;
    return ones == 2 ? 4 : ones == 1 ? 3 : 0;
}

enum { ARCS = 4 };

/* A curve in the plane of two axes. */
typedef struct curve {
    int x, z;    /* its axes */
    double side; /* of x where it stays on one side of z; 0: a closed one, about the centre */
    double t;
    bool dual; /* g^t + zeta^t = 1 */
} curve;

static bool is_bicone(const imp_form *form) { return form->nested && form->p[IMP_SECTION] == 1; }

static curve curve_of(const imp_form *form, int feature)
{
    if (is_bicone(form)) return (curve){.x = 0, .z = 1, .t = form->p[0], .dual = true};
    int z = 2;
    for (int i = 0; i < 3; i++)
        if (!form->nested && form->p[i] > 1) z = i;
    return (curve){.x = (z + 1 + feature / 2) % 3,
                   .z = z,
                   .side = feature % 2 == 0 ? -1 : 1,
                   .t = form->nested ? form->p[IMP_SECTION] : form->p[z],
                   .dual = form->nested};
}

/* g and zeta, and their rates by the logarithm of beta/alpha. */
typedef struct curve_place {
    double g, zeta, g_rate, zeta_rate;
} curve_place;

static curve_place place_on(const curve *c, double alpha, double beta, double end)
{
    const double t = c->t;
    if (!(alpha > 0)) return (curve_place){.g = 0, .zeta = 1};
    if (!c->dual) {
        const double zeta = pow(beta / (t * alpha), 1 / (t - 1));
        if (!(zeta < end)) return (curve_place){.g = 1 - pow(end, t), .zeta = end};
        const double rate = zeta / (t - 1);
        return (curve_place){1 - pow(zeta, t), zeta, -t * pow(zeta, t - 1) * rate, rate};
    }
    const bool beyond = beta > alpha; /* m: the smaller of g and zeta over the larger */
    const double m = pow(beyond ? alpha / beta : beta / alpha, 1 / (t - 1)), mt = pow(m, t);
    const double large = pow(1 + mt, -1 / t), small = m * large,
                 rate = (beyond ? -1 : 1) * small / ((t - 1) * (1 + mt));
    const double large_rate = -pow(m, t - 1) * rate;
    return beyond ? (curve_place){small, large, rate, large_rate} : (curve_place){large, small, large_rate, rate};
}

/* Along the curve's axes: alpha with its sign, beta, and the sides on which the place is. A direction that is level but
 * for rounding is level: over a flat place that would lead to some end of it. */
typedef struct curve_view {
    double alpha, beta, side, up;
} curve_view;

static curve_view view_of_curve(const imp_form *form, const curve *c, const double d[3])
{
    const double side = c->side != 0 ? c->side : copysign(1, d[c->x]);
    return (curve_view){form->axis[c->x] * side * d[c->x],
                        fabs(d[c->z]) > IMP_LEVEL ? form->axis[c->z] * fabs(d[c->z]) : 0, side, copysign(1, d[c->z])};
}

static int curved_axis(const imp_form *form) { return is_bicone(form) ? 2 : curve_of(form, 0).z; }

bool imp_ridge_is_apex(const imp_form *form, int feature) { return feature >= (is_bicone(form) ? 1 : ARCS); }

/* The apex on the side of d. */
static int apex_along(const imp_form *form, const double d[3])
{
    return (is_bicone(form) ? 1 : ARCS) + (d[curved_axis(form)] > 0);
}

/* s of an arc that ends in a sharp apex. */
static double turned(const imp_form *form, int feature, const double d[3])
{
    const curve c = curve_of(form, feature);
    const curve_view v = view_of_curve(form, &c, d);
    return v.alpha > 0 ? v.beta / (c.t * v.alpha) : INFINITY;
}

void imp_ridge_facing(const imp_form *form, qvec3 direction, int feature[2])
{
    const double d[3] = {direction.x, direction.y, direction.z};
    for (int k = 0; k < 2; k++) feature[k] = 2 * k + (d[curve_of(form, 2 * k).x] > 0);
    if (is_bicone(form)) feature[0] = 0, feature[1] = apex_along(form, d);
    if (form->nested) return;
    const double s[2] = {turned(form, feature[0], d), turned(form, feature[1], d)};
    const int farther = s[1] < s[0];
    if (s[1 - farther] >= 1) feature[1 - farther] = s[farther] < 1 ? feature[farther] : apex_along(form, d);
    if (s[farther] >= 1) feature[farther] = apex_along(form, d);
}

/* The arc that is first to take over from an apex. */
static int least_turned(const imp_form *form, const double d[3])
{
    int first = 0;
    for (int k = 1; k < ARCS; k++)
        if (turned(form, k, d) < turned(form, first, d)) first = k;
    return first;
}

double imp_ridge_room(const imp_form *form, int feature, qvec3 direction)
{
    const double d[3] = {direction.x, direction.y, direction.z}, length = form->axis[curved_axis(form)];
    if (form->nested) return INFINITY;
    if (!imp_ridge_is_apex(form, feature)) return length * (1 - turned(form, feature, d));
    return length * (turned(form, least_turned(form, d), d) - 1);
}

/* How s = beta/(t alpha) grows where it is 1: the sign of (beta/t - alpha)'. */
static double turns_on(const imp_form *form, int arc, const double d[3], const double rate[3])
{
    const curve c = curve_of(form, arc);
    return copysign(form->axis[c.z], d[c.z]) * rate[c.z] / c.t - form->axis[c.x] * c.side * rate[c.x];
}

int imp_ridge_ahead(const imp_form *form, int feature, qvec3 direction, qvec3 direction_rate, double within)
{
    const double d[3] = {direction.x, direction.y, direction.z},
                 rate[3] = {direction_rate.x, direction_rate.y, direction_rate.z};
    if (!(imp_ridge_room(form, feature, direction) <= within)) return feature;
    if (!imp_ridge_is_apex(form, feature)) return turns_on(form, feature, d, rate) > 0 ? apex_along(form, d) : feature;
    const int arc = least_turned(form, d);
    return turns_on(form, arc, d, rate) < 0 ? arc : feature;
}

static qvec3 apex_place(const imp_form *form, int feature)
{
    const int z = curved_axis(form);
    double x[3] = {0, 0, 0};
    x[z] = feature == ARCS || (is_bicone(form) && feature == 1) ? -form->axis[z] : form->axis[z];
    return (qvec3){x[0], x[1], x[2]};
}

qvec3 imp_ridge_place(const imp_form *form, int feature, qvec3 direction, double end)
{
    const double d[3] = {direction.x, direction.y, direction.z};
    double x[3] = {0, 0, 0};
    if (imp_ridge_is_apex(form, feature)) return apex_place(form, feature);
    const curve c = curve_of(form, feature);
    const curve_view v = view_of_curve(form, &c, d);
    const curve_place p = place_on(&c, v.alpha, v.beta, end);
    x[c.x] = v.side * form->axis[c.x] * p.g;
    x[c.z] = v.up * form->axis[c.z] * p.zeta;
    return (qvec3){x[0], x[1], x[2]};
}

/* With an exponent over 2 the curve is straight at its axes, and the place runs without bound as it comes by: a ratio
 * under a rounding is one. */
qvec3 imp_ridge_rate(const imp_form *form, int feature, qvec3 direction, qvec3 direction_rate, double end)
{
    const double d[3] = {direction.x, direction.y, direction.z},
                 rate[3] = {direction_rate.x, direction_rate.y, direction_rate.z};
    double x[3] = {0, 0, 0};
    if (imp_ridge_is_apex(form, feature)) return (qvec3){0, 0, 0};
    const curve c = curve_of(form, feature);
    const curve_view v = view_of_curve(form, &c, d);
    if (c.side != 0 && !(v.alpha > 0)) return (qvec3){0, 0, 0};
    const double alpha = fmax(v.alpha, IMP_ROUNDOFF * v.beta), beta = fmax(v.beta, IMP_ROUNDOFF * alpha);
    if (!(alpha > 0)) return (qvec3){0, 0, 0};
    const curve_place p = place_on(&c, alpha, beta, end);
    const double turns = v.up * form->axis[c.z] * rate[c.z] / beta - v.side * form->axis[c.x] * rate[c.x] / alpha;
    x[c.x] = v.side * form->axis[c.x] * p.g_rate * turns;
    x[c.z] = v.up * form->axis[c.z] * p.zeta_rate * turns;
    return (qvec3){x[0], x[1], x[2]};
}
