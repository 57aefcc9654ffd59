/* SPDX-License-Identifier: MIT
 *
 * The linear system of the held contacts: one unknown for a sliding contact, three for a rolling one. Contacts that share no moving body,
 * however remotely, are solved apart.
 */
#include "persist_system.h"

qvec3 impact_tangent(qvec3 n)
{
    const qvec3 t = fabs(n.x) < 0.6 ? (qvec3){0, n.z, -n.y} : (qvec3){-n.z, 0, n.x};
    return qvec3_scale(t, 1 / qvec3_norm(t));
}

qvec3 impact_system_response(const impact_world *world, const impact_state *states, const impact_touch *a,
                             const impact_touch *b, qvec3 f)
{
    const int bodies[2] = {b->body1, b->body2};
    const qvec3 arms[2] = {b->r1, b->r2};
    qvec3 change = {0, 0, 0};
    for (int k = 0; k < 2; k++) {
        const impact_body *body = &world->bodies[bodies[k]];
        if (body->is_static) continue;
        const qvec3 force = k == 0 ? f : qvec3_neg(f);
        const qvec3 da = qvec3_scale(force, body->inverse_mass);
        const qvec3 dalpha = impact_inverse_inertia(body, states[bodies[k]].q, qvec3_cross(arms[k], force));
        if (bodies[k] == a->body1) change = qvec3_add(change, qvec3_add(da, qvec3_cross(dalpha, a->r1)));
        if (bodies[k] == a->body2) change = qvec3_sub(change, qvec3_add(da, qvec3_cross(dalpha, a->r2)));
    }
    return change;
}

static int unknowns_of(const impact_touch *touch) { return touch->mode == IMPACT_ROLL ? 3 : 1; }

/* Row i of a touch: which component of u' it fixes. */
static qvec3 row_direction(const impact_touch *touch, int i)
{
    if (i == 0) return touch->normal;
    const qvec3 t = impact_tangent(touch->normal);
    return i == 1 ? t : qvec3_cross(touch->normal, t);
}

/* Column i: which force its unknown stands for; with friction, a sliding contact's pressure brings its friction along. */
static qvec3 column_direction(const impact_touch *touch, int i, bool with_friction)
{
    if (touch->mode == IMPACT_SLIDE && with_friction)
        return qvec3_axpy(-touch->friction, touch->direction, touch->normal);
    return row_direction(touch, i);
}

/* Gauss with complete pivoting; unknowns whose pivots vanish are set to zero. x comes in right. Returns the rank. */
static int solve_linear(double *a, double *right, int *order, int n)
{
    for (int i = 0; i < n; i++) order[i] = i;
    double first = 0;
    int rank = 0;
    for (; rank < n; rank++) {
        int row = rank, column = rank;
        for (int i = rank; i < n; i++)
            for (int j = rank; j < n; j++)
                if (fabs(a[i * n + j]) > fabs(a[row * n + column])) row = i, column = j;
        const double pivot = a[row * n + column];
        if (rank == 0) first = fabs(pivot);
        if (fabs(pivot) <= 1e-12 * first) break;
        for (int j = 0; j < n; j++) {
            const double swap = a[rank * n + j];
            a[rank * n + j] = a[row * n + j], a[row * n + j] = swap;
        }
        const double swap = right[rank];
        right[rank] = right[row], right[row] = swap;
        for (int i = 0; i < n; i++) {
            const double other = a[i * n + rank];
            a[i * n + rank] = a[i * n + column], a[i * n + column] = other;
        }
        const int which = order[rank];
        order[rank] = order[column], order[column] = which;
        for (int i = rank + 1; i < n; i++) {
            const double factor = a[i * n + rank] / pivot;
            if (factor == 0) continue;
            for (int j = rank; j < n; j++) a[i * n + j] -= factor * a[rank * n + j];
            right[i] -= factor * right[rank];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        if (i >= rank) {
            right[i] = 0;
            continue;
        }
        for (int j = i + 1; j < rank; j++) right[i] -= a[i * n + j] * right[j];
        right[i] /= a[i * n + i];
    }
    for (int i = 0; i < n; i++) a[order[i]] = right[i]; /* the matrix is spent: its first row serves */
    for (int i = 0; i < n; i++) right[i] = a[i];
    return rank;
}

/* ---- islands ---- */

static bool share_a_body(const impact_world *world, const impact_touch *a, const impact_touch *b)
{
    return a->body1 == b->body1 || a->body1 == b->body2 ||
           (a->body2 == b->body1 && !world->bodies[a->body2].is_static) ||
           (a->body2 == b->body2 && !world->bodies[a->body2].is_static);
}

/* Gives the touches that share bodies, directly or through others, the same number. */
static void find_islands(impact_persist *persist, const impact_world *world)
{
    int *island = persist->island;
    for (int a = 0; a < persist->count; a++) {
        island[a] = a;
        for (int b = 0; b < a; b++) {
            if (island[b] == island[a] || !share_a_body(world, &persist->touches[a], &persist->touches[b])) continue;
            const int from = island[a], to = island[b];
            for (int c = 0; c <= a; c++)
                if (island[c] == from) island[c] = to;
        }
    }
}

static void build_column(impact_persist *persist, const impact_world *world, const impact_state *states, int island,
                         int b, qvec3 f, double *column, int stride)
{
    for (int a = 0; a < persist->count; a++) {
        const impact_touch *touch = &persist->touches[a];
        if (persist->island[a] != island) continue;
        const qvec3 change = impact_system_response(world, states, touch, &persist->touches[b], f);
        for (int i = 0; i < unknowns_of(touch); i++, column += stride)
            *column = qvec3_dot(row_direction(touch, i), change);
    }
}

static void solve_island(impact_persist *persist, const impact_world *world, const impact_state *states,
                         bool with_friction, int island)
{
    int n = 0;
    for (int c = 0; c < persist->count; c++)
        for (int i = 0; persist->island[c] == island && i < unknowns_of(&persist->touches[c]); i++)
            persist->right[n++] = qvec3_dot(row_direction(&persist->touches[c], i), persist->touches[c].wanted);
    double *column = persist->matrix;
    for (int c = 0; c < persist->count; c++)
        for (int i = 0; persist->island[c] == island && i < unknowns_of(&persist->touches[c]); i++)
            build_column(persist, world, states, island, c, column_direction(&persist->touches[c], i, with_friction),
                         column++, n);
    const bool redundant = solve_linear(persist->matrix, persist->right, persist->order, n) < n;
    persist->redundant = persist->redundant || redundant;
    const double *x = persist->right;
    for (int c = 0; c < persist->count; c++) {
        impact_touch *touch = &persist->touches[c];
        if (persist->island[c] != island) continue;
        touch->redundant = redundant;
        touch->pressure = x[0];
        touch->force = (qvec3){0, 0, 0};
        for (int i = 0; i < unknowns_of(touch); i++)
            touch->force = qvec3_axpy(*x++, column_direction(touch, i, with_friction), touch->force);
    }
}

/* What is still keeps its reaction, and needs no impulse. */
static void recall(impact_touch *touch, const impact_world *world, bool with_friction)
{
    touch->force = with_friction ? world->pairs[touch->pair].reaction : (qvec3){0, 0, 0};
    touch->pressure = qvec3_dot(touch->normal, touch->force);
}

void impact_system_solve(impact_persist *persist, const impact_world *world, const impact_state *states,
                         bool with_friction)
{
    find_islands(persist, world);
    persist->redundant = false;
    for (int c = 0; c < persist->count; c++)
        if (persist->island[c] == c && !persist->touches[c].still)
            solve_island(persist, world, states, with_friction, c);
    for (int c = 0; c < persist->count; c++)
        if (persist->touches[c].still) recall(&persist->touches[c], world, with_friction);
}
