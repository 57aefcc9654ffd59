/* SPDX-License-Identifier: MIT
 *
 * scene_receipt: the scene's look at its own answer. Internal.
 */
#ifndef IMP_SCENE_RECEIPT_H
#define IMP_SCENE_RECEIPT_H

#include "scene/scene_internal.h"

void imp_scene_receipt_begin(impact_scene *scene);

/* Looks at the island as it stands after an event. */
void imp_scene_receipt_look(imp_island *island);

/* At the end of a run, whose states have been looked up (imp_scene_look): its status, or IMPACT_SOFT with a message
 * where the receipt has failed. */
impact_status imp_scene_receipt_judge(impact_scene *scene, impact_status status);

#endif
