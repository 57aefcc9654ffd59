/* SPDX-License-Identifier: MIT */
#include "base/tolerances.h"
#include "gap/gap_chart.h"
#include "gap/gap_walk.h"
#include <string.h>

static double exponent(const imp_form *form, int i) { return form->nested && i < 2 ? form->p[0] : form->p[i]; }

/* de/du of a pair; infinite at u = 0 of p < 2. */
static double steepness(double p, double u, double e)
{
    if (p == 2) return 1;
    if (u == 0) return p < 2 && p > 1 ? INFINITY : p == 1 ? INFINITY : 0;
    return (p - 1) * e / u;
}

/* The pivot of a constraint over the pairs i and j: the heavier. */
static bool heavier(const imp_surface *s, int i, int j) { return s->u[i] * s->e[i] >= s->u[j] * s->e[j]; }

/* How pair i moves per unit of its gentler half. */
static void motion(const imp_form *form, const imp_surface *s, int i, bool *primal, double *du, double *de)
{
    const double slope = steepness(exponent(form, i), s->u[i], s->e[i]);
    *primal = slope <= 1;
    *du = *primal ? 1 : 1 / slope;
    *de = *primal ? slope : 1;
}

/* The pivot pair k answers du_i of pair i on the constraint sum m |u|^p = const. */
static void pivot_motion(const imp_form *form, const imp_surface *s, int i, int k, double du, double de, double *duk,
                         double *dek)
{
    const double pk = exponent(form, k), change = s->e[i] * du + s->u[i] * de;
    *duk = -change / (pk * s->e[k]);
    *dek = pk == 2 ? *duk : (pk - 1) * s->e[k] / s->u[k] * *duk;
}

static void plain_chart(const imp_form *form, const imp_surface *s, double x[3], double N[3], double P[2][3],
                        double Q[2][3], imp_chart *c)
{
    int k = heavier(s, 0, 1) ? 0 : 1;
    if (heavier(s, 2, k)) k = 2;
    c->index[0] = (k + 1) % 3;
    c->index[1] = (k + 2) % 3;
    double inverse[3];
    for (int i = 0; i < 3; i++) {
        inverse[i] = form->p[i] / form->axis[i];
        x[i] = form->axis[i] * s->u[i];
        N[i] = inverse[i] * s->e[i];
    }
    for (int j = 0; j < 2; j++) {
        const int i = c->index[j], o = c->index[1 - j];
        double du, de, duk, dek;
        motion(form, s, i, &c->primal[j], &du, &de);
        pivot_motion(form, s, i, k, du, de, &duk, &dek);
        P[j][i] = form->axis[i] * du, P[j][k] = form->axis[k] * duk, P[j][o] = 0;
        Q[j][i] = inverse[i] * de, Q[j][k] = inverse[k] * dek, Q[j][o] = 0;
    }
}

static void nested_chart(const imp_form *form, const imp_surface *s, double x[3], double N[3], double P[2][3],
                         double Q[2][3], imp_chart *c)
{
    const double K = s->u[IMP_SECTION], eK = s->e[IMP_SECTION];
    imp_surface_point(form, s, x, N);
    /* pair 0: along the section */
    const int k = heavier(s, 0, 1) ? 0 : 1, i = 1 - k;
    double du, de, duk, dek;
    c->index[0] = i;
    motion(form, s, i, &c->primal[0], &du, &de);
    pivot_motion(form, s, i, k, du, de, &duk, &dek);
    P[0][i] = form->axis[i] * K * du, P[0][k] = form->axis[k] * K * duk, P[0][2] = 0;
    Q[0][i] = eK * de / form->axis[i], Q[0][k] = eK * dek / form->axis[k], Q[0][2] = 0;
    /* pair 1: along the profile */
    const bool top = heavier(s, 2, IMP_SECTION);
    const int free_pair = top ? IMP_SECTION : 2, pivot = top ? 2 : IMP_SECTION;
    c->index[1] = free_pair;
    motion(form, s, free_pair, &c->primal[1], &du, &de);
    pivot_motion(form, s, free_pair, pivot, du, de, &duk, &dek);
    const double dK = top ? du : duk, deK = top ? de : dek, dz = top ? duk : du, dez = top ? dek : de;
    for (int j = 0; j < 2; j++) {
        P[1][j] = form->axis[j] * dK * s->u[j];
        Q[1][j] = deK * s->e[j] / form->axis[j];
    }
    P[1][2] = form->axis[2] * dz;
    Q[1][2] = dez / form->axis[2];
}

void imp_chart_make(const imp_form *form, const imp_surface *s, imp_chart *c)
{
    double x[3], N[3], P[2][3], Q[2][3];
    if (form->kind != IMP_FORM_QUADRIC) {
        imp_walk_chart(form, s, P, Q);
        memcpy(x, s->u, sizeof x);
        memcpy(N, s->e, sizeof N);
    } else if (form->nested)
        nested_chart(form, s, x, N, P, Q, c);
    else
        plain_chart(form, s, x, N, P, Q, c);
    imp_to_world(form->rotation, x, c->x);
    imp_to_world(form->rotation, N, c->N);
    for (int j = 0; j < 2; j++) {
        imp_to_world(form->rotation, P[j], c->P[j]);
        imp_to_world(form->rotation, Q[j], c->Q[j]);
    }
}

/* ---- moving a surface point ---- */

static double signed_root(double value, double power)
{
    return value == 0 ? 0 : copysign(pow(fabs(value), power), value);
}

static double clamp_unit(double value) { return value > 1 ? 1 : value < -1 ? -1 : value; }

/* Moves the gentler half of a pair. p = 1 and steps through zero use u + e, along which both halves are gentle. */
static void move_pair(double p, bool primal, double step, double *u, double *e)
{
    if (p == 2) {
        *u = *e = clamp_unit(*u + step);
        return;
    }
    if (p == 1) {
        const double sum = *u + *e + step;
        *e = clamp_unit(sum);
        *u = clamp_unit(sum - *e);
        return;
    }
    const double old = primal ? *u : *e, moved = clamp_unit(old + step);
    const bool crosses = old != 0 && (moved > 0) != (old > 0) && (p < 2) == primal;
    if (crosses) {
        const double slope = steepness(p, *u, *e), other = primal ? slope * step : step / slope;
        primal = !primal;
        const double sum = clamp_unit(*u + *e + step + other);
        if (primal)
            *u = sum, *e = signed_root(*u, p - 1);
        else
            *e = sum, *u = signed_root(*e, 1 / (p - 1));
        return;
    }
    if (primal)
        *u = moved, *e = signed_root(moved, p - 1);
    else
        *e = moved, *u = signed_root(moved, 1 / (p - 1));
}

/* Gives the pivot the mass the others leave; false when they leave too little of it. */
static bool settle_pivot(double p, double rest, double *u, double *e)
{
    if (!(rest > IMP_CHART_PIVOT)) return false;
    if (p == 2) {
        *u = copysign(sqrt(rest), *u);
        *e = *u;
    } else if (p == 1) {
        *u = copysign(rest, *u);
    } else {
        *u = copysign(pow(rest, 1 / p), *u);
        *e = rest / *u;
    }
    return true;
}

bool imp_chart_move(const imp_form *form, const imp_chart *c, const double step[2], imp_surface *s)
{
    if (form->kind != IMP_FORM_QUADRIC) {
        imp_walk_move(form, step, s);
        return true;
    }
    for (int j = 0; j < 2; j++) {
        const int i = c->index[j];
        move_pair(exponent(form, i), c->primal[j], step[j], &s->u[i], &s->e[i]);
    }
    if (!form->nested) {
        const int i = c->index[0], o = c->index[1], k = 3 - i - o;
        return settle_pivot(form->p[k], 1 - s->u[i] * s->e[i] - s->u[o] * s->e[o], &s->u[k], &s->e[k]);
    }
    const int i = c->index[0], k = 1 - i, f = c->index[1], pivot = f == 2 ? IMP_SECTION : 2;
    if (f == IMP_SECTION && s->u[f] < 0) { /* through the pole: the section's other side */
        s->u[f] = -s->u[f], s->e[f] = -s->e[f];
        for (int j = 0; j < 2; j++) s->u[j] = -s->u[j], s->e[j] = -s->e[j];
    }
    return settle_pivot(form->p[0], 1 - s->u[i] * s->e[i], &s->u[k], &s->e[k]) &&
           settle_pivot(form->p[IMP_SECTION], 1 - s->u[f] * s->e[f], &s->u[pivot], &s->e[pivot]);
}

/* Takes the gentler half of each pair from the point x (body axes) where the surface point came from the normal alone.
 */
static void use_point(const imp_form *form, const double x[3], imp_surface *s)
{
    int pivot = 0;
    double heaviest = -1, rest = 1;
    for (int i = 0; i < 3; i++) {
        const double p = form->p[i], u = clamp_unit(x[i] / form->axis[i]), size = fabs(u);
        if (p == 1) {
            const bool face = size > IMP_CHART_FACE;
            s->u[i] = face ? u : 0;
            if (face) s->e[i] = copysign(1, u);
        } else if (size > 0 && (p - 1) * pow(size, p - 2) <= 1) {
            s->u[i] = u, s->e[i] = signed_root(u, p - 1);
        }
        if (s->u[i] * s->e[i] > heaviest) heaviest = s->u[i] * s->e[i], pivot = i;
    }
    for (int i = 0; i < 3; i++)
        if (i != pivot) rest -= s->u[i] * s->e[i];
    settle_pivot(form->p[pivot], fmax(rest, IMP_CHART_START), &s->u[pivot], &s->e[pivot]);
}

void imp_chart_start(const imp_form *form, const double d[3], const double *x, imp_surface *s)
{
    double body[3], point[3];
    imp_to_body(form->rotation, d, body);
    if (form->kind != IMP_FORM_QUADRIC) {
        if (x) imp_to_body(form->rotation, x, point);
        imp_walk_start(form, body, x ? point : NULL, s);
        return;
    }
    imp_form_support(form, body, s);
    if (!x || form->nested) return;
    imp_to_body(form->rotation, x, body);
    use_point(form, body, s);
}
