/* SPDX-License-Identifier: MIT
 *
 * One test for each line of docs/conventions.md about bodies and contacts.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>
#include <impact/impact.h>

static void assert_vec3(qvec3 got, qvec3 wanted) { assert_true(qvec3_norm(qvec3_sub(got, wanted)) < 1e-15); }

static impact_contact sphere_over_plane(double height)
{
    impact_solid sphere = {.position = {0, 0, height}, .orientation = {1, 0, 0, 0}};
    impact_solid plane = {.orientation = {1, 0, 0, 0}};
    impact_contact contact;
    assert_int_equal(impact_shape_sphere(0.5, &sphere.shape), IMPACT_OK);
    assert_int_equal(impact_shape_plane(INFINITY, INFINITY, &plane.shape), IMPACT_OK);
    assert_true(impact_gap(&sphere, &plane, NULL, &contact) >= 0);
    return contact;
}

static void plane_is_the_half_space_under_its_z(void **state)
{
    (void)state;
    assert_vec3(sphere_over_plane(2).point2, qvec3_make(0, 0, 0));
    assert_true(sphere_over_plane(0.25).gap < 0);
}

static void gap_is_positive_apart(void **state)
{
    (void)state;
    assert_true(sphere_over_plane(2).gap == 1.5);
    assert_true(sphere_over_plane(0.25).gap == -0.25);
}

static void normal_points_from_body_2_to_body_1(void **state)
{
    (void)state;
    assert_vec3(sphere_over_plane(2).normal, qvec3_make(0, 0, 1));
}

static void offset_is_contact_point_minus_centre(void **state)
{
    (void)state;
    assert_vec3(sphere_over_plane(2).offset1, qvec3_make(0, 0, -0.5));
}

/* A 2 kg sphere (body 1) falls at 3 m/s on a resting one of the same mass (body 2), without friction. */
static impact_outcome head_on(void)
{
    impact_collision collision = {.normal = {0, 0, 1}, .restitution = 1};
    for (int body = 0; body < 2; body++)
        collision.body[body] = (impact_collider){.mass = 2,
                                                 .moments = {0.2, 0.2, 0.2},
                                                 .orientation = {1, 0, 0, 0},
                                                 .offset = {0, 0, body == 0 ? -0.5 : 0.5}};
    collision.body[0].velocity = qvec3_make(0, 0, -3);
    impact_outcome outcome;
    assert_int_equal(impact_collide(&collision, &outcome), IMPACT_OK);
    return outcome;
}

static void impulse_acts_on_body_1(void **state)
{
    (void)state;
    const impact_outcome outcome = head_on();
    assert_vec3(outcome.impulse, qvec3_make(0, 0, 6));
    assert_vec3(outcome.velocity[0], qvec3_make(0, 0, 0));
    assert_vec3(outcome.velocity[1], qvec3_make(0, 0, -3));
}

static void normal_velocity_is_positive_when_separating(void **state)
{
    (void)state;
    const impact_outcome outcome = head_on();
    assert_true(outcome.normal_before == -3 && outcome.normal_after == 3);
}

static void angular_velocity_is_in_world_axes(void **state)
{
    (void)state;
    const double half = sqrt(0.5), angle = 0.3;
    const impact_flight start = {.orientation = {half, half, 0, 0}, .omega = {0, 0, angle}};
    const quat wanted = quat_mul(quat_make(cos(angle / 2), 0, 0, sin(angle / 2)), start.orientation);
    const quat got = impact_flight_after(start, qvec3_make(0, 0, 0), 1).orientation;
    assert_true(quat_norm(quat_sub(got, wanted)) < 1e-15);
}

static void moments_are_along_the_body_axes(void **state)
{
    (void)state;
    impact_shape shape;
    assert_int_equal(impact_shape_superquadric(1, 2, 3, 2, 2, 2, &shape), IMPACT_OK);
    const qvec3 per_mass = impact_shape_inertia(&shape); /* of an ellipsoid: (b^2 + c^2)/5, ... */
    assert_true(qvec3_norm(qvec3_sub(per_mass, qvec3_make(13.0 / 5, 10.0 / 5, 5.0 / 5))) < 1e-14);
}

/* No weight, no force but damping: v = v0 (1 - d)^t. */
static void damping_is_the_part_lost_per_second(void **state)
{
    (void)state;
    impact_body_def body = impact_default_body_def();
    body.name = "ball";
    body.linear_damping = 0.5;
    body.velocity = qvec3_make(8, 0, 0);
    assert_int_equal(impact_shape_sphere(0.5, &body.shape), IMPACT_OK);
    impact_scene_def def = impact_default_scene_def();
    def.gravity = qvec3_make(0, 0, 0);
    def.bodies = &body;
    def.body_count = 1;
    def.duration = 3;
    impact_scene *scene;
    impact_sample sample;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    assert_int_equal(impact_scene_body(scene, 0, &sample), IMPACT_OK);
    assert_true(fabs(sample.velocity.x - 1) < 1e-10);
    impact_scene_destroy(scene);
}

static void failures_are_negative(void **state)
{
    (void)state;
    assert_true(IMPACT_OK == 0 && IMPACT_AT_REST > 0 && IMPACT_SEPARATING > 0);
    assert_true(IMPACT_EARGUMENT < 0 && IMPACT_EABSENT < 0);
}

/* What both libraries have has one number; no other number means something in both. */
static void statuses_of_both_libraries_have_one_numbering(void **state)
{
    (void)state;
    assert_int_equal(QUAT_OK, IMPACT_OK);
    assert_int_equal(QUAT_EARGUMENT, IMPACT_EARGUMENT);
    assert_int_equal(QUAT_EDOMAIN, IMPACT_EDOMAIN);
    assert_int_equal(QUAT_ENOMEM, IMPACT_ENOMEM);
    assert_int_equal(QUAT_EABSENT, IMPACT_EABSENT);
    int known = 0;
    for (int number = -64; number < 64; number++) {
        const bool quats = strcmp(quat_status_string((quat_status)number), "unknown status") != 0;
        const bool impacts = strcmp(impact_status_string((impact_status)number), "unknown status") != 0;
        if (number > 0 || number < IMPACT_EABSENT) assert_false(quats && impacts);
        known += quats + impacts;
    }
    assert_true(known > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plane_is_the_half_space_under_its_z),
        cmocka_unit_test(gap_is_positive_apart),
        cmocka_unit_test(normal_points_from_body_2_to_body_1),
        cmocka_unit_test(offset_is_contact_point_minus_centre),
        cmocka_unit_test(impulse_acts_on_body_1),
        cmocka_unit_test(normal_velocity_is_positive_when_separating),
        cmocka_unit_test(angular_velocity_is_in_world_axes),
        cmocka_unit_test(moments_are_along_the_body_axes),
        cmocka_unit_test(damping_is_the_part_lost_per_second),
        cmocka_unit_test(failures_are_negative),
        cmocka_unit_test(statuses_of_both_libraries_have_one_numbering),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
