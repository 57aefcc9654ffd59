/* SPDX-License-Identifier: MIT */
#include "base/parts.h"
#include <stddef.h>

#if defined(IMPACT_PARTS_APART)
const struct imp_ode_driver *imp_cvode(void) { return imp_part_cvode ? imp_part_cvode() : NULL; }
const struct imp_gap_ccd *imp_ccd(void) { return imp_part_ccd ? imp_part_ccd() : NULL; }
#else
#if defined(IMPACT_WITH_CVODE)
const struct imp_ode_driver *imp_cvode(void) { return imp_part_cvode(); }
#else
const struct imp_ode_driver *imp_cvode(void) { return NULL; }
#endif
#if defined(IMPACT_WITH_CCD)
const struct imp_gap_ccd *imp_ccd(void) { return imp_part_ccd(); }
#else
const struct imp_gap_ccd *imp_ccd(void) { return NULL; }
#endif
#endif
