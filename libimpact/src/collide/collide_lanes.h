/* SPDX-License-Identifier: MIT
 *
 * collide, inside: two bodies worked on at once, each in a lane of its own.
 */
#ifndef IMP_COLLIDE_LANES_H
#define IMP_COLLIDE_LANES_H

#include "collide/collide_real.h"

typedef imp_real imp_lanes __attribute__((vector_size(2 * sizeof(imp_real))));

/* Per lane all bits or none, as comparisons of pairs give it. */
typedef imp_word imp_mask __attribute__((vector_size(2 * sizeof(imp_real))));

/* A vector for each body. */
typedef struct imp_vectors {
    imp_lanes x, y, z;
} imp_vectors;

static inline bool imp_mask_all(imp_mask m) { return (m[0] & m[1]) != 0; }
static inline bool imp_mask_any(imp_mask m) { return (m[0] | m[1]) != 0; }

/* x where the mask is set, 0 elsewhere, whatever x is there. */
static inline imp_lanes imp_lanes_where(imp_mask m, imp_lanes x) { return (imp_lanes)((imp_mask)x & m); }

static inline imp_lanes imp_lanes_pick(imp_mask m, imp_lanes x, imp_lanes otherwise)
{
    return (imp_lanes)(((imp_mask)x & m) | ((imp_mask)otherwise & ~m));
}

static inline imp_lanes imp_lanes_size(imp_lanes x)
{
    const imp_mask sign = (imp_mask)(imp_lanes){-0.0, -0.0};
    return (imp_lanes)((imp_mask)x & ~sign);
}

static inline imp_lanes imp_lanes_sqrt(imp_lanes x) { return (imp_lanes){imp_sqrt(x[0]), imp_sqrt(x[1])}; }
static inline imp_lanes imp_lanes_larger(imp_lanes x, imp_lanes y) { return imp_lanes_pick(x > y, x, y); }
static inline imp_lanes imp_lanes_smaller(imp_lanes x, imp_lanes y) { return imp_lanes_pick(x < y, x, y); }

static inline imp_vectors imp_vectors_of(imp_vec one, imp_vec two)
{
    return (imp_vectors){{one.x, two.x}, {one.y, two.y}, {one.z, two.z}};
}

/* Body `lane`'s. */
static inline imp_vec imp_vectors_at(const imp_vectors *v, int lane)
{
    return (imp_vec){v->x[lane], v->y[lane], v->z[lane]};
}

static inline imp_lanes imp_vectors_dot(const imp_vectors *p, const imp_vectors *q)
{
    return p->x * q->x + p->y * q->y + p->z * q->z;
}

static inline imp_vectors imp_vectors_cross(const imp_vectors *p, const imp_vectors *q)
{
    return (imp_vectors){p->y * q->z - p->z * q->y, p->z * q->x - p->x * q->z, p->x * q->y - p->y * q->x};
}

/* The weights entry by entry: a diagonal matrix times p. */
static inline imp_vectors imp_vectors_weigh(const imp_vectors *weights, const imp_vectors *p)
{
    return (imp_vectors){weights->x * p->x, weights->y * p->y, weights->z * p->z};
}

/* p + f q */
static inline imp_vectors imp_vectors_add(const imp_vectors *p, imp_lanes f, const imp_vectors *q)
{
    return (imp_vectors){p->x + f * q->x, p->y + f * q->y, p->z + f * q->z};
}

/* |x| + |y| + |z| */
static inline imp_lanes imp_vectors_size(const imp_vectors *p)
{
    return imp_lanes_size(p->x) + imp_lanes_size(p->y) + imp_lanes_size(p->z);
}

#endif
