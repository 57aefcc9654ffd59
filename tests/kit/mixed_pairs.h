/* SPDX-License-Identifier: MIT
 *
 * Pairs of a shape with faces and another shape, with their gap by construction.
 */
#ifndef KIT_MIXED_PAIRS_H
#define KIT_MIXED_PAIRS_H

#include <impact/face.h>
#include <impact/gap.h>
#include <quat/rotation.h>
#include "kit/solid_random.h"

enum {
    MIXED_BOX_SMOOTH, /* exponents 1.5 … 4 */
    MIXED_BOX_ELLIPSOID,
    MIXED_HULL_SMOOTH,
    MIXED_BOX_BOXY, /* exponents 10 … 100 */
    MIXED_CYLINDER_SMOOTH,
    MIXED_CONE_SMOOTH,
    MIXED_CAPSULE_SMOOTH,
    MIXED_CYLINDER_BOX,
    MIXED_CONE_HULL,
    MIXED_TURNED, /* cylinders and cones with each other, and balls */
    MIXED_FAMILIES
};

static inline const char *mixed_family_name(int family)
{
    static const char *const names[] = {"box-smooth",  "box-ellipsoid",  "hull-smooth",  "box-boxy",  "cylinder-smooth",
                                        "cone-smooth", "capsule-smooth", "cylinder-box", "cone-hull", "turned bodies"};
    return names[family];
}

typedef struct mixed_pair {
    impact_solid body[2];
    impact_hull *hull[2];
    double gap, reach;
    qvec3 normal;
} mixed_pair;

/* A normal of the first body: of a face or edge, a side or cap, or any; and the point on it. */
static inline void mixed_place(random_stream *random, const impact_shape *shape, qvec3 *n, qvec3 *x)
{
    *n = random_direction(random);
    const double kind = random_unit(random);
    if (kind < 0.5) { /* what a direction near an axis of the body, or a normal of it, has */
        double *d[3] = {&n->x, &n->y, &n->z};
        const int axis = (int)(3 * random_unit(random));
        for (int k = 0; k < 3; k++)
            if (kind < 0.25 ? k != axis : k == axis) *d[k] = 0;
        *n = qvec3_scale(*n, 1 / qvec3_norm(*n));
        if (shape->kind == IMPACT_POLYHEDRON) {
            const int f = (int)(impact_hull_describe(shape->hull).faces * random_unit(random));
            impact_hull_face(shape->hull, f, NULL, n);
        }
    }
    impact_face face;
    if (impact_shape_face(shape, *n, 0, &face) < 1) {
        impact_shape_support(shape, *n, x);
        return;
    }
    double sum = 0;
    *x = (qvec3){0, 0, 0};
    for (int i = 0; i < face.count; i++) {
        const double weight = random_unit(random);
        *x = qvec3_axpy(weight, face.point[i], *x), sum += weight;
    }
    *x = qvec3_scale(*x, 1 / sum);
}

static inline impact_shape mixed_second(random_stream *random, int family, impact_hull **hull)
{
    switch (family) {
    case MIXED_BOX_ELLIPSOID: return random_shape(random, RANDOM_ELLIPSOID);
    case MIXED_BOX_BOXY: return random_shape(random, RANDOM_BOXY);
    case MIXED_CYLINDER_BOX: return random_solid_shape(random, RANDOM_BOX, hull);
    case MIXED_CONE_HULL: return random_solid_shape(random, RANDOM_POLYHEDRON, hull);
    case MIXED_TURNED:
        return random_unit(random) < 0.3
                   ? random_shape(random, RANDOM_SPHERE)
                   : random_solid_shape(random, random_unit(random) < 0.5 ? RANDOM_CONE : RANDOM_CYLINDER_BODY, hull);
    default: return random_smooth_shape(random, random_unit(random) < 0.3);
    }
}

/* gap in parts of the second body's size. */
static inline mixed_pair random_mixed_pair(random_stream *random, int family, double gap)
{
    static const int first[MIXED_FAMILIES] = {
        RANDOM_BOX,  RANDOM_BOX,     RANDOM_POLYHEDRON,    RANDOM_BOX,  RANDOM_CYLINDER_BODY,
        RANDOM_CONE, RANDOM_CAPSULE, RANDOM_CYLINDER_BODY, RANDOM_CONE, RANDOM_CYLINDER_BODY};
    mixed_pair pair = {.hull = {NULL, NULL}};
    pair.body[0].shape = random_solid_shape(random, first[family], &pair.hull[0]);
    pair.body[1].shape = mixed_second(random, family, &pair.hull[1]);
    for (int k = 0; k < 2; k++) pair.body[k].orientation = random_rotation(random);
    qvec3 n, x;
    mixed_place(random, &pair.body[0].shape, &n, &x);
    n = quat_rotate(pair.body[0].orientation, n), x = quat_rotate(pair.body[0].orientation, x);
    pair.normal = qvec3_neg(n);
    pair.gap = gap * contact_size(&pair.body[1].shape);
    pair.body[0].position = qvec3_sub(qvec3_axpy(-pair.gap, n, contact_support(&pair.body[1], pair.normal)), x);
    pair.body[1].position = (qvec3){0, 0, 0};
    pair.reach =
        fmax(contact_size(&pair.body[0].shape), contact_size(&pair.body[1].shape)) + qvec3_norm(pair.body[0].position);
    return pair;
}

static inline void end_mixed_pair(mixed_pair *pair)
{
    impact_hull_destroy(pair->hull[0]);
    impact_hull_destroy(pair->hull[1]);
}

#endif
