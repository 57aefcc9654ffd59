/* SPDX-License-Identifier: MIT
 *
 * collide, inside: most collisions are told to be in order at a glance; and impact_collide with or without a receipt.
 */
#ifndef IMP_COLLIDE_CHECK_H
#define IMP_COLLIDE_CHECK_H

#include <impact/collide.h>

/* Whether the collision is one that impact_collide_check takes, and its numbers need no other units, if it separates or
 * approaches by IMP_COLLIDE_ORDINARY_APPROACH or faster. False: look closely. */
bool imp_collide_is_plain(const impact_collision *collision);

/* impact_collide, checked by its receipt or not, whatever the collision asks for. */
impact_status imp_collide(const impact_collision *collision, bool checks, impact_outcome *outcome);

#endif
