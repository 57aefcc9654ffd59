/* SPDX-License-Identifier: MIT
 *
 * collide, inside: how far a straight slip that begins a little aside swerves.
 */
#ifndef IMP_COLLIDE_SWERVE_H
#define IMP_COLLIDE_SWERVE_H

#include "collide/collide_real.h"

/* With q the velocity aside, S = s + R p that along, dq/dp = f - kappa q/S and q = q0 at first:
 * int q/S dp = q0 once + f again, int int q/S dp dp = q0 twice + f thrice. */
typedef struct imp_swerve {
    imp_real once, again, twice, thrice;
} imp_swerve;

/* Over dp; s > 0, and S > 0 up to there. */
imp_swerve imp_swerve_over(imp_real s, imp_real R, imp_real kappa, imp_real dp);

/* Over dp from s = 0, R > 0: what was aside then is forgotten. */
imp_swerve imp_swerve_from_rest(imp_real R, imp_real kappa, imp_real dp);

/* To S = 0, R < 0. */
imp_swerve imp_swerve_to_rest(imp_real s, imp_real R, imp_real kappa);

#endif
