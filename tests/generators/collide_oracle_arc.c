/* SPDX-License-Identifier: MIT */
#include "collide_oracle_arc.h"

#include <stdlib.h>
#include <string.h>

/* ---- the roots of T ---- */

/* mu (a - b) / 2, so that T = -c sin + d cos + h sin 2 theta. */
static real half_difference(const slip *f) { return f->mu * (f->a - f->b) / 2; }

static complex_real T_of(const slip *f, complex_real t)
{
    return -f->c * csinq(t) + f->d * ccosq(t) + half_difference(f) * csinq(2 * t);
}

static complex_real T_slope(const slip *f, complex_real t)
{
    return -f->c * ccosq(t) - f->d * csinq(t) + 2 * half_difference(f) * ccosq(2 * t);
}

static complex_real R_of(const slip *f, complex_real t)
{
    return f->c * ccosq(t) + f->d * csinq(t) - f->mu * (f->a + f->b) / 2 - half_difference(f) * ccosq(2 * t);
}

/* T(theta0 + x) - T(theta0), exact for small x. */
static complex_real T_change(const slip *f, real theta0, complex_real x)
{
    const complex_real half = csinq(x / 2), mid = theta0 + x / 2;
    return -2 * half * (f->c * ccosq(mid) + f->d * csinq(mid)) +
           2 * half_difference(f) * ccosq(2 * theta0 + x) * csinq(x);
}

real arc_wrapped(real angle)
{
    const real turn = 2 * M_PIq;
    return angle - turn * floorq(angle / turn);
}

/* h z^4 + (id - c) z^3 + (c + id) z - h = 0, z = exp(i theta), by Aberth's method. */
static void find_quartic(const slip *f, complex_real z[4])
{
    const real h = half_difference(f), C = hypotq(f->c, f->d);
    const complex_real i = 1.0iQ, p3 = i * f->d - f->c, p1 = f->c + i * f->d;
    const complex_real spread[4] = {1.1Q + 0.3iQ, -0.4Q + 0.9iQ, -0.8Q - 0.5iQ, 0.5Q - 1.2iQ};
    memcpy(z, spread, sizeof spread);
    if (fabsq(h) < 0.01Q * C) { /* two of them near the roots for a = b, one far outside and one far inside */
        const complex_real along = p1 / C;
        z[0] = along * (1 + 0.01iQ), z[1] = -along * (1 + 0.013iQ);
        z[2] = -p3 / h * (1 + 0.01iQ), z[3] = h / p1 * (1 + 0.017iQ);
    }
    for (int sweep = 0; sweep < 500; sweep++) {
        real moved = 0;
        for (int n = 0; n < 4; n++) {
            const complex_real value = ((h * z[n] + p3) * z[n] * z[n] + p1) * z[n] - h;
            const complex_real slope = (4 * h * z[n] + 3 * p3) * z[n] * z[n] + p1;
            complex_real sum = 0;
            for (int j = 0; j < 4; j++)
                if (j != n) sum += 1 / (z[n] - z[j]);
            const complex_real newton = value / slope, step = newton / (1 - newton * sum);
            z[n] -= step;
            moved = fmaxq(moved, cabsq(step) / cabsq(z[n]));
        }
        if (moved < 1e-32Q) break;
    }
}

/* Roots as offsets from theta0, each exact in itself however near; false when two of them coincide. */
static bool find_roots(arc *ar)
{
    const slip *f = ar->flow;
    const real T0 = crealq(T_of(f, ar->theta0));
    complex_real root[4];
    if (fabsq(half_difference(f)) < 1e-30Q * hypotq(f->c, f->d)) {
        ar->count = 2;
        root[0] = atan2q(f->d, f->c);
        root[1] = root[0] + M_PIq;
    } else {
        ar->count = 4;
        complex_real z[4];
        find_quartic(f, z);
        for (int n = 0; n < 4; n++) root[n] = -1.0iQ * clogq(z[n]);
    }
    for (int n = 0; n < ar->count; n++) {
        for (int j = 0; j < 3; j++) root[n] -= T_of(f, root[n]) / T_slope(f, root[n]);
        if (fabsq(cimagq(root[n])) < 1e-24Q) root[n] = crealq(root[n]);
        /* The turn nearest to theta0, then Newton on what T changes by. */
        real way = arc_wrapped(crealq(root[n]) - ar->theta0);
        if (way > M_PIq) way -= 2 * M_PIq;
        complex_real x = way + 1.0iQ * cimagq(root[n]);
        for (int j = 0; j < 3; j++) x -= (T0 + T_change(f, ar->theta0, x)) / T_slope(f, ar->theta0 + x);
        if (cimagq(root[n]) == 0) x = crealq(x);
        ar->offset[n] = x;
        ar->exponent[n] = R_of(f, ar->theta0 + x) / T_slope(f, ar->theta0 + x);
    }
    for (int n = 0; n < ar->count; n++)
        for (int j = 0; j < n; j++)
            if (cabsq(csinq((ar->offset[n] - ar->offset[j]) / 2)) < 1e-8Q) return false;
    return true;
}

/* ---- s and T along the arc ---- */

/* log of sin((theta - root) / 2) over the same at theta0, theta - theta0 = 2 turn; of conjugate roots gamma log + its
 * conjugate is the same twice. The argument runs from 0 to at most pi, always the same way round. */
static complex_real log_ratio(const arc *ar, int n, real square, real twice)
{
    const complex_real z = -2 * square + twice * ar->cotangent[n];
    const real x = crealq(z), y = cimagq(z);
    if (cimagq(ar->offset[n]) == 0) return log1pq(x);
    const real argument = fabsq(atan2q(y, 1 + x));
    return log1pq(2 * x + x * x + y * y) / 2 + 1.0iQ * copysignq(argument, ar->sign * cimagq(ar->offset[n]));
}

/* Fills all but the integrals; ss is d(int s^2/T)/dx here. */
static void look(const arc *ar, real x, arc_place *at)
{
    const real e = expq(-fabsq(x)), log_1p = log1pq(e), log_left = x > 0 ? -x - log_1p : -log_1p;
    const real less = e / (1 + e), more = 1 / (1 + e);
    const real way = ar->span * (x > 0 ? more : less), left = ar->span * (x > 0 ? less : more);
    real sn, cs, log_s = 0, log_T = 0;
    sincosq(ar->sign * way / 4, &sn, &cs);
    for (int n = 0; n < ar->count; n++) {
        complex_real ratio;
        if (n == ar->end && 4 * way > ar->span) {
            /* sin(left / 2) / sin(span / 2), however small `left` is. */
            const real sinc = left > 1e-30Q ? sinq(left / 2) / left : 0.5Q;
            ratio = log_left + logq(sinc * ar->span / sinq(ar->span / 2));
        } else {
            ratio = log_ratio(ar, n, sn * sn, 2 * sn * cs);
        }
        log_s += ar->times[n] * crealq(ar->exponent[n] * ratio);
        log_T += ar->times[n] * crealq(ratio);
    }
    at->s = ar->s0 * expq(log_s);
    at->theta = ar->theta0 + ar->sign * way;
    at->rate = ar->s0 / ar->T0 * ar->span * expq(log_s - log_T + 2 * log_left + x);
    at->ss = at->rate * at->s;
}

/* ---- the integrals ---- */

/* The Legendre polynomial of the degree at x, and the one before it. */
static real legendre(int degree, real x, real *before)
{
    real last = x;
    *before = 1;
    for (int n = 2; n <= degree; n++) {
        const real next = ((2 * n - 1) * x * last - (n - 1) * *before) / n;
        *before = last, last = next;
    }
    return last;
}

static void make_nodes(arc *ar)
{
    for (int i = 0; i < ARC_NODES; i++) {
        real x = cosq(M_PIq * (i + 0.75Q) / (ARC_NODES + 0.5Q)), slope = 1, before;
        for (int k = 0; k < 8; k++) {
            const real last = legendre(ARC_NODES, x, &before);
            slope = ARC_NODES * (x * last - before) / (x * x - 1);
            x -= last / slope;
        }
        ar->node[i] = x;
        ar->weight[i] = 2 / ((1 - x * x) * slope * slope);
        const real last = legendre(ARC_NODES - 1, x, &before);
        ar->highest[0][i] = ar->weight[i] * (ARC_NODES - 0.5Q) * last;
        ar->highest[1][i] = ar->weight[i] * (ARC_NODES - 1.5Q) * before;
    }
}

/* An integral over a panel and the size of the highest two Legendre coefficients of the integrand, times half the
 * width. */
typedef struct sum {
    real value, high;
} sum;

static void gauss(const arc *ar, real from, real to, sum *p, sum *ss)
{
    const real half = (to - from) / 2, mid = (to + from) / 2;
    real value[2] = {0, 0}, high[2][2] = {{0, 0}, {0, 0}};
    for (int i = 0; i < ARC_NODES; i++) {
        arc_place at;
        look(ar, mid + half * ar->node[i], &at);
        const real f[2] = {half * at.rate, half * at.ss};
        for (int k = 0; k < 2; k++) {
            value[k] += ar->weight[i] * f[k];
            for (int j = 0; j < 2; j++) high[k][j] += ar->highest[j][i] * f[k];
        }
    }
    *p = (sum){value[0], fabsq(high[0][0]) + fabsq(high[0][1])};
    *ss = (sum){value[1], fabsq(high[1][0]) + fabsq(high[1][1])};
}

/* Coefficients fall like a power: the rule, exact to twice the degree, is off by about the square of the
 * highest ones. */
static bool is_good(sum s, real so_far, real least)
{
    return s.high * s.high <= 1e-24Q * s.value * fmaxq(so_far + s.value, least);
}

/* Adds edges up to `to`, halving panels until they are good. */
static bool add_panel(arc *ar, real to)
{
    const arc_edge last = ar->edge[ar->edges - 1];
    sum p, ss;
    gauss(ar, last.x, to, &p, &ss);
    if (to - last.x > 1e-3Q && !(is_good(p, last.p, ar->least.p) && is_good(ss, last.ss, ar->least.ss)))
        return add_panel(ar, (last.x + to) / 2) && add_panel(ar, to);
    if (ar->edges + 1 > ARC_MOST_PANELS) return false;
    ar->edge[ar->edges++] = (arc_edge){to, last.p + p.value, last.ss + ss.value};
    return true;
}

bool arc_extend(arc *ar, real x)
{
    while (!ar->complete && ar->edge[ar->edges - 1].x < x) {
        const arc_edge last = ar->edge[ar->edges - 1];
        if (!add_panel(ar, last.x + (last.x < -20 ? 8 : fmaxq(3, last.x / 2)))) return false;
        const arc_edge *now = &ar->edge[ar->edges - 1];
        ar->complete = ar->gamma_end > 0 && now->x > 2 && now->p - last.p <= 1e-34Q * now->p &&
                       now->ss - last.ss <= 1e-34Q * now->ss;
    }
    return true;
}

/* The last edge at or before x, or the first of all. */
static int edge_before(const arc *ar, real x)
{
    int low = 0, high = ar->edges;
    while (high - low > 1) {
        const int mid = (low + high) / 2;
        if (ar->edge[mid].x <= x)
            low = mid;
        else
            high = mid;
    }
    return low;
}

bool arc_edge_between(const arc *ar, real x1, real x2, real *x)
{
    const int first = edge_before(ar, x1) + 1, last = edge_before(ar, x2);
    const int mid = (first + last) / 2;
    if (first > last || !(ar->edge[mid].x > x1 && ar->edge[mid].x < x2)) return false;
    *x = ar->edge[mid].x;
    return true;
}

arc_place arc_at(const arc *ar, real x)
{
    const int low = edge_before(ar, x);
    arc_place at;
    sum p = {0, 0}, ss = {0, 0};
    look(ar, x, &at);
    if (ar->edge[low].x != x) gauss(ar, ar->edge[low].x, x, &p, &ss);
    at.p = ar->edge[low].p + p.value;
    at.ss = ar->edge[low].ss + ss.value;
    return at;
}

real arc_place_of(const arc *ar, real way) { return logq(way / (ar->span - way)); }

/* ---- the arc ---- */

bool arc_is_straight(const slip *f)
{
    const real size = fabsq(f->c) + fabsq(f->d) + f->mu * (f->a + f->b);
    return fabsq(crealq(T_of(f, atan2q(f->u[Y], f->u[X])))) < 1e-28Q * size;
}

/* The first edge stands where s and T have not changed yet in 128 bits. */
static void start_table(arc *ar)
{
    real sharp = 1;
    for (int n = 0; n < ar->count; n++) sharp += ar->span * (1 + cabsq(ar->exponent[n])) * cabsq(ar->cotangent[n]);
    const real p = ar->s0 / ar->T0 * ar->span / sharp;
    ar->least = (arc_edge){0, p, p * ar->s0};
    const real part = 1e-20Q;
    ar->edge[0] = (arc_edge){logq(part / sharp), p * part, p * part * ar->s0};
    ar->edges = 1;
}

bool arc_make(arc *ar, const slip *flow)
{
    memset(ar, 0, sizeof *ar);
    ar->flow = flow;
    ar->s0 = hypotq(flow->u[X], flow->u[Y]);
    ar->theta0 = atan2q(flow->u[Y], flow->u[X]);
    const real T0 = crealq(T_of(flow, ar->theta0));
    if (!find_roots(ar)) return false;
    ar->sign = T0 > 0 ? 1 : -1;
    ar->T0 = fabsq(T0);
    ar->span = 10;
    for (int n = 0; n < ar->count; n++) {
        ar->cotangent[n] = 1 / ctanq(-ar->offset[n] / 2);
        ar->times[n] = cimagq(ar->offset[n]) == 0 ? 1 : cimagq(ar->offset[n]) > 0 ? 2 : 0;
        if (cimagq(ar->offset[n]) != 0) continue;
        const real ahead = ar->sign * crealq(ar->offset[n]), way = ahead > 0 ? ahead : ahead + 2 * M_PIq;
        if (way < ar->span) ar->span = way, ar->end = n;
    }
    ar->gamma_end = crealq(ar->exponent[ar->end]);
    make_nodes(ar);
    ar->edge = malloc(ARC_MOST_PANELS * sizeof *ar->edge);
    if (!ar->edge) abort();
    start_table(ar);
    return true;
}

void arc_free(arc *ar) { free(ar->edge); }
