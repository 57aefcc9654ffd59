/* SPDX-License-Identifier: MIT
 *
 * Friction of what sticks where it is not unique, in parts of its bounds: g_c = f_c/(mu lambda_c), g = g_0 + Q a with
 * the null space of W_SS, Q^T Q = 1. That g is taken whose greatest part t, |g_c| <= t, is nearly the least: it holds
 * longest, and when it no longer does no other would. From the least |g|, Q^T g = 0, the minima of
 *
 *     T t - sum log(t^2 - |g_c|^2)        T from 1/t up, by Newton's steps
 *
 * go to it, at most 2n/T over it (Nesterov & Nemirovskii 1994). What changes from then on is shared so that its |g| is
 * least: a contact that is about to open, or has just closed, would be over its bound at once if it got like the
 * others.
 */
#include "contact/springs.h"

#include <math.h>
#include "base/tolerances.h"
#include "contact/least.h"

/* Of what sticks: components, free ones, contacts. */
typedef struct centre {
    int n, free, contacts;
    double *basis;                        /* Q: n x free, stride n */
    double *bound, *g, *trial;            /* by component */
    double *hessian, *gradient, *step, t; /* of (a, t) */
} centre;

/* ---- the null space ---- */

/* Twice, as the first leaves rounding of what it takes away: x -= q (q . x) for the first `count` columns q. */
static void take_away(const centre *k, int count, double *x, int stride)
{
    for (int twice = 0; twice < 2; twice++)
        for (int j = 0; j < count; j++) {
            double dot = 0;
            for (int i = 0; i < k->n; i++) dot += k->basis[i * k->n + j] * x[i * stride];
            for (int i = 0; i < k->n; i++) x[i * stride] -= dot * k->basis[i * k->n + j];
        }
}

static double norm_of(const centre *k, int column)
{
    double sum = 0;
    for (int i = 0; i < k->n; i++) sum += k->basis[i * k->n + column] * k->basis[i * k->n + column];
    return sqrt(sum);
}

/* Q from N, whose rows are divided by the bounds: Gram & Schmidt, the longest column first. */
static void make_basis(centre *k)
{
    for (int i = 0; i < k->n; i++)
        for (int j = 0; j < k->free; j++) k->basis[i * k->n + j] /= k->bound[i];
    for (int j = 0; j < k->free; j++) {
        int longest = j;
        for (int l = j + 1; l < k->free; l++)
            if (norm_of(k, l) > norm_of(k, longest)) longest = l;
        for (int i = 0; i < k->n; i++) {
            double *row = &k->basis[i * k->n];
            const double swap = row[j];
            row[j] = row[longest], row[longest] = swap;
        }
        take_away(k, j, &k->basis[j], k->n);
        const double length = norm_of(k, j);
        for (int i = 0; i < k->n; i++) k->basis[i * k->n + j] /= length;
        for (int l = j + 1; l < k->free; l++) take_away(k, j + 1, &k->basis[l], k->n);
    }
}

/* Room: 12 n^2 + 10 n of contacts are 3 n^2 + 5 n of components. */
static centre lay_out_centre(imp_springs *s)
{
    const int n = s->stick_count;
    centre k = {.n = n, .contacts = n / 2, .basis = s->factor};
    k.hessian = k.basis + n * n;
    k.bound = k.hessian + (n + 1) * (n + 1);
    double **parts[] = {&k.g, &k.trial, &k.gradient, &k.step};
    for (int i = 0; i < 4; i++) *parts[i] = k.bound + (i + 1) * (n + 1);
    k.free = imp_least_null(s->w, 3 * s->count, s->stick, n, s->inverse, k.hessian, k.basis);
    for (int i = 0; i < n; i++) {
        const int contact = s->stick[i] / 3;
        k.bound[i] = s->springs[contact].friction * s->now[3 * contact];
        k.g[i] = s->now[s->stick[i]] / k.bound[i];
    }
    make_basis(&k);
    take_away(&k, k.free, k.g, 1);
    return k;
}

/* ---- the least greatest part ---- */

static double square_of(const double *g, int c) { return g[2 * c] * g[2 * c] + g[2 * c + 1] * g[2 * c + 1]; }

static double greatest_of(const centre *k, const double *g)
{
    double most = 0;
    for (int c = 0; c < k->contacts; c++) most = fmax(most, square_of(g, c));
    return sqrt(most);
}

/* The lower half of the Hessian, and the negative gradient, at T. */
static void find_newton(centre *k, double big)
{
    const int m = k->free, order = m + 1;
    for (int i = 0; i < order * order; i++) k->hessian[i] = 0;
    for (int i = 0; i < order; i++) k->gradient[i] = 0;
    k->gradient[m] = -big;
    for (int c = 0; c < k->contacts; c++) {
        const double x = k->g[2 * c], y = k->g[2 * c + 1], d = k->t * k->t - square_of(k->g, c);
        for (int j = 0; j < m; j++) {
            const double gx = k->basis[k->n * (2 * c) + j], gy = k->basis[k->n * (2 * c + 1) + j],
                         turn = x * gx + y * gy;
            k->gradient[j] -= 2 * turn / d;
            k->hessian[m * order + j] -= 4 * k->t * turn / (d * d);
            for (int l = 0; l <= j; l++) {
                const double hx = k->basis[k->n * (2 * c) + l], hy = k->basis[k->n * (2 * c + 1) + l];
                k->hessian[j * order + l] += 2 * (gx * hx + gy * hy) / d + 4 * turn * (x * hx + y * hy) / (d * d);
            }
        }
        k->gradient[m] += 2 * k->t / d;
        k->hessian[m * order + m] += (4 * k->t * k->t / d - 2) / d;
    }
}

/* One step, as much of it as keeps inside; returns Newton's decrement. */
static double take_step(centre *k, double big)
{
    const int m = k->free;
    double decrement = 0, part;
    find_newton(k, big);
    for (int i = 0; i <= m; i++) k->step[i] = k->gradient[i];
    imp_least_solve(k->hessian, m + 1, k->step);
    for (int i = 0; i <= m; i++) decrement += k->step[i] * k->gradient[i];
    decrement = sqrt(fmax(0, decrement));
    part = decrement > 0.25 ? 1 / (1 + decrement) : 1; /* that is inside: the function is self-concordant */
    for (int i = 0; i < k->n; i++) {
        k->trial[i] = k->g[i];
        for (int j = 0; j < m; j++) k->trial[i] += part * k->basis[i * k->n + j] * k->step[j];
    }
    if (!(greatest_of(k, k->trial) < k->t + part * k->step[m])) return 0; /* but for rounding */
    k->t += part * k->step[m];
    for (int i = 0; i < k->n; i++) k->g[i] = k->trial[i];
    return decrement;
}

/* ---- the whole ---- */

/* The columns of W_SS^+, in parts of the bounds, without what Q has of them. */
static void share_by_bounds(imp_springs *s, centre *k)
{
    const int n = k->n;
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) k->trial[i] = s->inverse[i * n + j] / k->bound[i];
        take_away(k, k->free, k->trial, 1);
        for (int i = 0; i < n; i++) s->inverse[i * n + j] = k->trial[i] * k->bound[i];
    }
}

void imp_springs_centre(imp_springs *s)
{
    centre k = lay_out_centre(s);
    double most = greatest_of(&k, k.g);
    k.t = 2 * most;
    for (double big = 1 / most;; big *= IMP_SPRINGS_TIGHTER) {
        for (int i = 0; i < IMP_SPRINGS_CENTRE_STEPS && take_step(&k, big) > 0.25; i++) {
        }
        most = greatest_of(&k, k.g);
        const double gap = 2 * k.contacts / big;
        if (gap <= 0.5 * fmax(1 - most, 0) || most - gap > 1 + IMP_SPRINGS_OVER || gap < 0.1 * IMP_SPRINGS_OVER) break;
    }
    for (int i = 0; i < k.n; i++) {
        imp_spring *c = &s->springs[s->stick[i] / 3];
        c->along[i % 2] = c->friction * k.g[i];
    }
    share_by_bounds(s, &k);
}
