/* SPDX-License-Identifier: MIT
 *
 * Random impacts at the limits of what is admitted, behind case_make.
 */
#ifndef COLLIDE_EXTREMES_H
#define COLLIDE_EXTREMES_H

#include "collide_cases.h"

impact_collision case_extreme(case_class class_, uint64_t *g, impact_law law);

#endif
