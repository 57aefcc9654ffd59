/* SPDX-License-Identifier: MIT */
#include "motion/psi.h"
#include "base/tolerances.h"
#include "world/world_gap.h"

static double psi(const imp_psi *p, double T, double *derivative)
{
    double value = p->gap + T * (p->speed - T * (0.5 * p->bend + T * p->jerk / 6)),
           d = p->speed - T * (p->bend + 0.5 * T * p->jerk);
    for (int k = 0; k < p->count; k++) {
        qvec3 point;
        value -=
            imp_world_support(p->body[k].body, qvec3_axpy(T, p->body[k].rate, p->body[k].m), &point) - p->body[k].h;
        d -= qvec3_dot(p->body[k].rate, point);
    }
    *derivative = d;
    return value;
}

/* Newton's iteration comes down on the zero of the concave psi from the right; a chord over its last half leads to
 * before it. */
double imp_psi_safe_step(const imp_psi *p, double T)
{
    enum { TRIES = 60 };
    double derivative, value = 0;
    for (int i = 0; i < TRIES && T > 0; i++) {
        value = psi(p, T, &derivative);
        if (value >= 0) return T;
        if (value > -IMP_PSI_NEAR * p->gap) break;
        const double next = T - value / derivative;
        if (!(next < T * (1 - IMP_PSI_STEP))) break;
        T = fmax(next, 0);
    }
    double half = 0.5 * T, at_half = psi(p, half, &derivative);
    for (int i = 0; i < TRIES && at_half < 0; i++) {
        T = half, value = at_half;
        half = 0.5 * T, at_half = psi(p, half, &derivative);
    }
    return at_half < 0 ? 0 : half + (T - half) * (at_half / (at_half - value));
}
