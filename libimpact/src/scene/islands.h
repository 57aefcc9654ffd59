/* SPDX-License-Identifier: MIT
 *
 * islands: a scene's islands, by their numbers, and those without one, to be used again. Internal.
 */
#ifndef IMP_ISLANDS_H
#define IMP_ISLANDS_H

#include "scene/scene_internal.h"

/* An island of nothing, without a number; NULL: there is no memory. */
imp_island *imp_islands_spare(impact_scene *scene);
/* Gives the island a number, and a slot in the queue, unless it has one. */
impact_status imp_islands_number(imp_island *island);
/* The island is no more: its account is the scene's, its memory the next one's. */
void imp_islands_release(imp_island *island);

/* What the island did since it was asked last is the scene's: works, losses, counts. */
void imp_islands_give_account(imp_island *island);
/* part goes over into sum. */
void imp_islands_add_usage(impact_usage *sum, impact_usage *part);

#endif
