/* SPDX-License-Identifier: MIT */
#include <quat/quat.h>
#include "dd.h"
#include "scale.h"

const char *quat_version(void) { return QUAT_VERSION; }

const char *quat_status_string(quat_status status)
{
    switch (status) {
    case QUAT_OK: return "ok";
    case QUAT_NOT_UNIQUE: return "the answer is not unique; one was chosen";
    case QUAT_NOT_CONVERGED: return "the iteration did not converge; the last iterate is returned";
    case QUAT_AT_INFINITY: return "the image is the point at infinity";
    case QUAT_EDOMAIN: return "zero, infinite or NaN where a finite, non-zero value is needed";
    case QUAT_EARGUMENT: return "argument out of range";
    case QUAT_ENOMEM: return "out of memory";
    case QUAT_EABSENT: return "this part was left out of the build";
    case QUAT_ERANGE: return "the result or a number on the way to it is too large or too small";
    }
    return "unknown status";
}

/* ---- lengths ---- */

double quat_norm_far(quat q)
{
    if (q.w == 0 && q.x == 0 && q.y == 0 && q.z == 0) return 0;
    if (isinf(q.w) || isinf(q.x) || isinf(q.y) || isinf(q.z)) return INFINITY;
    int exponent;
    const quat s = quat_prescale(q, &exponent);
    return ldexp(sqrt(quat_norm2(s)), exponent);
}

/* q/|q| for |q|^2 in the range of doubles: the plain quotient, corrected by the residual |q|^2 - n^2 of its length. */
QUAT_FMA_CLONES
static quat divide_by_length(quat q)
{
    const quat_dd w = quat_two_prod(q.w, q.w), x = quat_two_prod(q.x, q.x);
    const quat_dd y = quat_two_prod(q.y, q.y), z = quat_two_prod(q.z, q.z);
    const quat_dd wx = quat_two_sum(w.hi, x.hi), yz = quat_two_sum(y.hi, z.hi), sum = quat_two_sum(wx.hi, yz.hi);
    const double n = sqrt(sum.hi);
    const double lost = ((w.lo + x.lo) + (y.lo + z.lo)) + ((wx.lo + yz.lo) + sum.lo);
    const double correction = -0.5 * (fma(-n, n, sum.hi) + lost) / sum.hi;
    const quat unit = quat_make(q.w / n, q.x / n, q.y / n, q.z / n);
    return quat_axpy(correction, unit, unit);
}

quat_status quat_normalize(quat q, quat *unit)
{
    const double n2 = quat_norm2(q);
    if (n2 >= 1e-280 && n2 <= 1e280) {
        *unit = divide_by_length(q);
        return QUAT_OK;
    }
    *unit = quat_identity();
    if (!quat_isfinite(q) || quat_equal(q, quat_make(0, 0, 0, 0))) return QUAT_EDOMAIN;
    int exponent;
    *unit = divide_by_length(quat_prescale(q, &exponent));
    return QUAT_OK;
}

/* ---- products and quotients ---- */

QUAT_FMA_CLONES
quat quat_mul_compensated(quat p, quat q)
{
    const double a[4] = {p.w, p.x, p.y, p.z};
    const double b[4][4] = {
        {q.w, -q.x, -q.y, -q.z}, {q.x, q.w, q.z, -q.y}, {q.y, -q.z, q.w, q.x}, {q.z, q.y, -q.x, q.w}};
    return quat_make(quat_dot4_plus(0, a, b[0]).hi, quat_dot4_plus(0, a, b[1]).hi, quat_dot4_plus(0, a, b[2]).hi,
                     quat_dot4_plus(0, a, b[3]).hi);
}

/* q* / |q|^2 of a prescaled q: the inverse is this times 2^-exponent. */
static quat scaled_inverse(quat s)
{
    const double n2 = quat_norm2(s);
    return quat_make(s.w / n2, -s.x / n2, -s.y / n2, -s.z / n2);
}

static quat_status checked(quat value, quat *result)
{
    const bool fits = quat_isfinite(value);
    *result = fits ? value : quat_identity();
    return fits ? QUAT_OK : QUAT_ERANGE;
}

quat_status quat_inverse(quat q, quat *inverse)
{
    *inverse = quat_identity();
    if (!quat_isfinite(q) || quat_equal(q, quat_make(0, 0, 0, 0))) return QUAT_EDOMAIN;
    int exponent;
    const quat s = quat_prescale(q, &exponent);
    return checked(quat_ldexp(scaled_inverse(s), -exponent), inverse);
}

static quat_status divide(quat p, quat q, bool left, quat *quotient)
{
    *quotient = quat_identity();
    if (!quat_isfinite(p) || !quat_isfinite(q) || quat_equal(q, quat_make(0, 0, 0, 0))) return QUAT_EDOMAIN;
    int ep, eq;
    const quat sp = quat_prescale(p, &ep), inverse = scaled_inverse(quat_prescale(q, &eq));
    const quat r = left ? quat_mul(inverse, sp) : quat_mul(sp, inverse);
    return checked(quat_ldexp(r, ep - eq), quotient);
}

quat_status quat_div(quat p, quat q, quat *quotient) { return divide(p, q, false, quotient); }
quat_status quat_div_left(quat q, quat p, quat *quotient) { return divide(p, q, true, quotient); }

/* ---- distances and comparisons ---- */

double quat_distance(quat p, quat q) { return 2 * atan2(quat_norm(quat_sub(p, q)), quat_norm(quat_add(p, q))); }

double quat_rotation_distance(quat p, quat q)
{
    const double minus = quat_norm(quat_sub(p, q)), plus = quat_norm(quat_add(p, q));
    if (isnan(minus) || isnan(plus)) return NAN;
    return 4 * atan2(fmin(minus, plus), fmax(minus, plus));
}

double quat_angle(quat q)
{
    int exponent;
    if (quat_isfinite(q)) q = quat_prescale(q, &exponent); /* |v| overflows before q does, and loses digits below */
    return 2 * atan2(qvec3_norm(quat_vector(q)), fabs(q.w));
}

bool quat_near(quat p, quat q, double tolerance) { return quat_norm(quat_sub(p, q)) <= tolerance; }

bool quat_same_rotation(quat p, quat q, double angle) { return quat_rotation_distance(p, q) <= angle; }

/* ---- random ---- */

quat quat_random(quat_uniform uniform, void *state)
{
    const double two_pi = 6.28318530717958647692;
    const double u = uniform(state), a = two_pi * uniform(state), b = two_pi * uniform(state);
    const double r = sqrt(1 - u), s = sqrt(u);
    quat q;
    quat_normalize(quat_make(s * cos(b), r * sin(a), r * cos(a), s * sin(b)), &q);
    return q;
}
