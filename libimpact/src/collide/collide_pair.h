/* SPDX-License-Identifier: MIT
 *
 * collide, inside: two bodies worked on at once, each in a lane of its own.
 */
#ifndef IMP_COLLIDE_PAIR_H
#define IMP_COLLIDE_PAIR_H

#include "collide/collide_real.h"

typedef imp_real imp_pair __attribute__((vector_size(2 * sizeof(imp_real))));

/* Per lane all bits or none, as comparisons of pairs give it. */
typedef imp_word imp_mask __attribute__((vector_size(2 * sizeof(imp_real))));

/* A vector for each body. */
typedef struct imp_vectors {
    imp_pair x, y, z;
} imp_vectors;

static inline bool imp_mask_all(imp_mask m) { return (m[0] & m[1]) != 0; }
static inline bool imp_mask_any(imp_mask m) { return (m[0] | m[1]) != 0; }

/* x where the mask is set, 0 elsewhere, whatever x is there. */
static inline imp_pair imp_pair_where(imp_mask m, imp_pair x) { return (imp_pair)((imp_mask)x & m); }

static inline imp_pair imp_pair_pick(imp_mask m, imp_pair x, imp_pair otherwise)
{
    return (imp_pair)(((imp_mask)x & m) | ((imp_mask)otherwise & ~m));
}

static inline imp_pair imp_pair_size(imp_pair x)
{
    const imp_mask sign = (imp_mask)(imp_pair){-0.0, -0.0};
    return (imp_pair)((imp_mask)x & ~sign);
}

static inline imp_pair imp_pair_sqrt(imp_pair x) { return (imp_pair){imp_sqrt(x[0]), imp_sqrt(x[1])}; }
static inline imp_pair imp_pair_larger(imp_pair x, imp_pair y) { return imp_pair_pick(x > y, x, y); }
static inline imp_pair imp_pair_smaller(imp_pair x, imp_pair y) { return imp_pair_pick(x < y, x, y); }

static inline imp_vectors imp_vectors_of(imp_vec one, imp_vec two)
{
    return (imp_vectors){{one.x, two.x}, {one.y, two.y}, {one.z, two.z}};
}

/* Body `lane`'s. */
static inline imp_vec imp_vectors_at(const imp_vectors *v, int lane)
{
    return (imp_vec){v->x[lane], v->y[lane], v->z[lane]};
}

static inline imp_pair imp_vectors_dot(const imp_vectors *p, const imp_vectors *q)
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
static inline imp_vectors imp_vectors_add(const imp_vectors *p, imp_pair f, const imp_vectors *q)
{
    return (imp_vectors){p->x + f * q->x, p->y + f * q->y, p->z + f * q->z};
}

/* |x| + |y| + |z| */
static inline imp_pair imp_vectors_size(const imp_vectors *p)
{
    return imp_pair_size(p->x) + imp_pair_size(p->y) + imp_pair_size(p->z);
}

#endif
