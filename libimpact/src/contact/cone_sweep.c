/* SPDX-License-Identifier: MIT
 *
 * Where no path leads to an answer: contact by contact, in the order of their own,
 *
 *     r_c <- P_K(r_c - û_c/|W_cc|)        |W_cc|^2 the sum of its squares
 *
 * whose only fixed points are answers (De Saxcé & Feng 1998). It goes slowly, the slower the larger the reactions are
 * that contacts press out of one another, and is asked last. What is left then falls by one ratio, that of the slowest:
 * of three points d apart, d' = rho d, the rest of the way is d' rho/(1 - rho) (Aitken 1926).
 *
 * Where there is no answer r goes on for ever, by the same at each sweep in the end, along pressures that balance: a
 * map that brings no two points further apart and has no fixed point goes on by the least that it moves any (Pazy
 * 1971). What comes to rest goes the less at each sweep the longer it has been swept.
 */
#include "contact/cone_map.h"

#include <math.h>
#include <string.h>

static double size_of_block(const imp_cone_problem *problem, int c)
{
    const size_t width = 3 * (size_t)problem->count;
    double square = 0;
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++) {
            const double entry = problem->w[(3 * (size_t)c + i) * width + 3 * (size_t)c + j];
            square += entry * entry;
        }
    return sqrt(square);
}

/* One contact; returns how far its reaction goes. */
static double relax(const imp_cone_problem *problem, int c, double size, double *r)
{
    const int width = 3 * problem->count;
    const double friction = problem->friction[c];
    double u[3], on[3], change = 0;
    for (int k = 0; k < 3; k++) {
        const double *row = &problem->w[(size_t)(3 * c + k) * (size_t)width];
        u[k] = problem->q[3 * c + k];
        for (int j = 0; j < width; j++) u[k] += row[j] * r[j];
    }
    u[0] += friction * hypot(u[1], u[2]);
    for (int k = 0; k < 3; k++) u[k] = r[3 * c + k] - u[k] / size;
    imp_cone_project(friction, u, on, NULL);
    for (int k = 0; k < 3; k++) {
        change = fmax(change, fabs(on[k] - r[3 * c + k]));
        r[3 * c + k] = on[k];
    }
    return change;
}

static void sweep_on(const imp_cone_system *system, const double *size, long sweeps, double *r)
{
    const imp_cone_problem *problem = system->problem;
    for (long k = 0; k < sweeps; k++) {
        double change = 0;
        for (int i = 0; i < problem->count; i++) {
            const int c = system->order[i];
            if (size[c] > 0) change = fmax(change, relax(problem, c, size[c], r));
        }
        if (change == 0) return;
    }
}

double imp_cone_sweep(const imp_cone_system *system, long sweeps, double *r)
{
    const imp_cone_problem *problem = system->problem;
    const int width = 3 * problem->count;
    double *size = system->scratch, *middle = system->trial, *first = system->rate, *drift = system->lift;
    for (int c = 0; c < problem->count; c++) size[c] = size_of_block(problem, c);
    memcpy(first, r, sizeof *r * (size_t)width);
    sweep_on(system, size, sweeps, r);
    memcpy(middle, r, sizeof *r * (size_t)width);
    sweep_on(system, size, sweeps, r);
    double along = 0, square = 0, change = 0, before = 0;
    for (int i = 0; i < width; i++) {
        const double way = middle[i] - first[i], next = r[i] - middle[i], each = next / (double)sweeps;
        along += next * way;
        square += way * way;
        change += (each - drift[i]) * (each - drift[i]);
        before += drift[i] * drift[i];
        drift[i] = each;
    }
    if (along > 0 && along < square) {
        for (int i = 0; i < width; i++) r[i] += (r[i] - middle[i]) * (along / (square - along));
        sweep_on(system, size, sweeps, r); /* into the cones, and what is not slow */
    }
    return before > 0 ? sqrt(change / before) : INFINITY;
}
