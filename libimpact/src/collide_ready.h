/* SPDX-License-Identifier: MIT
 *
 * collide, inside: a body made ready for an impact.
 */
#ifndef IMPACT_COLLIDE_READY_H
#define IMPACT_COLLIDE_READY_H

#include <impact/collide.h>

/* Two numbers worked on at once. */
typedef double impact_pair __attribute__((vector_size(16)));

/* A static body has inverse_mass 0, inverse_moments 0, and is round. Local axes: `axis`. */
typedef struct impact_ready {
    double inverse_mass;
    qvec3 inverse_moments;
    qvec3 offset;  /* contact point, local axes */
    bool round;    /* three equal moments (or static): the orientation does not matter */
    qvec3 axis[3]; /* principal axes, world; of a round body, the world's */
} impact_ready;

/* In line, where fmax and fmin are calls; a NaN is not minded. */
static inline double impact_larger(double a, double b) { return a > b ? a : b; }
static inline double impact_smaller(double a, double b) { return a < b ? a : b; }

void impact_ready_make(const impact_collider *body, impact_ready *ready);

/* World vector to local axes and back. */
static inline qvec3 impact_ready_local(const impact_ready *ready, qvec3 v)
{
    if (ready->round) return v;
    return (qvec3){qvec3_dot(ready->axis[0], v), qvec3_dot(ready->axis[1], v), qvec3_dot(ready->axis[2], v)};
}

static inline qvec3 impact_ready_world(const impact_ready *ready, qvec3 v)
{
    if (ready->round) return v;
    return qvec3_axpy(v.x, ready->axis[0], qvec3_axpy(v.y, ready->axis[1], qvec3_scale(ready->axis[2], v.z)));
}

/* J^-1 v, local axes. */
static inline qvec3 impact_ready_spin(const impact_ready *ready, qvec3 v)
{
    const qvec3 w = ready->inverse_moments;
    return (qvec3){w.x * v.x, w.y * v.y, w.z * v.z};
}

#endif
