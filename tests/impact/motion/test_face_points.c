/* SPDX-License-Identifier: MIT
 *
 * The friction of points against that of the face they bear: sliding, turning and both, of polygons and discs, from
 * pressures that are even to such as leave the half of the points without.
 */
#include "motion/face_points.h"
#include "base/tolerances.h"
#include "kit/contact_random.h"
#include "kit/near.h"

static const double pi = 3.14159265358979323846;

/* A polygon round the origin, its points' mean, squashed; or a disc. */
static imp_flat_face some_face(random_stream *random, bool disc)
{
    imp_flat_face face = {.count = disc ? 0 : 3 + (int)(6 * random_unit(random)), .radius = disc};
    const double squash = 0.3 + 0.7 * random_unit(random), turn = 2 * pi * random_unit(random);
    double mean[2] = {0, 0};
    for (int i = 0; i < face.count; i++) {
        const double angle = 2 * pi * (i + 0.5 * random_unit(random)) / face.count, x = cos(angle),
                     y = squash * sin(angle);
        face.corner[i][0] = x * cos(turn) - y * sin(turn), face.corner[i][1] = x * sin(turn) + y * cos(turn);
        for (int k = 0; k < 2; k++) mean[k] += face.corner[i][k] / face.count;
    }
    for (int i = 0; i < face.count; i++)
        for (int k = 0; k < 2; k++) face.corner[i][k] -= mean[k];
    return face;
}

/* Its corners, or sixteen places of its rim, with parts of the pressure that differ by so much at most. */
static imp_face_points points_of(const imp_flat_face *face, double uneven, random_stream *random)
{
    imp_face_points points = {.count = face->count > 0 ? face->count : IMP_POINTS};
    double sum = 0, center[2] = {0, 0};
    for (int i = 0; i < points.count; i++) {
        const double angle = 2 * pi * i / points.count, on_rim[2] = {cos(angle), sin(angle)};
        for (int k = 0; k < 2; k++) points.bear[i][k] = face->count > 0 ? face->corner[i][k] : on_rim[k];
        sum += points.part[i] = 1 + uneven * (2 * random_unit(random) - 1);
    }
    for (int i = 0; i < points.count; i++)
        for (int k = 0; k < 2; k++) center[k] += (points.part[i] /= k > 0 ? 1 : sum) * points.bear[i][k];
    for (int i = 0; i < points.count; i++)
        for (int k = 0; k < 2; k++) points.bear[i][k] -= center[k];
    return points;
}

/* F and M about the origin, per unit of mu N. */
static void friction_of_points(const imp_face_points *points, const double twist[3], double f[3])
{
    f[0] = f[1] = f[2] = 0;
    for (int i = 0; i < points->count; i++) {
        const double *y = points->rub[i], u[2] = {twist[0] - twist[2] * y[1], twist[1] + twist[2] * y[0]};
        const double part = points->strength * points->part[i] / hypot(u[0], u[1]);
        f[0] -= part * u[0], f[1] -= part * u[1], f[2] -= part * (y[0] * u[1] - y[1] * u[0]);
    }
}

static void friction_of_face(const imp_flat_face *face, const double twist[3], double f[3])
{
    double rub[3][3], m[3][3];
    imp_pressed whole;
    imp_press_all(face, &whole);
    imp_press_moments(&whole, m);
    imp_press_rub(&whole, twist, rub);
    for (int i = 0; i < 3; i++) f[i] = rub[i][0] / m[0][0];
}

enum { RUNS = 1000 };

/* How many have places; the worst difference of these. */
static int compare(double uneven, double turning, double *worst)
{
    random_stream random = {7};
    int found = 0;
    *worst = 0;
    for (int k = 0; k < RUNS; k++) {
        const imp_flat_face face = some_face(&random, k % 10 == 0);
        imp_face_points points = points_of(&face, uneven, &random);
        const double way = 2 * pi * random_unit(&random), twist[3] = {cos(way), sin(way), k % 2 ? turning : -turning};
        double wanted[3], got[3];
        if (!imp_points_as_face(&face, twist, &points)) continue;
        assert_true(points.k > 0 && points.k <= 1 && points.strength > 0);
        friction_of_face(&face, twist, wanted);
        friction_of_points(&points, twist, got);
        for (int i = 0; i < 3; i++) *worst = fmax(*worst, fabs(got[i] - wanted[i]));
        found++;
    }
    return found;
}

/* Where it slides as fast as its border turns, or faster, all have; where it turns faster nine in ten, more of even
 * pressures. */
static void points_rub_as_the_face_does(void **state)
{
    (void)state;
    static const double turning[] = {1e-3, 0.1, 0.5, 1, 2, 10, 1e3};
    for (int k = 0; k < 7; k++)
        for (int uneven = 0; uneven < 2; uneven++) {
            double worst;
            const int found = compare(0.5 * uneven, turning[k], &worst);
            assert_true(found >= (turning[k] <= 1 ? 1 : uneven ? 0.88 : 0.94) * RUNS);
            assert_true(worst <= 2 * (turning[k] > 1 ? IMP_GLIDE_USABLE : IMP_GLIDE_KNOWN));
        }
}

/* A square: at k = 1/sqrt(3) of their ways where it all but slides; turning on the spot k^2 = r/(2 i), s = r/(sqrt 2
 * k), with the mean distance r = (sqrt 2 + asinh 1)/3 and the mean inverse i = 2 asinh 1 of that. */
static void limits_of_a_square(void **state)
{
    (void)state;
    const imp_flat_face square = {.count = 4, .corner = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
    imp_face_points points = {.count = 4, .bear = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}, .part = {.25, .25, .25, .25}};
    const double slides[3] = {3, 4, 0}, spins[3] = {0, 0, -2};
    assert_true(imp_points_as_face(&square, slides, &points));
    assert_near(points.k, 1 / sqrt(3), 2e-6);
    assert_near(points.strength, 1, 2e-6);
    assert_true(imp_points_as_face(&square, spins, &points));
    const double r = (sqrt(2) + asinh(1)) / 3, inverse = 2 * asinh(1), k = sqrt(r / (2 * inverse));
    assert_near(points.k, k, 1e-12);
    assert_near(points.strength, r / (sqrt(2) * k), 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(points_rub_as_the_face_does),
                                       cmocka_unit_test(limits_of_a_square)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
