/* SPDX-License-Identifier: MIT
 *
 * Support functions are dual norms. With independent exponents the multiplier lambda solves
 * sum (w_i/(p_i lambda))^(q_i) = 1, w_i = A_i |d_i|, q_i = p_i/(p_i - 1): convex and decreasing in log lambda.
 */
#include "shape/support.h"
#include <quat/rotation.h>
#include "base/tolerances.h"
#include "shape/solid.h"

/* ---- forms ---- */

const impact_hull *imp_core_hull(const impact_shape *shape)
{
    switch (shape->kind) {
    case IMPACT_SPHERE: return &imp_hull_point;
    case IMPACT_CAPSULE: return &imp_hull_segment;
    case IMPACT_BOX: return &imp_hull_box;
    case IMPACT_SUPERQUADRIC: return &imp_hull_octahedron;
    default: return shape->hull;
    }
}

static void make_core(const impact_shape *shape, double scale, imp_form *form)
{
    static const imp_form_kind kinds[IMPACT_SHAPE_KINDS] = {[IMPACT_BOX] = IMP_FORM_BOX,
                                                            [IMPACT_CYLINDER] = IMP_FORM_CYLINDER,
                                                            [IMPACT_CONE] = IMP_FORM_CONE,
                                                            [IMPACT_CAPSULE] = IMP_FORM_POLYTOPE,
                                                            [IMPACT_POLYHEDRON] = IMP_FORM_POLYTOPE};
    *form = (imp_form){.kind = kinds[shape->kind],
                       .p = {2, 2, 2, 2},
                       .base = shape->base * scale,
                       .rounding = shape->rounding * scale};
    imp_core_axes(shape, form->axis);
    for (int k = 0; k < 3; k++) form->axis[k] *= scale;
    form->core = (imp_core){.hull = imp_core_hull(shape), .even = shape->kind == IMPACT_POLYHEDRON};
    for (int k = 0; k < 3; k++) form->core.axis[k] = form->core.even ? scale : form->axis[k];
}

void imp_form_make(const impact_shape *shape, double scale, quat orientation, imp_form *form)
{
    if (imp_has_core(shape)) {
        make_core(shape, scale, form);
        imp_form_turn(form, orientation);
        return;
    }
    *form = (imp_form){.nested = shape->kind == IMPACT_SUPERELLIPSOID && shape->r != shape->t,
                       .axis = {shape->a * scale, shape->b * scale, shape->c * scale},
                       .p = {shape->r, shape->s, shape->t, shape->t}};
    form->uniform = !form->nested && shape->r == shape->s && shape->s == shape->t;
    form->round = form->uniform && shape->r == 2;
    imp_form_turn(form, orientation);
}

void imp_form_turn(imp_form *form, quat orientation)
{
    const qmat3 m = quat_to_matrix(orientation);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) form->rotation[i][j] = m.m[i][j];
}

/* ---- equal exponents: weights w[n] >= 0, not all zero ---- */

static double dual_norm_2(int n, const double *w, double *u)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += w[i] * w[i];
    const double h = sqrt(sum), inverse = 1 / h;
    for (int i = 0; i < n; i++) u[i] = w[i] * inverse;
    return h;
}

static double dual_norm_1(int n, const double *w, double *u)
{
    int best = 0;
    for (int i = 0; i < n; i++) {
        u[i] = 0;
        if (w[i] > w[best]) best = i;
    }
    u[best] = 1;
    return w[best];
}

/* (sum w^q)^(1/q), 1/p + 1/q = 1, and the unit vector u of norm p that reaches it; e = u^(p-1) = w/h. */
static double dual_norm(int n, const double *w, double p, double *u, double *e)
{
    double largest = 0, h;
    for (int i = 0; i < n; i++) largest = fmax(largest, w[i]);
    if (!(largest > 0)) { /* any point will do */
        for (int i = 0; i < n; i++) u[i] = e[i] = 0;
        u[0] = e[0] = 1;
        return 0;
    }
    if (p == 2) {
        h = dual_norm_2(n, w, u);
    } else if (p == 1) {
        h = dual_norm_1(n, w, u);
    } else {
        const double q1 = 1 / (p - 1), q = p * q1; /* q - 1, q */
        double sum = 0, power[3];
        for (int i = 0; i < n; i++) {
            power[i] = w[i] == largest ? 1 : pow(w[i] / largest, q1);
            sum += power[i] * (w[i] / largest);
        }
        const double stretch = pow(sum, 1 / q), shrink = pow(sum, -1 / p);
        h = largest * stretch;
        for (int i = 0; i < n; i++) u[i] = power[i] * shrink;
    }
    for (int i = 0; i < n; i++) e[i] = w[i] / h;
    return h;
}

/* ---- independent exponents ---- */

/* log lambda from the axes with p > 1; a_i = log(w_i/p_i), skipped where -inf. */
static double log_multiplier(int n, const double *a, const double *q)
{
    double l = -INFINITY;
    for (int i = 0; i < n; i++) l = fmax(l, a[i]);
    for (int k = 0; k < 60; k++) {
        double sum = 0, slope = 0, bend = 0;
        for (int i = 0; i < n; i++) {
            const double mass = exp(q[i] * (a[i] - l));
            sum += mass;
            slope += q[i] * mass;
            bend += q[i] * q[i] * mass;
        }
        /* Halley on F = log sum: F' = -slope/sum, F'' = bend/sum - (slope/sum)^2 */
        const double f = log(sum), f1 = -slope / sum, f2 = bend / sum - f1 * f1;
        const double newton = -f / f1, halley = newton / (1 + 0.5 * newton * f2 / f1);
        const double step = halley > 0 && halley <= 2 * fabs(newton) ? halley : newton;
        l += step;
        if (fabs(step) < IMP_MULTIPLIER_STEP * (1 + fabs(l))) break;
    }
    return l;
}

/* Weights scaled so that the largest is 1. */
static double mixed_dual_norm(const double *p, const double *w, double *u, double *e)
{
    double a[3], q[3], largest_sharp = 0;
    int index[3], n = 0, sharp = -1;
    for (int i = 0; i < 3; i++) {
        u[i] = e[i] = 0;
        if (p[i] - 1 < IMP_SHARP_EXPONENT) { /* an edge or vertex of slope 1 */
            if (w[i] > largest_sharp) largest_sharp = w[i], sharp = i;
        } else if (w[i] > 0) {
            index[n] = i;
            a[n] = log(w[i] / p[i]);
            q[n++] = p[i] / (p[i] - 1);
        }
    }
    double lambda = largest_sharp, spent = 0;
    if (n > 0) {
        double at_sharp = 2; /* the sum at log(largest_sharp): above 1, the root lies beyond */
        if (sharp >= 0) {
            at_sharp = 0;
            for (int k = 0; k < n; k++) at_sharp += exp(q[k] * (a[k] - log(lambda)));
        }
        if (at_sharp > 1) lambda = exp(log_multiplier(n, a, q)), sharp = -1;
    }
    /* when all of the unit lies on smooth axes it is made exact by a last step in log lambda: q may be large */
    const double log_lambda = log(lambda);
    double rest = 0;
    if (sharp < 0) {
        double sum = -1, slope = 0;
        for (int k = 0; k < n; k++) {
            const double mass = exp(q[k] * (a[k] - log_lambda));
            sum += mass;
            slope += q[k] * mass;
        }
        rest = sum / slope;
    }
    for (int k = 0; k < n; k++) {
        const int i = index[k];
        u[i] = exp((a[k] - log_lambda - rest) / (p[i] - 1));
        e[i] = w[i] / (p[i] * lambda);
        spent += u[i] * e[i];
    }
    for (int i = 0; i < 3; i++)
        if (p[i] - 1 < IMP_SHARP_EXPONENT) e[i] = w[i] / lambda;
    if (sharp >= 0) u[sharp] = fmax(0, 1 - spent);
    /* stationary in lambda: h = lambda (1 + sum (p - 1) u^p) */
    double h = 1;
    for (int k = 0; k < n; k++) h += (p[index[k]] - 1) * u[index[k]] * e[index[k]];
    return lambda * h;
}

/* ---- supports ---- */

static double nested_support(const imp_form *form, const double w[3], imp_surface *s)
{
    double outer[2], u[2], e[2];
    outer[0] = dual_norm(2, w, form->p[0], s->u, s->e);
    outer[1] = w[2];
    const double h = dual_norm(2, outer, form->p[IMP_SECTION], u, e);
    s->u[IMP_SECTION] = u[0], s->e[IMP_SECTION] = e[0];
    s->u[2] = u[1], s->e[2] = e[1];
    return h;
}

/* The middle of what a core reaches along d where that is an edge, side or cap. */
double imp_box_support(const double axis[3], const double d[3], double x[3])
{
    double h = 0;
    for (int i = 0; i < 3; i++) {
        x[i] = d[i] > 0 ? axis[i] : d[i] < 0 ? -axis[i] : 0;
        h += axis[i] * fabs(d[i]);
    }
    return h;
}

static double disc_support(double radius, const double d[3], double x[3])
{
    const double across = sqrt(d[0] * d[0] + d[1] * d[1]), inverse = across > 0 ? radius / across : 0;
    x[0] = d[0] * inverse, x[1] = d[1] * inverse;
    return radius * across;
}

static double cylinder_support(const imp_form *form, const double d[3], double x[3])
{
    x[2] = d[2] > 0 ? form->axis[2] : d[2] < 0 ? -form->axis[2] : 0;
    return disc_support(form->axis[0], d, x) + form->axis[2] * fabs(d[2]);
}

static double cone_support(const imp_form *form, const double d[3], double x[3])
{
    const double rim = disc_support(form->axis[0], d, x), top = form->axis[2] * d[2];
    x[2] = form->base;
    if (rim >= top) return rim + form->base * d[2];
    x[0] = x[1] = 0, x[2] += form->axis[2];
    return x[2] * d[2];
}

static double core_support(const imp_form *form, const double d[3], imp_surface *s)
{
    int vertex;
    double h = 0;
    switch (form->kind) {
    case IMP_FORM_BOX: h = imp_box_support(form->axis, d, s->u); break;
    case IMP_FORM_CYLINDER: h = cylinder_support(form, d, s->u); break;
    case IMP_FORM_CONE: h = cone_support(form, d, s->u); break;
    default: h = imp_core_support(&form->core, d, &vertex); imp_core_vertex(&form->core, vertex, s->u);
    }
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int i = 0; i < 3; i++) s->e[i] = d[i] / length;
    return h + form->rounding * length;
}

double imp_form_support(const imp_form *form, const double d[3], imp_surface *s)
{
    if (form->kind != IMP_FORM_QUADRIC) return core_support(form, d, s);
    double w[3], largest = 0;
    for (int i = 0; i < 3; i++) {
        w[i] = form->axis[i] * fabs(d[i]);
        largest = fmax(largest, w[i]);
    }
    double h;
    if (form->nested) {
        h = nested_support(form, w, s);
    } else if (form->uniform) {
        h = dual_norm(3, w, form->p[0], s->u, s->e);
    } else {
        for (int i = 0; i < 3; i++) w[i] /= largest;
        h = largest * mixed_dual_norm(form->p, w, s->u, s->e);
    }
    for (int i = 0; i < 3; i++)
        if (d[i] < 0) s->u[i] = -s->u[i], s->e[i] = -s->e[i];
    return h;
}

void imp_surface_point(const imp_form *form, const imp_surface *s, double x[3], double normal[3])
{
    if (form->kind != IMP_FORM_QUADRIC) {
        for (int i = 0; i < 3; i++) x[i] = s->u[i] + form->rounding * s->e[i], normal[i] = s->e[i];
        return;
    }
    if (form->nested) {
        const double k = s->u[IMP_SECTION], ek = s->e[IMP_SECTION];
        for (int i = 0; i < 2; i++) {
            x[i] = form->axis[i] * k * s->u[i];
            normal[i] = ek * s->e[i] / form->axis[i];
        }
        x[2] = form->axis[2] * s->u[2];
        normal[2] = s->e[2] / form->axis[2];
        return;
    }
    for (int i = 0; i < 3; i++) {
        x[i] = form->axis[i] * s->u[i];
        normal[i] = form->p[i] * s->e[i] / form->axis[i];
    }
}

double imp_form_support_world(const imp_form *form, const double d[3], double x[3], imp_surface *s)
{
    double body[3], point[3], normal[3];
    for (int i = 0; i < 3; i++)
        body[i] = form->rotation[0][i] * d[0] + form->rotation[1][i] * d[1] + form->rotation[2][i] * d[2];
    const double h = imp_form_support(form, body, s);
    imp_surface_point(form, s, point, normal);
    for (int i = 0; i < 3; i++)
        x[i] = form->rotation[i][0] * point[0] + form->rotation[i][1] * point[1] + form->rotation[i][2] * point[2];
    return h;
}

double imp_form_inside(const imp_form *form, const double x[3])
{
    double term[3];
    for (int i = 0; i < 3; i++) term[i] = fabs(x[i] / form->axis[i]);
    if (!form->nested) return pow(term[0], form->p[0]) + pow(term[1], form->p[1]) + pow(term[2], form->p[2]);
    const double larger = fmax(term[0], term[1]);
    double section = 0;
    if (larger > 0)
        section = larger * pow(pow(term[0] / larger, form->p[0]) + pow(term[1] / larger, form->p[0]), 1 / form->p[0]);
    return pow(section, form->p[IMP_SECTION]) + pow(term[2], form->p[IMP_SECTION]);
}

/* ---- Hessian ---- */

/* Of an axis with d = 0: m/d^2 = A u e/d^2 is A^2 u^(2-p)/(p lambda). */
static double flank_hessian(const imp_form *form, int i, double lambda)
{
    const double A = form->axis[i], p = form->p[i];
    return p == 2 ? A * A / (2 * lambda) : p < 2 ? 0 : INFINITY;
}

/* The limit q -> inf on one axis that has mass; sharp = 3: two have, and the surface is flat or an edge. */
static void sharp_hessian(const imp_form *form, const double d[3], const double qm[3], double lambda, int sharp,
                          double H[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) H[i][j] = sharp == 3 ? INFINITY : 0;
    if (sharp == 3) return;
    for (int i = 0; i < 3; i++) {
        if (i == sharp) continue;
        if (d[i] == 0) H[i][i] = flank_hessian(form, i, lambda);
        if (qm[i] == 0) continue;
        H[i][i] = lambda * qm[i] / (d[i] * d[i]);
        H[i][sharp] = H[sharp][i] = -lambda * qm[i] / (d[i] * d[sharp]);
        H[sharp][sharp] += lambda * qm[i] / (d[sharp] * d[sharp]);
    }
}

/* lambda [diag(q_i m_i/d_i^2 sum_{j != i} q_j m_j / S) - off-diagonal q_i m_i q_j m_j/(d_i d_j S)], m = u^p, S = sum q
 * m. */
static void independent_hessian(const imp_form *form, const double d[3], const imp_surface *s, double h, double H[3][3])
{
    double qm[3], sum = 0, stationary = 1;
    int sharp = -1;
    for (int i = 0; i < 3; i++) {
        const double mass = s->u[i] * s->e[i];
        if (form->p[i] - 1 < IMP_SHARP_EXPONENT) {
            qm[i] = 0;
            if (mass > 0) sharp = sharp < 0 ? i : 3;
            continue;
        }
        qm[i] = mass > 0 ? form->p[i] / (form->p[i] - 1) * mass : 0;
        stationary += (form->p[i] - 1) * mass;
        sum += qm[i];
    }
    const double lambda = h / stationary;
    if (sharp >= 0) {
        sharp_hessian(form, d, qm, lambda, sharp, H);
        return;
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            if (i != j) {
                H[i][j] = d[i] != 0 && d[j] != 0 ? -lambda * qm[i] * qm[j] / (d[i] * d[j] * sum) : 0;
                continue;
            }
            const double others = (qm[(i + 1) % 3] + qm[(i + 2) % 3]) / sum;
            H[i][i] = d[i] != 0 ? lambda * qm[i] / (d[i] * d[i]) * others : flank_hessian(form, i, lambda);
        }
}

/* u/e of e = u^(p-1): at 0 its limit. */
static double slope_of(double u, double e, double p)
{
    if (e != 0) return u / e;
    return p < 2 ? 0 : p == 2 ? 1 : INFINITY;
}

/* Along z, where the inner norm k is 0: flat, or pointed. With t = 2 the surface is h = A_z + k^2/(2 A_z), and has a
 * Hessian along x and y alone (in between it is as the section is). */
static void pole_hessian(const imp_form *form, double h, double H[3][3])
{
    const double t = form->p[IMP_SECTION];
    for (int i = 0; i < 2; i++) H[i][i] = t < 2 ? 0 : t > 2 ? INFINITY : form->axis[i] * form->axis[i] / h;
}

/* h = dual norm t of (k, w_z), k = dual norm r of (w_x, w_y): the Hessian by the chain rule. An exponent of 1 leaves
 * one of its two at a corner, which turns nothing. */
static void nested_hessian(const imp_form *form, const double d[3], const imp_surface *s, double h, double H[3][3])
{
    const double r = form->p[0], t = form->p[IMP_SECTION];
    const double eK = s->e[IMP_SECTION], ez = fabs(s->e[2]), k = eK * h; /* e = w/h */
    const double uK = s->u[IMP_SECTION], uz = fabs(s->u[2]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) H[i][j] = 0;
    if (k == 0) {
        pole_hessian(form, h, H);
        return;
    }
    if (t > 1) { /* second derivatives of the outer norm: F_kk = (q-1)/h u_K/e_K (e_z u_z), and alike */
        const double g[2] = {form->axis[0] * s->u[0], form->axis[1] * s->u[1]}; /* d(k)/d(d) */
        const double q1 = 1 / (t - 1), sz = (d[2] < 0 ? -1 : 1) * form->axis[2];
        const double Fkk = q1 / h * (uK / eK) * (ez * uz), Fkz = -q1 / h * uK * uz;
        for (int i = 0; i < 2; i++)
            for (int j = 0; j < 2; j++) H[i][j] = Fkk * g[i] * g[j];
        for (int i = 0; i < 2; i++) H[i][2] = H[2][i] = Fkz * g[i] * sz;
        H[2][2] = q1 / h * slope_of(uz, ez, t) * (eK * uK) * sz * sz;
    }
    if (r > 1) {
        const double m0 = s->u[0] * s->e[0], m1 = s->u[1] * s->e[1], scale = uK / (r - 1) / k;
        const double off = -scale * form->axis[0] * form->axis[1] * s->u[0] * s->u[1];
        H[0][0] += scale * form->axis[0] * form->axis[0] * slope_of(s->u[0], s->e[0], r) * m1;
        H[1][1] += scale * form->axis[1] * form->axis[1] * slope_of(s->u[1], s->e[1], r) * m0;
        H[0][1] += off, H[1][0] += off;
    }
}

/* Where a core has a vertex 0. On edges, sides and faces, infinite along what they hold: each coordinate for itself,
 * which is exact where they lie along an axis. On a cylinder's or cone's rim the circle's radius along it, R/rho for
 * d = (rho, z) unit. */
static void core_hessian(const imp_form *form, const double d[3], double H[3][3])
{
    short vertex[IMPACT_HULL_POINTS];
    double mean[3], x[3], low[3], high[3];
    const double across = d[0] * d[0] + d[1] * d[1];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) H[i][j] = 0;
    if (imp_of_revolution(form)) {
        imp_surface s;
        core_support(form, d, &s);
        const double rim = across > 0 ? sqrt(s.u[0] * s.u[0] + s.u[1] * s.u[1]) / (across * sqrt(across)) : INFINITY;
        if (across > 0 && rim > 0) {
            H[0][0] = d[1] * d[1] * rim, H[1][1] = d[0] * d[0] * rim;
            H[0][1] = H[1][0] = -d[0] * d[1] * rim;
        }
        if (across == 0 && (d[2] < 0 || form->kind == IMP_FORM_CYLINDER)) H[0][0] = H[1][1] = INFINITY;
        if (form->kind == IMP_FORM_CYLINDER && d[2] == 0) H[2][2] = INFINITY;
        return;
    }
    const double slack = IMP_CORE_TIE * fmax(form->axis[0], fmax(form->axis[1], form->axis[2]));
    const int count = imp_core_reached(&form->core, d, slack, vertex, mean);
    for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (int i = 0; i < count; i++) {
        imp_core_vertex(&form->core, vertex[i], x);
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], x[k]), high[k] = fmax(high[k], x[k]);
    }
    for (int k = 0; k < 3; k++)
        if (high[k] - low[k] > slack) H[k][k] = INFINITY;
}

static void ball_hessian(double radius, const double d[3], double H[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) H[i][j] += radius * ((i == j) - d[i] * d[j]);
}

void imp_form_hessian(const imp_form *form, const double d[3], double H[3][3])
{
    if (form->kind != IMP_FORM_QUADRIC) {
        core_hessian(form, d, H);
        if (form->rounding > 0) ball_hessian(form->rounding, d, H);
        return;
    }
    imp_surface s;
    const double h = imp_form_support(form, d, &s);
    if (form->nested)
        nested_hessian(form, d, &s, h, H);
    else
        independent_hessian(form, d, &s, h, H);
}
