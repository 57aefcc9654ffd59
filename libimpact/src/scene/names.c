/* SPDX-License-Identifier: MIT */
#include "scene/names.h"

#include <stdint.h>
#include <string.h>

impact_status imp_names_open(imp_names *names, imp_arena *arena, int room)
{
    size_t length = 4;
    while (length < 2 * (size_t)room) length *= 2;
    *names = (imp_names){.arena = arena,
                         .names = imp_arena_take(arena, (size_t)room, sizeof *names->names),
                         .numbers = imp_arena_take(arena, length, sizeof *names->numbers),
                         .mask = length - 1};
    if (!names->names || !names->numbers) return IMPACT_ENOMEM;
    for (size_t k = 0; k < length; k++) names->numbers[k] = -1;
    return IMPACT_OK;
}

/* Fowler, Noll and Vo's, FNV-1a in 64 bits, its halves joined. */
static size_t hash(const char *name)
{
    uint64_t h = 0xcbf29ce484222325u;
    for (; *name; name++) h = (h ^ (unsigned char)*name) * 0x100000001b3u;
    return (size_t)(h ^ (h >> 32));
}

/* Where in the table the name stands, or the empty place where it would. */
static size_t place_of(const imp_names *names, const char *name)
{
    size_t k = hash(name) & names->mask;
    while (names->numbers[k] >= 0 && strcmp(names->names[names->numbers[k]], name) != 0) k = (k + 1) & names->mask;
    return k;
}

impact_status imp_names_add(imp_names *names, const char *name)
{
    char *copy = imp_arena_copy(names->arena, name);
    if (!copy) return IMPACT_ENOMEM;
    names->numbers[place_of(names, copy)] = names->count;
    names->names[names->count++] = copy;
    return IMPACT_OK;
}

int imp_names_find(const imp_names *names, const char *name)
{
    return name ? names->numbers[place_of(names, name)] : -1;
}
