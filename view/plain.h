/* SPDX-License-Identifier: MIT
 *
 * plain: a record for readers that know no elliptic functions. Internal.
 */
#ifndef IMP_PLAIN_H
#define IMP_PLAIN_H

#include "run/run_open.h"

/* The run with quintics, to its own tolerance, in place of free flights: *plain asks the run for all but its keys,
 * which stand in the arena, and lives as long as both. *changed: there were some. */
impact_status imp_plain(imp_arena *arena, const impact_run *run, impact_run *plain, bool *changed);

#endif
