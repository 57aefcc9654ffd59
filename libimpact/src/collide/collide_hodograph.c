/* SPDX-License-Identifier: MIT
 *
 * With z = e^(i theta) the direction of slip, the rates R of s = |u_t| and T of theta are trigonometric polynomials,
 *
 *   T = Re(p z - q z^2),   p = d + ic,   q = mu (M_xy - i (M_yy - M_xx)/2),   (c, d) = M_tz,
 *   R = Re((c - id) z) - mu ((M_xx + M_yy)/2 + Re(h z^2)),   h = (M_xx - M_yy)/2 - i M_xy,
 *
 * and R/T is a sum of poles: over the roots z_i of q z^4 - p z^3 - p* z + q* = 0, the zeros of T, with gamma_i = R/T'
 * there and sum gamma_i = -2,
 *
 *   log s_1/s_0 = Re sum gamma_i log((z_1 - z_i)/(z_0 - z_i)).
 *
 * Roots lie on the unit circle, gamma then being real, or in pairs z, 1/z*: seen from the circle the inner one is as
 * far as the outer one, and the angles of both add up to the turn of z, so that a pair is 2 Re gamma log|r| + Im gamma
 * (turn - 2 arg r), r that of the outer one. No step of the solvers uses any of this.
 */
#include "collide/collide_hodograph.h"
#include "base/tolerances.h"

#include <complex.h>
#undef I
#include <float.h>
#include <math.h>

#if !defined(CMPLX) /* C11 has it, MinGW not */
#define CMPLX(x, y) __builtin_complex((double)(x), (double)(y))
#endif

typedef double complex point;

/* T and R, and what rounding of M leaves of them over eps. */
typedef struct polynomial {
    point p, q, along, bend; /* along: c - id; bend: mu h */
    double mean, rounding, size;
} polynomial;

static polynomial make_polynomial(const imp_felt_mass *f)
{
    const double mu = f->friction, c = f->m[0][2], d = f->m[1][2], half = (f->m[1][1] - f->m[0][0]) / 2, e = f->m[0][1];
    polynomial t = {
        .p = CMPLX(d, c), .q = CMPLX(mu * e, -mu * half), .along = CMPLX(c, -d), .bend = CMPLX(-mu * half, -mu * e)};
    t.mean = mu * (f->m[0][0] + f->m[1][1]) / 2;
    t.rounding = (1 + mu) * f->rounding;
    t.size = cabs(t.p) + 2 * cabs(t.q);
    return t;
}

/* dT/dtheta and R at any z, on the circle or not. */
static point turning_slope(const polynomial *t, point z)
{
    const point w = 1 / z;
    return _Complex_I * (t->p * z - conj(t->p) * w) / 2 - _Complex_I * (t->q * z * z - conj(t->q) * w * w);
}

static point slip_rate(const polynomial *t, point z)
{
    const point w = 1 / z;
    return (t->along * z + conj(t->along) * w) / 2 - t->mean - (t->bend * z * z + conj(t->bend) * w * w) / 2;
}

/* ---- the roots ---- */

typedef struct pole {
    point z, gamma;
    double off, gamma_off; /* what rounding leaves of both, over eps */
} pole;

/* Two roots near those for q = 0 and two far from the circle, or four about it. */
static void start_poles(const polynomial *t, point z[4])
{
    const point spread[4] = {1.1 + 0.3 * _Complex_I, -0.4 + 0.9 * _Complex_I, -0.8 - 0.5 * _Complex_I,
                             0.5 - 1.2 * _Complex_I};
    for (int i = 0; i < 4; i++) z[i] = spread[i];
    if (cabs(t->q) > 0.01 * cabs(t->p)) return;
    const point near = csqrt(-conj(t->p) / t->p);
    z[0] = near * (1 + 0.01 * _Complex_I), z[1] = -near * (1 + 0.013 * _Complex_I);
    z[2] = t->p / t->q * (1 + 0.01 * _Complex_I), z[3] = conj(t->q) / conj(t->p) * (1 + 0.017 * _Complex_I);
}

/* Aberth's method; false where it has not settled, as at a double root. */
static bool settle_poles(const polynomial *t, point z[4])
{
    const point p = t->p, q = t->q;
    start_poles(t, z);
    for (int sweep = 0; sweep < 40; sweep++) {
        double moved = 0;
        for (int n = 0; n < 4; n++) {
            const point value = ((q * z[n] - p) * z[n] * z[n] - conj(p)) * z[n] + conj(q);
            const point slope = (4 * q * z[n] - 3 * p) * z[n] * z[n] - conj(p);
            point others = 0;
            for (int k = 0; k < 4; k++)
                if (k != n) others += 1 / (z[n] - z[k]);
            const point newton = value / slope, step = newton / (1 - newton * others);
            z[n] -= step;
            moved = fmax(moved, cabs(step) / cabs(z[n]));
        }
        if (moved < 64 * DBL_EPSILON) return true;
    }
    return false;
}

/* Roots on the circle or outside of it; how many, 0: not to be told apart. */
static int make_poles(const polynomial *t, pole out[4])
{
    const double near = IMP_HODOGRAPH_CIRCLE;
    point z[4];
    int count = 0, outer = 0, inner = 0;
    if (!(cabs(t->q) > IMP_HODOGRAPH_LEAST * cabs(t->p)) || !settle_poles(t, z)) return 0;
    for (int n = 0; n < 4; n++) {
        for (int k = 0; k < n; k++)
            if (cabs(z[n] - z[k]) < IMP_HODOGRAPH_APART * cabs(z[n])) return 0;
        const double size = cabs(z[n]);
        outer += size > 1 + near;
        inner += size < 1 - near;
        if (size < 1 - near) continue;
        pole *r = &out[count++];
        r->z = size > 1 + near ? z[n] : z[n] / size;
        const point slope = turning_slope(t, r->z);
        r->gamma = slip_rate(t, r->z) / slope;
        if (size <= 1 + near) r->gamma = creal(r->gamma);
        /* of large z the polynomials' terms are large too */
        r->off = t->rounding * size * size / cabs(slope) * size;
        r->gamma_off = (t->rounding * size * size + t->size * size * r->off) * (1 + cabs(r->gamma)) / cabs(slope);
    }
    return outer == inner ? count : 0;
}

/* ---- the slip ---- */

bool imp_hodograph_residual(const imp_felt_mass *mass, imp_slip from, imp_slip to, double *residual)
{
    const polynomial t = make_polynomial(mass);
    const double s0 = hypot(from.x, from.y), s1 = hypot(to.x, to.y);
    const point z0 = CMPLX(from.x / s0, from.y / s0), z1 = CMPLX(to.x / s1, to.y / s1);
    const double off0 = from.size / s0, off1 = to.size / s1, turning = creal(t.p * z0 - t.q * z0 * z0);
    pole r[4];
    const int count = make_poles(&t, r);
    if (count == 0 || !(fabs(turning) > IMP_HODOGRAPH_TURNS * DBL_EPSILON * (t.rounding + t.size * off0))) return false;
    double turn = carg(z1 / z0), sum = 0, size = off0 + off1;
    if (turn * turning < 0 && fabs(turn) > IMP_HODOGRAPH_APART) turn += copysign(8 * atan(1), turning);
    for (int i = 0; i < count; i++) {
        const double far0 = cabs(z0 - r[i].z), far1 = cabs(z1 - r[i].z),
                     pair = cabs(r[i].z) > 1 + IMP_HODOGRAPH_OUTER ? 2 : 1;
        const double g = cabs(r[i].gamma), grown = log(far1 / far0);
        const double open = (off0 + r[i].off) / far0 + (off1 + r[i].off) / far1;
        /* So near to a direction that does not turn how near is rounding: s goes on, and the direction does not tell.
         */
        if (!(open * DBL_EPSILON < IMP_HODOGRAPH_OPEN)) return false;
        sum += pair * creal(r[i].gamma) * grown;
        if (pair > 1) sum += cimag(r[i].gamma) * (turn - 2 * carg((z1 - r[i].z) / (z0 - r[i].z)));
        size += pair * (g * open + (g + r[i].gamma_off) * (1 + fabs(grown)));
    }
    *residual = fabs(log(s1 / s0) - sum) / (DBL_EPSILON * size);
    return size * DBL_EPSILON < IMP_HODOGRAPH_OPEN;
}
