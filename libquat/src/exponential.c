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

/* cos a and sin a, each with what its rounding lost. Where one of them vanishes, at pi/2 and pi, the distance from
 * there has all its digits first. */
typedef struct circle {
    quat_dd cosine, sine;
} circle;

static inline circle circle_of(length a)
{
    static const double half_pi[3] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};
    for (int k = 1; k <= 2; k++) {
        const double x = a.hi - k * half_pi[0]; /* exact so near */
        if (fabs(x) > 1e-3) continue;
        const double terms[5] = {x, a.lo, -k * half_pi[1], a.lowest, -k * half_pi[2]};
        const quat_dd d = quat_sum3(5, terms);
        const double c = cos(d.hi), s = sin(d.hi);
        return k == 1 ? (circle){{-s, -d.lo * c}, {c, -d.lo * s}} : (circle){{-c, d.lo * s}, {-s, -d.lo * c}};
    }
    const double c = cos(a.hi), s = sin(a.hi);
    if (fabs(a.lo) < 1e-9) return (circle){{c, -a.lo * s}, {s, a.lo * c}};
    const double lo = sin(a.lo), half = sin(0.5 * a.lo), less = 2 * half * half; /* angles past 1e7 */
    return (circle){{c, -lo * s - less * c}, {s, lo * c - less * s}};
}

/* a b, and s/a, to twice the precision but for a unit or two. */
static inline quat_dd product(quat_dd a, quat_dd b)
{
    const quat_dd p = quat_two_prod(a.hi, b.hi);
    return (quat_dd){p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi)};
}
static inline quat_dd over(quat_dd s, length a)
{
    const double f = s.hi / a.hi;
    return (quat_dd){f, (fma(-f, a.hi, s.hi) + (s.lo - f * a.lo)) / a.hi};
}

static inline quat_dd root_of(quat_dd a)
{
    const double r = sqrt(a.hi);
    return (quat_dd){r, r > 0 ? (fma(-r, r, a.hi) + a.lo) / (2 * r) : 0};
}

/* scale.hi + scale.lo times the component x, rounded once. */
static inline double times(quat_dd scale, double x)
{
    return scale.hi * x + (fma(scale.hi, x, -(scale.hi * x)) + scale.lo * x);
}

/* e^w = (hi + lo) 2^exponent to 0.1 units, for |w| < 1000. With |r| <= ln(2)/2 the cubic term and those after it, the
 * only ones that are rounded, are small. */
QUAT_FMA_CLONES
static quat_dd exponential_of(double w, int *exponent)
{
    static const double ln2[2] = {0x1.62e42fefa38p-1, 0x1.ef35793c7673p-45}; /* k ln2[0] is exact, and so is r's head */
    const double k = nearbyint(w * 0x1.71547652b82fep+0);
    const quat_dd tail = quat_two_prod(-k, ln2[1]), r = quat_two_sum(w - k * ln2[0], tail.hi);
    double cubic = 1;
    for (int j = 15; j > 3; j--) cubic = 1 + r.hi * cubic / j;
    cubic *= r.hi * r.hi * r.hi / 6;
    const quat_dd linear = quat_two_sum(1, r.hi), square = quat_two_prod(0.5 * r.hi, r.hi);
    const quat_dd sum = quat_two_sum(linear.hi, square.hi);
    const double rest = (r.lo + tail.lo) * sum.hi + (linear.lo + square.lo + sum.lo);
    *exponent = (int)k;
    return quat_two_sum(sum.hi, cubic + rest);
}

/* Below this the third terms of both series vanish. */
static const double tiny_angle = 1e-8;

/* scale times exp(0, v). */
QUAT_FMA_CLONES
static quat scaled_exp_pure(quat_dd scale, qvec3 v)
{
    const double largest = fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z));
    if (largest < tiny_angle) {
        const double n2 = qvec3_dot(v, v);
        const quat_dd c = product(scale, (quat_dd){1, -n2 / 2}), s = product(scale, (quat_dd){1, -n2 / 6});
        return quat_make(c.hi + c.lo, times(s, v.x), times(s, v.y), times(s, v.z));
    }
    if (!qvec3_isfinite(v)) return quat_make(NAN, NAN, NAN, NAN);
    if (largest > 1e140) {
        const double n = qvec3_norm(v), s = isfinite(n) ? scale.hi * (sin(n) / n) : NAN;
        return quat_make(isfinite(n) ? scale.hi * cos(n) : NAN, s * v.x, s * v.y, s * v.z);
    }
    const length a = length_of(v.x, v.y, v.z);
    const circle k = circle_of(a);
    const quat_dd c = product(scale, k.cosine), s = product(scale, over(k.sine, a));
    return quat_make(c.hi + c.lo, times(s, v.x), times(s, v.y), times(s, v.z));
}

quat quat_exp_pure(qvec3 v) { return scaled_exp_pure((quat_dd){1, 0}, v); }

/* The vector part of a prescaled s, times 2^-exponent: it may be so small that its square would vanish. */
static inline length length_of_vector(quat s, quat *v, int *exponent)
{
    *exponent = ilogb(fmax(fmax(fabs(s.x), fabs(s.y)), fabs(s.z)));
    if (*exponent > -400) *exponent = 0;
    *v = quat_ldexp(quat_make(0, s.x, s.y, s.z), -*exponent);
    return length_of(v->x, v->y, v->z);
}

/* The v of quat_log_unit for a prescaled s. */
QUAT_FMA_CLONES
static qvec3 log_scaled(quat s)
{
    const double largest = fmax(fmax(fabs(s.x), fabs(s.y)), fabs(s.z));
    if (largest == 0) return qvec3_make(s.w < 0 ? 3.14159265358979323846 : 0 * s.x, s.y, s.z);
    int exponent;
    quat v;
    const length n = length_of_vector(s, &v, &exponent);
    /* atan2 of hi + lo: d atan2(n, w)/dn = w/(n^2 + w^2) */
    const double y = ldexp(n.hi, exponent), angle = atan2(y, s.w);
    const double angle_lo = ldexp(n.lo, exponent) * s.w / (y * y + s.w * s.w);
    const quat_dd k = over((quat_dd){angle, angle_lo}, n);
    return qvec3_make(times(k, v.x), times(k, v.y), times(k, v.z));
}

qvec3 quat_log_unit(quat q)
{
    if (!quat_isfinite(q)) return qvec3_make(NAN, NAN, NAN);
    int exponent;
    return log_scaled(quat_prescale(q, &exponent));
}

/* ln(DBL_MAX): beyond it e^w overflows. */
static const double largest_logarithm = 0x1.62e42fefa39efp+9;

quat_status quat_exp(quat q, quat *result)
{
    *result = quat_identity();
    if (!quat_isfinite(q)) return QUAT_EDOMAIN;
    if (q.w > largest_logarithm || !isfinite(qvec3_norm(quat_vector(q)))) return QUAT_ERANGE;
    int exponent;
    const quat_dd e = exponential_of(fmax(q.w, -800), &exponent);
    *result = quat_ldexp(scaled_exp_pure(e, quat_vector(q)), exponent);
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
    const quat power = quat_scale(quat_pow_unit(q, t), scale);
    if (!quat_isfinite(power)) return QUAT_ERANGE;
    *result = power;
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

/* The root of a prescaled s with a vector part, w >= 0. Where s.w < 0 it would cancel in w, and the vector part comes
 * first. */
QUAT_FMA_CLONES
static quat root_scaled(quat s)
{
    const double c[4] = {s.w, s.x, s.y, s.z};
    const quat_dd n = root_of(quat_dot4_plus(0, c, c)), sum = quat_two_sum(n.hi, fabs(s.w));
    const quat_dd b = root_of((quat_dd){0.5 * sum.hi, 0.5 * (sum.lo + n.lo)});
    const length half = {b.hi, b.lo, 0};
    if (s.w >= 0) {
        const quat_dd k = over((quat_dd){0.5, 0}, half);
        return quat_make(b.hi + b.lo, times(k, s.x), times(k, s.y), times(k, s.z));
    }
    int exponent;
    quat v;
    const length a = length_of_vector(s, &v, &exponent);
    const quat_dd w = over((quat_dd){0.5 * a.hi, 0.5 * a.lo}, half), k = over(b, a);
    return quat_make(ldexp(w.hi + w.lo, exponent), times(k, v.x), times(k, v.y), times(k, v.z));
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
    if (s.x == 0 && s.y == 0 && s.z == 0)
        s = s.w < 0 ? quat_make(0, sqrt(-s.w), 0, 0) : quat_make(sqrt(s.w), s.x, s.y, s.z);
    else
        s = root_scaled(s);
    *root = quat_ldexp(s, exponent / 2);
    return quat_equal(q, quat_make(q.w, 0, 0, 0)) && q.w < 0 ? QUAT_NOT_UNIQUE : QUAT_OK;
}
