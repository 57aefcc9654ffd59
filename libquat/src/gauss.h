/* SPDX-License-Identifier: MIT
 *
 * gauss: the mesh over which frames are chosen. Internal to gauss.c and gauss_area.c.
 */
#ifndef QUAT_GAUSS_H
#define QUAT_GAUSS_H

#include <quat/surface.h>

typedef struct quat_mesh {
    size_t n, m;
    const size_t (*triangle)[3];
    const double (*weight)[3]; /* of the edge opposite to each corner: half the cotangent of the corner's angle */
} quat_mesh;

/* q turned by `angle` about its own z axis. */
static inline quat quat_gauge_turn(quat q, double angle)
{
    return quat_mul(q, quat_make(cos(angle / 2), 0, 0, sin(angle / 2)));
}

/* The sum of the triangles' areas. */
double quat_gauge_area(const quat_mesh *mesh, const quat q[]);

/* Lowers the area from q on, in place, by GSL's BFGS over the nodes' angles: the areas are rounded off where they
 * vanish, less and less. Left as they are when that gains less than 1e-9. work holds 6 n numbers, trial n frames. */
quat_status quat_gauge_lower_area(const quat_mesh *mesh, quat q[], double work[], quat trial[], size_t *rounds);

#endif
