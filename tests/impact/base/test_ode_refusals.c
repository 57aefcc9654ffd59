/* SPDX-License-Identifier: MIT
 *
 * Every method of integration, with each call of its functions refused in turn, and each piece of memory: it ends in
 * words, and leaves nothing behind. And motions that lead out of double precision.
 */
#include <string.h>
#include <impact/impact.h>
#include "kit/ledger.h"

typedef struct witness {
    long rates, roots; /* calls so far */
    long refused_rate, refused_root;
    int refusal;
    long refuse_from; /* from this call of the rates on they ask for a shorter step; 0: never */
} witness;

/* The oscillator, whose y0 falls at pi/2. */
static int swing(double t, const double *y, double *rate, void *context)
{
    (void)t;
    witness *w = context;
    rate[0] = y[1];
    rate[1] = -y[0];
    if (++w->rates == w->refused_rate) return w->refusal;
    return w->refuse_from > 0 && w->rates >= w->refuse_from ? 1 : 0;
}

static int swing_root(double t, const double *y, double *value, void *context)
{
    (void)t;
    witness *w = context;
    value[0] = y[0];
    return ++w->roots == w->refused_root ? -1 : 0;
}

static const impact_ode_method methods[] = {IMPACT_ODE_RK4, IMPACT_ODE_LOBATTO, IMPACT_ODE_DOP853, IMPACT_ODE_ADAMS,
                                            IMPACT_ODE_BDF};

static bool is_here(impact_ode_method method)
{
    return (method != IMPACT_ODE_ADAMS && method != IMPACT_ODE_BDF) || impact_has(IMPACT_PART_CVODE);
}

static impact_ode_def def_of(impact_ode_method method, witness *w)
{
    const bool fixed = method == IMPACT_ODE_RK4;
    return (impact_ode_def){.struct_size = sizeof(impact_ode_def),
                            .size = 2,
                            .roots = 1,
                            .rhs = swing,
                            .root_functions = swing_root,
                            .method = method,
                            .step = fixed ? 0.1 : 0,
                            .relative_tolerance = fixed ? 0 : 1e-8,
                            .absolute_tolerance = fixed ? 0 : 1e-8,
                            .context = w};
}

/* From (1, 0) past the root; what it says where it does not get there. */
static impact_status go(impact_ode *ode)
{
    double t, y[2];
    bool found;
    impact_status status = impact_ode_start(ode, 0, (double[]){1, 0});
    if (status == IMPACT_OK) status = impact_ode_advance(ode, 2, &t, y, NULL, &found);
    if (status == IMPACT_OK && found) status = impact_ode_advance(ode, 2, &t, y, NULL, &found);
    if (status == IMPACT_OK) {
        assert_true(t == 2);
        assert_near(y[0], cos(2), 1e-5);
    }
    return status;
}

static void each_call_refused_in_turn(void **state)
{
    (void)state;
    for (int m = 0; m < 4; m++) {
        if (!is_here(methods[m])) continue;
        witness all = {0};
        impact_ode_def def = def_of(methods[m], &all);
        impact_ode *ode;
        assert_int_equal(impact_ode_create(&def, &ode), IMPACT_OK);
        assert_int_equal(go(ode), IMPACT_OK);
        impact_ode_destroy(ode);
        assert_true(all.rates > 10 && all.roots > 5);
        for (long k = 1; k <= all.rates + all.roots; k++) {
            witness w = {.refusal = -1};
            *(k <= all.rates ? &w.refused_rate : &w.refused_root) = k <= all.rates ? k : k - all.rates;
            def.context = &w;
            assert_int_equal(impact_ode_create(&def, &ode), IMPACT_OK);
            const impact_status status = go(ode);
            if (status != IMPACT_EINTEGRATOR || impact_ode_message(ode)[0] == '\0')
                fail_msg("method %d, call %ld: status %d, '%s'", (int)methods[m], k, status, impact_ode_message(ode));
            impact_ode_destroy(ode);
        }
    }
}

/* A root function that is no number within a step does not cross there: CVODE's search for the root went on for ever.
 */
static int swing_without_numbers(double t, const double *y, double *value, void *context)
{
    const int answer = swing_root(t, y, value, context);
    if (fabs(y[0]) < 1e-3) value[0] = NAN;
    return answer;
}

static void what_is_no_number_does_not_cross(void **state)
{
    (void)state;
    for (int m = 0; m < 5; m++) {
        if (!is_here(methods[m])) continue;
        witness w = {0};
        impact_ode_def def = def_of(methods[m], &w);
        impact_ode *ode;
        def.root_functions = swing_without_numbers;
        assert_int_equal(impact_ode_create(&def, &ode), IMPACT_OK);
        assert_int_equal(go(ode), IMPACT_OK);
        impact_ode_destroy(ode);
    }
}

static void each_piece_of_memory_refused_in_turn(void **state)
{
    (void)state;
    for (int m = 0; m < 4; m++) {
        long refused = 0;
        if (!is_here(methods[m])) continue;
        for (long k = 1;; k++) {
            ledger books = {.fail_at = k};
            const impact_allocator allocator = ledger_allocator(&books, 0);
            witness w = {0};
            impact_ode_def def = def_of(methods[m], &w);
            impact_ode *ode = NULL;
            def.allocator = &allocator;
            impact_status status = impact_ode_create(&def, &ode);
            if (status == IMPACT_OK) status = go(ode);
            impact_ode_destroy(ode);
            assert_int_equal(books.live, 0);
            if (books.calls < k) break;
            assert_true(status == IMPACT_ENOMEM || status == IMPACT_OK); /* less than was asked for may do */
            refused += status == IMPACT_ENOMEM;
        }
        assert_true(refused > 0);
    }
}

/* y' = y^2 from 1 is infinite at 1; y' = 1e200 y at once. */
static int explodes(double t, const double *y, double *rate, void *context)
{
    (void)t;
    rate[0] = *(const double *)context > 0 ? *(const double *)context * y[0] : y[0] * y[0];
    return 0;
}

static void what_leaves_double_precision_is_told(void **state)
{
    (void)state;
    for (int m = 0; m < 4; m++)
        for (int k = 0; k < 2; k++) {
            double rate = k ? 1e200 : 0, t, y[1] = {1};
            bool found;
            if (!is_here(methods[m])) continue;
            impact_ode_def def = def_of(methods[m], NULL);
            def.size = 1, def.roots = 0, def.root_functions = NULL, def.rhs = explodes, def.context = &rate;
            impact_ode *ode;
            assert_int_equal(impact_ode_create(&def, &ode), IMPACT_OK);
            assert_int_equal(impact_ode_start(ode, 0, y), IMPACT_OK);
            const impact_status status = impact_ode_advance(ode, 3, &t, y, NULL, &found);
            if (status == IMPACT_OK) fail_msg("method %d: at %g it is %g", (int)methods[m], t, y[0]);
            assert_true(impact_ode_message(ode)[0] != '\0');
            impact_ode_destroy(ode);
        }
}

/* What refuses from the first call on, or asks for shorter steps for ever, and what no step can reach: each in words.
 */
static void what_no_step_can_do_is_told(void **state)
{
    static const struct {
        long from; /* the call from which on it is refused */
        double relative;
        impact_ode_method method;
        const char *words;
    } cases[] = {{1, 1e-8, IMPACT_ODE_ADAMS, "at the start"},
                 {40, 1e-8, IMPACT_ODE_ADAMS, "do not converge"},
                 {40, 1e-8, IMPACT_ODE_BDF, "asking for a shorter step"},
                 {0, 1e-17, IMPACT_ODE_ADAMS, "more than double precision holds"}};
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        witness w = {.refuse_from = cases[k].from};
        impact_ode_def def = def_of(cases[k].method, &w);
        impact_ode *ode;
        def.relative_tolerance = cases[k].relative;
        if (cases[k].from == 0) def.absolute_tolerance = 1e-19;
        assert_int_equal(impact_ode_create(&def, &ode), IMPACT_OK);
        const impact_status status = go(ode);
        if (status != IMPACT_EINTEGRATOR || !strstr(impact_ode_message(ode), cases[k].words))
            fail_msg("case %zu: status %d, '%s'", k, status, impact_ode_message(ode));
        impact_ode_destroy(ode);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_call_refused_in_turn),
        cmocka_unit_test(what_is_no_number_does_not_cross),
        cmocka_unit_test(each_piece_of_memory_refused_in_turn),
        cmocka_unit_test(what_no_step_can_do_is_told),
        cmocka_unit_test(what_leaves_double_precision_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
