/* SPDX-License-Identifier: MIT
 *
 * parting: an island in which all is settled falls apart into what is still held together. Internal.
 */
#ifndef IMP_PARTING_H
#define IMP_PARTING_H

#include "scene/scene_internal.h"

/* Each component of what is tied goes its way: alone, as an island of its own, or as the island it was. loose: a list
 * of those that have left a pile and are to be settled first. */
impact_status imp_island_part_ways(imp_island *island, imp_island **loose);

/* Whether a pile is one still: no part of it has not touched the rest since the last look. */
bool imp_island_stays_together(imp_island *island);

/* Its bodies' rest is the scene's knowledge. */
void imp_island_count_moving(imp_island *island);

#endif
