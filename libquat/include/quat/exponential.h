/* SPDX-License-Identifier: MIT
 *
 * exponential: exp, log, powers and roots of quaternions, unit and not. Conventions in quat.h.
 *
 * With q = r (cos a + n sin a), r = |q|, n a unit vector, 0 <= a <= pi: log q = ln r + a n, and every other function
 * here follows from it. The scalar and the vector part of exp and log are each right to a few units in the last place,
 * also where they are tiny: near |v| = pi, near |q| = 1, for angles down to the smallest double. Past |v| = 1e7 it is
 * exp as a whole that is so.
 */
#ifndef QUAT_EXPONENTIAL_H
#define QUAT_EXPONENTIAL_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* exp(0, v) = cos|v| + v sin|v|/|v|, a unit quaternion: the rotation by 2|v| about v. exp(0, 0) = 1.
 * NaN in every component for an infinite or NaN v; |v| past 2^50 has lost its meaning as an angle. */
QUAT_API quat quat_exp_pure(qvec3 v);

/* The v with |v| <= pi and exp(0, v) = q for unit q; for other non-zero q, that of q/|q|.
 * q = -1 gives (pi, 0, 0); q = 0 gives 0. NaN in, NaN out. */
QUAT_API qvec3 quat_log_unit(quat q);

/* exp(q) = e^w (cos|v| + v sin|v|/|v|). QUAT_EDOMAIN for an infinite or NaN q, QUAT_ERANGE when e^w overflows;
 * *result = 1 then. */
QUAT_API quat_status quat_exp(quat q, quat *result);

/* ln|q| + n a, 0 <= a <= pi. Zero, infinite and NaN give QUAT_EDOMAIN and *result = 0; a negative real q gives
 * QUAT_NOT_UNIQUE (any unit n will do) and n = (1, 0, 0). */
QUAT_API quat_status quat_log(quat q, quat *result);

/* q^t = |q|^t (cos ta + n sin ta), t real. 0^t is 0 for t > 0 and 1 for t = 0. QUAT_EDOMAIN (*result = 1) for infinite
 * or NaN arguments and for 0^t, t < 0; QUAT_ERANGE (*result = 1) when |q|^t or ta overflows; QUAT_NOT_UNIQUE for
 * negative real q and t not an integer, with n = (1, 0, 0). */
QUAT_API quat_status quat_pow(quat q, double t, quat *result);

/* q^t for unit q and finite t, a unit quaternion: the rotation repeated t times, along q's own side of S^3. */
QUAT_API quat quat_pow_unit(quat q, double t);

/* p^q = exp(log(p) q), p's logarithm on the left. Errors of log, product and exp; 0^q gives QUAT_EDOMAIN. */
QUAT_API quat_status quat_pow_quat(quat p, quat q, quat *result);

/* The root with non-negative scalar part. sqrt(0) = 0; a negative real q gives QUAT_NOT_UNIQUE and the root
 * (0, sqrt|q|, 0, 0). QUAT_EDOMAIN and *root = 1 for infinite and NaN. */
QUAT_API quat_status quat_sqrt(quat q, quat *root);

#ifdef __cplusplus
}
#endif

#endif
