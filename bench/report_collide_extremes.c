/* SPDX-License-Identifier: MIT */
#include "report_collide_extremes.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include "../tests/generators/collide_cases.h"
#include "measure.h"

enum { CHUNK = 500, KINDS = CASE_ALL - CASE_CLASSES, MOST_THREADS = 256 };

typedef struct score {
    long impacts, refused, ok, separating, second, soft, unsettled;
    long not_finite, risen, unproved; /* with IMPACT_OK */
    double worst_receipt, longest;    /* of IMPACT_OK, in eps; s */
} score;

typedef struct pool {
    case_class class_;
    long count;
    uint64_t seed;
    atomic_long next;
} pool;

typedef struct hand {
    pthread_t thread;
    pool *all;
    score score;
} hand;

static bool is_finite(const impact_outcome *o)
{
    double sum = o->impulse_normal + o->work_compression + o->work_restitution + o->work_friction + o->normal_after;
    for (int i = 0; i < 2; i++)
        sum += o->velocity[i].x + o->velocity[i].y + o->velocity[i].z + o->omega[i].x + o->omega[i].y + o->omega[i].z;
    return isfinite(sum + o->energy_after);
}

static void judge(score *s, const impact_collision *c, const impact_outcome *o)
{
    impact_receipt r;
    const double worst = impact_collide_receipt(c, o, &r);
    s->ok++;
    s->second += o->second;
    s->not_finite += !is_finite(o);
    if (!(r.energy <= 100)) s->risen += !(r.energy <= 100 * fmax(1, impact_collide_sensitivity(c)));
    if (o->solver == IMPACT_SOLVER_CVODE) return; /* to its tolerance */
    s->unproved += !(worst <= 1e4);
    s->worst_receipt = fmax(s->worst_receipt, worst);
}

static void one(score *s, const impact_collision *c)
{
    impact_outcome o;
    const double from = measure_clock();
    const impact_status status = impact_collide(c, &o);
    s->longest = fmax(s->longest, measure_clock() - from);
    s->impacts++;
    if (status == IMPACT_OK) judge(s, c, &o);
    s->separating += status == IMPACT_SEPARATING;
    s->soft += status == IMPACT_SOFT;
    if (status >= 0) return;
    const bool refused = impact_collide_check(c, NULL, 0) != IMPACT_OK;
    s->refused += refused;
    s->unsettled += !refused;
}

static void *work(void *context)
{
    hand *h = context;
    pool *all = h->all;
    for (long from; (from = atomic_fetch_add(&all->next, CHUNK)) < all->count;)
        for (long i = from; i < from + CHUNK && i < all->count; i++) {
            const impact_collision c = case_make(all->class_, all->seed, (uint64_t)i);
            one(&h->score, &c);
        }
    return NULL;
}

static void add(score *to, const score *s)
{
    to->impacts += s->impacts;
    to->refused += s->refused;
    to->ok += s->ok;
    to->separating += s->separating;
    to->second += s->second;
    to->soft += s->soft;
    to->unsettled += s->unsettled;
    to->not_finite += s->not_finite;
    to->risen += s->risen;
    to->unproved += s->unproved;
    to->worst_receipt = fmax(to->worst_receipt, s->worst_receipt);
    to->longest = fmax(to->longest, s->longest);
}

static score run(case_class class_, long count, uint64_t seed, int threads)
{
    static hand hands[MOST_THREADS];
    pool all = {.class_ = class_, .count = count, .seed = seed};
    score sum = {0};
    for (int i = 0; i < threads; i++) {
        hands[i] = (hand){.all = &all};
        if (pthread_create(&hands[i].thread, NULL, work, &hands[i]) != 0) exit(1);
    }
    for (int i = 0; i < threads; i++) {
        pthread_join(hands[i].thread, NULL);
        add(&sum, &hands[i].score);
    }
    return sum;
}

static void print_row(const char *name, const score *s)
{
    printf("%s,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%.3g,%.3g\n", name, s->impacts, s->refused, s->separating, s->ok,
           s->second, s->soft, s->unsettled, s->not_finite, s->risen, s->unproved, s->worst_receipt, 1e3 * s->longest);
    fflush(stdout);
}

long report_extremes(const long each[3], uint64_t seed, int threads)
{
    score total = {0};
    printf("\nclass,impacts,refused,separating,ok,of_these_in_128_bits,soft,unsettled,not_finite_with_ok,risen_with_ok,"
           "receipt_failed_with_ok,worst_receipt_eps,longest_ms\n");
    for (int k = 0; k < KINDS; k++) {
        const score s = run((case_class)(CASE_CLASSES + k), each[k], seed, threads);
        print_row(case_name((case_class)(CASE_CLASSES + k)), &s);
        add(&total, &s);
    }
    print_row("all", &total);
    printf(
        "\n# %ld impacts at the limits: %ld refused, %ld answered, %ld of these in 128 bits; %ld soft, %ld unsettled; "
        "with ok: %ld not finite, %ld of risen energy, %ld whose receipt fails\n",
        total.impacts, total.refused, total.ok, total.second, total.soft, total.unsettled, total.not_finite,
        total.risen, total.unproved);
    return total.not_finite + total.risen + total.unproved;
}
