/* SPDX-License-Identifier: MIT
 *
 * The classical method of Runge and Kutta with a fixed step h, as a textbook has it:
 *
 *     k1 = f(t, y), k2 = f(t + h/2, y + h k1/2), k3 = f(t + h/2, y + h k2/2), k4 = f(t + h, y + h k3)
 *     y(t + h) = y + h (k1 + 2 k2 + 2 k3 + k4)/6
 *
 * Between the ends the cubic with their values and rates (Hermite's), whose error is of the order h^4 too. A root
 * function that changes sign over a step has its root there on that cubic; the next step goes on from the root. It
 * shares no code with CVODE. (Hairer, Norsett, Wanner 1993, II.1 and II.6.)
 */
#include "base/ode_roots.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { STAGES = 4, VECTORS = STAGES + 3 };

typedef struct rk4_ode {
    impact_ode ode;
    double *memory;
    double *y, *before;   /* now; at the step's begin */
    double *rate[STAGES]; /* rate[0] that at the step's begin, rate[3] at its end */
    double *middle;
    imp_ode_roots roots;
    double limit; /* of the step; 0: none */
    bool fresh;   /* no step since the start: rate[3] and roots.value[1] are not those of y yet */
    bool at_root; /* the step was cut off: roots.state is the state now */
    impact_ode_counts counts;
} rk4_ode;

static rk4_ode *rk4_of(const impact_ode *ode) { return (rk4_ode *)(uintptr_t)ode; }

static impact_status rk4_open(impact_ode *ode)
{
    rk4_ode *rk = rk4_of(ode);
    const size_t n = (size_t)ode->def.size;
    rk->memory = imp_arena_take(ode->arena, VECTORS * n + imp_ode_roots_room(ode), sizeof *rk->memory);
    if (!rk->memory) return IMPACT_ENOMEM;
    double *next = imp_ode_roots_lay_out(ode, &rk->roots, rk->memory);
    rk->y = next, next += n;
    rk->before = next, next += n;
    rk->middle = next, next += n;
    for (int k = 0; k < STAGES; k++, next += n) rk->rate[k] = next;
    return IMPACT_OK;
}

static void rk4_close(impact_ode *ode) { imp_arena_give(ode->arena, rk4_of(ode)->memory); }

static void rk4_resize(impact_ode *ode) { (void)ode; }

static impact_status rk4_start(impact_ode *ode, double t, const double *y)
{
    (void)t;
    rk4_ode *rk = rk4_of(ode);
    memcpy(rk->y, y, sizeof *y * (size_t)ode->size);
    rk->fresh = true;
    rk->at_root = false;
    rk->counts = (impact_ode_counts){0};
    rk->roots.calls = 0;
    return IMPACT_OK;
}

static bool rk4_limit_step(impact_ode *ode, double max_step)
{
    if (!(max_step >= 0)) return false;
    rk4_of(ode)->limit = max_step;
    return true;
}

static impact_status rk4_set_tolerances(impact_ode *ode, double relative, const double *absolute, double same)
{
    (void)ode, (void)relative, (void)absolute, (void)same;
    return IMPACT_OK;
}

static impact_status rate_at(rk4_ode *rk, double t, const double *y, double *rate)
{
    impact_ode *ode = &rk->ode;
    rk->counts.rhs_calls++;
    const int answer = ode->def.rhs(t, y, rate, ode->def.context);
    if (answer == 0) return IMPACT_OK;
    return imp_ode_explain(ode, ode->t, ode->def.step,
                           answer > 0 ? "the right-hand side asks for a shorter step than the fixed one"
                                      : "the right-hand side gave up");
}

/* ---- between the ends ---- */

/* Hermite's cubic about the nearer end: in s = (t - begin)/h or (t - end)/h. */
static void hermite_at(const rk4_ode *rk, double t, int derivative, double *y)
{
    const double begin = rk->ode.step_begin, h = rk->ode.step_end - begin, along = h != 0 ? (t - begin) / h : 1;
    const bool late = along > 0.5;
    const double s = late ? (h != 0 ? (t - rk->ode.step_end) / h : 0) : along;
    for (int i = 0; i < rk->ode.size; i++) {
        const double rise = rk->y[i] - rk->before[i], first = h * rk->rate[0][i], last = h * rk->rate[3][i];
        const double c[4] = {late ? rk->y[i] : rk->before[i], late ? last : first,
                             late ? 2 * last + first - 3 * rise : 3 * rise - 2 * first - last, first + last - 2 * rise};
        const double value[4] = {((c[3] * s + c[2]) * s + c[1]) * s + c[0], (3 * c[3] * s + 2 * c[2]) * s + c[1],
                                 6 * c[3] * s + 2 * c[2], 6 * c[3]};
        y[i] = derivative == 0 ? value[0] : h != 0 ? value[derivative] / pow(h, derivative) : 0;
    }
}

static impact_status rk4_interpolate(const impact_ode *ode, double t, int derivative, double *y)
{
    const double low = fmin(ode->step_begin, ode->step_end), high = fmax(ode->step_begin, ode->step_end);
    const double slack = 100 * (nextafter(high, INFINITY) - high); /* as CVODE has it: roundings of t */
    if (derivative < 0 || derivative > 3 || !(t >= low - slack && t <= high + slack)) return IMPACT_EARGUMENT;
    const rk4_ode *rk = rk4_of(ode);
    if (!rk->fresh)
        hermite_at(rk, t, derivative, y);
    else if (derivative == 0)
        memcpy(y, rk->y, sizeof *y * (size_t)ode->size);
    else
        return IMPACT_EARGUMENT; /* no step was taken yet */
    return IMPACT_OK;
}

/* ---- a step ---- */

/* From here on: after a root from there, where the rates are not known yet. */
static impact_status begin_step(rk4_ode *rk, double t)
{
    if (rk->at_root) memcpy(rk->y, rk->roots.state, sizeof *rk->y * (size_t)rk->ode.size);
    if (rk->fresh || rk->at_root) {
        const impact_status status = rate_at(rk, t, rk->y, rk->rate[3]);
        if (status != IMPACT_OK) return status;
        const impact_status seen = imp_ode_roots_at(&rk->ode, &rk->roots, t, rk->y, rk->roots.value[1]);
        if (seen != IMPACT_OK) return seen;
    }
    memcpy(rk->before, rk->y, sizeof *rk->y * (size_t)rk->ode.size);
    memcpy(rk->rate[0], rk->rate[3], sizeof *rk->y * (size_t)rk->ode.size);
    memcpy(rk->roots.value[0], rk->roots.value[1], sizeof *rk->y * (size_t)rk->ode.roots);
    return IMPACT_OK;
}

static impact_status stage(rk4_ode *rk, int k, double t, double step)
{
    for (int i = 0; i < rk->ode.size; i++) rk->middle[i] = rk->before[i] + step * rk->rate[k - 1][i];
    return rate_at(rk, t + step, rk->middle, rk->rate[k]);
}

static impact_status take_step(rk4_ode *rk, double t, double h)
{
    impact_status status = stage(rk, 1, t, 0.5 * h);
    if (status == IMPACT_OK) status = stage(rk, 2, t, 0.5 * h);
    if (status == IMPACT_OK) status = stage(rk, 3, t, h);
    if (status != IMPACT_OK) return status;
    double sum = 0;
    for (int i = 0; i < rk->ode.size; i++) {
        rk->y[i] = rk->before[i] + h / 6 * (rk->rate[0][i] + 2 * rk->rate[1][i] + 2 * rk->rate[2][i] + rk->rate[3][i]);
        sum += 0 * rk->y[i];
    }
    return sum == 0 ? IMPACT_OK : imp_ode_explain(&rk->ode, t, h, "the step leads out of double precision");
}

/* As far as t_stop, which a last step longer by a rounding reaches: no sliver is left over. */
static double length_of(const rk4_ode *rk, double t, double t_stop)
{
    const double left = t_stop - t;
    const double h = rk->limit > 0 ? fmin(rk->ode.def.step, rk->limit) : rk->ode.def.step;
    return fabs(left) <= h * (1 + IMP_RK4_SLIVER) ? left : copysign(h, left);
}

static impact_status rk4_step(impact_ode *ode, double t_stop, double *y, bool *found)
{
    rk4_ode *rk = rk4_of(ode);
    const double t = ode->t, h = length_of(rk, t, t_stop), end = h == t_stop - t ? t_stop : t + h;
    if (t == t_stop) {
        memcpy(y, rk->at_root ? rk->roots.state : rk->y, sizeof *y * (size_t)ode->size);
        return IMPACT_OK;
    }
    if (end == t) return imp_ode_explain(ode, t, h, "the fixed step is too short to change t");
    impact_status status = begin_step(rk, t);
    if (status == IMPACT_OK) status = take_step(rk, t, h);
    if (status != IMPACT_OK) return status;
    rk->fresh = rk->at_root = false;
    ode->step_begin = t, ode->step_end = ode->t = end;
    status = rate_at(rk, end, rk->y, rk->rate[3]);
    if (status == IMPACT_OK) status = imp_ode_roots_at(ode, &rk->roots, end, rk->y, rk->roots.value[1]);
    if (status == IMPACT_OK) status = imp_ode_roots_first(ode, &rk->roots, t, end, found);
    if (status != IMPACT_OK) return status;
    rk->counts.steps++;
    rk->at_root = *found;
    memcpy(y, *found ? rk->roots.state : rk->y, sizeof *y * (size_t)ode->size);
    return IMPACT_OK;
}

static impact_ode_counts rk4_count(const impact_ode *ode)
{
    impact_ode_counts counts = rk4_of(ode)->counts;
    counts.root_calls = rk4_of(ode)->roots.calls;
    return counts;
}

const imp_ode_driver imp_ode_rk4 = {.bytes = sizeof(rk4_ode),
                                    .open = rk4_open,
                                    .close = rk4_close,
                                    .resize = rk4_resize,
                                    .start = rk4_start,
                                    .limit_step = rk4_limit_step,
                                    .set_tolerances = rk4_set_tolerances,
                                    .step = rk4_step,
                                    .interpolate = rk4_interpolate,
                                    .count = rk4_count};
