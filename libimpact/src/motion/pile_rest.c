/* SPDX-License-Identifier: MIT */
#include "motion/pile_parts.h"
#include "base/tolerances.h"

#include <string.h>

/* Whether a static body's surface moves along under what touches it with friction. */
static bool is_dragged(const imp_pile_contacts *touching, const imp_world *world, double rest_speed)
{
    for (int k = 0; world->driven && k < touching->count; k++) {
        const imp_pile_point *point = &touching->points[k];
        const imp_body *under = &world->bodies[point->contact.body2];
        const imp_pair *pair = &world->pairs[point->pair];
        if (under->driven && pair->law.friction > 0 &&
            qvec3_norm(imp_surface_velocity(under, point->contact.arm2)) > rest_speed)
            return true;
        if (imp_is_turned(world, pair)) return true;
    }
    return false;
}

/* What counts as motion, m/s: the rest speed, or more where a fall of the bodies' own size is so fast that what
 * residuals are accepted leaves more of it. In other units the same pile comes to rest at the same step. */
static double least_motion(const imp_world *world, const imp_state *states, double rest_speed)
{
    return fmax(rest_speed, IMP_PILE_RESTS * imp_pile_smallest(world) / imp_pile_natural_time(world, states));
}

static bool is_touched(const imp_pile_contacts *touching, int body)
{
    for (int k = 0; k < touching->count; k++) {
        const imp_cone_contact *contact = &touching->points[k].contact;
        if (contact->body1 == body || contact->body2 == body) return true;
    }
    return false;
}

/* Points that touch, without reactions yet. */
static bool remember_points(imp_pile *pile)
{
    const imp_pile_contacts *touching = &pile->touching;
    pile->memory[0].count = 0;
    for (int k = 0; k < touching->count; k++)
        if (!imp_pile_remember(pile->arena, &pile->memory[0], &touching->points[k])) return false;
    return true;
}

/* The reactions that balance the loads of those that were gathered last. */
static void remember_rest(imp_pile *pile, int count)
{
    for (int c = 0; c < count; c++) {
        imp_pile_memory *m = &pile->memory[0].list[pile->members[c]];
        m->reaction = imp_pile_from_parts(&pile->contacts[c], &pile->r[pile->width * c], 1);
        if (pile->width > 3) m->moment = imp_pile_from_parts(&pile->contacts[c], &pile->r[pile->width * c + 3], 1);
    }
}

/* Reactions that balance the loads may be such as no load makes: a box that just fits between two walls. Whether the
 * loads make what holds it, as far as that is told. */
static bool holds_by_loads(imp_pile *pile, const imp_world *world, const imp_state *states, int count)
{
    const size_t size = sizeof *states * (size_t)world->body_count;
    memcpy(pile->middle, states, size);
    if (!imp_pile_may_balance(pile, world, count)) return true;
    memcpy(pile->end, states, size);
    for (int i = 0; i < world->body_count; i++) pile->end[i].v = pile->end[i].momentum = (qvec3){0, 0, 0};
    imp_pile_add_loads(world, pile->loads, 1, pile->end);
    imp_cone_contact_velocities(world, pile->end, pile->contacts, count, pile->q);
    const imp_pile_question question = {.count = count, .usable = IMP_PILE_USABLE};
    const imp_cone_outcome outcome = imp_pile_yield(pile, &question);
    if (outcome.status == IMP_CONE_BAD || !(outcome.residual <= IMP_PILE_USABLE)) return true;
    double left = 0;
    for (int i = 0; i < 3 * count; i++) left = fmax(left, fabs(pile->u[i]));
    return left <= IMP_PILE_USABLE * imp_pile_fastest(pile, count);
}

impact_status imp_pile_rests(imp_pile *pile, imp_world *world, double t, const imp_state *states, double rest_speed,
                             bool *rests)
{
    imp_pile_contacts *touching = &pile->touching;
    *rests = false;
    if (!imp_pile_reserve_bodies(pile, world)) return IMPACT_ENOMEM;
    const double least = least_motion(world, states, rest_speed);
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        if (qvec3_norm(states[i].v) + body->radius * qvec3_norm(imp_omega(body, &states[i])) > least) return IMPACT_OK;
    }
    if (!imp_field_loads(world, t, states, pile->loads)) return IMPACT_OK;
    imp_pile_contacts_mark(touching, world, &pile->memory[0]);
    if (!imp_pile_find_points(touching, world, states, NULL, 0, imp_pile_slack(pile, world), false))
        return IMPACT_ENOMEM;
    imp_pile_recall(touching, world, states, 0, &pile->memory[0]);
    imp_pile_place_friction(touching, world, &pile->memory[0], NULL, 0);
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static && !is_touched(touching, i)) return IMPACT_OK;
    if (is_dragged(touching, world, least)) return IMPACT_OK;
    const int closed = touching->count;
    if (!imp_pile_reserve_contacts(pile, world, closed) || !imp_rest_reserve(&pile->rest, closed, world->body_count))
        return IMPACT_ENOMEM;
    if (!remember_points(pile)) return IMPACT_ENOMEM;
    for (int count; (count = imp_pile_gather_island(pile, world)) > 0;) {
        const imp_cone_lengths *lengths = pile->width > 3 ? pile->lengths : NULL;
        const imp_rest_outcome outcome = imp_rest_solve(world, states, pile->contacts, pile->friction, lengths, count,
                                                        pile->loads, &pile->rest, pile->r, pile->velocities);
        if (outcome.status != IMP_REST_RESTS) return IMPACT_OK;
        remember_rest(pile, count);
        if (!holds_by_loads(pile, world, states, count)) return IMPACT_OK;
    }
    *rests = true;
    return IMPACT_OK;
}
