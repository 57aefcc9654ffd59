/* SPDX-License-Identifier: MIT
 *
 * How far the answer follows its data: a case on paper, and random cases against changes of another size and direction.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <impact/collide.h>
#include "generators/collide_cases.h"

static const impact_collider floor_body = {.mass = INFINITY, .orientation = {1, 0, 0, 0}};

/* A ball of unit mass falls straight down: v = eps u. Against the changes of u and of eps the answer moves by 0 or by
 * 2; n at unit length does not follow a change along itself. */
static void a_ball_on_paper(void **state)
{
    (void)state;
    const impact_collision c = {.body = {{1, {1, 1, 1}, {1, 0, 0, 0}, {0, 0, -1}, {0, 0, -1}, {0, 0, 0}}, floor_body},
                                .normal = {0, 0, 1},
                                .restitution = 0.5};
    const double s = impact_collide_sensitivity(&c);
    assert_true(s > 1.99 && s < 4.01);
    impact_collision stops = c;
    stops.body[0].velocity.z = 0;
    assert_true(impact_collide_sensitivity(&stops) == 0);
}

/* Thrown down so that it comes nearly to rest, it follows its data by what is left of the velocity. */
static void what_nearly_stops(void **state)
{
    (void)state;
    const impact_collision c = {
        .body = {{1, {1, 1, 1}, {1, 0, 0, 0}, {0, -0.6, -0.8}, {1e-6, -0.75, -1}, {0, 0, 0}}, floor_body},
        .normal = {0, 0.6, 0.8},
        .restitution = 0};
    const double s = impact_collide_sensitivity(&c);
    assert_true(s > 1e5 && s < 1e7);
}

static void refused(void **state)
{
    (void)state;
    const impact_collision c = {.body = {{-1, {1, 1, 1}, {1, 0, 0, 0}, {0}, {0}, {0}}, floor_body},
                                .normal = {0, 0, 1}};
    assert_true(isnan(impact_collide_sensitivity(&c)));
}

static double distance(const impact_collision *c, const impact_outcome *a, const impact_outcome *b)
{
    return case_error(c, a->velocity, a->omega, b->velocity, b->omega);
}

/* One number at a time, by 1e-9 of itself: never moves the answer much further than all of them at random. */
static void random_impacts(void **state)
{
    (void)state;
    int far = 0, count = 0;
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 60; i++) {
            const impact_collision c = case_make((case_class)class_, 71, i);
            impact_outcome o, other;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            const double s = impact_collide_sensitivity(&c);
            assert_true(s > 0 && isfinite(s));
            impact_collision d = c;
            double *const numbers[] = {&d.body[0].velocity.x, &d.body[1].omega.y, &d.body[0].offset.z, &d.friction};
            double *const number = numbers[i % 4];
            *number *= 1 + 1e-9;
            assert_int_equal(impact_collide(&d, &other), IMPACT_OK);
            far += distance(&c, &other, &o) > 3 * 1e-9 * s;
            count++;
        }
    assert_true(100 * far <= count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_ball_on_paper), cmocka_unit_test(what_nearly_stops),
                                       cmocka_unit_test(refused), cmocka_unit_test(random_impacts)};
    return cmocka_run_group_tests_name("impact collide_sensitivity", tests, NULL, NULL);
}
