/* SPDX-License-Identifier: MIT
 *
 * persist_still: bodies that stand still on more contacts than the balance of forces can tell apart. Internal.
 */
#ifndef IMPACT_PERSIST_STILL_H
#define IMPACT_PERSIST_STILL_H

#include "persist.h"

/* Of the bodies that hang together by held contacts, all slower than rest_speed (m/s), whose reactions are not unique:
 * where some reactions within their cones balance the loads, their pairs are still (see impact_pair), with such
 * reactions; the modes of the others are left as they were. Up to jam_speed that is so too of bodies to which their
 * contacts, if they stuck, would leave no motion: what of it there is ends within the rounding of their places, and is
 * the caller's to end. Nothing is still where other forces than gravity and damping act: the balance would not last.
 * The persist has room for what is held (impact_persist_reserve). */
impact_status impact_persist_find_still(impact_persist *persist, impact_world *world, const impact_state *states,
                                        const impact_load *loads, double rest_speed, double jam_speed);

/* Nothing is still any more, until it is found again. */
void impact_persist_stir(impact_world *world);

#endif
