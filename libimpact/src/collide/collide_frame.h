/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the contact frame and the inverse mass that the contact feels.
 */
#ifndef IMP_COLLIDE_FRAME_H
#define IMP_COLLIDE_FRAME_H

#include "collide/collide_ready.h"

/* M = scale [[a, e, c], [e, b, d], [c, d, 1]] in a right-handed frame (t1, t2, n); e = 0 in the principal one.
 * schur = b - e^2/a and k = 1 - (c, d).M_tt^-1 (c, d) are the least of sums of squares, not those differences. */
typedef struct imp_frame {
    qvec3 t1, t2, n;
    double a, b, c, d, e;
    double schur, k;
    double alpha, beta;  /* -M_tt^-1 M_tz: per unit of p, the tangential impulse that sticks */
    double scale;        /* M_zz, 1/kg */
    double conditioning; /* |M| |M^-1| / 3, Frobenius norms */
} imp_frame;

/* n and t1: unit, at right angles. */
void imp_frame_make(qvec3 n, qvec3 t1, const imp_ready *ready, imp_frame *frame);

/* Turns t1, t2 to the principal directions of M_tt. */
void imp_frame_turn(const imp_ready *ready, imp_frame *frame);

/* The principal frame for the unit normal n. */
void imp_frame_principal(qvec3 n, const imp_ready *ready, imp_frame *frame);

/* A unit vector across the unit vector n. */
qvec3 imp_frame_across(qvec3 n);

/* The collision's normal at unit length. */
qvec3 imp_frame_normal(const impact_collision *collision);

#endif
