/* SPDX-License-Identifier: MIT */
#include "report_collide_tally.h"

#include <math.h>
#include <stdio.h>

static const double eps = 0x1p-52;

/* ---- distributions ---- */

void spread_note(spread *s, double value)
{
    int bin = value > 0 ? (int)(PER_DECADE * (log10(value) + 19)) : 0;
    bin = bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
    s->bin[bin]++;
    s->count++;
    if (!(value <= s->worst) && !isnan(s->worst)) s->worst = value; /* a NaN stays */
}

double spread_quantile(const spread *s, double part)
{
    long seen = 0;
    for (int i = 0; i < BINS; i++) {
        seen += s->bin[i];
        if (seen > 0 && (double)seen >= part * (double)s->count)
            return i == 0 ? 0 : fmin(pow(10, (i + 1.0) / PER_DECADE - 19), s->worst);
    }
    return NAN;
}

static void merge_spread(spread *into, const spread *from)
{
    for (int i = 0; i < BINS; i++) into->bin[i] += from->bin[i];
    into->count += from->count;
    if (!(from->worst <= into->worst) && !isnan(into->worst)) into->worst = from->worst;
}

/* ---- comparisons ---- */

bool above_bar(double error, double conditioning) { return !(error <= fmax(1e-12, 10 * eps * conditioning)); }

void comparison_note(comparison *c, double error, double conditioning)
{
    spread_note(&c->error, error);
    spread_note(&c->scaled, error / (eps * conditioning));
    c->above_bar += above_bar(error, conditioning);
}

static void merge_comparison(comparison *into, const comparison *from)
{
    merge_spread(&into->error, &from->error);
    merge_spread(&into->scaled, &from->scaled);
    into->refused += from->refused;
    into->above_bar += from->above_bar;
    into->above_data += from->above_data;
}

static double scaled(const worst_row *row) { return row->error > 0 ? row->error / row->conditioning : 0; }

/* Sorted in, the largest first; of equals the first in the campaign, so that threads do not matter. */
static void keep_worst(worst_row list[WORST], worst_row row, double size(const worst_row *row))
{
    for (int i = 0; i < WORST; i++) {
        const double a = size(&row), b = size(&list[i]);
        if (a > b || (a == b && a > 0 && row.index < list[i].index)) {
            const worst_row next = list[i];
            list[i] = row;
            row = next;
        }
    }
}

static double plainly(const worst_row *row) { return row->error; }

void tally_oracle(tally *t, long index, double error, double conditioning)
{
    const worst_row row = {index, error, conditioning};
    comparison_note(&t->oracle, error, conditioning);
    keep_worst(t->by_error, row, plainly);
    keep_worst(t->by_scaled, row, scaled);
}

/* ---- one class ---- */

void tally_start(tally *t) { t->gain = t->cone = -INFINITY; }

void tally_merge(tally *into, const tally *from)
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
    into->time_sum += from->time_sum;
    into->time_count += from->time_count;
    merge_comparison(&into->cvode, &from->cvode);
    merge_comparison(&into->oracle, &from->oracle);
    merge_spread(&into->time, &from->time);
    for (int i = 0; i < WORST; i++) {
        keep_worst(into->by_error, from->by_error[i], plainly);
        keep_worst(into->by_scaled, from->by_scaled[i], scaled);
    }
}

/* How far the impulse stands outside of the friction cone, over |P|. */
static double outside_cone(const impact_collision *c, const impact_outcome *o)
{
    const double n = qvec3_norm(c->normal), p = qvec3_dot(o->impulse, c->normal) / n;
    const qvec3 t = qvec3_axpy(-p / n, c->normal, o->impulse);
    return (qvec3_norm(t) - c->friction * p) / (qvec3_norm(o->impulse) * sqrt(1 + c->friction * c->friction));
}

void tally_outcome(tally *t, const impact_collision *c, const impact_outcome *o)
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
    if (c->law == IMPACT_NEWTON)
        t->newton_gains += o->energy_rose;
    else
        t->gain = fmax(t->gain, (o->energy_after - o->energy_before) / o->energy_before);
    t->cone = fmax(t->cone, outside_cone(c, o));
}

void tally_time(tally *t, double seconds)
{
    spread_note(&t->time, seconds);
    if (seconds >= 2e-4) return; /* another program had the core */
    t->time_sum += seconds;
    t->time_count++;
}

/* ---- printing ---- */

void print_course_heading(void)
{
    printf("class,impacts,failures,slip,stick,reversal,jam,recompression,worst_gain,worst_cone,newton_gains,us_mean,us_"
           "p50,"
           "us_p99,us_max\n");
}

void print_course(const char *name, const tally *t)
{
    printf("%s,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%.2g,%.2g,%ld,", name, t->impacts, t->failures, t->slips, t->sticks,
           t->reversals, t->jams, t->again, t->gain, t->cone, t->newton_gains);
    printf("%.2g,%.2g,%.2g,%.2g\n", 1e6 * t->time_sum / (double)t->time_count, 1e6 * spread_quantile(&t->time, 0.5),
           1e6 * spread_quantile(&t->time, 0.99), 1e6 * t->time.worst);
}

static const double parts[] = {0.5, 0.9, 0.99, 0.999};

void print_comparison_heading(void)
{
    printf("class,against,compared,refused,above_1e-12_and_10_eps_cond,and_10_data_error,error_p50,error_p90,error_p99,"
           "error_p999,error_"
           "worst,eps_cond_p50,"
           "eps_cond_p90,eps_cond_p99,eps_cond_p999,eps_cond_worst\n");
}

void print_comparison(const char *name, const char *with, const comparison *c, bool judged)
{
    printf("%s,%s,%ld,%ld,", name, with, c->error.count, c->refused);
    if (judged)
        printf("%ld,%ld", c->above_bar, c->above_data);
    else
        printf(",");
    for (int i = 0; i < 4; i++) printf(",%.2g", spread_quantile(&c->error, parts[i]));
    printf(",%.2g", c->error.worst);
    for (int i = 0; i < 4; i++) printf(",%.2g", spread_quantile(&c->scaled, parts[i]));
    printf(",%.2g\n", c->scaled.worst);
}

void print_summary(const tally *total)
{
    const comparison *oracle = &total->oracle, *cvode = &total->cvode;
    printf("\n# %ld impacts: %ld failures; energy gained at most %.2g of what there was (Poisson, Stronge); impulse "
           "outside of the "
           "cone by at most %.2g of itself\n",
           total->impacts, total->failures, total->gain, total->cone);
    printf("# %ld against the 128-bit oracle: median error %.2g, worst %.2g, worst in eps cond %.2g; beyond both 1e-12 "
           "and 10 eps "
           "cond: %ld, of these beyond ten times the data's own error: %ld\n",
           oracle->error.count, spread_quantile(&oracle->error, 0.5), oracle->error.worst, oracle->scaled.worst,
           oracle->above_bar, oracle->above_data);
    printf("# %ld against CVODE at 1e-12: median difference %.2g, worst %.2g; CVODE gave up on %ld\n",
           cvode->error.count, spread_quantile(&cvode->error, 0.5), cvode->error.worst, cvode->refused);
    printf("# time of one call, us: mean %.2g, p50 %.2g, p99 %.2g, max %.2g\n",
           1e6 * total->time_sum / (double)total->time_count, 1e6 * spread_quantile(&total->time, 0.5),
           1e6 * spread_quantile(&total->time, 0.99), 1e6 * total->time.worst);
}
