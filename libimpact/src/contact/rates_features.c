/* SPDX-License-Identifier: MIT
 *
 * The one point of two bodies of which one has faces. With m the outward normal a place of a surface moves by
 * r' = w x r + W (m' - w x m) + l e: W the curvature of the feature it is on (0 of a corner, radius times distance from
 * the axis over that of the normal round a rim), e along an edge or side line, on which it goes at a rate l of its own
 * and to which n stays at right angles. On a face n' is the face's, and the place goes as the other body has it.
 *
 *     both stay together across n:   u + W1 (w1 x n) + W2 (w2 x n) + l1 e1 - l2 e2 = (W1 + W2) n'
 *     an edge                        n'.e = (w x n).e
 */
#include "contact/rates.h"
#include "contact/points.h"
#include "contact/held_system.h"

#include <impact/face.h>

/* One body at the contact, in the world. */
typedef struct side {
    const imp_body *body;
    const imp_state *state;
    qvec3 outward, arm, omega, velocity, turns; /* turns: omega x n */
    int dimension;                              /* of what is straight there: 0, 1 along e, 2 */
    qvec3 e;
} side;

static bool is_turned(const imp_body *body)
{
    return body->shape.kind == IMPACT_CYLINDER || body->shape.kind == IMPACT_CONE;
}

static side side_of(const imp_body *body, const imp_state *state, qvec3 outward, qvec3 arm, qvec3 n)
{
    side s = {.body = body, .state = state, .outward = outward, .arm = arm};
    if (!body->is_static) s.omega = imp_omega(body, state), s.velocity = state->v;
    s.turns = qvec3_cross(s.omega, n);
    if (!imp_has_faces(body)) return s;
    const quat axes = imp_shape_axes(body, state);
    impact_face face;
    const int dimension =
        impact_shape_face(&body->shape, quat_rotate_inverse(axes, outward), IMP_TOUCHING * body->radius, &face);
    s.dimension = dimension > 0 ? dimension : 0;
    if (s.dimension == 1) {
        const qvec3 along = quat_rotate(axes, qvec3_sub(face.point[1], face.point[0]));
        s.e = qvec3_scale(along, 1 / qvec3_norm(along));
    }
    return s;
}

/* W v: of a turned core the circle through the place, and the ball about it. */
static qvec3 feature_bend(const side *s, qvec3 v)
{
    const impact_shape *shape = &s->body->shape;
    if (!imp_has_faces(s->body)) return imp_surface_bend(s->body, s->state, s->outward, v);
    qvec3 out = qvec3_scale(qvec3_axpy(-qvec3_dot(v, s->outward), s->outward, v), shape->rounding);
    if (!is_turned(s->body) || s->dimension == 2) return out;
    const qvec3 axis = quat_rotate(imp_shape_axes(s->body, s->state), (qvec3){0, 0, 1}),
                place =
                    qvec3_axpy(-shape->rounding, s->outward, qvec3_sub(s->arm, imp_shape_offset(s->body, s->state))),
                spoke = qvec3_axpy(-qvec3_dot(place, axis), axis, place),
                across = qvec3_axpy(-qvec3_dot(s->outward, axis), axis, s->outward);
    const double radius = qvec3_norm(spoke), lean = qvec3_norm(across);
    if (!(radius > 0) || !(lean > 0)) return out;
    const qvec3 round = qvec3_cross(axis, qvec3_scale(spoke, 1 / radius));
    return qvec3_axpy(qvec3_dot(round, v) * radius / lean, round, out);
}

/* The vector across n that has these parts along two others. */
static qvec3 with_parts(qvec3 n, qvec3 p, double along_p, qvec3 q, double along_q)
{
    const double area = qvec3_dot(n, qvec3_cross(p, q));
    return qvec3_scale(qvec3_sub(qvec3_scale(qvec3_cross(q, n), along_p), qvec3_scale(qvec3_cross(p, n), along_q)),
                       1 / area);
}

/* (W1 + W2) v */
static qvec3 both_bend(const side s[2], qvec3 v) { return qvec3_add(feature_bend(&s[0], v), feature_bend(&s[1], v)); }

/* What (W1 + W2) n' is, but for places that go along edges. */
static qvec3 wanted_bend(const side s[2], qvec3 n)
{
    const qvec3 one = qvec3_add(s[0].velocity, qvec3_cross(s[0].omega, s[0].arm)),
                two = qvec3_add(s[1].velocity, qvec3_cross(s[1].omega, s[1].arm)), u = qvec3_sub(one, two),
                slip = qvec3_axpy(-qvec3_dot(u, n), n, u);
    return qvec3_add(slip, qvec3_add(feature_bend(&s[0], s[0].turns), feature_bend(&s[1], s[1].turns)));
}

/* Where nothing bends (a corner on an edge) the normal is any between those beside it: it turns as the bodies do. */
static double turn_across(const side s[2], qvec3 n, qvec3 t, qvec3 rest)
{
    const double bend = qvec3_dot(t, both_bend(s, t));
    if (!(bend > IMP_TOUCHING * s[0].body->radius)) return 0.5 * qvec3_dot(t, qvec3_add(s[0].turns, s[1].turns));
    return qvec3_dot(t, qvec3_sub(wanted_bend(s, n), both_bend(s, rest))) / bend;
}

/* How far two lines cross, sin of the angle; 0 where they do not, or lie on each other. */
static double crossing_of(const side s[2], bool joined, qvec3 n)
{
    if (joined || s[0].dimension != 1 || s[1].dimension != 1) return 0;
    const double crossing = qvec3_dot(n, qvec3_cross(s[0].e, s[1].e));
    return fabs(crossing) > IMP_LEVEL ? crossing : 0;
}

static qvec3 normal_rate(const side s[2], bool joined, qvec3 n)
{
    for (int k = 1; k >= 0; k--)
        if (s[k].dimension == 2) return s[k].turns;
    if (crossing_of(s, joined, n) != 0)
        return with_parts(n, s[0].e, qvec3_dot(s[0].e, s[0].turns), s[1].e, qvec3_dot(s[1].e, s[1].turns));
    for (int k = 0; k < 2; k++) {
        if (s[k].dimension == 0) continue;
        const qvec3 t = qvec3_cross(n, s[k].e), rest = qvec3_scale(s[k].e, qvec3_dot(s[k].e, s[k].turns));
        return qvec3_axpy(turn_across(s, n, t, rest), t, rest);
    }
    const qvec3 t1 = imp_tangent(n), t2 = qvec3_cross(n, t1), c1 = both_bend(s, t1), c2 = both_bend(s, t2),
                wanted = wanted_bend(s, n);
    if (!(fabs(qvec3_dot(n, qvec3_cross(c1, c2))) > IMP_TOUCHING * qvec3_norm(c1) * qvec3_norm(c2)))
        return qvec3_scale(qvec3_add(s[0].turns, s[1].turns), 0.5);
    return with_parts(n, c1, qvec3_dot(t1, wanted), c2, qvec3_dot(t2, wanted)); /* the matrix is symmetric */
}

imp_rates imp_feature_rates(const imp_world *world, const imp_pair *pair, bool joined, const impact_contact *contact,
                            const imp_state *states)
{
    const qvec3 n = contact->normal;
    const side s[2] = {side_of(&world->bodies[pair->body1], &states[pair->body1], qvec3_neg(n), contact->offset1, n),
                       side_of(&world->bodies[pair->body2], &states[pair->body2], n, contact->offset2, n)};
    const qvec3 apart = qvec3_sub(s[0].velocity, s[1].velocity);
    imp_rates rates = {.normal = normal_rate(s, joined, n)};
    const qvec3 own1 = qvec3_add(qvec3_cross(s[0].omega, s[0].arm),
                                 feature_bend(&s[0], qvec3_sub(s[0].turns, rates.normal))),
                own2 = qvec3_add(qvec3_cross(s[1].omega, s[1].arm),
                                 feature_bend(&s[1], qvec3_sub(rates.normal, s[1].turns)));
    if (s[0].dimension > 0 && s[1].dimension < s[0].dimension) {
        rates.arm2 = own2, rates.arm1 = qvec3_sub(own2, apart);
        return rates;
    }
    rates.arm1 = own1;
    const double crossing = crossing_of(s, joined, n);
    if (crossing != 0) {
        const qvec3 aside = qvec3_cross(s[1].e, n), off = qvec3_sub(qvec3_sub(own2, apart), own1);
        rates.arm1 = qvec3_axpy(qvec3_dot(off, aside) / crossing, s[0].e, own1);
    }
    rates.arm2 = qvec3_add(rates.arm1, apart);
    return rates;
}
