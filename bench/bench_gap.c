/* SPDX-License-Identifier: MIT
 *
 * bench_gap: time per query of our ways and of libccd's, FCL's, coal's and MuJoCo's, on the pairs of the campaign, with
 * each way's error beside it. CSV: family, method, setting, time in us (median over rounds in which all take turns),
 * error of the gap relative to L + |c| (p50, p99, worst), error of the normal in rad (p50), share of the pairs not
 * answered or answered as touching where they are apart. `receipt`: what an answer's own check adds to it, over the
 * whole.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/tolerances.h"
#include "gap/gap_core.h"
#include "gap/gap_solver.h"
#include "../tests/kit/contact_random.h"
#include "peers_gap.h"
#include "measure.h"

enum { PAIRS = 2000, REPEATS = 5, MOST_CONTESTANTS = 20 };

static int pair_count(void)
{
    static int count;
    if (count == 0) count = measure_count(PAIRS);
    return count;
}

/* Whether the nearest way out is another than the one constructed: the support functions along a normal found say so.
 */
static bool has_nearer(const gap_case *c)
{
    impact_contact contact;
    if (impact_gap(&c->body[0], &c->body[1], NULL, &contact) < 0) return false;
    const qvec3 n = contact.normal,
                d = qvec3_add(qvec3_sub(c->body[0].position, c->body[1].position),
                              qvec3_sub(contact_support(&c->body[0], qvec3_neg(n)), contact_support(&c->body[1], n)));
    return qvec3_dot(n, d) > c->gap + 4e-15 * c->reach;
}

/* Separated pairs (relative gap 1e-4 to 1) or, overlap true, overlaps of depth 1e-9 to 1e-4 of the thinnest axis. */
static void make_pairs(gap_case *cases, int family, bool overlap)
{
    random_stream random = {(uint64_t)family + 100};
    for (int i = 0; i < pair_count(); i++) {
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
        const qvec3 x1 = contact_support(&c->body[0], qvec3_neg(c->normal)),
                    x2 = contact_support(&c->body[1], c->normal);
        c->body[0].position = qvec3_axpy(c->gap, c->normal, qvec3_sub(x2, x1));
        c->reach = size + qvec3_norm(c->body[0].position);
        if (overlap && has_nearer(c)) {
            i--;
            continue;
        }
        c->cache = (impact_gap_cache){true, qvec3_axpy(1e-3, random_direction(&random), c->normal)};
        c->number = i;
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

/* ---- who answers the pairs of a family ---- */

typedef struct contestant {
    const gap_peer *peer;
    double times[REPEATS];
    int answered;
} contestant;

typedef struct contest {
    contestant list[MOST_CONTESTANTS];
    int count;
} contest;

static bool answers(const gap_peer *peer, int family, bool overlap)
{
    const bool ellipsoids = family <= RANDOM_ELLIPSOID;
    switch (peer->pairs) {
    case GAP_ALL: return true;
    case GAP_OVERLAPS: return overlap;
    case GAP_ELLIPSOIDS: return ellipsoids;
    default: return ellipsoids && !overlap;
    }
}

static void join(contest *c, const gap_peer *peer, int family, bool overlap, const gap_case *cases)
{
    for (; peer->method; peer++)
        if (answers(peer, family, overlap) && (!peer->load || peer->load(cases, pair_count())))
            c->list[c->count++] = (contestant){.peer = peer};
}

/* A round of a contestant: the mean time of a pair, us. */
static double time_round(contestant *one, const gap_case *cases)
{
    double gap;
    qvec3 normal;
    const double start = measure_clock();
    one->answered = 0;
    for (int i = 0; i < pair_count(); i++)
        one->answered += one->peer->method(&cases[i], one->peer->setting, &gap, &normal);
    return measure_since(start) / pair_count() * 1e6;
}

/* Errors, and the sum of all gaps. */
static void print_contestant(const char *family, const char *kind, contestant *one, const gap_case *cases, double ours)
{
    static double gaps[PAIRS], normals[PAIRS];
    int gap_count = 0, normal_count = 0;
    double sum = 0;
    for (int i = 0; i < pair_count(); i++) {
        double gap = NAN;
        qvec3 normal = {NAN, NAN, NAN};
        if (!one->peer->method(&cases[i], one->peer->setting, &gap, &normal)) continue;
        if (!isnan(gap)) sum += gap, gaps[gap_count++] = fabs(gap - cases[i].gap) / cases[i].reach;
        if (!isnan(normal.x)) normals[normal_count++] = qvec3_norm(qvec3_sub(normal, cases[i].normal));
    }
    const measure_time time = measure_of_rounds(one->times, REPEATS);
    const double p50 = measure_quantile(gaps, gap_count, 0.5), p99 = measure_quantile(gaps, gap_count, 0.99);
    printf("%s,%s,%s,%g,%.3g,%.2g,%.2g,%.2g,%.2g,%.4f,%.2g,%.2f,%.9g\n", family, kind, one->peer->name,
           one->peer->setting, time.median, p50, p99, gap_count ? gaps[gap_count - 1] : NAN,
           measure_quantile(normals, normal_count, 0.5), 1 - (double)one->answered / pair_count(), time.median / ours,
           time.spread, sum);
    fflush(stdout);
}

/* All in turn, round after round; returns the median time of ours from nothing, the first. */
static double compete(const char *family, const char *kind, contest *c, const gap_case *cases)
{
    for (int repeat = 0; repeat < REPEATS; repeat++)
        for (int k = 0; k < c->count; k++) c->list[k].times[repeat] = time_round(&c->list[k], cases);
    const double ours = measure_of_rounds(c->list[0].times, REPEATS).median;
    for (int k = 0; k < c->count; k++) print_contestant(family, kind, &c->list[k], cases, ours);
    return ours;
}

/* Whether both witness points lie in their bodies: the part of an answer that is there for its check alone. Of two
 * spheres nothing is checked, and of polytopes bounds that their gap comes with. */
static void measure_receipt(const char *family, const char *kind, const gap_case *cases, double ours)
{
    static imp_gap_solids pairs[PAIRS];
    static double points[PAIRS][2][3], times[REPEATS];
    int outside = 0;
    if (cases[0].body[0].shape.kind == IMPACT_SPHERE && cases[0].body[1].shape.kind == IMPACT_SPHERE) return;
    for (int i = 0; i < pair_count(); i++) {
        const impact_solid *one = &cases[i].body[0], *two = &cases[i].body[1];
        const double scale = imp_gap_scale(one, two);
        impact_contact c;
        if (impact_gap(one, two, NULL, &c) != IMPACT_OK) c.offset1 = c.offset2 = (qvec3){0, 0, 0};
        imp_gap_pair(one, one->orientation, two, two->orientation, scale, &pairs[i]);
        const qvec3 x[2] = {c.offset2, c.offset1};
        for (int k = 0; k < 2; k++) {
            const double at[3] = {scale * x[k].x, scale * x[k].y, scale * x[k].z};
            memcpy(points[i][k], at, sizeof at);
        }
    }
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        const double start = measure_clock();
        for (int i = 0; i < pair_count(); i++)
            for (int k = 0; k < 2; k++)
                if (!imp_core_takes(&cases[i].body[0].shape, &cases[i].body[1].shape))
                    outside += !imp_gap_holds(&pairs[i].form[k], points[i][k], IMP_GAP_OUTSIDE * pairs[i].reach);
        times[repeat] = measure_since(start) / pair_count() * 1e6;
    }
    const measure_time time = measure_of_rounds(times, REPEATS);
    printf("%s,%s,impact receipt,0,%.3g,nan,nan,nan,nan,%.2g,%.2g,%.2f,\n", family, kind, time.median,
           (double)outside / (2 * REPEATS * pair_count()), time.median / ours, time.spread);
}

static void name_absent(void)
{
    const struct {
        const char *name;
        const gap_peer *list;
    } peers[] = {
        {"libccd", gap_peers_ccd}, {"FCL", gap_peers_fcl}, {"coal", gap_peers_coal}, {"MuJoCo", gap_peers_mujoco}};
    for (int k = 0; k < 4; k++)
        if (!peers[k].list[0].method) printf("# %s is not installed: its rows are skipped\n", peers[k].name);
}

int main(void)
{
    static gap_case cases[PAIRS];
    const gap_peer own[] = {{"impact cold", ours_cold, 0, GAP_ALL, NULL},
                            {"impact warm", ours_warm, 0, GAP_ALL, NULL},
                            {NULL, NULL, 0, GAP_ALL, NULL}};
    const gap_peer *const all[] = {own, gap_peers_ccd, gap_peers_fcl, gap_peers_coal, gap_peers_mujoco};
    name_absent();
    printf("family,kind,method,setting,time_us,gap_p50,gap_p99,gap_worst,normal_p50,unanswered,time_over_ours,spread,"
           "checksum\n");
    for (int overlap = 0; overlap < 2; overlap++)
        for (int family = 0; family < RANDOM_FAMILIES; family++) {
            static contest c;
            const char *name = random_family_name(family), *kind = overlap ? "shallow" : "separated";
            make_pairs(cases, family, overlap);
            c.count = 0;
            for (int k = 0; k < 5; k++) join(&c, all[k], family, overlap, cases);
            measure_receipt(name, kind, cases, compete(name, kind, &c, cases));
        }
    fflush(stdout);
    _Exit(
        0); /* FCL and coal bring an octomap each, whose statics have the same names: both free them at a proper exit */
}
