/* SPDX-License-Identifier: MIT */
#include "oracle.h"
#include <quat/exponential.h>
#include <quat/rotation.h>

static const double pi = 3.14159265358979323846;

/* ---- conventions, by hand ---- */

static void conventions(void **state)
{
    (void)state;
    const double h = sqrt(0.5), e = 1e-15;
    const quat about_z = {h, 0, 0, h}, about_x = {h, h, 0, 0};
    /* active and right-handed: 90 degrees about z carries x to y */
    const qvec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    assert_true(qvec3_norm(qvec3_sub(quat_rotate(about_z, x), y)) < e);
    assert_true(qvec3_norm(qvec3_sub(quat_rotate_inverse(about_z, y), x)) < e);
    /* p q applies q first: z first carries x to y, then x carries y to z */
    assert_true(qvec3_norm(qvec3_sub(quat_rotate(quat_mul(about_x, about_z), x), z)) < e);
    /* the matrix' columns are the body axes in the world */
    const qmat3 m = quat_to_matrix(about_z);
    assert_true(fabs(m.m[1][0] - 1) < e && fabs(m.m[0][1] + 1) < e && fabs(m.m[2][2] - 1) < e);
    /* omega is in the world frame unless the name says body: body x, turned to world y */
    const quat dq = quat_derivative_body(about_z, x);
    assert_true(qvec3_norm(qvec3_sub(quat_omega_world(about_z, dq), y)) < e);
    assert_true(qvec3_norm(qvec3_sub(quat_omega_body(about_z, quat_derivative_world(about_z, y)), x)) < e);
    /* -90 about y, 90 about x, 90 about y is -90 about z */
    const quat back = {h, 0, -h, 0}, forth = {h, 0, h, 0};
    assert_true(quat_same_rotation(quat_mul(forth, quat_mul(about_x, back)), quat_conj(about_z), 1e-15));
}

/* ---- the operator ---- */

static void rotate_is_within_its_bar(void **state)
{
    (void)state;
    random_state r = {21};
    double worst = 0, length = 0, compose = 0, there_and_back = 0;
    for (int n = 0; n < 200000; n++) {
        const quat q = random_unit(&r), p = random_unit(&r);
        qvec3 v = random_direction(&r);
        if (n % 4 == 0) v.z *= random_scale(&r, -20, 0);
        if (n % 4 == 0) v.x *= random_scale(&r, -20, 0);
        const double size = qvec3_norm(v);
        worse(&worst, error_of_vector(quat_rotate(q, v), wide_rotate(wide_unit(wide_quat(q)), wide_vec(v))));
        worse(&length, fabs(qvec3_norm(quat_rotate(q, v)) / size - 1));
        worse(&compose,
              qvec3_norm(qvec3_sub(quat_rotate(quat_mul(p, q), v), quat_rotate(p, quat_rotate(q, v)))) / size);
        worse(&there_and_back, qvec3_norm(qvec3_sub(quat_rotate_inverse(q, quat_rotate(q, v)), v)) / size);
        assert_true(qvec3_norm(qvec3_sub(quat_rotate(q, v), quat_rotate(quat_neg(q), v))) == 0);
    }
    assert_bound("rotate error, u", worst, 6.5);
    assert_bound("|rotate(v)| = |v|", length, 2e-15);
    assert_bound("(pq) v = p (q v)", compose, 4e-15);
    assert_bound("rotate_inverse(rotate(v)) = v", there_and_back, 4e-15);
    const qvec3 twice = quat_rotate(quat_make(sqrt(2), 0, 0, sqrt(2)), qvec3_make(1, 0, 0));
    assert_true(qvec3_norm(qvec3_sub(twice, qvec3_make(0, 4, 0))) < 1e-14);
}

static void two_reflections_are_a_rotation(void **state)
{
    (void)state;
    random_state r = {22};
    double worst = 0, product = 0;
    for (int n = 0; n < 100000; n++) {
        const qvec3 a = random_direction(&r), b = random_direction(&r), v = random_direction(&r);
        const quat q = quat_from_reflections(a, b);
        worse(&worst, qvec3_norm(qvec3_sub(quat_rotate(q, v), quat_reflect(b, quat_reflect(a, v)))));
        worse(&product, quat_norm(quat_add(q, quat_mul(quat_pure(b), quat_pure(a)))));
    }
    assert_bound("rotation by two reflections", worst, 4e-15);
    assert_bound("q = -n2 n1", product, 5e-16);
    /* normals 45 degrees apart turn by 90 */
    const quat q = quat_from_reflections(qvec3_make(1, 0, 0), qvec3_make(sqrt(0.5), sqrt(0.5), 0));
    assert_true(fabs(quat_angle(q) - pi / 2) < 1e-15);
    /* one reflection turns a right-handed frame into a left-handed one */
    const qvec3 n = {0.6, 0, 0.8}, x = quat_reflect(n, qvec3_make(1, 0, 0)), y = quat_reflect(n, qvec3_make(0, 1, 0));
    assert_true(fabs(qvec3_dot(qvec3_cross(x, y), quat_reflect(n, qvec3_make(0, 0, 1))) + 1) < 1e-15);
}

/* ---- axis, angle, rotation vector ---- */

static void axes_angles_and_vectors(void **state)
{
    (void)state;
    random_state r = {23};
    double from = 0, vector = 0, back = 0, angle_worst = 0;
    for (int n = 0; n < 100000; n++) {
        const double angle = n % 2 ? random_scale(&r, -300, 0.49) : random_between(&r, 0, pi);
        const qvec3 axis = random_direction(&r), v = qvec3_scale(axis, angle);
        const qvec3 scaled = qvec3_scale(axis, random_scale(&r, -307, 307));
        quat q;
        assert_int_equal(quat_from_axis_angle(scaled, angle, &q), QUAT_OK);
        const wquat half = wide_scale(wide_unit(wide_vec(scaled)), (wide)angle / 2);
        worse(&from, error_of_parts(q, wide_exp(half)));
        worse(&vector, error_of_parts(quat_from_rotation_vector(v), wide_exp(wide_scale(wide_vec(v), (wide)0.5))));
        worse(&back, error_of_vector(quat_to_rotation_vector(n % 3 ? q : quat_neg(q)), wide_scale(half, 2)));
        qvec3 a;
        double t;
        assert_int_equal(quat_to_axis_angle(n % 3 ? q : quat_neg(q), &a, &t), QUAT_OK);
        worse(&angle_worst, fabs(t - angle) / angle / ROUNDING);
        if (angle < pi - 1e-6) assert_true(qvec3_norm(qvec3_sub(a, axis)) < 1e-15);
    }
    assert_bound("from axis and angle, each part, u", from, 6);
    assert_bound("from rotation vector, each part, u", vector, 3);
    assert_bound("rotation vector there and back, u", back, 6);
    assert_bound("angle there and back, u", angle_worst, 6);
    quat q;
    qvec3 a;
    double t;
    assert_int_equal(quat_from_axis_angle(qvec3_make(0, 0, 0), 1, &q), QUAT_EDOMAIN);
    assert_int_equal(quat_from_axis_angle(qvec3_make(1, 0, 0), INFINITY, &q), QUAT_EDOMAIN);
    assert_true(quat_equal(q, quat_identity()));
    assert_int_equal(quat_to_axis_angle(quat_make(-1, 0, 0, 0), &a, &t), QUAT_NOT_UNIQUE);
    assert_true(t == 0 && a.x == 1);
    assert_int_equal(quat_to_axis_angle(quat_make(0, 0, 0, 0), &a, &t), QUAT_EDOMAIN);
    const qvec3 half_turn = quat_to_rotation_vector(quat_make(0, 0, -1, 0));
    assert_true(half_turn.y == -pi);
}

/* ---- matrices ---- */

static void matrices_there_and_back(void **state)
{
    (void)state;
    random_state r = {24};
    double to = 0, from = 0;
    for (int n = 0; n < 100000; n++) {
        quat q = random_unit(&r);
        if (n % 4 == 0) q = quat_exp_pure(random_vector(&r, 0.5 * pi + random_scale(&r, -16, -1)));
        if (n % 4 == 1) q = quat_exp_pure(random_vector(&r, random_scale(&r, -18, -1)));
        const qmat3 m = quat_to_matrix(q);
        for (int j = 0; j < 3; j++) {
            const wquat column = wide_rotate(wide_unit(wide_quat(q)), (wquat){0, j == 0, j == 1, j == 2});
            worse(&to, error_of_vector(qvec3_make(m.m[0][j], m.m[1][j], m.m[2][j]), column));
        }
        quat back;
        assert_int_equal(quat_from_matrix(&m, &back), QUAT_OK);
        assert_true(back.w >= 0);
        worse(&from, error_of(quat_nearest(back, q), wide_unit(wide_quat(q))));
    }
    assert_bound("to matrix, column error, u", to, 6.5);
    assert_bound("to matrix and back, u", from, 5);
    const qmat3 bad = {{{NAN, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, worse_one = {{{INFINITY, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    quat q;
    assert_int_equal(quat_from_matrix(&bad, &q), QUAT_EDOMAIN);
    assert_int_equal(quat_from_matrix(&worse_one, &q), QUAT_EDOMAIN);
    assert_true(quat_equal(q, quat_identity()));
    const qmat3 nothing = {{{0}}}, small = {{{1e-20, 0, 0}, {0, 1e-20, 0}, {0, 0, 1e-20}}};
    const qmat3 large = {{{1e150, 0, 0}, {0, 1e150, 0}, {0, 0, 1e150}}};
    assert_int_equal(quat_from_matrix(&nothing, &q), QUAT_EDOMAIN);
    assert_int_equal(quat_from_matrix(&small, &q), QUAT_EDOMAIN);
    assert_int_equal(quat_from_matrix(&large, &q), QUAT_EDOMAIN);
    assert_true(quat_equal(q, quat_identity()));
    /* the four half turns and the identity, exactly */
    const qmat3 about_x = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}}, about_y = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
    assert_int_equal(quat_from_matrix(&about_x, &q), QUAT_OK);
    assert_true(fabs(q.x) == 1 && q.w == 0);
    assert_int_equal(quat_from_matrix(&about_y, &q), QUAT_OK);
    assert_true(fabs(q.y) == 1);
}

/* tr(R^T m), which the nearest rotation makes largest. */
static double fit(quat q, const qmat3 *m)
{
    const qmat3 r = quat_to_matrix(q);
    double sum = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) sum += r.m[i][j] * m->m[i][j];
    return sum;
}

static void noisy_matrices_give_the_nearest_rotation(void **state)
{
    (void)state;
    random_state r = {25};
    double exact = 0, stationary = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_unit(&r);
        qmat3 m = quat_to_matrix(q);
        quat found;
        double distance;
        assert_int_equal(quat_from_matrix_nearest(&m, &found, &distance), QUAT_OK);
        worse(&exact, quat_rotation_distance(found, q));
        assert_true(distance < 1e-15 * 10);
        const double scale = random_scale(&r, -300, 300), noise = random_scale(&r, -10, -0.3);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) m.m[i][j] = scale * (m.m[i][j] + noise * random_between(&r, -1, 1));
        const quat_status status = quat_from_matrix_nearest(&m, &found, NULL);
        assert_true(status == QUAT_OK);
        /* the condition for it: R^T m is symmetric */
        const qmat3 rot = quat_to_matrix(found), back = qmat3_transpose(&rot), s = qmat3_mul(&back, &m);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < i; j++) worse(&stationary, fabs(s.m[i][j] - s.m[j][i]) / scale);
        if (n % 20 == 0)
            for (int k = 0; k < 20; k++) assert_true(fit(random_unit(&r), &m) <= fit(found, &m) * (1 + 1e-14));
    }
    assert_bound("nearest to an exact rotation, rad", exact, 3e-15);
    assert_bound("R^T m symmetric", stationary, 1e-14);
    const qmat3 zero = {{{0}}}, mirror = {{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}},
                line = {{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    quat q;
    double distance;
    assert_int_equal(quat_from_matrix_nearest(&zero, &q, &distance), QUAT_EDOMAIN);
    assert_true(isnan(distance) && quat_equal(q, quat_identity()));
    assert_int_equal(quat_from_matrix_nearest(&mirror, &q, &distance), QUAT_NOT_UNIQUE);
    assert_true(fabs(distance - 2) < 1e-14);
    assert_int_equal(quat_from_matrix_nearest(&line, &q, NULL), QUAT_NOT_UNIQUE);
}

/* ---- from vectors ---- */

static void two_vectors(void **state)
{
    (void)state;
    random_state r = {26};
    double worst = 0, shortest = 0;
    for (int n = 0; n < 100000; n++) {
        const qvec3 a = random_direction(&r), d = random_direction(&r);
        /* any angle, nearly parallel and nearly opposite, at any length */
        const double near = random_scale(&r, -15, 0);
        qvec3 b = n % 3 == 0 ? d : qvec3_axpy(near, d, n % 3 == 1 ? a : qvec3_neg(a));
        const double scale = random_scale(&r, -290, 290);
        quat q;
        assert_true(quat_from_two_vectors(qvec3_scale(a, scale), qvec3_scale(b, 1 / scale), &q) >= 0);
        const wquat want = wide_unit(wide_vec(b));
        worse(&worst, error_of_vector(quat_rotate(q, a), want));
        /* the shortest way turns about an axis perpendicular to a */
        worse(&shortest, fabs(qvec3_dot(quat_vector(q), a)));
    }
    assert_bound("R a = b, u", worst, 16);
    assert_bound("axis perpendicular to a", shortest, 1e-15);
    quat q;
    assert_int_equal(quat_from_two_vectors(qvec3_make(0, 0, 2), qvec3_make(0, 0, -3), &q), QUAT_NOT_UNIQUE);
    assert_true(qvec3_norm(qvec3_sub(quat_rotate(q, qvec3_make(0, 0, 1)), qvec3_make(0, 0, -1))) < 1e-15);
    assert_int_equal(quat_from_two_vectors(qvec3_make(0, 0, 0), qvec3_make(0, 0, 1), &q), QUAT_EDOMAIN);
    assert_true(quat_equal(q, quat_identity()));
}

static void frames(void **state)
{
    (void)state;
    random_state r = {27};
    double worst = 0, whole = 0, askew = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_unit(&r);
        const qvec3 x = quat_rotate(q, qvec3_make(1, 0, 0)), y = quat_rotate(q, qvec3_make(0, 1, 0));
        const qvec3 z = quat_rotate(q, qvec3_make(0, 0, 1));
        quat found;
        /* y askew in the plane of x and y: near parallel costs digits by 1/angle */
        const double along = random_between(&r, -3, 3);
        assert_int_equal(quat_from_axes(qvec3_scale(x, random_scale(&r, -200, 200)), qvec3_axpy(along, x, y), &found),
                         QUAT_OK);
        worse(&worst, quat_rotation_distance(found, q));
        const double far = random_scale(&r, 0, 14);
        assert_int_equal(quat_from_axes(x, qvec3_axpy(far, x, y), &found), QUAT_OK);
        worse(&askew, quat_rotation_distance(found, q) / far);
        const double same = random_scale(&r, -200, 200); /* parallel, but for the rounding of each component */
        assert_int_equal(quat_from_axes(x, qvec3_scale(x, n % 2 ? same : -same), &found), QUAT_EDOMAIN);
        assert_int_equal(quat_from_frame(x, y, z, &found), QUAT_OK);
        worse(&whole, quat_rotation_distance(found, q));
    }
    assert_bound("from x and a skew y, rad", worst, 5e-15);
    /* far x + y has lost 2 u far of y, and the two unit vectors lose 2 u each */
    assert_bound("from x and far x + y, over far", askew, 10 * ROUNDING);
    assert_bound("from a frame, rad", whole, 3e-15);
    quat q;
    assert_int_equal(quat_from_axes(qvec3_make(1, 0, 0), qvec3_make(-2, 0, 0), &q), QUAT_EDOMAIN);
    assert_int_equal(quat_from_axes(qvec3_make(1, 0, 0), qvec3_make(NAN, 0, 0), &q), QUAT_EDOMAIN);
}

static void swing_and_twist(void **state)
{
    (void)state;
    random_state r = {28};
    double product = 0, swing_along = 0, twist_across = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_unit(&r);
        const qvec3 axis = random_direction(&r);
        quat swing, twist;
        assert_int_equal(quat_swing_twist(q, qvec3_scale(axis, random_scale(&r, -200, 200)), &swing, &twist), QUAT_OK);
        worse(&product, quat_norm(quat_sub(quat_mul(swing, twist), q)));
        worse(&swing_along, fabs(qvec3_dot(quat_vector(swing), axis)));
        worse(&twist_across, qvec3_norm(qvec3_cross(quat_vector(twist), axis)));
        assert_true(twist.w >= 0);
    }
    assert_bound("swing twist = q", product, 1e-15);
    assert_bound("the swing's axis is perpendicular", swing_along, 1e-15);
    assert_bound("the twist's axis is the axis", twist_across, 1e-15);
    quat swing, twist;
    assert_int_equal(quat_swing_twist(quat_make(0, 1, 0, 0), qvec3_make(0, 0, 1), &swing, &twist), QUAT_NOT_UNIQUE);
    assert_true(quat_equal(twist, quat_identity()) && quat_equal(swing, quat_make(0, 1, 0, 0)));
    assert_int_equal(quat_swing_twist(quat_identity(), qvec3_make(0, 0, 0), &swing, &twist), QUAT_EDOMAIN);
    const quat bad[3] = {{0, 0, 0, 0}, {NAN, 0, 0, 1}, {1, INFINITY, 0, 0}};
    for (int n = 0; n < 3; n++) {
        assert_int_equal(quat_swing_twist(bad[n], qvec3_make(0, 0, 1), &swing, &twist), QUAT_EDOMAIN);
        assert_true(quat_equal(swing, quat_identity()) && quat_equal(twist, quat_identity()));
    }
    assert_int_equal(quat_swing_twist(quat_make(1e308, 0, 0, 1e308), qvec3_make(0, 0, 1), &swing, &twist), QUAT_OK);
    assert_true(quat_near(twist, quat_make(sqrt(0.5), 0, 0, sqrt(0.5)), 2e-16));
}

/* Half turns exactly across the axis, in whole numbers, leave the twist open, whatever q's length; and what is beside
 * one by less than a rounding unit is known from q's digits as they are given. */
static void half_turns_across_the_axis(void **state)
{
    (void)state;
    random_state r = {29};
    double beside = 0;
    for (int n = 0; n < 20000; n++) {
        qvec3 axis, other;
        do {
            axis = qvec3_make(floor(random_between(&r, -9, 10)), floor(random_between(&r, -9, 10)),
                              floor(random_between(&r, -9, 10)));
            other = qvec3_make(floor(random_between(&r, -9, 10)), floor(random_between(&r, -9, 10)),
                               floor(random_between(&r, -9, 10)));
        } while (qvec3_norm(qvec3_cross(axis, other)) == 0);
        const double scale = ldexp(1, (int)random_between(&r, -900, 900));
        quat q = quat_pure(qvec3_scale(qvec3_cross(axis, other), scale)), swing, twist, unit;
        assert_int_equal(quat_swing_twist(q, axis, &swing, &twist), QUAT_NOT_UNIQUE);
        quat_normalize(q, &unit);
        assert_true(quat_equal(twist, quat_identity()) && quat_equal(swing, unit));
        /* a tilt by one of the last digits of q.x: (w, along) = (e, axis.x e/|axis|) */
        if (axis.x == 0) continue;
        const double e = 0x1p-44 * scale * (random_uniform(&r) < 0.5 ? 1 : -1), length = qvec3_norm(axis);
        q.w = fabs(e), q.x += e;
        assert_int_equal(quat_swing_twist(q, axis, &swing, &twist), QUAT_OK);
        quat want;
        assert_int_equal(quat_normalize(quat_from_parts(q.w, qvec3_scale(axis, e * axis.x / length / length)), &want),
                         QUAT_OK);
        worse(&beside, quat_norm(quat_sub(twist, want)));
    }
    assert_bound("the twist beside a half turn across", beside, 1e-15);
}

/* ---- angular velocity ---- */

static void angular_velocity(void **state)
{
    (void)state;
    random_state r = {29};
    double derivative = 0, step = 0, frames_agree = 0, undo = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_unit(&r);
        const qvec3 omega = random_vector(&r, random_between(&r, 0, 10));
        const double dt = random_scale(&r, -6, 0);
        /* the derivative against the exact path exp(omega t/2) q, differenced in wide arithmetic */
        const wide h = 1e-12;
        const wquat ahead = wide_mul(wide_exp(wide_scale(wide_vec(omega), h / 2)), wide_quat(q));
        const wquat behind = wide_mul(wide_exp(wide_scale(wide_vec(omega), -h / 2)), wide_quat(q));
        const wquat slope = wide_scale(wide_sub(ahead, behind), 1 / (2 * h));
        worse(&derivative, error_of(quat_derivative_world(q, omega), slope));
        worse(&step, error_of(quat_step_world(q, omega, dt),
                              wide_mul(wide_exp(wide_scale(wide_vec(omega), (wide)dt / 2)), wide_quat(q))));
        /* body and world say the same */
        const qvec3 body = quat_rotate_inverse(q, omega);
        worse(&frames_agree, quat_norm(quat_sub(quat_step_body(q, body, dt), quat_step_world(q, omega, dt))));
        worse(&undo, qvec3_norm(qvec3_sub(quat_omega_world(q, quat_derivative_world(q, omega)), omega)));
        worse(&undo, qvec3_norm(qvec3_sub(quat_omega_body(q, quat_derivative_body(q, body)), body)));
    }
    assert_bound("dq/dt, u", derivative, 3);
    assert_bound("a step, u", step, 20); /* an angle of up to 10 rad, rounded */
    assert_bound("world step = body step", frames_agree, 1e-14);
    assert_bound("omega of dq/dt", undo, 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conventions),
        cmocka_unit_test(rotate_is_within_its_bar),
        cmocka_unit_test(two_reflections_are_a_rotation),
        cmocka_unit_test(axes_angles_and_vectors),
        cmocka_unit_test(matrices_there_and_back),
        cmocka_unit_test(noisy_matrices_give_the_nearest_rotation),
        cmocka_unit_test(two_vectors),
        cmocka_unit_test(frames),
        cmocka_unit_test(swing_and_twist),
        cmocka_unit_test(half_turns_across_the_axis),
        cmocka_unit_test(angular_velocity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
