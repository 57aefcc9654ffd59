/* SPDX-License-Identifier: MIT
 *
 * Rest needs reactions that balance the loads, not that they be unique. They are looked for by Gauss's sweeps over the
 * contacts, each solved against the others as they are, as together does with impulses: f_n >= 0, a_n >= 0, f_n
 * a_n = 0, |f_t| <= mu f_n and f_t against a_t (Moreau 1988). The sweeps begin without reactions, so that contacts are
 * pressed by the loads alone: of a ball that just fits between two walls friction gives way, though walls that squeezed
 * it could hold it.
 */
#include "contact/held_still.h"
#include "contact/held_system.h"
#include "world/world_gap.h"

#include <stdlib.h>

/* What the loads and the reactions so far do to each body. */
typedef struct body_rate {
    qvec3 linear, angular; /* m/s^2, 1/s^2 */
} body_rate;

/* Of a contact to its own force, 1/kg. */
typedef struct contact_response {
    double along, across;
} contact_response;

typedef struct workspace {
    body_rate *rates;            /* per body */
    contact_response *responses; /* per contact */
    imp_pair *before;            /* the pairs as they were */
    bool *locked;                /* per body: what sticks at its contacts leaves it no motion */
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

/* ---- sweeps ---- */

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

/* Response of a contact to its own force: along the normal, and no less than the most across it. */
static contact_response response_of(const imp_world *world, const imp_state *states, const imp_held_contact *contact)
{
    const qvec3 t = imp_tangent(contact->normal), axes[3] = {contact->normal, t, qvec3_cross(contact->normal, t)};
    const bool round = world->bodies[contact->body1].spherical && world->bodies[contact->body2].spherical;
    double own[3];
    for (int i = 0; i < 3; i++)
        own[i] = qvec3_dot(axes[i], imp_system_response(world, states, contact, contact, axes[i]));
    return (contact_response){own[0], round ? fmax(own[1], own[2]) * (1 + IMP_STILL_ROUND) : own[1] + own[2]};
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

/* Gives the contact the pressure under which its bodies do not approach, then the friction that does most against their
 * slip. Returns by how much accelerations changed. */
static double improve_reaction(const imp_world *world, const imp_state *states, imp_held_contact *contact,
                               contact_response response, body_rate *rates)
{
    const qvec3 n = contact->normal;
    const double pressure = fmax(0, contact->pressure - qvec3_dot(n, acceleration(contact, rates)) / response.along);
    const double pushed = pressure - contact->pressure;
    push(world, states, contact, qvec3_scale(n, pushed), rates);
    const qvec3 rubs = qvec3_axpy(-contact->pressure, n, contact->force), slip = acceleration(contact, rates);
    qvec3 wanted = qvec3_axpy(-1 / response.across, qvec3_axpy(-qvec3_dot(n, slip), n, slip), rubs);
    const double size = qvec3_norm(wanted), most = contact->friction * pressure;
    if (size > most) wanted = qvec3_scale(wanted, most / size);
    push(world, states, contact, qvec3_sub(wanted, rubs), rates);
    contact->pressure = pressure;
    contact->force = qvec3_axpy(pressure, n, wanted);
    return fabs(pushed) * response.along + qvec3_norm(qvec3_sub(wanted, rubs)) * response.across;
}

/* The reaction that the contact's pair remembers, if that still is one. */
static qvec3 last_reaction(const imp_world *world, const imp_held_contact *contact)
{
    const qvec3 f = world->pairs[contact->pair].rest.reaction;
    const double pressure = qvec3_dot(contact->normal, f), rubs = qvec3_norm(qvec3_axpy(-pressure, contact->normal, f));
    return pressure >= 0 && rubs <= contact->friction * pressure + IMP_STILL_SETTLED * pressure ? f : (qvec3){0, 0, 0};
}

/* Gives the island's contacts reactions to begin with, those they had or none; returns the acceleration that they
 * leave.
 */
static double begin_reactions(imp_held *held, const imp_world *world, const imp_state *states, int island, bool anew,
                              workspace *work)
{
    for (int c = 0; c < held->count; c++) {
        imp_held_contact *contact = &held->contacts[c];
        if (held->island[c] != island) continue;
        const qvec3 before = anew ? contact->force : (qvec3){0, 0, 0};
        contact->force = anew ? (qvec3){0, 0, 0} : last_reaction(world, contact);
        contact->pressure = qvec3_dot(contact->normal, contact->force);
        work->responses[c] = response_of(world, states, contact);
        push(world, states, contact, qvec3_sub(contact->force, before), work->rates);
    }
    return greatest(held, world, island, work->rates);
}

typedef enum answer {
    UNKNOWN,  /* the sweeps did not settle */
    BALANCED, /* the bodies have no acceleration */
    MOVES     /* the sweeps settled on some */
} answer;

/* Looks for the reactions of the island's contacts: those that they had, if they balance the loads, or else from none
 * at all. */
static answer sweep_reactions(imp_held *held, const imp_world *world, const imp_state *states, int island,
                              workspace *work, double load)
{
    enum { SWEEPS = 20000, CHECK = 50 };
    const double balanced = IMP_STILL_BALANCED * load, settled = IMP_STILL_SETTLED * load;
    if (begin_reactions(held, world, states, island, false, work) <= balanced) return BALANCED;
    begin_reactions(held, world, states, island, true, work);
    double before = INFINITY;
    for (int k = 1; k <= SWEEPS; k++) {
        double change = 0;
        for (int c = 0; c < held->count; c++)
            if (held->island[c] == island)
                change =
                    fmax(change, improve_reaction(world, states, &held->contacts[c], work->responses[c], work->rates));
        if (change <= settled) return greatest(held, world, island, work->rates) <= balanced ? BALANCED : MOVES;
        if (k % CHECK != 0) continue;
        if (change > IMP_STILL_PROGRESS * before) return UNKNOWN;
        before = change;
    }
    return UNKNOWN;
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

/* Of an island that moves: what nothing presses, and parts, is open. */
static void open_parting(imp_held *held, imp_world *world, int island, const workspace *work, double load)
{
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (held->island[c] == island && contact->pressure == 0 &&
            qvec3_dot(contact->normal, acceleration(contact, work->rates)) > IMP_PRESSED_OF_LOADS * load)
            world->pairs[contact->pair].mode = IMP_OPEN;
    }
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

static void settle(imp_held *held, imp_world *world, const imp_state *states, int island, workspace *work)
{
    const double load = greatest(held, world, island, work->rates);
    const answer found = sweep_reactions(held, world, states, island, work, load);
    if (found == BALANCED) make_still(held, world, island);
    if (found == MOVES) open_parting(held, world, island, work, load);
}

/* Which bodies, slower than jam_speed, would not move any more if their contacts stuck. */
static void find_locked(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads,
                        double rest_speed, double jam_speed, bool *locked)
{
    imp_held_find_contacts(held, world, states, loads);
    for (int c = 0; c < held->count; c++) {
        imp_held_contact *contact = &held->contacts[c];
        contact->wanted =
            qvec3_neg(qvec3_axpy(imp_held_approach(world, contact, states), contact->normal, contact->slip));
    }
    imp_system_solve(held, world, states, false);
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
    begin_rates(world, states, loads, work->rates);
    for (int c = 0; c < held->count; c++)
        if (held->island[c] == c && can_be_still(held, world, states, c, rest_speed, work->locked))
            settle(held, world, states, c, work);
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
                      .responses = imp_arena_take(arena, (size_t)held->count, sizeof *work.responses),
                      .before = imp_arena_take(arena, (size_t)world->pair_count, sizeof *work.before),
                      .locked = imp_arena_take(arena, (size_t)world->body_count, sizeof *work.locked)};
    const bool room = work.rates && work.responses && work.before && work.locked;
    if (room) find(held, world, states, loads, rest_speed, jam_speed, &work);
    imp_arena_give(arena, work.rates);
    imp_arena_give(arena, work.responses);
    imp_arena_give(arena, work.before);
    imp_arena_give(arena, work.locked);
    return room ? IMPACT_OK : IMPACT_ENOMEM;
}
