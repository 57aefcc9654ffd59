/* SPDX-License-Identifier: MIT
 *
 * Through the queue, from slot to slot.
 */
#include "base/number.h"
#include "scene/arrivals.h"
#include "scene/coarser.h"
#include "scene/scene_keys.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

/* ---- all bodies at one time ---- */

impact_status imp_scene_look_by(impact_scene *scene, double t, imp_segment_look *at, bool parted, imp_state *states)
{
    for (int i = 0; i < scene->world.body_count; i++) {
        const imp_track *track = &scene->tracks.tracks[i];
        if (track->island < 0) states[i] = at(&track->segment, &scene->world.bodies[i], t);
    }
    for (int k = 0; k < scene->island_count; k++) {
        imp_island *island = scene->islands[k];
        if (!island) continue;
        const impact_status status = imp_island_look(island, t, parted);
        if (status != IMPACT_OK) return status;
        for (int i = 0; i < island->world.body_count; i++)
            states[island->world.bodies[i].index] = island->motion.sampled[i];
    }
    return IMPACT_OK;
}

impact_status imp_scene_look(impact_scene *scene, double t)
{
    return imp_scene_look_by(scene, t, imp_segment_at, true, scene->states);
}

impact_status imp_scene_look_between(impact_scene *scene, double t)
{
    return imp_scene_look_by(scene, t, imp_segment_at, false, scene->states);
}

double imp_scene_energy_beside(impact_scene *scene, const imp_island *except, double t)
{
    double energy = imp_account_sum(&scene->account);
    for (int k = 0; k < scene->account.live_count; k++) {
        const int i = scene->account.live[k];
        const imp_state state = imp_segment_at(&scene->tracks.tracks[i].segment, &scene->world.bodies[i], t);
        energy += imp_body_energy(&scene->world.bodies[i], &state, scene->world.gravity);
    }
    for (int k = 0; k < scene->island_count; k++) {
        imp_island *island = scene->islands[k];
        const bool constant = island && (island->rests || (island->rolls && !island->loses)); /* in the account */
        if (!island || island == except || constant || imp_island_look(island, t, true) != IMPACT_OK) continue;
        energy += imp_world_kinetic_energy(&island->world, island->motion.sampled) +
                  imp_field_potential(&island->world, island->motion.sampled);
    }
    return energy;
}

static void add_works(imp_works *sum, imp_works part)
{
    sum->force += part.force;
    sum->damping += part.damping;
    sum->sliding += part.sliding;
    sum->drive += part.drive;
}

imp_works imp_scene_works(const impact_scene *scene)
{
    imp_works works = scene->works;
    for (int k = 0; k < scene->account.live_count; k++)
        works.damping += imp_scene_damped(scene, scene->account.live[k], scene->t);
    for (int k = 0; k < scene->island_count; k++)
        if (scene->islands[k]) add_works(&works, imp_island_works(scene->islands[k], scene->t));
    return works;
}

double imp_scene_damped(const impact_scene *scene, int body, double t)
{
    const imp_segment *s = &scene->tracks.tracks[body].segment;
    const imp_body *b = &scene->world.bodies[body];
    const imp_state now = imp_segment_at(s, b, t);
    return imp_body_energy(b, &s->start, scene->world.gravity) - imp_body_energy(b, &now, scene->world.gravity);
}

/* ---- samples ---- */

static double sample_time(const impact_scene *scene)
{
    const bool wanted = scene->recorder && scene->recorder->sample && scene->output_rate > 0;
    return wanted ? (double)scene->next_sample / scene->output_rate : INFINITY;
}

bool imp_scene_good_row(impact_scene *scene, const impact_sample *s)
{
    const double sum = s->t + s->position.x + s->position.y + s->position.z + s->orientation.w + s->orientation.x +
                       s->orientation.y + s->orientation.z + s->velocity.x + s->velocity.y + s->velocity.z +
                       s->omega.x + s->omega.y + s->omega.z;
    if (isfinite(sum)) return true;
    snprintf(scene->message, sizeof scene->message, "the motion of '%s' has left double precision at t = %s", s->name,
             imp_number_of(s->t).text);
    return false;
}

/* Whether the body has a row at the sample time t; of what rests, the first since then. */
static bool takes_row(impact_scene *scene, int body, double t)
{
    imp_track *track = &scene->tracks.tracks[body];
    const bool stood = track->told;
    if (scene->world.bodies[body].is_static) return false;
    track->told = track->segment.kind == IMP_SEGMENT_REST;
    return scene->samples == IMPACT_SAMPLES_ALL || !stood || t >= scene->duration;
}

static impact_status emit(impact_scene *scene, double t)
{
    const impact_recorder *recorder = scene->recorder;
    const impact_status status = imp_scene_look(scene, t);
    scene->next_sample++;
    imp_queue_set(&scene->queue, 0, sample_time(scene));
    for (int i = 0; status == IMPACT_OK && i < scene->world.body_count; i++) {
        if (!takes_row(scene, i, t)) continue;
        const impact_sample sample = imp_scene_sample(&scene->world.bodies[i], t, &scene->states[i]);
        if (!imp_scene_good_row(scene, &sample)) return IMPACT_EDOMAIN;
        scene->world.usage.samples++;
        if (!recorder->sample(recorder->context, &sample)) return IMPACT_ESINK;
    }
    return status;
}

/* ---- slots ---- */

static impact_status body_due(impact_scene *scene, int body, double t)
{
    int touching;
    const impact_status status = imp_tracks_due(&scene->tracks, body, t, &touching);
    return status == IMPACT_OK && touching >= 0 ? imp_scene_meet(scene, touching, t) : status;
}

/* A step that ends where the run does is followed by no other yet. */
static impact_status island_due(impact_scene *scene, int slot, double t, double t_end)
{
    imp_island *island = scene->islands[slot - imp_scene_island_slot(scene, 0)];
    if (t < t_end || island->end.kind != IMP_END_TIME) return imp_scene_continue(scene, island);
    imp_queue_set(&scene->queue, slot, nextafter(t, INFINITY));
    return IMPACT_OK;
}

static impact_status due(impact_scene *scene, int slot, double t, double t_end)
{
    if (slot == 0) return emit(scene, t);
    if (slot <= scene->world.body_count) return body_due(scene, slot - 1, t);
    return island_due(scene, slot, t, t_end);
}

/* Libccd's answers are taken as they come, or not at all. */
static impact_status gaps_failed(impact_scene *scene)
{
    imp_gaps *gaps = &scene->gaps;
    snprintf(scene->message, sizeof scene->message,
             "bodies '%s' and '%s' at t = %s: libccd's gap is none at gap_tolerance = %g", gaps->failed[0],
             gaps->failed[1], imp_number_of(scene->t).text, gaps->tolerance);
    gaps->failed[0] = NULL;
    return IMPACT_EUNSETTLED;
}

bool imp_scene_told(impact_scene *scene)
{
    if (++scene->steps > scene->max_steps) {
        scene->stop = IMPACT_EUNSETTLED;
        snprintf(scene->message, sizeof scene->message, "%ld steps by t = %s: the limit, max_steps", scene->max_steps,
                 imp_number_of(scene->t).text);
        return false;
    }
    return imp_scene_may_go_on(scene);
}

bool imp_scene_may_go_on(impact_scene *scene)
{
    const impact_recorder *recorder = scene->recorder;
    if (!recorder || !recorder->progress || recorder->progress(recorder->context, scene->t, scene->duration))
        return true;
    scene->stop = IMPACT_STOPPED;
    return false;
}

/* Samples begin with the first that is not before now. */
static void begin_samples(impact_scene *scene)
{
    const double first = ceil(scene->t * scene->output_rate);
    if ((double)scene->next_sample < first) scene->next_sample = (long)first;
    imp_queue_set(&scene->queue, 0, sample_time(scene));
}

bool imp_scene_rests(const impact_scene *scene) { return scene->moving == 0 && scene->movable > 0 && !scene->unsteady; }

impact_status imp_scene_go_on(impact_scene *scene, double t_end)
{
    impact_status status = IMPACT_OK;
    const long events = scene->event_count;
    scene->refused = false;
    if (!scene->begun) {
        imp_field_locate(&scene->world, scene->t, scene->states, true);
        status = imp_scene_first_arrivals(scene);
    }
    scene->begun = true;
    begin_samples(scene);
    if (status == IMPACT_OK && scene->refused) status = IMPACT_ESINK;
    if (scene->gaps.failed[0]) return gaps_failed(scene);
    while (status == IMPACT_OK) {
        const double t = imp_queue_time(&scene->queue);
        if (scene->one_event && scene->event_count > events) t_end = scene->t; /* with all else of that instant */
        if (imp_scene_rests(scene)) return IMPACT_AT_REST;
        if (t > t_end) break;
        if (scene->event_count >= scene->max_events) {
            snprintf(scene->message, sizeof scene->message, "%ld events by t = %s: the limit", scene->event_count,
                     imp_number_of(scene->t).text);
            return IMPACT_EVENT_LIMIT;
        }
        status = imp_coarser_attend(scene, t);
        if (status != IMPACT_OK) return status;
        if (!imp_scene_told(scene)) return scene->stop;
        scene->t = fmax(scene->t, t);
        status = due(scene, imp_queue_first(&scene->queue), t, t_end);
        if (scene->gaps.failed[0]) return gaps_failed(scene);
        if (status == IMPACT_OK && (scene->refused || !imp_scene_account_now_and_then(scene))) status = IMPACT_ESINK;
    }
    if (status == IMPACT_OK) scene->t = t_end;
    return status;
}
