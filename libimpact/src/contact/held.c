/* SPDX-License-Identifier: MIT
 *
 * With n the normal, u the relative velocity of the contact points and u' its rate along the moving contact:
 *   held:    d2(gap)/dt2 = n . u' + n' . u = 0
 *   rolling: u' = 0
 *   sliding: tangential force = -friction pressure u_t/|u_t|
 * and u' = bias + K (reactions), linear: see held_system.
 */
#include "contact/held_flat.h"
#include "contact/held_line.h"
#include "contact/held_spot.h"
#include "contact/held_system.h"
#include "contact/rates.h"
#include "world/corner.h"
#include "world/world_gap.h"

#include <stdlib.h>
#include <string.h>

/* What is but rounding of a direction is none. */
static double beside(double part) { return fabs(part) > IMP_LEVEL ? part : 0; }

/* The carried contact's place begins where the orientation puts it: of a flat place that looks down but for rounding,
 * which would lead to some corner of it, in its middle. */
static void place_spot(imp_world *world, imp_pair *pair, const imp_state *states)
{
    const qvec3 n = quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1});
    const imp_body *body = &world->bodies[pair->body1];
    const qvec3 outward = quat_rotate_inverse(imp_shape_axes(body, &states[pair->body1]), qvec3_neg(n));
    imp_spot_find(&body->shape, (qvec3){beside(outward.x), beside(outward.y), beside(outward.z)}, pair->footing.spot);
    pair->footing.on = IMP_FOOT_SPOT;
}

impact_status imp_held_reserve(imp_held *held, imp_world *world, const imp_state *states)
{
    int count = 0;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        count += imp_is_held(pair);
        if (imp_is_carried(pair) && !imp_is_held(pair)) pair->footing.on = IMP_FOOT_POINT;
        if (imp_is_carried(pair) && !imp_flat_lies(world, pair, states) && !imp_line_lies(world, pair, states))
            pair->footing.on = IMP_FOOT_SPOT;
        if (imp_is_held(pair) && !imp_is_carried(pair) && imp_spot_suits(world, pair)) place_spot(world, pair, states);
    }
    held->count = count;
    return imp_held_make_room(held, count, world->body_count);
}

/* ---- geometry ---- */

/* Where nothing but the axis of a line is flat the orientation tells the spot as well as the spot itself: it is led
 * back there. */
static bool orientation_tells(const imp_pair *pair, const impact_shape *shape)
{
    const double p[3] = {shape->r, shape->s, shape->t};
    for (int i = 0; i < 3; i++)
        if (p[i] > 2 && !(pair->footing.on == IMP_FOOT_LINE && pair->footing.line == i)) return false;
    return true;
}

/* A carried contact moves over body 1 as its spot does; the plane's normal stays. */
static void carried_rates(const imp_world *world, imp_held_contact *contact, const imp_state *states,
                          const imp_spot *spot, qvec3 *rate1)
{
    const imp_body *b1 = &world->bodies[contact->body1];
    const imp_state *s1 = &states[contact->body1];
    const quat q = imp_shape_axes(b1, s1);
    const qvec3 omega = imp_omega(b1, s1);
    qvec3 turn = qvec3_cross(spot->normal, quat_rotate_inverse(q, omega));
    if (orientation_tells(&world->pairs[contact->pair], &b1->shape))
        turn = qvec3_axpy(qvec3_norm(omega),
                          qvec3_sub(quat_rotate_inverse(q, qvec3_neg(contact->normal)), spot->normal), turn);
    if (imp_line_lies(world, &world->pairs[contact->pair], states)) contact->foot = IMP_FOOT_LINE;
    if (contact->foot == IMP_FOOT_LINE) turn = imp_line_turn(&world->pairs[contact->pair], turn);
    const imp_spot_rate rate = imp_spot_move(&b1->shape, spot, turn);
    memcpy(contact->spot_rate, rate.s, sizeof rate.s);
    contact->point_speed = rate.point_speed;
    *rate1 = qvec3_add(qvec3_cross(omega, contact->r1), quat_rotate(q, rate.point_rate));
}

/* The contact of a plane with the spot of body 1 that is carried along. */
static impact_contact carried_contact(const imp_world *world, const imp_pair *pair, const imp_state *states,
                                      imp_spot *spot)
{
    const imp_body *b1 = &world->bodies[pair->body1];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    impact_contact contact = {.normal = quat_rotate(s2->q, (qvec3){0, 0, 1})};
    *spot = imp_spot_at(&b1->shape, pair->footing.spot);
    contact.offset1 = qvec3_add(imp_shape_offset(b1, s1), quat_rotate(imp_shape_axes(b1, s1), spot->point));
    contact.offset2 = qvec3_add(qvec3_sub(s1->x, s2->x), contact.offset1);
    contact.gap = qvec3_dot(contact.normal, contact.offset2);
    contact.offset2 = qvec3_axpy(-contact.gap, contact.normal, contact.offset2);
    return contact;
}

imp_held_contact imp_held_meet(const imp_world *world, int p, const impact_contact *contact)
{
    const imp_pair *pair = &world->pairs[p];
    return (imp_held_contact){.pair = p,
                              .body1 = pair->body1,
                              .body2 = pair->body2,
                              .mode = pair->mode,
                              .friction = pair->law.friction,
                              .normal = contact->normal,
                              .r1 = contact->offset1,
                              .r2 = contact->offset2};
}

imp_held_contact imp_held_contact_at(imp_world *world, int p, const imp_state *states, const imp_load *loads)
{
    imp_pair *pair = &world->pairs[p];
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const bool carried = imp_is_held(pair) && imp_is_carried(pair);
    if (carried && imp_flat_lies(world, pair, states)) return imp_flat_contact(world, p, states, loads);
    impact_contact met;
    imp_spot spot;
    imp_rates rates = {.normal = {0, 0, 0}};
    if (pair->site.corner > 0)
        met = imp_corner_contact(world, pair, states, &rates.arm1);
    else if (carried)
        met = carried_contact(world, pair, states, &spot);
    else
        imp_world_gap(world, pair, states, &met);
    imp_held_contact contact = imp_held_meet(world, p, &met);
    contact.foot = carried ? IMP_FOOT_SPOT : IMP_FOOT_POINT;
    contact.still = imp_is_held(pair) && pair->rest.still;
    const qvec3 u = qvec3_sub(imp_point_velocity(b1, s1, contact.r1), imp_point_velocity(b2, s2, contact.r2));
    contact.slip = qvec3_axpy(-qvec3_dot(u, contact.normal), contact.normal, u);
    contact.speed = qvec3_norm(contact.slip);
    contact.incipient = pair->mode == IMP_SLIDE && imp_is_incipient(pair);
    contact.direction =
        contact.incipient || contact.speed == 0 ? pair->slip.direction : qvec3_scale(contact.slip, 1 / contact.speed);
    if (carried)
        carried_rates(world, &contact, states, &spot, &rates.arm1);
    else if (!(pair->site.corner > 0))
        rates = imp_contact_rates(world, pair, pair->site.placed ? pair->site.bearer : IMP_BORNE_BY_BOTH, &met, states);
    if (b2->driven) rates.arm2 = qvec3_add(s1->v, rates.arm1); /* its centre stands still */
    contact.normal_rate = rates.normal;
    contact.bias = qvec3_sub(imp_point_acceleration(b1, s1, &loads[pair->body1], contact.r1, rates.arm1),
                             imp_point_acceleration(b2, s2, &loads[pair->body2], contact.r2, rates.arm2));
    return contact;
}

void imp_held_find_contacts(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads)
{
    int c = 0;
    for (int p = 0; p < world->pair_count; p++)
        if (imp_is_held(&world->pairs[p])) held->contacts[c++] = imp_held_contact_at(world, p, states, loads);
}

/* ---- reactions ---- */

void imp_held_add_reactions(const imp_held *held, imp_load *loads)
{
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        imp_load *l1 = &loads[contact->body1], *l2 = &loads[contact->body2];
        if (contact->still) {
            l1->force = l1->torque = l2->force = l2->torque = (qvec3){0, 0, 0};
            continue;
        }
        l1->force = qvec3_add(l1->force, contact->force);
        l1->torque = qvec3_add(l1->torque, qvec3_cross(contact->r1, contact->force));
        l2->force = qvec3_sub(l2->force, contact->force);
        l2->torque = qvec3_sub(l2->torque, qvec3_cross(contact->r2, contact->force));
    }
}

double imp_held_own_acceleration(const imp_held *held, const imp_world *world, const imp_state *states, int pair)
{
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (contact->pair == pair)
            return qvec3_dot(contact->normal, imp_system_response(world, states, contact, contact, contact->force));
    }
    return 0;
}

/* ---- constraints put back ---- */

static void close_gap(imp_world *world, imp_pair *pair, const impact_contact *contact, imp_state *states)
{
    const double w1 = world->bodies[pair->body1].inverse_mass, w2 = world->bodies[pair->body2].inverse_mass;
    imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    s1->x = qvec3_axpy(-contact->gap * w1 / (w1 + w2), contact->normal, s1->x);
    s2->x = qvec3_axpy(contact->gap * w2 / (w1 + w2), contact->normal, s2->x);
}

/* Turns body 1 so that the plane's normal stands where the carried contact is: what the integration's tolerance left
 * between them. */
static void align(const imp_world *world, const imp_pair *pair, imp_state *states, const imp_spot *spot)
{
    imp_state *s1 = &states[pair->body1];
    const qvec3 down = quat_rotate(states[pair->body2].q, (qvec3){0, 0, -1});
    const quat q = imp_shape_axes(&world->bodies[pair->body1], s1);
    const qvec3 turn = qvec3_cross(quat_rotate(q, spot->normal), down);
    quat_normalize(quat_mul(quat_from_rotation_vector(turn), s1->q), &s1->q);
}

/* Lays a carried contact on the plane: its body is all that moves, along the normal. */
static impact_contact close_carried(imp_world *world, imp_pair *pair, imp_state *states)
{
    const bool flat = pair->footing.on == IMP_FOOT_FLAT;
    imp_spot spot = imp_spot_at(&world->bodies[pair->body1].shape, pair->footing.spot);
    if (flat)
        imp_flat_level(world, pair, states);
    else
        align(world, pair, states, &spot);
    if (pair->footing.on == IMP_FOOT_LINE) imp_line_level(world, pair, states);
    impact_contact contact = carried_contact(world, pair, states, &spot);
    if (!flat) close_gap(world, pair, &contact, states);
    contact.gap = 0;
    return contact;
}

/* Where the held contacts are, and the displacements that close their gaps. One alone is closed along its normal: the
 * gap is linear in that, and where a body is all but flat its place would go far with the least turn. */
static void find_gaps(imp_held *held, imp_world *world, imp_state *states)
{
    int c = 0;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        if (!imp_is_held(pair)) continue;
        impact_contact contact;
        if (imp_is_carried(pair))
            contact = close_carried(world, pair, states);
        else if (pair->site.placed)
            contact = pair->site.contact;
        else
            imp_world_gap(world, pair, states, &contact);
        if (held->count == 1) close_gap(world, pair, &contact, states), contact.gap = 0;
        held->contacts[c] = imp_held_meet(world, p, &contact);
        held->contacts[c].still = pair->rest.still;
        held->contacts[c++].wanted = qvec3_scale(contact.normal, -contact.gap);
    }
}

static void displace(const imp_held *held, const imp_world *world, imp_state *states)
{
    for (int i = 0; i < world->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        const imp_effect *effect = &held->effects[i];
        states[i].x = qvec3_add(states[i].x, effect->linear);
        if (qvec3_norm(effect->angular) > 0)
            quat_normalize(quat_mul(quat_from_rotation_vector(effect->angular), states[i].q), &states[i].q);
    }
}

void imp_held_close_gaps(imp_held *held, imp_world *world, imp_state *states)
{
    find_gaps(held, world, states);
    if (held->count == 1) return;
    imp_system_solve(held, world, states, false);
    displace(held, world, states);
}

void imp_held_project(imp_held *held, imp_world *world, imp_state *states, const imp_load *loads)
{
    if (held->count == 0) return;
    for (int round = 0; round < IMP_HELD_ROUNDS; round++) imp_held_close_gaps(held, world, states);
    imp_held_project_velocities(held, world, states, loads);
}

/* Whether what puts the velocities back is far more than what is put back: a contact sticks beside another that holds
 * the same place but for roundings, and would hold the body from turning about it by that arm. */
static bool levers(const imp_held *held, const imp_world *world)
{
    double wanted = 0, given = 0;
    for (int c = 0; c < held->count; c++) wanted = fmax(wanted, qvec3_norm(held->contacts[c].wanted));
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static)
            given = fmax(given, world->bodies[i].radius * qvec3_norm(held->effects[i].angular));
    return given > IMP_PUT_BACK_BY * wanted;
}

void imp_held_find_stop(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads)
{
    imp_held_find_contacts(held, world, states, loads);
    for (int c = 0; c < held->count; c++) {
        imp_held_contact *contact = &held->contacts[c];
        contact->wanted =
            qvec3_neg(qvec3_axpy(imp_held_approach(world, contact, states), contact->normal, contact->slip));
    }
    imp_system_solve(held, world, states, false);
}

void imp_held_project_velocities(imp_held *held, imp_world *world, imp_state *states, const imp_load *loads)
{
    imp_held_find_stop(held, world, states, loads);
    if (levers(held, world)) {
        for (int c = 0; c < held->count; c++) held->contacts[c].mode = IMP_SLIDE;
        imp_system_solve(held, world, states, false); /* along normals alone */
    }
    imp_system_apply(held, world, states);
}

/* ---- modes ---- */

qvec3 imp_against_friction(const imp_held_contact *contact)
{
    const qvec3 friction = qvec3_axpy(-contact->pressure, contact->normal, contact->force);
    const double size = qvec3_norm(friction);
    return size > 0 ? qvec3_scale(friction, -1 / size) : imp_tangent(contact->normal);
}

void imp_held_begin_slide(imp_pair *pair, const imp_held_contact *contact)
{
    pair->mode = IMP_SLIDE;
    pair->slip = (imp_sliding){.stage = pair->law.friction > 0 ? IMP_SLIP_INCIPIENT : IMP_SLIP_GROSS,
                               .direction = imp_against_friction(contact)};
}

double imp_held_approach(const imp_world *world, const imp_held_contact *contact, const imp_state *states)
{
    const impact_contact met = {.normal = contact->normal, .offset1 = contact->r1, .offset2 = contact->r2};
    return imp_world_gap_rate(world, &world->pairs[contact->pair], states, &met);
}

double imp_held_drive_power(const imp_held *held, const imp_world *world)
{
    double power = 0;
    for (int c = 0; c < held->count && world->driven; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (world->bodies[contact->body2].driven)
            power += qvec3_dot(contact->force, imp_surface_velocity(&world->bodies[contact->body2], contact->r2));
    }
    return power;
}
