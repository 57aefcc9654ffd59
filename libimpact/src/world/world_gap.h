/* SPDX-License-Identifier: MIT
 *
 * world_gap: gaps, contact velocities and energy of the world's pairs. Internal.
 */
#ifndef IMP_WORLD_GAP_H
#define IMP_WORLD_GAP_H

#include "world/world.h"

/* The pair's contact, counted by the road that answered; of a pair that is placed the one that it has. */
impact_status imp_world_gap(imp_world *world, imp_pair *pair, const imp_state *states, impact_contact *contact);

/* The same where bodies that are so near, m, are taken to touch (normal.h). */
impact_status imp_world_gap_within(imp_world *world, imp_pair *pair, const imp_state *states, double within,
                                   impact_contact *contact);

/* The contact of two bodies, from no cache; the same count. gaps may be NULL. */
impact_status imp_gap_of(const imp_body *body1, const imp_state *state1, const imp_body *body2, const imp_state *state2,
                         imp_gaps *gaps, impact_usage *usage, impact_contact *contact);

/* Counts a query by the road that answered. */
void imp_count_gap(impact_gap_path path, impact_usage *usage);

/* How far off a gap of the two may be by the tolerance that libccd was given, m; 0 of all others. */
double imp_gap_error(const imp_gaps *gaps, const imp_body *body1, const imp_body *body2);

/* The support function of the body's surface about its centre of mass, in its own axes: see impact_shape_support. */
double imp_world_support(const imp_body *body, qvec3 direction, qvec3 *point);

/* d(gap)/dt at a contact of the pair. */
double imp_world_gap_rate(const imp_world *world, const imp_pair *pair, const imp_state *states,
                          const impact_contact *contact);

/* m: the size of the numbers that the gap of two bodies with these centres is made of, along its normal: far away along
 * a floor counts for nothing. */
double imp_place_scale(const imp_body *body1, qvec3 x1, const imp_body *body2, qvec3 x2, qvec3 normal);

/* The same of a pair, with the normal as it is known. */
double imp_world_place_scale(const imp_world *world, const imp_pair *pair, const imp_state *states);

/* Gaps of the pair up to this are rounding, m. */
double imp_world_touching_distance(const imp_world *world, const imp_pair *pair, const imp_state *states);

/* A lower bound of the gap without a query, from the bounding balls; -inf when there is none. */
double imp_world_distance_bound(const imp_world *world, const imp_pair *pair, const imp_state *states);

/* Another: how far the direction of the pair's last contact, or of a plane, separates them. */
double imp_world_separation(const imp_world *world, const imp_pair *pair, const imp_state *states);

/* Whether the contact lies within the bounds of the pair's plane (always, for other shapes); > 0 inside, m. */
double imp_world_inside_bounds(const imp_world *world, const imp_pair *pair, const imp_state *states,
                               const impact_contact *contact);

/* Of all bodies that move, J. */
double imp_world_kinetic_energy(const imp_world *world, const imp_state *states);

#endif
