/* SPDX-License-Identifier: MIT
 *
 * Where heavy bodies press light ones impulses are far greater than what they leave of one another: W p of a rounded W
 * is then off by eps |W| |p|, which is a light body's whole velocity, or a heavy one's mass. The bodies' own velocities
 * know better. The components A miss the velocities u' that their modes have by that rounding,
 * |u - u'| <= 32 eps sum |W p|, and it is taken away in rounds, each from the velocities that the last one left:
 *
 *     W_AA dp = u' - u,   A: the normals that pressed and what sticks,   dp of least norm
 */
#include "contact/encounter.h"

#include <float.h>
#include "base/tolerances.h"
#include "contact/least.h"

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

/* The largest terms of a contact's u: pushes along one of its axes are rounded along all. */
static double terms_of(const imp_group *g, const double *p, int contact)
{
    const int width = 3 * g->count;
    double most = 0;
    for (int row = 3 * contact; row < 3 * contact + 3; row++) {
        double sum = 0;
        for (int j = 0; j < width; j++) sum += fabs(g->w[(size_t)row * (size_t)width + (size_t)j] * p[j]);
        most = fmax(most, sum);
    }
    return most;
}

/* The normals that pressed, and what sticks: slip's friction hangs on its normal. */
static int find_pressed(const imp_group *g, const double *after, const double *p, int *which)
{
    int n = 0;
    for (int i = 0; i < g->count; i++) {
        const double *u = &after[3 * i];
        const bool sticks = g->contacts[i].friction > 0 && u[1] == 0 && u[2] == 0;
        for (int j = 0; j < (sticks ? 3 : 1) && p[3 * i] > 0; j++) which[n++] = 3 * i + j;
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

/* Into more[3 count]; false: u misses u' by no more than rounding of velocities, or by more than that of impulses. */
static bool find_mending(const imp_group *g, const double *after, const double *p, double *more,
                         impact_together_workspace *workspace)
{
    const double eps = IMP_ENCOUNTER_ROUNDINGS * DBL_EPSILON, speed = greatest_speed(g);
    const size_t width = 3 * (size_t)g->count;
    double *u = imp_encounter_take(workspace, width, sizeof *u), worst = 0;
    int *which = imp_encounter_take(workspace, width, sizeof *which);
    if (!u || !which) return false;
    imp_encounter_look(g, u);
    const int n = find_pressed(g, after, p, which);
    for (int k = 0; k < n; k++) {
        const double off = fabs(after[which[k]] - u[which[k]]);
        if (!(off <= eps * (terms_of(g, p, which[k] / 3) + speed))) return false;
        worst = fmax(worst, off);
    }
    if (worst <= eps * speed) return false;
    const size_t square = (size_t)n * (size_t)n;
    double *scratch = imp_encounter_take(workspace, 3 * square + (size_t)n, sizeof *scratch),
           *inverse = imp_encounter_take(workspace, square, sizeof *inverse);
    if (!scratch || !inverse) return false;
    (void)imp_least_inverse(g->w, (int)width, which, n, eps, scratch, inverse);
    for (size_t i = 0; i < width; i++) more[i] = 0;
    for (int k = 0; k < n; k++)
        for (int l = 0; l < n; l++) more[which[k]] += inverse[k * n + l] * (after[which[l]] - u[which[l]]);
    return true;
}

void imp_encounter_mend(const imp_group *g, const double *after, double *p, impact_together_workspace *workspace)
{
    imp_block *work = &workspace->work;
    const size_t used = work->used;
    for (int round = 0; round < IMP_ENCOUNTER_MENDINGS; round++) {
        double *more = imp_encounter_take(workspace, 3 * (size_t)g->count, sizeof *more);
        if (!more || !find_mending(g, after, p, more, workspace)) break;
        imp_encounter_push(g, more);
        for (int i = 0; i < 3 * g->count; i++) p[i] += more[i];
        work->used = used;
    }
    work->used = used;
}
