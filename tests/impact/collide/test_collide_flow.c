/* SPDX-License-Identifier: MIT
 *
 * The sliding flow as data: the elementary case, directions on the axes, what is refused. More of it:
 * test_collide_facts.c.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <impact/collide.h>
#include "generators/collide_cases.h"

/* a = b: s + u_x and s - u_x decay on their own, with e = |M_tz| and x along M_tz: u_x + s = A exp((e - mu a) tau),
 * s - u_x = B exp(-(e + mu a) tau), p their integral / 2. */
static void elementary_when_a_is_b(void **state)
{
    (void)state;
    uint64_t g = 41;
    for (int i = 0; i < 2000; i++) {
        const double e = 2 * case_random(&g), mu = 0.05 + case_random(&g), a = 0.5 + 2 * case_random(&g),
                     m = e * e / a * 1.1 + 0.5;
        const double turn = 6.283185307179586 * case_random(&g), theta = 6.283185307179586 * case_random(&g);
        const impact_flow flow = {.a = a, .b = a, .c = e * cos(turn), .d = e * sin(turn), .m = m, .friction = mu};
        const double tau = 1.5 * case_random(&g) / (e + mu * a);
        const double A = (1 + cos(theta)) * exp((e - mu * a) * tau), B = (1 - cos(theta)) * exp(-(e + mu * a) * tau);
        const double p = (1 + cos(theta)) * expm1((e - mu * a) * tau) / (e - mu * a) / 2 -
                         (1 - cos(theta)) * expm1(-(e + mu * a) * tau) / (e + mu * a) / 2;
        const double x = (A - B) / 2, y = sin(theta) * exp(-mu * a * tau);
        if (fabs(e - mu * a) < 1e-3) continue;
        const double u[3] = {cos(theta + turn), sin(theta + turn), -1};
        impact_flow_point points[2];
        assert_int_equal(impact_flow_sample(&flow, u, p, 2, points), IMPACT_OK);
        assert_true(fabs(points[1].velocity[0] - (x * cos(turn) - y * sin(turn))) < 1e-14);
        assert_true(fabs(points[1].velocity[1] - (x * sin(turn) + y * cos(turn))) < 1e-14);
        assert_true(fabs(points[1].speed - (A + B) / 2) < 1e-14);
    }
}

/* On the axes, where c = d = 0. */
static void directions_on_the_axes(void **state)
{
    (void)state;
    const impact_flow flow = {.a = 4, .b = 1, .m = 2, .friction = 0.5};
    impact_flow_direction found[4];
    assert_int_equal(impact_flow_directions(&flow, found), 4);
    for (int k = 0; k < 4; k++) {
        assert_true(fabs(sin(2 * found[k].theta)) < 1e-14);
        assert_true(k == 0 || found[k].theta > found[k - 1].theta);
        assert_true((found[k].pull < 0) == (fabs(cos(found[k].theta)) < 0.5));
    }
}

static void bad_input(void **state)
{
    (void)state;
    const impact_flow good = {.a = 1, .b = 2, .c = 0.1, .d = 0.1, .m = 1, .friction = 0.3};
    const double u[3] = {1, 0, -1}, bad[3] = {NAN, 0, 0};
    impact_flow_point points[4];
    impact_flow flow = good;
    assert_int_equal(impact_flow_sample(&flow, bad, 1, 4, points), IMPACT_EDOMAIN);
    assert_int_equal(impact_flow_sample(&flow, u, -1, 4, points), IMPACT_EARGUMENT);
    assert_int_equal(impact_flow_sample(&flow, u, 1, 1, points), IMPACT_EARGUMENT);
    flow.c = 2; /* not positive definite */
    assert_int_equal(impact_flow_sample(&flow, u, 1, 4, points), IMPACT_EARGUMENT);
    const impact_flow others[] = {
        {.a = 1, .b = 2, .m = -1, .friction = 0.3}, {.a = -1, .b = 2, .m = 1, .friction = 0.3},
        {.a = 1, .b = -2, .m = 1, .friction = 0.3}, {.a = INFINITY, .b = 2, .m = 1, .friction = 0.3},
        {.a = 1, .b = 2, .m = 1, .friction = -0.3}, {.a = 1, .b = 2, .m = 1, .friction = INFINITY}};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        assert_int_equal(impact_flow_sample(&others[k], u, 1, 4, points), IMPACT_EARGUMENT);
    assert_int_equal(impact_flow_sample(&good, u, INFINITY, 4, points), IMPACT_EARGUMENT);
    impact_flow_direction directions[4];
    assert_int_equal(impact_flow_directions(&flow, directions), 0);
    flow = (impact_flow){.a = 1, .b = 1, .m = 1, .friction = 0.3};
    assert_int_equal(impact_flow_directions(&flow, directions), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elementary_when_a_is_b),
        cmocka_unit_test(directions_on_the_axes),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests_name("impact collide_flow", tests, NULL, NULL);
}
