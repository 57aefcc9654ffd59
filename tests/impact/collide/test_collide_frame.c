/* SPDX-License-Identifier: MIT
 *
 * The contact frame: M against its definition by cross products and the inertia tensor, over random bodies.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <quat/rotation.h>
#include "collide/collide_frame.h"
#include "generators/collide_cases.h"

/* e.M f = e.f (w1 + w2) + sum (r x e).J^-1 (r x f), with J^-1 = R diag R' in full. */
static double by_definition(const impact_collision *c, qvec3 e, qvec3 f)
{
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &c->body[i];
        if (isinf(body->mass)) continue;
        const quat q = body->orientation;
        const qvec3 x = quat_rotate(q, (qvec3){1, 0, 0}), y = quat_rotate(q, (qvec3){0, 1, 0});
        const qvec3 z = quat_rotate(q, (qvec3){0, 0, 1});
        const qvec3 re = qvec3_cross(body->offset, e), rf = qvec3_cross(body->offset, f);
        sum += qvec3_dot(e, f) / body->mass + qvec3_dot(re, x) * qvec3_dot(rf, x) / body->moments.x +
               qvec3_dot(re, y) * qvec3_dot(rf, y) / body->moments.y +
               qvec3_dot(re, z) * qvec3_dot(rf, z) / body->moments.z;
    }
    return sum;
}

/* |M| |M^-1| / 3, the inverse by its adjugate. */
static double conditioning(const imp_frame *f)
{
    const long double a = f->a, b = f->b, c = f->c, d = f->d, e = f->e;
    const long double xx = b - d * d, yy = a - c * c, zz = a * b - e * e, xy = c * d - e, xz = e * d - b * c,
                      yz = e * c - a * d;
    const long double det = xx * a + xy * e + xz * c;
    const long double squares = a * a + b * b + 1 + 2 * (c * c + d * d + e * e);
    const long double adjugate = xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz);
    return (double)(sqrtl(squares * adjugate) / (3 * det));
}

/* Any tangent will do: M there, what elimination leaves of it, and the impulse that sticks. */
static void any_tangent(void **state)
{
    (void)state;
    uint64_t g = 11;
    for (uint64_t i = 0; i < 10000; i++) {
        const impact_collision c = case_make(i % 2 ? CASE_PLAIN : CASE_ROD, 7, i);
        imp_ready ready;
        imp_frame f;
        imp_ready_make(&c, &ready);
        const qvec3 n = imp_frame_normal(&c), t = imp_frame_across(n), s = qvec3_cross(n, t);
        const double angle = 7 * case_random(&g);
        const qvec3 t1 = qvec3_axpy(cos(angle), t, qvec3_scale(s, sin(angle))), t2 = qvec3_cross(n, t1);
        imp_frame_make(n, t1, &ready, &f);
        const double big = f.scale * (f.a + f.b + 1) * 2e-14;
        assert_true(qvec3_norm(qvec3_sub(f.t1, t1)) == 0 && qvec3_norm(qvec3_sub(f.t2, t2)) == 0);
        assert_true(fabs(by_definition(&c, t1, t1) - f.a * f.scale) < big);
        assert_true(fabs(by_definition(&c, t2, t2) - f.b * f.scale) < big);
        assert_true(fabs(by_definition(&c, t1, t2) - f.e * f.scale) < big);
        assert_true(fabs(by_definition(&c, t1, n) - f.c * f.scale) < big);
        assert_true(fabs(by_definition(&c, t2, n) - f.d * f.scale) < big);
        const double known = conditioning(&f), small = 1e-14 * known;
        assert_true(fabs(f.schur - (f.b - f.e * f.e / f.a)) < small * f.b);
        assert_true(fabs(f.a * f.alpha + f.e * f.beta + f.c) < small * f.a);
        assert_true(fabs(f.e * f.alpha + f.b * f.beta + f.d) < small * f.b);
        assert_true(fabs(f.k - (1 + f.c * f.alpha + f.d * f.beta)) < small);
        assert_true(fabs(f.conditioning - known) < small * known);
        const imp_frame before = f;
        imp_frame_turn(&ready, &f);
        assert_true(f.e == 0 && fabs(f.schur - f.b) < small * f.b && f.k == before.k);
        assert_true(fabs(f.a + f.b - before.a - before.b) < 1e-14 * (f.a + f.b));
        assert_true(fabs(hypot(f.alpha, f.beta) - hypot(before.alpha, before.beta)) < small);
    }
}

static void frame_is_principal(void **state)
{
    (void)state;
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 3000; i++) {
            const impact_collision c = case_make((case_class)class_, 7, i);
            imp_ready ready;
            imp_frame f;
            imp_ready_make(&c, &ready);
            imp_frame_principal(imp_frame_normal(&c), &ready, &f);
            const double big = f.scale * (f.a + f.b + 1) * 2e-14;
            assert_true(fabs(qvec3_dot(f.t1, f.t2)) < 1e-15 && fabs(qvec3_dot(f.t1, f.n)) < 1e-15 &&
                        fabs(qvec3_dot(f.t2, f.n)) < 1e-15);
            assert_true(qvec3_dot(qvec3_cross(f.t1, f.t2), f.n) > 0.999999);
            assert_true(fabs(by_definition(&c, f.t1, f.t1) - f.a * f.scale) < big);
            assert_true(fabs(by_definition(&c, f.t2, f.t2) - f.b * f.scale) < big);
            assert_true(fabs(by_definition(&c, f.n, f.n) - f.scale) < big);
            assert_true(fabs(by_definition(&c, f.t1, f.n) - f.c * f.scale) < big);
            assert_true(fabs(by_definition(&c, f.t2, f.n) - f.d * f.scale) < big);
            assert_true(fabs(by_definition(&c, f.t1, f.t2)) < big);
            /* Positive definite, and k its Schur complement. */
            assert_true(f.k > 0 && f.k <= 1 + 1e-15);
            assert_true(fabs(f.k - (1 - f.c * f.c / f.a - f.d * f.d / f.b)) < 1e-14);
            const double known = conditioning(&f);
            if (known < 1e6) assert_true(fabs(f.conditioning - known) < 1e-14 * known * known);
        }
}

/* An exact case: unit mass and inertia, r = (1, 0, 0), n = z. M = 1 + diag(0, 1, 1). */
static void frame_on_paper(void **state)
{
    (void)state;
    const impact_collision c = {
        .body = {{1, {1, 1, 1}, {1, 0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {.mass = INFINITY}},
        .normal = {0, 0, 2}};
    imp_ready ready;
    imp_frame f;
    imp_ready_make(&c, &ready);
    imp_frame_principal(imp_frame_normal(&c), &ready, &f);
    assert_true(fabs(f.scale - 2) < 1e-15 && fabs(f.a * f.b - 0.5) < 1e-15 && fabs(f.a + f.b - 1.5) < 1e-15 &&
                f.c == 0 && f.d == 0);
    assert_true(fabs(f.conditioning - sqrt(1.5)) < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(any_tangent), cmocka_unit_test(frame_is_principal),
                                       cmocka_unit_test(frame_on_paper)};
    return cmocka_run_group_tests_name("impact collide_frame", tests, NULL, NULL);
}
