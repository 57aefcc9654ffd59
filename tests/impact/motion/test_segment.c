/* SPDX-License-Identifier: MIT
 *
 * Segments against their closed forms in quadruple precision, against the differential equations they solve, and their
 * bounds against the motion itself.
 */
#include "motion/segment.h"
#include "motion/motion_equations.h"
#include "kit/contact_random.h"
#include "kit/near.h"

typedef __float128 wide;

/* e^-z by its series after halving z to under 1/2, in quadruple precision. */
static wide wide_exp(wide z)
{
    int halvings = 0;
    for (; z > (wide)0.5; halvings++) z /= 2;
    wide term = 1, sum = 1;
    for (int n = 1; n < 40; n++) sum += term *= -z / n;
    for (; halvings > 0; halvings--) sum *= sum;
    return sum;
}

/* (1 - e^-z)/z and (1 - that)/z: by series where the differences cancel. */
static wide wide_phi(wide z, int order)
{
    if (z > 1) return order == 1 ? (1 - wide_exp(z)) / z : (1 - wide_phi(z, 1)) / z;
    wide sum = 0;
    for (int n = 40; n >= 0; n--) sum = (1 - z * sum) / (n + order);
    return sum;
}

static void dampings_functions_are_right_to_rounding(void **state)
{
    (void)state;
    random_stream random = {11};
    for (int i = 0; i < 20000; i++) {
        const double k = random_log(&random, 1e-12, 1e6), T = random_log(&random, 1e-9, 1e6);
        const wide z = (wide)k * (wide)T, one = (wide)T * wide_phi(z, 1), two = (wide)T * (wide)T * wide_phi(z, 2);
        assert_near((double)((wide)imp_phi1(k, T) / one), 1, 1e-15);
        assert_near((double)((wide)imp_phi2(k, T) / two), 1, 2e-15);
    }
    assert_true(imp_phi1(0, 3) == 3 && imp_phi2(0, 3) == 4.5);
}

static imp_body solid(qvec3 moments, double linear_rate, double angular_rate)
{
    imp_body body = {.mass = 2,
                     .inverse_mass = 0.5,
                     .moments = moments,
                     .inverse_moments = {1 / moments.x, 1 / moments.y, 1 / moments.z},
                     .spherical = moments.x == moments.y && moments.y == moments.z,
                     .radius = 0.3,
                     .turn = {1, 0, 0, 0},
                     .linear_rate = linear_rate,
                     .angular_rate = angular_rate};
    impact_shape_superquadric(0.1, 0.2, 0.3, 2, 2, 2, &body.shape);
    return body;
}

static imp_state random_state(random_stream *random)
{
    return (imp_state){.x = random_vector(random, 0.1, 10),
                       .q = random_rotation(random),
                       .v = random_vector(random, 0.1, 10),
                       .momentum = random_vector(random, 0.01, 1)};
}

static imp_body random_solid(random_stream *random, bool damped)
{
    const double a = random_log(random, 0.1, 1), b = random_log(random, 0.1, 1);
    const qvec3 moments = {a, b, fabs(a - b) + random_unit(random) * (a + b - fabs(a - b))};
    return solid(moments, damped ? random_log(random, 1e-3, 10) : 0, damped ? random_log(random, 1e-3, 10) : 0);
}

/* v' = g - k v, L' = -kappa L, q' = (0, omega) q / 2, by central differences; and the state at t0 as it was. */
static void segments_solve_their_equations(void **state)
{
    (void)state;
    random_stream random = {12};
    const qvec3 g = {0.3, -0.2, -9.8};
    for (int i = 0; i < 2000; i++) {
        const imp_body body = random_solid(&random, i % 2);
        const imp_state start = random_state(&random);
        impact_tumble tumble;
        const double t0 = random_log(&random, 1e-3, 1e3), T = random_log(&random, 1e-2, 3), h = 1e-4;
        const imp_segment s = imp_segment_fly(&body, t0, &start, g, &tumble);
        assert_int_equal(s.kind, i % 2 ? IMP_SEGMENT_DAMPED : IMP_SEGMENT_FREE);
        const imp_state at = imp_segment_at(&s, &body, t0 + T), a = imp_segment_at(&s, &body, t0 + T - h),
                        b = imp_segment_at(&s, &body, t0 + T + h), first = imp_segment_at(&s, &body, t0);
        assert_memory_equal(&first, &start, sizeof start);
        const double size = 1 + qvec3_norm(start.v), spin = 1 + 10 * qvec3_norm(start.momentum) / 0.01;
        assert_near3(qvec3_scale(qvec3_sub(b.x, a.x), 0.5 / h), at.v, 1e-5 * size);
        const qvec3 rate = qvec3_axpy(-body.linear_rate, at.v, g);
        assert_near3(qvec3_scale(qvec3_sub(b.v, a.v), 0.5 / h), rate, 1e-5 * size);
        const qvec3 torque = qvec3_scale(at.momentum, -body.angular_rate);
        assert_near3(qvec3_scale(qvec3_sub(b.momentum, a.momentum), 0.5 / h), torque, 1e-5);
        const quat turning = quat_mul(quat_pure(imp_omega(&body, &at)), at.q);
        const quat off = quat_sub(quat_scale(quat_sub(b.q, a.q), 1 / h), turning);
        assert_at_most(quat_norm(off), h * h * spin * spin * spin + 1e-9);
        qvec3 v;
        assert_near3(imp_segment_place(&s, &body, t0 + T, &v), at.x, 0);
        assert_near3(v, at.v, 0);
    }
}

/* A damped body loses what the integral of its damping's power says, here by the closed form of its energy at rest. */
static void damping_dies_out_and_falls_at_g_over_k(void **state)
{
    (void)state;
    random_stream random = {13};
    for (int i = 0; i < 200; i++) {
        const imp_body body = solid((qvec3){0.3, 0.4, 0.5}, 2, 3);
        const imp_state start = random_state(&random);
        impact_tumble tumble;
        const imp_segment s = imp_segment_fly(&body, 0, &start, (qvec3){0, 0, -8}, &tumble);
        const imp_state late = imp_segment_at(&s, &body, 50), later = imp_segment_at(&s, &body, 60);
        assert_near3(late.v, (qvec3){0, 0, -4}, 1e-15);
        assert_near3(late.momentum, (qvec3){0, 0, 0}, 1e-60);
        assert_near3(qvec3_sub(later.x, late.x), (qvec3){0, 0, -40}, 1e-12);
        assert_at_most(imp_segment_bounds(&s, &body, 0, INFINITY).speed, fmax(4, qvec3_norm(start.v)) * (1 + 1e-15));
    }
}

/* A ball's omega + alpha T: q against steps a tenth as long. */
static void a_rolling_balls_turning(void **state)
{
    (void)state;
    random_stream random = {14};
    for (int i = 0; i < 50; i++) {
        imp_body body = solid((qvec3){0.4, 0.4, 0.4}, 0, 0);
        imp_state start = random_state(&random);
        const qvec3 omega = imp_omega(&body, &start), alpha = random_vector(&random, 0.1, 10);
        const imp_segment s = imp_segment_roll(1, INFINITY, &start, (qvec3){1, 2, 0}, alpha);
        const double T = 2;
        quat q = start.q;
        const int steps = 40000;
        for (int k = 0; k < steps; k++) {
            const double h = T / steps, middle = (k + 0.5) * h;
            qvec3 turn = qvec3_scale(qvec3_axpy(middle, alpha, omega), h);
            turn = qvec3_axpy(-h * h * h / 12, qvec3_cross(omega, alpha), turn);
            q = quat_mul(quat_from_rotation_vector(turn), q);
        }
        const imp_state at = imp_segment_at(&s, &body, 1 + T);
        assert_at_most(quat_norm(quat_sub(at.q, quat_unit(q))), 2e-11);
        assert_near3(imp_omega(&body, &at), qvec3_axpy(T, alpha, omega), 1e-13 * (1 + qvec3_norm(omega) + 20));
        assert_near3(at.v, qvec3_axpy(T, s.acceleration, start.v), 1e-14 * 20);
    }
}

/* No state within a window passes the bounds at its beginning. */
static void bounds_hold(void **state)
{
    (void)state;
    random_stream random = {15};
    for (int i = 0; i < 2000; i++) {
        const imp_body body = random_solid(&random, i % 2);
        const imp_state start = random_state(&random);
        impact_tumble tumble;
        const imp_segment s = imp_segment_fly(&body, 0, &start, (qvec3){0, 0, -9.8}, &tumble);
        const double t = random_log(&random, 1e-2, 1), window = random_log(&random, 1e-2, 1);
        const imp_bounds b = imp_segment_bounds(&s, &body, t, window);
        for (int k = 0; k < 20; k++) {
            const double T = window * random_unit(&random);
            const imp_state at = imp_segment_at(&s, &body, t + T);
            const qvec3 a = qvec3_axpy(-body.linear_rate, at.v, s.acceleration);
            assert_at_most(qvec3_norm(qvec3_sub(a, b.acceleration)), b.jerk * T * (1 + 1e-9) + 1e-12);
            assert_at_most(qvec3_norm(at.momentum), b.momentum * (1 + 1e-12));
            assert_at_most(qvec3_norm(at.v), b.speed * (1 + 1e-12));
        }
    }
}

/* A body that rolls, or turns about an axis of its own that stays. */
static imp_body random_roller(random_stream *random, bool ball, imp_state *start, qvec3 *alpha)
{
    const double moment = random_log(random, 0.1, 1);
    const imp_body body = ball ? solid((qvec3){moment, moment, moment}, 0, 0) : random_solid(random, false);
    *start = random_state(random);
    *alpha = random_vector(random, 0.1, 10);
    if (ball) return body;
    const qvec3 axis = quat_rotate(start->q, (qvec3){0, 0, 1});
    start->momentum = imp_inertia(&body, start->q, qvec3_scale(axis, 20 * random_unit(random) - 10));
    *alpha = qvec3_scale(axis, 20 * random_unit(random) - 10);
    return body;
}

/* The same of what rolls, whose spin may grow; and what turns seen from it. */
static void bounds_of_what_rolls_hold(void **state)
{
    (void)state;
    random_stream random = {19};
    for (int i = 0; i < 4000; i++) {
        imp_state start;
        qvec3 alpha;
        const imp_body body = random_roller(&random, i % 2, &start, &alpha);
        const imp_segment s = imp_segment_roll(0, INFINITY, &start, random_vector(&random, 0.1, 10), alpha);
        const double t = random_log(&random, 1e-2, 1), window = random_log(&random, 1e-3, 0.3);
        const imp_state at = imp_segment_at(&s, &body, t);
        const imp_bounds b = imp_segment_bounds(&s, &body, t, window);
        const imp_spin spin = imp_segment_spin(&s, &body, &at, &b, window);
        for (int k = 0; k < 20; k++) {
            const double T = window * random_unit(&random);
            const imp_state then = imp_segment_at(&s, &body, t + T);
            const qvec3 omega = imp_omega(&body, &then);
            assert_at_most(qvec3_norm(then.v), b.speed * (1 + 1e-12));
            assert_at_most(qvec3_norm(then.momentum), b.momentum * (1 + 1e-12));
            assert_at_most(qvec3_norm(omega), spin.most * (1 + 1e-12));
        }
    }
}

/* The state without its orientation: places, speeds and energies are the same to rounding. */
static void unturned_states_have_the_energies(void **state)
{
    (void)state;
    random_stream random = {20};
    for (int i = 0; i < 6000; i++) {
        imp_state start;
        qvec3 alpha;
        imp_body body = random_roller(&random, i % 3 == 2, &start, &alpha);
        impact_tumble tumble;
        imp_segment s;
        if (i % 3 == 0) {
            body = random_solid(&random, i % 2);
            start = random_state(&random);
            s = imp_segment_fly(&body, 1, &start, (qvec3){0, 1, -9.8}, &tumble);
        } else
            s = imp_segment_roll(1, INFINITY, &start, random_vector(&random, 0.1, 10), alpha);
        const double t = 1 + random_log(&random, 1e-2, 2);
        const imp_state whole = imp_segment_at(&s, &body, t), brief = imp_segment_unturned(&s, &body, t);
        assert_near3(brief.x, whole.x, 0);
        assert_near3(brief.v, whole.v, 0);
        const double energy = qvec3_dot(whole.momentum, imp_omega(&body, &whole)),
                     size = qvec3_dot(start.momentum, imp_omega(&body, &start)) + energy;
        assert_near(qvec3_dot(brief.momentum, imp_omega(&body, &brief)), energy, 1e-13 * size);
    }
}

/* A unit vector that is fixed in the world, seen from the body at that state. */
static qvec3 seen_from(const imp_state *state, qvec3 n) { return quat_rotate_inverse(state->q, n); }

/* omega' and what turns against Taylor's series: m(T) is no further from m + m' T + m'' T^2/2 than third T^3/6, and no
 * difference of m' is more than second, nor any omega than most. Slender bodies among them, whose |L| over the least
 * moment is a hundred times omega. */
static void turning_is_bounded(void **state)
{
    (void)state;
    random_stream random = {18};
    double closest = INFINITY;
    for (int i = 0; i < 4000; i++) {
        imp_body body = random_solid(&random, i % 2);
        if (i % 4 < 2) body.moments.z *= 1e-4, body.inverse_moments.z *= 1e4;
        imp_state start = random_state(&random);
        if (i % 8 < 4) start.momentum = imp_inertia(&body, start.q, random_vector(&random, 1, 20));
        impact_tumble tumble;
        const imp_segment s = imp_segment_fly(&body, 0, &start, (qvec3){0, 0, -9.8}, &tumble);
        const double t = random_log(&random, 1e-2, 1);
        const imp_state at = imp_segment_at(&s, &body, t);
        const double window = random_log(&random, 1e-3, 0.3) / (1 + qvec3_norm(imp_omega(&body, &at)));
        const imp_bounds b = imp_segment_bounds(&s, &body, t, window);
        imp_segment unknown = s; /* as a step of an integrator is, of which no range is known */
        unknown.kind = IMP_SEGMENT_ROLL;
        const imp_segment *segment = i % 3 ? &s : &unknown;
        const imp_spin spin = imp_segment_spin(segment, &body, &at, &b, window);
        const qvec3 n = random_direction(&random), m = seen_from(&at, n), rate = qvec3_cross(m, spin.omega),
                    second = qvec3_add(qvec3_cross(rate, spin.omega), qvec3_cross(m, spin.rate));
        closest = fmin(closest, spin.most / qvec3_norm(spin.omega));
        for (int k = 0; k < 20; k++) {
            const double T = window * random_unit(&random);
            const imp_state then = imp_segment_at(&s, &body, t + T);
            const qvec3 seen = seen_from(&then, n), omega = quat_rotate_inverse(then.q, imp_omega(&body, &then)),
                        taylor = qvec3_axpy(T, qvec3_axpy(0.5 * T, second, rate), m);
            const double rounding = 1e-14 * (1 + qvec3_norm(omega) * t);
            assert_at_most(qvec3_norm(omega), spin.most * (1 + 1e-12));
            assert_at_most(qvec3_norm(qvec3_sub(seen, taylor)), spin.third * T * T * T / 6 + rounding);
            assert_at_most(qvec3_norm(qvec3_sub(qvec3_cross(seen, omega), rate)),
                           spin.second * T + rounding * spin.most);
        }
    }
    assert_at_most(closest, 1.01); /* and near to what is */
}

/* ---- polynomials ---- */

/* y = (t, ...) of degree 5 on a step, its terms about the end; times and rates as they are. */
static void a_steps_polynomial(void **state)
{
    (void)state;
    random_stream random = {16};
    for (int i = 0; i < 1000; i++) {
        double c[12] = {0};
        const bool clocked = i % 2;
        const double h = random_log(&random, 1e-3, 1);
        imp_dense dense = {.end = 2, .h = h, .size = 2, .terms = 6, .clocked = clocked, .c = c};
        for (int j = 0; j < 6; j++) c[2 * j + 1] = random_unit(&random) - 0.5;
        c[0] = clocked ? 7 : 2, c[2] = h; /* t rises by h over the step, and bends a little */
        c[4] = clocked ? 0.2 * h : 0;
        dense.t0 = c[0] - c[2] + c[4], dense.t1 = c[0];
        const double t = dense.t0 + random_unit(&random) * (dense.t1 - dense.t0),
                     s = (imp_dense_tau(&dense, t) - 2) / h;
        assert_near(c[0] + s * (c[2] + s * c[4]), t, 1e-14);
        double y, wanted = 0, rate = 0;
        for (int j = 5; j >= 0; j--) rate = rate * s + wanted, wanted = wanted * s + c[2 * j + 1];
        imp_dense_at(&dense, t, 1, 1, &y);
        assert_near(y, wanted, 1e-14);
        imp_dense_rate r;
        imp_dense_rates(&dense, imp_dense_window_of(&dense, t, dense.t1 - t), 1, 1, &r);
        assert_near(r.value, wanted, 1e-13);
        assert_near(r.rate, rate / h, 1e-12 / h);
        for (int k = 0; k < 20; k++) {
            const double later = s * random_unit(&random);
            double value = 0, slope = 0, bend = 0;
            for (int j = 5; j >= 0; j--)
                bend = bend * later + 2 * slope, slope = slope * later + value, value = value * later + c[2 * j + 1];
            assert_at_most(fabs(value), r.most + 1e-12);
            assert_at_most(fabs(slope), r.most_rate * h + 1e-12);
            assert_at_most(fabs(bend), r.most_second * h * h + 1e-12);
        }
    }
}

/* Bounds are kept for who asks the same again: a step's, not those of the step before it. */
static void bounds_are_of_their_step(void **state)
{
    (void)state;
    imp_dense dense = {0};
    imp_arena *arena;
    const imp_body body = {.radius = 1, .mass = 1, .moments = {1, 1, 1}, .spherical = true};
    const imp_state start = {.q = {1, 0, 0, 0}};
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    for (int step = 1; step <= 2; step++) {
        const int size = Y_BODIES + Y_PER_BODY, v = Y_BODIES + Y_VELOCITY;
        assert_int_equal(imp_dense_reserve(&dense, arena, size, 1), IMPACT_OK);
        dense.t0 = 0, dense.t1 = dense.end = dense.h = 1, dense.size = size, dense.terms = 2;
        for (int i = 0; i < 2 * size; i++) dense.c[i] = 0;
        dense.c[size + v] = 3 * step; /* v_x rises by that over the step */
        const imp_segment segment = imp_segment_dense(&dense, 0, &start);
        for (int again = 0; again < 2; again++)
            assert_near(imp_segment_bounds(&segment, &body, 0.25, 0.5).acceleration.x, 3 * step, 1e-14);
    }
    imp_arena_destroy(arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dampings_functions_are_right_to_rounding),
        cmocka_unit_test(segments_solve_their_equations),
        cmocka_unit_test(damping_dies_out_and_falls_at_g_over_k),
        cmocka_unit_test(a_rolling_balls_turning),
        cmocka_unit_test(bounds_hold),
        cmocka_unit_test(bounds_of_what_rolls_hold),
        cmocka_unit_test(unturned_states_have_the_energies),
        cmocka_unit_test(turning_is_bounded),
        cmocka_unit_test(a_steps_polynomial),
        cmocka_unit_test(bounds_are_of_their_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
