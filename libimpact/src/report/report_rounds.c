/* SPDX-License-Identifier: MIT
 *
 * CPU time: rounds of all settings in turn, so that what the machine drifts hits all alike.
 */
#include "report/report_work.h"

#include <stdlib.h>

static int compare_numbers(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return a < b ? -1 : a > b;
}

/* The slowest are timed once, by the run that was compared, until the others' rounds fit into what time is left. */
static void choose_rounds(imp_report_work *w, int rounds)
{
    const double slow = 0.5, left = w->began + w->seconds - imp_report_now();
    double sum = 0;
    for (int k = 0; k < w->count; k++) {
        imp_report_entry *e = &w->entries[k];
        e->row.rounds = !e->ran ? 0 : e->track.cpu > slow ? 1 : rounds;
        if (e->row.rounds > 1) sum += rounds * e->track.cpu;
    }
    while (sum > left) {
        imp_report_entry *slowest = NULL;
        for (int k = 0; k < w->count; k++) {
            imp_report_entry *e = &w->entries[k];
            if (e->row.rounds > 1 && (!slowest || e->track.cpu > slowest->track.cpu)) slowest = e;
        }
        if (!slowest) break;
        slowest->row.rounds = 1;
        sum -= rounds * slowest->track.cpu;
    }
}

impact_status imp_report_measure_times(imp_report_work *w)
{
    const impact_report_def *how = w->how;
    const int rounds = how->rounds > 0 ? how->rounds : 7;
    w->summary->rounds = rounds;
    choose_rounds(w, rounds);
    for (int round = 0; round < rounds; round++)
        for (int k = 0; k < w->count; k++) {
            imp_report_entry *e = &w->entries[k];
            if (how->go_on && !how->go_on(how->context)) return imp_report_fail(w, IMPACT_STOPPED, "stopped");
            if (e->row.rounds <= 1 || round >= e->row.rounds) continue;
            if (imp_report_now() + e->track.cpu > w->began + w->seconds)
                e->row.rounds = round > 0 ? round : 1; /* what was told to take less takes the others' time */
            else
                e->cpu[round] = imp_report_time(&w->report, &e->methods);
        }
    for (int k = 0; k < w->count; k++) {
        imp_report_entry *e = &w->entries[k];
        if (e->row.rounds == 0) w->summary->dropped++;
        if (e->row.rounds == 1) e->cpu[0] = e->track.cpu;
        qsort(e->cpu, (size_t)e->row.rounds, sizeof *e->cpu, compare_numbers);
        if (e->row.rounds > 0) e->row.cpu = e->cpu[0], e->row.spread = e->cpu[e->row.rounds / 2] / e->cpu[0];
    }
    return IMPACT_OK;
}
