/* SPDX-License-Identifier: MIT
 *
 * h(m(T)), m(T) = m + m' T + m'' T^2/2 + what the jerk bounds, for any k >= 0 and T^2 <= 1/k, by homogeneity and
 * subadditivity:
 *
 *     h(m(T)) <= h((1 - k T^2/2) m + m' T) + h(m'' + k m) T^2/2
 *
 * The first and k h(m) T^2/2 make a convex function, as the support point there lies no further along m than h(m). What
 * is left bends by C = h(m'' + k m) - k h(m), which falls with k from h(m''), what m'' could do to any of the body's
 * points, towards m''.p, what it does to the one that is nearest: of a corner that has just left the ground nothing.
 */
#include "motion/psi.h"
#include "base/tolerances.h"
#include "world/world_gap.h"

#include <impact/flight.h>

/* psi for one k. */
typedef struct psi {
    const imp_psi *of;
    double k, bend;
} psi;

static psi psi_for(const imp_psi *p, double k)
{
    double bend = p->bend;
    for (int i = 0; i < p->count; i++) {
        const imp_turning *b = &p->body[i];
        const qvec3 to = qvec3_axpy(k, b->m, b->second);
        qvec3 point;
        if (!(qvec3_dot(to, to) > 0)) continue;
        bend += imp_world_support(b->body, to, &point) - k * b->h;
    }
    return (psi){p, k, fmax(0, bend)};
}

static double psi_at(const psi *f, double T, double *derivative)
{
    const imp_psi *p = f->of;
    double value = p->gap + T * (p->speed - T * (0.5 * f->bend + T * p->jerk / 6)),
           d = p->speed - T * (f->bend + 0.5 * T * p->jerk);
    for (int i = 0; i < p->count; i++) {
        const imp_turning *b = &p->body[i];
        const double s = 1 - 0.5 * f->k * T * T;
        qvec3 point;
        value -= imp_world_support(b->body, qvec3_axpy(T, b->rate, qvec3_scale(b->m, s)), &point) - s * b->h;
        d -= qvec3_dot(b->rate, point) + f->k * T * (b->h - qvec3_dot(b->m, point));
    }
    *derivative = d;
    return value;
}

/* No psi for this k is still above zero there: it lies below its tangent at 0. */
static double below_zero(const psi *f)
{
    const imp_psi *p = f->of;
    const double T = impact_flight_fall_time(p->gap, p->slope, -f->bend);
    return p->jerk > 0 ? fmin(T, fmax(cbrt(12 * p->gap / p->jerk), sqrt(12 * fmax(0, p->slope) / p->jerk))) : T;
}

/* Newton's iteration comes down on the zero of the concave psi from the right; a chord over its last half leads to
 * before it. */
static double solve_psi(const psi *f, double T)
{
    enum { TRIES = 60 };
    double derivative, value = 0;
    for (int i = 0; i < TRIES && T > 0; i++) {
        value = psi_at(f, T, &derivative);
        if (value >= 0) return T;
        if (value > -IMP_PSI_NEAR * f->of->gap) break;
        const double next = T - value / derivative;
        if (!(next < T * (1 - IMP_PSI_STEP))) break;
        T = fmax(next, 0);
    }
    double half = 0.5 * T, at_half = psi_at(f, half, &derivative);
    for (int i = 0; i < TRIES && at_half < 0; i++) {
        T = half, value = at_half;
        half = 0.5 * T, at_half = psi_at(f, half, &derivative);
    }
    return at_half < 0 ? 0 : half + (T - half) * (at_half / (at_half - value));
}

/* With k for steps that reach so many times as far as the last; a step that is as long as that is taken from anew. */
double imp_psi_safe_step(const imp_psi *p, double limit)
{
    enum { ROUNDS = 30 };
    psi f = psi_for(p, 0);
    double T = fmin(limit, below_zero(&f));
    if (!isfinite(T) || p->count == 0) return isfinite(T) ? solve_psi(&f, T) : T;
    for (int i = 0; i < ROUNDS && T > 0; i++) {
        const double reach = IMP_PSI_REACH * T;
        f = psi_for(p, 1 / (reach * reach));
        T = solve_psi(&f, fmin(limit, fmin(reach, below_zero(&f))));
        if (T < reach) break;
    }
    return T;
}
