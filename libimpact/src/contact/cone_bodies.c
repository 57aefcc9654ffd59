/* SPDX-License-Identifier: MIT */
#include "contact/cone_bodies_parts.h"
#include "base/numbers.h"
#include "base/tolerances.h"

#include <limits.h>
#include <math.h>
#include <string.h>

enum { BODY_VECTORS = 4, CONTACT_VECTORS = 7, CONTACT_NUMBERS = 3 };

/* ---- room ---- */

static bool furnish_bodies(imp_cone_bodies *workspace, int contacts, int bodies, int width)
{
    if (contacts <= workspace->contacts && bodies <= workspace->bodies && width <= workspace->width) return true;
    imp_arena *arena = workspace->arena;
    workspace->sky.arena = arena;
    imp_arena_give(arena, workspace->block);
    imp_arena_give(arena, workspace->turns);
    const size_t numbers = CONTACT_VECTORS * (size_t)width + CONTACT_NUMBERS;
    const size_t size = BODY_VECTORS * 6 * (size_t)bodies + numbers * (size_t)contacts;
    workspace->block = imp_arena_take(arena, size, sizeof *workspace->block);
    workspace->turns = width > 3 ? imp_arena_take(arena, (size_t)contacts, sizeof *workspace->turns) : NULL;
    const bool there = workspace->block && (width == 3 || workspace->turns);
    workspace->width = width;
    workspace->contacts = there ? contacts : 0;
    workspace->bodies = there ? bodies : 0;
    return there;
}

static imp_bodies_problem lay_out_bodies(imp_cone_bodies *workspace, int count, int bodies, int width)
{
    imp_bodies_problem p = {.count = count, .n = 6 * bodies, .width = width, .sky = &workspace->sky};
    double *block = workspace->block;
    double **body[] = {&p.x, &p.trial, &p.gradient, &p.step},
           **contact[] = {&p.r, &p.u, &p.offset, &p.pressed, &p.own_q, &p.y, &p.lean};
    for (int k = 0; k < BODY_VECTORS; k++, block += p.n) *body[k] = block;
    for (int k = 0; k < CONTACT_VECTORS; k++, block += (size_t)(width * count)) *contact[k] = block;
    p.stiffness = block, p.mobility = block + count, p.rolling = block + 2 * (size_t)count;
    return p;
}

/* ---- multipliers ---- */

static void set_offset(const imp_bodies_problem *p)
{
    for (int c = 0; c < p->count; c++) {
        const int i = p->width * c;
        memcpy(&p->offset[i], &p->q[i], (size_t)p->width * sizeof *p->q);
        double slope[6];
        p->offset[i] += imp_bodies_slip(p, c, &p->u[i], slope);
    }
}

/* The size of what turns the contact, as forces: of reactions b is rolling times as large, of velocities smaller. */
static double turning_square(const imp_bodies_problem *p, const double *own, double rolling)
{
    if (p->width == 3) return 0;
    return own[3] * own[3] + (own[4] * own[4] + own[5] * own[5]) * rolling * rolling;
}

static double largest_of(const imp_bodies_problem *p, const double *v, bool velocities)
{
    double most = 0;
    for (int c = 0; c < p->count; c++) {
        const double *own = &v[p->width * c];
        const double rolling = p->width == 3 ? 1 : velocities ? p->rolling[c] : 1 / p->rolling[c];
        most = fmax(most, imp_bodies_products(own, own, p->friction[c] > 0 ? 3 : 1) + turning_square(p, own, rolling));
    }
    return sqrt(most);
}

/* P_C in units of forces. */
static void nearest(const imp_bodies_problem *p, int c, double *v, double *on)
{
    if (p->width == 3) {
        imp_bodies_project(p->friction[c], p->least ? p->least[c] : 0, v, on, NULL);
        return;
    }
    for (int k = 4; k < 6; k++) v[k] /= p->rolling[c];
    imp_cone_project_turning(p->friction[c], p->lengths[c], 1, v, on, NULL);
    for (int k = 4; k < 6; k++) on[k] *= p->rolling[c];
}

/* As imp_cone_residual, and of what is so light that the largest velocity is changed by less than the largest reaction
 * as a part of that less: a box of two kilograms that spun on one of ten tons was left with half its friction. */
static double residual_of(const imp_bodies_problem *p, const double *r)
{
    const double most = largest_of(p, r, false), size = largest_of(p, p->q, true),
                 all = size > 0 && most > 0 ? most / size : 1;
    double worst = 0;
    for (int c = 0; c < p->count; c++) {
        const double *own = &r[p->width * c], *v = &p->u[p->width * c], s = fmin(all, 1 / p->mobility[c]);
        double wanted[6], on[6], slope[6], off = 0;
        const double slip = imp_bodies_slip(p, c, v, slope);
        for (int k = 0; k < p->width; k++) {
            const double rolling = k > 3 ? p->rolling[c] : 1; /* s holds in units of forces: b is rolling times these */
            wanted[k] = own[k] - s * rolling * rolling * (v[k] + (k == 0 ? slip : 0));
        }
        nearest(p, c, wanted, on);
        for (int k = 0; k < p->width; k++) {
            const double rolling = k > 3 ? p->rolling[c] : 1;
            if (k == 0 || k > 2 || p->friction[c] > 0) off += (own[k] - on[k]) / rolling * ((own[k] - on[k]) / rolling);
        }
        worst = imp_worse(worst, sqrt(off) / (s * (size > 0 ? size : most > 0 ? most : 1)));
    }
    return worst;
}

/* The motion for r, with s that follows it, or where that leads nowhere as r's own motion has it; how stiff the next
 * may be. */
static double settle_friction(imp_bodies_problem *p, double rho, double enough)
{
    enum { FEW = 2 };
    imp_bodies_stiffen(p, rho);
    p->follows = true;
    const int steps = imp_bodies_settle(p, enough);
    if (steps >= 0) return steps <= FEW ? fmin(IMP_BODIES_STIFFENS * rho, IMP_BODIES_STIFFEST) : rho;
    p->follows = false;
    imp_bodies_effect(p, p->r);
    set_offset(p);
    (void)imp_bodies_settle(p, enough);
    return fmax(0.1 * rho, IMP_BODIES_STIFF);
}

/* The motion for the reactions, and how good they are; the best go to r and u. */
static double try_reactions(const imp_bodies_problem *p, const double *reactions, double *r, double *u)
{
    const size_t size = (size_t)(p->width * p->count) * sizeof *r;
    imp_bodies_effect(p, reactions);
    const double residual = residual_of(p, reactions);
    if (residual < p->outcome->residual) {
        p->outcome->residual = residual;
        memcpy(r, reactions, size);
        memcpy(u, p->u, size);
    }
    return residual;
}

/* From p->r, as far as it goes, or brief: in some steps of Newton's. */
static void iterate(imp_bodies_problem *p, double enough, bool brief, double *r, double *u)
{
    enum { MOST = 40, PATIENCE = 10 };
    const size_t size = (size_t)p->width * sizeof *r * (size_t)p->count;
    const imp_cone_outcome *outcome = p->outcome;
    const int last = brief ? outcome->steps + IMP_BODIES_BRIEF : INT_MAX;
    double rho = IMP_BODIES_SOFT;
    for (int k = 0, idle = 0; k <= MOST && idle < PATIENCE; k++) {
        const double before = outcome->residual;
        const double found = try_reactions(p, p->r, r, u);
        idle = outcome->residual < 0.5 * before ? 0 : idle + 1;
        if (outcome->residual <= enough || outcome->steps > last) return;
        rho = fmax(settle_friction(p, rho, IMP_BODIES_INNER * fmin(found, 1)), IMP_BODIES_STIFF);
        memcpy(p->r, p->pressed, size);
    }
}

/* By way of contacts that give, r = P_K(-rho û): one answer for each rho, whichever reactions bear it. */
static void let_give(imp_bodies_problem *p, double enough, double *r, double *u)
{
    memset(p->r, 0, (size_t)(p->width * p->count) * sizeof *r);
    imp_bodies_effect(p, r);
    p->follows = true;
    for (double rho = IMP_BODIES_EASIEST; rho <= IMP_BODIES_HARDEST && p->outcome->residual > enough; rho *= 10) {
        imp_bodies_stiffen(p, rho);
        if (imp_bodies_settle(p, IMP_BODIES_EASED) < 0) return;
        (void)try_reactions(p, p->pressed, r, u);
    }
}

static double residual_of_start(const imp_bodies_problem *p)
{
    imp_bodies_effect(p, p->r);
    return residual_of(p, p->r);
}

/* A few sweeps at a time, as long as they lead on. */
static void sweep_near(const imp_bodies_problem *p)
{
    enum { FEW = 5 };
    double before = INFINITY, found = residual_of_start(p);
    for (int k = 0; k < IMP_BODIES_SWEEPS && found > IMP_BODIES_FAR && found < IMP_BODIES_SWEPT * before; k += FEW) {
        before = found;
        imp_bodies_sweep(p, FEW);
        found = residual_of_start(p);
    }
}

/* What begins far off is swept first; where that does not settle contacts are let give, and it goes on from there.
 */
static void sweep_and_iterate(imp_bodies_problem *p, double enough, bool brief, double *r, double *u)
{
    imp_bodies_stiffen(p, IMP_BODIES_SOFT);
    sweep_near(p);
    iterate(p, enough, brief, r, u);
    if (p->outcome->residual <= enough) return;
    let_give(p, enough, r, u);
    memcpy(p->r, r, (size_t)(p->width * p->count) * sizeof *r);
    iterate(p, enough, brief, r, u);
}

/* ---- moments as forces ---- */

/* The units of moments, with rolling's so that these move as much as forces do: one rho suits both. */
static void units_of_bodies(const imp_bodies_problem *p, int c, double units[6])
{
    imp_cone_units(p->friction[c], p->lengths[c], units);
    for (int k = 4; k < 6; k++) units[k] *= p->rolling[c];
}

/* Reactions to the units (or, back, to the caller's), velocities the other way; what a contact has not is 0 there. */
static void change_units(const imp_bodies_problem *p, bool velocities, bool back, const double *from, double *to)
{
    for (int i = 0; i < p->width * p->count; i++) {
        const int c = i / p->width, k = i % p->width;
        double units[6];
        units_of_bodies(p, c, units);
        to[i] = !(units[k] > 0) ? 0 : velocities == back ? from[i] * units[k] : from[i] / units[k];
    }
}

static double row_squares(const imp_cone_row *row, int first, int rows)
{
    double sum = 0;
    for (int side = 0; side < 2; side++)
        for (int k = first; k < first + rows; k++)
            for (int l = 0; l < 6; l++) sum += row->side[side][k][l] * row->side[side][k][l];
    return sum / rows;
}

static void set_turns(imp_bodies_problem *p, const imp_cone_row *turns, imp_cone_row *own)
{
    for (int c = 0; c < p->count; c++) {
        double units[6];
        p->rolling[c] = 1;
        if (p->lengths[c].rolling > 0)
            p->rolling[c] = p->lengths[c].rolling * sqrt(row_squares(&turns[c], 1, 2) / row_squares(&p->rows[c], 0, 3));
        units_of_bodies(p, c, units);
        for (int i = 0; i < 36; i++) {
            const int side = i / 18, k = i / 6 % 3, l = i % 6;
            own[c].side[side][k][l] = units[3 + k] > 0 ? turns[c].side[side][k][l] / units[3 + k] : 0;
        }
    }
    p->turns = own;
}

/* What turning there is without reactions, of a contact that does not resist it, is told as it is. */
static void give_turning(const imp_bodies_problem *p, const imp_cone_row *turns, const double *q, double *u)
{
    imp_bodies_effect(p, p->r);
    for (int c = 0; c < p->count; c++) {
        double v[3];
        imp_bodies_seen_by(p, &turns[c], c, p->x, v);
        for (int k = 0; k < 3; k++) u[6 * c + 3 + k] = q[6 * c + 3 + k] + v[k];
    }
}

imp_cone_outcome imp_cone_solve_bodies(imp_cone_bodies *workspace, const imp_cone_problem *problem,
                                       const imp_cone_couples *couples, double *r, double *u)
{
    imp_cone_outcome outcome = {.status = IMP_CONE_BAD, .residual = INFINITY};
    const int count = problem->count, bodies = couples->bodies, width = imp_cone_width(problem);
    const size_t size = (size_t)(width * count);
    if (count == 0) return (imp_cone_outcome){.status = IMP_CONE_SOLVED};
    outcome.status = IMP_CONE_NO_ROOM;
    if (!furnish_bodies(workspace, count, bodies, width)) return outcome;
    imp_bodies_problem p = lay_out_bodies(workspace, count, bodies, width);
    p.rows = couples->rows, p.couples = couples->of, p.least = couples->least, p.q = problem->q,
    p.friction = problem->friction, p.lengths = problem->lengths;
    p.outcome = &outcome;
    if (!imp_skyline_shape(p.sky, bodies, couples->of, count)) return outcome;
    outcome.status = IMP_CONE_BAD;
    memset(p.r, 0, size * sizeof *p.r);
    if (problem->last_r) memcpy(p.r, problem->last_r, size * sizeof *p.r);
    for (int c = 0; c < count; c++)
        if (!(p.friction[c] > 0)) p.r[width * c + 1] = p.r[width * c + 2] = 0;
    if (width > 3) {
        set_turns(&p, couples->turns, workspace->turns);
        change_units(&p, true, false, problem->q, p.own_q);
        change_units(&p, false, false, p.r, p.r);
        p.q = p.own_q;
    }
    sweep_and_iterate(&p, problem->enough > 0 ? problem->enough : IMP_BODIES_ACCEPTED,
                      problem->effort == IMP_CONE_BRIEF, r, u);
    if (!(outcome.residual < INFINITY)) return outcome;
    if (width > 3) {
        memcpy(p.r, r, size * sizeof *r);
        give_turning(&p, couples->turns, problem->q, u);
        change_units(&p, false, true, p.r, r);
    }
    outcome.status = outcome.residual <= IMP_BODIES_ACCEPTED ? IMP_CONE_SOLVED
                     : outcome.residual <= IMP_CONE_USABLE   ? IMP_CONE_INEXACT
                                                             : IMP_CONE_UNSETTLED;
    return outcome;
}
