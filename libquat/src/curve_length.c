/* SPDX-License-Identifier: MIT
 *
 * Arc length and what is integrated along a curve.
 */
#include "curve.h"

#include <float.h>
#include "quadrature.h"

typedef struct walk {
    const quat_curve *curve;
    bool failed, inflection;
} walk;

static double speed_at(double t, void *context, double *error)
{
    walk *w = context;
    qvec3 d[4];
    double e[4] = {0};
    if (w->failed || quat_curve_derivatives(w->curve, t, 1, d, e) != QUAT_OK) {
        w->failed = true;
        return 0;
    }
    *error = e[1];
    return qvec3_norm(d[1]);
}

/* The error of the derivatives that spoils an integral, in parts of it and its unit. */
static const double rough = 1e-8;

/* How far from the origin the curve's ends are: the size that values, and differences of them, are rounded to. */
static double reach(const quat_curve *curve)
{
    qvec3 first[4], last[4];
    if (quat_curve_derivatives(curve, curve->start, 0, first, NULL) != QUAT_OK ||
        quat_curve_derivatives(curve, curve->end, 0, last, NULL) != QUAT_OK)
        return 0;
    return fmax(qvec3_norm(first[0]), qvec3_norm(last[0]));
}

static quat_status check_ends(const quat_curve *curve, double a, double b)
{
    if (!quat_curve_is_good(curve)) return QUAT_EARGUMENT;
    if (!isfinite(a) || !isfinite(b)) return QUAT_EDOMAIN;
    if (!curve->closed && (fmin(a, b) < curve->start || fmax(a, b) > curve->end)) return QUAT_EDOMAIN;
    return QUAT_OK;
}

quat_status quat_curve_length(const quat_curve *curve, double a, double b, double *length)
{
    walk w = {.curve = curve};
    double noise;
    *length = 0;
    quat_status status = check_ends(curve, a, b);
    if (status != QUAT_OK) return status;
    status = quat_quadrature(speed_at, &w, a, b, 2e-15, length, &noise);
    if (!w.failed && isfinite(*length))
        return noise > rough * fabs(*length) && noise > rough * reach(curve) ? QUAT_NOT_CONVERGED : status;
    *length = 0;
    return w.failed ? QUAT_EDOMAIN : QUAT_ERANGE;
}

/* The t whose distance along the curve from `from` is `distance`, between from and high. Lengths that do not converge
 * take long and help little: after a few of them that is that. */
static quat_status advance(const quat_curve *curve, double from, double distance, double high, double guess, double *t)
{
    double low = from, at = from, length = 0, x = fmin(fmax(guess, low), high);
    int poor = 0;
    for (int round = 0; round < 100 && poor < 4; round++) {
        walk w = {.curve = curve};
        double piece;
        const quat_status status = quat_curve_length(curve, at, x, &piece);
        if (status < 0) return status;
        poor += status != QUAT_OK;
        length += piece;
        at = x;
        double error;
        const double off = length - distance, speed = speed_at(x, &w, &error);
        if (w.failed) return QUAT_EDOMAIN;
        if (off > 0)
            high = x;
        else
            low = x;
        *t = x;
        const double finest = 2 * DBL_EPSILON * fmax(fabs(low), fabs(high));
        if (fabs(off) <= fmax(4 * DBL_EPSILON * distance, finest * speed) || high - low <= finest)
            return poor ? QUAT_NOT_CONVERGED : QUAT_OK;
        double next = x - off / speed;
        if (!(next > low && next < high)) next = low + (high - low) / 2;
        if (next == x) return poor ? QUAT_NOT_CONVERGED : QUAT_OK;
        x = next;
    }
    return QUAT_NOT_CONVERGED;
}

quat_status quat_curve_at_length(const quat_curve *curve, double length, double *t)
{
    double whole;
    *t = curve ? curve->start : 0;
    if (!quat_curve_is_good(curve)) return QUAT_EARGUMENT;
    const quat_status status = quat_curve_length(curve, curve->start, curve->end, &whole);
    if (status < 0) return status;
    if (!(length >= -1e-9 * whole && length <= whole * (1 + 1e-9))) return QUAT_EDOMAIN;
    if (length <= 0) return status;
    *t = curve->end;
    if (length >= whole) return status;
    const double guess = curve->start + (curve->end - curve->start) * (length / whole);
    return advance(curve, curve->start, length, curve->end, guess, t);
}

quat_status quat_curve_even(const quat_curve *curve, size_t n, double t[])
{
    double whole;
    if (!quat_curve_is_good(curve) || n < 2) return QUAT_EARGUMENT;
    quat_status status = quat_curve_length(curve, curve->start, curve->end, &whole);
    if (status < 0) return status;
    t[0] = curve->start;
    size_t i;
    quat_status found = QUAT_OK;
    for (i = 1; i + 1 < n && found == QUAT_OK; i++) {
        const double step = whole / (double)(n - 1), before = i > 1 ? t[i - 2] : t[0];
        double guess = t[i - 1] + (i > 1 ? t[i - 1] - before : (curve->end - curve->start) / (double)(n - 1));
        found = advance(curve, t[i - 1], step, curve->end, guess, &t[i]);
        if (found < 0) return found;
        if (found != QUAT_OK) status = found;
        if (t[i] > t[i - 1] && t[i] < curve->end) continue;
        status = QUAT_NOT_CONVERGED; /* lengths that are noise lead nowhere */
        break;
    }
    const double last = t[i - 1], step = (curve->end - last) / (double)(n - i);
    for (size_t k = i; k < n; k++) t[k] = k + 1 < n ? last + (double)(k - i + 1) * step : curve->end;
    return status;
}

static bool bend(walk *w, double t, quat_curve_point *point)
{
    const quat_status status = w->failed ? QUAT_EDOMAIN : quat_curve_at(w->curve, t, point);
    w->failed = w->failed || status < 0;
    w->inflection = w->inflection || status == QUAT_NOT_UNIQUE;
    return !w->failed;
}

static double curvature_at(double t, void *context, double *error)
{
    quat_curve_point point;
    if (!bend(context, t, &point)) return 0;
    *error = point.curvature_error * point.speed;
    return point.curvature * point.speed;
}

static double torsion_at(double t, void *context, double *error)
{
    quat_curve_point point;
    if (!bend(context, t, &point)) return 0;
    *error = point.torsion_error * point.speed;
    return point.torsion * point.speed;
}

/* The integral of an angle along the whole curve. */
static quat_status total_angle(quat_integrand f, walk *w, double *angle)
{
    double noise;
    const quat_status status = quat_quadrature(f, w, w->curve->start, w->curve->end, 1e-14, angle, &noise);
    return noise > rough * (fabs(*angle) + 1) ? QUAT_NOT_CONVERGED : status;
}

quat_status quat_curve_total(const quat_curve *curve, quat_curve_totals *totals)
{
    const quat_curve_totals none = {0, 0, 0};
    walk w = {.curve = curve};
    *totals = none;
    if (!quat_curve_is_good(curve)) return QUAT_EARGUMENT;
    const quat_status s1 = quat_curve_length(curve, curve->start, curve->end, &totals->length),
                      s2 = total_angle(curvature_at, &w, &totals->curvature),
                      s3 = total_angle(torsion_at, &w, &totals->torsion);
    if (s1 < 0 || w.failed) {
        *totals = none;
        return s1 < 0 ? s1 : QUAT_EDOMAIN;
    }
    if (w.inflection) return QUAT_NOT_UNIQUE;
    return s1 != QUAT_OK || s2 != QUAT_OK || s3 != QUAT_OK ? QUAT_NOT_CONVERGED : QUAT_OK;
}
