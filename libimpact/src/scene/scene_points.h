/* SPDX-License-Identifier: MIT
 *
 * scene_points: at an instant a pair of bodies with faces is as many pairs as it has points that touch: each strikes,
 * and answers together with the others, at its own place. Internal.
 */
#ifndef IMP_SCENE_POINTS_H
#define IMP_SCENE_POINTS_H

#include "scene/scene_internal.h"

/* Makes each such pair that touches now one pair for each of its points, whose contact is known (imp_pair.placed), and
 * drops those that do not. */
impact_status imp_scene_place_points(imp_island *island);
/* Whether any of the points does not part: its bodies go on held by each other. */
bool imp_scene_points_stay(imp_island *island);
/* Drops them: all parted. */
void imp_scene_drop_points(imp_island *island);

#endif
