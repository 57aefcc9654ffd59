/* SPDX-License-Identifier: MIT
 *
 * motion_meet: bodies in flight in closed form, and when two of them meet. Internal.
 */
#ifndef IMP_MOTION_MEET_H
#define IMP_MOTION_MEET_H

#include <impact/tumble.h>
#include "world/world.h"

/* A body's flight since something last changed it. */
typedef struct imp_flyer {
    imp_state start, now; /* now: elapsed seconds after the start */
    double elapsed;
    bool turns; /* its surface moves as it turns */
    impact_tumble tumble;
    double jerk; /* bound of the third derivative of a unit vector seen from the body, 1/s^3 */
} imp_flyer;

/* Begins a flight from the state, or goes on with the one that led to just this state. */
void imp_flyer_board(imp_flyer *flyer, const imp_body *body, const imp_state *state);

/* The next state begins a flight, be it the same. */
void imp_flyer_leave(imp_flyer *flyer);

/* The state dt seconds on. */
imp_state imp_flyer_at(const imp_flyer *flyer, const imp_body *body, qvec3 gravity, double dt);

typedef struct imp_meeting_time {
    double dt;    /* infinite: not within the horizon */
    bool touches; /* false: a near miss so long that it is looked at again from here */
} imp_meeting_time;

/* When the pair's gap falls to zero (beyond a plane's bounds: when it rises to zero). scratch: a state for each
 * body. */
imp_meeting_time imp_motion_meet(imp_world *world, imp_pair *pair, const imp_flyer *flyers, imp_state *scratch,
                                 double horizon);

#endif
