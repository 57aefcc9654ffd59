/* SPDX-License-Identifier: MIT
 *
 * Patches of integer boxes against the clipped rectangles in exact fractions, and by hand.
 */
#include "kit/near.h"

#include <string.h>
#include <impact/patch.h>
#include "base/numbers.h"
#include "kit/face_pairs.h"

/* ---- fractions ---- */

__extension__ typedef __int128 wide;

typedef struct fraction {
    wide n, d;
} fraction;

static fraction make(wide n, wide d)
{
    wide a = n < 0 ? -n : n, b = d < 0 ? -d : d;
    while (b) {
        const wide rest = a % b;
        a = b, b = rest;
    }
    if (a == 0) return (fraction){0, 1};
    return d < 0 ? (fraction){-n / a, -d / a} : (fraction){n / a, d / a};
}

static fraction whole(long n) { return (fraction){n, 1}; }
static fraction plus(fraction a, fraction b) { return make(a.n * b.d + b.n * a.d, a.d * b.d); }
static fraction minus(fraction a, fraction b) { return make(a.n * b.d - b.n * a.d, a.d * b.d); }
static fraction times(fraction a, fraction b) { return make(a.n * b.n, a.d * b.d); }
static fraction over(fraction a, fraction b) { return make(a.n * b.d, a.d * b.n); }
static double value(fraction a) { return (double)a.n / (double)a.d; }

typedef struct ring {
    int count;
    fraction p[16][2];
} ring;

/* What of the ring has sign p[axis] <= limit. */
static ring cut(const ring *r, int axis, int sign, fraction limit)
{
    ring out = {.count = 0};
    for (int i = 0; i < r->count; i++) {
        const fraction *p = r->p[i], *q = r->p[(i + 1) % r->count];
        const fraction at_p = minus(limit, times(whole(sign), p[axis])),
                       at_q = minus(limit, times(whole(sign), q[axis]));
        if (at_p.n >= 0) memcpy(out.p[out.count++], p, sizeof out.p[0]);
        if ((at_p.n > 0 && at_q.n < 0) || (at_p.n < 0 && at_q.n > 0)) {
            const fraction share = over(at_p, minus(at_p, at_q));
            for (int k = 0; k < 2; k++) out.p[out.count][k] = plus(p[k], times(share, minus(q[k], p[k])));
            out.count++;
        }
    }
    return out;
}

/* Area and first moments. */
static void moments(const ring *r, fraction m[3])
{
    for (int k = 0; k < 3; k++) m[k] = whole(0);
    for (int i = 0; i < r->count; i++) {
        const fraction *p = r->p[i], *q = r->p[(i + 1) % r->count];
        const fraction cross = minus(times(p[0], q[1]), times(p[1], q[0]));
        m[0] = plus(m[0], over(cross, whole(2)));
        for (int k = 0; k < 2; k++) m[1 + k] = plus(m[1 + k], over(times(cross, plus(p[k], q[k])), whole(6)));
    }
}

static void patch_moments(const impact_patch *patch, double m[3])
{
    m[0] = m[1] = m[2] = 0;
    for (int i = 0; i < patch->count; i++) {
        const qvec3 p = patch->point[i].offset2, q = patch->point[(i + 1) % patch->count].offset2;
        const double cross = p.x * q.y - p.y * q.x;
        m[0] += cross / 2, m[1] += cross * (p.x + q.x) / 6, m[2] += cross * (p.y + q.y) / 6;
    }
}

/* A box of integer sides on another, moved by integers and turned by a rational angle about the vertical. */
static void integer_boxes(void **state)
{
    (void)state;
    static const int turn[5][3] = {{1, 0, 1}, {3, 4, 5}, {4, 3, 5}, {5, 12, 13}, {-3, 4, 5}}; /* cos, sin, over */
    random_stream random = {1};
    int shared = 0;
    for (int i = 0; i < 3000; i++) {
        long side[5], x, y;
        for (int k = 0; k < 5; k++) side[k] = 1 + (long)(6 * random_unit(&random));
        x = (long)(13 * random_unit(&random)) - 6, y = (long)(13 * random_unit(&random)) - 6;
        const int *t = turn[i % 5];
        ring r = {.count = 4};
        for (int k = 0; k < 4; k++) {
            const long u = k == 1 || k == 2 ? side[0] : -side[0], v = k > 1 ? side[1] : -side[1];
            r.p[k][0] = make(x * t[2] + t[0] * u - t[1] * v, t[2]);
            r.p[k][1] = make(y * t[2] + t[1] * u + t[0] * v, t[2]);
        }
        for (int k = 0; k < 4; k++) r = cut(&r, k / 2, k % 2 ? -1 : 1, whole(side[2 + k / 2]));
        fraction wanted[3];
        moments(&r, wanted);
        impact_solid body[2] = {{.orientation = {t[2] + t[0], 0, 0, t[1]}, .position = {(double)x, (double)y, 2}},
                                {.orientation = {1, 0, 0, 0}, .position = {0, 0, -(double)side[4]}}};
        impact_shape_box((double)side[0], (double)side[1], 2, 0, &body[0].shape);
        impact_shape_box((double)side[2], (double)side[3], (double)side[4], 0, &body[1].shape);
        impact_contact contact;
        impact_patch patch;
        assert_int_equal(impact_gap(&body[0], &body[1], NULL, &contact), IMPACT_OK);
        if (value(wanted[0]) < 1e-9) continue; /* they touch along an edge or not at all */
        shared++;
        assert_int_equal(impact_patch_find(&body[0], &body[1], &contact, 1e-12, &patch), IMPACT_OK);
        double m[3];
        patch_moments(&patch, m);
        assert_int_equal(patch.dimension, 2);
        for (int k = 0; k < 3; k++)
            if (fabs(m[k] - value(wanted[k])) > 1e-13 * 36 * 12)
                fail_msg("%d: moment %d is %.17g, wanted %.17g", i, k, m[k], value(wanted[k]));
        for (int k = 0; k < patch.count; k++) assert_true(fabs(patch.point[k].height) < 1e-14);
    }
    assert_true(shared > 1000);
}

/* ---- by hand ---- */

static impact_solid at(impact_shape shape, double x, double y, double z)
{
    return (impact_solid){.shape = shape, .position = {x, y, z}, .orientation = {1, 0, 0, 0}};
}

static void patch_of(const impact_solid *one, const impact_solid *other, impact_patch *patch)
{
    impact_contact contact;
    assert_int_equal(impact_gap(one, other, NULL, &contact), IMPACT_OK);
    assert_int_equal(impact_patch_find(one, other, &contact, 1e-12, patch), IMPACT_OK);
}

static void by_hand(void **state)
{
    (void)state;
    impact_shape box, capsule, cylinder, floor, ball, round;
    impact_patch patch;
    impact_shape_box(1, 1, 1, 0, &box);
    impact_shape_box(1, 1, 1, 0.25, &round);
    impact_shape_capsule(0.5, 2, &capsule);
    impact_shape_cylinder(1, 2, 0, &cylinder);
    impact_shape_sphere(1, &ball);
    impact_shape_plane(INFINITY, INFINITY, &floor);
    const impact_solid ground = at(floor, 0, 0, 0);
    impact_solid body = at(box, 5, 0, 1);
    patch_of(&body, &ground, &patch); /* a square, its own corners */
    assert_int_equal(patch.dimension, 2);
    assert_int_equal(patch.count, 4);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(patch.point[i].feature1.kind, IMPACT_VERTEX);
        assert_int_equal(patch.point[i].feature2.kind, IMPACT_FACE);
        assert_true(fabs(fabs(patch.point[i].offset1.x) - 1) < 1e-15 && patch.point[i].offset1.z == -1);
    }
    body = at(round, 5, 0, 1); /* of a rounded one the core's */
    patch_of(&body, &ground, &patch);
    assert_true(patch.count == 4 && fabs(fabs(patch.point[0].offset1.x) - 0.75) < 1e-15);
    body = at(capsule, 0, 0, 0.5), body.orientation = (quat){1, 0, 1, 0};
    patch_of(&body, &ground, &patch);
    assert_int_equal(patch.dimension, 1);
    assert_true(fabs(fabs(patch.point[0].offset1.x) - 2) < 1e-15 && fabs(patch.point[0].offset1.z + 0.5) < 1e-15);
    body = at(cylinder, 0, 0, 2);
    patch_of(&body, &ground, &patch);
    assert_true(patch.dimension == 2 && patch.count == 16 && patch.disc == 1);
    assert_int_equal(patch.point[0].feature1.kind, IMPACT_RIM);
    body.orientation = (quat){1, 0, 1, 0}, body.position.z = 1; /* on its side */
    patch_of(&body, &ground, &patch);
    assert_true(patch.dimension == 1 && patch.disc == 0);
    body = at(ball, 0, 0, 1);
    patch_of(&body, &ground, &patch);
    assert_true(patch.dimension == 0 && patch.point[0].closed && patch.point[0].feature1.kind == IMPACT_SMOOTH);
    const impact_solid block = at(box, 0, 0, -1);
    impact_solid above = at(box, 1.5, 1.25, 1); /* corner over corner: one of each and two crossings */
    patch_of(&above, &block, &patch);
    assert_int_equal(patch.count, 4);
    int own = 0, crossing = 0;
    for (int i = 0; i < 4; i++) {
        own += patch.point[i].feature1.kind == IMPACT_VERTEX && patch.point[i].feature2.kind == IMPACT_FACE;
        crossing += patch.point[i].feature1.kind == IMPACT_EDGE && patch.point[i].feature2.kind == IMPACT_EDGE;
    }
    assert_true(own == 1 && crossing == 2);
    above.position.z = 1.5; /* apart: no point is closed */
    patch_of(&above, &block, &patch);
    assert_true(patch.dimension == -1 && patch.count == 4 && fabs(patch.point[0].height - 0.5) < 1e-15);
}

/* A box that stands on an edge within the height: four points, two of them closed. */
static void a_small_tilt_is_told(void **state)
{
    (void)state;
    impact_solid body = {.orientation = {1, 1e-6, 0, 0}, .position = {0, 0, 1}}, ground = {.orientation = {1, 0, 0, 0}};
    impact_contact contact;
    impact_patch patch;
    impact_shape_box(1, 1, 1, 0, &body.shape);
    impact_shape_plane(INFINITY, INFINITY, &ground.shape);
    assert_int_equal(impact_gap(&body, &ground, NULL, &contact), IMPACT_OK);
    body.position.z -= contact.gap;
    assert_int_equal(impact_gap(&body, &ground, NULL, &contact), IMPACT_OK);
    assert_int_equal(impact_patch_find(&body, &ground, &contact, 1e-5, &patch), IMPACT_OK);
    assert_true(patch.count == 4 && patch.dimension == 2);
    double least = INFINITY, most = 0;
    for (int i = 0; i < 4; i++) least = fmin(least, patch.point[i].height), most = fmax(most, patch.point[i].height);
    assert_true(fabs(least) < 1e-15 && fabs(most - 4e-6) < 1e-11);
    assert_int_equal(impact_patch_find(&body, &ground, &contact, 1e-8, &patch), IMPACT_OK);
    assert_true(patch.count == 2 && patch.dimension == 1);
}

/* |u|^p <= p height/c: .83 of the half side at p = 100, .07 at 8, for 1 cm and 1e-12 m; none at 2. */
static void flats_of_superquadrics(void **state)
{
    (void)state;
    impact_solid ground = {.orientation = {1, 0, 0, 0}};
    impact_shape_plane(INFINITY, INFINITY, &ground.shape);
    const double exponent[3] = {100, 8, 3};
    for (int i = 0; i < 3; i++) {
        const double p = exponent[i], c = 0.01;
        impact_solid body = at(ground.shape, 0, 0, c);
        impact_patch patch;
        impact_shape_superquadric(c, c, c, p, p, p, &body.shape);
        patch_of(&body, &ground, &patch);
        assert_int_equal(patch.dimension, 2);
        double far = 0;
        for (int k = 0; k < patch.count; k++) far = fmax(far, fabs(patch.point[k].offset1.x));
        const double wanted = c * pow(p * 1e-12 / c, 1 / p);
        if (fabs(far - wanted) > 0.02 * wanted) fail_msg("exponent %g: %g, wanted %g", p, far, wanted);
        impact_face face; /* the border is within the height of the plane, and on the surface */
        impact_shape_face(&body.shape, (qvec3){0, 0, -1}, 1e-12, &face);
        for (int k = 0; k < face.count; k++) {
            qvec3 x = face.point[k];
            x.z += 1e-12;
            assert_true(fabs(impact_shape_inside(&body.shape, x) - 1) < 1e-12 * p);
        }
    }
    impact_solid body = at(ground.shape, 0, 0, 1);
    impact_patch patch;
    impact_shape_superquadric(1, 1, 1, 2, 2, 2, &body.shape);
    patch_of(&body, &ground, &patch);
    assert_int_equal(patch.dimension, 0);
    impact_shape_superquadric(1, 1, 2, 2, 2, 40, &body.shape); /* the side of a cylinder */
    body.orientation = (quat){1, 0, 1, 0};
    patch_of(&body, &ground, &patch);
    assert_int_equal(patch.dimension, 1);
    impact_shape barr; /* the same by Barr's form */
    impact_face one, other;
    impact_shape_superellipsoid(1, 2, 3, 0.2, 0.2, &barr);
    impact_shape_superquadric(1, 2, 3, 10, 10, 10, &body.shape);
    assert_int_equal(impact_shape_face(&barr, (qvec3){1, 0, 0}, 1e-9, &one), 2);
    assert_int_equal(impact_shape_face(&body.shape, (qvec3){1, 0, 0}, 1e-9, &other), 2);
    for (int k = 0; k < one.count; k++) assert_true(qvec3_norm(qvec3_sub(one.point[k], other.point[k])) < 1e-12);
    impact_shape_superellipsoid(1, 2, 3, 0.2, 0.5, &barr);
    for (int axis = 0; axis < 3; axis++) {
        const qvec3 d = {axis == 0, axis == 1, axis == 2};
        assert_int_equal(impact_shape_face(&barr, d, 1e-9, &one), 2);
        for (int k = 0; k < one.count; k++)
            assert_true(fabs(impact_shape_inside(&barr, qvec3_axpy(-1e-9, d, one.point[k])) - 1) < 1e-7);
    }
}

/* Points lie in both bodies but for their height, counter-clockwise, and swapped bodies have the same. */
static void identities(void **state)
{
    (void)state;
    random_stream random = {3};
    for (int i = 0; i < 3000; i++) {
        face_pair pair = random_face_pair(&random, i % PAIR_FAMILIES);
        const double reach =
            contact_size(&pair.body[0].shape) + contact_size(&pair.body[1].shape) + qvec3_norm(pair.body[0].position);
        impact_contact contact;
        impact_patch patch, other;
        assert_int_equal(impact_gap(&pair.body[0], &pair.body[1], NULL, &contact), IMPACT_OK);
        const double height = 1e-9;
        assert_int_equal(impact_patch_find(&pair.body[0], &pair.body[1], &contact, height, &patch), IMPACT_OK);
        assert_true(patch.count >= 1 && patch.count <= IMPACT_PATCH_POINTS);
        double least = INFINITY;
        for (int k = 0; k < patch.count; k++) {
            const impact_patch_point *p = &patch.point[k];
            const qvec3 c = qvec3_sub(pair.body[0].position, pair.body[1].position);
            const qvec3 v = qvec3_sub(qvec3_add(c, p->offset1), p->offset2);
            least = fmin(least, p->height);
            if (patch.count > 1) assert_true(qvec3_norm(qvec3_axpy(-p->height, patch.normal, v)) < 1e-14 * reach);
            for (int b = 0; b < 2; b++) {
                const qvec3 x = quat_rotate_inverse(quat_unit(pair.body[b].orientation), b ? p->offset2 : p->offset1);
                const double outside =
                    (impact_shape_inside(&pair.body[b].shape, x) - 1) * contact_size(&pair.body[b].shape);
                if (pair.body[b].shape.kind != IMPACT_SUPERQUADRIC && outside > 2e-9)
                    fail_msg("%d: point %d is %g outside of body %d", i, k, outside, b + 1);
            }
        }
        if (fabs(least - contact.gap) > height + 1e-14 * reach)
            fail_msg("%d: least height %g, gap %g", i, least, contact.gap);
        impact_contact back = contact;
        back.normal = qvec3_neg(contact.normal);
        back.offset1 = contact.offset2, back.offset2 = contact.offset1;
        assert_int_equal(impact_patch_find(&pair.body[1], &pair.body[0], &back, height, &other), IMPACT_OK);
        assert_int_equal(other.dimension, patch.dimension);
        end_face_pair(&pair);
    }
}

/* Random polyhedra on a plane, whatever lies within random heights: each point is where it is said to be, and the
 * lowest is among them. A plane laid through corners of several faces told of corners far below the body. */
static void points_of_polyhedra_are_theirs(void **state)
{
    (void)state;
    random_stream random = {83};
    long bent = 0;
    for (int run = 0; run < 4000; run++) {
        impact_hull *hull = random_hull(&random, 4 + (int)(12 * random_unit(&random)), 0);
        impact_solid solid = {.orientation = random_rotation(&random)}, floor = {.orientation = {1, 0, 0, 0}};
        impact_contact contact;
        impact_patch patch;
        qvec3 place;
        impact_shape_polyhedron(hull, &solid.shape);
        impact_shape_plane(INFINITY, INFINITY, &floor.shape);
        const qvec3 down = quat_rotate_inverse(solid.orientation, (qvec3){0, 0, -1});
        solid.position.z = impact_shape_support(&solid.shape, down, &place);
        const double height = random_log(&random, 1e-4, 1) * impact_shape_bounding_radius(&solid.shape);
        assert_int_equal(impact_gap(&solid, &floor, NULL, &contact), IMPACT_OK);
        assert_int_equal(impact_patch_find(&solid, &floor, &contact, height, &patch), IMPACT_OK);
        double lowest = INFINITY;
        for (int i = 0; i < patch.count; i++) {
            const impact_patch_point *p = &patch.point[i];
            lowest = fmin(lowest, p->height);
            assert_true(fabs(solid.position.z + p->offset1.z - p->height) <= 1e-13);
            assert_true(p->height <= height + 1e-13);
            bent += p->height > 1e-12;
            if (p->feature1.kind != IMPACT_VERTEX) continue;
            qvec3 corner = impact_hull_vertex(hull, p->feature1.index);
            corner = qvec3_add(solid.position, quat_rotate(solid.orientation, corner));
            assert_true(qvec3_norm(qvec3_sub(corner, qvec3_add(solid.position, p->offset1))) <= 1e-12);
        }
        assert_true(fabs(lowest) <= 1e-13);
        impact_hull_destroy(hull);
    }
    assert_true(bent > 1000);
}

/* Sides of cylinders and capsules that cross at a small angle, `end` from where they do: at both ends of what they
 * share they are as far apart as their axes but for the radii, each point lies on both, and its normal goes from axis
 * to axis. Where an end is farther apart than the height they touch at the contact's point alone. */
static void lines_of_round_sides(void **state)
{
    (void)state;
    random_stream random = {91};
    int joined = 0;
    enum { RUNS = 4000 };
    for (int run = 0; run < RUNS; run++) {
        impact_solid solid[2];
        double radius[2], half[2];
        for (int k = 0; k < 2; k++) {
            radius[k] = random_log(&random, 0.05, 0.5), half[k] = random_log(&random, 0.3, 2);
            (run >> k & 1 ? impact_shape_capsule(radius[k], half[k], &solid[k].shape)
                          : impact_shape_cylinder(radius[k], half[k], 0, &solid[k].shape));
        }
        const double height = random_log(&random, 1e-9, 1e-5), gap = 0.3 * height * random_unit(&random),
                     both = radius[0] + radius[1], x = 0.4 * random_unit(&random) - 0.2,
                     end[2] = {fmax(-half[1], x - half[0]), fmin(half[1], x + half[0])},
                     met = end[0] + random_unit(&random) * (end[1] - end[0]),
                     angle = random_log(&random, 1e-3, 10) * sqrt(2 * both * height) / (end[1] - end[0]);
        const quat turn = random_rotation(&random), lying = quat_from_rotation_vector((qvec3){0, IMP_PI / 2, 0}),
                   crossed = quat_from_rotation_vector((qvec3){0, 0, angle});
        solid[1].position = random_vector(&random, 0.1, 10);
        solid[1].orientation = quat_mul(turn, lying);
        const qvec3 above = {x, (x - met) * tan(angle), both + gap};
        solid[0].position = qvec3_add(solid[1].position, quat_rotate(turn, above));
        solid[0].orientation = quat_mul(turn, quat_mul(crossed, lying));
        const qvec3 place = {met, 0, radius[1]}, upper = {met, 0, radius[1] + gap};
        const impact_contact contact = {.gap = gap,
                                        .normal = quat_rotate(turn, (qvec3){0, 0, 1}),
                                        .offset1 = quat_rotate(turn, qvec3_sub(upper, above)),
                                        .offset2 = quat_rotate(turn, place)};
        impact_patch patch;
        assert_int_equal(impact_patch_find(&solid[0], &solid[1], &contact, height, &patch), IMPACT_OK);
        const double aside[2] = {(end[0] - met) * tan(angle), (end[1] - met) * tan(angle)},
                     farthest = fmax(fabs(aside[0]), fabs(aside[1])), most = sqrt(2 * both * height);
        if (fabs(farthest - most) < 0.01 * most) continue;
        assert_int_equal(patch.count, farthest < most ? 2 : 1);
        if (patch.count == 1) {
            assert_near3(patch.point[0].offset2, contact.offset2, 1e-9);
            continue;
        }
        joined++;
        for (int i = 0; i < 2; i++) {
            const impact_patch_point *p = &patch.point[i];
            const qvec3 two = quat_rotate_inverse(turn, p->offset2), n = quat_rotate_inverse(turn, p->normal),
                        one = quat_rotate_inverse(quat_mul(turn, crossed), p->offset1);
            const double z = both + gap, apart = hypot(z, aside[i]);
            const qvec3 across = {0, aside[i] / apart, z / apart};
            assert_near(p->height, apart - both, 1e-3 * height);
            assert_near3(n, across, 1e-2 * most);
            assert_near(two.x, end[i], 1e-2 * most);
            assert_near(hypot(two.y, two.z), radius[1], 1e-3 * height);
            assert_near(hypot(one.y, one.z), radius[0], 1e-3 * height);
            assert_near3(qvec3_sub(qvec3_add(above, quat_rotate_inverse(turn, p->offset1)), two),
                         qvec3_scale(across, p->height), 2e-2 * most);
        }
    }
    assert_in_range(joined, RUNS / 3, RUNS);
}

static void mistakes(void **state)
{
    (void)state;
    impact_solid one = {.orientation = {1, 0, 0, 0}}, other = one;
    impact_contact contact;
    impact_patch patch;
    impact_face face;
    impact_shape_box(1, 1, 1, 0, &one.shape);
    impact_shape_sphere(1, &other.shape);
    other.position.x = 3;
    assert_int_equal(impact_gap(&one, &other, NULL, &contact), IMPACT_OK);
    assert_int_equal(impact_patch_find(&one, &other, &contact, -1, &patch), IMPACT_EARGUMENT);
    assert_int_equal(impact_patch_find(&one, &other, &contact, NAN, &patch), IMPACT_EDOMAIN);
    contact.normal.x = NAN;
    assert_int_equal(impact_patch_find(&one, &other, &contact, 0, &patch), IMPACT_EDOMAIN);
    assert_int_equal(impact_shape_face(&one.shape, (qvec3){2, 0, 0}, 0, &face), -1);
    assert_int_equal(impact_shape_face(&one.shape, (qvec3){1, 0, 0}, -1, &face), -1);
    assert_int_equal(impact_shape_face(&one.shape, (qvec3){1, 0, 0}, 0, &face), 2);
    assert_true(face.feature.kind == IMPACT_FACE && face.feature.index == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integer_boxes),
        cmocka_unit_test(by_hand),
        cmocka_unit_test(a_small_tilt_is_told),
        cmocka_unit_test(flats_of_superquadrics),
        cmocka_unit_test(identities),
        cmocka_unit_test(lines_of_round_sides),
        cmocka_unit_test(mistakes),
        cmocka_unit_test(points_of_polyhedra_are_theirs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
