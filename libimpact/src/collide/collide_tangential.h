/* SPDX-License-Identifier: MIT
 *
 * collide_tangential: impacts without approach, of sliding contacts that no pressure can hold. Internal.
 */
#ifndef IMP_COLLIDE_TANGENTIAL_H
#define IMP_COLLIDE_TANGENTIAL_H

#include <impact/collide.h>

/* The collision has `pressed`. */
impact_status imp_collide_pressed(const impact_collision *collision, impact_outcome *outcome);

/* Whether u_n is zero but for rounding, and sliding friction draws the contact on: d(u_n)/dp = n . M (n - mu u_t/|u_t|)
 * < 0, so that no pressure withstands what presses. */
bool imp_collide_draws(const impact_collision *collision);

#endif
