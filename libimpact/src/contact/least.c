/* SPDX-License-Identifier: MIT
 *
 * W_SS = L L^T by Cholesky with pivoting, L of as many columns as the rank, so that W_SS^+ = H H^T with
 * H = L (L^T L)^-1.
 */
#include "contact/least.h"

#include <math.h>
#include <stddef.h>

typedef struct least_part {
    const double *w;
    int width, n;
    const int *which;
} least_part;

static double least_entry(const least_part *p, int i, int j)
{
    return p->w[(size_t)p->which[i] * (size_t)p->width + (size_t)p->which[j]];
}

/* Columns of L, n x rank, in the rows' own order; returns the rank. */
static int least_factor(const least_part *p, double rank_of, double *l, double *diagonal)
{
    const int n = p->n;
    double most = 0;
    for (int i = 0; i < n; i++) most = fmax(most, diagonal[i] = least_entry(p, i, i));
    int rank = 0;
    for (; rank < n; rank++) {
        int best = 0;
        for (int i = 1; i < n; i++)
            if (diagonal[i] > diagonal[best]) best = i;
        if (!(diagonal[best] > rank_of * most)) break;
        const double pivot = sqrt(diagonal[best]);
        for (int i = 0; i < n; i++) {
            double sum = least_entry(p, i, best);
            for (int k = 0; k < rank; k++) sum -= l[i * n + k] * l[best * n + k];
            l[i * n + rank] = sum / pivot;
        }
        for (int i = 0; i < n; i++) diagonal[i] -= l[i * n + rank] * l[i * n + rank];
        diagonal[best] = -1;
        for (int i = 0; i < n; i++)
            if (diagonal[i] == -1) l[i * n + rank] = i == best ? pivot : l[i * n + rank];
    }
    return rank;
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
    const int r = least_factor(&p, rank, l, diagonal);
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
