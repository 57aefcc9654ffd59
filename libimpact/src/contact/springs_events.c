/* SPDX-License-Identifier: MIT
 *
 * Where a polynomial first falls to zero. As far as it falls, or bends down, which its coefficients' signs tell, its
 * zero is the only one, and Newton's in a bracket finds it. Else strides: with |f''| <= B on [0, h],
 * f(t + d) >= f + f' d - B d^2/2, so that there is no zero before d = (f' + sqrt(f'^2 + 2 B f))/B. They pass no zero,
 * and near a simple one they are Newton's: they end there quadratically. Where a zero is guessed at Newton goes there
 * at once, and the polynomial over t - zero tells that it is the only one.
 */
#include "contact/springs.h"

#include <float.h>
#include <math.h>

/* Even and odd powers apart: two short chains instead of a long one. */
static double value_and_slope(const double *c, int order, double t, double *slope)
{
    const double square = t * t;
    double even = order % 2 ? 0 : c[order], odd = 0, even_slope = 0, odd_slope = 0;
    for (int k = order % 2 ? order : order - 1; k > 0; k -= 2) {
        even_slope = even_slope * square + even;
        even = even * square + c[k - 1];
        odd_slope = odd_slope * square + odd;
        odd = odd * square + c[k];
    }
    *slope = odd + 2 * t * (even_slope + t * odd_slope);
    return even + t * odd;
}

/* A bound of |f''| on [0, h]. */
static double bound_curvature(const double *c, int order, double h)
{
    double sum = 0;
    for (int k = order; k >= 2; k--) sum = sum * h + k * (k - 1.0) * fabs(c[k]);
    return sum;
}

/* Whether the terms before the first negative one are more at h than what the negative ones take: at less than h they
 * are all the more. */
static bool begins_above(const double *c, int terms, const double *power)
{
    double gives = 0, takes = 0;
    int k = 0;
    for (; k < terms && c[k] >= 0; k++) gives += c[k] * power[k];
    for (; k < terms; k++) takes += (c[k] < 0 ? -c[k] : 0) * power[k];
    return gives > takes;
}

/* Whether a + b t + c t^2 is above zero on [0, h] by more than what the later terms take. */
static bool is_clear(const double *c, int terms, const double *power)
{
    const double h = power[1], end = c[0] + (c[1] + c[2] * h) * h;
    double least = c[0] < end ? c[0] : end;
    if (c[2] > 0 && c[1] < 0 && -c[1] < 2 * c[2] * h) least = c[0] - c[1] * c[1] / (4 * c[2]);
    for (int k = 3; k < terms && least > 0; k++) least += (c[k] < 0 ? c[k] : 0) * power[k];
    return least > 0;
}

bool imp_springs_stay_above(const double *c, int terms, const double *power)
{
    if (begins_above(c, terms, power)) return true;
    for (int m = 0; m + 3 <= terms; m++) {
        if (is_clear(c + m, terms - m, power)) return true;
        if (c[m] < 0 || c[m + 1] < 0) return false;
    }
    return false;
}

/* Whether f' < 0 on all of (0, h], or f'' < 0. */
static bool falls_once(const double *c, int order, const double *power)
{
    imp_terms slope, bend;
    for (int k = 0; k < order; k++) slope[k] = -(k + 1) * c[k + 1];
    if (imp_springs_stay_above(slope, order, power)) return true;
    for (int k = 0; k + 1 < order; k++) bend[k] = (k + 1) * slope[k + 1];
    return imp_springs_stay_above(bend, order - 1, power);
}

/* The zero in (0, h], where f(h) <= 0 < f(0) and there is but one. */
static double only_zero(const double *c, int order, double h, double at_end)
{
    double low = 0, high = h, t = h * c[0] / (c[0] - at_end), slope;
    for (int i = 0; i < 100; i++) {
        if (!(t > low && t < high)) t = 0.5 * (low + high);
        const double f = value_and_slope(c, order, t, &slope);
        *(f > 0 ? &low : &high) = t;
        const double next = t - f / slope;
        if (fabs(next - t) <= 2 * DBL_EPSILON * t || high - low <= 2 * DBL_EPSILON * t)
            return fmin(fmax(next, low), high);
        t = next;
    }
    return high;
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

void imp_springs_find_powers(double h, int count, double *power)
{
    power[0] = 1, power[1] = h;
    for (int k = 2; k < count; k++) power[k] = power[k - 2] * (h * h); /* short chains */
}

/* The same of what falls, or bends down, all along. */
static double only_fall(const double *c, int order, double h, bool *found)
{
    double slope;
    *found = c[0] <= 0;
    if (*found) return 0;
    const double at_end = value_and_slope(c, order, h, &slope);
    *found = at_end <= 0;
    return *found ? only_zero(c, order, h, at_end) : h;
}

/* Whether a + b t + c t^2 is above what is taken. */
static inline bool bends_above(double a, double b, double c, double takes)
{
    const double end = a + b + c, least = a < end ? a : end;
    if (!(least > takes)) return false;
    return !(c > 0 && b < 0 && -b < 2 * c) || a - b * b / (4 * c) > takes;
}

bool imp_springs_begins_above(const double c[5], double takes)
{
    const double one = takes - (c[4] < 0 ? c[4] : 0), two = one - (c[3] < 0 ? c[3] : 0);
    if (bends_above(c[0], c[1], c[2], two)) return true;
    if (!(c[0] >= 0)) return false;
    return bends_above(c[1], c[2], c[3], one) || (c[1] >= 0 && bends_above(c[2], c[3], c[4], takes));
}

bool imp_springs_is_clear(const double *c, int terms)
{
    double takes = 0;
    for (int k = 5; k < terms; k++) takes -= c[k] < 0 ? c[k] : 0;
    return imp_springs_begins_above(c, takes);
}

/* Whether the sum over t - zero is below zero on [0, 1], a zero of it. */
static bool is_lone(const double *c, int order, double zero)
{
    imp_terms rest;
    double sum = 0;
    for (int k = order; k > 0; k--) rest[k - 1] = sum = sum * zero - c[k];
    return imp_springs_is_clear(rest, order);
}

/* Steps of Newton's: of t the next is off by bend/(2 slope) of the step's square, the bend by the slopes of two. */
double imp_springs_lone_fall(const double *c, int order, double about, bool *found)
{
    double t = about, slope, before = 0, step = INFINITY;
    *found = false;
    if (t == 0) {
        const double at_end = value_and_slope(c, order, 1, &slope);
        if (at_end > 0) return 1;
        t = c[0] / (c[0] - at_end);
    }
    for (int i = 0; i < 8; i++) {
        const double value = value_and_slope(c, order, t, &slope), bend = fabs((slope - before) / step);
        before = slope;
        step = -value / slope;
        t += step;
        if (!(t > 0 && t <= 1)) return 1;
        if (i == 0 || !(bend * step * step <= 4 * DBL_EPSILON * t * fabs(slope))) continue;
        *found = is_lone(c, order, t);
        return *found ? t : 1;
    }
    return 1;
}

double imp_springs_first_fall(const double *c, int order, double h, bool *found)
{
    *found = c[0] <= 0;
    if (*found) return 0;
    imp_terms power;
    imp_springs_find_powers(h, order + 1, power);
    if (imp_springs_stay_above(c, order + 1, power)) return h;
    double t = 0;
    for (double end = h; t == 0 && end > h / 16; end /= 2) {
        if (end < h) imp_springs_find_powers(end, order + 1, power);
        if (!falls_once(c, order, power)) continue;
        t = only_fall(c, order, end, found);
        if (*found) return t;
    }
    if (t == h) return h;
    for (int i = 0; i < 200; i++) {
        const double stride = safe_stride(c, order, t, h);
        if (stride >= h - t) return h;
        if (stride <= 2 * DBL_EPSILON * t) break;
        t += stride;
    }
    *found = true;
    return t;
}

/* Terms about t instead of 0. */
static void shift(double *c, int order, double t)
{
    for (int i = 0; i < order; i++)
        for (int k = order - 1; k >= i; k--) c[k] += t * c[k + 1];
}

int imp_springs_sign_changes(const double *c, int order, double t, double *when, int most)
{
    imp_terms f, power;
    double at = 0;
    int n = 0, first = 0;
    while (first < order && c[first] == 0) first++;
    const double sign = c[first] < 0 ? -1 : 1;
    for (int k = 0; k <= order; k++) f[k] = sign * c[k];
    if (f[0] == 0) f[0] = DBL_MIN; /* it begins at a zero */
    for (bool found = true; n < most;) {
        imp_springs_find_powers(t - at, order + 1, power);
        if (imp_springs_stay_above(f, order + 1, power)) break;
        const double further = imp_springs_first_fall(f, order, t - at, &found);
        if (!found) break;
        at += further;
        shift(f, order, further);
        for (int k = 1; k <= order; k++) f[k] = -f[k];
        if (f[1] <= 0) break; /* it touches zero, but for rounding */
        f[0] = DBL_MIN;
        when[n++] = at;
    }
    return n;
}
