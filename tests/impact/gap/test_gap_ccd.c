/* SPDX-License-Identifier: MIT
 *
 * libccd's own gap against impact_gap: what its tolerance is worth, that it says so where it has no answer, and what it
 * refuses.
 */
#include <quat/rotation.h>
#include <impact/gap.h>
#include <impact/status.h>
#include "kit/near.h"
#include "kit/contact_random.h"

static impact_solid at(impact_shape shape, qvec3 position, quat orientation)
{
    return (impact_solid){shape, position, orientation};
}

static impact_solid random_body(random_stream *seed, double spread, double exponent)
{
    impact_shape shape;
    double u[7];
    for (int k = 0; k < 7; k++) u[k] = 2 * random_unit(seed) - 1;
    impact_shape_superquadric(.1 + .1 * fabs(u[0]), .2, .3, exponent, exponent, exponent, &shape);
    return at(shape, (qvec3){spread * u[1], spread * u[2], spread * u[3]}, quat_unit((quat){u[4], u[5], u[6], 0.3}));
}

/* Every answer within its tolerance, to the factor that its check allows; and hardly ever none. */
static void it_is_as_good_as_it_was_asked_for(void **state)
{
    (void)state;
    enum { PAIRS = 400 };
    random_stream seed = {7};
    for (double tolerance = 1e-2; tolerance > 0.5e-7; tolerance /= 10) {
        int none = 0, asked = 0;
        for (int k = 0; k < PAIRS; k++) {
            const impact_solid a = random_body(&seed, 0, 2 + k % 3), b = random_body(&seed, 0.8, 2);
            impact_contact exact, ccd;
            assert_int_equal(impact_gap(&a, &b, NULL, &exact), IMPACT_OK);
            if (exact.gap < -0.02) continue;
            asked++;
            const impact_status status = impact_gap_ccd(&a, &b, tolerance, &ccd);
            none += status == IMPACT_EUNSETTLED;
            if (status != IMPACT_OK) continue;
            assert_int_equal(ccd.path, IMPACT_PATH_CCD);
            assert_near(ccd.gap, exact.gap, 31 * tolerance * 0.3);
            assert_near(qvec3_norm(ccd.normal), 1, 1e-15);
            assert_true(ccd.lower == ccd.gap && ccd.upper == ccd.gap && isnan(ccd.stiffness));
            const qvec3 apart = qvec3_sub(ccd.point1, ccd.point2);
            assert_near(qvec3_dot(ccd.normal, apart), ccd.gap, 31 * tolerance * 0.3); /* support points along it */
        }
        assert_true(asked > PAIRS / 2);
        assert_at_most(none, asked / 100.0);
    }
}

/* Swapped bodies: within the tolerance the same gap, and the normal turned round. */
static void swapped_bodies_answer_alike(void **state)
{
    (void)state;
    random_stream seed = {9};
    for (int k = 0; k < 100; k++) {
        const impact_solid a = random_body(&seed, 0, 2), b = random_body(&seed, 0.8, 2);
        impact_contact one, other;
        if (impact_gap_ccd(&a, &b, 1e-5, &one) != IMPACT_OK || impact_gap_ccd(&b, &a, 1e-5, &other) != IMPACT_OK)
            continue;
        if (one.gap < 0) continue;
        assert_near(one.gap, other.gap, 1e-4);
        assert_near3(one.normal, qvec3_neg(other.normal), 0.1);
    }
}

static void closed_forms_stay_closed_forms(void **state)
{
    (void)state;
    impact_shape ball, plane;
    impact_shape_sphere(0.3, &ball);
    impact_shape_plane(INFINITY, INFINITY, &plane);
    const impact_solid a = at(ball, (qvec3){0, 0, 1}, quat_identity()), b = at(ball, (qvec3){0, 1, 0}, quat_identity()),
                       floor = at(plane, (qvec3){0, 0, 0}, quat_identity());
    impact_contact one, same;
    assert_int_equal(impact_gap_ccd(&a, &b, 1e-4, &one), IMPACT_OK);
    impact_gap(&a, &b, NULL, &same);
    assert_true(one.gap == same.gap && one.path == IMPACT_PATH_CLOSED_FORM);
    assert_int_equal(impact_gap_ccd(&a, &floor, 1e-4, &one), IMPACT_OK);
    assert_true(one.path == IMPACT_PATH_CLOSED_FORM && one.gap == 1 - 0.3);
    assert_int_equal(impact_gap_ccd(&floor, &floor, 1e-4, &one), IMPACT_EARGUMENT);
}

static void it_refuses_what_it_cannot_give(void **state)
{
    (void)state;
    random_stream seed = {3};
    const impact_solid a = random_body(&seed, 0, 2), b = random_body(&seed, 0.8, 2);
    const double bad[] = {0, -1, 0.99e-7, 1.01e-2, NAN, INFINITY};
    impact_contact contact;
    for (int k = 0; k < 6; k++) {
        assert_int_equal(impact_gap_ccd(&a, &b, bad[k], &contact), IMPACT_EARGUMENT);
        assert_true(isnan(contact.gap) && contact.path == IMPACT_PATH_NONE);
    }
    impact_solid lost = b;
    lost.position.x = NAN;
    assert_int_equal(impact_gap_ccd(&a, &lost, 1e-4, &contact), IMPACT_EDOMAIN);
}

static void a_build_without_it_says_so(void **state)
{
    (void)state;
    random_stream seed = {3};
    const impact_solid a = random_body(&seed, 0, 2), b = random_body(&seed, 0.8, 2);
    impact_contact contact;
    assert_int_equal(impact_gap_ccd(&a, &b, 1e-4, &contact), IMPACT_EABSENT);
    assert_true(isnan(contact.gap));
}

int main(void)
{
    const struct CMUnitTest with[] = {
        cmocka_unit_test(it_is_as_good_as_it_was_asked_for), cmocka_unit_test(swapped_bodies_answer_alike),
        cmocka_unit_test(closed_forms_stay_closed_forms), cmocka_unit_test(it_refuses_what_it_cannot_give)};
    const struct CMUnitTest without[] = {cmocka_unit_test(a_build_without_it_says_so),
                                         cmocka_unit_test(closed_forms_stay_closed_forms)};
    return impact_has(IMPACT_PART_CCD) ? cmocka_run_group_tests(with, NULL, NULL)
                                       : cmocka_run_group_tests(without, NULL, NULL);
}
