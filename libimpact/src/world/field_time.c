/* SPDX-License-Identifier: MIT
 *
 * Custom forces in time: the pieces between their switches, and steps that do not pass over what they do. An integrator
 * asks a force at the ends of its steps; what changes it at every instant of a stretch longer than a step is seen.
 */
#include "world/field.h"

#include <math.h>

static bool has_switches(const imp_field *field) { return field->def.switch_count > 0 || field->def.switch_period > 0; }

/* The switch of this number, s: in order of time, and through all periods. */
static double switch_at(const imp_field *field, double number)
{
    const int count = field->def.switch_count;
    if (!(field->def.switch_period > 0))
        return number < 0 ? -INFINITY : number < count ? field->switches[(int)number] : INFINITY;
    if (count == 0) return number * field->def.switch_period;
    const double period = floor(number / count);
    return field->switches[(int)(number - period * count)] + period * field->def.switch_period;
}

/* The number of the last switch at t or before; -1: none. Periods are numbered by division, which may round to the one
 * beside. */
static double last_switch(const imp_field *field, double t)
{
    double number = -1;
    if (field->def.switch_period > 0) {
        const int count = field->def.switch_count;
        const double first = count > 0 ? field->switches[0] : 0;
        number = (floor((t - first) / field->def.switch_period) - 1) * (count > 0 ? count : 1);
    }
    while (switch_at(field, number + 1) <= t) number++;
    return number;
}

void imp_field_enter(imp_world *world, double t)
{
    for (int k = 0; k < world->field_count; k++) {
        imp_field *field = &world->fields[k];
        field->piece[0] = -INFINITY, field->piece[1] = INFINITY;
        if (!has_switches(field)) continue;
        const double last = last_switch(field, t);
        field->piece[0] = switch_at(field, last);
        field->piece[1] = switch_at(field, last + 1);
    }
}

double imp_field_next_switch(const imp_world *world)
{
    double next = INFINITY;
    for (int k = 0; k < world->field_count; k++) next = fmin(next, world->fields[k].piece[1]);
    return next;
}

/* The caller's own comparisons with the switch may round. */
static double roundings_off(double t) { return isfinite(t) ? IMP_SWITCH_ROUNDING * fabs(t) : 0; }

double imp_field_inner_time(const imp_field *field, double t)
{
    const double first = field->piece[0] + roundings_off(field->piece[0]),
                 last = field->piece[1] - roundings_off(field->piece[1]);
    return fmin(fmax(t, first), last);
}

bool imp_field_unsteady(const imp_world *world)
{
    for (int k = 0; k < world->field_count; k++)
        if (world->fields[k].def.kind == IMPACT_FORCE_CUSTOM && !world->fields[k].def.steady) return true;
    return false;
}

/* The time in which a body moves, or turns, by its radius, from the speed and the load it has. */
static double crossing_time(const imp_body *body, const imp_state *state, const imp_load *load)
{
    const double push = qvec3_norm(load->force) * body->inverse_mass +
                        body->radius * qvec3_norm(imp_inverse_inertia(body, state->q, load->torque));
    const double speed = qvec3_norm(state->v) + body->radius * qvec3_norm(imp_omega(body, state));
    return body->radius / (speed + sqrt(push * body->radius));
}

double imp_field_custom_step_limit(const imp_world *world, const imp_state *states, const imp_load *loads)
{
    double limit = INFINITY;
    for (int k = 0; k < world->field_count; k++) {
        const imp_field *field = &world->fields[k];
        if (field->def.kind != IMPACT_FORCE_CUSTOM || !isfinite(field->def.max_step)) continue;
        limit = fmin(limit, field->def.max_step);
        for (int i = 0; i < world->body_count; i++)
            if (!world->bodies[i].is_static && (field->only < 0 || field->only == i))
                limit = fmin(limit, fmax(crossing_time(&world->bodies[i], &states[i], &loads[i]),
                                         IMP_LEAST_OF_MAX_STEP * field->def.max_step));
    }
    return limit;
}
