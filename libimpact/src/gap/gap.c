/* SPDX-License-Identifier: MIT */
#include <impact/gap.h>
#include <quat/rotation.h>
#include "base/tolerances.h"
#include "gap/gap_core.h"
#include "gap/gap_solver.h"

static impact_contact no_contact(void)
{
    const qvec3 nan = {NAN, NAN, NAN};
    return (impact_contact){.gap = NAN,
                            .normal = nan,
                            .point1 = nan,
                            .point2 = nan,
                            .offset1 = nan,
                            .offset2 = nan,
                            .stiffness = NAN,
                            .lower = NAN,
                            .upper = NAN,
                            .path = IMPACT_PATH_NONE};
}

/* Fills the contact from the gap, the normal (2 to 1) and the witness offsets. */
static void closed_form(const impact_solid *body1, const impact_solid *body2, double gap, qvec3 normal, qvec3 offset1,
                        qvec3 offset2, double stiffness, impact_contact *contact)
{
    *contact = (impact_contact){.gap = gap,
                                .normal = normal,
                                .point1 = qvec3_add(body1->position, offset1),
                                .point2 = qvec3_add(body2->position, offset2),
                                .offset1 = offset1,
                                .offset2 = offset2,
                                .stiffness = stiffness,
                                .lower = gap,
                                .upper = gap,
                                .path = IMPACT_PATH_CLOSED_FORM};
}

static impact_status sphere_sphere(const impact_solid *body1, const impact_solid *body2, impact_contact *contact)
{
    const double r1 = body1->shape.a, r2 = body2->shape.a;
    const qvec3 d = qvec3_sub(body1->position, body2->position);
    const double distance = qvec3_norm(d);
    const qvec3 normal = distance > 0 ? qvec3_scale(d, 1 / distance) : (qvec3){0, 0, 1};
    const double gap = distance - r1 - r2;
    closed_form(body1, body2, gap, normal, qvec3_scale(normal, -r1), qvec3_scale(normal, r2), r1 + r2 + gap, contact);
    return distance > 0 ? IMPACT_OK : IMPACT_DEEP;
}

/* Power of two that brings the shape's largest semi-axis into [1, 2). */
static double unit_scale(const impact_shape *shape)
{
    return ldexp(1, -ilogb(fmax(shape->a, fmax(shape->b, shape->c))));
}

/* From the body's support h and point (less its position) along -normal. */
static void on_plane(const impact_solid *body, const impact_solid *plane, qvec3 normal, double h, qvec3 offset,
                     impact_contact *contact)
{
    const qvec3 d = qvec3_sub(body->position, plane->position);
    const double gap = qvec3_dot(normal, d) - h;
    const qvec3 foot = qvec3_axpy(-gap, normal, qvec3_add(d, offset));
    closed_form(body, plane, gap, normal, offset, foot, INFINITY, contact);
}

/* body is body 1: the gap is its lowest point's height, by the support function. */
static void body_plane(const impact_solid *body, quat body_orientation, const impact_solid *plane,
                       quat plane_orientation, impact_contact *contact)
{
    const qvec3 normal = quat_rotate(plane_orientation, (qvec3){0, 0, 1});
    if (body->shape.kind == IMPACT_SPHERE) {
        on_plane(body, plane, normal, body->shape.a, qvec3_scale(normal, -body->shape.a), contact);
        return;
    }
    const double scale = unit_scale(&body->shape), down[3] = {-normal.x, -normal.y, -normal.z};
    imp_form form;
    imp_surface surface;
    double x[3];
    imp_form_make(&body->shape, scale, body_orientation, &form);
    const double h = imp_form_support_world(&form, down, x, &surface) / scale;
    const qvec3 offset = {x[0] / scale, x[1] / scale, x[2] / scale};
    on_plane(body, plane, normal, h, offset, contact);
}

impact_contact imp_contact_swapped(impact_contact c)
{
    impact_contact s = c;
    s.normal = qvec3_neg(c.normal);
    s.point1 = c.point2, s.point2 = c.point1;
    s.offset1 = c.offset2, s.offset2 = c.offset1;
    return s;
}

double imp_gap_scale(const impact_solid *body1, const impact_solid *body2)
{
    return fmin(unit_scale(&body1->shape), unit_scale(&body2->shape));
}

void imp_gap_pair(const impact_solid *body1, quat q1, const impact_solid *body2, quat q2, double scale,
                  imp_gap_solids *pair)
{
    imp_form_make(&body2->shape, scale, q2, &pair->form[0]);
    imp_form_make(&body1->shape, scale, q1, &pair->form[1]);
    pair->form[0].rounding = pair->form[1].rounding = 0; /* of the cores */
    pair->size = 0;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++) pair->size = fmax(pair->size, pair->form[k].axis[i]);
    imp_gap_apart(qvec3_sub(body1->position, body2->position), scale, pair);
}

void imp_gap_apart(qvec3 c, double scale, imp_gap_solids *pair)
{
    pair->c[0] = c.x * scale, pair->c[1] = c.y * scale, pair->c[2] = c.z * scale;
    pair->reach = pair->size + sqrt(pair->c[0] * pair->c[0] + pair->c[1] * pair->c[1] + pair->c[2] * pair->c[2]);
}

qvec3 imp_gap_guess(const impact_solid *body1, const impact_solid *body2)
{
    imp_gap_solids pair;
    double n[3];
    imp_gap_pair(body1, body1->orientation, body2, body2->orientation, imp_gap_scale(body1, body2), &pair);
    imp_gap_seed(&pair, n);
    return (qvec3){n[0], n[1], n[2]};
}

void imp_gap_contact(const impact_solid *body1, const impact_solid *body2, double scale, const imp_gap_bracket *meeting,
                     impact_gap_path path, impact_contact *contact)
{
    const double back = 1 / scale;
    const qvec3 normal = {meeting->n[0], meeting->n[1], meeting->n[2]};
    const qvec3 offset1 = {meeting->x[1][0] * back, meeting->x[1][1] * back, meeting->x[1][2] * back};
    const qvec3 offset2 = {meeting->x[0][0] * back, meeting->x[0][1] * back, meeting->x[0][2] * back};
    closed_form(body1, body2, meeting->gap * back, normal, offset1, offset2, meeting->stiffness * back, contact);
    contact->path = path;
    contact->lower = meeting->lower * back, contact->upper = meeting->upper * back;
}

/* From the cores' contact to that of the bodies. */
static void put_balls(const impact_solid *body1, const impact_solid *body2, impact_contact *contact)
{
    const double r1 = body1->shape.rounding, r2 = body2->shape.rounding;
    if (r1 == 0 && r2 == 0) return;
    contact->gap -= r1 + r2, contact->lower -= r1 + r2, contact->upper -= r1 + r2;
    contact->offset1 = qvec3_axpy(-r1, contact->normal, contact->offset1);
    contact->offset2 = qvec3_axpy(r2, contact->normal, contact->offset2);
    contact->point1 = qvec3_add(body1->position, contact->offset1);
    contact->point2 = qvec3_add(body2->position, contact->offset2);
}

static impact_status smooth_pair(const impact_solid *body1, quat q1, const impact_solid *body2, quat q2,
                                 impact_gap_cache *cache, bool glance, impact_contact *contact)
{
    const double scale = imp_gap_scale(body1, body2);
    imp_gap_solids pair;
    imp_gap_pair(body1, q1, body2, q2, scale, &pair);
    imp_gap_bracket meeting;
    impact_gap_path path;
    const double cached[3] = {cache ? cache->normal.x : 0, cache ? cache->normal.y : 0, cache ? cache->normal.z : 0};
    const double *const seed = cache && cache->valid ? cached : NULL;
    impact_status status = IMPACT_OK;
    if (!glance)
        status = imp_gap_settle(&pair, seed, &meeting, &path);
    else if (!imp_gap_first(&pair, seed, &meeting, &path))
        return IMPACT_BRACKET;
    imp_gap_contact(body1, body2, scale, &meeting, path, contact);
    put_balls(body1, body2, contact);
    if (cache) *cache = (impact_gap_cache){true, contact->normal};
    return status;
}

/* Unit to rounding as it comes, in most calls. */
static bool unit_of(quat q, quat *unit)
{
    const double square = quat_dot(q, q);
    if (fabs(square - 1) <= IMP_UNIT_AS_IT_COMES) {
        *unit = q;
        return true;
    }
    return quat_normalize(q, unit) == QUAT_OK;
}

static bool finite_place(qvec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static impact_status check(const impact_solid *body, quat *unit)
{
    if (!unit_of(body->orientation, unit) || !finite_place(body->position)) return IMPACT_EDOMAIN;
    return impact_shape_check(&body->shape, NULL, 0);
}

impact_status imp_gap_check(const impact_solid *body1, quat *q1, const impact_solid *body2, quat *q2)
{
    impact_status status = check(body1, q1);
    if (status == IMPACT_OK) status = check(body2, q2);
    if (status != IMPACT_OK) return status;
    return body1->shape.kind == IMPACT_PLANE && body2->shape.kind == IMPACT_PLANE ? IMPACT_EARGUMENT : IMPACT_OK;
}

/* How bodies without a closed form are asked. */
typedef struct gap_question {
    bool glance; /* imp_gap_glance */
    double ccd;  /* libccd's tolerance; 0: not by libccd */
} gap_question;

static impact_status solve_pair(const impact_solid *body1, const impact_solid *body2, impact_gap_cache *cache,
                                gap_question question, impact_contact *contact)
{
    *contact = no_contact();
    quat q1, q2;
    const impact_status status = imp_gap_check(body1, &q1, body2, &q2);
    if (status != IMPACT_OK) return status;
    const bool plane1 = body1->shape.kind == IMPACT_PLANE, plane2 = body2->shape.kind == IMPACT_PLANE;
    if (body1->shape.kind == IMPACT_SPHERE && body2->shape.kind == IMPACT_SPHERE)
        return sphere_sphere(body1, body2, contact);
    if (plane2) {
        body_plane(body1, q1, body2, q2, contact);
        return IMPACT_OK;
    }
    if (plane1) {
        body_plane(body2, q2, body1, q1, contact);
        *contact = imp_contact_swapped(*contact);
        return IMPACT_OK;
    }
    if (imp_core_takes(&body1->shape, &body2->shape))
        return imp_core_contact(body1, q1, body2, q2, imp_gap_scale(body1, body2), cache, contact);
    if (question.ccd > 0) {
        const impact_status answered = imp_gap_by_ccd(body1, q1, body2, q2, question.ccd, contact);
        if (answered != IMPACT_EABSENT) put_balls(body1, body2, contact);
        return answered;
    }
    return smooth_pair(body1, q1, body2, q2, cache, question.glance, contact);
}

impact_status impact_gap(const impact_solid *body1, const impact_solid *body2, impact_gap_cache *cache,
                         impact_contact *contact)
{
    return solve_pair(body1, body2, cache, (gap_question){0}, contact);
}

impact_status imp_gap_glance(const impact_solid *body1, const impact_solid *body2, impact_gap_cache *cache,
                             impact_contact *contact)
{
    return solve_pair(body1, body2, cache, (gap_question){.glance = true}, contact);
}

impact_status impact_gap_ccd(const impact_solid *body1, const impact_solid *body2, double tolerance,
                             impact_contact *contact)
{
    *contact = no_contact();
    if (!(tolerance >= IMP_LEAST_CCD && tolerance <= IMP_MOST_CCD)) return IMPACT_EARGUMENT;
    return solve_pair(body1, body2, NULL, (gap_question){.ccd = tolerance}, contact);
}

double impact_gap_rate(const impact_contact *contact, qvec3 velocity1, qvec3 omega1, qvec3 velocity2, qvec3 omega2)
{
    const qvec3 u1 = qvec3_add(velocity1, qvec3_cross(omega1, contact->offset1));
    const qvec3 u2 = qvec3_add(velocity2, qvec3_cross(omega2, contact->offset2));
    return qvec3_dot(contact->normal, qvec3_sub(u1, u2));
}
