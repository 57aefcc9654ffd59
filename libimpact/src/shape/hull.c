/* SPDX-License-Identifier: MIT
 *
 * A hull from points: triangles, faces, then the frame of its mass.
 */
#include <quat/rotation.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/number.h"
#include "base/tolerances.h"
#include "shape/hull_build.h"

static impact_status complain(impact_status status, char *message, size_t size, const char *words, double value)
{
    if (message && size > 0) snprintf(message, size, words, imp_number_of(value).text);
    return status;
}

static impact_status check_points(const qvec3 *points, size_t count, double rounding, char *message, size_t size)
{
    if (count < 4) return complain(IMPACT_EARGUMENT, message, size, "%s points are fewer than 4", (double)count);
    if (count > IMPACT_HULL_POINTS)
        return complain(IMPACT_EARGUMENT, message, size, "%s points are more than 256", (double)count);
    if (!isfinite(rounding)) return complain(IMPACT_EDOMAIN, message, size, "rounding = %s is not finite", rounding);
    if (rounding < 0) return complain(IMPACT_EARGUMENT, message, size, "rounding = %s is negative", rounding);
    for (size_t i = 0; i < count; i++)
        if (!qvec3_isfinite(points[i]))
            return complain(IMPACT_EDOMAIN, message, size, "vertex %s is not finite", (double)i + 1);
    return IMPACT_OK;
}

/* The points about their middle, in units of their size, a power of two: 0 when they are all one. */
static double bring(const qvec3 *points, int count, imp_hull_work *w, double middle[3])
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, size = 0;
    w->count = count;
    for (int i = 0; i < count; i++) {
        const double x[3] = {points[i].x, points[i].y, points[i].z};
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], x[k]), high[k] = fmax(high[k], x[k]);
        memcpy(w->point[i], x, sizeof x);
    }
    for (int k = 0; k < 3; k++) {
        size = fmax(size, high[k] / 2 - low[k] / 2);
        middle[k] = 0;
    }
    if (!(size > 0)) return 0;
    const double unit = ldexp(1, ilogb(size));
    for (int k = 0; k < 3; k++) /* far from their origin, where the shift is exact (Sterbenz) */
        if (fabs(low[k] + high[k]) > 4 * size) middle[k] = low[k] / 2 + high[k] / 2;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) w->point[i][k] = (w->point[i][k] - middle[k]) / unit;
    return unit;
}

/* ---- the hull in one block ---- */

typedef struct arrays {
    double (*vertex)[3], (*normal)[3];
    imp_hull_edge *edge;
    short *start, *loop;
} arrays;

static size_t layout(impact_hull *hull, int corners, arrays *a)
{
    const size_t vertices = (size_t)hull->vertex_count, faces = (size_t)hull->face_count;
    char *place = (char *)(hull + 1);
    a->vertex = (double(*)[3])(void *)place, place += vertices * sizeof *a->vertex;
    a->normal = (double(*)[3])(void *)place, place += faces * sizeof *a->normal;
    a->edge = (imp_hull_edge *)(void *)place, place += (size_t)hull->edge_count * sizeof *a->edge;
    a->start = (short *)(void *)place, place += (faces + 1) * sizeof *a->start;
    a->loop = (short *)(void *)place, place += (size_t)corners * sizeof *a->loop;
    hull->vertex = (const double(*)[3])a->vertex, hull->normal = (const double(*)[3])a->normal;
    hull->edge = a->edge, hull->start = a->start, hull->loop = a->loop;
    return (size_t)(place - (char *)hull);
}

/* Edges once each: where i < j, with the faces on both sides. */
static void list_edges(const short (*beside)[IMPACT_HULL_POINTS], int vertices, imp_hull_edge *edge)
{
    for (int i = 0; i < vertices; i++)
        for (int j = i + 1; j < vertices; j++)
            if (beside[i][j] >= 0) *edge++ = (imp_hull_edge){{(short)i, (short)j}, {beside[i][j], beside[j][i]}};
}

static void fill(imp_hull_work *w, const short *number, arrays *a, impact_hull *hull)
{
    memset(w->left, -1, sizeof w->left); /* from here on the face to the left */
    for (int i = 0; i < w->count; i++)
        if (number[i] >= 0) memcpy(a->vertex[number[i]], w->point[i], sizeof w->point[0]);
    memcpy(a->normal, w->normal, (size_t)hull->face_count * sizeof *a->normal);
    memcpy(a->start, w->start, ((size_t)hull->face_count + 1) * sizeof *a->start);
    for (int f = 0; f < hull->face_count; f++) {
        const int from = w->start[f], to = w->start[f + 1];
        for (int i = from; i < to; i++) {
            const short v = number[w->loop[i]], next = number[w->loop[i + 1 < to ? i + 1 : from]];
            a->loop[i] = v;
            w->left[v][next] = (short)f;
        }
    }
    list_edges((const short(*)[IMPACT_HULL_POINTS])w->left, hull->vertex_count, a->edge);
}

/* ---- the frame ---- */

/* One rotation of Jacobi's method that makes m[p][q] zero; axes' columns follow. */
static void jacobi(double m[3][3], double axes[3][3], int p, int q)
{
    const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
    const double t = copysign(1, theta) / (fabs(theta) + hypot(1, theta)), c = 1 / hypot(1, t), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double a = m[k][p], b = m[k][q], x = axes[k][p], y = axes[k][q];
        m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
        axes[k][p] = c * x - s * y, axes[k][q] = s * x + c * y;
    }
    for (int k = 0; k < 3; k++) {
        const double a = m[p][k], b = m[q][k];
        m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
    }
}

/* Principal axes of the second moments; those of the points where they are principal but for rounding. */
static void principal(double m[3][3], double axes[3][3])
{
    const double least = IMP_HULL_FRAME * (m[0][0] + m[1][1] + m[2][2]);
    for (int sweep = 0; sweep < IMP_HULL_SWEEPS; sweep++)
        for (int p = 0; p < 3; p++) {
            const int q = (p + 1) % 3;
            if (fabs(m[p][q]) > least) jacobi(m, axes, p, q);
        }
}

static void turn_into(const double axes[3][3], const double center[3], double x[3])
{
    double d[3], y[3];
    for (int k = 0; k < 3; k++) d[k] = x[k] - center[k];
    for (int k = 0; k < 3; k++) y[k] = axes[0][k] * d[0] + axes[1][k] * d[1] + axes[2][k] * d[2];
    memcpy(x, y, sizeof y);
}

/* Moves the hull into the frame of its mass; center and axes tell where that was. */
static void settle_frame(impact_hull *hull, arrays *a, double center[3], double axes[3][3])
{
    double m[10], second[3][3];
    imp_hull_moments(hull, hull->rounding, m);
    hull->volume = m[0];
    for (int k = 0; k < 3; k++) {
        center[k] = fabs(m[1 + k]) > IMP_HULL_FRAME * m[0] ? m[1 + k] / m[0] : 0;
        for (int j = 0; j < 3; j++) axes[k][j] = k == j;
    }
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3;
        second[k][k] = m[4 + k] / m[0] - center[k] * center[k];
        second[k][next] = second[next][k] = m[7 + k] / m[0] - center[k] * center[next];
    }
    principal(second, axes);
    hull->inertia = (qvec3){second[1][1] + second[2][2], second[2][2] + second[0][0], second[0][0] + second[1][1]};
    const double none[3] = {0, 0, 0};
    for (int i = 0; i < hull->vertex_count; i++) turn_into((const double(*)[3])axes, center, a->vertex[i]);
    for (int i = 0; i < hull->face_count; i++) turn_into((const double(*)[3])axes, none, a->normal[i]);
}

static void bring_back(impact_hull *hull, arrays *a, double unit, double rounding)
{
    for (int i = 0; i < hull->vertex_count; i++) {
        double square = 0;
        for (int k = 0; k < 3; k++) {
            a->vertex[i][k] *= unit;
            hull->extent[k] = fmax(hull->extent[k], fabs(a->vertex[i][k]));
            square += (a->vertex[i][k] / unit) * (a->vertex[i][k] / unit);
        }
        hull->radius = fmax(hull->radius, unit * sqrt(square));
    }
    hull->volume *= unit * unit * unit;
    hull->inertia = qvec3_scale(hull->inertia, unit * unit);
    hull->rounding = rounding;
}

static void finish(impact_hull *hull, arrays *a, double unit, const double middle[3], double rounding)
{
    double center[3], axes[3][3];
    hull->rounding = rounding / unit;
    settle_frame(hull, a, center, axes);
    bring_back(hull, a, unit, rounding);
    hull->center = (qvec3){center[0] * unit + middle[0], center[1] * unit + middle[1], center[2] * unit + middle[2]};
    const qmat3 turn = {{{axes[0][0], axes[0][1], axes[0][2]},
                         {axes[1][0], axes[1][1], axes[1][2]},
                         {axes[2][0], axes[2][1], axes[2][2]}}};
    if (quat_from_matrix(&turn, &hull->axes) < 0) hull->axes = quat_identity();
}

/* ---- making one ---- */

static void *take(const impact_allocator *allocator, size_t size)
{
    return allocator && allocator->allocate ? allocator->allocate(size, allocator->context) : malloc(size);
}

static void give(const impact_allocator *allocator, void *piece, size_t size)
{
    if (allocator && allocator->allocate)
        allocator->release(piece, size, allocator->context);
    else
        free(piece);
}

/* Numbers for the points that are corners of three faces or more; how many. */
static int number_vertices(const imp_hull_work *w, short *number)
{
    int met[IMPACT_HULL_POINTS] = {0}, count = 0;
    for (int i = 0; i < w->start[w->faces]; i++) met[w->loop[i]]++;
    for (int i = 0; i < w->count; i++) number[i] = met[i] >= 3 ? (short)count++ : -1;
    return count;
}

/* Loops without the points that have no number: between two faces they lie on their edge. */
static void thin_loops(imp_hull_work *w, const short *number)
{
    int place = 0;
    for (int f = 0; f < w->faces; f++) {
        const int from = w->start[f], to = w->start[f + 1];
        w->start[f] = (short)place;
        for (int i = from; i < to; i++)
            if (number[w->loop[i]] >= 0) w->loop[place++] = w->loop[i];
    }
    w->start[w->faces] = (short)place;
}

static impact_status assemble(imp_hull_work *w, double unit, const double middle[3], double rounding,
                              const impact_allocator *allocator, impact_hull **hull)
{
    short number[IMPACT_HULL_POINTS];
    arrays a;
    impact_hull counts = {.vertex_count = number_vertices(w, number), .face_count = w->faces};
    thin_loops(w, number);
    const int corners = w->start[w->faces];
    counts.edge_count = corners / 2;
    counts.dropped = w->count - counts.vertex_count;
    const size_t bytes = sizeof counts + (size_t)counts.vertex_count * sizeof *a.vertex +
                         (size_t)counts.face_count * sizeof *a.normal + (size_t)counts.edge_count * sizeof *a.edge +
                         ((size_t)counts.face_count + 1 + (size_t)corners) * sizeof *a.loop;
    impact_hull *made = take(allocator, bytes);
    if (!made) return IMPACT_ENOMEM;
    *made = counts;
    made->bytes = bytes;
    atomic_init(&made->holders, 1);
    if (allocator) made->allocator = *allocator;
    layout(made, corners, &a);
    fill(w, number, &a, made);
    finish(made, &a, unit, middle, rounding);
    *hull = made;
    return IMPACT_OK;
}

static impact_status build(const qvec3 *points, int count, double rounding, imp_hull_work *w,
                           const impact_allocator *allocator, impact_hull **hull, char *message, size_t size)
{
    double middle[3], thickness;
    const double unit = bring(points, count, w, middle);
    if (!(unit > 0)) return complain(IMPACT_EARGUMENT, message, size, "its %s vertices are one point", count);
    if (!imp_hull_triangles(w, &thickness)) {
        char words[80];
        snprintf(words, sizeof words, "its %%s vertices lie in a plane to %.2g m", thickness * unit);
        return complain(IMPACT_EARGUMENT, message, size, words, count);
    }
    imp_hull_faces(w);
    return assemble(w, unit, middle, rounding, allocator, hull);
}

impact_status impact_hull_create(const qvec3 *points, size_t count, double rounding, const impact_allocator *allocator,
                                 impact_hull **hull, char *message, size_t size)
{
    *hull = NULL;
    if (message && size > 0) message[0] = '\0';
    impact_status status = check_points(points, count, rounding, message, size);
    if (status != IMPACT_OK) return status;
    imp_hull_work *w = take(allocator, sizeof *w);
    if (!w) return complain(IMPACT_ENOMEM, message, size, "out of memory: %s bytes", (double)sizeof *w);
    status = build(points, (int)count, rounding, w, allocator, hull, message, size);
    give(allocator, w, sizeof *w);
    return status;
}

impact_hull *impact_hull_share(const impact_hull *hull)
{
    impact_hull *shared = (impact_hull *)(uintptr_t)hull;
    atomic_fetch_add(&shared->holders, 1);
    return shared;
}

void impact_hull_destroy(impact_hull *hull)
{
    if (!hull || atomic_fetch_sub(&hull->holders, 1) > 1) return;
    const impact_allocator allocator = hull->allocator;
    give(&allocator, hull, hull->bytes);
}

/* ---- asking one ---- */

impact_hull_info impact_hull_describe(const impact_hull *hull)
{
    return (impact_hull_info){.vertices = hull->vertex_count,
                              .edges = hull->edge_count,
                              .faces = hull->face_count,
                              .dropped = hull->dropped,
                              .rounding = hull->rounding,
                              .center = hull->center,
                              .axes = hull->axes};
}

qvec3 impact_hull_vertex(const impact_hull *hull, int i)
{
    if (i < 0 || i >= hull->vertex_count) return (qvec3){NAN, NAN, NAN};
    return (qvec3){hull->vertex[i][0], hull->vertex[i][1], hull->vertex[i][2]};
}

int impact_hull_face(const impact_hull *hull, int i, int *vertex, qvec3 *normal)
{
    if (i < 0 || i >= hull->face_count) return 0;
    const int from = hull->start[i], count = hull->start[i + 1] - from;
    for (int k = 0; vertex && k < count; k++) vertex[k] = hull->loop[from + k];
    if (normal) *normal = (qvec3){hull->normal[i][0], hull->normal[i][1], hull->normal[i][2]};
    return count;
}
