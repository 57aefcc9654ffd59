/* SPDX-License-Identifier: MIT */
#include "world_gap.h"
#include "persist.h"

impact_status impact_world_gap(impact_world *world, impact_pair *pair, const impact_state *states,
                               impact_contact *contact)
{
    const impact_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const impact_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const impact_solid solid1 = impact_solid_of(b1, s1), solid2 = impact_solid_of(b2, s2);
    const impact_status status = impact_gap(&solid1, &solid2, &pair->cache, contact);
    contact->offset1 = qvec3_add(contact->offset1, impact_shape_offset(b1, s1));
    contact->offset2 = qvec3_add(contact->offset2, impact_shape_offset(b2, s2));
    switch (contact->path) {
    case IMPACT_PATH_CLOSED_FORM: world->usage.gap_closed_form++; break;
    case IMPACT_PATH_NEWTON: world->usage.gap_newton++; break;
    case IMPACT_PATH_GJK: world->usage.gap_gjk++; break;
    case IMPACT_PATH_FALLBACK: world->usage.gap_fallback++; break;
    case IMPACT_PATH_NONE: break;
    }
    return status;
}

double impact_world_support(const impact_body *body, qvec3 direction, qvec3 *point)
{
    if (!body->shifted) return impact_shape_support(&body->shape, direction, point);
    const double h = impact_shape_support(&body->shape, quat_rotate_inverse(body->turn, direction), point);
    *point = qvec3_add(body->offset, quat_rotate(body->turn, *point));
    return h + qvec3_dot(direction, body->offset);
}

static qvec3 omega_of(const impact_world *world, const impact_state *states, int body)
{
    return impact_omega(&world->bodies[body], &states[body]);
}

double impact_world_gap_rate(const impact_world *world, const impact_pair *pair, const impact_state *states,
                             const impact_contact *contact)
{
    return impact_gap_rate(contact, states[pair->body1].v, omega_of(world, states, pair->body1), states[pair->body2].v,
                           omega_of(world, states, pair->body2));
}

double impact_world_approach(const impact_world *world, const impact_touch *touch, const impact_state *states)
{
    const impact_contact contact = {.normal = touch->normal, .offset1 = touch->r1, .offset2 = touch->r2};
    return impact_world_gap_rate(world, &world->pairs[touch->pair], states, &contact);
}

double impact_world_reach(const impact_world *world, const impact_pair *pair, const impact_state *states)
{
    return qvec3_norm(states[pair->body1].x) + world->bodies[pair->body1].radius;
}

double impact_world_touching_distance(const impact_world *world, const impact_pair *pair, const impact_state *states)
{
    return 1e-12 * impact_world_reach(world, pair, states);
}

double impact_world_distance_bound(const impact_world *world, const impact_pair *pair, const impact_state *states)
{
    const impact_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const qvec3 d = qvec3_sub(states[pair->body1].x, states[pair->body2].x);
    if (b2->shape.kind == IMPACT_PLANE)
        return qvec3_dot(quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1}), d) - b1->radius;
    return qvec3_norm(d) - b1->radius - b2->radius;
}

double impact_world_distance_bound_rate(const impact_world *world, const impact_pair *pair, const impact_state *states)
{
    const qvec3 v = qvec3_sub(states[pair->body1].v, states[pair->body2].v);
    if (world->bodies[pair->body2].shape.kind == IMPACT_PLANE)
        return qvec3_dot(quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1}), v);
    const qvec3 d = qvec3_sub(states[pair->body1].x, states[pair->body2].x);
    return qvec3_dot(d, v) / qvec3_norm(d);
}

double impact_world_inside_bounds(const impact_world *world, const impact_pair *pair, const impact_state *states,
                                  const impact_contact *contact)
{
    const impact_shape *shape = &world->bodies[pair->body2].shape;
    if (shape->kind != IMPACT_PLANE) return INFINITY;
    const qvec3 local = quat_rotate_inverse(states[pair->body2].q, contact->offset2);
    return fmin(shape->a - fabs(local.x), shape->b - fabs(local.y));
}

double impact_world_kinetic_energy(const impact_world *world, const impact_state *states)
{
    double energy = 0;
    for (int i = 0; i < world->body_count; i++) {
        const impact_body *body = &world->bodies[i];
        if (body->is_static) continue;
        energy += 0.5 * body->mass * qvec3_dot(states[i].v, states[i].v) +
                  0.5 * qvec3_dot(states[i].momentum, impact_omega(body, &states[i]));
    }
    return energy;
}
