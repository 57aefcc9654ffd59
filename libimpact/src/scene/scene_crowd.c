/* SPDX-License-Identifier: MIT
 *
 * For a while so short that few bodies can meet, the bodies are divided into groups of those that can, and each group
 * is moved on to the while's end as a small scene of its own, events and all: what happens to one ball does not disturb
 * the motion of the others. The guess in the division, how fast a body can become, is checked at every step; a while in
 * which a body got further than it was allowed is taken back and tried again with more room.
 */
#include "scene/scene_crowd.h"
#include "scene/scene_keys.h"
#include "scene/scene_pile.h"
#include "world/crowd.h"
#include "motion/motion_equations.h"
#include "scene/scene_receipt.h"
#include "scene/scene_rows.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Fewer bodies than this are moved together. */
enum { LEAST_BODIES = 4 };

/* A group, as a scene. */
typedef struct party {
    impact_scene scene;
    struct imp_scene_crowd *owner;
    int group;
    int *body, *pair;  /* their indices in the whole scene */
    double *top_speed; /* of each body, m/s */
    impact_recorder recorder;
    imp_held_line *held; /* per pair; with keys */
    impact_status status;
    bool moved;
    double energy; /* at the start of the while */
} party;

typedef struct imp_scene_crowd {
    impact_scene *scene;
    imp_crowd crowd;
    party **parties;
    int party_count;
    int *held;  /* contacts of each body */
    int *local; /* scratch: a body's index in its party */
    double *energy, *energy_end;
    imp_rows rows;
    imp_kept_list kept;
    double while_time; /* s */
    bool escaped, stopped, piled;
    bool spent; /* a group found no memory: it did not move whole, and the scene cannot go on */
} imp_scene_crowd;

/* ---- a group's rows ---- */

static bool keep_sample(void *context, const impact_sample *sample)
{
    party *p = context;
    imp_row *row = imp_rows_add(&p->owner->rows);
    if (!row) return true; /* told at the end of the while */
    row->t = sample->t;
    row->beside = p->scene.beside_event;
    row->group = p->group;
    row->sample = *sample;
    row->sample.body = p->body[sample->body];
    row->rank = row->beside ? p->owner->rows.count : row->sample.body;
    return true;
}

static bool keep_event(void *context, const impact_event *event)
{
    party *p = context;
    imp_row *row = imp_rows_add(&p->owner->rows);
    if (!row) return true;
    row->t = event->t;
    row->beside = row->is_event = true;
    row->group = p->group;
    row->rank = p->owner->rows.count;
    row->event = *event;
    row->event.body1 = p->body[event->body1];
    row->event.body2 = event->body2 < 0 ? -1 : p->body[event->body2];
    snprintf(row->phases, sizeof row->phases, "%s", event->phases);
    return true;
}

static bool keep_span(void *context, const imp_span *span)
{
    party *p = context;
    imp_kept item = {.group = p->group, .is_span = true, .span = *span};
    item.span.from.body = item.span.to.body = p->body[span->from.body];
    imp_kept_add(&p->owner->kept, &item);
    return true; /* out of memory is told at the end of the while */
}

static bool keep_held(void *context, const impact_held *row)
{
    party *p = context;
    imp_kept item = {.group = p->group, .held = *row};
    item.held.body1 = p->body[row->body1];
    item.held.body2 = p->body[row->body2];
    imp_kept_add(&p->owner->kept, &item);
    return true;
}

static bool keep_piece(void *context, const imp_piece *piece)
{
    party *p = context;
    return imp_scene_spans_of(&p->scene, piece, keep_span, p) &&
           imp_scene_held_of(&p->scene, piece, p->held, keep_held, p);
}

static void drop_rows(imp_rows *rows, int group)
{
    int kept = 0;
    for (int k = 0; k < rows->count; k++)
        if (rows->rows[k].group != group) rows->rows[kept++] = rows->rows[k];
    rows->count = kept;
}

/* ---- how fast its bodies may be ---- */

/* Along a parabola a body is fastest at an end: that no body is too fast where events and steps are is enough. */
static bool within(const party *p, const imp_state *states)
{
    for (int i = 0; i < p->scene.world.body_count; i++)
        if (!p->scene.world.bodies[i].is_static && qvec3_norm(states[i].v) > p->top_speed[i]) return false;
    return true;
}

/* The same of the integrated state. */
static bool integrated_within(const party *p)
{
    const double *v = p->scene.motion.y ? p->scene.motion.y + Y_BODIES + Y_VELOCITY : NULL;
    for (int i = 0; v && i < p->scene.world.body_count; i++) {
        if (p->scene.world.bodies[i].is_static) continue;
        if (qvec3_norm((qvec3){v[0], v[1], v[2]}) > p->top_speed[i]) return false;
        v += Y_PER_BODY;
    }
    return true;
}

/* Before every stretch of a group's motion, and at every step of its integrator. */
static bool party_pulse(void *context, double t)
{
    party *p = context;
    imp_scene_crowd *crowd = p->owner;
    crowd->escaped = crowd->escaped || !within(p, p->scene.states);
    crowd->escaped = crowd->escaped || !integrated_within(p);
    crowd->stopped = crowd->stopped || !imp_scene_told(crowd->scene, fmin(t, crowd->scene->t));
    crowd->piled = crowd->piled || imp_scene_pile_party(crowd->scene, &p->scene);
    if (!crowd->escaped && !crowd->stopped && !crowd->piled) return true;
    p->scene.stop = IMPACT_STOPPED;
    return false;
}

/* ---- making groups ---- */

static void free_party(party *p)
{
    if (!p) return;
    imp_arena *arena = p->scene.world.arena;
    imp_motion_close(&p->scene.motion);
    imp_arena_give(arena, p->scene.world.bodies);
    imp_arena_give(arena, p->scene.world.pairs);
    imp_arena_give(arena, p->scene.states);
    imp_arena_give(arena, p->scene.before);
    imp_arena_give(arena, p->scene.modes);
    imp_arena_give(arena, p->body);
    imp_arena_give(arena, p->pair);
    imp_arena_give(arena, p->top_speed);
    imp_arena_give(arena, p->held);
    imp_arena_give(arena, p);
}

static void free_parties(imp_scene_crowd *crowd)
{
    for (int g = 0; g < crowd->party_count; g++) free_party(crowd->parties[g]);
    imp_arena_give(crowd->scene->world.arena, crowd->parties);
    crowd->parties = NULL;
    crowd->party_count = 0;
}

static impact_status allocate_party(party *p, int bodies, int pairs)
{
    imp_world *world = &p->scene.world;
    const size_t n = (size_t)bodies + 1, m = (size_t)pairs + 1;
    world->bodies = imp_arena_take(world->arena, n, sizeof *world->bodies);
    world->pairs = imp_arena_take(world->arena, m, sizeof *world->pairs);
    p->scene.states = imp_arena_take(world->arena, n, sizeof *p->scene.states);
    p->scene.before = imp_arena_take(world->arena, n, sizeof *p->scene.before);
    p->scene.modes = imp_arena_take(world->arena, m, sizeof *p->scene.modes);
    p->body = imp_arena_take(world->arena, n, sizeof *p->body);
    p->pair = imp_arena_take(world->arena, m, sizeof *p->pair);
    p->top_speed = imp_arena_take(world->arena, n, sizeof *p->top_speed);
    p->held = imp_arena_take(world->arena, m, sizeof *p->held);
    return world->bodies && world->pairs && p->scene.states && p->scene.before && p->scene.modes && p->body &&
                   p->pair && p->top_speed && p->held
               ? IMPACT_OK
               : IMPACT_ENOMEM;
}

/* The group's members, and then the static bodies that they can meet. */
static void list_bodies(imp_scene_crowd *crowd, party *p)
{
    const imp_crowd *c = &crowd->crowd;
    const imp_world *world = &crowd->scene->world;
    imp_world *own = &p->scene.world;
    const int g = p->group;
    for (int k = c->member_start[g]; k < c->member_start[g + 1]; k++) p->body[own->body_count++] = c->members[k];
    for (int k = c->pair_start[g]; k < c->pair_start[g + 1]; k++) crowd->local[world->pairs[c->pairs[k]].body2] = -1;
    for (int i = 0; i < own->body_count; i++) crowd->local[p->body[i]] = i;
    for (int k = c->pair_start[g]; k < c->pair_start[g + 1]; k++) {
        const int other = world->pairs[c->pairs[k]].body2;
        if (crowd->local[other] >= 0) continue;
        crowd->local[other] = own->body_count;
        p->body[own->body_count++] = other;
    }
    for (int k = c->pair_start[g]; k < c->pair_start[g + 1]; k++) p->pair[own->pair_count++] = c->pairs[k];
    for (int i = 0; i < own->body_count; i++) {
        own->bodies[i] = world->bodies[p->body[i]];
        p->top_speed[i] = c->bodies[p->body[i]].top_speed;
    }
    for (int k = 0; k < own->pair_count; k++) {
        own->pairs[k] = world->pairs[p->pair[k]];
        own->pairs[k].body1 = crowd->local[own->pairs[k].body1];
        own->pairs[k].body2 = crowd->local[own->pairs[k].body2];
    }
}

/* The group as the scene has it at the start of the while. */
static impact_status gather(imp_scene_crowd *crowd, party *p)
{
    const impact_scene *whole = crowd->scene;
    impact_scene *own = &p->scene;
    imp_motion_close(&own->motion);
    own->world.usage = (impact_usage){0};
    impact_status status =
        imp_motion_open(&own->motion, &own->world, whole->motion.tolerance, whole->motion.rest_speed);
    if (status != IMPACT_OK) return status;
    for (int i = 0; i < own->world.body_count; i++) {
        own->states[i] = own->before[i] = whole->states[p->body[i]];
        own->motion.resting[i] = whole->motion.resting[p->body[i]];
    }
    for (int k = 0; k < own->world.pair_count; k++) {
        const imp_pair *pair = &whole->world.pairs[p->pair[k]];
        const int body1 = own->world.pairs[k].body1, body2 = own->world.pairs[k].body2;
        own->world.pairs[k] = *pair;
        own->world.pairs[k].body1 = body1, own->world.pairs[k].body2 = body2;
        own->modes[k] = pair->mode;
    }
    own->t = whole->t;
    own->max_events = whole->max_events - whole->event_count;
    own->event_count = own->stalls = 0;
    own->impact_loss = own->impact_loss_before = own->impact_loss_fallen = 0;
    own->greatest_energy = whole->greatest_energy;
    imp_scene_receipt_begin(own);
    own->sampler.next = whole->sampler.next;
    own->stop = IMPACT_OK;
    own->message[0] = '\0';
    p->energy = own->energy_start = imp_scene_total_energy(own);
    return imp_persist_reserve(&own->motion.persist, &own->world, own->states);
}

static party *make_party(imp_scene_crowd *crowd, int group)
{
    const impact_scene *whole = crowd->scene;
    const imp_crowd *c = &crowd->crowd;
    const int members = c->member_start[group + 1] - c->member_start[group],
              pairs = c->pair_start[group + 1] - c->pair_start[group];
    party *p = imp_arena_take(whole->world.arena, 1, sizeof *p);
    if (!p) return NULL;
    p->owner = crowd;
    p->group = group;
    p->recorder = (impact_recorder){.context = p, .event = keep_event};
    if (whole->recorder && whole->recorder->sample) p->recorder.sample = keep_sample;
    p->scene.world = (imp_world){.arena = whole->world.arena,
                                 .gravity = whole->world.gravity,
                                 .driven = whole->world.driven,
                                 .slip_speed = whole->world.slip_speed,
                                 .onset_speed = whole->world.onset_speed,
                                 .flat_height = whole->world.flat_height};
    p->scene.duration = whole->duration;
    p->scene.law = whole->law;
    p->scene.compliance = whole->compliance;
    p->scene.springs = whole->springs;
    p->scene.solver = whole->solver;
    p->scene.rest_height = whole->rest_height;
    p->scene.rest_speed = whole->rest_speed;
    p->scene.recorder = whole->recorder ? &p->recorder : NULL;
    p->scene.sampler =
        (imp_sampler){.rate = whole->sampler.rate, .emit = imp_scene_emit, .pulse = party_pulse, .context = p};
    if (whole->sampler.piece) p->scene.sampler.piece = keep_piece;
    p->scene.key_tolerance = whole->key_tolerance;
    const impact_status status = allocate_party(p, members + pairs, pairs);
    if (status == IMPACT_OK) list_bodies(crowd, p);
    if (status == IMPACT_OK) return p;
    free_party(p);
    return NULL;
}

/* ---- moving groups on ---- */

/* A group at rest stays as it is, and its rows go on. */
static void stay(party *p, double t_end)
{
    impact_scene *own = &p->scene;
    while (p->recorder.sample && own->recorder && imp_motion_sample_time(&own->sampler) <= t_end)
        imp_scene_emit(own, (double)own->sampler.next++ / own->sampler.rate, own->states);
}

static impact_status move_party(imp_scene_crowd *crowd, party *p, double t_end)
{
    p->status = gather(crowd, p);
    if (p->status == IMPACT_OK) p->status = imp_scene_go_on(&p->scene, t_end, imp_scene_advance);
    if (p->status >= 0 && !within(p, p->scene.states)) crowd->escaped = true;
    return p->status;
}

static bool goes_on(impact_status status) { return status == IMPACT_OK || status == IMPACT_AT_REST; }

/* Moves all groups to t_end, or to where the first of them stopped; *stopped is that one, or NULL. */
static double move_parties(imp_scene_crowd *crowd, double t_end, party **stopped)
{
    bool again = true;
    *stopped = NULL;
    while (again) {
        again = false;
        for (int g = 0; g < crowd->party_count && !crowd->escaped && !crowd->stopped && !crowd->spent && !crowd->piled;
             g++) {
            party *p = crowd->parties[g];
            const bool done = p->moved && p->scene.t <= t_end;
            if (p == *stopped || (done && goes_on(p->status))) continue;
            p->moved = true;
            drop_rows(&crowd->rows, p->group);
            imp_kept_drop(&crowd->kept, p->group);
            memset(p->held, 0, sizeof *p->held * (size_t)p->scene.world.pair_count);
            if (goes_on(move_party(crowd, p, t_end))) continue;
            crowd->spent = p->status == IMPACT_ENOMEM;
            t_end = p->scene.t;
            *stopped = p;
            again = g > 0;
        }
    }
    return t_end;
}

static void add_usage(impact_usage *sum, const impact_usage *part)
{
    enum { COUNTS = sizeof *sum / sizeof(long) };
    long a[COUNTS], b[COUNTS];
    memcpy(a, sum, sizeof a);
    memcpy(b, part, sizeof b);
    for (int k = 0; k < COUNTS; k++) a[k] += b[k];
    memcpy(sum, a, sizeof a);
}

static void scatter(imp_scene_crowd *crowd, party *p)
{
    impact_scene *whole = crowd->scene, *own = &p->scene;
    for (int i = 0; i < own->world.body_count; i++) {
        if (own->world.bodies[i].is_static) continue;
        whole->states[p->body[i]] = own->states[i];
        whole->motion.resting[p->body[i]] = own->motion.resting[i];
        crowd->held[p->body[i]] = 0;
    }
    for (int k = 0; k < own->world.pair_count; k++) {
        imp_pair *pair = &whole->world.pairs[p->pair[k]];
        const int body1 = pair->body1, body2 = pair->body2;
        *pair = own->world.pairs[k];
        pair->body1 = body1, pair->body2 = body2;
        crowd->held[body1] += imp_is_held(pair);
        crowd->held[body2] += imp_is_held(pair);
    }
    whole->motion.works.force += own->motion.works.force;
    whole->motion.works.damping += own->motion.works.damping;
    whole->motion.works.sliding += own->motion.works.sliding;
    whole->motion.works.drive += own->motion.works.drive;
    imp_scene_receipt_add(whole, own);
    whole->impact_loss += own->impact_loss;
    whole->event_count += own->event_count;
    add_usage(&whole->world.usage, &own->world.usage);
    crowd->energy[p->group] = p->energy;
    crowd->energy_end[p->group] = imp_scene_total_energy(own);
}

/* ---- whiles ---- */

/* Rest is where the last body came to it. */
static double rest_time(const imp_scene_crowd *crowd, double t_end)
{
    double latest = crowd->scene->t;
    for (int g = 0; g < crowd->party_count; g++) {
        if (crowd->parties[g]->status != IMPACT_AT_REST) return t_end;
        latest = fmax(latest, crowd->parties[g]->scene.t);
    }
    return latest;
}

/* The time in which a body goes some part of its radius, more where few can meet. */
static double choose_while(imp_scene_crowd *crowd)
{
    const double least = 0.01, most = 4;
    const impact_scene *scene = crowd->scene;
    double radius = 0, square = 0;
    int moving = 0;
    for (int i = 0; i < scene->world.body_count; i++) {
        if (scene->world.bodies[i].is_static) continue;
        moving++;
        radius += scene->world.bodies[i].radius;
        square += qvec3_dot(scene->states[i].v, scene->states[i].v);
    }
    radius /= moving;
    const double natural = radius / (sqrt(square / moving) + sqrt(qvec3_norm(scene->world.gravity) * radius) + 1e-300);
    const int busy = 15 * crowd->crowd.meetings; /* a fifteenth as many meetings as bodies costs least: bench_crowd */
    if (busy > moving) crowd->while_time *= 0.7;
    if (2 * busy < moving) crowd->while_time *= 1.4;
    crowd->while_time = fmin(fmax(crowd->while_time, least * natural), most * natural);
    return crowd->while_time;
}

static impact_status make_parties(imp_scene_crowd *crowd, double time, double caution)
{
    const impact_scene *scene = crowd->scene;
    free_parties(crowd);
    impact_status status = imp_crowd_divide(&crowd->crowd, &scene->world, scene->states, scene->motion.resting,
                                            crowd->held, time, caution);
    if (status != IMPACT_OK) return status;
    crowd->parties = imp_arena_take(scene->world.arena, (size_t)crowd->crowd.group_count + 1, sizeof *crowd->parties);
    if (!crowd->parties) return IMPACT_ENOMEM;
    crowd->rows.count = crowd->rows.next = crowd->kept.count = 0;
    for (; crowd->party_count < crowd->crowd.group_count; crowd->party_count++) {
        crowd->parties[crowd->party_count] = make_party(crowd, crowd->party_count);
        if (!crowd->parties[crowd->party_count]) return IMPACT_ENOMEM;
    }
    return IMPACT_OK;
}

static impact_status close_while(imp_scene_crowd *crowd, double t_end, const party *stopped)
{
    impact_scene *scene = crowd->scene;
    for (int g = 0; g < crowd->party_count; g++) {
        if (crowd->parties[g]->status == IMPACT_AT_REST) stay(crowd->parties[g], t_end);
        scatter(crowd, crowd->parties[g]);
    }
    impact_status status =
        imp_rows_arrange(&crowd->rows, crowd->party_count, scene->t, t_end, crowd->energy, crowd->energy_end);
    scene->t = t_end;
    while (imp_motion_sample_time(&scene->sampler) <= t_end) scene->sampler.next++;
    if (status == IMPACT_OK) status = imp_scene_crowd_deliver(scene);
    if (status == IMPACT_OK) status = imp_kept_deliver(&crowd->kept, scene);
    if (status != IMPACT_OK || !stopped) return status;
    memcpy(scene->message, stopped->scene.message, sizeof scene->message);
    return stopped->status;
}

impact_status imp_scene_crowd_advance(impact_scene *scene, double t_end)
{
    enum { TRIES = 60 };
    imp_scene_crowd *crowd = scene->crowd;
    const double end = fmin(t_end, scene->t + choose_while(crowd));
    double caution = 3;
    crowd->stopped = crowd->piled = false;
    for (int try = 0; try < TRIES; try++, caution *= 2) {
        crowd->escaped = false;
        const impact_status status = make_parties(crowd, end - scene->t, caution);
        if (status != IMPACT_OK) return status;
        party *stopped;
        const double reached = move_parties(crowd, end, &stopped);
        if (crowd->spent) return IMPACT_ENOMEM;
        if (crowd->stopped) return scene->stop;
        if (crowd->piled) { /* nothing was taken over yet: by steps, then */
            crowd->rows.count = crowd->rows.next = crowd->kept.count = 0;
            return IMPACT_OK;
        }
        if (!crowd->escaped) return close_while(crowd, stopped ? reached : rest_time(crowd, end), stopped);
    }
    snprintf(scene->message, sizeof scene->message, "a body got faster without bound after t = %.17g", scene->t);
    return IMPACT_EUNSETTLED;
}

impact_status imp_scene_crowd_deliver(impact_scene *scene)
{
    return imp_rows_deliver(&scene->crowd->rows, scene->recorder);
}

void imp_scene_crowd_begin(impact_scene *scene)
{
    imp_scene_crowd *crowd = scene->crowd;
    memset(crowd->held, 0, sizeof *crowd->held * (size_t)scene->world.body_count);
    for (int k = 0; k < scene->world.pair_count; k++) {
        const imp_pair *pair = &scene->world.pairs[k];
        crowd->held[pair->body1] += imp_is_held(pair);
        crowd->held[pair->body2] += imp_is_held(pair);
    }
}

impact_status imp_scene_crowd_open(impact_scene *scene)
{
    const size_t n = (size_t)scene->world.body_count + 1;
    int moving = 0;
    for (int i = 0; i < scene->world.body_count; i++) moving += !scene->world.bodies[i].is_static;
    if (moving < LEAST_BODIES || scene->world.field_count > 0) return IMPACT_OK;
    imp_arena *arena = scene->world.arena;
    imp_scene_crowd *crowd = scene->crowd = imp_arena_take(arena, 1, sizeof *crowd);
    if (!crowd) return IMPACT_ENOMEM;
    *crowd = (imp_scene_crowd){.scene = scene,
                               .rows.arena = arena,
                               .kept.arena = arena,
                               .held = imp_arena_take(arena, n, sizeof *crowd->held),
                               .local = imp_arena_take(arena, n, sizeof *crowd->local),
                               .energy = imp_arena_take(arena, n, sizeof *crowd->energy),
                               .energy_end = imp_arena_take(arena, n, sizeof *crowd->energy_end)};
    if (!crowd->held || !crowd->local || !crowd->energy || !crowd->energy_end) return IMPACT_ENOMEM;
    return imp_crowd_open(&crowd->crowd, &scene->world);
}

void imp_scene_crowd_close(impact_scene *scene)
{
    imp_scene_crowd *crowd = scene->crowd;
    if (!crowd) return;
    free_parties(crowd);
    imp_crowd_close(&crowd->crowd);
    imp_rows_free(&crowd->rows);
    imp_kept_free(&crowd->kept);
    imp_arena_give(crowd->scene->world.arena, crowd->held);
    imp_arena_give(crowd->scene->world.arena, crowd->local);
    imp_arena_give(crowd->scene->world.arena, crowd->energy);
    imp_arena_give(crowd->scene->world.arena, crowd->energy_end);
    imp_arena_give(scene->world.arena, crowd);
    scene->crowd = NULL;
}
