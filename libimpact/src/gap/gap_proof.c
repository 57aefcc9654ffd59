/* SPDX-License-Identifier: MIT
 *
 * Whether an overlap's normal n, at depth, is the nearest way out: whether g <= -depth for every normal. Each point v
 * of the bodies' difference c + B - A bounds g(d) by v.d. v.d + depth |d| is convex in d, so that where it is no more
 * than 0 at the corners of a spherical triangle it is so throughout. The sphere is halved into such triangles, each
 * with the support point of its middle, until all are cleared or a normal with a larger g turns up. Around n itself,
 * where g is highest, the point there does, for depth a little less: by less than the accuracy that is promised. (Where
 * depth is no more than that, the bodies just touching, a triangle's inside is cleared for at most sqrt(3) times as
 * much.)
 */
#include "gap/gap_chart.h"
#include "gap/gap_solver.h"
#include <string.h>

enum { MAX_TRIANGLES = 6000, MAX_WAITING = 64 };

typedef struct triangle {
    double d[3][3]; /* unit corners */
    double v[3];    /* the point that all but cleared what it was cut from */
} triangle;

static bool clears(const triangle *t, const double v[3], double depth)
{
    return imp_dot(v, t->d[0]) <= -depth && imp_dot(v, t->d[1]) <= -depth && imp_dot(v, t->d[2]) <= -depth;
}

static void middle(const double a[3], const double b[3], double m[3])
{
    for (int i = 0; i < 3; i++) m[i] = a[i] + b[i];
    const double length = imp_norm(m);
    for (int i = 0; i < 3; i++) m[i] /= length;
}

/* Cuts the side along which the bound changes most, for a sphere's point of radius depth at least; *t keeps the half
 * where it is lower. */
static void halve(triangle *t, double depth, triangle *half)
{
    int side = 0;
    double most = -1;
    for (int i = 0; i < 3; i++) {
        const double *a = t->d[i], *b = t->d[(i + 1) % 3], chord[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
        const double change = fabs(imp_dot(t->v, chord)) + depth * imp_dot(chord, chord);
        if (change > most) most = change, side = i;
    }
    double m[3];
    const int next = (side + 1) % 3;
    const bool after = imp_dot(t->v, t->d[next]) > imp_dot(t->v, t->d[side]);
    middle(t->d[side], t->d[next], m);
    *half = *t;
    memcpy(t->d[after ? next : side], m, sizeof m);
    memcpy(half->d[after ? side : next], m, sizeof m);
}

/* The point of the difference farthest against the triangle's middle n; its g. */
static double support(const imp_gap_solids *pair, const triangle *t, double n[3], double v[3])
{
    double x[2][3], sum[3];
    for (int i = 0; i < 3; i++) sum[i] = t->d[0][i] + t->d[1][i] + t->d[2][i];
    const double length = imp_norm(sum);
    for (int i = 0; i < 3; i++) n[i] = sum[i] / length;
    const double g = imp_pair_gap(pair, n, x);
    for (int i = 0; i < 3; i++) v[i] = pair->c[i] + x[1][i] - x[0][i];
    return g;
}

imp_proof imp_gap_prove(const imp_gap_solids *pair, const double here[3], bool climb, double *gap, double n[3])
{
    double t[2][3], depth = -*gap - 1e-14 * pair->reach;
    imp_across(n, t);
    triangle waiting[MAX_WAITING];
    int count = 0;
    for (int octant = 0; octant < 8; octant++) {
        triangle *o = &waiting[count++];
        for (int i = 0; i < 3; i++) {
            o->d[0][i] = octant & 4 ? n[i] : -n[i];
            o->d[1][i] = octant & 2 ? t[0][i] : -t[0][i];
            o->d[2][i] = octant & 1 ? t[1][i] : -t[1][i];
            o->v[i] = here[i];
        }
    }
    for (int tests = 0; count > 0; tests++) {
        triangle *top = &waiting[count - 1];
        if (clears(top, top->v, depth) || clears(top, here, depth)) {
            count--;
            continue;
        }
        if (tests >= MAX_TRIANGLES || count == MAX_WAITING) return IMP_PROOF_OPEN;
        double m[3];
        const double g = support(pair, top, m, top->v);
        if (g > (climb ? *gap : -depth)) {
            *gap = g;
            memcpy(n, m, sizeof m);
            if (!climb) return IMP_PROOF_AGAINST;
            depth = -g - 1e-14 * pair->reach;
        }
        if (clears(top, top->v, depth))
            count--;
        else
            halve(top, fabs(depth), &waiting[count++]);
    }
    return IMP_PROOF_NEAREST;
}
