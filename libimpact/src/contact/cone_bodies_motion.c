/* SPDX-License-Identifier: MIT */
#include "contact/cone_bodies_parts.h"
#include "base/tolerances.h"

#include <math.h>
#include <string.h>

/* ---- G ---- */

void imp_bodies_seen_by(const imp_bodies_problem *p, const imp_cone_row *row, int c, const double *x, double v[3])
{
    v[0] = v[1] = v[2] = 0;
    for (int side = 0; side < 2; side++) {
        if (p->couples[c][side] < 0) continue;
        const double *own = &x[6 * p->couples[c][side]];
        for (int k = 0; k < 3; k++) {
            const double *a = row->side[side][k];
            v[k] += (a[0] * own[0] + a[1] * own[1]) + (a[2] * own[2] + a[3] * own[3]) + (a[4] * own[4] + a[5] * own[5]);
        }
    }
}

/* Most problems have three numbers a contact: loops over a width that is known take three quarters of the time. What
 * looks and sweeps ask for has it as its argument. */

/* G x at the contact. */
static inline void seen_at(const imp_bodies_problem *p, int c, const double *x, double v[6], const int width)
{
    imp_bodies_seen_by(p, &p->rows[c], c, x, v);
    if (width > 3) imp_bodies_seen_by(p, &p->turns[c], c, x, v + 3);
}

static inline void add_effect_of(const imp_bodies_problem *p, const imp_cone_row *row, int c, const double f[3],
                                 double factor, double *x)
{
    for (int side = 0; side < 2; side++) {
        if (p->couples[c][side] < 0) continue;
        double *own = &x[6 * p->couples[c][side]], sum[6];
        memcpy(sum, own, sizeof sum);
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 6; l++) sum[l] += factor * f[k] * row->side[side][k][l];
        memcpy(own, sum, sizeof sum);
    }
}

/* Adds factor G^T f of the contact. */
static inline void add_effect(const imp_bodies_problem *p, int c, const double *f, double factor, double *x,
                              const int width)
{
    add_effect_of(p, &p->rows[c], c, f, factor, x);
    if (width > 3) add_effect_of(p, &p->turns[c], c, f + 3, factor, x);
}

/* P_K without its derivative, by the formula of imp_cone_project: sweeps and line searches ask for nothing else. */
static inline void project_plain(double friction, const double *v, double *to)
{
    const double across = friction > 0 ? sqrt(v[1] * v[1] + v[2] * v[2]) : 0;
    const bool within = v[0] >= 0 && across <= friction * v[0], under = !within && v[0] <= -friction * across;
    const double size = (v[0] + friction * across) / (1 + friction * friction), part = within ? friction > 0
                                                                                       : under || !(friction > 0)
                                                                                           ? 0
                                                                                           : friction * size / across;
    to[0] = within ? v[0] : under ? 0 : size;
    to[1] = part * v[1], to[2] = part * v[2];
}

void imp_bodies_project(double friction, double least, const double *v, double *to, double slope[3][3])
{
    if (slope)
        imp_cone_project(friction, v, to, slope);
    else
        project_plain(friction, v, to);
    if (to[0] >= least) return;
    const double across = hypot(v[1], v[2]), bound = friction * least, part = across > bound ? bound / across : 1;
    to[0] = least;
    for (int k = 1; k < 3; k++) to[k] = friction > 0 ? part * v[k] : 0;
    if (!slope) return;
    memset(slope, 0, 9 * sizeof slope[0][0]);
    for (int k = 1; friction > 0 && k < 3; k++)
        for (int l = 1; l < 3; l++)
            slope[k][l] = part * ((k == l) - (across > bound ? v[k] * v[l] / (across * across) : 0));
}

/* P_C y of the contact, and its derivative, width x width. */
static void project_pressed(const imp_bodies_problem *p, int c, const double *y, double *f, double slope[36])
{
    if (p->width == 3)
        imp_bodies_project(p->friction[c], p->least ? p->least[c] : 0, y, f, (double(*)[3])slope);
    else
        imp_cone_project_turning(p->friction[c], p->lengths[c], p->rolling[c], y, f, (double(*)[6])slope);
}

/* P_C y alone. */
static inline void project_value(const imp_bodies_problem *p, int c, const double *y, double *f, const int width)
{
    if (width == 3 && !p->least)
        project_plain(p->friction[c], y, f);
    else
        project_pressed(p, c, y, f, NULL);
}

/* The part of the matrix from rows of the one kind times rows of the other: of three by three of slope. */
static void add_bend_of(const imp_bodies_problem *p, const imp_cone_row *row, const imp_cone_row *other, int c,
                        const double *slope)
{
    for (int i = 0; i < 2; i++) {
        double left[3][6] = {{0}};
        if (p->couples[c][i] < 0) continue;
        for (int m = 0; m < 3; m++)
            for (int o = 0; o < 3; o++)
                for (int k = 0; k < 6; k++)
                    left[m][k] += p->stiffness[c] * row->side[i][o][k] * slope[p->width * o + m];
        for (int j = 0; j < 2; j++)
            if (p->couples[c][j] >= 0)
                imp_skyline_add_product(p->sky, p->couples[c][i], p->couples[c][j], left, other->side[j]);
    }
}

static void add_bend(const imp_bodies_problem *p, int c, const double slope[36])
{
    add_bend_of(p, &p->rows[c], &p->rows[c], c, slope);
    if (p->width == 3) return;
    add_bend_of(p, &p->rows[c], &p->turns[c], c, slope + 3);
    add_bend_of(p, &p->turns[c], &p->rows[c], c, slope + 18);
    add_bend_of(p, &p->turns[c], &p->turns[c], c, slope + 21);
}

void imp_bodies_stiffen(const imp_bodies_problem *p, double stiffness)
{
    for (int c = 0; c < p->count; c++) {
        const int dimension = p->friction[c] > 0 ? 3 : 1;
        double trace = 0;
        for (int side = 0; side < 2; side++)
            for (int k = 0; k < dimension; k++)
                for (int l = 0; l < 6; l++) trace += p->rows[c].side[side][k][l] * p->rows[c].side[side][k][l];
        p->mobility[c] = trace / dimension;
        p->stiffness[c] = stiffness / p->mobility[c];
    }
}

void imp_bodies_effect(const imp_bodies_problem *p, const double *r)
{
    memset(p->x, 0, sizeof *p->x * (size_t)p->n);
    for (int c = 0; c < p->count; c++) add_effect(p, c, &r[p->width * c], 1, p->x, p->width);
    for (int c = 0; c < p->count; c++) {
        double v[6];
        const int i = p->width * c;
        seen_at(p, c, p->x, v, p->width);
        for (int k = 0; k < p->width; k++) p->u[i + k] = p->q[i + k] + v[k];
    }
}

/* ---- slip ---- */

/* u over its size, times the slope, at most two numbers; 0 of none. */
static double scaled_slip(double slope, double *u, int count)
{
    const double size = count == 1 ? fabs(u[0]) : sqrt(u[0] * u[0] + u[1] * u[1]);
    const double part = size > 0 ? slope / size : 0;
    for (int k = 0; k < count; k++) u[k] *= part;
    return slope * size;
}

double imp_bodies_slip(const imp_bodies_problem *p, int c, const double *u, double slope[6])
{
    const double friction = p->friction[c];
    slope[0] = 0, slope[1] = u[1], slope[2] = u[2];
    const double rubs = scaled_slip(friction > 0 ? friction : 0, slope + 1, 2);
    if (p->width == 3) return rubs;
    slope[3] = u[3], slope[4] = u[4], slope[5] = u[5];
    const double cone = friction > 0 ? friction : 1; /* with which spin is one slip */
    const double spins = scaled_slip(p->lengths[c].torsional > 0 ? cone : 0, slope + 3, 1),
                 one = sqrt(rubs * rubs + spins * spins);
    for (int k = 1; k < 4; k++) slope[k] *= one > 0 ? (k < 3 ? rubs : spins) / one : 0;
    return one + scaled_slip(p->lengths[c].rolling > 0 ? p->rolling[c] : 0, slope + 4, 2);
}

/* s alone. */
static double slip_part(const imp_bodies_problem *p, int c, const double *u)
{
    double slope[6];
    if (p->width > 3) return imp_bodies_slip(p, c, u, slope);
    return p->friction[c] > 0 ? p->friction[c] * sqrt(u[1] * u[1] + u[2] * u[2]) : 0;
}

/* ---- Newton ---- */

/* Of x: r - rho (q + s + G x), and where s follows x the velocities whose s it is. */
static inline void look_at_contact(const imp_bodies_problem *p, int c, const double *x, const int width)
{
    const int i = width * c;
    double v[6], *y = &p->y[i];
    seen_at(p, c, x, v, width);
    if (p->follows) {
        for (int k = 0; k < width; k++) v[k] += p->q[i + k];
        memcpy(&p->lean[i], v, sizeof *v * (size_t)width);
        v[0] += slip_part(p, c, v);
    } else {
        for (int k = 0; k < width; k++) v[k] += p->offset[i + k];
    }
    for (int k = 0; k < width; k++) y[k] = p->r[i + k] - p->stiffness[c] * v[k];
}

/* What x is to minimise; its reactions go to pressed, its gradient to gradient. Where s follows x that is the gradient
 * of nothing, and half its square is to fall. */
static inline double look_at_width(const imp_bodies_problem *p, const double *x, double *scale, const int width)
{
    double value = 0.5 * imp_bodies_products(x, x, p->n);
    memcpy(p->gradient, x, sizeof *x * (size_t)p->n);
    *scale = imp_bodies_products(x, x, p->n);
    for (int c = 0; c < p->count; c++) {
        double *f = &p->pressed[width * c];
        look_at_contact(p, c, x, width);
        project_value(p, c, &p->y[width * c], f, width);
        value += 0.5 * imp_bodies_products(f, f, width) / p->stiffness[c];
        *scale = fmax(*scale, imp_bodies_products(f, f, width) * p->mobility[c]);
        add_effect(p, c, f, -1, p->gradient, width);
    }
    *scale = sqrt(*scale);
    return p->follows ? 0.5 * imp_bodies_products(p->gradient, p->gradient, p->n) : value;
}

static double look_at(const imp_bodies_problem *p, const double *x, double *scale)
{
    return p->width == 3 ? look_at_width(p, x, scale, 3) : look_at_width(p, x, scale, 6);
}

/* From x, which was looked at last. */
static bool newton_step(const imp_bodies_problem *p)
{
    imp_skyline_clear(p->sky);
    for (int b = 0; b < p->n / 6; b++) {
        double one[6][6] = {{0}};
        for (int k = 0; k < 6; k++) one[k][k] = 1;
        imp_skyline_add(p->sky, b, b, one);
    }
    for (int c = 0; c < p->count; c++) {
        const int i = p->width * c;
        double f[6], slope[36], lean[6];
        if (!(p->pressed[i] > 0)) continue;
        project_pressed(p, c, &p->y[i], f, slope);
        if (p->follows) (void)imp_bodies_slip(p, c, &p->lean[i], lean);
        for (int k = 0; p->follows && k < p->width; k++)
            for (int l = 1; l < p->width; l++) slope[p->width * k + l] += slope[p->width * k] * lean[l];
        add_bend(p, c, slope);
    }
    p->outcome->factorings++;
    if (!imp_skyline_factor(p->sky)) return false;
    for (int i = 0; i < p->n; i++) p->step[i] = -p->gradient[i];
    imp_skyline_solve(p->sky, p->step);
    return true;
}

/* Along the step, halved until the function falls by a part of what its slope promises; false where it does not.
 * Shorter steps lead nowhere: with thirty halvings one pile of 167 took seven times as long, and thirty bricks and
 * twenty dominoes a fifteenth more; with eight these take a sixth more. */
static bool go_along(const imp_bodies_problem *p, double *value, double *scale)
{
    enum { HALVINGS = 10 };
    const double slope = p->follows ? -2 * *value : imp_bodies_products(p->gradient, p->step, p->n);
    double part = 1;
    for (int k = 0; k < HALVINGS; k++, part *= 0.5) {
        for (int i = 0; i < p->n; i++) p->trial[i] = p->x[i] + part * p->step[i];
        const double found = look_at(p, p->trial, scale);
        if (!(found <= *value + IMP_ARMIJO * part * slope)) continue;
        *value = found;
        memcpy(p->x, p->trial, sizeof *p->x * (size_t)p->n);
        return true;
    }
    return false;
}

/* Newton's steps for x until the gradient is `enough` of its terms, or rounding: there the function tells no more, and
 * a step counts that halves the gradient. How many; -1: none led on. */
int imp_bodies_settle(const imp_bodies_problem *p, double enough)
{
    enum { STEPS = 60 };
    double scale, value = look_at(p, p->x, &scale);
    for (int step = 0; step < STEPS; step++) {
        const double size = sqrt(imp_bodies_products(p->gradient, p->gradient, p->n));
        if (size <= fmax(enough, IMP_BODIES_FINEST) * scale) return step;
        if (!newton_step(p)) return -1;
        p->outcome->steps++;
        if (size > IMP_BODIES_ROUNDING * scale) {
            if (go_along(p, &value, &scale)) continue;
        } else {
            for (int i = 0; i < p->n; i++) p->trial[i] = p->x[i] + p->step[i];
            const double found = look_at(p, p->trial, &scale);
            if (imp_bodies_products(p->gradient, p->gradient, p->n) < 0.25 * size * size) {
                value = found;
                memcpy(p->x, p->trial, sizeof *p->x * (size_t)p->n);
                continue;
            }
        }
        (void)look_at(p, p->x, &scale);
        return size <= IMP_BODIES_ROUNDING * scale ? step : -1;
    }
    return -1;
}

/* r of one contact, as x is while the others stay. */
static inline void sweep_contact(const imp_bodies_problem *p, int c, const int width)
{
    double v[6], own[6], *r = &p->r[width * c];
    seen_at(p, c, p->x, v, width);
    for (int k = 0; k < width; k++) v[k] += p->q[width * c + k];
    v[0] += slip_part(p, c, v);
    for (int k = 0; k < width; k++) own[k] = r[k] - p->stiffness[c] * v[k];
    project_value(p, c, own, v, width);
    for (int k = 0; k < width; k++) own[k] = v[k] - r[k], r[k] = v[k];
    add_effect(p, c, own, 1, p->x, width);
}

static inline void sweep_width(const imp_bodies_problem *p, int sweeps, const int width)
{
    for (int k = 0; k < sweeps; k++) {
        for (int c = 0; c < p->count; c++) sweep_contact(p, c, width);
        for (int c = p->count - 1; c >= 0; c--) sweep_contact(p, c, width);
    }
}

void imp_bodies_sweep(const imp_bodies_problem *p, int sweeps)
{
    imp_bodies_stiffen(p, IMP_BODIES_SWEEP);
    imp_bodies_effect(p, p->r);
    if (p->width == 3)
        sweep_width(p, sweeps, 3);
    else
        sweep_width(p, sweeps, 6);
}
