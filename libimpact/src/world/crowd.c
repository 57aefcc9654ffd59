/* SPDX-License-Identifier: MIT
 *
 * A body that nothing comes near follows its parabola. One that can touch something is given a ball around where it is:
 * as far as its speed can take it, the speed that its group's energy can give it at most (where no surface is driven),
 * or a few times the greatest speed there is in the group. Groups grow by what their balls reach, and their balls with
 * them, until nothing changes. (The second bound on the speed is a guess, which the run checks at every step:
 * scene_crowd.c.)
 */
#include "world/crowd.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

impact_status imp_crowd_open(imp_crowd *crowd, const imp_world *world)
{
    const int n = world->body_count;
    const size_t size = (size_t)n + 1;
    imp_arena *arena = world->arena;
    *crowd = (imp_crowd){.arena = arena,
                         .body_count = n,
                         .bodies = imp_arena_take(arena, size, sizeof *crowd->bodies),
                         .order = imp_arena_take(arena, size, sizeof *crowd->order),
                         .moving_before = imp_arena_take(arena, size, sizeof *crowd->moving_before),
                         .first_pair = imp_arena_take(arena, size, sizeof *crowd->first_pair),
                         .slot = imp_arena_take(arena, size, sizeof *crowd->slot),
                         .member_start = imp_arena_take(arena, size, sizeof *crowd->member_start),
                         .members = imp_arena_take(arena, size, sizeof *crowd->members),
                         .pair_start = imp_arena_take(arena, size, sizeof *crowd->pair_start)};
    if (!crowd->bodies || !crowd->order || !crowd->moving_before || !crowd->first_pair || !crowd->slot ||
        !crowd->member_start || !crowd->members || !crowd->pair_start)
        return IMPACT_ENOMEM;
    for (int i = 0; i < n; i++) {
        crowd->moving_before[i + 1] = crowd->moving_before[i] + !world->bodies[i].is_static;
        if (world->bodies[i].shape.kind != IMPACT_PLANE) crowd->order[crowd->ordered++] = i;
    }
    for (int i = 0, pair = 0; i < n; i++) {
        crowd->first_pair[i] = pair;
        pair += world->bodies[i].is_static ? crowd->moving_before[n] - crowd->moving_before[i + 1] : n - 1 - i;
    }
    return IMPACT_OK;
}

void imp_crowd_close(imp_crowd *crowd)
{
    imp_arena_give(crowd->arena, crowd->bodies);
    imp_arena_give(crowd->arena, crowd->order);
    imp_arena_give(crowd->arena, crowd->moving_before);
    imp_arena_give(crowd->arena, crowd->first_pair);
    imp_arena_give(crowd->arena, crowd->slot);
    imp_arena_give(crowd->arena, crowd->member_start);
    imp_arena_give(crowd->arena, crowd->members);
    imp_arena_give(crowd->arena, crowd->pair_start);
    imp_arena_give(crowd->arena, crowd->pairs);
    *crowd = (imp_crowd){0};
}

int imp_crowd_pair(const imp_crowd *crowd, const imp_world *world, int i, int j)
{
    const int a = i < j ? i : j, b = i < j ? j : i;
    if (!world->bodies[a].is_static) return crowd->first_pair[a] + b - a - 1;
    return crowd->first_pair[a] + crowd->moving_before[b] - crowd->moving_before[a + 1];
}

/* ---- boxes ---- */

static void store(qvec3 v, double out[3]) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

/* More than the rounding of a place. */
static double rounding(const imp_body *body, const imp_state *state)
{
    return 1e-9 * (qvec3_norm(state->x) + body->radius);
}

/* Lowest and highest of a + b t + c t^2/2 over [0, T]. */
static void range(double a, double b, double c, double T, double *low, double *high)
{
    const double end = a + T * (b + 0.5 * T * c), turn = -b / c;
    *low = fmin(a, end), *high = fmax(a, end);
    if (!(turn > 0 && turn < T)) return;
    const double there = a + 0.5 * turn * b;
    *low = fmin(*low, there), *high = fmax(*high, there);
}

static void static_box(const imp_body *body, const imp_state *state, imp_crowd_body *b)
{
    const impact_solid solid = imp_solid_of(body, state);
    double x[3];
    store(solid.position, x);
    for (int i = 0; i < 3; i++) {
        const qvec3 axis = {i == 0, i == 1, i == 2}, d = quat_rotate_inverse(solid.orientation, axis);
        const double reach = impact_shape_support(&solid.shape, d, NULL) + rounding(body, state);
        b->low[i] = x[i] - reach, b->high[i] = x[i] + reach;
    }
}

static void moving_box(const imp_world *world, const imp_body *body, const imp_state *state, double time,
                       imp_crowd_body *b)
{
    double x[3], v[3], g[3];
    store(state->x, x), store(state->v, v), store(world->gravity, g);
    const double margin = body->radius + rounding(body, state);
    for (int i = 0; i < 3; i++) {
        if (b->course == IMP_COURSE_FREE)
            range(x[i], v[i], g[i], time, &b->low[i], &b->high[i]);
        else
            b->low[i] = x[i] - b->allowance, b->high[i] = x[i] + b->allowance;
        b->low[i] -= margin, b->high[i] += margin;
    }
}

static void begin(imp_crowd *crowd, const imp_world *world, const imp_state *states, const bool *resting,
                  const int *held, double time)
{
    for (int i = 0; i < crowd->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        imp_crowd_body *b = &crowd->bodies[i];
        *b = (imp_crowd_body){.top_speed = INFINITY, .parent = i, .group = -1};
        if (body->is_static) {
            if (body->shape.kind != IMPACT_PLANE) static_box(body, &states[i], b);
            continue;
        }
        const qvec3 v = states[i].v, omega = imp_omega(body, &states[i]);
        const bool damped = body->linear_rate != 0;
        b->speed = qvec3_norm(v) + body->radius * qvec3_norm(omega);
        b->kinetic = 0.5 * body->mass * qvec3_dot(v, v) + 0.5 * qvec3_dot(states[i].momentum, omega);
        b->course = resting[i] ? IMP_COURSE_REST : held[i] || damped ? IMP_COURSE_BOUNDED : IMP_COURSE_FREE;
        if (b->course == IMP_COURSE_FREE)
            b->allowance = time * (qvec3_norm(v) + 0.5 * time * qvec3_norm(world->gravity));
        moving_box(world, body, &states[i], time, b);
    }
}

/* ---- groups ---- */

static int root_of(const imp_crowd *crowd, int i)
{
    while (crowd->bodies[i].parent != i) i = crowd->bodies[i].parent;
    return i;
}

static void join(imp_crowd *crowd, int i, int j)
{
    const int a = root_of(crowd, i), b = root_of(crowd, j);
    crowd->bodies[i].parent = crowd->bodies[j].parent = a < b ? a : b;
    crowd->bodies[a].parent = crowd->bodies[b].parent = a < b ? a : b;
}

static impact_status note_pair(imp_crowd *crowd, const imp_world *world, int i, int j)
{
    int *pairs = imp_arena_grow(crowd->arena, crowd->pairs, &crowd->pair_room, crowd->pair_count + 1, sizeof *pairs);
    if (!pairs) return IMPACT_ENOMEM;
    crowd->pairs = pairs;
    crowd->pairs[crowd->pair_count++] = imp_crowd_pair(crowd, world, i, j);
    if (world->bodies[i].is_static || world->bodies[j].is_static) return IMPACT_OK;
    crowd->meetings++;
    join(crowd, i, j);
    return IMPACT_OK;
}

/* Whether two bodies whose boxes overlap can touch within the time. */
static bool can_meet(const imp_crowd *crowd, const imp_world *world, const imp_state *states, int i, int j, double time)
{
    const imp_crowd_body *a = &crowd->bodies[i], *b = &crowd->bodies[j];
    if (a->course == IMP_COURSE_STATIC || b->course == IMP_COURSE_STATIC) return true;
    const qvec3 d = qvec3_sub(states[i].x, states[j].x), v = qvec3_sub(states[i].v, states[j].v);
    const double reach = world->bodies[i].radius + world->bodies[j].radius + rounding(&world->bodies[i], &states[i]) +
                         rounding(&world->bodies[j], &states[j]);
    if (a->course != IMP_COURSE_FREE || b->course != IMP_COURSE_FREE)
        return qvec3_norm(d) <= reach + a->allowance + b->allowance;
    const double vv = qvec3_dot(v, v), nearest = vv > 0 ? fmin(fmax(-qvec3_dot(d, v) / vv, 0), time) : 0;
    return qvec3_norm(qvec3_axpy(nearest, v, d)) <= reach; /* one falls past the other in a straight line */
}

static bool can_meet_plane(const imp_crowd *crowd, const imp_world *world, const imp_state *states, int i, int plane,
                           double time)
{
    const imp_crowd_body *b = &crowd->bodies[i];
    const qvec3 n = quat_rotate(states[plane].q, (qvec3){0, 0, 1});
    const double height = qvec3_dot(n, qvec3_sub(states[i].x, states[plane].x));
    double low = height - b->allowance, high;
    if (b->course == IMP_COURSE_FREE)
        range(height, qvec3_dot(n, states[i].v), qvec3_dot(n, world->gravity), time, &low, &high);
    return low <=
           world->bodies[i].radius + rounding(&world->bodies[i], &states[i]) + 1e-9 * qvec3_norm(states[plane].x);
}

static bool boxes_overlap(const imp_crowd_body *a, const imp_crowd_body *b)
{
    for (int k = 1; k < 3; k++)
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return false;
    return true;
}

/* By insertion: from one time to the next the order hardly changes. */
static void sort_boxes(imp_crowd *crowd)
{
    for (int k = 1; k < crowd->ordered; k++) {
        const int moved = crowd->order[k];
        int at = k;
        for (; at > 0 && crowd->bodies[crowd->order[at - 1]].low[0] > crowd->bodies[moved].low[0]; at--)
            crowd->order[at] = crowd->order[at - 1];
        crowd->order[at] = moved;
    }
}

static impact_status find_pairs(imp_crowd *crowd, const imp_world *world, const imp_state *states, double time)
{
    impact_status status = IMPACT_OK;
    crowd->pair_count = crowd->meetings = 0;
    sort_boxes(crowd);
    for (int k = 0; k < crowd->ordered; k++) {
        const int i = crowd->order[k];
        const imp_crowd_body *a = &crowd->bodies[i];
        for (int l = k + 1; status == IMPACT_OK && l < crowd->ordered; l++) {
            const int j = crowd->order[l];
            const imp_crowd_body *b = &crowd->bodies[j];
            if (b->low[0] > a->high[0]) break;
            if (a->course == IMP_COURSE_STATIC && b->course == IMP_COURSE_STATIC) continue;
            if (boxes_overlap(a, b) && can_meet(crowd, world, states, i, j, time))
                status = note_pair(crowd, world, i, j);
        }
    }
    for (int p = 0; status == IMPACT_OK && p < crowd->body_count; p++) {
        if (world->bodies[p].shape.kind != IMPACT_PLANE) continue;
        for (int i = 0; status == IMPACT_OK && i < crowd->body_count; i++)
            if (!world->bodies[i].is_static && can_meet_plane(crowd, world, states, i, p, time))
                status = note_pair(crowd, world, i, p);
    }
    return status;
}

/* ---- allowances ---- */

typedef struct group_sum {
    bool awake;
    double speed, kinetic, fall; /* greatest; J; sum of sqrt(2 m) */
} group_sum;

static group_sum sum_of(const imp_crowd *crowd, const imp_world *world, int root)
{
    group_sum sum = {0};
    for (int i = crowd->slot[root]; i >= 0; i = crowd->bodies[i].group) {
        const imp_crowd_body *b = &crowd->bodies[i];
        sum.awake = sum.awake || b->course != IMP_COURSE_REST;
        sum.speed = fmax(sum.speed, b->speed);
        sum.kinetic += b->kinetic;
        sum.fall += sqrt(2 * world->bodies[i].mass);
    }
    return sum;
}

/* Chains each group's bodies from slot[root], through `group`, in descending order; -1 ends. */
static void chain_groups(imp_crowd *crowd, const imp_world *world)
{
    for (int i = 0; i < crowd->body_count; i++) crowd->slot[i] = -1;
    for (int i = 0; i < crowd->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        const int root = root_of(crowd, i);
        crowd->bodies[i].group = crowd->slot[root];
        crowd->slot[root] = i;
    }
}

/* Bounds what is no longer free or at rest, and lets allowances grow with their groups; false when nothing changed.
 * Energy: with all of the group's, K + g T sum(m V), given to one body of mass m, V = sqrt(2 E/m), which is quadratic
 * in sqrt(E). */
static bool allow(imp_crowd *crowd, const imp_world *world, const imp_state *states, double time, double caution)
{
    bool changed = false;
    const double g = qvec3_norm(world->gravity);
    for (int k = 0; k < crowd->pair_count; k++) {
        const imp_pair *pair = &world->pairs[crowd->pairs[k]];
        const int two[2] = {pair->body1, pair->body2};
        for (int s = 0; s < 2; s++)
            if (crowd->bodies[two[s]].course == IMP_COURSE_FREE) {
                crowd->bodies[two[s]].course = IMP_COURSE_BOUNDED;
                crowd->bodies[two[s]].allowance = 0;
                changed = true;
            }
    }
    chain_groups(crowd, world);
    for (int root = 0; root < crowd->body_count; root++) {
        if (crowd->slot[root] < 0) continue;
        const group_sum sum = sum_of(crowd, world, root);
        const double b = g * time * sum.fall, energy = 0.5 * (b + sqrt(b * b + 4 * sum.kinetic));
        for (int i = crowd->slot[root]; sum.awake && i >= 0; i = crowd->bodies[i].group) {
            imp_crowd_body *body = &crowd->bodies[i];
            if (body->course == IMP_COURSE_FREE) continue;
            const double most = world->driven ? INFINITY : sqrt(2 / world->bodies[i].mass) * energy;
            const double top_speed = fmin(most, caution * (sum.speed + g * time));
            changed = changed || body->course == IMP_COURSE_REST || time * top_speed > body->allowance;
            body->course = IMP_COURSE_BOUNDED;
            body->top_speed = top_speed * (1 + 1e-9);
            body->allowance = fmax(body->allowance, time * top_speed);
            moving_box(world, &world->bodies[i], &states[i], time, body);
        }
    }
    return changed;
}

/* ---- lists ---- */

static int ascending(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

static int group_of_pair(const imp_crowd *crowd, const imp_world *world, int pair)
{
    return crowd->bodies[world->pairs[pair].body1].group;
}

static void list_groups(imp_crowd *crowd, const imp_world *world)
{
    int *count = crowd->slot;
    crowd->group_count = 0;
    for (int i = 0; i < crowd->body_count; i++) crowd->bodies[i].group = -1;
    for (int i = 0; i < crowd->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        imp_crowd_body *root = &crowd->bodies[root_of(crowd, i)]; /* stands before all others of its group */
        if (root->group < 0) {
            count[crowd->group_count] = 0;
            root->group = crowd->group_count++;
        }
        crowd->bodies[i].group = root->group;
        count[root->group]++;
    }
    crowd->member_start[0] = 0;
    for (int g = 0; g < crowd->group_count; g++) crowd->member_start[g + 1] = crowd->member_start[g] + count[g];
    for (int g = 0; g < crowd->group_count; g++) count[g] = crowd->member_start[g];
    for (int i = 0; i < crowd->body_count; i++)
        if (crowd->bodies[i].group >= 0) crowd->members[count[crowd->bodies[i].group]++] = i;
}

static impact_status list_pairs(imp_crowd *crowd, const imp_world *world)
{
    int *sorted = imp_arena_take(crowd->arena, (size_t)crowd->pair_room, sizeof *sorted), *next = crowd->slot;
    if (!sorted) return IMPACT_ENOMEM;
    if (crowd->pair_count > 0) qsort(crowd->pairs, (size_t)crowd->pair_count, sizeof *crowd->pairs, ascending);
    memset(crowd->pair_start, 0, ((size_t)crowd->group_count + 1) * sizeof *crowd->pair_start);
    for (int k = 0; k < crowd->pair_count; k++) crowd->pair_start[group_of_pair(crowd, world, crowd->pairs[k]) + 1]++;
    for (int g = 0; g < crowd->group_count; g++) {
        crowd->pair_start[g + 1] += crowd->pair_start[g];
        next[g] = crowd->pair_start[g];
    }
    for (int k = 0; k < crowd->pair_count; k++)
        sorted[next[group_of_pair(crowd, world, crowd->pairs[k])]++] = crowd->pairs[k];
    imp_arena_give(crowd->arena, crowd->pairs);
    crowd->pairs = sorted;
    return IMPACT_OK;
}

impact_status imp_crowd_divide(imp_crowd *crowd, const imp_world *world, const imp_state *states, const bool *resting,
                               const int *held, double time, double caution)
{
    begin(crowd, world, states, resting, held, time);
    impact_status status = IMPACT_OK;
    do status = find_pairs(crowd, world, states, time);
    while (status == IMPACT_OK && allow(crowd, world, states, time, caution));
    if (status != IMPACT_OK) return status;
    list_groups(crowd, world);
    return list_pairs(crowd, world);
}
