/* SPDX-License-Identifier: MIT
 *
 * quat: types and algebra.
 *
 * Conventions (docs/conventions.md): w first, q = (w, x, y, z) = w + xi + yj + zk; Hamilton product; right-handed,
 * active rotations from body to world, v_world = q v q*; p q applies q first, then p; radians.
 *
 * Two kinds of function. Those that return a value follow IEEE arithmetic: they never fail, a NaN in an argument comes
 * out as NaN, and "unit" in their comment is a precondition, kept to a few rounding errors. Those that return a
 * quat_status check their arguments and always set their result, to the documented value if they fail.
 */
#ifndef QUAT_QUAT_H
#define QUAT_QUAT_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
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

typedef struct qvec2 {
    double x, y;
} qvec2;

/* Row-major: m[row][column]; a rotation matrix maps column vectors, v_world = m v_body. */
typedef struct qmat3 {
    double m[3][3];
} qmat3;

/* 0 is success; positive, success with a reason; negative, failure: the result is then a documented value. */
typedef enum quat_status {
    QUAT_OK = 0,
    QUAT_NOT_UNIQUE = 17,    /* the answer is one of several; a documented one was chosen */
    QUAT_NOT_CONVERGED = 18, /* the last iterate is returned */
    QUAT_AT_INFINITY = 19,   /* the image is the point at infinity, or farther than the largest double */
    QUAT_EARGUMENT = -1,     /* a count, a selector or a pointer out of its range */
    QUAT_EDOMAIN = -2,       /* zero, infinite or NaN where a finite, non-zero value is needed */
    QUAT_ENOMEM = -3,
    QUAT_EABSENT = -4, /* the part was left out of this build */
    QUAT_ERANGE = -5   /* the result or a number on the way to it is too large or too small for a double */
} quat_status;

/* The version of these headers, for the preprocessor. */
#define QUAT_VERSION_MAJOR 0
#define QUAT_VERSION_MINOR 2
#define QUAT_VERSION_PATCH 0

/* "MAJOR.MINOR.PATCH" of the library as built. */
QUAT_API const char *quat_version(void);

/* One short English sentence for a status; never NULL. */
QUAT_API const char *quat_status_string(quat_status status);

/* ---- vectors ---- */

QUAT_INLINE qvec3 qvec3_make(double x, double y, double z)
{
    const qvec3 r = {x, y, z};
    return r;
}
QUAT_INLINE qvec3 qvec3_add(qvec3 a, qvec3 b) { return qvec3_make(a.x + b.x, a.y + b.y, a.z + b.z); }
QUAT_INLINE qvec3 qvec3_sub(qvec3 a, qvec3 b) { return qvec3_make(a.x - b.x, a.y - b.y, a.z - b.z); }
QUAT_INLINE qvec3 qvec3_neg(qvec3 a) { return qvec3_make(-a.x, -a.y, -a.z); }
QUAT_INLINE qvec3 qvec3_scale(qvec3 a, double s) { return qvec3_make(a.x * s, a.y * s, a.z * s); }
QUAT_INLINE qvec2 qvec2_make(double x, double y)
{
    const qvec2 r = {x, y};
    return r;
}
/* a + s b */
QUAT_INLINE qvec3 qvec3_axpy(double s, qvec3 b, qvec3 a)
{
    return qvec3_make(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
QUAT_INLINE double qvec3_dot(qvec3 a, qvec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
QUAT_INLINE qvec3 qvec3_cross(qvec3 a, qvec3 b)
{
    return qvec3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
/* True when no component is infinite or NaN. */
QUAT_INLINE bool qvec3_isfinite(qvec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }
/* ---- matrices ---- */

QUAT_INLINE qmat3 qmat3_identity(void)
{
    const qmat3 r = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return r;
}
/* m v */
QUAT_INLINE qvec3 qmat3_apply(const qmat3 *m, qvec3 v)
{
    return qvec3_make(m->m[0][0] * v.x + m->m[0][1] * v.y + m->m[0][2] * v.z,
                      m->m[1][0] * v.x + m->m[1][1] * v.y + m->m[1][2] * v.z,
                      m->m[2][0] * v.x + m->m[2][1] * v.y + m->m[2][2] * v.z);
}
/* The matrix product a b. */
QUAT_INLINE qmat3 qmat3_mul(const qmat3 *a, const qmat3 *b)
{
    qmat3 r = *a;
    int i, j;
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++) r.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
    return r;
}
QUAT_INLINE qmat3 qmat3_transpose(const qmat3 *a)
{
    const qmat3 r = {{{a->m[0][0], a->m[1][0], a->m[2][0]},
                      {a->m[0][1], a->m[1][1], a->m[2][1]},
                      {a->m[0][2], a->m[1][2], a->m[2][2]}}};
    return r;
}
QUAT_INLINE double qmat3_det(const qmat3 *a)
{
    return qvec3_dot(
        qvec3_make(a->m[0][0], a->m[0][1], a->m[0][2]),
        qvec3_cross(qvec3_make(a->m[1][0], a->m[1][1], a->m[1][2]), qvec3_make(a->m[2][0], a->m[2][1], a->m[2][2])));
}

/* ---- building and taking apart ---- */

QUAT_INLINE quat quat_make(double w, double x, double y, double z)
{
    const quat r = {w, x, y, z};
    return r;
}
QUAT_INLINE quat quat_identity(void) { return quat_make(1, 0, 0, 0); }
/* w + v */
QUAT_INLINE quat quat_from_parts(double w, qvec3 v) { return quat_make(w, v.x, v.y, v.z); }
/* The pure quaternion (0, v). */
QUAT_INLINE quat quat_pure(qvec3 v) { return quat_make(0, v.x, v.y, v.z); }
/* The vector part (x, y, z). */
QUAT_INLINE qvec3 quat_vector(quat q) { return qvec3_make(q.x, q.y, q.z); }

/* ---- algebra ---- */

QUAT_INLINE quat quat_add(quat p, quat q) { return quat_make(p.w + q.w, p.x + q.x, p.y + q.y, p.z + q.z); }
QUAT_INLINE quat quat_sub(quat p, quat q) { return quat_make(p.w - q.w, p.x - q.x, p.y - q.y, p.z - q.z); }
QUAT_INLINE quat quat_neg(quat q) { return quat_make(-q.w, -q.x, -q.y, -q.z); }
QUAT_INLINE quat quat_scale(quat q, double s) { return quat_make(q.w * s, q.x * s, q.y * s, q.z * s); }
/* p + s q */
QUAT_INLINE quat quat_axpy(double s, quat q, quat p)
{
    return quat_make(p.w + s * q.w, p.x + s * q.x, p.y + s * q.y, p.z + s * q.z);
}
QUAT_INLINE quat quat_conj(quat q) { return quat_make(q.w, -q.x, -q.y, -q.z); }
QUAT_INLINE double quat_dot(quat p, quat q) { return (p.w * q.w + p.x * q.x) + (p.y * q.y + p.z * q.z); }

#ifdef __GNUC__
/* Two neighbouring components, worked on at once where there are registers for it (SSE2, NEON). */
typedef double quat_pair __attribute__((vector_size(16)));

/* Hamilton product p q: as rotations, q first, then p. Each component is the sum of two pairs: shorter chains and
 * smaller errors than four terms in a row. */
QUAT_INLINE quat quat_mul(quat p, quat q)
{
    const quat_pair wx = {p.w, p.x}, yz = {p.y, p.z}, xw = {p.x, p.w}, zy = {p.z, p.y};
    const quat_pair w = {q.w, q.w}, x = {-q.x, q.x}, y = {q.y, q.y}, z = {-q.z, q.z};
    const quat_pair r = (wx * w + xw * x) + (zy * z - yz * y), s = (wx * y + xw * z) + (yz * w - zy * x);
    return quat_make(r[0], r[1], s[0], s[1]);
}
#else
/* The same to the bit, one component after the other. */
QUAT_INLINE quat quat_mul(quat p, quat q)
{
    return quat_make(
        (p.w * q.w - p.x * q.x) + (-(p.z * q.z) - p.y * q.y), (p.x * q.w + p.w * q.x) + (p.y * q.z - p.z * q.y),
        (p.w * q.y - p.x * q.z) + (p.y * q.w + p.z * q.x), (p.x * q.y + p.w * q.z) + (p.z * q.w - p.y * q.x));
}
#endif

/* p q with every component as if summed in three times the precision and rounded once (Ogita, Rump and Oishi 2005,
 * algorithm DotK with K = 3, by FMA): for differences such as the vector part of p (1/p), all of which is rounding. The
 * same bits on every machine, since fma() is correctly rounded with and without the instruction. Products that leave
 * 1e-290 ... 1e290 may lose the compensation. */
QUAT_API quat quat_mul_compensated(quat p, quat q);

/* |q|^2; overflows and underflows as the sum does. */
QUAT_INLINE double quat_norm2(quat q) { return quat_dot(q, q); }
/* |q| where its square may overflow or underflow; quat_norm asks for it there. */
QUAT_API double quat_norm_far(quat q);
/* |q| without overflow or underflow; inf for an infinite component, else NaN for a NaN. */
QUAT_INLINE double quat_norm(quat q)
{
    const double n2 = quat_norm2(q);
    return n2 >= 1e-280 && n2 <= 1e280 ? sqrt(n2) : quat_norm_far(q);
}
/* True when no component is infinite or NaN. */
QUAT_INLINE bool quat_isfinite(quat q) { return isfinite(q.w) && isfinite(q.x) && isfinite(q.y) && isfinite(q.z); }

/* q/|q| at every finite, non-zero scale, every component to one rounding unit of the whole. Zero, infinite and NaN give
 * QUAT_EDOMAIN and *unit = 1. */
QUAT_API quat_status quat_normalize(quat q, quat *unit);

/* Length without overflow or underflow; inf for an infinite component, else NaN for a NaN. */
QUAT_INLINE double qvec3_norm(qvec3 a) { return quat_norm(quat_make(0, a.x, a.y, a.z)); }
/* a/|a| at every finite, non-zero scale. Zero, infinite and NaN give QUAT_EDOMAIN and *unit = (0, 0, 1). */
QUAT_INLINE quat_status qvec3_normalize(qvec3 a, qvec3 *unit)
{
    quat q;
    const quat_status status = quat_normalize(quat_make(0, a.x, a.y, a.z), &q);
    *unit = status == QUAT_OK ? qvec3_make(q.x, q.y, q.z) : qvec3_make(0, 0, 1);
    return status;
}

/* q times 1/|q|, inline and unchecked: to 3.5 rounding units for |q| between 1e-140 and 1e140, anything outside. */
QUAT_INLINE quat quat_unit(quat q) { return quat_scale(q, 1 / sqrt(quat_norm2(q))); }

/* q (3 - |q|^2)/2: one Newton step towards |q| = 1, for the drift of long products; error 3/2 (|q| - 1)^2. */
QUAT_INLINE quat quat_renormalize(quat q) { return quat_axpy(0.5 - 0.5 * quat_norm2(q), q, q); }

/* 1/q = q* / |q|^2. Zero, infinite and NaN give QUAT_EDOMAIN, |q| < 1/DBL_MAX gives QUAT_ERANGE; *inverse = 1 then. */
QUAT_API quat_status quat_inverse(quat q, quat *inverse);
/* p (1/q). Errors as quat_inverse's, and QUAT_EDOMAIN when p is infinite or NaN. */
QUAT_API quat_status quat_div(quat p, quat q, quat *quotient);
/* (1/q) p. Errors as quat_div's. */
QUAT_API quat_status quat_div_left(quat q, quat p, quat *quotient);

/* ---- distances and comparisons ---- */

/* Angle between unit p and q as points of S^3, 0 ... pi: 2 atan2(|p - q|, |p + q|) (Kahan). Blind to no sign. */
QUAT_API double quat_distance(quat p, quat q);
/* Angle of the rotation that carries unit p to unit q, 0 ... pi; q and -q are the same rotation. */
QUAT_API double quat_rotation_distance(quat p, quat q);
/* Rotation angle of q, of any non-zero length, 0 ... pi: 2 atan2(|v|, |w|). 0 for q = 0. */
QUAT_API double quat_angle(quat q);
/* True when all components are equal (0 = -0; NaN equals nothing). */
QUAT_INLINE bool quat_equal(quat p, quat q) { return p.w == q.w && p.x == q.x && p.y == q.y && p.z == q.z; }
/* |p - q| <= tolerance: near as points of R^4. */
QUAT_API bool quat_near(quat p, quat q, double tolerance);
/* Unit p and q turn space alike to within `angle` radians, whatever their signs. */
QUAT_API bool quat_same_rotation(quat p, quat q, double angle);
/* The one of q and -q on the same side of S^3 as `reference`; q when they are perpendicular. */
QUAT_INLINE quat quat_nearest(quat q, quat reference) { return quat_dot(q, reference) < 0 ? quat_neg(q) : q; }

/* ---- random ---- */

/* A generator of the caller's: uniform in [0, 1), with its state. */
typedef double (*quat_uniform)(void *state);
/* A unit quaternion, uniform on S^3, from three numbers of the generator (Shoemake 1992). */
QUAT_API quat quat_random(quat_uniform uniform, void *state);

#ifdef __cplusplus
}
#endif

#endif
