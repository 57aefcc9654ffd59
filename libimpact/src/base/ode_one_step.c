/* SPDX-License-Identifier: MIT */
#include "base/ode_one_step.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static imp_one_step *one_of(const impact_ode *ode) { return (imp_one_step *)(uintptr_t)ode; }

/* ---- memory ---- */

impact_status imp_one_step_open(impact_ode *ode, const imp_one_step_method *method, double **vectors)
{
    imp_one_step *one = one_of(ode);
    double **own[] = {&one->y, &one->before, &one->absolute, &one->scale, &one->slope};
    enum { OWN = sizeof own / sizeof *own };
    const size_t n = (size_t)ode->def.size, count = (size_t)(OWN + method->terms + method->vectors);
    one->method = method;
    one->memory = imp_arena_take(ode->arena, count * n + imp_ode_roots_room(ode), sizeof *one->memory);
    if (!one->memory) return IMPACT_ENOMEM;
    double *next = imp_ode_roots_lay_out(ode, &one->roots, one->memory);
    for (int k = 0; k < OWN; k++, next += n) *own[k] = next;
    for (int k = 0; k < method->terms; k++, next += n) one->term[k] = next;
    *vectors = next;
    one->relative = ode->def.relative_tolerance;
    for (int i = 0; i < ode->def.size; i++)
        one->absolute[i] = ode->def.absolute_tolerances ? ode->def.absolute_tolerances[i] : ode->def.absolute_tolerance;
    return IMPACT_OK;
}

void imp_one_step_close(impact_ode *ode) { imp_arena_give(ode->arena, one_of(ode)->memory); }

void imp_one_step_resize(impact_ode *ode) { (void)ode; }

impact_status imp_one_step_start(impact_ode *ode, double t, const double *y)
{
    (void)t;
    imp_one_step *one = one_of(ode);
    memcpy(one->y, y, sizeof *y * (size_t)ode->size);
    one->fresh = true;
    one->at_root = false;
    one->h = 0;
    one->counts = (impact_ode_counts){0};
    one->roots.calls = 0;
    return IMPACT_OK;
}

bool imp_one_step_limit(impact_ode *ode, double max_step)
{
    if (!(max_step >= 0)) return false;
    one_of(ode)->limit = max_step;
    return true;
}

impact_status imp_one_step_set_tolerances(impact_ode *ode, double relative, const double *absolute, double same)
{
    imp_one_step *one = one_of(ode);
    one->relative = relative;
    for (int i = 0; i < ode->size; i++) one->absolute[i] = absolute ? absolute[i] : same;
    return IMPACT_OK;
}

impact_ode_counts imp_one_step_count(const impact_ode *ode)
{
    impact_ode_counts counts = one_of(ode)->counts;
    counts.root_calls = one_of(ode)->roots.calls;
    return counts;
}

/* ---- f ---- */

impact_status imp_one_step_gave_up(imp_one_step *one, double h)
{
    return imp_ode_explain(&one->ode, one->ode.t, h, "the right-hand side gave up");
}

impact_status imp_one_step_too_short(imp_one_step *one)
{
    return imp_ode_explain(&one->ode, one->ode.t, one->h, "the error test fails however short the step is");
}

imp_one_step_outcome imp_one_step_rate(imp_one_step *one, double t, double t_stop, const double *y, double *rate)
{
    const double begin = one->ode.t;
    const double inside = t_stop - copysign(IMP_SWITCH_ROUNDING * fabs(t_stop), t_stop - begin);
    const double asked = t == t_stop && (inside - begin) * (t_stop - begin) > 0 ? inside : t;
    one->counts.rhs_calls++;
    const int answer = one->ode.def.rhs(asked, y, rate, one->ode.def.context);
    return answer == 0 ? IMP_STEP_STANDS : answer > 0 ? IMP_STEP_TOO_LONG : IMP_STEP_GAVE_UP;
}

/* ---- the polynomial ---- */

void imp_one_step_at(const imp_one_step *one, int derivative, double s, double h, double *y)
{
    const int n = one->ode.size, most = s != 0 ? one->method->terms - 1 : derivative;
    for (int m = most; m >= derivative; m--) {
        double factor = 1;
        for (int k = 0; k < derivative; k++) factor *= (m - k) / h;
        for (int i = 0; i < n; i++) y[i] = (m < most ? y[i] * s : 0) + factor * one->term[m][i];
    }
}

impact_status imp_one_step_interpolate(const impact_ode *ode, double t, int derivative, double *y)
{
    const imp_one_step *one = one_of(ode);
    const double h = ode->step_end - ode->step_begin;
    const double low = fmin(ode->step_begin, ode->step_end), high = fmax(ode->step_begin, ode->step_end);
    const double slack = 100 * (nextafter(high, INFINITY) - high); /* as CVODE has it: roundings of t */
    if (derivative < 0 || derivative >= one->method->terms || !(t >= low - slack && t <= high + slack))
        return IMPACT_EARGUMENT;
    if (one->fresh) {
        if (derivative > 0) return IMPACT_EARGUMENT; /* no step was taken yet */
        memcpy(y, one->y, sizeof *y * (size_t)ode->size);
        return IMPACT_OK;
    }
    imp_one_step_at(one, derivative, (t - ode->step_end) / h, h, y);
    return IMPACT_OK;
}

/* ---- a step ---- */

void imp_one_step_set_scale(imp_one_step *one, double h)
{
    for (int i = 0; i < one->ode.size; i++) {
        const double size = fabs(one->before[i]), way = fabs(h * one->first[i]);
        one->scale[i] = fmax(one->relative * size + one->absolute[i], IMP_ONE_STEP_ROUNDING * (size + way));
        if (!(one->scale[i] > 0)) one->scale[i] = IMP_ONE_STEP_LEAST;
    }
}

double imp_one_step_norm(const imp_one_step *one, const double *v)
{
    double most = 0;
    for (int i = 0; i < one->ode.size; i++) most = fmax(most, fabs(v[i]) / one->scale[i]);
    return most;
}

double imp_one_step_end(const imp_one_step *one, double t, double t_stop)
{
    const double left = t_stop - t, h = one->limit > 0 ? fmin(one->h, one->limit) : one->h;
    return fabs(left) <= h * (1 + IMP_RK4_SLIVER) ? t_stop : t + copysign(h, left);
}

/* The first step, by f and its rate, which stays in slope: what the rate alone tells of the error is a hundredth of the
 * tolerance (Hairer, Norsett, Wanner 1993, II.4). */
static impact_status choose_first(imp_one_step *one, double t, double t_stop)
{
    const double left = t_stop - t;
    imp_one_step_set_scale(one, 0);
    const double size = imp_one_step_norm(one, one->before), fast = imp_one_step_norm(one, one->first);
    double h = size > IMP_ONE_STEP_NOTHING && fast > IMP_ONE_STEP_NOTHING ? 0.01 * size / fast : IMP_ONE_STEP_FIRST;
    h = copysign(fmin(h, 0.5 * fabs(left)), left);
    for (int i = 0; i < one->ode.size; i++) one->y[i] = one->before[i] + h * one->first[i];
    const imp_one_step_outcome outcome = imp_one_step_rate(one, t + h, t_stop, one->y, one->roots.state);
    if (outcome == IMP_STEP_GAVE_UP) return imp_one_step_gave_up(one, 0);
    for (int i = 0; i < one->ode.size; i++)
        one->slope[i] = outcome == IMP_STEP_STANDS ? (one->roots.state[i] - one->first[i]) / h : 0;
    const double turning = fmax(fast, imp_one_step_norm(one, one->slope));
    one->h = turning > 0 ? pow(0.01 / turning, 1.0 / one->method->order) : fabs(left);
    return IMPACT_OK;
}

/* From here on: after a root from there, where the rates are not known yet. */
static impact_status begin_one_step(imp_one_step *one, double t, double t_stop)
{
    const size_t bytes = sizeof *one->y * (size_t)one->ode.size;
    if (one->at_root) memcpy(one->y, one->roots.state, bytes);
    if (one->fresh || one->at_root) {
        if (imp_one_step_rate(one, t, t_stop, one->y, one->last) != IMP_STEP_STANDS)
            return imp_one_step_gave_up(one, 0);
        const impact_status seen = imp_ode_roots_at(&one->ode, &one->roots, t, one->y, one->roots.value[1]);
        if (seen != IMPACT_OK) return seen;
    }
    memcpy(one->before, one->y, bytes);
    memcpy(one->first, one->last, bytes);
    memcpy(one->roots.value[0], one->roots.value[1], sizeof *one->y * (size_t)one->ode.roots);
    return one->fresh ? choose_first(one, t, t_stop) : IMPACT_OK;
}

/* Roots between each two of the looks. */
static impact_status look_for_roots(imp_one_step *one, double t, bool *found)
{
    impact_ode *ode = &one->ode;
    double low = t;
    for (int j = 0; j < one->looks && ode->roots > 0; j++) {
        const double high = j == one->looks - 1 ? ode->step_end : t + one->look[j] * (ode->step_end - t);
        if (j > 0) memcpy(one->roots.value[0], one->roots.value[1], sizeof *one->y * (size_t)ode->roots);
        impact_status status = imp_one_step_interpolate(ode, high, 0, one->roots.state);
        if (status == IMPACT_OK)
            status = imp_ode_roots_at(ode, &one->roots, high, one->roots.state, one->roots.value[1]);
        if (status == IMPACT_OK) status = imp_ode_roots_first(ode, &one->roots, low, high, found);
        if (status != IMPACT_OK || *found) return status;
        low = high;
    }
    return IMPACT_OK;
}

impact_status imp_one_step_go(impact_ode *ode, double t_stop, double *y, bool *found)
{
    imp_one_step *one = one_of(ode);
    const size_t bytes = sizeof *y * (size_t)ode->size;
    const double t = ode->t;
    double end = t;
    *found = false;
    if (t == t_stop) {
        memcpy(y, one->at_root ? one->roots.state : one->y, bytes);
        return IMPACT_OK;
    }
    impact_status status = begin_one_step(one, t, t_stop);
    if (status == IMPACT_OK) status = one->method->take(one, t, t_stop, &end);
    if (status != IMPACT_OK) return status;
    ode->step_begin = t, ode->step_end = ode->t = end;
    one->fresh = one->at_root = false;
    status = look_for_roots(one, t, found);
    if (status != IMPACT_OK) return status;
    one->counts.steps++;
    one->at_root = *found;
    memcpy(y, *found ? one->roots.state : one->y, bytes);
    return IMPACT_OK;
}
