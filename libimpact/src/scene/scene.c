/* SPDX-License-Identifier: MIT */
#include "scene/scene_internal.h"
#include "scene/coarser.h"
#include "scene/definitions.h"
#include "scene/scene_check.h"
#include "scene/scene_keys.h"
#include "scene/scene_receipt.h"
#include "scene/saved.h"
#include "scene/scene_methods.h"
#include "scene/scene_together.h"
#include "world/world_gap.h"
#include "base/definition.h"
#include "base/floats.h"
#include "base/parts.h"
#include "collide/collide_workspace.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of two rules for one pair either could be meant. */
static impact_status check_rules(const impact_scene *scene, char *message, size_t message_size)
{
    const imp_own_rule *second = imp_rules_second(&scene->rules);
    if (!second) return IMPACT_OK;
    if (message)
        snprintf(message, message_size, "pair with '%s': its rule with '%s' is given twice",
                 scene->names.names[second->low], scene->names.names[second->high]);
    return IMPACT_EARGUMENT;
}

/* A contact of a few rounding errors is no overlap. */
static impact_status check_overlaps(impact_scene *scene, char *message, unsigned long message_size)
{
    const imp_world *world = &scene->world;
    for (int n = 0; n < scene->tracks.near_count; n++) {
        const imp_near *near = &scene->tracks.near[n];
        const imp_body *b1 = &world->bodies[near->body[0]], *b2 = &world->bodies[near->body[1]];
        impact_contact contact;
        const impact_status status = imp_gap_of(b1, &scene->states[near->body[0]], b2, &scene->states[near->body[1]],
                                                scene->world.gaps, &scene->world.usage, &contact);
        if (status < 0) {
            if (message)
                snprintf(message, message_size, "bodies '%s' and '%s': %s", b1->name, b2->name,
                         impact_status_string(status));
            return status;
        }
        const double size =
            imp_place_scale(b1, scene->states[near->body[0]].x, b2, scene->states[near->body[1]].x, contact.normal);
        if (near->beyond || contact.gap >= -IMP_OVERLAP_AT_START * size) continue;
        if (message)
            snprintf(message, message_size, "body '%s': overlaps '%s' by %.6g m at the start", b1->name, b2->name,
                     -contact.gap);
        return IMPACT_EARGUMENT;
    }
    return IMPACT_OK;
}

/* The scene in an arena of its own. */
static impact_status open_memory(const impact_scene_def *def, impact_scene **scene, char *message, unsigned long size)
{
    imp_arena *arena;
    const impact_status status = imp_arena_create(def->allocator, &arena);
    if (status != IMPACT_OK) {
        if (message)
            snprintf(message, size, "scene '%s': %s", def->name ? def->name : "",
                     status == IMPACT_ENOMEM ? "no memory for it" : "its allocator has one function without the other");
        return status;
    }
    *scene = imp_arena_take(arena, 1, sizeof **scene);
    if (*scene) return (*scene)->world.arena = arena, IMPACT_OK;
    if (message) imp_arena_explain(arena, message, size);
    imp_arena_destroy(arena);
    return IMPACT_ENOMEM;
}

impact_status imp_scene_open_workspace(impact_scene *scene, char *message, unsigned long size)
{
    const bool springs = scene->compliance > 0;
    if (!springs && scene->methods.impacts != IMPACT_SOLVER_CVODE) return IMPACT_OK;
    const impact_ode_method method = springs ? IMPACT_ODE_BDF : IMPACT_ODE_ADAMS;
    const impact_status status =
        imp_collide_workspace_in(scene->world.arena, method, scene->methods.impact_tolerance, &scene->workspace);
    if (status == IMPACT_EABSENT && message)
        snprintf(message, size, "%s CVODE, and " IMP_NO_CVODE,
                 springs ? "compliance needs" : "impacts = \"cvode\" in methods, or solver, needs");
    return status;
}

static impact_status create(const impact_scene_def *given, impact_scene **out, char *message,
                            unsigned long message_size)
{
    impact_scene_def own;
    const impact_scene_def *def = &own;
    if (!imp_floats_are_gradual()) {
        if (message)
            snprintf(message, message_size,
                     "the processor flushes small numbers to zero (FTZ or DAZ): switch that off");
        return IMPACT_EDOMAIN;
    }
    impact_scene *scene;
    impact_status status = imp_scene_take_def(given, &own, message, message_size);
    if (status == IMPACT_OK) status = open_memory(def, &scene, message, message_size);
    if (status != IMPACT_OK) return status;
    status = imp_scene_take_lists(&own, scene->world.arena, message, message_size);
    if (status == IMPACT_OK) status = imp_scene_check(def, scene->world.arena, &scene->names, message, message_size);
    if (status != IMPACT_OK) {
        if (status == IMPACT_ENOMEM && message) imp_arena_explain(scene->world.arena, message, message_size);
        impact_scene_destroy(scene);
        return status;
    }
    scene->duration = def->duration;
    scene->law = def->law;
    scene->compliance = def->compliance;
    scene->methods = imp_scene_methods_of(def);
    scene->gaps = (imp_gaps){.method = scene->methods.gaps, .tolerance = scene->methods.gap_tolerance};
    scene->together = imp_scene_together_of(def);
    scene->rest_height = def->rest_height;
    scene->rest_speed = def->rest_speed;
    scene->pile_tolerance = def->pile_tolerance;
    scene->pile_parted = INFINITY;
    scene->max_events = def->max_events;
    scene->max_steps = def->max_steps;
    scene->piles = imp_scene_piles_of(def);
    scene->samples = def->samples;
    scene->key_tolerance = def->key_tolerance;
    scene->print = imp_scene_print(def);
    scene->output_rate = def->output_rate;
    status = imp_scene_build(scene, def);
    imp_scene_receipt_begin(scene);
    if (status == IMPACT_OK) status = check_rules(scene, message, message_size);
    if (status == IMPACT_OK) status = imp_scene_open_workspace(scene, message, message_size);
    if (status == IMPACT_OK) {
        imp_field_locate(&scene->world, scene->t, scene->states, false);
        scene->energy_start =
            imp_world_kinetic_energy(&scene->world, scene->states) + imp_field_potential(&scene->world, scene->states);
    }
    if (status == IMPACT_OK && !isfinite(scene->energy_start)) {
        status = IMPACT_EDOMAIN;
        if (message)
            snprintf(message, message_size, "scene '%s': its energy lies beyond double precision: take other units",
                     def->name ? def->name : "");
    }
    if (status == IMPACT_OK) status = imp_tracks_begin(&scene->tracks, 0, scene->states);
    if (status == IMPACT_OK) status = check_overlaps(scene, message, message_size);
    if (status == IMPACT_ENOMEM && message) imp_arena_explain(scene->world.arena, message, message_size);
    if (status != IMPACT_OK) {
        impact_scene_destroy(scene);
        return status;
    }
    *out = scene;
    return IMPACT_OK;
}

impact_status impact_scene_create(const impact_scene_def *def, impact_scene **out, char *message,
                                  unsigned long message_size)
{
    const imp_floats floats = imp_floats_hold();
    *out = NULL;
    if (message && message_size > 0) message[0] = '\0';
    const impact_status status = create(def, out, message, message_size);
    imp_floats_give_back(&floats);
    return status;
}

void impact_scene_destroy(impact_scene *scene)
{
    if (!scene) return;
    imp_coarser_end(scene);
    for (int k = 0; k < scene->island_count; k++)
        if (scene->islands[k]) imp_motion_forget(&scene->islands[k]->motion);
    for (int k = 0; k < scene->spare_count; k++) imp_motion_forget(&scene->spares[k]->motion);
    impact_collide_workspace_destroy(scene->workspace);
    imp_arena_destroy(scene->world.arena); /* with everything else */
}

static impact_status run(impact_scene *scene, double t_end)
{
    scene->message[0] = '\0';
    scene->stop = IMPACT_OK;
    if (scene->failed) {
        snprintf(scene->message, sizeof scene->message, "the scene's run has failed, or was stopped amid an instant");
        return IMPACT_EUNSETTLED;
    }
    if (!isfinite(t_end)) {
        snprintf(scene->message, sizeof scene->message, "t = %g is no time to run to", t_end);
        return IMPACT_EDOMAIN;
    }
    if (t_end < scene->t) {
        snprintf(scene->message, sizeof scene->message, "t = %.15g is over: the scene stands at %.15g s", t_end,
                 scene->t);
        return IMPACT_EARGUMENT;
    }
    const impact_status status = imp_scene_go_on(scene, t_end);
    scene->failed = scene->failed || (status < 0 && status != IMPACT_ESINK);
    return status;
}

static impact_status run_on(impact_scene *scene, double t, const impact_recorder *recorder)
{
    impact_recorder own = {0};
    const char *why = recorder ? imp_definition_refusal(recorder, sizeof own) : NULL;
    if (why) {
        snprintf(scene->message, sizeof scene->message, "recorder: struct_size = %zu: %s", recorder->struct_size, why);
        return IMPACT_EARGUMENT;
    }
    if (recorder) imp_definition_take(recorder, &own, sizeof own);
    const imp_floats floats = imp_floats_hold();
    scene->recorder = recorder ? &own : NULL;
    impact_status status = imp_scene_keys_begin(scene);
    if (status == IMPACT_OK) {
        const impact_status ran = run(scene, t);
        const impact_status seen =
            scene->is_coarser ? imp_scene_look_between(scene, scene->t) : imp_scene_look(scene, scene->t);
        status = imp_scene_receipt_judge(scene, ran == IMPACT_OK ? seen : ran);
        const impact_status followed = imp_coarser_follow(scene);
        if (followed != IMPACT_OK) status = followed;
    }
    if (!imp_scene_keys_end(scene) && status >= 0) status = IMPACT_ESINK;
    scene->recorder = NULL;
    if (status == IMPACT_ENOMEM) imp_arena_explain(scene->world.arena, scene->message, sizeof scene->message);
    if (status < 0 && scene->message[0] == '\0')
        snprintf(scene->message, sizeof scene->message, "%s", impact_status_string(status));
    imp_floats_give_back(&floats);
    return status;
}

/* Where nothing moves any more a run is over, its time that of the rest; what was asked for a time has come there. */
impact_status impact_scene_run_to(impact_scene *scene, double t, const impact_recorder *recorder)
{
    const impact_status status = run_on(scene, t, recorder);
    if (status >= 0 && imp_scene_rests(scene)) scene->t = t;
    return status;
}

impact_status impact_scene_step(impact_scene *scene, double t_max, const impact_recorder *recorder, impact_event *event)
{
    impact_event unwanted;
    scene->first_event = event ? event : &unwanted;
    *scene->first_event = (impact_event){.t = t_max, .body1 = -1, .body2 = -1, .name1 = "", .name2 = "", .phases = ""};
    scene->one_event = true;
    const impact_status status = run_on(scene, t_max, recorder);
    scene->one_event = false;
    scene->first_event = NULL;
    return status;
}

impact_status impact_scene_run(impact_scene *scene, const impact_recorder *recorder)
{
    return run_on(scene, fmax(scene->duration, scene->t), recorder);
}

const char *impact_scene_message(const impact_scene *scene) { return scene->message; }

const char *impact_scene_name(const impact_scene *scene) { return scene->name; }

double impact_scene_time(const impact_scene *scene) { return scene->t; }

int impact_scene_find(const impact_scene *scene, const char *body) { return imp_names_find(&scene->names, body); }

impact_status impact_scene_body(const impact_scene *scene, int body, impact_sample *sample)
{
    if (body < 0 || body >= scene->world.body_count) return IMPACT_EARGUMENT;
    *sample = imp_scene_sample(&scene->world.bodies[body], scene->t, &scene->states[body]);
    return IMPACT_OK;
}

impact_memory impact_scene_memory(const impact_scene *scene) { return imp_arena_memory(scene->world.arena); }

int impact_scene_body_count(const impact_scene *scene) { return scene->world.body_count; }

impact_status impact_scene_body_def(const impact_scene *scene, int body, impact_body_def *def)
{
    const bool known = body >= 0 && body < scene->world.body_count;
    if (!known || imp_definition_refusal(def, IMP_MOST_DEFINITION)) return IMPACT_EARGUMENT;
    const imp_body *b = &scene->world.bodies[body];
    const impact_sample now = imp_scene_sample(b, scene->t, &scene->states[body]);
    const impact_body_def own = {.name = b->name,
                                 .shape = b->given ? *b->given : b->shape,
                                 .user = b->user,
                                 .trail = b->trail,
                                 .is_static = b->is_static,
                                 .mass = b->mass,
                                 .density = NAN,
                                 .moments = b->moments,
                                 .position = now.position,
                                 .orientation = now.orientation,
                                 .shape_position = b->offset,
                                 .shape_orientation = b->turn,
                                 .velocity = now.velocity,
                                 .omega = now.omega,
                                 .friction = b->friction,
                                 .restitution = b->restitution,
                                 .torsional_friction = b->torsional,
                                 .rolling_friction = b->rolling,
                                 .linear_damping = -expm1(-b->linear_rate),
                                 .angular_damping = -expm1(-b->angular_rate)};
    imp_definition_give(&own, sizeof own, def, def->struct_size);
    return IMPACT_OK;
}

qvec3 impact_scene_gravity(const impact_scene *scene) { return scene->world.gravity; }

const char *impact_scene_force_name(const impact_scene *scene, int force)
{
    return force >= 0 && force < scene->world.field_count ? scene->world.fields[force].name : NULL;
}

double impact_scene_key_tolerance(const impact_scene *scene) { return scene->key_tolerance; }

impact_usage impact_scene_usage(const impact_scene *scene) { return scene->world.usage; }

double impact_scene_pile_error(const impact_scene *scene) { return scene->pile_error + scene->made; }

double impact_scene_pile_parted(const impact_scene *scene) { return scene->pile_parted; }

impact_energy impact_scene_energy(const impact_scene *scene) { return imp_scene_energy_of(scene, scene->states); }

impact_energy imp_scene_energy_of(const impact_scene *scene, const imp_state *states)
{
    const imp_works works = imp_scene_works(scene);
    double impact_loss = scene->impact_loss;
    for (int k = 0; k < scene->island_count; k++)
        if (scene->islands[k]) impact_loss += imp_island_loss(scene->islands[k], scene->t);
    return (impact_energy){.start = scene->energy_start,
                           .kinetic = imp_world_kinetic_energy(&scene->world, states),
                           .potential = imp_field_potential(&scene->world, states),
                           .force_work = works.force,
                           .drive_work = works.drive,
                           .damping_loss = works.damping,
                           .sliding_loss = works.sliding,
                           .impact_loss = impact_loss};
}
