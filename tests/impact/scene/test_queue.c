/* SPDX-License-Identifier: MIT
 *
 * The queue against a look through all its times.
 */
#include "scene/queue.h"
#include "kit/contact_random.h"
#include "kit/near.h"

enum { SLOTS = 60, CHANGES = 20000 };

static int first_of(const double *time)
{
    int first = 0;
    for (int i = 1; i < SLOTS; i++)
        if (time[i] < time[first]) first = i;
    return first;
}

/* Few times, so that many are equal: of these the slot of the least number is first. */
static void the_least_time_is_first_after_every_change(void **state)
{
    (void)state;
    random_stream random = {1};
    double time[SLOTS];
    imp_queue queue = {0};
    assert_int_equal(imp_arena_create(NULL, &queue.arena), IMPACT_OK);
    assert_int_equal(imp_queue_first(&queue), -1);
    assert_true(imp_queue_time(&queue) == INFINITY);
    for (int i = 0; i < SLOTS; i++) {
        assert_int_equal(imp_queue_add(&queue), i);
        time[i] = INFINITY;
    }
    for (int k = 0; k < CHANGES; k++) {
        const int slot = (int)(SLOTS * random_unit(&random));
        time[slot] = random_unit(&random) < 0.1 ? INFINITY : floor(20 * random_unit(&random));
        imp_queue_set(&queue, slot, time[slot]);
        assert_int_equal(imp_queue_first(&queue), first_of(time));
        assert_true(imp_queue_time(&queue) == time[first_of(time)]);
    }
    imp_arena_destroy(queue.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_least_time_is_first_after_every_change)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
