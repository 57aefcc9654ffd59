/* SPDX-License-Identifier: MIT
 *
 * report_run: one scene run for a report, its states at the report's times, and two such runs compared. Internal.
 */
#ifndef IMP_REPORT_RUN_H
#define IMP_REPORT_RUN_H

#include <impact/report.h>
#include "base/arena.h"

typedef struct imp_report_event {
    double t;
    int kind, body[2];
    unsigned force; /* of its name; 0: none */
} imp_report_event;

/* A run: its states at the times, those of bodies that move side by side, and its events. */
typedef struct imp_report_track {
    impact_sample *states;
    imp_report_event *events;
    int event_count, event_room;
    impact_status status;
    bool complete; /* it reached the end */
    double reached, account, cpu;
    impact_usage usage;
    char message[160];
} imp_report_track;

/* What all runs of one report share. */
typedef struct imp_report {
    imp_arena *arena;
    impact_scene_def def;
    int *moving, moving_count; /* the bodies that move */
    double *gyration;          /* of each, m */
    double *times;
    int time_count;
    double X, V;
    double deadline; /* of the run under way, s of CPU time */
    const impact_report_def *how;
    bool stopped; /* go_on said so */
} imp_report;

/* s of CPU time of this process. */
double imp_report_now(void);

/* The scene by these methods at these times; nudge, m: every body that moves starts so far aside (0: where it is).
 * states NULL: wanted are only the events, of a run without a stop, and its last states (NULL: not wanted).
 * IMPACT_ENOMEM alone is an error: what becomes of the run is in the track. */
impact_status imp_report_run(imp_report *report, const impact_methods *methods, double nudge, imp_report_track *track,
                             impact_sample *last);
void imp_report_forget(imp_report *report, imp_report_track *track);

/* Create, run and destroy, nothing else: s of CPU time. */
double imp_report_time(imp_report *report, const impact_methods *methods);

/* The errors of a at the report's first `count` times, against b: e of each, NULL: not wanted; the greatest. */
impact_report_error imp_report_compare(const imp_report *report, const imp_report_track *a, const imp_report_track *b,
                                       int count, double *e);

/* Of three runs, the second between the two others: half the sum of these less the second, as errors (t 0), times
 * IMP_REPORT_SPREAD. */
impact_report_error imp_report_bend(const imp_report *report, const imp_report_track *one,
                                    const imp_report_track *middle, const imp_report_track *other, int count);

/* Events of both up to t, pair by pair: the greatest difference of times in row->error.t, other_events, first_other,
 * dying. False: no memory. */
bool imp_report_match(const imp_report *report, const imp_report_track *a, const imp_report_track *b, double t,
                      impact_report_row *row);

#endif
