/* SPDX-License-Identifier: MIT
 *
 * Edges and apexes of superquadrics that straight lines join: the body is their hull, so that the farthest of their
 * places is the support's; each place is on the surface and is the farthest of its own curve; its rate is the
 * difference quotient; two places at one height make a line that lies on the surface.
 */
#include "shape/ridge.h"
#include <impact/face.h>
#include "kit/contact_random.h"
#include "kit/near.h"

enum { SHAPES = 300, DIRECTIONS = 40 };

/* Of all three classes; the third exponent in (1, 60). */
static impact_shape ridged_shape(random_stream *random)
{
    const double a = random_log(random, 0.1, 10), b = random_log(random, 0.1, 10), c = random_log(random, 0.1, 10),
                 t = 1 + random_log(random, 1e-3, 59);
    impact_shape shape;
    switch (random_bits(random) % 5) {
    case 0: impact_shape_superquadric(a, b, c, t, 1, 1, &shape); break;
    case 1: impact_shape_superquadric(a, b, c, 1, t, 1, &shape); break;
    case 2: impact_shape_superquadric(a, b, c, 1, 1, t, &shape); break;
    case 3: impact_shape_superellipsoid(a, b, c, 2 / t, 2, &shape); break;
    default: impact_shape_superellipsoid(a, b, c, 2, 2 / t, &shape);
    }
    return shape;
}

/* The left-hand side of the body's inequality, from its definition. */
static double inside(const impact_shape *s, qvec3 x)
{
    const double u = fabs(x.x / s->a), v = fabs(x.y / s->b), w = fabs(x.z / s->c);
    if (s->kind == IMPACT_SUPERQUADRIC) return pow(u, s->r) + pow(v, s->s) + pow(w, s->t);
    return pow(pow(u, s->r) + pow(v, s->r), s->t / s->r) + pow(w, s->t);
}

static imp_form form_of(const impact_shape *shape)
{
    imp_form form;
    imp_form_make(shape, 1, quat_identity(), &form);
    return form;
}

static void their_hull_is_the_body(void **state)
{
    (void)state;
    random_stream random = {71};
    for (int k = 0; k < SHAPES; k++) {
        const impact_shape shape = ridged_shape(&random);
        const imp_form form = form_of(&shape);
        const int count = imp_ridge_count(&shape);
        assert_true(count == 6 || count == 4 || count == 3);
        for (int i = 0; i < DIRECTIONS; i++) {
            const qvec3 d = random_direction(&random);
            const double h = impact_shape_support(&shape, d, NULL), size = impact_shape_bounding_radius(&shape);
            double farthest = -INFINITY, facing = -INFINITY;
            int feature[2];
            for (int f = 0; f < count; f++) {
                const qvec3 x = imp_ridge_place(&form, f, d, IMP_RIDGE_END);
                farthest = fmax(farthest, qvec3_dot(d, x));
                assert_near(inside(&shape, x), 1, 1e-12);
                /* the place for another direction is of the same curve, and no farther */
                const qvec3 y = imp_ridge_place(&form, f, random_direction(&random), IMP_RIDGE_END);
                assert_at_most(qvec3_dot(d, y), qvec3_dot(d, x) + 1e-14 * size);
            }
            imp_ridge_facing(&form, d, feature);
            for (int f = 0; f < 2; f++)
                facing = fmax(facing, qvec3_dot(d, imp_ridge_place(&form, feature[f], d, IMP_RIDGE_END)));
            assert_near(farthest, h, 1e-14 * size);
            assert_near(facing, h, 1e-14 * size);
        }
    }
}

/* Of the place along a turning direction; where it comes to an apex within the difference, or runs without bound at an
 * axis (exponent over 2), there is none. */
static void rates_are_differences(void **state)
{
    (void)state;
    random_stream random = {72};
    int compared = 0;
    for (int k = 0; k < SHAPES; k++) {
        const impact_shape shape = ridged_shape(&random);
        const imp_form form = form_of(&shape);
        const double size = impact_shape_bounding_radius(&shape);
        for (int i = 0; i < DIRECTIONS; i++) {
            const qvec3 d = random_direction(&random), turn = random_direction(&random), d_rate = qvec3_cross(turn, d);
            const int f = (int)(random_bits(&random) % (unsigned)imp_ridge_count(&shape));
            qvec3 slope[2];
            for (int n = 0; n < 2; n++) {
                const double h = n == 0 ? 1e-5 : 5e-6;
                const qvec3 ahead = imp_ridge_place(&form, f, qvec3_axpy(h, d_rate, d), IMP_RIDGE_END),
                            behind = imp_ridge_place(&form, f, qvec3_axpy(-h, d_rate, d), IMP_RIDGE_END);
                slope[n] = qvec3_scale(qvec3_sub(ahead, behind), 0.5 / h);
            }
            const qvec3 best = qvec3_axpy(1.0 / 3, qvec3_sub(slope[1], slope[0]), slope[1]); /* Richardson */
            if (qvec3_norm(qvec3_sub(slope[1], slope[0])) > 1e-6 * size) continue;
            assert_near3(imp_ridge_rate(&form, f, d, d_rate, IMP_RIDGE_END), best,
                         1e-8 * size + 1e-6 * qvec3_norm(best));
            compared += qvec3_norm(best) > 1e-3 * size;
        }
    }
    assert_true(compared > 1000);
}

/* Where an edge has come to its apex both say the same: what is ahead as d turns on, by the room it has there. */
static void what_is_ahead(void **state)
{
    (void)state;
    random_stream random = {74};
    int edges = 0, apexes = 0;
    for (int k = 0; k < SHAPES; k++) {
        const impact_shape shape = ridged_shape(&random);
        const imp_form form = form_of(&shape);
        if (imp_ridge_count(&shape) != 6) continue;
        const double p[3] = {shape.r, shape.s, shape.t}, axis[3] = {shape.a, shape.b, shape.c};
        const int z = p[0] > 1 ? 0 : p[1] > 1 ? 1 : 2, x = (z + 1) % 3, y = (z + 2) % 3;
        for (int i = 0; i < DIRECTIONS; i++) {
            double c[3] = {random_unit(&random) - 0.5, random_unit(&random) - 0.5, random_unit(&random) - 0.5};
            const double most = fmax(axis[x] * fabs(c[x]), axis[y] * fabs(c[y]));
            c[z] = copysign(p[z] * most / axis[z], c[z]);
            const qvec3 d = {c[0], c[1], c[2]}, d_rate = qvec3_cross(random_direction(&random), d),
                        next = qvec3_axpy(1e-7, d_rate, d);
            const int arc = axis[x] * fabs(c[x]) == most ? c[x] > 0 : 2 + (c[y] > 0), apex = 4 + (c[z] > 0);
            const double room = imp_ridge_room(&form, arc, next);
            if (fabs(room) < 1e-10 * axis[z]) continue;
            const int ahead = room > 0 ? arc : apex;
            assert_int_equal(imp_ridge_ahead(&form, arc, d, d_rate, 1e-14 * axis[z]), ahead);
            assert_int_equal(imp_ridge_ahead(&form, apex, d, d_rate, 1e-14 * axis[z]), ahead);
            /* with more room than that nothing gives way */
            const int stands = room > 0 ? arc : apex;
            assert_int_equal(imp_ridge_ahead(&form, stands, next, qvec3_neg(d_rate), 1e-14 * axis[z]), stands);
            edges += room > 0, apexes += room < 0;
        }
    }
    assert_true(edges > 1000 && apexes > 1000);
}

/* At the axes themselves: finite, and nothing where an arc looks away. */
static void rates_at_the_axes(void **state)
{
    (void)state;
    impact_shape shape;
    const double exponents[] = {1.0001, 1.5, 2, 2.5, 2.999};
    for (int i = 0; i < 5; i++)
        for (int kind = 0; kind < 3; kind++) {
            if (kind == 0) impact_shape_superquadric(1, 2, 3, 1, 1, exponents[i], &shape);
            if (kind == 1) impact_shape_superellipsoid(1, 2, 3, 2 / exponents[i], 2, &shape);
            if (kind == 2) impact_shape_superellipsoid(1, 2, 3, 2, 2 / exponents[i], &shape);
            const imp_form form = form_of(&shape);
            for (int axis = 0; axis < 6; axis++)
                for (int f = 0; f < imp_ridge_count(&shape); f++) {
                    const double side = axis % 2 ? 1 : -1;
                    const qvec3 d = {axis / 2 == 0 ? side : 0, axis / 2 == 1 ? side : 0, axis / 2 == 2 ? side : 0};
                    const qvec3 rate =
                                    imp_ridge_rate(&form, f, d, qvec3_cross((qvec3){0.3, 0.5, 0.7}, d), IMP_RIDGE_END),
                                x = imp_ridge_place(&form, f, d, IMP_RIDGE_END);
                    assert_true(isfinite(rate.x + rate.y + rate.z));
                    assert_near(inside(&shape, x), 1, 1e-14);
                    if (kind < 2 && axis == 0 && f == 1) assert_near3(rate, (qvec3){0, 0, 0}, 1e-300);
                }
        }
    /* a circle's place turns with the direction, on its axes as beside them */
    impact_shape_superellipsoid(2, 2, 1, 2, 1, &shape);
    const imp_form form = form_of(&shape);
    const qvec3 turn = {0, 0, 1}, along[] = {{1, 0, 0}, {0, -1, 0}, {0.6, 0.8, 0}};
    for (int i = 0; i < 3; i++)
        assert_near3(imp_ridge_rate(&form, 0, along[i], qvec3_cross(turn, along[i]), IMP_RIDGE_END),
                     qvec3_scale(qvec3_cross(turn, along[i]), 2), 1e-14);
}

/* The height of the second of two features over the first, along d. */
static double ahead_of(const imp_form *form, const int feature[2], qvec3 d)
{
    return qvec3_dot(d, qvec3_sub(imp_ridge_place(form, feature[1], d, IMP_RIDGE_END),
                                  imp_ridge_place(form, feature[0], d, IMP_RIDGE_END)));
}

/* Between two directions the one that sees a line, by bisection; false where these two features make none. */
static bool find_line(const imp_form *form, qvec3 from, qvec3 to, const int feature[2], qvec3 *d)
{
    double low = 0, high = 1;
    if (ahead_of(form, feature, from) * ahead_of(form, feature, to) >= 0) return false;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        *d = qvec3_axpy(middle, qvec3_sub(to, from), from);
        *((ahead_of(form, feature, *d) > 0) == (ahead_of(form, feature, from) > 0) ? &low : &high) = middle;
    }
    *d = qvec3_scale(*d, 1 / qvec3_norm(*d));
    return true;
}

static void lines_lie_on_the_surface(void **state)
{
    (void)state;
    random_stream random = {73};
    int lines = 0;
    for (int k = 0; k < SHAPES * DIRECTIONS; k++) {
        const impact_shape shape = ridged_shape(&random);
        const imp_form form = form_of(&shape);
        const double size = impact_shape_bounding_radius(&shape);
        const qvec3 from = random_direction(&random), to = random_direction(&random);
        int feature[2], other[2];
        qvec3 d;
        imp_ridge_facing(&form, from, feature), imp_ridge_facing(&form, to, other);
        if (feature[0] != other[0] || feature[1] != other[1] || !find_line(&form, from, to, feature, &d)) continue;
        imp_ridge_facing(&form, d, other);
        impact_face face;
        if (other[0] != feature[0] || other[1] != feature[1]) continue; /* it leads by the apex */
        assert_int_equal(impact_shape_face(&shape, d, 1e-12 * size, &face), 1);
        assert_int_equal(face.count, 2);
        assert_true(face.corner[0].index == feature[0] && face.corner[1].index == feature[1]);
        const qvec3 along = qvec3_sub(face.point[1], face.point[0]);
        for (int i = 0; i <= 4; i++) assert_near(inside(&shape, qvec3_axpy(0.25 * i, along, face.point[0])), 1, 1e-10);
        lines++;
    }
    assert_true(lines > 100);
}

static void which_have_them(void **state)
{
    (void)state;
    impact_shape s;
    const double none[][3] = {{1, 1, 1}, {2, 2, 2}, {1, 1.5, 2}, {1.5, 1.5, 1.5}};
    for (int i = 0; i < 4; i++) {
        impact_shape_superquadric(1, 2, 3, none[i][0], none[i][1], none[i][2], &s);
        assert_int_equal(imp_ridge_count(&s), 0);
    }
    impact_shape_superquadric(1, 2, 3, 1, 1.2, 1, &s);
    assert_int_equal(imp_ridge_count(&s), 6);
    impact_shape_superquadric(1, 2, 3, 1, 1, 40, &s);
    assert_int_equal(imp_ridge_count(&s), 6);
    impact_shape_superellipsoid(1, 2, 3, 1, 2, &s);
    assert_int_equal(imp_ridge_count(&s), 4);
    impact_shape_superellipsoid(1, 2, 3, 2, 1, &s);
    assert_int_equal(imp_ridge_count(&s), 3);
    impact_shape_superellipsoid(1, 2, 3, 2, 2, &s);
    assert_int_equal(imp_ridge_count(&s), 0);
    impact_shape_box(1, 2, 3, 0, &s);
    assert_int_equal(imp_ridge_count(&s), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(their_hull_is_the_body),
        cmocka_unit_test(rates_are_differences),
        cmocka_unit_test(what_is_ahead),
        cmocka_unit_test(rates_at_the_axes),
        cmocka_unit_test(lines_lie_on_the_surface),
        cmocka_unit_test(which_have_them),
    };
    return cmocka_run_group_tests_name("impact.ridge", tests, NULL, NULL);
}
