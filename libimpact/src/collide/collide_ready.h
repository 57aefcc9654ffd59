/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the bodies made ready for an impact, side by side.
 */
#ifndef IMP_COLLIDE_READY_H
#define IMP_COLLIDE_READY_H

#include <impact/collide.h>
#include "collide/collide_lanes.h"

/* A static body has mass, moments, inverses and offset 0. Local axes: `axis`; of a round or static body,
 * the world's. */
typedef struct imp_ready {
    imp_lanes mass, inverse_mass;
    imp_vectors moments, inverse_moments;
    imp_vectors velocity, omega, arm; /* arm: contact point from the centre; world */
    imp_vectors offset;               /* the same, local axes */
    imp_vectors axis[3];              /* principal axes, world */
    bool round;                       /* both have three equal moments (or are static): orientations do not matter */
} imp_ready;

void imp_ready_make(const impact_collision *collision, imp_ready *ready);

/* World vectors to local axes and back. */
static inline imp_vectors imp_ready_local(const imp_ready *ready, const imp_vectors *v)
{
    const imp_vectors *axis = ready->axis;
    if (ready->round) return *v;
    return (imp_vectors){imp_vectors_dot(&axis[0], v), imp_vectors_dot(&axis[1], v), imp_vectors_dot(&axis[2], v)};
}

static inline imp_vectors imp_ready_world(const imp_ready *ready, const imp_vectors *v)
{
    const imp_vectors *axis = ready->axis;
    if (ready->round) return *v;
    return (imp_vectors){v->x * axis[0].x + v->y * axis[1].x + v->z * axis[2].x,
                         v->x * axis[0].y + v->y * axis[1].y + v->z * axis[2].y,
                         v->x * axis[0].z + v->y * axis[1].z + v->z * axis[2].z};
}

/* Of the contact points, body 1 less body 2, world. */
static inline imp_vec imp_ready_velocity(const imp_ready *ready)
{
    const imp_vectors turn = imp_vectors_cross(&ready->omega, &ready->arm);
    const imp_lanes x = ready->velocity.x + turn.x, y = ready->velocity.y + turn.y, z = ready->velocity.z + turn.z;
    return (imp_vec){x[0] - x[1], y[0] - y[1], z[0] - z[1]};
}

#endif
