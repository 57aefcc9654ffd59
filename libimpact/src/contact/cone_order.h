/* SPDX-License-Identifier: MIT
 *
 * cone_order: sizes of a cone problem's numbers, and an order of its contacts that is its own. Internal to the cone
 * solver.
 */
#ifndef IMP_CONE_ORDER_H
#define IMP_CONE_ORDER_H

#include "contact/cone.h"

#include <stdint.h>

struct imp_cone_key {
    uint64_t key, coupled;
    int contact;
};

/* The greatest power of two that is no greater; 1 of what is not above zero or infinite. */
double imp_cone_power_of_two(double value);

/* The parts along its normal and tangents that are a contact's unknowns: three, or one without friction. */
int imp_cone_dimension(const imp_cone_problem *problem, int c);

/* The size of the contact with the largest, of reactions, or of velocities (turning), with imp_cone_units. */
double imp_cone_largest(const imp_cone_problem *problem, const double *v, bool turning);

/* By a hash of the contact's own numbers and of all its couplings: sums of integers know no order. Contacts of one key
 * have like numbers and like neighbours, so that which comes first changes nothing. */
void imp_cone_choose_order(const imp_cone_problem *problem, struct imp_cone_key *keys, int *order);

#endif
