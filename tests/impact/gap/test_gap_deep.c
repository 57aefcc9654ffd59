/* SPDX-License-Identifier: MIT
 *
 * Deep overlaps: octahedra against brute force over all features in 128 bits; other bodies with edges, in random and
 * in symmetric poses, against normals without number: no way out is nearer than the bracket says; and the way that is
 * given leads out, by the bodies' inequalities.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <impact/gap.h>
#include "kit/face_pairs.h"
#include "kit/figures.h"
#include "kit/mixed_pairs.h"

static double thinnest(const impact_shape *s) { return fmin(s->a, fmin(s->b, s->c)); }

static double reach_of(const impact_solid b[2])
{
    return fmax(contact_size(&b[0].shape), contact_size(&b[1].shape)) +
           qvec3_norm(qvec3_sub(b[0].position, b[1].position));
}

static impact_solid with_exponents(double a, double b, double c, double r, double s, double t)
{
    impact_solid body = {.orientation = {1, 0, 0, 0}};
    assert_int_equal(impact_shape_superquadric(a, b, c, r, s, t, &body.shape), IMPACT_OK);
    return body;
}

/* g along the unit n: no more than the gap. */
static double deep_along(const impact_solid body[2], qvec3 n)
{
    const qvec3 d = qvec3_add(qvec3_sub(body[0].position, body[1].position),
                              qvec3_sub(contact_support(&body[0], qvec3_neg(n)), contact_support(&body[1], n)));
    return qvec3_dot(n, d);
}

/* Rotations that bodies with three planes of symmetry have in common poses: by multiples of 45 degrees about axes and
 * diagonals, or none. */
static quat symmetric_turn(random_stream *random)
{
    static const qvec3 axes[7] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}};
    quat q;
    const qvec3 axis = axes[random_bits(random) % 7];
    quat_from_axis_angle(axis, 0.7853981633974483 * (double)(random_bits(random) % 8), &q);
    return q;
}

static qvec3 symmetric_place(random_stream *random, double far)
{
    const double x = (double)(random_bits(random) % 3) - 1, y = (double)(random_bits(random) % 3) - 1,
                 z = (double)(random_bits(random) % 3) - 1;
    return qvec3_scale((qvec3){x, y, z}, far * (double)(random_bits(random) % 3) / 2);
}

/* ---- octahedra, by brute force ---- */

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 wide;
enum { CORNERS = 36 };

static void wide_corners(const impact_solid *body, wide corner[6][3])
{
    wide q[4] = {body->orientation.w, body->orientation.x, body->orientation.y, body->orientation.z}, n = 0;
    for (int i = 0; i < 4; i++) n += q[i] * q[i];
    const wide w = q[0], x = q[1], y = q[2], z = q[3];
    const wide R[3][3] = {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    const double axis[3] = {body->shape.a, body->shape.b, body->shape.c};
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 3; i++) corner[k][i] = (k % 2 ? -1 : 1) * axis[k / 2] * R[i][k / 2] / n;
}

/* The squares of planes' distances from the origin, least of the planes through any three corners of the difference
 * that leave all the others on one side: its facets. */
static double brute_depth(const impact_solid body[2])
{
    wide one[6][3], two[6][3], v[CORNERS][3], least = INFINITY;
    wide_corners(&body[0], one);
    wide_corners(&body[1], two);
    const double p[2][3] = {{body[0].position.x, body[0].position.y, body[0].position.z},
                            {body[1].position.x, body[1].position.y, body[1].position.z}};
    for (int k = 0; k < CORNERS; k++)
        for (int i = 0; i < 3; i++) v[k][i] = one[k / 6][i] + p[0][i] - two[k % 6][i] - p[1][i];
    for (int a = 0; a < CORNERS; a++)
        for (int b = a + 1; b < CORNERS; b++)
            for (int c = b + 1; c < CORNERS; c++) {
                wide e[3], f[3], n[3], low = INFINITY, high = -INFINITY;
                for (int i = 0; i < 3; i++) e[i] = v[b][i] - v[a][i], f[i] = v[c][i] - v[a][i];
                for (int i = 0; i < 3; i++) n[i] = e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3];
                const wide square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
                if (square < 1e-40) continue; /* in line, to the rounding of doubles' products */
                const wide at = n[0] * v[a][0] + n[1] * v[a][1] + n[2] * v[a][2];
                for (int k = 0; k < CORNERS; k++) {
                    const wide off = n[0] * v[k][0] + n[1] * v[k][1] + n[2] * v[k][2] - at;
                    low = off < low ? off : low, high = off > high ? off : high;
                }
                const wide room = 1e-28 * (square + 1); /* corners in the plane, but for rounding */
                if (low < -room && high > room) continue;
                const wide distance = at * at / square;
                least = distance < least ? distance : least;
            }
    return sqrt((double)least);
}

static void octahedra_against_all_features(void **state)
{
    (void)state;
    random_stream random = {31};
    double worst = 0;
    for (int k = 0; k < 120; k++) {
        impact_solid body[2];
        for (int i = 0; i < 2; i++) {
            const double a = random_log(&random, 0.2, 1), b = random_log(&random, 0.2, 1),
                         c = random_log(&random, 0.2, 1);
            const bool regular = k % 3 == 0;
            body[i] = regular ? with_exponents(1, 1, 1, 1, 1, 1) : with_exponents(a, b, c, 1, 1, 1);
            body[i].orientation = k % 2 ? random_rotation(&random) : symmetric_turn(&random);
        }
        body[0].position = k % 4 < 2 ? symmetric_place(&random, 0.4) : random_vector(&random, 1e-3, 0.4);
        impact_contact c;
        const impact_status status = impact_gap(&body[0], &body[1], NULL, &c);
        if (c.gap >= 0) continue;
        if (status != IMPACT_OK) fail_msg("%d: status %d, gap %g in [%g, %g]", k, status, c.gap, c.lower, c.upper);
        const double error = fabs(c.gap + brute_depth(body)) / reach_of(body);
        worst = fmax(worst, error);
        if (!(error <= 4e-15)) fail_msg("%d: gap %.17g, by brute force %.17g", k, c.gap, -brute_depth(body));
        /* the witness points lie in their bodies, and differ by gap n */
        const qvec3 x1 = quat_rotate_inverse(body[0].orientation, c.offset1),
                    x2 = quat_rotate_inverse(body[1].orientation, c.offset2);
        assert_true(impact_shape_inside(&body[0].shape, x1) <= 1 + 1e-13);
        assert_true(impact_shape_inside(&body[1].shape, x2) <= 1 + 1e-13);
        const qvec3 v = qvec3_sub(qvec3_add(qvec3_sub(body[0].position, body[1].position), c.offset1), c.offset2);
        assert_true(qvec3_norm(qvec3_axpy(-c.gap, c.normal, v)) <= 1e-14 * reach_of(body));
    }
    show_figure("octahedra against all features, relative", worst);
}
#endif

/* ---- any bodies, against normals without number ---- */

/* The largest g near n by steps across it, halved when none is better. */
static double ascend(const impact_solid body[2], random_stream *random, qvec3 n)
{
    double best = deep_along(body, n);
    for (double step = 0.3; step > 1e-6;) {
        bool better = false;
        for (int i = 0; i < 8 && !better; i++) {
            const qvec3 m = qvec3_axpy(step, random_direction(random), n), unit = qvec3_scale(m, 1 / qvec3_norm(m));
            const double g = deep_along(body, unit);
            if (g > best) best = g, n = unit, better = true;
        }
        if (!better) step /= 2;
    }
    return best;
}

typedef struct tally {
    int asked, ok, deep, bracket;
    double widest; /* bracket over depth */
} tally;

static void check_overlap(random_stream *random, const impact_solid body[2], int starts, tally *t)
{
    impact_contact c;
    const impact_status status = impact_gap(&body[0], &body[1], NULL, &c);
    assert_true(status >= 0);
    if (!(c.upper < -1e-6 * thinnest(&body[0].shape))) return;
    const double reach = reach_of(body), room = 2e-14 * reach;
    t->asked++;
    t->ok += status == IMPACT_OK, t->deep += status == IMPACT_DEEP, t->bracket += status == IMPACT_BRACKET;
    t->widest = fmax(t->widest, (c.upper - c.lower) / -c.gap);
    assert_true(c.lower <= c.gap && c.gap <= c.upper);
    if (!(deep_along(body, c.normal) >= c.lower - room))
        fail_msg("g = %.17g along the normal, lower %.17g", deep_along(body, c.normal), c.lower);
    if (status == IMPACT_OK) assert_true(c.upper - c.lower <= 2e-14 * reach);
    for (int i = 0; i < starts; i++) {
        const double g = ascend(body, random, random_direction(random));
        if (!(g <= c.upper + room))
            fail_msg("status %d: g = %.17g, bracket [%.17g, %.17g], exponents %g %g %g, %g %g %g", status, g, c.lower,
                     c.upper, body[0].shape.r, body[0].shape.s, body[0].shape.t, body[1].shape.r, body[1].shape.s,
                     body[1].shape.t);
    }
}

static void report(const char *name, const tally *t)
{
    const char *const what[] = {"asked", "ok", "deep", "bracket", "widest over depth"};
    const double values[] = {t->asked, t->ok, t->deep, t->bracket, t->widest};
    for (int i = 0; i < 5; i++) {
        char line[80];
        snprintf(line, sizeof line, "%s, %s", name, what[i]);
        show_figure(line, values[i]);
    }
}

/* Exponents under 2, and others, overlapped by a hundredth of the thinnest axis and up to concentric. */
static void nearest_way_out_of_random_overlaps(void **state)
{
    (void)state;
    random_stream random = {32};
    static const int families[] = {RANDOM_OCTAHEDRAL, RANDOM_ROUND, RANDOM_MIXED,    RANDOM_OCTAHEDRAL,
                                   RANDOM_BARR,       RANDOM_BOXY,  RANDOM_ELLIPSOID};
    tally t = {0};
    for (int k = 0; k < 210; k++) {
        impact_solid body[2];
        double thin = INFINITY;
        for (int i = 0; i < 2; i++) {
            body[i] = (impact_solid){.shape = random_shape(&random, families[k % 7]),
                                     .orientation = random_rotation(&random)};
            thin = fmin(thin, thinnest(&body[i].shape));
        }
        body[0].position = random_vector(&random, 1e-3 * thin, 1.5 * thin);
        check_overlap(&random, body, 12, &t);
    }
    report("random overlaps", &t);
    assert_true(t.asked == 210 && t.ok >= 200);
    assert_true(t.widest <= 0.01);
}

/* The same bodies in poses where many ways out are equally near. */
static void nearest_way_out_of_symmetric_poses(void **state)
{
    (void)state;
    random_stream random = {33};
    static const double exponents[] = {1, 1.05, 1.2, 1.5, 1.8, 2, 4};
    tally t = {0};
    for (int k = 0; k < 210; k++) {
        impact_solid body[2];
        for (int i = 0; i < 2; i++) {
            const double p = exponents[(k + 3 * i * (k % 2)) % 7], flat = k % 3 == 2 ? 0.5 : 1;
            body[i] = with_exponents(1, 1, flat, p, p, p);
            body[i].orientation = symmetric_turn(&random);
        }
        body[0].position = symmetric_place(&random, 0.3);
        check_overlap(&random, body, 12, &t);
    }
    report("symmetric poses", &t);
    assert_true(t.asked == 206 && t.ok >= 183 && t.bracket <= 6);
    assert_true(t.widest <= 0.01);
}

/* Bodies that are concentric and alike turned have as many equal ways out as faces or corners: six of height 2 along
 * the axes, or eight along (1, 1, 1), where a superquadric's support is 3^(1/2 - 1/p). Where each is known the proof
 * that none is nearer ends. */
static void equal_ways_out_are_proved(void **state)
{
    (void)state;
    static const double exponents[4][2] = {{4, 4}, {1.5, 4}, {4, 1.5}, {1, 1.5}};
    random_stream random = {36};
    int proved = 0;
    double worst = 0;
    for (int k = 0; k < 80; k++) {
        const double *p = exponents[k % 4];
        impact_solid body[2] = {with_exponents(1, 1, 1, p[0], p[0], p[0]), with_exponents(1, 1, 1, p[1], p[1], p[1])};
        body[0].orientation = body[1].orientation = k < 40 ? symmetric_turn(&random) : random_rotation(&random);
        const double depth = k % 4 == 3 ? pow(3, 0.5 - 1 / p[0]) + pow(3, 0.5 - 1 / p[1]) : 2;
        impact_contact c;
        proved += impact_gap(&body[0], &body[1], NULL, &c) == IMPACT_OK;
        worst = fmax(worst, fabs(c.gap + depth));
    }
    show_figure("equal ways out, of 80 proved", proved);
    show_figure("equal ways out, off", worst);
    assert_int_equal(proved, 80);
    assert_true(worst <= 4e-15);
}

/* Ways out as many as a circle or a sphere has: no end to the proof, but a bracket. */
static void rings_of_ways_out(void **state)
{
    (void)state;
    random_stream random = {34};
    tally t = {0};
    for (int k = 0; k < 30; k++) {
        impact_solid body[2] = {with_exponents(1, 1, 3, 2, 2, 1 + 3 * random_unit(&random)),
                                with_exponents(0.5, 0.5, 2, 2, 2, 1 + 3 * random_unit(&random))};
        body[0].orientation = body[1].orientation = random_rotation(&random);
        check_overlap(&random, body, 12, &t);
    }
    report("rings", &t);
    assert_int_equal(t.asked, 30);
    assert_true(t.widest <= 0.01);
}

/* ---- the way out, by the bodies' inequalities ---- */

/* How far x (from the body's position, world) is off its surface, negative inside: to first order, by differences. */
static double off_surface(const impact_solid *body, qvec3 x)
{
    const impact_shape *s = &body->shape;
    const qvec3 at = quat_rotate_inverse(body->orientation, x);
    const double off = impact_shape_inside(s, at) - 1, axis[3] = {s->a, s->b, s->c}, place[3] = {at.x, at.y, at.z};
    if (s->kind != IMPACT_SUPERQUADRIC && s->kind != IMPACT_SUPERELLIPSOID && s->kind != IMPACT_SPHERE)
        return off * contact_size(s);
    double square = 0;
    for (int i = 0; i < 3; i++) {
        const double by = copysign(1e-7 * axis[i], place[i]);
        const qvec3 beside = {at.x + (i == 0) * by, at.y + (i == 1) * by, at.z + (i == 2) * by};
        const double slope = (impact_shape_inside(s, beside) - 1 - off) / by;
        square += slope * slope;
    }
    return off / sqrt(square);
}

/* How deep points of either surface, most of them near the normal's, lie in the other body. */
static double deepest_point(random_stream *random, const impact_solid body[2], qvec3 normal)
{
    double deepest = 0;
    for (int i = 0; i < 200; i++) {
        const impact_solid *one = &body[i % 2], *other = &body[1 - i % 2];
        const qvec3 towards = i % 2 ? normal : qvec3_neg(normal);
        const qvec3 d = qvec3_axpy(random_log(random, 1e-6, 3), random_direction(random), towards);
        const qvec3 x = qvec3_add(qvec3_sub(one->position, other->position),
                                  contact_support(one, qvec3_scale(d, 1 / qvec3_norm(d))));
        deepest = fmax(deepest, -off_surface(other, x));
    }
    return deepest;
}

typedef struct leads {
    int asked, bracket;
    double inside, off, along, aside, widest;
} leads;

/* Whatever its status, an overlap's normal and lower end lead out, and its points lie on the surfaces, gap apart along
 * the normal; but in a bracket they also face each other. */
static void check_way(random_stream *random, const impact_solid body[2], leads *l)
{
    impact_contact c;
    const impact_status status = impact_gap(&body[0], &body[1], NULL, &c);
    const double reach = reach_of(body);
    if (!(c.upper < -1e-6 * reach)) return;
    const impact_solid out[2] = {
        {.shape = body[0].shape, .position = qvec3_axpy(-c.lower, c.normal, body[0].position), body[0].orientation},
        body[1]};
    const qvec3 v = qvec3_sub(qvec3_add(qvec3_sub(body[0].position, body[1].position), c.offset1), c.offset2);
    l->asked++;
    l->bracket += status == IMPACT_BRACKET;
    l->inside = fmax(l->inside, deepest_point(random, out, c.normal) / reach);
    l->off = fmax(l->off, fabs(off_surface(&body[0], c.offset1)) / reach);
    l->off = fmax(l->off, fabs(off_surface(&body[1], c.offset2)) / reach);
    l->along = fmax(l->along, fabs(qvec3_dot(c.normal, v) - c.gap) / reach);
    if (status != IMPACT_BRACKET) l->aside = fmax(l->aside, qvec3_norm(qvec3_axpy(-c.gap, c.normal, v)) / reach);
    l->widest = fmax(l->widest, (c.upper - c.lower) / -c.gap);
}

/* Body 1's place: a thousandth to one and a half of the thinnest semi-axis away, or up to a size. */
static void check_random_way(random_stream *random, int one, int two, bool far, leads *l)
{
    impact_solid body[2] = {{.orientation = random_rotation(random)}, {.orientation = random_rotation(random)}};
    body[0].shape = random_shape(random, one), body[1].shape = random_shape(random, two);
    const double thin = fmin(thinnest(&body[0].shape), thinnest(&body[1].shape));
    body[0].position = random_vector(random, 1e-3 * thin, far ? reach_of(body) : 1.5 * thin);
    check_way(random, body, l);
}

static void ways_lead_out(void **state)
{
    (void)state;
    random_stream random = {35};
    leads l = {0};
    for (int k = 0; k < 120 * RANDOM_FAMILIES; k++) {
        const int family = k % RANDOM_FAMILIES, other = (int)(random_bits(&random) % RANDOM_FAMILIES);
        check_random_way(&random, family, k % 2 ? family : other, k % 3 == 0, &l);
    }
    for (int k = 0; k < 120 * PAIR_FAMILIES; k++) {
        face_pair pair = random_face_pair(&random, k % PAIR_FAMILIES);
        check_way(&random, pair.body, &l);
        end_face_pair(&pair);
    }
    for (int k = 0; k < 120 * MIXED_FAMILIES; k++) {
        mixed_pair pair = random_mixed_pair(&random, k % MIXED_FAMILIES, -random_log(&random, 1e-3, 1));
        check_way(&random, pair.body, &l);
        end_mixed_pair(&pair);
    }
    show_figure("ways out, asked", l.asked);
    show_figure("ways out, bracket", l.bracket);
    show_figure("ways out, moved by it deeper than", l.inside);
    show_figure("ways out, points off the surfaces", l.off);
    show_figure("ways out, points aside of each other", l.aside);
    show_figure("ways out, widest over depth", l.widest);
    assert_true(l.asked >= 2800 && l.bracket <= l.asked / 100);
    assert_true(l.inside <= 4e-15 && l.off <= 2e-14 && l.along <= 1e-14 && l.aside <= 2e-14);
    assert_true(l.widest <= 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifdef __SIZEOF_FLOAT128__
        cmocka_unit_test(octahedra_against_all_features),
#endif
        cmocka_unit_test(nearest_way_out_of_random_overlaps),
        cmocka_unit_test(nearest_way_out_of_symmetric_poses),
        cmocka_unit_test(equal_ways_out_are_proved),
        cmocka_unit_test(rings_of_ways_out),
        cmocka_unit_test(ways_lead_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
