/* SPDX-License-Identifier: MIT */
#include <quat/surface.h>

#include <float.h>
#include <limits.h>
#include <quat/rotation.h>
#include "difference.h"
#include "scale.h"
#include "surface.h"

static const qvec3 zero = {0, 0, 0};

/* t in low ... high: as it is, or by whole periods. */
static double home(double t, double low, double high, bool closed)
{
    if (!closed || (t >= low && t <= high)) return t;
    t -= (high - low) * floor((t - low) / (high - low));
    return fmin(fmax(t, low), high);
}

static bool ask(const quat_surface *s, double u, double v, qvec3 d[6])
{
    static const int filled[] = {1, 3, 6};
    if (!s->at(home(u, s->u0, s->u1, s->closed_u), home(v, s->v0, s->v1, s->closed_v), d, s->context)) return false;
    for (int i = 0; i < filled[s->known]; i++)
        if (!qvec3_isfinite(d[i])) return false;
    return true;
}

/* ---- differences ---- */

/* Element `which` of the function's values, along u or v with the other held. */
typedef struct line {
    const quat_surface *surface;
    double u, v;
    bool along_v;
    int which;
    double step; /* along u, for first_along */
} line;

static bool along(double t, qvec3 *x, void *context)
{
    const line *l = context;
    qvec3 d[6];
    if (!ask(l->surface, l->along_v ? l->u : t, l->along_v ? t : l->v, d)) return false;
    *x = d[l->which];
    return true;
}

/* The derivatives of f along the line, which ends where the surface does. */
static bool follow(quat_line f, line *l, double noise, int orders, qvec3 d[], double error[], double *step)
{
    const quat_surface *s = l->surface;
    const bool closed = l->along_v ? s->closed_v : s->closed_u;
    const double low = l->along_v ? s->v0 : s->u0, high = l->along_v ? s->v1 : s->u1;
    return quat_differentiate(f, l, l->along_v ? l->v : l->u, closed ? -INFINITY : low, closed ? INFINITY : high,
                              high - low, noise, orders, d, error, step);
}

/* x_u along v, for the mixed derivative. */
static bool first_along(double v, qvec3 *xu, void *context)
{
    const line *l = context;
    const quat_surface *s = l->surface;
    line in_u = {s, l->u, v, false, 0, 0};
    return quat_differentiate_once(along, &in_u, l->u, s->closed_u ? -INFINITY : s->u0, s->closed_u ? INFINITY : s->u1,
                                   l->step, xu);
}

static bool from_positions(const quat_surface *s, double u, double v, qvec3 d[6], double error[6])
{
    qvec3 by_u[2], by_v[2];
    double eu[2], ev[2];
    line in_u = {s, u, v, false, 0, 0}, in_v = {s, u, v, true, 0, 0};
    if (!follow(along, &in_u, 0, 2, by_u, eu, &in_v.step) || !follow(along, &in_v, 0, 2, by_v, ev, NULL)) return false;
    d[1] = by_u[0], d[2] = by_v[0], d[3] = by_u[1], d[5] = by_v[1];
    error[1] = eu[0], error[2] = ev[0], error[3] = eu[1], error[5] = ev[1];
    return follow(first_along, &in_v, eu[0], 1, &d[4], &error[4], NULL);
}

static bool differentiate(const quat_surface *s, double u, double v, bool along_v, int which, qvec3 *d, double *error)
{
    line l = {s, u, v, along_v, which, 0};
    return follow(along, &l, 0, 1, d, error, NULL);
}

static bool from_tangents(const quat_surface *s, double u, double v, qvec3 d[6], double error[6])
{
    return differentiate(s, u, v, false, 1, &d[3], &error[3]) && differentiate(s, u, v, true, 1, &d[4], &error[4]) &&
           differentiate(s, u, v, true, 2, &d[5], &error[5]);
}

static quat_status derivatives(const quat_surface *s, double u, double v, qvec3 d[6], double error[6])
{
    for (int i = 0; i < 6; i++) d[i] = zero, error[i] = 0;
    if (!quat_surface_is_good(s)) return QUAT_EARGUMENT;
    if (!isfinite(u) || !isfinite(v)) return QUAT_EDOMAIN;
    if (!s->closed_u && (u < s->u0 || u > s->u1)) return QUAT_EDOMAIN;
    if (!s->closed_v && (v < s->v0 || v > s->v1)) return QUAT_EDOMAIN;
    if (!ask(s, u, v, d)) return QUAT_EDOMAIN;
    for (int i = 0; i < 6; i++) error[i] = 2 * DBL_EPSILON * qvec3_norm(d[i]);
    if (s->known == 0 && !from_positions(s, u, v, d, error)) return QUAT_EDOMAIN;
    if (s->known == 1 && !from_tangents(s, u, v, d, error)) return QUAT_EDOMAIN;
    return QUAT_OK;
}

/* ---- curvature ---- */

/* Whether the tangents span a plane, to rounding: of their directions, so that nothing vanishes or overflows. */
static bool spans(qvec3 xu, qvec3 xv)
{
    const double u = qvec3_norm(xu), v = qvec3_norm(xv);
    if (!(fmin(u, v) > 1e-15 * fmax(u, v))) return false;
    const qvec3 by_u = quat_ldexp_vector(xu, -quat_vector_exponent(xu)),
                by_v = quat_ldexp_vector(xv, -quat_vector_exponent(xv));
    return qvec3_norm(qvec3_cross(by_u, by_v)) > 4 * DBL_EPSILON * qvec3_norm(by_u) * qvec3_norm(by_v);
}

/* The curvature of tangents near 1 and rates at most 2, which `unit`, a power of two, has been taken out of. */
static quat_status curvature_of(quat q, qvec3 a, qvec3 b, qvec3 xu, qvec3 xv, int unit, quat_curvature *c)
{
    const qvec3 t1 = quat_rotate(q, qvec3_make(1, 0, 0)), t2 = quat_rotate(q, qvec3_make(0, 1, 0));
    const double j11 = qvec3_dot(xu, t1), j12 = qvec3_dot(xv, t1), j21 = qvec3_dot(xu, t2), j22 = qvec3_dot(xv, t2);
    const double det = j11 * j22 - j12 * j21;
    if (det == 0) return QUAT_EDOMAIN;
    /* S = M J^-1: dN on T1 and T2 */
    const double s11 = (a.y * j22 - b.y * j21) / det, s12 = (b.y * j11 - a.y * j12) / det,
                 s21 = (b.x * j21 - a.x * j22) / det, s22 = (a.x * j12 - b.x * j11) / det;
    const double off = (s12 + s21) / 2, half = (s11 - s22) / 2, radius = hypot(half, off),
                 size = fabs(s11) + fabs(s22) + fabs(off), mean = (s11 + s22) / 2;
    c->gauss = ldexp((a.x * b.y - a.y * b.x) / det, 2 * unit);
    c->mean = ldexp(mean, unit);
    c->principal[0] = ldexp(mean + radius, unit);
    c->principal[1] = ldexp(mean - radius, unit);
    c->asymmetry = ldexp(fabs(s12 - s21), unit);
    const bool umbilic = radius <= 16 * DBL_EPSILON * size;
    const double angle = umbilic ? 0 : atan2(off, half) / 2;
    c->direction[0] = qvec3_axpy(sin(angle), t2, qvec3_scale(t1, cos(angle)));
    c->direction[1] = qvec3_axpy(-sin(angle), t1, qvec3_scale(t2, cos(angle)));
    if (!isfinite(c->gauss) || !isfinite(c->principal[0] - c->principal[1]) || !isfinite(c->asymmetry))
        return QUAT_ERANGE;
    return umbilic ? QUAT_NOT_UNIQUE : QUAT_OK;
}

/* Parameters counted in other units change a and x_u, or b and x_v, alike; a unit of length changes the curvatures
 * alone: with units that bring x_u, x_v and the larger rate close to 1 no product vanishes or overflows that the
 * curvatures do not. */
quat_status quat_curvature_of_frame(quat q, qvec3 a, qvec3 b, qvec3 xu, qvec3 xv, quat_curvature *c)
{
    const quat_curvature none = {0};
    *c = none;
    if (!qvec3_isfinite(xu) || !qvec3_isfinite(xv) || !qvec3_isfinite(a) || !qvec3_isfinite(b)) return QUAT_EDOMAIN;
    if (quat_normalize(q, &q) != QUAT_OK || !spans(xu, xv)) return QUAT_EDOMAIN;
    const int u = quat_vector_exponent(xu), v = quat_vector_exponent(xv),
              of_a = qvec3_norm(a) > 0 ? quat_vector_exponent(a) - u : INT_MIN / 2,
              of_b = qvec3_norm(b) > 0 ? quat_vector_exponent(b) - v : INT_MIN / 2, larger = of_a > of_b ? of_a : of_b,
              unit = larger > INT_MIN / 2 ? larger : 0;
    const quat_status status = curvature_of(q, quat_ldexp_vector(a, -u - unit), quat_ldexp_vector(b, -v - unit),
                                            quat_ldexp_vector(xu, -u), quat_ldexp_vector(xv, -v), unit, c);
    if (status < 0) *c = none;
    return status;
}

/* A vector of the body in axes turned by `angle` about z. */
static qvec3 turned(qvec3 a, double angle)
{
    const double c = cos(angle), s = sin(angle);
    return qvec3_make(c * a.x + s * a.y, c * a.y - s * a.x, a.z);
}

void quat_regauge(double angle, double angle_u, double angle_v, quat *q, qvec3 *a, qvec3 *b)
{
    *q = quat_mul(*q, quat_make(cos(angle / 2), 0, 0, sin(angle / 2)));
    *a = turned(*a, angle);
    *b = turned(*b, angle);
    a->z += angle_u;
    b->z += angle_v;
}

/* The rate of the frame T1 = x_u/|x_u|, N: a second derivative x_u' = x_uu or x_uv, and x_v' = x_uv or x_vv, along
 * which the parameter grows. N'.x_u = -N.x_u' and N'.x_v = -N.x_v'. */
static qvec3 rate(const quat_surface_point *p, qvec3 t1, qvec3 t2, qvec3 n, qvec3 xu_rate, qvec3 xv_rate)
{
    const double eu = qvec3_dot(p->xu, t1), ev = qvec3_dot(p->xv, t1), gv = qvec3_dot(p->xv, t2);
    const double on_u = qvec3_dot(n, xu_rate), on_v = qvec3_dot(n, xv_rate);
    /* N' = a_y T1 - a_x T2;  T1'.T2 = a_z */
    const double y = -on_u / eu;
    return qvec3_make((on_v + y * ev) / gv, y, qvec3_dot(xu_rate, t2) / eu);
}

/* The curvatures are the second derivatives' share along the normal, times 1/sine^2 of the angle between the tangents;
 * a tangent's error turns the normal, and changes the sine, by 1/sine of itself. */
static double error_of(const quat_surface_point *p, const double e[6], const qvec3 d[6])
{
    const double u = qvec3_norm(p->xu), v = qvec3_norm(p->xv), sine = p->area / (u * v);
    const double second = e[3] / (u * u) + 2 * e[4] / (u * v) + e[5] / (v * v),
                 size = qvec3_norm(d[3]) / (u * u) + 2 * qvec3_norm(d[4]) / (u * v) + qvec3_norm(d[5]) / (v * v);
    return (second + size * (e[1] / u + e[2] / v) * 2 / sine) / (sine * sine);
}

/* Beside a degenerate point the curvatures may err by more than they are, or than one over the surface's extent. */
static bool is_doubtful(const quat_surface *s, const quat_surface_point *p)
{
    const double extent = qvec3_norm(p->xu) * (s->u1 - s->u0) + qvec3_norm(p->xv) * (s->v1 - s->v0),
                 largest = fmax(fabs(p->curvature.principal[0]), fabs(p->curvature.principal[1]));
    return p->error > 1e-3 * (largest + 1 / extent);
}

quat_status quat_surface_at(const quat_surface *surface, double u, double v, quat_surface_point *p)
{
    const quat_surface_point none = {.frame = {1, 0, 0, 0}};
    qvec3 d[6], t1, t2, n;
    double e[6];
    *p = none;
    const quat_status status = derivatives(surface, u, v, d, e);
    if (qvec3_isfinite(d[0])) p->position = d[0];
    if (status != QUAT_OK) return status;
    if (!spans(d[1], d[2]) || qvec3_norm(d[1]) <= 4 * e[1] || qvec3_norm(d[2]) <= 4 * e[2]) return QUAT_EDOMAIN;
    for (int i = 1; i <= 2; i++)
        if (!(qvec3_norm(d[i]) >= 1e-100 && qvec3_norm(d[i]) <= 1e100)) return QUAT_ERANGE;
    for (int i = 3; i < 6; i++)
        if (qvec3_norm(d[i]) > 1e100) return QUAT_ERANGE;
    p->xu = d[1];
    p->xv = d[2];
    p->area = qvec3_norm(qvec3_cross(d[1], d[2]));
    qvec3_normalize(d[1], &t1);
    qvec3_normalize(qvec3_cross(d[1], d[2]), &n);
    t2 = qvec3_cross(n, t1);
    quat_from_axes(t1, t2, &p->frame);
    p->first[0] = qvec3_dot(d[1], d[1]), p->first[1] = qvec3_dot(d[1], d[2]), p->first[2] = qvec3_dot(d[2], d[2]);
    for (int i = 0; i < 3; i++) p->second[i] = qvec3_dot(d[3 + i], n);
    p->a = rate(p, t1, t2, n, d[3], d[4]);
    p->b = rate(p, t1, t2, n, d[4], d[5]);
    p->error = error_of(p, e, d);
    const quat_status found = quat_curvature_of_frame(p->frame, p->a, p->b, p->xu, p->xv, &p->curvature);
    return found >= 0 && is_doubtful(surface, p) ? QUAT_NOT_CONVERGED : found;
}

/* ---- a patch ---- */

quat_status quat_surface_patch(const quat_surface *surface, double u0, double u1, double v0, double v1, size_t rows,
                               size_t columns, qvec3 x[], quat q[], size_t triangles[])
{
    if (rows < 2 || columns < 2 || !(u0 < u1) || !(v0 < v1)) return QUAT_EARGUMENT;
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < columns; j++) {
            quat_surface_point p;
            const double u = i + 1 < rows ? u0 + (u1 - u0) * ((double)i / (double)(rows - 1)) : u1,
                         v = j + 1 < columns ? v0 + (v1 - v0) * ((double)j / (double)(columns - 1)) : v1;
            const quat_status status = quat_surface_at(surface, u, v, &p);
            if (status < 0) return status;
            x[i * columns + j] = p.position;
            q[i * columns + j] = p.frame;
        }
    for (size_t i = 0; i + 1 < rows; i++)
        for (size_t j = 0; j + 1 < columns; j++) {
            const size_t a = i * columns + j, corner[6] = {a, a + columns, a + columns + 1, a, a + columns + 1, a + 1};
            for (int k = 0; k < 6; k++) *triangles++ = corner[k];
        }
    return QUAT_OK;
}

/* ---- integrability ---- */

/* a along v, or b along u. */
static bool rate_along(double t, qvec3 *x, void *context)
{
    const line *l = context;
    quat_surface_point p;
    const double u = l->along_v ? l->u : t, v = l->along_v ? t : l->v;
    if (quat_surface_at(l->surface, home(u, l->surface->u0, l->surface->u1, l->surface->closed_u),
                        home(v, l->surface->v0, l->surface->v1, l->surface->closed_v), &p) < 0)
        return false;
    *x = l->along_v ? p.a : p.b;
    return true;
}

quat_status quat_surface_integrability(const quat_surface *s, double u, double v, double *residual)
{
    quat_surface_point p;
    qvec3 av, bu;
    double error;
    *residual = 0;
    const quat_status status = quat_surface_at(s, u, v, &p);
    if (status < 0) return status;
    line in_v = {s, u, v, true, 0, 0}, in_u = {s, u, v, false, 0, 0};
    if (!follow(rate_along, &in_v, 0, 1, &av, &error, NULL) || !follow(rate_along, &in_u, 0, 1, &bu, &error, NULL))
        return QUAT_EDOMAIN;
    const qvec3 r = qvec3_sub(qvec3_sub(av, bu), qvec3_cross(p.a, p.b));
    *residual = fmax(fabs(r.x), fmax(fabs(r.y), fabs(r.z)));
    return QUAT_OK;
}
