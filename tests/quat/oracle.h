/* SPDX-License-Identifier: MIT
 *
 * The oracle of libquat's tests: the plain textbook formulas in IEEE quadruple precision (113 bits, exponents to
 * +-4932), so far beyond double that neither cancellation nor scale needs care. It shares no code with the library.
 */
#ifndef QUAT_TEST_ORACLE_H
#define QUAT_TEST_ORACLE_H

#define __STDC_WANT_IEC_60559_TYPES_EXT__ 1
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>
#include <quat/quat.h>
#include "kit/figures.h"

#ifdef __clang__
/* clang calls the type by another name, and glibc's header then hides its functions, though they are there. */
__extension__ typedef __float128 wide;
wide fabsf128(wide), sqrtf128(wide), sinf128(wide), cosf128(wide), expf128(wide), logf128(wide), log1pf128(wide);
wide fmaxf128(wide, wide), atan2f128(wide, wide);
#else
__extension__ typedef _Float128 wide;
#endif

typedef struct wquat {
    wide w, x, y, z;
} wquat;

/* One rounding unit of double. */
#define ROUNDING 0x1p-53

static inline wquat wide_quat(quat q) { return (wquat){q.w, q.x, q.y, q.z}; }
static inline wquat wide_vec(qvec3 v) { return (wquat){0, v.x, v.y, v.z}; }
static inline wquat wide_add(wquat p, wquat q) { return (wquat){p.w + q.w, p.x + q.x, p.y + q.y, p.z + q.z}; }
static inline wquat wide_sub(wquat p, wquat q) { return (wquat){p.w - q.w, p.x - q.x, p.y - q.y, p.z - q.z}; }
static inline wquat wide_scale(wquat q, wide s) { return (wquat){q.w * s, q.x * s, q.y * s, q.z * s}; }
static inline wquat wide_conj(wquat q) { return (wquat){q.w, -q.x, -q.y, -q.z}; }
static inline wide wide_dot(wquat p, wquat q) { return p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z; }
static inline wquat wide_cross(wquat p, wquat q) /* of the vector parts */
{
    return (wquat){0, p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
static inline wide wide_norm(wquat q) { return sqrtf128(wide_dot(q, q)); }
static inline wquat wide_unit(wquat q) { return wide_scale(q, 1 / wide_norm(q)); }
static inline wquat wide_mul(wquat p, wquat q)
{
    return (wquat){p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
                   p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x, p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w};
}
static inline wide wide_vnorm(wquat q) { return sqrtf128(q.x * q.x + q.y * q.y + q.z * q.z); }
static inline wquat wide_inverse(wquat q) { return wide_scale(wide_conj(q), 1 / wide_dot(q, q)); }
static inline wquat wide_rotate(wquat q, wquat v) { return wide_mul(wide_mul(q, v), wide_conj(q)); }
/* The sum of n terms as if in twice the 113 bits (Knuth). */
static inline wide wide_sum(int n, const wide *terms)
{
    wide sum = 0, lost = 0;
    for (int i = 0; i < n; i++) {
        const wide s = sum + terms[i], t = s - sum;
        lost += (sum - (s - t)) + (terms[i] - t);
        sum = s;
    }
    return sum + lost;
}
/* |q|^2 - 1: the squares of doubles are exact in 113 bits. */
static inline wide wide_norm2_minus_one(wquat q)
{
    const wide terms[5] = {-1, q.w * q.w, q.x * q.x, q.y * q.y, q.z * q.z};
    return wide_sum(5, terms);
}
/* |v| - k pi/2 = (|v|^2 - (k pi/2)^2)/(|v| + k pi/2) for |v| close to it, where even 113 bits of |v| are too few. */
static inline wide wide_beyond(wquat q, int k)
{
    const wide half_pi = (wide)0x1.921fb54442d18p+0 + (wide)0x1.1a62633145c07p-54;
    static const double half_pi_squared[4] = {0x1.3bd3cc9be45dep+1, 0x1.692b71366cc04p-53, 0x1.8358e10acd480p-107,
                                              -0x1.f2f5dd7997ddfp-162};
    wide terms[7] = {q.x * q.x, q.y * q.y, q.z * q.z};
    for (int i = 0; i < 4; i++) terms[3 + i] = -(wide)(k * k) * half_pi_squared[i];
    return wide_sum(7, terms) / (wide_vnorm(q) + k * half_pi);
}
static inline wquat wide_exp(wquat q)
{
    const wide n = wide_vnorm(q), e = expf128(q.w), half_pi = (wide)0x1.921fb54442d18p+0 + (wide)0x1.1a62633145c07p-54;
    wide c = cosf128(n), s = sinf128(n);
    if (fabsf128(n - half_pi) < 1e-9) {
        const wide d = wide_beyond(q, 1);
        c = -sinf128(d);
        s = cosf128(d);
    } else if (fabsf128(n - 2 * half_pi) < 1e-9) {
        const wide d = wide_beyond(q, 2);
        c = -cosf128(d);
        s = -sinf128(d);
    }
    s = n == 0 ? e : e * s / n;
    return (wquat){e * c, s * q.x, s * q.y, s * q.z};
}
static inline wquat wide_log(wquat q)
{
    const wide n = wide_vnorm(q), s = n == 0 ? 0 : atan2f128(n, q.w) / n;
    const wide size = wide_norm(q);
    /* near |q| = 1 even 113 bits of |q| are too few */
    const wide l = size > 0.9 && size < 1.1 ? log1pf128(wide_norm2_minus_one(q)) / 2 : logf128(size);
    return (wquat){l, s * q.x, s * q.y, s * q.z};
}
static inline wquat wide_pow(wquat q, wide t) { return wide_exp(wide_scale(wide_log(q), t)); }
/* Along the great circle through p and q as they are given, both made exactly unit. */
static inline wquat wide_slerp(wquat p, wquat q, wide t)
{
    p = wide_unit(p);
    q = wide_unit(q);
    const wide a = 2 * atan2f128(wide_norm(wide_sub(p, q)), wide_norm(wide_add(p, q)));
    if (a == 0) return p;
    return wide_add(wide_scale(p, sinf128((1 - t) * a) / sinf128(a)), wide_scale(q, sinf128(t * a) / sinf128(a)));
}

/* ---- errors in rounding units: the largest error of a component, relative to the length of the whole ---- */

static inline double wide_error(wquat got, wquat want)
{
    const wquat e = wide_sub(got, want);
    const wide size = wide_norm(want),
               off = fmaxf128(fmaxf128(fabsf128(e.w), fabsf128(e.x)), fmaxf128(fabsf128(e.y), fabsf128(e.z)));
    if (off == 0) return 0;
    return (double)(off / size / ROUNDING);
}
static inline double error_of(quat got, wquat want) { return wide_error(wide_quat(got), want); }
static inline double error_of_vector(qvec3 got, wquat want) { return wide_error(wide_vec(got), want); }
static inline double error_of_scalar(double got, wide want)
{
    return want == got ? 0 : (double)(fabsf128((wide)got - want) / fabsf128(want) / ROUNDING);
}
/* The scalar and the vector part each on its own: the larger of the two. */
static inline double error_of_parts(quat got, wquat want)
{
    const double w = error_of_scalar(got.w, want.w);
    want.w = 0;
    const double v = error_of_vector(qvec3_make(got.x, got.y, got.z), want);
    return w > v ? w : v;
}

/* ---- random input ---- */

typedef struct random_state {
    uint64_t s;
} random_state;

/* splitmix64 (Steele, Lea, Flood 2014); 53 bits in [0, 1). */
static inline double random_uniform(void *state)
{
    random_state *r = state;
    uint64_t z = r->s += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}
static inline double random_between(random_state *r, double low, double high)
{
    return low + (high - low) * random_uniform(r);
}
/* 10^random: every scale alike. */
static inline double random_scale(random_state *r, double low, double high)
{
    return pow(10, random_between(r, low, high));
}
static inline quat random_unit(random_state *r) { return quat_random(random_uniform, r); }
static inline qvec3 random_direction(random_state *r)
{
    for (;;) {
        const double x = random_between(r, -1, 1), y = random_between(r, -1, 1), z = random_between(r, -1, 1);
        const qvec3 v = {x, y, z};
        const double n2 = v.x * v.x + v.y * v.y + v.z * v.z, n = sqrt(n2);
        if (n2 < 1 && n2 > 0.01) return (qvec3){v.x / n, v.y / n, v.z / n};
    }
}
/* Of the length or norm given, which may be random too: an argument is drawn before the call. */
static inline qvec3 random_vector(random_state *r, double length) { return qvec3_scale(random_direction(r), length); }
static inline quat random_quat(random_state *r, double norm) { return quat_scale(random_unit(r), norm); }
/* Components between -1 and 1 and, one time in four, of wildly different sizes or zero. */
static inline quat random_any(random_state *r)
{
    double c[4];
    const int nasty = random_uniform(r) < 0.25;
    for (int i = 0; i < 4; i++) {
        c[i] = random_between(r, -1, 1);
        if (nasty) c[i] *= random_uniform(r) < 0.2 ? 0 : random_scale(r, -20, 0);
    }
    return (quat){c[0], c[1], c[2], c[3]};
}

/* ---- checks ---- */

/* The worst of many errors, with what caused it. */
static inline void worse(double *worst, double error)
{
    if (!(error <= *worst)) *worst = error;
}
#define assert_bound(name, worst, bound)                                                                               \
    do {                                                                                                               \
        const double worst_ = (worst), bound_ = (bound);                                                               \
        show_bounded(name, worst_, bound_);                                                                            \
        if (!(worst_ <= bound_))                                                                                       \
            fail_msg("%s: wanted at most %g, got %g, ratio %g", name, bound_, worst_, worst_ / bound_);                \
    } while (0)

#endif
