/* SPDX-License-Identifier: MIT */
#include "world/world_gap.h"
#include "base/tolerances.h"
#include "world/corner.h"
#include "world/normal.h"

void imp_count_gap(impact_gap_path path, impact_usage *usage)
{
    switch (path) {
    case IMPACT_PATH_CLOSED_FORM: usage->gap_closed_form++; break;
    case IMPACT_PATH_NEWTON: usage->gap_newton++; break;
    case IMPACT_PATH_GJK: usage->gap_gjk++; break;
    case IMPACT_PATH_FALLBACK: usage->gap_fallback++; break;
    case IMPACT_PATH_CCD: usage->gap_ccd++; break;
    case IMPACT_PATH_NONE: break;
    }
}

static impact_status gap_of(const imp_body *b1, const imp_state *s1, const imp_body *b2, const imp_state *s2,
                            impact_gap_cache *cache, imp_gaps *gaps, impact_usage *usage, impact_contact *contact)
{
    const impact_solid solid1 = imp_solid_of(b1, s1), solid2 = imp_solid_of(b2, s2);
    const bool ccd = gaps && gaps->method == IMPACT_GAP_CCD;
    const impact_status status =
        ccd ? impact_gap_ccd(&solid1, &solid2, gaps->tolerance, contact) : impact_gap(&solid1, &solid2, cache, contact);
    if (ccd && status < 0 && !gaps->failed[0]) gaps->failed[0] = b1->name, gaps->failed[1] = b2->name;
    contact->offset1 = qvec3_add(contact->offset1, imp_shape_offset(b1, s1));
    contact->offset2 = qvec3_add(contact->offset2, imp_shape_offset(b2, s2));
    imp_count_gap(contact->path, usage);
    return status;
}

static double touching(const imp_body *b1, const imp_state *s1, const imp_body *b2, const imp_state *s2, qvec3 normal)
{
    return IMP_TOUCHING * imp_place_scale(b1, s1->x, b2, s2->x, normal);
}

impact_status imp_gap_of(const imp_body *body1, const imp_state *state1, const imp_body *body2, const imp_state *state2,
                         imp_gaps *gaps, impact_usage *usage, impact_contact *contact)
{
    const impact_status status = gap_of(body1, state1, body2, state2, NULL, gaps, usage, contact);
    imp_settle_normal(body1, state1, body2, state2, touching(body1, state1, body2, state2, contact->normal), contact);
    return status;
}

double imp_gap_error(const imp_gaps *gaps, const imp_body *body1, const imp_body *body2)
{
    const bool closed = body2->shape.kind == IMPACT_PLANE || (imp_is_ball(body1) && imp_is_ball(body2));
    if (!gaps || gaps->method != IMPACT_GAP_CCD || closed) return 0;
    return gaps->tolerance * fmax(body1->radius, body2->radius);
}

impact_status imp_world_gap_within(imp_world *world, imp_pair *pair, const imp_state *states, double within,
                                   impact_contact *contact)
{
    if (pair->site.placed || pair->site.corner > 0) {
        *contact = pair->site.corner > 0 ? imp_corner_contact(world, pair, states, NULL) : pair->site.contact;
        return IMPACT_OK;
    }
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const impact_status status = gap_of(b1, s1, b2, s2, &pair->cache, world->gaps, &world->usage, contact);
    imp_settle_among(world, pair, states, fmax(within, touching(b1, s1, b2, s2, contact->normal)), contact);
    return status;
}

impact_status imp_world_gap(imp_world *world, imp_pair *pair, const imp_state *states, impact_contact *contact)
{
    return imp_world_gap_within(world, pair, states, 0, contact);
}

double imp_world_support(const imp_body *body, qvec3 direction, qvec3 *point)
{
    if (!body->shifted) return impact_shape_support(&body->shape, direction, point);
    const double h = impact_shape_support(&body->shape, quat_rotate_inverse(body->turn, direction), point);
    *point = qvec3_add(body->offset, quat_rotate(body->turn, *point));
    return h + qvec3_dot(direction, body->offset);
}

static qvec3 omega_of(const imp_world *world, const imp_state *states, int body)
{
    return imp_omega(&world->bodies[body], &states[body]);
}

double imp_world_gap_rate(const imp_world *world, const imp_pair *pair, const imp_state *states,
                          const impact_contact *contact)
{
    return impact_gap_rate(contact, states[pair->body1].v, omega_of(world, states, pair->body1), states[pair->body2].v,
                           omega_of(world, states, pair->body2));
}

/* Of a plane its normal; of others the last contact's, or before there was one the line of centres. */
static qvec3 about_normal(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    if (world->bodies[pair->body2].shape.kind == IMPACT_PLANE)
        return quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1});
    if (pair->cache.valid) return pair->cache.normal;
    const qvec3 d = qvec3_sub(states[pair->body1].x, states[pair->body2].x);
    const double distance = qvec3_norm(d);
    return distance > 0 ? qvec3_scale(d, 1 / distance) : (qvec3){1, 1, 1};
}

double imp_place_scale(const imp_body *b1, qvec3 x1, const imp_body *b2, qvec3 x2, qvec3 n)
{
    return fabs(n.x) * (fabs(x1.x) + fabs(x2.x)) + fabs(n.y) * (fabs(x1.y) + fabs(x2.y)) +
           fabs(n.z) * (fabs(x1.z) + fabs(x2.z)) + b1->radius + (isfinite(b2->radius) ? b2->radius : 0);
}

double imp_world_place_scale(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    return imp_place_scale(&world->bodies[pair->body1], states[pair->body1].x, &world->bodies[pair->body2],
                           states[pair->body2].x, about_normal(world, pair, states));
}

double imp_world_touching_distance(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    return IMP_TOUCHING * imp_world_place_scale(world, pair, states) +
           imp_gap_error(world->gaps, &world->bodies[pair->body1], &world->bodies[pair->body2]);
}

double imp_world_distance_bound(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const qvec3 d = qvec3_sub(states[pair->body1].x, states[pair->body2].x);
    if (b2->shape.kind == IMPACT_PLANE)
        return qvec3_dot(quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1}), d) - b1->radius;
    return qvec3_norm(d) - b1->radius - b2->radius;
}

static double reach_along(const imp_body *body, const imp_state *state, qvec3 direction)
{
    qvec3 place;
    if (body->shape.kind == IMPACT_PLANE) return 0; /* along its normal */
    return imp_world_support(body, quat_rotate_inverse(state->q, direction), &place);
}

double imp_world_separation(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const qvec3 n = about_normal(world, pair, states);
    return qvec3_dot(n, qvec3_sub(s1->x, s2->x)) - reach_along(&world->bodies[pair->body1], s1, qvec3_neg(n)) -
           reach_along(&world->bodies[pair->body2], s2, n);
}

double imp_world_inside_bounds(const imp_world *world, const imp_pair *pair, const imp_state *states,
                               const impact_contact *contact)
{
    const impact_shape *shape = &world->bodies[pair->body2].shape;
    if (shape->kind != IMPACT_PLANE) return INFINITY;
    const qvec3 local = quat_rotate_inverse(states[pair->body2].q, contact->offset2);
    return fmin(shape->a - fabs(local.x), shape->b - fabs(local.y));
}

double imp_world_kinetic_energy(const imp_world *world, const imp_state *states)
{
    double energy = 0;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        energy += 0.5 * body->mass * qvec3_dot(states[i].v, states[i].v) +
                  0.5 * qvec3_dot(states[i].momentum, imp_omega(body, &states[i]));
    }
    return energy;
}
