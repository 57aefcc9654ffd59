/* SPDX-License-Identifier: MIT
 *
 * Rest needs reactions that balance the loads (rest.h), not that they be unique, and that Coulomb's law keeps the
 * bodies where they are if they stand (held_law.h). Its answer begins without reactions, so that contacts are pressed
 * by the loads alone: of a ball that just fits between two walls friction gives way, though walls that squeezed it
 * could hold it.
 */
#include "contact/held_still.h"
#include "contact/held_law.h"
#include "contact/held_system.h"
#include "contact/rest.h"
#include "world/world_gap.h"

/* What the loads and the reactions do to each body. */
typedef struct body_rate {
    qvec3 linear, angular; /* m/s^2, 1/s^2 */
} body_rate;

typedef struct workspace {
    body_rate *rates; /* per body */
    imp_pair *before; /* the pairs as they were */
    bool *locked;     /* per body: what sticks at its contacts leaves it no motion */
    bool room;        /* false: memory was refused */
} workspace;

static bool is_slow(const imp_world *world, const imp_state *states, int i, double rest_speed)
{
    const imp_body *body = &world->bodies[i];
    if (body->is_static) return !body->driven;
    return qvec3_norm(states[i].v) + body->radius * qvec3_norm(imp_omega(body, &states[i])) <= rest_speed;
}

static bool pair_is_slow(const imp_world *world, const imp_state *states, const imp_pair *pair, double rest_speed)
{
    return is_slow(world, states, pair->body1, rest_speed) && is_slow(world, states, pair->body2, rest_speed);
}

/* ---- reactions ---- */

static void push(const imp_world *world, const imp_state *states, const imp_held_contact *contact, qvec3 f,
                 body_rate *rates)
{
    const int bodies[2] = {contact->body1, contact->body2};
    const qvec3 arms[2] = {contact->r1, contact->r2};
    for (int k = 0; k < 2; k++) {
        const imp_body *body = &world->bodies[bodies[k]];
        if (body->is_static) continue;
        const qvec3 own = k == 0 ? f : qvec3_neg(f);
        body_rate *rate = &rates[bodies[k]];
        rate->linear = qvec3_axpy(body->inverse_mass, own, rate->linear);
        rate->angular =
            qvec3_add(rate->angular, imp_inverse_inertia(body, states[bodies[k]].q, qvec3_cross(arms[k], own)));
    }
}

static qvec3 acceleration(const imp_held_contact *contact, const body_rate *rates)
{
    const body_rate *one = &rates[contact->body1], *two = &rates[contact->body2]; /* zero of a static body */
    return qvec3_sub(qvec3_add(one->linear, qvec3_cross(one->angular, contact->r1)),
                     qvec3_add(two->linear, qvec3_cross(two->angular, contact->r2)));
}

static void begin_rates(const imp_world *world, const imp_state *states, const imp_load *loads, body_rate *rates)
{
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        rates[i] = (body_rate){{0, 0, 0}, {0, 0, 0}};
        if (body->is_static) continue;
        rates[i].linear = qvec3_scale(loads[i].force, body->inverse_mass);
        rates[i].angular = imp_inverse_inertia(body, states[i].q, loads[i].torque);
    }
}

/* The bodies' greatest acceleration, any point's. */
static double greatest(const imp_held *held, const imp_world *world, int island, const body_rate *rates)
{
    double most = 0;
    for (int c = 0; c < held->count; c++) {
        if (held->island[c] != island) continue;
        const int bodies[2] = {held->contacts[c].body1, held->contacts[c].body2};
        for (int k = 0; k < 2; k++)
            if (!world->bodies[bodies[k]].is_static)
                most = fmax(most, qvec3_norm(rates[bodies[k]].linear) +
                                      world->bodies[bodies[k]].radius * qvec3_norm(rates[bodies[k]].angular));
    }
    return most;
}

/* The reaction that the contact's pair remembers, if that still is one. */
static qvec3 last_reaction(const imp_world *world, const imp_held_contact *contact)
{
    const qvec3 f = world->pairs[contact->pair].rest.reaction;
    const double pressure = qvec3_dot(contact->normal, f), rubs = qvec3_norm(qvec3_axpy(-pressure, contact->normal, f));
    return pressure >= 0 && rubs <= contact->friction * pressure + IMP_STILL_SETTLED * pressure ? f : (qvec3){0, 0, 0};
}

/* The acceleration that the loads and the contacts' forces leave the island's bodies. */
static double left_by(const imp_held *held, const imp_world *world, const imp_state *states, const imp_load *loads,
                      int island, body_rate *rates)
{
    begin_rates(world, states, loads, rates);
    for (int c = 0; c < held->count; c++)
        if (held->island[c] == island) push(world, states, &held->contacts[c], held->contacts[c].force, rates);
    return greatest(held, world, island, rates);
}

/* Takes the contacts' forces from the law's r. */
static void read_law(imp_held *held, const imp_held_law *law)
{
    for (int i = 0; i < law->count; i++) {
        imp_held_contact *contact = &held->contacts[law->contact[i]];
        const qvec3 *axes = law->contacts[i].axes;
        const double *r = &law->r[3 * i];
        contact->pressure = r[0];
        contact->force = qvec3_axpy(r[0], axes[0], qvec3_axpy(r[1], axes[1], qvec3_scale(axes[2], r[2])));
    }
}

/* Whether the law, if all velocities were 0, leaves the bodies where they are. Its reactions are no matter: its path
 * may take such as squeeze 1e10 times as hard as need be. */
static bool law_holds(imp_held *held, const imp_world *world, const imp_state *states, const imp_load *loads,
                      int island, double load, workspace *work, imp_held_law *law)
{
    begin_rates(world, states, loads, work->rates);
    imp_held_law_find(held, world, states, loads, island, law);
    for (int i = 0; i < law->count; i++) {
        const qvec3 a = acceleration(&held->contacts[law->contact[i]], work->rates);
        for (int k = 0; k < 3; k++) law->q[3 * i + k] = qvec3_dot(law->contacts[i].axes[k], a);
    }
    const imp_cone_outcome o = imp_held_law_solve(law);
    if (o.status != IMP_CONE_SOLVED && o.status != IMP_CONE_INEXACT) return false;
    read_law(held, law);
    return left_by(held, world, states, loads, island, work->rates) <= IMP_STILL_HELD * load;
}

/* The contacts' least forces that balance the loads, if there are any. */
static void take_least(imp_held *held, const imp_world *world, const imp_state *states, const imp_load *loads,
                       imp_rest_workspace *rest, imp_held_law *law, imp_rest_velocity *velocities)
{
    imp_rest_solve(world, states, law->contacts, law->friction, NULL, law->count, loads, rest, law->r, velocities);
    read_law(held, law);
}

static bool find_reactions(imp_held *held, const imp_world *world, const imp_state *states, const imp_load *loads,
                           int island, double load, workspace *work)
{
    imp_held_law law;
    imp_rest_workspace rest = {.arena = world->arena};
    imp_rest_velocity *velocities = imp_arena_take(world->arena, (size_t)world->body_count, sizeof *velocities);
    const bool room = imp_held_law_take(world->arena, held->count, &law) && velocities &&
                      imp_rest_reserve(&rest, held->count, world->body_count);
    const bool found = room && law_holds(held, world, states, loads, island, load, work, &law);
    if (found) take_least(held, world, states, loads, &rest, &law, velocities);
    imp_held_law_give(&law);
    imp_rest_release(&rest);
    imp_arena_give(world->arena, velocities);
    work->room = work->room && room;
    return found;
}

/* Whether the reactions that the island had balance the loads, or others do, by the law. */
static bool rests(imp_held *held, const imp_world *world, const imp_state *states, const imp_load *loads, int island,
                  workspace *work)
{
    begin_rates(world, states, loads, work->rates);
    const double load = greatest(held, world, island, work->rates);
    for (int c = 0; c < held->count; c++)
        if (held->island[c] == island) held->contacts[c].force = last_reaction(world, &held->contacts[c]);
    const double balanced = IMP_STILL_BALANCED * load;
    return left_by(held, world, states, loads, island, work->rates) <= balanced ||
           (find_reactions(held, world, states, loads, island, load, work) &&
            left_by(held, world, states, loads, island, work->rates) <= balanced);
}

/* ---- islands ---- */

/* Whether the island's bodies are all slow, and its reactions not unique. */
static bool can_be_still(const imp_held *held, const imp_world *world, const imp_state *states, int island,
                         double rest_speed, const bool *locked)
{
    bool redundant = false;
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (held->island[c] != island) continue;
        if (!pair_is_slow(world, states, &world->pairs[contact->pair], rest_speed) &&
            !(locked[contact->body1] && locked[contact->body2]))
            return false;
        redundant = redundant || contact->redundant;
    }
    return redundant;
}

static void make_still(imp_held *held, imp_world *world, int island)
{
    for (int c = 0; c < held->count; c++) {
        if (held->island[c] != island) continue;
        imp_pair *pair = &world->pairs[held->contacts[c].pair];
        pair->rest.still = true;
        pair->rest.reaction = held->contacts[c].force;
    }
}

/* Which bodies, slower than jam_speed, would not move any more if their contacts stuck. */
static void find_locked(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads,
                        double rest_speed, double jam_speed, bool *locked)
{
    imp_held_find_stop(held, world, states, loads);
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        locked[i] = body->is_static;
        if (body->is_static || !is_slow(world, states, i, jam_speed)) continue;
        const imp_effect *effect = &held->effects[i];
        const qvec3 v = qvec3_add(states[i].v, effect->linear),
                    omega = qvec3_add(imp_omega(body, &states[i]), effect->angular);
        locked[i] = qvec3_norm(v) + body->radius * qvec3_norm(omega) <= rest_speed;
    }
}

/* Solves for the reactions as if everything slow stuck, and finds the islands; which of them are still. */
static void find(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads, double rest_speed,
                 double jam_speed, workspace *work)
{
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        work->before[p] = *pair;
        if (!imp_is_held(pair) || pair->law.friction == 0) continue;
        if (!pair_is_slow(world, states, pair, jam_speed)) continue;
        pair->mode = IMP_STICK;
        imp_end_incipient(pair);
    }
    find_locked(held, world, states, loads, rest_speed, jam_speed, work->locked);
    imp_held_solve(held, world, states, loads);
    for (int c = 0; c < held->count; c++)
        if (held->island[c] == c && can_be_still(held, world, states, c, rest_speed, work->locked) &&
            rests(held, world, states, loads, c, work))
            make_still(held, world, c);
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        if (pair->rest.still || !imp_is_held(pair)) continue;
        pair->mode = work->before[p].mode;
        pair->slip.stage = work->before[p].slip.stage;
    }
}

void imp_held_wake(imp_world *world)
{
    for (int p = 0; p < world->pair_count; p++) world->pairs[p].rest.still = false;
}

impact_status imp_held_find_still(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads,
                                  double rest_speed, double jam_speed)
{
    bool any = false;
    imp_held_wake(world);
    for (int p = 0; p < world->pair_count; p++)
        any = any || (imp_is_held(&world->pairs[p]) && pair_is_slow(world, states, &world->pairs[p], jam_speed));
    if (!any || world->field_count > 0) return IMPACT_OK;
    imp_arena *arena = world->arena;
    workspace work = {.rates = imp_arena_take(arena, (size_t)world->body_count, sizeof *work.rates),
                      .before = imp_arena_take(arena, (size_t)world->pair_count, sizeof *work.before),
                      .locked = imp_arena_take(arena, (size_t)world->body_count, sizeof *work.locked)};
    work.room = work.rates && work.before && work.locked;
    if (work.room) find(held, world, states, loads, rest_speed, jam_speed, &work);
    imp_arena_give(arena, work.rates);
    imp_arena_give(arena, work.before);
    imp_arena_give(arena, work.locked);
    return work.room ? IMPACT_OK : IMPACT_ENOMEM;
}
