/* SPDX-License-Identifier: MIT */
#include "scene/queue.h"

#include <math.h>

static bool before(const imp_queue *queue, int a, int b)
{
    return queue->time[a] < queue->time[b] || (queue->time[a] == queue->time[b] && a < b);
}

static void put(imp_queue *queue, int place, int slot)
{
    queue->heap[place] = slot;
    queue->place[slot] = place;
}

static void rise(imp_queue *queue, int slot)
{
    int place = queue->place[slot];
    for (; place > 0 && before(queue, slot, queue->heap[(place - 1) / 2]); place = (place - 1) / 2)
        put(queue, place, queue->heap[(place - 1) / 2]);
    put(queue, place, slot);
}

static void sink(imp_queue *queue, int slot)
{
    int place = queue->place[slot];
    for (int child; (child = 2 * place + 1) < queue->slots; place = child) {
        if (child + 1 < queue->slots && before(queue, queue->heap[child + 1], queue->heap[child])) child++;
        if (!before(queue, queue->heap[child], slot)) break;
        put(queue, place, queue->heap[child]);
    }
    put(queue, place, slot);
}

static bool grow(imp_queue *queue)
{
    const int wanted = queue->slots + 1;
    double *time = imp_arena_grow(queue->arena, queue->time, &queue->rooms[0], wanted, sizeof *time);
    if (time) queue->time = time;
    int *heap = imp_arena_grow(queue->arena, queue->heap, &queue->rooms[1], wanted, sizeof *heap);
    if (heap) queue->heap = heap;
    int *place = imp_arena_grow(queue->arena, queue->place, &queue->rooms[2], wanted, sizeof *place);
    if (place) queue->place = place;
    return time && heap && place;
}

int imp_queue_add(imp_queue *queue)
{
    if (!grow(queue)) return -1;
    const int slot = queue->slots++;
    queue->time[slot] = INFINITY;
    put(queue, slot, slot);
    return slot;
}

void imp_queue_set(imp_queue *queue, int slot, double time)
{
    const double old = queue->time[slot];
    queue->time[slot] = time;
    if (time < old) rise(queue, slot);
    if (time > old) sink(queue, slot);
}

int imp_queue_first(const imp_queue *queue) { return queue->slots > 0 ? queue->heap[0] : -1; }

double imp_queue_time(const imp_queue *queue) { return queue->slots > 0 ? queue->time[queue->heap[0]] : INFINITY; }
