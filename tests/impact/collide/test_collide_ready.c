/* SPDX-License-Identifier: MIT
 *
 * A body made ready: its axes, and the small components of a slim body's offset.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <quat/rotation.h>
#include "collide/collide_ready.h"
#include "generators/collide_cases.h"

/* |q|^2 times the rotation of a quaternion of small whole numbers: whole numbers too. */
static qvec3 turned(quat q, qvec3 v)
{
    const double w = q.w, x = q.x, y = q.y, z = q.z;
    return (qvec3){(w * w + x * x - y * y - z * z) * v.x + 2 * (x * y - w * z) * v.y + 2 * (x * z + w * y) * v.z,
                   2 * (x * y + w * z) * v.x + (w * w - x * x + y * y - z * z) * v.y + 2 * (y * z - w * x) * v.z,
                   2 * (x * z - w * y) * v.x + 2 * (y * z + w * x) * v.y + (w * w - x * x - y * y + z * z) * v.z};
}

/* A rod along its z, struck 2^-30 off its axis: the offset in the world is exact, and so must the small
 * components be. */
static void slim_offset_is_exact(void **state)
{
    (void)state;
    static const quat turns[] = {{1, 2, 2, 4}, {3, -1, 5, 2}, {-7, 4, 0, 6}, {0, 0, 3, 1}, {1, 0, 0, 0}, {2, 9, -5, 7}};
    const qvec3 local = {0x1p-30, -0x1.8p-31, 1};
    for (int i = 0; i < 6; i++) {
        const double n2 = quat_dot(turns[i], turns[i]);
        const impact_collision c = {
            .body = {
                {.mass = INFINITY},
                {.mass = 1, .moments = {1, 1, 1e-4}, .orientation = turns[i], .offset = turned(turns[i], local)},
            }};
        imp_ready ready;
        imp_ready_make(&c, &ready);
        assert_false(ready.round);
        const qvec3 offset = imp_vectors_at(&ready.offset, 1);
        assert_true(fabs(offset.x / (n2 * local.x) - 1) < 5e-16);
        assert_true(fabs(offset.y / (n2 * local.y) - 1) < 5e-16);
        assert_true(fabs(offset.z / n2 - 1) < 5e-16);
    }
}

static void axes_are_the_orientation(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        const impact_collision c = case_make(CASE_WILD, 5, i);
        imp_ready ready;
        imp_ready_make(&c, &ready);
        const imp_vectors v = imp_vectors_of(c.normal, c.normal), there = imp_ready_local(&ready, &v);
        const imp_vectors back = imp_ready_world(&ready, &there);
        for (int k = 0; k < 2; k++) {
            const impact_collider *body = &c.body[k];
            if (isinf(body->mass)) continue;
            const qvec3 n = imp_vectors_at(&there, k), r = quat_rotate_inverse(body->orientation, body->offset);
            assert_true(qvec3_norm(qvec3_sub(n, quat_rotate_inverse(body->orientation, c.normal))) < 2e-15);
            assert_true(qvec3_norm(qvec3_sub(imp_vectors_at(&back, k), c.normal)) < 2e-15);
            assert_true(qvec3_norm(qvec3_sub(imp_vectors_at(&ready.offset, k), r)) <= 2e-15 * qvec3_norm(r));
        }
    }
}

/* Nothing that a static body's moments and orientation hold gets through. */
static void round_and_static_bodies_stay_in_the_world(void **state)
{
    (void)state;
    const quat q = {0.5, 0.5, -0.5, 0.5}, none = {NAN, NAN, NAN, NAN};
    const impact_collider ball = {2, {3, 3, 3}, q, {1, 2, 3}, {0, 0, 0}, {0, 0, 0}};
    const impact_collider wall = {.mass = INFINITY, .moments = {NAN, 0, -1}, .orientation = none, .offset = {4, 5, 6}};
    const impact_collider rod = {2, {3, 3, 1}, q, {1, 2, 3}, {0, 0, 0}, {0, 0, 0}};
    imp_ready ready;
    imp_ready_make(&(impact_collision){.body = {ball, wall}}, &ready);
    assert_true(ready.round && ready.inverse_mass[0] == 0.5 && ready.inverse_moments.y[0] == 1.0 / 3);
    assert_true(ready.offset.x[0] == 1 && ready.arm.x[1] == 4);
    for (int i = 0; i < 2; i++) {
        if (i == 1) imp_ready_make(&(impact_collision){.body = {rod, wall}}, &ready);
        assert_true(ready.inverse_mass[1] == 0 && ready.inverse_moments.y[1] == 0 && ready.moments.x[1] == 0);
        assert_true(ready.offset.x[1] == 0 && ready.mass[1] == 0);
        assert_true(ready.axis[0].x[1] == 1 && ready.axis[1].y[1] == 1 && ready.axis[2].x[1] == 0);
    }
    assert_false(ready.round);
    imp_ready_make(&(impact_collision){.body = {rod, ball}}, &ready);
    assert_true(ready.axis[0].x[1] == 1 && ready.axis[1].z[1] == 0 && ready.offset.z[1] == 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(slim_offset_is_exact),
                                       cmocka_unit_test(axes_are_the_orientation),
                                       cmocka_unit_test(round_and_static_bodies_stay_in_the_world)};
    return cmocka_run_group_tests_name("impact collide_ready", tests, NULL, NULL);
}
