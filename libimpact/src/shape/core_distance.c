/* SPDX-License-Identifier: MIT
 *
 * Distances from cores. Of a convex body the inside is bounded by its faces' planes; outside, the nearest point is on a
 * face that is seen, or on its border.
 */
#include <string.h>
#include "base/numbers.h"
#include "shape/solid.h"

/* Of a point from a box about 0, in n dimensions. */
static double box_distance(int n, const double *x, const double *half)
{
    double outside = 0, inside = -INFINITY;
    for (int k = 0; k < n; k++) {
        const double away = fabs(x[k]) - half[k];
        inside = fmax(inside, away);
        if (away > 0) outside += away * away;
    }
    return outside > 0 ? sqrt(outside) : inside;
}

static double segment_distance(const double *x, const double *a, const double *b, int n)
{
    double along = 0, length = 0, square = 0;
    for (int k = 0; k < n; k++) along += (x[k] - a[k]) * (b[k] - a[k]), length += (b[k] - a[k]) * (b[k] - a[k]);
    const double part = length > 0 ? fmax(0, fmin(1, along / length)) : 0;
    for (int k = 0; k < n; k++) {
        const double d = x[k] - a[k] - part * (b[k] - a[k]);
        square += d * d;
    }
    return sqrt(square);
}

/* The triangle of a cone's profile, with its mirror image: base and side. */
static double cone_distance(const imp_form *form, const double x[3])
{
    const double R = form->axis[0], H = form->axis[2], rim[2] = {R, form->base}, top[2] = {0, form->base + H},
                 at[2] = {hypot(x[0], x[1]), x[2]};
    const double length = hypot(R, H), side = (H * (at[0] - rim[0]) + R * (at[1] - rim[1])) / length,
                 below = rim[1] - at[1];
    if (side <= 0 && below <= 0) return fmax(side, below);
    const double foot[2] = {0, form->base};
    return fmin(segment_distance(at, rim, top, 2), segment_distance(at, foot, rim, 2));
}

/* The distance from a face that is seen: its plane's where the foot lies on it. */
static double face_distance(const imp_core *core, int face, const double n[3], double above, const double x[3])
{
    const impact_hull *hull = core->hull;
    const short *loop = hull->loop + hull->start[face];
    const int count = hull->start[face + 1] - hull->start[face];
    double border = INFINITY, a[3], b[3];
    bool over = true;
    imp_core_vertex(core, loop[count - 1], a);
    for (int i = 0; i < count; i++) {
        imp_core_vertex(core, loop[i], b);
        double side = 0; /* n x (b - a) . (x - a) */
        for (int k = 0; k < 3; k++) {
            const int p = (k + 1) % 3, q = (k + 2) % 3;
            side += (n[p] * (b[q] - a[q]) - n[q] * (b[p] - a[p])) * (x[k] - a[k]);
        }
        over = over && side >= 0;
        border = fmin(border, segment_distance(x, a, b, 3));
        memcpy(a, b, sizeof a);
    }
    return over ? above : border;
}

static double polytope_distance(const imp_core *core, const double x[3])
{
    const impact_hull *hull = core->hull;
    double inside = -INFINITY, outside = INFINITY;
    if (hull->face_count == 0) {
        double a[3], b[3];
        imp_core_vertex(core, 0, a);
        imp_core_vertex(core, hull->vertex_count - 1, b);
        return segment_distance(x, a, b, 3);
    }
    for (int f = 0; f < hull->face_count; f++) {
        double n[3];
        imp_core_normal(core, f, n);
        const double above = n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - imp_core_height(core, f, n);
        inside = fmax(inside, above);
        if (above > 0) outside = fmin(outside, face_distance(core, f, n, above, x));
    }
    return inside > 0 ? outside : inside;
}

double imp_core_distance(const imp_form *form, const double x[3])
{
    const double turned[2] = {hypot(x[0], x[1]), x[2]}, half[2] = {form->axis[0], form->axis[2]};
    switch (form->kind) {
    case IMP_FORM_BOX: return box_distance(3, x, form->axis);
    case IMP_FORM_CYLINDER: return box_distance(2, turned, half);
    case IMP_FORM_CONE: return cone_distance(form, x);
    case IMP_FORM_POLYTOPE: return polytope_distance(&form->core, x);
    case IMP_FORM_QUADRIC: break;
    }
    return NAN;
}
