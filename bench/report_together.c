/* SPDX-License-Identifier: MIT
 *
 * report_together: random encounters (docs/together.md), each solved thrice: as drawn; with bodies renumbered and
 * contacts shuffled, which must give the same bits; and turned, in other units, which must give the same answer to
 * 1e-11 times its sensitivity (as far as it goes after changes of the data of 1e-11, the most of 512 tries, or 1e-11).
 *
 * report_together [--encounters N] [--seed S] [--only I]
 * N (default 1000) are shared among the rows; of these only number I, as the lines below name it. Friction 0 to 10,
 * restitution .05 to 1, masses and stiffnesses within a ratio of 1e4; bodies at rest, static, planar among them. CSV:
 * law; Poisson's restitution or Newton's; exponent of the springs; contacts; encounters; answered, nothing to answer,
 * answered with a receipt that does not pass, those of these that are sensitive: changes of their data of 2^-40 take
 * velocities a thousand times as far as the receipt misses by, and roundings, 2^-50, as far; wedged (told with proof),
 * not settled; those whose energy rose (by springs: by more than 1e-14; Moreau's may), and those whose bits changed
 * with the order; the worst residual of the answered; those that were turned and compared, those of them that were off,
 * and those of these by Moreau that have several answers: both solve his problems, with receipts that pass, and are
 * more than 1e-6 apart; those that turned are told as wedged, and those of them of which the same happens to changes
 * of their data of 1e-11: there chance tells whether a wedge locks or comes loose; CPU time, us: median, the part .99,
 * most; Taylor steps or linear systems: median, most. Then one line for each that is not answered, as drawn or turned:
 * its number from the seed, so that it can be made again.
 */
#include <stdio.h>
#include <string.h>
#include "kit/encounter_answer.h"
#include "measure.h"
#include "options.h"

typedef struct family {
    impact_together_law law;
    double exponent;
    int least, most;
    impact_law restitution; /* Moreau's: the law it restores by; springs have their own */
} family;

static const family families[] = {
    {IMPACT_TOGETHER_SPRINGS, 1.5, 2, 3, IMPACT_POISSON},  {IMPACT_TOGETHER_SPRINGS, 1.5, 4, 6, IMPACT_POISSON},
    {IMPACT_TOGETHER_SPRINGS, 1.5, 7, 12, IMPACT_POISSON}, {IMPACT_TOGETHER_SPRINGS, 1, 2, 3, IMPACT_POISSON},
    {IMPACT_TOGETHER_SPRINGS, 1, 4, 6, IMPACT_POISSON},    {IMPACT_TOGETHER_SPRINGS, 1, 7, 12, IMPACT_POISSON},
    {IMPACT_TOGETHER_MOREAU, 0, 2, 3, IMPACT_POISSON},     {IMPACT_TOGETHER_MOREAU, 0, 4, 6, IMPACT_POISSON},
    {IMPACT_TOGETHER_MOREAU, 0, 7, 12, IMPACT_POISSON},    {IMPACT_TOGETHER_MOREAU, 0, 2, 3, IMPACT_NEWTON},
    {IMPACT_TOGETHER_MOREAU, 0, 4, 6, IMPACT_NEWTON},      {IMPACT_TOGETHER_MOREAU, 0, 7, 12, IMPACT_NEWTON}};
enum { FAMILIES = sizeof families / sizeof *families };

typedef struct tally {
    int answered, separating, soft, sensitive, early, wedged, unsettled, risen, changed, turned, off, several, lost,
        chance;
    double worst, *time, *steps;
} tally;

static double cpu_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The same with bodies and contacts in the reverse order; body b becomes count - 1 - b. */
static random_encounter reversed(const random_encounter *e)
{
    random_encounter other = *e;
    const int bodies = e->body_count - 1, meetings = e->meeting_count - 1;
    for (int b = 0; b <= bodies; b++) other.bodies[bodies - b] = e->bodies[b];
    for (int i = 0; i <= meetings; i++) {
        impact_meeting *m = &other.meetings[meetings - i];
        *m = e->meetings[i];
        m->body1 = bodies - m->body1, m->body2 = bodies - m->body2;
    }
    return other;
}

static bool same_bits(const answer *a, const answer *b, int bodies)
{
    bool same = a->status == b->status;
    for (int k = 0; k < bodies; k++)
        same = same && memcmp(&a->velocity[k], &b->velocity[bodies - 1 - k], sizeof *a->velocity) == 0 &&
               memcmp(&a->omega[k], &b->omega[bodies - 1 - k], sizeof *a->omega) == 0;
    return same;
}

static void count_status(const answer *a, tally *t, long number)
{
    t->answered += a->status == IMPACT_OK;
    t->separating += a->status == IMPACT_SEPARATING;
    t->soft += a->status == IMPACT_SOFT;
    t->early += a->outcome.ended_early;
    t->wedged += a->outcome.wedged >= 0;
    const bool unsettled = a->status < 0 && a->outcome.wedged < 0;
    t->unsettled += unsettled;
    if (a->status == IMPACT_SOFT || unsettled)
        fprintf(stderr, "encounter %ld: %s, residual %.2g, error %.2g%s\n", number, impact_status_string(a->status),
                a->outcome.residual, a->outcome.error, a->outcome.ended_early ? ", ended early" : "");
}

/* Whether an answer whose receipt does not pass misses by no more than its data's roundings, 2^-50, do: as changes a
 * thousand times as large show, which take it a thousand times as far. A solver's own noise does not grow with them. */
static bool is_sensitive(const family *f, const random_encounter *e, const answer *a, random_stream *random)
{
    const double missed = 0x1p10 * a->outcome.residual;
    return spread(random, e, f->law, f->exponent, a, 0x1p-40, missed) >= missed;
}

static void turn_one(const family *f, const random_encounter *e, const answer *a, random_stream *random,
                     impact_together_workspace *workspace, long number, tally *t)
{
    const encounter_frame frame = {random_rotation(random), random_log(random, 0.1, 10), random_log(random, 0.1, 10),
                                   random_log(random, 0.1, 10)};
    const random_encounter other = change_frame(e, &frame);
    answer b = solve(&other, f->law, f->exponent, workspace);
    if (b.status != IMPACT_OK) {
        const bool chance = b.outcome.wedged >= 0 && is_lost_nearby(random, e, f->law, f->exponent);
        t->lost++;
        t->chance += chance;
        if (!chance)
            fprintf(stderr, "encounter %ld: turned: %s%s\n", number, impact_status_string(b.status),
                    b.outcome.wedged >= 0 ? ", wedged" : "");
        return;
    }
    change_back(&b, e->body_count, &frame);
    const double off = distance(e, a, &b), allowed = allowance(random, e, f->law, f->exponent, a, off);
    t->turned++;
    if (off <= allowed) return;
    const bool several = f->law == IMPACT_TOGETHER_MOREAU && off > 1e-6;
    t->off++;
    t->several += several;
    fprintf(stderr, "encounter %ld: turned it is off by %.2g, allowed %.2g%s\n", number, off, allowed,
            several ? ", another answer" : "");
}

static void solve_one(const family *f, uint64_t seed, long number, impact_together_workspace *workspace, int k,
                      tally *t)
{
    static const encounter_ranges whole = {
        .friction = 10, .restitution = 0.05, .mass_ratio = 1e4, .stiffness_ratio = 1e4};
    encounter_ranges ranges = whole;
    ranges.least = f->least, ranges.most = f->most;
    random_stream random = {seed + 0x9e3779b97f4a7c15u * (uint64_t)number};
    random_encounter e = encounter_draw(&random, &ranges);
    e.restitution = f->restitution;
    const random_encounter other = reversed(&e);
    const double begun = cpu_clock();
    const answer a = solve(&e, f->law, f->exponent, workspace);
    t->time[k] = 1e6 * (cpu_clock() - begun);
    t->steps[k] = (double)a.outcome.steps;
    count_status(&a, t, number);
    const answer b = solve(&other, f->law, f->exponent, workspace);
    t->changed += !same_bits(&a, &b, e.body_count);
    t->sensitive += a.status == IMPACT_SOFT && !a.outcome.ended_early && is_sensitive(f, &e, &a, &random);
    if (a.status != IMPACT_OK) return;
    turn_one(f, &e, &a, &random, workspace, number, t);
    t->worst = fmax(t->worst, a.outcome.residual);
    t->risen += f->law == IMPACT_TOGETHER_SPRINGS ? a.outcome.energy_after > a.outcome.energy_before * (1 + 1e-14)
                                                  : a.outcome.energy_rose;
}

static void print_heading(void)
{
    static const char *const columns[] = {"law",         "restitution", "exponent",    "contacts",      "encounters",
                                          "answered",    "separating",  "soft",        "sensitive",     "ended_early",
                                          "wedged",      "unsettled",   "energy_rose", "order_changed", "residual",
                                          "turned",      "turned_off",  "several",     "turned_lost",   "chance",
                                          "time_median", "time_99",     "time_most",   "steps_median",  "steps_most"};
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++) printf("%s%s", k ? "," : "", columns[k]);
    printf("\n");
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"--encounters", "--seed", "--only", NULL};
    const long encounters = options_count(argc, argv, "--encounters", 1000),
               seed = options_count(argc, argv, "--seed", 1), only = options_count(argc, argv, "--only", -1);
    impact_together_workspace *workspace;
    if (!options_known(argc, argv, names) || encounters < 0 || seed < 0) {
        fprintf(stderr, "report_together [--encounters N] [--seed S] [--only I]\n");
        return 2;
    }
    if (impact_together_workspace_create(NULL, &workspace) != IMPACT_OK) return 1;
    print_heading();
    long number = 0;
    for (int k = 0; k < FAMILIES; k++) {
        const family *f = &families[k];
        const int share = (int)(encounters / FAMILIES + (k < encounters % FAMILIES));
        const bool here = only >= number && only < number + share;
        const int runs = only < 0 ? share : here;
        tally t = {.time = calloc((size_t)runs + 1, sizeof *t.time),
                   .steps = calloc((size_t)runs + 1, sizeof *t.steps)};
        for (int i = 0; i < runs; i++) solve_one(f, (uint64_t)seed, only < 0 ? number + i : only, workspace, i, &t);
        number += share;
        if (runs == 0) continue;
        printf("%s,%s,%g,%d-%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%.2g,%d,%d,%d,%d,%d,%.0f,%.0f,%.0f,%.0f,%.0f\n",
               impact_together_law_name(f->law), impact_law_name(f->restitution), f->exponent, f->least, f->most, runs,
               t.answered, t.separating, t.soft, t.sensitive, t.early, t.wedged, t.unsettled, t.risen, t.changed,
               t.worst, t.turned, t.off, t.several, t.lost, t.chance, measure_quantile(t.time, runs, 0.5),
               measure_quantile(t.time, runs, 0.99), measure_quantile(t.time, runs, 1),
               measure_quantile(t.steps, runs, 0.5), measure_quantile(t.steps, runs, 1));
        fflush(stdout);
        free(t.time);
        free(t.steps);
    }
    impact_together_workspace_destroy(workspace);
    return 0;
}
