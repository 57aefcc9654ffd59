/* SPDX-License-Identifier: MIT
 *
 * truth_fall: a superquadric that falls on the floor z = 0, bounces and tumbles, from impact to impact by others than
 * the library: torque-free rotation and frictional impacts by the 128-bit oracles of tests/generators, the height of
 * the lowest point by the support function in 128 bits, its first root by samples and bisection. gcc with libquadmath.
 */
#ifndef BENCH_TRUTH_FALL_H
#define BENCH_TRUTH_FALL_H

#include <stdbool.h>
#include <impact/collide.h>

typedef struct truth_state {
    double t;
    qvec3 position, velocity; /* world */
    quat orientation;
    qvec3 omega; /* body axes */
} truth_state;

typedef struct truth_fall {
    double mass, axis[3], exponent; /* |x/a|^n + |y/b|^n + |z/c|^n = 1, n > 1 */
    qvec3 moments;
    double gravity, restitution, friction; /* of the pair */
    impact_law law;
    truth_state from; /* a flight begins here */
} truth_fall;

/* In the flight that begins at `from`. */
truth_state truth_fall_at(const truth_fall *fall, double t);

/* How much larger than itself a relative change of the first angular velocity is in the orientation at t, rad. */
double truth_fall_condition(const truth_fall *fall, double t);

/* To the next impact, and on: `from` becomes the state after it. False: there is none until then, or the body comes
 * back to the floor sooner than can be told from leaving it. */
bool truth_fall_next(truth_fall *fall, double until);

#endif
