/* SPDX-License-Identifier: MIT
 *
 * The oracle is a coning motion, q(t) = exp(a t z/2) exp(b t n/2): turning at b about an axis that itself turns at a.
 * Its angular velocity is a z + R_z(a t) b n in world axes and b n + R(q)^T a z in body axes.
 */
#include "oracle.h"
#include <quat/exponential.h>
#include <quat/integrate.h>
#include <quat/rotation.h>

typedef struct cone {
    double a, b;
    qvec3 n;
    quat_frame frame;
} cone;

static quat exact(const cone *c, double t)
{
    const quat outer = quat_exp_pure(qvec3_make(0, 0, 0.5 * c->a * t));
    return quat_mul(outer, quat_exp_pure(qvec3_scale(c->n, 0.5 * c->b * t)));
}

static qvec3 omega(double t, void *context)
{
    const cone *const c = context;
    const qvec3 z = {0, 0, c->a}, n = qvec3_scale(c->n, c->b);
    if (c->frame == QUAT_BODY) return qvec3_add(n, quat_rotate_inverse(exact(c, t), z));
    return qvec3_add(z, quat_rotate(quat_exp_pure(qvec3_make(0, 0, 0.5 * c->a * t)), n));
}

static void their_order_to_rounding(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        cone c = {1.3, 2.1, {0.6, 0, 0.8}, k % 2 ? QUAT_BODY : QUAT_WORLD};
        const quat_method method = k / 2 == 2 ? QUAT_MAGNUS8 : k / 2 ? QUAT_CF4 : QUAT_MAGNUS4;
        const int doublings = method == QUAT_MAGNUS8 ? 4 : 6; /* 64 steps of order 8 are at rounding */
        double error[6];
        quat q;
        for (int i = 0; i < doublings; i++) {
            const size_t steps = (size_t)8 << i;
            assert_int_equal(quat_integrate(omega, &c, c.frame, method, 0.5, 4, steps, exact(&c, 0.5), &q), QUAT_OK);
            error[i] = quat_distance(q, exact(&c, 4));
        }
        const int order = method == QUAT_MAGNUS8 ? 8 : 4;
        for (int i = 1; i < doublings; i++) assert_true(fabs(log2(error[i - 1] / error[i]) - order) < 0.25 * order / 4);
        assert_int_equal(quat_integrate(omega, &c, c.frame, method, 0.5, 4, 20000, exact(&c, 0.5), &q), QUAT_OK);
        assert_bound("error after 20000 steps, rad", quat_distance(q, exact(&c, 4)), 1e-13);
        assert_bound("|q| after 20000 steps, u", fabs(quat_norm(q) - 1) / ROUNDING, 4);
        /* and back */
        assert_int_equal(quat_integrate(omega, &c, c.frame, method, 4, 0.5, 20000, exact(&c, 4), &q), QUAT_OK);
        assert_bound("error on the way back, rad", quat_distance(q, exact(&c, 0.5)), 1e-13);
    }
}

static void steady_turning_is_exact(void **state)
{
    (void)state;
    random_state r = {81};
    double worst = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_unit(&r);
        const qvec3 w = random_vector(&r, random_between(&r, 0, 5));
        const double h = random_between(&r, -1, 1);
        const quat_frame frame = n % 2 ? QUAT_WORLD : QUAT_BODY;
        const quat want = n % 2 ? quat_step_world(q, w, h) : quat_step_body(q, w, h);
        worse(&worst, quat_distance(quat_step_magnus4(q, w, w, h, frame), want));
        worse(&worst, quat_distance(quat_step_cf4(q, w, w, h, frame), want));
        worse(&worst, quat_distance(quat_step_magnus8(q, (const qvec3[4]){w, w, w, w}, h, frame), want));
    }
    assert_bound("steady turning, rad", worst, 3e-15);
}

/* Steps back undo steps: Gauss' points stand alike about the middle, and so do commutators of an even number. */
static void steps_back_undo_steps(void **state)
{
    (void)state;
    random_state r = {83};
    double worst = 0;
    for (int n = 0; n < 30000; n++) {
        const quat q = random_unit(&r);
        qvec3 there[4], back[4];
        for (int k = 0; k < 4; k++) there[k] = back[3 - k] = random_vector(&r, random_between(&r, 0, 3));
        const double h = random_between(&r, -1, 1);
        const quat_frame frame = n % 2 ? QUAT_WORLD : QUAT_BODY;
        for (int k = 0; k < 3; k++) {
            static const quat_method methods[] = {QUAT_MAGNUS4, QUAT_CF4, QUAT_MAGNUS8};
            double part[4];
            const int parts = quat_method_parts(methods[k], part);
            const quat step = quat_step_by(methods[k], q, there, h, frame);
            worse(&worst, quat_distance(quat_step_by(methods[k], step, back + 4 - parts, -h, frame), q));
        }
    }
    assert_bound("there and back, rad", worst, 1e-13);
}

static qvec3 broken(double t, void *context)
{
    (void)context;
    return qvec3_make(1, t < 0.5 ? 0 : NAN, 0);
}

static qvec3 fast(double t, void *context)
{
    (void)context;
    return qvec3_make(t < 50 ? 1 : 1e308, 0, 0);
}

static void bad_input_is_named(void **state)
{
    (void)state;
    cone c = {1, 1, {1, 0, 0}, QUAT_WORLD};
    const quat one = quat_identity(), zero = {0, 0, 0, 0};
    quat q;
    assert_int_equal(quat_integrate(omega, &c, QUAT_WORLD, QUAT_CF4, 0, 1, 0, one, &q), QUAT_EARGUMENT);
    assert_int_equal(quat_integrate(omega, &c, (quat_frame)7, QUAT_CF4, 0, 1, 1, one, &q), QUAT_EARGUMENT);
    assert_int_equal(quat_integrate(omega, &c, QUAT_WORLD, (quat_method)7, 0, 1, 1, one, &q), QUAT_EARGUMENT);
    assert_int_equal(quat_integrate(omega, &c, QUAT_WORLD, QUAT_CF4, 0, INFINITY, 1, one, &q), QUAT_EDOMAIN);
    assert_int_equal(quat_integrate(omega, &c, QUAT_WORLD, QUAT_CF4, 0, 1, 1, zero, &q), QUAT_EDOMAIN);
    assert_true(quat_equal(q, one));
    assert_int_equal(quat_integrate(broken, NULL, QUAT_WORLD, QUAT_MAGNUS4, 0, 1, 10, one, &q), QUAT_EDOMAIN);
    assert_true(quat_near(q, quat_exp_pure(qvec3_make(0.25, 0, 0)), 1e-15)); /* as far as it came */
    assert_int_equal(quat_integrate(fast, NULL, QUAT_BODY, QUAT_CF4, 0, 100, 10, one, &q), QUAT_ERANGE);
    assert_true(quat_near(q, quat_exp_pure(qvec3_make(25, 0, 0)), 1e-14));
    assert_int_equal(quat_integrate(omega, &c, QUAT_WORLD, QUAT_MAGNUS4, -1.7e308, 1.7e308, 2, one, &q), QUAT_EDOMAIN);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(their_order_to_rounding),
                                       cmocka_unit_test(steady_turning_is_exact),
                                       cmocka_unit_test(steps_back_undo_steps), cmocka_unit_test(bad_input_is_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
