/* SPDX-License-Identifier: MIT
 *
 * Collocation at Lobatto's nodes, and Dormand and Prince's method of order 8, on the oscillator y = (cos t, -sin t) and
 * on problems known in closed form: its order, errors as asked for at the ends of steps, between them and at roots,
 * what comes and goes within a step, and what it refuses.
 */
#include <string.h>
#include <impact/ode.h>
#include "kit/ledger.h"

static const double pi = 3.14159265358979323846;

/* What one of them is tested by. */
typedef struct one_step_case {
    impact_ode_method method;
    long steps;        /* at most, of the swing over ten units of time, to 1e-13 */
    double between;    /* its polynomial's error, in tolerances */
    double power[2];   /* of t in a rate: right throughout a step; and at its end */
    double longest;    /* a step in which what comes and goes within .12 is seen */
    double least_step; /* of that of powers */
} one_step_case;

static const one_step_case lobatto = {IMPACT_ODE_LOBATTO, 40, 10, {7, 13}, 0, 0.3},
                           dop853 = {IMPACT_ODE_DOP853, 100, 100, {6, 7}, 0.2, 0.1};
static const one_step_case *tested;

static int test_lobatto(void **state)
{
    (void)state;
    tested = &lobatto;
    return 0;
}

static int test_dop853(void **state)
{
    (void)state;
    tested = &dop853;
    return 0;
}

typedef struct swing_answer {
    double refuse_from;
    int refusal;
} swing_answer;

static int swing(double t, const double *y, double *rate, void *context)
{
    const swing_answer *answer = context;
    rate[0] = y[1];
    rate[1] = -y[0];
    return answer && t > answer->refuse_from ? answer->refusal : 0;
}

/* y0; what is zero from the start on and rises; and what is below zero near t = 0.3 only. */
static int swing_roots(double t, const double *y, double *value, void *context)
{
    (void)context;
    value[0] = y[0];
    value[1] = t;
    value[2] = fabs(t - 0.3) - 0.06;
    return 0;
}

static impact_ode_def def_of(double tolerance, int roots)
{
    return (impact_ode_def){.struct_size = sizeof(impact_ode_def),
                            .size = 2,
                            .roots = roots,
                            .rhs = swing,
                            .root_functions = roots ? swing_roots : NULL,
                            .method = tested->method,
                            .relative_tolerance = tolerance,
                            .absolute_tolerance = tolerance};
}

static impact_ode *start_at(const impact_ode_def *def)
{
    impact_ode *ode;
    assert_int_equal(impact_ode_create(def, &ode), IMPACT_OK);
    assert_int_equal(impact_ode_start(ode, 0, (double[]){1, 0}), IMPACT_OK);
    return ode;
}

static double error_of(double t, const double *y) { return hypot(y[0] - cos(t), y[1] + sin(t)); }

typedef struct swing_errors {
    double end, within;
    impact_ode_counts counts;
} swing_errors;

/* From 0 to `until`, steps no longer than `longest`. */
static swing_errors errors_to(double until, double tolerance, double longest)
{
    swing_errors e = {0};
    const impact_ode_def def = def_of(tolerance, 0);
    impact_ode *ode = start_at(&def);
    assert_int_equal(impact_ode_limit_step(ode, longest), IMPACT_OK);
    double t = 0, y[2], begin, end;
    bool found;
    while (t != until) {
        assert_int_equal(impact_ode_step(ode, until, &t, y, NULL, &found), IMPACT_OK);
        e.end = fmax(e.end, error_of(t, y));
        impact_ode_last_step(ode, &begin, &end);
        for (int k = 0; k <= 8; k++) {
            const double at = k < 8 ? begin + k * (end - begin) / 8 : end;
            assert_int_equal(impact_ode_interpolate(ode, at, 0, y), IMPACT_OK);
            e.within = fmax(e.within, error_of(at, y));
        }
    }
    e.counts = impact_ode_count(ode);
    impact_ode_destroy(ode);
    return e;
}

/* Errors add up over ten units of time, in steps that go with the tolerance. */
static void errors_are_as_asked_for(void **state)
{
    (void)state;
    for (double tolerance = 1e-4; tolerance > 1e-15; tolerance /= 10) {
        for (int way = -1; way <= 1; way += 2) {
            const swing_errors e = errors_to(10 * way, tolerance, 0);
            assert_at_most(e.end, 10 * tolerance + 1e-15);
            assert_at_most(e.within, tested->between * tolerance + 1e-15);
        }
    }
    assert_true(errors_to(10, 1e-13, 0).counts.steps < tested->steps);
}

/* y0' to rounding throughout a step, y1' at its end. */
static int powers(double t, const double *y, double *rate, void *context)
{
    (void)y, (void)context;
    rate[0] = pow(t, tested->power[0]);
    rate[1] = pow(t, tested->power[1]);
    return 0;
}

static void polynomials_are_exact(void **state)
{
    (void)state;
    impact_ode_def def = def_of(1, 0);
    def.rhs = powers;
    impact_ode *ode;
    assert_int_equal(impact_ode_create(&def, &ode), IMPACT_OK);
    assert_int_equal(impact_ode_start(ode, 0, (double[]){1, 1}), IMPACT_OK);
    double t, y[2], begin, end;
    bool found;
    do assert_int_equal(impact_ode_step(ode, 1, &t, y, NULL, &found), IMPACT_OK);
    while (t != 1);
    assert_near(y[0], 1 + 1 / (tested->power[0] + 1), 1e-15);
    assert_near(y[1], 1 + 1 / (tested->power[1] + 1), 1e-15);
    impact_ode_last_step(ode, &begin, &end);
    assert_true(end - begin > tested->least_step); /* exact where the step is long */
    for (int k = 0; k <= 10; k++) {
        const double at = k < 10 ? begin + 0.1 * k * (end - begin) : end;
        assert_int_equal(impact_ode_interpolate(ode, at, 0, y), IMPACT_OK);
        const double p = tested->power[0];
        assert_near(y[0], 1 + pow(at, p + 1) / (p + 1), 1e-15);
        assert_int_equal(impact_ode_interpolate(ode, at, 3, y), IMPACT_OK);
        assert_near(y[0], p * (p - 1) * pow(at, p - 2), 1e-11);
    }
    impact_ode_destroy(ode);
}

static void roots_are_found_within_steps(void **state)
{
    (void)state;
    const impact_ode_def def = def_of(1e-12, 3);
    impact_ode *ode = start_at(&def);
    assert_int_equal(impact_ode_limit_step(ode, tested->longest), IMPACT_OK);
    const double expected[] = {0.24, 0.36, 0.5 * pi, 1.5 * pi, 2.5 * pi};
    const int which[] = {2, 2, 0, 0, 0}, way[] = {-1, 1, -1, 1, -1};
    for (int k = 0; k < 5; k++) {
        double t, y[2];
        int crossed[3];
        bool found;
        assert_int_equal(impact_ode_advance(ode, 100, &t, y, crossed, &found), IMPACT_OK);
        assert_true(found);
        assert_near(t, expected[k], 1e-11);
        for (int i = 0; i < 3; i++) assert_int_equal(crossed[i], i == which[k] ? way[k] : 0);
        assert_at_most(error_of(t, y), 1e-11);
    }
    impact_ode_destroy(ode);
}

/* sin t with an error of rounding that is another at each call. */
static int rough_root(double t, const double *y, double *value, void *context)
{
    unsigned *calls = context;
    (void)t;
    *calls = *calls * 1664525u + 1013904223u;
    value[0] = -y[1] + 1e-13 * ((double)(*calls >> 16) / 65536 - 0.5);
    return 0;
}

static int swing_alone(double t, const double *y, double *rate, void *context)
{
    (void)context;
    return swing(t, y, rate, NULL);
}

/* What was found to cross is told, whatever the function says when it is asked there again; it is not lost. */
static void roots_known_to_rounding_are_told(void **state)
{
    (void)state;
    const impact_ode_method methods[] = {IMPACT_ODE_LOBATTO, IMPACT_ODE_RK4};
    for (int m = 0; m < 2; m++) {
        unsigned calls = 1;
        impact_ode_def def = def_of(1e-12, 1);
        def.rhs = swing_alone, def.root_functions = rough_root, def.context = &calls;
        def.falling_roots_only = true;
        def.method = methods[m];
        if (def.method == IMPACT_ODE_RK4) def.step = 1e-3;
        impact_ode *ode;
        assert_int_equal(impact_ode_create(&def, &ode), IMPACT_OK);
        for (int k = 0; k < 50; k++) {
            double t, y[2];
            int crossed;
            bool found;
            assert_int_equal(impact_ode_start(ode, 0, (double[]){cos(1 + 0.03 * k), -sin(1 + 0.03 * k)}), IMPACT_OK);
            assert_int_equal(impact_ode_advance(ode, 5, &t, y, &crossed, &found), IMPACT_OK);
            assert_true(found);
            assert_int_equal(crossed, -1);
            assert_near(t, pi - (1 + 0.03 * k), 1e-11);
        }
        impact_ode_destroy(ode);
    }
}

/* A start leaves nothing of what was done before; and ends at the same bits. */
static void starts_anew(void **state)
{
    (void)state;
    const impact_ode_def def = def_of(1e-10, 3);
    impact_ode *ode = start_at(&def);
    double first[2], again[2], t;
    bool found;
    assert_int_equal(impact_ode_advance(ode, 0.2, &t, first, NULL, &found), IMPACT_OK);
    assert_int_equal(impact_ode_step(ode, 0.2, &t, again, NULL, &found), IMPACT_OK); /* stays */
    assert_memory_equal(first, again, sizeof first);
    const impact_ode_counts once = impact_ode_count(ode);
    assert_int_equal(impact_ode_start(ode, 0, (double[]){1, 0}), IMPACT_OK);
    assert_int_equal(impact_ode_interpolate(ode, 0, 0, again), IMPACT_OK);
    assert_true(again[0] == 1 && again[1] == 0);
    assert_int_equal(impact_ode_interpolate(ode, 0, 1, again), IMPACT_EARGUMENT);
    assert_int_equal(impact_ode_advance(ode, 0.2, &t, again, NULL, &found), IMPACT_OK);
    assert_memory_equal(first, again, sizeof first);
    const impact_ode_counts twice = impact_ode_count(ode);
    assert_int_equal(twice.rhs_calls, 2 * once.rhs_calls);
    assert_int_equal(twice.steps, 2 * once.steps);
    assert_int_equal(twice.root_calls, 2 * once.root_calls);
    assert_int_equal(twice.starts, 2);
    assert_int_equal(impact_ode_interpolate(ode, 2, 0, again), IMPACT_EARGUMENT);
    assert_int_equal(impact_ode_interpolate(ode, 0.2, 9, again), IMPACT_EARGUMENT);
    impact_ode_destroy(ode);
}

/* f that jumps at the stop is that from before it; and a jump within is found by ever shorter steps. */
static int jumping(double t, const double *y, double *rate, void *context)
{
    (void)y;
    const double *at = context;
    rate[0] = t < *at ? 1 : -1;
    rate[1] = 0;
    return 0;
}

static void forces_jump_at_stops(void **state)
{
    (void)state;
    double jump = 1;
    impact_ode_def def = def_of(1e-10, 0);
    def.rhs = jumping, def.context = &jump;
    impact_ode *ode = start_at(&def);
    double t, y[2];
    bool found;
    assert_int_equal(impact_ode_advance(ode, 1, &t, y, NULL, &found), IMPACT_OK);
    assert_near(y[0], 2, 1e-15);
    const long smooth = impact_ode_count(ode).rhs_calls;
    assert_true(smooth < 100);
    jump = 1.37;
    assert_int_equal(impact_ode_start(ode, 1, (double[]){2, 0}), IMPACT_OK);
    assert_int_equal(impact_ode_advance(ode, 2, &t, y, NULL, &found), IMPACT_OK);
    assert_near(y[0], 2 + 0.37 - 0.63, 1e-8);
    assert_true(impact_ode_count(ode).error_test_failures > 0);
    impact_ode_destroy(ode);
}

/* Away with what cannot be followed: a pole, a function that gives up, one that has no short step to go. */
static int pole(double t, const double *y, double *rate, void *context)
{
    (void)t, (void)context;
    rate[0] = y[0] * y[0];
    rate[1] = 0;
    return 0;
}

static void what_cannot_be_followed_ends_with_words(void **state)
{
    (void)state;
    for (int refusal = -1; refusal <= 1; refusal += 2) {
        swing_answer answer = {0.5, refusal};
        impact_ode_def def = def_of(1e-8, 0);
        def.context = &answer;
        impact_ode *ode = start_at(&def);
        double t, y[2];
        bool found;
        assert_int_equal(impact_ode_advance(ode, 1, &t, y, NULL, &found), IMPACT_EINTEGRATOR);
        assert_true(t <= 0.5 && (refusal < 0 || t > 0.499));
        assert_non_null(strstr(impact_ode_message(ode), refusal < 0 ? "gave up" : "however short"));
        impact_ode_destroy(ode);
    }
    impact_ode_def def = def_of(1e-8, 0);
    def.rhs = pole;
    impact_ode *ode = start_at(&def);
    double t, y[2];
    bool found;
    assert_int_equal(impact_ode_advance(ode, 2, &t, y, NULL, &found), IMPACT_EINTEGRATOR);
    assert_near(t, 1, 1e-6);
    impact_ode_destroy(ode);
    def = def_of(1e-8, 0);
    def.step = 0.1;
    assert_int_equal(impact_ode_create(&def, &ode), IMPACT_EARGUMENT);
    def.step = 0, def.relative_tolerance = 0;
    assert_int_equal(impact_ode_create(&def, &ode), IMPACT_EARGUMENT);
}

/* The first of two swings, in the memory of both. */
static void a_smaller_problem_in_the_same_memory(void **state)
{
    (void)state;
    impact_ode_def def = def_of(1e-9, 3);
    impact_ode *small = start_at(&def);
    def.size = 4;
    ledger books = {0};
    const impact_allocator allocator = ledger_allocator(&books, 0);
    def.allocator = &allocator;
    impact_ode *large;
    assert_int_equal(impact_ode_create(&def, &large), IMPACT_OK);
    assert_int_equal(impact_ode_resize(large, 2, 3), IMPACT_OK);
    assert_int_equal(impact_ode_start(large, 0, (double[]){1, 0}), IMPACT_OK);
    double a[2], b[2], t;
    bool found;
    for (int k = 0; k < 5; k++) {
        assert_int_equal(impact_ode_advance(small, 10, &t, a, NULL, &found), IMPACT_OK);
        assert_int_equal(impact_ode_advance(large, 10, &t, b, NULL, &found), IMPACT_OK);
        assert_memory_equal(a, b, sizeof a);
    }
    impact_ode_destroy(small);
    impact_ode_destroy(large);
    assert_int_equal(books.live, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_as_asked_for),
        cmocka_unit_test(polynomials_are_exact),
        cmocka_unit_test(roots_are_found_within_steps),
        cmocka_unit_test(roots_known_to_rounding_are_told),
        cmocka_unit_test(starts_anew),
        cmocka_unit_test(forces_jump_at_stops),
        cmocka_unit_test(what_cannot_be_followed_ends_with_words),
        cmocka_unit_test(a_smaller_problem_in_the_same_memory),
    };
    const int failed = cmocka_run_group_tests_name("collocation", tests, test_lobatto, NULL);
    return failed + cmocka_run_group_tests_name("DOP853", tests, test_dop853, NULL);
}
