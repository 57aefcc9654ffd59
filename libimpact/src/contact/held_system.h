/* SPDX-License-Identifier: MIT
 *
 * held_system: the linear system behind the held contacts. Internal.
 */
#ifndef IMP_HELD_SYSTEM_H
#define IMP_HELD_SYSTEM_H

#include "contact/held.h"

/* An orthonormal tangent; the other is normal x it. */
qvec3 imp_tangent(qvec3 normal);

/* Change of contact a's relative acceleration (or velocity) for a force (or impulse) f on body 1 of contact b. */
qvec3 imp_system_response(const imp_world *world, const imp_state *states, const imp_held_contact *a,
                          const imp_held_contact *b, qvec3 f);

/* Finds each contact's force (or impulse) and pressure, so that its relative acceleration (or velocity) changes by what
 * is wanted: along the normal, and for a rolling contact across it too. with_friction: a sliding contact's pressure
 * brings its friction along, and where its direction is solved for too, across that direction u' changes by pull x (the
 * force across it). Where the reactions are not unique, those
 * whose changes have the least sum of squares, each over the inertia at its contact, of what the contacts' force comes
 * as (of impulses: of none): they follow the state as smoothly as it goes. What is still keeps its reaction, and no
 * impulse. */
void imp_system_solve(imp_held *held, const imp_world *world, const imp_state *states, bool with_friction);

/* Of an island, by its first contact: how many independent forces of its contacts move nothing; and the k-th, per
 * contact, N: until anything else is solved. */
int imp_system_count_idle(imp_held *held, const imp_world *world, const imp_state *states, int island);
void imp_system_idle(const imp_held *held, int island, int k, qvec3 *force);

/* By how much all forces that were solved for change this contact's relative acceleration. */
qvec3 imp_system_change(const imp_held *held, const imp_held_contact *contact);

/* Adds to the states what all impulses that were solved for do. */
void imp_system_apply(const imp_held *held, const imp_world *world, imp_state *states);

#endif
