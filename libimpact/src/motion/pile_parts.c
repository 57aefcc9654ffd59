/* SPDX-License-Identifier: MIT */
#include "motion/pile_parts.h"
#include "base/tolerances.h"
#include "contact/encounter.h"

#include <quat/exponential.h>

/* ---- room ---- */

void imp_pile_open(imp_pile *pile, imp_arena *arena, double tolerance)
{
    *pile = (imp_pile){.arena = arena,
                       .tolerance = tolerance,
                       .longest = IMP_PILE_LONGEST * cbrt(tolerance / IMP_DEFAULT_PILE_TOLERANCE),
                       .cone.arena = arena,
                       .rest.arena = arena,
                       .touching.arena = arena,
                       .by_bodies.arena = arena};
}

static void *replaced(imp_pile *pile, void *old, size_t count, size_t size, bool *there)
{
    imp_arena_give(pile->arena, old);
    void *room = imp_arena_take(pile->arena, count, size);
    *there = *there && room;
    return room;
}

bool imp_pile_reserve_bodies(imp_pile *pile, const imp_world *world)
{
    const size_t bodies = (size_t)world->body_count;
    bool there = imp_pile_contacts_reserve(&pile->touching, world);
    if (world->body_count <= pile->bodies) return there;
    imp_state **states[] = {&pile->middle, &pile->mean, &pile->end, &pile->projected, &pile->from};
    for (int k = 0; k < 5; k++) *states[k] = replaced(pile, *states[k], bodies, sizeof **states[k], &there);
    for (int k = 0; k < IMP_PILE_RATES; k++) {
        imp_pile_rates **rates[] = {&pile->rates[k], &pile->kept.rates[k]};
        for (int i = 0; i < 2; i++) *rates[i] = replaced(pile, *rates[i], bodies, sizeof **rates[i], &there);
    }
    pile->loads = replaced(pile, pile->loads, bodies, sizeof *pile->loads, &there);
    pile->number = replaced(pile, pile->number, bodies, sizeof *pile->number, &there);
    pile->listed = replaced(pile, pile->listed, bodies, sizeof *pile->listed, &there);
    pile->velocities = replaced(pile, pile->velocities, bodies, sizeof *pile->velocities, &there);
    pile->bodies = there ? world->body_count : 0;
    return there;
}

/* The numbers that a contact of the world may have. */
static int widest_of(const imp_world *world)
{
    for (int p = 0; p < world->pair_count; p++)
        if (imp_is_rough(&world->pairs[p])) return IMP_CONE_WIDEST;
    return 3;
}

bool imp_pile_reserve_contacts(imp_pile *pile, const imp_world *world, int wanted)
{
    const int widest = widest_of(world);
    if (wanted <= pile->contacts_most && widest <= pile->widest) return true;
    const int contacts = wanted > pile->contacts_most ? wanted + wanted / 2 : pile->contacts_most;
    const size_t count = (size_t)contacts, n = (size_t)widest * count;
    bool there = true;
    pile->lengths = replaced(pile, pile->lengths, count, sizeof *pile->lengths, &there);
    pile->turns = replaced(pile, pile->turns, count, sizeof *pile->turns, &there);
    pile->contacts = replaced(pile, pile->contacts, count, sizeof *pile->contacts, &there);
    pile->couples = replaced(pile, pile->couples, count, sizeof *pile->couples, &there);
    pile->members = replaced(pile, pile->members, count, sizeof *pile->members, &there);
    pile->rows = replaced(pile, pile->rows, count, sizeof *pile->rows, &there);
    pile->bounce = replaced(pile, pile->bounce, count, sizeof *pile->bounce, &there);
    pile->friction = replaced(pile, pile->friction, count, sizeof *pile->friction, &there);
    pile->pivots = replaced(pile, pile->pivots, 2 * count, sizeof *pile->pivots, &there);
    imp_arena_give(pile->arena, pile->w);
    pile->w = imp_arena_take_unset(pile->arena, n * n, sizeof *pile->w); /* which many contacts never touch */
    there = there && pile->w;
    pile->gap = replaced(pile, pile->gap, count, sizeof *pile->gap, &there);
    pile->balance = replaced(pile, pile->balance, imp_encounter_wedge_size(count), sizeof *pile->balance, &there);
    double **vectors[] = {&pile->q,      &pile->r,      &pile->u,    &pile->before,
                          &pile->last_r, &pile->last_u, &pile->lead, &pile->bend};
    for (int k = 0; k < 8; k++) *vectors[k] = replaced(pile, *vectors[k], n, sizeof **vectors[k], &there);
    const int dense =
        contacts < IMP_PILE_DENSE ? contacts : IMP_PILE_DENSE; /* more are never solved in their own space */
    there = (widest > 3 ? imp_cone_reserve_turning : imp_cone_reserve)(&pile->cone, dense) && there;
    pile->contacts_most = there ? contacts : 0;
    pile->widest = widest;
    return there;
}

quat imp_pile_turned(quat q, qvec3 omega, double h)
{
    const qvec3 turn = qvec3_scale(omega, h);
    if (qvec3_norm(turn) > 0) (void)quat_normalize(quat_mul(quat_exp_pure(qvec3_scale(turn, 0.5)), q), &q);
    return q;
}

/* What moves goes on with its velocities for h. */
void imp_pile_drift(const imp_world *world, const imp_state *velocities, double h, imp_state *states)
{
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        const qvec3 omega = imp_omega(body, &velocities[i]); /* the states may be these */
        states[i].x = qvec3_axpy(h, velocities[i].v, states[i].x);
        states[i].q = imp_pile_turned(states[i].q, omega, h);
    }
}

/* A measure of the pile: its smallest body. */
double imp_pile_smallest(const imp_world *world)
{
    double least = INFINITY;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) least = fmin(least, world->bodies[i].radius);
    return least;
}

double imp_pile_allowed(const imp_pile *pile, const imp_world *world)
{
    return pile->tolerance * imp_pile_smallest(world);
}

double imp_pile_slack(const imp_pile *pile, const imp_world *world)
{
    return IMP_PILE_SLACK * imp_pile_allowed(pile, world);
}

int imp_pile_list_bodies(imp_pile *pile, const imp_world *world, int count)
{
    int bodies = 0;
    for (int c = 0; c < count; c++) pile->number[pile->contacts[c].body1] = pile->number[pile->contacts[c].body2] = -1;
    for (int c = 0; c < count; c++) {
        const int body[2] = {pile->contacts[c].body1, pile->contacts[c].body2};
        for (int k = 0; k < 2; k++) {
            if (world->bodies[body[k]].is_static || pile->number[body[k]] >= 0) continue;
            pile->number[body[k]] = bodies;
            pile->listed[bodies++] = body[k];
        }
    }
    return bodies;
}

/* The points of the next island to the front of the arrays, with their gaps; how many. */
int imp_pile_gather_island(imp_pile *pile, const imp_world *world)
{
    const int count = imp_pile_take_island(&pile->touching, world, pile->members);
    pile->width = 3;
    for (int c = 0; c < count; c++) {
        const imp_pile_point *point = &pile->touching.points[pile->members[c]];
        const imp_pair *pair = &world->pairs[point->pair];
        pile->contacts[c] = point->contact;
        pile->friction[c] = point->strength * pair->law.friction;
        pile->lengths[c] = (imp_cone_lengths){pair->law.torsional, pair->law.rolling};
        pile->gap[c] = point->gap;
        if (imp_is_rough(pair)) pile->width = IMP_CONE_WIDEST;
    }
    return count;
}
