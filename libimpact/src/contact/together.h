/* SPDX-License-Identifier: MIT
 *
 * together: impulses that many touching pairs exchange together, without restitution. Internal.
 */
#ifndef IMP_TOGETHER_H
#define IMP_TOGETHER_H

#include "contact/persist.h"

/* One touching pair's part. */
typedef struct imp_share {
    imp_touch touch;
    qvec3 before, after; /* relative velocity of the contact points */
    qvec3 impulse;       /* on body 1, N s */
    double normal;       /* its part along the normal, >= 0 */
    double work;         /* J: impulse . (before + after)/2; the shares' sum is the change of energy */
} imp_share;

/* Changes the velocities so that no share's pair approaches any more: normal impulses >= 0, only where the pair does
 * not part; friction within its cone, against the slip that is left. Gauss's sweeps over the shares in order, each
 * solving its own; kinetic energy falls. Where they do not settle, as between bodies of very different masses, all that
 * press are solved at once. True when it settled; what approach is left otherwise is less than before. */
bool imp_answer_together(const imp_world *world, imp_state *states, imp_share *shares, int count);

#endif
