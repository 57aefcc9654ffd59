/* SPDX-License-Identifier: MIT
 *
 * scene_meeting: the pairs that touch at the scene's time, how they approach, and what presses them together. Internal.
 */
#ifndef IMP_SCENE_MEETING_H
#define IMP_SCENE_MEETING_H

#include "scene/scene_internal.h"

typedef struct imp_meeting {
    imp_held_contact contact; /* until it is pressed no more than where it is */
    double velocity;          /* d(gap)/dt, m/s */
    double touching;          /* m: gaps up to this are rounding */
    double own;               /* m/s^2: what the pair's own reaction adds to d2(gap)/dt2 */
    bool pressed;
    bool jams;           /* no pressures can hold it: its impact has no approach */
    double acceleration; /* then: d2(gap)/dt2 under the loads and the other contacts' reactions, m/s^2 */
} imp_meeting;

/* The loads on all bodies now; and with the reactions of the contacts that are held. */
impact_status imp_scene_load(imp_island *island);
impact_status imp_scene_load_with_reactions(imp_island *island);

/* Fills the meeting of a held pair, or of an open one that touches within its plane's bounds; false otherwise. */
bool imp_scene_meets(imp_island *island, int p, imp_meeting *m);
/* Finds what presses the pair together, and its whole contact, if that is not known yet. */
void imp_scene_press(imp_island *island, imp_meeting *m);

/* Whether a bounce at this speed would rise less than the rest height under the acceleration that presses the bodies
 * together. Bounces that are met a rounding d late gain what they fall by it, and never rise less than d e^2/(1 - e^2):
 * that counts as rest too. */
bool imp_scene_dies_out(imp_island *island, imp_meeting *m, double speed);
/* Whether the pair parts at this speed so fast that no acceleration there could make it die out. */
bool imp_scene_leaves_for_good(const imp_island *island, const imp_meeting *m, double speed);

/* The pair's impact as it is to be solved; a body as one of its sides. */
impact_collision imp_scene_collision(imp_island *island, imp_meeting *m);
impact_collider imp_scene_collider(const imp_island *island, int body, qvec3 offset);

/* After an impact; a static body keeps its own. */
void imp_scene_set_velocities(imp_island *island, int body, qvec3 velocity, qvec3 omega);
/* The work of the static body's drive with the impulse on body 1 is booked, J. */
double imp_scene_drive_impulse(imp_island *island, const imp_held_contact *contact, qvec3 impulse);
/* An answer whose law let it give bodies so much energy, J. */
void imp_scene_gain(imp_island *island, double works);

#endif
