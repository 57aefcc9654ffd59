/* SPDX-License-Identifier: MIT
 *
 * A step of a pile as a segment. With s = (t - t1)/h from -1 to 0, every body's place and orientation is the quintic
 * that has the values, rates and second rates of both ends, its velocity the place's rate, its angular momentum a
 * straight line: the acceleration of a step is (v1 - v0)/h, its torque (L1 - L0)/h.
 */
#include "base/bracket.h"
#include "motion/motion_equations.h"
#include "motion/motion_pile.h"

#include <string.h>

/* y, h y' and h^2 y'' at one end. */
typedef struct jet {
    double y, first, second;
} jet;

/* c_j of sum c_j s^j: Taylor's to s^2 at s = 0, and s^3 (alpha + beta s + gamma s^2) that meets the jet at s = -1. */
static void hermite(jet from, jet to, double c[6])
{
    c[0] = to.y, c[1] = to.first, c[2] = 0.5 * to.second;
    const double a = -(from.y - (c[0] - c[1] + c[2])), e1 = from.first - (c[1] - 2 * c[2]), e2 = from.second - 2 * c[2];
    c[3] = 10 * a - 4 * e1 - 0.5 * e2;
    c[4] = 15 * a - 7 * e1 - e2;
    c[5] = 6 * a - 3 * e1 - 0.5 * e2;
}

/* One end of a body's step. */
typedef struct body_end {
    jet place[3], turn[4];
} body_end;

static jet jet_of(double y, double first, double second) { return (jet){y, first, second}; }

static body_end end_of(const imp_body *body, const imp_state *state, qvec3 acceleration, qvec3 torque, double h)
{
    const qvec3 w = imp_omega(body, state);
    const qvec3 alpha = imp_inverse_inertia(body, state->q, qvec3_sub(torque, qvec3_cross(w, state->momentum)));
    const quat q = state->q, first = quat_scale(quat_mul((quat){0, w.x, w.y, w.z}, q), 0.5 * h);
    const quat bend = quat_scale(quat_mul((quat){0, alpha.x, alpha.y, alpha.z}, q), 0.5 * h * h),
               second = quat_add(bend, quat_scale(quat_mul((quat){0, w.x, w.y, w.z}, first), 0.5 * h));
    const qvec3 x = state->x, v = qvec3_scale(state->v, h), a = qvec3_scale(acceleration, h * h);
    return (body_end){{jet_of(x.x, v.x, a.x), jet_of(x.y, v.y, a.y), jet_of(x.z, v.z, a.z)},
                      {jet_of(q.w, first.w, second.w), jet_of(q.x, first.x, second.x), jet_of(q.y, first.y, second.y),
                       jet_of(q.z, first.z, second.z)}};
}

static void put_terms(imp_dense *dense, int i, const double *c, int terms)
{
    for (int j = 0; j < dense->terms; j++) dense->c[j * dense->size + i] = j < terms ? c[j] : 0;
}

static void put_line(imp_dense *dense, int i, double from, double to)
{
    put_terms(dense, i, (double[]){to, to - from}, 2);
}

static void put_body(imp_dense *dense, int first, const imp_body *body, const imp_state *from, const imp_state *to)
{
    const double h = dense->h;
    const qvec3 acceleration = qvec3_scale(qvec3_sub(to->v, from->v), 1 / h),
                torque = qvec3_scale(qvec3_sub(to->momentum, from->momentum), 1 / h);
    const body_end a = end_of(body, from, acceleration, torque, h), b = end_of(body, to, acceleration, torque, h);
    double c[6];
    for (int k = 0; k < 3; k++) {
        hermite(a.place[k], b.place[k], c);
        put_terms(dense, first + k, c, 6);
        const double rate[5] = {c[1] / h, 2 * c[2] / h, 3 * c[3] / h, 4 * c[4] / h, 5 * c[5] / h};
        put_terms(dense, first + Y_VELOCITY + k, rate, 5);
    }
    for (int k = 0; k < 4; k++) {
        hermite(a.turn[k], b.turn[k], c);
        put_terms(dense, first + 3 + k, c, 6);
    }
    put_line(dense, first + Y_VELOCITY + 3, from->momentum.x, to->momentum.x);
    put_line(dense, first + Y_VELOCITY + 4, from->momentum.y, to->momentum.y);
    put_line(dense, first + Y_VELOCITY + 5, from->momentum.z, to->momentum.z);
}

static void put_works(imp_motion *motion, const imp_works *before)
{
    imp_dense *dense = &motion->dense;
    const imp_works *after = &motion->works;
    put_line(dense, Y_TIME, dense->t0, dense->t1);
    put_line(dense, Y_FORCE_WORK, before->force, after->force);
    put_line(dense, Y_DAMPING, before->damping, after->damping);
    put_line(dense, Y_SLIDING, before->sliding, after->sliding);
    if (motion->world->driven) put_line(dense, imp_motion_drive(motion), before->drive, after->drive);
}

static impact_status keep_pile_step(imp_motion *motion, double t0, const imp_works *before, const imp_state *from,
                                    const imp_state *to)
{
    enum { TERMS = 6 };
    imp_dense *dense = &motion->dense;
    impact_status status = imp_motion_make_room(motion);
    if (status == IMPACT_OK)
        status = imp_dense_reserve(dense, motion->world->arena, motion->size, motion->world->body_count);
    if (status != IMPACT_OK) return status;
    const double t1 = motion->stride.t;
    dense->t0 = t0, dense->t1 = dense->end = t1;
    dense->h = t1 - t0;
    dense->size = motion->size;
    dense->terms = TERMS;
    dense->clocked = dense->fixed = false;
    dense->stepped = true;
    memset(dense->c, 0, sizeof *dense->c * TERMS * (size_t)dense->size);
    put_works(motion, before);
    for (int i = 0, first = Y_BODIES; i < motion->world->body_count; i++) {
        if (motion->world->bodies[i].is_static) continue;
        put_body(dense, first, &motion->world->bodies[i], &from[i], &to[i]);
        first += Y_PER_BODY;
    }
    return IMPACT_OK;
}

/* ---- edges of forces: a step ends at the first that it meets, on its far side ---- */

/* Below zero beyond an edge that the motion was within, or without, when the step began. */
static double least_edge(const imp_world *world, double t, const imp_state *states)
{
    double least = INFINITY;
    for (int k = 0; k < imp_field_edge_count(world); k++) least = fmin(least, imp_field_edge(world, t, states, k));
    return least;
}

static impact_status step_again(imp_pile *pile, imp_world *world, double t0, double most, const imp_state *before,
                                imp_state *states, imp_pile_step_result *result)
{
    const impact_status status = imp_pile_take_back(pile);
    memcpy(states, before, sizeof *states * (size_t)world->body_count);
    return status == IMPACT_OK ? imp_pile_step(pile, world, t0, most, states, result) : status;
}

/* The step led beyond an edge: shorter ones by the rule of Illinois, until one ends there. */
static impact_status end_at_edge(imp_pile *pile, imp_world *world, double t0, const imp_state *before,
                                 imp_state *states, imp_pile_step_result *result)
{
    imp_bracket b = {.high = result->taken,
                     .at_low = least_edge(world, t0, before),
                     .at_high = least_edge(world, t0 + result->taken, states)};
    const double near = IMP_PILE_EDGE * b.high;
    impact_status status = IMPACT_OK;
    for (int k = 0; k < IMP_BRACKET_MOST && status == IMPACT_OK && b.high - b.low > near; k++) {
        const double h = fmin(fmax(imp_bracket_guess(&b), b.low + 0.5 * near), b.high - 0.5 * near);
        status = step_again(pile, world, t0, h, before, states, result);
        const double value = least_edge(world, t0 + result->taken, states);
        if (status != IMPACT_OK || (value >= 0 && result->taken < h)) return status; /* its error allows no more */
        imp_bracket_take(&b, value >= 0 ? h : result->taken, value, value < 0);
    }
    return status == IMPACT_OK ? step_again(pile, world, t0, b.high, before, states, result) : status;
}

/* So short that no edge, and nothing else of custom forces, is passed over unseen. */
static double step_limit(imp_motion *motion, double t0, const imp_state *states)
{
    imp_world *world = motion->world;
    if (world->field_count == 0 || !imp_field_loads(world, t0, states, motion->loads)) return INFINITY;
    return fmin(imp_field_step_limit(world, states, motion->loads),
                imp_field_custom_step_limit(world, states, motion->loads));
}

static impact_status next_step(imp_motion *motion, imp_pile *pile, double most, const imp_state *before,
                               imp_state *states, imp_pile_step_result *result)
{
    imp_world *world = motion->world;
    const double t0 = motion->stride.t;
    /* a step's forces are those of where and when it begins */
    imp_field_enter(world, t0);
    for (int custom = 0; custom < 2; custom++) imp_field_locate(world, t0, states, custom);
    const bool edges = imp_field_edge_count(world) > 0;
    impact_status status = world->field_count > 0 ? imp_motion_make_room(motion) : IMPACT_OK;
    if (status == IMPACT_OK && edges) status = imp_pile_keep(pile);
    if (status != IMPACT_OK) return status;
    status = imp_pile_step(pile, world, t0, fmin(most, step_limit(motion, t0, states)), states, result);
    if (status != IMPACT_OK || !edges || !(least_edge(world, t0 + result->taken, states) < 0)) return status;
    return end_at_edge(pile, world, t0, before, states, result);
}

impact_status imp_motion_next_by_steps(imp_motion *motion, imp_pile *pile, const imp_state *before, imp_state *states,
                                       imp_pile_step_result *result)
{
    imp_stride *s = &motion->stride;
    const double t0 = s->t, most = s->t_end - t0;
    const imp_works works = motion->works;
    const impact_status status = next_step(motion, pile, most, before, states, result);
    if (status != IMPACT_OK) return status;
    s->t = result->taken >= most ? s->t_end : t0 + result->taken;
    s->restart = s->t >= s->t_end;
    motion->works.force += result->force_work;
    motion->works.damping += result->damping;
    motion->works.drive += result->drive_work;
    motion->works.sliding += result->sliding;
    return keep_pile_step(motion, t0, &works, pile->from, states);
}

impact_status imp_motion_look_by_steps(imp_motion *motion, imp_pile *pile, double t, imp_state *states)
{
    const impact_usage usage = motion->world->usage;
    impact_status status = imp_motion_look(motion, t, states);
    if (status != IMPACT_OK) return status;
    if (!imp_motion_keep_contacts(motion)) return IMPACT_ENOMEM;
    status = imp_pile_part(pile, motion->world, states);
    imp_motion_restore_contacts(motion);
    motion->world->usage = usage;
    return status;
}
