/* SPDX-License-Identifier: MIT
 *
 * scene_check: what is wrong with a definition, in one sentence that names the thing and the value. Internal.
 */
#ifndef IMP_SCENE_CHECK_H
#define IMP_SCENE_CHECK_H

#include <impact/scene.h>

/* IMPACT_OK, or a failure with its message. */
impact_status imp_scene_check(const impact_scene_def *def, char *message, unsigned long message_size);

/* Index of the named body of the definition, or -1. */
int imp_scene_def_find(const impact_scene_def *def, const char *name);

/* The mass of a body that moves, kg, and its principal moments, kg m^2: as given, or of the uniform solid. */
double imp_scene_body_mass(const impact_body_def *body, qvec3 *moments);

/* Whether the body's shape has a place of its own in the body's frame. */
bool imp_scene_shape_stands_aside(const impact_body_def *body);

#endif
