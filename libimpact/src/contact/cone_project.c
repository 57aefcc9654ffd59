/* SPDX-License-Identifier: MIT */
#include "contact/cone.h"

#include <math.h>
#include <string.h>

void imp_cone_project(double friction, const double *v, double *to, double slope[3][3])
{
    const double across = friction > 0 ? sqrt(v[1] * v[1] + v[2] * v[2]) : 0;
    if (slope) memset(slope, 0, 9 * sizeof slope[0][0]);
    to[0] = to[1] = to[2] = 0;
    if (v[0] >= 0 && across <= friction * v[0]) {
        for (int k = 0; k < (friction > 0 ? 3 : 1); k++) {
            to[k] = v[k];
            if (slope) slope[k][k] = 1;
        }
        return;
    }
    if (v[0] <= -friction * across) return;
    const double part = 1 / (1 + friction * friction), dir[3] = {1, friction * v[1] / across, friction * v[2] / across};
    const double size = part * (v[0] + friction * across);
    for (int k = 0; k < 3; k++) {
        to[k] = size * dir[k];
        for (int l = 0; slope && l < 3; l++) slope[k][l] = part * dir[k] * dir[l];
    }
    const double turn = friction * size / across;
    for (int k = 1; slope && k < 3; k++)
        for (int l = 1; l < 3; l++) slope[k][l] += turn * ((k == l) - v[k] * v[l] / (across * across));
}

/* ---- with moments ---- */

void imp_cone_units(double friction, imp_cone_lengths lengths, double units[6])
{
    units[0] = units[1] = units[2] = 1;
    units[3] = lengths.torsional > 0 ? (friction > 0 ? friction : 1) / lengths.torsional : 0;
    units[4] = units[5] = lengths.rolling > 0 ? 1 / lengths.rolling : 0;
}

double imp_cone_slip(double friction, const imp_cone_lengths *lengths, const double *u)
{
    const double across = friction > 0 ? friction * sqrt(u[1] * u[1] + u[2] * u[2]) : 0;
    if (!lengths) return across;
    const double about = lengths->torsional > 0 ? lengths->torsional * u[3] : 0;
    const double rolls = lengths->rolling > 0 ? lengths->rolling * hypot(u[4], u[5]) : 0;
    return (about != 0 ? hypot(across, about) : across) + rolls;
}

/* One of the round cones |v_part| <= slope v_n: which of the six are its parts. */
typedef struct cone_part {
    int from, to;
    double slope, size, dir[3];
} cone_part;

static cone_part part_of(const double *v, int from, int to, double slope)
{
    cone_part part = {.from = from, .to = to, .slope = slope};
    double square = 0;
    for (int k = from; k < to; k++) square += v[k] * v[k];
    part.size = sqrt(square);
    for (int k = from; k < to && part.size > 0; k++) part.dir[k - from] = v[k] / part.size;
    return part;
}

/* On the cone's border at the height n: slope n along dir; and its derivative, n' given. */
static void to_border(const cone_part *part, double n, const double *rate, double *to, double slope[6][6])
{
    const double turn = part->slope * n / part->size;
    for (int k = part->from; k < part->to; k++) {
        to[k] = part->slope * n * part->dir[k - part->from];
        for (int l = 0; slope && l < 6; l++) slope[k][l] = part->slope * part->dir[k - part->from] * rate[l];
        for (int l = part->from; slope && l < part->to; l++)
            slope[k][l] += turn * ((k == l) - part->dir[k - part->from] * part->dir[l - part->from]);
    }
}

/* The nearest point has n = (v_n + sum slope size)/(1 + sum slope²), at least 0, the sums over the parts that are held
 * to their border, those with size > slope n. n is between what it was and size/slope of the part that comes to be
 * held: begun with the greater of both size/slope, none is let go again. Returns n, and which are held. */
static double height_of(double v, const cone_part part[2], bool held[2])
{
    const int first = part[0].size * part[1].slope >= part[1].size * part[0].slope ? 0 : 1;
    double sum = v, square = 1;
    for (int k = 0; k < 2; k++) {
        const int i = k == 0 ? first : 1 - first;
        held[i] = part[i].size * square > part[i].slope * sum;
        if (!held[i]) continue;
        sum += part[i].slope * part[i].size;
        square += part[i].slope * part[i].slope;
    }
    return sum / square;
}

/* n's derivative. */
static void height_rate(const cone_part part[2], const bool held[2], double rate[6])
{
    double square = 1;
    for (int i = 0; i < 2; i++)
        if (held[i]) square += part[i].slope * part[i].slope;
    memset(rate, 0, 6 * sizeof *rate);
    rate[0] = 1 / square;
    for (int i = 0; i < 2; i++)
        for (int k = part[i].from; held[i] && k < part[i].to; k++)
            rate[k] = part[i].slope * part[i].dir[k - part[i].from] / square;
}

void imp_cone_project_turning(double friction, imp_cone_lengths lengths, double rolling, const double *v, double *to,
                              double slope[6][6])
{
    const bool rubs = friction > 0;
    const cone_part part[2] = {part_of(v, rubs ? 1 : 3, lengths.torsional > 0 ? 4 : 3, rubs ? friction : 1),
                               part_of(v, 4, lengths.rolling > 0 ? 6 : 4, rolling)};
    bool held[2];
    double rate[6];
    const double n = height_of(v[0], part, held);
    if (slope) memset(slope, 0, 36 * sizeof slope[0][0]);
    memset(to, 0, 6 * sizeof *to);
    if (!(n > 0)) return;
    height_rate(part, held, rate);
    to[0] = n;
    for (int l = 0; slope && l < 6; l++) slope[0][l] = rate[l];
    for (int i = 0; i < 2; i++) {
        if (held[i]) to_border(&part[i], n, rate, to, slope);
        for (int k = part[i].from; !held[i] && k < part[i].to; k++) {
            to[k] = v[k];
            if (slope) slope[k][k] = 1;
        }
    }
}
