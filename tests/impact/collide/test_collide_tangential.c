/* SPDX-License-Identifier: MIT
 *
 * Painleve's rod: a uniform rod of length 2 and mass 1 leans at theta and slides on its lower end r = -(cos theta,
 * sin theta) towards its lean. With K_zz = 1 + 3 cos^2, K_xx = 1 + 3 sin^2, K_xz = -3 sin cos of that end and slip to
 * -x
 *
 *     d(u_n)/dp = K_zz + mu K_xz = -a < 0       from mu > (1 + 3 cos^2)/(3 sin cos) on, 4/3 at the least
 *     slip s stops after p1 = s/(mu K_xx + K_xz), when u_n = -a p1; then it sticks, d(u_n)/dp = g = K_zz - K_xz^2/K_xx,
 *     for p2 = a p1/g to the end of compression, and eps (p1 + p2) of restitution (Poisson),
 *     sqrt(eps^2 a p1 (p1 + p2)/g) (Stronge)
 */
#include <string.h>

#include <impact/collide.h>
#include <quat/rotation.h>
#include "kit/contact_random.h"
#include "kit/near.h"

static impact_collision rod_of(double theta, double friction, double slip, quat turned)
{
    const double c = cos(theta), s = sin(theta);
    /* the rod along its first axis, which then is at (c, 0, s) */
    const quat lean = {cos(theta / 2), 0, -sin(theta / 2), 0};
    const impact_collider floor = {.mass = INFINITY, .orientation = {1, 0, 0, 0}},
                          rod = {.mass = 1,
                                 .moments = {1e-6, 1.0 / 3, 1.0 / 3},
                                 .orientation = quat_mul(turned, lean),
                                 .offset = quat_rotate(turned, (qvec3){-c, 0, -s}),
                                 .velocity = quat_rotate(turned, (qvec3){slip, 0, 0})};
    return (impact_collision){
        .body = {rod, floor}, .normal = quat_rotate(turned, (qvec3){0, 0, 1}), .friction = friction, .pressed = true};
}

static void the_rod_is_stopped_as_the_closed_form_has_it(void **state)
{
    (void)state;
    random_stream random = {17};
    int jammed = 0;
    for (int run = 0; run < 3000; run++) {
        const double theta = 0.05 + 1.45 * random_unit(&random), mu = random_log(&random, 0.5, 20),
                     speed = random_log(&random, 1e-6, 1e6), eps = run % 3 == 0 ? 0 : random_unit(&random);
        const quat turned = random_rotation(&random);
        impact_collision collision = rod_of(theta, mu, -speed, turned);
        collision.restitution = eps;
        collision.law = run % 2 ? IMPACT_STRONGE : IMPACT_POISSON;
        if (run % 5 == 0) { /* the floor first */
            const impact_collider rod = collision.body[0];
            collision.body[0] = collision.body[1], collision.body[1] = rod;
            collision.normal = qvec3_neg(collision.normal);
        }
        const double c = cos(theta), s = sin(theta), zz = 1 + 3 * c * c, xx = 1 + 3 * s * s, xz = -3 * s * c;
        const double a = -(zz + mu * xz), g = zz - xz * xz / xx;
        impact_outcome o;
        const impact_status status = impact_collide(&collision, &o);
        if (a <= 1e-6) {
            if (a < -1e-6) assert_int_equal(status, IMPACT_SEPARATING);
            continue;
        }
        jammed++;
        assert_int_equal(status, IMPACT_OK);
        const double p1 = speed / (mu * xx + xz), p2 = a * p1 / g;
        const double more = run % 2 ? sqrt(eps * eps * a * p1 * (p1 + p2) / g) : eps * (p1 + p2);
        const double normal = p1 + p2 + more, across = mu * p1 - xz / xx * (p2 + more);
        const qvec3 on_rod = run % 5 == 0 ? qvec3_neg(o.impulse) : o.impulse;
        assert_near3(qvec3_scale(quat_rotate_inverse(turned, on_rod), 1 / normal), (qvec3){across / normal, 0, 1},
                     1e-12);
        assert_near(o.normal_after / speed, g * more / speed, 1e-12 * (1 + a));
        assert_int_equal(o.phases[0], IMPACT_TANGENTIAL);
        assert_int_equal(o.phases[1], IMPACT_STICK_C);
        assert_int_equal(o.phase_count, eps > 0 ? 3 : 2);
        assert_true(o.energy_after < o.energy_before);
        impact_receipt receipt;
        assert_true(impact_collide_receipt(&collision, &o, &receipt) < 1e4);
    }
    assert_true(jammed > 800);
}

/* Without `pressed`, sliding away from its lean, approaching or parting it is what it was. */
static void all_else_is_as_before(void **state)
{
    (void)state;
    impact_outcome o, plain;
    impact_collision away = rod_of(1, 4, 1, quat_identity()), free = rod_of(1, 4, -1, quat_identity());
    assert_int_equal(impact_collide(&away, &o), IMPACT_SEPARATING);
    free.pressed = false;
    assert_int_equal(impact_collide(&free, &o), IMPACT_SEPARATING);
    for (int k = 0; k < 2; k++) {
        impact_collision moves = rod_of(1, 4, -1, quat_identity());
        moves.body[0].velocity.z = k ? 1e-3 : -1e-3;
        const impact_status status = impact_collide(&moves, &o);
        moves.pressed = false;
        assert_int_equal(impact_collide(&moves, &plain), status);
        assert_memory_equal(&o.impulse, &plain.impulse, sizeof o.impulse);
        assert_memory_equal(o.velocity, plain.velocity, sizeof o.velocity);
        assert_memory_equal(o.omega, plain.omega, sizeof o.omega);
    }
    impact_collision bad = rod_of(1, 4, -1, quat_identity());
    bad.friction = -1;
    assert_int_equal(impact_collide(&bad, &o), IMPACT_EARGUMENT);
    assert_string_equal(impact_phase_name(IMPACT_TANGENTIAL), "tangential");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rod_is_stopped_as_the_closed_form_has_it),
        cmocka_unit_test(all_else_is_as_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
