/* SPDX-License-Identifier: MIT */
#include "scene/scene_pile.h"
#include "base/tolerances.h"
#include "motion/pile.h"
#include "scene/scene_crowd.h"
#include "scene/scene_events.h"
#include "scene/scene_keys.h"

#include <stdio.h>
#include <string.h>

struct imp_scene_pile {
    imp_pile pile;
    bool stepping, always;
    double since;  /* s: where counting began: */
    long pulses;   /* the integrator's steps with bodies held on each other */
    int alone;     /* steps since two bodies that move touched */
    double error;  /* m, of all steps */
    imp_state *at; /* per body: states of a sample */
};

impact_status imp_scene_pile_open(impact_scene *scene, impact_piles piles)
{
    imp_arena *arena = scene->world.arena;
    if (piles == IMPACT_PILES_EXACT) return IMPACT_OK;
    struct imp_scene_pile *p = scene->pile = imp_arena_take(arena, 1, sizeof *p);
    if (!p) return IMPACT_ENOMEM;
    p->at = imp_arena_take(arena, (size_t)scene->world.body_count, sizeof *p->at);
    p->stepping = p->always = piles == IMPACT_PILES_STEPS;
    scene->world.usage.islands_stepped = p->stepping;
    imp_pile_open(&p->pile, arena);
    return p->at ? IMPACT_OK : IMPACT_ENOMEM;
}

double impact_scene_pile_error(const impact_scene *scene) { return scene->pile ? scene->pile->error : 0; }

bool imp_scene_pile_stepped(const impact_scene *scene) { return scene->pile && scene->pile->stepping; }

/* ---- when ---- */

/* Whether bodies that move are held on each other with friction, and by three contacts in all: fewer are no pile. */
static bool is_pile(const imp_world *world)
{
    int held = 0;
    bool rough = false;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        if (!imp_is_held(pair)) continue;
        held++;
        rough = rough || (!world->bodies[pair->body2].is_static && pair->friction > 0);
    }
    return rough && held >= 3;
}

static bool begin_steps(impact_scene *scene)
{
    struct imp_scene_pile *p = scene->pile;
    p->stepping = true;
    p->alone = 0;
    imp_pile_begin(&p->pile);
    scene->world.usage.islands_stepped++;
    return true;
}

/* One more step of the integrator, of a world of the scene's bodies at time t: whether patience is at its end. */
static bool count_step(impact_scene *scene, const imp_world *world, const imp_state *states, double t)
{
    struct imp_scene_pile *p = scene->pile;
    if (!p || p->stepping || !is_pile(world)) return false;
    if (!(fabs(t - p->since) <= imp_pile_natural_time(world, states))) p->since = t, p->pulses = 0;
    return ++p->pulses >= IMP_PILE_PATIENCE && begin_steps(scene);
}

bool imp_scene_pile_pulse(impact_scene *scene) { return count_step(scene, &scene->world, scene->states, scene->t); }

bool imp_scene_pile_party(impact_scene *whole, const impact_scene *party)
{
    return count_step(whole, &party->world, party->states, party->t);
}

/* ---- rows ---- */

/* The ends of a body's step as keys: the motion between them is their polynomial. */
static void find_ends(const impact_scene *scene, int i, const imp_state *from, double t, impact_key keys[2])
{
    const imp_body *body = &scene->world.bodies[i];
    const imp_state *a = &from[i], *b = &scene->states[i];
    const double rate = 1 / (scene->t - t);
    const qvec3 acceleration = qvec3_scale(qvec3_sub(b->v, a->v), rate),
                torque = qvec3_scale(qvec3_sub(b->momentum, a->momentum), rate);
    keys[0] = imp_key_of(body, i, t, a, acceleration, torque);
    keys[1] = imp_key_of(body, i, scene->t, b, acceleration, torque);
}

static bool add_span_of(impact_scene *scene, int body, const imp_state *from, double t)
{
    impact_key keys[2];
    find_ends(scene, body, from, t, keys);
    imp_span span = {.from = keys[0], .to = keys[1]};
    for (int k = 0; k < 3; k++) {
        const impact_key at = imp_key_between(keys, t + 0.25 * (k + 1) * (scene->t - t));
        span.way[k] = (imp_pose){at.t, at.position, at.orientation};
    }
    return imp_scene_add_span(scene, &span);
}

static void find_states(impact_scene *scene, const imp_state *from, double t, double due)
{
    imp_state *at = scene->pile->at;
    for (int i = 0; i < scene->world.body_count; i++) {
        const imp_body *body = &scene->world.bodies[i];
        impact_key keys[2];
        at[i] = scene->states[i];
        if (body->is_static || due >= scene->t) continue;
        find_ends(scene, i, from, t, keys);
        const impact_key key = imp_key_between(keys, fmax(due, t));
        at[i] = (imp_state){key.position, key.orientation, key.velocity, imp_inertia(body, key.orientation, key.omega)};
    }
}

/* Of the step from t: samples that fall in it, and its keys. */
static impact_status emit_rows(impact_scene *scene, const imp_state *from, double t)
{
    imp_sampler *sampler = &scene->sampler;
    for (; imp_motion_sample_time(sampler) <= scene->t; sampler->next++) {
        if (!scene->recorder || !scene->recorder->sample) continue;
        const double due = imp_motion_sample_time(sampler);
        find_states(scene, from, t, due);
        if (!imp_scene_emit(scene, due, scene->pile->at)) return scene->stop;
    }
    for (int i = 0; scene->keys && scene->recorder && i < scene->world.body_count; i++)
        if (!scene->world.bodies[i].is_static && !add_span_of(scene, i, from, t)) return IMPACT_ESINK;
    return IMPACT_OK;
}

/* ---- the steps ---- */

static impact_status bring_all_to_rest(impact_scene *scene)
{
    const double energy = imp_scene_total_energy(scene);
    imp_scene_remember(scene);
    for (int i = 0; i < scene->world.body_count; i++) {
        if (scene->world.bodies[i].is_static || scene->motion.resting[i]) continue;
        scene->states[i].v = scene->states[i].momentum = (qvec3){0, 0, 0};
        scene->motion.resting[i] = true;
        const impact_event event = imp_scene_event_of_body(scene, IMPACT_EVENT_REST, i);
        const impact_status status = imp_scene_record(scene, &event);
        if (status != IMPACT_OK) return status;
    }
    scene->impact_loss += energy - imp_scene_total_energy(scene);
    return IMPACT_OK;
}

/* Back to the exact motion, with the contacts that there are. */
static impact_status end_steps(impact_scene *scene)
{
    scene->pile->stepping = false;
    scene->pile->pulses = 0;
    const impact_status status = imp_scene_settle(scene);
    if (status == IMPACT_OK && scene->crowd) imp_scene_crowd_begin(scene);
    return status;
}

/* One step, its account and its rows. */
static impact_status take_step(impact_scene *scene, double t_end, imp_pile_step_result *result)
{
    struct imp_scene_pile *p = scene->pile;
    const double energy = imp_scene_total_energy(scene), most = t_end - scene->t;
    memcpy(scene->before, scene->states, sizeof *scene->states * (size_t)scene->world.body_count);
    /* a step's forces are those of where and when it begins */
    imp_field_enter(&scene->world, scene->t);
    for (int custom = 0; custom < 2; custom++) imp_field_locate(&scene->world, scene->t, scene->states, custom);
    const impact_status status = imp_pile_step(&p->pile, &scene->world, scene->t, most, scene->states, result);
    if (status != IMPACT_OK) {
        if (status == IMPACT_ENOMEM)
            return imp_arena_explain(p->pile.arena, scene->message, sizeof scene->message), status;
        snprintf(scene->message, sizeof scene->message, "by steps from t = %.17g: %s", scene->t,
                 p->pile.message[0] ? p->pile.message : impact_status_string(status));
        return status;
    }
    const double t = scene->t;
    scene->t = result->taken >= most ? t_end : t + result->taken;
    p->error += result->error;

    scene->world.usage.pile_steps++;
    scene->motion.works.force += result->force_work;
    scene->motion.works.damping += result->damping;
    scene->motion.works.drive += result->drive_work;
    scene->impact_loss +=
        energy - imp_scene_total_energy(scene) + result->force_work + result->drive_work - result->damping;
    return emit_rows(scene, scene->before, t);
}

impact_status imp_scene_pile_advance(impact_scene *scene, double t_end)
{
    enum { STEPS = 64, ALONE = 64 };
    struct imp_scene_pile *p = scene->pile;
    for (int i = 0; i < scene->world.body_count; i++) scene->motion.resting[i] = false;
    for (int k = 0; k < STEPS && scene->t < t_end; k++) {
        imp_pile_step_result result;
        const impact_status status = take_step(scene, t_end, &result);
        if (status != IMPACT_OK) return status;
        if (imp_pile_rests(&p->pile, &scene->world, scene->t, scene->states, scene->rest_speed))
            return bring_all_to_rest(scene);
        p->alone = result.coupled > 0 ? 0 : p->alone + 1;
        if (p->alone >= ALONE && !p->always) return end_steps(scene);
    }
    return imp_scene_account(scene) ? IMPACT_OK : IMPACT_ESINK;
}
