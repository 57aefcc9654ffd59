/* SPDX-License-Identifier: MIT
 *
 * arrivals: what happens where two bodies meet, or where an island's segment ends: all that touch are gathered,
 * settled (scene_instant.c), and go their ways. Internal.
 */
#ifndef IMP_ARRIVALS_H
#define IMP_ARRIVALS_H

#include "scene/scene_internal.h"

/* All that touch at the start. */
impact_status imp_scene_first_arrivals(impact_scene *scene);
/* The pair touches at t. */
impact_status imp_scene_meet(impact_scene *scene, int near, double t);
/* An island that was gathered is settled, or goes by steps, and its parts go their ways. */
impact_status imp_scene_conclude(imp_island *island);
/* The island's segment ends now. */
impact_status imp_scene_continue(impact_scene *scene, imp_island *island);

#endif
