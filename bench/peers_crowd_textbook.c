/* SPDX-License-Identifier: MIT
 *
 * The event-driven program of the textbooks (Rapaport; Lubachevsky), for equal balls and nothing else: the yardstick
 * of bench_crowd. The box is cut into cells as wide as a ball at least; a ball may only meet those of its own and the
 * 26 next ones. Each ball has one event, its next: with another ball, with a wall, or that it goes over into the next
 * cell; an indexed binary heap tells the first of all. Whoever's event was with a ball that has changed its flight
 * since looks for another when that event is due.
 */
#include "peers_crowd.h"

#include <math.h>

enum { NOTHING = -1, WALL = -2, CELL = -8 }; /* partners that are no balls: WALL - k and CELL - k, of the wall k */

typedef struct ball {
    qvec3 x, v;
    double t; /* of x */
    double due;
    int partner;      /* of the event due */
    unsigned changes; /* of its flight, */
    unsigned known;   /* and the partner's when that event was found */
    int cell, next, previous;
    int place; /* in the heap */
} ball;

typedef struct book {
    ball *balls;
    int *heap, *first; /* of each cell */
    int count, cells;  /* along a side */
    double side, radius;
} book;

/* ---- heap ---- */

static void put(book *b, int place, int i) { b->heap[place] = i, b->balls[i].place = place; }

static void rise(book *b, int i)
{
    int place = b->balls[i].place;
    for (; place > 0 && b->balls[b->heap[(place - 1) / 2]].due > b->balls[i].due; place = (place - 1) / 2)
        put(b, place, b->heap[(place - 1) / 2]);
    put(b, place, i);
}

static void sink(book *b, int i)
{
    int place = b->balls[i].place;
    for (int child; (child = 2 * place + 1) < b->count; place = child) {
        child += child + 1 < b->count && b->balls[b->heap[child + 1]].due < b->balls[b->heap[child]].due;
        if (b->balls[b->heap[child]].due >= b->balls[i].due) break;
        put(b, place, b->heap[child]);
    }
    put(b, place, i);
}

static void set_event(book *b, int i, double due, int partner)
{
    ball *one = &b->balls[i];
    const double before = one->due;
    one->due = due, one->partner = partner;
    if (partner >= 0) one->known = b->balls[partner].changes;
    if (due < before) rise(b, i);
    if (due > before) sink(b, i);
}

/* ---- cells ---- */

static double along(qvec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static int stride(const book *b, int axis) { return axis == 0 ? 1 : axis == 1 ? b->cells : b->cells * b->cells; }

static int coordinate(const book *b, int cell, int axis) { return cell / stride(b, axis) % b->cells; }

static void enter(book *b, int i, int cell)
{
    ball *one = &b->balls[i];
    one->cell = cell, one->previous = NOTHING, one->next = b->first[cell];
    if (one->next >= 0) b->balls[one->next].previous = i;
    b->first[cell] = i;
}

static void leave(book *b, int i)
{
    const ball *one = &b->balls[i];
    *(one->previous >= 0 ? &b->balls[one->previous].next : &b->first[one->cell]) = one->next;
    if (one->next >= 0) b->balls[one->next].previous = one->previous;
}

static int cell_at(const book *b, qvec3 x)
{
    int cell = 0;
    for (int axis = 0; axis < 3; axis++) {
        const int k = (int)(along(x, axis) / b->side * b->cells);
        cell += (k < 0 ? 0 : k >= b->cells ? b->cells - 1 : k) * stride(b, axis);
    }
    return cell;
}

/* ---- events ---- */

/* Where the ball, at the time t, leaves its cell or meets the wall behind it. */
static void look_at_cell(const book *b, const ball *one, double t, double *due, int *partner)
{
    const double width = b->side / b->cells;
    for (int axis = 0; axis < 3; axis++) {
        const double v = along(one->v, axis), x = along(one->x, axis);
        if (v == 0) continue;
        const int up = v > 0, k = coordinate(b, one->cell, axis);
        const double wall = fmax(0, ((up ? b->side - b->radius : b->radius) - x) / v);
        const double edge = (up ? k == b->cells - 1 : k == 0) ? INFINITY : fmax(0, ((k + up) * width - x) / v);
        if (t + fmin(wall, edge) >= *due) continue;
        *due = t + fmin(wall, edge), *partner = (wall < edge ? WALL : CELL) - 2 * axis - up;
    }
}

/* Where the ball, at the time t, meets the other one. */
static double meeting(const book *b, const ball *one, const ball *other, double t)
{
    const qvec3 d = qvec3_sub(one->x, qvec3_axpy(t - other->t, other->v, other->x)), w = qvec3_sub(one->v, other->v);
    const double fall = qvec3_dot(d, w);
    if (fall >= 0) return INFINITY;
    const double gap = qvec3_dot(d, d) - 4 * b->radius * b->radius, left = fall * fall - qvec3_dot(w, w) * gap;
    return left < 0 ? INFINITY : t + fmax(0, gap / (sqrt(left) - fall));
}

static void look_at_balls(const book *b, int i, double t, double *due, int *partner)
{
    const ball *one = &b->balls[i];
    int low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        const int k = coordinate(b, one->cell, axis);
        low[axis] = k > 0 ? k - 1 : 0, high[axis] = k < b->cells - 1 ? k + 1 : k;
    }
    for (int z = low[2]; z <= high[2]; z++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int x = low[0]; x <= high[0]; x++)
                for (int j = b->first[(z * b->cells + y) * b->cells + x]; j >= 0; j = b->balls[j].next) {
                    if (j == i) continue;
                    const double met = meeting(b, one, &b->balls[j], t);
                    if (met < *due && met <= b->balls[j].due) *due = met, *partner = j;
                }
}

/* The ball's next event, as it is at the time t; where it is with a ball, that one's too. */
static void predict(book *b, int i, double t)
{
    double due = INFINITY;
    int partner = NOTHING;
    look_at_cell(b, &b->balls[i], t, &due, &partner);
    look_at_balls(b, i, t, &due, &partner);
    set_event(b, i, due, partner);
    if (partner >= 0 && due < b->balls[partner].due) set_event(b, partner, due, i);
}

static void move(ball *one, double t)
{
    one->x = qvec3_axpy(t - one->t, one->v, one->x);
    one->t = t;
}

static void strike(book *b, int i, int j, double t)
{
    ball *one = &b->balls[i], *other = &b->balls[j];
    move(other, t);
    const qvec3 d = qvec3_sub(one->x, other->x);
    const double push = qvec3_dot(d, qvec3_sub(one->v, other->v)) / qvec3_dot(d, d);
    one->v = qvec3_axpy(-push, d, one->v), other->v = qvec3_axpy(push, d, other->v);
    one->changes++, other->changes++;
    set_event(b, i, INFINITY, NOTHING);
    set_event(b, j, INFINITY, NOTHING);
    predict(b, i, t);
    if (other->partner != i) predict(b, j, t);
}

static void reflect(ball *one, int axis)
{
    double *v = axis == 0 ? &one->v.x : axis == 1 ? &one->v.y : &one->v.z;
    *v = -*v;
    one->changes++;
}

/* Whether what was due for the ball was an impact. */
static bool handle(book *b, int i)
{
    ball *one = &b->balls[i];
    const double t = one->due;
    const int partner = one->partner;
    move(one, t);
    if (partner >= 0) {
        const bool still = one->known == b->balls[partner].changes && b->balls[partner].partner == i;
        if (still)
            strike(b, i, partner, t);
        else
            predict(b, i, t);
        return still;
    }
    const bool wall = partner > CELL;
    const int k = (wall ? WALL : CELL) - partner;
    if (wall) {
        reflect(one, k / 2);
    } else {
        leave(b, i);
        enter(b, i, one->cell + (k % 2 ? 1 : -1) * stride(b, k / 2));
    }
    predict(b, i, t);
    return wall;
}

/* ---- a run ---- */

static bool open_book(book *b, const gas *g)
{
    *b = (book){.count = g->count, .side = g->side, .radius = g->radius[0]};
    b->cells = (int)fmax(1, g->side / (2 * b->radius));
    const size_t cells = (size_t)b->cells * (size_t)b->cells * (size_t)b->cells;
    b->balls = calloc((size_t)g->count, sizeof *b->balls);
    b->heap = calloc((size_t)g->count, sizeof *b->heap);
    b->first = malloc(cells * sizeof *b->first);
    if (!b->balls || !b->heap || !b->first) return false;
    for (size_t k = 0; k < cells; k++) b->first[k] = NOTHING;
    for (int i = 0; i < g->count; i++) {
        b->balls[i] = (ball){.x = g->position[i], .v = g->velocity[i], .due = INFINITY, .partner = NOTHING};
        put(b, i, i);
        enter(b, i, cell_at(b, g->position[i]));
    }
    for (int i = 0; i < g->count; i++) predict(b, i, 0);
    return true;
}

static double energy_of(const book *b)
{
    double energy = 0;
    for (int i = 0; i < b->count; i++) energy += crowd_energy(b->radius, b->balls[i].v);
    return energy;
}

bool crowd_textbook(const gas *g, double duration, gas_run *run)
{
    book b;
    *run = (gas_run){.memory = NAN};
    const bool open = open_book(&b, g);
    if (open) {
        const double before = energy_of(&b), from = crowd_clock();
        while (b.balls[b.heap[0]].due <= duration) run->events += handle(&b, b.heap[0]);
        run->seconds = crowd_clock() - from;
        run->energy = energy_of(&b) / before - 1;
    }
    free(b.balls), free(b.heap), free(b.first);
    return open;
}
