/* SPDX-License-Identifier: MIT
 *
 * What the thesis prints and nothing else holds: equation 18 in body and in world axes, equations 11 to 13 and the
 * proof of theorem 4, equation 29, appendix A's matrix r x and its M(p1 - p2), section 8.1's condition.
 */
#include "kit/contact_random.h"
#include "kit/near.h"

#include <float.h>
#include <impact/collide.h>

/* ---- equation 18 ---- */

/* A frame that turns: q(t) = exp(a t) exp(b t) p, and its derivative by the product rule. */
static quat turning(qvec3 a, qvec3 b, quat p, double t, quat *rate)
{
    const quat first = quat_from_rotation_vector(qvec3_scale(a, 2 * t));
    const quat second = quat_mul(quat_from_rotation_vector(qvec3_scale(b, 2 * t)), p);
    *rate = quat_add(quat_mul(quat_mul(quat_pure(a), first), second), quat_mul(first, quat_mul(quat_pure(b), second)));
    return quat_mul(first, second);
}

/* The matrix of equation 18 as printed, without v(t)/2, times q. */
static quat printed_18(qvec3 k, quat q)
{
    return quat_make(-k.x * q.x - k.y * q.y - k.z * q.z, k.x * q.w + k.z * q.y - k.y * q.z,
                     k.y * q.w - k.z * q.x + k.x * q.z, k.z * q.w + k.y * q.x - k.x * q.y);
}

/* The text's k = 2 (q0 dq - q dq0 - q x dq). */
static qvec3 printed_k(quat q, quat dq)
{
    const qvec3 v = quat_vector(q), dv = quat_vector(dq);
    return qvec3_scale(qvec3_sub(qvec3_sub(qvec3_scale(dv, q.w), qvec3_scale(v, dq.w)), qvec3_cross(v, dv)), 2);
}

static void equation_18_is_right_in_body_axes(void **state)
{
    (void)state;
    random_stream r = {18};
    for (int round = 0; round < 5000; round++) {
        const qvec3 a = random_vector(&r, 0.1, 3), b = random_vector(&r, 0.1, 3), x = random_direction(&r);
        quat dq;
        const quat q = turning(a, b, random_rotation(&r), 4 * random_unit(&r), &dq);
        const qvec3 k = printed_k(q, dq), world = quat_rotate(q, k);
        const double bound = 40 * DBL_EPSILON * (qvec3_norm(a) + qvec3_norm(b));
        assert_at_most(quat_distance(quat_scale(printed_18(k, q), 0.5), dq), bound);
        assert_at_most(quat_distance(quat_derivative_body(q, k), dq), bound);      /* 1/2 q (0, k) */
        assert_at_most(quat_distance(quat_derivative_world(q, world), dq), bound); /* 1/2 (0, R k) q */
        /* equation 19: d(q x q*) = q (k x x) q* */
        const quat moved = quat_add(quat_mul(quat_mul(dq, quat_pure(x)), quat_conj(q)),
                                    quat_mul(quat_mul(q, quat_pure(x)), quat_conj(dq)));
        assert_near3(quat_vector(moved), quat_rotate(q, qvec3_cross(k, x)), 2 * bound);
    }
}

/* ---- theorem 4 ---- */

/* |v'|^2 = |v|^2 - 4 (n.v)^2 + 4 (n.v)^2, not -4 cos a + 4 cos a; the turn is about n x v, not about n x n = 0. */
static void theorem_4_with_its_axis(void **state)
{
    (void)state;
    random_stream r = {4};
    for (int round = 0; round < 5000; round++) {
        const qvec3 n = random_direction(&r), v = random_vector(&r, 0.1, 10), image = quat_reflect(n, v);
        const double size = qvec3_norm(v), along = qvec3_dot(n, v), angle = asin(fmin(fabs(along) / size, 1));
        assert_near(qvec3_norm(image), size, 8 * DBL_EPSILON * size);
        quat turn;
        if (quat_from_axis_angle(qvec3_scale(qvec3_cross(n, v), along < 0 ? -1 : 1), 2 * angle, &turn) != QUAT_OK)
            continue;
        assert_near3(quat_rotate(turn, v), image, 1e-7 * size); /* asin near 1 */
    }
}

/* ---- equation 29 and appendix A ---- */

static impact_collider random_collider(random_stream *r)
{
    impact_collider c = {.mass = random_log(r, 0.1, 10), .orientation = random_rotation(r)};
    const double a = random_log(r, 0.1, 1), b = random_log(r, 0.1, 1), d = random_log(r, 0.1, 1);
    c.moments = qvec3_scale(qvec3_make(b * b + d * d, a * a + d * d, a * a + b * b), c.mass / 5);
    c.offset = random_vector(r, 0.1, 1);
    c.velocity = random_vector(r, 0.1, 3);
    c.omega = random_vector(r, 0.1, 3);
    return c;
}

static qvec3 contact_velocity(const impact_collider *c, qvec3 velocity, qvec3 omega)
{
    return qvec3_add(velocity, qvec3_cross(omega, c->offset));
}

/* (1/m I - [r]x J^-1 [r]x) p, [r]x with -r_x at (2,3); with `printed` +r_x as appendix A has it. */
static qvec3 inverse_mass(const impact_collider *c, qvec3 p, bool printed)
{
    const qvec3 r = c->offset;
    const qmat3 cross = {{{0, -r.z, r.y}, {r.z, 0, printed ? r.x : -r.x}, {-r.y, r.x, 0}}};
    qvec3 turned = quat_rotate_inverse(c->orientation, qmat3_apply(&cross, p));
    turned = qvec3_make(turned.x / c->moments.x, turned.y / c->moments.y, turned.z / c->moments.z);
    const qvec3 back = qmat3_apply(&cross, quat_rotate(c->orientation, turned));
    return qvec3_sub(qvec3_scale(p, 1 / c->mass), back);
}

static void appendix_a_with_its_signs(void **state)
{
    (void)state;
    random_stream r = {36};
    int off = 0, impacts = 0, stuck = 0;
    for (int round = 0; round < 3000; round++) {
        const impact_collision hit = {.body = {random_collider(&r), random_collider(&r)},
                                      .normal = random_direction(&r),
                                      .friction = 1,
                                      .restitution = 0.5};
        impact_outcome o;
        if (impact_collide(&hit, &o) != IMPACT_OK) continue;
        impacts++;
        qvec3 change = {0, 0, 0}, sum = change, wrong = change;
        for (int i = 0; i < 2; i++) {
            const impact_collider *c = &hit.body[i];
            const qvec3 before = contact_velocity(c, c->velocity, c->omega),
                        after = contact_velocity(c, o.velocity[i], o.omega[i]);
            change = qvec3_axpy(i ? -1 : 1, qvec3_sub(after, before), change);
            sum = qvec3_add(sum, inverse_mass(c, o.impulse, false));
            wrong = qvec3_add(wrong, inverse_mass(c, o.impulse, true));
        }
        /* p2 = -p1, so the difference of both is (M1 + M2) p1, and M (p1 - p2) twice that */
        assert_near3(change, sum, 1e-12 * qvec3_norm(sum));
        off += qvec3_norm(qvec3_sub(change, wrong)) > 1e-3 * qvec3_norm(sum);
        /* equation 29: |f| <= mu f_n; with -mu |f_n| nothing but f = 0 could stick */
        assert_at_most(o.impulse_tangential, o.impulse_normal * (1 + 4 * DBL_EPSILON));
        stuck += o.phases[o.phase_count - 1] == IMPACT_STICK_R && o.impulse_tangential > 0;
    }
    assert_true(impacts > 1000);
    assert_true(stuck > 100);
    assert_true(off > 9 * impacts / 10);
}

/* ---- 8.1 ---- */

/* The least over many directions of B - A's support; the origin is inside only where none is negative. */
static double least_support(const impact_solid *a, const impact_solid *b, qvec3 hint)
{
    random_stream r = {81};
    double least = INFINITY;
    for (int k = 0; k < 400; k++) {
        const qvec3 n = k == 0 ? hint : random_direction(&r);
        const double h = impact_shape_support(&b->shape, quat_rotate_inverse(b->orientation, n), NULL) +
                         impact_shape_support(&a->shape, quat_rotate_inverse(a->orientation, qvec3_neg(n)), NULL) +
                         qvec3_dot(n, qvec3_sub(b->position, a->position));
        least = fmin(least, h);
    }
    return least;
}

/* B - A of bodies that do not touch is not empty either: the condition is that it holds the origin. */
static void collide_where_the_difference_holds_the_origin(void **state)
{
    (void)state;
    random_stream r = {13};
    int apart = 0, overlapping = 0;
    for (int round = 0; round < 400; round++) {
        impact_solid a = {.shape = random_shape(&r, RANDOM_ROUND), .orientation = random_rotation(&r)}, b = a;
        b.orientation = random_rotation(&r);
        b.position = random_vector(&r, 0.2, 4);
        impact_contact contact;
        if (impact_gap(&a, &b, NULL, &contact) < 0 || fabs(contact.gap) < 1e-6) continue;
        /* the normal points from b to a, along which b - a reaches least */
        const double least = least_support(&a, &b, contact.normal);
        if (contact.gap > 0)
            assert_near(least, -contact.gap, 1e-9);
        else
            assert_true(least > 0);
        *(contact.gap > 0 ? &apart : &overlapping) += 1;
    }
    assert_true(apart > 100 && overlapping > 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equation_18_is_right_in_body_axes), cmocka_unit_test(theorem_4_with_its_axis),
        cmocka_unit_test(appendix_a_with_its_signs), cmocka_unit_test(collide_where_the_difference_holds_the_origin)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
