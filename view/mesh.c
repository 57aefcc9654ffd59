/* SPDX-License-Identifier: MIT
 *
 * A curved shape is a grid of Barr's angles, an octant at a time. A shape with faces is what it is made of: the faces
 * of its core moved out by the rounding r, a strip of the ball of r along each edge and a fan of it on each corner; one
 * that is round about z its profile, turned. Each of those polygons is cut along the planes x = 0, y = 0, z = 0.
 */
#include "mesh.h"

#include <math.h>
#include <quat/rotation.h>
#include <stdint.h>

enum { GRID = 12, GRID_ROW = GRID + 1, SECTORS = 64, MOST_CORNERS = IMPACT_HULL_POINTS + 4, ARC = 8 };

static const double quarter_turn = 1.5707963267948966;

/* rad between normals of neighbouring strips of a rounded edge. */
static const double widest_strip = 0.27;

/* A corner of a polygon, and the surface's normal there. */
typedef struct spot {
    qvec3 x, n;
} spot;

/* ---- vertices ---- */

static void put_three(imp_text *list, qvec3 v)
{
    const float values[3] = {(float)v.x, (float)v.y, (float)v.z};
    imp_text_put(list, values, sizeof values);
}

/* Normals are unit again once they are rounded to floats. */
static uint32_t put_spot(imp_mesh *mesh, const impact_body_def *body, spot s)
{
    const uint32_t number = (uint32_t)(mesh->points.size / (3 * sizeof(float)));
    put_three(&mesh->points, qvec3_add(body->shape_position, quat_rotate(body->shape_orientation, s.x)));
    put_three(&mesh->normals, quat_rotate(body->shape_orientation, qvec3_scale(s.n, 1 / qvec3_norm(s.n))));
    return number;
}

static void put_triangle(imp_mesh *mesh, int kind, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    imp_text_put(&mesh->index[kind], corners, sizeof corners);
}

/* ---- polygons, cut into octants ---- */

static double along(qvec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/* What of the polygon has side * coordinate >= 0; 0 corners when that has no inside. */
static int clip(const spot *in, int count, int axis, double side, spot *out)
{
    int kept = 0;
    bool inside = false;
    for (int i = 0; i < count; i++) {
        const spot *a = &in[i], *b = &in[(i + 1) % count];
        const double p = side * along(a->x, axis), q = side * along(b->x, axis);
        inside = inside || p > 0;
        if (p >= 0) out[kept++] = *a;
        if (p * q >= 0) continue;
        const double s = p / (p - q);
        out[kept++] = (spot){qvec3_axpy(s, qvec3_sub(b->x, a->x), a->x), qvec3_axpy(s, qvec3_sub(b->n, a->n), a->n)};
    }
    return inside && kept > 2 ? kept : 0;
}

static void put_polygon(imp_mesh *mesh, const impact_body_def *body, const spot *corners, int count, int axis, int kind)
{
    if (axis < 3) {
        spot part[MOST_CORNERS];
        for (int side = 0; side < 2; side++) {
            const int kept = clip(corners, count, axis, side ? -1 : 1, part);
            if (kept > 0) put_polygon(mesh, body, part, kept, axis + 1, (kind + side) % 2);
        }
        return;
    }
    const uint32_t first = put_spot(mesh, body, corners[0]);
    uint32_t last = put_spot(mesh, body, corners[1]);
    for (int i = 2; i < count; i++) {
        const uint32_t next = put_spot(mesh, body, corners[i]);
        put_triangle(mesh, kind, first, last, next);
        last = next;
    }
}

/* Corners in order round it; two of them may be one point. */
static void put_four(imp_mesh *mesh, const impact_body_def *body, spot a, spot b, spot c, spot d)
{
    const spot corners[4] = {a, b, c, d};
    put_polygon(mesh, body, corners, 4, 0, 0);
}

/* ---- flat faces ---- */

static int face_of(const impact_shape *shape, int face, int *vertex, qvec3 *normal)
{
    if (shape->kind == IMPACT_POLYHEDRON) return impact_hull_face(shape->hull, face, vertex, normal);
    static const int turns[2][4] = {{0, 2, 3, 1}, {0, 1, 3, 2}}; /* of the two bits after the axis */
    const int axis = face / 2, up = face % 2;
    for (int i = 0; i < 4; i++) {
        const int bits = turns[up][i];
        vertex[i] = (up << axis) | ((bits & 1) << (axis + 1) % 3) | ((bits >> 1) << (axis + 2) % 3);
    }
    const double sign = up ? 1 : -1;
    *normal = (qvec3){axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0};
    return 4;
}

static qvec3 vertex_of(const impact_shape *s, int i)
{
    if (s->kind == IMPACT_POLYHEDRON) return impact_hull_vertex(s->hull, i);
    const double r = s->rounding;
    return (qvec3){(i & 1 ? 1 : -1) * (s->a - r), (i & 2 ? 1 : -1) * (s->b - r), (i & 4 ? 1 : -1) * (s->c - r)};
}

/* The face whose border runs from one vertex to the other, and its normal; false: there is none. */
static bool face_beside(const impact_shape *shape, int faces, int from, int to, qvec3 *normal)
{
    int vertex[IMPACT_HULL_POINTS];
    for (int f = 0; f < faces; f++) {
        const int count = face_of(shape, f, vertex, normal);
        for (int i = 0; i < count; i++)
            if (vertex[i] == from && vertex[(i + 1) % count] == to) return true;
    }
    return false;
}

/* The sum of the normals that meet in a vertex. */
static qvec3 middle_of(const impact_shape *shape, int faces, int v)
{
    int vertex[IMPACT_HULL_POINTS];
    qvec3 sum = {0, 0, 0}, normal;
    for (int f = 0; f < faces; f++) {
        const int count = face_of(shape, f, vertex, &normal);
        for (int i = 0; i < count; i++)
            if (vertex[i] == v) sum = qvec3_add(sum, normal);
    }
    return qvec3_scale(sum, 1 / qvec3_norm(sum));
}

static qvec3 between(qvec3 n, qvec3 m, double s)
{
    const qvec3 sum = qvec3_axpy(s, qvec3_sub(m, n), n);
    return qvec3_scale(sum, 1 / qvec3_norm(sum));
}

static spot spot_at(qvec3 vertex, double r, qvec3 n) { return (spot){qvec3_axpy(r, n, vertex), n}; }

/* Along the edge from u to v with the normals left and right of it: its strips, and half of the fan at u. */
static void put_edge(imp_mesh *mesh, const impact_body_def *body, int faces, int u, int v, qvec3 left)
{
    const impact_shape *shape = &body->shape;
    const double r = shape->rounding;
    const qvec3 x = vertex_of(shape, u), y = vertex_of(shape, v), middle = middle_of(shape, faces, u);
    qvec3 right;
    if (!face_beside(shape, faces, v, u, &right)) return;
    const double angle = acos(fmax(-1, fmin(1, qvec3_dot(left, right))));
    const int parts = 1 + (int)(angle / widest_strip);
    for (int i = 0; i < parts; i++) {
        const qvec3 n = between(left, right, (double)i / parts), m = between(left, right, (i + 1.0) / parts);
        if (u < v) put_four(mesh, body, spot_at(x, r, m), spot_at(y, r, m), spot_at(y, r, n), spot_at(x, r, n));
        for (int k = 0; k < parts; k++) {
            const double s = (double)k / parts, t = (k + 1.0) / parts;
            put_four(mesh, body, spot_at(x, r, between(n, middle, s)), spot_at(x, r, between(n, middle, t)),
                     spot_at(x, r, between(m, middle, t)), spot_at(x, r, between(m, middle, s)));
        }
    }
}

static void flat_mesh(imp_mesh *mesh, const impact_body_def *body)
{
    const impact_shape *shape = &body->shape;
    const int faces = shape->kind == IMPACT_BOX ? 6 : impact_hull_describe(shape->hull).faces;
    int vertex[IMPACT_HULL_POINTS];
    for (int f = 0; f < faces; f++) {
        qvec3 normal;
        spot corners[MOST_CORNERS];
        const int count = face_of(shape, f, vertex, &normal);
        for (int i = 0; i < count; i++) corners[i] = spot_at(vertex_of(shape, vertex[i]), shape->rounding, normal);
        put_polygon(mesh, body, corners, count, 0, 0);
        for (int i = 0; i < count && shape->rounding > 0; i++)
            put_edge(mesh, body, faces, vertex[i], vertex[(i + 1) % count], normal);
    }
}

/* ---- round about z ---- */

/* A ring: its radius and height, and the normal out and up. */
typedef struct ring {
    double rho, z, out, up;
} ring;

/* Rings of the ball of r about (rho, z), from one angle of the normal over the equator to another. */
static int put_arc(ring *rings, double rho, double z, double r, double from, double to)
{
    for (int i = 0; i <= ARC; i++) {
        const double a = from + (to - from) * i / ARC;
        rings[i] = (ring){rho + r * cos(a), z + r * sin(a), cos(a), sin(a)};
    }
    return ARC + 1;
}

/* From the lowest point to the highest. A cone's side stands at atan(R/H) over the equator. */
static int profile_of(const impact_shape *s, ring *rings)
{
    const double r = s->rounding, rho = s->a - r;
    int count = 1;
    if (s->kind == IMPACT_CONE) {
        const double height = s->c - 2 * r, tilt = atan2(rho, height);
        rings[0] = (ring){0, s->base - r, 0, -1};
        count += put_arc(rings + count, rho, s->base, r, -quarter_turn, tilt);
        return count + put_arc(rings + count, 0, s->base + height, r, tilt, quarter_turn);
    }
    rings[0] = (ring){0, -s->c, 0, -1};
    count += put_arc(rings + count, rho, r - s->c, r, -quarter_turn, 0);
    count += put_arc(rings + count, rho, s->c - r, r, 0, quarter_turn);
    rings[count] = (ring){0, s->c, 0, 1};
    return count + 1;
}

static spot turned(const ring *r, int sector)
{
    const double a = 4 * quarter_turn * sector / SECTORS, c = cos(a), s = sin(a);
    return (spot){{r->rho * c, r->rho * s, r->z}, {r->out * c, r->out * s, r->up}};
}

static void round_mesh(imp_mesh *mesh, const impact_body_def *body)
{
    ring rings[2 * ARC + 4];
    const int count = profile_of(&body->shape, rings);
    for (int k = 0; k + 1 < count; k++) {
        const ring *a = &rings[k], *b = &rings[k + 1];
        if (a->rho == b->rho && a->z == b->z) continue; /* a sharp rim */
        for (int i = 0; i < SECTORS; i++)
            put_four(mesh, body, turned(a, i), turned(a, i + 1), turned(b, i + 1), turned(b, i));
    }
}

/* ---- curved all over ---- */

static void curved_mesh(imp_mesh *mesh, const impact_body_def *body)
{
    for (int octant = 0; octant < 8; octant++) {
        const int kind = (octant + octant / 4 + 1) % 2;
        uint32_t first = 0;
        for (int j = 0; j < GRID_ROW; j++)
            for (int i = 0; i < GRID_ROW; i++) {
                const double u = quarter_turn * (octant % 4 - 2 + (double)i / GRID);
                const double v = quarter_turn * (octant / 4 - 1 + (double)j / GRID);
                const spot s = {impact_shape_point(&body->shape, u, v), impact_shape_normal(&body->shape, u, v)};
                const uint32_t number = put_spot(mesh, body, s);
                if (i == 0 && j == 0) first = number;
            }
        for (int j = 0; j < GRID; j++)
            for (int i = 0; i < GRID; i++) {
                const uint32_t a = first + (uint32_t)(j * GRID_ROW + i), b = a + GRID_ROW;
                put_triangle(mesh, kind, a, a + 1, b + 1);
                put_triangle(mesh, kind, a, b + 1, b);
            }
    }
}

bool imp_mesh_of(imp_arena *arena, const impact_body_def *body, imp_mesh *mesh)
{
    const imp_text none = {.arena = arena};
    *mesh = (imp_mesh){none, none, {none, none}};
    switch (body->shape.kind) {
    case IMPACT_BOX:
    case IMPACT_POLYHEDRON: flat_mesh(mesh, body); break;
    case IMPACT_CYLINDER:
    case IMPACT_CONE:
    case IMPACT_CAPSULE: round_mesh(mesh, body); break;
    default: curved_mesh(mesh, body);
    }
    return !(mesh->points.failed || mesh->normals.failed || mesh->index[0].failed || mesh->index[1].failed);
}

void imp_mesh_free(imp_mesh *mesh)
{
    imp_text_free(&mesh->points);
    imp_text_free(&mesh->normals);
    imp_text_free(&mesh->index[0]);
    imp_text_free(&mesh->index[1]);
}
