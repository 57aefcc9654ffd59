/* SPDX-License-Identifier: MIT
 *
 * collide, inside: from a finished course to an outcome.
 */
#ifndef IMP_COLLIDE_REPORT_H
#define IMP_COLLIDE_REPORT_H

#include "collide/collide_course.h"

/* The velocities of both bodies after an impulse on body 1, and its opposite on body 2, and their energies. */
void imp_report_push(const imp_ready *ready, imp_vec impulse, impact_outcome *outcome);

/* All of the outcome but the solver, which is given in it. speed: the course's unit of velocity. */
void imp_report_course(const impact_collision *collision, const imp_ready *ready, const imp_course *course,
                       imp_real speed, impact_outcome *outcome);

/* The kinetic energy of what moves; omega: local axes. */
static inline imp_real imp_report_energy(const imp_ready *ready, const imp_vectors *velocity, const imp_vectors *omega)
{
    const imp_vectors momentum = imp_vectors_weigh(&ready->moments, omega);
    const imp_lanes each =
        0.5 * (ready->mass * imp_vectors_dot(velocity, velocity) + imp_vectors_dot(&momentum, omega));
    return each[0] + each[1];
}

#endif
