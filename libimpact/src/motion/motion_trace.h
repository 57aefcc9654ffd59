/* SPDX-License-Identifier: MIT
 *
 * motion_trace: the integrator's steps as pieces of motion, for keys. Internal.
 */
#ifndef IMP_MOTION_TRACE_H
#define IMP_MOTION_TRACE_H

#include "motion/motion_equations.h"

/* Before the first step of a stretch that begins at t with these states, which motion->y holds. */
impact_status imp_motion_trace_start(imp_motion *motion, double t, const imp_state *states);
/* After each step, from tau_before to tau, where the state is y: hands it to the sampler, whose answer is returned. */
bool imp_motion_trace_step(imp_motion *motion, const imp_sampler *sampler, double tau_before, double tau,
                           const double *y);
void imp_motion_trace_free(struct imp_trace *trace, imp_arena *arena);

#endif
