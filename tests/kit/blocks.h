/* SPDX-License-Identifier: MIT
 *
 * The arena's calls, sent here by the linker (-Wl,--wrap): the block of a number is refused, or all from it on. For one
 * file of a program.
 */
#ifndef TESTS_BLOCKS_H
#define TESTS_BLOCKS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct imp_arena imp_arena;
void *__real_imp_arena_take(imp_arena *arena, size_t count, size_t size);
void *__real_imp_arena_grow(imp_arena *arena, void *array, int *room, int wanted, size_t size);
char *__real_imp_arena_copy(imp_arena *arena, const char *text);
void *__wrap_imp_arena_take(imp_arena *arena, size_t count, size_t size);
void *__wrap_imp_arena_grow(imp_arena *arena, void *array, int *room, int wanted, size_t size);
char *__wrap_imp_arena_copy(imp_arena *arena, const char *text);

static long blocks, fail_at;
static bool all_after;

static bool refused(void)
{
    blocks++;
    return fail_at > 0 && (blocks == fail_at || (all_after && blocks > fail_at));
}

void *__wrap_imp_arena_take(imp_arena *arena, size_t count, size_t size)
{
    return refused() ? NULL : __real_imp_arena_take(arena, count, size);
}

void *__wrap_imp_arena_grow(imp_arena *arena, void *array, int *room, int wanted, size_t size)
{
    const bool grows = wanted > *room; /* what has room asks for nothing */
    return grows && refused() ? NULL : __real_imp_arena_grow(arena, array, room, wanted, size);
}

char *__wrap_imp_arena_copy(imp_arena *arena, const char *text)
{
    return refused() ? NULL : __real_imp_arena_copy(arena, text);
}

#endif
