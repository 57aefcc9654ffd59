/* SPDX-License-Identifier: MIT
 *
 * A recorder that keeps all rows of a run, and the bodies the scene tests share.
 */
#ifndef SCENE_LOG_H
#define SCENE_LOG_H

#include <stdlib.h>
#include <string.h>
#include <impact/scene.h>
#include <quat/rotation.h>
#include "kit/near.h"

typedef struct scene_log {
    impact_sample *samples;
    impact_event *events;
    char (*phases)[64];
    int sample_count, event_count;
} scene_log;

static inline bool log_sample(void *context, const impact_sample *sample)
{
    scene_log *log = context;
    log->samples = realloc(log->samples, (size_t)(log->sample_count + 1) * sizeof *log->samples);
    log->samples[log->sample_count++] = *sample;
    return true;
}

static inline bool log_event(void *context, const impact_event *event)
{
    scene_log *log = context;
    const size_t count = (size_t)log->event_count + 1;
    log->events = realloc(log->events, count * sizeof *log->events);
    log->phases = realloc(log->phases, count * sizeof *log->phases);
    strncpy(log->phases[log->event_count], event->phases, sizeof *log->phases - 1);
    log->phases[log->event_count][sizeof *log->phases - 1] = '\0';
    log->events[log->event_count++] = *event;
    return true;
}

static inline impact_recorder log_recorder(scene_log *log)
{
    return (impact_recorder){
        .struct_size = sizeof(impact_recorder), .context = log, .sample = log_sample, .event = log_event};
}

static inline void free_log(scene_log *log)
{
    free(log->samples);
    free(log->events);
    free(log->phases);
    *log = (scene_log){0};
}

/* Index of the n-th (from 0) event of the kind, with these words for phases (NULL: any), or -1. */
static inline int find_event(const scene_log *log, impact_event_kind kind, const char *phases, int n)
{
    for (int i = 0; i < log->event_count; i++)
        if (log->events[i].kind == kind && (!phases || strcmp(log->phases[i], phases) == 0) && n-- == 0) return i;
    return -1;
}

static inline impact_scene *make_scene(const impact_scene_def *def)
{
    char message[256];
    impact_scene *scene;
    if (impact_scene_create(def, &scene, message, sizeof message) != IMPACT_OK) fail_msg("%s", message);
    return scene;
}

static inline impact_body_def plane_body(const char *name, qvec3 position, quat orientation, double friction,
                                         double restitution)
{
    impact_body_def body = impact_default_body_def();
    body.name = name;
    body.is_static = true;
    body.position = position;
    body.orientation = orientation;
    body.friction = friction;
    body.restitution = restitution;
    impact_shape_plane(INFINITY, INFINITY, &body.shape);
    return body;
}

static inline impact_body_def ball_body(const char *name, qvec3 position, double friction, double restitution)
{
    impact_body_def body = impact_default_body_def();
    body.name = name;
    body.position = position;
    body.mass = 4;
    body.friction = friction;
    body.restitution = restitution;
    impact_shape_sphere(0.3, &body.shape);
    return body;
}

#endif
