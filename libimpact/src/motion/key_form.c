/* SPDX-License-Identifier: MIT
 *
 * Motions of which one key says all. With T = t - t0:
 *
 *     STEADY  x = x0 + v0 T + a T^2/2,  q = exp((omega0 T + alpha T^2/2)/2) q0,  alpha along omega0:
 *             rest; flight whose spin is steady; a ball that rolls or slides in a line
 *
 *     FREE    v' = g - k v,  L' = -kappa L:  g = a0 + k v0, L0 = J omega0, and what motion/segment.h has of it
 */
#include "motion/key.h"

static bool is_steady(const imp_body *body, const imp_segment *s)
{
    if (s->kind == IMP_SEGMENT_FREE) return !s->tumble || s->tumble->steady;
    if (s->kind == IMP_SEGMENT_REST) return qvec3_dot(s->start.v, s->start.v) == 0;
    const qvec3 cross = qvec3_cross(imp_omega(body, &s->start), s->spin_up);
    return s->kind == IMP_SEGMENT_ROLL && qvec3_dot(cross, cross) == 0;
}

impact_key_form imp_key_form(const imp_body *body, const imp_segment *segment)
{
    if (is_steady(body, segment)) return IMPACT_KEY_STEADY;
    const bool free = segment->kind == IMP_SEGMENT_FREE || segment->kind == IMP_SEGMENT_DAMPED;
    return free ? IMPACT_KEY_FREE : IMPACT_KEY_QUINTIC;
}

static impact_key steady(const impact_key *from, double t)
{
    impact_key key = *from;
    const double T = t - from->t;
    const qvec3 turn = qvec3_scale(qvec3_axpy(0.5 * T, from->alpha, from->omega), T);
    key.t = t;
    key.position = qvec3_axpy(T, qvec3_axpy(0.5 * T, from->acceleration, from->velocity), from->position);
    key.velocity = qvec3_axpy(T, from->acceleration, from->velocity);
    key.orientation = quat_unit(quat_mul(quat_from_rotation_vector(turn), from->orientation));
    key.omega = qvec3_axpy(T, from->alpha, from->omega);
    return key;
}

impact_key imp_key_alone(const imp_body *body, const impact_key *key, double t)
{
    if (t == key->t) return *key;
    if (key->form == IMPACT_KEY_STEADY) return steady(key, t);
    imp_state start = {.x = key->position, .v = key->velocity, .q = key->orientation};
    start.momentum = imp_inertia(body, start.q, key->omega);
    impact_tumble tumble;
    const qvec3 g = qvec3_axpy(body->linear_rate, key->velocity, key->acceleration);
    const imp_segment flight = imp_segment_fly(body, key->t, &start, g, &tumble);
    const imp_state state = imp_segment_at(&flight, body, t);
    qvec3 acceleration, torque;
    imp_segment_rates(&flight, body, t, &acceleration, &torque);
    return imp_key_of(body, key->body, t, &state, acceleration, torque);
}
