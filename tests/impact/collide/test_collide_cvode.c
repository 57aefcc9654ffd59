/* SPDX-License-Identifier: MIT
 *
 * CVODE's road: tolerances, friction laws, a workspace used again, and what it refuses. Where none is given its
 * tolerance is 1e-12.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>

#include <impact/collide.h>
#include "generators/collide_cases.h"

static double distance(const impact_collision *c, const impact_outcome *a, const impact_outcome *b)
{
    return case_error(c, a->velocity, a->omega, b->velocity, b->omega);
}

/* The error falls with the tolerance, for both methods. */
static void error_follows_tolerance(void **state)
{
    (void)state;
    const impact_ode_method methods[2] = {IMPACT_ODE_ADAMS, IMPACT_ODE_BDF};
    for (int m = 0; m < 2; m++) {
        double before = INFINITY;
        for (double tolerance = 1e-4; tolerance > 1e-11; tolerance *= 1e-3) {
            impact_collide_workspace *ws;
            assert_int_equal(impact_collide_workspace_create(methods[m], tolerance, &ws), IMPACT_OK);
            double sum = 0;
            for (uint64_t i = 0; i < 60; i++) {
                impact_collision c = case_make(CASE_PLAIN, 73, i);
                impact_outcome exact, o;
                assert_int_equal(impact_collide(&c, &exact), IMPACT_OK);
                c.solver = IMPACT_SOLVER_CVODE;
                c.workspace = ws;
                assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
                sum += distance(&c, &exact, &o) / 60;
            }
            assert_true(impact_collide_workspace_count(ws).rhs_calls > 1000);
            impact_collide_workspace_destroy(ws);
            assert_true(sum < 15 * tolerance && sum < 0.1 * before);
            before = sum;
        }
    }
}

/* A workspace holds nothing of the impacts before. */
static void a_workspace_forgets(void **state)
{
    (void)state;
    impact_collide_workspace *ws;
    assert_int_equal(impact_collide_workspace_create(IMPACT_ODE_ADAMS, 1e-10, &ws), IMPACT_OK);
    impact_outcome first[30], again;
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < 30; k++) {
            const int i = pass == 0 ? k : 29 - k;
            impact_collision c = case_make(CASE_ROD, 79, (uint64_t)i);
            c.solver = IMPACT_SOLVER_CVODE;
            c.workspace = ws;
            assert_int_equal(impact_collide(&c, pass == 0 ? &first[i] : &again), IMPACT_OK);
            if (pass == 1) assert_memory_equal(&again.velocity, &first[i].velocity, sizeof again.velocity);
        }
    impact_collide_workspace_destroy(ws);
}

static double constant(double speed, void *context)
{
    (void)speed;
    return *(const double *)context;
}

/* Stribeck: from mu_0 at rest down to mu_1. */
static double stribeck(double speed, void *context)
{
    (void)context;
    return 0.1 + 0.4 * exp(-speed / 0.5);
}

static double negative(double speed, void *context)
{
    (void)speed, (void)context;
    return -1;
}

static void friction_laws(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 100; i++) {
        impact_collision c = case_make(i % 2 ? CASE_ROD : CASE_PLAIN, 83, i);
        impact_outcome o, law;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        double mu = c.friction;
        c.friction_law = constant;
        c.friction_context = &mu;
        assert_int_equal(impact_collide(&c, &law), IMPACT_OK);
        assert_true(distance(&c, &o, &law) < 1e-10);
        c.friction_law = stribeck;
        assert_int_equal(impact_collide(&c, &law), IMPACT_OK);
        assert_int_equal(law.solver, IMPACT_SOLVER_CVODE);
        assert_true(law.impulse_tangential <= 0.5 * law.impulse_normal * (1 + 1e-14));
        if (c.law != IMPACT_NEWTON) assert_true(law.energy_after <= law.energy_before * (1 + 1e-14));
        c.friction_law = negative;
        assert_true(impact_collide(&c, &law) < 0);
    }
}

/* A sphere that slides throughout: du/dp = -(7/2) mu(u) / m, so int du / mu = -(7/2) p / m. With mu = A u, u = u0
 * exp(-3.5 A p / m). */
static double proportional(double speed, void *context)
{
    (void)context;
    return 0.05 * speed;
}

static void viscous_friction_on_paper(void **state)
{
    (void)state;
    const double j = 0.4 * 0.09;
    impact_collision c = {.body = {{1, {j, j, j}, {1, 0, 0, 0}, {0, 0, -0.3}, {3, 0, -1}, {0, 0, 0}},
                                   {.mass = INFINITY, .orientation = {1, 0, 0, 0}}},
                          .normal = {0, 0, 1},
                          .restitution = 0.5,
                          .friction_law = proportional};
    impact_outcome o;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    const double u = 3 * exp(-3.5 * 0.05 * 1.5);
    assert_true(fabs(o.velocity[0].x - 0.3 * o.omega[0].y - u) < 1e-11);
}

static void refusals(void **state)
{
    (void)state;
    impact_collide_workspace *ws;
    assert_int_equal(impact_collide_workspace_create(IMPACT_ODE_ADAMS, 0, &ws), IMPACT_EARGUMENT);
    assert_null(ws);
    assert_int_equal(impact_collide_workspace_create(IMPACT_ODE_ADAMS, NAN, &ws), IMPACT_EARGUMENT);
    impact_collide_workspace_destroy(NULL);
    impact_collision c = case_make(CASE_PLAIN, 83, 1);
    impact_outcome o;
    char message[200];
    c.friction_law = stribeck;
    c.solver = IMPACT_SOLVER_SERIES;
    assert_int_equal(impact_collide(&c, &o), IMPACT_EARGUMENT);
    c.friction_law = NULL;
    c.tangential_compliance = 1;
    assert_int_equal(impact_collide_check(&c, message, sizeof message), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "needs cvode"));
    c.solver = IMPACT_SOLVER_AUTO;
    c.law = IMPACT_POISSON;
    assert_int_equal(impact_collide_check(&c, message, sizeof message), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "needs stronge"));
    c.tangential_compliance = -1;
    assert_int_equal(impact_collide(&c, &o), IMPACT_EARGUMENT);
    c.tangential_compliance = 0;
    c.series_order = 99;
    assert_int_equal(impact_collide_check(&c, message, sizeof message), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "series_order is 99"));
}

/* A build without CVODE says so. */
static void absent(void **state)
{
    (void)state;
    impact_collide_workspace *ws;
    assert_int_equal(impact_collide_workspace_create(IMPACT_ODE_ADAMS, 1e-9, &ws), IMPACT_EABSENT);
    impact_collision c = case_make(CASE_PLAIN, 83, 1);
    impact_outcome o;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    c.solver = IMPACT_SOLVER_CVODE;
    assert_int_equal(impact_collide(&c, &o), IMPACT_EABSENT);
}

int main(void)
{
    const struct CMUnitTest without[] = {cmocka_unit_test(absent)};
    if (!impact_has(IMPACT_PART_CVODE)) return cmocka_run_group_tests_name("impact collide_cvode", without, NULL, NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_follows_tolerance),
        cmocka_unit_test(a_workspace_forgets),
        cmocka_unit_test(friction_laws),
        cmocka_unit_test(viscous_friction_on_paper),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests_name("impact collide_cvode", tests, NULL, NULL);
}
