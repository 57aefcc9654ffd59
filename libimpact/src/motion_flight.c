/* SPDX-License-Identifier: MIT
 *
 * Flight in closed form: uniform gravity, on bodies whose turning does not move their surface or who do not turn.
 */
#include "motion.h"
#include "world_gap.h"

#include <impact/flight.h>

static impact_state fly(const impact_world *world, int i, const impact_state *start, double dt)
{
    const impact_body *body = &world->bodies[i];
    if (body->is_static) return *start;
    const impact_flight flight = {start->x, start->q, start->v, impact_omega(body, start)};
    const impact_flight end = impact_flight_after(flight, world->gravity, dt);
    return (impact_state){end.position, end.orientation, end.velocity, start->momentum};
}

/* Time until the pair's gap falls to zero (or, beyond a plane's bounds, until it rises to it), or infinity. With the normal held fixed
 * the gap of two bodies that do not turn is bounded below by a parabola, which each step falls down: no contact can be missed, and
 * against a plane the first step is exact. */
static double time_to_contact(impact_motion *motion, impact_pair *pair, const impact_state *start, double horizon)
{
    enum { STEPS = 200 };
    impact_world *world = motion->world;
    impact_state *states = motion->scratch;
    const double sign = pair->beyond ? -1 : 1;
    double dt = 0;
    for (int i = 0; i < STEPS; i++) {
        states[pair->body1] = fly(world, pair->body1, &start[pair->body1], dt);
        states[pair->body2] = fly(world, pair->body2, &start[pair->body2], dt);
        impact_contact contact;
        impact_world_gap(world, pair, states, &contact);
        const double rate = qvec3_dot(contact.normal, qvec3_sub(states[pair->body1].v, states[pair->body2].v));
        const double acceleration =
            world->bodies[pair->body2].is_static ? qvec3_dot(contact.normal, world->gravity) : 0;
        const bool grazes = dt == 0 && fabs(contact.gap) <= pair->slack && fabs(rate) <= world->slip_speed;
        const double gap = grazes ? pair->slack : sign * contact.gap;
        const double step = impact_flight_fall_time(gap, sign * rate, sign * acceleration);
        if (!(dt + step <= horizon)) return INFINITY;
        if (dt + step == dt) return dt;
        dt += step;
    }
    return dt;
}

impact_status impact_motion_fly(impact_motion *motion, double *t, double t_end, impact_state *states,
                                impact_sampler *sampler, impact_end *end)
{
    impact_world *world = motion->world;
    double dt = t_end - *t;
    impact_motion_set_slack(motion, states);
    *end = (impact_end){IMPACT_END_TIME, 0};
    for (int p = 0; p < world->pair_count; p++) {
        const double contact = time_to_contact(motion, &world->pairs[p], states, dt);
        if (contact > dt || (contact == dt && end->kind != IMPACT_END_TIME)) continue;
        dt = contact;
        *end = (impact_end){world->pairs[p].beyond ? IMPACT_END_RETURN : IMPACT_END_GAP, p};
    }
    const double t_event = end->kind == IMPACT_END_TIME ? t_end : *t + dt;
    world->usage.ballistic_flights++;
    while (impact_motion_sample_time(sampler) <= t_event) {
        for (int i = 0; i < world->body_count; i++)
            motion->sampled[i] = fly(world, i, &states[i], impact_motion_sample_time(sampler) - *t);
        const impact_status status =
            impact_motion_emit(motion, sampler, impact_motion_sample_time(sampler), motion->sampled);
        if (status == IMPACT_OK) continue;
        *end = (impact_end){IMPACT_END_TIME, 0};
        return status;
    }
    for (int i = 0; i < world->body_count; i++) states[i] = fly(world, i, &states[i], dt);
    *t = t_event;
    return IMPACT_OK;
}
