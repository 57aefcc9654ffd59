/* SPDX-License-Identifier: MIT
 *
 * What an answer of the gap can be held to without the solver: for every unit n, g(n) = n.c - h_2(n) - h_1(-n) is no
 * more than the gap, and for every two points of the bodies their distance is no less. So normal and witness points
 * are an interval with two proved ends, once the points are seen to lie in their bodies: by the bodies' inequalities,
 * which no step of the solver evaluates.
 */
#include <quat/rotation.h>
#include <float.h>
#include <stdint.h>
#include <string.h>
#include "base/numbers.h"
#include "gap/gap_solver.h"
#include "shape/solid.h"

/* ---- powers, to two roundings: inlined they cost half of what libm's do, and here they are most of the cost ---- */

static const double ln_2 = 0.6931471805599453, whole = 0x1.8p52; /* added and taken away: rounds to a whole number */

/* ln x = k ln 2 + ln m, sqrt(1/2) <= m < sqrt 2, and ln m = 2 artanh r, r = (m - 1)/(m + 1): of the series r^21/21 and
 * on is left out, 4e-18. */
static inline double log_of(double x)
{
    if (!(x >= DBL_MIN && x <= DBL_MAX)) return x >= 0 ? (x < 1 ? -INFINITY : INFINITY) : NAN;
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    const uint64_t root = 0x3fe6a09e667f3bcd, above = bits - root; /* of sqrt(1/2) */
    const double k = (double)((int64_t)above >> 52);
    bits = root + (above & 0xfffffffffffff);
    double m;
    memcpy(&m, &bits, sizeof m);
    const double r = (m - 1) / (m + 1), s = r * r;
    double sum = 1 / 19.;
    sum = sum * s + 1 / 17.;
    sum = sum * s + 1 / 15.;
    sum = sum * s + 1 / 13.;
    sum = sum * s + 1 / 11.;
    sum = sum * s + 1 / 9.;
    sum = sum * s + 1 / 7.;
    sum = sum * s + 1 / 5.;
    sum = sum * s + 1 / 3.;
    return k * ln_2 + (2 * r + 2 * r * s * sum);
}

/* e^y = 2^k e^r, |r| <= (ln 2)/2: of the series r^14/14! and on is left out, 4e-18. What r rounds by is eps |y|, and
 * |y| e^y at most 1/e of a mass of 1. */
static inline double exp_of(double y)
{
    if (!(y > -700 && y < 700)) return y < 0 ? 0 : y > 0 ? INFINITY : NAN;
    const double k = y * (1 / ln_2) + whole - whole, r = y - k * ln_2;
    double sum = 1 / 6227020800.;
    sum = sum * r + 1 / 479001600.;
    sum = sum * r + 1 / 39916800.;
    sum = sum * r + 1 / 3628800.;
    sum = sum * r + 1 / 362880.;
    sum = sum * r + 1 / 40320.;
    sum = sum * r + 1 / 5040.;
    sum = sum * r + 1 / 720.;
    sum = sum * r + 1 / 120.;
    sum = sum * r + 1 / 24.;
    sum = sum * r + 1 / 6.;
    sum = sum * r + 0.5;
    const uint64_t bits = (uint64_t)(1023 + (int64_t)k) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power * (1 + (r + r * r * sum));
}

/* x^p, x >= 0. */
static inline double mass_of(double x, double p)
{
    if (p == 2 || p == 1) return p == 2 ? x * x : x;
    return exp_of(p * log_of(x));
}

/* The masses that the left-hand side of a body's inequality is the sum of. A superellipsoid's section is told by x's
 * and y's in the ratio of its sum's terms, that of the larger being the whole. */
static double plain_excess(const imp_form *form, const double x[3], double mass[3])
{
    double over = -1;
    for (int i = 0; i < 3; i++) over += mass[i] = mass_of(fabs(x[i]) / form->axis[i], form->p[i]);
    return over;
}

/* (u^p + v^p)^(t/p) by the logarithms of both: the larger's times t and that of 1 + (less/larger)^p times t/p. */
static double nested_excess(const imp_form *form, const double x[3], double mass[3])
{
    const double p = form->p[0], t = form->p[IMP_SECTION], u = fabs(x[0]) / form->axis[0],
                 v = fabs(x[1]) / form->axis[1];
    const int first = u < v;
    const double larger = log_of(first ? v : u), less = u + v > 0 ? exp_of(p * (log_of(first ? u : v) - larger)) : 0;
    mass[first] = exp_of(t * larger + t / p * log_of(1 + less));
    mass[1 - first] = less * mass[first];
    mass[2] = mass_of(fabs(x[2]) / form->axis[2], t);
    return mass[first] + mass[2] - 1;
}

/* The left-hand side of a body's inequality, less 1. */
static double excess_at(const imp_form *form, const double body[3], double mass[3])
{
    return form->nested ? nested_excess(form, body, mass) : plain_excess(form, body, mass);
}

/* |grad f|: p_i m_i/|x_i| are the sizes of its parts, of a section over its sum. */
static double slope_at(const imp_form *form, const double x[3], const double mass[3])
{
    const double section = fmax(mass[0], mass[1]), part = section > 0 ? section / (mass[0] + mass[1]) : 1;
    double square = 0;
    for (int i = 0; i < 3; i++) {
        const double p = form->nested ? form->p[IMP_SECTION] : form->p[i];
        const double slope = x[i] != 0 ? p * mass[i] / x[i] * (form->nested && i < 2 ? part : 1) : 0;
        square += slope * slope;
    }
    return sqrt(square);
}

static void turn_in(const imp_form *form, const double x[3], double body[3])
{
    for (int i = 0; i < 3; i++)
        body[i] = form->rotation[0][i] * x[0] + form->rotation[1][i] * x[1] + form->rotation[2][i] * x[2];
}

double imp_gap_outside(const imp_form *form, const double x[3])
{
    double body[3];
    turn_in(form, x, body);
    if (form->kind != IMP_FORM_QUADRIC) return imp_core_distance(form, body) - form->rounding;
    double mass[3];
    const double over = excess_at(form, body, mass);
    return over / slope_at(form, body, mass);
}

/* f(x/f(x)) <= 1, as no exponent is below 1: x is within |x| (f - 1) of the body. Mostly that is enough, and costs no
 * slope. */
bool imp_gap_holds(const imp_form *form, const double x[3], double slack)
{
    double body[3];
    turn_in(form, x, body);
    if (form->kind != IMP_FORM_QUADRIC) return imp_core_distance(form, body) - form->rounding <= slack;
    double mass[3];
    const double over = excess_at(form, body, mass);
    if (over * (fabs(x[0]) + fabs(x[1]) + fabs(x[2])) <= slack) return true;
    return over < INFINITY && over <= slack * slope_at(form, body, mass);
}

/* ---- of a contact, for anyone ---- */

/* h(d) about the body's position, d world and unit; a plane's where d is its normal but for rounding, which *off is. */
static double height_of(const impact_solid *body, qvec3 d, double *off)
{
    const qvec3 inside = quat_rotate_inverse(quat_unit(body->orientation), d);
    if (body->shape.kind != IMPACT_PLANE) return impact_shape_support(&body->shape, inside, NULL);
    *off = fmax(*off, qvec3_norm(qvec3_sub(inside, (qvec3){0, 0, 1})));
    return 0;
}

static double outside_of(const impact_solid *body, qvec3 offset)
{
    const qvec3 x = quat_rotate_inverse(quat_unit(body->orientation), offset);
    if (body->shape.kind == IMPACT_PLANE) return x.z;
    const double scale = ldexp(1, -ilogb(fmax(body->shape.a, fmax(body->shape.b, body->shape.c))));
    const double scaled[3] = {scale * x.x, scale * x.y, scale * x.z};
    imp_form form;
    imp_form_make(&body->shape, scale, quat_identity(), &form);
    return imp_gap_outside(&form, scaled) / scale;
}

/* NaN stays. */
static double excess_of(double x) { return x <= 0 ? 0 : x; }

static double size_of(const impact_solid *body)
{
    return body->shape.kind == IMPACT_PLANE ? 0 : fmax(body->shape.a, fmax(body->shape.b, body->shape.c));
}

double impact_gap_receipt(const impact_solid *body1, const impact_solid *body2, const impact_contact *contact,
                          impact_gap_residuals *residuals)
{
    const qvec3 c = qvec3_sub(body1->position, body2->position), n = contact->normal;
    const double unit = DBL_EPSILON * (fmax(size_of(body1), size_of(body2)) + qvec3_norm(c));
    impact_gap_residuals r = {.normal = fabs(qvec3_norm(n) - 1)};
    const double lower = qvec3_dot(n, c) - height_of(body2, n, &r.normal) - height_of(body1, qvec3_neg(n), &r.normal);
    const qvec3 v = qvec3_sub(qvec3_add(c, contact->offset1), contact->offset2);
    r.normal /= DBL_EPSILON;
    r.dual = fabs(contact->lower - lower) / unit;
    const double along = qvec3_dot(n, v), apart = qvec3_norm(v);
    r.primal = excess_of((contact->gap > 0 ? apart : along) - contact->upper);
    if (!(contact->gap > 0)) r.primal += excess_of(contact->lower - along);
    r.primal /= unit;
    r.order = (excess_of(contact->lower - contact->gap) + excess_of(contact->gap - contact->upper)) / unit;
    r.inside1 = excess_of(outside_of(body1, contact->offset1)) / unit;
    r.inside2 = excess_of(outside_of(body2, contact->offset2)) / unit;
    if (residuals) *residuals = r;
    const double all[6] = {r.normal, r.dual, r.primal, r.order, r.inside1, r.inside2};
    double worst = 0;
    for (int i = 0; i < 6; i++) worst = imp_worse(worst, all[i]);
    return isnan(worst) ? INFINITY : worst;
}
