/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the contact frame and the inverse mass that the contact feels.
 */
#ifndef IMP_COLLIDE_FRAME_H
#define IMP_COLLIDE_FRAME_H

#include "collide/collide_ready.h"

/* M = scale [[a, e, c], [e, b, d], [c, d, 1]] in a right-handed frame (t1, t2, n); e = 0 in the principal one.
 * schur = det M_tt / a and k = 1 - (c, d).M_tt^-1 (c, d) are the least of sums of squares, not differences. */
typedef struct imp_frame {
    imp_vec t1, t2, n;
    imp_real a, b, c, d, e;
    imp_real schur, k;
    imp_real alpha, beta;  /* -M_tt^-1 M_tz: per unit of p, the tangential impulse that sticks */
    imp_real scale;        /* M_zz, 1/kg */
    imp_real conditioning; /* |M| |M^-1| / 3, Frobenius norms */
} imp_frame;

/* Rows of the root of M, M = w I + B' B: with the weights J^-1/2, a unit vector's dot product with them is its arm
 * offset x e, local axes, for each body. */
typedef struct imp_levers {
    imp_vectors row[3];
} imp_levers;

static inline imp_vectors imp_frame_lever(imp_lanes weight, imp_lanes p, const imp_vectors *x, imp_lanes q,
                                          const imp_vectors *y)
{
    p *= weight;
    q *= weight;
    return (imp_vectors){p * x->x - q * y->x, p * x->y - q * y->y, p * x->z - q * y->z};
}

static inline imp_levers imp_frame_levers(const imp_ready *ready)
{
    const imp_vectors *axis = ready->axis, *r = &ready->offset, *w = &ready->inverse_moments;
    return (imp_levers){{imp_frame_lever(imp_lanes_sqrt(w->x), r->y, &axis[2], r->z, &axis[1]),
                         imp_frame_lever(imp_lanes_sqrt(w->y), r->z, &axis[0], r->x, &axis[2]),
                         imp_frame_lever(imp_lanes_sqrt(w->z), r->x, &axis[1], r->y, &axis[0])}};
}

/* The rows times e. */
static inline imp_vectors imp_frame_arms(const imp_levers *l, imp_vec e)
{
    const imp_vectors *row = l->row;
    return (imp_vectors){row[0].x * e.x + row[0].y * e.y + row[0].z * e.z,
                         row[1].x * e.x + row[1].y * e.y + row[1].z * e.z,
                         row[2].x * e.x + row[2].y * e.y + row[2].z * e.z};
}

/* n and t1: unit, at right angles. */
void imp_frame_make(imp_vec n, imp_vec t1, const imp_ready *ready, imp_frame *frame);

/* Turns t1, t2 to the principal directions of M_tt. */
void imp_frame_turn(const imp_ready *ready, imp_frame *frame);

/* The principal frame for the unit normal n. */
void imp_frame_principal(imp_vec n, const imp_ready *ready, imp_frame *frame);

/* A unit vector across the unit vector n. */
imp_vec imp_frame_across(imp_vec n);

/* The collision's normal at unit length. */
imp_vec imp_frame_normal(const impact_collision *collision);

#endif
