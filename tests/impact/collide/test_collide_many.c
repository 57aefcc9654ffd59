/* SPDX-License-Identifier: MIT
 *
 * Many impacts in one call: the same bits as one by one, for any number of threads.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include <impact/collide.h>
#include "generators/collide_cases.h"

enum { COUNT = 20000 };

static void same_bits_on_any_number_of_threads(void **state)
{
    (void)state;
    impact_collision *c = calloc(COUNT, sizeof *c);
    impact_outcome *single = calloc(COUNT, sizeof *single), *many = calloc(COUNT, sizeof *many);
    impact_status *statuses = calloc(COUNT, sizeof *statuses);
    assert_true(c && single && many && statuses);
    for (int i = 0; i < COUNT; i++) {
        c[i] = case_make((case_class)(i % CASE_CLASSES), 47, (uint64_t)i);
        if (i % 500 == 0 && impact_has(IMPACT_PART_CVODE)) c[i].solver = IMPACT_SOLVER_CVODE;
        assert_int_equal(impact_collide(&c[i], &single[i]), IMPACT_OK);
    }
    const int threads[] = {1, 2, 3, 7, 0};
    for (int t = 0; t < 5; t++) {
        memset(many, 0, COUNT * sizeof *many);
        assert_int_equal(impact_collide_many(c, COUNT, threads[t], many, statuses), IMPACT_OK);
        for (int i = 0; i < COUNT; i++) {
            assert_memory_equal(many[i].velocity, single[i].velocity, sizeof single[i].velocity);
            assert_memory_equal(many[i].omega, single[i].omega, sizeof single[i].omega);
            assert_memory_equal(&many[i].impulse, &single[i].impulse, sizeof single[i].impulse);
            assert_int_equal(statuses[i], IMPACT_OK);
        }
    }
    /* The first failure is told; the others are solved. */
    c[15000].body[0].mass = NAN;
    c[12345].friction = -1;
    assert_int_equal(impact_collide_many(c, COUNT, 4, many, statuses), IMPACT_EARGUMENT);
    assert_int_equal(statuses[15000], IMPACT_EDOMAIN);
    assert_int_equal(statuses[12345], IMPACT_EARGUMENT);
    assert_int_equal(statuses[12346], IMPACT_OK);
    assert_int_equal(impact_collide_many(c, COUNT, -1, many, NULL), IMPACT_EARGUMENT);
    assert_int_equal(impact_collide_many(c, 0, 4, many, NULL), IMPACT_OK);
    free(c);
    free(single);
    free(many);
    free(statuses);
}

static double stribeck(double speed, void *context)
{
    (void)context;
    return 0.1 + 0.4 * exp(-speed / 0.5);
}

/* Friction laws are called from all threads, and a workspace is a pattern for each thread's own. */
static void cvode_in_threads(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    enum { FEW = 300 };
    static impact_collision c[FEW];
    static impact_outcome single[FEW], many[FEW];
    impact_collide_workspace *workspace;
    assert_int_equal(impact_collide_workspace_create(IMPACT_ODE_BDF, 1e-8, &workspace), IMPACT_OK);
    for (int i = 0; i < FEW; i++) {
        c[i] = case_make((case_class)(i % CASE_CLASSES), 53, (uint64_t)i);
        c[i].solver = IMPACT_SOLVER_CVODE;
        c[i].friction_law = i % 3 ? stribeck : NULL;
        c[i].workspace = i % 2 ? workspace : NULL;
        assert_int_equal(impact_collide(&c[i], &single[i]), IMPACT_OK);
    }
    const long calls = impact_collide_workspace_count(workspace).rhs_calls;
    for (int threads = 1; threads < 5; threads++) {
        assert_int_equal(impact_collide_many(c, FEW, threads, many, NULL), IMPACT_OK);
        for (int i = 0; i < FEW; i++) {
            assert_memory_equal(many[i].velocity, single[i].velocity, sizeof single[i].velocity);
            assert_memory_equal(many[i].omega, single[i].omega, sizeof single[i].omega);
        }
    }
    assert_int_equal(impact_collide_workspace_count(workspace).rhs_calls, calls);
    impact_collide_workspace_destroy(workspace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_bits_on_any_number_of_threads),
                                       cmocka_unit_test(cvode_in_threads)};
    return cmocka_run_group_tests_name("impact collide_many", tests, NULL, NULL);
}
