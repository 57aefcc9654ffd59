/* SPDX-License-Identifier: MIT */
#include "oracle.h"
#include <quat/exponential.h>
#include <quat/project.h>

static const quat one = {1, 0, 0, 0}, minus = {-1, 0, 0, 0};
static const quat_pole poles[] = {QUAT_SOUTH_POLE, QUAT_NORTH_POLE};

/* A unit quaternion at 10^-12 ... 1 from a pole or the equator, or anywhere; exactly unit it need not be. */
static quat nasty(random_state *r, int n)
{
    const double small = random_scale(r, n % 2 ? -12 : -150, -0.3);
    const qvec3 d = random_direction(r);
    switch (n % 4) {
    case 0: return quat_from_parts(sqrt((1 - small) * (1 + small)), qvec3_scale(d, small));
    case 1: return quat_from_parts(-sqrt((1 - small) * (1 + small)), qvec3_scale(d, small));
    case 2:
        return quat_from_parts(random_uniform(r) < 0.5 ? small : -small,
                               qvec3_scale(d, sqrt((1 - small) * (1 + small))));
    default: return random_unit(r);
    }
}

/* The largest error of a component relative to itself. */
static double own_error(qvec3 got, wquat want)
{
    double worst = 0;
    worse(&worst, error_of_scalar(got.x, want.x));
    worse(&worst, error_of_scalar(got.y, want.y));
    worse(&worst, error_of_scalar(got.z, want.z));
    return worst;
}

static wquat wide_stereographic(quat q, quat_pole pole)
{
    const wquat unit = wide_unit(wide_quat(q));
    const wide w = pole * unit.w;
    /* v/(1 + w), with 1 + w as |v|^2/(1 - w) where it cancels even in 113 bits */
    const wide v2 = unit.x * unit.x + unit.y * unit.y + unit.z * unit.z;
    const wide down = w < 0 ? 1 - w : v2 / (1 + w);
    return wide_scale((wquat){0, unit.x, unit.y, unit.z}, 1 / down);
}

static wquat wide_from_stereographic(qvec3 x, quat_pole pole)
{
    const wide over = wide_norm2_minus_one(wide_vec(x)), d = 2 + over;
    return (wquat){pole * over / d, 2 * (wide)x.x / d, 2 * (wide)x.y / d, 2 * (wide)x.z / d};
}

static void stereographic_against_the_oracle(void **state)
{
    (void)state;
    random_state r = {101};
    double there = 0, back = 0, back_w = 0, scaled = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = nasty(&r, n);
        const quat_pole pole = poles[random_uniform(&r) < 0.5];
        qvec3 image;
        assert_int_equal(quat_stereographic(q, pole, &image), QUAT_OK);
        worse(&there, own_error(image, wide_stereographic(q, pole)));
        const quat p = quat_from_stereographic(image, pole);
        const wquat want = wide_from_stereographic(image, pole);
        worse(&back, own_error(quat_vector(p), want));
        worse(&back_w, error_of_scalar(p.w, want.w));
        const double scale = random_scale(&r, -140, 300);
        if (quat_norm(quat_scale(q, scale)) < 1e300 && random_uniform(&r) < 0.3) {
            const quat big = quat_scale(nasty(&r, 3), scale);
            quat_stereographic(big, pole, &image);
            worse(&scaled, own_error(image, wide_stereographic(big, pole)));
        }
    }
    assert_bound("stereographic, each component, u", there, 5);
    assert_bound("stereographic at any length, u", scaled, 5);
    assert_bound("from stereographic, each component, u", back, 4);
    assert_bound("from stereographic, w, u", back_w, 4);
}

/* 1 - pole w of a unit quaternion, also where that keeps no digit. */
static wide from_pole(wquat q, quat_pole pole)
{
    const wide w = pole * q.w;
    return w <= 0 ? 1 - w : (q.x * q.x + q.y * q.y + q.z * q.z) / (1 + w);
}

static void there_and_back(void **state)
{
    (void)state;
    random_state r = {102};
    double sphere = 0, root = 0, edge = 0, mirrored = 0, angles = 0;
    for (int n = 0; n < 200000; n++) {
        const quat q = nasty(&r, n);
        const quat_pole pole = poles[n % 3 == 0];
        qvec3 image, other;
        quat_stereographic(q, pole, &image);
        worse(&sphere, quat_norm(quat_sub(quat_from_stereographic(image, pole), q)));
        /* inside the ball on the far side of the pole: 5.4.1 with its pole put right */
        assert_true((qvec3_norm(image) < 1 + 1e-15) == (pole * q.w < 1e-15) || fabs(q.w) < 1e-14);
        quat_stereographic(quat_make(-q.w, q.x, q.y, q.z), (quat_pole)-pole, &other);
        worse(&mirrored, qvec3_norm(qvec3_sub(image, other)));

        int half;
        quat p;
        assert_int_equal(quat_orthographic(q, &image, &half), QUAT_OK);
        assert_int_equal(half, (q.w > 0) - (q.w < 0));
        assert_int_equal(quat_from_orthographic(image, half, &p), QUAT_OK);
        worse(&root, quat_norm(quat_sub(p, q)) * fmax(fabs(q.w), 1e-8));
        worse(&edge, fabs(quat_norm(p) - 1));

        /* conformal, and exactly how: |P(p) - P(q)|^2 = |p - q|^2/((1 + w_p) (1 + w_q)), seen from -1 */
        const wquat a = wide_unit(wide_quat(q)), b = wide_unit(wide_quat(random_unit(&r)));
        const quat rounded = {(double)b.w, (double)b.x, (double)b.y, (double)b.z};
        qvec3 at, to;
        quat_stereographic(q, pole, &at);
        quat_stereographic(rounded, pole, &to);
        const wquat there = wide_unit(wide_quat(rounded)), gap = wide_sub(a, there);
        const wide stretch = wide_norm(gap) / sqrtf128(from_pole(a, pole) * from_pole(there, pole));
        worse(&angles,
              (double)fabsf128((wide)qvec3_norm(qvec3_sub(at, to)) - stretch) / (qvec3_norm(at) + qvec3_norm(to)));
    }
    assert_bound("q -> stereographic -> q", sphere, 1e-15);
    assert_bound("one pole is the other's mirror image", mirrored, 0);
    assert_bound("q -> orthographic -> q, times w", root, 1e-15);
    assert_bound("|q| from orthographic", edge, 1e-15);
    assert_bound("distances of images, over the images", angles, 1e-15);
}

static void the_poles_are_reported(void **state)
{
    (void)state;
    qvec3 image;
    qvec2 plane;
    double line;
    for (int n = 0; n < 2; n++) {
        const quat pole = n ? one : minus, other = n ? minus : one;
        assert_int_equal(quat_stereographic(pole, poles[n], &image), QUAT_AT_INFINITY);
        assert_true(isinf(image.x) && isinf(image.y) && isinf(image.z));
        assert_true(quat_equal(quat_from_stereographic(image, poles[n]), pole));
        assert_int_equal(quat_stereographic(other, poles[n], &image), QUAT_OK);
        assert_true(qvec3_norm(image) == 0);
        assert_true(quat_equal(quat_from_stereographic(image, poles[n]), other));
        assert_true(quat_equal(quat_from_stereographic(qvec3_make(0, -INFINITY, 1), poles[n]), pole));
        const double z = n ? 1 : -1;
        assert_int_equal(quat_stereographic_sphere(qvec3_make(0, 0, z), poles[n], &plane), QUAT_AT_INFINITY);
        assert_true(quat_from_stereographic_sphere(plane, poles[n]).z == z);
        assert_int_equal(quat_stereographic_circle(qvec2_make(0, z), poles[n], &line), QUAT_AT_INFINITY);
        assert_true(isinf(line) && quat_from_stereographic_circle(line, poles[n]).y == z);
    }
    /* next to the pole: 2/|v|, up to where it overflows */
    assert_int_equal(quat_stereographic(quat_make(-1, 1e-307, 0, 0), QUAT_SOUTH_POLE, &image), QUAT_OK);
    assert_true(fabs(image.x / 2e307 - 1) < 1e-15);
    assert_int_equal(quat_stereographic(quat_make(-1, 0, 1e-310, 0), QUAT_SOUTH_POLE, &image), QUAT_AT_INFINITY);
    assert_int_equal(quat_stereographic(quat_make(-1e-310, 0, 1e-310, 0), QUAT_SOUTH_POLE, &image), QUAT_OK);
    assert_true(fabs(image.y - (1 + sqrt(2))) < 1e-14);
    assert_int_equal(quat_stereographic(quat_make(1e308, 0, 0, 1e308), QUAT_SOUTH_POLE, &image), QUAT_OK);
    assert_true(fabs(image.z - (sqrt(2) - 1)) < 1e-15);
    const quat far = quat_from_stereographic(qvec3_make(3e200, -4e200, 0), QUAT_SOUTH_POLE);
    assert_true(far.w == -1 && fabs(far.x / 2.4e-201 - 1) < 1e-15 && fabs(far.y / -3.2e-201 - 1) < 1e-15);
}

static void bad_input_is_told(void **state)
{
    (void)state;
    const quat bad[] = {{0, 0, 0, 0}, {NAN, 1, 0, 0}, {1, INFINITY, 0, 0}};
    qvec3 image;
    qvec2 plane;
    quat q;
    int half;
    for (int n = 0; n < 3; n++) {
        assert_int_equal(quat_stereographic(bad[n], QUAT_SOUTH_POLE, &image), QUAT_EDOMAIN);
        assert_true(qvec3_norm(image) == 0);
        assert_int_equal(quat_orthographic(bad[n], &image, &half), QUAT_EDOMAIN);
        assert_true(qvec3_norm(image) == 0 && half == 0);
    }
    assert_int_equal(quat_stereographic(one, (quat_pole)0, &image), QUAT_EARGUMENT);
    assert_true(isnan(quat_from_stereographic(image, (quat_pole)3).w));
    assert_true(isnan(quat_from_stereographic(qvec3_make(NAN, INFINITY, 0), QUAT_SOUTH_POLE).w));
    assert_int_equal(quat_from_orthographic(qvec3_make(0, 0, 0), 2, &q), QUAT_EARGUMENT);
    assert_true(quat_equal(q, one));
    assert_int_equal(quat_from_orthographic(qvec3_make(NAN, 0, 0), 1, &q), QUAT_EDOMAIN);
    assert_true(quat_equal(q, one));
    assert_int_equal(quat_from_orthographic(qvec3_make(0, 0, 0), 0, &q), QUAT_EDOMAIN);
    assert_int_equal(quat_stereographic_sphere(qvec3_make(0, 0, 0), QUAT_NORTH_POLE, &plane), QUAT_EDOMAIN);
    assert_int_equal(quat_hopf_fibre(qvec3_make(0, 0, 0), 1, &q), QUAT_EDOMAIN);
    assert_int_equal(quat_hopf_fibre(qvec3_make(1, 0, 0), NAN, &q), QUAT_EDOMAIN);
    assert_true(quat_equal(q, one));
}

static void the_boundary(void **state)
{
    (void)state;
    random_state r = {103};
    double root = 0, outside = 0;
    for (int n = 0; n < 100000; n++) {
        const qvec3 x = random_vector(&r, 1 - random_scale(&r, -18, 0));
        const wide rest = -wide_norm2_minus_one(wide_vec(x));
        const int half = n % 2 ? 1 : -1;
        quat q;
        assert_int_equal(quat_from_orthographic(x, half, &q), QUAT_OK);
        if (rest > 0) worse(&root, error_of_scalar(q.w, half * sqrtf128(rest)));
        if (rest <= 0) assert_true(q.w == 0 && fabs(quat_norm(q) - 1) < 4e-16);
        const qvec3 out = qvec3_scale(x, (1 + random_scale(&r, -12, 300)) / qvec3_norm(x));
        assert_int_equal(quat_from_orthographic(out, half, &q), QUAT_EDOMAIN);
        worse(&outside, quat_norm(quat_sub(q, quat_pure(qvec3_scale(x, 1 / qvec3_norm(x))))));
    }
    assert_bound("w = sqrt((1 - n)(1 + n)), u", root, 2);
    assert_bound("an image outside goes to the boundary", outside, 1e-15);
    quat q;
    assert_int_equal(quat_from_orthographic(qvec3_make(0.6, 0, 0.8), 0, &q), QUAT_OK);
    assert_true(q.w == 0 && fabs(quat_norm(q) - 1) < 3e-16);
    assert_int_equal(quat_from_orthographic(qvec3_make(0.3, 0, 0.4), 0, &q), QUAT_EDOMAIN);
    assert_true(q.w == 0 && fabs(q.x - 0.6) < 2e-16 && fabs(q.z - 0.8) < 2e-16);
}

/* By hand: figure 4's x/(1 - y), and 3-4-5 triangles. */
static void circle_and_sphere(void **state)
{
    (void)state;
    double line;
    qvec2 plane, c;
    qvec3 s;
    int half;
    quat_stereographic_circle(qvec2_make(0.6, 0.8), QUAT_NORTH_POLE, &line);
    assert_true(fabs(line - 3) < 3e-15);
    quat_stereographic_circle(qvec2_make(0.6, 0.8), QUAT_SOUTH_POLE, &line);
    assert_true(fabs(line - 1.0 / 3) < 2e-16);
    c = quat_from_stereographic_circle(3, QUAT_NORTH_POLE);
    assert_true(fabs(c.x - 0.6) < 2e-16 && fabs(c.y - 0.8) < 2e-16);
    quat_stereographic_sphere(qvec3_make(2, -3, 6), QUAT_NORTH_POLE, &plane);
    assert_true(fabs(plane.x - 2) < 1e-15 && fabs(plane.y + 3) < 2e-15);
    s = quat_from_stereographic_sphere(qvec2_make(2, -3), QUAT_NORTH_POLE);
    assert_true(fabs(s.x - 2.0 / 7) < 1e-16 && fabs(s.y + 3.0 / 7) < 1e-16 && fabs(s.z - 6.0 / 7) < 2e-16);
    quat_orthographic_circle(qvec2_make(3, -4), &line, &half);
    assert_true(fabs(line - 0.6) < 2e-16 && half == -1);
    assert_int_equal(quat_from_orthographic_circle(0.6, -1, &c), QUAT_OK);
    assert_true(fabs(c.y + 0.8) < 2e-16 && c.x == 0.6);
    quat_orthographic_sphere(qvec3_make(2, -3, 6), &plane, &half);
    assert_true(fabs(plane.x - 2.0 / 7) < 1e-16 && half == 1);
    assert_int_equal(quat_from_orthographic_sphere(plane, 1, &s), QUAT_OK);
    assert_true(fabs(s.z - 6.0 / 7) < 3e-16);
    assert_int_equal(quat_from_orthographic_sphere(qvec2_make(2, 0), 1, &s), QUAT_EDOMAIN);
    assert_true(s.x == 1 && s.z == 0);
    /* a great circle of S^3 through neither pole is a circle in space: that of (1 + i)/sqrt(2) t + j sqrt(1 - t^2) */
    double spread = 0;
    for (int n = 0; n < 1000; n++) {
        const double t = 2 * 3.14159265358979323846 * n / 1000, h = sqrt(0.5);
        qvec3 image;
        quat_stereographic(quat_make(h * cos(t), h * cos(t), sin(t), 0), QUAT_SOUTH_POLE, &image);
        worse(&spread, fabs(qvec3_norm(qvec3_sub(image, qvec3_make(-1, 0, 0))) - sqrt(2)));
    }
    assert_bound("a great circle's image is a circle", spread, 1e-14);
}

static void arrays_do_as_the_single_ones(void **state)
{
    (void)state;
    enum { count = 301 };
    random_state r = {104};
    quat q[count], back[count];
    qvec3 image[count], flat[count], single;
    int half[count], side;
    size_t first;
    for (int n = 0; n < count; n++) q[n] = nasty(&r, n);
    assert_int_equal(quat_stereographic_array(count, q, QUAT_SOUTH_POLE, image, &first), QUAT_OK);
    assert_int_equal(first, count);
    assert_int_equal(quat_orthographic_array(count, q, flat, half, NULL), QUAT_OK);
    for (int n = 0; n < count; n++) {
        quat_stereographic(q[n], QUAT_SOUTH_POLE, &single);
        assert_memory_equal(&single, &image[n], sizeof single);
        quat_orthographic(q[n], &single, &side);
        assert_memory_equal(&single, &flat[n], sizeof single);
        assert_int_equal(side, half[n]);
    }
    quat_from_stereographic_array(count, image, QUAT_SOUTH_POLE, back);
    for (int n = 0; n < count; n++) assert_true(quat_near(back[n], q[n], 1e-15));
    assert_int_equal(quat_from_orthographic_array(count, flat, half, back, NULL), QUAT_OK);
    q[20] = minus;
    assert_int_equal(quat_stereographic_array(count, q, QUAT_SOUTH_POLE, image, &first), QUAT_AT_INFINITY);
    assert_int_equal(first, 20);
    q[200] = quat_make(0, 0, 0, 0);
    assert_int_equal(quat_stereographic_array(count, q, QUAT_SOUTH_POLE, image, &first), QUAT_EDOMAIN);
    assert_int_equal(first, 200);
    assert_int_equal(quat_orthographic_array(count, q, flat, NULL, &first), QUAT_EDOMAIN);
    half[7] = 9;
    assert_int_equal(quat_from_orthographic_array(count, flat, half, back, &first), QUAT_EARGUMENT);
    assert_int_equal(first, 7);
    assert_int_equal(quat_stereographic_array(0, NULL, QUAT_SOUTH_POLE, NULL, &first), QUAT_OK);
}

static void hopf(void **state)
{
    (void)state;
    random_state r = {105};
    double unit = 0, below = 0, along = 0, angle = 0, great = 0, oracle = 0;
    for (int n = 0; n < 100000; n++) {
        const quat q = random_unit(&r);
        const double t = random_between(&r, -3.14159, 3.14159);
        const qvec3 p = quat_hopf(q), d = random_direction(&r);
        worse(&unit, fabs(qvec3_norm(p) - 1));
        worse(&along, qvec3_norm(qvec3_sub(quat_hopf(quat_mul(q, quat_exp_pure(qvec3_make(0, 0, t)))), p)));
        worse(&oracle, error_of_vector(p, wide_rotate(wide_quat(q), (wquat){0, 0, 0, 1})));
        quat f, start;
        assert_int_equal(quat_hopf_fibre(n % 2 ? d : qvec3_scale(p, 7), t, &f), QUAT_OK);
        worse(&below, qvec3_norm(qvec3_sub(quat_hopf(f), n % 2 ? d : p)));
        quat_hopf_fibre(d, 0, &start);
        if (n % 2) {
            worse(&angle, fabs(remainder(quat_hopf_angle(f) - t, 6.283185307179586)) * fabs(start.w));
            worse(&great, fabs(quat_distance(f, start) - fabs(t)));
        } else {
            quat_hopf_fibre(p, quat_hopf_angle(q), &f);
            worse(&angle, quat_norm(quat_sub(f, q)) * hypot(q.w, q.z));
        }
    }
    assert_bound("|h(q)| = 1", unit, 2e-15);
    assert_bound("h(q), u", oracle, 6.5);
    assert_bound("h is the same along a fibre", along, 2e-15);
    assert_bound("h(fibre of p) = p", below, 2e-15);
    assert_bound("angle on the fibre", angle, 3e-15);
    assert_bound("fibres are great circles", great, 3e-15);
    /* over -z */
    quat f;
    assert_int_equal(quat_hopf_fibre(qvec3_make(0, 0, -2), 0.3, &f), QUAT_NOT_UNIQUE);
    assert_true(quat_near(f, quat_make(0, sin(0.3), cos(0.3), 0), 2e-16));
    assert_true(fabs(quat_hopf_angle(f) - 0.3) < 2e-16);
    assert_true(quat_hopf(f).z == -1);
    /* the fibres over z and -z are the great circles (w, z) and (x, y): two linked circles, images of a line and the
     * unit circle */
    quat_hopf_fibre(qvec3_make(0, 0, 1), 0.3, &f);
    assert_true(quat_near(f, quat_make(cos(0.3), 0, 0, sin(0.3)), 2e-16));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stereographic_against_the_oracle),
        cmocka_unit_test(there_and_back),
        cmocka_unit_test(the_poles_are_reported),
        cmocka_unit_test(bad_input_is_told),
        cmocka_unit_test(the_boundary),
        cmocka_unit_test(circle_and_sphere),
        cmocka_unit_test(arrays_do_as_the_single_ones),
        cmocka_unit_test(hopf),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
