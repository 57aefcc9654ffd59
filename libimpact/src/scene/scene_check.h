/* SPDX-License-Identifier: MIT
 *
 * scene_check: what is wrong with a definition, in one sentence that names the thing and the value. Internal.
 */
#ifndef IMP_SCENE_CHECK_H
#define IMP_SCENE_CHECK_H

#include <impact/scene.h>
#include "scene/names.h"

/* IMPACT_OK, with the bodies' names in the arena; or a failure with its message, but for IMPACT_ENOMEM. */
impact_status imp_scene_check(const impact_scene_def *def, imp_arena *arena, imp_names *names, char *message,
                              unsigned long message_size);

/* The mass of a body that moves, kg, and its principal moments, kg m^2: as given, or of the uniform solid. */
double imp_scene_body_mass(const impact_body_def *body, qvec3 *moments);

/* Whether the body's shape has a place of its own in the body's frame. */
bool imp_scene_shape_stands_aside(const impact_body_def *body);

#endif
