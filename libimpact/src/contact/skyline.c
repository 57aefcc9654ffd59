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
        total += SIDE * SIDE * (size_t)(i - sky->first[i] + 1);
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

/* ---- elements: row i, and column i, begin at 6 first, and are as long as their block row ---- */

static double *skyline_line(const imp_skyline *sky, double *values, int i, int *first)
{
    const int block = i / SIDE;
    *first = SIDE * sky->first[block];
    return values + sky->start[block] + (size_t)(i % SIDE) * SIDE * (size_t)(block - sky->first[block] + 1);
}

/* Element (i, j). */
static double *skyline_element(const imp_skyline *sky, int i, int j)
{
    int first;
    double *line = i >= j ? skyline_line(sky, sky->lower, i, &first) : skyline_line(sky, sky->upper, j, &first);
    return &line[(i >= j ? j : i) - first];
}

void imp_skyline_add(imp_skyline *sky, int a, int b, double block[6][6])
{
    for (int k = 0; k < SIDE; k++)
        for (int l = 0; l < SIDE; l++)
            *skyline_element(sky, SIDE * sky->place[a] + k, SIDE * sky->place[b] + l) += block[k][l];
}

/* sum l_k u_k where both lines have begun, up to `end`. */
static double common_product(const double *one, int one_first, const double *two, int two_first, int end)
{
    const int begin = one_first > two_first ? one_first : two_first;
    double sum = 0;
    for (int k = begin; k < end; k++) sum += one[k - one_first] * two[k - two_first];
    return sum;
}

bool imp_skyline_factor(imp_skyline *sky)
{
    for (int i = 0; i < SIDE * sky->bodies; i++) {
        int first, other;
        double *row = skyline_line(sky, sky->lower, i, &first), *column = skyline_line(sky, sky->upper, i, &first);
        for (int j = first; j < i; j++) {
            const double *above = skyline_line(sky, sky->upper, j, &other),
                         *left = skyline_line(sky, sky->lower, j, &other);
            row[j - first] = (row[j - first] - common_product(row, first, above, other, j)) / left[j - other];
            column[j - first] -= common_product(column, first, left, other, j);
        }
        row[i - first] -= common_product(row, first, column, first, i);
        if (!(fabs(row[i - first]) > 0)) return false;
    }
    return true;
}

void imp_skyline_solve(const imp_skyline *sky, double *x)
{
    const int n = SIDE * sky->bodies;
    double *y = sky->scratch;
    int first;
    for (int b = 0; b < sky->bodies; b++) memcpy(&y[SIDE * sky->place[b]], &x[SIDE * b], SIDE * sizeof *x);
    for (int i = 0; i < n; i++) {
        const double *row = skyline_line(sky, sky->lower, i, &first);
        y[i] -= common_product(row, first, y, 0, i);
    }
    for (int i = n - 1; i >= 0; i--) {
        y[i] /= skyline_line(sky, sky->lower, i, &first)[i - first];
        const double *column = skyline_line(sky, sky->upper, i, &first);
        for (int k = first; k < i; k++) y[k] -= column[k - first] * y[i];
    }
    for (int b = 0; b < sky->bodies; b++) memcpy(&x[SIDE * b], &y[SIDE * sky->place[b]], SIDE * sizeof *x);
}
