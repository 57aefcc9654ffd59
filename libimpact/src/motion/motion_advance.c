/* SPDX-License-Identifier: MIT */
#include "motion/motion.h"

impact_status imp_motion_advance(imp_motion *motion, double *t, double t_end, imp_state *states, imp_sampler *sampler,
                                 imp_end *end)
{
    motion->message[0] = '\0';
    if (imp_motion_is_ballistic(motion)) return imp_motion_fly(motion, t, t_end, states, sampler, end);
    if (!imp_motion_load(motion, *t, states)) return IMPACT_EDOMAIN;
    const double change = imp_field_next_switch(motion->world);
    const impact_status status = imp_motion_integrate(motion, t, fmin(t_end, change), states, sampler, end);
    if (status != IMPACT_OK || *t < change) return status;
    imp_field_enter(motion->world, *t);
    if (end->kind == IMP_END_TIME) *end = (imp_end){IMP_END_RENEWAL, 0}; /* other loads: which contacts hold? */
    return status;
}
