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
#include "collide_frame.h"
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

static void frame_is_principal(void **state)
{
    (void)state;
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 3000; i++) {
            const impact_collision c = case_make((case_class)class_, 7, i);
            impact_ready ready[2];
            impact_frame f;
            for (int k = 0; k < 2; k++) impact_ready_make(&c.body[k], &ready[k]);
            impact_frame_make(impact_frame_normal(&c), ready, &f);
            const double big = f.scale * (f.a + f.b + 1) * 1e-13;
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
            assert_true(f.conditioning >= 1);
        }
}

/* An exact case: unit mass and inertia, r = (1, 0, 0), n = z. M = 1 + diag(0, 1, 1). */
static void frame_on_paper(void **state)
{
    (void)state;
    const impact_collision c = {
        .body = {{1, {1, 1, 1}, {1, 0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {.mass = INFINITY}},
        .normal = {0, 0, 2}};
    impact_ready ready[2];
    impact_frame f;
    for (int k = 0; k < 2; k++) impact_ready_make(&c.body[k], &ready[k]);
    impact_frame_make(impact_frame_normal(&c), ready, &f);
    assert_true(fabs(f.scale - 2) < 1e-15 && fabs(f.a * f.b - 0.5) < 1e-15 && fabs(f.a + f.b - 1.5) < 1e-15 &&
                f.c == 0 && f.d == 0);
    assert_true(fabs(f.conditioning - 2) < 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(frame_is_principal), cmocka_unit_test(frame_on_paper)};
    return cmocka_run_group_tests_name("impact collide_frame", tests, NULL, NULL);
}
