/* SPDX-License-Identifier: MIT */
#include "scene/scene_events.h"

#include <stdio.h>
#include <string.h>

double imp_scene_total_energy(const imp_island *island) { return imp_island_energy(island); }

double imp_scene_undriven_energy(const imp_island *island)
{
    return imp_scene_total_energy(island) - island->motion.works.drive;
}

impact_sample imp_scene_sample(const imp_body *body, double t, const imp_state *s)
{
    return (impact_sample){t,
                           body->index,
                           body->name,
                           s->x,
                           s->q,
                           body->is_static ? body->drift : s->v,
                           body->is_static ? body->spin : imp_omega(body, s)};
}

static impact_status record_row(imp_island *island, int body, const imp_state *states)
{
    const impact_recorder *recorder = island->scene->recorder;
    if (body < 0 || island->world.bodies[body].is_static || !recorder->sample) return IMPACT_OK;
    const impact_sample sample = imp_scene_sample(&island->world.bodies[body], island->t, &states[body]);
    if (!imp_scene_good_row(island->scene, &sample)) return IMPACT_EDOMAIN;
    island->world.usage.samples++;
    if (!recorder->sample(recorder->context, &sample)) island->scene->refused = true;
    return IMPACT_OK;
}

static impact_status record_rows(imp_island *island, int body1, int body2, const imp_state *states)
{
    const impact_status status = record_row(island, body1, states);
    return status == IMPACT_OK ? record_row(island, body2, states) : status;
}

bool imp_scene_tells_events(const imp_island *island)
{
    const impact_scene *scene = island->scene;
    return scene->first_event || (scene->recorder && scene->recorder->event);
}

/* The first event of a run that is to end with it; its words live as long as the scene. */
static void keep_first(impact_scene *scene, const impact_event *event)
{
    *scene->first_event = *event;
    snprintf(scene->first_phases, sizeof scene->first_phases, "%s", event->phases);
    scene->first_event->phases = scene->first_phases;
    scene->first_event = NULL;
}

/* The event as the caller knows its bodies, with the energy of those elsewhere. */
static void record_event(const imp_island *island, const impact_event *event)
{
    impact_scene *scene = island->scene;
    const impact_recorder *recorder = scene->recorder;
    if (!imp_scene_tells_events(island)) return;
    impact_event told = *event;
    told.body1 = island->world.bodies[event->body1].index;
    if (event->body2 >= 0) told.body2 = island->world.bodies[event->body2].index;
    told.energy_before += island->outside;
    told.energy_after += island->outside;
    if (scene->first_event) keep_first(scene, &told);
    if (recorder && recorder->event && !recorder->event(recorder->context, &told)) scene->refused = true;
}

impact_status imp_scene_record(imp_island *island, const impact_event *event)
{
    island->world.usage.events[event->kind]++;
    island->scene->event_count++;
    if (!island->scene->recorder) {
        record_event(island, event);
        return IMPACT_OK;
    }
    const int other = event->kind == IMPACT_EVENT_FORCE ? -1 : event->body2;
    impact_status status = record_rows(island, event->body1, other, island->before);
    if (status == IMPACT_OK) record_event(island, event);
    if (status == IMPACT_OK) status = record_rows(island, event->body1, other, island->states);
    memcpy(island->before, island->states, sizeof *island->states * (size_t)island->world.body_count);
    return status;
}

static double energy_told(const imp_island *island)
{
    return imp_scene_tells_events(island) ? imp_scene_total_energy(island) : 0;
}

impact_event imp_scene_event_of_contact(const imp_island *island, impact_event_kind kind,
                                        const imp_held_contact *contact)
{
    const imp_world *world = &island->world;
    const double energy = energy_told(island);
    return (impact_event){.t = island->t,
                          .kind = kind,
                          .body1 = contact->body1,
                          .body2 = contact->body2,
                          .name1 = world->bodies[contact->body1].name,
                          .name2 = world->bodies[contact->body2].name,
                          .point = qvec3_add(island->states[contact->body1].x, contact->r1),
                          .normal = contact->normal,
                          .phases = "",
                          .energy_before = energy,
                          .energy_after = energy};
}

impact_event imp_scene_event_of_body(const imp_island *island, impact_event_kind kind, int body)
{
    const double energy = energy_told(island);
    return (impact_event){.t = island->t,
                          .kind = kind,
                          .body1 = body,
                          .body2 = -1,
                          .name1 = island->world.bodies[body].name,
                          .name2 = "",
                          .point = island->states[body].x,
                          .phases = "",
                          .energy_before = energy,
                          .energy_after = energy};
}

void imp_scene_remember(imp_island *island)
{
    memcpy(island->before, island->states, sizeof *island->states * (size_t)island->world.body_count);
    for (int p = 0; p < island->world.pair_count; p++)
        island->notes[p] = (imp_note){.mode = island->world.pairs[p].mode};
}

const char *imp_scene_phases_in_words(const unsigned char *phases, int count, char *words, size_t size)
{
    size_t used = 0;
    words[0] = '\0';
    for (int i = 0; i < count && used < size; i++)
        used += (size_t)snprintf(words + used, size - used, "%s%s", i ? " " : "",
                                 impact_phase_name((impact_phase)phases[i]));
    return words;
}
