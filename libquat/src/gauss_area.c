/* SPDX-License-Identifier: MIT */
#include "gauss.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>

/* sqrt(A^2 + soft^2) - soft for the area A of the triangle q0, q1, q2 in R^4 (each on q0's side), and its slopes by the
 * angles: with soft > 0 smooth where A vanishes. */
static double triangle_area(quat q0, quat q1, quat q2, double soft, double slope[3])
{
    const quat a = quat_sub(q1, q0), b = quat_sub(q2, q0);
    const double aa = quat_norm2(a), bb = quat_norm2(b), ab = quat_dot(a, b);
    /* as the length of the part of b perpendicular to a, which does not cancel */
    const quat across = aa > 0 ? quat_axpy(-ab / aa, a, b) : quat_make(0, 0, 0, 0);
    const double square = aa * quat_norm2(across) / 4, size = sqrt(square + soft * soft);
    if (!slope) return square / (size + soft + 1e-300);
    for (int i = 0; i < 3; i++) slope[i] = 0;
    if (size <= 1e-150) return 0;
    const quat k = quat_make(0, 0, 0, 1);
    const quat by_a = quat_scale(quat_sub(quat_scale(a, bb), quat_scale(b, ab)), 1 / (4 * size)),
               by_b = quat_scale(quat_sub(quat_scale(b, aa), quat_scale(a, ab)), 1 / (4 * size));
    slope[1] = quat_dot(by_a, quat_mul(q1, k)) / 2;
    slope[2] = quat_dot(by_b, quat_mul(q2, k)) / 2;
    slope[0] = -quat_dot(quat_add(by_a, by_b), quat_mul(q0, k)) / 2;
    return square / (size + soft);
}

static double softened(const quat_mesh *mesh, const quat q[], double soft, double slope[])
{
    double sum = 0, s[3];
    if (slope) memset(slope, 0, mesh->n * sizeof *slope);
    for (size_t i = 0; i < mesh->m; i++) {
        const size_t *const t = mesh->triangle[i];
        sum += triangle_area(q[t[0]], quat_nearest(q[t[1]], q[t[0]]), quat_nearest(q[t[2]], q[t[0]]), soft,
                             slope ? s : NULL);
        for (int c = 0; slope && c < 3; c++) slope[t[c]] += s[c];
    }
    return sum;
}

double quat_gauge_area(const quat_mesh *mesh, const quat q[]) { return softened(mesh, q, 0, NULL); }

/* ---- over GSL's minimiser ---- */

typedef struct task {
    const quat_mesh *mesh;
    const quat *from;
    quat *trial;
    double *slope;
    double soft;
} task;

static double evaluate(const gsl_vector *angle, task *t, double slope[])
{
    for (size_t i = 0; i < t->mesh->n; i++) t->trial[i] = quat_gauge_turn(t->from[i], gsl_vector_get(angle, i));
    return softened(t->mesh, t->trial, t->soft, slope);
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

/* Down from angles 0 to where the slope vanishes or rounding ends it; false after too many rounds. */
static bool descend(gsl_multimin_fdfminimizer *search, gsl_multimin_function_fdf *f, const gsl_vector *zero,
                    double scale, size_t *rounds)
{
    double since = INFINITY; /* the area at the last restart */
    gsl_multimin_fdfminimizer_set(search, f, zero, 0.1, 0.1);
    for (size_t round = 0; round < 600; round++, ++*rounds) {
        if (gsl_multimin_test_gradient(search->gradient, 1e-8 * scale / sqrt((double)f->n)) == GSL_SUCCESS) return true;
        if (gsl_multimin_fdfminimizer_iterate(search) == GSL_SUCCESS) continue;
        /* no way down along BFGS' direction: once more from steepest descent, while that gains anything */
        if (search->f >= since * (1 - 1e-9)) return true;
        since = search->f;
        gsl_multimin_fdfminimizer_restart(search);
    }
    return false;
}

quat_status quat_gauge_lower_area(const quat_mesh *mesh, quat q[], double work[], quat trial[], size_t *rounds)
{
    static const double softness[] = {1e-1, 1e-2, 1e-3, 1e-4};
    const size_t n = mesh->n;
    const double scale = quat_gauge_area(mesh, q);
    task t = {mesh, q, trial, work, 0};
    gsl_multimin_function_fdf f = {area_of, slope_of, area_and_slope, n, &t};
    if (scale <= 1e-24 * (double)mesh->m) return QUAT_OK; /* a plane: nothing but rounding */
    /* GSL asks for about twenty vectors itself and ends the program when it gets none: asked for here first. */
    void *const probe = malloc(32 * n * sizeof(double) + 65536);
    if (!probe) return QUAT_ENOMEM;
    free(probe);
    gsl_multimin_fdfminimizer *const search =
        gsl_multimin_fdfminimizer_alloc(gsl_multimin_fdfminimizer_vector_bfgs2, n);
    if (!search) return QUAT_ENOMEM;
    quat *const before = (quat *)(void *)(work + 2 * n);
    memcpy(before, q, n * sizeof *q);
    const gsl_vector_const_view zero = gsl_vector_const_view_array(work + n, n);
    memset(work + n, 0, n * sizeof *work);
    bool good = true;
    for (size_t s = 0; s < sizeof softness / sizeof *softness; s++) {
        t.soft = softness[s] * scale / (double)mesh->m;
        good = descend(search, &f, &zero.vector, scale, rounds);
        for (size_t i = 0; i < n; i++)
            q[i] = quat_renormalize(quat_gauge_turn(q[i], gsl_vector_get(search->x, i) - gsl_vector_get(search->x, 0)));
    }
    gsl_multimin_fdfminimizer_free(search);
    if (!(quat_gauge_area(mesh, q) < scale * (1 - 1e-9))) memcpy(q, before, n * sizeof *q);
    return good ? QUAT_OK : QUAT_NOT_CONVERGED;
}
