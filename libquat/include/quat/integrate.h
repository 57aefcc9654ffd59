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
    QUAT_CF4      /* two exponentials, no cross product (Blanes and Moan 2006; Celledoni, Marthinsen, Owren 2003) */
} quat_method;

/* One step of h seconds from unit q, given omega at the two Gauss points t + (1/2 -+ sqrt(3)/6) h: order 4, exact for a
 * constant omega; both err by O(h^5). */
QUAT_API quat quat_step_magnus4(quat q, qvec3 omega1, qvec3 omega2, double h, quat_frame frame);
QUAT_API quat quat_step_cf4(quat q, qvec3 omega1, qvec3 omega2, double h, quat_frame frame);

/* q at t1 from q at t0, in n equal steps (t1 < t0 goes back). Global error O(h^4). The result is unit to a few rounding
 * units for any n. QUAT_EARGUMENT for n = 0 or an unknown method or frame; QUAT_EDOMAIN for a q that cannot be
 * normalised, infinite or NaN times, and when omega returns infinite or NaN; QUAT_ERANGE when a step's angle overflows:
 * *result is then q as last reached. */
QUAT_API quat_status quat_integrate(quat_omega omega, void *context, quat_frame frame, quat_method method, double t0,
                                    double t1, size_t n, quat q, quat *result);

#ifdef __cplusplus
}
#endif

#endif
