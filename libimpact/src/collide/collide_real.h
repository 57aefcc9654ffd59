/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the number that the impact kernel is written in. Its sources are compiled twice: in double, and
 * (collide_second.c, which defines IMP_SECOND) in the compiler's 128-bit floating point, 113 bits, for what double
 * cannot settle. Thresholds in these sources are units of IMP_EPSILON. Of libm only sqrt is asked for, and of the
 * variation exp and log1p; where exp, log and cbrt serve estimates they stay double.
 */
#ifndef IMP_COLLIDE_REAL_H
#define IMP_COLLIDE_REAL_H

#include <float.h>
#include <math.h>
#include <quat/quat.h>

/* Its lanes' masks are integers of its size: 32-bit machines have none. */
#if (LDBL_MANT_DIG == 113 || defined(__SIZEOF_FLOAT128__)) && defined(__SIZEOF_INT128__)
#define IMP_HAS_SECOND 1
#else
#define IMP_HAS_SECOND 0
#endif

#if defined(IMP_SECOND) && IMP_HAS_SECOND

#if LDBL_MANT_DIG == 113
typedef long double imp_real;
#else
__extension__ typedef __float128 imp_real;
#endif
__extension__ typedef __int128 imp_word;
#define IMP_EPSILON ((imp_real)0x1p-112)
#define IMP_ROOT_EPSILON ((imp_real)0x1p-56)
#define IMP_SPLITTER ((imp_real)0x1p57 + 1) /* cuts a number in halves (Dekker) */

static inline imp_real imp_abs(imp_real x) { return x < 0 ? -x : x; }

/* Newton on 1/sqrt from double's, x brought near 1 by powers of two first: 113 bits after two steps. */
static inline imp_real imp_sqrt(imp_real x)
{
    imp_real f = 1;
    if (!(x > 0 && x - x == 0)) return x >= 0 ? x : (imp_real)NAN;
    for (int i = 0; i < 64 && x > 0x1p200; i++) x *= 0x1p-400, f *= 0x1p200;
    for (int i = 0; i < 64 && x < 0x1p-200; i++) x *= 0x1p400, f *= 0x1p-200;
    imp_real y = 1 / sqrt((double)x);
    for (int i = 0; i < 2; i++) y += y * (1 - x * y * y) / 2;
    const imp_real root = x * y;
    return f * (root + (x - root * root) * y / 2);
}

static inline imp_real imp_hypot(imp_real x, imp_real y) { return imp_sqrt(x * x + y * y); }
static inline imp_real imp_copysign(imp_real x, imp_real y) { return y < 0 ? -imp_abs(x) : imp_abs(x); }

/* Taylor near 0, then squared back: 2^24 roundings are lost at most, and 88 bits stay. */
static inline imp_real imp_exp(imp_real x)
{
    if (!(x > -11000)) return x <= -11000 ? 0 : x;
    if (x > 11000) return (imp_real)INFINITY;
    const imp_real w = x * 0x1p-24;
    imp_real sum = 0;
    for (int k = 12; k >= 1; k--) sum = w / k * (1 + sum);
    /* e^2w - 1 = (e^w - 1) (2 + (e^w - 1)) */
    for (int i = 0; i < 24; i++) sum = sum * (2 + sum);
    return 1 + sum;
}

/* Halley's step on exp from double's. */
static inline imp_real imp_log1p(imp_real x)
{
    if (imp_abs(x) < 0x1p-40) return x * (1 - x / 2 * (1 - 2 * x / 3));
    const imp_real y = log1p((double)x), e = imp_exp(y);
    return y + 2 * (1 + x - e) / (1 + x + e);
}

/* A vector of the world. */
typedef struct imp_vec {
    imp_real x, y, z;
} imp_vec;

static inline imp_vec imp_vec_of(qvec3 v) { return (imp_vec){v.x, v.y, v.z}; }
static inline qvec3 imp_vec_rounded(imp_vec v) { return (qvec3){(double)v.x, (double)v.y, (double)v.z}; }
static inline imp_real imp_vec_dot(imp_vec a, imp_vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline imp_vec imp_vec_scale(imp_vec a, imp_real f) { return (imp_vec){a.x * f, a.y * f, a.z * f}; }
static inline imp_vec imp_vec_neg(imp_vec a) { return (imp_vec){-a.x, -a.y, -a.z}; }
/* f a + b */
static inline imp_vec imp_vec_axpy(imp_real f, imp_vec a, imp_vec b)
{
    return (imp_vec){f * a.x + b.x, f * a.y + b.y, f * a.z + b.z};
}
static inline imp_vec imp_vec_cross(imp_vec a, imp_vec b)
{
    return (imp_vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

#else

typedef double imp_real;
typedef long long imp_word;
#define IMP_EPSILON DBL_EPSILON
#define IMP_ROOT_EPSILON 0x1p-27 /* a Newton step of this relative size is followed by one of eps at most */
#define IMP_SPLITTER 134217729.0

static inline imp_real imp_abs(imp_real x) { return fabs(x); }
static inline imp_real imp_sqrt(imp_real x) { return sqrt(x); }
static inline imp_real imp_hypot(imp_real x, imp_real y) { return hypot(x, y); }
static inline imp_real imp_copysign(imp_real x, imp_real y) { return copysign(x, y); }
static inline imp_real imp_exp(imp_real x) { return exp(x); }
static inline imp_real imp_log1p(imp_real x) { return log1p(x); }

typedef qvec3 imp_vec;
static inline imp_vec imp_vec_of(qvec3 v) { return v; }
static inline qvec3 imp_vec_rounded(imp_vec v) { return v; }
static inline imp_real imp_vec_dot(imp_vec a, imp_vec b) { return qvec3_dot(a, b); }
static inline imp_vec imp_vec_scale(imp_vec a, imp_real f) { return qvec3_scale(a, f); }
static inline imp_vec imp_vec_neg(imp_vec a) { return qvec3_neg(a); }
static inline imp_vec imp_vec_axpy(imp_real f, imp_vec a, imp_vec b) { return qvec3_axpy(f, a, b); }
static inline imp_vec imp_vec_cross(imp_vec a, imp_vec b) { return qvec3_cross(a, b); }

#endif

/* In line, where fmax and fmin are calls; a NaN is not minded. */
static inline imp_real imp_larger(imp_real a, imp_real b) { return a > b ? a : b; }
static inline imp_real imp_smaller(imp_real a, imp_real b) { return a < b ? a : b; }
static inline bool imp_is_finite(imp_real x) { return x - x == 0; }

#endif
