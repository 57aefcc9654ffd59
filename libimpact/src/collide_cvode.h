/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the same phases of an impact by CVODE with root functions.
 */
#ifndef IMPACT_COLLIDE_CVODE_H
#define IMPACT_COLLIDE_CVODE_H

#include "collide_course.h"

/* Solves the course by CVODE. `speed` is U, the unit of velocity, for the caller's friction law. IMPACT_EUNSETTLED
 * where the phases do not end, IMPACT_EINTEGRATOR where CVODE gives up, IMPACT_EABSENT in a build without it. */
impact_status impact_cvode_solve(impact_course *course, const impact_collision *collision, double speed);

/* The integrator of the compliant contact, kept in a workspace. */
typedef struct impact_compliant impact_compliant;

/* Solves the course with the tangential compliance eta^2 > 0 by Stronge's law; *keep is made when it is NULL. */
impact_status impact_compliant_solve(impact_course *course, double compliance, double tolerance,
                                     impact_compliant **keep);
void impact_compliant_destroy(impact_compliant *compliant);

/* A new workspace of the same method and tolerance; NULL: the default ones. */
impact_status impact_cvode_workspace_like(const impact_collide_workspace *pattern,
                                          impact_collide_workspace **workspace);

#endif
