/* SPDX-License-Identifier: MIT */
#include "world/corner.h"
#include "shape/ridge.h"
#include "shape/solid.h"
#include "world/world_gap.h"

/* What of a core can stand on a plane alone: a corner, or the lowest place of a rim. */
typedef struct corner_place {
    qvec3 at;     /* of the core, body axes of the shape, m */
    double rim;   /* m: the radius of the rim, 0 of a corner */
    qvec3 along;  /* of a rim: from its centre, unit */
    double slope; /* of a rim: its tilt, |along| before it was made a unit */
} corner_place;

int imp_corner_count(const imp_body *body)
{
    switch (body->shape.kind) {
    case IMPACT_BOX:
    case IMPACT_CAPSULE:
    case IMPACT_POLYHEDRON: return imp_core_hull(&body->shape)->vertex_count;
    case IMPACT_CYLINDER:
    case IMPACT_CONE: return 2;
    case IMPACT_SPHERE: return 1;
    default: return imp_ridge_count(&body->shape);
    }
}

int imp_corner_number(const imp_body *body, impact_feature feature)
{
    const int count = imp_corner_count(body);
    const bool counts = feature.index >= 0 && feature.index < count;
    if (body->shape.kind == IMPACT_SPHERE) return 1;
    if (imp_ridge_count(&body->shape) > 0)
        return counts && (feature.kind == IMPACT_EDGE || feature.kind == IMPACT_VERTEX) ? feature.index + 1 : 0;
    if (body->shape.kind == IMPACT_CONE) return feature.kind == IMPACT_RIM ? 1 : feature.kind == IMPACT_VERTEX ? 2 : 0;
    const impact_feature_kind kind = body->shape.kind == IMPACT_CYLINDER ? IMPACT_RIM : IMPACT_VERTEX;
    return feature.kind == kind && counts ? feature.index + 1 : 0;
}

/* A form and its lowest places, where the plane's normal is `up` in the shape's axes. */
static corner_place rim_place(double radius, double z, qvec3 up)
{
    const double slope = hypot(up.x, up.y);
    const qvec3 along = slope > 0 ? (qvec3){-up.x / slope, -up.y / slope, 0} : (qvec3){1, 0, 0};
    return (corner_place){{radius * along.x, radius * along.y, z}, radius, along, slope};
}

/* `end` of a superquadric's arcs. */
static corner_place place_of(const imp_form *form, qvec3 up, int i, double end)
{
    const double R = form->axis[0], H = form->axis[2];
    if (form->kind == IMP_FORM_CYLINDER) return rim_place(R, i == 0 ? -H : H, up);
    if (form->kind == IMP_FORM_CONE && i == 0) return rim_place(R, form->base, up);
    if (form->kind == IMP_FORM_CONE) return (corner_place){.at = {0, 0, form->base + H}};
    if (form->kind == IMP_FORM_QUADRIC && form->round) return (corner_place){.at = {0, 0, 0}};
    if (form->kind == IMP_FORM_QUADRIC) return (corner_place){.at = imp_ridge_place(form, i, qvec3_neg(up), end)};
    double c[3];
    imp_core_vertex(&form->core, i, c);
    return (corner_place){.at = {c[0], c[1], c[2]}};
}

/* The face of a body with a core that a corner is on, from its shape's centre and in its axes. */
static qvec3 face_normal(const imp_form *form, int face)
{
    double n[3];
    imp_core_normal(&form->core, face, n);
    return (qvec3){n[0], n[1], n[2]};
}

static double face_height(const imp_form *form, int face, qvec3 n)
{
    return imp_core_height(&form->core, face, (double[]){n.x, n.y, n.z}) + form->rounding;
}

int imp_corner_faces(const imp_body *body)
{
    const impact_shape_kind kind = body->shape.kind;
    const bool flat = kind == IMPACT_BOX || kind == IMPACT_POLYHEDRON;
    return body->is_static && flat ? imp_core_hull(&body->shape)->face_count : 0;
}

/* The body as what it stands on sees it. */
typedef struct corner_view {
    imp_form form;
    quat axes;        /* of the shape */
    qvec3 centre;     /* of the shape, from the centre of mass, world */
    qvec3 normal, up; /* of what it stands on: world; the shape's axes */
    qvec3 apart;      /* from the other's centre of mass to this one's */
    double level;     /* m: how high along the normal that face is over its centre of mass */
} corner_view;

static void look_at_corner(const imp_world *world, const imp_pair *pair, const imp_state *states, corner_view *v)
{
    const imp_body *body = &world->bodies[pair->body1], *under = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    v->axes = imp_shape_axes(body, s1);
    v->centre = imp_shape_offset(body, s1);
    v->normal = quat_rotate(s2->q, (qvec3){0, 0, 1});
    v->apart = qvec3_sub(s1->x, s2->x);
    v->level = 0;
    if (pair->site.face > 0) {
        imp_form below;
        imp_form_make(&under->shape, 1, quat_identity(), &below);
        const qvec3 n = face_normal(&below, pair->site.face - 1);
        v->normal = quat_rotate(imp_shape_axes(under, s2), n);
        v->level = face_height(&below, pair->site.face - 1, n) + qvec3_dot(v->normal, imp_shape_offset(under, s2));
    }
    v->up = quat_rotate_inverse(v->axes, v->normal);
    imp_form_make(&body->shape, 1, quat_identity(), &v->form);
    if (body->shape.kind == IMPACT_SPHERE) v->form.rounding = body->shape.a; /* its centre, and a ball about it */
}

static qvec3 from_centre(const corner_view *v, qvec3 at) { return qvec3_add(v->centre, quat_rotate(v->axes, at)); }

static double height_of(const corner_view *v, qvec3 at)
{
    return qvec3_dot(v->normal, qvec3_add(v->apart, from_centre(v, at))) - v->form.rounding - v->level;
}

/* How the normal turns as the body sees it. */
static qvec3 up_rate(const imp_world *world, const imp_pair *pair, const imp_state *states, const corner_view *v)
{
    const qvec3 omega = imp_omega(&world->bodies[pair->body1], &states[pair->body1]);
    return qvec3_cross(v->up, quat_rotate_inverse(v->axes, omega));
}

int imp_corner_ahead(const imp_world *world, const imp_pair *pair, const imp_state *states, int corner)
{
    if (corner == 0 || imp_ridge_count(&world->bodies[pair->body1].shape) == 0) return corner;
    corner_view v;
    look_at_corner(world, pair, states, &v);
    const qvec3 rate = up_rate(world, pair, states, &v);
    return 1 + imp_ridge_ahead(&v.form, corner - 1, qvec3_neg(v.up), qvec3_neg(rate),
                               imp_world_touching_distance(world, pair, states));
}

/* The place of the pair's corner. A rim's stays on the side where it stood while that comes down: it passes flat with
 * the other side below the plane, as a corner would that lands, its slope < 0 from there, and does not change over on
 * the way, nor where its tilt is but roundings. */
static corner_place own_place(const imp_world *world, const imp_pair *pair, const imp_state *states,
                              const corner_view *v)
{
    corner_place place = place_of(&v->form, v->up, pair->site.corner - 1, IMP_RIDGE_BEYOND);
    const qvec3 side = pair->site.side;
    if (!(place.rim > 0) || (side.x == 0 && side.y == 0)) return place;
    if (2 * place.rim * place.slope <= imp_world_touching_distance(world, pair, states)) {
        place.along = side;
        place.slope = 0;
    }
    if (qvec3_dot(place.along, side) < 0) place.along = qvec3_neg(place.along), place.slope = -place.slope;
    place.at.x = place.rim * place.along.x, place.at.y = place.rim * place.along.y;
    return place;
}

/* How the place moves in the shape's axes, where the normal turns in them. */
static qvec3 place_rate(const imp_form *form, const corner_place *place, int i, qvec3 up, qvec3 rate)
{
    if (form->kind == IMP_FORM_QUADRIC && !form->round)
        return imp_ridge_rate(form, i, qvec3_neg(up), qvec3_neg(rate), IMP_RIDGE_BEYOND);
    if (!(place->rim > 0 && place->slope != 0)) return (qvec3){0, 0, 0};
    const qvec3 e = place->along, turn = {-rate.x / place->slope, -rate.y / place->slope, 0};
    return qvec3_scale(qvec3_axpy(-qvec3_dot(e, turn), e, turn), place->rim);
}

impact_contact imp_corner_contact(const imp_world *world, const imp_pair *pair, const imp_state *states, qvec3 *rate)
{
    corner_view v;
    look_at_corner(world, pair, states, &v);
    const corner_place place = own_place(world, pair, states, &v);
    const qvec3 corner = from_centre(&v, place.at);
    impact_contact contact = {.normal = v.normal, .offset1 = qvec3_axpy(-v.form.rounding, v.normal, corner)};
    contact.offset2 = qvec3_add(v.apart, contact.offset1);
    contact.gap = qvec3_dot(contact.normal, contact.offset2) - v.level;
    contact.offset2 = qvec3_axpy(-contact.gap, contact.normal, contact.offset2);
    if (!rate) return contact;
    const qvec3 omega = imp_omega(&world->bodies[pair->body1], &states[pair->body1]),
                runs = place_rate(&v.form, &place, pair->site.corner - 1, v.up, up_rate(world, pair, states, &v));
    *rate = qvec3_add(qvec3_cross(omega, corner), quat_rotate(v.axes, runs));
    return contact;
}

bool imp_corner_is_held(const imp_world *world, const imp_pair *pair, int corner)
{
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *other = &world->pairs[p];
        const bool is_it = corner > 0 ? other->site.corner == corner : other->site.corner > 0;
        if (is_it && imp_is_held(other) && imp_same_bodies(other, pair)) return true;
    }
    return false;
}

/* m: how far a place (from the body's centre of mass, world) is within the border of the face, along it. */
static double within_border(const imp_body *body, const imp_state *state, int face, qvec3 place)
{
    imp_form form;
    imp_form_make(&body->shape, 1, quat_identity(), &form);
    const impact_hull *hull = form.core.hull;
    const qvec3 n = face_normal(&form, face),
                p = quat_rotate_inverse(imp_shape_axes(body, state), qvec3_sub(place, imp_shape_offset(body, state)));
    const int first = hull->start[face], end = hull->start[face + 1];
    double least = INFINITY;
    for (int i = first; i < end; i++) {
        double x[3], y[3];
        imp_core_vertex(&form.core, hull->loop[i], x);
        imp_core_vertex(&form.core, hull->loop[i + 1 < end ? i + 1 : first], y);
        const qvec3 from = {x[0], x[1], x[2]}, along = {y[0] - x[0], y[1] - x[1], y[2] - x[2]};
        const double across = qvec3_dot(qvec3_cross(n, along), qvec3_sub(p, from));
        least = fmin(least, across / qvec3_norm(along));
    }
    return least;
}

int imp_corner_face_under(const imp_body *body, const imp_state *state, const impact_contact *contact, double within)
{
    const int count = imp_corner_faces(body);
    imp_form form;
    if (count > 0) imp_form_make(&body->shape, 1, quat_identity(), &form);
    for (int f = 0; f < count; f++) {
        const qvec3 n = quat_rotate(imp_shape_axes(body, state), face_normal(&form, f));
        /* the contact of an edge has a foot there, too, but a normal of its own */
        if (qvec3_norm(qvec3_sub(n, contact->normal)) > within) continue;
        if (within_border(body, state, f, contact->offset2) > 0) return f + 1;
    }
    return 0;
}

/* Edges that meet in an apex have their places there together. */
static bool is_same(qvec3 a, qvec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

qvec3 imp_corner_across(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    corner_view v;
    look_at_corner(world, pair, states, &v);
    const corner_place place = place_of(&v.form, v.up, pair->site.corner - 1, IMP_RIDGE_BEYOND);
    return quat_rotate(v.axes, qvec3_scale(place.along, -2 * place.rim));
}

qvec3 imp_corner_side(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    corner_view v;
    look_at_corner(world, pair, states, &v);
    const corner_place place = place_of(&v.form, v.up, pair->site.corner - 1, IMP_RIDGE_BEYOND);
    return 2 * place.rim * place.slope > imp_world_touching_distance(world, pair, states) ? place.along
                                                                                          : (qvec3){0, 0, 0};
}

double imp_corner_clearance(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    const int count = imp_corner_count(&world->bodies[pair->body1]);
    corner_view v;
    look_at_corner(world, pair, states, &v);
    const corner_place own = own_place(world, pair, states, &v);
    double least = INFINITY;
    if (pair->site.face > 0)
        least = within_border(&world->bodies[pair->body2], &states[pair->body2], pair->site.face - 1,
                              imp_corner_contact(world, pair, states, NULL).offset2);
    if (v.form.kind == IMP_FORM_QUADRIC && !v.form.round)
        least = fmin(least, imp_ridge_room(&v.form, pair->site.corner - 1, qvec3_neg(v.up)));
    if (own.rim > 0) least = fmin(least, 2 * own.rim * own.slope); /* of other rims that are held their pairs tell */
    for (int i = 0; i < count; i++) {
        const corner_place place = place_of(&v.form, v.up, i, IMP_RIDGE_END);
        if (imp_corner_is_held(world, pair, i + 1) || is_same(place.at, own.at)) continue;
        least = fmin(least, height_of(&v, place.at));
    }
    return least;
}

double imp_corner_lowest(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    const int count = imp_corner_count(&world->bodies[pair->body1]);
    corner_view v;
    look_at_corner(world, pair, states, &v);
    double least = INFINITY;
    for (int i = 0; i < count; i++) least = fmin(least, height_of(&v, place_of(&v.form, v.up, i, IMP_RIDGE_END).at));
    return least;
}
