/* SPDX-License-Identifier: MIT
 *
 * scene_strike: all impacts of one instant. Internal.
 */
#ifndef IMP_SCENE_STRIKE_H
#define IMP_SCENE_STRIKE_H

#include "scene/scene_internal.h"

/* One impact after another, in the order of the pairs, until no touching pair approaches. Restitution that has gone
 * round among the same few pairs time and again is spent: the rest of it is answered by all together. parted: there was
 * one pair, and nothing will hold it. */
impact_status imp_scene_strike_all(imp_island *island, bool *parted);

/* Contacts have been given their modes: of those that slide and are drawn on (scene_drawn.h) where others hold their
 * bodies, what is lifted is opened, and what jams is struck with all that touch. *struck: the modes are no more. */
impact_status imp_scene_strike_drawn(imp_island *island, bool *struck);

#endif
