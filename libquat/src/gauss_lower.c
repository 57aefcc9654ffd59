/* SPDX-License-Identifier: MIT */
#include "gauss.h"

#include <float.h>
#include <string.h>

/* One round's second derivatives: springs along the edges, and `firm` times the mesh's own weights, which are
 * definite. */
typedef struct springs {
    const quat_mesh *mesh;
    const double (*stiffness)[3];
    double firm;
} springs;

static double spring(const springs *s, size_t i, int c) { return s->stiffness[i][c] + s->firm * s->mesh->weight[i][c]; }

/* out = H x */
static void apply(const springs *s, const double x[], double out[])
{
    const quat_mesh *const mesh = s->mesh;
    memset(out, 0, mesh->n * sizeof *out);
    for (size_t i = 0; i < mesh->m; i++)
        for (int c = 0; c < 3; c++) {
            size_t a, b;
            quat_mesh_edge(mesh, i, c, &a, &b);
            const double pull = spring(s, i, c) * (x[b] - x[a]);
            out[a] -= pull;
            out[b] += pull;
        }
}

static double dot(size_t n, const double a[], const double b[])
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* An angle common to all nodes costs nothing: what rounding leaves of it would grow without bounds. */
static void remove_mean(size_t n, double x[])
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += x[i];
    for (size_t i = 0; i < n; i++) x[i] -= sum / (double)n;
}

/* The diagonal of H: each node's springs together; false when one is negative. */
static bool own_springs(const springs *s, double own[])
{
    const quat_mesh *const mesh = s->mesh;
    memset(own, 0, mesh->n * sizeof *own);
    for (size_t i = 0; i < mesh->m; i++)
        for (int c = 0; c < 3; c++) {
            size_t a, b;
            quat_mesh_edge(mesh, i, c, &a, &b);
            own[a] += spring(s, i, c);
            own[b] += spring(s, i, c);
        }
    for (size_t i = 0; i < mesh->n; i++) {
        if (!(own[i] >= 0)) return false;
        if (own[i] == 0) own[i] = 1;
    }
    return true;
}

/* x = -H^-1 g by conjugate gradients, H's diagonal before them; false when H is not definite, and when rounding makes
 * it look so early on. work: 5 n numbers. */
static bool solve(const springs *s, const double g[], double x[], double work[])
{
    const size_t n = s->mesh->n;
    double *const r = work, *const p = r + n, *const hp = p + n, *const z = hp + n, *const own = z + n;
    if (!own_springs(s, own)) return false;
    memset(x, 0, n * sizeof *x);
    for (size_t i = 0; i < n; i++) r[i] = -g[i];
    remove_mean(n, r);
    for (size_t i = 0; i < n; i++) p[i] = z[i] = r[i] / own[i];
    double rz = dot(n, r, z);
    const double enough = rz * 1e-20, usable = rz * 1e-8;
    for (size_t round = 0; round < 4 * n && rz > enough; round++) {
        apply(s, p, hp);
        const double curve = dot(n, p, hp);
        if (!(curve > 0)) return rz <= usable;
        const double step = rz / curve, old = rz;
        for (size_t i = 0; i < n; i++) x[i] += step * p[i], r[i] -= step * hp[i];
        remove_mean(n, r);
        for (size_t i = 0; i < n; i++) z[i] = r[i] / own[i];
        rz = dot(n, r, z);
        for (size_t i = 0; i < n; i++) p[i] = z[i] + rz / old * p[i];
    }
    return true;
}

/* The sum, its slopes and the springs. */
static double slopes(const quat_mesh *mesh, quat_gauge_cost cost, double soft, const quat q[], double g[],
                     double stiffness[][3])
{
    double sum = 0;
    memset(g, 0, mesh->n * sizeof *g);
    for (size_t i = 0; i < mesh->m; i++) {
        const quat_triangle_cost t = cost(mesh, i, q, soft);
        sum += t.value;
        for (int c = 0; c < 3; c++) {
            g[mesh->triangle[i][c]] += t.slope[c];
            stiffness[i][c] = t.stiffness[c];
        }
    }
    return sum;
}

/* Newton's step x, as little firmer than the springs as makes them definite; down the slopes when nothing does. */
static void newton(springs *s, const double g[], double x[], double work[])
{
    static const double least = 1e-6, most = 1e6;
    s->firm = s->firm > least ? s->firm / 4 : 0;
    while (!solve(s, g, x, work)) {
        s->firm = s->firm > 0 ? 4 * s->firm : least;
        if (s->firm <= most) continue;
        s->firm = 0;
        for (size_t i = 0; i < s->mesh->n; i++) x[i] = -g[i];
        return;
    }
}

quat_status quat_gauge_lower(const quat_mesh *mesh, quat_gauge_cost cost, double soft, quat q[], double work[],
                             quat trial[], size_t *rounds)
{
    const size_t n = mesh->n;
    double *const g = work, *const x = g + n, *const scratch = x + n;
    double(*const stiffness)[3] = (double(*)[3])(scratch + 5 * n);
    springs s = {mesh, (const double(*)[3])stiffness, 0};
    for (int round = 0; round < 200; round++, ++*rounds) {
        const double value = slopes(mesh, cost, soft, q, g, stiffness), slack = 64 * DBL_EPSILON * fabs(value);
        newton(&s, g, x, scratch);
        const double gain = -dot(n, g, x), held = x[0];
        double most = 0, next = INFINITY;
        for (size_t i = 0; i < n; i++) x[i] -= held, most = fmax(most, fabs(x[i]));
        double step = most > 1 ? 1 / most : 1;
        for (int half = 0; half < 40; half++, step /= 2) {
            for (size_t i = 0; i < n; i++) trial[i] = quat_renormalize(quat_gauge_turn(q[i], step * x[i]));
            next = quat_gauge_sum(mesh, cost, trial, soft);
            if (next <= value - 1e-4 * step * gain + slack) break;
        }
        if (!(next <= value + slack)) return QUAT_OK; /* as low as rounding lets it come */
        memcpy(q, trial, n * sizeof *q);
        if (gain > 100 * slack && value - next <= slack) return QUAT_OK; /* or a fold does: neighbours change sides */
        if (gain <= 1e-15 * fabs(value)) return QUAT_OK; /* the error after this step is that before it, squared */
    }
    return QUAT_NOT_CONVERGED;
}
