/* SPDX-License-Identifier: MIT
 *
 * persist_system: the linear system behind the held contacts. Internal.
 */
#ifndef IMPACT_PERSIST_SYSTEM_H
#define IMPACT_PERSIST_SYSTEM_H

#include "persist.h"

/* An orthonormal tangent; the other is normal x it. */
qvec3 impact_tangent(qvec3 normal);

/* Change of touch a's relative acceleration (or velocity) for a force (or impulse) f on body 1 of touch b. */
qvec3 impact_system_response(const impact_world *world, const impact_state *states, const impact_touch *a,
                             const impact_touch *b, qvec3 f);

/* Finds each touch's force (or impulse) and pressure, so that its relative acceleration (or velocity) changes by what
 * is wanted: along the normal, and for a rolling contact across it too. with_friction: a sliding contact's pressure
 * brings its friction along, and where its direction is solved for too, across that direction u' changes by pull x (the
 * force across it). Where the reactions are not unique, those of the least sum of squares, each over the inertia at its
 * contact: they follow the state as smoothly as it goes. What is still keeps its reaction, and no impulse. */
void impact_system_solve(impact_persist *persist, const impact_world *world, const impact_state *states,
                         bool with_friction);

/* By how much all forces that were solved for change this touch's relative acceleration. */
qvec3 impact_system_change(const impact_persist *persist, const impact_touch *touch);

/* Adds to the states what all impulses that were solved for do. */
void impact_system_apply(const impact_persist *persist, const impact_world *world, impact_state *states);

#endif
