/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the contact frame and the inverse mass that the contact feels.
 */
#ifndef IMPACT_COLLIDE_FRAME_H
#define IMPACT_COLLIDE_FRAME_H

#include <impact/collide.h>

/* One body made ready: inverses and unit orientation; a static body has inverse_mass 0. */
typedef struct impact_ready {
    double inverse_mass;
    qvec3 inverse_moments, root; /* 1 / J and its square root */
    quat orientation;
    bool round; /* three equal moments (or static): the orientation does not matter */
} impact_ready;

/* M = scale [[a, 0, c], [0, b, d], [c, d, 1]] in the principal tangential frame (t1, t2, n), right-handed.
 * k = scale-free Schur complement 1 - c^2/a - d^2/b, from QR of the stacked [I sqrt(w); L_i^-1 [r_i]] and not from that difference. */
typedef struct impact_frame {
    qvec3 t1, t2, n;
    double a, b, c, d, k;
    double scale;        /* M_zz, 1/kg */
    double conditioning; /* largest over smallest eigenvalue of M */
} impact_frame;

void impact_frame_ready(const impact_collider *body, impact_ready *ready);
void impact_frame_make(const impact_collision *collision, const impact_ready ready[2], impact_frame *frame);

/* Of the contact points, body 1 less body 2, world. */
qvec3 impact_frame_velocity(const impact_collision *collision);

/* World vector to principal axes and back. */
qvec3 impact_frame_to_body(quat q, qvec3 v);
qvec3 impact_frame_to_world(quat q, qvec3 v);

#endif
