/* SPDX-License-Identifier: MIT
 *
 * Shapes with faces beside smooth ones and round ones. Truth by construction: a feature of the first body, a normal in
 * its cone and a point on it; the second body stands with its support point opposite, the gap away.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <impact/toi.h>
#include "gap/gap_walk.h"
#include "base/tolerances.h"
#include "gap/gap_solver.h"
#include "kit/figures.h"
#include "kit/mixed_pairs.h"

/* Of the reach: how far the points of a contact that is settled are from facing each other, x1 - x2 = gap n. */
static double aside_of(const mixed_pair *pair, const impact_contact *contact)
{
    const qvec3 x1 = qvec3_add(pair->body[0].position, contact->offset1),
                x2 = qvec3_add(pair->body[1].position, contact->offset2);
    return qvec3_norm(qvec3_sub(qvec3_sub(x1, x2), qvec3_scale(contact->normal, contact->gap))) / pair->reach;
}

/* 1: the answer is told not to be settled, with a bracket that holds what was made. */
static int check_pair(const mixed_pair *pair, const char *what, int i)
{
    impact_contact contact;
    const impact_status status = impact_gap(&pair->body[0], &pair->body[1], NULL, &contact);
    const double error = (contact.gap - pair->gap) / pair->reach;
    const double receipt = impact_gap_receipt(&pair->body[0], &pair->body[1], &contact, NULL);
    if (status == IMPACT_OK) assert_true(aside_of(pair, &contact) <= 2e-14);
    /* apart the gap is what was made; overlapping it is no less */
    if (status == IMPACT_OK && (pair->gap >= 0 ? fabs(error) : -error) <= 1e-14 && receipt <= 20) return 0;
    if (pair->gap < 0 && (status == IMPACT_BRACKET || status == IMPACT_DEEP) && contact.upper >= pair->gap) return 1;
    fail_msg("%s %d (kinds %d, %d): status %d, gap %.17g, made %.17g, error %.3g, receipt %.3g", what, i,
             (int)pair->body[0].shape.kind, (int)pair->body[1].shape.kind, (int)status, contact.gap, pair->gap, error,
             receipt);
    return 1;
}

static void apart(void **state)
{
    (void)state;
    random_stream random = {1};
    for (int i = 0; i < 6000; i++) {
        mixed_pair pair = random_mixed_pair(&random, i % MIXED_FAMILIES, random_log(&random, 1e-6, 1));
        check_pair(&pair, mixed_family_name(i % MIXED_FAMILIES), i);
        end_mixed_pair(&pair);
    }
}

static void shallow_overlap(void **state)
{
    (void)state;
    random_stream random = {2};
    int flagged = 0;
    for (int i = 0; i < 2000; i++) {
        mixed_pair pair = random_mixed_pair(&random, i % MIXED_FAMILIES, -random_log(&random, 1e-9, 1e-3));
        flagged += check_pair(&pair, mixed_family_name(i % MIXED_FAMILIES), i);
        end_mixed_pair(&pair);
    }
    assert_true(flagged < 20); /* a cone's edge on a polyhedron's */
}

/* Deep: right, or a bracket that says so; no normal of many contradicts either. */
static void deep_overlap(void **state)
{
    (void)state;
    random_stream random = {3};
    int flagged = 0;
    for (int i = 0; i < 400; i++) {
        mixed_pair pair = random_mixed_pair(&random, i % MIXED_FAMILIES, 1);
        pair.body[0].position = qvec3_scale(random_direction(&random), 0.2 * random_unit(&random));
        pair.body[1].position = (qvec3){0, 0, 0};
        impact_contact contact;
        const impact_status status = impact_gap(&pair.body[0], &pair.body[1], NULL, &contact);
        flagged += status != IMPACT_OK;
        assert_true(status == IMPACT_OK || status == IMPACT_DEEP || status == IMPACT_BRACKET);
        const double size = contact_size(&pair.body[0].shape) + contact_size(&pair.body[1].shape);
        assert_true(contact.upper - contact.lower <= 0.011 * size);
        for (int k = 0; k < 300; k++) {
            const qvec3 n = random_direction(&random),
                        v = qvec3_add(
                            qvec3_sub(pair.body[0].position, pair.body[1].position),
                            qvec3_sub(contact_support(&pair.body[0], qvec3_neg(n)), contact_support(&pair.body[1], n)));
            if (qvec3_dot(n, v) > contact.upper + 1e-14 * size)
                fail_msg("%s %d: %.17g along a normal, upper %.17g, status %d", mixed_family_name(i % MIXED_FAMILIES),
                         i, qvec3_dot(n, v), contact.upper, (int)status);
        }
        end_mixed_pair(&pair);
    }
    assert_true(flagged < 60);
}

static void swapped(void **state)
{
    (void)state;
    random_stream random = {4};
    for (int i = 0; i < 2000; i++) {
        mixed_pair pair = random_mixed_pair(&random, i % MIXED_FAMILIES, random_log(&random, 1e-6, 1));
        const impact_solid first = pair.body[0];
        impact_contact one, other;
        assert_int_equal(impact_gap(&pair.body[0], &pair.body[1], NULL, &one), IMPACT_OK);
        pair.body[0] = pair.body[1], pair.body[1] = first;
        assert_int_equal(impact_gap(&pair.body[0], &pair.body[1], NULL, &other), IMPACT_OK);
        assert_true(fabs(one.gap - other.gap) <= 2e-14 * pair.reach);
        end_mixed_pair(&pair);
    }
}

/* Tumbling bodies that fly at each other: the gap is 0 at the time told, and they do not overlap at any of many before.
 */
static void times_of_impact(void **state)
{
    (void)state;
    random_stream random = {5};
    int met = 0;
    for (int i = 0; i < 300; i++) {
        mixed_pair pair = random_mixed_pair(&random, i % MIXED_FAMILIES, 1);
        impact_motion motion[2];
        for (int k = 0; k < 2; k++) motion[k] = (impact_motion){.omega = qvec3_scale(random_direction(&random), 3)};
        pair.body[0].position = qvec3_scale(random_direction(&random), 8);
        motion[0].velocity = qvec3_scale(pair.body[0].position, -0.25);
        double time;
        impact_contact contact;
        const impact_status status =
            impact_toi(&pair.body[0], &motion[0], &pair.body[1], &motion[1], 4, &time, &contact);
        assert_true(status == IMPACT_OK || status == IMPACT_EUNSETTLED);
        met += status == IMPACT_OK;
        for (int k = 0; status == IMPACT_OK && k < 50; k++) {
            const double t = time * k / 50;
            const impact_solid one = impact_motion_at(&pair.body[0], &motion[0], t),
                               two = impact_motion_at(&pair.body[1], &motion[1], t);
            impact_contact before;
            if (impact_gap(&one, &two, NULL, &before) == IMPACT_OK && before.gap < -1e-12)
                fail_msg("%d: overlap of %g at %g, told %g", i, -before.gap, t, time);
        }
        if (status == IMPACT_OK) assert_true(fabs(contact.gap) < 1e-13);
        end_mixed_pair(&pair);
    }
    assert_true(met > 290);
}

/* A cylinder that stands on a face of a polyhedron, over its border or not, leaning by up to 1e-4, and all but touches.
 */
static mixed_pair stand_on_face(random_stream *random)
{
    mixed_pair pair = {.hull = {NULL, random_hull(random, 4 + (int)(9 * random_unit(random)), 0)}};
    impact_solid *top = &pair.body[0], *base = &pair.body[1];
    impact_shape_polyhedron(pair.hull[1], &base->shape);
    impact_shape_cylinder(random_log(random, 0.2, 1), random_log(random, 0.2, 1), 0, &top->shape);
    int corner[IMPACT_HULL_POINTS];
    qvec3 n;
    const int f = (int)(impact_hull_describe(pair.hull[1]).faces * random_unit(random));
    const int count = impact_hull_face(pair.hull[1], f, corner, &n);
    const qvec3 out = impact_hull_vertex(pair.hull[1], corner[(int)(count * random_unit(random))]);
    base->orientation = random_rotation(random);
    pair.normal = quat_rotate(base->orientation, n);
    const qvec3 axis = qvec3_cross((qvec3){0, 0, 1}, pair.normal);
    const double lean = random_unit(random) < 0.2 ? 0 : random_log(random, 1e-15, 1e-4);
    quat upright, leaning;
    assert_int_equal(quat_from_axis_angle(axis, atan2(qvec3_norm(axis), pair.normal.z), &upright), QUAT_OK);
    assert_int_equal(quat_from_axis_angle(random_direction(random), lean, &leaning), QUAT_OK);
    top->orientation = quat_mul(leaning, upright);
    const double gap = (random_unit(random) < 0.5 ? 1 : -1) * random_log(random, 1e-14, 1e-6);
    const double high = gap + qvec3_dot(pair.normal, contact_support(base, pair.normal)) -
                        qvec3_dot(pair.normal, contact_support(top, qvec3_neg(pair.normal)));
    const qvec3 at = qvec3_scale(quat_rotate(base->orientation, out), 1.2 * random_unit(random));
    base->position = (qvec3){0, 0, 0};
    top->position = qvec3_axpy(high - qvec3_dot(pair.normal, at), pair.normal, at);
    pair.reach = fmax(contact_size(&top->shape), contact_size(&base->shape)) + qvec3_norm(top->position);
    return pair;
}

/* From the face's normal Newton settles them, on what is found without a normal to begin with. */
static void on_a_face(void **state)
{
    (void)state;
    random_stream random = {6};
    int others = 0;
    for (int i = 0; i < 4000; i++) {
        mixed_pair pair = stand_on_face(&random);
        impact_gap_cache cache = {true, pair.normal};
        impact_contact near, far;
        const impact_status status = impact_gap(&pair.body[0], &pair.body[1], &cache, &near);
        if (status == IMPACT_OK) assert_true(impact_gap_receipt(&pair.body[0], &pair.body[1], &near, NULL) <= 20);
        if (status == IMPACT_OK && impact_gap(&pair.body[0], &pair.body[1], NULL, &far) == IMPACT_OK)
            assert_true(fabs(near.gap - far.gap) <= 4e-14 * pair.reach);
        others += status != IMPACT_OK || near.path != IMPACT_PATH_NEWTON;
        end_mixed_pair(&pair);
    }
    show_figure("not settled by Newton", others);
    assert_true(others < 40); /* 20: among them rims that lean by 1e-11, whose lowest place rounding hides */
}

/* How far the centre of a ball of radius r is in a cylinder, the ball touching it from inside at (x, 0, z). */
static double room_of(double R, double h, bool cap, double x, double z, double r)
{
    return fmin(R - fabs(cap ? x : R - r), h - fabs(cap ? r - h : z));
}

/* The ball is in the cylinder, and no larger one is. */
static void balls_in_cylinders(void **state)
{
    (void)state;
    random_stream random = {7};
    for (int i = 0; i < 2000; i++) {
        impact_shape shape;
        imp_form form;
        const double R = random_log(&random, 0.1, 1), h = random_log(&random, 0.1, 1), part = random_unit(&random);
        const bool cap = random_unit(&random) < 0.5;
        impact_shape_cylinder(R, h, 0, &shape);
        imp_form_make(&shape, 1, quat_identity(), &form);
        const double x[3] = {cap ? part * R : R, 0, cap ? -h : (2 * part - 1) * h};
        const double r = imp_walk_inner_radius(&form, x), more = 1.01 * r;
        assert_true(room_of(R, h, cap, x[0], x[2], r) >= r - 1e-15);
        assert_true(room_of(R, h, cap, x[0], x[2], more) < more);
    }
}

/* What balls in both bodies prove at once, the halving of the whole sphere of normals does not speak against. */
static void nearest_by_the_whole_sphere(void **state)
{
    (void)state;
    random_stream random = {8};
    int asked = 0;
    for (int i = 0; i < 3000; i++) {
        mixed_pair made = random_mixed_pair(&random, i % MIXED_CAPSULE_SMOOTH, -random_log(&random, 1e-5, 0.1));
        const impact_solid *b = made.body;
        impact_contact contact;
        const impact_status status = impact_gap(&b[0], &b[1], NULL, &contact);
        const double scale = imp_gap_scale(&b[0], &b[1]), rounding = b[0].shape.rounding + b[1].shape.rounding;
        double gap = (contact.gap + rounding) * scale;
        if (status == IMPACT_OK && gap < 0) {
            imp_gap_solids pair;
            imp_gap_pair(&b[0], b[0].orientation, &b[1], b[1].orientation, scale, &pair);
            double n[3] = {contact.normal.x, contact.normal.y, contact.normal.z};
            const double peak[3] = {gap * n[0], gap * n[1], gap * n[2]};
            imp_gap_peaks peaks = {0};
            imp_gap_peak_add(peak, &peaks);
            assert_int_not_equal(imp_gap_prove(&pair, &peaks, 2 * IMP_GAP_SLACK * pair.reach, false, &gap, n),
                                 IMP_PROOF_AGAINST);
            asked++;
        }
        end_mixed_pair(&made);
    }
    assert_in_range(asked, 1500, 3000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(apart),
        cmocka_unit_test(shallow_overlap),
        cmocka_unit_test(nearest_by_the_whole_sphere),
        cmocka_unit_test(deep_overlap),
        cmocka_unit_test(swapped),
        cmocka_unit_test(times_of_impact),
        cmocka_unit_test(on_a_face),
        cmocka_unit_test(balls_in_cylinders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
