/* SPDX-License-Identifier: MIT
 *
 * rolling: a ball alone on a plane that stands still, under gravity: rolling, or sliding in a straight line, it has
 * constant accelerations. Internal.
 *
 *     rolls            a = g_t/(1 + J/(m r^2)),  alpha = n x a/r
 *     slides along e   f = -mu N e,  a = g_t + f/m,  alpha = r1 x f/J,  slip' = g_t + f (1/m + r^2/J)
 *
 * with r1 = -r n, N = -m g.n and g_t = g - (g.n) n. The slip keeps its line where g_t lies in it or vanishes; where it
 * shrinks it dies out at |slip|/|slip'|. What spins about n goes on to do so.
 */
#ifndef IMP_ROLLING_H
#define IMP_ROLLING_H

#include "scene/island.h"

/* Whether the island moves so from its time on, its contact being as imp_scene_load_with_reactions left it; then its
 * body's segment, and what ends it in *end. */
bool imp_island_rolls(const imp_island *island, imp_segment *segment, imp_end *end);

#endif
