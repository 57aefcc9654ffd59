/* SPDX-License-Identifier: MIT
 *
 * scene_together: impulses that many touching pairs exchange together, without restitution. Internal.
 */
#ifndef IMPACT_SCENE_TOGETHER_H
#define IMPACT_SCENE_TOGETHER_H

#include "persist.h"

/* One touching pair's part. */
typedef struct impact_share {
    impact_touch touch;
    qvec3 before, after; /* relative velocity of the contact points */
    qvec3 impulse;       /* on body 1, N s */
    double normal;       /* its part along the normal, >= 0 */
    double work;         /* J: impulse . (before + after)/2; the shares' sum is the change of energy */
} impact_share;

/* Changes the velocities so that no share's pair approaches any more: normal impulses >= 0, only where the pair does
 * not part; friction within its cone, against the slip that is left. Gauss's sweeps over the shares in order, each
 * solving its own; kinetic energy falls. Where they do not settle, as between bodies of very different masses, all that
 * press are solved at once. True when it settled; what approach is left otherwise is less than before. */
bool impact_answer_together(const impact_world *world, impact_state *states, impact_share *shares, int count);

#endif
