/* SPDX-License-Identifier: MIT
 *
 * The links that a search for contact is proved by, each replayed: the gap, which shares nothing with the bounds, is
 * asked at many times within. Balls, needles, boxes and cones, slow and fast, near and far; steady and tumbling, damped
 * and driven.
 */
#include "motion/search_window.h"
#include "kit/contact_random.h"
#include "kit/near.h"

typedef struct chase {
    imp_body body[2];
    imp_segment segment[2];
    impact_tumble tumble[2];
    imp_search search;
} chase;

static impact_shape draw_shape(random_stream *random, int family)
{
    if (family < RANDOM_FAMILIES) return random_shape(random, family);
    impact_shape shape;
    const double height = random_log(random, 0.1, 1);
    assert_int_equal(impact_shape_cone(random_log(random, 0.1, 1), height, 0, &shape), IMPACT_OK);
    return shape;
}

/* Of equal moments or not, its centre of mass beside the shape's or not. */
static imp_body draw_body(random_stream *random, int family, bool damped)
{
    const double I[3] = {1, 1 + 0.5 * random_unit(random), 1 + 0.5 * random_unit(random)};
    const bool equal = random_unit(random) < 0.4;
    imp_body body = {.shape = draw_shape(random, family), .spherical = equal, .turn = {1, 0, 0, 0}};
    body.moments = equal ? (qvec3){1, 1, 1} : (qvec3){I[0], I[1], I[2]};
    body.inverse_moments = (qvec3){1 / body.moments.x, 1 / body.moments.y, 1 / body.moments.z};
    body.radius = impact_shape_bounding_radius(&body.shape);
    if (random_unit(random) < 0.3) {
        body.shifted = true;
        body.turn = random_rotation(random);
        body.offset = qvec3_scale(random_direction(random), 0.2 * body.radius);
        body.radius *= 1.2;
    }
    if (damped) body.linear_rate = random_log(random, 0.01, 3), body.angular_rate = random_log(random, 0.01, 3);
    return body;
}

static void draw_segment(chase *c, random_stream *random, int k)
{
    const imp_body *body = &c->body[k];
    imp_state start = {
        .x = random_vector(random, 1, 5), .q = random_rotation(random), .v = random_vector(random, 0.01, 3)};
    start.momentum = imp_inertia(body, start.q, random_vector(random, 0.01, 10));
    const qvec3 pull = random_vector(random, 0.01, 3);
    if (random_unit(random) < 0.1)
        c->segment[k] = imp_segment_rest(0, &start);
    else if (body->spherical && random_unit(random) < 0.3)
        c->segment[k] = imp_segment_roll(0, 100, &start, pull, random_vector(random, 0.1, 3));
    else
        c->segment[k] = imp_segment_fly(body, 0, &start, pull, &c->tumble[k]);
}

static void draw(chase *c, random_stream *random, int k)
{
    for (int i = 0; i < 2; i++) {
        c->body[i] = draw_body(random, k % (RANDOM_FAMILIES + 2), k % 3 == 0);
        draw_segment(c, random, i);
    }
    c->search = (imp_search){.body = {&c->body[0], &c->body[1]}, .segment = {&c->segment[0], &c->segment[1]}};
}

/* The bodies at t with their gap; false where they touch. */
static bool see(const imp_window *w, double t, imp_instant *at)
{
    imp_instant_place(w, t, at);
    assert_true(impact_gap(&at->body[0], &at->body[1], NULL, &at->contact) >= 0);
    imp_instant_note(w, at);
    return at->gap > 1e-9;
}

/* The same with body 1 moved along the normal, so that a gap is left of 1e-4 to 1. */
static bool see_near(chase *c, random_stream *random, double t, imp_window *w, imp_instant *at)
{
    if (!see(w, t, at)) return false;
    qvec3 *x = &c->segment[0].start.x;
    *x = qvec3_axpy(random_log(random, 1e-4, 1) - at->gap, at->contact.normal, *x);
    return see(w, t, at);
}

static void replay(const imp_window *w, double from, double to)
{
    enum { TIMES = 24 };
    for (int i = 0; i <= TIMES; i++) {
        imp_instant at;
        see(w, from + (to - from) * i / TIMES, &at);
        if (!(at.contact.upper > -1e-12 * (1 + qvec3_norm(at.c))))
            fail_msg("gap %g at %g, on the way from %g to %g", at.contact.upper, at.t, from, to);
    }
}

/* Links hold between instants a step apart, and fail where the time between is long. */
static void no_link_spans_a_contact(void **state)
{
    (void)state;
    random_stream random = {62};
    int held = 0, refused = 0;
    for (int k = 0; k < 8000; k++) {
        chase c;
        imp_window w;
        imp_instant from, to;
        draw(&c, &random, k);
        const double t = random_unit(&random), T = random_log(&random, 1e-3, 0.3);
        imp_window_open(&c.search, t, t + T, &w);
        if (w.t1 < t + T || !see_near(&c, &random, t, &w, &from) || !see(&w, t + T, &to)) continue;
        if (!imp_search_link(&w, &from, &to)) {
            refused++;
            continue;
        }
        held++;
        replay(&w, t, t + T);
    }
    if (held < 1000 || refused < 300) fail_msg("%d held, %d refused", held, refused);
}

/* Sketched: a normal near the gap's parts the bodies by no more than the gap, and where they overlap none does. */
static void no_sketch_parts_what_touches(void **state)
{
    (void)state;
    random_stream random = {64};
    int parted = 0;
    for (int k = 0; k < 4000; k++) {
        chase c;
        imp_window w;
        imp_instant at;
        draw(&c, &random, k);
        imp_window_open(&c.search, 0, 1e-3, &w);
        const bool apart = see_near(&c, &random, 0, &w, &at);
        const double gap = at.gap;
        const qvec3 n = qvec3_axpy(0.1, random_direction(&random), at.contact.normal);
        if (!imp_instant_sketch(&w, qvec3_scale(n, 1 / qvec3_norm(n)), &at)) continue;
        parted++;
        assert_true(apart && at.gap <= gap * (1 + 1e-12) + 1e-14);
    }
    assert_true(parted > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_link_spans_a_contact),
        cmocka_unit_test(no_sketch_parts_what_touches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
