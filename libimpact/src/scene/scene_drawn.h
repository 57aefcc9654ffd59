/* SPDX-License-Identifier: MIT
 *
 * scene_drawn: pairs that slide at u_n = 0 and are drawn on by their own friction (Painleve). Internal.
 */
#ifndef IMP_SCENE_DRAWN_H
#define IMP_SCENE_DRAWN_H

#include "scene/scene_meeting.h"

/* The pair slides, is all but still along the normal, and its own friction draws it on, what is held beside it
 * answering. Pressed together it jams: no pressures hold it. Lifted it leaves, of three solutions that it has. The
 * reactions have been solved for. */
bool imp_scene_jams(imp_island *island, imp_meeting *m);
bool imp_scene_lifts(imp_island *island, imp_meeting *m);

/* Whether another held contact has one of the pair's bodies that move. */
bool imp_scene_held_elsewhere(const imp_world *world, const imp_touch *touch);

#endif
