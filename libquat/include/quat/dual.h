/* SPDX-License-Identifier: MIT
 *
 * dual: rigid motions as unit dual quaternions r + e d, e^2 = 0: the point x goes to R(r) x + s, with d = (0, s) r / 2.
 * p q applies q first, then p. Conventions in quat.h; lengths in the caller's unit.
 */
#ifndef QUAT_DUAL_H
#define QUAT_DUAL_H

#include "rotation.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct qdual {
    quat real, dual;
} qdual;

/* A motion's logarithm: turning by `rotation` (rotation vector, rad) while moving at the rate `translation` of the
 * body's point that is at the origin at the start; both over one unit of time, at constant rate. */
typedef struct qtwist {
    qvec3 rotation, translation;
} qtwist;

QUAT_INLINE qdual quat_dual_make(quat real, quat dual)
{
    const qdual r = {real, dual};
    return r;
}
QUAT_INLINE qdual quat_dual_identity(void) { return quat_dual_make(quat_identity(), quat_make(0, 0, 0, 0)); }

/* The motion x -> R(q) x + shift, q unit. */
QUAT_INLINE qdual quat_dual_from(quat q, qvec3 shift)
{
    return quat_dual_make(q, quat_scale(quat_mul(quat_pure(shift), q), 0.5));
}
/* The shift of a unit p: the vector part of 2 d r*. Its rotation is p.real. */
QUAT_INLINE qvec3 quat_dual_shift(qdual p) { return quat_vector(quat_scale(quat_mul(p.dual, quat_conj(p.real)), 2)); }

QUAT_INLINE qdual quat_dual_add(qdual p, qdual q)
{
    return quat_dual_make(quat_add(p.real, q.real), quat_add(p.dual, q.dual));
}
QUAT_INLINE qdual quat_dual_scale(qdual p, double s)
{
    return quat_dual_make(quat_scale(p.real, s), quat_scale(p.dual, s));
}
QUAT_INLINE qdual quat_dual_mul(qdual p, qdual q)
{
    return quat_dual_make(quat_mul(p.real, q.real), quat_add(quat_mul(p.real, q.dual), quat_mul(p.dual, q.real)));
}
/* Both parts conjugated: the inverse motion of a unit p. */
QUAT_INLINE qdual quat_dual_conj(qdual p) { return quat_dual_make(quat_conj(p.real), quat_conj(p.dual)); }
/* The inverse of any p with non-zero real part: 1/r - e (1/r) d (1/r). Errors as quat_inverse's; *inverse = 1 then. */
QUAT_API quat_status quat_dual_inverse(qdual p, qdual *inverse);

/* The motion of unit p applied to a point, and its inverse. */
QUAT_INLINE qvec3 quat_dual_apply(qdual p, qvec3 x) { return qvec3_add(quat_rotate(p.real, x), quat_dual_shift(p)); }
QUAT_INLINE qvec3 quat_dual_apply_inverse(qdual p, qvec3 x)
{
    return quat_rotate_inverse(p.real, qvec3_sub(x, quat_dual_shift(p)));
}

/* The unit dual quaternion nearest in direction: real part of length 1, dual part perpendicular to it. QUAT_EDOMAIN and
 * *unit = 1 when the real part cannot be normalised or the dual part is infinite or NaN, QUAT_ERANGE and *unit = 1 when
 * the dual part overflows. */
QUAT_API quat_status quat_dual_normalize(qdual p, qdual *unit);

/* exp and log between twists and unit dual quaternions; the log takes the short way (rotation of at most pi; p and -p
 * are the same motion). shift = J_left(rotation) translation (jacobian.h). Right at vanishing rotation too. */
QUAT_API qdual quat_dual_exp(qtwist twist);
QUAT_API qtwist quat_dual_log(qdual p);

/* Screw interpolation p exp(t log(p* q)) (Kavan, Collins, Zara, O'Sullivan 2008), the short way: turns at constant rate
 * about, and slides along, one axis. t = 0 gives p and t = 1 gives q (or -q) exactly. */
QUAT_API qdual quat_dual_sclerp(qdual p, qdual q, double t);

/* Chasles: every motion turns by `angle` (0 ... pi) about the line through `point` (its nearest to the origin) along
 * the unit `axis`, and slides by `slide` along it. A pure shift gives angle 0, the axis along it and QUAT_NOT_UNIQUE
 * (any point will do; the origin is given); the identity gives axis z and slide 0 as well. QUAT_EDOMAIN, with the
 * identity's values, when p cannot be normalised, QUAT_ERANGE when the slide overflows. */
QUAT_API quat_status quat_dual_to_screw(qdual p, qvec3 *axis, qvec3 *point, double *angle, double *slide);
/* The reverse. QUAT_EDOMAIN and *p = 1 for an axis that cannot be normalised and for infinite and NaN, QUAT_ERANGE and
 * *p = 1 when the motion overflows. */
QUAT_API quat_status quat_dual_from_screw(qvec3 axis, qvec3 point, double angle, double slide, qdual *p);

/* Weighted blend of n motions (dual quaternion linear blending): the normalised sum, every p[i] with the sign that is
 * nearest to p[0]. QUAT_EARGUMENT for n = 0; QUAT_EDOMAIN and *blend = 1 when the sum cannot be normalised. */
QUAT_API quat_status quat_dual_blend(size_t n, const qdual p[], const double weights[], qdual *blend);

#ifdef __cplusplus
}
#endif

#endif
