/* SPDX-License-Identifier: MIT
 *
 * Prints the coefficients of libquat/src/slerp_kernel.h: the polynomial of degree 11 in x that equals atan(sqrt x)/sqrt
 * x at the Chebyshev nodes of 0 <= x <= tan^2(pi/8), and its largest relative error with the coefficients rounded to
 * double. cc -O2 atan_coefficients.c -lm && ./a.out
 */
#define __STDC_WANT_IEC_60559_TYPES_EXT__ 1
#include <math.h>
#include <stdio.h>

enum { N = 12 };
__extension__ typedef _Float128 wide;

static wide f(wide x) { return x == 0 ? 1 : atanf128(sqrtf128(x)) / sqrtf128(x); }

int main(void)
{
    /* 1 % beyond, so that quaternions that are unit but for rounding stay inside */
    const wide pi = 4 * atanf128(1), t = tanf128(pi / 8), end = t * t * (wide)1.01;
    wide a[N][N + 1];
    for (int i = 0; i < N; i++) {
        const wide x = end / 2 * (1 - cosf128(pi * (2 * i + 1) / (2 * N)));
        wide power = 1;
        for (int j = 0; j < N; j++, power *= x / end) a[i][j] = power; /* in x/end: well scaled */
        a[i][N] = f(x);
    }
    for (int k = 0; k < N; k++) {
        int p = k;
        for (int i = k + 1; i < N; i++)
            if (fabsf128(a[i][k]) > fabsf128(a[p][k])) p = i;
        for (int j = 0; j <= N; j++) {
            const wide s = a[k][j];
            a[k][j] = a[p][j];
            a[p][j] = s;
        }
        for (int i = 0; i < N; i++) {
            if (i == k) continue;
            const wide m = a[i][k] / a[k][k];
            for (int j = k; j <= N; j++) a[i][j] -= m * a[k][j];
        }
    }
    double c[N];
    wide scale = 1, worst = 0;
    for (int k = 0; k < N; k++, scale *= end) {
        c[k] = (double)(a[k][N] / a[k][k] / scale);
        printf("%a,\n", c[k]);
    }
    for (int i = 0; i <= 100000; i++) {
        const wide x = end * i / 100000;
        wide sum = 0;
        for (int k = N - 1; k >= 0; k--) sum = sum * x + c[k];
        worst = fmaxf128(worst, fabsf128(sum / f(x) - 1));
    }
    printf("largest relative error %g\n", (double)worst);
    return 0;
}
