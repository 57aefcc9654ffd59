/* SPDX-License-Identifier: MIT */
#include "scene/queue.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { CHILDREN = 4, LINE = 64 };

static bool before(imp_queue_item a, imp_queue_item b)
{
    return a.time < b.time || (a.time == b.time && a.slot < b.slot);
}

static void put(imp_queue *queue, int place, imp_queue_item item)
{
    queue->heap[place] = item;
    queue->place[item.slot] = place;
}

static void rise(imp_queue *queue, int place, imp_queue_item item)
{
    for (; place > 0 && before(item, queue->heap[(place - 1) / CHILDREN]); place = (place - 1) / CHILDREN)
        put(queue, place, queue->heap[(place - 1) / CHILDREN]);
    put(queue, place, item);
}

static void sink(imp_queue *queue, int place, imp_queue_item item)
{
    for (int child; (child = CHILDREN * place + 1) < queue->slots; place = child) {
        const int end = child + CHILDREN < queue->slots ? child + CHILDREN : queue->slots;
        for (int k = child + 1; k < end; k++) child = before(queue->heap[k], queue->heap[child]) ? k : child;
        if (!before(queue->heap[child], item)) break;
        put(queue, place, queue->heap[child]);
    }
    put(queue, place, item);
}

static bool grow_heap(imp_queue *queue, int wanted)
{
    if (wanted <= queue->room) return true;
    const int room = 2 * wanted;
    imp_queue_item *block = imp_arena_take(queue->arena, (size_t)room + CHILDREN, sizeof *block);
    if (!block) return false;
    imp_queue_item *heap = block;
    while ((uintptr_t)(heap + 1) % LINE != 0 && heap < block + CHILDREN) heap++;
    if (queue->slots > 0) memcpy(heap, queue->heap, (size_t)queue->slots * sizeof *heap);
    imp_arena_give(queue->arena, queue->block);
    queue->block = block, queue->heap = heap, queue->room = room;
    return true;
}

static bool grow(imp_queue *queue)
{
    const int wanted = queue->slots + 1;
    int *place = imp_arena_grow(queue->arena, queue->place, &queue->place_room, wanted, sizeof *place);
    if (place) queue->place = place;
    return place && grow_heap(queue, wanted);
}

int imp_queue_add(imp_queue *queue)
{
    if (!grow(queue)) return -1;
    const int slot = queue->slots++;
    put(queue, slot, (imp_queue_item){INFINITY, slot});
    return slot;
}

void imp_queue_set(imp_queue *queue, int slot, double time)
{
    const int place = queue->place[slot];
    const double old = queue->heap[place].time;
    if (time < old) rise(queue, place, (imp_queue_item){time, slot});
    if (time > old) sink(queue, place, (imp_queue_item){time, slot});
}

double imp_queue_time_of(const imp_queue *queue, int slot) { return queue->heap[queue->place[slot]].time; }

int imp_queue_first(const imp_queue *queue) { return queue->slots > 0 ? queue->heap[0].slot : -1; }

double imp_queue_time(const imp_queue *queue) { return queue->slots > 0 ? queue->heap[0].time : INFINITY; }
