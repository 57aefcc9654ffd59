/* SPDX-License-Identifier: MIT
 *
 * One test for each line of docs/conventions.md about quaternions.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <quat/euler.h>
#include <quat/project.h>
#include <quat/rotation.h>

static const quat i = {0, 1, 0, 0}, j = {0, 0, 1, 0}, k = {0, 0, 0, 1};
static const qvec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};

static void assert_quat(quat got, quat wanted) { assert_true(quat_norm(quat_sub(got, wanted)) < 1e-15); }
static void assert_vec3(qvec3 got, qvec3 wanted) { assert_true(qvec3_norm(qvec3_sub(got, wanted)) < 1e-15); }

static quat turn(qvec3 axis, double angle)
{
    quat q;
    assert_int_equal(quat_from_axis_angle(axis, angle, &q), QUAT_OK);
    return q;
}

static const double quarter = 1.5707963267948966;

static void order_is_w_first(void **state)
{
    (void)state;
    const quat q = quat_make(1, 2, 3, 4);
    assert_true(q.w == 1 && q.x == 2 && q.y == 3 && q.z == 4);
    const double *in_memory = &q.w;
    assert_true(in_memory == (const double *)&q);
}

static void product_is_hamiltons(void **state)
{
    (void)state;
    assert_quat(quat_mul(i, j), k);
    assert_quat(quat_mul(quat_mul(i, j), k), quat_make(-1, 0, 0, 0));
}

static void rotation_is_active_and_right_handed(void **state)
{
    (void)state;
    const quat q = turn(z, quarter);
    assert_vec3(quat_rotate(q, x), y);
    assert_quat(quat_mul(quat_mul(q, i), quat_conj(q)), j);
}

static void product_turns_by_the_right_factor_first(void **state)
{
    (void)state;
    const quat p = turn(z, quarter), q = turn(x, quarter);
    assert_vec3(quat_rotate(quat_mul(p, q), y), quat_rotate(p, quat_rotate(q, y)));
    assert_vec3(quat_rotate(quat_mul(p, q), y), z);
}

static void matrix_columns_are_the_body_axes(void **state)
{
    (void)state;
    const qmat3 m = quat_to_matrix(turn(z, quarter));
    assert_vec3(qvec3_make(m.m[0][0], m.m[1][0], m.m[2][0]), y);
    assert_vec3(qmat3_apply(&m, x), y);
}

static void rotations_are_blind_to_the_sign(void **state)
{
    (void)state;
    const quat q = turn(y, 1);
    assert_vec3(quat_rotate(quat_neg(q), x), quat_rotate(q, x));
    assert_vec3(quat_to_rotation_vector(quat_neg(q)), quat_to_rotation_vector(q));
}

static void angular_velocity_is_in_world_axes(void **state)
{
    (void)state;
    const quat q = turn(x, quarter);
    const double dt = 1e-6;
    const quat later = quat_mul(quat_from_rotation_vector(qvec3_scale(z, dt)), q);
    const quat rate = quat_scale(quat_mul(quat_pure(z), q), 0.5);
    assert_true(quat_norm(quat_sub(later, quat_axpy(dt, rate, q))) < dt * dt);
}

static void capital_letters_turn_about_the_bodys_axes(void **state)
{
    (void)state;
    const double angles[3] = {0.1, 0.2, 0.3};
    const quat rx = turn(x, 0.1), ry = turn(y, 0.2), rz = turn(z, 0.3);
    quat_euler sequence;
    quat q;
    assert_int_equal(quat_euler_from_name("XYZ", &sequence), QUAT_OK);
    assert_int_equal(quat_from_euler(angles, sequence, &q), QUAT_OK);
    assert_quat(q, quat_mul(rx, quat_mul(ry, rz)));
    assert_int_equal(quat_euler_from_name("xyz", &sequence), QUAT_OK);
    assert_int_equal(quat_from_euler(angles, sequence, &q), QUAT_OK);
    assert_quat(q, quat_mul(rz, quat_mul(ry, rx)));
}

static void projections_of_s3_are_from_minus_one(void **state)
{
    (void)state;
    qvec3 image;
    double line;
    assert_int_equal(quat_stereographic(quat_identity(), QUAT_SOUTH_POLE, &image), QUAT_OK);
    assert_vec3(image, qvec3_make(0, 0, 0));
    assert_int_equal(quat_stereographic(quat_make(-0.6, 0.8, 0, 0), QUAT_SOUTH_POLE, &image), QUAT_OK);
    assert_vec3(image, qvec3_make(2, 0, 0));
    assert_int_equal(quat_stereographic_circle(qvec2_make(0.8, 0.6), QUAT_NORTH_POLE, &line), QUAT_OK);
    assert_true(fabs(line - 2) < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(order_is_w_first),
        cmocka_unit_test(product_is_hamiltons),
        cmocka_unit_test(rotation_is_active_and_right_handed),
        cmocka_unit_test(product_turns_by_the_right_factor_first),
        cmocka_unit_test(matrix_columns_are_the_body_axes),
        cmocka_unit_test(rotations_are_blind_to_the_sign),
        cmocka_unit_test(angular_velocity_is_in_world_axes),
        cmocka_unit_test(projections_of_s3_are_from_minus_one),
        cmocka_unit_test(capital_letters_turn_about_the_bodys_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
