/* SPDX-License-Identifier: MIT
 *
 * Sizes go in classes, four to an octave: k = 4 e + f stands for (4 + f) 2^e units of 16 bytes (8 where pointers have
 * 4), so a block is at most a quarter larger than what was asked for. Each class has its list of blocks that were given
 * back. What a piece has left when the next is taken is cut into blocks of those lists.
 *
 * Under AddressSanitizer what is not handed out is poisoned, and a strip behind every block too.
 */
#include "base/arena.h"

#include <limits.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define IMP_POISONS
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(IMP_POISONS)
#include <sanitizer/asan_interface.h>
enum { STRIP = 32 };
static void hide(void *at, size_t size) { ASAN_POISON_MEMORY_REGION(at, size); }
static void show(void *at, size_t size) { ASAN_UNPOISON_MEMORY_REGION(at, size); }
#else
enum { STRIP = 0 };
static void hide(void *at, size_t size) { (void)at, (void)size; }
static void show(void *at, size_t size) { (void)at, (void)size; }
#endif

enum {
    UNIT = _Alignof(max_align_t), /* bytes: malloc's alignment, and of a header's size: 16, of 32 bits' 8 */
    CLASSES = 4 * 56,             /* up to 2^62 bytes */
    FIRST_PIECE = 4096            /* bytes: a page */
};

typedef struct header {                        /* stands before its block */
    _Alignas(max_align_t) struct header *next; /* in its list, while nobody has it */
    size_t class;
} header;

typedef struct piece { /* stands at its beginning */
    _Alignas(max_align_t) struct piece *next;
    size_t size;
} piece;

struct imp_arena {
    impact_allocator allocator;
    piece *pieces; /* the latest first */
    char *free;    /* of the latest: what is not cut yet */
    size_t left;
    header *lists[CLASSES];
    impact_memory memory;
};

_Static_assert(sizeof(header) % UNIT == 0 && sizeof(piece) % UNIT == 0, "blocks stay aligned");

static void *by_malloc(size_t size, void *context)
{
    (void)context;
    return malloc(size);
}

static void by_free(void *piece_of_memory, size_t size, void *context)
{
    (void)size, (void)context;
    free(piece_of_memory);
}

static size_t rounded(size_t size, size_t unit) { return (size + unit - 1) / unit * unit; }

/* ---- classes ---- */

static size_t class_size(size_t class) { return ((4 + class % 4) << (class / 4)) * UNIT; }

/* The smallest that holds `size` <= 2^62 bytes. */
static size_t class_of(size_t size)
{
    size_t class = 0;
    while (class_size(class + 4) <= size) class += 4;
    while (class_size(class) < size) class ++;
    return class;
}

/* ---- pieces ---- */

static bool allowed(const impact_allocator *allocator, size_t held, size_t size)
{
    return allocator->limit == 0 || (size <= allocator->limit && held <= allocator->limit - size);
}

/* Into blocks of the lists, the largest that fit first: what is lost is less than the smallest class. */
static void cut_the_rest(imp_arena *arena)
{
    while (arena->left >= sizeof(header) + class_size(0)) {
        size_t class = class_of(arena->left - sizeof(header));
        if (class_size(class) > arena->left - sizeof(header)) class --;
        header *h = (header *)(void *)arena->free;
        show(h, sizeof *h);
        *h = (header){arena->lists[class], class};
        arena->lists[class] = h;
        arena->free += sizeof *h + class_size(class);
        arena->left -= sizeof *h + class_size(class);
    }
}

static bool take_piece(imp_arena *arena, size_t size)
{
    const impact_allocator *allocator = &arena->allocator;
    piece *p = allowed(allocator, arena->memory.held, size) ? allocator->allocate(size, allocator->context) : NULL;
    if (!p) return false;
    cut_the_rest(arena);
    *p = (piece){arena->pieces, size};
    arena->pieces = p;
    arena->free = (char *)(p + 1);
    arena->left = size - sizeof *p;
    arena->memory.held += size;
    arena->memory.pieces++;
    hide(arena->free, arena->left);
    return true;
}

/* As large as all before it together; where that is refused, as large as is needed. */
static bool make_room(imp_arena *arena, size_t bytes)
{
    if (arena->left >= bytes) return true;
    const size_t least = rounded(bytes + sizeof(piece), UNIT), held = arena->memory.held;
    return (held > least && take_piece(arena, held)) || take_piece(arena, least);
}

impact_status imp_arena_create(const impact_allocator *allocator, imp_arena **out)
{
    impact_allocator own = {.allocate = by_malloc, .release = by_free};
    *out = NULL;
    if (allocator && !allocator->allocate != !allocator->release) return IMPACT_EARGUMENT;
    if (allocator && allocator->allocate) own = *allocator;
    if (allocator) own.limit = allocator->limit;
    piece *first = allowed(&own, 0, FIRST_PIECE) ? own.allocate(FIRST_PIECE, own.context) : NULL;
    if (!first) return IMPACT_ENOMEM;
    *first = (piece){NULL, FIRST_PIECE};
    imp_arena *arena = (imp_arena *)(void *)(first + 1);
    *arena = (imp_arena){.allocator = own, .pieces = first, .memory = {.held = FIRST_PIECE, .pieces = 1}};
    const size_t taken = sizeof *first + rounded(sizeof *arena, UNIT);
    arena->free = (char *)first + taken;
    arena->left = FIRST_PIECE - taken;
    hide(arena->free, arena->left);
    *out = arena;
    return IMPACT_OK;
}

_Static_assert(sizeof(piece) + sizeof(imp_arena) + UNIT <= FIRST_PIECE, "an arena stands in its first piece");

void imp_arena_destroy(imp_arena *arena)
{
    if (!arena) return;
    const impact_allocator allocator = arena->allocator;
    for (piece *p = arena->pieces, *next; p; p = next) {
        const size_t size = p->size;
        next = p->next;
        show(p, size);
        allocator.release(p, size, allocator.context);
    }
}

/* ---- blocks ---- */

static header *header_of(void *block) { return (header *)block - 1; }

static header *new_block(imp_arena *arena, size_t class)
{
    const size_t bytes = sizeof(header) + class_size(class);
    if (!make_room(arena, bytes)) return NULL;
    header *h = (header *)(void *)arena->free;
    arena->free += bytes;
    arena->left -= bytes;
    return h;
}

/* A block of the class, of which `size` bytes are wanted. */
static void *hand_out(imp_arena *arena, size_t class, size_t size)
{
    header *h = arena->lists[class];
    if (h)
        arena->lists[class] = h->next;
    else if (!(h = new_block(arena, class)))
        return NULL;
    show(h, sizeof *h + size);
    *h = (header){NULL, class};
    arena->memory.used += class_size(class);
    if (arena->memory.used > arena->memory.most) arena->memory.most = arena->memory.used;
    return h + 1;
}

void *imp_arena_take_unset(imp_arena *arena, size_t count, size_t size)
{
    const size_t largest = SIZE_MAX / 8;
    const bool fits = size == 0 || count <= largest / size;
    void *block = fits ? hand_out(arena, class_of(count * size + STRIP), count * size) : NULL;
    if (!block) arena->memory.wanted = fits ? count * size : SIZE_MAX;
    return block;
}

void *imp_arena_take(imp_arena *arena, size_t count, size_t size)
{
    void *block = imp_arena_take_unset(arena, count, size);
    return block ? memset(block, 0, count * size) : NULL;
}

void imp_arena_give(imp_arena *arena, void *block)
{
    if (!block) return;
    header *h = header_of(block);
    h->next = arena->lists[h->class];
    arena->lists[h->class] = h;
    arena->memory.used -= class_size(h->class);
    hide(block, class_size(h->class));
}

void *imp_arena_grow(imp_arena *arena, void *array, int *room, int wanted, size_t size)
{
    if (array && wanted <= *room) return array;
    const int doubled = *room > INT_MAX / 2 ? INT_MAX : 2 * *room;
    int larger = wanted > doubled ? wanted : doubled;
    void *grown = imp_arena_take(arena, (size_t)larger, size);
    if (!grown && larger > wanted) grown = imp_arena_take(arena, (size_t)(larger = wanted), size);
    if (!grown) return NULL;
    if (array) memcpy(grown, array, (size_t)*room * size);
    imp_arena_give(arena, array);
    *room = larger;
    return grown;
}

char *imp_arena_copy(imp_arena *arena, const char *text)
{
    const size_t size = strlen(text) + 1;
    char *copy = imp_arena_take(arena, size, 1);
    return copy ? memcpy(copy, text, size) : NULL;
}

static void *take_within(size_t size, void *arena) { return imp_arena_take(arena, 1, size); }

static void give_within(void *block, size_t size, void *arena)
{
    (void)size;
    imp_arena_give(arena, block);
}

impact_allocator imp_arena_allocator(imp_arena *arena)
{
    return (impact_allocator){.allocate = take_within, .release = give_within, .context = arena};
}

impact_memory imp_arena_memory(const imp_arena *arena) { return arena->memory; }

void imp_arena_explain(const imp_arena *arena, char *message, size_t size)
{
    const impact_memory *m = &arena->memory;
    int length = snprintf(message, size, "out of memory: %zu bytes more than the %zu held", m->wanted, m->held);
    if (arena->allocator.limit && length >= 0 && (size_t)length < size)
        snprintf(message + length, size - (size_t)length, " (limit %zu)", arena->allocator.limit);
}
