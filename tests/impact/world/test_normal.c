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

/* A bar flush with a floor that is eight times as wide has the floor's normal however it moves; along its own the
 * floor's far edge would be what bears it. A floor that ends under its lower end has, where it is tilted by more, the
 * one of the two along which they approach less fast. */
static void what_lies_flush_has_one_normal(void **state)
{
    (void)state;
    impact_shape wide, narrow;
    random_stream random = {68};
    int turned = 0;
    assert_int_equal(impact_shape_box(4, 4, 1, 0, &wide), IMPACT_OK);
    assert_int_equal(impact_shape_box(0.5, 0.1, 0.02, 0, &narrow), IMPACT_OK);
    const imp_body floor = body_of(wide, true), bar = body_of(narrow, false);
    const double within = 3e-9;
    for (int run = 0; run < 4000; run++) {
        const bool flush = run % 2;
        const double tilt =
            (flush ? 0.02 + 0.1 * random_unit(&random) : 1.1 + random_unit(&random)) * within / bar.radius;
        const quat q = random_rotation(&random), tilted = {cos(tilt / 2), 0, sin(tilt / 2), 0};
        const qvec3 up = quat_rotate(q, (qvec3){0, 0, 1}),
                    corner = quat_rotate(quat_mul(q, tilted), (qvec3){0.5, 0.1, -0.02});
        const imp_state below = {.x = quat_rotate(q, (qvec3){flush ? 0 : -3.49, 0, -1}), .q = q},
                        above = {.x = qvec3_scale(up, -qvec3_dot(up, corner)),
                                 .q = quat_mul(q, tilted),
                                 .v = random_vector(&random, 0.1, 10)};
        impact_contact contact = {
            .offset1 = corner, .offset2 = qvec3_sub(qvec3_add(above.x, corner), below.x), .normal = up};
        imp_settle_normal(&bar, &above, &floor, &below, within, &contact);
        if (flush) assert_near3(contact.normal, up, 0);
        turned += qvec3_norm(qvec3_sub(contact.normal, up)) > 0;
    }
    assert_true(turned > 200);
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

/* Two boxes lean on each other, edge on edge, about y: what they touch along goes from the one's side to the other's.
 * At rest, and where they part along both alike, it is the middle, whichever is listed first; else that along which
 * they part fastest. Held by a step it is the middle, however they move. */
static void edges_on_each_other_touch_along_the_middle(void **state)
{
    (void)state;
    impact_shape box;
    random_stream random = {72};
    const double a = 0.2, c = 0.3;
    assert_int_equal(impact_shape_box(a, 0.25, c, 0, &box), IMPACT_OK);
    const imp_body body[2] = {body_of(box, false), body_of(box, false)};
    for (int run = 0; run < 4000; run++) {
        const quat q = random_rotation(&random);
        const double lean[2] = {0.02 + 0.7 * random_unit(&random), 0.02 + 0.7 * random_unit(&random)};
        const int moves = run % 4; /* 0: at rest, 1: along the middle, 2: across, 3: across, and held by a step */
        imp_state at[2];
        qvec3 corner[2], out[2];
        for (int k = 0; k < 2; k++) {
            const double side = k == 0 ? 1 : -1; /* the first is on the left and leans to the right */
            at[k] = (imp_state){.q = quat_mul(q, (quat){cos(lean[k] / 2), 0, side * sin(lean[k] / 2), 0})};
            corner[k] = quat_rotate(at[k].q, (qvec3){side * a, 0, c});
            out[k] = quat_rotate(at[k].q, (qvec3){1, 0, 0}); /* from the first to the second */
            at[k].x = qvec3_neg(corner[k]);
        }
        qvec3 middle;
        assert_int_equal(qvec3_normalize(qvec3_add(out[0], out[1]), &middle), QUAT_OK);
        const qvec3 across = qvec3_cross(middle, quat_rotate(q, (qvec3){0, 1, 0}));
        const double along = 2 * random_unit(&random) - 1, sideways = moves < 2 ? 0 : 2 * random_unit(&random) - 1;
        if (moves > 0) at[1].v = qvec3_axpy(sideways, across, qvec3_scale(middle, along));
        for (int first = 0; first < 2; first++) { /* normals go from body 2 to body 1 */
            const imp_body *one = &body[first], *two = &body[1 - first];
            const double sign = first == 0 ? -1 : 1, within = moves == 3 ? 2 * imp_stepped_flush(one, two) : 1e-9;
            const int found = run / 4 % 2;
            impact_contact contact = {
                .normal = qvec3_scale(out[found], sign), .offset1 = corner[first], .offset2 = corner[1 - first]};
            imp_settle_normal(one, &at[first], two, &at[1 - first], within, &contact);
            const double rate[2] = {qvec3_dot(out[0], at[1].v), qvec3_dot(out[1], at[1].v)};
            const int fastest = rate[found] < 0 && rate[1 - found] > rate[found] ? 1 - found : found;
            assert_near3(contact.normal, qvec3_scale(moves == 2 ? out[fastest] : middle, sign), 1e-14);
            assert_near3(contact.offset1, corner[first], 1e-12);
        }
    }
}

/* A ball over a box's top, a cylinder's disc and a cone's base, or beside: by its lowest point, as long as that is
 * within the border, and under the cone's side, by as much as it lies deep. */
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
        const double room = kind == 0 ? fmin(0.2 - fabs(x), 0.3 - fabs(y)) : 0.25 - hypot(x, y), deep = fmax(0, -gap),
                     under_side = kind < 2 || deep == 0 ? room : (room - 0.25 / 0.4 * deep) * 0.4 / hypot(0.25, 0.4);
        const qvec3 n = quat_rotate(q, (qvec3){0, 0, way});
        if (fabs(fmin(room, under_side) - deep) < 1e-9) continue;
        const bool stands = fmin(room, under_side) >= deep;
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

/* A ball that touches flat boxes, discs and cones, or all but does, wherever and whatever direction it is looked for:
 * where a face is said to part them it does, as the whole search has it. */
static void no_nearer_way_out_is_left(void **state)
{
    (void)state;
    random_stream random = {72};
    impact_shape ball, under[4];
    assert_int_equal(impact_shape_sphere(radius, &ball), IMPACT_OK);
    assert_int_equal(impact_shape_box(0.2, 0.3, 0.01, 0, &under[0]), IMPACT_OK);
    assert_int_equal(impact_shape_cylinder(0.25, 0.01, 0, &under[1]), IMPACT_OK);
    assert_int_equal(impact_shape_cone(0.25, 0.4, 0, &under[2]), IMPACT_OK);
    assert_int_equal(impact_shape_cone(0.25, 0.1, 0.02, &under[3]), IMPACT_OK);
    const imp_body above = body_of(ball, false);
    int found = 0;
    for (int run = 0; run < 20000; run++) {
        const imp_body face = body_of(under[run % 4], false);
        const imp_state ground = {.q = {1, 0, 0, 0}};
        imp_state one = {.x = random_vector(&random, 0.1, 1), .q = {1, 0, 0, 0}};
        impact_contact whole, contact;
        const impact_solid solids[2] = {{.shape = ball, .position = one.x, .orientation = one.q},
                                        {.shape = under[run % 4], .orientation = ground.q}};
        if (impact_gap(&solids[0], &solids[1], NULL, &whole) != IMPACT_OK) continue;
        one.x = qvec3_axpy(1e-3 * random_unit(&random) - 9e-4 - whole.gap, whole.normal, one.x);
        impact_solid moved = solids[0];
        moved.position = one.x;
        if (impact_gap(&moved, &solids[1], NULL, &whole) != IMPACT_OK) continue;
        const qvec3 n = run % 3 == 0 ? random_direction(&random) : whole.normal;
        if (!imp_face_gap(&above, &one, &face, &ground, n, &contact)) continue;
        assert_near(contact.gap, whole.gap, 1e-12);
        found++;
    }
    assert_true(found > 2000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_disc_that_lands_flat_stays_where_it_touches),
                                       cmocka_unit_test(what_lies_flush_has_one_normal),
                                       cmocka_unit_test(at_an_edge_the_rate_decides),
                                       cmocka_unit_test(edges_on_each_other_touch_along_the_middle),
                                       cmocka_unit_test(what_stands_over_a_face),
                                       cmocka_unit_test(no_nearer_way_out_is_left)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
