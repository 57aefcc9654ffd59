/* SPDX-License-Identifier: MIT
 *
 * spline: a rotation spline through keys, twice continuously differentiable: orientation, angular velocity and angular
 * acceleration have no jumps. Conventions in quat.h.
 *
 * Between keys i and i + 1 it is q_i exp(r(t)/2), r a cubic polynomial of rotation vectors (Park and Ravani 1997); the
 * rates at the keys are those that make the angular acceleration continuous, found by Newton's method on a
 * block-tridiagonal system.
 */
#ifndef QUAT_SPLINE_H
#define QUAT_SPLINE_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct quat_spline quat_spline;

typedef enum quat_spline_end {
    QUAT_SPLINE_NATURAL, /* no angular acceleration at either end */
    QUAT_SPLINE_CLAMPED, /* angular velocity given at both ends */
    QUAT_SPLINE_PERIODIC /* the last key is the first again; velocity and acceleration go round */
} quat_spline_end;

/* A spline through n >= 2 keys (n >= 3 periodic): unit q[i] at time t[i], strictly increasing. Keys are taken as
 * rotations: successive ones are joined the short way, and the curve on S^3 starts at q[0] as given. omega_first and
 * omega_last (rad/s, world axes) count for clamped ends only. All data is copied; *spline is the caller's to free.
 * QUAT_EARGUMENT: n, the end condition, times that do not increase, a periodic last key that is not the first (to 1e-9
 * rad). QUAT_EDOMAIN: a key that cannot be normalised; infinite or NaN times or velocities. QUAT_ENOMEM. QUAT_ERANGE:
 * times less than 1e-100 or more than 1e100 apart; a spline that whirls, 1e5 rad or more from one key to the next
 * (clamped too fast, or times too uneven). QUAT_NOT_CONVERGED: keys so far apart (near pi) that no smooth spline was
 * found. *spline = NULL unless QUAT_OK. */
QUAT_API quat_status quat_spline_new(size_t n, const double t[], const quat q[], quat_spline_end end, qvec3 omega_first,
                                     qvec3 omega_last, quat_spline **spline);
/* Frees the spline; NULL is allowed. */
QUAT_API void quat_spline_free(quat_spline *spline);

/* The orientation at time t, continuous on S^3. Before the first key and after the last it stays what it is there; a
 * periodic spline goes round instead, changing sign with every loop that needs it. NaN for a NaN or infinite t. */
QUAT_API quat quat_spline_at(const quat_spline *spline, double t);
/* The same with angular velocity (rad/s) and acceleration (rad/s^2), world axes; each may be NULL. At the ends they are
 * those of the spline, outside (not periodic) they are zero. */
QUAT_API quat quat_spline_state(const quat_spline *spline, double t, qvec3 *omega, qvec3 *acceleration);

/* ---- by arc length ---- */

/* The angle turned through (rad), integral of |omega|, from the first key to time t; between 0 and the whole, which is
 * what t = INFINITY gives. Adaptive Gauss-Kronrod, to about 1e-14 of it. */
QUAT_API double quat_spline_length(const quat_spline *spline, double t);
/* The time at which the angle turned through is `length`, limited to the spline's own range. With t = time_at(s), s at
 * constant rate, the motion has constant angular speed. NaN for NaN. */
QUAT_API double quat_spline_time_at(const quat_spline *spline, double length);

#ifdef __cplusplus
}
#endif

#endif
