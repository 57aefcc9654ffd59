/* SPDX-License-Identifier: MIT
 *
 * The reference first, then every method from loose to tight, each run compared with it and forgotten but for its
 * errors in time and its events; then who vouches for the reference, and until when; then the rounds of timing, all
 * settings in turn, so that what the machine drifts hits all alike.
 */
#include "report/report_run.h"

#include "base/tolerances.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SETTINGS = 64, MOST_TIMES = 10000, MOST_ROUNDS = 15 };

/* A setting, and what became of it. */
typedef struct entry {
    impact_report_row row;
    impact_methods methods;
    imp_report_track track; /* its events; its states go when they are compared */
    double *e;              /* worst error at each time, from the reference */
    double cpu[MOST_ROUNDS];
    bool ran;
} entry;

typedef struct work {
    imp_report report;
    const impact_report_def *how;
    impact_report_summary *summary;
    char *message;
    unsigned long message_size;
    double began, seconds;
    impact_methods reference_methods;
    imp_report_track reference;
    entry *entries;
    int count, room;
    int compared; /* times before the horizon */
} work;

static impact_status fail(work *w, impact_status status, const char *why)
{
    if (w->message && w->message_size > 0) snprintf(w->message, w->message_size, "%s", why);
    return status;
}

const char *impact_report_method_name(impact_report_method method)
{
    static const char *const names[IMPACT_REPORT_METHODS] = {"default",    "motion = cvode", "impacts = cvode",
                                                             "gaps = ccd", "textbook",       "motion = rk4"};
    return (int)method >= 0 && method < IMPACT_REPORT_METHODS ? names[method] : NULL;
}

/* ---- what is asked ---- */

static bool falls(const double *list, int count)
{
    for (int k = 0; k < count; k++)
        if (!(list[k] > 0 && isfinite(list[k])) || (k > 0 && !(list[k] < list[k - 1]))) return false;
    return true;
}

static impact_status check(work *w)
{
    const impact_report_def *how = w->how;
    if (!(how->seconds >= 0 && isfinite(how->seconds))) return fail(w, IMPACT_EARGUMENT, "seconds must be positive");
    if (how->times < 0 || how->times > MOST_TIMES) return fail(w, IMPACT_EARGUMENT, "times must lie in 1 to 10000");
    if (how->rounds < 0 || how->rounds > MOST_ROUNDS) return fail(w, IMPACT_EARGUMENT, "rounds must lie in 1 to 15");
    const bool lists = how->tolerance_count >= 0 && how->step_count >= 0 && how->tolerance_count <= MOST_SETTINGS &&
                       how->step_count <= MOST_SETTINGS;
    if (!lists || (how->tolerances && !falls(how->tolerances, how->tolerance_count)))
        return fail(w, IMPACT_EARGUMENT, "tolerances must fall, from one to the next, and be positive");
    if (how->steps && !falls(how->steps, how->step_count))
        return fail(w, IMPACT_EARGUMENT, "steps must fall, from one to the next, and be positive");
    if (how->oracle && !(how->oracle_error > 0)) return fail(w, IMPACT_EARGUMENT, "an oracle has an error > 0");
    return IMPACT_OK;
}

/* ---- the bodies that move ---- */

static impact_status open_bodies(work *w)
{
    imp_report *r = &w->report;
    char message[200] = "";
    impact_scene *scene;
    const impact_status status = impact_scene_create(&r->def, &scene, message, sizeof message);
    if (status != IMPACT_OK) return fail(w, status, message);
    const int n = r->def.body_count;
    r->moving = imp_arena_take(r->arena, (size_t)n, sizeof *r->moving);
    r->gyration = imp_arena_take(r->arena, (size_t)n, sizeof *r->gyration);
    for (int i = 0; r->moving && r->gyration && i < n; i++) {
        impact_body_def body;
        impact_scene_body_def(scene, i, &body);
        if (body.is_static) continue;
        r->gyration[r->moving_count] = sqrt(fmax(body.moments.x, fmax(body.moments.y, body.moments.z)) / body.mass);
        r->moving[r->moving_count++] = i;
    }
    impact_scene_destroy(scene);
    if (!r->moving || !r->gyration) return IMPACT_ENOMEM;
    return r->moving_count > 0 ? IMPACT_OK : fail(w, IMPACT_EARGUMENT, "nothing moves: no report");
}

static impact_sample *new_states(const imp_report *r)
{
    return imp_arena_take(r->arena, (size_t)r->time_count * (size_t)r->moving_count, sizeof(impact_sample));
}

/* ---- times ---- */

/* k T/times; one nearer to an event than a thousandth of their distance goes that far before it. */
static double moved(const work *w, double t)
{
    const double near = w->report.def.duration / (1000.0 * w->report.time_count);
    for (int again = 0; again < 10; again++) {
        double before = t;
        for (int k = 0; k < w->reference.event_count; k++) {
            const double event = w->reference.events[k].t;
            if (fabs(t - event) < near) before = fmin(before, event - near);
        }
        if (before == t || before <= 0) break;
        t = before;
    }
    return t;
}

static impact_status choose_times(work *w)
{
    imp_report *r = &w->report;
    const impact_report_def *how = w->how;
    r->time_count = how->oracle ? how->oracle_count / r->moving_count : how->times > 0 ? how->times : 48;
    if (how->oracle && (r->time_count < 1 || how->oracle_count % r->moving_count != 0))
        return fail(w, IMPACT_EARGUMENT, "the oracle has not every body that moves at each of its times");
    r->times = imp_arena_take(r->arena, (size_t)r->time_count, sizeof *r->times);
    if (!r->times) return IMPACT_ENOMEM;
    for (int k = 0; k < r->time_count; k++) {
        r->times[k] =
            how->oracle ? how->oracle[k * r->moving_count].t : moved(w, r->def.duration * (k + 1) / r->time_count);
        for (int i = 0; how->oracle && i < r->moving_count; i++) {
            const impact_sample *s = &how->oracle[k * r->moving_count + i];
            if (s->t != r->times[k] || s->body != r->moving[i] || (k > 0 && !(s->t > r->times[k - 1])))
                return fail(w, IMPACT_EARGUMENT, "the oracle's rows are not in the order of time and bodies");
        }
    }
    return IMPACT_OK;
}

/* ---- the reference ---- */

/* The default, in its own motion without a stop: where are its events? */
static impact_status look_at_default(work *w, impact_sample *last)
{
    static const double tolerances[] = {1e-15, 1e-14, 1e-13};
    imp_report_track *track = &w->reference;
    for (int k = 0; k < 3; k++) {
        imp_report_forget(&w->report, track);
        w->reference_methods = (impact_methods){.tolerance = tolerances[k]};
        const impact_status status = imp_report_run(&w->report, &w->reference_methods, 0, track, last);
        if (status != IMPACT_OK) return status;
        if (track->complete) return IMPACT_OK;
        if (track->status == IMPACT_STOPPED && w->report.stopped) return IMPACT_STOPPED;
        if (track->status == IMPACT_STOPPED)
            return fail(w, IMPACT_STOPPED, "one run of the scene takes longer than the budget");
    }
    return fail(w, track->status < 0 ? track->status : IMPACT_EUNSETTLED,
                track->message[0] ? track->message : impact_status_string(track->status));
}

static bool same_bits(const impact_sample *a, const impact_sample *b, int count)
{
    for (int i = 0; i < count; i++)
        if (memcmp(&a[i].position, &b[i].position, sizeof a[i].position) != 0 ||
            memcmp(&a[i].orientation, &b[i].orientation, sizeof a[i].orientation) != 0 ||
            memcmp(&a[i].velocity, &b[i].velocity, sizeof a[i].velocity) != 0)
            return false;
    return true;
}

static impact_status differ(work *w)
{
    char text[200];
    const impact_scene_def *def = &w->report.def;
    const char *law = NULL;
    for (int k = 0; k < def->force_count && !law; k++)
        if (def->forces[k].kind == IMPACT_FORCE_CUSTOM) law = def->forces[k].name ? def->forces[k].name : "";
    if (law)
        snprintf(text, sizeof text, "force '%s' is not the same in two runs: a report needs laws without memory", law);
    else
        snprintf(text, sizeof text, "two runs of one setting end differently: there is nothing to compare with");
    return fail(w, IMPACT_EARGUMENT, text);
}

/* A second run, with stops: its states; and both must end with the same bits. */
static impact_status take_reference(work *w)
{
    imp_report *r = &w->report;
    impact_sample *last = imp_arena_take(r->arena, 2 * (size_t)r->moving_count, sizeof *last);
    if (!last) return IMPACT_ENOMEM;
    impact_status status = look_at_default(w, last);
    if (status == IMPACT_OK) status = choose_times(w);
    if (status != IMPACT_OK) return status;
    imp_report_forget(r, &w->reference);
    w->reference.states = new_states(r);
    if (!w->reference.states) return IMPACT_ENOMEM;
    status = imp_report_run(r, &w->reference_methods, 0, &w->reference, last + r->moving_count);
    if (status != IMPACT_OK) return status;
    if (!w->reference.complete) return fail(w, IMPACT_STOPPED, "one run of the scene takes longer than the budget");
    if (!same_bits(last, last + r->moving_count, r->moving_count)) return differ(w);
    if (w->how->oracle)
        memcpy(w->reference.states, w->how->oracle, (size_t)w->how->oracle_count * sizeof *w->how->oracle);
    return IMPACT_OK;
}

static double turned(quat a, quat b)
{
    const double dot = fmin(1, fabs(quat_dot(a, b)));
    return 2 * acos(dot);
}

/* X and V, from the reference. */
static impact_status measure_scene(work *w)
{
    imp_report *r = &w->report;
    const impact_sample *states = w->reference.states;
    for (int i = 0; i < r->moving_count; i++) {
        double way = 0;
        const impact_body_def *body = &r->def.bodies[r->moving[i]];
        qvec3 x = body->position;
        quat q = quat_unit(body->orientation);
        r->V = fmax(r->V, qvec3_norm(body->velocity) + r->gyration[i] * qvec3_norm(body->omega));
        for (int k = 0; k < r->time_count; k++) {
            const impact_sample *s = &states[k * r->moving_count + i];
            way += qvec3_norm(qvec3_sub(s->position, x)) + r->gyration[i] * turned(s->orientation, q);
            x = s->position, q = s->orientation;
            r->V = fmax(r->V, qvec3_norm(s->velocity) + r->gyration[i] * qvec3_norm(s->omega));
        }
        r->X = fmax(r->X, way);
    }
    return r->X > 0 && r->V > 0 ? IMPACT_OK : fail(w, IMPACT_EARGUMENT, "nothing moves: no report");
}

/* ---- settings ---- */

static impact_methods methods_of(impact_report_method method, double setting)
{
    const double impacts = fmax(setting, 1e-14), gaps = fmin(fmax(setting, IMP_LEAST_CCD), IMP_MOST_CCD);
    switch (method) {
    case IMPACT_REPORT_MOTION: return (impact_methods){.motion = IMPACT_MOTION_CVODE, .tolerance = setting};
    case IMPACT_REPORT_IMPACTS:
        return (impact_methods){.impacts = IMPACT_SOLVER_CVODE, .tolerance = setting, .impact_tolerance = impacts};
    case IMPACT_REPORT_GAPS: return (impact_methods){.gaps = IMPACT_GAP_CCD, .gap_tolerance = gaps};
    case IMPACT_REPORT_TEXTBOOK:
        return (impact_methods){.motion = IMPACT_MOTION_CVODE,
                                .impacts = IMPACT_SOLVER_CVODE,
                                .gaps = impact_has(IMPACT_PART_CCD) ? IMPACT_GAP_CCD : IMPACT_GAP_NEWTON,
                                .tolerance = setting,
                                .impact_tolerance = impacts,
                                .gap_tolerance = impact_has(IMPACT_PART_CCD) ? gaps : 0};
    case IMPACT_REPORT_RK4: return (impact_methods){.motion = IMPACT_MOTION_RK4, .step = setting};
    default: return (impact_methods){.tolerance = setting};
    }
}

static bool add(work *w, impact_report_method method, double setting)
{
    entry *more = imp_arena_grow(w->report.arena, w->entries, &w->room, w->count + 1, sizeof *more);
    if (!more) return false;
    w->entries = more;
    more[w->count++] = (entry){.row = {.method = method, .setting = setting, .status = IMPACT_STOPPED},
                               .methods = methods_of(method, setting > 0 ? setting : 1e-13)};
    return true;
}

/* What changes nothing in this scene, by the counters of the default, or is not to be had. */
static void find_useless(work *w)
{
    const impact_usage *u = &w->reference.usage;
    bool *useless = w->summary->useless;
    const bool cvode = impact_has(IMPACT_PART_CVODE), closed = u->ballistic_flights + u->rolls > 0;
    const long impacts = u->impacts_closed_form + u->impacts_series + u->impacts_cvode;
    useless[IMPACT_REPORT_MOTION] = !cvode || !closed;
    useless[IMPACT_REPORT_IMPACTS] = !cvode || impacts == 0 || w->report.def.compliance > 0;
    useless[IMPACT_REPORT_GAPS] = !impact_has(IMPACT_PART_CCD) || u->gap_newton + u->gap_gjk + u->gap_fallback == 0;
    useless[IMPACT_REPORT_RK4] = !closed && u->integrator_steps == 0;
    int useful = 0;
    for (int m = IMPACT_REPORT_MOTION; m <= IMPACT_REPORT_GAPS; m++) useful += !useless[m];
    useless[IMPACT_REPORT_TEXTBOOK] = !cvode || useful < 2;
}

static bool add_settings(work *w, impact_report_method method)
{
    static const double tolerances[] = {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14};
    static const double gaps[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}, steps[] = {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4};
    const impact_report_def *how = w->how;
    const impact_usage *u = &w->reference.usage;
    const double *list = how->tolerances ? how->tolerances : tolerances;
    int count = how->tolerances ? how->tolerance_count : 11;
    double unit = 1;
    if (method == IMPACT_REPORT_DEFAULT && u->integrators == 0 && u->impacts_cvode == 0) return add(w, method, 0);
    if (method == IMPACT_REPORT_GAPS) list = gaps, count = 5;
    if (method == IMPACT_REPORT_RK4) {
        list = how->steps ? how->steps : steps, count = how->steps ? how->step_count : 6;
        unit = how->steps ? 1 : fmin(1, w->report.def.duration);
    }
    for (int k = 0; k < count; k++)
        if (!add(w, method, unit * list[k])) return false;
    return true;
}

/* ---- runs ---- */

static bool of_method(const work *w, int k, int method) { return (int)w->entries[k].row.method == method; }

static impact_status run_entry(work *w, entry *e)
{
    imp_report *r = &w->report;
    e->track.states = new_states(r);
    e->e = imp_arena_take(r->arena, (size_t)r->time_count, sizeof *e->e);
    if (!e->track.states || !e->e) return IMPACT_ENOMEM;
    const impact_status status = imp_report_run(r, &e->methods, 0, &e->track, NULL);
    if (status != IMPACT_OK) return status;
    e->ran = e->track.status != IMPACT_STOPPED;
    e->row.status = e->track.status;
    e->row.reached = e->track.reached;
    e->row.account = e->track.account;
    e->row.usage = e->track.usage;
    memcpy(e->row.message, e->track.message, sizeof e->row.message);
    if (e->track.complete) imp_report_compare(r, &e->track, &w->reference, r->time_count, e->e);
    return IMPACT_OK;
}

/* Methods from m on that have settings. */
static int methods_left(const work *w, int m)
{
    int left = 0;
    for (; m < IMPACT_REPORT_METHODS; m++) {
        bool any = false;
        for (int k = 0; k < w->count; k++) any = any || of_method(w, k, m);
        left += any;
    }
    return left;
}

/* Each method has its share of what time is left, and stops where a run does not end in it. */
static impact_status run_all(work *w)
{
    const double part = 0.6, began = imp_report_now(); /* of what is left: the rest is for timing */
    const double end = began + part * (w->began + w->seconds - began);
    for (int m = 0; m < IMPACT_REPORT_METHODS; m++) {
        const double now = imp_report_now(), share = fmax(end - now, 0) / fmax(methods_left(w, m), 1);
        w->report.deadline = now + share;
        for (int k = 0; k < w->count; k++) {
            if (!of_method(w, k, m)) continue;
            const impact_status status = run_entry(w, &w->entries[k]);
            if (status != IMPACT_OK) return status;
            if (w->report.stopped) return fail(w, IMPACT_STOPPED, "stopped");
            if (!w->entries[k].ran) break;
        }
    }
    return IMPACT_OK;
}

/* ---- certainty ---- */

static int first_parting(const work *w, const entry *e)
{
    int k = 0;
    while (k < w->report.time_count && e->e[k] <= IMP_REPORT_PARTING) k++;
    return k;
}

typedef enum aspect { MOTION, IMPACTS, ASPECTS } aspect;

/* Whether the run does it by another method than the default: an integrator's motion is not vouched for by itself. */
static bool vouches(const work *w, const entry *e, aspect a)
{
    const bool closed = w->reference.usage.integrators == 0;
    if (!e->track.complete) return false;
    switch (e->row.method) {
    case IMPACT_REPORT_MOTION: return a == MOTION && closed;
    case IMPACT_REPORT_IMPACTS: return a == IMPACTS;
    case IMPACT_REPORT_TEXTBOOK: return a == IMPACTS ? !w->summary->useless[IMPACT_REPORT_IMPACTS] : closed;
    case IMPACT_REPORT_RK4: return a == MOTION;
    default: return false;
    }
}

/* Until when the reference and the nearest witness of each aspect go together. */
static void find_horizon(work *w)
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
static const entry *nearest(const work *w, aspect a)
{
    const entry *best = NULL;
    for (int k = 0; k < w->count; k++) {
        const entry *e = &w->entries[k];
        if (!vouches(w, e, a)) continue;
        if (!best || impact_report_worst(e->row.error) < impact_report_worst(best->row.error)) best = e;
    }
    return best;
}

static impact_report_witness named(const entry *e)
{
    return e ? (impact_report_witness){e->row.method, e->row.setting} : (impact_report_witness){0};
}

static void find_certainty(work *w)
{
    impact_report_summary *s = w->summary;
    const double stated = w->how->oracle_error, none = INFINITY;
    const entry *motion = nearest(w, MOTION), *impacts = nearest(w, IMPACTS);
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
static impact_status compare_all(work *w)
{
    imp_report *r = &w->report;
    const double all = INFINITY;
    for (int k = 0; k < w->count; k++) {
        entry *e = &w->entries[k];
        e->row.error = (impact_report_error){all, all, all, all};
        e->row.first_other = INFINITY;
        if (!e->track.complete) continue;
        e->row.error = imp_report_compare(r, &e->track, &w->reference, w->compared, NULL);
        if (!imp_report_match(r, &w->reference, &e->track, w->summary->horizon, &e->row)) return IMPACT_ENOMEM;
    }
    return IMPACT_OK;
}

/* ---- condition ---- */

static impact_status run_aside(work *w, double nudge, imp_report_track *track)
{
    imp_report *r = &w->report;
    *track = (imp_report_track){.states = new_states(r)};
    if (!track->states) return IMPACT_ENOMEM;
    r->deadline = imp_report_now() + fmax(w->began + w->seconds - imp_report_now(), 0) / 8;
    return imp_report_run(r, &w->reference_methods, nudge * r->X, track, NULL);
}

/* The start a little to one side and to the other: half the difference of the ends is what that makes of it, half their
 * sum less the reference what rounding does on the way, in all that every run shares. */
static impact_status find_condition(work *w)
{
    imp_report *r = &w->report;
    imp_report_track one = {0}, other = {0};
    w->summary->condition = NAN;
    if (w->how->oracle) return IMPACT_OK;
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

/* ---- time ---- */

static int compare_numbers(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return a < b ? -1 : a > b;
}

/* The slowest are timed once, by the run that was compared, until the others' rounds fit into what time is left. */
static void choose_rounds(work *w, int rounds)
{
    const double slow = 0.5, left = w->began + w->seconds - imp_report_now();
    double sum = 0;
    for (int k = 0; k < w->count; k++) {
        entry *e = &w->entries[k];
        e->row.rounds = !e->ran ? 0 : e->track.cpu > slow ? 1 : rounds;
        if (e->row.rounds > 1) sum += rounds * e->track.cpu;
    }
    while (sum > left) {
        entry *slowest = NULL;
        for (int k = 0; k < w->count; k++) {
            entry *e = &w->entries[k];
            if (e->row.rounds > 1 && (!slowest || e->track.cpu > slowest->track.cpu)) slowest = e;
        }
        if (!slowest) break;
        slowest->row.rounds = 1;
        sum -= rounds * slowest->track.cpu;
    }
}

static impact_status measure_times(work *w)
{
    const impact_report_def *how = w->how;
    const int rounds = how->rounds > 0 ? how->rounds : 7;
    w->summary->rounds = rounds;
    choose_rounds(w, rounds);
    for (int round = 0; round < rounds; round++)
        for (int k = 0; k < w->count; k++) {
            entry *e = &w->entries[k];
            if (how->go_on && !how->go_on(how->context)) return fail(w, IMPACT_STOPPED, "stopped");
            if (e->row.rounds > 1) e->cpu[round] = imp_report_time(&w->report, &e->methods);
        }
    for (int k = 0; k < w->count; k++) {
        entry *e = &w->entries[k];
        if (e->row.rounds == 0) w->summary->dropped++;
        if (e->row.rounds == 1) e->cpu[0] = e->track.cpu;
        qsort(e->cpu, (size_t)e->row.rounds, sizeof *e->cpu, compare_numbers);
        if (e->row.rounds > 0) e->row.cpu = e->cpu[0], e->row.spread = e->cpu[e->row.rounds / 2] / e->cpu[0];
    }
    return IMPACT_OK;
}

/* ---- all of it ---- */

static impact_status sweep(work *w)
{
    find_useless(w);
    for (int m = 0; m < IMPACT_REPORT_METHODS; m++)
        if (!w->summary->useless[m] && !w->how->left_out[m] && !add_settings(w, (impact_report_method)m))
            return IMPACT_ENOMEM;
    impact_status status = run_all(w);
    if (status != IMPACT_OK) return status;
    find_horizon(w);
    status = compare_all(w);
    if (status == IMPACT_OK) status = find_condition(w);
    if (status == IMPACT_OK) find_certainty(w);
    return status;
}

static impact_status hand_on(const work *w, impact_report_sink *sink, void *context)
{
    for (int k = 0; sink && k < w->count; k++)
        if (!sink(&w->entries[k].row, context)) return IMPACT_ESINK;
    return IMPACT_OK;
}

static impact_status report(work *w, impact_report_sink *sink, void *context)
{
    impact_status status = check(w);
    if (status == IMPACT_OK) status = open_bodies(w);
    if (status == IMPACT_OK) status = take_reference(w);
    if (status == IMPACT_OK) status = measure_scene(w);
    if (status == IMPACT_OK) status = sweep(w);
    if (status == IMPACT_OK) status = measure_times(w);
    if (status != IMPACT_OK) return status;
    impact_report_summary *s = w->summary;
    const bool tolerant = w->reference.usage.integrators > 0 || w->reference.usage.impacts_cvode > 0;
    s->duration = w->report.def.duration;
    s->times = w->report.time_count;
    s->events = w->reference.event_count;
    s->X = w->report.X, s->V = w->report.V;
    s->reference = w->how->oracle ? NAN : tolerant ? w->reference_methods.tolerance : 0;
    s->cpu = imp_report_now() - w->began;
    return hand_on(w, sink, context);
}

impact_status impact_report(const impact_scene_def *def, const impact_report_def *how, impact_report_sink *sink,
                            void *context, impact_report_summary *summary, char *message, unsigned long message_size)
{
    const impact_report_def as_ever = {0};
    impact_report_summary unwanted;
    imp_arena *arena;
    const impact_status status = imp_arena_create(def->allocator, &arena);
    if (message && message_size > 0) message[0] = '\0';
    if (status != IMPACT_OK) return status;
    work w = {.how = how ? how : &as_ever,
              .summary = summary ? summary : &unwanted,
              .message = message,
              .message_size = message_size,
              .began = imp_report_now()};
    *w.summary = (impact_report_summary){0};
    w.seconds = w.how->seconds > 0 ? w.how->seconds : 20;
    w.report = (imp_report){.arena = arena, .def = *def, .deadline = w.began + 0.5 * w.seconds, .how = w.how};
    w.report.def.methods = (impact_methods){0};
    w.report.def.solver = IMPACT_SOLVER_AUTO;
    w.report.def.tolerance = impact_default_scene_def().tolerance;
    const impact_status done = report(&w, sink, context);
    if (done == IMPACT_ENOMEM) fail(&w, done, impact_status_string(done));
    imp_arena_destroy(arena);
    return done;
}
