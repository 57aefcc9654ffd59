/* SPDX-License-Identifier: MIT
 *
 * Contact A slides at u_n = 0, the contacts H beside it are held: H's reactions answer a pressure at A so that they
 * stay held, each as it slides or rolls. With F the response of the bodies alone, f_A = n - mu e,
 *
 *     H r_H = -F_HA,      d(u_n)/d(lambda) = n . (F_AA + F_AH r_H)
 *
 * Under zero each pressure makes the need for it greater: with stiff springs at A and H, whatever their ratios, the
 * determinant of that response times those of H alone is the sign that a real exponent of growth takes.
 */
#include "scene/scene_drawn.h"
#include "base/tolerances.h"
#include "collide/collide_tangential.h"
#include "contact/held_system.h"

#include <float.h>
#include <string.h>

/* Whether another held contact has one of the contact's bodies that move. */
static bool is_held_elsewhere(const imp_world *world, const imp_held_contact *contact)
{
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        const int body[2] = {pair->body1, pair->body2};
        if (p == contact->pair || !imp_is_held(pair)) continue;
        for (int k = 0; k < 2; k++)
            if (!world->bodies[body[k]].is_static && (body[k] == contact->body1 || body[k] == contact->body2))
                return true;
    }
    return false;
}

/* Whether friction makes no normal velocity of the body's point: it stands in line with the centre. */
static bool is_in_line(const imp_body *body, qvec3 arm, qvec3 normal)
{
    return body->is_static || qvec3_norm(qvec3_cross(arm, normal)) <= 4 * DBL_EPSILON * qvec3_norm(arm);
}

static bool both_in_line(const imp_world *world, const imp_held_contact *contact)
{
    return is_in_line(&world->bodies[contact->body1], contact->r1, contact->normal) &&
           is_in_line(&world->bodies[contact->body2], contact->r2, contact->normal);
}

/* ---- the pair alone ---- */

static bool draws(imp_island *island, imp_meeting *m)
{
    const imp_world *world = &island->world;
    const imp_held_contact *contact = &m->contact;
    if (!(contact->friction > 0) || fabs(m->velocity) > world->slip_speed || island->scene->compliance > 0)
        return false;
    if (both_in_line(world, contact) || is_held_elsewhere(world, contact)) return false;
    imp_scene_press(island, m);
    if (!(contact->speed > world->slip_speed) || contact->foot >= IMP_FOOT_FLAT) return false;
    const impact_collision collision = imp_scene_collision(island, m);
    return imp_collide_draws(&collision);
}

/* What of its acceleration may be rounding of the loads, m/s^2: of bodies that fall together it is all. */
static double rounding_of_loads(const imp_island *island, const imp_meeting *m)
{
    const int body[2] = {m->contact.body1, m->contact.body2};
    double sum = 0;
    for (int k = 0; k < 2; k++)
        sum += qvec3_norm(island->motion.loads[body[k]].force) * island->world.bodies[body[k]].inverse_mass;
    return IMP_PRESSED_OF_LOADS * sum;
}

bool imp_scene_jams(imp_island *island, imp_meeting *m)
{
    return draws(island, m) && m->acceleration < -rounding_of_loads(island, m);
}

bool imp_scene_lifts(imp_island *island, imp_meeting *m)
{
    return draws(island, m) && m->acceleration > rounding_of_loads(island, m);
}

/* ---- with contacts beside it ---- */

static void ask_contacts(const imp_island *island, imp_held *held, const imp_held_contact *contact, qvec3 force)
{
    for (int c = 0; c < held->count; c++) {
        imp_held_contact *beside = &held->contacts[c];
        beside->still = beside->turning = false;
        beside->force = (qvec3){0, 0, 0};
        beside->wanted = qvec3_neg(imp_system_response(&island->world, island->states, beside, contact, force));
    }
}

/* d(u_n)/d(lambda) of the contact `own`, without it among those that answer; of what it would be without them. Held
 * between two walls neither of its contacts moves along its normal: all that is told then is rounding. */
static double response_of(imp_island *island, int own)
{
    imp_held *held = &island->motion.held;
    const imp_held_contact contact = held->contacts[own];
    const qvec3 force = qvec3_axpy(-contact.friction, contact.direction, contact.normal);
    held->contacts[own] = held->contacts[--held->count];
    ask_contacts(island, held, &contact, force);
    imp_system_solve(held, &island->world, island->states, true);
    const qvec3 alone = imp_system_response(&island->world, island->states, &contact, &contact, force),
                change = qvec3_add(alone, imp_system_change(held, &contact));
    return qvec3_dot(contact.normal, change) / qvec3_norm(alone);
}

/* Let go, a contact whose pressure is lambda would go at -response lambda: drawn on and pressed it has lambda < 0. */
static bool may_be_drawn(const imp_island *island, const imp_held_contact *contact)
{
    const imp_world *world = &island->world;
    if (contact->mode != IMP_SLIDE || contact->incipient || contact->foot >= IMP_FOOT_FLAT || !(contact->friction > 0))
        return false;
    return contact->speed > world->slip_speed && is_held_elsewhere(world, contact);
}

/* The first of what is held that is drawn on, of pairs after that one; -1: none. */
static int find_drawn(imp_island *island, int after, imp_held_contact *kept)
{
    imp_held *held = &island->motion.held;
    const int count = held->count;
    const size_t bytes = sizeof *kept * (size_t)count;
    int found = -1;
    memcpy(kept, held->contacts, bytes);
    for (int c = 0; c < count && found < 0; c++) {
        if (kept[c].pair <= after || !may_be_drawn(island, &kept[c])) continue;
        if (response_of(island, c) < -IMP_TOUCHING) found = c;
        memcpy(held->contacts, kept, bytes);
        held->count = count;
    }
    return found;
}

impact_status imp_scene_find_drawn(imp_island *island, int after, int *pair, bool *jams)
{
    const imp_held *held = &island->motion.held;
    *pair = -1;
    imp_held_contact *kept = imp_arena_take_unset(island->world.arena, (size_t)held->count, sizeof *kept);
    if (!kept) return IMPACT_ENOMEM;
    const int found = find_drawn(island, after, kept);
    if (found >= 0) *pair = kept[found].pair, *jams = kept[found].pressure < 0;
    imp_arena_give(island->world.arena, kept);
    return IMPACT_OK;
}
