/* SPDX-License-Identifier: MIT
 *
 * Straight pieces and laws of restitution: sticking, the one direction of a restart, and Newton's gain.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "collide_course.h"
#include "generators/collide_cases.h"

static bool frame_of(const impact_collision *c, impact_frame *f)
{
    impact_ready ready[2];
    for (int k = 0; k < 2; k++) impact_ready_make(&c->body[k], &ready[k]);
    impact_frame_make(impact_frame_normal(c), ready, f);
    return f->conditioning < 1e6;
}

/* Friction holds iff |M_tt^-1 M_tz| <= mu; otherwise the restart is an invariant direction with R > 0, the only one, and Z > mu R. */
static void stick_or_the_one_direction(void **state)
{
    (void)state;
    int sticks = 0, restarts = 0;
    for (uint64_t i = 0; i < 20000; i++) {
        const impact_collision c = case_make(i % 2 ? CASE_ROD : CASE_PLAIN, 11, i);
        impact_frame f;
        const double mu = 0.3 * c.friction;
        if (!frame_of(&c, &f) || mu == 0) continue;
        const impact_line line = impact_course_from_rest(&f, mu);
        const double need = hypot(f.c / f.a, f.d / f.b);
        assert_int_equal(line.stick, need <= mu);
        if (line.stick) {
            sticks++;
            /* The impulse (gx, gy, 1) leaves u_t where it is. */
            assert_true(fabs(f.a * line.gx + f.c) < 1e-15 * (f.a + 1) && fabs(f.b * line.gy + f.d) < 1e-15 * (f.b + 1));
            assert_true(line.Z > 0 && hypot(line.gx, line.gy) <= mu * (1 + 1e-15));
            continue;
        }
        restarts++;
        const double x = -line.gx / mu, y = -line.gy / mu;
        assert_true(fabs(x * x + y * y - 1) < 1e-14);
        assert_true(line.R >= 0);
        assert_true(fabs(impact_course_turning(&f, mu, x, y)) < 1e-14 * (1 + mu) * (f.a + f.b + 1));
        const impact_line same = impact_course_sliding(&f, mu, x, y);
        assert_true(fabs(same.R - line.R) < 1e-13 * (1 + mu * (f.a + f.b)));
        assert_true(fabs(same.Z - line.Z) < 1e-13 * (1 + mu * mu * (f.a + f.b)));
        assert_true(line.Z > mu * line.R);
        /* No other invariant direction has R > 0: scan the circle for sign changes of T. */
        int leaving = 0;
        const int cells = 2000;
        for (int k = 0; k < cells && i < 2000; k++) {
            const double t = 6.283185307179586 * k / cells, u = 6.283185307179586 * (k + 1) / cells;
            const bool root = (impact_course_turning(&f, mu, cos(t), sin(t)) < 0) !=
                              (impact_course_turning(&f, mu, cos(u), sin(u)) < 0);
            leaving += root && impact_course_sliding(&f, mu, cos(t), sin(t)).R > 1e-3 &&
                       impact_course_sliding(&f, mu, cos(u), sin(u)).R > 1e-3;
        }
        assert_true(leaving <= 1);
    }
    assert_true(sticks > 1000 && restarts > 1000);
}

/* xi' M xi = Z - mu R > 0 for every direction, so Z <= 0 means R < 0. */
static void a_jam_runs_into_a_stop(void **state)
{
    (void)state;
    int jams = 0;
    for (uint64_t i = 0; i < 20000; i++) {
        const impact_collision c = case_make(CASE_WILD, 13, i);
        impact_frame f;
        if (!frame_of(&c, &f)) continue;
        for (int k = 0; k < 12; k++) {
            const double t = 6.283185307179586 * k / 12, x = cos(t), y = sin(t), mu = c.friction;
            const impact_line line = impact_course_sliding(&f, mu, x, y);
            const double form = 1 - 2 * mu * (f.c * x + f.d * y) + mu * mu * (f.a * x * x + f.b * y * y);
            assert_true(fabs(line.Z - mu * line.R - form) <= 1e-14 * (1 + mu + mu * mu) * (1 + f.a + f.b));
            assert_true(form > 0);
            if (line.Z > 0) continue;
            jams++;
            assert_true(line.R < 0);
        }
    }
    assert_true(jams > 100);
}

/* Kane's rod: thin, at 55 degrees, eps = 1, mu = 0.5, v = (-1, 0, -1). Newton's law gains 10.4 %; the two others do not gain. */
static void newton_gains_on_a_rod(void **state)
{
    (void)state;
    const double angle = 55 * acos(-1) / 180, half = 1, m = 1, j = m * half * half / 3;
    impact_collision c = {
        .body = {{m, {j, j, 1e-9}, {1, 0, 0, 0}, {half * cos(angle), 0, -half * sin(angle)}, {-1, 0, -1}, {0, 0, 0}},
                 {.mass = INFINITY, .orientation = {1, 0, 0, 0}}},
        .normal = {0, 0, 1},
        .friction = 0.5,
        .restitution = 1,
        .law = IMPACT_NEWTON};
    impact_outcome o;
    double least = INFINITY, most = -INFINITY;
    for (int side = -1; side <= 1; side += 2) {
        c.body[0].offset.x = side * half * cos(angle);
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        const double gain = o.energy_after / o.energy_before - 1;
        least = fmin(least, gain);
        most = fmax(most, gain);
        assert_int_equal(o.energy_rose, gain > 1e-12);
    }
    assert_true(fabs(most - 0.104) < 5e-4);
    for (int law = 0; law < 2; law++)
        for (int side = -1; side <= 1; side += 2) {
            c.law = law ? IMPACT_STRONGE : IMPACT_POISSON;
            c.body[0].offset.x = side * half * cos(angle);
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            assert_true(o.energy_after <= o.energy_before * (1 + 1e-15));
            assert_false(o.energy_rose);
        }
}

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
        cmocka_unit_test(stick_or_the_one_direction),
        cmocka_unit_test(a_jam_runs_into_a_stop),
        cmocka_unit_test(newton_gains_on_a_rod),
        cmocka_unit_test(laws_end_where_they_say),
    };
    return cmocka_run_group_tests_name("impact collide_course", tests, NULL, NULL);
}
