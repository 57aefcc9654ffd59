/* SPDX-License-Identifier: MIT
 *
 * drive: static bodies whose surface moves along itself, at a constant velocity and spin: belts, turntables, drums.
 * Nothing of where the surface is changes, so that gaps and flights do not know; contacts do, and the drive's work is
 * kept account of. Internal.
 */
#ifndef IMP_SURFACE_VELOCITY_H
#define IMP_SURFACE_VELOCITY_H

#include "world/world.h"

/* NULL, or why a static body cannot move so: its surface would not stay where it is. */
const char *imp_surface_velocity_refusal(const impact_body_def *def);

/* The motion of a static body that is not refused, put exactly along its surface. */
void imp_surface_velocity_make(const impact_body_def *def, imp_body *body);

#endif
