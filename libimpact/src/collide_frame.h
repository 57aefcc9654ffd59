/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the contact frame and the inverse mass that the contact feels.
 */
#ifndef IMPACT_COLLIDE_FRAME_H
#define IMPACT_COLLIDE_FRAME_H

#include "collide_ready.h"

/* M = scale [[a, 0, c], [0, b, d], [c, d, 1]] in the principal tangential frame (t1, t2, n), right-handed.
 * k = scale-free Schur complement 1 - c^2/a - d^2/b, as the least of a sum of squares and not from that difference. */
typedef struct impact_frame {
    qvec3 t1, t2, n;
    double a, b, c, d, k;
    double scale;        /* M_zz, 1/kg */
    double conditioning; /* largest over smallest eigenvalue of M */
} impact_frame;

/* n: unit normal. */
void impact_frame_make(qvec3 n, const impact_ready ready[2], impact_frame *frame);

/* The collision's normal at unit length. */
qvec3 impact_frame_normal(const impact_collision *collision);

/* Of the contact points, body 1 less body 2, world. */
qvec3 impact_frame_velocity(const impact_collision *collision);

#endif
