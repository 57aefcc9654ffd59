/* SPDX-License-Identifier: MIT */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>
#include <impact/toi.h>
#include "gap/gap_solver.h"
#include "kit/contact_random.h"
#include "motion/search.h"

static impact_solid solid(impact_shape shape, qvec3 position, quat orientation)
{
    return (impact_solid){shape, position, orientation};
}

static impact_shape sphere(double radius)
{
    impact_shape shape = {0};
    assert_int_equal(impact_shape_sphere(radius, &shape), IMPACT_OK);
    return shape;
}

static void near(double got, double wanted, double tolerance)
{
    if (!(fabs(got - wanted) <= tolerance)) fail_msg("wanted %.17g, got %.17g, off by %g", wanted, got, got - wanted);
}

static const impact_motion at_rest = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

static void spheres_meet_in_closed_form(void **state)
{
    (void)state;
    const impact_solid a = solid(sphere(1), (qvec3){-5, 0.6, 0}, quat_identity()),
                       b = solid(sphere(0.5), (qvec3){0, 0, 0}, quat_identity());
    const impact_motion m = {{2, 0, 0}, {0, 0, 0}, {3, 4, 5}};
    double t;
    impact_contact contact;
    assert_int_equal(impact_toi(&a, &m, &b, &at_rest, 10, &t, &contact), IMPACT_OK);
    near(t, (5 - sqrt(2.25 - 0.36)) / 2, 1e-15);
    assert_true(fabs(contact.gap) < 2e-15);
    const impact_motion past = {{2, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const impact_solid high = solid(sphere(1), (qvec3){-5, 1.5 + 1e-9, 0}, quat_identity());
    assert_int_equal(impact_toi(&high, &past, &b, &at_rest, 10, &t, NULL), IMPACT_NO_CONTACT);
    assert_true(t == 10);
    const impact_solid grazing = solid(sphere(1), (qvec3){-5, 1.5 - 1e-9, 0}, quat_identity());
    assert_int_equal(impact_toi(&grazing, &past, &b, &at_rest, 10, &t, NULL), IMPACT_OK);
    near(t, (5 - sqrt(2.25 - (1.5 - 1e-9) * (1.5 - 1e-9))) / 2, 1e-10); /* conditioning 1/sqrt(1e-9) */
}

static void falling_on_a_plane(void **state)
{
    (void)state;
    impact_shape plane;
    impact_shape_plane(INFINITY, INFINITY, &plane);
    const impact_solid floor = solid(plane, (qvec3){0, 0, 0}, quat_identity()),
                       ball = solid(sphere(0.3), (qvec3){0, 0, 1.3}, quat_identity());
    const impact_motion fall = {{0, 0, 0}, {0, 0, -9.80665}, {0, 0, 0}}, moving = {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    double t;
    assert_int_equal(impact_toi(&ball, &fall, &floor, &at_rest, 10, &t, NULL), IMPACT_OK);
    near(t, sqrt(2 / 9.80665), 2e-16);
    assert_int_equal(impact_toi(&floor, &at_rest, &ball, &fall, 10, &t, NULL), IMPACT_OK);
    near(t, sqrt(2 / 9.80665), 2e-16);
    assert_int_equal(impact_toi(&ball, &fall, &floor, &moving, 10, &t, NULL), IMPACT_EARGUMENT);
    const impact_motion thrown = {{0, 0, 3}, {0, 0, -9.80665}, {0, 0, 0}}; /* up first */
    assert_int_equal(impact_toi(&ball, &thrown, &floor, &at_rest, 10, &t, NULL), IMPACT_OK);
    near(t, (3 + sqrt(9 + 2 * 9.80665)) / 9.80665, 4e-16);
}

/* A stick that turns once a second strikes a pin at its tip's radius: the sampling of a coarse step would miss it. */
static void nothing_is_missed(void **state)
{
    (void)state;
    impact_shape stick;
    assert_int_equal(impact_shape_ellipsoid(1, 1e-3, 1e-3, &stick), IMPACT_OK);
    const impact_solid rod = solid(stick, (qvec3){0, 0, 0}, quat_identity());
    const double angle = 0.25, radius = 1e-6;
    const impact_solid pin = solid(sphere(radius), (qvec3){0.5 * cos(angle), 0.5 * sin(angle), 0}, quat_identity());
    const impact_motion spin = {{0, 0, 0}, {0, 0, 0}, {0, 0, 100}};
    double t;
    impact_contact contact;
    assert_int_equal(impact_toi(&rod, &spin, &pin, &at_rest, 1, &t, &contact), IMPACT_OK);
    assert_true(fabs(contact.gap) <= 1e-15);
    const double half_width = 1e-3 * sqrt(0.75); /* the rod's half width at 0.5 */
    assert_true(t < angle / 100 && t > (angle - 1.1 * (half_width + radius) / 0.5) / 100);
    const impact_motion shot = {{1e6, 0, 0}, {0, 0, 0}, {0, 0, 0}}; /* two bullets through each other within 4 ns */
    const impact_solid left = solid(sphere(1e-3), (qvec3){-1e3, 0, 0}, quat_identity()),
                       right = solid(sphere(1e-3), (qvec3){0, 1.9e-3, 0}, quat_identity());
    assert_int_equal(impact_toi(&left, &shot, &right, &at_rest, 1, &t, NULL), IMPACT_OK);
    near(t, (1e3 - sqrt(4e-6 - 1.9e-3 * 1.9e-3)) / 1e6, 1e-15);
}

/* Thin plates all but face to face: their gap is told to the rounding of their width, however near their centres come.
 */
static void thin_plates_meet(void **state)
{
    (void)state;
    random_stream random = {44};
    int met = 0;
    for (int k = 0; k < 3000; k++) {
        impact_solid plate[2];
        const quat turn = random_rotation(&random);
        const qvec3 n = quat_rotate(turn, (qvec3){0, 0, 1}), centre = random_vector(&random, 0.01, 1);
        const double thin = random_log(&random, 1e-9, 1e-3), away = random_log(&random, 0.1, 1);
        for (int i = 0; i < 2; i++) {
            const qvec3 tilt = random_vector(&random, 1e-3 * thin, thin);
            const double wide = random_log(&random, 0.3, 1), p = k % 3 ? 2 : 2 + 2 * random_unit(&random);
            plate[i] = solid((impact_shape){0}, qvec3_axpy(i ? 0 : away, n, centre),
                             quat_mul(quat_from_rotation_vector(tilt), turn));
            assert_int_equal(impact_shape_superquadric(1, wide, thin, p, p, p, &plate[i].shape), IMPACT_OK);
        }
        const impact_motion fall = {qvec3_neg(n), {0, 0, 0}, k % 2 ? qvec3_scale(n, 3) : (qvec3){0, 0, 0}};
        double t;
        const impact_status status = impact_toi(&plate[0], &fall, &plate[1], &at_rest, 2, &t, NULL);
        if (status != IMPACT_OK) fail_msg("%d: status %d at %g, plates of %g from %g", k, status, t, thin, away);
        const impact_solid there = impact_motion_at(&plate[0], &fall, t);
        impact_contact c;
        met += impact_gap(&there, &plate[1], NULL, &c) == IMPACT_OK;
        near(c.gap, 0, 1e-14);
    }
    assert_true(met > 2500);
}

/* One draw a statement: the order of evaluation within one is the compiler's. */
static impact_solid random_solid(random_stream *random, int family, double distance)
{
    impact_solid body = {.shape = random_shape(random, family)};
    body.position = qvec3_scale(random_direction(random), distance);
    body.orientation = random_rotation(random);
    return body;
}

/* Towards the origin, and tumbling. */
static impact_motion random_motion(random_stream *random, qvec3 position)
{
    impact_motion motion;
    motion.velocity = qvec3_axpy(0.2, random_direction(random), qvec3_scale(position, -0.25));
    motion.acceleration = qvec3_scale(random_direction(random), 0.1);
    motion.omega = qvec3_scale(random_direction(random), 3);
    return motion;
}

/* Random tumbling shapes: the gap is zero at the time and positive on a grid before it. */
static void first_contact_of_random_pairs(void **state)
{
    (void)state;
    random_stream random = {99};
    int met = 0;
    for (int k = 0; k < 1500; k++) {
        const int family = 1 + k % (RANDOM_FAMILIES - 1);
        if (family == RANDOM_NEEDLE) continue;
        const impact_solid a = random_solid(&random, family, 4), b = random_solid(&random, family, 0);
        const impact_motion ma = random_motion(&random, a.position), mb = random_motion(&random, b.position);
        double t;
        impact_contact contact;
        const impact_status status = impact_toi(&a, &ma, &b, &mb, 6, &t, &contact);
        if (!(status == IMPACT_OK || status == IMPACT_NO_CONTACT))
            fail_msg("status %d at t = %g, gap %g", status, t, contact.gap);
        if (status == IMPACT_OK) {
            met++;
            if (!(fabs(contact.gap) <= 1e-15 * (1 + 1)))
                fail_msg("%s: gap %g in [%g, %g] by path %d at contact, t %.17g", random_family_name(family),
                         contact.gap, contact.lower, contact.upper, contact.path, t);
        }
        for (int i = 0; i < 40; i++) {
            const double s = t * i / 40;
            const impact_solid at = impact_motion_at(&a, &ma, s), bt = impact_motion_at(&b, &mb, s);
            impact_contact before;
            assert_true(impact_gap(&at, &bt, NULL, &before) >= 0);
            if (!(before.upper > 0)) fail_msg("gap %g at %g, before the contact at %g", before.gap, s, t);
        }
    }
    assert_true(met > 500);
}

/* Needles, thrown past and at each other with slow and fast spins: never unsettled, and no contact before the first.
 * The gap left is that of the time's last digit. */
static void any_spin(void **state)
{
    (void)state;
    random_stream random = {7};
    int met = 0;
    for (int k = 0; k < 1500; k++) {
        const impact_solid a = random_solid(&random, k % RANDOM_FAMILIES, 2),
                           b = random_solid(&random, (k / RANDOM_FAMILIES) % RANDOM_FAMILIES, 0);
        impact_motion ma = random_motion(&random, a.position), mb = random_motion(&random, b.position);
        ma.velocity = qvec3_scale(ma.velocity, 3);
        ma.omega = qvec3_scale(ma.omega, random_log(&random, 0.01, 20));
        mb.omega = qvec3_scale(mb.omega, random_log(&random, 0.01, 20));
        double t;
        impact_contact contact;
        const impact_status status = impact_toi(&a, &ma, &b, &mb, 2, &t, &contact);
        if (!(status == IMPACT_OK || status == IMPACT_NO_CONTACT))
            fail_msg("%d: status %d at t = %g, gap %g", k, status, t, contact.gap);
        met += status == IMPACT_OK && t > 0;
        const double rate =
            impact_gap_rate(&contact, qvec3_axpy(t, ma.acceleration, ma.velocity), ma.omega,
                            qvec3_axpy(t, mb.acceleration, mb.velocity), mb.omega); /* the time is rounded */
        if (status == IMPACT_OK && t > 0) near(contact.gap, 0, 1.5e-15 + 0x1p-52 * t * fabs(rate));
        for (int i = 0; i < 30; i++) {
            const double s = i < 15 ? t * random_unit(&random) : t * (1 - random_log(&random, 1e-9, 0.1));
            const impact_solid at = impact_motion_at(&a, &ma, s), bt = impact_motion_at(&b, &mb, s);
            impact_contact before;
            assert_true(impact_gap(&at, &bt, NULL, &before) >= 0);
            if (t > 0 && !(before.upper > 0)) fail_msg("%d: gap %g at %g, before %g", k, before.gap, s, t);
        }
    }
    assert_true(met > 500);
}

/* Any two shapes, planes among them, thrown anyhow: accelerated, spun to 60 rad/s, alike or not at all, to meet or to
 * miss. */
static void any_motion(void **state)
{
    (void)state;
    random_stream random = {4};
    int met = 0, missed = 0;
    for (int k = 0; k < 2000; k++) {
        impact_solid body[2];
        impact_motion motion[2];
        for (int i = 0; i < 2; i++) {
            const double distance = i == 0 ? random_log(&random, 0.3, 5) : 0;
            const int family = (int)(random_bits(&random) % RANDOM_FAMILIES);
            body[i] = random_solid(&random, family, distance);
            motion[i] = random_motion(&random, body[i].position);
            const double push = random_log(&random, 0.01, 100), spin = random_log(&random, 0.01, 20);
            motion[i].acceleration = qvec3_scale(motion[i].acceleration, k % 2 == 0 ? push : 0);
            motion[i].omega = qvec3_scale(motion[i].omega, k % 5 == 0 ? 0 : spin);
        }
        if (k % 29 == 0) {
            impact_shape_plane(INFINITY, INFINITY, &body[1].shape);
            motion[1] = at_rest;
        }
        if (k % 29 == 1) motion[1].omega = motion[0].omega;
        double t;
        const double end = random_log(&random, 0.1, 10);
        impact_contact contact;
        const impact_status status = impact_toi(&body[0], &motion[0], &body[1], &motion[1], end, &t, &contact);
        if (!(status == IMPACT_OK || status == IMPACT_NO_CONTACT))
            fail_msg("%d: status %d at t = %g, gap %g", k, status, t, contact.gap);
        if (status == IMPACT_NO_CONTACT) assert_true(missed++ >= 0 && t == end && contact.gap > 0);
        if (status == IMPACT_OK && t > 0) {
            double speed = 0;
            for (int i = 0; i < 2; i++)
                speed +=
                    qvec3_norm(qvec3_axpy(t, motion[i].acceleration, motion[i].velocity)) + qvec3_norm(motion[i].omega);
            near(contact.gap, 0, 1e-15 + 2.3e-16 * t * speed); /* the time's last digit */
            met++;
        }
        for (int i = 0; i < 8; i++) {
            const double s = i < 4 ? t * random_unit(&random) : t * (1 - random_log(&random, 1e-9, 0.1));
            const impact_solid at = impact_motion_at(&body[0], &motion[0], s),
                               bt = impact_motion_at(&body[1], &motion[1], s);
            impact_contact before;
            assert_true(impact_gap(&at, &bt, NULL, &before) >= 0);
            if (t > 0 && !(before.upper > 0)) fail_msg("%d: gap %g at %g, before %g", k, before.gap, s, t);
        }
    }
    if (met < 250 || missed < 500) fail_msg("%d met, %d missed", met, missed);
}

/* What toi says of the contact, a query of the gap there says too: no use is made of the search's own answer. */
static void contact_is_the_gaps(void **state)
{
    (void)state;
    random_stream random = {31};
    int met = 0;
    for (int k = 0; k < 3000; k++) {
        const int family = k % RANDOM_FAMILIES;
        if (family == RANDOM_NEEDLE) continue;
        const impact_solid a = random_solid(&random, family, 3), b = random_solid(&random, family, 0);
        const impact_motion ma = random_motion(&random, a.position), mb = random_motion(&random, b.position);
        double t;
        impact_contact contact, there;
        const impact_status status = impact_toi(&a, &ma, &b, &mb, 8, &t, &contact);
        if (status != IMPACT_OK || t == 0) continue;
        met++;
        const impact_solid at = impact_motion_at(&a, &ma, t), bt = impact_motion_at(&b, &mb, t);
        const impact_status asked = impact_gap(&at, &bt, NULL, &there);
        if (family == RANDOM_OCTAHEDRAL && asked != IMPACT_OK) continue; /* two vertices may have no one normal */
        assert_int_equal(asked, IMPACT_OK);
        near(there.gap, 0, 1.5e-15);
        near(contact.gap, there.gap, 1.5e-15);
        near(contact.lower, contact.gap, 0);
        assert_true(contact.upper >= contact.gap && contact.upper <= 4e-14);
        near(qvec3_norm(qvec3_sub(qvec3_sub(contact.point1, contact.point2), qvec3_scale(contact.normal, contact.gap))),
             0, 4e-14);
        if (family < RANDOM_CYLINDER) near(qvec3_norm(qvec3_sub(contact.normal, there.normal)), 0, 1e-13);
    }
    assert_true(met > 1500);
}

/* No step of this advancement leans on the search's bounds: the gap never falls faster than the centres and the
 * bounding balls' rims move. It comes to the contact that was found, and never past it. */
static void advancement_by_speed_alone(void **state)
{
    (void)state;
    random_stream random = {41};
    int met = 0, near_it = 0;
    for (int k = 0; k < 300; k++) {
        const int family = k % RANDOM_FAMILIES;
        const impact_solid a = random_solid(&random, family, 2), b = random_solid(&random, family, 0);
        const impact_motion ma = random_motion(&random, a.position), mb = random_motion(&random, b.position);
        double t, at = 0;
        const double end = 4;
        if (impact_toi(&a, &ma, &b, &mb, end, &t, NULL) < 0) fail_msg("%d: unsettled", k);
        const double speed = qvec3_norm(ma.velocity) + qvec3_norm(mb.velocity) +
                             end * (qvec3_norm(ma.acceleration) + qvec3_norm(mb.acceleration)) +
                             impact_shape_bounding_radius(&a.shape) * qvec3_norm(ma.omega) +
                             impact_shape_bounding_radius(&b.shape) * qvec3_norm(mb.omega);
        for (int step = 0; step < 120 && at < t; step++) {
            const impact_solid a_at = impact_motion_at(&a, &ma, at), b_at = impact_motion_at(&b, &mb, at);
            impact_contact c;
            assert_true(impact_gap(&a_at, &b_at, NULL, &c) >= 0);
            if (!(c.upper > -1e-14)) fail_msg("%d: gap %g at %.17g, the contact at %.17g", k, c.upper, at, t);
            at += c.lower / speed;
        }
        if (t > 0 && t < end) met++, near_it += t - at < 1e-2;
        if (t > 0 && t < end && at > t + 1e-14) fail_msg("%d: free of contact to %.17g, contact at %.17g", k, at, t);
    }
    if (met < 80 || near_it < 0.8 * met) fail_msg("%d met, %d approached", met, near_it);
}

typedef struct pass {
    impact_solid body[2];
    impact_motion motion[2];
} pass;

static void passing(const void *of, double t, imp_gap_moved *moved)
{
    const pass *p = of;
    qvec3 v[2];
    for (int k = 0; k < 2; k++) {
        moved->body[k] = impact_motion_at(&p->body[k], &p->motion[k], t);
        moved->omega[k] = p->motion[k].omega;
        v[k] = qvec3_axpy(t, p->motion[k].acceleration, p->motion[k].velocity);
    }
    moved->v = qvec3_sub(v[0], v[1]);
}

/* Newton for contact and time at once, from a tenth of a second before one: most often it settles, and where it says so
 * a query of the gap has the bodies touch. */
static void newton_strikes_what_closes(void **state)
{
    (void)state;
    random_stream random = {43};
    int asked = 0, struck = 0;
    for (int k = 0; k < 3000; k++) {
        const impact_solid a = random_solid(&random, k % RANDOM_FAMILIES, 3),
                           b = random_solid(&random, k % RANDOM_FAMILIES, 0);
        const impact_motion ma = random_motion(&random, a.position), mb = random_motion(&random, b.position);
        double t;
        if (impact_toi(&a, &ma, &b, &mb, 8, &t, NULL) != IMPACT_OK || t < 0.1) continue;
        const pass moving = {{a, b}, {ma, mb}};
        const imp_gap_course course = {.at = passing, .of = &moving, .longest = 0.5};
        const double from = t - 0.1;
        const impact_solid at = impact_motion_at(&a, &ma, from), bt = impact_motion_at(&b, &mb, from);
        impact_contact before, contact, there;
        if (impact_gap(&at, &bt, NULL, &before) != IMPACT_OK) continue;
        asked++;
        double when = from;
        if (!imp_gap_strike(&course, from, t + 0.1, before.normal, &when, &contact)) continue;
        struck++;
        assert_true(when >= from && when <= t + 0.1);
        const impact_solid ac = impact_motion_at(&a, &ma, when), bc = impact_motion_at(&b, &mb, when);
        assert_true(impact_gap(&ac, &bc, NULL, &there) >= 0);
        near(contact.gap, 0, 1e-13);
        near(there.gap, 0, 1e-13);
    }
    if (asked < 1200 || struck < 0.95 * asked) fail_msg("%d of %d struck", struck, asked);
}

/* The receipt of a contact: right ones pass, those of another time fail. */
static void receipts_tell_wrong_times(void **state)
{
    (void)state;
    random_stream random = {42};
    int told = 0;
    for (int k = 0; k < 300; k++) {
        const impact_solid a = random_solid(&random, RANDOM_MIXED, 3), b = random_solid(&random, RANDOM_MIXED, 0);
        const impact_motion ma = random_motion(&random, a.position), mb = random_motion(&random, b.position);
        double t;
        impact_contact contact;
        if (impact_toi(&a, &ma, &b, &mb, 8, &t, &contact) != IMPACT_OK || t == 0) continue;
        const impact_solid body[2] = {a, b};
        const impact_motion motion[2] = {ma, mb};
        const double off[3] = {0, 1e-3, -1e-3};
        for (int i = 0; i < 3; i++) {
            const double then = t + off[i];
            const impact_solid a_at = impact_motion_at(&a, &ma, then), b_at = impact_motion_at(&b, &mb, then);
            impact_contact at;
            assert_true(impact_gap(&a_at, &b_at, NULL, &at) >= 0);
            const double rate = impact_gap_rate(&at, qvec3_axpy(then, ma.acceleration, ma.velocity), ma.omega,
                                                qvec3_axpy(then, mb.acceleration, mb.velocity), mb.omega);
            if (fabs(rate) < 1e-2) continue;
            assert_int_equal(imp_toi_holds(body, motion, then, &at), i == 0);
            told++;
            at.lower = 0; /* were only the gap wrong: the bodies overlap before */
            if (i == 1) assert_false(imp_toi_holds(body, motion, then, &at));
        }
    }
    assert_true(told > 300);
}

static void bad_input(void **state)
{
    (void)state;
    const impact_solid a = solid(sphere(1), (qvec3){-5, 0, 0}, quat_identity()),
                       b = solid(sphere(1), (qvec3){0, 0, 0}, quat_identity());
    double t;
    for (size_t i = 0; i < sizeof(impact_motion) / sizeof(double); i++) {
        impact_motion bad = at_rest;
        memcpy((double *)&bad + i, &(double){i % 2 ? INFINITY : NAN}, sizeof(double));
        assert_int_equal(impact_toi(&a, &bad, &b, &at_rest, 1, &t, NULL), IMPACT_EDOMAIN);
        assert_int_equal(impact_toi(&b, &at_rest, &a, &bad, 1, &t, NULL), IMPACT_EDOMAIN);
        assert_true(isnan(t));
    }
    assert_int_equal(impact_toi(&a, &at_rest, &b, &at_rest, INFINITY, &t, NULL), IMPACT_EDOMAIN);
    assert_int_equal(impact_toi(&a, &at_rest, &b, &at_rest, -1, &t, NULL), IMPACT_EARGUMENT);
    assert_int_equal(impact_toi(&a, &at_rest, &b, &at_rest, 1, &t, NULL), IMPACT_NO_CONTACT);
    const impact_solid inside = solid(sphere(1), (qvec3){-1, 0, 0}, quat_identity());
    assert_int_equal(impact_toi(&inside, &at_rest, &b, &at_rest, 1, &t, NULL), IMPACT_OK);
    assert_true(t == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_meet_in_closed_form),
        cmocka_unit_test(falling_on_a_plane),
        cmocka_unit_test(nothing_is_missed),
        cmocka_unit_test(thin_plates_meet),
        cmocka_unit_test(first_contact_of_random_pairs),
        cmocka_unit_test(any_spin),
        cmocka_unit_test(any_motion),
        cmocka_unit_test(contact_is_the_gaps),
        cmocka_unit_test(advancement_by_speed_alone),
        cmocka_unit_test(newton_strikes_what_closes),
        cmocka_unit_test(receipts_tell_wrong_times),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
