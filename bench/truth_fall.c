/* SPDX-License-Identifier: MIT */
#include "truth_fall.h"

#include <math.h>
#include <quadmath.h>
#include <quat/rotation.h>
#include "collide_oracle.h"
#include "tumble_oracle.h"

typedef __float128 real;

static const double samples = 50;      /* a radian */
static const double scan_error = 1e-6; /* of a semi-axis: what the scan may be off by; dips that deep are looked at */
static const int samples_exact = 256;  /* after so many the scan takes up the oracle's state again */

truth_state truth_fall_at(const truth_fall *f, double t)
{
    const real left = (real)t - f->from.t;
    truth_state s = f->from;
    s.t = t;
    s.position.x = (double)(f->from.position.x + f->from.velocity.x * left);
    s.position.y = (double)(f->from.position.y + f->from.velocity.y * left);
    s.position.z = (double)(f->from.position.z + left * (f->from.velocity.z - (real)f->gravity * left / 2));
    s.velocity.z = (double)(f->from.velocity.z - (real)f->gravity * left);
    if (qvec3_norm(f->from.omega) > 0)
        oracle_tumble_omega(f->moments, f->from.orientation, f->from.omega, (double)left, &s.orientation, &s.omega);
    return s;
}

double truth_fall_condition(const truth_fall *f, double t)
{
    const double part = 1e-10;
    truth_fall aside = *f;
    if (!(qvec3_norm(f->from.omega) > 0)) return 0;
    aside.from.omega.x *= 1 + part; /* one component: its direction changes too */
    const truth_state one = truth_fall_at(f, t), other = truth_fall_at(&aside, t);
    return quat_rotation_distance(one.orientation, other.orientation) / part;
}

/* The support function of the direction down, and the lowest point, body axes: for n of all axes and m = n/(n - 1),
 * h(d) = (sum |a d|^m)^(1/m), x = a sign(d) (|a d|/h)^(m - 1). */
static real depth_of(const truth_fall *f, quat q, real low[3])
{
    const real w = q.w, x = q.x, y = q.y, z = q.z, size = w * w + x * x + y * y + z * z,
               m = (real)f->exponent / ((real)f->exponent - 1);
    const real down[3] = {-2 * (x * z - w * y) / size, -2 * (y * z + w * x) / size,
                          -(w * w - x * x - y * y + z * z) / size};
    real sum = 0;
    for (int i = 0; i < 3; i++) sum += powq(f->axis[i] * fabsq(down[i]), m);
    const real h = powq(sum, 1 / m);
    for (int i = 0; low && i < 3; i++)
        low[i] = copysignq(f->axis[i] * powq(f->axis[i] * fabsq(down[i]) / h, m - 1), down[i]);
    return h;
}

/* For the scan, in double where that is plain. */
static double height(const truth_fall *f, const truth_state *s)
{
    if (f->exponent == 2) {
        const qvec3 n = quat_rotate_inverse(s->orientation, (qvec3){0, 0, 1});
        return s->position.z - sqrt(pow(f->axis[0] * n.x, 2) + pow(f->axis[1] * n.y, 2) + pow(f->axis[2] * n.z, 2));
    }
    return (double)(s->position.z - depth_of(f, s->orientation, NULL));
}

static double height_at(const truth_fall *f, double t)
{
    const truth_state s = truth_fall_at(f, t);
    return (double)(s.position.z - depth_of(f, s.orientation, NULL));
}

/* ---- the scan: from sample to sample by Runge and Kutta ---- */

static void rates(const truth_fall *f, const double y[7], double rate[7])
{
    const qvec3 w = {y[4], y[5], y[6]}, I = f->moments;
    const quat dq = quat_derivative_body((quat){y[0], y[1], y[2], y[3]}, w);
    rate[0] = dq.w, rate[1] = dq.x, rate[2] = dq.y, rate[3] = dq.z;
    rate[4] = (I.y - I.z) * w.y * w.z / I.x;
    rate[5] = (I.z - I.x) * w.z * w.x / I.y;
    rate[6] = (I.x - I.y) * w.x * w.y / I.z;
}

static void turn_on(const truth_fall *f, truth_state *s, double h)
{
    static const double at[4] = {0, .5, .5, 1}, weight[4] = {1 / 6., 1 / 3., 1 / 3., 1 / 6.};
    const double y[7] = {s->orientation.w, s->orientation.x, s->orientation.y, s->orientation.z,
                         s->omega.x,       s->omega.y,       s->omega.z};
    double k[7] = {0}, sum[7] = {0}, stage[7];
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 7; j++) stage[j] = y[j] + at[i] * h * k[j];
        rates(f, stage, k);
        for (int j = 0; j < 7; j++) sum[j] += weight[i] * k[j];
    }
    s->orientation = (quat){y[0] + h * sum[0], y[1] + h * sum[1], y[2] + h * sum[2], y[3] + h * sum[3]};
    s->omega = (qvec3){y[4] + h * sum[4], y[5] + h * sum[5], y[6] + h * sum[6]};
}

/* The flight that begins at its state at t: what is near to t costs no long way. */
static truth_fall begun_at(const truth_fall *f, double t)
{
    truth_fall near = *f;
    near.from = truth_fall_at(f, t);
    return near;
}

/* The state of the scan's sample k, h apart; `base`, the flight from the last exact one, goes along. */
static truth_state sample(const truth_fall *f, double begin, double h, long k, const truth_state *before,
                          truth_fall *base)
{
    const double t = begin + (double)k * h, left = t - f->from.t;
    truth_state s = *before;
    if (k % samples_exact == 0) {
        *base = begun_at(base, t);
        s = base->from;
    } else {
        turn_on(f, &s, h);
    }
    s.t = t;
    s.position.z = f->from.position.z + left * (f->from.velocity.z - f->gravity * left / 2);
    return s;
}

/* A root between low, where the height is positive, and high, where it is not: the last double before it. */
static double bisect(const truth_fall *f, double low, double high)
{
    for (int i = 0; i < 80; i++) {
        const double middle = low + (high - low) / 2;
        if (middle <= low || middle >= high) break;
        if (height_at(f, middle) > 0)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The least height in low ... high, which has one minimum, by thirds. */
static double lowest(const truth_fall *f, double low, double high)
{
    for (int i = 0; i < 60; i++) {
        const double third = (high - low) / 3;
        if (height_at(f, low + third) < height_at(f, high - third))
            high -= third;
        else
            low += third;
    }
    return low + (high - low) / 2;
}

/* From `begin` to `end`, in which the body may touch the floor; leaving: it does at the begin. */
static bool contact_within(const truth_fall *f, double begin, double end, bool leaving, double *t)
{
    const double rate = qvec3_norm(f->from.omega);
    double h = fmin(1 / (samples * rate), (end - begin) / 4000);
    while (leaving && height_at(f, begin + h) <= 0 && h > 1e-9 * end) h /= 2;
    truth_fall base = begun_at(f, begin);
    truth_state s = base.from;
    double old = INFINITY, now = leaving ? INFINITY : height(f, &s);
    for (long k = 1; begin + (double)(k - 1) * h < end; k++) {
        s = sample(f, begin, h, k, &s, &base);
        const double next = height(f, &s), before = begin + (double)(k - 2) * h;
        if (next <= 0 && !isfinite(now)) return false; /* it came back before it had left */
        if (next <= 0) {
            const truth_fall near = begun_at(f, before + h);
            return *t = bisect(&near, before + h, s.t), *t <= end;
        }
        const double bend = old - 2 * now + next, dip = bend > 0 ? now - (old - next) * (old - next) / (8 * bend) : now;
        if (isfinite(old) && now < old && now <= next && dip < scan_error * f->axis[0]) {
            const truth_fall near = begun_at(f, before);
            const double low = lowest(&near, before, s.t);
            if (height_at(&near, low) <= 0) return *t = bisect(&near, before, low), *t <= end;
        }
        old = now, now = next;
    }
    return false;
}

/* The centre is higher than the farthest point reaches from one time to another, if at all: nothing touches then. */
static bool first_contact(const truth_fall *f, double until, double *t)
{
    const double *a = f->axis, v = f->from.velocity.z, g = f->gravity, from = f->from.t;
    const double far = f->exponent == 2 ? fmax(a[0], fmax(a[1], a[2])) : sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    const double up = f->from.position.z - far, square = v * v + 2 * g * up;
    const double back = square > 0 ? from + (v + sqrt(square)) / g : from;
    if (up > 0) return contact_within(f, fmin(back, until), until, false, t);
    if (!(v > 0 && square > 0)) return contact_within(f, from, until, true, t);
    const double away = from + (v - sqrt(square)) / g;
    if (contact_within(f, from, fmin(away, until), true, t)) return true;
    return back < until && contact_within(f, back, until, false, t);
}

/* ---- an impact ---- */

/* Without friction: P = -(1 + e) u_n/(1/m + (r x n).J^-1 (r x n)). */
static void slip_off(const truth_fall *f, truth_state *s, qvec3 low)
{
    const qvec3 n = quat_rotate_inverse(s->orientation, (qvec3){0, 0, 1}), arm = qvec3_cross(low, n), I = f->moments;
    const qvec3 turned = {arm.x / I.x, arm.y / I.y, arm.z / I.z};
    const double u = s->velocity.z + qvec3_dot(s->omega, arm);
    const double P = -(1 + f->restitution) * u / (1 / f->mass + qvec3_dot(arm, turned));
    s->velocity.z += P / f->mass;
    s->omega = qvec3_axpy(P, turned, s->omega);
}

static bool strike(const truth_fall *f, truth_state *s)
{
    real low[3];
    depth_of(f, s->orientation, low);
    const qvec3 point = {(double)low[0], (double)low[1], (double)low[2]};
    if (f->friction == 0) return slip_off(f, s, point), true;
    impact_collision c = {.normal = {0, 0, 1}, .friction = f->friction, .restitution = f->restitution, .law = f->law};
    oracle_outcome out;
    c.body[0] = (impact_collider){.mass = f->mass,
                                  .moments = f->moments,
                                  .orientation = s->orientation,
                                  .offset = quat_rotate(s->orientation, point),
                                  .velocity = s->velocity,
                                  .omega = quat_rotate(s->orientation, s->omega)};
    c.body[1] = (impact_collider){.mass = INFINITY, .moments = {1, 1, 1}, .orientation = {1, 0, 0, 0}};
    if (!oracle_collide(&c, &out)) return false;
    s->velocity = out.velocity[0];
    s->omega = quat_rotate_inverse(s->orientation, out.omega[0]);
    return true;
}

bool truth_fall_next(truth_fall *f, double until)
{
    double t;
    if (!first_contact(f, until, &t)) return false;
    truth_state s = truth_fall_at(f, t);
    if (!strike(f, &s)) return false;
    f->from = s;
    return true;
}
