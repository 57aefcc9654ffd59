/* SPDX-License-Identifier: MIT
 *
 * scene_points: at an instant a pair of bodies with faces is as many pairs as it has points that touch: each strikes,
 * and answers together with the others, at its own place. Internal.
 */
#ifndef IMP_SCENE_POINTS_H
#define IMP_SCENE_POINTS_H

#include "scene/scene_internal.h"

/* Makes each such pair that touches now one pair for each of its points, whose contact is known (imp_site.placed), and
 * drops those that do not. */
impact_status imp_scene_place_points(imp_island *island);
/* What of the points does not part. */
typedef enum imp_stay {
    IMP_STAY_NONE,
    IMP_STAY_CORNERS, /* on planes and static faces, of no two bodies more than two: they are held exactly, each a pair
                         of its own */
    IMP_STAY_FACES    /* more, or others: the bodies lie on each other, and go by steps */
} imp_stay;
imp_stay imp_scene_points_stay(imp_island *island); /* but for what lies (gliding.h) */
bool imp_scene_point_stays(imp_island *island, int p);

/* What joins what is held between instants, when no points are placed: where it touches at one corner alone the pair is
 * that corner's from here. As a whole its contact is at whichever is lowest, and would go on at another's velocity. */
void imp_scene_name_corner(imp_island *island, imp_pair *pair);

/* Of the points leaves the corners that are held; of bodies that none holds, the pair as a whole. */
void imp_scene_drop_points(imp_island *island);
/* Whether a corner is held, or what has a flat place: what the exact motion may not get on with. */
bool imp_scene_holds_features(const imp_island *island);

#endif
