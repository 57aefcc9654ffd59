/* SPDX-License-Identifier: MIT
 *
 * The receipt of an encounter passes what obeys its identities, and fails what misses any one of them: outcomes are
 * made from impulses by Newton's and Euler's equations, right but for the one thing that is wrong.
 */
#include "contact/encounter.h"

#include "kit/contact_random.h"
#include "kit/near.h"

/* Two bodies, or one and a static one, that meet at one point. */
typedef struct blow {
    impact_collider bodies[2];
    impact_meeting meeting;
    impact_encounter encounter;
    qvec3 impulse, velocity[2], omega[2];
    impact_meeting_outcome own;
    impact_together_outcome outcome;
} blow;

static qvec3 spin_of(const impact_collider *body, qvec3 momentum)
{
    const qvec3 own = quat_rotate_inverse(body->orientation, momentum), j = body->moments;
    return quat_rotate(body->orientation, (qvec3){own.x / j.x, own.y / j.y, own.z / j.z});
}

static double energy_of(const impact_collider *body, qvec3 velocity, qvec3 omega)
{
    const qvec3 own = quat_rotate_inverse(body->orientation, omega), j = body->moments;
    return 0.5 * body->mass * qvec3_dot(velocity, velocity) +
           0.5 * (j.x * own.x * own.x + j.y * own.y * own.y + j.z * own.z * own.z);
}

static qvec3 relative(const blow *b, const qvec3 *velocity, const qvec3 *omega)
{
    const qvec3 one = qvec3_add(velocity[0], qvec3_cross(omega[0], b->meeting.offset1)),
                two = qvec3_add(velocity[1], qvec3_cross(omega[1], b->meeting.offset2));
    return qvec3_sub(one, two);
}

/* What the impulse makes of the bodies, and an outcome that says so. */
static void strike(blow *b, qvec3 impulse)
{
    const qvec3 arm[2] = {b->meeting.offset1, b->meeting.offset2};
    double before = 0, after = 0;
    b->impulse = impulse;
    for (int k = 0; k < 2; k++) {
        const impact_collider *body = &b->bodies[k];
        const qvec3 p = k == 0 ? impulse : qvec3_neg(impulse);
        b->velocity[k] = body->velocity, b->omega[k] = body->omega;
        if (isinf(body->mass)) continue;
        before += energy_of(body, body->velocity, body->omega);
        b->velocity[k] = qvec3_axpy(1 / body->mass, p, body->velocity);
        b->omega[k] = qvec3_add(body->omega, spin_of(body, qvec3_cross(arm[k], p)));
        after += energy_of(body, b->velocity[k], b->omega[k]);
    }
    b->own = (impact_meeting_outcome){.impulse = impulse, .work_compression = after - before};
    b->outcome = (impact_together_outcome){.velocity = b->velocity,
                                           .omega = b->omega,
                                           .meetings = &b->own,
                                           .energy_before = before,
                                           .energy_after = after};
}

/* u_n that an impulse along the normal adds, for each N s. */
static double lightness(blow *b)
{
    const qvec3 before[2] = {b->bodies[0].velocity, b->bodies[1].velocity},
                spin[2] = {b->bodies[0].omega, b->bodies[1].omega};
    strike(b, b->meeting.normal);
    return qvec3_dot(b->meeting.normal, qvec3_sub(relative(b, b->velocity, b->omega), relative(b, before, spin)));
}

static impact_collider draw_body(random_stream *random)
{
    const double a = random_log(random, 0.05, 0.6), c = random_log(random, 0.05, 0.6), m = random_log(random, 0.1, 10);
    return (impact_collider){.mass = m,
                             .moments = {m * (a + c), m * a, m * c},
                             .orientation = random_rotation(random),
                             .velocity = random_vector(random, 0.1, 1),
                             .omega = random_vector(random, 0.1, 1)};
}

/* A blow that comes to `towards`; returns its u_n. With `rests` the second body is static. */
static double draw(random_stream *random, bool rests, bool approaches, blow *b)
{
    double u;
    do {
        *b = (blow){.bodies = {draw_body(random), draw_body(random)}};
        if (rests)
            b->bodies[1] = (impact_collider){.mass = INFINITY, .moments = {1, 1, 1}, .orientation = {1, 0, 0, 0}};
        b->meeting = (impact_meeting){.body1 = 0,
                                      .body2 = 1,
                                      .normal = random_direction(random),
                                      .offset1 = random_vector(random, 0.1, 1),
                                      .offset2 = random_vector(random, 0.1, 1),
                                      .friction = random_log(random, 0.1, 2),
                                      .restitution = 0.5,
                                      .stiffness = 1};
        const qvec3 v[2] = {b->bodies[0].velocity, b->bodies[1].velocity},
                    w[2] = {b->bodies[0].omega, b->bodies[1].omega};
        u = qvec3_dot(b->meeting.normal, relative(b, v, w));
    } while (fabs(u) < 0.1 || (u < 0) != approaches);
    return u;
}

static double receipt(blow *b, impact_together_law law)
{
    b->encounter = (impact_encounter){
        .bodies = b->bodies, .body_count = 2, .meetings = &b->meeting, .meeting_count = 1, .law = law};
    return imp_encounter_receipt(&b->encounter, &b->outcome);
}

/* A thousandth of what is there may not pass by far. */
static const double noticed = 1e-5, right = 1e-14;

static void each_identity_is_missed_in_turn(void **state)
{
    (void)state;
    random_stream random = {71};
    for (int run = 0; run < 2000; run++) {
        blow b;
        const double u = draw(&random, run % 2, true, &b), light = lightness(&b);
        const qvec3 n = b.meeting.normal, good = qvec3_scale(n, -1.5 * u / light); /* u_n' = -u_n/2 */
        qvec3 across;
        assert_int_equal(qvec3_normalize(qvec3_cross(n, random_direction(&random)), &across), QUAT_OK);
        const impact_together_law law = run % 4 < 2 ? IMPACT_TOGETHER_SPRINGS : IMPACT_TOGETHER_MOREAU;
        strike(&b, good);
        assert_at_most(receipt(&b, law), right);
        /* momentum and spin of the first body */
        b.velocity[0] = qvec3_axpy(1e-3 * qvec3_norm(b.velocity[0]), random_direction(&random), b.velocity[0]);
        assert_true(receipt(&b, law) > noticed);
        strike(&b, good);
        b.omega[0] = qvec3_axpy(1e-3 * qvec3_norm(b.omega[0]), random_direction(&random), b.omega[0]);
        assert_true(receipt(&b, law) > noticed);
        /* energies, and the works' sum */
        strike(&b, good);
        b.outcome.energy_after *= 1.001;
        assert_true(receipt(&b, law) > noticed);
        strike(&b, good);
        b.own.work_compression += 1e-3 * b.outcome.energy_before;
        assert_true(receipt(&b, law) > noticed);
        /* an impulse out of its cone, and one that does not part them; all else is right */
        strike(&b, qvec3_axpy(1.01 * b.meeting.friction * qvec3_norm(good), across, good));
        assert_true(receipt(&b, law) > noticed);
        strike(&b, qvec3_scale(good, 0.6));
        assert_true(receipt(&b, law) > noticed);
        /* NaN never passes */
        strike(&b, good);
        b.omega[0].y = NAN;
        assert_false(receipt(&b, law) <= 1);
    }
}

/* One that pulls, and leaves them parting. */
static void contacts_do_not_pull(void **state)
{
    (void)state;
    random_stream random = {73};
    for (int run = 0; run < 500; run++) {
        blow b;
        const double u = draw(&random, run % 2, false, &b), light = lightness(&b);
        strike(&b, qvec3_scale(b.meeting.normal, -0.5 * u / light));
        assert_true(receipt(&b, IMPACT_TOGETHER_MOREAU) > 0.1);
        strike(&b, (qvec3){0, 0, 0});
        assert_at_most(receipt(&b, IMPACT_TOGETHER_MOREAU), right);
    }
}

/* By springs no work is left over, and friction's is none that is gained. */
static void springs_give_nothing(void **state)
{
    (void)state;
    random_stream random = {79};
    for (int run = 0; run < 500; run++) {
        blow b;
        const double u = draw(&random, run % 2, true, &b), light = lightness(&b);
        strike(&b, qvec3_scale(b.meeting.normal, -2.1 * u / light)); /* u_n' = -1.1 u_n */
        assert_true(receipt(&b, IMPACT_TOGETHER_SPRINGS) > noticed);
        assert_at_most(receipt(&b, IMPACT_TOGETHER_MOREAU), right);
        strike(&b, qvec3_scale(b.meeting.normal, -1.5 * u / light));
        b.own.work_friction = 1e-3 * b.outcome.energy_before, b.own.work_compression -= b.own.work_friction;
        assert_true(receipt(&b, IMPACT_TOGETHER_SPRINGS) > noticed);
        assert_at_most(receipt(&b, IMPACT_TOGETHER_MOREAU), right);
    }
}

/* A light blow on what goes by: an impulse along it by a rounding of the momentum is none, a thousand times as large it
 * is friction where there should be none. */
static void roundings_of_momentum_are_none(void **state)
{
    (void)state;
    random_stream random = {89};
    for (int run = 0; run < 500; run++) {
        blow b;
        const double u = draw(&random, run % 2, true, &b), light = lightness(&b), blows = 1e-10;
        const qvec3 n = b.meeting.normal, good = qvec3_scale(n, 1.5 * blows / light);
        qvec3 across;
        b.meeting.friction = 0;
        b.bodies[0].velocity = qvec3_axpy(-u - blows, n, b.bodies[0].velocity);
        const double mass = fmin(b.bodies[0].mass, b.bodies[1].mass);
        assert_int_equal(qvec3_normalize(qvec3_cross(n, random_direction(&random)), &across), QUAT_OK);
        strike(&b, qvec3_axpy(1e-15 * mass, across, good));
        assert_at_most(receipt(&b, IMPACT_TOGETHER_MOREAU), 1e-11);
        strike(&b, qvec3_axpy(1e-12 * mass, across, good));
        assert_true(receipt(&b, IMPACT_TOGETHER_MOREAU) > 1e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_identity_is_missed_in_turn),
                                       cmocka_unit_test(contacts_do_not_pull), cmocka_unit_test(springs_give_nothing),
                                       cmocka_unit_test(roundings_of_momentum_are_none)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
