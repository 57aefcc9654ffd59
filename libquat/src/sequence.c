/* SPDX-License-Identifier: MIT */
#include <quat/exponential.h>
#include <quat/sequence.h>
#include "dd.h"

static const double pi = 3.14159265358979323846;

typedef struct circle {
    double cosine, sine;
} circle;

/* cos and sin of `turns` half turns, exact at every quarter; pi in twice the precision: they are rounded once. */
static circle half_turns(double turns)
{
    const double r = remainder(turns, 2), quarter = floor(2 * r + 0.5), rest = r - 0.5 * quarter;
    const quat_dd f = quat_two_prod(pi, rest);
    const double lo = f.lo + 0x1.1a62633145c07p-53 * rest, cosine = cos(f.hi), sine = sin(f.hi);
    const double c = cosine - lo * sine, s = sine + lo * cosine;
    if (isnan(f.hi)) return (circle){f.hi, f.hi};
    switch ((int)quarter & 3) {
    case 0: return (circle){c, s};
    case 1: return (circle){-s, c};
    case 2: return (circle){-c, -s};
    default: return (circle){s, -c};
    }
}

/* ---- the belt ---- */

quat quat_belt_twist(double angle, double t)
{
    const double half = 0.5 * angle * t;
    return quat_make(cos(half), 0, sin(half), 0);
}

/* The product written out: with c, s of pi t and C, D of pi s/2 it is 1 + 2 s C (-s C + c D i + c C j - s D k), so that
 * both ends are exact. Where s C is near 1 the scalar part is better summed as c^2 - s^2 cos(pi s). */
quat quat_belt_untwist(double s, double t)
{
    const circle along = half_turns(t), aside = half_turns(0.5 * s);
    const double m = along.sine * aside.cosine, k = 2 * m;
    const double w =
        m * m < 0.5 ? 1 - k * m : along.cosine * along.cosine - along.sine * along.sine * half_turns(s).cosine;
    return quat_make(w, k * along.cosine * aside.sine, k * along.cosine * aside.cosine, -k * along.sine * aside.sine);
}

/* q y q* is, with a, b = cos, sin of pi s and f = 2 pi t,
 * (ab (cos f - cos^2 f) + b sin^2 f, a^2 + b^2 cos f, -ab (sin f - sin f cos f) + b sin f cos f). */
qvec3 quat_belt_centre(double s, double t)
{
    const circle aside = half_turns(s), turn = half_turns(2 * remainder(t, 1));
    const double a = aside.cosine, b = aside.sine, c = turn.cosine, z = turn.sine, per = 1 / (2 * pi);
    return qvec3_make(0.5 * b * (1 - a) * t + per * b * z * (a - 0.5 * (1 + a) * c), a * a * t + per * b * b * z,
                      per * b * (0.5 * (1 + a) * z * z - a * (1 - c)));
}

void quat_belt_frames(double s, size_t n, quat q[], qvec3 centre[])
{
    for (size_t i = 0; i < n; i++) {
        const double t = n > 1 ? (double)i / (double)(n - 1) : 0;
        if (q) q[i] = quat_belt_untwist(s, t);
        if (centre) centre[i] = quat_belt_centre(s, t);
    }
}

/* ---- spinor discs ---- */

size_t quat_spinor_arrows(double angle, size_t most, double arrows[])
{
    if (!isfinite(angle)) return 0;
    const double size = fabs(angle), count = ceil(size / pi * (1 - 0x1p-51)); /* a multiple of pi may be rounded up */
    for (size_t k = 0; k < most && (double)k < count; k++) {
        const double length = fmin(pi, size - (double)k * pi);
        arrows[k] = copysign(length, k % 4 < 2 ? angle : -angle);
    }
    return (size_t)fmin(count, 0x1p53);
}

double quat_spinor_place(double angle) { return copysign(fabs(remainder(angle, 4 * pi)), angle); }

/* ---- bands ---- */

quat quat_band(double twist, double u)
{
    const circle bend = half_turns(u);
    const double half = 0.5 * twist * u, c = cos(half), s = sin(half);
    return quat_make(bend.cosine * c, -bend.sine * s, bend.cosine * s, bend.sine * c);
}

int quat_loop_sign(size_t n, const quat q[])
{
    int sign = n > 1 && quat_dot(q[0], q[n - 1]) < 0 ? -1 : 1;
    for (size_t i = 1; i < n; i++)
        if (quat_dot(q[i - 1], q[i]) < 0) sign = -sign;
    return sign;
}

/* ---- the ball ---- */

quat quat_roll(quat q, double dx, double dy) { return quat_step_world(q, qvec3_make(-dy, dx, 0), 1); }

void quat_roll_path(quat start, size_t n, const qvec2 hand[], quat out[])
{
    quat q = start;
    for (size_t i = 0; i < n; i++) {
        if (i > 0) q = quat_renormalize(quat_roll(q, hand[i].x - hand[i - 1].x, hand[i].y - hand[i - 1].y));
        out[i] = q;
    }
}

/* In axes that go round with the hand the ball turns at a constant rate. */
quat quat_roll_circle(double radius, double angle)
{
    const double half = 0.5 * angle;
    return quat_mul(quat_exp_pure(qvec3_make(0, 0, half)), quat_exp_pure(qvec3_make(-radius * half, 0, -half)));
}

qvec3 quat_roll_loop(double radius)
{
    /* 2 pi (h - 1)/h with h = sqrt(1 + r^2), and h - 1 = r^2/(h + 1) */
    const double h = hypot(1, radius), part = 2 * pi * (radius / h) * (radius / (h + 1));
    return qvec3_make(-radius * part, 0, -part);
}

/* ---- chains ---- */

static bool can_start(quat start, size_t legs, const qvec3 turns[], quat *unit)
{
    if (quat_normalize(start, unit) != QUAT_OK) return false;
    for (size_t i = 0; i < legs; i++)
        if (!qvec3_isfinite(turns[i])) return false;
    return true;
}

quat_status quat_chain(quat start, size_t legs, const qvec3 turns[], quat_frame frame, size_t parts, quat out[])
{
    quat q;
    const bool known = parts > 0 && (frame == QUAT_WORLD || frame == QUAT_BODY);
    if (!known || !can_start(start, legs, turns, &q)) {
        for (size_t i = 0; i <= legs * parts; i++) out[i] = quat_identity();
        return known ? QUAT_EDOMAIN : QUAT_EARGUMENT;
    }
    out[0] = q;
    for (size_t i = 0; i < legs; i++) {
        for (size_t k = 1; k <= parts; k++) {
            const quat turn = quat_from_rotation_vector(qvec3_scale(turns[i], (double)k / (double)parts));
            out[i * parts + k] = frame == QUAT_WORLD ? quat_mul(turn, q) : quat_mul(q, turn);
        }
        q = quat_renormalize(out[(i + 1) * parts]);
        out[(i + 1) * parts] = q;
    }
    return QUAT_OK;
}
