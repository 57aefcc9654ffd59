/* SPDX-License-Identifier: MIT
 *
 * The door of the room collide: answers known on paper, bad input, and what an outcome says.
 */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include <impact/collide.h>
#include "kit/allocations.h"
#include "generators/collide_cases.h"
#include "generators/collide_scenes.h"
#include "kit/near.h"

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

static void sphere_at_any_speed(void **state)
{
    (void)state;
    /* Velocities so large or small that squares of theirs are not numbers: the answer keeps its bits, and so does
     * friction; energies must still be numbers. */
    const impact_collision c = sphere_on_plane((qvec3){4, 1, -2}, (qvec3){1, -2, 5}, 0.25, 0.3);
    impact_outcome o, far;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    for (int sign = -1; sign <= 1; sign += 2) {
        const double f = sign < 0 ? 0x1p-530 : 0x1p505;
        impact_collision d = c;
        d.body[0].velocity = qvec3_scale(c.body[0].velocity, f);
        d.body[0].omega = qvec3_scale(c.body[0].omega, f);
        assert_int_equal(impact_collide(&d, &far), IMPACT_OK);
        assert_near3(qvec3_scale(far.velocity[0], 1 / f), o.velocity[0], 1e-15);
        assert_near3(qvec3_scale(far.omega[0], 1 / f), o.omega[0], 1e-14);
    }
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
        assert_near(contact, i <= 20 ? 0 : tangent - limit, 1e-15 * (1 + tangent));
        if (i <= 20) assert_near(o.velocity[0].x, 5.0 / 7 * tangent, 1e-15 * (1 + tangent));
        if (i != 20) assert_int_equal(o.phases[o.phase_count - 1], i < 20 ? IMPACT_STICK_R : IMPACT_SLIP_R);
        assert_near(o.velocity[0].z, eps, 1e-15);
    }
}

static void rebound_off_a_wall(void **state)
{
    (void)state;
    /* Sliding throughout, e_t = 1 - mu (1 + eps) cot(incidence): .894 for aluminium oxide at 60 degrees. */
    const double angle = 60 * acos(-1) / 180, mu = 0.092, eps = 0.98;
    const impact_collision c = sphere_on_plane((qvec3){sin(angle), 0, -cos(angle)}, (qvec3){0, 0, 0}, mu, eps);
    impact_outcome o;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    assert_near(o.velocity[0].x / sin(angle), 1 - mu * (1 + eps) / tan(angle), 1e-15);
    assert_near(o.velocity[0].x / sin(angle), 0.894, 1e-3);
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

/* ---- invariance ---- */

typedef impact_collision changed(impact_collision c);
typedef void changed_back(impact_outcome *o);

/* The answer to the changed impact, changed back, against the first: off by so many roundings of the data of either,
 * and of M. */
static void assert_invariant(changed *change, changed_back *back, double roundings)
{
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 500; i++) {
            const impact_collision c = case_make((case_class)class_, 53, i), d = change(c);
            impact_outcome o, other;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            assert_int_equal(impact_collide(&d, &other), IMPACT_OK);
            back(&other);
            const double off = case_error(&c, other.velocity, other.omega, o.velocity, o.omega);
            const double follows = impact_collide_sensitivity(&c) + impact_collide_sensitivity(&d) + o.conditioning;
            const double allowed = roundings * DBL_EPSILON * (1 + follows);
            if (!(off <= allowed))
                fail_msg("%s %d: off by %.3g, allowed %.3g", case_name((case_class)class_), (int)i, off, allowed);
            assert_near(other.energy_after, o.energy_after, allowed * o.energy_before);
            assert_int_equal(other.compressions, o.compressions);
        }
}

static const quat any_turn = {0.5, -0.5, 0.1, 0.7};

static impact_collision rotated(impact_collision c)
{
    c.normal = quat_rotate(any_turn, c.normal);
    for (int i = 0; i < 2; i++) {
        impact_collider *b = &c.body[i];
        b->orientation = quat_mul(any_turn, b->orientation);
        b->offset = quat_rotate(any_turn, b->offset);
        b->velocity = quat_rotate(any_turn, b->velocity);
        b->omega = quat_rotate(any_turn, b->omega);
    }
    return c;
}

static void rotated_back(impact_outcome *o)
{
    for (int i = 0; i < 2; i++) {
        o->velocity[i] = quat_rotate_inverse(any_turn, o->velocity[i]);
        o->omega[i] = quat_rotate_inverse(any_turn, o->omega[i]);
    }
}

static impact_collision swapped(impact_collision c)
{
    const impact_collider first = c.body[0];
    c.body[0] = c.body[1];
    c.body[1] = first;
    c.normal = qvec3_neg(c.normal);
    return c;
}

static void swapped_back(impact_outcome *o)
{
    const qvec3 v = o->velocity[0], w = o->omega[0];
    o->velocity[0] = o->velocity[1];
    o->omega[0] = o->omega[1];
    o->velocity[1] = v;
    o->omega[1] = w;
}

/* Lengths by 2^7, times by 2^-3, masses by 2^-12: no number is rounded by it, nor its root. */
static impact_collision other_units(impact_collision c)
{
    for (int i = 0; i < 2; i++) {
        impact_collider *b = &c.body[i];
        b->mass *= 0x1p-12;
        b->moments = qvec3_scale(b->moments, 0x1p2);
        b->offset = qvec3_scale(b->offset, 0x1p7);
        b->velocity = qvec3_scale(b->velocity, 0x1p10);
        b->omega = qvec3_scale(b->omega, 0x1p3);
    }
    return c;
}

static void units_back(impact_outcome *o)
{
    for (int i = 0; i < 2; i++) {
        o->velocity[i] = qvec3_scale(o->velocity[i], 0x1p-10);
        o->omega[i] = qvec3_scale(o->omega[i], 0x1p-3);
    }
    o->energy_after *= 0x1p-8;
}

static void rotated_is_the_same(void **state)
{
    (void)state;
    assert_invariant(rotated, rotated_back, 6);
}

static void swapped_is_the_same(void **state)
{
    (void)state;
    assert_invariant(swapped, swapped_back, 1);
}

static void in_other_units_is_the_same(void **state)
{
    (void)state;
    assert_invariant(other_units, units_back, 0);
}

/* Each body's change of momentum and angular momentum is the impulse and its moment. */
static void momentum_is_the_impulse(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        const impact_collision c = case_make(CASE_PLAIN, 59, i);
        impact_outcome o;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        for (int b = 0; b < 2; b++) {
            const impact_collider *body = &c.body[b];
            if (isinf(body->mass)) continue;
            const qvec3 p = b == 0 ? o.impulse : qvec3_neg(o.impulse), j = body->moments;
            const double rounding = 1e-15 * (body->mass + qvec3_norm(p));
            assert_near3(qvec3_scale(qvec3_sub(o.velocity[b], body->velocity), body->mass), p, rounding);
            const qvec3 dw = quat_rotate_inverse(body->orientation, qvec3_sub(o.omega[b], body->omega));
            const qvec3 dl = quat_rotate(body->orientation, (qvec3){j.x * dw.x, j.y * dw.y, j.z * dw.z});
            assert_near3(dl, qvec3_cross(body->offset, p), rounding);
        }
    }
}

/* Two equal solid spheres, oblique: M = diag(7/2, 7/2, 1) 2/m. */
static void two_spheres_by_hand(void **state)
{
    (void)state;
    for (int sticks = 0; sticks < 2; sticks++) {
        const impact_collision c = scene_two_spheres(sticks);
        const impact_collider *one = &c.body[0], *two = &c.body[1];
        impact_outcome o;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        const qvec3 n = c.normal, u1 = qvec3_add(one->velocity, qvec3_cross(one->omega, one->offset));
        const qvec3 u = qvec3_sub(u1, qvec3_add(two->velocity, qvec3_cross(two->omega, two->offset)));
        const double uz = qvec3_dot(u, n), p = -uz * 2 * 1.3;
        const qvec3 ut = qvec3_axpy(-uz, n, u);
        const double s = qvec3_norm(ut), most = 0.25 * p, stop = s * 2 * 2 / 7;
        assert_int_equal(stop < most, sticks);
        const qvec3 P = qvec3_axpy(-fmin(stop, most) / s, ut, qvec3_scale(n, p));
        assert_near3(o.impulse, P, 1e-14);
        assert_near3(o.velocity[0], qvec3_axpy(0.25, P, one->velocity), 1e-14);
        assert_near3(o.omega[1], qvec3_axpy(-1 / 0.144, qvec3_cross(two->offset, P), two->omega), 1e-13);
    }
}

static void words_for_all(void **state)
{
    (void)state;
    assert_string_equal(impact_law_name(IMPACT_STRONGE), "stronge");
    assert_string_equal(impact_solver_name(IMPACT_SOLVER_CLOSED_FORM), "closed form");
    assert_string_equal(impact_phase_name(IMPACT_REVERSAL), "reversal");
    assert_string_equal(impact_phase_name((impact_phase)77), "unknown");
}

/* However ill-conditioned M is, a contact that sticks ends with u = uz n, to the rounding of the velocities it is made
 * of. */
static void what_sticks_is_at_rest(void **state)
{
    (void)state;
    int stuck = 0;
    for (uint64_t i = 0; i < 6000; i++) {
        const impact_collision c = case_make(CASE_WILD, 31, i);
        impact_outcome o;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        const int last = o.phases[o.phase_count - 1];
        if (last != IMPACT_STICK_C && last != IMPACT_STICK_R) continue;
        qvec3 u = {0, 0, 0};
        double size = 0;
        for (int b = 0; b < 2; b++) {
            const qvec3 r = c.body[b].offset, spin = qvec3_cross(o.omega[b], r);
            u = qvec3_axpy(b == 0 ? 1 : -1, qvec3_add(o.velocity[b], spin), u);
            size += qvec3_norm(o.velocity[b]) + qvec3_norm(o.omega[b]) * qvec3_norm(r);
        }
        const qvec3 wanted = qvec3_scale(c.normal, o.normal_after / qvec3_norm(c.normal));
        assert_true(qvec3_norm(qvec3_sub(u, wanted)) < 100 * 0x1p-52 * (size - o.normal_before));
        stuck++;
    }
    assert_true(stuck > 1000);
}

/* By impact_collide, nor by CVODE's road once it has a workspace (what SUNDIALS does inside is its own). */
static void nothing_is_allocated(void **state)
{
    (void)state;
    const bool cvode = impact_has(IMPACT_PART_CVODE);
    impact_collide_workspace *workspace = NULL;
    if (cvode) assert_int_equal(impact_collide_workspace_create(IMPACT_ODE_ADAMS, 1e-9, &workspace), IMPACT_OK);
    void *volatile block = malloc(1);
    free(block);
    assert_true(allocations > 0); /* the count works */
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 300; i++) {
            impact_collision c = case_make((case_class)class_, 41, i);
            c.workspace = workspace;
            if (cvode && i < 10) c.solver = IMPACT_SOLVER_CVODE;
            impact_outcome o;
            const long before = allocations;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            assert_int_equal(allocations, before);
        }
    impact_collide_workspace_destroy(workspace);
}

/* Near the end of double precision: an answer in finite numbers, or a refusal. */
static void nothing_overflows_unsaid(void **state)
{
    (void)state;
    uint64_t g = 5;
    int refused = 0;
    for (int i = 0; i < 4000; i++) {
        impact_collision c = case_make(i % 2 ? CASE_PLAIN : CASE_SPHERE, 19, (uint64_t)i);
        const double size = pow(10, 150 + 8 * case_random(&g));
        for (int k = 0; k < 2; k++) {
            const double most = DBL_MAX / (4 + qvec3_norm(c.body[k].velocity));
            c.body[k].velocity = qvec3_scale(c.body[k].velocity, fmin(size, most));
            c.body[k].omega = (qvec3){0, 0, 0};
        }
        impact_outcome o;
        const impact_status status = impact_collide(&c, &o);
        if (status < 0) {
            refused++;
            continue;
        }
        for (int k = 0; k < 2; k++) {
            const qvec3 v = o.velocity[k], w = o.omega[k];
            assert_true(isfinite(v.x) && isfinite(v.y) && isfinite(v.z));
            assert_true(isfinite(w.x) && isfinite(w.y) && isfinite(w.z));
        }
    }
    assert_true(refused > 0 && refused < 4000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_overflows_unsaid),
        cmocka_unit_test(sphere_slides),
        cmocka_unit_test(sphere_at_any_speed),
        cmocka_unit_test(what_sticks_is_at_rest),
        cmocka_unit_test(sphere_sticks_below_its_angle),
        cmocka_unit_test(rebound_off_a_wall),
        cmocka_unit_test(plastic_and_smooth),
        cmocka_unit_test(bad_input_is_named),
        cmocka_unit_test(separating_bodies_stay_as_they_are),
        cmocka_unit_test(rotated_is_the_same),
        cmocka_unit_test(swapped_is_the_same),
        cmocka_unit_test(in_other_units_is_the_same),
        cmocka_unit_test(momentum_is_the_impulse),
        cmocka_unit_test(two_spheres_by_hand),
        cmocka_unit_test(words_for_all),
        cmocka_unit_test(nothing_is_allocated),
    };
    return cmocka_run_group_tests_name("impact collide", tests, NULL, NULL);
}
