/* SPDX-License-Identifier: MIT
 *
 * With impulses p at the contacts and u the relative velocities after, p_n >= 0, u_n >= 0, p_n u_n = 0, |p_t| <= mu p_n and p_t . u_t <= 0
 * (Moreau, "Unilateral contact and dry friction in finite freedom dynamics", 1988, without restitution). Then the kinetic energy changes
 * by p . u - (p . W p)/2 <= 0.
 */
#include "scene_together.h"
#include "persist_system.h"

#include <math.h>

static qvec3 point_velocity(const impact_world *world, const impact_state *states, int body, qvec3 r)
{
    const impact_body *b = &world->bodies[body];
    if (b->is_static) return (qvec3){0, 0, 0};
    return qvec3_add(states[body].v, qvec3_cross(impact_omega(b, &states[body]), r));
}

static qvec3 relative_velocity(const impact_world *world, const impact_state *states, const impact_touch *touch)
{
    return qvec3_sub(point_velocity(world, states, touch->body1, touch->r1),
                     point_velocity(world, states, touch->body2, touch->r2));
}

static void apply(const impact_world *world, impact_state *states, const impact_touch *touch, qvec3 impulse)
{
    const int bodies[2] = {touch->body1, touch->body2};
    const qvec3 arms[2] = {touch->r1, touch->r2};
    for (int k = 0; k < 2; k++) {
        const impact_body *body = &world->bodies[bodies[k]];
        impact_state *state = &states[bodies[k]];
        if (body->is_static) continue;
        const qvec3 own = k == 0 ? impulse : qvec3_neg(impulse);
        state->v = qvec3_axpy(body->inverse_mass, own, state->v);
        state->momentum = qvec3_add(state->momentum, qvec3_cross(arms[k], own));
    }
}

/* Response of the contact to its own impulse: along the normal, and the most across it. */
static void own_response(const impact_world *world, const impact_state *states, const impact_touch *touch,
                         double *along, double *across)
{
    const qvec3 t1 = impact_tangent(touch->normal), t2 = qvec3_cross(touch->normal, t1);
    *along = qvec3_dot(touch->normal, impact_system_response(world, states, touch, touch, touch->normal));
    *across = qvec3_dot(t1, impact_system_response(world, states, touch, touch, t1)) +
              qvec3_dot(t2, impact_system_response(world, states, touch, touch, t2));
    *across *= 0.5 * (1 + 1e-12); /* exact for round bodies */
    if (!world->bodies[touch->body1].spherical || !world->bodies[touch->body2].spherical) *across *= 2;
}

/* Solves one share against the others as they are: along the normal, then across it; returns by how much velocities changed. */
static double improve(const impact_world *world, impact_state *states, impact_share *share, double along, double across)
{
    const impact_touch *touch = &share->touch;
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

bool impact_answer_together(const impact_world *world, impact_state *states, impact_share *shares, int count)
{
    enum { SWEEPS = 5000 };
    double speed = 0, left = INFINITY;
    for (int c = 0; c < count; c++) {
        shares[c].before = relative_velocity(world, states, &shares[c].touch);
        shares[c].impulse = (qvec3){0, 0, 0};
        shares[c].normal = 0;
        speed = fmax(speed, qvec3_norm(shares[c].before));
    }
    for (int sweep = 0; sweep < SWEEPS && left > 1e-14 * speed; sweep++) {
        left = 0;
        for (int c = 0; c < count; c++) {
            double along, across;
            own_response(world, states, &shares[c].touch, &along, &across);
            left = fmax(left, improve(world, states, &shares[c], along, across));
        }
    }
    for (int c = 0; c < count; c++) {
        impact_share *share = &shares[c];
        share->after = relative_velocity(world, states, &share->touch);
        share->work = 0.5 * qvec3_dot(share->impulse, qvec3_add(share->before, share->after));
    }
    return left <= 1e-14 * speed;
}
