/* SPDX-License-Identifier: MIT */
#include "scene/scene_meeting.h"
#include "contact/points.h"
#include "world/world_gap.h"

#include <string.h>

impact_status imp_scene_load(imp_island *island)
{
    if (imp_motion_load(&island->motion, island->t, island->states)) return IMPACT_OK;
    memcpy(island->scene->message, island->motion.message, sizeof island->motion.message);
    return IMPACT_EDOMAIN;
}

impact_status imp_scene_load_with_reactions(imp_island *island)
{
    imp_held *held = &island->motion.held;
    impact_status status = imp_held_reserve(held, &island->world, island->states);
    if (status == IMPACT_OK) status = imp_scene_load(island);
    if (status != IMPACT_OK || held->count == 0) return status;
    imp_held_solve(held, &island->world, island->states, island->motion.loads);
    imp_held_add_reactions(held, island->motion.loads);
    return IMPACT_OK;
}

bool imp_scene_meets(imp_island *island, int p, imp_meeting *m)
{
    imp_world *world = &island->world;
    imp_pair *pair = &world->pairs[p];
    if (pair->mode == IMP_BEYOND ||
        imp_world_distance_bound(world, pair, island->states) > world->bodies[pair->body1].radius)
        return false;
    impact_contact contact;
    imp_world_gap(world, pair, island->states, &contact);
    m->touching = imp_world_touching_distance(world, pair, island->states);
    if (!imp_is_held(pair) &&
        (contact.gap > m->touching || imp_world_inside_bounds(world, pair, island->states, &contact) < 0))
        return false;
    m->contact = imp_held_meet(world, p, &contact);
    m->velocity = imp_held_approach(world, &m->contact, island->states);
    m->own = imp_held_own_acceleration(&island->motion.held, world, island->states, p);
    m->pressed = m->jams = false;
    return true;
}

void imp_scene_press(imp_island *island, imp_meeting *m)
{
    if (m->pressed) return;
    m->contact = imp_held_contact_at(&island->world, m->contact.pair, island->states, island->motion.loads);
    m->acceleration =
        qvec3_dot(m->contact.normal, m->contact.bias) + qvec3_dot(m->contact.normal_rate, m->contact.slip) - m->own;
    m->pressed = true;
}

/* Of what is no larger than 1e150, which all but overflows otherwise. */
static double length(qvec3 v) { return sqrt(qvec3_dot(v, v)); }

/* No acceleration presses two bodies together for longer than this: about edges and over faces the normal turns fast,
 * but not for long. Surfaces rounder than a thousandth of the body press no more. The loads hold the pair's own
 * reaction, which its acceleration does not. */
static double most_lasting_press(const imp_island *island, const imp_meeting *m)
{
    const int body[2] = {m->contact.body1, m->contact.body2};
    const imp_state *states = island->states;
    double speed = length(qvec3_sub(states[body[0]].v, states[body[1]].v)), pull = fabs(m->own), radius = INFINITY;
    for (int k = 0; k < 2; k++) {
        const imp_body *b = &island->world.bodies[body[k]];
        const imp_load *l = &island->motion.loads[body[k]];
        if (b->is_static) continue;
        speed += b->radius * length(imp_omega(b, &states[body[k]]));
        pull += length(l->force) * b->inverse_mass;
        pull += b->radius * length(imp_inverse_inertia(b, states[body[k]].q, l->torque));
        radius = fmin(radius, b->radius);
    }
    return pull + speed * speed / (IMP_ROUNDEST_PRESS * radius);
}

/* How high the pair's bounce has to rise to be one, m. A corner's bounce brings down the body's others, and these bring
 * it down: how many follow its own restitution does not tell. */
static double least_rise(const imp_island *island, const imp_meeting *m)
{
    enum { MOST = 10 };
    const imp_pair *pair = &island->world.pairs[m->contact.pair];
    const double own = 1 / (1 - pair->law.restitution * pair->law.restitution),
                 gain = imp_pair_has_faces(&island->world, pair) ? MOST : own;
    return fmax(island->scene->rest_height, m->touching * fmin(gain, MOST));
}

bool imp_scene_leaves_for_good(const imp_island *island, const imp_meeting *m, double speed)
{
    return speed > 0 && speed * speed >= 2 * most_lasting_press(island, m) * least_rise(island, m);
}

bool imp_scene_dies_out(imp_island *island, imp_meeting *m, double speed)
{
    if (imp_scene_leaves_for_good(island, m, fabs(speed))) return false;
    imp_scene_press(island, m);
    if (!(m->acceleration < 0)) return false;
    const double press = fmin(-m->acceleration, most_lasting_press(island, m));
    return speed * speed < 2 * press * least_rise(island, m);
}

/* ---- an impact of the pair ---- */

impact_collider imp_scene_collider(const imp_island *island, int body, qvec3 offset)
{
    const imp_body *b = &island->world.bodies[body];
    const imp_state *s = &island->states[body];
    if (b->is_static) return (impact_collider){b->mass, b->moments, s->q, offset, b->drift, b->spin};
    return (impact_collider){b->mass, b->moments, s->q, offset, s->v, imp_omega(b, s)};
}

/* One whose bounce would die out is solved with restitution 0: it then exchanges, at once, the whole impulse of the
 * infinitely many bounces that would follow, less what the pressing force brings while they last: the sum m w (1 + e)(1
 * + e + ...) - m |a| T with T = 2 e w/(|a| (1 - e)) is m w. */
impact_collision imp_scene_collision(imp_island *island, imp_meeting *m)
{
    const double restitution = island->world.pairs[m->contact.pair].law.restitution;
    const bool dies = !m->jams && imp_scene_dies_out(island, m, restitution * m->velocity);
    const imp_held_contact *contact = &m->contact;
    return (impact_collision){.body = {imp_scene_collider(island, contact->body1, contact->r1),
                                       imp_scene_collider(island, contact->body2, contact->r2)},
                              .normal = contact->normal,
                              .friction = contact->friction,
                              .restitution = dies ? 0 : restitution,
                              .law = island->scene->law,
                              .pressed = m->jams,
                              .solver = island->scene->methods.impacts,
                              .tangential_compliance = island->scene->compliance,
                              .workspace = island->scene->workspace};
}

void imp_scene_set_velocities(imp_island *island, int i, qvec3 velocity, qvec3 omega)
{
    const imp_body *body = &island->world.bodies[i];
    imp_state *state = &island->states[i];
    if (body->is_static) return;
    state->v = velocity;
    state->momentum = imp_inertia(body, state->q, omega);
}

/* A static body's drive does work with the impulse on body 1, which gets its momentum from outside. */
double imp_scene_drive_impulse(imp_island *island, const imp_held_contact *contact, qvec3 impulse)
{
    const imp_body *other = &island->world.bodies[contact->body2];
    const double work = qvec3_dot(impulse, imp_surface_velocity(other, contact->r2));
    island->motion.works.drive += work;
    if (other->is_static) imp_island_push(island, impulse);
    return work;
}

void imp_scene_gain(imp_island *island, double works)
{
    island->gained += works;
    island->world.usage.impacts_gaining++;
}
