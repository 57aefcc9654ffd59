/* SPDX-License-Identifier: MIT
 *
 * gather: what meets at one instant becomes an island: the bodies, what touches them now, all that is held with any of
 * these or tied to it by a force, and so on, with the static bodies they touch. Internal.
 */
#ifndef IMP_GATHER_H
#define IMP_GATHER_H

#include "scene/scene_internal.h"

/* The body, and all of its island, are to be of the next that is gathered. */
void imp_gather_member(impact_scene *scene, int body);
void imp_gather_company(impact_scene *scene, int body);

/* An island of all that the members (and the pair `seed`, or -1) touch at t; the members' old islands are no more.
 * stepped: to be moved by steps, as it is too where one that joins it was. */
impact_status imp_gather(impact_scene *scene, int seed, double t, bool stepped, imp_island **island);

/* What was gathered in the island, as it stands now, as one that goes by steps, with all pairs that its bodies may
 * make; the island is no more. */
impact_status imp_gather_steps(imp_island *island, imp_island **stepped);

/* Whether the pair touches at t, but for a rounding. */
bool imp_gather_touches(impact_scene *scene, const imp_near *near, double t);
/* The energy of all but the island's bodies at t, J, for the rows of events; theirs leaves the account. */
double imp_gather_energy_outside(impact_scene *scene, const imp_island *island, double t);

#endif
