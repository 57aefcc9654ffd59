/* SPDX-License-Identifier: MIT
 *
 * The sliding flow as data: convexity, the elementary case, invariant directions and turns of u_z.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <impact/collide.h>
#include "generators/collide_cases.h"

enum { POINTS = 200 };

static double distance(const impact_flow *f, const impact_flow_point *a, const impact_flow_point *b)
{
    const double x = a->velocity[0] - b->velocity[0], y = a->velocity[1] - b->velocity[1];
    return sqrt(x * x / f->a + y * y / f->b);
}

/* Two slips under the same M never part, in the norm of M_tt^-1; u_z turns at most twice before it is straight. */
static void non_expansive_and_few_turns(void **state)
{
    (void)state;
    int most = 0;
    for (uint64_t i = 0; i < 3000; i++) {
        const impact_collision c = case_make(i % 2 ? CASE_ROD : CASE_PLAIN, 37, i);
        impact_flow flow;
        double u[3];
        assert_int_equal(impact_flow_make(&c, &flow, u), IMPACT_OK);
        const double v[3] = {-0.3 * u[0] + 0.1 * u[1], u[1] - 0.8 * u[0], u[2]};
        impact_flow_point one[POINTS], two[POINTS];
        const double p_end =
            3 * fabs(u[2]) / flow.m + 2 * hypot(u[0], u[1]) / ((0.1 + c.friction) * fmin(flow.a, flow.b));
        assert_int_equal(impact_flow_sample(&flow, u, p_end, POINTS, one), IMPACT_OK);
        assert_int_equal(impact_flow_sample(&flow, v, p_end, POINTS, two), IMPACT_OK);
        const double start = distance(&flow, &one[0], &two[0]),
                     rounding = 1e-14 * (start + hypot(u[0], u[1]) / sqrt(fmin(flow.a, flow.b)));
        int turns = 0;
        for (int k = 1; k < POINTS; k++) {
            assert_true(distance(&flow, &one[k], &two[k]) <= distance(&flow, &one[k - 1], &two[k - 1]) + 10 * rounding);
            if (k < 2) continue;
            const double before = one[k - 1].velocity[2] - one[k - 2].velocity[2],
                         after = one[k].velocity[2] - one[k - 1].velocity[2];
            const double tiny = 1e-12 * (fabs(one[k].velocity[2]) + fabs(u[2]));
            turns += (before > tiny && after < -tiny) || (before < -tiny && after > tiny);
        }
        assert_true(turns <= 3);
        most = turns > most ? turns : most;
    }
    assert_true(most >= 1);
}

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
        assert_true(fabs(points[1].velocity[0] - (x * cos(turn) - y * sin(turn))) < 1e-13);
        assert_true(fabs(points[1].velocity[1] - (x * sin(turn) + y * cos(turn))) < 1e-13);
        assert_true(fabs(points[1].speed - (A + B) / 2) < 1e-13);
    }
}

/* Four directions iff |c|^2/3 + |d|^2/3 < (mu |a - b|)^2/3, else two; half of them attract. */
static void directions_four_or_two(void **state)
{
    (void)state;
    uint64_t g = 43;
    int four = 0, two = 0;
    for (int i = 0; i < 5000; i++) {
        const double a = 0.2 + case_random(&g), b = 0.2 + case_random(&g), mu = 3 * case_random(&g),
                     f = pow(10, -3 * case_random(&g));
        const impact_flow flow = {
            .a = a, .b = b, .c = f * (case_random(&g) - 0.5), .d = f * (case_random(&g) - 0.5), .m = 4, .friction = mu};
        const double astroid = cbrt(flow.c * flow.c) + cbrt(flow.d * flow.d) - cbrt(mu * mu * (a - b) * (a - b));
        impact_flow_direction found[4];
        const int n = impact_flow_directions(&flow, found);
        if (fabs(astroid) < 1e-9) continue;
        assert_int_equal(n, astroid < 0 ? 4 : 2);
        int attract = 0, grow = 0;
        for (int k = 0; k < n; k++) {
            const double x = cos(found[k].theta), y = sin(found[k].theta);
            assert_true(fabs(-flow.c * y + flow.d * x + mu * (a - b) * x * y) < 1e-14);
            assert_true(fabs(found[k].rate - (flow.c * x + flow.d * y - mu * (a * x * x + b * y * y))) < 1e-14);
            assert_true(fabs(found[k].climb - (flow.m - mu * (flow.c * x + flow.d * y))) < 1e-14);
            attract += found[k].pull < 0;
            grow += found[k].rate > 0;
        }
        assert_int_equal(attract, n / 2);
        assert_int_equal(grow, hypot(flow.c / a, flow.d / b) > mu);
        four += n == 4;
        two += n == 2;
    }
    assert_true(four > 500 && two > 500);
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
    impact_flow_direction directions[4];
    assert_int_equal(impact_flow_directions(&flow, directions), 0);
    flow = (impact_flow){.a = 1, .b = 1, .m = 1, .friction = 0.3};
    assert_int_equal(impact_flow_directions(&flow, directions), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(non_expansive_and_few_turns),
        cmocka_unit_test(elementary_when_a_is_b),
        cmocka_unit_test(directions_four_or_two),
        cmocka_unit_test(directions_on_the_axes),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests_name("impact collide_flow", tests, NULL, NULL);
}
