/* SPDX-License-Identifier: MIT
 *
 * collide, inside: two bodies worked on at once, each in a lane of its own.
 */
#ifndef IMPACT_COLLIDE_PAIR_H
#define IMPACT_COLLIDE_PAIR_H

#include <math.h>
#include <quat/quat.h>

typedef double impact_pair __attribute__((vector_size(16)));

/* Per lane all bits or none, as comparisons of pairs give it. */
typedef long long impact_mask __attribute__((vector_size(16)));

/* A vector for each body. */
typedef struct impact_vectors {
    impact_pair x, y, z;
} impact_vectors;

static inline bool impact_mask_all(impact_mask m) { return (m[0] & m[1]) != 0; }
static inline bool impact_mask_any(impact_mask m) { return (m[0] | m[1]) != 0; }

/* x where the mask is set, 0 elsewhere, whatever x is there. */
static inline impact_pair impact_pair_where(impact_mask m, impact_pair x) { return (impact_pair)((impact_mask)x & m); }

static inline impact_pair impact_pair_pick(impact_mask m, impact_pair x, impact_pair otherwise)
{
    return (impact_pair)(((impact_mask)x & m) | ((impact_mask)otherwise & ~m));
}

static inline impact_pair impact_pair_size(impact_pair x)
{
    const impact_mask sign = (impact_mask)(impact_pair){-0.0, -0.0};
    return (impact_pair)((impact_mask)x & ~sign);
}

static inline impact_pair impact_pair_sqrt(impact_pair x) { return (impact_pair){sqrt(x[0]), sqrt(x[1])}; }
static inline impact_pair impact_pair_larger(impact_pair x, impact_pair y) { return impact_pair_pick(x > y, x, y); }
static inline impact_pair impact_pair_smaller(impact_pair x, impact_pair y) { return impact_pair_pick(x < y, x, y); }

static inline impact_vectors impact_vectors_of(qvec3 one, qvec3 two)
{
    return (impact_vectors){{one.x, two.x}, {one.y, two.y}, {one.z, two.z}};
}

/* Body `lane`'s. */
static inline qvec3 impact_vectors_at(const impact_vectors *v, int lane)
{
    return (qvec3){v->x[lane], v->y[lane], v->z[lane]};
}

static inline impact_pair impact_vectors_dot(const impact_vectors *p, const impact_vectors *q)
{
    return p->x * q->x + p->y * q->y + p->z * q->z;
}

static inline impact_vectors impact_vectors_cross(const impact_vectors *p, const impact_vectors *q)
{
    return (impact_vectors){p->y * q->z - p->z * q->y, p->z * q->x - p->x * q->z, p->x * q->y - p->y * q->x};
}

/* The weights entry by entry: a diagonal matrix times p. */
static inline impact_vectors impact_vectors_weigh(const impact_vectors *weights, const impact_vectors *p)
{
    return (impact_vectors){weights->x * p->x, weights->y * p->y, weights->z * p->z};
}

/* p + f q */
static inline impact_vectors impact_vectors_add(const impact_vectors *p, impact_pair f, const impact_vectors *q)
{
    return (impact_vectors){p->x + f * q->x, p->y + f * q->y, p->z + f * q->z};
}

/* |x| + |y| + |z| */
static inline impact_pair impact_vectors_size(const impact_vectors *p)
{
    return impact_pair_size(p->x) + impact_pair_size(p->y) + impact_pair_size(p->z);
}

#endif
