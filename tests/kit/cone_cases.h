/* SPDX-License-Identifier: MIT
 *
 * Cone problems made from a known answer: bodies of random mass touch each other and the ground at random places;
 * r and u are chosen complementary, each contact open, sticking or sliding, and q = u - W r; with lengths, with moments
 * and turning too. For the cone's tests, report and benchmark.
 */
#ifndef CONE_CASES_H
#define CONE_CASES_H

#include <math.h>
#include <stdlib.h>
#include "contact/cone.h"
#include "kit/contact_random.h"

typedef struct cone_case {
    int count, width; /* contacts; 3 or, with lengths, 6 */
    imp_cone_lengths *lengths;
    double *w, *q, *friction, *r, *u; /* r and u: the answer that it was made from */
} cone_case;

static inline double cone_between(random_stream *random, double low, double high)
{
    return low + (high - low) * random_unit(random);
}

static inline void cone_case_free(cone_case *c)
{
    free(c->lengths);
    free(c->w);
    free(c->q);
    free(c->friction);
    free(c->r);
    free(c->u);
}

/* One body's part of a contact's rows of G M^(-1/2): a force at a random arm, and moments. */
static inline void cone_case_side(random_stream *random, const qvec3 axes[3], double linear, double angular, double *g,
                                  int width, bool turning)
{
    const qvec3 arm = random_vector(random, 0.3, 1);
    for (int k = 0; k < 3; k++) {
        const qvec3 torque = qvec3_cross(arm, axes[k]);
        double *row = &g[k * width];
        row[0] = linear * axes[k].x, row[1] = linear * axes[k].y, row[2] = linear * axes[k].z;
        row[3] = angular * torque.x, row[4] = angular * torque.y, row[5] = angular * torque.z;
        double *about = &g[(3 + k) * width];
        if (turning) about[3] = angular * axes[k].x, about[4] = angular * axes[k].y, about[5] = angular * axes[k].z;
    }
}

/* W of rank 6 bodies at most. */
static inline void cone_case_matrix(random_stream *random, cone_case *c, int bodies)
{
    const int n = c->width * c->count, width = 6 * bodies;
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
        cone_case_side(random, axes, roots[2 * one], roots[2 * one + 1], &g[c->width * k * width + 6 * one], width,
                       c->lengths);
        if (!ground)
            cone_case_side(random, axes, -roots[2 * two], -roots[2 * two + 1], &g[c->width * k * width + 6 * two],
                           width, c->lengths);
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

/* An answer with moments: the points' slip and their spin on one ellipsoid, the rolling on a disc of its own. */
static inline void cone_case_turning_answer(random_stream *random, double friction, imp_cone_lengths lengths, double *r,
                                            double *u)
{
    const double scale[6] = {1, friction, friction, lengths.torsional, lengths.rolling, lengths.rolling};
    const bool open = random_unit(random) < 0.25;
    r[0] = open ? 0 : random_unit(random);
    u[0] = open ? random_unit(random) : 0;
    for (int part = 0, from = 1; part < 2; part++, from = 4) {
        const int to = part ? 6 : 4;
        const bool held = random_unit(random) < 0.5;
        const double share = sqrt(random_unit(random)), speed = random_unit(random);
        double dir[3], length = 0;
        for (int k = from; k < to; k++) {
            dir[k - from] = scale[k] > 0 ? cone_between(random, -1, 1) : 0;
            length += dir[k - from] * dir[k - from];
        }
        length = length > 0 ? sqrt(length) : 1;
        for (int k = from; k < to; k++) {
            const double along = dir[k - from] / length;
            r[k] = -scale[k] * r[0] * along * (held ? share : 1);
            if ((!held || open) && scale[k] > 0) u[k] = speed * along / scale[k];
            if (scale[k] == 0) u[k] = cone_between(random, -1, 1);
        }
    }
}

static inline cone_case cone_case_room(int count, bool turning)
{
    const int width = turning ? 6 : 3;
    const size_t n = (size_t)(width * count);
    return (cone_case){count,
                       width,
                       turning ? calloc((size_t)count, sizeof(imp_cone_lengths)) : NULL,
                       calloc(n * n, sizeof(double)),
                       calloc(n, sizeof(double)),
                       calloc((size_t)count, sizeof(double)),
                       calloc(n, sizeof(double)),
                       calloc(n, sizeof(double))};
}

/* q = u - W r. */
static inline void cone_case_close(cone_case *c)
{
    const size_t n = (size_t)(c->width * c->count);
    for (size_t i = 0; i < n; i++) {
        double sum = 0;
        for (size_t j = 0; j < n; j++) sum += c->w[i * n + j] * c->r[j];
        c->q[i] = c->u[i] - sum;
    }
}

/* So many contacts among so many bodies, friction 0 or to most; a tenth of them without. */
static inline cone_case cone_case_make(random_stream *random, int count, int bodies, double most)
{
    cone_case c = cone_case_room(count, false);
    cone_case_matrix(random, &c, bodies);
    for (int k = 0; k < count; k++) {
        c.friction[k] = random_unit(random) < 0.1 ? 0 : random_log(random, 0.05 * most, most);
        cone_case_answer(random, c.friction[k], &c.r[3 * k], &c.u[3 * k]);
    }
    cone_case_close(&c);
    return c;
}

/* The same with moments, lengths from 1e-3 to 1 of the arms', a fifth of each without. */
static inline cone_case cone_case_make_turning(random_stream *random, int count, int bodies, double most)
{
    cone_case c = cone_case_room(count, true);
    cone_case_matrix(random, &c, bodies);
    for (int k = 0; k < count; k++) {
        c.friction[k] = random_unit(random) < 0.1 ? 0 : random_log(random, 0.05 * most, most);
        c.lengths[k].torsional = random_unit(random) < 0.2 ? 0 : random_log(random, 1e-3, 1);
        c.lengths[k].rolling = random_unit(random) < 0.2 ? 0 : random_log(random, 1e-3, 1);
        cone_case_turning_answer(random, c.friction[k], c.lengths[k], &c.r[6 * k], &c.u[6 * k]);
    }
    cone_case_close(&c);
    return c;
}

static inline imp_cone_problem cone_case_problem(const cone_case *c)
{
    return (imp_cone_problem){.count = c->count, .w = c->w, .q = c->q, .friction = c->friction, .lengths = c->lengths};
}

#endif
