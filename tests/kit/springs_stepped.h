/* SPDX-License-Identifier: MIT
 *
 * The springs of docs/together.md by small steps of equal length, friction of each by its convex problem: no modes, no
 * events, and whatever begins to slip or stops is told by that problem alone. Runge & Kutta's implicit method of two
 * stages and order two (Alexander 1977), L-stable, so that sticking and creeping are no other than slipping:
 *
 *     U = u + sum a h W F,   D = delta - sum a h U_n,   F = (lambda(D), f),   f against U_t, or within its disc: U_t =
 * 0
 *
 * by Gauss's sweeps over the contacts. The error falls with the square of the step, though where slip begins or stops
 * not evenly. Forms and rows are springs_oracle.h's.
 */
#ifndef SPRINGS_STEPPED_H
#define SPRINGS_STEPPED_H

#include "kit/springs_oracle.h"

enum { STEPPED_WIDTH = 3 * ORACLE_CONTACTS, STEPPED_SWEEPS = 2000 };

typedef struct stepped_contact {
    double friction, restitution, stiffness, depth, deepest, base, kappa;
    bool unloads;
    double axis[2], along[2]; /* of the tangential block of W: an eigenvector, the eigenvalues */
} stepped_contact;

typedef struct stepped {
    int count;
    double w[STEPPED_WIDTH][STEPPED_WIDTH], u[STEPPED_WIDTH], p[STEPPED_WIDTH];
    stepped_contact contact[ORACLE_CONTACTS];
} stepped;

static inline void stepped_set(stepped *s, const oracle *o)
{
    double mean = 0;
    *s = (stepped){.count = o->contacts};
    for (int k = 0; k < 3 * s->count; k++) {
        real unit[6 * ORACLE_BODIES] = {0};
        oracle_push(o, k / 3, k % 3, 1, unit);
        for (int l = 0; l < 3 * s->count; l++) s->w[l][k] = (double)oracle_velocity(o, unit, l / 3, l % 3);
        s->u[k] = (double)oracle_velocity(o, o->y, k / 3, k % 3);
        if (k % 3 == 0) mean += s->w[k][k] / s->count;
    }
    for (int k = 0; k < 3 * s->count; k++)
        for (int l = 0; l < 3 * s->count; l++) s->w[l][k] /= mean;
    for (int c = 0; c < s->count; c++) {
        const oracle_contact *own = &o->contact[c];
        stepped_contact *to = &s->contact[c];
        *to = (stepped_contact){.friction = (double)own->friction,
                                .restitution = (double)own->restitution,
                                .stiffness = (double)own->stiffness,
                                .kappa = (double)own->stiffness};
        const double xx = s->w[3 * c + 1][3 * c + 1], xy = s->w[3 * c + 1][3 * c + 2], yy = s->w[3 * c + 2][3 * c + 2],
                     turn = 0.5 * atan2(2 * xy, xx - yy), part = hypot(0.5 * (xx - yy), xy);
        to->axis[0] = cos(turn), to->axis[1] = sin(turn);
        to->along[0] = 0.5 * (xx + yy) + part, to->along[1] = 0.5 * (xx + yy) - part;
    }
}

/* f with which b + h W_tt f is 0 or against f on the disc's rim: (h W_tt + s) f = -b, |f| = bound. */
static inline void stepped_friction(const stepped_contact *c, const double b[2], double h, double bound, double f[2])
{
    const double x = -(b[0] * c->axis[0] + b[1] * c->axis[1]), y = -(b[1] * c->axis[0] - b[0] * c->axis[1]);
    double shift = 0, g[2];
    for (int turn = 0; turn < 60; turn++) {
        g[0] = x / (h * c->along[0] + shift), g[1] = y / (h * c->along[1] + shift);
        const double size = hypot(g[0], g[1]);
        if (size <= bound * (1 + 1e-15)) break;
        const double slope = g[0] * g[0] / (h * c->along[0] + shift) + g[1] * g[1] / (h * c->along[1] + shift);
        shift += size * size / slope * (size / bound - 1); /* Newton's for 1/|f|: from below */
    }
    f[0] = g[0] * c->axis[0] - g[1] * c->axis[1], f[1] = g[0] * c->axis[1] + g[1] * c->axis[0];
    if (bound == 0) f[0] = f[1] = 0;
}

static inline double stepped_force(const stepped_contact *c, double depth, double exponent)
{
    return depth > c->base ? c->kappa * pow(depth - c->base, exponent) : 0;
}

/* One stage, implicit over h, from u and the contacts' depths: forces, velocities and depths at its end. */
static inline void stepped_stage(const stepped *s, double exponent, double h, const double *u, const double *depth,
                                 double *force, double *after, double *deeper)
{
    const int n = 3 * s->count;
    for (int i = 0; i < n; i++) {
        after[i] = u[i];
        for (int j = 0; j < n; j++) after[i] += h * s->w[i][j] * force[j];
    }
    for (int sweep = 0; sweep < STEPPED_SWEEPS; sweep++) {
        double most = 0;
        for (int c = 0; c < s->count; c++) {
            const stepped_contact *own = &s->contact[c];
            deeper[c] = depth[c] - h * after[3 * c];
            double next[3] = {stepped_force(own, deeper[c], exponent), 0, 0}, b[2];
            for (int i = 0; i < 2; i++)
                b[i] = after[3 * c + 1 + i] + h * s->w[3 * c + 1 + i][3 * c] * (next[0] - force[3 * c]) -
                       h * s->w[3 * c + 1 + i][3 * c + 1] * force[3 * c + 1] -
                       h * s->w[3 * c + 1 + i][3 * c + 2] * force[3 * c + 2];
            stepped_friction(own, b, h, own->friction * next[0], &next[1]);
            for (int k = 0; k < 3; k++) {
                const double change = next[k] - force[3 * c + k];
                for (int i = 0; i < n; i++) {
                    after[i] += h * s->w[i][3 * c + k] * change;
                    most = fmax(most, fabs(h * s->w[i][3 * c + k] * change));
                }
                force[3 * c + k] = next[k];
            }
        }
        if (most < 1e-14) break;
    }
}

/* The branches at the end of a step that began with the depths and velocities given. */
static inline void stepped_turn(stepped *s, const double *depth, const double *u, double exponent, double h)
{
    for (int c = 0; c < s->count; c++) {
        stepped_contact *own = &s->contact[c];
        if (!own->unloads && own->depth > 0 && own->restitution < 1 && s->u[3 * c] > 0 && u[3 * c] <= 0) {
            const double square = own->restitution * own->restitution, part = u[3 * c] / (u[3 * c] - s->u[3 * c]);
            own->deepest = depth[c] - 0.5 * h * part * u[3 * c];
            own->unloads = true;
            own->base = (1 - square) * own->deepest;
            own->kappa = own->stiffness * pow(square, -exponent);
        } else if (own->unloads && own->depth > own->deepest && s->u[3 * c] < 0) {
            own->unloads = false, own->base = 0, own->kappa = own->stiffness;
        }
    }
}

static inline void stepped_step(stepped *s, double exponent, double h, double force[2][STEPPED_WIDTH])
{
    const int n = 3 * s->count;
    const double first = 1 - sqrt(0.5);
    double u[STEPPED_WIDTH], one[STEPPED_WIDTH], depth[ORACLE_CONTACTS], middle[ORACLE_CONTACTS],
        start[ORACLE_CONTACTS], before[STEPPED_WIDTH];
    for (int i = 0; i < n; i++) before[i] = s->u[i];
    for (int c = 0; c < s->count; c++) start[c] = s->contact[c].depth;
    stepped_stage(s, exponent, first * h, s->u, start, force[0], one, middle);
    for (int i = 0; i < n; i++) {
        u[i] = s->u[i] + (1 - first) / first * (one[i] - s->u[i]);
        s->p[i] += h * ((1 - first) * force[0][i]);
    }
    for (int c = 0; c < s->count; c++) depth[c] = start[c] - (1 - first) * h * one[3 * c];
    stepped_stage(s, exponent, first * h, u, depth, force[1], s->u, middle);
    for (int i = 0; i < n; i++) s->p[i] += h * first * force[1][i];
    for (int c = 0; c < s->count; c++) s->contact[c].depth = middle[c];
    stepped_turn(s, start, before, exponent, h);
}

/* Nothing presses: how long until something does, in time; INFINITY: nothing will. */
static inline double stepped_flight(const stepped *s)
{
    double soonest = INFINITY;
    for (int c = 0; c < s->count; c++) {
        const double gap = s->contact[c].base - s->contact[c].depth;
        if (gap < 0) return 0;
        if (s->u[3 * c] < -1e-12) soonest = fmin(soonest, gap / -s->u[3 * c]);
    }
    return soonest;
}

/* Steps of h, in units of the mean of W_nn and of the stiffness, from the encounter's beginning to its end; v, omega of
 * all bodies. False: it takes too long. */
static inline bool stepped_run(const impact_encounter *e, double exponent, double h, qvec3 *v, qvec3 *omega)
{
    oracle o = {.bodies = e->body_count, .contacts = e->meeting_count, .exponent = exponent};
    for (int b = 0; b < o.bodies; b++) oracle_set_body(&o, b, &e->bodies[b]);
    for (int c = 0; c < o.contacts; c++) oracle_set_contact(&o.contact[c], &e->meetings[c]);
    stepped s;
    stepped_set(&s, &o);
    double force[2][STEPPED_WIDTH] = {{0}}, flight = 0;
    for (int step = 0; isfinite(flight = stepped_flight(&s)); step++) {
        if (step == 10000000) return false;
        for (int c = 0; c < s.count; c++) s.contact[c].depth -= s.u[3 * c] * flight;
        stepped_step(&s, exponent, h, force);
    }
    double mean = 0;
    for (int c = 0; c < s.count; c++) {
        real unit[6 * ORACLE_BODIES] = {0};
        oracle_push(&o, c, 0, 1, unit);
        mean += (double)oracle_velocity(&o, unit, c, 0) / s.count;
    }
    for (int k = 0; k < 3 * s.count; k++) oracle_push(&o, k / 3, k % 3, s.p[k] / mean, o.y);
    for (int b = 0; b < o.bodies; b++) {
        const real *y = &o.y[6 * b];
        v[b] = (qvec3){(double)y[0], (double)y[1], (double)y[2]};
        omega[b] = (qvec3){(double)y[3], (double)y[4], (double)y[5]};
    }
    return true;
}

#endif
