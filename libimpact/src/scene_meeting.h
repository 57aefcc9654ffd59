/* SPDX-License-Identifier: MIT
 *
 * scene_meeting: the pairs that touch at the scene's time, how they approach, and what presses them together. Internal.
 */
#ifndef IMPACT_SCENE_MEETING_H
#define IMPACT_SCENE_MEETING_H

#include "scene_internal.h"

typedef struct impact_meeting {
    impact_touch touch;
    double velocity;     /* d(gap)/dt, m/s */
    double acceleration; /* d2(gap)/dt2 under the loads and the other contacts' reactions, m/s^2 */
    double own;          /* what the pair's own reaction adds to it */
} impact_meeting;

/* The loads on all bodies now; and with the reactions of the contacts that are held. */
impact_status impact_scene_load(impact_scene *scene);
impact_status impact_scene_load_with_reactions(impact_scene *scene);

/* Fills the meeting of a held pair, or of an open one that touches within its plane's bounds; false otherwise. */
bool impact_scene_meets(impact_scene *scene, int p, impact_meeting *m);

/* Whether a bounce at this speed would rise less than the rest height under the acceleration that presses the bodies
 * together. Bounces that are met a rounding d late gain what they fall by it, and never rise less than d e^2/(1 - e^2):
 * that counts as rest too. */
bool impact_scene_dies_out(const impact_scene *scene, const impact_meeting *m, double speed);

#endif
