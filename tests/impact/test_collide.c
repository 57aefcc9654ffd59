/* SPDX-License-Identifier: MIT
 *
 * The door of the room collide: answers known on paper, bad input, and what an outcome says.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>

#include <impact/collide.h>

static void assert_near(double got, double wanted, double tolerance)
{
    if (fabs(got - wanted) <= tolerance) return;
    fail_msg("wanted %.17g, got %.17g: off by %.3g, allowed %.3g", wanted, got, fabs(got - wanted), tolerance);
}

static void assert_near3(qvec3 got, qvec3 wanted, double tolerance)
{
    assert_near(got.x, wanted.x, tolerance);
    assert_near(got.y, wanted.y, tolerance);
    assert_near(got.z, wanted.z, tolerance);
}

/* A solid sphere of radius .3 m and 4 kg on the plane z = 0. */
static impact_collision sphere_on_plane(qvec3 v, qvec3 omega, double mu, double eps)
{
    const double j = 0.4 * 4 * 0.09;
    return (impact_collision){
        .body = {{4, {j, j, j}, {1, 0, 0, 0}, {0, 0, -0.3}, v, omega}, {.mass = INFINITY, .orientation = {1, 0, 0, 0}}},
        .normal = {0, 0, 1},
        .friction = mu,
        .restitution = eps};
}

static void sphere_slides(void **state)
{
    (void)state;
    /* Contact velocity (4 + .6, 1 + .3, -2): p = m (1 + eps) 2 = 10.4, friction .25 p against the sliding direction. */
    const impact_collision c = sphere_on_plane((qvec3){4, 1, -2}, (qvec3){1, -2, 5}, 0.25, 0.3);
    impact_outcome o;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    const double s = sqrt(4.6 * 4.6 + 1.3 * 1.3), fx = -0.25 * 10.4 * 4.6 / s, fy = -0.25 * 10.4 * 1.3 / s, j = 0.144;
    assert_near3(o.velocity[0], (qvec3){4 + fx / 4, 1 + fy / 4, 0.6}, 2e-15);
    assert_near3(o.omega[0], (qvec3){1 + 0.3 * fy / j, -2 - 0.3 * fx / j, 5}, 1e-14);
    assert_near(o.compression_impulse, 8, 1e-14);
    assert_near(o.impulse_normal, 10.4, 1e-14);
    assert_near(o.impulse_tangential, 2.6, 1e-14);
    assert_near(o.work_compression, -8, 1e-14);
    assert_near(o.work_restitution, 0.72, 1e-14);
    assert_near(o.energy_after - o.energy_before, o.work_compression + o.work_restitution + o.work_friction, 1e-13);
    assert_int_equal(o.phase_count, 2);
    assert_int_equal(o.phases[0], IMPACT_SLIP_C);
    assert_int_equal(o.phases[1], IMPACT_SLIP_R);
    assert_int_equal(o.solver, IMPACT_SOLVER_CLOSED_FORM);
    assert_int_equal(o.compressions, 1);
    assert_false(o.energy_rose);
}

static void sphere_sticks_below_its_angle(void **state)
{
    (void)state;
    /* A sphere without spin sticks iff tan(incidence) <= 7/2 mu (1 + eps). */
    const double mu = 0.2, eps = 0.6, limit = 3.5 * mu * (1 + eps);
    for (int i = 1; i < 40; i++) {
        const double tangent = limit * i / 20.0;
        const impact_collision c = sphere_on_plane((qvec3){tangent, 0, -1}, (qvec3){0, 0, 0}, mu, eps);
        impact_outcome o;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        const double contact = o.velocity[0].x - 0.3 * o.omega[0].y;
        if (i <= 20) assert_near(contact, 0, 1e-15 * (1 + tangent));
        if (i <= 20) assert_near(o.velocity[0].x, 5.0 / 7 * tangent, 1e-15 * (1 + tangent));
        if (i > 20) assert_true(contact > 0.01);
        if (i < 20) assert_int_equal(o.phases[o.phase_count - 1], IMPACT_STICK_R);
        assert_near(o.velocity[0].z, eps, 1e-15);
    }
}

static void rebound_off_a_wall(void **state)
{
    (void)state;
    /* Sliding throughout, e_t = 1 - mu (1 + eps) cot(incidence). */
    const double angle = 60 * acos(-1) / 180, mu = 0.092, eps = 0.98;
    const impact_collision c = sphere_on_plane((qvec3){sin(angle), 0, -cos(angle)}, (qvec3){0, 0, 0}, mu, eps);
    impact_outcome o;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    assert_near(o.velocity[0].x / sin(angle), 1 - mu * (1 + eps) / tan(angle), 1e-15);
}

static void plastic_and_smooth(void **state)
{
    (void)state;
    impact_collision c = sphere_on_plane((qvec3){1, 0, -2}, (qvec3){0, 0, 0}, 0, 0);
    for (int law = IMPACT_POISSON; law <= IMPACT_STRONGE; law++) {
        c.law = (impact_law)law;
        impact_outcome o;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        assert_near3(o.velocity[0], (qvec3){1, 0, 0}, 0);
        assert_near3(o.omega[0], (qvec3){0, 0, 0}, 0);
        assert_int_equal(o.phase_count, 1);
    }
}

static void bad_input_is_named(void **state)
{
    (void)state;
    const impact_collision good = sphere_on_plane((qvec3){4, 1, -2}, (qvec3){1, -2, 5}, 0.25, 0.3);
    impact_collision c[12];
    for (int i = 0; i < 12; i++) c[i] = good;
    c[0].body[0].mass = -3;
    c[1].body[0].moments.y = 0;
    c[2].normal = (qvec3){0, 0, 0};
    c[3].restitution = 1.2;
    c[4].friction = -0.1;
    c[5].body[0].orientation.w = 1.5;
    c[6].body[0].mass = INFINITY;
    c[7].law = (impact_law)17;
    c[8].body[1].velocity.z = NAN;
    c[9].friction = INFINITY;
    c[10].normal.x = NAN;
    c[11].body[0].offset.y = INFINITY;
    const char *words[12] = {"body 1: mass is -3",
                             "body 1: moments are (0.144, 0, 0.144)",
                             "normal is (0, 0, 0)",
                             "restitution is 1.2",
                             "friction is -0.1",
                             "body 1: orientation has length 1.5",
                             "both bodies are static",
                             "law is 17",
                             "body 2: velocity is (0, 0, nan)",
                             "friction is inf",
                             "normal is (nan, 0, 1)",
                             "body 1: offset is (0, inf, -0.3)"};
    for (int i = 0; i < 12; i++) {
        const impact_status wanted = i < 8 ? IMPACT_EARGUMENT : IMPACT_EDOMAIN;
        char message[200];
        assert_int_equal(impact_collide_check(&c[i], message, sizeof message), wanted);
        if (!strstr(message, words[i])) fail_msg("wanted \"%s\", got \"%s\"", words[i], message);
        impact_outcome o;
        assert_int_equal(impact_collide(&c[i], &o), wanted);
        assert_memory_equal(&o.velocity[0], &c[i].body[0].velocity, sizeof o.velocity[0]);
        assert_true(isnan(o.impulse_normal));
    }
    c[3].any_restitution = true;
    impact_outcome o;
    assert_int_equal(impact_collide(&c[3], &o), IMPACT_OK);
}

static void separating_bodies_stay_as_they_are(void **state)
{
    (void)state;
    const impact_collision c = sphere_on_plane((qvec3){4, 1, 2}, (qvec3){1, -2, 5}, 0.25, 0.3);
    impact_outcome o;
    assert_int_equal(impact_collide(&c, &o), IMPACT_SEPARATING);
    assert_memory_equal(&o.velocity[0], &c.body[0].velocity, sizeof o.velocity[0]);
    assert_memory_equal(&o.omega[0], &c.body[0].omega, sizeof o.omega[0]);
    assert_near(o.normal_after, 2, 0);
    assert_near(o.impulse_normal, 0, 0);
    assert_near(o.energy_after, o.energy_before, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sphere_slides),      cmocka_unit_test(sphere_sticks_below_its_angle),
        cmocka_unit_test(rebound_off_a_wall), cmocka_unit_test(plastic_and_smooth),
        cmocka_unit_test(bad_input_is_named), cmocka_unit_test(separating_bodies_stay_as_they_are),
    };
    return cmocka_run_group_tests_name("impact collide", tests, NULL, NULL);
}
