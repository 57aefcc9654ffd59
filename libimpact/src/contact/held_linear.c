/* SPDX-License-Identifier: MIT
 *
 * P A Q = L U, of rank r: with z = Q^-1 x, the first r of z follow from the others, which are free. The least z is one
 * solution less its part along those of the homogeneous system, for which an orthonormal basis is kept.
 */
#include "contact/held_linear.h"
#include "base/tolerances.h"

#include <math.h>
#include <string.h>

static double *row_of(const imp_linear *system, int i) { return &system->matrix[i * system->n]; }

static void swap_rows(imp_linear *system, int i, int j)
{
    if (i == j) return;
    double *a = row_of(system, i), *b = row_of(system, j);
    for (int k = 0; k < system->n; k++) {
        const double swap = a[k];
        a[k] = b[k], b[k] = swap;
    }
    const int swap = system->rows[i];
    system->rows[i] = system->rows[j], system->rows[j] = swap;
}

static void swap_columns(imp_linear *system, int i, int j)
{
    if (i == j) return;
    for (int k = 0; k < system->n; k++) {
        double *row = row_of(system, k);
        const double swap = row[i];
        row[i] = row[j], row[j] = swap;
    }
    const int swap = system->columns[i];
    system->columns[i] = system->columns[j], system->columns[j] = swap;
}

static void begin_elimination(imp_linear *system)
{
    system->rank = system->n;
    system->sign = 1;
    for (int k = 0; k < system->n; k++) system->rows[k] = system->columns[k] = k;
}

double imp_linear_dot(const double *a, const double *b, int n)
{
    double sum[4] = {0, 0, 0, 0};
    int i = 0;
    for (; i + 4 <= n; i += 4)
        for (int k = 0; k < 4; k++) sum[k] += a[i + k] * b[i + k];
    for (; i < n; i++) sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* a less factor b. */
static void subtract(double *a, double factor, const double *b, int n)
{
    for (int i = 0; i < n; i++) a[i] -= factor * b[i];
}

/* ---- pivots from columns, four at a time: one pass over what is left instead of four, in the same order of sums ----
 */

enum { PANEL = 4 };

/* row -= factors[0] from[0] - factors[1] from[1] ... from column `first` on. */
static void subtract_rows(double *restrict row, const double *factors, const double *from, int n, int first, int count)
{
    if (count < PANEL) {
        for (int l = 0; l < count; l++)
            for (int j = first; j < n; j++) row[j] -= factors[l] * from[l * n + j];
        return;
    }
    const double f0 = factors[0], f1 = factors[1], f2 = factors[2], f3 = factors[3];
    const double *restrict a = from, *restrict b = a + n, *restrict c = b + n, *restrict d = c + n;
    for (int j = first; j < n; j++) row[j] = (((row[j] - f0 * a[j]) - f1 * b[j]) - f2 * c[j]) - f3 * d[j];
}

/* Takes the columns k to k + width apart, these columns alone; false where a pivot does not exceed the least. */
static bool reduce_panel(imp_linear *system, int first, int width, double least)
{
    const int n = system->n;
    const double *a = system->matrix;
    for (int k = first; k < first + width; k++) {
        int row = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i * n + k]) > fabs(a[row * n + k])) row = i;
        if (!(fabs(a[row * n + k]) > least)) return false;
        if (row != k) system->sign = -system->sign;
        swap_rows(system, k, row);
        const double *from = row_of(system, k);
        if (from[k] < 0) system->sign = -system->sign;
        for (int i = k + 1; i < n; i++) {
            double *own = row_of(system, i);
            own[k] /= from[k];
            for (int j = k + 1; j < first + width; j++) own[j] -= own[k] * from[j];
        }
    }
    return true;
}

/* False where a pivot does not exceed the least. */
static bool reduce_regular(imp_linear *system, double least)
{
    const int n = system->n;
    begin_elimination(system);
    for (int first = 0; first < n; first += PANEL) {
        const int width = n - first < PANEL ? n - first : PANEL, next = first + width;
        if (!reduce_panel(system, first, width, least)) return false;
        for (int i = first + 1; i < n; i++)
            subtract_rows(row_of(system, i), row_of(system, i) + first, row_of(system, first), n, next,
                          i < next ? i - first : width);
    }
    return true;
}

bool imp_linear_factor_regular(imp_linear *system) { return reduce_regular(system, 0); }

/* The largest of so many numbers, by four maxima at a time, none of which waits for another. */
static double largest_entry(const double *a, int count)
{
    enum { LANES = 4 };
    double most[LANES] = {0, 0, 0, 0};
    int i = 0;
    for (; i + LANES <= count; i += LANES)
        for (int k = 0; k < LANES; k++) {
            const double size = fabs(a[i + k]);
            most[k] = size > most[k] ? size : most[k];
        }
    for (; i < count; i++) most[0] = fabs(a[i]) > most[0] ? fabs(a[i]) : most[0];
    const double low = most[0] > most[1] ? most[0] : most[1], high = most[2] > most[3] ? most[2] : most[3];
    return low > high ? low : high;
}

/* With complete pivoting, as far as pivots do not vanish. What is largest in each row is kept as rows change: of rows
 * that do not change, by a pivot column with a zero there, it stays. */
static void reduce_singular(imp_linear *system, double least)
{
    const int n = system->n;
    double *most = system->scratch;
    begin_elimination(system);
    for (int i = 0; i < n; i++) most[i] = largest_entry(row_of(system, i), n);
    for (int k = 0; k < n; k++) {
        int row = k, column = k;
        for (int i = k + 1; i < n; i++)
            if (most[i] > most[row]) row = i;
        if (!(most[row] > least)) {
            system->rank = k;
            return;
        }
        while (fabs(row_of(system, row)[column]) < most[row]) column++;
        swap_rows(system, k, row);
        most[row] = most[k];
        swap_columns(system, k, column);
        const double *from = row_of(system, k);
        for (int i = k + 1; i < n; i++) {
            double *own = row_of(system, i);
            if (own[k] == 0) continue;
            own[k] /= from[k];
            subtract(&own[k + 1], own[k], &from[k + 1], n - k - 1);
            most[i] = largest_entry(&own[k + 1], n - k - 1);
        }
    }
}

/* Solves the upper triangle of the first `rank` rows. */
static void substitute_back(const imp_linear *system, double *z)
{
    for (int i = system->rank - 1; i >= 0; i--) {
        const double *row = row_of(system, i);
        for (int j = i + 1; j < system->rank; j++) z[i] -= row[j] * z[j];
        z[i] /= row[i];
    }
}

static double *basis_of(const imp_linear *system, int k) { return &system->spare[(k - system->rank) * system->n]; }

/* Of the homogeneous system: by Gram and Schmidt, twice, from those with a single one of the free unknowns. */
static void find_basis(const imp_linear *system)
{
    const int n = system->n, rank = system->rank;
    for (int k = rank; k < n; k++) {
        double *own = basis_of(system, k);
        for (int i = 0; i < n; i++) own[i] = i < rank ? -row_of(system, i)[k] : i == k;
        substitute_back(system, own);
        for (int twice = 0; twice < 2; twice++)
            for (int l = rank; l < k; l++)
                subtract(own, imp_linear_dot(own, basis_of(system, l), n), basis_of(system, l), n);
        const double size = sqrt(imp_linear_dot(own, own, n));
        for (int i = 0; i < n; i++) own[i] /= size;
    }
}

void imp_linear_factor(imp_linear *system)
{
    const size_t bytes = (size_t)system->n * (size_t)system->n * sizeof *system->matrix;
    const double most = largest_entry(system->matrix, system->n * system->n);
    const double none = system->vanishing > 0 ? system->vanishing : IMP_LINEAR_VANISHING;
    memcpy(system->spare, system->matrix, bytes);
    if (reduce_regular(system, fmax(system->doubtful, none) * most)) return;
    memcpy(system->matrix, system->spare, bytes);
    reduce_singular(system, none * most);
    system->sign = 0;
    find_basis(system);
}

void imp_linear_solve(const imp_linear *system, double *x)
{
    const int n = system->n, rank = system->rank;
    double *z = system->scratch;
    for (int i = 0; i < n; i++) z[i] = i < rank ? x[system->rows[i]] : 0;
    for (int i = 0; i < rank; i++) {
        const double *row = row_of(system, i);
        double sum = 0;
        for (int j = 0; j < i; j++) sum += row[j] * z[j];
        z[i] -= sum;
    }
    substitute_back(system, z);
    for (int k = rank; k < n; k++) subtract(z, imp_linear_dot(z, basis_of(system, k), n), basis_of(system, k), n);
    for (int i = 0; i < n; i++) x[system->columns[i]] = z[i];
}
