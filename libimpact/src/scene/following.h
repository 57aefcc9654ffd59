/* SPDX-License-Identifier: MIT
 *
 * following: how what is settled moves on: the next segments of an island, and of a body that is alone. Internal.
 */
#ifndef IMP_FOLLOWING_H
#define IMP_FOLLOWING_H

#include "scene/scene_internal.h"

/* Whether the pair keeps its bodies in one island, and is not searched for. */
bool imp_island_ties(const imp_island *island, const imp_pair *pair);
bool imp_island_all_rest(const imp_island *island);

/* The tracks' pairs learn what is held. */
impact_status imp_island_tell_pairs(imp_island *island);
/* The island's body i goes on alone, where nothing acts on it but gravity and damping. */
impact_status imp_island_fly(imp_island *island, int i);
/* The island, whose bodies are all tied, gets its number and its first segments. */
impact_status imp_island_start(imp_island *island);
/* Its next step, of the integrator or of a pile. */
impact_status imp_island_step_on(imp_island *island);
/* The next contacts of all its bodies are searched for. */
void imp_island_look_ahead(imp_island *island);

/* The status, with the motion's message where the scene has none yet. */
impact_status imp_island_fail(imp_island *island, impact_status status);

#endif
