/* SPDX-License-Identifier: MIT
 *
 * report_collide, inside: what a campaign counts, per class, and how it is printed.
 */
#ifndef REPORT_COLLIDE_TALLY_H
#define REPORT_COLLIDE_TALLY_H

#include "../tests/generators/collide_cases.h"

enum { BINS = 400, PER_DECADE = 16, WORST = 3 };

/* A distribution in bins of a sixteenth of a decade from 1e-19 up. */
typedef struct spread {
    long count, bin[BINS];
    double worst;
} spread;

void spread_note(spread *s, double value);
/* The bin's upper end; NaN when nothing was noted. */
double spread_quantile(const spread *s, double part);

/* Errors against another solver; scaled: in units of eps cond(M). */
typedef struct comparison {
    spread error, scaled;
    long refused;    /* the other has no answer */
    long above_bar;  /* off by more than 1e-12 and more than 10 eps cond */
    long above_data; /* and by more than ten times what the data's own last bits make */
} comparison;

bool above_bar(double error, double conditioning);
void comparison_note(comparison *c, double error, double conditioning);

/* One impact whose error is among the worst of its class. */
typedef struct worst_row {
    long index;
    double error, conditioning;
} worst_row;

typedef struct tally {
    long impacts, failures, slips, sticks, reversals, jams, again, newton_gains;
    double gain, cone;
    comparison cvode, oracle;
    worst_row by_error[WORST], by_scaled[WORST]; /* against the oracle; error 0: none */
    spread time;
    double time_sum; /* of the calls that nothing interrupted */
    long time_count;
} tally;

void tally_start(tally *t);
void tally_merge(tally *into, const tally *from);
void tally_outcome(tally *t, const impact_collision *c, const impact_outcome *o);
void tally_time(tally *t, double seconds);
/* Against the 128-bit oracle. */
void tally_oracle(tally *t, long index, double error, double conditioning);

void print_course_heading(void);
void print_course(const char *name, const tally *t);
void print_comparison_heading(void);
/* judged: whether the other solver is right beyond doubt, so that what is above the bar can be told. */
void print_comparison(const char *name, const char *with, const comparison *c, bool judged);
void print_summary(const tally *total);

#endif
