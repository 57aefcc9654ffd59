/* SPDX-License-Identifier: MIT */
#include "field.h"

static bool acts_on(const impact_field *field, const impact_world *world, int body)
{
    return !world->bodies[body].is_static && (field->only < 0 || field->only == body);
}

/* ---- wind ---- */

/* Distance along the tube's axis, and from it. */
static void tube_coordinates(const impact_force_def *def, qvec3 x, double *along, double *across)
{
    const qvec3 d = qvec3_sub(x, def->origin);
    const double s = qvec3_dot(d, def->direction);
    *along = fabs(s);
    *across = qvec3_norm(qvec3_axpy(-s, def->direction, d));
}

static qvec3 wind(const impact_force_def *def, qvec3 x)
{
    double along, across;
    tube_coordinates(def, x, &along, &across);
    const double fall = def->falloff_power == 0 ? 1 : pow(1 + along / def->falloff_length, -def->falloff_power);
    return qvec3_scale(def->direction, def->strength * fall);
}

static double wind_edge(const impact_force_def *def, qvec3 x)
{
    double along, across;
    tube_coordinates(def, x, &along, &across);
    return fmin(def->reach - along, def->radius - across);
}

/* ---- attraction: the slot of bodies i < j is i + j (j - 1)/2 ---- */

static double attraction(const impact_force_def *def, double m1, double m2, double distance)
{
    return def->constant * m1 * m2 * pow(distance, -def->power);
}

/* Zero at the reach; at infinity when that is possible; else at 1 m. */
static double attraction_potential(const impact_force_def *def, double m1, double m2, double distance)
{
    const double k = def->constant * m1 * m2;
    const double zero = isfinite(def->reach) ? def->reach : 1;
    if (def->power == 1) return k * log(distance / zero);
    const double e = 1 - def->power;
    const double at_zero = isfinite(def->reach) || e > 0 ? pow(zero, e) : 0;
    return k * (pow(distance, e) - at_zero) / e;
}

static void add_attraction(const impact_world *world, const impact_field *field, const impact_state *states,
                           impact_load *loads)
{
    int slot = 0;
    for (int j = 1; j < world->body_count; j++)
        for (int i = 0; i < j; i++, slot++) {
            if (world->bodies[i].is_static || world->bodies[j].is_static || !field->inside[slot]) continue;
            const qvec3 d = qvec3_sub(states[j].x, states[i].x);
            const double distance = qvec3_norm(d);
            const qvec3 f = qvec3_scale(
                d, attraction(&field->def, world->bodies[i].mass, world->bodies[j].mass, distance) / distance);
            loads[i].force = qvec3_add(loads[i].force, f);
            loads[j].force = qvec3_sub(loads[j].force, f);
        }
}

/* ---- all of them ---- */

static bool add_to_body(const impact_field *field, const impact_world *world, double t, const impact_state *states,
                        int i, impact_load *load)
{
    const impact_body *body = &world->bodies[i];
    const qvec3 omega = impact_omega(body, &states[i]);
    qvec3 force = {0, 0, 0}, torque = {0, 0, 0};
    if (field->def.kind == IMPACT_FORCE_WIND) {
        if (!field->inside[i]) return true;
        force = wind(&field->def, states[i].x);
    } else if (!field->def.function(t, i, body->mass, states[i].x, states[i].q, states[i].v, omega, &force, &torque,
                                    field->def.context)) {
        return false;
    }
    load->force = qvec3_add(load->force, force);
    load->torque = qvec3_add(load->torque, torque);
    load->work_rate += qvec3_dot(force, states[i].v) + qvec3_dot(torque, omega);
    return true;
}

/* Damping as in the thesis' scenes: velocity and angular velocity lose a fixed part per second. */
static void add_damping(const impact_body *body, const impact_state *state, impact_load *load)
{
    const qvec3 f = qvec3_scale(state->v, -body->mass * body->linear_rate);
    const qvec3 torque = qvec3_scale(state->momentum, -body->angular_rate);
    load->force = qvec3_add(load->force, f);
    load->torque = qvec3_add(load->torque, torque);
    load->damping_rate -= qvec3_dot(f, state->v) + qvec3_dot(torque, impact_omega(body, state));
}

bool impact_field_loads(const impact_world *world, double t, const impact_state *states, impact_load *loads)
{
    for (int i = 0; i < world->body_count; i++) {
        const impact_body *body = &world->bodies[i];
        loads[i] = (impact_load){{0, 0, 0}, {0, 0, 0}, 0, 0};
        if (body->is_static) continue;
        loads[i].force = qvec3_scale(world->gravity, body->mass);
        if (body->linear_rate != 0 || body->angular_rate != 0) add_damping(body, &states[i], &loads[i]);
    }
    for (int k = 0; k < world->field_count; k++) {
        const impact_field *field = &world->fields[k];
        if (field->def.kind == IMPACT_FORCE_ATTRACTION) {
            add_attraction(world, field, states, loads);
            continue;
        }
        for (int i = 0; i < world->body_count; i++)
            if (acts_on(field, world, i) && !add_to_body(field, world, t, states, i, &loads[i])) return false;
    }
    return true;
}

double impact_field_potential(const impact_world *world, const impact_state *states)
{
    double potential = 0;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) potential -= world->bodies[i].mass * qvec3_dot(world->gravity, states[i].x);
    for (int k = 0; k < world->field_count; k++) {
        const impact_field *field = &world->fields[k];
        if (field->def.kind != IMPACT_FORCE_ATTRACTION) continue;
        int slot = 0;
        for (int j = 1; j < world->body_count; j++)
            for (int i = 0; i < j; i++, slot++)
                if (!world->bodies[i].is_static && !world->bodies[j].is_static && field->inside[slot])
                    potential += attraction_potential(&field->def, world->bodies[i].mass, world->bodies[j].mass,
                                                      qvec3_norm(qvec3_sub(states[j].x, states[i].x)));
    }
    return potential;
}

/* ---- edges ---- */

int impact_field_slots(const impact_force_def *def, int body_count)
{
    switch (def->kind) {
    case IMPACT_FORCE_WIND: return body_count;
    case IMPACT_FORCE_ATTRACTION: return body_count * (body_count - 1) / 2;
    case IMPACT_FORCE_CUSTOM: return 0;
    }
    return 0;
}

bool impact_field_any(const impact_world *world)
{
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static && (world->bodies[i].linear_rate != 0 || world->bodies[i].angular_rate != 0))
            return true;
    return world->field_count > 0;
}

int impact_field_edge_count(const impact_world *world)
{
    int count = 0;
    for (int k = 0; k < world->field_count; k++) count += world->fields[k].slots;
    return count;
}

/* > 0 inside the reach; +1 where there is no edge. */
static double edge_value(const impact_world *world, const impact_field *field, const impact_state *states, int slot)
{
    if (field->def.kind == IMPACT_FORCE_WIND)
        return acts_on(field, world, slot) && (isfinite(field->def.reach) || isfinite(field->def.radius))
                   ? wind_edge(&field->def, states[slot].x)
                   : 1;
    if (!isfinite(field->def.reach)) return 1;
    int j = 1, first = 0;
    while (slot >= first + j) first += j++;
    const int i = slot - first;
    if (world->bodies[i].is_static || world->bodies[j].is_static) return 1;
    return field->def.reach - qvec3_norm(qvec3_sub(states[j].x, states[i].x));
}

void impact_field_edges(const impact_world *world, const impact_state *states, double *value)
{
    for (int k = 0; k < world->field_count; k++)
        for (int slot = 0; slot < world->fields[k].slots; slot++) {
            const double edge = edge_value(world, &world->fields[k], states, slot);
            *value++ = world->fields[k].inside[slot] ? edge : -edge;
        }
}

void impact_field_locate(impact_world *world, const impact_state *states)
{
    for (int k = 0; k < world->field_count; k++)
        for (int slot = 0; slot < world->fields[k].slots; slot++)
            world->fields[k].inside[slot] = edge_value(world, &world->fields[k], states, slot) >= 0;
}

void impact_field_cross(impact_world *world, int edge, int *field, int *body)
{
    int k = 0;
    while (edge >= world->fields[k].slots) edge -= world->fields[k++].slots;
    world->fields[k].inside[edge] = !world->fields[k].inside[edge];
    int j = edge;
    if (world->fields[k].def.kind == IMPACT_FORCE_ATTRACTION) {
        int first = 0;
        for (j = 1; edge >= first + j;) first += j++;
    }
    *field = k;
    *body = j;
}
