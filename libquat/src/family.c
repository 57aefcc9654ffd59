/* SPDX-License-Identifier: MIT */
#include <quat/family.h>

static const double pi = 3.14159265358979324, two_pi = 6.28318530717958648;

static bool positive(double x) { return isfinite(x) && x > 0; }

/* ---- curves ---- */

/* Adds the derivatives 0 ... 3 of size sin(w t + phase) to f; exact phases of a quarter turn by swapping. */
typedef enum wave { SINE, COSINE } wave;

static void add_wave(double size, double w, wave kind, double t, double f[4])
{
    const double s = sin(w * t), c = cos(w * t);
    const double cycle[4] = {s, c, -s, -c};
    double power = size;
    for (int k = 0; k < 4; k++, power *= w) f[k] += power * cycle[(k + (kind == COSINE)) & 3];
}

/* Leibniz. */
static void multiply(const double f[4], const double g[4], double h[4])
{
    h[0] = f[0] * g[0];
    h[1] = f[1] * g[0] + f[0] * g[1];
    h[2] = f[2] * g[0] + 2 * f[1] * g[1] + f[0] * g[2];
    h[3] = f[3] * g[0] + 3 * (f[2] * g[1] + f[1] * g[2]) + f[0] * g[3];
}

static void gather(const double x[4], const double y[4], const double z[4], qvec3 d[4])
{
    for (int k = 0; k < 4; k++) d[k] = qvec3_make(x[k], y[k], z[k]);
}

static bool ellipse(double t, qvec3 d[4], void *context)
{
    const quat_family *f = context;
    double x[4] = {0}, y[4] = {0}, z[4] = {0};
    add_wave(f->a, 1, COSINE, t, x);
    add_wave(f->b, 1, SINE, t, y);
    z[0] = f->c * t;
    z[1] = f->c;
    gather(x, y, z, d);
    return true;
}

static bool torus_knot(double t, qvec3 d[4], void *context)
{
    const quat_family *f = context;
    double ring[4] = {f->a, 0, 0, 0}, c[4] = {0}, s[4] = {0}, x[4], y[4], z[4] = {0};
    add_wave(f->b, f->d, COSINE, t, ring);
    add_wave(1, f->c, COSINE, t, c);
    add_wave(1, f->c, SINE, t, s);
    multiply(ring, c, x);
    multiply(ring, s, y);
    add_wave(-f->b, f->d, SINE, t, z);
    gather(x, y, z, d);
    return true;
}

static bool trefoil(double t, qvec3 d[4], void *context)
{
    const double a = ((const quat_family *)context)->a;
    double x[4] = {0}, y[4] = {0}, z[4] = {0};
    add_wave(a, 1, SINE, t, x);
    add_wave(2 * a, 2, SINE, t, x);
    add_wave(a, 1, COSINE, t, y);
    add_wave(-2 * a, 2, COSINE, t, y);
    add_wave(-a, 3, SINE, t, z);
    gather(x, y, z, d);
    return true;
}

static bool viviani(double t, qvec3 d[4], void *context)
{
    const double a = ((const quat_family *)context)->a;
    double x[4] = {a, 0, 0, 0}, y[4] = {0}, z[4] = {0};
    add_wave(a, 1, COSINE, t, x);
    add_wave(a, 1, SINE, t, y);
    add_wave(2 * a, 0.5, SINE, t, z);
    gather(x, y, z, d);
    return true;
}

static bool cubic(double t, qvec3 d[4], void *context)
{
    const quat_family *f = context;
    const double a = f->a, square[4] = {a * t * t, 2 * a * t, 2 * a, 0}, line[4] = {a * t, a, 0, 0}, none[4] = {0};
    const double cube[4] = {a * t * t * t, 3 * a * t * t, 6 * a * t, 6 * a};
    gather(line, f->b != 0 ? cube : square, f->b != 0 ? none : cube, d);
    return true;
}

static quat_status make_curve(quat_status status, quat_curve_function at, quat_family numbers, double start, double end,
                              bool closed, quat_family *family, quat_curve *curve)
{
    const quat_curve none = {0}, made = {at, family, start, end, closed, 3};
    *family = numbers;
    *curve = status == QUAT_OK ? made : none;
    return status;
}

static quat_family numbers(double a, double b, double c, double d, double e)
{
    const quat_family f = {a, b, c, d, e};
    return f;
}

quat_status quat_ellipse(double a, double b, quat_family *family, quat_curve *curve)
{
    return make_curve(positive(a) && positive(b) ? QUAT_OK : QUAT_EDOMAIN, ellipse, numbers(a, b, 0, 0, 0), 0, two_pi,
                      true, family, curve);
}

quat_status quat_helix(double r, double h, double turns, quat_family *family, quat_curve *curve)
{
    return make_curve(positive(r) && isfinite(h) && positive(turns) ? QUAT_OK : QUAT_EDOMAIN, ellipse,
                      numbers(r, r, h / two_pi, 0, 0), 0, two_pi * turns, false, family, curve);
}

static int common_factor(int p, int q) { return q == 0 ? p : common_factor(q, p % q); }

quat_status quat_torus_knot(double R, double r, int p, int q, quat_family *family, quat_curve *curve)
{
    const bool counts = p >= 1 && q >= 1 && p <= 1000 && q <= 1000 && common_factor(p, q) == 1;
    const quat_status status = !counts ? QUAT_EARGUMENT : positive(R) && positive(r) && r < R ? QUAT_OK : QUAT_EDOMAIN;
    return make_curve(status, torus_knot, numbers(R, r, p, q, 0), 0, two_pi, true, family, curve);
}

quat_status quat_trefoil(double a, quat_family *family, quat_curve *curve)
{
    return make_curve(positive(a) ? QUAT_OK : QUAT_EDOMAIN, trefoil, numbers(a, 0, 0, 0, 0), 0, two_pi, true, family,
                      curve);
}

quat_status quat_viviani(double a, quat_family *family, quat_curve *curve)
{
    return make_curve(positive(a) ? QUAT_OK : QUAT_EDOMAIN, viviani, numbers(a, 0, 0, 0, 0), 0, 2 * two_pi, true,
                      family, curve);
}

quat_status quat_cubic(double a, bool planar, quat_family *family, quat_curve *curve)
{
    return make_curve(positive(a) ? QUAT_OK : QUAT_EDOMAIN, cubic, numbers(a, planar, 0, 0, 0), -1, 1, false, family,
                      curve);
}

/* ---- surfaces: each coordinate a sum of products f(u) g(v) ---- */

/* Value, first and second derivative. */
typedef struct jet {
    double v[3];
} jet;

static jet constant(double c)
{
    const jet j = {{c, 0, 0}};
    return j;
}
static jet linear(double slope, double t)
{
    const jet j = {{slope * t, slope, 0}};
    return j;
}
static jet sine(double size, double t)
{
    const double s = size * sin(t), c = size * cos(t);
    const jet j = {{s, c, -s}};
    return j;
}
static jet cosine(double size, double t)
{
    const double s = size * sin(t), c = size * cos(t);
    const jet j = {{c, -s, -c}};
    return j;
}

/* sign(w) |w|^e of a wave w with w'' = -w. */
static jet power_of(jet w, double e)
{
    const double x = w.v[0], size = fabs(x), top = copysign(pow(size, e), x);
    if (x == 0) {
        const jet flat = {{0, e == 1 ? w.v[1] : 0, e < 2 && e != 1 ? NAN : e == 2 ? NAN : 0}};
        return flat;
    }
    const double slope = e * top / x;
    const jet j = {{top, slope * w.v[1], (e - 1) * slope / x * w.v[1] * w.v[1] + slope * w.v[2]}};
    return j;
}

static jet sum_of(jet f, jet g)
{
    const jet j = {{f.v[0] + g.v[0], f.v[1] + g.v[1], f.v[2] + g.v[2]}};
    return j;
}

/* One coordinate f(u) g(v), in the order x, x_u, x_v, x_uu, x_uv, x_vv. */
static void product(jet f, jet g, double out[6])
{
    static const int in_u[6] = {0, 1, 0, 2, 1, 0}, in_v[6] = {0, 0, 1, 0, 1, 2};
    for (int i = 0; i < 6; i++) out[i] = f.v[in_u[i]] * g.v[in_v[i]];
}

static bool spread(jet xu, jet xv, jet yu, jet yv, jet zu, jet zv, qvec3 d[6])
{
    double x[6], y[6], z[6];
    product(xu, xv, x);
    product(yu, yv, y);
    product(zu, zv, z);
    for (int i = 0; i < 6; i++) d[i] = qvec3_make(x[i], y[i], z[i]);
    return true;
}

static bool plane(double u, double v, qvec3 d[6], void *context)
{
    (void)context;
    return spread(linear(1, u), constant(1), constant(1), linear(1, v), constant(0), constant(0), d);
}

static bool ellipsoid(double u, double v, qvec3 d[6], void *context)
{
    const quat_family *f = context;
    return spread(cosine(f->a, u), cosine(1, v), sine(f->b, u), cosine(1, v), constant(1), sine(f->c, v), d);
}

static bool torus(double u, double v, qvec3 d[6], void *context)
{
    const quat_family *f = context;
    const jet ring = sum_of(constant(f->a), cosine(f->b, v));
    return spread(cosine(1, u), ring, sine(1, u), ring, constant(1), sine(f->b, v), d);
}

static bool saddle(double u, double v, qvec3 d[6], void *context)
{
    const double a = ((const quat_family *)context)->a;
    spread(linear(1, u), constant(1), constant(1), linear(1, v), constant(0), constant(0), d);
    d[0].z = (u - v) * (u + v) / (2 * a);
    d[1].z = u / a, d[2].z = -v / a;
    d[3].z = 1 / a, d[4].z = 0, d[5].z = -1 / a;
    return true;
}

static bool catenoid(double u, double v, qvec3 d[6], void *context)
{
    const double a = ((const quat_family *)context)->a, c = cosh(v / a), s = sinh(v / a);
    const jet ring = {{a * c, s, c / a}};
    return spread(cosine(1, u), ring, sine(1, u), ring, constant(1), linear(1, v), d);
}

static bool helicoid(double u, double v, qvec3 d[6], void *context)
{
    const double a = ((const quat_family *)context)->a;
    return spread(cosine(1, u), linear(1, v), sine(1, u), linear(1, v), linear(a, u), constant(1), d);
}

static bool superellipsoid(double u, double v, qvec3 d[6], void *context)
{
    const quat_family *f = context;
    const jet ring = power_of(cosine(1, v), f->d), height = power_of(sine(1, v), f->d);
    const jet x = power_of(cosine(1, u), f->e), y = power_of(sine(1, u), f->e), c = constant(f->c);
    jet ax = x, by = y;
    for (int i = 0; i < 3; i++) ax.v[i] *= f->a, by.v[i] *= f->b;
    return spread(ax, ring, by, ring, c, height, d);
}

static quat_status make_surface(quat_status status, quat_surface_function at, quat_family given, quat_surface ranges,
                                quat_family *family, quat_surface *surface)
{
    const quat_surface none = {0};
    *family = given;
    *surface = status == QUAT_OK ? ranges : none;
    if (status != QUAT_OK) return status;
    surface->at = at;
    surface->context = family;
    surface->known = 2;
    return status;
}

static quat_surface ranges(double u0, double u1, double v0, double v1, bool closed_u, bool closed_v)
{
    const quat_surface s = {.u0 = u0, .u1 = u1, .v0 = v0, .v1 = v1, .closed_u = closed_u, .closed_v = closed_v};
    return s;
}

quat_status quat_plane(double a, double b, quat_family *family, quat_surface *surface)
{
    return make_surface(positive(a) && positive(b) ? QUAT_OK : QUAT_EDOMAIN, plane, numbers(a, b, 0, 0, 0),
                        ranges(-a, a, -b, b, false, false), family, surface);
}

quat_status quat_ellipsoid(double a, double b, double c, quat_family *family, quat_surface *surface)
{
    return make_surface(positive(a) && positive(b) && positive(c) ? QUAT_OK : QUAT_EDOMAIN, ellipsoid,
                        numbers(a, b, c, 0, 0), ranges(0, two_pi, -pi / 2, pi / 2, true, false), family, surface);
}

quat_status quat_torus(double R, double r, quat_family *family, quat_surface *surface)
{
    return make_surface(positive(R) && positive(r) && r < R ? QUAT_OK : QUAT_EDOMAIN, torus, numbers(R, r, 0, 0, 0),
                        ranges(0, two_pi, 0, two_pi, true, true), family, surface);
}

quat_status quat_saddle(double a, double size, quat_family *family, quat_surface *surface)
{
    return make_surface(positive(a) && positive(size) ? QUAT_OK : QUAT_EDOMAIN, saddle, numbers(a, 0, 0, 0, 0),
                        ranges(-size, size, -size, size, false, false), family, surface);
}

quat_status quat_catenoid(double a, double height, quat_family *family, quat_surface *surface)
{
    return make_surface(positive(a) && positive(height) ? QUAT_OK : QUAT_EDOMAIN, catenoid, numbers(a, 0, 0, 0, 0),
                        ranges(0, two_pi, -height, height, true, false), family, surface);
}

quat_status quat_helicoid(double a, double turns, double width, quat_family *family, quat_surface *surface)
{
    return make_surface(positive(a) && positive(turns) && positive(width) ? QUAT_OK : QUAT_EDOMAIN, helicoid,
                        numbers(a, 0, 0, 0, 0), ranges(-pi * turns, pi * turns, -width, width, false, false), family,
                        surface);
}

quat_status quat_superellipsoid(double a, double b, double c, double e, double f, quat_family *family,
                                quat_surface *surface)
{
    const bool good = positive(a) && positive(b) && positive(c) && e >= 0.05 && e <= 4 && f >= 0.05 && f <= 4;
    return make_surface(good ? QUAT_OK : QUAT_EDOMAIN, superellipsoid, numbers(a, b, c, e, f),
                        ranges(0, two_pi, -pi / 2, pi / 2, true, false), family, surface);
}
