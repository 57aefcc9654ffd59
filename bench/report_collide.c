/* SPDX-License-Identifier: MIT
 *
 * report_collide: the campaign of the room collide over random impacts of every class.
 *
 * report_collide [--impacts N] [--seed S] [--threads T] [--cvode N] [--oracle N]
 * CSV, one row per class: how many impacts, how many failed (a status below 0, or a NaN), what happened in them; the worst energy
 * gain over the energy before (Poisson and Stronge), the worst distance outside of the friction cone over |P|, the median and worst
 * disagreement with CVODE at 1e-12 on N impacts, the median and worst error against the 128-bit oracle on N impacts (in units of
 * eps cond too), and the time of one call
 * in microseconds (the mean leaves out what took above 200: another program had the core). Every figure but the times depends on the seed alone, not on the threads.
 */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "../tests/generators/collide_cases.h"
#ifdef HAVE_QUADMATH
#include "../tests/generators/collide_oracle.h"
#endif

enum { BINS = 400, PER_DECADE = 16 };

/* Bins of a sixteenth of a decade from 1e-19. */
typedef struct spread {
    long count, bin[BINS];
    double worst;
} spread;

typedef struct tally {
    long impacts, failures, slips, sticks, reversals, jams, again, newton_gains;
    double gain, cone;
    spread cvode, oracle, oracle_scaled, time;
    long cvode_failures;
    double time_sum; /* of the calls that nothing interrupted */
    long time_count;
} tally;

typedef struct job {
    pthread_t thread;
    int number, threads;
    long impacts, cvode, oracle;
    uint64_t seed;
    tally tally[CASE_CLASSES];
    impact_collide_workspace *workspace;
} job;

static void note(spread *s, double value)
{
    int bin = value > 0 ? (int)(PER_DECADE * (log10(value) + 19)) : 0;
    bin = bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
    s->bin[bin]++;
    s->count++;
    if (!(value <= s->worst)) s->worst = value;
}

static double quantile(const spread *s, double q)
{
    long seen = 0;
    for (int i = 0; i < BINS; i++) {
        seen += s->bin[i];
        if (seen > 0 && (double)seen >= q * (double)s->count) return i == 0 ? 0 : pow(10, (i + 1.0) / PER_DECADE - 19);
    }
    return s->count ? s->worst : NAN;
}

static void merge_spread(spread *into, const spread *from)
{
    for (int i = 0; i < BINS; i++) into->bin[i] += from->bin[i];
    into->count += from->count;
    if (!(from->worst <= into->worst)) into->worst = from->worst;
}

static void merge(tally *into, const tally *from)
{
    into->impacts += from->impacts;
    into->failures += from->failures;
    into->slips += from->slips;
    into->sticks += from->sticks;
    into->reversals += from->reversals;
    into->jams += from->jams;
    into->again += from->again;
    into->newton_gains += from->newton_gains;
    into->gain = fmax(into->gain, from->gain);
    into->cone = fmax(into->cone, from->cone);
    into->cvode_failures += from->cvode_failures;
    into->time_sum += from->time_sum;
    into->time_count += from->time_count;
    merge_spread(&into->cvode, &from->cvode);
    merge_spread(&into->oracle, &from->oracle);
    merge_spread(&into->oracle_scaled, &from->oracle_scaled);
    merge_spread(&into->time, &from->time);
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static bool all_finite(const impact_outcome *o)
{
    double sum = 0;
    for (int i = 0; i < 2; i++)
        sum += o->velocity[i].x + o->velocity[i].y + o->velocity[i].z + o->omega[i].x + o->omega[i].y + o->omega[i].z;
    sum +=
        o->impulse.x + o->impulse.y + o->impulse.z + o->impulse_normal + o->impulse_tangential + o->compression_impulse;
    return isfinite(sum + o->work_compression + o->work_restitution + o->work_friction + o->energy_after +
                    o->normal_after);
}

/* How far the impulse stands outside of the friction cone, over |P|. */
static double outside_cone(const impact_collision *c, const impact_outcome *o)
{
    const double n = qvec3_norm(c->normal), p = qvec3_dot(o->impulse, c->normal) / n;
    const qvec3 t = qvec3_axpy(-p / n, c->normal, o->impulse);
    return (qvec3_norm(t) - c->friction * p) / (qvec3_norm(o->impulse) * sqrt(1 + c->friction * c->friction));
}

static void count_phases(tally *t, const impact_outcome *o)
{
    bool stick = false, reversal = false;
    for (int i = 0; i < o->phase_count; i++) {
        stick = stick || o->phases[i] == IMPACT_STICK_C || o->phases[i] == IMPACT_STICK_R;
        reversal = reversal || o->phases[i] == IMPACT_REVERSAL;
    }
    t->slips += !stick && !reversal;
    t->sticks += stick;
    t->reversals += reversal;
    t->jams += o->jammed;
    t->again += o->compressions > 1;
}

static void against_cvode(job *j, tally *t, impact_collision c, const impact_outcome *o)
{
    impact_outcome other;
    c.solver = IMPACT_SOLVER_CVODE;
    c.workspace = j->workspace;
    if (impact_collide(&c, &other) != IMPACT_OK) {
        t->cvode_failures++;
        return;
    }
    note(&t->cvode, case_error(&c, o->velocity, o->omega, other.velocity, other.omega));
}

static void against_oracle(tally *t, const impact_collision *c, const impact_outcome *o)
{
#ifdef HAVE_QUADMATH
    oracle_outcome wanted;
    if (!oracle_collide(c, &wanted)) return;
    const double error = case_error(c, o->velocity, o->omega, wanted.velocity, wanted.omega);
    note(&t->oracle, error);
    note(&t->oracle_scaled, error / (0x1p-52 * o->conditioning));
#else
    (void)t, (void)c, (void)o;
#endif
}

static void one(job *j, case_class class_, long index)
{
    tally *t = &j->tally[class_];
    const impact_collision c = case_make(class_, j->seed, (uint64_t)index);
    impact_outcome o;
    const double from = seconds();
    const impact_status status = impact_collide(&c, &o);
    const double time = seconds() - from;
    note(&t->time, time);
    if (time < 2e-4) {
        t->time_sum += time;
        t->time_count++;
    }
    t->impacts++;
    if (status != IMPACT_OK || !all_finite(&o)) {
        t->failures++;
        fprintf(stderr, "%s %ld: %s\n", case_name(class_), index, impact_status_string(status));
        return;
    }
    count_phases(t, &o);
    const double gain = (o.energy_after - o.energy_before) / o.energy_before;
    if (c.law == IMPACT_NEWTON)
        t->newton_gains += o.energy_rose;
    else
        t->gain = fmax(t->gain, gain);
    t->cone = fmax(t->cone, outside_cone(&c, &o));
    if (j->workspace && j->cvode > 0 && index % j->cvode == 0) against_cvode(j, t, c, &o);
    if (j->oracle > 0 && index % j->oracle == 0) against_oracle(t, &c, &o);
}

static void *work(void *context)
{
    job *j = context;
    impact_collide_workspace_create(IMPACT_ODE_ADAMS, 1e-12, &j->workspace);
    for (int k = 0; k < CASE_CLASSES; k++) {
        j->tally[k].gain = j->tally[k].cone = -INFINITY;
        for (long i = j->number; i < j->impacts / CASE_CLASSES; i += j->threads) one(j, (case_class)k, i);
    }
    impact_collide_workspace_destroy(j->workspace);
    return NULL;
}

static void print_row(const char *name, const tally *t)
{
    printf("%s,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%.2g,%.2g,%ld,", name, t->impacts, t->failures, t->slips, t->sticks,
           t->reversals, t->jams, t->again, t->gain, t->cone, t->newton_gains);
    printf("%ld,%ld,%.2g,%.2g,", t->cvode.count, t->cvode_failures, quantile(&t->cvode, 0.5), t->cvode.worst);
    printf("%ld,%.2g,%.2g,%.2g,", t->oracle.count, quantile(&t->oracle, 0.5), t->oracle.worst, t->oracle_scaled.worst);
    printf("%.2g,%.2g,%.2g,%.2g\n", 1e6 * t->time_sum / (double)t->time_count, 1e6 * quantile(&t->time, 0.5),
           1e6 * quantile(&t->time, 0.99), 1e6 * t->time.worst);
}

/* The number after the option's name, or -1. */
static long option(int argc, char **argv, const char *name, long fallback)
{
    for (int i = 1; i + 1 < argc; i += 2)
        if (strcmp(argv[i], name) == 0) {
            char *end;
            const long value = strtol(argv[i + 1], &end, 10);
            return *end == '\0' && value >= 0 ? value : -1;
        }
    return fallback;
}

static bool known(int argc, char **argv)
{
    static const char *const names[] = {"--impacts", "--seed", "--threads", "--cvode", "--oracle"};
    if (argc % 2 == 0) return false;
    for (int i = 1; i < argc; i += 2) {
        bool found = false;
        for (size_t k = 0; k < sizeof names / sizeof *names; k++) found = found || strcmp(argv[i], names[k]) == 0;
        if (!found) return false;
    }
    return true;
}

static job jobs[64];

int main(int argc, char **argv)
{
    const long impacts = option(argc, argv, "--impacts", 1000000), seed = option(argc, argv, "--seed", 1);
    const long threads = option(argc, argv, "--threads", 4), cvode = option(argc, argv, "--cvode", 7000);
    const long oracle = option(argc, argv, "--oracle", 140);
    if (!known(argc, argv) || impacts < CASE_CLASSES || seed < 0 || threads < 1 || threads > 64 || cvode < 0 ||
        oracle < 0) {
        fprintf(stderr, "report_collide [--impacts N] [--seed S] [--threads 1 ... 64] [--cvode N] [--oracle N]\n");
        return 2;
    }
    for (int i = 0; i < threads; i++) {
        jobs[i] = (job){.number = i, .threads = (int)threads, .impacts = impacts, .seed = (uint64_t)seed};
        /* Every n-th impact, so that about so many are compared in all. */
        jobs[i].cvode = cvode > 0 ? (impacts + cvode - 1) / cvode : 0;
        jobs[i].oracle = oracle > 0 ? (impacts + oracle - 1) / oracle : 0;
        if (pthread_create(&jobs[i].thread, NULL, work, &jobs[i]) != 0) return 1;
    }
    printf("class,impacts,failures,slip,stick,reversal,jam,recompression,worst_gain,worst_cone,newton_gains,"
           "cvode_compared,cvode_failures,cvode_median,cvode_worst,oracle_compared,oracle_median,oracle_worst,oracle_"
           "worst_eps_cond,"
           "us_mean,us_p50,us_p99,us_max\n");
    static tally total;
    total.gain = total.cone = -INFINITY;
    for (int i = 0; i < threads; i++) pthread_join(jobs[i].thread, NULL);
    for (int k = 0; k < CASE_CLASSES; k++) {
        for (int i = 1; i < threads; i++) merge(&jobs[0].tally[k], &jobs[i].tally[k]);
        print_row(case_name((case_class)k), &jobs[0].tally[k]);
        merge(&total, &jobs[0].tally[k]);
    }
    print_row("all", &total);
    return total.failures > 0;
}
