/* SPDX-License-Identifier: MIT */
#include "motion.h"

impact_status impact_motion_advance(impact_motion *motion, double *t, double t_end, impact_state *states,
                                    impact_sampler *sampler, impact_end *end)
{
    motion->message[0] = '\0';
    if (impact_motion_is_ballistic(motion)) return impact_motion_fly(motion, t, t_end, states, sampler, end);
    if (!impact_motion_load(motion, *t, states)) return IMPACT_EDOMAIN;
    return impact_motion_integrate(motion, t, t_end, states, sampler, end);
}
