/* SPDX-License-Identifier: MIT */
#include <quat/average.h>
#include <quat/exponential.h>
#include <quat/rotation.h>
#include "attitude.h"
#include <float.h>

/* Weights relative to their largest; NULL stands for all 1. False when there is no use in them. */
static bool largest_weight(size_t n, const double weights[], double *largest)
{
    *largest = weights ? 0 : 1;
    for (size_t i = 0; weights && i < n; i++) {
        if (!(weights[i] >= 0) || isinf(weights[i])) return false;
        *largest = fmax(*largest, weights[i]);
    }
    return *largest > 0;
}

static double weight(const double weights[], size_t i, double largest) { return weights ? weights[i] / largest : 1; }

/* ---- means ---- */

quat_status quat_mean(size_t n, const quat q[], const double weights[], quat *mean)
{
    double largest, m[4][4] = {{0}}, values[4], vectors[4][4];
    *mean = quat_identity();
    if (n == 0) return QUAT_EARGUMENT;
    if (!largest_weight(n, weights, &largest)) return QUAT_EDOMAIN;
    for (size_t i = 0; i < n; i++) {
        quat unit;
        if (quat_normalize(q[i], &unit) != QUAT_OK) return QUAT_EDOMAIN;
        const double c[4] = {unit.w, unit.x, unit.y, unit.z}, w = weight(weights, i, largest);
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < 4; k++) m[j][k] += w * c[j] * c[k];
    }
    quat_eigen4(m, values, vectors);
    const double *const v = vectors[0];
    if (quat_normalize(quat_make(v[0], v[1], v[2], v[3]), mean) != QUAT_OK) return QUAT_EDOMAIN;
    if (mean->w < 0) *mean = quat_neg(*mean);
    return values[0] - values[1] <= 32 * DBL_EPSILON * values[0] ? QUAT_NOT_UNIQUE : QUAT_OK;
}

/* The rotation vector (half of it: the logarithm on S^3) from mean to q, the short way, in the mean's own axes. */
static qvec3 half_turn_to(quat mean, quat q)
{
    quat_normalize(q, &q);
    return quat_log_unit(quat_mul_compensated(quat_conj(mean), quat_nearest(q, mean)));
}

quat_status quat_mean_karcher(size_t n, const quat q[], const double weights[], quat *mean, double *spread)
{
    double largest;
    if (spread) *spread = NAN;
    const quat_status start = quat_mean(n, q, weights, mean);
    if (start < 0 || !largest_weight(n, weights, &largest)) return start;
    for (int round = 0; round < 100; round++) {
        qvec3 sum = {0, 0, 0};
        double total = 0, square = 0;
        for (size_t i = 0; i < n; i++) {
            const double w = weight(weights, i, largest);
            const qvec3 h = half_turn_to(*mean, q[i]);
            sum = qvec3_axpy(w, h, sum);
            square += w * qvec3_dot(h, h);
            total += w;
        }
        const qvec3 step = qvec3_scale(sum, 1 / total);
        if (spread) *spread = 2 * sqrt(square / total);
        /* steps below the rounding of the logarithms themselves gain nothing */
        if (qvec3_norm(step) <= 4 * DBL_EPSILON * (1 + sqrt(square / total))) return start;
        quat_normalize(quat_mul(*mean, quat_exp_pure(step)), mean);
        if (mean->w < 0) *mean = quat_neg(*mean);
    }
    return QUAT_NOT_CONVERGED;
}

/* ---- alignment ---- */

static bool finite_sets(size_t n, const qvec3 a[], const qvec3 b[])
{
    for (size_t i = 0; i < n; i++)
        if (!qvec3_isfinite(a[i]) || !qvec3_isfinite(b[i])) return false;
    return true;
}

static double largest_component(size_t n, const qvec3 a[], qvec3 centre)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++) {
        const qvec3 d = qvec3_sub(a[i], centre);
        largest = fmax(fmax(largest, fabs(d.x)), fmax(fabs(d.y), fabs(d.z)));
    }
    return largest;
}

/* A power of two near x: lengths are scaled by it, so that their products keep within the range of doubles. */
static double scale_near(double x) { return x > 0 && isfinite(x) ? ldexp(1, -ilogb(x) > 1000 ? 1000 : -ilogb(x)) : 1; }

/* The two sets about their centres: the profile matrix sum w b a^T, its best rotation and what is left. */
static quat_status align_centred(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], double heaviest,
                                 qvec3 ca, qvec3 cb, quat *q, double *residual)
{
    const double sa = scale_near(largest_component(n, a, ca)), sb = scale_near(largest_component(n, b, cb));
    qmat3 m = {{{0}}};
    for (size_t i = 0; i < n; i++) {
        const double w = weight(weights, i, heaviest);
        const qvec3 u = qvec3_scale(qvec3_sub(a[i], ca), sa), v = qvec3_scale(qvec3_sub(b[i], cb), w * sb);
        const double from[3] = {u.x, u.y, u.z}, to[3] = {v.x, v.y, v.z};
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) m.m[j][k] += to[j] * from[k];
    }
    const quat_status status = quat_attitude(&m, q);
    if (residual) {
        const double s = fmin(sa, sb);
        double sum = 0, total = 0;
        for (size_t i = 0; i < n; i++) {
            const double w = weight(weights, i, heaviest);
            const qvec3 u = qvec3_scale(qvec3_sub(a[i], ca), s), v = qvec3_scale(qvec3_sub(b[i], cb), s);
            sum = hypot(sum, sqrt(w) * qvec3_norm(qvec3_sub(v, quat_rotate(*q, u))));
            total += w;
        }
        *residual = sum / sqrt(total) / s;
    }
    return status;
}

quat_status quat_align(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat *q, double *residual)
{
    double heaviest;
    const qvec3 origin = {0, 0, 0};
    *q = quat_identity();
    if (residual) *residual = NAN;
    if (n == 0) return QUAT_EARGUMENT;
    if (!largest_weight(n, weights, &heaviest) || !finite_sets(n, a, b)) return QUAT_EDOMAIN;
    const quat_status status = align_centred(n, a, b, weights, heaviest, origin, origin, q, residual);
    if (status < 0 && residual) *residual = NAN;
    return status;
}

static qvec3 centroid(size_t n, const qvec3 a[], const double weights[], double heaviest)
{
    /* about the first point, so that sets far from the origin lose nothing */
    qvec3 sum = {0, 0, 0};
    double total = 0;
    for (size_t i = 0; i < n; i++) {
        const double w = weight(weights, i, heaviest);
        sum = qvec3_axpy(w, qvec3_sub(a[i], a[0]), sum);
        total += w;
    }
    return qvec3_axpy(1 / total, sum, a[0]);
}

quat_status quat_align_points(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat *q, qvec3 *shift,
                              double *residual)
{
    double heaviest;
    *q = quat_identity();
    *shift = qvec3_make(0, 0, 0);
    if (residual) *residual = NAN;
    if (n == 0) return QUAT_EARGUMENT;
    if (!largest_weight(n, weights, &heaviest) || !finite_sets(n, a, b)) return QUAT_EDOMAIN;
    const qvec3 ca = centroid(n, a, weights, heaviest), cb = centroid(n, b, weights, heaviest);
    const double size = fmax(largest_component(n, a, ca), largest_component(n, b, cb));
    if (!qvec3_isfinite(ca) || !qvec3_isfinite(cb) || isinf(size)) return QUAT_ERANGE;
    const quat_status status = align_centred(n, a, b, weights, heaviest, ca, cb, q, residual);
    *shift = qvec3_sub(cb, quat_rotate(*q, ca));
    if (qvec3_isfinite(*shift)) return status < 0 ? QUAT_NOT_UNIQUE : status;
    *q = quat_identity();
    *shift = qvec3_make(0, 0, 0);
    if (residual) *residual = NAN;
    return QUAT_ERANGE;
}
