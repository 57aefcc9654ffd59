/* SPDX-License-Identifier: MIT
 *
 * The grid against a look through all boxes: of all sizes, near the origin and far from it, moved again and again.
 */
#include "world/grid.h"
#include "kit/contact_random.h"
#include "kit/near.h"

enum { BOXES = 300, MOVES = 4000 };

static imp_box random_box(random_stream *random, double far)
{
    imp_box box;
    const double size = random_log(random, 1e-3, 2);
    for (int k = 0; k < 3; k++) {
        box.low[k] = far + 10 * (random_unit(random) - 0.5);
        box.high[k] = box.low[k] + size * random_unit(random);
    }
    return box;
}

static void finds_all_that_overlap_and_nothing_else(void **state)
{
    (void)state;
    const double places[] = {0, 1e6, -1e12};
    for (int place = 0; place < 3; place++) {
        random_stream random = {2};
        imp_grid grid;
        imp_arena *arena;
        assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
        imp_box boxes[BOXES];
        assert_int_equal(imp_grid_open(&grid, arena, BOXES), IMPACT_OK);
        for (int i = 0; i < BOXES; i++) {
            boxes[i] = random_box(&random, places[place]);
            assert_int_equal(imp_grid_put(&grid, i, &boxes[i]), IMPACT_OK);
        }
        for (int move = 0; move < MOVES; move++) {
            const int i = (int)(BOXES * random_unit(&random));
            boxes[i] = random_box(&random, places[place]);
            assert_int_equal(imp_grid_put(&grid, i, &boxes[i]), IMPACT_OK);
            assert_int_equal(imp_grid_query(&grid, &boxes[i]), IMPACT_OK);
            bool found[BOXES] = {false};
            for (int k = 0; k < grid.found_count; k++) {
                assert_false(found[grid.found[k]]); /* once */
                found[grid.found[k]] = true;
            }
            for (int j = 0; j < BOXES; j++) assert_int_equal(found[j], imp_boxes_overlap(&boxes[i], &boxes[j]));
        }
        imp_arena_destroy(arena);
    }
}

/* A point and a box as large as the world have their places too. */
static void the_smallest_and_the_largest(void **state)
{
    (void)state;
    imp_grid grid;
    imp_arena *arena;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    assert_int_equal(imp_grid_open(&grid, arena, 3), IMPACT_OK);
    const imp_box point = {{1, 1, 1}, {1, 1, 1}}, large = {{-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}},
                  aside = {{2, 1, 1}, {2, 1, 1}};
    assert_int_equal(imp_grid_put(&grid, 0, &point), IMPACT_OK);
    assert_int_equal(imp_grid_put(&grid, 1, &large), IMPACT_OK);
    assert_int_equal(imp_grid_put(&grid, 2, &aside), IMPACT_OK);
    assert_int_equal(imp_grid_query(&grid, &point), IMPACT_OK);
    assert_int_equal(grid.found_count, 2);
    assert_int_equal(imp_grid_query(&grid, &large), IMPACT_OK);
    assert_int_equal(grid.found_count, 3);
    imp_arena_destroy(arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_all_that_overlap_and_nothing_else),
        cmocka_unit_test(the_smallest_and_the_largest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
