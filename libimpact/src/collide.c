/* SPDX-License-Identifier: MIT */
#include <impact/collide.h>

impact_status impact_collide(const impact_collision *collision, impact_outcome *outcome)
{
    (void)collision;
    (void)outcome;
    return IMPACT_EABSENT;
}
