/* SPDX-License-Identifier: MIT
 *
 * What a definition may give, and gives by itself: the ends of every range that the headers name are taken, and what
 * lies beyond them by a part in a thousand is refused; the defaults are those that the headers name.
 */
#include <math.h>
#include "kit/scene_log.h"

/* Two balls of 1 m beside each other, of centres one apart of each other by 2 m and some. */
static impact_scene_def balls(impact_body_def bodies[2], double apart)
{
    for (int i = 0; i < 2; i++) {
        bodies[i] = impact_default_body_def();
        bodies[i].name = i ? "right" : "left";
        bodies[i].mass = 1;
        bodies[i].position.x = i * apart;
        assert_int_equal(impact_shape_sphere(1, &bodies[i].shape), IMPACT_OK);
    }
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies, def.body_count = 2;
    return def;
}

static bool is_taken(const impact_scene_def *def)
{
    impact_scene *scene;
    const impact_status status = impact_scene_create(def, &scene, NULL, 0);
    assert_true(status == IMPACT_OK || status == IMPACT_EARGUMENT);
    impact_scene_destroy(scene);
    return status == IMPACT_OK;
}

/* *value, a number of the definition's, may lie in [least, most]; what may not be asked for is NAN. */
static void assert_range(const impact_scene_def *def, double *value, double least, double most)
{
    const double kept = *value;
    if (!isnan(least)) {
        *value = least, assert_true(is_taken(def));
        *value = 0.999 * least, assert_false(is_taken(def));
    }
    if (!isnan(most)) {
        *value = most, assert_true(is_taken(def));
        *value = 1.001 * most, assert_false(is_taken(def));
    }
    *value = kept;
}

static void numbers_of_a_scene_lie_where_its_header_says(void **state)
{
    (void)state;
    impact_body_def bodies[2];
    impact_scene_def def = balls(bodies, 3);
    assert_range(&def, &def.tolerance, 1e-15, 1e-2);
    assert_range(&def, &def.methods.tolerance, 1e-15, 1e-2);
    assert_range(&def, &def.key_tolerance, 1e-14, 1e-2);
    assert_range(&def, &def.pile_tolerance, 1e-9, 1e-2);
    def.duration = 2;
    assert_range(&def, &def.output_rate, NAN, 5e14);
    def.law = IMPACT_STRONGE, def.compliance = 1;
    assert_range(&def, &def.methods.impact_tolerance, 1e-14, 1e-2);
}

static void gap_tolerances_lie_where_the_header_says(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CCD)) skip();
    impact_body_def bodies[2];
    impact_scene_def def = balls(bodies, 3);
    def.methods.gaps = IMPACT_GAP_CCD;
    assert_range(&def, &def.methods.gap_tolerance, 1e-7, 1e-2);
}

/* A plate's largest moment is the others' sum, and a rounding or some more of it; an exponent is 1, or is told from it.
 */
static void numbers_of_a_body_lie_where_it_can_be(void **state)
{
    (void)state;
    impact_body_def bodies[2];
    const impact_scene_def def = balls(bodies, 3);
    bodies[0].moments = (qvec3){1, 2, 3 * (1 + 1e-12)};
    assert_true(is_taken(&def));
    bodies[0].moments.z = 3 * (1 + 3e-12);
    assert_false(is_taken(&def));
    bodies[0].moments = (qvec3){NAN, NAN, NAN};
    const double over[] = {0, 1e-7, 9e-7, 1.1e-6};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(impact_shape_superquadric(1, 1, 1, 1 + over[i], 2, 2, &bodies[0].shape), IMPACT_OK);
        assert_int_equal(is_taken(&def), i == 0 || i == 3);
    }
}

/* By less than 1e-9 of the places' scale, here 2 of radii and some 2 of the place itself; and so where a body is put.
 */
static void bodies_may_overlap_by_nine_digits(void **state)
{
    (void)state;
    impact_body_def bodies[2];
    const double least = 1e-9 * 4, parts[] = {0.99, 1.01};
    for (int i = 0; i < 2; i++) {
        impact_scene_def def = balls(bodies, 2 - parts[i] * least);
        assert_int_equal(is_taken(&def), i == 0);
        bodies[1].position.x = 3;
        impact_scene *scene;
        assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
        bodies[1].position.x = 2 - parts[i] * least;
        impact_sample moved;
        assert_int_equal(impact_scene_body(scene, 1, &moved), IMPACT_OK);
        moved.position.x = 2 - parts[i] * least;
        assert_int_equal(impact_scene_set_state(scene, 1, &moved) == IMPACT_OK, i == 0);
        impact_scene_destroy(scene);
    }
}

static void defaults_are_those_of_the_header(void **state)
{
    (void)state;
    const impact_scene_def def = impact_default_scene_def();
    assert_near(def.tolerance, 1e-13, 0);
    assert_near(def.key_tolerance, 1e-10, 0);
    assert_near(def.pile_tolerance, 1e-3, 0);
    assert_near(def.rest_height, 1e-12, 0);
    assert_near(def.rest_speed, 1e-9, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_of_a_scene_lie_where_its_header_says),
        cmocka_unit_test(gap_tolerances_lie_where_the_header_says),
        cmocka_unit_test(numbers_of_a_body_lie_where_it_can_be),
        cmocka_unit_test(bodies_may_overlap_by_nine_digits),
        cmocka_unit_test(defaults_are_those_of_the_header),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
