/* SPDX-License-Identifier: MIT
 *
 * The proof that nothing touches between two times, 0 and T. Where normals n0 and n1 part the bodies by g0 and g1
 * there, follow the direction n(t) that turns from one to the other at a steady rate Omega. In the axes of a body whose
 * spin is w (its rate in them W') it is d(t) = R^T n, or its opposite, and with D = Omega - w, E = |D x w|
 *
 *     d'' = R^T [D x (D x n) + (D x w) x n - w' x n]
 *     |d'''| <= E (|w| + 3 |D|) + |D|^3 + |W''| + |W'| (4 |D| + |w|).
 *
 * d(t) is the chord between its ends less the integral of Green's function, which is never negative and has the
 * integral t (T - t)/2, times d''. The support function h is convex and subadditive. So with c, v, a the centres'
 * offset and its rates, J no less than |a'|, lambda = t/T, the bodies are parted at t by at least
 *
 *     (1 - lambda) g0 + lambda g1 - lambda (1 - lambda) T^2/2 [M + L T (1 + lambda)/3],
 *     M = (n.c)'' + sum h(-d'') at time 0,   (n.c)'' = -Omega^2 n.c + 2 (Omega x n).v + n.a,
 *     L = Omega^3 |c| + 3 Omega^2 |v| + 3 Omega |a| + J + sum r |d'''|, at their largest, r the body's radius.
 *
 * With K for T^2/2 times the bracket at lambda = 1 that is never negative if sqrt(g0) + sqrt(g1) >= sqrt(K), or, as the
 * bracket times (1 - lambda) falls, if g1 is at least T^2/2 times the bracket at 0 and M >= 0. The normals are those of
 * the gap or near it, so that the bound falls short of the gap by terms of second order in T only, however steep or
 * flat the surfaces.
 */
#include "motion/search_window.h"
#include "base/tolerances.h"
#include "world/world_gap.h"

static bool is_still(qvec3 v) { return v.x == 0 && v.y == 0 && v.z == 0; }

void imp_window_open(const imp_search *s, double t, double end, imp_window *w)
{
    imp_state state[2];
    double turning = 0;
    *w = (imp_window){.of = s, .t0 = t};
    for (int k = 0; k < 2; k++) {
        w->turns[k] = imp_segment_turns(s->segment[k], s->body[k]);
        imp_form_make(&s->body[k]->shape, 1, quat_identity(), &w->form[k]);
        if (!w->turns[k]) continue;
        state[k] = imp_segment_at(s->segment[k], s->body[k], t);
        turning = fmax(turning, qvec3_norm(imp_omega(s->body[k], &state[k])));
    }
    w->longest = turning > 0 ? IMP_WINDOW_TURN / turning : INFINITY;
    w->t1 = fmin(end, t + IMP_WINDOW_LOOKS * w->longest);
    for (int k = 0; k < 2; k++) {
        const imp_segment *segment = s->segment[k];
        if (!w->turns[k] && imp_segment_is_parabola(segment)) continue;
        const imp_bounds bounds = imp_segment_bounds(segment, s->body[k], t, w->t1 - t);
        if (!imp_segment_is_parabola(segment)) w->jerk += bounds.jerk;
        if (w->turns[k]) w->spin[k] = imp_segment_spin(segment, s->body[k], &state[k], &bounds, w->t1 - t);
    }
}

void imp_instant_place(const imp_window *w, double t, imp_instant *at)
{
    const imp_search *s = w->of;
    at->t = t;
    at->sketched = false;
    for (int k = 0; k < 2; k++) {
        const imp_state *state = &at->state[k];
        at->state[k] = imp_segment_at(s->segment[k], s->body[k], t);
        at->arm[k] = imp_shape_offset(s->body[k], state);
        at->body[k] =
            (impact_solid){s->body[k]->shape, qvec3_add(state->x, at->arm[k]), imp_shape_axes(s->body[k], state)};
        at->form[k] = w->form[k];
        imp_form_turn(&at->form[k], at->body[k].orientation);
        at->omega[k] = w->turns[k] ? imp_omega(s->body[k], state) : (qvec3){0, 0, 0};
    }
    at->c = qvec3_sub(at->state[0].x, at->state[1].x);
    at->v = qvec3_sub(at->state[0].v, at->state[1].v);
}

/* What a gap along n may be for its rounding. */
static double rounding_along(const imp_window *w, const imp_instant *at, qvec3 n)
{
    const imp_search *s = w->of;
    return IMP_TOI_ROUNDING * imp_place_scale(s->body[0], at->state[0].x, s->body[1], at->state[1].x, n);
}

void imp_instant_take(const imp_window *w, imp_instant *at)
{
    const impact_contact *c = &at->contact;
    at->sketched = false;
    at->gap = c->lower;
    at->tolerance = rounding_along(w, at, c->normal);
    at->rate = impact_gap_rate(c, at->v, at->omega[0], (qvec3){0, 0, 0}, at->omega[1]);
}

void imp_instant_note(const imp_window *w, imp_instant *at)
{
    at->contact.offset1 = qvec3_add(at->contact.offset1, at->arm[0]);
    at->contact.offset2 = qvec3_add(at->contact.offset2, at->arm[1]);
    imp_instant_take(w, at);
}

bool imp_instant_sketch(const imp_window *w, qvec3 n, imp_instant *at)
{
    qvec3 offset[2];
    double gap = qvec3_dot(n, at->c);
    for (int k = 0; k < 2; k++) {
        const qvec3 outward = k ? n : qvec3_neg(n);
        const double d[3] = {outward.x, outward.y, outward.z};
        double x[3];
        imp_surface surface;
        gap -= imp_form_support_world(&at->form[k], d, x, &surface) + qvec3_dot(outward, at->arm[k]);
        offset[k] = qvec3_add(at->arm[k], (qvec3){x[0], x[1], x[2]});
    }
    if (!(gap > IMP_TOI_NEAR * rounding_along(w, at, n))) return false;
    at->contact = (impact_contact){.gap = gap, .lower = gap, .upper = INFINITY, .normal = n};
    at->contact.offset1 = offset[0], at->contact.offset2 = offset[1];
    imp_instant_take(w, at);
    at->sketched = true;
    return true;
}

/* h(d) of body k about its centre of mass, d in world axes. */
static double support(const imp_instant *at, int k, qvec3 d)
{
    const double world[3] = {d.x, d.y, d.z};
    double x[3];
    imp_surface surface;
    return is_still(d) ? 0 : imp_form_support_world(&at->form[k], world, x, &surface) + qvec3_dot(d, at->arm[k]);
}

/* Relative acceleration, and w' of what turns, world. */
static qvec3 rates_at(const imp_window *w, const imp_instant *at, qvec3 spin_rate[2])
{
    qvec3 pull[2];
    for (int k = 0; k < 2; k++) {
        const imp_body *body = w->of->body[k];
        const imp_segment *segment = w->of->segment[k];
        qvec3 torque;
        imp_segment_rates(segment, body, imp_segment_own(segment, at->t), &pull[k], &torque);
        spin_rate[k] = !w->turns[k] || w->spin[k].most_rate == 0
                           ? (qvec3){0, 0, 0}
                           : quat_rotate(at->state[k].q, imp_spin_rate(body, &at->state[k], torque));
    }
    return qvec3_sub(pull[0], pull[1]);
}

/* The bound's M and L, from the base to the end; sense: of time, 1 or -1. */
static void bends(const imp_window *w, const imp_instant *base, const imp_instant *end, double T, double sense,
                  qvec3 turn, double *M, double *L)
{
    const qvec3 n = base->contact.normal, lead = qvec3_cross(turn, n);
    const double square = qvec3_dot(turn, turn), rate = sqrt(square);
    qvec3 spin_rate[2];
    const qvec3 pull = rates_at(w, base, spin_rate);
    const double most_pull = qvec3_norm(pull) + w->jerk * T,
                 distance = fmax(qvec3_norm(base->c), qvec3_norm(end->c)) + most_pull * T * T / 8,
                 speed = fmax(qvec3_norm(base->v), qvec3_norm(end->v)) + w->jerk * T * T / 8;
    *M = -square * qvec3_dot(n, base->c) + 2 * sense * qvec3_dot(lead, base->v) + qvec3_dot(n, pull);
    *L = square * (rate * distance + 3 * speed) + 3 * rate * most_pull + w->jerk;
    for (int k = 0; k < 2; k++) {
        const imp_spin *spin = &w->spin[k];
        const qvec3 omega = qvec3_scale(base->omega[k], sense), D = qvec3_sub(turn, omega), E = qvec3_cross(D, omega),
                    bend = qvec3_add(qvec3_cross(qvec3_sub(E, spin_rate[k]), n), qvec3_cross(D, qvec3_cross(D, n)));
        const double slip = qvec3_norm(D) + spin->most_rate * T, across = qvec3_norm(E) + rate * spin->most_rate * T;
        *M += support(base, k, k ? qvec3_neg(bend) : bend);
        *L += w->of->body[k]->radius * (across * (spin->most + 3 * slip) + slip * slip * slip + spin->most_second +
                                        spin->most_rate * (4 * slip + spin->most));
    }
}

/* The steady turn that takes the unit n0 to n1 in the time T; they are less than a right angle apart. */
static qvec3 turn_between(qvec3 n0, qvec3 n1, double T)
{
    const qvec3 axis = qvec3_cross(n0, n1);
    const double sine = qvec3_norm(axis);
    return sine > 0 ? qvec3_scale(axis, atan2(sine, qvec3_dot(n0, n1)) / (sine * T)) : axis;
}

bool imp_search_link(const imp_window *w, const imp_instant *from, const imp_instant *to)
{
    const bool forward = from->gap < to->gap;
    const imp_instant *base = forward ? from : to, *end = forward ? to : from;
    const double T = to->t - from->t, g0 = fmax(0, base->gap) + base->tolerance, g1 = end->gap + base->tolerance;
    if (!(qvec3_dot(base->contact.normal, end->contact.normal) > 0)) return false;
    const qvec3 turn = turn_between(base->contact.normal, end->contact.normal, T);
    double M, L;
    bends(w, base, end, T, forward ? 1 : -1, turn, &M, &L);
    if (M >= 0 && g1 >= 0.5 * T * T * (M + L * T / 3)) return true;
    const double K = 0.5 * T * T * (M + 2 * L * T / 3);
    return K <= 0 || sqrt(g0) + sqrt(g1) >= sqrt(K);
}
