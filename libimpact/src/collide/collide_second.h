/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the kernel in its second precision.
 */
#ifndef IMP_COLLIDE_SECOND_H
#define IMP_COLLIDE_SECOND_H

#include <impact/collide.h>

/* As the series in double, in 113 bits (IMPACT_SOLVER_SERIES in the outcome); about a hundred times as long. IMPACT_OK,
 * IMPACT_SEPARATING where the approach was rounding (the outcome is not touched), IMPACT_EUNSETTLED, IMPACT_EABSENT
 * where the compiler has no such numbers. */
impact_status imp_second_collide(const impact_collision *collision, impact_outcome *outcome);

#endif
