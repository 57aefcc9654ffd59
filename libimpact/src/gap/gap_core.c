/* SPDX-License-Identifier: MIT */
#include "gap/gap_core.h"
#include "base/tolerances.h"
#include "gap/gap_chart.h"
#include <string.h>

void imp_core_cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double product = a[j] * b[i], error = fma(-a[j], b[i], product);
        c[k] = fma(a[i], b[j], -product) + error;
    }
}

static void turn(const double R[3][3], const double x[3], double y[3])
{
    for (int i = 0; i < 3; i++) y[i] = R[i][0] * x[0] + R[i][1] * x[1] + R[i][2] * x[2];
}

void imp_core_place(const imp_core_pair *pair, int body, int vertex, double x[3])
{
    double own[3];
    imp_core_vertex(&pair->core[body], vertex, own);
    if (body)
        turn(pair->R, own, x);
    else
        memcpy(x, own, sizeof own);
}

void imp_core_edge(const imp_core_pair *pair, int body, int edge, double e[3])
{
    const imp_core *core = &pair->core[body];
    const short *v = core->hull->edge[edge].v;
    double own[3];
    for (int k = 0; k < 3; k++) own[k] = core->axis[k] * (core->hull->vertex[v[1]][k] - core->hull->vertex[v[0]][k]);
    if (body)
        turn(pair->R, own, e);
    else
        memcpy(e, own, sizeof own);
}

void imp_core_face(const imp_core_pair *pair, int body, int face, double n[3])
{
    double own[3];
    imp_core_normal(&pair->core[body], face, own);
    if (body)
        turn(pair->R, own, n);
    else
        memcpy(n, own, sizeof own);
}

static void reach_of(const imp_core_pair *pair, int body, const double d[3], int *vertex)
{
    if (pair->box[body])
        *vertex = (d[0] > 0) | (d[1] > 0) << 1 | (d[2] > 0) << 2;
    else
        imp_core_support(&pair->core[body], d, vertex);
}

double imp_core_height_between(const imp_core_pair *pair, const double n[3], imp_core_tip *tip)
{
    double back[3], a[3], b[3];
    for (int k = 0; k < 3; k++) back[k] = -(n[0] * pair->R[0][k] + n[1] * pair->R[1][k] + n[2] * pair->R[2][k]);
    reach_of(pair, 0, n, &tip->vertex[0]);
    reach_of(pair, 1, back, &tip->vertex[1]);
    imp_core_place(pair, 0, tip->vertex[0], a);
    imp_core_place(pair, 1, tip->vertex[1], b);
    for (int k = 0; k < 3; k++) tip->w[k] = pair->c[k] + b[k] - a[k];
    return imp_dot(n, tip->w);
}

static bool settled(const imp_core_pair *pair, const imp_core_gap *answer)
{
    return answer->upper - answer->lower <= IMP_CORE_ACCEPTED * pair->reach;
}

/* The told gap lies between: where the features fix the normal g is the more exact, else the distance. */
static impact_status told_apart(const imp_core_pair *pair, imp_core_gap *answer)
{
    if (!settled(pair, answer)) imp_core_enumerate(pair, answer);
    answer->upper = fmax(answer->upper, answer->lower);
    answer->gap = answer->firm ? answer->lower : answer->upper;
    if (!settled(pair, answer)) return IMPACT_BRACKET;
    return IMPACT_OK;
}

/* The answer along another normal, if that is as good and there are points for it. */
static bool turned_to(const imp_core_pair *pair, double g, const double n[3], double slack, imp_core_gap *answer)
{
    imp_core_gap other = *answer;
    if (!(answer->lower - g <= IMP_CORE_ACCEPTED * pair->reach)) return false;
    other.gap = other.upper = other.lower = g;
    memcpy(other.n, n, sizeof other.n);
    if (!imp_core_witness(pair, slack, &other)) return false;
    *answer = other;
    return true;
}

static bool turned_to_any(const imp_core_pair *pair, double slack, imp_core_gap *answer)
{
    double n[3];
    if (!pair->box[0] || !pair->box[1]) return turned_to(pair, imp_core_edge_axis(pair, n), n, slack, answer);
    for (int axis = 0; axis < IMP_CORE_BOX_AXES; axis++)
        if (turned_to(pair, imp_core_box_axis(pair, axis, n), n, slack, answer)) return true;
    return false;
}

/* Where a normal is best by a rounding and no features along it lie on each other, as no vertex is over the face whose
 * it is, others cross near by: their own normal is as good, and the points are theirs. Where there are none, more is
 * taken to reach as far. */
static impact_status overlapping(const imp_core_pair *pair, imp_core_gap *answer)
{
    answer->gap = answer->upper = answer->lower;
    answer->firm = true;
    for (double slack = IMP_CORE_LEVEL; slack <= IMP_CORE_LEVEL_MOST; slack *= 8)
        if (imp_core_witness(pair, slack, answer) || turned_to_any(pair, slack, answer)) return IMPACT_OK;
    return IMPACT_BRACKET;
}

/* A unit vector normal to the segments, if any, whose middle lines meet: g is 0 along it. */
static void stray_normal(const imp_core_pair *pair, double n[3])
{
    double e[2][3] = {{0}}, t[2][3];
    int edges = 0;
    for (int body = 0; body < 2; body++)
        if (pair->core[body].hull->edge_count > 0) imp_core_edge(pair, body, 0, e[edges++]);
    if (edges == 2) {
        imp_core_cross(e[0], e[1], n);
        const double length = imp_norm(n);
        if (length > 0) {
            for (int k = 0; k < 3; k++) n[k] /= length;
            return;
        }
    }
    const double length = imp_norm(e[0]);
    for (int k = 0; k < 3; k++) n[k] = edges > 0 ? e[0][k] / length : 0;
    if (edges == 0) n[0] = 1;
    imp_across(n, t);
    memcpy(n, t[0], sizeof t[0]);
}

/* Points and segments: no facets; where they meet any normal will do. */
static impact_status thin_pair(const imp_core_pair *pair, imp_core_gap *answer)
{
    imp_core_enumerate(pair, answer);
    if (answer->upper > IMP_CORE_ACCEPTED * pair->reach) return told_apart(pair, answer);
    imp_core_tip tip;
    stray_normal(pair, answer->n);
    answer->lower = imp_core_height_between(pair, answer->n, &tip);
    return told_apart(pair, answer);
}

impact_status imp_core_solve(const imp_core_pair *pair, const double *cached, imp_core_gap *answer)
{
    *answer = (imp_core_gap){.lower = -INFINITY, .upper = INFINITY};
    const double distance = imp_norm(pair->c);
    for (int k = 0; k < 3; k++) answer->n[k] = distance > 0 ? pair->c[k] / distance : k == 2;
    if (pair->core[0].hull->face_count + pair->core[1].hull->face_count == 0) return thin_pair(pair, answer);
    const bool boxes = pair->box[0] && pair->box[1];
    if (boxes) {
        int axis;
        answer->lower = imp_core_box_axes(pair, answer->n, &axis);
        answer->firm = true;
        if (imp_core_box_face(pair, axis, answer) || imp_core_box_edges(pair, axis, answer)) return IMPACT_OK;
        if (!(answer->lower > 0)) return overlapping(pair, answer);
    } else if (cached) {
        memcpy(answer->n, cached, sizeof answer->n);
    }
    if (imp_core_nearest(pair, answer)) {
        if (answer->lower > 0 && settled(pair, answer)) return told_apart(pair, answer);
        if (answer->upper > IMP_CORE_TOUCHING * pair->reach && told_apart(pair, answer) == IMPACT_OK) return IMPACT_OK;
    }
    if (!boxes) {
        double n[3];
        const double g = imp_core_axes_of_all(pair, n);
        if (g > answer->lower) answer->lower = g, answer->firm = true, memcpy(answer->n, n, sizeof n);
    }
    if (answer->upper < INFINITY && answer->lower > 0) return told_apart(pair, answer);
    return overlapping(pair, answer);
}
