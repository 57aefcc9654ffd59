/* SPDX-License-Identifier: MIT
 *
 * A disc on a ball has one normal, the disc's own: whatever that is rounded to, the contact stays where it is.
 */
#include "kit/near.h"

#include <quat/rotation.h>
#include "kit/contact_random.h"
#include "world/normal.h"

static const double half_height = 0.05, radius = 0.3, aside = 0.1;

static imp_body body_of(impact_shape shape, bool is_static)
{
    return (imp_body){.shape = shape,
                      .radius = impact_shape_bounding_radius(&shape),
                      .is_static = is_static,
                      .mass = 1,
                      .inverse_mass = 1,
                      .moments = {1, 1, 1},
                      .inverse_moments = {1, 1, 1},
                      .turn = {1, 0, 0, 0}};
}

static void a_disc_that_lands_flat_stays_where_it_touches(void **state)
{
    (void)state;
    impact_shape disc, ball;
    random_stream random = {61};
    assert_int_equal(impact_shape_cylinder(radius, half_height, 0, &disc), IMPACT_OK);
    assert_int_equal(impact_shape_sphere(radius, &ball), IMPACT_OK);
    const imp_body above = body_of(disc, false), under = body_of(ball, true);
    for (int run = 0; run < 2000; run++) {
        const quat q = random_rotation(&random);
        const qvec3 up = quat_rotate(q, (qvec3){0, 0, 1}), side = quat_rotate(q, (qvec3){aside, 0, 0});
        const imp_state one = {.x = qvec3_add(qvec3_scale(up, radius + half_height), side),
                               .q = q,
                               .v = qvec3_scale(up, -2)},
                        two = {.q = {1, 0, 0, 0}};
        impact_contact contact = {.offset1 = qvec3_neg(qvec3_add(qvec3_scale(up, half_height), side)),
                                  .offset2 = qvec3_scale(up, radius)};
        contact.normal = qvec3_axpy(2e-16, random_direction(&random), up); /* as a search leaves it */
        const impact_contact found = contact;
        imp_settle_normal(&above, &one, &under, &two, 1e-9, &contact);
        assert_near3(contact.normal, found.normal, 1e-14);
        assert_near3(contact.offset1, found.offset1, 1e-12);
        assert_near3(contact.offset2, found.offset2, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_disc_that_lands_flat_stays_where_it_touches)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
