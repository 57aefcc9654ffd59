/* SPDX-License-Identifier: MIT
 *
 * The linear system of the held contacts: one unknown for a sliding contact, two where its direction is solved for too,
 * three for a rolling one. Contacts that share no moving body, however remotely, are solved apart.
 */
#include "contact/held_system.h"
#include "contact/cone_assemble.h"
#include "contact/held_linear.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* One unknown force and the equation beside it. What acts on body 2 is subtracted from what acts on body 1. */
typedef struct imp_unknown {
    int contact, body[2];  /* -1: static */
    qvec3 row, row_arm[2]; /* the equation fixes row . (linear) + row_arm . (angular) */
    qvec3 force;           /* on body 1, for 1 N; what it does: */
    qvec3 linear[2], spin[2];
    double scale;    /* root of what a unit force does at its contact, in the mean of its rows, 1/sqrt(kg) */
    double mobility; /* the equation is less this times the force */
    double value;    /* N */
} imp_unknown;

/* ---- room ---- */

/* Room for `count`, with the first `kept` of what stood there. */
static void *grown(imp_arena *arena, void *old, size_t kept, size_t count, size_t size, bool *there)
{
    void *room = imp_arena_take(arena, count, size);
    *there = *there && room;
    if (!room) return old;
    if (kept > 0) memcpy(room, old, kept * size);
    imp_arena_give(arena, old);
    return room;
}

impact_status imp_held_make_room(imp_held *held, int contacts_needed, int bodies_needed)
{
    const size_t contacts = (size_t)contacts_needed, n = 3 * contacts, bodies = (size_t)bodies_needed;
    bool there = true;
    if (contacts_needed > held->capacity) {
        held->contacts =
            grown(held->arena, held->contacts, (size_t)held->capacity, contacts, sizeof *held->contacts, &there);
        held->island = grown(held->arena, held->island, 0, contacts, sizeof *held->island, &there);
        held->unknowns = grown(held->arena, held->unknowns, 0, n, sizeof *held->unknowns, &there);
        held->matrix = grown(held->arena, held->matrix, 0, 2 * n * n, sizeof *held->matrix, &there);
        held->right = grown(held->arena, held->right, 0, 2 * n, sizeof *held->right, &there);
        held->order = grown(held->arena, held->order, 0, 2 * n, sizeof *held->order, &there);
        if (there) held->capacity = contacts_needed;
    }
    if (bodies_needed > held->bodies) {
        held->first = grown(held->arena, held->first, 0, bodies, sizeof *held->first, &there);
        held->effects = grown(held->arena, held->effects, 0, bodies, sizeof *held->effects, &there);
        if (there) held->bodies = bodies_needed;
    }
    return there ? IMPACT_OK : IMPACT_ENOMEM;
}

void imp_held_free(imp_held *held)
{
    imp_arena_give(held->arena, held->contacts);
    imp_arena_give(held->arena, held->island);
    imp_arena_give(held->arena, held->unknowns);
    imp_arena_give(held->arena, held->matrix);
    imp_arena_give(held->arena, held->right);
    imp_arena_give(held->arena, held->order);
    imp_arena_give(held->arena, held->first);
    imp_arena_give(held->arena, held->effects);
    *held = (imp_held){.arena = held->arena};
}

/* ---- responses ---- */

qvec3 imp_tangent(qvec3 n)
{
    const qvec3 t = fabs(n.x) < 0.6 ? (qvec3){0, n.z, -n.y} : (qvec3){-n.z, 0, n.x};
    return qvec3_scale(t, 1 / qvec3_norm(t));
}

qvec3 imp_system_response(const imp_world *world, const imp_state *states, const imp_held_contact *a,
                          const imp_held_contact *b, qvec3 f)
{
    const int bodies[2] = {b->body1, b->body2};
    const qvec3 arms[2] = {b->r1, b->r2};
    qvec3 change = {0, 0, 0};
    for (int k = 0; k < 2; k++) {
        const imp_body *body = &world->bodies[bodies[k]];
        if (body->is_static) continue;
        const qvec3 force = k == 0 ? f : qvec3_neg(f);
        const qvec3 da = qvec3_scale(force, body->inverse_mass);
        const qvec3 dalpha = imp_inverse_inertia(body, states[bodies[k]].q, qvec3_cross(arms[k], force));
        if (bodies[k] == a->body1) change = qvec3_add(change, qvec3_add(da, qvec3_cross(dalpha, a->r1)));
        if (bodies[k] == a->body2) change = qvec3_sub(change, qvec3_add(da, qvec3_cross(dalpha, a->r2)));
    }
    return change;
}

static void clear_effects(imp_held *held, const imp_world *world)
{
    for (int i = 0; i < world->body_count; i++) held->effects[i] = (imp_effect){{0, 0, 0}, {0, 0, 0}};
}

qvec3 imp_system_change(const imp_held *held, const imp_held_contact *contact)
{
    const imp_effect *one = &held->effects[contact->body1], *two = &held->effects[contact->body2];
    return qvec3_sub(qvec3_add(one->linear, qvec3_cross(one->angular, contact->r1)),
                     qvec3_add(two->linear, qvec3_cross(two->angular, contact->r2)));
}

/* ---- islands ---- */

static int island_of(const imp_held *held, int contact)
{
    while (held->island[contact] != contact) contact = held->island[contact];
    return contact;
}

/* Gives the contacts that share bodies, directly or through others, the same number: the first of them. */
static void find_islands(imp_held *held, const imp_world *world)
{
    for (int c = 0; c < held->count; c++)
        held->first[held->contacts[c].body1] = held->first[held->contacts[c].body2] = -1;
    for (int c = 0; c < held->count; c++) {
        const int bodies[2] = {held->contacts[c].body1, held->contacts[c].body2};
        held->island[c] = c;
        for (int k = 0; k < 2; k++) {
            if (world->bodies[bodies[k]].is_static) continue;
            int *first = &held->first[bodies[k]];
            if (*first < 0) *first = c;
            const int a = island_of(held, *first), b = island_of(held, c);
            held->island[a < b ? b : a] = a < b ? a : b;
        }
    }
    for (int c = 0; c < held->count; c++) held->island[c] = held->island[held->island[c]];
}

/* ---- unknowns ---- */

static int unknowns_of(const imp_held_contact *contact, bool with_friction)
{
    return contact->mode == IMP_STICK ? 3 : with_friction && contact->turning ? 2 : 1;
}

/* Row i of a contact: which component of u' it fixes. */
static qvec3 row_direction(const imp_held_contact *contact, int i, bool with_friction)
{
    if (i == 0) return contact->normal;
    if (contact->mode == IMP_SLIDE && with_friction) return qvec3_cross(contact->normal, contact->direction);
    const qvec3 t = imp_tangent(contact->normal);
    return i == 1 ? t : qvec3_cross(contact->normal, t);
}

/* Which force an unknown stands for; with friction, a sliding contact's pressure brings its friction along. */
static qvec3 force_direction(const imp_held_contact *contact, int i, bool with_friction)
{
    if (contact->mode == IMP_SLIDE && with_friction && i == 0)
        return qvec3_axpy(-contact->friction, contact->direction, contact->normal);
    const qvec3 row = row_direction(contact, i, with_friction);
    return contact->mode == IMP_SLIDE && i == 1 ? qvec3_neg(row) : row;
}

/* What the row sees of a force along itself. */
static double row_response(const imp_world *world, const imp_state *states, const imp_unknown *u)
{
    double response = 0;
    for (int k = 0; k < 2; k++) {
        if (u->body[k] < 0) continue;
        const imp_body *body = &world->bodies[u->body[k]];
        response += body->inverse_mass * qvec3_dot(u->row, u->row) +
                    qvec3_dot(u->row_arm[k], imp_inverse_inertia(body, states[u->body[k]].q, u->row_arm[k]));
    }
    return response;
}

static void fill_unknown(const imp_world *world, const imp_state *states, const imp_held_contact *contact, int i,
                         bool with_friction, imp_unknown *u)
{
    const int bodies[2] = {contact->body1, contact->body2};
    const qvec3 arms[2] = {contact->r1, contact->r2};
    u->mobility = u->value = 0;
    u->row = row_direction(contact, i, with_friction);
    u->force = force_direction(contact, i, with_friction);
    for (int k = 0; k < 2; k++) {
        const imp_body *body = &world->bodies[bodies[k]];
        u->body[k] = body->is_static ? -1 : bodies[k];
        if (body->is_static) continue;
        u->row_arm[k] = qvec3_cross(arms[k], u->row);
        u->linear[k] = qvec3_scale(u->force, body->inverse_mass);
        u->spin[k] = imp_inverse_inertia(body, states[bodies[k]].q, qvec3_cross(arms[k], u->force));
    }
}

/* The island's unknowns; how many. */
static int list_unknowns(imp_held *held, const imp_world *world, const imp_state *states, int island,
                         bool with_friction)
{
    int n = 0;
    for (int c = island; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (held->island[c] != island) continue;
        const int count = unknowns_of(contact, with_friction);
        double response = 0;
        for (int i = 0; i < count; i++) {
            fill_unknown(world, states, contact, i, with_friction, &held->unknowns[n + i]);
            response += row_response(world, states, &held->unknowns[n + i]);
        }
        for (int i = 0; i < count; i++) {
            held->unknowns[n + i].contact = c;
            held->unknowns[n + i].scale = sqrt(response / count);
        }
        if (contact->mode == IMP_SLIDE && count == 2) held->unknowns[n + 1].mobility = contact->mobility;
        n += count;
    }
    return n;
}

/* What equation a sees of unknown b. */
static double response_to(const imp_unknown *a, const imp_unknown *b)
{
    double seen = 0;
    for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) {
            if (a->body[k] < 0 || a->body[k] != b->body[l]) continue;
            const double part = qvec3_dot(a->row, b->linear[l]) + qvec3_dot(a->row_arm[k], b->spin[l]);
            seen += k == l ? part : -part;
        }
    return seen;
}

static void build_matrix(const imp_unknown *u, int n, double *matrix)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) matrix[i * n + j] = response_to(&u[i], &u[j]) / (u[i].scale * u[j].scale);
        matrix[i * n + i] -= u[i].mobility / (u[i].scale * u[i].scale);
    }
}

/* ---- solutions ---- */

/* What the equation asks for beyond what the forces so far do. */
static double residual(const imp_held *held, const imp_unknown *u)
{
    double left = qvec3_dot(u->row, held->contacts[u->contact].wanted) + u->mobility * u->value;
    for (int k = 0; k < 2; k++) {
        if (u->body[k] < 0) continue;
        const imp_effect *effect = &held->effects[u->body[k]];
        const double seen = qvec3_dot(u->row, effect->linear) + qvec3_dot(u->row_arm[k], effect->angular);
        left -= k == 0 ? seen : -seen;
    }
    return left;
}

static void add_force(imp_held *held, imp_unknown *u, double more)
{
    u->value += more;
    for (int k = 0; k < 2; k++) {
        if (u->body[k] < 0) continue;
        imp_effect *effect = &held->effects[u->body[k]];
        const double own = k == 0 ? more : -more;
        effect->linear = qvec3_axpy(own, u->linear[k], effect->linear);
        effect->angular = qvec3_axpy(own, u->spin[k], effect->angular);
    }
}

/* The largest of what all equations ask for beyond what the forces so far do, which x is set to. */
static double residuals(const imp_held *held, int n, double *x)
{
    const imp_unknown *u = held->unknowns;
    double left = 0;
    for (int i = 0; i < n; i++) {
        x[i] = residual(held, &u[i]) / u[i].scale;
        left = fmax(left, fabs(x[i]));
    }
    return left;
}

static double asked_for(const imp_held *held, int n)
{
    const imp_unknown *u = held->unknowns;
    double asked = 0;
    for (int i = 0; i < n; i++)
        asked = fmax(asked, fabs(qvec3_dot(u[i].row, held->contacts[u[i].contact].wanted)) / u[i].scale);
    return asked;
}

/* The forces; and then what their rounding has left, so often that what they do is right to rounding: of the motion,
 * not of the forces, which can be far greater than what they leave of one another. Whether they do what is asked. */
static bool find_forces(imp_held *held, const imp_linear *system)
{
    enum { MOST = 6 };
    imp_unknown *u = held->unknowns;
    double *x = held->right, before = INFINITY, left = residuals(held, system->n, x);
    const double first = left;
    for (int pass = 0; pass < MOST && left > DBL_EPSILON * first && left < 0.5 * before; pass++) {
        before = left;
        imp_linear_solve(system, x);
        for (int i = 0; i < system->n; i++) add_force(held, &u[i], x[i] / u[i].scale);
        left = residuals(held, system->n, x);
    }
    return left <= IMP_UNMET * asked_for(held, system->n);
}

/* Where forces are not unique those nearest to what the contacts have. */
static void begin_forces(imp_held *held, int n)
{
    imp_unknown *u = held->unknowns;
    for (int i = 0; i < n; i++) {
        const imp_held_contact *contact = &held->contacts[u[i].contact];
        const bool own = contact->mode == IMP_STICK || i == 0 || u[i].contact != u[i - 1].contact;
        if (own) add_force(held, &u[i], qvec3_dot(contact->force, u[i].row));
    }
}

static void take_forces(imp_held *held, int island, bool with_friction, bool unique, bool met)
{
    const imp_unknown *u = held->unknowns;
    for (int c = island; c < held->count; c++) {
        imp_held_contact *contact = &held->contacts[c];
        if (held->island[c] != island) continue;
        const int count = unknowns_of(contact, with_friction);
        contact->redundant = !unique;
        contact->unmet = !met;
        contact->pressure = u->value;
        const bool turns = contact->mode == IMP_SLIDE && count == 2;
        contact->turn = turns ? u[1].value / (contact->friction * contact->pressure) : 0;
        contact->force = (qvec3){0, 0, 0};
        for (int i = 0; i < count; i++, u++) contact->force = qvec3_axpy(u->value, u->force, contact->force);
    }
}

static imp_linear factor_island(imp_held *held, const imp_world *world, const imp_state *states, bool with_friction,
                                int island, bool yields)
{
    const int n = list_unknowns(held, world, states, island, with_friction);
    imp_linear system = {.n = n,
                         .doubtful = IMP_LINEAR_DOUBTFUL,
                         .matrix = held->matrix,
                         .spare = held->matrix + n * n,
                         .scratch = held->right + n,
                         .rows = held->order,
                         .columns = held->order + n};
    build_matrix(held->unknowns, n, system.matrix);
    if (yields) imp_cone_let_yield(system.matrix, n);
    imp_linear_factor(&system);
    return system;
}

static bool island_slides(const imp_held *held, int island)
{
    for (int c = island; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (held->island[c] == island && contact->mode == IMP_SLIDE && contact->friction > 0) return true;
    }
    return false;
}

static void solve_island(imp_held *held, const imp_world *world, const imp_state *states, bool with_friction,
                         int island)
{
    imp_linear system = factor_island(held, world, states, with_friction, island, false);
    const bool unique = system.rank == system.n;
    if (with_friction && !unique) {
        if (island_slides(held, island)) system = factor_island(held, world, states, true, island, true);
        begin_forces(held, system.n);
    }
    const bool met = find_forces(held, &system);
    take_forces(held, island, with_friction, unique, met);
}

int imp_system_count_idle(imp_held *held, const imp_world *world, const imp_state *states, int island)
{
    const imp_linear system = factor_island(held, world, states, true, island, false);
    return system.n - system.rank;
}

void imp_system_idle(const imp_held *held, int island, int k, qvec3 *force)
{
    int n = 0;
    for (int c = island; c < held->count; c++) {
        force[c] = (qvec3){0, 0, 0};
        n += held->island[c] == island ? unknowns_of(&held->contacts[c], true) : 0;
    }
    const double *own = held->matrix + n * n + k * n;
    for (int i = 0; i < n; i++) {
        const imp_unknown *u = &held->unknowns[held->order[n + i]];
        force[u->contact] = qvec3_axpy(own[i] / u->scale, u->force, force[u->contact]);
    }
}

/* What is still keeps its reaction, and needs no impulse. */
static void recall(imp_held_contact *contact, const imp_world *world, bool with_friction)
{
    contact->force = with_friction ? world->pairs[contact->pair].rest.reaction : (qvec3){0, 0, 0};
    contact->pressure = qvec3_dot(contact->normal, contact->force);
}

void imp_system_solve(imp_held *held, const imp_world *world, const imp_state *states, bool with_friction)
{
    find_islands(held, world);
    clear_effects(held, world);
    for (int c = 0; c < held->count; c++)
        if (held->island[c] == c && !held->contacts[c].still) solve_island(held, world, states, with_friction, c);
    for (int c = 0; c < held->count; c++)
        if (held->contacts[c].still) recall(&held->contacts[c], world, with_friction);
}

void imp_system_apply(const imp_held *held, const imp_world *world, imp_state *states)
{
    for (int i = 0; i < world->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        const imp_effect *effect = &held->effects[i];
        states[i].v = qvec3_add(states[i].v, effect->linear);
        states[i].momentum =
            qvec3_add(states[i].momentum, imp_inertia(&world->bodies[i], states[i].q, effect->angular));
    }
}
