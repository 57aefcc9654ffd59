/* SPDX-License-Identifier: MIT
 *
 * The steps and links that a time of impact is proved by, each replayed: the gap, which shares nothing with the bounds,
 * is asked at many times within. Balls, needles, boxes and planes, slow and fast, near and far.
 */
#include "motion/toi_proof.h"
#include "kit/contact_random.h"
#include "kit/near.h"

#include <impact/toi.h>

typedef struct chase {
    impact_solid body[2];
    impact_motion motion[2];
    imp_chase q;
} chase;

static void draw_body(chase *c, random_stream *random, int k, int family)
{
    c->body[k] = (impact_solid){.shape = random_shape(random, family), .orientation = random_rotation(random)};
    c->body[k].position = random_vector(random, 1, 5);
    c->motion[k].velocity = random_vector(random, 0.01, 3);
    c->motion[k].acceleration = random_vector(random, 0.01, 3);
    c->motion[k].omega = random_vector(random, 0.01, 10);
}

/* As impact_toi has it (toi.c). */
static void draw(chase *c, random_stream *random, int family, bool plane)
{
    for (int k = 0; k < 2; k++) draw_body(c, random, k, family);
    if (plane) {
        impact_shape_plane(INFINITY, INFINITY, &c->body[1].shape);
        c->motion[1] = (impact_motion){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    }
    c->q = (imp_chase){.course = {.body = {&c->body[0], &c->body[1]}, .motion = {&c->motion[0], &c->motion[1]}},
                       .acceleration = qvec3_sub(c->motion[0].acceleration, c->motion[1].acceleration)};
    for (int k = 0; k < 2; k++) {
        const double spin = qvec3_norm(c->motion[k].omega);
        c->q.course.half_spin[k] = 0.5 * spin;
        if (spin > 0) c->q.course.axis[k] = quat_pure(qvec3_scale(c->motion[k].omega, 1 / spin));
        c->q.plane[k] = c->body[k].shape.kind == IMPACT_PLANE;
        if (c->q.plane[k]) continue;
        c->q.radius[k] = impact_shape_bounding_radius(&c->body[k].shape);
        c->q.omega[k] = c->motion[k].omega;
        c->q.turning = fmax(c->q.turning, spin);
        c->q.length = fmax(c->q.length, contact_size(&c->body[k].shape));
    }
    c->q.course.longest = 0.1 / c->q.turning;
}

/* The bodies at t with their gap; false where they touch. */
static bool see(const chase *c, double t, imp_instant *at)
{
    imp_instant_place(&c->q, t, true, at);
    assert_true(impact_gap(&at->body[0], &at->body[1], NULL, &at->contact) >= 0);
    at->gap = at->contact.lower;
    return at->gap > 1e-9;
}

/* The same with body 1 moved along the normal, so that a gap is left of 1e-4 to 1. */
static bool see_near(chase *c, random_stream *random, double t, imp_instant *at)
{
    if (!see(c, t, at)) return false;
    const double left = random_log(random, 1e-4, 1);
    c->body[0].position = qvec3_axpy(left - at->gap, at->contact.normal, c->body[0].position);
    return see(c, t, at);
}

static void replay(const chase *c, double from, double to)
{
    enum { TIMES = 24 };
    for (int i = 0; i <= TIMES; i++) {
        imp_instant at;
        see(c, from + (to - from) * i / TIMES, &at);
        if (!(at.contact.upper > -1e-12 * (c->q.length + qvec3_norm(at.c))))
            fail_msg("gap %g at %g, on the way from %g to %g", at.contact.upper, at.t, from, to);
    }
}

/* Most with a bound that binds: shorter than the limit. */
static void no_step_passes_a_contact(void **state)
{
    (void)state;
    random_stream random = {61};
    int bound = 0;
    for (int k = 0; k < 4000; k++) {
        chase c;
        imp_instant at;
        draw(&c, &random, k % RANDOM_FAMILIES, k % 3 == 0);
        if (!see_near(&c, &random, random_unit(&random), &at)) continue;
        const double limit = random_log(&random, 1e-2, 1) / (1 + c.q.turning);
        const qvec3 trend = random_vector(&random, 0.01, 10);
        const double step = imp_toi_safe_step(&c.q, &at, trend, limit);
        assert_true(step > 0 && step <= limit);
        bound += step < limit;
        replay(&c, at.t, at.t + step);
    }
    if (bound < 300) fail_msg("%d bound", bound);
}

/* Links hold between instants a step apart, and fail where the time between is long. */
static void no_link_spans_a_contact(void **state)
{
    (void)state;
    random_stream random = {62};
    int held = 0, refused = 0;
    for (int k = 0; k < 6000; k++) {
        chase c;
        imp_instant from, to;
        draw(&c, &random, k % RANDOM_FAMILIES, k % 3 == 0);
        const double t = random_unit(&random), T = random_log(&random, 1e-2, 3) / (1 + c.q.turning);
        if (!see_near(&c, &random, t, &from) || !see(&c, t + T, &to)) continue;
        if (!imp_toi_link(&c.q, &from, &to)) {
            refused++;
            continue;
        }
        held++;
        replay(&c, t, t + T);
    }
    if (held < 1000 || refused < 300) fail_msg("%d held, %d refused", held, refused);
}

/* Along n the two bounding balls fall by a quadratic in t, whose first zero is the step. */
static void balls_meet_where_their_quadratic_says(void **state)
{
    (void)state;
    random_stream random = {63};
    int met = 0, turned = 0;
    for (int k = 0; k < 4000; k++) {
        chase c;
        imp_instant at;
        draw(&c, &random, RANDOM_MIXED, k % 4 == 0);
        imp_instant_place(&c.q, random_unit(&random), true, &at);
        const qvec3 n = qvec3_scale(at.c, 1 / qvec3_norm(at.c));
        const double T = imp_toi_ball_step(&c.q, &at, n), slope = qvec3_dot(n, at.v),
                     bend = fmin(0, qvec3_dot(n, c.q.acceleration)),
                     apart = qvec3_norm(at.c) - c.q.radius[0] - c.q.radius[1];
        if (c.q.plane[1] || apart <= 0) {
            assert_true(T == 0);
            continue;
        }
        assert_true(T > 0);
        if (isinf(T)) {
            assert_true(slope >= 0 && bend == 0);
            continue;
        }
        met++, turned += slope > 0;
        assert_near(apart + T * (slope + 0.5 * T * bend), 0, 1e-13 * (apart + T * (fabs(slope) - T * bend)));
        for (int i = 1; i < 16; i++) {
            const double s = T * i / 16;
            assert_true(apart + s * (slope + 0.5 * s * bend) > 0);
        }
    }
    assert_true(met > 1000 && turned > 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_step_passes_a_contact),
        cmocka_unit_test(no_link_spans_a_contact),
        cmocka_unit_test(balls_meet_where_their_quadratic_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
