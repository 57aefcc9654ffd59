/* SPDX-License-Identifier: MIT
 *
 * held_law: Coulomb's law in accelerations of held contacts that hang together, as a cone problem (cone.h):
 *
 *     K* contains û,  û . r = 0,  K contains r,   u = W r + q,   q = bias + (n' . slip) n. Internal.
 */
#ifndef IMP_HELD_LAW_H
#define IMP_HELD_LAW_H

#include "contact/cone_assemble.h"
#include "contact/held.h"

typedef struct imp_held_law {
    int count;
    int *contact; /* which of the held's each is */
    imp_cone_contact *contacts;
    imp_cone_row *rows;
    imp_cone_mode *modes;
    double *w, *q, *r, *u, *friction;
    double size;  /* the largest part of q as the loads make it, m/s^2 */
    double *room; /* of the question whether pressures balance */
    imp_cone_workspace cone;
} imp_held_law;

/* Room for so many contacts; false where the arena has no more. */
bool imp_held_law_take(imp_arena *arena, int count, imp_held_law *law);
void imp_held_law_give(imp_held_law *law);

/* The problem of an island, whose number is its first contact's. */
void imp_held_law_find(const imp_held *held, const imp_world *world, const imp_state *states, const imp_load *loads,
                       int island, imp_held_law *law);

/* r, u and modes. */
imp_cone_outcome imp_held_law_solve(imp_held_law *law);

#endif
