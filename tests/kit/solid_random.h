/* SPDX-License-Identifier: MIT
 *
 * Random shapes with faces.
 */
#ifndef KIT_SOLID_RANDOM_H
#define KIT_SOLID_RANDOM_H

#include <impact/shape.h>
#include "kit/contact_random.h"

enum { RANDOM_POINTS = 5 }; /* in a cube, on a sphere, on a lattice, on a prism's rings, almost in a plane */

static inline qvec3 random_point(random_stream *random, int family)
{
    const double x = 2 * random_unit(random) - 1, y = 2 * random_unit(random) - 1, z = 2 * random_unit(random) - 1;
    const double turn = floor(8 * random_unit(random)) * 0.7853981633974483;
    switch (family) {
    case 1: return random_direction(random);
    case 2: return (qvec3){floor(3 * x), floor(3 * y), floor(3 * z)};
    case 3: return (qvec3){cos(turn), sin(turn), z > 0 ? 0.3 : -0.7};
    case 4: return (qvec3){x, y, x - 0.5 * y + 1e-12 * z};
    default: return (qvec3){x, y, z};
    }
}

/* Never NULL: points that make no hull are drawn again. */
static inline impact_hull *random_hull(random_stream *random, int count, double rounding)
{
    impact_hull *hull = NULL;
    while (!hull) {
        qvec3 points[IMPACT_HULL_POINTS];
        const int family = (int)(4 * random_unit(random));
        for (int i = 0; i < count; i++) points[i] = random_point(random, family);
        impact_hull_create(points, (size_t)count, rounding, NULL, &hull, NULL, 0);
    }
    return hull;
}

enum { RANDOM_BOX, RANDOM_CYLINDER_BODY, RANDOM_CONE, RANDOM_CAPSULE, RANDOM_POLYHEDRON, RANDOM_SOLIDS };

/* Half of them rounded. *hull: what a polyhedron needs, to be destroyed; else as it was. */
static inline impact_shape random_solid_shape(random_stream *random, int family, impact_hull **hull)
{
    impact_shape shape = {.kind = IMPACT_SPHERE, .a = 1, .b = 1, .c = 1, .r = 2, .s = 2, .t = 2};
    const double a = random_log(random, 0.2, 1), b = random_log(random, 0.2, 1), c = random_log(random, 0.2, 1);
    const double part = random_unit(random) < 0.5 ? 0 : 0.9 * random_unit(random);
    switch (family) {
    case RANDOM_BOX: impact_shape_box(a, b, c, part * fmin(a, fmin(b, c)), &shape); break;
    case RANDOM_CYLINDER_BODY: impact_shape_cylinder(a, c, part * fmin(a, c), &shape); break;
    case RANDOM_CONE: impact_shape_cone(a, c, part * fmin(a, c / 2), &shape); break;
    case RANDOM_CAPSULE: impact_shape_capsule(a, c, &shape); break;
    case RANDOM_POLYHEDRON:
        *hull = random_hull(random, 4 + (int)(12 * random_unit(random)), 0.3 * part);
        impact_shape_polyhedron(*hull, &shape);
        break;
    default: break;
    }
    return shape;
}

#endif
