/* SPDX-License-Identifier: MIT
 *
 * drive: static bodies whose surface moves along itself, at a constant velocity and spin: belts, turntables, drums.
 * Nothing of where the surface is changes, so that gaps and flights do not know; contacts do, and the drive's work is
 * kept account of. Internal.
 */
#ifndef IMPACT_DRIVE_H
#define IMPACT_DRIVE_H

#include "persist.h"

/* NULL, or why a static body cannot move so: its surface would not stay where it is. */
const char *impact_drive_refusal(const impact_body_def *def);

/* The motion of a static body that is not refused, put exactly along its surface. */
void impact_drive_make(const impact_body_def *def, impact_body *body);

/* What the drives give the world through the held contacts as they are solved for: their forces' power, W, or their
 * impulses' work, J. */
double impact_drive_power(const impact_persist *persist, const impact_world *world);

#endif
