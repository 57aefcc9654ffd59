/* SPDX-License-Identifier: MIT
 *
 * collide, inside: impacts that need no contact frame.
 */
#ifndef IMPACT_COLLIDE_DIRECT_H
#define IMPACT_COLLIDE_DIRECT_H

#include "collide_ready.h"

/* Solves an impact without friction, or of round bodies struck centrally: all of the outcome but velocities and energies. n is the unit
 * normal, u the relative velocity of the contact points, approach = u.n < 0; a tangential velocity up to `rounding` counts as none.
 * False where neither holds. */
bool impact_direct_solve(const impact_collision *collision, const impact_ready ready[2], qvec3 n, qvec3 u,
                         double approach, double rounding, impact_outcome *outcome);

#endif
