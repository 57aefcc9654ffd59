/* SPDX-License-Identifier: MIT
 *
 * Impacts that need no contact frame, against the way of all others (the series' door, which sets one up).
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <impact/collide.h>
#include "generators/collide_cases.h"

static void assert_same(const impact_collision *c, const impact_outcome *a, const impact_outcome *b)
{
    const double joule = 4e-15 * (b->energy_before + fabs(b->work_compression)), p = 4e-15 * qvec3_norm(b->impulse);
    assert_true(case_error(c, a->velocity, a->omega, b->velocity, b->omega) < 1e-14);
    assert_true(fabs(a->impulse_normal - b->impulse_normal) <= p);
    assert_true(fabs(a->impulse_tangential - b->impulse_tangential) <= p);
    assert_true(fabs(a->compression_impulse - b->compression_impulse) <= p);
    assert_true(fabs(a->work_compression - b->work_compression) <= joule);
    assert_true(fabs(a->work_restitution - b->work_restitution) <= joule);
    assert_true(fabs(a->work_friction - b->work_friction) <= joule);
    assert_true(fabs(a->energy_before - b->energy_before) <= joule && fabs(a->energy_after - b->energy_after) <= joule);
    assert_true(fabs(a->normal_after - b->normal_after) <= 4e-15 * -b->normal_before);
    assert_int_equal(a->compressions, b->compressions);
    assert_int_equal(a->phase_count, b->phase_count);
    assert_memory_equal(a->phases, b->phases, (size_t)a->phase_count);
    assert_true(a->jammed == b->jammed && a->energy_rose == b->energy_rose);
}

/* Straight down on the body below, spinning about the normal. */
static void put_to_rest(impact_collision *c)
{
    c->normal = (qvec3){0, 0, 2};
    for (int i = 0; i < 2; i++) {
        impact_collider *body = &c->body[i];
        body->offset = (qvec3){0, 0, (i == 0 ? -1 : 1) * qvec3_norm(body->offset)};
        body->velocity = (qvec3){0, 0, i == 0 ? -1 : 0};
        body->omega = (qvec3){0, 0, 1};
    }
}

static void compare(case_class class_, bool sphere)
{
    for (uint64_t i = 0; i < 4000; i++) {
        impact_collision c = case_make(class_, 83, i);
        if (sphere && i % 7 == 0) put_to_rest(&c);
        impact_outcome direct, series;
        assert_int_equal(impact_collide(&c, &direct), IMPACT_OK);
        assert_int_equal(direct.solver, IMPACT_SOLVER_CLOSED_FORM);
        c.solver = IMPACT_SOLVER_SERIES;
        assert_int_equal(impact_collide(&c, &series), IMPACT_OK);
        assert_same(&c, &direct, &series);
        if (sphere && c.friction > 0) assert_true(fabs(direct.conditioning / series.conditioning - 1) < 1e-14);
        if (c.friction == 0) assert_true(direct.conditioning == 1);
    }
}

static void spheres(void **state)
{
    (void)state;
    compare(CASE_SPHERE, true);
}

static void without_friction(void **state)
{
    (void)state;
    compare(CASE_SMOOTH, false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(spheres), cmocka_unit_test(without_friction)};
    return cmocka_run_group_tests_name("impact collide_direct", tests, NULL, NULL);
}
