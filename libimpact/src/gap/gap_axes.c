/* SPDX-License-Identifier: MIT
 *
 * The facets of c + B - A. Boxes: 15 axes (Gottschalk 1996), each cross with its own length, so that nothing cancels
 * however parallel the edges are: only a cross that is exactly 0 is left out. Others: the pairs of edges whose arcs on
 * the sphere of normals cross (Gregorius 2013).
 */
#include "base/tolerances.h"
#include "gap/gap_chart.h"
#include "gap/gap_core.h"
#include <string.h>

typedef struct best_axis {
    double g, n[3];
    int axis;
} best_axis;

static void offer(best_axis *best, int axis, double g, double sign, double x, double y, double z)
{
    if (!(g > best->g)) return;
    best->g = g, best->axis = axis;
    best->n[0] = sign * x, best->n[1] = sign * y, best->n[2] = sign * z;
}

/* e_i x R_k */
static double box_cross(const imp_core_pair *pair, int i, int k, double n[3])
{
    const double *a = pair->core[0].axis, *b = pair->core[1].axis;
    const double(*R)[3] = pair->R;
    const int j = (i + 1) % 3, l = (i + 2) % 3, p = (k + 1) % 3, q = (k + 2) % 3;
    const double y = -R[l][k], z = R[j][k], length = sqrt(y * y + z * z);
    if (!(length > 0)) return -INFINITY;
    const double at = y * pair->c[j] + z * pair->c[l], part = (at < 0 ? -1 : 1) / length;
    const double h = a[j] * fabs(y) + a[l] * fabs(z) + b[p] * fabs(y * R[j][p] + z * R[l][p]) +
                     b[q] * fabs(y * R[j][q] + z * R[l][q]);
    n[i] = 0, n[j] = part * y, n[l] = part * z;
    return (fabs(at) - h) / length;
}

double imp_core_box_axis(const imp_core_pair *pair, int axis, double n[3])
{
    const double *a = pair->core[0].axis, *b = pair->core[1].axis, *c = pair->c;
    const double(*R)[3] = pair->R;
    const int k = axis % 3;
    if (axis >= 6) return box_cross(pair, axis / 3 - 2, k, n);
    const double x[3] = {axis < 3 ? k == 0 : R[0][k], axis < 3 ? k == 1 : R[1][k], axis < 3 ? k == 2 : R[2][k]};
    const double at = imp_dot(c, x), sign = at < 0 ? -1 : 1;
    const double h = axis < 3 ? a[k] + b[0] * fabs(R[k][0]) + b[1] * fabs(R[k][1]) + b[2] * fabs(R[k][2])
                              : b[k] + a[0] * fabs(x[0]) + a[1] * fabs(x[1]) + a[2] * fabs(x[2]);
    for (int j = 0; j < 3; j++) n[j] = sign * x[j];
    return fabs(at) - h;
}

double imp_core_box_axes(const imp_core_pair *pair, double n[3], int *axis)
{
    best_axis best = {.g = -INFINITY};
    for (int i = 0; i < IMP_CORE_BOX_AXES; i++) {
        double m[3];
        const double g = imp_core_box_axis(pair, i, m);
        if (g > best.g) offer(&best, i, g, 1, m[0], m[1], m[2]);
    }
    const double length = imp_norm(best.n); /* of an axis of B as long as a rotation's column is, to some roundings */
    for (int k = 0; k < 3; k++) n[k] = best.n[k] / length;
    *axis = best.axis;
    return best.g / length;
}

bool imp_core_box_face(const imp_core_pair *pair, int axis, imp_core_gap *answer)
{
    if (axis > 5) return false;
    const int face_body = axis / 3;
    const double *n = answer->n, *half = pair->core[face_body].axis, gap = answer->lower;
    imp_core_tip tip;
    double a[3], b[3], from[3];
    imp_core_height_between(pair, n, &tip);
    imp_core_place(pair, 0, tip.vertex[0], a);
    imp_core_place(pair, 1, tip.vertex[1], b);
    for (int k = 0; k < 3; k++) from[k] = face_body ? a[k] - pair->c[k] : b[k] + pair->c[k]; /* about the face's body */
    for (int j = 0; j < 3; j++) {
        const double at = face_body ? imp_dot(from, (double[3]){pair->R[0][j], pair->R[1][j], pair->R[2][j]}) : from[j];
        if (j != axis % 3 && !(fabs(at) <= half[j])) return false;
    }
    for (int k = 0; k < 3; k++) {
        answer->x[0][k] = face_body ? a[k] : from[k] - gap * n[k];
        answer->x[1][k] = face_body ? from[k] + gap * n[k] : b[k];
    }
    answer->gap = answer->upper = gap;
    return true;
}

bool imp_core_box_edges(const imp_core_pair *pair, int axis, imp_core_gap *answer)
{
    const int i = axis / 3 - 2, k = axis % 3;
    if (axis < 6) return false;
    const double along[3] = {pair->R[0][k], pair->R[1][k], pair->R[2][k]}, cosine = along[i];
    const double square = along[(i + 1) % 3] * along[(i + 1) % 3] + along[(i + 2) % 3] * along[(i + 2) % 3];
    if (!(square > IMP_CORE_CROSSING)) return false;
    imp_core_tip tip;
    double a[3], b[3];
    imp_core_height_between(pair, answer->n, &tip);
    imp_core_place(pair, 0, tip.vertex[0], a);
    imp_core_place(pair, 1, tip.vertex[1], b);
    const double on = tip.w[i], off = imp_dot(tip.w, along);
    const double t = (cosine * on - off) / square, s = on + t * cosine;
    if (!(fabs(a[i] + s) <= pair->core[0].axis[i] && fabs(imp_dot(b, along) + t) <= pair->core[1].axis[k]))
        return false;
    for (int j = 0; j < 3; j++) answer->x[0][j] = a[j] + (j == i ? s : 0), answer->x[1][j] = b[j] + t * along[j];
    answer->gap = answer->upper = answer->lower;
    return true;
}

static void try_axis(const imp_core_pair *pair, const double n[3], double sign, best_axis *best)
{
    const double length = imp_norm(n);
    if (!(length > 0)) return;
    const double m[3] = {sign * n[0] / length, sign * n[1] / length, sign * n[2] / length};
    imp_core_tip tip;
    offer(best, 6, imp_core_height_between(pair, m, &tip), 1, m[0], m[1], m[2]);
}

/* What the crossing of arcs needs of an edge: its direction and the normals beside it, of B reversed. */
typedef struct arc {
    double e[3], n[2][3];
    bool whole; /* a segment's: the circle */
} arc;

static void arcs_of(const imp_core_pair *pair, int body, arc *arcs)
{
    const impact_hull *hull = pair->core[body].hull;
    double normal[2 * IMPACT_HULL_POINTS][3];
    for (int f = 0; f < hull->face_count; f++) {
        imp_core_face(pair, body, f, normal[f]);
        for (int k = 0; body == 1 && k < 3; k++) normal[f][k] = -normal[f][k];
    }
    for (int i = 0; i < hull->edge_count; i++) {
        imp_core_edge(pair, body, i, arcs[i].e);
        const double length = imp_norm(arcs[i].e);
        for (int k = 0; k < 3; k++) arcs[i].e[k] /= length;
        arcs[i].whole = hull->edge[i].f[0] < 0;
        for (int side = 0; side < 2 && !arcs[i].whole; side++)
            memcpy(arcs[i].n[side], normal[hull->edge[i].f[side]], sizeof normal[0]);
    }
}

/* Whether the ends of an arc are on both sides of the other's circle, or by rounding on it. */
static bool apart(double first, double second)
{
    return first * second < 0 || fabs(first) < IMP_CORE_ARC || fabs(second) < IMP_CORE_ARC;
}

/* Whether they may cross: each has its ends on both sides of the other's circle, and on the same half of the sphere. */
static bool arcs_cross(const arc *a, const arc *b)
{
    double d[4] = {0, 0, 0, 0};
    if (!b->whole) {
        d[0] = imp_dot(b->n[0], a->e), d[1] = imp_dot(b->n[1], a->e);
        if (!apart(d[0], d[1])) return false;
    }
    if (!a->whole) {
        d[2] = imp_dot(a->n[0], b->e), d[3] = imp_dot(a->n[1], b->e);
        if (!apart(d[2], d[3])) return false;
    }
    if (a->whole || b->whole) return true;
    const double sum[3] = {a->n[0][0] + a->n[1][0], a->n[0][1] + a->n[1][1], a->n[0][2] + a->n[1][2]},
                 other[3] = {b->n[0][0] + b->n[1][0], b->n[0][1] + b->n[1][1], b->n[0][2] + b->n[1][2]};
    double cross[3];
    imp_core_cross(a->e, b->e, cross);
    return imp_dot(cross, sum) * imp_dot(cross, other) > -IMP_CORE_ARC;
}

static void edge_axes(const imp_core_pair *pair, best_axis *best)
{
    enum { EDGES = 3 * IMPACT_HULL_POINTS };
    arc arcs[2][EDGES];
    arcs_of(pair, 0, arcs[0]);
    arcs_of(pair, 1, arcs[1]);
    for (int i = 0; i < pair->core[0].hull->edge_count; i++)
        for (int j = 0; j < pair->core[1].hull->edge_count; j++) {
            const arc *a = &arcs[0][i], *b = &arcs[1][j];
            double n[3];
            if (!arcs_cross(a, b)) continue;
            imp_core_cross(a->e, b->e, n);
            if (a->whole || b->whole) {
                try_axis(pair, n, 1, best);
                try_axis(pair, n, -1, best);
            } else {
                const double along = imp_dot(n, a->n[0]) + imp_dot(n, a->n[1]);
                try_axis(pair, n, along < 0 ? -1 : 1, best);
            }
        }
}

double imp_core_axes_of_all(const imp_core_pair *pair, double n[3])
{
    best_axis best = {.g = -INFINITY};
    for (int body = 0; body < 2; body++)
        for (int f = 0; f < pair->core[body].hull->face_count; f++) {
            imp_core_face(pair, body, f, n);
            try_axis(pair, n, body ? -1 : 1, &best);
        }
    edge_axes(pair, &best);
    memcpy(n, best.n, sizeof best.n);
    return best.g;
}

double imp_core_edge_axis(const imp_core_pair *pair, double n[3])
{
    best_axis best = {.g = -INFINITY, .n = {0, 0, 1}};
    edge_axes(pair, &best);
    memcpy(n, best.n, sizeof best.n);
    return best.g;
}
