/* SPDX-License-Identifier: MIT
 *
 * The oracle is the motion done in two plain steps, x -> R x + s, with quaternion and shift kept apart.
 */
#include "oracle.h"
#include <quat/dual.h>

static qvec3 some_shift(random_state *r) { return random_vector(r, random_scale(r, -3, 3)); }
static qdual somewhere(random_state *r, double reach)
{
    const qvec3 shift = random_vector(r, reach);
    return quat_dual_from(random_unit(r), shift);
}
static qvec3 apart(quat q, qvec3 s, qvec3 x) { return qvec3_add(quat_rotate(q, x), s); }
static double gap(qvec3 a, qvec3 b, double size) { return qvec3_norm(qvec3_sub(a, b)) / size; }

static void motions_compose(void **state)
{
    (void)state;
    random_state r = {91};
    double apply = 0, compose = 0, invert = 0, shift = 0, general = 0;
    for (int n = 0; n < 100000; n++) {
        const quat a = random_unit(&r), b = random_unit(&r);
        const qvec3 s = some_shift(&r), t = some_shift(&r), x = some_shift(&r);
        const double size = qvec3_norm(s) + qvec3_norm(t) + qvec3_norm(x);
        const qdual p = quat_dual_from(a, s), q = quat_dual_from(b, t), pq = quat_dual_mul(p, q);
        worse(&shift, gap(quat_dual_shift(p), s, qvec3_norm(s)));
        worse(&apply, gap(quat_dual_apply(p, x), apart(a, s, x), size));
        worse(&compose, gap(quat_dual_apply(pq, x), apart(a, s, apart(b, t, x)), size));
        worse(&invert, gap(quat_dual_apply(quat_dual_conj(p), apart(a, s, x)), x, size));
        worse(&invert, gap(quat_dual_apply_inverse(p, apart(a, s, x)), x, size));
        const qdual any = {random_any(&r), random_any(&r)};
        qdual inverse;
        if (quat_norm(any.real) < 0.1) continue;
        assert_int_equal(quat_dual_inverse(any, &inverse), QUAT_OK);
        const qdual one = quat_dual_mul(any, inverse);
        worse(&general, quat_norm(quat_sub(one.real, quat_identity())) + quat_norm(one.dual));
    }
    assert_bound("shift there and back", shift, 2e-15);
    assert_bound("motion of a point", apply, 3e-15);
    assert_bound("motion after motion", compose, 5e-15);
    assert_bound("and back", invert, 5e-15);
    assert_bound("p/p = 1, any p", general, 1e-13);
}

static void logarithms_and_screws(void **state)
{
    (void)state;
    random_state r = {92};
    double forth = 0, screw = 0, axis_worst = 0, slide_worst = 0, place = 0, again = 0;
    for (int n = 0; n < 100000; n++) {
        const double angle = n % 2 ? random_between(&r, 1e-3, 3.1) : random_scale(&r, -12, 0.4),
                     slide = random_between(&r, -5, 5);
        const qvec3 axis = random_direction(&r), far = some_shift(&r);
        /* taken off twice: once leaves a rounding error of far, which may be much the longer */
        const qvec3 near = qvec3_axpy(-qvec3_dot(far, axis), axis, far), x = some_shift(&r);
        const qvec3 point = qvec3_axpy(-qvec3_dot(near, axis), axis, near);
        const double size = 1 + qvec3_norm(point) + qvec3_norm(x) + fabs(slide);
        qdual p;
        assert_int_equal(quat_dual_from_screw(axis, point, angle, slide, &p), QUAT_OK);
        /* the definition: turn about the line, slide along it */
        quat q;
        quat_from_axis_angle(axis, angle, &q);
        const qvec3 want = qvec3_axpy(slide, axis, qvec3_add(point, quat_rotate(q, qvec3_sub(x, point))));
        worse(&screw, gap(quat_dual_apply(p, x), want, size));
        const qdual back = quat_dual_exp(quat_dual_log(n % 3 ? p : quat_dual_scale(p, -1)));
        worse(&forth, gap(quat_dual_apply(back, x), want, size));
        qvec3 found, found_point;
        double found_angle, found_slide;
        assert_int_equal(quat_dual_to_screw(p, &found, &found_point, &found_angle, &found_slide), QUAT_OK);
        worse(&axis_worst, qvec3_norm(qvec3_sub(found, axis)));
        worse(&slide_worst, fabs(found_slide - slide) / size);
        /* the place of the axis is as sharp as the angle is wide */
        worse(&place, qvec3_norm(qvec3_sub(found_point, point)) * fmin(angle, 1) / size);
        assert_true(fabs(found_angle - angle) < 2e-15);
        /* a short way may be a turn by little about a line far away */
        const qdual moved = quat_dual_from(q, x);
        quat_dual_to_screw(moved, &found, &found_point, &found_angle, &found_slide);
        assert_int_equal(quat_dual_from_screw(found, found_point, found_angle, found_slide, &p), QUAT_OK);
        worse(&again, gap(quat_dual_shift(p), x, qvec3_norm(x)));
    }
    assert_bound("motion by its screw", again, 4e-15);
    assert_bound("screw by its definition", screw, 4e-15);
    assert_bound("exp log p = p", forth, 6e-15);
    assert_bound("axis of the screw", axis_worst, 2e-15);
    assert_bound("slide of the screw", slide_worst, 2e-15);
    assert_bound("place of the screw, times its angle up to 1", place, 1e-14);
    qvec3 axis, point;
    double angle, slide;
    const qdual moved = quat_dual_from(quat_identity(), qvec3_make(0, 3, 4));
    assert_int_equal(quat_dual_to_screw(moved, &axis, &point, &angle, &slide), QUAT_NOT_UNIQUE);
    assert_true(angle == 0 && fabs(slide - 5) < 1e-15 && fabs(axis.y - 0.6) < 1e-15 && qvec3_norm(point) == 0);
    assert_int_equal(quat_dual_to_screw(quat_dual_identity(), &axis, &point, &angle, &slide), QUAT_NOT_UNIQUE);
    assert_true(axis.z == 1 && slide == 0);
}

static void screw_interpolation(void **state)
{
    (void)state;
    random_state r = {93};
    double half = 0, moved = 0, unit = 0;
    for (int n = 0; n < 100000; n++) {
        const qdual p = somewhere(&r, 2), q = somewhere(&r, 2);
        const double t = random_uniform(&r);
        const qdual s = quat_dual_sclerp(p, q, t);
        worse(&unit, fabs(quat_norm(s.real) - 1) + fabs(quat_dot(s.real, s.dual)));
        const qdual twice = quat_dual_sclerp(p, quat_dual_sclerp(p, q, 0.5), t), once = quat_dual_sclerp(p, q, 0.5 * t);
        const qvec3 x = random_direction(&r);
        /* near opposite orientations the shorter way is a matter of rounding, and the screw may be long */
        if (fabs(quat_dot(p.real, q.real)) > 0.05)
            worse(&half, gap(quat_dual_apply(twice, x), quat_dual_apply(once, x), 3));
        const qdual g = somewhere(&r, 1);
        const qdual a = quat_dual_mul(g, s), b = quat_dual_sclerp(quat_dual_mul(g, p), quat_dual_mul(g, q), t);
        if (fabs(quat_dot(p.real, q.real)) > 0.05) worse(&moved, gap(quat_dual_apply(a, x), quat_dual_apply(b, x), 4));
        assert_true(quat_equal(quat_dual_sclerp(p, q, 0).dual, p.dual));
        assert_true(quat_same_rotation(quat_dual_sclerp(p, q, 1).real, q.real, 0));
    }
    assert_bound("sclerp is unit", unit, 1e-14);
    assert_bound("half of half", half, 1e-14);
    assert_bound("g sclerp(p, q) = sclerp(gp, gq)", moved, 1e-14);
    /* a quarter turn about the line x = 1 along z, rising 2: half of it is an eighth of a turn, rising 1 */
    qdual p, eighth;
    quat_dual_from_screw(qvec3_make(0, 0, 1), qvec3_make(1, 0, 0), 2 * atan2(1, 1), 2, &p);
    quat_dual_from_screw(qvec3_make(0, 0, 1), qvec3_make(1, 0, 0), atan2(1, 1), 1, &eighth);
    const qdual s = quat_dual_sclerp(quat_dual_identity(), p, 0.5);
    assert_true(quat_near(s.real, eighth.real, 1e-15) && quat_near(s.dual, eighth.dual, 1e-15));
}

static void normalise_and_blend(void **state)
{
    (void)state;
    random_state r = {94};
    qdual unit, p[3];
    double askew = 0;
    for (int n = 0; n < 100000; n++) {
        const qdual any = {random_quat(&r, random_scale(&r, -100, 100)), random_any(&r)};
        assert_int_equal(quat_dual_normalize(any, &unit), QUAT_OK);
        assert_true(fabs(quat_norm(unit.real) - 1) < 1e-15);
        worse(&askew, fabs(quat_dot(unit.real, unit.dual)) / (1 + quat_norm(any.dual) / quat_norm(any.real)));
        for (int i = 0; i < 3; i++) p[i] = quat_dual_from(quat_make(1, 0, 0, 0), random_direction(&r));
        p[1] = quat_dual_scale(p[1], -1); /* the same motion */
        const double w[3] = {1, 2, 1};
        assert_int_equal(quat_dual_blend(3, p, w, &unit), QUAT_OK);
        const qvec3 a = quat_dual_shift(p[0]), b = quat_dual_shift(p[1]), c = quat_dual_shift(p[2]);
        assert_true(gap(quat_dual_shift(unit), qvec3_scale(qvec3_add(qvec3_add(a, c), qvec3_scale(b, 2)), 0.25), 1) <
                    1e-15);
    }
    /* two dot products of 3 u, the one taken off and the one that looks, and 2 u for taking off */
    assert_bound("real . dual = 0, over the dual's size", askew, 8 * ROUNDING);
    const qdual bad = {{0, 0, 0, 0}, {1, 0, 0, 0}}, nan = {{1, 0, 0, 0}, {NAN, 0, 0, 0}};
    assert_int_equal(quat_dual_normalize(bad, &unit), QUAT_EDOMAIN);
    assert_int_equal(quat_dual_normalize(nan, &unit), QUAT_EDOMAIN);
    assert_int_equal(quat_dual_inverse(bad, &unit), QUAT_EDOMAIN);
    assert_true(quat_equal(unit.real, quat_identity()));
    assert_int_equal(quat_dual_blend(0, p, NULL, &unit), QUAT_EARGUMENT);
    assert_int_equal(quat_dual_blend(1, &bad, NULL, &unit), QUAT_EDOMAIN);
    assert_int_equal(quat_dual_from_screw(qvec3_make(0, 0, 0), qvec3_make(0, 0, 0), 1, 0, &unit), QUAT_EDOMAIN);
    assert_int_equal(quat_dual_from_screw(qvec3_make(0, 0, 1), qvec3_make(0, NAN, 0), 1, 0, &unit), QUAT_EDOMAIN);
    /* finite, but too far */
    const qdual far = {{0.5, 0.5, 0.5, 0.5}, {0, 1.7e308, 1.7e308, -1.7e308}},
                near_zero = {{1e-300, 0, 0, 0}, {0, 1e10, 0, 0}};
    qvec3 axis, point;
    double angle, slide;
    assert_int_equal(quat_dual_to_screw(far, &axis, &point, &angle, &slide), QUAT_ERANGE);
    assert_true(axis.z == 1 && qvec3_norm(point) == 0 && angle == 0 && slide == 0);
    assert_int_equal(quat_dual_normalize(near_zero, &unit), QUAT_ERANGE);
    assert_int_equal(quat_dual_from_screw(qvec3_make(0, 0, 1), qvec3_make(1.7e308, 0, 0), 3, 1, &unit), QUAT_ERANGE);
    assert_true(quat_equal(unit.real, quat_identity()));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(motions_compose), cmocka_unit_test(logarithms_and_screws),
                                       cmocka_unit_test(screw_interpolation), cmocka_unit_test(normalise_and_blend)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
