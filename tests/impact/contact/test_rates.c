/* SPDX-License-Identifier: MIT
 *
 * How a contact moves with its bodies: against the contact a moment later, and without noise where one surface is
 * nearly flat.
 */
#include "contact/rates.h"
#include "kit/contact_random.h"
#include "kit/near.h"
#include "world/world_gap.h"

/* Two bodies that touch at one point, and no faster than they slide. */
typedef struct touching {
    imp_body bodies[2];
    imp_state states[2];
    imp_pair pair;
    imp_world world;
} touching;

static imp_body body_of(impact_shape shape)
{
    return (imp_body){.shape = shape,
                      .radius = impact_shape_bounding_radius(&shape),
                      .mass = 1,
                      .inverse_mass = 1,
                      .moments = {1, 1, 1},
                      .inverse_moments = {1, 1, 1},
                      .turn = {1, 0, 0, 0}};
}

/* A ball or an ellipsoid, or a superquadric of these exponents. */
static impact_shape shape_of(random_stream *random, int kind, double exponent)
{
    impact_shape shape;
    const double a = random_log(random, 0.3, 1), b = random_log(random, 0.3, 1), c = random_log(random, 0.3, 1);
    if (kind == 0) impact_shape_sphere(a, &shape);
    if (kind == 1) impact_shape_ellipsoid(a, b, c, &shape);
    if (kind == 2) impact_shape_superquadric(a, b, c, exponent, fmax(2, 0.7 * exponent), 2 + 0.3 * exponent, &shape);
    return shape;
}

/* Side by side along n, as the support functions have it; the normal velocities are made equal. */
static impact_contact contact_along(touching *t, random_stream *random, qvec3 n)
{
    imp_state *one = &t->states[0], *two = &t->states[1];
    qvec3 arm[2];
    t->world = (imp_world){.bodies = t->bodies, .body_count = 2};
    for (int k = 0; k < 2; k++) {
        const qvec3 out = k == 0 ? qvec3_neg(n) : n, d = quat_rotate_inverse(t->states[k].q, out);
        imp_world_support(&t->bodies[k], d, &arm[k]);
        arm[k] = quat_rotate(t->states[k].q, arm[k]);
        t->states[k].v = qvec3_scale(random_direction(random), 2);
        t->states[k].momentum = qvec3_scale(random_direction(random), 5);
    }
    one->x = qvec3_sub(arm[1], arm[0]);
    const qvec3 u =
        qvec3_sub(imp_point_velocity(&t->bodies[0], one, arm[0]), imp_point_velocity(&t->bodies[1], two, arm[1]));
    one->v = qvec3_axpy(-qvec3_dot(u, n), n, one->v);
    return (impact_contact){.normal = n, .offset1 = arm[0], .offset2 = arm[1]};
}

/* Turned any way. */
static touching bodies_of(const impact_shape shapes[2], random_stream *random)
{
    touching t = {.bodies = {body_of(shapes[0]), body_of(shapes[1])}, .pair = {.body1 = 0, .body2 = 1}};
    for (int k = 0; k < 2; k++) t.states[k] = (imp_state){.q = random_rotation(random)};
    return t;
}

/* The contact after a while of going on as they go. */
static impact_contact later(const touching *t, double h)
{
    imp_state states[2];
    for (int k = 0; k < 2; k++) {
        states[k] = t->states[k];
        states[k].x = qvec3_axpy(h, states[k].v, states[k].x);
        states[k].q = quat_mul(quat_from_rotation_vector(qvec3_scale(states[k].momentum, h)), states[k].q);
    }
    impact_contact contact;
    impact_usage usage = {0};
    assert_true(imp_gap_of(&t->bodies[0], &states[0], &t->bodies[1], &states[1], NULL, &usage, &contact) >= 0);
    return contact;
}

/* By differences over h and 2 h to both sides. */
static imp_rates measured(const touching *t, double h)
{
    const impact_contact a = later(t, h), b = later(t, -h), c = later(t, 2 * h), d = later(t, -2 * h);
    const qvec3 near[3] = {qvec3_sub(a.normal, b.normal), qvec3_sub(a.offset1, b.offset1),
                           qvec3_sub(a.offset2, b.offset2)},
                far[3] = {qvec3_sub(c.normal, d.normal), qvec3_sub(c.offset1, d.offset1),
                          qvec3_sub(c.offset2, d.offset2)};
    qvec3 slope[3];
    for (int k = 0; k < 3; k++) slope[k] = qvec3_scale(qvec3_axpy(-0.125, far[k], near[k]), 2 / (3 * h));
    return (imp_rates){slope[0], slope[1], slope[2]};
}

static double apart(const imp_rates *a, const imp_rates *b)
{
    return qvec3_norm(qvec3_sub(a->normal, b->normal)) + qvec3_norm(qvec3_sub(a->arm1, b->arm1)) +
           qvec3_norm(qvec3_sub(a->arm2, b->arm2));
}

/* Where differences of two widths agree: over a flat place a contact runs too fast for them. */
static void rates_are_those_of_the_contact_that_moves(void **state)
{
    (void)state;
    random_stream random = {71};
    const imp_rates none = {.normal = {0, 0, 0}};
    int compared = 0;
    for (int run = 0; run < 3000; run++) {
        const double exponents[2] = {random_log(&random, 2, 6), random_log(&random, 2, 6)};
        const impact_shape shapes[2] = {shape_of(&random, run % 3, exponents[0]),
                                        shape_of(&random, run / 3 % 3, exponents[1])};
        touching t = bodies_of(shapes, &random);
        const impact_contact contact = contact_along(&t, &random, random_direction(&random));
        const imp_rates rates = imp_contact_rates(&t.world, &t.pair, IMP_BORNE_BY_BOTH, &contact, t.states),
                        wide = measured(&t, 2e-4), narrow = measured(&t, 1e-4);
        const double fast = apart(&narrow, &none);
        if (apart(&wide, &narrow) > 1e-7 * fast) continue;
        compared++;
        assert_at_most(apart(&rates, &narrow), 1e-6 * fast);
    }
    assert_true(compared > 2000);
}

/* Where one surface is nearly flat, a rounding of the normal changes no rate. */
static void a_flat_place_makes_no_noise(void **state)
{
    (void)state;
    random_stream random = {72};
    for (int run = 0; run < 1000; run++) {
        const int flat = run & 1;
        impact_shape shapes[2];
        shapes[1 - flat] = shape_of(&random, run / 2 % 2, 0);
        shapes[flat] = shape_of(&random, 2, random_log(&random, 3, 100));
        touching t = bodies_of(shapes, &random);
        /* the middle of a face and its edges are left out */
        const double share = 0.3 + 0.5 * random_unit(&random);
        const qvec3 own = {pow(share, shapes[flat].r - 1), pow(share, shapes[flat].s - 1), 1},
                    out = quat_rotate(t.states[flat].q, qvec3_scale(own, 1 / qvec3_norm(own)));
        impact_contact contact = contact_along(&t, &random, flat == 1 ? out : qvec3_neg(out));
        const imp_rates rates = imp_contact_rates(&t.world, &t.pair, IMP_BORNE_BY_BOTH, &contact, t.states);
        const double fast = qvec3_norm(rates.arm1) + qvec3_norm(rates.arm2) + qvec3_norm(rates.normal);
        for (int k = 0; k < 10; k++) {
            impact_contact rounded = contact;
            rounded.normal = qvec3_axpy(2e-16, random_direction(&random), contact.normal);
            const imp_rates again = imp_contact_rates(&t.world, &t.pair, IMP_BORNE_BY_BOTH, &rounded, t.states);
            assert_near3(again.arm1, rates.arm1, 1e-13 * fast);
            assert_near3(again.arm2, rates.arm2, 1e-13 * fast);
            assert_near3(again.normal, rates.normal, 1e-13 * fast);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rates_are_those_of_the_contact_that_moves),
                                       cmocka_unit_test(a_flat_place_makes_no_noise)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
