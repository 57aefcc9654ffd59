/* SPDX-License-Identifier: MIT
 *
 * scene_pile: when a scene's motion is stepped instead of integrated, and how it comes back. Internal.
 */
#ifndef IMP_SCENE_PILE_H
#define IMP_SCENE_PILE_H

#include "scene/scene_internal.h"

/* Room for stepping, in the scene's arena; none where piles are to be moved exactly. */
impact_status imp_scene_pile_open(impact_scene *scene, impact_piles piles);

/* Asked at every step of the integrator: whether the motion has not got on for so long that it is to go on by steps. */
bool imp_scene_pile_pulse(impact_scene *scene);
/* The same of a group of a crowd, whose work is thrown away then. */
bool imp_scene_pile_party(impact_scene *whole, const impact_scene *party);

/* Whether the motion is by steps now. */
bool imp_scene_pile_stepped(const impact_scene *scene);
/* Some steps of the whole scene, until t_end at most. Where all rests, or no body touches another that moves any more,
 * the motion is exact again. */
impact_status imp_scene_pile_advance(impact_scene *scene, double t_end);

#endif
