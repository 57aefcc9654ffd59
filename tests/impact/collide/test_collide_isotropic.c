/* SPDX-License-Identifier: MIT
 *
 * Turning slip with a = b in closed form: against the series over random M, on paper, and where a and b are equal but
 * for rounding.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <float.h>
#include <string.h>

#include "collide/collide_isotropic.h"
#include "collide/collide_series.h"
#include "generators/collide_cases.h"

static double decades(uint64_t *g, double low, double high) { return pow(10, low + (high - low) * case_random(g)); }

/* M = [[a, 0, c], [0, a, d], [c, d, 1]], |M_tz| the part `share` < 1 of what keeps it positive definite. */
static imp_frame frame_of(double a, double share, double angle)
{
    const double g = share * sqrt(a), c = g * cos(angle), d = g * sin(angle);
    return (imp_frame){.a = a,
                       .b = a,
                       .c = c,
                       .d = d,
                       .schur = a,
                       .k = 1 - share * share,
                       .alpha = -c / a,
                       .beta = -d / a,
                       .scale = 1};
}

static imp_course solved(const imp_frame *f, const impact_collision *c, double ux, double uy, bool series)
{
    imp_course course;
    imp_course_start(&course, f, c, ux, uy);
    if (series)
        assert_true(imp_series_solve(&course, IMP_SERIES_ORDER));
    else
        imp_isotropic_solve(&course);
    assert_true(course.ended);
    return course;
}

static void assert_near(const char *what, double x, double wanted, double size, double tolerance)
{
    if (fabs(x - wanted) <= tolerance * size) return;
    fail_msg("%s is %.17g, wanted %.17g; off by %.3g of %.3g", what, x, wanted, fabs(x - wanted) / size, tolerance);
}

static void assert_same_course(const imp_course *one, const imp_course *two)
{
    const double size = two->p, work = fabs(two->work_c) + two->work_r;
    assert_near("p", one->p, two->p, size, 1e-12);
    assert_near("px", one->px, two->px, size * (1 + one->mu), 1e-12);
    assert_near("py", one->py, two->py, size * (1 + one->mu), 1e-12);
    assert_near("uz", one->uz, two->uz, 1 + fabs(two->uz), 1e-12);
    assert_near("p_c", one->p_c, two->p_c, size, 1e-12);
    assert_near("work_c", one->work_c, two->work_c, work, 1e-12);
    assert_near("work_r", one->work_r, two->work_r, work, 1e-12);
    assert_near("work_f", one->work_f, two->work_f, work - two->work_f, 1e-12);
    assert_int_equal(one->compressions, two->compressions);
}

/* As in collide_isotropic.c, in long double: s = X e^(alpha tau) + Y e^(-beta tau). */
typedef long double wide;
typedef struct whirl {
    wide g, mu, alpha, beta, X, Y;
} whirl;

static whirl whirl_of(const imp_frame *f, double mu, double ux, double uy)
{
    const wide c = f->c, d = f->d, g = hypotl(c, d), along = (c * ux + d * uy) / g, across = (c * uy - d * ux) / g;
    const wide large = (hypotl(ux, uy) + fabsl(along)) / 2, small = across * across / (4 * large);
    const bool with = along > 0;
    return (whirl){g, mu, g - mu * f->a, g + mu * f->a, with ? large : small, with ? small : large};
}

/* How far uz falls while it is negative for the first time, from its top to where sliding stops; 0: nothing of it. */
static double fall_of(const whirl *w)
{
    const wide X = (1 - w->mu * w->g) * w->X, Y = (1 + w->mu * w->g) * w->Y;
    if (X >= 0) return 0;
    const wide top = fmaxl(logl(Y / -X) / (2 * w->g), 0);
    const wide rise = X * expm1l(w->alpha * top) / w->alpha - Y * expm1l(-w->beta * top) / w->beta;
    return rise >= 1 ? 0 : (double)(X * expl(w->alpha * top) / w->alpha - Y * expl(-w->beta * top) / w->beta);
}

/* The least s of sliding that does not stop. */
static double least_speed(const whirl *w)
{
    const wide turn = logl(w->beta * w->Y / (w->alpha * w->X)) / (w->alpha + w->beta);
    return (double)(w->X * expl(w->alpha * turn) * (1 + w->alpha / w->beta));
}

/* Sliding starts in any direction, along M_tz and against it too but for very little; friction from hardly any to much;
 * alpha of either sign and nearly 0; every law. */
static void as_the_series(void **state)
{
    (void)state;
    uint64_t g = 5;
    int sticks = 0, slips = 0, jams = 0, again = 0;
    for (int i = 0; i < 60000; i++) {
        const double share = i % 5 == 0 ? decades(&g, -12, -1) : 0.95 * case_random(&g);
        const double angle = 7 * case_random(&g), a = decades(&g, -0.5, 1);
        const imp_frame f = frame_of(a, share, angle);
        impact_collision c = {.law = (impact_law)(i % 3)};
        c.friction = i % 7 == 0 ? hypot(f.c, f.d) / f.a * (1 + 1e-9 * (case_random(&g) - 0.5)) : decades(&g, -3, 2);
        c.restitution = i % 10 == 0 ? 0 : i % 10 == 1 ? 1 : case_random(&g);
        const double along = atan2(f.d, f.c), aside = i % 11 == 0 ? decades(&g, -12, -1) : 6.28 * case_random(&g);
        const double theta = along + aside + (i % 2) * 3.14159265358979, s = decades(&g, -4, 4);
        const imp_course one = solved(&f, &c, s * cos(theta), s * sin(theta), false),
                         two = solved(&f, &c, s * cos(theta), s * sin(theta), true);
        assert_same_course(&one, &two);
        /* A jam, however small, is seen as soon as uz = -1 shows it; compressed again is a jam too. */
        const whirl w = whirl_of(&f, c.friction, s * cos(theta), s * sin(theta));
        const double fall = fall_of(&w);
        const bool jams_plainly = fall > 4 * DBL_EPSILON || one.compressions > 1;
        if (jams_plainly || fall == 0) {
            assert_int_equal(one.jammed, jams_plainly);
            assert_int_equal(two.jammed, jams_plainly);
        }
        /* Sliding that turns past u_t = 0 by a hair: the series takes that for a reversal. */
        if (memchr(two.phases, IMPACT_REVERSAL, (size_t)two.phase_count)) {
            assert_true(w.alpha > 0 && least_speed(&w) < 1e-16 * s);
            continue;
        }
        assert_int_equal(one.phase_count, two.phase_count);
        assert_memory_equal(one.phases, two.phases, (size_t)one.phase_count);
        const unsigned char last = one.phases[one.phase_count - 1];
        sticks += last == IMPACT_STICK_C || last == IMPACT_STICK_R;
        slips += last == IMPACT_SLIP_C || last == IMPACT_SLIP_R;
        jams += one.jammed;
        again += one.compressions > 1;
    }
    assert_true(sticks > 1000 && slips > 1000 && jams > 1000 && again > 0);
}

/* mu a = g: alpha = 0, and s = X + Y e^(-2 g tau): sliding across M_tz at first neither stops nor grows without end.
 * With X = Y = 1/2, q = 1 - e^(-2 g tau), mu = 1/2, g = 1/4: uz = -1 + (7/16) tau + (9/8) q and s = 1 - q / 2, u_y =
 * sqrt(1 - q). */
static void neither_growing_nor_stopping(void **state)
{
    (void)state;
    const imp_frame f = {.a = 0.5, .b = 0.5, .c = 0.25, .schur = 0.5, .k = 0.875, .alpha = -0.5, .scale = 1};
    const impact_collision c = {.friction = 0.5};
    const imp_course o = solved(&f, &c, 0, 1, false);
    double tau = 1;
    for (int i = 0; i < 50; i++)
        tau -= (-1 + 0.4375 * tau - 1.125 * expm1(-0.5 * tau)) / (0.4375 + 0.5625 * exp(-0.5 * tau));
    const double q = -expm1(-0.5 * tau);
    assert_near("p", o.p, 0.5 * tau + q, 1, 4 * DBL_EPSILON);
    assert_near("px", o.px, -0.5 * (0.5 * tau - q), 1, 4 * DBL_EPSILON);
    assert_near("py", o.py, -2 * (1 - sqrt(1 - q)), 1, 4 * DBL_EPSILON);
    /* Energy: u_t . M_tt^-1 u_t / 2 and so on, by the change of u. */
    const double ux = q / 2, uy = sqrt(1 - q), w = -0.25 / 0.5 * ux;
    const double before = 0.5 * (1 / 0.5 + 1 / 0.875), after = 0.5 * ((ux * ux + uy * uy) / 0.5 + w * w / 0.875);
    assert_near("work", o.work_c + o.work_f, after - before, before, 4 * DBL_EPSILON);
    assert_int_equal(o.phase_count, 1);
    assert_int_equal(o.phases[0], IMPACT_SLIP_C);
}

/* Equal to the last bit or but for rounding: both roads answer alike, and which is taken does not show in
 * the answer. */
static void equal_but_for_rounding(void **state)
{
    (void)state;
    int closed = 0, series = 0;
    for (uint64_t i = 0; i < 6000; i++) {
        impact_collision c = case_make(CASE_ISOTROPIC, 23, i);
        if (c.friction == 0) continue;
        const double more = 1 + (double)(i % 40) * 0x1p-52;
        c.body[0].moments = qvec3_scale(c.body[0].moments, more);
        impact_collision d = c;
        d.solver = IMPACT_SOLVER_SERIES;
        impact_outcome one, two;
        assert_int_equal(impact_collide(&c, &one), IMPACT_OK);
        assert_int_equal(impact_collide(&d, &two), IMPACT_OK);
        closed += one.solver == IMPACT_SOLVER_CLOSED_FORM;
        series += one.solver == IMPACT_SOLVER_SERIES;
        const double error = case_error(&c, one.velocity, one.omega, two.velocity, two.omega);
        if (!(error <= 10 * DBL_EPSILON * one.conditioning))
            fail_msg("case %d: the roads differ by %.3g, conditioning %.3g", (int)i, error, one.conditioning);
    }
    assert_true(closed > 1000 && series > 300);
}

static void asked_for(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        impact_collision c = case_make(CASE_ISOTROPIC, 29, i);
        c.solver = IMPACT_SOLVER_CLOSED_FORM;
        impact_outcome o;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        assert_int_equal(o.solver, IMPACT_SOLVER_CLOSED_FORM);
        const double sum = o.work_compression + o.work_restitution + o.work_friction;
        assert_true(fabs(o.energy_after - o.energy_before - sum) <= 1e-14 * o.energy_before);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(as_the_series), cmocka_unit_test(neither_growing_nor_stopping),
                                       cmocka_unit_test(equal_but_for_rounding), cmocka_unit_test(asked_for)};
    return cmocka_run_group_tests_name("impact collide_isotropic", tests, NULL, NULL);
}
