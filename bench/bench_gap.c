/* SPDX-License-Identifier: MIT
 *
 * bench_gap: time per query of our ways and of libccd's, on the pairs of the campaign, with each way's error beside it.
 * CSV: family, method, setting, time in us (median of repeats of a batch), error of the gap relative to L + |c| (p50,
 * p99, worst), error of the normal in rad (p50), share of the pairs not answered or answered as touching where they are
 * apart. `receipt`: what an answer's own check adds to it, over the whole.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <impact/toi.h>
#include "gap/gap_solver.h"
#include "../tests/kit/contact_random.h"
#include "peers_gap.h"
#include "measure.h"

enum { PAIRS = 2000, REPEATS = 7 };

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

/* One row; ours: the time of ours from nothing, 0 where this is it. Returns the time. */
static double measure(const char *family, const char *kind, const char *name, gap_method *method, double setting,
                      const gap_case *cases, double ours)
{
    static double times[REPEATS], gaps[PAIRS], normals[PAIRS];
    int answered = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        answered = 0;
        double gap;
        qvec3 normal;
        const double start = measure_clock();
        for (int i = 0; i < pair_count(); i++) answered += method(&cases[i], setting, &gap, &normal);
        times[repeat] = (measure_clock() - start) / pair_count() * 1e6;
    }
    int gap_count = 0, normal_count = 0;
    for (int i = 0; i < pair_count(); i++) {
        double gap = NAN;
        qvec3 normal = {NAN, NAN, NAN};
        if (!method(&cases[i], setting, &gap, &normal)) continue;
        if (!isnan(gap)) gaps[gap_count++] = fabs(gap - cases[i].gap) / cases[i].reach;
        if (!isnan(normal.x)) normals[normal_count++] = qvec3_norm(qvec3_sub(normal, cases[i].normal));
    }
    const double time = measure_quantile(times, REPEATS, 0.5), p50 = measure_quantile(gaps, gap_count, 0.5),
                 p99 = measure_quantile(gaps, gap_count, 0.99);
    printf("%s,%s,%s,%g,%.3g,%.2g,%.2g,%.2g,%.2g,%.4f,%.2g\n", family, kind, name, setting, time, p50, p99,
           gap_count ? gaps[gap_count - 1] : NAN, measure_quantile(normals, normal_count, 0.5),
           1 - (double)answered / pair_count(), ours > 0 ? time / ours : 1);
    fflush(stdout);
    return time;
}

/* Whether both witness points lie in their bodies: the part of an answer that is there for its check alone. Of two
 * spheres nothing is checked. */
static void measure_receipt(const char *family, const char *kind, const gap_case *cases, double ours)
{
    static imp_gap_solids pairs[PAIRS];
    static double points[PAIRS][2][3], times[REPEATS];
    double outside = 0;
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
            for (int k = 0; k < 2; k++) outside = fmax(outside, imp_gap_outside(&pairs[i].form[k], points[i][k]));
        times[repeat] = (measure_clock() - start) / pair_count() * 1e6;
    }
    const double time = measure_quantile(times, REPEATS, 0.5);
    printf("%s,%s,impact receipt,0,%.3g,nan,nan,%.2g,nan,0,%.2g\n", family, kind, time, outside, time / ours);
}

/* Time of impact of tumbling bodies that fly at each other; the error is the gap left at the time found. */
static void measure_toi(void)
{
    static gap_case cases[PAIRS];
    static double times[REPEATS], left[PAIRS];
    for (int family = 0; family < RANDOM_FAMILIES; family++) {
        random_stream random = {(uint64_t)family + 200};
        make_pairs(cases, family, false);
        static impact_motion motion[PAIRS][2];
        for (int i = 0; i < pair_count(); i++) {
            cases[i].body[0].position = qvec3_scale(random_direction(&random), 4);
            for (int k = 0; k < 2; k++)
                motion[i][k] = (impact_motion){.omega = qvec3_scale(random_direction(&random), 3)};
            motion[i][0].velocity = qvec3_scale(cases[i].body[0].position, -0.25);
        }
        int met = 0;
        for (int repeat = 0; repeat < 3; repeat++) {
            met = 0;
            const double start = measure_clock();
            for (int i = 0; i < pair_count(); i++) {
                double time;
                impact_contact c;
                const impact_status status =
                    impact_toi(&cases[i].body[0], &motion[i][0], &cases[i].body[1], &motion[i][1], 4, &time, &c);
                if (status == IMPACT_OK)
                    left[met++] = fabs(c.gap) /
                                  fmax(contact_size(&cases[i].body[0].shape), contact_size(&cases[i].body[1].shape));
            }
            times[repeat] = (measure_clock() - start) / pair_count() * 1e6;
        }
        const double time = measure_quantile(times, 3, 0.5), p50 = measure_quantile(left, met, 0.5),
                     p99 = measure_quantile(left, met, 0.99);
        printf("%s,toi,impact toi,0,%.3g,%.2g,%.2g,%.2g,nan,%.4f,nan\n", random_family_name(family), time, p50, p99,
               left[met - 1], 1 - (double)met / pair_count());
    }
}

static void measure_peers(const char *family, const char *kind, const gap_peer *peer, int number, bool overlap,
                          const gap_case *cases, double ours)
{
    for (; peer->method; peer++) {
        if (peer->overlap_only && !overlap) continue;
        if (peer->separated_ellipsoids_only && (overlap || number > RANDOM_ELLIPSOID)) continue;
        measure(family, kind, peer->name, peer->method, peer->setting, cases, ours);
    }
}

/* The ellipsoid pairs for peers_gap.py: a b c, x y z, w i j k of both bodies, the gap, the normal, L + |c|. */
static void print_cases(void)
{
    static gap_case cases[PAIRS];
    make_pairs(cases, RANDOM_ELLIPSOID, false);
    for (int i = 0; i < pair_count(); i++) {
        for (int k = 0; k < 2; k++) {
            const impact_solid *b = &cases[i].body[k];
            printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,", b->shape.a, b->shape.b, b->shape.c,
                   b->position.x, b->position.y, b->position.z, b->orientation.w, b->orientation.x, b->orientation.y,
                   b->orientation.z);
        }
        const qvec3 n = cases[i].normal;
        printf("%.17g,%.17g,%.17g,%.17g,%.17g\n", cases[i].gap, n.x, n.y, n.z, cases[i].reach);
    }
}

/* bench_gap [--cases]: --cases prints the ellipsoid pairs and measures nothing. */
int main(int argc, char **argv)
{
    static gap_case cases[PAIRS];
    if (argc > 1 && strcmp(argv[1], "--cases") == 0) {
        print_cases();
        return 0;
    }
    printf("family,kind,method,setting,time_us,gap_p50,gap_p99,gap_worst,normal_p50,unanswered,time_over_ours\n");
    for (int overlap = 0; overlap < 2; overlap++)
        for (int family = 0; family < RANDOM_FAMILIES; family++) {
            const char *name = random_family_name(family), *kind = overlap ? "shallow" : "separated";
            make_pairs(cases, family, overlap);
            const double ours = measure(name, kind, "impact cold", ours_cold, 0, cases, 0);
            measure(name, kind, "impact warm", ours_warm, 0, cases, ours);
            measure_receipt(name, kind, cases, ours);
            measure_peers(name, kind, gap_peers_ccd, family, overlap, cases, ours);
            measure_peers(name, kind, gap_peers_fcl, family, overlap, cases, ours);
        }
    measure_toi();
    if (!gap_peers_ccd[0].method) printf("# libccd is not installed: its rows are skipped\n");
    if (!gap_peers_fcl[0].method) printf("# FCL is not installed: its rows are skipped\n");
    return 0;
}
