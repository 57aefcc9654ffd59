/* SPDX-License-Identifier: MIT
 *
 * What an instant comes to is concluded once; that it is concluded without end, as no known scene has it, has to end
 * with a status, the body and the time.
 */
#include "scene/arrivals.h"
#include "scene/gather.h"
#include "kit/scene_ending.h"

#include <string.h>

/* The ball's island is gathered and concluded once more at t. */
static impact_status conclude_again(impact_scene *scene, int ball, double t)
{
    imp_island *island;
    imp_gather_member(scene, ball);
    assert_int_equal(imp_gather(scene, -1, t, false, &island), IMPACT_OK);
    island->outside = imp_gather_energy_outside(scene, island, t);
    return imp_scene_conclude(island);
}

/* At a later time it is counted from the beginning: twenty instants with ten conclusions each are none too many. */
static void events_without_end_at_one_instant(void **state)
{
    (void)state;
    const impact_body_def bodies[2] = {floor_body(0.5, 0.5), ball_body("ball", (qvec3){0, 0, 0.3}, 0.5, 0.5)};
    const impact_scene_def def = scene_of(bodies, 2, 10);
    impact_scene *scene = make_scene(&def);
    for (int instant = 1; instant <= 20; instant++) {
        assert_true(impact_scene_run_to(scene, 0.01 * instant, NULL) >= 0);
        for (int k = 0; k < 10; k++) assert_int_equal(conclude_again(scene, 1, 0.01 * instant), IMPACT_OK);
    }
    impact_status status = IMPACT_OK;
    for (int k = 0; status == IMPACT_OK && k < 1000; k++) status = conclude_again(scene, 1, 0.2);
    assert_int_equal(status, IMPACT_EUNSETTLED);
    const char *message = impact_scene_message(scene);
    if (!strstr(message, "body 'ball': ") || !strstr(message, "events at the one instant t = 0.2 brought no end"))
        fail_msg("'%s' does not name body and time", message);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_without_end_at_one_instant),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
