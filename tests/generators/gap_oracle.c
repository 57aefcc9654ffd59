/* SPDX-License-Identifier: MIT
 *
 * gap_oracle: reference gaps in 113-bit arithmetic, by another road than the library's: Newton on the
 * Karush-Kuhn-Tucker equations in the points alone,
 *
 *     x2 - x1 = nu grad f1(x1),  grad f1(x1) + mu grad f2(x2) = 0,  f1(x1) = f2(x2) = 1,
 *
 * followed along a path: from a pair whose answer is known by construction (chosen normal), body 1 is carried in small
 * steps to a place chosen at random.
 *
 * cc -O2 gap_oracle.c -lquadmath -o gap_oracle && ./gap_oracle > ../data/gap_oracle.csv
 * Rows: kind a b c r s t  x y z  w i j k of body 1 and of body 2; gap; normal (2 to 1); witness points less their
 * body's position.
 */
#include <quadmath.h>
#include <stdint.h>
#include <stdio.h>

typedef __float128 real;

typedef struct body {
    int nested;
    double axis[3], p[3], position[3], q[4];
    real R[3][3];
} body;

static uint64_t state = 2024;

static double uniform(void)
{
    uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static void rotation(body *b)
{
    real n = 0, q[4];
    for (int i = 0; i < 4; i++) n += (real)b->q[i] * b->q[i];
    n = sqrtq(n);
    for (int i = 0; i < 4; i++) q[i] = b->q[i] / n;
    const real w = q[0], x = q[1], y = q[2], z = q[3];
    const real R[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) b->R[i][j] = R[i][j];
}

static real sgn(real v) { return v < 0 ? -1 : 1; }

/* f, its gradient and Hessian at x, body axes. */
static real left_hand_side(const body *b, const real x[3], real g[3], real H[3][3])
{
    real u[3], term[3], first[3], second[3];
    for (int i = 0; i < 3; i++) {
        u[i] = fabsq(x[i] / b->axis[i]);
        term[i] = powq(u[i], b->p[i]);
        first[i] = b->p[i] * term[i] / u[i] * sgn(x[i]) / b->axis[i];
        second[i] = (real)b->p[i] * (b->p[i] - 1) * term[i] / (u[i] * u[i]) / b->axis[i] / b->axis[i];
        for (int j = 0; j < 3; j++) H[i][j] = 0;
    }
    g[2] = first[2], H[2][2] = second[2];
    if (!b->nested) {
        for (int i = 0; i < 2; i++) g[i] = first[i], H[i][i] = second[i];
        return term[0] + term[1] + term[2];
    }
    const real s = term[0] + term[1], k = (real)b->p[2] / b->p[0], outer = powq(s, k);
    for (int i = 0; i < 2; i++) {
        g[i] = k * outer / s * first[i];
        for (int j = 0; j < 2; j++) H[i][j] = k * (k - 1) * outer / s / s * first[i] * first[j];
        H[i][i] += k * outer / s * second[i];
    }
    return outer + term[2];
}

static real world_left_hand_side(const body *b, const real x[3], real g[3], real H[3][3])
{
    real local[3], lg[3], lH[3][3];
    for (int i = 0; i < 3; i++) local[i] = b->R[0][i] * x[0] + b->R[1][i] * x[1] + b->R[2][i] * x[2];
    const real f = left_hand_side(b, local, lg, lH);
    for (int i = 0; i < 3; i++) {
        g[i] = b->R[i][0] * lg[0] + b->R[i][1] * lg[1] + b->R[i][2] * lg[2];
        for (int j = 0; j < 3; j++) {
            H[i][j] = 0;
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3; l++) H[i][j] += b->R[i][k] * lH[k][l] * b->R[j][l];
        }
    }
    return f;
}

static int solve(int n, real a[8][9], real x[8])
{
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k; i < n; i++)
            if (fabsq(a[i][k]) > fabsq(a[best][k])) best = i;
        if (a[best][k] == 0) return 0;
        for (int j = 0; j <= n; j++) {
            const real t = a[k][j];
            a[k][j] = a[best][j], a[best][j] = t;
        }
        for (int i = k + 1; i < n; i++) {
            const real f = a[i][k] / a[k][k];
            for (int j = k; j <= n; j++) a[i][j] -= f * a[k][j];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        x[k] = a[k][n];
        for (int j = k + 1; j < n; j++) x[k] -= a[k][j] * x[j];
        x[k] /= a[k][k];
    }
    return 1;
}

/* Unknowns: x1, x2 relative to their centres, nu, mu. c: centre 2 minus centre 1. Returns the last step's length. */
static real newton(const body b[2], const real c[3], real z[8], int iterations)
{
    real length = 1;
    for (int it = 0; it < iterations; it++) {
        real g1[3], H1[3][3], g2[3], H2[3][3], a[8][9], step[8];
        const real f1 = world_left_hand_side(&b[0], z, g1, H1), f2 = world_left_hand_side(&b[1], z + 3, g2, H2);
        for (int i = 0; i < 8; i++)
            for (int j = 0; j < 9; j++) a[i][j] = 0;
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                a[i][j] = -z[6] * H1[i][j] - (i == j);
                a[i][3 + j] = i == j;
                a[3 + i][j] = H1[i][j];
                a[3 + i][3 + j] = z[7] * H2[i][j];
            }
            a[i][6] = -g1[i];
            a[i][8] = -(c[i] + z[3 + i] - z[i] - z[6] * g1[i]);
            a[3 + i][7] = g2[i];
            a[3 + i][8] = -(g1[i] + z[7] * g2[i]);
            a[6][i] = g1[i];
            a[7][3 + i] = g2[i];
        }
        a[6][8] = 1 - f1;
        a[7][8] = 1 - f2;
        if (!solve(8, a, step)) return 1;
        length = 0;
        for (int i = 0; i < 8; i++) {
            z[i] += step[i];
            length += fabsq(step[i]);
        }
    }
    return length;
}

static void print(real value)
{
    char text[64];
    quadmath_snprintf(text, sizeof text, "%.20Qg", value);
    printf(",%s", text);
}

static void print_row(const body b[2], const real z[8])
{
    for (int k = 0; k < 2; k++) {
        printf("%s%d", k ? "," : "", b[k].nested ? 3 : 2);
        for (int i = 0; i < 3; i++) printf(",%.17g", b[k].axis[i]);
        for (int i = 0; i < 3; i++) printf(",%.17g", b[k].p[i]);
        for (int i = 0; i < 3; i++) printf(",%.17g", b[k].position[i]);
        for (int i = 0; i < 4; i++) printf(",%.17g", b[k].q[i]);
    }
    real g[3], H[3][3];
    world_left_hand_side(&b[0], z, g, H);
    const real n = sqrtq(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    print(z[6] * n);
    for (int i = 0; i < 3; i++) print(-g[i] / n);
    for (int i = 0; i < 6; i++) print(z[i]);
    printf("\n");
}

static void random_body(body *b, double low, double high)
{
    b->nested = uniform() < 0.3;
    for (int i = 0; i < 3; i++) b->axis[i] = 0.3 + uniform();
    for (int i = 0; i < 3; i++) b->p[i] = low + (high - low) * uniform();
    if (b->nested) b->p[1] = b->p[0];
    for (int i = 0; i < 4; i++) b->q[i] = 2 * uniform() - 1;
    rotation(b);
}

/* A surface point of body b, z, with the outward normal g: the ray in a random direction. */
static void surface_point(const body *b, real x[3])
{
    real H[3][3], g[3], low = 0, high = 4, d[3];
    for (int i = 0; i < 3; i++) d[i] = 2 * uniform() - 1;
    for (int k = 0; k < 130; k++) {
        const real middle = (low + high) / 2;
        for (int i = 0; i < 3; i++) x[i] = middle * d[i];
        if (world_left_hand_side(b, x, g, H) < 1)
            low = middle;
        else
            high = middle;
    }
}

/* The point of body b whose outward normal is along -g: ascent by Newton from a few starts. */
static int opposing_point(const body *b, const real g[3], real x[3], real *mu)
{
    for (int attempt = 0; attempt < 60; attempt++) {
        surface_point(b, x);
        real gb[3], H[3][3], step[8], a[8][9]; /* four rows used, the fifth column the right-hand side */
        world_left_hand_side(b, x, gb, H);
        real gg = 0, gn = 0;
        for (int i = 0; i < 3; i++) gg += gb[i] * g[i], gn += gb[i] * gb[i];
        if (gg > 0) continue;
        *mu = -gg / gn;
        real length = 1;
        for (int it = 0; it < 60 && length > 1e-30Q; it++) {
            const real f = world_left_hand_side(b, x, gb, H);
            for (int i = 0; i < 3; i++) {
                for (int j = 0; j < 3; j++) a[i][j] = *mu * H[i][j];
                a[i][3] = gb[i];
                a[3][i] = gb[i];
                a[i][4] = -(g[i] + *mu * gb[i]);
            }
            a[3][3] = 0;
            a[3][4] = 1 - f;
            if (!solve(4, a, step)) break;
            length = 0;
            for (int i = 0; i < 3; i++) length += fabsq(step[i]);
            const real scale = length > 0.2Q ? 0.2Q / length : 1;
            for (int i = 0; i < 3; i++) x[i] += scale * step[i];
            *mu += scale * step[3];
        }
        if (length <= 1e-30Q && *mu > 0) return 1;
    }
    return 0;
}

static int one(double exponent_low, double exponent_high, double gap, double carry)
{
    body b[2];
    real z[8], g[3], H[3][3], c[3], from[3];
    random_body(&b[0], exponent_low, exponent_high);
    random_body(&b[1], exponent_low, exponent_high);
    surface_point(&b[0], z);
    world_left_hand_side(&b[0], z, g, H);
    if (!opposing_point(&b[1], g, z + 3, &z[7])) return 0;
    const real n = sqrtq(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    z[6] = gap / n;
    for (int i = 0; i < 3; i++) {
        from[i] = z[i] - z[3 + i] + z[6] * g[i];
        b[0].position[i] = 2 * uniform() - 1;
        b[1].position[i] = (double)(b[0].position[i] + from[i] + carry * (2 * uniform() - 1));
    }
    for (int step = 1; step <= 40; step++) {
        for (int i = 0; i < 3; i++) {
            const real to = (real)b[1].position[i] - b[0].position[i];
            c[i] = from[i] + (to - from[i]) * step / 40;
        }
        if (!(newton(b, c, z, 6) < 1e-3Q)) return 0;
    }
    if (!(newton(b, c, z, 6) < 1e-28Q) || !(z[7] > 0)) return 0;
    print_row(b, z);
    return 1;
}

int main(void)
{
    for (int i = 0; i < 120;) i += one(1.6, 6, 0.3, 0.3);
    for (int i = 0; i < 40;) i += one(2, 12, 1e-3, 2e-4);
    for (int i = 0; i < 40;) i += one(2, 4, -1e-4, 2e-5);
    return 0;
}
