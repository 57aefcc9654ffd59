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

/* ---- powers, to two roundings: here they are most of the cost. No branch, and series summed by halves (Estrin 1960),
 * so that a processor has several on the way at once: a third of what libm's cost. ---- */

static const double ln_2 = 0.6931471805599453, whole = 0x1.8p52; /* added and taken away: rounds to a whole number */

static inline uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline double double_of(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* x = 2^k m, sqrt(1/2) <= m < sqrt 2, and ln m = 2 artanh r, r = (m - 1)/(m + 1): of the series r^21/21 and on is left
 * out, 4e-18. Of 0, and below DBL_MIN, about -709; of what is infinite or no number about 710. */
static inline double log_of(double x)
{
    const uint64_t root = 0x3fe6a09e667f3bcd, above = bits_of(x) - root; /* of sqrt(1/2) */
    const uint64_t unit = 0x4330000000000000;                            /* of 2^52: the last bits count wholes */
    const double k = double_of(unit | (above + ((uint64_t)1024 << 52)) >> 52) - double_of(unit | 1024);
    const double m = double_of(root + (above & 0xfffffffffffff)), r = (m - 1) / (m + 1);
    const double s = r * r, s2 = s * s, s4 = s2 * s2;
    const double low = (1 / 3. + 1 / 5. * s) + (1 / 7. + 1 / 9. * s) * s2,
                 high = (1 / 11. + 1 / 13. * s) + (1 / 15. + 1 / 17. * s) * s2;
    return k * ln_2 + (2 * r + 2 * r * s * (low + high * s4 + 1 / 19. * (s4 * s4)));
}

/* e^y = 2^k e^r, |r| <= (ln 2)/2: of the series r^14/14! and on is left out, 4e-18. What r rounds by is eps |y|, and
 * |y| e^y at most 1/e of a mass of 1. Beyond +-700 as there: no point near its body has such a mass. */
static inline double exp_of(double any)
{
    const double y = -700 > any ? -700 : 700 < any ? 700 : any;
    const double rounded = y * (1 / ln_2) + whole, k = rounded - whole, r = y - k * ln_2, r2 = r * r, r4 = r2 * r2;
    const double low = (0.5 + 1 / 6. * r) + (1 / 24. + 1 / 120. * r) * r2,
                 middle = (1 / 720. + 1 / 5040. * r) + (1 / 40320. + 1 / 362880. * r) * r2,
                 high = (1 / 3628800. + 1 / 39916800. * r) + (1 / 479001600. + 1 / 6227020800. * r) * r2;
    const double power = double_of((bits_of(rounded) << 52) + ((uint64_t)1023 << 52));
    return power * (1 + (r + r2 * (low + (middle + high * r4) * r4)));
}

/* The left-hand side of a body's inequality, less 1, and the masses that it is the sum of. */
static double plain_excess(const imp_form *form, const double u[3], double mass[3])
{
    const double y[3] = {form->p[0] * log_of(u[0]), form->p[1] * log_of(u[1]), form->p[2] * log_of(u[2])};
    for (int i = 0; i < 3; i++) mass[i] = exp_of(y[i]);
    return mass[0] + mass[1] + mass[2] - 1;
}

static double round_excess(const double u[3], double mass[3])
{
    for (int i = 0; i < 3; i++) mass[i] = u[i] * u[i];
    return mass[0] + mass[1] + mass[2] - 1;
}

/* (u^p + v^p)^(t/p) by the logarithms of both: the larger's times t and that of 1 + (less/larger)^p times t/p. The
 * section's masses are in the ratio of its sum's terms, that of the larger being the whole. */
static double nested_excess(const imp_form *form, const double u[3], double mass[3])
{
    const double p = form->p[0], t = form->p[IMP_SECTION];
    const double log[3] = {log_of(u[0]), log_of(u[1]), log_of(u[2])};
    const int first = u[0] < u[1];
    const double less = exp_of(p * (log[1 - first] - log[first]));
    mass[2] = exp_of(t * log[2]);
    mass[first] = exp_of(t * log[first] + t / p * log_of(1 + less));
    mass[1 - first] = less * mass[first];
    return mass[first] + mass[2] - 1;
}

static double excess_at(const imp_form *form, const double x[3], double mass[3])
{
    const double u[3] = {fabs(x[0]) / form->axis[0], fabs(x[1]) / form->axis[1], fabs(x[2]) / form->axis[2]};
    if (form->nested) return nested_excess(form, u, mass);
    return form->p[0] == 2 && form->p[1] == 2 && form->p[2] == 2 ? round_excess(u, mass) : plain_excess(form, u, mass);
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
    double body[3], mass[3];
    turn_in(form, x, body);
    if (form->kind != IMP_FORM_QUADRIC) return imp_core_distance(form, body) - form->rounding;
    const double over = excess_at(form, body, mass);
    return over / slope_at(form, body, mass);
}

/* f(x/f(x)) <= 1, as no exponent is below 1: x is within |x| (f - 1) of the body. Mostly that is enough, and costs no
 * slope. */
bool imp_gap_holds(const imp_form *form, const double x[3], double slack)
{
    double body[3], mass[3];
    turn_in(form, x, body);
    if (form->kind != IMP_FORM_QUADRIC) return imp_core_distance(form, body) - form->rounding <= slack;
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
