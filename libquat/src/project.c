/* SPDX-License-Identifier: MIT
 *
 * Every sphere here is a part of S^3: (z, x, y, 0) of S^2 and (y, x, 0, 0) of S^1 go the same way as q.
 */
#include <quat/exponential.h>
#include <quat/project.h>
#include "dd.h"
#include "scale.h"

static double largest_of(qvec3 v) { return fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z)); }
static qvec3 scaled(qvec3 v, int exponent)
{
    return qvec3_make(ldexp(v.x, exponent), ldexp(v.y, exponent), ldexp(v.z, exponent));
}
static bool known(quat_pole pole) { return pole == QUAT_SOUTH_POLE || pole == QUAT_NORTH_POLE; }
static bool in_range(double square) { return square >= 1e-280 && square <= 1e280; }

/* ---- stereographic ---- */

/* v (n - w)/|v|^2, which is v/(n + w) without the difference; v may be so small that its square vanishes. */
static qvec3 far_image(double n, double w, qvec3 v)
{
    int exponent = 0;
    double square = qvec3_dot(v, v);
    if (!in_range(square)) {
        exponent = ilogb(largest_of(v));
        v = scaled(v, -exponent);
        square = qvec3_dot(v, v);
    }
    return scaled(qvec3_scale(v, (n - w) / square), -exponent);
}

quat_status quat_stereographic(quat q, quat_pole pole, qvec3 *image)
{
    int exponent;
    *image = qvec3_make(0, 0, 0);
    if (!known(pole)) return QUAT_EARGUMENT;
    if (!quat_isfinite(q) || quat_equal(q, quat_make(0, 0, 0, 0))) return QUAT_EDOMAIN;
    if (!in_range(quat_norm2(q))) q = quat_prescale(q, &exponent);
    const double n = sqrt(quat_norm2(q)), w = pole == QUAT_SOUTH_POLE ? q.w : -q.w;
    const qvec3 v = quat_vector(q);
    if (w >= 0) {
        *image = qvec3_make(v.x / (n + w), v.y / (n + w), v.z / (n + w));
        return QUAT_OK;
    }
    if (largest_of(v) > 0) {
        const qvec3 far = far_image(n, w, v);
        if (qvec3_isfinite(far)) {
            *image = far;
            return QUAT_OK;
        }
    }
    *image = qvec3_make(INFINITY, INFINITY, INFINITY);
    return QUAT_AT_INFINITY;
}

/* 1 - |x|^2, |x| < 1e140, rounded once. */
QUAT_FMA_CLONES
static double rest_of(qvec3 x)
{
    const double a[4] = {x.x, x.y, x.z, 0}, b[4] = {-x.x, -x.y, -x.z, 0};
    return quat_dot4_plus(1, a, b).hi;
}

quat quat_from_stereographic(qvec3 image, quat_pole pole)
{
    if (!known(pole) || isnan(image.x) || isnan(image.y) || isnan(image.z)) return quat_make(NAN, NAN, NAN, NAN);
    const double side = pole == QUAT_SOUTH_POLE ? 1 : -1, largest = largest_of(image);
    if (isinf(largest)) return quat_make(-side, 0, 0, 0);
    if (largest > 1e140) return quat_from_parts(-side, far_image(1, -1, image));
    const double rest = rest_of(image), d = 2 - rest; /* 1 + r^2, rounded twice */
    return quat_make(side * rest / d, 2 * image.x / d, 2 * image.y / d, 2 * image.z / d);
}

quat_status quat_stereographic_sphere(qvec3 p, quat_pole pole, qvec2 *image)
{
    qvec3 v;
    const quat_status status = quat_stereographic(quat_make(p.z, p.x, p.y, 0), pole, &v);
    *image = qvec2_make(v.x, v.y);
    return status;
}

qvec3 quat_from_stereographic_sphere(qvec2 image, quat_pole pole)
{
    const quat q = quat_from_stereographic(qvec3_make(image.x, image.y, 0), pole);
    return qvec3_make(q.x, q.y, q.w);
}

quat_status quat_stereographic_circle(qvec2 p, quat_pole pole, double *image)
{
    qvec3 v;
    const quat_status status = quat_stereographic(quat_make(p.y, p.x, 0, 0), pole, &v);
    *image = v.x;
    return status;
}

qvec2 quat_from_stereographic_circle(double image, quat_pole pole)
{
    const quat q = quat_from_stereographic(qvec3_make(image, 0, 0), pole);
    return qvec2_make(q.x, q.w);
}

/* ---- orthographic ---- */

quat_status quat_orthographic(quat q, qvec3 *image, int *half)
{
    quat unit;
    const quat_status status = quat_normalize(q, &unit);
    if (status != QUAT_OK) unit = quat_make(0, 0, 0, 0);
    *image = quat_vector(unit);
    if (half) *half = (q.w > 0) - (q.w < 0);
    if (half && status != QUAT_OK) *half = 0;
    return status;
}

quat_status quat_from_orthographic(qvec3 image, int half, quat *q)
{
    static const double rounding = 0x1p-50;
    *q = quat_identity();
    if (half < -1 || half > 1) return QUAT_EARGUMENT;
    if (!qvec3_isfinite(image)) return QUAT_EDOMAIN;
    const double rest = largest_of(image) > 2 ? -1 : rest_of(image);
    if (half != 0 && rest > 0) {
        *q = quat_from_parts(half * sqrt(rest), image);
        return QUAT_OK;
    }
    const quat_status status = quat_normalize(quat_pure(image), q); /* on the boundary */
    return fabs(rest) <= rounding ? status : QUAT_EDOMAIN;
}

quat_status quat_orthographic_sphere(qvec3 p, qvec2 *image, int *half)
{
    qvec3 v;
    const quat_status status = quat_orthographic(quat_make(p.z, p.x, p.y, 0), &v, half);
    *image = qvec2_make(v.x, v.y);
    return status;
}

quat_status quat_from_orthographic_sphere(qvec2 image, int half, qvec3 *p)
{
    quat q;
    const quat_status status = quat_from_orthographic(qvec3_make(image.x, image.y, 0), half, &q);
    *p = qvec3_make(q.x, q.y, q.w);
    return status;
}

quat_status quat_orthographic_circle(qvec2 p, double *image, int *half)
{
    qvec3 v;
    const quat_status status = quat_orthographic(quat_make(p.y, p.x, 0, 0), &v, half);
    *image = v.x;
    return status;
}

quat_status quat_from_orthographic_circle(double image, int half, qvec2 *p)
{
    quat q;
    const quat_status status = quat_from_orthographic(qvec3_make(image, 0, 0), half, &q);
    *p = qvec2_make(q.x, q.w);
    return status;
}

/* ---- arrays ---- */

/* The gravest status so far and where it came first. */
typedef struct verdict {
    quat_status status;
    size_t first;
} verdict;

static void take(verdict *v, quat_status status, size_t i)
{
    const bool graver = v->status == QUAT_OK ? status != QUAT_OK : v->status > 0 && status < 0;
    if (graver) *v = (verdict){status, i};
}

static quat_status tell(verdict v, size_t *first)
{
    if (first) *first = v.first;
    return v.status;
}

quat_status quat_stereographic_array(size_t n, const quat q[], quat_pole pole, qvec3 image[], size_t *first)
{
    verdict v = {QUAT_OK, n};
    for (size_t i = 0; i < n; i++) take(&v, quat_stereographic(q[i], pole, &image[i]), i);
    return tell(v, first);
}

void quat_from_stereographic_array(size_t n, const qvec3 image[], quat_pole pole, quat q[])
{
    for (size_t i = 0; i < n; i++) q[i] = quat_from_stereographic(image[i], pole);
}

quat_status quat_orthographic_array(size_t n, const quat q[], qvec3 image[], int half[], size_t *first)
{
    verdict v = {QUAT_OK, n};
    for (size_t i = 0; i < n; i++) take(&v, quat_orthographic(q[i], &image[i], half ? &half[i] : NULL), i);
    return tell(v, first);
}

quat_status quat_from_orthographic_array(size_t n, const qvec3 image[], const int half[], quat q[], size_t *first)
{
    verdict v = {QUAT_OK, n};
    for (size_t i = 0; i < n; i++) take(&v, quat_from_orthographic(image[i], half[i], &q[i]), i);
    return tell(v, first);
}

/* ---- Hopf ---- */

quat_status quat_hopf_fibre(qvec3 p, double t, quat *q)
{
    const quat_status status = quat_from_two_vectors(qvec3_make(0, 0, 1), p, q);
    if (status < 0 || !isfinite(t)) {
        *q = quat_identity();
        return QUAT_EDOMAIN;
    }
    *q = quat_mul(*q, quat_exp_pure(qvec3_make(0, 0, t)));
    return status;
}

double quat_hopf_angle(quat q)
{
    /* over -z, where w = z = 0, q = j exp(k t) */
    return q.w == 0 && q.z == 0 ? atan2(q.x, q.y) : atan2(q.z, q.w);
}
