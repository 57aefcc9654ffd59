/* SPDX-License-Identifier: MIT */
#include "world/normal.h"
#include "base/tolerances.h"
#include "shape/solid.h"

#include <impact/face.h>

/* How many faces the body has, and the normal of each, in the shape's axes: those of what has edges beside them. */
static int own_faces(const impact_shape *shape)
{
    switch (shape->kind) {
    case IMPACT_BOX:
    case IMPACT_POLYHEDRON: return imp_core_hull(shape)->face_count;
    case IMPACT_CYLINDER: return 2;
    case IMPACT_CONE: return 1;
    default: return 0;
    }
}

static qvec3 outward_normal(const impact_shape *shape, int face)
{
    if (shape->kind == IMPACT_CYLINDER || shape->kind == IMPACT_CONE) return (qvec3){0, 0, face == 0 ? -1 : 1};
    imp_form form;
    double n[3];
    imp_form_make(shape, 1, quat_identity(), &form);
    imp_core_normal(&form.core, face, n);
    return (qvec3){n[0], n[1], n[2]};
}

/* A direction, from body 2 to body 1: how far it separates them, how fast more, and where they reach farthest. */
typedef struct parting {
    double gap, rate;
    qvec3 offset[2];
} parting;

static qvec3 nearest_on_segment(qvec3 a, qvec3 b, qvec3 p)
{
    const qvec3 along = qvec3_sub(b, a);
    const double length2 = qvec3_dot(along, along), s = qvec3_dot(qvec3_sub(p, a), along);
    return length2 > 0 ? qvec3_axpy(fmin(fmax(s / length2, 0), 1), along, a) : a;
}

/* How far the body reaches along d, and where: with an edge or a face, nearest to where it touches. */
static double reach(const imp_body *body, const imp_state *state, qvec3 d, qvec3 touches, qvec3 towards, qvec3 *place)
{
    const quat axes = imp_shape_axes(body, state);
    const qvec3 own = quat_rotate_inverse(axes, d), shift = imp_shape_offset(body, state);
    qvec3 farthest;
    const double h = impact_shape_support(&body->shape, own, &farthest) + qvec3_dot(d, shift);
    *place = qvec3_add(shift, quat_rotate(axes, farthest));
    impact_face face;
    const int dimension = impact_shape_face(&body->shape, own, IMP_ROUNDOFF * body->radius, &face);
    if (dimension == 1)
        *place = nearest_on_segment(qvec3_add(shift, quat_rotate(axes, face.point[0])),
                                    qvec3_add(shift, quat_rotate(axes, face.point[1])), touches);
    if (dimension == 2) *place = qvec3_axpy(body->shape.rounding, qvec3_sub(d, towards), touches);
    return h;
}

static parting parting_along(const imp_body *const body[2], const imp_state *const state[2],
                             const impact_contact *contact, qvec3 n)
{
    const qvec3 touches[2] = {contact->offset1, contact->offset2};
    parting p = {.gap = qvec3_dot(n, qvec3_sub(state[0]->x, state[1]->x))};
    for (int k = 0; k < 2; k++) {
        const double side = k == 0 ? -1 : 1;
        const qvec3 towards = qvec3_scale(contact->normal, side);
        p.gap -= reach(body[k], state[k], qvec3_scale(n, side), touches[k], towards, &p.offset[k]);
        if (body[k]->is_static) continue; /* a belt moves, and its surface stays */
        const qvec3 v = qvec3_add(state[k]->v, qvec3_cross(imp_omega(body[k], state[k]), p.offset[k]));
        p.rate -= side * qvec3_dot(n, v);
    }
    return p;
}

void imp_settle_normal(const imp_body *body1, const imp_state *state1, const imp_body *body2, const imp_state *state2,
                       double within, impact_contact *contact)
{
    const imp_body *const body[2] = {body1, body2};
    const imp_state *const state[2] = {state1, state2};
    const int faces[2] = {own_faces(&body1->shape), own_faces(&body2->shape)};
    if (faces[0] + faces[1] == 0 || !(fabs(contact->gap) <= within)) return;
    const impact_contact found = *contact;
    double slowest = parting_along(body, state, &found, found.normal).rate;
    for (int k = 0; k < 2; k++)
        for (int f = 0; f < faces[k] && slowest < 0; f++) {
            const qvec3 out = quat_rotate(imp_shape_axes(body[k], state[k]), outward_normal(&body[k]->shape, f)),
                        n = k == 0 ? qvec3_neg(out) : out;
            const parting p = parting_along(body, state, &found, n);
            if (!(p.rate > slowest && p.gap >= -within)) continue;
            slowest = p.rate;
            contact->normal = n;
            contact->gap = contact->lower = contact->upper = p.gap;
            contact->offset1 = p.offset[0], contact->offset2 = p.offset[1];
        }
}

double imp_stepped_flush(const imp_body *body1, const imp_body *body2)
{
    const double radius1 = body1->is_static ? INFINITY : body1->radius,
                 radius2 = body2->is_static ? INFINITY : body2->radius;
    return IMP_PILE_SLACK * fmin(radius1, radius2);
}
