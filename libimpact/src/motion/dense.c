/* SPDX-License-Identifier: MIT */
#include "motion/dense.h"

#include <string.h>

impact_status imp_dense_reserve(imp_dense *dense, imp_arena *arena, int size, int bodies)
{
    double *c = imp_arena_grow(arena, dense->c, &dense->room, IMP_DENSE_TERMS * size, sizeof *c);
    imp_dense_seen *seen = imp_arena_grow(arena, dense->seen, &dense->seen_room, bodies, sizeof *seen);
    if (c) dense->c = c;
    if (seen) dense->seen = seen;
    if (!c || !seen) return IMPACT_ENOMEM;
    for (int i = 0; i < bodies; i++) seen[i].t = NAN;
    return IMPACT_OK;
}

/* Terms that count at s: at the step's end, which is asked for most, all but the first are 0. */
static int terms_at(const imp_dense *dense, double s) { return s != 0 ? dense->terms : 1; }

/* Time rises with tau: Newton's iteration, its first step from the step's end for nothing, within a bracket, by halves
 * where it leaves that. */
double imp_dense_tau(const imp_dense *dense, double t)
{
    enum { MOST = 100 };
    if (!dense->clocked) return t;
    if (t == dense->c[0]) return dense->end;
    double low = -1, high = 0, s = (t - dense->c[0]) / dense->c[dense->size];
    if (!(s > low && s < high)) s = -0.5;
    for (int i = 0; i < MOST; i++) {
        double value = 0, rate = 0;
        for (int j = dense->terms - 1; j >= 0; j--) {
            rate = rate * s + value;
            value = value * s + dense->c[j * dense->size];
        }
        if (value == t) break;
        *(value < t ? &low : &high) = s;
        double next = s - (value - t) / rate;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (next == s || next == low || next == high) break;
        s = next;
    }
    return dense->end + s * dense->h;
}

static double place_of(const imp_dense *dense, double t) { return (imp_dense_tau(dense, t) - dense->end) / dense->h; }

double imp_dense_place(const imp_dense *dense, double t) { return dense->h > 0 ? place_of(dense, t) : 0; }

/* Horner's rule for all components side by side, as they stand. */
void imp_dense_there(const imp_dense *dense, double s, int first, int count, double *y)
{
    for (int i = 0; i < count; i++) y[i] = 0;
    for (int j = terms_at(dense, s) - 1; j >= 0; j--) {
        const double *c = &dense->c[j * dense->size + first];
        for (int i = 0; i < count; i++) y[i] = y[i] * s + c[i];
    }
}

void imp_dense_at(const imp_dense *dense, double t, int first, int count, double *y)
{
    imp_dense_there(dense, imp_dense_place(dense, t), first, count, y);
}

imp_dense_window imp_dense_window_of(const imp_dense *dense, double t, double window)
{
    if (!(dense->h > 0)) return (imp_dense_window){0, 0};
    const double s = place_of(dense, t), last = fmin(t + window, dense->t1);
    return (imp_dense_window){s, last > t ? fmax(place_of(dense, last) - s, 0) : 0};
}

/* The polynomials' terms about s, by repeated division, all components side by side: of one alone each term waits for
 * the one before it. */
static void expand_about(const imp_dense *dense, double s, int first, int count, double c[][IMP_DENSE_AT_ONCE])
{
    const int n = dense->terms;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < IMP_DENSE_AT_ONCE; i++) c[j][i] = i < count ? dense->c[j * dense->size + first + i] : 0;
    for (int k = 0; k < n; k++)
        for (int j = n - 2; j >= k; j--)
            for (int i = 0; i < IMP_DENSE_AT_ONCE; i++) c[j][i] += s * c[j + 1][i];
}

void imp_dense_rates(const imp_dense *dense, imp_dense_window at, int first, int count, imp_dense_rate *rates)
{
    const double h = dense->h;
    double c[IMP_DENSE_TERMS][IMP_DENSE_AT_ONCE];
    if (!(h > 0)) {
        memset(rates, 0, (size_t)count * sizeof *rates);
        imp_dense_there(dense, 0, first, 1, &rates[0].value);
        return;
    }
    expand_about(dense, at.s, first, count, c);
    for (int i = 0; i < count; i++) {
        imp_dense_rate r = {.value = c[0][i], .rate = dense->terms > 1 ? c[1][i] / h : 0};
        for (int j = dense->terms - 1; j >= 0; j--) {
            const double size = fabs(c[j][i]);
            r.most = r.most * at.w + size;
            if (j > 0) r.most_rate = r.most_rate * at.w + j * size;
            if (j > 1) r.most_second = r.most_second * at.w + j * (j - 1) * size;
        }
        r.most_rate /= h, r.most_second /= h * h;
        rates[i] = r;
    }
}

static double slope_of(const imp_dense *dense, double s, int i)
{
    double value = 0, rate = 0;
    if (s == 0) return dense->terms > 1 ? dense->c[dense->size + i] : 0;
    for (int j = dense->terms - 1; j >= 0; j--) {
        rate = rate * s + value;
        value = value * s + dense->c[j * dense->size + i];
    }
    return rate;
}

/* By s, and then by t, which is y[0] where tau is another. */
void imp_dense_slopes(const imp_dense *dense, double s, int first, int count, double *slopes)
{
    const bool moves = dense->h > 0;
    const double rate = dense->clocked && moves ? slope_of(dense, s, 0) : dense->h;
    for (int i = 0; i < count; i++) slopes[i] = moves ? slope_of(dense, s, first + i) / rate : 0;
}

void imp_dense_jet(const imp_dense *dense, double s, int i, double jet[3])
{
    jet[0] = jet[1] = jet[2] = 0;
    for (int j = dense->terms - 1; j >= 0; j--) {
        jet[2] = jet[2] * s + 2 * jet[1];
        jet[1] = jet[1] * s + jet[0];
        jet[0] = jet[0] * s + dense->c[j * dense->size + i];
    }
    jet[1] /= dense->h, jet[2] /= dense->h * dense->h;
}
