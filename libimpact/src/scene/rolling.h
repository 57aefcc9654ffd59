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
 *
 * A pair with rolling friction rho (its moment rho N against omega_t) and torsional friction tau, in a straight line e,
 * k = n x e, beta = J/(m r^2):
 *
 *     rolls along e    a = (g_t - rho N/(m r) e)/(1 + beta), until v = 0; |a - g_t| <= mu N/m
 *     slides along e   alpha = (r mu -/+ rho) N/J k, against omega.k; until the slip, or omega.k, is 0
 *     spins on n       alpha = -/+ tau N/J n, until omega = 0
 *
 * On level ground it so rolls v^2/(2 |a|) far, 7 r v^2/(10 rho g) for a solid ball, and spins for 2 r^2 omega/(5 tau
 * g). What spins and also rolls or slides, with tau, is in no closed form: its friction turns between both.
 */
#ifndef IMP_ROLLING_H
#define IMP_ROLLING_H

#include "scene/island.h"

/* Whether bodies that resist turning on each other are held in the island, and neither rest nor are a ball alone on a
 * plane, that has a closed form if it is all of the island: steps move them, as no integrator has their moments. Its
 * contacts are as imp_scene_load left them. */
bool imp_island_needs_steps(const imp_island *island);

/* Whether the pair, a ball that lies on a plane and all of its island, rolls or spins in closed form: what has been
 * stepped needs no more steps. */
bool imp_island_rolls_out(const imp_island *island, const imp_pair *pair);

/* Whether the island moves so from its time on, its contact being as imp_scene_load_with_reactions left it; then its
 * body's segment, and what ends it in *end. */
bool imp_island_rolls(const imp_island *island, imp_segment *segment, imp_end *end);

#endif
