/* SPDX-License-Identifier: MIT
 *
 * Both faces are brought into the plane across the normal, where they are convex polygons, segments or points, and
 * clipped against one another. Each face is the plane z(x, y) through its points; heights are the difference. What lies
 * within a height of a polytope may be corners of several faces, in no plane: then z is each corner's own there, and
 * between them that of the triangles from the first corner on.
 */
#include <impact/patch.h>
#include <quat/rotation.h>
#include "base/tolerances.h"
#include "gap/flat.h"
#include "gap/gap_chart.h"

#include <string.h>

typedef struct face_side {
    impact_face face;
    const impact_shape *shape;
    quat turn;
    qvec3 center; /* from body 2's */
    imp_flat flat;
    double z, slope[2]; /* height over the plane across the normal: z + slope.(x, y) */
    bool bent;          /* its corners lie in no plane: each has its own height */
    double own[IMPACT_FACE_POINTS], corner[IMPACT_FACE_POINTS][2];
} face_side;

typedef struct patch_frame {
    qvec3 n, x, y;
    double slack, room; /* rounding of places; how far from the centres a patch can be */
} patch_frame;

static qvec3 placed(const face_side *s, int i) { return qvec3_add(s->center, quat_rotate(s->turn, s->face.point[i])); }

/* The plane through three points of the face that are far from a line, or the line through two. */
static void lay_plane(face_side *s, const patch_frame *f)
{
    const int count = s->face.count;
    s->slope[0] = s->slope[1] = 0;
    s->z = count > 0 ? qvec3_dot(f->n, placed(s, 0)) : qvec3_dot(f->n, s->center);
    if (count < 2) return;
    const qvec3 a = placed(s, 0), b = placed(s, count / 3 > 0 ? count / 3 : 1), c = placed(s, 2 * count / 3);
    const qvec3 u = qvec3_sub(b, a), v = count > 2 ? qvec3_sub(c, a) : qvec3_cross(f->n, u);
    const double ux = qvec3_dot(u, f->x), uy = qvec3_dot(u, f->y), vx = qvec3_dot(v, f->x), vy = qvec3_dot(v, f->y),
                 area = ux * vy - uy * vx, uz = qvec3_dot(u, f->n), vz = qvec3_dot(v, f->n);
    if (!(fabs(area) > 0)) return;
    s->slope[0] = (uz * vy - uy * vz) / area, s->slope[1] = (ux * vz - uz * vx) / area;
    s->z -= s->slope[0] * qvec3_dot(a, f->x) + s->slope[1] * qvec3_dot(a, f->y);
}

static double height_of_plane(const face_side *s, const double p[2])
{
    return s->z + s->slope[0] * p[0] + s->slope[1] * p[1];
}

static bool lay_face(const impact_solid *body, qvec3 center, qvec3 direction, double height, const patch_frame *f,
                     face_side *s)
{
    impact_shape shape = body->shape;
    s->shape = &body->shape, s->turn = quat_unit(body->orientation), s->center = center;
    if (shape.kind == IMPACT_PLANE) shape.a = fmin(shape.a, f->room), shape.b = fmin(shape.b, f->room);
    if (impact_shape_face(&shape, quat_rotate_inverse(s->turn, direction), height, &s->face) < 0) return false;
    lay_plane(s, f);
    s->bent = false;
    s->flat.count = s->face.count;
    for (int i = 0; i < s->face.count; i++) {
        const qvec3 p = placed(s, i);
        s->flat.p[i][0] = qvec3_dot(p, f->x), s->flat.p[i][1] = qvec3_dot(p, f->y);
        s->flat.from[i] = (short)i;
        s->own[i] = qvec3_dot(p, f->n);
        memcpy(s->corner[i], s->flat.p[i], sizeof s->corner[i]);
        s->bent = s->bent || !(fabs(s->own[i] - height_of_plane(s, s->flat.p[i])) <= f->slack);
    }
    if (s->face.count > 1) imp_flat_hull(&s->flat, 0);
    return true;
}

/* The corner of the face at a place of the plane; -1: none. */
static int corner_at(const face_side *s, const double p[2], double slack)
{
    for (int i = 0; i < s->face.count; i++)
        if (fabs(p[0] - s->corner[i][0]) <= slack && fabs(p[1] - s->corner[i][1]) <= slack) return i;
    return -1;
}

/* What of the body is there: a corner, a side or the inside of its face. */
static impact_feature feature_at(const face_side *s, const double p[2], double slack)
{
    const imp_flat *flat = &s->flat;
    const int corner = corner_at(s, p, slack);
    if (corner >= 0) return s->face.corner[corner];
    for (int i = 0; s->face.dimension == 2 && i < flat->count; i++) {
        const double *a = flat->p[i], *b = flat->p[(i + 1) % flat->count];
        const double x = b[0] - a[0], y = b[1] - a[1];
        if (fabs(x * (p[1] - a[1]) - y * (p[0] - a[0])) > slack * (fabs(x) + fabs(y))) continue;
        const impact_feature_kind kind = s->face.corner[flat->from[i]].kind;
        return (impact_feature){kind == IMPACT_VERTEX ? IMPACT_EDGE : kind, -1};
    }
    return s->face.feature;
}

/* Over the triangle of a bent face's corners from its first that holds the place, or is nearest to. */
static double height_of_triangles(const face_side *s, const double p[2])
{
    const imp_flat *flat = &s->flat;
    double height = s->own[flat->from[0]], best = -INFINITY;
    for (int i = 1; i + 1 < flat->count; i++) {
        const double *a = flat->p[0], u[2] = {flat->p[i][0] - a[0], flat->p[i][1] - a[1]},
                     v[2] = {flat->p[i + 1][0] - a[0], flat->p[i + 1][1] - a[1]}, w[2] = {p[0] - a[0], p[1] - a[1]};
        const double area = u[0] * v[1] - u[1] * v[0];
        if (!(area > 0)) continue;
        const double second = fmax(0, (w[0] * v[1] - w[1] * v[0]) / area),
                     third = fmax(0, (u[0] * w[1] - u[1] * w[0]) / area), first = 1 - second - third,
                     least = fmin(first, fmin(second, third));
        if (!(least > best)) continue;
        best = least;
        height = first * s->own[flat->from[0]] + second * s->own[flat->from[i]] + third * s->own[flat->from[i + 1]];
    }
    return height;
}

static double height_at(const face_side *s, const double p[2], double slack)
{
    if (!s->bent) return height_of_plane(s, p);
    const int corner = corner_at(s, p, slack);
    return corner >= 0 ? s->own[corner] : height_of_triangles(s, p);
}

static void put_point(const face_side s[2], const patch_frame *f, const double p[2], double height, impact_patch *patch)
{
    const double z1 = height_at(&s[0], p, f->slack), z2 = height_at(&s[1], p, f->slack);
    const qvec3 flat = qvec3_axpy(p[0], f->x, qvec3_scale(f->y, p[1]));
    patch->point[patch->count++] = (impact_patch_point){.offset1 = qvec3_sub(qvec3_axpy(z1, f->n, flat), s[0].center),
                                                        .offset2 = qvec3_axpy(z2, f->n, flat),
                                                        .normal = f->n,
                                                        .height = z1 - z2,
                                                        .feature1 = feature_at(&s[0], p, f->slack),
                                                        .feature2 = feature_at(&s[1], p, f->slack),
                                                        .closed = z1 - z2 <= height};
}

/* The contact's own points. */
static void lone_point(const face_side s[2], const impact_contact *contact, double height, impact_patch *patch)
{
    patch->count = 1;
    patch->point[0] = (impact_patch_point){.offset1 = contact->offset1,
                                           .offset2 = contact->offset2,
                                           .normal = contact->normal,
                                           .height = contact->gap,
                                           .feature1 = s[0].face.feature,
                                           .feature2 = s[1].face.feature,
                                           .closed = contact->gap <= height};
}

static int patch_dimension(const impact_patch *patch)
{
    int closed = 0;
    for (int i = 0; i < patch->count; i++) closed += patch->point[i].closed;
    return closed > 2 ? 2 : closed - 1;
}

/* Of a disc that lies on the other face as a whole. */
static double whole_disc(const face_side s[2], const imp_flat *common)
{
    for (int k = 0; k < 2; k++) {
        int kept = 0;
        for (int i = 0; s[k].face.disc > 0 && i < common->count; i++)
            kept += common->from[i] >= 0 && (common->from[i] >= IMPACT_FACE_POINTS) == (k == 1);
        if (kept == IMPACT_FACE_RIM && common->count == kept) return s[k].face.disc;
    }
    return 0;
}

/* A whole disc keeps places a sixteenth of its rim apart: of equal areas roundings would choose. */
static void thin_disc(imp_flat *common)
{
    enum { EVERY = IMPACT_FACE_RIM / IMPACT_PATCH_POINTS };
    int kept = 0;
    for (int i = 0; i < common->count; i++) {
        if (common->from[i] % IMPACT_FACE_POINTS % EVERY != 0) continue;
        memcpy(common->p[kept], common->p[i], sizeof common->p[i]);
        common->from[kept++] = common->from[i];
    }
    common->count = kept;
}

/* Where the contact is, if no point of the patch is as near: a corner amid others that are a little higher. */
static void put_nearest(const face_side s[2], const patch_frame *f, const impact_contact *contact, double height,
                        impact_patch *patch)
{
    for (int i = 0; i < patch->count; i++)
        if (patch->point[i].height <= contact->gap + f->slack) return;
    const qvec3 place = qvec3_add(s[0].center, contact->offset1);
    const double p[2] = {qvec3_dot(place, f->x), qvec3_dot(place, f->y)};
    if (patch->count == IMPACT_PATCH_POINTS) patch->count--;
    put_point(s, f, p, height, patch);
}

static void clip_faces(face_side s[2], const patch_frame *f, double height, impact_patch *patch)
{
    imp_flat common;
    imp_flat_copy(&common, &s[0].flat);
    imp_flat_clip(&common, &s[1].flat, f->slack, IMPACT_FACE_POINTS);
    if (common.count > 1) imp_flat_hull(&common, f->slack);
    patch->disc = whole_disc(s, &common);
    patch->thinned = common.count > IMPACT_PATCH_POINTS ? common.count - IMPACT_PATCH_POINTS : 0;
    if (patch->disc > 0) thin_disc(&common);
    imp_flat_thin(&common, IMPACT_PATCH_POINTS);
    for (int i = 0; i < common.count; i++) put_point(s, f, common.p[i], height, patch);
}

/* ---- lines on each other ---- */

/* A place of a line: across the normal, how far along, its height, and how round the body is across it. */
typedef struct line_place {
    double p[2], z, radius;
} line_place;

/* m: the radius across a line of the surface at its point. */
static double radius_across(const impact_shape *shape, qvec3 point)
{
    switch (shape->kind) {
    case IMPACT_CYLINDER:
    case IMPACT_CAPSULE: return hypot(point.x, point.y);
    case IMPACT_CONE: return hypot(point.x, point.y) * hypot(1, shape->a / shape->c);
    default: return shape->rounding;
    }
}

static line_place place_between(const face_side *s, double part)
{
    line_place place;
    for (int k = 0; k < 2; k++) place.p[k] = s->corner[0][k] + part * (s->corner[1][k] - s->corner[0][k]);
    place.z = height_of_plane(s, place.p);
    const double r0 = radius_across(s->shape, s->face.point[0]), r1 = radius_across(s->shape, s->face.point[1]);
    place.radius = r0 + part * (r1 - r0);
    return place;
}

/* The places of both, so far along the first line. */
static void places_at(const face_side s[2], const double u[2], double t, line_place place[2])
{
    double from[2];
    for (int k = 0; k < 2; k++)
        from[k] = (s[k].corner[0][0] - s[0].corner[0][0]) * u[0] + (s[k].corner[0][1] - s[0].corner[0][1]) * u[1];
    for (int k = 0; k < 2; k++) {
        const double x = s[k].corner[1][0] - s[k].corner[0][0], y = s[k].corner[1][1] - s[k].corner[0][1];
        place[k] = place_between(&s[k], (t - from[k]) / (x * u[0] + y * u[1]));
    }
}

/* Where what two lines share begins and ends, along the first, whose direction is u; false: it is a point, or none. */
static bool find_shared(const face_side s[2], const patch_frame *f, const double u[2], double end[2])
{
    end[0] = -INFINITY, end[1] = INFINITY;
    for (int k = 0; k < 2; k++) {
        double t[2];
        for (int i = 0; i < 2; i++)
            t[i] = (s[k].corner[i][0] - s[0].corner[0][0]) * u[0] + (s[k].corner[i][1] - s[0].corner[0][1]) * u[1];
        end[0] = fmax(end[0], fmin(t[0], t[1])), end[1] = fmin(end[1], fmax(t[0], t[1]));
    }
    return end[1] - end[0] > f->slack;
}

/* How far surfaces that are d to the side of each other part by it: d^2/2R of round ones, no more than d of sharp ones.
 */
static double rise_across(double aside, double radius, double slack)
{
    const double d = fabs(aside);
    return d <= slack ? 0 : d < 2 * radius ? d * d / (2 * radius) : d;
}

/* Of lines d apart the surfaces are nearest between them, at R1/R and R2/R of the way, where each has fallen back;
 * sharp edges have no way that they fall back. */
static void put_between(const face_side s[2], const patch_frame *f, const line_place place[2], double aside,
                        const double across[2], double height, impact_patch *patch)
{
    const double radius = place[0].radius + place[1].radius;
    const bool round = fabs(aside) > f->slack && fabs(aside) < 2 * radius;
    const double rise = round ? rise_across(aside, radius, f->slack) : 0, part = round ? place[0].radius / radius : 0,
                 tilt = round ? -aside / radius : 0;
    const double p[2] = {place[0].p[0] + part * aside * across[0], place[0].p[1] + part * aside * across[1]},
                 z1 = place[0].z + part * rise, z2 = place[1].z - (1 - part) * rise;
    const qvec3 flat = qvec3_axpy(p[0], f->x, qvec3_scale(f->y, p[1])),
                side = qvec3_axpy(across[0], f->x, qvec3_scale(f->y, across[1]));
    patch->point[patch->count++] =
        (impact_patch_point){.offset1 = qvec3_sub(qvec3_axpy(z1, f->n, flat), s[0].center),
                             .offset2 = qvec3_axpy(z2, f->n, flat),
                             .normal = qvec3_scale(qvec3_axpy(tilt, side, f->n), 1 / hypot(1, tilt)),
                             .height = z1 - z2,
                             .feature1 = feature_at(&s[0], place[0].p, f->slack),
                             .feature2 = feature_at(&s[1], place[1].p, f->slack),
                             .closed = z1 - z2 <= height};
}

/* The ends of what two lines share, if they are as good as on each other there. */
static void join_lines(const face_side s[2], const patch_frame *f, double height, impact_patch *patch)
{
    const double x = s[0].corner[1][0] - s[0].corner[0][0], y = s[0].corner[1][1] - s[0].corner[0][1],
                 length = hypot(x, y), u[2] = {x / length, y / length}, across[2] = {-u[1], u[0]};
    double end[2], aside[2];
    line_place place[2][2];
    if (!find_shared(s, f, u, end)) return;
    for (int i = 0; i < 2; i++) {
        places_at(s, u, end[i], place[i]);
        aside[i] =
            (place[i][1].p[0] - place[i][0].p[0]) * across[0] + (place[i][1].p[1] - place[i][0].p[1]) * across[1];
        if (!(rise_across(aside[i], place[i][0].radius + place[i][1].radius, f->slack) <= height)) return;
    }
    for (int i = 0; i < 2; i++) put_between(s, f, place[i], aside[i], across, height, patch);
}

/* No less than the bounding radius, which of shapes without a core takes a search. */
static double shape_reach(const impact_shape *shape)
{
    const bool quadric = shape->kind == IMPACT_SUPERQUADRIC || shape->kind == IMPACT_SUPERELLIPSOID;
    return quadric ? qvec3_norm((qvec3){shape->a, shape->b, shape->c}) : impact_shape_bounding_radius(shape);
}

static patch_frame frame_of(const impact_solid *body1, const impact_solid *body2, const impact_contact *contact)
{
    const double n[3] = {contact->normal.x, contact->normal.y, contact->normal.z};
    double t[2][3];
    imp_across(n, t);
    const double size = fmin(shape_reach(&body1->shape), shape_reach(&body2->shape)) +
                        qvec3_norm(qvec3_sub(body1->position, body2->position));
    return (patch_frame){.n = contact->normal, /* x, y, n: right-handed */
                         .x = {t[0][0], t[0][1], t[0][2]},
                         .y = qvec3_cross(contact->normal, (qvec3){t[0][0], t[0][1], t[0][2]}),
                         .slack = IMP_PATCH_BORDER * size,
                         .room = 2 * size};
}

impact_status impact_patch_find(const impact_solid *body1, const impact_solid *body2, const impact_contact *contact,
                                double height, impact_patch *patch)
{
    const qvec3 n = contact->normal, none = {0, 0, 0};
    face_side s[2];
    *patch = (impact_patch){.dimension = -1, .normal = n};
    if (!isfinite(height) || !isfinite(contact->gap) || !(fabs(qvec3_norm(n) - 1) <= IMP_FACE_UNIT))
        return IMPACT_EDOMAIN;
    if (height < 0) return IMPACT_EARGUMENT;
    const patch_frame f = frame_of(body1, body2, contact);
    const qvec3 c = qvec3_sub(body1->position, body2->position);
    if (!lay_face(body1, c, qvec3_neg(n), height, &f, &s[0]) || !lay_face(body2, none, n, height, &f, &s[1]))
        return IMPACT_EARGUMENT;
    patch->dimension1 = s[0].face.dimension, patch->dimension2 = s[1].face.dimension;
    if (s[0].face.dimension == 1 && s[1].face.dimension == 1)
        join_lines(s, &f, height, patch);
    else if (s[0].face.dimension > 0 && s[1].face.dimension > 0)
        clip_faces(s, &f, height, patch);
    if (patch->count > 0 && (s[0].bent || s[1].bent)) put_nearest(s, &f, contact, height, patch);
    if (patch->count == 0) lone_point(s, contact, height, patch);
    patch->dimension = patch_dimension(patch);
    return IMPACT_OK;
}
