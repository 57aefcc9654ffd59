/* SPDX-License-Identifier: MIT
 *
 * gjk in a build without libccd: there is nothing to harvest.
 */
#include "gap_solver.h"

bool impact_gap_harvest(const impact_pair *pair, bool deep, double n[3])
{
    (void)pair, (void)deep, (void)n;
    return false;
}
