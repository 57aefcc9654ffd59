/* SPDX-License-Identifier: MIT
 *
 * motion_stretch: what the three rooms of the integrator's work ask of each other: the choice of a method
 * (motion_method.c), its steps (motion_stretch.c), a step as a segment (motion_step.c). Internal.
 */
#ifndef IMP_MOTION_STRETCH_H
#define IMP_MOTION_STRETCH_H

#include "motion/motion_equations.h"

/* Makes the integrator that the stretch from stride.t to stride.t_end needs the one at work, with its tolerances. */
impact_status imp_motion_choose(imp_motion *motion, const imp_state *states);
/* Whether another would be chosen now: slip that had just begun has a direction of its own, or dies out again. */
bool imp_motion_outgrows(const imp_motion *motion);
/* The integrators' work since it was counted last, into the world's usage. */
void imp_motion_count_work(imp_motion *motion);

/* The last step as the segment [t0, t1]: y^(j) h^j/j! at its end, as far as the method's order goes. */
impact_status imp_motion_keep_step(imp_motion *motion, double t0, double t1);
imp_works imp_motion_works_of(const imp_motion *motion, const double *y);

#endif
