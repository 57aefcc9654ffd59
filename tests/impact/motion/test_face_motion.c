/* SPDX-License-Identifier: MIT
 *
 * The motion of a face: its balance against its own equations, its steps against Runge and Kutta's of a fixed length
 * whose limit is extrapolated, and what neither knows: energy, turned and mirrored axes, and other units.
 */
#include "motion/face_motion.h"
#include <string.h>
#include "kit/near.h"

static double uniform(unsigned long *seed, double low, double high)
{
    *seed = *seed * 6364136223846793005UL + 1442695040888963407UL;
    return low + (high - low) * (double)(*seed >> 11) * 0x1p-53;
}

static imp_face_motion square_motion(double height, double friction)
{
    imp_face_motion m = {.face = {.count = 4, .corner = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}},
                         .height = height,
                         .friction = friction,
                         .load.press = 1,
                         .turning = 1.5};
    imp_face_prepare(&m);
    m.gyration = sqrt(2.0 / 3);
    return m;
}

static imp_face_motion disc_motion(double height, double friction)
{
    imp_face_motion m = {.face = {.radius = 1}, .height = height, .friction = friction, .load.press = 1, .turning = 2};
    imp_face_prepare(&m);
    m.gyration = sqrt(.5);
    return m;
}

/* The three equations, with the part that is pressed found again. */
static void the_pressure_balances(void **state)
{
    (void)state;
    unsigned long seed = 5;
    int cut = 0, tips = 0;
    for (int k = 0; k < 3000; k++) {
        imp_face_motion m = k % 2 ? disc_motion(uniform(&seed, 0, 1), uniform(&seed, 0, 1))
                                  : square_motion(uniform(&seed, 0, 1), uniform(&seed, 0, 1));
        for (int i = 0; i < 2; i++) m.aside[i] = uniform(&seed, -.02, .02);
        const double twist[3] = {uniform(&seed, -1, 1), uniform(&seed, -1, 1), uniform(&seed, -1, 1)};
        imp_face_balance b = {.p = {0}};
        if (!imp_face_balance_of(&m, twist, &b)) {
            tips++;
            continue;
        }
        imp_pressed part;
        double moments[3][3], rub[3][3], force[3] = {0}, pressed[3] = {0};
        imp_press_part(&m.face, b.p, &part);
        imp_press_moments(&part, moments);
        imp_press_rub(&part, twist, rub);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                pressed[i] += moments[i][j] * b.p[j];
                force[i] += m.friction * rub[i][j] * b.p[j];
            }
        const double turns = m.turning * force[2], w = twist[2], *j = m.aside;
        assert_near(pressed[0], 1, 1e-11);
        assert_near(pressed[1], -m.height * force[0] - turns * j[1] - w * w * j[0], 1e-11);
        assert_near(pressed[2], -m.height * force[1] + turns * j[0] - w * w * j[1], 1e-11);
        assert_near(hypot(b.force[0] - force[0], b.force[1] - force[1]), 0, 1e-11);
        assert_true(imp_face_spare(&m.face, b.center) > 0);
        cut += imp_least_pressure(&m.face, b.p) < 0;
    }
    assert_true(cut > 300 && tips < 1000);
}

/* The time, way, angle and work that are left at the end, along the twist that there is. */
static void finish(const imp_face_motion *m, double *y)
{
    double rate[IMP_FACE_STATE];
    imp_face_balance balance = {.p = {0}};
    assert_true(imp_face_rates(m, y, rate, &balance));
    const double k = m->gyration * m->gyration, s = imp_face_speed(m, y);
    const double falls = -(y[3] * rate[3] + y[4] * rate[4] + k * y[5] * rate[5]), time = s * s / falls;
    y[6] += time;
    for (int i = 0; i < 3; i++) y[i] += 0.5 * time * y[3 + i];
}

static void follow(const imp_face_motion *m, double *y, double slow)
{
    double length = 1;
    imp_face_path path;
    for (int n = 0; imp_face_speed(m, y) > slow && n < 1000; n++) {
        assert_true(imp_face_motion_step(m, y, &length, &path));
        imp_face_at(&path, 0, y);
    }
    finish(m, y);
}

/* Runge and Kutta's steps of h in the same variable. */
static void follow_by_fixed_steps(const imp_face_motion *m, double *y, double slow, double h)
{
    const double scale = m->friction * m->load.press + hypot(m->load.pull[0], m->load.pull[1]);
    while (imp_face_speed(m, y) > slow) {
        double rate[4][IMP_FACE_STATE], at[IMP_FACE_STATE];
        for (int s = 0; s < 4; s++) {
            imp_face_balance balance = {.p = {0}};
            for (int i = 0; i < IMP_FACE_STATE; i++)
                at[i] = y[i] + (s == 0 ? 0 : h * (s == 3 ? 1 : .5) * rate[s - 1][i]);
            assert_true(imp_face_rates(m, at, rate[s], &balance));
            for (int i = 0; i < IMP_FACE_STATE; i++) rate[s][i] *= imp_face_speed(m, at) / scale;
        }
        for (int i = 0; i < IMP_FACE_STATE; i++)
            y[i] += h * (rate[0][i] + 2 * rate[1][i] + 2 * rate[2][i] + rate[3][i]) / 6;
    }
    finish(m, y);
}

/* Their error falls as h^4: two lengths give the limit. The first is the case of docs/faces.md. */
static void steps_are_the_limit_of_short_ones(void **state)
{
    (void)state;
    imp_face_motion cases[4] = {square_motion(0, 1), square_motion(.3, .8), disc_motion(.2, .5), square_motion(.2, .6)};
    cases[3].load.pull[0] = .1, cases[3].load.pull[1] = -.2;
    for (int k = 0; k < 4; k++) {
        const double begin[IMP_FACE_STATE] = {0, 0, 0, 1, k == 0 ? 0 : .3, 1}, slow = 1e-9;
        double y[IMP_FACE_STATE], coarse[IMP_FACE_STATE], fine[IMP_FACE_STATE];
        memcpy(y, begin, sizeof y), memcpy(coarse, begin, sizeof y), memcpy(fine, begin, sizeof y);
        follow(&cases[k], y, slow);
        follow_by_fixed_steps(&cases[k], coarse, slow, 5e-3);
        follow_by_fixed_steps(&cases[k], fine, slow, 2.5e-3);
        for (int i = 0; i < 3; i++) assert_near(y[i], fine[i] + (fine[i] - coarse[i]) / 15, 2e-10);
        assert_near(y[6], fine[6] + (fine[6] - coarse[6]) / 15, 2e-10);
        if (k > 0) continue;
        assert_near(y[6], 1.4190, 5e-5);
        assert_near(y[2], .7442, 5e-5);
        assert_near(y[0], .6817, 5e-5);
    }
}

/* Kinetic energy, over m size^2, goes to friction and the pull alone. */
static void energy_is_kept(void **state)
{
    (void)state;
    unsigned long seed = 9;
    for (int k = 0; k < 20; k++) {
        imp_face_motion m = k % 2 ? disc_motion(.3, .4) : square_motion(.3, .4);
        m.load.pull[0] = uniform(&seed, -.3, .3), m.load.pull[1] = uniform(&seed, -.2, .2);
        double y[IMP_FACE_STATE] = {0, 0, 0, uniform(&seed, -2, 2), uniform(&seed, -2, 2), uniform(&seed, -3, 3)};
        const double begun = .5 * (y[3] * y[3] + y[4] * y[4] + y[5] * y[5] / m.turning);
        double length = 1;
        imp_face_path path;
        for (int n = 0; n < 30 && imp_face_speed(&m, y) > 1e-6; n++) {
            assert_true(imp_face_motion_step(&m, y, &length, &path));
            double before[IMP_FACE_STATE];
            imp_face_at(&path, -1, before);
            assert_near(before[3], y[3], 1e-13); /* it begins where it did */
            imp_face_at(&path, 0, y);
            const double kinetic = .5 * (y[3] * y[3] + y[4] * y[4] + y[5] * y[5] / m.turning);
            assert_near(kinetic + y[7] - m.load.pull[0] * y[0] - m.load.pull[1] * y[1], begun, 1e-12 * (1 + begun));
        }
    }
}

/* Mirrored, a face goes the mirrored way. */
static void mirrored(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        imp_face_motion m = k ? disc_motion(.3, .5) : square_motion(.3, .5), mirror = m;
        m.load.pull[0] = mirror.load.pull[0] = .1;
        m.load.pull[1] = .2, mirror.load.pull[1] = -.2;
        double y[IMP_FACE_STATE] = {0, 0, 0, 1, .4, 2}, z[IMP_FACE_STATE] = {0, 0, 0, 1, -.4, -2};
        follow(&m, y, 1e-9);
        follow(&mirror, z, 1e-9);
        static const double sign[3] = {1, -1, -1};
        for (int i = 0; i < 3; i++) assert_near(z[i], sign[i] * y[i], 1e-12);
        assert_near(z[6], y[6], 1e-12);
    }
}

/* A push that ends so far from where it begins. */
static bool pushed_to(const void *context, const double *y, imp_face_load *load)
{
    load->pull[0] = y[IMP_FACE_X] < *(const double *)context ? .3 : 0;
    load->power = load->pull[0] * y[IMP_FACE_V];
    return true;
}

/* Where no node of a step sees that a force ends, before the first of them, the step is too long. */
static void a_force_ends_just_after_the_begin(void **state)
{
    (void)state;
    for (double end = 1e-2; end > 1e-5; end /= 2) {
        imp_face_motion m = square_motion(.3, 0);
        m.loads = pushed_to, m.context = &end, m.longest = 1;
        double y[IMP_FACE_STATE] = {0, 0, 0, 1, 0, 0}, length = .7;
        imp_face_path path;
        assert_true(imp_face_motion_step(&m, y, &length, &path));
        imp_face_at(&path, 0, y);
        assert_near(y[IMP_FACE_PUSHED], .3 * fmin(y[IMP_FACE_X], end), 1e-9);
        assert_near(y[IMP_FACE_V], sqrt(1 + .6 * fmin(y[IMP_FACE_X], end)), 1e-9);
    }
}

/* A wall of force, a million times what else acts, that nothing tells of. */
static bool walled(const void *context, const double *y, imp_face_load *load)
{
    load->pull[0] = y[IMP_FACE_X] < *(const double *)context ? 0 : -1e6;
    load->power = load->pull[0] * y[IMP_FACE_V];
    return true;
}

/* However high it is, a jump is stepped over: no step is so short that time stands. */
static void a_jump_is_stepped_over(void **state)
{
    (void)state;
    const double end = .3;
    imp_face_motion m = square_motion(0, .2);
    m.loads = walled, m.context = &end, m.longest = 1;
    double y[IMP_FACE_STATE] = {0, 0, 0, 1, 0, 0}, length = .7;
    imp_face_path path;
    for (int steps = 0; y[IMP_FACE_X] < end; steps++) {
        assert_true(steps < 100 && imp_face_motion_step(&m, y, &length, &path));
        assert_true(path.length >= .99e-12);
        imp_face_at(&path, 0, y);
        y[IMP_FACE_TIME] = 0;
    }
    assert_near(y[IMP_FACE_V], sqrt(1 - 2 * .2 * end), 1e-4); /* the height times the time of the shortest step */
}

/* A pull that grows from what friction holds. */
static bool growing(const void *context, const double *y, imp_face_load *load)
{
    load->pull[0] = .5 + *(const double *)context * y[IMP_FACE_TIME];
    load->power = load->pull[0] * y[IMP_FACE_V];
    return true;
}

/* However slowly it moves yet, a step takes no more than the time that the load may be followed in; v = v0 + rate
 * t^2/2. */
static void no_step_is_longer_than_its_load_allows(void **state)
{
    (void)state;
    for (double rate = 1; rate < 1e4; rate *= 10) {
        imp_face_motion m = square_motion(.3, .5);
        m.loads = growing, m.context = &rate, m.longest = 2e-3;
        double y[IMP_FACE_STATE] = {0, 0, 0, 1e-6, 0, 0}, length = 1e6;
        imp_face_path path;
        for (int n = 0; n < 20; n++) {
            const double begun = y[IMP_FACE_TIME], v = y[IMP_FACE_V];
            assert_true(imp_face_motion_step(&m, y, &length, &path));
            length = 1e6;
            imp_face_at(&path, 0, y);
            const double t = y[IMP_FACE_TIME];
            assert_true(t - begun <= 1.26 * m.longest);
            assert_near(y[IMP_FACE_V], v + rate * (t * t - begun * begun) / 2, 1e-9 * (1 + y[IMP_FACE_V]));
        }
    }
}

/* A pull of nothing, that counts how often it is asked. */
static bool counted(const void *context, const double *y, imp_face_load *load)
{
    (void)y, (void)load;
    ++**(long *const *)context;
    return true;
}

/* Steps that meet a place where no polynomial follows the rates end there, or are short before it: of motions of a
 * cube, whose pressure leaves corners and comes to others, the rates are asked for 4738 times each; 4948 where steps
 * run into the border that the centre of turning crosses, 5494 where they run over corners, 5684 where over both. */
static void steps_end_where_rates_bend(void **state)
{
    (void)state;
    enum { MOTIONS = 40 };
    unsigned long seed = 11;
    long asked = 0, *const count = &asked;
    for (int k = 0; k < MOTIONS; k++) {
        imp_face_motion m = square_motion(1, .5);
        m.loads = counted, m.context = &count, m.longest = 1e3;
        double y[IMP_FACE_STATE] = {0, 0, uniform(&seed, 0, 2)};
        for (int i = 0; i < 3; i++) y[IMP_FACE_V + i] = uniform(&seed, -1, 1);
        follow(&m, y, 1e-5);
    }
    assert_in_range(asked / MOTIONS, 1000, 4850);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_pressure_balances),
                                       cmocka_unit_test(steps_are_the_limit_of_short_ones),
                                       cmocka_unit_test(energy_is_kept),
                                       cmocka_unit_test(mirrored),
                                       cmocka_unit_test(a_force_ends_just_after_the_begin),
                                       cmocka_unit_test(a_jump_is_stepped_over),
                                       cmocka_unit_test(no_step_is_longer_than_its_load_allows),
                                       cmocka_unit_test(steps_end_where_rates_bend)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
