/* SPDX-License-Identifier: MIT
 *
 * Moreau's compression and Poisson's restitution of all contacts at once (Glocker & Pfeiffer 1995; Anitescu & Potra
 * 1997):
 *
 *     u = u0 + W c,  K* contains u + mu |u_t| n,  c . (u + mu |u_t| n) = 0,  K contains c            compression
 *     u' = u + W r:  r_n >= eps c_n,  u_n' >= 0,  (r_n - eps c_n) u_n' = 0,  r_t against u_t'         restitution
 *
 * The second is a problem of the same kind in twice the contacts: of each contact once the part eps c_n, whose normal
 * row is set apart, v = d (r - eps c_n), so that it is what it is, and once what is more; each with friction of its own
 * cone against the one u_t.
 */
#include "contact/encounter.h"

#include <string.h>
#include "base/tolerances.h"

typedef struct moreau {
    imp_group *group;
    imp_cone_workspace *cone;
    double *w, *q, *friction, *r, *v; /* of the second problem: 6 count */
    double *u;                        /* 3 count: after compression */
} moreau;

static bool solved(const imp_cone_outcome *o, imp_group *group)
{
    group->steps += o->factorings;
    group->chosen = group->chosen || o->chosen;
    return o->status == IMP_CONE_SOLVED || o->status == IMP_CONE_INEXACT;
}

static bool compress(moreau *m)
{
    const int n = m->group->count;
    for (int i = 0; i < n; i++) m->friction[i] = m->group->contacts[i].friction;
    const imp_cone_problem problem = {.count = n, .w = m->group->w, .q = m->group->u0, .friction = m->friction};
    const imp_cone_outcome o = imp_cone_solve(&problem, m->cone, m->group->p, m->u, NULL);
    return solved(&o, m->group);
}

/* The second problem: contact i is what is more, n + i its part eps c_n. */
static void set_restitution(moreau *m)
{
    const imp_group *g = m->group;
    const size_t n = (size_t)g->count, one = 3 * n, two = 6 * n;
    double mean = 0;
    for (size_t i = 0; i < n; i++) mean += g->w[3 * i * (one + 1)] / (double)n;
    for (size_t i = 0; i < two; i++)
        for (size_t j = 0; j < two; j++) {
            const bool apart = (i >= one && i % 3 == 0) || (j >= one && j % 3 == 0);
            m->w[i * two + j] = apart ? (i == j ? mean : 0) : g->w[i % one * one + j % one];
        }
    for (size_t i = 0; i < one; i++) {
        m->q[i] = m->u[i];
        for (size_t c = 0; c < n; c++) m->q[i] += g->w[i * one + 3 * c] * (g->contacts[c].restitution * g->p[3 * c]);
        m->q[one + i] = i % 3 == 0 ? -mean * (g->contacts[i / 3].restitution * g->p[i]) : m->q[i];
    }
    for (size_t i = 0; i < n; i++) m->friction[n + i] = m->friction[i];
}

/* Works by impulses: p . (u + u')/2, normal and tangential. */
static void book(imp_finding *f, int phase, const double *p, const double *u, const double *after)
{
    const double normal = 0.5 * p[0] * (u[0] + after[0]);
    f->work[normal < 0 ? 0 : 1] += normal;
    f->work[2] += 0.5 * (p[1] * (u[1] + after[1]) + p[2] * (u[2] + after[2]));
    f->compressions += phase == 0 && p[0] > 0;
}

static bool restore(moreau *m)
{
    imp_group *g = m->group;
    const int n = g->count;
    set_restitution(m);
    const imp_cone_problem problem = {.count = 2 * n, .w = m->w, .q = m->q, .friction = m->friction};
    const imp_cone_outcome o = imp_cone_solve(&problem, m->cone, m->r, m->v, NULL);
    if (!solved(&o, g)) return false;
    for (int i = 0; i < n; i++) {
        const double *more = &m->r[3 * i], *part = &m->r[3 * (n + i)];
        const double given = g->contacts[i].restitution * g->p[3 * i];
        const double p[3] = {more[0] + given, more[1] + part[1], more[2] + part[2]};
        book(&g->findings[i], 0, &g->p[3 * i], &g->u0[3 * i], &m->u[3 * i]);
        book(&g->findings[i], 1, p, &m->u[3 * i], &m->v[3 * i]);
        for (int j = 0; j < 3; j++) g->p[3 * i + j] += p[j];
    }
    return true;
}

impact_status imp_moreau_solve(imp_group *group, impact_together_workspace *workspace)
{
    const size_t n = (size_t)group->count;
    moreau m = {.group = group, .cone = &workspace->cone};
    m.w = imp_encounter_take(workspace, 36 * n * n, sizeof *m.w);
    m.q = imp_encounter_take(workspace, 6 * n, sizeof *m.q);
    m.friction = imp_encounter_take(workspace, 2 * n, sizeof *m.friction);
    m.r = imp_encounter_take(workspace, 6 * n, sizeof *m.r);
    m.v = imp_encounter_take(workspace, 6 * n, sizeof *m.v);
    m.u = imp_encounter_take(workspace, 3 * n, sizeof *m.u);
    if (!m.u || !imp_cone_reserve(m.cone, 2 * group->count)) return IMPACT_ENOMEM;
    if (!compress(&m) || !restore(&m)) return IMPACT_EUNSETTLED;
    return IMPACT_OK;
}
