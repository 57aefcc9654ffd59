/* SPDX-License-Identifier: MIT
 *
 * A report in its order. The reference first, then every method from loose to tight, each run compared with it and
 * forgotten but for its errors in time and its events; then who vouches for the reference, and until when; then the
 * rounds of timing, all settings in turn, so that what the machine drifts hits all alike.
 */
#include "report/report_work.h"
#include "base/tolerances.h"
#include "base/definition.h"
#include "scene/definitions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

impact_status imp_report_fail(imp_report_work *w, impact_status status, const char *why)
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

static impact_status check(imp_report_work *w)
{
    const impact_report_def *how = w->how;
    if (!(how->seconds >= 0 && isfinite(how->seconds)))
        return imp_report_fail(w, IMPACT_EARGUMENT, "seconds must be positive");
    if (how->times < 0 || how->times > IMP_REPORT_TIMES)
        return imp_report_fail(w, IMPACT_EARGUMENT, "times must lie in 1 to 10000");
    if (how->rounds < 0 || how->rounds > IMP_REPORT_ROUNDS)
        return imp_report_fail(w, IMPACT_EARGUMENT, "rounds must lie in 1 to 15");
    const bool lists = how->tolerance_count >= 0 && how->step_count >= 0 &&
                       how->tolerance_count <= IMP_REPORT_SETTINGS && how->step_count <= IMP_REPORT_SETTINGS;
    if (!lists || (how->tolerances && !falls(how->tolerances, how->tolerance_count)))
        return imp_report_fail(w, IMPACT_EARGUMENT, "tolerances must fall, from one to the next, and be positive");
    if (how->steps && !falls(how->steps, how->step_count))
        return imp_report_fail(w, IMPACT_EARGUMENT, "steps must fall, from one to the next, and be positive");
    if (how->oracle && !(how->oracle_error > 0))
        return imp_report_fail(w, IMPACT_EARGUMENT, "an oracle has an error > 0");
    return IMPACT_OK;
}

/* ---- the bodies that move ---- */

static impact_status open_bodies(imp_report_work *w)
{
    imp_report *r = &w->report;
    char message[200] = "";
    impact_scene *scene;
    const impact_status status = impact_scene_create(&r->def, &scene, message, sizeof message);
    if (status != IMPACT_OK) return imp_report_fail(w, status, message);
    const int n = r->def.body_count;
    r->moving = imp_arena_take(r->arena, (size_t)n, sizeof *r->moving);
    r->gyration = imp_arena_take(r->arena, (size_t)n, sizeof *r->gyration);
    for (int i = 0; r->moving && r->gyration && i < n; i++) {
        impact_body_def body = impact_default_body_def();
        impact_scene_body_def(scene, i, &body);
        if (body.is_static) continue;
        r->gyration[r->moving_count] = sqrt(fmax(body.moments.x, fmax(body.moments.y, body.moments.z)) / body.mass);
        r->moving[r->moving_count++] = i;
    }
    impact_scene_destroy(scene);
    if (!r->moving || !r->gyration) return IMPACT_ENOMEM;
    return r->moving_count > 0 ? IMPACT_OK : imp_report_fail(w, IMPACT_EARGUMENT, "nothing moves: no report");
}

impact_sample *imp_report_new_states(const imp_report *r)
{
    return imp_arena_take(r->arena, (size_t)r->time_count * (size_t)r->moving_count, sizeof(impact_sample));
}

/* ---- times ---- */

/* (k/times) T, which ends at T whatever it is (0.2 48/48 is above 0.2); one nearer to an event than a thousandth of
 * their distance goes that far before it. */
static double moved(const imp_report_work *w, double t)
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

static impact_status choose_times(imp_report_work *w)
{
    imp_report *r = &w->report;
    const impact_report_def *how = w->how;
    r->time_count = how->oracle ? how->oracle_count / r->moving_count : how->times > 0 ? how->times : 48;
    if (how->oracle && (r->time_count < 1 || how->oracle_count % r->moving_count != 0))
        return imp_report_fail(w, IMPACT_EARGUMENT, "the oracle has not every body that moves at each of its times");
    r->times = imp_arena_take(r->arena, (size_t)r->time_count, sizeof *r->times);
    if (!r->times) return IMPACT_ENOMEM;
    for (int k = 0; k < r->time_count; k++) {
        r->times[k] = how->oracle ? how->oracle[k * r->moving_count].t
                                  : moved(w, r->def.duration * ((double)(k + 1) / r->time_count));
        for (int i = 0; how->oracle && i < r->moving_count; i++) {
            const impact_sample *s = &how->oracle[k * r->moving_count + i];
            if (s->t != r->times[k] || s->body != r->moving[i] || (k > 0 && !(s->t > r->times[k - 1])))
                return imp_report_fail(w, IMPACT_EARGUMENT,
                                       "the oracle's rows are not in the order of time and bodies");
        }
    }
    return IMPACT_OK;
}

/* ---- the reference ---- */

/* The default, in its own motion without a stop: where are its events? */
static impact_status look_at_default(imp_report_work *w, impact_sample *last)
{
    static const double tolerances[] = {1e-15, 1e-14, 1e-13};
    imp_report_track *track = &w->reference;
    for (int k = 0; k < 3; k++) {
        imp_report_forget(&w->report, track);
        w->reference_methods = (impact_methods){.tolerance = tolerances[k]};
        const impact_status status = imp_report_run(&w->report, &w->reference_methods, 0, track, last);
        if (status != IMPACT_OK) return status;
        if (track->complete) return IMPACT_OK;
        if (track->status == IMPACT_STOPPED && w->report.stopped) return imp_report_fail(w, IMPACT_STOPPED, "stopped");
        if (track->status == IMPACT_STOPPED)
            return imp_report_fail(w, IMPACT_STOPPED, "one run of the scene takes longer than the budget");
    }
    return imp_report_fail(w, track->status < 0 ? track->status : IMPACT_EUNSETTLED,
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

static impact_status differ(imp_report_work *w)
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
    return imp_report_fail(w, IMPACT_EARGUMENT, text);
}

/* A second run, with stops: its states; and both must end with the same bits. */
static impact_status take_reference(imp_report_work *w)
{
    imp_report *r = &w->report;
    impact_sample *last = imp_arena_take(r->arena, 2 * (size_t)r->moving_count, sizeof *last);
    if (!last) return IMPACT_ENOMEM;
    impact_status status = look_at_default(w, last);
    if (status == IMPACT_OK) status = choose_times(w);
    if (status != IMPACT_OK) return status;
    imp_report_forget(r, &w->reference);
    w->reference.states = imp_report_new_states(r);
    if (!w->reference.states) return IMPACT_ENOMEM;
    status = imp_report_run(r, &w->reference_methods, 0, &w->reference, last + r->moving_count);
    if (status != IMPACT_OK) return status;
    if (!w->reference.complete)
        return imp_report_fail(w, IMPACT_STOPPED, "one run of the scene takes longer than the budget");
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
static impact_status measure_scene(imp_report_work *w)
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
    return r->X > 0 && r->V > 0 ? IMPACT_OK : imp_report_fail(w, IMPACT_EARGUMENT, "nothing moves: no report");
}

/* ---- runs ---- */

static impact_status run_entry(imp_report_work *w, imp_report_entry *e)
{
    imp_report *r = &w->report;
    e->track.states = imp_report_new_states(r);
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
static int methods_left(const imp_report_work *w, int m)
{
    int left = 0;
    for (; m < IMPACT_REPORT_METHODS; m++) {
        bool any = false;
        for (int k = 0; k < w->count; k++) any = any || (int)w->entries[k].row.method == m;
        left += any;
    }
    return left;
}

/* Each method has its share of what time is left, and stops where a run does not end in it. */
static impact_status run_all(imp_report_work *w)
{
    const double part = 0.6, began = imp_report_now(); /* of what is left: the rest is for timing */
    const double end = began + part * (w->began + w->seconds - began);
    for (int m = 0; m < IMPACT_REPORT_METHODS; m++) {
        const double now = imp_report_now(), share = fmax(end - now, 0) / fmax(methods_left(w, m), 1);
        w->report.deadline = now + share;
        for (int k = 0; k < w->count; k++) {
            if ((int)w->entries[k].row.method != m) continue;
            const impact_status status = run_entry(w, &w->entries[k]);
            if (status != IMPACT_OK) return status;
            if (w->report.stopped) return imp_report_fail(w, IMPACT_STOPPED, "stopped");
            if (!w->entries[k].ran) break;
        }
    }
    return IMPACT_OK;
}

/* ---- all of it ---- */

static impact_status sweep(imp_report_work *w)
{
    if (!imp_report_choose_settings(w)) return IMPACT_ENOMEM;
    impact_status status = run_all(w);
    if (status != IMPACT_OK) return status;
    imp_report_find_horizon(w);
    status = imp_report_compare_all(w);
    if (status == IMPACT_OK) status = imp_report_find_condition(w);
    if (status == IMPACT_OK) imp_report_find_certainty(w);
    return status;
}

static impact_status hand_on(const imp_report_work *w, impact_report_sink *sink, void *context)
{
    for (int k = 0; sink && k < w->count; k++)
        if (!sink(&w->entries[k].row, context)) return IMPACT_ESINK;
    return IMPACT_OK;
}

static impact_status report(imp_report_work *w, impact_report_sink *sink, void *context)
{
    impact_status status = check(w);
    if (status == IMPACT_OK) status = open_bodies(w);
    if (status == IMPACT_OK) status = take_reference(w);
    if (status == IMPACT_OK) status = measure_scene(w);
    if (status == IMPACT_OK) status = sweep(w);
    if (status == IMPACT_OK) status = imp_report_measure_times(w);
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

/* Both definitions, as this version has them. */
static impact_status take(imp_report_work *w, const impact_scene_def *def, const impact_report_def *how,
                          impact_report_def *own)
{
    const char *why = how ? imp_definition_refusal(how, sizeof *own) : NULL;
    if (why && w->message)
        snprintf(w->message, w->message_size, "report: struct_size = %zu: %s", how->struct_size, why);
    if (why) return IMPACT_EARGUMENT;
    if (how) imp_definition_take(how, own, sizeof *own);
    return imp_scene_take_def(def, &w->report.def, w->message, w->message_size);
}

impact_status impact_report(const impact_scene_def *def, const impact_report_def *how, impact_report_sink *sink,
                            void *context, impact_report_summary *summary, char *message, unsigned long message_size)
{
    impact_report_def own_how = {.struct_size = sizeof own_how};
    impact_report_summary unwanted;
    imp_report_work w = {.how = &own_how,
                         .summary = summary ? summary : &unwanted,
                         .message = message,
                         .message_size = message_size,
                         .began = imp_report_now()};
    *w.summary = (impact_report_summary){0};
    if (message && message_size > 0) message[0] = '\0';
    impact_status status = take(&w, def, how, &own_how);
    if (status == IMPACT_OK) status = imp_arena_create(w.report.def.allocator, &w.report.arena);
    if (status != IMPACT_OK) return status;
    w.seconds = IMP_REPORT_WORK * (own_how.seconds > 0 ? own_how.seconds : 20);
    w.report.deadline = w.began + 0.5 * w.seconds;
    w.report.how = &own_how;
    w.report.def.methods = (impact_methods){0};
    w.report.def.solver = IMPACT_SOLVER_AUTO;
    w.report.def.tolerance = impact_default_scene_def().tolerance;
    status = imp_scene_take_lists(&w.report.def, w.report.arena, message, message_size);
    if (status == IMPACT_OK) status = report(&w, sink, context);
    if (status == IMPACT_ENOMEM) imp_report_fail(&w, status, impact_status_string(status));
    imp_arena_destroy(w.report.arena);
    return status;
}
