/* SPDX-License-Identifier: MIT
 *
 * rest: whether bodies that touch can stand still under their loads: a proof either way. Internal.
 *
 * Rest needs reactions f, each within its cone K, with G^T f + load = 0; they need not be unique. Of least norm, in the
 * metric in which a contact's reaction is one number along its normal and two across, they are f = P_K(G x) where x
 *
 *     minimises D(x) = |P_K(G x)|²/2 + load . x        (x: six numbers a body, in units of M^(-1/2); dual, convex, C¹)
 *
 * since D' = G^T P_K(G x) + load. Or D falls for ever along a d with P_K(G d) = 0 and load . d < 0. For any f in K
 * that balances the loads -load . d = f . G d <= |f| |P_K(G d)|: no reactions under -load . d/|P_K(G d)| do, and the
 * bodies that move in -d, against which nothing holds them, are those that go.
 */
#ifndef IMP_REST_H
#define IMP_REST_H

#include "contact/cone_assemble.h"
#include "world/field.h"

typedef enum imp_rest_status {
    IMP_REST_RESTS,    /* reactions balance the loads of every body, to rounding */
    IMP_REST_MOVES,    /* none do, up to a size that no scene has */
    IMP_REST_UNDECIDED /* too near the limit between both; or no room */
} imp_rest_status;

typedef struct imp_rest_outcome {
    imp_rest_status status;
    double residual;        /* the largest over the bodies of |load + reactions| over the sum of their sizes */
    double least_reactions; /* MOVES: under this, N, no reactions balance the loads; 0 otherwise */
    int steps;              /* Newton's */
} imp_rest_outcome;

/* All it needs, from an arena; nothing is allocated while it solves. */
typedef struct imp_rest_workspace {
    imp_arena *arena;
    int contacts, bodies; /* there is room for */
    double *block;
    imp_cone_row *rows, *turns;
    int *indices;
} imp_rest_workspace;

/* Room for so many contacts among so many bodies; false where the arena has no more. */
bool imp_rest_reserve(imp_rest_workspace *workspace, int contacts, int bodies);
void imp_rest_release(imp_rest_workspace *workspace);

/* lengths: of contacts that resist turning, or NULL. loads: one per body of the world. reactions: 3 count along the
 * contacts' axes, N, with lengths 6 count, the moments about them, N m, after them. velocities: one per body of the
 * world, zero where a body stays or is static; MOVES: the motion that shows it, of a kinetic energy of 1/2 in all,
 * J. Bodies that no contact names are left out. */
typedef struct imp_rest_velocity {
    qvec3 linear, angular; /* m/s; 1/s, world */
} imp_rest_velocity;
imp_rest_outcome imp_rest_solve(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                                const double *friction, const imp_cone_lengths *lengths, int count,
                                const imp_load *loads, imp_rest_workspace *workspace, double *reactions,
                                imp_rest_velocity *velocities);

/* Contacts whose forces are within cones, without moments. */
typedef struct imp_rest_question {
    int count, bodies;
    const int (*couples)[2]; /* per contact the bodies that move, 0 .. bodies - 1; -1: a side that does not */
    const imp_cone_row *rows;
    const double *friction;
} imp_rest_question;

/* Of all forces with the G^T f of these (3 count, within their cones) those of least norm, in their place; false, and
 * they stay, where they are not found. */
bool imp_rest_find_least(const imp_rest_question *question, imp_rest_workspace *workspace, double *forces);

#endif
