/* SPDX-License-Identifier: MIT
 *
 * scene_press: what presses pairs together that touch at one instant, where each of them bears on the others. Internal.
 */
#ifndef IMP_SCENE_PRESS_H
#define IMP_SCENE_PRESS_H

#include "scene/scene_meeting.h"

/* Finds what presses each of the pairs together under the loads and the reactions of the others, which need not be held
 * yet: a body that another strikes does not fall while it stands. IMPACT_ENOMEM; IMPACT_EDOMAIN: a load refused. */
impact_status imp_scene_press_all(imp_island *island, imp_meeting *met, int count);

#endif
