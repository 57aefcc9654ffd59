/* SPDX-License-Identifier: MIT
 *
 * The room surface against the classical formulas (LN - M^2)/(EG - F^2) ... in quadruple precision and against closed
 * forms, neither of which knows of frames.
 */
#include "oracle.h"

#include <quat/family.h>
#include <quat/rotation.h>
#include "handler.h"
#include "kit/near.h"

static const double pi = 3.14159265358979324;

/* ---- the oracle ---- */

static wquat xyz(wide x, wide y, wide z) { return (wquat){0, x, y, z}; }

typedef struct classical {
    wide K, H; /* H with the sign of dN */
    wquat normal;
} classical;

/* From x_u, x_v, x_uu, x_uv, x_vv. */
static classical from_derivatives(wquat u, wquat v, wquat uu, wquat uv, wquat vv)
{
    const wquat n = wide_unit(wide_cross(u, v));
    const wide E = wide_dot(u, u), F = wide_dot(u, v), G = wide_dot(v, v), L = wide_dot(uu, n), M = wide_dot(uv, n),
               N = wide_dot(vv, n), g = E * G - F * F;
    return (classical){(L * N - M * M) / g, -(E * N - 2 * F * M + G * L) / (2 * g), n};
}

static classical wide_ellipsoid(wide a, wide b, wide c, wide u, wide v)
{
    const wide cu = cosf128(u), su = sinf128(u), cv = cosf128(v), sv = sinf128(v);
    return from_derivatives(xyz(-a * cv * su, b * cv * cu, 0), xyz(-a * sv * cu, -b * sv * su, c * cv),
                            xyz(-a * cv * cu, -b * cv * su, 0), xyz(a * sv * su, -b * sv * cu, 0),
                            xyz(-a * cv * cu, -b * cv * su, -c * sv));
}

/* K = a^2 b^2 c^2/(...)^2, from the implicit equation: another road. */
static wide ellipsoid_gauss(wide a, wide b, wide c, wide u, wide v)
{
    const wide x = cosf128(v) * cosf128(u) / a, y = cosf128(v) * sinf128(u) / b, z = sinf128(v) / c,
               s = x * x + y * y + z * z;
    return 1 / (a * a * b * b * c * c * s * s);
}

static double off(double got, wide want, wide scale) { return (double)(fabsf128((wide)got - want) / scale); }

/* The worst of K and of H, against the size of the curvatures there. */
static void judge(const quat_surface_point *p, classical want, double worst[3])
{
    const quat_curvature *c = &p->curvature;
    const wide k = fmaxf128(fabsf128(c->principal[0]), fabsf128(c->principal[1]));
    worse(&worst[0], off(c->gauss, want.K, k * k));
    worse(&worst[1], off(c->mean, want.H, k));
    worse(&worst[2], (double)wide_norm(wide_sub(wide_vec(quat_rotate(p->frame, qvec3_make(0, 0, 1))), want.normal)));
}

/* ---- at a point ---- */

static void ellipsoids_in_quad(void **state)
{
    (void)state;
    random_state r = {401};
    double worst[3] = {0}, closed = 0;
    for (int round = 0; round < 30000; round++) {
        const double a = random_scale(&r, -2, 2), b = a * random_between(&r, 0.3, 3),
                     c = a * random_between(&r, 0.3, 3);
        const double u = random_between(&r, 0, 2 * pi), v = random_between(&r, -1.57, 1.57);
        quat_family family;
        quat_surface s;
        quat_surface_point p;
        assert_int_equal(quat_ellipsoid(a, b, c, &family, &s), QUAT_OK);
        assert_true(quat_surface_at(&s, u, v, &p) >= 0);
        judge(&p, wide_ellipsoid(a, b, c, u, v), worst);
        worse(&closed, off(p.curvature.gauss, ellipsoid_gauss(a, b, c, u, v), ellipsoid_gauss(a, b, c, u, v)));
    }
    assert_bound("ellipsoid: K", worst[0], 4e-15);
    assert_bound("ellipsoid: H", worst[1], 3e-15);
    assert_bound("ellipsoid: normal", worst[2], 2e-15);
    assert_bound("ellipsoid: K relative, closed form", closed, 5e-15);
}

static bool veil(double u, double v, qvec3 d[6], void *context)
{
    const quat_surface *inner = context;
    return inner->at(u, v, d, inner->context);
}

/* Ever closer to the pole of the angles, where they degenerate: right to the last digit with derivatives known; with
 * fewer known the word comes before the value is worthless. */
static void beside_the_pole(void **state)
{
    (void)state;
    random_state r = {413};
    double worst[3] = {0}, told = 0, honest = 0;
    size_t doubtful = 0;
    for (int round = 0; round < 30000; round++) {
        const double a = random_between(&r, 0.3, 3), b = random_between(&r, 0.3, 3), c = random_between(&r, 0.3, 3),
                     u = random_between(&r, 0, 2 * pi), v = (round % 2 ? 1 : -1) * (pi / 2 - random_scale(&r, -14, -1));
        quat_family family;
        quat_surface s;
        quat_surface_point p;
        assert_int_equal(quat_ellipsoid(a, b, c, &family, &s), QUAT_OK);
        quat_surface poorer = s;
        poorer.at = veil, poorer.context = &s, poorer.known = round % 30 ? 2 : round / 30 % 2;
        const quat_status status = quat_surface_at(&poorer, u, v, &p);
        const classical want = wide_ellipsoid(a, b, c, u, v);
        if (poorer.known == 2) {
            assert_true(status >= 0);
            judge(&p, want, worst);
            continue;
        }
        doubtful += status == QUAT_NOT_CONVERGED;
        if (status < 0) continue;
        worse(&honest, off(p.curvature.mean, want.H, p.error));
        if (status == QUAT_OK) worse(&told, off(p.curvature.mean, want.H, fabsf128(want.H)));
    }
    assert_true(doubtful > 50);
    assert_bound("to 1e-14 from a pole: K", worst[0], 4e-15);
    assert_bound("to 1e-14 from a pole: H", worst[1], 3e-15);
    assert_bound("to 1e-14 from a pole: normal", worst[2], 2e-15);
    assert_bound("with fewer derivatives: H, where it is called ok", told, 3e-4);
    assert_bound("its error by the estimate", honest, 1);
}

/* What the thesis prints for K and H, and where it holds. With unit and perpendicular tangents along T1 and T2 a_x b_y
 * - a_y b_x is K and (a_y - b_x)/2 is H; with others the first is K sqrt(EG - F^2), and the second is nothing: it
 * changes with the frame's angle about N, and K and H do not. II/I gives -H. */
static void what_the_thesis_prints_for_curvature(void **state)
{
    (void)state;
    random_state r = {414};
    double product = 0, unit = 0, second = 0, changed = 0;
    for (int round = 0; round < 100000; round++) {
        quat_family f;
        quat_surface s;
        quat_surface_point p;
        quat_ellipsoid(1, 2, 1.5, &f, &s);
        assert_true(quat_surface_at(&s, random_between(&r, 0, 2 * pi), random_between(&r, -1.4, 1.4), &p) >= 0);
        quat q = p.frame;
        qvec3 a = p.a, b = p.b;
        quat_regauge(random_between(&r, -9, 9), random_between(&r, -3, 3), random_between(&r, -3, 3), &q, &a, &b);
        const double K = p.curvature.gauss, H = p.curvature.mean, E = p.first[0], F = p.first[1], G = p.first[2];
        worse(&product, fabs((a.x * b.y - a.y * b.x) / (K * sqrt(E * G - F * F)) - 1));
        worse(&second, fabs((E * p.second[2] - 2 * F * p.second[1] + G * p.second[0]) / (2 * (E * G - F * F)) + H));
        worse(&changed, fabs((a.y - b.x) / 2 - H));
        /* rates along T1 and T2 themselves: x_u = sqrt(E) T1, x_v = F/sqrt(E) T1 + sqrt(EG - F^2)/sqrt(E) T2 */
        const double e = sqrt(E), g = sqrt(E * G - F * F) / e;
        const qvec3 by_1 = qvec3_scale(p.a, 1 / e), by_2 = qvec3_scale(qvec3_axpy(-F / e, by_1, p.b), 1 / g);
        worse(&unit, fabs(by_1.x * by_2.y - by_1.y * by_2.x - K));
        worse(&unit, fabs((by_1.y - by_2.x) / 2 - H));
    }
    assert_bound("a_x b_y - a_y b_x is K sqrt(EG - F^2)", product, 4e-15);
    assert_bound("and K, H for unit tangents", unit, 6e-15);
    assert_bound("II/I is -H", second, 3e-15);
    assert_true(changed > 1);
}

static void closed_forms(void **state)
{
    (void)state;
    random_state r = {402};
    double torus = 0, sphere = 0, minimal = 0, saddle = 0, flat = 0, directions = 0;
    for (int round = 0; round < 20000; round++) {
        quat_family f;
        quat_surface s;
        quat_surface_point p;
        const double R = random_scale(&r, -2, 2), small = R * random_between(&r, 0.05, 0.8),
                     u = random_between(&r, 0, 2 * pi), v = random_between(&r, 0, 2 * pi),
                     w = random_between(&r, -1, 1);
        assert_int_equal(quat_torus(R, small, &f, &s), QUAT_OK);
        assert_true(quat_surface_at(&s, u, v, &p) >= 0);
        const wide ring = R + small * cosf128(v), k1 = 1 / (wide)small, k2 = cosf128(v) / ring;
        worse(&torus, off(p.curvature.gauss, k1 * k2, k1 * k1));
        worse(&torus, off(p.curvature.mean, (k1 + k2) / 2, k1));
        worse(&torus, off(p.curvature.principal[0], k1, k1));
        worse(&torus, off(p.curvature.principal[1], k2, k1));
        /* the meridian is the direction of most curvature */
        const qvec3 meridian = {-sin(v) * cos(u), -sin(v) * sin(u), cos(v)};
        worse(&directions, 1 - fabs(qvec3_dot(meridian, p.curvature.direction[0])));
        worse(&directions, fabs(qvec3_dot(meridian, p.curvature.direction[1])));

        quat_ellipsoid(R, R, R, &f, &s);
        assert_true(quat_surface_at(&s, u, 1.5 * w, &p) >= 0);
        worse(&sphere, fabs(p.curvature.gauss * R * R - 1));
        worse(&sphere, fabs(p.curvature.mean * R - 1)); /* positive: the normal is outward */

        quat_catenoid(R, 2 * R, &f, &s);
        assert_true(quat_surface_at(&s, u, w * R, &p) >= 0);
        const wide c = coshl(w), k = 1 / ((wide)R * c * c);
        worse(&minimal, off(p.curvature.gauss, -k * k, k * k));
        worse(&minimal, off(p.curvature.mean, 0, k));
        quat_helicoid(R, 1, 2 * R, &f, &s);
        assert_true(quat_surface_at(&s, u - pi, w * R, &p) >= 0);
        const wide kh = (wide)R / ((wide)R * R + (wide)(w * R) * (w * R));
        worse(&minimal, off(p.curvature.gauss, -kh * kh, kh * kh));
        worse(&minimal, off(p.curvature.mean, 0, kh));

        quat_saddle(R, 2 * R, &f, &s);
        assert_true(quat_surface_at(&s, w * R, (u / pi - 1) * R, &p) >= 0);
        const wide x = w, y = (wide)((u / pi - 1) * R) / R, q = 1 + x * x + y * y;
        worse(&saddle, off(p.curvature.gauss, -1 / ((wide)R * R * q * q), 1 / ((wide)R * R * q * q)));
        worse(&saddle, off(p.curvature.mean, (x * x - y * y) / (2 * R * q * sqrtf128(q)), 1 / (R * q)));

        quat_plane(R, R, &f, &s);
        assert_int_equal(quat_surface_at(&s, w * R, 0.5 * R, &p), QUAT_NOT_UNIQUE);
        worse(&flat, fabs(p.curvature.gauss) + fabs(p.curvature.mean));
    }
    assert_bound("torus", torus, 1e-14);
    assert_bound("torus: principal directions", directions, 2e-15);
    assert_bound("sphere", sphere, 5e-15);
    assert_bound("catenoid and helicoid", minimal, 5e-15);
    assert_bound("saddle", saddle, 4e-15);
    assert_bound("plane", flat, 0);
}

/* sign(w) |w|^e and its derivatives, for w'' = -w. */
static void wide_power(wide w, wide slope, wide e, wide out[3])
{
    const wide size = fabsf128(w), top = expf128(e * logf128(size)) * (w < 0 ? -1 : 1);
    out[0] = top;
    out[1] = e * top / w * slope;
    out[2] = e * (e - 1) * top / (w * w) * slope * slope - e * top;
}

static void superellipsoids_in_quad(void **state)
{
    (void)state;
    random_state r = {408};
    double worst[3] = {0};
    for (int round = 0; round < 20000; round++) {
        const double a = random_between(&r, 0.5, 2), b = random_between(&r, 0.5, 2), c = random_between(&r, 0.5, 2),
                     e = random_between(&r, 0.1, 3), f = random_between(&r, 0.1, 3), u = random_between(&r, 0, 2 * pi),
                     v = random_between(&r, -1.5, 1.5);
        quat_family family;
        quat_surface s;
        quat_surface_point p;
        wide cu[3], su[3], cv[3], sv[3];
        wide_power(cosf128(u), -sinf128(u), f, cu);
        wide_power(sinf128(u), cosf128(u), f, su);
        wide_power(cosf128(v), -sinf128(v), e, cv);
        wide_power(sinf128(v), cosf128(v), e, sv);
        assert_int_equal(quat_superellipsoid(a, b, c, e, f, &family, &s), QUAT_OK);
        assert_true(quat_surface_at(&s, u, v, &p) >= 0);
        /* near a seam the angles of doubles no longer say where they are: a cosine has lost its digits */
        if (fabs(sin(2 * u)) < 0.02 || fabs(sin(2 * v)) < 0.02) continue;
        judge(&p,
              from_derivatives(
                  xyz(a * cv[0] * cu[1], b * cv[0] * su[1], 0), xyz(a * cv[1] * cu[0], b * cv[1] * su[0], c * sv[1]),
                  xyz(a * cv[0] * cu[2], b * cv[0] * su[2], 0), xyz(a * cv[1] * cu[1], b * cv[1] * su[1], 0),
                  xyz(a * cv[2] * cu[0], b * cv[2] * su[0], c * sv[2])),
              worst);
    }
    assert_bound("superellipsoid: K", worst[0], 1e-13);
    assert_bound("superellipsoid: H", worst[1], 1e-13);
    assert_bound("superellipsoid: normal", worst[2], 2e-15);
}

/* The thesis' equations 23 and 24 as they should read, for unit and perpendicular tangents: the part along N of q_u
 * (1/q)_v is -K/4, that of q (0, x) (1/q)_u + q (0, y) (1/q)_v is -H. */
static void equations_23_and_24(void **state)
{
    (void)state;
    random_state r = {409};
    double worst = 0;
    for (int round = 0; round < 100000; round++) {
        quat_family f;
        quat_surface s;
        quat_surface_point p;
        quat_torus(2, 1, &f, &s);
        const double v = random_between(&r, 0, 2 * pi), u = random_between(&r, 0, 2 * pi);
        assert_true(quat_surface_at(&s, u, v, &p) >= 0);
        quat q = p.frame;
        qvec3 a = qvec3_scale(p.a, 1 / qvec3_norm(p.xu)), b = qvec3_scale(p.b, 1 / qvec3_norm(p.xv));
        const qvec3 n = quat_rotate(q, qvec3_make(0, 0, 1));
        const quat qu = quat_scale(quat_mul(q, quat_pure(a)), 0.5), qv = quat_scale(quat_mul(q, quat_pure(b)), 0.5);
        const quat k = quat_mul(qu, quat_conj(qv)),
                   h = quat_add(quat_mul(quat_mul(q, quat_make(0, 1, 0, 0)), quat_conj(qu)),
                                quat_mul(quat_mul(q, quat_make(0, 0, 1, 0)), quat_conj(qv)));
        worse(&worst, fabs(qvec3_dot(quat_vector(k), n) + p.curvature.gauss / 4));
        worse(&worst, fabs(qvec3_dot(quat_vector(h), n) + p.curvature.mean));
    }
    assert_bound("equations 23 and 24", worst, 4e-15);
}

/* ---- invariance ---- */

typedef struct sheared {
    quat_surface inner;
    quat turn;
    qvec3 shift;
    double m[2][2], wobble; /* the torus' angles: m (s, t), and a ripple on the first */
} sheared;

static bool shear(double s, double t, qvec3 d[6], void *context)
{
    const sheared *g = context;
    qvec3 x[6];
    const double(*const m)[2] = g->m, u = m[0][0] * s + m[0][1] * t + g->wobble * sin(s), v = m[1][0] * s + m[1][1] * t;
    const double us = m[0][0] + g->wobble * cos(s), ut = m[0][1], vs = m[1][0], vt = m[1][1], uss = -g->wobble * sin(s);
    g->inner.at(u, v, x, g->inner.context);
    d[0] = x[0];
    d[1] = qvec3_axpy(us, x[1], qvec3_scale(x[2], vs));
    d[2] = qvec3_axpy(ut, x[1], qvec3_scale(x[2], vt));
    d[3] = qvec3_axpy(uss, x[1], qvec3_axpy(us * us, x[3], qvec3_axpy(2 * us * vs, x[4], qvec3_scale(x[5], vs * vs))));
    d[4] = qvec3_axpy(us * ut, x[3], qvec3_axpy(us * vt + ut * vs, x[4], qvec3_scale(x[5], vs * vt)));
    d[5] = qvec3_axpy(ut * ut, x[3], qvec3_axpy(2 * ut * vt, x[4], qvec3_scale(x[5], vt * vt)));
    for (int i = 0; i < 6; i++) d[i] = quat_rotate(g->turn, d[i]);
    d[0] = qvec3_add(d[0], g->shift);
    return true;
}

static void nothing_depends_on_place_parameter_or_gauge(void **state)
{
    (void)state;
    random_state r = {403};
    double worst = 0, gauge = 0, asymmetry = 0, direction = 0;
    for (int round = 0; round < 100000; round++) {
        quat_family f;
        sheared g = {.turn = random_unit(&r),
                     .shift = random_direction(&r),
                     .wobble = random_between(&r, -0.3, 0.3),
                     .m = {{1, random_between(&r, -0.5, 0.5)}, {random_between(&r, -0.5, 0.5), 1}}};
        quat_surface_point here, there;
        quat_torus(2, 1, &f, &g.inner);
        const quat_surface s = {shear, &g, -10, 10, -10, 10, false, false, 2};
        const double t1 = random_between(&r, 0, 6), t2 = random_between(&r, 0, 6);
        assert_true(quat_surface_at(&s, t1, t2, &there) >= 0);
        quat_surface inner = g.inner;
        assert_true(quat_surface_at(&inner, g.m[0][0] * t1 + g.m[0][1] * t2 + g.wobble * sin(t1),
                                    g.m[1][0] * t1 + g.m[1][1] * t2, &here) >= 0);
        const quat_curvature *a = &here.curvature, *b = &there.curvature;
        worse(&worst, fabs(a->gauss - b->gauss));
        worse(&worst, fabs(a->mean - b->mean));
        worse(&asymmetry, b->asymmetry);
        worse(&direction, 1 - fabs(qvec3_dot(quat_rotate(g.turn, a->direction[0]), b->direction[0])));
        /* any angle about the normal, varying at any rate */
        quat_curvature c;
        quat q = there.frame;
        qvec3 ra = there.a, rb = there.b;
        const double dv = random_between(&r, -3, 3), du = random_between(&r, -3, 3), angle = random_between(&r, -9, 9);
        quat_regauge(angle, du, dv, &q, &ra, &rb);
        assert_true(quat_curvature_of_frame(q, ra, rb, there.xu, there.xv, &c) >= 0);
        worse(&gauge, fabs(b->gauss - c.gauss));
        worse(&gauge, fabs(b->mean - c.mean));
        worse(&gauge, 1 - fabs(qvec3_dot(b->direction[0], c.direction[0])));
        worse(&gauge, fabs(c.asymmetry));
    }
    assert_bound("K and H after motion and new parameters", worst, 8e-15);
    assert_bound("principal direction", direction, 3e-15);
    assert_bound("asymmetry of dN", asymmetry, 2e-15);
    assert_bound("K, H, direction in another gauge", gauge, 5e-15);
}

/* q_u = q (0, a)/2 by differences of the frame itself. */
static void rates_are_the_frames(void **state)
{
    (void)state;
    random_state r = {404};
    double rates = 0, integrable = 0;
    for (int round = 0; round < 2000; round++) {
        quat_family f;
        quat_surface s;
        quat_surface_point p, before, after;
        const double u = random_between(&r, 0.5, 5.5), v = random_between(&r, -1.2, 1.2), h = 1e-5;
        quat_ellipsoid(1, 2, 1.5, &f, &s);
        quat_surface_at(&s, u, v, &p);
        for (int along_v = 0; along_v < 2; along_v++) {
            quat_surface_at(&s, along_v ? u : u - h, along_v ? v - h : v, &before);
            quat_surface_at(&s, along_v ? u : u + h, along_v ? v + h : v, &after);
            const quat slope =
                quat_scale(quat_sub(quat_nearest(after.frame, p.frame), quat_nearest(before.frame, p.frame)), 0.5 / h);
            worse(&rates, qvec3_norm(qvec3_sub(quat_omega_body(p.frame, slope), along_v ? p.b : p.a)));
        }
        double residual;
        if (round % 20 == 0) {
            assert_int_equal(quat_surface_integrability(&s, u, v, &residual), QUAT_OK);
            worse(&integrable, residual);
        }
    }
    assert_bound("rates against differences", rates, 1e-9);
    assert_bound("a_v - b_u - a x b", integrable, 1e-10);
}

/* ---- differences ---- */

static void fewer_derivatives(void **state)
{
    (void)state;
    const double bar[2] = {5e-11, 3e-14};
    for (int known = 1; known >= 0; known--) {
        double worst = 0, honest = 0;
        for (int which = 0; which < 3; which++) {
            quat_family f;
            quat_surface s;
            if (which == 0) quat_torus(2, 1, &f, &s);
            if (which == 1) quat_ellipsoid(1, 2, 1.5, &f, &s);
            if (which == 2) quat_saddle(1, 1, &f, &s);
            quat_surface poorer = s;
            poorer.at = veil, poorer.context = &s, poorer.known = known;
            for (int i = 0; i <= 20; i++)
                for (int j = 0; j <= 10; j++) {
                    quat_surface_point full, p;
                    const double u = fmin(s.u0 + (s.u1 - s.u0) * i / 20, s.u1),
                                 v = s.v0 + (s.v1 - s.v0) * (0.05 + 0.09 * j);
                    assert_true(quat_surface_at(&s, u, v, &full) >= 0 && quat_surface_at(&poorer, u, v, &p) >= 0);
                    const double off_k = fabs(p.curvature.gauss - full.curvature.gauss),
                                 off_h = fabs(p.curvature.mean - full.curvature.mean);
                    worse(&worst, fmax(off_k, off_h));
                    worse(&honest, off_h / (p.error + full.error));
                }
        }
        char name[80];
        snprintf(name, sizeof name, "K and H, derivatives known to order %d", known);
        assert_bound(name, worst, bar[known]);
        assert_bound("error by its estimate", honest, 3);
    }
}

/* ---- bad input ---- */

static bool nowhere(double u, double v, qvec3 d[6], void *context)
{
    (void)u, (void)v, (void)d, (void)context;
    return false;
}
static bool a_line(double u, double v, qvec3 d[6], void *context)
{
    (void)context;
    d[0] = qvec3_make(u + v, 0, 0);
    d[1] = d[2] = qvec3_make(1, 0, 0);
    d[3] = d[4] = d[5] = qvec3_make(0, 0, 0);
    return true;
}

static void bad_input_has_a_status(void **state)
{
    (void)state;
    quat_family f;
    quat_surface s;
    quat_surface_point p;
    quat_surface_totals t;
    double residual;
    const quat_surface none = {nowhere, NULL, 0, 1, 0, 1, false, false, 2},
                       thin = {a_line, NULL, 0, 1, 0, 1, false, false, 2},
                       guessed = {a_line, NULL, 0, 1, 0, 1, false, false, 0}, empty = {0};
    quat_curvature c;
    const qvec3 x = {1, 0, 0}, y = {0, 1, 0}, wild = {0, 1e308, 0}, tiny = {1e-120, 0, 0};
    assert_int_equal(quat_curvature_of_frame(quat_make(0, 0, 0, 0), x, y, x, y, &c), QUAT_EDOMAIN);
    assert_int_equal(quat_curvature_of_frame(quat_identity(), x, y, x, x, &c), QUAT_EDOMAIN);
    assert_int_equal(quat_curvature_of_frame(quat_identity(), wild, wild, tiny, qvec3_scale(y, 1e-120), &c),
                     QUAT_ERANGE);
    assert_true(c.gauss == 0 && c.mean == 0 && c.principal[0] == 0);
    assert_int_equal(quat_surface_at(&none, 0.5, 0.5, &p), QUAT_EDOMAIN);
    assert_int_equal(quat_surface_at(&thin, 0.5, 0.5, &p), QUAT_EDOMAIN);
    assert_near3(p.position, qvec3_make(1, 0, 0), 0);
    assert_int_equal(quat_surface_at(&guessed, 0.5, 0.5, &p), QUAT_EDOMAIN);
    assert_int_equal(quat_surface_at(&empty, 0.5, 0.5, &p), QUAT_EARGUMENT);
    assert_int_equal(quat_surface_at(&thin, 0.5, 1.5, &p), QUAT_EDOMAIN);
    assert_int_equal(quat_surface_at(&thin, NAN, 0.5, &p), QUAT_EDOMAIN);
    assert_int_equal(quat_surface_integrability(&none, 0.5, 0.5, &residual), QUAT_EDOMAIN);
    assert_int_equal(quat_surface_total(&none, 1e-10, &t), QUAT_EDOMAIN);
    assert_int_equal(quat_surface_total(&none, 0, &t), QUAT_EARGUMENT);
    quat_ellipsoid(1, 1, 1, &f, &s);
    assert_int_equal(quat_surface_at(&s, 1, pi / 2, &p), QUAT_EDOMAIN); /* the pole */
    assert_near3(p.position, qvec3_make(0, 0, 1), 1e-16);
    assert_true(quat_surface_at(&s, 1, pi / 2 - 1e-6, &p) >= 0);
    assert_near(p.curvature.gauss, 1, 1e-13);
    assert_int_equal(quat_superellipsoid(1, 1, 1, 0.5, 0.5, &f, &s), QUAT_OK);
    assert_int_equal(quat_surface_at(&s, 1, 0, &p), QUAT_EDOMAIN); /* no second derivative on the equator */
    assert_true(quat_surface_at(&s, 1, 0.5, &p) >= 0);
    assert_int_equal(quat_superellipsoid(1, 1, 1, 0, 1, &f, &s), QUAT_EDOMAIN);
    assert_int_equal(quat_surface_at(&s, 1, 0.5, &p), QUAT_EARGUMENT);

    for (double size = 1e-300; size < 1e301; size *= 1e25) { /* a value or a status at every size */
        quat_ellipsoid(size, size, size, &f, &s);
        const quat_status status = quat_surface_at(&s, 1, 0.5, &p);
        assert_true(status >= 0 || status == QUAT_ERANGE || status == QUAT_EDOMAIN);
        if (status >= 0) assert_near(p.curvature.mean * size, 1, 1e-14);
        if (size > 1e-90 && size < 1e90) assert_true(status >= 0);
        assert_true(isfinite(p.curvature.gauss) && isfinite(p.area) && isfinite(p.error));
    }
    quat_ellipsoid(1, 1, 1, &f, &s);
    assert_int_equal(quat_surface_patch(&s, 0, 1, 0, 1, 1, 2, NULL, NULL, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_surface_patch(&s, 0, 1, 1, 1, 2, 2, NULL, NULL, NULL), QUAT_EARGUMENT);

    assert_int_equal(handled, 0);
}

/* ---- units, and parameters that run nearly together ---- */

/* A point of a torus of radii 3 and 1, |x_u| and |x_v| of units of their own, x_v sheared towards x_u. */
typedef struct skewed {
    double length, along_u, along_v, angle;
} skewed;

static bool at_skewed(double u, double v, qvec3 d[6], void *context)
{
    const skewed *const s = context;
    (void)u, (void)v;
    /* of the torus at its outermost circle: x_u = (0, 4, 0), x_v = (0, 0, 1), x_uu = (-4, 0, 0), x_vv = (-1, 0, 0) */
    const double c = cos(s->angle), w = sin(s->angle), uu = s->along_u * s->along_u, uv = s->along_u * s->along_v,
                 vv = s->along_v * s->along_v;
    const qvec3 unit[6] = {{4, 0, 0},       {0, 4 * s->along_u, 0}, {0, 4 * c * s->along_v, w * s->along_v},
                           {-4 * uu, 0, 0}, {-4 * c * uv, 0, 0},    {-(4 * c * c + w * w) * vv, 0, 0}};
    for (int i = 0; i < 6; i++) d[i] = qvec3_scale(unit[i], s->length);
    return true;
}

static void units_change_units_alone(void **state)
{
    (void)state;
    random_state r = {419};
    int answered = 0;
    for (int round = 0; round < 20000; round++) {
        const double rate = random_scale(&r, -100, 60);
        skewed s = {random_scale(&r, -99, 99), rate, rate * random_scale(&r, -8, 8), pi / 2};
        const quat_surface surface = {at_skewed, &s, 0, 1, 0, 1, false, false, 2};
        const double u = s.length * s.along_u, v = s.length * s.along_v, most = 8 * fmax(s.along_u, s.along_v);
        quat_surface_point p;
        const quat_status status = quat_surface_at(&surface, 0.5, 0.5, &p);
        if (fmin(u, v) < 1.01e-100 || s.length * fmax(most, most * most) > 0.99e100) continue;
        if (fmin(u * s.along_u, v * s.along_v) < 1e-307) continue; /* no normal doubles */
        answered++;
        assert_true(status == QUAT_OK);
        assert_near(p.curvature.principal[0] * s.length, 1, 4e-15);
        assert_near(p.curvature.principal[1] * s.length, 0.25, 4e-15);
        assert_near(p.curvature.gauss * s.length * s.length, 0.25, 4e-15);
        assert_true(p.error * s.length < 1e-14);
    }
    assert_true(answered > 5000);
}

/* Rates and tangents of any size that doubles hold: a cylinder's x_u along T1, curved along x_v. */
static void frames_of_every_size(void **state)
{
    (void)state;
    random_state r = {421};
    quat_curvature c;
    for (int round = 0; round < 20000; round++) {
        const double u = random_scale(&r, -300, 300), v = u * random_scale(&r, -7, 7), k = random_scale(&r, -140, 140),
                     h = k * random_scale(&r, -3, 3);
        const qvec3 a = {0, k * u, 0}, b = {-h * v, 0, 0}, xu = {u, 0, 0}, xv = {0, v, 0};
        if (!(fmin(fmin(u, v), fmin(k * u, h * v)) > 1e-307 && fmax(fmax(u, v), fmax(k * u, h * v)) < 1e307)) continue;
        assert_true(quat_curvature_of_frame(quat_identity(), a, b, xu, xv, &c) >= 0);
        assert_near(c.gauss / k / h, 1, 4e-15);
        assert_near(c.principal[0] / fmax(k, h), 1, 4e-15);
        assert_near(c.principal[1] / fmax(k, h), fmin(k, h) / fmax(k, h), 4e-15);
        assert_true(c.asymmetry <= 4e-15 * fmax(k, h));
    }
    const qvec3 x = {1, 0, 0}, y = {0, 1, 0}, none = {0, 0, 0};
    assert_int_equal(quat_curvature_of_frame(quat_identity(), none, none, x, y, &c), QUAT_NOT_UNIQUE);
    assert_true(c.gauss == 0 && c.mean == 0);
    assert_int_equal(quat_curvature_of_frame(quat_identity(), qvec3_scale(y, 1e300), none, x, y, &c), QUAT_OK);
    assert_near(c.principal[0], 1e300, 1e285);
    assert_int_equal(quat_curvature_of_frame(quat_identity(), qvec3_scale(y, 1e300), qvec3_scale(x, -1e300), x, y, &c),
                     QUAT_ERANGE); /* K = 1e600 */
    assert_true(c.gauss == 0 && c.mean == 0 && c.principal[0] == 0);
}

typedef struct turned_point {
    qvec3 d[6];
} turned_point;

static bool at_turned(double u, double v, qvec3 d[6], void *context)
{
    (void)u, (void)v;
    memcpy(d, ((const turned_point *)context)->d, 6 * sizeof *d);
    return true;
}

/* Rounded tangents at an angle of 1e-12 know the curvature to 1e-4 only; the estimate says so, and beyond 1e-3 the
 * status. */
static void tangents_that_run_together(void **state)
{
    (void)state;
    random_state r = {431};
    int doubtful = 0, wrong = 0;
    for (int round = 0; round < 20000; round++) {
        const quat q = random_unit(&r);
        skewed s = {1, 1, 1, random_scale(&r, -14.5, 0)};
        qvec3 d[6];
        at_skewed(0, 0, d, &s);
        quat_surface_point p;
        turned_point turned;
        for (int i = 0; i < 6; i++) turned.d[i] = quat_rotate(q, d[i]);
        const quat_surface surface = {at_turned, &turned, 0, 1, 0, 1, false, false, 2};
        const quat_status status = quat_surface_at(&surface, 0.5, 0.5, &p);
        if (status == QUAT_EDOMAIN) continue;
        assert_true(status >= 0);
        doubtful += status == QUAT_NOT_CONVERGED;
        const double error = fmax(fabs(p.curvature.principal[0] - 1), fabs(p.curvature.principal[1] - 0.25));
        assert_true(error <= 8 * p.error);
        wrong += error > 0.01;
        assert_true(status == QUAT_NOT_CONVERGED || error < 0.01);
    }
    assert_true(doubtful > 1000 && wrong > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ellipsoids_in_quad),
                                       cmocka_unit_test(beside_the_pole),
                                       cmocka_unit_test(what_the_thesis_prints_for_curvature),
                                       cmocka_unit_test(closed_forms),
                                       cmocka_unit_test(superellipsoids_in_quad),
                                       cmocka_unit_test(equations_23_and_24),
                                       cmocka_unit_test(nothing_depends_on_place_parameter_or_gauge),
                                       cmocka_unit_test(rates_are_the_frames),
                                       cmocka_unit_test(fewer_derivatives),
                                       cmocka_unit_test(units_change_units_alone),
                                       cmocka_unit_test(frames_of_every_size),
                                       cmocka_unit_test(tangents_that_run_together),
                                       cmocka_unit_test(bad_input_has_a_status)};
    gsl_set_error_handler(count_call);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
