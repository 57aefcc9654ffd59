/* SPDX-License-Identifier: MIT
 *
 * bench_toi: the first time at which two tumbling bodies meet, by impact_toi and by two textbook ways with other
 * libraries' queries, on the same pairs. CSV: family; method; setting; time in us of one (median over rounds in which
 * all take turns); error: what the gap still is at the time found, over the size of the larger body (p50, p99, worst);
 * share of the pairs not answered where impact_toi answers; that time over ours; median over least; sum of the times.
 *
 *   samples          libccd's GJK says yes or no at so many times of the interval, then bisection: a meeting between
 *                    two samples is missed
 *   advancement      conservative advancement (Mirtich 1996): t += distance/(|v| + |w1| R1 + |w2| R2), with FCL's
 *                    distance, until it is this small; ellipsoids
 */
#include <stdio.h>
#include <string.h>
#include <impact/toi.h>
#include "../tests/kit/contact_random.h"
#include "measure.h"
#include "peers_gap.h"

enum { PAIRS = 100, ROUNDS = 3, METHODS = 6 };

typedef struct meeting {
    impact_solid body[2];
    impact_motion motion[2];
    double size, speed; /* of the larger body; what no point's approach exceeds */
    bool meets;
} meeting;

static const double interval = 4;

static int pair_count(void) { return getenv("BENCH_QUICK") ? 8 : PAIRS; }

static int rounds(void) { return getenv("BENCH_QUICK") ? 2 : ROUNDS; }

static double radius(const impact_shape *s) { return fmax(s->a, fmax(s->b, s->c)); }

static void make(random_stream *random, int family, meeting *m)
{
    memset(m, 0, sizeof *m);
    for (int k = 0; k < 2; k++) {
        m->body[k].shape = random_shape(random, family);
        m->body[k].orientation = random_rotation(random);
        m->size = fmax(m->size, contact_size(&m->body[k].shape));
    }
    m->body[0].position = qvec3_scale(random_direction(random), 4);
    for (int k = 0; k < 2; k++) m->motion[k].omega = qvec3_scale(random_direction(random), 3);
    m->motion[0].velocity = qvec3_scale(m->body[0].position, -1 / interval);
    m->speed = qvec3_norm(m->motion[0].velocity);
    for (int k = 0; k < 2; k++) m->speed += qvec3_norm(m->motion[k].omega) * radius(&m->body[k].shape);
}

static impact_solid place(const meeting *m, int k, double t) { return impact_motion_at(&m->body[k], &m->motion[k], t); }

/* ---- methods: the time, or NaN ---- */

static double exact(const meeting *m, double setting)
{
    double time;
    (void)setting;
    return impact_toi(&m->body[0], &m->motion[0], &m->body[1], &m->motion[1], interval, &time, NULL) == IMPACT_OK ? time
                                                                                                                  : NAN;
}

static bool meets_at(const meeting *m, double t)
{
    const impact_solid one = place(m, 0, t), other = place(m, 1, t);
    return gap_ccd_meets(&one, &other);
}

static double samples(const meeting *m, double count)
{
    double low = 0, high = 0;
    for (int k = 1; k <= (int)count; k++) {
        high = interval * k / count;
        if (meets_at(m, high)) break;
        low = high;
    }
    if (low == high) return NAN;
    while (high - low > 1e-9 * interval) { /* closer than GJK tells */
        const double middle = 0.5 * (low + high);
        if (middle == low || middle == high) break;
        *(meets_at(m, middle) ? &high : &low) = middle;
    }
    return high;
}

static double advancement(const meeting *m, double tolerance)
{
    double t = 0;
    for (int k = 0; k < 10000 && t <= interval; k++) {
        const impact_solid one = place(m, 0, t), other = place(m, 1, t);
        const double distance = gap_fcl_distance(&one, &other, 1e-12);
        if (!(distance > tolerance * m->size)) return distance >= 0 ? t : NAN;
        t += distance / m->speed;
    }
    return NAN;
}

typedef struct method {
    const char *name;
    double setting;
    double (*time)(const meeting *m, double setting);
    const gap_peer *needs;
    bool ellipsoids_only;
} method;

/* ---- the table ---- */

static void print(const char *family, const method *how, const meeting *list, double *times, double ours)
{
    static double left[PAIRS];
    int met = 0, wanted = 0;
    double sum = 0;
    for (int i = 0; i < pair_count(); i++) {
        if (!list[i].meets) continue;
        wanted++;
        const double t = how->time(&list[i], how->setting);
        if (isnan(t)) continue;
        impact_contact contact;
        const impact_solid one = place(&list[i], 0, t), other = place(&list[i], 1, t);
        if (impact_gap(&one, &other, NULL, &contact) < 0) continue;
        sum += t;
        left[met++] = fabs(contact.gap) / list[i].size;
    }
    const measure_time time = measure_of_rounds(times, rounds());
    const double p50 = measure_quantile(left, met, 0.5), p99 = measure_quantile(left, met, 0.99);
    printf("%s,%s,%g,%.3g,%.2g,%.2g,%.2g,%.4f,%.3g,%.2f,%.9g\n", family, how->name, how->setting, time.median, p50, p99,
           met ? left[met - 1] : NAN, wanted ? 1 - (double)met / wanted : NAN, time.median / ours, time.spread, sum);
    fflush(stdout);
}

static void compete(int family, const method *methods)
{
    static meeting list[PAIRS];
    static double times[METHODS][ROUNDS];
    random_stream random = {(uint64_t)family + 200};
    bool there[METHODS];
    for (int i = 0; i < pair_count(); i++) {
        make(&random, family, &list[i]);
        list[i].meets = !isnan(exact(&list[i], 0));
    }
    for (int k = 0; k < METHODS; k++)
        there[k] = (!methods[k].needs || methods[k].needs[0].method) &&
                   (!methods[k].ellipsoids_only || family <= RANDOM_ELLIPSOID);
    for (int round = 0; round < rounds(); round++)
        for (int k = 0; k < METHODS; k++) {
            const double from = measure_clock();
            double sum = 0;
            for (int i = 0; there[k] && i < pair_count(); i++) sum += methods[k].time(&list[i], methods[k].setting);
            times[k][round] = measure_since(from) / pair_count() * 1e6;
            if (sum == 1) printf("#\n"); /* the compiler may not leave it out */
        }
    const double ours = measure_of_rounds(times[0], rounds()).median;
    for (int k = 0; k < METHODS; k++)
        if (there[k]) print(random_family_name(family), &methods[k], list, times[k], ours);
}

int main(void)
{
    const method methods[METHODS] = {{"impact", 0, exact, NULL, false},
                                     {"samples (libccd)", 10, samples, gap_peers_ccd, false},
                                     {"samples (libccd)", 100, samples, gap_peers_ccd, false},
                                     {"samples (libccd)", 1000, samples, gap_peers_ccd, false},
                                     {"advancement (FCL)", 1e-4, advancement, gap_peers_fcl, true},
                                     {"advancement (FCL)", 1e-8, advancement, gap_peers_fcl, true}};
    if (!gap_peers_ccd[0].method) printf("# libccd is not installed: its rows are skipped\n");
    if (!gap_peers_fcl[0].method) printf("# FCL is not installed: its rows are skipped\n");
    printf("family,method,setting,us,gap_p50,gap_p99,gap_worst,unanswered,time_over_ours,spread,checksum\n");
    for (int family = 0; family < RANDOM_FAMILIES; family++) compete(family, methods);
    return 0;
}
