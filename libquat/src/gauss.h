/* SPDX-License-Identifier: MIT
 *
 * gauss: the mesh over which frames are chosen, and what is least. Internal to gauss.c, gauss_cost.c, gauss_lower.c.
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

/* The ends of the edge opposite corner c of triangle i. */
static inline void quat_mesh_edge(const quat_mesh *mesh, size_t i, int c, size_t *a, size_t *b)
{
    *a = mesh->triangle[i][(c + 1) % 3];
    *b = mesh->triangle[i][(c + 2) % 3];
}

/* What one triangle costs, and how that changes with its corners' angles. An angle common to all three changes nothing:
 * the slopes sum to 0, and the second derivatives are those of springs along the edges: stiffness[c], opposite corner
 * c, is minus the mixed one of its ends. */
typedef struct quat_triangle_cost {
    double value, slope[3], stiffness[3];
} quat_triangle_cost;

typedef quat_triangle_cost (*quat_gauge_cost)(const quat_mesh *mesh, size_t i, const quat q[], double soft);

/* The sum over the edges of weight |q_a - q_b|^2, neighbours turned to one side of S^3; `soft` is not used. */
quat_triangle_cost quat_gauge_length(const quat_mesh *mesh, size_t i, const quat q[], double soft);
/* sqrt(A^2 + soft^2) - soft for the area A of the flat triangle in R^4: smooth where A vanishes, for soft > 0. */
quat_triangle_cost quat_gauge_area(const quat_mesh *mesh, size_t i, const quat q[], double soft);

/* The cost of all triangles. */
double quat_gauge_sum(const quat_mesh *mesh, quat_gauge_cost cost, const quat q[], double soft);

/* Lowers the sum from q on, in place, over the nodes' angles, that of node 0 held: Newton's method, conjugate gradients
 * inside, down to rounding. work holds 7 n + 3 m numbers, trial n frames; *rounds counts on. QUAT_NOT_CONVERGED when
 * 200 rounds are not enough. */
quat_status quat_gauge_lower(const quat_mesh *mesh, quat_gauge_cost cost, double soft, quat q[], double work[],
                             quat trial[], size_t *rounds);

#endif
