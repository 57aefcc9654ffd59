/* SPDX-License-Identifier: MIT
 *
 * Every number of a call is looked at: with any one of them NaN or infinite the call is refused, and says so.
 */
#include <quat/average.h>
#include <quat/batch.h>
#include <quat/dual.h>
#include <quat/euler.h>
#include <quat/exponential.h>
#include <quat/integrate.h>
#include <quat/interpolate.h>
#include <quat/rotation.h>
#include <quat/spline.h>
#include "kit/near.h"

static const double bad[] = {NAN, INFINITY, -INFINITY};

/* taken(numbers): whether the call takes them. */
typedef bool call(const double *x);

static void each_in_turn(const char *name, call *taken, int n, const double *good)
{
    double x[32];
    for (int i = 0; i < n; i++) x[i] = good[i];
    if (!taken(x)) fail_msg("%s refuses good numbers", name);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            x[i] = bad[k];
            if (taken(x)) fail_msg("%s takes %g as number %d", name, bad[k], i);
            x[i] = good[i];
        }
}

static quat q_of(const double *x) { return (quat){x[0], x[1], x[2], x[3]}; }
static qvec3 v_of(const double *x) { return (qvec3){x[0], x[1], x[2]}; }

static bool normalizes(const double *x)
{
    quat r;
    return quat_normalize(q_of(x), &r) == QUAT_OK;
}

static bool inverts(const double *x)
{
    quat r;
    return quat_inverse(q_of(x), &r) == QUAT_OK;
}

static bool divides(const double *x)
{
    quat r, l;
    return quat_div(q_of(x), q_of(x + 4), &r) == QUAT_OK && quat_div_left(q_of(x + 4), q_of(x), &l) == QUAT_OK;
}

static bool has_log(const double *x)
{
    quat r;
    return quat_log(q_of(x), &r) == QUAT_OK;
}

static bool has_root(const double *x)
{
    quat r;
    return quat_sqrt(q_of(x), &r) == QUAT_OK;
}

static bool has_power(const double *x)
{
    quat r;
    return quat_pow(q_of(x), x[4], &r) == QUAT_OK;
}

static bool has_quaternion_power(const double *x)
{
    quat r;
    return quat_pow_quat(q_of(x), q_of(x + 4), &r) == QUAT_OK;
}

static bool to_euler(const double *x)
{
    double angles[3];
    quat_euler zyx;
    return quat_euler_from_name("ZYX", &zyx) == QUAT_OK && quat_to_euler(q_of(x), zyx, angles) == QUAT_OK;
}

static bool from_euler(const double *x)
{
    quat r;
    quat_euler zyx;
    return quat_euler_from_name("ZYX", &zyx) == QUAT_OK && quat_from_euler(x, zyx, &r) == QUAT_OK;
}

static bool to_axis(const double *x)
{
    qvec3 axis;
    double angle;
    return quat_to_axis_angle(q_of(x), &axis, &angle) == QUAT_OK;
}

static bool from_axis(const double *x)
{
    quat r;
    return quat_from_axis_angle(v_of(x), x[3], &r) == QUAT_OK;
}

static bool from_axes(const double *x)
{
    quat r;
    return quat_from_axes(v_of(x), v_of(x + 3), &r) == QUAT_OK;
}

static bool from_vectors(const double *x)
{
    quat r;
    return quat_from_two_vectors(v_of(x), v_of(x + 3), &r) == QUAT_OK;
}

static bool swings(const double *x)
{
    quat swing, twist;
    return quat_swing_twist(q_of(x), v_of(x + 4), &swing, &twist) == QUAT_OK;
}

static bool dual_inverts(const double *x)
{
    qdual r;
    return quat_dual_inverse((qdual){q_of(x), q_of(x + 4)}, &r) == QUAT_OK &&
           quat_dual_normalize((qdual){q_of(x), q_of(x + 4)}, &r) == QUAT_OK;
}

static bool from_screw(const double *x)
{
    qdual r;
    return quat_dual_from_screw(v_of(x), v_of(x + 3), x[6], x[7], &r) == QUAT_OK;
}

static bool aligns(const double *x)
{
    const qvec3 a[2] = {v_of(x), v_of(x + 3)}, b[2] = {v_of(x + 6), v_of(x + 9)};
    quat r;
    double residual;
    return quat_align(2, a, b, x + 12, &r, &residual) == QUAT_OK;
}

static qvec3 steady(double t, void *context)
{
    (void)t;
    return v_of(context);
}

static bool clamps(const double *x)
{
    const quat keys[2] = {q_of(x), q_of(x + 4)};
    quat_spline *s;
    const bool good = quat_spline_new(2, x + 8, keys, QUAT_SPLINE_CLAMPED, v_of(x + 10), v_of(x + 13), &s) == QUAT_OK;
    if (good != (s != NULL)) fail_msg("a spline and no status, or the reverse");
    quat_spline_free(s);
    return good;
}

static void every_number_is_looked_at(void **state)
{
    (void)state;
    const double two[] = {0.5, -0.4, 0.3, 0.2, 0.7, 0.1, -0.2, 0.6, 1, 2};
    each_in_turn("normalize", normalizes, 4, two);
    each_in_turn("inverse", inverts, 4, two);
    each_in_turn("division", divides, 8, two);
    each_in_turn("log", has_log, 4, two);
    each_in_turn("sqrt", has_root, 4, two);
    each_in_turn("pow", has_power, 5, two);
    each_in_turn("pow of quaternions", has_quaternion_power, 8, two);
    each_in_turn("to Euler angles", to_euler, 4, two);
    each_in_turn("from Euler angles", from_euler, 3, two);
    each_in_turn("to axis and angle", to_axis, 4, two);
    each_in_turn("from axis and angle", from_axis, 4, two);
    each_in_turn("from axes", from_axes, 6, two);
    each_in_turn("from two vectors", from_vectors, 6, two);
    each_in_turn("swing and twist", swings, 7, two);
    each_in_turn("dual inverse", dual_inverts, 8, two);
    each_in_turn("from a screw", from_screw, 8, two);
    const double sets[] = {1, 0, 0, 0, 1, 0, 0, 1, 0, -1, 0, 0, 1, 2};
    each_in_turn("align", aligns, 14, sets);
    const double spline[] = {1, 0, 0, 0, 0.8, 0.6, 0, 0, 0, 1, 0.1, 0.2, 0, 0.3, 0, 0.1};
    each_in_turn("a clamped spline", clamps, 16, spline);
}

static void integration_refuses(void **state)
{
    (void)state;
    double w[] = {0.1, 0.2, 0.3};
    quat r;
    const quat q = {1, 0, 0, 0};
    assert_int_equal(quat_integrate(steady, w, QUAT_BODY, QUAT_CF4, 0, 1, 10, q, &r), QUAT_OK);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(quat_integrate(steady, w, QUAT_BODY, QUAT_CF4, bad[k], 1, 10, q, &r), QUAT_EDOMAIN);
        assert_int_equal(quat_integrate(steady, w, QUAT_BODY, QUAT_CF4, 0, bad[k], 10, q, &r), QUAT_EDOMAIN);
        w[2] = bad[k];
        assert_int_equal(quat_integrate(steady, w, QUAT_BODY, QUAT_CF4, 0, 1, 10, q, &r), QUAT_EDOMAIN);
        w[2] = 0.3;
    }
}

static void infinite_and_nan_sizes(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        double x[4] = {NAN, NAN, NAN, NAN};
        x[i] = -INFINITY;
        assert_true(isinf(quat_norm(q_of(x)))); /* as hypot: infinite, whatever the others are */
        x[i] = NAN;
        assert_true(isnan(quat_norm(q_of(x))));
    }
    assert_true(isnan(quat_distance((quat){NAN, 0, 0, 0}, quat_identity())));
    assert_true(isnan(quat_rotation_distance(quat_identity(), (quat){1, NAN, 0, 0})));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_number_is_looked_at),
                                       cmocka_unit_test(integration_refuses), cmocka_unit_test(infinite_and_nan_sizes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
