/* SPDX-License-Identifier: MIT
 *
 * Shapes and solids out of bytes, and back into C.
 */
#ifndef FUZZ_SOLIDS_H
#define FUZZ_SOLIDS_H

#include "fuzz.h"

#include <impact/gap.h>
#include <quat/rotation.h>

/* A hull of up to twelve points; those of the last two calls live. */
static inline const impact_hull *take_hull(fuzz_bytes *b, double size)
{
    static impact_hull *kept[2];
    static int last;
    qvec3 points[12];
    const unsigned count = 4 + take_below(b, 9);
    for (unsigned i = 0; i < count; i++) points[i] = qvec3_scale(take_vec3(b, 1), size);
    last = 1 - last;
    impact_hull_destroy(kept[last]);
    impact_hull_create(points, count, take_below(b, 2) ? 0.1 * size : 0, NULL, &kept[last], NULL, 0);
    return kept[last];
}

/* A shape with faces; s stays where the numbers are refused. */
static inline void take_faces(fuzz_bytes *b, double a, double m, double n, impact_shape *s)
{
    const double part = take_below(b, 2) ? 0.99 * take_unit(b) : 0, side = fmin(a, fmin(a * m, a * n));
    switch (take_below(b, 5)) {
    case 0: impact_shape_box(a, a * m, a * n, part * side, s); break;
    case 1: impact_shape_cylinder(a, a * m, part * fmin(a, a * m), s); break;
    case 2: impact_shape_cone(a, a * m, part * fmin(a, a * m / 2), s); break;
    case 3: impact_shape_capsule(a, a * m, s); break;
    default: {
        const impact_hull *hull = take_hull(b, a);
        if (hull) impact_shape_polyhedron(hull, s);
    }
    }
}

static inline impact_shape take_shape(fuzz_bytes *b)
{
    static const double steep[] = {1, 1, 2, 2, 1e6, 100, 4, 1.0000001};
    impact_shape s = {.kind = IMPACT_SPHERE, .a = 1, .b = 1, .c = 1, .r = 2, .s = 2, .t = 2};
    const double a = take_positive(b, 4), m = take_positive(b, 2), n = take_positive(b, 2);
    switch (take_below(b, 8)) {
    case 0: impact_shape_sphere(a, &s); break;
    case 1: {
        const unsigned sides = take_below(b, 4);
        impact_shape_plane(sides & 1 ? INFINITY : a, sides & 2 ? INFINITY : a * m, &s);
        break;
    }
    case 2: impact_shape_ellipsoid(a, a * m, a * n, &s); break;
    case 3: {
        const double p = 1 + take_positive(b, 6), q = 1 + take_positive(b, 6), r = 1 + take_positive(b, 6);
        impact_shape_superquadric(a, a * m, a * n, fmin(p, 1e6), fmin(q, 1e6), fmin(r, 1e6), &s);
        break;
    }
    case 4: {
        const double e = 2 * take_unit(b), f = 2 * take_unit(b);
        impact_shape_superellipsoid(a, a * m, a * n, fmax(e, 1e-3), fmax(f, 1e-3), &s);
        break;
    }
    case 6:
    case 7: take_faces(b, a, m, n, &s); break;
    default: {
        const double p = steep[take_below(b, 8)], q = steep[take_below(b, 8)], r = steep[take_below(b, 8)];
        impact_shape_superquadric(a, a * m, a * n, p, q, r, &s);
    }
    }
    return s;
}

static inline impact_solid take_solid(fuzz_bytes *b, double far)
{
    impact_solid solid = {.shape = take_shape(b)};
    solid.position = take_vec3(b, far);
    solid.orientation = take_quat(b);
    return solid;
}

/* The largest semi-axis; a plane has none. */
static inline double solid_size(const impact_solid *s)
{
    return s->shape.kind == IMPACT_PLANE ? 0 : fmax(s->shape.a, fmax(s->shape.b, s->shape.c));
}

static inline void show_shape(FILE *out, const impact_shape *s)
{
    const double numbers[8] = {s->a, s->b, s->c, s->r, s->s, s->t, s->rounding, s->base};
    fprintf(out, "{(impact_shape_kind)%d", (int)s->kind);
    for (int i = 0; i < 8; i++) {
        fputs(", ", out);
        show_number(out, numbers[i]);
    }
    fputs(", NULL", out);
    if (s->hull) fputs(" /* the hull of these: ", out);
    for (int i = 0; s->hull && i < impact_hull_describe(s->hull).vertices; i++)
        show_vec3(out, i ? ", " : "", impact_hull_vertex(s->hull, i));
    fputs(s->hull ? " */}" : "}", out);
}

static inline void show_solid(FILE *out, const char *name, const impact_solid *s)
{
    fprintf(out, "    const impact_solid %s = {.shape = ", name);
    show_shape(out, &s->shape);
    show_vec3(out, ",\n        .position = ", s->position);
    show_quat(out, ", .orientation = ", s->orientation);
    fputs("};\n", out);
}

#endif
