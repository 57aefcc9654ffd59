/* SPDX-License-Identifier: MIT
 *
 * Weights of means and alignments, relative to their largest; NULL stands for all 1.
 */
#ifndef QUAT_WEIGHTS_H
#define QUAT_WEIGHTS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* False when there is no use in them: negative, infinite, NaN, or all 0. */
static inline bool quat_weight_largest(size_t n, const double weights[], double *largest)
{
    *largest = weights ? 0 : 1;
    for (size_t i = 0; weights && i < n; i++) {
        if (!(weights[i] >= 0) || isinf(weights[i])) return false;
        *largest = fmax(*largest, weights[i]);
    }
    return *largest > 0;
}

static inline double quat_weight(const double weights[], size_t i, double largest)
{
    return weights ? weights[i] / largest : 1;
}

#endif
