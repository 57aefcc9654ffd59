/* SPDX-License-Identifier: MIT
 *
 * An allocator that keeps books: what it gave and has not got back, with its sizes, and one call that it refuses.
 */
#ifndef TESTS_LEDGER_H
#define TESTS_LEDGER_H

#include <stdlib.h>
#include <impact/memory.h>
#include "kit/near.h"

typedef struct ledger {
    size_t held, most; /* bytes out; the most there were */
    long calls, live;  /* of allocate; pieces out */
    long fail_at;      /* the call that is refused; 0: none */
    int all_after;     /* and all after it */
} ledger;

enum { LEDGER_HEAD = 64 }; /* before each piece: its size, and alignment */

static inline void *ledger_allocate(size_t size, void *context)
{
    ledger *l = (ledger *)context;
    l->calls++;
    if (l->fail_at > 0 && (l->calls == l->fail_at || (l->all_after && l->calls > l->fail_at))) return NULL;
    size_t *piece = (size_t *)malloc(size + LEDGER_HEAD);
    if (!piece) return NULL;
    *piece = size;
    l->live++;
    l->held += size;
    if (l->held > l->most) l->most = l->held;
    return (char *)piece + LEDGER_HEAD;
}

static inline void ledger_release(void *piece, size_t size, void *context)
{
    ledger *l = (ledger *)context;
    size_t *whole = (size_t *)(void *)((char *)piece - LEDGER_HEAD);
    assert_int_equal(*whole, size);
    l->live--;
    l->held -= size;
    free(whole);
}

static inline impact_allocator ledger_allocator(ledger *l, size_t limit)
{
    return (impact_allocator){.allocate = ledger_allocate, .release = ledger_release, .context = l, .limit = limit};
}

#endif
