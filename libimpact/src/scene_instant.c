/* SPDX-License-Identifier: MIT
 *
 * What happens at one instant: impacts, one after another, until no touching pair approaches; then the contacts that
 * are held.
 */
#include "scene_internal.h"
#include "drive.h"
#include "persist_flat.h"
#include "persist_line.h"
#include "persist_still.h"
#include "scene_together.h"
#include "world_gap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- rows ---- */

double impact_scene_total_energy(const impact_scene *scene)
{
    return impact_world_kinetic_energy(&scene->world, scene->states) +
           impact_field_potential(&scene->world, scene->states);
}

/* What impacts alone take from: without what drives gave on the way. */
static double undriven_energy(const impact_scene *scene)
{
    return impact_scene_total_energy(scene) - scene->motion.works.drive;
}

/* A static body's drive does work with the impulse on body 1. */
static double drive_impulse(impact_scene *scene, const impact_touch *touch, qvec3 impulse)
{
    const double work = qvec3_dot(impulse, impact_surface_velocity(&scene->world.bodies[touch->body2], touch->r2));
    scene->motion.works.drive += work;
    return work;
}

impact_sample impact_scene_sample(const impact_scene *scene, double t, int body, const impact_state *states)
{
    const impact_state *s = &states[body];
    const impact_body *b = &scene->world.bodies[body];
    return (impact_sample){
        t, body, b->name, s->x, s->q, b->is_static ? b->drift : s->v, b->is_static ? b->spin : impact_omega(b, s)};
}

static bool record_rows(impact_scene *scene, int body, const impact_state *states)
{
    const impact_recorder *recorder = scene->recorder;
    if (body < 0 || scene->world.bodies[body].is_static || !recorder->sample) return true;
    const impact_sample sample = impact_scene_sample(scene, scene->t, body, states);
    scene->world.usage.samples++;
    return recorder->sample(recorder->context, &sample);
}

/* Counts the event, and hands it on between its bodies' rows before and after. */
static impact_status record(impact_scene *scene, const impact_event *event)
{
    scene->world.usage.events[event->kind]++;
    scene->event_count++;
    if (!scene->recorder) return IMPACT_OK;
    const int other = event->kind == IMPACT_EVENT_FORCE ? -1 : event->body2;
    scene->beside_event = true;
    const bool taken = record_rows(scene, event->body1, scene->before) && record_rows(scene, other, scene->before) &&
                       (!scene->recorder->event || scene->recorder->event(scene->recorder->context, event)) &&
                       record_rows(scene, event->body1, scene->states) && record_rows(scene, other, scene->states);
    scene->beside_event = false;
    memcpy(scene->before, scene->states, sizeof *scene->states * (size_t)scene->world.body_count);
    return taken ? IMPACT_OK : IMPACT_ESINK;
}

static impact_event event_of_touch(const impact_scene *scene, impact_event_kind kind, const impact_touch *touch)
{
    const impact_world *world = &scene->world;
    const double energy = impact_scene_total_energy(scene);
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

static impact_event event_of_body(const impact_scene *scene, impact_event_kind kind, int body)
{
    const double energy = impact_scene_total_energy(scene);
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

/* ---- loads ---- */

static impact_status load(impact_scene *scene)
{
    if (impact_motion_load(&scene->motion, scene->t, scene->states)) return IMPACT_OK;
    memcpy(scene->message, scene->motion.message, sizeof scene->motion.message);
    return IMPACT_EDOMAIN;
}

/* The loads with the reactions of the contacts that are held. */
static impact_status load_with_reactions(impact_scene *scene)
{
    impact_persist *persist = &scene->motion.persist;
    impact_status status = impact_persist_reserve(persist, &scene->world, scene->states);
    if (status == IMPACT_OK) status = load(scene);
    if (status != IMPACT_OK || persist->count == 0) return status;
    impact_persist_solve(persist, &scene->world, scene->states, scene->motion.loads);
    impact_persist_add_reactions(persist, scene->motion.loads);
    return IMPACT_OK;
}

/* ---- touching pairs ---- */

typedef struct meeting {
    impact_touch touch;
    double velocity;     /* d(gap)/dt, m/s */
    double acceleration; /* d2(gap)/dt2 under the loads and the other contacts' reactions, m/s^2 */
    double own;          /* what the pair's own reaction adds to it */
} meeting;

/* Fills the meeting of a held pair, or of an open one that touches within its plane's bounds; false otherwise. */
static bool meets(impact_scene *scene, int p, meeting *m)
{
    impact_world *world = &scene->world;
    impact_pair *pair = &world->pairs[p];
    if (pair->beyond || impact_world_distance_bound(world, pair, scene->states) > world->bodies[pair->body1].radius)
        return false;
    impact_contact contact;
    impact_world_gap(world, pair, scene->states, &contact);
    if (!impact_is_held(pair) && (contact.gap > impact_world_touching_distance(world, pair, scene->states) ||
                                  impact_world_inside_bounds(world, pair, scene->states, &contact) < 0))
        return false;
    m->touch = impact_persist_touch(world, p, scene->states, scene->motion.loads);
    m->velocity = impact_world_approach(world, &m->touch, scene->states);
    m->own = impact_persist_own_acceleration(&scene->motion.persist, world, scene->states, p);
    m->acceleration =
        qvec3_dot(m->touch.normal, m->touch.bias) + qvec3_dot(m->touch.normal_rate, m->touch.slip) - m->own;
    return true;
}

/* The acceleration that presses two bodies together and goes on doing so: about edges and over faces the normal turns
 * fast, but not for long. Surfaces rounder than a thousandth of the body press no more than this. The loads hold the
 * pair's own reaction, which its acceleration does not. */
static double lasting_press(const impact_scene *scene, const meeting *m)
{
    const double roundest = 1e-3;
    const int body[2] = {m->touch.body1, m->touch.body2};
    const impact_state *states = scene->states;
    double speed = qvec3_norm(qvec3_sub(states[body[0]].v, states[body[1]].v)), pull = fabs(m->own), radius = INFINITY;
    for (int k = 0; k < 2; k++) {
        const impact_body *b = &scene->world.bodies[body[k]];
        const impact_load *l = &scene->motion.loads[body[k]];
        if (b->is_static) continue;
        speed += b->radius * qvec3_norm(impact_omega(b, &states[body[k]]));
        pull += qvec3_norm(l->force) * b->inverse_mass;
        pull += b->radius * qvec3_norm(impact_inverse_inertia(b, states[body[k]].q, l->torque));
        radius = fmin(radius, b->radius);
    }
    /* of a face that is about to be rolled over the reaction is without bound, for no time */
    const double passing = 1e6 * qvec3_norm(scene->world.gravity);
    if (passing > 0) pull = fmin(pull, passing);
    return fmin(-m->acceleration, pull + speed * speed / (roundest * radius));
}

/* Whether a bounce at this speed would rise less than the rest height under the acceleration that presses the bodies
 * together. Bounces that are met a rounding d late gain what they fall by it, and never rise less than d e^2/(1 - e^2):
 * that counts as rest too. */
static bool dies_out(const impact_scene *scene, const meeting *m, double speed)
{
    enum { MOST = 10 };
    const impact_pair *pair = &scene->world.pairs[m->touch.pair];
    double late = impact_world_touching_distance(&scene->world, pair, scene->states);
    if (!impact_motion_is_ballistic(&scene->motion))
        late = fmax(late, scene->motion.tolerance * impact_world_reach(&scene->world, pair, scene->states));
    const double gain = 1 / (1 - pair->restitution * pair->restitution);
    const double height = fmax(scene->rest_height, late * fmin(gain, MOST));
    return m->acceleration < 0 && speed * speed < 2 * lasting_press(scene, m) * height;
}

/* ---- one impact ---- */

static impact_collider collider(const impact_scene *scene, int body, qvec3 offset)
{
    const impact_body *b = &scene->world.bodies[body];
    const impact_state *s = &scene->states[body];
    if (b->is_static) return (impact_collider){b->mass, b->moments, s->q, offset, b->drift, b->spin};
    return (impact_collider){b->mass, b->moments, s->q, offset, s->v, impact_omega(b, s)};
}

static const char *phases_in_words(const impact_outcome *outcome, char *words, size_t size)
{
    static const char *const names[] = {[IMPACT_SLIP_C] = "slip-c",
                                        [IMPACT_STICK_C] = "stick-c",
                                        [IMPACT_SLIP_R] = "slip-r",
                                        [IMPACT_STICK_R] = "stick-r",
                                        [IMPACT_REVERSAL] = "reversal"};
    size_t used = 0;
    words[0] = '\0';
    for (int i = 0; i < outcome->phase_count && used < size; i++)
        used += (size_t)snprintf(words + used, size - used, "%s%s", i ? " " : "", names[outcome->phases[i]]);
    return words;
}

static void count_solver(impact_scene *scene, impact_solver solver)
{
    impact_usage *usage = &scene->world.usage;
    if (solver == IMPACT_SOLVER_CLOSED_FORM) usage->impacts_closed_form++;
    if (solver == IMPACT_SOLVER_SERIES) usage->impacts_series++;
    if (solver == IMPACT_SOLVER_CVODE) usage->impacts_cvode++;
}

/* Solves the pair's impact. One whose bounce would die out is solved with restitution 0: it then exchanges, at once,
 * the whole impulse of the infinitely many bounces that would follow, less what the pressing force brings while they
 * last: the sum m w (1 + e)(1 + e + ...) - m |a| T with T = 2 e w/(|a| (1 - e)) is m w. */
static impact_status strike(impact_scene *scene, const meeting *m)
{
    impact_world *world = &scene->world;
    const impact_touch *touch = &m->touch;
    const double restitution = world->pairs[touch->pair].restitution;
    const impact_collision collision = {
        .body = {collider(scene, touch->body1, touch->r1), collider(scene, touch->body2, touch->r2)},
        .normal = touch->normal,
        .friction = touch->friction,
        .restitution = dies_out(scene, m, restitution * m->velocity) ? 0 : restitution,
        .law = scene->law,
        .solver = scene->solver,
        .tangential_compliance = scene->compliance,
        .workspace = scene->springs};
    impact_outcome outcome;
    const impact_status status = impact_collide(&collision, &outcome);
    if (status != IMPACT_OK) {
        snprintf(scene->message, sizeof scene->message, "impact of '%s' and '%s' at t = %.17g: %s",
                 world->bodies[touch->body1].name, world->bodies[touch->body2].name, scene->t,
                 status == IMPACT_EARGUMENT && scene->solver == IMPACT_SOLVER_CLOSED_FORM
                     ? "it has no closed form, and the scene asks for no other solver"
                     : impact_status_string(status));
        return status < 0 ? status : IMPACT_EUNSETTLED;
    }
    impact_event event = event_of_touch(scene, IMPACT_EVENT_IMPACT, touch);
    const int bodies[2] = {touch->body1, touch->body2};
    drive_impulse(scene, touch, outcome.impulse);
    impact_persist_stir(world);
    for (int k = 0; k < 2; k++) {
        const impact_body *body = &world->bodies[bodies[k]];
        impact_state *state = &scene->states[bodies[k]];
        if (body->is_static) continue;
        state->v = outcome.velocity[k];
        state->momentum = impact_inertia(body, state->q, outcome.omega[k]);
        scene->motion.resting[bodies[k]] = false;
    }
    count_solver(scene, outcome.solver);
    char words[128];
    event.phases = phases_in_words(&outcome, words, sizeof words);
    event.impulse_normal = outcome.impulse_normal;
    event.impulse_tangential = outcome.impulse_tangential;
    event.normal_before = outcome.normal_before;
    event.normal_after = outcome.normal_after;
    event.energy_after = impact_scene_total_energy(scene);
    return record(scene, &event);
}

/* The first touching pair that approaches in earnest, or -1. Those that barely do are put right by projection where
 * they are held, or (answering) will be: what answers another impact so softly would not rise again. */
static int find_approach(impact_scene *scene, bool answering, meeting *m)
{
    for (int p = 0; p < scene->world.pair_count; p++) {
        if (!meets(scene, p, m)) continue;
        const bool open = !impact_is_held(&scene->world.pairs[p]), held = answering || !open;
        /* what is open and pressed together would fall through, however loose the tolerance */
        const double slow = open && m->acceleration < 0 ? fmin(scene->world.slip_speed, 1e-2 * scene->rest_speed)
                                                        : scene->world.slip_speed;
        if (m->velocity < -slow && !(held && dies_out(scene, m, m->velocity))) return p;
    }
    return -1;
}

/* ---- many impacts in one instant ---- */

/* All touching pairs answer together what is left of the instant's impacts, without restitution. */
static impact_status strike_together(impact_scene *scene)
{
    impact_world *world = &scene->world;
    impact_share *shares = calloc((size_t)world->pair_count + 1, sizeof *shares);
    if (!shares) return IMPACT_ENOMEM;
    impact_persist_stir(world);
    int count = 0;
    meeting m;
    for (int p = 0; p < world->pair_count; p++)
        if (meets(scene, p, &m)) shares[count++].touch = m.touch;
    double energy = impact_scene_total_energy(scene);
    impact_status status = IMPACT_OK;
    if (!impact_answer_together(world, scene->states, shares, count) && world->driven) {
        snprintf(scene->message, sizeof scene->message,
                 "no impulses end the impacts at t = %.17g: do moving surfaces draw a body in where it jams?",
                 scene->t);
        status = IMPACT_EUNSETTLED;
    }
    for (int c = 0; status == IMPACT_OK && c < count; c++) {
        const impact_share *share = &shares[c];
        if (!(share->normal > 0)) continue;
        impact_event event = event_of_touch(scene, IMPACT_EVENT_IMPACT, &share->touch);
        event.phases = "together";
        event.impulse_normal = share->normal;
        event.impulse_tangential = qvec3_norm(qvec3_axpy(-share->normal, share->touch.normal, share->impulse));
        event.normal_before = qvec3_dot(share->touch.normal, share->before);
        event.normal_after = qvec3_dot(share->touch.normal, share->after);
        event.energy_before = energy;
        event.energy_after = energy += share->work + drive_impulse(scene, &share->touch, share->impulse);
        scene->motion.resting[share->touch.body1] = scene->motion.resting[share->touch.body2] = false;
        world->usage.impacts_together++;
        status = record(scene, &event);
    }
    free(shares);
    return status;
}

/* Whether the impacts of this instant have gone round among the pairs that struck often enough, and lose energy as they
 * go. */
static bool goes_round(const impact_scene *scene, int impacts)
{
    int struck = 0;
    bool elastic = true;
    for (int p = 0; p < scene->world.pair_count; p++) {
        struck += scene->world.pairs[p].struck;
        elastic = elastic && (!scene->world.pairs[p].struck || scene->world.pairs[p].restitution == 1);
    }
    return !elastic && impacts > 10 * struck;
}

/* ---- which contacts are held ---- */

/* What has no friction slides even where it stands still. */
static impact_mode held_mode(const impact_touch *touch, bool slides)
{
    return slides || touch->friction == 0 ? IMPACT_SLIDE : IMPACT_ROLL;
}

/* Tentative modes: what touches and does not leave is held; those that would pull are opened again when the reactions
 * are known. */
static void choose_modes(impact_scene *scene)
{
    impact_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) {
        meeting m;
        impact_pair *pair = &world->pairs[p];
        if (!meets(scene, p, &m)) continue;
        const bool stays = m.acceleration < 0 ? dies_out(scene, &m, m.velocity) : m.velocity <= world->slip_speed;
        const bool slides = m.touch.speed > world->slip_speed || (impact_is_held(pair) && m.touch.onset);
        pair->mode = stays ? held_mode(&m.touch, slides) : IMPACT_OPEN;
        pair->onset = slides && m.touch.onset && m.touch.speed < world->onset_speed;
    }
}

static impact_event_kind change_of_mode(impact_mode before, impact_mode now)
{
    if (now == IMPACT_OPEN) return IMPACT_EVENT_LIFTOFF;
    if (before == IMPACT_OPEN) return IMPACT_EVENT_CONTACT;
    return now == IMPACT_ROLL ? IMPACT_EVENT_STICK : IMPACT_EVENT_SLIP;
}

static impact_status record_changes(impact_scene *scene)
{
    impact_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) {
        const impact_mode now = world->pairs[p].mode;
        if (now == scene->modes[p]) continue;
        const impact_touch touch = impact_persist_touch(world, p, scene->states, scene->motion.loads);
        impact_event event = event_of_touch(scene, change_of_mode(scene->modes[p], now), &touch);
        const bool stands = touch.friction == 0 && touch.speed <= world->slip_speed;
        event.phases = now == IMPACT_OPEN ? "" : now == IMPACT_ROLL || stands ? "roll" : "slide";
        scene->motion.resting[touch.body1] = scene->motion.resting[touch.body2] = false;
        const impact_status status = record(scene, &event);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

/* How fast any point of the body moves at most, m/s. */
static double fastest_point(const impact_body *body, const impact_state *state)
{
    return qvec3_norm(state->v) + body->radius * qvec3_norm(impact_omega(body, state));
}

/* A body that is slower than the rest speed, held, and not accelerated, is at rest. */
static bool comes_to_rest(const impact_scene *scene, int body)
{
    const impact_body *b = &scene->world.bodies[body];
    const impact_state *s = &scene->states[body];
    if (b->is_static || scene->motion.resting[body]) return false;
    if (fastest_point(b, s) > scene->rest_speed) return false;
    qvec3 force = scene->motion.loads[body].force, torque = scene->motion.loads[body].torque;
    bool held = false;
    for (int c = 0; c < scene->motion.persist.count; c++) {
        const impact_touch *touch = &scene->motion.persist.touches[c];
        if (touch->body1 != body && touch->body2 != body) continue;
        if (touch->still) return true;
        const bool fades = touch->mode == IMPACT_SLIDE && !touch->onset && touch->friction > 0;
        if (fades && touch->speed <= 2 * scene->rest_speed) return false; /* it sticks first */
        held = true;
        const qvec3 f = touch->body1 == body ? touch->force : qvec3_neg(touch->force);
        force = qvec3_add(force, f);
        torque = qvec3_add(torque, qvec3_cross(touch->body1 == body ? touch->r1 : touch->r2, f));
    }
    const double acceleration =
        qvec3_norm(force) * b->inverse_mass + b->radius * qvec3_norm(impact_inverse_inertia(b, s->q, torque));
    return held && acceleration < 100 * scene->rest_speed;
}

static impact_status bring_to_rest(impact_scene *scene)
{
    for (int i = 0; i < scene->world.body_count; i++) {
        if (!comes_to_rest(scene, i)) continue;
        scene->states[i].v = scene->states[i].momentum = (qvec3){0, 0, 0};
        scene->motion.resting[i] = true;
        const impact_event event = event_of_body(scene, IMPACT_EVENT_REST, i);
        const impact_status status = record(scene, &event);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

static void stop(impact_scene *scene, int body)
{
    if (!scene->world.bodies[body].is_static) scene->states[body].v = scene->states[body].momentum = (qvec3){0, 0, 0};
}

/* What stands still, or is so jammed that it stops before it has gone the rest height. */
static impact_status find_still(impact_scene *scene)
{
    impact_motion *motion = &scene->motion;
    impact_world *world = &scene->world;
    const double jam_speed = fmax(scene->rest_speed, sqrt(2 * qvec3_norm(world->gravity) * scene->rest_height));
    const impact_status status =
        impact_persist_find_still(&motion->persist, world, scene->states, motion->loads, scene->rest_speed, jam_speed);
    for (int p = 0; status == IMPACT_OK && p < world->pair_count; p++) {
        const impact_pair *pair = &world->pairs[p];
        if (!impact_is_held(pair) || !pair->still) continue;
        stop(scene, pair->body1);
        stop(scene, pair->body2);
    }
    return status;
}

/* Puts the constraints of the contacts that are held in order, and opens those that would pull. */
static impact_status make_consistent(impact_scene *scene)
{
    impact_motion *motion = &scene->motion;
    impact_persist_stir(&scene->world);
    impact_status status = impact_persist_reserve(&motion->persist, &scene->world, scene->states);
    if (status == IMPACT_OK) status = load(scene);
    if (status != IMPACT_OK) return status;
    impact_persist_project(&motion->persist, &scene->world, scene->states, motion->loads);
    motion->works.drive += impact_drive_power(&motion->persist, &scene->world);
    status = load(scene);
    if (status == IMPACT_OK) status = find_still(scene);
    if (status == IMPACT_OK)
        status = impact_persist_resolve(&motion->persist, &scene->world, scene->states, motion->loads);
    if (status == IMPACT_EUNSETTLED)
        snprintf(scene->message, sizeof scene->message, "no consistent set of contact forces found at t = %.17g",
                 scene->t);
    return status;
}

/* The first open pair that touches, is all but still along the normal, and is pressed together by the loads and the
 * reactions; or -1. */
static int find_pressed(impact_scene *scene, meeting *m)
{
    impact_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) {
        impact_pair *pair = &world->pairs[p];
        if (impact_is_held(pair) || pair->settled || !meets(scene, p, m)) continue;
        const impact_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
        const double push1 = qvec3_norm(scene->motion.loads[pair->body1].force) * b1->inverse_mass,
                     push2 = qvec3_norm(scene->motion.loads[pair->body2].force) * b2->inverse_mass;
        const double pressed = -1e-9 * (push1 + push2);
        if (m->acceleration < pressed && dies_out(scene, m, m->velocity)) return p;
    }
    return -1;
}

/* What rocks on a face too low to be seen lies on it; the energy is given up. */
static impact_status lie_down(impact_scene *scene)
{
    const double energy = undriven_energy(scene);
    impact_status status = load(scene);
    if (status != IMPACT_OK) return status;
    const bool flat = impact_flat_lay(&scene->world, scene->states, scene->motion.loads);
    const bool lined = impact_line_lay(&scene->motion.persist, &scene->world, scene->states, scene->motion.loads);
    if (!flat && !lined) return status;
    status = make_consistent(scene);
    scene->impact_loss += energy - undriven_energy(scene);
    return status;
}

/* Whether a body that moves is held with friction by reactions that are not unique. */
static bool hangs_on_choice(const impact_scene *scene)
{
    const impact_persist *persist = &scene->motion.persist;
    for (int c = 0; c < persist->count; c++) {
        const impact_touch *touch = &persist->touches[c];
        if (touch->still || !touch->redundant || !(touch->friction > 0)) continue;
        const int bodies[2] = {touch->body1, touch->body2};
        for (int k = 0; k < 2; k++) {
            const impact_body *body = &scene->world.bodies[bodies[k]];
            const impact_state *state = &scene->states[bodies[k]];
            if (!body->is_static && fastest_point(body, state) > scene->rest_speed) return true;
        }
    }
    return false;
}

/* From tentative modes to consistent ones. What opened a moment ago, and is pressed together again now that other
 * contacts have changed their modes, is held again at once: it would come back in less than can be told from rounding,
 * and again and again. Each pair is given one such chance in an instant. opened: the pair that has just lifted off, or
 * -1; rejoin: whether to look for such pairs. */
static impact_status hold(impact_scene *scene, int opened, bool rejoin)
{
    impact_world *world = &scene->world;
    for (int p = 0; p < world->pair_count; p++) world->pairs[p].settled = p == opened;
    impact_status status = make_consistent(scene);
    while (rejoin && status == IMPACT_OK) {
        meeting m;
        status = load_with_reactions(scene);
        const int p = status == IMPACT_OK ? find_pressed(scene, &m) : -1;
        if (p < 0) break;
        impact_pair *pair = &world->pairs[p];
        pair->settled = true;
        pair->onset = false;
        pair->mode = held_mode(&m.touch, m.touch.speed > world->slip_speed);
        status = make_consistent(scene);
    }
    if (status == IMPACT_OK) status = lie_down(scene);
    if (status == IMPACT_OK) world->usage.reactions_chosen += hangs_on_choice(scene);
    if (status == IMPACT_OK) status = load(scene);
    if (status == IMPACT_OK) status = record_changes(scene);
    return status == IMPACT_OK ? bring_to_rest(scene) : status;
}

static void remember(impact_scene *scene)
{
    memcpy(scene->before, scene->states, sizeof *scene->states * (size_t)scene->world.body_count);
    for (int p = 0; p < scene->world.pair_count; p++) scene->modes[p] = scene->world.pairs[p].mode;
}

/* One impact after another, in the order of the pairs, until no touching pair approaches. Restitution that has gone
 * round among the same few pairs time and again is spent: the rest of it is answered by all together. */
static impact_status strike_all(impact_scene *scene)
{
    enum { MAX_IMPACTS = 100000 };
    impact_world *world = &scene->world;
    meeting m;
    bool fresh = true; /* the loads know of the last impact */
    for (int p = 0; p < world->pair_count; p++) world->pairs[p].struck = false;
    impact_status status = load_with_reactions(scene);
    for (int count = 0; status == IMPACT_OK; count++) {
        int p = find_approach(scene, count > 0, &m);
        if (p < 0 && !fresh) {
            status = load_with_reactions(scene);
            p = status == IMPACT_OK ? find_approach(scene, count > 0, &m) : -1;
            fresh = true;
        }
        if (p < 0) return status;
        if (goes_round(scene, count)) {
            status = strike_together(scene);
            return status == IMPACT_OK ? load_with_reactions(scene) : status;
        }
        if (count > 0) world->usage.impacts_simultaneous++;
        if (count == MAX_IMPACTS) {
            snprintf(scene->message, sizeof scene->message, "%d impacts in the one instant t = %.17g brought no end",
                     count, scene->t);
            return IMPACT_EUNSETTLED;
        }
        status = strike(scene, &m);
        world->pairs[p].struck = true;
        fresh = false;
    }
    return status;
}

impact_status impact_scene_settle(impact_scene *scene)
{
    remember(scene);
    const double account = undriven_energy(scene) + scene->impact_loss;
    impact_status status = strike_all(scene);
    if (status == IMPACT_OK) {
        choose_modes(scene);
        status = hold(scene, -1, false);
    }
    scene->impact_loss = account - undriven_energy(scene);
    return status;
}

/* ---- the ends of stretches of motion ---- */

static impact_status arrive(impact_scene *scene, int p)
{
    impact_world *world = &scene->world;
    impact_pair *pair = &world->pairs[p];
    impact_contact contact;
    impact_world_gap(world, pair, scene->states, &contact);
    if (impact_world_inside_bounds(world, pair, scene->states, &contact) < 0) {
        pair->beyond = true;
        return IMPACT_OK;
    }
    if (contact.gap < 0)
        impact_persist_close_gap(world, pair, &contact, scene->states); /* a rounding; many would sum up */
    return impact_scene_settle(scene);
}

/* The contact changes its mode, and the rest follows. */
static impact_status change_mode(impact_scene *scene, int p, impact_mode mode)
{
    remember(scene);
    impact_pair *pair = &scene->world.pairs[p];
    pair->mode = mode;
    pair->onset = false;
    const double account = undriven_energy(scene) + scene->impact_loss;
    const impact_status status = hold(scene, mode == IMPACT_OPEN ? p : -1, true);
    scene->impact_loss = account - undriven_energy(scene);
    return status;
}

/* A rolling contact's friction has reached its cone: it slides, against the friction that held it. */
static impact_status begin_slide(impact_scene *scene, int p)
{
    remember(scene);
    impact_persist *persist = &scene->motion.persist;
    const impact_status status = load(scene);
    if (status != IMPACT_OK) return status;
    impact_persist_solve(persist, &scene->world, scene->states, scene->motion.loads);
    for (int c = 0; c < persist->count; c++)
        if (persist->touches[c].pair == p) impact_persist_begin_slide(&scene->world.pairs[p], &persist->touches[c]);
    return hold(scene, -1, true);
}

/* Whether it is the face or the line that a pair's centre of pressure has left, not the plane; the body then tips. */
static bool tips(impact_scene *scene, int p)
{
    const double spent = 1e-6; /* of its spare, as a root leaves it */
    impact_world *world = &scene->world;
    impact_persist *persist = &scene->motion.persist;
    impact_pair *pair = &world->pairs[p];
    remember(scene);
    if ((!pair->flat && !pair->lined) || load(scene) != IMPACT_OK) return false;
    impact_persist_solve(persist, world, scene->states, scene->motion.loads);
    for (int c = 0; c < persist->count; c++) {
        const impact_touch *touch = &persist->touches[c];
        if (touch->pair != p) continue;
        if (touch->flat && touch->spare <= spent)
            impact_flat_tip(world, pair, scene->states, touch);
        else if (touch->lined && impact_line_spare(world, touch, scene->states, scene->motion.loads) <= spent)
            pair->lined = false;
        else
            return false;
        return true;
    }
    return false;
}

static impact_status cross_edge(impact_scene *scene, int edge)
{
    int field, body;
    remember(scene);
    impact_field_cross(&scene->world, edge, &field, &body);
    impact_event event = event_of_body(scene, IMPACT_EVENT_FORCE, body);
    event.name2 = scene->world.fields[field].name;
    const impact_status status = record(scene, &event);
    return status == IMPACT_OK ? hold(scene, -1, true) : status;
}

/* Held contacts are put back, and those that others hold are asked again whether they must give way. */
static impact_status renew(impact_scene *scene)
{
    remember(scene);
    const impact_status status = load(scene);
    if (status != IMPACT_OK) return status;
    impact_persist_stop_onsets(&scene->motion.persist, &scene->world, scene->states, scene->motion.loads);
    return hold(scene, -1, true);
}

impact_status impact_scene_handle(impact_scene *scene, impact_end end)
{
    switch (end.kind) {
    case IMPACT_END_TIME: return IMPACT_OK;
    case IMPACT_END_GAP: return arrive(scene, end.index);
    case IMPACT_END_RETURN: scene->world.pairs[end.index].beyond = false; return IMPACT_OK;
    case IMPACT_END_BOUNDS:
        if (tips(scene, end.index)) return hold(scene, -1, true);
        scene->world.pairs[end.index].beyond = true;
        return change_mode(scene, end.index, IMPACT_OPEN);
    case IMPACT_END_LIFTOFF: return change_mode(scene, end.index, IMPACT_OPEN);
    case IMPACT_END_SLIP: return begin_slide(scene, end.index);
    case IMPACT_END_STICK: return change_mode(scene, end.index, IMPACT_ROLL);
    case IMPACT_END_EDGE: return cross_edge(scene, end.index);
    case IMPACT_END_SLOW: remember(scene); return hold(scene, -1, true);
    case IMPACT_END_RENEWAL: return renew(scene);
    }
    return IMPACT_OK;
}
