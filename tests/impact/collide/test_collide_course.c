/* SPDX-License-Identifier: MIT
 *
 * The laws of restitution.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <impact/collide.h>
#include "generators/collide_cases.h"

/* Each law ends where it says. */
static void laws_end_where_they_say(void **state)
{
    (void)state;
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 2000; i++) {
            const impact_collision c = case_make((case_class)class_, 17, i);
            impact_outcome o;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            const double p = o.impulse_normal, e = c.restitution;
            if (c.law == IMPACT_POISSON) assert_true(fabs(p - (1 + e) * o.compression_impulse) <= 4e-15 * p);
            if (c.law == IMPACT_NEWTON)
                assert_true(fabs(o.normal_after + e * o.normal_before) <= 4e-15 * fabs(o.normal_before));
            if (c.law == IMPACT_STRONGE && o.compressions == 1)
                assert_true(fabs(o.work_restitution + e * e * o.work_compression) <= 4e-14 * -o.work_compression);
            assert_true(o.normal_after >= 0 && o.work_friction <= 0 && o.work_compression <= 0 &&
                        o.work_restitution >= 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(laws_end_where_they_say),
    };
    return cmocka_run_group_tests_name("impact collide_course", tests, NULL, NULL);
}
