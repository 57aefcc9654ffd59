/* SPDX-License-Identifier: MIT */
#include "scene/island.h"
#include "motion/motion_equations.h"
#include "motion/motion_pile.h"
#include "scene/scene_internal.h"
#include "scene/stepped.h"
#include "world/world_gap.h"

#include <string.h>

static impact_status reserve_bodies(imp_island *island, int bodies)
{
    if (bodies <= island->body_room && bodies <= island->motion.room) return IMPACT_OK;
    imp_arena *arena = island->scene->world.arena;
    int room[3] = {island->body_room, island->body_room, island->body_room};
    imp_body *list = imp_arena_grow(arena, island->world.bodies, &room[0], bodies, sizeof *list);
    if (list) island->world.bodies = list;
    imp_state *states = imp_arena_grow(arena, island->states, &room[1], bodies, sizeof *states);
    if (states) island->states = states;
    imp_state *before = imp_arena_grow(arena, island->before, &room[2], bodies, sizeof *before);
    if (before) island->before = before;
    if (!list || !states || !before) return IMPACT_ENOMEM;
    island->body_room = room[0];
    return imp_motion_reserve(&island->motion, arena, bodies) ? IMPACT_OK : IMPACT_ENOMEM;
}

static impact_status reserve_pairs(imp_island *island, int pairs)
{
    if (pairs <= island->pair_room) return IMPACT_OK;
    imp_arena *arena = island->scene->world.arena;
    int room[2] = {island->pair_room, island->pair_room};
    imp_pair *list = imp_arena_grow(arena, island->world.pairs, &room[0], pairs, sizeof *list);
    if (list) island->world.pairs = list;
    imp_note *notes = imp_arena_grow(arena, island->notes, &room[1], pairs, sizeof *notes);
    if (notes) island->notes = notes;
    if (!list || !notes) return IMPACT_ENOMEM;
    island->pair_room = room[0];
    return IMPACT_OK;
}

impact_status imp_island_reserve(imp_island *island, int bodies, int pairs)
{
    const impact_status status = reserve_bodies(island, bodies);
    return status == IMPACT_OK ? reserve_pairs(island, pairs) : status;
}

void imp_island_clear(imp_island *island)
{
    imp_world *world = &island->world;
    const imp_world *whole = &island->scene->world;
    world->arena = whole->arena;
    world->body_count = world->pair_count = 0;
    world->gravity = whole->gravity;
    world->driven = false;
    world->gaps = whole->gaps;
    world->slip_speed = whole->slip_speed;
    world->incipient_speed = whole->incipient_speed;
    world->flat_height = whole->flat_height;
    island->number = -1;
    island->strides = 0;
    island->impact_loss = island->loss_before = island->gained = island->outside = 0;
    island->rests = island->rolls = island->loses = island->lies = island->stepped = island->moves = false;
    island->end = (imp_end){IMP_END_TIME, 0};
    island->pushed = (imp_push){.off = 0};
    imp_motion_reset(&island->motion, world, &island->scene->methods, island->scene->rest_speed);
}

static void free_fields(imp_world *world)
{
    for (int k = 0; k < world->field_count; k++) imp_arena_give(world->arena, world->fields[k].inside);
    imp_arena_give(world->arena, world->fields);
    world->fields = NULL;
    world->field_count = 0;
}

void imp_island_set_slip_speed(imp_island *island, double speed)
{
    island->world.slip_speed = speed;
    island->world.incipient_speed = IMP_INCIPIENT_OF_SLIP_SPEED * speed;
}

int imp_island_add_body(imp_island *island, int body, const imp_state *state)
{
    imp_world *world = &island->world;
    const int i = world->body_count++;
    world->bodies[i] = island->scene->world.bodies[body];
    const imp_body *own = &world->bodies[i];
    const double told = own->is_static ? 0 : IMP_SLIP_TOLD * imp_motion_speed(own, state);
    if (told > world->slip_speed) imp_island_set_slip_speed(island, told);
    world->driven = world->driven || world->bodies[i].driven;
    island->states[i] = *state;
    island->motion.resting[i] = false;
    return i;
}

int imp_island_find(const imp_island *island, int body)
{
    int low = 0, high = island->world.body_count - 1;
    while (low <= high) {
        const int middle = (low + high) / 2, there = island->world.bodies[middle].index;
        if (there == body) return middle;
        if (there < body)
            low = middle + 1;
        else
            high = middle - 1;
    }
    return -1;
}

/* ---- forces ---- */

/* Whether the scene's force acts on one of the island's bodies; the island's index of the only one it acts on. */
static bool acts_here(const imp_island *island, const imp_field *field, int *only)
{
    *only = field->only < 0 ? -1 : imp_island_find(island, field->only);
    return field->only < 0 || *only >= 0;
}

/* The scene's slot of the island's. */
static int slot_of(const imp_island *island, const imp_field *field, int slot)
{
    const imp_body *bodies = island->world.bodies;
    if (field->def.kind != IMPACT_FORCE_ATTRACTION) return bodies[slot].index;
    int j = 1, first = 0;
    while (slot >= first + j) first += j++;
    const int low = bodies[slot - first].index, high = bodies[j].index;
    return low + high * (high - 1) / 2;
}

impact_status imp_island_take_forces(imp_island *island)
{
    const imp_world *whole = &island->scene->world;
    imp_world *world = &island->world;
    free_fields(world);
    if (whole->field_count == 0) return IMPACT_OK;
    world->fields = imp_arena_take(world->arena, (size_t)whole->field_count, sizeof *world->fields);
    if (!world->fields) return IMPACT_ENOMEM;
    for (int k = 0; k < whole->field_count; k++) {
        int only;
        if (!acts_here(island, &whole->fields[k], &only)) continue;
        imp_field *field = &world->fields[world->field_count++];
        *field = whole->fields[k];
        field->only = only;
        field->slots = imp_field_slots(&field->def, world->body_count);
        field->number = k;
        field->inside = imp_arena_take(world->arena, (size_t)field->slots + 1, sizeof *field->inside);
        if (!field->inside) return IMPACT_ENOMEM;
        for (int s = 0; s < field->slots; s++) field->inside[s] = whole->fields[k].inside[slot_of(island, field, s)];
    }
    imp_field_enter(world, island->t);
    return IMPACT_OK;
}

void imp_island_give_forces(imp_island *island)
{
    for (int k = 0; k < island->world.field_count; k++) {
        const imp_field *field = &island->world.fields[k];
        imp_field *own = &island->scene->world.fields[field->number];
        for (int s = 0; s < field->slots; s++) own->inside[slot_of(island, field, s)] = field->inside[s];
    }
}

/* ---- its clock ---- */

impact_status imp_island_look(imp_island *island, double t, bool parted)
{
    imp_motion *motion = &island->motion;
    const imp_tracks *tracks = &island->scene->tracks;
    const imp_world *world = &island->world;
    if (island->rests || island->rolls) {
        for (int i = 0; i < world->body_count; i++)
            motion->sampled[i] = imp_segment_at(&tracks->tracks[world->bodies[i].index].segment, &world->bodies[i], t);
        return IMPACT_OK;
    }
    memcpy(motion->sampled, island->states, (size_t)world->body_count * sizeof *island->states); /* static ones */
    if (!island->moves) return IMPACT_OK;
    return island->stepped && parted ? imp_motion_look_by_steps(motion, island->pile, t, motion->sampled)
                                     : imp_motion_look(motion, t, motion->sampled);
}

void imp_island_put_back(imp_island *island)
{
    if (island->rests || island->rolls || island->stepped || !island->moves) return;
    (void)imp_motion_put_back(&island->motion, island->t,
                              island->states); /* what is refused is found when it departs */
}

void imp_island_go_to(imp_island *island, double t)
{
    const imp_tracks *tracks = &island->scene->tracks;
    const imp_world *world = &island->world;
    if (island->rests || island->rolls) {
        for (int i = 0; i < world->body_count; i++)
            island->states[i] = imp_segment_at(&tracks->tracks[world->bodies[i].index].segment, &world->bodies[i], t);
        const double left = island->loses ? imp_island_energy(island) : island->begun_with;
        if (island->loses) island->motion.works.sliding += island->begun_with - left;
        island->begun_with = left;
    } else {
        imp_motion_go_to(&island->motion, t, island->states);
        if (island->stepped)
            island->impact_loss = imp_island_stepped_loss(island, island->states, &island->motion.works);
    }
    island->t = t;
    imp_island_put_back(island);
}

/* What friction has taken of a ball since its segment began, at t, J. */
static double rubbed_off(const imp_island *island, double t)
{
    double left = 0;
    for (int i = 0; i < island->world.body_count; i++) {
        const imp_body *body = &island->world.bodies[i];
        if (body->is_static) continue;
        const imp_state now = imp_segment_at(&island->scene->tracks.tracks[body->index].segment, body, t);
        left += imp_body_energy(body, &now, island->world.gravity);
    }
    return island->begun_with - left;
}

imp_works imp_island_works(const imp_island *island, double t)
{
    imp_works works = island->motion.works;
    if (!island->rests && !island->rolls && island->moves) return imp_motion_works(&island->motion, t);
    if (island->rolls && island->loses && island->moves) works.sliding += rubbed_off(island, t);
    return works;
}

double imp_island_loss(const imp_island *island, double t)
{
    if (!island->stepped || island->rests || !island->moves) return island->impact_loss;
    const imp_works works = imp_island_works(island, t);
    return imp_island_stepped_loss(island, island->motion.sampled, &works);
}

/* ---- momentum ---- */

static qvec3 momentum_of(const imp_island *island, double *size)
{
    const imp_world *world = &island->world;
    qvec3 sum = {0, 0, 0};
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        sum = qvec3_axpy(body->mass, island->states[i].v, sum);
        *size += body->mass * (qvec3_norm(island->states[i].v) + world->slip_speed);
    }
    return sum;
}

void imp_island_begin_push(imp_island *island)
{
    island->pushed = (imp_push){.off = island->pushed.off};
    island->pushed.had = momentum_of(island, &island->pushed.size);
}

void imp_island_push(imp_island *island, qvec3 impulse)
{
    island->pushed.given = qvec3_add(island->pushed.given, impulse);
    island->pushed.size += qvec3_norm(impulse);
}

void imp_island_end_push(imp_island *island)
{
    imp_push *pushed = &island->pushed;
    const qvec3 now = momentum_of(island, &pushed->size), due = qvec3_add(pushed->had, pushed->given);
    if (!(pushed->size > 0)) return;
    const double off = qvec3_norm(qvec3_sub(now, due)) / pushed->size;
    if (!(off <= pushed->off)) pushed->off = off; /* a NaN stays */
}

/* ---- energy ---- */

double imp_island_energy(const imp_island *island)
{
    return imp_world_kinetic_energy(&island->world, island->states) +
           imp_field_potential(&island->world, island->states);
}

double imp_island_balance(const imp_island *island)
{
    const imp_works *works = &island->motion.works;
    return imp_island_energy(island) + island->impact_loss + works->damping + works->sliding - works->force -
           works->drive;
}
