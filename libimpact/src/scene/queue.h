/* SPDX-License-Identifier: MIT
 *
 * queue: an indexed heap of times, of four children each. Every slot has one time, changed in place: nothing in it is
 * ever stale. Internal.
 *
 * LaMarca & Ladner, "The influence of caches on the performance of heaps", 1996.
 */
#ifndef IMP_QUEUE_H
#define IMP_QUEUE_H

#include "base/arena.h"

typedef struct imp_queue_item {
    double time; /* of the slot; infinite: never */
    int slot;
} imp_queue_item;

typedef struct imp_queue {
    imp_arena *arena;
    int slots, room, place_room;
    imp_queue_item *block, *heap; /* the heap begins in the block where its items' four children lie in one line */
    int *place;                   /* of each slot in the heap */
} imp_queue;

/* A new slot with the time infinity, or -1 when there is no memory. */
int imp_queue_add(imp_queue *queue);

void imp_queue_set(imp_queue *queue, int slot, double time);
double imp_queue_time_of(const imp_queue *queue, int slot);
/* The slot of the least time; of several the one of the least number. -1 in an empty queue. */
int imp_queue_first(const imp_queue *queue);
/* The least time; infinite in an empty queue. */
double imp_queue_time(const imp_queue *queue);

#endif
