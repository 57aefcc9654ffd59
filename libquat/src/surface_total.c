/* SPDX-License-Identifier: MIT */
#include "surface.h"

#include <float.h>
#include <stdlib.h>
#include <gsl/gsl_integration.h>

/* Nodes and weights of n points across low ... high. */
static quat_status rule(size_t n, double low, double high, bool closed, double node[], double weight[])
{
    if (closed) {
        for (size_t i = 0; i < n; i++) {
            node[i] = low + (high - low) * (((double)i + 0.5) / (double)n);
            weight[i] = (high - low) / (double)n;
        }
        return QUAT_OK;
    }
    void *const probe = malloc(4096); /* GSL's own memory, which it must not lack: its handler would end the program */
    if (!probe) return QUAT_ENOMEM;
    free(probe);
    gsl_integration_glfixed_table *const table = gsl_integration_glfixed_table_alloc(n); /* n is one it holds */
    if (!table) return QUAT_ENOMEM;
    for (size_t i = 0; i < n; i++) gsl_integration_glfixed_point(low, high, i, &node[i], &weight[i], table);
    gsl_integration_glfixed_table_free(table);
    return QUAT_OK;
}

static quat_status sum(const quat_surface *s, size_t n, double *work, quat_surface_totals *totals)
{
    const quat_surface_totals none = {0, 0, 0, 0};
    double *const u = work, *const wu = u + n, *const v = wu + n, *const wv = v + n;
    *totals = none;
    quat_status status = rule(n, s->u0, s->u1, s->closed_u, u, wu);
    if (status == QUAT_OK) status = rule(n, s->v0, s->v1, s->closed_v, v, wv);
    if (status != QUAT_OK) return status;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            quat_surface_point p;
            status = quat_surface_at(s, u[i], v[j], &p);
            if (status < 0) {
                *totals = none;
                return status;
            }
            const double piece = wu[i] * wv[j] * p.area;
            totals->area += piece;
            totals->gauss += piece * p.curvature.gauss;
            totals->mean += piece * p.curvature.mean;
            totals->bending += piece * p.curvature.mean * p.curvature.mean;
        }
    return QUAT_OK;
}

static bool agree(double a, double b, double size, double tolerance)
{
    return fabs(a - b) <= tolerance * (fabs(b) + size);
}

quat_status quat_surface_total(const quat_surface *surface, double tolerance, quat_surface_totals *totals)
{
    const quat_surface_totals none = {0, 0, 0, 0};
    quat_surface_totals before = none;
    *totals = none;
    if (!quat_surface_is_good(surface) || !(tolerance >= 1e-14)) return QUAT_EARGUMENT;
    double *const work = malloc(4 * 512 * sizeof *work);
    if (!work) return QUAT_ENOMEM;
    quat_status status = QUAT_NOT_CONVERGED;
    const size_t most = surface->known > 0 ? 512 : 128; /* differences of x alone ask it 200 times a point */
    for (size_t n = 16; n <= most && status == QUAT_NOT_CONVERGED; n *= 2) {
        const quat_status summed = sum(surface, n, work, totals);
        if (summed != QUAT_OK) status = summed;
        /* K and H^2 go without a unit; of the mean's integral, a length, zero is the sum of parts */
        else if (n > 16 && agree(before.area, totals->area, 0, tolerance) &&
                 agree(before.gauss, totals->gauss, 12, tolerance) &&
                 agree(before.bending, totals->bending, 12, tolerance) &&
                 agree(before.mean, totals->mean, sqrt(totals->area * totals->bending), tolerance))
            status = QUAT_OK;
        before = *totals;
    }
    free(work);
    return status;
}
