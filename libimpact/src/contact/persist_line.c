/* SPDX-License-Identifier: MIT
 *
 * With a the axis of the line, n the normal and h = a x n: a . n = 0 is kept, (a . n)' = omega . h = 0 and
 * (a . n)'' = omega' . h + (omega . n)(omega . a) = 0.
 */
#include "contact/persist_line.h"
#include "contact/persist_flat.h"
#include "contact/persist_spot.h"

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
static double missing_torque(const imp_world *world, const imp_touch *touch, const imp_state *states,
                             const imp_load *load, qvec3 h)
{
    const imp_pair *pair = &world->pairs[touch->pair];
    const imp_body *body = &world->bodies[touch->body1];
    const imp_state *state = &states[touch->body1];
    const qvec3 omega = imp_omega(body, state);
    const qvec3 free = qvec3_sub(load->torque, qvec3_cross(omega, state->momentum));
    const qvec3 torque = qvec3_add(free, qvec3_cross(touch->r1, touch->force));
    const double rate = qvec3_dot(h, imp_inverse_inertia(body, state->q, torque)) +
                        qvec3_dot(omega, touch->normal) * qvec3_dot(omega, axis_of(state, pair->footing.line));
    return -rate / qvec3_dot(h, imp_inverse_inertia(body, state->q, h));
}

double imp_line_spare(const imp_world *world, const imp_touch *touch, const imp_state *states, const imp_load *loads)
{
    const double tight = IMP_LINE_TIGHT, noise = IMP_LINE_NOISE;
    const imp_pair *pair = &world->pairs[touch->pair];
    if (touch->foot != IMP_FOOT_LINE || !(touch->pressure > 0)) return 1;
    const qvec3 h = tipping_axis(pair, states);
    const double arm = fabs(missing_torque(world, touch, states, &loads[touch->body1], h)) / touch->pressure;
    /* slip that dies out has no direction to speak of, for no time */
    const double speed = qvec3_norm(states[touch->body1].v) * noise;
    const double off =
        touch->mode == IMP_SLIDE && !touch->onset ? tight + speed / fmax(touch->speed, world->slip_speed) : tight;
    return 1 - arm / (off * world->bodies[touch->body1].radius);
}

void imp_line_brace(const imp_world *world, const imp_touch *touch, const imp_state *states, imp_load *load)
{
    if (touch->foot != IMP_FOOT_LINE) return;
    const qvec3 h = tipping_axis(&world->pairs[touch->pair], states);
    load->torque = qvec3_axpy(missing_torque(world, touch, states, load, h), h, load->torque);
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

static const imp_touch *touch_of(const imp_persist *persist, const imp_world *world, const imp_pair *pair)
{
    for (int c = 0; c < persist->count; c++)
        if (&world->pairs[persist->touches[c].pair] == pair) return &persist->touches[c];
    return NULL;
}

static bool lay_lined(imp_persist *persist, imp_world *world, imp_pair *pair, imp_state *states, const imp_load *loads)
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
    const imp_touch there = imp_persist_touch(world, (int)(pair - world->pairs), states, loads);
    if (pair->law.friction > 0 && there.speed <= world->slip_speed) pair->mode = IMP_ROLL, imp_end_onset(pair);
    imp_persist_solve(persist, world, states, loads);
    const imp_touch *touch = touch_of(persist, world, pair);
    if (touch && imp_line_spare(world, touch, states, loads) > 0.5) return true;
    *pair = pair_before;
    states[pair->body1] = state_before;
    return false;
}

bool imp_line_lay(imp_persist *persist, imp_world *world, imp_state *states, const imp_load *loads)
{
    bool any = false;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        if (pair->footing.on == IMP_FOOT_SPOT && imp_flat_suits(world, pair))
            any = lay_lined(persist, world, pair, states, loads) || any;
    }
    return any;
}
