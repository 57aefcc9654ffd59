/* SPDX-License-Identifier: MIT
 *
 * Two octahedra (exponents 1) that overlap. Their difference c + B - A is a polytope, and g, the least v.n over its
 * vertices v, is highest along the normal of one of its facets: a face of A, a face of B, or an edge of A across an
 * edge of B. So the largest g of those 2 (4 + 4 + 36) normals is the gap, and no search is needed. Where two edges are
 * all but parallel their normal is rounded by eps over the angle about either, and the facet is as narrow as the angle:
 * g loses eps.
 */
#include "gap/gap_chart.h"
#include "gap/gap_solver.h"
#include <string.h>

/* Of the reach: by this the corners of a facet may seem to differ in height where its normal comes from edges that are
 * all but parallel. */
static const double most_slack = 1e-12;

enum { FACES = 4, EDGES = 6, MAX_CORNERS = 12 };

static bool is_octahedron(const imp_form *form)
{
    return !form->nested && form->p[0] == 1 && form->p[1] == 1 && form->p[2] == 1;
}

bool imp_gap_are_octahedra(const imp_gap_solids *pair)
{
    return is_octahedron(&pair->form[0]) && is_octahedron(&pair->form[1]);
}

/* Normals of the faces and directions of the edges, world, of any length; one of each opposite two. */
static void features(const imp_form *form, double face[FACES][3], double edge[EDGES][3])
{
    const double *a = form->axis;
    for (int k = 0; k < FACES; k++) {
        const double n[3] = {1 / a[0], (k & 1 ? -1 : 1) / a[1], (k & 2 ? -1 : 1) / a[2]};
        imp_to_world(form->rotation, n, face[k]);
    }
    for (int k = 0; k < EDGES; k++) {
        const int i = k % 3, j = (k + 1) % 3;
        double e[3] = {0, 0, 0};
        e[i] = a[i], e[j] = k < 3 ? a[j] : -a[j];
        imp_to_world(form->rotation, e, edge[k]);
    }
}

/* The better of n and -n, when better than *gap. */
static void try_normal(const imp_gap_solids *pair, const double n[3], double *gap, double best[3])
{
    const double length = imp_norm(n);
    if (!(length > 0)) return; /* parallel edges */
    for (int side = -1; side <= 1; side += 2) {
        const double unit[3] = {side * n[0] / length, side * n[1] / length, side * n[2] / length};
        const double g = imp_pair_gap(pair, unit, NULL);
        if (g > *gap) *gap = g, memcpy(best, unit, sizeof unit);
    }
}

static double best_normal(const imp_gap_solids *pair, double n[3])
{
    double face[2][FACES][3], edge[2][EDGES][3], gap = -INFINITY;
    for (int k = 0; k < 2; k++) features(&pair->form[k], face[k], edge[k]);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < FACES; i++) try_normal(pair, face[k][i], &gap, n);
    for (int i = 0; i < EDGES; i++)
        for (int j = 0; j < EDGES; j++) {
            double across[3];
            imp_cross(edge[0][i], edge[1][j], across);
            if (imp_norm(across) > 1e-15 * imp_norm(edge[0][i]) * imp_norm(edge[1][j]))
                try_normal(pair, across, &gap, n);
        }
    return gap;
}

/* ---- witness points: the middle of where the two features lie on each other ---- */

typedef struct polygon {
    int count;
    double p[MAX_CORNERS][2]; /* across the normal */
} polygon;

/* The corners that reach as far along d (world) as the body does, but for slack; shifted. */
static polygon reached(const imp_form *form, const double d[3], double t[2][3], const double shift[3], double slack)
{
    polygon at = {0};
    double body[3], h = 0;
    imp_to_body(form->rotation, d, body);
    for (int i = 0; i < 3; i++) h = fmax(h, form->axis[i] * fabs(body[i]));
    for (int i = 0; i < 3; i++)
        for (int side = -1; side <= 1; side += 2) {
            if (!(side * form->axis[i] * body[i] >= h - slack)) continue;
            double corner[3] = {0, 0, 0}, world[3];
            corner[i] = side * form->axis[i];
            imp_to_world(form->rotation, corner, world);
            for (int j = 0; j < 3; j++) world[j] += shift[j];
            for (int j = 0; j < 2; j++) at.p[at.count][j] = imp_dot(world, t[j]);
            at.count++;
        }
    return at;
}

/* The side of the line from a to b that p is on: its distance, > 0 to the left. */
static double beside(const double a[2], const double b[2], const double p[2])
{
    const double x = b[0] - a[0], y = b[1] - a[1];
    return (x * (p[1] - a[1]) - y * (p[0] - a[0])) / hypot(x, y);
}

/* What of the polygon is to the left of the line, or by no more than slack to its right (Sutherland and Hodgman 1974).
 */
static polygon left_of(const polygon *whole, const double a[2], const double b[2], double slack)
{
    polygon part = {0};
    for (int i = 0; i < whole->count; i++) {
        const double *p = whole->p[i], *q = whole->p[(i + 1) % whole->count];
        const double at_p = beside(a, b, p) + slack, at_q = beside(a, b, q) + slack;
        if (at_p >= 0 && part.count < MAX_CORNERS) memcpy(part.p[part.count++], p, sizeof part.p[0]);
        if ((at_p < 0) != (at_q < 0) && part.count < MAX_CORNERS) {
            for (int j = 0; j < 2; j++) part.p[part.count][j] = p[j] + (q[j] - p[j]) * (at_p / (at_p - at_q));
            part.count++;
        }
    }
    return part;
}

/* The middle of what two triangles, segments or corners have in common, but for slack; false when it is nothing. */
static bool common(polygon one, const polygon *other, double slack, double middle[2])
{
    const double *o = other->p[0], *a = other->p[1], *b = other->p[2];
    if (other->count == 1) one = *other;
    if (other->count == 2) { /* between both sides of its line, and its ends */
        const double across[2] = {a[1] - o[1], o[0] - a[0]};
        const double o_end[2] = {o[0] + across[0], o[1] + across[1]}, a_end[2] = {a[0] + across[0], a[1] + across[1]};
        one = left_of(&one, o, a, slack);
        one = left_of(&one, a, o, slack);
        one = left_of(&one, o, o_end, slack);
        one = left_of(&one, a_end, a, slack);
    }
    if (other->count == 3) {
        const bool left = beside(o, a, b) > 0;
        for (int i = 0; i < 3; i++) {
            const double *from = other->p[i], *to = other->p[(i + 1) % 3];
            one = left ? left_of(&one, from, to, slack) : left_of(&one, to, from, slack);
        }
    }
    middle[0] = middle[1] = 0;
    for (int i = 0; i < one.count; i++)
        for (int j = 0; j < 2; j++) middle[j] += one.p[i][j] / one.count;
    return one.count > 0;
}

/* Witness points that differ by gap n exactly, and lie in their bodies but for slack. */
static bool place_points(const imp_gap_solids *pair, double slack, imp_gap_bracket *meeting)
{
    double t[2][3], opposite[3], shift[3], middle[2], support[2][3];
    const double *const n = meeting->n, none[3] = {0, 0, 0};
    imp_across(n, t);
    imp_pair_gap(pair, n, support);
    for (int i = 0; i < 3; i++) opposite[i] = -n[i], shift[i] = pair->c[i] - meeting->gap * n[i];
    const polygon a = reached(&pair->form[0], n, t, none, slack),
                  b = reached(&pair->form[1], opposite, t, shift, slack);
    if (a.count > 3 || b.count > 3 || !common(a, &b, slack, middle)) return false;
    const double height = imp_dot(n, support[0]);
    for (int i = 0; i < 3; i++) {
        meeting->x[0][i] = middle[0] * t[0][i] + middle[1] * t[1][i] + height * n[i];
        meeting->x[1][i] = meeting->x[0][i] - shift[i];
    }
    return true;
}

bool imp_gap_octahedra(const imp_gap_solids *pair, imp_gap_bracket *meeting)
{
    meeting->gap = meeting->lower = meeting->upper = best_normal(pair, meeting->n);
    meeting->stiffness = INFINITY; /* a facet's normal does not move with its bodies' places */
    if (!(meeting->gap < 0)) return false;
    for (double slack = 1e-15; slack <= most_slack; slack *= 10)
        if (place_points(pair, slack * pair->reach, meeting)) return true;
    return false;
}
