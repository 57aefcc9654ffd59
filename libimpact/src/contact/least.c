/* SPDX-License-Identifier: MIT
 *
 * W_SS = L L^T by Cholesky with pivoting, L of as many columns as the rank, so that W_SS^+ = H H^T with
 * H = L (L^T L)^-1. Of the projection P = 1 - W_SS^+ W_SS onto the null space the same gives P = N N^T with
 * N^T N = 1: P's pivots are 1/n at the least as long as there is any, since those left sum to a whole number.
 */
#include "contact/least.h"
#include "contact/held_linear.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct least_part {
    const double *w;
    int width, n;
    const int *which; /* NULL: all */
} least_part;

static double least_entry(const least_part *p, int i, int j)
{
    const int row = p->which ? p->which[i] : i, column = p->which ? p->which[j] : j;
    return p->w[(size_t)row * (size_t)p->width + (size_t)column];
}

/* Columns of L by rows of n numbers, in the rows' own order; returns the rank. order, unless NULL: the rows as they
 * were taken, of which L is a lower triangle. */
static int least_factor(const least_part *p, double rank_of, double *l, double *diagonal, int *order)
{
    const int n = p->n;
    double most = 0;
    for (int i = 0; i < n; i++) most = fmax(most, diagonal[i] = least_entry(p, i, i));
    for (int rank = 0; rank < n; rank++) {
        int best = 0;
        for (int i = 1; i < n; i++)
            if (diagonal[i] > diagonal[best]) best = i;
        if (!(diagonal[best] > rank_of * most)) return rank;
        const double *from = &l[(size_t)best * (size_t)n], pivot = sqrt(diagonal[best]);
        diagonal[best] = -INFINITY; /* taken: zero from here on */
        for (int i = 0; i < n; i++) {
            double *row = &l[(size_t)i * (size_t)n];
            row[rank] = i == best         ? pivot
                        : diagonal[i] < 0 ? 0
                                          : (least_entry(p, i, best) - imp_linear_dot(row, from, rank)) / pivot;
            diagonal[i] -= row[rank] * row[rank];
        }
        if (order) order[rank] = best;
    }
    return n;
}

/* Solves (L^T L) x = b, r x r, by Cholesky in place; b becomes x. columns right sides by rows. */
static void least_solve(double *a, int r, double *b, int columns)
{
    for (int k = 0; k < r; k++) {
        for (int m = 0; m < k; m++) a[k * r + k] -= a[k * r + m] * a[k * r + m];
        a[k * r + k] = sqrt(a[k * r + k]);
        for (int i = k + 1; i < r; i++) {
            for (int m = 0; m < k; m++) a[i * r + k] -= a[i * r + m] * a[k * r + m];
            a[i * r + k] /= a[k * r + k];
        }
    }
    for (int c = 0; c < columns; c++) {
        for (int i = 0; i < r; i++) {
            for (int m = 0; m < i; m++) b[i * columns + c] -= a[i * r + m] * b[m * columns + c];
            b[i * columns + c] /= a[i * r + i];
        }
        for (int i = r - 1; i >= 0; i--) {
            for (int m = i + 1; m < r; m++) b[i * columns + c] -= a[m * r + i] * b[m * columns + c];
            b[i * columns + c] /= a[i * r + i];
        }
    }
}

int imp_least_inverse(const double *w, int width, const int *which, int n, double rank, double *scratch,
                      double *inverse)
{
    const least_part p = {w, width, n, which};
    double *l = scratch, *normal = l + n * n, *h = normal + n * n, *diagonal = h + n * n;
    const int r = least_factor(&p, rank, l, diagonal, NULL);
    for (int i = 0; i < r; i++)
        for (int j = 0; j < r; j++) {
            double sum = 0;
            for (int k = 0; k < n; k++) sum += l[k * n + i] * l[k * n + j];
            normal[i * r + j] = sum;
        }
    for (int i = 0; i < r; i++)
        for (int j = 0; j < n; j++) h[i * n + j] = l[j * n + i];
    least_solve(normal, r, h, n);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double sum = 0;
            for (int k = 0; k < r; k++) sum += h[k * n + i] * h[k * n + j];
            inverse[i * n + j] = sum;
        }
    return r;
}

int imp_least_null(const double *w, int width, const int *which, int n, const double *inverse, double *scratch,
                   double *basis)
{
    const least_part p = {w, width, n, which};
    double *projection = scratch, *diagonal = scratch + n * n;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double sum = i == j;
            for (int k = 0; k < n; k++) sum -= inverse[i * n + k] * least_entry(&p, k, j);
            projection[i * n + j] = sum;
        }
    return least_factor(&(least_part){projection, n, n, NULL}, 0.5 / n, basis, diagonal, NULL);
}

void imp_least_solve(double *a, int m, double *b)
{
    for (int k = 0; k < m; k++) {
        const double whole = a[k * m + k];
        for (int j = 0; j < k; j++) a[k * m + k] -= a[k * m + j] * a[k * m + j];
        const bool none = !(a[k * m + k] > m * DBL_EPSILON * whole);
        const double pivot = none ? INFINITY : sqrt(a[k * m + k]);
        for (int i = k + 1; i < m; i++) {
            for (int j = 0; j < k; j++) a[i * m + k] -= a[i * m + j] * a[k * m + j];
            a[i * m + k] /= pivot;
        }
        a[k * m + k] = pivot;
        for (int j = 0; j < k; j++) b[k] -= a[k * m + j] * b[j];
        b[k] /= pivot;
    }
    for (int i = m - 1; i >= 0; i--) {
        for (int j = i + 1; j < m; j++) b[i] -= a[j * m + i] * b[j];
        b[i] /= a[i * m + i];
    }
}

int imp_least_solve_pivoted(const double *a, int n, double rank, double *scratch, int *order, double *b)
{
    const least_part p = {a, n, n, NULL};
    double *l = scratch, *x = l + (size_t)n * (size_t)n;
    const int r = least_factor(&p, rank, l, x, order);
    for (int i = 0; i < r; i++) {
        const double *row = &l[(size_t)order[i] * (size_t)n];
        x[i] = (b[order[i]] - imp_linear_dot(row, x, i)) / row[i];
    }
    for (int i = 0; i < n; i++) b[i] = 0;
    for (int i = r - 1; i >= 0; i--) {
        const double *row = &l[(size_t)order[i] * (size_t)n];
        b[order[i]] = x[i] / row[i];
        for (int j = 0; j < i; j++) x[j] -= row[j] * b[order[i]];
    }
    return r;
}
