/* SPDX-License-Identifier: MIT
 *
 * report_collide: the campaign of the room collide over random impacts of every class.
 *
 * report_collide [--impacts N] [--seed S] [--threads T] [--cvode N] [--oracle N] [--range N]
 * N impacts in all, the classes in turn, on so many threads (by itself as many as there are cores); one in a hundred is
 * solved by CVODE at 1e-12 too and one in two hundred by the 128-bit oracle, or about as many as --cvode and --oracle
 * say. How far it is and how long it will yet take goes to stderr. Every figure but the times depends on N and the seed
 * alone.
 *
 * Beside the classes, a tenth as many slender and slippery impacts each, and --range N (by itself a thousandth) of
 * numbers within 1e+-3 ... 1e+-100, most of the time of which goes into 128 bits and CVODE.
 *
 * Four tables, CSV:
 * 1. per class: how many impacts, how many failed (a status below 0, or a NaN), what happened in them; the worst energy
 * gain over the energy before (Poisson and Stronge), the worst distance outside of the friction cone over |P|, Newton's
 * gains, and the time of one call in microseconds (the mean leaves out what took above 200: another program had the
 * core);
 * 2. per class and independent solver: quantiles of the error of the velocities, plain and in units of eps cond(M); how
 * many the other solver could not answer, how many are off by more than 1e-12 and more than 10 eps cond, and how many
 * of these by more than ten times the data's own error (see 3) as well;
 * 3. the worst of each class against the oracle: beside the error of ours, data_error is how far the exact answer
 * itself moves when the inputs change by at most one unit in the last place, the largest of 24 such changes;
 * 4. of the limits: how many were refused, answered, in 128 bits, soft (said so), unsettled; how many broke a promise
 * with IMPACT_OK: not finite, energy risen by more than 100 eps times the sensitivity, a receipt that fails; the worst
 * receipt and the longest call. In between all of it in words.
 */
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include "report_collide_extremes.h"
#include "report_collide_tally.h"
#include "measure.h"
#include "options.h"
#ifdef HAVE_QUADMATH
#include "../tests/generators/collide_oracle.h"
#endif

enum { CHUNK = 2000, MOST_THREADS = 256 };

typedef struct campaign {
    long each; /* impacts of a class */
    uint64_t seed;
    long cvode, oracle; /* every so many impacts of a class; 0: none */
    atomic_long chunk;  /* the next to be taken */
    atomic_long done;   /* impacts */
} campaign;

typedef struct job {
    pthread_t thread;
    campaign *all;
    tally tally[CASE_CLASSES];
    impact_collide_workspace *workspace;
} job;

/* ---- the data's own error ---- */

#ifdef HAVE_QUADMATH
static void nudge(double *value, uint64_t *g) { *value *= 1 + floor(3 * case_random(g) - 1) * 0x1p-52; }

static void nudge3(qvec3 *v, uint64_t *g)
{
    nudge(&v->x, g);
    nudge(&v->y, g);
    nudge(&v->z, g);
}

static impact_collision nudged(impact_collision c, uint64_t *g)
{
    for (int i = 0; i < 2; i++) {
        impact_collider *body = &c.body[i];
        if (isinf(body->mass)) continue;
        nudge(&body->mass, g);
        nudge3(&body->moments, g);
        nudge3(&body->offset, g);
        nudge3(&body->velocity, g);
        nudge3(&body->omega, g);
        nudge(&body->orientation.w, g);
        nudge(&body->orientation.x, g);
        nudge(&body->orientation.y, g);
        nudge(&body->orientation.z, g);
    }
    nudge3(&c.normal, g);
    nudge(&c.friction, g);
    if (c.restitution < 1) nudge(&c.restitution, g);
    return c;
}

/* How far the exact answer moves when the inputs change by at most one unit in the last place. */
static double data_error(const impact_collision *c)
{
    oracle_outcome exact, moved;
    uint64_t g = 1;
    double worst = 0;
    if (!oracle_collide(c, &exact)) return NAN;
    for (int i = 0; i < 24; i++) {
        const impact_collision other = nudged(*c, &g);
        if (oracle_collide(&other, &moved))
            worst = fmax(worst, case_error(c, moved.velocity, moved.omega, exact.velocity, exact.omega));
    }
    return worst;
}
#endif

/* ---- one impact ---- */

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

static void against_cvode(job *j, tally *t, impact_collision c, const impact_outcome *o)
{
    impact_outcome other;
    c.solver = IMPACT_SOLVER_CVODE;
    c.workspace = j->workspace;
    if (impact_collide(&c, &other) != IMPACT_OK)
        t->cvode.refused++;
    else
        comparison_note(&t->cvode, case_error(&c, o->velocity, o->omega, other.velocity, other.omega), o->conditioning);
}

static void against_oracle(tally *t, long index, const impact_collision *c, const impact_outcome *o)
{
#ifdef HAVE_QUADMATH
    oracle_outcome wanted;
    if (!oracle_collide(c, &wanted)) {
        t->oracle.refused++;
        return;
    }
    const double error = case_error(c, o->velocity, o->omega, wanted.velocity, wanted.omega);
    tally_oracle(t, index, error, o->conditioning);
    if (above_bar(error, o->conditioning) && !(error <= 10 * data_error(c))) t->oracle.above_data++;
#else
    (void)t, (void)index, (void)c, (void)o;
#endif
}

static void one(job *j, case_class class_, long index)
{
    const campaign *all = j->all;
    tally *t = &j->tally[class_];
    const impact_collision c = case_make(class_, all->seed, (uint64_t)index);
    impact_outcome o;
    const double from = measure_clock();
    const impact_status status = impact_collide(&c, &o);
    tally_time(t, measure_clock() - from);
    t->impacts++;
    if (status != IMPACT_OK || !all_finite(&o)) {
        t->failures++;
        fprintf(stderr, "%s %ld: %s\n", case_name(class_), index, impact_status_string(status));
        return;
    }
    tally_outcome(t, &c, &o);
    if (j->workspace && all->cvode > 0 && index % all->cvode == 0) against_cvode(j, t, c, &o);
    if (all->oracle > 0 && index % all->oracle == 0) against_oracle(t, index, &c, &o);
}

/* ---- all of them ---- */

/* Chunks go from class to class, so that what remains costs about what was done. */
static void *work(void *context)
{
    job *j = context;
    campaign *all = j->all;
    const long chunks = (all->each + CHUNK - 1) / CHUNK * CASE_CLASSES;
    impact_collide_workspace_create(IMPACT_ODE_ADAMS, 1e-12, &j->workspace);
    for (int k = 0; k < CASE_CLASSES; k++) tally_start(&j->tally[k]);
    for (long chunk; (chunk = atomic_fetch_add(&all->chunk, 1)) < chunks;) {
        const long from = chunk / CASE_CLASSES * CHUNK, to = from + CHUNK < all->each ? from + CHUNK : all->each;
        for (long i = from; i < to; i++) {
            one(j, (case_class)(chunk % CASE_CLASSES), i);
            atomic_fetch_add_explicit(&all->done, 1, memory_order_relaxed);
        }
    }
    impact_collide_workspace_destroy(j->workspace);
    return NULL;
}

/* A line every second on a terminal, else one every 15 s, until all is done. */
static void show_progress(campaign *all)
{
    const bool terminal = isatty(STDERR_FILENO);
    const long impacts = all->each * CASE_CLASSES;
    const double start = measure_clock(), every = terminal ? 1 : 15;
    double last = start;
    for (long done; (done = atomic_load(&all->done)) < impacts;) {
        nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
        const double now = measure_clock();
        if (now - last < every || done == 0) continue;
        last = now;
        const double left = (now - start) * (double)(impacts - done) / (double)done;
        fprintf(stderr, "%s%ld of %ld impacts, about %.0f s left   %s", terminal ? "\r" : "", done, impacts, left,
                terminal ? "" : "\n");
    }
    if (terminal) fprintf(stderr, "\r%60s\r", "");
}

/* ---- the tables ---- */

#ifdef HAVE_QUADMATH
static void print_worst_row(case_class class_, uint64_t seed, const worst_row *row)
{
    const impact_collision c = case_make(class_, seed, (uint64_t)row->index);
    impact_outcome o;
    impact_collide(&c, &o);
    const double data = data_error(&c);
    printf("%s,%ld,%.2g,%.2g,%.2g,%.2g,%.2g,%s,%s,", case_name(class_), row->index, row->error,
           row->error / (0x1p-52 * row->conditioning), row->conditioning, data, row->error / data,
           impact_law_name(c.law), impact_solver_name(o.solver));
    for (int i = 0; i < o.phase_count; i++)
        printf("%s%s", i > 0 ? " " : "", impact_phase_name((impact_phase)o.phases[i]));
    printf("\n");
}

static void print_worst(case_class class_, uint64_t seed, const tally *t)
{
    for (int i = 0; i < WORST; i++)
        if (t->by_error[i].error > 0) print_worst_row(class_, seed, &t->by_error[i]);
    for (int i = 0; i < WORST; i++) {
        bool printed = !(t->by_scaled[i].error > 0);
        for (int k = 0; k < WORST; k++) printed = printed || t->by_scaled[i].index == t->by_error[k].index;
        if (!printed) print_worst_row(class_, seed, &t->by_scaled[i]);
    }
}
#endif

static void print_tables(const tally each[CASE_CLASSES], uint64_t seed)
{
    static tally total;
    tally_start(&total);
    for (int k = 0; k < CASE_CLASSES; k++) tally_merge(&total, &each[k]);
    print_course_heading();
    for (int k = 0; k < CASE_CLASSES; k++) print_course(case_name((case_class)k), &each[k]);
    print_course("all", &total);
    printf("\n");
    print_comparison_heading();
    for (int k = 0; k < CASE_CLASSES; k++) print_comparison(case_name((case_class)k), "oracle", &each[k].oracle, true);
    print_comparison("all", "oracle", &total.oracle, true);
    for (int k = 0; k < CASE_CLASSES; k++) print_comparison(case_name((case_class)k), "cvode", &each[k].cvode, false);
    print_comparison("all", "cvode", &total.cvode, false);
#ifdef HAVE_QUADMATH
    printf("\nclass,index,error,eps_cond,conditioning,data_error,error_over_data,law,solver,phases\n");
    fflush(stdout);
    for (int k = 0; k < CASE_CLASSES; k++) print_worst((case_class)k, seed, &each[k]);
#else
    (void)seed;
#endif
    print_summary(&total);
}

/* ---- the door ---- */

/* About `wanted` of the impacts of all classes: every so many of a class, and no multiple of 3, since the laws come in
 * turn. */
static long stride(long impacts, long wanted)
{
    const long every = wanted > 0 ? (impacts + wanted - 1) / wanted : 0;
    return every > 0 && every % 3 == 0 ? every + 1 : every;
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"--impacts", "--seed", "--threads", "--cvode", "--oracle", "--range", NULL};
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    const long impacts = options_count(argc, argv, "--impacts", 1000000), seed = options_count(argc, argv, "--seed", 1);
    const long threads = options_count(argc, argv, "--threads",
                                       cores < 1              ? 1
                                       : cores < MOST_THREADS ? cores
                                                              : MOST_THREADS);
    const long cvode = options_count(argc, argv, "--cvode", impacts / 100),
               oracle = options_count(argc, argv, "--oracle", impacts / 200),
               range = options_count(argc, argv, "--range", impacts / 1000);
    if (!options_known(argc, argv, names) || impacts < CASE_CLASSES || seed < 0 || threads < 1 ||
        threads > MOST_THREADS || cvode < 0 || oracle < 0 || range < 0) {
        fprintf(stderr,
                "report_collide [--impacts N >= %d] [--seed S] [--threads 1 ... %d] [--cvode N] [--oracle N] "
                "[--range N]\n",
                CASE_CLASSES, MOST_THREADS);
        return 2;
    }
    campaign all = {.each = impacts / CASE_CLASSES, .seed = (uint64_t)seed};
    all.cvode = stride(impacts, cvode);
    all.oracle = stride(impacts, oracle);
    job *jobs = calloc((size_t)threads, sizeof *jobs);
    if (!jobs) return 1;
    for (int i = 0; i < threads; i++) {
        jobs[i].all = &all;
        if (pthread_create(&jobs[i].thread, NULL, work, &jobs[i]) != 0) return 1;
    }
    show_progress(&all);
    for (int i = 0; i < threads; i++) pthread_join(jobs[i].thread, NULL);
    long failures = 0;
    for (int k = 0; k < CASE_CLASSES; k++) {
        for (int i = 1; i < threads; i++) tally_merge(&jobs[0].tally[k], &jobs[i].tally[k]);
        failures += jobs[0].tally[k].failures;
    }
    print_tables(jobs[0].tally, all.seed);
    free(jobs);
    failures += report_extremes((long[]){impacts / 10, impacts / 10, range}, all.seed, (int)threads);
    return failures > 0;
}
