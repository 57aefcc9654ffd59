/* SPDX-License-Identifier: MIT */
#include "attitude.h"
#include <float.h>

/* One Jacobi rotation that makes a[p][q] zero (Golub and Van Loan, section 8.5). */
static void annihilate(double a[4][4], double v[4][4], int p, int q)
{
    if (a[p][q] == 0) return;
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = copysign(1, theta) / (fabs(theta) + hypot(1, theta));
    const double c = 1 / sqrt(1 + t * t), s = t * c;
    for (int k = 0; k < 4; k++) {
        const double x = a[k][p], y = a[k][q];
        a[k][p] = c * x - s * y;
        a[k][q] = s * x + c * y;
    }
    for (int k = 0; k < 4; k++) {
        const double x = a[p][k], y = a[q][k], vx = v[p][k], vy = v[q][k];
        a[p][k] = c * x - s * y;
        a[q][k] = s * x + c * y;
        v[p][k] = c * vx - s * vy;
        v[q][k] = s * vx + c * vy;
    }
    a[p][q] = a[q][p] = 0;
}

static double off_diagonal(double a[4][4])
{
    double sum = 0;
    for (int i = 0; i < 4; i++)
        for (int j = i + 1; j < 4; j++) sum += fabs(a[i][j]);
    return sum;
}

void quat_eigen4(double a[4][4], double values[4], double vectors[4][4])
{
    double scale = 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            vectors[i][j] = i == j;
            scale = fmax(scale, fabs(a[i][j]));
        }
    /* convergence is quadratic: 4 x 4 needs five or six sweeps; the bound only makes an endless loop impossible */
    for (int sweep = 0; sweep < 30 && off_diagonal(a) > DBL_EPSILON * DBL_EPSILON * scale; sweep++)
        for (int p = 0; p < 3; p++)
            for (int q = p + 1; q < 4; q++) annihilate(a, vectors, p, q);
    for (int i = 0; i < 4; i++) values[i] = a[i][i];
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 4; j++) {
            if (!(values[j] > values[i])) continue;
            const double value = values[i];
            values[i] = values[j];
            values[j] = value;
            for (int k = 0; k < 4; k++) {
                const double x = vectors[i][k];
                vectors[i][k] = vectors[j][k];
                vectors[j][k] = x;
            }
        }
}

static double largest_element(const qmat3 *m)
{
    double largest = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            if (!isfinite(m->m[i][j])) return NAN;
            largest = fmax(largest, fabs(m->m[i][j]));
        }
    return largest;
}

quat_status quat_attitude(const qmat3 *m, quat *q)
{
    *q = quat_identity();
    const double largest = largest_element(m);
    if (!(largest > 0)) return QUAT_EDOMAIN;
    const int shift = -ilogb(largest);
    double s[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) s[i][j] = ldexp(m->m[i][j], shift);
    const double wx = s[2][1] - s[1][2], wy = s[0][2] - s[2][0], wz = s[1][0] - s[0][1];
    const double xy = s[1][0] + s[0][1], xz = s[0][2] + s[2][0], yz = s[2][1] + s[1][2];
    double k[4][4] = {{s[0][0] + s[1][1] + s[2][2], wx, wy, wz},
                      {wx, s[0][0] - s[1][1] - s[2][2], xy, xz},
                      {wy, xy, s[1][1] - s[0][0] - s[2][2], yz},
                      {wz, xz, yz, s[2][2] - s[0][0] - s[1][1]}};
    double values[4], vectors[4][4];
    quat_eigen4(k, values, vectors);
    const double *const v = vectors[0];
    quat_normalize(quat_make(v[0], v[1], v[2], v[3]), q);
    if (q->w < 0) *q = quat_neg(*q);
    return values[0] - values[1] <= 32 * DBL_EPSILON * fmax(values[0], -values[3]) ? QUAT_NOT_UNIQUE : QUAT_OK;
}
