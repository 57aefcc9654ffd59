/* SPDX-License-Identifier: MIT */
#include "oracle.h"
#include <quat/exponential.h>
#include <quat/interpolate.h>
#include <quat/rotation.h>

static const double pi = 3.14159265358979323846;

/* A unit quaternion at the given angle on S^3 from p. */
static quat at_angle(random_state *r, quat p, double angle)
{
    const qvec3 d = random_direction(r);
    quat q;
    quat_normalize(quat_mul(p, quat_exp_pure(qvec3_scale(d, angle))), &q);
    return q;
}

static double nasty_t(random_state *r, int n)
{
    return n % 4 == 0 ? random_scale(r, -300, 0) : n % 4 == 1 ? 1 - random_scale(r, -16, 0) : random_uniform(r);
}

static void slerp_is_within_its_bar(void **state)
{
    (void)state;
    random_state r = {51};
    double short_way = 0, given = 0, antipodal = 0, beyond = 0, norm = 0;
    for (int n = 0; n < 150000; n++) {
        const quat p = random_unit(&r);
        const double t = nasty_t(&r, n), small = random_scale(&r, -12, -0.1);
        const quat q = at_angle(&r, p, n % 3 ? random_between(&r, 0, 0.5 * pi - 1e-9) : small);
        const wquat want = wide_slerp(wide_quat(p), wide_quat(q), t);
        const quat got = quat_slerp(p, n % 2 ? q : quat_neg(q), t);
        worse(&short_way, error_of(got, want));
        worse(&norm, fabs(quat_norm(got) - 1) / ROUNDING);
        worse(&given, error_of(quat_slerp_as_given(p, q, t), want));

        const quat far = at_angle(&r, p, n % 3 ? random_between(&r, 0.5 * pi, pi) : pi - random_scale(&r, -8, -0.1));
        worse(n % 3 ? &given : &antipodal,
              error_of(quat_slerp_as_given(p, far, t), wide_slerp(wide_quat(p), wide_quat(far), t)));
        const double outside = random_between(&r, -2, 3);
        worse(&beyond, error_of(quat_slerp(p, q, outside), wide_slerp(wide_quat(p), wide_quat(q), outside)));
    }
    assert_bound("slerp, short way, u", short_way, 4);
    assert_bound("slerp as given, u", given, 4);
    assert_bound("slerp as given, pi - 1e-8 ..., u", antipodal, 4);
    assert_bound("|slerp| = 1, u", norm, 8);
    assert_bound("slerp, t from -2 to 3, u", beyond, 16);
}

static void ends_are_exact(void **state)
{
    (void)state;
    random_state r = {52};
    for (int n = 0; n < 100000; n++) {
        const quat p = random_unit(&r), q = random_unit(&r), near = quat_nearest(q, p);
        assert_true(quat_equal(quat_slerp(p, q, 0), p) && quat_equal(quat_slerp(p, q, 1), near));
        assert_true(quat_equal(quat_slerp_as_given(p, q, 0), p) && quat_equal(quat_slerp_as_given(p, q, 1), q));
        assert_true(quat_equal(quat_nlerp(p, q, 0), p) && quat_equal(quat_nlerp(p, q, 1), near));
        assert_true(quat_equal(quat_nlerp_as_given(p, q, 1), q));
        assert_true(quat_equal(quat_squad(p, q, p, q, 0), p) && quat_equal(quat_squad(p, q, p, q, 1), q));
        assert_true(quat_norm(quat_sub(quat_slerp(p, p, 0.3), p)) < 4e-16);
    }
    const quat one = quat_identity(), minus = {-1, 0, 0, 0};
    assert_true(quat_near(quat_slerp_as_given(one, minus, 0.5), quat_make(0, 1, 0, 0), 1e-16));
    assert_true(quat_near(quat_slerp_as_given(one, minus, 0.25), quat_make(sqrt(0.5), sqrt(0.5), 0, 0), 3e-16));
    assert_true(quat_near(quat_slerp(one, minus, 0.25), one, 0));
    assert_true(quat_equal(quat_nlerp_as_given(one, minus, 0.5), one));
    assert_true(isnan(quat_slerp(one, quat_make(NAN, 0, 0, 0), 0.5).w) && isnan(quat_slerp(one, minus, NAN).w));
    assert_true(isnan(quat_nlerp(one, quat_make(NAN, 0, 0, 0), 0.5).w));
    assert_true(isnan(quat_nlerp(one, quat_make(INFINITY, 0, 0, 0), 0.5).w));
    assert_true(isnan(quat_nlerp(quat_make(0.5, 0.5, 0.5, 0.5), quat_make(0.8, 0.6, 0, 0), INFINITY).w));
    /* opposite but for components whose squares and inverses leave the range of doubles */
    const quat almost = {-1, 3e-309, 0, 2e-310};
    assert_true(quat_near(quat_slerp_as_given(one, almost, 0.5), quat_make(0, 1, 0, 0), 1e-16));
    /* 90 degrees about z in three parts of 30 */
    const quat h = {sqrt(0.5), 0, 0, sqrt(0.5)};
    assert_true(quat_near(quat_slerp(one, h, 1.0 / 3), quat_make(cos(pi / 12), 0, 0, sin(pi / 12)), 2e-16));
}

static void slerp_keeps_its_identities(void **state)
{
    (void)state;
    random_state r = {53};
    double speed = 0, reversed = 0, halves = 0, turned = 0, power = 0;
    for (int n = 0; n < 100000; n++) {
        const quat p = random_unit(&r), q = quat_nearest(random_unit(&r), p), g = random_unit(&r);
        const double t = random_uniform(&r);
        const quat s = quat_slerp(p, q, t);
        worse(&speed, fabs(quat_distance(p, s) - t * quat_distance(p, q)));
        worse(&reversed, quat_norm(quat_sub(s, quat_slerp(q, p, 1 - t))));
        worse(&halves, quat_norm(quat_sub(quat_slerp(p, quat_slerp(p, q, 0.5), t), quat_slerp(p, q, 0.5 * t))));
        worse(&turned, quat_norm(quat_sub(quat_slerp(quat_mul(g, p), quat_mul(g, q), t), quat_mul(g, s))));
        worse(&power, quat_norm(quat_sub(quat_mul(quat_pow_unit(quat_mul(q, quat_conj(p)), t), p), s)));
    }
    assert_bound("angle p s = t angle p q", speed, 2e-15);
    assert_bound("slerp(p, q, t) = slerp(q, p, 1 - t)", reversed, 2e-15);
    assert_bound("half of half", halves, 2e-15);
    assert_bound("g slerp(p, q) = slerp(gp, gq)", turned, 3e-15);
    assert_bound("slerp = (q p*)^t p", power, 3e-15);
}

/* ---- angular velocities, against differences in quadruple precision ---- */

static wquat wide_nlerp(wquat p, wquat q, wide t)
{
    return wide_unit(wide_add(wide_scale(p, 1 - t), wide_scale(q, t)));
}
static wquat wide_squad(wquat p, wquat a, wquat b, wquat q, wide t)
{
    return wide_slerp(wide_slerp(p, q, t), wide_slerp(a, b, t), 2 * t * (1 - t));
}
static wquat wide_omega(wquat before, wquat here, wquat after, wide h)
{
    wquat w = wide_mul(wide_scale(wide_sub(after, before), 1 / h), wide_conj(here));
    w.w = 0;
    return w;
}

static void angular_velocities(void **state)
{
    (void)state;
    random_state r = {54};
    const wide h = 1e-10;
    double slerp = 0, nlerp = 0, given = 0, squad = 0;
    for (int n = 0; n < 5000; n++) {
        const quat p = random_unit(&r), q = quat_nearest(random_unit(&r), p);
        const quat a = at_angle(&r, p, random_between(&r, 0, 0.5)), b = at_angle(&r, q, random_between(&r, 0, 0.5));
        const wquat wp = wide_quat(p), wq = wide_quat(q), wa = wide_quat(a), wb = wide_quat(b);
        const double t = random_uniform(&r);
        const wide l = t - h, m = t + h;
        wquat w = wide_omega(wide_slerp(wp, wq, l), wide_slerp(wp, wq, t), wide_slerp(wp, wq, m), h);
        worse(&slerp, (double)wide_norm(wide_sub(wide_vec(quat_slerp_omega(p, n % 2 ? q : quat_neg(q))), w)));
        w = wide_omega(wide_nlerp(wp, wq, l), wide_nlerp(wp, wq, t), wide_nlerp(wp, wq, m), h);
        worse(&nlerp, (double)wide_norm(wide_sub(wide_vec(quat_nlerp_omega(p, n % 2 ? q : quat_neg(q), t)), w)));
        const quat far = at_angle(&r, p, random_between(&r, 1.6, 3));
        const wquat wf = wide_quat(far);
        w = wide_omega(wide_nlerp(wp, wf, l), wide_nlerp(wp, wf, t), wide_nlerp(wp, wf, m), h);
        worse(&given, (double)(wide_norm(wide_sub(wide_vec(quat_nlerp_as_given_omega(p, far, t)), w)) / wide_norm(w)));
        w = wide_omega(wide_squad(wp, wa, wb, wq, l), wide_squad(wp, wa, wb, wq, t), wide_squad(wp, wa, wb, wq, m), h);
        worse(&squad, (double)wide_norm(wide_sub(wide_vec(quat_squad_omega(p, a, b, q, t)), w)));
    }
    assert_bound("angular velocity of slerp", slerp, 1e-14);
    assert_bound("angular velocity of nlerp", nlerp, 1e-14);
    assert_bound("angular velocity of nlerp as given, relative", given, 1e-13);
    assert_bound("angular velocity of squad", squad, 1e-13);
}

/* nlerp is the chord, made unit: near ends and far ones, and the given way round where it is the long one. */
static void nlerp_is_the_chord(void **state)
{
    (void)state;
    random_state r = {55};
    double near = 0, given = 0;
    for (int n = 0; n < 5000; n++) {
        const quat p = random_unit(&r), q = at_angle(&r, p, random_between(&r, 0, 2.9));
        const double t = random_uniform(&r);
        const wquat want = wide_nlerp(wide_quat(p), wide_quat(quat_nearest(q, p)), t);
        worse(&near, (double)wide_norm(wide_sub(wide_quat(quat_nlerp(p, n % 2 ? q : quat_neg(q), t)), want)));
        const wquat chord = wide_add(wide_scale(wide_quat(p), 1 - (wide)t), wide_scale(wide_quat(q), t));
        const double length = (double)wide_norm(chord);
        const wquat off = wide_sub(wide_quat(quat_nlerp_as_given(p, q, t)), wide_unit(chord));
        worse(&given, (double)wide_norm(off) * length);
    }
    assert_bound("nlerp", near, 1e-15);
    assert_bound("nlerp as given, times the chord's length", given, 1e-15);
}

static double apart(qvec3 a, qvec3 b) { return qvec3_norm(qvec3_sub(a, b)); }

static void angular_velocities_keep_their_identities(void **state)
{
    (void)state;
    random_state r = {57};
    double slerp = 0, opposite = 0, nlerp = 0, plain = 0, turned = 0, reversed = 0;
    for (int n = 0; n < 100000; n++) {
        const quat p = random_unit(&r), g = random_unit(&r);
        const quat q = at_angle(&r, p, n % 4 ? random_between(&r, 0, 0.5 * pi - 1e-3) : random_scale(&r, -12, 0));
        const quat a = at_angle(&r, p, random_between(&r, 0, 0.5)), b = at_angle(&r, q, random_between(&r, 0, 0.5));
        const double t = n % 3 ? random_uniform(&r) : nasty_t(&r, n);
        /* steady: slerp = exp(omega t/2) p */
        const qvec3 steady = quat_slerp_omega(p, q);
        const quat there = quat_mul(quat_exp_pure(qvec3_scale(steady, 0.5 * t)), p);
        worse(&slerp, quat_norm(quat_sub(there, quat_slerp(p, q, t))));
        /* between opposite points along the circle that is taken there */
        const quat half_way =
            quat_mul(quat_exp_pure(qvec3_scale(quat_slerp_as_given_omega(p, quat_neg(p)), 0.5 * t)), p);
        worse(&opposite, quat_norm(quat_sub(half_way, quat_slerp_as_given(p, quat_neg(p), t))));
        /* 2 (q - p) s* over |s|^2, s = (1 - t) p + t q */
        const wquat d = wide_sub(wide_quat(q), wide_quat(p)), s = wide_add(wide_quat(p), wide_scale(d, t));
        const wquat w = wide_scale(wide_mul(d, wide_conj(s)), 2 / wide_dot(s, s));
        worse(&nlerp, (double)wide_vnorm(wide_sub(wide_vec(quat_nlerp_omega(p, q, t)), w)));
        /* a squad without bend is a slerp; turning everything turns it; backwards it runs the other way */
        const qvec3 bent = quat_squad_omega(p, a, b, q, t);
        worse(&plain, apart(quat_squad_omega(p, p, q, q, t), steady));
        const qvec3 left = quat_squad_omega(quat_mul(g, p), quat_mul(g, a), quat_mul(g, b), quat_mul(g, q), t);
        const qvec3 right = quat_squad_omega(quat_mul(p, g), quat_mul(a, g), quat_mul(b, g), quat_mul(q, g), t);
        worse(&turned, fmax(apart(left, quat_rotate(g, bent)), apart(right, bent)));
        worse(&reversed, qvec3_norm(qvec3_add(quat_squad_omega(q, b, a, p, 1 - t), bent)));
    }
    assert_bound("slerp = exp(omega t/2) p", slerp, 3e-15);
    assert_bound("the same between opposite points", opposite, 3e-15);
    assert_bound("angular velocity of nlerp, 1e5", nlerp, 1e-14);
    assert_bound("that of a squad without bend is slerp's", plain, 1e-14);
    assert_bound("squad's turns with everything", turned, 1e-13);
    assert_bound("and is reversed with the order", reversed, 1e-13);
}

static void squad_joins_smoothly(void **state)
{
    (void)state;
    random_state r = {55};
    double worst = 0;
    for (int n = 0; n < 100000; n++) {
        quat k[4];
        k[0] = random_unit(&r);
        for (int i = 1; i < 4; i++) k[i] = at_angle(&r, k[i - 1], random_between(&r, 0, 1));
        const quat a0 = quat_squad_control(k[0], k[0], k[1]), a1 = quat_squad_control(k[0], k[1], k[2]),
                   a2 = quat_squad_control(k[1], k[2], k[3]);
        const qvec3 left = quat_squad_omega(k[0], a0, a1, k[1], 1), right = quat_squad_omega(k[1], a1, a2, k[2], 0);
        worse(&worst, qvec3_norm(qvec3_sub(left, right)));
    }
    assert_bound("squad: angular velocity across a key", worst, 1e-13);
}

static void unflip_follows_a_curve(void **state)
{
    (void)state;
    enum { count = 100000 };
    random_state r = {56};
    static quat q[count], clean[count];
    for (int turns = 1; turns <= 2; turns++) {
        size_t flipped = 0;
        for (int i = 0; i < count; i++) {
            const double half = pi * turns * i / (count - 1);
            clean[i] = quat_make(cos(half), 0, 0.6 * sin(half), 0.8 * sin(half));
            q[i] = i && random_uniform(&r) < 0.5 ? quat_neg(clean[i]) : clean[i];
            flipped += !quat_equal(q[i], clean[i]);
        }
        int sign = 0;
        assert_int_equal(quat_unflip(count, q, &sign), flipped);
        assert_int_equal(sign, turns == 1 ? -1 : 1); /* one full turn ends at -1, two at 1 */
        for (int i = 0; i < count; i++) assert_true(quat_equal(q[i], clean[i]));
        assert_int_equal(quat_unflip(count, q, NULL), 0);
    }
    int sign = 0;
    assert_int_equal(quat_unflip(0, NULL, &sign), 0);
    assert_int_equal(sign, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slerp_is_within_its_bar),    cmocka_unit_test(ends_are_exact),
        cmocka_unit_test(slerp_keeps_its_identities), cmocka_unit_test(nlerp_is_the_chord),
        cmocka_unit_test(angular_velocities),         cmocka_unit_test(angular_velocities_keep_their_identities),
        cmocka_unit_test(squad_joins_smoothly),       cmocka_unit_test(unflip_follows_a_curve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
