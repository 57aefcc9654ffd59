/* SPDX-License-Identifier: MIT
 *
 * spin: how a body turns over a window of time, no less: of its omega W in body axes, and of any unit vector m that is
 * fixed in the world, seen from the body, m' = m x W. Internal.
 */
#ifndef IMP_SPIN_H
#define IMP_SPIN_H

#include "world/world.h"

typedef struct imp_spin {
    qvec3 omega, rate;    /* W and W' at the window's start, 1/s and 1/s^2 */
    double most;          /* |W|, 1/s */
    double most_rate;     /* |W'|, 1/s^2 */
    double most_second;   /* |W''|, 1/s^3 */
    double second, third; /* |m''|, 1/s^2, and |m'''|, 1/s^3 */
} imp_spin;

/* L' at the window's start, world, N m, and no less than |L'| and |L''| over it. */
typedef struct imp_torques {
    qvec3 now;
    double most, rate;
} imp_torques;

/* From the state at its start; |L| is no more than momentum. fastest: no less than the components of W, where that is
 * known; else NULL. */
imp_spin imp_spin_of(const imp_body *body, const imp_state *now, const qvec3 *fastest, double momentum,
                     imp_torques torques, double window);

/* W' in body axes at a state under a torque, world axes. */
qvec3 imp_spin_rate(const imp_body *body, const imp_state *now, qvec3 torque);

#endif
