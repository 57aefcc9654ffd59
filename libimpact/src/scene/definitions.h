/* SPDX-License-Identifier: MIT
 *
 * definitions: what a caller hands over, as structs of this version. Internal.
 */
#ifndef IMP_DEFINITIONS_H
#define IMP_DEFINITIONS_H

#include <impact/scene.h>
#include "base/arena.h"

/* The scene's own struct; its lists are still the caller's. IMPACT_EARGUMENT, with a message. */
impact_status imp_scene_take_def(const impact_scene_def *given, impact_scene_def *own, char *message,
                                 unsigned long message_size);

/* Its lists: those of structs of this version stay where they are, others are copied into the arena. IMPACT_EARGUMENT,
 * with a message, IMPACT_ENOMEM. */
impact_status imp_scene_take_lists(impact_scene_def *own, imp_arena *arena, char *message, unsigned long message_size);

#endif
