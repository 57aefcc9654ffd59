/* SPDX-License-Identifier: MIT */
#include "tumble_oracle.h"

#include <quadmath.h>

typedef __float128 real;

/* ---- elliptic functions ---- */

static real agm(real a, real b)
{
    for (int i = 0; i < 60 && fabsq(a - b) > 1e-33Q * a; i++) {
        const real mean = (a + b) / 2;
        b = sqrtq(a * b);
        a = mean;
    }
    return a;
}

static real quarter_period(real m1) { return M_PIq / 2 / agm(1, sqrtq(m1)); }

double oracle_elliptic_k(double m1) { return (double)quarter_period(m1); }

/* Abramowitz and Stegun 16.4: up the arithmetic-geometric mean, down again in the amplitude. */
void oracle_elliptic(double m1, double u, double *sn, double *cn, double *dn)
{
    enum { MOST = 60 };
    real a[MOST], c[MOST], b = sqrtq(m1);
    int n = 0;
    a[0] = 1;
    c[0] = sqrtq(1 - (real)m1);
    while (n + 1 < MOST && c[n] > 1e-34Q) {
        a[n + 1] = (a[n] + b) / 2;
        c[n + 1] = (a[n] - b) / 2;
        b = sqrtq(a[n] * b);
        n++;
    }
    real phi = ldexpq(a[n] * u, n);
    for (; n > 0; n--) phi = (phi + asinq(c[n] / a[n] * sinq(phi))) / 2;
    const real s = sinq(phi), k = cosq(phi);
    *sn = (double)s;
    *cn = (double)k;
    *dn = (double)sqrtq(k * k + m1 * s * s);
}

double oracle_elliptic_phase(double m1, double u, double f)
{
    const real K = quarter_period(m1), Kp = quarter_period(1 - (real)m1);
    const real z = M_PIq * u / (2 * K), zeta = M_PIq * f * Kp / (2 * K), log_q = -M_PIq * Kp / K;
    real re = 1, im = 0;
    for (int n = 1; n < 400; n++) {
        const real sign = n % 2 ? -1 : 1, up = expq(2 * n * n * log_q + 2 * n * zeta),
                   down = expq(2 * n * n * log_q - 2 * n * zeta);
        re += sign * cosq(2 * n * z) * (up + down);
        im -= sign * sinq(2 * n * z) * (up - down);
    }
    return (double)atan2q(im, re);
}

/* ---- tumbling ---- */

enum { ORDER = 32 };

typedef struct body {
    real I[3], L[3], q[4]; /* L in the body's axes */
} body;

static body make_body(qvec3 moments, quat orientation, qvec3 momentum)
{
    body b = {{moments.x, moments.y, moments.z}, {0}, {orientation.w, orientation.x, orientation.y, orientation.z}};
    const real world[3] = {momentum.x, momentum.y, momentum.z};
    real norm = 0;
    for (int i = 0; i < 4; i++) norm += b.q[i] * b.q[i];
    for (int i = 0; i < 4; i++) b.q[i] /= sqrtq(norm);
    const real w = b.q[0], x = b.q[1], y = b.q[2], z = b.q[3];
    const real R[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; i++) b.L[i] = R[0][i] * world[0] + R[1][i] * world[1] + R[2][i] * world[2];
    return b;
}

static real horner(const real *c, real h)
{
    real value = 0;
    for (int n = ORDER; n >= 0; n--) value = value * h + c[n];
    return value;
}

/* L' = L x omega, q' = q (0, omega)/2, omega = L/I in the body's axes. */
static void step(body *b, real h)
{
    real L[3][ORDER + 1], w[3][ORDER + 1], q[4][ORDER + 1];
    for (int i = 0; i < 3; i++) L[i][0] = b->L[i], w[i][0] = b->L[i] / b->I[i];
    for (int i = 0; i < 4; i++) q[i][0] = b->q[i];
    for (int n = 0; n < ORDER; n++) {
        real rate[4] = {0};
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            real sum = 0;
            for (int m = 0; m <= n; m++) sum += L[j][m] * L[k][n - m];
            L[i][n + 1] = sum * (1 / b->I[k] - 1 / b->I[j]) / (n + 1);
            w[i][n + 1] = L[i][n + 1] / b->I[i];
        }
        for (int m = 0; m <= n; m++) {
            const real x = w[0][n - m], y = w[1][n - m], z = w[2][n - m];
            rate[0] -= q[1][m] * x + q[2][m] * y + q[3][m] * z;
            rate[1] += q[0][m] * x + q[2][m] * z - q[3][m] * y;
            rate[2] += q[0][m] * y + q[3][m] * x - q[1][m] * z;
            rate[3] += q[0][m] * z + q[1][m] * y - q[2][m] * x;
        }
        for (int i = 0; i < 4; i++) q[i][n + 1] = rate[i] / 2 / (n + 1);
    }
    for (int i = 0; i < 3; i++) b->L[i] = horner(L[i], h);
    for (int i = 0; i < 4; i++) b->q[i] = horner(q[i], h);
}

static real size_of(const body *b) { return sqrtq(b->L[0] * b->L[0] + b->L[1] * b->L[1] + b->L[2] * b->L[2]); }

/* A third of a radian a step, of omega or of its turn in the body by Euler's equations, (I_i - I_j)/I_k times as fast;
 * neither is faster than |L| over the smallest moment. The 32nd power is 1e-16, and the nearest pole of an elliptic
 * function is pi/2 away or more: 1e-22. */
static void spin(body *b, real t)
{
    const real sign = t < 0 ? -1 : 1, most = size_of(b) / fminq(b->I[0], fminq(b->I[1], b->I[2]));
    real left = fabsq(t), gyration = 1;
    for (int i = 0; i < 3; i++) gyration = fmaxq(gyration, fabsq(b->I[i] - b->I[(i + 1) % 3]) / b->I[(i + 2) % 3]);
    while (left > 0) {
        real square = 0;
        for (int i = 0; i < 3; i++) square += b->L[i] * b->L[i] / (b->I[i] * b->I[i]);
        const real h = fminq(left, 1 / (3 * fminq(most, gyration * sqrtq(square))));
        step(b, sign * h);
        left -= h;
    }
}

/* Landau and Lifshitz, Mechanics, section 37. */
static real period_of(const body *b)
{
    real I[3] = {b->I[0], b->I[1], b->I[2]};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2 - i; j++)
            if (I[j] > I[j + 1]) {
                const real swap = I[j];
                I[j] = I[j + 1];
                I[j + 1] = swap;
            }
    const real M2 = size_of(b) * size_of(b);
    real E2 = 0;
    for (int i = 0; i < 3; i++) E2 += b->L[i] * b->L[i] / b->I[i];
    if (M2 < E2 * I[1]) {
        const real swap = I[0];
        I[0] = I[2];
        I[2] = swap;
    }
    const real k2 = (I[1] - I[0]) * (E2 * I[2] - M2) / ((I[2] - I[1]) * (M2 - E2 * I[0]));
    return 4 * quarter_period(1 - k2) * sqrtq(I[0] * I[1] * I[2] / ((I[2] - I[1]) * (M2 - E2 * I[0])));
}

double oracle_tumble_period(qvec3 moments, quat orientation, qvec3 momentum)
{
    const body b = make_body(moments, orientation, momentum);
    return (double)period_of(&b);
}

/* a b. */
static void multiply(const real a[4], const real b[4], real product[4])
{
    product[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    product[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    product[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    product[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

static void tumble(body *b, const real axis[3], real t)
{
    const real period = period_of(b), laps = nearbyintq(t / period);
    if (finiteq(period) && laps != 0) {
        const real back[4] = {b->q[0], -b->q[1], -b->q[2], -b->q[3]};
        body lap = *b;
        real turn[4], turned[4], along = 0;
        spin(&lap, period);
        multiply(lap.q, back, turn);
        for (int i = 0; i < 3; i++) along += turn[i + 1] * axis[i] / size_of(b);
        const real half = laps * atan2q(along, turn[0]);
        const real turns[4] = {cosq(half), sinq(half) * axis[0] / size_of(b), sinq(half) * axis[1] / size_of(b),
                               sinq(half) * axis[2] / size_of(b)};
        multiply(turns, b->q, turned);
        for (int i = 0; i < 4; i++) b->q[i] = turned[i];
        t -= laps * period;
    }
    spin(b, t);
}

quat oracle_tumble(qvec3 moments, quat orientation, qvec3 momentum, double t)
{
    body b = make_body(moments, orientation, momentum);
    const real axis[3] = {momentum.x, momentum.y, momentum.z};
    tumble(&b, axis, t);
    return (quat){(double)b.q[0], (double)b.q[1], (double)b.q[2], (double)b.q[3]};
}

double oracle_tumble_sensitivity(qvec3 moments, quat orientation, qvec3 momentum, double t)
{
    const body start = make_body(moments, orientation, momentum);
    const real rounding = 0x1p-53Q;
    body there = start;
    double sum = 0;
    spin(&there, t);
    for (int k = 0; k < 6; k++) {
        body other = start;
        real square = 0;
        if (k < 3)
            other.I[k] *= 1 + rounding;
        else
            other.L[k - 3] += rounding * size_of(&start);
        spin(&other, t);
        for (int i = 0; i < 4; i++) square += (other.q[i] - there.q[i]) * (other.q[i] - there.q[i]);
        sum += (double)sqrtq(square);
    }
    return sum;
}

static body spinning_body(qvec3 moments, quat orientation, qvec3 omega)
{
    body b = make_body(moments, orientation, (qvec3){0, 0, 0});
    b.L[0] = (real)moments.x * omega.x, b.L[1] = (real)moments.y * omega.y, b.L[2] = (real)moments.z * omega.z;
    return b;
}

void oracle_tumble_omega(qvec3 moments, quat orientation, qvec3 omega, double t, quat *q, qvec3 *omega_t)
{
    body b = spinning_body(moments, orientation, omega);
    const real back[4] = {b.q[0], -b.q[1], -b.q[2], -b.q[3]}, inside[4] = {0, b.L[0], b.L[1], b.L[2]};
    real half[4], world[4];
    multiply(b.q, inside, half);
    multiply(half, back, world);
    tumble(&b, world + 1, t);
    *q = (quat){(double)b.q[0], (double)b.q[1], (double)b.q[2], (double)b.q[3]};
    *omega_t = (qvec3){(double)(b.L[0] / b.I[0]), (double)(b.L[1] / b.I[1]), (double)(b.L[2] / b.I[2])};
}

void oracle_tumble_omega_sensitivity(qvec3 moments, quat orientation, qvec3 omega, double t, double *of_q,
                                     double *of_omega)
{
    const body start = spinning_body(moments, orientation, omega);
    const real change = 0x1p-60Q;
    body there = start;
    spin(&there, t);
    *of_q = *of_omega = 0;
    for (int k = 0; k < 6; k++) {
        body other = start;
        real turned = 0, faster = 0, size = 0;
        if (k < 3) other.I[k] *= 1 + change;
        other.L[k % 3] *= 1 + change; /* omega stays as it is where a moment changes */
        spin(&other, t);
        for (int i = 0; i < 4; i++) turned += (other.q[i] - there.q[i]) * (other.q[i] - there.q[i]);
        for (int i = 0; i < 3; i++) {
            const real off = other.L[i] / other.I[i] - there.L[i] / there.I[i];
            faster += off * off, size += there.L[i] * there.L[i] / (there.I[i] * there.I[i]);
        }
        *of_q += (double)(2 * sqrtq(turned) / change);
        *of_omega += (double)(sqrtq(faster / size) / change);
    }
}
