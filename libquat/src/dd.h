/* SPDX-License-Identifier: MIT
 *
 * Error-free sums and products (Knuth; Ogita, Rump and Oishi 2005), for the library's own use.
 * fma() is correctly rounded by the C standard, in hardware and in software alike: QUAT_FMA_CLONES only makes it fast.
 */
#ifndef QUAT_DD_H
#define QUAT_DD_H

#include <math.h>

/* Not clang: up to 17 it gives the clones names of their own and leaves the function itself undefined. Nor under gcc's
 * thread sanitizer, which is not there yet when the loader picks a clone. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) &&                           \
    !defined(__SANITIZE_THREAD__)
#define QUAT_HAS_CLONES
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

/* The sum of n <= 16 terms as if in three times the precision (Ogita, Rump and Oishi 2005, SumK with K = 3). */
static inline quat_dd quat_sum3(int n, const double *terms)
{
    double sum = terms[0], errors = 0, rest = 0;
    for (int i = 1; i < n; i++) {
        const quat_dd t = quat_two_sum(sum, terms[i]), e = quat_two_sum(errors, t.lo);
        sum = t.hi;
        errors = e.hi;
        rest += e.lo;
    }
    const quat_dd total = quat_two_sum(sum, errors);
    return quat_two_sum(total.hi, total.lo + rest);
}

/* base + a0 b0 + a1 b1 + a2 b2 + a3 b3 in three times the precision. */
static inline quat_dd quat_dot4_plus(double base, const double a[4], const double b[4])
{
    double terms[9] = {base};
    for (int i = 0; i < 4; i++) {
        const quat_dd p = quat_two_prod(a[i], b[i]);
        terms[1 + i] = p.hi;
        terms[5 + i] = p.lo;
    }
    return quat_sum3(9, terms);
}

#endif
