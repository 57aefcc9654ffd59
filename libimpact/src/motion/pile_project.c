/* SPDX-License-Identifier: MIT */
#include "motion/pile_parts.h"
#include "base/tolerances.h"
#include "contact/least.h"

#include <string.h>

/* How far apart what is held may be: as far as the step met it or as it may err, m. */
static double most_apart(imp_pile *pile, const imp_world *world, double slack)
{
    const imp_pile_memories *held = imp_pile_ended(pile);
    double apart = fmax(slack, imp_pile_allowed(pile, world));
    for (int k = 0; k < held->count; k++) apart = fmax(apart, 2 * held->list[k].gap);
    return apart;
}

/* The points that were held at the end of the step and are no farther apart than that: what is has parted, as a face
 * that leaves another over its border, and would be drawn back by what the step slid. */
static bool find_held(imp_pile *pile, imp_world *world, const imp_state *states, double h, double apart)
{
    imp_pile_contacts *touching = &pile->touching;
    imp_pile_memories *held = imp_pile_ended(pile);
    imp_pile_contacts_mark(touching, world, held);
    if (!imp_pile_find_points(touching, world, states, states, h, apart, true)) return false;
    imp_pile_recall(touching, world, states, h, held);
    for (int k = 0; k < touching->count; k++)
        touching->points[k].taken = touching->points[k].memory < 0 || touching->points[k].gap > apart;
    return true;
}

/* Impulses of displacement along the normals, that take every gap to zero: the least that do, of those equations that
 * are independent. */
static void close_gaps(imp_pile *pile, const imp_world *world, const imp_state *states, int count)
{
    const size_t n = (size_t)count;
    imp_cone_assemble_normals(world, states, pile->contacts, count, pile->rows, pile->w);
    for (int c = 0; c < count; c++) pile->last_u[c] = -pile->gap[c];
    imp_least_solve_pivoted(pile->w, count, IMP_LINEAR_VANISHING, pile->w + n * n, pile->pivots, pile->last_u);
    memset(pile->r, 0, sizeof *pile->r * 3 * n);
    for (int c = 0; c < count; c++) pile->r[3 * c] = pile->last_u[c];
}

/* How far its displacement moves any of the body's points, m. */
static double way_of_body(const imp_world *world, const imp_state *displaced, int i)
{
    const imp_body *body = &world->bodies[i];
    if (body->is_static) return 0;
    return qvec3_norm(displaced[i].v) + body->radius * qvec3_norm(imp_omega(body, &displaced[i]));
}

/* How far the displacements move any body's point, m. */
static double way_of(const imp_world *world, const imp_state *displaced)
{
    double most = 0;
    for (int i = 0; i < world->body_count; i++) most = fmax(most, way_of_body(world, displaced, i));
    return most;
}

/* Whether closing the island's gaps moves a point much farther than what is held may be apart and the gaps together,
 * each of which takes about its own size. So do contacts beside each other, d apart: gaps that differ by e take a turn
 * by e/d, of which no gap that a step has left tells anything. */
static bool goes_astray(const imp_pile *pile, const imp_world *world, int count, double apart)
{
    double most = 0;
    for (int c = 0; c < count; c++) {
        apart += fabs(pile->gap[c]);
        most = fmax(most, way_of_body(world, pile->middle, pile->contacts[c].body1));
        most = fmax(most, way_of_body(world, pile->middle, pile->contacts[c].body2));
    }
    return most > IMP_PILE_ASTRAY * apart;
}

/* Gives the displacements those impulses, unless the equations that were left out are not met then: of contacts that
 * are more than motions not every gap can be zero; or they go astray. */
static void push_together(imp_pile *pile, imp_world *world, int count, double slack, double apart)
{
    double off = 0;
    imp_cone_push(world, pile->contacts, count, pile->r, pile->middle);
    imp_cone_contact_velocities(world, pile->middle, pile->contacts, count, pile->u);
    for (int c = 0; c < count; c++) off = fmax(off, fabs(pile->gap[c] + pile->u[3 * c]));
    if (off <= 0.1 * slack && !goes_astray(pile, world, count, apart)) return;
    for (int i = 0; i < 3 * count; i++) pile->r[i] = -pile->r[i];
    imp_cone_push(world, pile->contacts, count, pile->r, pile->middle);
}

/* Impulses of displacement along the normals, that part what overlaps: a cone problem without friction. */
static void part_overlaps(imp_pile *pile, const imp_world *world, int count)
{
    const imp_pile_question question = {.count = count, .usable = IMP_PILE_USABLE, .effort = IMP_CONE_BRIEF};
    pile->width = 3;
    memset(pile->q, 0, sizeof *pile->q * 3 * (size_t)count);
    for (int c = 0; c < count; c++) pile->q[3 * c] = pile->gap[c], pile->friction[c] = 0;
    const imp_cone_outcome outcome = imp_pile_solve(pile, world, &question);
    if (outcome.residual <= question.usable) /* what it leaves is a part of the overlaps */
        imp_cone_push(world, pile->contacts, count, pile->r, pile->middle);
}

/* Everything that moves stands where it is in the states, pile->middle has its displacement. */
static void displace_nothing(imp_pile *pile, const imp_world *world, const imp_state *states)
{
    memcpy(pile->middle, states, sizeof *states * (size_t)world->body_count);
    for (int i = 0; i < world->body_count; i++) pile->middle[i].v = pile->middle[i].momentum = (qvec3){0, 0, 0};
}

/* The points that overlap by more than that where they are displaced join those that part; whether any does. */
static bool join_overlaps(const imp_pile *pile, const imp_world *world, double left)
{
    bool joined = false;
    for (int k = 0; k < pile->touching.count; k++) {
        imp_pile_point *point = &pile->touching.points[k];
        double u[3];
        imp_cone_contact_velocities(world, pile->middle, &point->contact, 1, u);
        const bool joins = !point->parts && point->gap + u[0] < -left;
        point->parts = point->parts || joins;
        joined = joined || joins;
    }
    return joined;
}

static double deepest(const imp_pile_contacts *touching)
{
    double most = 0;
    for (int k = 0; k < touching->count; k++) most = fmax(most, -touching->points[k].gap);
    return most;
}

/* Parts what overlaps by more than `left`, and what is near and would overlap by it, by more than `joins`, both in m:
 * one after another the contacts of two bodies drove each other ever deeper. pile->middle gets the displacement.
 * Whether anything overlaps. */
static bool part_near(imp_pile *pile, imp_world *world, const imp_state *states, double left, double joins)
{
    imp_pile_contacts *touching = &pile->touching;
    displace_nothing(pile, world, states);
    for (int k = 0; k < touching->count; k++) touching->points[k].parts = false;
    bool any = false;
    while (join_overlaps(pile, world, any ? joins : left)) {
        any = true;
        displace_nothing(pile, world, states);
        for (int k = 0; k < touching->count; k++) touching->points[k].taken = !touching->points[k].parts;
        for (int count; (count = imp_pile_gather_island(pile, world)) > 0;) part_overlaps(pile, world, count);
    }
    return any;
}

/* What is parted by D, against loads F, had come no farther: it has less energy by W = -F.D than where it was found,
 * and that is its approach's, v' = v + a D, a (v.M D) + a^2 (D.M D)/2 = -W, or all of it. Without that what falls to
 * and fro between two contacts within a step each gets what it loses there again from being parted. */
static void slow_down(imp_pile *pile, const imp_world *world, int count, imp_state *states)
{
    const int bodies = imp_pile_list_bodies(pile, world, count);
    double approach = 0, size = 0, work = 0;
    for (int k = 0; k < bodies; k++) {
        const int b = pile->listed[k];
        const imp_body *body = &world->bodies[b];
        const imp_state *by = &pile->middle[b];
        const qvec3 turn = imp_omega(body, by);
        approach += body->mass * qvec3_dot(states[b].v, by->v) + qvec3_dot(imp_omega(body, &states[b]), by->momentum);
        size += body->mass * qvec3_dot(by->v, by->v) + qvec3_dot(turn, by->momentum);
        work -= qvec3_dot(pile->loads[b].force, by->v) + qvec3_dot(pile->loads[b].torque, turn);
    }
    if (!(work > 0 && approach < 0)) return;
    const double left = approach * approach - 2 * work * size,
                 part = left > 0 ? 2 * work / (sqrt(left) - approach) : -approach / size;
    for (int k = 0; k < bodies; k++) {
        imp_state *state = &states[pile->listed[k]];
        const imp_state *by = &pile->middle[pile->listed[k]];
        state->v = qvec3_axpy(part, by->v, state->v);
        state->momentum = qvec3_axpy(part, by->momentum, state->momentum);
    }
}

/* What touches, where anything overlaps by more than that. */
static bool find_overlaps(imp_pile *pile, imp_world *world, const imp_state *states, double left)
{
    const double near = imp_pile_allowed(pile, world);
    imp_pile_contacts *touching = &pile->touching;
    if (!imp_pile_find_points(touching, world, states, NULL, 0, -left, false)) return false;
    if (touching->count > 0 && !imp_pile_find_points(touching, world, states, NULL, 0, near, false)) return false;
    return imp_pile_reserve_contacts(pile, world, touching->count);
}

impact_status imp_pile_project(imp_pile *pile, imp_world *world, double h, imp_state *states, double *parted)
{
    const double slack = imp_pile_slack(pile, world), apart = most_apart(pile, world, slack);
    if (!find_held(pile, world, states, h, apart) || !imp_pile_reserve_contacts(pile, world, pile->touching.count))
        return IMPACT_ENOMEM;
    displace_nothing(pile, world, states);
    for (int count; (count = imp_pile_gather_island(pile, world)) > 0;) {
        close_gaps(pile, world, states, count);
        push_together(pile, world, count, slack, apart);
    }
    imp_pile_drift(world, pile->middle, 1, states);
    /* overlaps as small as a ten-thousandth of a step's error are closed with the gaps of the next */
    const double left = 0.001 * slack;
    if (!find_overlaps(pile, world, states, left)) return IMPACT_ENOMEM;
    if (part_near(pile, world, states, left, fmax(left, IMP_PILE_JOINS * deepest(&pile->touching))) && h > 0) {
        for (int k = 0; k < pile->touching.count; k++) pile->touching.points[k].taken = !pile->touching.points[k].parts;
        for (int count; (count = imp_pile_gather_island(pile, world)) > 0;) slow_down(pile, world, count, states);
    }
    *parted = way_of(world, pile->middle);
    imp_pile_drift(world, pile->middle, 1, states);
    return IMPACT_OK;
}

impact_status imp_pile_part(imp_pile *pile, imp_world *world, imp_state *states)
{
    /* places turn: each leaves the square of what the one before did; about a rim, where two normals take turns, half
     */
    enum { PASSES = 40 };
    const double rounding = IMP_TOUCHING * imp_pile_smallest(world);
    if (!imp_pile_reserve_bodies(pile, world)) return IMPACT_ENOMEM;
    imp_pile_contacts_mark(&pile->touching, world, imp_pile_held(pile));
    for (int pass = 0; pass < PASSES; pass++) {
        if (!find_overlaps(pile, world, states, rounding)) return IMPACT_ENOMEM;
        if (!part_near(pile, world, states, rounding, rounding)) return IMPACT_OK;
        imp_pile_drift(world, pile->middle, 1, states);
    }
    return IMPACT_OK;
}

impact_status imp_pile_lay_down(imp_pile *pile, imp_world *world, imp_state *states)
{
    double way;
    const impact_status status = imp_pile_project(pile, world, 0, states, &way);
    return status == IMPACT_OK ? imp_pile_part(pile, world, states) : status;
}
