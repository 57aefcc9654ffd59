/* SPDX-License-Identifier: MIT
 *
 * Without friction only M_zz counts. Round bodies struck centrally have M = diag(l, l, w): sliding goes straight, and friction does not
 * act on u_z. In both, u_z rises by M_zz per unit of p throughout, and every law ends at p = (1 + eps) p_c.
 */
#include "collide_direct.h"

#include <float.h>

/* Whether every offset is along the normal and every body round; *l is then M_tt. */
static bool central(const impact_ready ready[2], qvec3 n, double *l)
{
    if (!ready[0].round || !ready[1].round) return false;
    *l = ready[0].inverse_mass + ready[1].inverse_mass;
    for (int i = 0; i < 2; i++) {
        const qvec3 r = ready[i].offset, x = qvec3_cross(r, n);
        const double r2 = qvec3_dot(r, r);
        /* A static body may be struck anywhere. */
        if (ready[i].inverse_mass != 0 && qvec3_dot(x, x) > 16 * DBL_EPSILON * DBL_EPSILON * r2) return false;
        *l += r2 * ready[i].inverse_moments.x;
    }
    return true;
}

/* M_zz */
static double along_normal(const impact_ready ready[2], qvec3 n)
{
    double w = ready[0].inverse_mass + ready[1].inverse_mass;
    for (int i = 0; i < 2; i++) {
        const qvec3 x = qvec3_cross(ready[i].offset, impact_ready_local(&ready[i], n));
        w += qvec3_dot(x, impact_ready_spin(&ready[i], x));
    }
    return w;
}

static void add_phase(impact_outcome *outcome, impact_phase phase)
{
    outcome->phases[outcome->phase_count++] = (unsigned char)phase;
}

/* What friction does to the tangential velocity t, |t| = s: its impulse, into the outcome, and how far it goes. */
static void rub(impact_outcome *outcome, const impact_collision *collision, qvec3 t, double s, double l)
{
    const double mu = collision->friction, p = outcome->impulse_normal, stop = s / l;
    const bool back = collision->restitution > 0, holds = stop < mu * p,
               soon = stop < mu * outcome->compression_impulse;
    if (s > 0) {
        /* The direction rounds: the cone is kept to the last bit. */
        const double f = holds ? stop : mu * p * (1 - DBL_EPSILON);
        outcome->impulse_tangential = f;
        outcome->impulse = qvec3_axpy(-f / s, t, outcome->impulse);
        outcome->work_friction = -f * (s - 0.5 * f * l);
        add_phase(outcome, IMPACT_SLIP_C);
    }
    if (soon) add_phase(outcome, IMPACT_STICK_C);
    if (back && !soon) add_phase(outcome, IMPACT_SLIP_R);
    if (back && holds) add_phase(outcome, IMPACT_STICK_R);
}

bool impact_direct_solve(const impact_collision *collision, const impact_ready ready[2], qvec3 n, qvec3 u,
                         double approach, double rounding, impact_outcome *outcome)
{
    const bool smooth = collision->friction == 0;
    double w = ready[0].inverse_mass + ready[1].inverse_mass, l = 0;
    if (smooth)
        w = along_normal(ready, n);
    else if (!central(ready, n, &l))
        return false;
    const double eps = collision->restitution, speed = -approach, p_c = speed / w, p = (1 + eps) * p_c;
    *outcome = (impact_outcome){.impulse = qvec3_scale(n, p),
                                .impulse_normal = p,
                                .normal_before = approach,
                                .normal_after = eps * speed,
                                .compression_impulse = p_c,
                                .work_compression = -0.5 * speed * p_c,
                                .work_restitution = 0.5 * eps * eps * speed * p_c,
                                .compressions = 1,
                                .solver = IMPACT_SOLVER_CLOSED_FORM,
                                .conditioning = smooth ? 1 : l / w};
    if (smooth) {
        add_phase(outcome, IMPACT_SLIP_C);
        if (eps > 0) add_phase(outcome, IMPACT_SLIP_R);
    } else {
        const qvec3 t = qvec3_axpy(-approach, n, u);
        const double s = sqrt(qvec3_dot(t, t));
        rub(outcome, collision, t, s > rounding ? s : 0, l);
    }
    outcome->energy_rose = outcome->work_compression + outcome->work_restitution + outcome->work_friction >
                           -1e-12 * outcome->work_compression;
    return true;
}
