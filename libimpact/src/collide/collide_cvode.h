/* SPDX-License-Identifier: MIT
 *
 * collide, inside: the same phases of an impact by CVODE with root functions.
 */
#ifndef IMP_COLLIDE_CVODE_H
#define IMP_COLLIDE_CVODE_H

#include "collide/collide_workspace.h"
#include "collide/collide_course.h"

/* Solves the course by CVODE. `speed` is U, the unit of velocity, for the caller's friction law. IMPACT_EUNSETTLED
 * where the phases do not end, IMPACT_EINTEGRATOR where CVODE gives up, IMPACT_EABSENT in a build without it. */
impact_status imp_cvode_solve(imp_course *course, const impact_collision *collision, double speed);

/* The integrator of the compliant contact, kept in a workspace. */
typedef struct imp_compliant imp_compliant;

/* Solves the course with the tangential compliance eta^2 > 0 by Stronge's law; *keep is made when it is NULL. */
impact_status imp_compliant_solve(imp_arena *arena, imp_course *course, double compliance, double tolerance,
                                  imp_compliant **keep);
void imp_compliant_destroy(imp_arena *arena, imp_compliant *compliant);

/* A workspace's relative tolerance; NULL: of the one that is made. */
double imp_cvode_tolerance(const impact_collide_workspace *workspace);

/* A new workspace of the same method and tolerance; NULL: the default ones. */
impact_status imp_cvode_workspace_like(const impact_collide_workspace *pattern, impact_collide_workspace **workspace);

#endif
