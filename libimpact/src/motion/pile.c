/* SPDX-License-Identifier: MIT */
#include "motion/pile.h"
#include "base/tolerances.h"
#include "contact/persist_linear.h"
#include "contact/rates.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>
#include <quat/exponential.h>

/* ---- room ---- */

void imp_pile_open(imp_pile *pile, imp_arena *arena)
{
    *pile = (imp_pile){
        .arena = arena, .cone.arena = arena, .rest.arena = arena, .touching.arena = arena, .by_bodies.arena = arena};
}

static void *replaced(imp_pile *pile, void *old, size_t count, size_t size, bool *there)
{
    imp_arena_give(pile->arena, old);
    void *room = imp_arena_take(pile->arena, count, size);
    *there = *there && room;
    return room;
}

static bool reserve_bodies(imp_pile *pile, const imp_world *world)
{
    const size_t bodies = (size_t)world->body_count;
    bool there = imp_pile_contacts_reserve(&pile->touching, world);
    if (world->body_count <= pile->bodies) return there;
    imp_state **states[] = {&pile->middle, &pile->mean, &pile->whole, &pile->half, &pile->end};
    for (int k = 0; k < 5; k++) *states[k] = replaced(pile, *states[k], bodies, sizeof **states[k], &there);
    pile->loads = replaced(pile, pile->loads, bodies, sizeof *pile->loads, &there);
    pile->number = replaced(pile, pile->number, bodies, sizeof *pile->number, &there);
    pile->velocities = replaced(pile, pile->velocities, bodies, sizeof *pile->velocities, &there);
    pile->bodies = there ? world->body_count : 0;
    return there;
}

/* The numbers that a contact of the world may have. */
static int widest_of(const imp_world *world)
{
    for (int p = 0; p < world->pair_count; p++)
        if (imp_is_rough(&world->pairs[p])) return IMP_CONE_WIDEST;
    return 3;
}

static bool reserve_contacts(imp_pile *pile, const imp_world *world, int contacts)
{
    const int widest = widest_of(world);
    const size_t count = (size_t)contacts, n = (size_t)widest * count;
    bool there = true;
    if (contacts <= pile->contacts_most && widest <= pile->widest) return true;
    pile->lengths = replaced(pile, pile->lengths, count, sizeof *pile->lengths, &there);
    pile->turns = replaced(pile, pile->turns, count, sizeof *pile->turns, &there);
    pile->contacts = replaced(pile, pile->contacts, count, sizeof *pile->contacts, &there);
    pile->members = replaced(pile, pile->members, count, sizeof *pile->members, &there);
    pile->rows = replaced(pile, pile->rows, count, sizeof *pile->rows, &there);
    pile->friction = replaced(pile, pile->friction, count, sizeof *pile->friction, &there);
    pile->pivots = replaced(pile, pile->pivots, 2 * count, sizeof *pile->pivots, &there);
    pile->w = replaced(pile, pile->w, n * n, sizeof *pile->w, &there);
    pile->gap = replaced(pile, pile->gap, count, sizeof *pile->gap, &there);
    double **vectors[] = {&pile->q, &pile->r, &pile->u, &pile->before, &pile->last_r, &pile->last_u, &pile->lead};
    for (int k = 0; k < 7; k++) *vectors[k] = replaced(pile, *vectors[k], n, sizeof **vectors[k], &there);
    there = (widest > 3 ? imp_cone_reserve_turning : imp_cone_reserve)(&pile->cone, contacts) && there;
    pile->contacts_most = there ? contacts : 0;
    pile->widest = widest;
    return there;
}

void imp_pile_begin(imp_pile *pile)
{
    pile->step = 0;
    pile->begun = false;
    pile->memory[0].count = 0;
}

/* ---- motion ---- */

static quat turned_by(quat q, qvec3 omega, double h)
{
    const qvec3 turn = qvec3_scale(omega, h);
    if (qvec3_norm(turn) > 0) (void)quat_normalize(quat_mul(quat_exp_pure(qvec3_scale(turn, 0.5)), q), &q);
    return q;
}

/* What moves goes on with its velocities for h. */
static void drift(const imp_world *world, const imp_state *velocities, double h, imp_state *states)
{
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        const qvec3 omega = imp_omega(body, &velocities[i]); /* the states may be these */
        states[i].x = qvec3_axpy(h, velocities[i].v, states[i].x);
        states[i].q = turned_by(states[i].q, omega, h);
    }
}

static void add_loads(const imp_world *world, const imp_load *loads, double h, imp_state *states)
{
    for (int i = 0; i < world->body_count; i++) {
        if (world->bodies[i].is_static) continue;
        states[i].v = qvec3_axpy(h * world->bodies[i].inverse_mass, loads[i].force, states[i].v);
        states[i].momentum = qvec3_axpy(h, loads[i].torque, states[i].momentum);
    }
}

/* A measure of the pile: its smallest body. */
static double smallest(const imp_world *world)
{
    double least = INFINITY;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) least = fmin(least, world->bodies[i].radius);
    return least;
}

/* ---- contacts ---- */

/* The points of the next island to the front of the arrays, with their gaps; how many. */
static int gather_island(imp_pile *pile, const imp_world *world)
{
    const int count = imp_pile_take_island(&pile->touching, world, pile->members);
    pile->width = 3;
    for (int c = 0; c < count; c++) {
        const imp_pile_point *point = &pile->touching.points[pile->members[c]];
        const imp_pair *pair = &world->pairs[point->pair];
        pile->contacts[c] = point->contact;
        pile->friction[c] = pair->friction;
        pile->lengths[c] = (imp_cone_lengths){pair->torsional, pair->rolling};
        pile->gap[c] = point->gap;
        if (imp_is_rough(pair)) pile->width = IMP_CONE_WIDEST;
    }
    return count;
}

/* ---- one step, whole ---- */

/* Along the contact's axes, and, of a width of six, about them. */
static void parts_of(const imp_cone_contact *contact, qvec3 along, qvec3 about, int width, double factor, double *to)
{
    for (int k = 0; k < width; k++) to[k] = factor * qvec3_dot(contact->axes[k % 3], k < 3 ? along : about);
}

static qvec3 from_parts(const imp_cone_contact *contact, const double *parts, double divisor)
{
    qvec3 v = {0, 0, 0};
    for (int k = 0; k < 3; k++) v = qvec3_axpy(parts[k] / divisor, contact->axes[k], v);
    return v;
}

/* What is remembered of the contacts, along their axes; whether that is all of them. One that was open begins open, and
 * bounces off what it approaches at the velocities pile->before. What is held does not bounce. */
static bool recall_step(imp_pile *pile, const imp_world *world, int count, double h)
{
    bool all = true;
    for (int c = 0; c < count; c++) {
        const imp_pile_point *point = &pile->touching.points[pile->members[c]];
        const imp_pile_memory *m = imp_pile_recall(&pile->memory[1], point);
        const int i = pile->width * c;
        if (!m) pile->q[i] += world->pairs[point->pair].restitution * fmin(0, pile->before[i]);
        for (int k = 0; !m && k < pile->width; k++) pile->last_r[i + k] = 0, pile->last_u[i + k] = pile->q[i + k];
        all = all && m;
        if (!m) continue;
        parts_of(&pile->contacts[c], m->reaction, m->moment, pile->width, h, &pile->last_r[i]);
        parts_of(&pile->contacts[c], m->velocity, m->turning, pile->width, 1, &pile->last_u[i]);
    }
    return all;
}

static bool remember_step(imp_pile *pile, imp_pile_memories *memories, int count, double h)
{
    for (int c = 0; c < count; c++) {
        imp_pile_memory *m = imp_pile_remember(pile->arena, memories, &pile->touching.points[pile->members[c]]);
        if (!m) return false;
        const int i = pile->width * c;
        m->reaction = from_parts(&pile->contacts[c], &pile->r[i], h);
        m->velocity = from_parts(&pile->contacts[c], &pile->u[i], 1);
        if (pile->width == 3) continue;
        m->moment = from_parts(&pile->contacts[c], &pile->r[i + 3], h);
        m->turning = from_parts(&pile->contacts[c], &pile->u[i + 3], 1);
    }
    return true;
}

/* Work of the static bodies' moving surfaces with the impulses. */
static double drive_work(const imp_pile *pile, const imp_world *world, int count)
{
    double work = 0;
    for (int c = 0; c < count && world->driven; c++) {
        const imp_cone_contact *own = &pile->contacts[c];
        const imp_body *under = &world->bodies[own->body2];
        const qvec3 v = imp_surface_velocity(under, own->arm2);
        for (int k = 0; k < pile->width; k++)
            work += pile->r[pile->width * c + k] * qvec3_dot(own->axes[k % 3], k < 3 ? v : under->spin);
    }
    return work;
}

/* The island's bodies by numbers of their own, from 0; how many move. */
static int number_bodies(imp_pile *pile, const imp_world *world, int count)
{
    int bodies = 0;
    for (int c = 0; c < count; c++) pile->number[pile->contacts[c].body1] = pile->number[pile->contacts[c].body2] = -1;
    for (int c = 0; c < count; c++) {
        const int body[2] = {pile->contacts[c].body1, pile->contacts[c].body2};
        for (int k = 0; k < 2; k++)
            if (!world->bodies[body[k]].is_static && pile->number[body[k]] < 0) pile->number[body[k]] = bodies++;
    }
    return bodies;
}

/* W is there for by_contacts alone. */
static imp_cone_problem problem_of(const imp_pile *pile, int count)
{
    return (imp_cone_problem){.count = count,
                              .w = pile->w,
                              .q = pile->q,
                              .friction = pile->friction,
                              .lengths = pile->width > 3 ? pile->lengths : NULL,
                              .last_r = pile->last_r,
                              .last_u = pile->last_u};
}

static imp_cone_outcome by_contacts(imp_pile *pile, const imp_world *world, int count)
{
    const imp_cone_problem problem = problem_of(pile, count);
    if (pile->width > 3)
        imp_cone_assemble_turning(world, pile->middle, pile->contacts, count, pile->rows, pile->turns, pile->w);
    else
        imp_cone_assemble(world, pile->middle, pile->contacts, count, pile->rows, pile->w);
    return imp_cone_solve(&problem, &pile->cone, pile->r, pile->u, NULL);
}

/* The greatest velocity that contacts have without impulses, m/s. */
static double fastest_of(const imp_pile *pile, int count)
{
    double most = 0;
    for (int i = 0; i < pile->width * count; i++) {
        const imp_cone_lengths *own = &pile->lengths[i / pile->width];
        const int k = i % pile->width;
        most = fmax(most, fabs(pile->q[i]) * (k < 3 ? 1 : k == 3 ? own->torsional : own->rolling));
    }
    return most;
}

/* Few contacts in their own space, to rounding; many in that of the bodies, and where that leaves what counts in the
 * step's error in the other again, if they are not too many for that. */
static imp_cone_outcome find_impulses(imp_pile *pile, const imp_world *world, int count, double h)
{
    if (count <= IMP_PILE_FEW) return by_contacts(pile, world, count);
    imp_cone_find_rows(world, pile->middle, pile->contacts, count, pile->rows);
    if (pile->width > 3) imp_cone_find_turns(world, pile->middle, pile->contacts, count, pile->turns);
    const int bodies = number_bodies(pile, world, count);
    const imp_cone_problem problem = problem_of(pile, count);
    const imp_cone_outcome quick = imp_cone_solve_bodies(&pile->by_bodies, pile->contacts, pile->rows, pile->turns,
                                                         pile->number, bodies, &problem, pile->r, pile->u);
    const bool counts = !(quick.residual <= IMP_PILE_USABLE &&
                          h * quick.residual * fastest_of(pile, count) <= 0.1 * IMP_PILE_ERROR * smallest(world));
    const bool answered = quick.status != IMP_CONE_BAD && quick.status != IMP_CONE_NO_ROOM;
    return counts && answered && count <= IMP_PILE_DENSE ? by_contacts(pile, world, count) : quick;
}

/* What friction takes over the step, where its impulse meets the slip of before and after it half each. */
static double rubbed(const imp_pile *pile, int count)
{
    double work = 0;
    for (int i = 0; i < pile->width * count; i++)
        if (i % pile->width > 0) work -= 0.5 * pile->r[i] * (pile->before[i] + pile->u[i]);
    return fmax(work, 0);
}

/* The places are those of the step's middle: what its two ends' velocities differ by from what they would be there, as
 * bodies and contacts turn. */
static void add_bends(const imp_pile *pile, imp_world *world, const imp_state *states, int count, double h)
{
    for (int c = 0; c < count; c++) {
        const imp_pile_point *point = &pile->touching.points[pile->members[c]];
        const impact_contact contact = {
            .normal = point->contact.axes[0], .offset1 = point->contact.arm1, .offset2 = point->contact.arm2};
        double bend[6];
        imp_contact_bend(world, &world->pairs[point->pair], point->bearer, &contact, point->contact.axes, states, bend);
        for (int k = 0; k < pile->width; k++) {
            pile->before[pile->width * c + k] -= 0.5 * h * bend[k];
            pile->q[pile->width * c + k] += 0.5 * h * bend[k];
        }
    }
}

/* What turns the contact's slip at the end of the step, without changing its size, into the way it goes at the middle;
 * what velocity friction gives the contact by being off that way, m/s. 0 of slip that the step turns back. */
static double lead_of(const imp_pile *pile, int c, double lead[6])
{
    const int i = pile->width * c;
    const double *from = &pile->before[i], *to = &pile->u[i], *r = &pile->r[i];
    memset(lead, 0, 6 * sizeof *lead);
    const double slip = hypot(to[1], to[2]), mean = hypot(from[1] + to[1], from[2] + to[2]);
    if (!(slip > 0) || !(from[1] * to[1] + from[2] * to[2] > 0)) return 0;
    for (int k = 1; k < 3; k++) lead[k] = slip * (from[k] + to[k]) / mean - to[k];
    double w = 0;
    for (int side = 0; side < 2; side++)
        for (int l = 0; l < 6; l++) w += pile->rows[c].side[side][0][l] * pile->rows[c].side[side][0][l];
    return w * hypot(r[1], r[2]) * hypot(lead[1], lead[2]) / slip;
}

/* Friction acts along the slip of the step's middle where that turns: found from the slip at its end. */
static imp_cone_outcome follow_slip(imp_pile *pile, const imp_world *world, int count, double h, imp_cone_outcome first)
{
    const size_t size = (size_t)(pile->width * count);
    const double natural = imp_pile_natural_time(world, pile->middle);
    double most = 0, lead[6];
    for (int c = 0; c < count; c++) most = fmax(most, lead_of(pile, c, lead));
    if (!(most / h * natural * natural > IMP_PILE_LEAD * IMP_PILE_ERROR * smallest(world))) return first;
    for (int c = 0; c < count; c++) {
        lead_of(pile, c, lead);
        memcpy(&pile->lead[pile->width * c], lead, sizeof *lead * (size_t)pile->width);
    }
    memcpy(pile->last_r, pile->r, size * sizeof *pile->r);
    for (size_t i = 0; i < size; i++) pile->q[i] += pile->lead[i], pile->last_u[i] = pile->u[i] + pile->lead[i];
    const imp_cone_outcome second = find_impulses(pile, world, count, h);
    for (size_t i = 0; i < size; i++) pile->u[i] -= pile->lead[i];
    return second;
}

/* The impulses of one island over a step h: states have the velocities before, `next` those with the loads. */
static impact_status answer(imp_pile *pile, imp_world *world, const imp_state *states, int count, double h,
                            imp_state *next, imp_pile_step_result *result)
{
    const bool turning = pile->width > 3;
    (turning ? imp_cone_contact_turning : imp_cone_contact_velocities)(world, next, pile->contacts, count, pile->q);
    (turning ? imp_cone_contact_turning : imp_cone_contact_velocities)(world, states, pile->contacts, count,
                                                                       pile->before);
    add_bends(pile, world, states, count, h);
    const bool all_held = recall_step(pile, world, count, h);
    imp_cone_outcome outcome = find_impulses(pile, world, count, h);
    if (all_held && outcome.residual <= IMP_PILE_USABLE) outcome = follow_slip(pile, world, count, h, outcome);
    if (outcome.status == IMP_CONE_NO_ROOM) return IMPACT_ENOMEM;
    if (outcome.status == IMP_CONE_BAD || !(outcome.residual <= IMP_PILE_USABLE)) {
        snprintf(pile->message, sizeof pile->message, "the impulses of %d contacts are %s", count,
                 imp_cone_status_name(outcome.status));
        return IMPACT_EUNSETTLED;
    }
    (turning ? imp_cone_push_turning : imp_cone_push)(world, pile->contacts, count, pile->r, next);
    result->error += h * outcome.residual * fastest_of(pile, count);
    if (!remember_step(pile, &pile->memory[2], count, h)) return IMPACT_ENOMEM;
    result->drive_work += drive_work(pile, world, count);
    result->sliding += rubbed(pile, count);
    for (int c = 0; c < count; c++)
        result->coupled +=
            !world->bodies[pile->contacts[c].body1].is_static && !world->bodies[pile->contacts[c].body2].is_static;
    result->contacts += count;
    return IMPACT_OK;
}

/* Whether loads follow velocities, or tell work that does. */
static bool loads_follow(const imp_world *world)
{
    for (int i = 0; i < world->body_count; i++)
        if (world->bodies[i].linear_rate > 0 || world->bodies[i].angular_rate > 0) return true;
    return world->field_count > 0;
}

/* The middle of the step with the velocities that are the mean of its ends'. */
static void find_mean(imp_pile *pile, const imp_world *world, const imp_state *from, const imp_state *to)
{
    memcpy(pile->mean, pile->middle, sizeof *pile->mean * (size_t)world->body_count);
    for (int i = 0; i < world->body_count; i++) {
        pile->mean[i].v = qvec3_scale(qvec3_add(from[i].v, to[i].v), 0.5);
        pile->mean[i].momentum = qvec3_scale(qvec3_add(from[i].momentum, to[i].momentum), 0.5);
    }
}

/* The velocities at the end of the step, the places being those of its middle; loads are those of the states given. */
static impact_status push_bodies(imp_pile *pile, imp_world *world, double t, double h, const imp_state *loaded,
                                 imp_state *to, imp_pile_step_result *result)
{
    if (!imp_field_loads(world, t + 0.5 * h, loaded, pile->loads)) return IMPACT_EDOMAIN;
    memcpy(to, pile->middle, sizeof *to * (size_t)world->body_count);
    add_loads(world, pile->loads, h, to);
    for (int i = 0; i < world->body_count; i++) {
        result->force_work += h * pile->loads[i].work_rate;
        result->damping += h * pile->loads[i].damping_rate;
    }
    for (int k = 0; k < pile->memory[1].count; k++) pile->memory[1].list[k].taken = false;
    pile->memory[2].count = 0;
    imp_pile_contacts_mark(&pile->touching, world, &pile->memory[1]);
    if (!imp_pile_find_points(&pile->touching, world, pile->middle, to, h, IMP_PILE_SLACK * smallest(world), false) ||
        !reserve_contacts(pile, world, pile->touching.count))
        return IMPACT_ENOMEM;
    for (int count; (count = gather_island(pile, world)) > 0;) {
        const impact_status status = answer(pile, world, pile->middle, count, h, to, result);
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

/* From `from` over h to `to`. Loads that follow velocities are asked at those of the beginning, and then at the mean of
 * those that this leads to: of the second order, and their work with the way. */
static impact_status step_once(imp_pile *pile, imp_world *world, double t, double h, const imp_state *from,
                               imp_state *to, imp_pile_step_result *result)
{
    result->contacts = result->coupled = 0;
    memcpy(pile->middle, from, sizeof *from * (size_t)world->body_count);
    drift(world, from, 0.5 * h, pile->middle);
    const imp_pile_step_result before = *result;
    impact_status status = push_bodies(pile, world, t, h, pile->middle, to, result);
    if (status == IMPACT_OK && loads_follow(world)) {
        *result = before;
        find_mean(pile, world, from, to);
        status = push_bodies(pile, world, t, h, pile->mean, to, result);
    }
    if (status != IMPACT_OK) return status;
    if (!imp_pile_copy_memories(pile->arena, &pile->memory[1], &pile->memory[2])) return IMPACT_ENOMEM;
    /* x' = x_m + h v'/2; of what tumbles with the turning that it has in its end's orientation, near enough */
    drift(world, to, 0.5 * h, to);
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (!body->is_static && !body->spherical)
            to[i].q = turned_by(pile->middle[i].q, imp_omega(body, &to[i]), 0.5 * h);
    }
    return IMPACT_OK;
}

/* ---- constraints put back ---- */

/* The points that were held at the end of the step, as far apart as the step met them. */
static bool find_held(imp_pile *pile, imp_world *world, const imp_state *states, double h, double slack)
{
    imp_pile_contacts *touching = &pile->touching;
    double apart = slack;
    for (int k = 0; k < pile->memory[0].count; k++) apart = fmax(apart, 2 * pile->memory[0].list[k].gap);
    imp_pile_contacts_mark(touching, world, &pile->memory[0]);
    if (!imp_pile_find_points(touching, world, states, states, h, apart, true)) return false;
    for (int k = 0; k < touching->count; k++)
        touching->points[k].taken = imp_pile_recall(&pile->memory[0], &touching->points[k]) == NULL;
    for (int k = 0; k < pile->memory[0].count; k++) pile->memory[0].list[k].taken = false;
    return true;
}

/* Impulses of displacement along the normals, that take every gap to zero: the least that do, of those equations that
 * are independent. */
static void close_gaps(imp_pile *pile, const imp_world *world, const imp_state *states, int count)
{
    const size_t n = (size_t)count;
    imp_cone_assemble(world, states, pile->contacts, count, pile->rows, pile->w);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            pile->w[i * n + j] = pile->w[3 * (3 * i * n + j)]; /* to the front: none is lost */
    imp_linear linear = {.n = count,
                         .matrix = pile->w,
                         .spare = pile->w + n * n,
                         .scratch = pile->last_r,
                         .rows = pile->pivots,
                         .columns = pile->pivots + n};
    imp_linear_factor(&linear);
    for (int c = 0; c < count; c++) pile->last_u[c] = -pile->gap[c];
    imp_linear_solve(&linear, pile->last_u);
    memset(pile->r, 0, sizeof *pile->r * 3 * n);
    for (int c = 0; c < count; c++) pile->r[3 * c] = pile->last_u[c];
}

/* Gives the displacements those impulses, unless the equations that were left out are not met then: of contacts that
 * are more than motions not every gap can be zero. */
static void push_together(imp_pile *pile, imp_world *world, int count, double slack)
{
    double off = 0;
    imp_cone_push(world, pile->contacts, count, pile->r, pile->middle);
    imp_cone_contact_velocities(world, pile->middle, pile->contacts, count, pile->u);
    for (int c = 0; c < count; c++) off = fmax(off, fabs(pile->gap[c] + pile->u[3 * c]));
    if (off <= 0.1 * slack) return;
    for (int i = 0; i < 3 * count; i++) pile->r[i] = -pile->r[i];
    imp_cone_push(world, pile->contacts, count, pile->r, pile->middle);
}

/* Impulses of displacement along the normals, that part what overlaps: a cone problem without friction. */
static void part_overlaps(imp_pile *pile, const imp_world *world, const imp_state *states, int count)
{
    imp_cone_assemble(world, states, pile->contacts, count, pile->rows, pile->w);
    memset(pile->q, 0, sizeof *pile->q * 3 * (size_t)count);
    for (int c = 0; c < count; c++) pile->q[3 * c] = pile->gap[c], pile->friction[c] = 0;
    const imp_cone_problem problem = {.count = count, .w = pile->w, .q = pile->q, .friction = pile->friction};
    const imp_cone_outcome outcome = imp_cone_solve(&problem, &pile->cone, pile->r, pile->u, NULL);
    if (outcome.status != IMP_CONE_SOLVED && outcome.status != IMP_CONE_INEXACT)
        memset(pile->r, 0, sizeof *pile->r * 3 * (size_t)count);
}

/* Moves bodies along normals, least in the metric of mass: what is held to gap zero, where that can be; then overlaps
 * apart. Gaps within the slack may stay. */
static impact_status project_places(imp_pile *pile, imp_world *world, double h, imp_state *states)
{
    const double slack = IMP_PILE_SLACK * smallest(world), rounding = IMP_TOUCHING * smallest(world);
    for (int pass = 0; pass < 2; pass++) {
        const bool found = pass == 0 ? find_held(pile, world, states, h, slack)
                                     : imp_pile_find_points(&pile->touching, world, states, NULL, 0, -rounding, false);
        if (!found || !reserve_contacts(pile, world, pile->touching.count)) return IMPACT_ENOMEM;
        memcpy(pile->middle, states, sizeof *states * (size_t)world->body_count);
        for (int i = 0; i < world->body_count; i++) pile->middle[i].v = pile->middle[i].momentum = (qvec3){0, 0, 0};
        for (int count; (count = gather_island(pile, world)) > 0;) {
            (pass == 0 ? close_gaps : part_overlaps)(pile, world, states, count);
            if (pass == 0)
                push_together(pile, world, count, slack);
            else
                imp_cone_push(world, pile->contacts, count, pile->r, pile->middle);
        }
        drift(world, pile->middle, 1, states);
    }
    return IMPACT_OK;
}

/* ---- the step that its error allows ---- */

/* How far apart any body's point stands in two ends of a step. */
static double apart(const imp_world *world, const imp_state *a, const imp_state *b)
{
    double most = 0;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        const quat turn = quat_mul(a[i].q, quat_conj(b[i].q));
        const double angle =
            body->shape.kind == IMPACT_SPHERE && !body->shifted ? 0 : 2 * qvec3_norm((qvec3){turn.x, turn.y, turn.z});
        most = fmax(most, qvec3_norm(qvec3_sub(a[i].x, b[i].x)) + body->radius * angle);
    }
    return most;
}

double imp_pile_natural_time(const imp_world *world, const imp_state *states)
{
    const double size = smallest(world), g = qvec3_norm(world->gravity);
    double speed = 0;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) speed = fmax(speed, qvec3_norm(states[i].v));
    return size / (sqrt(g * size) + (g > 0 ? 0 : speed) + 1e-300);
}

static impact_status try_step(imp_pile *pile, imp_world *world, double t, double h, const imp_state *states,
                              imp_pile_step_result *result)
{
    imp_pile_step_result scratch = {.taken = 0};
    *result = (imp_pile_step_result){.taken = h};
    if (!imp_pile_copy_memories(pile->arena, &pile->memory[1], &pile->memory[0])) return IMPACT_ENOMEM;
    impact_status status = step_once(pile, world, t, 0.5 * h, states, pile->half, result);
    if (status == IMPACT_OK) status = step_once(pile, world, t + 0.5 * h, 0.5 * h, pile->half, pile->end, result);
    if (status != IMPACT_OK) return status;
    if (!imp_pile_copy_memories(pile->arena, &pile->memory[3], &pile->memory[1]) ||
        !imp_pile_copy_memories(pile->arena, &pile->memory[1], &pile->memory[0]))
        return IMPACT_ENOMEM;
    status = step_once(pile, world, t, h, states, pile->whole, &scratch);
    result->error += apart(world, pile->whole, pile->end);
    return status;
}

/* What touches at the first step and does not approach is held from there: it does not come to touch within the step.
 */
static impact_status begin_held(imp_pile *pile, imp_world *world, const imp_state *states)
{
    imp_pile_contacts *touching = &pile->touching;
    pile->begun = true;
    if (!imp_pile_find_points(touching, world, states, NULL, 0, IMP_PILE_SLACK * smallest(world), false))
        return IMPACT_ENOMEM;
    pile->memory[0].count = 0;
    for (int k = 0; k < touching->count; k++) {
        const imp_pile_point *point = &touching->points[k];
        double u[3];
        imp_cone_contact_velocities(world, states, &point->contact, 1, u);
        if (u[0] < -imp_still_rate(world, hypot(u[1], u[2]))) continue;
        if (!imp_pile_remember(pile->arena, &pile->memory[0], point)) return IMPACT_ENOMEM;
    }
    return IMPACT_OK;
}

impact_status imp_pile_step(imp_pile *pile, imp_world *world, double t, double most, imp_state *states,
                            imp_pile_step_result *result)
{
    if (!reserve_bodies(pile, world)) return IMPACT_ENOMEM;
    const double natural = imp_pile_natural_time(world, states), wanted = IMP_PILE_ERROR * smallest(world);
    const double least = IMP_PILE_SHORTEST * natural;
    if (!(pile->step > 0)) pile->step = IMP_PILE_FIRST * natural;
    double h = fmin(most, fmin(pile->step, IMP_PILE_LONGEST * natural));
    impact_status status = pile->begun ? IMPACT_OK : begin_held(pile, world, states);
    if (status == IMPACT_OK) status = try_step(pile, world, t, h, states, result);
    while (h > least && (status == IMPACT_EUNSETTLED || (status == IMPACT_OK && result->error > wanted))) {
        h *= 0.5;
        status = try_step(pile, world, t, h, states, result);
    }
    if (status != IMPACT_OK) return status;
    memcpy(states, pile->end, sizeof *states * (size_t)world->body_count);
    if (!imp_pile_copy_memories(pile->arena, &pile->memory[0], &pile->memory[3])) return IMPACT_ENOMEM;
    /* h³ where modes stay, h where they change: doubled where the first would allow as much */
    pile->step = result->error < 0.1 * wanted ? 2 * h : h;
    return project_places(pile, world, h, states);
}

/* ---- rest ---- */

/* Whether a static body's surface moves along under what touches it with friction. */
static bool is_dragged(const imp_pile_contacts *touching, const imp_world *world, double rest_speed)
{
    for (int k = 0; world->driven && k < touching->count; k++) {
        const imp_pile_point *point = &touching->points[k];
        const imp_body *under = &world->bodies[point->contact.body2];
        const imp_pair *pair = &world->pairs[point->pair];
        if (under->driven && pair->friction > 0 &&
            qvec3_norm(imp_surface_velocity(under, point->contact.arm2)) > rest_speed)
            return true;
        if (under->driven && imp_is_rough(pair) && qvec3_norm(under->spin) > 0) return true;
    }
    return false;
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
        m->reaction = from_parts(&pile->contacts[c], &pile->r[pile->width * c], 1);
        if (pile->width > 3) m->moment = from_parts(&pile->contacts[c], &pile->r[pile->width * c + 3], 1);
    }
}

impact_status imp_pile_rests(imp_pile *pile, imp_world *world, double t, const imp_state *states, double rest_speed,
                             bool *rests)
{
    imp_pile_contacts *touching = &pile->touching;
    *rests = false;
    if (!reserve_bodies(pile, world)) return IMPACT_ENOMEM;
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (body->is_static) continue;
        if (qvec3_norm(states[i].v) + body->radius * qvec3_norm(imp_omega(body, &states[i])) > rest_speed)
            return IMPACT_OK;
    }
    if (!imp_field_loads(world, t, states, pile->loads)) return IMPACT_OK;
    imp_pile_contacts_mark(touching, world, &pile->memory[0]);
    if (!imp_pile_find_points(touching, world, states, NULL, 0, IMP_PILE_SLACK * smallest(world), false))
        return IMPACT_ENOMEM;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static && !is_touched(touching, i)) return IMPACT_OK;
    if (is_dragged(touching, world, rest_speed)) return IMPACT_OK;
    const int closed = touching->count;
    if (!reserve_contacts(pile, world, closed) || !imp_rest_reserve(&pile->rest, closed, world->body_count))
        return IMPACT_ENOMEM;
    if (!remember_points(pile)) return IMPACT_ENOMEM;
    for (int count; (count = gather_island(pile, world)) > 0;) {
        const imp_cone_lengths *lengths = pile->width > 3 ? pile->lengths : NULL;
        const imp_rest_outcome outcome = imp_rest_solve(world, states, pile->contacts, pile->friction, lengths, count,
                                                        pile->loads, &pile->rest, pile->r, pile->velocities);
        if (outcome.status != IMP_REST_RESTS) return IMPACT_OK;
        remember_rest(pile, count);
    }
    *rests = true;
    return IMPACT_OK;
}
