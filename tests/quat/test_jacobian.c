/* SPDX-License-Identifier: MIT
 *
 * The oracle: central differences of the textbook formulas in quadruple precision, good to 1e-20; for many more inputs
 * closed forms in quadruple precision, and identities.
 */
#include "oracle.h"
#include <quat/exponential.h>
#include <quat/jacobian.h>
#include <quat/rotation.h>

typedef wquat (*map)(wquat argument, const wquat *context);

static const wide h = 1e-11;

/* d f/d component j, by a fourth-order central difference. */
static wquat difference(map f, wquat at, int j, const wquat *context)
{
    const wquat step = {j == 0 ? h : 0, j == 1 ? h : 0, j == 2 ? h : 0, j == 3 ? h : 0};
    const wquat near = wide_sub(f(wide_add(at, step), context), f(wide_sub(at, step), context));
    const wquat far =
        wide_sub(f(wide_add(at, wide_scale(step, 2)), context), f(wide_sub(at, wide_scale(step, 2)), context));
    return wide_scale(wide_sub(wide_scale(near, 8), far), 1 / (12 * h));
}

static wquat sandwich(wquat q, const wquat *v) { return wide_mul(wide_mul(q, *v), wide_conj(q)); }
static wquat multiply_left(wquat q, const wquat *p) { return wide_mul(*p, q); }
static wquat multiply_right(wquat p, const wquat *q) { return wide_mul(p, *q); }
static wquat exponential(wquat v, const wquat *unused)
{
    (void)unused;
    return wide_exp(v);
}
static wquat logarithm(wquat q, const wquat *unused)
{
    (void)unused;
    wquat l = wide_log(q);
    l.w = 0;
    return l;
}

static wide component_of(wquat q, int i) { return i == 0 ? q.w : i == 1 ? q.x : i == 2 ? q.y : q.z; }
static double component(wquat q, int i) { return (double)component_of(q, i); }

static double spread(random_state *r, int n) { return n % 2 ? random_between(r, 0.01, 3) : random_scale(r, -8, 0.4); }

static void jacobians_match_differences(void **state)
{
    (void)state;
    random_state r = {41};
    double rotate = 0, product = 0, exp_worst = 0, log_worst = 0;
    for (int n = 0; n < 4000; n++) {
        const quat q = random_unit(&r), p = random_any(&r);
        const qvec3 v = random_vector(&r, spread(&r, n)), u = random_direction(&r);
        const wquat wv = wide_vec(u), wq = wide_quat(q), wp = wide_quat(p);
        const qmat34 dr = quat_rotate_jacobian(q, u);
        const qmat4 left = quat_left_matrix(p), right = quat_right_matrix(p);
        const qmat43 de = quat_exp_jacobian(v);
        const quat e = quat_from_rotation_vector(qvec3_scale(v, 1.9));
        const qmat34 dl = quat_log_jacobian(e);
        const double far = quat_norm(quat_sub(e, quat_make(-1, 0, 0, 0)));
        for (int j = 0; j < 4; j++) {
            const wquat a = difference(sandwich, wq, j, &wv), b = difference(multiply_left, wq, j, &wp);
            const wquat c = difference(multiply_right, wq, j, &wp), l = difference(logarithm, wide_quat(e), j, NULL);
            const wquat d = j ? difference(exponential, wide_vec(v), j, NULL) : wp;
            for (int i = 0; i < 4; i++) {
                worse(&product, fabs(left.m[i][j] - component(b, i)));
                worse(&product, fabs(right.m[i][j] - component(c, i)));
                if (i) worse(&rotate, fabs(dr.m[i - 1][j] - component(a, i)));
                if (j) worse(&exp_worst, fabs(de.m[i][j - 1] - component(d, i)));
                if (i) worse(&log_worst, fabs(dl.m[i - 1][j] - component(l, i)) * far * far);
            }
        }
    }
    assert_bound("Jacobian of the product", product, 1e-15);
    assert_bound("Jacobian of rotate", rotate, 4e-15);
    assert_bound("Jacobian of exp", exp_worst, 1e-14);
    assert_bound("Jacobian of log, times the distance from -1", log_worst, 1e-13);
}

/* omega of r(t) = r + t d, from dq/dt by differences. */
static wquat turned(wquat t, const wquat *context)
{
    return wide_exp(wide_scale(wide_add(context[0], wide_scale(context[1], t.w)), (wide)0.5));
}

static void rotation_vector_jacobians_give_the_angular_velocity(void **state)
{
    (void)state;
    random_state r = {42};
    double world = 0, body = 0, inverse = 0;
    for (int n = 0; n < 20000; n++) {
        const qvec3 v = random_vector(&r, n % 3 ? random_between(&r, 0, 6) : random_scale(&r, -9, 0.5)),
                    d = random_direction(&r);
        const wquat context[2] = {wide_vec(v), wide_vec(d)}, zero = {0, 0, 0, 0};
        const wquat q = turned(zero, context), dq = difference(turned, zero, 0, context);
        const wquat ww = wide_scale(wide_mul(dq, wide_conj(q)), 2), wb = wide_scale(wide_mul(wide_conj(q), dq), 2);
        const qmat3 left = quat_rotation_vector_jacobian_left(v), right = quat_rotation_vector_jacobian_right(v);
        const qmat3 left_inverse = quat_rotation_vector_jacobian_left_inverse(v);
        const qmat3 right_inverse = quat_rotation_vector_jacobian_right_inverse(v);
        const qvec3 omega_world = qmat3_apply(&left, d), omega_body = qmat3_apply(&right, d);
        worse(&world,
              error_of_vector(omega_world, wide_sub(ww, (wquat){ww.w, 0, 0, 0})) * ROUNDING * qvec3_norm(omega_world));
        worse(&body,
              error_of_vector(omega_body, wide_sub(wb, (wquat){wb.w, 0, 0, 0})) * ROUNDING * qvec3_norm(omega_body));
        worse(&inverse, qvec3_norm(qvec3_sub(qmat3_apply(&left_inverse, omega_world), d)));
        worse(&inverse, qvec3_norm(qvec3_sub(qmat3_apply(&right_inverse, omega_body), d)));
    }
    assert_bound("world angular velocity from dr/dt", world, 5e-15);
    assert_bound("body angular velocity from dr/dt", body, 5e-15);
    assert_bound("its inverse, |r| to 6", inverse, 1e-13);
}

/* ---- many more, against closed forms in quadruple precision, which the differences above vouch for ---- */

/* The components of the unit quaternion 1, i, j or k. */
static wquat unit_of(int j) { return (wquat){j == 0, j == 1, j == 2, j == 3}; }

static wquat vector_part(wquat q)
{
    q.w = 0;
    return q;
}

/* d (q v q*) = e v q* + q v e*, e the unit of the component. */
static wquat closed_rotate(wquat q, wquat v, int j)
{
    return wide_add(wide_mul(wide_mul(unit_of(j), v), wide_conj(q)), wide_mul(wide_mul(q, v), wide_conj(unit_of(j))));
}

/* d exp(0, v): the sine over the length and its slope over the length, by their series where they cancel. */
static wquat closed_exp(wquat v, int j)
{
    const wide n = wide_vnorm(v), n2 = n * n, along = component_of(v, j);
    const wide sinc = n < 1e-9 ? 1 - n2 / 6 : sinf128(n) / n;
    const wide slope = n < 1e-9 ? n2 / 30 - (wide)1 / 3 : (cosf128(n) - sinc) / n2;
    const wquat d = wide_add(wide_scale(unit_of(j), sinc), wide_scale(v, slope * along));
    return (wquat){-sinc * along, d.x, d.y, d.z};
}

/* d (u atan2(|u|, w)/|u|) */
static wquat closed_log(wquat q, int j)
{
    const wide n = wide_vnorm(q), n2 = n * n, size = wide_dot(q, q);
    const int close = n < 1e-9 && q.w > 0;
    const wide f = close ? 1 / q.w - n2 / (3 * q.w * q.w * q.w) : atan2f128(n, q.w) / n;
    const wide slope = close ? -2 / (3 * q.w * q.w * q.w) : (q.w / size - f) / n2;
    const wquat u = vector_part(q);
    if (j == 0) return wide_scale(u, -1 / size);
    return wide_add(wide_scale(unit_of(j), f), wide_scale(u, slope * component_of(q, j)));
}

static void jacobians_match_closed_forms(void **state)
{
    (void)state;
    random_state r = {43};
    double rotate = 0, product = 0, exp_worst = 0, log_worst = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_unit(&r), p = random_any(&r), s = random_any(&r);
        const qvec3 v = random_vector(&r, n % 2 ? random_between(&r, 0, 3.14) : random_scale(&r, -300, 0.49)),
                    u = random_vector(&r, random_scale(&r, -290, 290));
        const double size = qvec3_norm(u);
        const qmat34 dr = quat_rotate_jacobian(q, u);
        const qmat4 left = quat_left_matrix(p), right = quat_right_matrix(p);
        const qmat43 de = quat_exp_jacobian(v);
        const quat e = quat_exp_pure(v), ps = quat_mul(p, s), sp = quat_mul(s, p);
        const qmat34 dl = quat_log_jacobian(e);
        const double far = quat_norm(quat_sub(e, quat_make(-1, 0, 0, 0)));
        for (int i = 0; i < 4; i++) {
            const double *const l = left.m[i], *const m = right.m[i];
            worse(&product, fabs(l[0] * s.w + l[1] * s.x + l[2] * s.y + l[3] * s.z - component(wide_quat(ps), i)));
            worse(&product, fabs(m[0] * s.w + m[1] * s.x + m[2] * s.y + m[3] * s.z - component(wide_quat(sp), i)));
        }
        for (int j = 0; j < 4; j++) {
            const wquat a = closed_rotate(wide_quat(q), wide_vec(u), j), l = closed_log(wide_quat(e), j);
            const wquat d = closed_exp(wide_vec(v), j);
            for (int i = 0; i < 4; i++) {
                if (i) worse(&rotate, fabs(dr.m[i - 1][j] - component(a, i)) / size);
                if (j) worse(&exp_worst, fabs(de.m[i][j - 1] - component(d, i)));
                if (i) worse(&log_worst, fabs(dl.m[i - 1][j] - component(l, i)) * far * far);
            }
        }
    }
    assert_bound("1e5 of the product", product, 2e-15);
    assert_bound("1e5 of rotate, over |v|", rotate, 4e-15);
    assert_bound("1e5 of exp", exp_worst, 1e-14);
    assert_bound("1e5 of log, times the distance from -1", log_worst, 1e-13);
}

/* J r = r, [r]x J = R - 1 (these two determine J), J_right = J^T, J_left = R J_right. */
static void rotation_vector_jacobians_keep_their_identities(void **state)
{
    (void)state;
    random_state r = {44};
    double along = 0, across = 0, turned = 0, inverse = 0;
    for (int n = 0; n < 100000; n++) {
        const qvec3 v = random_vector(&r, n % 3 ? random_between(&r, 0, 6) : random_scale(&r, -300, 0.7));
        const qvec3 d = random_direction(&r);
        const quat q = quat_from_rotation_vector(v);
        const qmat3 left = quat_rotation_vector_jacobian_left(v), right = quat_rotation_vector_jacobian_right(v);
        const qmat3 back = quat_rotation_vector_jacobian_left_inverse(v);
        const qmat3 right_back = quat_rotation_vector_jacobian_right_inverse(v), t = qmat3_transpose(&right);
        const qvec3 jd = qmat3_apply(&left, d), jv = qmat3_apply(&left, v);
        if (qvec3_norm(v) > 1e-290) worse(&along, qvec3_norm(qvec3_sub(jv, v)) / qvec3_norm(v));
        worse(&across, qvec3_norm(qvec3_sub(qvec3_cross(v, jd), qvec3_sub(quat_rotate(q, d), d))));
        worse(&turned, qvec3_norm(qvec3_sub(jd, quat_rotate(q, qmat3_apply(&right, d)))));
        worse(&turned, qvec3_norm(qvec3_sub(jd, qmat3_apply(&t, d))));
        worse(&inverse, qvec3_norm(qvec3_sub(qmat3_apply(&back, jd), d)));
        const qvec3 rd = qmat3_apply(&right, d);
        worse(&inverse, qvec3_norm(qvec3_sub(qmat3_apply(&right_back, rd), d)));
    }
    const qmat3 tiny = quat_rotation_vector_jacobian_left(qvec3_make(0, 5e-324, 0)); /* the smallest double */
    assert_true(tiny.m[0][0] == 1 && tiny.m[0][2] == 0 && tiny.m[2][2] == 1);
    assert_bound("J r = r", along, 2e-15);
    assert_bound("r x J d = R d - d", across, 1e-14);
    assert_bound("J_left = R J_right = J_right^T", turned, 1e-14);
    assert_bound("their inverses, |r| to 6", inverse, 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jacobians_match_differences),
        cmocka_unit_test(rotation_vector_jacobians_give_the_angular_velocity),
        cmocka_unit_test(jacobians_match_closed_forms),
        cmocka_unit_test(rotation_vector_jacobians_keep_their_identities),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
