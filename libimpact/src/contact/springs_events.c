/* SPDX-License-Identifier: MIT
 *
 * Where a polynomial first falls to zero. With |f''| <= B on [0, h], f(t + d) >= f + f' d - B d^2/2, so that there is
 * no zero before d = (f' + sqrt(f'^2 + 2 B f))/B. Such strides pass no zero, and near a simple one they are Newton's:
 * they end there quadratically.
 */
#include "contact/springs.h"

#include <float.h>
#include <math.h>

static double value_and_slope(const double *c, int order, double t, double *slope)
{
    double f = c[order], d = 0;
    for (int k = order - 1; k >= 0; k--) {
        d = d * t + f;
        f = f * t + c[k];
    }
    *slope = d;
    return f;
}

/* A bound of |f''| on [0, h]. */
static double bound_curvature(const double *c, int order, double h)
{
    double sum = 0;
    for (int k = order; k >= 2; k--) sum = sum * h + k * (k - 1.0) * fabs(c[k]);
    return sum;
}

/* Whether the terms after the first are too small to reach zero in [0, h]. */
static bool stays(const double *c, int order, double h)
{
    double sum = 0;
    for (int k = order; k >= 1; k--) sum = (sum + fmax(0, -c[k])) * h;
    return sum < c[0];
}

/* The positive zero of f + slope d - bound d^2/2, of f > 0. */
static double zero_of_bound(double f, double slope, double bound)
{
    const double root = sqrt(slope * slope + 2 * bound * f);
    const double above = slope > 0 ? slope + root : 2 * f, below = slope > 0 ? bound : root - slope;
    return below > 0 ? above / below : DBL_MAX;
}

/* How far from t there is no zero, at most to h: the bound taken over less and less, as long as it is what stops. */
static double safe_stride(const double *c, int order, double t, double h)
{
    double slope, best = 0;
    const double f = value_and_slope(c, order, t, &slope);
    if (f <= 0) return 0;
    for (double end = h; best < (end - t) / 2;) {
        const double stride = fmin(zero_of_bound(f, slope, bound_curvature(c, order, end)), end - t);
        if (stride < 2 * best || stride <= 2 * DBL_EPSILON * t) return fmax(best, stride);
        best = stride;
        end = t + fmax(4 * best, (end - t) / 16);
    }
    return best;
}

double imp_springs_first_fall(const double *c, int order, double h, bool *found)
{
    *found = c[0] <= 0;
    if (*found) return 0;
    if (stays(c, order, h)) return h;
    double t = 0;
    for (int i = 0; i < 200; i++) {
        const double stride = safe_stride(c, order, t, h);
        if (stride >= h - t) return h;
        if (stride <= 2 * DBL_EPSILON * t) break;
        t += stride;
    }
    *found = true;
    return t;
}
