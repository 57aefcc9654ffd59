/* SPDX-License-Identifier: MIT
 *
 * flight: motion between impacts where it has a closed form: uniform gravity, and bodies whose angular velocity stays
 * as it is (three equal principal moments, or no rotation).
 */
#ifndef IMPACT_FLIGHT_H
#define IMPACT_FLIGHT_H

#include <quat/quat.h>
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A body in ballistic flight. SI, world frame. */
typedef struct impact_flight {
    qvec3 position;
    quat orientation;
    qvec3 velocity;
    qvec3 omega; /* constant */
} impact_flight;

/* The flight after dt seconds (any sign) under uniform gravity: exact but for rounding. */
IMPACT_API impact_flight impact_flight_after(impact_flight start, qvec3 gravity, double dt);

/* Smallest dt >= 0 at which a + b dt + c dt^2 / 2 falls to zero, for a >= 0 (negative a counts as 0): infinite when it
 * never does, and 0 when a = 0 and it falls at once. A gap of zero that opens (b > 0) falls again later, not now. */
IMPACT_API double impact_flight_fall_time(double a, double b, double c);

#ifdef __cplusplus
}
#endif

#endif
