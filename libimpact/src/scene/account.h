/* SPDX-License-Identifier: MIT
 *
 * account: the energy of a whole scene at one time without a sum over its bodies. A body whose energy is constant on
 * its segment has a leaf of a binary tree of sums, changed in O(log n), the same bits whatever the order of the
 * changes; those whose energy changes on the way are listed, and asked. Internal.
 */
#ifndef IMP_ACCOUNT_H
#define IMP_ACCOUNT_H

#include "base/arena.h"

typedef struct imp_account {
    int leaves;  /* a power of two */
    double *sum; /* of node k's children 2k and 2k + 1; the leaves from sum[leaves] on */
    int *live;   /* bodies alone whose energy changes */
    int live_count;
    int *place; /* in that list, or -1 */
} imp_account;

impact_status imp_account_open(imp_account *account, imp_arena *arena, int bodies);

/* The body's energy, J, is this from here on; or changes. */
void imp_account_set(imp_account *account, int body, double energy);
void imp_account_set_live(imp_account *account, int body);

/* Of all that is constant, J. */
double imp_account_sum(const imp_account *account);

#endif
