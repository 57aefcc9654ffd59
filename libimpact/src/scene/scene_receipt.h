/* SPDX-License-Identifier: MIT
 *
 * scene_receipt: the scene's look at its own answer. Internal.
 */
#ifndef IMP_SCENE_RECEIPT_H
#define IMP_SCENE_RECEIPT_H

#include "scene/scene_internal.h"

void imp_scene_receipt_begin(impact_scene *scene);

/* Looks at the scene as it stands at the end of a stretch that began at time begin. */
void imp_scene_receipt_look(impact_scene *scene, double begin);

/* What a part of the scene, moved on its own, found. */
void imp_scene_receipt_add(impact_scene *scene, const impact_scene *part);

/* The status of a run that reached its end; IMPACT_SOFT, with a message, where the receipt has failed. */
impact_status imp_scene_receipt_judge(impact_scene *scene, impact_status status);

#endif
