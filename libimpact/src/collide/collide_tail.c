/* SPDX-License-Identifier: MIT
 *
 * The last way of a slip that ends. Let the direction end at theta_e, T(theta_e) = 0 > T'(theta_e), R(theta_e) < 0, and
 * t = tan((theta - theta_e) / 2). What is still to come of an integral of s^n g(theta) d tau is s^n f(t), with f
 * analytic at t = 0:
 *
 *   V f' + n R~ f = -(1 + t^2)^2 g,   V = (1 + t^2)^3 T / 2 (degree 6, V(0) = 0),   R~ = (1 + t^2)^2 R (degree 4),
 *
 * a recurrence of a few terms for its coefficients: f_k (k V_1 + n R~_0) = known, and V_1, R~_0 < 0 never cancel.
 */
#include "collide/collide_series.h"

#include <float.h>

enum { TERMS = 64 };

typedef struct direction {
    double x, y;
} direction;

/* Newton for T = 0 from (x, y), turning the vector by a rational rotation. */
static bool find_end(const imp_frame *frame, double mu, direction *e)
{
    for (int i = 0; i < 8; i++) {
        const double T = imp_course_turning(frame, mu, e->x, e->y);
        const double slope =
            -(frame->c * e->x + frame->d * e->y) + mu * (frame->a - frame->b) * (e->x * e->x - e->y * e->y);
        if (!(slope < 0)) return false;
        const double half = -0.5 * T / slope;
        if (fabs(half) > 0.4) return false;
        const double f = 1 / (1 + half * half), cs = (1 - half * half) * f, sn = 2 * half * f;
        *e = (direction){cs * e->x - sn * e->y, sn * e->x + cs * e->y};
        if (fabs(half) < 1e-9) {
            const double n = 1 / sqrt(e->x * e->x + e->y * e->y);
            *e = (direction){e->x * n, e->y * n};
            return true;
        }
    }
    return false;
}

typedef struct recurrence {
    double V[7], R[5];
    double reach; /* |t| well inside the circle of convergence, by a bound on the nearest root of V / t */
} recurrence;

static void make_recurrence(recurrence *q, double mu, double a, double b, double e, double c, double d)
{
    const double g = mu * (b - a), h = mu * e;
    const double T1 = -2 * (c + g), T2 = 6 * h, T3 = -2 * (c - g), T4 = -2 * h;
    q->V[0] = 0;
    q->V[1] = T1 / 2;
    q->V[2] = T2 / 2;
    q->V[3] = (T3 + T1) / 2;
    q->V[4] = (T4 + T2) / 2;
    q->V[5] = T3 / 2;
    q->V[6] = T4 / 2;
    q->R[0] = c - mu * a;
    q->R[1] = 2 * d - 4 * h;
    q->R[2] = 2 * mu * (a - 2 * b);
    q->R[3] = 2 * d + 4 * h;
    q->R[4] = -c - mu * a;
    /* Fujiwara's bound for the roots of T~ / t; the factor 1 + t^2 is regular but for t = +-i. */
    const double root = 2 * imp_larger(imp_larger(fabs(T2 / T1), sqrt(fabs(T3 / T1))), cbrt(fabs(T4 / T1) / 2));
    q->reach = 1 / imp_larger(root, 1);
}

/* The next coefficient of f for right-hand side -G_k. */
static double next(const recurrence *q, const double *f, int k, int n, double G)
{
    double sum = G;
    for (int j = 2; j <= 6 && j <= k; j++) sum += q->V[j] * (k - j + 1) * f[k - j + 1];
    double low = 0;
    for (int j = 1; j <= 4 && j <= k; j++) low += q->R[j] * f[k - j];
    return -(sum + n * low) / (k * q->V[1] + n * q->R[0]);
}

bool imp_tail_make(imp_tail *tail, const imp_frame *frame, double mu, double ux, double uy, double s, double uz)
{
    static const double one[5] = {1, 0, 2, 0, 1}, cosine[5] = {1, 0, 0, 0, -1}, sine[5] = {0, 2, 0, 2, 0};
    const direction start = {ux / s, uy / s};
    direction end = start;
    if (!find_end(frame, mu, &end)) return false;
    const double x = end.x, y = end.y;
    /* M_tt and M_tz along and across the end direction. */
    const double a = frame->a * x * x + frame->b * y * y, b = frame->a * y * y + frame->b * x * x;
    const double e = (frame->b - frame->a) * x * y, c = frame->c * x + frame->d * y, d = mu * e;
    recurrence q;
    make_recurrence(&q, mu, a, b, e, c, d);
    if (!(q.R[0] < 0 && q.V[1] < 0)) return false;
    const double t = (x * start.y - y * start.x) / (1 + (x * start.x + y * start.y));
    if (fabs(t) > 0.8 * q.reach) return false;

    double f[TERMS], fx[TERMS], fy[TERMS], ff[TERMS], g[TERMS], w[TERMS];
    double sf = 0, sx = 0, sy = 0, sff = 0, sw = 0, power = 1;
    bool settled = false;
    int small = 0;
    for (int k = 0; k < TERMS && !settled; k++) {
        f[k] = next(&q, f, k, 1, k < 5 ? one[k] : 0);
        fx[k] = next(&q, fx, k, 1, k < 5 ? cosine[k] : 0);
        fy[k] = next(&q, fy, k, 1, k < 5 ? sine[k] : 0);
        ff[k] = next(&q, ff, k, 2, k < 5 ? one[k] : 0);
        g[k] = f[k] - mu * (c * fx[k] + d * fy[k]);
        w[k] = next(&q, w, k, 2, g[k] + (k >= 2 ? 2 * g[k - 2] : 0) + (k >= 4 ? g[k - 4] : 0));
        sf += f[k] * power;
        sx += fx[k] * power;
        sy += fy[k] * power;
        sff += ff[k] * power;
        sw += w[k] * power;
        const bool tiny = fabs(f[k] * power) <= 1e-17 * fabs(sf) && fabs(fx[k] * power) <= 1e-17 * fabs(sx) &&
                          fabs(fy[k] * power) <= 1e-17 * fabs(sx) && fabs(ff[k] * power) <= 1e-17 * fabs(sff) &&
                          fabs(w[k] * power) <= 1e-17 * (fabs(sw) + sf * sf);
        small = tiny ? small + 1 : 0;
        settled = small >= 2 || (k > 0 && t == 0);
        power *= t;
    }
    if (!settled) return false;
    const double along = -mu * s * sx, over = -mu * s * sy;
    tail->p = s * sf;
    tail->px = along * x - over * y;
    tail->py = along * y + over * x;
    tail->rise = tail->p + c * along + d * over;
    tail->work = (uz + tail->rise) * tail->p - s * s * sw;
    tail->work_f = -mu * s * s * sff;
    return true;
}
