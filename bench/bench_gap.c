/* SPDX-License-Identifier: MIT
 *
 * bench_gap: time per query of our ways and of libccd's, on the pairs of the campaign, with each way's error beside it.
 * CSV: family, method, setting, time in us (median of repeats of a batch), error of the gap relative to L + |c| (p50, p99,
 * worst), error of the normal in rad (p50), share of the pairs not answered or answered as touching where they are apart.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "../tests/contact_random.h"
#include "peers_gap.h"

enum { PAIRS = 2000, REPEATS = 7 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile(double *values, int count, double q)
{
    if (count == 0) return NAN;
    qsort(values, (size_t)count, sizeof *values, ascending);
    return values[(int)(q * (count - 1))];
}

/* Separated pairs (relative gap 1e-4 to 1) or, overlap true, overlaps of depth 1e-9 to 1e-4 of the thinnest axis. */
static void make_pairs(gap_case *cases, int family, bool overlap)
{
    random_stream random = {(uint64_t)family + 100};
    for (int i = 0; i < PAIRS; i++) {
        gap_case *c = &cases[i];
        double size = 0, thin = INFINITY;
        for (int k = 0; k < 2; k++) {
            c->body[k].shape = random_shape(&random, family);
            c->body[k].orientation = random_rotation(&random);
            c->body[k].position = (qvec3){0, 0, 0};
            size = fmax(size, contact_size(&c->body[k].shape));
            thin = fmin(thin, fmin(c->body[k].shape.a, fmin(c->body[k].shape.b, c->body[k].shape.c)));
        }
        c->normal = random_direction(&random);
        c->gap = overlap ? -thin * random_log(&random, 1e-9, 1e-4) : size * random_log(&random, 1e-4, 1);
        if (overlap && !contact_is_deepest(c->body, c->normal, c->gap)) { /* no truth to be had: draw again */
            i--;
            continue;
        }
        const qvec3 x1 = contact_support(&c->body[0], qvec3_neg(c->normal)), x2 = contact_support(&c->body[1], c->normal);
        c->body[0].position = qvec3_axpy(c->gap, c->normal, qvec3_sub(x2, x1));
        c->reach = size + qvec3_norm(c->body[0].position);
        c->cache = (impact_gap_cache){true, qvec3_axpy(1e-3, random_direction(&random), c->normal)};
        c->cache.normal = qvec3_scale(c->cache.normal, 1 / qvec3_norm(c->cache.normal));
    }
}

static bool ours_cold(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    (void)setting;
    impact_contact contact;
    const impact_status status = impact_gap(&c->body[0], &c->body[1], NULL, &contact);
    *gap = contact.gap, *normal = contact.normal;
    return status == IMPACT_OK;
}

/* From a normal 1e-3 rad away, as a simulation's last step leaves it. */
static bool ours_warm(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    (void)setting;
    impact_contact contact;
    impact_gap_cache cache = c->cache;
    const impact_status status = impact_gap(&c->body[0], &c->body[1], &cache, &contact);
    *gap = contact.gap, *normal = contact.normal;
    return status == IMPACT_OK;
}

static void measure(const char *family, const char *kind, const char *name, gap_method *method, double setting, const gap_case *cases)
{
    static double times[REPEATS], gaps[PAIRS], normals[PAIRS];
    int answered = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        answered = 0;
        double gap;
        qvec3 normal;
        const double start = now();
        for (int i = 0; i < PAIRS; i++) answered += method(&cases[i], setting, &gap, &normal);
        times[repeat] = (now() - start) / PAIRS * 1e6;
    }
    int gap_count = 0, normal_count = 0;
    for (int i = 0; i < PAIRS; i++) {
        double gap = NAN;
        qvec3 normal = {NAN, NAN, NAN};
        if (!method(&cases[i], setting, &gap, &normal)) continue;
        if (!isnan(gap)) gaps[gap_count++] = fabs(gap - cases[i].gap) / cases[i].reach;
        if (!isnan(normal.x)) normals[normal_count++] = qvec3_norm(qvec3_sub(normal, cases[i].normal));
    }
    const double time = quantile(times, REPEATS, 0.5), p50 = quantile(gaps, gap_count, 0.5), p99 = quantile(gaps, gap_count, 0.99);
    printf("%s,%s,%s,%g,%.3g,%.2g,%.2g,%.2g,%.2g,%.4f\n", family, kind, name, setting, time, p50, p99,
           gap_count ? gaps[gap_count - 1] : NAN, quantile(normals, normal_count, 0.5), 1 - (double)answered / PAIRS);
    fflush(stdout);
}

int main(void)
{
    static gap_case cases[PAIRS];
    printf("family,kind,method,setting,time_us,gap_p50,gap_p99,gap_worst,normal_p50,unanswered\n");
    for (int overlap = 0; overlap < 2; overlap++)
        for (int family = 0; family < RANDOM_FAMILIES; family++) {
            const char *name = random_family_name(family), *kind = overlap ? "shallow" : "separated";
            make_pairs(cases, family, overlap);
            measure(name, kind, "impact cold", ours_cold, 0, cases);
            measure(name, kind, "impact warm", ours_warm, 0, cases);
            for (int p = 0; gap_peers[p].method; p++)
                if (!gap_peers[p].overlap_only || overlap) measure(name, kind, gap_peers[p].name, gap_peers[p].method, gap_peers[p].setting, cases);
        }
    if (!gap_peers[0].method) printf("# libccd is not installed: its rows are skipped\n");
    return 0;
}
