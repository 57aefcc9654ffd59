/* SPDX-License-Identifier: MIT */
#include "motion/pile_parts.h"
#include "base/bracket.h"
#include "base/tolerances.h"
#include "contact/rates.h"
#include "world/normal.h"

#include <stdio.h>
#include <string.h>

/* Along the contact's axes, and, of a width of six, about them. */
static void parts_of(const imp_cone_contact *contact, qvec3 along, qvec3 about, int width, double factor, double *to)
{
    for (int k = 0; k < width; k++) to[k] = factor * qvec3_dot(contact->axes[k % 3], k < 3 ? along : about);
}

qvec3 imp_pile_from_parts(const imp_cone_contact *contact, const double *parts, double divisor)
{
    qvec3 v = {0, 0, 0};
    for (int k = 0; k < 3; k++) v = qvec3_axpy(parts[k] / divisor, contact->axes[k], v);
    return v;
}

/* From before the step. */
static const imp_pile_memory *remembered(const imp_pile *pile, const imp_pile_point *point)
{
    return point->memory < 0 ? NULL : &pile->memory[1].list[point->memory];
}

/* By how much more what was open before the step is to part, < 0, for the velocities pile->before with which it closes;
 * pile->q has the loads. A bounce at e w that these, h a, let rise by less than a step may err, (e w)^2/2a, is none: by
 * as much gaps are closed, and with e = .9 that would lift a ball as high as it had bounced, again and again for ever.
 */
static double bounce_of(const imp_pile *pile, const imp_world *world, const imp_pile_point *point, int i, double h)
{
    const double back = world->pairs[point->pair].law.restitution * fmin(0, pile->before[i]),
                 falls = pile->before[i] - pile->q[i], allowed = imp_pile_allowed(pile, world);
    return h > 0 && back * back * h < 2 * allowed * falls ? 0 : back;
}

/* Where the impulses may begin: as before the step. A contact that was open before it bounces off what it approaches,
 * pile->bounce; what is held does not. Whether none does approach. */
static bool recall_step(imp_pile *pile, const imp_world *world, int count, double h)
{
    bool smooth = true;
    for (int c = 0; c < count; c++) {
        const imp_pile_point *point = &pile->touching.points[pile->members[c]];
        const imp_pile_memory *before = remembered(pile, point);
        const int i = pile->width * c;
        pile->bounce[c] = before ? 0 : bounce_of(pile, world, point, i, h);
        pile->q[i] += pile->bounce[c];
        smooth = smooth && (before || pile->before[i] >= 0);
        if (before) {
            parts_of(&pile->contacts[c], before->reaction, before->moment, pile->width, h, &pile->last_r[i]);
            parts_of(&pile->contacts[c], before->velocity, before->turning, pile->width, 1, &pile->last_u[i]);
        } else
            for (int k = 0; k < pile->width; k++) pile->last_r[i + k] = 0, pile->last_u[i + k] = pile->q[i + k];
    }
    return smooth;
}

/* How the contact's own impulses move it, 1/kg: along its normal. */
static double mobility_of(const imp_pile *pile, int c)
{
    double w = 0;
    for (int side = 0; side < 2; side++)
        for (int l = 0; l < 6; l++) w += pile->rows[c].side[side][0][l] * pile->rows[c].side[side][0][l];
    return w;
}

/* What presses is held. What opens is not, or its gap would be taken to zero for ever: of reaction and opening, of
 * which one is zero but for rounding, that is the greater. */
static bool remember_step(imp_pile *pile, imp_pile_memories *memories, int count, double h)
{
    for (int c = 0; c < count; c++) {
        const int i = pile->width * c;
        if (pile->u[i] > mobility_of(pile, c) * pile->r[i]) continue;
        const imp_pile_point *point = &pile->touching.points[pile->members[c]];
        const imp_pile_memory *before = remembered(pile, point);
        imp_pile_memory *m = imp_pile_remember(pile->arena, memories, point);
        if (!m) return false;
        m->velocity = imp_pile_from_parts(&pile->contacts[c], &pile->u[i], 1);
        if (pile->width > 3) m->turning = imp_pile_from_parts(&pile->contacts[c], &pile->u[i + 3], 1);
        if (!(h > 0)) { /* impulses at an instant are no reactions */
            if (before) m->reaction = before->reaction, m->moment = before->moment;
            continue;
        }
        m->reaction = imp_pile_from_parts(&pile->contacts[c], &pile->r[i], h);
        if (pile->width > 3) m->moment = imp_pile_from_parts(&pile->contacts[c], &pile->r[i + 3], h);
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
        const qvec3 v[2] = {imp_surface_velocity(under, own->arm2),
                            imp_surface_velocity(under, qvec3_add(own->arm2, own->rub))};
        for (int k = 0; k < pile->width; k++)
            work += pile->r[pile->width * c + k] * qvec3_dot(own->axes[k % 3], k < 3 ? v[k > 0] : under->spin);
    }
    return work;
}

/* The places are those of the step's middle: what its two ends' velocities differ by from what they would be there, as
 * bodies and contacts turn, into pile->bend. */
static void find_bends(const imp_pile *pile, imp_world *world, const imp_state *states, int count, double h)
{
    memset(pile->bend, 0, (size_t)(pile->width * count) * sizeof *pile->bend);
    for (int c = 0; c < count && h > 0; c++) {
        const imp_pile_point *point = &pile->touching.points[pile->members[c]];
        const imp_cone_contact *own = &point->contact;
        const impact_contact contact = {.normal = own->axes[0], .offset1 = own->arm1, .offset2 = own->arm2};
        double bend[6];
        imp_contact_bend(world, &world->pairs[point->pair], point->bearer, &contact, own->axes, own->rub, states, bend);
        for (int k = 0; k < pile->width; k++) pile->bend[pile->width * c + k] = h * bend[k];
    }
}

/* The same of its moments about all three axes, 1/(kg m^2). */
static double turning_mobility_of(const imp_pile *pile, int c)
{
    double w = 0;
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 6; l++) w += pile->turns[c].side[side][k][l] * pile->turns[c].side[side][k][l];
    return w;
}

/* What turns a slip at the end of the step, without changing its size, into the way it goes at the middle; returns by
 * what angle, about. 0 of slip that the step turns back. */
static double turn_to_middle(int count, const double *from, const double *to, double *lead)
{
    double meet = 0, slip = 0, mean = 0, off = 0;
    for (int k = 0; k < count; k++) {
        lead[k] = 0;
        meet += from[k] * to[k];
        slip = hypot(slip, to[k]), mean = hypot(mean, from[k] + to[k]);
    }
    if (!(slip > 0) || !(meet > 0)) return 0;
    for (int k = 0; k < count; k++) {
        lead[k] = slip * (from[k] + to[k]) / mean - to[k];
        off = hypot(off, lead[k]);
    }
    return off / slip;
}

/* That of the contact's slip, which is one with its spin times tau/mu, and of its rolling; what velocity friction gives
 * the bodies, of this size, by being off that way, m/s. */
static double lead_of(const imp_pile *pile, int c, double size, double lead[6])
{
    const int i = pile->width * c;
    const double *from = &pile->before[i], *to = &pile->u[i], *r = &pile->r[i];
    memset(lead, 0, 6 * sizeof *lead);
    if (pile->width == 3)
        return turn_to_middle(2, &from[1], &to[1], &lead[1]) * mobility_of(pile, c) * hypot(r[1], r[2]);
    const double arm = pile->friction[c] > 0 ? pile->lengths[c].torsional / pile->friction[c] : 0,
                 slip[2][3] = {{from[1], from[2], arm * from[3]}, {to[1], to[2], arm * to[3]}},
                 rubs = hypot(hypot(r[1], r[2]), arm > 0 ? r[3] / arm : 0), turns = size * turning_mobility_of(pile, c);
    const double off = turn_to_middle(3, slip[0], slip[1], &lead[1]) * rubs * (mobility_of(pile, c) + arm * turns),
                 rolls = turn_to_middle(2, &from[4], &to[4], &lead[4]) * hypot(r[4], r[5]) * turns;
    lead[3] = arm > 0 ? lead[3] / arm : 0;
    return off + rolls;
}

/* How fast the fastest of the island's bodies goes, m/s. */
static double fastest_body(const imp_pile *pile, const imp_world *world, const imp_state *states, int count)
{
    double most = 0;
    for (int c = 0; c < count; c++) {
        const int own[2] = {pile->contacts[c].body1, pile->contacts[c].body2};
        for (int k = 0; k < 2; k++) {
            const imp_body *body = &world->bodies[own[k]];
            if (body->is_static) continue;
            const double turning = body->radius * qvec3_norm(imp_omega(body, &states[own[k]]));
            most = fmax(most, qvec3_norm(states[own[k]].v) + turning);
        }
    }
    return most;
}

/* What the residual of the impulses makes of the step's error may be a part of what that may be. */
static imp_pile_question question_of(const imp_pile *pile, const imp_world *world, const imp_state *states, int count,
                                     double h)
{
    const double fastest = imp_pile_fastest(pile, count) + IMP_NOT_ZERO,
                 error = IMP_PILE_RESIDUAL * imp_pile_allowed(pile, world) / h,
                 still = IMP_PILE_STILL * fastest_body(pile, world, states, count);
    return (imp_pile_question){.count = count,
                               .recalls = true,
                               .effort = IMP_CONE_BRIEF,
                               .enough = fmax(fmin(fmin(error, still) / fastest, IMP_PILE_USABLE), IMP_BODIES_ACCEPTED),
                               .usable = fmin(error / fastest, IMP_PILE_USABLE)};
}

/* Where friction is to act along the slip of the step's middle, and that turns by what counts: into pile->lead. */
static bool find_leads(imp_pile *pile, const imp_world *world, int count, double h)
{
    const double natural = imp_pile_natural_time(world, pile->middle), smallest = imp_pile_smallest(world);
    double most = 0, lead[6];
    for (int c = 0; c < count; c++) {
        most = fmax(most, lead_of(pile, c, smallest, lead));
        memcpy(&pile->lead[pile->width * c], lead, sizeof *lead * (size_t)pile->width);
    }
    return most / h * natural * natural > IMP_PILE_LEAD * imp_pile_allowed(pile, world);
}

/* J: what the impulses give the bodies, where of the bounces the part is taken; *size: of what it is the sum. */
static double given(const imp_pile *pile, int count, double part, double *size)
{
    double work = 0;
    *size = 0;
    for (int i = 0; i < pile->width * count; i++) {
        const double after = pile->u[i] - (i % pile->width == 0 ? part * pile->bounce[i / pile->width] : 0),
                     own = 0.5 * pile->r[i] * (pile->before[i] + after);
        work += own, *size += fabs(own);
    }
    return work;
}

/* What friction takes over the step, where its impulse meets the slip of before and after it half each; no more than
 * all of the impulses take: in a bounce that friction turns aside the normals give what it takes beyond that. */
static double rubbed(const imp_pile *pile, int count)
{
    double work = 0, size;
    for (int i = 0; i < pile->width * count; i++)
        if (i % pile->width > 0) work -= 0.5 * pile->r[i] * (pile->before[i] + pile->u[i]);
    return fmax(fmin(work, -given(pile, count, 1, &size)), 0);
}

static imp_cone_outcome solve_with_part(imp_pile *pile, const imp_world *world, const imp_pile_question *question,
                                        double from, double part)
{
    const size_t size = (size_t)(pile->width * question->count) * sizeof *pile->r;
    for (int c = 0; c < question->count; c++) pile->q[pile->width * c] += (part - from) * pile->bounce[c];
    memcpy(pile->last_r, pile->r, size);
    memcpy(pile->last_u, pile->u, size);
    return imp_pile_solve(pile, world, question);
}

/* Against the speeds that contacts have, or those of a fall: what is all but at rest has none to be measured by. */
static bool is_usable(const imp_pile *pile, const imp_world *world, int count, double residual)
{
    const double fall = imp_pile_smallest(world) / imp_pile_natural_time(world, pile->middle);
    return residual <= IMP_PILE_USABLE || residual * imp_pile_fastest(pile, count) <= IMP_PILE_USABLE * fall;
}

/* Of given(), that of bounces which no impulses hold: towards them both grow without bound. */
static double given_if_held(const imp_pile *pile, const imp_world *world, int count, double part, double residual,
                            double *size)
{
    const double work = given(pile, count, part, size);
    return is_usable(pile, world, count, residual) ? work : INFINITY;
}

/* Newton's restitution at several contacts gives energy, where they differ or rub (Kane 1984), and where friction jams
 * no impulses hold it: a body that is caught between two others cannot leave the one by as much. Without bounces they
 * give none, and are there: what is taken is the greatest part of all that gives none either, as far as impulses are
 * known. */
static imp_cone_outcome lessen_bounces(imp_pile *pile, const imp_world *world, const imp_pile_question *question,
                                       imp_cone_outcome outcome)
{
    enum { MOST = 8 };
    const int count = question->count;
    double size, part = 1, work = given_if_held(pile, world, count, part, outcome.residual, &size);
    imp_bracket b = {.high = 1, .at_low = -size, .at_high = work};
    for (int k = 0; k < MOST && outcome.status != IMP_CONE_NO_ROOM && fabs(work) > IMP_PILE_USABLE * size; k++) {
        if (part == 1 && work <= 0) return outcome;
        const double guess = k + 1 < MOST ? imp_bracket_guess(&b) : b.low;
        outcome = solve_with_part(pile, world, question, part, guess);
        part = guess;
        work = given_if_held(pile, world, count, part, outcome.residual, &size);
        imp_bracket_take(&b, part, work, work > 0);
    }
    for (int c = 0; c < count; c++) pile->bounce[c] *= part;
    return outcome;
}

/* Where no shorter step is to be had. */
static imp_cone_outcome solve_at_length(imp_pile *pile, const imp_world *world, imp_pile_question question)
{
    const size_t size = (size_t)(pile->width * question.count) * sizeof *pile->r;
    memcpy(pile->last_r, pile->r, size);
    memcpy(pile->last_u, pile->u, size);
    question.effort = IMP_CONE_WANDERS;
    return imp_pile_solve(pile, world, &question);
}

/* What is asked for, for friction as it is placed: pile->q, before, bounce, and a start; pile->bend is known. Whether
 * nothing bounces. */
static bool ask(imp_pile *pile, imp_world *world, const imp_state *states, int count, double h, const imp_state *next)
{
    const bool turning = pile->width > 3;
    (turning ? imp_cone_contact_turning : imp_cone_contact_velocities)(world, next, pile->contacts, count, pile->q);
    (turning ? imp_cone_contact_turning : imp_cone_contact_velocities)(world, states, pile->contacts, count,
                                                                       pile->before);
    for (int i = 0; i < pile->width * count; i++)
        pile->before[i] -= 0.5 * pile->bend[i], pile->q[i] += 0.5 * pile->bend[i];
    return recall_step(pile, world, count, h);
}

/* Into pile->r and u. */
static imp_cone_outcome find_impulses(imp_pile *pile, const imp_world *world, const imp_pile_question *question,
                                      bool smooth)
{
    imp_cone_outcome outcome = imp_pile_solve(pile, world, question);
    if (!smooth) outcome = lessen_bounces(pile, world, question, outcome);
    if (pile->shortest && outcome.status != IMP_CONE_NO_ROOM &&
        !is_usable(pile, world, question->count, outcome.residual))
        outcome = solve_at_length(pile, world, *question);
    return outcome;
}

/* The same from there, with the leads. */
static imp_cone_outcome find_again(imp_pile *pile, const imp_world *world, const imp_pile_question *question,
                                   bool smooth, bool leads)
{
    const size_t size = (size_t)(pile->width * question->count);
    if (!leads) memset(pile->lead, 0, size * sizeof *pile->lead);
    memcpy(pile->last_r, pile->r, size * sizeof *pile->r);
    for (size_t i = 0; i < size; i++) pile->q[i] += pile->lead[i], pile->last_u[i] = pile->u[i] + pile->lead[i];
    const imp_cone_outcome outcome = find_impulses(pile, world, question, smooth);
    for (size_t i = 0; i < size; i++) pile->u[i] -= pile->lead[i];
    return outcome;
}

static bool is_edge_or_corner(impact_feature feature)
{
    return feature.kind == IMPACT_EDGE || feature.kind == IMPACT_VERTEX;
}

/* Edges on each other that slip part along one of the normals at the ends of their fan, and bear along it. */
static bool turn_edges(imp_pile *pile, const imp_world *world, int count)
{
    const double still = IMP_PILE_USABLE * imp_pile_fastest(pile, count);
    bool turned = false;
    for (int c = 0; c < count; c++) {
        imp_pile_point *point = &pile->touching.points[pile->members[c]];
        imp_cone_contact *own = &pile->contacts[c];
        const double *u = &pile->u[pile->width * c];
        if (!is_edge_or_corner(point->feature[0]) || !is_edge_or_corner(point->feature[1])) continue;
        if (!(pile->r[pile->width * c] > 0) || !(hypot(u[1], u[2]) > still)) continue;
        const impact_contact contact = {.normal = own->axes[0], .offset1 = own->arm1, .offset2 = own->arm2};
        imp_edges edges;
        if (!imp_edge_normals(world, &world->pairs[point->pair], pile->middle, &contact, &edges)) continue;
        const qvec3 slip = qvec3_axpy(u[1], own->axes[1], qvec3_scale(own->axes[2], u[2]));
        const double across = qvec3_dot(slip, qvec3_sub(edges.normal[0], edges.normal[1]));
        if (!(fabs(across) > still)) continue; /* along the edges */
        const int parts = across > 0 ? 0 : 1;
        imp_cone_find_axes(edges.normal[parts], point->contact.axes);
        memcpy(own->axes, point->contact.axes, sizeof own->axes);
        point->bearer = edges.owner[parts] == 0 ? IMP_BORNE_BY_1 : IMP_BORNE_BY_2;
        turned = true;
    }
    return turned;
}

/* Friction acts where the pressures have their centre, and along the slip of the step's middle: both as the first
 * answer has them. Once: where pressures are not unique each answer has others. */
static imp_cone_outcome find_with_friction(imp_pile *pile, imp_world *world, const imp_state *states, int count,
                                           double h, const imp_state *next)
{
    find_bends(pile, world, states, count, h);
    bool smooth = ask(pile, world, states, count, h, next);
    const imp_pile_question question = question_of(pile, world, states, count, h > 0 ? h : pile->strike.span);
    imp_cone_outcome first = find_impulses(pile, world, &question, smooth);
    if (is_usable(pile, world, count, first.residual) && turn_edges(pile, world, count)) {
        find_bends(pile, world, states, count, h);
        smooth = ask(pile, world, states, count, h, next);
        first = find_impulses(pile, world, &question, smooth);
    }
    if (!is_usable(pile, world, count, first.residual)) return first;
    const bool leads = smooth && h > 0 && first.residual <= IMP_PILE_USABLE && find_leads(pile, world, count, h);
    const bool shifted =
        imp_pile_shift_friction(&pile->touching, pile->members, count, pile->r, pile->width, pile->contacts);
    /* bends stay: they differ by what the centre moves in a step, of h, times h; so do the leads */
    if (shifted) (void)ask(pile, world, states, count, h, next);
    return leads || shifted ? find_again(pile, world, &question, smooth, leads) : first;
}

/* The impulses of one island over a step h: states have the velocities before, `next` those with the loads. h = 0: at
 * an instant; what they leave acts over the step that it is in. */
impact_status imp_pile_answer(imp_pile *pile, imp_world *world, const imp_state *states, int count, double h,
                              imp_state *next, imp_pile_step_result *result)
{
    const bool turning = pile->width > 3;
    const double span = h > 0 ? h : pile->strike.span;
    const imp_cone_outcome outcome = find_with_friction(pile, world, states, count, h, next);
    if (outcome.status == IMP_CONE_NO_ROOM) return IMPACT_ENOMEM;
    if (outcome.status == IMP_CONE_BAD || !is_usable(pile, world, count, outcome.residual)) {
        snprintf(pile->message, sizeof pile->message, "the impulses of %d contacts are %s", count,
                 imp_cone_status_name(outcome.status));
        return IMPACT_EUNSETTLED;
    }
    (turning ? imp_cone_push_turning : imp_cone_push)(world, pile->contacts, count, pile->r, next);
    result->error += span * outcome.residual * imp_pile_fastest(pile, count);
    if (!remember_step(pile, &pile->memory[2], count, h)) return IMPACT_ENOMEM;
    result->drive_work += drive_work(pile, world, count);
    result->sliding += rubbed(pile, count);
    for (int c = 0; c < count; c++)
        result->coupled +=
            !world->bodies[pile->contacts[c].body1].is_static && !world->bodies[pile->contacts[c].body2].is_static;
    result->contacts += count;
    return IMPACT_OK;
}
