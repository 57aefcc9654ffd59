/* SPDX-License-Identifier: MIT
 *
 * report_faces: the accuracy campaign of shapes with faces.
 *
 * report_faces [--pairs N] [--seed S]
 * CSV: one row per family, of N pairs each (a tenth of them where all features are many). Polytopes against all of
 * their features in 113-bit arithmetic; mixed pairs, apart, against a gap by construction. Errors over L + |c|, of the
 * answers with status ok. flagged: another status. wrong: ok and off by more than 4e-15, of mixed pairs 1e-14, or a
 * residual above 20 eps.
 */
#include <stdio.h>
#include <stdlib.h>
#include "../tests/kit/face_pairs.h"
#include "../tests/kit/mixed_pairs.h"
#include "options.h"
#ifdef HAVE_QUADMATH
#include "faces_oracle.h"
#endif

typedef struct tally {
    long pairs, overlapping, flagged, wrong, count;
    double apart, overlap, *errors;
} tally;

static int by_size(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

static void note(tally *t, const impact_solid body[2], impact_status status, const impact_contact *contact, double gap,
                 double error, double bar)
{
    t->pairs++;
    t->overlapping += gap < 0;
    if (status != IMPACT_OK) {
        t->flagged++;
        return;
    }
    double *worst = gap < 0 ? &t->overlap : &t->apart;
    *worst = fmax(*worst, error);
    t->errors[t->count++] = error;
    t->wrong += !(error <= bar) || !(impact_gap_receipt(&body[0], &body[1], contact, NULL) <= 20);
}

static void print(const char *kind, const char *family, tally *t)
{
    qsort(t->errors, (size_t)t->count, sizeof *t->errors, by_size);
    printf("%s,%s,%ld,%ld,%.2g,%.2g,%.2g,%.2g,%ld,%ld\n", kind, family, t->pairs, t->overlapping,
           t->errors[t->count / 2], t->errors[(long)(0.999 * (double)t->count)], t->apart, t->overlap, t->flagged,
           t->wrong);
    fflush(stdout);
}

#ifdef HAVE_QUADMATH
static void polytopes(long pairs, random_stream *random, double *errors)
{
    for (int family = 0; family < PAIR_FAMILIES; family++) {
        tally t = {.errors = errors};
        const long count = family < PAIR_HULLS ? pairs : pairs / 10 + 1;
        for (long i = 0; i < count; i++) {
            face_pair pair = random_face_pair(random, family);
            impact_contact contact;
            const impact_status status = impact_gap(&pair.body[0], &pair.body[1], NULL, &contact);
            const double gap = faces_oracle_gap(&pair.body[0], &pair.body[1]);
            note(&t, pair.body, status, &contact, gap, faces_oracle_error(&pair.body[0], &pair.body[1], &contact, gap),
                 4e-15);
            end_face_pair(&pair);
        }
        print("polytopes", pair_family_name(family), &t);
    }
}
#endif

static void mixed(long pairs, random_stream *random, double *errors)
{
    for (int family = 0; family < MIXED_FAMILIES; family++) {
        tally t = {.errors = errors};
        for (long i = 0; i < pairs; i++) {
            mixed_pair pair = random_mixed_pair(random, family, random_log(random, 1e-8, 1));
            impact_contact contact;
            const impact_status status = impact_gap(&pair.body[0], &pair.body[1], NULL, &contact);
            note(&t, pair.body, status, &contact, pair.gap, fabs(contact.gap - pair.gap) / pair.reach, 1e-14);
            end_mixed_pair(&pair);
        }
        print("mixed", mixed_family_name(family), &t);
    }
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"--pairs", "--seed", NULL};
    const long pairs = options_known(argc, argv, names) ? options_count(argc, argv, "--pairs", 1000) : -1;
    const long seed = options_count(argc, argv, "--seed", 1);
    if (pairs < 1 || seed < 0) {
        fprintf(stderr, "usage: report_faces [--pairs N] [--seed S]\n");
        return 2;
    }
    random_stream random = {(uint64_t)seed};
    double *errors = malloc((size_t)pairs * sizeof *errors);
    if (!errors) return 1;
    printf("kind,family,pairs,overlapping,p50,p999,worst_apart,worst_overlap,flagged,wrong\n");
#ifdef HAVE_QUADMATH
    polytopes(pairs, &random, errors);
#else
    printf("# no 128-bit arithmetic: polytopes are left out\n");
#endif
    mixed(pairs, &random, errors);
    free(errors);
    return 0;
}
