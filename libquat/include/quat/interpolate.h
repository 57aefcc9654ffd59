/* SPDX-License-Identifier: MIT
 *
 * interpolate: between two and four unit quaternions, and recorded curves. Splines through many keys: spline.h.
 * Conventions in quat.h.
 *
 * Each comes in two forms. The plain one interpolates *rotations*: it takes the short way, from p to q or -q. The one
 * called as_given interpolates *points of S^3*: from p to q even if -q is nearer. t runs from 0 (p) to 1 (q), both
 * exact; outside, the great circle goes on. Infinite and NaN come out as NaN, but for an end that is not asked for: the
 * result at t = 0 is p whatever q, at t = 1 q whatever p.
 */
#ifndef QUAT_INTERPOLATE_H
#define QUAT_INTERPOLATE_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- between two ---- */

/* (1 - t) p + t q, normalised: the great circle at a speed that varies, most for wide angles. When the sum vanishes
 * (as_given only: opposite p and q, t = 1/2) the result is p. */
QUAT_API quat quat_nlerp(quat p, quat q, double t);
QUAT_API quat quat_nlerp_as_given(quat p, quat q, double t);

/* The great circle at constant speed (Shoemake 1985), to 4 rounding units at every angle. For opposite p and q
 * (as_given only) every great circle is as short: the one through p i, i = (0, 1, 0, 0), is taken. When p and q are
 * perpendicular the plain form goes to q as given. */
QUAT_API quat quat_slerp(quat p, quat q, double t);
QUAT_API quat quat_slerp_as_given(quat p, quat q, double t);

/* The angular velocities, radians per unit of t, in world axes (body axes: quat_rotate_inverse by the interpolant).
 * That of slerp is constant: 2 log(q p*). */
QUAT_API qvec3 quat_slerp_omega(quat p, quat q);
QUAT_API qvec3 quat_slerp_as_given_omega(quat p, quat q);
QUAT_API qvec3 quat_nlerp_omega(quat p, quat q, double t);
QUAT_API qvec3 quat_nlerp_as_given_omega(quat p, quat q, double t);

/* ---- between four ---- */

/* Shoemake's (1987) quadrangle: slerp(slerp(p, q, t), slerp(a, b, t), 2t(1 - t)), all as given. With the control points
 * of quat_squad_control it joins segments of equal length in t with continuous angular velocity. */
QUAT_API quat quat_squad(quat p, quat a, quat b, quat q, double t);
/* The control point at key q between its neighbours: q exp(-(log(q* before) + log(q* after))/4). Keys first made
 * continuous by quat_unflip. At an end, give q itself for the neighbour that is not there. */
QUAT_API quat quat_squad_control(quat before, quat q, quat after);
/* The angular velocity of quat_squad, radians per unit of t, world axes; by the chain rule, not by differences. NaN
 * where the two inner great circles are at opposite points of S^3: squad jumps there. */
QUAT_API qvec3 quat_squad_omega(quat p, quat a, quat b, quat q, double t);

/* ---- recorded curves ---- */

/* Changes signs in place so that each of the n quaternions is on its predecessor's side of S^3; the first is kept.
 * Returns how many were changed. *monodromy (may be NULL) gets the sign with which a closed loop returns to its start:
 * +1, or -1 when q[n-1] has come out opposite to q[0] (an odd number of full turns). Neighbours at right angles are
 * left as they are. */
QUAT_API size_t quat_unflip(size_t n, quat q[], int *monodromy);

#ifdef __cplusplus
}
#endif

#endif
