/* SPDX-License-Identifier: MIT
 *
 * queue: an indexed binary heap of times. Every slot has one time, changed in place: nothing in it is ever stale.
 * Internal.
 */
#ifndef IMP_QUEUE_H
#define IMP_QUEUE_H

#include "base/arena.h"

typedef struct imp_queue {
    imp_arena *arena;
    int slots;
    int rooms[3]; /* of the arrays */
    double *time; /* of each slot; infinite: never */
    int *heap, *place;
} imp_queue;

/* A new slot with the time infinity, or -1 when there is no memory. */
int imp_queue_add(imp_queue *queue);

void imp_queue_set(imp_queue *queue, int slot, double time);
/* The slot of the least time; of several the one of the least number. -1 in an empty queue. */
int imp_queue_first(const imp_queue *queue);
/* The least time; infinite in an empty queue. */
double imp_queue_time(const imp_queue *queue);

#endif
