/* SPDX-License-Identifier: MIT
 *
 * held_flat: bodies that lie on a flat face, where the contact's place follows the balance and no longer the tilt.
 * Internal.
 *
 * On a plane, a face whose exponents are high carries the body at any of its points at a tilt of next to nothing: 1e-50
 * rad a third of the way out for an exponent of 100, about which the body would rock in 1e-25 s. Below a rise of
 * flat_height the tilt is 0 and the contact point, as the centre of pressure, stands where no torque is left to tip the
 * body: the limit of those motions as they grow smaller.
 */
#ifndef IMP_HELD_FLAT_H
#define IMP_HELD_FLAT_H

#include "contact/held.h"

/* Lays down the bodies that rock on a face with less energy than lifts them by flat_height, and rest or slide there on
 * a point that does not either; whose whole energy is no more than that, and whose friction holds them, are stopped.
 * Tells whether there were any. */
bool imp_flat_lay(imp_world *world, imp_state *states, const imp_load *loads);

/* Whether the pair is held and its place carried, the body's only contact, of a shape about its centre of mass. */
bool imp_flat_suits(const imp_world *world, const imp_pair *pair);

/* Whether a flat pair still is: held, the body's only contact, and not rocking. */
bool imp_flat_lies(const imp_world *world, const imp_pair *pair, const imp_state *states);

/* Stands the body exactly on its face, moving along the plane only. */
void imp_flat_level(const imp_world *world, const imp_pair *pair, imp_state *states);

/* The contact of a flat pair, at its centre of pressure: its bias is such that the linear system of the contacts finds
 * the balance. */
imp_held_contact imp_flat_contact(const imp_world *world, int pair, const imp_state *states, const imp_load *loads);

/* The force of the plane on the pair's flat body under which that sticks, N. */
qvec3 imp_flat_holding(const imp_world *world, int pair, const imp_state *states, const imp_load *loads);

/* The body tips over a centre of pressure that has gone too far out: its contact is carried on from there. */
void imp_flat_tip(const imp_world *world, imp_pair *pair, const imp_state *states, const imp_held_contact *contact);

#endif
