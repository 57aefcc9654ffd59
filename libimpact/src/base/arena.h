/* SPDX-License-Identifier: MIT
 *
 * arena: the memory of one scene or workspace. Blocks are cut from pieces of the caller's allocator; a piece is as
 * large as all before it together, so n bytes take log2(n) pieces. What is given back serves the next request of its
 * size; all of it goes when the arena is destroyed, so that a failure half-way needs no undoing. For one thread.
 * Internal.
 */
#ifndef IMP_ARENA_H
#define IMP_ARENA_H

#include <stdbool.h>
#include <impact/memory.h>
#include <impact/status.h>

typedef struct imp_arena imp_arena;

/* The arena stands in its own first piece. allocator: copied; NULL: malloc. IMPACT_EARGUMENT: one function without the
 * other; IMPACT_ENOMEM. */
impact_status imp_arena_create(const impact_allocator *allocator, imp_arena **arena);
void imp_arena_destroy(imp_arena *arena); /* releases every piece; NULL is fine */

/* count * size bytes of zeros, aligned as malloc's; NULL: the allocator has no more, or the limit is reached, or the
 * product overflows: see imp_arena_memory. A count of 0 is answered by a block of no use that is not NULL. */
void *imp_arena_take(imp_arena *arena, size_t count, size_t size);
/* The same, not set to zeros: for bytes that are written once, and before they are read. */
void *imp_arena_take_unset(imp_arena *arena, size_t count, size_t size);
/* Gives a block back; NULL is fine. */
void imp_arena_give(imp_arena *arena, void *block);
/* An array of *room elements with room for `wanted` at least, doubled where it grows, its new part zero; *room follows.
 * array: NULL at first. NULL: there is no more; then array and *room stay as they were. */
void *imp_arena_grow(imp_arena *arena, void *array, int *room, int wanted, size_t size);
char *imp_arena_copy(imp_arena *arena, const char *text); /* of a string; NULL: no more */

/* What takes an allocator takes from the arena. */
impact_allocator imp_arena_allocator(imp_arena *arena);

impact_memory imp_arena_memory(const imp_arena *arena);
/* "out of memory: 4096 bytes more than the 65536 held (limit 65536)" */
void imp_arena_explain(const imp_arena *arena, char *message, size_t size);

#endif
