/* SPDX-License-Identifier: MIT */
#include "scene/scene_together.h"
#include "base/tolerances.h"
#include "base/number.h"
#include "contact/encounter.h"
#include "contact/held_still.h"
#include "scene/scene_events.h"
#include "scene/scene_methods.h"
#include "scene/scene_press.h"
#include "shape/support.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

impact_scene_together imp_scene_together_of(const impact_scene_def *def)
{
    if (def->together != IMPACT_SCENE_TOGETHER_AUTO) return def->together;
    if (imp_scene_methods_of(def).impacts != IMPACT_SOLVER_AUTO || def->compliance > 0) return IMPACT_SCENE_SEQUENCE;
    return def->law == IMPACT_STRONGE ? IMPACT_SCENE_SPRINGS : IMPACT_SCENE_MOREAU;
}

/* All that touch at the island's time, and the room for their answer. */
typedef struct gathering {
    int count;
    imp_meeting *met;
    impact_meeting *meetings;
    impact_meeting_outcome *outcomes;
    impact_collider *bodies;
    qvec3 *velocity, *omega;
} gathering;

static void give_gathering(imp_arena *arena, gathering *g)
{
    imp_arena_give(arena, g->met);
    imp_arena_give(arena, g->meetings);
    imp_arena_give(arena, g->outcomes);
    imp_arena_give(arena, g->bodies);
    imp_arena_give(arena, g->velocity);
    imp_arena_give(arena, g->omega);
}

/* jammed: a pair that jams, or -1. */
static impact_status make_gathering(imp_island *island, int jammed, gathering *g)
{
    imp_world *world = &island->world;
    imp_arena *arena = world->arena;
    const size_t pairs = (size_t)world->pair_count, bodies = (size_t)world->body_count;
    *g = (gathering){.met = imp_arena_take(arena, pairs, sizeof *g->met),
                     .meetings = imp_arena_take(arena, pairs, sizeof *g->meetings),
                     .outcomes = imp_arena_take(arena, pairs, sizeof *g->outcomes),
                     .bodies = imp_arena_take(arena, bodies, sizeof *g->bodies),
                     .velocity = imp_arena_take(arena, bodies, sizeof *g->velocity),
                     .omega = imp_arena_take(arena, bodies, sizeof *g->omega)};
    if (!g->met || !g->meetings || !g->outcomes || !g->bodies || !g->velocity || !g->omega) return IMPACT_ENOMEM;
    for (int p = 0; p < world->pair_count; p++)
        if (imp_scene_meets(island, p, &g->met[g->count])) g->met[g->count++].jams = p == jammed;
    for (int i = 0; i < world->body_count; i++) g->bodies[i] = imp_scene_collider(island, i, (qvec3){0, 0, 0});
    return IMPACT_OK;
}

/* ---- whether one impact alone is the answer ---- */

static bool approaches(imp_island *island, imp_meeting *m)
{
    return m->velocity < -island->world.slip_speed &&
           !(imp_is_held(&island->world.pairs[m->contact.pair]) && imp_scene_dies_out(island, m, m->velocity));
}

/* Whether the struck pair's impact alone, of all that touch, leaves none approaching. */
static bool suffices_alone(imp_island *island, gathering *g, imp_meeting *struck)
{
    const imp_held_contact *contact = &struck->contact;
    for (int c = 0; c < g->count; c++)
        if (g->met[c].contact.pair != contact->pair && approaches(island, &g->met[c])) return false;
    impact_outcome outcome;
    const impact_collision collision = imp_scene_collision(island, struck);
    if (impact_collide(&collision, &outcome) < 0) return true; /* for that one to be told */
    imp_state kept[2];
    const int body[2] = {contact->body1, contact->body2};
    for (int k = 0; k < 2; k++) {
        kept[k] = island->states[body[k]];
        imp_scene_set_velocities(island, body[k], outcome.velocity[k], outcome.omega[k]);
    }
    bool alone = true;
    for (int c = 0; c < g->count; c++)
        alone =
            alone && imp_held_approach(&island->world, &g->met[c].contact, island->states) >= -island->world.slip_speed;
    for (int k = 0; k < 2; k++) island->states[body[k]] = kept[k];
    return alone;
}

/* ---- all together ---- */

/* Of Hertz's springs of one modulus, up to a factor: the root of the radius of the two surfaces' mean curvature, or
 * where that is nothing, or sharp, of the smaller body. A face is one that touches with all that is its. */
static double hertz_stiffness(const imp_island *island, const imp_held_contact *contact)
{
    const int body[2] = {contact->body1, contact->body2};
    const double touching =
        imp_world_touching_distance(&island->world, &island->world.pairs[contact->pair], island->states);
    double bent = 0, smaller = INFINITY;
    for (int k = 0; k < 2; k++) {
        const imp_body *b = &island->world.bodies[body[k]];
        const qvec3 towards = k == 0 ? qvec3_neg(contact->normal) : contact->normal;
        double k1, k2;
        smaller = fmin(smaller, b->radius);
        if (b->shape.kind == IMPACT_PLANE) continue;
        imp_shape_curvatures(&b->shape, quat_rotate_inverse(imp_shape_axes(b, &island->states[body[k]]), towards),
                             touching, &k1, &k2);
        bent += 0.5 * (k1 + k2);
    }
    return sqrt(bent > 0 && isfinite(bent) ? 1 / bent : smaller);
}

/* What answers, as rows name it; spent: their restitution; jams: because one does. */
typedef struct answering {
    impact_together_law law;
    const char *name;
    bool spent, jams;
} answering;

/* m/s: the fastest approach of all, which any of them may be pressed by: what rests comes back from the blow that it
 * passes on, not from its own approach, which is none. */
static double fastest_approach(const gathering *g)
{
    double fastest = 0;
    for (int c = 0; c < g->count; c++) fastest = fmax(fastest, -g->met[c].velocity);
    return fastest;
}

static void describe(imp_island *island, gathering *g, bool spent)
{
    const double fastest = fastest_approach(g);
    for (int c = 0; c < g->count; c++) {
        imp_meeting *m = &g->met[c];
        const imp_pair *pair = &island->world.pairs[m->contact.pair];
        const bool dies = spent || (!m->jams && imp_scene_dies_out(island, m, pair->law.restitution * fastest));
        g->meetings[c] = (impact_meeting){.body1 = m->contact.body1,
                                          .body2 = m->contact.body2,
                                          .normal = m->contact.normal,
                                          .offset1 = m->contact.r1,
                                          .offset2 = m->contact.r2,
                                          .friction = pair->law.friction,
                                          .restitution = dies ? 0 : pair->law.restitution,
                                          .stiffness = pair->law.stiffness > 0 ? pair->law.stiffness
                                                                               : hertz_stiffness(island, &m->contact),
                                          .pressed = m->jams};
    }
}

/* N s: impulses up to this are rounding of the greatest. */
static double rounding_of_impulses(const gathering *g)
{
    double greatest = 0;
    for (int c = 0; c < g->count; c++) greatest = fmax(greatest, qvec3_norm(g->outcomes[c].impulse));
    return IMP_ENCOUNTER_GRAIN * greatest;
}

/* A row for each contact that exchanged an impulse; all share the encounter's number. */
static impact_status record_all(imp_island *island, const gathering *g, const char *name, double energy)
{
    impact_status status = IMPACT_OK;
    const long number = ++island->scene->encounter_count;
    const double none = rounding_of_impulses(g);
    island->world.usage.encounters++;
    for (int c = 0; status == IMPACT_OK && c < g->count; c++) {
        const impact_meeting_outcome *o = &g->outcomes[c];
        const imp_held_contact *contact = &g->met[c].contact;
        char words[128];
        const double before = energy;
        energy += o->work_compression + o->work_restitution + o->work_friction +
                  imp_scene_drive_impulse(island, contact, o->impulse);
        if (qvec3_norm(o->impulse) <= none) continue;
        impact_event event = imp_scene_event_of_contact(island, IMPACT_EVENT_IMPACT, contact);
        event.encounter = number;
        event.phases =
            o->phase_count > 0 ? imp_scene_phases_in_words(o->phases, o->phase_count, words, sizeof words) : name;
        event.impulse = o->impulse;
        event.impulse_normal = qvec3_dot(contact->normal, o->impulse);
        event.impulse_tangential = qvec3_norm(qvec3_axpy(-event.impulse_normal, contact->normal, o->impulse));
        event.normal_before = o->normal_before;
        event.normal_after = o->normal_after;
        event.energy_before = before;
        event.energy_after = energy;
        island->motion.resting[contact->body1] = island->motion.resting[contact->body2] = false;
        island->notes[contact->pair].struck = true;
        island->world.usage.impacts_together++;
        status = imp_scene_record(island, &event);
    }
    return status;
}

/* What the answer gave the bodies, J, but for what drives did. */
static double works_of(const gathering *g)
{
    double works = 0;
    for (int c = 0; c < g->count; c++)
        works += g->outcomes[c].work_compression + g->outcomes[c].work_restitution + g->outcomes[c].work_friction;
    return works;
}

/* Whether what jams was drawn on. */
static bool was_drawn(const gathering *g)
{
    for (int c = 0; c < g->count; c++)
        if (g->met[c].jams && g->outcomes[c].phase_count > 0 && g->outcomes[c].phases[0] == IMPACT_TANGENTIAL)
            return true;
    return false;
}

/* The first answer that is not known to the last digits. */
static void tell_soft(imp_island *island, const gathering *g, const impact_together_outcome *outcome)
{
    impact_scene *scene = island->scene;
    const imp_body *bodies = island->world.bodies;
    char known[96] = "does not pass its receipt";
    if (outcome->ended_early)
        snprintf(known, sizeof known, "was ended early, and is known to %.2g of their approach", outcome->error);
    snprintf(scene->message, sizeof scene->message,
             "%d contacts at t = %s, one of '%s' and '%s': their answer together %s", g->count,
             imp_number_of(island->t).text, bodies[g->met[0].contact.body1].name, bodies[g->met[0].contact.body2].name,
             known);
}

/* Below zero nothing was answered. */
static impact_status answer(imp_island *island, gathering *g, answering how)
{
    impact_scene *scene = island->scene;
    imp_world *world = &island->world;
    if (!scene->together_workspace) {
        const impact_status status = imp_together_workspace_in(scene->world.arena, &scene->together_workspace);
        if (status != IMPACT_OK) return status;
    }
    const impact_status pressed = imp_scene_press_all(island, g->met, g->count);
    if (pressed != IMPACT_OK) return pressed;
    describe(island, g, how.spent);
    const double energy = imp_scene_tells_events(island) ? imp_scene_total_energy(island) : 0;
    const impact_encounter encounter = {.bodies = g->bodies,
                                        .body_count = world->body_count,
                                        .meetings = g->meetings,
                                        .meeting_count = g->count,
                                        .law = how.law,
                                        .restitution = scene->law,
                                        .workspace = scene->together_workspace};
    impact_together_outcome outcome = {.velocity = g->velocity, .omega = g->omega, .meetings = g->outcomes};
    const impact_status status = impact_collide_together(&encounter, &outcome);
    island->strides += outcome.steps + outcome.events;
    if (status < 0 || status == IMPACT_SEPARATING) return status;
    if (how.jams && !was_drawn(g)) return IMPACT_SEPARATING;
    if (status == IMPACT_SOFT && world->usage.impacts_soft++ == 0) tell_soft(island, g, &outcome);
    for (int i = 0; i < world->body_count; i++) imp_scene_set_velocities(island, i, g->velocity[i], g->omega[i]);
    imp_held_wake(world);
    if (outcome.energy_rose) imp_scene_gain(island, works_of(g));
    return record_all(island, g, how.name, energy);
}

/* What the law has no answer for; the first is kept. */
static void tell_unsettled(imp_island *island, const gathering *g, const imp_meeting *struck, impact_together_law by)
{
    impact_scene *scene = island->scene;
    const imp_body *bodies = island->world.bodies;
    if (scene->message[0]) return;
    snprintf(scene->message, sizeof scene->message,
             "%d contacts at t = %s, that of '%s' and '%s' among them%s: %s finds no answer to all together%s",
             g->count, imp_number_of(island->t).text, bodies[struck->contact.body1].name,
             bodies[struck->contact.body2].name, struck->jams ? ", which jams" : "", impact_together_law_name(by),
             struck->jams ? "" : "; they are answered one after another");
}

/* Whether the pair's own impact is all there is to answer. */
static bool is_alone(imp_island *island, gathering *g, imp_meeting *struck)
{
    return g->count < 2 || (!struck->jams && suffices_alone(island, g, struck));
}

impact_status imp_scene_answer_together(imp_island *island, imp_meeting *struck, imp_answer *by)
{
    const impact_scene_together asked = island->scene->together;
    const impact_together_law law = asked == IMPACT_SCENE_SPRINGS ? IMPACT_TOGETHER_SPRINGS : IMPACT_TOGETHER_MOREAU;
    *by = IMP_ANSWER_ALONE;
    if (island->world.pair_count < 2) return IMPACT_OK;
    if (!struck->jams && (asked == IMPACT_SCENE_SEQUENCE || island->unanswered)) return IMPACT_OK;
    gathering g;
    impact_status status = make_gathering(island, struck->jams ? struck->contact.pair : -1, &g);
    if (status == IMPACT_OK && !is_alone(island, &g, struck)) {
        status = answer(island, &g, (answering){law, impact_together_law_name(law), false, struck->jams});
        const bool nothing = status == IMPACT_EUNSETTLED || (struck->jams && status == IMPACT_SEPARATING);
        *by = !nothing ? IMP_ANSWER_TOGETHER : struck->jams ? IMP_ANSWER_NONE : IMP_ANSWER_ALONE;
        if (status == IMPACT_EUNSETTLED) {
            island->unanswered = !struck->jams;
            tell_unsettled(island, &g, struck, law);
        }
        /* what the law has no answer for is answered one after another, as those that come later are */
        if (status == IMPACT_EUNSETTLED || status > 0) status = IMPACT_OK;
    }
    give_gathering(island->world.arena, &g);
    return status;
}

impact_status imp_scene_end_together(imp_island *island)
{
    gathering g;
    impact_status status = make_gathering(island, -1, &g);
    if (status == IMPACT_OK) status = answer(island, &g, (answering){IMPACT_TOGETHER_MOREAU, "together", true, false});
    give_gathering(island->world.arena, &g);
    if (status == IMPACT_EUNSETTLED)
        snprintf(island->scene->message, sizeof island->scene->message, "no impulses end the impacts at t = %s%s",
                 imp_number_of(island->t).text,
                 island->world.driven ? ": do moving surfaces draw a body in where it jams?" : "");
    return status > 0 ? IMPACT_OK : status;
}
