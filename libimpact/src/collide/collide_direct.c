/* SPDX-License-Identifier: MIT
 *
 * Without friction only M_zz counts. Round bodies struck centrally have M = diag(l, l, w): sliding goes straight, and
 * friction does not act on u_z. In both, u_z rises by M_zz per unit of p throughout, and every law ends at p = (1 +
 * eps) p_c.
 */
#include "collide/collide_direct.h"
#include "base/tolerances.h"

#include <float.h>

/* Whether every offset is along the normal and every body round; *l is then M_tt. */
static bool central(const imp_ready *ready, qvec3 n, double *l)
{
    if (!ready->round) return false;
    const imp_vectors *r = &ready->offset, normal = imp_vectors_of(n, n), x = imp_vectors_cross(r, &normal);
    const imp_lanes r2 = imp_vectors_dot(r, r), aside = imp_vectors_dot(&x, &x);
    if (imp_mask_any(aside > 16 * DBL_EPSILON * DBL_EPSILON * r2)) return false;
    const imp_lanes each = ready->inverse_mass + r2 * ready->inverse_moments.x;
    *l = each[0] + each[1];
    return true;
}

/* M_zz */
static double along_normal(const imp_ready *ready, qvec3 n)
{
    const imp_vectors each = imp_vectors_of(n, n), there = imp_ready_local(ready, &each);
    const imp_vectors x = imp_vectors_cross(&ready->offset, &there);
    const imp_vectors turn = imp_vectors_weigh(&ready->inverse_moments, &x);
    const imp_lanes w = ready->inverse_mass + imp_vectors_dot(&x, &turn);
    return w[0] + w[1];
}

/* |M| |M^-1| / 3 of M = diag(l, l, 1). */
static double diagonal_conditioning(double l)
{
    const double inverse = 1 / l;
    return sqrt(2 * (l * l + inverse * inverse) + 5) / 3;
}

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

/* The phases, and the impulse up to the end of each: p along n, q against the sliding e. */
typedef struct phase_list {
    qvec3 n, e;
    impact_outcome *outcome;
} phase_list;

static inline void add_phase(const phase_list *list, impact_phase phase, double p, double q)
{
    impact_outcome *o = list->outcome;
    o->phase_impulse[o->phase_count] = qvec3_axpy(-q, list->e, qvec3_scale(list->n, p));
    o->phases[o->phase_count++] = (unsigned char)phase;
}

/* The last one ends with the whole impulse. */
static inline void end_phase(impact_outcome *o, impact_phase phase)
{
    o->phase_impulse[o->phase_count] = o->impulse;
    o->phases[o->phase_count++] = (unsigned char)phase;
}

static void list_phases(const phase_list *list, const friction *f, bool slides, double mu, double p_c, double p)
{
    const bool restores = p > p_c;
    impact_outcome *o = list->outcome;
    o->phase_count = 0;
    if (slides && f->holds_soon)
        add_phase(list, IMPACT_SLIP_C, f->impulse / mu, f->impulse);
    else if (slides && restores)
        add_phase(list, IMPACT_SLIP_C, p_c, mu * p_c);
    if (!restores) {
        end_phase(o, f->holds_soon ? IMPACT_STICK_C : IMPACT_SLIP_C);
        return;
    }
    if (f->holds_soon)
        add_phase(list, IMPACT_STICK_C, p_c, f->impulse);
    else if (f->holds)
        add_phase(list, IMPACT_SLIP_R, f->impulse / mu, f->impulse);
    end_phase(o, f->holds ? IMPACT_STICK_R : IMPACT_SLIP_R);
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
    const phase_list list = {n, rubs ? qvec3_scale(t, 1 / s) : (qvec3){0, 0, 0}, outcome};
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
    list_phases(&list, &f, smooth || s > 0, collision->friction, p_c, p);
    outcome->solver = IMPACT_SOLVER_CLOSED_FORM;
    outcome->conditioning = smooth ? 1 : diagonal_conditioning(l / w);
    outcome->jammed = false;
    outcome->energy_rose = back - work + outcome->work_friction > IMP_COLLIDE_ROSE * work;
    return true;
}
