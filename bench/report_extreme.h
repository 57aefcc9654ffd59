/* SPDX-License-Identifier: MIT
 *
 * What the files of report_extreme share: a scene, its run and its row.
 */
#ifndef BENCH_REPORT_EXTREME_H
#define BENCH_REPORT_EXTREME_H

#include <impact/impact.h>

static const double extreme_gravity = 9.81;

enum { MOST_BODIES = 3 };

typedef struct extreme_trial {
    impact_scene_def def;
    impact_body_def bodies[MOST_BODIES];
    impact_force_def force;
    impact_scene *scene;
    impact_status status;
    double cpu; /* s */
} extreme_trial;

/* What an error is by, until when, and the condition there. */
typedef struct extreme_source {
    double error;
    const char *by;
    double until, condition;
} extreme_source;

void extreme_open(extreme_trial *t);
void extreme_go_on(extreme_trial *t, double until);
impact_sample extreme_end_of(const extreme_trial *t, int body);
void extreme_row(const char *name, double parameter, extreme_trial *t, extreme_source s); /* and the trial is over */

/* The row of a trial that was opened, of a superquadric of that exponent, its second body, that falls on the floor:
 * against truth_fall. Without 128 bits it is left out, in words. */
void extreme_falling(const char *name, double parameter, extreme_trial *t, double exponent);

#endif
