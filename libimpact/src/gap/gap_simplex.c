/* SPDX-License-Identifier: MIT
 *
 * Distance by simplices (Gilbert, Johnson, Keerthi 1988) of the bodies shrunk about their centres by a common factor: a
 * globally convergent seed. Overlapping bodies come apart when shrunk, and their normal then is near the one sought.
 */
#include "base/tolerances.h"
#include "gap/gap_solver.h"
#include <string.h>

typedef struct simplex {
    int count;
    double w[4][3];    /* points of the shrunk c + B - A */
    double x[4][2][3]; /* where they come from */
    double share[4];   /* of the nearest point */
} simplex;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Shares of the point of the affine hull of the chosen vertices nearest to the origin; false unless all are positive.
 */
static bool hull_shares(const simplex *s, const int *index, int count, double *share)
{
    double a[3][4], edge[3][3];
    const double *base = s->w[index[0]];
    for (int i = 1; i < count; i++)
        for (int k = 0; k < 3; k++) edge[i - 1][k] = s->w[index[i]][k] - base[k];
    const int n = count - 1;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) a[i][j] = dot(edge[i], edge[j]);
        a[i][n] = -dot(edge[i], base);
    }
    for (int k = 0; k < n; k++) { /* Gauss; the matrix is symmetric and positive */
        if (!(a[k][k] > 0)) return false;
        for (int i = k + 1; i < n; i++) {
            const double f = a[i][k] / a[k][k];
            for (int j = k; j <= n; j++) a[i][j] -= f * a[k][j];
        }
    }
    share[0] = 1;
    for (int k = n - 1; k >= 0; k--) {
        double sum = a[k][n];
        for (int j = k + 1; j < n; j++) sum -= a[k][j] * share[j + 1];
        share[k + 1] = sum / a[k][k];
        if (!(share[k + 1] > 0)) return false;
    }
    for (int k = 1; k < count; k++) share[0] -= share[k];
    return share[0] > 0;
}

/* Reduces the simplex to the face that holds the point v nearest to the origin; the newest vertex is one of its. */
static double reduce(simplex *s, double v[3])
{
    double best = INFINITY, best_share[4] = {0};
    int best_mask = 0;
    for (int mask = 1 << (s->count - 1); mask < 1 << s->count; mask++) {
        int index[4], count = 0;
        double share[4];
        for (int i = 0; i < s->count; i++)
            if (mask & 1 << i) index[count++] = i;
        if (!hull_shares(s, index, count, share)) continue;
        double p[3] = {0, 0, 0};
        for (int i = 0; i < count; i++)
            for (int k = 0; k < 3; k++) p[k] += share[i] * s->w[index[i]][k];
        const double d = dot(p, p);
        if (d < best) {
            best = d, best_mask = mask;
            memcpy(best_share, share, sizeof best_share);
            memcpy(v, p, sizeof p);
        }
    }
    int count = 0;
    for (int i = 0; i < s->count; i++)
        if (best_mask & 1 << i) {
            if (count != i) {
                memcpy(s->w[count], s->w[i], sizeof s->w[0]);
                memcpy(s->x[count], s->x[i], sizeof s->x[0]);
            }
            s->share[count] = best_share[count];
            count++;
        }
    s->count = count;
    return sqrt(best);
}

/* The bodies' points whose difference is the nearest one. */
static void nearest(const simplex *s, double x[2][3])
{
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 3; j++) {
            x[k][j] = 0;
            for (int i = 0; i < s->count; i++) x[k][j] += s->share[i] * s->x[i][k][j];
        }
}

imp_simplex_end imp_gap_simplex(const imp_gap_solids *pair, double shrink, double tolerance, int steps, double n[3],
                                double x[2][3], double *lower, double *upper)
{
    simplex s = {0};
    double v[3];
    for (int k = 0; k < 3; k++) v[k] = n[k];
    *upper = INFINITY;
    *lower = -INFINITY;
    double best[3] = {n[0], n[1], n[2]}, distance = 1;
    for (int step = 0; step < steps; step++) {
        double u[3], w[3];
        for (int k = 0; k < 3; k++) u[k] = v[k] / distance;
        imp_pair_gap(pair, u, x);
        for (int k = 0; k < 3; k++) w[k] = pair->c[k] + shrink * (x[1][k] - x[0][k]);
        const double bound = dot(u, w);
        if (bound > *lower) {
            *lower = bound;
            memcpy(best, u, sizeof best);
        }
        if (step > 0 && *upper - *lower <= tolerance * (pair->size + *upper)) break;
        bool known = false;
        for (int i = 0; i < s.count; i++) known = known || memcmp(s.w[i], w, sizeof w) == 0;
        if (known) break;
        memcpy(s.w[s.count], w, sizeof w);
        memcpy(s.x[s.count++], x, sizeof s.x[0]);
        distance = reduce(&s, v);
        *upper = fmin(*upper, distance);
        if (s.count == 4 || !(distance > IMP_SIMPLEX_OVERLAPS * pair->size)) {
            memcpy(n, best, sizeof best);
            nearest(&s, x);
            return IMP_SIMPLEX_OVERLAP;
        }
    }
    memcpy(n, best, sizeof best);
    nearest(&s, x);
    return IMP_SIMPLEX_APART;
}
