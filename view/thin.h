/* SPDX-License-Identifier: MIT
 *
 * thin: a record with fewer keys and shorter numbers, for a page. Internal.
 */
#ifndef IMP_THIN_H
#define IMP_THIN_H

#include "run/run_open.h"
#include "run/text.h"

/* Tolerances that make sense: what float32 keeps, and what is still seen to be the same motion. */
#define IMP_THIN_LEAST 1e-7
#define IMP_THIN_MOST 0.1

/* Appends the record of the run with those keys alone that meet the motion to tolerance, a part of each body's size and
 * rad; events, contacts and the account are as they were. Its head has the tolerance as "thinned". With 0 all keys stay
 * as they are. */
impact_status imp_thin(imp_text *out, const impact_run *run, double tolerance);

#endif
