/* SPDX-License-Identifier: MIT
 *
 * Inverses, axes, and the offsets in local axes. The moment of an impulse about a slim body's axis comes from the small
 * components of the offset across that axis: rounding of the large one must not spill into them, so they are taken in
 * doubled precision (Dekker 1971).
 */
#include "collide/collide_ready.h"

#include "base/tolerances.h"

typedef struct doubled {
    imp_lanes high, low; /* their sum is meant */
} doubled;

typedef struct halves {
    imp_lanes whole, high, low;
} halves;

static inline halves halve(imp_lanes a)
{
    const imp_lanes t = IMP_SPLITTER * a, high = t - (t - a);
    return (halves){a, high, a - high};
}

static inline doubled product(halves a, halves b)
{
    const imp_lanes p = a.whole * b.whole;
    return (doubled){p, (((a.high * b.high - p) + a.high * b.low) + a.low * b.high) + a.low * b.low};
}

static inline doubled sum(doubled a, doubled b)
{
    const imp_lanes s = a.high + b.high, t = s - a.high;
    return (doubled){s, ((a.high - (s - t)) + (b.high - t)) + (a.low + b.low)};
}

static inline doubled difference(doubled a, doubled b) { return sum(a, (doubled){-b.high, -b.low}); }
static inline doubled twice(doubled a) { return (doubled){2 * a.high, 2 * a.low}; }

/* x . v for an axis x in doubled precision. */
static inline imp_lanes along(doubled x, doubled y, doubled z, const halves v[3])
{
    const doubled px = product(halve(x.high), v[0]), py = product(halve(y.high), v[1]),
                  pz = product(halve(z.high), v[2]);
    const doubled s = sum(sum(px, py), pz);
    return s.high + (s.low + (x.low * v[0].whole + y.low * v[1].whole + z.low * v[2].whole));
}

typedef struct quats {
    imp_lanes w, x, y, z;
} quats;

/* The offsets along the principal axes, times |q|^2. */
static imp_vectors slim_offset(const quats *q, const imp_vectors *r)
{
    const halves w = halve(q->w), x = halve(q->x), y = halve(q->y), z = halve(q->z);
    const halves v[3] = {halve(r->x), halve(r->y), halve(r->z)};
    const doubled ww = product(w, w), xx = product(x, x), yy = product(y, y), zz = product(z, z);
    const doubled xy = product(x, y), xz = product(x, z), yz = product(y, z);
    const doubled wx = product(w, x), wy = product(w, y), wz = product(w, z);
    const doubled wz_less = difference(ww, zz), xy_less = difference(xx, yy);
    const doubled z_z = difference(sum(ww, zz), sum(xx, yy));
    return (imp_vectors){along(sum(wz_less, xy_less), twice(sum(xy, wz)), twice(difference(xz, wy)), v),
                         along(twice(difference(xy, wz)), difference(wz_less, xy_less), twice(sum(yz, wx)), v),
                         along(twice(sum(xz, wy)), twice(difference(yz, wx)), z_z, v)};
}

/* The homogeneous form: a quaternion off unit length scales the axes, which is put right by one factor; it
 * is returned. */
static imp_lanes make_axes(const quats *q, imp_vectors axis[3])
{
    const imp_lanes ww = q->w * q->w, xx = q->x * q->x, yy = q->y * q->y, zz = q->z * q->z;
    const imp_lanes f = 1 / (ww + xx + yy + zz), g = 2 * f;
    const imp_lanes xy = q->x * q->y, xz = q->x * q->z, yz = q->y * q->z;
    const imp_lanes wx = q->w * q->x, wy = q->w * q->y, wz = q->w * q->z;
    axis[0] = (imp_vectors){((ww - zz) + (xx - yy)) * f, (xy + wz) * g, (xz - wy) * g};
    axis[1] = (imp_vectors){(xy - wz) * g, ((ww - zz) - (xx - yy)) * f, (yz + wx) * g};
    axis[2] = (imp_vectors){(xz + wy) * g, (yz - wx) * g, ((ww + zz) - (xx + yy)) * f};
    return f;
}

/* In the lanes of slim bodies, the offset again with small components as good as the large one. */
static void refine_offset(const quats *q, imp_lanes f, const imp_vectors *r, imp_mask lanes, imp_vectors *offset)
{
    const imp_vectors fine = slim_offset(q, r);
    const imp_lanes x = fine.x * f, y = fine.y * f, z = fine.z * f;
    /* Where doubling overflows, as it was. */
    lanes &= (x + y + z) - (x + y + z) == 0;
    offset->x = imp_lanes_pick(lanes, x, offset->x);
    offset->y = imp_lanes_pick(lanes, y, offset->y);
    offset->z = imp_lanes_pick(lanes, z, offset->z);
}

void imp_ready_make(const impact_collision *collision, imp_ready *ready)
{
    const impact_collider *one = &collision->body[0], *two = &collision->body[1];
    const imp_lanes mass = {one->mass, two->mass}, zero = {0, 0}, unit = {1, 1};
    const imp_mask moves = mass < (imp_real)INFINITY;
    ready->mass = imp_lanes_where(moves, mass);
    ready->inverse_mass = 1 / mass;
    const imp_vectors j = imp_vectors_of(imp_vec_of(one->moments), imp_vec_of(two->moments));
    ready->moments =
        (imp_vectors){imp_lanes_where(moves, j.x), imp_lanes_where(moves, j.y), imp_lanes_where(moves, j.z)};
    ready->inverse_moments = (imp_vectors){imp_lanes_where(moves, 1 / imp_lanes_pick(moves, j.x, unit)),
                                           imp_lanes_where(moves, 1 / imp_lanes_pick(moves, j.y, unit)),
                                           imp_lanes_where(moves, 1 / imp_lanes_pick(moves, j.z, unit))};
    ready->velocity = imp_vectors_of(imp_vec_of(one->velocity), imp_vec_of(two->velocity));
    ready->omega = imp_vectors_of(imp_vec_of(one->omega), imp_vec_of(two->omega));
    ready->arm = imp_vectors_of(imp_vec_of(one->offset), imp_vec_of(two->offset));
    const imp_vectors r = {imp_lanes_where(moves, ready->arm.x), imp_lanes_where(moves, ready->arm.y),
                           imp_lanes_where(moves, ready->arm.z)};
    const imp_mask turned = moves & ~((j.x == j.y) & (j.y == j.z));
    ready->offset = r;
    ready->round = !imp_mask_any(turned);
    if (ready->round) {
        ready->axis[0] = (imp_vectors){unit, zero, zero};
        ready->axis[1] = (imp_vectors){zero, unit, zero};
        ready->axis[2] = (imp_vectors){zero, zero, unit};
        return;
    }
    const quat p = one->orientation, s = two->orientation;
    const quats q = {imp_lanes_pick(turned, (imp_lanes){p.w, s.w}, unit),
                     imp_lanes_where(turned, (imp_lanes){p.x, s.x}), imp_lanes_where(turned, (imp_lanes){p.y, s.y}),
                     imp_lanes_where(turned, (imp_lanes){p.z, s.z})};
    const imp_lanes f = make_axes(&q, ready->axis);
    ready->offset = imp_ready_local(ready, &r);
    const imp_lanes least = imp_lanes_smaller(imp_lanes_smaller(j.x, j.y), j.z);
    const imp_lanes most = imp_lanes_larger(imp_lanes_larger(j.x, j.y), j.z);
    const imp_mask lanes = turned & (most > IMP_COLLIDE_SLIM * least);
    if (imp_mask_any(lanes)) refine_offset(&q, f, &r, lanes, &ready->offset);
}
