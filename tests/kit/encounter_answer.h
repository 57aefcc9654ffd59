/* SPDX-License-Identifier: MIT
 *
 * A random encounter solved, with all that is told of it.
 */
#ifndef ENCOUNTER_ANSWER_H
#define ENCOUNTER_ANSWER_H

#include "kit/encounter_random.h"

typedef struct answer {
    impact_status status;
    impact_together_outcome outcome;
    qvec3 velocity[ENCOUNTER_BODIES], omega[ENCOUNTER_BODIES];
    impact_meeting_outcome meetings[ENCOUNTER_CONTACTS];
} answer;

static inline answer solve(const random_encounter *e, impact_together_law law, double exponent,
                           impact_together_workspace *workspace)
{
    answer a;
    impact_encounter encounter = encounter_of(e, law);
    encounter.exponent = exponent;
    encounter.workspace = workspace;
    a.outcome = (impact_together_outcome){.velocity = a.velocity, .omega = a.omega, .meetings = a.meetings};
    a.status = impact_collide_together(&encounter, &a.outcome);
    return a;
}

#endif
