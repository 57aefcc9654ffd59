/* SPDX-License-Identifier: MIT
 *
 * field: the scene's forces summed over its bodies, and the edges of their reach. Internal.
 */
#ifndef IMPACT_FIELD_H
#define IMPACT_FIELD_H

#include "world.h"

typedef struct impact_load {
    qvec3 force, torque; /* N, N m, world */
    double work_rate;    /* W: of wind and custom forces */
    double damping_rate; /* W lost to damping, >= 0 */
} impact_load;

/* Load of gravity, fields and damping on every body at time t. false: a custom force refused. */
bool impact_field_loads(const impact_world *world, double t, const impact_state *states, impact_load *loads);

/* The greatest rate, 1/s, at which custom forces brake a body's motion along or about an axis of the world, by
 * differences: so much faster than the motion they may be that only an implicit method follows. *turning: the fastest
 * of their bodies' |omega|. 0 where there are none, or a force refuses. */
double impact_field_brake(const impact_world *world, double t, const impact_state *states, double *turning);

/* Potential energy of gravity and attraction, J. */
double impact_field_potential(const impact_world *world, const impact_state *states);

/* How many edges the fields have; for each its value, > 0 on the side where the motion now is, and minus the value's
 * rate; one's value. */
int impact_field_edge_count(const impact_world *world);
void impact_field_edges(const impact_world *world, const impact_state *states, double *value);
double impact_field_edge(const impact_world *world, const impact_state *states, int edge);
/* A step, s, so short that no body within an edge can leave and come back in it unseen; infinite when there
 * are none. */
double impact_field_step_limit(const impact_world *world, const impact_state *states, const impact_load *loads);
/* Sets every inside flag from where the bodies are. */
void impact_field_locate(impact_world *world, const impact_state *states);
/* Edge was crossed: turns its flag, and tells whose edge it is. */
void impact_field_cross(impact_world *world, int edge, int *field, int *body);

/* Slots of a field over so many bodies; for allocation. */
int impact_field_slots(const impact_force_def *def, int body_count);
/* Whether any force but uniform gravity acts on any body. */
bool impact_field_any(const impact_world *world);

#endif
