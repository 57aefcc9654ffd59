/* SPDX-License-Identifier: MIT
 *
 * cone_bodies: Coulomb's law at many contacts, solved for the bodies' velocities instead of the reactions: six unknowns
 * a body however many contacts it has, coupled as bodies touch. Internal.
 *
 * With G the rows of all contacts per root of mass, x = G^T r is what the reactions r do, and u = q + G x. With the
 * slip's part s = mu |u_t| n, r is the fixed point of r' = P_K(r - rho (u + s)), whose x has
 *
 *     F(x) = x - sum G^T P_K(r - rho (q + s(x) + G x)) = 0
 *
 * by semismooth Newton on the bodies, s with its slope; where that leads nowhere s is held, and x minimises |x|²/2 +
 * sum |P_K(r - rho (q + s + G x))|²/(2 rho) (the method of multipliers: Rockafellar 1976; Hestenes, Powell 1969; s from
 * iteration to iteration: Cadoux 2009). rho grows as Newton takes fewer steps. Where that does not settle, as
 * of faces that slide and turn on each other under masses far apart, contacts are let give: with r = 0 each rho has its
 * own answer, whichever reactions bear it, and from soft to stiff x hardly changes. Reactions that are not unique are
 * no trouble, as x is. Moments are forces in the units of imp_cone_units, their rows of G divided by them.
 */
#ifndef IMP_CONE_BODIES_H
#define IMP_CONE_BODIES_H

#include "contact/cone.h"
#include "contact/cone_assemble.h"
#include "contact/skyline.h"

typedef struct imp_cone_bodies {
    imp_arena *arena;
    int contacts, bodies, width; /* there is room for; numbers a contact */
    double *block;
    imp_cone_row *turns;
    imp_skyline sky;
} imp_cone_bodies;

/* What the problem's contacts couple. */
typedef struct imp_cone_couples {
    int bodies;                /* that move */
    const int (*of)[2];        /* each contact's, from 0 to bodies - 1, or -1 where it does not move */
    const imp_cone_row *rows;  /* each contact's */
    const imp_cone_row *turns; /* of imp_cone_find_turns, where the problem has lengths; else NULL */
    const double *least;       /* N s: what is to be at least along each normal, K's part beyond instead of K; NULL: 0;
                                  without       lengths */
} imp_cone_couples;

/* The problem (of its numbers W alone is not asked), into r and u.
 * SOLVED: the proof's residual, as of imp_cone_outcome, is at most IMP_BODIES_ACCEPTED; INEXACT, UNSETTLED: r and u are
 * the best that was found, s having crept where much friction couples much sliding. BAD: a number is none.
 * NO_ROOM: memory is refused. */
imp_cone_outcome imp_cone_solve_bodies(imp_cone_bodies *workspace, const imp_cone_problem *problem,
                                       const imp_cone_couples *couples, double *r, double *u);

#endif
