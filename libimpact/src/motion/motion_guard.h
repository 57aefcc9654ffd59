/* SPDX-License-Identifier: MIT
 *
 * motion_guard: that no force is stepped over, that time advances, and what is said where it does not. Internal.
 */
#ifndef IMP_MOTION_GUARD_H
#define IMP_MOTION_GUARD_H

#include "motion/motion.h"

/* No step may be longer than this, s, in the state y. */
double imp_motion_step_limit(imp_motion *motion, const double *y);

/* One step of the integrator, as impact_ode_step, within imp_motion_step_limit: again and shorter where a custom force
 * is not, within the step, what the step's polynomial says. */
impact_status imp_motion_step(imp_motion *motion, double stop, double *tau, double *y, bool *found);

/* Whether a loss that friction or damping only add to has fallen in the last step, by more than its error: then the
 * reactions are wrong. It is booked, and the next stretch is for the other method. */
bool imp_motion_loss_falls(imp_motion *motion, const double *y);
/* The last step was not taken after all: y is again what it was before it, and nothing is booked. False: that was tried
 * already, and did not help. */
bool imp_motion_take_back(imp_motion *motion, double *y);

/* Whether y is finite; where it is not, it is again what it was before the last step. */
bool imp_motion_finite_or_back(const imp_motion *motion, double *y);

/* Counts a step that came to t; false where time all but stands. */
bool imp_motion_gains(imp_motion *motion, double t);

/* IMPACT_EUNSETTLED, with a message of what, the time, and the body that moves fastest for its size. */
impact_status imp_motion_stuck(imp_motion *motion, const char *what, double t);

bool imp_motion_has_custom_force(const imp_world *world);

#endif
