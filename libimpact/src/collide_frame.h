/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the contact frame and the inverse mass that the contact feels.
 */
#ifndef IMPACT_COLLIDE_FRAME_H
#define IMPACT_COLLIDE_FRAME_H

#include "collide_ready.h"

/* M = scale [[a, e, c], [e, b, d], [c, d, 1]] in a right-handed frame (t1, t2, n); e = 0 in the principal one.
 * schur = b - e^2/a and k = 1 - (c, d).M_tt^-1 (c, d) are the least of sums of squares, not those differences. */
typedef struct impact_frame {
    qvec3 t1, t2, n;
    double a, b, c, d, e;
    double schur, k;
    double alpha, beta;  /* -M_tt^-1 M_tz: per unit of p, the tangential impulse that sticks */
    double scale;        /* M_zz, 1/kg */
    double conditioning; /* |M| |M^-1| / 3, Frobenius norms */
} impact_frame;

/* n and t1: unit, at right angles. */
void impact_frame_make(qvec3 n, qvec3 t1, const impact_ready *ready, impact_frame *frame);

/* Turns t1, t2 to the principal directions of M_tt. */
void impact_frame_turn(const impact_ready *ready, impact_frame *frame);

/* The principal frame for the unit normal n. */
void impact_frame_principal(qvec3 n, const impact_ready *ready, impact_frame *frame);

/* A unit vector across the unit vector n. */
qvec3 impact_frame_across(qvec3 n);

/* The collision's normal at unit length. */
qvec3 impact_frame_normal(const impact_collision *collision);

#endif
