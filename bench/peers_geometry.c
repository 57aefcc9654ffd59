/* SPDX-License-Identifier: MIT */
#include "peers_geometry.h"

#include <math.h>
#ifdef HAVE_GSL
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#endif

static const double pi = 3.14159265358979323846;

outcome plain_stereographic(int n, const quat frames[])
{
    double worst = 0, sum = 0;
    for (int i = 0; i < n; i++) {
        const quat q = frames[i];
        const qvec3 x = {q.x / (1 + q.w), q.y / (1 + q.w), q.z / (1 + q.w)};
        const double r = qvec3_dot(x, x);
        const quat back = {(1 - r) / (1 + r), 2 * x.x / (1 + r), 2 * x.y / (1 + r), 2 * x.z / (1 + r)};
        worst = fmax(worst, quat_norm(quat_sub(back, q)));
        sum += back.w + 2 * back.x + 3 * back.y + 4 * back.z;
    }
    return (outcome){worst, sum};
}

/* ---- differences ---- */

static qvec3 helix(double t) { return (qvec3){cos(t), sin(t), t}; }

outcome helix_differences(int n, double step)
{
    double worst = 0, sum = 0;
    for (int i = 0; i < n; i++) {
        const double t = 4 * pi * i / n;
        const qvec3 a = helix(t - step), b = helix(t), c = helix(t + step);
        const qvec3 first = qvec3_scale(qvec3_sub(c, a), 1 / (2 * step)),
                    second = qvec3_scale(qvec3_axpy(-2, b, qvec3_add(a, c)), 1 / (step * step));
        const double curvature = qvec3_norm(qvec3_cross(first, second)) / pow(qvec3_norm(first), 3);
        worst = fmax(worst, fabs(curvature - 0.5));
        sum += curvature;
    }
    return (outcome){worst, sum};
}

static qvec3 torus(double u, double v)
{
    const double r = 2 + cos(v);
    return (qvec3){r * cos(u), r * sin(u), sin(v)};
}

static double gauss_by_differences(double u, double v, double h)
{
    const qvec3 x = torus(u, v), left = torus(u - h, v), right = torus(u + h, v), low = torus(u, v - h),
                high = torus(u, v + h);
    const qvec3 xu = qvec3_scale(qvec3_sub(right, left), 1 / (2 * h)),
                xv = qvec3_scale(qvec3_sub(high, low), 1 / (2 * h)),
                xuu = qvec3_scale(qvec3_axpy(-2, x, qvec3_add(left, right)), 1 / (h * h)),
                xvv = qvec3_scale(qvec3_axpy(-2, x, qvec3_add(low, high)), 1 / (h * h)),
                xuv = qvec3_scale(qvec3_sub(qvec3_add(torus(u + h, v + h), torus(u - h, v - h)),
                                            qvec3_add(torus(u + h, v - h), torus(u - h, v + h))),
                                  1 / (4 * h * h));
    const qvec3 cross = qvec3_cross(xu, xv), n = qvec3_scale(cross, 1 / qvec3_norm(cross));
    const double E = qvec3_dot(xu, xu), F = qvec3_dot(xu, xv), G = qvec3_dot(xv, xv), L = qvec3_dot(xuu, n),
                 M = qvec3_dot(xuv, n), N = qvec3_dot(xvv, n);
    return (L * N - M * M) / (E * G - F * F);
}

outcome torus_differences(int n, double step)
{
    double worst = 0, sum = 0;
    for (int i = 0; i < n; i++) {
        const double u = 2 * pi * i / n, v = 2 * pi * (i % 33) / 33, got = gauss_by_differences(u, v, step);
        worst = fmax(worst, fabs(got - cos(v) / (2 + cos(v))));
        sum += got;
    }
    return (outcome){worst, sum};
}

/* ---- integrals ---- */

outcome ellipse_polygon(double sides)
{
    double length = 0, x = 2, y = 0;
    for (long i = 1; i <= (long)sides; i++) {
        const double t = 2 * pi * (double)i / sides, nx = 2 * cos(t), ny = sin(t);
        length += hypot(nx - x, ny - y);
        x = nx, y = ny;
    }
    return (outcome){fabs(length / ellipse_length - 1), length};
}

/* K |x_u x x_v| of (cos v cos u, cos v sin u, c sin v) at v. */
static double gauss_density(double v)
{
    const double c = 1.5, w = c * c * cos(v) * cos(v) + sin(v) * sin(v);
    return c * c / (w * w) * cos(v) * sqrt(w);
}

outcome ellipsoid_midpoints(double n)
{
    double sum = 0;
    for (long j = 0; j < (long)n; j++)
        for (long i = 0; i < 2 * (long)n; i++) sum += gauss_density(pi * (((double)j + 0.5) / n - 0.5));
    const double total = sum * (pi / n) * (pi / n);
    return (outcome){fabs(total - 4 * pi), total};
}

#ifdef HAVE_GSL
static double integral(double (*f)(double x, void *context), double a, double b, double tolerance)
{
    double value = 0, error;
    gsl_integration_workspace *room = gsl_integration_workspace_alloc(1000);
    gsl_function function = {f, NULL};
    gsl_set_error_handler_off(); /* what it could not reach shows in the error */
    gsl_integration_qags(&function, a, b, 0, tolerance, 1000, room, &value, &error);
    gsl_integration_workspace_free(room);
    return value;
}

static double speed(double t, void *context)
{
    (void)context;
    return hypot(2 * sin(t), cos(t));
}

static double density(double v, void *context)
{
    (void)context;
    return 2 * pi * gauss_density(v);
}

outcome ellipse_gsl(double tolerance)
{
    const double length = integral(speed, 0, 2 * pi, tolerance);
    return (outcome){fabs(length / ellipse_length - 1), length};
}

outcome ellipsoid_gsl(double tolerance)
{
    const double total = integral(density, -pi / 2, pi / 2, tolerance);
    return (outcome){fabs(total - 4 * pi), total};
}
#else
outcome ellipse_gsl(double tolerance) { return (outcome){NAN, tolerance}; }
outcome ellipsoid_gsl(double tolerance) { return (outcome){NAN, tolerance}; }
#endif
