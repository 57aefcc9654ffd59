/* SPDX-License-Identifier: MIT
 *
 * bench_mass: principal moments of inertia of convex solids |x/a|^n + |y/b|^n + |z/c|^n = 1. CSV: shape; method;
 * setting; us; the worst relative error of a moment; us over the library's; median over least; checksum. The truth is
 * Dirichlet's integral in long double:
 *
 *   int x^2 dV = 8 a^3 b c/n^3 Gamma(3/n) Gamma(1/n)^2/Gamma(1 + 5/n),   V = 8 a b c/n^3 Gamma(1/n)^3/Gamma(1 + 3/n)
 *
 * Beside it what a program does that knows the surface only: GSL's adaptive quadrature, two within each other, of
 * x^2 z(x, y) over an octant, at tolerances; and tetrahedra from the centre to a mesh of so many points each way.
 * All take turns, round after round.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <impact/shape.h>
#include "measure.h"
#ifdef HAVE_GSL
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#endif

enum { ROUNDS = 9, MOST = 8, SHAPES = 4 };

typedef struct solid {
    impact_shape shape;
    double n;
} solid;

static double dirichlet(double n, double p, double q, double r)
{
    return (double)expl(lgammal(p / (long double)n) + lgammal(q / (long double)n) + lgammal(r / (long double)n) -
                        lgammal(1 + (p + q + r) / (long double)n));
}

/* Per unit mass. */
static qvec3 truth(const solid *s)
{
    const double a = s->shape.a, b = s->shape.b, c = s->shape.c,
                 part = dirichlet(s->n, 3, 1, 1) / dirichlet(s->n, 1, 1, 1);
    return (qvec3){part * (b * b + c * c), part * (c * c + a * a), part * (a * a + b * b)};
}

/* ---- methods ---- */

static qvec3 library(const solid *s, double setting)
{
    (void)setting;
    return impact_shape_inertia(&s->shape);
}

/* Tetrahedra (0, p, q, r) of volume V: int x x^T dV = V/20 (sum p p^T + (p + q + r)(p + q + r)^T). */
static void add_tetrahedron(qvec3 p, qvec3 q, qvec3 r, double *volume, qvec3 *squares)
{
    const double v = qvec3_dot(p, qvec3_cross(q, r)) / 6;
    const qvec3 m = qvec3_add(p, qvec3_add(q, r));
    *volume += v;
    squares->x += v / 20 * (p.x * p.x + q.x * q.x + r.x * r.x + m.x * m.x);
    squares->y += v / 20 * (p.y * p.y + q.y * q.y + r.y * r.y + m.y * m.y);
    squares->z += v / 20 * (p.z * p.z + q.z * q.z + r.z * r.z + m.z * m.z);
}

static qvec3 mesh(const solid *s, double setting)
{
    const int nu = 2 * (int)setting, nv = (int)setting;
    qvec3 *points = malloc((size_t)nu * ((size_t)nv + 1) * sizeof *points), squares = {0, 0, 0};
    double volume = 0;
    if (!points || impact_shape_mesh(&s->shape, nu, nv, points, NULL) != IMPACT_OK) exit(1);
    for (int j = 0; j < nv; j++)
        for (int i = 0; i < nu; i++) {
            const qvec3 *low = points + (size_t)j * (size_t)nu, *high = low + nu;
            const int next = (i + 1) % nu;
            add_tetrahedron(low[i], low[next], high[next], &volume, &squares);
            add_tetrahedron(low[i], high[next], high[i], &volume, &squares);
        }
    free(points);
    return (qvec3){(squares.y + squares.z) / volume, (squares.z + squares.x) / volume,
                   (squares.x + squares.y) / volume};
}

#ifdef HAVE_GSL
/* Of the octant with semi-axes 1: int x^power z dx dy. */
typedef struct octant {
    double n, x, tolerance;
    int power;
    gsl_integration_workspace *inner;
} octant;

static double height(double y, void *context)
{
    const octant *o = context;
    return pow(fmax(0, 1 - pow(o->x, o->n) - pow(y, o->n)), 1 / o->n);
}

static double slice(double x, void *context)
{
    octant *o = context;
    double value = 0, error;
    gsl_function f = {height, o};
    o->x = x;
    gsl_integration_qags(&f, 0, pow(1 - pow(x, o->n), 1 / o->n), 0, o->tolerance, 1000, o->inner, &value, &error);
    return (o->power == 2 ? x * x : 1) * value;
}

static qvec3 quadrature(const solid *s, double tolerance)
{
    gsl_integration_workspace *outer = gsl_integration_workspace_alloc(1000);
    octant o = {.n = s->n, .tolerance = tolerance, .inner = gsl_integration_workspace_alloc(1000)};
    double value[2], error;
    gsl_function f = {slice, &o};
    for (int k = 0; k < 2; k++) {
        o.power = 2 * k;
        gsl_integration_qags(&f, 0, 1, 0, 10 * tolerance, 1000, outer, &value[k], &error);
    }
    gsl_integration_workspace_free(outer);
    gsl_integration_workspace_free(o.inner);
    const double a = s->shape.a, b = s->shape.b, c = s->shape.c, part = value[1] / value[0];
    return (qvec3){part * (b * b + c * c), part * (c * c + a * a), part * (a * a + b * b)};
}
#endif

/* ---- the table ---- */

static const struct {
    const char *name;
    double setting;
    qvec3 (*inertia)(const solid *s, double setting);
    int batch;
} methods[] = {
    {"libimpact", 0, library, 100},
    {"mesh", 16, mesh, 1},
    {"mesh", 64, mesh, 1},
    {"mesh", 256, mesh, 1},
#ifdef HAVE_GSL
    {"GSL QAGS", 1e-4, quadrature, 1},
    {"GSL QAGS", 1e-8, quadrature, 1},
    {"GSL QAGS", 1e-12, quadrature, 1},
#endif
};
enum { METHODS = sizeof methods / sizeof *methods };

static double sum_of(qvec3 v) { return v.x + v.y + v.z; }

static void compete(const char *name, const solid *s)
{
    double times[METHODS][ROUNDS], own = 0, sum = 0;
    const int few = 2, rounds = measure_count(ROUNDS) > few ? measure_count(ROUNDS) : few;
    const qvec3 right = truth(s);
    for (int r = 0; r < rounds; r++)
        for (int k = 0; k < METHODS; k++) {
            const double from = measure_clock();
            for (int b = 0; b < methods[k].batch; b++) sum += methods[k].inertia(s, methods[k].setting).x;
            times[k][r] = 1e6 * measure_since(from) / methods[k].batch;
        }
    if (!isfinite(sum)) printf("# %s: not every method gives a number\n", name);
    for (int k = 0; k < METHODS; k++) {
        const measure_time time = measure_of_rounds(times[k], rounds);
        const qvec3 got = methods[k].inertia(s, methods[k].setting);
        const double off = fmax(fabs(got.x / right.x - 1), fmax(fabs(got.y / right.y - 1), fabs(got.z / right.z - 1)));
        if (k == 0) own = time.median;
        printf("%s,%s,%g,%.4g,%.2g,%.3g,%.2f,%.12g\n", name, methods[k].name, methods[k].setting, time.median, off,
               time.median / own, time.spread, sum_of(got));
    }
    fflush(stdout);
}

int main(void)
{
    static const double exponents[SHAPES] = {2, 2.5, 4, 12};
#ifdef HAVE_GSL
    gsl_set_error_handler_off(); /* what it could not reach shows in the error */
#else
    printf("# GSL is not installed: its rows are skipped\n");
#endif
    printf("shape,method,setting,us,error,time_over_ours,spread,checksum\n");
    for (int k = 0; k < SHAPES; k++) {
        solid s = {.n = exponents[k]};
        char name[40];
        impact_shape_superquadric(0.3, 0.2, 0.1, s.n, s.n, s.n, &s.shape);
        snprintf(name, sizeof name, "exponent %g", s.n);
        compete(name, &s);
    }
    return 0;
}
