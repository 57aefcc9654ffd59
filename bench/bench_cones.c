/* SPDX-License-Identifier: MIT
 *
 * bench_cones: how long a cone problem takes (docs/cone.md). CSV: contacts; bodies among them; the time from nothing,
 * and with the last answer of a problem whose q differed by 1e-6, in us of CPU: median over the problems of the least
 * of repeats; linear systems of both, medians; all solved; the worst residual.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "contact/cone.h"
#include "kit/cone_cases.h"
#include "measure.h"

enum { MOST_PROBLEMS = 40 };

typedef struct tally {
    double cold[MOST_PROBLEMS], warm[MOST_PROBLEMS], cold_systems[MOST_PROBLEMS], warm_systems[MOST_PROBLEMS], worst;
    int solved;
} tally;

static double least_time(const imp_cone_problem *problem, imp_cone_workspace *room, int repeats, double *r, double *u,
                         imp_cone_outcome *outcome)
{
    double least = INFINITY;
    for (int k = 0; k < repeats; k++) {
        const double begun = measure_clock();
        *outcome = imp_cone_solve(problem, room, r, u, NULL);
        least = fmin(least, measure_since(begun));
    }
    return 1e6 * least;
}

static void solve_one(random_stream *random, int contacts, int bodies, int repeats, imp_cone_workspace *room, int k,
                      tally *t)
{
    cone_case c = cone_case_make(random, contacts, bodies, 1);
    const int n = 3 * contacts;
    imp_cone_problem problem = cone_case_problem(&c);
    imp_cone_outcome cold, warm;
    double *r = calloc(5 * (size_t)n, sizeof *r), *u = r + n, *next = u + n, *after = next + n, *change = after + n;
    t->cold[k] = least_time(&problem, room, repeats, r, u, &cold);
    for (int i = 0; i < n; i++) change[i] = 1e-6 * cone_between(random, -1, 1);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) c.q[i] += c.w[(size_t)i * (size_t)n + (size_t)j] * change[j];
    problem.last_r = r, problem.last_u = u;
    t->warm[k] = least_time(&problem, room, repeats, next, after, &warm);
    t->cold_systems[k] = cold.factorings, t->warm_systems[k] = warm.factorings;
    t->solved += cold.status == IMP_CONE_SOLVED && warm.status == IMP_CONE_SOLVED;
    t->worst = fmax(t->worst, fmax(cold.residual, warm.residual));
    free(r);
    cone_case_free(&c);
}

int main(void)
{
    static const struct {
        int contacts, bodies, problems, repeats;
    } rows[] = {{1, 1, 40, 50},  {3, 2, 40, 20},  {10, 10, 40, 10}, {10, 5, 40, 10},
                {30, 15, 20, 5}, {50, 25, 10, 3}, {100, 50, 5, 1},  {300, 150, 1, 1}};
    imp_cone_workspace room = {.capacity = 0};
    if (imp_arena_create(NULL, &room.arena) != IMPACT_OK) return 1;
    printf("contacts,bodies,cold_us,warm_us,cold_systems,warm_systems,solved,of,residual\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (getenv("BENCH_QUICK") && rows[i].contacts > 100) break; /* seconds for one */
        random_stream random = {(uint64_t)rows[i].contacts};
        tally t = {.worst = 0};
        if (!imp_cone_reserve(&room, rows[i].contacts)) return 1;
        const int count = measure_count(rows[i].problems);
        for (int k = 0; k < count; k++)
            solve_one(&random, rows[i].contacts, rows[i].bodies, measure_count(rows[i].repeats), &room, k, &t);
        printf("%d,%d,%.1f,%.1f,%.0f,%.0f,%d,%d,%.2g\n", rows[i].contacts, rows[i].bodies,
               measure_quantile(t.cold, count, 0.5), measure_quantile(t.warm, count, 0.5),
               measure_quantile(t.cold_systems, count, 0.5), measure_quantile(t.warm_systems, count, 0.5), t.solved,
               count, t.worst);
        fflush(stdout);
    }
    imp_arena_destroy(room.arena);
    return 0;
}
