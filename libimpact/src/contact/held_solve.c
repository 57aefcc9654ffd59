/* SPDX-License-Identifier: MIT
 *
 * The reactions of held contacts: the linear system, and the directions of slip that begins from rest.
 */
#include "contact/held_system.h"

#include <math.h>

/* What the reactions leave of each contact's tangential acceleration, and how far its friction is from the cone. */
static void finish_contacts(imp_held *held)
{
    for (int a = 0; a < held->count; a++) {
        imp_held_contact *contact = &held->contacts[a];
        const qvec3 rate = qvec3_add(contact->bias, imp_system_change(held, contact));
        contact->slip_rate = qvec3_axpy(-qvec3_dot(rate, contact->normal), contact->normal, rate);
        const qvec3 tangential = qvec3_axpy(-contact->pressure, contact->normal, contact->force);
        contact->margin = contact->friction * contact->pressure - qvec3_norm(tangential);
    }
}

/* Where they are not unique, next to those that the pairs remember. */
static void solve_reactions(imp_held *held, const imp_world *world, const imp_state *states)
{
    for (int c = 0; c < held->count; c++) {
        imp_held_contact *contact = &held->contacts[c];
        contact->force = world->pairs[contact->pair].rest.reaction;
        contact->wanted =
            qvec3_neg(qvec3_axpy(qvec3_dot(contact->normal_rate, contact->slip), contact->normal, contact->bias));
    }
    imp_system_solve(held, world, states, true);
    finish_contacts(held);
}

/* The unit vector d and the least k >= 0 of (A + k) d = b, for A symmetric and positive definite, in two dimensions: k
 * by Newton on 1/|d(k)| = 1, which is concave and increasing, from k = 0. *hold = |A^-1 b|; below 1 there is no k: d
 * is then A^-1 b/hold. */
static void secular(double a11, double a12, double a22, double b1, double b2, double *d1, double *d2, double *hold)
{
    double k = 0;
    *hold = 0;
    for (int i = 0; i < 60; i++) {
        const double p = a11 + k, q = a22 + k, determinant = p * q - a12 * a12;
        *d1 = (q * b1 - a12 * b2) / determinant;
        *d2 = (p * b2 - a12 * b1) / determinant;
        const double size = hypot(*d1, *d2);
        if (i == 0) *hold = size;
        const double e1 = (q * *d1 - a12 * *d2) / determinant, e2 = (p * *d2 - a12 * *d1) / determinant;
        const double step = (size - 1) * size * size / (*d1 * e1 + *d2 * e2);
        *d1 /= size, *d2 /= size;
        if (!(step > IMP_SECULAR_STEP * (p + q))) return;
        k += step;
    }
}

/* Slip that begins from rest goes the way it is accelerated, slip_rate || direction, until it is fast enough to have a
 * direction of its own. The direction in which it does, with the pressure and the other contacts' forces as they are;
 * sets the contact's hold. */
static qvec3 incipient_direction(const imp_world *world, const imp_state *states, imp_held_contact *contact)
{
    const qvec3 t1 = imp_tangent(contact->normal), t2 = qvec3_cross(contact->normal, t1);
    const double grip = contact->friction * contact->pressure;
    const qvec3 k1 = imp_system_response(world, states, contact, contact, qvec3_scale(t1, grip));
    const qvec3 k2 = imp_system_response(world, states, contact, contact, qvec3_scale(t2, grip));
    const double a11 = qvec3_dot(t1, k1), a12 = qvec3_dot(t1, k2), a22 = qvec3_dot(t2, k2);
    const double x = qvec3_dot(t1, contact->direction), y = qvec3_dot(t2, contact->direction);
    const double b1 = qvec3_dot(t1, contact->slip_rate) + a11 * x + a12 * y,
                 b2 = qvec3_dot(t2, contact->slip_rate) + a12 * x + a22 * y;
    contact->hold = 0;
    if (!(grip > 0) || (b1 == 0 && b2 == 0)) return contact->direction;
    double d1, d2;
    secular(a11, a12, a22, b1, b2, &d1, &d2, &contact->hold);
    return qvec3_axpy(d1, t1, qvec3_scale(t2, d2));
}

static bool has_incipient(const imp_held *held)
{
    for (int c = 0; c < held->count; c++)
        if (held->contacts[c].incipient) return true;
    return false;
}

/* ---- one contact after another: slow, but from anywhere ---- */

/* Turns every incipient slip's direction to where it goes; the most that one turned. */
static double turn_each(imp_held *held, const imp_world *world, const imp_state *states)
{
    double turned = 0;
    for (int c = 0; c < held->count; c++) {
        imp_held_contact *contact = &held->contacts[c];
        if (!contact->incipient) continue;
        const qvec3 before = contact->direction;
        contact->direction = incipient_direction(world, states, contact);
        turned = fmax(turned, qvec3_norm(qvec3_sub(contact->direction, before)));
    }
    return turned;
}

/* Solves with all directions as they are, and turns them, so often; the most that one turned last. */
static double turn_in_turns(imp_held *held, const imp_world *world, const imp_state *states, int turns)
{
    double turned = INFINITY;
    for (int c = 0; c < held->count; c++) held->contacts[c].turning = false;
    for (int k = 0; k < turns && turned >= IMP_ONSET_TURNED; k++) {
        solve_reactions(held, world, states);
        turned = turn_each(held, world, states);
    }
    return turned;
}

/* ---- all together: Newton's method ---- */

/* What slip's acceleration is to friction: how its direction holds against being turned. */
static double mobility_of(const imp_held_contact *contact)
{
    const double grip = contact->friction * contact->pressure;
    return grip > 0 ? qvec3_dot(contact->direction, contact->slip_rate) / grip : 0;
}

/* Takes the direction that was solved for; returns what the linear step left undone. */
static double take_turn(const imp_world *world, imp_held_contact *contact)
{
    const qvec3 across = qvec3_cross(contact->normal, contact->direction);
    const double turn = fmax(-0.5, fmin(0.5, contact->turn)), before = contact->mobility, size = hypot(1, turn);
    contact->direction = qvec3_axpy(turn / size, across, qvec3_scale(contact->direction, 1 / size));
    contact->mobility = mobility_of(contact);
    const double response = world->bodies[contact->body1].inverse_mass + world->bodies[contact->body2].inverse_mass;
    return fabs(contact->turn) * (fabs(contact->turn) + fabs(contact->mobility - before) / response);
}

/* From the directions and mobilities as they are; false where it does not converge. */
static bool turn_together(imp_held *held, const imp_world *world, const imp_state *states)
{
    enum { STEPS = 12 };
    for (int k = 0; k < STEPS; k++) {
        double left = 0;
        for (int c = 0; c < held->count; c++)
            held->contacts[c].turning = held->contacts[c].incipient && held->contacts[c].friction > 0;
        solve_reactions(held, world, states);
        for (int c = 0; c < held->count; c++)
            if (held->contacts[c].turning) left = fmax(left, take_turn(world, &held->contacts[c]));
        if (left < IMP_ONSET_LEFT) return true;
        if (!(left < IMP_ONSET_FAR)) return false;
    }
    return false;
}

/* ---- both ---- */

/* Begins where slip went when it was last solved for; false where one of them begins anew. */
static bool recall_turns(imp_held *held, const imp_world *world)
{
    bool all = true;
    for (int c = 0; c < held->count; c++) {
        imp_held_contact *contact = &held->contacts[c];
        if (!contact->incipient) continue;
        const imp_pair *pair = &world->pairs[contact->pair];
        const qvec3 d =
            qvec3_axpy(-qvec3_dot(pair->slip.direction, contact->normal), contact->normal, pair->slip.direction);
        contact->direction = qvec3_scale(d, 1 / qvec3_norm(d));
        contact->mobility = pair->slip.mobility;
        all = all && pair->slip.stage == IMP_SLIP_TURNED;
    }
    return all;
}

static void keep_turns(const imp_held *held, imp_world *world)
{
    for (int c = 0; c < held->count; c++) {
        imp_held_contact contact = held->contacts[c];
        if (!contact.incipient) continue;
        imp_pair *pair = &world->pairs[contact.pair];
        pair->slip =
            (imp_sliding){.stage = IMP_SLIP_TURNED, .direction = contact.direction, .mobility = contact.mobility};
    }
}

/* Sets the hold of every incipient slip; whether all of them go on sliding. Newton's method also finds directions
 * against which slip would be accelerated: none of Coulomb's. */
static bool hold_incipient(imp_held *held, const imp_world *world, const imp_state *states)
{
    bool all = true;
    for (int c = 0; c < held->count; c++) {
        imp_held_contact *contact = &held->contacts[c];
        if (!contact->incipient) continue;
        incipient_direction(world, states, contact);
        all = all && contact->hold >= 1 - IMP_HOLD_ROUNDING;
    }
    return all;
}

/* Without knowledge of where slip went. */
static bool solve_anew(imp_held *held, imp_world *world, const imp_state *states)
{
    enum { TRIES = 4, FEW = 5, MANY = 50 };
    for (int k = 0; k < TRIES; k++) {
        recall_turns(held, world);
        if (turn_in_turns(held, world, states, FEW << k) < IMP_ONSET_TURNED) return true;
        for (int c = 0; c < held->count; c++) held->contacts[c].mobility = mobility_of(&held->contacts[c]);
        if (turn_together(held, world, states)) return true;
    }
    recall_turns(held, world);
    return turn_in_turns(held, world, states, MANY) < IMP_ONSET_TURNED;
}

/* The directions of slip that begins, and all reactions with them. */
static void solve_incipient(imp_held *held, imp_world *world, const imp_state *states)
{
    bool settled = recall_turns(held, world) && turn_together(held, world, states);
    bool good = settled && hold_incipient(held, world, states);
    if (!good) {
        settled = solve_anew(held, world, states);
        good = settled && hold_incipient(held, world, states);
    }
    if (good) keep_turns(held, world);
}

void imp_held_solve(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads)
{
    imp_held_find_contacts(held, world, states, loads);
    if (has_incipient(held))
        solve_incipient(held, world, states);
    else
        solve_reactions(held, world, states);
}
