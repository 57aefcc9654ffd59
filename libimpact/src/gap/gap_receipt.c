/* SPDX-License-Identifier: MIT
 *
 * What an answer of the gap can be held to without the solver: for every unit n, g(n) = n.c - h_2(n) - h_1(-n) is no
 * more than the gap, and for every two points of the bodies their distance is no less. So normal and witness points
 * are an interval with two proved ends, once the points are seen to lie in their bodies: by the bodies' inequalities,
 * which no step of the solver evaluates.
 */
#include <quat/rotation.h>
#include <float.h>
#include "base/numbers.h"
#include "gap/gap_solver.h"
#include "shape/solid.h"

/* x^p of 0 <= x <= 1, or a little over. By the logarithm it costs less than pow, and rounds by p |ln x| x^p eps, which
 * is eps/e at most: masses are told from 1. */
static double mass_of(double x, double p)
{
    if (p == 2 || p == 1) return p == 2 ? x * x : x;
    return x > 0 ? exp(p * log(x)) : 0;
}

/* The left-hand side of a body's inequality, less 1, and the masses that it is the sum of; x's and y's of a
 * superellipsoid's section are in the ratio of its sum's terms, and `sum` times too large. */
typedef struct excess {
    double over, mass[3], sum;
} excess;

static excess plain_excess(const imp_form *form, const double x[3])
{
    excess e = {.over = -1, .sum = 1};
    for (int i = 0; i < 3; i++) e.over += e.mass[i] = mass_of(fabs(x[i]) / form->axis[i], form->p[i]);
    return e;
}

/* (u^p + v^p)^(t/p) by the logarithms of both: the larger's times t and that of 1 + (less/larger)^p times t/p. */
static excess nested_excess(const imp_form *form, const double x[3])
{
    const double p = form->p[0], t = form->p[IMP_SECTION], u = fabs(x[0]) / form->axis[0],
                 v = fabs(x[1]) / form->axis[1], along = mass_of(fabs(x[2]) / form->axis[2], t);
    const bool first = u >= v;
    const double larger = log(first ? u : v), less = u + v > 0 ? exp(p * (log(first ? v : u) - larger)) : 0;
    const double sum = 1 + less, section = exp(t * larger + t / p * log(sum));
    return (excess){.over = section + along - 1,
                    .mass = {first ? section : less * section, first ? less * section : section, along},
                    .sum = sum};
}

static excess excess_at(const imp_form *form, const double body[3])
{
    return form->nested ? nested_excess(form, body) : plain_excess(form, body);
}

/* |grad f|: p_i m_i/|x_i| are the sizes of its parts. */
static double slope_at(const imp_form *form, const double x[3], const excess *e)
{
    double square = 0;
    for (int i = 0; i < 3; i++) {
        const double p = form->nested ? form->p[IMP_SECTION] : form->p[i], sum = i < 2 ? e->sum : 1;
        const double slope = x[i] != 0 ? p * e->mass[i] / (sum * x[i]) : 0;
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
    const excess e = excess_at(form, body);
    return e.over / slope_at(form, body, &e);
}

/* f(x/f(x)) <= 1, as no exponent is below 1: x is within |x| (f - 1) of the body. Mostly that is enough, and costs no
 * slope. */
bool imp_gap_holds(const imp_form *form, const double x[3], double slack)
{
    double body[3];
    turn_in(form, x, body);
    if (form->kind != IMP_FORM_QUADRIC) return imp_core_distance(form, body) - form->rounding <= slack;
    const excess e = excess_at(form, body);
    if (e.over * (fabs(x[0]) + fabs(x[1]) + fabs(x[2])) <= slack) return true;
    return e.over <= slack * slope_at(form, body, &e);
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
