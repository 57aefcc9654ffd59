/* SPDX-License-Identifier: MIT
 *
 * collide, inside: receipts.
 */
#ifndef IMP_COLLIDE_RECEIPT_H
#define IMP_COLLIDE_RECEIPT_H

#include "collide/collide_ready.h"

/* impact_collide_receipt of numbers near 1. */
double imp_receipt_make(const impact_collision *collision, const impact_outcome *outcome, impact_receipt *receipt);

/* Of closed forms, where the whole receipt would cost what the answer does: u_n+ as reported, and the energy against
 * the works, in eps; not finite: NaN. n: the unit normal. */
double imp_receipt_brief(const imp_ready *ready, qvec3 n, const impact_outcome *outcome);

#endif
