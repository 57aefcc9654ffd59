/* SPDX-License-Identifier: MIT
 *
 * Which normal a contact has. A disc on a ball has one, the disc's own: whatever that is rounded to, the contact stays
 * where it is. A box at another's edge has two: the one that attains the gap's rate. And what stands over a face, and
 * what beside it.
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

/* Two boxes, edge along edge: the upper one is over the lower's top and beside its side alike. Any motion chooses: the
 * normal along which they approach less, or part more; and none is chosen anew where the one that was found parts. */
static void at_an_edge_the_rate_decides(void **state)
{
    (void)state;
    impact_shape box;
    random_stream random = {67};
    int chosen[2] = {0, 0};
    assert_int_equal(impact_shape_box(0.2, 0.25, 0.3, 0, &box), IMPACT_OK);
    const imp_body moves = body_of(box, false), stays = body_of(box, true);
    for (int run = 0; run < 4000; run++) {
        const quat q = random_rotation(&random);
        const bool first = run % 2; /* which of the two moves */
        const qvec3 normal[2] = {quat_rotate(q, (qvec3){1, 0, 0}), quat_rotate(q, (qvec3){0, 0, 1})};
        const imp_state above = {.x = quat_rotate(q, (qvec3){0.4, 0.1, 0.6}),
                                 .q = q,
                                 .v = random_vector(&random, 0.1, 10)},
                        below = {.q = q};
        const qvec3 corner = quat_rotate(q, (qvec3){-0.2, 0, -0.3}), foot = quat_rotate(q, (qvec3){0.2, 0.1, 0.3});
        const int had = run / 2 % 2;
        const double side = first ? 1 : -1, rate[2] = {qvec3_dot(normal[0], above.v), qvec3_dot(normal[1], above.v)};
        impact_contact contact = {.offset1 = first ? corner : foot,
                                  .offset2 = first ? foot : corner,
                                  .normal = qvec3_scale(normal[had], side)};
        if (first)
            imp_settle_normal(&moves, &above, &stays, &below, 1e-9, &contact);
        else
            imp_settle_normal(&stays, &below, &moves, &above, 1e-9, &contact);
        const int want = rate[had] < 0 && rate[1 - had] > rate[had] ? 1 - had : had;
        chosen[want != had]++;
        assert_near3(contact.normal, qvec3_scale(normal[want], side), 1e-15);
        assert_near(contact.gap, 0, 1e-15);
        /* the places stay on both bodies and on each other */
        assert_near3(qvec3_sub(qvec3_add(above.x, first ? contact.offset1 : contact.offset2),
                               first ? contact.offset2 : contact.offset1),
                     (qvec3){0, 0, 0}, 1e-12);
    }
    assert_true(chosen[0] > 1000 && chosen[1] > 500);
    /* beyond `within` nothing is asked */
    const imp_state up = {.x = {0.4, 0, 0.7}, .q = {1, 0, 0, 0}, .v = {-1, 0, 0}}, still = {.q = {1, 0, 0, 0}};
    impact_contact apart = {.gap = 0.1, .normal = {1, 0, 0}};
    imp_settle_normal(&moves, &up, &stays, &still, 1e-9, &apart);
    assert_near3(apart.normal, (qvec3){1, 0, 0}, 0);
}

/* A ball over a box's top, a cylinder's disc and a cone's base, or beside: by its lowest point, as long as that is
 * within the border, by as much as it lies deep. */
static void what_stands_over_a_face(void **state)
{
    (void)state;
    random_stream random = {71};
    impact_shape ball, under[3];
    assert_int_equal(impact_shape_sphere(radius, &ball), IMPACT_OK);
    assert_int_equal(impact_shape_box(0.2, 0.3, 0.1, 0, &under[0]), IMPACT_OK);
    assert_int_equal(impact_shape_cylinder(0.25, 0.1, 0, &under[1]), IMPACT_OK);
    assert_int_equal(impact_shape_cone(0.25, 0.4, 0, &under[2]), IMPACT_OK);
    const imp_body above = body_of(ball, false);
    int over = 0, beside = 0;
    for (int run = 0; run < 6000; run++) {
        const int kind = run % 3;
        const imp_body face = body_of(under[kind], false);
        const quat q = random_rotation(&random);
        qvec3 lowest;
        const double x = 0.8 * random_unit(&random) - 0.4, y = 0.8 * random_unit(&random) - 0.4,
                     gap = 0.1 * random_unit(&random) - 0.05, way = kind == 2 ? -1 : 1,
                     top = impact_shape_support(&under[kind], (qvec3){0, 0, way}, &lowest);
        const imp_state ground = {.x = random_vector(&random, 0.1, 10), .q = q},
                        one = {.x = qvec3_add(ground.x, quat_rotate(q, (qvec3){x, y, way * (top + radius + gap)})),
                               .q = random_rotation(&random)};
        const double room = kind == 0 ? fmin(0.2 - fabs(x), 0.3 - fabs(y)) : 0.25 - hypot(x, y);
        const qvec3 n = quat_rotate(q, (qvec3){0, 0, way});
        if (fabs(room - fmax(0, -gap)) < 1e-9) continue;
        const bool stands = room >= fmax(0, -gap);
        for (int swapped = 0; swapped < 2; swapped++) {
            impact_contact contact;
            const bool found = swapped ? imp_face_gap(&face, &ground, &above, &one, qvec3_neg(n), &contact)
                                       : imp_face_gap(&above, &one, &face, &ground, n, &contact);
            assert_int_equal(found, stands);
            if (!found) continue;
            assert_near(contact.gap, gap, 1e-13);
            assert_near3(contact.normal, swapped ? qvec3_neg(n) : n, 1e-14);
            const qvec3 on_ball = swapped ? contact.offset2 : contact.offset1,
                        foot = swapped ? contact.offset1 : contact.offset2;
            assert_near3(on_ball, qvec3_scale(n, -radius), 1e-13);
            assert_near3(foot, quat_rotate(q, (qvec3){x, y, way * top}), 1e-13);
        }
        over += stands, beside += !stands;
    }
    assert_true(over > 500 && beside > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_disc_that_lands_flat_stays_where_it_touches),
                                       cmocka_unit_test(at_an_edge_the_rate_decides),
                                       cmocka_unit_test(what_stands_over_a_face)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
