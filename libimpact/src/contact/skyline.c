/* SPDX-License-Identifier: MIT */
#include "contact/skyline.h"

#include <math.h>
#include <string.h>

enum { SIDE = 6 };

/* ---- shape ---- */

static bool furnish_skyline(imp_skyline *sky, int bodies)
{
    if (bodies <= sky->body_room) return true;
    imp_arena *arena = sky->arena;
    const size_t count = (size_t)bodies;
    int **lists[] = {&sky->place, &sky->first, &sky->degree, &sky->queue};
    bool there = true;
    sky->body_room = 0;
    for (int k = 0; k < 4; k++) {
        imp_arena_give(arena, *lists[k]);
        *lists[k] = imp_arena_take(arena, count, sizeof **lists[k]);
        there = there && *lists[k];
    }
    imp_arena_give(arena, sky->start);
    imp_arena_give(arena, sky->scratch);
    sky->start = imp_arena_take(arena, count + 1, sizeof *sky->start);
    sky->scratch = imp_arena_take(arena, SIDE * count, sizeof *sky->scratch);
    if (there && sky->start && sky->scratch) sky->body_room = bodies;
    return sky->body_room == bodies;
}

static bool is_couple(const int couple[2]) { return couple[0] >= 0 && couple[1] >= 0 && couple[0] != couple[1]; }

/* Appends to the queue all neighbours of the body that have no place yet, those of fewest neighbours first. */
static int append_neighbours(imp_skyline *sky, int body, const int (*touching)[2], int count, int length)
{
    const int from = length;
    for (int k = 0; k < count; k++) {
        if (!is_couple(touching[k]) || (touching[k][0] != body && touching[k][1] != body)) continue;
        const int other = touching[k][touching[k][0] == body];
        if (sky->place[other] >= 0) continue;
        sky->place[other] = 0;
        int at = length++;
        for (; at > from && sky->degree[sky->queue[at - 1]] > sky->degree[other]; at--)
            sky->queue[at] = sky->queue[at - 1];
        sky->queue[at] = other;
    }
    return length;
}

static void order_bodies(imp_skyline *sky, const int (*touching)[2], int count)
{
    const int n = sky->bodies;
    memset(sky->degree, 0, sizeof *sky->degree * (size_t)n);
    for (int k = 0; k < count; k++)
        for (int side = 0; side < 2 && is_couple(touching[k]); side++) sky->degree[touching[k][side]]++;
    for (int i = 0; i < n; i++) sky->place[i] = -1;
    int length = 0;
    for (int next = 0; next < n; next++) {
        if (next == length) { /* another island: from its body of fewest neighbours */
            int least = -1;
            for (int i = 0; i < n; i++)
                if (sky->place[i] < 0 && (least < 0 || sky->degree[i] < sky->degree[least])) least = i;
            sky->place[least] = 0;
            sky->queue[length++] = least;
        }
        length = append_neighbours(sky, sky->queue[next], touching, count, length);
    }
    for (int i = 0; i < n; i++) sky->place[sky->queue[i]] = n - 1 - i;
}

bool imp_skyline_shape(imp_skyline *sky, int bodies, const int (*touching)[2], int count)
{
    if (!furnish_skyline(sky, bodies)) return false;
    sky->bodies = bodies;
    order_bodies(sky, touching, count);
    for (int i = 0; i < bodies; i++) sky->first[i] = i;
    for (int k = 0; k < count; k++) {
        if (!is_couple(touching[k])) continue;
        const int a = sky->place[touching[k][0]], b = sky->place[touching[k][1]], low = a < b ? a : b,
                  high = a + b - low;
        if (low < sky->first[high]) sky->first[high] = low;
    }
    size_t total = 0;
    for (int i = 0; i < bodies; i++) {
        sky->start[i] = total;
        total += (size_t)(i - sky->first[i] + 1);
    }
    sky->start[bodies] = total;
    if (total <= sky->value_room) return true;
    imp_arena_give(sky->arena, sky->lower);
    imp_arena_give(sky->arena, sky->upper);
    sky->lower = imp_arena_take(sky->arena, total, sizeof *sky->lower);
    sky->upper = imp_arena_take(sky->arena, total, sizeof *sky->upper);
    sky->value_room = sky->lower && sky->upper ? total : 0;
    return sky->value_room > 0;
}

void imp_skyline_clear(imp_skyline *sky)
{
    memset(sky->lower, 0, sizeof *sky->lower * sky->start[sky->bodies]);
    memset(sky->upper, 0, sizeof *sky->upper * sky->start[sky->bodies]);
}

/* ---- blocks: those of row i, and of column i, begin at first[i] and end at the diagonal ---- */

/* C -= A B. */
static void take_product(double c[restrict SIDE][SIDE], double a[restrict SIDE][SIDE], double b[restrict SIDE][SIDE])
{
    for (int k = 0; k < SIDE; k++)
        for (int m = 0; m < SIDE; m++)
            for (int l = 0; l < SIDE; l++) c[k][l] -= a[k][m] * b[m][l];
}

/* B D^-1 in B's place, of D^-1. */
static void divide_right(double b[restrict SIDE][SIDE], double inverse[restrict SIDE][SIDE])
{
    for (int k = 0; k < SIDE; k++) {
        double row[SIDE] = {0};
        for (int m = 0; m < SIDE; m++)
            for (int l = 0; l < SIDE; l++) row[l] += b[k][m] * inverse[m][l];
        memcpy(b[k], row, sizeof row);
    }
}

/* D^-1 in D's place (Gauss & Jordan): rows are multiplied by it at once, where substitution goes number by number. */
static bool invert_block(double d[SIDE][SIDE])
{
    for (int k = 0; k < SIDE; k++) {
        if (!(fabs(d[k][k]) > 0)) return false;
        const double part = 1 / d[k][k];
        d[k][k] = 1;
        for (int m = 0; m < SIDE; m++) d[k][m] *= part;
        for (int l = 0; l < SIDE; l++) {
            if (l == k) continue;
            const double factor = d[l][k];
            d[l][k] = 0;
            for (int m = 0; m < SIDE; m++) d[l][m] -= factor * d[k][m];
        }
    }
    return true;
}

/* D^-1 x in x's place. */
static void divide_left(double inverse[SIDE][SIDE], double *x)
{
    double own[SIDE];
    memcpy(own, x, sizeof own);
    for (int k = 0; k < SIDE; k++) {
        x[k] = 0;
        for (int l = 0; l < SIDE; l++) x[k] += inverse[k][l] * own[l];
    }
}

/* y -= B x. */
static void take_from(double *y, double b[SIDE][SIDE], const double *x)
{
    for (int k = 0; k < SIDE; k++) {
        double sum = 0;
        for (int l = 0; l < SIDE; l++) sum += b[k][l] * x[l];
        y[k] -= sum;
    }
}

/* The block of row i, column j <= i, or of row j, column i; on the diagonal they are one. */
static imp_skyline_block *block_at(const imp_skyline *sky, imp_skyline_block *values, int i, int j)
{
    return &values[sky->start[i] + (size_t)(j - sky->first[i])];
}

void imp_skyline_add(imp_skyline *sky, int a, int b, double block[6][6])
{
    const int i = sky->place[a], j = sky->place[b];
    imp_skyline_block *own = i >= j ? block_at(sky, sky->lower, i, j) : block_at(sky, sky->upper, j, i);
    for (int k = 0; k < SIDE; k++)
        for (int l = 0; l < SIDE; l++) own->a[k][l] += block[k][l];
}

void imp_skyline_add_product(imp_skyline *sky, int a, int b, double left[restrict 3][6],
                             const double right[restrict 3][6])
{
    const int i = sky->place[a], j = sky->place[b];
    imp_skyline_block *own = i >= j ? block_at(sky, sky->lower, i, j) : block_at(sky, sky->upper, j, i);
    for (int k = 0; k < SIDE; k++)
        for (int l = 0; l < SIDE; l++)
            own->a[k][l] += left[0][k] * right[0][l] + left[1][k] * right[1][l] + left[2][k] * right[2][l];
}

/* A = (1 + L)(D + U): S_ij = A_ij - sum L_ik U_kj on both sides of the diagonal, U_ji = S_ji, L_ij = S_ij D_j^-1. */
bool imp_skyline_factor(imp_skyline *sky)
{
    for (int i = 0; i < sky->bodies; i++) {
        const int begin = sky->first[i];
        imp_skyline_block *row = block_at(sky, sky->lower, i, begin), *column = block_at(sky, sky->upper, i, begin);
        for (int j = begin; j < i; j++) {
            for (int k = sky->first[j] > begin ? sky->first[j] : begin; k < j; k++) {
                take_product(row[j - begin].a, row[k - begin].a, block_at(sky, sky->upper, j, k)->a);
                take_product(column[j - begin].a, block_at(sky, sky->lower, j, k)->a, column[k - begin].a);
            }
            divide_right(row[j - begin].a, block_at(sky, sky->lower, j, j)->a);
        }
        for (int k = begin; k < i; k++) take_product(row[i - begin].a, row[k - begin].a, column[k - begin].a);
        if (!invert_block(row[i - begin].a)) return false;
    }
    return true;
}

void imp_skyline_solve(const imp_skyline *sky, double *x)
{
    double *y = sky->scratch;
    for (int b = 0; b < sky->bodies; b++) memcpy(&y[SIDE * sky->place[b]], &x[SIDE * b], SIDE * sizeof *x);
    for (int i = 0; i < sky->bodies; i++)
        for (int k = sky->first[i]; k < i; k++)
            take_from(&y[SIDE * i], block_at(sky, sky->lower, i, k)->a, &y[SIDE * k]);
    for (int i = sky->bodies - 1; i >= 0; i--) {
        divide_left(block_at(sky, sky->lower, i, i)->a, &y[SIDE * i]);
        for (int k = sky->first[i]; k < i; k++)
            take_from(&y[SIDE * k], block_at(sky, sky->upper, i, k)->a, &y[SIDE * i]);
    }
    for (int b = 0; b < sky->bodies; b++) memcpy(&x[SIDE * b], &y[SIDE * sky->place[b]], SIDE * sizeof *x);
}
