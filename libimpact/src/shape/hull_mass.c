/* SPDX-License-Identifier: MIT
 *
 * Moments of a polyhedron K and of K with a ball of radius r about each of its points. Of K: the divergence theorem
 * over the tetrahedra from the origin to its faces' triangles (Mirtich 1996). Around it, x = p + t n, 0 <= t <= r, n
 * normal to K at p:
 *
 *     a prism on each face, area A, int p = A g, int p p' = S       dV = dA dt
 *     a wedge on each edge, angle theta, int n = s, int n n' = T    dV = dl t dt dtheta
 *     a sector on each vertex, solid angle w, int n = f, n n' = F   dV = t^2 dt dOmega
 *
 * The angle of a sector is what its faces' corners leave of 2 pi. By Gauss's theorem on the unit sector, with sides of
 * arc vectors s_i and angles theta_i and outward normals e_i (the edges from the vertex): f = -1/2 sum theta_i e_i and
 * F = (w - sum s_i e_i')/3.
 */
#include "base/numbers.h"
#include "shape/core.h"

static qvec3 vector_of(const double x[3]) { return (qvec3){x[0], x[1], x[2]}; }

/* moments += weight * (1, p, p p') */
static void add_moments_at(double moments[10], double weight, qvec3 p)
{
    const double terms[10] = {1, p.x, p.y, p.z, p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.y * p.z, p.z * p.x};
    for (int i = 0; i < 10; i++) moments[i] += weight * terms[i];
}

/* The second moments += weight * (a b' + b a')/2 */
static void add_product_of(double moments[10], double weight, qvec3 a, qvec3 b)
{
    const double terms[6] = {a.x * b.x,
                             a.y * b.y,
                             a.z * b.z,
                             0.5 * (a.x * b.y + a.y * b.x),
                             0.5 * (a.y * b.z + a.z * b.y),
                             0.5 * (a.z * b.x + a.x * b.z)};
    for (int i = 0; i < 6; i++) moments[4 + i] += weight * terms[i];
}

static void add_first(double moments[10], double weight, qvec3 p)
{
    moments[1] += weight * p.x, moments[2] += weight * p.y, moments[3] += weight * p.z;
}

/* Of a simplex the second moments are those of its corners and its middle: for n corners
 * measure/(n (n + 1)) (sum v v' + (sum v)(sum v)'). */
static void add_simplex(double moments[10], double measure, int corners, const qvec3 *v)
{
    const double share = measure / (corners * (corners + 1.0));
    qvec3 sum = {0, 0, 0};
    for (int i = 0; i < corners; i++) {
        sum = qvec3_add(sum, v[i]);
        add_product_of(moments, share, v[i], v[i]);
    }
    add_product_of(moments, share, sum, sum);
    moments[0] += measure;
    add_first(moments, measure / corners, sum);
}

/* A face's tetrahedra, and the prism on it. */
static void add_face(const impact_hull *hull, int face, double r, double moments[10])
{
    const short *loop = hull->loop + hull->start[face];
    const int count = hull->start[face + 1] - hull->start[face];
    const qvec3 n = vector_of(hull->normal[face]);
    double flat[10] = {0};
    for (int i = 1; i + 1 < count; i++) {
        const qvec3 v[4] = {vector_of(hull->vertex[loop[0]]),
                            vector_of(hull->vertex[loop[i]]),
                            vector_of(hull->vertex[loop[i + 1]]),
                            {0, 0, 0}};
        const qvec3 cross = qvec3_cross(qvec3_sub(v[1], v[0]), qvec3_sub(v[2], v[0]));
        add_simplex(moments, qvec3_dot(v[0], qvec3_cross(v[1], v[2])) / 6, 4, v);
        add_simplex(flat, 0.5 * qvec3_dot(cross, n), 3, v);
    }
    const qvec3 first = {flat[1], flat[2], flat[3]};
    for (int i = 0; i < 10; i++) moments[i] += r * flat[i];
    add_first(moments, 0.5 * r * r * flat[0], n);
    add_product_of(moments, r * r, first, n);
    add_product_of(moments, r * r * r / 3 * flat[0], n, n);
}

typedef struct wedge {
    qvec3 along, arc; /* unit, from v[0] to v[1]; int n dtheta */
    double length, angle;
    qvec3 middle, across; /* unit: of the arc, and across it and the edge */
} wedge;

static wedge wedge_of(const impact_hull *hull, const imp_hull_edge *edge)
{
    const qvec3 a = vector_of(hull->vertex[edge->v[0]]), b = vector_of(hull->vertex[edge->v[1]]), d = qvec3_sub(b, a);
    const qvec3 n = vector_of(hull->normal[edge->f[0]]), m = vector_of(hull->normal[edge->f[1]]), sum = qvec3_add(n, m);
    wedge w = {.length = qvec3_norm(d)};
    w.along = qvec3_scale(d, 1 / w.length);
    w.angle = 2 * atan2(qvec3_norm(qvec3_sub(n, m)), qvec3_norm(sum));
    w.middle = qvec3_scale(sum, 1 / qvec3_norm(sum));
    w.across = qvec3_cross(w.along, w.middle);
    w.arc = qvec3_scale(w.middle, 2 * sin(w.angle / 2));
    return w;
}

static void add_wedge(const impact_hull *hull, const imp_hull_edge *edge, const wedge *w, double r, double moments[10])
{
    const qvec3 a = vector_of(hull->vertex[edge->v[0]]), b = vector_of(hull->vertex[edge->v[1]]), ends[2] = {a, b};
    const double l = w->length, r2 = r * r / 2, r3 = r * r * r / 3, r4 = r * r * r * r / 4;
    add_simplex(moments, r2 * w->angle * l, 2, ends);
    add_first(moments, r3 * l, w->arc);
    add_product_of(moments, r3 * l, qvec3_add(a, b), w->arc);
    add_product_of(moments, r4 * l * (w->angle + sin(w->angle)) / 2, w->middle, w->middle);
    add_product_of(moments, r4 * l * (w->angle - sin(w->angle)) / 2, w->across, w->across);
}

/* The inner angles of faces at each vertex, summed. */
static void corner_angles(const impact_hull *hull, double *sum)
{
    for (int f = 0; f < hull->face_count; f++) {
        const short *loop = hull->loop + hull->start[f];
        const int count = hull->start[f + 1] - hull->start[f];
        for (int i = 0; i < count; i++) {
            const qvec3 v = vector_of(hull->vertex[loop[i]]);
            const qvec3 a = qvec3_sub(vector_of(hull->vertex[loop[(i + 1) % count]]), v),
                        b = qvec3_sub(vector_of(hull->vertex[loop[(i + count - 1) % count]]), v);
            sum[loop[i]] += atan2(qvec3_norm(qvec3_cross(a, b)), qvec3_dot(a, b));
        }
    }
}

/* Its part of the sectors at both ends: -1/2 theta e of f, -s e'/3 of F. */
static void add_sides(const impact_hull *hull, const imp_hull_edge *edge, const wedge *w, double r, double moments[10])
{
    const double r4 = r * r * r * r / 4, r5 = r * r * r * r * r / 5;
    for (int k = 0; k < 2; k++) {
        const qvec3 e = k ? qvec3_neg(w->along) : w->along, f = qvec3_scale(e, -0.5 * w->angle);
        add_first(moments, r4, f);
        add_product_of(moments, 2 * r4, vector_of(hull->vertex[edge->v[k]]), f);
        add_product_of(moments, -r5 / 3, w->arc, e);
    }
}

static void add_corner(const impact_hull *hull, int vertex, double angles, double r, double moments[10])
{
    const double w = 2 * IMP_PI - angles, r5 = r * r * r * r * r / 5;
    add_moments_at(moments, r * r * r / 3 * w, vector_of(hull->vertex[vertex]));
    for (int k = 0; k < 3; k++) moments[4 + k] += r5 * w / 3;
}

void imp_hull_moments(const impact_hull *hull, double r, double moments[10])
{
    double angles[IMPACT_HULL_POINTS] = {0};
    for (int i = 0; i < 10; i++) moments[i] = 0;
    for (int f = 0; f < hull->face_count; f++) add_face(hull, f, r, moments);
    if (!(r > 0)) return;
    corner_angles(hull, angles);
    for (int i = 0; i < hull->edge_count; i++) {
        const wedge w = wedge_of(hull, &hull->edge[i]);
        add_wedge(hull, &hull->edge[i], &w, r, moments);
        add_sides(hull, &hull->edge[i], &w, r, moments);
    }
    for (int i = 0; i < hull->vertex_count; i++) add_corner(hull, i, angles[i], r, moments);
}
