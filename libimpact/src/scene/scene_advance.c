/* SPDX-License-Identifier: MIT
 *
 * From one event of a scene to the next: below the scene's own run and the groups of its crowd alike.
 */
#include "scene/scene_keys.h"
#include "scene/scene_pile.h"
#include "scene/scene_receipt.h"

#include <stdio.h>

bool imp_scene_good_row(impact_scene *scene, const impact_sample *s)
{
    const double sum = s->t + s->position.x + s->position.y + s->position.z + s->orientation.w + s->orientation.x +
                       s->orientation.y + s->orientation.z + s->velocity.x + s->velocity.y + s->velocity.z +
                       s->omega.x + s->omega.y + s->omega.z;
    if (isfinite(sum)) return true;
    snprintf(scene->message, sizeof scene->message, "the motion of '%s' has left double precision at t = %.17g",
             s->name, s->t);
    return false;
}

bool imp_scene_emit(void *context, double t, const imp_state *states)
{
    impact_scene *scene = context;
    const impact_recorder *recorder = scene->recorder;
    for (int i = 0; recorder->sample && i < scene->world.body_count; i++) {
        if (scene->world.bodies[i].is_static) continue;
        const impact_sample sample = imp_scene_sample(scene, t, i, states);
        if (!imp_scene_good_row(scene, &sample)) {
            scene->stop = IMPACT_EDOMAIN;
            return false;
        }
        scene->world.usage.samples++;
        if (recorder->sample(recorder->context, &sample)) continue;
        scene->stop = IMPACT_ESINK;
        return false;
    }
    return true;
}

/* Nothing moves, and no force may ever move anything. */
static bool all_at_rest(const impact_scene *scene)
{
    bool any = false;
    if (imp_field_unsteady(&scene->world)) return false;
    for (int i = 0; i < scene->world.body_count; i++) {
        if (scene->world.bodies[i].is_static) continue;
        if (!scene->motion.resting[i]) return false;
        any = true;
    }
    return any;
}

impact_status imp_scene_advance(impact_scene *scene, double t_end)
{
    enum { MAX_STALLS = 10000 };
    const double t_before = scene->t;
    imp_end end;
    imp_sampler silent = {.pulse = scene->sampler.pulse, .piece = scene->sampler.piece, .context = scene};
    const bool samples = scene->recorder && scene->recorder->sample;
    impact_status status =
        imp_motion_advance(&scene->motion, &scene->t, t_end, scene->states, samples ? &scene->sampler : &silent, &end);
    if (status < 0) {
        snprintf(scene->message, sizeof scene->message, "%s", scene->motion.message);
        return status;
    }
    const bool is_event = end.kind != IMP_END_TIME && end.kind != IMP_END_RENEWAL;
    if (is_event && !imp_scene_account(scene)) return IMPACT_ESINK;
    status = imp_scene_handle(scene, end);
    while (status == IMPACT_OK && imp_motion_also_crossed(&scene->motion, &end)) status = imp_scene_handle(scene, end);
    if (status == IMPACT_OK && is_event && !imp_scene_account(scene)) status = IMPACT_ESINK;
    if (status != IMPACT_OK) return status;
    imp_scene_receipt_look(scene, t_before);
    scene->stalls = scene->t > t_before ? 0 : scene->stalls + 1;
    if (scene->stalls < MAX_STALLS) return scene->stop;
    snprintf(scene->message, sizeof scene->message, "%d events at the one instant t = %.17g brought no end", MAX_STALLS,
             scene->t);
    return IMPACT_EUNSETTLED;
}

impact_status imp_scene_go_on(impact_scene *scene, double t_end, imp_scene_step step)
{
    impact_status status = IMPACT_OK;
    while (status == IMPACT_OK && scene->t < t_end) {
        if (all_at_rest(scene)) return IMPACT_AT_REST;
        if (scene->event_count >= scene->max_events) {
            snprintf(scene->message, sizeof scene->message, "%ld events by t = %.17g: the limit", scene->event_count,
                     scene->t);
            return IMPACT_EVENT_LIMIT;
        }
        scene->stop = IMPACT_OK;
        if (!scene->sampler.pulse(scene->sampler.context, scene->t) && scene->stop != IMPACT_OK) return scene->stop;
        status = imp_scene_pile_stepped(scene) ? imp_scene_pile_advance(scene, t_end) : step(scene, t_end);
        if (scene->crowd && !imp_scene_account(scene)) return IMPACT_ESINK;
    }
    return status;
}
