/* SPDX-License-Identifier: MIT
 *
 * One word for each.
 */
#include <impact/collide.h>

const char *impact_law_name(impact_law law)
{
    switch (law) {
    case IMPACT_POISSON: return "poisson";
    case IMPACT_NEWTON: return "newton";
    case IMPACT_STRONGE: return "stronge";
    }
    return "unknown";
}

const char *impact_solver_name(impact_solver solver)
{
    switch (solver) {
    case IMPACT_SOLVER_AUTO: return "auto";
    case IMPACT_SOLVER_CLOSED_FORM: return "closed form";
    case IMPACT_SOLVER_SERIES: return "series";
    case IMPACT_SOLVER_CVODE: return "cvode";
    }
    return "unknown";
}

const char *impact_phase_name(impact_phase phase)
{
    switch (phase) {
    case IMPACT_SLIP_C: return "slip-c";
    case IMPACT_STICK_C: return "stick-c";
    case IMPACT_SLIP_R: return "slip-r";
    case IMPACT_STICK_R: return "stick-r";
    case IMPACT_REVERSAL: return "reversal";
    case IMPACT_TANGENTIAL: return "tangential";
    }
    return "unknown";
}
