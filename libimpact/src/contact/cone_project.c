/* SPDX-License-Identifier: MIT */
#include "contact/cone.h"

#include <math.h>
#include <string.h>

void imp_cone_project(double friction, const double *v, double *to, double slope[3][3])
{
    const double across = friction > 0 ? sqrt(v[1] * v[1] + v[2] * v[2]) : 0;
    if (slope) memset(slope, 0, 9 * sizeof slope[0][0]);
    to[0] = to[1] = to[2] = 0;
    if (v[0] >= 0 && across <= friction * v[0]) {
        for (int k = 0; k < (friction > 0 ? 3 : 1); k++) {
            to[k] = v[k];
            if (slope) slope[k][k] = 1;
        }
        return;
    }
    if (v[0] <= -friction * across) return;
    const double part = 1 / (1 + friction * friction), dir[3] = {1, friction * v[1] / across, friction * v[2] / across};
    const double size = part * (v[0] + friction * across);
    for (int k = 0; k < 3; k++) {
        to[k] = size * dir[k];
        for (int l = 0; slope && l < 3; l++) slope[k][l] = part * dir[k] * dir[l];
    }
    const double turn = friction * size / across;
    for (int k = 1; slope && k < 3; k++)
        for (int l = 1; l < 3; l++) slope[k][l] += turn * ((k == l) - v[k] * v[l] / (across * across));
}
