/* SPDX-License-Identifier: MIT
 *
 * Who vouches for the reference, until when, and how surely; and what of the errors is the scene's own condition.
 */
#include "report/report_work.h"

#include "base/tolerances.h"
#include <math.h>

static int first_parting(const imp_report_work *w, const imp_report_entry *e)
{
    int k = 0;
    while (k < w->report.time_count && e->e[k] <= IMP_REPORT_PARTING) k++;
    return k;
}

typedef enum aspect { MOTION, IMPACTS, ASPECTS } aspect;

/* Whether the run does it by another method than the default: an integrator's motion is not vouched for by itself, and
 * what is moved by steps is by the same steps whatever the method; so is what glides on a face, and a run that
 * integrates nothing else vouches for nothing. */
static bool vouches(const imp_report_work *w, const imp_report_entry *e, aspect a)
{
    const bool closed = w->reference.usage.integrators == 0;
    const bool glides_only = w->reference.usage.glides > 0 && e->track.usage.integrator_steps == 0;
    if (!e->track.complete || w->reference.usage.pile_steps > 0 || (a == MOTION && glides_only)) return false;
    switch (e->row.method) {
    case IMPACT_REPORT_MOTION: return a == MOTION && closed;
    case IMPACT_REPORT_IMPACTS: return a == IMPACTS;
    case IMPACT_REPORT_TEXTBOOK: return a == IMPACTS ? !w->summary->useless[IMPACT_REPORT_IMPACTS] : closed;
    case IMPACT_REPORT_RK4: return a == MOTION;
    default: return false;
    }
}

/* Until when the reference and the nearest witness of each aspect go together. */
void imp_report_find_horizon(imp_report_work *w)
{
    imp_report *r = &w->report;
    w->compared = r->time_count;
    for (int a = MOTION; a < ASPECTS && !w->how->oracle; a++) {
        int farthest = -1;
        for (int k = 0; k < w->count; k++)
            if (vouches(w, &w->entries[k], (aspect)a)) farthest = (int)fmax(farthest, first_parting(w, &w->entries[k]));
        if (farthest >= 0) w->compared = (int)fmin(w->compared, farthest);
    }
    w->summary->horizon = w->compared == r->time_count ? r->def.duration
                          : w->compared > 0            ? r->times[w->compared - 1]
                                                       : 0;
}

static impact_report_error larger_of(impact_report_error a, impact_report_error b)
{
    return (impact_report_error){fmax(a.x, b.x), fmax(a.v, b.v), fmax(a.q, b.q), fmax(a.t, b.t)};
}

/* The nearest witness of the aspect; NULL: there is none. */
static const imp_report_entry *nearest(const imp_report_work *w, aspect a)
{
    const imp_report_entry *best = NULL;
    for (int k = 0; k < w->count; k++) {
        const imp_report_entry *e = &w->entries[k];
        if (!vouches(w, e, a)) continue;
        if (!best || impact_report_worst(e->row.error) < impact_report_worst(best->row.error)) best = e;
    }
    return best;
}

static impact_report_witness named(const imp_report_entry *e)
{
    return e ? (impact_report_witness){e->row.method, e->row.setting} : (impact_report_witness){0};
}

void imp_report_find_certainty(imp_report_work *w)
{
    impact_report_summary *s = w->summary;
    const double stated = w->how->oracle_error, none = INFINITY;
    const imp_report_entry *motion = nearest(w, MOTION), *impacts = nearest(w, IMPACTS);
    s->motion_witness = named(motion), s->impact_witness = named(impacts);
    s->sure = w->how->oracle || (motion && w->compared > 0);
    s->certainty = (impact_report_error){none, none, none, none};
    if (w->how->oracle)
        s->certainty = (impact_report_error){stated, stated, stated, NAN};
    else if (s->sure)
        s->certainty =
            larger_of(s->rounding, impacts ? larger_of(motion->row.error, impacts->row.error) : motion->row.error);
    for (int k = 0; k < w->count; k++)
        w->entries[k].row.below =
            s->sure && impact_report_worst(w->entries[k].row.error) < impact_report_worst(s->certainty);
}

/* Until the horizon; what did not reach the end has no error to show. */
impact_status imp_report_compare_all(imp_report_work *w)
{
    imp_report *r = &w->report;
    const double all = INFINITY;
    for (int k = 0; k < w->count; k++) {
        imp_report_entry *e = &w->entries[k];
        e->row.error = (impact_report_error){all, all, all, all};
        e->row.first_other = INFINITY;
        if (!e->track.complete) continue;
        e->row.error = imp_report_compare(r, &e->track, &w->reference, w->compared, NULL);
        if (!imp_report_match(r, &w->reference, &e->track, w->summary->horizon, &e->row)) return IMPACT_ENOMEM;
    }
    return IMPACT_OK;
}

/* ---- condition ---- */

static impact_status run_aside(imp_report_work *w, double nudge, imp_report_track *track)
{
    imp_report *r = &w->report;
    *track = (imp_report_track){.states = imp_report_new_states(r)};
    if (!track->states) return IMPACT_ENOMEM;
    r->deadline = imp_report_now() + fmax(w->began + w->seconds - imp_report_now(), 0) / 8;
    return imp_report_run(r, &w->reference_methods, nudge * r->X, track, NULL);
}

static bool any_ended(const imp_report_work *w)
{
    for (int k = 0; k < w->count; k++)
        if (w->entries[k].track.complete) return true;
    return false;
}

/* The start a little to one side and to the other: half the difference of the ends is what that makes of it, half their
 * sum less the reference what rounding does on the way, in all that every run shares. */
impact_status imp_report_find_condition(imp_report_work *w)
{
    imp_report *r = &w->report;
    imp_report_track one = {0}, other = {0};
    w->summary->condition = NAN;
    /* where the time was too short for every setting there is nothing to set it beside, and none left for two more
     * runs: bricks set aside by a hair took 31 s over one instant */
    if (w->how->oracle || !any_ended(w)) return IMPACT_OK;
    impact_status status = run_aside(w, IMP_REPORT_NUDGE, &one);
    if (status == IMPACT_OK) status = run_aside(w, -IMP_REPORT_NUDGE, &other);
    if (status == IMPACT_OK && one.complete && other.complete) {
        const impact_report_error apart = imp_report_compare(r, &one, &other, w->compared, NULL);
        w->summary->condition = impact_report_worst(apart) / (2 * IMP_REPORT_NUDGE);
        w->summary->rounding = imp_report_bend(r, &one, &w->reference, &other, w->compared);
    }
    imp_report_forget(r, &one);
    imp_report_forget(r, &other);
    return status;
}
