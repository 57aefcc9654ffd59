/* SPDX-License-Identifier: MIT
 *
 * One frictional impact in 128-bit arithmetic by the closed hodograph, sharing no formula with the library's solvers
 * beyond the equation of motion itself: M from its definition, s(theta) as a product of powers of sines, p and the work
 * of friction by quadrature over theta, the normal work from the energy; what slides straight, or not at all, in closed
 * form. gcc with libquadmath.
 */
#ifndef COLLIDE_ORACLE_H
#define COLLIDE_ORACLE_H

#include <impact/collide.h>

typedef struct oracle_outcome {
    qvec3 velocity[2], omega[2], impulse;
    double compression_impulse, work_compression, work_restitution, work_friction, normal_after;
    int compressions;
    bool stuck;    /* u_t came to 0 */
    bool reversed; /* and slid on at once */
    bool jammed;   /* u_z fell somewhere in compression */
    double turned; /* angle through which the sliding direction turned, rad */
} oracle_outcome;

/* False: two roots of T coincide to within 1e-8 rad, or sliding neither stops nor goes on; this is outside of the
 * oracle. */
bool oracle_collide(const impact_collision *collision, oracle_outcome *outcome);

#endif
