/* SPDX-License-Identifier: MIT
 *
 * The nearest way out of a polytope for a cylinder or cone, by features, against the halving of the whole sphere of
 * normals, which knows nothing of them; in random poses and in those where features line up.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include "base/tolerances.h"
#include "gap/gap_chart.h"
#include "gap/gap_solver.h"
#include "gap/gap_walk.h"
#include "kit/mixed_pairs.h"
#include "kit/near.h"

typedef struct arcs_pair {
    impact_solid body[2];
    impact_hull *hull;
    imp_gap_solids pair;
} arcs_pair;

/* A turn by quarters, thirds and eighths, or by almost that, or any. */
static quat some_turn(random_stream *random)
{
    quat q = quat_identity();
    if (random_unit(random) < 0.4) return random_rotation(random);
    for (int k = 0; k < 3; k++) {
        const int parts[] = {4, 6, 8};
        const double angle = 2 * M_PI / parts[(int)(3 * random_unit(random))] * (int)(8 * random_unit(random));
        const qvec3 axis = {k == 0, k == 1, k == 2};
        quat turn;
        quat_from_axis_angle(axis, angle + (random_unit(random) < 0.2 ? random_log(random, 1e-15, 1e-3) : 0), &turn);
        q = quat_mul(turn, q);
    }
    return q;
}

static double draw_size(random_stream *random) { return random_unit(random) < 0.4 ? 0.5 : random_log(random, 0.2, 1); }

static impact_shape some_polytope(random_stream *random, impact_hull **hull)
{
    impact_shape shape;
    const double kind = random_unit(random), a = draw_size(random), b = draw_size(random), c = draw_size(random);
    *hull = NULL;
    if (kind < 0.4)
        assert_int_equal(impact_shape_box(a, b, c, 0, &shape), IMPACT_OK);
    else if (kind < 0.55)
        assert_int_equal(impact_shape_capsule(a, c, &shape), IMPACT_OK);
    else
        shape = random_solid_shape(random, RANDOM_POLYHEDRON, hull);
    return shape;
}

/* Centres that coincide, that differ along an axis or a diagonal, or by anything; until they overlap. */
static arcs_pair some_pair(random_stream *random)
{
    arcs_pair p;
    p.body[0] = (impact_solid){.shape = some_polytope(random, &p.hull), .orientation = some_turn(random)};
    p.body[1] = (impact_solid){.orientation = some_turn(random)};
    const double a = draw_size(random), c = draw_size(random);
    if (random_unit(random) < 0.5)
        assert_int_equal(impact_shape_cylinder(a, c, 0, &p.body[1].shape), IMPACT_OK);
    else
        assert_int_equal(impact_shape_cone(a, c, 0, &p.body[1].shape), IMPACT_OK);
    const double kind = random_unit(random), way = random_unit(random) < 0.5 ? 0.5 : random_unit(random);
    const qvec3 any = random_vector(random, 0.1, 1.5);
    p.body[0].position = kind < 0.15   ? (qvec3){0, 0, 0}
                         : kind < 0.35 ? (qvec3){0, 0, way}
                         : kind < 0.5  ? (qvec3){way, way, 0}
                                       : any;
    if (random_unit(random) < 0.5) {
        const impact_solid first = p.body[0];
        p.body[0] = p.body[1], p.body[1] = first;
    }
    const double scale = imp_gap_scale(&p.body[0], &p.body[1]);
    imp_gap_pair(&p.body[0], p.body[0].orientation, &p.body[1], p.body[1].orientation, scale, &p.pair);
    return p;
}

/* Above what the halving of the sphere leaves; where it ends. */
static imp_proof halved(const imp_gap_solids *pair, double slack, double *gap)
{
    double n[3] = {0, 0, 1}, x[2][3], v[3];
    imp_gap_peaks peaks = {0};
    *gap = imp_pair_gap(pair, n, x);
    for (int i = 0; i < 3; i++) v[i] = pair->c[i] + x[1][i] - x[0][i];
    imp_gap_peak_add(v, &peaks);
    return imp_gap_prove(pair, &peaks, slack, true, gap, n);
}

static void as_the_whole_sphere_has_it(void **state)
{
    (void)state;
    random_stream random = {11};
    int compared = 0;
    for (int i = 0; i < 6000; i++) {
        arcs_pair p = some_pair(&random);
        assert_true(imp_gap_has_arcs(&p.pair));
        const double coarse = 1e-4 * p.pair.reach, fine = IMP_GAP_SLACK * p.pair.reach;
        double whole;
        const imp_proof proof = halved(&p.pair, coarse, &whole);
        if (proof == IMP_PROOF_NEAREST && whole < -2 * coarse) {
            imp_way_out out;
            assert_true(imp_gap_highest_by_arcs(&p.pair, fine, -INFINITY, &out));
            if (!out.all || !(out.gap <= whole + coarse) || !(out.gap >= whole - fine))
                fail_msg("%d: all %d, %.17g by features, %.17g by halving", i, out.all, out.gap, whole);
            assert_near(imp_pair_gap(&p.pair, out.n, NULL), out.gap, 4e-15 * p.pair.reach);
            assert_near(imp_norm(out.n), 1, 4e-15);
            compared++;
        }
        impact_hull_destroy(p.hull);
    }
    assert_in_range(compared, 2500, 6000);
}

/* What is asked for above the highest is proved not to be there; just below it is found. */
static void asked_from_above_and_below(void **state)
{
    (void)state;
    random_stream random = {12};
    for (int i = 0; i < 3000; i++) {
        arcs_pair p = some_pair(&random);
        const double fine = IMP_GAP_SLACK * p.pair.reach;
        imp_way_out out, asked;
        assert_true(imp_gap_highest_by_arcs(&p.pair, fine, -INFINITY, &out));
        if (out.all) {
            assert_false(imp_gap_highest_by_arcs(&p.pair, fine, out.gap, &asked));
            assert_true(asked.all);
            assert_true(imp_gap_highest_by_arcs(&p.pair, fine, out.gap - 1e-9 * p.pair.reach, &asked));
            assert_true(asked.all);
            assert_near(asked.gap, out.gap, 2 * fine);
        }
        impact_hull_destroy(p.hull);
    }
}

/* Every overlap has its answer, with its points, and no normal of many has a larger g. */
static void every_overlap_is_answered(void **state)
{
    (void)state;
    random_stream random = {13};
    int flagged = 0, overlaps = 0;
    for (int i = 0; i < 6000; i++) {
        arcs_pair p = some_pair(&random);
        impact_contact contact;
        const impact_status status = impact_gap(&p.body[0], &p.body[1], NULL, &contact);
        if (contact.gap < 0) {
            overlaps++;
            flagged += status != IMPACT_OK;
            const double rounding = p.body[0].shape.rounding + p.body[1].shape.rounding;
            const double scale = imp_gap_scale(&p.body[0], &p.body[1]), core = (contact.gap + rounding) * scale;
            for (int k = 0; k < 400 && status == IMPACT_OK && core < 0; k++) {
                const qvec3 m = random_direction(&random);
                assert_true(imp_pair_gap(&p.pair, (double[3]){m.x, m.y, m.z}, NULL) <= core + 2e-14 * p.pair.reach);
            }
            if (status == IMPACT_OK) assert_true(impact_gap_receipt(&p.body[0], &p.body[1], &contact, NULL) <= 20);
        }
        impact_hull_destroy(p.hull);
    }
    assert_in_range(overlaps, 3000, 6000);
    assert_true(flagged <= overlaps / 1000);
}

/* g is the same all around, or all along an arc: an edge along the axis. */
static void an_edge_along_the_axis(void **state)
{
    (void)state;
    random_stream random = {14};
    for (int i = 0; i < 200; i++) {
        const quat turn = random_rotation(&random);
        const double radius = random_log(&random, 0.1, 0.5);
        impact_solid body[2] = {{.orientation = turn}, {.orientation = turn}};
        impact_contact contact;
        assert_int_equal(impact_shape_cylinder(radius, 1, 0, &body[0].shape), IMPACT_OK);
        if (i % 2)
            assert_int_equal(impact_shape_capsule(0.1, 3, &body[1].shape), IMPACT_OK);
        else
            assert_int_equal(impact_shape_box(1, 1.5, 4, 0, &body[1].shape), IMPACT_OK);
        if (i % 2 == 0) body[1].position = quat_rotate(turn, (qvec3){1, 1.5, 0});
        assert_int_equal(impact_gap(&body[0], &body[1], NULL, &contact), IMPACT_OK);
        assert_near(contact.gap, -radius - (i % 2 ? 0.1 : 0), 1e-14);
    }
}

/* A vertex on a cone's axis, near the apex: as near a way out all around, the radii at which add up to the depth. */
static void a_vertex_on_a_cone_s_axis(void **state)
{
    (void)state;
    random_stream random = {15};
    for (int i = 0; i < 400; i++) {
        impact_solid body[2] = {{.orientation = quat_identity()}, {.orientation = random_rotation(&random)}};
        const double radius = random_log(&random, 0.3, 1), height = random_log(&random, 0.1, 1),
                     deep = random_log(&random, 1e-4, 0.05);
        impact_contact contact;
        assert_int_equal(impact_shape_box(0.5, 0.6, 0.7, 0, &body[0].shape), IMPACT_OK);
        assert_int_equal(impact_shape_cone(radius, height, 0, &body[1].shape), IMPACT_OK);
        /* the vertex that all of a box lies beyond, from the apex inwards */
        const qvec3 out = quat_rotate(body[1].orientation, (qvec3){0, 0, 1});
        const qvec3 vertex = {copysign(0.5, -out.x), copysign(0.6, -out.y), copysign(0.7, -out.z)};
        const qvec3 apex = quat_rotate(body[1].orientation, (qvec3){0, 0, 0.75 * height - deep});
        body[0].position = qvec3_sub(apex, vertex);
        const impact_status status = impact_gap(&body[0], &body[1], NULL, &contact);
        assert_int_equal(status, IMPACT_OK);
        assert_true(impact_gap_receipt(&body[0], &body[1], &contact, NULL) <= 20);
    }
}

/* Rounded ones too, whose cores may but touch; a nanometre deep at a vertex or apex, too, whose features only tell
 * where. */
static void mixed_pairs_are_answered(void **state)
{
    (void)state;
    random_stream random = {16};
    int flagged = 0;
    for (int i = 0; i < 2000; i++) {
        mixed_pair pair =
            random_mixed_pair(&random, i % 2 ? MIXED_CYLINDER_BOX : MIXED_CONE_HULL, -random_log(&random, 1e-9, 0.3));
        impact_contact contact;
        flagged += impact_gap(&pair.body[0], &pair.body[1], NULL, &contact) != IMPACT_OK;
        assert_true(contact.gap >= pair.gap - 1e-14 * pair.reach);
        end_mixed_pair(&pair);
    }
    assert_in_range(flagged, 0, 2);
}

/* Where a walk begins within a segment, with a normal that is an end's. */
static void a_normal_along_a_segment(void **state)
{
    (void)state;
    impact_shape capsule;
    imp_form form;
    imp_surface s;
    assert_int_equal(impact_shape_capsule(0.1, 1, &capsule), IMPACT_OK);
    imp_form_make(&capsule, 1, quat_identity(), &form);
    imp_walk_start(&form, (double[3]){0, 0, 1}, (double[3]){0, 0, 0.3}, &s);
    assert_int_equal(s.kind, IMP_ON_VERTEX);
    assert_near(s.e[2], 1, 0);
    imp_walk_start(&form, (double[3]){1, 0, 1e-9}, (double[3]){0, 0, 0.3}, &s);
    assert_int_equal(s.kind, IMP_ON_EDGE);
    assert_near(s.e[2], 0, 0);
    assert_near(s.u[2], 0.3, 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_the_whole_sphere_has_it), cmocka_unit_test(asked_from_above_and_below),
        cmocka_unit_test(every_overlap_is_answered),  cmocka_unit_test(mixed_pairs_are_answered),
        cmocka_unit_test(a_normal_along_a_segment),   cmocka_unit_test(an_edge_along_the_axis),
        cmocka_unit_test(a_vertex_on_a_cone_s_axis)};
    return cmocka_run_group_tests_name("impact.gap_arcs", tests, NULL, NULL);
}
