/* SPDX-License-Identifier: MIT */
#include <quat/exponential.h>
#include "dd.h"
#include "scale.h"

/* |v| in twice the precision, for 1e-140 < |v| < 1e140. */
static inline quat_dd norm_dd(double x, double y, double z)
{
    const double v[4] = {x, y, z, 0};
    return quat_dd_sqrt(quat_dd_dot4(v, v));
}

/* cos a and sin(a)/a for the angle a = a.hi + a.lo > 0; the second with its own rounding error, so that what is
 * multiplied by it is rounded once. Angles past 2^26 lose the low part of the angle to plain addition formulas. */
typedef struct circle {
    double cosine;
    quat_dd sinc;
} circle;

static inline circle circle_of(quat_dd a)
{
    const double c = cos(a.hi), s = sin(a.hi);
    /* near pi the low part is all there is: sin(hi + lo) = sin hi + lo cos hi, to lo^2 */
    const double sine_lo = a.lo * c, f = s / a.hi;
    const double residual = (fma(-f, a.hi, s) + sine_lo) - f * a.lo;
    return (circle){c - a.lo * s, quat_two_sum(f, residual / a.hi)};
}

/* scale.hi + scale.lo times the component x, rounded once. */
static inline double times(quat_dd scale, double x) { return scale.hi * x + (fma(scale.hi, x, -(scale.hi * x)) + scale.lo * x); }

/* Below this the second term of both series is less than a rounding error. */
static const double tiny_angle = 1e-8;

QUAT_FMA_CLONES
quat quat_exp_pure(qvec3 v)
{
    const double largest = fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z));
    if (largest < tiny_angle) {
        const double n2 = qvec3_dot(v, v);
        return quat_make(1 - n2 / 2, v.x, v.y, v.z);
    }
    if (!qvec3_isfinite(v)) return quat_make(NAN, NAN, NAN, NAN);
    if (largest > 1e140) {
        const double n = qvec3_norm(v), s = isfinite(n) ? sin(n) / n : NAN;
        return quat_make(isfinite(n) ? cos(n) : NAN, s * v.x, s * v.y, s * v.z);
    }
    const circle k = circle_of(norm_dd(v.x, v.y, v.z));
    return quat_make(k.cosine, times(k.sinc, v.x), times(k.sinc, v.y), times(k.sinc, v.z));
}

/* The v of quat_log_unit; |s|^2 in the range of doubles. */
QUAT_FMA_CLONES
static qvec3 log_scaled(quat s)
{
    const double largest = fmax(fmax(fabs(s.x), fabs(s.y)), fabs(s.z));
    if (largest == 0) return qvec3_make(s.w < 0 ? 3.14159265358979323846 : 0 * s.x, s.y, s.z);
    /* the vector part may be so small that its square vanishes: scale it once more by itself */
    int exponent = ilogb(largest);
    if (exponent > -400) exponent = 0;
    const quat v = quat_ldexp(quat_make(0, s.x, s.y, s.z), -exponent);
    const quat_dd n = norm_dd(v.x, v.y, v.z);
    /* atan2 of hi + lo: d atan2(n, w)/dn = w/(n^2 + w^2) */
    const double y = ldexp(n.hi, exponent), angle = atan2(y, s.w);
    const double angle_lo = ldexp(n.lo, exponent) * s.w / (y * y + s.w * s.w);
    const double f = angle / n.hi;
    const quat_dd k = {f, ((fma(-f, n.hi, angle) + angle_lo) - f * n.lo) / n.hi};
    return qvec3_make(times(k, v.x), times(k, v.y), times(k, v.z));
}

qvec3 quat_log_unit(quat q)
{
    if (!quat_isfinite(q)) return qvec3_make(NAN, NAN, NAN);
    int exponent;
    return log_scaled(quat_prescale(q, &exponent));
}

quat_status quat_exp(quat q, quat *result)
{
    *result = quat_identity();
    if (!quat_isfinite(q)) return QUAT_EDOMAIN;
    const double e = exp(q.w);
    const quat u = quat_exp_pure(quat_vector(q));
    if (!isfinite(e)) return QUAT_ERANGE;
    *result = quat_scale(u, e);
    return QUAT_OK;
}

/* |s|^2 - 1 to nearly three times the precision: nine exact terms, summed with all their rounding errors. */
QUAT_FMA_CLONES
static double norm2_minus_one(quat s)
{
    const double c[4] = {s.w, s.x, s.y, s.z};
    double sum = -1, errors = 0, errors_of_errors = 0, low[8];
    for (int i = 0; i < 4; i++) {
        const quat_dd square = quat_two_prod(c[i], c[i]), t = quat_two_sum(sum, square.hi);
        sum = t.hi;
        low[2 * i] = square.lo;
        low[2 * i + 1] = t.lo;
    }
    for (int i = 0; i < 8; i++) {
        const quat_dd t = quat_two_sum(errors, low[i]);
        errors = t.hi;
        errors_of_errors += t.lo;
    }
    const quat_dd total = quat_two_sum(sum, errors);
    return total.hi + (total.lo + errors_of_errors);
}

/* ln|s| for |s|^2 in the range of doubles. */
QUAT_FMA_CLONES
static double log_norm(quat s)
{
    const double c[4] = {s.w, s.x, s.y, s.z};
    const quat_dd n2 = quat_dd_dot4(c, c);
    if (n2.hi > 0.5 && n2.hi < 2) return 0.5 * log1p(norm2_minus_one(s));
    return 0.5 * (log(n2.hi) + n2.lo / n2.hi);
}

quat_status quat_log(quat q, quat *result)
{
    *result = quat_make(0, 0, 0, 0);
    if (!quat_isfinite(q) || quat_equal(q, quat_make(0, 0, 0, 0))) return QUAT_EDOMAIN;
    const double n2 = quat_norm2(q), ln2 = 0.693147180559945309417;
    int exponent = 0;
    quat s = q;
    if (!(n2 >= 1e-280 && n2 <= 1e280)) s = quat_prescale(q, &exponent);
    *result = quat_from_parts(log_norm(s) + exponent * ln2, log_scaled(s));
    return q.w < 0 && q.x == 0 && q.y == 0 && q.z == 0 ? QUAT_NOT_UNIQUE : QUAT_OK;
}

quat quat_pow_unit(quat q, double t) { return quat_exp_pure(qvec3_scale(quat_log_unit(q), t)); }

quat_status quat_pow(quat q, double t, quat *result)
{
    *result = quat_identity();
    if (!quat_isfinite(q) || !isfinite(t)) return QUAT_EDOMAIN;
    if (t == 0) return QUAT_OK;
    if (quat_equal(q, quat_make(0, 0, 0, 0))) {
        if (t < 0) return QUAT_EDOMAIN;
        *result = q;
        return QUAT_OK;
    }
    if (t == 1) {
        *result = q;
        return QUAT_OK;
    }
    const double scale = pow(quat_norm(q), t);
    if (!isfinite(scale)) return QUAT_ERANGE;
    const bool negative = q.w < 0 && q.x == 0 && q.y == 0 && q.z == 0;
    if (negative && t == floor(t)) {
        *result = quat_make(fmod(t, 2) == 0 ? scale : -scale, 0, 0, 0);
        return QUAT_OK;
    }
    *result = quat_scale(quat_pow_unit(q, t), scale);
    return negative ? QUAT_NOT_UNIQUE : QUAT_OK;
}

quat_status quat_pow_quat(quat p, quat q, quat *result)
{
    *result = quat_identity();
    if (!quat_isfinite(q)) return QUAT_EDOMAIN;
    quat l;
    const quat_status logarithm = quat_log(p, &l);
    if (logarithm < 0) return logarithm;
    const quat exponent = quat_mul(l, q);
    if (!quat_isfinite(exponent)) return QUAT_ERANGE;
    const quat_status status = quat_exp(exponent, result);
    return status < 0 ? status : logarithm;
}

quat_status quat_sqrt(quat q, quat *root)
{
    *root = quat_identity();
    if (!quat_isfinite(q)) return QUAT_EDOMAIN;
    int exponent;
    quat s = quat_prescale(q, &exponent);
    if (exponent % 2) {
        s = quat_scale(s, 2);
        exponent -= 1;
    }
    const double n = quat_norm(s), v = qvec3_norm(quat_vector(s));
    if (v == 0) {
        *root = s.w < 0 ? quat_make(0, sqrt(-s.w), 0, 0) : quat_make(sqrt(s.w), s.x, s.y, s.z);
    } else if (s.w >= 0) {
        const double w = sqrt(0.5 * (n + s.w));
        *root = quat_make(w, s.x / (2 * w), s.y / (2 * w), s.z / (2 * w));
    } else {
        /* n + w would cancel: the vector part first */
        const double b = sqrt(0.5 * (n - s.w));
        *root = quat_make(v / (2 * b), b * (s.x / v), b * (s.y / v), b * (s.z / v));
    }
    *root = quat_ldexp(*root, exponent / 2);
    return v == 0 && s.w < 0 ? QUAT_NOT_UNIQUE : QUAT_OK;
}
