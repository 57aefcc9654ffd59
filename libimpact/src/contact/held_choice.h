/* SPDX-License-Identifier: MIT
 *
 * held_choice: which reactions are taken of those that do the same. Internal.
 */
#ifndef IMP_HELD_CHOICE_H
#define IMP_HELD_CHOICE_H

#include "contact/held.h"

/* Of the pairs that are to roll and whose slip is marked as begun, with the reactions that they remember solved for:
 * lets them remember, where reactions are not unique, some amid their cones, solves for these, and takes the marks
 * away. IMPACT_ENOMEM. */
impact_status imp_held_choose(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads);

#endif
