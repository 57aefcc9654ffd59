/* SPDX-License-Identifier: MIT
 *
 * Linear systems of known rank: A = B C of random factors, of which the solution of least norm lies in the span of the
 * rows of C.
 */
#include "contact/held_linear.h"
#include "kit/contact_random.h"
#include "kit/near.h"

#include <string.h>

enum { MOST = 24 };

static double random_range(random_stream *random, double low, double high)
{
    return low + (high - low) * random_unit(random);
}

typedef struct factors {
    int n, rank;
    double b[MOST][MOST], c[MOST][MOST]; /* n x rank and rank x n */
    double a[MOST * MOST];
} factors;

static void draw_factors(factors *f, int n, int rank, random_stream *random)
{
    f->n = n, f->rank = rank;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < rank; k++) {
            f->b[i][k] = random_range(random, -1, 1);
            f->c[k][i] = random_range(random, -1, 1);
        }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double sum = 0;
            for (int k = 0; k < rank; k++) sum += f->b[i][k] * f->c[k][j];
            f->a[i * n + j] = sum;
        }
}

/* x in the span of the rows of C, and A x. */
static void draw_solution(const factors *f, random_stream *random, double *x, double *right)
{
    for (int j = 0; j < f->n; j++) x[j] = 0;
    for (int k = 0; k < f->rank; k++) {
        const double weight = random_range(random, -1, 1);
        for (int j = 0; j < f->n; j++) x[j] += weight * f->c[k][j];
    }
    for (int i = 0; i < f->n; i++) {
        right[i] = 0;
        for (int j = 0; j < f->n; j++) right[i] += f->a[i * f->n + j] * x[j];
    }
}

static void the_solution_of_least_norm(void **state)
{
    (void)state;
    random_stream random = {71};
    int checked = 0;
    for (int k = 0; k < 4000; k++) {
        const int n = 1 + (int)random_range(&random, 0, MOST - 0.01);
        const int missing = k % 2 ? 0 : (int)random_range(&random, 0, 0.5 * n);
        factors f = {0};
        double x[MOST], got[MOST], matrix[MOST * MOST], spare[MOST * MOST], scratch[MOST];
        int rows[MOST], columns[MOST];
        draw_factors(&f, n, n - missing, &random);
        draw_solution(&f, &random, x, got);
        memcpy(matrix, f.a, sizeof matrix);
        imp_linear system = {
            .n = n, .matrix = matrix, .spare = spare, .scratch = scratch, .rows = rows, .columns = columns};
        imp_linear_factor(&system);
        assert_int_equal(system.rank, n - missing);
        imp_linear_solve(&system, got);
        double residual = 0, error = 0, norm = 0;
        for (int i = 0; i < n; i++) {
            double left = 0;
            for (int j = 0; j < n; j++) left += f.a[i * n + j] * (got[j] - x[j]);
            residual = fmax(residual, fabs(left));
            error = fmax(error, fabs(got[i] - x[i]));
            norm = fmax(norm, fabs(x[i]));
        }
        assert_at_most(residual, 1e-12 * (1 + norm));
        checked += error < 1e-9 * norm; /* most of the random systems are no worse conditioned than that */
    }
    assert_true(checked > 3900);
}

/* Nothing is asked of nothing. */
static void a_system_of_zeros(void **state)
{
    (void)state;
    double matrix[4] = {0, 0, 0, 0}, spare[4], scratch[2], x[2] = {0, 0};
    int rows[2], columns[2];
    imp_linear system = {
        .n = 2, .matrix = matrix, .spare = spare, .scratch = scratch, .rows = rows, .columns = columns};
    imp_linear_factor(&system);
    assert_int_equal(system.rank, 0);
    imp_linear_solve(&system, x);
    assert_true(x[0] == 0 && x[1] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_solution_of_least_norm),
        cmocka_unit_test(a_system_of_zeros),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
