/* SPDX-License-Identifier: MIT
 *
 * gjk in a build without libccd: there is nothing to harvest.
 */
#include "gap/gap_solver.h"

bool imp_gap_epa(const imp_gap_solids *pair, double rho, const double first[3], double tolerance, double *depth,
                 double n[3])
{
    (void)pair, (void)rho, (void)first, (void)tolerance, (void)depth, (void)n;
    return false;
}

bool imp_gap_harvest(const imp_gap_solids *pair, double n[3])
{
    (void)pair, (void)n;
    return false;
}
