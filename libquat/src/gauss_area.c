/* SPDX-License-Identifier: MIT */
#include "gauss.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>

/* The triangle of q0, q1, q2 in R^4 (each on q0's side), and the slopes of its area by the angles. */
static double triangle_area(quat q0, quat q1, quat q2, double slope[3])
{
    const quat a = quat_sub(q1, q0), b = quat_sub(q2, q0);
    const double aa = quat_norm2(a), bb = quat_norm2(b), ab = quat_dot(a, b);
    /* as the length of the part of b perpendicular to a, which does not cancel */
    const quat across = aa > 0 ? quat_axpy(-ab / aa, a, b) : quat_make(0, 0, 0, 0);
    const double area = sqrt(aa * quat_norm2(across)) / 2;
    if (!slope) return area;
    for (int i = 0; i < 3; i++) slope[i] = 0;
    if (area <= 1e-300) return area;
    const quat k = quat_make(0, 0, 0, 1);
    const quat by_a = quat_scale(quat_sub(quat_scale(a, bb), quat_scale(b, ab)), 1 / (4 * area)),
               by_b = quat_scale(quat_sub(quat_scale(b, aa), quat_scale(a, ab)), 1 / (4 * area));
    slope[1] = quat_dot(by_a, quat_mul(q1, k)) / 2;
    slope[2] = quat_dot(by_b, quat_mul(q2, k)) / 2;
    slope[0] = -quat_dot(quat_add(by_a, by_b), quat_mul(q0, k)) / 2;
    return area;
}

double quat_gauge_area(const quat_mesh *mesh, const quat q[], double slope[])
{
    double sum = 0, s[3];
    if (slope) memset(slope, 0, mesh->n * sizeof *slope);
    for (size_t i = 0; i < mesh->m; i++) {
        const size_t *const t = mesh->triangle[i];
        sum += triangle_area(q[t[0]], quat_nearest(q[t[1]], q[t[0]]), quat_nearest(q[t[2]], q[t[0]]), slope ? s : NULL);
        for (int c = 0; slope && c < 3; c++) slope[t[c]] += s[c];
    }
    return sum;
}

/* ---- over GSL's minimiser ---- */

typedef struct task {
    const quat_mesh *mesh;
    const quat *from;
    quat *trial;
    double *slope;
} task;

static double evaluate(const gsl_vector *angle, task *t, double slope[])
{
    for (size_t i = 0; i < t->mesh->n; i++) t->trial[i] = quat_gauge_turn(t->from[i], gsl_vector_get(angle, i));
    return quat_gauge_area(t->mesh, t->trial, slope);
}

static double area_of(const gsl_vector *angle, void *context) { return evaluate(angle, context, NULL); }

static void area_and_slope(const gsl_vector *angle, void *context, double *area, gsl_vector *slope)
{
    task *t = context;
    *area = evaluate(angle, t, t->slope);
    for (size_t i = 0; i < t->mesh->n; i++) gsl_vector_set(slope, i, t->slope[i]);
}

static void slope_of(const gsl_vector *angle, void *context, gsl_vector *slope)
{
    double area;
    area_and_slope(angle, context, &area, slope);
}

quat_status quat_gauge_lower_area(const quat_mesh *mesh, quat q[], double work[], quat trial[], size_t *rounds)
{
    const size_t n = mesh->n;
    task t = {mesh, q, trial, work};
    gsl_multimin_function_fdf f = {area_of, slope_of, area_and_slope, n, &t};
    /* GSL asks for about twenty vectors itself and ends the program when it gets none: asked for here first. */
    void *const probe = malloc(32 * n * sizeof(double) + 65536);
    if (!probe) return QUAT_ENOMEM;
    free(probe);
    gsl_multimin_fdfminimizer *const search =
        gsl_multimin_fdfminimizer_alloc(gsl_multimin_fdfminimizer_vector_bfgs2, n);
    if (!search) return QUAT_ENOMEM;
    memset(work + n, 0, n * sizeof *work);
    const gsl_vector_const_view start = gsl_vector_const_view_array(work + n, n);
    const double scale = quat_gauge_area(mesh, q, NULL);
    quat_status status = QUAT_NOT_CONVERGED;
    int step = gsl_multimin_fdfminimizer_set(search, &f, &start.vector, 0.1, 0.1);
    for (size_t round = 0; round < 2000 && step == GSL_SUCCESS; round++, ++*rounds) {
        if (gsl_multimin_test_gradient(search->gradient, 1e-8 * scale / sqrt((double)n)) == GSL_SUCCESS) {
            status = QUAT_OK;
            break;
        }
        step = gsl_multimin_fdfminimizer_iterate(search);
        if (step == GSL_ENOPROG) status = QUAT_OK; /* as low as rounding lets it come */
    }
    if (search->f <= scale)
        for (size_t i = 0; i < n; i++)
            q[i] = quat_renormalize(quat_gauge_turn(q[i], gsl_vector_get(search->x, i) - gsl_vector_get(search->x, 0)));
    gsl_multimin_fdfminimizer_free(search);
    return status;
}
