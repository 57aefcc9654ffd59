/* SPDX-License-Identifier: MIT
 *
 * The integrator's thin face against solutions with closed forms, Robertson's problem, and everything that can be
 * refused.
 */
#include <stdio.h>
#include <string.h>
#include <impact/ode.h>
#include "kit/ledger.h"

static const double pi = 3.14159265358979323846;

/* ---- the oscillator: y = (cos t, -sin t) ---- */

typedef struct oscillator {
    double refuse_from;      /* t */
    int refusal;             /* what the right-hand side answers from there on */
    double refuse_root_from; /* t */
    int roots;
} oscillator;

static int swing(double t, const double *y, double *rate, void *context)
{
    const oscillator *o = context;
    if (t > o->refuse_from) return o->refusal;
    rate[0] = y[1];
    rate[1] = -y[0];
    return 0;
}

/* y0, y1 and a function without roots. */
static int swing_roots(double t, const double *y, double *value, void *context)
{
    const oscillator *o = context;
    const double all[3] = {y[0], y[1], 2 + y[0]};
    memcpy(value, all, sizeof *all * (size_t)o->roots);
    return t > o->refuse_root_from;
}

static impact_ode_def swing_def(oscillator *o, int roots)
{
    *o = (oscillator){INFINITY, 0, INFINITY, roots};
    return (impact_ode_def){.struct_size = sizeof(impact_ode_def),
                            .size = 2,
                            .roots = roots,
                            .rhs = swing,
                            .root_functions = roots ? swing_roots : NULL,
                            .context = o,
                            .method = IMPACT_ODE_ADAMS,
                            .relative_tolerance = 1e-13,
                            .absolute_tolerance = 1e-15};
}

static impact_ode *start_swing(const impact_ode_def *def)
{
    impact_ode *ode;
    assert_int_equal(impact_ode_create(def, &ode), IMPACT_OK);
    assert_int_equal(impact_ode_start(ode, 0, (double[]){1, 0}), IMPACT_OK);
    return ode;
}

static void oscillator_by_either_method_forward_and_back(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        oscillator o;
        impact_ode_def def = swing_def(&o, 0);
        def.method = k % 2 ? IMPACT_ODE_BDF : IMPACT_ODE_ADAMS;
        if (k % 2) def.relative_tolerance = 1e-10, def.absolute_tolerance = 1e-12;
        impact_ode *ode = start_swing(&def);
        double t, y[2], worst = 0;
        bool found;
        for (int i = 1; i <= 40; i++) {
            const double t_stop = (k < 2 ? 1 : -1) * 0.25 * pi * i;
            assert_int_equal(impact_ode_advance(ode, t_stop, &t, y, NULL, &found), IMPACT_OK);
            assert_true(t == t_stop && !found);
            worst = fmax(worst, hypot(y[0] - cos(t), y[1] + sin(t)));
        }
        /* No step adds more than its tolerance, and the oscillator does not magnify what was added. */
        assert_at_most(worst, (double)impact_ode_count(ode).steps * 2 * def.relative_tolerance);
        assert_string_equal(impact_ode_message(ode), "");
        impact_ode_destroy(ode);
    }
}

static void roots_are_located(void **state)
{
    (void)state;
    for (int falling = 0; falling < 2; falling++) {
        oscillator o;
        impact_ode_def def = swing_def(&o, 3);
        def.falling_roots_only = falling;
        impact_ode *ode = start_swing(&def);
        double t = 0, y[2];
        int crossed[3];
        bool found;
        /* y0 = cos t and y1 = -sin t cross in turn: y0 falls, y1 rises, y0 rises, y1 falls. */
        for (int i = 1; i <= 40; i++) {
            const int direction = (i - 1) % 4 == 0 || (i - 1) % 4 == 3 ? -1 : 1;
            if (falling && direction > 0) continue;
            assert_int_equal(impact_ode_advance(ode, 100, &t, y, crossed, &found), IMPACT_OK);
            assert_true(found);
            assert_near(t, 0.5 * pi * i, 1e-11);
            assert_int_equal(crossed[(i + 1) % 2], direction);
            assert_int_equal(crossed[i % 2], 0);
            assert_int_equal(crossed[2], 0);
            assert_near(y[(i + 1) % 2], 0, 1e-12);
        }
        impact_ode_destroy(ode);
    }
}

static void restarts_with_the_workspace_it_has(void **state)
{
    (void)state;
    oscillator o;
    const impact_ode_def def = swing_def(&o, 0);
    impact_ode *ode = start_swing(&def);
    double t, y[2], first[2];
    bool found;
    assert_int_equal(impact_ode_advance(ode, 3, &t, first, NULL, &found), IMPACT_OK);
    const impact_ode_counts once = impact_ode_count(ode);
    assert_true(once.steps > 0 && once.rhs_calls >= once.steps && once.starts == 1);
    for (int i = 2; i <= 5; i++) {
        assert_int_equal(impact_ode_start(ode, 0, (double[]){1, 0}), IMPACT_OK);
        assert_int_equal(impact_ode_advance(ode, 3, &t, y, NULL, &found), IMPACT_OK);
        assert_memory_equal(y, first, sizeof y);
        const impact_ode_counts counts = impact_ode_count(ode);
        assert_int_equal(counts.starts, i);
        assert_int_equal(counts.steps, i * once.steps);
        assert_int_equal(counts.rhs_calls, i * once.rhs_calls);
    }
    /* Elsewhere, from another state: the oscillator does not mind. */
    assert_int_equal(impact_ode_start(ode, -7, (double[]){0, 2}), IMPACT_OK);
    assert_int_equal(impact_ode_advance(ode, -5, &t, y, NULL, &found), IMPACT_OK);
    assert_near(y[0], 2 * sin(2), 1e-11);
    assert_near(y[1], 2 * cos(2), 1e-11);
    impact_ode_destroy(ode);
}

static void interpolates_inside_the_last_step(void **state)
{
    (void)state;
    oscillator o;
    const impact_ode_def def = swing_def(&o, 1);
    impact_ode *ode = start_swing(&def);
    double t = 0, y[2], begin, end, before = 0;
    bool found = false;
    for (int steps = 0; !found; steps++) {
        assert_int_equal(impact_ode_step(ode, 100, &t, y, NULL, &found), IMPACT_OK);
        impact_ode_last_step(ode, &begin, &end);
        assert_near(begin, before, 1e-14);
        assert_true(t > begin && t <= end && (found || t == end));
        before = end;
        for (int k = 0; k <= 8; k++) {
            const double at = begin + (end - begin) * k / 8;
            double rate[2];
            assert_int_equal(impact_ode_interpolate(ode, at, 0, y), IMPACT_OK);
            assert_near(y[0], cos(at), 2e-12);
            assert_near(y[1], -sin(at), 2e-12);
            if (steps < 20) continue; /* the first steps are of low order */
            assert_int_equal(impact_ode_interpolate(ode, at, 1, rate), IMPACT_OK);
            assert_near(rate[0], -sin(at), 1e-9);
            assert_near(rate[1], -cos(at), 1e-9);
        }
        assert_int_equal(impact_ode_interpolate(ode, end + 0.1, 0, y), IMPACT_EARGUMENT);
        assert_int_equal(impact_ode_interpolate(ode, begin - 0.1, 0, y), IMPACT_EARGUMENT);
        assert_int_equal(impact_ode_interpolate(ode, end, 99, y), IMPACT_EARGUMENT);
    }
    assert_near(t, 0.5 * pi, 1e-12); /* the root stands inside the step that went past it */
    impact_ode_destroy(ode);
}

static void steps_keep_their_limit_and_never_pass_the_stop(void **state)
{
    (void)state;
    oscillator o;
    const impact_ode_def def = swing_def(&o, 0);
    impact_ode *ode = start_swing(&def);
    double t = 0, y[2], begin, end;
    bool found;
    assert_int_equal(impact_ode_limit_step(ode, 0.003), IMPACT_OK);
    while (t < 1) {
        assert_int_equal(impact_ode_step(ode, 1, &t, y, NULL, &found), IMPACT_OK);
        impact_ode_last_step(ode, &begin, &end);
        assert_true(end - begin <= 0.003 * (1 + 1e-12) && t <= 1);
    }
    assert_true(impact_ode_count(ode).steps >= 333);
    assert_int_equal(impact_ode_limit_step(ode, 0), IMPACT_OK);
    const long limited = impact_ode_count(ode).steps;
    assert_int_equal(impact_ode_advance(ode, 2, &t, y, NULL, &found), IMPACT_OK);
    assert_true(impact_ode_count(ode).steps - limited < 300);
    assert_near(y[0], cos(2), 1e-12);
    assert_int_equal(impact_ode_limit_step(ode, -1), IMPACT_EARGUMENT);
    impact_ode_destroy(ode);
}

/* A looser one takes fewer steps and errs more; what cannot be is refused. */
static void another_tolerance_from_the_next_start_on(void **state)
{
    (void)state;
    oscillator o;
    const impact_ode_def def = swing_def(&o, 0);
    impact_ode *ode = start_swing(&def);
    double t, y[2];
    const double start[2] = {1, 0};
    bool found;
    assert_int_equal(impact_ode_advance(ode, 20, &t, y, NULL, &found), IMPACT_OK);
    const long close = impact_ode_count(ode).steps;
    assert_near(y[0], cos(20), 1e-10);
    assert_int_equal(impact_ode_set_tolerance(ode, 1e-6, 1e-8), IMPACT_OK);
    assert_int_equal(impact_ode_start(ode, 0, start), IMPACT_OK);
    assert_int_equal(impact_ode_advance(ode, 20, &t, y, NULL, &found), IMPACT_OK);
    assert_true(2 * (impact_ode_count(ode).steps - close) < close);
    assert_near(y[0], cos(20), 1e-3);
    assert_true(fabs(y[0] - cos(20)) > 1e-8);
    assert_int_equal(impact_ode_set_tolerance(ode, -1, 1), IMPACT_EARGUMENT);
    assert_int_equal(impact_ode_set_tolerance(ode, 1e-6, NAN), IMPACT_EARGUMENT);
    const double each[2] = {1e-8, 1e-8}, bad[2] = {1e-8, NAN}; /* one for each component: the same here */
    const long loose = impact_ode_count(ode).steps - close;
    assert_int_equal(impact_ode_set_tolerances(ode, 1e-6, each), IMPACT_OK);
    assert_int_equal(impact_ode_start(ode, 0, start), IMPACT_OK);
    assert_int_equal(impact_ode_advance(ode, 20, &t, y, NULL, &found), IMPACT_OK);
    assert_int_equal(impact_ode_count(ode).steps - close, 2 * loose);
    assert_int_equal(impact_ode_set_tolerances(ode, 1e-6, bad), IMPACT_EARGUMENT);
    impact_ode_destroy(ode);
}

/* To where it stands already, before the first step and after it. */
static void no_way_to_go_is_no_failure(void **state)
{
    (void)state;
    oscillator o;
    const impact_ode_def def = swing_def(&o, 0);
    impact_ode *ode = start_swing(&def);
    double t = NAN, y[2] = {NAN, NAN};
    bool found;
    assert_int_equal(impact_ode_advance(ode, 0, &t, y, NULL, &found), IMPACT_OK);
    assert_true(t == 0 && !found && y[0] == 1 && y[1] == 0);
    assert_int_equal(impact_ode_advance(ode, 1, &t, y, NULL, &found), IMPACT_OK);
    const double there = y[0];
    assert_int_equal(impact_ode_advance(ode, 1, &t, y, NULL, &found), IMPACT_OK);
    assert_true(t == 1 && y[0] == there);
    impact_ode_destroy(ode);
}

/* ---- Robertson's kinetics (1966), stiff: reference values of the Test Set for IVP Solvers (Mazzia and Magherini
 * 2008), t = 1e11 ---- */

static int robertson(double t, const double *y, double *rate, void *context)
{
    (void)t, (void)context;
    rate[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
    rate[2] = 3e7 * y[1] * y[1];
    rate[1] = -rate[0] - rate[2];
    return 0;
}

static void robertson_over_eleven_decades(void **state)
{
    (void)state;
    const double wanted[3] = {0.2083340149701255e-7, 0.8333360770334713e-13, 0.9999999791665050};
    const double absolute[3] = {1e-16, 1e-20, 1e-12};
    const impact_ode_def def = {.struct_size = sizeof def,
                                .size = 3,
                                .rhs = robertson,
                                .method = IMPACT_ODE_BDF,
                                .relative_tolerance = 1e-10,
                                .absolute_tolerances = absolute};
    impact_ode *ode;
    assert_int_equal(impact_ode_create(&def, &ode), IMPACT_OK);
    assert_int_equal(impact_ode_start(ode, 0, (double[]){1, 0, 0}), IMPACT_OK);
    double t, y[3];
    bool found;
    for (double t_stop = 0.1; t_stop < 1e11; t_stop *= 10) {
        assert_int_equal(impact_ode_advance(ode, t_stop, &t, y, NULL, &found), IMPACT_OK);
        assert_near(y[0] + y[1] + y[2], 1, 1e-12); /* what is there is neither made nor lost */
    }
    assert_int_equal(impact_ode_advance(ode, 1e11, &t, y, NULL, &found), IMPACT_OK);
    for (int i = 0; i < 3; i++) assert_near(y[i] / wanted[i], 1, 1e-6);
    assert_true(impact_ode_count(ode).steps < 20000); /* an explicit method would need 1e14 */
    impact_ode_destroy(ode);
}

/* ---- refusals ---- */

static void refused_functions_end_with_words(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        oscillator o;
        const impact_ode_def def = swing_def(&o, 3);
        impact_ode *ode = start_swing(&def);
        if (k < 2) o.refuse_from = 1, o.refusal = k == 0 ? -1 : 1;
        if (k == 2) o.refuse_root_from = 1;
        double t = 0, y[2];
        bool found;
        assert_int_equal(impact_ode_advance(ode, 1.5, &t, y, NULL, &found), IMPACT_EINTEGRATOR);
        assert_false(found);
        /* Words of ours, with the time: no text of SUNDIALS. */
        double told = NAN;
        char why = 0;
        if (sscanf(impact_ode_message(ode), "integration stopped at t = %lf, step %*f: %c", &told, &why) != 2)
            fail_msg("%s", impact_ode_message(ode));
        assert_int_equal(why, "tna"[k]); /* the rates give up; no step is short enough; a root function gives up */
        assert_true(impact_ode_count(ode).steps < 1000);
        assert_near(told, 1.1, 0.2);
        assert_true(t <= 1.2);
        /* It can be started again. */
        o = (oscillator){INFINITY, 0, INFINITY, o.roots};
        assert_int_equal(impact_ode_start(ode, 0, (double[]){1, 0}), IMPACT_OK);
        assert_string_equal(impact_ode_message(ode), "");
        assert_int_equal(impact_ode_advance(ode, 1.5, &t, y, NULL, &found), IMPACT_OK);
        assert_near(y[0], cos(1.5), 1e-12);
        impact_ode_destroy(ode);
    }
}

static void too_many_steps_end_with_words(void **state)
{
    (void)state;
    oscillator o;
    impact_ode_def def = swing_def(&o, 0);
    def.max_steps = 7;
    impact_ode *ode = start_swing(&def);
    double t = 0, y[2];
    bool found;
    assert_int_equal(impact_ode_advance(ode, 1000, &t, y, NULL, &found), IMPACT_EINTEGRATOR);
    assert_non_null(strstr(impact_ode_message(ode), "7 steps did not reach t = 1000"));
    assert_int_equal(impact_ode_count(ode).steps, 7);
    impact_ode_destroy(ode);
}

static void a_start_that_is_no_number_is_named(void **state)
{
    (void)state;
    oscillator o;
    const impact_ode_def def = swing_def(&o, 0);
    impact_ode *ode = start_swing(&def);
    assert_int_equal(impact_ode_start(ode, 2, (double[]){1, NAN}), IMPACT_EDOMAIN);
    assert_string_equal(impact_ode_message(ode), "start at t = 2: component 1 is nan");
    assert_int_equal(impact_ode_start(ode, 2, (double[]){INFINITY, 0}), IMPACT_EDOMAIN);
    assert_int_equal(impact_ode_start(ode, NAN, (double[]){1, 0}), IMPACT_EDOMAIN);
    impact_ode_destroy(ode);
}

static void bad_definitions_are_refused(void **state)
{
    (void)state;
    static const double negative[2] = {1e-12, -1e-12}, not_a_number[2] = {NAN, 1e-12};
    for (int k = 0; k < 11; k++) {
        oscillator o;
        impact_ode_def def = swing_def(&o, 3);
        switch (k) {
        case 0: def.size = 0; break;
        case 1: def.roots = -1; break;
        case 2: def.rhs = NULL; break;
        case 3: def.root_functions = NULL; break;
        case 4: def.relative_tolerance = 0; break;
        case 5: def.relative_tolerance = NAN; break;
        case 6: def.absolute_tolerance = -1; break;
        case 7: def.absolute_tolerance = NAN; break;
        case 8: def.max_steps = -1; break;
        case 9: def.absolute_tolerances = negative; break;
        default: def.absolute_tolerances = not_a_number; break;
        }
        impact_ode *ode = (impact_ode *)&def;
        if (impact_ode_create(&def, &ode) != IMPACT_EARGUMENT) fail_msg("definition %d was not refused", k);
        assert_null(ode);
    }
    impact_ode_destroy(NULL);
}

/* Bits: an integrator of six components that was made smaller is one of two. */
static void a_smaller_problem_in_the_same_memory(void **state)
{
    (void)state;
    for (int method = IMPACT_ODE_ADAMS; method <= IMPACT_ODE_BDF; method++) {
        oscillator wide, narrow;
        impact_ode_def def = swing_def(&narrow, 1);
        def.method = (impact_ode_method)method;
        impact_ode *small = start_swing(&def), *large;
        def.context = &wide;
        wide = narrow;
        def.size = 6;
        def.roots = 4;
        assert_int_equal(impact_ode_create(&def, &large), IMPACT_OK);
        assert_int_equal(impact_ode_resize(large, 7, 1), IMPACT_EARGUMENT);
        assert_int_equal(impact_ode_resize(large, 0, 1), IMPACT_EARGUMENT);
        assert_int_equal(impact_ode_resize(large, 2, 5), IMPACT_EARGUMENT);
        assert_int_equal(impact_ode_resize(large, 2, 1), IMPACT_OK);
        assert_int_equal(impact_ode_start(large, 0, (double[]){1, 0}), IMPACT_OK);
        for (int step = 0; step < 300; step++) {
            double t1, t2, y1[2], y2[2];
            bool found1, found2;
            assert_int_equal(impact_ode_step(small, 50, &t1, y1, NULL, &found1), IMPACT_OK);
            assert_int_equal(impact_ode_step(large, 50, &t2, y2, NULL, &found2), IMPACT_OK);
            assert_true(t1 == t2 && y1[0] == y2[0] && y1[1] == y2[1] && found1 == found2);
        }
        impact_ode_destroy(small);
        impact_ode_destroy(large);
    }
}

/* Of the caller's allocator, and of it alone: counted, and not asked again after the creation. */
static void memory_is_the_callers(void **state)
{
    (void)state;
    for (int method = IMPACT_ODE_ADAMS; method <= IMPACT_ODE_BDF; method++) {
        ledger l = {0};
        const impact_allocator allocator = ledger_allocator(&l, 0);
        oscillator o;
        impact_ode_def def = swing_def(&o, 3);
        def.method = (impact_ode_method)method;
        def.allocator = &allocator;
        impact_ode *ode = start_swing(&def);
        const long calls = l.calls;
        assert_int_equal(impact_ode_memory(ode).held, l.held);
        const double tolerances[2] = {1e-12, 1e-13};
        assert_int_equal(impact_ode_set_tolerances(ode, 1e-12, tolerances), IMPACT_OK);
        assert_int_equal(impact_ode_start(ode, 0, (double[]){1, 0}), IMPACT_OK);
        double t, y[2];
        bool found;
        for (int step = 0; step < 300; step++)
            assert_int_equal(impact_ode_step(ode, 1e3, &t, y, NULL, &found), IMPACT_OK);
        assert_int_equal(impact_ode_interpolate(ode, t, 1, y), IMPACT_OK);
        assert_int_equal(l.calls, calls);
        impact_ode_destroy(ode);
        assert_int_equal(l.held, 0);
        for (long fail_at = 1; fail_at <= calls; fail_at++) {
            l = (ledger){.fail_at = fail_at};
            const impact_status status = impact_ode_create(&def, &ode);
            assert_true(status == IMPACT_OK || (status == IMPACT_ENOMEM && !ode));
            impact_ode_destroy(ode);
            assert_int_equal(l.held, 0);
        }
    }
}

static void a_build_without_cvode_says_so(void **state)
{
    (void)state;
    oscillator o;
    const impact_ode_def def = swing_def(&o, 0);
    impact_ode *ode = (impact_ode *)&o;
    assert_int_equal(impact_ode_create(&def, &ode), IMPACT_EABSENT);
    assert_null(ode);
}

int main(void)
{
    const struct CMUnitTest present[] = {
        cmocka_unit_test(oscillator_by_either_method_forward_and_back),
        cmocka_unit_test(roots_are_located),
        cmocka_unit_test(restarts_with_the_workspace_it_has),
        cmocka_unit_test(interpolates_inside_the_last_step),
        cmocka_unit_test(steps_keep_their_limit_and_never_pass_the_stop),
        cmocka_unit_test(another_tolerance_from_the_next_start_on),
        cmocka_unit_test(no_way_to_go_is_no_failure),
        cmocka_unit_test(robertson_over_eleven_decades),
        cmocka_unit_test(refused_functions_end_with_words),
        cmocka_unit_test(too_many_steps_end_with_words),
        cmocka_unit_test(a_start_that_is_no_number_is_named),
        cmocka_unit_test(bad_definitions_are_refused),
        cmocka_unit_test(a_smaller_problem_in_the_same_memory),
        cmocka_unit_test(memory_is_the_callers),
    };
    const struct CMUnitTest absent[] = {cmocka_unit_test(a_build_without_cvode_says_so)};
    if (!impact_has(IMPACT_PART_CVODE)) return cmocka_run_group_tests(absent, NULL, NULL);
    return cmocka_run_group_tests(present, NULL, NULL);
}
