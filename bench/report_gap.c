/* SPDX-License-Identifier: MIT
 *
 * report_gap: the accuracy campaign of the gap. Truth by construction: choose two shapes, their orientations, the
 * normal and the gap; support points then say where the second body stands.
 *
 * report_gap [--pairs N] [--seed S] [--threads T] [--family NAME]
 * CSV: one row per family of pairs and sign of the gap; errors relative to L + |c|, normals in rad, of the answers with
 * status ok, nan where there was none. flagged: another status (a bracket, or deep). wrong: status ok and off by more
 * than 1e-13. nearer: overlaps whose nearest way out is another than the one constructed. skipped: constructions
 * dropped before the gap was asked for, their truth not being known; not among the pairs. Deep overlaps, a tenth of the
 * pairs, have no truth by construction: their gap_ columns are the bracket's width over the depth, whatever the status;
 * wrong: a residual over 20 eps, or one of 200 normals along which the bodies overlap less than the bracket allows.
 */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include "../tests/kit/contact_random.h"

enum { BINS = 400, MIXTURE = RANDOM_FAMILIES, FAMILIES = RANDOM_FAMILIES + 1, SIGNS = 4, DEEP = 3, NORMALS = 200 };

static const char *const sign_name[SIGNS] = {"separated", "touching", "shallow overlap", "deep overlap"};

/* Bins of a twentieth of a decade from 1e-19. */
typedef struct errors {
    long count, bin[BINS];
    double worst;
} errors;

typedef struct tally {
    errors gap, normal;
    long pairs, flagged, wrong, nearer, skipped, paths[IMPACT_PATH_FALLBACK + 1];
} tally;

typedef struct job {
    pthread_t thread;
    long pairs;
    uint64_t seed;
    int only;
    tally tally[FAMILIES][SIGNS];
} job;

static void note(errors *e, double error)
{
    int bin = error > 0 ? (int)(20 * (log10(error) + 19)) : 0;
    bin = bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
    e->bin[bin]++;
    e->count++;
    e->worst = fmax(e->worst, error);
}

static double quantile(const errors *e, double q)
{
    long seen = 0;
    if (e->count == 0) return NAN;
    for (int i = 0; i < BINS; i++) {
        seen += e->bin[i];
        if ((double)seen >= q * (double)e->count) return i == 0 ? 0 : pow(10, (i + 1) / 20.0 - 19);
    }
    return e->worst;
}

static void merge(errors *into, const errors *from)
{
    for (int i = 0; i < BINS; i++) into->bin[i] += from->bin[i];
    into->count += from->count;
    into->worst = fmax(into->worst, from->worst);
}

/* g(n): a lower bound of the gap for every n. */
static double gap_along(const impact_solid body[2], qvec3 n)
{
    const qvec3 d = qvec3_add(qvec3_sub(body[0].position, body[1].position),
                              qvec3_sub(contact_support(&body[0], qvec3_neg(n)), contact_support(&body[1], n)));
    return qvec3_dot(n, d);
}

/* The second body's centre within one and a half of the thinnest semi-axis of the first's. */
static void deep_pair(random_stream *random, impact_solid body[2], double thin, tally *t)
{
    impact_contact c;
    body[0].position = random_vector(random, 1e-3 * thin, 1.5 * thin);
    const impact_status status = impact_gap(&body[0], &body[1], NULL, &c);
    if (!(c.upper < -1e-3 * thin)) {
        t->skipped++;
        return;
    }
    const double reach =
        fmax(contact_size(&body[0].shape), contact_size(&body[1].shape)) + qvec3_norm(body[0].position);
    bool wrong = status != IMPACT_BRACKET && !(impact_gap_receipt(&body[0], &body[1], &c, NULL) <= 20);
    for (int i = 0; i < NORMALS; i++) {
        const qvec3 n = i % 2 ? random_direction(random)
                              : qvec3_axpy(random_log(random, 1e-6, 1), random_direction(random), c.normal);
        wrong = wrong || !(gap_along(body, qvec3_scale(n, 1 / qvec3_norm(n))) <= c.upper + 2e-14 * reach);
    }
    t->pairs++;
    t->paths[c.path]++;
    t->flagged += status != IMPACT_OK;
    t->wrong += wrong;
    note(&t->gap, (c.upper - c.lower) / -c.gap);
}

static void one_pair(random_stream *random, int family, tally tallies[SIGNS])
{
    impact_solid body[2] = {{.position = {0, 0, 0}}, {.position = {0, 0, 0}}};
    for (int k = 0; k < 2; k++) {
        body[k].shape = random_shape(random, family == MIXTURE ? (int)(random_bits(random) % RANDOM_FAMILIES) : family);
        body[k].orientation = random_rotation(random);
    }
    const qvec3 normal = random_direction(random);
    const double size = fmax(contact_size(&body[0].shape), contact_size(&body[1].shape));
    const double kind = random_unit(random);
    const int sign = kind < 0.6 ? 0 : kind < 0.8 ? 1 : 2;
    /* shallow: to 1e-4 of the smallest semi-axis, beyond which the construction is no more the deepest normal */
    double thin = size;
    for (int k = 0; k < 2; k++) thin = fmin(thin, fmin(body[k].shape.a, fmin(body[k].shape.b, body[k].shape.c)));
    const double gap = sign == 0   ? size * random_log(random, 1e-9, 100)
                       : sign == 1 ? 0
                                   : -thin * random_log(random, 1e-12, 1e-4);
    if (random_unit(random) < 0.1) {
        deep_pair(random, body, thin, &tallies[DEEP]);
        return;
    }
    tally *t = &tallies[sign];
    if (gap < 0 && !contact_is_deepest(body, normal, gap)) {
        t->skipped++; /* another normal is the nearer way out: no truth to be had */
        return;
    }
    body[0].position = qvec3_axpy(
        gap, normal, qvec3_sub(contact_support(&body[1], normal), contact_support(&body[0], qvec3_neg(normal))));

    impact_contact contact;
    const impact_status status = impact_gap(&body[0], &body[1], NULL, &contact);
    t->pairs++;
    t->paths[contact.path]++;
    if (status != IMPACT_OK) {
        t->flagged++;
        if (getenv("REPORT_FLAGGED"))
            printf("# flagged %d: %s, exponents %g %g %g | %g %g %g, axes %g %g %g | %g %g %g, gap %g got %g in [%g, "
                   "%g]\n",
                   status, random_family_name(family == MIXTURE ? 0 : family), body[0].shape.r, body[0].shape.s,
                   body[0].shape.t, body[1].shape.r, body[1].shape.s, body[1].shape.t, body[0].shape.a, body[0].shape.b,
                   body[0].shape.c, body[1].shape.a, body[1].shape.b, body[1].shape.c, gap, contact.gap, contact.lower,
                   contact.upper);
        return;
    }
    const double reach = size + qvec3_norm(body[0].position);
    const double along = gap_along(body, contact.normal);
    if (gap < 0 && along > gap + 4e-15 * reach && fabs(contact.gap - along) <= 4e-15 * reach) {
        t->nearer++; /* the way out that was constructed is not the nearest: the support functions bear the answer out
                      */
        return;
    }
    const double error = fabs(contact.gap - gap) / reach;
    note(&t->gap, error);
    note(&t->normal, qvec3_norm(qvec3_sub(contact.normal, normal)));
    if (!(error <= 1e-13)) {
        t->wrong++;
        if (getenv("REPORT_FLAGGED"))
            printf("# wrong: %s, exponents %g %g %g | %g %g %g, axes %g %g %g | %g %g %g, gap %g got %g path %d\n",
                   random_family_name(family == MIXTURE ? 0 : family), body[0].shape.r, body[0].shape.s,
                   body[0].shape.t, body[1].shape.r, body[1].shape.s, body[1].shape.t, body[0].shape.a, body[0].shape.b,
                   body[0].shape.c, body[1].shape.a, body[1].shape.b, body[1].shape.c, gap, contact.gap, contact.path);
    }
}

static void *work(void *argument)
{
    job *j = argument;
    random_stream random = {j->seed};
    for (long i = 0; i < j->pairs; i++) {
        const int family = j->only >= 0 ? j->only : (int)(i % FAMILIES);
        one_pair(&random, family, j->tally[family]);
    }
    return NULL;
}

static void print(const tally *t, const char *family, const char *sign)
{
    if (t->pairs + t->skipped == 0) return;
    printf("%s,%s,%ld,%.2g,%.2g,%.2g,%.2g,%.2g,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%ld\n", family, sign, t->pairs,
           quantile(&t->gap, 0.5), quantile(&t->gap, 0.99), t->gap.count ? t->gap.worst : NAN,
           quantile(&t->normal, 0.5), quantile(&t->normal, 0.99), t->flagged, t->wrong, t->nearer, t->skipped,
           t->paths[IMPACT_PATH_CLOSED_FORM], t->paths[IMPACT_PATH_NEWTON], t->paths[IMPACT_PATH_GJK],
           t->paths[IMPACT_PATH_FALLBACK]);
}

static void add(tally *into, const tally *from)
{
    merge(&into->gap, &from->gap);
    merge(&into->normal, &from->normal);
    into->pairs += from->pairs;
    into->flagged += from->flagged;
    into->wrong += from->wrong;
    into->nearer += from->nearer;
    into->skipped += from->skipped;
    for (int i = 0; i <= IMPACT_PATH_FALLBACK; i++) into->paths[i] += from->paths[i];
}

int main(int argc, char **argv)
{
    long pairs = 1200000, threads = 2;
    uint64_t seed = 1;
    int only = -1;
    for (int i = 1; i < argc; i++) {
        if (i + 1 < argc && strcmp(argv[i], "--pairs") == 0)
            pairs = atol(argv[++i]);
        else if (i + 1 < argc && strcmp(argv[i], "--seed") == 0)
            seed = strtoull(argv[++i], NULL, 10);
        else if (i + 1 < argc && strcmp(argv[i], "--threads") == 0)
            threads = atol(argv[++i]);
        else if (i + 1 < argc && strcmp(argv[i], "--family") == 0) {
            i++;
            for (int f = 0; f < RANDOM_FAMILIES; f++)
                if (strcmp(argv[i], random_family_name(f)) == 0) only = f;
            if (strcmp(argv[i], "mixture") == 0) only = MIXTURE;
        } else {
            fprintf(stderr, "usage: report_gap [--pairs N] [--seed S] [--threads T] [--family NAME]\n");
            return 2;
        }
    }
    if (pairs < 1 || threads < 1) return 2;
    job *jobs = calloc((size_t)threads, sizeof *jobs);
    tally *total = calloc(SIGNS, sizeof *total);
    if (!jobs || !total) return 1;
    for (long k = 0; k < threads; k++) {
        jobs[k].pairs = pairs / threads;
        random_stream seeds = {seed * 1000003u +
                               (uint64_t)k}; /* mixed: streams apart by a shift would repeat each other */
        jobs[k].seed = random_bits(&seeds);
        jobs[k].only = only;
        if (pthread_create(&jobs[k].thread, NULL, work, &jobs[k]) != 0) return 1;
    }
    for (long k = 0; k < threads; k++) pthread_join(jobs[k].thread, NULL);
    printf("family,kind,pairs,gap_p50,gap_p99,gap_worst,normal_p50,normal_p99,flagged,wrong,nearer,skipped,closed_form,"
           "newton,gjk,fallback\n");
    for (int f = 0; f < FAMILIES; f++)
        for (int sign = 0; sign < SIGNS; sign++) {
            tally *first = &jobs[0].tally[f][sign];
            for (long k = 1; k < threads; k++) add(first, &jobs[k].tally[f][sign]);
            add(&total[sign], first);
            print(first, f == MIXTURE ? "mixture" : random_family_name(f), sign_name[sign]);
        }
    for (int sign = 0; sign < SIGNS; sign++) print(&total[sign], "all", sign_name[sign]);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    printf("# seed %llu, %ld threads, largest resident set %ld kB\n", (unsigned long long)seed, threads,
           usage.ru_maxrss);
    free(jobs);
    free(total);
    return 0;
}
