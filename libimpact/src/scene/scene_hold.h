/* SPDX-License-Identifier: MIT
 *
 * scene_hold: which contacts are held at an instant, in which mode, and what comes to rest. Internal.
 */
#ifndef IMP_SCENE_HOLD_H
#define IMP_SCENE_HOLD_H

#include "scene/scene_internal.h"

/* Tentative modes: what touches and does not leave is held; those that would pull are opened again when the reactions
 * are known. */
void imp_scene_choose_modes(imp_island *island);

/* From tentative modes to consistent ones. What opened a moment ago, and is pressed together again now that other
 * contacts have changed their modes, is held again at once: it would come back in less than can be told from rounding,
 * and again and again. Each pair is given one such chance in an instant. opened: the pair that has just lifted off, or
 * -1; rejoin: whether to look for such pairs. Where no forces are found that hold what touches it is to go by steps
 * (the island lies), unless the scene is to be exact. */
impact_status imp_scene_hold(imp_island *island, int opened, bool rejoin);

#endif
