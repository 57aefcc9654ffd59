/* SPDX-License-Identifier: MIT
 *
 * Principal moments and axes of an inertia tensor, by Jacobi's method.
 */
#include <impact/collide.h>
#include <quat/rotation.h>

#include <float.h>
#include "base/tolerances.h"

/* One rotation in the plane (p, q) that zeroes a[p][q]; v gathers the rotations. */
static void rotate(double a[3][3], double v[3][3], int p, int q)
{
    if (a[p][q] == 0) return;
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = copysign(1 / (fabs(theta) + sqrt(theta * theta + 1)), theta), c = 1 / sqrt(t * t + 1), s = t * c;
    for (int i = 0; i < 3; i++) {
        const double x = a[i][p], y = a[i][q];
        a[i][p] = c * x - s * y;
        a[i][q] = s * x + c * y;
    }
    for (int i = 0; i < 3; i++) {
        const double x = a[p][i], y = a[q][i];
        a[p][i] = c * x - s * y;
        a[q][i] = s * x + c * y;
    }
    for (int i = 0; i < 3; i++) {
        const double x = v[i][p], y = v[i][q];
        v[i][p] = c * x - s * y;
        v[i][q] = s * x + c * y;
    }
}

impact_status impact_principal_axes(const qmat3 *tensor, qvec3 *moments, quat *orientation)
{
    double a[3][3], size = 0;
    *moments = (qvec3){NAN, NAN, NAN};
    *orientation = quat_identity();
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            if (!isfinite(tensor->m[i][j])) return IMPACT_EDOMAIN;
            size = fmax(size, fabs(tensor->m[i][j]));
        }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            if (fabs(tensor->m[i][j] - tensor->m[j][i]) > IMP_COLLIDE_SYMMETRIC * size) return IMPACT_EARGUMENT;
            a[i][j] = 0.5 * (tensor->m[i][j] + tensor->m[j][i]);
        }
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 12; sweep++) {
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
        if (fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]) <= DBL_MIN * size) break;
    }
    *moments = (qvec3){a[0][0], a[1][1], a[2][2]};
    if (!(a[0][0] > 0 && a[1][1] > 0 && a[2][2] > 0)) return IMPACT_EARGUMENT;
    qmat3 axes;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) axes.m[i][j] = v[i][j];
    return quat_from_matrix(&axes, orientation) == QUAT_OK ? IMPACT_OK : IMPACT_EDOMAIN;
}
