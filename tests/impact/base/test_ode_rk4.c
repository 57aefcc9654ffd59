/* SPDX-License-Identifier: MIT
 *
 * The fixed step of Runge and Kutta on the oscillator y = (cos t, -sin t): its order, between the steps and at roots
 * too, and what it refuses.
 */
#include <string.h>
#include <impact/ode.h>
#include "kit/ledger.h"

static const double pi = 3.14159265358979323846;

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

/* y0, which falls at pi/2 and rises at 3 pi/2, and what is zero from the start on and rises. */
static int swing_roots(double t, const double *y, double *value, void *context)
{
    (void)context;
    value[0] = y[0];
    value[1] = t;
    return 0;
}

static impact_ode_def def_of(double step, int roots)
{
    return (impact_ode_def){.struct_size = sizeof(impact_ode_def),
                            .size = 2,
                            .roots = roots,
                            .rhs = swing,
                            .root_functions = roots ? swing_roots : NULL,
                            .method = IMPACT_ODE_RK4,
                            .step = step};
}

static impact_ode *start_at(const impact_ode_def *def)
{
    impact_ode *ode;
    assert_int_equal(impact_ode_create(def, &ode), IMPACT_OK);
    assert_int_equal(impact_ode_start(ode, 0, (double[]){1, 0}), IMPACT_OK);
    return ode;
}

static double error_of(double t, const double *y) { return hypot(y[0] - cos(t), y[1] + sin(t)); }

/* The greatest errors with a step: at its ends up to 10, within steps, and of four roots' times. */
typedef struct swing_errors {
    double end, within, root;
} swing_errors;

static swing_errors errors_with(double step)
{
    swing_errors e = {0};
    impact_ode_def def = def_of(step, 0);
    impact_ode *ode = start_at(&def);
    double t = 0, y[2], inside[2], begin, end;
    bool found;
    while (t < 10) {
        assert_int_equal(impact_ode_step(ode, 10, &t, y, NULL, &found), IMPACT_OK);
        e.end = fmax(e.end, error_of(t, y));
        impact_ode_last_step(ode, &begin, &end);
        for (int k = 1; k < 8; k++) {
            const double at = begin + k * (end - begin) / 8;
            assert_int_equal(impact_ode_interpolate(ode, at, 0, inside), IMPACT_OK);
            e.within = fmax(e.within, error_of(at, inside));
        }
    }
    impact_ode_destroy(ode);
    def = def_of(step, 2);
    ode = start_at(&def);
    for (int k = 0; k < 4; k++) {
        int crossed[2];
        assert_int_equal(impact_ode_advance(ode, 100, &t, y, crossed, &found), IMPACT_OK);
        assert_true(found);
        assert_int_equal(crossed[0], k % 2 ? 1 : -1);
        assert_int_equal(crossed[1], 0); /* began at zero: does not cross */
        e.root = fmax(e.root, fabs(t - (k + 0.5) * pi));
        assert_at_most(fabs(y[0]), 1e-14);
    }
    impact_ode_destroy(ode);
    return e;
}

static double slope(double coarse, double fine, double ratio) { return log(coarse / fine) / log(ratio); }

static void it_is_of_order_four_everywhere(void **state)
{
    (void)state;
    for (double step = 0.16; step > 0.015; step /= 2) {
        const swing_errors coarse = errors_with(step), fine = errors_with(step / 2);
        assert_near(slope(coarse.end, fine.end, 2), 4, 0.1);
        assert_near(slope(coarse.within, fine.within, 2), 4, 0.1);
        assert_near(slope(coarse.root, fine.root, 2), 4, 0.4); /* where in the step the root lies differs */
    }
}

/* As many calls as the textbook's, with the rate at a step's end used for the next one's begin. */
static void it_asks_no_more_than_four_times_a_step(void **state)
{
    (void)state;
    const impact_ode_def def = def_of(0.1, 0);
    impact_ode *ode = start_at(&def);
    double t, y[2];
    bool found;
    assert_int_equal(impact_ode_advance(ode, 10, &t, y, NULL, &found), IMPACT_OK);
    assert_true(t == 10);
    const impact_ode_counts counts = impact_ode_count(ode);
    assert_int_equal(counts.steps, 100); /* 0.1 a hundred times is not 10, and leaves no sliver */
    assert_int_equal(counts.rhs_calls, 401);
    assert_int_equal(counts.starts, 1);
    assert_int_equal(impact_ode_step(ode, 10, &t, y, NULL, &found), IMPACT_OK); /* stays */
    assert_int_equal(impact_ode_count(ode).rhs_calls, 401);
    impact_ode_destroy(ode);
}

/* Backwards, with a limit below the step, and over fewer components. */
static void it_goes_where_it_is_asked(void **state)
{
    (void)state;
    const impact_ode_def def = def_of(0.1, 0);
    impact_ode *ode = start_at(&def);
    double t, y[2], begin, end;
    bool found;
    assert_int_equal(impact_ode_advance(ode, -3, &t, y, NULL, &found), IMPACT_OK);
    assert_near(error_of(-3, y), 0, 1e-5);
    assert_int_equal(impact_ode_limit_step(ode, 0.01), IMPACT_OK);
    assert_int_equal(impact_ode_step(ode, 3, &t, y, NULL, &found), IMPACT_OK);
    impact_ode_last_step(ode, &begin, &end);
    assert_near(end - begin, 0.01, 1e-15);
    assert_int_equal(impact_ode_limit_step(ode, -1), IMPACT_EARGUMENT);
    assert_int_equal(impact_ode_limit_step(ode, 0), IMPACT_OK);
    assert_int_equal(impact_ode_interpolate(ode, end, 4, y), IMPACT_EARGUMENT);
    assert_int_equal(impact_ode_interpolate(ode, end + 1, 0, y), IMPACT_EARGUMENT);
    assert_int_equal(impact_ode_set_tolerance(ode, 1e-3, 0), IMPACT_OK); /* means nothing */
    impact_ode_destroy(ode);
}

static void a_refusal_ends_it_in_words(void **state)
{
    (void)state;
    for (int refusal = -1; refusal <= 1; refusal += 2) {
        swing_answer answer = {.refuse_from = 0.5, .refusal = refusal};
        impact_ode_def def = def_of(0.1, 0);
        def.context = &answer;
        impact_ode *ode = start_at(&def);
        double t, y[2];
        bool found;
        assert_int_equal(impact_ode_advance(ode, 2, &t, y, NULL, &found), IMPACT_EINTEGRATOR);
        assert_non_null(strstr(impact_ode_message(ode), refusal < 0 ? "gave up" : "asks for a shorter step"));
        impact_ode_destroy(ode);
    }
}

static void a_definition_says_no_more_than_it_needs(void **state)
{
    (void)state;
    impact_ode *ode;
    const double bad[] = {0, -1, NAN, INFINITY};
    for (int k = 0; k < 4; k++) {
        const impact_ode_def def = def_of(bad[k], 0);
        assert_int_equal(impact_ode_create(&def, &ode), IMPACT_EARGUMENT);
    }
    impact_ode_def adams = def_of(0.1, 0);
    adams.method = IMPACT_ODE_ADAMS, adams.relative_tolerance = 1e-6;
    assert_int_equal(impact_ode_create(&adams, &ode), IMPACT_EARGUMENT); /* a step is not for it */
    adams.method = (impact_ode_method)17, adams.step = 0;
    assert_int_equal(impact_ode_create(&adams, &ode), IMPACT_EARGUMENT);
}

static void it_takes_nothing_but_its_allocators(void **state)
{
    (void)state;
    ledger books = {0};
    const impact_allocator allocator = ledger_allocator(&books, 0);
    impact_ode_def def = def_of(0.1, 2);
    def.allocator = &allocator;
    impact_ode *ode = start_at(&def);
    assert_true(books.live > 0);
    impact_ode_destroy(ode);
    assert_int_equal(books.live, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_of_order_four_everywhere),
        cmocka_unit_test(it_asks_no_more_than_four_times_a_step),
        cmocka_unit_test(it_goes_where_it_is_asked),
        cmocka_unit_test(a_refusal_ends_it_in_words),
        cmocka_unit_test(a_definition_says_no_more_than_it_needs),
        cmocka_unit_test(it_takes_nothing_but_its_allocators),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
