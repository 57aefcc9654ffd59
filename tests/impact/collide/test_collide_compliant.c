/* SPDX-License-Identifier: MIT
 *
 * Tangential compliance: against the rebound of real spheres, against plain time stepping with the force returned to
 * the cone, Garwin's superball, and in the limit of a rigid contact. CVODE's relative tolerance is 1e-12 where none is
 * given.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "collide/collide_frame.h"
#include "generators/collide_cases.h"

static double rebound_angle(double degrees, double compliance)
{
    const double angle = degrees * acos(-1) / 180, r = 2.5e-3, j = 0.4 * r * r;
    const impact_collision c = {
        .body = {{1, {j, j, j}, {1, 0, 0, 0}, {0, 0, -r}, {3.9 * sin(angle), 0, -3.9 * cos(angle)}, {0, 0, 0}},
                 {.mass = INFINITY, .orientation = {1, 0, 0, 0}}},
        .normal = {0, 0, 1},
        .friction = 0.092,
        .restitution = 0.98,
        .law = IMPACT_STRONGE,
        .tangential_compliance = compliance};
    impact_outcome o;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    return atan2(o.velocity[0].x, o.velocity[0].z) * 180 / acos(-1);
}

/* 5 mm aluminium-oxide spheres on soda-lime glass (Kharaz, Gorham & Salman 2001). Nothing is fitted: eta^2 = E* / 4 G*
 * from the elastic constants, E = 380 and 70 GPa, nu = .23 and .25 (Mindlin 1949). */
static void kharaz_spheres(void **state)
{
    (void)state;
    static const double measured[6][2] = {{4.2922, 2.9577},   {9.9429, 6.6917},   {20.5594, 12.3645},
                                          {30.3767, 21.7809}, {39.6233, 32.5455}, {60.0571, 57.3652}};
    const double normal = 1 / ((1 - 0.23 * 0.23) / 380 + (1 - 0.25 * 0.25) / 70);
    const double shear = 1 / ((2 - 0.23) * 2 * 1.23 / 380 + (2 - 0.25) * 2 * 1.25 / 70),
                 compliance = normal / (4 * shear);
    assert_true(fabs(compliance - 1.164) < 5e-4);
    double worst = 0, worst_rigid = 0;
    for (int i = 0; i < 6; i++) {
        const double off = fabs(rebound_angle(measured[i][0], compliance) - measured[i][1]);
        const double rigid = fabs(rebound_angle(measured[i][0], 0) - measured[i][1]);
        worst = fmax(worst, off);
        worst_rigid = fmax(worst_rigid, rigid);
        /* What slides throughout does not feel it. */
        if (measured[i][0] > 35) assert_true(fabs(off - rigid) < 1e-6);
    }
    assert_true(worst < 0.9);
    assert_true(worst_rigid > 2.5);
}

/* The same contact by small steps of time: f moves by -k u_t dt and is brought back to the cone. Of first order. */
static bool by_small_steps(const impact_collision *c, qvec3 *impulse, double dt)
{
    imp_ready ready;
    imp_frame m;
    imp_ready_make(c, &ready);
    imp_frame_principal(imp_frame_normal(c), &ready, &m);
    const qvec3 u0 = imp_ready_velocity(&ready);
    const double start[3] = {qvec3_dot(u0, m.t1), qvec3_dot(u0, m.t2), qvec3_dot(u0, m.n)},
                 k = 1 / c->tangential_compliance;
    double P[3] = {0, 0, 0}, f[2] = {0, 0}, delta = 0, delta_c = 0;
    const double e2 = c->restitution * c->restitution;
    for (long step = 0; step < 40000000; step++) {
        const double ux = start[0] + m.a * P[0] + m.c * P[2], uy = start[1] + m.b * P[1] + m.d * P[2];
        const double uz = start[2] + m.c * P[0] + m.d * P[1] + P[2];
        delta -= uz * dt;
        if (delta > delta_c) delta_c = delta;
        const double F = delta_c - (delta_c - delta) / e2;
        if (F <= 0 && uz > 0) {
            const double unit = 1 / m.scale;
            *impulse =
                qvec3_add(qvec3_scale(m.n, P[2] * unit), qvec3_axpy(P[0] * unit, m.t1, qvec3_scale(m.t2, P[1] * unit)));
            return true;
        }
        f[0] -= k * ux * dt;
        f[1] -= k * uy * dt;
        const double size = sqrt(f[0] * f[0] + f[1] * f[1]), most = c->friction * fmax(F, 0);
        if (size > most) f[0] *= most / size, f[1] *= most / size;
        P[0] += f[0] * dt;
        P[1] += f[1] * dt;
        P[2] += F * dt;
    }
    return false;
}

static void time_stepping(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        impact_collision c = case_make(i % 3 ? CASE_PLAIN : CASE_ROD, 61, i);
        c.law = IMPACT_STRONGE;
        c.restitution = 0.3 + 0.7 * c.restitution;
        c.friction = 0.05 + c.friction;
        c.tangential_compliance = 0.5 + (double)(i % 5) / 3;
        impact_outcome o;
        qvec3 P = {NAN, NAN, NAN};
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        assert_true(by_small_steps(&c, &P, 2e-5));
        const double off = qvec3_norm(qvec3_sub(P, o.impulse)) / qvec3_norm(P);
        if (!(off < 1e-5)) fail_msg("case %d: impulse off by %.3g of it", (int)i, off);
    }
}

/* Random impacts of every class: an answer, no gain of energy, inside of the cone, Stronge's restitution of the normal
 * work. */
static void always_an_answer(void **state)
{
    (void)state;
    impact_collide_workspace *ws;
    assert_int_equal(impact_collide_workspace_create(IMPACT_ODE_BDF, 1e-9, &ws), IMPACT_OK);
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 60; i++) {
            impact_collision c = case_make((case_class)class_, 67, i);
            c.law = IMPACT_STRONGE;
            c.tangential_compliance = 1.2;
            c.workspace = ws;
            impact_outcome o;
            const impact_status status = impact_collide(&c, &o);
            if (status != IMPACT_OK)
                fail_msg("%s %d: %s", case_name((case_class)class_), (int)i, impact_status_string(status));
            assert_true(o.energy_after <= o.energy_before * (1 + 1e-14));
            assert_true(o.impulse_tangential <= c.friction * o.impulse_normal * (1 + 1e-14));
            assert_true(o.normal_after >= 0);
            if (o.compressions > 1) continue;
            const double given_back = -c.restitution * c.restitution * o.work_compression;
            assert_true(fabs(o.work_restitution - given_back) <= 1e-6 * -o.work_compression);
        }
    impact_collide_workspace_destroy(ws);
}

static qvec3 velocity_of(const impact_collision *c)
{
    imp_ready ready;
    imp_ready_make(c, &ready);
    return imp_ready_velocity(&ready);
}

/* Garwin's superball (1969): eta^2 = 7/2 makes the tangential spring swing in time with the normal one, so that a solid
 * sphere keeps its energy and sends its contact velocity back; the second bounce undoes the first but for the sign of
 * the first's spin and slip. */
static void superball(void **state)
{
    (void)state;
    const double r = 0.02, m = 0.05, j = 0.4 * m * r * r;
    impact_collision c = {.body = {{m, {j, j, j}, {1, 0, 0, 0}, {0, 0, -r}, {1.5, 0.4, -2}, {10, -20, 5}},
                                   {.mass = INFINITY, .orientation = {1, 0, 0, 0}}},
                          .normal = {0, 0, 1},
                          .friction = 5,
                          .restitution = 1,
                          .law = IMPACT_STRONGE,
                          .tangential_compliance = 3.5};
    impact_outcome o;
    const qvec3 v = c.body[0].velocity, w = c.body[0].omega;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    const qvec3 before = velocity_of(&c);
    c.body[0].velocity = o.velocity[0];
    c.body[0].omega = o.omega[0];
    const qvec3 after = velocity_of(&c);
    assert_true(qvec3_norm(qvec3_add(before, after)) < 1e-9);
    assert_true(fabs(o.energy_after - o.energy_before) < 1e-10 * o.energy_before);
    c.body[0].velocity.z = -o.velocity[0].z;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    assert_true(fabs(o.velocity[0].x - v.x) < 1e-9 && fabs(o.velocity[0].y - v.y) < 1e-9);
    assert_true(qvec3_norm(qvec3_sub(o.omega[0], w)) < 1e-9 / r);
}

static double off_rigid(impact_collision c, const impact_outcome *rigid, double compliance)
{
    impact_outcome o;
    c.tangential_compliance = compliance;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    return case_error(&c, o.velocity, o.omega, rigid->velocity, rigid->omega);
}

/* A stiff contact comes near the rigid answer in proportion to its compliance: a hundredth of it, a hundredth of the
 * way, in the mean of the logarithms. */
static void stiff_is_rigid(void **state)
{
    (void)state;
    enum { COUNT = 50 };
    double ratio = 0;
    for (uint64_t i = 0; i < COUNT; i++) {
        impact_collision c = case_make(CASE_PLAIN, 71, i);
        c.law = IMPACT_STRONGE;
        impact_outcome rigid;
        assert_int_equal(impact_collide(&c, &rigid), IMPACT_OK);
        const double stiff = off_rigid(c, &rigid, 1e-4);
        assert_true(stiff < 5e-3);
        ratio += log10(stiff / off_rigid(c, &rigid, 1e-2)) / COUNT;
    }
    assert_true(fabs(ratio + 2) < 0.2);
}

/* What hardly gives back leaves an answer in proportion from that which gives nothing. */
static void small_restitutions(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 20; i++) {
        impact_collision c = case_make(CASE_PLAIN, 73, i);
        c.law = IMPACT_STRONGE;
        c.tangential_compliance = 0.1 + (double)(i % 5);
        c.restitution = 0;
        impact_outcome dead, o;
        assert_int_equal(impact_collide(&c, &dead), IMPACT_OK);
        for (c.restitution = 1e-9; c.restitution < 2e-3; c.restitution *= 10) {
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            assert_true(case_error(&c, o.velocity, o.omega, dead.velocity, dead.omega) < 3 * c.restitution + 1e-9);
            assert_true(o.energy_after <= o.energy_before * (1 + 1e-14));
        }
    }
}

int main(void)
{
    if (!impact_has(IMPACT_PART_CVODE)) return 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kharaz_spheres),   cmocka_unit_test(superball),      cmocka_unit_test(time_stepping),
        cmocka_unit_test(always_an_answer), cmocka_unit_test(stiff_is_rigid), cmocka_unit_test(small_restitutions),
    };
    return cmocka_run_group_tests_name("impact collide_compliant", tests, NULL, NULL);
}
