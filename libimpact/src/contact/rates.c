/* SPDX-License-Identifier: MIT
 *
 * On each surface the point of outward normal m moves by r' = w x r + W (m' - w x m), W the Hessian of its support
 * function. That both points stay together gives, with n = m2 = -m1 and u the relative velocity,
 *
 *     both round        (W1 + W2) n' = u + W1 (w1 x n) + W2 (w2 x n)
 *     a face of body 2  n' = w2 x n (W2 is infinite); where body 1 lies flat on it W1 = 0: each point stays on it
 *
 * and, whatever n' is, (n . u)' = n . u' + n' . u along the contact.
 */
#include "contact/rates.h"
#include "contact/persist_system.h"
#include "contact/points.h"
#include "world/world_gap.h"

/* Where an exponent is over 2 the surface is flat along its axis at 0: there the radius of curvature stands for its
 * neighbourhood's. */
static double off_zero(double component) { return copysign(fmax(fabs(component), IMP_OFF_FLAT), component); }

qvec3 imp_surface_bend(const imp_body *body, const imp_state *state, qvec3 outward, qvec3 v)
{
    if (body->shape.kind == IMPACT_SPHERE)
        return qvec3_scale(qvec3_axpy(-qvec3_dot(v, outward), outward, v), body->shape.a);
    const quat q = imp_shape_axes(body, state);
    const qvec3 d = quat_rotate_inverse(q, outward);
    const qmat3 h = impact_shape_support_hessian(&body->shape, (qvec3){off_zero(d.x), off_zero(d.y), off_zero(d.z)});
    const qvec3 b = quat_rotate_inverse(q, v);
    return quat_rotate(q, (qvec3){h.m[0][0] * b.x + h.m[0][1] * b.y + h.m[0][2] * b.z,
                                  h.m[1][0] * b.x + h.m[1][1] * b.y + h.m[1][2] * b.z,
                                  h.m[2][0] * b.x + h.m[2][1] * b.y + h.m[2][2] * b.z});
}

static qvec3 body_turning(const imp_body *body, const imp_state *state)
{
    return body->is_static ? body->spin : imp_omega(body, state);
}

static qvec3 velocity_of(const imp_body *body, const imp_state *state)
{
    return body->is_static ? (qvec3){0, 0, 0} : state->v;
}

/* A plane's normal stays. */
static imp_rates round_rates(const imp_world *world, const imp_pair *pair, const impact_contact *contact,
                             const imp_state *states)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const qvec3 n = contact->normal, out1 = qvec3_neg(n), w1 = imp_omega(b1, s1), turn1 = qvec3_cross(w1, n);
    imp_rates rates = {.normal = {0, 0, 0}};
    if (b2->shape.kind != IMPACT_PLANE) {
        const qvec3 u = qvec3_sub(imp_point_velocity(b1, s1, contact->offset1),
                                  imp_point_velocity(b2, s2, contact->offset2)),
                    slip = qvec3_axpy(-qvec3_dot(u, n), n, u), w2 = body_turning(b2, s2), turn2 = qvec3_cross(w2, n);
        const qvec3 t1 = imp_tangent(n), t2 = qvec3_cross(n, t1);
        const qvec3 c1 = qvec3_add(imp_surface_bend(b1, s1, out1, t1), imp_surface_bend(b2, s2, n, t1));
        const qvec3 c2 = qvec3_add(imp_surface_bend(b1, s1, out1, t2), imp_surface_bend(b2, s2, n, t2));
        const qvec3 moves =
            qvec3_add(slip, qvec3_add(imp_surface_bend(b1, s1, out1, turn1), imp_surface_bend(b2, s2, n, turn2)));
        const double a = qvec3_dot(t1, c1), b = qvec3_dot(t1, c2), d = qvec3_dot(t2, c2), determinant = a * d - b * b;
        const double x = qvec3_dot(t1, moves), y = qvec3_dot(t2, moves);
        rates.normal = qvec3_axpy((d * x - b * y) / determinant, t1, qvec3_scale(t2, (a * y - b * x) / determinant));
        rates.arm2 =
            qvec3_add(qvec3_cross(w2, contact->offset2), imp_surface_bend(b2, s2, n, qvec3_sub(rates.normal, turn2)));
    }
    rates.arm1 =
        qvec3_add(qvec3_cross(w1, contact->offset1), imp_surface_bend(b1, s1, out1, qvec3_sub(turn1, rates.normal)));
    return rates;
}

/* W of a side line, or of what is rounded, as the bearer's normal turns on it; 0 where the body lies flat: there its
 * radius of curvature is none. */
static qvec3 roll(const imp_body *body, const imp_state *state, qvec3 outward, qvec3 turn)
{
    const double size = qvec3_norm(turn);
    const qvec3 along =
        size > 0 ? imp_surface_bend(body, state, outward, qvec3_scale(turn, 1 / size)) : (qvec3){0, 0, 0};
    return qvec3_norm(along) <= 2 * body->radius ? qvec3_scale(along, size) : (qvec3){0, 0, 0};
}

/* Of one point of several the normal goes with the face, and the point with the other body's corner, or along its side
 * as that rolls. */
static imp_rates borne_rates(const imp_world *world, const imp_pair *pair, imp_bearer bearer,
                             const impact_contact *contact, const imp_state *states)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const qvec3 none = {0, 0, 0}, w1 = imp_omega(b1, s1), w2 = b2->is_static ? none : imp_omega(b2, s2),
                apart = qvec3_sub(s1->v, velocity_of(b2, s2));
    imp_rates rates;
    if (bearer == IMP_BORNE_BY_2) {
        rates.normal = qvec3_cross(w2, contact->normal);
        const qvec3 turn = qvec3_sub(qvec3_cross(w1, contact->normal), rates.normal);
        rates.arm1 = qvec3_add(qvec3_cross(w1, contact->offset1), roll(b1, s1, qvec3_neg(contact->normal), turn));
        rates.arm2 = qvec3_add(rates.arm1, apart);
    } else {
        rates.normal = qvec3_cross(w1, contact->normal);
        const qvec3 turn = qvec3_sub(rates.normal, qvec3_cross(w2, contact->normal));
        rates.arm2 = qvec3_add(qvec3_cross(w2, contact->offset2), roll(b2, s2, contact->normal, turn));
        rates.arm1 = qvec3_sub(rates.arm2, apart);
    }
    return rates;
}

imp_rates imp_contact_rates(imp_world *world, const imp_pair *pair, imp_bearer bearer, const impact_contact *contact,
                            const imp_state *states)
{
    if (bearer != IMP_BORNE_BY_BOTH) return borne_rates(world, pair, bearer, contact, states);
    const bool on_plane = world->bodies[pair->body2].shape.kind == IMPACT_PLANE;
    return on_plane || !imp_pair_has_faces(world, pair) ? round_rates(world, pair, contact, states)
                                                        : imp_feature_rates(world, pair, contact, states);
}

static qvec3 angular_acceleration(const imp_body *body, const imp_state *state, const imp_load *load)
{
    const qvec3 torque = qvec3_sub(load->torque, qvec3_cross(imp_omega(body, state), state->momentum));
    return imp_inverse_inertia(body, state->q, torque);
}

qvec3 imp_point_acceleration(const imp_body *body, const imp_state *state, const imp_load *load, qvec3 arm,
                             qvec3 arm_rate)
{
    if (body->is_static) return body->driven ? qvec3_cross(body->spin, arm_rate) : (qvec3){0, 0, 0};
    const qvec3 a = qvec3_scale(load->force, body->inverse_mass);
    return qvec3_add(qvec3_add(a, qvec3_cross(angular_acceleration(body, state, load), arm)),
                     qvec3_cross(imp_omega(body, state), arm_rate));
}

/* Along the axes, which turn as little as the normal lets them, of a vector and its rate. */
static void turn_along(const qvec3 axes[3], qvec3 normal_rate, qvec3 vector, qvec3 rate, double *along)
{
    along[0] = qvec3_dot(axes[0], rate) + qvec3_dot(normal_rate, vector);
    for (int k = 1; k < 3; k++)
        along[k] = qvec3_dot(axes[k], rate) - qvec3_dot(normal_rate, axes[k]) * qvec3_dot(axes[0], vector);
}

void imp_contact_bend(imp_world *world, const imp_pair *pair, imp_bearer bearer, const impact_contact *contact,
                      const qvec3 axes[3], const imp_state *states, double bend[6])
{
    const imp_body *body[2] = {&world->bodies[pair->body1], &world->bodies[pair->body2]};
    const imp_state *state[2] = {&states[pair->body1], &states[pair->body2]};
    const imp_load unloaded = {.work_rate = 0};
    const qvec3 arm[2] = {contact->offset1, contact->offset2};
    imp_rates rates = imp_contact_rates(world, pair, bearer, contact, states);
    if (body[1]->driven) rates.arm2 = qvec3_add(state[0]->v, rates.arm1); /* its centre stands still */
    const qvec3 arm_rate[2] = {rates.arm1, rates.arm2};
    qvec3 velocity[2], acceleration[2], turning[2], bending[2];
    for (int k = 0; k < 2; k++) {
        velocity[k] = imp_point_velocity(body[k], state[k], arm[k]);
        acceleration[k] = imp_point_acceleration(body[k], state[k], &unloaded, arm[k], arm_rate[k]);
        turning[k] = body_turning(body[k], state[k]);
        bending[k] = body[k]->is_static ? (qvec3){0, 0, 0} : angular_acceleration(body[k], state[k], &unloaded);
    }
    turn_along(axes, rates.normal, qvec3_sub(velocity[0], velocity[1]), qvec3_sub(acceleration[0], acceleration[1]),
               bend);
    turn_along(axes, rates.normal, qvec3_sub(turning[0], turning[1]), qvec3_sub(bending[0], bending[1]), bend + 3);
}
