/* SPDX-License-Identifier: MIT
 *
 * collide, inside: how the velocities after an impact follow its data.
 */
#ifndef IMP_COLLIDE_COLUMNS_H
#define IMP_COLLIDE_COLUMNS_H

#include <impact/collide.h>

/* impact_collide_sensitivity from a collision of numbers near 1 and its outcome, an approach, of constant friction and
 * a rigid contact. INFINITY: tied. NaN: the outcome's phases were not followed to their end. */
double imp_columns_sensitivity(const impact_collision *collision, const impact_outcome *outcome);

/* The same in 113 bits; NaN where the compiler has no such numbers. */
double imp_second_columns_sensitivity(const impact_collision *collision, const impact_outcome *outcome);

#endif
