/* SPDX-License-Identifier: MIT */
#include "world/normal.h"
#include "base/tolerances.h"
#include "shape/solid.h"

#include <impact/face.h>

/* The faces of what has edges beside them. */
typedef struct face_list {
    const impact_shape *shape;
    int count;
    imp_form form; /* of polytopes, in the shape's axes */
} face_list;

static int face_count(const impact_shape *shape)
{
    switch (shape->kind) {
    case IMPACT_BOX:
    case IMPACT_POLYHEDRON: return imp_core_hull(shape)->face_count;
    case IMPACT_CYLINDER: return 2;
    case IMPACT_CONE: return 1;
    default: return 0;
    }
}

static bool is_flat_sided(const impact_shape *shape)
{
    return shape->kind != IMPACT_CYLINDER && shape->kind != IMPACT_CONE;
}

static face_list faces_of(const impact_shape *shape)
{
    face_list list = {.shape = shape, .count = face_count(shape)};
    if (list.count > 0 && is_flat_sided(shape)) imp_form_make(shape, 1, quat_identity(), &list.form);
    return list;
}

/* Outward, in the shape's axes. */
static qvec3 normal_of_face(const face_list *list, int face)
{
    if (!is_flat_sided(list->shape)) return (qvec3){0, 0, face == 0 ? -1 : 1};
    double n[3];
    imp_core_normal(&list->form.core, face, n);
    return (qvec3){n[0], n[1], n[2]};
}

/* How far the shape reaches along the face's normal. */
static double height_of_face(const face_list *list, int face, qvec3 normal)
{
    qvec3 place;
    if (!is_flat_sided(list->shape)) return impact_shape_support(list->shape, normal, &place);
    const double n[3] = {normal.x, normal.y, normal.z};
    return imp_core_height(&list->form.core, face, n) + list->shape->rounding;
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
    const int dimension = impact_shape_face(&body->shape, own, IMP_TOUCHING * body->radius, &face);
    if (dimension == 1)
        *place = nearest_on_segment(qvec3_add(shift, quat_rotate(axes, face.point[0])),
                                    qvec3_add(shift, quat_rotate(axes, face.point[1])), touches);
    if (dimension == 2) *place = qvec3_axpy(body->shape.rounding, qvec3_sub(d, towards), touches);
    return h;
}

/* How far the direction separates them: most do not, and no place is asked for then. */
static double separated_by(const imp_body *const body[2], const imp_state *const state[2], qvec3 n)
{
    double gap = qvec3_dot(n, qvec3_sub(state[0]->x, state[1]->x));
    for (int k = 0; k < 2; k++) {
        const qvec3 d = k == 0 ? qvec3_neg(n) : n;
        qvec3 place;
        gap -=
            impact_shape_support(&body[k]->shape, quat_rotate_inverse(imp_shape_axes(body[k], state[k]), d), &place) +
            qvec3_dot(d, imp_shape_offset(body[k], state[k]));
    }
    return gap;
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

/* The direction in which `place` (world axes) on the body's surface is nearest to be left; false: it is farther off, or
 * deeper, than `within`. */
static bool leaves(const imp_body *body, const imp_state *state, qvec3 place, double within, qvec3 *normal)
{
    const qvec3 from = qvec3_sub(place, state->x);
    if (body->shape.kind == IMPACT_PLANE) {
        const qvec3 local = quat_rotate_inverse(state->q, from);
        *normal = quat_rotate(state->q, (qvec3){0, 0, 1});
        return fabs(local.z) <= within && fabs(local.x) <= body->shape.a && fabs(local.y) <= body->shape.b;
    }
    if (qvec3_norm(from) > body->radius + within) return false;
    impact_solid ball = {.position = place, .orientation = quat_identity()};
    const impact_solid solid = imp_solid_of(body, state);
    impact_contact contact;
    if (impact_shape_sphere(within, &ball.shape) != IMPACT_OK) return false;
    if (impact_gap(&ball, &solid, NULL, &contact) < 0) return false;
    *normal = contact.normal;
    return fabs(contact.gap + within) <= within;
}

/* Two bodies, and all static ones there are, with where they are (NULL: no others). */
typedef struct meeting {
    const imp_body *body[2];
    const imp_state *state[2];
    const imp_world *others;
    const imp_state *states;
} meeting;

/* Whether what goes along the direction away from that of the bodies that is static goes into another that is. */
static bool is_hidden(const meeting *m, const qvec3 offset[2], qvec3 n, double within)
{
    const int own = m->body[1]->is_static ? 1 : 0;
    if (!m->others || !m->body[own]->is_static) return false;
    const qvec3 place = qvec3_add(m->state[own]->x, offset[own]), out = own ? n : qvec3_neg(n);
    for (int i = 0; i < m->others->body_count; i++) {
        const imp_body *other = &m->others->bodies[i];
        qvec3 free;
        if (!other->is_static || other == m->body[own]) continue;
        if (!leaves(other, &m->states[i], place, within, &free)) continue;
        if (qvec3_dot(out, free) < -IMP_TOUCHING) return true;
    }
    return false;
}

/* A look for the normal along which bodies part fastest, of that found and those of faces. */
typedef struct settling {
    const meeting *m;
    impact_contact found;
    double within, fastest; /* NAN: what is found has not been looked at */
    int faces;              /* whose normals differ; the first two */
    qvec3 normal[2];
    int owner[2]; /* -1: a face of both bodies is there, flush */
} settling;

static double rate_found(const settling *s)
{
    const qvec3 touches[2] = {s->found.offset1, s->found.offset2};
    return is_hidden(s->m, touches, s->found.normal, s->within)
               ? -INFINITY
               : parting_along(s->m->body, s->m->state, &s->found, s->found.normal).rate;
}

static void take_normal(qvec3 n, const parting *p, impact_contact *contact)
{
    contact->normal = n;
    contact->gap = contact->lower = contact->upper = p->gap;
    contact->offset1 = p->offset[0], contact->offset2 = p->offset[1];
}

/* One that separates them, from body 2 to body 1. */
static void consider(settling *s, qvec3 n, impact_contact *contact)
{
    if (isnan(s->fastest)) s->fastest = rate_found(s);
    if (s->fastest >= 0) return;
    const parting p = parting_along(s->m->body, s->m->state, &s->found, n);
    if (!(p.rate > s->fastest && p.gap >= -s->within) || is_hidden(s->m, p.offset, n, s->within)) return;
    s->fastest = p.rate;
    take_normal(n, &p, contact);
}

static double smaller_radius(const settling *s) { return fmin(s->m->body[0]->radius, s->m->body[1]->radius); }

/* Turned by less than lifts the smaller body by `within`. */
static bool are_flush(const settling *s, qvec3 n1, qvec3 n2)
{
    return smaller_radius(s) * qvec3_norm(qvec3_sub(n1, n2)) <= s->within;
}

static void note_face(settling *s, int k, qvec3 n)
{
    for (int i = 0; i < s->faces && i < 2; i++)
        if (are_flush(s, n, s->normal[i])) {
            if (s->owner[i] != k) s->owner[i] = -1;
            return;
        }
    if (s->faces < 2) s->normal[s->faces] = n, s->owner[s->faces] = k;
    s->faces++;
}

/* Those of body k's faces. The other's place there lies under the plane of most: they separate nothing. One that is
 * the same as was found needs no look: along a bar's own face the floor, which it is flush with, reaches as much
 * farther as it is wider than the bar. */
static void consider_faces(settling *s, int k, impact_contact *contact)
{
    const imp_body *own = s->m->body[k];
    if (face_count(&own->shape) == 0) return;
    const imp_state *state = s->m->state[k], *others = s->m->state[1 - k];
    const face_list faces = faces_of(&own->shape);
    const quat axes = imp_shape_axes(own, state);
    const qvec3 touches = k == 0 ? s->found.offset2 : s->found.offset1,
                from = qvec3_sub(qvec3_sub(others->x, state->x), imp_shape_offset(own, state)),
                place = quat_rotate_inverse(axes, qvec3_add(from, touches));
    for (int f = 0; f < faces.count; f++) {
        const qvec3 local = normal_of_face(&faces, f);
        if (qvec3_dot(local, place) - height_of_face(&faces, f, local) < -s->within) continue;
        const qvec3 out = quat_rotate(axes, local), n = k == 0 ? qvec3_neg(out) : out;
        const bool same = are_flush(s, n, s->found.normal);
        if (!same && separated_by(s->m->body, s->m->state, n) < -s->within) continue;
        note_face(s, k, n);
        if (!same) consider(s, n, contact);
    }
}

/* m/s: how fast bodies part is known no better than a direction. */
static double rate_error(const settling *s)
{
    double speed = 0;
    for (int k = 0; k < 2; k++) {
        const imp_body *body = s->m->body[k];
        const imp_state *state = s->m->state[k];
        if (!body->is_static) speed += qvec3_norm(state->v) + body->radius * qvec3_norm(imp_omega(body, state));
    }
    return s->within / smaller_radius(s) * speed;
}

/* Two faces, of one body each: edges that lie along each other touch alike along all directions between. Of edges that
 * lie d beside each other these separate by d |n1 - n2| differently; so do, of all lengths, a face and an edge in it
 * that are nearly flush. */
static bool is_between(const settling *s)
{
    if (s->faces != 2 || s->owner[0] < 0 || s->owner[1] < 0) return false;
    double gap[2];
    for (int i = 0; i < 2; i++) {
        const parting p = parting_along(s->m->body, s->m->state, &s->found, s->normal[i]);
        if (is_hidden(s->m, p.offset, s->normal[i], s->within)) return false;
        gap[i] = p.gap;
    }
    return fabs(gap[0] - gap[1]) <= s->within * qvec3_norm(qvec3_sub(s->normal[0], s->normal[1]));
}

/* Where they part along both alike. How fast what is held by a step parts is known no better than that errs, and its
 * answer tells. */
static bool part_alike(const settling *s)
{
    if (s->within >= imp_stepped_flush(s->m->body[0], s->m->body[1])) return true;
    double rate[2];
    for (int i = 0; i < 2; i++) rate[i] = parting_along(s->m->body, s->m->state, &s->found, s->normal[i]).rate;
    return fabs(rate[0] - rate[1]) <= rate_error(s);
}

static void take_middle(const settling *s, impact_contact *contact)
{
    qvec3 n;
    if (qvec3_normalize(qvec3_add(s->normal[0], s->normal[1]), &n) != QUAT_OK) return;
    const parting p = parting_along(s->m->body, s->m->state, &s->found, n);
    if (p.gap >= -s->within) take_normal(n, &p, contact);
}

static void settle(const meeting *m, double within, impact_contact *contact)
{
    if (!(fabs(contact->gap) <= within)) return;
    settling s = {.m = m, .found = *contact, .within = within, .fastest = NAN};
    for (int k = 0; k < 2; k++) consider_faces(&s, k, contact);
    if (is_between(&s) && part_alike(&s)) take_middle(&s, contact);
}

static meeting meeting_among(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    return (meeting){.body = {&world->bodies[pair->body1], &world->bodies[pair->body2]},
                     .state = {&states[pair->body1], &states[pair->body2]},
                     .others = world,
                     .states = states};
}

void imp_settle_normal(const imp_body *body1, const imp_state *state1, const imp_body *body2, const imp_state *state2,
                       double within, impact_contact *contact)
{
    const meeting m = {.body = {body1, body2}, .state = {state1, state2}};
    settle(&m, within, contact);
}

void imp_settle_among(const imp_world *world, const imp_pair *pair, const imp_state *states, double within,
                      impact_contact *contact)
{
    const meeting m = meeting_among(world, pair, states);
    settle(&m, within, contact);
}

bool imp_edge_normals(const imp_world *world, const imp_pair *pair, const imp_state *states,
                      const impact_contact *contact, imp_edges *edges)
{
    const meeting m = meeting_among(world, pair, states);
    settling s = {.m = &m, .found = *contact, .within = imp_stepped_flush(m.body[0], m.body[1]), .fastest = NAN};
    impact_contact fastest = *contact;
    for (int k = 0; k < 2; k++) consider_faces(&s, k, &fastest);
    if (!is_between(&s)) return false;
    for (int i = 0; i < 2; i++) edges->normal[i] = s.normal[i], edges->owner[i] = s.owner[i];
    return true;
}

/* ---- a gap by a face ---- */

/* The body's face that looks most along d (shape's axes), or -1; its normal. */
static int face_along(const imp_body *body, qvec3 d, qvec3 *normal)
{
    const face_list faces = faces_of(&body->shape);
    int best = -1;
    double most = -INFINITY;
    for (int f = 0; f < faces.count; f++) {
        const qvec3 n = normal_of_face(&faces, f);
        const double along = qvec3_dot(n, d);
        if (along > most) most = along, best = f, *normal = n;
    }
    return best;
}

/* m: how far within the border of the face a place is, along it; < 0: beside it. */
static double within_face(const impact_face *face, qvec3 normal, qvec3 place)
{
    if (face->disc > 0) return face->disc - hypot(place.x, place.y);
    double least = INFINITY;
    for (int i = 0; i < face->count; i++) {
        const qvec3 from = face->point[i], along = qvec3_sub(face->point[(i + 1) % face->count], from);
        least = fmin(least, qvec3_dot(qvec3_cross(normal, along), qvec3_sub(place, from)) / qvec3_norm(along));
    }
    return least;
}

/* Outward from the side of a cylinder or cone at the place's azimuth, in the shape's axes. */
static qvec3 normal_of_side(const impact_shape *shape, qvec3 place)
{
    const double rho = hypot(place.x, place.y), radius = shape->a - shape->rounding,
                 height = shape->kind == IMPACT_CONE ? shape->c - 2 * shape->rounding : INFINITY, up = radius / height,
                 size = hypot(1, up);
    const qvec3 out = rho > 0 ? (qvec3){place.x / rho, place.y / rho, 0} : (qvec3){1, 0, 0};
    return (qvec3){out.x / size, out.y / size, up / size};
}

/* m: how deep a place lies under the planes of all faces but one and under the side: a ball of that radius about it is
 * within them. */
static double depth_beside(const impact_shape *shape, int own, qvec3 place)
{
    const face_list faces = faces_of(shape);
    double least = INFINITY;
    for (int f = 0; f < faces.count; f++) {
        const qvec3 n = normal_of_face(&faces, f);
        if (f != own) least = fmin(least, height_of_face(&faces, f, n) - qvec3_dot(n, place));
    }
    if (is_flat_sided(shape)) return least;
    qvec3 farthest;
    const qvec3 side = normal_of_side(shape, place);
    return fmin(least, impact_shape_support(shape, side, &farthest) - qvec3_dot(side, place));
}

/* Body k's face towards the other, and the other's place that is lowest over it. Where that is under the face, the ball
 * about it that touches the face is within the body: no direction is a nearer way out. */
static bool stands_on(const imp_body *const body[2], const imp_state *const state[2], int k, qvec3 towards,
                      impact_contact *contact)
{
    const imp_body *under = body[k], *above = body[1 - k];
    const quat axes = imp_shape_axes(under, state[k]), upper = imp_shape_axes(above, state[1 - k]);
    qvec3 normal, lowest;
    impact_face face;
    const int own_face = face_along(under, quat_rotate_inverse(axes, towards), &normal);
    if (own_face < 0) return false;
    if (impact_shape_face(&under->shape, normal, IMP_ROUNDOFF * under->radius, &face) != 2) return false;
    const qvec3 n = quat_rotate(axes, normal);
    impact_shape_support(&above->shape, quat_rotate_inverse(upper, qvec3_neg(n)), &lowest);
    const qvec3 own = qvec3_add(imp_shape_offset(above, state[1 - k]), quat_rotate(upper, lowest)),
                between = qvec3_sub(state[1 - k]->x, state[k]->x),
                place = qvec3_sub(qvec3_add(between, own), imp_shape_offset(under, state[k])),
                local = quat_rotate_inverse(axes, place);
    const double gap = qvec3_dot(normal, qvec3_sub(local, face.point[0]));
    if (!(within_face(&face, normal, local) >= fmax(0, -gap))) return false;
    if (gap < 0 && !(depth_beside(&under->shape, own_face, local) >= -gap)) return false;
    const qvec3 foot = qvec3_axpy(-gap, n, qvec3_add(between, own));
    *contact = (impact_contact){.gap = gap,
                                .lower = gap,
                                .upper = gap,
                                .stiffness = INFINITY,
                                .path = IMPACT_PATH_CLOSED_FORM,
                                .normal = k == 1 ? n : qvec3_neg(n),
                                .offset1 = k == 1 ? own : foot,
                                .offset2 = k == 1 ? foot : own};
    return true;
}

bool imp_face_gap(const imp_body *body1, const imp_state *state1, const imp_body *body2, const imp_state *state2,
                  qvec3 normal, impact_contact *contact)
{
    const imp_body *const body[2] = {body1, body2};
    const imp_state *const state[2] = {state1, state2};
    return stands_on(body, state, 1, normal, contact) || stands_on(body, state, 0, qvec3_neg(normal), contact);
}

double imp_stepped_flush(const imp_body *body1, const imp_body *body2)
{
    const double radius1 = body1->is_static ? INFINITY : body1->radius,
                 radius2 = body2->is_static ? INFINITY : body2->radius;
    return IMP_PILE_SLACK * IMP_DEFAULT_PILE_TOLERANCE * fmin(radius1, radius2);
}
