/* SPDX-License-Identifier: MIT
 *
 * At the limits: answers that overflow are refused and leave what the header says; cases between two branches hold the
 * identity that both hold; outputs that nobody wants may be NULL; memory that is refused is told.
 */
#include <quat/average.h>
#include <quat/batch.h>
#include <quat/dual.h>
#include <quat/euler.h>
#include <quat/exponential.h>
#include <quat/interpolate.h>
#include <quat/jacobian.h>
#include <quat/project.h>
#include <quat/rotation.h>
#include <quat/sequence.h>
#include <quat/spline.h>
#include <float.h>
#include "kit/near.h"

static long refuse_at; /* the allocation, counted from here, that is refused; 0: none */
void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_malloc(size_t size) { return refuse_at > 0 && --refuse_at == 0 ? NULL : __real_malloc(size); }

static const quat one = {1, 0, 0, 0};

static void assert_equal4(quat got, quat wanted) { assert_true(quat_equal(got, wanted)); }

/* ---- overflow ---- */

static void points_too_far_apart(void **state)
{
    (void)state;
    const qvec3 far[2] = {{1.7e308, 0, 0}, {-1.7e308, 0, 0}}, near[2] = {{1, 0, 0}, {0, 1, 0}};
    quat q;
    qvec3 shift;
    double residual;
    assert_int_equal(quat_align_points(2, far, near, NULL, &q, &shift, &residual), QUAT_ERANGE);
    assert_int_equal(quat_align_points(2, near, far, NULL, &q, &shift, NULL), QUAT_ERANGE);
    assert_equal4(q, one);
    assert_near3(shift, (qvec3){0, 0, 0}, 0);
    assert_true(isnan(residual));
    /* sets that fit, but whose shift from the one to the other overflows */
    const qvec3 left[2] = {{-1.7e308, 0, 0}, {-1.69e308, 0, 0}}, right[2] = {{1.7e308, 0, 0}, {1.71e308, 0, 0}};
    assert_int_equal(quat_align_points(2, left, right, NULL, &q, &shift, &residual), QUAT_ERANGE);
    assert_int_equal(quat_align_points(2, left, right, NULL, &q, &shift, NULL), QUAT_ERANGE);
    assert_equal4(q, one);
    assert_near3(shift, (qvec3){0, 0, 0}, 0);
    assert_true(isnan(residual));
}

static void screws_out_of_range(void **state)
{
    (void)state;
    qdual r;
    const qdual small = {{1e-200, 0, 0, 0}, {0, 1, 0, 0}};
    assert_int_equal(quat_dual_inverse(small, &r), QUAT_ERANGE);
    assert_equal4(r.real, one);
    assert_near(quat_norm(r.dual), 0, 0);
    qvec3 axis, point;
    double angle, slide;
    /* |shift| is beyond the doubles, none of its numbers is */
    const qdual far = quat_dual_make(one, quat_make(0, 8e307, 8e307, 8e307));
    assert_int_equal(quat_dual_to_screw(far, &axis, &point, &angle, &slide), QUAT_ERANGE);
    assert_near(angle, 0, 0);
    assert_near(slide, 0, 0);
    assert_near3(axis, (qvec3){0, 0, 1}, 0);
    /* so small a turn that its axis lies out of the range: a shift */
    const qdual still = quat_dual_from(quat_from_rotation_vector((qvec3){0, 0, 1e-308}), (qvec3){3, 4, 0});
    assert_int_equal(quat_dual_to_screw(still, &axis, &point, &angle, &slide), QUAT_NOT_UNIQUE);
    assert_near(angle, 0, 0);
    assert_near(slide, 5, 5 * DBL_EPSILON);
    assert_near3(axis, (qvec3){0.6, 0.8, 0}, 2 * DBL_EPSILON);
    assert_near3(point, (qvec3){0, 0, 0}, 0);
}

static void powers_out_of_range(void **state)
{
    (void)state;
    quat r;
    assert_int_equal(quat_pow_quat(quat_make(1e300, 0, 0, 0), quat_make(0, 1e308, 0, 0), &r), QUAT_ERANGE);
    assert_equal4(r, one);
    assert_int_equal(quat_pow_quat(quat_make(10, 0, 0, 0), quat_make(1e3, 0, 0, 0), &r), QUAT_ERANGE);
}

/* ---- between two branches ---- */

static void powers_at_the_cut(void **state)
{
    (void)state;
    quat r, l, back;
    const quat p = {-3, 4, -12, 84};
    assert_int_equal(quat_pow(p, 1, &r), QUAT_OK);
    assert_equal4(r, p);
    assert_int_equal(quat_pow(quat_make(-4, 0, 0, 0), 0.5, &r), QUAT_NOT_UNIQUE);
    assert_int_equal(quat_mul(r, r).w < 0, true);
    assert_near(quat_norm(quat_sub(quat_mul(r, r), quat_make(-4, 0, 0, 0))), 0, 8 * DBL_EPSILON);
    for (int k = 1; k < 4; k++) { /* beside the cut, along each axis: the log is unique, and exp undoes it */
        double x[4] = {-2, 0, 0, 0};
        x[k] = 1e-3;
        const quat q = {x[0], x[1], x[2], x[3]};
        assert_int_equal(quat_log(q, &l), QUAT_OK);
        assert_int_equal(quat_exp(l, &back), QUAT_OK);
        assert_near(quat_norm(quat_sub(back, q)), 0, 2 * 4 * DBL_EPSILON);
        assert_int_equal(quat_pow(q, 3, &r), QUAT_OK);
        assert_near(quat_norm(quat_sub(r, quat_mul(q, quat_mul(q, q)))), 0, 8 * 16 * DBL_EPSILON);
    }
}

static void slerp_of_one_orientation(void **state)
{
    (void)state;
    const quat p = quat_from_rotation_vector((qvec3){0.3, -0.2, 0.9}), q = quat_from_rotation_vector((qvec3){1, 2, 0});
    assert_equal4(quat_slerp_as_given(p, q, 1), q);
    assert_equal4(quat_slerp_as_given(p, quat_neg(q), 1), quat_neg(q));
    assert_equal4(quat_slerp(p, p, 2.5), p);
    assert_equal4(quat_slerp_as_given(p, p, -1), p);
    assert_true(isnan(quat_slerp(p, p, NAN).w) && isnan(quat_slerp_as_given(p, q, NAN).w));
    /* beyond the ends: as far again past q as p is before it */
    const quat beyond = quat_slerp_as_given(p, q, 2), mirrored = quat_mul(quat_mul(q, quat_conj(p)), q);
    assert_near(quat_norm(quat_sub(beyond, mirrored)), 0, 8 * DBL_EPSILON);
}

static void half_turns_about_every_axis(void **state)
{
    (void)state;
    const qvec3 a[] = {{0.1, 2, 3}, {2, 0.1, 3}, {3, 2, 0.1}, {2, 2, 0.1}, {1, 1, 1}, {0, 0, 2}, {2, 0, 0}};
    for (size_t i = 0; i < sizeof a / sizeof *a; i++) {
        quat q;
        assert_int_equal(quat_from_two_vectors(a[i], qvec3_scale(a[i], -2), &q), QUAT_NOT_UNIQUE);
        assert_near3(quat_rotate(q, a[i]), qvec3_scale(a[i], -1), 8 * DBL_EPSILON * qvec3_norm(a[i]));
        assert_near(q.w, 0, DBL_EPSILON);
    }
}

/* The x axis is met to roundings however nearly parallel the two are; the z axis as well as y tells it. */
static void axes_that_are_nearly_parallel(void **state)
{
    (void)state;
    const qvec3 across = {2 / sqrt(5), -1 / sqrt(5), 0};
    qvec3 x;
    qvec3_normalize((qvec3){1, 2, 3}, &x);
    for (double angle = 1e-1; angle > 1e-14; angle *= 0.3) {
        quat q;
        assert_int_equal(quat_from_axes(x, qvec3_axpy(angle, across, x), &q), QUAT_OK);
        const qvec3 ex = quat_rotate(q, (qvec3){1, 0, 0}), ez = quat_rotate(q, (qvec3){0, 0, 1});
        assert_near3(ex, x, 4 * DBL_EPSILON);
        assert_near3(ez, qvec3_cross(x, across), 4 * DBL_EPSILON / angle);
    }
}

static void logarithms_rates_at_one(void **state)
{
    (void)state;
    const double sizes[] = {0, 5e-324, 1e-160, 1e-9, 1e-5, 1e-3, 0.02};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        const double n = sizes[k], a[3] = {0.6 * n, 0.64 * n, 0.48 * n};
        const qmat34 r = quat_log_jacobian((quat){sqrt(1 - n * n), a[0], a[1], a[2]});
        for (int i = 0; i < 3; i++) {
            assert_true(r.m[i][0] == -a[i]);
            for (int j = 0; j < 3; j++) { /* f = 1 + n^2/6 ..., slope = -2/3 - n^2/5 ... */
                const double slope = -2.0 / 3 - n * n / 5, wanted = (i == j ? 1 + n * n / 6 : 0) + slope * a[i] * a[j];
                assert_near(r.m[i][1 + j], wanted, n * n * n * n + (i == j ? 2e-16 : 1e-15 * n * n));
            }
        }
    }
}

static void sequences_that_are_none(void **state)
{
    (void)state;
    const double angles[3] = {0.1, 0.2, 0.3};
    double got[3];
    quat q;
    int good = 0;
    for (unsigned code = 0; code < 0x100; code++) {
        const unsigned a = code >> 4 & 3, b = code >> 2 & 3, c = code & 3;
        const bool is = code < 0x80 && a < 3 && b < 3 && c < 3 && a != b && b != c; /* 12, in either way */
        assert_int_equal(quat_from_euler(angles, (quat_euler)code, &q) == QUAT_OK, is);
        assert_int_equal(quat_to_euler(one, (quat_euler)code, got) != QUAT_EARGUMENT, is);
        good += is;
        if (!is) assert_equal4(q, one);
    }
    assert_int_equal(good, 24);
}

static void projections_of_nothing(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        double x[3] = {0.1, 0.2, 0.3};
        x[k] = NAN;
        assert_true(isnan(quat_from_stereographic((qvec3){x[0], x[1], x[2]}, QUAT_SOUTH_POLE).w));
    }
    assert_true(isnan(quat_from_stereographic((qvec3){0, 0, 0}, (quat_pole)7).w));
    /* the fibre's angle, where w alone is 0: q = k has exp(k t) with t = pi/2 */
    assert_near(quat_hopf_angle(quat_make(0, 0, 0, 1)), 1.57079632679489661923, DBL_EPSILON);
}

/* ---- what is not wanted, and memory ---- */

static void outputs_may_be_absent(void **state)
{
    (void)state;
    const qmat3 turned = quat_to_matrix(quat_from_rotation_vector((qvec3){1, 2, 3})), none = {{{0}}};
    const qmat3 m[4] = {turned, none, turned, none};
    quat out[4], frames[3];
    qvec3 centre[3];
    size_t bad;
    assert_int_equal(quat_from_matrix_array(4, m, out, &bad), QUAT_EDOMAIN);
    assert_int_equal(bad, 1); /* the first of two */
    assert_int_equal(quat_from_matrix_array(4, m, out, NULL), QUAT_EDOMAIN);
    assert_int_equal(quat_from_matrix_array(1, m, out, NULL), QUAT_OK);
    quat_belt_frames(0.3, 3, frames, NULL);
    quat_belt_frames(0.3, 3, NULL, centre);
    for (int i = 0; i < 3; i++) {
        assert_equal4(frames[i], quat_belt_untwist(0.3, 0.5 * i));
        assert_near3(centre[i], quat_belt_centre(0.3, 0.5 * i), 0);
    }
    const qmat3 broken = {{{1, 0, 0}, {0, NAN, 0}, {0, 0, 1}}};
    quat q;
    double distance;
    assert_int_equal(quat_from_matrix_nearest(&broken, &q, &distance), QUAT_EDOMAIN);
    assert_true(isnan(distance));
    assert_equal4(q, one);
}

static void splines(void **state)
{
    (void)state;
    const double t[3] = {0, 1, 2};
    const quat q[3] = {one, quat_from_rotation_vector((qvec3){0, 0, 1}), quat_from_rotation_vector((qvec3){0, 0, 3})};
    const qvec3 none = {0, 0, 0};
    quat_spline *s;
    for (long at = 1; at <= 2; at++) {
        refuse_at = at;
        assert_int_equal(quat_spline_new(3, t, q, QUAT_SPLINE_NATURAL, none, none, &s), QUAT_ENOMEM);
        assert_null(s);
        assert_int_equal(refuse_at, 0);
    }
    assert_int_equal(quat_spline_new(SIZE_MAX / 8, t, q, QUAT_SPLINE_NATURAL, none, none, &s), QUAT_EARGUMENT);
    assert_int_equal(quat_spline_new(3, t, q, QUAT_SPLINE_NATURAL, none, none, &s), QUAT_OK);
    qvec3 omega = none, acceleration = none;
    assert_true(isnan(quat_spline_state(s, NAN, NULL, NULL).w));
    assert_true(isnan(quat_spline_state(s, INFINITY, &omega, &acceleration).w));
    assert_true(isnan(omega.x) && isnan(acceleration.z));
    quat_spline_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_too_far_apart),     cmocka_unit_test(screws_out_of_range),
        cmocka_unit_test(powers_out_of_range),      cmocka_unit_test(powers_at_the_cut),
        cmocka_unit_test(slerp_of_one_orientation), cmocka_unit_test(half_turns_about_every_axis),
        cmocka_unit_test(sequences_that_are_none),  cmocka_unit_test(projections_of_nothing),
        cmocka_unit_test(outputs_may_be_absent),    cmocka_unit_test(axes_that_are_nearly_parallel),
        cmocka_unit_test(logarithms_rates_at_one),  cmocka_unit_test(splines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
