/* SPDX-License-Identifier: MIT
 *
 * motion_meet: bodies in flight in closed form, and when two of them meet. Internal.
 */
#ifndef IMPACT_MOTION_MEET_H
#define IMPACT_MOTION_MEET_H

#include <impact/tumble.h>
#include "world.h"

/* A body's flight since something last changed it. */
typedef struct impact_flyer {
    impact_state start, now; /* now: elapsed seconds after the start */
    double elapsed;
    bool turns; /* its surface moves as it turns */
    impact_tumble tumble;
    double jolt; /* bound of the third derivative of a unit vector seen from the body, 1/s^3 */
} impact_flyer;

/* Begins a flight from the state, or goes on with the one that led to just this state. */
void impact_flyer_board(impact_flyer *flyer, const impact_body *body, const impact_state *state);

/* The next state begins a flight, be it the same. */
void impact_flyer_leave(impact_flyer *flyer);

/* The state dt seconds on. */
impact_state impact_flyer_at(const impact_flyer *flyer, const impact_body *body, qvec3 gravity, double dt);

typedef struct impact_meeting_time {
    double dt;    /* infinite: not within the horizon */
    bool touches; /* false: a near miss so long that it is looked at again from here */
} impact_meeting_time;

/* When the pair's gap falls to zero (beyond a plane's bounds: when it rises to zero). scratch: a state for each
 * body. */
impact_meeting_time impact_motion_meet(impact_world *world, impact_pair *pair, const impact_flyer *flyers,
                                       impact_state *scratch, double horizon);

#endif
