/* SPDX-License-Identifier: MIT */
#include "quadrature.h"

#include <gsl/gsl_integration.h>

typedef struct search {
    gsl_function f;
    double allowed;
    size_t left; /* intervals that may still be asked */
    bool short_of;
} search;

static double refine(search *s, double a, double b, int depth)
{
    double integral, error, size, spread;
    gsl_integration_qk21(&s->f, a, b, &integral, &error, &size, &spread);
    if (error <= s->allowed || error <= 2e-14 * size) return integral;
    if (depth == 0 || s->left < 2) {
        s->short_of = true;
        return integral;
    }
    s->left -= 2;
    const double middle = a + (b - a) / 2;
    return refine(s, a, middle, depth - 1) + refine(s, middle, b, depth - 1);
}

quat_status quat_quadrature(quat_integrand f, void *context, double a, double b, double tolerance, double *integral)
{
    search s = {.f = {f, context}, .left = 4000};
    double whole, error, size, spread;
    *integral = 0;
    if (a == b) return QUAT_OK;
    gsl_integration_qk21(&s.f, a, b, &whole, &error, &size, &spread);
    s.allowed = tolerance * size;
    *integral = error <= s.allowed ? whole : refine(&s, a, b, 40);
    return s.short_of ? QUAT_NOT_CONVERGED : QUAT_OK;
}
