/* SPDX-License-Identifier: MIT
 *
 * Moving frames: against closed forms, the total torsion, and the carrying of a vector over a polygon in quadruple
 * precision, which knows neither reflections nor torsion.
 */
#include "oracle.h"

#include <quat/curve.h>
#include <quat/family.h>
#include <quat/rotation.h>
#include "kit/near.h"

static const double pi = 3.14159265358979324;
static const qvec3 x_axis = {1, 0, 0};

/* Two mirrors, in quadruple precision: the chord's bisecting plane, then the one that brings the tangent where it
 * belongs. The whole frame goes along. */
static wquat wide_mirrored(wquat v, wquat normal)
{
    return wide_sub(v, wide_scale(normal, 2 * wide_dot(v, normal) / wide_dot(normal, normal)));
}

static void steps_are_two_mirrors(void **state)
{
    (void)state;
    random_state r = {312};
    double axes = 0, back = 0, moved = 0, tangents = 0;
    for (int round = 0; round < 100000; round++) {
        const quat q = random_unit(&r), turn = random_unit(&r);
        const double bend = random_scale(&r, -12, 0), scale = random_scale(&r, -50, 50);
        const qvec3 t0 = quat_rotate(q, x_axis), x0 = qvec3_scale(random_direction(&r), scale);
        qvec3 t1, chord = qvec3_axpy(bend, random_direction(&r), t0);
        assert_int_equal(qvec3_normalize(qvec3_axpy(bend, random_direction(&r), t0), &t1), QUAT_OK);
        const qvec3 x1 = qvec3_axpy(scale * random_between(&r, 0.1, 10), chord, x0);
        quat next, other;
        chord = qvec3_sub(x1, x0);
        assert_int_equal(quat_frame_step(q, x0, x1, t1, &next), QUAT_OK);
        assert_true(quat_dot(q, next) >= 0);
        const wquat first = wide_vec(chord), tangent = wide_unit(wide_vec(t1)),
                    second = wide_sub(
                        tangent,
                        wide_mirrored(wide_unit(wide_rotate(wide_unit(wide_quat(q)), (wquat){0, 1, 0, 0})), first));
        for (int axis = 0; axis < 3; axis++) {
            const wquat body = {0, axis == 0, axis == 1, axis == 2},
                        want = wide_mirrored(wide_mirrored(wide_rotate(wide_unit(wide_quat(q)), body), first), second),
                        got = wide_rotate(wide_unit(wide_quat(next)), body);
            worse(&axes, (double)wide_norm(wide_sub(got, want)));
        }
        worse(&tangents, qvec3_norm(qvec3_sub(quat_rotate(next, x_axis), t1)));
        assert_int_equal(quat_frame_step(next, x1, x0, t0, &other), QUAT_OK); /* and the same way back */
        worse(&back, quat_rotation_distance(other, q));
        /* the whole scene turned turns the answer */
        assert_int_equal(quat_frame_step(quat_mul(turn, q), quat_rotate(turn, x0), quat_rotate(turn, x1),
                                         quat_rotate(turn, t1), &other),
                         QUAT_OK);
        worse(&moved, quat_rotation_distance(other, quat_mul(turn, next)));
    }
    assert_bound("a step against two mirrors", axes, 2e-14);
    assert_bound("its tangent", tangents, 2e-14);
    assert_bound("there and back, rad", back, 1e-14);
    assert_bound("with the whole scene turned, rad", moved, 2e-14);
}

/* On a helix the minimal frame is Frenet's turned by minus torsion times length. */
static double helix_error(size_t n, double *tangent)
{
    static quat q[4097];
    quat_family family;
    quat_curve curve;
    quat_framing_report report;
    double worst = 0;
    quat_helix(1, 4, 2, &family, &curve);
    const double b = 4 / (2 * pi), c = sqrt(1 + b * b);
    assert_int_equal(quat_curve_frames(&curve, QUAT_MINIMAL, NULL, n, NULL, q, &report), QUAT_OK);
    assert_true(report.holonomy == 0 && report.monodromy == 0);
    for (size_t i = 0; i < n; i++) {
        const double t = curve.end * (double)i / (double)(n - 1), angle = -b / (c * c) * c * t;
        quat_curve_point point;
        quat_curve_at(&curve, fmin(t, curve.end), &point);
        worse(&worst,
              quat_rotation_distance(q[i], quat_mul(point.frame, quat_make(cos(angle / 2), sin(angle / 2), 0, 0))));
        worse(tangent, qvec3_norm(qvec3_sub(quat_rotate(q[i], x_axis), quat_rotate(point.frame, x_axis))));
        if (i > 0) assert_true(quat_dot(q[i], q[i - 1]) > 0);
    }
    return worst;
}

static void minimal_frames_are_of_order_four(void **state)
{
    (void)state;
    double before = 0, tangent = 0, least = INFINITY, most = 0;
    for (size_t n = 33; n <= 1025; n = 2 * n - 1) {
        const double error = helix_error(n, &tangent);
        if (n > 33) least = fmin(least, log2(before / error)), most = fmax(most, log2(before / error));
        before = error;
    }
    show_figure("least order of the double reflection", least);
    show_figure("greatest order of the double reflection", most);
    assert_true(least > 3.95 && most < 4.05);
    assert_bound("minimal frame, 513 steps a turn", before, 1e-10);
    assert_bound("its tangent", tangent, 3e-15);
}

static void closed_frames_close(void **state)
{
    (void)state;
    static quat q[2001], frenet_frame[2001];
    double gap = 0, side = 0;
    int monodromy[3];
    for (int which = 0; which < 3; which++) {
        quat_family family;
        quat_curve curve;
        quat_framing_report report, other;
        if (which == 0) quat_ellipse(2, 1, &family, &curve);
        if (which == 1) quat_trefoil(1, &family, &curve);
        if (which == 2) quat_torus_knot(2, 0.5, 2, 5, &family, &curve);
        assert_int_equal(quat_curve_frames(&curve, QUAT_CLOSED, NULL, 2001, NULL, q, &report), QUAT_OK);
        monodromy[which] = report.monodromy;
        worse(&gap, quat_rotation_distance(q[0], q[2000]));
        for (size_t i = 1; i < 2001; i++) assert_true(quat_dot(q[i], q[i - 1]) > 0.99);
        assert_true((quat_dot(q[0], q[2000]) < 0 ? -1 : 1) == report.monodromy);
        /* the same tangents as Frenet's */
        assert_int_equal(quat_curve_frames(&curve, QUAT_FRENET, NULL, 2001, NULL, frenet_frame, &other), QUAT_OK);
        worse(&gap, quat_rotation_distance(frenet_frame[0], frenet_frame[2000]));
        for (size_t i = 0; i < 2001; i++)
            worse(&side, qvec3_norm(qvec3_sub(quat_rotate(q[i], x_axis), quat_rotate(frenet_frame[i], x_axis))));
    }
    assert_true(monodromy[0] == -1); /* one full turn about z */
    assert_bound("closed frames come back, rad", gap, 4e-15);
    assert_bound("tangents of closed and Frenet frames", side, 4e-15);
}

/* The angle about their common x axis from p to q. */
static double turned(quat p, quat q)
{
    const quat s = quat_mul(quat_conj(p), q);
    return remainder(2 * atan2(s.x, s.w), 2 * pi);
}

/* Closed frames differ from minimal ones by a turn about the tangent in proportion to arc length. */
static void holonomy_is_taken_back_evenly(void **state)
{
    (void)state;
    enum { n = 401 };
    static quat minimal[n], closed[n];
    quat_family family;
    quat_curve curve;
    quat_framing_report report;
    double whole, worst = 0;
    quat_trefoil(1, &family, &curve);
    assert_int_equal(quat_curve_length(&curve, 0, 2 * pi, &whole), QUAT_OK);
    assert_int_equal(quat_curve_frames(&curve, QUAT_MINIMAL, NULL, n, NULL, minimal, &report), QUAT_OK);
    assert_true(fabs(report.holonomy) > 0.1);
    assert_int_equal(quat_curve_frames(&curve, QUAT_CLOSED, NULL, n, NULL, closed, NULL), QUAT_OK);
    for (int i = 0; i < n; i++) {
        double gone;
        assert_int_equal(quat_curve_length(&curve, 0, fmin(2 * pi * i / (n - 1), 2 * pi), &gone), QUAT_OK);
        worse(&worst, fabs(remainder(turned(minimal[i], closed[i]) + report.holonomy * gone / whole, 2 * pi)));
    }
    assert_bound("twist of closed frames, rad", worst, 1e-14);
}

/* A minimal frame turns at the rate of the curvature alone: its way on S^3 is half the total curvature, and no other
 * frames of the curve have a shorter one. */
static double way(size_t n, const quat q[])
{
    double sum = 0;
    for (size_t i = 1; i < n; i++) sum += quat_distance(q[i - 1], q[i]);
    return sum;
}

static void minimal_frames_go_the_shortest_way(void **state)
{
    (void)state;
    enum { n = 4001 };
    static quat q[n], other[n];
    double shortest = 0;
    for (int which = 0; which < 3; which++) {
        quat_family family;
        quat_curve curve;
        quat_curve_totals total;
        if (which == 0) quat_trefoil(1, &family, &curve);
        if (which == 1) quat_torus_knot(2, 0.5, 2, 5, &family, &curve);
        if (which == 2) quat_helix(1, 4, 2, &family, &curve);
        assert_int_equal(quat_curve_total(&curve, &total), QUAT_OK);
        assert_int_equal(quat_curve_frames(&curve, QUAT_MINIMAL, NULL, n, NULL, q, NULL), QUAT_OK);
        assert_int_equal(quat_curve_frames(&curve, QUAT_MINIMAL, NULL, n / 2 + 1, NULL, other, NULL), QUAT_OK);
        const double fine = way(n, q), coarse = way(n / 2 + 1, other), limit = fine + (fine - coarse) / 3;
        worse(&shortest, fabs(2 * limit / total.curvature - 1));
        assert_int_equal(quat_curve_frames(&curve, QUAT_FRENET, NULL, n, NULL, other, NULL), QUAT_OK);
        assert_true(way(n, other) > fine);
        if (curve.closed) assert_int_equal(quat_curve_frames(&curve, QUAT_CLOSED, NULL, n, NULL, other, NULL), QUAT_OK);
        if (curve.closed) assert_true(way(n, other) > fine);
    }
    assert_bound("a minimal frame's way, in half total curvatures", shortest, 1e-10);
}

/* One round of the tangents on their sphere, as a polygon of great arcs: a vector carried along each by the shortest
 * rotation comes back turned. Twice with half the steps, and extrapolated. */
static double carried_round(const quat_curve *curve, int n)
{
    wquat q = {1, 0, 0, 0}, first = {0, 0, 0, 0}, before = first;
    for (int i = 0; i <= n; i++) {
        qvec3 d[4];
        assert_int_equal(quat_curve_derivatives(curve, i < n ? curve->end * i / n : curve->end, 1, d, NULL), QUAT_OK);
        const wquat t = wide_unit(wide_vec(d[1]));
        if (i == 0) first = t;
        if (i > 0) { /* 1 - t before: twice the half-way quaternion's direction */
            const wquat turn = wide_mul(i < n ? t : first, before), half = {1 - turn.w, -turn.x, -turn.y, -turn.z};
            q = wide_mul(wide_unit(half), q);
        }
        before = t;
    }
    return 2 * atan2((double)wide_dot(q, first), (double)q.w);
}

static void holonomy_is_minus_the_total_torsion(void **state)
{
    (void)state;
    enum { n = 4001 };
    static quat q[n];
    random_state r = {311};
    double torsion = 0, polygon = 0;
    for (int round = 0; round < 60; round++) {
        quat_family family;
        quat_curve curve;
        quat_framing_report report;
        quat_curve_totals total;
        const double size = random_scale(&r, -3, 3), thick = size * random_between(&r, 0.2, 0.6);
        if (round == 0)
            quat_trefoil(1, &family, &curve);
        else if (round == 1)
            quat_viviani(1, &family, &curve);
        else
            quat_torus_knot(size, thick, 1 + round % 3, 2 + round % 3, &family, &curve);
        assert_int_equal(quat_curve_total(&curve, &total), QUAT_OK);
        assert_int_equal(quat_curve_frames(&curve, QUAT_MINIMAL, NULL, n, NULL, q, &report), QUAT_OK);
        worse(&torsion, fabs(remainder(report.holonomy + total.torsion, 2 * pi)));
        if (round % 10 > 2) continue;
        const double coarse = carried_round(&curve, 2000),
                     fine = coarse + remainder(carried_round(&curve, 4000) - coarse, 2 * pi);
        worse(&polygon, fabs(remainder(report.holonomy - (fine + (fine - coarse) / 3), 2 * pi)));
    }
    assert_bound("holonomy + total torsion, full turns apart", torsion, 1e-9);
    assert_bound("holonomy against a polygon of tangents", polygon, 1e-9);
}

/* A plane curve's frame turns about its normal as often as its tangent goes round: an odd number of turns is -1. */
static bool limacon(double t, qvec3 d[4], void *context)
{
    const double loop = *(const double *)context;
    double c[4] = {cos(t), -sin(t), -cos(t), sin(t)}, s[4] = {sin(t), cos(t), -sin(t), -cos(t)}, power = loop;
    const double c2[4] = {cos(2 * t), -sin(2 * t), -cos(2 * t), sin(2 * t)},
                 s2[4] = {sin(2 * t), cos(2 * t), -sin(2 * t), -cos(2 * t)};
    for (int k = 0; k < 4; k++, power *= 2) d[k] = qvec3_make(c[k] + power * c2[k], s[k] + power * s2[k], 0);
    return true;
}
static bool eight(double t, qvec3 d[4], void *context)
{
    (void)context;
    d[0] = qvec3_make(sin(t), sin(2 * t) / 2, 0);
    d[1] = qvec3_make(cos(t), cos(2 * t), 0);
    d[2] = qvec3_make(-sin(t), -2 * sin(2 * t), 0);
    d[3] = qvec3_make(-cos(t), -4 * cos(2 * t), 0);
    return true;
}

static void monodromy_counts_turns(void **state)
{
    (void)state;
    quat q[201];
    quat_framing_report report;
    double round = 0.1, looped = 2;
    const quat_curve once = {limacon, &round, 0, 2 * pi, true, 3}, twice = {limacon, &looped, 0, 2 * pi, true, 3},
                     never = {eight, NULL, 0, 2 * pi, true, 3};
    const quat_curve *const curves[3] = {&never, &once, &twice};
    for (int turns = 0; turns < 3; turns++)
        for (int framing = QUAT_MINIMAL; framing <= QUAT_CLOSED; framing++) {
            assert_int_equal(quat_curve_frames(curves[turns], (quat_framing)framing, NULL, 201, NULL, q, &report),
                             QUAT_OK);
            assert_near(report.holonomy, 0, 1e-14);
            assert_int_equal(report.monodromy, turns == 1 ? -1 : 1);
        }
    assert_int_equal(quat_curve_frames(&never, QUAT_FRENET, NULL, 200, NULL, q, &report), QUAT_NOT_UNIQUE);
    assert_int_equal(report.inflections, 3); /* no normal at both ends, which are one place, and turned over half-way */
}

static void inflections_are_reported(void **state)
{
    (void)state;
    quat_family family;
    quat_curve curve;
    quat_curve_point point;
    quat_framing_report report;
    quat q[101];
    quat_cubic(1, true, &family, &curve);
    assert_int_equal(quat_curve_at(&curve, 0, &point), QUAT_NOT_UNIQUE);
    assert_true(point.curvature == 0 && point.torsion == 0 && quat_equal(point.frame, quat_identity()));
    assert_int_equal(quat_curve_at(&curve, 0.1, &point), QUAT_OK);
    assert_near3(quat_rotate(point.frame, qvec3_make(0, 0, 1)), qvec3_make(0, 0, 1), 1e-15);
    assert_int_equal(quat_curve_frames(&curve, QUAT_FRENET, NULL, 101, NULL, q, &report), QUAT_NOT_UNIQUE);
    assert_int_equal(report.inflections, 2); /* no normal at 0, and turned over after it */
    assert_int_equal(quat_curve_frames(&curve, QUAT_FRENET, NULL, 100, NULL, q, &report), QUAT_NOT_UNIQUE);
    assert_int_equal(report.inflections, 1);
    const quat up = {1, 0, 0, 0};
    assert_int_equal(quat_curve_frames(&curve, QUAT_MINIMAL, &up, 101, NULL, q, &report), QUAT_OK);
    assert_int_equal(report.inflections, 0);
    for (int i = 0; i < 101; i++) assert_near3(quat_rotate(q[i], qvec3_make(0, 0, 1)), qvec3_make(0, 0, 1), 1e-14);
}

/* A tangent that is almost the mirror image of the one before in the chord: the frame about it hangs on rounding, and
 * its x axis is the tangent all the same; a cusp has a status. */
static void beside_a_cusp(void **state)
{
    (void)state;
    random_state r = {317};
    int cusps = 0;
    double tangents = 0;
    for (int round = 0; round < 20000; round++) {
        const quat q = random_unit(&r);
        const qvec3 x1 = random_direction(&r), o = {0, 0, 0},
                    cusp = quat_reflect(x1, quat_rotate(q, qvec3_make(1, 0, 0)));
        qvec3 t1;
        quat next;
        const quat_status exact = quat_frame_step(q, o, x1, cusp, &next);
        assert_int_equal(exact, QUAT_EDOMAIN);
        assert_true(quat_equal(next, q));
        assert_int_equal(qvec3_normalize(qvec3_axpy(random_scale(&r, -17, 0), random_direction(&r), cusp), &t1),
                         QUAT_OK);
        const quat_status status = quat_frame_step(q, o, x1, t1, &next);
        const double apart = qvec3_norm(qvec3_sub(t1, cusp));
        assert_true(status == (apart > 2e-15 ? QUAT_OK : QUAT_EDOMAIN) || (apart > 1e-15 && apart < 3e-15));
        cusps += status != QUAT_OK;
        if (status == QUAT_OK) worse(&tangents, qvec3_norm(qvec3_sub(quat_rotate(next, qvec3_make(1, 0, 0)), t1)));
    }
    assert_true(cusps > 1000 && cusps < 4000);
    assert_bound("the tangent beside a cusp", tangents, 4e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(beside_a_cusp),
                                       cmocka_unit_test(steps_are_two_mirrors),
                                       cmocka_unit_test(minimal_frames_are_of_order_four),
                                       cmocka_unit_test(closed_frames_close),
                                       cmocka_unit_test(holonomy_is_taken_back_evenly),
                                       cmocka_unit_test(holonomy_is_minus_the_total_torsion),
                                       cmocka_unit_test(minimal_frames_go_the_shortest_way),
                                       cmocka_unit_test(monodromy_counts_turns),
                                       cmocka_unit_test(inflections_are_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
