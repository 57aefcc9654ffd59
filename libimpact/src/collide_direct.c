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

/* The impulse of friction on the tangential velocity t: how large, its work, and whether it stops it, in compression or at all. */
typedef struct friction {
    double impulse, work;
    bool holds, holds_soon;
} friction;

static friction rub(double mu, double p, double p_c, double s, double l)
{
    const double stop = s / l;
    friction f = {0, 0, stop < mu * p, stop < mu * p_c};
    /* The direction rounds: the cone is kept to the last bit. */
    f.impulse = f.holds ? stop : mu * p * (1 - DBL_EPSILON);
    f.work = -f.impulse * (s - 0.5 * f.impulse * l);
    return f;
}

static int list_phases(const friction *f, bool slides, bool back, unsigned char *phases)
{
    int n = 0;
    if (slides) phases[n++] = IMPACT_SLIP_C;
    if (f->holds_soon) phases[n++] = IMPACT_STICK_C;
    if (back && !f->holds_soon) phases[n++] = IMPACT_SLIP_R;
    if (back && f->holds) phases[n++] = IMPACT_STICK_R;
    return n;
}

bool impact_direct_solve(const impact_collision *collision, const impact_ready ready[2], qvec3 n, qvec3 u,
                         double approach, double rounding, impact_outcome *outcome)
{
    const bool smooth = collision->friction == 0;
    double w = ready[0].inverse_mass + ready[1].inverse_mass, l = 1;
    if (smooth)
        w = along_normal(ready, n);
    else if (!central(ready, n, &l))
        return false;
    const double eps = collision->restitution, speed = -approach, p_c = speed / w, p = (1 + eps) * p_c;
    const double work = 0.5 * speed * p_c, back = eps * eps * work;
    const qvec3 normal = qvec3_scale(n, p), t = qvec3_axpy(speed, n, u);
    const double t2 = qvec3_dot(t, t), length = t2 > DBL_MIN && t2 < DBL_MAX ? sqrt(t2) : qvec3_norm(t);
    const double s = length > rounding ? length : 0;
    const friction f = rub(collision->friction, p, p_c, s, l);
    const bool rubs = s > 0 && !smooth;
    outcome->impulse = rubs ? qvec3_axpy(-f.impulse / s, t, normal) : normal;
    outcome->impulse_normal = p;
    outcome->impulse_tangential = rubs ? f.impulse : 0;
    outcome->normal_before = approach;
    outcome->normal_after = eps * speed;
    outcome->compression_impulse = p_c;
    outcome->work_compression = -work;
    outcome->work_restitution = back;
    outcome->work_friction = rubs ? f.work : 0;
    outcome->compressions = 1;
    outcome->phase_count = list_phases(&f, smooth || s > 0, eps > 0, outcome->phases);
    outcome->solver = IMPACT_SOLVER_CLOSED_FORM;
    outcome->conditioning = smooth ? 1 : l / w;
    outcome->jammed = false;
    outcome->energy_rose = back - work + outcome->work_friction > 1e-12 * work;
    return true;
}
