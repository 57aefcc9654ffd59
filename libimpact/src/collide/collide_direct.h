/* SPDX-License-Identifier: MIT
 *
 * collide, inside: impacts that need no contact frame.
 */
#ifndef IMP_COLLIDE_DIRECT_H
#define IMP_COLLIDE_DIRECT_H

#include "collide/collide_ready.h"

/* Solves an impact without friction, or of round bodies struck centrally: all of the outcome but velocities and
 * energies. n is the unit normal; the contact points slide by t across it, s = |t| (0 where t is but rounding), and
 * approach at speed > 0. False where neither holds. */
bool imp_direct_solve(const impact_collision *collision, const imp_ready *ready, qvec3 n, qvec3 t, double s,
                      double speed, impact_outcome *outcome);

#endif
