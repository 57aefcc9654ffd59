/* SPDX-License-Identifier: MIT
 *
 * motion_pile: the motion of an island by the steps of a pile (pile.h) instead of an integrator's. Internal.
 */
#ifndef IMP_MOTION_PILE_H
#define IMP_MOTION_PILE_H

#include "motion/motion.h"
#include "motion/pile.h"

/* The next step, as imp_motion_next: from the states, which are `before` too, at motion->stride.t. Its polynomial is in
 * motion->dense; nothing in it is an event. */
impact_status imp_motion_next_by_steps(imp_motion *motion, imp_pile *pile, const imp_state *before, imp_state *states,
                                       imp_pile_step_result *result);

/* Every body's state at t within the last step, as imp_motion_look; what overlaps between the step's ends is parted. */
impact_status imp_motion_look_by_steps(imp_motion *motion, imp_pile *pile, double t, imp_state *states);

#endif
