/* SPDX-License-Identifier: MIT */
#include "base/tolerances.h"
#include "motion/psi.h"
#include "motion/search_parts.h"
#include "world/normal.h"
#include "world/world_gap.h"

#include <impact/flight.h>

static void see_motion(const imp_search *s, double t, imp_sight *l)
{
    l->t = t;
    l->window = imp_search_end(s) - t;
    l->parabola = true;
    l->jerk = 0;
    for (int k = 0; k < 2; k++) {
        const imp_segment *segment = s->segment[k];
        l->state[k] = imp_segment_at(segment, s->body[k], t);
        l->bounds[k] = imp_segment_bounds(segment, s->body[k], t, l->window);
        l->spin[k] = imp_search_turns(s, k)
                         ? imp_segment_spin(segment, s->body[k], &l->state[k], &l->bounds[k], l->window)
                         : (imp_spin){.most = 0};
        if (imp_segment_is_parabola(segment)) continue;
        l->parabola = false;
        /* damping's acceleration keeps its direction and only falls: it bends by no more than it does now, and by
         * nothing back */
        l->jerk += segment->kind == IMP_SEGMENT_DAMPED ? 0 : l->bounds[k].jerk;
    }
    l->pull = qvec3_sub(l->bounds[0].acceleration, l->bounds[1].acceleration);
}

/* veer: the rate of `towards`, held; most: |veer| T is no more. */
static void add_turning(imp_psi *p, const imp_search *s, int k, const imp_sight *l, qvec3 towards, qvec3 veer,
                        double most)
{
    const bool veers = !imp_search_same(veer, (qvec3){0, 0, 0}), spins = imp_search_turns(s, k);
    if (!spins && !veers) return;
    const imp_body *body = s->body[k];
    const imp_spin *spin = &l->spin[k];
    imp_turning *b = &p->body[p->count++];
    b->body = body;
    b->m = quat_rotate_inverse(l->state[k].q, towards);
    const qvec3 along = veers ? quat_rotate_inverse(l->state[k].q, veer) : veer;
    b->rate = qvec3_add(qvec3_cross(b->m, spin->omega), along);
    b->second = qvec3_add(qvec3_cross(qvec3_add(b->rate, along), spin->omega), qvec3_cross(b->m, spin->rate));
    qvec3 point;
    b->h = imp_world_support(body, b->m, &point);
    p->slope -= qvec3_dot(b->rate, point);
    p->spread += body->radius * qvec3_norm(b->second);
    p->jerk += body->radius * ((1 + most) * spin->third + 3 * qvec3_norm(veer) * spin->second);
}

void imp_sight_look(const imp_search *s, double t, const impact_contact *known, imp_sight *l)
{
    see_motion(s, t, l);
    if (known)
        l->contact = *known;
    else
        imp_gap_of(s->body[0], &l->state[0], s->body[1], &l->state[1], s->gaps, s->usage, &l->contact);
    if (imp_search_is_stepped(s, 0) || imp_search_is_stepped(s, 1))
        imp_settle_normal(s->body[0], &l->state[0], s->body[1], &l->state[1], imp_stepped_flush(s->body[0], s->body[1]),
                          &l->contact);
    const qvec3 still = {0, 0, 0};
    const qvec3 omega1 = imp_omega(s->body[0], &l->state[0]);
    const qvec3 omega2 = s->body[1]->is_static ? still : imp_omega(s->body[1], &l->state[1]);
    l->rate = impact_gap_rate(&l->contact, l->state[0].v, omega1, l->state[1].v, omega2);
}

/* The centres' part of A; each damped one's falls by itself. */
static double bend_of(const imp_search *s, const imp_sight *l, qvec3 n)
{
    if (l->parabola) return -qvec3_dot(n, l->pull);
    double bend = 0, others = 0;
    for (int k = 0; k < 2; k++) {
        const double along = qvec3_dot(k ? qvec3_neg(n) : n, l->bounds[k].acceleration);
        if (s->segment[k]->kind == IMP_SEGMENT_DAMPED)
            bend += fmax(0, -along);
        else
            others += along;
    }
    const double drift = l->jerk > 0 ? l->jerk * l->window / 3 : 0;
    return bend + drift - others;
}

/* Whether the step is far less than what the gap's own rate promises. */
static bool creeps_on(const imp_sight *l, double gap, double step)
{
    return step < l->window && (l->rate >= 0 || step < IMP_CREEPING * gap / -l->rate);
}

bool imp_sight_creeps(const imp_search *s, const imp_sight *l, double gap, double step)
{
    return !imp_search_has_plane(s) && (imp_search_turns(s, 0) || imp_search_turns(s, 1)) && creeps_on(l, gap, step);
}

/* The same with a direction n + n' T that goes along: two edges stay across it, and a corner does not fall behind on
 * one. Any n' proves what it does. */
static double step_going_along(const imp_search *s, const imp_sight *l, double gap, qvec3 turned)
{
    const qvec3 n = l->contact.normal, veer = qvec3_axpy(-qvec3_dot(turned, n), n, turned);
    const double rate = qvec3_norm(veer), limit = fmin(l->window, 0.5 / rate);
    const qvec3 v = qvec3_sub(l->state[0].v, l->state[1].v), c = qvec3_sub(l->state[0].x, l->state[1].x);
    if (!(rate > 0) || !isfinite(rate)) return 0;
    const double speed = qvec3_dot(n, v) + qvec3_dot(veer, c), along = -2 * qvec3_dot(veer, v);
    imp_psi p = {.gap = gap, .speed = speed, .slope = speed};
    if (l->parabola) {
        p.bend = along - qvec3_dot(n, l->pull);
        p.jerk = 3 * fmax(0, -qvec3_dot(veer, l->pull));
    } else {
        const double most = qvec3_norm(l->bounds[0].acceleration) + qvec3_norm(l->bounds[1].acceleration);
        p.bend = along + bend_of(s, l, n);
        p.jerk = 3 * rate * (most + (l->jerk > 0 ? l->jerk * l->window : 0));
    }
    add_turning(&p, s, 0, l, qvec3_neg(n), qvec3_neg(veer), 0.5);
    add_turning(&p, s, 1, l, n, veer, 0.5);
    return imp_psi_safe_step(&p, limit);
}

/* Of such directions that which the contact's normals have a little earlier and later: where it turns on as it did, or
 * otherwise from here on, the rates of before and after tell, and their mean neither. */
static double step_veering(const imp_search *s, const imp_sight *l, double gap)
{
    const double spin = l->spin[0].most + l->spin[1].most, apart = IMP_VEERING / spin;
    if (!(spin > 0)) return 0;
    qvec3 turned[2];
    for (int k = 0; k < 2; k++) {
        const double then = k ? apart : -apart; /* as they move now: their segments may be shorter */
        const imp_state a = imp_drifted(s->body[0], &l->state[0], then),
                        b = imp_drifted(s->body[1], &l->state[1], then);
        impact_contact contact;
        imp_gap_of(s->body[0], &a, s->body[1], &b, s->gaps, s->usage, &contact);
        turned[k] = qvec3_scale(qvec3_sub(contact.normal, l->contact.normal), 1 / then);
    }
    const double step = step_going_along(s, l, gap, qvec3_scale(qvec3_add(turned[0], turned[1]), 0.5));
    if (!creeps_on(l, gap, step)) return step;
    return fmax(step, fmax(step_going_along(s, l, gap, turned[0]), step_going_along(s, l, gap, turned[1])));
}

double imp_sight_scale(const imp_search *s, const imp_sight *l)
{
    return imp_place_scale(s->body[0], l->state[0].x, s->body[1], l->state[1].x, l->contact.normal);
}

/* The step that psi allows along the contact's normal, where that leaves a gap. */
static double step_along(const imp_search *s, const imp_sight *l, double gap)
{
    const qvec3 n = l->contact.normal, none = {0, 0, 0};
    const double speed = qvec3_dot(n, qvec3_sub(l->state[0].v, l->state[1].v));
    imp_psi p = {.gap = gap, .speed = speed, .slope = speed, .bend = bend_of(s, l, n)};
    add_turning(&p, s, 0, l, qvec3_neg(n), none, 0);
    add_turning(&p, s, 1, l, n, none, 0);
    return imp_psi_safe_step(&p, l->window);
}

/* What the body reaches along n from its centre of mass. */
static double reach_of(const imp_body *body, const imp_state *state, qvec3 n)
{
    qvec3 point;
    return imp_world_support(body, quat_rotate_inverse(state->q, n), &point);
}

bool imp_sight_is_parted(const imp_search *s, double t)
{
    if (!s->axis || s->beyond || imp_search_has_plane(s) || imp_search_same(*s->axis, (qvec3){0, 0, 0})) return false;
    imp_sight l;
    see_motion(s, t, &l);
    const qvec3 n = l.contact.normal = *s->axis;
    const double gap = qvec3_dot(n, qvec3_sub(l.state[0].x, l.state[1].x)) -
                       reach_of(s->body[0], &l.state[0], qvec3_neg(n)) - reach_of(s->body[1], &l.state[1], n);
    const double touching = IMP_TOUCHING * imp_sight_scale(s, &l);
    return gap > touching && l.window > 0 && step_along(s, &l, gap - touching) >= l.window;
}

double imp_sight_step(const imp_search *s, const imp_sight *l, double gap)
{
    const qvec3 n = l->contact.normal;
    const double speed = qvec3_dot(n, qvec3_sub(l->state[0].v, l->state[1].v));
    if (l->parabola && !imp_search_turns(s, 0) && !imp_search_turns(s, 1))
        return impact_flight_fall_time(gap, speed, qvec3_dot(n, l->pull));
    const double step = step_along(s, l, gap);
    return imp_sight_creeps(s, l, gap, step) ? fmax(step, step_veering(s, l, gap)) : step;
}

double imp_sight_step_behind(const imp_search *s, const imp_sight *l)
{
    const qvec3 n = l->contact.normal;
    const double deep = fmax(0, -l->contact.gap);
    const double drift = l->jerk > 0 ? l->jerk * l->window / 3 : 0, pull = qvec3_dot(n, l->pull);
    imp_psi p = {.slope = qvec3_dot(n, l->state[0].v)};
    add_turning(&p, s, 0, l, qvec3_neg(n), (qvec3){0, 0, 0}, 0);
    const double bend = p.count > 0 || !l->parabola ? fmax(0, pull) + drift + p.spread : pull;
    double low = 0, high = impact_flight_fall_time(deep, -p.slope, -bend);
    if (p.jerk == 0) return high;
    high = fmin(high, 2 * fmax(cbrt(6 * deep / p.jerk), fmax(sqrt(6 * fmax(0, -p.slope) / p.jerk), 0)));
    for (int i = 0; i < 100 && high > low * (1 + IMP_SEARCH_BISECTED); i++) {
        const double T = 0.5 * (low + high);
        *(T * (p.slope + T * (0.5 * bend + T * p.jerk / 6)) < deep ? &low : &high) = T;
    }
    return low;
}

double imp_sight_still_rate(const imp_search *s, const imp_sight *l)
{
    double speed = 0;
    for (int k = 0; k < 2; k++)
        if (imp_search_turns(s, k)) speed += qvec3_norm(l->state[k].v) + s->body[k]->radius * l->spin[k].most;
    return s->still + IMP_STILL_OF_SPEED * speed;
}

double imp_sight_most_bend(const imp_search *s, const imp_sight *l, double window)
{
    imp_sight near = *l;
    near.window = fmin(l->window, window);
    double bend = fmax(0, bend_of(s, &near, l->contact.normal));
    for (int k = 0; k < 2; k++)
        if (imp_search_turns(s, k))
            bend += s->body[k]->radius * (l->spin[k].most * l->spin[k].most + l->spin[k].second);
    return bend;
}
