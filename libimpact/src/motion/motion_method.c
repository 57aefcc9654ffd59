/* SPDX-License-Identifier: MIT
 *
 * Which variable, which method and which tolerances a stretch of integration needs.
 */
#include "motion/motion_stretch.h"
#include "base/parts.h"
#include "contact/held_spot.h"
#include "contact/points.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

impact_status imp_motion_make_room(imp_motion *motion)
{
    const imp_world *world = motion->world;
    int moving = 0;
    for (int i = 0; i < world->body_count; i++) moving += !world->bodies[i].is_static;
    int spots = 0;
    for (int p = 0; p < world->pair_count; p++) spots += imp_spot_suits(world, &world->pairs[p]);
    const int size = Y_BODIES + Y_PER_BODY * moving + Y_PER_SPOT * spots + world->driven;
    const int roots =
        ROOTS_PER_PAIR * world->pair_count + ROOTS_PER_EDGE * imp_field_edge_count(world) + world->body_count;
    if (motion->y && size == motion->size && roots == motion->roots) return IMPACT_OK;
    imp_motion_forget(motion);
    motion->size = size, motion->roots = roots;
    motion->kept = imp_arena_take(world->arena, (size_t)motion->size, sizeof *motion->kept);
    motion->found = imp_arena_take(world->arena, (size_t)motion->roots, sizeof *motion->found);
    motion->absolute = imp_arena_take(world->arena, (size_t)motion->size, sizeof *motion->absolute);
    motion->probe = imp_arena_take(world->arena, 4 * (size_t)motion->size, sizeof *motion->probe);
    motion->y = imp_arena_take(world->arena, (size_t)motion->size, sizeof *motion->y);
    const bool room = motion->kept && motion->y && motion->found && motion->absolute && motion->probe;
    return room ? IMPACT_OK : IMPACT_ENOMEM;
}

/* Makes the integrator of the method the one at work, creating it when it is first needed. */
static impact_status choose_integrator(imp_motion *motion, impact_ode_method method)
{
    impact_ode **all[] = {[IMPACT_ODE_ADAMS] = &motion->adams,
                          [IMPACT_ODE_BDF] = &motion->bdf,
                          [IMPACT_ODE_RK4] = &motion->rk4,
                          [IMPACT_ODE_LOBATTO] = &motion->lobatto,
                          [IMPACT_ODE_DOP853] = &motion->dop853};
    impact_ode **ode = all[method];
    impact_status status = imp_motion_make_room(motion);
    if (status == IMPACT_OK && !*ode) {
        const impact_ode_def def = {.struct_size = sizeof def,
                                    .size = motion->size,
                                    .roots = motion->roots,
                                    .rhs = imp_motion_rates,
                                    .root_functions = imp_motion_root_values,
                                    .context = motion,
                                    .method = method,
                                    .step = method == IMPACT_ODE_RK4 ? motion->step : 0,
                                    .relative_tolerance = motion->tolerance,
                                    .absolute_tolerance = IMP_ABSOLUTE_OF_RELATIVE * motion->tolerance,
                                    .falling_roots_only = true};
        status = imp_ode_create_in(motion->world->arena, &def, ode);
        if (status == IMPACT_EABSENT)
            snprintf(motion->message, sizeof motion->message, "this motion needs the integrator, and " IMP_NO_CVODE);
        motion->world->usage.integrators += status == IMPACT_OK;
    }
    motion->ode = *ode;
    return status;
}

void imp_motion_count_work(imp_motion *motion)
{
    const impact_ode *all[] = {motion->adams, motion->bdf, motion->rk4, motion->lobatto, motion->dop853};
    long starts = 0, steps = 0, calls = 0;
    for (int k = 0; k < 5; k++) {
        if (!all[k]) continue;
        const impact_ode_counts counts = impact_ode_count(all[k]);
        starts += counts.starts, steps += counts.steps, calls += counts.rhs_calls;
    }
    impact_usage *usage = &motion->world->usage;
    usage->integrator_starts += starts - motion->counted.starts;
    usage->integrator_steps += steps - motion->counted.steps;
    motion->last_rates = calls - motion->counted.rhs_calls;
    usage->integrator_rhs_calls += calls - motion->counted.rhs_calls;
    motion->counted = (impact_ode_counts){.starts = starts, .steps = steps, .rhs_calls = calls};
}

/* The slowest slip, as the contacts stand, of the contacts whose slip is past incipient, m/s; infinite when none does.
 * slow: of those alone whose slip has just begun, or of the others. */
static double slowest_slip(const imp_motion *motion, bool slow)
{
    double slowest = INFINITY;
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        if (contact->mode == IMP_SLIDE && !contact->incipient && contact->friction > 0 &&
            (motion->world->pairs[contact->pair].slip.stage == IMP_SLIP_SLOW) == slow)
            slowest = fmin(slowest, contact->speed);
    }
    return slowest;
}

/* Whether some slip dies out again that has just begun. */
static bool slow_slip_fades(const imp_motion *motion)
{
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        if (contact->mode == IMP_SLIDE && !contact->incipient &&
            motion->world->pairs[contact->pair].slip.stage == IMP_SLIP_SLOW &&
            qvec3_dot(contact->slip_rate, contact->slip) < 0)
            return true;
    }
    return false;
}

/* Slip that has its direction from itself again is slow no more. */
static void end_slow_slip(imp_motion *motion)
{
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        imp_pair *pair = &motion->world->pairs[contact->pair];
        const bool grown = contact->mode != IMP_SLIDE || contact->speed >= IMP_SLIP_SLOW_OF_SCALE * motion->slip_scale;
        if (pair->slip.stage == IMP_SLIP_SLOW && grown) pair->slip.stage = IMP_SLIP_GROSS;
    }
}

/* The speed below which slip slows the clock: small against the motion and the weight of the sliding bodies. */
static double slip_scale(const imp_motion *motion, const imp_state *states)
{
    double scale = 0;
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        if (contact->mode != IMP_SLIDE) continue;
        const imp_body *body = &motion->world->bodies[contact->body1];
        const double fall = fabs(contact->pressure) * body->inverse_mass * body->radius;
        scale = fmax(scale, 0.05 * (imp_motion_speed(body, &states[contact->body1]) + sqrt(fall)));
    }
    return fmax(scale, motion->world->slip_speed);
}

/* How fast a carried contact may move over its surface before it slows the clock, 1/s: as the body itself moves, about;
 * 0: none is. */
static double point_speed_scale(const imp_motion *motion, const imp_state *states)
{
    double scale = 0;
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        if (!imp_held_contact_is_followed(contact)) continue;
        const imp_body *body = &motion->world->bodies[contact->body1];
        const double fall = qvec3_norm(motion->loads[contact->body1].force) * body->inverse_mass;
        const double rate = qvec3_norm(imp_omega(body, &states[contact->body1])) + sqrt(fall / body->radius);
        scale = fmax(scale, rate);
    }
    return scale;
}

/* Whether custom forces brake so much faster than the motion goes on that Adams' short steps, a hundredth of their
 * time, would cost more than BDF's many. */
static bool is_braked(const imp_motion *motion, double t, double t_end, const imp_state *states)
{
    double turning;
    return imp_field_brake(motion->world, t, states, &turning) > 30 * turning + 50 / (t_end - t);
}

/* Whether something slides that has just begun to: its direction is all that is known of it, to the digits that the
 * velocities leave of a slip so small. */
static bool slip_begins(const imp_motion *motion)
{
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        if (contact->mode == IMP_SLIDE && (contact->incipient || contact->speed < motion->slip_scale)) return true;
    }
    return false;
}

static bool is_curved(const imp_body *body)
{
    return body->shape.kind == IMPACT_SUPERQUADRIC || body->shape.kind == IMPACT_SUPERELLIPSOID;
}

/* Whether more than a point of a superquadric can lie on the other body. */
static bool lies_on_flats(const imp_world *world, const imp_pair *pair)
{
    return (is_curved(&world->bodies[pair->body1]) || is_curved(&world->bodies[pair->body2])) &&
           (imp_pair_has_faces(world, pair) || imp_pair_can_lie(world, pair));
}

/* Whether the explicit method's steps suit what is held. Slip that has just begun has its direction from the last that
 * was found, which long steps lose; and what creeps over flat places of superquadrics, pressed by 1e8 times its weight,
 * leaves rates whose rounding one step's errors are taken from. */
static bool suits_explicit(const imp_motion *motion)
{
    const int count = motion->held.count;
    bool suits = !motion->following && (motion->sliding || count > 1);
    for (int c = 0; c < count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        const imp_pair *pair = &motion->world->pairs[contact->pair];
        suits = suits && !contact->incipient && (count == 1 || !lies_on_flats(motion->world, pair));
    }
    return suits;
}

/* Whether the surface all but has edges: those of two exponents of 1 are contacts of their own. */
static bool is_sharp(const imp_body *body)
{
    const impact_shape *s = &body->shape;
    const int straight = (s->r == 1) + (s->s == 1) + (s->t == 1);
    return is_curved(body) && straight < 2 && fmin(s->r, fmin(s->s, s->t)) < IMP_COLLOCATED_EXPONENT;
}

/* Whether a held body has such: the contact crosses them between two of collocation's nodes. */
static bool crosses_edges(const imp_motion *motion)
{
    for (int c = 0; c < motion->held.count; c++) {
        const imp_held_contact *contact = &motion->held.contacts[c];
        if (is_sharp(&motion->world->bodies[contact->body1]) || is_sharp(&motion->world->bodies[contact->body2]))
            return true;
    }
    return false;
}

/* Which variable and which method the stretch needs. */
static impact_status choose_road(imp_motion *motion, double t, double t_end, const imp_state *states)
{
    if (motion->held.count > 0) imp_held_solve(&motion->held, motion->world, states, motion->loads);
    motion->slip_scale = slip_scale(motion, states);
    end_slow_slip(motion);
    motion->stiff = isfinite(slowest_slip(motion, true));
    const double grown = slowest_slip(motion, false);
    motion->sliding = isfinite(grown) && (!motion->stiff || grown < IMP_SLIP_SLOW_OF_SCALE * motion->slip_scale);
    motion->sliding = motion->sliding || slow_slip_fades(motion);
    motion->point_speed_scale = point_speed_scale(motion, states);
    motion->following = motion->point_speed_scale > 0;
    const bool stiff = motion->stiff || is_braked(motion, t, t_end, states),
               other = motion->distrusted != (motion->method == IMPACT_MOTION_OTHER);
    motion->distrusted = false;
    if (motion->method == IMPACT_MOTION_RK4) return choose_integrator(motion, IMPACT_ODE_RK4);
    if (stiff != other) return choose_integrator(motion, IMPACT_ODE_BDF);
    if (motion->method != IMPACT_MOTION_AUTO) return choose_integrator(motion, IMPACT_ODE_ADAMS);
    /* At one contact collocation takes a tenth of Adams' steps and a third of the time, for two digits more
     * (sphere_wall, turntable); of slip that begins its long steps lose seven digits. Where slip dies out, and where
     * the modes of many contacts end steps again and again, the explicit method takes a fourteenth of Adams' steps and
     * a third of the time (tests/lua/test_fading.lua). */
    if (motion->held.count <= 1 && !slip_begins(motion) && !crosses_edges(motion))
        return choose_integrator(motion, IMPACT_ODE_LOBATTO);
    return choose_integrator(motion, suits_explicit(motion) ? IMPACT_ODE_DOP853 : IMPACT_ODE_ADAMS);
}

static double stretch_tolerance(const imp_motion *motion)
{
    const double part = motion->held.count == 0 ? IMP_FLIGHT_OF_TOLERANCE : IMP_HELD_OF_TOLERANCE;
    double tolerance = fmin(motion->tolerance, fmax(IMP_FLIGHT_TOLERANCE, part * motion->tolerance));
    if (motion->bounces && motion->ode != motion->lobatto) tolerance = fmin(tolerance, IMP_BOUNCE_TOLERANCE);
    for (int c = 0; c < motion->held.count; c++)
        if (motion->held.contacts[c].mode == IMP_SLIDE && motion->held.contacts[c].friction > 0)
            tolerance = fmin(tolerance, IMP_SLIDING_TOLERANCE);
    return tolerance;
}

static impact_status choose_tolerance(imp_motion *motion, const imp_state *states)
{
    motion->relative = stretch_tolerance(motion);
    imp_motion_measures(motion, states, motion->absolute);
    for (int i = 0; i < motion->size; i++) motion->absolute[i] *= IMP_ABSOLUTE_OF_RELATIVE * motion->relative;
    return impact_ode_set_tolerances(motion->ode, motion->relative, motion->absolute);
}

/* Whether an open pair touches: what bounced a moment ago is to come down where it falls. */
static bool has_bounced(const imp_motion *motion, const imp_state *states)
{
    imp_world *world = motion->world;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair *pair = &world->pairs[p];
        const double touching = imp_world_touching_distance(world, pair, states);
        if (imp_is_held(pair) || pair->mode == IMP_BEYOND || imp_world_distance_bound(world, pair, states) > touching)
            continue;
        impact_contact contact;
        imp_world_gap(world, pair, states, &contact);
        if (contact.gap <= touching) return true;
    }
    return false;
}

impact_status imp_motion_choose(imp_motion *motion, const imp_state *states)
{
    motion->bounces = has_bounced(motion, states);
    const impact_status status = choose_road(motion, motion->stride.t, motion->stride.t_end, states);
    return status == IMPACT_OK ? choose_tolerance(motion, states) : status;
}

bool imp_motion_outgrows(const imp_motion *motion)
{
    if (!motion->stiff) return false;
    return slowest_slip(motion, true) > IMP_SLIP_SLOW_OF_SCALE * motion->slip_scale ||
           (!motion->sliding && slow_slip_fades(motion));
}
