/* SPDX-License-Identifier: MIT */
#include <quat/euler.h>
#include "scale.h"

/* The axes of a sequence, in the order of its letters. */
typedef struct axes {
    int first, middle, third;
    bool extrinsic;
} axes;

static bool decode(quat_euler sequence, axes *a)
{
    const unsigned code = (unsigned)sequence;
    *a = (axes){(int)(code >> 4 & 3), (int)(code >> 2 & 3), (int)(code & 3), (code & 0x40) != 0};
    return code < 0x80 && a->first < 3 && a->middle < 3 && a->third < 3 && a->first != a->middle &&
           a->middle != a->third;
}

quat_status quat_euler_from_name(const char *name, quat_euler *sequence)
{
    *sequence = QUAT_EULER_XYZ;
    if (!name) return QUAT_EARGUMENT;
    unsigned code = 0;
    const bool extrinsic = name[0] >= 'a';
    for (int i = 0; i < 3; i++) {
        const int axis = name[i] - (extrinsic ? 'x' : 'X');
        if (axis < 0 || axis > 2) return QUAT_EARGUMENT;
        code = code << 2 | (unsigned)axis;
    }
    if (name[3] != '\0') return QUAT_EARGUMENT;
    const quat_euler found = (quat_euler)(code | (extrinsic ? 0x40u : 0u));
    axes a;
    if (!decode(found, &a)) return QUAT_EARGUMENT;
    *sequence = found;
    return QUAT_OK;
}

static quat turn(int axis, double angle)
{
    const double c = cos(0.5 * angle), s = sin(0.5 * angle);
    return quat_make(c, axis == 0 ? s : 0, axis == 1 ? s : 0, axis == 2 ? s : 0);
}

quat_status quat_from_euler(const double angles[3], quat_euler sequence, quat *q)
{
    axes a;
    *q = quat_identity();
    if (!decode(sequence, &a)) return QUAT_EARGUMENT;
    if (!isfinite(angles[0]) || !isfinite(angles[1]) || !isfinite(angles[2])) return QUAT_EDOMAIN;
    const quat first = turn(a.first, angles[0]), middle = turn(a.middle, angles[1]), third = turn(a.third, angles[2]);
    *q = a.extrinsic ? quat_mul(third, quat_mul(middle, first)) : quat_mul(first, quat_mul(middle, third));
    return QUAT_OK;
}

/* An angle of at most 2 pi either way, brought into -pi ... pi; 2 pi with the digits a double leaves out. */
static double wrapped(double angle)
{
    const double pi = 3.14159265358979323846, rest = 2.4492935982947064e-16;
    if (angle > pi) return (angle - 2 * pi) - rest;
    if (angle < -pi) return (angle + 2 * pi) + rest;
    return angle;
}

quat_status quat_to_euler(quat q, quat_euler sequence, double angles[3])
{
    axes e;
    angles[0] = angles[1] = angles[2] = 0;
    if (!decode(sequence, &e)) return QUAT_EARGUMENT;
    if (!quat_isfinite(q) || quat_equal(q, quat_make(0, 0, 0, 0))) return QUAT_EDOMAIN;
    int exponent;
    q = quat_prescale(q, &exponent);

    /* the paper treats extrinsic sequences; an intrinsic one is the extrinsic of the letters backwards */
    const int i = e.extrinsic ? e.first : e.third, j = e.middle;
    const bool proper = e.first == e.third;
    const int k = proper ? 3 - i - j : e.extrinsic ? e.third : e.first;
    const double sign = (i - j) * (j - k) * (k - i) / 2, v[3] = {q.x, q.y, q.z};
    double a = q.w, b = v[i], c = v[j], d = v[k] * sign;
    if (!proper) {
        a = q.w - v[j];
        b = v[i] + v[k] * sign;
        c = v[j] + q.w;
        d = v[k] * sign - v[i];
    }
    const bool lock = (a == 0 && b == 0) || (c == 0 && d == 0);
    double plus = atan2(b, a), minus = atan2(d, c);
    const double middle = 2 * atan2(hypot(c, d), hypot(a, b));
    /* at lock one of the two is free: choose it such that the third letter's angle, plus + minus (extrinsic) or
     * plus - minus (intrinsic), is zero */
    const double side = e.extrinsic ? 1 : -1;
    if (c == 0 && d == 0)
        minus = -side * plus;
    else if (lock)
        plus = -side * minus;
    double before = wrapped(plus - minus), after = wrapped(plus + minus);
    if (!proper) after = wrapped(sign * after);
    angles[0] = e.extrinsic ? before : after;
    angles[1] = proper ? middle : (middle - 1.57079632679489661923) - 6.123233995736766e-17;
    angles[2] = e.extrinsic ? after : before;
    return lock ? QUAT_NOT_UNIQUE : QUAT_OK;
}
