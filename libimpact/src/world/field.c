/* SPDX-License-Identifier: MIT */
#include "world/field.h"
#include "base/tolerances.h"

static bool acts_on(const imp_field *field, const imp_world *world, int body)
{
    return !world->bodies[body].is_static && (field->only < 0 || field->only == body);
}

/* ---- wind ---- */

/* What is left of it there. */
static double wind_fall(const impact_force_def *def, qvec3 x)
{
    const double along = fabs(qvec3_dot(qvec3_sub(x, def->origin), def->direction));
    return def->falloff_power == 0 ? 1 : pow(1 + along / def->falloff_length, -def->falloff_power);
}

static qvec3 wind(const impact_force_def *def, const imp_state *state)
{
    const qvec3 pull = qvec3_axpy(-def->drag, state->v, qvec3_scale(def->direction, def->strength));
    return qvec3_scale(pull, wind_fall(def, state->x));
}

/* ---- attraction: the slot of bodies i < j is i + j (j - 1)/2 ---- */

static double attraction(const impact_force_def *def, double m1, double m2, double distance)
{
    return def->constant * m1 * m2 * pow(distance, -def->power);
}

/* Zero at the reach; at infinity when that is possible; else at 1 m. */
static double attraction_potential(const impact_force_def *def, double m1, double m2, double distance)
{
    const double k = def->constant * m1 * m2, e = 1 - def->power;
    if (e < 0 && !isfinite(def->reach)) return k * pow(distance, e) / e;
    const double zero = isfinite(def->reach) ? def->reach : 1, ratio = log(distance / zero);
    return k * pow(zero, e) * (e == 0 ? ratio : expm1(e * ratio) / e);
}

static void add_attraction(const imp_world *world, const imp_field *field, const imp_state *states, imp_load *loads)
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

/* Without what is nothing beside any tolerance: an integrator squares it, and then divides zero by zero. */
static qvec3 felt(qvec3 f, double unit)
{
    const double least = IMP_LEAST_ACCELERATION * unit;
    return (qvec3){fabs(f.x) < least ? 0 : f.x, fabs(f.y) < least ? 0 : f.y, fabs(f.z) < least ? 0 : f.z};
}

static bool add_to_body(const imp_field *field, const imp_world *world, double t, const imp_state *states, int i,
                        imp_load *load)
{
    const imp_body *body = &world->bodies[i];
    const qvec3 omega = imp_omega(body, &states[i]);
    qvec3 force = {0, 0, 0}, torque = {0, 0, 0};
    if (field->def.kind == IMPACT_FORCE_WIND) {
        if (!field->inside[i]) return true;
        force = wind(&field->def, &states[i]);
    } else if (!field->def.function(imp_field_inner_time(field, t), body->index, body->mass, states[i].x, states[i].q,
                                    states[i].v, omega, &force, &torque, field->def.context)) {
        return false;
    }
    force = felt(force, body->mass);
    torque = felt(torque, body->mass * body->radius);
    load->force = qvec3_add(load->force, force);
    load->torque = qvec3_add(load->torque, torque);
    load->work_rate += qvec3_dot(force, states[i].v) + qvec3_dot(torque, omega);
    return true;
}

/* Damping as in the thesis' scenes: velocity and angular velocity lose a fixed part per second. */
static void add_damping(const imp_body *body, const imp_state *state, imp_load *load)
{
    const qvec3 f = qvec3_scale(state->v, -body->mass * body->linear_rate);
    const qvec3 torque = qvec3_scale(state->momentum, -body->angular_rate);
    load->force = qvec3_add(load->force, f);
    load->torque = qvec3_add(load->torque, torque);
    load->damping_rate -= qvec3_dot(f, state->v) + qvec3_dot(torque, imp_omega(body, state));
}

bool imp_field_loads(const imp_world *world, double t, const imp_state *states, imp_load *loads)
{
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        loads[i] = (imp_load){{0, 0, 0}, {0, 0, 0}, 0, 0};
        if (body->is_static) continue;
        loads[i].force = qvec3_scale(world->gravity, body->mass);
        if (body->linear_rate != 0 || body->angular_rate != 0) add_damping(body, &states[i], &loads[i]);
    }
    for (int k = 0; k < world->field_count; k++) {
        const imp_field *field = &world->fields[k];
        if (field->def.kind == IMPACT_FORCE_ATTRACTION) {
            add_attraction(world, field, states, loads);
            continue;
        }
        for (int i = 0; i < world->body_count; i++)
            if (acts_on(field, world, i) && !add_to_body(field, world, t, states, i, &loads[i])) return false;
    }
    return true;
}

/* ---- how fast forces brake ---- */

static double component(qvec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

static bool brake_of(const imp_field *field, const imp_world *world, double t, const imp_state *state, int i,
                     double *rate)
{
    const imp_body *body = &world->bodies[i];
    const qvec3 omega = imp_omega(body, state), axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double size = qvec3_norm(state->v) + body->radius * qvec3_norm(omega);
    const double nudge = IMP_BRAKE_NUDGE * (size > 0 ? size : body->radius);
    qvec3 force = {0, 0, 0}, torque = {0, 0, 0};
    t = imp_field_inner_time(field, t);
    if (!field->def.function(t, body->index, body->mass, state->x, state->q, state->v, omega, &force, &torque,
                             field->def.context))
        return false;
    for (int k = 0; k < 6; k++) {
        const bool turns = k >= 3;
        const qvec3 e = axes[k % 3], v = turns ? state->v : qvec3_axpy(nudge, e, state->v);
        const qvec3 w = turns ? qvec3_axpy(nudge / body->radius, e, omega) : omega;
        qvec3 f = {0, 0, 0}, g = {0, 0, 0};
        if (!field->def.function(t, body->index, body->mass, state->x, state->q, v, w, &f, &g, field->def.context))
            return false;
        const qvec3 change = turns
                                 ? imp_inverse_inertia(body, state->q, qvec3_scale(qvec3_sub(g, torque), body->radius))
                                 : qvec3_scale(qvec3_sub(f, force), body->inverse_mass);
        *rate = fmax(*rate, -component(change, k % 3) / nudge);
    }
    return true;
}

double imp_field_brake(const imp_world *world, double t, const imp_state *states, double *turning)
{
    double rate = 0;
    *turning = 0;
    for (int k = 0; k < world->field_count; k++) {
        const imp_field *field = &world->fields[k];
        for (int i = 0; i < world->body_count && field->def.kind == IMPACT_FORCE_WIND; i++)
            if (acts_on(field, world, i) && field->inside[i])
                rate =
                    fmax(rate, field->def.drag * wind_fall(&field->def, states[i].x) * world->bodies[i].inverse_mass);
        for (int i = 0; i < world->body_count && field->def.kind == IMPACT_FORCE_CUSTOM; i++) {
            if (!acts_on(field, world, i)) continue;
            if (!brake_of(field, world, t, &states[i], i, &rate)) return 0;
            *turning = fmax(*turning, qvec3_norm(imp_omega(&world->bodies[i], &states[i])));
        }
    }
    return rate;
}

double imp_field_potential(const imp_world *world, const imp_state *states)
{
    double potential = 0;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) potential -= world->bodies[i].mass * qvec3_dot(world->gravity, states[i].x);
    for (int k = 0; k < world->field_count; k++) {
        const imp_field *field = &world->fields[k];
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

int imp_field_slots(const impact_force_def *def, int body_count)
{
    switch (def->kind) {
    case IMPACT_FORCE_WIND: return body_count;
    case IMPACT_FORCE_ATTRACTION: return body_count * (body_count - 1) / 2;
    case IMPACT_FORCE_CUSTOM: return def->edge ? body_count : 0;
    }
    return 0;
}

int imp_field_edge_count(const imp_world *world)
{
    int count = 0;
    for (int k = 0; k < world->field_count; k++) count += world->fields[k].slots;
    return count;
}

/* value > 0 inside the reach, its rate, and the speed across or along it. */
typedef struct field_edge {
    double value, rate, speed;
} field_edge;

static const field_edge no_edge = {1, -1, 0};

static field_edge wind_edge(const impact_force_def *def, const imp_state *state)
{
    const qvec3 d = qvec3_sub(state->x, def->origin);
    const double s = qvec3_dot(d, def->direction), v = qvec3_dot(state->v, def->direction);
    const qvec3 p = qvec3_axpy(-s, def->direction, d);
    const double across = qvec3_norm(p), speed = qvec3_norm(state->v);
    const field_edge end = {def->reach - fabs(s), s < 0 ? v : -v, speed};
    const field_edge side = {def->radius - across, across > 0 ? -qvec3_dot(p, state->v) / across : 0, speed};
    return end.value < side.value ? end : side;
}

/* A root of the value ends the step; that one comes and goes within a step is for max_step to prevent. */
static field_edge custom_edge(const imp_world *world, const imp_field *field, double t, const imp_state *s, int body)
{
    const imp_body *b = &world->bodies[body];
    if (!acts_on(field, world, body)) return no_edge;
    const impact_sample sample = {t, b->index, b->name, s->x, s->q, s->v, imp_omega(b, s)};
    return (field_edge){field->def.edge(imp_field_inner_time(field, t), &sample, field->def.context), 0, 0};
}

static field_edge edge_of(const imp_world *world, const imp_field *field, double t, const imp_state *states, int slot)
{
    if (field->def.kind == IMPACT_FORCE_CUSTOM) return custom_edge(world, field, t, &states[slot], slot);
    if (field->def.kind == IMPACT_FORCE_WIND)
        return acts_on(field, world, slot) && (isfinite(field->def.reach) || isfinite(field->def.radius))
                   ? wind_edge(&field->def, &states[slot])
                   : no_edge;
    if (!isfinite(field->def.reach)) return no_edge;
    int j = 1, first = 0;
    while (slot >= first + j) first += j++;
    const int i = slot - first;
    if (world->bodies[i].is_static || world->bodies[j].is_static) return no_edge;
    const qvec3 d = qvec3_sub(states[j].x, states[i].x), v = qvec3_sub(states[j].v, states[i].v);
    const double distance = qvec3_norm(d);
    return (field_edge){field->def.reach - distance, -qvec3_dot(d, v) / distance, qvec3_norm(v)};
}

void imp_field_edges(const imp_world *world, double t, const imp_state *states, double *value)
{
    for (int k = 0; k < world->field_count; k++)
        for (int slot = 0; slot < world->fields[k].slots; slot++) {
            const field_edge e = edge_of(world, &world->fields[k], t, states, slot);
            const double sign = world->fields[k].inside[slot] ? 1 : -1;
            *value++ = sign * e.value;
            *value++ =
                world->fields[k].def.kind == IMPACT_FORCE_CUSTOM ? 1 : imp_still_rate(world, e.speed) - sign * e.rate;
        }
}

double imp_field_edge(const imp_world *world, double t, const imp_state *states, int number)
{
    int k = 0;
    while (number >= world->fields[k].slots) number -= world->fields[k++].slots;
    const double value = edge_of(world, &world->fields[k], t, states, number).value;
    return world->fields[k].inside[number] ? value : -value;
}

/* Half of the way across, at the speed given or from rest at the acceleration given. */
static double half_crossing_time(double across, qvec3 velocity, qvec3 acceleration)
{
    return 0.5 * across / (qvec3_norm(velocity) + sqrt(qvec3_norm(acceleration) * across));
}

static qvec3 acceleration_of(const imp_world *world, const imp_load *loads, int body)
{
    return qvec3_scale(loads[body].force, world->bodies[body].inverse_mass);
}

double imp_field_step_limit(const imp_world *world, const imp_state *states, const imp_load *loads)
{
    double limit = INFINITY;
    for (int k = 0; k < world->field_count; k++) {
        const imp_field *field = &world->fields[k];
        const bool wind = field->def.kind == IMPACT_FORCE_WIND;
        const double across = wind ? fmin(field->def.reach, field->def.radius) : field->def.reach;
        if (!isfinite(across)) continue;
        for (int i = 0; wind && i < field->slots; i++)
            if (field->inside[i] && acts_on(field, world, i))
                limit = fmin(limit, half_crossing_time(across, states[i].v, acceleration_of(world, loads, i)));
        for (int j = 1, slot = 0; !wind && slot < field->slots; j++)
            for (int i = 0; i < j; i++, slot++)
                if (field->inside[slot] && !world->bodies[i].is_static && !world->bodies[j].is_static)
                    limit = fmin(limit, half_crossing_time(across, qvec3_sub(states[j].v, states[i].v),
                                                           qvec3_sub(acceleration_of(world, loads, j),
                                                                     acceleration_of(world, loads, i))));
    }
    return limit;
}

void imp_field_locate(imp_world *world, double t, const imp_state *states, bool custom)
{
    for (int k = 0; k < world->field_count; k++)
        for (int slot = 0; slot < world->fields[k].slots; slot++) {
            if ((world->fields[k].def.kind == IMPACT_FORCE_CUSTOM) != custom) continue;
            const field_edge e = edge_of(world, &world->fields[k], t, states, slot);
            world->fields[k].inside[slot] = e.value > 0 || (e.value == 0 && e.rate >= 0);
        }
}

void imp_field_cross(imp_world *world, int edge, int *field, int *body)
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
