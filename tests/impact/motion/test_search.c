/* SPDX-License-Identifier: MIT
 *
 * The search: the first contact of two segments, against balls' closed form, against damped balls' by the clock in
 * which they move on lines, and of shapes that tumble against a close look at all times before it.
 */
#include "motion/search.h"
#include "motion/motion_equations.h"
#include "world/world_gap.h"
#include "kit/contact_random.h"
#include "kit/near.h"

#include <string.h>

static imp_body make_body(impact_shape shape, double linear_rate, double angular_rate)
{
    const qvec3 unit = impact_shape_inertia(&shape);
    return (imp_body){.shape = shape,
                      .mass = 1,
                      .inverse_mass = 1,
                      .moments = unit,
                      .inverse_moments = {1 / unit.x, 1 / unit.y, 1 / unit.z},
                      .spherical = shape.kind == IMPACT_SPHERE,
                      .radius = impact_shape_bounding_radius(&shape),
                      .turn = {1, 0, 0, 0},
                      .linear_rate = linear_rate,
                      .angular_rate = angular_rate};
}

static imp_body make_ball(double radius, double rate)
{
    impact_shape shape;
    impact_shape_sphere(radius, &shape);
    return make_body(shape, rate, 0);
}

typedef struct couple {
    imp_body body[2];
    imp_segment segment[2];
    impact_tumble tumble[2];
    impact_usage usage;
} couple;

static imp_search search_of(couple *c)
{
    return (imp_search){.body = {&c->body[0], &c->body[1]},
                        .segment = {&c->segment[0], &c->segment[1]},
                        .still = 1e-11,
                        .usage = &c->usage};
}

static void begin(couple *c, int k, double t0, qvec3 x, qvec3 v, qvec3 omega, qvec3 g)
{
    imp_state state = {.x = x, .q = {1, 0, 0, 0}, .v = v};
    state.momentum = imp_inertia(&c->body[k], state.q, omega);
    c->segment[k] = imp_segment_fly(&c->body[k], t0, &state, g, &c->tumble[k]);
}

/* Where |d + w T| = R in long double, or infinity. */
static double line_time(qvec3 d, qvec3 w, double R)
{
    const long double a = (long double)w.x * w.x + (long double)w.y * w.y + (long double)w.z * w.z,
                      b = (long double)d.x * w.x + (long double)d.y * w.y + (long double)d.z * w.z,
                      e = (long double)d.x * d.x + (long double)d.y * d.y + (long double)d.z * d.z - (long double)R * R,
                      left = b * b - a * e;
    return b < 0 && left >= 0 ? (double)(e / (-b + sqrtl(left))) : INFINITY;
}

/* Begun at different times, falling alike: the second, seen from the first, goes on a line. */
static void balls_meet_on_a_line(void **state)
{
    (void)state;
    random_stream random = {31};
    const qvec3 g = {0, 0, -9.8};
    int met = 0;
    for (int i = 0; i < 20000; i++) {
        couple c = {.body = {make_ball(random_log(&random, 1e-2, 1), 0), make_ball(random_log(&random, 1e-2, 1), 0)}};
        const qvec3 d = random_vector(&random, 2.1, 20), v = random_vector(&random, 0.1, 10), none = {0, 0, 0};
        const qvec3 w = qvec3_axpy(0.1 * qvec3_norm(d), random_direction(&random), qvec3_neg(d));
        const double late = i % 2 ? 0 : 0.25;
        begin(&c, 0, late, d, qvec3_axpy(late, g, qvec3_add(v, w)), none, g);
        begin(&c, 1, 0, qvec3_axpy(-late, qvec3_axpy(0.5 * late, g, v), none), v, none, g);
        const imp_search s = search_of(&c);
        const double R = c.body[0].radius + c.body[1].radius, wanted = late + line_time(d, w, R);
        const imp_found found = imp_search_contact(&s, late, INFINITY);
        const double graze = fabs(R - qvec3_norm(qvec3_cross(d, w)) / qvec3_norm(w));
        if (graze < 1e-6 * R) continue;
        assert_int_equal(found.touches, isfinite(wanted));
        if (!found.touches) continue;
        assert_near(found.t, wanted, 1e-13 * (1 + wanted) * R / graze * 10);
        met++;
        /* named the other way round the bits are the same */
        couple other = {.body = {c.body[1], c.body[0]}, .segment = {c.segment[1], c.segment[0]}};
        const imp_search t = search_of(&other);
        assert_true(imp_search_contact(&t, late, INFINITY).t == found.t);
    }
    assert_true(met > 3000);
}

/* Damped alike and without weight they move on lines in the clock (1 - e^(-kt))/k. */
static void damped_balls_meet(void **state)
{
    (void)state;
    random_stream random = {32};
    int met = 0;
    for (int i = 0; i < 3000; i++) {
        const double k = random_log(&random, 1e-3, 1);
        couple c = {.body = {make_ball(0.3, k), make_ball(0.2, k)}};
        const qvec3 d = random_vector(&random, 1, 5), none = {0, 0, 0};
        const qvec3 w = qvec3_axpy(0.2 * qvec3_norm(d), random_direction(&random), qvec3_scale(d, -1.5));
        begin(&c, 0, 0, d, w, none, none);
        begin(&c, 1, 0, none, none, none, none);
        const imp_search s = search_of(&c);
        const double graze = fabs(0.5 - qvec3_norm(qvec3_cross(d, w)) / qvec3_norm(w));
        const double clock = line_time(d, w, 0.5), wanted = k * clock < 1 ? -log1p(-k * clock) / k : INFINITY;
        if (graze < 1e-4 || fabs(k * clock - 1) < 1e-3) continue;
        imp_found found = imp_search_contact(&s, 0, INFINITY);
        for (int again = 0; again < 100 && !found.touches && isfinite(found.t); again++)
            found = imp_search_contact(&s, found.t, INFINITY);
        assert_int_equal(found.touches, isfinite(wanted));
        if (found.touches) assert_near(found.t, wanted, 1e-10 * (1 + wanted));
        met += found.touches;
    }
    assert_true(met > 1000);
}

/* What tumbles, damped or not, round or with edges: at the time found the gap is zero to rounding, and at none of many
 * before it less. */
static void nothing_is_passed_over(void **state)
{
    (void)state;
    random_stream random = {33};
    int met = 0;
    for (int i = 0; i < 400; i++) {
        couple c = {0};
        for (int k = 0; k < 2; k++) {
            const impact_shape shape =
                i < 300 ? random_smooth_shape(&random, false) : random_shape(&random, RANDOM_BOXY);
            c.body[k] = make_body(shape, i % 2 ? 0.3 : 0, i % 2 ? 0.2 : 0);
        }
        const double reach = c.body[0].radius + c.body[1].radius;
        const qvec3 d = qvec3_scale(random_direction(&random), 3 * reach);
        const qvec3 w =
            qvec3_scale(qvec3_axpy(0.2, random_direction(&random), qvec3_scale(d, -1 / (3 * reach))), reach);
        begin(&c, 0, 0, d, w, random_vector(&random, 1, 20), (qvec3){0, 0, -1});
        begin(&c, 1, 0, (qvec3){0, 0, 0}, (qvec3){0, 0, 0}, random_vector(&random, 1, 20), (qvec3){0, 0, -1});
        const imp_search s = search_of(&c);
        imp_found found = imp_search_contact(&s, 0, 10);
        for (int again = 0; again < 100 && !found.touches && found.t < 10; again++)
            found = imp_search_contact(&s, found.t, 10);
        const double last = fmin(found.t, 5);
        for (int k = 0; k <= 200; k++) {
            const double t = last * k / 200;
            const imp_state a = imp_segment_at(&c.segment[0], &c.body[0], t),
                            b = imp_segment_at(&c.segment[1], &c.body[1], t);
            impact_contact contact;
            imp_gap_of(&c.body[0], &a, &c.body[1], &b, NULL, &c.usage, &contact);
            assert_true(contact.gap > -1e-12 * reach);
            if (k == 200 && found.touches && last == found.t) assert_near(contact.gap, 0, 1e-12 * reach);
        }
        met += found.touches;
    }
    assert_true(met > 100);
}

/* Behind a plane's bounds and thrown back up: at the time found the gap comes back to zero from below, and at none of
 * many before it. What never comes back is never found. */
static void what_is_behind_a_plane_comes_back(void **state)
{
    (void)state;
    random_stream random = {35};
    int back = 0, never = 0;
    for (int i = 0; i < 300; i++) {
        couple c = {0};
        impact_shape plane;
        const bool damped = i % 3 == 1, ball = i % 3 == 2;
        impact_shape_plane(1, 1, &plane);
        c.body[0] = ball ? make_ball(random_log(&random, 0.1, 1), 0)
                         : make_body(random_smooth_shape(&random, false), damped ? 0.3 : 0, damped ? 0.2 : 0);
        c.body[1] = (imp_body){.shape = plane, .is_static = true, .turn = {1, 0, 0, 0}};
        const double reach = c.body[0].radius;
        const qvec3 x = {0, 0, -reach * (1.5 + random_unit(&random))},
                    v = {random_unit(&random), 0, reach * (2 + 6 * random_unit(&random))};
        begin(&c, 0, 0, x, v, random_vector(&random, 1, 20), (qvec3){0, 0, -4 * reach});
        c.segment[1] = imp_segment_rest(0, &(imp_state){.q = {1, 0, 0, 0}});
        imp_search s = search_of(&c);
        s.beyond = true;
        imp_found found = imp_search_contact(&s, 0, 10);
        for (int again = 0; again < 100 && !found.touches && found.t < 10; again++)
            found = imp_search_contact(&s, found.t, 10);
        back += found.touches, never += !found.touches;
        const double last = fmin(found.t, 3);
        for (int k = 0; k <= 200; k++) {
            const double t = last * k / 200;
            const imp_state a = imp_segment_at(&c.segment[0], &c.body[0], t), b = c.segment[1].start;
            impact_contact contact;
            imp_gap_of(&c.body[0], &a, &c.body[1], &b, NULL, &c.usage, &contact);
            assert_true(contact.gap < 1e-12 * reach);
            if (k == 200 && found.touches) assert_near(contact.gap, 0, 1e-9 * reach);
        }
    }
    assert_true(back > 50 && never > 50);
}

/* A step of an integrator, from t0 for 1/2 s, in which a ball's gap over a plane is k s (s - a) (s - b), s = t - t0. */
typedef struct dip {
    imp_dense dense;
    double c[4 * (Y_BODIES + Y_PER_BODY)];
} dip;

static void make_dip(dip *d, double t0, double radius, double k, double a, double b, bool fixed)
{
    enum { SIZE = Y_BODIES + Y_PER_BODY };
    const double h = 0.5, gap[4] = {0, k * a * b, -k * (a + b), k};
    static const double binomial[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
    memset(d, 0, sizeof *d);
    d->dense =
        (imp_dense){.t0 = t0, .t1 = t0 + h, .end = t0 + h, .h = h, .size = SIZE, .terms = 4, .fixed = fixed, .c = d->c};
    d->c[Y_TIME] = t0 + h, d->c[SIZE + Y_TIME] = h;
    d->c[Y_BODIES + 2] = radius;
    d->c[Y_BODIES + 3] = 1;
    for (int i = 0; i < 4; i++) /* of s = h (1 + sigma) */
        for (int j = 0; j <= i; j++) {
            d->c[j * SIZE + Y_BODIES + 2] += gap[i] * pow(h, i) * binomial[i][j];
            if (j > 0) d->c[(j - 1) * SIZE + Y_BODIES + Y_VELOCITY + 2] += j * gap[i] * pow(h, i - 1) * binomial[i][j];
        }
}

/* It leaves the plane and dips below it again, for any part of the step, by more than what is all but closed: of a
 * fixed step, whose length says nothing of the motion, by anything. */
static void what_leaves_and_comes_back_within_a_step_is_found(void **state)
{
    (void)state;
    random_stream random = {36};
    for (int i = 0; i < 200; i++) {
        const bool fixed = i % 2;
        const double t0 = random_log(&random, 1e-2, 1e3),
                     a = fixed ? random_log(&random, 1e-4, 1e-2) : random_log(&random, 2e-3, 1e-1),
                     b = a * (1.5 + random_unit(&random)), radius = random_log(&random, 0.1, 1),
                     k = random_log(&random, 10, 1000);
        dip d;
        couple c = {.body = {make_ball(radius, 0)}};
        make_dip(&d, t0, radius, k, a, b, fixed);
        impact_shape_plane(INFINITY, INFINITY, &c.body[1].shape);
        c.body[1].is_static = true, c.body[1].turn = (quat){1, 0, 0, 0};
        const imp_state ball = {.x = {0, 0, radius}, .q = {1, 0, 0, 0}};
        c.segment[0] = imp_segment_dense(&d.dense, 0, &ball);
        c.segment[1] = imp_segment_rest(0, &(imp_state){.q = {1, 0, 0, 0}});
        const imp_search s = search_of(&c);
        imp_found found = imp_search_contact(&s, t0, INFINITY);
        for (int again = 0; again < 100 && !found.touches && isfinite(found.t); again++)
            found = imp_search_contact(&s, found.t, INFINITY);
        assert_true(found.touches);
        /* as closely as gaps of places of this size tell */
        assert_near(found.t, t0 + a, 1e-12 * radius / (k * a * (b - a)) + 1e-12 * (1 + t0));
    }
}

/* Stopped on the way and taken up again, the answer has the same bits. */
static void pauses_change_no_bits(void **state)
{
    (void)state;
    random_stream random = {34};
    for (int i = 0; i < 200; i++) {
        couple c = {0};
        for (int k = 0; k < 2; k++) c.body[k] = make_body(random_smooth_shape(&random, false), 0, 0);
        const double reach = c.body[0].radius + c.body[1].radius;
        const qvec3 d = qvec3_scale(random_direction(&random), 3 * reach);
        begin(&c, 0, 0, d, qvec3_scale(d, -0.5), random_vector(&random, 1, 20), (qvec3){0, 0, -1});
        begin(&c, 1, 0, (qvec3){0, 0, 0}, (qvec3){0, 0, 0}, random_vector(&random, 1, 20), (qvec3){0, 0, -1});
        const imp_search s = search_of(&c);
        const imp_found whole = imp_search_contact(&s, 0, INFINITY);
        imp_found part = imp_search_contact(&s, 0, 0.1);
        for (int again = 0; again < 10000 && !part.touches && isfinite(part.t); again++)
            part = imp_search_contact(&s, part.t, part.t);
        assert_true(whole.t == part.t && whole.touches == part.touches);
    }
}

/* A slender body that has just left the ground, on a corner whose weight turning has all but come to lift: the search
 * keeps up with it, whatever the rest of the body does. Followed by what any of its points could do, in steps that are
 * parts of the time since, it takes eighty queries. */
static void what_has_left_the_ground_is_let_go(void **state)
{
    (void)state;
    random_stream random = {39};
    for (int i = 0; i < 200; i++) {
        couple c = {0};
        impact_shape_superquadric(random_log(&random, 1e-3, 1e-2), random_log(&random, 1e-3, 1e-2), 0.2, 60, 50, 300,
                                  &c.body[0].shape);
        c.body[0] = make_body(c.body[0].shape, 0, 0);
        impact_shape plane;
        impact_shape_plane(INFINITY, INFINITY, &plane);
        c.body[1] = (imp_body){.shape = plane, .is_static = true, .radius = INFINITY, .turn = {1, 0, 0, 0}};
        const double lean = 0.3 + 0.6 * random_unit(&random), spin = random_log(&random, 1, 100);
        imp_state now = {.q = quat_from_rotation_vector((qvec3){0, lean, 0})}, ground = {.q = {1, 0, 0, 0}};
        qvec3 corner;
        imp_world_support(&c.body[0], quat_rotate_inverse(now.q, (qvec3){0, 0, -1}), &corner);
        const qvec3 arm = quat_rotate(now.q, corner), omega = {0, copysign(spin, arm.x), 0};
        now.x.z = 1e-12 - arm.z;
        now.v = qvec3_cross(arm, omega); /* the corner stands */
        now.momentum = imp_inertia(&c.body[0], now.q, omega);
        const qvec3 g = {0, 0, 0.98 * spin * spin * arm.z};
        c.segment[0] = imp_segment_fly(&c.body[0], 0, &now, g, &c.tumble[0]);
        c.segment[1] = imp_segment_rest(0, &ground);
        imp_search s = search_of(&c);

        const imp_found found = imp_search_contact(&s, 0, 0.1 / spin);
        assert_true(!found.touches && found.t > 0.1 / spin);
        assert_true(c.usage.gap_closed_form + c.usage.gap_newton + c.usage.gap_gjk < 12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_meet_on_a_line),
        cmocka_unit_test(damped_balls_meet),
        cmocka_unit_test(nothing_is_passed_over),
        cmocka_unit_test(what_has_left_the_ground_is_let_go),
        cmocka_unit_test(what_is_behind_a_plane_comes_back),
        cmocka_unit_test(what_leaves_and_comes_back_within_a_step_is_found),
        cmocka_unit_test(pauses_change_no_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
