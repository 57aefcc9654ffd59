/* SPDX-License-Identifier: MIT */
#include "contact/held_law.h"
#include "contact/encounter.h"
#include "contact/held_flat.h"

#include <math.h>

bool imp_held_law_take(imp_arena *arena, int count, imp_held_law *law)
{
    const size_t size = (size_t)count, n = 3 * size;
    *law = (imp_held_law){.contact = imp_arena_take(arena, size, sizeof *law->contact),
                          .contacts = imp_arena_take(arena, size, sizeof *law->contacts),
                          .rows = imp_arena_take(arena, size, sizeof *law->rows),
                          .modes = imp_arena_take(arena, size, sizeof *law->modes),
                          .w = imp_arena_take(arena, n * n + 3 * n + size, sizeof *law->w),
                          .cone = {.arena = arena}};
    if (!law->contact || !law->contacts || !law->rows || !law->modes || !law->w) return false;
    law->q = law->w + n * n, law->r = law->q + n, law->u = law->r + n, law->friction = law->u + n;
    law->room = imp_arena_take(arena, imp_encounter_wedge_size(size), sizeof *law->room);
    return law->room && imp_cone_reserve(&law->cone, count);
}

void imp_held_law_give(imp_held_law *law)
{
    imp_arena *arena = law->cone.arena;
    imp_cone_release(&law->cone);
    imp_arena_give(arena, law->contact);
    imp_arena_give(arena, law->contacts);
    imp_arena_give(arena, law->rows);
    imp_arena_give(arena, law->modes);
    imp_arena_give(arena, law->w);
    imp_arena_give(arena, law->room);
}

static void list_contacts(const imp_held *held, int island, imp_held_law *law)
{
    law->count = 0;
    for (int c = island; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (held->island[c] != island) continue;
        imp_cone_contact *own = &law->contacts[law->count];
        *own = (imp_cone_contact){
            .body1 = contact->body1, .body2 = contact->body2, .arm1 = contact->r1, .arm2 = contact->r2};
        imp_cone_find_axes(contact->normal, own->axes);
        law->friction[law->count] = contact->friction;
        law->contact[law->count++] = c;
    }
}

/* A body that lies on a flat place has no other contact. */
static void lie_on_flat(const imp_world *world, const imp_held_contact *contact, const imp_state *states,
                        const imp_load *loads, imp_held_law *law)
{
    const double response = world->bodies[contact->body1].inverse_mass;
    const qvec3 holding = imp_flat_holding(world, contact->pair, states, loads);
    for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++) law->w[3 * k + l] = k == l ? response : 0;
        law->q[k] = -response * qvec3_dot(law->contacts[0].axes[k], holding);
    }
}

/* W and q. */
static void find_problem(const imp_held *held, const imp_world *world, const imp_state *states, const imp_load *loads,
                         imp_held_law *law)
{
    const imp_held_contact *first = &held->contacts[law->contact[0]];
    if (first->foot == IMP_FOOT_FLAT) {
        lie_on_flat(world, first, states, loads, law);
        return;
    }
    imp_cone_assemble(world, states, law->contacts, law->count, law->rows, law->w);
    for (int i = 0; i < law->count; i++) {
        const imp_held_contact *contact = &held->contacts[law->contact[i]];
        for (int k = 0; k < 3; k++) law->q[3 * i + k] = qvec3_dot(law->contacts[i].axes[k], contact->bias);
        law->q[3 * i] += qvec3_dot(contact->normal_rate, contact->slip);
    }
}

/* Where pressures balance that no load makes, as between two walls, each contact yields a little: bodies that do have
 * none of these. */
static void let_yield(imp_held_law *law)
{
    const imp_wedge_question question = {.count = law->count, .w = law->w, .friction = law->friction};
    if (law->count < 2 || !imp_encounter_wedged(&question, law->room)) return;
    imp_cone_let_yield(law->w, 3 * law->count);
}

void imp_held_law_find(const imp_held *held, const imp_world *world, const imp_state *states, const imp_load *loads,
                       int island, imp_held_law *law)
{
    list_contacts(held, island, law);
    find_problem(held, world, states, loads, law);
    let_yield(law);
    law->size = 0;
    for (int i = 0; i < 3 * law->count; i++) law->size = fmax(law->size, fabs(law->q[i]));
}

imp_cone_outcome imp_held_law_solve(imp_held_law *law)
{
    const imp_cone_problem problem = {.count = law->count, .w = law->w, .q = law->q, .friction = law->friction};
    return imp_cone_solve(&problem, &law->cone, law->r, law->u, law->modes);
}
