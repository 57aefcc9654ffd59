/* SPDX-License-Identifier: MIT
 *
 * Conservative advancement. From a time at which the gap is g, with normal n, let m = R^T n be that normal in the axes
 * of a body, m' and m'' its rates there, h the support function, r the bounding radius and j >= |m'''| for the whole
 * flight. As h is convex and subadditive,
 *
 *     psi(T) = g + n.v T + min(0, n.a) T^2/2 - sum over the bodies [h(m + m' T) - h(m) + h(m'') T^2/2 + r j T^3/6]
 *
 * (m towards the other body) is concave and never more than the gap T later: psi(T) >= 0 proves that there is no
 * contact until then. The steps to the zero of psi converge quadratically and never pass the contact. toi.c does the
 * same where omega is constant.
 */
#include "motion/motion_meet.h"
#include "motion/psi.h"
#include "motion/segment.h"
#include "world/world_gap.h"

#include <impact/flight.h>
#include <string.h>

/* ---- one body ---- */

void imp_flyer_board(imp_flyer *flyer, const imp_body *body, const imp_state *state)
{
    if (memcmp(&flyer->now, state, sizeof *state) == 0) return;
    *flyer = (imp_flyer){.start = *state, .now = *state};
    if (body->is_static || qvec3_norm(state->momentum) == 0) return;
    const double mean = body->moments.x;
    const qvec3 moments = body->spherical ? (qvec3){mean, mean, mean} : body->moments;
    impact_tumble_make(moments, state->q, state->momentum, &flyer->tumble);
    flyer->turns = !imp_is_ball(body);
    if (flyer->turns) flyer->jerk = imp_segment_tumble_jerk(&flyer->tumble);
}

void imp_flyer_leave(imp_flyer *flyer) { flyer->now.q.w = NAN; }

imp_state imp_flyer_at(const imp_flyer *flyer, const imp_body *body, qvec3 gravity, double dt)
{
    imp_state state = flyer->start;
    if (body->is_static) return state;
    const double t = flyer->elapsed + dt;
    state.x = qvec3_axpy(t, qvec3_axpy(0.5 * t, gravity, state.v), state.x);
    state.v = qvec3_axpy(t, gravity, state.v);
    if (flyer->tumble.moments.x > 0) state.q = impact_tumble_at(&flyer->tumble, t);
    return state;
}

/* ---- psi ---- */

static void add_flyer(imp_psi *p, const imp_body *body, const imp_flyer *flyer, const imp_state *state, qvec3 towards)
{
    if (!flyer->turns) return;
    imp_turning *b = &p->body[p->count++];
    b->body = body;
    b->m = quat_rotate_inverse(state->q, towards);
    const qvec3 momentum = quat_rotate_inverse(state->q, state->momentum), i = body->inverse_moments;
    const qvec3 omega = {momentum.x * i.x, momentum.y * i.y, momentum.z * i.z};
    const qvec3 torque = qvec3_cross(momentum, omega), spin_up = {torque.x * i.x, torque.y * i.y, torque.z * i.z};
    b->rate = qvec3_cross(b->m, omega);
    const qvec3 second = qvec3_add(qvec3_cross(b->rate, omega), qvec3_cross(b->m, spin_up));
    qvec3 point;
    b->h = imp_world_support(body, b->m, &point);
    p->slope -= qvec3_dot(b->rate, point);
    p->spread += body->radius * qvec3_norm(second);
    if (qvec3_norm(second) > 0) p->bend += imp_world_support(body, second, &point);
    p->jerk += body->radius * flyer->jerk;
}

/* ---- far away: bounding balls ---- */

/* Nothing can happen before this: of two bodies that fall alike, which move in a straight line to each other; of a
 * body and a plane. The balls are a little too large, so that the time is never late. */
static double balls_fly_until(const imp_world *world, const imp_pair *pair, const imp_state *states)
{
    const double larger = 1e-6;
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const bool plane = b2->shape.kind == IMPACT_PLANE;
    const double reach = b1->radius + (plane ? 0 : b2->radius);
    const double bound = imp_world_distance_bound(world, pair, states) - larger * reach;
    if (!(bound > 0) || pair->beyond) return 0;
    if (plane) {
        const qvec3 n = quat_rotate(states[pair->body2].q, (qvec3){0, 0, 1});
        return impact_flight_fall_time(bound, qvec3_dot(n, states[pair->body1].v), qvec3_dot(n, world->gravity));
    }
    if (b2->is_static) return 0;
    const qvec3 d = qvec3_sub(states[pair->body1].x, states[pair->body2].x);
    const qvec3 v = qvec3_sub(states[pair->body1].v, states[pair->body2].v);
    const double speed = qvec3_norm(v), along = -qvec3_dot(d, v) / speed, aside = qvec3_norm(qvec3_cross(d, v)) / speed;
    const double edge = reach * (1 + larger), half = sqrt((edge - aside) * (edge + aside)); /* of the chord */
    return along > 0 && aside <= edge ? bound * (qvec3_norm(d) + edge) / (along + half) / speed : INFINITY;
}

/* ---- advancement ---- */

/* A rate of the gap that only rounding makes. */
static double flyers_still_rate(const imp_world *world, const imp_pair *pair, const imp_flyer *flyers,
                                const imp_state *states)
{
    double speed = 0;
    for (int k = 0; k < 2; k++) {
        const int i = k ? pair->body2 : pair->body1;
        if (!flyers[i].turns) continue;
        const imp_body *body = &world->bodies[i];
        speed += qvec3_norm(states[i].v) + body->radius * qvec3_norm(imp_omega(body, &states[i]));
    }
    return imp_still_rate(world, speed);
}

static bool either_turns(const imp_pair *pair, const imp_flyer *flyers)
{
    return flyers[pair->body1].turns || flyers[pair->body2].turns;
}

/* A step over which the gap cannot fall to zero; of bodies that do not turn, the one in which the parabola along the
 * normal does. */
static double flight_step_before(const imp_world *world, const imp_pair *pair, const imp_flyer *flyers,
                                 const imp_state *states, const impact_contact *contact, double gap, double limit)
{
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const qvec3 n = contact->normal;
    const double speed = qvec3_dot(n, qvec3_sub(s1->v, s2->v));
    const double pull = b2->is_static ? qvec3_dot(n, world->gravity) : 0;
    if (!either_turns(pair, flyers)) return impact_flight_fall_time(gap, speed, pull);
    imp_psi p = {.gap = gap, .speed = speed, .slope = speed, .bend = fmax(0, -pull)};
    add_flyer(&p, b1, &flyers[pair->body1], s1, qvec3_neg(n));
    add_flyer(&p, b2, &flyers[pair->body2], s2, n);
    return imp_psi_safe_step(&p, fmin(limit, impact_flight_fall_time(p.gap, p.slope, -p.bend)));
}

/* Behind a plane, a step over which the gap cannot rise to zero: its normal is fixed and -h concave, below its
 * tangents. */
static double flight_step_behind(const imp_world *world, const imp_pair *pair, const imp_flyer *flyers,
                                 const imp_state *states, const impact_contact *contact)
{
    const qvec3 n = contact->normal;
    const double deep = fmax(0, -contact->gap), pull = qvec3_dot(n, world->gravity);
    imp_psi p = {.slope = qvec3_dot(n, states[pair->body1].v)};
    add_flyer(&p, &world->bodies[pair->body1], &flyers[pair->body1], &states[pair->body1], qvec3_neg(n));
    const double bend = p.count > 0 ? fmax(0, pull) + p.spread : pull;
    double low = 0, high = impact_flight_fall_time(deep, -p.slope, -bend);
    if (p.jerk == 0) return high;
    high = fmin(high, 2 * fmax(cbrt(6 * deep / p.jerk), fmax(sqrt(6 * fmax(0, -p.slope) / p.jerk), 0)));
    for (int i = 0; i < 100 && high > low * (1 + 1e-9); i++) {
        const double T = 0.5 * (low + high);
        *(T * (p.slope + T * (0.5 * bend + T * p.jerk / 6)) < deep ? &low : &high) = T;
    }
    return low;
}

imp_meeting_time imp_motion_meet(imp_world *world, imp_pair *pair, const imp_flyer *flyers, imp_state *states,
                                 double horizon)
{
    enum { STEPS = 2000 };
    const imp_meeting_time never = {INFINITY, false};
    const int body[2] = {pair->body1, pair->body2};
    for (int k = 0; k < 2; k++) states[body[k]] = flyers[body[k]].now;
    const double touching = imp_world_touching_distance(world, pair, states);
    double dt = balls_fly_until(world, pair, states);
    bool leaving = false;
    for (int i = 0; i < STEPS && dt <= horizon; i++) {
        for (int k = 0; k < 2; k++)
            states[body[k]] = imp_flyer_at(&flyers[body[k]], &world->bodies[body[k]], world->gravity, dt);
        impact_contact contact;
        imp_world_gap(world, pair, states, &contact);
        double step, gap = contact.lower;
        if (pair->beyond) {
            step = flight_step_behind(world, pair, flyers, states, &contact);
        } else {
            const double rate = imp_world_gap_rate(world, pair, states, &contact);
            const bool still = fabs(rate) <= flyers_still_rate(world, pair, flyers, states);
            if (dt == 0) leaving = fabs(gap) <= pair->slack && (still || (rate > 0 && either_turns(pair, flyers)));
            leaving = leaving && gap <= touching;
            const double rounding = IMP_GAP_ROUNDING * imp_world_place_scale(world, pair, states);
            if (leaving) gap += pair->slack;
            if (gap <= rounding && (dt > 0 || rate < 0)) return (imp_meeting_time){dt, true};
            if (dt >= horizon) return never;
            step = flight_step_before(world, pair, flyers, states, &contact, gap, horizon - dt);
        }
        if (!(dt + step <= horizon)) return never;
        if (dt + step == dt) return (imp_meeting_time){dt, true};
        dt += step;
    }
    return dt <= horizon ? (imp_meeting_time){dt, false} : never;
}
