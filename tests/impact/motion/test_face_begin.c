/* SPDX-License-Identifier: MIT
 *
 * How a face begins to move, against what shares no formula with it: dissipation by quadrature over the area, its least
 * value by a search over directions, the closed forms of a square and a disc, and a motion of small speed.
 */
#include "motion/face_begin.h"
#include <string.h>
#include "kit/near.h"

static double uniform(unsigned long *seed, double low, double high)
{
    *seed = *seed * 6364136223846793005UL + 1442695040888963407UL;
    return low + (high - low) * (double)(*seed >> 11) * 0x1p-53;
}

static const double still[IMP_FACE_STATE] = {0};

static imp_face_motion prepared(imp_face_motion m)
{
    imp_face_prepare(&m);
    m.gyration = sqrt((m.moments[1][1] + m.moments[2][2]) / m.moments[0][0]);
    return m;
}

static imp_face_motion square(double height, double friction)
{
    return prepared((imp_face_motion){.face = {.count = 4, .corner = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}},
                                      .height = height,
                                      .friction = friction,
                                      .load.press = 1,
                                      .turning = 1.5});
}

static imp_face_motion disc(double height, double friction)
{
    return prepared((imp_face_motion){
        .face = {.radius = 1}, .height = height, .friction = friction, .load.press = 1, .turning = 2});
}

/* A polygon with its corners about a circle, or a disc; and a pull, a torque and a tip. */
static imp_face_motion random_motion(unsigned long *seed)
{
    imp_face_motion m = {.height = uniform(seed, 0, .5),
                         .friction = uniform(seed, .1, 1),
                         .load.press = uniform(seed, .5, 2),
                         .turning = uniform(seed, 1, 3)};
    const int count = (int)uniform(seed, 2, 8);
    if (count < 3)
        m.face.radius = 1;
    else
        m.face.count = count;
    for (int i = 0; i < m.face.count; i++) {
        const double angle = 2 * acos(-1) * (i + uniform(seed, 0, .6)) / count;
        m.face.corner[i][0] = cos(angle), m.face.corner[i][1] = sin(angle);
    }
    for (int i = 0; i < 2; i++) {
        m.load.pull[i] = uniform(seed, -.3, .3);
        m.load.tip[i] = uniform(seed, -.1, .1);
        m.aside[i] = uniform(seed, -.02, .02);
    }
    m.load.turn = uniform(seed, -1, 1);
    return prepared(m);
}

static void scale_load(imp_face_motion *m, double part)
{
    m->load.turn *= part;
    for (int i = 0; i < 2; i++) m->load.pull[i] *= part;
}

/* ---- the dissipation by quadrature ---- */

static double speed_at(const double d[3], double x, double y) { return hypot(d[0] - d[2] * y, d[1] + d[2] * x); }

/* int p |u| over a triangle: halved again and again, each a tenth-order rule's three middles of sides would err by its
 * kink alone. */
static double over_triangle(const double p[3], const double d[3], const double a[2], const double b[2],
                            const double c[2], int depth)
{
    const double m[3][2] = {{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2},
                            {(b[0] + c[0]) / 2, (b[1] + c[1]) / 2},
                            {(c[0] + a[0]) / 2, (c[1] + a[1]) / 2}};
    if (depth > 0)
        return over_triangle(p, d, a, m[0], m[2], depth - 1) + over_triangle(p, d, m[0], b, m[1], depth - 1) +
               over_triangle(p, d, m[2], m[1], c, depth - 1) + over_triangle(p, d, m[0], m[1], m[2], depth - 1);
    const double area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += fmax(0, p[0] + p[1] * m[k][0] + p[2] * m[k][1]) * speed_at(d, m[k][0], m[k][1]);
    return area * sum / 3;
}

enum { RIM = 64 };

static double dissipation(const imp_face_motion *m, const double p[3], const double d[3])
{
    const double middle[2] = {0, 0};
    const int count = m->face.count ? m->face.count : RIM, depth = m->face.count ? 4 : 2;
    double sum = 0;
    for (int i = 0; i < count; i++) {
        double from[2], to[2];
        for (int k = 0; k < 2 && m->face.count; k++)
            from[k] = m->face.corner[i][k], to[k] = m->face.corner[(i + 1) % count][k];
        if (!m->face.count) { /* as wide as its sectors' area */
            const double step = 2 * acos(-1) / RIM, r = sqrt(step / sin(step));
            from[0] = r * cos(step * i), from[1] = r * sin(step * i);
            to[0] = r * cos(step * (i + 1)), to[1] = r * sin(step * (i + 1));
        }
        sum += over_triangle(p, d, middle, from, to, depth);
    }
    return m->friction * m->load.press * sum;
}

/* L.d, of accelerations: of v and w/turning. */
static double drive(const imp_face_motion *m, const double d[3])
{
    return m->load.pull[0] * d[0] + m->load.pull[1] * d[1] + m->load.turn / m->turning * d[2];
}

/* Twists about so many centres, from near to far, both ways; then nearer to the best. */
static double least_factor(const imp_face_motion *m, const double p[3], double best[3])
{
    double least = INFINITY, width = .2;
    for (int i = 0; i < 13; i++)
        for (int j = 0; j < 24; j++) {
            const double polar = acos(-1) * (i + .5) / 13, around = acos(-1) * j / 12;
            const double d[3] = {sin(polar) * cos(around), sin(polar) * sin(around), cos(polar)};
            const double driven = drive(m, d), factor = driven > 0 ? dissipation(m, p, d) / driven : INFINITY;
            if (factor < least) least = factor, memcpy(best, d, 3 * sizeof *best);
        }
    for (int tries = 0; width > 1e-5 && tries < 400; tries++) {
        bool better = false;
        for (int k = 0; k < 6; k++) {
            double d[3] = {best[0], best[1], best[2]};
            d[k / 2] += k % 2 ? width : -width;
            const double driven = drive(m, d), factor = driven > 0 ? dissipation(m, p, d) / driven : INFINITY;
            if (factor < least) least = factor, memcpy(best, d, 3 * sizeof *best), better = true;
        }
        if (!better) width /= 2;
    }
    return least;
}

/* ---- what is held to it ---- */

static imp_face_begin begins(const imp_face_motion *m, double a[3], imp_face_balance *balance)
{
    return imp_face_begins(m, still, a, balance);
}

static void rests_up_to_the_limit_of_quadrature(void **state)
{
    (void)state;
    unsigned long seed = 3;
    int tried = 0, cut = 0;
    for (int k = 0; k < 24; k++) {
        imp_face_motion m = random_motion(&seed);
        double a[3], d[3] = {0}, factor = 1;
        imp_face_balance balance;
        bool balanced = true;
        /* the pressure goes with the pull: the load at the limit by a few rounds */
        for (int round = 0; round < 12 && balanced; round++) {
            balance = (imp_face_balance){.p = {0}};
            balanced = imp_face_balance_under(&m, &m.load, NULL, &balance);
            if (!balanced) break;
            factor = least_factor(&m, balance.p, d);
            if (fabs(factor - 1) < 1e-5) break;
            scale_load(&m, factor);
        }
        if (!balanced || fabs(factor - 1) > 1e-4) continue;
        tried++;
        cut += imp_least_pressure(&m.face, balance.p) < 0;
        scale_load(&m, .997);
        assert_int_equal(begins(&m, a, &balance), IMP_FACE_STANDS);
        scale_load(&m, 1.003 / .997);
        assert_int_equal(begins(&m, a, &balance), IMP_FACE_GOES);
        /* it begins along the twist that the limit gives way to */
        const double cross[3] = {a[1] * d[2] - a[2] * d[1], a[2] * d[0] - a[0] * d[2], a[0] * d[1] - a[1] * d[0]};
        const double off = sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
        assert_near(off / (qvec3_norm((qvec3){a[0], a[1], a[2]}) * qvec3_norm((qvec3){d[0], d[1], d[2]})), 0, .05);
        assert_true(drive(&m, a) > 0);
    }
    assert_true(tried > 12 && cut > 0);
}

/* A square turns on the spot from mu m g (root 2 + asinh 1)/3 on, a disc from 2/3 on; both are pulled away by mu m g,
 * with whatever torque that has about the pressure's centre alone. */
static void closed_forms(void **state)
{
    (void)state;
    double a[3];
    imp_face_balance balance;
    for (int k = 0; k < 2; k++) {
        imp_face_motion m = k ? disc(.3, .5) : square(.3, .5);
        const double arm = k ? 2. / 3 : (sqrt(2) + asinh(1)) / 3, hold = .5 * arm * m.turning;
        for (double off = 1e-1; off > 1e-12; off /= 10) {
            m.load.turn = hold * (1 - off);
            assert_int_equal(begins(&m, a, &balance), IMP_FACE_STANDS);
            assert_near(balance.moment, -.5 * arm * (1 - off), 1e-15);
            m.load.turn = -hold * (1 + off);
            assert_int_equal(begins(&m, a, &balance), IMP_FACE_GOES);
            assert_near(a[2], -hold * off, 1e-15);
            assert_near(hypot(a[0], a[1]), 0, 1e-14);
        }
        m.load.turn = 0;
        for (double off = 1e-1; off > 1e-12; off /= 10)
            for (int i = 0; i < 6; i++) {
                m.load.pull[0] = .5 * (1 - off) * cos(i), m.load.pull[1] = .5 * (1 - off) * sin(i);
                assert_int_equal(begins(&m, a, &balance), IMP_FACE_STANDS);
                m.load.pull[0] = .5 * (1 + off) * cos(i), m.load.pull[1] = .5 * (1 + off) * sin(i);
                assert_int_equal(begins(&m, a, &balance), IMP_FACE_GOES);
                assert_near(hypot(a[0] - .5 * off * cos(i), a[1] - .5 * off * sin(i)), 0, 1e-14);
                assert_near(a[2], 0, 1e-14);
            }
    }
}

/* The rates of a small motion along a are a; of rest at the limit they have no side. */
static void begins_as_a_small_motion_goes(void **state)
{
    (void)state;
    unsigned long seed = 11;
    int gone = 0;
    for (int k = 0; k < 2000; k++) {
        const imp_face_motion m = random_motion(&seed);
        double a[3], rate[IMP_FACE_STATE];
        imp_face_balance balance;
        if (begins(&m, a, &balance) != IMP_FACE_GOES) continue;
        for (double speed = 1e-3; speed > 1e-7; speed /= 1e3) {
            double y[IMP_FACE_STATE] = {0, 0, 0, speed * a[0], speed * a[1], speed * a[2]};
            imp_face_balance now = {.p = {0}};
            assert_true(imp_face_rates(&m, y, rate, &now));
            /* w^2 shifts the pressure, in the second order */
            for (int i = 0; i < 3; i++) assert_near(rate[IMP_FACE_V + i], a[i], 1e-11 + .1 * y[5] * y[5]);
        }
        gone++;
    }
    assert_true(gone > 500);
}

/* Turned with its load, a face begins the turned way. */
static void turns_with_its_axes(void **state)
{
    (void)state;
    unsigned long seed = 17;
    for (int k = 0; k < 500; k++) {
        imp_face_motion m = random_motion(&seed);
        double a[3], b[3], y[IMP_FACE_STATE] = {0};
        imp_face_balance balance;
        const imp_face_begin one = begins(&m, a, &balance);
        y[IMP_FACE_ANGLE] = uniform(&seed, -3, 3);
        imp_face_turn(m.load.pull, y[IMP_FACE_ANGLE], m.load.pull);
        imp_face_turn(m.load.tip, y[IMP_FACE_ANGLE], m.load.tip);
        assert_int_equal(imp_face_begins(&m, y, b, &balance), one);
        imp_face_turn(a, y[IMP_FACE_ANGLE], a);
        for (int i = 0; i < 3; i++) assert_near(b[i], a[i], 1e-10);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rests_up_to_the_limit_of_quadrature),
        cmocka_unit_test(closed_forms),
        cmocka_unit_test(begins_as_a_small_motion_goes),
        cmocka_unit_test(turns_with_its_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
