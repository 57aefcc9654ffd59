/* SPDX-License-Identifier: MIT */
#include "faces_oracle.h"
#include <quadmath.h>

typedef __float128 real;

enum { MOST = 256 };

typedef struct body {
    int vertices, triangles, edges;
    real vertex[MOST][3];
    int triangle[2 * MOST][3], edge[6 * MOST][2];
    real ball;
} body;

static real dot(const real a[3], const real b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const real a[3], const real b[3], real c[3])
{
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void minus(const real a[3], const real b[3], real c[3])
{
    for (int k = 0; k < 3; k++) c[k] = a[k] - b[k];
}

static void add_vertex(body *b, real x, real y, real z)
{
    b->vertex[b->vertices][0] = x, b->vertex[b->vertices][1] = y, b->vertex[b->vertices++][2] = z;
}

static void add_edge(body *b, int i, int j) { b->edge[b->edges][0] = i, b->edge[b->edges++][1] = j; }

/* A face as the fan of its triangles, with their sides. */
static void add_face(body *b, const int *v, int count)
{
    for (int i = 1; i + 1 < count; i++) {
        int *t = b->triangle[b->triangles++];
        t[0] = v[0], t[1] = v[i], t[2] = v[i + 1];
        add_edge(b, v[i], v[i + 1]);
        add_edge(b, v[0], v[i]);
    }
    add_edge(b, v[0], v[count - 1]);
}

static void make_box(body *b, const impact_shape *s)
{
    const real r = s->rounding;
    static const int face[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
    for (int i = 0; i < 8; i++)
        add_vertex(b, (i & 1 ? 1 : -1) * (s->a - r), (i & 2 ? 1 : -1) * (s->b - r), (i & 4 ? 1 : -1) * (s->c - r));
    for (int f = 0; f < 6; f++) add_face(b, face[f], 4);
}

static void make_octahedron(body *b, const impact_shape *s)
{
    for (int i = 0; i < 6; i++)
        add_vertex(b,
                   i == 0   ? s->a
                   : i == 1 ? -s->a
                            : 0,
                   i == 2   ? s->b
                   : i == 3 ? -s->b
                            : 0,
                   i == 4   ? s->c
                   : i == 5 ? -s->c
                            : 0);
    for (int i = 0; i < 8; i++) {
        const int v[3] = {i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2 & 1)};
        add_face(b, v, 3);
    }
}

static void make_hull(body *b, const impact_hull *hull)
{
    const impact_hull_info info = impact_hull_describe(hull);
    for (int i = 0; i < info.vertices; i++) {
        const qvec3 v = impact_hull_vertex(hull, i);
        add_vertex(b, v.x, v.y, v.z);
    }
    for (int f = 0; f < info.faces; f++) {
        int v[IMPACT_HULL_POINTS];
        const int count = impact_hull_face(hull, f, v, NULL);
        add_face(b, v, count);
    }
}

static void make(body *b, const impact_solid *solid)
{
    const impact_shape *s = &solid->shape;
    b->vertices = b->triangles = b->edges = 0;
    b->ball = s->rounding;
    switch (s->kind) {
    case IMPACT_SPHERE: add_vertex(b, 0, 0, 0), b->ball = s->a; break;
    case IMPACT_CAPSULE:
        add_vertex(b, 0, 0, (real)s->a - s->c), add_vertex(b, 0, 0, (real)s->c - s->a), add_edge(b, 0, 1);
        break;
    case IMPACT_BOX: make_box(b, s); break;
    case IMPACT_POLYHEDRON: make_hull(b, s->hull); break;
    default: make_octahedron(b, s);
    }
    const quat o = solid->orientation;
    real w = o.w, x = o.x, y = o.y, z = o.z;
    const real length = sqrtq(w * w + x * x + y * y + z * z);
    w /= length, x /= length, y /= length, z /= length;
    const real R[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    const real place[3] = {solid->position.x, solid->position.y, solid->position.z};
    for (int i = 0; i < b->vertices; i++) {
        real p[3];
        for (int k = 0; k < 3; k++) p[k] = dot(R[k], b->vertex[i]) + place[k];
        for (int k = 0; k < 3; k++) b->vertex[i][k] = p[k];
    }
}

/* g of cores along n of any length but 0, from body 2 to body 1. */
static real height(const body *one, const body *two, const real n[3])
{
    real low = HUGE_VALQ, high = -HUGE_VALQ;
    for (int i = 0; i < one->vertices; i++) low = fminq(low, dot(n, one->vertex[i]));
    for (int i = 0; i < two->vertices; i++) high = fmaxq(high, dot(n, two->vertex[i]));
    return (low - high) / sqrtq(dot(n, n));
}

static void offer_axis(const body *one, const body *two, const real n[3], real *best)
{
    if (!(dot(n, n) > 0)) return;
    const real m[3] = {-n[0], -n[1], -n[2]};
    *best = fmaxq(*best, fmaxq(height(one, two, n), height(one, two, m)));
}

static void triangle_normal(const body *b, int i, real n[3])
{
    real p[3], q[3];
    const int *t = b->triangle[i];
    minus(b->vertex[t[1]], b->vertex[t[0]], p);
    minus(b->vertex[t[2]], b->vertex[t[0]], q);
    cross(p, q, n);
}

static real facets(const body *one, const body *two)
{
    real best = -HUGE_VALQ, n[3], d[3], e[3];
    for (int i = 0; i < one->triangles; i++) triangle_normal(one, i, n), offer_axis(one, two, n, &best);
    for (int i = 0; i < two->triangles; i++) triangle_normal(two, i, n), offer_axis(one, two, n, &best);
    for (int i = 0; i < one->edges; i++)
        for (int j = 0; j < two->edges; j++) {
            minus(one->vertex[one->edge[i][1]], one->vertex[one->edge[i][0]], d);
            minus(two->vertex[two->edge[j][1]], two->vertex[two->edge[j][0]], e);
            cross(d, e, n);
            offer_axis(one, two, n, &best);
        }
    return best;
}

static real clamp(real t) { return t > 0 ? t < 1 ? t : 1 : 0; }

static real point_segment(const real p[3], const real a[3], const real b[3])
{
    real d[3], r[3];
    minus(b, a, d), minus(p, a, r);
    const real t = clamp(dot(r, d) / dot(d, d));
    for (int k = 0; k < 3; k++) r[k] -= t * d[k];
    return dot(r, r);
}

/* The lines' common normal where its feet are in both; the ends are looked at apart. */
static real segment_segment(const real a[3], const real b[3], const real c[3], const real d[3])
{
    real u[3], v[3], r[3], n[3], x[3];
    minus(b, a, u), minus(d, c, v), minus(c, a, r);
    cross(u, v, n);
    const real square = dot(n, n);
    if (!(square > 0)) return HUGE_VALQ;
    cross(r, v, x);
    const real s = dot(x, n) / square;
    cross(r, u, x);
    const real t = dot(x, n) / square;
    if (s < 0 || s > 1 || t < 0 || t > 1) return HUGE_VALQ;
    const real along = dot(r, n);
    return along * along / square;
}

static real point_triangle(const real p[3], const body *b, int i)
{
    real n[3], e[3], r[3], x[3];
    triangle_normal(b, i, n);
    const real square = dot(n, n);
    if (!(square > 0)) return HUGE_VALQ;
    for (int k = 0; k < 3; k++) {
        const real *from = b->vertex[b->triangle[i][k]], *to = b->vertex[b->triangle[i][(k + 1) % 3]];
        minus(to, from, e), minus(p, from, r);
        cross(e, r, x);
        if (dot(x, n) < 0) return HUGE_VALQ;
    }
    minus(p, b->vertex[b->triangle[i][0]], r);
    return dot(r, n) * dot(r, n) / square;
}

static real half_of_distances(const body *one, const body *two)
{
    real least = HUGE_VALQ, d[3];
    for (int i = 0; i < one->vertices; i++) {
        const real *p = one->vertex[i];
        for (int j = 0; j < two->vertices; j++) minus(p, two->vertex[j], d), least = fminq(least, dot(d, d));
        for (int j = 0; j < two->edges; j++)
            least = fminq(least, point_segment(p, two->vertex[two->edge[j][0]], two->vertex[two->edge[j][1]]));
        for (int j = 0; j < two->triangles; j++) least = fminq(least, point_triangle(p, two, j));
    }
    return least;
}

static real distance(const body *one, const body *two)
{
    real least = fminq(half_of_distances(one, two), half_of_distances(two, one));
    for (int i = 0; i < one->edges; i++)
        for (int j = 0; j < two->edges; j++)
            least = fminq(least, segment_segment(one->vertex[one->edge[i][0]], one->vertex[one->edge[i][1]],
                                                 two->vertex[two->edge[j][0]], two->vertex[two->edge[j][1]]));
    return sqrtq(least);
}

double faces_oracle_gap(const impact_solid *body1, const impact_solid *body2)
{
    static _Thread_local body one, two;
    make(&one, body1), make(&two, body2);
    /* Any axis that parts the bodies says which of the two it is; where none of the facets' does, they overlap. */
    const real deep = one.triangles + two.triangles > 0 ? facets(&one, &two) : 1;
    const real gap = deep > 0 ? distance(&one, &two) : deep;
    return (double)(gap - one.ball - two.ball);
}

double faces_oracle_error(const impact_solid *body1, const impact_solid *body2, const impact_contact *contact,
                          double gap)
{
    static _Thread_local body one, two;
    make(&one, body1), make(&two, body2);
    const impact_shape *s = &body1->shape, *t = &body2->shape;
    const double size = fmax(fmax(fmax(s->a, s->b), s->c), fmax(fmax(t->a, t->b), t->c));
    const qvec3 c = qvec3_sub(body1->position, body2->position);
    const real n[3] = {contact->normal.x, contact->normal.y, contact->normal.z};
    const double along = (double)(height(&one, &two, n) - one.ball - two.ball);
    const qvec3 v = qvec3_sub(qvec3_add(c, contact->offset1), contact->offset2);
    const double points = qvec3_dot(contact->normal, v), off = qvec3_norm(qvec3_axpy(-points, contact->normal, v));
    /* the normal of points that all but touch is as good as their distance allows: g tells what it is worth */
    double worst = fmax(fabs(contact->gap - gap), along - gap);
    worst = fmax(worst, contact->gap > 0 ? fabs(qvec3_norm(v) - gap) : fmax(fabs(points - gap), off));
    if (contact->upper - contact->lower <= 1e-14 * size) worst = fmax(worst, gap - along);
    return worst / (size + qvec3_norm(c));
}
