/* SPDX-License-Identifier: MIT
 *
 * pile_parts: what the steps of a pile, the impulses in them, the places after them and the proof of rest share.
 * Internal.
 */
#ifndef IMP_PILE_PARTS_H
#define IMP_PILE_PARTS_H

#include "motion/pile.h"

/* False: there is no room. */
bool imp_pile_reserve_bodies(imp_pile *pile, const imp_world *world);
bool imp_pile_reserve_contacts(imp_pile *pile, const imp_world *world, int wanted);

/* A measure of the pile: its smallest body, m. */
double imp_pile_smallest(const imp_world *world);
/* What a step may err, m: its tolerance's part of that. */
double imp_pile_allowed(const imp_pile *pile, const imp_world *world);
/* Gaps up to this are closed, m: a tenth of a step's error. */
double imp_pile_slack(const imp_pile *pile, const imp_world *world);

/* The orientation, turned by omega over h. */
quat imp_pile_turned(quat q, qvec3 omega, double h);
/* What moves goes on with its velocities for h. */
void imp_pile_drift(const imp_world *world, const imp_state *velocities, double h, imp_state *states);

/* Adds what loads change velocities by in h. */
void imp_pile_add_loads(const imp_world *world, const imp_load *loads, double h, imp_state *states);

/* The points of the next island to the front of the arrays, with their gaps; how many. */
int imp_pile_gather_island(imp_pile *pile, const imp_world *world);
/* Its bodies that move, once each: into pile->number and listed; how many. */
int imp_pile_list_bodies(imp_pile *pile, const imp_world *world, int count);

/* A cone problem of the island at hand: pile->q, friction, contacts, places in pile->middle. */
typedef struct imp_pile_question {
    int count;
    bool recalls;          /* pile->last_r and last_u are a start */
    double enough, usable; /* residuals: that does; up to which no other way is tried */
    imp_cone_effort effort;
} imp_pile_question;

/* Into pile->r and u. */
imp_cone_outcome imp_pile_solve(imp_pile *pile, const imp_world *world, const imp_pile_question *question);

/* Whether pressures may balance among the island's contacts that no load makes, as between two walls; of islands that
 * are not solved in their own space it is not asked. pile->w has the problem then, */
bool imp_pile_may_balance(imp_pile *pile, const imp_world *world, int count);
/* and this its solution where all contacts yield a little (contact/held_law.c), which have no such pressures. */
imp_cone_outcome imp_pile_yield(imp_pile *pile, const imp_pile_question *question);

/* The greatest velocity that contacts have without impulses, pile->q, m/s. */
double imp_pile_fastest(const imp_pile *pile, int count);

/* The vector whose parts along the contact's axes these are, over the divisor. */
qvec3 imp_pile_from_parts(const imp_cone_contact *contact, const double *parts, double divisor);

/* The impulses of one island over a step h: states have the velocities before, `next` those with the loads. h = 0: at
 * an instant. */
impact_status imp_pile_answer(imp_pile *pile, imp_world *world, const imp_state *states, int count, double h,
                              imp_state *next, imp_pile_step_result *result);

/* Looks among the points that were found in states of the velocities, at the time since the step's begin, for what
 * was open and closes so fast that the step would err by more than it may: into pile->strike, if it is the first. */
void imp_pile_seek_strikes(imp_pile *pile, const imp_world *world, const imp_state *states, double time);

/* Strikes at an instant what of the states touches and approaches so, with its islands; *struck: something did.
 * IMPACT_ENOMEM, IMPACT_EUNSETTLED: the states, and what is remembered, are as they were. */
impact_status imp_pile_strike_now(imp_pile *pile, imp_world *world, imp_state *states, imp_pile_step_result *result,
                                  bool *struck);

/* What the step tried last left held. */
static inline imp_pile_memories *imp_pile_ended(imp_pile *pile) { return &pile->memory[2]; }

/* Moves bodies along normals, least in the metric of mass: what is held to gap zero, where that can be; then overlaps
 * apart, *parted (m) being how far that moves any point. Gaps within the slack may stay. The step over h ended in the
 * states. */
impact_status imp_pile_project(imp_pile *pile, imp_world *world, double h, imp_state *states, double *parted);

#endif
