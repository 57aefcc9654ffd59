/* SPDX-License-Identifier: MIT */
#include "difference.h"

#include <float.h>

enum { nodes = QUAT_DIFFERENCE_NODES, halvings = 12 };

void quat_difference_weights(int n, const double node[], int orders, double weights[][QUAT_DIFFERENCE_NODES])
{
    for (int k = 0; k <= orders; k++)
        for (int i = 0; i < n; i++) weights[k][i] = 0;
    weights[0][0] = 1;
    double before = 1;
    for (int i = 1; i < n; i++) {
        double product = 1;
        for (int j = 0; j < i; j++) {
            const double gap = node[i] - node[j];
            product *= gap;
            for (int k = orders; k >= 0; k--) {
                const double lower = k > 0 ? k * weights[k - 1][j] : 0;
                if (j == i - 1) {
                    const double own = k > 0 ? k * weights[k - 1][i - 1] : 0;
                    weights[k][i] = before / product * (own - node[i - 1] * weights[k][i - 1]);
                }
                weights[k][j] = (node[i] * weights[k][j] - lower) / gap;
            }
        }
        before = product;
    }
}

/* Nodes t + (i - 4) h, shifted to lie in low ... high, as what they are away from t in steps; the middle ones first. */
static void place(double t, double h, double low, double high, double at[nodes], double node[nodes])
{
    static const int outward[nodes] = {0, 1, -1, 2, -2, 3, -3, 4, -4};
    double shift = 0;
    if (t - 4 * h < low) shift = ceil((low - (t - 4 * h)) / h);
    if (t + 4 * h > high) shift = -ceil((t + 4 * h - high) / h);
    for (int i = 0; i < nodes; i++) {
        at[i] = fmin(fmax(t + (outward[i] + shift) * h, low), high);
        node[i] = (at[i] - t) / h; /* of the rounded argument, so that its rounding does no harm */
    }
}

static qvec3 combine(int n, const double weights[], const qvec3 x[])
{
    qvec3 sum = {0, 0, 0};
    for (int i = n - 1; i >= 0; i--) sum = qvec3_axpy(weights[i], x[i], sum);
    return sum;
}

/* Five, seven and nine values give three answers; the last error is taken to shrink as the one before did. */
static double truncation(qvec3 five, qvec3 seven, qvec3 nine)
{
    const double last = qvec3_norm(qvec3_sub(nine, seven)), first = qvec3_norm(qvec3_sub(seven, five));
    return first > last ? last * (last / first) : last;
}

bool quat_differentiate_once(quat_line f, void *context, double t, double low, double high, double step, qvec3 *d)
{
    double at[nodes], node[nodes], weights[2][nodes];
    qvec3 x[nodes];
    place(t, step, low, high, at, node);
    quat_difference_weights(nodes, node, 1, weights);
    for (int i = 0; i < nodes; i++)
        if (!f(at[i], &x[i], context)) return false;
    *d = qvec3_scale(combine(nodes, weights[1], x), 1 / step);
    return true;
}

bool quat_differentiate(quat_line f, void *context, double t, double low, double high, double span, double noise,
                        int orders, qvec3 d[], double error[], double *step)
{
    double h = (isfinite(high - low) ? high - low : span) / 24;
    for (int k = 0; k < orders; k++) error[k] = INFINITY;
    for (int level = 0; level < halvings; level++, h /= 2) {
        double at[nodes], node[nodes], w5[4][nodes], w7[4][nodes], w9[4][nodes], size = 0;
        qvec3 x[nodes];
        bool rounded = true;
        place(t, h, low, high, at, node);
        quat_difference_weights(5, node, orders, w5);
        quat_difference_weights(7, node, orders, w7);
        quat_difference_weights(9, node, orders, w9);
        for (int i = 0; i < nodes; i++) {
            if (!f(at[i], &x[i], context)) return false;
            size = fmax(size, qvec3_norm(x[i]));
        }
        double power = 1;
        for (int k = 1; k <= orders; k++) {
            power *= h;
            const qvec3 nine = combine(9, w9[k], x);
            const double cut = truncation(combine(5, w5[k], x), combine(7, w7[k], x), nine) / power;
            double rounding = 0;
            for (int i = 0; i < nodes; i++) rounding += fabs(w9[k][i]);
            rounding *= (4 * DBL_EPSILON * size + noise) / power; /* f's own rounding included */
            rounded = rounded && cut <= rounding;
            if (cut + rounding < error[k - 1]) {
                error[k - 1] = cut + rounding;
                d[k - 1] = qvec3_scale(nine, 1 / power);
                if (step && k == 1) *step = h;
            }
        }
        if (rounded) break;
    }
    for (int k = 0; k < orders; k++)
        if (!(error[k] < INFINITY) || !qvec3_isfinite(d[k])) return false;
    return true;
}
