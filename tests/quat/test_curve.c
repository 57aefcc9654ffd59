/* SPDX-License-Identifier: MIT
 *
 * The room curve against closed forms and against Fourier sums in quadruple precision, which share nothing with it.
 */
#include "oracle.h"

#include <quat/curve.h>
#include <quat/family.h>
#include <quat/rotation.h>
#include "handler.h"
#include "kit/near.h"

static const double pi = 3.14159265358979324;

/* ---- the oracle: sums of size cos(w t) and size sin(w t), differentiated term by term ---- */

typedef struct term {
    int axis;
    wide size, w;
    int quarter; /* sin(w t + quarter pi/2) */
} term;

static wide wave(wide w, wide t, int quarter)
{
    const wide s = sinf128(w * t), c = cosf128(w * t), cycle[4] = {s, c, -s, -c};
    return cycle[quarter & 3];
}

static void fourier(int n, const term terms[], wide t, wquat d[4])
{
    for (int k = 0; k < 4; k++) {
        wide x[3] = {0, 0, 0};
        for (int i = 0; i < n; i++) {
            wide power = terms[i].size;
            for (int j = 0; j < k; j++) power *= terms[i].w;
            x[terms[i].axis] += power * wave(terms[i].w, t, terms[i].quarter + k);
        }
        d[k] = (wquat){0, x[0], x[1], x[2]};
    }
}

/* (R + r cos qt) cos pt = R cos pt + r/2 (cos (p+q)t + cos (p-q)t), and so on. */
static void knot(wide R, wide r, int p, int q, wide t, wquat d[4])
{
    const term terms[] = {{0, R, p, 1},         {0, r / 2, p + q, 1}, {0, r / 2, p - q, 1}, {1, R, p, 0},
                          {1, r / 2, p + q, 0}, {1, r / 2, p - q, 0}, {2, -r, q, 0}};
    fourier(7, terms, t, d);
}

typedef struct apparatus {
    wide speed, curvature, torsion;
    wquat tangent, normal, binormal;
} apparatus;

static apparatus frenet(const wquat d[4])
{
    const wquat b = wide_cross(d[1], d[2]);
    const wide speed = wide_norm(d[1]), turn = wide_norm(b);
    return (apparatus){speed,           turn / (speed * speed * speed), wide_dot(b, d[3]) / (turn * turn),
                       wide_unit(d[1]), wide_unit(wide_cross(b, d[1])), wide_unit(b)};
}

static double off(double got, wide want, wide scale) { return (double)(fabsf128((wide)got - want) / scale); }

static double frame_error(quat q, const apparatus *a)
{
    double worst = 0;
    const qvec3 t = quat_rotate(q, qvec3_make(1, 0, 0)), n = quat_rotate(q, qvec3_make(0, 1, 0)),
                b = quat_rotate(q, qvec3_make(0, 0, 1));
    worse(&worst, (double)wide_norm(wide_sub(wide_vec(t), a->tangent)));
    worse(&worst, (double)wide_norm(wide_sub(wide_vec(n), a->normal)));
    worse(&worst, (double)wide_norm(wide_sub(wide_vec(b), a->binormal)));
    return worst;
}

/* ---- at a point ---- */

static void knots_in_quad(void **state)
{
    (void)state;
    random_state r = {301};
    double speed = 0, curvature = 0, torsion = 0, frame = 0;
    for (int round = 0; round < 100000; round++) {
        const double R = random_scale(&r, -3, 3), small = R * random_between(&r, 0.05, 0.6),
                     t = random_between(&r, 0, 2 * pi);
        const int p = 1 + round % 4, q = p == 2 ? 3 + round % 2 * 2 : p + 1;
        quat_family family;
        quat_curve curve;
        quat_curve_point point;
        wquat d[4];
        assert_int_equal(quat_torus_knot(R, small, p, q, &family, &curve), QUAT_OK);
        assert_int_equal(quat_curve_at(&curve, t, &point), QUAT_OK);
        knot(R, small, p, q, t, d);
        const apparatus want = frenet(d);
        /* curvature's own scale is |x''|/|x'|^2: where the curve is nearly straight its digits are lost to the cross
         * product */
        const wide bend = wide_norm(d[2]) / (want.speed * want.speed), weak = want.curvature / bend;
        worse(&speed, off(point.speed, want.speed, want.speed));
        worse(&curvature, off(point.curvature, want.curvature, bend));
        worse(&torsion, off(point.torsion, want.torsion,
                            wide_norm(d[3]) / (want.speed * want.speed * want.speed) / want.curvature / weak));
        worse(&frame, (double)(frame_error(point.frame, &want) * weak));
    }
    assert_bound("speed of torus knots", speed, 3e-15);
    assert_bound("curvature", curvature, 1e-13);
    assert_bound("torsion", torsion, 1e-13);
    assert_bound("Frenet frame, rad", frame, 1e-13);
}

static void helices_in_closed_form(void **state)
{
    (void)state;
    random_state r = {302};
    double worst = 0, length = 0, total = 0, rates = 0;
    for (int round = 0; round < 2000; round++) {
        quat_family family;
        quat_curve curve;
        quat_curve_point point, near;
        quat_curve_totals totals;
        const double a = random_scale(&r, -2, 2), b = a * random_between(&r, -2, 2), turns = random_between(&r, 0.5, 5);
        assert_int_equal(quat_helix(a, 2 * pi * b, turns, &family, &curve), QUAT_OK);
        const double t = random_between(&r, 0.1, curve.end - 0.1), c2 = a * a + b * b, c = sqrt(c2);
        assert_int_equal(quat_curve_at(&curve, t, &point), QUAT_OK);
        worse(&worst, fabs(point.curvature - a / c2) * c);
        worse(&worst, fabs(point.torsion - b / c2) * c);
        double l;
        assert_int_equal(quat_curve_length(&curve, t, curve.end, &l), QUAT_OK);
        worse(&length, fabs(l / (c * (curve.end - t)) - 1));
        assert_int_equal(quat_curve_total(&curve, &totals), QUAT_OK);
        worse(&total, fabs(totals.length - c * curve.end) / (c * curve.end));
        worse(&total, fabs(totals.curvature - curve.end * a / c) / curve.end);
        worse(&total, fabs(totals.torsion - curve.end * b / c) / curve.end);
        /* the frame turns at speed (torsion, 0, curvature) in its own axes: the thesis' equation 18, in body axes */
        assert_int_equal(quat_curve_at(&curve, t + 1e-3, &near), QUAT_OK);
        const quat turn = quat_nearest(quat_mul(quat_conj(point.frame), near.frame), quat_identity());
        const qvec3 want = qvec3_scale(qvec3_make(b / c2, 0, a / c2), c * 1e-3);
        worse(&rates, qvec3_norm(qvec3_sub(quat_to_rotation_vector(turn), want)));
    }
    assert_bound("curvature and torsion of helices", worst, 3e-15);
    assert_bound("length", length, 2e-15);
    assert_bound("totals", total, 3e-15);
    assert_bound("rate of the Frenet frame", rates, 5e-15);
}

/* ---- differences ---- */

static bool veil(double t, qvec3 d[4], void *context)
{
    return ((const quat_curve *)context)->at(t, d, ((const quat_curve *)context)->context);
}

static void fewer_derivatives(void **state)
{
    (void)state;
    /* as a part of the curve's size over its speed's powers, at 2000 points; open curves have ends */
    const double curvature_bar[3] = {5e-11, 1e-13, 1e-15}, torsion_bar[3] = {5e-9, 5e-12, 2e-13};
    for (int known = 2; known >= 0; known--) {
        double curvature = 0, torsion = 0, honest = 0;
        for (int which = 0; which < 3; which++) {
            quat_family family;
            quat_curve curve;
            if (which == 0) quat_trefoil(1, &family, &curve);
            if (which == 1) quat_helix(2, 1, 1.5, &family, &curve);
            if (which == 2) quat_cubic(1, false, &family, &curve);
            quat_curve poorer = curve;
            poorer.at = veil, poorer.context = &curve, poorer.known = known;
            for (int i = 0; i <= 700; i++) {
                const double t = fmin(curve.start + (curve.end - curve.start) * i / 700, curve.end);
                quat_curve_point full, point;
                assert_int_equal(quat_curve_at(&curve, t, &full), QUAT_OK);
                assert_int_equal(quat_curve_at(&poorer, t, &point), QUAT_OK);
                worse(&curvature, fabs(point.curvature - full.curvature) / (1 + full.curvature));
                worse(&torsion, fabs(point.torsion - full.torsion) / (1 + fabs(full.torsion)));
                worse(&honest, fabs(point.curvature - full.curvature) / (point.curvature_error + full.curvature_error));
                worse(&honest, fabs(point.torsion - full.torsion) / (point.torsion_error + full.torsion_error));
            }
        }
        char name[80];
        snprintf(name, sizeof name, "curvature, %d derivatives known", known);
        assert_bound(name, curvature, curvature_bar[known]);
        snprintf(name, sizeof name, "torsion, %d derivatives known", known);
        assert_bound(name, torsion, torsion_bar[known]);
        assert_bound("error by its estimate", honest, 3);
    }
}

/* ---- invariance ---- */

typedef struct moved {
    quat_curve inner;
    quat turn;
    qvec3 shift;
    double scale, wobble;
} moved;

/* scale R x(s(t)) + shift with s = t + wobble sin t. */
static bool move(double t, qvec3 d[4], void *context)
{
    const moved *m = context;
    qvec3 x[4];
    const double s1 = 1 + m->wobble * cos(t), s2 = -m->wobble * sin(t), s3 = -m->wobble * cos(t);
    double e[4];
    if (quat_curve_derivatives(&m->inner, t + m->wobble * sin(t), 3, x, e) != QUAT_OK) return false;
    d[0] = x[0];
    d[1] = qvec3_scale(x[1], s1);
    d[2] = qvec3_axpy(s2, x[1], qvec3_scale(x[2], s1 * s1));
    d[3] = qvec3_axpy(s3, x[1], qvec3_axpy(3 * s1 * s2, x[2], qvec3_scale(x[3], s1 * s1 * s1)));
    for (int k = 0; k < 4; k++) d[k] = qvec3_scale(quat_rotate(m->turn, d[k]), m->scale);
    d[0] = qvec3_add(d[0], m->shift);
    return true;
}

static void nothing_depends_on_place_or_parameter(void **state)
{
    (void)state;
    random_state r = {303};
    double curvature = 0, torsion = 0, frame = 0;
    for (int round = 0; round < 100000; round++) {
        quat_family family;
        moved m = {.turn = random_unit(&r),
                   .shift = qvec3_scale(random_direction(&r), 3),
                   .scale = random_scale(&r, -3, 3),
                   .wobble = random_between(&r, -0.5, 0.5)};
        quat_curve_point here, there;
        quat_trefoil(1, &family, &m.inner);
        const quat_curve curve = {move, &m, 0, 2 * pi, true, 3};
        const double t = random_between(&r, 0, 2 * pi);
        assert_int_equal(quat_curve_at(&curve, t, &there), QUAT_OK);
        assert_int_equal(quat_curve_at(&m.inner, t + m.wobble * sin(t), &here), QUAT_OK);
        worse(&curvature, fabs(there.curvature * m.scale - here.curvature) / here.curvature);
        worse(&torsion, fabs(there.torsion * m.scale - here.torsion) / (1 + fabs(here.torsion)));
        worse(&frame, quat_rotation_distance(there.frame, quat_mul(m.turn, here.frame)));
    }
    assert_bound("curvature after a motion", curvature, 5e-15);
    assert_bound("torsion after a motion", torsion, 2e-15);
    assert_bound("frame after a motion, rad", frame, 4e-15);
}

/* ---- length ---- */

/* An ellipse's perimeter by the arithmetic-geometric mean (Gauss, Legendre). */
static wide perimeter(wide a, wide b)
{
    wide lost = (a * a - b * b) / 2, factor = 1, x = a, y = b;
    for (int i = 0; i < 20; i++) {
        const wide c = (x - y) / 2, mean = (x + y) / 2;
        y = sqrtf128(x * y);
        x = mean;
        lost += factor * c * c;
        factor *= 2;
    }
    return 2 * atan2f128(0, -1) * (a * a - lost) / x;
}

static void lengths(void **state)
{
    (void)state;
    random_state r = {304};
    double whole = 0, inverse = 0, even = 0;
    for (int round = 0; round < 300; round++) {
        const double a = random_scale(&r, -3, 3), b = a * random_scale(&r, -2, 2);
        quat_family family;
        quat_curve curve;
        double l, t, back;
        assert_int_equal(quat_ellipse(a, b, &family, &curve), QUAT_OK);
        assert_int_equal(quat_curve_length(&curve, 0, 2 * pi, &l), QUAT_OK);
        worse(&whole, off(l, perimeter(a, b), perimeter(a, b)));
        assert_int_equal(quat_curve_length(&curve, 2 * pi, 0, &back), QUAT_OK);
        worse(&whole, fabs(back + l) / l);
        const double part = random_uniform(&r) * l;
        assert_int_equal(quat_curve_at_length(&curve, part, &t), QUAT_OK);
        assert_int_equal(quat_curve_length(&curve, 0, t, &back), QUAT_OK);
        worse(&inverse, fabs(back - part) / l);
        if (round % 10 == 0) {
            double at[33];
            assert_int_equal(quat_curve_even(&curve, 33, at), QUAT_OK);
            for (int i = 1; i < 33; i++) {
                assert_int_equal(quat_curve_length(&curve, at[i - 1], at[i], &back), QUAT_OK);
                worse(&even, fabs(back * 32 / l - 1));
            }
        }
    }
    assert_bound("perimeter of ellipses", whole, 5e-15);
    assert_bound("length(at_length(l)) - l", inverse, 3e-15);
    assert_bound("even steps", even, 3e-13);
}

/* The speed's kinks are rounded off ever closer to where it is least, which may be an end of the halving or not. */
static void needles(void **state)
{
    (void)state;
    random_state r = {305};
    double end = 0, inside = 0, inverse = 0;
    for (int round = 0; round < 300; round++) {
        const double a = round % 2 ? 1 : random_scale(&r, -12, 0), b = round % 2 ? random_scale(&r, -12, 0) : 1,
                     from = random_between(&r, 0, 2 * pi);
        const wide want = perimeter(a, b);
        quat_family family;
        quat_curve curve;
        double l, t, back;
        assert_int_equal(quat_ellipse(a, b, &family, &curve), QUAT_OK);
        assert_int_equal(quat_curve_length(&curve, 0, 2 * pi, &l), QUAT_OK);
        worse(&end, off(l, want, want));
        assert_int_equal(quat_curve_at_length(&curve, from / 6.3 * l, &t), QUAT_OK);
        assert_int_equal(quat_curve_length(&curve, 0, t, &back), QUAT_OK);
        worse(&inverse, fabs(back / l - from / 6.3));
        assert_int_equal(quat_curve_length(&curve, from, from + 2 * pi, &l), QUAT_OK);
        worse(&inside, off(l, want, want));
    }
    assert_bound("perimeter of needles, ratio 1 ... 1e-12", end, 5e-15);
    assert_bound("from anywhere round", inside, 2e-13);
    assert_bound("length(at_length(l)) - l, needles", inverse, 3e-14);
}

static void totals_of_closed_curves(void **state)
{
    (void)state;
    quat_family family;
    quat_curve curve;
    quat_curve_totals t;
    quat_ellipse(3, 1, &family, &curve);
    assert_int_equal(quat_curve_total(&curve, &t), QUAT_OK);
    assert_bound("Fenchel: a plane oval turns by 2 pi", fabs(t.curvature - 2 * pi) + fabs(t.torsion), 1e-14);
    quat_trefoil(1, &family, &curve);
    assert_int_equal(quat_curve_total(&curve, &t), QUAT_OK);
    assert_true(t.curvature > 4 * pi); /* Fary, Milnor */
    quat_viviani(1, &family, &curve);  /* on a sphere */
    assert_int_equal(quat_curve_total(&curve, &t), QUAT_OK);
    assert_bound("Viviani: total torsion", fabs(t.torsion), 1e-14);
}

/* ---- samples ---- */

static void samples_stand_for_their_curve(void **state)
{
    (void)state;
    double position[2], curvature[2], torsion[2];
    for (int fine = 0; fine < 2; fine++) {
        enum { most = 257 };
        const size_t n = fine ? most : 129;
        double t[most];
        qvec3 x[most];
        quat_family family;
        quat_curve exact, curve;
        quat_trefoil(1, &family, &exact);
        for (size_t i = 0; i < n; i++) {
            qvec3 d[4];
            t[i] = 2 * pi * (double)i / (double)(n - 1);
            t[i] = fmin(t[i] + 0.3 * sin(t[i]) / 2, 2 * pi); /* uneven */
            quat_curve_derivatives(&exact, t[i], 0, d, NULL);
            x[i] = d[0];
        }
        const quat_samples samples = {n, t, x, true};
        assert_int_equal(quat_curve_from_samples(&samples, &curve), QUAT_OK);
        position[fine] = curvature[fine] = torsion[fine] = 0;
        for (int i = 0; i < 1000; i++) {
            const double at = 2 * pi * i / 1000;
            quat_curve_point want, got;
            assert_int_equal(quat_curve_at(&exact, at, &want), QUAT_OK);
            assert_int_equal(quat_curve_at(&curve, at, &got), QUAT_OK);
            worse(&position[fine], qvec3_norm(qvec3_sub(want.position, got.position)));
            worse(&curvature[fine], fabs(want.curvature - got.curvature));
            worse(&torsion[fine], fabs(want.torsion - got.torsion));
        }
    }
    show_figure("samples: order of position", log2(position[0] / position[1]));
    show_figure("samples: order of curvature", log2(curvature[0] / curvature[1]));
    show_figure("samples: order of torsion", log2(torsion[0] / torsion[1]));
    assert_bound("256 samples: position", position[1], 1e-11);
    assert_bound("256 samples: curvature", curvature[1], 1e-8);
    assert_bound("256 samples: torsion", torsion[1], 1e-6);
    assert_true(log2(position[0] / position[1]) > 7.5 && log2(curvature[0] / curvature[1]) > 5.5 &&
                log2(torsion[0] / torsion[1]) > 4.5);
}

/* ---- where curves degenerate ---- */

static bool standing(double t, qvec3 d[4], void *context)
{
    (void)t, (void)context;
    for (int k = 0; k < 4; k++) d[k] = qvec3_make(k == 0, 0, 0);
    return true;
}

/* (t, t^3, t^4): an inflection of space at 0, where the curvature is 6 |t| and the torsion 2. */
static bool bent_once(double t, qvec3 d[4], void *context)
{
    (void)context;
    d[0] = qvec3_make(t, t * t * t, t * t * t * t);
    d[1] = qvec3_make(1, 3 * t * t, 4 * t * t * t);
    d[2] = qvec3_make(0, 6 * t, 12 * t * t);
    d[3] = qvec3_make(0, 6, 24 * t);
    return true;
}

static void near_an_inflection(void **state)
{
    (void)state;
    random_state r = {306};
    double curvature = 0, torsion = 0, frame = 0, honest = 0;
    size_t lost = 0;
    for (int round = 0; round < 100000; round++) {
        const quat_curve curve = {bent_once, NULL, -1, 1, false, round % 10 ? 3 : round / 10 % 3};
        const double t = random_scale(&r, -16, 0) * (round % 2 ? 1 : -1);
        const wide w = t;
        const wquat d[4] = {{0, w, w * w * w, w * w * w * w},
                            {0, 1, 3 * w * w, 4 * w * w * w},
                            {0, 0, 6 * w, 12 * w * w},
                            {0, 0, 6, 24 * w}};
        const apparatus want = frenet(d);
        quat_curve_point point;
        const quat_status status = quat_curve_at(&curve, t, &point);
        if (curve.known < 3) { /* the inflection is met where the differences lose it, and not before */
            lost += status == QUAT_NOT_UNIQUE;
            assert_true(status == QUAT_OK || (status == QUAT_NOT_UNIQUE && fabs(t) < 1e-11));
            worse(&honest, off(point.curvature, want.curvature, point.curvature_error + 1e-15 * point.curvature));
            if (status != QUAT_OK) continue;
            worse(&honest, off(point.torsion, want.torsion, point.torsion_error + 1e-14));
            continue;
        }
        assert_int_equal(status, QUAT_OK);
        worse(&curvature, off(point.curvature, want.curvature, want.curvature));
        worse(&torsion, off(point.torsion, want.torsion, 2));
        worse(&frame, frame_error(point.frame, &want));
    }
    assert_true(lost > 0);
    assert_bound("curvature near an inflection, relative", curvature, 3e-15);
    assert_bound("torsion near it", torsion, 5e-15);
    assert_bound("Frenet frame near it, rad", frame, 2e-15);
    assert_bound("near it, error by its estimate", honest, 5);
}

static bool cusp(double t, qvec3 d[4], void *context)
{
    (void)context;
    d[0] = qvec3_make(t * t, t * t * t, 0);
    d[1] = qvec3_make(2 * t, 3 * t * t, 0);
    d[2] = qvec3_make(2, 6 * t, 0);
    d[3] = qvec3_make(0, 6, 0);
    return true;
}
static bool straight(double t, qvec3 d[4], void *context)
{
    (void)context;
    for (int k = 0; k < 4; k++) d[k] = qvec3_make(k == 1 ? 3 : 0, k == 1, -(k == 1));
    d[0] = qvec3_make(3 * t, t, -t);
    return true;
}
static bool root(double t, qvec3 d[4], void *context)
{
    (void)context;
    d[0] = qvec3_make(t, sqrt(t), 0);
    d[1] = qvec3_make(1, 0.5 / sqrt(t), 0);
    d[2] = qvec3_make(0, -0.25 / (t * sqrt(t)), 0);
    d[3] = qvec3_make(0, 0.375 / (t * t * sqrt(t)), 0);
    return true;
}

static void degenerate_curves(void **state)
{
    (void)state;
    quat_curve_point point;
    quat_curve_totals totals;
    double l, t, even[5], worst = 0, cusps = 0;
    quat q[5];
    for (int known = 0; known <= 3; known++) {
        const quat_curve still = {standing, NULL, -1, 1, known % 2 == 1, known},
                         sharp = {cusp, NULL, -1, 1, false, known}, line = {straight, NULL, -1, 1, false, known},
                         steep = {root, NULL, 0, 1, false, known};
        /* one point for all t: no length, no tangent */
        assert_int_equal(quat_curve_length(&still, -1, 1, &l), QUAT_OK);
        worse(&worst, l);
        assert_int_equal(quat_curve_at_length(&still, 0, &t), QUAT_OK);
        assert_true(t == -1);
        assert_int_equal(quat_curve_even(&still, 5, even), QUAT_OK);
        for (int i = 0; i < 5; i++) assert_true(even[i] >= -1 && even[i] <= 1 && (i == 0 || even[i] > even[i - 1]));
        assert_int_equal(quat_curve_at(&still, 0.1, &point), QUAT_EDOMAIN);
        assert_int_equal(quat_curve_total(&still, &totals), QUAT_EDOMAIN);
        assert_int_equal(quat_curve_frames(&still, QUAT_MINIMAL, NULL, 5, NULL, q, NULL), QUAT_EDOMAIN);
        /* a cusp has a length and no tangent */
        assert_int_equal(quat_curve_length(&sharp, -1, 1, &l), QUAT_OK);
        worse(&cusps, fabs(l / (2 * (13 * sqrt(13) - 8) / 27) - 1));
        assert_int_equal(quat_curve_at_length(&sharp, l / 2, &t), QUAT_OK);
        assert_near(t, 0, 1e-7);
        assert_int_equal(quat_curve_at(&sharp, 0, &point), QUAT_EDOMAIN);
        assert_int_equal(quat_curve_at(&sharp, 0.5, &point), QUAT_OK);
        assert_near(point.curvature, 0.768, 1e-11);
        assert_int_equal(quat_curve_frames(&sharp, QUAT_MINIMAL, NULL, 5, NULL, q, NULL), QUAT_EDOMAIN);
        /* a straight line has no normal */
        assert_int_equal(quat_curve_total(&line, &totals), QUAT_NOT_UNIQUE);
        assert_near(totals.length, 2 * sqrt(11), 1e-13);
        assert_true(totals.curvature == 0 && totals.torsion == 0);
        assert_int_equal(quat_curve_at(&line, 0.3, &point), QUAT_NOT_UNIQUE);
        assert_near3(quat_rotate(point.frame, qvec3_make(1, 0, 0)), qvec3_scale(qvec3_make(3, 1, -1), 1 / sqrt(11)),
                     1e-13);
        /* an infinite speed: what can be had, and the word for it */
        assert_int_equal(quat_curve_length(&steep, 0, 1, &l), QUAT_NOT_CONVERGED);
        assert_near(l, (2 * sqrt(5) + asinh(2)) / 4, known > 0 ? 1e-7 : 1e-2);
    }
    assert_bound("length of a point", worst, 1e-13);
    assert_bound("length of a cusp", cusps, 1e-13);
}

/* ---- bad input ---- */

static bool nowhere(double t, qvec3 d[4], void *context)
{
    (void)t, (void)d, (void)context;
    return false;
}
static bool jagged(double t, qvec3 d[4], void *context)
{
    (void)context;
    d[0] = qvec3_make(t, fabs(sin(1 / (t * t + 1e-9))), 0);
    d[1] = qvec3_make(1, 1e8 * sin(1e8 * t), 0);
    return true;
}

static void bad_input_has_a_status(void **state)
{
    (void)state;
    const quat_curve none = {nowhere, NULL, 0, 1, false, 3}, still = {standing, NULL, 0, 1, false, 3},
                     noisy = {jagged, NULL, -1, 1, false, 1}, empty = {0}, backward = {standing, NULL, 1, 0, false, 3};
    quat_curve_point point;
    quat_curve_totals totals;
    double l, t[3];
    quat q[3];
    qvec3 d[4];
    assert_int_equal(quat_curve_at(&none, 0.5, &point), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_at(&still, 0.5, &point), QUAT_EDOMAIN);
    assert_near3(point.position, qvec3_make(1, 0, 0), 0);
    assert_int_equal(quat_curve_at(&empty, 0.5, &point), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_at(&backward, 0.5, &point), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_at(&still, 1.5, &point), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_at(&still, NAN, &point), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_derivatives(&still, 0.5, 4, d, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_length(&none, 0, 1, &l), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_length(&still, 0, INFINITY, &l), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_length(&noisy, -1, 1, &l), QUAT_NOT_CONVERGED);
    assert_true(isfinite(l));
    const double half = 0.5 * l;
    double even[9];
    assert_int_equal(quat_curve_at_length(&noisy, half, &l), QUAT_NOT_CONVERGED); /* and before long */
    assert_true(l > -1 && l < 1);
    assert_int_equal(quat_curve_even(&noisy, 9, even), QUAT_NOT_CONVERGED);
    for (int i = 1; i < 9; i++) assert_true(even[i] > even[i - 1]);
    assert_true(even[0] == -1 && even[8] == 1);
    assert_int_equal(quat_curve_at_length(&still, 1, &l), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_even(&none, 3, t), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_total(&none, &totals), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_frames(&none, QUAT_MINIMAL, NULL, 3, NULL, q, NULL), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_frames(&still, QUAT_FRENET, NULL, 3, NULL, q, NULL), QUAT_EDOMAIN);
    quat_family family;
    quat_curve helix;
    quat_helix(1, 1, 1, &family, &helix);
    const double back[3] = {0, 2, 1};
    assert_int_equal(quat_curve_frames(&helix, QUAT_CLOSED, NULL, 3, NULL, q, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_frames(&helix, QUAT_MINIMAL, NULL, 3, back, q, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_frames(&helix, QUAT_MINIMAL, NULL, 1, NULL, q, NULL), QUAT_EARGUMENT);
    const quat zero = {0, 0, 0, 0};
    assert_int_equal(quat_curve_frames(&helix, QUAT_MINIMAL, &zero, 3, NULL, q, NULL), QUAT_EDOMAIN);
    const qvec3 o = {0, 0, 0}, x = {1, 0, 0};
    assert_int_equal(quat_frame_step(quat_identity(), o, o, x, q), QUAT_EDOMAIN);
    assert_int_equal(quat_frame_step(quat_identity(), o, x, o, q), QUAT_EDOMAIN);
    quat_curve made;
    const qvec3 points[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 1}};
    const double times[4] = {0, 1, 2, 3}, same[4] = {0, 1, 1, 3};
    const quat_samples few = {3, times, points, false}, stuck = {4, same, points, false},
                       open = {4, times, points, true};
    assert_int_equal(quat_curve_from_samples(&few, &made), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_from_samples(&stuck, &made), QUAT_EARGUMENT);
    assert_int_equal(quat_curve_from_samples(&open, &made), QUAT_EDOMAIN);
    assert_int_equal(quat_torus_knot(2, 1, 2, 4, &family, &made), QUAT_EARGUMENT);
    assert_int_equal(quat_torus_knot(1, 2, 2, 3, &family, &made), QUAT_EDOMAIN);
    assert_int_equal(quat_ellipse(-1, 1, &family, &made), QUAT_EDOMAIN);
    assert_int_equal(quat_curve_at(&made, 0, &point), QUAT_EARGUMENT);
    for (double size = 1e-300; size < 1e301; size *= 1e25) { /* a value or a status at every size */
        quat_ellipse(size, size, &family, &made);
        const quat_status status = quat_curve_at(&made, 1, &point);
        assert_true(status >= 0 || status == QUAT_ERANGE);
        if (status >= 0) assert_near(point.curvature * size, 1, 1e-14);
        if (size > 1e-90 && size < 1e90) assert_int_equal(status, QUAT_OK);
        assert_true(isfinite(point.curvature) && isfinite(point.torsion) && isfinite(point.torsion_error));
    }
    assert_int_equal(handled, 0);
}

/* ---- units ---- */

typedef struct scaled_knot {
    double length, rate;
} scaled_knot;

/* (cos rt, sin rt, rt/2) times a length: curvature 4/5 and torsion 2/5 of one over the length, whatever the rate. */
static bool at_scaled_helix(double t, qvec3 d[4], void *context)
{
    const scaled_knot *const k = context;
    const double turn = k->rate * t, c = cos(turn), s = sin(turn);
    const qvec3 unit[4] = {{c, s, turn / 2}, {-s, c, 0.5}, {-c, -s, 0}, {s, -c, 0}};
    double size = k->length;
    for (int i = 0; i < 4; i++, size *= k->rate) d[i] = qvec3_scale(unit[i], size);
    return true;
}

/* What has a speed within 1e-100 ... 1e100 has its curvature, torsion and frame, however slow its parameter. */
static void units_change_units_alone(void **state)
{
    (void)state;
    random_state r = {409};
    int answered = 0;
    for (int round = 0; round < 20000; round++) {
        scaled_knot k = {random_scale(&r, -100, 100), random_scale(&r, -100, 60)};
        const quat_curve curve = {at_scaled_helix, &k, 0, 10 / k.rate, false, 3};
        const double turn = random_between(&r, 0, 10), speed = k.length * k.rate * sqrt(1.25);
        quat_curve_point p;
        const quat_status status = quat_curve_at(&curve, turn / k.rate, &p);
        const bool within = speed > 1.01e-100 && fmax(speed, speed * k.rate * k.rate) < 0.99e100;
        /* derivatives that are no normal doubles are no data */
        if (!within || k.length * k.rate * k.rate * k.rate < 1e-307) continue;
        answered++;
        assert_int_equal(status, QUAT_OK);
        assert_near(p.curvature * k.length, 0.8, 2e-15);
        assert_near(p.torsion * k.length, 0.4, 2e-15);
        assert_true(p.curvature_error * k.length < 1e-14 && p.torsion_error * k.length < 1e-14);
        assert_near3(quat_rotate(p.frame, qvec3_make(0, 1, 0)), qvec3_make(-cos(turn), -sin(turn), 0), 2e-14);
    }
    assert_true(answered > 8000);
    /* all derivatives but the first vanish beside it, or it beside them */
    scaled_knot k = {1, 1e-150};
    const quat_curve still = {at_scaled_helix, &k, 0, 1, false, 3};
    quat_curve_point p;
    assert_int_equal(quat_curve_at(&still, 0, &p), QUAT_ERANGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(knots_in_quad),
                                       cmocka_unit_test(helices_in_closed_form),
                                       cmocka_unit_test(fewer_derivatives),
                                       cmocka_unit_test(nothing_depends_on_place_or_parameter),
                                       cmocka_unit_test(lengths),
                                       cmocka_unit_test(needles),
                                       cmocka_unit_test(near_an_inflection),
                                       cmocka_unit_test(degenerate_curves),
                                       cmocka_unit_test(totals_of_closed_curves),
                                       cmocka_unit_test(samples_stand_for_their_curve),
                                       cmocka_unit_test(units_change_units_alone),
                                       cmocka_unit_test(bad_input_has_a_status)};
    gsl_set_error_handler(count_call);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
