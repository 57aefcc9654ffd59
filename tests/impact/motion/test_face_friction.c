/* SPDX-License-Identifier: MIT
 *
 * The friction of a face against adaptive quadrature over its area, against closed forms, turned and mirrored, and from
 * where its two ways of summing meet; and a square that slides and turns to its end against the numbers of another
 * program, in which two methods agree (docs/faces.md).
 */
#include "motion/face_friction.h"
#include <stdlib.h>
#include "base/tolerances.h"
#include "kit/near.h"

static double uniform(unsigned long *seed, double low, double high)
{
    *seed = *seed * 6364136223846793005UL + 1442695040888963407UL;
    return low + (high - low) * (double)(*seed >> 11) * 0x1p-53;
}

static const double pi = 3.14159265358979323846;

/* Corners on an ellipse, or a disc, away from the origin. */
static imp_flat_face random_face(unsigned long *seed, bool disc)
{
    imp_flat_face face = {.center = {uniform(seed, -.3, .3), uniform(seed, -.3, .3)}, .radius = uniform(seed, .5, 1)};
    if (disc) return face;
    const double squash = uniform(seed, .1, 1), turn = uniform(seed, 0, pi);
    face.count = 3 + (int)uniform(seed, 0, 10);
    for (int i = 0; i < face.count; i++) {
        const double angle = 2 * pi * (i + uniform(seed, 0, .7)) / face.count, x = cos(angle), y = squash * sin(angle);
        face.corner[i][0] = face.center[0] + face.radius * (x * cos(turn) - y * sin(turn));
        face.corner[i][1] = face.center[1] + face.radius * (x * sin(turn) + y * cos(turn));
    }
    return face;
}

/* ---- the oracle: strips across x, each along y, halved until sixteen Gauss places and twice eight agree ---- */

typedef struct oracle {
    const imp_flat_face *face;
    const double *p, *twist;
    int part; /* 0, 1: force; 2: moment; 3: 1/|u| */
    double x, scale;
} oracle;

typedef double integrand(oracle *o, double s);
enum { DEPTH = 40 };

static double eight(integrand *f, oracle *o, double from, double to)
{
    static const double place[4] = {0.18343464249564978, 0.525532409916329, 0.7966664774136267, 0.9602898564975362},
                        weight[4] = {0.36268378337836166, 0.3137066458778869, 0.22238103445337443, 0.10122853629037706};
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
        sum += half * weight[k] * (f(o, middle - half * place[k]) + f(o, middle + half * place[k]));
    }
    return sum;
}

static double adapt(integrand *f, oracle *o, double from, double to, double whole, double allowed, int depth)
{
    const double middle = 0.5 * (from + to), a = eight(f, o, from, middle), b = eight(f, o, middle, to);
    if (depth == 0 || (depth < DEPTH - 3 && fabs(a + b - whole) <= allowed)) return a + b; /* no agreement by chance */
    return adapt(f, o, from, middle, a, allowed, depth - 1) + adapt(f, o, middle, to, b, allowed, depth - 1);
}

static double integral(integrand *f, oracle *o, double from, double to, double allowed)
{
    return to > from ? adapt(f, o, from, to, eight(f, o, from, to), allowed, DEPTH) : 0;
}

static double friction_there(oracle *o, double y)
{
    const double *v = o->twist, u[2] = {v[0] - v[2] * y, v[1] + v[2] * o->x}, size = hypot(u[0], u[1]);
    const double p = o->p[0] + o->p[1] * o->x + o->p[2] * y;
    if (!(size > 0)) return 0;
    if (o->part == 3) return p / size;
    return -p / size * (o->part == 0 ? u[0] : o->part == 1 ? u[1] : o->x * u[1] - y * u[0]);
}

/* Ends of the face along y, its part of p >= 0 alone. */
static bool strip(const oracle *o, double *low, double *high)
{
    const imp_flat_face *face = o->face;
    *low = INFINITY, *high = -INFINITY;
    if (face->count == 0) {
        const double d = o->x - face->center[0], half = sqrt(fmax(0, face->radius * face->radius - d * d));
        *low = face->center[1] - half, *high = face->center[1] + half;
    }
    for (int i = 0; i < face->count; i++) {
        const double *a = face->corner[i], *b = face->corner[(i + 1) % face->count];
        if ((a[0] - o->x) * (b[0] - o->x) > 0 || a[0] == b[0]) continue;
        const double y = a[1] + (b[1] - a[1]) * (o->x - a[0]) / (b[0] - a[0]);
        *low = fmin(*low, y), *high = fmax(*high, y);
    }
    const double zero = -(o->p[0] + o->p[1] * o->x) / o->p[2];
    if (o->p[2] > 0) *low = fmax(*low, zero);
    if (o->p[2] < 0) *high = fmin(*high, zero);
    return *high > *low;
}

/* Across a disc by the angle: what its strips' ends do at its sides is then smooth. */
static double strip_integral(oracle *o, double s)
{
    const imp_flat_face *face = o->face;
    const bool disc = face->count == 0;
    double low, high, middle = o->twist[0] / o->twist[2];
    o->x = disc ? face->center[0] + face->radius * sin(s) : s;
    if (!strip(o, &low, &high)) return 0;
    if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
    const double allowed = 1e-14 * o->scale, width = disc ? face->radius * cos(s) : 1;
    return width *
           (integral(friction_there, o, low, middle, allowed) + integral(friction_there, o, middle, high, allowed));
}

static int disc_cuts(const oracle *o, double *cut)
{
    const imp_flat_face *face = o->face;
    const double slope = hypot(o->p[1], o->p[2]),
                 middle = o->p[0] + o->p[1] * face->center[0] + o->p[2] * face->center[1],
                 half = acos(fmin(1, fmax(-1, -middle / (slope * face->radius)))), about = atan2(o->p[2], o->p[1]);
    int cuts = 0;
    cut[cuts++] = -pi / 2, cut[cuts++] = pi / 2;
    cut[cuts++] = asin(cos(about + half)), cut[cuts++] = asin(cos(about - half));
    const double turning = (-o->twist[1] / o->twist[2] - face->center[0]) / face->radius;
    if (fabs(turning) < 1) cut[cuts++] = asin(turning);
    return cuts;
}

static int polygon_cuts(const oracle *o, double *cut)
{
    const imp_flat_face *face = o->face;
    const double turning = -o->twist[1] / o->twist[2];
    double first = INFINITY, last = -INFINITY;
    int cuts = 0;
    for (int i = 0; i < face->count; i++) {
        const double *a = face->corner[i], *b = face->corner[(i + 1) % face->count];
        const double from = o->p[0] + o->p[1] * a[0] + o->p[2] * a[1], to = o->p[0] + o->p[1] * b[0] + o->p[2] * b[1];
        cut[cuts++] = a[0];
        first = fmin(first, a[0]), last = fmax(last, a[0]);
        if (from * to < 0) cut[cuts++] = a[0] + (b[0] - a[0]) * from / (from - to);
    }
    if (turning > first && turning < last) cut[cuts++] = turning;
    return cuts;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Over x, from corner to corner and to the centre of turning. */
static double oracle_sum(oracle *o)
{
    double cut[2 * IMP_FLAT_SIDES + 1], sum = 0;
    const int cuts = o->face->count == 0 ? disc_cuts(o, cut) : polygon_cuts(o, cut);
    qsort(cut, (size_t)cuts, sizeof *cut, ascending);
    for (int i = 0; i + 1 < cuts; i++) sum += integral(strip_integral, o, cut[i], cut[i + 1], 1e-14 * o->scale);
    return sum;
}

/* F, M of the part of the face that the pressure presses. */
static void friction_of(const imp_flat_face *face, const double p[3], const double twist[3], double f[3])
{
    imp_pressed pressed;
    double rub[3][3];
    imp_press_part(face, p, &pressed);
    imp_press_rub(&pressed, twist, rub);
    for (int i = 0; i < 3; i++) f[i] = rub[i][0] * p[0] + rub[i][1] * p[1] + rub[i][2] * p[2];
}

/* About a place of the face's, this far from its middle. */
static void turn_about(const imp_flat_face *face, double distance, double angle, double omega, double twist[3])
{
    imp_pressed whole;
    imp_press_all(face, &whole);
    const double o[2] = {whole.middle[0] + distance * cos(angle), whole.middle[1] + distance * sin(angle)};
    twist[0] = omega * o[1], twist[1] = -omega * o[0], twist[2] = omega;
}

static void random_pressure(const imp_flat_face *face, unsigned long *seed, bool cut, double p[3])
{
    p[0] = 1, p[1] = uniform(seed, -.3, .3), p[2] = uniform(seed, -.3, .3);
    if (cut) {
        const double *middle = face->count > 0 ? face->corner[1] : face->center;
        for (int i = 1; i < 3; i++) p[i] *= 10;
        p[0] = .1 - p[1] * (face->center[0] + .2 * (middle[0] - face->center[0])) -
               p[2] * (face->center[1] + .2 * (middle[1] - face->center[1]));
    }
}

static void it_is_the_integral_over_the_area(void **state)
{
    (void)state;
    unsigned long seed = 1;
    static const double near[] = {1, 1 - 1e-3, 1 + 1e-6, 1 - 1e-9, .3, 0, 2, 3.9, 4.1, 30, 1e4};
    for (int k = 0; k < 33; k++) {
        const imp_flat_face face = random_face(&seed, k % 3 == 0);
        double p[3], twist[3], got[3];
        random_pressure(&face, &seed, k % 2, p);
        const double distance = face.radius * near[k % 11], omega = uniform(&seed, .1, 2) * (k % 4 < 2 ? 1 : -1);
        turn_about(&face, distance, uniform(&seed, 0, 2 * pi), omega, twist);
        friction_of(&face, p, twist, got);
        oracle o = {.face = &face, .p = p, .twist = twist, .scale = fmax(1, face.radius * hypot(p[1], p[2]))};
        for (o.part = 0; o.part < 3; o.part++) assert_near(got[o.part], oracle_sum(&o), 2e-13 * o.scale);
    }
}

static void the_inverse_of_the_speed_too(void **state)
{
    (void)state;
    unsigned long seed = 5;
    static const double near[] = {1 - 1e-3, .3, 0, 2, 3.9, 4.1, 30};
    const double even[3] = {1, 0, 0};
    for (int k = 0; k < 21; k++) {
        const imp_flat_face face = random_face(&seed, k % 3 == 0);
        imp_pressed whole;
        double twist[3];
        imp_press_all(&face, &whole);
        turn_about(&face, face.radius * near[k % 7], uniform(&seed, 0, 2 * pi), k % 2 ? 1 : -2, twist);
        oracle o = {.face = &face, .p = even, .twist = twist, .part = 3, .scale = 1e4};
        const double sum = oracle_sum(&o);
        assert_near(imp_press_inverse_speed(&whole, twist), sum, 1e-9 * sum);
    }
}

/* The border's sums and the area's, on both sides of where one takes over from the other. */
static void both_sums_meet(void **state)
{
    (void)state;
    unsigned long seed = 2;
    for (int k = 0; k < 2000; k++) {
        const imp_flat_face face = random_face(&seed, k % 2);
        imp_pressed whole;
        double p[3], twist[3], near[3], far[3];
        const double angle = uniform(&seed, 0, 2 * pi);
        imp_press_all(&face, &whole);
        random_pressure(&face, &seed, false, p);
        const double distance = IMP_FACE_DISTANT * whole.reach;
        turn_about(&face, distance * (1 - 1e-14), angle, 1, twist);
        friction_of(&face, p, twist, near);
        turn_about(&face, distance * (1 + 1e-14), angle, 1, twist);
        friction_of(&face, p, twist, far);
        for (int i = 0; i < 3; i++) assert_near(near[i], far[i], 3e-14);
    }
}

static imp_flat_face square(double half)
{
    return (imp_flat_face){.count = 4, .corner = {{-half, -half}, {half, -half}, {half, half}, {-half, half}}};
}

/* What slides without turning is held by mu N at the centre of pressure; what turns on the spot by mu N times the mean
 * distance: of a square (sqrt 2 + asinh 1)/3 of its half side, of a disc 2/3 of its radius. */
static void closed_forms(void **state)
{
    (void)state;
    const imp_flat_face box = square(1), disc = {.radius = 1};
    const double uniform_pressure[3] = {1, 0, 0}, tilted[3] = {1, .4, -.3}, spin[3] = {0, 0, -2}, slide[3] = {3, 4, 0};
    double f[3];
    friction_of(&box, uniform_pressure, spin, f);
    assert_near(f[2], 4 * (sqrt(2) + asinh(1)) / 3, 4e-15);
    assert_near(hypot(f[0], f[1]), 0, 1e-15);
    friction_of(&disc, uniform_pressure, spin, f);
    assert_near(f[2], 2 * pi / 3, 4e-15);
    friction_of(&box, tilted, slide, f);
    assert_near(f[0], -4 * .6, 4e-15);
    assert_near(f[1], -4 * .8, 4e-15);
    assert_near(f[2], -(.4 * 4 / 3) * .8 + (-.3 * 4 / 3) * .6, 4e-15); /* x F_y - y F_x, int x^2 = 4/3 */
}

/* The most that friction can take: convex and of the first degree in the twist, and so is what it takes. */
static void power_is_convex(void **state)
{
    (void)state;
    unsigned long seed = 3;
    for (int k = 0; k < 2000; k++) {
        const imp_flat_face face = random_face(&seed, k % 2);
        double p[3], twist[3][3], f[3], power[3];
        random_pressure(&face, &seed, false, p);
        for (int i = 0; i < 3; i++) {
            twist[0][i] = uniform(&seed, -1, 1), twist[1][i] = uniform(&seed, -1, 1);
            twist[2][i] = twist[0][i] + twist[1][i];
        }
        for (int j = 0; j < 3; j++) {
            friction_of(&face, p, twist[j], f);
            power[j] = -(f[0] * twist[j][0] + f[1] * twist[j][1] + f[2] * twist[j][2]);
        }
        assert_at_most(power[2], power[0] + power[1] + 1e-14);
        /* a force of another twist does no more against this one */
        const double other = -(f[0] * twist[0][0] + f[1] * twist[0][1] + f[2] * twist[0][2]);
        assert_at_most(other, power[0] + 1e-14);
    }
}

/* A square of half side 1 under uniform pressure, mu = g = v = w = 1, until it stops: time, angle and way of another
 * program, in which RK4 and DOP853 agree to 2e-6 (docs/faces.md). */
static void a_square_slides_and_turns_to_its_end(void **state)
{
    (void)state;
    const imp_flat_face box = square(1);
    const double p[3] = {.25, 0, 0}, inertia = 2.0 / 3, h = 1e-3;
    double y[6] = {1, 1, 0, 0, 0, 0}; /* v, w, way, turn, time, across */
    for (double left = 1; left > 1e-9;) {
        double rate[4][6], at[6];
        for (int s = 0; s < 4; s++) {
            double f[3];
            for (int i = 0; i < 6; i++) at[i] = y[i] + (s == 0 ? 0 : h * (s == 3 ? 1 : .5) * rate[s - 1][i]);
            const double size = hypot(at[0], at[1]), c = cos(at[3]), n = sin(at[3]);
            const double twist[3] = {c * at[0] + n * at[5], c * at[5] - n * at[0], at[1]};
            friction_of(&box, p, twist, f);
            const double r[6] = {c * f[0] - n * f[1], f[2] / inertia, at[0], at[1], 1, n * f[0] + c * f[1]};
            for (int i = 0; i < 6; i++) rate[s][i] = size * r[i];
        }
        for (int i = 0; i < 6; i++) y[i] += h * (rate[0][i] + 2 * rate[1][i] + 2 * rate[2][i] + rate[3][i]) / 6;
        left = hypot(y[0], y[1]);
    }
    assert_near(y[4], 1.4190, 5e-5);
    assert_near(y[3], .7442, 5e-5);
    assert_near(y[2], .6817, 5e-5);
    assert_near(y[0] / y[1], .752, 5e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_is_the_integral_over_the_area),
                                       cmocka_unit_test(the_inverse_of_the_speed_too),
                                       cmocka_unit_test(both_sums_meet),
                                       cmocka_unit_test(closed_forms),
                                       cmocka_unit_test(power_is_convex),
                                       cmocka_unit_test(a_square_slides_and_turns_to_its_end)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
