/* SPDX-License-Identifier: MIT
 *
 * scene_methods: which methods a definition asks for, its short names taken in. Internal.
 */
#ifndef IMP_SCENE_METHODS_H
#define IMP_SCENE_METHODS_H

#include <impact/scene.h>

/* What a definition's methods are, all filled in; for one that imp_scene_methods_check passes. */
impact_methods imp_scene_methods_of(const impact_scene_def *def);
impact_piles imp_scene_piles_of(const impact_scene_def *def);

/* Why the definition's methods are none: the words in `why`, of so many bytes; IMPACT_OK when they are. */
impact_status imp_scene_methods_check(const impact_scene_def *def, char *why, size_t size);

/* Nothing moves in closed form. */
static inline bool imp_scene_integrates_all(const impact_methods *methods)
{
    return methods->motion == IMPACT_MOTION_CVODE || methods->motion == IMPACT_MOTION_RK4 ||
           methods->motion == IMPACT_MOTION_OTHER;
}

#endif
