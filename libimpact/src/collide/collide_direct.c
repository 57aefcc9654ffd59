/* SPDX-License-Identifier: MIT
 *
 * Without friction only M_zz counts. Round bodies struck centrally have M = diag(l, l, w): sliding goes straight, and
 * friction does not act on u_z. In both, u_z rises by M_zz per unit of p throughout, and every law ends at p = (1 +
 * eps) p_c.
 */
#include "collide/collide_direct.h"

#include <float.h>

/* Whether every offset is along the normal and every body round; *l is then M_tt. */
static bool central(const imp_ready *ready, qvec3 n, double *l)
{
    if (!ready->round) return false;
    const imp_vectors *r = &ready->offset, normal = imp_vectors_of(n, n), x = imp_vectors_cross(r, &normal);
    const imp_pair r2 = imp_vectors_dot(r, r), aside = imp_vectors_dot(&x, &x);
    if (imp_mask_any(aside > 16 * DBL_EPSILON * DBL_EPSILON * r2)) return false;
    const imp_pair each = ready->inverse_mass + r2 * ready->inverse_moments.x;
    *l = each[0] + each[1];
    return true;
}

/* M_zz */
static double along_normal(const imp_ready *ready, qvec3 n)
{
    const imp_vectors each = imp_vectors_of(n, n), there = imp_ready_local(ready, &each);
    const imp_vectors x = imp_vectors_cross(&ready->offset, &there);
    const imp_vectors turn = imp_vectors_weigh(&ready->inverse_moments, &x);
    const imp_pair w = ready->inverse_mass + imp_vectors_dot(&x, &turn);
    return w[0] + w[1];
}

/* |M| |M^-1| / 3 of M = diag(l, l, 1). */
static double conditioning(double l) { return sqrt((2 * l * l + 1) * (2 + l * l)) / (3 * l); }

/* The impulse of friction on the tangential velocity t: how large, its work, and whether it stops it, in compression or
 * at all. */
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

bool imp_direct_solve(const impact_collision *collision, const imp_ready *ready, qvec3 n, qvec3 t, double s,
                      double speed, impact_outcome *outcome)
{
    const bool smooth = collision->friction == 0;
    double w = ready->inverse_mass[0] + ready->inverse_mass[1], l = 1;
    if (smooth)
        w = along_normal(ready, n);
    else if (!central(ready, n, &l))
        return false;
    const double eps = collision->restitution, p_c = speed / w, p = (1 + eps) * p_c;
    const double work = 0.5 * speed * p_c, back = eps * eps * work;
    const qvec3 normal = qvec3_scale(n, p);
    const friction f = rub(collision->friction, p, p_c, s, l);
    const bool rubs = s > 0 && !smooth;
    outcome->impulse = rubs ? qvec3_axpy(-f.impulse / s, t, normal) : normal;
    outcome->impulse_normal = p;
    outcome->impulse_tangential = rubs ? f.impulse : 0;
    outcome->normal_before = -speed;
    outcome->normal_after = eps * speed;
    outcome->compression_impulse = p_c;
    outcome->work_compression = -work;
    outcome->work_restitution = back;
    outcome->work_friction = rubs ? f.work : 0;
    outcome->compressions = 1;
    outcome->phase_count = list_phases(&f, smooth || s > 0, eps > 0, outcome->phases);
    outcome->solver = IMPACT_SOLVER_CLOSED_FORM;
    outcome->conditioning = smooth ? 1 : conditioning(l / w);
    outcome->jammed = false;
    outcome->energy_rose = back - work + outcome->work_friction > 1e-12 * work;
    return true;
}
