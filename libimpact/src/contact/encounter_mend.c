/* SPDX-License-Identifier: MIT
 *
 * Where heavy bodies press light ones impulses are far greater than what they leave of one another: W p of a rounded W
 * is then off by eps |W| |p|, which is a light body's whole velocity, or a heavy one's mass. The bodies' own velocities
 * know better. The components A miss the velocities u' that their modes have by that rounding,
 * |u - u'| <= 32 eps max sum |W p|, or by what the solver left: of its answer's residual R either velocities or
 * impulses are off by such a part, |u - u'| <= R max sum |W p|. It is taken away in rounds, each from the velocities
 * that the last one left:
 *
 *     (W D)_A dp = (u' - u)_A,   A: the normals that pressed and what sticks,   dp of least norm
 *
 * D what goes with an impulse of A: itself, and of the normal of what slides friction too, as much of it as there was.
 */
#include "contact/encounter.h"

#include <float.h>
#include "base/tolerances.h"
#include "contact/held_linear.h"

qvec3 imp_encounter_impulse(const imp_contact *contact, const double p[3])
{
    qvec3 sum = qvec3_scale(contact->axes[0], p[0]);
    for (int k = 1; k < 3; k++) sum = qvec3_axpy(p[k], contact->axes[k], sum);
    return sum;
}

void imp_encounter_push(const imp_group *g, const double *p)
{
    for (int i = 0; i < g->count; i++) {
        const imp_contact *c = &g->contacts[i];
        const qvec3 impulse = imp_encounter_impulse(c, &p[3 * i]);
        for (int s = 0; s < 2; s++) {
            const impact_collider *body = &g->bodies[c->body[s]];
            if (imp_encounter_is_static(body)) continue;
            const qvec3 own = s == 0 ? impulse : qvec3_neg(impulse),
                        turn = imp_encounter_turn(body, qvec3_cross(c->arm[s], own));
            g->velocity[c->body[s]] = qvec3_axpy(1 / body->mass, own, g->velocity[c->body[s]]);
            g->omega[c->body[s]] = qvec3_add(g->omega[c->body[s]], turn);
        }
    }
}

void imp_encounter_look(const imp_group *g, double *u)
{
    for (int i = 0; i < g->count; i++) imp_encounter_velocity(&g->contacts[i], g->velocity, g->omega, &u[3 * i]);
}

/* The largest terms of a velocity. Those of one contact tell it at none: what is found of the problem is right to what
 * rounds the greatest, wherever it is, and pushes along one axis are rounded along all. */
static double greatest_terms(const imp_group *g, const double *p)
{
    const int width = 3 * g->count;
    double most = 0;
    for (int row = 0; row < width; row++) {
        double sum = 0;
        for (int j = 0; j < width; j++) sum += fabs(g->w[(size_t)row * (size_t)width + (size_t)j] * p[j]);
        most = fmax(most, sum);
    }
    return most;
}

/* A component of A: its impulse is along its own axis, or, of the normal of slip, with its friction, in the ratio
 * in which they are: |p_t| = mu p_n stays so. */
typedef struct unknown {
    int row;
    bool slides;
} unknown;

/* The normals that pressed, and what sticks. */
static int find_unknowns(const imp_group *g, const double *after, const double *p, unknown *unknowns)
{
    int n = 0;
    for (int i = 0; i < g->count; i++) {
        if (!(p[3 * i] > 0)) continue;
        const bool sticks = g->contacts[i].friction > 0 && after[3 * i + 1] == 0 && after[3 * i + 2] == 0;
        unknowns[n++] = (unknown){3 * i, !sticks};
        for (int k = 1; sticks && k < 3; k++) unknowns[n++] = (unknown){3 * i + k, false};
    }
    return n;
}

/* The speeds that rounding is told from. */
static double greatest_speed(const imp_group *g)
{
    double speed = 0;
    for (int i = 0; i < 3 * g->count; i++) speed = fmax(speed, fabs(g->u0[i]));
    return speed;
}

/* The change of the velocity along `row` by the unknown of another. */
static double change_by(const imp_group *g, const double *p, int row, const unknown *other)
{
    const double *w = &g->w[(size_t)row * 3 * (size_t)g->count + (size_t)other->row], *own = &p[other->row];
    return other->slides ? w[0] + (w[1] * own[1] + w[2] * own[2]) / own[0] : w[0];
}

/* Into more[3 count] what changes the velocities of A by `off`; each measured by the power of two near the root of its
 * own mobility, so that masses far apart are none to the elimination, and none of W's digits are lost. */
static bool solve_mending(const imp_group *g, const double *p, const unknown *unknowns, int n, const double *off,
                          double *more, impact_together_workspace *workspace)
{
    const size_t width = 3 * (size_t)g->count, square = (size_t)n * (size_t)n;
    imp_linear linear = {.n = n,
                         .doubtful = IMP_ENCOUNTER_DOUBTFUL,
                         .vanishing = IMP_ENCOUNTER_ROUNDINGS * DBL_EPSILON,
                         .matrix = imp_encounter_take(workspace, square, sizeof *linear.matrix),
                         .spare = imp_encounter_take(workspace, square, sizeof *linear.spare),
                         .scratch = imp_encounter_take(workspace, (size_t)n, sizeof *linear.scratch),
                         .rows = imp_encounter_take(workspace, (size_t)n, sizeof *linear.rows),
                         .columns = imp_encounter_take(workspace, (size_t)n, sizeof *linear.columns)};
    double *size = imp_encounter_take(workspace, (size_t)n, sizeof *size),
           *x = imp_encounter_take(workspace, (size_t)n, sizeof *x);
    if (!x) return false;
    for (int k = 0; k < n; k++) size[k] = 1 / imp_encounter_unit(sqrt(g->w[(size_t)unknowns[k].row * (width + 1)]));
    for (int k = 0; k < n; k++) {
        x[k] = size[k] * off[k];
        for (int l = 0; l < n; l++)
            linear.matrix[k * n + l] = size[k] * size[l] * change_by(g, p, unknowns[k].row, &unknowns[l]);
    }
    imp_linear_factor(&linear);
    imp_linear_solve(&linear, x);
    for (size_t i = 0; i < width; i++) more[i] = 0;
    for (int k = 0; k < n; k++) {
        const int row = unknowns[k].row;
        more[row] = size[k] * x[k];
        for (int l = 1; unknowns[k].slides && l < 3; l++) more[row + l] = more[row] * (p[row + l] / p[row]);
    }
    return true;
}

/* Into more[3 count]; false: u misses u' by no more than `enough` of the greatest speed, or by more than that part of
 * impulses does. */
static bool find_mending(const imp_group *g, const double *after, const double *p, double part, double enough,
                         double *more, impact_together_workspace *workspace)
{
    const double speed = greatest_speed(g), most = part * (greatest_terms(g, p) + speed);
    const size_t width = 3 * (size_t)g->count;
    double *u = imp_encounter_take(workspace, width, sizeof *u), worst = 0;
    unknown *unknowns = imp_encounter_take(workspace, width, sizeof *unknowns);
    if (!u || !unknowns) return false;
    imp_encounter_look(g, u);
    const int n = find_unknowns(g, after, p, unknowns);
    for (int k = 0; k < n; k++) {
        const int row = unknowns[k].row;
        const double off = after[row] - u[row];
        if (!(fabs(off) <= most)) return false;
        worst = fmax(worst, fabs(off));
        u[k] = off; /* k <= row */
    }
    return worst > enough * speed && solve_mending(g, p, unknowns, n, u, more, workspace);
}

/* Of impulses, what the residual leaves. 0 where that is no more than what is accepted of velocities: to mend it, the
 * ice under two stones of which one strikes the other pulled at both by 1e-11 N s. */
static double part_left(const imp_group *g, const double *p, double residual)
{
    const bool counts = residual * greatest_terms(g, p) > IMP_CONE_ACCEPTED * greatest_speed(g);
    return counts ? fmin(residual, IMP_CONE_USABLE) : 0;
}

void imp_encounter_mend(const imp_group *g, const double *after, double residual, double *p,
                        impact_together_workspace *workspace)
{
    imp_block *work = &workspace->work;
    const double part = fmax(IMP_ENCOUNTER_ROUNDINGS * DBL_EPSILON, part_left(g, p, residual));
    const size_t used = work->used;
    for (int round = 0; round < IMP_ENCOUNTER_MENDINGS; round++) {
        double *more = imp_encounter_take(workspace, 3 * (size_t)g->count, sizeof *more);
        /* begun where more than rounding of velocities is missed, and led on to that of one */
        const double enough = (round > 0 ? 1 : IMP_ENCOUNTER_ROUNDINGS) * DBL_EPSILON;
        if (!more || !find_mending(g, after, p, part, enough, more, workspace)) break;
        imp_encounter_push(g, more);
        for (int i = 0; i < 3 * g->count; i++) p[i] += more[i];
        work->used = used;
    }
    work->used = used;
}
