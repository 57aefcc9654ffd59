/* SPDX-License-Identifier: MIT
 *
 * Error-free sums and products (Knuth; Ogita, Rump and Oishi 2005), for the library's own use.
 * fma() is correctly rounded by the C standard, in hardware and in software alike: QUAT_FMA_CLONES only makes it fast.
 */
#ifndef QUAT_DD_H
#define QUAT_DD_H

#include <math.h>

/* Not clang: up to 17 it gives the clones names of their own and leaves the function itself undefined. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
#define QUAT_FMA_CLONES __attribute__((target_clones("fma", "default")))
#define QUAT_AVX2_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define QUAT_FMA_CLONES
#define QUAT_AVX2_CLONES
#endif

/* hi + lo, unevaluated, |lo| no more than half a unit in the last place of hi. */
typedef struct quat_dd {
    double hi, lo;
} quat_dd;

static inline quat_dd quat_two_sum(double a, double b)
{
    const double s = a + b, t = s - a;
    return (quat_dd){s, (a - (s - t)) + (b - t)};
}

static inline quat_dd quat_two_prod(double a, double b)
{
    const double p = a * b;
    return (quat_dd){p, fma(a, b, -p)};
}

/* s + a b in twice the precision. */
static inline quat_dd quat_dd_fma(quat_dd s, double a, double b)
{
    const quat_dd p = quat_two_prod(a, b), t = quat_two_sum(s.hi, p.hi);
    return (quat_dd){t.hi, s.lo + (t.lo + p.lo)};
}

/* a0 b0 + a1 b1 + a2 b2 + a3 b3 in twice the precision. */
static inline quat_dd quat_dd_dot4(const double a[4], const double b[4])
{
    quat_dd s = quat_two_prod(a[0], b[0]);
    for (int i = 1; i < 4; i++) s = quat_dd_fma(s, a[i], b[i]);
    return quat_two_sum(s.hi, s.lo);
}

/* The square root of s > 0. */
static inline quat_dd quat_dd_sqrt(quat_dd s)
{
    const double r = sqrt(s.hi);
    const double residual = fma(-r, r, s.hi) + s.lo;
    return quat_two_sum(r, residual / (2 * r));
}

#endif
