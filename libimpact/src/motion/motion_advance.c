/* SPDX-License-Identifier: MIT */
#include "motion/motion.h"

impact_status imp_motion_advance(impact_motion *motion, double *t, double t_end, imp_state *states,
                                 imp_sampler *sampler, imp_end *end)
{
    motion->message[0] = '\0';
    if (imp_motion_is_ballistic(motion)) return imp_motion_fly(motion, t, t_end, states, sampler, end);
    if (!imp_motion_load(motion, *t, states)) return IMPACT_EDOMAIN;
    return imp_motion_integrate(motion, t, t_end, states, sampler, end);
}
