/* SPDX-License-Identifier: MIT
 *
 * held_still: bodies that stand still on more contacts than the balance of forces can tell apart. Internal.
 */
#ifndef IMP_HELD_STILL_H
#define IMP_HELD_STILL_H

#include "contact/held.h"

/* Of the bodies that hang together by held contacts, all slower than rest_speed (m/s), whose reactions are not unique:
 * where some reactions within their cones balance the loads, their pairs are still (see imp_pair), with such
 * reactions; the modes of the others are left as they were. Up to jam_speed that is so too of bodies to which their
 * contacts, if they stuck, would leave no motion: what of it there is ends within the rounding of their places, and is
 * the caller's to end. Nothing is still where other forces than gravity and damping act: the balance would not last.
 * The held has room for what is held (imp_held_reserve). */
impact_status imp_held_find_still(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads,
                                  double rest_speed, double jam_speed);

/* Nothing is still any more, until it is found again. */
void imp_held_wake(imp_world *world);

#endif
