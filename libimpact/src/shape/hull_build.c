/* SPDX-License-Identifier: MIT
 *
 * The hull grows point by point: the triangles that a point sees go, and it is joined to the border of what is left.
 * Orientations are exact, so that no triangle is ever turned. What is flat but for rounding is one face: its plane is
 * that of its largest triangle, its normal in the end that of its loop (Newell).
 */
#include "base/tolerances.h"
#include "shape/hull_build.h"
#include <math.h>
#include <string.h>

static void edge_of(const double a[3], const double b[3], double d[3])
{
    for (int i = 0; i < 3; i++) d[i] = b[i] - a[i];
}

static void cross_of(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot_of(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void area_vector(const imp_hull_work *w, const short t[3], double n[3])
{
    double a[3], b[3];
    edge_of(w->point[t[0]], w->point[t[1]], a);
    edge_of(w->point[t[0]], w->point[t[2]], b);
    cross_of(a, b, n);
}

static void put_triangle(imp_hull_work *w, int a, int b, int c)
{
    int place = w->triangles;
    for (int i = 0; i < w->triangles; i++)
        if (w->triangle[i][0] < 0) place = i;
    if (place == w->triangles) w->triangles++;
    const short t[3] = {(short)a, (short)b, (short)c};
    memcpy(w->triangle[place], t, sizeof t);
    for (int i = 0; i < 3; i++) w->left[t[i]][t[(i + 1) % 3]] = (short)place;
}

static void drop_triangle(imp_hull_work *w, int i)
{
    short *t = w->triangle[i];
    for (int k = 0; k < 3; k++) w->left[t[k]][t[(k + 1) % 3]] = -1;
    t[0] = -1;
}

/* The point farthest from a point, a line or a plane through the first ones chosen. */
static int farthest_from(const imp_hull_work *w, int chosen, const int *c, double *distance)
{
    int best = 0;
    double n[3] = {0}, a[3], b[3];
    *distance = -1;
    edge_of(w->point[c[0]], w->point[c[chosen > 1 ? 1 : 0]], a);
    if (chosen == 3) {
        edge_of(w->point[c[0]], w->point[c[2]], b);
        cross_of(a, b, n);
    }
    for (int i = 0; i < w->count; i++) {
        double d[3], side[3], away;
        edge_of(w->point[c[0]], w->point[i], d);
        cross_of(a, d, side);
        if (chosen == 1)
            away = sqrt(dot_of(d, d));
        else if (chosen == 2)
            away = sqrt(dot_of(side, side) / dot_of(a, a));
        else
            away = fabs(dot_of(n, d)) / sqrt(dot_of(n, n));
        if (away > *distance) *distance = away, best = i;
    }
    return best;
}

static bool first_tetrahedron(imp_hull_work *w, double *thickness)
{
    int c[4] = {0};
    double distance;
    c[0] = farthest_from(w, 1, c, &distance);
    for (int chosen = 1; chosen < 4; chosen++) {
        c[chosen] = farthest_from(w, chosen, c, &distance);
        *thickness = chosen == 3 ? distance : 0;
        if (!(distance > w->flat)) return false;
    }
    if (imp_orientation(w->point[c[0]], w->point[c[1]], w->point[c[2]], w->point[c[3]]) > 0) {
        const int swap = c[1];
        c[1] = c[2], c[2] = swap;
    }
    put_triangle(w, c[0], c[1], c[2]);
    put_triangle(w, c[0], c[2], c[3]);
    put_triangle(w, c[0], c[3], c[1]);
    put_triangle(w, c[1], c[3], c[2]);
    return true;
}

static bool sees(const imp_hull_work *w, int p, int i)
{
    const short *t = w->triangle[i];
    return t[0] >= 0 && imp_orientation(w->point[t[0]], w->point[t[1]], w->point[t[2]], w->point[p]) > 0;
}

static void join_point(imp_hull_work *w, int p)
{
    bool seen[4 * IMPACT_HULL_POINTS];
    short border[IMP_HULL_CORNERS][2];
    int borders = 0;
    for (int i = 0; i < w->triangles; i++) seen[i] = sees(w, p, i);
    for (int i = 0; i < w->triangles; i++)
        for (int k = 0; seen[i] && k < 3; k++) {
            const short from = w->triangle[i][k], to = w->triangle[i][(k + 1) % 3];
            if (seen[w->left[to][from]]) continue;
            border[borders][0] = from, border[borders++][1] = to;
        }
    for (int i = 0; i < w->triangles; i++)
        if (seen[i]) drop_triangle(w, i);
    for (int i = 0; i < borders; i++) put_triangle(w, border[i][0], border[i][1], p);
}

bool imp_hull_triangles(imp_hull_work *w, double *thickness)
{
    double square = 0;
    for (int i = 0; i < w->count; i++) square = fmax(square, dot_of(w->point[i], w->point[i]));
    w->triangles = 0;
    w->flat = IMP_HULL_FLAT * sqrt(square);
    memset(w->left, -1, sizeof w->left);
    if (!first_tetrahedron(w, thickness)) return false;
    for (int p = 0; p < w->count; p++) join_point(w, p);
    return true;
}

/* ---- faces ---- */

static bool in_plane(const imp_hull_work *w, const short t[3], const double n[3], const double on[3])
{
    for (int k = 0; k < 3; k++) {
        double d[3];
        edge_of(on, w->point[t[k]], d);
        if (!(fabs(dot_of(n, d)) <= w->flat)) return false;
    }
    return true;
}

/* The face of the triangle: all that is joined to it in its plane. */
static void spread(imp_hull_work *w, int first, int face)
{
    short waiting[4 * IMPACT_HULL_POINTS];
    int count = 1;
    double n[3];
    const double *on = w->point[w->triangle[first][0]];
    area_vector(w, w->triangle[first], n);
    const double length = sqrt(dot_of(n, n));
    for (int k = 0; k < 3; k++) n[k] /= length;
    waiting[0] = (short)first, w->group[first] = (short)face;
    while (count > 0) {
        const short *t = w->triangle[waiting[--count]];
        for (int k = 0; k < 3; k++) {
            const short next = w->left[t[(k + 1) % 3]][t[k]];
            if (w->group[next] >= 0 || !in_plane(w, w->triangle[next], n, on)) continue;
            w->group[next] = (short)face, waiting[count++] = next;
        }
    }
}

/* The largest triangle without a face, or -1. */
static int largest(const imp_hull_work *w)
{
    int best = -1;
    double most = -1;
    for (int i = 0; i < w->triangles; i++) {
        double n[3];
        if (w->triangle[i][0] < 0 || w->group[i] >= 0) continue;
        area_vector(w, w->triangle[i], n);
        if (dot_of(n, n) > most) most = dot_of(n, n), best = i;
    }
    return best;
}

/* Where the border of a face goes from each point; false unless it is one loop. */
static bool loop_of(imp_hull_work *w, int face, int *length)
{
    short next[IMPACT_HULL_POINTS];
    int edges = 0, first = -1;
    memset(next, -1, sizeof next);
    for (int i = 0; i < w->triangles; i++)
        for (int k = 0; w->triangle[i][0] >= 0 && w->group[i] == face && k < 3; k++) {
            const short from = w->triangle[i][k], to = w->triangle[i][(k + 1) % 3];
            if (w->group[w->left[to][from]] == face) continue;
            if (next[from] >= 0) return false;
            next[from] = to, first = from, edges++;
        }
    *length = 0;
    for (int at = first; *length < edges; at = next[at]) {
        w->loop[w->start[face] + (*length)++] = (short)at;
        if (next[at] == first) break;
    }
    return *length == edges && edges >= 3;
}

static void newell(imp_hull_work *w, int face)
{
    double *n = w->normal[face];
    n[0] = n[1] = n[2] = 0;
    const short *loop = w->loop + w->start[face];
    const int count = w->start[face + 1] - w->start[face];
    for (int i = 1; i + 1 < count; i++) {
        double part[3];
        const short t[3] = {loop[0], loop[i], loop[i + 1]};
        area_vector(w, t, part);
        for (int k = 0; k < 3; k++) n[k] += part[k];
    }
    const double length = sqrt(dot_of(n, n));
    for (int k = 0; k < 3; k++) n[k] /= length;
}

static bool merged(imp_hull_work *w, bool each_its_own)
{
    memset(w->group, -1, sizeof w->group);
    w->start[0] = 0;
    w->faces = 0;
    for (int i; (i = largest(w)) >= 0; w->faces++)
        if (each_its_own)
            w->group[i] = (short)w->faces;
        else
            spread(w, i, w->faces);
    for (int face = 0; face < w->faces; face++) {
        int length;
        if (!loop_of(w, face, &length)) return false;
        w->start[face + 1] = (short)(w->start[face] + length);
        newell(w, face);
    }
    return true;
}

void imp_hull_faces(imp_hull_work *w)
{
    /* Slivers as narrow as the slack can join faces to a ring: then triangles stay what they are. */
    if (!merged(w, false)) merged(w, true);
}
