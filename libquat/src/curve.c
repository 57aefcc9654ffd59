/* SPDX-License-Identifier: MIT */
#include <quat/curve.h>

#include <float.h>
#include <quat/rotation.h>
#include "curve.h"
#include "difference.h"
#include "scale.h"

static const qvec3 zero = {0, 0, 0};

/* ---- through samples ---- */

enum { window = 8 };

/* The first of the samples whose polynomial holds at t; for a closed curve it may lie before 0. */
static ptrdiff_t window_start(const quat_samples *s, double t, size_t count)
{
    size_t low = 0, high = s->n - 1;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (s->t[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    const ptrdiff_t start = (ptrdiff_t)low - (ptrdiff_t)(count / 2) + 1;
    if (s->closed) return start;
    return start < 0 ? 0 : start > (ptrdiff_t)(s->n - count) ? (ptrdiff_t)(s->n - count) : start;
}

static bool sampled(double t, qvec3 d[4], void *context)
{
    const quat_samples *s = context;
    const size_t around = s->n - 1, count = s->closed       ? (around < window ? around : window)
                                            : s->n < window ? s->n
                                                            : window;
    const double period = s->t[s->n - 1] - s->t[0];
    double node[QUAT_DIFFERENCE_NODES], weights[4][QUAT_DIFFERENCE_NODES];
    qvec3 x[window];
    const ptrdiff_t start = window_start(s, t, count);
    for (size_t i = 0; i < count; i++) {
        ptrdiff_t k = start + (ptrdiff_t)i;
        double turns = 0;
        if (s->closed && k < 0) k += (ptrdiff_t)around, turns = -1;
        if (s->closed && k >= (ptrdiff_t)around) k -= (ptrdiff_t)around, turns = 1;
        node[i] = s->t[k] - t + turns * period;
        x[i] = s->x[k];
    }
    quat_difference_weights((int)count, node, 3, weights);
    for (int k = 0; k < 4; k++) {
        d[k] = zero;
        for (size_t i = 0; i < count; i++) d[k] = qvec3_axpy(weights[k][i], x[i], d[k]);
    }
    return true;
}

quat_status quat_curve_from_samples(const quat_samples *samples, quat_curve *curve)
{
    const quat_curve none = {0};
    double size = 0;
    *curve = none;
    if (!samples || samples->n < 4 || !samples->t || !samples->x) return QUAT_EARGUMENT;
    const size_t last = samples->n - 1;
    for (size_t i = 0; i <= last; i++) {
        if (!isfinite(samples->t[i]) || !qvec3_isfinite(samples->x[i])) return QUAT_EDOMAIN;
        if (i > 0 && !(samples->t[i] > samples->t[i - 1])) return QUAT_EARGUMENT;
        size = fmax(size, qvec3_norm(samples->x[i]));
    }
    if (samples->closed && qvec3_norm(qvec3_sub(samples->x[last], samples->x[0])) > 1e-9 * size) return QUAT_EDOMAIN;
    curve->at = sampled;
    curve->context = (void *)samples;
    curve->start = samples->t[0];
    curve->end = samples->t[last];
    curve->closed = samples->closed;
    curve->known = 3;
    return QUAT_OK;
}

/* ---- at a point ---- */

bool quat_curve_is_good(const quat_curve *curve)
{
    return curve && curve->at && isfinite(curve->end - curve->start) && curve->start < curve->end &&
           curve->known >= 0 && curve->known <= 3;
}

/* t in start ... end: as it is, or for a closed curve by whole periods. */
static double home(const quat_curve *curve, double t)
{
    if (!curve->closed || (t >= curve->start && t <= curve->end)) return t;
    const double period = curve->end - curve->start;
    t -= period * floor((t - curve->start) / period);
    return t < curve->start ? curve->start : t > curve->end ? curve->end : t;
}

static bool ask(const quat_curve *curve, double t, qvec3 d[4])
{
    if (!curve->at(home(curve, t), d, curve->context)) return false;
    for (int k = 0; k <= curve->known; k++)
        if (!qvec3_isfinite(d[k])) return false;
    return true;
}

static bool highest_known(double t, qvec3 *x, void *context)
{
    const quat_curve *curve = context;
    qvec3 d[4];
    if (!ask(curve, t, d)) return false;
    *x = d[curve->known];
    return true;
}

static bool derivatives(const quat_curve *curve, double t, int order, qvec3 d[4], double error[4])
{
    const int known = curve->known;
    if (!ask(curve, t, d)) return false;
    for (int k = 0; k <= known; k++) error[k] = 2 * DBL_EPSILON * qvec3_norm(d[k]);
    if (known >= order) return true;
    return quat_differentiate(highest_known, (void *)curve, t, curve->closed ? -INFINITY : curve->start,
                              curve->closed ? INFINITY : curve->end, curve->end - curve->start, 0, order - known,
                              d + known + 1, error + known + 1, NULL);
}

quat_status quat_curve_derivatives(const quat_curve *curve, double t, int order, qvec3 d[4], double error[4])
{
    double own[4];
    double *const e = error ? error : own;
    for (int k = 0; k < 4; k++) d[k] = zero, e[k] = 0;
    if (!quat_curve_is_good(curve) || order < 0 || order > 3) return QUAT_EARGUMENT;
    if (!isfinite(t) || (!curve->closed && (t < curve->start || t > curve->end))) return QUAT_EDOMAIN;
    if (derivatives(curve, t, order, d, e)) return QUAT_OK;
    for (int k = 0; k < 4; k++) d[k] = zero, e[k] = 0;
    return QUAT_EDOMAIN;
}

quat_status quat_curve_tangent(const quat_curve *curve, double t, qvec3 *position, qvec3 *tangent)
{
    qvec3 d[4];
    double error[4];
    const quat_status status = quat_curve_derivatives(curve, t, 1, d, error);
    *position = d[0];
    if (status != QUAT_OK) return status;
    if (qvec3_norm(d[1]) <= 4 * error[1]) return QUAT_EDOMAIN;
    return qvec3_normalize(d[1], tangent);
}

/* Neither a unit of length nor one of t changes more than the curvature's own unit: with those that bring d[1] and d[2]
 * close to 1 no product of them vanishes or overflows that the curvature and the torsion do not. Returns the unit of
 * length, as a power of two. */
static int to_own_units(qvec3 d[4], double e[4])
{
    const int first = quat_vector_exponent(d[1]), second = quat_vector_exponent(d[2]),
              rate = qvec3_norm(d[2]) > 0 ? second - first : 0, length = first - rate;
    for (int k = 1; k < 4; k++) {
        d[k] = quat_ldexp_vector(d[k], -length - k * rate);
        e[k] = ldexp(e[k], -length - k * rate);
    }
    return length;
}

/* What follows from the first three derivatives, `unit` being the unit of length. */
static quat_status bend(const qvec3 d[4], const double e[4], int unit, quat_curve_point *point)
{
    const qvec3 cross = qvec3_cross(d[1], d[2]);
    const double speed = qvec3_norm(d[1]), turn = qvec3_norm(cross), cube = speed * speed * speed,
                 turn_error = speed * e[2] + qvec3_norm(d[2]) * e[1];
    qvec3 tangent, normal;
    point->curvature_error = ldexp(turn_error / cube + 3 * (turn / cube) * (e[1] / speed), -unit);
    qvec3_normalize(d[1], &tangent);
    if (turn <= 4 * turn_error) {
        quat_from_two_vectors(qvec3_make(1, 0, 0), tangent, &point->frame);
        return QUAT_NOT_UNIQUE;
    }
    const double torsion = qvec3_dot(cross, d[3]) / turn / turn;
    point->curvature = ldexp(turn / cube, -unit);
    point->torsion = ldexp(torsion, -unit);
    point->torsion_error =
        ldexp(e[3] / turn + (qvec3_norm(d[3]) / turn + 2 * fabs(torsion)) * (turn_error / turn), -unit);
    qvec3_normalize(qvec3_cross(cross, d[1]), &normal);
    return quat_from_axes(tangent, normal, &point->frame);
}

quat_status quat_curve_at(const quat_curve *curve, double t, quat_curve_point *point)
{
    const quat_curve_point none = {.frame = {1, 0, 0, 0}};
    qvec3 d[4];
    double e[4];
    *point = none;
    const quat_status status = quat_curve_derivatives(curve, t, 3, d, e);
    point->position = d[0];
    if (status != QUAT_OK) return status;
    const double speed = qvec3_norm(d[1]);
    if (speed <= 4 * e[1]) return QUAT_EDOMAIN;
    if (!(speed >= 1e-100) || fmax(speed, fmax(qvec3_norm(d[2]), qvec3_norm(d[3]))) > 1e100) return QUAT_ERANGE;
    point->speed = speed;
    const int unit = to_own_units(d, e);
    return bend(d, e, unit, point);
}
