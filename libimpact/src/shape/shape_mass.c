/* SPDX-License-Identifier: MIT
 *
 * Volume, inertia and bounding ball. Volumes and second moments are Dirichlet integrals; Barr's by layers in z.
 */
#include <impact/shape.h>
#include "base/numbers.h"
#include "base/tolerances.h"
#include "shape/solid.h"

/* Mean of (x/a)^2 over the superquadric, sigma = 1/r + 1/s + 1/t. */
static double mean_square(double r, double sigma)
{
    return tgamma(1 + 3 / r) / tgamma(1 + 1 / r) * (tgamma(1 + sigma) / tgamma(1 + sigma + 2 / r)) / 3;
}

double impact_shape_volume(const impact_shape *shape)
{
    const double box = 8 * shape->a * shape->b * shape->c, r = shape->r, s = shape->s, t = shape->t;
    switch (shape->kind) {
    case IMPACT_SPHERE: return 4.0 / 3.0 * IMP_PI * shape->a * shape->a * shape->a;
    case IMPACT_PLANE: return INFINITY;
    case IMPACT_SUPERQUADRIC:
        if (r == 2 && s == 2 && t == 2) return box * (IMP_PI / 6);
        return box * (tgamma(1 + 1 / r) * tgamma(1 + 1 / s) * tgamma(1 + 1 / t) / tgamma(1 + 1 / r + 1 / s + 1 / t));
    case IMPACT_SUPERELLIPSOID:
        return box * (tgamma(1 + 1 / r) * tgamma(1 + 1 / r) / tgamma(1 + 2 / r)) *
               (tgamma(1 + 1 / t) * tgamma(1 + 2 / t) / tgamma(1 + 3 / t));
    default: return imp_has_core(shape) ? imp_solid_volume(shape) : NAN;
    }
}

/* <(x/a)^2>, <(y/b)^2>, <(z/c)^2>. */
static qvec3 mean_squares(const impact_shape *shape)
{
    const double r = shape->r, s = shape->s, t = shape->t;
    if (shape->kind == IMPACT_SPHERE || (r == 2 && s == 2 && t == 2)) return (qvec3){0.2, 0.2, 0.2};
    if (shape->kind == IMPACT_SUPERQUADRIC) {
        const double sigma = 1 / r + 1 / s + 1 / t;
        return (qvec3){mean_square(r, sigma), mean_square(s, sigma), mean_square(t, sigma)};
    }
    const double across = tgamma(1 + 3 / r) * tgamma(1 + 2 / r) / (tgamma(1 + 1 / r) * tgamma(1 + 4 / r)) *
                          (tgamma(1 + 4 / t) * tgamma(1 + 3 / t) / (tgamma(1 + 5 / t) * tgamma(1 + 2 / t))) / 3;
    const double along = tgamma(1 + 3 / t) * tgamma(1 + 3 / t) / (tgamma(1 + 5 / t) * tgamma(1 + 1 / t)) / 3;
    return (qvec3){across, across, along};
}

qvec3 impact_shape_inertia(const impact_shape *shape)
{
    if (shape->kind == IMPACT_PLANE) return (qvec3){INFINITY, INFINITY, INFINITY};
    if (imp_has_core(shape)) return imp_solid_inertia(shape);
    const qvec3 mean = mean_squares(shape);
    const double x2 = mean.x * shape->a * shape->a, y2 = mean.y * shape->b * shape->b,
                 z2 = mean.z * shape->c * shape->c;
    return (qvec3){y2 + z2, z2 + x2, x2 + y2};
}

/* ---- the smallest ball: max of sum A_i^2 m_i^(2/p_i) over masses m_i >= 0 of sum 1 ----
 * Terms with p <= 2 are convex, so at most one of them has mass; terms with p > 2 are concave. */

typedef struct terms {
    int count;
    double square[3], power[3]; /* A_i^2 and 2/p_i < 1 */
} terms;

/* Mass the concave terms take at the common slope exp(log_slope). */
static double mass_at(const terms *t, double log_slope)
{
    double mass = 0;
    for (int i = 0; i < t->count; i++) mass += exp((log(t->square[i] * t->power[i]) - log_slope) / (1 - t->power[i]));
    return mass;
}

/* log of the slope at which the concave terms take the given mass in (0, 1]. */
static double log_slope_of(const terms *t, double mass)
{
    double low = -INFINITY, high = -INFINITY; /* one term alone takes the mass; count terms share it */
    for (int i = 0; i < t->count; i++) {
        const double c = log(t->square[i] * t->power[i]);
        low = fmax(low, c - (1 - t->power[i]) * log(mass));
        high = fmax(high, c - (1 - t->power[i]) * log(mass / t->count));
    }
    double middle = 0.5 * (low + high);
    for (int k = 0; k < 200 && middle > low && middle < high; k++, middle = 0.5 * (low + high)) {
        if (mass_at(t, middle) > mass)
            low = middle;
        else
            high = middle;
    }
    return middle;
}

/* Largest value the concave terms reach with the given mass. */
static double concave_best(const terms *t, double mass)
{
    if (t->count == 0 || mass <= 0) return 0;
    const double slope = log_slope_of(t, mass), total = mass_at(t, slope);
    double value = 0;
    for (int i = 0; i < t->count; i++) {
        const double share = exp((log(t->square[i] * t->power[i]) - slope) / (1 - t->power[i])) * (mass / total);
        value += t->square[i] * pow(share, t->power[i]);
    }
    return value;
}

/* Slope of the sum when one convex term (square, power in [1, 2]) holds w and the concave ones 1 - w: concave in w. */
static double slope_at(const terms *t, double square, double power, double w)
{
    return square * power * pow(w, power - 1) - exp(log_slope_of(t, 1 - w));
}

/* The best with that convex term: its slope is concave, so the interior maximum is the slope's last zero. */
static double best_with(const terms *t, double square, double power)
{
    double low = 0, high = 1;
    for (int k = 0; k < 100; k++) { /* where the slope is largest */
        const double a = low + (high - low) * 0.381966011250105, b = low + (high - low) * 0.618033988749895;
        if (slope_at(t, square, power, a) < slope_at(t, square, power, b))
            low = a;
        else
            high = b;
    }
    if (!(slope_at(t, square, power, low) > 0)) return 0;
    high = 1;
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        if (middle >= 1 || slope_at(t, square, power, middle) < 0)
            high = middle;
        else
            low = middle;
    }
    return square * pow(low, power) + concave_best(t, 1 - low);
}

/* Greatest length in scaled axes (the largest 1) of sum |x_i/A_i|^p_i <= 1. */
static double farthest(int n, const double axis[3], const double exponent[3])
{
    terms concave = {0};
    double square[3], power[3], best = 0;
    int convex = 0;
    for (int i = 0; i < n; i++) {
        best = fmax(best, axis[i] * axis[i]);
        if (exponent[i] > 2) {
            concave.square[concave.count] = axis[i] * axis[i];
            concave.power[concave.count++] = 2 / exponent[i];
        } else {
            square[convex] = axis[i] * axis[i];
            power[convex++] = 2 / exponent[i];
        }
    }
    if (concave.count > 0) {
        best = fmax(best, concave_best(&concave, 1));
        for (int i = 0; i < convex; i++) best = fmax(best, best_with(&concave, square[i], power[i]));
    }
    return sqrt(best);
}

double impact_shape_bounding_radius(const impact_shape *shape)
{
    if (shape->kind == IMPACT_PLANE) return INFINITY;
    if (shape->kind == IMPACT_SPHERE) return shape->a;
    if (imp_has_core(shape)) return imp_solid_radius(shape);
    const double scale = fmax(shape->a, fmax(shape->b, shape->c));
    const double axis[3] = {shape->a / scale, shape->b / scale, shape->c / scale};
    const double exponent[3] = {shape->r, shape->s, shape->t};
    if (shape->kind == IMPACT_SUPERQUADRIC) return scale * farthest(3, axis, exponent);
    /* The section's farthest point, then the profile through it. */
    const double profile[3] = {farthest(2, axis, exponent), axis[2]}, along[3] = {shape->t, shape->t};
    return scale * farthest(2, profile, along);
}
