/* SPDX-License-Identifier: MIT
 *
 * Torsional and rolling friction in the cone solver: the projection against bisection in long double, answers against
 * the law's words in long double, problems made from a known answer.
 */
#include "contact/cone.h"
#include "kit/cone_cases.h"
#include "kit/near.h"

#include <string.h>

enum { MOST = 12, WIDE = 6 * MOST };

static imp_cone_workspace room;

typedef struct answer {
    imp_cone_outcome outcome;
    double r[WIDE], u[WIDE];
    imp_cone_mode modes[MOST];
} answer;

static answer solve(const imp_cone_problem *problem)
{
    answer a;
    assert_true(imp_cone_reserve_turning(&room, problem->count));
    a.outcome = imp_cone_solve(problem, &room, a.r, a.u, a.modes);
    return a;
}

/* ---- the projection ---- */

/* The nearest point has for its n the root of n - v_n - sum slope (size - slope n)+, which rises: by bisection. */
static void project_by_bisection(const double *slope, const double *v, long double *to)
{
    const long double size[2] = {sqrtl((long double)v[1] * v[1] + (long double)v[2] * v[2] + (long double)v[3] * v[3]),
                                 sqrtl((long double)v[4] * v[4] + (long double)v[5] * v[5])};
    long double low = 0, high = fabsl((long double)v[0]) + slope[0] * size[0] + slope[1] * size[1];
    for (int k = 0; k < 200; k++) {
        const long double n = 0.5L * (low + high);
        long double rise = n - v[0];
        for (int i = 0; i < 2; i++) rise -= slope[i] * fmaxl(0, size[i] - slope[i] * n);
        if (rise < 0)
            low = n;
        else
            high = n;
    }
    to[0] = high;
    for (int k = 1; k < 6; k++) {
        const int i = k > 3;
        to[k] = size[i] > slope[i] * high ? slope[i] * high * v[k] / size[i] : v[k];
    }
}

static void random_point(random_stream *random, double *v)
{
    const double sizes[3] = {random_log(random, 1e-6, 1e6), random_log(random, 1e-6, 1e6),
                             random_log(random, 1e-6, 1e6)};
    for (int k = 0; k < 6; k++) v[k] = cone_between(random, -1, 1) * sizes[k == 0 ? 0 : k < 4 ? 1 : 2];
}

static void the_nearest_point_is_found(void **state)
{
    (void)state;
    random_stream random = {21};
    for (int k = 0; k < 200000; k++) {
        const double friction = random_log(&random, 1e-4, 1e4), rolling = k % 2 ? random_log(&random, 1e-4, 1e4) : 1;
        const double slope[2] = {friction, rolling};
        double v[6], to[6];
        long double wanted[6], size = 0;
        random_point(&random, v);
        for (int i = 0; i < 6; i++) size = fmaxl(size, fabsl((long double)v[i]));
        imp_cone_project_turning(friction, (imp_cone_lengths){1, 1}, rolling, v, to, NULL);
        project_by_bisection(slope, v, wanted);
        for (int i = 0; i < 6; i++) assert_near(to[i], (double)wanted[i], 1e-15 * (double)size);
    }
}

/* Along random directions, by differences of 1e-4, that end on the same piece: what they differ by falls with the step
 * squared. */
static void its_slope_is_its_derivative(void **state)
{
    (void)state;
    random_stream random = {22};
    int asked = 0;
    for (int k = 0; k < 20000; k++) {
        const double friction = random_log(&random, 0.1, 10), h = 1e-4;
        const imp_cone_lengths lengths = {k % 5 ? 1 : 0, k % 7 ? 1 : 0};
        double v[6], d[6], to[6], slope[6][6], sides[2][6], at[2][6][6], off[2] = {0, 0};
        for (int i = 0; i < 6; i++) v[i] = cone_between(&random, -1, 1), d[i] = cone_between(&random, -1, 1);
        imp_cone_project_turning(friction, lengths, 1, v, to, slope);
        for (int half = 0; half < 2; half++) {
            const double step = half ? 0.5 * h : h;
            for (int s = 0; s < 2; s++) {
                double moved[6];
                for (int i = 0; i < 6; i++) moved[i] = v[i] + (s ? -step : step) * d[i];
                imp_cone_project_turning(friction, lengths, 1, moved, sides[s], at[s]);
            }
            for (int i = 0; i < 6; i++) {
                double along = 0;
                for (int j = 0; j < 6; j++) along += slope[i][j] * d[j];
                off[half] = fmax(off[half], fabs((sides[0][i] - sides[1][i]) / (2 * step) - along));
            }
        }
        double jump = 0; /* of the slope between both sides: where a piece ends it is not small */
        for (int i = 0; i < 36; i++) jump = fmax(jump, fabs(at[0][i / 6][i % 6] - at[1][i / 6][i % 6]));
        if (jump > 0.01) continue;
        asked++;
        assert_at_most(off[1], 0.3 * off[0] + 1e-10);
    }
    assert_true(asked > 18000);
}

/* Moreau: v - P v is in the polar cone and at right angles to P v; P of P is P. */
static void it_parts_any_point_in_two(void **state)
{
    (void)state;
    random_stream random = {23};
    for (int k = 0; k < 20000; k++) {
        const double friction = k % 4 ? random_log(&random, 1e-3, 1e3) : 0;
        const imp_cone_lengths lengths = {k % 3 ? 1 : 0, k % 5 ? 1 : 0};
        const double slope = friction > 0 ? friction : 1;
        const int from = friction > 0 ? 1 : 3, to = lengths.torsional > 0 ? 4 : 3;
        double v[6], on[6], again[6], rest[6], product = 0, size = 0, first = 0;
        random_point(&random, v);
        imp_cone_project_turning(friction, lengths, 1, v, on, NULL);
        imp_cone_project_turning(friction, lengths, 1, on, again, NULL);
        for (int i = 0; i < 6; i++) {
            const bool out = (i > 0 && i < from) || (i >= to && i < 4) || (i > 3 && !(lengths.rolling > 0));
            if (out) v[i] = 0;
            if (out) assert_true(on[i] == 0);
            size = fmax(size, fabs(v[i]));
            rest[i] = v[i] - on[i];
            product += rest[i] * on[i];
        }
        for (int i = from; i < to; i++) first += rest[i] * rest[i];
        for (int i = 0; i < 6; i++) assert_near(again[i], on[i], 1e-15 * size);
        assert_near(product, 0, 1e-15 * size * size * fmax(slope, 1));
        assert_at_most(rest[0] + slope * sqrt(first) + hypot(rest[4], rest[5]), 1e-15 * size * fmax(slope, 1));
    }
}

/* ---- the solver ---- */

/* The law as words, each to a part of the largest, in sums of their own. */
static void assert_law(const imp_cone_problem *problem, const answer *a)
{
    const int n = 6 * problem->count;
    double most = 0, size = 0;
    for (int c = 0; c < problem->count; c++)
        for (int k = 0; k < 6; k++) {
            const imp_cone_lengths *l = &problem->lengths[c];
            const double length = k < 3 ? 1 : k == 3 ? l->torsional : l->rolling;
            if (length > 0 && k < 3) most = fmax(most, fabs(a->r[6 * c + k]));
            size = fmax(size, fabs(problem->q[6 * c + k]) * length);
        }
    const double tiny_r = 1e-12 * most, tiny_u = 1e-12 * size;
    for (int c = 0; c < problem->count; c++) {
        const double mu = problem->friction[c], tau = problem->lengths[c].torsional, rho = problem->lengths[c].rolling;
        const double *r = &a->r[6 * c];
        long double u[6];
        for (int k = 0; k < 6; k++) {
            u[k] = problem->q[6 * c + k];
            for (int j = 0; j < n; j++) u[k] += (long double)problem->w[(6 * c + k) * n + j] * a->r[j];
        }
        const double rubs = hypot(mu > 0 ? hypot(r[1], r[2]) / mu : 0, tau > 0 ? r[3] / tau : 0);
        const double rolls = rho > 0 ? hypot(r[4], r[5]) / rho : 0;
        const double slip = hypot(mu * hypot((double)u[1], (double)u[2]), tau * (double)u[3]);
        const double turn = rho * hypot((double)u[4], (double)u[5]);
        if (mu == 0) assert_true(r[1] == 0 && r[2] == 0);
        if (tau == 0) assert_true(r[3] == 0);
        if (rho == 0) assert_true(r[4] == 0 && r[5] == 0);
        assert_at_most(-r[0], 0);
        assert_at_most(rubs - r[0], 3 * tiny_r / fmin(1, mu > 0 ? mu : 1));
        assert_at_most(rolls - r[0], 3 * tiny_r);
        assert_at_most(-(double)u[0], 3 * tiny_u);
        /* û . r = 0, which is r_n u_n and, of each part, its power at full strength less its power */
        const double power =
            (double)(r[0] * u[0] + r[1] * u[1] + r[2] * u[2] + r[3] * u[3] + r[4] * u[4] + r[5] * u[5]);
        assert_near(power + r[0] * (slip + turn), 0, 1e-11 * most * size);
        assert_near(r[0] * (double)u[0], 0, 1e-11 * most * size);
    }
}

static void known_answers_with_moments_are_found(void **state)
{
    (void)state;
    random_stream random = {24};
    int same = 0, solved = 0;
    enum { RUNS = 3000 };
    for (int k = 0; k < RUNS; k++) {
        const int count = 1 + (int)cone_between(&random, 0, 7.99), bodies = 1 + count / (1 + k % 3);
        cone_case c = cone_case_make_turning(&random, count, bodies, 1);
        const imp_cone_problem problem = cone_case_problem(&c);
        const answer got = solve(&problem);
        if (got.outcome.status == IMP_CONE_SOLVED) {
            double off = 0;
            assert_law(&problem, &got);
            for (int i = 0; i < 6 * count; i++) off = fmax(off, fabs(got.u[i] - c.u[i]) / (1 + fabs(c.u[i])));
            same += off < 1e-9;
            solved++;
        }
        cone_case_free(&c);
    }
    assert_true(solved > 0.999 * RUNS);
    assert_true(same > 0.8 * RUNS); /* others have more than one answer */
}

/* q moved by a millionth: the last answer's modes solve it, in a few linear systems. */
static void the_last_answer_with_moments_leads_on(void **state)
{
    (void)state;
    random_stream random = {25};
    int at_once = 0;
    enum { RUNS = 200, COUNT = 5, N = 6 * COUNT };
    for (int k = 0; k < RUNS; k++) {
        cone_case c = cone_case_make_turning(&random, COUNT, COUNT, 1);
        imp_cone_problem problem = cone_case_problem(&c);
        const answer first = solve(&problem);
        double change[N];
        for (int i = 0; i < N; i++) change[i] = 1e-6 * cone_between(&random, -1, 1);
        for (int i = 0; i < N; i++)
            for (int j = 0; j < N; j++) c.q[i] += c.w[N * i + j] * change[j];
        problem.last_r = first.r, problem.last_u = first.u;
        const answer next = solve(&problem);
        assert_int_equal(next.outcome.status, IMP_CONE_SOLVED);
        assert_law(&problem, &next);
        at_once += next.outcome.stage == IMP_CONE_LAST && next.outcome.factorings <= 3;
        cone_case_free(&c);
    }
    assert_true(at_once > 0.9 * RUNS);
}

/* Contacts in another order, lengths in a unit 1/8 as long and masses in one 1/4 as great: the same bits. */
static void order_and_units_change_no_bit(void **state)
{
    (void)state;
    random_stream random = {26};
    enum { COUNT = 4, N = 6 * COUNT };
    for (int k = 0; k < 200; k++) {
        cone_case c = cone_case_make_turning(&random, COUNT, COUNT, 1), d = cone_case_room(COUNT, true);
        for (int i = 0; i < N; i++) {
            const int from = 6 * (COUNT - 1 - i / 6) + i % 6;
            const double turn = i % 6 > 2 ? 0.125 : 1;
            d.q[i] = 8 * turn * c.q[from];
            for (int j = 0; j < N; j++)
                d.w[N * i + j] =
                    turn * (j % 6 > 2 ? 0.125 : 1) * 0.25 * c.w[N * from + 6 * (COUNT - 1 - j / 6) + j % 6];
        }
        for (int i = 0; i < COUNT; i++) {
            d.friction[i] = c.friction[COUNT - 1 - i];
            d.lengths[i].torsional = 8 * c.lengths[COUNT - 1 - i].torsional;
            d.lengths[i].rolling = 8 * c.lengths[COUNT - 1 - i].rolling;
        }
        const imp_cone_problem one = cone_case_problem(&c), two = cone_case_problem(&d);
        const answer a = solve(&one), b = solve(&two);
        for (int i = 0; i < N; i++) {
            const int from = 6 * (COUNT - 1 - i / 6) + i % 6;
            assert_true(b.r[i] == a.r[from] * (i % 6 > 2 ? 256 : 32));
        }
        cone_case_free(&c);
        cone_case_free(&d);
    }
}

/* Velocities where they are unique. */
static void without_lengths_it_is_the_problem_of_three(void **state)
{
    (void)state;
    random_stream random = {27};
    for (int k = 0; k < 300; k++) {
        enum { COUNT = 3, N = 6 * COUNT, SMALL = 3 * COUNT };
        cone_case c = cone_case_make_turning(&random, COUNT, COUNT, 1);
        double w[SMALL * SMALL], q[SMALL], r[SMALL], u[SMALL];
        for (int i = 0; i < COUNT; i++) c.lengths[i] = (imp_cone_lengths){0, 0};
        for (int i = 0; i < SMALL; i++) {
            const int row = 6 * (i / 3) + i % 3;
            q[i] = c.q[row];
            for (int j = 0; j < SMALL; j++) w[SMALL * i + j] = c.w[N * row + 6 * (j / 3) + j % 3];
        }
        const imp_cone_problem whole = cone_case_problem(&c),
                               small = {.count = COUNT, .w = w, .q = q, .friction = c.friction};
        const answer a = solve(&whole);
        const imp_cone_outcome o = imp_cone_solve(&small, &room, r, u, NULL);
        assert_int_equal(a.outcome.status, o.status);
        for (int i = 0; i < SMALL && !o.chosen && o.status == IMP_CONE_SOLVED; i++)
            assert_near(a.u[6 * (i / 3) + i % 3], u[i], 1e-10);
        cone_case_free(&c);
    }
}

static void bad_lengths_are_refused(void **state)
{
    (void)state;
    random_stream random = {28};
    const double bad[3] = {-1, NAN, INFINITY};
    for (int k = 0; k < 6; k++) {
        cone_case c = cone_case_make_turning(&random, 2, 2, 1);
        *(k % 2 ? &c.lengths[1].torsional : &c.lengths[1].rolling) = bad[k / 2];
        const imp_cone_problem problem = cone_case_problem(&c);
        assert_int_equal(solve(&problem).outcome.status, IMP_CONE_BAD);
        cone_case_free(&c);
    }
}

static int furnish(void **state)
{
    (void)state;
    return imp_arena_create(NULL, &room.arena);
}

static int clear(void **state)
{
    (void)state;
    imp_arena_destroy(room.arena);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_point_is_found),
        cmocka_unit_test(its_slope_is_its_derivative),
        cmocka_unit_test(it_parts_any_point_in_two),
        cmocka_unit_test(known_answers_with_moments_are_found),
        cmocka_unit_test(the_last_answer_with_moments_leads_on),
        cmocka_unit_test(order_and_units_change_no_bit),
        cmocka_unit_test(without_lengths_it_is_the_problem_of_three),
        cmocka_unit_test(bad_lengths_are_refused),
    };
    return cmocka_run_group_tests(tests, furnish, clear);
}
