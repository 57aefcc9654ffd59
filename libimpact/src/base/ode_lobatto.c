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
#include "base/ode_roots.h"
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
    impact_ode ode;
    lobatto_tables tables;
    double *memory;
    double *y, *before;  /* now; at the step's begin */
    double *rate[NODES]; /* f_j; rate[LAST] is that of the next step's begin */
    double *term[TERMS]; /* the last step's polynomial: y = sum_m term[m] s^m */
    double *absolute, *scale, *guess;
    imp_ode_roots roots;
    double relative;
    double limit;   /* of the step; 0: none */
    double h;       /* the next step's */
    double ratio;   /* of the last sweep's change to that before, in the last step; it goes as the step's length */
    bool fresh;     /* no step since the start: rate[LAST] and roots.value[1] are not those of y yet */
    bool continued; /* there is a polynomial to go on with */
    bool at_root;   /* the step was cut off: roots.state is the state now */
    impact_ode_counts counts;
} lobatto_ode;

static lobatto_ode *lobatto_of(const impact_ode *ode) { return (lobatto_ode *)(uintptr_t)ode; }

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

/* ---- memory ---- */

static impact_status lobatto_open(impact_ode *ode)
{
    lobatto_ode *lo = lobatto_of(ode);
    enum { VECTORS = 5 + NODES + TERMS };
    const size_t n = (size_t)ode->def.size;
    lo->memory = imp_arena_take(ode->arena, VECTORS * n + imp_ode_roots_room(ode), sizeof *lo->memory);
    if (!lo->memory) return IMPACT_ENOMEM;
    double *next = imp_ode_roots_lay_out(ode, &lo->roots, lo->memory);
    double **vectors[] = {&lo->y, &lo->before, &lo->absolute, &lo->scale, &lo->guess};
    for (int k = 0; k < 5; k++, next += n) *vectors[k] = next;
    for (int k = 0; k < NODES; k++, next += n) lo->rate[k] = next;
    for (int k = 0; k < TERMS; k++, next += n) lo->term[k] = next;
    lo->relative = ode->def.relative_tolerance;
    for (int i = 0; i < ode->def.size; i++)
        lo->absolute[i] = ode->def.absolute_tolerances ? ode->def.absolute_tolerances[i] : ode->def.absolute_tolerance;
    make_tables(&lo->tables);
    return IMPACT_OK;
}

static void lobatto_close(impact_ode *ode) { imp_arena_give(ode->arena, lobatto_of(ode)->memory); }

static void lobatto_resize(impact_ode *ode) { (void)ode; }

static impact_status lobatto_start(impact_ode *ode, double t, const double *y)
{
    (void)t;
    lobatto_ode *lo = lobatto_of(ode);
    memcpy(lo->y, y, sizeof *y * (size_t)ode->size);
    lo->fresh = true;
    lo->at_root = lo->continued = false;
    lo->h = 0;
    lo->counts = (impact_ode_counts){0};
    lo->roots.calls = 0;
    return IMPACT_OK;
}

static bool lobatto_limit_step(impact_ode *ode, double max_step)
{
    if (!(max_step >= 0)) return false;
    lobatto_of(ode)->limit = max_step;
    return true;
}

static impact_status lobatto_set_tolerances(impact_ode *ode, double relative, const double *absolute, double same)
{
    lobatto_ode *lo = lobatto_of(ode);
    lo->relative = relative;
    for (int i = 0; i < ode->size; i++) lo->absolute[i] = absolute ? absolute[i] : same;
    return IMPACT_OK;
}

/* ---- f ---- */

static impact_status gave_up(lobatto_ode *lo, double h)
{
    return imp_ode_explain(&lo->ode, lo->ode.t, h, "the right-hand side gave up");
}

/* f into rate; > 0, < 0: as the right-hand side answers. */
static int node_rate(lobatto_ode *lo, double t, const double *y, double *rate)
{
    lo->counts.rhs_calls++;
    return lo->ode.def.rhs(t, y, rate, lo->ode.def.context);
}

/* ---- the polynomial ---- */

/* Its derivative at s, in t. At the end, s = 0, which is asked for most, that is one term. */
static void polynomial_at(const lobatto_ode *lo, int derivative, double s, double h, double *y)
{
    const int n = lo->ode.size, most = s != 0 ? TERMS - 1 : derivative;
    for (int m = most; m >= derivative; m--) {
        double factor = 1;
        for (int k = 0; k < derivative; k++) factor *= (m - k) / h;
        for (int i = 0; i < n; i++) y[i] = (m < most ? y[i] * s : 0) + factor * lo->term[m][i];
    }
}

static impact_status lobatto_interpolate(const impact_ode *ode, double t, int derivative, double *y)
{
    const lobatto_ode *lo = lobatto_of(ode);
    const double h = ode->step_end - ode->step_begin;
    const double low = fmin(ode->step_begin, ode->step_end), high = fmax(ode->step_begin, ode->step_end);
    const double slack = 100 * (nextafter(high, INFINITY) - high); /* as CVODE has it: roundings of t */
    if (derivative < 0 || derivative >= TERMS || !(t >= low - slack && t <= high + slack)) return IMPACT_EARGUMENT;
    if (lo->fresh) {
        if (derivative > 0) return IMPACT_EARGUMENT; /* no step was taken yet */
        memcpy(y, lo->y, sizeof *y * (size_t)ode->size);
        return IMPACT_OK;
    }
    polynomial_at(lo, derivative, (t - ode->step_end) / h, h, y);
    return IMPACT_OK;
}

/* From p_k to powers of s, over the integral; y at the end stands in term[0]. */
static void make_polynomial(lobatto_ode *lo, double h)
{
    for (int i = 0; i < lo->ode.size; i++) {
        double p[NODES];
        for (int k = 0; k < NODES; k++) {
            p[k] = 0;
            for (int j = 0; j < NODES; j++) /* P_k's mean over the nodes is 0: what all have in common stays out */
                p[k] += lo->tables.transform[k][j] * (k > 0 ? lo->rate[j][i] - lo->rate[LAST][i] : lo->rate[j][i]);
        }
        for (int m = 0; m < NODES; m++) {
            double sum = 0;
            for (int k = m; k < NODES; k++) sum += lo->tables.power[k][m] * p[k];
            lo->term[m + 1][i] = h / (m + 1) * sum;
        }
        lo->term[0][i] = lo->y[i];
    }
}

/* ---- a step ---- */

/* What counts in each component: the tolerance, but never what rounding makes of it. */
static void set_scale(lobatto_ode *lo, double h)
{
    const double *f = lo->rate[0];
    for (int i = 0; i < lo->ode.size; i++) {
        const double size = fabs(lo->before[i]), way = fabs(h * f[i]);
        lo->scale[i] = fmax(lo->relative * size + lo->absolute[i], IMP_LOBATTO_ROUNDING * (size + way));
        if (!(lo->scale[i] > 0)) lo->scale[i] = IMP_LOBATTO_LEAST;
    }
}

static double norm_of(const lobatto_ode *lo, const double *v)
{
    double most = 0;
    for (int i = 0; i < lo->ode.size; i++) most = fmax(most, fabs(v[i]) / lo->scale[i]);
    return most;
}

/* y_i, by the rates as they stand. */
static void node_state(const lobatto_ode *lo, int i, double h, double *y)
{
    const int n = lo->ode.size;
    for (int k = 0; k < n; k++) y[k] = 0;
    for (int j = 0; j < NODES; j++)
        for (int k = 0; k < n; k++) y[k] += lo->tables.sum[i][j] * lo->rate[j][k];
    for (int k = 0; k < n; k++) y[k] = lo->before[k] + h * y[k];
}

/* The rates at the nodes as they may be expected: the polynomial continued, or along a line with the rate `guess`. */
static void predict(lobatto_ode *lo, double t, double h)
{
    const double last = lo->ode.step_end - lo->ode.step_begin;
    for (int j = 1; j < NODES; j++) {
        const double after = lo->tables.place[j] * h;
        if (lo->continued)
            polynomial_at(lo, 1, (t + after - lo->ode.step_end) / last, last, lo->rate[j]);
        else
            for (int i = 0; i < lo->ode.size; i++) lo->rate[j][i] = lo->rate[0][i] + after * lo->guess[i];
    }
}

static double node_time(const lobatto_ode *lo, int j, double t, double end)
{
    return j == LAST ? end : t + lo->tables.place[j] * (end - t);
}

/* Where f is asked: at t_stop, where it may jump, before that. */
static double asked_at(double time, double t, double t_stop)
{
    const double inside = t_stop - copysign(IMP_SWITCH_ROUNDING * fabs(t_stop), t_stop - t);
    return time == t_stop && (inside - t) * (t_stop - t) > 0 ? inside : time;
}

typedef enum lobatto_outcome { STANDS, TOO_LONG, GAVE_UP } lobatto_outcome;

/* Once over the nodes; the greatest change of a rate, as a way in scales. */
static lobatto_outcome sweep(lobatto_ode *lo, double t, double end, double t_stop, double *change)
{
    const double h = end - t;
    *change = 0;
    for (int j = 1; j < NODES; j++) {
        node_state(lo, j, h, lo->y);
        const double time = asked_at(node_time(lo, j, t, end), t, t_stop);
        const int answer = node_rate(lo, time, lo->y, lo->roots.state);
        if (answer != 0) return answer > 0 ? TOO_LONG : GAVE_UP;
        for (int i = 0; i < lo->ode.size; i++) {
            const double here = fabs(h * (lo->roots.state[i] - lo->rate[j][i])) / lo->scale[i];
            if (!(here <= IMP_LOBATTO_FAR)) return TOO_LONG;
            *change = fmax(*change, here);
            lo->rate[j][i] = lo->roots.state[i];
        }
    }
    return STANDS;
}

/* Sweeps until what is left of them, as a geometric series would have it, is a tenth of the tolerance. */
static lobatto_outcome iterate(lobatto_ode *lo, double t, double end, double t_stop)
{
    enum { MOST = 15 };
    double before = INFINITY;
    lo->ratio = 0;
    for (int k = 0; k < MOST; k++) {
        double change;
        const lobatto_outcome outcome = sweep(lo, t, end, t_stop, &change);
        if (outcome != STANDS) return outcome;
        if (k > 0) lo->ratio = change / before;
        if (change <= IMP_LOBATTO_LEFT) return STANDS;
        if (k > 0 && lo->ratio < 1 && change * lo->ratio <= IMP_LOBATTO_LEFT * (1 - lo->ratio)) return STANDS;
        if (k > 1 && lo->ratio > IMP_LOBATTO_SLOW) return TOO_LONG;
        before = change;
    }
    return TOO_LONG;
}

/* The error of the polynomial, in scales. */
static double error_of(lobatto_ode *lo, double h)
{
    double size[NODES];
    for (int k = LAST - 3; k < NODES; k++) {
        for (int i = 0; i < lo->ode.size; i++) {
            double p = 0;
            for (int j = 0; j < NODES; j++) p += lo->tables.transform[k][j] * (lo->rate[j][i] - lo->rate[0][i]);
            const double rounding = IMP_LOBATTO_ROUNDING * fabs(h * lo->rate[0][i]);
            lo->guess[i] = fmax(fabs(h * p) / (2 * k + 1) - rounding, 0);
        }
        size[k] = norm_of(lo, lo->guess);
    }
    const double last = fmax(size[LAST], size[LAST - 1]), earlier = fmax(size[LAST - 2], size[LAST - 3]);
    return earlier > last ? last * last / earlier : last;
}

/* The first step, by f and its rate, which stays in guess: h^9 of what the rate alone tells is a hundredth of the
 * tolerance (Hairer, Norsett, Wanner 1993, II.4). */
static lobatto_outcome first_step(lobatto_ode *lo, double t, double left)
{
    set_scale(lo, 0);
    const double size = norm_of(lo, lo->before), fast = norm_of(lo, lo->rate[0]);
    double h = size > IMP_LOBATTO_NOTHING && fast > IMP_LOBATTO_NOTHING ? 0.01 * size / fast : IMP_LOBATTO_FIRST;
    h = fmin(h, 0.5 * fabs(left));
    for (int i = 0; i < lo->ode.size; i++) lo->y[i] = lo->before[i] + copysign(h, left) * lo->rate[0][i];
    const int answer = node_rate(lo, t + copysign(h, left), lo->y, lo->roots.state);
    if (answer < 0) return GAVE_UP;
    for (int i = 0; i < lo->ode.size; i++)
        lo->guess[i] = answer == 0 ? (lo->roots.state[i] - lo->rate[0][i]) / copysign(h, left) : 0;
    const double turning = fmax(fast, norm_of(lo, lo->guess));
    lo->h = turning > 0 ? pow(0.01 / turning, 1.0 / TERMS) : fabs(left);
    return STANDS;
}

/* From here on: after a root from there, where the rates are not known yet. */
static impact_status begin_collocation(lobatto_ode *lo, double t, double left)
{
    const size_t bytes = sizeof *lo->y * (size_t)lo->ode.size;
    if (lo->at_root) memcpy(lo->y, lo->roots.state, bytes);
    if (lo->fresh || lo->at_root) {
        if (node_rate(lo, t, lo->y, lo->rate[LAST]) != 0) return gave_up(lo, 0);
        const impact_status seen = imp_ode_roots_at(&lo->ode, &lo->roots, t, lo->y, lo->roots.value[1]);
        if (seen != IMPACT_OK) return seen;
    }
    memcpy(lo->before, lo->y, bytes);
    memcpy(lo->rate[0], lo->rate[LAST], bytes);
    memcpy(lo->roots.value[0], lo->roots.value[1], sizeof *lo->y * (size_t)lo->ode.roots);
    if (!lo->fresh) return IMPACT_OK;
    return first_step(lo, t, left) == GAVE_UP ? gave_up(lo, 0) : IMPACT_OK;
}

/* The end of the step: t_stop, which a last step longer by a rounding reaches, no sliver being left over, or before. */
static double end_of(const lobatto_ode *lo, double t, double t_stop)
{
    const double left = t_stop - t, h = lo->limit > 0 ? fmin(lo->h, lo->limit) : lo->h;
    return fabs(left) <= h * (1 + IMP_RK4_SLIVER) ? t_stop : t + copysign(h, left);
}

/* The next step's length: as the error, which goes as h^9, and the sweeps allow. Of sweeps that shrink errors by r,
 * which goes as h, a time takes 1/(h log 1/r): the least at r = 1/e. */
static double next_length(const lobatto_ode *lo, double h, lobatto_outcome outcome, double error)
{
    const double least = 0.1, part = outcome == STANDS ? 0.9 * pow(fmax(error, IMP_LOBATTO_GROWTH), -1.0 / TERMS) : 0.5;
    return fabs(h) * fmax(least, fmin(part, IMP_LOBATTO_RATIO / lo->ratio));
}

/* Shorter and shorter until it stands. */
static impact_status take_collocation(lobatto_ode *lo, double t, double t_stop, double *end)
{
    for (double failed = INFINITY;;) {
        *end = end_of(lo, t, t_stop);
        const double h = *end - t;
        if (!(h != 0 && fabs(h) < failed)) /* a rounding of t is the shortest */
            return imp_ode_explain(&lo->ode, t, lo->h, "the error test fails however short the step is");
        set_scale(lo, h);
        predict(lo, t, h);
        const lobatto_outcome outcome = iterate(lo, t, *end, t_stop);
        if (outcome == GAVE_UP) return gave_up(lo, h);
        const double error = outcome == STANDS ? error_of(lo, h) : INFINITY;
        lo->h = next_length(lo, h, outcome, error);
        if (error <= 1) return IMPACT_OK;
        failed = fabs(h);
        lo->counts.error_test_failures++;
        if (lo->fresh) memset(lo->guess, 0, sizeof *lo->guess * (size_t)lo->ode.size);
    }
}

/* Roots between each two neighbours of the nodes: what comes and goes within a step is seen where the rates were. */
static impact_status look_for_roots(lobatto_ode *lo, double t, bool *found)
{
    impact_ode *ode = &lo->ode;
    double low = t;
    for (int j = 1; j < NODES && ode->roots > 0; j++) {
        const double high = node_time(lo, j, t, ode->step_end);
        if (j > 1) memcpy(lo->roots.value[0], lo->roots.value[1], sizeof *lo->y * (size_t)ode->roots);
        impact_status status = lobatto_interpolate(ode, high, 0, lo->roots.state);
        if (status == IMPACT_OK) status = imp_ode_roots_at(ode, &lo->roots, high, lo->roots.state, lo->roots.value[1]);
        if (status == IMPACT_OK) status = imp_ode_roots_first(ode, &lo->roots, low, high, found);
        if (status != IMPACT_OK || *found) return status;
        low = high;
    }
    return IMPACT_OK;
}

static impact_status lobatto_step(impact_ode *ode, double t_stop, double *y, bool *found)
{
    lobatto_ode *lo = lobatto_of(ode);
    const double t = ode->t;
    double end = t;
    *found = false;
    if (t == t_stop) {
        memcpy(y, lo->at_root ? lo->roots.state : lo->y, sizeof *y * (size_t)ode->size);
        return IMPACT_OK;
    }
    impact_status status = begin_collocation(lo, t, t_stop - t);
    if (status == IMPACT_OK) status = take_collocation(lo, t, t_stop, &end);
    if (status != IMPACT_OK) return status;
    node_state(lo, LAST, end - t, lo->y);
    ode->step_begin = t, ode->step_end = ode->t = end;
    make_polynomial(lo, end - t);
    lo->fresh = lo->at_root = false;
    lo->continued = true;
    status = look_for_roots(lo, t, found);
    if (status != IMPACT_OK) return status;
    lo->counts.steps++;
    lo->at_root = *found;
    memcpy(y, *found ? lo->roots.state : lo->y, sizeof *y * (size_t)ode->size);
    return IMPACT_OK;
}

static impact_ode_counts lobatto_count(const impact_ode *ode)
{
    impact_ode_counts counts = lobatto_of(ode)->counts;
    counts.root_calls = lobatto_of(ode)->roots.calls;
    return counts;
}

const imp_ode_driver imp_ode_lobatto = {.bytes = sizeof(lobatto_ode),
                                        .open = lobatto_open,
                                        .close = lobatto_close,
                                        .resize = lobatto_resize,
                                        .start = lobatto_start,
                                        .limit_step = lobatto_limit_step,
                                        .set_tolerances = lobatto_set_tolerances,
                                        .step = lobatto_step,
                                        .interpolate = lobatto_interpolate,
                                        .count = lobatto_count};
