/* SPDX-License-Identifier: MIT
 *
 * The arena against a plain model: what is handed out is zero, aligned, apart from everything else, and keeps what is
 * written to it; all goes back to the allocator, with the sizes it was asked for, whatever failed on the way.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/arena.h"
#include "kit/ledger.h"

static uint64_t seed = 1;

static uint64_t random_number(void) /* xorshift64* (Vigna 2016) */
{
    seed ^= seed >> 12, seed ^= seed << 25, seed ^= seed >> 27;
    return seed * 2685821657736338717u;
}

/* Mostly small, below 2^17 bytes. */
static size_t random_size(void)
{
    const uint64_t below = (uint64_t)1 << random_number() % 18;
    return (size_t)(random_number() % below);
}

typedef struct model_block {
    unsigned char *at, mark;
    size_t size;
} model_block;

static void fill(model_block *b, size_t size)
{
    for (size_t i = 0; i < size; i++) assert_int_equal(b->at[i], 0);
    b->size = size;
    b->mark = (unsigned char)(random_number() >> 56);
    memset(b->at, b->mark, size);
}

static void check(const model_block *b)
{
    for (size_t i = 0; i < b->size; i++) assert_int_equal(b->at[i], b->mark);
}

static void blocks_keep_apart(void **state)
{
    (void)state;
    ledger c = {0};
    const impact_allocator allocator = ledger_allocator(&c, 0);
    imp_arena *arena;
    model_block blocks[64] = {0};
    assert_int_equal(imp_arena_create(&allocator, &arena), IMPACT_OK);
    size_t asked = 0, most = 0;
    for (int step = 0; step < 5000; step++) {
        model_block *b = &blocks[random_number() % 64];
        check(b);
        imp_arena_give(arena, b->at);
        asked -= b->size;
        const size_t size = random_size();
        *b = (model_block){.at = imp_arena_take(arena, size, 1)};
        assert_non_null(b->at);
        assert_int_equal((uintptr_t)b->at % _Alignof(max_align_t), 0);
        fill(b, size);
        asked += size;
        if (asked > most) most = asked;
        assert_int_equal(imp_arena_memory(arena).held, c.held);
        assert_true(imp_arena_memory(arena).used >= asked);
    }
    for (int i = 0; i < 64; i++) check(&blocks[i]);
    assert_true(imp_arena_memory(arena).most >= most);
    imp_arena_destroy(arena);
    assert_int_equal(c.live, 0);
    assert_int_equal(c.held, 0);
}

/* n bytes in log2(n) pieces: each is as large as all before it. */
static void pieces_double(void **state)
{
    (void)state;
    ledger c = {0};
    const impact_allocator allocator = ledger_allocator(&c, 0);
    imp_arena *arena;
    assert_int_equal(imp_arena_create(&allocator, &arena), IMPACT_OK);
    for (int i = 0; i < 100000; i++) assert_non_null(imp_arena_take(arena, 3, 8));
    assert_int_equal(imp_arena_memory(arena).pieces, c.calls);
    assert_true(c.calls <= 1 + ceil(log2((double)c.held / 4096)));
    assert_true(c.held <= 2 * imp_arena_memory(arena).used * 80 / 64 + 4096); /* a header of 16 bytes on each 64 */
    imp_arena_destroy(arena);
}

/* What comes back serves again: a run in balance takes nothing more. */
static void what_is_given_back_serves_again(void **state)
{
    (void)state;
    ledger c = {0};
    const impact_allocator allocator = ledger_allocator(&c, 0);
    imp_arena *arena;
    assert_int_equal(imp_arena_create(&allocator, &arena), IMPACT_OK);
    void *blocks[50];
    for (int round = 0; round < 200; round++) {
        for (int i = 0; i < 50; i++) assert_non_null(blocks[i] = imp_arena_take(arena, (size_t)(17 * i), 5));
        for (int i = 49; i >= 0; i--) imp_arena_give(arena, blocks[i]);
        assert_int_equal(imp_arena_memory(arena).used, 0);
    }
    const long calls = c.calls;
    for (int i = 0; i < 50; i++) assert_non_null(imp_arena_take(arena, (size_t)(17 * i), 5));
    assert_int_equal(c.calls, calls);
    assert_true(c.held <= 4 * imp_arena_memory(arena).most);
    imp_arena_destroy(arena);
}

static void an_array_grows_by_doubling(void **state)
{
    (void)state;
    imp_arena *arena;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    double *array = NULL;
    int room = 0, moves = 0;
    for (int i = 0; i < 10000; i++) {
        double *grown = imp_arena_grow(arena, array, &room, i + 1, sizeof *array);
        assert_non_null(grown);
        moves += grown != array;
        array = grown;
        assert_true(room > i);
        assert_true(array[room - 1] == 0);
        array[i] = i + 1;
    }
    for (int i = 0; i < 10000; i++) assert_true(array[i] == i + 1);
    assert_true(moves <= 15);
    imp_arena_destroy(arena);
}

static void the_limit_binds_and_is_told(void **state)
{
    (void)state;
    char message[200];
    for (size_t limit = 0; limit < 300000; limit += 4099) {
        ledger c = {0};
        const impact_allocator allocator = ledger_allocator(&c, limit);
        imp_arena *arena;
        const impact_status status = imp_arena_create(&allocator, &arena);
        if (limit > 0 && limit < 4096) assert_int_equal(status, IMPACT_ENOMEM);
        if (status != IMPACT_OK) continue;
        int taken = 0;
        while (taken < 1000 && imp_arena_take(arena, 1000, 1)) taken++;
        if (limit == 0) {
            assert_int_equal(taken, 1000);
            imp_arena_destroy(arena);
            continue;
        }
        assert_true(c.held <= limit);
        /* Doubling gives way to what is needed, so little stays unused: 1000 bytes take a class of 1024, or of 1280
         * with the sanitizer, a header, and at worst a piece of their own. */
        assert_true((double)taken >= (double)(limit - 4096) / (1280 + 32) - 1);
        assert_int_equal(imp_arena_memory(arena).wanted, 1000);
        imp_arena_explain(arena, message, sizeof message);
        char wanted[200];
        snprintf(wanted, sizeof wanted, "out of memory: 1000 bytes more than the %zu held (limit %zu)", c.held, limit);
        assert_string_equal(message, wanted);
        imp_arena_destroy(arena);
        assert_int_equal(c.live, 0);
    }
}

static void failures_are_answered(void **state)
{
    (void)state;
    for (long fail_at = 1; fail_at <= 12; fail_at++) {
        ledger c = {.fail_at = fail_at};
        const impact_allocator allocator = ledger_allocator(&c, 0);
        imp_arena *arena = (imp_arena *)&c;
        if (imp_arena_create(&allocator, &arena) != IMPACT_OK) {
            assert_int_equal(fail_at, 1);
            assert_null(arena);
            continue;
        }
        int refused = 0;
        for (int i = 0; i < 2000; i++) {
            model_block b = {.at = imp_arena_take(arena, (size_t)i, 1)};
            refused += !b.at;
            if (b.at) fill(&b, (size_t)i);
        }
        assert_true(refused <= 1); /* a refused doubling is made up for by a smaller piece */
        imp_arena_destroy(arena);
        assert_int_equal(c.live, 0);
    }
}

static void what_makes_no_sense_is_refused(void **state)
{
    (void)state;
    imp_arena *arena;
    const impact_allocator half = {.allocate = ledger_allocate};
    assert_int_equal(imp_arena_create(&half, &arena), IMPACT_EARGUMENT);
    assert_null(arena);
    const impact_allocator limited = {.limit = 1 << 20};
    assert_int_equal(imp_arena_create(&limited, &arena), IMPACT_OK);
    assert_null(imp_arena_take(arena, SIZE_MAX / 2, 3)); /* the product overflows */
    assert_null(imp_arena_take(arena, 1 << 20, 1));
    assert_int_equal(imp_arena_memory(arena).wanted, 1 << 20);
    assert_non_null(imp_arena_take(arena, 0, 8));
    imp_arena_give(arena, NULL);
    assert_string_equal(imp_arena_copy(arena, "a name"), "a name");
    imp_arena_destroy(arena);
    imp_arena_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_keep_apart),
        cmocka_unit_test(pieces_double),
        cmocka_unit_test(what_is_given_back_serves_again),
        cmocka_unit_test(an_array_grows_by_doubling),
        cmocka_unit_test(the_limit_binds_and_is_told),
        cmocka_unit_test(failures_are_answered),
        cmocka_unit_test(what_makes_no_sense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
