/* SPDX-License-Identifier: MIT
 *
 * The integrated state is y = (t, works[3], (x, q, v, L) of each body that moves, the place of each contact that is
 * carried, and where surfaces are driven the drives' work). While a contact slides, time is not the variable of
 * integration: with s the slip speed, du/dt is singular where s dies out, since the direction of slip turns ever
 * faster. In tau with dt/dtau = 1/(1 + sum slip_scale/s_i) the motion is smooth, s dies out exponentially, and no sign
 * can flip. So CVODE has it; the explicit method's steps are as short as the slip asks (motion_guard.c), and tau is
 * time since the stretch began, which has digits for the shortest. Where slip begins from rest it has no direction but
 * its acceleration's (held.c); once it has, the direction is bound to the acceleration the more stiffly the slower
 * the slip is: BDF takes that stretch, in t. Over a flat place of a surface the contact point runs without bound, and
 * with it the reactions: u' of held_spot slows the clock alike, dt/dtau = 1/hypot(1, |u'|/point_speed_scale).
 */
#include "motion/motion_equations.h"
#include "base/number.h"
#include "world/surface_velocity.h"
#include "contact/held_flat.h"
#include "contact/held_line.h"
#include "contact/held_spot.h"
#include "world/corner.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

/* ---- the integrated state ---- */

void imp_motion_pack(const imp_motion *motion, double t, const imp_state *states, double *y)
{
    y[Y_TIME] = t;
    y[Y_FORCE_WORK] = motion->works.force;
    y[Y_DAMPING] = motion->works.damping;
    y[Y_SLIDING] = motion->works.sliding;
    double *b = y + Y_BODIES;
    for (int i = 0; i < motion->world->body_count; i++) {
        if (motion->world->bodies[i].is_static) continue;
        const imp_state *s = &states[i];
        const double values[Y_PER_BODY] = {s->x.x, s->x.y, s->x.z, s->q.w,        s->q.x,        s->q.y,       s->q.z,
                                           s->v.x, s->v.y, s->v.z, s->momentum.x, s->momentum.y, s->momentum.z};
        memcpy(b, values, sizeof values);
        b += Y_PER_BODY;
    }
    for (int p = 0; p < motion->world->pair_count; p++) {
        const imp_pair *pair = &motion->world->pairs[p];
        if (!imp_spot_suits(motion->world, pair)) continue;
        for (int k = 0; k < Y_PER_SPOT; k++) *b++ = imp_is_carried(pair) ? pair->footing.spot[k] : 0;
    }
    if (motion->world->driven) y[imp_motion_drive(motion)] = motion->works.drive;
}

static double measure_of(double size) { return size > IMP_ORDINARY_SIZE || (size > 0 && size < 1) ? size : 1; }

/* How fast the bodies are, or would be once the loads have moved a point of theirs by its body's size, m/s: what others
 * push may not be moving yet. */
static double speed_scale(const imp_motion *motion, const imp_state *states)
{
    double fastest = 0;
    for (int i = 0; i < motion->world->body_count; i++) {
        const imp_body *body = &motion->world->bodies[i];
        if (body->is_static) continue;
        const qvec3 turned = imp_inverse_inertia(body, states[i].q, motion->loads[i].torque);
        const double pushed = qvec3_norm(motion->loads[i].force) / body->mass + body->radius * qvec3_norm(turned);
        fastest = fmax(fastest, hypot(imp_motion_speed(body, &states[i]), sqrt(pushed * body->radius)));
    }
    return fastest;
}

/* Works are differences of energies: that which moves, and what the loads do over the bodies' sizes, J. */
static double energy_scale(const imp_motion *motion, const imp_state *states)
{
    double scale = imp_world_kinetic_energy(motion->world, states);
    for (int i = 0; i < motion->world->body_count; i++)
        if (!motion->world->bodies[i].is_static)
            scale += motion->world->bodies[i].radius * qvec3_norm(motion->loads[i].force);
    return scale > 0 ? scale : 1;
}

void imp_motion_measures(const imp_motion *motion, const imp_state *states, double *measure)
{
    for (int i = 0; i < motion->size; i++) measure[i] = 1;
    const double energy = energy_scale(motion, states) / IMP_ABSOLUTE_OF_RELATIVE, speed = speed_scale(motion, states);
    for (int k = Y_FORCE_WORK; k <= Y_SLIDING; k++) measure[k] = energy;
    if (motion->world->driven) measure[imp_motion_drive(motion)] = energy;
    double *b = measure + Y_BODIES;
    for (int i = 0; i < motion->world->body_count; i++) {
        const imp_body *body = &motion->world->bodies[i];
        if (body->is_static) continue;
        const double moment = fmax(body->moments.x, fmax(body->moments.y, body->moments.z));
        for (int k = 0; k < 3; k++) {
            b[k] = measure_of(body->radius);
            b[Y_VELOCITY + k] = measure_of(speed);
            b[Y_VELOCITY + 3 + k] = measure_of(moment * speed / body->radius);
        }
        b += Y_PER_BODY;
    }
}

/* Static bodies' states are left as they are. */
void imp_motion_unpack(const imp_motion *motion, const double *y, imp_state *states)
{
    const double *b = y + Y_BODIES;
    for (int i = 0; i < motion->world->body_count; i++) {
        if (motion->world->bodies[i].is_static) continue;
        imp_state *s = &states[i];
        s->x = (qvec3){b[0], b[1], b[2]};
        quat_normalize((quat){b[3], b[4], b[5], b[6]}, &s->q);
        s->v = (qvec3){b[7], b[8], b[9]};
        s->momentum = (qvec3){b[10], b[11], b[12]};
        b += Y_PER_BODY;
    }
    for (int p = 0; p < motion->world->pair_count; p++) {
        imp_pair *pair = &motion->world->pairs[p];
        if (!imp_spot_suits(motion->world, pair)) continue;
        if (imp_is_carried(pair)) memcpy(pair->footing.spot, b, sizeof pair->footing.spot);
        if (pair->footing.on == IMP_FOOT_FLAT) imp_flat_level(motion->world, pair, states);
        if (pair->footing.on == IMP_FOOT_LINE) imp_line_level(motion->world, pair, states);
        b += Y_PER_SPOT;
    }
}

/* How far a contact's slip is to slow the clock: what next to nothing presses changes nothing, and need never die out.
 */
static double rubbing(const imp_held *held, int contact)
{
    const double least = 0.01; /* of the greatest pressure */
    double most = 0;
    for (int c = 0; c < held->count; c++) most = fmax(most, fabs(held->contacts[c].pressure));
    const double pressure = fabs(held->contacts[contact].pressure);
    return pressure < least * most ? pressure / (least * most) : 1;
}

static bool slip_slows_clock(const imp_motion *motion) { return motion->sliding && motion->ode != motion->dop853; }

/* dt/dtau. */
double imp_motion_clock(const imp_motion *motion)
{
    double slowness = 1;
    for (int c = 0; c < motion->held.count && motion->following; c++)
        if (imp_held_contact_is_followed(&motion->held.contacts[c]))
            slowness = hypot(slowness, motion->held.contacts[c].point_speed / motion->point_speed_scale);
    for (int c = 0; c < motion->held.count && slip_slows_clock(motion); c++)
        if (motion->held.contacts[c].mode == IMP_SLIDE && !motion->held.contacts[c].incipient &&
            motion->held.contacts[c].friction > 0)
            slowness += rubbing(&motion->held, c) * motion->slip_scale / motion->held.contacts[c].speed;
    return 1 / slowness;
}

/* Under the load and, where contacts are held, what the reactions do. */
static void body_rates(const imp_body *body, const imp_state *s, const imp_load *load, const imp_effect *effect,
                       double clock, double *rate)
{
    const imp_effect none = {{0, 0, 0}, {0, 0, 0}};
    if (!effect) effect = &none;
    const qvec3 a = qvec3_axpy(body->inverse_mass, load->force, effect->linear);
    const qvec3 torque = qvec3_add(load->torque, imp_inertia(body, s->q, effect->angular));
    const qvec3 omega = imp_omega(body, s);
    const quat turning = quat_mul((quat){0, omega.x, omega.y, omega.z}, s->q);
    const double values[Y_PER_BODY] = {
        s->v.x, s->v.y, s->v.z, 0.5 * turning.w, 0.5 * turning.x, 0.5 * turning.y, 0.5 * turning.z,
        a.x,    a.y,    a.z,    torque.x,        torque.y,        torque.z};
    for (int k = 0; k < Y_PER_BODY; k++) rate[k] = clock * values[k];
}

/* Of the contacts that are carried, in the order of their pairs, as the contacts are. */
static void spot_rates(const imp_motion *motion, double clock, double *rate)
{
    const imp_world *world = motion->world;
    for (int p = 0, c = 0; p < world->pair_count; p++) {
        const imp_held_contact *contact = imp_is_held(&world->pairs[p]) ? &motion->held.contacts[c++] : NULL;
        if (!imp_spot_suits(world, &world->pairs[p])) continue;
        for (int k = 0; k < Y_PER_SPOT; k++)
            *rate++ = contact && imp_held_contact_is_followed(contact) ? clock * contact->spot_rate[k] : 0;
    }
}

/* What is still is balanced by its reactions. */
static void clear_still_loads(imp_motion *motion)
{
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        if (!contact->still) continue;
        motion->loads[contact->body1].force = motion->loads[contact->body1].torque =
            motion->loads[contact->body2].force = motion->loads[contact->body2].torque = (qvec3){0, 0, 0};
    }
}

int imp_motion_rates(double tau, const double *y, double *rate, void *context)
{
    imp_motion *motion = context;
    imp_world *world = motion->world;
    imp_motion_unpack(motion, y, motion->scratch);
    if (!imp_motion_load(motion, imp_motion_clocked(motion) ? y[Y_TIME] : tau, motion->scratch)) return -1;
    rate[Y_FORCE_WORK] = rate[Y_DAMPING] = rate[Y_SLIDING] = 0;
    for (int i = 0; i < world->body_count; i++) {
        rate[Y_FORCE_WORK] += motion->loads[i].work_rate;
        rate[Y_DAMPING] += motion->loads[i].damping_rate;
    }
    if (motion->held.count > 0) imp_held_solve(&motion->held, world, motion->scratch, motion->loads);
    for (int c = 0; c < motion->held.count; c++)
        if (motion->held.contacts[c].mode == IMP_SLIDE && motion->held.contacts[c].friction > 0)
            rate[Y_SLIDING] -= qvec3_dot(motion->held.contacts[c].force, motion->held.contacts[c].slip);
    clear_still_loads(motion);
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        imp_line_brace(world, contact, motion->scratch, &motion->loads[contact->body1]);
    }
    const double clock = imp_motion_clock(motion);
    rate[Y_TIME] = clock;
    for (int k = Y_FORCE_WORK; k < Y_BODIES; k++) rate[k] *= clock;
    double *b = rate + Y_BODIES;
    for (int i = 0; i < world->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        body_rates(&world->bodies[i], &motion->scratch[i], &motion->loads[i],
                   motion->held.count > 0 ? &motion->held.effects[i] : NULL, clock, b);
        b += Y_PER_BODY;
    }
    spot_rates(motion, clock, b);
    if (world->driven) rate[imp_motion_drive(motion)] = clock * imp_held_drive_power(&motion->held, world);
    return 0;
}

/* ---- roots: every one falls through zero when its event comes ---- */

double imp_motion_speed(const imp_body *body, const imp_state *state)
{
    return qvec3_norm(state->v) + body->radius * qvec3_norm(imp_omega(body, state));
}

static void held_pair_roots(imp_world *world, const imp_held_contact *contact, const imp_state *states,
                            const imp_load *loads, double *value)
{
    const impact_contact met = {.offset2 = contact->r2};
    value[0] = contact->still ? 1 : contact->pressure;
    value[1] = contact->still               ? 1
               : contact->mode == IMP_STICK ? contact->margin
               : contact->friction == 0     ? 1 /* slip neither begins nor ends */
               : contact->incipient         ? contact->hold - (1 - IMP_HOLD_ROUNDING)
                                            : contact->speed - world->slip_speed;
    const imp_pair *pair = &world->pairs[contact->pair];
    value[2] = pair->site.corner > 0 ? imp_corner_clearance(world, pair, states) - pair->site.sunk +
                                           0.5 * imp_world_touching_distance(world, pair, states)
                                     : imp_world_inside_bounds(world, pair, states, &met);
    if (!isfinite(value[2])) value[2] = 1;
    if (contact->foot == IMP_FOOT_FLAT) value[2] = fmin(value[2], contact->spare);
    if (contact->foot == IMP_FOOT_LINE) value[2] = fmin(value[2], imp_line_spare(world, contact, states, loads));
}

/* A custom force's edge may answer anything. */
static bool edges_are_finite(imp_motion *motion, double t, const double *value, int count)
{
    for (int k = 0; k < count; k++) {
        if (isfinite(value[k])) continue;
        snprintf(motion->message, sizeof motion->message, "the edge of a custom force is not finite at t = %s",
                 imp_number_of(t).text);
        return false;
    }
    return true;
}

int imp_motion_root_values(double tau, const double *y, double *value, void *context)
{
    imp_motion *motion = context;
    imp_world *world = motion->world;
    imp_state *states = motion->scratch;
    imp_motion_unpack(motion, y, states);
    if (motion->held.count > 0) {
        if (!imp_motion_load(motion, imp_motion_clocked(motion) ? y[Y_TIME] : tau, states)) return -1;
        imp_held_solve(&motion->held, world, states, motion->loads);
    }
    for (int p = 0, c = 0; p < world->pair_count; p++, value += ROOTS_PER_PAIR) {
        value[2] = 1;
        if (imp_is_held(&world->pairs[p]))
            held_pair_roots(world, &motion->held.contacts[c++], states, motion->loads, value);
        else
            value[0] = value[1] = 1; /* found by search.h */
    }
    const int edges = ROOTS_PER_EDGE * imp_field_edge_count(world);
    const double t = imp_motion_clocked(motion) ? y[Y_TIME] : tau;
    imp_field_edges(world, t, states, value);
    if (!edges_are_finite(motion, t, value, edges)) return -1;
    value += edges;
    const bool wakes = imp_field_unsteady(world);
    for (int i = 0; i < world->body_count; i++) {
        value[i] = 1;
        if (world->bodies[i].is_static) continue;
        const double speed = imp_motion_speed(&world->bodies[i], &states[i]);
        value[i] = !motion->resting[i] ? speed - motion->rest_speed : wakes ? 2 * motion->rest_speed - speed : 1;
    }
    return 0;
}
