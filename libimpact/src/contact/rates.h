/* SPDX-License-Identifier: MIT
 *
 * rates: how a contact moves with its bodies: what of gap'' and of the slip's rate the velocities alone bring.
 * Internal.
 */
#ifndef IMP_RATES_H
#define IMP_RATES_H

#include "world/field.h"

/* How fast: */
typedef struct imp_rates {
    qvec3 normal;     /* it turns, 1/s */
    qvec3 arm1, arm2; /* the contact point moves from each centre of mass, m/s */
} imp_rates;

/* Of the pair's contact, which touches. */
imp_rates imp_contact_rates(imp_world *world, const imp_pair *pair, imp_bearer bearer, const impact_contact *contact,
                            const imp_state *states);

/* The same of the one point of two bodies of which one has faces; joined: or of one of those of lines that lie on each
 * other, which is where they do and not where they would cross. */
imp_rates imp_feature_rates(const imp_world *world, const imp_pair *pair, bool joined, const impact_contact *contact,
                            const imp_state *states);

/* W v, m^2: of a tangential vector, W the Hessian of the body's support function at the outward normal, world. */
qvec3 imp_surface_bend(const imp_body *body, const imp_state *state, qvec3 outward, qvec3 v);

/* Acceleration of a body's contact point under the load alone, m/s^2: arm from the centre of mass, and its rate. */
qvec3 imp_point_acceleration(const imp_body *body, const imp_state *state, const imp_load *load, qvec3 arm,
                             qvec3 arm_rate);

/* The rates of the contact's velocity, and of how the bodies turn on each other, along axes that turn with its normal:
 * those of the velocities alone, without loads or reactions; across it of the velocity at rub (m) from there, which
 * goes with whose corner it is. axes: the normal and two tangents; 6 numbers, m/s^2 and 1/s^2. */
void imp_contact_bend(imp_world *world, const imp_pair *pair, imp_bearer bearer, const impact_contact *contact,
                      const qvec3 axes[3], qvec3 rub, const imp_state *states, double bend[6]);

#endif
