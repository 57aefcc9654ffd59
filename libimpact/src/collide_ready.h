/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the bodies made ready for an impact, side by side.
 */
#ifndef IMPACT_COLLIDE_READY_H
#define IMPACT_COLLIDE_READY_H

#include <impact/collide.h>
#include "collide_pair.h"

/* A static body has mass, moments, inverses and offset 0. Local axes: `axis`; of a round or static body,
 * the world's. */
typedef struct impact_ready {
    impact_pair mass, inverse_mass;
    impact_vectors moments, inverse_moments;
    impact_vectors velocity, omega, arm; /* arm: contact point from the centre; world */
    impact_vectors offset;               /* the same, local axes */
    impact_vectors axis[3];              /* principal axes, world */
    bool round;                          /* both have three equal moments (or are static): orientations do not matter */
} impact_ready;

/* In line, where fmax and fmin are calls; a NaN is not minded. */
static inline double impact_larger(double a, double b) { return a > b ? a : b; }
static inline double impact_smaller(double a, double b) { return a < b ? a : b; }

void impact_ready_make(const impact_collision *collision, impact_ready *ready);

/* World vectors to local axes and back. */
static inline impact_vectors impact_ready_local(const impact_ready *ready, const impact_vectors *v)
{
    const impact_vectors *axis = ready->axis;
    if (ready->round) return *v;
    return (impact_vectors){impact_vectors_dot(&axis[0], v), impact_vectors_dot(&axis[1], v),
                            impact_vectors_dot(&axis[2], v)};
}

static inline impact_vectors impact_ready_world(const impact_ready *ready, const impact_vectors *v)
{
    const impact_vectors *axis = ready->axis;
    if (ready->round) return *v;
    return (impact_vectors){v->x * axis[0].x + v->y * axis[1].x + v->z * axis[2].x,
                            v->x * axis[0].y + v->y * axis[1].y + v->z * axis[2].y,
                            v->x * axis[0].z + v->y * axis[1].z + v->z * axis[2].z};
}

/* Of the contact points, body 1 less body 2, world. */
static inline qvec3 impact_ready_velocity(const impact_ready *ready)
{
    const impact_vectors turn = impact_vectors_cross(&ready->omega, &ready->arm);
    const impact_pair x = ready->velocity.x + turn.x, y = ready->velocity.y + turn.y, z = ready->velocity.z + turn.z;
    return (qvec3){x[0] - x[1], y[0] - y[1], z[0] - z[1]};
}

#endif
