/* SPDX-License-Identifier: MIT
 *
 * The linear system of the held contacts: one unknown for a sliding contact, two where its direction is solved for too,
 * three for a rolling one. Contacts that share no moving body, however remotely, are solved apart.
 */
#include "contact/persist_system.h"
#include "contact/persist_linear.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* One unknown force and the equation beside it. What acts on body 2 is subtracted from what acts on body 1. */
typedef struct imp_unknown {
    int touch, body[2];    /* -1: static */
    qvec3 row, row_arm[2]; /* the equation fixes row . (linear) + row_arm . (angular) */
    qvec3 force;           /* on body 1, for 1 N; what it does: */
    qvec3 linear[2], spin[2];
    double scale; /* root of what a unit force does at its contact, in the mean of its rows, 1/sqrt(kg) */
    double pull;  /* the equation is less pull times the force */
    double value; /* N */
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

impact_status imp_persist_make_room(imp_persist *persist, int touches_needed, int bodies_needed)
{
    const size_t touches = (size_t)touches_needed, n = 3 * touches, bodies = (size_t)bodies_needed;
    bool there = true;
    if (touches_needed > persist->capacity) {
        persist->touches = grown(persist->arena, persist->touches, (size_t)persist->capacity, touches,
                                 sizeof *persist->touches, &there);
        persist->island = grown(persist->arena, persist->island, 0, touches, sizeof *persist->island, &there);
        persist->unknowns = grown(persist->arena, persist->unknowns, 0, n, sizeof *persist->unknowns, &there);
        persist->matrix = grown(persist->arena, persist->matrix, 0, 2 * n * n, sizeof *persist->matrix, &there);
        persist->right = grown(persist->arena, persist->right, 0, 2 * n, sizeof *persist->right, &there);
        persist->order = grown(persist->arena, persist->order, 0, 2 * n, sizeof *persist->order, &there);
        if (there) persist->capacity = touches_needed;
    }
    if (bodies_needed > persist->bodies) {
        persist->first = grown(persist->arena, persist->first, 0, bodies, sizeof *persist->first, &there);
        persist->effects = grown(persist->arena, persist->effects, 0, bodies, sizeof *persist->effects, &there);
        if (there) persist->bodies = bodies_needed;
    }
    return there ? IMPACT_OK : IMPACT_ENOMEM;
}

void imp_persist_free(imp_persist *persist)
{
    imp_arena_give(persist->arena, persist->touches);
    imp_arena_give(persist->arena, persist->island);
    imp_arena_give(persist->arena, persist->unknowns);
    imp_arena_give(persist->arena, persist->matrix);
    imp_arena_give(persist->arena, persist->right);
    imp_arena_give(persist->arena, persist->order);
    imp_arena_give(persist->arena, persist->first);
    imp_arena_give(persist->arena, persist->effects);
    *persist = (imp_persist){.arena = persist->arena};
}

/* ---- responses ---- */

qvec3 imp_tangent(qvec3 n)
{
    const qvec3 t = fabs(n.x) < 0.6 ? (qvec3){0, n.z, -n.y} : (qvec3){-n.z, 0, n.x};
    return qvec3_scale(t, 1 / qvec3_norm(t));
}

qvec3 imp_system_response(const imp_world *world, const imp_state *states, const imp_touch *a, const imp_touch *b,
                          qvec3 f)
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

static void clear_effects(imp_persist *persist, const imp_world *world)
{
    for (int i = 0; i < world->body_count; i++) persist->effects[i] = (imp_effect){{0, 0, 0}, {0, 0, 0}};
}

qvec3 imp_system_change(const imp_persist *persist, const imp_touch *touch)
{
    const imp_effect *one = &persist->effects[touch->body1], *two = &persist->effects[touch->body2];
    return qvec3_sub(qvec3_add(one->linear, qvec3_cross(one->angular, touch->r1)),
                     qvec3_add(two->linear, qvec3_cross(two->angular, touch->r2)));
}

/* ---- islands ---- */

static int island_of(const imp_persist *persist, int touch)
{
    while (persist->island[touch] != touch) touch = persist->island[touch];
    return touch;
}

/* Gives the touches that share bodies, directly or through others, the same number: the first of them. */
static void find_islands(imp_persist *persist, const imp_world *world)
{
    for (int c = 0; c < persist->count; c++)
        persist->first[persist->touches[c].body1] = persist->first[persist->touches[c].body2] = -1;
    for (int c = 0; c < persist->count; c++) {
        const int bodies[2] = {persist->touches[c].body1, persist->touches[c].body2};
        persist->island[c] = c;
        for (int k = 0; k < 2; k++) {
            if (world->bodies[bodies[k]].is_static) continue;
            int *first = &persist->first[bodies[k]];
            if (*first < 0) *first = c;
            const int a = island_of(persist, *first), b = island_of(persist, c);
            persist->island[a < b ? b : a] = a < b ? a : b;
        }
    }
    for (int c = 0; c < persist->count; c++) persist->island[c] = persist->island[persist->island[c]];
}

/* ---- unknowns ---- */

static int unknowns_of(const imp_touch *touch, bool with_friction)
{
    return touch->mode == IMP_ROLL ? 3 : with_friction && touch->turning ? 2 : 1;
}

/* Row i of a touch: which component of u' it fixes. */
static qvec3 row_direction(const imp_touch *touch, int i, bool with_friction)
{
    if (i == 0) return touch->normal;
    if (touch->mode == IMP_SLIDE && with_friction) return qvec3_cross(touch->normal, touch->direction);
    const qvec3 t = imp_tangent(touch->normal);
    return i == 1 ? t : qvec3_cross(touch->normal, t);
}

/* Which force an unknown stands for; with friction, a sliding contact's pressure brings its friction along. */
static qvec3 force_direction(const imp_touch *touch, int i, bool with_friction)
{
    if (touch->mode == IMP_SLIDE && with_friction && i == 0)
        return qvec3_axpy(-touch->friction, touch->direction, touch->normal);
    const qvec3 row = row_direction(touch, i, with_friction);
    return touch->mode == IMP_SLIDE && i == 1 ? qvec3_neg(row) : row;
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

static void fill_unknown(const imp_world *world, const imp_state *states, const imp_touch *touch, int i,
                         bool with_friction, imp_unknown *u)
{
    const int bodies[2] = {touch->body1, touch->body2};
    const qvec3 arms[2] = {touch->r1, touch->r2};
    u->pull = u->value = 0;
    u->row = row_direction(touch, i, with_friction);
    u->force = force_direction(touch, i, with_friction);
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
static int list_unknowns(imp_persist *persist, const imp_world *world, const imp_state *states, int island,
                         bool with_friction)
{
    int n = 0;
    for (int c = island; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        if (persist->island[c] != island) continue;
        const int count = unknowns_of(touch, with_friction);
        double response = 0;
        for (int i = 0; i < count; i++) {
            fill_unknown(world, states, touch, i, with_friction, &persist->unknowns[n + i]);
            response += row_response(world, states, &persist->unknowns[n + i]);
        }
        for (int i = 0; i < count; i++) {
            persist->unknowns[n + i].touch = c;
            persist->unknowns[n + i].scale = sqrt(response / count);
        }
        if (touch->mode == IMP_SLIDE && count == 2) persist->unknowns[n + 1].pull = touch->pull;
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
        matrix[i * n + i] -= u[i].pull / (u[i].scale * u[i].scale);
    }
}

/* ---- solutions ---- */

/* What the equation asks for beyond what the forces so far do. */
static double residual(const imp_persist *persist, const imp_unknown *u)
{
    double left = qvec3_dot(u->row, persist->touches[u->touch].wanted) + u->pull * u->value;
    for (int k = 0; k < 2; k++) {
        if (u->body[k] < 0) continue;
        const imp_effect *effect = &persist->effects[u->body[k]];
        const double seen = qvec3_dot(u->row, effect->linear) + qvec3_dot(u->row_arm[k], effect->angular);
        left -= k == 0 ? seen : -seen;
    }
    return left;
}

static void add_force(imp_persist *persist, imp_unknown *u, double more)
{
    u->value += more;
    for (int k = 0; k < 2; k++) {
        if (u->body[k] < 0) continue;
        imp_effect *effect = &persist->effects[u->body[k]];
        const double own = k == 0 ? more : -more;
        effect->linear = qvec3_axpy(own, u->linear[k], effect->linear);
        effect->angular = qvec3_axpy(own, u->spin[k], effect->angular);
    }
}

/* The forces; and then what their rounding has left, so often that what they do is right to rounding: of the motion,
 * not of the forces, which can be far greater than what they leave of one another. */
static void find_forces(imp_persist *persist, const imp_linear *system)
{
    enum { MOST = 6 };
    imp_unknown *u = persist->unknowns;
    double *x = persist->right, first = 0, before = INFINITY;
    for (int pass = 0; pass < MOST; pass++) {
        double left = 0;
        for (int i = 0; i < system->n; i++) {
            x[i] = residual(persist, &u[i]) / u[i].scale;
            left = fmax(left, fabs(x[i]));
        }
        if (pass == 0) first = left;
        if (left <= DBL_EPSILON * first || !(left < 0.5 * before)) return;
        before = left;
        imp_linear_solve(system, x);
        for (int i = 0; i < system->n; i++) add_force(persist, &u[i], x[i] / u[i].scale);
    }
}

/* Where forces are not unique those nearest to what the touches have. */
static void begin_forces(imp_persist *persist, int n)
{
    imp_unknown *u = persist->unknowns;
    for (int i = 0; i < n; i++) {
        const imp_touch *touch = &persist->touches[u[i].touch];
        const bool own = touch->mode == IMP_ROLL || i == 0 || u[i].touch != u[i - 1].touch;
        if (own) add_force(persist, &u[i], qvec3_dot(touch->force, u[i].row));
    }
}

static void take_forces(imp_persist *persist, int island, bool with_friction, bool unique)
{
    const imp_unknown *u = persist->unknowns;
    for (int c = island; c < persist->count; c++) {
        imp_touch *touch = &persist->touches[c];
        if (persist->island[c] != island) continue;
        const int count = unknowns_of(touch, with_friction);
        touch->redundant = !unique;
        touch->pressure = u->value;
        const bool turns = touch->mode == IMP_SLIDE && count == 2;
        touch->turn = turns ? u[1].value / (touch->friction * touch->pressure) : 0;
        touch->force = (qvec3){0, 0, 0};
        for (int i = 0; i < count; i++, u++) touch->force = qvec3_axpy(u->value, u->force, touch->force);
    }
}

static imp_linear factor_island(imp_persist *persist, const imp_world *world, const imp_state *states,
                                bool with_friction, int island)
{
    const int n = list_unknowns(persist, world, states, island, with_friction);
    imp_linear system = {.n = n,
                         .doubtful = IMP_LINEAR_DOUBTFUL,
                         .matrix = persist->matrix,
                         .spare = persist->matrix + n * n,
                         .scratch = persist->right + n,
                         .rows = persist->order,
                         .columns = persist->order + n};
    build_matrix(persist->unknowns, n, system.matrix);
    imp_linear_factor(&system);
    return system;
}

static void solve_island(imp_persist *persist, const imp_world *world, const imp_state *states, bool with_friction,
                         int island)
{
    const imp_linear system = factor_island(persist, world, states, with_friction, island);
    const bool unique = system.rank == system.n;
    if (with_friction && !unique) begin_forces(persist, system.n);
    find_forces(persist, &system);
    take_forces(persist, island, with_friction, unique);
}

int imp_system_count_idle(imp_persist *persist, const imp_world *world, const imp_state *states, int island)
{
    const imp_linear system = factor_island(persist, world, states, true, island);
    return system.n - system.rank;
}

void imp_system_idle(const imp_persist *persist, int island, int k, qvec3 *force)
{
    int n = 0;
    for (int c = island; c < persist->count; c++) {
        force[c] = (qvec3){0, 0, 0};
        n += persist->island[c] == island ? unknowns_of(&persist->touches[c], true) : 0;
    }
    const double *own = persist->matrix + n * n + k * n;
    for (int i = 0; i < n; i++) {
        const imp_unknown *u = &persist->unknowns[persist->order[n + i]];
        force[u->touch] = qvec3_axpy(own[i] / u->scale, u->force, force[u->touch]);
    }
}

/* What is still keeps its reaction, and needs no impulse. */
static void recall(imp_touch *touch, const imp_world *world, bool with_friction)
{
    touch->force = with_friction ? world->pairs[touch->pair].rest.reaction : (qvec3){0, 0, 0};
    touch->pressure = qvec3_dot(touch->normal, touch->force);
}

void imp_system_solve(imp_persist *persist, const imp_world *world, const imp_state *states, bool with_friction)
{
    find_islands(persist, world);
    clear_effects(persist, world);
    for (int c = 0; c < persist->count; c++)
        if (persist->island[c] == c && !persist->touches[c].still)
            solve_island(persist, world, states, with_friction, c);
    for (int c = 0; c < persist->count; c++)
        if (persist->touches[c].still) recall(&persist->touches[c], world, with_friction);
}

void imp_system_apply(const imp_persist *persist, const imp_world *world, imp_state *states)
{
    for (int i = 0; i < world->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        const imp_effect *effect = &persist->effects[i];
        states[i].v = qvec3_add(states[i].v, effect->linear);
        states[i].momentum =
            qvec3_add(states[i].momentum, imp_inertia(&world->bodies[i], states[i].q, effect->angular));
    }
}
