/* SPDX-License-Identifier: MIT */
#include "shape/core.h"
#include <math.h>

/* ---- the tables ---- */

static const double point_vertex[1][3] = {{0, 0, 0}};
const impact_hull imp_hull_point = {.vertex_count = 1, .vertex = point_vertex};

static const double segment_vertex[2][3] = {{0, 0, -1}, {0, 0, 1}};
static const imp_hull_edge segment_edge[1] = {{{0, 1}, {-1, -1}}};
const impact_hull imp_hull_segment = {
    .vertex_count = 2, .edge_count = 1, .vertex = segment_vertex, .edge = segment_edge};

/* Vertex i has x > 0 for bit 0, y > 0 for bit 1, z > 0 for bit 2; faces -x, +x, -y, +y, -z, +z. */
static const double box_vertex[8][3] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                        {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
static const double box_normal[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
static const short box_start[7] = {0, 4, 8, 12, 16, 20, 24};
static const short box_loop[24] = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
static const imp_hull_edge box_edge[12] = {{{0, 1}, {2, 4}}, {{2, 3}, {4, 3}}, {{4, 5}, {5, 2}}, {{6, 7}, {3, 5}},
                                           {{0, 2}, {4, 0}}, {{1, 3}, {1, 4}}, {{4, 6}, {0, 5}}, {{5, 7}, {5, 1}},
                                           {{0, 4}, {0, 2}}, {{1, 5}, {2, 1}}, {{2, 6}, {3, 0}}, {{3, 7}, {1, 3}}};
const impact_hull imp_hull_box = {.vertex_count = 8,
                                  .edge_count = 12,
                                  .face_count = 6,
                                  .vertex = box_vertex,
                                  .normal = box_normal,
                                  .edge = box_edge,
                                  .start = box_start,
                                  .loop = box_loop};

/* Vertices +x, -x, +y, -y, +z, -z; face i has the signs of i's bits, a set one being < 0. */
#define THIRD 0.57735026918962576
static const double octahedron_vertex[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
static const double octahedron_normal[8][3] = {
    {THIRD, THIRD, THIRD},  {-THIRD, THIRD, THIRD},  {THIRD, -THIRD, THIRD},  {-THIRD, -THIRD, THIRD},
    {THIRD, THIRD, -THIRD}, {-THIRD, THIRD, -THIRD}, {THIRD, -THIRD, -THIRD}, {-THIRD, -THIRD, -THIRD}};
static const short octahedron_start[9] = {0, 3, 6, 9, 12, 15, 18, 21, 24};
static const short octahedron_loop[24] = {0, 2, 4, 1, 4, 2, 0, 4, 3, 1, 3, 4, 0, 5, 2, 1, 2, 5, 0, 3, 5, 1, 5, 3};
static const imp_hull_edge octahedron_edge[12] = {
    {{0, 2}, {0, 4}}, {{2, 4}, {0, 1}}, {{4, 0}, {0, 2}}, {{1, 4}, {1, 3}}, {{2, 1}, {1, 5}}, {{4, 3}, {2, 3}},
    {{3, 0}, {2, 6}}, {{1, 3}, {3, 7}}, {{0, 5}, {4, 6}}, {{5, 2}, {4, 5}}, {{5, 1}, {5, 7}}, {{3, 5}, {6, 7}}};
const impact_hull imp_hull_octahedron = {.vertex_count = 6,
                                         .edge_count = 12,
                                         .face_count = 8,
                                         .vertex = octahedron_vertex,
                                         .normal = octahedron_normal,
                                         .edge = octahedron_edge,
                                         .start = octahedron_start,
                                         .loop = octahedron_loop};

/* ---- what they can be asked ---- */

double imp_core_support(const imp_core *core, const double d[3], int *vertex)
{
    const impact_hull *hull = core->hull;
    const double w[3] = {core->axis[0] * d[0], core->axis[1] * d[1], core->axis[2] * d[2]};
    double best = -INFINITY;
    *vertex = 0;
    for (int i = 0; i < hull->vertex_count; i++) {
        const double *v = hull->vertex[i], h = v[0] * w[0] + v[1] * w[1] + v[2] * w[2];
        if (h > best) best = h, *vertex = i;
    }
    return best;
}

void imp_core_vertex(const imp_core *core, int i, double x[3])
{
    for (int k = 0; k < 3; k++) x[k] = core->axis[k] * core->hull->vertex[i][k];
}

/* A plane n.x = h becomes (n/axis).x = h. */
void imp_core_normal(const imp_core *core, int face, double n[3])
{
    const double *own = core->hull->normal[face];
    double square = 0;
    for (int k = 0; k < 3; k++) {
        n[k] = core->even ? own[k] : own[k] / core->axis[k];
        square += n[k] * n[k];
    }
    if (core->even) return;
    const double length = sqrt(square);
    for (int k = 0; k < 3; k++) n[k] /= length;
}

double imp_core_height(const imp_core *core, int face, const double n[3])
{
    const impact_hull *hull = core->hull;
    double best = -INFINITY, x[3];
    for (int i = hull->start[face]; i < hull->start[face + 1]; i++) {
        imp_core_vertex(core, hull->loop[i], x);
        best = fmax(best, n[0] * x[0] + n[1] * x[1] + n[2] * x[2]);
    }
    return best;
}

int imp_core_reached(const imp_core *core, const double d[3], double slack, short *vertex, double mean[3])
{
    int count = 0, best;
    const double h = imp_core_support(core, d, &best);
    mean[0] = mean[1] = mean[2] = 0;
    for (int i = 0; i < core->hull->vertex_count; i++) {
        double x[3];
        imp_core_vertex(core, i, x);
        if (!(d[0] * x[0] + d[1] * x[1] + d[2] * x[2] >= h - slack)) continue;
        vertex[count++] = (short)i;
        for (int k = 0; k < 3; k++) mean[k] += x[k];
    }
    for (int k = 0; k < 3; k++) mean[k] /= count;
    return count;
}
