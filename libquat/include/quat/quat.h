/* SPDX-License-Identifier: MIT
 *
 * quat: types and algebra.
 *
 * Conventions (docs/conventions.md): w first, q = (w, x, y, z) = w + xi + yj + zk; Hamilton product; right-handed,
 * active rotations from body to world, v_world = q v q*; p q applies q first, then p.
 */
#ifndef QUAT_QUAT_H
#define QUAT_QUAT_H

#include <math.h>
#include "export.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct quat {
    double w, x, y, z;
} quat;

typedef struct qvec3 {
    double x, y, z;
} qvec3;

/* Row-major: m[row][column]; a rotation matrix maps column vectors, v_world = m v_body. */
typedef struct qmat3 {
    double m[3][3];
} qmat3;

/* 0 is success; positive, success with a reason; negative, failure: the result is then a documented value. */
typedef enum quat_status {
    QUAT_OK = 0,
    QUAT_NOT_UNIQUE = 1, /* the answer is one of several; a documented one was chosen */
    QUAT_EDOMAIN = -1,   /* zero, infinite or NaN where a finite, non-zero value is needed */
    QUAT_EARGUMENT = -2, /* a count, a selector or a pointer out of its range */
    QUAT_ENOMEM = -3,
    QUAT_EABSENT = -4    /* the part was left out of this build */
} quat_status;

/* One short English sentence for a status; never NULL. */
QUAT_API const char *quat_status_string(quat_status status);

/* ---- vectors ---- */

static inline qvec3 qvec3_make(double x, double y, double z) { return (qvec3){x, y, z}; }
static inline qvec3 qvec3_add(qvec3 a, qvec3 b) { return (qvec3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline qvec3 qvec3_sub(qvec3 a, qvec3 b) { return (qvec3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline qvec3 qvec3_neg(qvec3 a) { return (qvec3){-a.x, -a.y, -a.z}; }
static inline qvec3 qvec3_scale(qvec3 a, double s) { return (qvec3){a.x * s, a.y * s, a.z * s}; }
/* a + s b */
static inline qvec3 qvec3_axpy(double s, qvec3 b, qvec3 a) { return (qvec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z}; }
static inline double qvec3_dot(qvec3 a, qvec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline qvec3 qvec3_cross(qvec3 a, qvec3 b)
{
    return (qvec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/* Length without overflow or underflow; inf for an infinite component, NaN for a NaN. */
QUAT_API double qvec3_norm(qvec3 a);

/* ---- quaternions ---- */

static inline quat quat_make(double w, double x, double y, double z) { return (quat){w, x, y, z}; }
static inline quat quat_identity(void) { return (quat){1, 0, 0, 0}; }
static inline quat quat_conj(quat q) { return (quat){q.w, -q.x, -q.y, -q.z}; }
static inline double quat_dot(quat p, quat q) { return p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z; }

/* Hamilton product p q: as rotations, q first, then p. */
static inline quat quat_mul(quat p, quat q)
{
    return (quat){p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z,
                  p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
                  p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
                  p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w};
}

/* q/|q| at every finite, non-zero scale. Zero, infinite and NaN give QUAT_EDOMAIN and *unit = 1. */
QUAT_API quat_status quat_normalize(quat q, quat *unit);

#ifdef __cplusplus
}
#endif

#endif
