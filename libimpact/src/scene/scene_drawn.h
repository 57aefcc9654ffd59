/* SPDX-License-Identifier: MIT
 *
 * scene_drawn: contacts that slide at u_n = 0 and are drawn on by their own friction (Painleve). Pressed together they
 * jam: no pressures hold them. Lifted they leave, of three solutions that they have. Internal.
 */
#ifndef IMP_SCENE_DRAWN_H
#define IMP_SCENE_DRAWN_H

#include "scene/scene_meeting.h"

/* The pair, whose bodies no other contact holds, is drawn on, and is pressed; or lifted. */
bool imp_scene_jams(imp_island *island, imp_meeting *m);
bool imp_scene_lifts(imp_island *island, imp_meeting *m);

/* Of the contacts held, whose reactions are solved for, the first pair after that one that is drawn on where others
 * hold its bodies; -1: none. *jams: pressed, else lifted. */
impact_status imp_scene_find_drawn(imp_island *island, int after, int *pair, bool *jams);

#endif
