/* SPDX-License-Identifier: MIT
 *
 * Moreau's compression and Poisson's restitution of all contacts at once (Glocker & Pfeiffer 1995; Anitescu & Potra
 * 1997):
 *
 *     u = u0 + W c,  K* contains u + mu |u_t| n,  c . (u + mu |u_t| n) = 0,  K contains c            compression
 *     u' = u + W r:  r_n >= eps c_n,  u_n' >= 0,  (r_n - eps c_n) u_n' = 0,  r_t against u_t'         restitution
 *
 * The second is a problem of the same kind in more contacts: of each contact what is more than eps c_n, and of those
 * that pressed the part eps c_n besides, whose normal row is set apart, v = d (r - eps c_n), so that it is what it is;
 * each with friction of its own cone against the one u_t. Newton's restitution is one problem, of what velocities are
 * more than their rebound (Moreau 1988):
 *
 *     b = eps max(-u0_n, 0):  u' = u0 + W p,  K* contains u' - b n + mu |u_t'| n,  p . (the same) = 0,  K contains p
 */
#include "contact/encounter.h"

#include <float.h>
#include <string.h>
#include "base/tolerances.h"

typedef struct moreau {
    imp_group *group;
    impact_together_workspace *workspace;
    imp_cone_workspace *cone;
    double *w, *q, *friction, *r, *v; /* of the second problem: 6 count */
    double *u;                        /* 3 count: after compression */
    imp_cone_mode *modes;             /* 2 count */
    double *last_r, *last_u;          /* 6 count: where a problem may begin */
    double *room;                     /* of the question whether it is wedged */
    double *least;                    /* count: eps c_n */
    int parts, *part_of;              /* those that are not zero; count: whose they are */
    double *rebound;                  /* count: b; by Poisson's law 0 */
    int bodies, (*couples)[2];        /* those that move; count */
    bool strikes;                     /* not only the seeds of what is pressed do */
    double residual;                  /* of the last problem's answer */
    imp_cone_row *rows;               /* count */
} moreau;

/* Whether what r leaves is rounding of W r, though that be more than q: encounter_mend.c takes it away. */
static bool is_rounding(const imp_cone_problem *problem, double residual, const double *r)
{
    const int n = 3 * problem->count;
    double terms = 0, size = 0;
    for (int i = 0; i < n; i++) {
        double sum = 0;
        for (int j = 0; j < n; j++) sum += fabs(problem->w[(size_t)i * (size_t)n + (size_t)j] * r[j]);
        terms = fmax(terms, sum);
        size = fmax(size, fabs(problem->q[i]));
    }
    return residual * size <= IMP_ENCOUNTER_ROUNDINGS * DBL_EPSILON * terms;
}

static bool solved(moreau *m, const imp_cone_problem *problem, const imp_cone_outcome *o, const double *r)
{
    m->residual = o->residual;
    m->group->steps += o->factorings;
    m->group->chosen = m->group->chosen || o->chosen;
    return o->status == IMP_CONE_SOLVED || o->status == IMP_CONE_INEXACT ||
           (o->status == IMP_CONE_UNSETTLED && is_rounding(problem, o->residual, r));
}

static bool find_answer(moreau *m, const imp_cone_problem *problem, double *r, double *u, imp_cone_outcome *o)
{
    *o = imp_cone_solve(problem, m->cone, r, u, m->modes);
    return solved(m, problem, o, r);
}

/* Whether what pressed has the velocities that the modes say, and what did not keeps its rebound: where nothing solves
 * a problem its impulses grow without end, and their rounding hides what they leave. */
static bool comes_to(const imp_group *g, const double *u, const double *modes_say, const double *rebound)
{
    double off = 0, speed = 0;
    for (int i = 0; i < g->count; i++) {
        speed = fmax(speed, fmax(fabs(g->u0[3 * i]), fabs(u[3 * i])));
        off = fmax(off, g->p[3 * i] > 0 ? fabs(u[3 * i] - modes_say[3 * i]) : rebound[i] - u[3 * i]);
    }
    return off <= IMP_ENCOUNTER_RECEIPT * speed;
}

/* ---- a start for many contacts: in the space of the bodies ---- */

static int find_number(const moreau *m, int contacts, int body)
{
    for (int c = 0; c <= contacts; c++)
        for (int side = 0; side < 2; side++)
            if (m->group->contacts[c].body[side] == body && m->couples[c][side] >= 0) return m->couples[c][side];
    return -1;
}

static void couple_contacts(moreau *m)
{
    const imp_group *g = m->group;
    for (int c = 0; c < g->count; c++) {
        const imp_contact *contact = &g->contacts[c];
        memcpy(m->rows[c].side, contact->row, sizeof contact->row);
        m->couples[c][0] = m->couples[c][1] = -1;
        for (int side = 0; side < 2; side++) {
            if (imp_encounter_is_static(&g->bodies[contact->body[side]])) continue;
            const int known = find_number(m, c, contact->body[side]);
            m->couples[c][side] = known >= 0 ? known : m->bodies++;
        }
    }
}

/* Impulses of at least that along the normals, and the velocities after them, of the problem that begins with the
 * velocities q; whether there is a start. */
static bool find_start(moreau *m, const double *q, const double *least)
{
    const int n = m->group->count;
    if (n < IMP_ENCOUNTER_MANY) return false;
    if (m->bodies == 0) couple_contacts(m);
    const imp_cone_problem problem = {.count = n, .q = q, .friction = m->friction, .enough = IMP_CONE_ACCEPTED};
    const imp_cone_couples couples = {
        .bodies = m->bodies, .of = (const int(*)[2])m->couples, .rows = m->rows, .least = least};
    const imp_cone_outcome o = imp_cone_solve_bodies(&m->workspace->bodies, &problem, &couples, m->last_r, m->last_u);
    return o.status == IMP_CONE_SOLVED || o.status == IMP_CONE_INEXACT;
}

/* The start of the second problem, from that with R = (eps c_n + more, R_t): friction in the parts' proportion. */
static void part_start(const moreau *m)
{
    const int n = m->group->count;
    for (int k = 0; k < m->parts; k++) {
        const int i = m->part_of[k];
        double *own = &m->last_r[3 * i], *part = &m->last_r[3 * (n + k)];
        const double share = own[0] > 0 ? fmin(m->least[i] / own[0], 1) : 0;
        part[0] = m->least[i], part[1] = share * own[1], part[2] = share * own[2];
        own[0] = fmax(own[0] - m->least[i], 0), own[1] -= part[1], own[2] -= part[2];
        memcpy(&m->last_u[3 * (n + k)], &m->last_u[3 * i], 3 * sizeof *m->last_u);
        m->last_u[3 * (n + k)] = 0;
    }
}

/* What the contacts' own space may take from a start: a few steps of Newton's, or as many paths as that is. */
static double work_of_start(int count)
{
    enum { STEPS = 8 };
    return fmax(IMP_ENCOUNTER_WORK, STEPS * 2.0 / 3 * pow(3.0 * count, 3));
}

/* ---- compression ---- */

/* Works by impulses: p . (u + u')/2, normal and tangential. */
static void book(imp_finding *f, int phase, const double *p, const double *u, const double *after)
{
    const double normal = 0.5 * p[0] * (u[0] + after[0]);
    f->work[normal < 0 ? 0 : 1] += normal;
    f->work[2] += 0.5 * (p[1] * (u[1] + after[1]) + p[2] * (u[2] + after[2]));
    f->compressions += phase == 0 && p[0] > 0;
}

/* What the modes say is zero, where W r + q leaves the rounding of r; parts: modes of the same slip, of a second
 * problem (else the same). */
static void clean(int count, const imp_cone_mode *modes, const imp_cone_mode *parts, double *u)
{
    for (int i = 0; i < count; i++) {
        if (modes[i] != IMP_CONE_OPEN) u[3 * i] = 0;
        if (modes[i] == IMP_CONE_STICKS || parts[i] == IMP_CONE_STICKS) u[3 * i + 1] = u[3 * i + 2] = 0;
    }
}

/* The impulses of compression where they are not unique, on which restitution depends: without it they are what the
 * solver's path has of rounding. */
static void share(moreau *m, double residual)
{
    const int width = 3 * m->group->count;
    double size = 0;
    for (int i = 0; i < width; i++) size = fmax(size, fabs(m->q[i]));
    if (m->bodies == 0) couple_contacts(m);
    const imp_share_question question = {m->u, size, fmax(residual, IMP_CONE_ACCEPTED) * size, m->bodies,
                                         (const int(*)[2])m->couples};
    (void)imp_encounter_share(m->group, &question, m->modes, m->workspace);
}

/* The velocities before, less the rebounds. */
static void set_compression(const moreau *m)
{
    memcpy(m->q, m->group->u0, 3 * (size_t)m->group->count * sizeof *m->q);
    for (int i = 0; i < m->group->count; i++) m->q[3 * i] -= m->rebound[i];
}

/* The same, of what is pressed and may be drawn those of its seed; whether there is such. */
static bool plant_seeds(const moreau *m)
{
    const imp_group *g = m->group;
    bool any = false;
    set_compression(m);
    for (int i = 0; i < g->count; i++) {
        const double slip = g->contacts[i].slip;
        if (slip > 0) m->q[3 * i] = -IMP_MOREAU_SEED * slip;
        any = any || slip > 0;
    }
    return any;
}

/* The answer without the seeds: by its modes where they have drawn, else as if there were none. */
static bool take_seeds_away(moreau *m, imp_cone_problem problem)
{
    const imp_group *g = m->group;
    const size_t n = 3 * (size_t)problem.count;
    set_compression(m);
    problem.near_last = imp_encounter_draws(g);
    if (problem.near_last) {
        memcpy(m->last_r, g->p, n * sizeof *m->last_r);
        memcpy(m->last_u, m->u, n * sizeof *m->last_u);
        problem.last_r = m->last_r;
    }
    const imp_cone_outcome o = imp_cone_solve(&problem, m->cone, g->p, m->u, m->modes);
    return solved(m, &problem, &o, g->p);
}

static bool compress(moreau *m)
{
    const int n = m->group->count;
    for (int i = 0; i < n; i++) m->friction[i] = m->group->contacts[i].friction;
    const bool seeded = plant_seeds(m), starts = find_start(m, m->q, NULL);
    const imp_cone_problem problem = {.count = n,
                                      .w = m->group->w,
                                      .q = m->q,
                                      .friction = m->friction,
                                      .last_r = starts ? m->last_r : NULL,
                                      .last_u = m->last_u,
                                      .work = starts ? work_of_start(n) : 0};
    imp_cone_outcome o;
    if (!find_answer(m, &problem, m->group->p, m->u, &o)) return false;
    if (o.chosen) share(m, o.residual);
    if (seeded && !take_seeds_away(m, problem)) return false;
    m->strikes = imp_encounter_strikes(m->group);
    if (!m->strikes) return true;
    clean(n, m->modes, m->modes, m->u);
    for (int i = 0; i < n; i++) m->u[3 * i] += m->rebound[i];
    imp_encounter_push(m->group, m->group->p);
    imp_encounter_mend(m->group, m->u, m->residual, m->group->p, m->workspace);
    memcpy(m->q, m->u, 3 * (size_t)n * sizeof *m->q);
    imp_encounter_look(m->group, m->u);
    if (o.status == IMP_CONE_UNSETTLED && !comes_to(m->group, m->u, m->q, m->rebound)) return false;
    for (int i = 0; i < n; i++)
        book(&m->group->findings[i], 0, &m->group->p[3 * i], &m->group->u0[3 * i], &m->u[3 * i]);
    return true;
}

/* ---- restitution ---- */

static double least_restitution(const imp_group *g)
{
    double least = INFINITY;
    for (int i = 0; i < g->count; i++) least = fmin(least, g->contacts[i].restitution);
    return least;
}

/* u after normal parts eps c_n, their friction apart: c = c_n + c_t leaves W c = u - u0 to rounding of u, where W c_n
 * would leave that of impulses. */
static void add_parts(const moreau *m)
{
    const imp_group *g = m->group;
    const size_t n = (size_t)g->count, one = 3 * n;
    const double least = least_restitution(g);
    for (size_t i = 0; i < one; i++) {
        m->q[i] = m->u[i] + least * (m->u[i] - g->u0[i]);
        for (size_t c = 0; c < n; c++) {
            const double *row = &g->w[i * one + 3 * c], *p = &g->p[3 * c];
            m->q[i] += (g->contacts[c].restitution - least) * row[0] * p[0] - least * (row[1] * p[1] + row[2] * p[2]);
        }
    }
}

/* Of a part of nothing, v = d r, both r and û would be on the border of their cones: in cone_map.h's units
 * y_n - |y_t| = x_n, so that e^2 = x_n (x_n + |x_t|), and the path would come to it as e, where else it does as e^2. */
static void find_parts(moreau *m)
{
    m->parts = 0;
    for (int i = 0; i < m->group->count; i++) {
        m->least[i] = m->group->contacts[i].restitution * m->group->p[3 * i];
        if (m->least[i] > 0) m->part_of[m->parts++] = i;
    }
}

/* The row of W that one of the second problem has. */
static size_t row_in_group(const moreau *m, size_t i)
{
    const size_t one = 3 * (size_t)m->group->count;
    return i < one ? i : 3 * (size_t)m->part_of[(i - one) / 3] + i % 3;
}

/* The second problem: contact i is what is more, n + k the part eps c_n of the k-th that has one. */
static void set_restitution(moreau *m)
{
    const imp_group *g = m->group;
    const size_t n = (size_t)g->count, one = 3 * n, two = one + 3 * (size_t)m->parts;
    double mean = 0;
    for (size_t i = 0; i < n; i++) mean += g->w[3 * i * (one + 1)] / (double)n;
    for (size_t i = 0; i < two; i++)
        for (size_t j = 0; j < two; j++) {
            const bool apart = (i >= one && i % 3 == 0) || (j >= one && j % 3 == 0);
            m->w[i * two + j] = apart ? (i == j ? mean : 0) : g->w[row_in_group(m, i) * one + row_in_group(m, j)];
        }
    add_parts(m);
    for (size_t i = one; i < two; i++)
        m->q[i] = i % 3 == 0 ? -mean * m->least[row_in_group(m, i) / 3] : m->q[row_in_group(m, i)];
    for (size_t k = 0; k < (size_t)m->parts; k++) m->friction[n + k] = m->friction[m->part_of[k]];
}

/* Each contact's part at its own place, n + i. */
static void spread_parts(moreau *m)
{
    const int n = m->group->count;
    for (int i = n - 1, k = m->parts - 1; i >= 0; i--) {
        const bool any = k >= 0 && m->part_of[k] == i;
        for (int j = 0; j < 3; j++) m->r[3 * (n + i) + j] = any ? m->r[3 * (n + k) + j] : 0;
        m->modes[n + i] = any ? m->modes[n + k] : IMP_CONE_OPEN;
        k -= any;
    }
}

/* The second problem's answer: of each contact r more than its part, which are with it in p. The last of it is pushed.
 */
static void take_restitution(moreau *m)
{
    imp_group *g = m->group;
    const int n = g->count;
    double *p = m->r, *after = m->q;
    for (int i = 0; i < n; i++) {
        const double *more = &m->r[3 * i], *part = &m->r[3 * (n + i)];
        const double sum[3] = {more[0] + m->least[i], more[1] + part[1], more[2] + part[2]};
        memcpy(&p[3 * i], sum, sizeof sum);
    }
    imp_encounter_push(g, p);
    imp_encounter_mend(g, m->v, m->residual, p, m->workspace);
    imp_encounter_look(g, after);
    for (int i = 0; i < n; i++) {
        book(&g->findings[i], 1, &p[3 * i], &m->u[3 * i], &after[3 * i]);
        for (int j = 0; j < 3; j++) g->p[3 * i + j] += p[3 * i + j];
    }
}

/* Without restitution r = 0 solves the second problem. */
static bool restores(const imp_group *g)
{
    for (int i = 0; i < g->count; i++)
        if (g->contacts[i].restitution > 0) return true;
    return false;
}

static double greatest_size(const double *x, int count)
{
    double most = 0;
    for (int i = 0; i < count; i++) most = fmax(most, fabs(x[i]));
    return most;
}

/* The second problem with d so many times as great; velocities v with it. */
static void change_scale(moreau *m, double times)
{
    const size_t n = (size_t)m->group->count, width = 3 * (n + (size_t)m->parts);
    for (size_t i = 3 * n; i < width; i += 3) {
        m->w[i * (width + 1)] *= times;
        m->q[i] *= times;
        m->v[i] *= times;
    }
}

/* An answer is right to a part of the greatest of q. Where that is a part, d eps c_n, of impulses far greater than what
 * they leave of one another, velocities may be left by more than is taken of an answer: then once more, from there,
 * with d so little that no part is greater than the velocities. With that at once paths lead to another of several
 * answers.
 */
static bool find_restitution(moreau *m, imp_cone_problem *problem)
{
    const int width = 3 * problem->count;
    imp_cone_outcome o;
    if (!find_answer(m, problem, m->r, m->v, &o)) return false;
    const double size = greatest_size(m->q, width), speed = greatest_size(m->q, 3 * m->group->count);
    if (o.residual * size <= IMP_CONE_ACCEPTED * speed || !(speed > 0 && speed < size)) return true;
    change_scale(m, speed / size);
    memcpy(m->last_r, m->r, (size_t)width * sizeof *m->r);
    memcpy(m->last_u, m->v, (size_t)width * sizeof *m->v);
    problem->last_r = m->last_r;
    return find_answer(m, problem, m->r, m->v, &o);
}

static bool restore(moreau *m)
{
    imp_group *g = m->group;
    const int n = g->count;
    find_parts(m);
    const bool starts = find_start(m, m->u, m->least);
    if (starts) part_start(m);
    set_restitution(m);
    imp_cone_problem problem = {.count = n + m->parts,
                                .w = m->w,
                                .q = m->q,
                                .friction = m->friction,
                                .last_r = starts ? m->last_r : NULL,
                                .last_u = m->last_u,
                                .work = starts ? work_of_start(n + m->parts) : 0};
    if (!find_restitution(m, &problem)) return false;
    spread_parts(m);
    clean(n, m->modes, m->modes + n, m->v);
    take_restitution(m);
    return true;
}

impact_status imp_moreau_solve(imp_group *group, imp_rebound rebound, impact_together_workspace *workspace)
{
    const bool newton = rebound == IMP_REBOUND_NEWTON, poisson = rebound == IMP_REBOUND_POISSON && restores(group);
    const size_t n = (size_t)group->count;
    moreau m = {.group = group, .workspace = workspace, .cone = &workspace->cone};
    m.w = imp_encounter_take(workspace, 36 * n * n, sizeof *m.w);
    m.q = imp_encounter_take(workspace, 6 * n, sizeof *m.q);
    m.friction = imp_encounter_take(workspace, 2 * n, sizeof *m.friction);
    m.r = imp_encounter_take(workspace, 6 * n, sizeof *m.r);
    m.v = imp_encounter_take(workspace, 6 * n, sizeof *m.v);
    m.u = imp_encounter_take(workspace, 3 * n, sizeof *m.u);
    m.modes = imp_encounter_take(workspace, 2 * n, sizeof *m.modes);
    m.last_r = imp_encounter_take(workspace, 6 * n, sizeof *m.last_r);
    m.last_u = imp_encounter_take(workspace, 6 * n, sizeof *m.last_u);
    m.room = imp_encounter_take(workspace, imp_encounter_wedge_size(n), sizeof *m.room);
    m.least = imp_encounter_take(workspace, n, sizeof *m.least);
    m.part_of = imp_encounter_take(workspace, n, sizeof *m.part_of);
    m.rebound = imp_encounter_take(workspace, n, sizeof *m.rebound);
    m.couples = imp_encounter_take(workspace, n, sizeof *m.couples);
    m.rows = imp_encounter_take(workspace, n, sizeof *m.rows);
    if (!m.rows || !imp_cone_reserve(m.cone, 2 * group->count)) return IMPACT_ENOMEM;
    for (size_t i = 0; i < n && newton; i++) m.rebound[i] = group->contacts[i].restitution * fmax(-group->u0[3 * i], 0);
    const bool compressed = compress(&m);
    if (compressed && !m.strikes) return IMPACT_SEPARATING;
    if (compressed && (!poisson || restore(&m))) return IMPACT_OK;
    const imp_wedge_question question = {group->count, group->w, m.friction, NULL};
    group->wedged = imp_encounter_wedged(&question, m.room);
    return IMPACT_EUNSETTLED;
}
