/* SPDX-License-Identifier: MIT
 *
 * Cone problems made from a known answer: bodies of random mass touch each other and the ground at random places;
 * r and u are chosen complementary, each contact open, sticking or sliding, and q = u - W r. For the cone's test,
 * report and benchmark.
 */
#ifndef CONE_CASES_H
#define CONE_CASES_H

#include <math.h>
#include <stdlib.h>
#include "contact/cone.h"
#include "kit/contact_random.h"

typedef struct cone_case {
    int count;
    double *w, *q, *friction, *r, *u; /* r and u: the answer that it was made from */
} cone_case;

static inline double cone_between(random_stream *random, double low, double high)
{
    return low + (high - low) * random_unit(random);
}

static inline void cone_case_free(cone_case *c)
{
    free(c->w);
    free(c->q);
    free(c->friction);
    free(c->r);
    free(c->u);
}

/* One body's part of a contact's rows of G M^(-1/2): a force at a random arm. */
static inline void cone_case_side(random_stream *random, const qvec3 axes[3], double linear, double angular, double *g,
                                  int width)
{
    const qvec3 arm = random_vector(random, 0.3, 1);
    for (int k = 0; k < 3; k++) {
        const qvec3 torque = qvec3_cross(arm, axes[k]);
        double *row = &g[k * width];
        row[0] = linear * axes[k].x, row[1] = linear * axes[k].y, row[2] = linear * axes[k].z;
        row[3] = angular * torque.x, row[4] = angular * torque.y, row[5] = angular * torque.z;
    }
}

/* W of rank 6 bodies at most. */
static inline void cone_case_matrix(random_stream *random, cone_case *c, int bodies)
{
    const int n = 3 * c->count, width = 6 * bodies;
    double *g = calloc((size_t)n * (size_t)width, sizeof *g), *roots = calloc((size_t)width, sizeof *roots);
    for (int b = 0; b < bodies; b++) {
        roots[2 * b] = sqrt(random_log(random, 0.1, 10));
        roots[2 * b + 1] = roots[2 * b] * random_log(random, 0.5, 4);
    }
    for (int k = 0; k < c->count; k++) {
        const qvec3 normal = random_direction(random),
                    other = fabs(normal.x) < 0.6 ? (qvec3){1, 0, 0} : (qvec3){0, 1, 0};
        const qvec3 across = qvec3_cross(normal, other), tangent = qvec3_scale(across, 1 / qvec3_norm(across));
        const qvec3 axes[3] = {normal, tangent, qvec3_cross(normal, tangent)};
        const int one = (int)cone_between(random, 0, bodies - 1e-9), two = (int)cone_between(random, 0, bodies - 1e-9);
        const bool ground = one == two || random_unit(random) < 0.3;
        cone_case_side(random, axes, roots[2 * one], roots[2 * one + 1], &g[3 * k * width + 6 * one], width);
        if (!ground)
            cone_case_side(random, axes, -roots[2 * two], -roots[2 * two + 1], &g[3 * k * width + 6 * two], width);
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double sum = 0;
            for (int k = 0; k < width; k++) sum += g[i * width + k] * g[j * width + k];
            c->w[(size_t)i * (size_t)n + (size_t)j] = c->w[(size_t)j * (size_t)n + (size_t)i] = sum;
        }
    free(g);
    free(roots);
}

static inline void cone_case_answer(random_stream *random, double friction, double *r, double *u)
{
    const double mode = random_unit(random), angle = cone_between(random, 0, 6.28318530717958647692);
    if (mode < 0.25) { /* open */
        u[0] = random_unit(random);
        u[1] = cone_between(random, -1, 1), u[2] = cone_between(random, -1, 1);
        return;
    }
    r[0] = random_unit(random);
    const double limit = friction * r[0];
    if (mode < 0.65 && friction > 0) { /* sticks */
        const double rubs = limit * sqrt(random_unit(random));
        r[1] = rubs * cos(angle), r[2] = rubs * sin(angle);
        return;
    }
    const double slip = random_unit(random);
    u[1] = slip * cos(angle), u[2] = slip * sin(angle);
    r[1] = -limit * cos(angle), r[2] = -limit * sin(angle);
}

/* So many contacts among so many bodies, friction 0 or to most; a tenth of them without. */
static inline cone_case cone_case_make(random_stream *random, int count, int bodies, double most)
{
    const size_t n = 3 * (size_t)count;
    cone_case c = {count,
                   calloc(n * n, sizeof *c.w),
                   calloc(n, sizeof *c.q),
                   calloc((size_t)count, sizeof *c.friction),
                   calloc(n, sizeof *c.r),
                   calloc(n, sizeof *c.u)};
    cone_case_matrix(random, &c, bodies);
    for (int k = 0; k < count; k++) {
        c.friction[k] = random_unit(random) < 0.1 ? 0 : random_log(random, 0.05 * most, most);
        cone_case_answer(random, c.friction[k], &c.r[3 * k], &c.u[3 * k]);
    }
    for (size_t i = 0; i < n; i++) {
        double sum = 0;
        for (size_t j = 0; j < n; j++) sum += c.w[i * n + j] * c.r[j];
        c.q[i] = c.u[i] - sum;
    }
    return c;
}

static inline imp_cone_problem cone_case_problem(const cone_case *c)
{
    return (imp_cone_problem){.count = c->count, .w = c->w, .q = c->q, .friction = c->friction};
}

#endif
