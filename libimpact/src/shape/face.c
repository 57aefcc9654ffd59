/* SPDX-License-Identifier: MIT
 *
 * Flats. A superquadric about its axis k, x_k = A_k (1 - e): sum over the other two of |x_i/A_i|^p_i is
 * 1 - (1 - e)^p_k ~ p_k e, so that what is within the height of the plane reaches A_i (p_k height/A_k)^(1/p_i): nearly
 * all of the side for a large p_i, the square root of the height for 2. A superellipsoid's section counts with its
 * exponent t outside: (t/r) |y/b|^r + |z/c|^t <= t e about x.
 */
#include <impact/face.h>
#include "base/numbers.h"
#include "base/tolerances.h"
#include "shape/ridge.h"
#include "shape/solid.h"

static void put_point(impact_face *face, qvec3 x, impact_feature_kind kind, int index)
{
    face->point[face->count] = x;
    face->corner[face->count++] = (impact_feature){kind, index};
}

/* Corners of a convex face into their order about the direction: by the angle at their mean. */
static void order(impact_face *face, qvec3 d)
{
    qvec3 mean = {0, 0, 0};
    double angle[IMPACT_FACE_POINTS];
    for (int i = 0; i < face->count; i++) mean = qvec3_axpy(1.0 / face->count, face->point[i], mean);
    const qvec3 x = qvec3_sub(face->point[0], mean), y = qvec3_cross(d, x);
    for (int i = 0; i < face->count; i++) {
        const qvec3 r = qvec3_sub(face->point[i], mean), p = face->point[i];
        const impact_feature corner = face->corner[i];
        const double turn = atan2(qvec3_dot(r, y), qvec3_dot(r, x));
        int j = i;
        for (; j > 0 && angle[j - 1] > turn; j--)
            angle[j] = angle[j - 1], face->point[j] = face->point[j - 1], face->corner[j] = face->corner[j - 1];
        angle[j] = turn, face->point[j] = p, face->corner[j] = corner;
    }
}

/* ---- polytopes ---- */

static int edge_between(const impact_hull *hull, int i, int j)
{
    for (int e = 0; e < hull->edge_count; e++) {
        const short *v = hull->edge[e].v;
        if ((v[0] == i && v[1] == j) || (v[0] == j && v[1] == i)) return e;
    }
    return -1;
}

static int face_along(const imp_core *core, const double d[3])
{
    int best = -1;
    double most = -INFINITY;
    for (int f = 0; f < core->hull->face_count; f++) {
        double n[3];
        imp_core_normal(core, f, n);
        const double along = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
        if (along > most) most = along, best = f;
    }
    return best;
}

static void polytope_face(const imp_form *form, qvec3 d, double height, impact_face *face)
{
    short vertex[IMPACT_HULL_POINTS];
    const double at[3] = {d.x, d.y, d.z}, size = fmax(form->axis[0], fmax(form->axis[1], form->axis[2]));
    double mean[3], x[3];
    const int count = imp_core_reached(&form->core, at, fmax(height, IMP_CORE_TIE * size), vertex, mean);
    for (int i = 0; i < count; i++) {
        imp_core_vertex(&form->core, vertex[i], x);
        put_point(face, (qvec3){x[0], x[1], x[2]}, IMPACT_VERTEX, vertex[i]);
    }
    face->dimension = count > 2 ? 2 : count - 1;
    if (count > 2) order(face, d);
    face->feature = count > 2    ? (impact_feature){IMPACT_FACE, face_along(&form->core, at)}
                    : count == 2 ? (impact_feature){IMPACT_EDGE, edge_between(form->core.hull, vertex[0], vertex[1])}
                                 : face->corner[0];
}

/* ---- turned bodies ---- */

static void disc_face(impact_face *face, double radius, double z, bool up, int index)
{
    for (int i = 0; i < IMPACT_FACE_RIM; i++) {
        const double angle = (up ? 2 : -2) * IMP_PI * i / IMPACT_FACE_RIM;
        put_point(face, (qvec3){radius * cos(angle), radius * sin(angle), z}, IMPACT_RIM, index);
    }
    face->dimension = 2, face->disc = radius;
    face->feature = (impact_feature){IMPACT_FACE, index};
}

static void line_face(impact_face *face, qvec3 a, impact_feature_kind first, qvec3 b, impact_feature_kind second)
{
    put_point(face, a, first, 0);
    put_point(face, b, second, 1);
    face->dimension = 1;
    face->feature = (impact_feature){IMPACT_EDGE, -1};
}

/* Cap 0 is at -z, 1 at +z. */
static void cylinder_face(const imp_form *form, qvec3 d, double height, impact_face *face)
{
    const double R = form->axis[0], c = form->axis[2], across = hypot(d.x, d.y), up = d.z > 0 ? c : -c;
    const qvec3 rim = {across > 0 ? R * d.x / across : R, across > 0 ? R * d.y / across : 0, 0};
    if (2 * R * across <= height)
        disc_face(face, R, up, d.z > 0, d.z > 0);
    else if (2 * c * fabs(d.z) <= height)
        line_face(face, (qvec3){rim.x, rim.y, -c}, IMPACT_RIM, (qvec3){rim.x, rim.y, c}, IMPACT_RIM);
    else
        put_point(face, (qvec3){rim.x, rim.y, up}, IMPACT_RIM, d.z > 0);
}

static void cone_face(const imp_form *form, qvec3 d, double height, impact_face *face)
{
    const double R = form->axis[0], H = form->axis[2], across = hypot(d.x, d.y), tilt = R * across - H * d.z;
    const qvec3 rim = {across > 0 ? R * d.x / across : R, across > 0 ? R * d.y / across : 0, form->base},
                top = {0, 0, form->base + H};
    if (d.z < 0 && 2 * R * across <= height)
        disc_face(face, R, form->base, false, 0);
    else if (fabs(tilt) <= height)
        line_face(face, rim, IMPACT_RIM, top, IMPACT_VERTEX);
    else if (tilt > 0)
        put_point(face, rim, IMPACT_RIM, 0);
    else
        put_point(face, top, IMPACT_VERTEX, 0);
}

/* ---- superquadrics ---- */

/* Half the sides of the flat about axis k; 0 along what is curved. weight: of |x_i/A_i|^p_i in the sum that is room. */
typedef struct flat_place {
    double half[3], p[3], weight[3], room;
} flat_place;

static flat_place flat_about(const imp_form *form, int k, double height)
{
    const bool nested = form->nested;
    const double r = form->p[0], t = nested ? form->p[IMP_SECTION] : form->p[2], outer = nested ? t : form->p[k];
    flat_place f = {.p = {r, nested ? r : form->p[1], t}, .weight = {1, 1, 1}};
    if (nested && k < 2) f.weight[1 - k] = t / r;
    if (nested && k == 2) f.p[0] = f.p[1] = t;
    f.room = -expm1(outer * log1p(-fmin(height / form->axis[k], 0.5)));
    for (int i = 0; i < 3; i++)
        f.half[i] = i != k && f.p[i] >= IMP_FLAT_EXPONENT ? form->axis[i] * pow(f.room / f.weight[i], 1 / f.p[i]) : 0;
    return f;
}

/* The border of the flat about axis k, in the section's own exponent for a superellipsoid about z. */
static void quadric_polygon(const imp_form *form, int k, bool up, const flat_place *f, impact_face *face)
{
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    for (int corner = 0; corner < IMPACT_FACE_RIM; corner++) {
        const double angle = (up ? 2 : -2) * IMP_PI * corner / IMPACT_FACE_RIM;
        const double c = corner % (IMPACT_FACE_RIM / 2) == IMPACT_FACE_RIM / 4 ? 0 : cos(angle),
                     s = corner % (IMPACT_FACE_RIM / 2) == 0 ? 0 : sin(angle);
        const double p = form->nested && k == 2 ? form->p[0] : f->p[i],
                     q = form->nested && k == 2 ? form->p[0] : f->p[j];
        double x[3];
        x[k] = up ? form->axis[k] : -form->axis[k];
        x[i] = copysign(f->half[i] * pow(fabs(c), 2 / p), c), x[j] = copysign(f->half[j] * pow(fabs(s), 2 / q), s);
        put_point(face, (qvec3){x[0], x[1], x[2]}, IMPACT_SMOOTH, -1);
    }
    face->dimension = 2;
    face->feature = (impact_feature){IMPACT_FACE, 2 * k + up};
}

static void quadric_face(const imp_form *form, qvec3 direction, double height, impact_face *face)
{
    const double d[3] = {direction.x, direction.y, direction.z};
    int k = fabs(d[0]) > fabs(d[1]) ? 0 : 1;
    if (fabs(d[2]) > fabs(d[k])) k = 2;
    const flat_place f = flat_about(form, k, height);
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const bool wide[2] = {f.half[i] > 0 && f.half[i] * fabs(d[i]) <= height,
                          f.half[j] > 0 && f.half[j] * fabs(d[j]) <= height};
    imp_surface s;
    double x[3], normal[3];
    imp_form_support(form, d, &s);
    imp_surface_point(form, &s, x, normal);
    if (wide[0] && wide[1]) {
        quadric_polygon(form, k, d[k] > 0, &f, face);
    } else if (wide[0] || wide[1]) {
        const int along = wide[0] ? i : j;
        double y[3] = {x[0], x[1], x[2]};
        x[along] = -f.half[along], y[along] = f.half[along];
        line_face(face, (qvec3){x[0], x[1], x[2]}, IMPACT_SMOOTH, (qvec3){y[0], y[1], y[2]}, IMPACT_SMOOTH);
    } else {
        put_point(face, (qvec3){x[0], x[1], x[2]}, IMPACT_SMOOTH, -1);
    }
}

/* A line from edge to edge, or the place of the one that reaches farther. */
static void ridged_face(const imp_form *form, qvec3 d, double height, impact_face *face)
{
    int feature[2];
    qvec3 x[2];
    imp_ridge_facing(form, d, feature);
    for (int k = 0; k < 2; k++) x[k] = imp_ridge_place(form, feature[k], d, IMP_RIDGE_END);
    const qvec3 apart = qvec3_sub(x[1], x[0]);
    const double ahead = qvec3_dot(d, apart);
    impact_feature_kind kind[2];
    for (int k = 0; k < 2; k++) kind[k] = imp_ridge_is_apex(form, feature[k]) ? IMPACT_VERTEX : IMPACT_EDGE;
    const bool both = fabs(ahead) <= height && qvec3_norm(apart) > 0;
    const int first = !both && ahead > 0;
    put_point(face, x[first], kind[first], feature[first]);
    if (!both) return;
    put_point(face, x[1], kind[1], feature[1]);
    face->dimension = 1;
    face->feature = (impact_feature){IMPACT_EDGE, -1};
}

/* ---- all ---- */

static int plane_face(const impact_shape *shape, qvec3 d, impact_face *face)
{
    if (!(d.z > 0) || hypot(d.x, d.y) > IMP_FACE_UNIT) return -1;
    face->feature = (impact_feature){IMPACT_FACE, -1};
    face->dimension = 2;
    if (!isfinite(shape->a) || !isfinite(shape->b)) return 2;
    for (int i = 0; i < 4; i++)
        put_point(face, (qvec3){i == 1 || i == 2 ? shape->a : -shape->a, i > 1 ? shape->b : -shape->b, 0}, IMPACT_EDGE,
                  -1);
    return 2;
}

int impact_shape_face(const impact_shape *shape, qvec3 direction, double height, impact_face *face)
{
    face->dimension = face->count = 0;
    face->disc = 0;
    face->feature = (impact_feature){IMPACT_SMOOTH, -1};
    if (!(height >= 0) || !(fabs(qvec3_norm(direction) - 1) <= IMP_FACE_UNIT)) return -1;
    if (shape->kind == IMPACT_PLANE) return plane_face(shape, direction, face);
    imp_form form;
    imp_form_make(shape, 1, quat_identity(), &form);
    switch (form.kind) {
    case IMP_FORM_QUADRIC:
        if (imp_ridge_count(shape) > 0)
            ridged_face(&form, direction, height, face);
        else
            quadric_face(&form, direction, height, face);
        break;
    case IMP_FORM_CYLINDER: cylinder_face(&form, direction, height, face); break;
    case IMP_FORM_CONE: cone_face(&form, direction, height, face); break;
    default: polytope_face(&form, direction, height, face);
    }
    for (int i = 0; i < face->count; i++) face->point[i] = qvec3_axpy(form.rounding, direction, face->point[i]);
    if (face->dimension == 0) face->feature = face->corner[0];
    return face->dimension;
}
