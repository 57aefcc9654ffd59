/* SPDX-License-Identifier: MIT
 *
 * A line of a round body that slides, turns and rolls: its friction against a sum over places, its motion against
 * Newton's and Euler's equations in space, with the pressure that keeps the body level, and Coulomb's law at each of
 * many places, by Runge and Kutta's steps; the torque that turns it, its rest against a search over twists, and how it
 * begins to move against a motion of small speed.
 */
#include "motion/face_begin.h"
#include <quat/quat.h>
#include <string.h>
#include "kit/near.h"

static double uniform(unsigned long *seed, double low, double high)
{
    *seed = *seed * 6364136223846793005UL + 1442695040888963407UL;
    return low + (high - low) * (double)(*seed >> 11) * 0x1p-53;
}

static imp_face_motion prepared(imp_face_motion m)
{
    imp_face_prepare(&m);
    m.gyration = sqrt((m.moments[1][1] + m.moments[2][2]) / m.moments[0][0]);
    return m;
}

/* A line from -low to 1 of a body of such a height, m = P = 1. */
static imp_face_motion line_motion(double low, double height, double friction, double turning)
{
    return prepared((imp_face_motion){.face = {.count = IMP_FLAT_LINE, .corner = {{-low, 0}, {1, 0}}},
                                      .height = height,
                                      .friction = friction,
                                      .load.press = 1,
                                      .turning = turning,
                                      .longest = INFINITY,
                                      .rolling = .5 * height * height});
}

static imp_face_motion random_line(unsigned long *seed)
{
    imp_face_motion m =
        line_motion(uniform(seed, .6, 1), uniform(seed, .05, .4), uniform(seed, .1, .8), uniform(seed, 2, 3));
    m.rolling = m.height * m.height * uniform(seed, .3, .9);
    return m;
}

/* ---- friction ---- */

/* The middle of each of many places. */
static void sum_over_places(const imp_flat_face *face, const double p[3], const double twist[3], double out[3])
{
    enum { PLACES = 200000 };
    const double from = face->corner[0][0], width = (face->corner[1][0] - from) / PLACES;
    memset(out, 0, 3 * sizeof *out);
    for (int k = 0; k < PLACES; k++) {
        const double x = from + (k + .5) * width, u[2] = {twist[0], twist[1] + twist[2] * x},
                     part = -width * fmax(0, p[0] + p[1] * x) / hypot(u[0], u[1]);
        out[0] += part * u[0], out[1] += part * u[1], out[2] += part * x * u[1];
    }
}

static void friction_is_the_sum_over_places(void **state)
{
    (void)state;
    unsigned long seed = 3;
    int cut = 0;
    for (int k = 0; k < 300; k++) {
        const imp_face_motion m = random_line(&seed);
        const double p[3] = {1, uniform(&seed, -1.5, 1.5), 0}, far = pow(10, uniform(&seed, -3, 2));
        const double twist[3] = {far * uniform(&seed, -1, 1), far * uniform(&seed, -1, 1), uniform(&seed, -1, 1)};
        imp_pressed part;
        double rub[3][3], sum[3];
        imp_press_part(&m.face, p, &part);
        imp_press_rub(&part, twist, rub);
        sum_over_places(&m.face, p, twist, sum);
        for (int i = 0; i < 3; i++) assert_near(rub[i][0] * p[0] + rub[i][1] * p[1], sum[i], 1e-8);
        cut += imp_least_pressure(&m.face, p) < 0;
    }
    assert_true(cut > 50);
}

/* Where its two ways meet, as far off as it is long, along it and across; and along the line itself, where the place
 * about which it turns is on it. */
static void it_has_no_seams(void **state)
{
    (void)state;
    unsigned long seed = 4;
    for (int k = 0; k < 2000; k++) {
        const imp_face_motion m = line_motion(1, .1, 1, 3);
        const double angle = uniform(&seed, -4, 4), w = k % 2 ? -1 : 1;
        double rub[2][3][3];
        for (int i = 0; i < 2; i++) {
            const double far = 4 * (i ? 1 + 1e-15 : 1 - 1e-15), twist[3] = {far * cos(angle), far * sin(angle), w};
            imp_press_rub(&m.whole, twist, rub[i]);
        }
        for (int i = 0; i < 9; i++) assert_near(rub[0][i / 3][i % 3], rub[1][i / 3][i % 3], 5e-14);
        const double o = uniform(&seed, -1, 1), on[3] = {0, -o * w, w};
        imp_press_rub(&m.whole, on, rub[0]);
        assert_near(rub[0][0][0], 0, 0);
        assert_near(rub[0][1][0], w * 2 * o, 1e-15);
        assert_near(rub[0][2][0], -w * (1 - o * o), 1e-15);
    }
}

/* ---- motion ---- */

/* In space, m = g = 1 over the size: z is up, the line along e, the centre c over it. */
typedef struct rod {
    qvec3 x, e, v, omega;
} rod;

typedef struct pressing {
    qvec3 force, torque; /* about the centre */
} pressing;

/* What the places do, pressed by p[0] + p[1] s, where kept[0] + kept[1] s >= 0. */
static pressing press_places(const imp_face_motion *m, const rod *r, const double pressed[2], const double kept[2])
{
    enum { PLACES = 2000 };
    const qvec3 up = {0, 0, 1};
    const double from = m->face.corner[0][0], width = (m->face.corner[1][0] - from) / PLACES;
    pressing sum = {{0, 0, 0}, {0, 0, 0}};
    for (int k = 0; k < PLACES; k++) {
        const double s = from + (k + .5) * width, p = kept[0] + kept[1] * s < 0 ? 0 : pressed[0] + pressed[1] * s;
        const qvec3 arm = qvec3_axpy(s, r->e, qvec3_scale(up, -m->height)),
                    u = qvec3_add(r->v, qvec3_cross(r->omega, arm));
        const double slip = hypot(u.x, u.y), rubs = slip > 0 ? m->friction * p * width / slip : 0;
        const qvec3 f = {-rubs * u.x, -rubs * u.y, p * width};
        sum.force = qvec3_add(sum.force, f), sum.torque = qvec3_add(sum.torque, qvec3_cross(arm, f));
    }
    return sum;
}

static qvec3 inertia_of(const imp_face_motion *m, qvec3 e, qvec3 w)
{
    const double I = m->rolling, J = 1 / m->turning;
    return qvec3_axpy((I - J) * qvec3_dot(e, w), e, qvec3_scale(w, J));
}

/* v' and w' under a force and a torque; and what they leave of z'' and (e.z)''. */
static rod rates_under(const imp_face_motion *m, const rod *r, pressing by, double off[2])
{
    const double I = m->rolling, J = 1 / m->turning;
    const qvec3 gravity = {m->load.pull[0], m->load.pull[1], -1};
    const qvec3 torque = qvec3_sub(by.torque, qvec3_cross(r->omega, inertia_of(m, r->e, r->omega)));
    const qvec3 alpha = qvec3_axpy((1 / I - 1 / J) * qvec3_dot(r->e, torque), r->e, qvec3_scale(torque, 1 / J)),
                turns = qvec3_cross(r->omega, r->e);
    const rod rate = {r->v, turns, qvec3_add(gravity, by.force), alpha};
    off[0] = rate.v.z;
    off[1] = qvec3_add(qvec3_cross(alpha, r->e), qvec3_cross(r->omega, turns)).z;
    return rate;
}

/* The pressure that keeps the body up and level where just the places are pressed that were. */
static void find_pressure(const imp_face_motion *m, const rod *r, const double kept[2], double p[2], pressing *by)
{
    static const double unit[2][2] = {{1, 0}, {0, 1}};
    const pressing none = {{0, 0, 0}, {0, 0, 0}};
    pressing one[2];
    double q[2], off[2][2];
    (void)rates_under(m, r, none, q);
    for (int k = 0; k < 2; k++) {
        one[k] = press_places(m, r, unit[k], kept);
        (void)rates_under(m, r, one[k], off[k]);
        for (int i = 0; i < 2; i++) off[k][i] -= q[i];
    }
    const double whole = off[0][0] * off[1][1] - off[0][1] * off[1][0];
    p[0] = (off[1][0] * q[1] - off[1][1] * q[0]) / whole, p[1] = (off[0][1] * q[0] - off[0][0] * q[1]) / whole;
    by->force = qvec3_axpy(p[0], one[0].force, qvec3_scale(one[1].force, p[1]));
    by->torque = qvec3_axpy(p[0], one[0].torque, qvec3_scale(one[1].torque, p[1]));
}

static rod rod_rates(const imp_face_motion *m, const rod *r)
{
    double kept[2] = {1, 0}, p[2], off[2];
    pressing by;
    for (int round = 0; round < 20; round++) {
        find_pressure(m, r, kept, p, &by);
        const double change = fabs(p[0] - kept[0]) + fabs(p[1] - kept[1]);
        memcpy(kept, p, sizeof kept);
        if ((round > 0 && change < 1e-9) || (p[0] > fabs(p[1]))) break;
    }
    return rates_under(m, r, by, off);
}

static rod axpy(double h, const rod *k, const rod *r)
{
    return (rod){qvec3_axpy(h, k->x, r->x), qvec3_axpy(h, k->e, r->e), qvec3_axpy(h, k->v, r->v),
                 qvec3_axpy(h, k->omega, r->omega)};
}

static rod rod_step(const imp_face_motion *m, const rod *r, double h)
{
    const rod a = rod_rates(m, r), to_b = axpy(.5 * h, &a, r), b = rod_rates(m, &to_b), to_c = axpy(.5 * h, &b, r),
              c = rod_rates(m, &to_c), to_d = axpy(h, &c, r), d = rod_rates(m, &to_d);
    const rod first = axpy(h / 6, &a, r), second = axpy(h / 3, &b, &first), third = axpy(h / 3, &c, &second);
    return axpy(h / 6, &d, &third);
}

static rod rod_of(const imp_face_motion *m, const double *y)
{
    double v[2];
    imp_face_center_velocity(m, y, v);
    return (rod){{y[0], y[1], 0},
                 {cos(y[IMP_FACE_ANGLE]), sin(y[IMP_FACE_ANGLE]), 0},
                 {v[0], v[1], 0},
                 {y[IMP_FACE_ROLL] * cos(y[IMP_FACE_ANGLE]), y[IMP_FACE_ROLL] * sin(y[IMP_FACE_ANGLE]), y[IMP_FACE_W]}};
}

/* To the time of the path's end or until it is slow; what of slip and turning there is at the end of each step. */
static void motion_is_that_of_its_places(void **state)
{
    (void)state;
    unsigned long seed = 12;
    for (int k = 0; k < 8; k++) {
        imp_face_motion m = random_line(&seed);
        m.friction = fmin(m.friction, .4);
        if (k % 2) m.load.pull[0] = uniform(&seed, -.03, .03), m.load.pull[1] = uniform(&seed, -.03, .03);
        double y[IMP_FACE_STATE] = {0, 0, 0, uniform(&seed, -1, 1), uniform(&seed, -1, 1), uniform(&seed, -1, 1)};
        y[IMP_FACE_ROLL] = k < 2 ? 0 : uniform(&seed, -1, 1);
        rod r = rod_of(&m, y);
        double length = .5, t = 0;
        imp_face_path path;
        for (int n = 0; n < 200 && imp_face_speed(&m, y) > 2e-2; n++) {
            assert_true(imp_face_motion_step(&m, y, &length, &path));
            imp_face_at(&path, 0, y);
            const int steps = 2 + (int)((y[IMP_FACE_TIME] - t) * 400 / fmin(1, 10 * imp_face_speed(&m, y)));
            for (int i = 0; i < steps; i++) r = rod_step(&m, &r, (y[IMP_FACE_TIME] - t) / steps);
            t = y[IMP_FACE_TIME];
        }
        const rod own = rod_of(&m, y);
        assert_near(qvec3_norm(qvec3_sub(own.x, r.x)), 0, 1e-6);
        assert_near(qvec3_norm(qvec3_sub(own.e, r.e)), 0, 1e-6);
        assert_near(qvec3_norm(qvec3_sub(own.v, r.v)), 0, 1e-5);
        assert_near(m.height * qvec3_norm(qvec3_sub(own.omega, r.omega)), 0, 1e-5);
    }
}

static double kinetic(const imp_face_motion *m, const double *y)
{
    double v[2];
    imp_face_center_velocity(m, y, v);
    return .5 * (v[0] * v[0] + v[1] * v[1] + y[IMP_FACE_W] * y[IMP_FACE_W] / m->turning +
                 m->rolling * y[IMP_FACE_ROLL] * y[IMP_FACE_ROLL]);
}

/* To where it but rolls: friction has taken what is missing; slip and turning go together. */
static void energy_is_kept(void **state)
{
    (void)state;
    unsigned long seed = 19;
    for (int k = 0; k < 40; k++) {
        imp_face_motion m = random_line(&seed);
        double y[IMP_FACE_STATE] = {0, 0, 0, uniform(&seed, -2, 2), uniform(&seed, -2, 2), uniform(&seed, -2, 2)};
        y[IMP_FACE_ROLL] = uniform(&seed, -.5, .5) / m.height;
        const double begun = kinetic(&m, y);
        double length = 1;
        imp_face_path path;
        for (int n = 0; n < 100 && imp_face_speed(&m, y) > 1e-8; n++) {
            if (!imp_face_motion_step(&m, y, &length, &path)) break; /* it tips over an end */
            imp_face_at(&path, 0, y);
            assert_near(kinetic(&m, y) + y[IMP_FACE_WORK], begun, 1e-11 * (1 + begun));
        }
    }
}

/* A short line under a wide body, which turns more slowly than it slides: to its end. */
static void what_turns_slowly_comes_to_its_end(void **state)
{
    (void)state;
    for (double height = .5; height < 4; height *= 1.5) {
        imp_face_motion m = line_motion(1, height, .2 / height, 1 / (.3 + height * height / 4));
        double y[IMP_FACE_STATE] = {0, 0, 0, 0, -1, 1}, length = .7;
        y[IMP_FACE_ROLL] = -.1 / (height * height);
        imp_face_path path;
        int steps = 0;
        for (; imp_face_speed(&m, y) > 1e-6; steps++) {
            assert_true(steps < 1000 && imp_face_motion_step(&m, y, &length, &path));
            imp_face_at(&path, 0, y);
        }
    }
}

/* ---- rest ---- */

/* It is turned from mu m g h/2 on, h the half length, and with what is more; pulled across, it slips from where its
 * rolling asks for more than mu. */
static void what_turns_it(void **state)
{
    (void)state;
    static const double still[IMP_FACE_STATE] = {0};
    for (int k = 0; k < 6; k++) {
        const double friction = .1 + .2 * k, off = k % 2 ? -1e-9 : 1e-4;
        imp_face_motion m = line_motion(1, .2, friction, 3);
        double a[3];
        imp_face_balance balance;
        m.load.turn = m.turning * friction * .5 * (1 + off);
        assert_int_equal(imp_face_begins(&m, still, a, &balance), off > 0 ? IMP_FACE_GOES : IMP_FACE_STANDS);
        assert_near(a[2], off > 0 ? off * m.turning * friction * .5 : 0, 1e-12);
        m.load.turn = 0, m.load.pull[1] = imp_face_ease(&m) * friction * (1 + off);
        assert_int_equal(imp_face_begins(&m, still, a, &balance), off > 0 ? IMP_FACE_GOES : IMP_FACE_STANDS);
        assert_near(a[1], off > 0 ? off * m.load.pull[1] / (1 + off) : 0, 1e-12);
    }
}

/* Where it stands no twist shows that it does not; where it goes it goes as it does from the least of speeds. */
static void it_begins_as_it_goes_on(void **state)
{
    (void)state;
    static const double still[IMP_FACE_STATE] = {0};
    unsigned long seed = 8;
    int stands = 0, goes = 0;
    for (int k = 0; k < 400; k++) {
        imp_face_motion m = random_line(&seed);
        double a[3];
        imp_face_balance balance;
        for (int i = 0; i < 2; i++)
            m.load.pull[i] = uniform(&seed, -1, 1) * m.friction, m.load.tip[i] = uniform(&seed, -.01, .01);
        m.load.turn = uniform(&seed, -1, 1) * m.turning * m.friction;
        const imp_face_begin found = imp_face_begins(&m, still, a, &balance);
        if (found == IMP_FACE_STANDS) {
            stands++;
            for (int i = 0; i < 200; i++) {
                const double d[3] = {uniform(&seed, -1, 1), uniform(&seed, -1, 1), uniform(&seed, -1, 1)};
                imp_pressed part;
                double rub[3][3], taken = 0, given = 0;
                imp_press_part(&m.face, balance.p, &part);
                imp_press_rub(&part, d, rub);
                for (int j = 0; j < 3; j++) {
                    for (int n = 0; n < 2; n++) taken -= m.friction * d[j] * rub[j][n] * balance.p[n];
                    given -= d[j] * (j < 2 ? balance.force[j] : balance.moment);
                }
                assert_true(given <= taken + 1e-12);
            }
        } else if (found == IMP_FACE_GOES) {
            goes++;
            double y[IMP_FACE_STATE] = {0}, rate[IMP_FACE_STATE];
            const double size = qvec3_norm((qvec3){a[0], a[1], a[2]}), small = 1e-9 / size;
            imp_face_balance moves = balance;
            for (int i = 0; i < 3; i++) y[IMP_FACE_V + i] = small * a[i];
            assert_true(imp_face_rates(&m, y, rate, &moves));
            for (int i = 0; i < 3; i++) assert_near(rate[IMP_FACE_V + i], a[i], 1e-7 * (1 + size));
        }
    }
    assert_true(stands > 30 && goes > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(friction_is_the_sum_over_places),
                                       cmocka_unit_test(it_has_no_seams),
                                       cmocka_unit_test(motion_is_that_of_its_places),
                                       cmocka_unit_test(energy_is_kept),
                                       cmocka_unit_test(what_turns_slowly_comes_to_its_end),
                                       cmocka_unit_test(what_turns_it),
                                       cmocka_unit_test(it_begins_as_it_goes_on)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
