/* SPDX-License-Identifier: MIT
 *
 * Quaternion Gauss maps: the frames chosen over a mesh, against the one case that is known in closed form.
 */
#include "oracle.h"

#include <string.h>
#include <quat/family.h>
#include <quat/rotation.h>
#include "handler.h"

static const double pi = 3.14159265358979324;

/* ---- parts of a sphere ---- */

enum { rings = 24, spokes = 48, cap_nodes = 1 + rings * spokes, cap_triangles = spokes * (2 * rings - 1) };

typedef struct cap {
    qvec3 x[cap_nodes];
    quat q[cap_nodes];
    size_t triangle[cap_triangles][3];
} cap;

/* The unit sphere within the angle `reach` of sign z, as rings about its pole. Normals outward. */
static void make_cap(int sign, double reach, cap *c)
{
    size_t m = 0;
    c->x[0] = qvec3_make(0, 0, sign);
    for (int i = 1; i <= rings; i++)
        for (int j = 0; j < spokes; j++) {
            const double polar = reach * i / rings, around = 2 * pi * j / spokes;
            c->x[1 + (i - 1) * spokes + j] =
                qvec3_make(sin(polar) * cos(around), sin(polar) * sin(around), sign * cos(polar));
        }
    for (size_t j = 0; j < spokes; j++) {
        const size_t next = (j + 1) % spokes;
        const size_t first[3] = {0, 1 + j, 1 + next};
        for (int k = 0; k < 3; k++) c->triangle[m][k] = first[k];
        m++;
        for (size_t i = 1; i < rings; i++) {
            const size_t a = 1 + (i - 1) * spokes + j, b = 1 + (i - 1) * spokes + next, d = a + spokes, e = b + spokes;
            const size_t two[2][3] = {{a, d, e}, {a, e, b}};
            for (int h = 0; h < 2; h++, m++)
                for (int k = 0; k < 3; k++) c->triangle[m][k] = two[h][k];
        }
    }
    assert_int_equal(m, cap_triangles);
    const quat pole = sign > 0 ? quat_identity() : quat_make(0, 1, 0, 0);
    c->q[0] = pole;
    for (size_t i = 1; i < cap_nodes; i++) quat_from_two_vectors(qvec3_make(0, 0, 1), c->x[i], &c->q[i]);
    /* any frames with these normals will do */
    random_state r = {405};
    for (size_t i = 1; i < cap_nodes; i++) {
        const double angle = random_between(&r, -9, 9);
        c->q[i] = quat_mul(c->q[i], quat_make(cos(angle), 0, 0, sin(angle)));
    }
}

/* Of a half sphere the best frames are the shortest rotations from its pole, which fill a cap of radius pi/4 of a great
 * sphere of S^3: totally geodesic, met by the circles of frames at right angles to its edge, area 2 pi (1 - cos pi/4).
 */
static void half_spheres(void **state)
{
    (void)state;
    static cap north, south;
    const double want = 2 * pi * (1 - sqrt(0.5)),
                 polygon = pow(2 * pi / spokes, 2) / 6; /* what a polygon lacks of a circle */
    double length = 0, area = 0, energy[3];
    for (int gauge = QUAT_SHORTEST; gauge <= QUAT_MINIMAL_AREA; gauge++) {
        quat_gauge_report report;
        make_cap(1, pi / 2, &north);
        assert_int_equal(quat_choose_frames(cap_nodes, north.x, cap_triangles, north.triangle[0], (quat_gauge)gauge,
                                            north.q, &report),
                         QUAT_OK);
        assert_int_equal(report.torn, 0);
        energy[gauge] = report.energy;
        double worst = 0;
        for (size_t i = 0; i < cap_nodes; i++) {
            quat shortest;
            quat_from_two_vectors(qvec3_make(0, 0, 1), north.x[i], &shortest);
            worse(&worst, quat_rotation_distance(shortest, north.q[i]));
        }
        if (gauge == QUAT_MINIMAL_LENGTH) length = worst;
        /* 2 pi times the integral of sin x (1/4 + 1/(4 cos^2 x/2)) */
        const double stretch = 2 * pi * (0.25 + log(2) / 2);
        if (gauge == QUAT_MINIMAL_LENGTH)
            assert_bound("squared stretch of it", fabs(report.energy / stretch - 1), polygon);
        if (gauge == QUAT_MINIMAL_AREA) area = worst;
        if (gauge != QUAT_SHORTEST)
            assert_bound("area of a half sphere's Gauss map", fabs(report.area - want) / want, polygon);
    }
    const double least = energy[QUAT_MINIMAL_LENGTH] * (1 - 1e-13);
    assert_true(least <= energy[QUAT_SHORTEST] && least <= energy[QUAT_MINIMAL_AREA]);
    assert_bound("least length against the shortest rotations", length, 1e-14);
    assert_bound("least area against them", area, 1e-14);

    quat_gauge_report report;
    make_cap(-1, pi / 2, &south);
    /* the southern triangles look inward; the frames do not mind */
    assert_int_equal(
        quat_choose_frames(cap_nodes, south.x, cap_triangles, south.triangle[0], QUAT_MINIMAL_LENGTH, south.q, &report),
        QUAT_OK);
    quat q1[spokes + 1], q2[spokes + 1];
    double angle[spokes + 1], turns, apart;
    for (size_t j = 0; j <= spokes; j++) {
        q1[j] = north.q[1 + (rings - 1) * spokes + j % spokes];
        q2[j] = south.q[1 + (rings - 1) * spokes + j % spokes];
    }
    assert_int_equal(quat_transition(spokes + 1, q1, q2, angle, &turns, &apart), QUAT_OK);
    assert_bound("winding of the sphere's transition + 2", fabs(turns + 2), 1e-14);
    assert_bound("normals along the seam", apart, 1e-14);
    /* s = q2* q1 stays on one circle; the thesis' t = q1 q2* turns about the normal, and that goes round */
    double fixed = 0, moving = 0;
    for (size_t j = 0; j <= spokes; j++) {
        const quat s = quat_mul(quat_conj(q2[j]), q1[j]), t = quat_mul(q1[j], quat_conj(q2[j]));
        worse(&fixed, hypot(s.x, s.y));
        worse(&moving, qvec3_norm(qvec3_cross(quat_vector(t), quat_rotate(q1[j], qvec3_make(0, 0, 1)))));
    }
    assert_bound("s off its circle about z", fixed, 1e-14);
    assert_bound("axis of q1 q2* against the normal", moving, 1e-14);
    double even = 0;
    for (size_t j = 0; j <= spokes; j++) worse(&even, fabs(angle[j] - angle[0] + 4 * pi * (double)j / spokes));
    assert_bound("its angle against a straight line", even, 1e-14);
}

/* Numbered from a node on the rim instead of the pole: the least frames are the same again, but for one angle common to
 * all. */
static void from_the_rim(double reach)
{
    static cap c, turned;
    make_cap(1, reach, &c);
    for (size_t i = 0; i < cap_nodes; i++) turned.x[i] = c.x[cap_nodes - 1 - i], turned.q[i] = c.q[cap_nodes - 1 - i];
    for (size_t i = 0; i < cap_triangles; i++)
        for (int k = 0; k < 3; k++) turned.triangle[i][k] = cap_nodes - 1 - c.triangle[i][k];
    double off_by[3] = {0}, energy[3];
    for (int gauge = QUAT_SHORTEST; gauge <= QUAT_MINIMAL_AREA; gauge++) {
        quat_gauge_report report;
        quat common = {0, 0, 0, 0};
        assert_int_equal(quat_choose_frames(cap_nodes, turned.x, cap_triangles, turned.triangle[0], (quat_gauge)gauge,
                                            turned.q, &report),
                         QUAT_OK);
        energy[gauge] = report.energy;
        for (size_t i = 0; i < cap_nodes; i++) {
            quat shortest;
            quat_from_two_vectors(qvec3_make(0, 0, 1), turned.x[i], &shortest);
            const quat s = quat_mul(quat_conj(shortest), turned.q[i]);
            if (i == 0) common = s;
            worse(&off_by[gauge], quat_rotation_distance(common, s));
        }
    }
    assert_true(energy[QUAT_MINIMAL_LENGTH] <= energy[QUAT_SHORTEST] * (1 + 1e-13));
    assert_bound("least length from the rim, rad", off_by[QUAT_MINIMAL_LENGTH], 1e-14);
    assert_bound("least area from the rim, rad", off_by[QUAT_MINIMAL_AREA], 1e-14);
}

static void the_start_does_not_matter(void **state)
{
    (void)state;
    from_the_rim(pi / 2);
    from_the_rim(3.05); /* all but a disc of 5 degrees, where frames carried along edges would whirl */
}

/* A square of the saddle: each strategy is the best by its own measure, whatever frames come in. */
static void least_area(void **state)
{
    (void)state;
    enum { n = 17 };
    static qvec3 x[n * n];
    static quat q[n * n];
    static size_t triangle[2 * (n - 1) * (n - 1)][3];
    const size_t m = 2 * (n - 1) * (n - 1);
    quat_family f;
    quat_surface s;
    double area[3], energy[3];
    quat_saddle(1, 2, &f, &s);
    assert_int_equal(quat_surface_patch(&s, -2, 2, -2, 2, n, n, x, q, triangle[0]), QUAT_OK);
    for (int gauge = QUAT_SHORTEST; gauge <= QUAT_MINIMAL_AREA; gauge++) {
        quat_gauge_report report;
        const quat_status status = quat_choose_frames(n * n, x, m, triangle[0], (quat_gauge)gauge, q, &report);
        assert_int_equal(status, QUAT_OK);
        assert_int_equal(report.torn, 0);
        area[gauge] = report.area, energy[gauge] = report.energy;
        if (gauge == QUAT_MINIMAL_AREA) show_figure("saddle, rounds to least area", (double)report.rounds);
    }
    assert_true(energy[QUAT_MINIMAL_LENGTH] < energy[QUAT_SHORTEST] &&
                energy[QUAT_MINIMAL_LENGTH] < energy[QUAT_MINIMAL_AREA]);
    assert_true(area[QUAT_MINIMAL_AREA] < area[QUAT_MINIMAL_LENGTH]);
    random_state r = {407};
    for (int round = 0; round < 3; round++) {
        static quat other[n * n];
        quat_gauge_report report;
        for (size_t i = 0; i < n * n; i++) {
            const double angle = i > 0 ? random_between(&r, -9, 9) : 0;
            other[i] = quat_mul(q[i], quat_make(cos(angle), 0, 0, sin(angle)));
        }
        assert_int_equal(quat_choose_frames(n * n, x, m, triangle[0], QUAT_MINIMAL_AREA, other, &report), QUAT_OK);
        assert_bound("area found again", fabs(report.area / area[QUAT_MINIMAL_AREA] - 1), 1e-14);
        double worst = 0;
        for (size_t i = 0; i < n * n; i++) worse(&worst, quat_rotation_distance(other[i], q[i]));
        assert_bound("frames found again, rad", worst, 1e-13);
    }
}

/* Seams of any normals, along which one frame turns in the other by a known angle: any winding, forward and back. */
static void transitions_wind_as_they_are_made(void **state)
{
    (void)state;
    enum { most = 60 };
    random_state r = {416};
    double angles = 0, winding = 0, reversed = 0;
    size_t coarse = 0;
    for (int round = 0; round < 10000; round++) {
        quat q1[most], q2[most], back1[most], back2[most];
        double angle[most], want[most], turns, again, apart;
        const size_t n = 2 + (size_t)(random_uniform(&r) * (most - 2));
        double widest = 0;
        want[0] = random_between(&r, -pi, pi);
        for (size_t i = 0; i < n; i++) {
            if (i > 0) want[i] = want[i - 1] + random_between(&r, -1, 1) * (round % 10 ? 2.35 : 3.1);
            if (i > 0) widest = fmax(widest, fabs(want[i] - want[i - 1]));
            const quat q = quat_scale(random_unit(&r), random_scale(&r, -3, 3));
            q2[i] = random_uniform(&r) < 0.5 ? q : quat_neg(q);
            q1[i] = quat_mul(q, quat_make(cos(want[i] / 2), 0, 0, sin(want[i] / 2)));
            back1[n - 1 - i] = q1[i], back2[n - 1 - i] = q2[i];
        }
        const quat_status status = quat_transition(n, q1, q2, angle, &turns, &apart);
        assert_int_equal(status, widest > 0.75 * pi ? QUAT_NOT_UNIQUE : QUAT_OK);
        coarse += status == QUAT_NOT_UNIQUE;
        for (size_t i = 0; i < n; i++) worse(&angles, fabs(angle[i] - want[i]));
        worse(&winding, fabs(turns - (want[n - 1] - want[0]) / (2 * pi)));
        assert_true(quat_transition(n, back1, back2, NULL, &again, NULL) == status && apart < 1e-14);
        worse(&reversed, fabs(turns + again));
    }
    assert_true(coarse > 100);
    assert_bound("angles along 10000 seams, rad", angles, 3e-14);
    assert_bound("their winding", winding, 5e-15);
    assert_bound("winding backward", reversed, 5e-15);
}

/* ---- what least area is ---- */

/* It knows a surface by its normals alone: half of any ellipsoid has a half sphere's frames, whatever its
 * least length. */
static void half_ellipsoids(void **state)
{
    (void)state;
    static cap c;
    random_state r = {410};
    double length = 0, area = 0;
    for (int round = 0; round < 10; round++) {
        const double square[3] = {random_between(&r, 0.1, 4), random_between(&r, 0.1, 4), random_between(&r, 0.1, 4)};
        double worst[3] = {0};
        for (int gauge = QUAT_MINIMAL_LENGTH; gauge <= QUAT_MINIMAL_AREA; gauge++) {
            make_cap(1, pi / 2, &c);
            qvec3 normal[cap_nodes];
            memcpy(normal, c.x, sizeof normal);
            for (size_t i = 0; i < cap_nodes; i++) {
                const qvec3 n = normal[i], x = {square[0] * n.x, square[1] * n.y, square[2] * n.z};
                c.x[i] = qvec3_scale(x, 1 / sqrt(qvec3_dot(x, n))); /* where the ellipsoid has this normal */
            }
            assert_int_equal(
                quat_choose_frames(cap_nodes, c.x, cap_triangles, c.triangle[0], (quat_gauge)gauge, c.q, NULL),
                QUAT_OK);
            for (size_t i = 0; i < cap_nodes; i++) {
                quat shortest;
                quat_from_two_vectors(qvec3_make(0, 0, 1), normal[i], &shortest);
                worse(&worst[gauge], quat_rotation_distance(shortest, c.q[i]));
            }
        }
        worse(&length, worst[QUAT_MINIMAL_LENGTH]);
        worse(&area, worst[QUAT_MINIMAL_AREA]);
    }
    assert_true(length > 0.1);
    assert_bound("half ellipsoids: least area, rad", area, 1e-13);
}

/* Tori cut open into one patch: all have the same normals, hence the same least area, and more than the 2 pi that the
 * two coverings of the sphere have when S^3 is seen over S^2 (a sphere of radius 1/2). Along the circles where K = 0
 * frames may slip past each other at no cost. */
static void whole_tori(void **state)
{
    (void)state;
    enum { n = 25, m = 2 * (n - 1) * (n - 1) };
    static qvec3 x[n * n];
    static quat given[n * n], q[n * n];
    static size_t triangle[m][3];
    const double radius[3] = {0.1, 0.8, 1.9};
    random_state r = {411};
    double least = 0, apart = 0, again = 0, fewest = INFINITY, most = 0;
    for (int which = 0; which < 3; which++) {
        quat_family f;
        quat_surface s;
        quat_gauge_report report[4];
        quat_torus(2, radius[which], &f, &s);
        assert_int_equal(quat_surface_patch(&s, 0, 2 * pi, 0, 2 * pi, n, n, x, given, triangle[0]), QUAT_OK);
        for (int round = QUAT_SHORTEST; round <= QUAT_MINIMAL_AREA + 1; round++) {
            const int gauge = round <= QUAT_MINIMAL_AREA ? round : QUAT_MINIMAL_AREA;
            memcpy(q, given, sizeof q);
            for (size_t i = 1; i < n * n && round > QUAT_MINIMAL_AREA; i++) { /* once more, from any frames */
                const double angle = random_between(&r, -9, 9);
                q[i] = quat_mul(q[i], quat_make(cos(angle), 0, 0, sin(angle)));
            }
            assert_int_equal(quat_choose_frames(n * n, x, m, triangle[0], (quat_gauge)gauge, q, &report[round]),
                             QUAT_OK);
            assert_int_equal(report[round].torn, 0);
        }
        assert_true(report[1].energy < report[0].energy && report[1].energy < report[2].energy);
        assert_true(report[2].area < report[1].area && report[2].area > 2 * pi);
        if (which == 0) least = report[2].area;
        worse(&apart, fabs(report[2].area / least - 1));
        worse(&again, fabs(report[3].area / report[2].area - 1));
        most = fmax(most, (double)report[2].rounds);
        fewest = fmin(fewest, (double)report[2].rounds);
    }
    show_figure("torus, fewest rounds to least area", fewest);
    show_figure("torus, most rounds to least area", most);
    assert_bound("least area of tori, thin and thick", apart, 1e-8);
    assert_bound("and from any frames", again, 1e-13);
}

/* The sum of the areas in quadruple precision, by Gram's determinant. */
static wide wide_area(size_t m, const size_t triangle[][3], const quat q[])
{
    wide sum = 0;
    for (size_t i = 0; i < m; i++) {
        const quat corner = q[triangle[i][0]];
        const wquat o = wide_quat(corner), a = wide_sub(wide_quat(quat_nearest(q[triangle[i][1]], corner)), o),
                    b = wide_sub(wide_quat(quat_nearest(q[triangle[i][2]], corner)), o);
        const wide ab = wide_dot(a, b);
        sum += sqrtf128(fmaxf128(wide_dot(a, a) * wide_dot(b, b) - ab * ab, 0)) / 2;
    }
    return sum;
}

/* No other angles near or far have less. */
static void nothing_is_less(void **state)
{
    (void)state;
    enum { n = 17, m = 2 * (n - 1) * (n - 1) };
    static qvec3 x[n * n];
    static quat q[n * n], other[n * n];
    static size_t triangle[m][3];
    random_state r = {412};
    quat_family f;
    quat_surface s;
    quat_gauge_report report;
    quat_saddle(1, 2, &f, &s);
    assert_int_equal(quat_surface_patch(&s, -2, 2, -2, 2, n, n, x, q, triangle[0]), QUAT_OK);
    assert_int_equal(quat_choose_frames(n * n, x, m, triangle[0], QUAT_MINIMAL_AREA, q, &report), QUAT_OK);
    const wide least = wide_area(m, (const size_t(*)[3])triangle, q);
    assert_bound("area against 128 bits", (double)fabsf128((wide)report.area / least - 1), 1e-14);
    double gained = 0;
    for (int round = 0; round < 2000; round++) {
        const double size = random_scale(&r, -7, 0), kx = random_between(&r, 0, 3), ky = random_between(&r, 0, 3),
                     phase = random_between(&r, 0, 2 * pi);
        for (size_t i = 0; i < n * n; i++) { /* in turn waves and each node for itself */
            const double angle =
                size * (round % 2 ? sin(kx * x[i].x + ky * x[i].y + phase) : random_between(&r, -1, 1));
            other[i] = quat_mul(q[i], quat_make(cos(angle / 2), 0, 0, sin(angle / 2)));
        }
        worse(&gained, (double)(1 - wide_area(m, (const size_t(*)[3])triangle, other) / least));
    }
    assert_bound("area that other angles save", gained, 0);
}

static void a_flat_patch_costs_nothing(void **state)
{
    (void)state;
    enum { n = 9 };
    qvec3 x[n * n];
    quat q[n * n];
    size_t triangle[2 * (n - 1) * (n - 1)][3], m = 0;
    random_state r = {406};
    for (size_t i = 0; i < n * n; i++) {
        const double angle = random_between(&r, -9, 9);
        x[i] = qvec3_make((double)(i % n), (double)i / n, 0); /* slanted */
        q[i] = quat_make(cos(angle), 0, 0, sin(angle));
    }
    for (size_t i = 0; i + n < n * n; i++) {
        if (i % n == n - 1) continue;
        const size_t two[2][3] = {{i, i + 1, i + n + 1}, {i, i + n + 1, i + n}};
        for (int h = 0; h < 2; h++, m++)
            for (int k = 0; k < 3; k++) triangle[m][k] = two[h][k];
    }
    for (int gauge = QUAT_SHORTEST; gauge <= QUAT_MINIMAL_AREA; gauge++) {
        quat_gauge_report report;
        const quat first = q[0];
        assert_int_equal(quat_choose_frames(n * n, x, m, triangle[0], (quat_gauge)gauge, q, &report), QUAT_OK);
        assert_true(fabs(report.energy) < 1e-25 && report.area < 1e-25 && report.torn == 0);
        for (size_t i = 0; i < n * n; i++) assert_true(quat_distance(q[i], first) < 1e-14);
    }
}

/* ---- bad input ---- */

/* A unit of length, a power of two, changes no bit: angles are all that lengths are asked for. */
static void units_change_nothing(void **state)
{
    (void)state;
    static cap c, other;
    static const int exponents[] = {-900, -545, -300, 520, 1020};
    for (int gauge = 0; gauge <= QUAT_MINIMAL_AREA; gauge++) {
        quat_gauge_report want, got;
        make_cap(1, 1.2, &c);
        assert_int_equal(
            quat_choose_frames(cap_nodes, c.x, cap_triangles, c.triangle[0], (quat_gauge)gauge, c.q, &want), QUAT_OK);
        assert_true(want.energy > 1);
        for (size_t k = 0; k < sizeof exponents / sizeof *exponents; k++) {
            make_cap(1, 1.2, &other);
            for (int i = 0; i < cap_nodes; i++)
                other.x[i] = qvec3_make(ldexp(other.x[i].x, exponents[k]), ldexp(other.x[i].y, exponents[k]),
                                        ldexp(other.x[i].z, exponents[k]));
            assert_int_equal(quat_choose_frames(cap_nodes, other.x, cap_triangles, other.triangle[0], (quat_gauge)gauge,
                                                other.q, &got),
                             QUAT_OK);
            assert_true(got.energy == want.energy && got.area == want.area && got.rounds == want.rounds);
            assert_memory_equal(c.q, other.q, sizeof c.q);
        }
    }
}

static void bad_input_has_a_status(void **state)
{
    (void)state;
    const qvec3 x[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
    const size_t one[3] = {0, 1, 2}, out[3] = {0, 1, 4};
    quat q[4] = {{1, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}};
    assert_int_equal(quat_choose_frames(3, x, 1, one, QUAT_MINIMAL_AREA, q, NULL), QUAT_OK);
    assert_int_equal(quat_choose_frames(3, x, 1, out, QUAT_SHORTEST, q, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(3, x, 0, one, QUAT_SHORTEST, q, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(3, x, 1, one, (quat_gauge)7, q, NULL), QUAT_EARGUMENT);
    assert_int_equal(quat_choose_frames(4, x, 1, one, QUAT_SHORTEST, q, NULL), QUAT_EDOMAIN);
    q[3] = quat_identity();
    assert_int_equal(quat_choose_frames(4, x, 1, one, QUAT_SHORTEST, q, NULL), QUAT_EARGUMENT); /* in two parts */
    q[1] = quat_make(0, 1, 0, 0); /* the normal turned over */
    assert_int_equal(quat_choose_frames(3, x, 1, one, QUAT_SHORTEST, q, NULL), QUAT_NOT_UNIQUE);
    assert_int_equal(quat_transition(0, q, q, NULL, NULL, NULL), QUAT_EARGUMENT);
    const quat up = {1, 0, 0, 0}, tipped = {1, 0.1, 0, 0};
    assert_int_equal(quat_transition(1, &up, &tipped, NULL, NULL, NULL), QUAT_EDOMAIN);
    assert_int_equal(handled, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(half_spheres),
                                       cmocka_unit_test(transitions_wind_as_they_are_made),
                                       cmocka_unit_test(the_start_does_not_matter),
                                       cmocka_unit_test(least_area),
                                       cmocka_unit_test(half_ellipsoids),
                                       cmocka_unit_test(whole_tori),
                                       cmocka_unit_test(nothing_is_less),
                                       cmocka_unit_test(a_flat_patch_costs_nothing),
                                       cmocka_unit_test(units_change_nothing),
                                       cmocka_unit_test(bad_input_has_a_status)};
    gsl_set_error_handler(count_call);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
