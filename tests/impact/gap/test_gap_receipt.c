/* SPDX-License-Identifier: MIT
 *
 * Receipts: every answer with status ok passes, over random pairs of all families; and answers spoilt in any one number
 * fail.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <impact/gap.h>
#include "gap/gap_solver.h"
#include "kit/contact_random.h"
#include "kit/figures.h"
#include "kit/near.h"

static const double limit = 20;

/* Apart, touching or overlapping by some of the thinner axis, at any scale; one of thirty is a plane. */
static void random_solids(random_stream *random, int k, impact_solid body[2])
{
    const double scale = ldexp(1, (int)(random_bits(random) % 200) - 100);
    qvec3 x[2];
    const qvec3 normal = random_direction(random);
    for (int i = 0; i < 2; i++) {
        body[i] = (impact_solid){.shape = random_shape(random, (int)(random_bits(random) % RANDOM_FAMILIES))};
        body[i].orientation = random_rotation(random);
        x[i] = contact_support(&body[i], i ? normal : qvec3_neg(normal));
        body[i].shape.a *= scale, body[i].shape.b *= scale, body[i].shape.c *= scale;
    }
    const double thin = fmin(body[0].shape.a, fmin(body[0].shape.b, body[0].shape.c));
    const double gap = k % 3 == 0   ? scale * random_log(random, 1e-9, 100)
                       : k % 3 == 1 ? 0
                                    : -thin * random_log(random, 1e-9, 1);
    body[0].position = qvec3_axpy(gap, normal, qvec3_scale(qvec3_sub(x[1], x[0]), scale));
    if (k % 30 == 7) impact_shape_plane(INFINITY, INFINITY, &body[1].shape);
}

/* With an exponent of 1 + 1e-13 the point follows the normal by 2e-3 of rounding, and leaves its body: what is said is
 * a bracket that holds. */
static void a_point_that_leaves_its_body(void **state)
{
    (void)state;
    const impact_solid one = {
        .shape = {IMPACT_SPHERE, 1, 1, 1, 2, 2, 2},
        .position = {-0.025118864315095794, 0.4685201574755089, 5.3129216907122414},
        .orientation = {-0.85749292571254321, 4.902576684311408e-09, -0.51449575542752801, 5.3058470622339199e-09}};
    impact_solid two = {
        .shape = {IMPACT_SUPERQUADRIC, 1, 0.14630573442793054, 1, 1.0000000000001306, 2, 2.0977507858516189},
        .position = {-1, 0, -4.7546795773833423},
        .orientation = {0, -3.392663629998558e-16, -0.763959932992747, 0.64526368314179716}};
    impact_contact c, near;
    assert_int_equal(impact_gap(&one, &two, NULL, &c), IMPACT_BRACKET);
    two.shape.r = 1.0001;
    assert_int_equal(impact_gap(&one, &two, NULL, &near), IMPACT_OK);
    assert_true(c.lower <= near.gap + 1e-4 && near.gap - 1e-4 <= c.upper);
}

static void right_answers_pass(void **state)
{
    (void)state;
    random_stream random = {51};
    double worst = 0, width = 0;
    int checked = 0, path[IMPACT_PATH_FALLBACK + 1] = {0}, deep = 0;
    for (int k = 0; k < 20000; k++) {
        impact_solid body[2];
        random_solids(&random, k, body);
        impact_contact c;
        impact_gap_residuals r;
        const impact_status status = impact_gap(&body[0], &body[1], NULL, &c);
        assert_true(status >= 0);
        if (status == IMPACT_BRACKET) continue;
        const double got = impact_gap_receipt(&body[0], &body[1], &c, &r);
        if (!(got <= limit))
            fail_msg("%d: status %d, normal %g dual %g primal %g order %g inside %g %g; exponents %g %g %g, %g %g %g",
                     k, status, r.normal, r.dual, r.primal, r.order, r.inside1, r.inside2, body[0].shape.r,
                     body[0].shape.s, body[0].shape.t, body[1].shape.r, body[1].shape.s, body[1].shape.t);
        worst = fmax(worst, got);
        checked++;
        path[c.path]++;
        deep += status == IMPACT_DEEP;
        if (status == IMPACT_OK && c.path == IMPACT_PATH_NEWTON)
            width += (c.upper - c.lower) / (contact_size(&body[0].shape) + contact_size(&body[1].shape) + fabs(c.gap));
    }
    width /= path[IMPACT_PATH_NEWTON];
    show_bounded("residual of the receipt", worst, limit);
    show_figure("by Newton", path[IMPACT_PATH_NEWTON]);
    show_figure("by a seed of libccd", path[IMPACT_PATH_GJK]);
    show_figure("by the fallback", path[IMPACT_PATH_FALLBACK]);
    show_figure("deep", deep);
    show_figure("mean width", width);
    assert_true(checked > 19000);
    /* most by the first way that is tried, and to the last digit: today 771, 304, 2 and 7.2e-17 */
    const int seeds = impact_has(IMPACT_PART_CCD) ? 800 : 0; /* without libccd the fallback has these, too */
    assert_true(path[IMPACT_PATH_GJK] <= seeds && path[IMPACT_PATH_FALLBACK] <= 1120 - seeds && deep <= 4);
    assert_at_most(width, 8e-17);
}

/* Each number moved by 1e-9 of the size. */
static void spoilt_answers_fail(void **state)
{
    (void)state;
    random_stream random = {52};
    for (int k = 0; k < 2000; k++) {
        impact_solid body[2];
        random_solids(&random, 3 * k, body);
        if (body[1].shape.kind == IMPACT_PLANE) continue;
        impact_contact c;
        if (impact_gap(&body[0], &body[1], NULL, &c) != IMPACT_OK) continue;
        const double much = 1e-9 * (fmax(contact_size(&body[0].shape), contact_size(&body[1].shape)) +
                                    qvec3_norm(qvec3_sub(body[0].position, body[1].position)));
        impact_contact spoilt[8] = {c, c, c, c, c, c, c, c};
        spoilt[0].gap += much;
        spoilt[1].lower -= much;
        spoilt[2].upper -= much;
        spoilt[3].offset1 = qvec3_axpy(-much, c.normal, c.offset1); /* out of its body */
        spoilt[4].offset2 = qvec3_axpy(much, c.normal, c.offset2);
        spoilt[5].normal = qvec3_scale(c.normal, 1 + 1e-9);
        spoilt[6].offset1.x = NAN;
        spoilt[7].gap = NAN;
        for (int i = 0; i < 8; i++)
            if (!(impact_gap_receipt(&body[0], &body[1], &spoilt[i], NULL) > 1e4))
                fail_msg("%d passes, spoilt %d", k, i);
    }
}

/* Whether a point is in the body but for a slack, asked at less cost, is what its distance says: points on the surface,
 * moved in and out along the normal by parts of the slack and much more. */
static void held_is_by_the_distance(void **state)
{
    (void)state;
    random_stream random = {19};
    int held = 0, out = 0;
    for (int k = 0; k < 20000; k++) {
        const impact_shape shape = random_shape(&random, (int)(random_bits(&random) % RANDOM_FAMILIES));
        const quat q = random_rotation(&random);
        const qvec3 d = random_direction(&random);
        imp_form form;
        qvec3 x;
        imp_form_make(&shape, 1, q, &form);
        impact_shape_support(&shape, quat_rotate_inverse(q, d), &x);
        const double slack = random_log(&random, 1e-13, 1e-2) * contact_size(&shape),
                     most = random_log(&random, 0.1, 10);
        const qvec3 at = qvec3_axpy((2 * random_unit(&random) - 1) * most * slack, d, quat_rotate(q, x));
        const double place[3] = {at.x, at.y, at.z}, outside = imp_gap_outside(&form, place);
        if (fabs(outside - slack) < 1e-15 * contact_size(&shape)) continue; /* on the border: either */
        assert_int_equal(imp_gap_holds(&form, place, slack), outside <= slack);
        *(outside <= slack ? &held : &out) += 1;
    }
    assert_true(held > 5000 && out > 1000);
    imp_form form;
    const impact_shape egg = random_shape(&random, RANDOM_MIXED);
    imp_form_make(&egg, 1, quat_identity(), &form);
    assert_false(imp_gap_holds(&form, (double[]){NAN, 0, 0}, 1));
}

/* (f - 1)/|grad f| of sum |x_i|^p_i and of (|x|^p + |y|^p)^(t/p) + |z|^t, by libm's powers. */
static double outside_by_libm(const impact_shape *s, const double x[3])
{
    const double p[3] = {s->r, s->s, s->t};
    double f = 0, square = 0;
    const bool nested = s->kind == IMPACT_SUPERELLIPSOID;
    const double section = nested ? pow(x[0], p[0]) + pow(x[1], p[0]) : 1;
    if (!(fmin(section, fmin(x[0], fmin(x[1], x[2]))) > 1e-250)) return NAN; /* its powers have no digits left */
    for (int i = 0; i < 3; i++) {
        const bool within = nested && i < 2;
        const double slope =
            within ? p[2] * pow(section, p[2] / p[0] - 1) * pow(x[i], p[0] - 1) : p[i] * pow(x[i], p[i] - 1);
        f += within ? (i == 0 ? pow(section, p[2] / p[0]) : 0) : pow(x[i], p[i]);
        square += slope * slope;
    }
    return (f - 1) / sqrt(square);
}

/* Near the surface and as far from it as half and double, of exponents 1 to 1000, by other powers than the receipt's.
 */
static void outside_is_by_the_inequality(void **state)
{
    (void)state;
    random_stream random = {6};
    double worst = 0;
    int asked = 0;
    for (int k = 0; k < 40000; k++) {
        impact_shape shape;
        const double most = k % 4 ? 10 : 1000, t = random_log(&random, 1, most);
        if (k % 2)
            impact_shape_superellipsoid(1, 1, 1, 2 / t, 2 / random_log(&random, 1, most), &shape);
        else
            impact_shape_superquadric(1, 1, 1, t, random_log(&random, 1, most), random_log(&random, 1, most), &shape);
        const qvec3 d = random_direction(&random);
        qvec3 x;
        imp_form form;
        imp_form_make(&shape, 1, quat_identity(), &form);
        impact_shape_support(&shape, (qvec3){fabs(d.x), fabs(d.y), fabs(d.z)}, &x);
        const double part = k % 3 ? 1 + 1e-3 * (random_unit(&random) - 0.5) : random_log(&random, 0.5, 2);
        const double place[3] = {part * x.x, part * x.y, part * x.z};
        const double wanted = outside_by_libm(&shape, place), got = imp_gap_outside(&form, place);
        if (!(fabs(wanted) < 10)) continue;
        asked++;
        worst = fmax(worst, fabs(got - wanted) / (1 + most * fabs(wanted)));
    }
    show_figure("outside against libm's powers", worst);
    assert_true(asked > 30000);
    assert_at_most(worst, 1e-15);
    imp_form form;
    impact_shape ball;
    impact_shape_superquadric(1, 1, 1, 3, 3, 3, &ball);
    imp_form_make(&ball, 1, quat_identity(), &form);
    assert_true(imp_gap_outside(&form, (double[]){0, 1, 0}) == 0);
    assert_true(imp_gap_outside(&form, (double[]){5e-324, 1, 0}) == 0);
    for (int p = 2; p <= 3; p++) { /* an ellipsoid's squares overflow */
        impact_shape_superquadric(1, 1, 1, p, p, p, &ball);
        imp_form_make(&ball, 1, quat_identity(), &form);
        assert_true(!imp_gap_holds(&form, (double[]){1e300, 0, 0}, 1));
        assert_true(!imp_gap_holds(&form, (double[]){INFINITY, 0, 0}, 1));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_that_leaves_its_body), cmocka_unit_test(right_answers_pass),
        cmocka_unit_test(spoilt_answers_fail),          cmocka_unit_test(held_is_by_the_distance),
        cmocka_unit_test(outside_is_by_the_inequality),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
