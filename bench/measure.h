/* SPDX-License-Identifier: MIT
 *
 * What the benchmarks and reports measure with: a clock and quantiles.
 */
#ifndef MEASURE_H
#define MEASURE_H

#include <math.h>
#include <stdlib.h>
#include <time.h>

/* So many samples; with BENCH_QUICK in the environment a twentieth, of the same rows (./run report --quick). */
static inline int measure_count(int full)
{
    const int few = full / 20;
    return !getenv("BENCH_QUICK") ? full : few > 1 ? few : 1;
}

/* Seconds from some fixed time on. */
static inline double measure_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline int measure_ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts the values; the one below which the part q of them lies, NaN where there is none. */
static inline double measure_quantile(double *values, int count, double q)
{
    if (count == 0) return NAN;
    qsort(values, (size_t)count, sizeof *values, measure_ascending);
    return values[(int)(q * (count - 1) + 0.5)];
}

#endif
