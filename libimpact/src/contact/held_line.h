/* SPDX-License-Identifier: MIT
 *
 * held_line: bodies that lie along a line of their surface, such as a cylinder on its side that rolls straight.
 * Internal.
 *
 * Along an axis of high exponent a round side is flat, and rounding alone makes the body rock along it, faster than can
 * be followed. While nothing tips it that way, the axis is kept level and the contact stays at the middle of the line;
 * across, it is carried as ever.
 */
#ifndef IMP_HELD_LINE_H
#define IMP_HELD_LINE_H

#include "contact/held.h"

/* Lays bodies along a line where they rock along it with less energy than lifts them by flat_height, and nothing tips
 * them. Tells whether there were any. The held has room for what is held. */
bool imp_line_lay(imp_held *held, imp_world *world, imp_state *states, const imp_load *loads);

/* Whether a pair whose body lay along a line still does: held, its only contact, and not rocking. */
bool imp_line_lies(const imp_world *world, const imp_pair *pair, const imp_state *states);

/* How the spot's normal turns, body axes: as given, but not along the line. */
qvec3 imp_line_turn(const imp_pair *pair, qvec3 normal_rate);

/* Takes away the velocity that would tip the body along its line. */
void imp_line_level(const imp_world *world, const imp_pair *pair, imp_state *states);

/* Above 0 while the contact, solved for, needs its centre of pressure at the middle of the line, to rounding; 1 of
 * other touches. */
double imp_line_spare(const imp_world *world, const imp_held_contact *contact, const imp_state *states,
                      const imp_load *loads);

/* Adds to the load, of the contact's body and solved for, what keeps the line level: the moment of the pressure along
 * it.
 */
void imp_line_brace(const imp_world *world, const imp_held_contact *contact, const imp_state *states, imp_load *load);

#endif
