/* SPDX-License-Identifier: MIT
 *
 * With a the axis of the line, n the normal and h = a x n: a . n = 0 is kept, (a . n)' = omega . h = 0 and
 * (a . n)'' = omega' . h + (omega . n)(omega . a) = 0.
 */
#include "contact/held_line.h"
#include "contact/held_flat.h"
#include "contact/held_spot.h"

static qvec3 axis_of(const imp_state *state, int axis)
{
    return quat_rotate(state->q, (qvec3){axis == 0, axis == 1, axis == 2});
}

/* The horizontal axis about which the line tips. */
static qvec3 tipping_axis_of(const imp_pair *pair, const imp_state *states, int axis)
{
    const qvec3 n = quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1});
    const qvec3 h = qvec3_cross(axis_of(&states[pair->body1], axis), n);
    return qvec3_scale(h, 1 / qvec3_norm(h));
}

static qvec3 tipping_axis(const imp_pair *pair, const imp_state *states)
{
    return tipping_axis_of(pair, states, pair->footing.line);
}

static double tipping_energy(const imp_world *world, const imp_pair *pair, const imp_state *states, int axis)
{
    const imp_body *body = &world->bodies[pair->body1];
    const imp_state *state = &states[pair->body1];
    const qvec3 h = tipping_axis_of(pair, states, axis);
    const double rate = qvec3_dot(h, imp_omega(body, state));
    return 0.5 * rate * rate * qvec3_dot(h, imp_inertia(body, state->q, h));
}

bool imp_line_lies(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    return pair->footing.on == IMP_FOOT_LINE && imp_flat_suits(world, pair) &&
           tipping_energy(world, pair, states, pair->footing.line) <= pair->footing.lying;
}

qvec3 imp_line_turn(const imp_pair *pair, qvec3 normal_rate)
{
    const int k = pair->footing.line;
    return (qvec3){k == 0 ? 0 : normal_rate.x, k == 1 ? 0 : normal_rate.y, k == 2 ? 0 : normal_rate.z};
}

void imp_line_level(const imp_world *world, const imp_pair *pair, imp_state *states)
{
    const imp_body *body = &world->bodies[pair->body1];
    imp_state *state = &states[pair->body1];
    const qvec3 h = tipping_axis(pair, states), omega = imp_omega(body, state);
    state->momentum = imp_inertia(body, state->q, qvec3_axpy(-qvec3_dot(omega, h), h, omega));
}

/* The torque about h that is missing to keep a . n = 0, N m. */
static double missing_torque(const imp_world *world, const imp_held_contact *contact, const imp_state *states,
                             const imp_load *load, qvec3 h)
{
    const imp_pair *pair = &world->pairs[contact->pair];
    const imp_body *body = &world->bodies[contact->body1];
    const imp_state *state = &states[contact->body1];
    const qvec3 omega = imp_omega(body, state);
    const qvec3 free = qvec3_sub(load->torque, qvec3_cross(omega, state->momentum));
    const qvec3 torque = qvec3_add(free, qvec3_cross(contact->r1, contact->force));
    const double rate = qvec3_dot(h, imp_inverse_inertia(body, state->q, torque)) +
                        qvec3_dot(omega, contact->normal) * qvec3_dot(omega, axis_of(state, pair->footing.line));
    return -rate / qvec3_dot(h, imp_inverse_inertia(body, state->q, h));
}

double imp_line_spare(const imp_world *world, const imp_held_contact *contact, const imp_state *states,
                      const imp_load *loads)
{
    const double tight = IMP_LINE_TIGHT, noise = IMP_LINE_NOISE;
    const imp_pair *pair = &world->pairs[contact->pair];
    if (contact->foot != IMP_FOOT_LINE || !(contact->pressure > 0)) return 1;
    const qvec3 h = tipping_axis(pair, states);
    const double arm = fabs(missing_torque(world, contact, states, &loads[contact->body1], h)) / contact->pressure;
    /* slip that dies out has no direction to speak of, for no time */
    const double speed = qvec3_norm(states[contact->body1].v) * noise;
    const double off = contact->mode == IMP_SLIDE && !contact->incipient
                           ? tight + speed / fmax(contact->speed, world->slip_speed)
                           : tight;
    return 1 - arm / (off * world->bodies[contact->body1].radius);
}

void imp_line_brace(const imp_world *world, const imp_held_contact *contact, const imp_state *states, imp_load *load)
{
    if (contact->foot != IMP_FOOT_LINE) return;
    const qvec3 h = tipping_axis(&world->pairs[contact->pair], states);
    load->torque = qvec3_axpy(missing_torque(world, contact, states, load, h), h, load->torque);
}

/* Along which axis the surface is flat and the body does not rock visibly; -1: none. */
static int line_of(const imp_world *world, const imp_pair *pair, const imp_state *states, double enough)
{
    const imp_body *body = &world->bodies[pair->body1];
    const imp_spot spot = imp_spot_at(&body->shape, pair->footing.spot);
    const double p[3] = {body->shape.r, body->shape.s, body->shape.t};
    const double pressure = enough / world->flat_height;
    for (int i = 0; i < 3; i++) {
        const double rises = body->radius * fabs(spot.u[i] * spot.e[i]);
        if (p[i] >= 3 && tipping_energy(world, pair, states, i) + pressure * rises <= enough) return i;
    }
    return -1;
}

static const imp_held_contact *contact_of(const imp_held *held, const imp_world *world, const imp_pair *pair)
{
    for (int c = 0; c < held->count; c++)
        if (&world->pairs[held->contacts[c].pair] == pair) return &held->contacts[c];
    return NULL;
}

static bool lay_lined(imp_held *held, imp_world *world, imp_pair *pair, imp_state *states, const imp_load *loads)
{
    const qvec3 n = quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1});
    const double enough = -qvec3_dot(loads[pair->body1].force, n) * world->flat_height;
    const int axis = enough > 0 ? line_of(world, pair, states, enough) : -1;
    if (axis < 0) return false;
    const imp_pair pair_before = *pair;
    const imp_state state_before = states[pair->body1];
    pair->footing.on = IMP_FOOT_LINE;
    pair->footing.line = axis;
    pair->footing.lying = enough;
    pair->footing.spot[axis] = 0;
    imp_line_level(world, pair, states);
    /* the place along the line may have given it a slip that its middle has not */
    const imp_held_contact there = imp_held_contact_at(world, (int)(pair - world->pairs), states, loads);
    if (pair->law.friction > 0 && there.speed <= world->slip_speed) pair->mode = IMP_STICK, imp_end_incipient(pair);
    imp_held_solve(held, world, states, loads);
    const imp_held_contact *contact = contact_of(held, world, pair);
    if (contact && imp_line_spare(world, contact, states, loads) > 0.5) return true;
    *pair = pair_before;
    states[pair->body1] = state_before;
    return false;
}

bool imp_line_lay(imp_held *held, imp_world *world, imp_state *states, const imp_load *loads)
{
    bool any = false;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        if (pair->footing.on == IMP_FOOT_SPOT && imp_flat_suits(world, pair))
            any = lay_lined(held, world, pair, states, loads) || any;
    }
    return any;
}
