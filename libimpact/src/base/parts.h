/* SPDX-License-Identifier: MIT
 *
 * The parts that stand apart, SUNDIALS' CVODE and libccd: tables of functions, had by asking a function. Whoever links
 * decides which function that is:
 *   the part's own (ode_cvode.c, gjk.c): a static program that asks for it by the linker's -u, as impact_static does;
 *   a loader's (part_load.c, the runner's): the shared library and the runner load a part when it is first asked for;
 *   none: a static program that does not ask. The name is weak, so that nothing here draws the part in. Internal.
 */
#ifndef IMP_PARTS_H
#define IMP_PARTS_H

#include <impact/status.h>

struct imp_ode_driver;
struct imp_gap_ccd;

/* IMPACT_PARTS_APART: the linker knows weak names as ELF has them, and this file is none of a part's; elsewhere the
 * parts of the build are drawn in, all. */
#if defined(IMPACT_PARTS_APART)
#define IMP_PART __attribute__((weak))
#else
#define IMP_PART IMPACT_API
#endif

IMP_PART const struct imp_ode_driver *imp_part_cvode(void);
IMP_PART const struct imp_gap_ccd *imp_part_ccd(void);

#define IMP_NO_CVODE "this program has none (built with IMPACT_WITH_CVODE off, or linked without)"
#define IMP_NO_CCD "this program has none (built with IMPACT_WITH_CCD off, or linked without)"

/* The tables, or NULL: the build or the program has none, or it cannot be loaded. */
const struct imp_ode_driver *imp_cvode(void);
const struct imp_gap_ccd *imp_ccd(void);

#endif
