/* SPDX-License-Identifier: MIT */
#include "flight/elliptic.h"
#include "base/tolerances.h"
#include "base/numbers.h"

#include <math.h>

enum { TERMS = IMPACT_THETA_TERMS };

/* Each step halves the logarithm of b/a, at most 744 in size, and then doubles the digits: 16 would do. */
enum { MAX_MEANS = 24 };

/* Limit of the arithmetic-geometric mean of 1 and b. */
static double agm(double b)
{
    double a = 1;
    if (b == 0) return 0;
    for (int i = 0; i < MAX_MEANS && fabs(a - b) > IMP_AGM_MET * a; i++) {
        const double mean = 0.5 * (a + b);
        b = sqrt(a * b);
        a = mean;
    }
    return 0.5 * (a + b);
}

/* ---- sn, cn, dn ---- */

/* Powers of the nome, and the theta functions at zero, which the quotients are scaled by. */
static void make_series(impact_elliptic *e, double nome)
{
    double theta2 = 0, theta3 = 1, theta4 = 1; /* theta2 without its factor 2 nome^(1/4) */
    for (int n = 0; n < TERMS; n++) {
        const double square = pow(nome, n * n), product = pow(nome, n * (n + 1));
        theta2 += product;
        if (n > 0) theta3 += 2 * square, theta4 += n % 2 ? -2 * square : 2 * square;
        e->even[n] = e->hyperbolic ? pow(nome, n * (n - 1)) : 2 * square;
        e->odd[n] = e->hyperbolic ? square : product;
    }
    e->sn = theta3 / (e->hyperbolic ? theta4 : theta2);
    e->cn = e->hyperbolic ? theta2 / theta4 : theta4 / theta2;
    e->dn = e->hyperbolic ? theta2 / theta3 : theta4 / theta3;
}

void imp_elliptic_make(double m, double m1, impact_elliptic *e)
{
    const double half_pi = 0.5 * IMP_PI, mean = agm(sqrt(m1)), complementary = agm(sqrt(m));
    e->K = half_pi / mean;
    e->hyperbolic = IMP_PI * mean < 2.302585092994046 * complementary; /* exp(-pi K'/K) > 0.1 */
    e->scale = e->hyperbolic ? complementary : mean;                   /* pi/(2 K') or pi/(2 K) */
    make_series(e, exp(-IMP_PI * (e->hyperbolic ? complementary / mean : mean / complementary)));
}

static void at_circular(const impact_elliptic *e, double u, double *sn, double *cn, double *dn)
{
    const double s = sin(e->scale * u), c = cos(e->scale * u), s2 = 2 * s * c, c2 = (c - s) * (c + s);
    double sine = s, cosine = c, even_sine = 0, even_cosine = 1; /* of (2 n + 1) z and of 2 n z */
    double theta1 = s, theta2 = c, theta3 = 1, theta4 = 1;
    for (int n = 1; n < TERMS; n++) {
        const double next_sine = sine * c2 + cosine * s2, even_next = even_sine * c2 + even_cosine * s2;
        cosine = cosine * c2 - sine * s2;
        sine = next_sine;
        even_cosine = even_cosine * c2 - even_sine * s2;
        even_sine = even_next;
        theta1 += n % 2 ? -e->odd[n] * sine : e->odd[n] * sine;
        theta2 += e->odd[n] * cosine;
        theta3 += e->even[n] * even_cosine;
        theta4 += n % 2 ? -e->even[n] * even_cosine : e->even[n] * even_cosine;
    }
    *sn = e->sn * theta1 / theta4;
    *cn = e->cn * theta2 / theta4;
    *dn = e->dn * theta3 / theta4;
}

/* What the series at imaginary arguments are made of: with v = scale |u| and q' the nome, exp(-v) and q' exp(2 v),
 * each at most 1. */
typedef struct fading {
    double fall, rise;
} fading;

static fading fading_at(const impact_elliptic *e, double u)
{
    return (fading){exp(-e->scale * fabs(u)), exp(-2 * e->scale * (e->K - fabs(u)))};
}

static void at_hyperbolic(const impact_elliptic *e, double u, double *sn, double *cn, double *dn)
{
    const fading f = fading_at(e, u);
    const double x = f.fall * f.fall, down = e->odd[1] * x;
    double rise = 1, fall = x, both = 1;                           /* rise^n, x^(2 n + 1), (q' x)^n */
    double theta1 = 1 - x, theta2 = 1 + x, theta3 = 1, theta4 = 1; /* the first two over exp(v) */
    for (int n = 1; n < TERMS; n++) {
        rise *= f.rise;
        fall *= x * x;
        both *= down;
        const double odd = e->odd[n] * rise, even = e->even[n] * (rise + both);
        theta1 += n % 2 ? -odd * (1 - fall) : odd * (1 - fall);
        theta2 += odd * (1 + fall);
        theta3 += even;
        theta4 += n % 2 ? -even : even;
    }
    *sn = copysign(e->sn * theta1 / theta2, u);
    *cn = e->cn * 2 * f.fall * theta4 / theta2;
    *dn = e->dn * 2 * f.fall * theta3 / theta2;
}

void imp_elliptic_at(const impact_elliptic *e, double u, double *sn, double *cn, double *dn)
{
    if (e->hyperbolic)
        at_hyperbolic(e, u, sn, cn, dn);
    else
        at_circular(e, u, sn, cn, dn);
}

/* ---- integrals ---- */

/* Where one argument is far above the others each step halves the logarithm of their ratio, at most 744; then it
 * quarters the differences: 20 would do. NaN for NaN. */
enum { MAX_DUPLICATIONS = 32 };

double imp_elliptic_rf(double x, double y, double z)
{
    if ((x == 0) + (y == 0) + (z == 0) > 1) return INFINITY;
    for (int i = 0; i < MAX_DUPLICATIONS; i++) {
        const double a = (x + y + z) / 3, dx = 1 - x / a, dy = 1 - y / a, dz = -dx - dy;
        if (fmax(fabs(dx), fmax(fabs(dy), fabs(dz))) < IMP_RF_NEAR) {
            const double e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
            return (1 + e3 * (1.0 / 14 - e2 * (3.0 / 44)) + e2 * (e2 / 24 - 0.1)) / sqrt(a);
        }
        const double rx = sqrt(x), ry = sqrt(y), rz = sqrt(z), lambda = rx * (ry + rz) + ry * rz;
        x = 0.25 * (x + lambda);
        y = 0.25 * (y + lambda);
        z = 0.25 * (z + lambda);
    }
    return NAN;
}

double imp_elliptic_inverse(double sn, double cn, double dn) { return sn * imp_elliptic_rf(cn * cn, dn * dn, 1); }

/* ---- the phase ---- */

/* theta_4(z + i zeta, q^2) = 1 + 2 sum (-1)^n q^(2 n^2) cos(2 n (z + i zeta)); q exp(2 zeta) = exp(-pi w/K), exp(-2
 * zeta) = exp(-pi y/K). */
static void make_circular(const impact_elliptic *e, double y, double w, impact_elliptic_phase *p)
{
    const double up = exp(-2 * e->scale * w), down = exp(-2 * e->scale * y), q = up * down;
    double rate = 0, cosines = 1;
    p->sine[0] = p->linear = 0;
    p->cosine[0] = 1;
    for (int n = 1; n < TERMS; n++) {
        const double a = pow(q, n * (2 * n - 1)) * pow(up, n), b = pow(q, 2 * n * n) * pow(down, n);
        p->sine[n] = n % 2 ? a - b : b - a;
        p->cosine[n] = n % 2 ? -a - b : a + b;
        rate += 2 * n * p->sine[n];
        cosines += p->cosine[n];
    }
    p->slope = e->scale * rate / cosines;
}

/* The same is, but for a linear part and a real factor, theta_2(a - i b, q") = 2 q"^(1/4) sum q"^(n (n + 1)) cos((2
 * n + 1)(a - i b)) with a = pi y/(4 K'), b = pi u/(4 K'), q" = exp(-pi K/(2 K')). */
static void make_hyperbolic(const impact_elliptic *e, double y, impact_elliptic_phase *p)
{
    const double a = 0.5 * e->scale * y, nome = sqrt(e->odd[1]);
    double rate = 0, cosines = 0;
    p->linear = a / e->K;
    for (int n = 0; n < TERMS; n++) {
        const double square = pow(nome, n * n), product = pow(nome, n * (n + 1));
        const double s = sin((2 * n + 1) * a), c = cos((2 * n + 1) * a);
        p->sine[n] = square * s;
        p->cosine[n] = square * c;
        rate += product * (2 * n + 1) * s;
        cosines += product * c;
    }
    p->slope = 0.5 * e->scale * rate / cosines - p->linear;
}

void imp_elliptic_phase_make(const impact_elliptic *e, double y, double w, impact_elliptic_phase *phase)
{
    if (e->hyperbolic)
        make_hyperbolic(e, y, phase);
    else
        make_circular(e, y, w, phase);
}

static double phase_circular(const impact_elliptic *e, const impact_elliptic_phase *p, double u)
{
    const double s2 = sin(2 * e->scale * u), c2 = cos(2 * e->scale * u);
    double sine = 0, cosine = 1, im = 0, re = 1;
    for (int n = 1; n < TERMS - 1; n++) {
        const double next = sine * c2 + cosine * s2;
        cosine = cosine * c2 - sine * s2;
        sine = next;
        im += p->sine[n] * sine;
        re += p->cosine[n] * cosine;
    }
    return atan2(im, re);
}

static double phase_hyperbolic(const impact_elliptic *e, const impact_elliptic_phase *p, double u)
{
    const fading f = fading_at(e, u);
    const double root = sqrt(f.rise), x = f.fall; /* q" exp(2 b), exp(-2 b) */
    double rise = 1, fall = x, im = 0, re = 0;
    for (int n = 0; n < TERMS; n++) {
        im += p->sine[n] * rise * (1 - fall);
        re += p->cosine[n] * rise * (1 + fall);
        rise *= root;
        fall *= x * x;
    }
    const double linear = isinf(e->K) ? 0 : p->linear * fabs(u);
    return copysign(atan2(im, re) - linear, u);
}

double imp_elliptic_phase_at(const impact_elliptic *e, const impact_elliptic_phase *phase, double u)
{
    return e->hyperbolic ? phase_hyperbolic(e, phase, u) : phase_circular(e, phase, u);
}
