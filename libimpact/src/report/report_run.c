/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include "report/report_run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

double imp_report_now(void)
{
#ifdef CLOCK_PROCESS_CPUTIME_ID
    struct timespec now;
    if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now) == 0) return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
#endif
    return (double)clock() / CLOCKS_PER_SEC;
}

/* ---- while it runs ---- */

typedef struct listener {
    imp_report *report;
    imp_report_track *track;
    bool full; /* no memory for an event */
} listener;

/* FNV-1a; never 0. */
static unsigned name_print(const char *name)
{
    unsigned sum = 2166136261u;
    for (; *name; name++) sum = (sum ^ (unsigned char)*name) * 16777619u;
    return sum | 1;
}

static bool note_event(void *context, const impact_event *event)
{
    listener *l = context;
    imp_report_track *track = l->track;
    imp_report_event *list =
        imp_arena_grow(l->report->arena, track->events, &track->event_room, track->event_count + 1, sizeof *list);
    l->full = !list;
    if (!list) return false;
    track->events = list;
    list[track->event_count++] =
        (imp_report_event){.t = event->t,
                           .kind = (int)event->kind,
                           .body = {event->body1, event->body2},
                           .force = event->kind == IMPACT_EVENT_FORCE ? name_print(event->name2) : 0};
    return true;
}

static bool has_time(void *context, double t, double t_end)
{
    const listener *l = context;
    const impact_report_def *how = l->report->how;
    (void)t, (void)t_end;
    if (how->go_on && !how->go_on(how->context)) l->report->stopped = true;
    return !l->report->stopped && imp_report_now() < l->report->deadline;
}

/* ---- making it ---- */

/* Across gravity, where a body that lies or stands stays; some way where there is none. */
static qvec3 aside(qvec3 gravity)
{
    const qvec3 way = {0.48, 0.64, 0.6};
    const double g = qvec3_norm(gravity);
    if (g == 0) return way;
    const qvec3 down = qvec3_scale(gravity, 1 / g), level = qvec3_axpy(-qvec3_dot(way, down), down, way);
    const double length = qvec3_norm(level);
    return length > 0.1 ? qvec3_scale(level, 1 / length) : qvec3_cross(down, (qvec3){1, 0, 0});
}

/* By so much, m, and by the same part of its own spin. */
static void set_aside(impact_body_def *body, double nudge, qvec3 gravity, double X)
{
    const qvec3 way = aside(gravity);
    body->position = qvec3_axpy(nudge, way, body->position);
    body->omega = qvec3_axpy(nudge / X * qvec3_norm(body->omega), way, body->omega);
}

static impact_status make(imp_report *report, const impact_methods *methods, double nudge, impact_scene **scene,
                          char *message, size_t size)
{
    impact_scene_def def = report->def;
    impact_body_def *bodies = NULL;
    def.methods = *methods;
    if (methods->motion != IMPACT_MOTION_AUTO && def.piles == IMPACT_PILES_STEPS) def.piles = IMPACT_PILES_AUTO;
    if (nudge != 0) {
        bodies = imp_arena_take(report->arena, (size_t)def.body_count, sizeof *bodies);
        if (!bodies) return IMPACT_ENOMEM;
        memcpy(bodies, def.bodies, (size_t)def.body_count * sizeof *bodies);
        for (int i = 0; i < def.body_count; i++)
            if (!bodies[i].is_static) set_aside(&bodies[i], i % 2 ? -nudge : nudge, def.gravity, report->X);
        def.bodies = bodies;
        def.gravity = qvec3_scale(def.gravity, 1 + nudge / report->X); /* up and down no body may be set */
    }
    const impact_status status = impact_scene_create(&def, scene, message, size);
    imp_arena_give(report->arena, bodies);
    return status;
}

/* ---- running it ---- */

static bool goes_on(impact_status status)
{
    return status >= 0 && status != IMPACT_STOPPED && status != IMPACT_EVENT_LIMIT;
}

static void read_states(const imp_report *report, const impact_scene *scene, impact_sample *states)
{
    for (int i = 0; i < report->moving_count; i++) impact_scene_body(scene, report->moving[i], &states[i]);
}

/* What does not close, over the greatest of the account's terms. */
static double account_of(const impact_scene *scene)
{
    const impact_energy e = impact_scene_energy(scene);
    const double given = e.start + e.force_work + e.drive_work,
                 left = e.kinetic + e.potential + e.damping_loss + e.sliding_loss + e.impact_loss;
    const double terms[] = {e.start,     e.force_work,   e.drive_work,   e.kinetic,
                            e.potential, e.damping_loss, e.sliding_loss, e.impact_loss};
    double greatest = 0;
    for (size_t k = 0; k < sizeof terms / sizeof *terms; k++) greatest = fmax(greatest, fabs(terms[k]));
    return greatest > 0 ? fabs(given - left) / greatest : 0;
}

static void follow(imp_report *report, impact_scene *scene, const impact_recorder *recorder, imp_report_track *track)
{
    for (int k = 0; track->states && k < report->time_count && goes_on(track->status); k++) {
        track->status = impact_scene_run_to(scene, report->times[k], recorder);
        if (goes_on(track->status))
            read_states(report, scene, track->states + (size_t)k * (size_t)report->moving_count);
    }
    if (goes_on(track->status)) track->status = impact_scene_run(scene, recorder);
    track->complete = goes_on(track->status);
}

impact_status imp_report_run(imp_report *report, const impact_methods *methods, double nudge, imp_report_track *track,
                             impact_sample *last)
{
    const double began = imp_report_now();
    listener listening = {.report = report, .track = track};
    const impact_recorder recorder = {
        .struct_size = sizeof recorder, .context = &listening, .event = note_event, .progress = has_time};
    impact_scene *scene;
    track->status = make(report, methods, nudge, &scene, track->message, sizeof track->message);
    if (track->status != IMPACT_OK) return track->status == IMPACT_ENOMEM ? IMPACT_ENOMEM : IMPACT_OK;
    follow(report, scene, &recorder, track);
    track->reached = impact_scene_time(scene);
    track->account = account_of(scene);
    track->usage = impact_scene_usage(scene);
    if (!track->complete) snprintf(track->message, sizeof track->message, "%s", impact_scene_message(scene));
    if (last) read_states(report, scene, last);
    impact_scene_destroy(scene);
    track->cpu = imp_report_now() - began;
    return listening.full || track->status == IMPACT_ENOMEM ? IMPACT_ENOMEM : IMPACT_OK;
}

void imp_report_forget(imp_report *report, imp_report_track *track)
{
    imp_arena_give(report->arena, track->states);
    imp_arena_give(report->arena, track->events);
    *track = (imp_report_track){0};
}

double imp_report_time(imp_report *report, const impact_methods *methods)
{
    const double began = imp_report_now();
    impact_scene *scene;
    if (make(report, methods, 0, &scene, NULL, 0) == IMPACT_OK) impact_scene_run(scene, NULL);
    impact_scene_destroy(scene);
    return imp_report_now() - began;
}
