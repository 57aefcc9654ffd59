/* SPDX-License-Identifier: MIT
 *
 * On each surface the point of outward normal m moves by r' = w x r + W (m' - w x m), W the Hessian of its support
 * function. That both points stay together gives, with n = m2 = -m1 and u the relative velocity,
 *
 *     both round        (W1 + W2) n' = u + W1 (w1 x n) + W2 (w2 x n)
 *     body 2 flatter    (1 + W1 S2) z = u + W1 (w1 x n - w2 x n), n' = w2 x n + S2 z, z = W2 (n' - w2 x n)
 *     a face of body 2  n' = w2 x n (W2 is infinite); where body 1 lies flat on it W1 = 0: each point stays on it
 *
 * S2 = 1/W2 is how the normal turns along the surface. Where that is nearly flat the first equation takes z out of W2
 * times a difference: of a ball's bias on a face of exponent 50 it left 1e-3 wrong.
 *
 * and, whatever n' is, (n . u)' = n . u' + n' . u along the contact.
 */
#include "contact/rates.h"
#include "contact/held_system.h"
#include "contact/points.h"
#include "world/world_gap.h"

/* Where an exponent is over 2 the surface is flat along its axis at 0: there the radius of curvature stands for its
 * neighbourhood's. */
static double off_zero(double component) { return copysign(fmax(fabs(component), IMP_OFF_FLAT), component); }

/* W at one outward normal; of a ball its radius is all. */
typedef struct surface_curve {
    bool ball;
    double radius;
    quat axes;
    qmat3 hessian; /* in the body's axes */
    qvec3 outward;
} surface_curve;

static surface_curve surface_curve_of(const imp_body *body, const imp_state *state, qvec3 outward)
{
    surface_curve curve = {
        .ball = body->shape.kind == IMPACT_SPHERE, .radius = body->shape.a, .outward = outward, .axes = {1, 0, 0, 0}};
    if (curve.ball) return curve;
    curve.axes = imp_shape_axes(body, state);
    const qvec3 d = quat_rotate_inverse(curve.axes, outward);
    curve.hessian = impact_shape_support_hessian(&body->shape, (qvec3){off_zero(d.x), off_zero(d.y), off_zero(d.z)});
    return curve;
}

static qvec3 bend_of(const surface_curve *curve, qvec3 v)
{
    if (curve->ball) return qvec3_scale(qvec3_axpy(-qvec3_dot(v, curve->outward), curve->outward, v), curve->radius);
    const double(*h)[3] = curve->hessian.m;
    const qvec3 b = quat_rotate_inverse(curve->axes, v);
    return quat_rotate(curve->axes, (qvec3){h[0][0] * b.x + h[0][1] * b.y + h[0][2] * b.z,
                                            h[1][0] * b.x + h[1][1] * b.y + h[1][2] * b.z,
                                            h[2][0] * b.x + h[2][1] * b.y + h[2][2] * b.z});
}

qvec3 imp_surface_bend(const imp_body *body, const imp_state *state, qvec3 outward, qvec3 v)
{
    const surface_curve curve = surface_curve_of(body, state, outward);
    return bend_of(&curve, v);
}

static qvec3 body_turning(const imp_body *body, const imp_state *state)
{
    return body->is_static ? body->spin : imp_omega(body, state);
}

static qvec3 velocity_of(const imp_body *body, const imp_state *state)
{
    return body->is_static ? (qvec3){0, 0, 0} : state->v;
}

/* How much the surface there is flatter than round: the larger radius of curvature, about; 0 of what S does not suit.
 */
static double flatness(const impact_shape *shape, const surface_curve *curve)
{
    const double least = fmin(shape->r, fmin(shape->s, shape->t)), most = fmax(shape->r, fmax(shape->s, shape->t));
    if (shape->kind != IMPACT_SUPERQUADRIC || least < 2 || most == 2) return 0;
    const qvec3 t = imp_tangent(curve->outward);
    return qvec3_norm(bend_of(curve, t)) + qvec3_norm(bend_of(curve, qvec3_cross(curve->outward, t)));
}

/* How a superquadric's outward normal turns along its surface; exponents of 2 and more. With g the gradient of
 * sum |x/a|^p and D its Hessian, S = (1 - m m^T) D/|g|. */
typedef struct surface_turning {
    quat axes;
    double bend[3], slope; /* D, |g| */
    qvec3 outward;
} surface_turning;

static surface_turning surface_turning_of(const imp_body *body, const imp_state *state, qvec3 arm, qvec3 outward)
{
    const impact_shape *shape = &body->shape;
    surface_turning own = {.axes = imp_shape_axes(body, state), .outward = outward};
    const qvec3 place = quat_rotate_inverse(own.axes, qvec3_sub(arm, imp_shape_offset(body, state)));
    const double x[3] = {place.x, place.y, place.z}, a[3] = {shape->a, shape->b, shape->c},
                 p[3] = {shape->r, shape->s, shape->t};
    for (int i = 0; i < 3; i++) {
        const double u = fabs(x[i] / a[i]);
        own.slope = hypot(own.slope, p[i] / a[i] * pow(u, p[i] - 1));
        own.bend[i] = p[i] * (p[i] - 1) / (a[i] * a[i]) * pow(u, p[i] - 2);
    }
    return own;
}

/* S v, 1/m, of a tangential vector. */
static qvec3 surface_turn(const surface_turning *own, qvec3 v)
{
    const qvec3 b = quat_rotate_inverse(own->axes, v);
    const qvec3 world = quat_rotate(own->axes, (qvec3){own->bend[0] * b.x, own->bend[1] * b.y, own->bend[2] * b.z});
    return qvec3_scale(qvec3_axpy(-qvec3_dot(world, own->outward), own->outward, world), 1 / own->slope);
}

/* Two bodies at their one point, and the slip of the first over the second. */
typedef struct round_pair {
    const imp_body *body[2];
    const imp_state *state[2];
    qvec3 arm[2], omega[2], slip;
    surface_curve curve[2];
} round_pair;

/* The tangential x whose image is y; images of the two tangents. */
static qvec3 tangent_of_image(const qvec3 t[2], const qvec3 image[2], qvec3 y)
{
    const double a = qvec3_dot(t[0], image[0]), b = qvec3_dot(t[0], image[1]), c = qvec3_dot(t[1], image[0]),
                 d = qvec3_dot(t[1], image[1]), determinant = a * d - b * c;
    const double y0 = qvec3_dot(t[0], y), y1 = qvec3_dot(t[1], y);
    return qvec3_axpy((d * y0 - b * y1) / determinant, t[0], qvec3_scale(t[1], (a * y1 - c * y0) / determinant));
}

/* n' of two that are both round. */
static qvec3 round_turn(const round_pair *r, qvec3 n)
{
    const qvec3 t[2] = {imp_tangent(n), qvec3_cross(n, imp_tangent(n))};
    qvec3 image[2], moves = r->slip;
    for (int k = 0; k < 2; k++) {
        image[k] = qvec3_add(bend_of(&r->curve[0], t[k]), bend_of(&r->curve[1], t[k]));
        moves = qvec3_add(moves, bend_of(&r->curve[k], qvec3_cross(r->omega[k], n)));
    }
    return tangent_of_image(t, image, moves);
}

static imp_rates flatter_rates(const round_pair *r, int flat, qvec3 n)
{
    const int other = 1 - flat;
    const double side = flat == 1 ? 1 : -1;
    const qvec3 out = r->curve[flat].outward, over = qvec3_scale(r->slip, side);
    const surface_curve *round = &r->curve[other];
    const surface_turning turning = surface_turning_of(r->body[flat], r->state[flat], r->arm[flat], out);
    const qvec3 t[2] = {imp_tangent(n), qvec3_cross(n, imp_tangent(n))};
    qvec3 image[2];
    for (int k = 0; k < 2; k++) image[k] = qvec3_add(t[k], bend_of(round, surface_turn(&turning, t[k])));
    const qvec3 rolls = qvec3_cross(qvec3_sub(r->omega[other], r->omega[flat]), out);
    const qvec3 z = tangent_of_image(t, image, qvec3_add(over, bend_of(round, rolls)));
    const qvec3 turn = qvec3_add(qvec3_cross(r->omega[flat], out), surface_turn(&turning, z));
    const qvec3 own = qvec3_add(qvec3_cross(r->omega[flat], r->arm[flat]), z),
                others = qvec3_add(qvec3_cross(r->omega[other], r->arm[other]), qvec3_sub(z, over));
    return (imp_rates){
        .normal = qvec3_scale(turn, side), .arm1 = flat == 0 ? own : others, .arm2 = flat == 0 ? others : own};
}

/* Between balls the normal goes with their centres, as their arms do; a plane's stays. */
static imp_rates ball_rates(const imp_world *world, const imp_pair *pair, qvec3 n, const imp_state *states)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    imp_rates rates = {.normal = {0, 0, 0}};
    if (b2->shape.kind == IMPACT_PLANE) return rates;
    const qvec3 v = qvec3_sub(s1->v, velocity_of(b2, s2)), aside = qvec3_axpy(-qvec3_dot(v, n), n, v);
    rates.normal = qvec3_scale(aside, 1 / qvec3_norm(qvec3_sub(s1->x, s2->x)));
    rates.arm1 = qvec3_scale(rates.normal, -b1->radius), rates.arm2 = qvec3_scale(rates.normal, b2->radius);
    return rates;
}

/* A plane's normal stays. */
static imp_rates round_rates(const imp_world *world, const imp_pair *pair, const impact_contact *contact,
                             const imp_state *states)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const qvec3 n = contact->normal, out1 = qvec3_neg(n), w1 = imp_omega(b1, s1), turn1 = qvec3_cross(w1, n);
    const surface_curve curve = surface_curve_of(b1, s1, out1);
    imp_rates rates = {.normal = {0, 0, 0}};
    if (b2->shape.kind != IMPACT_PLANE) {
        const qvec3 u = qvec3_sub(imp_point_velocity(b1, s1, contact->offset1),
                                  imp_point_velocity(b2, s2, contact->offset2)),
                    w2 = body_turning(b2, s2);
        const round_pair r = {.body = {b1, b2},
                              .state = {s1, s2},
                              .arm = {contact->offset1, contact->offset2},
                              .omega = {w1, w2},
                              .slip = qvec3_axpy(-qvec3_dot(u, n), n, u),
                              .curve = {curve, surface_curve_of(b2, s2, n)}};
        const double flat1 = flatness(&b1->shape, &r.curve[0]), flat2 = flatness(&b2->shape, &r.curve[1]);
        if (flat1 > 0 || flat2 > 0) return flatter_rates(&r, flat2 >= flat1, n);
        rates.normal = round_turn(&r, n);
        rates.arm2 = qvec3_add(qvec3_cross(w2, contact->offset2),
                               bend_of(&r.curve[1], qvec3_sub(rates.normal, qvec3_cross(w2, n))));
    }
    rates.arm1 = qvec3_add(qvec3_cross(w1, contact->offset1), bend_of(&curve, qvec3_sub(turn1, rates.normal)));
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
    if (bearer == IMP_BORNE_BY_1 || bearer == IMP_BORNE_BY_2) return borne_rates(world, pair, bearer, contact, states);
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const bool on_plane = b2->shape.kind == IMPACT_PLANE;
    if (imp_is_ball(b1) && (on_plane || imp_is_ball(b2))) return ball_rates(world, pair, contact->normal, states);
    return on_plane || !imp_pair_has_faces(world, pair)
               ? round_rates(world, pair, contact, states)
               : imp_feature_rates(world, pair, bearer == IMP_BORNE_BY_LINES, contact, states);
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
                      const qvec3 axes[3], qvec3 rub, const imp_state *states, double bend[6])
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
    if (!(qvec3_dot(rub, rub) > 0)) return;
    double more[3];
    const qvec3 rub_rate = qvec3_cross(turning[bearer == IMP_BORNE_BY_1], rub),
                turns = qvec3_sub(turning[0], turning[1]),
                rate = qvec3_add(qvec3_cross(qvec3_sub(bending[0], bending[1]), rub), qvec3_cross(turns, rub_rate));
    turn_along(axes, rates.normal, qvec3_cross(turns, rub), rate, more);
    bend[1] += more[1], bend[2] += more[2];
}
