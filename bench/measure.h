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

/* Seconds that the processor has worked for this program: the machine may have other work. */
static inline double measure_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds that have passed: of work on several threads. */
static inline double measure_wall(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* What asking takes: a system call, some tenths of a microsecond; the least of many. */
static inline double measure_asking(void)
{
    static double least;
    if (least > 0) return least;
    least = INFINITY;
    for (int k = 0; k < 1000; k++) {
        const double from = measure_clock();
        least = fmin(least, measure_clock() - from);
    }
    return least;
}

/* Seconds of work since then, without the asking. */
static inline double measure_since(double from) { return fmax(0, measure_clock() - from - measure_asking()); }

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

/* Of rounds in which all contestants took turns: the median, and that over the least. */
typedef struct measure_time {
    double median, spread;
} measure_time;

static inline measure_time measure_of_rounds(double *values, int count)
{
    const double median = measure_quantile(values, count, 0.5);
    const measure_time time = {median, count > 0 ? median / values[0] : NAN};
    return time;
}

#endif
