/* SPDX-License-Identifier: MIT
 *
 * The weights of slerp over at most a quarter of a great circle, without branches, without libm but for sqrt, and so
 * the same bits everywhere: one quaternion at a time or a vector register full.
 */
#ifndef QUAT_SLERP_KERNEL_H
#define QUAT_SLERP_KERNEL_H

#include <math.h>

/* atan(sqrt x)/sqrt x on 0 ... tan^2(pi/8), to 3e-18: tests/generators/atan_coefficients.c. */
static inline double quat_atan_series(double x)
{
    const double x2 = x * x, x4 = x2 * x2, x8 = x4 * x4;
    const double c0 = 0x1p+0 + -0x1.555555555552bp-2 * x, c2 = 0x1.9999999993e7bp-3 + -0x1.2492492229a26p-3 * x;
    const double c4 = 0x1.c71c70b8df71dp-4 + -0x1.745cf436e5409p-4 * x,
                 c6 = 0x1.3b10cb9e6d103p-4 + -0x1.10e871e23fdedp-4 * x;
    const double c8 = 0x1.dee1777d6f8bp-5 + -0x1.9c0abd56141f8p-5 * x,
                 c10 = 0x1.35e6d565cf39bp-5 + -0x1.2146b7b09aeb1p-6 * x;
    return ((c0 + c2 * x2) + (c4 + c6 * x2) * x4) + (c8 + c10 * x2) * x8;
}

/* sin(sqrt x)/sqrt x and cos(sqrt x) on 0 ... (pi/4)^2: Taylor, the first term left out is below 3e-18. */
static inline double quat_sin_series(double x)
{
    const double x2 = x * x, x4 = x2 * x2;
    const double c1 = -1.0 / 6 + x * (1.0 / 120), c3 = -1.0 / 5040 + x * (1.0 / 362880);
    const double c5 = -1.0 / 39916800 + x * (1.0 / 6227020800), c7 = -1.0 / 1307674368000 + x * (1.0 / 355687428096000);
    return 1 + x * ((c1 + c3 * x2) + (c5 + c7 * x2) * x4);
}
static inline double quat_cos_series(double x)
{
    const double x2 = x * x, x4 = x2 * x2;
    const double c2 = 1.0 / 24 - x * (1.0 / 720), c4 = 1.0 / 40320 - x * (1.0 / 3628800);
    const double c6 = 1.0 / 479001600 - x * (1.0 / 87178291200), c8 = 1.0 / 20922789888000;
    return (1 - 0.5 * x) + x2 * ((c2 + c4 * x2) + (c6 + c8 * x2) * x4);
}

/* The point at t between p and q, an angle 2h <= pi/2 apart, is a p + b q. Given s2 = sin^2 h = |q - p|^2/4, and
 * |m| <= 1, m = 2t - 1: measured from the middle, a and b are cos(mh)/(2 cos h) -+ sin(mh)/(2 sin h). */
static inline void quat_slerp_weights(double s2, double m, double *a, double *b)
{
    const double c = sqrt(1 - s2), d = 1 + c, r = 1 / (c * d); /* cos h; 1/c = r d, 1/d = r c */
    const double tan2 = s2 * ((r * c) * (r * c));              /* tan^2(h/2) */
    const double k = 2 * (r * c) * quat_atan_series(tan2);     /* h/sin h */
    const double angle2 = m * m * (k * k * s2);                /* (mh)^2 */
    const double along = 0.5 * (r * d) * quat_cos_series(angle2), across = 0.5 * m * k * quat_sin_series(angle2);
    *a = along - across;
    *b = along + across;
}

#endif
