/* SPDX-License-Identifier: MIT */
#include <quat/average.h>
#include <quat/exponential.h>
#include <quat/rotation.h>
#include "attitude.h"
#include "weights.h"
#include <float.h>

quat_status quat_mean(size_t n, const quat q[], const double weights[], quat *mean)
{
    double largest, m[4][4] = {{0}}, values[4], vectors[4][4];
    *mean = quat_identity();
    if (n == 0) return QUAT_EARGUMENT;
    if (!quat_weight_largest(n, weights, &largest)) return QUAT_EDOMAIN;
    for (size_t i = 0; i < n; i++) {
        quat unit;
        if (quat_normalize(q[i], &unit) != QUAT_OK) return QUAT_EDOMAIN;
        const double c[4] = {unit.w, unit.x, unit.y, unit.z}, w = quat_weight(weights, i, largest);
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
    if (start < 0 || !quat_weight_largest(n, weights, &largest)) return start;
    for (int round = 0; round < 100; round++) {
        qvec3 sum = {0, 0, 0};
        double total = 0, square = 0;
        for (size_t i = 0; i < n; i++) {
            const double w = quat_weight(weights, i, largest);
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
