/* SPDX-License-Identifier: MIT */
#include "contact/cone_order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- without units ---- */

double imp_cone_power_of_two(double value)
{
    int exponent;
    (void)frexp(value, &exponent);
    return value > 0 && isfinite(value) ? ldexp(1, exponent - 1) : 1;
}

int imp_cone_dimension(const imp_cone_problem *problem, int c) { return problem->friction[c] > 0 ? 3 : 1; }

/* Of reactions; of velocities (turning) the units divide. */
static double contact_size(const imp_cone_problem *problem, const double *v, int c, bool turning)
{
    v += imp_cone_width(problem) * c;
    double square = v[0] * v[0], units[6];
    for (int k = 1; k < imp_cone_dimension(problem, c); k++) square += v[k] * v[k];
    if (!problem->lengths) return sqrt(square);
    imp_cone_units(problem->friction[c], problem->lengths[c], units);
    for (int k = 3; k < 6; k++)
        if (units[k] > 0) square += pow(turning ? v[k] / units[k] : v[k] * units[k], 2);
    return sqrt(square);
}

double imp_cone_largest(const imp_cone_problem *problem, const double *v, bool turning)
{
    double most = 0;
    for (int c = 0; c < problem->count; c++) most = fmax(most, contact_size(problem, v, c, turning));
    return most;
}

/* ---- an order of the contacts that is the problem's own ---- */

/* splitmix64's mixing (Steele, Lea & Flood 2014). */
static uint64_t mix(uint64_t h, double value)
{
    const double positive = value + 0.0; /* one zero, not two */
    uint64_t bits;
    memcpy(&bits, &positive, sizeof bits);
    uint64_t z = h + bits + 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static int by_key(const void *a, const void *b)
{
    const struct imp_cone_key *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return (x->contact > y->contact) - (x->contact < y->contact);
}

/* Factors, powers of two, that take the units out of W and q. */
typedef struct cone_units {
    double w, q;
} cone_units;

static cone_units units_of(const imp_cone_problem *problem)
{
    const size_t width = (size_t)imp_cone_width(problem), n = width * (size_t)problem->count;
    double most = 0;
    for (size_t i = 0; i < n; i++)
        if (i % width < 3) most = fmax(most, problem->w[i * (n + 1)]);
    return (cone_units){1 / imp_cone_power_of_two(most),
                        1 / imp_cone_power_of_two(imp_cone_largest(problem, problem->q, true))};
}

static uint64_t own_key(const imp_cone_problem *problem, cone_units units, int c)
{
    const int width = imp_cone_width(problem);
    const size_t n = (size_t)(width * problem->count);
    double length[6] = {1, 1, 1, 0, 0, 0};
    uint64_t h = mix(1, problem->friction[c]);
    if (problem->lengths) {
        const imp_cone_lengths *own = &problem->lengths[c];
        length[3] = own->torsional,
        length[4] = length[5] = own->rolling; /* moments as forces: without units of length */
    }
    for (int k = 0; k < width; k++) {
        h = mix(h, units.q * length[k] * problem->q[width * c + k]);
        for (int l = 0; l < width; l++)
            h = mix(h, units.w * length[k] * length[l] *
                           problem->w[(size_t)(width * c + k) * n + (size_t)(width * c + l)]);
    }
    return h;
}

void imp_cone_choose_order(const imp_cone_problem *problem, struct imp_cone_key *keys, int *order)
{
    const cone_units units = units_of(problem);
    const int count = problem->count, width = imp_cone_width(problem), n = width * count;
    for (int c = 0; c < count; c++) keys[c] = (struct imp_cone_key){.key = own_key(problem, units, c), .contact = c};
    for (int c = 0; c < count; c++) {
        uint64_t sum = 0;
        for (int j = 0; j < count; j++) {
            const double *w = &problem->w[(size_t)(width * c) * (size_t)n + (size_t)(width * j)];
            uint64_t h = keys[j].key;
            if (j == c || (w[0] == 0 && w[1] == 0 && w[2] == 0)) continue;
            for (int k = 0; k < 3; k++) h = mix(h, units.w * w[k]);
            sum += h;
        }
        keys[c].coupled = sum;
    }
    for (int c = 0; c < count; c++) keys[c].key += 3 * keys[c].coupled;
    qsort(keys, (size_t)count, sizeof *keys, by_key);
    for (int c = 0; c < count; c++) order[c] = keys[c].contact;
}
