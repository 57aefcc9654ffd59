/* SPDX-License-Identifier: MIT */
#include "gauss.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <quat/rotation.h>
#include "scale.h"

static const qvec3 z_axis = {0, 0, 1};

/* ---- the mesh ---- */

/* A unit of length, as a power of two, in which no edge overflows and no triangle's area vanishes but beside others. */
static int unit_of(size_t n, const qvec3 x[])
{
    qvec3 most = {0, 0, 0};
    for (size_t i = 0; i < n; i++)
        most = qvec3_make(fmax(most.x, fabs(x[i].x)), fmax(most.y, fabs(x[i].y)), fmax(most.z, fabs(x[i].z)));
    return quat_vector_exponent(most);
}

static qvec3 edge(qvec3 from, qvec3 to, int unit)
{
    return qvec3_sub(quat_ldexp_vector(to, -unit), quat_ldexp_vector(from, -unit));
}

/* Of the angle between two edges, whatever their lengths. */
static double half_cotangent(qvec3 u, qvec3 v)
{
    u = quat_ldexp_vector(u, -quat_vector_exponent(u)), v = quat_ldexp_vector(v, -quat_vector_exponent(v));
    const double sine = qvec3_norm(qvec3_cross(u, v)), cosine = qvec3_dot(u, v);
    return sine > 1e-12 * fabs(cosine) ? cosine / sine / 2 : 0; /* a triangle without area has no say */
}

static void weigh(const qvec3 x[], int unit, size_t m, const size_t triangle[][3], double weight[][3])
{
    for (size_t i = 0; i < m; i++)
        for (int c = 0; c < 3; c++) {
            const size_t *const t = triangle[i];
            const qvec3 corner = x[t[c]];
            weight[i][c] = half_cotangent(edge(corner, x[t[(c + 1) % 3]], unit), edge(corner, x[t[(c + 2) % 3]], unit));
        }
}

/* ---- a start ---- */

/* The frame of the normal of `to` with the least turning from the frame `from`, on its side of S^3. */
static quat_status carry(quat from, quat to, quat *q)
{
    quat turn;
    const quat_status status = quat_from_two_vectors(quat_rotate(from, z_axis), quat_rotate(to, z_axis), &turn);
    *q = quat_nearest(quat_renormalize(quat_mul(turn, from)), from);
    return status;
}

enum { unseen, now, done };

/* From node 0 outward, ring after ring of neighbours: each frame carried from the neighbour it is reached by, or with
 * `signs` only turned to its side of S^3. */
static quat_status walk(const quat_mesh *mesh, quat q[], bool signs, char seen[])
{
    size_t count = 1, last = 0;
    quat_status worst = QUAT_OK;
    memset(seen, unseen, mesh->n);
    seen[0] = done;
    while (count > last && count < mesh->n) {
        last = count;
        for (size_t i = 0; i < mesh->m; i++)
            for (int c = 0; c < 6; c++) {
                const size_t from = mesh->triangle[i][c % 3], to = mesh->triangle[i][(c + 1 + c / 3) % 3];
                if (seen[from] != done || seen[to] != unseen) continue;
                const quat_status status = signs ? QUAT_OK : carry(q[from], q[to], &q[to]);
                if (signs) q[to] = quat_nearest(q[to], q[from]);
                if (status != QUAT_OK) worst = status;
                seen[to] = now;
                count++;
            }
        for (size_t i = 0; i < mesh->n; i++)
            if (seen[i] == now) seen[i] = done;
    }
    return count < mesh->n ? QUAT_EARGUMENT : worst;
}

/* Triangles around which the frames turn once more than their normals do. */
static size_t whirls(const quat_mesh *mesh, const quat q[])
{
    size_t count = 0;
    for (size_t i = 0; i < mesh->m; i++) {
        double angle = 0;
        for (int c = 0; c < 3; c++) {
            const quat from = q[mesh->triangle[i][c]], to = q[mesh->triangle[i][(c + 1) % 3]];
            const quat s = quat_mul(quat_conj(from), quat_nearest(to, from));
            angle += 2 * atan2(s.z, s.w);
        }
        count += fabs(angle) > 3.14159265358979324;
    }
    return count;
}

/* The mean of the normals over the area of the patch. */
static bool mean_normal(const quat_mesh *mesh, const qvec3 x[], const quat q[], qvec3 *mean)
{
    qvec3 sum = {0, 0, 0};
    double area = 0;
    const int unit = unit_of(mesh->n, x);
    for (size_t i = 0; i < mesh->m; i++) {
        const size_t *const t = mesh->triangle[i];
        const double twice = qvec3_norm(qvec3_cross(edge(x[t[0]], x[t[1]], unit), edge(x[t[0]], x[t[2]], unit)));
        for (int c = 0; c < 3; c++) sum = qvec3_axpy(twice / 3, quat_rotate(q[t[c]], z_axis), sum);
        area += twice;
    }
    return qvec3_norm(sum) > 1e-6 * area && qvec3_normalize(sum, mean) == QUAT_OK;
}

/* Every node's shortest rotation from a frame of the mean normal, turned together about the normals so that q[0] stays:
 * a field without whirls unless the patch covers the opposite of the mean. False when there is none. */
static bool from_the_mean(const quat_mesh *mesh, const qvec3 x[], const quat given[], quat q[])
{
    qvec3 mean;
    quat middle;
    if (!mean_normal(mesh, x, given, &mean)) return false;
    quat_from_two_vectors(z_axis, mean, &middle);
    for (size_t i = 0; i < mesh->n; i++)
        if (carry(middle, given[i], &q[i]) != QUAT_OK) return false;
    const quat s = quat_mul(quat_conj(q[0]), given[0]);
    const double angle = 2 * atan2(s.z, s.w);
    for (size_t i = 0; i < mesh->n; i++) q[i] = quat_gauge_turn(q[i], angle);
    return true;
}

/* The better of two starts, by their whirls. */
static quat_status start(const quat_mesh *mesh, const qvec3 x[], quat q[], quat trial[], char seen[])
{
    const bool has_mean = from_the_mean(mesh, x, q, trial);
    const size_t far = has_mean ? whirls(mesh, trial) : SIZE_MAX;
    const quat_status status = walk(mesh, q, far == 0, seen);
    if (status < 0) return status;
    if (far > 0 && (!has_mean || whirls(mesh, q) <= far)) return status;
    memcpy(q, trial, mesh->n * sizeof *q);
    return walk(mesh, q, true, seen);
}

/* ---- least area ---- */

/* Down with the areas rounded off where they vanish, less and less. Left as they are when that gains less than 1e-9. */
static quat_status lower_area(const quat_mesh *mesh, quat q[], double work[], quat trial[], quat before[],
                              size_t *rounds)
{
    static const double softness[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
    const double scale = quat_gauge_sum(mesh, quat_gauge_area, q, 0);
    quat_status status = QUAT_OK;
    if (scale <= 1e-24 * (double)mesh->m) return QUAT_OK; /* a plane: nothing but rounding */
    memcpy(before, q, mesh->n * sizeof *q);
    for (size_t s = 0; s < sizeof softness / sizeof *softness; s++)
        status = quat_gauge_lower(mesh, quat_gauge_area, softness[s] * scale / (double)mesh->m, q, work, trial, rounds);
    if (!(quat_gauge_sum(mesh, quat_gauge_area, q, 0) < scale * (1 - 1e-9))) memcpy(q, before, mesh->n * sizeof *q);
    return status;
}

/* ---- the whole ---- */

static quat_status check(size_t n, const qvec3 x[], size_t m, const size_t corner[], quat q[])
{
    if (n == 0 || m == 0 || !x || !q || !corner) return QUAT_EARGUMENT;
    if (n > SIZE_MAX / 256 || m > SIZE_MAX / 256) return QUAT_ENOMEM;
    for (size_t i = 0; i < 3 * m; i++)
        if (corner[i] >= n) return QUAT_EARGUMENT;
    for (size_t i = 0; i < n; i++)
        if (!qvec3_isfinite(x[i]) || quat_normalize(q[i], &q[i]) != QUAT_OK) return QUAT_EDOMAIN;
    return QUAT_OK;
}

static size_t torn_edges(const quat_mesh *mesh, const quat q[])
{
    size_t a, b, count = 0;
    for (size_t i = 0; i < mesh->m; i++)
        for (int c = 0; c < 3; c++) {
            quat_mesh_edge(mesh, i, c, &a, &b);
            count += quat_dot(q[a], q[b]) < 0;
        }
    return count;
}

quat_status quat_choose_frames(size_t n, const qvec3 x[], size_t m, const size_t triangles[], quat_gauge gauge,
                               quat q[], quat_gauge_report *report)
{
    quat_gauge_report own;
    const quat_gauge_report none = {0, 0, 0, 0};
    if (!report) report = &own;
    *report = none;
    if ((unsigned)gauge > QUAT_MINIMAL_AREA) return QUAT_EARGUMENT;
    quat_status status = check(n, x, m, triangles, q);
    if (status != QUAT_OK) return status;
    char *const memory = malloc(m * 6 * sizeof(double) + n * (7 * sizeof(double) + 2 * sizeof(quat) + 1));
    if (!memory) return QUAT_ENOMEM;
    quat *const trial = (quat *)(void *)memory;
    quat *const before = trial + n;
    double *const work = (double *)(before + n);
    double(*const weight)[3] = (double(*)[3])(work + 7 * n + 3 * m);
    char *const seen = (char *)(weight + m);
    const size_t(*const triangle)[3] = (const size_t(*)[3])triangles;
    const quat_mesh mesh = {n, m, triangle, (const double(*)[3])weight};
    weigh(x, unit_of(n, x), m, triangle, weight);
    status = start(&mesh, x, q, trial, seen);
    if (status >= 0) {
        quat_status least = QUAT_OK;
        if (gauge != QUAT_SHORTEST)
            least = quat_gauge_lower(&mesh, quat_gauge_length, 0, q, work, trial, &report->rounds);
        if (gauge == QUAT_MINIMAL_AREA) {
            const quat_status area = lower_area(&mesh, q, work, trial, before, &report->rounds);
            if (area != QUAT_OK) least = area;
        }
        if (least != QUAT_OK) status = least;
        if (gauge != QUAT_SHORTEST) walk(&mesh, q, true, seen);
        report->energy = quat_gauge_sum(&mesh, quat_gauge_length, q, 0);
        report->area = quat_gauge_sum(&mesh, quat_gauge_area, q, 0);
        report->torn = torn_edges(&mesh, q);
    }
    free(memory);
    return status;
}

/* ---- between two ---- */

quat_status quat_transition(size_t n, const quat q1[], const quat q2[], double angle[], double *turns, double *off)
{
    const double two_pi = 6.28318530717958648, widest = 0.375 * two_pi;
    double first = 0, last = 0, worst = 0;
    bool coarse = false;
    if (turns) *turns = 0;
    if (off) *off = 0;
    if (n < 1 || !q1 || !q2) return QUAT_EARGUMENT;
    for (size_t i = 0; i < n; i++) {
        quat a, b;
        if (quat_normalize(q1[i], &a) != QUAT_OK || quat_normalize(q2[i], &b) != QUAT_OK) return QUAT_EDOMAIN;
        const quat s = quat_mul(quat_conj(b), a);
        const double side = 2 * atan2(hypot(s.x, s.y), hypot(s.w, s.z));
        double phi = 2 * atan2(s.z, s.w);
        phi -= two_pi * nearbyint((phi - last) / two_pi);
        worst = fmax(worst, side);
        if (i == 0) first = phi;
        coarse = coarse || (i > 0 && fabs(phi - last) > widest);
        if (angle) angle[i] = phi;
        last = phi;
    }
    if (off) *off = worst;
    if (worst > 1e-6) return QUAT_EDOMAIN;
    if (turns) *turns = (last - first) / two_pi;
    return coarse ? QUAT_NOT_UNIQUE : QUAT_OK;
}
