/* SPDX-License-Identifier: MIT
 *
 * With impulses p at the contacts and u the relative velocities after, p_n >= 0, u_n >= 0, p_n u_n = 0, |p_t| <= mu p_n
 * and p_t . u_t <= 0 (Moreau, "Unilateral contact and dry friction in finite freedom dynamics", 1988, without
 * restitution). Then the kinetic energy changes by p . u - (p . W p)/2 <= 0.
 */
#include "contact/together.h"
#include "contact/persist_system.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static qvec3 relative_velocity(const imp_world *world, const imp_state *states, const imp_touch *touch)
{
    return qvec3_sub(imp_point_velocity(&world->bodies[touch->body1], &states[touch->body1], touch->r1),
                     imp_point_velocity(&world->bodies[touch->body2], &states[touch->body2], touch->r2));
}

static void apply(const imp_world *world, imp_state *states, const imp_touch *touch, qvec3 impulse)
{
    const int bodies[2] = {touch->body1, touch->body2};
    const qvec3 arms[2] = {touch->r1, touch->r2};
    for (int k = 0; k < 2; k++) {
        const imp_body *body = &world->bodies[bodies[k]];
        imp_state *state = &states[bodies[k]];
        if (body->is_static) continue;
        const qvec3 own = k == 0 ? impulse : qvec3_neg(impulse);
        state->v = qvec3_axpy(body->inverse_mass, own, state->v);
        state->momentum = qvec3_add(state->momentum, qvec3_cross(arms[k], own));
    }
}

/* Response of the contact to its own impulse: along the normal, and the most across it. */
static void share_response(const imp_world *world, const imp_state *states, const imp_touch *touch, double *along,
                           double *across)
{
    const qvec3 t1 = imp_tangent(touch->normal), t2 = qvec3_cross(touch->normal, t1);
    *along = qvec3_dot(touch->normal, imp_system_response(world, states, touch, touch, touch->normal));
    *across = qvec3_dot(t1, imp_system_response(world, states, touch, touch, t1)) +
              qvec3_dot(t2, imp_system_response(world, states, touch, touch, t2));
    *across *= 0.5 * (1 + 1e-12); /* exact for round bodies */
    if (!world->bodies[touch->body1].spherical || !world->bodies[touch->body2].spherical) *across *= 2;
}

/* Solves one share against the others as they are: along the normal, then across it; returns by how much velocities
 * changed. */
static double improve_share(const imp_world *world, imp_state *states, imp_share *share, double along, double across)
{
    const imp_touch *touch = &share->touch;
    const qvec3 n = touch->normal;
    const double u = qvec3_dot(n, relative_velocity(world, states, touch));
    const double normal = fmax(0, share->normal - u / along), pushed = normal - share->normal;
    if (pushed != 0) apply(world, states, touch, qvec3_scale(n, pushed));
    qvec3 tangential = qvec3_axpy(-share->normal, n, share->impulse);
    share->normal = normal;
    double rubbed = 0;
    if (touch->friction > 0) {
        const qvec3 slip = relative_velocity(world, states, touch);
        const qvec3 across_slip = qvec3_axpy(-qvec3_dot(n, slip), n, slip);
        qvec3 wanted = qvec3_axpy(-1 / across, across_slip, tangential);
        const double size = qvec3_norm(wanted), most = touch->friction * normal;
        if (size > most) wanted = qvec3_scale(wanted, most / size);
        const qvec3 change = qvec3_sub(wanted, tangential);
        rubbed = qvec3_norm(change);
        if (rubbed > 0) apply(world, states, touch, change);
        tangential = wanted;
    }
    share->impulse = qvec3_axpy(normal, n, tangential);
    return fabs(pushed) * along + rubbed * across;
}

/* One sweep over the shares; true when it moved nothing but roundings: of the velocities, and of what the impulses make
 * of them. */
static bool sweep_shares(const imp_world *world, imp_state *states, imp_share *shares, int count, double speed)
{
    bool settled = true;
    for (int c = 0; c < count; c++) {
        double along, across;
        share_response(world, states, &shares[c].touch, &along, &across);
        const double moved = improve_share(world, states, &shares[c], along, across);
        settled = settled && moved <= 1e-14 * speed + 4 * DBL_EPSILON * shares[c].normal * along;
    }
    return settled;
}

static bool sweep_until(const imp_world *world, imp_state *states, imp_share *shares, int count, double speed, int most)
{
    bool settled = false;
    for (int k = 0; k < most && !settled; k++) settled = sweep_shares(world, states, shares, count, speed);
    return settled;
}

/* ---- where sweeps hardly move: heavy bodies on light ones ---- */

/* The touch of a share that presses, sliding if its friction is spent and else stuck; no more approach and slip than
 * that is wanted. */
static imp_touch pressing_touch(const imp_share *share)
{
    imp_touch touch = share->touch;
    const qvec3 tangential = qvec3_axpy(-share->normal, touch.normal, share->impulse);
    const double friction = qvec3_norm(tangential);
    touch.mode = friction < touch.friction * share->normal * (1 - 1e-9) ? IMP_ROLL : IMP_SLIDE;
    touch.direction = friction > 0 ? qvec3_scale(tangential, -1 / friction) : imp_tangent(touch.normal);
    touch.wanted = qvec3_neg(share->before);
    return touch;
}

/* The impulse, brought back into the cone. */
static void take(const imp_world *world, imp_state *states, imp_share *share, const imp_touch *touch)
{
    const qvec3 n = touch->normal;
    const double normal = fmax(0, qvec3_dot(n, touch->force)), most = touch->friction * normal;
    qvec3 tangential = qvec3_axpy(-qvec3_dot(n, touch->force), n, touch->force);
    const double size = qvec3_norm(tangential);
    if (size > most) tangential = qvec3_scale(tangential, most / size);
    const qvec3 impulse = qvec3_axpy(normal, n, tangential);
    apply(world, states, touch, qvec3_sub(impulse, share->impulse));
    share->impulse = impulse;
    share->normal = normal;
}

/* Solves for the impulses of all shares that press, stuck or sliding as they are now, at once. */
static void solve_at_once(const imp_world *world, imp_state *states, imp_share *shares, int count, imp_persist *system)
{
    system->count = 0;
    for (int c = 0; c < count; c++)
        if (shares[c].normal > 0) system->touches[system->count++] = pressing_touch(&shares[c]);
    imp_system_solve(system, world, states, true);
    for (int c = 0, k = 0; c < count; c++)
        if (shares[c].normal > 0) take(world, states, &shares[c], &system->touches[k++]);
}

/* Shares solved at once, and sweeps that tell which press and which slide, in turn. Without success nothing is changed.
 */
static bool settle_at_once(const imp_world *world, imp_state *states, imp_share *shares, int count, double speed)
{
    enum { ROUNDS = 30, SWEEPS = 30 };
    const size_t bodies = (size_t)world->body_count, n = (size_t)count;
    imp_persist system = {.arena = world->arena};
    imp_state *kept_states = imp_arena_take(world->arena, bodies, sizeof *kept_states);
    imp_share *kept_shares = imp_arena_take(world->arena, n, sizeof *kept_shares);
    bool settled = false;
    if (kept_states && kept_shares && imp_persist_make_room(&system, count, world->body_count) == IMPACT_OK) {
        memcpy(kept_states, states, bodies * sizeof *states);
        memcpy(kept_shares, shares, n * sizeof *shares);
        for (int round = 0; round < ROUNDS && !settled; round++) {
            solve_at_once(world, states, shares, count, &system);
            settled = sweep_until(world, states, shares, count, speed, SWEEPS);
        }
        if (!settled) {
            memcpy(states, kept_states, bodies * sizeof *states);
            memcpy(shares, kept_shares, n * sizeof *shares);
        }
    }
    imp_persist_free(&system);
    imp_arena_give(world->arena, kept_states);
    imp_arena_give(world->arena, kept_shares);
    return settled;
}

/* Impulses far greater than what they leave of one another leave their rounding too: what approach and slip it makes of
 * the shares that press is taken away by impulses of its own size. */
static void take_rounding_away(const imp_world *world, imp_state *states, imp_share *shares, int count)
{
    imp_persist system = {.arena = world->arena};
    if (imp_persist_make_room(&system, count, world->body_count) == IMPACT_OK) {
        for (int c = 0; c < count; c++) {
            if (shares[c].normal <= 0) continue;
            imp_touch *touch = &system.touches[system.count++];
            *touch = pressing_touch(&shares[c]);
            touch->wanted = qvec3_neg(relative_velocity(world, states, touch));
        }
        imp_system_solve(&system, world, states, true);
        imp_system_apply(&system, world, states);
        for (int c = 0, k = 0; c < count; c++) {
            if (shares[c].normal <= 0) continue;
            shares[c].normal += system.touches[k].pressure;
            shares[c].impulse = qvec3_add(shares[c].impulse, system.touches[k++].force);
        }
    }
    imp_persist_free(&system);
}

bool imp_answer_together(const imp_world *world, imp_state *states, imp_share *shares, int count)
{
    enum { SWEEPS = 5000 };
    double speed = 0;
    for (int c = 0; c < count; c++) {
        shares[c].before = relative_velocity(world, states, &shares[c].touch);
        shares[c].impulse = (qvec3){0, 0, 0};
        shares[c].normal = 0;
        speed = fmax(speed, qvec3_norm(shares[c].before));
    }
    const bool settled =
        sweep_until(world, states, shares, count, speed, SWEEPS) || settle_at_once(world, states, shares, count, speed);
    if (settled) take_rounding_away(world, states, shares, count);
    for (int c = 0; c < count; c++) {
        imp_share *share = &shares[c];
        share->after = relative_velocity(world, states, &share->touch);
        share->work = 0.5 * qvec3_dot(share->impulse, qvec3_add(share->before, share->after));
    }
    return settled;
}
