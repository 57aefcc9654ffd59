/* SPDX-License-Identifier: MIT
 *
 * bench_faces: time per query of shapes with faces, and of libccd's on the same pairs.
 * CSV: family, kind (apart, overlapping), method, time in us (median over repeats of a batch), share of the pairs not
 * answered (ours: a status that is not ok; libccd's GJK: a wrong yes or no; EPA: no answer), error of the gap over
 * L + |c| against ours (p50, worst; EPA's overlaps).
 */
#include <stdio.h>
#include <stdlib.h>
#include "../tests/kit/face_pairs.h"
#include "../tests/kit/mixed_pairs.h"
#include "measure.h"
#include "peers_gap.h"

enum { PAIRS = 2000, REPEATS = 5 };

static bool ours_cold(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    (void)setting;
    impact_contact contact;
    const impact_status status = impact_gap(&c->body[0], &c->body[1], NULL, &contact);
    *gap = contact.gap, *normal = contact.normal;
    return status == IMPACT_OK;
}

/* From the normal of the same pair. */
static bool ours_warm(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    (void)setting;
    impact_contact contact;
    impact_gap_cache cache = c->cache;
    const impact_status status = impact_gap(&c->body[0], &c->body[1], &cache, &contact);
    *gap = contact.gap, *normal = contact.normal;
    return status == IMPACT_OK;
}

static void measure(const char *family, const char *kind, const char *name, double setting, gap_method *method,
                    const gap_case *cases, int count)
{
    static double times[REPEATS], errors[PAIRS];
    int answered = 0, told = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        const double start = measure_clock();
        double gap;
        qvec3 normal;
        answered = 0;
        for (int i = 0; i < count; i++) answered += method(&cases[i], setting, &gap, &normal);
        times[repeat] = measure_since(start) / count * 1e6;
    }
    for (int i = 0; i < count; i++) {
        double gap = NAN;
        qvec3 normal;
        if (method(&cases[i], setting, &gap, &normal) && !isnan(gap))
            errors[told++] = fabs(gap - cases[i].gap) / cases[i].reach;
    }
    const double time = measure_quantile(times, REPEATS, 0.5), p50 = measure_quantile(errors, told, 0.5);
    printf("%s,%s,%s,%g,%.3g,%.4f,%.2g,%.2g\n", family, kind, name, setting, time, 1 - (double)answered / count, p50,
           told ? errors[told - 1] : NAN);
    fflush(stdout);
}

/* The pairs of one sign, their truth ours. */
static int sort_out(const impact_solid (*all)[2], int count, bool overlap, gap_case *cases)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        impact_contact contact;
        if (impact_gap(&all[i][0], &all[i][1], NULL, &contact) != IMPACT_OK || (contact.gap < 0) != overlap) continue;
        cases[kept++] = (gap_case){.body = {all[i][0], all[i][1]},
                                   .gap = contact.gap,
                                   .normal = contact.normal,
                                   .reach = fmax(contact_size(&all[i][0].shape), contact_size(&all[i][1].shape)) +
                                            qvec3_norm(qvec3_sub(all[i][0].position, all[i][1].position)),
                                   .cache = {true, contact.normal}};
    }
    return kept;
}

static void measure_family(const char *family, const impact_solid (*all)[2])
{
    static gap_case cases[PAIRS];
    for (int overlap = 0; overlap < 2; overlap++) {
        const char *kind = overlap ? "overlapping" : "apart";
        const int count = sort_out(all, PAIRS, overlap, cases);
        if (count < PAIRS / 20) continue;
        measure(family, kind, "impact cold", 0, ours_cold, cases, count);
        measure(family, kind, "impact warm", 0, ours_warm, cases, count);
        for (const gap_peer *peer = gap_peers_ccd; peer->method; peer++)
            if (overlap || peer->pairs == GAP_ALL)
                measure(family, kind, peer->name, peer->setting, peer->method, cases, count);
    }
}

int main(void)
{
    static impact_solid all[PAIRS][2];
    static face_pair faces[PAIRS];
    static mixed_pair mixed[PAIRS];
    printf("family,kind,method,setting,time_us,unanswered,gap_p50,gap_worst\n");
    for (int family = 0; family < PAIR_FAMILIES; family++) {
        random_stream random = {(uint64_t)family + 300};
        for (int i = 0; i < PAIRS; i++) {
            faces[i] = random_face_pair(&random, family);
            for (int k = 0; k < 2; k++) all[i][k] = faces[i].body[k];
        }
        measure_family(pair_family_name(family), (const impact_solid(*)[2])all);
        for (int i = 0; i < PAIRS; i++) end_face_pair(&faces[i]);
    }
    for (int family = 0; family < MIXED_FAMILIES; family++) {
        random_stream random = {(uint64_t)family + 400};
        for (int i = 0; i < PAIRS; i++) {
            const double gap = random_log(&random, 1e-6, 1);
            mixed[i] = random_mixed_pair(&random, family, i % 2 ? gap : -1e-3 * gap);
            for (int k = 0; k < 2; k++) all[i][k] = mixed[i].body[k];
        }
        measure_family(mixed_family_name(family), (const impact_solid(*)[2])all);
        for (int i = 0; i < PAIRS; i++) end_mixed_pair(&mixed[i]);
    }
    if (!gap_peers_ccd[0].method) printf("# libccd is not installed: its rows are skipped\n");
    return 0;
}
