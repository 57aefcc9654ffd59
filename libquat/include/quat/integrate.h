/* SPDX-License-Identifier: MIT
 *
 * integrate: the orientation that follows from an angular velocity given as a function of time, by steps on the group:
 * products of exponentials, so that |q| = 1 is kept by construction. Conventions in quat.h.
 */
#ifndef QUAT_INTEGRATE_H
#define QUAT_INTEGRATE_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The angular velocity (rad/s) at time t (s). */
typedef qvec3 (*quat_omega)(double t, void *context);

/* In which axes the angular velocity is given. */
typedef enum quat_frame { QUAT_WORLD, QUAT_BODY } quat_frame;

typedef enum quat_method {
    QUAT_MAGNUS4, /* one exponential of (h/2)(w1 + w2) -+ (sqrt 3/12) h^2 w1 x w2 (Blanes, Casas, Oteo, Ros 2009) */
    QUAT_CF4,     /* two exponentials, no cross product (Blanes and Moan 2006; Celledoni, Marthinsen, Owren 2003) */
    QUAT_MAGNUS8  /* one exponential, six cross products of four omegas (Blanes, Casas, Ros 2000): of order 8 */
} quat_method;

/* One step of h seconds from unit q, given omega at the two Gauss points t + (1/2 -+ sqrt(3)/6) h: order 4, exact for a
 * constant omega; both err by O(h^5). */
QUAT_API quat quat_step_magnus4(quat q, qvec3 omega1, qvec3 omega2, double h, quat_frame frame);
QUAT_API quat quat_step_cf4(quat q, qvec3 omega1, qvec3 omega2, double h, quat_frame frame);

/* The same of order 8, given omega at the four Gauss points t + (1/2 -+ .4305682) h and t + (1/2 -+ .1699905) h in
 * the order of time; errs by O(h^9). Blanes, Casas and Ros, "Improved high order integrators based on the Magnus
 * expansion", BIT 40 (2000). */
QUAT_API quat quat_step_magnus8(quat q, const qvec3 omega[4], double h, quat_frame frame);

/* At which parts of a step a method asks for omega: their number, 2 or 4, in the order of time; 0 for an unknown
 * method. And a step by the method, given omega there. */
QUAT_API int quat_method_parts(quat_method method, double part[4]);
QUAT_API quat quat_step_by(quat_method method, quat q, const qvec3 omega[], double h, quat_frame frame);

/* q at t1 from q at t0, in n equal steps (t1 < t0 goes back). Global error O(h^4), by QUAT_MAGNUS8 O(h^8). The result
 * is unit to a few rounding units for any n. QUAT_EARGUMENT for n = 0 or an unknown method or frame; QUAT_EDOMAIN for a
 * q that cannot be normalised, infinite or NaN times, and when omega returns infinite or NaN; QUAT_ERANGE when a step's
 * angle overflows: *result is then q as last reached. */
QUAT_API quat_status quat_integrate(quat_omega omega, void *context, quat_frame frame, quat_method method, double t0,
                                    double t1, size_t n, quat q, quat *result);

#ifdef __cplusplus
}
#endif

#endif
