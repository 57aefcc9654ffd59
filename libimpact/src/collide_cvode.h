/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the same phases of an impact by CVODE with root functions.
 */
#ifndef IMPACT_COLLIDE_CVODE_H
#define IMPACT_COLLIDE_CVODE_H

#include "collide_course.h"

/* Solves the course by CVODE. `speed` is U, the unit of velocity, for the caller's friction law. IMPACT_EUNSETTLED where the phases do
 * not end, IMPACT_EINTEGRATOR where CVODE gives up, IMPACT_EABSENT in a build without it. */
impact_status impact_cvode_solve(impact_course *course, const impact_collision *collision, double speed);

/* A new workspace of the same method and tolerance; NULL: the default ones. */
impact_status impact_cvode_workspace_like(const impact_collide_workspace *pattern,
                                          impact_collide_workspace **workspace);

#endif
