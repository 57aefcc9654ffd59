/* SPDX-License-Identifier: MIT
 *
 * scene_check: what is wrong with a definition, in one sentence that names the thing and the value. Internal.
 */
#ifndef IMPACT_SCENE_CHECK_H
#define IMPACT_SCENE_CHECK_H

#include <impact/scene.h>

/* IMPACT_OK, or a failure with its message. */
impact_status impact_scene_check(const impact_scene_def *def, char *message, unsigned long message_size);

/* Index of the named body of the definition, or -1. */
int impact_scene_def_find(const impact_scene_def *def, const char *name);

/* The mass of a body that moves, kg, and its principal moments, kg m^2: as given, or of the uniform solid. */
double impact_scene_body_mass(const impact_body_def *body, qvec3 *moments);

/* Whether the body's shape has a place of its own in the body's frame. */
bool impact_scene_shape_stands_aside(const impact_body_def *body);

#endif
