/* SPDX-License-Identifier: MIT
 *
 * What needs no search: the distance over all pairs of an edge with an edge and of a vertex with a face, and the
 * witness points of an overlap.
 */
#include "base/tolerances.h"
#include "gap/flat.h"
#include "gap/gap_chart.h"
#include "gap/gap_core.h"
#include <string.h>

typedef struct closest {
    double square, x[2][3], n[3];
    bool firm;
} closest;

static double clamp_part(double value) { return value > 0 ? value < 1 ? value : 1 : 0; }

/* Points of both bodies (B's with c), and the normal their features fix, or NULL. */
static void offer_points(const double a[3], const double b[3], const double *n, closest *best)
{
    const double v[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, square = imp_dot(v, v);
    if (!(square < best->square)) return;
    best->square = square, best->firm = n != NULL;
    memcpy(best->x[0], a, sizeof best->x[0]);
    memcpy(best->x[1], b, sizeof best->x[1]);
    memcpy(best->n, n ? n : v, sizeof best->n);
    if (n && imp_dot(n, v) < 0)
        for (int k = 0; k < 3; k++) best->n[k] = -n[k];
}

/* v made normal to the edge that an end of the other is nearest to. */
static void square_off(const double *side, double v[3])
{
    for (int again = 0; side && again < 2; again++) {
        const double part = imp_dot(v, side) / imp_dot(side, side);
        for (int k = 0; k < 3; k++) v[k] -= part * side[k];
    }
}

/* The nearest points of the lines a + s d and b + t e; a second time from the first answer, which near parallel lines
 * need: their parts are rounded by u over the angle's square. */
static void of_lines(const double r[3], const double d[3], const double e[3], double square, double *s, double *t)
{
    const double dd = imp_dot(d, d), ee = imp_dot(e, e), de = imp_dot(d, e);
    for (int again = 0; again < 2; again++) {
        double v[3];
        for (int k = 0; k < 3; k++) v[k] = r[k] + *s * d[k] - *t * e[k];
        const double dr = imp_dot(d, v), er = imp_dot(e, v);
        *s += (de * er - dr * ee) / square, *t += (dd * er - de * dr) / square;
    }
}

/* The nearest points of the segments a + s d, b + t e, s and t in [0, 1] (Ericson 2005). */
static void segments(const double a[3], const double d[3], const double b[3], const double e[3], closest *best)
{
    double r[3], cross[3], p[3], q[3], s = 0, t = 0;
    for (int k = 0; k < 3; k++) r[k] = a[k] - b[k];
    imp_core_cross(d, e, cross);
    const double dd = imp_dot(d, d), ee = imp_dot(e, e), de = imp_dot(d, e), dr = imp_dot(d, r), er = imp_dot(e, r);
    const double square = imp_dot(cross, cross);
    if (square > 0) of_lines(r, d, e, square, &s, &t);
    const bool inside = square > 0 && t > 0 && t < 1 && s > 0 && s < 1;
    if (!inside) {
        s = clamp_part(s), t = ee > 0 ? (de * s + er) / ee : 0;
        if (!(t > 0 && t < 1)) {
            t = clamp_part(t);
            s = dd > 0 ? clamp_part((t * de - dr) / dd) : 0;
        }
    }
    for (int k = 0; k < 3; k++) p[k] = a[k] + s * d[k], q[k] = b[k] + t * e[k];
    const double before = best->square;
    offer_points(p, q, inside ? cross : NULL, best);
    if (best->square < before && !inside) square_off(s > 0 && s < 1 ? d : t > 0 && t < 1 ? e : NULL, best->n);
}

static void all_edges(const imp_core_pair *pair, closest *best)
{
    const impact_hull *A = pair->core[0].hull, *B = pair->core[1].hull;
    for (int i = 0; i < A->edge_count; i++) {
        double a[3], d[3], b[3], e[3];
        imp_core_place(pair, 0, A->edge[i].v[0], a);
        imp_core_edge(pair, 0, i, d);
        for (int j = 0; j < B->edge_count; j++) {
            imp_core_place(pair, 1, B->edge[j].v[0], b);
            for (int k = 0; k < 3; k++) b[k] += pair->c[k];
            imp_core_edge(pair, 1, j, e);
            segments(a, d, b, e, best);
        }
    }
}

/* A point against the edges of the other body: for bodies without edges. */
static void lone_point(const imp_core_pair *pair, int body, closest *best)
{
    const impact_hull *other = pair->core[1 - body].hull;
    double p[3], b[3], e[3];
    const double none[3] = {0, 0, 0};
    imp_core_place(pair, body, 0, p);
    for (int k = 0; body == 1 && k < 3; k++) p[k] += pair->c[k];
    for (int j = 0; j < other->edge_count; j++) {
        imp_core_place(pair, 1 - body, other->edge[j].v[0], b);
        for (int k = 0; body == 0 && k < 3; k++) b[k] += pair->c[k];
        imp_core_edge(pair, 1 - body, j, e);
        if (body == 0)
            segments(p, none, b, e, best);
        else
            segments(b, e, p, none, best);
    }
}

/* The vertices of one body over the faces of the other. */
static void all_faces(const imp_core_pair *pair, int body, closest *best)
{
    const impact_hull *hull = pair->core[body].hull, *other = pair->core[1 - body].hull;
    for (int f = 0; f < hull->face_count; f++) {
        double n[3], corner[2][3], first[3];
        imp_core_face(pair, body, f, n);
        const short *loop = hull->loop + hull->start[f];
        const int count = hull->start[f + 1] - hull->start[f];
        imp_core_place(pair, body, loop[0], first);
        for (int v = 0; v < other->vertex_count; v++) {
            double p[3], foot[3];
            imp_core_place(pair, 1 - body, v, p);
            for (int k = 0; k < 3; k++) p[k] += body == 0 ? pair->c[k] : -pair->c[k]; /* about the face's body */
            const double above = imp_dot(n, p) - imp_dot(n, first);
            bool over = above >= 0 && above * above < best->square;
            memcpy(corner[1], first, sizeof first);
            for (int i = 1; over && i <= count; i++) {
                double side[3], from[3], cross[3];
                memcpy(corner[0], corner[1], sizeof first);
                imp_core_place(pair, body, loop[i % count], corner[1]);
                for (int k = 0; k < 3; k++) side[k] = corner[1][k] - corner[0][k], from[k] = p[k] - corner[0][k];
                imp_cross(side, from, cross);
                over = imp_dot(cross, n) >= 0;
            }
            if (!over) continue;
            for (int k = 0; k < 3; k++) foot[k] = p[k] - above * n[k];
            for (int k = 0; body == 1 && k < 3; k++) foot[k] += pair->c[k], p[k] += pair->c[k];
            offer_points(body == 0 ? foot : p, body == 0 ? p : foot, n, best);
        }
    }
}

void imp_core_enumerate(const imp_core_pair *pair, imp_core_gap *answer)
{
    closest best = {.square = INFINITY};
    imp_core_tip tip;
    all_edges(pair, &best);
    all_faces(pair, 0, &best);
    all_faces(pair, 1, &best);
    for (int body = 0; body < 2; body++)
        if (pair->core[body].hull->edge_count == 0) lone_point(pair, body, &best);
    if (best.square == INFINITY) return;
    answer->upper = sqrt(best.square);
    for (int k = 0; k < 3; k++) answer->x[0][k] = best.x[0][k], answer->x[1][k] = best.x[1][k] - pair->c[k];
    const double length = imp_norm(best.n);
    if (!(length > 0)) return;
    const double n[3] = {best.n[0] / length, best.n[1] / length, best.n[2] / length};
    const double g = imp_core_height_between(pair, n, &tip);
    if (!(g > answer->lower)) return;
    answer->lower = g, answer->firm = best.firm;
    memcpy(answer->n, n, sizeof n);
}

/* ---- witness points of an overlap ---- */

/* The vertices that reach as far along d as the body does, but for slack, as a polygon across n, moved by shift. */
static void reached(const imp_core_pair *pair, int body, const double d[3], double t[2][3], const double shift[3],
                    double slack, imp_flat *flat)
{
    double h = -INFINITY, height[IMPACT_HULL_POINTS], x[3];
    const int count = pair->core[body].hull->vertex_count;
    for (int i = 0; i < count; i++) {
        imp_core_place(pair, body, i, x);
        height[i] = imp_dot(d, x);
        h = fmax(h, height[i]);
    }
    flat->count = 0;
    for (int i = 0; i < count; i++) {
        if (!(height[i] >= h - slack)) continue;
        imp_core_place(pair, body, i, x);
        for (int k = 0; k < 3; k++) x[k] += shift[k];
        for (int j = 0; j < 2; j++) flat->p[flat->count][j] = imp_dot(x, t[j]);
        flat->from[flat->count++] = (short)i;
    }
    imp_flat_hull(flat, 0);
}

bool imp_core_witness(const imp_core_pair *pair, double slack, imp_core_gap *answer)
{
    const double *n = answer->n, none[3] = {0, 0, 0};
    double t[2][3], back[3], shift[3], middle[2] = {0, 0};
    imp_core_tip tip;
    imp_flat a, b;
    imp_across(n, t);
    imp_core_height_between(pair, n, &tip);
    imp_core_place(pair, 0, tip.vertex[0], back);
    const double height = imp_dot(n, back);
    for (int k = 0; k < 3; k++) back[k] = -n[k], shift[k] = pair->c[k] - answer->gap * n[k];
    reached(pair, 0, n, t, none, slack * pair->reach, &a);
    reached(pair, 1, back, t, shift, slack * pair->reach, &b);
    imp_flat_clip(&a, &b, slack * pair->reach, 0);
    if (a.count == 0) return false;
    for (int i = 0; i < a.count; i++)
        for (int j = 0; j < 2; j++) middle[j] += a.p[i][j] / a.count;
    for (int k = 0; k < 3; k++) {
        answer->x[0][k] = middle[0] * t[0][k] + middle[1] * t[1][k] + height * n[k];
        answer->x[1][k] = answer->x[0][k] - shift[k];
    }
    return true;
}
