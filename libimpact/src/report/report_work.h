/* SPDX-License-Identifier: MIT
 *
 * report_work: one report under way. report.c goes through it in order; its steps stand in report_settings.c (which
 * methods), report_certainty.c (what the errors mean) and report_rounds.c (time). Internal.
 */
#ifndef IMP_REPORT_WORK_H
#define IMP_REPORT_WORK_H

#include "report/report_run.h"

enum { IMP_REPORT_SETTINGS = 64, IMP_REPORT_TIMES = 10000, IMP_REPORT_ROUNDS = 15 }; /* at most */

/* A setting, and what became of it. */
typedef struct imp_report_entry {
    impact_report_row row;
    impact_methods methods;
    imp_report_track track; /* its events; its states go when they are compared */
    double *e;              /* worst error at each time, from the reference */
    double cpu[IMP_REPORT_ROUNDS];
    bool ran;
} imp_report_entry;

typedef struct imp_report_work {
    imp_report report;
    const impact_report_def *how;
    impact_report_summary *summary;
    char *message;
    unsigned long message_size;
    double began, seconds;
    impact_methods reference_methods;
    imp_report_track reference;
    imp_report_entry *entries;
    int count, room;
    int compared; /* times before the horizon */
} imp_report_work;

/* The message, and the status again. */
impact_status imp_report_fail(imp_report_work *w, impact_status status, const char *why);

/* Room for the states of a run; NULL: no memory. */
impact_sample *imp_report_new_states(const imp_report *report);

/* Fills the entries by the reference's counters. False: no memory. */
bool imp_report_choose_settings(imp_report_work *w);

/* Until when the reference and the nearest witness of each aspect go together; then the errors up to there, what a
 * start a little aside makes of them, and who vouches how surely. In this order, after all runs. */
void imp_report_find_horizon(imp_report_work *w);
impact_status imp_report_compare_all(imp_report_work *w);
impact_status imp_report_find_condition(imp_report_work *w);
void imp_report_find_certainty(imp_report_work *w);

/* IMPACT_STOPPED where go_on says so. */
impact_status imp_report_measure_times(imp_report_work *w);

#endif
