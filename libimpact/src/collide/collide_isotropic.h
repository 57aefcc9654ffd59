/* SPDX-License-Identifier: MIT
 *
 * collide, inside: turning slip where the tangent plane gives alike in all directions (a = b).
 */
#ifndef IMP_COLLIDE_ISOTROPIC_H
#define IMP_COLLIDE_ISOTROPIC_H

#include "collide/collide_course.h"

/* Whether a and b are the same but for rounding: to as much as that of their own sums, so that taking them as equal
 * changes M by no more than making it did. */
bool imp_isotropic_is(const imp_frame *frame);

/* Solves the whole impact from u_t != 0 on, mu > 0, sliding that turns. */
void imp_isotropic_solve(imp_course *course);

#endif
