/* SPDX-License-Identifier: MIT */
#include "motion/face_begin.h"
#include "base/tolerances.h"

#include <math.h>
#include <quat/quat.h>
#include <string.h>

/* A load, in the face's axes; twists and loads are (v, k w) and (F, M/k)/m with k^2 = J/m, and across a line by the
 * root of its ease likewise: M = 1. Lengths over size. */
typedef struct problem {
    const imp_face_motion *motion;
    imp_face_load load;
    double pulled[3], k[3];
    imp_pressed pressed; /* at rest, by */
    double p[3];
} problem;

static double twist_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static double twist_size(const double a[3]) { return qvec3_norm((qvec3){a[0], a[1], a[2]}); }

static void twist_axpy(double t, const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = t * a[i] + b[i];
}

/* ---- rest ---- */

/* D(d) under the pressure of rest, and its slope. */
static double dissipation(const problem *q, const double d[3], double slope[3])
{
    const double twist[3] = {d[0] / q->k[0], d[1] / q->k[1], d[2] / q->k[2]},
                 part = -q->motion->friction * q->load.press;
    double rub[3][3];
    imp_press_rub(&q->pressed, twist, rub);
    for (int i = 0; i < 3; i++) slope[i] = part * twist_dot(rub[i], q->p) / q->k[i];
    return twist_dot(slope, d);
}

/* Two directions at right angles to L and each other. */
static void span_plane(const double L[3], double across[2][3])
{
    const double size = twist_size(L);
    const qvec3 n = {L[0] / size, L[1] / size, L[2] / size},
                least = fabs(n.x) < 0.5 ? (qvec3){1, 0, 0} : (qvec3){0, 1, 0}, a = qvec3_cross(n, least),
                u = qvec3_scale(a, 1 / qvec3_norm(a)), w = qvec3_cross(n, u);
    memcpy(across[0], (double[3]){u.x, u.y, u.z}, sizeof across[0]);
    memcpy(across[1], (double[3]){w.x, w.y, w.z}, sizeof across[1]);
}

/* Newton's step in the plane, of slopes by differences. */
static void step_in_plane(const problem *q, double across[2][3], const double d[3], const double slope[3],
                          double step[3])
{
    double h[2][2], g[2], there[3], turned[3];
    const double small = imp_face_difference(q->motion) * twist_size(d);
    for (int i = 0; i < 2; i++) g[i] = twist_dot(across[i], slope);
    for (int j = 0; j < 2; j++) {
        twist_axpy(small, across[j], d, there);
        (void)dissipation(q, there, turned);
        for (int i = 0; i < 2; i++) h[i][j] = (twist_dot(across[i], turned) - g[i]) / small;
    }
    const double off = 0.5 * (h[0][1] + h[1][0]), whole = h[0][0] * h[1][1] - off * off;
    const bool bends = h[0][0] > 0 && whole > 0;
    const double s[2] = {bends ? (h[1][1] * g[0] - off * g[1]) / whole : g[0],
                         bends ? (h[0][0] * g[1] - off * g[0]) / whole : g[1]};
    for (int i = 0; i < 3; i++) step[i] = -s[0] * across[0][i] - s[1] * across[1][i];
}

/* Whether D >= 1 on the plane L.d = 1; else d is a twist that shows it is not. D falls all along Newton's steps. */
static bool holds(const problem *q, double d[3])
{
    const double square = twist_dot(q->pulled, q->pulled);
    double across[2][3], slope[3], step[3], next[3], sloped[3];
    for (int i = 0; i < 3; i++) d[i] = q->pulled[i] / square;
    span_plane(q->pulled, across);
    double now = dissipation(q, d, slope);
    for (int round = 0; round < IMP_FACE_BEGINS && now >= 1 - IMP_LEVEL; round++) {
        step_in_plane(q, across, d, slope, step);
        const double falls = twist_dot(slope, step);
        if (!(falls < -IMP_LEVEL * now)) return true;
        double t = 1, then = now;
        for (; t > IMP_FACE_HALVED; t *= 0.5) {
            twist_axpy(t, step, d, next);
            then = dissipation(q, next, sloped);
            if (then <= now + IMP_FACE_FALLS * t * falls) break;
        }
        if (!(t > IMP_FACE_HALVED)) return true; /* a rounding from the least */
        now = then;
        memcpy(d, next, sizeof next);
        memcpy(slope, sloped, sizeof sloped);
    }
    return now >= 1 - IMP_LEVEL;
}

/* ---- motion ---- */

/* a - L - f(a/|a|); false: no pressure balances. */
static bool miss(const problem *q, const double a[3], double off[3], imp_face_balance *balance)
{
    const double size = twist_size(a), P = q->load.press;
    const imp_face_twist twist = {.way = {a[0] / (q->k[0] * size), a[1] / (q->k[1] * size), a[2] / (q->k[2] * size)}};
    if (!(size > 0) || !imp_face_balance_under(q->motion, &q->load, &twist, balance)) return false;
    for (int i = 0; i < 2; i++) off[i] = a[i] - q->pulled[i] - P * balance->force[i] / q->k[i];
    off[2] = a[2] - q->pulled[2] - P * balance->moment / q->k[2];
    return true;
}

/* -J^-1 off, J by differences: the step. Friction is the same for any a of one direction: J a = a, which tells what
 * differences of an a near 0 do not. */
static bool step_to_motion(const problem *q, const double a[3], const double off[3], const imp_face_balance *balance,
                           double step[3])
{
    double J[3][3], there[3], turned[3];
    const double small = imp_face_difference(q->motion) * twist_size(a);
    for (int j = 0; j < 3; j++) {
        imp_face_balance last = *balance;
        memcpy(there, a, sizeof there);
        there[j] += small;
        if (!miss(q, there, turned, &last)) return false;
        for (int i = 0; i < 3; i++) J[i][j] = (turned[i] - off[i]) / small;
    }
    const double square = twist_dot(a, a);
    for (int i = 0; i < 3; i++) {
        const double off_a = (a[i] - twist_dot(J[i], a)) / square;
        for (int j = 0; j < 3; j++) J[i][j] += off_a * a[j];
    }
    const qvec3 x = {J[0][0], J[1][0], J[2][0]}, y = {J[0][1], J[1][1], J[2][1]}, z = {J[0][2], J[1][2], J[2][2]},
                b = {-off[0], -off[1], -off[2]}, yz = qvec3_cross(y, z);
    const double whole = qvec3_dot(x, yz);
    if (!(fabs(whole) > 0)) return false;
    step[0] = qvec3_dot(b, yz) / whole;
    step[1] = qvec3_dot(x, qvec3_cross(b, z)) / whole;
    step[2] = qvec3_dot(x, qvec3_cross(y, b)) / whole;
    return isfinite(step[0] + step[1] + step[2]);
}

/* From a on: its motion; what is missed falls with each of Newton's steps. */
static bool find_motion(const problem *q, double a[3], imp_face_balance *balance)
{
    double off[3], step[3], next[3], missed[3];
    if (!miss(q, a, off, balance)) return false;
    for (int round = 0; round < IMP_FACE_BEGINS; round++) {
        const double now = twist_size(off);
        if (!step_to_motion(q, a, off, balance, step)) return false;
        if (twist_size(step) <= IMP_FACE_BEGUN * twist_size(a)) {
            twist_axpy(1, step, a, a);
            return twist_dot(a, q->pulled) > 0 && miss(q, a, off, balance);
        }
        double t = 1;
        for (; t > IMP_FACE_HALVED; t *= 0.5) {
            imp_face_balance last = *balance;
            twist_axpy(t, step, a, next);
            if (!miss(q, next, missed, &last) || !(twist_size(missed) <= (1 - IMP_FACE_FALLS * t) * now)) continue;
            *balance = last;
            break;
        }
        /* what Newton's whole step does not lessen any more is rounding */
        if (t < 1 && now <= IMP_LEVEL * twist_size(q->pulled)) return twist_dot(a, q->pulled) > 0;
        if (!(t > IMP_FACE_HALVED)) return false;
        memcpy(a, next, sizeof next);
        memcpy(off, missed, sizeof missed);
    }
    return false;
}

/* False: y has no load. */
static bool pose(const imp_face_motion *motion, const double *y, problem *q)
{
    const double none[2] = {0, 0};
    q->motion = motion;
    q->k[0] = 1, q->k[1] = 1 / sqrt(imp_face_ease(motion)), q->k[2] = 1 / sqrt(motion->turning);
    if (!imp_face_load_at(motion, y, &q->load)) return false;
    imp_face_turn(q->load.pull, -y[IMP_FACE_ANGLE], q->load.pull);
    q->pulled[0] = q->load.pull[0];
    q->pulled[1] = q->k[1] * (q->load.pull[1] + motion->height * imp_face_roll_rate(motion, &q->load, none));
    q->pulled[2] = q->k[2] * q->load.turn;
    return true;
}

imp_face_begin imp_face_begins(const imp_face_motion *motion, const double *y, double acceleration[3],
                               imp_face_balance *balance)
{
    problem q;
    double d[3] = {0, 0, 0}, slope[3], a[3];
    memset(acceleration, 0, 3 * sizeof *acceleration);
    *balance = (imp_face_balance){.p = {0}};
    if (!pose(motion, y, &q)) return IMP_FACE_NEITHER;
    const bool stands = imp_face_balance_under(motion, &q.load, NULL, balance), pulled = twist_size(q.pulled) > 0;
    if (stands) {
        memcpy(q.p, balance->p, sizeof q.p);
        imp_press_part(&motion->face, q.p, &q.pressed);
        if (!pulled || holds(&q, d)) return IMP_FACE_STANDS;
    }
    if (!pulled) return IMP_FACE_NEITHER;
    /* along a twist d that friction does not hold a.a/2 + D(a) - L.a is least at (L.d - D(d)) d/d.d */
    const double drives = stands ? 1 - dissipation(&q, d, slope) : 1;
    for (int i = 0; i < 3; i++) a[i] = stands ? drives * d[i] / twist_dot(d, d) : q.pulled[i];
    *balance = (imp_face_balance){.p = {0}};
    if (!find_motion(&q, a, balance)) return IMP_FACE_NEITHER;
    a[1] /= q.k[1];
    imp_face_turn(a, y[IMP_FACE_ANGLE], acceleration);
    acceleration[2] = a[2] / q.k[2];
    return IMP_FACE_GOES;
}
