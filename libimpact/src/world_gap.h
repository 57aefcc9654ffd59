/* SPDX-License-Identifier: MIT
 *
 * world_gap: gaps, contact velocities and energy of the world's pairs. Internal.
 */
#ifndef IMPACT_WORLD_GAP_H
#define IMPACT_WORLD_GAP_H

#include "world.h"

struct impact_touch;

/* The pair's contact, counted by the road that answered. */
impact_status impact_world_gap(impact_world *world, impact_pair *pair, const impact_state *states,
                               impact_contact *contact);

/* The support function of the body's surface about its centre of mass, in its own axes: see impact_shape_support. */
double impact_world_support(const impact_body *body, qvec3 direction, qvec3 *point);

/* d(gap)/dt at a contact of the pair. */
double impact_world_gap_rate(const impact_world *world, const impact_pair *pair, const impact_state *states,
                             const impact_contact *contact);

/* Normal relative velocity at a touch, m/s; < 0: approaching. */
double impact_world_approach(const impact_world *world, const struct impact_touch *touch, const impact_state *states);

/* m: how far body 1 reaches from the origin: places are known relative to it. */
double impact_world_reach(const impact_world *world, const impact_pair *pair, const impact_state *states);

/* Gaps of the pair up to this are rounding, m. */
double impact_world_touching_distance(const impact_world *world, const impact_pair *pair, const impact_state *states);

/* A lower bound of the gap without a query, from the bounding balls; -inf when there is none. */
double impact_world_distance_bound(const impact_world *world, const impact_pair *pair, const impact_state *states);

/* Its rate, m/s. */
double impact_world_distance_bound_rate(const impact_world *world, const impact_pair *pair, const impact_state *states);

/* Whether the contact lies within the bounds of the pair's plane (always, for other shapes); > 0 inside, m. */
double impact_world_inside_bounds(const impact_world *world, const impact_pair *pair, const impact_state *states,
                                  const impact_contact *contact);

/* Of all bodies that move, J. */
double impact_world_kinetic_energy(const impact_world *world, const impact_state *states);

#endif
