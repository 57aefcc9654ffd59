/* SPDX-License-Identifier: MIT
 *
 * A ball that meets another like it comes to rest on it by the impulse 1/2. Of one that is a part more what it leaves
 * is taken away, as long as that is rounding, or within the residual that the answer is right to; else it is none.
 */
#include "contact/encounter.h"
#include "kit/near.h"

static const impact_collider balls[] = {{.mass = 1, .moments = {1, 1, 1}, .orientation = {1, 0, 0, 0}},
                                        {.mass = 1, .moments = {1, 1, 1}, .orientation = {1, 0, 0, 0}}};

/* The velocity that is left. */
static double mended(double more, double residual)
{
    const impact_meeting meeting = {.body2 = 1, .normal = {1, 0, 0}, .offset1 = {-1, 0, 0}, .offset2 = {1, 0, 0}};
    const impact_encounter e = {.bodies = balls, .body_count = 2, .meetings = &meeting, .meeting_count = 1};
    const imp_contact contact = imp_encounter_contact(&e, 0, false);
    const double w[9] = {2, 0, 0, 0, 0, 0, 0, 0, 0}, u0[3] = {-1, 0, 0}, after[3] = {0, 0, 0};
    double p[3] = {0.5 * (1 + more), 0, 0}, u[3];
    qvec3 velocity[2] = {{-1, 0, 0}, {0, 0, 0}}, omega[2] = {{0, 0, 0}, {0, 0, 0}};
    const imp_group group = {
        .count = 1, .contacts = &contact, .w = w, .u0 = u0, .bodies = balls, .velocity = velocity, .omega = omega};
    impact_together_workspace *workspace;
    assert_int_equal(impact_together_workspace_create(NULL, &workspace), IMPACT_OK);
    assert_true(imp_block_clear(workspace->arena, &workspace->work, 10000));
    imp_encounter_push(&group, p);
    imp_encounter_mend(&group, after, residual, p, workspace);
    imp_encounter_look(&group, u);
    assert_near(p[0], 0.5 * (1 + u[0]), 1e-15);
    impact_together_workspace_destroy(workspace);
    return u[0];
}

static void rounding_is_taken_away(void **state)
{
    (void)state;
    assert_near(mended(1e-14, 0), 0, 3e-16);
    assert_near(mended(1e-13, 0), 1e-13, 1e-15);
}

static void what_the_residual_leaves_is_taken_away(void **state)
{
    (void)state;
    assert_near(mended(1e-9, 1e-9), 0, 3e-16);
    assert_near(mended(1e-8, 1e-9), 1e-8, 1e-15);
}

/* Of answers that are not to be used nothing is. */
static void wrong_modes_are_not_mended(void **state)
{
    (void)state;
    assert_near(mended(1e-6, 1), 0, 3e-16);
    assert_near(mended(1e-5, 1), 1e-5, 1e-15);
}

/* Of answers as good as are accepted. */
static void what_is_accepted_is_left(void **state)
{
    (void)state;
    assert_near(mended(5e-14, 9e-14), 5e-14, 1e-15);
    assert_near(mended(5e-14, 2e-13), 0, 3e-16);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rounding_is_taken_away), cmocka_unit_test(what_the_residual_leaves_is_taken_away),
        cmocka_unit_test(wrong_modes_are_not_mended), cmocka_unit_test(what_is_accepted_is_left)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
