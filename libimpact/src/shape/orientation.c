/* SPDX-License-Identifier: MIT
 *
 * On which side of a plane a point is (Shewchuk 1997): the determinant
 *
 *     (b - a) x (c - a) . (d - a) = |bcd| - |acd| + |abd| - |abc|
 *
 * in doubles where its error bound leaves the sign, else by its 24 products, each a sum of four doubles that overlap in
 * no bit, added without rounding.
 */
#include "base/tolerances.h"
#include "shape/core.h"
#include <math.h>

typedef struct expansion {
    int count;
    double part[96]; /* of growing size, overlapping in no bit; their sum is exact */
} expansion;

/* Knuth: sum + error = a + b. */
static double two_sum(double a, double b, double *error)
{
    const double sum = a + b, virtual_b = sum - a, virtual_a = sum - virtual_b;
    *error = (a - virtual_a) + (b - virtual_b);
    return sum;
}

static double two_product(double a, double b, double *error)
{
    const double product = a * b;
    *error = fma(a, b, -product);
    return product;
}

static void grow(expansion *e, double b)
{
    int count = 0;
    for (int i = 0; i < e->count; i++) {
        double error;
        b = two_sum(b, e->part[i], &error);
        if (error != 0) e->part[count++] = error;
    }
    if (b != 0) e->part[count++] = b;
    e->count = count;
}

static void add_product(expansion *e, double x, double y, double z)
{
    double low, error;
    const double high = two_product(x, y, &low);
    const double lower = two_product(low, z, &error);
    grow(e, error), grow(e, lower);
    const double upper = two_product(high, z, &error);
    grow(e, error), grow(e, upper);
}

/* sign |pqr| */
static void add_determinant(expansion *e, double sign, const double p[3], const double q[3], const double r[3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        add_product(e, sign * p[i], q[j], r[k]);
        add_product(e, -sign * p[i], q[k], r[j]);
    }
}

static int exactly(const double a[3], const double b[3], const double c[3], const double d[3])
{
    expansion e = {0};
    add_determinant(&e, 1, b, c, d);
    add_determinant(&e, -1, a, c, d);
    add_determinant(&e, 1, a, b, d);
    add_determinant(&e, -1, a, b, c);
    return e.count == 0 ? 0 : e.part[e.count - 1] > 0 ? 1 : -1;
}

int imp_orientation(const double a[3], const double b[3], const double c[3], const double d[3])
{
    double sum = 0, size = 0, p[3], q[3], r[3];
    for (int i = 0; i < 3; i++) p[i] = b[i] - a[i], q[i] = c[i] - a[i], r[i] = d[i] - a[i];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        sum += (p[j] * q[k] - p[k] * q[j]) * r[i];
        size += (fabs(p[j] * q[k]) + fabs(p[k] * q[j])) * fabs(r[i]);
    }
    if (fabs(sum) > IMP_ORIENTATION_BOUND * size) return sum > 0 ? 1 : -1;
    return exactly(a, b, c, d);
}
