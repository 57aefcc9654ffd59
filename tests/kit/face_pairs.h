/* SPDX-License-Identifier: MIT
 *
 * Pairs of polytopes as they are hard: parallel faces and edges, tilts from 1e-1 to 1e-16, needles and plates, all but
 * touching, deep.
 */
#ifndef KIT_FACE_PAIRS_H
#define KIT_FACE_PAIRS_H

#include <impact/gap.h>
#include <quat/rotation.h>
#include "kit/solid_random.h"

enum {
    PAIR_BOXES,
    PAIR_ROUNDED,
    PAIR_WORLD_AXES, /* orientations of the cube's group */
    PAIR_TURNED,     /* the same, turned together */
    PAIR_NORMAL,     /* one turned about a normal of the other */
    PAIR_TILTED,     /* from parallel by 1e-1 … 1e-16 */
    PAIR_ASPECT,     /* sides 1 : 1e4 */
    PAIR_TOUCHING,   /* within 1e-4 … 1e-16 of touching, along a face, or any way */
    PAIR_DEEP,
    PAIR_BALLS,  /* spheres and capsules with boxes and each other */
    PAIR_HULLS,  /* of 4 … 12 points, with each other, boxes, octahedra */
    PAIR_SOLIDS, /* dodecahedra and prisms */
    PAIR_FAMILIES
};

static inline const char *pair_family_name(int family)
{
    static const char *const names[] = {"boxes",          "rounded", "world axes", "turned together",
                                        "about a normal", "tilted",  "aspect",     "touching",
                                        "deep",           "balls",   "hulls",      "solids"};
    return names[family];
}

typedef struct face_pair {
    impact_solid body[2];
    impact_hull *hull[2]; /* NULL or to be destroyed */
} face_pair;

static inline quat cube_rotation(random_stream *random)
{
    static const quat q[4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0.5, 0.5, 0.5, 0.5}, {1, 1, 0, 0}};
    quat turn = quat_identity(), unit;
    for (int k = 0; k < 4; k++) turn = quat_mul(turn, q[random_bits(random) >> 62]);
    return quat_normalize(turn, &unit) == QUAT_OK ? unit : quat_identity();
}

static inline quat about(qvec3 axis, double angle)
{
    quat q = quat_identity();
    quat_from_axis_angle(axis, angle, &q);
    return q;
}

static inline impact_shape pair_box(random_stream *random, double low, double part)
{
    impact_shape shape = {.kind = IMPACT_SPHERE};
    const double a = random_log(random, low, 1), b = random_log(random, low, 1), c = random_log(random, low, 1);
    impact_shape_box(a, b, c, part * fmin(a, fmin(b, c)), &shape);
    return shape;
}

static inline impact_hull *regular_hull(random_stream *random)
{
    const double g = 1.618033988749895;
    qvec3 p[20];
    impact_hull *hull = NULL;
    int count = 0;
    if (random_unit(random) < 0.5) {
        for (int i = 0; i < 8; i++) p[count++] = (qvec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
        for (int i = 0; i < 4; i++) {
            const double s = i & 1 ? g : -g, t = i & 2 ? 1 / g : -1 / g;
            p[count++] = (qvec3){0, t, s}, p[count++] = (qvec3){t, s, 0}, p[count++] = (qvec3){s, 0, t};
        }
    } else {
        const int sides = 3 + (int)(8 * random_unit(random));
        for (int i = 0; i < 2 * sides; i++)
            p[count++] = (qvec3){cos(6.283185307179586 * (i / 2) / sides), sin(6.283185307179586 * (i / 2) / sides),
                                 i & 1 ? 0.5 : -0.5};
    }
    impact_hull_create(p, (size_t)count, 0, NULL, &hull, NULL, 0);
    return hull;
}

static inline impact_shape pair_shape(random_stream *random, int family, impact_hull **hull)
{
    impact_shape shape = {.kind = IMPACT_SPHERE};
    const double kind = random_unit(random), size = random_log(random, 0.2, 1);
    if (family == PAIR_ROUNDED) return pair_box(random, 0.2, 0.9 * random_unit(random));
    if (family == PAIR_ASPECT) return pair_box(random, 1e-4, 0);
    if (family == PAIR_BALLS && kind < 0.3) impact_shape_sphere(size, &shape);
    if (family == PAIR_BALLS && kind >= 0.3 && kind < 0.7)
        impact_shape_capsule(size, random_log(random, 0.1, 2), &shape);
    if (family == PAIR_HULLS && kind < 0.2)
        impact_shape_superquadric(size, random_log(random, 0.2, 1), 1, 1, 1, 1, &shape);
    if (family == PAIR_HULLS && kind >= 0.2 && kind < 0.8)
        *hull = random_hull(random, 4 + (int)(9 * random_unit(random)), kind < 0.5 ? 0 : 0.1);
    if (family == PAIR_SOLIDS) *hull = regular_hull(random);
    if (*hull) impact_shape_polyhedron(*hull, &shape);
    return shape.a > 0 ? shape : pair_box(random, 0.2, 0);
}

/* Body 1 by its distance from body 2 along n: at the gap where their faces along n are parallel. */
static inline void put_apart(face_pair *pair, qvec3 n, double gap)
{
    const qvec3 x1 = contact_support(&pair->body[0], qvec3_neg(n)), x2 = contact_support(&pair->body[1], n);
    pair->body[0].position = qvec3_axpy(gap - qvec3_dot(n, qvec3_sub(x1, x2)), n, pair->body[1].position);
}

static inline face_pair random_face_pair(random_stream *random, int family)
{
    face_pair pair = {.hull = {NULL, NULL}};
    for (int k = 0; k < 2; k++) {
        pair.body[k].shape = pair_shape(random, family, &pair.hull[k]);
        pair.body[k].position = (qvec3){0, 0, 0};
        pair.body[k].orientation = random_rotation(random);
    }
    quat *q = &pair.body[0].orientation, *r = &pair.body[1].orientation;
    const quat common = random_rotation(random);
    const qvec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, own = axis[random_bits(random) % 3];
    if (family == PAIR_WORLD_AXES) *q = cube_rotation(random), *r = cube_rotation(random);
    if (family == PAIR_TURNED || family == PAIR_TILTED || family == PAIR_SOLIDS)
        *r = common, *q = quat_mul(common, cube_rotation(random));
    if (family == PAIR_NORMAL) *q = quat_mul(*r, about(own, 3 * random_unit(random)));
    if (family == PAIR_TILTED) *q = quat_mul(about(random_direction(random), random_log(random, 1e-16, 1e-1)), *q);
    const qvec3 n = random_unit(random) < 0.5 ? random_direction(random) : quat_rotate(*r, own);
    const double size = contact_size(&pair.body[1].shape);
    double gap = size * (random_unit(random) < 0.5 ? random_log(random, 1e-3, 1) : -random_log(random, 1e-3, 1));
    if (family == PAIR_TOUCHING) gap = size * (random_unit(random) < 0.5 ? 1 : -1) * random_log(random, 1e-16, 1e-4);
    put_apart(&pair, n, gap);
    if (family != PAIR_TOUCHING || random_unit(random) < 0.5) { /* to the side as well */
        const qvec3 d = qvec3_scale(random_direction(random), random_unit(random) * size);
        pair.body[0].position = qvec3_add(pair.body[0].position, qvec3_axpy(-qvec3_dot(d, n), n, d));
    }
    if (family == PAIR_DEEP)
        pair.body[0].position = qvec3_scale(random_direction(random), 0.3 * size * random_unit(random));
    return pair;
}

static inline void end_face_pair(face_pair *pair)
{
    impact_hull_destroy(pair->hull[0]);
    impact_hull_destroy(pair->hull[1]);
}

#endif
