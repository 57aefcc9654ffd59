/* SPDX-License-Identifier: MIT
 *
 * With a the axis of the line, n the normal and h = a x n: a . n = 0 is kept, (a . n)' = omega . h = 0 and
 * (a . n)'' = omega' . h + (omega . n)(omega . a) = 0.
 */
#include "persist_line.h"
#include "persist_flat.h"
#include "persist_spot.h"

static qvec3 axis_of(const impact_state *state, int axis)
{
    return quat_rotate(state->q, (qvec3){axis == 0, axis == 1, axis == 2});
}

/* The horizontal axis about which the line tips. */
static qvec3 tipping_axis_of(const impact_pair *pair, const impact_state *states, int axis)
{
    const qvec3 n = quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1});
    const qvec3 h = qvec3_cross(axis_of(&states[pair->body1], axis), n);
    return qvec3_scale(h, 1 / qvec3_norm(h));
}

static qvec3 tipping_axis(const impact_pair *pair, const impact_state *states)
{
    return tipping_axis_of(pair, states, pair->line);
}

static double tipping_energy(const impact_world *world, const impact_pair *pair, const impact_state *states, int axis)
{
    const impact_body *body = &world->bodies[pair->body1];
    const impact_state *state = &states[pair->body1];
    const qvec3 h = tipping_axis_of(pair, states, axis);
    const double rate = qvec3_dot(h, impact_omega(body, state));
    return 0.5 * rate * rate * qvec3_dot(h, impact_inertia(body, state->q, h));
}

bool impact_line_lies(const impact_world *world, const impact_pair *pair, const impact_state *states)
{
    return pair->lined && impact_flat_suits(world, pair) &&
           tipping_energy(world, pair, states, pair->line) <= pair->lying;
}

qvec3 impact_line_turn(const impact_pair *pair, qvec3 normal_rate)
{
    const int k = pair->line;
    return (qvec3){k == 0 ? 0 : normal_rate.x, k == 1 ? 0 : normal_rate.y, k == 2 ? 0 : normal_rate.z};
}

void impact_line_level(const impact_world *world, const impact_pair *pair, impact_state *states)
{
    const impact_body *body = &world->bodies[pair->body1];
    impact_state *state = &states[pair->body1];
    const qvec3 h = tipping_axis(pair, states), omega = impact_omega(body, state);
    state->momentum = impact_inertia(body, state->q, qvec3_axpy(-qvec3_dot(omega, h), h, omega));
}

/* The torque about h that is missing to keep a . n = 0, N m. */
static double missing_torque(const impact_world *world, const impact_touch *touch, const impact_state *states,
                             const impact_load *load, qvec3 h)
{
    const impact_pair *pair = &world->pairs[touch->pair];
    const impact_body *body = &world->bodies[touch->body1];
    const impact_state *state = &states[touch->body1];
    const qvec3 omega = impact_omega(body, state);
    const qvec3 free = qvec3_sub(load->torque, qvec3_cross(omega, state->momentum));
    const qvec3 torque = qvec3_add(free, qvec3_cross(touch->r1, touch->force));
    const double rate = qvec3_dot(h, impact_inverse_inertia(body, state->q, torque)) +
                        qvec3_dot(omega, touch->normal) * qvec3_dot(omega, axis_of(state, pair->line));
    return -rate / qvec3_dot(h, impact_inverse_inertia(body, state->q, h));
}

double impact_line_spare(const impact_world *world, const impact_touch *touch, const impact_state *states,
                         const impact_load *loads)
{
    const double tight = 1e-9, noise = 1e-12; /* of the body's radius; of its speed, across the slip */
    const impact_pair *pair = &world->pairs[touch->pair];
    if (!touch->lined || !(touch->pressure > 0)) return 1;
    const qvec3 h = tipping_axis(pair, states);
    const double arm = fabs(missing_torque(world, touch, states, &loads[touch->body1], h)) / touch->pressure;
    /* slip that dies out has no direction to speak of, for no time */
    const double speed = qvec3_norm(states[touch->body1].v) * noise;
    const double off =
        touch->mode == IMPACT_SLIDE && !touch->onset ? tight + speed / fmax(touch->speed, world->slip_speed) : tight;
    return 1 - arm / (off * world->bodies[touch->body1].radius);
}

void impact_line_brace(const impact_world *world, const impact_touch *touch, const impact_state *states,
                       impact_load *load)
{
    if (!touch->lined) return;
    const qvec3 h = tipping_axis(&world->pairs[touch->pair], states);
    load->torque = qvec3_axpy(missing_torque(world, touch, states, load, h), h, load->torque);
}

/* Along which axis the surface is flat and the body does not rock visibly; -1: none. */
static int line_of(const impact_world *world, const impact_pair *pair, const impact_state *states, double enough)
{
    const impact_body *body = &world->bodies[pair->body1];
    const impact_spot spot = impact_spot_at(&body->shape, pair->spot);
    const double p[3] = {body->shape.r, body->shape.s, body->shape.t};
    const double pressure = enough / world->flat_height;
    for (int i = 0; i < 3; i++) {
        const double rises = body->radius * fabs(spot.u[i] * spot.e[i]);
        if (p[i] >= 3 && tipping_energy(world, pair, states, i) + pressure * rises <= enough) return i;
    }
    return -1;
}

static const impact_touch *touch_of(const impact_persist *persist, const impact_world *world, const impact_pair *pair)
{
    for (int c = 0; c < persist->count; c++)
        if (&world->pairs[persist->touches[c].pair] == pair) return &persist->touches[c];
    return NULL;
}

static bool lay(impact_persist *persist, impact_world *world, impact_pair *pair, impact_state *states,
                const impact_load *loads)
{
    const qvec3 n = quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1});
    const double enough = -qvec3_dot(loads[pair->body1].force, n) * world->flat_height;
    const int axis = enough > 0 ? line_of(world, pair, states, enough) : -1;
    if (axis < 0) return false;
    const impact_pair pair_before = *pair;
    const impact_state state_before = states[pair->body1];
    pair->lined = true;
    pair->line = axis;
    pair->lying = enough;
    pair->spot[axis] = 0;
    impact_line_level(world, pair, states);
    /* the place along the line may have given it a slip that its middle has not */
    const impact_touch there = impact_persist_touch(world, (int)(pair - world->pairs), states, loads);
    if (pair->friction > 0 && there.speed <= world->slip_speed) pair->mode = IMPACT_ROLL, pair->onset = false;
    impact_persist_solve(persist, world, states, loads);
    const impact_touch *touch = touch_of(persist, world, pair);
    if (touch && impact_line_spare(world, touch, states, loads) > 0.5) return true;
    *pair = pair_before;
    states[pair->body1] = state_before;
    return false;
}

bool impact_line_lay(impact_persist *persist, impact_world *world, impact_state *states, const impact_load *loads)
{
    bool any = false;
    for (int p = 0; p < world->pair_count; p++) {
        impact_pair *pair = &world->pairs[p];
        if (!pair->flat && !pair->lined && impact_flat_suits(world, pair))
            any = lay(persist, world, pair, states, loads) || any;
    }
    return any;
}
