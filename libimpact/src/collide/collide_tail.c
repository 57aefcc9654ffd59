/* SPDX-License-Identifier: MIT
 *
 * The last way of a slip that ends. Let the direction end at theta_e, T(theta_e) = 0 > T'(theta_e), R(theta_e) < 0, and
 * t = tan((theta - theta_e) / 2). What is still to come of an integral of s^n g(theta) d tau is s^n f(t), with f
 * analytic at t = 0:
 *
 *   V f' + n R~ f = -(1 + t^2)^2 g,   V = (1 + t^2)^3 T / 2 (degree 6, V(0) = 0),   R~ = (1 + t^2)^2 R (degree 4),
 *
 * a recurrence of a few terms for its coefficients: f_k (k V_1 + n R~_0) = known, and V_1, R~_0 < 0 never cancel:
 * R~_0 = R(theta_e) comes as that of a straight line, and V_1 = T'(theta_e) = -(R + mu M_tt across). Likewise
 * du_z/dtau = Z s + mu s (c (1 - cos) - d sin), c and d along and across the end, Z at the end.
 */
#include "collide/collide_series.h"

#ifdef IMP_SECOND
enum { TERMS = 160 };
#else
enum { TERMS = 64 };
#endif

typedef struct direction {
    imp_real x, y;
} direction;

/* Newton for T = 0 from (x, y), turning the vector by a rational rotation. */
static bool find_end(const imp_frame *frame, imp_real mu, direction *e)
{
    for (int i = 0; i < 12; i++) {
        const imp_real T = imp_course_turning(frame, mu, e->x, e->y);
        const imp_real slope =
            -(frame->c * e->x + frame->d * e->y) + mu * (frame->a - frame->b) * (e->x * e->x - e->y * e->y);
        if (!(slope < 0)) return false;
        const imp_real half = -0.5 * T / slope;
        if (imp_abs(half) > 0.4) return false;
        const imp_real f = 1 / (1 + half * half), cs = (1 - half * half) * f, sn = 2 * half * f;
        *e = (direction){cs * e->x - sn * e->y, sn * e->x + cs * e->y};
        if (imp_abs(half) < IMP_ROOT_EPSILON) {
            const imp_real n = 1 / imp_sqrt(e->x * e->x + e->y * e->y);
            *e = (direction){e->x * n, e->y * n};
            return true;
        }
    }
    return false;
}

typedef struct recurrence {
    imp_real V[7], R[5];
    imp_real reach; /* |t| well inside the circle of convergence, by a bound on the nearest root of V / t */
} recurrence;

/* R: at the end. */
static void make_recurrence(recurrence *q, imp_real mu, imp_real a, imp_real b, imp_real e, imp_real c, imp_real d,
                            imp_real R)
{
    const imp_real g = mu * (b - a), h = mu * e;
    const imp_real T1 = -2 * (R + mu * b), T2 = 6 * h, T3 = -2 * (c - g), T4 = -2 * h;
    q->V[0] = 0;
    q->V[1] = T1 / 2;
    q->V[2] = T2 / 2;
    q->V[3] = (T3 + T1) / 2;
    q->V[4] = (T4 + T2) / 2;
    q->V[5] = T3 / 2;
    q->V[6] = T4 / 2;
    q->R[0] = R;
    q->R[1] = 2 * d - 4 * h;
    q->R[2] = 2 * mu * (a - 2 * b);
    q->R[3] = 2 * d + 4 * h;
    q->R[4] = -c - mu * a;
    /* Fujiwara's bound for the roots of T~ / t; the factor 1 + t^2 is regular but for t = +-i. */
    const imp_real root =
        2 * imp_larger(imp_larger(imp_abs(T2 / T1), imp_sqrt(imp_abs(T3 / T1))), cbrt((double)(imp_abs(T4 / T1) / 2)));
    q->reach = 1 / imp_larger(root, 1);
}

/* The next coefficient of f for right-hand side -G_k. */
static imp_real next(const recurrence *q, const imp_real *f, int k, int n, imp_real G)
{
    imp_real sum = G;
    for (int j = 2; j <= 6 && j <= k; j++) sum += q->V[j] * (k - j + 1) * f[k - j + 1];
    imp_real low = 0;
    for (int j = 1; j <= 4 && j <= k; j++) low += q->R[j] * f[k - j];
    return -(sum + n * low) / (k * q->V[1] + n * q->R[0]);
}

bool imp_tail_make(imp_tail *tail, const imp_frame *frame, imp_real mu, imp_real ux, imp_real uy, imp_real s,
                   imp_real uz)
{
    static const imp_real one[5] = {1, 0, 2, 0, 1}, versine[5] = {0, 0, 2, 0, 2}, sine[5] = {0, 2, 0, 2, 0};
    const direction start = {ux / s, uy / s};
    direction end = start;
    if (!find_end(frame, mu, &end)) return false;
    const imp_real x = end.x, y = end.y;
    /* M_tt and M_tz along and across the end direction. */
    const imp_real a = frame->a * x * x + frame->b * y * y, b = frame->a * y * y + frame->b * x * x;
    const imp_real e = (frame->b - frame->a) * x * y, c = frame->c * x + frame->d * y, d = mu * e;
    recurrence q;
    const imp_line line = imp_course_straight_line(frame, mu, x, y);
    make_recurrence(&q, mu, a, b, e, c, d, line.R);
    if (!(q.R[0] < 0 && q.V[1] < 0)) return false;
    const imp_real t = (x * start.y - y * start.x) / (1 + (x * start.x + y * start.y));
    if (imp_abs(t) > 0.8 * q.reach) return false;

    /* Of s, s (1 - cos), s sin, s^2 and, of s du_z, the work. */
    imp_real f[TERMS], fv[TERMS], fy[TERMS], ff[TERMS], g[TERMS], w[TERMS];
    imp_real sf = 0, sv = 0, sy = 0, sff = 0, sw = 0, power = 1;
    bool settled = false;
    int small = 0;
    for (int k = 0; k < TERMS && !settled; k++) {
        f[k] = next(&q, f, k, 1, k < 5 ? one[k] : 0);
        fv[k] = next(&q, fv, k, 1, k < 5 ? versine[k] : 0);
        fy[k] = next(&q, fy, k, 1, k < 5 ? sine[k] : 0);
        ff[k] = next(&q, ff, k, 2, k < 5 ? one[k] : 0);
        g[k] = line.Z * f[k] + mu * (c * fv[k] - d * fy[k]);
        w[k] = next(&q, w, k, 2, g[k] + (k >= 2 ? 2 * g[k - 2] : 0) + (k >= 4 ? g[k - 4] : 0));
        sf += f[k] * power;
        sv += fv[k] * power;
        sy += fy[k] * power;
        sff += ff[k] * power;
        sw += w[k] * power;
        const imp_real least = IMP_EPSILON / 16;
        const bool tiny =
            imp_abs(f[k] * power) <= least * imp_abs(sf) && imp_abs(fv[k] * power) <= least * imp_abs(sf) &&
            imp_abs(fy[k] * power) <= least * imp_abs(sf) && imp_abs(ff[k] * power) <= least * imp_abs(sff) &&
            imp_abs(w[k] * power) <= least * (imp_abs(sw) + sf * sf);
        small = tiny ? small + 1 : 0;
        settled = small >= 2 || (k > 0 && t == 0);
        power *= t;
    }
    if (!settled) return false;
    const imp_real along = -mu * s * (sf - sv), over = -mu * s * sy;
    tail->p = s * sf;
    tail->px = along * x - over * y;
    tail->py = along * y + over * x;
    tail->rise = s * (line.Z * sf + mu * (c * sv - d * sy));
    tail->work = (uz + tail->rise) * tail->p - s * s * sw;
    tail->work_f = -mu * s * s * sff;
    return true;
}
