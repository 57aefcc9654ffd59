/* SPDX-License-Identifier: MIT
 *
 * collide, inside: receipts.
 */
#ifndef IMP_COLLIDE_RECEIPT_H
#define IMP_COLLIDE_RECEIPT_H

#include "collide/collide_ready.h"
#include "collide/collide_units.h"

/* impact_collide_receipt of numbers near 1; least: what they are no finer than, being the caller's; follows: the
 * hodograph is looked at too. */
double imp_receipt_make(const impact_collision *collision, const impact_outcome *outcome, const imp_least *least,
                        bool follows, impact_receipt *receipt);

/* Of closed forms, where the whole receipt would cost what the answer does: u_n+ as reported, and the energy against
 * the works, in eps; not finite: NaN. n: the unit normal; size: of the velocities' terms before the impact (energy does
 * not rise, and where M's entries are at most 1e3 apart no velocity then grows by more than its root). *works: their
 * sum. */
double imp_receipt_brief(const imp_ready *ready, qvec3 n, double size, const impact_outcome *outcome, double *works);

#endif
