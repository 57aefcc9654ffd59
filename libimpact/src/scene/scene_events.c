/* SPDX-License-Identifier: MIT */
#include "scene/scene_events.h"
#include "world/world_gap.h"

#include <string.h>

double imp_scene_total_energy(const impact_scene *scene)
{
    return imp_world_kinetic_energy(&scene->world, scene->states) + imp_field_potential(&scene->world, scene->states);
}

double imp_scene_undriven_energy(const impact_scene *scene)
{
    return imp_scene_total_energy(scene) - scene->motion.works.drive;
}

impact_sample imp_scene_sample(const impact_scene *scene, double t, int body, const imp_state *states)
{
    const imp_state *s = &states[body];
    const imp_body *b = &scene->world.bodies[body];
    return (impact_sample){
        t, body, b->name, s->x, s->q, b->is_static ? b->drift : s->v, b->is_static ? b->spin : imp_omega(b, s)};
}

static impact_status record_row(impact_scene *scene, int body, const imp_state *states)
{
    const impact_recorder *recorder = scene->recorder;
    if (body < 0 || scene->world.bodies[body].is_static || !recorder->sample) return IMPACT_OK;
    const impact_sample sample = imp_scene_sample(scene, scene->t, body, states);
    if (!imp_scene_good_row(scene, &sample)) return IMPACT_EDOMAIN;
    scene->world.usage.samples++;
    return recorder->sample(recorder->context, &sample) ? IMPACT_OK : IMPACT_ESINK;
}

static impact_status record_rows(impact_scene *scene, int body1, int body2, const imp_state *states)
{
    const impact_status status = record_row(scene, body1, states);
    return status == IMPACT_OK ? record_row(scene, body2, states) : status;
}

impact_status imp_scene_record(impact_scene *scene, const impact_event *event)
{
    scene->world.usage.events[event->kind]++;
    scene->event_count++;
    if (!scene->recorder) return IMPACT_OK;
    const int other = event->kind == IMPACT_EVENT_FORCE ? -1 : event->body2;
    scene->beside_event = true;
    impact_status status = record_rows(scene, event->body1, other, scene->before);
    if (status == IMPACT_OK && scene->recorder->event && !scene->recorder->event(scene->recorder->context, event))
        status = IMPACT_ESINK;
    if (status == IMPACT_OK) status = record_rows(scene, event->body1, other, scene->states);
    scene->beside_event = false;
    memcpy(scene->before, scene->states, sizeof *scene->states * (size_t)scene->world.body_count);
    return status;
}

impact_event imp_scene_event_of_touch(const impact_scene *scene, impact_event_kind kind, const imp_touch *touch)
{
    const imp_world *world = &scene->world;
    const double energy = imp_scene_total_energy(scene);
    return (impact_event){.t = scene->t,
                          .kind = kind,
                          .body1 = touch->body1,
                          .body2 = touch->body2,
                          .name1 = world->bodies[touch->body1].name,
                          .name2 = world->bodies[touch->body2].name,
                          .point = qvec3_add(scene->states[touch->body1].x, touch->r1),
                          .normal = touch->normal,
                          .phases = "",
                          .energy_before = energy,
                          .energy_after = energy};
}

impact_event imp_scene_event_of_body(const impact_scene *scene, impact_event_kind kind, int body)
{
    const double energy = imp_scene_total_energy(scene);
    return (impact_event){.t = scene->t,
                          .kind = kind,
                          .body1 = body,
                          .body2 = -1,
                          .name1 = scene->world.bodies[body].name,
                          .name2 = "",
                          .point = scene->states[body].x,
                          .phases = "",
                          .energy_before = energy,
                          .energy_after = energy};
}

void imp_scene_remember(impact_scene *scene)
{
    memcpy(scene->before, scene->states, sizeof *scene->states * (size_t)scene->world.body_count);
    for (int p = 0; p < scene->world.pair_count; p++) scene->modes[p] = scene->world.pairs[p].mode;
}
