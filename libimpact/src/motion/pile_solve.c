/* SPDX-License-Identifier: MIT
 *
 * The cone problem of an island's impulses. Few contacts in their own space; many in that of the bodies,
 * and where that leaves what counts in the other again, if they are not too many for that.
 */
#include "motion/pile_parts.h"
#include "base/tolerances.h"
#include "contact/encounter.h"

#include <string.h>

/* Whom each contact couples, by numbers of their own from 0; how many move. */
static int couple_bodies(imp_pile *pile, const imp_world *world, int count)
{
    const int bodies = imp_pile_list_bodies(pile, world, count);
    for (int c = 0; c < count; c++) {
        pile->couples[c][0] = pile->number[pile->contacts[c].body1];
        pile->couples[c][1] = pile->number[pile->contacts[c].body2];
    }
    return bodies;
}

/* W is there for by_contacts alone. */
static imp_cone_problem problem_of(const imp_pile *pile, const imp_pile_question *question)
{
    return (imp_cone_problem){.count = question->count,
                              .w = pile->w,
                              .q = pile->q,
                              .friction = pile->friction,
                              .lengths = pile->width > 3 ? pile->lengths : NULL,
                              .last_r = question->recalls ? pile->last_r : NULL,
                              .last_u = question->recalls ? pile->last_u : NULL,
                              .enough = question->enough,
                              .work = question->effort == IMP_CONE_BRIEF ? IMP_PILE_WORK : 0,
                              .effort = question->effort};
}

static void assemble_island(imp_pile *pile, const imp_world *world, int count)
{
    if (pile->width > 3)
        imp_cone_assemble_turning(world, pile->middle, pile->contacts, count, pile->rows, pile->turns, pile->w);
    else
        imp_cone_assemble(world, pile->middle, pile->contacts, count, pile->rows, pile->w);
}

static imp_cone_outcome by_contacts(imp_pile *pile, const imp_world *world, const imp_pile_question *question)
{
    const imp_cone_problem problem = problem_of(pile, question);
    assemble_island(pile, world, problem.count);
    return imp_cone_solve(&problem, &pile->cone, pile->r, pile->u, NULL);
}

/* Whether no motion of all bodies alike, along the sum of their normals, takes all contacts with static bodies apart,
 * friction against it: what is between walls. */
static bool is_enclosed(const imp_pile *pile, const imp_world *world, int count)
{
    qvec3 away = {0, 0, 0};
    for (int c = 0; c < count; c++)
        if (world->bodies[pile->contacts[c].body2].is_static) away = qvec3_add(away, pile->contacts[c].axes[0]);
    for (int c = 0; c < count; c++) {
        const imp_cone_contact *own = &pile->contacts[c];
        if (!world->bodies[own->body2].is_static) continue;
        const double along = qvec3_dot(away, own->axes[0]);
        if (!(along > pile->friction[c] * qvec3_norm(qvec3_axpy(-along, own->axes[0], away)))) return true;
    }
    return false;
}

/* Whether one body alone touches several that are static, at more points than tell how it is pressed. */
static bool is_borne_by_several(const imp_pile *pile, const imp_world *world, int count)
{
    enum { UNIQUE = 3 };
    bool several = false;
    for (int c = 0; c < count; c++) {
        const imp_cone_contact *own = &pile->contacts[c];
        if (!world->bodies[own->body2].is_static || own->body1 != pile->contacts[0].body1) return false;
        several = several || own->body2 != pile->contacts[0].body2;
    }
    return several && count > UNIQUE;
}

bool imp_pile_may_balance(imp_pile *pile, const imp_world *world, int count)
{
    if (count > IMP_PILE_DENSE || pile->width > 3) return false;
    const bool several = is_borne_by_several(pile, world, count);
    if (!several && !is_enclosed(pile, world, count)) return false;
    assemble_island(pile, world, count);
    const imp_wedge_question question = {.count = count, .w = pile->w, .friction = pile->friction};
    return several || imp_encounter_wedged(&question, pile->balance);
}

imp_cone_outcome imp_pile_yield(imp_pile *pile, const imp_pile_question *question)
{
    const imp_cone_problem problem = problem_of(pile, question);
    imp_cone_let_yield(pile->w, 3 * question->count);
    return imp_cone_solve(&problem, &pile->cone, pile->r, pile->u, NULL);
}

static imp_cone_outcome by_bodies(imp_pile *pile, const imp_world *world, const imp_pile_question *question)
{
    imp_cone_problem problem = problem_of(pile, question);
    if (question->count > IMP_PILE_DENSE) problem.effort = IMP_CONE_SWEEPS;
    imp_cone_find_rows(world, pile->middle, pile->contacts, problem.count, pile->rows);
    if (pile->width > 3) imp_cone_find_turns(world, pile->middle, pile->contacts, problem.count, pile->turns);
    const imp_cone_couples couples = {.bodies = couple_bodies(pile, world, problem.count),
                                      .of = (const int(*)[2])pile->couples,
                                      .rows = pile->rows,
                                      .turns = pile->turns};
    return imp_cone_solve_bodies(&pile->by_bodies, &problem, &couples, pile->r, pile->u);
}

double imp_pile_fastest(const imp_pile *pile, int count)
{
    double most = 0;
    for (int i = 0; i < pile->width * count; i++) {
        const imp_cone_lengths *own = &pile->lengths[i / pile->width];
        const int k = i % pile->width;
        if ((k == 1 || k == 2) && !(pile->friction[i / pile->width] > 0)) continue; /* none is asked for there */
        most = fmax(most, fabs(pile->q[i]) * (k < 3 ? 1 : k == 3 ? own->torsional : own->rolling));
    }
    return most;
}

/* What was found in the bodies' space is where the contacts' own begins: from there its Newton ends in a few steps
 * where from the last step's answer one in two went the long way. */
static imp_cone_outcome by_contacts_from_there(imp_pile *pile, const imp_world *world, imp_pile_question question)
{
    const size_t size = (size_t)(pile->width * question.count) * sizeof *pile->r;
    memcpy(pile->last_r, pile->r, size);
    memcpy(pile->last_u, pile->u, size);
    question.recalls = true;
    return by_contacts(pile, world, &question);
}

/* Of more than three points of a face pressures are not unique, and friction hangs on them where it slides: the
 * contacts' space finds any, that of the bodies some near where it begins. */
static bool slides_on_many(const imp_pile *pile, int count)
{
    enum { UNIQUE = 3 };
    const imp_pile_point *points = pile->touching.points;
    for (int c = UNIQUE; c < count; c++) {
        const imp_pile_point *point = &points[pile->members[c]];
        if (point->slides && point->pair == points[pile->members[c - UNIQUE]].pair) return true;
    }
    return false;
}

imp_cone_outcome imp_pile_solve(imp_pile *pile, const imp_world *world, const imp_pile_question *question)
{
    if (imp_pile_may_balance(pile, world, question->count)) {
        const imp_cone_outcome outcome = imp_pile_yield(pile, question);
        if (outcome.status != IMP_CONE_BAD && outcome.residual <= question->usable) return outcome;
    }
    const bool few = question->count <= IMP_PILE_FEW;
    if (few && !slides_on_many(pile, question->count)) return by_contacts(pile, world, question);
    const imp_cone_outcome quick = by_bodies(pile, world, question);
    const bool answered = quick.status != IMP_CONE_BAD && quick.status != IMP_CONE_NO_ROOM;
    if (!answered || (!few && quick.residual <= question->usable) || question->count > IMP_PILE_DENSE) return quick;
    return by_contacts_from_there(pile, world, *question);
}
