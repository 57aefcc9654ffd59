/* SPDX-License-Identifier: MIT
 *
 * Collocation at Lobatto's nodes: over a step from t to t + h the solution is a polynomial whose rate is right at
 * 8 nodes t + c_j h, both ends among them. With f_j = f(t + c_j h, y_j), x = 2c - 1 and Legendre's P_k,
 *
 *     y' = sum_k p_k P_k(x),   p_k = 1/g_k sum_j w_j P_k(x_j) f_j,   w_j = 2/(56 P_7(x_j)^2),
 *                              g_k = 2/(2k + 1), but g_7 = 2/7 (the quadrature of P_7^2 is not exact)
 *     y_i = y + h/2 sum_k p_k I_k(x_i),   I_0 = x + 1,   I_k = (P_k+1 - P_k-1)/(2k + 1)
 *
 * to order 14 at the end and h^9 between. The y_j are found by iteration, each f_j used as soon as it is there, from
 * the last step's polynomial continued, or at a start from f and its rate: a force that hardly depends on y takes two
 * sweeps, and nothing is gained by short steps, as it is where a multistep method begins at order 1 behind each event.
 *
 * The error that the step is held to is that of the polynomial, by the coefficient that it lacks: p_8 goes as
 * p_7 (p_7/p_5), each of a pair of neighbours, as in even and odd functions every other one is 0. In s = (t - end)/h,
 * P_k(x) = sum_m C(k, m) C(k + m, m) s^m: the powers that impact_ode_interpolate answers by.
 *
 * Hairer, Norsett, Wanner 1993, II.7; Everhart 1985 and Rein and Spiegel 2015 for its use between encounters.
 */
#include "base/ode_one_step.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { NODES = 8, LAST = NODES - 1, TERMS = NODES + 1 };

typedef struct lobatto_tables {
    double place[NODES];            /* c_j */
    double sum[NODES][NODES];       /* a_ij: y_i = y + h sum_j a_ij f_j */
    double transform[NODES][NODES]; /* p_k of f_j */
    double power[NODES][NODES];     /* of s^m in P_k */
} lobatto_tables;

typedef struct lobatto_ode {
    imp_one_step one;
    lobatto_tables tables;
    double *rate[NODES]; /* f_j */
    double *guess;       /* a component's error */
    double ratio;        /* of the last sweep's change to that before, in the last step; it goes as the step's length */
} lobatto_ode;

static lobatto_ode *lobatto_of(const imp_one_step *one) { return (lobatto_ode *)(uintptr_t)one; }

/* ---- tables ---- */

/* P_0 .. P_n at x. */
static void legendre(double x, int n, double *p)
{
    p[0] = 1, p[1] = x;
    for (int k = 1; k < n; k++) p[k + 1] = ((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1);
}

/* The j-th zero of (1 - x^2) P_7': Newton's iteration on P_6 - x P_7, which it is over 7, from Chebyshev's node. */
static double node(int j)
{
    double x = -cos(3.14159265358979323846 * j / LAST), p[NODES];
    if (j == 0 || j == LAST) return j == 0 ? -1 : 1;
    for (int i = 0; i < 10; i++) {
        legendre(x, LAST, p);
        x += (p[LAST - 1] - x * p[LAST]) / (NODES * p[LAST]);
    }
    return x;
}

static void make_tables(lobatto_tables *t)
{
    double p[NODES][NODES + 1];
    for (int j = 0; j < NODES; j++) {
        const double x = node(j);
        legendre(x, NODES, p[j]);
        t->place[j] = 0.5 * (1 + x);
        const double weight = 2 / (NODES * LAST * p[j][LAST] * p[j][LAST]);
        for (int k = 0; k < NODES; k++) t->transform[k][j] = weight * p[j][k] * (k == LAST ? LAST : 2 * k + 1) / 2;
    }
    for (int i = 0; i < NODES; i++)
        for (int j = 0; j < NODES; j++) {
            t->sum[i][j] = t->place[i] * t->transform[0][j];
            for (int k = 1; k < NODES; k++)
                t->sum[i][j] += 0.5 * (p[i][k + 1] - p[i][k - 1]) / (2 * k + 1) * t->transform[k][j];
        }
    for (int k = 0; k < NODES; k++) {
        t->power[k][0] = 1;
        for (int m = 0; m + 1 < NODES; m++)
            t->power[k][m + 1] = t->power[k][m] * (k - m) * (k + m + 1) / ((m + 1) * (m + 1));
    }
}

/* ---- the polynomial ---- */

/* From p_k to powers of s, over the integral; y at the end stands in term[0]. */
static void make_polynomial(imp_one_step *one, double h)
{
    const lobatto_ode *lo = lobatto_of(one);
    memcpy(one->term[0], one->y, sizeof *one->y * (size_t)one->ode.size);
    for (int i = 0; i < one->ode.size; i++) {
        double p[NODES];
        for (int k = 0; k < NODES; k++) {
            p[k] = 0;
            for (int j = 0; j < NODES; j++) /* P_k's mean over the nodes is 0: what all have in common stays out */
                p[k] += lo->tables.transform[k][j] * (k > 0 ? lo->rate[j][i] - lo->rate[LAST][i] : lo->rate[j][i]);
        }
        for (int m = 0; m < NODES; m++) {
            double sum = 0;
            for (int k = m; k < NODES; k++) sum += lo->tables.power[k][m] * p[k];
            one->term[m + 1][i] = h / (m + 1) * sum;
        }
    }
}

/* ---- a step ---- */

/* y_i, by the rates as they stand. */
static void node_state(const lobatto_ode *lo, int i, double h, double *y)
{
    const int n = lo->one.ode.size;
    for (int k = 0; k < n; k++) y[k] = 0;
    for (int j = 0; j < NODES; j++)
        for (int k = 0; k < n; k++) y[k] += lo->tables.sum[i][j] * lo->rate[j][k];
    for (int k = 0; k < n; k++) y[k] = lo->one.before[k] + h * y[k];
}

/* The rates at the nodes as they may be expected: the polynomial continued, or at a start along a line. */
static void predict(lobatto_ode *lo, double t, double h)
{
    const imp_one_step *one = &lo->one;
    const double last = one->ode.step_end - one->ode.step_begin;
    for (int j = 1; j < NODES; j++) {
        const double after = lo->tables.place[j] * h;
        if (!one->fresh)
            imp_one_step_at(one, 1, (t + after - one->ode.step_end) / last, last, lo->rate[j]);
        else
            for (int i = 0; i < one->ode.size; i++) lo->rate[j][i] = one->first[i] + after * one->slope[i];
    }
}

static double node_time(const lobatto_ode *lo, int j, double t, double end)
{
    return j == LAST ? end : t + lo->tables.place[j] * (end - t);
}

/* Once over the nodes; the greatest change of a rate, as a way in scales. */
static imp_one_step_outcome sweep(lobatto_ode *lo, double t, double end, double t_stop, double *change)
{
    imp_one_step *one = &lo->one;
    const double h = end - t;
    double *rate = one->roots.state;
    *change = 0;
    for (int j = 1; j < NODES; j++) {
        node_state(lo, j, h, one->y);
        const imp_one_step_outcome outcome = imp_one_step_rate(one, node_time(lo, j, t, end), t_stop, one->y, rate);
        if (outcome != IMP_STEP_STANDS) return outcome;
        for (int i = 0; i < one->ode.size; i++) {
            const double here = fabs(h * (rate[i] - lo->rate[j][i])) / one->scale[i];
            if (!isfinite(here)) return IMP_STEP_TOO_LONG;
            *change = fmax(*change, here);
            lo->rate[j][i] = rate[i];
        }
    }
    return IMP_STEP_STANDS;
}

/* Sweeps until what is left of them, as a geometric series would have it, is a tenth of the tolerance. */
static imp_one_step_outcome iterate(lobatto_ode *lo, double t, double end, double t_stop)
{
    enum { MOST = 15 };
    double before = INFINITY;
    lo->ratio = 0;
    for (int k = 0; k < MOST; k++) {
        double change;
        const imp_one_step_outcome outcome = sweep(lo, t, end, t_stop, &change);
        if (outcome != IMP_STEP_STANDS) return outcome;
        if (k > 0) lo->ratio = change / before;
        if (change <= IMP_LOBATTO_LEFT) return IMP_STEP_STANDS;
        if (k > 0 && lo->ratio < 1 && change * lo->ratio <= IMP_LOBATTO_LEFT * (1 - lo->ratio)) return IMP_STEP_STANDS;
        if (k > 1 && lo->ratio > IMP_LOBATTO_SLOW) return IMP_STEP_TOO_LONG;
        before = change;
    }
    return IMP_STEP_TOO_LONG;
}

/* The error of the polynomial, in scales. */
static double error_of(lobatto_ode *lo, double h)
{
    const imp_one_step *one = &lo->one;
    double size[NODES];
    for (int k = LAST - 3; k < NODES; k++) {
        for (int i = 0; i < one->ode.size; i++) {
            double p = 0;
            for (int j = 0; j < NODES; j++) p += lo->tables.transform[k][j] * (lo->rate[j][i] - one->first[i]);
            const double rounding = IMP_ONE_STEP_ROUNDING * fabs(h * one->first[i]);
            lo->guess[i] = fmax(fabs(h * p) / (2 * k + 1) - rounding, 0);
        }
        size[k] = imp_one_step_norm(one, lo->guess);
    }
    const double last = fmax(size[LAST], size[LAST - 1]), earlier = fmax(size[LAST - 2], size[LAST - 3]);
    return earlier > last ? last * last / earlier : last;
}

/* The next step's length: as the error, which goes as h^9, and the sweeps allow. Of sweeps that shrink errors by r,
 * which goes as h, a time takes 1/(h log 1/r): the least at r = 1/e. */
static double next_length(const lobatto_ode *lo, double h, imp_one_step_outcome outcome, double error)
{
    const double least = 0.1,
                 part = outcome == IMP_STEP_STANDS ? 0.9 * pow(fmax(error, IMP_ONE_STEP_GROWTH), -1.0 / TERMS) : 0.5;
    return fabs(h) * fmax(least, fmin(part, IMP_LOBATTO_RATIO / lo->ratio));
}

/* Shorter and shorter until it stands. */
static impact_status take_collocation(imp_one_step *one, double t, double t_stop, double *end)
{
    lobatto_ode *lo = lobatto_of(one);
    for (double failed = INFINITY;;) {
        *end = imp_one_step_end(one, t, t_stop);
        const double h = *end - t;
        if (!(h != 0 && fabs(h) < failed)) return imp_one_step_too_short(one);
        imp_one_step_set_scale(one, h);
        predict(lo, t, h);
        const imp_one_step_outcome outcome = iterate(lo, t, *end, t_stop);
        if (outcome == IMP_STEP_GAVE_UP) return imp_one_step_gave_up(one, h);
        const double error = outcome == IMP_STEP_STANDS ? error_of(lo, h) : INFINITY;
        one->h = next_length(lo, h, outcome, error);
        node_state(lo, LAST, h, one->y);
        if (error <= 1) {
            make_polynomial(one, h);
            return IMPACT_OK;
        }
        failed = fabs(h);
        one->counts.error_test_failures++;
        if (one->fresh) memset(one->slope, 0, sizeof *one->slope * (size_t)one->ode.size);
    }
}

static impact_status lobatto_open(impact_ode *ode)
{
    static const imp_one_step_method method = {
        .terms = TERMS, .order = TERMS, .vectors = NODES + 1, .take = take_collocation};
    imp_one_step *one = (imp_one_step *)ode;
    lobatto_ode *lo = lobatto_of(one);
    double *next;
    const impact_status status = imp_one_step_open(ode, &method, &next);
    if (status != IMPACT_OK) return status;
    for (int k = 0; k < NODES; k++, next += ode->def.size) lo->rate[k] = next;
    lo->guess = next;
    make_tables(&lo->tables);
    one->first = lo->rate[0], one->last = lo->rate[LAST];
    one->look = lo->tables.place + 1, one->looks = LAST; /* what comes and goes within a step is seen at the nodes */
    return IMPACT_OK;
}

const imp_ode_driver imp_ode_lobatto = {.bytes = sizeof(lobatto_ode),
                                        .open = lobatto_open,
                                        .close = imp_one_step_close,
                                        .resize = imp_one_step_resize,
                                        .start = imp_one_step_start,
                                        .limit_step = imp_one_step_limit,
                                        .set_tolerances = imp_one_step_set_tolerances,
                                        .step = imp_one_step_go,
                                        .interpolate = imp_one_step_interpolate,
                                        .count = imp_one_step_count};
