/* SPDX-License-Identifier: MIT
 *
 * Whether g is nowhere more than a bound B < 0, over the whole sphere of normals. Each point v of the bodies'
 * difference c + B - A bounds g(d) by v.d. v.d - B |d| is convex in d, so that where it is no more than 0 at the
 * corners of a spherical triangle it is so throughout. The sphere is halved into such triangles, each with the support
 * point of its middle, until all are cleared or a normal with a larger g turns up. Around a peak n of g, of height g(n)
 * < B, its own point g(n) n does: v.d <= B for all within acos(B/g(n)). So poses with as many equal peaks as symmetry
 * makes are proved once each peak is known: where a middle comes close to the bound Newton is asked for the peak by it.
 * (Where B
 * >= 0, the bodies just touching, a triangle's inside is cleared for at most sqrt(3) times as much.)
 */
#include "base/tolerances.h"
#include "gap/gap_chart.h"
#include "gap/gap_solver.h"
#include <string.h>

/* A triangle is halved 2 log2(1e7) times at most before a peak's point clears it, and the stack keeps one of each two.
 */
enum { MAX_TRIANGLES = 6000, MAX_WAITING = 96 };

typedef struct triangle {
    double d[3][3]; /* unit corners */
    double v[3];    /* the point that all but cleared what it was cut from */
} triangle;

static bool clears(const triangle *t, const double v[3], double depth)
{
    return imp_dot(v, t->d[0]) <= -depth && imp_dot(v, t->d[1]) <= -depth && imp_dot(v, t->d[2]) <= -depth;
}

static bool peaks_clear(const triangle *t, const imp_gap_peaks *peaks, double depth)
{
    for (int i = 0; i < peaks->count; i++)
        if (clears(t, peaks->v[i], depth)) return true;
    return false;
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

/* Eight triangles about n; the one with it in a corner, and their first points. */
static int octants(const imp_gap_peaks *peaks, const double n[3], triangle *waiting)
{
    double t[2][3];
    imp_across(n, t);
    for (int octant = 0; octant < 8; octant++) {
        triangle *o = &waiting[octant];
        for (int i = 0; i < 3; i++) {
            o->d[0][i] = octant & 4 ? n[i] : -n[i];
            o->d[1][i] = octant & 2 ? t[0][i] : -t[0][i];
            o->d[2][i] = octant & 1 ? t[1][i] : -t[1][i];
            o->v[i] = peaks->v[0][i];
        }
    }
    return 8;
}

void imp_gap_peak_add(const double v[3], imp_gap_peaks *peaks)
{
    if (peaks->count < IMP_MOST_PEAKS) memcpy(peaks->v[peaks->count++], v, sizeof peaks->v[0]);
}

static double near_the_peak(const imp_gap_solids *pair, double bound)
{
    return fmin(IMP_GAP_NEAR_PEAK * pair->reach, IMP_GAP_PEAK_OF_DEPTH * fabs(bound));
}

/* Newton for the peak near the normal m, unless it is known or as many were asked for as may be; its height, -INFINITY
 * when there is none. */
static double ask_peak(const imp_gap_solids *pair, imp_gap_peaks *peaks, double bound, double m[3])
{
    imp_gap_bracket meeting;
    const double near = near_the_peak(pair, bound);
    for (int i = 0; i < peaks->count; i++)
        if (imp_dot(m, peaks->v[i]) <= -(1 - IMP_GAP_SAME_PEAK) * imp_norm(peaks->v[i])) return -INFINITY;
    if (peaks->asked++ >= IMP_MOST_PEAKS || !imp_gap_newton(pair, m, NULL, &meeting)) return -INFINITY;
    const double v[3] = {meeting.gap * meeting.n[0], meeting.gap * meeting.n[1], meeting.gap * meeting.n[2]};
    if (meeting.gap > bound)
        memcpy(m, meeting.n, sizeof meeting.n);
    else if (meeting.gap > bound - 2 * near)
        imp_gap_peak_add(v, peaks);
    return meeting.gap;
}

imp_proof imp_gap_prove(const imp_gap_solids *pair, imp_gap_peaks *peaks, double slack, bool climb, double *gap,
                        double n[3])
{
    triangle waiting[MAX_WAITING];
    double depth = -*gap - slack;
    int count = octants(peaks, n, waiting);
    peaks->asked = 0;
    for (int tests = 0; count > 0; tests++) {
        triangle *top = &waiting[count - 1];
        if (clears(top, top->v, depth) || peaks_clear(top, peaks, depth)) {
            count--;
            continue;
        }
        if (tests >= MAX_TRIANGLES || count == MAX_WAITING) return IMP_PROOF_OPEN;
        double m[3], g = support(pair, top, m, top->v);
        if (!climb && g > -depth - near_the_peak(pair, depth)) g = fmax(g, ask_peak(pair, peaks, -depth, m));
        if (g > (climb ? *gap : -depth)) {
            *gap = g;
            memcpy(n, m, sizeof m);
            if (!climb) return IMP_PROOF_AGAINST;
            depth = -g - slack;
        }
        if (clears(top, top->v, depth))
            count--;
        else
            halve(top, fabs(depth), &waiting[count++]);
    }
    return IMP_PROOF_NEAREST;
}
