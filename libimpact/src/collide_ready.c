/* SPDX-License-Identifier: MIT
 *
 * Inverses, axes, and the offset in local axes. The moment of an impulse about a slim body's axis comes from the small components of
 * the offset across that axis: rounding of the large one must not spill into them, so they are taken in doubled precision
 * (Dekker 1971).
 */
#include "collide_ready.h"

/* Largest over smallest moment from which a body is slim. */
static const double slim = 8;

typedef struct pair {
    double high, low; /* their sum is meant */
} pair;

typedef struct halves {
    double whole, high, low;
} halves;

static inline halves halve(double a)
{
    const double t = 134217729 * a, high = t - (t - a);
    return (halves){a, high, a - high};
}

static inline pair product(halves a, halves b)
{
    const double p = a.whole * b.whole;
    return (pair){p, (((a.high * b.high - p) + a.high * b.low) + a.low * b.high) + a.low * b.low};
}

static inline pair sum(pair a, pair b)
{
    const double s = a.high + b.high, t = s - a.high;
    return (pair){s, ((a.high - (s - t)) + (b.high - t)) + (a.low + b.low)};
}

static inline pair difference(pair a, pair b) { return sum(a, (pair){-b.high, -b.low}); }
static inline pair twice(pair a) { return (pair){2 * a.high, 2 * a.low}; }

/* x . v for an axis x in doubled precision. */
static double along(pair x, pair y, pair z, const halves v[3])
{
    const pair px = product(halve(x.high), v[0]), py = product(halve(y.high), v[1]), pz = product(halve(z.high), v[2]);
    const pair s = sum(sum(px, py), pz);
    return s.high + (s.low + (x.low * v[0].whole + y.low * v[1].whole + z.low * v[2].whole));
}

/* The offset along the principal axes, times |q|^2. */
static qvec3 slim_offset(quat given, qvec3 r)
{
    const halves w = halve(given.w), x = halve(given.x), y = halve(given.y), z = halve(given.z);
    const halves v[3] = {halve(r.x), halve(r.y), halve(r.z)};
    const pair ww = product(w, w), xx = product(x, x), yy = product(y, y), zz = product(z, z);
    const pair xy = product(x, y), xz = product(x, z), yz = product(y, z);
    const pair wx = product(w, x), wy = product(w, y), wz = product(w, z);
    const pair wz_less = difference(ww, zz), xy_less = difference(xx, yy);
    const pair z_z = difference(sum(ww, zz), sum(xx, yy));
    return (qvec3){along(sum(wz_less, xy_less), twice(sum(xy, wz)), twice(difference(xz, wy)), v),
                   along(twice(difference(xy, wz)), difference(wz_less, xy_less), twice(sum(yz, wx)), v),
                   along(twice(sum(xz, wy)), twice(difference(yz, wx)), z_z, v)};
}

void impact_ready_make(const impact_collider *body, impact_ready *ready)
{
    ready->offset = body->offset;
    ready->round = true;
    ready->axis[0] = (qvec3){1, 0, 0};
    ready->axis[1] = (qvec3){0, 1, 0};
    ready->axis[2] = (qvec3){0, 0, 1};
    if (isinf(body->mass)) {
        ready->inverse_mass = 0;
        ready->inverse_moments = (qvec3){0, 0, 0};
        return;
    }
    const qvec3 j = body->moments;
    ready->inverse_mass = 1 / body->mass;
    if (j.x == j.y && j.y == j.z) {
        const double inverse = 1 / j.x;
        ready->inverse_moments = (qvec3){inverse, inverse, inverse};
        return;
    }
    ready->round = false;
    ready->inverse_moments = (qvec3){1 / j.x, 1 / j.y, 1 / j.z};
    /* The homogeneous form: a quaternion off unit length scales the axes, which is put right by one factor. */
    const quat q = body->orientation;
    const double ww = q.w * q.w, xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, f = 1 / (ww + xx + yy + zz), g = 2 * f;
    const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z, wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    ready->axis[0] = (qvec3){((ww - zz) + (xx - yy)) * f, (xy + wz) * g, (xz - wy) * g};
    ready->axis[1] = (qvec3){(xy - wz) * g, ((ww - zz) - (xx - yy)) * f, (yz + wx) * g};
    ready->axis[2] = (qvec3){(xz + wy) * g, (yz - wx) * g, ((ww + zz) - (xx + yy)) * f};
    const double least = impact_smaller(impact_smaller(j.x, j.y), j.z),
                 most = impact_larger(impact_larger(j.x, j.y), j.z);
    if (most > slim * least) {
        const qvec3 fine = qvec3_scale(slim_offset(q, body->offset), f);
        /* Beyond 1e300 doubling overflows. */
        if (isfinite(fine.x + fine.y + fine.z)) {
            ready->offset = fine;
            return;
        }
    }
    ready->offset = impact_ready_local(ready, body->offset);
}
