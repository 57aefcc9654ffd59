/* SPDX-License-Identifier: MIT
 *
 * field: the scene's forces summed over its bodies, and the edges of their reach. Internal.
 */
#ifndef IMP_FIELD_H
#define IMP_FIELD_H

#include "world/world.h"

typedef struct imp_load {
    qvec3 force, torque; /* N, N m, world */
    double work_rate;    /* W: of wind and custom forces */
    double damping_rate; /* W lost to damping, >= 0 */
} imp_load;

/* Load of gravity, fields and damping on every body at time t. false: a custom force refused. */
bool imp_field_loads(const imp_world *world, double t, const imp_state *states, imp_load *loads);

/* The greatest rate, 1/s, at which custom forces brake a body's motion along or about an axis of the world, by
 * differences: so much faster than the motion they may be that only an implicit method follows. *turning: the fastest
 * of their bodies' |omega|. 0 where there are none, or a force refuses. */
double imp_field_brake(const imp_world *world, double t, const imp_state *states, double *turning);

/* Potential energy of gravity and attraction, J. */
double imp_field_potential(const imp_world *world, const imp_state *states);

/* How many edges the fields have; for each its value, > 0 on the side where the motion now is, and minus the value's
 * rate (of a custom force's: 1); one's value. */
int imp_field_edge_count(const imp_world *world);
void imp_field_edges(const imp_world *world, double t, const imp_state *states, double *value);
double imp_field_edge(const imp_world *world, double t, const imp_state *states, int edge);
/* A step, s, so short that no body within an edge can leave and come back in it unseen; infinite when there
 * are none. */
double imp_field_step_limit(const imp_world *world, const imp_state *states, const imp_load *loads);
/* The same for what may not be stepped over of custom forces: max_step, and a body's radius over its speed. */
double imp_field_custom_step_limit(const imp_world *world, const imp_state *states, const imp_load *loads);
/* Sets the inside flags of the custom forces, or of all others, from where the bodies are. */
void imp_field_locate(imp_world *world, double t, const imp_state *states, bool custom);
/* Sets every custom force's piece to the one that begins at t or before, and ends after it. */
void imp_field_enter(imp_world *world, double t);
/* Where the first of them ends, s; infinite when there are no switches. */
double imp_field_next_switch(const imp_world *world);
/* t, or the time nearest to it that lies inside the field's piece. */
double imp_field_inner_time(const imp_field *field, double t);
/* Whether some force may move, some time, what rests under it now. */
bool imp_field_unsteady(const imp_world *world);
/* Edge was crossed: turns its flag, and tells whose edge it is. */
void imp_field_cross(imp_world *world, int edge, int *field, int *body);

/* Slots of a field over so many bodies; for allocation. */
int imp_field_slots(const impact_force_def *def, int body_count);

#endif
