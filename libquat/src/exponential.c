/* SPDX-License-Identifier: MIT */
#include <quat/exponential.h>
#include "dd.h"
#include "scale.h"

/* |v| as hi + lo + lowest, for 1e-140 < |v| < 1e140. */
typedef struct length {
    double hi, lo, lowest;
} length;

static inline length length_of(double x, double y, double z)
{
    const double n = sqrt(x * x + y * y + z * z), a[4] = {x, y, z, n}, b[4] = {x, y, z, -n};
    /* (n + lo)^2 = |v|^2: 2 n lo = e - lo^2 with e = |v|^2 - n^2 */
    const quat_dd e = quat_dot4_plus(0, a, b);
    const double lo = e.hi / (2 * n), lowest = (fma(-lo, 2 * n, e.hi) + e.lo - lo * lo) / (2 * n);
    return (length){n, lo, lowest};
}

/* cos a and sin a. Where one of them vanishes, at pi/2 and pi, the distance from there has all its digits first. */
typedef struct circle {
    double cosine, sine;
} circle;

static inline circle circle_of(length a)
{
    static const double half_pi[3] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};
    for (int k = 1; k <= 2; k++) {
        const double x = a.hi - k * half_pi[0]; /* exact so near */
        if (fabs(x) > 1e-3) continue;
        const double terms[5] = {x, a.lo, -k * half_pi[1], a.lowest, -k * half_pi[2]};
        const double d = quat_sum3(5, terms).hi;
        return k == 1 ? (circle){-sin(d), cos(d)} : (circle){-cos(d), -sin(d)};
    }
    const double c = cos(a.hi), s = sin(a.hi);
    return (circle){c - a.lo * s, s + a.lo * c};
}

/* s/a with its own rounding error, so that what is multiplied by it is rounded once. */
static inline quat_dd over(double s, length a)
{
    const double f = s / a.hi;
    return (quat_dd){f, (fma(-f, a.hi, s) - f * a.lo) / a.hi};
}

/* scale.hi + scale.lo times the component x, rounded once. */
static inline double times(quat_dd scale, double x)
{
    return scale.hi * x + (fma(scale.hi, x, -(scale.hi * x)) + scale.lo * x);
}

/* Below this the second term of both series is less than a rounding error. */
static const double tiny_angle = 1e-8;

/* scale times exp(0, v). */
QUAT_FMA_CLONES
static quat scaled_exp_pure(double scale, qvec3 v)
{
    const double largest = fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z));
    if (largest < tiny_angle) {
        const double n2 = qvec3_dot(v, v);
        return quat_make(scale * (1 - n2 / 2), scale * v.x, scale * v.y, scale * v.z);
    }
    if (!qvec3_isfinite(v)) return quat_make(NAN, NAN, NAN, NAN);
    if (largest > 1e140) {
        const double n = qvec3_norm(v), s = isfinite(n) ? scale * (sin(n) / n) : NAN;
        return quat_make(isfinite(n) ? scale * cos(n) : NAN, s * v.x, s * v.y, s * v.z);
    }
    const length a = length_of(v.x, v.y, v.z);
    const circle k = circle_of(a);
    const quat_dd sinc = over(k.sine, a), p = quat_two_prod(scale, sinc.hi), f = {p.hi, p.lo + scale * sinc.lo};
    return quat_make(scale * k.cosine, times(f, v.x), times(f, v.y), times(f, v.z));
}

quat quat_exp_pure(qvec3 v) { return scaled_exp_pure(1, v); }

/* The v of quat_log_unit for a prescaled s. */
QUAT_FMA_CLONES
static qvec3 log_scaled(quat s)
{
    const double largest = fmax(fmax(fabs(s.x), fabs(s.y)), fabs(s.z));
    if (largest == 0) return qvec3_make(s.w < 0 ? 3.14159265358979323846 : 0 * s.x, s.y, s.z);
    /* the vector part may be so small that its square vanishes: scale it once more by itself */
    int exponent = ilogb(largest);
    if (exponent > -400) exponent = 0;
    const quat v = quat_ldexp(quat_make(0, s.x, s.y, s.z), -exponent);
    const length n = length_of(v.x, v.y, v.z);
    /* atan2 of hi + lo: d atan2(n, w)/dn = w/(n^2 + w^2) */
    const double y = ldexp(n.hi, exponent), angle = atan2(y, s.w);
    const double angle_lo = ldexp(n.lo, exponent) * s.w / (y * y + s.w * s.w);
    quat_dd k = over(angle, n);
    k.lo += angle_lo / n.hi;
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
    if (!isfinite(e) || !isfinite(qvec3_norm(quat_vector(q)))) return QUAT_ERANGE;
    *result = scaled_exp_pure(e, quat_vector(q));
    return QUAT_OK;
}

/* ln|s| for |s|^2 in the range of doubles. */
QUAT_FMA_CLONES
static double log_norm(quat s)
{
    const double c[4] = {s.w, s.x, s.y, s.z};
    const quat_dd n2 = quat_dot4_plus(0, c, c);
    if (n2.hi > 0.5 && n2.hi < 2) return 0.5 * log1p(quat_dot4_plus(-1, c, c).hi);
    return 0.5 * (log(n2.hi) + n2.lo / n2.hi);
}

quat_status quat_log(quat q, quat *result)
{
    *result = quat_make(0, 0, 0, 0);
    if (!quat_isfinite(q) || quat_equal(q, quat_make(0, 0, 0, 0))) return QUAT_EDOMAIN;
    const double n2 = quat_norm2(q), ln2 = 0.693147180559945309417;
    int exponent;
    const quat s = quat_prescale(q, &exponent);
    const double logarithm = n2 >= 1e-280 && n2 <= 1e280 ? log_norm(q) : log_norm(s) + exponent * ln2;
    *result = quat_from_parts(logarithm, log_scaled(s));
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
