/* SPDX-License-Identifier: MIT
 *
 * What may land yet beside what is held: of bodies that lie on the ends of a line nothing may, but for the far sides of
 * their rims, whose heights are closed forms.
 */
#include "kit/near.h"

#include <quat/rotation.h>
#include "kit/contact_random.h"
#include "world/corner.h"

typedef struct lying {
    imp_body bodies[2];
    imp_pair pairs[2]; /* the corners 1 and 2 of body 0, on the plane */
    imp_state states[2];
    imp_world world;
} lying;

/* The body's centre of mass is its shape's; turned so that `down` of its axes is the plane's. */
static void lay_on_plane(impact_shape shape, qvec3 down, lying *on)
{
    impact_shape plane;
    assert_int_equal(impact_shape_plane(INFINITY, INFINITY, &plane), IMPACT_OK);
    *on = (lying){.pairs = {{0, 1, .mode = IMP_STICK, .site.corner = 1}, {0, 1, .mode = IMP_SLIDE, .site.corner = 2}}};
    const impact_shape shapes[2] = {shape, plane};
    for (int k = 0; k < 2; k++) {
        on->bodies[k] = (imp_body){.shape = shapes[k],
                                   .radius = k == 0 ? impact_shape_bounding_radius(&shape) : 0,
                                   .is_static = k == 1,
                                   .mass = 1,
                                   .inverse_mass = 1,
                                   .moments = {1, 1, 1},
                                   .inverse_moments = {1, 1, 1},
                                   .turn = {1, 0, 0, 0}};
        on->states[k] = (imp_state){.q = {1, 0, 0, 0}};
    }
    quat turn;
    assert_int_equal(quat_from_two_vectors(down, (qvec3){0, 0, -1}, &turn), QUAT_OK);
    on->states[0].q = turn;
    on->world = (imp_world){.bodies = on->bodies, .body_count = 2, .pairs = on->pairs, .pair_count = 2};
    on->states[0].x.z = -imp_corner_contact(&on->world, &on->pairs[0], on->states, NULL).gap;
}

static double clearance(const lying *on, int p) { return imp_corner_clearance(&on->world, &on->pairs[p], on->states); }

/* Of the side's normal (h, r)/hypot(h, r). */
static void a_cone_that_lies_on_its_side(void **state)
{
    (void)state;
    random_stream random = {71};
    for (int run = 0; run < 1000; run++) {
        const double r = random_log(&random, 0.1, 2), h = random_log(&random, 0.1, 2), size = hypot(r, h);
        impact_shape cone;
        lying on;
        assert_int_equal(impact_shape_cone(r, h, 0, &cone), IMPACT_OK);
        lay_on_plane(cone, (qvec3){h / size, 0, r / size}, &on);
        assert_near(clearance(&on, 0), 2 * r * h / size, 1e-12);
        assert_true(clearance(&on, 1) == INFINITY); /* the rim's pair tells it */
        on.pairs[1].mode = IMP_OPEN;
        assert_near(clearance(&on, 0), 0, 1e-12); /* the top */
        on.pairs[1].mode = IMP_STICK, on.pairs[0].mode = IMP_OPEN;
        assert_near(clearance(&on, 1), 0, 1e-12); /* the rim's lowest place */
    }
}

static void a_cylinder_that_lies_on_its_side(void **state)
{
    (void)state;
    impact_shape cylinder;
    lying on;
    assert_int_equal(impact_shape_cylinder(0.3, 0.7, 0, &cylinder), IMPACT_OK);
    lay_on_plane(cylinder, (qvec3){1, 0, 0}, &on);
    for (int p = 0; p < 2; p++) assert_near(clearance(&on, p), 0.6, 1e-15);
}

static void a_capsule_that_lies_on_its_side(void **state)
{
    (void)state;
    impact_shape capsule;
    lying on;
    assert_int_equal(impact_shape_capsule(0.3, 0.7, &capsule), IMPACT_OK);
    lay_on_plane(capsule, (qvec3){1, 0, 0}, &on);
    for (int p = 0; p < 2; p++) assert_true(clearance(&on, p) == INFINITY);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_cone_that_lies_on_its_side),
                                       cmocka_unit_test(a_cylinder_that_lies_on_its_side),
                                       cmocka_unit_test(a_capsule_that_lies_on_its_side)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
